//! Names of instances in expressions and scenes: `left.angle`.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::Unfolded;
use super::prefix::path_of;
use crate::diagnostics::{Fault, Faults};
use crate::names::{array_of, is_reserved, nearest, quoted};
use crate::syntax::{
    Component, Expression, ExpressionKind, Index, Item, ModeStatement, Name, Path, Section, Step, Use,
};
use crate::unfold::component_names::OwnNames;

/// The names that may be read somewhere.
pub(super) struct Scope {
    /// The names that are declared beside the uses.
    own: BTreeMap<String, proc_macro2::Span>,
    /// All instances with their places, also those whose use comes later.
    announced: BTreeMap<String, proc_macro2::Span>,
    /// The instances whose use was read.
    instances: BTreeMap<String, InstanceScope>,
    /// The declared names of instances, by their paths.
    members: BTreeMap<String, Name>,
    /// The names among them that are read inside of their component only, which no help may give.
    private: BTreeSet<String>,
    /// The component of each array of instances, with the place of the first.
    arrays: BTreeMap<String, (String, proc_macro2::Span)>,
    /// Instances of which nothing is known, after a fault.
    excused: BTreeSet<String>,
}

/// An instance that can be read.
struct InstanceScope {
    path: Path,
    component: Rc<Component>,
}

impl Scope {
    pub(super) fn new(items: &[Item]) -> Self {
        let announced = items.iter().filter_map(|item| match item {
            Item::Use(instance) => Some((instance.name.text.clone(), instance.name.span())),
            _ => None,
        });
        // Of two with one name the first counts.
        let announced: Vec<_> = announced.collect();
        let announced = announced.into_iter().rev();
        let own = items.iter().filter(|item| !matches!(item, Item::Use(_)));
        Scope {
            own: own.flat_map(Item::declared).map(|name| (name.text.clone(), name.span())).collect(),
            announced: announced.collect(),
            instances: BTreeMap::new(),
            members: BTreeMap::new(),
            private: BTreeSet::new(),
            arrays: BTreeMap::new(),
            excused: BTreeSet::new(),
        }
    }

    /// Says nothing about the names of an instance.
    pub(super) fn excuse(&mut self, instance: &Name) {
        self.excused.insert(instance.text.clone());
    }

    /// Reports an instance whose name is taken.
    pub(super) fn is_declared_twice(&self, name: &Name, faults: &mut Faults) -> bool {
        let first = self.own.get(&name.text).or_else(|| {
            let is_known = self.instances.contains_key(&name.text) || self.excused.contains(&name.text);
            self.announced.get(&name.text).filter(|_| is_known)
        });
        let Some(first) = first else { return false };
        let fault = Fault::new(name.span(), format!("`{name}` is declared twice"));
        faults.report(fault.note_place("first declared", *first));
        true
    }

    /// Reports an entry of an array whose other entries are instances of another component.
    pub(super) fn is_of_another_component(&mut self, instance: &Use, faults: &mut Faults) -> bool {
        let (name, path) = (&instance.name, &instance.path);
        let new = (path.text.clone(), name.span());
        let (first, place) = self.arrays.entry(name.root().to_string()).or_insert(new);
        if *first == path.text {
            return false;
        }
        let text =
            format!("`{name}` is a `{}`, and other entries of `{}` are `{first}`", path.text, name.root());
        let fault = Fault::new(path.name.span(), text).note_place("the first is declared", *place);
        faults.report(
            fault.help("entries of one array are instances of one component: give these another name"),
        );
        true
    }

    /// Adds an instance, with those inside of it.
    pub(super) fn add(
        &mut self,
        name: &Name,
        component: &Rc<Component>,
        unfolded: &Unfolded,
        members: &[Name],
    ) {
        let path = path_of(name);
        for inner in &unfolded.instances {
            let path = super::prefix::behind(&path, &inner.path);
            let component = Rc::clone(&inner.declared);
            self.instances.insert(path.text(), InstanceScope { path, component });
        }
        self.instances.insert(name.text.clone(), InstanceScope { path, component: Rc::clone(component) });
        self.members.extend(members.iter().map(|name| (name.text.clone(), name.clone())));
        let is_function = |item: &&Item| matches!(item, Item::Function(_) | Item::Functions(_));
        let functions = unfolded.items.iter().filter(is_function).flat_map(Item::declared);
        let functions: BTreeSet<&str> = functions.map(|name| name.text.as_str()).collect();
        let is_private =
            |own: &str| own.split('.').any(|step| step.starts_with('_')) || functions.contains(own);
        let private = unfolded.members.values().zip(members).filter(|(own, _)| is_private(&own.text));
        self.private.extend(private.map(|(_, name)| name.text.clone()));
    }

