//! Expressions, by recursive descent: `sum`, `product`, `unary`, `power`, `postfix`, `primary`.
//!
//! What another language would write and what is clear nevertheless is reported, read as a missing value, and
//! passed over; only where no expression can begin is the whole given up.

#![expect(
    clippy::boxed_local,
    reason = "the recursion passes pointers on, and what it calls opens them beside its stack"
)]

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};

use super::cursor::Cursor;
use super::index::{begins_fold, fold_head, index_of};
use super::numbers::number;
use super::punctuation::unexpected;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_DEPTH;
use crate::names::{FOLDS, can_be_raw, is_rust_keyword};
use crate::syntax::{
    AddOperator, Expression, ExpressionKind, Factor, Fold, MultiplyOperator, Name, Number, Order, Range, Term,
};

/// Expressions are nested as deep as [`MAX_DEPTH`] allows, and an unoptimised build gives every value of a function a place of its own on
/// the stack. So what the recursion passes on is a pointer, and nodes and faults are made in functions that call nothing of it.
type Parsed = Result<Box<Expression>, Reported>;

/// An expression; it ends at the first token that cannot continue it.
pub(crate) fn expression(cursor: &mut Cursor, faults: &mut Faults) -> Result<Expression, Reported> {
    sum(cursor, faults, 0).map(|value| *value)
}

/// Reads all tokens of a stream as one expression.
pub(crate) fn whole(tokens: TokenStream, faults: &mut Faults) -> Expression {
    *inside(Cursor::new(tokens, Span::call_site()), faults, 0, "the end")
}

/// Reads everything up to the end of a cursor as one expression.
fn inside(mut cursor: Cursor, faults: &mut Faults, depth: usize, end: &str) -> Box<Expression> {
    let span = cursor.span();
    match sum(&mut cursor, faults, depth) {
        Ok(value) if cursor.is_end() => value,
        Ok(_) => {
            unexpected(&cursor, faults, end);
            missing(span)
        }
        Err(Reported { .. }) => missing(span),
    }
}

fn node(span: Span, kind: ExpressionKind) -> Box<Expression> {
    Box::new(Expression::new(span, kind))
}

fn missing(span: Span) -> Box<Expression> {
    Box::new(Expression::missing(span))
}

fn sum(cursor: &mut Cursor, faults: &mut Faults, depth: usize) -> Parsed {
    let first = product(cursor, faults, depth)?;
    let mut rest = Vec::new();
    while let Some(operator) = add_operator(cursor) {
        let span = cursor.span();
        cursor.skip(1);
        push_term(&mut rest, operator, span, product(cursor, faults, depth)?);
    }
    Ok(sum_of(first, rest))
}

fn add_operator(cursor: &Cursor) -> Option<AddOperator> {
    match cursor.peek() {
        Some(TokenTree::Punct(mark)) if mark.as_char() == '+' => Some(AddOperator::Plus),
        Some(TokenTree::Punct(mark)) if mark.as_char() == '-' => Some(AddOperator::Minus),
        _ => None,
    }
}

fn push_term(rest: &mut Vec<Term>, operator: AddOperator, span: Span, value: Box<Expression>) {
    rest.push(Term { operator, span, value: *value });
}

fn sum_of(first: Box<Expression>, rest: Vec<Term>) -> Box<Expression> {
    match rest.first() {
        None => first,
        Some(term) => node(term.span, ExpressionKind::Sum { first, rest }),
    }
}

fn product(cursor: &mut Cursor, faults: &mut Faults, depth: usize) -> Parsed {
    let first = unary(cursor, faults, depth)?;
    let mut rest = Vec::new();
    while let Some(operator) = multiply_operator(cursor) {
        let span = cursor.span();
        if cursor.is_pair('*', '*') {
            double_star(span, faults);
            cursor.skip(1);
        }
        cursor.skip(1);
        push_factor(&mut rest, operator, span, unary(cursor, faults, depth)?);
    }
    Ok(product_of(first, rest))
}

