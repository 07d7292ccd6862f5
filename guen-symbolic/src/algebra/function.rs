//! The elementary functions as values.

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
