//! Chooses the quasi-velocities that a declaration leaves out: rates of coordinates that complete its forms.
//!
//! If the rates of a set `S` of coordinates are taken as the missing forms, the declared forms, set to zero, give the velocities of the
//! other coordinates: `x' = -T x'_S`. A set is singular at a state where `T` does not
//! exist, and near such a state `T` is large: its *condition* at a state is `sqrt(1 + |T|^2)` in the norm of Frobenius, at least one,
//! and that of the set is the worst over states drawn at random, on the manifold of the holonomic constraints. It does not depend on
//! the scales of the forms.

use crate::algebra::{ExprId, Graph, Role, SymbolId};
use crate::zero::{drawn_states, evaluate_f64};

/// States at which sets are compared.
pub(super) const STATES: usize = 64;
/// A set is taken if its condition is at most so many times the best.
const CLOSE_TO_BEST: f64 = 10.0;
/// Multiplications for which all sets are compared; beyond, sets are improved by exchanges.
const MOST_WORK: usize = 20_000_000;
/// Rounds of exchanges.
const ROUNDS: usize = 20;
/// A pivot below this, beside rows of length one, is none.
const LEAST_PIVOT: f64 = 1e-9;

/// Coordinates whose rates complete forms.
#[derive(Clone, Debug, PartialEq)]
pub struct RateChoice {
    /// The coordinates, by place, in their order.
    pub coordinates: Vec<usize>,
    /// The condition at the worst of the states.
    pub condition: f64,
    /// The set with the least condition, and that condition.
    pub best: (Vec<usize>, f64),
}

/// Returns the lexicographically first set of coordinates whose rates complete forms, of those whose condition is within ten times
/// the best; if every set is singular at some state, so that the forms given are dependent, coordinates that could complete those of
/// them which are not.
///
/// `rows` are the coefficients of the velocities in the forms given, `equations` vanish on the manifold, `constant` is the value
/// at which a constant is drawn. All sets are compared where that is some millions of multiplications; for larger systems a set is improved
/// by exchanges, and the choice is the first of those seen. Where no set is regular at all states, constants are taken up to a fifth
/// larger or smaller, each by another factor, and states at which the forms given are dependent are left out.
///
/// ```
/// use guen_symbolic::{Graph, Role, chosen_rates};
/// // A blade: dot(x) sin(phi) - dot(y) cos(phi) = 0.
/// let mut g = Graph::new();
/// let [phi, x, y] = ["phi", "x", "y"].map(|name| g.symbol(name, Role::Coordinate));
/// let (s, c) = g.sin_cos(phi);
/// let row = vec![g.zero(), s, g.neg(c)];
/// let choice = chosen_rates(&mut g, &[row], &[], &[phi, x, y], &|_| 1.0).unwrap();
/// assert_eq!(choice.coordinates, [0, 1]);
/// ```
pub fn chosen_rates(
    graph: &mut Graph,
    rows: &[Vec<ExprId>],
    equations: &[ExprId],
    coordinates: &[ExprId],
    constant: &dyn Fn(SymbolId) -> f64,
) -> Result<RateChoice, Vec<usize>> {
    let matrices = at_states(graph, rows, equations, coordinates.len(), constant);
    if let Some(choice) = chosen(&matrices, coordinates.len()) {
        return Ok(choice);
    }
    // Lengths that are equal let a loop fold, and where it is folded some coordinate rests.
    let unequal = |symbol: SymbolId| constant(symbol) * (0.8 + 0.4 * fraction(symbol.index()));
    let mut regular = at_states(graph, rows, equations, coordinates.len(), &unequal);
    regular.retain(|matrix| pivots(matrix).len() == rows.len());
    chosen(&regular, coordinates.len()).ok_or_else(|| {
        let missing = coordinates.len().saturating_sub(rows.len());
        let taken = regular.first().or(matrices.first()).map(|matrix| pivots(matrix)).unwrap_or_default();
        (0..coordinates.len()).filter(|x| !taken.contains(x)).take(missing).collect()
    })
}

/// A number between zero and one: near ones differ for neighbours.
fn fraction(place: usize) -> f64 {
    (place as f64 * 0.618_033_988_749_894_9).fract()
}