fn multiply_operator(cursor: &Cursor) -> Option<MultiplyOperator> {
    match cursor.peek() {
        Some(TokenTree::Punct(mark)) if mark.as_char() == '*' => Some(MultiplyOperator::Times),
        Some(TokenTree::Punct(mark)) if mark.as_char() == '/' => Some(MultiplyOperator::Over),
        _ => None,
    }
}

fn double_star(span: Span, faults: &mut Faults) {
    faults
        .report(Fault::new(span, "`**` is not an operator").help("a power is written with `^`, as in `a^b`"));
}

fn push_factor(rest: &mut Vec<Factor>, operator: MultiplyOperator, span: Span, value: Box<Expression>) {
    rest.push(Factor { operator, span, value: *value });
}

fn product_of(first: Box<Expression>, rest: Vec<Factor>) -> Box<Expression> {
    match rest.first() {
        None => first,
        Some(factor) => node(factor.span, ExpressionKind::Product { first, rest }),
    }
}

fn unary(cursor: &mut Cursor, faults: &mut Faults, depth: usize) -> Parsed {
    let span = cursor.span();
    if cursor.eat('-').is_some() {
        let depth = deeper(depth, span, faults)?;
        return Ok(negation(span, unary(cursor, faults, depth)?));
    }
    if cursor.eat('+').is_some() {
        sign_without_term(span, faults);
        let depth = deeper(depth, span, faults)?;
        return unary(cursor, faults, depth);
    }
    power(cursor, faults, depth)
}

fn negation(span: Span, operand: Box<Expression>) -> Box<Expression> {
    node(span, ExpressionKind::Negation(operand))
}

fn sign_without_term(span: Span, faults: &mut Faults) {
    faults.report(Fault::new(span, "`+` stands between two terms").help("remove this sign"));
}

fn power(cursor: &mut Cursor, faults: &mut Faults, depth: usize) -> Parsed {
    let base = postfix(cursor, faults, depth)?;
    let span = cursor.span();
    if cursor.eat('^').is_none() {
        return Ok(base);
    }
    root_without_parentheses(cursor, faults, &base);
    let depth = deeper(depth, span, faults)?;
    let exponent = unary(cursor, faults, depth)?;
    Ok(power_of(span, base, exponent))
}

fn power_of(span: Span, base: Box<Expression>, exponent: Box<Expression>) -> Box<Expression> {
    node(span, ExpressionKind::Power { base, exponent })
}

/// `x^1/2` would be half of `x`, and nobody writes that so. `x^2/2` is left alone: it is what it looks like.
fn root_without_parentheses(cursor: &Cursor, faults: &mut Faults, base: &Expression) {
    let number = |n| match cursor.peek_nth(n) {
        Some(TokenTree::Literal(literal)) => Number::from_literal(&literal.to_string()).ok(),
        _ => None,
    };
    let (Some(one), Some(below)) = (number(0), number(2)) else { return };
    if !one.is_one() || !cursor.is_punct_at(1, '/') {
        return;
    }
    let base = match base.kind {
        ExpressionKind::Name(_) | ExpressionKind::Call { .. } => base.to_string(),
        _ => "x".to_owned(),
    };
    let slash = cursor.peek_nth(1).map_or(cursor.span(), TokenTree::span);
    faults.report(
        Fault::new(slash, format!("`{base}^{one}/{below}` divides the power by {below}"))
            .help(format_args!("write `{base}^({one}/{below})` for the root, or `{base}/{below}`")),
    );
}

fn postfix(cursor: &mut Cursor, faults: &mut Faults, depth: usize) -> Parsed {
    let mut value = primary(cursor, faults, depth)?;
    let mut depth = depth;
    loop {
        let span = cursor.span();
        if is_prime(cursor) {
            value = prime(cursor, faults, &value);
        } else if !cursor.is_pair('.', '.') && cursor.eat('.').is_some() {
            depth = deeper(depth, span, faults)?;
            value = member(cursor, faults, depth, value)?;
        } else if is_juxtaposed(cursor) {
            without_operator(cursor, faults, &value);
            depth = deeper(depth, span, faults)?;
            if let Some(group) = cursor.eat_group(Delimiter::Parenthesis) {
                arguments(&group, faults, depth);
            } else {
                primary(cursor, faults, depth)?;
            }
            value = missing(span);
        } else {
            return Ok(value);
        }
    }
}

