//! Constants, and the limits of constants and inputs.

use std::collections::{BTreeMap, BTreeSet};

use guen_symbolic::{ExprId, Role, Roles, SignBound};

use super::Resolver;
use crate::diagnostics::Fault;
use crate::model::ConstantEntry;
use crate::model::expression_place::ExpressionPlace;
use crate::model::scope::Category;
use crate::names::array_of;
use crate::syntax::{BoundKind, Constant, Expression, Plain};

impl<'a> Resolver<'a, '_> {
    pub(super) fn constant(&mut self, constant: &'a Constant) {
        let bound = constant.bound.map(|bound| bound.kind);
        let promise = match bound {
            None => SignBound::Free,
            Some(BoundKind::Positive) => SignBound::Positive,
            Some(BoundKind::Nonnegative) => SignBound::NonNegative,
            Some(BoundKind::Nonzero) => SignBound::NonZero,
        };
        self.eval.entry = Some(constant.name.text.clone());
        let is_degrees = constant.unit.as_ref().is_some_and(|unit| unit.is_degrees);
        let default = constant.default.as_ref().map(|e| self.eval.scalar_at(ExpressionPlace::Default, e));
        let default = default.map(|e| e.map(|e| self.in_unit(e, is_degrees)));
        if let (Some(Ok(value)), Some(default)) = (&default, &constant.default) {
            self.check_default(*value, bound, default);
        }
        let limits = constant.limits.as_deref().and_then(|limits| self.constant_limits(limits, is_degrees));
        if let (Some(Ok(value)), Some(limits), Some(written)) = (&default, limits, &constant.default) {
            self.check_limited_default(*value, limits, written);
        }
        let promise = limits.map_or(promise, |[lower, _]| match self.eval.bench.graph.as_number(lower) {
            Some(number) if number.is_zero() => SignBound::NonNegative,
            Some(number) if !number.is_negative() => SignBound::Positive,
            _ => promise,
        });
        let graph = &mut self.eval.bench.graph;
        let symbol = graph.bounded_symbol(&constant.name.text, Role::Constant, promise);
        let default = default.and_then(Result::ok);
        let mut value = symbol;
        if is_degrees {
            // The field is in degrees, and everything else in radians.
            let degree = graph.degree();
            value = graph.mul(symbol, degree);
        }
        self.declare_symbol(&constant.name, Category::Constant, value);
        self.constants.push(ConstantEntry {
            name: &constant.name,
            docs: &constant.docs,
            bound,
            limits,
            default,
            is_derived: false,
            symbol,
        });
    }

    /// A default or a limit in the unit of its constant: a number is, and what depends on constants is in radians.
    fn in_unit(&mut self, e: ExprId, is_degrees: bool) -> ExprId {
        let graph = &mut self.eval.bench.graph;
        if !is_degrees || graph.symbols_in(&[e]).is_empty() {
            return e;
        }
        let degree = graph.degree();
        graph.div(e, degree)
    }

    /// Notes which constants follow others.
    pub(super) fn note_derived(&mut self) {
        let graph = &self.eval.bench.graph;
        let follows = |constant: &ConstantEntry<'_>| {
            constant.default.is_some_and(|e| graph.roles(e).meets(Roles::of(Role::Constant)))
        };
        let following: BTreeSet<&str> = self
            .constants
            .iter()
            .filter(|constant| follows(constant))
            .map(|constant| array_of(&constant.name.text))
            .collect();
        for constant in &mut self.constants {
            constant.is_derived = following.contains(array_of(&constant.name.text));
        }
    }

    /// The entries of an array are given together: all of them have a default, or none.
    pub(super) fn check_defaults_of_arrays(&mut self, constants: &[Constant]) {
        let mut first: BTreeMap<&str, &Constant> = BTreeMap::new();
        for constant in constants.iter().filter(|constant| constant.name.path().is_some()) {
            let name = &constant.name;
            let other = *first.entry(array_of(&name.text)).or_insert(constant);
            if other.default.is_some() == constant.default.is_some() {
                continue;
            }
            let (with, without) =
                if constant.default.is_some() { (constant, other) } else { (other, constant) };
            let text = format!("`{}` has a default, and `{}` has none", with.name, without.name);
            let fault = Fault::new(name.span(), text).note("the entries of an array are given together");
            self.eval.faults.report(fault.help("give all of them a default, or none"));
        }
    }

    /// The limits of a constant; two numbers have to stand in their order.
    fn constant_limits(&mut self, limits: &[Expression; 2], is_degrees: bool) -> Option<[ExprId; 2]> {
        let values = limits.each_ref().map(|e| self.eval.scalar_at(ExpressionPlace::Default, e).ok());
        let [Some(lower), Some(upper)] = values.map(|e| e.map(|e| self.in_unit(e, is_degrees))) else {
            return None;
        };
        let before = self.eval.faults.count();
        self.in_order(lower, upper, limits);
        (self.eval.faults.count() == before).then_some([lower, upper])
    }

    /// A default that is a number must lie between limits that are.
    fn check_limited_default(&mut self, value: ExprId, limits: [ExprId; 2], written: &Expression) {
        let graph = &mut self.eval.bench.graph;
        let outside = [graph.sub(value, limits[0]), graph.sub(limits[1], value)];
        if outside.iter().any(|rest| graph.as_number(*rest).is_some_and(|rest| rest.is_negative())) {
            let fault = Fault::new(written.span, "this default lies outside of its limits");
            self.eval.faults.report(fault.help("change the default or the limits"));
        }
    }

    /// The limits of an input; two numbers have to stand in their order.
    pub(super) fn limits(&mut self, plain: &Plain, limits: &[Expression; 2]) -> Option<[ExprId; 2]> {
        self.eval.entry = Some(plain.name.text.clone());
        let values = limits.each_ref().map(|e| self.eval.scalar_at(ExpressionPlace::Limit, e).ok());
        let [Some(lower), Some(upper)] = values else { return None };
        self.in_order(lower, upper, limits);
        Some([lower, upper])
    }

    fn in_order(&mut self, lower: ExprId, upper: ExprId, limits: &[Expression; 2]) {
        let graph = &mut self.eval.bench.graph;
        let span = graph.sub(upper, lower);
        if graph.as_number(span).is_some_and(|span| span.is_negative()) {
            let fault = Fault::new(limits[0].extent(), "the lower limit is above the upper one");
            self.eval.faults.report(fault.help("limits are written `name in lower..upper`"));
        }
    }

    /// A default that is a number must keep the bound beside it.
    fn check_default(&mut self, value: ExprId, bound: Option<BoundKind>, written: &Expression) {
        let Some(number) = self.eval.bench.graph.as_number(value) else { return };
        let broken = match bound {
            None => None,
            Some(BoundKind::Positive) => (number.is_negative() || number.is_zero()).then_some("> 0"),
            Some(BoundKind::Nonnegative) => number.is_negative().then_some(">= 0"),
            Some(BoundKind::Nonzero) => number.is_zero().then_some("!= 0"),
        };
        if let Some(bound) = broken {
            let fault = Fault::new(written.span, format!("this default does not keep the bound `{bound}`"));
            self.eval.faults.report(fault.help("change the default or the bound"));
        }
    }
}
