//! The declaration that stands in for a faulty one: its names, with formulas in which nothing is wrong.
//!
//! What follows from it are the public items with the signatures of the real ones, so that the rest of the user's crate
//! reports its own mistakes only, and completion keeps working. Every form is the rate of one coordinate, and the mass
//! matrix is the identity. Vectors are recognised by how they are written; a scene keeps every variable and provides
//! everything, because what it would keep is not known.

mod components;
mod contacts;
mod expressions;
mod forms;
mod kinds;
mod scenes;

use std::collections::BTreeSet;

use proc_macro2::Span;
use quote::format_ident;

use crate::names;
use crate::syntax::{
    Body, BodyField, Constant, Declaration, Definition, Docs, Expression, Force, Inertia, Item, Name,
    Particle, Plain, Provide, Quantity, Section, State, SuppliedFunction,
};
use expressions::{call, number, rate, square, sum, value};
use forms::Forms;
use kinds::{Kind, Kinds};

/// Returns a declaration with the names of another, in which nothing is wrong unless the system cannot have its name.
pub fn sound(declaration: &Declaration) -> Declaration {
    let mut names = Names::default();
    let kinds = Kinds::new(declaration);
    let mut entries = Entries::default();
    declaration.items.iter().for_each(|item| entries.add(item, &kinds, &mut names));
    let forms = Forms::new(declaration, &kinds, &mut names);
    // After the forms, whose names are fields of the state, too.
    declaration.items.iter().for_each(|item| entries.add_states(item, &forms, &mut names));
    if forms.driven.is_none() || !entries.functions.is_empty() {
        // Without a force there is no function to carry, and with functions of the program there is no such form.
        entries.provides.retain(|provide| provide.name.text != "carried");
    }
    let energy = sum(forms.coordinates.iter().map(|x| square(rate(&x.name))));
    let mut items = vec![
        Item::Constants(section(entries.constants.clone())),
        Item::Functions(section(entries.functions.clone())),
        Item::Inputs(section(entries.inputs.clone())),
        Item::Coordinates(section(forms.coordinates.clone())),
        Item::Parameters(section(forms.parameters.clone())),
        Item::KineticEnergy(Quantity { docs: Docs::default(), keyword: Span::call_site(), value: energy }),
        Item::Bodies(section(entries.bodies.clone())),
        Item::Particles(section(entries.particles.clone())),
        Item::States(section(entries.states.clone())),
        Item::Outputs(section(entries.outputs.clone())),
        Item::Provide(section(entries.provides.clone())),
    ];
    items.extend(forms.constraints.iter().cloned());
    items.extend(forms.driven.as_ref().map(|x| Item::Forces(section(vec![entries.force(x)]))));
    if let Some(moving) = &forms.driven {
        items.extend(contacts::items(declaration, &kinds, &mut names, moving, &forms.coordinates));
    }
    items.extend(scenes::items(declaration, &entries, &forms));
    let outline = Declaration { items, origins: Vec::new(), is_outline: true, ..declaration.clone() };
    components::free_modules(components::free_names(outline, declaration), declaration)
}

/// A section without documentation; one without entries is as if it were not there.
fn section<T>(entries: Vec<T>) -> Section<T> {
    Section::new(Docs::default(), Span::call_site(), entries)
}

/// The names that are taken. A name that is reserved or taken keeps its identifier, which the fields have, and is called
/// otherwise in the declaration.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl Names {
    fn take(&mut self, name: &Name) -> Name {
        let mut text = name.text.clone();
        while names::is_reserved(&text) || self.0.contains(&text) {
            text.insert_str(0, "other_");
        }
        self.0.insert(text.clone());
        self.0.extend(["_x", "_y", "_z"].map(|axis| names::suffixed(&text, axis)));
        Name { text, ..name.clone() }
    }
}

/// The entry of a name once: a second one was reported as a fault already.
fn push<T>(entries: &mut Vec<T>, name: &Name, of: impl Fn(&T) -> &Name, new: impl FnOnce() -> T) {
    if entries.iter().all(|known| of(known).text != name.text) {
        entries.push(new());
    }
}

/// The entries beside coordinates and forms.
#[derive(Default)]
struct Entries {
    constants: Vec<Constant>,
    functions: Vec<SuppliedFunction>,
    inputs: Vec<Plain>,
    states: Vec<State>,
    outputs: Vec<Definition>,
    bodies: Vec<Body>,
    particles: Vec<Particle>,
    provides: Vec<Provide>,
}

