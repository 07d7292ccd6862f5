//! Shapes: what an operation is made of, whatever member of a family it belongs to.

use std::cmp::Ordering;

use crate::algebra::{Graph, SymbolId, mix};

/// The number of operations below a node that its shape sees.
pub(super) const ROUNDS: usize = 5;

/// The shape of an operation, and the largest index that it sees: two operations of one shape differ in their indices by
/// the difference of these.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Shape {
    pub(super) hash: u64,
    pub(super) index: Option<i64>,
}

impl Shape {
    pub(super) fn of_kind(kind: u64) -> Self {
        Shape { hash: mix(kind ^ 0x5348 << 48), index: None }
    }

    /// The shape of an operation whose operands may change places.
    pub(super) fn joined(kind: u64, parts: &mut [Shape]) -> Self {
        let index = parts.iter().filter_map(|part| part.index).max();
        let mut hash = mix(kind ^ 0x4a4f << 48);
        // A sum over hashes does not depend on the order.
        let mut all: u64 = 0;
        for part in parts.iter() {
            all = all.wrapping_add(part.relative_to(index));
        }
        hash = mix(hash ^ all);
        Shape { hash, index }
    }

    /// The shape of an operation whose operands keep their places.
    pub(super) fn ordered(kind: u64, parts: &[Shape]) -> Self {
        let index = parts.iter().filter_map(|part| part.index).max();
        let mut hash = mix(kind ^ 0x4f52 << 48);
        for part in parts {
            hash = mix(hash.rotate_left(7) ^ part.relative_to(index));
        }
        Shape { hash, index }
    }

    pub(super) fn raised(self, exponent: i32) -> Self {
        if exponent == 1 { self } else { Shape { hash: mix(self.hash ^ exponent as u32 as u64), ..self } }
    }

    fn relative_to(&self, index: Option<i64>) -> u64 {
        let distance = match (self.index, index) {
            (Some(own), Some(index)) => (index - own) as u64,
            _ => u64::MAX,
        };
        mix(self.hash ^ mix(distance))
    }

    /// The order of terms: by shape, then by index.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        (self.hash, self.index).cmp(&(other.hash, other.index))
    }
}

/// The family and the index of each symbol: `q[3]` and `q3` are the fourth of `q`.
pub(super) struct Indices(Vec<Shape>);

impl Indices {
    pub(super) fn new(graph: &Graph) -> Self {
        Indices(graph.symbols().map(|symbol| of_name(&graph.symbol_info(symbol).name, symbol)).collect())
    }

    pub(super) fn of(&self, symbol: SymbolId) -> Shape {
        self.0.get(symbol.index()).copied().unwrap_or_default()
    }
}

fn of_name(name: &str, symbol: SymbolId) -> Shape {
    let hash = |text: &str, start: u64| {
        text.bytes().fold(start, |hash, byte| mix(hash.rotate_left(5) ^ u64::from(byte)))
    };
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let first = match name.find('[') {
        Some(bracket) => bracket + 1,
        None => name.trim_end_matches(|c: char| c.is_ascii_digit()).len(),
    };
    let (family, rest) = name.split_at(first);
    let (index, rest) = rest.split_at(digits(rest));
    // A family that is written out is the same family.
    let (family, rest) = (family.trim_end_matches('['), rest.trim_start_matches(']'));
    match index.parse() {
        Ok(index) if !family.is_empty() => Shape { hash: hash(rest, hash(family, 1)), index: Some(index) },
        _ => Shape { hash: hash(name, mix(u64::from(symbol.0))), index: None },
    }
}
