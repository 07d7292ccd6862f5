//! Coordinates near all equations at once, those that follow from the others among them: where Newton's method on the others alone ends on
//! another branch.

use super::positions::{Positions, distance, moved, size};
use crate::numbers::real::Ordered;

/// Steps of the search, trials among them.
const STEPS: usize = 200;
/// The first part of the diagonal that is added to it.
const FIRST_DAMPING: f64 = 1e-3;
/// The damping beyond which nothing gets smaller.
const LARGEST_DAMPING: f64 = 1e12;
/// The longest step over the largest coordinate of the guess.
const LONGEST: f64 = 2.0;
/// The length of a step and the distance from all equations, over the largest coordinate, at which a point is near enough for Newton's method.
const NEAR: f64 = 1e-7;

/// The equations of least squares at a point: `sum f^2`, `F^T F` and `F^T f`, each equation over the length that its gradient has at the guess.
struct Squares<const N: usize> {
    sum: f64,
    matrix: [[f64; N]; N],
    slope: [f64; N],
}

/// A point where all equations together are near zero, by damped least squares (Levenberg and Marquardt) from a guess. `None` where there
/// are no further equations, or no such point is found.
#[cold]
#[inline(never)]
pub(super) fn by_all<R, S, const N: usize, const H: usize>(
    system: &S,
    t: R,
    guess: &[R; N],
    free: &[bool; N],
) -> Option<[R; N]>
where
    R: Ordered,
    S: Positions<R, N, H> + ?Sized,
{
    let mut has_further = false;
    system.further(t, guess, &mut |_, _| has_further = true);
    if !has_further {
        return None;
    }
    let mut x = *guess;
    let mut extent = x.iter().fold(0.0_f64, |most, x| most.max(x.to_f64().abs()));
    let mut squares = measured(system, t, (&x, guess), free);
    let mut damping = FIRST_DAMPING;
    for _ in 0..STEPS {
        let step = damped_step(&squares, damping).map(R::from_f64);
        let length = size(&step);
        if !(squares.sum.is_finite() && length.is_finite()) || damping > LARGEST_DAMPING {
            return None;
        }
        if extent == 0.0 {
            extent = length;
        }
        // Far away angles have turned round.
        if length > LONGEST * extent {
            damping *= 4.0;
            continue;
        }
        let trial = moved(&x, &step, 1.0);
        let there = measured(system, t, (&trial, guess), free);
        if there.sum < squares.sum || length <= NEAR * extent {
            (x, squares) = (trial, there);
            damping /= 4.0;
            if length <= NEAR * extent {
                // Elsewhere the squares have a least value that is not zero.
                return (libm::sqrt(squares.sum) <= NEAR * extent).then_some(x);
            }
        } else {
            damping *= 4.0;
        }
    }
    None
}

/// Whether Newton's method ended where it began, near all equations.
pub(super) fn stayed<R: Ordered, const N: usize>(begin: &[R; N], end: &[R; N]) -> bool {
    let extent = begin.iter().fold(0.0_f64, |most, x| most.max(x.to_f64().abs()));
    distance(begin, end) <= libm::sqrt(NEAR) * extent
}

fn measured<R, S, const N: usize, const H: usize>(
    system: &S,
    t: R,
    (x, guess): (&[R; N], &[R; N]),
    free: &[bool; N],
) -> Squares<N>
where
    R: Ordered,
    S: Positions<R, N, H> + ?Sized,
{
    let mut squares = Squares { sum: 0.0, matrix: [[0.0; N]; N], slope: [0.0; N] };
    let of_free = |gradient: &[R; N]| -> [f64; N] {
        core::array::from_fn(|i| if free[i] { gradient[i].to_f64() } else { 0.0 })
    };
    let mut add = |gap: R, gradient: &[R; N], at_guess: &[R; N]| {
        let length = size(&of_free(at_guess));
        let scale = if length > 0.0 { 1.0 / length } else { 1.0 };
        let (gap, gradient) = (gap.to_f64() * scale, of_free(gradient).map(|entry| entry * scale));
        squares.sum += gap * gap;
        for i in 0..N {
            squares.slope[i] += gradient[i] * gap;
            for k in 0..N {
                squares.matrix[i][k] += gradient[i] * gradient[k];
            }
        }
    };
    let (gaps, gradients) = system.linearized(t, x);
    let (_, at_guess) = system.linearized(t, guess);
    for v in 0..H {
        add(gaps[v], &gradients[v], &at_guess[v]);
    }
    let mut place = 0;
    system.further(t, x, &mut |gap, gradient| {
        let (mut known, mut count) = ([R::zero(); N], 0);
        system.further(t, guess, &mut |_, gradient| {
            if count == place {
                known = *gradient;
            }
            count += 1;
        });
        add(gap, gradient, &known);
        place += 1;
    });
    squares
}

/// `-(F^T F + d)^-1 F^T f`, by Cholesky's elimination: the matrix is positive definite.
fn damped_step<const N: usize>(squares: &Squares<N>, damping: f64) -> [f64; N] {
    let mut matrix = squares.matrix;
    let mut step = squares.slope.map(|slope| -slope);
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += damping;
    }
    for k in 0..N {
        let pivot = matrix[k];
        for i in k + 1..N {
            let factor = matrix[i][k] / pivot[k];
            for (entry, above) in matrix[i].iter_mut().zip(pivot).skip(k) {
                *entry -= factor * above;
            }
            step[i] -= factor * step[k];
        }
    }
    for k in (0..N).rev() {
        for j in k + 1..N {
            step[k] -= matrix[k][j] * step[j];
        }
        step[k] /= matrix[k][k];
    }
    step
}
