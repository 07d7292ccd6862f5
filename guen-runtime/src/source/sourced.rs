//! Prepared systems with a text of C.

use super::Source;
use crate::system::System;

/// A prepared system that has its right-hand side as a text of C, with the numbers that the text asks for.
///
/// Systems and scenes with `provide source;` are: without inputs as `Prepared`, with inputs as `Driven`, where they are held.
///
/// ```
/// use guen_runtime::{Source, Sourced, System};
///
/// /// `x' = -rate x`, by hand.
/// struct Decay {
///     rate: f64,
/// }
/// impl System<f64, 1> for Decay {
///     fn rhs(&self, _t: f64, &[x]: &[f64; 1]) -> [f64; 1] {
///         [-self.rate * x]
///     }
/// }
/// impl Sourced<1> for Decay {
///     const SOURCE: Source = Source {
///         name: "decay",
///         program: "#define decay_CONSTANTS 1\n#define decay_PREPARED 0\n#define decay_STATES 1\n#define decay_INPUTS 0\n#define decay_DOMAIN 0\n\
///             GUEN_FUNCTION void decay_rhs(const double *c, const double *k, double t, const double *s, const double *u, double *r)\n\
///             {\n    (void)k;\n    (void)t;\n    (void)u;\n    r[0] = -c[0] * s[0];\n}\n\
///             GUEN_FUNCTION void decay_domain(const double *c, const double *k, double t, const double *s, double *d)\n\
///             {\n    (void)c;\n    (void)k;\n    (void)t;\n    (void)s;\n    (void)d;\n}\n",
///         steps: true,
///         adaptive: true,
///         series: false,
///     };
///     const NUMBERS: usize = 1;
///
///     fn numbers(&self) -> impl Iterator<Item = f64> {
///         [self.rate].into_iter()
///     }
/// }
/// assert_eq!(Decay { rate: 2.0 }.numbers().count(), Decay::NUMBERS);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no text of C",
    note = "a system or a scene has one if it says `provide source;`",
    note = "a prepared system with inputs becomes one with `.driven(inputs)`, where they are held"
)]
pub trait Sourced<const N: usize>: System<f64, N> {
    /// The text.
    const SOURCE: Source;

    /// The number of constants, prepared values and inputs together.
    const NUMBERS: usize;

    /// The constants, the prepared values and the inputs, in the order of the arrays `c`, `k` and `u` of the text.
    fn numbers(&self) -> impl Iterator<Item = f64>;
}

impl<S: Sourced<N>, const N: usize> Sourced<N> for &S {
    const SOURCE: Source = S::SOURCE;
    const NUMBERS: usize = S::NUMBERS;

    fn numbers(&self) -> impl Iterator<Item = f64> {
        S::numbers(self)
    }
}
