//! Texts of C (`provide source`): which systems have none, and which steppers the others have in theirs.

use guen_symbolic::{Multivariate, Operation, Programs};

use crate::derive::{DerivedLevel, function};
use crate::diagnostics::{Fault, Faults};
use crate::model::Model;
use crate::syntax::Name;

/// Reports at the word `source` what a text of C cannot say: functions of the program, and motions through modes.
pub(in crate::derive) fn check(
    model: &Model<'_>,
    programs: &Programs,
    has_modes: bool,
    word: &Name,
    faults: &mut Faults,
) {
    if model.declaration.is_outline {
        return;
    }
    if has_modes {
        let text = "motions go through modes, and a text of C has one right-hand side";
        let help = "provide it in a scene with one mode, `modes { name: open; }`";
        faults.report(Fault::new(word.span(), text).help(help));
        return;
    }
    let written = programs
        .functions
        .iter()
        .filter(|known| [function::RHS, function::DOMAIN].contains(&known.name.as_str()));
    let written = written.flat_map(|program| &program.instructions);
    let supplied = programs.prepare.iter().chain(written).find_map(|step| match &step.operation {
        Operation::Apply(Multivariate::Supplied { function, .. }, _) => {
            model.functions.get(usize::from(*function))
        }
        _ => None,
    });
    if let Some(supplied) = supplied {
        let text = format!("`{}` is a function of the program, which a text of C cannot call", supplied.name);
        faults.report(Fault::new(word.span(), text).help("declare it as an expression, `fn name(x) = e;`"));
    }
}

impl DerivedLevel {
    /// Whether its text of C has steppers: it does not lead states back onto constraints of positions after steps.
    pub fn steps_in_c(&self) -> bool {
        self.selection.holonomic.is_empty()
    }

    /// Whether these choose their steps, too: at switches such steps would have to begin anew.
    pub fn steps_adapt_in_c(&self) -> bool {
        self.steps_in_c() && self.switches.is_empty()
    }
}
