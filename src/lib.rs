//! Equations of motion of mechanical systems, derived at compile time.
//!
//! Declare coordinates, velocity constraints, quasi-velocities, kinetic energy and force function; the macro
//! [`mechanical_system!`] builds the displacement operators, their brackets, the classification, and the equations
//! of motion in the form of Pham Guen (1969), valid for holonomic and nonholonomic systems alike. What it emits is
//! straight-line code, generic in the real type, without allocation and without `std`.
//!
//! ```
//! use guen::mechanical_system;
//! use guen::prelude::*;
//!
//! mechanical_system! {
//!     /// A sled on an inclined plane, with a blade that does not slip sideways.
//!     pub system Sled {
//!         constants   { m > 0, k > 0, alpha, incline, g = 9.81 }
//!         coordinates { phi, x, y }
//!         parameters {
//!             turning = dot(phi);
//!             speed   = dot(x)*cos(phi) + dot(y)*sin(phi);
//!         }
//!         constraints { blade: dot(x)*sin(phi) - dot(y)*cos(phi) = 0; }
//!         let center_x = x + alpha*cos(phi);
//!         let center_y = y + alpha*sin(phi);
//!         kinetic_energy = m/2*(dot(center_x)^2 + dot(center_y)^2) + m/2*k^2*turning^2;
//!         force_function = m*g*sin(incline)*center_x;
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let system = Sled { m: 1.0, k: 0.5, alpha: 0.2, incline: 0.1, g: 9.81 }.prepare()?;
//! let start = sled::State { turning: 1.0, ..Default::default() };
//! let motion = system.simulate(&start, 0.0..2.0)?;
//! assert!((system.energy(2.0, &motion.end()) - system.energy(0.0, &start)).abs() < 1e-7);
//! assert!(!sled::CLASS.is_holonomic());
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! | feature | default | what it brings |
//! | --- | --- | --- |
//! | `nalgebra` | yes | conversions between states and `nalgebra::SVector` |
//! | `alloc` | with `std` | `simulate` and the `Trajectory` that it returns |
//! | `std` | yes | `Std`, and lanes chosen at run time; recordings and pictures are in the crate `guen-study` |
//! | `serde` | no | serde's traits for constants, states and inputs, and for reports of studies |
//! | `components` | no | the module `components`: wheels, springs, motors, arms to be used in systems |
//! | `study` | no | the module `study`: which method, real and step for which accuracy; recordings and pictures |
//! | `viewer` | no | `study`, and in it `Viewer`: recordings as pages that play |
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

pub use guen_runtime::{
    Actuated, Approx7, Approx7Functions, Approx13, Approx13Functions, AuxiliaryStates, Bodies, Body,
    BodyFault, Catastatic, Cause, CheckCosts, Class, Coefficient, Commutator, Conservative, ConstantsError,
    Coordinate, Cost, Derived, Differentiable, Displacement, Dual, Equations, Function, Functions, Fused,
    FusedOperations, Generic, Grid, Guarded, Holonomic, IncompleteLieGroup, InputLaw, InputRecords,
    InputValues, IntegrationError, Invariants, Kernel, KernelMethod, LaneScalar, Laned, LatexDocument, Level,
    LevelInfo, Levels, LieGroup, Lift, Linearization, Monitored, Nonholonomic, Operator, Ordered, OutputMap,
    Positions, PositionsError, Projected, Real, Renormalized, Report, ReportSection, Rheonomic, RunningError,
    Scleronomic, Setting, Simulate, Smooth, SmoothLaw, Source, Sourced, System, Table, TableError,
    WithFunctions, WithInputs, WithScalar, from_fn, generic, hybrid, lanes, maximum, minimum, project,
    projected, renormalized, select, steppers,
};
pub use guen_runtime::{Coefficients, Convolutions, DrivenSeries, HIGHEST_ORDER, PowerSeries, TaylorSeries};
pub use guen_runtime::{Liftable, Linearizable, OutputLinearization, control, linearized, seeded};

