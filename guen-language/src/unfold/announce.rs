//! The first pass: counts, and the entries that every array has.

use proc_macro2::Span;

use super::{Count, Unfolder};
use crate::diagnostics::Fault;
use crate::limits::{MAX_COORDINATES, MAX_ENTRIES};
use crate::names;
use crate::syntax::{Declaration, Index, IndexExpression, Item, Name, Section};

impl Unfolder<'_> {
    /// Finds out which entries every array has.
    pub(super) fn announce(&mut self, declaration: &Declaration) {
        let items = &declaration.items;
        self.each(&declaration.nesting, items.len(), &mut |this, place| this.announce_item(&items[place]));
        // After a fault the entries that are missing may be those which it has in it.
        if self.faults.count() == 0 {
            self.arrays.report_gaps(self.faults);
        }
    }

    fn announce_item(&mut self, item: &Item) {
        match item {
            Item::Count(count) => self.count(count),
            Item::Constants(section) => self.sized(section, "a constant", MAX_ENTRIES, |entry| &entry.name),
            Item::Inputs(section) => self.sized(section, "an input", MAX_ENTRIES, |entry| &entry.name),
            Item::Coordinates(section) => {
                self.sized(section, "a coordinate", MAX_COORDINATES, |entry| &entry.name);
            }
            Item::Let(definition) => self.entry(&definition.name, "a `let`"),
            Item::Use(instance) => self.entry(&instance.name, "an instance"),
            Item::Component(component) => self.entry(&component.name, "a component"),
            Item::Function(function) => self.entry(&function.name, "a function"),
            Item::Functions(section) => self.section(section, "a function", |entry| &entry.name),
            Item::Parameters(section) => self.section(section, "a parameter", |entry| &entry.name),
            Item::Outputs(section) => self.section(section, "an output", |entry| &entry.name),
            Item::Constraints(section) => self.section(section, "a constraint", |entry| &entry.name),
            Item::Holonomic(section) => self.section(section, "a holonomic constraint", |entry| &entry.name),
            Item::Bodies(section) => self.section(section, "a body", |entry| &entry.name),
            Item::States(section) => self.section(section, "a state", |entry| &entry.name),
            Item::Switches(section) => self.section(section, "a switch", |entry| &entry.name),
            Item::Contacts(section) => self.section(section, "a contact", |entry| &entry.name),
            Item::Resets(section) => self.section(section, "a reset", |entry| &entry.name),
            Item::Modes(section) => self.counted(section, "statements"),
            Item::Particles(section) => self.counted(section, "particles"),
            Item::Forces(section) => self.counted(section, "forces"),
            Item::KineticEnergy(_)
            | Item::Gravity(_)
            | Item::ForceFunction(_)
            | Item::PotentialEnergy(_)
            | Item::Argument(_)
            | Item::Provide(_)
            | Item::Scene(_) => {}
        }
    }

    fn count(&mut self, count: &crate::syntax::Count) {
        let name = &count.name;
        if names::is_reserved(&name.text) {
            let text = format!("`{name}` is reserved and cannot name a count");
            self.faults.report(Fault::new(name.span(), text).help("choose another name"));
        }
        let value = self.number(&count.value).filter(|value| {
            if *value < 0 {
                let text = format!("count `{name}` is {value}, and a count is a whole number from 0 on");
                self.faults.report(Fault::new(count.value.span, text));
            }
            *value >= 0
        });
        if let Some(first) = self.counts.get(&name.text) {
            let fault = Fault::new(name.span(), format!("`{name}` is declared twice"));
            self.faults.report(fault.note_place("first declared as a count", first.name.span()));
            return;
        }
        self.arrays.single(&name.text, name.span(), self.faults);
        let new = Count { name: name.clone(), value, is_used: name.text.starts_with('_') };
        self.counts.insert(name.text.clone(), new);
    }

    /// A section in which `q[n]` outside of a loop declares so many entries.
    fn sized<T>(&mut self, section: &Section<T>, noun: &'static str, most: usize, name: fn(&T) -> &Name) {
        let mut total = 0;
        self.each(&section.nesting, section.entries.len(), &mut |this, place| {
            let name = name(&section.entries[place]);
            let before = total;
            match &name.index {
                Index::Written(written) if this.variables.is_empty() => {
                    let Some(sizes) = this.sizes(name, &written.indices) else { return };
                    total += sizes.iter().product::<usize>();
                    if total <= most
                        && let Some(array) =
                            this.arrays.declare(&name.text, name.span(), sizes.len(), noun, this.faults)
                    {
                        array.add_all(&sizes, name.span());
                        array.sizes = array.sizes.iter().zip(&sizes).map(|(a, b)| *a.max(b)).collect();
                    }
                }
                _ => {
                    total += 1;
                    this.entry(name, noun);
                }
            }
            this.limited(before, total, most, name.span(), noun);
        });
    }

    /// The lengths of an array along its indices; none after a fault.
    pub(super) fn sizes(&mut self, name: &Name, indices: &[IndexExpression]) -> Option<Vec<usize>> {
        let mut sizes = Vec::new();
        for e in indices {
            let value = self.number(e)?;
            let Ok(size) = usize::try_from(value) else {
                let text = format!("`{name}` cannot have {value} entries");
                self.faults.report(Fault::new(e.span, text).note("a length is a whole number from 0 on"));
                return None;
            };
            sizes.push(size);
        }
        let all = sizes.iter().try_fold(1_usize, |all, size| all.checked_mul(*size)).unwrap_or(usize::MAX);
        self.spend(all, name.span()).then_some(sizes)
    }

    fn section<T>(&mut self, section: &Section<T>, noun: &'static str, name: fn(&T) -> &Name) {
        let mut total = 0;
        self.each(&section.nesting, section.entries.len(), &mut |this, place| {
            let name = name(&section.entries[place]);
            total += 1;
            this.limited(total - 1, total, MAX_ENTRIES, name.span(), noun);
            this.entry(name, noun);
        });
    }

    /// A section of entries without names.
    fn counted<T>(&mut self, section: &Section<T>, what: &str) {
        let mut total = 0;
        let place = section.keyword;
        self.each(&section.nesting, section.entries.len(), &mut |this, _| {
            total += 1;
            if total == MAX_ENTRIES + 1 {
                this.faults.report(Fault::new(place, format!("more than {MAX_ENTRIES} {what}")));
            }
        });
    }

    /// Reports the entry that is one too many.
    fn limited(&mut self, before: usize, total: usize, most: usize, span: Span, noun: &str) {
        if before <= most && total > most {
            let what = noun.split_once(' ').map_or(noun, |(_, noun)| noun).trim_matches('`');
            self.faults.report(Fault::new(span, format!("more than {most} {what}s")));
        }
    }

    /// A name with or without an index, which stands for one entry.
    fn entry(&mut self, name: &Name, noun: &'static str) {
        if let Some(count) = self.counts.get(&name.text) {
            let fault = Fault::new(name.span(), format!("`{name}` is declared twice"));
            self.faults.report(fault.note_place("first declared as a count", count.name.span()));
            return;
        }
        let Index::Written(written) = &name.index else {
            return self.arrays.single(&name.text, name.span(), self.faults);
        };
        let Some(indices) = self.place(name, &written.indices) else { return };
        if let Some(array) = self.arrays.declare(&name.text, name.span(), indices.len(), noun, self.faults) {
            array.add(indices, name.span());
        }
    }

    /// The indices of an entry that is declared; none after a fault.
    pub(super) fn place(&mut self, name: &Name, indices: &[IndexExpression]) -> Option<Vec<usize>> {
        let values: Vec<Option<i64>> = indices.iter().map(|e| self.number(e)).collect();
        let mut place = Vec::new();
        for (value, e) in values.into_iter().zip(indices) {
            let value = value?;
            match usize::try_from(value) {
                Ok(index) if index < crate::limits::MAX_UNFOLDED => place.push(index),
                _ => {
                    let text = format!("`{}[{value}]` is out of range", name.text);
                    let last = crate::limits::MAX_UNFOLDED - 1;
                    self.faults
                        .report(Fault::new(e.span, text).note(format!("indices run from 0 to {last}")));
                    return None;
                }
            }
        }
        Some(place)
    }
}
