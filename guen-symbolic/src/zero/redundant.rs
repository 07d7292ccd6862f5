//! Equations on positions that follow from others wherever all of them hold, although their gradients are independent elsewhere:
//! the closing equations of a mechanism that moves only because its axes stand as they do.
//!
//! What comes in are equations `f(t, x) = 0`. Points where all of them hold are found over the reals, from random starts. The rank of
//! the gradients there is what double precision says where it says that they are independent. A dependence is looked at in 237 bits: Newton's method on the independent equations alone has to end where the
//! others hold, and their gradients are combinations of those, to more than fifty digits. That is observed at points, and no proof.

use core::cmp::Reverse;

use f256::f256;

use super::manifold::solve_dense;
use super::positions::{Drawn, MotionEquations, dot};
use super::real::{Real, RealPoint, exponent};
use crate::algebra::{ExprId, Function, Graph};

/// An equation that follows from others where all of them hold.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Redundant {
    /// The equation, by its place.
    pub equation: usize,
    /// The equations whose gradients its own is a combination of.
    pub beside: Vec<usize>,
}

/// Points that must show the same dependence.
const POINTS: usize = 4;
/// Starts of the search for points at most, and the solutions of linear equations for which there is time, by the cube of their number.
const MOST_STARTS: usize = 40;
const MOST_WORK: usize = 4_000_000;
/// The remainder beside those before it from which on a gradient of length one is taken in its order.
const CLEARLY: f64 = 0.02;
/// A gradient of length one with so much left beside the others is independent of them.
const INDEPENDENT: f64 = 1e-4;
/// The rest of a gradient of length one below which it is a combination of the others, as far as double precision tells.
const DEPENDENT: f64 = 1e-7;
/// Newton's steps in 237 bits.
const POLISH_STEPS: usize = 5;
/// The power of two below which a value in 237 bits counts as zero.
const ZERO_EXPONENT: f64 = -180.0;

/// A point where the gradients are dependent: they, and those that all others are combinations of.
struct Point {
    gradients: Vec<Vec<f64>>,
    chosen: Vec<usize>,
}

/// The equations that follow from others wherever all hold; none where that is not observed.
pub(super) fn find(graph: &mut Graph, equations: &[ExprId]) -> Vec<Redundant> {
    let count = equations.len();
    let equations = MotionEquations::new(graph, equations);
    let mut points: Vec<Point> = Vec::new();
    for start in 0..(MOST_WORK / (count * count * count)).clamp(POINTS, MOST_STARTS) {
        let drawn = RealPoint::new(start as u64);
        let drawn = |symbol| drawn.draw(equations.graph, symbol);
        // Constants stay as they are drawn at every other start: where they move, lengths like to vanish, and where they stay,
        // those of a loop may be unable to close it.
        let Some(x) = equations.point(&drawn, start % 2 == 1) else { continue };
        let gradients = equations.gradients(&x, &drawn);
        let Some(chosen) = independent(&gradients) else { continue };
        if chosen.len() == count {
            return Vec::new();
        }
        if equations.confirm(&x, &drawn, &chosen) {
            points.push(Point { gradients, chosen });
        }
    }
    // A mechanism may move in several ways, some of them with more freedom where bars coincide. The rank is the largest that was
    // seen, and what is left out serves at most points: elsewhere the forms become dependent, an edge of the chart.
    let rank = points.iter().map(|point| point.chosen.len()).max().unwrap_or(0);
    points.retain(|point| point.chosen.len() == rank);
    let serves = |chosen: &[usize]| {
        points
            .iter()
            .map(|point| least(&point.gradients, chosen))
            .filter(|least| *least > INDEPENDENT)
            .count()
    };
    let sets = points.iter().map(|point| &point.chosen);
    // Of sets that serve alike that of the equations which come first.
    let Some(chosen) = sets.max_by_key(|chosen| (serves(chosen), Reverse(*chosen))) else {
        return Vec::new();
    };
    if serves(chosen) < POINTS {
        return Vec::new();
    }
    let left = (0..count).filter(|equation| !chosen.contains(equation));
    left.map(|equation| Redundant { equation, beside: beside(&points, chosen, equation) }).collect()
}

