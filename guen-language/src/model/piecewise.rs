//! Piecewise functions: `min`, `max`, `clamp` and `select`, whose first argument is a comparison.

use guen_symbolic::ExprId;
use proc_macro2::Span;

use super::evaluate::{Evaluated, Evaluator};
use super::value::Value;
use crate::diagnostics::Fault;
use crate::syntax::{Expression, ExpressionKind, Name, Order};

/// The form of a call of `select`.
const SELECT_USAGE: &str = "write `select(c >= 0, a, b)`: `a` where the comparison holds, `b` elsewhere";

impl Evaluator<'_> {
    /// `select(a >= b, x, y)`.
    pub(super) fn select(&mut self, function: &Name, arguments: &[Expression], list: Span) -> Evaluated {
        let [condition, above, below] = arguments else {
            let (found, were) = (arguments.len(), if arguments.len() == 1 { "was" } else { "were" });
            let text = format!("`select` takes 3 arguments, and {found} {were} given");
            return self.fail(Fault::new(list, text).help(SELECT_USAGE));
        };
        let compared = self.condition(condition);
        let (above_value, below_value) = (self.value(above), self.value(below));
        let ((c, turned), mut above_value, mut below_value) = (compared?, above_value?, below_value?);
        if turned {
            core::mem::swap(&mut above_value, &mut below_value);
        }
        match (above_value, below_value) {
            (Value::Scalar(a), Value::Scalar(b)) => {
                let value = self.bench.graph.select(c, a, b);
                self.check_size(value, function.span())
            }
            (Value::Vector(u), Value::Vector(v)) => {
                let chosen = core::array::from_fn(|i| self.bench.graph.select(c, u[i], v[i]));
                self.checked_vector(chosen, function.span())
            }
            (a, b) => {
                let (a, b) = if turned { (b, a) } else { (a, b) };
                let text = format!(
                    "`select` chooses between two scalars or two vectors, and these are {} and {}",
                    a.kind(),
                    b.kind()
                );
                self.fail(Fault::new(below.extent(), text))
            }
        }
    }

    /// `a >= b` as the function that is not negative where it holds; `a > b` as that of `b >= a`, which holds elsewhere.
    fn condition(&mut self, condition: &Expression) -> Evaluated<(ExprId, bool)> {
        let ExpressionKind::Comparison { left, order, right } = &condition.kind else {
            if matches!(condition.kind, ExpressionKind::Missing) {
                return Err(self.faults.reported_before());
            }
            let fault = Fault::new(condition.extent(), "the first argument of `select` is a comparison");
            let text = condition.source();
            return self.fail(fault.help(format!("write `select({text} >= 0, a, b)`")));
        };
        let (a, b) = (self.value(left), self.value(right));
        let mut side = |value: Evaluated, e: &Expression| match value? {
            Value::Scalar(e) => Ok(e),
            other => {
                let text = format!("`{}` compares scalars, and this is {}", order.sign(), other.kind());
                self.fail(Fault::new(e.extent(), text))
            }
        };
        let (a, b) = (side(a, left), side(b, right));
        let (a, b) = (a?, b?);
        let graph = &mut self.bench.graph;
        let (difference, turned) = match order {
            Order::AtLeast => (graph.sub(a, b), false),
            Order::AtMost => (graph.sub(b, a), false),
            Order::Above => (graph.sub(b, a), true),
            Order::Below => (graph.sub(a, b), true),
        };
        Ok((self.bench.tidy(difference), turned))
    }

    /// `min(a, b, ..)`, `max(a, b, ..)` and `clamp(x, low, high)`.
    pub(super) fn extremum(&mut self, function: &Name, values: &[(Value, Span)], list: Span) -> Evaluated {
        let name = function.text.as_str();
        let mut scalars = Vec::new();
        for value in values {
            scalars.push(self.scalar(function, value));
        }
        let scalars = scalars.into_iter().collect::<Evaluated<Vec<ExprId>>>()?;
        let found = scalars.len();
        let were = if found == 1 { "was" } else { "were" };
        let value = match (name, &scalars[..]) {
            ("clamp", &[x, low, high]) => {
                let graph = &mut self.bench.graph;
                if let (Some(a), Some(b)) = (graph.as_number(low), graph.as_number(high))
                    && a > b
                {
                    let fault = Fault::new(values[1].1, "the lower limit of `clamp` is above the upper one");
                    return self.fail(fault.help("write `clamp(x, low, high)`"));
                }
                let above = graph.maximum(x, low);
                graph.minimum(above, high)
            }
            ("clamp", _) => {
                let text = format!("`clamp` takes 3 arguments, and {found} {were} given");
                return self.fail(Fault::new(list, text).help("write `clamp(x, low, high)`"));
            }
            (_, [first, rest @ ..]) if !rest.is_empty() => {
                let graph = &mut self.bench.graph;
                rest.iter().fold(*first, |extremum, e| match name {
                    "min" => graph.minimum(extremum, *e),
                    _ => graph.maximum(extremum, *e),
                })
            }
            _ => {
                let text = format!("`{name}` takes 2 arguments or more, and {found} {were} given");
                return self.fail(Fault::new(list, text).help(format!("write `{name}(a, b)`")));
            }
        };
        self.check_size(value, function.span())
    }
}
