//! Reals, dual numbers, systems and steppers for guen: `no_std`, without allocation.
//!
//! Generated code consists of data and straight-line expressions; whatever needs no user type is here:
//!
//! | question | answer |
//! | --- | --- |
//! | what is a number? | [`Real`], [`Ordered`], [`Dual`], [`RunningError`]; [`Lift`] embeds a base real; [`select`], [`minimum`], [`maximum`] choose |
//! | what is integrated? | [`System`], [`Monitored`], [`Differentiable`], [`TaylorSeries`], [`from_fn`], [`generic`] |
//! | what does a guard ask it? | [`Guarded`], with [`Invariants`] and [`CheckCosts`] |
//! | which functions does it have? | [`WithFunctions`]: [`Approx13`], [`Approx7`], [`Fused`], [`Functions`] of your own |
//! | which functions does the program supply? | [`Smooth`], [`Table`], [`Grid`] |
//! | over which reals? | [`WithScalar`]: a system made anew over each |
//! | how many at once? | [`lanes`]; [`Laned`] systems |
//! | what acts on functions? | [`Operator`], [`Function`], [`Coordinate`], [`Commutator`] |
//! | what is known at compile time? | [`Class`], the markers [`Holonomic`] to [`Conservative`], [`Cost`] |
//! | how is it integrated? | [`steppers`]: an [`Integration`](steppers::Integration) run by one of ten methods |
//! | what touches, sticks and slips? | [`hybrid`]: a [`Hybrid`](hybrid::Hybrid) run through the modes of a [`HybridSystem`](hybrid::HybridSystem) |
//! | how is it controlled? | [`Linearizable`], [`control`] |
//! | which level of detail? | [`Level`], [`LevelInfo`], [`Levels`] |
//! | what holds of positions? | [`Positions`], [`consistent`], [`project`], [`projected`] |
//! | where are its bodies? | [`Bodies`] |
//! | how does it go into a program of C? | [`Source`] |
//! | what can go wrong? | [`ConstantsError`], [`IntegrationError`] with its [`Cause`], [`PositionsError`] |
//!
//! The crate knows nothing of the language or of the algebra, and can be used with systems written by hand.
//!
//! # Features
//!
//! - `nalgebra`: re-exports that crate, and [`nalgebra_conversions!`] has an effect.
//! - `serde`: re-exports that crate, and [`serde_record!`] has an effect.
//! - `alloc`: `Simulate::simulate` and the `Trajectory` that it returns. Nothing else allocates.
//! - `std`: `alloc`; `Std`, the platform's elementary functions; [`lanes`] chosen at run time, and not by the target of the
//!   build. Without it everything else gives the same bits.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]
#![deny(unsafe_code)]
#![warn(unreachable_pub)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

pub mod control;
mod functions;
mod generated;
pub mod hybrid;
mod linear_algebra;
mod numbers;
mod report;
#[cfg(feature = "alloc")]
mod simulation;
mod source;
pub mod steppers;
mod system;

