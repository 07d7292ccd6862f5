//! Whole numbers: `[i, j]` behind a name, the range of a loop, a condition on indices.

use proc_macro2::{Delimiter, Group, Literal, Span, TokenTree};

use super::cursor::Cursor;
use super::names::name;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::{MAX_CONDITION_OPERATIONS, MAX_INDEX_OPERATIONS};
use crate::names::is_rust_keyword;
use crate::syntax::{
    Comparison, Condition, Index, IndexExpression, IndexKind, IndexOperator, Name, Range, WrittenIndex,
    WrittenMember,
};

const HELP_NUMBER: &str = "an index is made of whole numbers, counts and loop variables with `+ - * / %`";
const HELP_RANGE: &str = "a range is `0..n`, without its end, or `0..=k`, with its end";

type Parsed = Result<IndexExpression, Reported>;

/// A name with what stands in brackets behind it, if anything does.
pub(crate) fn indexed_name(cursor: &mut Cursor, faults: &mut Faults, role: &str) -> Result<Name, Reported> {
    let name = name(cursor, faults, role)?;
    Ok(index_of(cursor, faults, name))
}

/// A name in a scene or in `modes`: `q[3]`, or a name of an instance, `left.q[3]`.
pub(crate) fn member_name(cursor: &mut Cursor, faults: &mut Faults, role: &str) -> Result<Name, Reported> {
    Ok(member_of(member_steps(cursor, faults, role)?))
}

/// Names between points, each with its index; at least one.
pub(super) fn member_steps(
    cursor: &mut Cursor,
    faults: &mut Faults,
    role: &str,
) -> Result<Vec<Name>, Reported> {
    let mut steps = vec![indexed_name(cursor, faults, role)?];
    while cursor.is_punct('.') && !cursor.is_pair('.', '.') {
        cursor.skip(1);
        steps.push(indexed_name(cursor, faults, "a name of the instance")?);
    }
    Ok(steps)
}

/// The name that some steps lead to; there is at least one.
pub(super) fn member_of(mut steps: Vec<Name>) -> Name {
    if steps.len() == 1 {
        return steps.remove(0);
    }
    let texts: Vec<&str> = steps.iter().map(|step| step.text.as_str()).collect();
    let (text, ident) = (texts.join("."), steps[steps.len() - 1].ident.clone());
    Name { text, ident, index: Index::Member(Box::new(WrittenMember { steps })) }
}

/// A name that has been read with its index behind it.
pub(crate) fn index_of(cursor: &mut Cursor, faults: &mut Faults, name: Name) -> Name {
    let Some(group) = cursor.eat_group(Delimiter::Bracket) else { return name };
    let mut indices = indices(&group, faults);
    while let Some(second) = cursor.eat_group(Delimiter::Bracket) {
        indices.extend(self::indices(&second, faults));
        indices.truncate(2);
        let fault = Fault::new(second.span_open(), "an entry has one pair of brackets");
        faults.report(fault.help(format!("write `{name}[i, j]` for an entry of two indices")));
    }
    Name { index: Index::Written(Box::new(WrittenIndex { indices, brackets: group.span() })), ..name }
}

/// The indices between brackets: one or two.
fn indices(group: &Group, faults: &mut Faults) -> Vec<IndexExpression> {
    let mut cursor = Cursor::inside(group);
    let mut found = Vec::new();
    while !cursor.is_end() {
        let span = cursor.span();
        let index = index(&mut cursor, faults);
        let is_whole = index.is_ok();
        found.push(index.unwrap_or_else(|Reported { .. }| missing(span)));
        if is_whole && !cursor.is_end() && !cursor.is_punct(',') {
            let fault =
                Fault::new(cursor.span(), format!("expected `]` or an operator, found {}", cursor.found()));
            faults.report(if cursor.is_punct(':') || cursor.is_pair('.', '.') {
                fault.help("a name has one entry at a time: write a loop, `for i in 0..n { .. }`")
            } else {
                fault.help(HELP_NUMBER)
            });
        }
        cursor.recover_to_comma();
        cursor.skip(1);
    }
    if found.is_empty() {
        let fault = Fault::new(group.span_open(), "an index is missing between these brackets");
        faults.report(fault.help("indices run from 0: `q[0]` is the first entry"));
        found.push(missing(group.span_open()));
    } else if found.len() > 2 {
        faults.report(Fault::new(found[2].span, "an array has one or two indices, and here are more"));
        found.truncate(2);
    }
    found
}

