//! The gap of a contact, and the velocity along it.

use guen_symbolic::{Role, Roles, VelocityPartials};

use super::*;

/// The velocity along a contact.
#[derive(Default)]
pub(super) struct Along {
    /// The components that do not vanish.
    pub(super) forms: Vec<ExprId>,
    /// The structure of each.
    pub(super) shapes: Vec<Option<FormShape>>,
    /// The axis of each, where a vector was written.
    pub(super) axes: Vec<&'static str>,
}

impl Resolver<'_, '_> {
    /// The gap: a function of time and coordinates.
    pub(super) fn gap(&mut self, contact: &Contact, clause: &Clause) -> Evaluated<ExprId> {
        let place =
            if clause.word == ClauseWord::Latch { ExpressionPlace::Latch } else { ExpressionPlace::Gap };
        let gap = self.eval.scalar_at(place, &clause.value)?;
        let what = if clause.word == ClauseWord::Latch { "latch" } else { "gap" };
        let (name, span) = (&contact.name, clause.value.extent());
        let fault = |text: String| Fault::new(span, format!("the {what} of `{name}` {text}"));
        if !self.eval.bench.graph.roles(gap).has(Role::Coordinate) {
            return self.eval.fail(fault("never changes".to_owned()).note("it depends on no coordinate"));
        }
        let signs = self.signs(gap, None);
        if !signs.zero {
            let sign = if signs.above { "above" } else { "below" };
            let fault = fault("never reaches zero".to_owned());
            return self.eval.fail(fault.note(format!("it is {sign} zero everywhere")));
        }
        if !signs.above && clause.word == ClauseWord::Gap {
            return self
                .eval
                .fail(fault("is nowhere above zero".to_owned()).note("a contact is open where its gap is"));
        }
        Ok(gap)
    }

    /// Whether an expression has a parameter in it that is no velocity: a fault of the parameter, which is told with all forms.
    fn has_faulty_parameter(&self, form: ExprId) -> bool {
        let graph = &self.eval.bench.graph;
        let velocity = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity));
        let symbols = graph.symbols_in(&[form]);
        self.parameters.iter().map(|parameter| parameter.symbol).any(|parameter| {
            let is_inside = graph.as_symbol(parameter).is_some_and(|symbol| symbols.contains(&symbol));
            let meaning = self.eval.expansions.get(&parameter);
            is_inside && meaning.is_some_and(|meaning| !graph.roles(*meaning).meets(velocity))
        })
    }

    /// The velocity along a contact: its components that do not vanish, each with its structure.
    pub(super) fn slip(&mut self, contact: &Contact, clause: &Clause) -> Evaluated<Along> {
        let word = clause.word.text();
        let name = &contact.name;
        let place =
            if clause.word == ClauseWord::Grip { ExpressionPlace::Grip } else { ExpressionPlace::Slip };
        let value = self.eval.at(place, &clause.value)?;
        let (forms, shapes): (Vec<_>, Vec<_>) = match &value {
            Value::Scalar(form) => vec![(*form, self.eval.shapes.form(*form))],
            Value::Vector(v) => {
                let (graph, shapes) = (&self.eval.bench.graph, &self.eval.shapes);
                (0..3).map(|i| (v[i], shapes.component(graph, v, i))).collect()
            }
            other => {
                let text =
                    format!("the {word} of `{name}` is a scalar or a vector, and this is {}", other.kind());
                return self.eval.fail(Fault::new(clause.value.extent(), text));
            }
        }
        .into_iter()
        .unzip();
        let moving = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity));
        if !forms.iter().any(|form| self.eval.bench.graph.roles(*form).meets(moving)) {
            let text = format!("the {word} of `{name}` has no velocity");
            let fault = Fault::new(clause.value.extent(), text);
            return self.eval.fail(fault.help("the rate of a coordinate is written `dot(x)`"));
        }
        let mut kept = Along::default();
        let is_vector = matches!(value, Value::Vector(_));
        let velocities = self.velocities.clone();
        for ((form, shape), axis) in forms.into_iter().zip(shapes).zip(["x", "y", "z"]) {
            let expanded = self.eval.expanded(form);
            let mut partials = VelocityPartials::new(&self.eval.bench, &velocities, &[]);
            let Some(parts) = partials.affine(&mut self.eval.bench, expanded) else {
                let guilty = self.eval.guilty(&clause.value, &mut |eval, e| {
                    let e = eval.expanded(e);
                    let mut partials = VelocityPartials::new(&eval.bench, &velocities, &[]);
                    partials.affine(&mut eval.bench, e).is_some()
                });
                let (span, term) = guilty.unwrap_or((clause.value.span, clause.value.source()));
                let text = format!("the {word} of `{name}` is not linear in the velocities");
                return self.eval.fail(Fault::new(span, text).note(format!("`{term}` is not")));
            };
            if !parts.on_velocities.is_empty() || self.has_faulty_parameter(form) {
                kept.forms.push(form);
                kept.shapes.push(shape);
                kept.axes.extend(is_vector.then_some(axis));
            } else if !self.eval.bench.vanishes(parts.offset) {
                let text = format!("the {word} of `{name}` has a component without velocity");
                return self.eval.fail(Fault::new(clause.value.extent(), text));
            }
        }
        if kept.forms.len() > 2 {
            let text = format!("the {word} of `{name}` has three components");
            let fault = Fault::new(clause.value.extent(), text)
                .note("a contact has a normal and at most two tangents")
                .help("write the tangential ones: `vec(inner(v, a), inner(v, b))`");
            return self.eval.fail(fault);
        }
        if kept.forms.is_empty() {
            let text = format!("the {word} of `{name}` has no velocity");
            return self.eval.fail(Fault::new(clause.value.extent(), text));
        }
        Ok(kept)
    }
}
