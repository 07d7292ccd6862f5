//! Functions that a declaration has declared so far, and the calls of them that are being evaluated.

use std::collections::BTreeMap;
use std::rc::Rc;

use guen_symbolic::Multivariate;

use super::value::Value;
use crate::syntax::FunctionDefinition;

/// The functions declared so far, and the calls that are being evaluated.
#[derive(Default)]
pub(super) struct DeclaredFunctions {
    pub(super) by_name: BTreeMap<String, Rc<FunctionDefinition>>,
    /// The functions that the program supplies: each in the graph, unless a fault of it was reported, with the names of its arguments.
    pub(super) supplied: BTreeMap<String, (Option<Multivariate>, Vec<String>)>,
    /// The arguments of the calls that are being evaluated, the innermost last.
    pub(super) frames: Vec<BTreeMap<String, Value>>,
    /// The depths of the functions' expressions in the calls that are being evaluated, added up.
    pub(super) depth: usize,
    /// Calls evaluated so far.
    pub(super) calls: usize,
    /// Faults that were told the innermost call around them.
    pub(super) noted: usize,
}

impl DeclaredFunctions {
    /// The value of an argument of the innermost call.
    pub(super) fn argument(&self, name: &str) -> Option<&Value> {
        self.frames.last()?.get(name)
    }

    /// The function of a name.
    pub(super) fn get(&self, name: &str) -> Option<&FunctionDefinition> {
        self.by_name.get(name).map(|function| &**function)
    }

    /// The names of all functions.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().chain(self.supplied.keys()).map(String::as_str)
    }
}
