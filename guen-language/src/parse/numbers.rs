//! Numbers in expressions, and the faults of what looks like one.

use proc_macro2::{Literal, Span};

use crate::diagnostics::{Fault, Faults};
use crate::limits::{MAX_DECIMAL_ORDER, MAX_DIGITS};
use crate::names::is_function;
use crate::syntax::{Expression, ExpressionKind, Number, NumberProblem};

/// A number, or a missing value and the reason.
pub(super) fn number(literal: &Literal, faults: &mut Faults) -> Expression {
    let (text, span) = (literal.to_string(), literal.span());
    match Number::from_literal(&text) {
        Ok(number) => Expression::new(span, ExpressionKind::Number(number)),
        Err(problem) => {
            faults.report(number_fault(span, &text, problem));
            Expression::missing(span)
        }
    }
}

fn number_fault(span: Span, text: &str, problem: NumberProblem) -> Fault {
    match problem {
        NumberProblem::NotANumber => {
            let fault = Fault::new(span, "expected a number, a name or a function");
            if text.starts_with('\'') { fault.help("a time derivative is written `dot(x)`") } else { fault }
        }
        NumberProblem::NotDecimal => Fault::new(span, format!("`{text}` is not a decimal number"))
            .help("write numbers as `16` or `1.6e1`"),
        NumberProblem::Suffix(digits, letters) => {
            let fault = Fault::new(span, format!("a number cannot run into the name `{letters}`"));
            if is_type(&letters) {
                fault.help(format_args!("numbers are exact and have no types: write `{digits}`"))
            } else if is_function(&letters) {
                fault.help(format_args!("a product is written with `*`: `{digits}*{letters}(..)`"))
            } else {
                fault.help(format_args!("a product is written with `*`: `{digits}*{letters}`"))
            }
        }
        NumberProblem::OutOfRange => Fault::new(
            span,
            format!("numbers lie between 10^-{MAX_DECIMAL_ORDER} and 10^{MAX_DECIMAL_ORDER}, or are zero"),
        ),
        NumberProblem::TooManyDigits => {
            Fault::new(span, format!("a number has at most {MAX_DIGITS} significant digits"))
        }
    }
}

/// Whether a suffix is a type of numbers in Rust.
fn is_type(suffix: &str) -> bool {
    let Some(kind) = suffix.chars().next().filter(|kind| "iuf".contains(*kind)) else { return false };
    let size = &suffix[1..];
    matches!(size, "8" | "16" | "32" | "64" | "128") || (kind != 'f' && size == "size")
}
