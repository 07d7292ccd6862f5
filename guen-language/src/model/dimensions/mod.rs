//! Checks the dimensions of a declaration with units, and infers those of names without one.
//!
//! Names are visited in their order; each fault is reported at the smallest sum, product or argument that cannot be. Statements in
//! which other faults were found are skipped, and the names that they declare fit every dimension. So each fault that is found in the rest
//! is a fault of the whole declaration.

mod expressions;
mod unknowns;

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use guen_symbolic::Rational;

use crate::damage::Sound;
use crate::diagnostics::{Faults, collect};
use crate::syntax::{
    Body, ClauseWord, Contact, Declaration, Dimension, Equation, Expression, ExpressionKind, Inertia, Item,
    Name, Quantity as Written, Reset, Unit,
};
use expressions::{Dimensions, NUMBER, Quantity, per_second};
use unknowns::{Partial, Unknowns};

/// Names with their units: as written, or as they follow.
pub type Units = BTreeMap<String, String>;

/// Checks the dimensions of a declaration that cannot be understood otherwise.
pub(crate) fn check(declaration: &Declaration, faults: &mut Faults) {
    units(declaration, faults.count(), faults);
}

/// Checks the dimensions of a declaration, as far as faults that were reported before leave them. None of a name without any, nor
/// where nothing has a unit. The first `unread` of the faults were found before names had a meaning.
pub(super) fn units(declaration: &Declaration, unread: usize, faults: &mut Faults) -> Units {
    if declared_units(declaration).is_empty() {
        return Units::new();
    }
    let sound = Rc::new(Sound::new(declaration, faults.found(), unread));
    let pass = |unknowns: Unknowns| collect(|faults| pass(declaration, &sound, unknowns, faults));
    let ((units, _), report) = pass(Unknowns::default());
    if report.is_empty() {
        return units;
    }
    // A name without a unit gets the dimension that most of its uses agree on. The first use may be the fault.
    let mut elected = BTreeMap::new();
    for _ in 0..MOST_ROUNDS {
        let ((_, unknowns), _) = pass(Unknowns::voting(elected.clone()));
        let winners = unknowns.winners();
        if winners.is_empty() {
            break;
        }
        elected.extend(winners);
    }
    let (_, report) = pass(Unknowns::elected(elected));
    faults.absorb(report);
    units
}

/// The most rounds in which unknown dimensions follow from each other.
const MOST_ROUNDS: usize = 10;

