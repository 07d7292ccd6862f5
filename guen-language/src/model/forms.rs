//! Parameters (1.3), (1.6) and constraints (1.1) as linear forms: declared, taken apart, and checked one by one.

use std::collections::BTreeMap;

use guen_symbolic::{
    ExprId, Form, FormShape, Role, Roles, Substitution, VelocityForm, VelocityPartials, Verdict, decompose,
};
use proc_macro2::Span;

use super::evaluate::{Evaluated, Evaluator, LONGEST_NOTE};
use super::expression_place::ExpressionPlace;
use super::scope::Category;
use super::value::Value;
use super::{FormEntry, FormKind};
use crate::diagnostics::Fault;
use crate::syntax::{Definition, Docs, Equation, Expression, ExpressionKind, Name};

/// A form before the coordinates' matrix is known: its definition in velocities and names of forms.
pub(super) struct RawForm<'a> {
    pub(super) entry: FormEntry<'a>,
    /// The symbol `eta_j`.
    pub(super) symbol: ExprId,
    /// `l - r`, over velocities and symbols of forms declared before.
    pub(super) definition: ExprId,
    /// `f(t, x)` for a holonomic constraint.
    pub(super) position: Option<ExprId>,
    /// The form in terms of points and frames, where it is declared so: what the system graph holds.
    pub(super) shape: Option<FormShape>,
    /// The sides as written, for blame.
    pub(super) sides: Vec<&'a Expression>,
}

/// The name, the documentation and the kind of the entry that declares a form.
struct FormHeading<'a> {
    name: &'a Name,
    docs: &'a Docs,
    kind: FormKind,
}

/// The suffixes of components.
const AXES: [&str; 3] = ["_x", "_y", "_z"];