    /// The names of instances that may be read here.
    fn readable(&self) -> impl Iterator<Item = &str> {
        self.members.keys().map(String::as_str).filter(|known| !self.private.contains(*known))
    }

    /// Makes paths of the names of instances in the expressions of an item.
    pub(super) fn read(&self, item: &mut Item, faults: &mut Faults) {
        let hidden: Vec<String> = match item {
            Item::Function(function) => function.parameters.iter().map(|name| name.text.clone()).collect(),
            _ => Vec::new(),
        };
        if let Item::Contacts(section) = item {
            for clause in section.entries.iter_mut().flat_map(|contact| &mut contact.clauses) {
                self.expression(&mut clause.value, clause.word.own_names(), faults);
            }
            return;
        }
        let hidden: Vec<&str> = hidden.iter().map(String::as_str).collect();
        item.expressions_mut().into_iter().for_each(|e| self.expression(e, &hidden, faults));
    }

    fn expression(&self, e: &mut Expression, hidden: &[&str], faults: &mut Faults) {
        if let ExpressionKind::Field { .. } = e.kind
            && let Some((base, name)) = self.instance_of(e, hidden)
        {
            let (span, parentheses) = (name.span(), e.parentheses);
            let kind =
                self.member(&base, &name, faults).map_or(ExpressionKind::Missing, ExpressionKind::Name);
            *e = Expression { span, parentheses, kind };
            return;
        }
        match &e.kind {
            ExpressionKind::Name(name) if !hidden.contains(&name.text.as_str()) => {
                let name = name.clone();
                if self.refuses(&name, faults) {
                    e.kind = ExpressionKind::Missing;
                }
                return;
            }
            ExpressionKind::Field { base, name }
                if !matches!(name.index, Index::None) && !self.is_unknown(base, hidden) =>
            {
                let text = format!("`{}` has no entries", name.root());
                faults.report(
                    Fault::new(name.span(), text).note("arrays are declared, and instances have arrays"),
                );
            }
            ExpressionKind::Method { base, name, .. } => {
                if let ExpressionKind::Name(instance) = &base.kind
                    && self.announced.contains_key(&instance.text)
                {
                    let text = format!("`{name}` is no function that `{instance}` gives to others");
                    faults.report(
                        Fault::new(name.span(), text)
                            .note("the functions of a component are its own; its values are read")
                            .help(format!("write `{instance}.name` with the name of a value")),
                    );
                    e.kind = ExpressionKind::Missing;
                    return;
                }
            }
            _ => {}
        }
        e.children_mut().into_iter().for_each(|child| self.expression(child, hidden, faults));
    }

    /// Whether an expression is a name that nothing declares, or something behind one: it is reported as unknown.
    fn is_unknown(&self, e: &Expression, hidden: &[&str]) -> bool {
        match &e.kind {
            ExpressionKind::Field { base, .. } => self.is_unknown(base, hidden),
            ExpressionKind::Name(name) => {
                let mut known = self.own.keys().chain(self.announced.keys());
                !hidden.contains(&name.text.as_str())
                    && !known.any(|known| array_of(known) == array_of(&name.text))
            }
            _ => false,
        }
    }

    /// The path of the instance before the last point of an expression, and the name behind it.
    fn instance_of(&self, e: &Expression, hidden: &[&str]) -> Option<(Name, Name)> {
        let ExpressionKind::Field { base, name } = &e.kind else { return None };
        let before = match &base.kind {
            ExpressionKind::Name(instance) if !hidden.contains(&instance.text.as_str()) => instance.clone(),
            ExpressionKind::Field { .. } => {
                let (outer, inner) = self.instance_of(base, hidden)?;
                joined(&outer, &inner)
            }
            _ => return None,
        };
        let is_instance = self.instances.contains_key(&before.text)
            || self.announced.contains_key(&before.text)
            || self.excused.contains(&before.text);
        is_instance.then(|| (before, name.clone()))
    }

