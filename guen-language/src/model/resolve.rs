//! A declaration becomes a model: one pass over the items in the order in which they were written.

mod constants;
mod contacts;
mod count;
mod finish;
mod modes;
mod order;
mod provide;
mod redundant;
mod resets;
mod rolling;
mod states;

use std::collections::{BTreeMap, BTreeSet};

use guen_symbolic::{
    ExprId, FirstOrderState, Flow, Force, Forms, Graph, Holonomic, Mechanics, Multibody, RigidBody, Role,
    Roles, Substitution, WRITTEN_OUT_PARAMETERS, Workbench,
};

use super::assumed_rates::AssumedRates;
use super::bodies::{Weight, is_no_inertia, turns_about_several_axes};
use super::contact::{ResetEntry, SwitchEntry};
use super::evaluate::{Evaluated, Evaluator};
use super::expression_place::ExpressionPlace;
use super::forms::RawForm;
use super::scope::{Category, Scope};
use super::shapes::Shapes;
use super::spatial::inner;
use super::value::{BodyValue, Value};
use super::{BodyEntry, ConstantEntry, Load, Model, OutputEntry, SceneEntry, SymbolEntry};
use crate::damage::Damage;
use crate::diagnostics::{Fault, Faults};
use crate::syntax::{
    Argument, ArgumentKind, Declaration, Definition, Expression, ExpressionKind, Force as WrittenForce, Item,
    Quantity, Scene, SectionKind,
};

/// Checks names, kinds and forms. `None` if a fault was reported that leaves no model; after faults in what the motion does not need,
/// such as outputs, forces and contacts, the model is partial.
pub fn resolve<'a>(declaration: &'a Declaration, faults: &mut Faults) -> Option<Model<'a>> {
    resolved(declaration, Damage::None, faults)
}

/// Checks a declaration of which something may be missing, as [`resolve`] does.
pub(crate) fn resolved<'a>(
    declaration: &'a Declaration,
    damage: Damage,
    faults: &mut Faults,
) -> Option<Model<'a>> {
    let before = faults.count();
    let mut resolver = Resolver::new(declaration, faults);
    resolver.announce();
    resolver.is_whole = damage == Damage::None;
    resolver.is_core_sound = damage != Damage::Core && resolver.eval.faults.count() == before;
    for (place, item) in declaration.items.iter().enumerate() {
        let before = resolver.eval.faults.count();
        resolver.item(item);
        if resolver.eval.faults.count() > before {
            resolver.is_whole = false;
            resolver.is_core_sound &= is_leaf(item);
        }
        if let Some(origin) = declaration.origins.get(place).copied().flatten() {
            let instance = &declaration.instances[origin];
            resolver.eval.faults.of_instance(before, &instance.used(), instance.place);
        }
    }
    let (is_core_sound, mut model) = resolver.finish();
    let units = super::dimensions::units(declaration, before, faults);
    if let Some(model) = &mut model {
        model.units = units;
    }
    let mut model = model.filter(|_| is_core_sound)?;
    model.is_partial = damage != Damage::None || faults.count() > before;
    if model.is_partial {
        model.keep_core();
    }
    Some(model)
}

/// Whether the motion does not need an item: what is wrong in it hides nothing that is wrong elsewhere.
fn is_leaf(item: &Item) -> bool {
    matches!(
        item,
        Item::Forces(_)
            | Item::Switches(_)
            | Item::Contacts(_)
            | Item::Resets(_)
            | Item::Modes(_)
            | Item::Outputs(_)
            | Item::Provide(_)
            | Item::Scene(_)
    )
}

