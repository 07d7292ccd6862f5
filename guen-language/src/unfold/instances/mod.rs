//! Puts the items of components in the place of their uses. What comes out has no components: a name of an instance is a path,
//! `left.angle`, and an argument is a name like a `let`.
//!
//! A component is written out once, by itself: its loops, and the instances that it has in turn. Every use takes these items with
//! its name in front of theirs. The names of the system are unknown in a component, and a component's are read through
//! the name of the instance.

mod arguments;
mod conflicts;
mod members;
mod merge;
mod prefix;

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::diagnostics::{Fault, Faults, collect};
use crate::limits::MAX_INSTANCES;
use crate::names::{is_reserved, nearest, quoted};
use crate::syntax::{Component, Declaration, Imported, Instance, Item, Name, Use};
use crate::unfold::component_names::OwnNames;
use crate::unfold::{check_names, component_counts};
use members::Scope;

/// Returns the declaration without components and uses.
pub(super) fn instantiate(declaration: Declaration, faults: &mut Faults) -> Declaration {
    let is_concerned = |item: &Item| matches!(item, Item::Component(_) | Item::Use(_));
    if !declaration.items.iter().any(is_concerned) {
        return declaration;
    }
    conflicts::check(&declaration, faults);
    let mut stage = Stage { faults, depth: 0, written: 0 };
    let known = Known { declared: Vec::new(), announced: Vec::new(), imported: &declaration.imported };
    let whole = stage.items(declaration.items.clone(), &known, &declaration.name);
    let Unfolded { items, origins, instances, components, .. } = whole;
    let components = components.into_iter().map(|part| {
        let constants = merge::constants(&part.component, &part.content);
        (Rc::clone(&part.component), constants)
    });
    let components = components.collect();
    if faults.count() == 0 {
        merge::check(&declaration.name, &items, faults);
    }
    let (items, origins) = merge::merged(items, origins);
    Declaration { items, origins, instances, components, ..declaration }
}

/// The constants of a component, and of the components that it uses, as a declaration of their own.
pub(super) fn constants(component: &Component, faults: &mut Faults) -> Declaration {
    let none = Known { declared: Vec::new(), announced: Vec::new(), imported: &component.imported };
    let part = Stage { faults, depth: 0, written: 0 }.by_itself(component, &none);
    merge::constants(&part.component, &part.content)
}

/// The value of every count where a component is written out by itself: its constants do not depend on it.
const STAND_IN: i64 = 2;

/// The components that may be used somewhere.
#[derive(Clone)]
struct Known<'a> {
    /// Components that are declared in the braces of the system, each with its items written out.
    declared: Vec<(Name, Rc<Part>)>,
    /// The names of all of them, also of those that come later.
    announced: Vec<Name>,
    imported: &'a [Imported],
}

/// A component that is written out.
struct Part {
    component: Rc<Component>,
    content: Unfolded,
}

/// Items without uses.
#[derive(Default)]
struct Unfolded {
    items: Vec<Item>,
    /// The instance that each item comes from, as a place in `instances`.
    origins: Vec<Option<usize>>,
    /// The instances, each behind the one that it is a part of.
    instances: Vec<Instance>,
    /// The declared names, which can be read from outside, by their paths.
    members: BTreeMap<String, Name>,
    /// The components that are declared among the items.
    components: Vec<Rc<Part>>,
}

struct Stage<'f> {
    faults: &'f mut Faults,
    /// The number of components around the one that is written out.
    depth: usize,
    /// The instances so far.
    written: usize,
}