    /// The name behind the name of an instance; none after a fault.
    fn member(&self, instance: &Name, name: &Name, faults: &mut Faults) -> Option<Name> {
        if self.excused.contains(&instance.text) {
            return None;
        }
        let Some(scope) = self.instances.get(&instance.text) else {
            let fault = Fault::new(instance.span(), format!("`{instance}` is used before it is declared"));
            let place = self.announced.get(&instance.text).copied().unwrap_or_else(|| instance.span());
            faults.report(fault.note_place("declared", place).help("move its `use` above this"));
            return None;
        };
        let text = joined(instance, name).text;
        if let Some(known) = self.members.get(&text) {
            if name.text.starts_with('_') || is_function(&scope.component, name) {
                return self.private(&scope.component, instance, name, faults);
            }
            let mut known = known.clone();
            known.ident.set_span(name.span());
            return Some(known);
        }
        let component = &scope.component;
        if component.arguments.iter().any(|argument| argument.name.text == name.text) {
            return self.private(component, instance, name, faults);
        }
        if self.instances.contains_key(&text) {
            let fault = Fault::new(name.span(), format!("`{text}` is an instance, and no value"));
            faults.report(fault.help(format!("write the value that is meant, as `{text}.name`")));
            return None;
        }
        let own = OwnNames::new(component);
        if own.has(name.root().to_string().trim_start_matches("r#")) {
            // The rate of a coordinate or the component of a vector.
            let is_array = self.members.keys().any(|known| known.starts_with(&format!("{text}[")));
            if is_array {
                let fault = Fault::new(name.span(), format!("`{text}` is an array, and no single value"));
                faults.report(fault.help(format!("write the entry that is meant, as `{text}[0]`")));
                return None;
            }
            if !matches!(name.index, Index::None) {
                let fault = Fault::new(name.span(), format!("`{instance}` has no entry `{text}`"));
                faults.report(fault);
                return None;
            }
            let mut derived = super::prefix::name(name, &scope.path);
            derived.ident.set_span(name.span());
            return Some(derived);
        }
        let prefix = format!("{instance}.");
        let known: Vec<&str> = self.readable().filter_map(|known| known.strip_prefix(&prefix)).collect();
        let fault = Fault::new(name.span(), format!("`{instance}`, a `{}`, has no `{name}`", component.name));
        faults.report(match nearest(&name.text, known.iter().copied()) {
            Some(near) => fault.help(format!("did you mean `{near}`?")),
            None if known.is_empty() => fault,
            None => fault.help(format!("it has {}", quoted(known))),
        });
        None
    }

    fn private(
        &self,
        component: &Component,
        instance: &Name,
        name: &Name,
        faults: &mut Faults,
    ) -> Option<Name> {
        let fault = Fault::new(name.span(), format!("`{name}` is private to component `{}`", component.name));
        faults.report(
            fault
                .note("arguments, functions and names that begin with `_` are read inside of the component only")
                .help(format!("read another name of `{instance}`, or declare a `let` in the component")),
        );
        None
    }

    /// Reports a name that is no value here: an instance, or a name of a component without its instance.
    fn refuses(&self, name: &Name, faults: &mut Faults) -> bool {
        if self.excused.contains(&name.text) {
            return true;
        }
        if let Some(scope) = self.instances.get(&name.text) {
            let text = format!("`{name}` is an instance of `{}`, and no value", scope.component.name);
            let member = self.readable().find(|known| known.starts_with(&format!("{name}.")));
            let fault = Fault::new(name.span(), text);
            faults.report(match member {
                Some(member) => fault.help(format!("write one of its names, as `{member}`")),
                None => fault,
            });
            return true;
        }
        if self.own.contains_key(&name.text)
            || is_reserved(&name.text)
            || self.announced.contains_key(&name.text)
        {
            return false;
        }
        let suffix = format!(".{}", name.text);
        let members: Vec<&str> = self.readable().filter(|known| known.ends_with(&suffix)).collect();
        let Some(first) = members.first() else { return false };
        let fault = Fault::new(name.span(), format!("`{name}` is private to the component that declares it"));
        let fault = fault.note("outside of the component it is read through the name of an instance");
        faults.report(match members.len() {
            1..=4 => fault.help(format!("write {}", quoted(members).replace(", ", " or "))),
            _ => fault.help(format!("write it behind the name of an instance, as `{first}`")),
        });
        true
    }

    /// Gives the names in scenes and in `modes` their paths; the name of an instance or of an array stands for all that can be
    /// meant.
    pub(super) fn scenes(&self, items: &mut [Item]) {
        let moving: Vec<Name> = items
            .iter()
            .filter(|item| matches!(item, Item::Coordinates(_) | Item::Parameters(_) | Item::States(_)))
            .flat_map(Item::declared)
            .cloned()
            .collect();
        for item in items {
            match item {
                Item::Scene(scene) => {
                    let tracks = scene.tracks.iter().flat_map(|name| self.tracked(name, &moving));
                    scene.tracks = tracks.collect();
                    scene.fixes = scene
                        .fixes
                        .iter()
                        .flat_map(|fix| {
                            let names = self.all(&fix.name);
                            names
                                .into_iter()
                                .map(|name| crate::syntax::Fix { name, value: fix.value.clone() })
                        })
                        .collect();
                    scene.provides = self.provided(&scene.provides);
                    scene.modes.iter_mut().for_each(|section| self.modes(section));
                }
                Item::Provide(section) => section.entries = self.provided(&section.entries),
                Item::Modes(section) => self.modes(section),
                _ => {}
            }
        }
    }

