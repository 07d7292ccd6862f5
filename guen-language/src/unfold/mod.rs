//! Writes loops out: what comes in has counts, arrays, `for`, `if` on indices, and sums over ranges; what goes out is the
//! declaration that a patient person would have written, in which every entry of an array has a name of its own, `q[3]`.
//!
//! Two passes over the items: the first finds out which entries every array has, the second writes entries and expressions
//! out. Names of an index are checked here, everything else is left to the model.

mod announce;
mod arrays;
mod component_counts;
mod component_names;
mod expressions;
mod instances;
mod numbers;
pub(crate) mod unknown_names;
mod write;

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use crate::diagnostics::{Fault, Faults};
use crate::limits::MAX_UNFOLDED;
use crate::names;
use crate::syntax::{
    Component, Conditional, Declaration, Docs, EntryNode, Index, Item, Loop, Name, Range, Visibility,
};
use arrays::Arrays;
pub(crate) use component_names::names as check_names;

/// Returns the declaration without loops, counts, written indices and uses of components. What cannot be written out is reported and
/// left out.
pub fn unfold(declaration: Declaration, faults: &mut Faults) -> Declaration {
    let declaration = without_loops(declaration, &[], faults);
    instances::instantiate(declaration, faults)
}

/// The constants of a component as a declaration of their own, with those of the components that it uses.
pub(crate) fn constants(component: &Component, faults: &mut Faults) -> Declaration {
    instances::constants(component, faults)
}

/// The items of a component without loops, for values of the counts among its arguments.
fn loops_of(component: &Component, counts: &[(&Name, i64)], faults: &mut Faults) -> Vec<Item> {
    let (docs, visibility, name) = (Docs::default(), Visibility::Private, component.name.clone());
    let (items, nesting) = (component.items.clone(), component.nesting.clone());
    let (tokens, crate_path, unused, imported, instances, origins, components) = Default::default();
    let whole = Declaration {
        tokens,
        crate_path,
        docs,
        visibility,
        name,
        items,
        nesting,
        counts: unused,
        imported,
        instances,
        origins,
        components,
        in_mode: None,
        is_outline: false,
        of_modes: Default::default(),
    };
    without_loops(whole, counts, faults).items
}

fn without_loops(declaration: Declaration, counts: &[(&Name, i64)], faults: &mut Faults) -> Declaration {
    if counts.is_empty() && is_plain(&declaration) {
        return declaration;
    }
    let mut unfolder = Unfolder::new(faults);
    for (name, value) in counts {
        let count = Count { name: Name::clone(name), value: Some(*value), is_used: true };
        unfolder.counts.insert(name.text.clone(), count);
    }
    let before = unfolder.faults.count();
    unfolder.announce(&declaration);
    unfolder.knows_entries = unfolder.faults.count() == before;
    unfolder.write(declaration)
}

/// Whether nothing is to be done, judged by the tokens that only this stage knows: the way of most declarations.
fn is_plain(declaration: &Declaration) -> bool {
    let has_index = |item: &Item| {
        let mut found = matches!(item, Item::Count(_)) || expressions::section_nesting(item).is_some();
        expressions::names(item, &mut |name| found |= !matches!(name.index, Index::None));
        found || expressions::has_fold(item)
    };
    declaration.nesting.is_empty() && !declaration.items.iter().any(has_index)
}

/// The state of both passes.
struct Unfolder<'f> {
    faults: &'f mut Faults,
    /// Counts with their values, where they are declared, and whether something uses them.
    counts: BTreeMap<String, Count>,
    /// Loop variables with their values, the innermost last.
    variables: Vec<(String, i64)>,
    /// Arguments of the function that is written out: they hide what has their name.
    hidden: BTreeSet<String>,
    arrays: Arrays,
    /// The entries that may still be written out; none once there were too many.
    budget: Option<usize>,
    /// Whether the entries of arrays are known: not after a fault before.
    knows_entries: bool,
    /// Whether loop variables may stand for real numbers here.
    may_use_variables: bool,
}