/// The coefficients of forms at states on the manifold; states at which one is not finite are left out.
fn at_states(
    graph: &mut Graph,
    rows: &[Vec<ExprId>],
    equations: &[ExprId],
    coordinates: usize,
    constant: &dyn Fn(SymbolId) -> f64,
) -> Vec<Vec<Vec<f64>>> {
    let entries: Vec<ExprId> = rows.iter().flatten().copied().collect();
    let states = drawn_states(graph, equations, STATES, constant);
    let matrices = states.iter().map(|state| {
        let value = |symbol| match graph.symbol_info(symbol).role {
            Role::Constant if !state.is_known(symbol) => constant(symbol),
            _ => state.value(symbol),
        };
        let values = evaluate_f64(graph, &entries, &value);
        values.chunks(coordinates).map(<[f64]>::to_vec).collect()
    });
    matrices.filter(|matrix: &Vec<Vec<f64>>| matrix.iter().flatten().all(|entry| entry.is_finite())).collect()
}

/// The choice by the coefficients at states.
fn chosen(matrices: &[Vec<Vec<f64>>], coordinates: usize) -> Option<RateChoice> {
    let rows = matrices.first()?.len();
    let free = coordinates.checked_sub(rows)?;
    if rows == 0 {
        let all: Vec<usize> = (0..coordinates).collect();
        return Some(RateChoice { best: (all.clone(), 1.0), coordinates: all, condition: 1.0 });
    }
    let work = matrices.len() * rows * rows * coordinates;
    if sets(coordinates, free).saturating_mul(work) <= MOST_WORK {
        of_all(matrices, coordinates, free)
    } else {
        by_exchanges(matrices, coordinates)
    }
}

/// The number of sets of so many coordinates; the largest number where it is larger.
fn sets(coordinates: usize, free: usize) -> usize {
    (0..free).fold(1_usize, |sets, i| match sets.checked_mul(coordinates - i) {
        Some(product) => product / (i + 1),
        None => usize::MAX,
    })
}

/// Compares all sets.
fn of_all(matrices: &[Vec<Vec<f64>>], coordinates: usize, free: usize) -> Option<RateChoice> {
    let mut found: Vec<(Vec<usize>, f64)> = Vec::new();
    let mut best = f64::INFINITY;
    let mut set: Vec<usize> = (0..free).collect();
    loop {
        let others: Vec<usize> = (0..coordinates).filter(|x| !set.contains(x)).collect();
        let mut worst = 1.0_f64;
        for matrix in matrices {
            worst =
                worst.max(Solved::new(matrix, &others).map_or(f64::INFINITY, |solved| solved.condition()));
            // The best only gets better: what is too far from it now stays so.
            if worst > CLOSE_TO_BEST * best || worst.is_infinite() {
                break;
            }
        }
        if worst.is_finite() && worst <= CLOSE_TO_BEST * best {
            best = best.min(worst);
            found.push((set.clone(), worst));
        }
        // The next set in the order of words.
        let Some(i) = (0..free).rev().find(|i| set[*i] < coordinates - free + i) else { break };
        set[i] += 1;
        for k in i + 1..free {
            set[k] = set[k - 1] + 1;
        }
    }
    let (coordinates, condition) = found.iter().find(|(_, own)| *own <= CLOSE_TO_BEST * best)?.clone();
    let best = found.into_iter().find(|(_, own)| *own <= best)?;
    Some(RateChoice { coordinates, condition, best })
}

