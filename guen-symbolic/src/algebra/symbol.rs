//! Symbols: what they stand for and what is promised about them.

/// The meaning of a symbol.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Role {
    /// The time `t`.
    Time,
    /// A physical constant.
    Constant,
    /// A coordinate `x_i`.
    Coordinate,
    /// The rate `x_i'` of a coordinate.
    Velocity,
    /// A quasi-velocity `eta_j`.
    QuasiVelocity,
    /// The rate `eta_s'` of a quasi-velocity.
    QuasiAcceleration,
    /// A control input.
    Input,
    /// A first-order state beside the motion, such as the current of a motor.
    State,
}

/// A set of [`Role`]s: which kinds of symbol occur below a node.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Roles(u8);

impl Roles {
    /// No role at all.
    pub const NONE: Roles = Roles(0);

    /// The set of one role.
    pub const fn of(role: Role) -> Self {
        Roles(1 << role as u8)
    }

    /// The union.
    pub const fn or(self, other: Roles) -> Self {
        Roles(self.0 | other.0)
    }

    /// Whether the role is in the set.
    pub const fn has(self, role: Role) -> bool {
        self.0 & (1 << role as u8) != 0
    }

    /// Whether both sets share a role.
    pub const fn meets(self, other: Roles) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether nothing beyond physical constants occurs.
    pub const fn is_constant(self) -> bool {
        self.0 & !Roles::of(Role::Constant).0 == 0
    }
}

/// The bound that a declaration promises for a physical constant.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum SignBound {
    /// No bound.
    #[default]
    Free,
    /// `c > 0`.
    Positive,
    /// `c >= 0`.
    NonNegative,
    /// `c < 0`.
    Negative,
    /// `c <= 0`.
    NonPositive,
    /// `c != 0`.
    NonZero,
}

/// A named symbol.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// The name in the declaration.
    pub name: String,
    /// The meaning of the symbol.
    pub role: Role,
    /// The promise about its value.
    pub bound: SignBound,
}
