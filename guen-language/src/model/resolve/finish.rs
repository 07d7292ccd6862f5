//! The end of the pass over the items: the model is put together.

use super::*;
use crate::model::contact::ContactEntry;
use crate::model::{Divisor, Follower, SceneModes};

impl<'a> Resolver<'a, '_> {
    /// Puts the model together, out of what the items left, and says whether what the motion needs is sound.
    pub(super) fn finish(self) -> (bool, Option<Model<'a>>) {
        let mut is_core_sound = self.is_core_sound;
        let model = self.put_together(&mut is_core_sound);
        (is_core_sound, model)
    }

    fn put_together(mut self, is_core_sound: &mut bool) -> Option<Model<'a>> {
        self.note_derived();
        let failed = !*is_core_sound;
        let has_contacts = self.has_contacts();
        let modes = if self.declaration.in_mode.is_some() { None } else { self.modes() };
        let before = self.eval.faults.count();
        let missing = self.missing_contacts();
        let velocities = self.velocities.clone();
        let mut degrees = self.parameters.len();
        let has_energy = self.energy.is_some() || self.has_masses;
        let mut raw: Vec<RawForm<'a>> = self.parameters;
        order::by_instance(self.declaration, &mut raw, degrees, &mut self.eval.vectors);
        raw.extend(self.constraints);
        let mut redundant = Vec::new();
        if !failed && raw.iter().any(|form| form.position.is_some()) {
            let coordinates: Vec<ExprId> = self.coordinates.iter().map(|c| c.symbol).collect();
            redundant = redundant::taken(&mut self.eval, &mut raw, &coordinates, degrees);
            self.eval.check_divisors_on_manifold();
        }
        let (mut forms, mut idle) = self.eval.linear_forms(&raw, &velocities);
        if let Some(given) = forms.as_mut().filter(|_| !failed) {
            redundant.extend(redundant::taken_rows(&mut self.eval, &mut raw, given, degrees));
        }
        let mut chosen = None;
        if raw.len() + idle < velocities.len() {
            match &forms {
                Some(given) if !failed => {
                    let before = raw.len();
                    let (coordinates, constants) = (&self.coordinates, &self.constants);
                    chosen = self.eval.complete(&mut raw, degrees, given, coordinates, constants);
                    let more = raw.len() - before;
                    degrees += more;
                    // Constraints stand behind the parameters.
                    redundant
                        .iter_mut()
                        .flat_map(|taken| &mut taken.entry.beside)
                        .for_each(|form| *form += more);
                    order::by_instance(self.declaration, &mut raw, degrees, &mut self.eval.vectors);
                    (forms, idle) = self.eval.linear_forms(&raw, &velocities);
                    match &chosen {
                        Some(chosen) => self.eval.report_assumed(Some(chosen)),
                        None => self.eval.excuse_rates(&self.coordinates),
                    }
                }
                _ => self.eval.excuse_rates(&self.coordinates),
            }
        }
        self.eval.report_assumed(None);
        *is_core_sound &= self.eval.faults.count() == before;
        let mut scenes: Vec<SceneEntry<'a>> = Vec::new();
        let written = self.written_scenes;
        for (place, &scene) in written.iter().enumerate() {
            let mut of_scene = SceneModes::Without;
            if has_contacts && self.declaration.is_outline {
                // A scene that has modes there is one of a smooth system.
                let several = modes.clone().filter(|_| scene.modes.is_empty());
                of_scene = several.map_or(SceneModes::Without, SceneModes::Several);
            } else if has_contacts {
                let entries: Vec<&ContactEntry<'_>> =
                    self.contacts.iter().map(|contact| &contact.entry).collect();
                let known = (&entries[..], &missing);
                let found = contacts::modes_of_scene(known, modes.as_deref(), scene, self.eval.faults);
                of_scene = found.unwrap_or(SceneModes::Without);
            }
            let is_idle = !has_contacts && !self.eval.scope.has_contacts() && !self.declaration.is_outline;
            let mut of_contacts = scene.modes.iter().filter(|section| is_idle && !section.entries.is_empty());
            if let Some(section) = of_contacts.next() {
                let text = "there are no contacts that `modes` could speak of";
                let fault = Fault::new(section.keyword, text);
                self.eval.faults.report(fault.help("declare them: `contacts { name: gap = e; }`"));
            }
            let is_in_mode = matches!(of_scene, SceneModes::One(_)) || self.declaration.in_mode.is_some();
            let entry =
                self.eval.scene(scene, self.declaration, &written[..place], &self.constants, is_in_mode);
            scenes.extend(entry.map(|entry| SceneEntry { modes: of_scene, ..entry }));
        }
        let before = self.eval.faults.count();
        if !failed {
            // Counts and idle sections mean something only where everything that the motion needs was understood.
            let keyword = |kind: SectionKind| {
                self.declaration.items.iter().find_map(|item| match item {
                    Item::Parameters(section) if kind == SectionKind::Parameters => Some(section.keyword),
                    Item::Coordinates(section) if kind == SectionKind::Coordinates => Some(section.keyword),
                    _ => None,
                })
            };
            let place = keyword(SectionKind::Parameters)
                .or(keyword(SectionKind::Coordinates))
                .unwrap_or(self.declaration.name.span());
            count::check(&mut self.eval, &raw, forms.as_deref(), &redundant, &velocities, idle, place);
            let mentioned = if self.is_whole { BTreeSet::new() } else { mentioned(self.declaration) };
            self.eval.scope.report_unused(&mentioned, self.eval.faults);
            if self.gravity.is_some() && self.weights.is_empty() {
                report_idle_gravity(self.declaration, self.eval.faults);
            }
        }
        *is_core_sound &= self.eval.faults.count() == before;
        // A partial model has contacts without modes.
        let modes = modes.or_else(|| (has_contacts && self.declaration.in_mode.is_none()).then(Vec::new));
        let (forms, written): (Vec<_>, Vec<_>) = forms?.into_iter().unzip();
        if forms.len() != self.coordinates.len() || !has_energy {
            return None;
        }
        rolling::join(&mut self.eval, &mut raw, degrees);
        let bench = &mut self.eval.bench;
        let mut force_function: Vec<ExprId> = self.force_function.into_iter().collect();
        if let Some(gravity) = self.gravity {
            for (mass, position) in &self.weights {
                let height = inner(bench, &gravity, position);
                force_function.push(bench.graph.mul(*mass, height));
            }
        }
        let force_function = bench.graph.sum(force_function);
        let mut kinetic_energy = bench.graph.sum(self.kinetic);
        let mut in_velocities = Substitution::new(redundant.iter().map(|taken| taken.rate));
        let mut written_out = |e: &mut ExprId| *e = in_velocities.of(&mut bench.graph, *e);
        written_out(&mut kinetic_energy);
        self.written_energy.iter_mut().for_each(&mut written_out);
        self.output_values.iter_mut().for_each(&mut written_out);
        // Every rate is known, or its fault was reported.
        let mut states: Vec<FirstOrderState> = self
            .eval
            .states
            .iter()
            .map(|(symbol, rate)| FirstOrderState { symbol: *symbol, rate: rate.unwrap_or(*symbol) })
            .collect();
        states.iter_mut().for_each(|state| written_out(&mut state.rate));
        self.slips.iter_mut().for_each(|(function, _)| written_out(function));
        self.forces
            .iter_mut()
            .flat_map(|force| [&mut force.magnitude, &mut force.along])
            .for_each(&mut written_out);
        for reset in &mut self.resets {
            written_out(&mut reset.function);
            reset.assignments.iter_mut().for_each(|(_, value)| written_out(value));
        }
        let (mut contacts, shapes): (Vec<_>, Vec<_>) =
            self.contacts.into_iter().map(|contact| (contact.entry, contact.shapes)).unzip();
        contacts.iter_mut().flat_map(|entry| &mut entry.rows).for_each(|row| written_out(&mut row.form));
        let (redundant, further): (Vec<_>, Vec<_>) =
            redundant.into_iter().map(|taken| (taken.entry, taken.equation)).unzip();
        // Those with an equation stand before the others.
        let further = further.into_iter().flatten().collect();
        let zero = bench.graph.zero();
        let measured = self.eval.shapes.measured();
        let mut structure = self.eval.shapes.system;
        structure.gravity = self.gravity;
        let magnitudes = self.forces.iter().map(|force| force.magnitude);
        let asked: Vec<ExprId> = magnitudes.chain(self.force_function).collect();
        let asked = bench.graph.reachable(&asked, |_| false);
        structure.scalars.retain(|e, _| asked.contains(e));
        // Constraints come after the parameters.
        let place = |own: usize, parameters: bool| if parameters { own } else { own + degrees };
        let vectors = self.eval.vectors.iter();
        structure.vectors = vectors
            .map(|(parameters, places)| places.map(|own| own.map(|own| place(own, *parameters))))
            .collect();
        structure.forms = raw.iter().map(|form| form.shape.clone()).collect();
        let pressed = modes.is_some().then(|| {
            let mut structure = structure.clone();
            structure.loads.extend(shapes.into_iter().flatten());
            structure.pruned()
        });
        let measured = measured.map(|mut seen| {
            seen.scalars.clear();
            seen.pruned()
        });
        let structure = structure.pruned();
        let multibody = self.has_masses.then(|| Multibody {
            bodies: self.rigid_bodies,
            gravity: self.gravity.unwrap_or([zero; 3]),
            other_energy: self.written_energy.unwrap_or(zero),
            other_force_function: self.force_function.unwrap_or(zero),
        });
        let accelerations = raw[..degrees]
            .iter()
            .map(|form| {
                // Outputs may have asked for it.
                let known = self.eval.motion.rates.get(&form.symbol).copied();
                let name = || format!("{}'", form.entry.name);
                known.unwrap_or_else(|| bench.graph.symbol(&name(), Role::QuasiAcceleration))
            })
            .collect();
        let holonomic: Vec<Holonomic> = raw
            .iter()
            .enumerate()
            .filter_map(|(form, raw)| raw.position.map(|equation| Holonomic { form, equation }))
            .collect();
        // Written in velocities, or with bodies, the energy speaks of every momentum; written in the parameters alone it
        // is given on the constraints.
        let in_velocities = self.has_masses || bench.graph.roles(kinetic_energy).has(Role::Velocity);
        let stated = raw.iter().map(|form| in_velocities || form.entry.mentioned_in_energy).collect();
        let etas: Vec<ExprId> = raw.iter().map(|form| form.symbol).collect();
        let motion_symbols = self.eval.motion.meanings(&etas, degrees);
        let reactions = self
            .eval
            .motion
            .reactions
            .iter()
            .filter_map(|(eta, _, span)| Some((etas.iter().position(|known| known == eta)?, *span)))
            .collect();
        let coordinates: Vec<ExprId> = self.coordinates.iter().map(|c| c.symbol).collect();
        let quaternions = crate::model::quaternions::unit_quaternions(
            bench,
            &self.eval.quaternions,
            &coordinates,
            &holonomic,
        );
        let mut mechanics = Mechanics {
            forms: Forms {
                time: self.eval.time,
                coordinates: self.coordinates.iter().map(|c| c.symbol).collect(),
                forms,
                degrees,
            },
            written,
            velocities,
            etas,
            accelerations,
            inputs: self.inputs.iter().map(|input| input.symbol).collect(),
            holonomic,
            redundant: further,
            kinetic_energy,
            stated,
            force_function,
            multibody,
            structure,
            forces: self.forces,
            states,
            outputs: self.output_values,
            motion_symbols,
            measured,
        };
        let mut followers = Vec::new();
        for name in self.declaration.in_mode.iter().flat_map(|mode| &mode.followers) {
            if let Some(Value::Scalar(value)) = self.eval.scope.peek(&name.text) {
                followers.push(Follower { name: name.text.clone(), output: mechanics.outputs.len() });
                mechanics.outputs.push(*value);
            }
        }
        let mut divisors = Vec::new();
        for (function, origin) in self.slips {
            divisors.push(Divisor { output: mechanics.outputs.len(), origin });
            mechanics.outputs.push(function);
        }
        let contacts = modes.zip(pressed).map(|(modes, structure)| {
            contacts::assembled(
                bench,
                &mut mechanics,
                contacts,
                (self.switches, self.resets),
                modes,
                structure,
            )
        });
        let provides = scenes.iter().flat_map(|entry| &entry.scene.provides);
        let provides_operators =
            self.provides_operators || provides.into_iter().any(|provide| provide.name.text == "operators");
        Some(Model {
            identifiers: self.eval.scope.into_identifiers().with_counts(&self.declaration.counts),
            declaration: self.declaration,
            bench: self.eval.bench,
            constants: self.constants,
            functions: supplied_functions(self.declaration),
            inputs: self.inputs,
            coordinates: self.coordinates,
            forms: raw.into_iter().map(|form| form.entry).collect(),
            units: Default::default(),
            is_partial: false,
            chosen,
            redundant,
            bodies: self.bodies,
            particles: self.particles,
            states: self.states,
            outputs: self.outputs,
            quaternions,
            reactions,
            contacts,
            followers,
            undetermined: self.undetermined,
            loads: self.loads,
            divisors,
            scenes,
            left_out: self.eval.left_out,
            provides_operators,
            provides_taylor: self.provides_taylor,
            provides_carried: self.provides_carried,
            provides_source: self.provides_source,
            mechanics,
            has_masses: self.has_masses,
            kinetic_energy_span: self.energy.map(|energy| energy.keyword),
        })
    }
}