/// `start..end` or `start..=end`.
pub(crate) fn range(cursor: &mut Cursor, faults: &mut Faults) -> Result<Range, Reported> {
    cursor.open_invisible();
    if cursor.is_word("range") && cursor.group_at(1, Delimiter::Parenthesis).is_some() {
        let fault = Fault::new(cursor.span(), "`range(..)` is not a range of this language");
        return Err(faults.report(fault.help(HELP_RANGE)));
    }
    let start = index(cursor, faults)?;
    let span = cursor.span();
    if cursor.is_pair('.', '.') {
        cursor.skip(2);
        let is_closed = cursor.eat('=').is_some();
        return Ok(Range { start, end: index(cursor, faults)?, is_closed, span });
    }
    let fault = Fault::new(span, format!("expected `..`, found {}", cursor.found()));
    if cursor.is_punct(':') && !cursor.is_pair(':', ':') {
        return Err(faults.report(fault.help("the range from `a` to `b`, both included, is written `a..=b`")));
    }
    Err(faults.report(fault.help(HELP_RANGE)))
}

/// A condition on indices.
pub(crate) fn condition(cursor: &mut Cursor, faults: &mut Faults) -> Result<Condition, Reported> {
    any(cursor, faults, &mut Budget::new(MAX_CONDITION_OPERATIONS, "condition"))
}

/// Conditions that `||` joins.
fn any(cursor: &mut Cursor, faults: &mut Faults, budget: &mut Budget) -> Result<Condition, Reported> {
    let mut left = all(cursor, faults, budget)?;
    while cursor.is_pair('|', '|') {
        budget.spend(cursor.span(), faults)?;
        cursor.skip(2);
        left = Condition::Or(Box::new(left), Box::new(all(cursor, faults, budget)?));
    }
    Ok(left)
}

/// Conditions that `&&` joins.
fn all(cursor: &mut Cursor, faults: &mut Faults, budget: &mut Budget) -> Result<Condition, Reported> {
    let mut left = single(cursor, faults, budget)?;
    while cursor.is_pair('&', '&') {
        budget.spend(cursor.span(), faults)?;
        cursor.skip(2);
        left = Condition::And(Box::new(left), Box::new(single(cursor, faults, budget)?));
    }
    Ok(left)
}

fn single(cursor: &mut Cursor, faults: &mut Faults, budget: &mut Budget) -> Result<Condition, Reported> {
    cursor.open_invisible();
    if cursor.is_punct('!') && !cursor.is_pair('!', '=') {
        budget.spend(cursor.span(), faults)?;
        cursor.skip(1);
        return Ok(Condition::Not(Box::new(single(cursor, faults, budget)?)));
    }
    // Parentheses hold a condition where a comparison stands inside of them.
    if let Some(group) = cursor.group_at(0, Delimiter::Parenthesis).filter(|group| holds_comparison(group)) {
        budget.spend(group.span_open(), faults)?;
        let mut inside = Cursor::inside(&group.clone());
        cursor.skip(1);
        let inner = any(&mut inside, faults, budget)?;
        return inside.is_end().then_some(inner).ok_or_else(|| behind(&inside, faults, "`)`", None));
    }
    let left = index(cursor, faults)?;
    let comparison = comparison(cursor, faults)?;
    Ok(Condition::Comparison(left, comparison, index(cursor, faults)?))
}

/// Reports what stands behind the end of something in parentheses.
fn behind(cursor: &Cursor, faults: &mut Faults, expected: &str, help: Option<&str>) -> Reported {
    let fault = Fault::new(cursor.span(), format!("expected {expected}, found {}", cursor.found()));
    faults.report(help.iter().fold(fault, |fault, help| fault.help(help)))
}

