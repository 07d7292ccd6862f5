//! Names that a system declares nowhere, told beside the faults of its loops and components: the model, which tells them otherwise,
//! does not come to see a declaration that cannot be written out.

use std::collections::BTreeSet;

use super::component_names::{loop_variables, texts};
use crate::diagnostics::{Fault, Faults};
use crate::names::{RATE_SUFFIX, is_function, is_reserved, nearest};
use crate::syntax::{Declaration, Expression, ExpressionKind, Index, Item, Name};

/// Returns the names that nothing in a declaration can have declared, each at its first use. Its loops are still written: what a fault
/// leaves out of them is declared here.
pub(crate) fn unknown_names(declaration: &Declaration) -> Vec<Fault> {
    let mut known: BTreeSet<&str> = declaration.items.iter().flat_map(texts).collect();
    let mut variables = Vec::new();
    loop_variables(&declaration.nesting, &mut variables);
    declaration.items.iter().for_each(|item| loop_variables(item.nesting(), &mut variables));
    known.extend(variables);
    let mut search = Search { declaration, known, told: BTreeSet::new(), faults: Vec::new() };
    for item in &declaration.items {
        match item {
            // Names of their own stand in these.
            Item::Contacts(_) | Item::Resets(_) | Item::Modes(_) | Item::Component(_) | Item::Scene(_) => {}
            Item::Function(function) => {
                let own: Vec<&str> = function.parameters.iter().map(|name| name.text.as_str()).collect();
                item.expressions().into_iter().for_each(|e| search.look_at(e, &own));
            }
            item => item.expressions().into_iter().for_each(|e| search.look_at(e, &[])),
        }
    }
    search.faults
}

/// Reports them where nothing else is reported of their places.
pub(crate) fn report(unknown: Vec<Fault>, faults: &mut Faults) {
    for fault in unknown {
        if !faults.has_at(fault.span()) {
            faults.report(fault);
        }
    }
}

struct Search<'a> {
    declaration: &'a Declaration,
    known: BTreeSet<&'a str>,
    told: BTreeSet<&'a str>,
    faults: Vec<Fault>,
}

impl<'a> Search<'a> {
    fn look_at(&mut self, e: &'a Expression, own: &[&str]) {
        match &e.kind {
            ExpressionKind::Name(name) if !self.knows(name, own) && self.told.insert(&name.text) => {
                let system = &self.declaration.name;
                let fault =
                    Fault::new(name.span(), format!("unknown name `{}` in system `{system}`", name.text));
                self.faults.push(match nearest(&name.text, self.known.iter().copied()) {
                    Some(near) => fault.help(format_args!("did you mean `{near}`?")),
                    None => fault,
                });
            }
            ExpressionKind::Fold(fold) => {
                let own: Vec<&str> = own.iter().copied().chain([fold.variable.text.as_str()]).collect();
                return self.look_at(&fold.body, &own);
            }
            _ => {}
        }
        e.children().into_iter().for_each(|child| self.look_at(child, own));
    }

    /// Whether a name is declared somewhere, be it as the rate or a component of something. Members of instances are looked up where
    /// components are written out.
    fn knows(&self, name: &Name, own: &[&str]) -> bool {
        let text = name.text.as_str();
        let mut parts = [RATE_SUFFIX, "_x", "_y", "_z"].into_iter();
        matches!(name.index, Index::Member(_))
            || self.known.contains(text)
            || own.contains(&text)
            || is_reserved(text)
            || is_function(text)
            || parts.any(|suffix| text.strip_suffix(suffix).is_some_and(|of| self.known.contains(of)))
    }
}