#[doc(hidden)]
pub use functions::derivatives::{derivatives_0, derivatives_1, derivatives_2, derivatives_3, derivatives_4};
pub use functions::error::TableError;
pub use functions::grid::Grid;
#[doc(hidden)]
pub use functions::hoisted::{Hoisted, PreparedValues};
#[doc(hidden)]
pub use functions::in_lanes::EachLane;
pub use functions::smooth::Smooth;
pub use functions::table::Table;
pub use generated::checks;
pub use generated::derived::Derived;
pub use generated::entries::{EntryNames, entries, with_entries};
pub use numbers::choices::{maximum, minimum, select};
pub use numbers::dual::Dual;
pub use numbers::lanes;
pub use numbers::lift::Lift;
pub use numbers::power_series::{HIGHEST_ORDER, PowerSeries};
pub use numbers::real::{Ordered, Real};
pub use numbers::running_error::RunningError;
pub use numbers::with_functions::{
    Approx7, Approx7Functions, Approx13, Approx13Functions, Functions, Fused, FusedOperations, LaneScalar,
    PlainLanes, WithFunctions,
};
#[cfg(feature = "std")]
pub use numbers::with_functions::{Std, StdFunctions};
pub use report::cost::Cost;
pub use report::{LatexDocument, MarkdownDocument, Report, ReportSection};
#[cfg(feature = "alloc")]
pub use simulation::{
    Happened, Quality, Simulation, SimulationError, SimulationWithoutInputs, Trajectory, Trigger,
};
pub use source::{Kernel, KernelMethod, Source, Sourced};
pub use steppers::{Cause, IntegrationError, Setting};
pub use system::check_costs::CheckCosts;
pub use system::constants_error::{BodyFault, ConstantsError};
pub use system::constraints::auxiliary_states::{AuxiliaryStates, Renormalized, renormalized};
#[doc(hidden)]
pub use system::constraints::positions::onto;
pub use system::constraints::positions::{Positions, Projected, consistent, project, projected};
pub use system::constraints::positions_error::PositionsError;
pub use system::derivatives::differentiable::{Differentiable, Equations, Generic, generic};
pub use system::derivatives::linearization::{
    Liftable, Linearizable, Linearization, OutputLinearization, linearized, moving, seeded, slopes, tangents,
};
pub use system::derivatives::series::{Coefficients, Convolutions, DrivenSeries, TaylorSeries};
pub use system::guarded::Guarded;
#[doc(hidden)]
pub use system::hints::Unprepared;
pub use system::inputs::actuated::{Actuated, WithInputs};
pub use system::inputs::input_law::{InputLaw, InputRecords, SmoothLaw};
#[cfg(feature = "alloc")]
pub use system::inputs::input_values::InputSamples;
pub use system::inputs::input_values::InputValues;
pub use system::invariants::Invariants;
pub use system::level::{Level, LevelInfo, Levels};
pub use system::observables::bodies::{Bodies, Body};
pub use system::observables::outputs::OutputMap;
pub use system::operators::bracket::Coefficient;
pub use system::operators::classification::{
    Catastatic, Class, Conservative, Holonomic, IncompleteLieGroup, LieGroup, Nonholonomic, Rheonomic,
    Scleronomic,
};
#[doc(hidden)]
pub use system::operators::frame::Frame;
pub use system::operators::frame::{Commutator, Displacement};
pub use system::operators::operator::{Applied, Coordinate, Function, Operator};
pub use system::simulate::Simulate;
pub use system::with_scalar::WithScalar;
pub use system::{FromFn, Laned, MAX_SWITCHES, Monitored, System, from_fn};

#[doc(hidden)]
pub use generated::instances::Instances;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use generated::serde_support::{
    deserialize_derived, deserialize_record, serialize_derived, serialize_record,
};
#[doc(hidden)]
pub use generated::shape::Shape;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use generated::shape::{deserialize_structured, serialize_structured};
#[cfg(feature = "nalgebra")]
pub use nalgebra;
#[cfg(feature = "serde")]
pub use serde;

/// The items that a program needs in scope to integrate systems.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::Unprepared as _;
    pub use crate::steppers::{
        Bounded, Direction, Dop853, Euler, Event, Gauss4, Gauss6, Guard, Integration, IntegrationResult,
        LaneMethod, Outcome, Radau5, Rk4, Rk8, Statistics, Taylor, Tsit5,
    };
    pub use crate::{
        Actuated, Cause, Coordinate, Dual, Function, InputLaw, IntegrationError, Level, Lift, Monitored,
        Operator, Ordered, Real, Simulate, System, from_fn,
    };
    #[cfg(feature = "alloc")]
    pub use crate::{Simulation, SimulationError, Trajectory, Trigger};
    pub use core::ops::ControlFlow;
}