/// Every name in the expressions of a declaration, and coordinates by the names of their rates.
fn mentioned(declaration: &Declaration) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for item in &declaration.items {
        item.expressions().into_iter().for_each(|e| names_in(e, &mut found));
    }
    let rates: Vec<String> = found
        .iter()
        .filter_map(|name| name.strip_suffix(crate::names::RATE_SUFFIX))
        .map(String::from)
        .collect();
    found.extend(rates);
    found
}

/// The functions that the program supplies, in order.
fn supplied_functions(declaration: &Declaration) -> Vec<&crate::syntax::SuppliedFunction> {
    let sections = declaration.items.iter().filter_map(|item| match item {
        Item::Functions(section) => Some(section),
        _ => None,
    });
    sections.flat_map(|section| &section.entries).collect()
}

/// Gravity without anything that has a mass would be ignored: it is refused instead.
fn report_idle_gravity(declaration: &Declaration, faults: &mut Faults) {
    let place = declaration.items.iter().find_map(|item| match item {
        Item::Gravity(quantity) => Some(quantity.keyword),
        _ => None,
    });
    if let Some(place) = place {
        faults.report(
            Fault::new(place, "`gravity` acts on particles and on bodies with a mass, and there are none")
                .help("write the force function instead: `force_function = e;`"),
        );
    }
}