/// Passes a prime behind an operand: a lifetime is two tokens, a character literal is one.
fn prime(cursor: &mut Cursor, faults: &mut Faults, value: &Expression) -> Box<Expression> {
    let span = cursor.span();
    cursor.skip(if cursor.is_punct('\'') && cursor.ident_at(1).is_some() { 2 } else { 1 });
    faults.report(
        Fault::new(span, "a prime does not make a derivative")
            .help(format_args!("write `dot({})`", short_name(value))),
    );
    missing(span)
}

/// Reports that two operands stand side by side.
fn without_operator(cursor: &Cursor, faults: &mut Faults, value: &Expression) {
    // After a literal such as `2sin` the parentheses belong to what has been reported.
    if matches!(value.kind, ExpressionKind::Missing) {
        return;
    }
    let message = format!("expected an operator before {}", cursor.found());
    faults.report(
        Fault::new(cursor.span(), message).help("if a product is meant, write `*` between its factors"),
    );
}

/// Reads a component or a method behind a `.`.
fn member(cursor: &mut Cursor, faults: &mut Faults, depth: usize, base: Box<Expression>) -> Parsed {
    let span = cursor.span();
    let Some(name) = member_name(cursor, faults)? else { return Ok(missing(span)) };
    match cursor.eat_group(Delimiter::Parenthesis) {
        Some(group) => {
            let arguments = arguments(&group, faults, depth);
            Ok(method(span, base, name, arguments, group.span()))
        }
        None => Ok(field(span, base, index_of(cursor, faults, name))),
    }
}

/// The name behind a `.`; none where a number stands, which is passed.
fn member_name(cursor: &mut Cursor, faults: &mut Faults) -> Result<Option<Name>, Reported> {
    let span = cursor.span();
    let Some(TokenTree::Ident(ident)) = cursor.peek().cloned() else {
        let fault = Fault::new(span, format!("expected a name after `.`, found {}", cursor.found()));
        if matches!(cursor.peek(), Some(TokenTree::Literal(_))) {
            faults.report(fault.help("the components of a vector are `.x`, `.y` and `.z`"));
            cursor.skip(1);
            return Ok(None);
        }
        return Err(faults.report(fault));
    };
    keyword(&ident, faults, "a name after `.`")?;
    cursor.skip(1);
    Ok(Some(Name::new(ident)))
}

fn method(
    span: Span,
    base: Box<Expression>,
    name: Name,
    arguments: Vec<Expression>,
    list: Span,
) -> Box<Expression> {
    node(span, ExpressionKind::Method { base, name, arguments, list })
}

/// A name behind a `.`, with its index, if it has one.
fn field(span: Span, base: Box<Expression>, name: Name) -> Box<Expression> {
    node(span, ExpressionKind::Field { base, name })
}

/// Whether the token directly behind an operand begins another one. A name may end the expression and begin
/// something else; parentheses and numbers cannot.
fn is_juxtaposed(cursor: &Cursor) -> bool {
    match cursor.peek() {
        Some(TokenTree::Literal(_)) => true,
        Some(TokenTree::Group(group)) => match group.delimiter() {
            Delimiter::Parenthesis => true,
            // An empty fragment such as `$vis` is nothing.
            Delimiter::None => !group.stream().is_empty(),
            Delimiter::Brace | Delimiter::Bracket => false,
        },
        _ => false,
    }
}

/// Whether a lifetime or a character literal stands here: what rustc makes of the prime in `x'`.
fn is_prime(cursor: &Cursor) -> bool {
    match cursor.peek() {
        Some(TokenTree::Punct(mark)) => mark.as_char() == '\'',
        Some(TokenTree::Literal(literal)) => literal.to_string().starts_with('\''),
        _ => false,
    }
}

