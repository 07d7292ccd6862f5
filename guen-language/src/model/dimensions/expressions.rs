//! Dimensions of expressions: what is added is of one dimension, and functions take numbers.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use guen_symbolic::Rational;
use proc_macro2::Span;

use super::unknowns::{Partial, Unknowns};
use crate::damage::Sound;
use crate::diagnostics::{Fault, Faults};
use crate::names::is_function;
use crate::syntax::{Dimension, Expression, ExpressionKind, FunctionDefinition, MultiplyOperator, Name};

/// The dimension of a value by its kind.
#[derive(Clone)]
pub(super) enum Quantity {
    /// Zero fits everywhere, and so does what a fault was reported of.
    Anything,
    /// A scalar, or a vector by that of its components.
    Of(Partial),
    /// A rotation: its entries are numbers.
    Rotation,
    /// A body by the dimension of its centre, if it has one.
    Body(Option<Partial>),
}

/// Words for what has no dimension.
pub(super) const NUMBER: &str = "a number";

/// The names with their dimensions.
pub(super) struct Dimensions<'f> {
    pub(super) faults: &'f mut Faults,
    /// The statements without other faults.
    pub(super) sound: Rc<Sound>,
    pub(super) unknowns: Unknowns,
    pub(super) names: BTreeMap<String, Quantity>,
    /// Names that stand for numbers, for exponents.
    pub(super) numbers: BTreeMap<String, Rational>,
    pub(super) functions: BTreeMap<String, FunctionDefinition>,
    /// The functions that the program supplies: the dimensions of their arguments and of their values.
    pub(super) supplied: BTreeMap<String, (Vec<Partial>, Partial)>,
    /// The gap and the slip of contacts.
    pub(super) contacts: BTreeMap<(&'static str, String), Quantity>,
    /// The names of parameters and constraints.
    pub(super) forms: BTreeSet<String>,
}

/// A power of the second.
pub(super) fn seconds(power: i64) -> Partial {
    let second = Dimension::of_unit("s").unwrap_or_else(Dimension::one);
    Partial::from(second).raised(&Rational::integer(power))
}

