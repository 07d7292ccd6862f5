//! Operators and brackets of a generated system, from one description of it.

use core::fmt;
use core::marker::PhantomData;

use super::bracket::Coefficient;
use super::operator::Operator;
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;

/// The operators of a generated system and their brackets: the description from which [`Displacement`] and the brackets of its
/// module come. Generated code implements it for the prepared system over `f64`.
#[doc(hidden)]
pub trait Frame<const N: usize> {
    /// The prepared system over another real.
    type Over<B: Real>;

    /// The highest index of an operator that a bracket may have.
    const LAST: usize;

    /// The brackets `(X_r, X_s)`, `r < s`, that do not vanish identically.
    const BRACKETS: &'static [(usize, usize, [Coefficient; N])];

    /// The coefficients of the operator `X_index`.
    fn operator<B: Real, R: Real + Lift<B>>(
        prepared: &Self::Over<B>,
        t: R,
        x: &[R; N],
        index: usize,
    ) -> [R; N];

    /// The coefficients of the bracket at a place of [`BRACKETS`](Self::BRACKETS).
    fn bracket<B: Real, R: Real + Lift<B>>(
        prepared: &Self::Over<B>,
        t: R,
        x: &[R; N],
        place: usize,
    ) -> [R; N];
}

/// The operator of displacement `X_J` of the generated system `S`: the type of the constants `X0`, `X1`, .. of its module, which
/// are its only values. See [`Operator`].
///
/// ```
/// use guen_runtime::Displacement;
/// // Of no system, to show the name; `hoop::X1` is one of the hoop.
/// let operator = Displacement::<(), 1>::default();
/// assert_eq!(format!("{operator:?}"), "X1");
/// assert_eq!(size_of_val(&operator), 0);
/// ```
pub struct Displacement<S, const J: usize>(PhantomData<fn() -> S>);

impl<S, const J: usize> Displacement<S, J> {
    /// The operator.
    #[doc(hidden)]
    pub const NEW: Self = Displacement(PhantomData);
}

impl<S, const J: usize> Clone for Displacement<S, J> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const J: usize> Copy for Displacement<S, J> {}

impl<S, const J: usize> Default for Displacement<S, J> {
    fn default() -> Self {
        Self::NEW
    }
}

impl<S, const J: usize> PartialEq for Displacement<S, J> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<S, const J: usize> Eq for Displacement<S, J> {}

impl<S, const J: usize> fmt::Debug for Displacement<S, J> {
    /// Writes its name: `X1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "X{J}")
    }
}

impl<B: Real, S: Frame<N>, const J: usize, const N: usize> Operator<B, N> for Displacement<S, J> {
    type Prepared = S::Over<B>;
    const TIME: bool = J == 0;

    #[inline]
    fn coefficients<R: Real + Lift<B>>(prepared: &S::Over<B>, t: R, x: &[R; N]) -> [R; N] {
        S::operator(prepared, t, x, J)
    }
}

/// The place of a bracket among those that do not vanish, and whether it is the one of `(X_j, X_i)`.
const fn place<S: Frame<N>, const N: usize>(i: usize, j: usize) -> Option<(usize, bool)> {
    assert!(i <= S::LAST && j <= S::LAST, "the system has no such bracket: an index is too large");
    let mut place = 0;
    while place < S::BRACKETS.len() {
        let (r, s, _) = S::BRACKETS[place];
        if r == i && s == j || r == j && s == i {
            return Some((place, r == j));
        }
        place += 1;
    }
    None
}

/// The commutator of two operators of the generated system `S`, resolved in its operators: the type behind `Bracket` of its module. It has
/// no values.
///
/// ```text
/// (X_I, X_J) = X_I X_J - X_J X_I = sum_t C_IJt X_t        t = 1 .. N
/// ```
///
/// `X_0` does not occur on the right: `d/dt` cancels. So the arrays have `N` entries, that of `X_t` at index `t - 1`.
///
/// For the system `sled`, `sled::Bracket::<1, 2>::COEFFICIENTS` costs nothing at run time: a `const` assertion on it lets a program refuse to
/// compile for a system that is not what it takes it for.
#[derive(Debug)]
pub struct Commutator<S, const I: usize, const J: usize, const N: usize>(PhantomData<fn() -> S>);

impl<S: Frame<N>, const I: usize, const J: usize, const N: usize> Commutator<S, I, J, N> {
    /// The coefficients `C_IJ1 .. C_IJN`, each with what the compiler proved.
    pub const COEFFICIENTS: [Coefficient; N] = known::<S, N>(I, J);

    /// The values of `C_IJ1 .. C_IJN` at time `t` and position `x`.
    #[inline]
    pub fn coefficients<B: Real, R: Real + Lift<B>>(prepared: &S::Over<B>, t: R, x: &[R; N]) -> [R; N] {
        match const { place::<S, N>(I, J) } {
            None => [R::zero(); N],
            Some((place, false)) => S::bracket(prepared, t, x, place),
            Some((place, true)) => S::bracket(prepared, t, x, place).map(|c| -c),
        }
    }
}

/// The facts known of the coefficients of the bracket `(X_i, X_j)`.
const fn known<S: Frame<N>, const N: usize>(i: usize, j: usize) -> [Coefficient; N] {
    let Some((place, reversed)) = place::<S, N>(i, j) else { return [Coefficient::Zero; N] };
    let mut known = S::BRACKETS[place].2;
    let mut t = 0;
    while reversed && t < N {
        if let Coefficient::Number { numerator, denominator } = known[t] {
            known[t] = Coefficient::Number { numerator: -numerator, denominator };
        }
        t += 1;
    }
    known
}
