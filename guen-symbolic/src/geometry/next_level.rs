//! The brackets of one level with `X_0..X_l` as numbers modulo the prime: which of them enlarge the rank is asked before any of them
//! is an expression.

use super::{Brackets, Forms, Operators};
use crate::algebra::ExprId;
use crate::workbench::Workbench;
use crate::zero::REDRAWS;
use crate::zero::field::{add, mul, rank};
use crate::zero::jets::{Moving, Tape};

/// Points at which ranks are looked at; the largest counts.
const RANK_POINTS: usize = 2;

/// The values at one point of a level.
struct Point {
    /// The values of the brackets that are kept.
    kept: Vec<Vec<u64>>,
    /// `[X_r, Y]^w` modulo `D_1`, by `Y`, `r` and `w`.
    brackets: Vec<Vec<Vec<u64>>>,
}

/// Places `(Y, r)` of the brackets `[X_r, Y]` that enlarge the rank of what is kept, at most `most` of them; `None` without points.
pub(super) fn enlarging(
    bench: &mut Workbench,
    geometry: (&Forms, &Operators, &Brackets),
    fresh: &[Vec<ExprId>],
    kept: &[Vec<ExprId>],
    most: usize,
) -> Option<Vec<(usize, usize)>> {
    let (forms, ..) = geometry;
    let mut points = points(bench, geometry, fresh, kept)?;
    let mut found = Vec::new();
    for y in 0..fresh.len() {
        for r in 0..=forms.degrees {
            if found.len() == most {
                return Some(found);
            }
            let rows = kept.len() + found.len() + 1;
            let enlarges = points.iter_mut().any(|point| {
                point.kept.truncate(rows - 1);
                point.kept.push(point.brackets[y][r].clone());
                rank(&point.kept) == rows
            });
            if enlarges {
                found.push((y, r));
            }
            // Whichever points were asked, each has the row, or none.
            for point in &mut points {
                point.kept.truncate(rows - 1);
                if enlarges {
                    point.kept.push(point.brackets[y][r].clone());
                }
            }
        }
    }
    Some(found)
}

/// The points at which everything has a value.
fn points(
    bench: &mut Workbench,
    geometry: (&Forms, &Operators, &Brackets),
    fresh: &[Vec<ExprId>],
    kept: &[Vec<ExprId>],
) -> Option<Vec<Point>> {
    let mut tape = Tape::default();
    let entries: Vec<ExprId> = fresh.iter().flatten().copied().collect();
    let nodes = tape.extend(&mut bench.graph, &entries);
    let mut points = Vec::new();
    for number in 0..REDRAWS + RANK_POINTS {
        let sample = bench.zero.fresh(&bench.graph, number, true)?;
        let mut moving = Moving::new(&bench.graph, &bench.zero, &tape, sample);
        points.extend(point(&mut moving, nodes, geometry, fresh, kept));
        if points.len() == RANK_POINTS {
            return Some(points);
        }
    }
    None
}

/// `[X_r, Y]^w = X_r(y^w) + sum_v y^v C_rvw` at a point: the first part is the rate of `y^w` along `x' = xi_r`.
fn point(
    moving: &mut Moving<'_>,
    nodes: usize,
    (forms, operators, brackets): (&Forms, &Operators, &Brackets),
    fresh: &[Vec<ExprId>],
    kept: &[Vec<ExprId>],
) -> Option<Point> {
    let kept = kept.iter().map(|y| moving.values(y)).collect::<Option<Vec<_>>>()?;
    let ys = fresh.iter().map(|y| moving.values(y)).collect::<Option<Vec<_>>>()?;
    let xi = operators.xi.iter().map(|xi| moving.values(xi)).collect::<Option<Vec<_>>>()?;
    let mut found = vec![Vec::new(); fresh.len()];
    for r in 0..=forms.degrees {
        let coefficients = brackets.values(moving, &xi, r)?;
        moving.set_rate(forms.time, u64::from(r == 0));
        for (x, rate) in forms.coordinates.iter().zip(&xi[r]) {
            moving.set_rate(*x, *rate);
        }
        moving.pass(0..nodes)?;
        for ((y, values), found) in fresh.iter().zip(&ys).zip(&mut found) {
            let bracket = y.iter().zip(&coefficients).map(|(e, row)| {
                let terms = values.iter().zip(row).filter(|(value, _)| **value != 0);
                terms.fold(moving.rate(*e), |sum, (value, c)| add(sum, mul(*value, *c)))
            });
            found.push(bracket.collect());
        }
    }
    Some(Point { kept, brackets: found })
}