impl Dimensions<'_> {
    /// A dimension in words.
    pub(super) fn written(&self, of: &Partial) -> String {
        match self.unknowns.resolved(of).known() {
            Some(known) if known.is_one() => NUMBER.to_owned(),
            Some(known) => known.to_string(),
            None => "something unknown".to_owned(),
        }
    }

    /// Reports two dimensions that ought to be one.
    fn differ(&mut self, [a, b]: &[Partial; 2], [left, right]: [&str; 2], span: Span, message: &str) {
        let [a, b] = [a, b].map(|one| match self.written(one) {
            number if number == NUMBER => format!("is {NUMBER}"),
            unit => format!("is in {unit}"),
        });
        let note = format!("{left} {a}, and {right} {b}");
        self.faults.report(Fault::new(span, message).note(note));
    }

    /// The dimension that two expressions share, with a fault at the place where they have none.
    pub(super) fn shared(
        &mut self,
        (a, left): (Quantity, &str),
        (b, right): (Quantity, &str),
        span: Span,
        message: &str,
    ) -> Quantity {
        match (a, b) {
            (Quantity::Of(a), Quantity::Of(b)) => match self.unknowns.equal(&a, &b) {
                Ok(()) => Quantity::Of(a),
                Err(both) => {
                    self.differ(&both, [left, right], span, message);
                    Quantity::Anything
                }
            },
            (Quantity::Anything, other) | (other, Quantity::Anything) => other,
            (other, _) => other,
        }
    }

    /// Whether an expression has a dimension; else a fault is reported.
    pub(super) fn require(&mut self, e: &Expression, own: Quantity, wanted: Partial, what: &str) -> bool {
        let Quantity::Of(own) = own else { return true };
        if let Err(both) = self.unknowns.equal(&own, &wanted) {
            let [own, wanted] = both.each_ref().map(|one| self.written(one));
            let is = if own == NUMBER { "is" } else { "is in" };
            let wanted = if wanted == NUMBER { wanted } else { format!("in {wanted}") };
            self.faults.report(
                Fault::new(e.extent(), format!("{what} is {wanted}, and this {is} {own}"))
                    .note(format!("`{}` {is} {own}", e.source())),
            );
            return false;
        }
        true
    }

    /// The dimension of an expression.
    pub(super) fn of(&mut self, e: &Expression) -> Quantity {
        match &e.kind {
            ExpressionKind::Fold(_) | ExpressionKind::Missing => Quantity::Anything,
            ExpressionKind::Number(number) if number.is_zero() => Quantity::Anything,
            ExpressionKind::Number(_) => Quantity::Of(Partial::one()),
            ExpressionKind::Name(name) => self.name(name),
            ExpressionKind::Negation(operand) => self.of(operand),
            ExpressionKind::Sum { first, rest } => {
                let mut sum = self.of(first);
                let mut left = first.source();
                for term in rest {
                    let value = self.of(&term.value);
                    let right = term.value.source();
                    let (l, r) = (format!("`{left}`"), format!("`{right}`"));
                    sum =
                        self.shared((sum, &l), (value, &r), term.span, "this sum adds different dimensions");
                    left = right;
                }
                sum
            }
            ExpressionKind::Product { first, rest } => {
                let mut product = self.of(first);
                for factor in rest {
                    let power = if factor.operator == MultiplyOperator::Times { 1 } else { -1 };
                    let value = self.of(&factor.value);
                    product = match (product, value) {
                        (Quantity::Anything, _) | (_, Quantity::Anything) => Quantity::Anything,
                        (Quantity::Of(a), Quantity::Of(b)) => {
                            Quantity::Of(a.times(&b, &Rational::integer(power)))
                        }
                        (Quantity::Rotation, other) | (other, _) => other,
                    };
                }
                product
            }
            ExpressionKind::Power { base, exponent } => {
                let own = self.of(base);
                self.raised(base, own, exponent)
            }
            ExpressionKind::Comparison { left, right, .. } => {
                let (l, r) = (format!("`{}`", left.source()), format!("`{}`", right.source()));
                let (a, b) = (self.of(left), self.of(right));
                self.shared((a, &l), (b, &r), e.span, "this compares different dimensions")
            }
            ExpressionKind::Field { base, name } => {
                let base = self.of(base);
                self.field(base, name)
            }
            ExpressionKind::Method { base, name, arguments, .. } => {
                let own = self.of(base);
                match (&own, name.text.as_str(), &arguments[..]) {
                    (Quantity::Body(center), "velocity_at", [point]) => {
                        let center = center.clone();
                        let at = self.of(point);
                        let center = center.map_or(Quantity::Anything, Quantity::Of);
                        let place = (at, "the point");
                        let length = self.shared(
                            place,
                            (center, "the centre"),
                            name.span(),
                            "a point of a body is a place",
                        );
                        per_second(length)
                    }
                    (_, "powi" | "powf", [exponent]) => self.raised(base, own, exponent),
                    (_, "recip", []) => match own {
                        Quantity::Of(own) => Quantity::Of(own.raised(&Rational::integer(-1))),
                        other => other,
                    },
                    _ => {
                        let mut all = vec![(&**base, own)];
                        for argument in arguments {
                            let own = self.of(argument);
                            all.push((argument, own));
                        }
                        self.function(name, &all)
                    }
                }
            }
            ExpressionKind::Call { function, arguments, .. } => {
                let all: Vec<(&Expression, Quantity)> =
                    arguments.iter().map(|argument| (argument, self.of(argument))).collect();
                if let Some((expected, value)) = self.supplied.get(&function.text).cloned() {
                    for ((e, own), wanted) in all.into_iter().zip(expected) {
                        self.require(e, own, wanted, &format!("an argument of `{function}`"));
                    }
                    return Quantity::Of(value);
                }
                match self.functions.get(&function.text).cloned() {
                    Some(declared) => self.called(function, &declared, all),
                    None => self.function(function, &all),
                }
            }
        }
    }

    fn name(&mut self, name: &Name) -> Quantity {
        if let Some(known) = self.names.get(&name.text) {
            return known.clone();
        }
        match name.text.as_str() {
            "t" => Quantity::Of(seconds(1)),
            "pi" => Quantity::Of(Partial::one()),
            _ => Quantity::Anything,
        }
    }

    fn raised(&mut self, base: &Expression, own: Quantity, exponent: &Expression) -> Quantity {
        match (own, self.number(exponent)) {
            (Quantity::Of(own), Some(power)) => Quantity::Of(own.raised(&power)),
            // Nothing is known of a power where nothing is known of the exponent.
            (_, None) if self.is_unknown(exponent) => Quantity::Anything,
            (own, None) => {
                self.require(base, own, Partial::one(), "the base of this power");
                Quantity::Of(Partial::one())
            }
            (own, _) => own,
        }
    }

    /// Whether something in an expression is missing, or was declared by a statement with a fault.
    fn is_unknown(&self, e: &Expression) -> bool {
        match &e.kind {
            ExpressionKind::Missing => true,
            ExpressionKind::Name(name) if !["t", "pi"].contains(&name.text.as_str()) => {
                let own = self.names.get(&name.text);
                !self.numbers.contains_key(&name.text) && matches!(own, None | Some(Quantity::Anything))
            }
            _ => e.children().into_iter().any(|child| self.is_unknown(child)),
        }
    }

    fn field(&mut self, base: Quantity, name: &Name) -> Quantity {
        match (base, name.text.as_str()) {
            (Quantity::Rotation, _) => Quantity::Of(Partial::one()),
            (Quantity::Body(_), "angular_velocity") => Quantity::Of(seconds(-1)),
            (Quantity::Body(_), "orientation") => Quantity::Rotation,
            (Quantity::Body(center), _) => center.map_or(Quantity::Anything, Quantity::Of),
            (own, _) => own,
        }
    }

    /// Whether there is no fault in a function, whatever its arguments are.
    pub(super) fn is_sound(&mut self, function: &FunctionDefinition) -> bool {
        let before = self.faults.count();
        self.value_for(function, function.parameters.iter().map(|_| Quantity::Anything));
        self.faults.count() == before
    }

    /// A call of a function of the declaration: dimensions are those of its arguments.
    fn called(
        &mut self,
        name: &Name,
        function: &FunctionDefinition,
        arguments: Vec<(&Expression, Quantity)>,
    ) -> Quantity {
        let before = self.faults.count();
        let value = self.value_for(function, arguments.into_iter().map(|(_, value)| value));
        self.faults.note_since(before, &format!("in the call of `{name}`"), name.span());
        value
    }

    /// The value of a function.
    fn value_for(
        &mut self,
        function: &FunctionDefinition,
        arguments: impl Iterator<Item = Quantity>,
    ) -> Quantity {
        let mut hidden = Vec::new();
        for (parameter, value) in function.parameters.iter().zip(arguments) {
            hidden.push((parameter.text.clone(), self.names.insert(parameter.text.clone(), value)));
        }
        let value = self.of(&function.value);
        for (parameter, own) in hidden.into_iter().rev() {
            match own {
                Some(own) => self.names.insert(parameter, own),
                None => self.names.remove(&parameter),
            };
        }
        value
    }

    /// A function of the language.
    fn function(&mut self, name: &Name, arguments: &[(&Expression, Quantity)]) -> Quantity {
        let number = || Quantity::Of(Partial::one());
        let first = || arguments.first().map_or(Quantity::Anything, |(_, own)| own.clone());
        match name.text.as_str() {
            "dot" => per_second(first()),
            "abs" | "norm" => first(),
            "sqrt" => match first() {
                Quantity::Of(own) => Quantity::Of(own.raised(&Rational::new(1, 2))),
                other => other,
            },
            "min" | "max" | "clamp" | "vec" => self.alike(name, arguments),
            // The first is a comparison.
            "select" => self.alike(name, arguments.get(1..).unwrap_or_default()),
            "inner" | "cross" => match arguments {
                [(_, Quantity::Of(a)), (_, Quantity::Of(b))] => {
                    Quantity::Of(a.times(b, &Rational::integer(1)))
                }
                _ => Quantity::Anything,
            },
            "unit" | "sign" => number(),
            "atan2" => {
                if let [(a, own), (b, other)] = arguments {
                    let (left, right) = (format!("`{}`", a.source()), format!("`{}`", b.source()));
                    self.shared(
                        (own.clone(), &left),
                        (other.clone(), &right),
                        name.span(),
                        "the arguments of `atan2` have different dimensions",
                    );
                }
                number()
            }
            "transpose" => Quantity::Rotation,
            "angular_velocity" | "angular_velocity_body" => Quantity::Of(seconds(-1)),
            "rot_x" | "rot_y" | "rot_z" | "rot" | "quaternion" => {
                for (e, own) in arguments {
                    self.require(e, own.clone(), Partial::one(), &format!("an argument of `{name}`"));
                }
                Quantity::Rotation
            }
            // The reaction does work on its own form.
            "reaction" => match first() {
                Quantity::Of(form) => {
                    let watt = Dimension::of_unit("W").unwrap_or_else(Dimension::one);
                    Quantity::Of(Partial::from(watt).times(&form, &Rational::integer(-1)))
                }
                other => other,
            },
            asked @ ("gap" | "slip") => match arguments {
                [(Expression { kind: ExpressionKind::Name(contact), .. }, _)] => {
                    let asked = if asked == "gap" { "gap" } else { "slip" };
                    self.contacts.get(&(asked, contact.text.clone())).cloned().unwrap_or(Quantity::Anything)
                }
                _ => Quantity::Anything,
            },
            known if is_function(known) => {
                for (e, own) in arguments {
                    self.require(e, own.clone(), Partial::one(), &format!("an argument of `{name}`"));
                }
                number()
            }
            // One that a statement with a fault declares.
            _ => Quantity::Anything,
        }
    }

    /// The dimension that all arguments share.
    fn alike(&mut self, name: &Name, arguments: &[(&Expression, Quantity)]) -> Quantity {
        let what = match name.text.as_str() {
            "vec" => "the components of this vector have different dimensions".to_owned(),
            other => format!("the arguments of `{other}` have different dimensions"),
        };
        let mut shared = Quantity::Anything;
        for (place, (e, own)) in arguments.iter().enumerate() {
            let before = arguments[..place].iter().rev().find(|(_, own)| matches!(own, Quantity::Of(_)));
            let left = before.map_or(String::new(), |(e, _)| format!("`{}`", e.source()));
            let right = format!("`{}`", e.source());
            shared = self.shared((shared, &left), (own.clone(), &right), e.extent(), &what);
        }
        shared
    }

    /// The value of an expression that is a number.
    pub(super) fn number(&self, e: &Expression) -> Option<Rational> {
        match &e.kind {
            ExpressionKind::Number(number) => Rational::from_decimal(&number.digits, number.exponent),
            ExpressionKind::Name(name) => self.numbers.get(&name.text).cloned(),
            ExpressionKind::Negation(operand) => Some(-self.number(operand)?),
            ExpressionKind::Sum { first, rest } => rest.iter().try_fold(self.number(first)?, |sum, term| {
                let value = self.number(&term.value)?;
                Some(if term.operator == crate::syntax::AddOperator::Plus {
                    sum + value
                } else {
                    sum - value
                })
            }),
            ExpressionKind::Product { first, rest } => {
                rest.iter().try_fold(self.number(first)?, |product, factor| {
                    let value = self.number(&factor.value)?;
                    Some(match factor.operator {
                        MultiplyOperator::Times => product * value,
                        MultiplyOperator::Over => product * value.recip()?,
                    })
                })
            }
            _ => None,
        }
    }
}

/// The dimension of a rate.
pub(super) fn per_second(own: Quantity) -> Quantity {
    match own {
        Quantity::Of(own) => Quantity::Of(own.times(&seconds(-1), &Rational::integer(1))),
        other => other,
    }
}
