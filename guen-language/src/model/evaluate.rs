//! Expressions of the language as exact expressions: names looked up, kinds checked, operators applied.

use std::collections::{BTreeMap, BTreeSet};

use guen_symbolic::{ExprId, Flow, Node, PowerError, Rational, Role, Roles, Workbench};
use proc_macro2::Span;

use super::assumed_rates::AssumedRates;
use super::declared_functions::DeclaredFunctions;
use super::expression_place::{ExpressionPlace, ROLES, role_name};
use super::motion_symbols::MotionSymbols;
use super::scope::{Category, Scope};
use super::shapes::Shapes;
use super::value::{ContactValue, Value, Vector};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::{MAX_EXPONENT, MAX_FACTORS, MAX_NUMBER_BITS, MAX_TOTAL_DEPTH};
use crate::syntax::{AddOperator, Expression, ExpressionKind, MultiplyOperator, Name};

/// The context of an evaluation.
pub(super) struct Evaluator<'f> {
    /// The sink of this stage.
    pub(super) faults: &'f mut Faults,
    /// Expressions and the zero test.
    pub(super) bench: Workbench,
    /// The structure of values.
    pub(super) shapes: Shapes,
    /// Vectors among the forms: whether of parameters, and the places of their components in the section.
    pub(super) vectors: Vec<(bool, [Option<usize>; 3])>,
    /// The names declared so far.
    pub(super) scope: Scope,
    /// The symbol of time.
    pub(super) time: ExprId,
    /// `d/dt` of functions of time and coordinates: `x_i` moves at `x_i'`, `t` at one.
    pub(super) rate: Option<Flow>,
    /// The place that is being evaluated.
    pub(super) place: ExpressionPlace,
    /// The entry that is being evaluated, where it has a name.
    pub(super) entry: Option<String>,
    /// Parameters and constraints with their definitions in the velocities.
    pub(super) expansions: BTreeMap<ExprId, ExprId>,
    /// Components of vector equations that say `0 = 0`.
    pub(super) left_out: Vec<String>,
    /// Accelerations and reactions that outputs use.
    pub(super) motion: MotionSymbols,
    /// States beside the motion, with their rates as far as these are declared.
    pub(super) states: Vec<(ExprId, Option<ExprId>)>,
    /// Contacts by name, as outputs and loads see them.
    pub(super) contacts: BTreeMap<String, ContactValue>,
    /// Arguments of `quaternion`.
    pub(super) quaternions: Vec<[ExprId; 4]>,
    /// Functions of the declaration.
    pub(super) functions: DeclaredFunctions,
    /// Rates of coordinates that are used as parameters, until it is known whether they are.
    pub(super) rates: AssumedRates,
    /// Divisors with their places, for a second look once the holonomic constraints are known.
    pub(super) divisors: Vec<(ExprId, Span)>,
}

/// The result of evaluating: a value, or the knowledge that a fault was reported.
pub(super) type Evaluated<T = Value> = Result<T, Reported>;