#[cfg(feature = "alloc")]
pub use guen_runtime::{
    Happened, InputSamples, Quality, Simulation, SimulationError, SimulationWithoutInputs, Trajectory,
    Trigger,
};
#[cfg(feature = "std")]
pub use guen_runtime::{Std, StdFunctions};

/// The trade of speed for accuracy of a system, measured; with recordings, ensembles and pictures: the crate
/// `guen-study`.
///
/// ```
/// use guen::study::Study;
///
/// guen::mechanical_system! {
///     pub system Pendulum {
///         constants   { l > 0, g = 9.81 }
///         coordinates { q }
///         parameters  { w = dot(q); }
///         kinetic_energy   = l^2*w^2/2;
///         potential_energy = -g*l*cos(q);
///     }
/// }
///
/// let trade = Study::new(Pendulum::new(1.0), [0.5, 0.0], 0.0..2.0)?
///     .keep(|method, real| method == "RK8" && real == "f64")
/// #   .scan(1 << 12)
///     .count_evaluations()
///     .run();
/// assert!(trade.report.fastest_within(1e-9)?.row.error < Some(1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "study")]
#[cfg_attr(docsrs, doc(cfg(feature = "study")))]
pub use guen_study as study;

#[cfg(feature = "components")]
#[cfg_attr(docsrs, doc(cfg(feature = "components")))]
pub mod components;

/// Declares a mechanical system and derives its equations of motion at compile time.
///
/// For `pub system Hoop { .. }` it generates the struct `Hoop` of physical constants and, beside it, the module
/// `hoop` with everything else: `State`, `Prepared`, the operators `X0 ..`, their `Bracket`s, classification and
/// costs as constants, and the text of what was derived. The sections of a declaration are described in the
/// book, chapter "The language" (`docs/language.md` of the repository).
///
/// ```
/// guen::mechanical_system! {
///     /// A bead on a hoop that turns about its vertical diameter.
///     pub system Bead {
///         constants   { m > 0, R > 0, Omega, g = 9.81 }
///         coordinates { theta }
///         parameters  { omega = dot(theta); }
///         kinetic_energy   = m/2*R^2*(omega^2 + Omega^2*sin(theta)^2);
///         potential_energy = -m*g*R*cos(theta);
///     }
/// }
///
/// # fn main() -> Result<(), guen::ConstantsError> {
/// let bead = Bead { m: 1.0, R: 0.1, Omega: 20.0, g: 9.81 }.prepare()?;
/// let rate = bead.rhs(0.0, &bead::State { theta: 0.1, omega: 0.0 });
/// assert!(rate.omega > 0.0); // the bead climbs: the hoop turns faster than sqrt(g/R)
/// assert!(bead::CONSERVATIVE);
/// # Ok(())
/// # }
/// ```
#[macro_export]
macro_rules! mechanical_system {
    // A path of one's own, for macros of one's own that re-export this crate.
    (crate = $($rest:tt)*) => { $crate::__private::mechanical_system! { crate = $($rest)* } };
    // `$crate` finds the facade under whatever name the user's Cargo.toml gives it.
    ($($declaration:tt)*) => { $crate::__private::mechanical_system! { crate = $crate; $($declaration)* } };
}

