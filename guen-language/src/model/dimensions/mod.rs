//! Checks the dimensions of a declaration with units, and infers those of names without one.
//!
//! The input is a declaration without faults of names and kinds. Names are visited in their order; each fault is reported at the
//! smallest sum, product or argument that cannot be.

mod expressions;
mod unknowns;

use std::collections::{BTreeMap, BTreeSet};

use guen_symbolic::Rational;

use crate::diagnostics::Faults;
use crate::syntax::{
    ClauseWord, Contact, Declaration, Dimension, Expression, ExpressionKind, Inertia, Item, Reset, Unit,
};
use expressions::{Dimensions, NUMBER, Quantity, per_second};
use unknowns::{Partial, Unknowns};

/// Names with their units: as written, or as they follow.
pub type Units = BTreeMap<String, String>;

/// Checks the dimensions of a declaration. None of a name without any, nor where nothing has a unit.
pub(super) fn units(declaration: &Declaration, faults: &mut Faults) -> Units {
    let written = declared_units(declaration);
    if written.is_empty() {
        return Units::new();
    }
    let mut dimensions = Dimensions {
        faults,
        unknowns: Unknowns::default(),
        names: BTreeMap::new(),
        numbers: BTreeMap::new(),
        functions: BTreeMap::new(),
        supplied: BTreeMap::new(),
        forms: BTreeSet::new(),
    };
    let mut shown = Vec::new();
    // Gravity may stand behind the bodies.
    let gravity = declaration.items.iter().find_map(|item| match item {
        Item::Gravity(quantity) => Some(quantity),
        _ => None,
    });
    let mut weights: Vec<(Partial, Partial)> = Vec::new();
    for item in &declaration.items {
        if let Item::States(section) = item {
            for state in &section.entries {
                let own = dimensions.declared(state.unit.as_ref());
                dimensions.names.insert(state.name.text.clone(), own);
                shown.push(state.name.text.clone());
            }
        }
    }
    for item in &declaration.items {
        dimensions.item(item, &mut shown, &mut weights);
    }
    if let Some(gravity) = gravity
        && let Quantity::Of(field) = dimensions.of(&gravity.value)
    {
        for (mass, position) in weights {
            let wanted =
                of("J").times(&mass, &Rational::integer(-1)).times(&position, &Rational::integer(-1));
            dimensions.require(&gravity.value, Quantity::Of(field.clone()), wanted, "gravity");
        }
    }
    let mut units = Units::new();
    for name in shown {
        let Some(Quantity::Of(own)) = dimensions.names.get(&name) else { continue };
        let mut say = |name: String, of: Partial| {
            if let Some(own) = dimensions.unknowns.resolved(&of).known() {
                // That of a torque, too.
                let unit = own.short();
                units.insert(name, if unit == "J" { "N*m".to_owned() } else { unit });
            }
        };
        if dimensions.forms.contains(&name) {
            let per_rate = |unit: &str| of(unit).times(own, &Rational::integer(-1));
            say(momentum(&name), per_rate("J"));
            say(reaction(&name), per_rate("W"));
            say(residual(&name), own.times(&expressions::seconds(1), &Rational::integer(1)));
        }
        say(name, own.clone());
    }
    units.extend(written.into_iter().map(|(name, unit)| (name.to_owned(), unit.text.clone())));
    units
}

/// The name under which the unit of a form's momentum `dT/d eta` stands.
pub fn momentum(form: &str) -> String {
    format!("dT/d{form}")
}

/// The name under which the unit of a constraint's reaction stands.
pub fn reaction(constraint: &str) -> String {
    format!("reaction({constraint})")
}

/// The name under which the unit of what is left of a constraint on positions stands.
pub fn residual(constraint: &str) -> String {
    format!("residual({constraint})")
}

/// The names with units of their own.
fn declared_units(declaration: &Declaration) -> Vec<(&str, &Unit)> {
    let mut found = Vec::new();
    for item in &declaration.items {
        match item {
            Item::Constants(section) => {
                let units =
                    section.entries.iter().map(|entry| (entry.name.text.as_str(), entry.unit.as_ref()));
                found.extend(units.filter_map(|(name, unit)| Some((name, unit?))));
            }
            Item::Coordinates(section) | Item::Inputs(section) => {
                let units =
                    section.entries.iter().map(|entry| (entry.name.text.as_str(), entry.unit.as_ref()));
                found.extend(units.filter_map(|(name, unit)| Some((name, unit?))));
            }
            Item::States(section) => {
                let units =
                    section.entries.iter().map(|entry| (entry.name.text.as_str(), entry.unit.as_ref()));
                found.extend(units.filter_map(|(name, unit)| Some((name, unit?))));
            }
            _ => {}
        }
    }
    found
}

/// The dimension of a unit.
fn of(unit: &str) -> Partial {
    Dimension::of_unit(unit).unwrap_or_else(Dimension::one).into()
}

