//! Whether a divisor may vanish: its value where a system rests, and at other states.

use crate::algebra::{ExprId, Graph, Role, SignBound, SymbolId, mix};
use crate::geometry::Form;
use crate::numbering::{Num, Numbering};
use crate::workbench::Workbench;

/// States near the rest position that are looked at, that first.
pub(super) const STATES: u64 = 4;

/// States that are looked at for a change of sign, those near the rest position first.
const FAR_STATES: u64 = 12;

/// Coordinates of the states that are not near the rest position are within: nearly half a turn.
const FAR: f64 = 3.0;

/// Values below this count as zero, of constants near one.
pub(super) const ZERO_BELOW: f64 = 1e-6;

/// Halvings of the way between two states until the place is found where a divisor vanishes.
const HALVINGS: usize = 60;

/// The determinant of the forms counts as zero below this share of what it is elsewhere.
const SINGULAR_BELOW: f64 = 1e-9;

/// The value of a symbol at a state: the rest position first, then others; constants near one.
fn at_state(graph: &Graph, symbol: SymbolId, state: u64) -> f64 {
    let info = graph.symbol_info(symbol);
    let draw = mix(mix(state ^ 0x706c_616e) ^ symbol.index() as u64) >> 11;
    let part = draw as f64 / (1_u64 << 53) as f64;
    let moves = !matches!(info.role, Role::Constant);
    let range = if state < STATES { 1.0 } else { FAR };
    match info.bound {
        _ if moves && state == 0 => 0.0,
        _ if moves => range * (2.0 * part - 1.0),
        SignBound::Negative | SignBound::NonPositive => -0.7 - 0.6 * part,
        _ => 0.7 + 0.6 * part,
    }
}

/// The value at a state.
pub(super) fn real_value(bench: &Workbench, numbers: &Numbering, e: Num, state: u64) -> f64 {
    numbers.evaluate(&bench.graph, &[e], &|symbol| at_state(&bench.graph, symbol, state))[0]
}

/// Whether a divisor vanishes at no state that is looked at, nor between two of them but where the forms are dependent: there no way
/// to the rates has values.
pub(super) fn is_safe(bench: &Workbench, numbers: &Numbering, forms: &[Form], divisor: Num) -> bool {
    let values: Vec<f64> = (0..FAR_STATES).map(|state| real_value(bench, numbers, divisor, state)).collect();
    (0..FAR_STATES).zip(&values).all(|(state, value)| match value.is_nan() {
        // Far away not every root has a value.
        true => state >= STATES,
        false if value.abs() < ZERO_BELOW => false,
        false => {
            let keeps_sign = value.signum() == values[0].signum();
            keeps_sign || is_singular_between(bench, numbers, forms, divisor, state)
        }
    })
}

/// Whether the forms are dependent where a divisor vanishes between the rest position and a state at which it has the other sign.
fn is_singular_between(
    bench: &Workbench,
    numbers: &Numbering,
    forms: &[Form],
    divisor: Num,
    state: u64,
) -> bool {
    let graph = &bench.graph;
    let at = |share: f64, symbol: SymbolId| {
        (1.0 - share) * at_state(graph, symbol, 0) + share * at_state(graph, symbol, state)
    };
    let value = |share: f64| numbers.evaluate(graph, &[divisor], &|symbol| at(share, symbol))[0];
    let (mut before, mut after) = (0.0, 1.0);
    let sign = value(before).signum();
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        if value(middle).signum() == sign { before = middle } else { after = middle }
    }
    let entries: Vec<ExprId> = forms.iter().flat_map(|form| form.row.iter().copied()).collect();
    let determinant = |share: f64| {
        let values = crate::zero::evaluate_f64(graph, &entries, &|symbol| at(share, symbol));
        determinant(values.chunks(forms.len()).map(<[f64]>::to_vec).collect())
    };
    let elsewhere = f64::max(determinant(0.0).abs(), determinant(1.0).abs());
    determinant(0.5 * (before + after)).abs() < SINGULAR_BELOW * elsewhere
}

fn determinant(mut rows: Vec<Vec<f64>>) -> f64 {
    let mut product = 1.0;
    for column in 0..rows.len() {
        let size = |row: &Vec<f64>| row[column].abs();
        let largest = (column..rows.len()).max_by(|i, k| size(&rows[*i]).total_cmp(&size(&rows[*k])));
        let Some(largest) = largest else { return product };
        rows.swap(column, largest);
        let pivot = rows[column][column];
        product *= pivot;
        if pivot == 0.0 {
            return 0.0;
        }
        let (above, below) = rows.split_at_mut(column + 1);
        for row in below {
            let factor = row[column] / pivot;
            for (e, own) in row[column..].iter_mut().zip(&above[column][column..]) {
                *e -= factor * own;
            }
        }
    }
    product
}

/// Whether vectors in space are independent.
pub(super) fn independent(vectors: &[[f64; 3]]) -> bool {
    let length = |v: &[f64; 3]| v.iter().map(|e| e * e).sum::<f64>().sqrt();
    match vectors {
        [a] => length(a) > ZERO_BELOW,
        [a, b] => {
            let product = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            length(&product) > ZERO_BELOW * length(a) * length(b)
        }
        [a, b, c] => {
            let determinant = a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            determinant.abs() > ZERO_BELOW * length(a) * length(b) * length(c)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cosine is positive within a radian of the rest position; forms that are dependent where it vanishes make it safe.
    #[test]
    fn a_cosine_is_safe_where_the_forms_vanish_with_it_alone() {
        let mut bench = Workbench::new(Graph::new());
        let angle = bench.graph.symbol("q", Role::Coordinate);
        let (_, cosine) = bench.graph.sin_cos(angle);
        let (zero, one) = (bench.graph.zero(), bench.graph.one());
        let generation = bench.zero.generation();
        let mut numbers = Numbering::new(&mut bench.graph, (0, false), generation);
        let divisor = numbers.import(&mut bench, cosine);
        let form = |entry: ExprId| [Form { row: vec![entry], offset: zero }];
        assert!(!is_safe(&bench, &numbers, &form(one), divisor));
        assert!(is_safe(&bench, &numbers, &form(cosine), divisor));
        let two = bench.graph.add(one, one);
        let raised = bench.graph.add(two, cosine);
        let raised = numbers.import(&mut bench, raised);
        assert!(is_safe(&bench, &numbers, &form(one), raised));
    }
}
