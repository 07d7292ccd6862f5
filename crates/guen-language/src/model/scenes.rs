//! Scenes: their names and values are checked as the language says.

use super::evaluate::Evaluator;
use super::place::Place;
use super::scope::Category;
use super::value::Value;
use super::{FixedConstant, SceneEntry};
use crate::diagnostics::Fault;
use crate::names;
use crate::syntax::{Fix, Name, Provide, Scene};

/// What a scene may provide beside outputs.
const QUANTITIES: [&str; 4] = ["energy", "reactions", "linearization", "operators"];

impl Evaluator<'_> {
    /// Checks a scene's statements at their words; `None` after a fault.
    pub(super) fn scene(&mut self, scene: &Scene) -> Option<SceneEntry> {
        let before = self.faults.count();
        let mut fixes = Vec::new();
        for name in &scene.tracks {
            self.tracked(name);
        }
        for fix in &scene.fixes {
            fixes.extend(self.fixed(fix));
        }
        for provide in &scene.provides {
            self.provided(provide);
        }
        (self.faults.count() == before).then_some(SceneEntry { keyword: scene.keyword, fixes })
    }

    fn tracked(&mut self, name: &Name) {
        match self.scope.category(&name.text) {
            Some(Category::Coordinate | Category::Parameter) => {}
            Some(other) => {
                let noun = other.noun();
                self.faults.report(
                    Fault::new(
                        name.span(),
                        format!("`{name}` is {noun}, and a scene tracks coordinates and parameters"),
                    )
                    .help(format!("a quantity that is computed is provided: `provide {name};`")),
                );
            }
            None => self.unknown(name, "a scene"),
        }
    }

    fn fixed(&mut self, fix: &Fix) -> Option<FixedConstant> {
        let name = &fix.name;
        match (self.scope.category(&name.text), &fix.value) {
            (Some(Category::Constant), Some(value)) => {
                // A number, or made of constants; a fault is reported there.
                let fixed = self.scalar_at(Place::Default, value).ok()?;
                let symbol = match self.scope.peek(&name.text) {
                    Some(Value::Scalar(symbol)) => *symbol,
                    _ => return None,
                };
                return Some(FixedConstant {
                    name: name.text.clone(),
                    span: name.span(),
                    symbol,
                    value: fixed,
                });
            }
            (Some(Category::Constant), None) => {
                self.faults.report(
                    Fault::new(name.span(), format!("constant `{name}` is fixed to a value"))
                        .help(format!("write `fix {name} = 1;`")),
                );
            }
            (Some(Category::Coordinate | Category::Parameter), None) => {}
            (Some(Category::Coordinate | Category::Parameter), Some(value)) => {
                self.faults.report(
                    Fault::new(value.first_token(), format!("`{name}` is fixed at its initial value"))
                        .help(format!("write `fix {name};`")),
                );
            }
            (Some(other), _) => {
                let noun = other.noun();
                self.faults.report(Fault::new(
                    name.span(),
                    format!("`{name}` is {noun}, and a scene fixes constants, and parameters or coordinates at rest"),
                ));
            }
            (None, _) => self.unknown(name, "a scene"),
        }
        None
    }

    fn provided(&mut self, provide: &Provide) {
        let name = &provide.name;
        let is_known = QUANTITIES.contains(&name.text.as_str())
            || self.scope.category(&name.text) == Some(Category::Output);
        if !is_known {
            let near = names::nearest(&name.text, QUANTITIES);
            let fault = Fault::new(name.span(), format!("a scene cannot provide `{name}`"));
            self.faults.report(match near {
                Some(near) => fault.help(format!("did you mean `{near}`?")),
                None => fault.help(format!("it provides {} and declared outputs", names::quoted(QUANTITIES))),
            });
        }
        let Some(of) = &provide.of else { return };
        for constraint in of {
            if name.text != "reactions" {
                self.faults.report(Fault::new(constraint.span(), format!("`{name}` takes no names")));
                return;
            }
            if self.scope.category(&constraint.text) != Some(Category::Constraint) {
                self.faults.report(
                    Fault::new(constraint.span(), format!("`{constraint}` is not a constraint"))
                        .note("reactions are those of constraints"),
                );
            }
        }
    }

    fn unknown(&mut self, name: &Name, place: &str) {
        // The scope reports it with the nearest known name.
        let _ = self.scope.look_up(self.faults, name, place);
    }
}