impl Evaluator<'_> {
    /// `name = e;` in `parameters`: a scalar, or a vector that declares its components.
    pub(super) fn parameter<'a>(&mut self, definition: &'a Definition, forms: &mut Vec<RawForm<'a>>) {
        self.entry = Some(definition.name.text.clone());
        let value = self.at(ExpressionPlace::Parameter, &definition.value);
        let sides = vec![&definition.value];
        self.declare_forms(
            FormHeading { name: &definition.name, docs: &definition.docs, kind: FormKind::Parameter },
            value,
            None,
            sides,
            forms,
        );
    }

    /// `name: l = r;` in `constraints`: `eta_v = l - r`; zero may stand for the zero vector.
    pub(super) fn constraint<'a>(&mut self, equation: &'a Equation, forms: &mut Vec<RawForm<'a>>) {
        let value = self.difference(ExpressionPlace::Constraint, equation);
        let sides = vec![&equation.left, &equation.right];
        self.declare_forms(
            FormHeading { name: &equation.name, docs: &equation.docs, kind: FormKind::Constraint },
            value,
            None,
            sides,
            forms,
        );
    }

    /// `name: l = r;` in `holonomic`: the form is the rate of `l - r`.
    pub(super) fn holonomic<'a>(&mut self, equation: &'a Equation, forms: &mut Vec<RawForm<'a>>) {
        let position = self.difference(ExpressionPlace::Holonomic, equation);
        let position = position.and_then(|position| self.somewhere(equation, position));
        let (value, position) = match position {
            Ok(Value::Scalar(f)) => {
                let rate = self.total_rate(f);
                self.shapes.scalar_rate(&self.bench.graph, f, rate);
                (Ok(Value::Scalar(rate)), Some(vec![f]))
            }
            Ok(Value::Vector(f)) => (Ok(Value::Vector(self.vector_rate(&f))), Some(f.to_vec())),
            other => (other, None),
        };
        let sides = vec![&equation.left, &equation.right];
        self.declare_forms(
            FormHeading { name: &equation.name, docs: &equation.docs, kind: FormKind::Holonomic },
            value,
            position,
            sides,
            forms,
        );
    }

    /// The difference of the sides of an equation in positions, unless its range shows that it vanishes nowhere.
    fn somewhere(&mut self, equation: &Equation, position: Value) -> Evaluated {
        for f in position.expressions() {
            if !self.bench.graph.roles(f).has(Role::Coordinate) {
                continue;
            }
            let opposite = self.bench.graph.neg(f);
            let graph = &self.bench.graph;
            let found = [f, opposite].into_iter().find(|f| graph.is_above_zero(*f));
            if found.is_none() && !graph.vanishes_nowhere(f) {
                continue;
            }
            let name = &equation.name.text;
            let fault =
                Fault::new(equation.equals, format!("holonomic constraint `{name}` cannot be fulfilled"));
            let text = graph.text_limited(found.unwrap_or(f), LONGEST_NOTE);
            let says = if found.is_some() { "is above zero" } else { "differs from zero" };
            return self.fail(match text {
                Some(text) => fault.note(format!("`{text}` {says} at all positions")),
                None => fault.note(format!("the difference of its sides {says} at all positions")),
            });
        }
        Ok(position)
    }

    fn difference(&mut self, place: ExpressionPlace, equation: &Equation) -> Evaluated {
        self.entry = Some(equation.name.text.clone());
        let (left, right) = (self.at(place, &equation.left), self.at(place, &equation.right));
        let (left, right) = (left?, right?);
        let is_zero = |value: &Value| matches!(value, Value::Scalar(e) if self.bench.graph.is_zero(*e));
        match (&left, &right) {
            (Value::Vector(_), zero) if is_zero(zero) => Ok(left),
            (zero, Value::Vector(v)) if is_zero(zero) => Ok(Value::Vector(self.opposite_vector(&v.clone()))),
            (Value::Scalar(a), Value::Scalar(b)) => {
                let b = self.opposite(*b);
                Ok(Value::Scalar(self.sum(*a, b)))
            }
            (Value::Vector(a), Value::Vector(b)) => {
                let b = self.opposite_vector(b);
                Ok(Value::Vector(self.vector_sum(a, &b)))
            }
            _ => self.fail(
                Fault::new(
                    equation.equals,
                    format!(
                        "the sides of an equation are of one kind, and these are {} and {}",
                        left.kind(),
                        right.kind()
                    ),
                )
                .help("to impose one component write `inner(e, u) = 0` with a unit vector `u`"),
            ),
        }
    }

    fn declare_forms<'a>(
        &mut self,
        FormHeading { name, docs, kind }: FormHeading<'a>,
        value: Evaluated,
        position: Option<Vec<ExprId>>,
        sides: Vec<&'a Expression>,
        forms: &mut Vec<RawForm<'a>>,
    ) {
        let category = if kind == FormKind::Parameter { Category::Parameter } else { Category::Constraint };
        let value = match value {
            Ok(Value::Rotation(_) | Value::Body(_)) => {
                let fault = Fault::new(sides[0].extent(), "a form is a scalar or a vector");
                self.fail(fault)
            }
            other => other,
        };
        let push = |this: &mut Self,
                    forms: &mut Vec<RawForm<'a>>,
                    text: &str,
                    (definition, shape): (ExprId, Option<FormShape>),
                    i: usize| {
            let symbol = this.bench.graph.symbol(text, Role::QuasiVelocity);
            forms.push(RawForm {
                entry: FormEntry {
                    name: text.to_owned(),
                    written: name,
                    docs,
                    kind,
                    mentioned_in_energy: false,
                },
                symbol,
                definition,
                shape,
                position: position.as_ref().map(|f| f[i]),
                sides: sides.clone(),
            });
            this.expansions.insert(symbol, definition);
            symbol
        };
        match value {
            Err(_) => self.scope.declare(self.faults, name, category, None),
            Ok(Value::Vector(components)) => {
                // The fault of the whole is that of its components.
                let is_twice = self.scope.category(&name.text).is_some();
                let mut symbols = [self.bench.graph.zero(); 3];
                let before = forms.len();
                let mut places = [None; 3];
                for (i, (definition, axis)) in components.into_iter().zip(AXES).enumerate() {
                    let component = name.suffixed(axis);
                    let text = component.text.clone();
                    let value = if self.vanishes_as_form(definition) {
                        // 0 = 0: nothing to impose, nothing to name.
                        self.left_out.push(text.clone());
                        self.bench.graph.zero()
                    } else {
                        let shape = self.shapes.component(&self.bench.graph, &components, i);
                        places[i] = Some(forms.len());
                        push(self, forms, &text, (definition, shape), i)
                    };
                    symbols[i] = value;
                    if is_twice {
                        self.scope.excuse(text, name.span());
                    } else {
                        let value = Some(Value::Scalar(value));
                        self.scope.declare_component(self.faults, &component, category, value);
                    }
                }
                if self.shapes.is_velocity(&components) {
                    let parameters = kind == FormKind::Parameter;
                    self.vectors.push((parameters, places));
                }
                if forms.len() == before {
                    let noun = noun(kind);
                    self.faults.report(
                        Fault::new(name.span(), format!("{noun} `{name}` vanishes identically"))
                            .note("all its components say `0 = 0`")
                            .help(format!("remove `{name}`")),
                    );
                }
                self.scope.declare(self.faults, name, category, Some(Value::Vector(symbols)));
            }
            Ok(Value::Scalar(definition)) => {
                let shape = self.shapes.form(definition);
                let symbol = push(self, forms, &name.text, (definition, shape), 0);
                self.scope.declare(self.faults, name, category, Some(Value::Scalar(symbol)));
            }
            Ok(_) => {}
        }
    }

    fn vanishes_as_form(&mut self, definition: ExprId) -> bool {
        // Where the holonomic constraints declared so far hold.
        let expanded = self.expanded(definition);
        self.bench.verdict_on_manifold(expanded) == Verdict::Zero
    }

    /// Names of forms replaced by their definitions, down to the velocities.
    pub(super) fn expanded(&mut self, e: ExprId) -> ExprId {
        let mut e = e;
        // A form uses only forms declared before it, so that this ends.
        while self.bench.graph.roles(e).has(Role::QuasiVelocity) {
            let mut step =
                Substitution::new(self.expansions.iter().map(|(eta, definition)| (*eta, *definition)));
            e = step.of(&mut self.bench.graph, e);
        }
        e
    }

    /// Takes every form apart, and has it as it is written in velocities; what is not an affine form of these is
    /// reported. Beside the forms the number of those that should not be there at all.
    pub(super) fn linear_forms(
        &mut self,
        raw: &[RawForm<'_>],
        velocities: &[ExprId],
    ) -> (Option<Vec<(Form, ExprId)>>, usize) {
        let mut partials = VelocityPartials::new(&self.bench, velocities, &[]);
        let mut forms = Vec::new();
        let mut healthy = true;
        let mut idle = 0;
        // Components of one vector share their place: one report is enough.
        let mut blamed: BTreeMap<String, ()> = BTreeMap::new();
        for form in raw {
            let expanded = self.expanded(form.definition);
            let Some(parts) = partials.affine(&mut self.bench, expanded) else {
                if blamed.insert(form.entry.written.text.clone(), ()).is_none() {
                    self.report_not_affine(form, &mut partials);
                }
                healthy = false;
                continue;
            };
            if parts.on_velocities.is_empty() {
                if blamed.insert(form.entry.written.text.clone(), ()).is_none() {
                    self.report_without_velocity(form, &parts);
                }
                let is_condition = self.bench.graph.roles(parts.offset).has(Role::Coordinate);
                idle += usize::from(form.entry.kind == FormKind::Parameter || !is_condition);
                healthy = false;
                continue;
            }
            let mut row = vec![self.bench.graph.zero(); velocities.len()];
            for (i, a) in parts.on_velocities {
                row[i] = a;
            }
            forms.push((Form { row, offset: parts.offset }, expanded));
        }
        (healthy.then_some(forms), idle)
    }

    fn report_not_affine(&mut self, form: &RawForm<'_>, partials: &mut VelocityPartials) {
        let noun = noun(form.entry.kind);
        let mut guilty = None;
        for side in &form.sides {
            guilty = self.guilty(side, &mut |this, e| {
                let e = this.expanded(e);
                partials.affine(&mut this.bench, e).is_some()
            });
            if guilty.is_some() {
                break;
            }
        }
        let (span, term) = guilty.unwrap_or((form.sides[0].extent(), form.sides[0].source()));
        self.faults.report(
            Fault::new(span, format!("{noun} `{}` is not affine in the velocities", form.entry.name))
                .note(format!("`{term}` is not")),
        );
    }

    /// Reports a kinetic energy that is no polynomial of degree two in the velocities, at the term.
    pub(super) fn check_quadratic(
        &mut self,
        written: &Expression,
        energy: ExprId,
        velocities: &[ExprId],
        etas: &[ExprId],
    ) {
        let symbols: Vec<ExprId> = velocities.iter().chain(etas).copied().collect();
        let mut partials = VelocityPartials::new(&self.bench, velocities, etas);
        let mut quadratic =
            |this: &mut Self, e| decompose(&mut this.bench, &mut partials, &symbols, e).is_ok();
        if quadratic(self, energy) {
            return;
        }
        let guilty = self.guilty(written, &mut quadratic);
        let (span, term) = guilty.unwrap_or((written.extent(), written.source()));
        self.faults.report(
            Fault::new(span, "the kinetic energy is not quadratic in the velocities")
                .note(format!("`{term}` is not a polynomial of degree two in the velocities")),
        );
    }

    /// The smallest part of a sum, of a product with one guilty factor, that fails a test by itself: its place, and
    /// its text.
    pub(super) fn guilty(
        &mut self,
        e: &Expression,
        is_fine: &mut dyn FnMut(&mut Self, ExprId) -> bool,
    ) -> Option<(Span, String)> {
        // It was evaluated without a fault before.
        let parts = self.value(e).ok()?.expressions();
        if parts.into_iter().all(|part| is_fine(self, part)) {
            return None;
        }
        let inside = match &e.kind {
            ExpressionKind::Sum { .. } | ExpressionKind::Negation(_) | ExpressionKind::Product { .. } => {
                e.children()
            }
            _ => Vec::new(),
        };
        for child in inside {
            if let Some(found) = self.guilty(child, is_fine) {
                return Some(found);
            }
        }
        Some((e.span, shortened(&e.source())))
    }

    fn report_without_velocity(&mut self, form: &RawForm<'_>, parts: &VelocityForm) {
        let name = &form.entry.name;
        let span = form.entry.written.span();
        let noun = noun(form.entry.kind);
        let source = || form.sides.iter().map(|side| side.source()).collect::<Vec<_>>().join(" = ");
        let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
        let has_position = self.bench.graph.roles(parts.offset).has(Role::Coordinate);
        let fault = match (self.bench.verdict_on_manifold(parts.offset), form.entry.kind) {
            (Verdict::Zero, FormKind::Parameter) => {
                Fault::new(span, format!("parameter `{name}` vanishes identically"))
                    .help(format!("remove `{name}`"))
            }
            (Verdict::Zero, FormKind::Holonomic)
                if form.position.is_some_and(|left| !self.bench.vanishes(left)) =>
            {
                Fault::new(span, format!("holonomic constraint `{name}` does not depend on the coordinates"))
                    .note("it holds in every position, or in none")
                    .help(format!("remove `{name}`"))
            }
            (Verdict::Zero, _) => Fault::new(span, format!("{noun} `{name}` vanishes identically"))
                .note("it says `0 = 0`")
                .help(format!("remove `{name}`")),
            (_, FormKind::Constraint) if has_position => {
                let text = if form.entry.name == form.entry.written.text {
                    shortened(&source())
                } else {
                    ".. = ..".to_owned()
                };
                let written = &form.entry.written.text;
                Fault::new(span, format!("constraint `{name}` has no velocity in it"))
                    .note("a condition on positions enters by its rate")
                    .help(format!("declare it as `holonomic {{ {written}: {text}; }}`"))
            }
            (_, FormKind::Constraint) => {
                let text = self.bench.graph.text_limited(parts.offset, LONGEST_NOTE);
                let fault = Fault::new(
                    span,
                    format!("constraint `{name}` has no velocity in it and cannot be fulfilled"),
                );
                match text {
                    Some(text) => fault.note(format!("it requires `{text} = 0`")),
                    None => fault,
                }
            }
            (_, FormKind::Holonomic) => {
                let what = if self.bench.graph.roles(parts.offset).meets(moving) { "its rate" } else { "it" };
                Fault::new(span, format!("holonomic constraint `{name}` does not depend on the coordinates"))
                    .note(format!("{what} has no velocity in it, so that no motion can fulfil it"))
            }
            (_, FormKind::Parameter) if self.bench.graph.roles(parts.offset).is_constant() => {
                Fault::new(span, format!("parameter `{name}` has no velocity in it"))
                    .note("parameters are the quasi-velocities of the system, affine in the velocities")
                    .help(format!(
                        "a physical constant is declared as `constants {{ {name} = {}, .. }}`",
                        shortened(&source())
                    ))
            }
            (_, FormKind::Parameter) => Fault::new(span, format!("parameter `{name}` has no velocity in it"))
                .note("parameters are the quasi-velocities of the system, affine in the velocities")
                .help(format!(
                    "a name for an expression is declared as `let {name} = {};`",
                    shortened(&source())
                )),
        };
        self.faults.report(fault);
    }
}

/// Text that fits into a message.
fn shortened(text: &str) -> String {
    if text.chars().count() <= LONGEST_NOTE {
        return text.to_owned();
    }
    text.chars().take(LONGEST_NOTE).chain(['…']).collect()
}

/// Returns the word for a form of this kind.
pub(super) fn noun(kind: FormKind) -> &'static str {
    match kind {
        FormKind::Parameter => "parameter",
        FormKind::Constraint => "constraint",
        FormKind::Holonomic => "holonomic constraint",
    }
}
