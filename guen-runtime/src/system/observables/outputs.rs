//! The outputs of a system, with their names.

use crate::numbers::real::Real;
use crate::system::System;

/// A system with outputs, `K` reals in all: functions of time, state and inputs that were declared. Generated systems that declare
/// some are; with inputs those that hold them, or have a law for them.
///
/// ```
/// use guen_runtime::{OutputMap, System};
///
/// /// A stone with its energy per mass.
/// struct Stone;
/// impl System<f64, 2> for Stone {
///     fn rhs(&self, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
///         [v, -9.81]
///     }
/// }
/// impl OutputMap<f64, 2, 1> for Stone {
///     type Outputs = f64;
///     const OUTPUTS: [&'static str; 1] = ["energy"];
///     fn output_values(&self, _t: f64, &[z, v]: &[f64; 2]) -> [f64; 1] {
///         [9.81 * z + v * v / 2.0]
///     }
///     fn named_outputs(values: &[f64; 1]) -> f64 {
///         values[0]
///     }
/// }
/// assert_eq!(Stone.output_values(0.0, &[1.0, 2.0]), [11.81]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no outputs",
    note = "a system has some if it declares `outputs {{ .. }}`, a scene if it says `provide outputs;`"
)]
pub trait OutputMap<R: Real, const N: usize, const K: usize>: System<R, N> {
    /// The outputs, with named fields.
    type Outputs;

    /// The names of the reals: of a vector `p` they are `p.x`, `p.y`, `p.z`.
    const OUTPUTS: [&'static str; K];

    /// The units of the reals, for tables and plots; each may be empty, and all are missing where none is declared.
    const OUTPUT_UNITS: &'static [&'static str] = &[];

    /// The outputs as reals, in the order of their names.
    fn output_values(&self, t: R, state: &[R; N]) -> [R; K];

    /// The outputs of these reals.
    fn named_outputs(values: &[R; K]) -> Self::Outputs;
}

impl<R: Real, S: OutputMap<R, N, K> + ?Sized, const N: usize, const K: usize> OutputMap<R, N, K> for &S {
    type Outputs = S::Outputs;
    const OUTPUTS: [&'static str; K] = S::OUTPUTS;
    const OUTPUT_UNITS: &'static [&'static str] = S::OUTPUT_UNITS;

    fn output_values(&self, t: R, state: &[R; N]) -> [R; K] {
        (**self).output_values(t, state)
    }

    fn named_outputs(values: &[R; K]) -> S::Outputs {
        S::named_outputs(values)
    }
}
