//! Functions as values: elementary ones, and those of several arguments.

/// An elementary function of one argument.
///
/// Tangent and cotangent are quotients of sine and cosine, the square root is the root of order two.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Function {
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Inverse sine.
    Asin,
    /// Inverse cosine.
    Acos,
    /// Inverse tangent.
    Atan,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent: kept whole, since a quotient would overflow where it is nearly one.
    Tanh,
    /// Absolute value.
    Abs,
    /// Sign: -1, 0 or 1.
    Sign,
    /// The largest integer that is not larger.
    Floor,
    /// The real root of the given order, at least two.
    Root(u32),
}

impl Function {
    /// A number for structural hashing.
    pub(crate) fn code(self) -> u64 {
        match self {
            Function::Sin => 1,
            Function::Cos => 2,
            Function::Asin => 3,
            Function::Acos => 4,
            Function::Atan => 5,
            Function::Exp => 6,
            Function::Ln => 7,
            Function::Sinh => 8,
            Function::Cosh => 9,
            Function::Tanh => 10,
            Function::Abs => 11,
            Function::Sign => 12,
            Function::Floor => 13,
            Function::Root(q) => 64 + u64::from(q),
        }
    }

    /// The name in the language; roots of an order above two are powers there.
    pub fn name(self) -> &'static str {
        match self {
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Asin => "asin",
            Function::Acos => "acos",
            Function::Atan => "atan",
            Function::Exp => "exp",
            Function::Ln => "ln",
            Function::Sinh => "sinh",
            Function::Cosh => "cosh",
            Function::Tanh => "tanh",
            Function::Abs => "abs",
            Function::Sign => "sign",
            Function::Floor => "floor",
            Function::Root(2) => "sqrt",
            Function::Root(_) => "root",
        }
    }

    pub(crate) fn is_odd(self) -> bool {
        use Function::{Asin, Atan, Root, Sign, Sin, Sinh, Tanh};
        match self {
            Sin | Asin | Atan | Sinh | Tanh | Sign => true,
            Root(q) => q % 2 == 1,
            _ => false,
        }
    }

    pub(crate) fn is_even(self) -> bool {
        matches!(self, Function::Cos | Function::Cosh | Function::Abs)
    }
}

/// The most arguments of a function that the program supplies.
pub const MAX_ARGUMENTS: usize = 8;

/// A function of several arguments.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Multivariate {
    /// `atan2(y, x)`, the angle of the point `(x, y)`.
    Atan2,
    /// `select(c, a, b)`: `a` where `c >= 0`, and `b` elsewhere.
    Select,
    /// The smaller of two.
    Minimum,
    /// The larger of two.
    Maximum,
    /// A smooth function that the program supplies, or a partial derivative of it.
    Supplied {
        /// The number among those of the graph.
        function: u16,
        /// The number of times that it is differentiated by each of its arguments.
        orders: [u8; MAX_ARGUMENTS],
    },
}

impl Multivariate {
    /// A number for structural hashing.
    pub(crate) fn code(self) -> u64 {
        match self {
            Multivariate::Atan2 => 1,
            Multivariate::Select => 2,
            Multivariate::Minimum => 3,
            Multivariate::Maximum => 4,
            Multivariate::Supplied { function, orders } => {
                super::id::mix(u64::from_le_bytes(orders) ^ u64::from(function) << 56) | 8
            }
        }
    }

    /// The name in the language; functions that the program supplies have their own.
    pub fn name(self) -> &'static str {
        match self {
            Multivariate::Atan2 => "atan2",
            Multivariate::Select => "select",
            Multivariate::Minimum => "min",
            Multivariate::Maximum => "max",
            Multivariate::Supplied { .. } => "supplied",
        }
    }

    /// Whether it is a choice between branches.
    pub fn is_choice(self) -> bool {
        matches!(self, Multivariate::Select | Multivariate::Minimum | Multivariate::Maximum)
    }
}

/// A function that the program supplies.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SuppliedFunction {
    /// The name in the declaration.
    pub name: String,
    /// The names of its arguments.
    pub arguments: Vec<String>,
}
