//! Tells rows that are independent, at states where equations hold, by numbers.

use super::rates::STATES;
use crate::algebra::{ExprId, Graph, Role, SymbolId};
use crate::zero::{drawn_states, evaluate_f64};

/// The remainder of a row, beside its own size, where it depends on others: rounding of some dozens of operations and of the
/// projection of the state is far below it.
const DEPENDENT_REMAINDER: f64 = 1e-7;

/// Returns for each row whether it is independent of those before it, and which rows depend on each other.
///
/// The rows are compared at states where the equations hold, with constants at the values of `constant`: unlike points modulo a prime,
/// these keep the constants. A row counts as dependent where it is at most of the states.
///
/// ```
/// use guen_symbolic::{Graph, Role, independent_rows};
/// // At equal angles (1, sin a) and (1, sin b) are the same row.
/// let mut g = Graph::new();
/// let [a, b] = ["a", "b"].map(|name| g.symbol(name, Role::Coordinate));
/// let ((sin_a, _), (sin_b, _)) = (g.sin_cos(a), g.sin_cos(b));
/// let rows = [vec![g.one(), sin_a], vec![g.one(), sin_b]];
/// let equation = g.sub(a, b);
/// assert_eq!(independent_rows(&mut g, &rows, &[equation], &|_| 1.0).0, [true, false]);
/// assert_eq!(independent_rows(&mut g, &rows, &[], &|_| 1.0).0, [true, true]);
/// ```
pub fn independent_rows(
    graph: &mut Graph,
    rows: &[Vec<ExprId>],
    equations: &[ExprId],
    constant: &dyn Fn(SymbolId) -> f64,
) -> (Vec<bool>, Vec<bool>) {
    let entries: Vec<ExprId> = rows.iter().flatten().copied().collect();
    let (mut votes, mut together, mut states) = (vec![0; rows.len()], vec![0; rows.len()], 0);
    for state in drawn_states(graph, equations, STATES, constant) {
        let value = |symbol| match graph.symbol_info(symbol).role {
            Role::Constant if !state.is_known(symbol) => constant(symbol),
            _ => state.value(symbol),
        };
        let values = evaluate_f64(graph, &entries, &value);
        if values.iter().any(|value| !value.is_finite()) {
            continue;
        }
        states += 1;
        let width = rows.first().map_or(0, Vec::len);
        let (free, related) = at_a_state(&values.chunks(width.max(1)).collect::<Vec<_>>());
        for (vote, free) in votes.iter_mut().zip(free) {
            *vote += usize::from(free);
        }
        for (vote, related) in together.iter_mut().zip(related) {
            *vote += usize::from(related);
        }
    }
    // Without any state nothing speaks against a row.
    let most = |votes: Vec<usize>, none: bool| {
        votes.into_iter().map(|votes| if states == 0 { none } else { 2 * votes > states }).collect()
    };
    (most(votes, true), most(together, false))
}

/// The rows that are independent of those before them, and the rows that take part in a relation.
fn at_a_state(rows: &[&[f64]]) -> (Vec<bool>, Vec<bool>) {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let (mut free, mut related) = (vec![false; rows.len()], vec![false; rows.len()]);
    // Orthonormal vectors, each with its coefficients by the rows.
    let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for (place, row) in rows.iter().enumerate() {
        let size = dot(row, row).sqrt();
        let mut rest = row.to_vec();
        let mut made_of = vec![0.0; rows.len()];
        made_of[place] = 1.0;
        // Twice, so that rounding of the first time is gone.
        for _ in 0..2 {
            for (vector, coefficients) in &basis {
                let along = dot(&rest, vector);
                rest.iter_mut().zip(vector).for_each(|(rest, vector)| *rest -= along * vector);
                made_of.iter_mut().zip(coefficients).for_each(|(own, other)| *own -= along * other);
            }
        }
        let left = dot(&rest, &rest).sqrt();
        if left > DEPENDENT_REMAINDER * size {
            free[place] = true;
            rest.iter_mut().chain(&mut made_of).for_each(|x| *x /= left);
            basis.push((rest, made_of));
        } else {
            for (other, coefficient) in made_of.into_iter().enumerate() {
                related[other] |=
                    coefficient.abs() * dot(rows[other], rows[other]).sqrt() > DEPENDENT_REMAINDER * size;
            }
            related[place] = true;
        }
    }
    (free, related)
}

#[cfg(test)]
mod tests {
    use super::at_a_state;

    #[test]
    fn relations_name_their_rows() {
        let rows: [&[f64]; 4] = [&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[0.0, 2.0, 0.0], &[0.0, 0.0, 1.0]];
        let (free, related) = at_a_state(&rows);
        assert_eq!(free, [true, true, false, true]);
        assert_eq!(related, [false, true, true, false]);
        // The zero row depends on no other.
        assert_eq!(at_a_state(&[&[0.0, 0.0], &[1.0, 0.0]]), (vec![false, true], vec![true, false]));
    }
}
