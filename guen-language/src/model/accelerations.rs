//! Accelerations and reactions in outputs and in the rates of states: the only places where they may be named.
//!
//! There `dot(e)` of something with velocities or parameters is its rate along the motion, and `reaction(name)`
//! the multiplier of a constraint. The model introduces symbols for them; the derivation, which knows the motion, puts
//! in what they are.

use guen_symbolic::{ExprId, Flow, Role, Roles};
use proc_macro2::Span;

use super::evaluate::{Evaluated, Evaluator};
use super::expression_place::ExpressionPlace;
use super::scope::Category;
use super::value::{Value, Vector};
use crate::diagnostics::Fault;
use crate::syntax::{Expression, ExpressionKind, Name};

/// The word that is a function in outputs and in the rates of states, and a name like any other elsewhere.
pub(super) const REACTION: &str = "reaction";

impl Evaluator<'_> {
    /// Whether rates of velocities may be asked for.
    pub(super) fn knows_motion(&self) -> bool {
        matches!(self.place, ExpressionPlace::Output | ExpressionPlace::StateRate)
    }

    /// `d/dt` of a function of time, coordinates, velocities, quasi-velocities and states, along the motion.
    pub(super) fn rate_along_motion(&mut self, e: ExprId) -> ExprId {
        let graph = &mut self.bench.graph;
        let moving = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity));
        for symbol in graph.symbols_in(&[e]) {
            let info = graph.symbol_info(symbol);
            if !moving.has(info.role) {
                continue;
            }
            // Rates of parameters are written as in the equations of motion.
            let name = match info.role {
                Role::QuasiVelocity => format!("{}'", info.name),
                _ => format!("dot({})", info.name),
            };
            let of = graph.symbol_expr(symbol);
            self.motion.rates.entry(of).or_insert_with(|| graph.symbol(&name, Role::QuasiAcceleration));
        }
        let rates = self.motion.coordinates.iter().copied();
        let rates = rates.chain(self.motion.rates.iter().map(|(of, rate)| (*of, *rate)));
        let rates = rates.chain(self.states.iter().filter_map(|(of, rate)| Some((*of, (*rate)?))));
        let rates: Vec<_> = rates.chain([(self.time, graph.one())]).collect();
        Flow::new(graph, rates).of(graph, e)
    }

    /// The rate of a scalar, asked of the motion. Where frames and places say what it is it is kept whole: then no sum with others takes it
    /// apart.
    pub(super) fn measured_rate(&mut self, e: ExprId) -> ExprId {
        let rate = self.rate_along_motion(e);
        if self.shapes.measure_scalar(e) { self.bench.graph.keep(rate) } else { rate }
    }

    /// The rates of the components of a vector, asked of the motion, each as that of a scalar.
    pub(super) fn measured_rates(&mut self, v: &Vector) -> Vector {
        [0, 1, 2].map(|i| {
            let rate = self.rate_along_motion(v[i]);
            let is_known = self.shapes.measure_component(&self.bench.graph, v, i);
            if is_known { self.bench.graph.keep(rate) } else { rate }
        })
    }

    /// `reaction(name)`: the multiplier of a constraint, the three of a vector constraint.
    pub(super) fn reaction(&mut self, function: &Name, arguments: &[Expression], list: Span) -> Evaluated {
        if !self.knows_motion() {
            let place = self.place.description(self.entry.as_deref());
            let fault = Fault::new(function.span(), format!("{place} cannot depend on a reaction"));
            let fault =
                fault.note("reactions follow from the motion: only `outputs` and `states` may use them");
            return self.fail(match self.place {
                ExpressionPlace::GripForce | ExpressionPlace::GripLoad => fault.help(
                    "a grip is loaded by a contact without friction, or by a constraint, as `load = reaction(name)`: factors belong into `friction`",
                ),
                _ => fault,
            });
        }
        if let [Expression { kind: ExpressionKind::Missing, .. }] = arguments {
            return Err(self.faults.reported_before());
        }
        let [Expression { kind: ExpressionKind::Name(name), .. }] = arguments else {
            return self.fail(
                Fault::new(list, "`reaction` takes the name of a constraint")
                    .help("write `reaction(name)` with a name from `constraints` or `holonomic`"),
            );
        };
        if self.scope.category(&name.text) == Some(Category::Contact) {
            let contact = self.contact_named(REACTION, arguments, list)?.1;
            return Ok(match contact.is_held {
                true => self.multipliers(contact.reaction, name),
                false => contact.reaction,
            });
        }
        let value = self.name(name)?;
        let category = self.scope.category(&name.text);
        if category != Some(Category::Constraint) {
            let noun = category.map_or("no constraint", Category::noun);
            return self.fail(Fault::new(
                name.span(),
                format!("`{name}` is {noun}, and reactions are of constraints"),
            ));
        }
        Ok(self.multipliers(value, name))
    }

    /// The multipliers of forms.
    pub(super) fn multipliers(&mut self, value: Value, name: &Name) -> Value {
        let mut symbol_of = |eta: ExprId| {
            let Some(symbol) = self.bench.graph.as_symbol(eta) else { return eta };
            if self.bench.graph.symbol_info(symbol).role != Role::QuasiVelocity {
                return eta;
            }
            if let Some((_, known, _)) = self.motion.reactions.iter().find(|(of, ..)| *of == eta) {
                return *known;
            }
            let text = format!("reaction({})", self.bench.graph.symbol_info(symbol).name);
            let reaction = self.bench.graph.symbol(&text, Role::QuasiAcceleration);
            self.motion.reactions.push((eta, reaction, name.span()));
            reaction
        };
        match value {
            Value::Vector(etas) => Value::Vector(etas.map(&mut symbol_of)),
            Value::Scalar(eta) => Value::Scalar(symbol_of(eta)),
            other => other,
        }
    }
}