struct Resolver<'a, 'f> {
    declaration: &'a Declaration,
    /// Whether no fault was found so far, here or before.
    is_whole: bool,
    /// Whether none was found in what the motion needs.
    is_core_sound: bool,
    eval: Evaluator<'f>,
    constants: Vec<ConstantEntry<'a>>,
    inputs: Vec<SymbolEntry<'a>>,
    coordinates: Vec<SymbolEntry<'a>>,
    velocities: Vec<ExprId>,
    parameters: Vec<RawForm<'a>>,
    constraints: Vec<RawForm<'a>>,
    kinetic: Vec<ExprId>,
    energy: Option<&'a Quantity>,
    has_masses: bool,
    rigid_bodies: Vec<RigidBody>,
    written_energy: Option<ExprId>,
    weights: Vec<Weight>,
    gravity: Option<super::value::Vector>,
    force_function: Option<ExprId>,
    forces: Vec<Force>,
    bodies: Vec<BodyEntry>,
    particles: Vec<Weight>,
    states: Vec<SymbolEntry<'a>>,
    outputs: Vec<OutputEntry<'a>>,
    switches: Vec<SwitchEntry<'a>>,
    resets: Vec<ResetEntry<'a>>,
    contacts: Vec<contacts::RawContact<'a>>,
    /// Symbols of reactions that are not determined.
    undetermined: Vec<ExprId>,
    /// The reactions that the friction of slipping contacts depends on.
    loads: Vec<Load<'a>>,
    /// The squares of slips in a plane, whose directions friction needs, each with its reason.
    slips: Vec<(ExprId, String)>,
    /// Scenes as written: they may name parameters that are chosen once all forms are known.
    written_scenes: Vec<&'a Scene>,
    output_values: Vec<ExprId>,
    provides_operators: bool,
    provides_taylor: Option<&'a crate::syntax::Name>,
    provides_carried: Option<&'a crate::syntax::Name>,
    provides_source: Option<&'a crate::syntax::Name>,
}

impl<'a, 'f> Resolver<'a, 'f> {
    fn new(declaration: &'a Declaration, faults: &'f mut Faults) -> Self {
        let mut graph = Graph::new();
        graph.keep_angles_whole();
        let time = graph.symbol("t", Role::Time);
        let shapes = Shapes::new(&graph);
        Resolver {
            declaration,
            is_whole: true,
            is_core_sound: true,
            eval: Evaluator {
                faults,
                bench: Workbench::new(graph),
                shapes,
                vectors: Vec::new(),
                scope: Scope::default(),
                time,
                rate: None,
                place: ExpressionPlace::Let,
                entry: None,
                expansions: BTreeMap::new(),
                left_out: Vec::new(),
                motion: super::motion_symbols::MotionSymbols::default(),
                states: Vec::new(),
                contacts: BTreeMap::new(),
                quaternions: Vec::new(),
                functions: Default::default(),
                rates: AssumedRates::default(),
                divisors: Vec::new(),
            },
            constants: Vec::new(),
            inputs: Vec::new(),
            coordinates: Vec::new(),
            velocities: Vec::new(),
            parameters: Vec::new(),
            constraints: Vec::new(),
            kinetic: Vec::new(),
            energy: None,
            has_masses: false,
            rigid_bodies: Vec::new(),
            written_energy: None,
            weights: Vec::new(),
            gravity: None,
            force_function: None,
            forces: Vec::new(),
            bodies: Vec::new(),
            particles: Vec::new(),
            states: Vec::new(),
            outputs: Vec::new(),
            switches: Vec::new(),
            resets: Vec::new(),
            contacts: Vec::new(),
            undetermined: Vec::new(),
            loads: Vec::new(),
            slips: Vec::new(),
            written_scenes: Vec::new(),
            output_values: Vec::new(),
            provides_operators: false,
            provides_taylor: None,
            provides_carried: None,
            provides_source: None,
        }
    }

