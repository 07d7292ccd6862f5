//! Products: numbers, powers and quotients, with tangents and cotangents for quotients of sines and cosines.

use crate::algebra::{ExprId, Function, Multivariate, Node, Rational};
use crate::print::latex_name;
use crate::print::names::operator;

use super::Style;
use super::order::FactorKey;
use super::render::{Precedence, Printer};

/// A factor of a product as it will be shown: `cot(x)` has taken the place of two.
struct Shown {
    key: FactorKey,
    text: String,
    level: Precedence,
    exponent: i32,
    /// A function with what it is applied to.
    call: Option<Call>,
    /// An exponent over the order of a root above two.
    order: u32,
}

/// A function as it is written, and what stands behind it.
pub(super) struct Call {
    head: String,
    arguments: String,
}

impl Printer<'_> {
    /// The number before a product and its factors, with what is in products that are kept whole among them.
    pub(super) fn factors(&self, coefficient: &Rational, e: ExprId) -> (Rational, Vec<(ExprId, i32)>) {
        let mut number = coefficient.clone();
        let mut factors: Vec<(ExprId, i32)> = Vec::new();
        let mut stack = vec![(e, 1)];
        while let Some((e, k)) = stack.pop() {
            let e = self.opened(e);
            match self.graph.node(e) {
                Node::Product(inner) => stack.extend(inner.iter().rev().map(|(base, own)| (*base, own * k))),
                // Zero has no negative power, and a division by it is no number.
                Node::Number(value) => match value.powi(k) {
                    Some(power) => number = number * power,
                    None => factors.push((e, k)),
                },
                Node::Sum { constant, terms } if constant.is_zero() && terms.len() == 1 => {
                    let (term, c) = &terms[0];
                    number = number * c.powi(k).expect("coefficients are not zero");
                    stack.push((*term, k));
                }
                _ => match factors.iter_mut().find(|(base, _)| *base == e) {
                    Some((_, own)) => *own += k,
                    None => factors.push((e, k)),
                },
            }
        }
        factors.retain(|(_, k)| *k != 0);
        (number, factors)
    }

    /// `coefficient * e`: whether it is the negative of the text, the text, and how tightly that binds.
    pub(super) fn product(&self, coefficient: &Rational, e: ExprId) -> (bool, String, Precedence) {
        let (number, factors) = self.factors(coefficient, e);
        let mut minus = number.is_negative();
        let number = number.abs();
        // A thing by itself; what is asked for may be under way, and then it is no such thing.
        if let ([(base, 1)], true) = (&factors[..], number.is_one())
            && let Some(piece) = self.pieces.get(base)
        {
            return (minus != piece.minus, piece.text.clone(), piece.level);
        }
        let mut shown = Vec::new();
        for (base, k) in &factors {
            for (name, exponent) in self.quotient(&factors, *base, *k) {
                let (negative, item) = self.shown(*base, exponent, name);
                minus ^= negative && exponent % 2 != 0;
                shown.push(item);
            }
        }
        shown.sort_by(|a, b| a.key.cmp(&b.key));
        let (above, below): (Vec<_>, Vec<_>) = shown.iter().partition(|item| item.exponent > 0);
        let level = match (&above[..], &below[..]) {
            ([one], []) if number.is_one() && one.exponent == 1 => one.level,
            ([_], []) if number.is_one() => Precedence::Power,
            ([], []) if number.is_integer() => Precedence::Atom,
            _ => Precedence::Product,
        };
        (minus, self.quotient_text(&number, &above, &below), level)
    }

    /// A factor, and whether what is shown is the negative of its base.
    fn shown(&self, base: ExprId, exponent: i32, name: Option<&'static str>) -> (bool, Shown) {
        let piece = &self.pieces[&base];
        let item = Shown {
            key: self.factor_key(base),
            text: piece.text.clone(),
            level: piece.level,
            exponent,
            call: None,
            order: 1,
        };
        match self.graph.node(base) {
            Node::Function(Function::Root(q), x) if self.style == Style::Text && *q > 2 => (
                false,
                Shown {
                    text: self.wrapped(*x, Precedence::Atom),
                    level: Precedence::Atom,
                    order: *q,
                    ..item
                },
            ),
            Node::Function(Function::Root(_), _) => (piece.minus, item),
            Node::Function(Function::Abs, _) if self.style == Style::Latex => (piece.minus, item),
            Node::Function(function, x) => {
                // Tangents and cotangents are odd as the sine is.
                let parity = if name.is_some() { Function::Sin } else { *function };
                let (minus, argument) = self.argument(parity, *x);
                let call = self.applied(name.unwrap_or(function.name()), *x, &argument);
                (
                    minus,
                    Shown { text: self.call(&call, 1), level: Precedence::Atom, call: Some(call), ..item },
                )
            }
            Node::Multivariate(function, _) => {
                (false, Shown { call: Some(self.multivariate(*function, base)), ..item })
            }
            _ => (piece.minus, item),
        }
    }

    /// A factor `sin(x)^e` beside a power of `cos(x)` of other sign: the common part is a tangent or cotangent.
    fn quotient(&self, factors: &[(ExprId, i32)], base: ExprId, e: i32) -> Vec<(Option<&'static str>, i32)> {
        let Node::Function(function @ (Function::Sin | Function::Cos), x) = *self.graph.node(base) else {
            return vec![(None, e)];
        };
        let (partner, name) = match function {
            Function::Sin => (Function::Cos, "tan"),
            _ => (Function::Sin, "cot"),
        };
        let Some(partner) = factors
            .iter()
            .find(|(b, _)| matches!(*self.graph.node(*b), Node::Function(f, y) if f == partner && x == y))
        else {
            return vec![(None, e)];
        };
        if (partner.1 > 0) == (e > 0) {
            return vec![(None, e)];
        }
        let common = e.abs().min(partner.1.abs());
        let rest = e.signum() * (e.abs() - common);
        // The factor above shows the quotient, the one below only what is left of it.
        let mut parts = Vec::new();
        if e > 0 {
            parts.push((Some(name), common));
        }
        if rest != 0 {
            parts.push((None, rest));
        }
        parts
    }

    fn quotient_text(&self, coefficient: &Rational, above: &[&Shown], below: &[&Shown]) -> String {
        let (n, d) = match coefficient.to_i64_pair() {
            Some((n, d)) => (n.to_string(), d.to_string()),
            None => {
                let (n, d) = coefficient.to_big_pair();
                (n.to_string(), d.to_string())
            }
        };
        match self.style {
            Style::Text => {
                let mut top = Vec::new();
                let mut bottom: Vec<String> =
                    below.iter().map(|item| self.power(item, Precedence::Power)).collect();
                if above.is_empty() {
                    top.push(n);
                    if d != "1" {
                        bottom.insert(0, d);
                    }
                } else if d != "1" {
                    top.push(format!("{n}/{d}"));
                } else if n != "1" {
                    top.push(n);
                }
                top.extend(above.iter().map(|item| self.power(item, Precedence::Power)));
                let top = top.join("*");
                match bottom.len() {
                    0 => top,
                    1 => format!("{top}/{}", bottom[0]),
                    _ => format!("{top}/({})", bottom.join("*")),
                }
            }
            Style::Latex => {
                let is_fraction = !below.is_empty();
                // What is alone above or below a bar needs no parentheses.
                let side = |items: &[&Shown], number: &str| -> Vec<String> {
                    let is_alone = is_fraction && items.len() == 1 && number == "1";
                    let least = if is_alone { Precedence::Sum } else { Precedence::Power };
                    items.iter().map(|item| self.power(item, least)).collect()
                };
                let (mut top, mut bottom) = (side(above, &n), side(below, &d));
                if !is_fraction && d != "1" {
                    top.insert(0, format!("\\frac{{{n}}}{{{d}}}"));
                } else {
                    if n != "1" || above.is_empty() {
                        top.insert(0, n);
                    }
                    if d != "1" {
                        bottom.insert(0, d);
                    }
                }
                let top = top.join("\\,");
                if bottom.is_empty() { top } else { format!("\\frac{{{top}}}{{{}}}", bottom.join("\\,")) }
            }
        }
    }

    /// A factor with the absolute value of its exponent; in parentheses where it binds less tightly than asked for.
    fn power(&self, item: &Shown, least: Precedence) -> String {
        let e = item.exponent.unsigned_abs();
        if e == 1 && item.order == 1 {
            return if item.level >= least { item.text.clone() } else { self.parentheses(&item.text) };
        }
        if let (1, Some(call)) = (item.order, &item.call) {
            return self.call(call, e);
        }
        let base =
            if item.level == Precedence::Atom { item.text.clone() } else { self.parentheses(&item.text) };
        match (self.style, item.order) {
            (Style::Text, 1) => format!("{base}^{e}"),
            (Style::Text, q) => format!("{base}^({e}/{q})"),
            (Style::Latex, _) => format!("{base}^{{{e}}}"),
        }
    }

    /// A function of `x`, of which `argument` is the text.
    pub(super) fn applied(&self, name: &str, x: ExprId, argument: &str) -> Call {
        if self.style == Style::Text {
            return Call { head: name.to_owned(), arguments: self.parentheses(argument) };
        }
        let head = match name {
            "asin" | "acos" | "atan" => format!("\\arc{}", &name[1..]),
            "sign" | "floor" => format!("\\operatorname{{{name}}}"),
            _ => format!("\\{name}"),
        };
        // One symbol needs no parentheses behind a name.
        let is_symbol = matches!(self.graph.node(self.opened(x)), Node::Symbol(_) | Node::Pi);
        let arguments = match (is_symbol, argument.starts_with('\\')) {
            (false, _) => self.parentheses(argument),
            (true, true) => argument.to_owned(),
            (true, false) => format!(" {argument}"),
        };
        Call { head, arguments }
    }

    /// `atan2(y, x)`.
    /// A function of several arguments; of `select` the first is a condition.
    pub(super) fn multivariate(&self, function: Multivariate, e: ExprId) -> Call {
        let mut arguments: Vec<String> =
            self.graph.children(e).iter().map(|e| self.pieces[e].signed()).collect();
        if function == Multivariate::Select {
            arguments[0].push_str(if self.style == Style::Text { " >= 0" } else { " \\ge 0" });
        }
        let text = self.style == Style::Text;
        let head = match function {
            Multivariate::Supplied { function, orders } => {
                let supplied = &self.graph.supplied_functions()[usize::from(function)];
                let by = supplied.arguments.iter().zip(orders);
                let by = by.flat_map(|(name, times)| core::iter::repeat_n(name.as_str(), times.into()));
                if text {
                    by.fold(supplied.name.clone(), |head, name| format!("{head}_{name}"))
                } else {
                    // A derivative has the arguments as indices.
                    let by: Vec<String> = by.map(latex_name).collect();
                    let name = operator(&supplied.name);
                    if by.is_empty() { name } else { format!("{name}_{{{}}}", by.join(",")) }
                }
            }
            known if text => known.name().to_owned(),
            Multivariate::Minimum | Multivariate::Maximum => format!("\\{}", function.name()),
            known => format!("\\operatorname{{{}}}", known.name()),
        };
        Call { head, arguments: self.parentheses(&arguments.join(", ")) }
    }

    /// A function to a power. In LaTeX the exponent stands at the name: behind the arguments it would be read as theirs.
    pub(super) fn call(&self, call: &Call, exponent: u32) -> String {
        let Call { head, arguments } = call;
        match (exponent, self.style) {
            (1, _) => format!("{head}{arguments}"),
            (e, Style::Text) => format!("{head}{arguments}^{e}"),
            (e, Style::Latex) => format!("{head}^{{{e}}}{arguments}"),
        }
    }
}
