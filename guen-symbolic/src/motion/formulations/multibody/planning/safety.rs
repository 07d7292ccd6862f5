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

/// Forms whose determinant is smaller than this share of the product of their sizes count as dependent.
const DEPENDENT_BELOW: f64 = 1e-12;

/// The values of symbols at a state.
type State<'a> = dyn Fn(SymbolId) -> f64 + 'a;

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
    let value = |at: &State<'_>| numbers.evaluate(graph, &[divisor], &|symbol| at(symbol))[0];
    vanishes_with_the_forms(graph, forms, &value, (0, state))
}

/// Whether the forms are dependent where a value vanishes that has other signs at two states: on the line between these.
fn vanishes_with_the_forms(
    graph: &Graph,
    forms: &[Form],
    value: &dyn Fn(&State<'_>) -> f64,
    (from, to): (u64, u64),
) -> bool {
    let at = |share: f64, symbol: SymbolId| {
        (1.0 - share) * at_state(graph, symbol, from) + share * at_state(graph, symbol, to)
    };
    let (mut before, mut after) = (0.0, 1.0);
    let sign = value(&|symbol| at(before, symbol)).signum();
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        if value(&|symbol| at(middle, symbol)).signum() == sign { before = middle } else { after = middle }
    }
    let determinant = |share: f64| determinant_of(graph, forms, &|symbol| at(share, symbol)).0;
    let elsewhere = f64::max(determinant(0.0).abs(), determinant(1.0).abs());
    determinant(0.5 * (before + after)).abs() < SINGULAR_BELOW * elsewhere
}

/// The determinant of forms at a state, and the product of their sizes there.
fn determinant_of(graph: &Graph, forms: &[Form], at: &State<'_>) -> (f64, f64) {
    let entries: Vec<ExprId> = forms.iter().flat_map(|form| form.row.iter().copied()).collect();
    let values = crate::zero::evaluate_f64(graph, &entries, &|symbol| at(symbol));
    let rows: Vec<Vec<f64>> = values.chunks(forms.len()).map(<[f64]>::to_vec).collect();
    let size = |row: &Vec<f64>| row.iter().fold(0.0_f64, |size, e| size.max(e.abs()));
    let sizes = rows.iter().map(size).product();
    (determinant(rows), sizes)
}

/// Whether forms are dependent only where some others are: at the states that are looked at, and between them.
pub(in crate::motion::formulations::multibody) fn are_regular_with(
    graph: &Graph,
    forms: &[Form],
    others: &[Form],
) -> bool {
    let of = |forms: &[Form], state: u64| {
        let (determinant, sizes) = determinant_of(graph, forms, &|symbol| at_state(graph, symbol, state));
        (determinant, determinant.abs() > DEPENDENT_BELOW * sizes)
    };
    let value = |at: &State<'_>| determinant_of(graph, forms, at).0;
    let mut first: Option<(u64, f64)> = None;
    (0..FAR_STATES).all(|state| {
        if !of(others, state).1 {
            return true;
        }
        let (own, is_regular) = of(forms, state);
        let (from, sign) = *first.get_or_insert((state, own));
        let keeps_sign = own.signum() == sign.signum();
        is_regular && (keeps_sign || vanishes_with_the_forms(graph, others, &value, (from, state)))
    }) && first.is_some()
}

fn determinant(mut rows: Vec<Vec<f64>>) -> f64 {
    let mut product = 1.0;
    for column in 0..rows.len() {
        let size = |row: &Vec<f64>| row[column].abs();
        let largest = (column..rows.len()).max_by(|i, k| size(&rows[*i]).total_cmp(&size(&rows[*k])));
        let Some(largest) = largest else { return product };
        rows.swap(column, largest);
        let pivot = rows[column][column];
        product *= if largest == column { pivot } else { -pivot };
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

    #[test]
    fn determinants_have_a_sign() {
        let rows = |order: [usize; 3]| {
            let rows = [[0.5, 2.0, 0.0], [1.0, 0.0, 0.25], [0.0, 1.0, -3.0]];
            order.map(|i| rows[i].to_vec()).to_vec()
        };
        let expected = 5.875;
        for (order, sign) in [([0, 1, 2], 1.0), ([1, 0, 2], -1.0), ([1, 2, 0], 1.0), ([2, 1, 0], -1.0)] {
            assert!((determinant(rows(order)) - sign * expected).abs() < 1e-14, "{order:?}");
        }
    }

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
        // So are forms beside others.
        let graph = &bench.graph;
        assert!(!are_regular_with(graph, &form(cosine), &form(one)));
        assert!(
            are_regular_with(graph, &form(cosine), &form(cosine))
                && are_regular_with(graph, &form(raised), &form(one))
        );
        assert!(!are_regular_with(graph, &form(one), &form(zero)));
        let raised = numbers.import(&mut bench, raised);
        assert!(is_safe(&bench, &numbers, &form(one), raised));
    }
}