fn primary(cursor: &mut Cursor, faults: &mut Faults, depth: usize) -> Parsed {
    match cursor.peek() {
        Some(TokenTree::Ident(_)) => name_or_call(cursor, faults, depth),
        Some(TokenTree::Group(group))
            if matches!(group.delimiter(), Delimiter::Parenthesis | Delimiter::None) =>
        {
            let group = group.clone();
            cursor.skip(1);
            parentheses(&group, faults, depth)
        }
        _ => number_or_fault(cursor, faults),
    }
}

/// A number, or what stands where an expression should begin.
fn number_or_fault(cursor: &mut Cursor, faults: &mut Faults) -> Parsed {
    let span = cursor.span();
    match cursor.peek().cloned() {
        Some(TokenTree::Literal(literal)) => {
            cursor.skip(1);
            Ok(Box::new(number(&literal, faults)))
        }
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket => {
            cursor.skip(1);
            let fault = Fault::new(span, "brackets have no meaning here");
            faults.report(fault.help("a vector is written `vec(x, y, z)`, a product in parentheses"));
            Ok(missing(span))
        }
        _ => Err(expected_expression(cursor, faults)),
    }
}

fn expected_expression(cursor: &Cursor, faults: &mut Faults) -> Reported {
    let fault = Fault::new(cursor.span(), format!("expected an expression, found {}", cursor.found()));
    faults.report(if cursor.is_punct('|') {
        fault.help("an absolute value is written `abs(x)`, the length of a vector `norm(v)`")
    } else if is_prime(cursor) {
        fault.help("a time derivative is written `dot(x)`")
    } else {
        fault
    })
}

/// Refuses the keywords of Rust as names in expressions.
fn keyword(ident: &proc_macro2::Ident, faults: &mut Faults, expected: &str) -> Result<(), Reported> {
    let text = ident.to_string();
    if !is_rust_keyword(&text) {
        return Ok(());
    }
    let fault = Fault::new(ident.span(), format!("expected {expected}, found keyword `{text}`"));
    Err(faults.report(if text == "mod" {
        fault.help("the rest of a division by `b` is `x - b*floor(x/b)`")
    } else if matches!(text.as_str(), "if" | "else" | "match" | "where") {
        fault.help("an expression has no branches: write `select(c >= 0, a, b)`, `a` where the comparison holds and `b` elsewhere")
    } else if matches!(text.as_str(), "for" | "while" | "loop") {
        fault.help("the sum of a range is written `sum(i in 0..n: e)`")
    } else if can_be_raw(&text) {
        fault.help(format_args!("if this is the name of a variable, write `r#{text}`"))
    } else {
        fault
    }))
}

/// A name and what may stand directly behind it.
fn name_or_call(cursor: &mut Cursor, faults: &mut Faults, depth: usize) -> Parsed {
    let name = name_of_operand(cursor, faults)?;
    let Some(group) = cursor.eat_group(Delimiter::Parenthesis) else {
        return Ok(name_alone(cursor, faults, name));
    };
    if FOLDS.contains(&name.text.as_str()) && begins_fold(&group) {
        return fold(&group, faults, depth, name);
    }
    let arguments = compared_arguments(&group, faults, depth, name.text == "select");
    Ok(call(faults, name, arguments, group.span()))
}

/// The name at the cursor, which is passed.
fn name_of_operand(cursor: &mut Cursor, faults: &mut Faults) -> Result<Name, Reported> {
    let Some(ident) = cursor.ident_at(0).cloned() else { return Err(expected_expression(cursor, faults)) };
    keyword(&ident, faults, "an expression")?;
    cursor.skip(1);
    Ok(Name::new(ident))
}

