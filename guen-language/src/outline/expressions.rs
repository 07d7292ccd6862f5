//! The few expressions that a trivial declaration is made of.

use proc_macro2::{Ident, Span};

use crate::syntax::{AddOperator, Expression, ExpressionKind, Name, Number, Term};

fn of(kind: ExpressionKind) -> Expression {
    Expression::new(Span::call_site(), kind)
}

/// `0` or `1`.
pub(super) fn number(value: u8) -> Expression {
    let (digits, text) = (value.to_string(), value.to_string());
    of(ExpressionKind::Number(Number { digits, exponent: 0, text }))
}

/// The value of a declared name.
pub(super) fn value(name: &Name) -> Expression {
    of(ExpressionKind::Name(name.clone()))
}

/// `function(arguments)`.
pub(super) fn call(function: &str, arguments: Vec<Expression>) -> Expression {
    let function = Name::new(Ident::new(function, Span::call_site()));
    of(ExpressionKind::Call { function, arguments, list: Span::call_site() })
}

/// `dot(name)`.
pub(super) fn rate(name: &Name) -> Expression {
    call("dot", vec![value(name)])
}

/// `base^2`.
pub(super) fn square(base: Expression) -> Expression {
    of(ExpressionKind::Power { base: Box::new(base), exponent: Box::new(number(2)) })
}

/// The sum of some terms; zero if there are none.
pub(super) fn sum(terms: impl IntoIterator<Item = Expression>) -> Expression {
    let span = Span::call_site();
    let rest = terms.into_iter().map(|value| Term { operator: AddOperator::Plus, span, value }).collect();
    of(ExpressionKind::Sum { first: Box::new(number(0)), rest })
}
