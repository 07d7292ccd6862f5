//! Signs of what is written in contacts, as far as limits of constants, switches and speeds tell.

use guen_symbolic::{PossibleSigns, Rational};

use super::*;

impl Resolver<'_, '_> {
    /// The signs that an expression may have: constants lie within their limits, switches between 0 and 1, and a speed is not
    /// below zero.
    pub(super) fn signs(&self, e: ExprId, speed: Option<ExprId>) -> PossibleSigns {
        let graph = &self.eval.bench.graph;
        let (zero, one) = (Rational::ZERO, Rational::ONE);
        let mut limits: Vec<(ExprId, [Option<Rational>; 2])> = Vec::new();
        for constant in &self.constants {
            let number = |limit: ExprId| graph.as_number(limit).cloned();
            limits.extend(constant.limits.map(|limits| (constant.symbol, limits.map(number))));
        }
        limits.extend(self.switches.iter().map(|s| (s.symbol, [Some(zero.clone()), Some(one.clone())])));
        limits.extend(speed.map(|speed| (speed, [Some(zero), None])));
        graph.signs_within(e, &limits)
    }

    /// Whether an expression may pass through zero: it changes during a motion, and has no sign that is proved.
    pub(in crate::model::resolve) fn passes_through_zero(&self, e: ExprId) -> bool {
        let moving = [Role::Time, Role::Coordinate, Role::Velocity, Role::QuasiVelocity, Role::State];
        let roles = self.eval.bench.graph.roles(e);
        let signs = self.signs(e, None);
        moving.into_iter().any(|role| roles.has(role)) && signs.below && signs.above
    }

    /// Whether an expression may jump above zero, as a switch does.
    pub(super) fn jumps_above_zero(&self, e: ExprId) -> bool {
        let graph = &self.eval.bench.graph;
        let symbols = graph.symbols_in(&[e]);
        let is_inside = |switch: ExprId| graph.as_symbol(switch).is_some_and(|s| symbols.contains(&s));
        let signs = self.signs(e, None);
        signs.above
            && (signs.below || signs.zero)
            && self.switches.iter().any(|switch| is_inside(switch.symbol))
    }

    /// The condition of a contact, of which it is not seen that it always or never holds. An instance may be given such a one by an
    /// argument.
    pub(super) fn undecided(
        &mut self,
        contact: &Contact,
        clause: &Clause,
        value: ExprId,
    ) -> Evaluated<ExprId> {
        let signs = self.signs(value, None);
        let mut names = BTreeSet::new();
        names_in(&clause.value, &mut names);
        if contact.name.text.contains('.') && !names.is_empty() || signs.above && (signs.below || signs.zero)
        {
            return Ok(value);
        }
        let (name, does) = match contact.clause(ClauseWord::Latch) {
            Some(_) => (&contact.name, "locks"),
            None => (&contact.name, "closes"),
        };
        let span = clause.value.extent();
        let fault = match signs.above {
            true => Fault::new(span, format!("the condition of `{name}` always holds"))
                .note("it is above zero everywhere")
                .help("leave `when` out"),
            false => Fault::new(span, format!("the condition of `{name}` never holds"))
                .note(format!("it is nowhere above zero, so that `{name}` never {does}")),
        };
        self.eval.fail(fault)
    }

    /// Returns how an expression of constants lies outside of 0 to 1, with the reason: by the ranges of its constants, or in a corner of
    /// their limits, where constants without limits have their defaults.
    pub(super) fn outside_of_unit(&mut self, value: ExprId) -> Option<(&'static str, Option<String>)> {
        let one = self.eval.bench.graph.one();
        let above_one = self.eval.bench.graph.sub(value, one);
        let (of_value, of_rest) = (self.signs(value, None), self.signs(above_one, None));
        if !of_value.above && !of_value.zero || !of_rest.below && !of_rest.zero {
            return Some(("lies", None));
        }
        let graph = &mut self.eval.bench.graph;
        let symbols = graph.symbols_in(&[value]);
        let inside = |graph: &Graph, e: ExprId| graph.as_symbol(e).is_some_and(|s| symbols.contains(&s));
        let limited: Vec<(&str, ExprId, [ExprId; 2])> = self
            .constants
            .iter()
            .filter(|constant| inside(graph, constant.symbol))
            .filter_map(|constant| Some((constant.name.text.as_str(), constant.symbol, constant.limits?)))
            .collect();
        let is_by_defaults = limited.is_empty();
        if limited.len() > MOST_LIMITED {
            return None;
        }
        for corner in 0..1_usize << limited.len() {
            let ends =
                limited.iter().enumerate().map(|(i, (_, symbol, ends))| (*symbol, ends[corner >> i & 1]));
            let mut at = Substitution::new(ends.collect::<Vec<_>>());
            let mut found = at.of(graph, value);
            // Defaults are of earlier constants.
            for constant in self.constants.iter().rev().filter(|constant| constant.limits.is_none()) {
                let Some(default) = constant.default else { continue };
                found = Substitution::new([(constant.symbol, default)]).of(graph, found);
            }
            let Some(number) = graph.as_number(found).map(Rational::to_f64) else { continue };
            if (0.0..=1.0).contains(&number) {
                continue;
            }
            if is_by_defaults {
                return Some(("lies", Some(format!("by the defaults of its constants it is {number}"))));
            }
            let mut places = Vec::new();
            for (i, (name, _, ends)) in limited.iter().enumerate() {
                let end = graph.text_limited(ends[corner >> i & 1], LIMIT_CHARACTERS).unwrap_or_default();
                places.push(format!("`{name} = {end}`"));
            }
            let note = format!("at {} it is {number}", places.join(", "));
            return Some(("may lie", Some(note)));
        }
        None
    }
}

/// The most constants with limits whose corners are looked at.
const MOST_LIMITED: usize = 6;

/// The most characters of a limit in a message.
const LIMIT_CHARACTERS: usize = 40;