    /// Every name that is declared anywhere, so that a use before the declaration is told from an unknown name.
    fn announce(&mut self) {
        check_system_name(self.declaration, self.eval.faults);
        let scope = &mut self.eval.scope;
        for item in &self.declaration.items {
            match item {
                Item::Constants(section) => section.entries.iter().for_each(|e| scope.announce(&e.name)),
                Item::Inputs(section) | Item::Coordinates(section) => {
                    section.entries.iter().for_each(|e| scope.announce(&e.name));
                }
                Item::Let(definition) => scope.announce(&definition.name),
                Item::Argument(argument) => scope.announce_argument(&argument.name),
                Item::Function(function) => scope.announce(&function.name),
                Item::Functions(section) => section.entries.iter().for_each(|e| scope.announce(&e.name)),
                Item::Parameters(section) | Item::Outputs(section) => {
                    section.entries.iter().for_each(|e| scope.announce(&e.name));
                }
                Item::Constraints(section) | Item::Holonomic(section) => {
                    section.entries.iter().for_each(|e| scope.announce(&e.name));
                }
                Item::Bodies(section) => section.entries.iter().for_each(|e| scope.announce(&e.name)),
                Item::Switches(section) => section.entries.iter().for_each(|e| scope.announce(&e.name)),
                Item::Contacts(section) => {
                    section.entries.iter().for_each(|e| scope.announce_contact(&e.name));
                }
                Item::Resets(section) => section.entries.iter().for_each(|e| scope.announce(&e.name)),
                _ => {}
            }
        }
        self.declare_states();
    }

