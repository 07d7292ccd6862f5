//! Whether a divisor may vanish: its value where a system rests, and at other states.

use crate::algebra::{Bound, Role, SymbolId, mix};
use crate::numbering::{Num, Numbering};
use crate::workbench::Workbench;

/// States that are looked at, the rest position first.
pub(super) const STATES: u64 = 4;

/// Values below this count as zero, of constants near one.
pub(super) const ZERO_BELOW: f64 = 1e-6;

/// The value at a state: the rest position first, then others; constants near one.
pub(super) fn real_value(bench: &Workbench, numbers: &Numbering, e: Num, state: u64) -> f64 {
    let graph = &bench.graph;
    let value = |symbol: SymbolId| {
        let info = graph.symbol_info(symbol);
        let draw = mix(mix(state ^ 0x706c_616e) ^ symbol.index() as u64) >> 11;
        let part = draw as f64 / (1_u64 << 53) as f64;
        let moves = !matches!(info.role, Role::Constant);
        match info.bound {
            _ if moves && state == 0 => 0.0,
            _ if moves => 2.0 * part - 1.0,
            Bound::Negative | Bound::NonPositive => -0.7 - 0.6 * part,
            _ => 0.7 + 0.6 * part,
        }
    };
    numbers.evaluate(graph, &[e], &value)[0]
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
