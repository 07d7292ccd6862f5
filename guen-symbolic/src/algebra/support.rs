//! Sets of symbols that tell quickly that none of them occurs.

use super::symbol::Roles;

/// A set of symbols, approximately: their roles, and one bit of 64 for each symbol, chosen by its number among those of its role. Two sets that do not
/// meet have no symbol in common; two that meet may have none in common either.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct Support {
    roles: Roles,
    bits: u64,
}

impl Support {
    /// The symbol that is the `ordinal`-th of its role.
    pub(super) fn of_symbol(roles: Roles, ordinal: u32) -> Self {
        Support { roles, bits: 1 << (ordinal % u64::BITS) }
    }

    /// The symbols of both.
    pub(super) fn or(self, other: Support) -> Self {
        Support { roles: self.roles.or(other.roles), bits: self.bits | other.bits }
    }

    pub(super) fn roles(self) -> Roles {
        self.roles
    }

    /// Whether the set has no symbol.
    pub(super) fn is_empty(self) -> bool {
        self.bits == 0
    }

    /// Whether some symbol may be in both.
    pub(crate) fn meets(self, other: Support) -> bool {
        self.roles.meets(other.roles) && self.bits & other.bits != 0
    }
}

#[cfg(test)]
mod tests {
    use crate::{Flow, Graph, Role, Substitution};

    /// Symbols that share their bit are told apart by what is done with them.
    #[test]
    fn more_symbols_than_bits_are_kept_apart() {
        let mut g = Graph::new();
        let x: Vec<_> = (0..130).map(|k| g.symbol(&format!("x{k}"), Role::Coordinate)).collect();
        let products: Vec<_> = (1..x.len()).map(|k| g.mul(x[k - 1], x[k])).collect();
        let sum = g.sum(products.clone());
        for k in [1, 64, 65, 128] {
            let slope = Flow::partial(&g, x[k]).of(&mut g, sum);
            assert_eq!(slope, g.add(x[k - 1], x[k + 1]));
            let zero = g.zero();
            let without = Substitution::new([(x[k], zero)]).of(&mut g, sum);
            let left = products.iter().enumerate().filter(|(place, _)| *place + 1 != k && *place != k);
            let left: Vec<_> = left.map(|(_, product)| *product).collect();
            assert_eq!(without, g.sum(left));
        }
        let constant = g.symbol("c", Role::Constant);
        assert!(!g.support(constant).meets(g.support(x[0])));
        assert!(g.support(x[64]).meets(g.support(x[0])));
        assert!(!g.support(x[65]).meets(g.support(x[0])));
    }
}