impl Stage<'_> {
    /// Writes a component out where it is declared. What counts among its arguments lead to is reported where they are given.
    fn by_itself(&mut self, component: &Component, outer: &Known<'_>) -> Rc<Part> {
        let counts: Vec<(&Name, i64)> =
            component.counts().map(|argument| (&argument.name, STAND_IN)).collect();
        if counts.is_empty() {
            return self.component(component, outer.imported, outer, &counts);
        }
        let (depth, written) = (self.depth, self.written);
        collect(|faults| {
            Stage { faults, depth, written }.component(component, outer.imported, outer, &counts)
        })
        .0
    }

    /// Writes a component out for the counts that a use gives; none where there is none, or after a fault in it.
    fn counted(&mut self, instance: &Use, component: &Component, outer: &Known<'_>) -> Option<Rc<Part>> {
        let counts = arguments::counts(instance, component, self.faults)?;
        if !collect(|faults| component_counts::check(component, faults)).1.is_empty() {
            // The component has one struct of constants, which cannot fit every use. The fault is reported where it is declared.
            return None;
        }
        let before = self.faults.count();
        let part = self.component(component, outer.imported, outer, &counts);
        if self.faults.count() == before {
            return Some(part);
        }
        let what = format!("in `{}`, a `{}`, used", instance.name, component.name);
        self.faults.of_instance(before, &what, instance.name.span());
        None
    }

    /// Writes a component out, with its own names.
    fn component(
        &mut self,
        component: &Component,
        imported: &[Imported],
        outer: &Known<'_>,
        counts: &[(&Name, i64)],
    ) -> Rc<Part> {
        let items = super::loops_of(component, counts, self.faults);
        let known = Known { declared: outer.declared.clone(), announced: Vec::new(), imported };
        let content = self.items(items, &known, &component.name);
        Rc::new(Part { component: Rc::new(component.clone()), content })
    }

    /// Writes the uses among some items out.
    fn items(&mut self, items: Vec<Item>, outer: &Known<'_>, owner: &Name) -> Unfolded {
        let mut known = outer.clone();
        let components = items.iter().filter(|item| matches!(item, Item::Component(_)));
        known.announced.extend(components.flat_map(Item::declared).cloned());
        let mut scope = Scope::new(&items);
        let mut found = Unfolded::default();
        for mut item in items {
            scope.read(&mut item, self.faults);
            match item {
                Item::Component(component) => {
                    check_names(&component, self.faults);
                    // Its uses are checked even where it has faults.
                    let written = self.by_itself(&component, &known);
                    found.components.push(Rc::clone(&written));
                    known.declared.push((component.name.clone(), written));
                }
                Item::Use(instance) => {
                    if scope.is_declared_twice(&instance.name, self.faults) {
                        continue;
                    }
                    if is_reserved(&instance.name.root().to_string()) {
                        // Reported with the names that the system, or the component, declares.
                        scope.excuse(&instance.name);
                        continue;
                    }
                    if scope.is_of_another_component(&instance, self.faults) {
                        scope.excuse(&instance.name);
                        continue;
                    }
                    let Some(part) = self.find(&instance, &known, owner) else {
                        scope.excuse(&instance.name);
                        continue;
                    };
                    self.instance(&instance, &part, &mut found, &mut scope);
                }
                item => {
                    for name in item.declared() {
                        found.members.insert(name.text.clone(), name.clone());
                    }
                    found.items.push(item);
                    found.origins.push(None);
                }
            }
        }
        scope.scenes(&mut found.items);
        found
    }

    /// The component of a use, written out; none where there is none, or where its faults are reported elsewhere.
    fn find(&mut self, instance: &Use, known: &Known<'_>, owner: &Name) -> Option<Rc<Part>> {
        let path = &instance.path;
        if path.text == owner.text {
            let fault = Fault::new(path.name.span(), format!("`{owner}` uses itself"));
            self.faults.report(fault.help("a component may use others, each of which ends somewhere"));
            return None;
        }
        let declared = known.declared.iter().position(|(name, _)| path.is_name() && name.text == path.text);
        if let Some(place) = declared {
            let part = Rc::clone(&known.declared[place].1);
            if part.component.counts().next().is_none() {
                return Some(part);
            }
            let before = known.declared[..place].to_vec();
            let outer = Known { declared: before, announced: Vec::new(), imported: known.imported };
            return self.counted(instance, &part.component, &outer);
        }
        if let Some(imported) = known.imported.iter().find(|imported| imported.path == path.text) {
            if imported.is_faulty {
                // A fault is in the compiler's output already, where the component is declared.
                return None;
            }
            let none =
                Known { declared: Vec::new(), announced: Vec::new(), imported: &imported.component.imported };
            if self.depth >= crate::limits::MAX_COMPONENT_DEPTH {
                let most = crate::limits::MAX_COMPONENT_DEPTH;
                let text = format!("more than {most} components inside of each other");
                self.faults.report(Fault::new(path.name.span(), text));
                return None;
            }
            self.depth += 1;
            let component = &imported.component;
            let unfolded = match component.counts().next() {
                None => Some(self.component(component, &component.imported, &none, &[])),
                Some(_) => self.counted(instance, component, &none),
            };
            self.depth -= 1;
            return unfolded;
        }
        if let Some(later) = known.announced.iter().find(|name| path.is_name() && name.text == path.text) {
            let text = format!("component `{later}` is used before it is declared");
            let fault = Fault::new(path.name.span(), text).note_place("declared", later.span());
            self.faults.report(fault.help("move its declaration above this one"));
            return None;
        }
        let names = known.declared.iter().map(|(name, _)| name.text.as_str());
        let names: Vec<&str> =
            names.chain(known.imported.iter().map(|imported| imported.path.as_str())).collect();
        let fault = Fault::new(path.name.span(), format!("unknown component `{}`", path.text));
        self.faults.report(match nearest(&path.text, names.iter().copied()) {
            Some(near) => fault.help(format_args!("did you mean `{near}`?")),
            None if names.is_empty() => {
                fault.help("declare it above by `component Name(..) { .. }`, or import it with `use` of Rust")
            }
            None => fault.help(format_args!("the components here are {}", quoted(names))),
        });
        None
    }

    /// Takes the items of a component over, with the name of the instance in front of their names.
    fn instance(&mut self, instance: &Use, part: &Part, found: &mut Unfolded, scope: &mut Scope) {
        let Part { component, content: unfolded } = part;
        self.written += 1 + unfolded.instances.len();
        if self.written > MAX_INSTANCES {
            if self.written - unfolded.instances.len() <= MAX_INSTANCES + 1 {
                let text = format!("more than {MAX_INSTANCES} instances of components");
                self.faults.report(Fault::new(instance.name.span(), text));
            }
            return;
        }
        let path = prefix::path_of(&instance.name);
        let names = OwnNames::new(component);
        let place = found.instances.len();
        let own = Instance {
            path: path.clone(),
            docs: instance.docs.clone(),
            component: instance.path.clone(),
            place: instance.name.span(),
            declared: Rc::clone(component),
        };
        found.instances.push(own);
        for inner in &unfolded.instances {
            let path = prefix::behind(&path, &inner.path);
            found.instances.push(Instance { path, ..inner.clone() });
        }
        for argument in arguments::items(instance, component, &path, self.faults) {
            found.items.push(argument);
            found.origins.push(None);
        }
        for (item, origin) in unfolded.items.iter().zip(&unfolded.origins) {
            found.items.push(prefix::item(item, &path, &names));
            found.origins.push(Some(origin.map_or(place, |inner| place + 1 + inner)));
        }
        let members = unfolded.members.values().map(|name| prefix::name(name, &path));
        let members: Vec<Name> = members.collect();
        scope.add(&instance.name, component, unfolded, &members);
        found.members.extend(members.into_iter().map(|name| (name.text.clone(), name)));
    }
}