    fn item(&mut self, item: &'a Item) {
        match item {
            // Loops are unfolded, and counts known.
            Item::Count(_) => {}
            Item::Constants(section) => {
                section.entries.iter().for_each(|constant| self.constant(constant));
                self.check_defaults_of_arrays(&section.entries);
            }
            Item::Inputs(section) => {
                for plain in &section.entries {
                    let symbol = self.eval.bench.graph.symbol(&plain.name.text, Role::Input);
                    let limits = plain.limits.as_deref().and_then(|limits| self.limits(plain, limits));
                    self.declare_symbol(&plain.name, Category::Input, symbol);
                    self.inputs.push(SymbolEntry { name: &plain.name, docs: &plain.docs, symbol, limits });
                }
            }
            Item::Coordinates(section) => {
                for plain in &section.entries {
                    let symbol = self.eval.bench.graph.symbol(&plain.name.text, Role::Coordinate);
                    self.declare_symbol(&plain.name, Category::Coordinate, symbol);
                    self.coordinates.push(SymbolEntry {
                        name: &plain.name,
                        docs: &plain.docs,
                        symbol,
                        limits: None,
                    });
                }
                for plain in &section.entries {
                    let name = format!("dot({})", plain.name.text);
                    self.velocities.push(self.eval.bench.graph.symbol(&name, Role::Velocity));
                }
                let has_rows = |item: &Item| matches!(item, Item::Constraints(_) | Item::Holonomic(_));
                if self.coordinates.len() > WRITTEN_OUT_PARAMETERS
                    && !self.declaration.items.iter().any(has_rows)
                {
                    self.eval.bench.graph.nest_sums();
                }
                let graph = &self.eval.bench.graph;
                let moving = self.coordinates.iter().map(|c| c.symbol).zip(self.velocities.iter().copied());
                self.eval.motion.coordinates = moving.clone().collect();
                self.eval.rate = Some(Flow::new(graph, moving.chain([(self.eval.time, graph.one())])));
            }
            Item::Let(definition) => {
                self.eval.entry = Some(definition.name.text.clone());
                let value = self.eval.at(ExpressionPlace::Let, &definition.value).ok();
                value.iter().for_each(|value| self.eval.shapes.named(&definition.name.text, value));
                self.eval.scope.declare(self.eval.faults, &definition.name, Category::Let, value);
            }
            Item::Function(function) => self.eval.function(function),
            Item::Functions(section) => {
                section.entries.iter().for_each(|function| self.eval.supplied_function(function));
            }
            Item::Parameters(section) => {
                section.entries.iter().for_each(|p| self.eval.parameter(p, &mut self.parameters));
            }
            Item::Constraints(section) => {
                section.entries.iter().for_each(|c| self.eval.constraint(c, &mut self.constraints));
            }
            Item::Holonomic(section) => {
                section.entries.iter().for_each(|c| self.eval.holonomic(c, &mut self.constraints));
                self.judge_on_positions();
            }
            Item::KineticEnergy(quantity) => {
                self.energy.get_or_insert(quantity);
                if let Ok(energy) = self.eval.scalar_at(ExpressionPlace::KineticEnergy, &quantity.value) {
                    let etas = self.parameters.iter().chain(&self.constraints).map(|form| form.symbol);
                    let etas: Vec<ExprId> = etas.chain(self.eval.rates.symbols()).collect();
                    self.eval.check_quadratic(&quantity.value, energy, &self.velocities, &etas);
                    self.kinetic.push(energy);
                    // Those of components add up.
                    let before = self.written_energy.unwrap_or_else(|| self.eval.bench.graph.zero());
                    self.written_energy = Some(self.eval.bench.graph.add(before, energy));
                }
                let mut mentioned = BTreeSet::new();
                names_in(&quantity.value, &mut mentioned);
                for form in &mut self.constraints {
                    let entry = &mut form.entry;
                    entry.mentioned_in_energy |=
                        mentioned.contains(&entry.name) || mentioned.contains(&entry.written.text);
                }
            }
            Item::Particles(section) => {
                for particle in &section.entries {
                    self.has_masses = true;
                    if let Ok((energy, weight)) = self.eval.particle(particle) {
                        self.kinetic.push(energy);
                        self.particles.push(weight);
                        self.weights.push(weight);
                        let (mass, position) = weight;
                        let inertia = [self.eval.bench.graph.zero(); 6];
                        let center = Some(position);
                        self.eval.particle_node(weight);
                        let (orientation, spin) = (None, None);
                        self.rigid_bodies.push(RigidBody { mass, center, orientation, spin, inertia });
                    }
                }
            }
            Item::Bodies(section) => {
                for body in &section.entries {
                    self.has_masses = true;
                    let value = self.eval.body(body).ok().map(|(energy, weight, value)| {
                        self.kinetic.push(energy);
                        self.weights.extend(weight);
                        self.eval.body_node(&value);
                        let BodyValue { name, mass, inertia, center, orientation } = &value;
                        // Without a mass a centre moves nothing, and without inertia an orientation.
                        let zero = self.eval.bench.graph.zero();
                        let turned = inertia.and(orientation.as_ref());
                        self.rigid_bodies.push(RigidBody {
                            mass: mass.unwrap_or(zero),
                            center: mass.and(*center).map(|(position, _)| position),
                            orientation: turned.map(|rotation| rotation.matrix),
                            spin: turned.map(|rotation| rotation.body_rate),
                            inertia: inertia.unwrap_or([zero; 6]),
                        });
                        let is_impossible = inertia.zip(turned).is_some_and(|(inertia, rotation)| {
                            let bench = &mut self.eval.bench;
                            let velocities = &self.velocities;
                            is_no_inertia(&bench.graph, &inertia)
                                && turns_about_several_axes(bench, &rotation.body_rate, velocities)
                        });
                        self.bodies.push(BodyEntry {
                            is_impossible,
                            name: name.clone(),
                            mass: *mass,
                            inertia: *inertia,
                            center: center.map(|(position, _)| position),
                            orientation: orientation.as_ref().map(|rotation| rotation.matrix),
                        });
                        Value::Body(Box::new(value))
                    });
                    self.eval.scope.declare(self.eval.faults, &body.name, Category::Body, value);
                }
            }
            Item::Gravity(quantity) => {
                self.gravity = self.eval.vector_at(ExpressionPlace::Gravity, &quantity.value).ok()
            }
            Item::ForceFunction(quantity) => {
                let value = self.eval.scalar_at(ExpressionPlace::ForceFunction, &quantity.value).ok();
                self.add_force_function(value);
            }
            Item::PotentialEnergy(quantity) => {
                let potential = self.eval.scalar_at(ExpressionPlace::ForceFunction, &quantity.value).ok();
                let value = potential.map(|v| self.eval.bench.graph.neg(v));
                self.add_force_function(value);
            }
            Item::States(section) => section.entries.iter().for_each(|state| self.state(state)),
            Item::Forces(section) => section.entries.iter().for_each(|force| self.force(force)),
            Item::Switches(section) => section.entries.iter().for_each(|switch| self.switch(switch)),
            Item::Contacts(section) => section.entries.iter().for_each(|contact| self.contact(contact)),
            Item::Resets(section) => section.entries.iter().for_each(|reset| self.reset(reset)),
            // Read when all contacts are known.
            Item::Modes(_) => {}
            Item::Outputs(section) => section.entries.iter().for_each(|output| self.output(output)),
            Item::Provide(section) => section.entries.iter().for_each(|provide| self.provide(provide)),
            Item::Scene(scene) => self.written_scenes.push(scene),
            Item::Argument(argument) => self.argument(argument),
            // Both were unfolded before.
            Item::Component(_) | Item::Use(_) => {}
        }
    }