impl Entries {
    fn add(&mut self, item: &Item, kinds: &Kinds, names: &mut Names) {
        match item {
            Item::Constants(section) => {
                section.entries.iter().for_each(|c| self.constant(c, &section.entries, names))
            }
            Item::Inputs(section) => {
                for input in &section.entries {
                    let limits = input.limits.as_ref().map(|_| Box::new([number(0), number(1)]));
                    let new = || Plain { name: names.take(&input.name), unit: None, limits, ..input.clone() };
                    push(&mut self.inputs, &input.name, |input| &input.name, new);
                }
            }
            Item::Functions(section) => {
                for function in section.entries.iter().filter(|function| !function.arguments.is_empty()) {
                    let numbered = |k: usize| Name::new(format_ident!("argument_{k}"));
                    let count = function.arguments.len().min(guen_symbolic::MAX_ARGUMENTS);
                    let new = || SuppliedFunction {
                        name: names.take(&function.name),
                        arguments: (0..count).map(numbered).collect(),
                        ..function.clone()
                    };
                    push(&mut self.functions, &function.name, |function| &function.name, new);
                }
            }
            Item::Outputs(section) => {
                for output in &section.entries {
                    let value = trivial(kinds.of(&output.value));
                    let new =
                        || Definition { name: names.take(&output.name), value, docs: output.docs.clone() };
                    push(&mut self.outputs, &output.name, |output| &output.name, new);
                }
            }
            Item::Bodies(section) => section.entries.iter().for_each(|body| self.body(body, names)),
            Item::Particles(section) => {
                let particle =
                    |p: &Particle| Particle { mass: number(1), position: trivial(Kind::Vector), ..p.clone() };
                self.particles.extend(section.entries.iter().map(particle));
            }
            Item::Provide(section) => {
                for provide in &section.entries {
                    if ["operators", "taylor", "carried", "source"].contains(&provide.name.text.as_str()) {
                        let new = || Provide { of: None, ..provide.clone() };
                        push(&mut self.provides, &provide.name, |provide| &provide.name, new);
                    }
                }
            }
            _ => {}
        }
    }

    /// States whose names no coordinate and no parameter has.
    fn add_states(&mut self, item: &Item, forms: &Forms, names: &mut Names) {
        let Item::States(section) = item else { return };
        for state in section.entries.iter().filter(|state| forms.is_free(&state.name)) {
            let new =
                || State { name: names.take(&state.name), unit: None, rate: number(0), ..state.clone() };
            push(&mut self.states, &state.name, |state| &state.name, new);
        }
    }

    /// A default that is made of other constants is made of one of those before; any other is a number.
    fn constant(&mut self, constant: &Constant, all: &[Constant], names: &mut Names) {
        let default = constant.default.as_ref().map(|default| {
            let is_derived = all.iter().any(|other| default.mentions(&other.name.text));
            let before = self.constants.first().filter(|_| is_derived);
            before.map_or_else(|| number(1), |before| value(&before.name))
        });
        // The entries of an array have defaults together.
        let array = names::array_of(&constant.name.text);
        let sibling = self
            .constants
            .iter()
            .find(|known| known.name.path().is_some() && names::array_of(&known.name.text) == array);
        let default = sibling.map_or(default, |known| known.default.clone());
        let new = || Constant {
            name: names.take(&constant.name),
            unit: None,
            limits: None,
            default,
            ..constant.clone()
        };
        push(&mut self.constants, &constant.name, |constant| &constant.name, new);
    }

    fn body(&mut self, body: &Body, names: &mut Names) {
        let field = |of: &Option<BodyField<Expression>>, value: Expression| {
            of.as_ref().map(|field| BodyField { keyword: field.keyword, value })
        };
        let inertia = body.inertia.as_ref().map(|field| BodyField {
            keyword: field.keyword,
            value: Inertia::Diagonal(Box::new([number(1), number(1), number(1)])),
        });
        let new = || Body {
            docs: body.docs.clone(),
            name: names.take(&body.name),
            mass: field(&body.mass, number(1)),
            inertia,
            center: field(&body.center, trivial(Kind::Vector)),
            orientation: field(&body.orientation, call("rot_x", vec![number(0)])),
        };
        push(&mut self.bodies, &body.name, |body| &body.name, new);
    }

    /// A force that depends on every input, so that scenes have them, and has a function to carry.
    fn force(&self, along: &Name) -> Force {
        let carried = call("sin", vec![value(along)]);
        Force {
            docs: Docs::default(),
            force: sum(self.inputs.iter().map(|input| value(&input.name)).chain([carried])),
            along: Span::call_site(),
            direction: rate(along),
        }
    }
}

/// A value of a kind.
fn trivial(kind: Kind) -> Expression {
    match kind {
        Kind::Vector | Kind::Plane => call("vec", vec![number(0), number(0), number(0)]),
        Kind::Scalar | Kind::Rotation => number(0),
    }
}

/// A name of our own, where a declaration has too few.
fn unnamed(names: &mut Names) -> Name {
    let number = names.0.len();
    names.take(&Name::new(format_ident!("missing_{number}")))
}