/// Improves one set, and then moves it to the front.
fn by_exchanges(matrices: &[Vec<Vec<f64>>], coordinates: usize) -> Option<RateChoice> {
    let others = pivots(matrices.first()?);
    if others.len() < matrices[0].len() {
        return None;
    }
    let mut all: Vec<Solved> =
        matrices.iter().map(|matrix| Solved::new(matrix, &others)).collect::<Option<_>>()?;
    let worst = |all: &[Solved]| all.iter().map(Solved::condition).fold(1.0, f64::max);
    let exchanged = |all: &[Solved], row: usize, column: usize| -> Option<Vec<Solved>> {
        all.iter().map(|solved| solved.exchanged(row, column)).collect()
    };
    let free =
        |all: &[Solved]| -> Vec<usize> { (0..coordinates).filter(|x| !all[0].others.contains(x)).collect() };
    let mut condition = worst(&all);
    for _ in 0..ROUNDS {
        let before = condition;
        for row in 0..others.len() {
            for column in free(&all) {
                if let Some(next) = exchanged(&all, row, column)
                    && worst(&next) < condition
                {
                    condition = worst(&next);
                    all = next;
                    break;
                }
            }
        }
        if condition >= before {
            break;
        }
    }
    let best = (free(&all), condition);
    for first in 0..coordinates {
        let Some(row) = all[0].others.iter().position(|x| *x == first) else { continue };
        for column in free(&all).into_iter().rev().take_while(|column| *column > first) {
            if let Some(next) = exchanged(&all, row, column)
                && worst(&next) <= CLOSE_TO_BEST * best.1
            {
                condition = worst(&next);
                all = next;
                break;
            }
        }
    }
    Some(RateChoice { coordinates: free(&all), condition, best })
}

/// Columns in which the rows are independent, as many as possible, by complete pivoting.
fn pivots(rows: &[Vec<f64>]) -> Vec<usize> {
    let mut rows = rows.to_vec();
    let mut columns = Vec::new();
    for done in 0..rows.len() {
        let entries = (done..rows.len()).flat_map(|i| (0..rows[i].len()).map(move |j| (i, j)));
        let largest = entries.max_by(|(i, j), (k, l)| rows[*i][*j].abs().total_cmp(&rows[*k][*l].abs()));
        let Some((i, j)) = largest else { break };
        rows.swap(done, i);
        if eliminate(&mut rows, done, j).is_none() {
            break;
        }
        columns.push(j);
    }
    columns
}

fn of_length_one(rows: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let scaled = |row: &Vec<f64>| {
        let length = row.iter().map(|a| a * a).sum::<f64>().sqrt();
        (length > 0.0).then(|| row.iter().map(|a| a / length).collect())
    };
    rows.iter().map(scaled).collect()
}

/// Divides a row by its entry in a column, and takes that column out of all others.
fn eliminate(rows: &mut [Vec<f64>], row: usize, column: usize) -> Option<()> {
    let pivot = rows[row][column];
    if pivot.abs().is_nan() || pivot.abs() < LEAST_PIVOT {
        return None;
    }
    rows[row].iter_mut().for_each(|a| *a /= pivot);
    let own = rows[row].clone();
    for other in rows.iter_mut().enumerate().filter(|(i, _)| *i != row).map(|(_, other)| other) {
        let share = other[column];
        if share != 0.0 {
            other.iter_mut().zip(&own).for_each(|(a, b)| *a -= share * b);
        }
    }
    Some(())
}

/// Forms at a state, solved for the velocities of some coordinates.
struct Solved {
    /// One row for each of those coordinates, with a one in its column.
    rows: Vec<Vec<f64>>,
    /// The coordinates that are solved for.
    others: Vec<usize>,
}

impl Solved {
    fn new(rows: &[Vec<f64>], others: &[usize]) -> Option<Self> {
        let mut rows = of_length_one(rows)?;
        for (done, column) in others.iter().enumerate() {
            let largest = (done..rows.len())
                .max_by(|i, k| rows[*i][*column].abs().total_cmp(&rows[*k][*column].abs()))?;
            rows.swap(done, largest);
            eliminate(&mut rows, done, *column)?;
        }
        Some(Solved { rows, others: others.to_vec() })
    }

    /// `sqrt(1 + |T|^2)`.
    fn condition(&self) -> f64 {
        // Every row has a one of its own and zeros in the columns of the others.
        let all: f64 = self.rows.iter().flatten().map(|a| a * a).sum();
        (1.0 + all - self.rows.len() as f64).max(1.0).sqrt()
    }