    /// The value of an argument, under its name in the instance.
    fn argument(&mut self, argument: &'a Argument) {
        let Argument { name, kind, component, given } = argument;
        self.eval.entry = Some(given.name.text.clone());
        let value = self.eval.at(ExpressionPlace::Let, &given.value).ok();
        let value = value.filter(|value| {
            let fits = match kind {
                ArgumentKind::Scalar => matches!(value, Value::Scalar(_)),
                ArgumentKind::Vector => matches!(value, Value::Vector(_)),
                ArgumentKind::Rotation => matches!(value, Value::Rotation(_)),
                ArgumentKind::Body => matches!(value, Value::Body(_)),
                // A number in place of its name, once uses are unfolded.
                ArgumentKind::Count => true,
            };
            if !fits {
                let (given, word) = (&given.name, kind.word());
                let article = "a";
                let text = format!(
                    "argument `{given}` of `{component}` is {article} {word}, and this is {}",
                    value.kind()
                );
                self.eval.faults.report(Fault::new(argument.given.value.extent(), text));
            }
            fits
        });
        value.iter().for_each(|value| self.eval.shapes.named(&name.text, value));
        let category = if *kind == ArgumentKind::Body { Category::Body } else { Category::Let };
        self.eval.scope.declare(self.eval.faults, name, category, value);
    }

    /// Judges what is zero on the holonomic constraints from here on.
    fn judge_on_positions(&mut self) {
        let positions: Vec<ExprId> = self.constraints.iter().filter_map(|form| form.position).collect();
        let bench = &mut self.eval.bench;
        bench.zero.set_manifold(&mut bench.graph, &positions);
    }

    /// Adds to the force function: those of components add up.
    fn add_force_function(&mut self, value: Option<ExprId>) {
        let Some(value) = value else { return };
        let graph = &mut self.eval.bench.graph;
        let before = self.force_function.unwrap_or_else(|| graph.zero());
        self.force_function = Some(graph.add(before, value));
    }

    fn declare_symbol(&mut self, name: &crate::syntax::Name, category: Category, symbol: ExprId) {
        self.eval.scope.declare(self.eval.faults, name, category, Some(Value::Scalar(symbol)));
    }