fn call(faults: &mut Faults, function: Name, arguments: Vec<Expression>, list: Span) -> Box<Expression> {
    let span = function.span();
    if function.text == "dot" && arguments.len() == 2 {
        faults.report(
            Fault::new(span, "`dot` takes one argument: it is the derivative by time")
                .help("the product of two vectors is written `inner(u, v)`"),
        );
        return missing(span);
    }
    node(span, ExpressionKind::Call { function, arguments, list })
}

/// A name without parentheses behind it.
fn name_alone(cursor: &mut Cursor, faults: &mut Faults, name: Name) -> Box<Expression> {
    let span = name.span();
    if cursor.is_pair(':', ':') {
        while cursor.is_pair(':', ':') {
            cursor.skip(2);
            if cursor.ident_at(0).is_some() {
                cursor.skip(1);
            }
        }
        faults.report(
            Fault::new(span, "paths have no meaning here")
                .help("functions and constants have plain names, such as `sin(x)` and `pi`"),
        );
        return missing(span);
    }
    if cursor.is_punct('!') && matches!(cursor.peek_nth(1), Some(TokenTree::Group(_))) {
        cursor.skip(2);
        faults.report(
            Fault::new(span, format!("macros such as `{name}!` cannot be called here"))
                .help("functions are written without `!`, such as `vec(x, y, z)`"),
        );
        return missing(span);
    }
    node(span, ExpressionKind::Name(index_of(cursor, faults, name)))
}

/// `sum(i in 0..n: e)` and `product(i in 0..n: e)`.
fn fold(group: &Group, faults: &mut Faults, depth: usize, function: Name) -> Parsed {
    let depth = deeper(depth, group.span_open(), faults)?;
    let mut cursor = Cursor::inside(group);
    let Some(head) = boxed_head(&mut cursor, faults) else { return Ok(missing(function.span())) };
    let body = inside(cursor, faults, depth, "`)`");
    Ok(fold_of(function, head, body))
}

fn boxed_head(cursor: &mut Cursor, faults: &mut Faults) -> Option<Box<(Name, Range)>> {
    fold_head(cursor, faults).ok().map(Box::new)
}

fn fold_of(function: Name, head: Box<(Name, Range)>, body: Box<Expression>) -> Box<Expression> {
    let (variable, range) = *head;
    let span = function.span();
    node(span, ExpressionKind::Fold(Box::new(Fold { function, variable, range, body: *body })))
}

/// An expression in parentheses, or in an invisible group, which counts as such.
fn parentheses(group: &Group, faults: &mut Faults, depth: usize) -> Parsed {
    let is_visible = group.delimiter() == Delimiter::Parenthesis;
    let depth = deeper(depth, if is_visible { group.span_open() } else { group.span() }, faults)?;
    let mut cursor = Cursor::inside(group);
    let span = cursor.span();
    let mut value = match sum(&mut cursor, faults, depth) {
        Err(Reported { .. }) => missing(span),
        Ok(value) if cursor.is_end() => value,
        Ok(_) => {
            behind_operand(&cursor, faults);
            missing(span)
        }
    };
    if is_visible {
        value.parentheses = Some(group.span());
    } else if value.parentheses.is_none() && matches!(value.kind, ExpressionKind::Missing) {
        value.span = group.span();
    }
    Ok(value)
}

/// Reports what stands behind the expression in parentheses.
fn behind_operand(cursor: &Cursor, faults: &mut Faults) {
    if cursor.is_punct(',') {
        faults.report(
            Fault::new(cursor.span(), "expected `)` or an operator, found `,`")
                .help("a vector is written `vec(x, y, z)`"),
        );
    } else {
        unexpected(cursor, faults, "`)`");
    }
}

/// The arguments of a call, separated by commas; one more comma at the end is allowed.
pub(crate) fn arguments(group: &Group, faults: &mut Faults, depth: usize) -> Vec<Expression> {
    compared_arguments(group, faults, depth, false)
}