/// Declares a component: a part of a mechanical system, to be used any number of times in any number of systems.
///
/// For `pub component Wheel(hub: vector, ..) { .. }` it generates the struct `Wheel` of the component's constants. A system has
/// a wheel by `use Wheel as left { hub: e, .. }`. A component is imported like an item, from another module or another crate.
/// The book describes components in the chapter "Components" (`docs/start/components.md` of the repository).
///
/// ```
/// use guen::prelude::*;
///
/// mechanical_component! {
///     /// A mass on a spring that hangs from `anchor`.
///     pub component Spring(anchor: vector) {
///         constants   { m > 0, k > 0, rest >= 0 = 0.1 }
///         coordinates { length }
///         particles   { m at anchor - vec(0, 0, length); }
///         potential_energy = k/2*(length - rest)^2;
///     }
/// }
///
/// mechanical_system! {
///     pub system Pair {
///         constants   { M > 0, g = 9.81 }
///         coordinates { z }
///         particles   { M at vec(0, 0, z); }
///         potential_energy = M*z^2;
///         gravity     = vec(0, 0, -g);
///         use Spring as left  { anchor: vec(-1, 0, z) }
///         use Spring as right { anchor: vec( 1, 0, z) }
///     }
/// }
///
/// # fn main() -> Result<(), guen::ConstantsError> {
/// let spring = Spring { m: 0.1, k: 20.0, rest: 0.1 };
/// let pair = Pair { M: 1.0, g: 9.81, left: spring, right: Spring { k: 30.0, ..spring } }.prepare()?;
/// assert_eq!(pair::State::NAMES, ["z", "left.length", "right.length", "z_rate", "left.length_rate", "right.length_rate"]);
/// let rate = pair.rhs(0.0, &pair::State::default());
/// assert!(rate.left.length_rate > 9.81);
/// # Ok(())
/// # }
/// ```
#[macro_export]
macro_rules! mechanical_component {
    (crate = $($rest:tt)*) => { $crate::__private::mechanical_component! { crate = $($rest)* } };
    ($($declaration:tt)*) => { $crate::__private::mechanical_component! { crate = $crate; $($declaration)* } };
}

/// The items that a program needs in scope: the macros, and what integrates and simulates.
pub mod prelude {
    pub use crate::{mechanical_component, mechanical_system};
    pub use guen_runtime::prelude::*;
    #[cfg(feature = "study")]
    pub use guen_study::{Export, ExportModes};
}

/// The items that expansions refer to; no part of the public interface.
#[doc(hidden)]
pub mod __private {
    pub use guen_macros::{
        mechanical_component, mechanical_component_with, mechanical_system, mechanical_system_with, page,
    };
    pub use guen_runtime::checks::{
        self, Bound, check_constants, check_definite, check_entries, check_fixed, check_hoisted,
        check_inertia, check_limits, check_mass, check_nonnegative, check_nonzero, check_pivot,
        check_positive, check_within, clamped, condition, drift, first, furthest, head, joined, largest,
        placed, rounded,
    };
    pub use guen_runtime::lanes::Lanes;
    pub use guen_runtime::{
        Actuated, AuxiliaryStates, Bodies, Body, Catastatic, CheckCosts, Class, Coefficient, Coefficients,
        Conservative, ConstantsError, Convolutions, Cost, Derived, Differentiable, Displacement,
        DrivenSeries, Dual, EachLane, EntryNames, Guarded, HIGHEST_ORDER, Hoisted, Holonomic,
        IncompleteLieGroup, InputLaw, InputRecords, Instances, Invariants, Laned, Level, LevelInfo, Levels,
        LieGroup, Lift, Liftable, Linearizable, Linearization, Monitored, Nonholonomic, Operator, Ordered,
        OutputLinearization, OutputMap, Positions, PositionsError, PreparedValues, Real, Report,
        ReportSection, Rheonomic, RunningError, Scleronomic, Shape, Simulate, Smooth, Source, Sourced,
        System, TaylorSeries, Unprepared, WithInputs, WithScalar, entries, linearized, maximum, minimum,
        nalgebra_conversions, seeded, select,
    };
    pub use guen_runtime::{
        actuated, condition, contact_mode, contact_states, copied, differentiable, domain, dynamics, energy,
        facts, guard_answers, guarded, held_through_modes, instance_mode, jacobians, laned, level_info,
        levels, linearizable, mass_form, momenta, monitored, motion_of_system, onto_constraints, operators,
        output_map, prepare, prepared, program, program_functions, rates, reaction_covector, reactions,
        record, reduce, reported, restored_by_modes, simulated, simulated_through_modes, source, sourced,
        state_of_system, steady_motions, structured, switches, uses, with_scalar,
    };
    pub use guen_runtime::{consistent, control, hybrid, onto, serde_record, serde_structured};
    pub use guen_runtime::{derivatives_0, derivatives_1, derivatives_2, derivatives_3, derivatives_4};
}
