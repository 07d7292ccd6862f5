//! Equations on positions that follow from others wherever all of them hold, although their gradients are independent elsewhere:
//! the closing equations of a mechanism that moves only because its axes stand as they do.
//!
//! What comes in are equations `f(t, x) = 0`. Points where all of them hold are found over the reals, from random starts, by the
//! method of Levenberg and Marquardt with a damping of `|f|^2`: it converges quadratically where gradients become dependent, too
//! (Yamashita and Fukushima 2001). The rank of the gradients there is what double precision says where it says that they are
//! independent. A dependence is looked at in 237 bits: Newton's method on the independent equations alone has to end where the
//! others hold, and their gradients are combinations of those, to more than fifty digits. That is observed at points, and no proof.

use core::cmp::Reverse;

use f256::f256;

use super::manifold::solve_dense;
use super::real::{Real, RealPoint, evaluate_in, exponent};
use crate::algebra::{Bound, ExprId, Flow, Function, Graph, Rational, Role, SymbolId};

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
/// Steps of one search.
const STEPS: usize = 120;
/// The remainder beside those before it from which on a gradient of length one is taken in its order.
const CLEARLY: f64 = 0.02;
/// A gradient of length one with so much left beside the others is independent of them.
const INDEPENDENT: f64 = 1e-4;
/// One with less left is a combination of them, as far as double precision tells.
const DEPENDENT: f64 = 1e-7;
/// Newton's steps in 237 bits.
const POLISH_STEPS: usize = 5;
/// The power of two below which a value in 237 bits counts as zero.
const ZERO_EXPONENT: f64 = -180.0;

/// The equations with their derivatives.
struct Equations<'a> {
    graph: &'a Graph,
    equations: &'a [ExprId],
    /// The equations, and their derivatives row by row.
    roots: Vec<ExprId>,
    /// The nodes of these, in an order in which they can be evaluated.
    order: Vec<ExprId>,
    /// The symbols along which a point may move: coordinates and constants.
    variables: Vec<SymbolId>,
    /// Tells for each variable whether it is a coordinate.
    moving: Vec<bool>,
}

/// A point where the gradients are dependent: they, and those that all others are combinations of.
struct Point {
    gradients: Vec<Vec<f64>>,
    chosen: Vec<usize>,
}