/// Visits a declaration once.
fn pass(
    declaration: &Declaration,
    sound: &Rc<Sound>,
    unknowns: Unknowns,
    faults: &mut Faults,
) -> (Units, Unknowns) {
    let mut dimensions = Dimensions {
        faults,
        sound: Rc::clone(sound),
        unknowns,
        names: BTreeMap::new(),
        numbers: BTreeMap::new(),
        functions: BTreeMap::new(),
        contacts: BTreeMap::new(),
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
                dimensions.declare(&state.name, state.unit.as_ref());
                shown.push(state.name.text.clone());
            }
        }
    }
    for (place, item) in declaration.items.iter().enumerate() {
        let before = dimensions.faults.count();
        dimensions.item(item, &mut shown, &mut weights);
        if let Some(origin) = declaration.origins.get(place).copied().flatten() {
            let instance = &declaration.instances[origin];
            dimensions.faults.of_instance(before, &instance.used(), instance.place);
        }
    }
    if let Some(gravity) = gravity
        && sound.has(gravity.value.first_token())
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
    units.extend(
        declared_units(declaration).into_iter().map(|(name, unit)| (name.to_owned(), unit.text.clone())),
    );
    (units, dimensions.unknowns)
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
    /// Declares a name with the dimension of its unit, or an unknown one.
    fn declare(&mut self, name: &Name, unit: Option<&Unit>) {
        let own = match unit {
            Some(unit) if self.sound.is_read(name.span()) => Quantity::Of(unit.dimension.clone().into()),
            None if self.sound.has(name.span()) => Quantity::Of(self.unknowns.fresh()),
            _ => Quantity::Anything,
        };
        self.name_of(name, own);
    }

    /// Lets a name stand for something. Nothing is known of one that is declared twice: its last statement has a fault.
    fn name_of(&mut self, name: &Name, own: Quantity) {
        self.names.insert(name.text.clone(), own);
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

    fn energy(&mut self, written: &Written, what: &str) {
        if self.sound.has(written.keyword) {
            let own = self.of(&written.value);
            self.require(&written.value, own, of("J"), what);
        }
    }

    fn equation(&mut self, equation: &Equation) -> Quantity {
        if !self.sound.has(equation.name.span()) {
            return Quantity::Anything;
        }
        let (a, b) = (self.of(&equation.left), self.of(&equation.right));
        let (l, r) = (format!("`{}`", equation.left.source()), format!("`{}`", equation.right.source()));
        let message = "the sides of this equation have different dimensions";
        self.shared((a, &l), (b, &r), equation.equals, message)
    }

    /// The dimension of the value of a statement; nothing is known where a fault was found in it.
    fn of_whole(&mut self, name: &Name, value: &Expression) -> Quantity {
        if self.sound.has(name.span()) { self.of(value) } else { Quantity::Anything }
    }

    fn form(&mut self, name: &Name, own: Quantity, shown: &mut Vec<String>) {
        let name = name.text.as_str();
        for axis in ["", "_x", "_y", "_z"] {
            let name = crate::names::suffixed(name, axis);
            self.names.insert(name.clone(), own.clone());
            self.forms.insert(name.clone());
            shown.push(name);
        }
    }

    fn item(&mut self, item: &Item, shown: &mut Vec<String>, weights: &mut Vec<(Partial, Partial)>) {
        let sound = Rc::clone(&self.sound);
        match item {
            Item::Count(_) => {}
            Item::Constants(section) => {
                for entry in &section.entries {
                    self.declare(&entry.name, entry.unit.as_ref());
                    shown.push(entry.name.text.clone());
                    let before = self.faults.count();
                    let default = entry.default.iter().filter(|_| sound.has(entry.name.span()));
                    default.for_each(|default| self.value_of(&entry.name.text, default));
                    // All instances of a component have their constants here: a fault in a default is kept once.
                    self.faults.keep_since(before, |_| true);
                }
            }
            Item::Coordinates(section) | Item::Inputs(section) => {
                for entry in &section.entries {
                    self.declare(&entry.name, entry.unit.as_ref());
                    shown.push(entry.name.text.clone());
                    if matches!(item, Item::Coordinates(_)) {
                        // In case it is chosen as a parameter.
                        let rate = crate::names::suffixed(&entry.name.text, crate::names::RATE_SUFFIX);
                        self.names.insert(rate.clone(), per_second(self.names[&entry.name.text].clone()));
                        self.forms.insert(rate.clone());
                        shown.push(rate);
                    }
                    let limits = entry.limits.iter().filter(|_| sound.has(entry.name.span()));
                    let limits = limits.flat_map(|limits| limits.iter());
                    limits.for_each(|limit| self.value_of(&entry.name.text, limit));
                }
            }
            Item::Let(definition) => self.named(&definition.name, &definition.value, &definition.name),
            Item::Argument(argument) => {
                self.named(&argument.name, &argument.given.value, &argument.given.name);
            }
            Item::Functions(section) => {
                for function in section.entries.iter().filter(|function| sound.has(function.name.span())) {
                    // Each has one dimension, and so has each of its arguments, whatever the program supplies.
                    let arguments = function.arguments.iter().map(|_| self.unknowns.fresh()).collect();
                    let value = self.unknowns.fresh();
                    self.supplied.insert(function.name.text.clone(), (arguments, value));
                }
            }
            Item::Function(function) => {
                if sound.has(function.name.span()) && self.is_sound(function) {
                    self.functions.insert(function.name.text.clone(), function.clone());
                }
            }
            Item::Parameters(section) => {
                for entry in &section.entries {
                    let own = self.of_whole(&entry.name, &entry.value);
                    self.form(&entry.name, own, shown);
                }
            }
            Item::Outputs(section) => {
                for entry in &section.entries {
                    let own = self.of_whole(&entry.name, &entry.value);
                    self.name_of(&entry.name, own);
                    shown.push(entry.name.text.clone());
                }
            }
            Item::Constraints(section) => {
                for entry in &section.entries {
                    let own = self.equation(entry);
                    self.form(&entry.name, own, shown);
                }
            }
            Item::Holonomic(section) => {
                for entry in &section.entries {
                    let own = self.equation(entry);
                    self.form(&entry.name, per_second(own), shown);
                }
            }
            Item::KineticEnergy(quantity) => self.energy(quantity, "the kinetic energy"),
            Item::ForceFunction(quantity) => self.energy(quantity, "the force function"),
            Item::PotentialEnergy(quantity) => self.energy(quantity, "the potential energy"),
            Item::Particles(section) => {
                for particle in &section.entries {
                    if sound.has(particle.mass.first_token()) {
                        self.mass(&particle.mass, &particle.position, weights);
                    }
                }
            }
            Item::Bodies(section) => section.entries.iter().for_each(|body| self.body(body, weights)),
            // Their names are known from the beginning.
            Item::States(section) => {
                for state in section.entries.iter().filter(|state| sound.has(state.name.span())) {
                    let own = per_second(self.names[&state.name.text].clone());
                    let rate = self.of(&state.rate);
                    let (l, r) = (format!("`dot({})`", state.name), format!("`{}`", state.rate.source()));
                    let message = "the sides of this equation have different dimensions";
                    self.shared((own, &l), (rate, &r), state.equals, message);
                }
            }
            Item::Forces(section) => {
                for force in section.entries.iter().filter(|force| sound.has(force.force.first_token())) {
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
                for fix in scene.fixes.iter().filter(|fix| sound.has(fix.name.span())) {
                    fix.value.iter().for_each(|value| self.value_of(&fix.name.text, value));
                }
            }
            Item::Switches(section) => {
                for switch in &section.entries {
                    self.of_whole(&switch.name, &switch.value);
                    self.name_of(&switch.name, Quantity::Of(Partial::one()));
                }
            }
            Item::Contacts(section) => {
                for contact in section.entries.iter().filter(|contact| sound.has(contact.name.span())) {
                    self.contact(contact);
                }
            }
            Item::Resets(section) => {
                for reset in section.entries.iter().filter(|reset| sound.has(reset.name.span())) {
                    self.reset(reset);
                }
            }
            Item::Gravity(_) | Item::Provide(_) | Item::Modes(_) | Item::Component(_) | Item::Use(_) => {}
        }
    }

    /// A name for an expression, of a statement that begins with `place`.
    fn named(&mut self, name: &Name, value: &Expression, place: &Name) {
        let own = self.of_whole(place, value);
        if self.sound.has(place.span()) {
            self.numbers.extend(self.number(value).map(|number| (name.text.clone(), number)));
        }
        self.name_of(name, own);
    }

    /// A body: its mass at its centre, and its inertia.
    fn body(&mut self, body: &Body, weights: &mut Vec<(Partial, Partial)>) {
        if !self.sound.has(body.name.span()) {
            return self.name_of(&body.name, Quantity::Anything);
        }
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
        self.name_of(&body.name, Quantity::Body(center));
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
                ClauseWord::Slip | ClauseWord::Grip => {
                    self.contacts.insert(("slip", contact.name.text.clone()), own.clone());
                    along = Some(own);
                }
                ClauseWord::Gap | ClauseWord::Latch => {
                    self.contacts.insert(("gap", contact.name.text.clone()), own);
                }
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