/// The arguments of a call, of which the first may be a comparison.
fn compared_arguments(group: &Group, faults: &mut Faults, depth: usize, compares: bool) -> Vec<Expression> {
    let mut arguments = Vec::new();
    let Ok(depth) = deeper(depth, group.span_open(), faults) else { return arguments };
    let mut cursor = Cursor::inside(group);
    while !cursor.is_end() {
        let span = cursor.span();
        let value = argument(&mut cursor, faults, depth, compares && arguments.is_empty());
        let is_whole = push_argument(&mut arguments, value, span);
        if is_whole && is_followed_by_semicolon(&cursor, faults) {
            cursor.skip(1);
            continue;
        }
        cursor.recover_to_comma();
        cursor.skip(1);
    }
    arguments
}

/// Adds an argument, or a missing one; returns whether it was read to its end.
fn push_argument(arguments: &mut Vec<Expression>, value: Parsed, span: Span) -> bool {
    let is_whole = value.is_ok();
    arguments.push(value.map_or_else(|Reported { .. }| Expression::missing(span), |value| *value));
    is_whole
}

/// Whether a `;` stands where arguments need a `,`; everything but a `,` is reported.
fn is_followed_by_semicolon(cursor: &Cursor, faults: &mut Faults) -> bool {
    if cursor.is_end() || cursor.is_punct(',') {
        return false;
    }
    if cursor.is_punct(';') {
        faults.report(Fault::new(cursor.span(), "expected `,` between arguments, found `;`"));
        return true;
    }
    unexpected(cursor, faults, "`,`");
    false
}

/// An operand, and where a relation stands behind it, what it is compared with.
fn argument(cursor: &mut Cursor, faults: &mut Faults, depth: usize, may_compare: bool) -> Parsed {
    let left = sum(cursor, faults, depth)?;
    let span = cursor.span();
    let Some(order) = relation(cursor, faults, may_compare)? else { return Ok(left) };
    let right = sum(cursor, faults, depth)?;
    compared(span, faults, may_compare, left, order, right)
}

/// Passes the relation that may stand behind an operand.
fn relation(cursor: &mut Cursor, faults: &mut Faults, may_compare: bool) -> Result<Option<Order>, Reported> {
    let (order, marks) = match () {
        () if cursor.is_pair('>', '=') => (Order::AtLeast, 2),
        () if cursor.is_pair('<', '=') => (Order::AtMost, 2),
        () if cursor.is_punct('>') => (Order::Above, 1),
        () if cursor.is_punct('<') => (Order::Below, 1),
        () if may_compare && (cursor.is_pair('=', '=') || cursor.is_pair('!', '=')) => {
            let text = format!("`select` does not compare by {}", cursor.found());
            return Err(faults.report(Fault::new(cursor.span(), text).help(
                "a condition is written with `>=`, `>`, `<=` or `<`: numbers that are computed are hardly ever equal",
            )));
        }
        () => return Ok(None),
    };
    cursor.skip(marks);
    Ok(Some(order))
}

fn compared(
    span: Span,
    faults: &mut Faults,
    may_compare: bool,
    left: Box<Expression>,
    order: Order,
    right: Box<Expression>,
) -> Parsed {
    if !may_compare {
        let fault =
            Fault::new(span, "a comparison is the first argument of `select`, and stands nowhere else");
        return Err(faults.report(fault.help("write `select(c >= 0, a, b)`")));
    }
    Ok(node(span, ExpressionKind::Comparison { left, order, right }))
}

/// Returns the next level of nesting, as long as there are any.
fn deeper(depth: usize, span: Span, faults: &mut Faults) -> Result<usize, Reported> {
    if depth < MAX_DEPTH {
        return Ok(depth + 1);
    }
    Err(too_deep(span, faults))
}

fn too_deep(span: Span, faults: &mut Faults) -> Reported {
    faults.report(
        Fault::new(span, format!("the expression is nested more than {MAX_DEPTH} levels deep"))
            .help("give parts of it names with `let`"),
    )
}

/// The value's text for a message if it is short, else `x`.
fn short_name(value: &Expression) -> String {
    match &value.kind {
        ExpressionKind::Name(name) => name.text.clone(),
        _ => "x".to_owned(),
    }
}
