//! `forces { force along direction; .. }`.

use proc_macro2::Group;

use super::attributes::docs;
use super::expression::expression;
use super::lists::{entries, expression_to_semicolon};
use super::nesting::Entries;
use super::punctuation::{begins_documentation, unexpected};
use crate::diagnostics::{Fault, Faults};
use crate::syntax::Force;

/// The entries of `forces`.
pub(crate) fn forces(group: &Group, faults: &mut Faults) -> Entries<Force> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let force = expression(cursor, faults)?;
        let Some(along) = cursor.eat_word("along") else {
            let found = cursor.found();
            let is_other_shape = [';', ',', ':', '='].iter().any(|mark| cursor.is_punct(*mark));
            if is_other_shape || cursor.is_end() {
                let fault = Fault::new(cursor.span(), format!("expected `along`, found {found}"));
                return Err(faults
                    .report(fault.help(
                        "a force reads `force along velocity;`, for example `-c*dot(x) along dot(x);`",
                    )));
            }
            return Err(unexpected(cursor, faults, "`along`"));
        };
        let direction = expression_to_semicolon(cursor, faults, begins_documentation);
        Ok(Force { docs, force, along, direction })
    })
}
