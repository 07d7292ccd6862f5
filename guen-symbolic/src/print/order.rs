//! The reader's order of factors and terms.

use std::cmp::Reverse;

use crate::algebra::{ExprId, Graph, Node, Role, Roles};

const MOTION: Roles =
    Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity)).or(Roles::of(Role::QuasiAcceleration));

/// The number of symbols above which the text of two functions decides their order.
const SYMBOLS_COMPARED: usize = 8;

/// The place of a factor in a product.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct FactorKey {
    class: u8,
    symbols: Vec<u32>,
    function: u64,
    text: String,
}

/// The place of a term in a sum.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct TermKey {
    accelerations: Reverse<u32>,
    velocities: Reverse<u32>,
    indices: Vec<u32>,
    degree: u32,
    factors: Vec<(FactorKey, Reverse<i32>)>,
}

impl FactorKey {
    /// The key of a base, from the symbols below it and its text.
    pub(super) fn new(graph: &Graph, base: ExprId, symbols: Vec<u32>, text: &str) -> Self {
        let roles = graph.roles(base);
        let class = match graph.node(base) {
            Node::Symbol(symbol) => match graph.symbol_info(*symbol).role {
                Role::Constant => 1,
                Role::Time => 4,
                Role::Coordinate => 5,
                Role::Velocity => 7,
                Role::QuasiVelocity => 8,
                Role::QuasiAcceleration => 9,
                Role::State => 10,
                Role::Input => 11,
            },
            _ if roles == Roles::NONE => 0,
            _ if roles.is_constant() => 2,
            _ if roles.meets(MOTION.or(Roles::of(Role::Input)).or(Roles::of(Role::State))) => 6,
            _ => 3,
        };
        let function = match graph.node(base) {
            Node::Function(function, _) => function.code(),
            _ => 0,
        };
        FactorKey { class, symbols, function, text: text.to_owned() }
    }
}

/// Adds the symbols below a child to those below its parent: the first few, in order.
pub(super) fn merge_symbols(symbols: &mut Vec<u32>, child: &[u32]) {
    let mut at = 0;
    let mut next = 0;
    while next < child.len() {
        let symbol = child[next];
        while at < symbols.len() && symbols[at] < symbol {
            at += 1;
        }
        if at == SYMBOLS_COMPARED {
            return;
        }
        if at == symbols.len() || symbols[at] != symbol {
            symbols.insert(at, symbol);
            symbols.truncate(SYMBOLS_COMPARED);
        }
        next += 1;
    }
}

impl TermKey {
    /// The key of the term with these factors, which are in the order of a product.
    pub(super) fn new(graph: &Graph, factors: Vec<(ExprId, FactorKey, i32)>) -> Self {
        let (mut accelerations, mut velocities, mut degree) = (0, 0, 0);
        let mut indices = Vec::new();
        for (base, _, e) in &factors {
            let count = e.unsigned_abs();
            let role =
                graph.as_symbol(*base).map(|symbol| (symbol.index() as u32, graph.symbol_info(symbol).role));
            match role {
                Some((_, Role::QuasiAcceleration)) => accelerations += count,
                Some((index, Role::Velocity | Role::QuasiVelocity)) => {
                    velocities += count;
                    // Exponents are small; the order beyond a few copies of one index tells nothing.
                    indices.extend(std::iter::repeat_n(index, count.min(8) as usize));
                }
                _ if graph.roles(*base).meets(MOTION) => {
                    velocities += count;
                    indices.push(u32::MAX);
                }
                _ => degree += count,
            }
        }
        TermKey {
            accelerations: Reverse(accelerations),
            velocities: Reverse(velocities),
            indices,
            degree,
            factors: factors.into_iter().map(|(_, key, e)| (key, Reverse(e))).collect(),
        }
    }
}
