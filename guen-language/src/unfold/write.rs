//! The second pass: items without loops.

use super::Unfolder;
use super::arrays::next;
use crate::syntax::{
    Body, BodyField, Clause, Constant, Contact, Declaration, Definition, Equation, Expression, Fix, Force,
    FunctionDefinition, GivenArgument, Index, Inertia, Item, ModeStatement, Name, Particle, Plain, Provide,
    Quantity, Reset, ResetAssignment, Scene, SceneStatement, Section, State, Switch, Use,
};

impl Unfolder<'_> {
    /// Writes the items out.
    pub(super) fn write(mut self, declaration: Declaration) -> Declaration {
        let Declaration { items, nesting, .. } = &declaration;
        let mut written = Vec::new();
        self.each(nesting, items.len(), &mut |this, place| written.extend(this.item(&items[place])));
        let counts = self.counts.into_values().map(|count| (count.name, count.is_used)).collect();
        Declaration { items: written, nesting: Vec::new(), counts, ..declaration }
    }

    fn item(&mut self, item: &Item) -> Option<Item> {
        self.may_use_variables = matches!(
            item,
            Item::Let(_) | Item::Use(_) | Item::Constants(_) | Item::Inputs(_) | Item::Scene(_)
        );
        Some(match item {
            Item::Count(_) => return None,
            Item::Constants(section) => {
                Item::Constants(self.sized_section(section, |constant| &constant.name, Self::constant))
            }
            Item::Inputs(section) => {
                Item::Inputs(self.sized_section(section, |plain| &plain.name, Self::plain))
            }
            Item::Coordinates(section) => {
                Item::Coordinates(self.sized_section(section, |plain| &plain.name, Self::plain))
            }
            Item::Let(definition) => Item::Let(self.definition(definition)?),
            Item::Use(instance) => Item::Use(self.instance(instance)?),
            Item::Component(component) => Item::Component(component.clone()),
            Item::Argument(argument) => Item::Argument(argument.clone()),
            Item::Function(function) => Item::Function(self.function(function)),
            Item::Functions(section) => {
                Item::Functions(self.written(section, |_, entry| Some(entry.clone())))
            }
            Item::Parameters(section) => Item::Parameters(self.written(section, Self::definition)),
            Item::Outputs(section) => Item::Outputs(self.written(section, Self::definition)),
            Item::Constraints(section) => Item::Constraints(self.written(section, Self::equation)),
            Item::Holonomic(section) => Item::Holonomic(self.written(section, Self::equation)),
            Item::KineticEnergy(quantity) => Item::KineticEnergy(self.quantity(quantity)),
            Item::Gravity(quantity) => Item::Gravity(self.quantity(quantity)),
            Item::ForceFunction(quantity) => Item::ForceFunction(self.quantity(quantity)),
            Item::PotentialEnergy(quantity) => Item::PotentialEnergy(self.quantity(quantity)),
            Item::Particles(section) => Item::Particles(self.written(section, Self::particle)),
            Item::Bodies(section) => Item::Bodies(self.written(section, Self::body)),
            Item::States(section) => Item::States(self.written(section, Self::state)),
            Item::Forces(section) => Item::Forces(self.written(section, Self::force)),
            Item::Switches(section) => Item::Switches(self.written(section, Self::switch)),
            Item::Contacts(section) => Item::Contacts(self.written(section, Self::contact)),
            Item::Resets(section) => Item::Resets(self.written(section, Self::reset)),
            Item::Modes(section) => Item::Modes(self.modes(section)),
            Item::Provide(section) => {
                let entries = section.entries.iter().flat_map(|provide| self.provide(provide)).collect();
                Item::Provide(Section::new(section.docs.clone(), section.keyword, entries))
            }
            Item::Scene(scene) => Item::Scene(self.scene(scene)),
        })
    }

    fn written<T>(&mut self, section: &Section<T>, entry: fn(&mut Self, &T) -> Option<T>) -> Section<T> {
        let mut entries = Vec::new();
        self.each(&section.nesting, section.entries.len(), &mut |this, place| {
            entries.extend(entry(this, &section.entries[place]));
        });
        Section::new(section.docs.clone(), section.keyword, entries)
    }

    /// A section in which `q[n]` outside of a loop stands for all entries.
    fn sized_section<T: Clone>(
        &mut self,
        section: &Section<T>,
        name: fn(&T) -> &Name,
        entry: fn(&mut Self, &T, Name) -> T,
    ) -> Section<T> {
        let mut entries = Vec::new();
        self.each(&section.nesting, section.entries.len(), &mut |this, place| {
            let one = &section.entries[place];
            let name = name(one);
            match &name.index {
                Index::Written(written) if this.variables.is_empty() => {
                    let Some(sizes) = this.sizes(name, &written.indices) else { return };
                    let mut indices = vec![0; sizes.len()];
                    for _ in 0..sizes.iter().product() {
                        let Some(name) = this.entry_name(name, &indices) else { return };
                        entries.push(entry(this, one, name));
                        next(&mut indices, &sizes);
                    }
                }
                _ => {
                    let Some(name) = this.declared(name) else { return };
                    entries.push(entry(this, one, name));
                }
            }
        });
        Section::new(section.docs.clone(), section.keyword, entries)
    }

    /// The name of an entry of an array that is declared.
    fn entry_name(&self, name: &Name, indices: &[usize]) -> Option<Name> {
        let array = self.arrays.of(&name.text).filter(|array| array.sizes.len() == indices.len())?;
        Some(Name::at(array.path(name.ident.clone(), indices)))
    }

    /// A declared name with its index computed; none after a fault.
    fn declared(&mut self, name: &Name) -> Option<Name> {
        let Index::Written(written) = &name.index else { return Some(name.clone()) };
        let indices = self.place(name, &written.indices)?;
        self.entry_name(name, &indices)
    }

    fn constant(&mut self, constant: &Constant, name: Name) -> Constant {
        let default = constant.default.as_ref().map(|default| self.expression(default));
        let limits =
            constant.limits.as_deref().map(|limits| Box::new(limits.each_ref().map(|e| self.expression(e))));
        Constant { name, default, limits, ..constant.clone() }
    }

    fn plain(&mut self, plain: &Plain, name: Name) -> Plain {
        let limits =
            plain.limits.as_deref().map(|limits| Box::new(limits.each_ref().map(|e| self.expression(e))));
        Plain { name, limits, ..plain.clone() }
    }

    fn definition(&mut self, definition: &Definition) -> Option<Definition> {
        let value = self.expression(&definition.value);
        Some(Definition { docs: definition.docs.clone(), name: self.declared(&definition.name)?, value })
    }

    fn instance(&mut self, instance: &Use) -> Option<Use> {
        let arguments = instance.arguments.iter().map(|argument| GivenArgument {
            name: argument.name.clone(),
            value: self.expression(&argument.value),
        });
        let arguments = arguments.collect();
        Some(Use { name: self.declared(&instance.name)?, arguments, ..instance.clone() })
    }

    fn function(&mut self, function: &FunctionDefinition) -> FunctionDefinition {
        self.hidden = function.parameters.iter().map(|parameter| parameter.text.clone()).collect();
        let value = self.expression(&function.value);
        self.hidden.clear();
        FunctionDefinition { value, ..function.clone() }
    }

    fn switch(&mut self, switch: &Switch) -> Option<Switch> {
        let value = self.expression(&switch.value);
        Some(Switch { docs: switch.docs.clone(), name: self.declared(&switch.name)?, value })
    }

    fn contact(&mut self, contact: &Contact) -> Option<Contact> {
        let clause = |clause: &Clause| Clause { value: self.expression(&clause.value), ..clause.clone() };
        let clauses = contact.clauses.iter().map(clause).collect();
        Some(Contact { docs: contact.docs.clone(), name: self.declared(&contact.name)?, clauses })
    }

    fn reset(&mut self, reset: &Reset) -> Option<Reset> {
        let function = self.expression(&reset.function);
        let assignments = reset.assignments.iter().map(|given| ResetAssignment {
            variable: self.expression(&given.variable),
            equals: given.equals,
            value: self.expression(&given.value),
        });
        let assignments = assignments.collect();
        Some(Reset { name: self.declared(&reset.name)?, function, assignments, ..reset.clone() })
    }

    /// Statements about contacts; the name of an array in front of states stands for all of its entries.
    fn modes(&mut self, section: &Section<ModeStatement>) -> Section<ModeStatement> {
        let mut entries = Vec::new();
        self.each(
            &section.nesting,
            section.entries.len(),
            &mut |this, place| match &section.entries[place] {
                ModeStatement::States { contact, states } => {
                    let contacts = this.all(contact).into_iter();
                    let of = |contact| ModeStatement::States { contact, states: states.clone() };
                    entries.extend(contacts.map(of));
                }
                ModeStatement::Never { keyword, combination } => {
                    let pairs = combination.iter();
                    let pairs: Vec<_> =
                        pairs.map(|(contact, state)| Some((this.used(contact)?, state.clone()))).collect();
                    if let Some(combination) = pairs.into_iter().collect() {
                        entries.push(ModeStatement::Never { keyword: *keyword, combination });
                    }
                }
            },
        );
        Section::new(section.docs.clone(), section.keyword, entries)
    }

    fn equation(&mut self, equation: &Equation) -> Option<Equation> {
        let (left, right) = (self.expression(&equation.left), self.expression(&equation.right));
        let name = self.declared(&equation.name)?;
        Some(Equation { docs: equation.docs.clone(), name, left, equals: equation.equals, right })
    }

    fn quantity(&mut self, quantity: &Quantity) -> Quantity {
        Quantity { value: self.expression(&quantity.value), ..quantity.clone() }
    }

    fn particle(&mut self, particle: &Particle) -> Option<Particle> {
        let (mass, position) = (self.expression(&particle.mass), self.expression(&particle.position));
        Some(Particle { docs: particle.docs.clone(), mass, at: particle.at, position })
    }

    fn state(&mut self, state: &State) -> Option<State> {
        let rate = self.expression(&state.rate);
        Some(State { name: self.declared(&state.name)?, rate, ..state.clone() })
    }

    fn force(&mut self, force: &Force) -> Option<Force> {
        let (value, direction) = (self.expression(&force.force), self.expression(&force.direction));
        Some(Force { docs: force.docs.clone(), force: value, along: force.along, direction })
    }

    fn body(&mut self, body: &Body) -> Option<Body> {
        let mut field = |field: &Option<BodyField<Expression>>| {
            let field = field.as_ref()?;
            Some(BodyField { keyword: field.keyword, value: self.expression(&field.value) })
        };
        let (mass, center, orientation) = (field(&body.mass), field(&body.center), field(&body.orientation));
        let inertia = body.inertia.as_ref().map(|inertia| {
            let value = match &inertia.value {
                Inertia::Missing => Inertia::Missing,
                Inertia::Diagonal(entries) => {
                    Inertia::Diagonal(Box::new(entries.each_ref().map(|e| self.expression(e))))
                }
                Inertia::Symmetric(entries) => {
                    Inertia::Symmetric(Box::new(entries.each_ref().map(|e| self.expression(e))))
                }
            };
            BodyField { keyword: inertia.keyword, value }
        });
        Some(Body {
            docs: body.docs.clone(),
            name: self.declared(&body.name)?,
            mass,
            inertia,
            center,
            orientation,
        })
    }

    fn scene(&mut self, scene: &Scene) -> Scene {
        let (tracks, fixes, provides) = Default::default();
        let (docs, name) = (scene.docs.clone(), scene.name.clone());
        let (statements, nesting) = Default::default();
        let keyword = scene.keyword;
        let modes = Vec::new();
        let mut written = Scene { docs, keyword, name, tracks, fixes, provides, modes, statements, nesting };
        if scene.nesting.is_empty() {
            written.add(SceneStatement::Track(self.tracks(&scene.tracks)));
            written.add(SceneStatement::Fix(self.fixes(&scene.fixes)));
            written.add(SceneStatement::Provide(self.provides(&scene.provides)));
            written.modes = scene.modes.iter().map(|section| self.modes(section)).collect();
            return written;
        }
        self.each(&scene.nesting, 0, &mut |this, place| {
            written.add(match &scene.statements[place] {
                SceneStatement::Track(names) => SceneStatement::Track(this.tracks(names)),
                SceneStatement::Fix(fixes) => SceneStatement::Fix(this.fixes(fixes)),
                SceneStatement::Provide(provides) => SceneStatement::Provide(this.provides(provides)),
                SceneStatement::Modes(section) => SceneStatement::Modes(this.modes(section)),
            });
        });
        written
    }

    fn tracks(&mut self, names: &[Name]) -> Vec<Name> {
        names.iter().flat_map(|name| self.all(name)).collect()
    }

    fn fixes(&mut self, fixes: &[Fix]) -> Vec<Fix> {
        let mut found = Vec::new();
        for fix in fixes {
            let value = fix.value.as_ref().map(|value| self.expression(value));
            found.extend(self.all(&fix.name).into_iter().map(|name| Fix { name, value: value.clone() }));
        }
        found
    }

    fn provides(&mut self, provides: &[Provide]) -> Vec<Provide> {
        provides.iter().flat_map(|provide| self.provide(provide)).collect()
    }

    fn provide(&mut self, provide: &Provide) -> Vec<Provide> {
        let of: Option<Vec<Name>> =
            provide.of.as_ref().map(|of| of.iter().flat_map(|name| self.all(name)).collect());
        self.all(&provide.name).into_iter().map(|name| Provide { name, of: of.clone() }).collect()
    }

    /// The entries that a name in a scene or in `modes` stands for: one, or all of an array.
    fn all(&mut self, name: &Name) -> Vec<Name> {
        if let (Index::None, Some(array)) = (&name.index, self.arrays.of(&name.text)) {
            return array
                .indices()
                .map(|indices| Name::at(array.path(name.ident.clone(), indices)))
                .collect();
        }
        self.used(name).into_iter().collect()
    }
}