    fn modes(&self, section: &mut Section<ModeStatement>) {
        let statements = section.entries.iter().flat_map(|statement| match statement {
            ModeStatement::States { contact, states } => {
                let of = |contact| ModeStatement::States { contact, states: states.clone() };
                self.all(contact).into_iter().map(of).collect::<Vec<_>>()
            }
            ModeStatement::Never { keyword, combination } => {
                let known = |name: &Name| self.members.get(&name.text).map(|known| placed(known, name));
                let pairs = combination.iter();
                let pairs = pairs.map(|(name, state)| (known(name).unwrap_or(name.clone()), state.clone()));
                vec![ModeStatement::Never { keyword: *keyword, combination: pairs.collect() }]
            }
        });
        section.entries = statements.collect();
    }

    fn provided(&self, provides: &[crate::syntax::Provide]) -> Vec<crate::syntax::Provide> {
        let mut found = Vec::new();
        for provide in provides {
            let of: Option<Vec<Name>> =
                provide.of.as_ref().map(|of| of.iter().flat_map(|name| self.all(name)).collect());
            let names = self.all(&provide.name);
            found.extend(names.into_iter().map(|name| crate::syntax::Provide { name, of: of.clone() }));
        }
        found
    }

    /// The names that a name after `track` stands for: of an instance, and of an array of instances, its coordinates, parameters and
    /// states.
    fn tracked(&self, name: &Name, moving: &[Name]) -> Vec<Name> {
        let meant: Vec<&String> =
            self.instances.keys().filter(|instance| stands_for(&name.text, instance)).collect();
        if meant.is_empty() {
            return self.all(name);
        }
        let is_inside = |known: &Name, instance: &str| {
            known.text.strip_prefix(instance).is_some_and(|rest| rest.starts_with('.'))
        };
        let inside = moving.iter().filter(|known| meant.iter().any(|instance| is_inside(known, instance)));
        let inside: Vec<Name> = inside.map(|known| placed(known, name)).collect();
        if inside.is_empty() { vec![name.clone()] } else { inside }
    }

    /// The names that a name in a scene or in `modes` stands for: itself, or what is left open by arrays without an index, be they of
    /// instances or of their names.
    fn all(&self, name: &Name) -> Vec<Name> {
        if let Some(known) = self.members.get(&name.text) {
            return vec![placed(known, name)];
        }
        let entries = self.members.iter().filter(|(text, _)| stands_for(&name.text, text));
        let entries: Vec<Name> = entries.map(|(_, known)| placed(known, name)).collect();
        if !entries.is_empty() {
            return entries;
        }
        // The rate of a coordinate, which the macro chooses.
        let instance = self.instances.iter().filter(|(text, _)| {
            name.text.strip_prefix(text.as_str()).is_some_and(|rest| rest.starts_with('.'))
        });
        let Some((text, scope)) = instance.max_by_key(|(text, _)| text.len()) else {
            return vec![name.clone()];
        };
        let field = proc_macro2::Ident::new(
            name.text[text.len() + 1..].split(['[', '.']).next().unwrap_or_default(),
            name.span(),
        );
        let mut path = scope.path.clone();
        path.steps.push(Step::Field(field));
        let known = Name::at(path);
        if known.text == name.text { vec![placed(&known, name)] } else { vec![name.clone()] }
    }
}

/// Whether a name, in which arrays may stand without an index, stands for a known one: `foot.knee` for `foot[0].knee`.
fn stands_for(name: &str, known: &str) -> bool {
    let (steps, known_steps) = (name.split('.'), known.split('.'));
    steps.clone().count() == known_steps.clone().count()
        && steps.zip(known_steps).all(|(step, known)| step == known || step == array_of(known))
}

/// A known name at the place where it is used.
fn placed(known: &Name, used: &Name) -> Name {
    let mut known = known.clone();
    known.ident.set_span(used.span());
    known
}

/// The name of what is behind a point.
fn joined(instance: &Name, name: &Name) -> Name {
    let mut both = super::prefix::name(name, &path_of(instance));
    both.ident.set_span(name.span());
    both
}

fn is_function(component: &Component, name: &Name) -> bool {
    component
        .items
        .iter()
        .any(|item| matches!(item, Item::Function(function) if function.name.text == name.text))
}
