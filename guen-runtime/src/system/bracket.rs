//! Brackets of operators: the coefficients of structure, and what is known of each before the program runs.

use core::fmt;

use crate::numbers::lift::Lift;
use crate::numbers::real::Real;

/// A structure coefficient, as far as it is known at compile time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Coefficient {
    /// Proved to vanish identically.
    Zero,
    /// A rational number other than zero, in lowest terms.
    Number {
        /// The numerator, with the sign.
        numerator: i64,
        /// The denominator, positive.
        denominator: i64,
    },
    /// Constant in time and position: a function of the physical constants, or a number that is no ratio of two
    /// `i64`.
    Constant,
    /// A function of time or position, or of unknown nature.
    Variable,
}

impl Coefficient {
    /// Whether the coefficient is known to be the same at all times and positions.
    pub const fn is_constant(self) -> bool {
        !matches!(self, Self::Variable)
    }
}

impl fmt::Display for Coefficient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Zero => f.write_str("0"),
            Self::Number { numerator, denominator: 1 } => write!(f, "{numerator}"),
            Self::Number { numerator, denominator } => write!(f, "{numerator}/{denominator}"),
            Self::Constant => f.write_str("constant"),
            Self::Variable => f.write_str("variable"),
        }
    }
}

/// The bracket of two operators, resolved in the operators of the system.
///
/// ```text
/// (X_I, X_J) = X_I X_J - X_J X_I = sum_t C_IJt X_t        t = 1 .. N
/// ```
///
/// `X_0` does not occur on the right: `d/dt` cancels. So the arrays have `N` entries, that of `X_t` at index
/// `t - 1`.
///
/// Reading [`COEFFICIENTS`](BracketCoefficients::COEFFICIENTS) costs nothing at run time; a `const` assertion on
/// it lets a program refuse to compile for a system that is not what it takes it for.
///
/// ```
/// use guen_runtime::{BracketCoefficients, Coefficient, Lift, Real};
///
/// /// Rotations about two body axes: `(X_1, X_2) = X_3`.
/// struct Spin;
/// impl<B: Real> BracketCoefficients<B, 3> for Spin {
///     type Prepared = ();
///     const I: usize = 1;
///     const J: usize = 2;
///     const COEFFICIENTS: [Coefficient; 3] =
///         [Coefficient::Zero, Coefficient::Zero, Coefficient::Number { numerator: 1, denominator: 1 }];
///     fn coefficients<R: Real + Lift<B>>(_: &(), _t: R, _x: &[R; 3]) -> [R; 3] {
///         [R::zero(), R::zero(), R::one()]
///     }
/// }
///
/// const _: () = assert!(<Spin as BracketCoefficients<f64, 3>>::COEFFICIENTS[2].is_constant());
/// ```
pub trait BracketCoefficients<B: Real, const N: usize> {
    /// The system's prepared constants, of base `B`.
    type Prepared;

    /// The index of the first operator, from 0.
    const I: usize;

    /// The index of the second operator, from 0.
    const J: usize;

    /// The coefficients `C_IJ1 .. C_IJN`, each with what the compiler proved.
    const COEFFICIENTS: [Coefficient; N];

    /// The values of `C_IJ1 .. C_IJN` at time `t` and position `x`.
    fn coefficients<R: Real + Lift<B>>(prepared: &Self::Prepared, t: R, x: &[R; N]) -> [R; N];
}