    fn force(&mut self, written: &'a WrittenForce) {
        let magnitude = self.eval.at(ExpressionPlace::Force, &written.force);
        let direction = self.eval.at(ExpressionPlace::Direction, &written.direction);
        let (Ok(magnitude), Ok(direction)) = (magnitude, direction) else { return };
        let (graph, shapes) = (&self.eval.bench.graph, &self.eval.shapes);
        let pairs = match (magnitude, direction) {
            (Value::Scalar(f), Value::Scalar(u)) => vec![(f, u, shapes.form(u))],
            (Value::Vector(f), Value::Vector(u)) => {
                (0..3).map(|i| (f[i], u[i], shapes.component(graph, &u, i))).collect()
            }
            (f, u) => {
                let fault = Fault::new(
                    written.along,
                    format!(
                        "a force and the velocity that it acts along are of one kind, and these are {} and {}",
                        f.kind(),
                        u.kind()
                    ),
                );
                self.eval.faults.report(fault);
                return;
            }
        };
        let moving = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity));
        if !pairs.iter().any(|(_, u, _)| self.eval.bench.graph.roles(*u).meets(moving)) {
            self.eval.faults.report(
                Fault::new(
                    written.direction.span,
                    "what follows `along` is a velocity, and this contains none",
                )
                .help("a force along a coordinate is `force along dot(x)`"),
            );
            return;
        }
        for (magnitude, along, shape) in pairs {
            let expanded = self.eval.expanded(along);
            let mut partials = guen_symbolic::VelocityPartials::new(&self.eval.bench, &self.velocities, &[]);
            if partials.affine(&mut self.eval.bench, expanded).is_none() {
                let etas: Vec<ExprId> = Vec::new();
                let guilty = self.eval.guilty(&written.direction, &mut |eval, e| {
                    let e = eval.expanded(e);
                    let mut partials =
                        guen_symbolic::VelocityPartials::new(&eval.bench, &self.velocities, &etas);
                    partials.affine(&mut eval.bench, e).is_some()
                });
                let (span, term) = guilty.unwrap_or((written.direction.span, written.direction.source()));
                self.eval.faults.report(
                    Fault::new(span, "what follows `along` is not affine in the velocities")
                        .note(format!("`{term}` is not")),
                );
                return;
            }
            self.forces.push(Force { magnitude, along });
            self.eval.shapes.system.loads.push(shape);
        }
    }

    fn output(&mut self, definition: &'a Definition) {
        self.eval.entry = Some(definition.name.text.clone());
        let value = self.eval.at(ExpressionPlace::Output, &definition.value);
        let parts = match &value {
            Ok(Value::Scalar(e)) => vec![*e],
            Ok(Value::Vector(v)) => v.to_vec(),
            Ok(other) => {
                let fault = Fault::new(
                    definition.value.extent(),
                    format!("an output is a scalar or a vector, and this is {}", other.kind()),
                );
                self.eval.faults.report(fault);
                Vec::new()
            }
            Err(_) => Vec::new(),
        };
        let first = self.output_values.len();
        let components = (first..first + parts.len()).collect();
        self.output_values.extend(parts);
        self.outputs.push(OutputEntry { name: &definition.name, docs: &definition.docs, components });
        self.eval.scope.declare(self.eval.faults, &definition.name, Category::Output, value.ok());
    }
}

/// Items of the generated module, and what generated code calls by short names: no system can have such a name.
fn check_system_name(declaration: &Declaration, faults: &mut Faults) {
    let name = &declaration.name;
    if !crate::names::is_generated_item(&name.text) && !super::is_carried_form(name, declaration) {
        return;
    }
    faults.report(
        Fault::new(name.span(), format!("a system cannot be called `{name}`"))
            .note(format!("its module has an item `{name}` of its own"))
            .help("choose another name"),
    );
}

/// Every name that occurs in an expression.
fn names_in(e: &Expression, found: &mut BTreeSet<String>) {
    if let ExpressionKind::Name(name) = &e.kind {
        found.insert(name.text.clone());
    }
    if let ExpressionKind::Field { base, name } = &e.kind
        && let ExpressionKind::Name(vector) = &base.kind
    {
        found.insert(crate::names::suffixed(&vector.text, &format!("_{}", name.text)));
    }
    e.children().into_iter().for_each(|child| names_in(child, found));
}