/// The equations that follow from others wherever all hold; none where that is not observed.
pub(super) fn find(graph: &mut Graph, equations: &[ExprId]) -> Vec<Redundant> {
    let count = equations.len();
    let equations = Equations::new(graph, equations);
    let mut points: Vec<Point> = Vec::new();
    for start in 0..(MOST_WORK / (count * count * count)).clamp(POINTS, MOST_STARTS) {
        let Some((x, others)) = equations.point(start as u64) else { continue };
        let gradients = equations.gradients(&x, &others);
        let Some(chosen) = independent(&gradients) else { continue };
        if chosen.len() == count {
            return Vec::new();
        }
        if equations.confirm(&x, &others, &chosen) {
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

impl<'a> Equations<'a> {
    fn new(graph: &'a mut Graph, equations: &'a [ExprId]) -> Self {
        let symbols = graph.symbols_in(equations).into_iter();
        let variables: Vec<SymbolId> = symbols
            .filter(|s| matches!(graph.symbol_info(*s).role, Role::Coordinate | Role::Constant))
            .collect();
        let mut flows: Vec<Flow> =
            variables.iter().map(|symbol| Flow::partial(graph, graph.symbol_expr(*symbol))).collect();
        let mut roots = equations.to_vec();
        for equation in equations {
            let own = graph.symbols_in(&[*equation]);
            let zero = graph.zero();
            roots.extend(
                variables.iter().zip(&mut flows).map(|(symbol, flow)| {
                    if own.contains(symbol) { flow.of(graph, *equation) } else { zero }
                }),
            );
        }
        let moving = variables.iter().map(|s| graph.symbol_info(*s).role == Role::Coordinate).collect();
        let order = graph.reachable(&roots, |_| false);
        Equations { graph, equations, roots, order, variables, moving }
    }

    /// Left sides and gradients by all variables.
    fn values<R: Real + From<f64>>(&self, x: &[R], others: &RealPoint) -> (Vec<R>, Vec<Vec<R>>) {
        let value = |symbol: SymbolId| match self.variables.iter().position(|own| *own == symbol) {
            Some(i) => x[i],
            None => R::from(others.draw(self.graph, symbol)),
        };
        let mut values = evaluate_in(self.graph, &self.order, &self.roots, &value);
        let jacobian = values.split_off(self.equations.len());
        (values, jacobian.chunks(self.variables.len().max(1)).map(<[R]>::to_vec).collect())
    }

    /// A point where all equations hold, in double precision. Constants stay as they are drawn at every other start: where they
    /// move, lengths like to vanish, and where they stay, those of a loop may be unable to close it.
    fn point(&self, start: u64) -> Option<(Vec<f64>, RealPoint)> {
        let moves: Vec<bool> = self.moving.iter().map(|moving| *moving || start % 2 == 1).collect();
        let others = RealPoint::new(start);
        let mut x: Vec<f64> = self.variables.iter().map(|s| others.draw(self.graph, *s)).collect();
        let size = |f: &[f64]| f.iter().map(|f| f * f).sum::<f64>();
        let mut damping = 1.0;
        let held = |mut rows: Vec<Vec<f64>>| {
            rows.iter_mut().for_each(|row| {
                row.iter_mut().zip(&moves).for_each(|(a, moves)| *a *= f64::from(u8::from(*moves)))
            });
            rows
        };
        let (mut f, rows) = self.values(&x, &others);
        let mut rows = held(rows);
        for _ in 0..STEPS {
            let left = size(&f);
            if !left.is_finite() {
                return None;
            }
            let mut system: Vec<Vec<f64>> = rows
                .iter()
                .zip(&f)
                .map(|(row, f)| rows.iter().map(|other| dot(row, other)).chain([*f]).collect())
                .collect();
            let mean = (0..f.len()).map(|i| system[i][i]).sum::<f64>() / f.len() as f64;
            for (i, row) in system.iter_mut().enumerate() {
                row[i] += mean * (damping * left.min(1.0)).max(1e-14);
            }
            let multipliers = solve_dense(system)?;
            let step = |j: usize| rows.iter().zip(&multipliers).map(|(row, m)| row[j] * m).sum::<f64>();
            let trial: Vec<f64> = x.iter().enumerate().map(|(j, x)| x - step(j)).collect();
            let length = x.iter().zip(&trial).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let (next, gradients) = self.values(&trial, &others);
            // Roundings may not make the last steps larger.
            if size(&next) <= left || left < 1e-20 {
                (x, f, rows) = (trial, next, held(gradients));
                damping = (damping / 4.0).max(1e-3);
                if length < 1e-11 {
                    break;
                }
            } else if damping > 1e12 {
                return None;
            } else {
                damping *= 8.0;
            }
        }
        let keeps = |(symbol, x): (&SymbolId, &f64)| match self.graph.symbol_info(*symbol).bound {
            Bound::Positive | Bound::NonNegative => *x > 1e-3,
            Bound::Negative | Bound::NonPositive => *x < -1e-3,
            Bound::Free | Bound::NonZero => true,
        };
        (size(&f) < 1e-20 && self.variables.iter().zip(&x).all(keeps)).then_some((x, others))
    }

    /// The gradients by the coordinates, in units of their lengths where the search began: of its own length every gradient would
    /// seem to be long, even one that vanishes.
    fn gradients(&self, x: &[f64], others: &RealPoint) -> Vec<Vec<f64>> {
        let begin: Vec<f64> = self.variables.iter().map(|s| others.draw(self.graph, *s)).collect();
        let ((_, first), (_, rows)) = (self.values(&begin, others), self.values(x, others));
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
    fn confirm(&self, x: &[f64], others: &RealPoint, chosen: &[usize]) -> bool {
        let mut x: Vec<f256> = x.iter().map(|x| f256::from(*x)).collect();
        let (mut f, mut rows) = self.values(&x, others);
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
            (f, rows) = self.values(&x, others);
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

fn dot<R: Real>(a: &[R], b: &[R]) -> R {
    a.iter().zip(b).fold(R::rational(&Rational::ZERO), |sum, (a, b)| sum + *a * *b)
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
