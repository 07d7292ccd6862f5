//! The arrays of a declaration, and what entries each has.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use crate::diagnostics::{Fault, Faults};
use crate::names::RATE_SUFFIX;
use crate::syntax::{Path, Step};

/// The names of a declaration that have entries, and those that have none.
#[derive(Default)]
pub(super) struct Arrays {
    arrays: BTreeMap<String, Array>,
    /// Names without an index, with their places.
    single: BTreeMap<String, Span>,
    /// Names that are declared both ways.
    confused: BTreeSet<String>,
}

/// The entries that one name has.
pub(super) struct Array {
    /// The section of its entries, `a constant`.
    noun: &'static str,
    first: Span,
    /// Every entry with its place.
    entries: BTreeMap<Vec<usize>, Span>,
    /// The number of entries along each index.
    pub(super) sizes: Vec<usize>,
}

impl Array {
    /// The number of indices in words.
    pub(super) fn rank(&self) -> &'static str {
        if self.sizes.len() == 1 { "one index" } else { "two indices" }
    }

    /// Whether there is an entry at some indices.
    pub(super) fn has(&self, indices: &[usize]) -> bool {
        self.entries.contains_key(indices)
    }

    /// The indices of all entries, in order.
    pub(super) fn indices(&self) -> impl Iterator<Item = &Vec<usize>> {
        self.entries.keys()
    }

    /// The path to an entry.
    pub(super) fn path(&self, root: proc_macro2::Ident, indices: &[usize]) -> Path {
        let steps = indices.iter().zip(&self.sizes).map(|(at, of)| Step::Index { at: *at, of: *of });
        Path { root, module: None, steps: steps.collect() }
    }
}

/// Indices in brackets, for messages.
pub(super) fn brackets(indices: &[usize]) -> String {
    let indices: Vec<String> = indices.iter().map(ToString::to_string).collect();
    format!("[{}]", indices.join(", "))
}

impl Arrays {
    /// Declares a name without an index.
    pub(super) fn single(&mut self, name: &str, span: Span, faults: &mut Faults) {
        if let Some(array) = self.arrays.get(name) {
            self.confused.insert(name.to_owned());
            conflict(name, span, array.first, faults);
        }
        self.single.entry(name.to_owned()).or_insert(span);
    }

    /// Whether a name is declared without an index.
    pub(super) fn is_single(&self, name: &str) -> bool {
        self.single.contains_key(name)
    }

    /// Whether a name is declared both ways, so that nothing can be said of its uses.
    pub(super) fn is_confused(&self, name: &str) -> bool {
        self.confused.contains(name)
    }

    /// Declares an array whose entries follow.
    pub(super) fn declare(
        &mut self,
        name: &str,
        span: Span,
        rank: usize,
        noun: &'static str,
        faults: &mut Faults,
    ) -> Option<&mut Array> {
        if let Some(first) = self.single.get(name) {
            self.confused.insert(name.to_owned());
            conflict(name, span, *first, faults);
            return None;
        }
        let new = || Array { noun, first: span, entries: BTreeMap::new(), sizes: vec![0; rank] };
        let array = self.arrays.entry(name.to_owned()).or_insert_with(new);
        if array.sizes.len() != rank {
            let has = array.rank();
            let fault = Fault::new(span, format!("`{name}` is declared with another number of indices"));
            faults.report(fault.note_place(&format!("`{name}` has {has}, as declared"), array.first));
            return None;
        }
        if array.noun != noun {
            let text = format!("an entry of `{name}` is {noun}, and others are {}s", plural(array.noun));
            faults.report(Fault::new(span, text).note_place("the first is declared", array.first));
            return None;
        }
        Some(array)
    }

    /// Whether a name, or what it is a component or a rate of, has entries.
    pub(super) fn of(&self, name: &str) -> Option<&Array> {
        if self.single.contains_key(name) {
            return None;
        }
        if let Some(array) = self.arrays.get(name) {
            return Some(array);
        }
        let stems =
            ["_x", "_y", "_z", RATE_SUFFIX].into_iter().filter_map(|suffix| name.strip_suffix(suffix));
        stems.into_iter().find_map(|stem| self.arrays.get(stem))
    }

    /// Reports indices between others that nothing declares.
    pub(super) fn report_gaps(&self, faults: &mut Faults) {
        for (name, array) in &self.arrays {
            let mut expected = vec![0; array.sizes.len()];
            for (indices, span) in &array.entries {
                if *indices != expected {
                    let gap = brackets(&expected);
                    let last = brackets(&array.sizes.iter().map(|size| size - 1).collect::<Vec<_>>());
                    let fault = Fault::new(*span, format!("`{name}{gap}` is declared nowhere"));
                    faults.report(fault.note(format!(
                        "`{name}` has entries up to `{name}{last}`, and every index is declared exactly once"
                    )));
                    break;
                }
                next(&mut expected, &array.sizes);
            }
        }
    }
}

impl Array {
    /// Adds an entry.
    pub(super) fn add(&mut self, indices: Vec<usize>, span: Span) {
        for (size, index) in self.sizes.iter_mut().zip(&indices) {
            *size = (*size).max(index + 1);
        }
        // A repetition is reported as that of any other name.
        self.entries.entry(indices).or_insert(span);
    }

    /// Adds all entries of an array of known sizes.
    pub(super) fn add_all(&mut self, sizes: &[usize], span: Span) {
        let mut indices = vec![0; sizes.len()];
        for _ in 0..sizes.iter().product() {
            self.add(indices.clone(), span);
            next(&mut indices, sizes);
        }
    }
}

/// The indices behind some indices, the last one running fastest.
pub(super) fn next(indices: &mut [usize], sizes: &[usize]) {
    for (index, size) in indices.iter_mut().zip(sizes).rev() {
        *index += 1;
        if *index < *size {
            return;
        }
        *index = 0;
    }
}

fn conflict(name: &str, span: Span, first: Span, faults: &mut Faults) {
    let fault = Fault::new(span, format!("`{name}` is declared with an index and without one"));
    faults.report(fault.note_place("the other is declared", first));
}

/// The noun without its article.
fn plural(noun: &str) -> &str {
    noun.split_once(' ').map_or(noun, |(_, noun)| noun)
}
