//! Nodes of the graph.

use super::function::{Function, Multivariate};
use super::id::{ExprId, SymbolId};
use super::rational::Rational;

/// A node of the graph, in normal form.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Node {
    /// An exact number.
    Number(Rational),
    /// The number pi.
    Pi,
    /// A symbol.
    Symbol(SymbolId),
    /// `constant + sum coefficient * term`; at least one term, and more than that or not simply `1 * term`.
    Sum {
        /// The number added.
        constant: Rational,
        /// Terms with coefficients that are not zero, in the graph's order.
        terms: Box<[(ExprId, Rational)]>,
    },
    /// `product base^exponent`; exponents are not zero; not simply `base^1`.
    Product(Box<[(ExprId, i32)]>),
    /// An elementary function of one argument.
    Function(Function, ExprId),
    /// A function of several arguments.
    Multivariate(Multivariate, Box<[ExprId]>),
    /// An expression that is kept whole: equal to what is inside, but neither flattened nor expanded into its users.
    Kept(ExprId),
    /// The result of a division by the number zero; whoever divides asks first, so that it shows a mistake of ours.
    Undefined,
}

/// The reason why a power was refused.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PowerError {
    /// The exponent is not a number.
    ExponentNotNumber,
    /// The exponent, or the number that would result, is too large.
    TooLarge,
    /// An even root of a negative number.
    NegativeBase,
    /// A negative power of zero.
    DivisionByZero,
}

/// Returns the common factor of all coefficients of a sum, with the sign of the first.
pub(super) fn content_of(constant: &Rational, terms: &[(ExprId, Rational)]) -> Rational {
    let mut content = constant.abs();
    let mut index = 0;
    while index < terms.len() {
        content = content.content_gcd(&terms[index].1);
        index += 1;
    }
    if terms[0].1.is_negative() { -content } else { content }
}