/// Whether a comparison stands in parentheses, in further ones perhaps.
fn holds_comparison(group: &Group) -> bool {
    let mut groups = vec![group.clone()];
    while let Some(group) = groups.pop() {
        for token in group.stream() {
            match token {
                TokenTree::Punct(mark) if matches!(mark.as_char(), '<' | '>' | '=' | '!') => return true,
                TokenTree::Group(inner) if inner.delimiter() == Delimiter::Parenthesis => groups.push(inner),
                _ => {}
            }
        }
    }
    false
}

fn comparison(cursor: &mut Cursor, faults: &mut Faults) -> Result<Comparison, Reported> {
    let pairs = [
        ("<=", Comparison::LessOrEqual),
        (">=", Comparison::GreaterOrEqual),
        ("==", Comparison::Equal),
        ("!=", Comparison::Unequal),
    ];
    for (text, comparison) in pairs {
        let mut marks = text.chars();
        if cursor.is_pair(marks.next().unwrap_or(' '), marks.next().unwrap_or(' ')) {
            cursor.skip(2);
            return Ok(comparison);
        }
    }
    if cursor.eat('<').is_some() {
        return Ok(Comparison::Less);
    }
    if cursor.eat('>').is_some() {
        return Ok(Comparison::Greater);
    }
    let fault = Fault::new(cursor.span(), format!("expected a comparison, found {}", cursor.found()));
    Err(faults.report(if cursor.is_punct('=') {
        fault.help("equality is written `==`")
    } else {
        fault.help("a condition compares indices: `i < k`, `i % 2 == 0`")
    }))
}

/// The operations that an index or a condition may still have. They nest to the left and in parentheses, and later stages walk them recursively:
/// their number bounds the stack of both.
struct Budget {
    left: usize,
    most: usize,
    what: &'static str,
}

impl Budget {
    fn new(most: usize, what: &'static str) -> Self {
        Budget { left: most, most, what }
    }

    /// Takes one operation off, as long as there are any.
    fn spend(&mut self, span: Span, faults: &mut Faults) -> Result<(), Reported> {
        match self.left.checked_sub(1) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(self.overspent(span, faults)),
        }
    }

    fn overspent(&self, span: Span, faults: &mut Faults) -> Reported {
        let (what, most) = (self.what, self.most);
        let article = if what.starts_with('i') { "an" } else { "a" };
        let fault = Fault::new(span, format!("{article} {what} of more than {most} operations"));
        faults.report(fault.note("parentheses and signs count as operations"))
    }
}

/// An expression of whole numbers; it ends at the first token that cannot continue it.
pub(crate) fn index(cursor: &mut Cursor, faults: &mut Faults) -> Parsed {
    sum(cursor, faults, &mut Budget::new(MAX_INDEX_OPERATIONS, "index"))
}

fn sum(cursor: &mut Cursor, faults: &mut Faults, budget: &mut Budget) -> Parsed {
    let operators = [('+', IndexOperator::Plus), ('-', IndexOperator::Minus)];
    operations(cursor, faults, budget, &operators, product)
}

fn product(cursor: &mut Cursor, faults: &mut Faults, budget: &mut Budget) -> Parsed {
    let operators =
        [('*', IndexOperator::Times), ('/', IndexOperator::Over), ('%', IndexOperator::Remainder)];
    operations(cursor, faults, budget, &operators, unary)
}

/// Operands with operators of one rank between them, from left to right.
fn operations(
    cursor: &mut Cursor,
    faults: &mut Faults,
    budget: &mut Budget,
    operators: &[(char, IndexOperator)],
    operand: fn(&mut Cursor, &mut Faults, &mut Budget) -> Parsed,
) -> Parsed {
    let mut left = operand(cursor, faults, budget)?;
    while let Some((_, operator)) = operators.iter().find(|(mark, _)| cursor.is_punct(*mark)) {
        let span = cursor.span();
        budget.spend(span, faults)?;
        cursor.skip(1);
        left = operation(left, *operator, span, operand(cursor, faults, budget)?);
    }
    Ok(left)
}

