//! Coefficients of friction and restitution, and what loads a grip.

use proc_macro2::Span;

use super::*;
use crate::model::accelerations::REACTION;
use crate::syntax::{Name, SPEED};

/// The load of a grip that is written as a reaction.
#[derive(Clone, Copy)]
pub(super) enum Loading {
    /// The force of a row, by its place among those of all contacts.
    Row(usize),
    /// The magnitude of a permanent constraint's reaction.
    Constraint(ExprId),
    /// A fault was reported.
    Fault,
}

impl<'a> Resolver<'a, '_> {
    /// A coefficient of friction, in which `speed` is the magnitude of the slip.
    pub(super) fn coefficient(
        &mut self,
        contact: &Contact,
        clause: &Clause,
        speed: Option<ExprId>,
    ) -> Evaluated<ExprId> {
        let inside = speed.filter(|_| clause.word == ClauseWord::Friction);
        let own = inside.map(|speed| (SPEED.to_owned(), Value::Scalar(speed)));
        self.eval.functions.frames.push(own.into_iter().collect());
        let place = match clause.word {
            // The whole system has checked it. Here a switch is not held, and may stand for velocities and states.
            _ if self.declaration.in_mode.is_some() => ExpressionPlace::Let,
            ClauseWord::Stiction => ExpressionPlace::Stiction,
            _ => ExpressionPlace::Friction,
        };
        let value = self.eval.scalar_at(place, &clause.value);
        self.eval.functions.frames.pop();
        let value = self.without_inputs(contact, clause, value)?;
        self.not_below_zero(contact, clause, value, speed)
    }

    /// The limit of a grip, or its load where that is an expression.
    pub(super) fn force_of_grip(&mut self, contact: &Contact, clause: &Clause) -> Evaluated<ExprId> {
        let place = if clause.word == ClauseWord::Load {
            ExpressionPlace::GripLoad
        } else {
            ExpressionPlace::GripForce
        };
        let value = self.eval.scalar_at(place, &clause.value)?;
        self.not_below_zero(contact, clause, value, None)
    }

    /// A value of which it is not seen that it is below zero, itself or by the default of the constant that it is.
    fn not_below_zero(
        &mut self,
        contact: &Contact,
        clause: &Clause,
        value: ExprId,
        speed: Option<ExprId>,
    ) -> Evaluated<ExprId> {
        let (word, name) = (clause.word.text(), &contact.name);
        let signs = self.signs(value, speed);
        let text = match self.default_of(value) {
            _ if !signs.above && !signs.zero => format!("the {word} of `{name}` is below zero"),
            _ if !signs.above && !self.eval.bench.vanishes(value) => {
                format!("the {word} of `{name}` is nowhere above zero")
            }
            Some((constant, default)) if default < 0.0 => {
                format!("the {word} `{constant}` of `{name}` is below zero by its default")
            }
            _ if contact.clause(ClauseWord::Grip).is_some() && self.eval.bench.graph.is_zero(value) => {
                let fault = Fault::new(clause.value.extent(), format!("the {word} of `{name}` is zero"));
                return self.eval.fail(fault.note("a grip without force holds nothing"));
            }
            _ => return Ok(value),
        };
        self.eval.fail(Fault::new(clause.value.extent(), text))
    }

    /// The name and the default of the constant that an expression is, where the default is a number.
    fn default_of(&self, value: ExprId) -> Option<(&'a Name, f64)> {
        let graph = &self.eval.bench.graph;
        let symbol = graph.as_symbol(value)?;
        let constant = self.constants.iter().find(|c| graph.as_symbol(c.symbol) == Some(symbol))?;
        Some((constant.name, graph.as_number(constant.default?)?.to_f64()))
    }

    /// A condition, which depends on no input; that of a release has to pass through zero.
    pub(super) fn condition(
        &mut self,
        contact: &Contact,
        clause: &Clause,
        value: Evaluated<ExprId>,
    ) -> Evaluated<ExprId> {
        let value = self.without_inputs(contact, clause, value)?;
        if clause.word == ClauseWord::When {
            return self.undecided(contact, clause, value);
        }
        if !self.passes_through_zero(value) && !self.jumps_above_zero(value) {
            let is_constant = self.eval.bench.graph.roles(value).is_constant();
            let does = if is_constant { "changes" } else { "passes through zero" };
            let text = format!("the release of `{}` never {does}", contact.name);
            let fault = Fault::new(clause.value.extent(), text);
            return self.eval.fail(fault.note("a latch is free again where its release rises through zero"));
        }
        Ok(value)
    }

    /// The coefficient of restitution: of constants, from 0 to 1.
    pub(super) fn restitution(&mut self, contact: &Contact, clause: &Clause) -> Evaluated<ExprId> {
        let value = self.eval.scalar_at(ExpressionPlace::Restitution, &clause.value)?;
        let graph = &self.eval.bench.graph;
        let span = clause.value.extent();
        if let Some(number) = graph.as_number(value) {
            let number = number.to_f64();
            if !(0.0..=1.0).contains(&number) {
                let text = format!("restitution {} lies outside of 0 to 1", clause.value.source());
                return self.eval.fail(Fault::new(span, text));
            }
            return Ok(value);
        }
        let symbol = graph.as_symbol(value);
        let plain = self.constants.iter().find(|c| symbol.is_some() && graph.as_symbol(c.symbol) == symbol);
        if let Some(constant) = plain {
            let number = |e: Option<ExprId>| e.and_then(|e| graph.as_number(e)).map(|n| n.to_f64());
            let name = constant.name;
            let is_outside = |limits: [ExprId; 2]| {
                let [lower, upper] = limits.map(|limit| number(Some(limit)));
                lower.is_some_and(|lower| lower < 0.0) || upper.is_some_and(|upper| upper > 1.0)
            };
            if constant.limits.is_some_and(is_outside) {
                let text = format!("restitution `{name}` of `{}` may lie outside of 0 to 1", contact.name);
                let fault = Fault::new(span, text).note("by its limits");
                return self.eval.fail(fault.help(format!("declare `{name} in 0..1`")));
            }
            if constant.limits.is_none() && constant.default.is_none() {
                let text = format!("restitution `{name}` of `{}` may lie outside of 0 to 1", contact.name);
                return self.eval.fail(Fault::new(span, text).help(format!("declare `{name} in 0..1`")));
            }
            if constant.limits.is_none()
                && number(constant.default).is_some_and(|default| !(0.0..=1.0).contains(&default))
            {
                let text = format!("restitution `{name}` lies outside of 0 to 1 by its default");
                return self.eval.fail(Fault::new(span, text));
            }
            return Ok(value);
        }
        match self.outside_of_unit(value) {
            None => Ok(value),
            Some((verb, note)) => {
                let source = clause.value.source();
                let text = format!("restitution `{source}` of `{}` {verb} outside of 0 to 1", contact.name);
                let fault = Fault::new(span, text);
                self.eval.fail(note.into_iter().fold(fault, Fault::note))
            }
        }
    }

    /// A value in which switches may stand, and inputs may not. Where there is none, because of another fault, its names are looked at.
    pub(super) fn without_inputs(
        &mut self,
        contact: &Contact,
        clause: &Clause,
        value: Evaluated<ExprId>,
    ) -> Evaluated<ExprId> {
        let graph = &self.eval.bench.graph;
        let symbols = value.as_ref().ok().map(|value| graph.symbols_in(&[*value]));
        let is_inside = |symbol: ExprId| match &symbols {
            Some(symbols) => graph.as_symbol(symbol).is_some_and(|symbol| symbols.contains(&symbol)),
            None => self.place_of(&clause.value, symbol).is_some(),
        };
        let inputs: Vec<_> = self.inputs.iter().filter(|input| is_inside(input.symbol)).collect();
        let mut faults = Vec::new();
        for input in inputs {
            let span = self.place_of(&clause.value, input.symbol).unwrap_or(clause.value.extent());
            let text = format!("the {} of `{}` depends on an input", clause.word.text(), contact.name);
            faults.push(Fault::new(span, text).note(format!("`{}` is an input", input.name)));
        }
        faults.into_iter().map(|fault| self.eval.faults.report(fault)).last().map_or(value, Err)
    }

    /// The first name in an expression that brings in a symbol.
    pub(super) fn place_of(&self, e: &Expression, symbol: ExprId) -> Option<Span> {
        if let ExpressionKind::Name(name) = &e.kind {
            let parts = self.eval.scope.peek(&name.text)?.expressions();
            let graph = &self.eval.bench.graph;
            let has = graph.as_symbol(symbol).is_some_and(|s| graph.symbols_in(&parts).contains(&s));
            return has.then(|| name.span());
        }
        e.children().into_iter().find_map(|child| self.place_of(child, symbol))
    }

    /// The load of a grip, where it is written as a reaction.
    pub(super) fn loading(&mut self, grip: &Contact, clause: &Clause) -> Option<Loading> {
        let (call, axis) = match &clause.value.kind {
            ExpressionKind::Field { base, name } => (&base.kind, Some(name)),
            kind => (kind, None),
        };
        let ExpressionKind::Call { function, arguments, list } = call else { return None };
        let [Expression { kind: ExpressionKind::Name(name), .. }] = &arguments[..] else { return None };
        let scope = &self.eval.scope;
        if function.text != REACTION || scope.category(REACTION).is_some() {
            return None;
        }
        if scope.category(&name.text) == Some(Category::Constraint) {
            return Some(self.loading_constraint(name, axis));
        }
        if axis.is_some() {
            return None;
        }
        if let Some(fault) = self.circle(grip, name) {
            self.eval.faults.report(fault);
            return Some(Loading::Fault);
        }
        let Ok((name, contact)) = self.eval.contact_named(REACTION, arguments, *list) else {
            return Some(Loading::Fault);
        };
        if contact.kind != ContactKind::Smooth {
            let is =
                if contact.kind == ContactKind::Latch { "is a latch" } else { "has friction of its own" };
            let text = format!("`{name}` {is}, and cannot load a grip");
            self.eval.faults.report(
                Fault::new(name.span(), text)
                    .note("a grip is loaded by the force of a contact without friction"),
            );
            return Some(Loading::Fault);
        }
        let place = self.contacts.iter().position(|known| known.entry.name.text == name.text);
        let rows_of = |count: usize| self.contacts[..count].iter().map(|known| known.entry.rows.len()).sum();
        Some(place.map_or(Loading::Fault, |place| Loading::Row(rows_of(place))))
    }

    /// The reaction of a permanent constraint that loads a grip, of a vector the component along an axis.
    fn loading_constraint(&mut self, name: &Name, axis: Option<&Name>) -> Loading {
        let Ok(forms) = self.eval.name(name) else { return Loading::Fault };
        let own = match (forms, axis) {
            (Value::Scalar(form), None) => Some(form),
            (Value::Vector(forms), Some(axis)) => {
                let place = ["x", "y", "z"].iter().position(|known| *known == axis.text);
                place.map(|place| forms[place]).filter(|form| !self.eval.bench.graph.is_zero(*form))
            }
            _ => None,
        };
        let fault = match (own, axis) {
            (Some(form), _) => match self.eval.multipliers(Value::Scalar(form), name) {
                Value::Scalar(reaction) => return Loading::Constraint(reaction),
                _ => return Loading::Fault,
            },
            (None, None) => Fault::new(name.span(), format!("`{name}` has several reactions"))
                .note("a grip is loaded by one of them")
                .help(format!("write one component: `reaction({name}).x`")),
            (None, Some(axis)) => {
                Fault::new(axis.span(), format!("the reaction of `{name}` has no component `{axis}`"))
            }
        };
        self.eval.faults.report(fault);
        Loading::Fault
    }

    /// The fault of a grip that is loaded by its own force, or by that of another grip.
    fn circle(&self, grip: &Contact, name: &Name) -> Option<Fault> {
        if name.text == grip.name.text {
            let fault = Fault::new(name.span(), format!("`{name}` is loaded by its own force"));
            return Some(fault.note("a grip is loaded by the force of a contact without friction"));
        }
        let sections = self.declaration.items.iter().filter_map(|item| match item {
            Item::Contacts(section) => Some(section),
            _ => None,
        });
        let other = sections.flat_map(|section| &section.entries).find(|entry| entry.name.text == name.text);
        other?.clause(ClauseWord::Grip)?;
        let fault = Fault::new(name.span(), format!("`{name}` is a grip, and cannot load another"));
        Some(fault.note("a grip is loaded by the force of a contact without friction"))
    }
}