    /// Solved for another coordinate in place of that of a row.
    fn exchanged(&self, row: usize, column: usize) -> Option<Self> {
        let mut rows = self.rows.clone();
        eliminate(&mut rows, row, column)?;
        let mut others = self.others.clone();
        others[row] = column;
        Some(Solved { rows, others })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn drawn(states: usize, rows: usize, columns: usize) -> Vec<Vec<Vec<f64>>> {
        let seed = &mut 7;
        let mut matrix = || {
            (0..rows).map(|_| (0..columns).map(|_| random(seed)).collect::<Vec<f64>>()).collect::<Vec<_>>()
        };
        (0..states).map(|_| matrix()).collect()
    }

    /// The condition by its definition, with Cramer's rule for two forms.
    #[test]
    fn conditions_are_those_of_the_definition() {
        for matrix in drawn(20, 2, 5) {
            let (p, q) = (1, 3);
            let det = |a: usize, b: usize| matrix[0][a] * matrix[1][b] - matrix[0][b] * matrix[1][a];
            let entries = [0, 2, 4].iter().flat_map(|s| [det(*s, q) / det(p, q), det(p, *s) / det(p, q)]);
            let expected = (1.0 + entries.map(|t| t * t).sum::<f64>()).sqrt();
            let condition = Solved::new(&matrix, &[p, q]).unwrap().condition();
            assert!((condition / expected - 1.0).abs() < 1e-9, "{condition} {expected}");
        }
    }

    #[test]
    fn exchanges_solve_for_what_they_say() {
        for matrix in drawn(10, 3, 6) {
            let solved = Solved::new(&matrix, &[0, 1, 2]).unwrap().exchanged(1, 4).unwrap();
            let direct = Solved::new(&matrix, &[0, 4, 2]).unwrap();
            assert_eq!(solved.others, [0, 4, 2]);
            assert!((solved.condition() / direct.condition() - 1.0).abs() < 1e-9);
        }
    }

    /// A coordinate whose velocity vanishes in every motion has a rate that nobody may take.
    #[test]
    fn singular_sets_are_not_taken() {
        let fixed = vec![vec![vec![1.0, 0.0, 0.0]]; 4];
        assert_eq!(chosen(&fixed, 3).unwrap().coordinates, [1, 2]);
        // A row of zeros, or one row twice: no set completes them.
        assert_eq!(chosen(&vec![vec![vec![0.0; 3]]; 4], 3), None);
        assert_eq!(chosen(&vec![vec![vec![1.0, 2.0, 3.0]; 2]; 4], 3), None);
    }

    /// Twelve times the best is too far, eight times is not.
    #[test]
    fn sets_within_ten_times_the_best_are_close() {
        for (size, first) in [(12.0, [1]), (8.0, [0])] {
            // With the first coordinate chosen the other moves `size` times as fast.
            let choice = chosen(&[vec![vec![-size, 1.0]]], 2).unwrap();
            assert_eq!(choice.coordinates, first);
            assert_eq!(choice.best.0, [1]);
        }
    }

    /// Both ways find sets within ten times the same best, and the exchanges none that is singular.
    #[test]
    fn exchanges_find_close_sets() {
        for (rows, columns) in [(1, 6), (3, 7), (4, 6)] {
            let matrices = drawn(8, rows, columns);
            let all = of_all(&matrices, columns, columns - rows).unwrap();
            let exchanged = by_exchanges(&matrices, columns).unwrap();
            assert!(exchanged.best.1 >= all.best.1 * (1.0 - 1e-9));
            assert!(exchanged.best.1 < 3.0 * all.best.1, "{} {}", exchanged.best.1, all.best.1);
            assert!(exchanged.condition <= 10.0 * exchanged.best.1 * (1.0 + 1e-9));
            assert_eq!(exchanged.coordinates.len(), columns - rows);
        }
    }

    /// `x y = 0` has two branches, and on one of them it says the same as a rate that is given.
    #[test]
    fn branches_on_which_what_is_given_is_dependent_are_left_out() {
        for given in 0..2 {
            let mut g = Graph::new();
            let [x, y, z] = ["x", "y", "z"].map(|name| g.symbol(name, Role::Coordinate));
            let (zero, product) = (g.zero(), g.mul(x, y));
            let mut rate = vec![zero; 3];
            rate[given] = g.one();
            let rows = [vec![y, x, zero], rate];
            let choice = chosen_rates(&mut g, &rows, &[product], &[x, y, z], &|_| 1.0);
            assert_eq!(choice.unwrap().coordinates, [2]);
        }
    }

    #[test]
    fn sets_are_counted() {
        assert_eq!([sets(7, 3), sets(28, 14), sets(5, 0)], [35, 40_116_600, 1]);
        assert_eq!(sets(200, 100), usize::MAX);
    }
}