impl MotionEquations<'_> {
    /// The gradients by the coordinates, in units of their lengths where the search began: of its own length every gradient would
    /// seem to be long, even one that vanishes.
    fn gradients(&self, x: &[f64], drawn: Drawn<'_>) -> Vec<Vec<f64>> {
        let begin: Vec<f64> = self.variables.iter().map(|s| drawn(*s)).collect();
        let ((_, first), (_, rows)) = (self.values(&begin, drawn), self.values(x, drawn));
        let rows = rows.into_iter().zip(first).map(|(row, first)| {
            let first = self.by_coordinates(first);
            let length = dot(&first, &first).sqrt();
            self.by_coordinates(row).into_iter().map(|a| a / length).collect()
        });
        rows.collect()
    }

    fn by_coordinates<R: Real>(&self, row: Vec<R>) -> Vec<R> {
        row.into_iter().zip(&self.moving).filter(|(_, moving)| **moving).map(|(a, _)| a).collect()
    }

    /// Whether at the point near by where the chosen equations hold in 237 bits the others hold, too, and have gradients that are
    /// combinations of those of the chosen.
    fn confirm(&self, x: &[f64], drawn: Drawn<'_>, chosen: &[usize]) -> bool {
        let mut x: Vec<f256> = x.iter().map(|x| f256::from(*x)).collect();
        let (mut f, mut rows) = self.values(&x, drawn);
        for _ in 0..POLISH_STEPS {
            let system = chosen.iter().map(|i| {
                let products = chosen.iter().map(|k| dot(&rows[*i], &rows[*k]));
                products.chain([f[*i]]).collect()
            });
            let Some(multipliers) = solve_dense(system.collect()) else { return false };
            for (j, x) in x.iter_mut().enumerate() {
                let step =
                    chosen.iter().zip(&multipliers).fold(f256::ZERO, |sum, (i, m)| sum + rows[*i][j] * *m);
                *x -= step;
            }
            (f, rows) = self.values(&x, drawn);
        }
        let is_nothing = |value: f256| value.is_finite() && exponent(value) < ZERO_EXPONENT;
        let mut rests: Vec<Vec<f256>> = rows.into_iter().map(|row| self.by_coordinates(row)).collect();
        for i in chosen {
            take(&mut rests, *i);
        }
        let follow =
            (0..rests.len()).filter(|i| !chosen.contains(i)).all(|i| rests[i].iter().all(|a| is_nothing(*a)));
        follow && f.into_iter().all(is_nothing)
    }
}

/// Takes the direction of one row out of all others.
fn take<R: Real>(rows: &mut [Vec<R>], chosen: usize) {
    let length = dot(&rows[chosen], &rows[chosen]).of(Function::Root(2));
    let direction: Vec<R> = rows[chosen].iter().map(|a| *a / length).collect();
    for row in rows.iter_mut() {
        // Twice is enough (Kahan and Parlett): what is left is orthogonal to rounding.
        for _ in 0..2 {
            let share = dot(row, &direction);
            for (a, d) in row.iter_mut().zip(&direction) {
                *a = *a - share * *d;
            }
        }
    }
}

/// Rows that all others are combinations of, in their order as far as they are clearly independent; none where it is not clear at
/// which row to end.
fn independent(gradients: &[Vec<f64>]) -> Option<Vec<usize>> {
    let mut rests = gradients.to_vec();
    let mut chosen: Vec<usize> = Vec::new();
    for i in 0..rests.len() {
        if dot(&rests[i], &rests[i]).sqrt() > CLEARLY {
            chosen.push(i);
            take(&mut rests, i);
        }
    }
    loop {
        let open = (0..rests.len()).filter(|i| !chosen.contains(i));
        let left: Vec<(usize, f64)> = open.map(|i| (i, dot(&rests[i], &rests[i]).sqrt())).collect();
        if left.iter().any(|(_, left)| left.is_nan()) {
            return None;
        }
        let most = left.iter().map(|(_, left)| *left).fold(0.0, f64::max);
        if most < DEPENDENT {
            chosen.sort_unstable();
            return Some(chosen);
        }
        if most < INDEPENDENT {
            return None;
        }
        let (next, _) = *left.iter().find(|(_, left)| *left >= most)?;
        chosen.push(next);
        take(&mut rests, next);
    }
}

/// Returns the smallest remainder of a chosen row beside those before it.
fn least(gradients: &[Vec<f64>], chosen: &[usize]) -> f64 {
    let mut rests = gradients.to_vec();
    let left = chosen.iter().map(|i| {
        let left = dot(&rests[*i], &rests[*i]).sqrt();
        take(&mut rests, *i);
        left
    });
    // NaN is no number to be chosen for.
    left.fold(f64::INFINITY, |least, left| {
        if left < least {
            left
        } else if left.is_nan() {
            0.0
        } else {
            least
        }
    })
}

/// The chosen equations that the gradient of another is a combination of.
fn beside(points: &[Point], chosen: &[usize], equation: usize) -> Vec<usize> {
    let mut found = Vec::new();
    for Point { gradients, .. } in points.iter().filter(|point| least(&point.gradients, chosen) > INDEPENDENT)
    {
        let system = chosen.iter().map(|i| {
            let products = chosen.iter().map(|k| dot(&gradients[*i], &gradients[*k]));
            products.chain([dot(&gradients[*i], &gradients[equation])]).collect()
        });
        let Some(shares) = solve_dense(system.collect()) else { continue };
        found.extend(chosen.iter().zip(shares).filter(|(_, share)| share.abs() > DEPENDENT).map(|(i, _)| *i));
    }
    found.sort_unstable();
    found.dedup();
    found
}