struct Count {
    name: Name,
    /// None after a fault.
    value: Option<i64>,
    is_used: bool,
}

impl<'f> Unfolder<'f> {
    fn new(faults: &'f mut Faults) -> Self {
        Unfolder {
            faults,
            counts: BTreeMap::new(),
            variables: Vec::new(),
            hidden: BTreeSet::new(),
            arrays: Arrays::default(),
            budget: Some(MAX_UNFOLDED),
            knows_entries: true,
            may_use_variables: false,
        }
    }

    /// Calls a function for every entry of a list, in the order in which loops and conditions yield them.
    fn each(&mut self, nodes: &[EntryNode], entries: usize, visit: &mut dyn FnMut(&mut Self, usize)) {
        if nodes.is_empty() {
            for entry in 0..entries {
                self.one(entry, visit);
            }
        } else {
            self.nodes(nodes, visit);
        }
    }

    fn nodes(&mut self, nodes: &[EntryNode], visit: &mut dyn FnMut(&mut Self, usize)) {
        for node in nodes {
            match node {
                EntryNode::Entry(entry) => self.one(*entry, visit),
                EntryNode::For(Loop { variable, range, body, .. }) => {
                    self.check_variable(variable);
                    self.repeat(variable, range, &mut |this| this.nodes(body, visit));
                }
                EntryNode::If(Conditional { condition, then, otherwise }) => match self.holds(condition) {
                    Some(true) => self.nodes(then, visit),
                    Some(false) => self.nodes(otherwise, visit),
                    None => {}
                },
            }
        }
    }

    /// One entry, with the values of loop variables beside the faults that are found in it.
    fn one(&mut self, entry: usize, visit: &mut dyn FnMut(&mut Self, usize)) {
        let before = self.faults.count();
        visit(self, entry);
        self.note_variables(before);
    }

    /// Names the loop variables in the faults that were reported since.
    fn note_variables(&mut self, before: usize) {
        if self.faults.count() > before && !self.variables.is_empty() {
            let values: Vec<String> =
                self.variables.iter().map(|(name, value)| format!("`{name} = {value}`")).collect();
            self.faults.note_first(before, &values.join(", "));
        }
    }

    /// Runs through a range with a loop variable.
    fn repeat(&mut self, variable: &Name, range: &Range, body: &mut dyn FnMut(&mut Self)) {
        let Some((start, end)) = self.bounds(range) else { return };
        let rounds = usize::try_from(end.saturating_sub(start)).unwrap_or(0);
        if !self.affords(rounds, range.span) {
            return;
        }
        for value in start..end {
            if !self.spend(1, range.span) {
                return;
            }
            self.variables.push((variable.text.clone(), value));
            body(self);
            self.variables.pop();
        }
    }

    /// Takes entries from the budget; `false` if they are not taken, which is reported.
    fn spend(&mut self, entries: usize, place: Span) -> bool {
        let affords = self.affords(entries, place);
        if affords {
            self.budget = self.budget.map(|budget| budget - entries);
        }
        affords
    }

    /// Whether so many entries may still be written out. An array or a loop that alone is too long is left out, and the rest goes
    /// on; where many entries came together, nothing else is written out, and nothing else is reported.
    fn affords(&mut self, entries: usize, place: Span) -> bool {
        let Some(budget) = self.budget else { return false };
        if entries <= budget {
            return true;
        }
        let text = format!("more than {MAX_UNFOLDED} entries, with all loops written out");
        self.faults.report(Fault::new(place, text));
        if entries <= MAX_UNFOLDED {
            self.budget = None;
        }
        false
    }

    fn check_variable(&mut self, variable: &Name) {
        if names::is_reserved(&variable.text) {
            let text = format!("`{variable}` is reserved and cannot name a loop variable");
            self.faults.report(Fault::new(variable.span(), text).help("choose another name"));
        }
    }
}
