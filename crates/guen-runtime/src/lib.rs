//! Reals, dual numbers, systems and steppers for guen: `no_std`, without allocation.
//!
//! Generated code consists of data and straight-line expressions; whatever needs no user type is here:
//!
//! | question | answer |
//! | --- | --- |
//! | what is a number? | [`Real`], [`Ordered`], [`Dual`]; [`Lift`] embeds a base real |
//! | which functions does it have? | [`Tuned`]: [`Digits13`], [`Digits7`], [`Fused`], [`Functions`] of your own |
//! | how many at once? | [`lanes`]; [`Laned`] systems |
//! | what is integrated? | [`System`], [`Monitored`], [`from_fn`] |
//! | what acts on functions? | [`Operator`], [`Function`], [`Coordinate`], [`BracketCoefficients`] |
//! | what is known at compile time? | [`Class`], the markers [`Holonomic`] to [`Conservative`], [`Cost`] |
//! | how is it integrated? | [`steppers`]: [`Rk4`](steppers::Rk4), [`Dop853`](steppers::Dop853) |
//! | what holds of positions? | [`Positions`], [`consistent`], [`project`], [`projected`] |
//! | what can go wrong? | [`ConstantsError`], [`IntegrationError`] with its [`Cause`], [`PositionsError`] |
//!
//! The crate knows nothing of the language or of the algebra, and can be used with systems written by hand.
//!
//! # Features
//!
//! - `nalgebra`: re-exports that crate, and [`nalgebra_conversions!`] has an effect.
//! - `std`: [`Std`], the platform's elementary functions; [`lanes`] chosen at run time, and not by the target of the
//!   build. Without it everything else gives the same bits.
#![no_std]
#![deny(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

mod bracket;
pub mod checks;
mod classification;
mod cost;
mod decimal;
mod dual;
mod elementary;
mod error;
mod float;
pub mod lanes;
mod lift;
mod linearization;
mod nalgebra_support;
mod operator;
mod positions;
mod real;
mod report;
pub mod steppers;
mod system;
mod tuned;

pub use bracket::{BracketCoefficients, Coefficient};
pub use classification::{
    Catastatic, Class, Conservative, Holonomic, IncompleteLieGroup, LieGroup, Nonholonomic, Rheonomic,
    Scleronomic,
};
pub use cost::Cost;
pub use dual::Dual;
pub use error::{BodyFault, Cause, ConstantsError, IntegrationError, Setting};
pub use lift::Lift;
pub use linearization::{Linearization, seeded};
pub use operator::{Applied, Coordinate, Function, Operator};
pub use positions::{Positions, PositionsError, Projected, consistent, project, projected};
pub use real::{Ordered, Real};
pub use report::{Report, ReportSection};
pub use system::{FromFn, Laned, Monitored, System, from_fn};
pub use tuned::{
    Choice, Digits7, Digits7Functions, Digits13, Digits13Functions, Functions, Fused, FusedOperations, Own,
    Tuned,
};
#[cfg(feature = "std")]
pub use tuned::{Std, StdFunctions};

#[cfg(feature = "nalgebra")]
pub use nalgebra;

/// What a program that integrates systems wants in scope.
pub mod prelude {
    pub use crate::steppers::{Done, Dop853, Outcome, Rk4, Statistics};
    pub use crate::{
        Cause, Coordinate, Dual, Function, IntegrationError, Lift, Monitored, Operator, Ordered, Real,
        System, from_fn,
    };
    pub use core::ops::ControlFlow;
}
