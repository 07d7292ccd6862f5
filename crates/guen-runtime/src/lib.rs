//! Reals, dual numbers, systems and steppers for guen: `no_std`, without allocation.
//!
//! Generated code consists of data and straight-line expressions; whatever needs no user type is here:
//!
//! | question | answer |
//! | --- | --- |
//! | what is a number? | [`Real`], [`Ordered`], [`Dual`], [`RunningError`]; [`Lift`] embeds a base real |
//! | what is integrated? | [`System`], [`Monitored`], [`Differentiable`], [`TaylorSeries`], [`from_fn`], [`generic`] |
//! | which functions does it have? | [`WithFunctions`]: [`Approx13`], [`Approx7`], [`Fused`], [`Functions`] of your own |
//! | over which reals? | [`Recast`], what can be made anew over each |
//! | how many at once? | [`lanes`]; [`Laned`] systems |
//! | what acts on functions? | [`Operator`], [`Function`], [`Coordinate`], [`BracketCoefficients`] |
//! | what is known at compile time? | [`Class`], the markers [`Holonomic`] to [`Conservative`], [`Cost`] |
//! | how is it integrated? | [`steppers`]: an [`Integration`](steppers::Integration) run by one of ten methods |
//! | how is it controlled? | [`Linearizable`], [`control`] |
//! | which level of detail? | [`Level`], [`LevelInfo`], [`Levels`] |
//! | what holds of positions? | [`Positions`], [`consistent`], [`project`], [`projected`] |
//! | where are its bodies? | [`Bodies`] |
//! | what can go wrong? | [`ConstantsError`], [`IntegrationError`] with its [`Cause`], [`PositionsError`] |
//!
//! The crate knows nothing of the language or of the algebra, and can be used with systems written by hand.
//!
//! # Features
//!
//! - `nalgebra`: re-exports that crate, and [`nalgebra_conversions!`] has an effect.
//! - `serde`: re-exports that crate, and [`serde_record!`] has an effect.
//! - `std`: [`Std`], the platform's elementary functions; [`lanes`] chosen at run time, and not by the target of the
//!   build. Without it everything else gives the same bits.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]
#![deny(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

mod auxiliary_states;
mod bodies;
mod bracket;
pub mod checks;
mod classification;
mod condition;
pub mod control;
mod cost;
mod decimal;
mod derived;
mod differentiable;
mod dual;
mod elementary;
mod emitted;
mod error;
mod float;
mod invariants;
pub mod lanes;
mod level;
mod lift;
mod linearization;
mod nalgebra_support;
mod operator;
mod positions;
mod real;
mod recast;
mod report;
mod rules;
mod running_error;
mod serde_support;
mod series;
pub mod steppers;
mod system;
mod with_functions;

pub use auxiliary_states::{AuxiliaryStates, Renormalized, renormalized};
pub use bodies::{Bodies, Body};
pub use bracket::{BracketCoefficients, Coefficient};
pub use classification::{
    Catastatic, Class, Conservative, Holonomic, IncompleteLieGroup, LieGroup, Nonholonomic, Rheonomic,
    Scleronomic,
};
pub use cost::Cost;
pub use derived::Derived;
pub use differentiable::{Differentiable, Equations, Generic, generic};
pub use dual::Dual;
pub use error::{BodyFault, Cause, ConstantsError, IntegrationError, Setting};
pub use invariants::Invariants;
pub use level::{Level, LevelInfo, Levels};
pub use lift::Lift;
pub use linearization::{Liftable, Linearizable, Linearization, OutputLinearization, seeded};
pub use operator::{Applied, Coordinate, Function, Operator};
#[doc(hidden)]
pub use positions::furthest_surplus;
pub use positions::{Positions, PositionsError, Projected, consistent, project, projected};
pub use real::{Ordered, Real};
pub use recast::Recast;
pub use report::{LatexDocument, MarkdownDocument, Report, ReportSection};
pub use running_error::RunningError;
pub use series::{Coefficients, Convolutions, HIGHEST_ORDER, TaylorSeries};
pub use system::{FromFn, Laned, Monitored, System, from_fn};
pub use with_functions::{
    Approx7, Approx7Functions, Approx13, Approx13Functions, Functions, Fused, FusedOperations, LaneScalar,
    PlainLanes, WithFunctions,
};
#[cfg(feature = "std")]
pub use with_functions::{Std, StdFunctions};

#[cfg(feature = "nalgebra")]
pub use nalgebra;
#[cfg(feature = "serde")]
pub use serde;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use serde_support::{deserialize_derived, deserialize_record, serialize_derived, serialize_record};

/// What a program that integrates systems wants in scope.
pub mod prelude {
    pub use crate::steppers::{
        Bounded, Direction, Dop853, Euler, Event, Gauss4, Gauss6, Guard, Integration, IntegrationResult,
        Outcome, Radau5, Rk4, Rk8, Statistics, Taylor, Tsit5,
    };
    pub use crate::{
        Cause, Coordinate, Dual, Function, IntegrationError, Level, Lift, Monitored, Operator, Ordered, Real,
        System, from_fn,
    };
    pub use core::ops::ControlFlow;
}