fn operation(
    left: IndexExpression,
    operator: IndexOperator,
    span: Span,
    right: IndexExpression,
) -> IndexExpression {
    IndexExpression { span, kind: IndexKind::Operation(Box::new(left), operator, Box::new(right)) }
}

fn unary(cursor: &mut Cursor, faults: &mut Faults, budget: &mut Budget) -> Parsed {
    cursor.open_invisible();
    let span = cursor.span();
    if cursor.eat('-').is_some() {
        budget.spend(span, faults)?;
        let operand = unary(cursor, faults, budget)?;
        return Ok(IndexExpression { span, kind: IndexKind::Negation(Box::new(operand)) });
    }
    if let Some(group) = cursor.eat_group(Delimiter::Parenthesis) {
        budget.spend(span, faults)?;
        let mut inside = Cursor::inside(&group);
        let value = sum(&mut inside, faults, budget)?;
        return match inside.is_end() {
            true => Ok(value),
            false => Err(behind(&inside, faults, "`)` or an operator", Some(HELP_NUMBER))),
        };
    }
    operand(cursor, faults)
}

/// A number or a name.
fn operand(cursor: &mut Cursor, faults: &mut Faults) -> Parsed {
    let span = cursor.span();
    match cursor.peek().cloned() {
        Some(TokenTree::Literal(literal)) => {
            cursor.skip(1);
            number(&literal, faults)
        }
        Some(TokenTree::Ident(ident)) if !is_rust_keyword(&ident.to_string()) => {
            cursor.skip(1);
            if cursor.group_at(0, Delimiter::Parenthesis).is_some() {
                cursor.skip(1);
                let fault =
                    Fault::new(span, format!("an index calls no function, and this is `{ident}(..)`"));
                return Err(faults.report(fault.help(HELP_NUMBER)));
            }
            Ok(IndexExpression { span, kind: IndexKind::Name(Name::new(ident)) })
        }
        _ => {
            let fault = Fault::new(span, format!("expected a whole number, found {}", cursor.found()));
            Err(faults.report(fault.help(HELP_NUMBER)))
        }
    }
}

fn number(literal: &Literal, faults: &mut Faults) -> Parsed {
    let (text, span) = (literal.to_string(), literal.span());
    match text.replace('_', "").parse() {
        Ok(value) => Ok(IndexExpression { span, kind: IndexKind::Number(value) }),
        Err(_) => {
            let digits: String = text.chars().take_while(char::is_ascii_digit).collect();
            let fault = Fault::new(span, format!("an index is a whole number, and this is `{text}`"));
            let is_typed = !digits.is_empty() && text[digits.len()..].starts_with(['u', 'i']);
            Err(faults.report(match is_typed {
                true => fault.help(format!("numbers have no types here: write `{digits}`")),
                false => fault.help(HELP_NUMBER),
            }))
        }
    }
}

fn missing(span: Span) -> IndexExpression {
    IndexExpression { span, kind: IndexKind::Missing }
}

/// Whether `name in` stands at the beginning of a group: the head of a sum or product over a range.
pub(crate) fn begins_fold(group: &Group) -> bool {
    let mut tokens = group.stream().into_iter();
    matches!(tokens.next(), Some(TokenTree::Ident(_)))
        && matches!(tokens.next(), Some(TokenTree::Ident(word)) if word == "in")
}

/// `i in 0..n:` at the beginning of a sum or product; the cursor stands behind the colon afterwards.
pub(crate) fn fold_head(cursor: &mut Cursor, faults: &mut Faults) -> Result<(Name, Range), Reported> {
    let variable = name(cursor, faults, "a loop variable")?;
    cursor.skip(1);
    let range = range(cursor, faults)?;
    if cursor.eat(':').is_none() {
        let fault =
            Fault::new(cursor.span(), format!("expected `:` after the range, found {}", cursor.found()));
        return Err(faults.report(fault.help("a sum reads `sum(i in 0..n: e)`")));
    }
    Ok((variable, range))
}
