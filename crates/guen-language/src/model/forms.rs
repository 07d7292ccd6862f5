//! Parameters and constraints as linear forms: declared, taken apart, and checked one by one.

use std::collections::BTreeMap;

use guen_symbolic::{ExprId, Form, Role, Roles, Substitution, VelocityForm, VelocityPartials, Verdict};
use proc_macro2::Span;

use super::evaluate::{Evaluated, Evaluator, children};
use super::place::Place;
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
    /// The sides as written, for blame.
    pub(super) sides: Vec<&'a Expression>,
}

/// The suffixes of components.
const AXES: [&str; 3] = ["_x", "_y", "_z"];

impl Evaluator<'_> {
    /// `name = e;` in `parameters`: a scalar, or a vector that declares its components.
    pub(super) fn parameter<'a>(&mut self, definition: &'a Definition, forms: &mut Vec<RawForm<'a>>) {
        let value = self.at(Place::Parameter, &definition.value);
        let sides = vec![&definition.value];
        self.declare_forms(
            &definition.name,
            &definition.docs,
            FormKind::Parameter,
            value,
            None,
            sides,
            forms,
        );
    }

    /// `name: l = r;` in `constraints`: `eta_v = l - r`; zero may stand for the zero vector.
    pub(super) fn constraint<'a>(&mut self, equation: &'a Equation, forms: &mut Vec<RawForm<'a>>) {
        let value = self.difference(Place::Constraint, equation);
        let sides = vec![&equation.left, &equation.right];
        self.declare_forms(&equation.name, &equation.docs, FormKind::Constraint, value, None, sides, forms);
    }

    /// `name: l = r;` in `holonomic`: the form is the rate of `l - r`.
    pub(super) fn holonomic<'a>(&mut self, equation: &'a Equation, forms: &mut Vec<RawForm<'a>>) {
        let position = self.difference(Place::Holonomic, equation);
        let (value, position) = match position {
            Ok(Value::Scalar(f)) => (Ok(Value::Scalar(self.total_rate(f))), Some(vec![f])),
            Ok(Value::Vector(f)) => (Ok(Value::Vector(self.vector_rate(&f))), Some(f.to_vec())),
            other => (other, None),
        };
        let sides = vec![&equation.left, &equation.right];
        self.declare_forms(
            &equation.name,
            &equation.docs,
            FormKind::Holonomic,
            value,
            position,
            sides,
            forms,
        );
    }

    fn difference(&mut self, place: Place, equation: &Equation) -> Evaluated {
        let (left, right) = (self.at(place, &equation.left), self.at(place, &equation.right));
        let (left, right) = (left?, right?);
        let is_zero = |value: &Value| matches!(value, Value::Scalar(e) if self.bench.graph.is_zero(*e));
        match (&left, &right) {
            (Value::Vector(_), zero) if is_zero(zero) => Ok(left),
            (zero, Value::Vector(v)) if is_zero(zero) => {
                Ok(Value::Vector(v.map(|e| self.bench.graph.neg(e))))
            }
            (Value::Scalar(a), Value::Scalar(b)) => Ok(Value::Scalar(self.bench.graph.sub(*a, *b))),
            (Value::Vector(a), Value::Vector(b)) => {
                Ok(Value::Vector(std::array::from_fn(|i| self.bench.graph.sub(a[i], b[i]))))
            }
            _ => self.fail(Fault::new(
                equation.equals,
                format!(
                    "the sides of an equation are of one kind, and these are {} and {}",
                    left.kind(),
                    right.kind()
                ),
            )),
        }
    }

    #[allow(
        clippy::too_many_arguments,
        reason = "one call for each of the three sections, side by side above"
    )]
    fn declare_forms<'a>(
        &mut self,
        name: &'a Name,
        docs: &'a Docs,
        kind: FormKind,
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
        let push =
            |this: &mut Self, forms: &mut Vec<RawForm<'a>>, text: &str, definition: ExprId, i: usize| {
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
                    position: position.as_ref().map(|f| f[i]),
                    sides: sides.clone(),
                });
                this.expansions.insert(symbol, definition);
                symbol
            };
        match value {
            Err(_) => self.scope.declare(self.faults, name, category, None),
            Ok(Value::Vector(components)) => {
                let mut symbols = [self.bench.graph.zero(); 3];
                for (i, (definition, axis)) in components.into_iter().zip(AXES).enumerate() {
                    let text = format!("{}{axis}", name.text);
                    let value = if self.vanishes_as_form(definition) {
                        // 0 = 0: nothing to impose, nothing to name.
                        self.left_out.push(text.clone());
                        self.bench.graph.zero()
                    } else {
                        push(self, forms, &text, definition, i)
                    };
                    symbols[i] = value;
                    let value = Some(Value::Scalar(value));
                    self.scope.declare_component(self.faults, &text, name.span(), category, value);
                }
                self.scope.declare(self.faults, name, category, Some(Value::Vector(symbols)));
            }
            Ok(Value::Scalar(definition)) => {
                let symbol = push(self, forms, &name.text, definition, 0);
                self.scope.declare(self.faults, name, category, Some(Value::Scalar(symbol)));
            }
            Ok(_) => {}
        }
    }

    fn vanishes_as_form(&mut self, definition: ExprId) -> bool {
        let expanded = self.expanded(definition);
        self.bench.vanishes(expanded)
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

    /// Takes every form apart; what is not an affine form of the velocities is reported.
    pub(super) fn linear_forms(&mut self, raw: &[RawForm<'_>], velocities: &[ExprId]) -> Option<Vec<Form>> {
        let mut partials = VelocityPartials::new(&self.bench, velocities, &[]);
        let mut forms = Vec::new();
        let mut healthy = true;
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
                healthy = false;
                continue;
            }
            let mut row = vec![self.bench.graph.zero(); velocities.len()];
            for (i, a) in parts.on_velocities {
                row[i] = a;
            }
            forms.push(Form { row, offset: parts.offset });
        }
        healthy.then_some(forms)
    }

    fn report_not_affine(&mut self, form: &RawForm<'_>, partials: &mut VelocityPartials) {
        let noun = noun(form.entry.kind);
        let mut span = form.sides[0].extent();
        let mut term = None;
        for side in &form.sides {
            if let Some(guilty) = self.guilty_term(side, partials) {
                (span, term) = (guilty.0, Some(guilty.1));
                break;
            }
        }
        let mut fault =
            Fault::new(span, format!("{noun} `{}` is not affine in the velocities", form.entry.name));
        if let Some(term) = term {
            fault = fault.note(format!("`{term}` is not"));
        }
        self.faults.report(fault);
    }

    /// The smallest summand that is not affine by itself.
    fn guilty_term(&mut self, e: &Expression, partials: &mut VelocityPartials) -> Option<(Span, String)> {
        let value = match self.bench_value(e)? {
            Value::Scalar(value) => vec![value],
            Value::Vector(v) => v.to_vec(),
            _ => return None,
        };
        let affine = value.into_iter().all(|value| {
            let expanded = self.expanded(value);
            partials.affine(&mut self.bench, expanded).is_some()
        });
        if affine {
            return None;
        }
        if matches!(e.kind, ExpressionKind::Sum { .. } | ExpressionKind::Negation(_)) {
            for child in children(e) {
                if let Some(found) = self.guilty_term(child, partials) {
                    return Some(found);
                }
            }
        }
        Some((e.span, e.to_string()))
    }

    /// The value of an expression that was evaluated without a fault before.
    fn bench_value(&mut self, e: &Expression) -> Option<Value> {
        self.value(e).ok()
    }

    fn report_without_velocity(&mut self, form: &RawForm<'_>, parts: &VelocityForm) {
        let name = &form.entry.name;
        let span = form.entry.written.span();
        let noun = noun(form.entry.kind);
        let fault = match self.bench.verdict_on_manifold(parts.offset) {
            Verdict::Zero => Fault::new(span, format!("{noun} `{name}` vanishes identically"))
                .help("remove it: it says `0 = 0`"),
            _ if form.entry.kind == FormKind::Constraint => {
                let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
                if self.bench.graph.roles(parts.offset).meets(moving) {
                    Fault::new(span, format!("constraint `{name}` has no velocity in it")).help(format!(
                        "a condition on positions is declared as `holonomic {{ {name}: .. = ..; }}`"
                    ))
                } else {
                    Fault::new(
                        span,
                        format!("constraint `{name}` has no velocity in it and cannot be fulfilled"),
                    )
                }
            }
            _ if form.entry.kind == FormKind::Holonomic => {
                Fault::new(span, format!("holonomic constraint `{name}` does not depend on the coordinates"))
            }
            _ if self.bench.graph.roles(parts.offset).is_constant() => {
                Fault::new(span, format!("parameter `{name}` has no velocity in it"))
                    .note("parameters are the quasi-velocities of the system")
                    .help("a physical constant is declared under `constants`")
            }
            _ => Fault::new(span, format!("parameter `{name}` has no velocity in it"))
                .note("parameters are the quasi-velocities of the system: affine in the velocities")
                .help("a name for an expression is declared by `let`"),
        };
        self.faults.report(fault);
    }
}

/// What a form is called.
pub(super) fn noun(kind: FormKind) -> &'static str {
    match kind {
        FormKind::Parameter => "parameter",
        FormKind::Constraint => "constraint",
        FormKind::Holonomic => "holonomic constraint",
    }
}
