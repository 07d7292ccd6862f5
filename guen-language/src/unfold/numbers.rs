//! Values of whole numbers, ranges and conditions.

use proc_macro2::Span;

use super::Unfolder;
use crate::diagnostics::Fault;
use crate::names::nearest;
use crate::syntax::{Comparison, Condition, IndexExpression, IndexKind, IndexOperator, Name, Range};

impl Unfolder<'_> {
    /// The value of an expression; none after a fault.
    pub(super) fn number(&mut self, e: &IndexExpression) -> Option<i64> {
        match &e.kind {
            IndexKind::Missing => None,
            IndexKind::Number(value) => Some(*value),
            IndexKind::Name(name) => self.named(name),
            IndexKind::Negation(operand) => {
                let value = self.number(operand)?;
                self.bounded(value.checked_neg(), e.span)
            }
            IndexKind::Operation(left, operator, right) => {
                let (a, b) = (self.number(left), self.number(right));
                let (a, b) = (a?, b?);
                let value = match operator {
                    IndexOperator::Plus => a.checked_add(b),
                    IndexOperator::Minus => a.checked_sub(b),
                    IndexOperator::Times => a.checked_mul(b),
                    IndexOperator::Over | IndexOperator::Remainder if b == 0 => {
                        self.faults.report(Fault::new(e.span, "this index divides by zero"));
                        return None;
                    }
                    IndexOperator::Over => a.checked_div(b),
                    IndexOperator::Remainder => a.checked_rem(b),
                };
                self.bounded(value, e.span)
            }
        }
    }

    fn bounded(&mut self, value: Option<i64>, span: Span) -> Option<i64> {
        if value.is_none() {
            self.faults.report(Fault::new(span, "this index is too large: whole numbers have 64 bits"));
        }
        value
    }

    /// The value of a loop variable or a count.
    fn named(&mut self, name: &Name) -> Option<i64> {
        if let Some(value) = self.whole_number(&name.text) {
            return value;
        }
        let text = format!("`{name}` is no count and no loop variable");
        let known = self.counts.keys().chain(self.variables.iter().map(|(name, _)| name));
        let near = nearest(&name.text, known.map(String::as_str));
        let fault =
            Fault::new(name.span(), text).note("indices and ranges are known while the program is compiled");
        self.faults.report(match near {
            Some(near) => fault.help(format!("did you mean `{near}`?")),
            None => fault.help(format!("declare it above, as `count {name} = 20;`")),
        });
        None
    }

    /// The value of a loop variable or a count, if the name is one; of a count with a fault nothing.
    pub(super) fn whole_number(&mut self, name: &str) -> Option<Option<i64>> {
        if let Some((_, value)) = self.variables.iter().rev().find(|(variable, _)| variable == name) {
            return Some(Some(*value));
        }
        let count = self.counts.get_mut(name)?;
        count.is_used = true;
        Some(count.value)
    }

    /// The first number of a range, and the one behind the last.
    pub(super) fn bounds(&mut self, range: &Range) -> Option<(i64, i64)> {
        let (start, end) = (self.number(&range.start), self.number(&range.end));
        let (start, end) = (start?, end?);
        let end = if range.is_closed { self.bounded(end.checked_add(1), range.span)? } else { end };
        Some((start, end))
    }

    /// Whether a condition holds; none after a fault.
    pub(super) fn holds(&mut self, condition: &Condition) -> Option<bool> {
        match condition {
            Condition::Missing => None,
            Condition::Not(inner) => self.holds(inner).map(|holds| !holds),
            Condition::And(left, right) => match self.holds(left)? {
                true => self.holds(right),
                false => Some(false),
            },
            Condition::Or(left, right) => match self.holds(left)? {
                true => Some(true),
                false => self.holds(right),
            },
            Condition::Comparison(left, comparison, right) => {
                let (a, b) = (self.number(left), self.number(right));
                let (a, b) = (a?, b?);
                Some(match comparison {
                    Comparison::Less => a < b,
                    Comparison::LessOrEqual => a <= b,
                    Comparison::Greater => a > b,
                    Comparison::GreaterOrEqual => a >= b,
                    Comparison::Equal => a == b,
                    Comparison::Unequal => a != b,
                })
            }
        }
    }
}
