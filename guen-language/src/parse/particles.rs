//! `particles { mass at position; .. }`.

use proc_macro2::Group;

use super::attributes::docs;
use super::expression::expression;
use super::lists::{entries, expression_to_semicolon};
use super::nesting::Entries;
use super::punctuation::{begins_documentation, unexpected};
use crate::diagnostics::{Fault, Faults};
use crate::syntax::Particle;

/// The entries of `particles`.
pub(crate) fn particles(group: &Group, faults: &mut Faults) -> Entries<Particle> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let mass = expression(cursor, faults)?;
        let Some(at) = cursor.eat_word("at") else {
            if cursor.is_punct(';') || cursor.is_punct(',') || cursor.is_punct(':') || cursor.is_end() {
                let fault = Fault::new(cursor.span(), format!("expected `at`, found {}", cursor.found()));
                return Err(faults.report(fault.help("a particle reads `mass at vec(x, y, z);`")));
            }
            return Err(unexpected(cursor, faults, "`at`"));
        };
        let position = expression_to_semicolon(cursor, faults, begins_documentation);
        Ok(Particle { docs, mass, at, position })
    })
}