impl Evaluator<'_> {
    /// Reports a fault.
    pub(super) fn fail<T>(&mut self, fault: Fault) -> Evaluated<T> {
        Err(self.faults.report(fault))
    }

    /// Evaluates at a place and checks that nothing occurs there that may not.
    pub(super) fn at(&mut self, place: ExpressionPlace, e: &Expression) -> Evaluated {
        self.place = place;
        let value = match self.value(e) {
            Ok(value) => value,
            Err(reported) => {
                self.check_names(place, e);
                return Err(reported);
            }
        };
        self.check_depth(&value, e)?;
        let roles =
            value.expressions().iter().fold(Roles::NONE, |roles, e| roles.or(self.bench.graph.roles(*e)));
        self.check_allowed(place, roles, e)?;
        self.check_jumps(place, &value, e)?;
        Ok(value)
    }

    /// Evaluates as [`Evaluator::at`], for places that take a scalar.
    pub(super) fn scalar_at(&mut self, place: ExpressionPlace, e: &Expression) -> Evaluated<ExprId> {
        match self.at(place, e)? {
            Value::Scalar(value) => Ok(value),
            other => {
                let what = place.description(self.entry.as_deref());
                self.fail(Fault::new(e.extent(), format!("{what} is a scalar, and this is {}", other.kind())))
            }
        }
    }

    /// Evaluates as [`Evaluator::at`], for places that take a vector.
    pub(super) fn vector_at(&mut self, place: ExpressionPlace, e: &Expression) -> Evaluated<Vector> {
        match self.at(place, e)? {
            Value::Vector(value) => Ok(value),
            other => {
                let what = place.description(self.entry.as_deref());
                self.fail(
                    Fault::new(e.extent(), format!("{what} is a vector here, and this is {}", other.kind()))
                        .help("write `vec(x, y, z)`"),
                )
            }
        }
    }

    /// Reports every name and call that brings in what may not occur at a place.
    fn check_allowed(&mut self, place: ExpressionPlace, roles: Roles, e: &Expression) -> Evaluated<()> {
        let allowed = place.allowed();
        let mut result = Ok(());
        let mut seen = BTreeSet::new();
        for role in ROLES.into_iter().filter(|role| roles.has(*role) && !allowed.has(*role)) {
            let mut culprits = self.culprits(e, Roles::of(role));
            if culprits.is_empty() && seen.is_empty() {
                culprits.push((e.extent(), None));
            }
            for (span, name) in culprits {
                // A name is one mistake, however often it occurs and whatever it brings in.
                let key = name.map_or_else(|| format!("{span:?}"), ToOwned::to_owned);
                if seen.insert(key) {
                    result = self.fail_not_allowed(place, role, span, name);
                }
            }
        }
        result
    }

    /// Reports the names that may not occur at a place in an expression that has no value, because of another fault.
    fn check_names(&mut self, place: ExpressionPlace, e: &Expression) {
        let allowed = place.allowed();
        let is_refused = |role: &Role| !allowed.has(*role) && !self.culprits(e, Roles::of(*role)).is_empty();
        let refused: Vec<Role> = ROLES.into_iter().filter(is_refused).collect();
        let roles = refused.into_iter().fold(Roles::NONE, |roles, role| roles.or(Roles::of(role)));
        let _reported = self.check_allowed(place, roles, e);
    }

    fn fail_not_allowed(
        &mut self,
        place: ExpressionPlace,
        role: Role,
        span: Span,
        name: Option<&str>,
    ) -> Evaluated<()> {
        let what = place.description(self.entry.as_deref());
        let direct = name.filter(|name| self.scope.definition(name).is_none() && *name != "t");
        let on = match direct {
            Some(name) => {
                format!("{} `{name}`", role_name(role).replacen("a ", "the ", 1).replacen("an ", "the ", 1))
            }
            None => role_name(role).to_owned(),
        };
        let switch = (role == Role::Input)
            .then(|| name.and_then(|name| self.switch_in(name)))
            .flatten()
            .map(|name| format!("the switch `{name}`"));
        let mut fault = if place.is_of_contact() {
            let of_role = if role == Role::QuasiVelocity { Role::Velocity } else { role };
            let on = switch.clone().unwrap_or_else(|| role_name(of_role).to_owned());
            Fault::new(span, format!("{what} depends on {on}"))
        } else {
            let on = switch.clone().unwrap_or(on);
            Fault::new(span, format!("{what} cannot depend on {on}"))
        };
        if let Some((name, defined)) = name.and_then(|name| Some((name, self.scope.definition(name)?))) {
            let inside = self.symbol_of_role(name, role);
            let inside = inside.map_or_else(|| role_name(role).to_owned(), |name| format!("`{name}`"));
            fault = fault.note_place(&format!("`{name}` contains {inside} by its definition"), defined);
        }
        fault = match (place, role) {
            (ExpressionPlace::Holonomic, Role::Velocity | Role::QuasiVelocity) => {
                fault.help("a condition on velocities belongs into `constraints`")
            }
            (ExpressionPlace::ForceFunction, Role::Velocity | Role::QuasiVelocity | Role::Input) => {
                fault.help("write it under `forces`, as `force along velocity;`")
            }
            (_, Role::Input) if switch.is_some() => fault.note(
                "switches are allowed in `forces`, `states`, `outputs` and the values of `resets`, and in the coefficients, limits and conditions of contacts",
            ),
            (_, Role::Input) => fault.note("inputs are allowed in `states`, `forces`, `outputs` and the values of `resets` only"),
            (ExpressionPlace::Force, Role::QuasiAcceleration) => {
                fault.note("accelerations follow from forces: `outputs` and the rates of states may use them")
            }
            (ExpressionPlace::KineticEnergy | ExpressionPlace::ForceFunction, Role::State) => fault
                .note("energies are those of the motion; states act on it through `forces`")
                .help("write what the state does as `force along velocity;`"),
            (_, Role::State) => fault.note("states are allowed in `forces`, `states`, `outputs`, `switches`, `resets`, and the limits and conditions of contacts"),
            _ => match place.rule() {
                Some(rule) => fault.note(rule),
                None => fault,
            },
        };
        self.fail(fault)
    }

    /// The switch that a name is, or that its value contains.
    fn switch_in(&self, name: &str) -> Option<String> {
        let is_switch = |name: &str| self.scope.category(name) == Some(Category::Switch);
        if is_switch(name) {
            return Some(name.to_owned());
        }
        self.symbol_of_role(name, Role::Input).filter(|inside| is_switch(inside))
    }

    /// The name of a symbol of this kind inside the value of a name.
    fn symbol_of_role(&self, name: &str, role: Role) -> Option<String> {
        let parts = self.scope.peek(name)?.expressions();
        let graph = &self.bench.graph;
        let symbol = graph.symbols_in(&parts).into_iter().find(|s| graph.symbol_info(*s).role == role)?;
        Some(graph.symbol_info(symbol).name.clone())
    }

    /// Refuses expressions that are deep because names stand for names: every stage walks them.
    fn check_depth(&mut self, value: &Value, e: &Expression) -> Evaluated<()> {
        let graph = &self.bench.graph;
        if value.expressions().into_iter().all(|part| graph.depth(part) <= MAX_TOTAL_DEPTH) {
            return Ok(());
        }
        self.fail(
            Fault::new(
                e.extent(),
                format!("the expression is more than {MAX_TOTAL_DEPTH} operations deep, with what its names stand for"),
            )
            .help("declare part of it as a coordinate, a parameter or a constant of its own"),
        )
    }

    /// The names and calls inside an expression that bring in one of these kinds of symbol.
    fn culprits<'e>(&self, e: &'e Expression, roles: Roles) -> Vec<(Span, Option<&'e str>)> {
        let mut found = Vec::new();
        self.culprits_beside(&BTreeSet::new(), e, roles, &mut found);
        found
    }

    /// The culprits in the expression of a function, whose arguments are none.
    pub(super) fn culprits_beside<'e>(
        &self,
        arguments: &BTreeSet<&str>,
        e: &'e Expression,
        roles: Roles,
        found: &mut Vec<(Span, Option<&'e str>)>,
    ) {
        match &e.kind {
            ExpressionKind::Name(name)
                if arguments.contains(name.text.as_str())
                    || self.functions.argument(&name.text).is_some() => {}
            ExpressionKind::Name(name) => {
                let own = if name.text == "t" {
                    Roles::of(Role::Time)
                } else {
                    let parts = self.scope.peek(&name.text).map(Value::expressions).unwrap_or_default();
                    parts.iter().fold(Roles::NONE, |all, e| all.or(self.bench.graph.roles(*e)))
                };
                if own.meets(roles) {
                    found.push((name.span(), Some(name.text.as_str())));
                }
            }
            ExpressionKind::Call { function, .. }
                if roles.has(Role::Velocity)
                    && matches!(
                        function.text.as_str(),
                        "dot" | "angular_velocity" | "angular_velocity_body"
                    ) =>
            {
                found.push((function.span(), None));
            }
            // The rate of a state has in it what its declaration has.
            ExpressionKind::Call { function, arguments, .. }
                if function.text == "dot" && self.have_rates_with(arguments, roles) =>
            {
                found.push((function.span(), None));
            }
            ExpressionKind::Call { function, .. } if self.brings_in(&function.text, roles) => {
                found.push((function.span(), Some(function.text.as_str())));
            }
            // It takes the name of a constraint or a contact, and no value.
            ExpressionKind::Call { function, .. } if self.takes_a_name(function) => {}
            ExpressionKind::Method { name, .. } | ExpressionKind::Field { name, .. }
                if roles.has(Role::Velocity)
                    && matches!(name.text.as_str(), "velocity_at" | "angular_velocity") =>
            {
                found.push((name.span(), None));
            }
            _ => {
                for child in e.children() {
                    self.culprits_beside(arguments, child, roles, found);
                }
            }
        }
    }

    /// Whether the rate of a state that is named in some expressions brings in one of these kinds of symbol.
    fn have_rates_with(&self, expressions: &[Expression], roles: Roles) -> bool {
        let graph = &self.bench.graph;
        let mut states =
            self.states.iter().filter_map(|(state, rate)| Some((graph.as_symbol(*state)?, (*rate)?)));
        states.any(|(state, rate)| {
            graph.roles(rate).meets(roles)
                && expressions.iter().any(|e| e.mentions(&graph.symbol_info(state).name))
        })
    }

    /// The value of an expression.
    pub(super) fn value(&mut self, e: &Expression) -> Evaluated {
        match &e.kind {
            // The parser has reported the missing expression.
            ExpressionKind::Missing | ExpressionKind::Fold(_) if self.faults.count() > 0 => {
                Err(self.faults.reported_before())
            }
            ExpressionKind::Missing | ExpressionKind::Fold(_) => {
                self.fail(Fault::new(e.span, "something is missing here"))
            }
            ExpressionKind::Number(number) => {
                let value = Rational::from_decimal(&number.digits, number.exponent).unwrap_or_default();
                Ok(Value::Scalar(self.bench.graph.number(value)))
            }
            ExpressionKind::Name(name) => self.name(name),
            ExpressionKind::Call { function, arguments, list } => self.call(function, arguments, *list),
            ExpressionKind::Field { base, name } => self.field(base, name),
            ExpressionKind::Method { base, name, arguments, list } => {
                self.method(base, name, arguments, *list)
            }
            ExpressionKind::Negation(operand) => {
                let value = self.value(operand)?;
                self.negated(value, e.span)
            }
            ExpressionKind::Sum { first, rest } => {
                // Every term is evaluated, so that the faults of all are reported.
                let mut sum = self.value(first);
                for term in rest {
                    let value = self.value(&term.value);
                    sum = match (sum, value) {
                        (Ok(a), Ok(b)) => self.added(a, b, term.operator, term.span),
                        (Err(reported), _) | (_, Err(reported)) => Err(reported),
                    };
                }
                sum
            }
            ExpressionKind::Product { first, rest } => self.product(first, rest),
            // The parser lets it stand there alone.
            ExpressionKind::Comparison { .. } => {
                self.fail(Fault::new(e.span, "a comparison is the first argument of `select`"))
            }
            ExpressionKind::Power { base, exponent } => {
                let (base_value, exponent_value) = (self.value(base), self.value(exponent));
                let (base_value, exponent_value) = (base_value?, exponent_value?);
                self.raised(base_value, exponent_value, base.span, exponent.span)
            }
        }
    }

    pub(super) fn name(&mut self, name: &Name) -> Evaluated {
        if let Some(value) = self.functions.argument(&name.text) {
            return Ok(value.clone());
        }
        if self.scope.category(&name.text) == Some(Category::Function) {
            return self.function_as_value(name);
        }
        match name.text.as_str() {
            "t" => return Ok(Value::Scalar(self.time)),
            "pi" => return Ok(Value::Scalar(self.bench.graph.pi())),
            _ => {}
        }
        if self.scope.category(&name.text) == Some(Category::Contact) {
            self.scope.refer(name);
            let fault = Fault::new(name.span(), format!("`{name}` is a contact, and no value"));
            return self.fail(
                fault.help(format!("in `outputs` write `gap({name})`, `slip({name})` or `reaction({name})`")),
            );
        }
        if let Some(rate) = self.assumed_rate(name) {
            return Ok(rate);
        }
        let place = self.place.description(self.entry.as_deref());
        match self.scope.look_up(self.faults, name, &place) {
            Some(value) => Ok(value),
            // Unknown, or declared with a fault: both are in the sink already.
            None => Err(self.faults.reported_before()),
        }
    }

    /// `a*R*v` means `a*(R*v)`: rotations wait until the vector to their right is known.
    fn product(&mut self, first: &Expression, rest: &[crate::syntax::Factor]) -> Evaluated {
        let mut values = vec![self.value(first)];
        values.extend(rest.iter().map(|factor| self.value(&factor.value)));
        let values: Vec<Value> = values.into_iter().collect::<Result<_, _>>()?;
        let mut values = values.into_iter();
        let Some(mut product) = values.next() else { return Ok(Value::Scalar(self.bench.graph.one())) };
        // A scalar in front of a rotation is kept aside until the vector arrives.
        let mut scale: Option<ExprId> = None;
        for (value, factor) in values.zip(rest) {
            product = match factor.operator {
                MultiplyOperator::Over => {
                    if scale.is_some() {
                        return self.fail(Fault::new(
                            factor.span,
                            "a scaled rotation has to be applied to a vector first",
                        ));
                    }
                    self.divided(product, value, factor.span, factor.value.span)?
                }
                MultiplyOperator::Times => match (product, value) {
                    (Value::Scalar(a), rotation @ Value::Rotation(_)) if scale.is_none() => {
                        scale = Some(a);
                        rotation
                    }
                    (a, b) => {
                        let product = self.multiplied(a, b, factor.span)?;
                        match (scale.take(), product) {
                            (Some(scale), product @ Value::Vector(_)) => {
                                self.multiplied(Value::Scalar(scale), product, factor.span)?
                            }
                            (waiting, product) => {
                                scale = waiting;
                                product
                            }
                        }
                    }
                },
            };
        }
        if scale.is_some() {
            return self.fail(
                Fault::new(first.span, "a scalar times a rotation is not a rotation")
                    .help("apply the rotation to a vector: `a*R*v`"),
            );
        }
        Ok(product)
    }

    /// `base^exponent`.
    pub(super) fn raised(
        &mut self,
        base: Value,
        exponent: Value,
        base_span: Span,
        exponent_span: Span,
    ) -> Evaluated {
        let (Value::Scalar(b), Value::Scalar(x)) = (&base, &exponent) else {
            let (what, span) = if matches!(base, Value::Scalar(_)) {
                (exponent.kind(), exponent_span)
            } else {
                (base.kind(), base_span)
            };
            return self.fail(
                Fault::new(span, format!("powers are of scalars, and this is {what}"))
                    .help("the square of a vector's length is `inner(v, v)`"),
            );
        };
        if self.bench.graph.as_number(*x).is_some_and(|number| number.is_negative()) {
            self.check_divisor(*b, base_span)?;
        }
        match self.bench.graph.power(*b, *x) {
            Ok(value) => self.check_size(value, exponent_span),
            Err(PowerError::ExponentNotNumber) => self.fail(
                Fault::new(exponent_span, "the exponent is not a number")
                    .help("a variable exponent is written `exp(y*ln(x))`"),
            ),
            Err(PowerError::TooLarge) => self.fail(
                Fault::new(exponent_span, "the exponent is too large")
                    .note("exponents lie between -64 and 64, roots go up to the 64th, numbers up to 10^400"),
            ),
            Err(PowerError::NegativeBase) => {
                self.fail(Fault::new(base_span, "an even root of a negative number"))
            }
            Err(PowerError::DivisionByZero) => {
                self.fail(Fault::new(exponent_span, "a negative power of zero"))
            }
        }
    }

    /// Refuses a divisor that vanishes identically.
    pub(super) fn check_divisor(&mut self, divisor: ExprId, span: Span) -> Evaluated<()> {
        let vanishes = match self.bench.graph.as_number(divisor) {
            Some(number) => number.is_zero(),
            None => self.bench.vanishes(divisor),
        };
        if vanishes {
            return self.fail(Fault::new(span, "division by something that is identically zero"));
        }
        if self.bench.graph.as_number(divisor).is_none() {
            self.divisors.push((divisor, span));
        }
        Ok(())
    }

    /// The second look at divisors: on the holonomic constraints.
    pub(super) fn check_divisors_on_manifold(&mut self) {
        for (divisor, span) in std::mem::take(&mut self.divisors) {
            if self.bench.is_seen_to_vanish(divisor) {
                let text = self.bench.graph.text_limited(divisor, LONGEST_NOTE);
                let text = text.map_or_else(|| "the divisor".to_owned(), |text| format!("`{text}`"));
                self.faults.report(
                    Fault::new(span, "division by something that is identically zero")
                        .note(format!("{text} vanishes wherever the `holonomic` constraints hold")),
                );
            }
        }
    }

    /// The total time derivative of a function of time and coordinates.
    pub(super) fn total_rate(&mut self, e: ExprId) -> ExprId {
        match &mut self.rate {
            Some(rate) => rate.of(&mut self.bench.graph, e),
            // Before the coordinates are declared nothing moves but time.
            None => Flow::partial(&self.bench.graph, self.time).of(&mut self.bench.graph, e),
        }
    }

    fn added(&mut self, a: Value, b: Value, operator: AddOperator, span: Span) -> Evaluated {
        let minus = operator == AddOperator::Minus;
        match (&a, &b) {
            (Value::Scalar(a), Value::Scalar(b)) => {
                let b = if minus { self.opposite(*b) } else { *b };
                let sum = self.sum(*a, b);
                self.check_size(sum, span)
            }
            (Value::Vector(a), Value::Vector(b)) => {
                let b = if minus { self.opposite_vector(b) } else { *b };
                let sum = self.vector_sum(a, &b);
                self.checked_vector(sum, span)
            }
            _ => {
                let verb = if minus { "subtract" } else { "add" };
                self.fail(Fault::new(span, format!("cannot {verb} {} and {}", a.kind(), b.kind())))
            }
        }
    }

    /// Refuses numbers, exponents and lengths beyond what the language holds; of an expression whose parts were
    /// checked before.
    pub(super) fn check_size(&mut self, e: ExprId, span: Span) -> Evaluated {
        let large = |number: &Rational| number.bits() > MAX_NUMBER_BITS;
        let fault = match self.bench.graph.node(e) {
            Node::Number(value) if large(value) => NUMBER_TOO_LARGE,
            Node::Sum { constant, terms } if large(constant) || terms.iter().any(|(_, c)| large(c)) => {
                NUMBER_TOO_LARGE
            }
            Node::Sum { terms, .. } if terms.iter().any(|(term, _)| self.has_large_exponent(*term)) => {
                EXPONENT_TOO_LARGE
            }
            Node::Product(factors) if factors.len() > MAX_FACTORS => {
                let fault =
                    Fault::new(span, format!("a product of more than {MAX_FACTORS} different factors"));
                return self.fail(fault);
            }
            _ if self.has_large_exponent(e) => EXPONENT_TOO_LARGE,
            _ => return Ok(Value::Scalar(e)),
        };
        self.fail(Fault::new(span, fault))
    }

    fn has_large_exponent(&self, e: ExprId) -> bool {
        matches!(self.bench.graph.node(e), Node::Product(factors)
            if factors.iter().any(|(_, k)| k.abs() > MAX_EXPONENT))
    }

    /// Checks the size of every component as [`Evaluator::check_size`].
    pub(super) fn checked_vector(&mut self, v: Vector, span: Span) -> Evaluated {
        for e in v {
            self.check_size(e, span)?;
        }
        Ok(Value::Vector(v))
    }
}

const NUMBER_TOO_LARGE: &str = "this number is beyond 10^±400";
const EXPONENT_TOO_LARGE: &str = "this power, with the powers inside of it, is beyond the 1000th";

/// Characters of a formula in a note.
pub(super) const LONGEST_NOTE: usize = 200;
