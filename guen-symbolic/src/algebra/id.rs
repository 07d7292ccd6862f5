//! Identifiers of expressions and symbols, and the hash of the tables that they are kept in.

/// An expression of a [`Graph`](super::Graph); children always have smaller identifiers than their parents.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ExprId(pub(crate) u32);

impl ExprId {
    /// The position in the graph's table of nodes.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A symbol of a [`Graph`](super::Graph).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct SymbolId(pub(crate) u32);

impl SymbolId {
    /// The position in the graph's table of symbols.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The finaliser of the splitmix64 generator (Steele, Lea, Flood 2014): a fixed mixing of 64 bits.
pub(crate) fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
