//! Reads what a system says that it provides: all but four quantities are there anyway.

use super::Resolver;
use crate::diagnostics::Fault;
use crate::names::nearest;
use crate::syntax::Provide;

/// The quantities that are derived only when a system asks for them.
const ASKED_FOR: [&str; 4] = ["operators", "taylor", "carried", "source"];

impl<'a> Resolver<'a, '_> {
    pub(super) fn provide(&mut self, provide: &'a Provide) {
        let name = &provide.name;
        match name.text.as_str() {
            "operators" if provide.of.is_none() => self.provides_operators = true,
            "taylor" if provide.of.is_none() => self.provides_taylor = Some(name),
            "carried" if provide.of.is_none() => self.provides_carried = Some(name),
            "source" if provide.of.is_none() => self.provides_source = Some(name),
            _ => {
                let fault = Fault::new(name.span(), "the full system provides everything already")
                    .note("`provide` chooses what a scene offers beside its state")
                    .note(
                        "of a system four say something: `operators`, that the brackets of all operators are \
                         derived, `taylor`, that it has a Taylor series, `carried`, that it has a form \
                         without elementary calls, and `source`, that its right-hand side is a text of C, too",
                    );
                self.eval.faults.report(match nearest(&name.text, ASKED_FOR) {
                    Some(near) => fault.help(format_args!("did you mean `{near}`?")),
                    None => fault,
                });
            }
        }
    }
}