impl Dimensions<'_> {
    /// The dimension of something declared: that of its unit, or an unknown one.
    fn declared(&mut self, unit: Option<&Unit>) -> Quantity {
        Quantity::Of(match unit {
            Some(unit) => unit.dimension.clone().into(),
            None => self.unknowns.fresh(),
        })
    }

    /// A number takes the unit of what it is a value of; what names are in has one of its own.
    fn value_of(&mut self, name: &str, value: &Expression) {
        if !has_names(value) {
            return;
        }
        let own = self.of(value);
        if let Some(Quantity::Of(wanted)) = self.names.get(name).cloned() {
            self.require(value, own, wanted, &format!("`{name}`"));
        }
    }

    fn energy(&mut self, value: &Expression, what: &str) {
        let own = self.of(value);
        self.require(value, own, of("J"), what);
    }

    fn equation(&mut self, left: &Expression, right: &Expression, equals: proc_macro2::Span) -> Quantity {
        let (a, b) = (self.of(left), self.of(right));
        let (l, r) = (format!("`{}`", left.source()), format!("`{}`", right.source()));
        self.shared((a, &l), (b, &r), equals, "the sides of this equation have different dimensions")
    }

    fn form(&mut self, name: &str, own: Quantity, shown: &mut Vec<String>) {
        for axis in ["", "_x", "_y", "_z"] {
            let name = crate::names::suffixed(name, axis);
            self.names.insert(name.clone(), own.clone());
            self.forms.insert(name.clone());
            shown.push(name);
        }
    }

    fn item(&mut self, item: &Item, shown: &mut Vec<String>, weights: &mut Vec<(Partial, Partial)>) {
        match item {
            Item::Count(_) => {}
            Item::Constants(section) => {
                for entry in &section.entries {
                    let own = self.declared(entry.unit.as_ref());
                    self.names.insert(entry.name.text.clone(), own);
                    shown.push(entry.name.text.clone());
                    entry.default.iter().for_each(|default| self.value_of(&entry.name.text, default));
                }
            }
            Item::Coordinates(section) | Item::Inputs(section) => {
                for entry in &section.entries {
                    let own = self.declared(entry.unit.as_ref());
                    self.names.insert(entry.name.text.clone(), own);
                    shown.push(entry.name.text.clone());
                    if matches!(item, Item::Coordinates(_)) {
                        // In case it is chosen as a parameter.
                        let rate = crate::names::suffixed(&entry.name.text, crate::names::RATE_SUFFIX);
                        self.names.insert(rate.clone(), per_second(self.names[&entry.name.text].clone()));
                        self.forms.insert(rate.clone());
                        shown.push(rate);
                    }
                    let limits = entry.limits.iter().flat_map(|limits| limits.iter());
                    limits.for_each(|limit| self.value_of(&entry.name.text, limit));
                }
            }
            Item::Let(definition) => {
                let own = self.of(&definition.value);
                self.numbers
                    .extend(self.number(&definition.value).map(|n| (definition.name.text.clone(), n)));
                self.names.insert(definition.name.text.clone(), own);
            }
            Item::Argument(argument) => {
                let value = &argument.given.value;
                let own = self.of(value);
                self.numbers.extend(self.number(value).map(|n| (argument.name.text.clone(), n)));
                self.names.insert(argument.name.text.clone(), own);
            }
            Item::Functions(section) => {
                for function in &section.entries {
                    // Each has one dimension, and so has each of its arguments, whatever the program supplies.
                    let arguments = function.arguments.iter().map(|_| self.unknowns.fresh()).collect();
                    let value = self.unknowns.fresh();
                    self.supplied.insert(function.name.text.clone(), (arguments, value));
                }
            }
            Item::Function(function) => {
                self.functions.insert(function.name.text.clone(), function.clone());
            }
            Item::Parameters(section) => {
                for entry in &section.entries {
                    let own = self.of(&entry.value);
                    self.form(&entry.name.text, own, shown);
                }
            }
            Item::Outputs(section) => {
                for entry in &section.entries {
                    let own = self.of(&entry.value);
                    self.names.insert(entry.name.text.clone(), own);
                    shown.push(entry.name.text.clone());
                }
            }
            Item::Constraints(section) => {
                for entry in &section.entries {
                    let own = self.equation(&entry.left, &entry.right, entry.equals);
                    self.form(&entry.name.text, own, shown);
                }
            }
            Item::Holonomic(section) => {
                for entry in &section.entries {
                    let own = self.equation(&entry.left, &entry.right, entry.equals);
                    self.form(&entry.name.text, per_second(own), shown);
                }
            }
            Item::KineticEnergy(quantity) => self.energy(&quantity.value, "the kinetic energy"),
            Item::ForceFunction(quantity) => self.energy(&quantity.value, "the force function"),
            Item::PotentialEnergy(quantity) => self.energy(&quantity.value, "the potential energy"),
            Item::Particles(section) => {
                for particle in &section.entries {
                    self.mass(&particle.mass, &particle.position, weights);
                }
            }
            Item::Bodies(section) => {
                for body in &section.entries {
                    if let (Some(mass), Some(center)) = (&body.mass, &body.center) {
                        self.mass(&mass.value, &center.value, weights);
                    }
                    let entries: &[Expression] = match body.inertia.as_ref().map(|field| &field.value) {
                        Some(Inertia::Diagonal(entries)) => &entries[..],
                        Some(Inertia::Symmetric(entries)) => &entries[..],
                        _ => &[],
                    };
                    for entry in entries {
                        let own = self.of(entry);
                        // Angles are numbers: the energy is `1/2 I omega^2`.
                        let moment = of("J").times(&expressions::seconds(2), &Rational::integer(1));
                        self.require(entry, own, moment, "a moment of inertia");
                    }
                    if let Some(orientation) = &body.orientation {
                        self.of(&orientation.value);
                    }
                    let center = body.center.as_ref().map(|field| self.of(&field.value));
                    let center = center.and_then(|own| match own {
                        Quantity::Of(own) => Some(own),
                        _ => None,
                    });
                    self.names.insert(body.name.text.clone(), Quantity::Body(center));
                }
            }
            // Their names are known from the beginning.
            Item::States(section) => {
                for state in &section.entries {
                    let own = per_second(self.names[&state.name.text].clone());
                    let rate = self.of(&state.rate);
                    let (l, r) = (format!("`dot({})`", state.name), format!("`{}`", state.rate.source()));
                    let message = "the sides of this equation have different dimensions";
                    self.shared((own, &l), (rate, &r), state.equals, message);
                }
            }
            Item::Forces(section) => {
                for force in &section.entries {
                    let (own, along) = (self.of(&force.force), self.of(&force.direction));
                    if let (Quantity::Of(own), Quantity::Of(along)) = (own, along) {
                        let wanted = of("W").times(&along, &Rational::integer(-1));
                        let direction = self.written(&along);
                        let what = if direction == NUMBER {
                            "a force along a number".to_owned()
                        } else {
                            format!("a force along a velocity in {direction}")
                        };
                        self.require(&force.force, Quantity::Of(own), wanted, &what);
                    }
                }
            }
            Item::Scene(scene) => {
                for fix in &scene.fixes {
                    fix.value.iter().for_each(|value| self.value_of(&fix.name.text, value));
                }
            }
            Item::Switches(section) => {
                for switch in &section.entries {
                    self.of(&switch.value);
                    self.names.insert(switch.name.text.clone(), Quantity::Of(Partial::one()));
                }
            }
            Item::Contacts(section) => section.entries.iter().for_each(|contact| self.contact(contact)),
            Item::Resets(section) => section.entries.iter().for_each(|reset| self.reset(reset)),
            Item::Gravity(_) | Item::Provide(_) | Item::Modes(_) | Item::Component(_) | Item::Use(_) => {}
        }
    }

    /// A variable and its new value have one dimension.
    fn reset(&mut self, reset: &Reset) {
        self.of(&reset.function);
        for given in &reset.assignments {
            let (own, value) = (self.of(&given.variable), self.of(&given.value));
            let (l, r) = (format!("`{}`", given.variable.source()), format!("`{}`", given.value.source()));
            let message = "the variable and its new value have different dimensions";
            self.shared((own, &l), (value, &r), given.equals, message);
        }
    }

    /// Coefficients are numbers, and the limit of a grip is a force along its velocity.
    fn contact(&mut self, contact: &Contact) {
        let mut along = None;
        for clause in &contact.clauses {
            let outer = match (clause.word, &along) {
                (ClauseWord::Friction, Some(slip)) => {
                    Some(self.names.insert("speed".to_owned(), Quantity::clone(slip)))
                }
                _ => None,
            };
            let own = self.of(&clause.value);
            if let Some(outer) = outer {
                match outer {
                    Some(outer) => self.names.insert("speed".to_owned(), outer),
                    None => self.names.remove("speed"),
                };
            }
            let word = clause.word.text();
            match clause.word {
                ClauseWord::Slip | ClauseWord::Grip => along = Some(own),
                ClauseWord::Friction | ClauseWord::Stiction | ClauseWord::Restitution => {
                    self.require(&clause.value, own, Partial::one(), &format!("the {word}"));
                }
                ClauseWord::Limit | ClauseWord::Load => {
                    if let Some(Quantity::Of(along)) = &along {
                        let wanted = of("W").times(along, &Rational::integer(-1));
                        self.require(&clause.value, own, wanted, &format!("the {word}"));
                    }
                }
                _ => {}
            }
        }
    }

    /// A mass at a place: its kinetic energy is an energy.
    fn mass(&mut self, mass: &Expression, position: &Expression, weights: &mut Vec<(Partial, Partial)>) {
        let (own, place) = (self.of(mass), self.of(position));
        let (Quantity::Of(own), Quantity::Of(place)) = (own, place) else { return };
        let wanted = of("J").times(&place.raised(&Rational::integer(-2)), &Rational::integer(1));
        let wanted = wanted.times(&expressions::seconds(2), &Rational::integer(1));
        let place_written = self.written(&place);
        if self.require(
            mass,
            Quantity::Of(own.clone()),
            wanted,
            &format!("a mass at a place in {place_written}"),
        ) {
            weights.push((own, place));
        }
    }
}

/// Whether a name stands in an expression, other than that of a number.
fn has_names(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Name(name) => name.text != "pi",
        _ => e.children().into_iter().any(has_names),
    }
}
