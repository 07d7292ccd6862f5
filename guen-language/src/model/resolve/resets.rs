//! `resets`: functions whose zeros are located, and the variables that have new values there.

use super::*;
use crate::syntax::{Reset, ResetAssignment};

/// The variables that a reset changes, for notes.
const VARIABLES: &str = "a reset gives new values to coordinates, parameters and states";

impl<'a> Resolver<'a, '_> {
    /// `name: e rises, variable = e, ..;` of `resets`.
    pub(super) fn reset(&mut self, reset: &'a Reset) {
        if self.declaration.in_mode.is_some() {
            // The scene has no resets: their variables may even follow from others there.
            return;
        }
        self.eval.entry = Some(reset.name.text.clone());
        let before = self.eval.faults.count();
        self.eval.scope.declare(self.eval.faults, &reset.name, Category::Reset, None);
        let function = self.eval.scalar_at(ExpressionPlace::ResetFunction, &reset.function);
        if let Ok(function) = function
            && !self.passes_through_zero(function)
        {
            let is_constant = self.eval.bench.graph.roles(function).is_constant();
            let does = if is_constant { "changes" } else { "passes through zero" };
            let text = format!("the function of reset `{}` never {does}", reset.name);
            let note = "a reset happens where its function passes through zero";
            self.eval.faults.report(Fault::new(reset.function.extent(), text).note(note));
        }
        if reset.assignments.is_empty() {
            let fault = Fault::new(reset.name.span(), format!("the reset `{}` changes nothing", reset.name));
            let word = reset.crossing.word();
            let help =
                format!("write the new values behind the function: `{}: e {word}, x = 0;`", reset.name);
            self.eval.faults.report(fault.help(help));
        }
        let mut assignments: Vec<(ExprId, ExprId)> = Vec::new();
        let mut places: Vec<(ExprId, &Expression)> = Vec::new();
        for given in &reset.assignments {
            let variable = self.variable(given);
            let value = self.eval.at(ExpressionPlace::ResetValue, &given.value);
            let (Ok(variable), Ok(value)) = (variable, value) else { continue };
            for (symbol, value) in self.pairs(given, &variable, &value) {
                let first = places.iter().find(|(known, _)| *known == symbol);
                if let Some((_, first)) = first {
                    let text =
                        format!("`{}` has two values in reset `{}`", given.variable.source(), reset.name);
                    let fault = Fault::new(given.variable.extent(), text);
                    self.eval.faults.report(fault.note_place("first given", first.extent()));
                    continue;
                }
                places.push((symbol, &given.variable));
                assignments.push((symbol, value));
            }
        }
        if let (Ok(function), true) = (function, self.eval.faults.count() == before) {
            let (name, docs, crossing) = (&reset.name, &reset.docs, reset.crossing);
            self.resets.push(ResetEntry { name, docs, function, crossing, assignments });
        }
    }

    /// The value of what stands left of `=`: a variable, or a vector of variables.
    fn variable(&mut self, given: &ResetAssignment) -> Evaluated<Value> {
        let written = &given.variable;
        let fault = |text: String| Fault::new(written.extent(), text).note(VARIABLES);
        let name = match &written.kind {
            ExpressionKind::Name(name) => name,
            ExpressionKind::Missing => return self.eval.at(ExpressionPlace::ResetValue, written),
            ExpressionKind::Call { function, .. } if function.text == "dot" => {
                let fault = fault(format!("`{}` is a velocity, and no variable", written.source()));
                return self.eval.fail(fault.help("velocities follow from the parameters: reset these"));
            }
            _ => return self.eval.fail(fault(format!("`{}` is no variable", written.source()))),
        };
        let category = self.eval.scope.category(&name.text);
        let is_fixed = category.filter(|category| {
            !matches!(category, Category::Coordinate | Category::Parameter | Category::State | Category::Let)
        });
        if let Some(category) = is_fixed {
            let fault = fault(format!("`{name}` is {}, and no variable", category.noun()));
            return self.eval.fail(match category {
                Category::Input => {
                    fault.help("inputs change at times of the run: `.inputs(&[(time, inputs)])`")
                }
                Category::Constant => {
                    fault.help("what changes on the way is a state: `states { dot(x) = 0; }`")
                }
                _ => fault,
            });
        }
        self.eval.at(ExpressionPlace::ResetValue, written)
    }

    /// The symbols of variables with their values.
    fn pairs(&mut self, given: &ResetAssignment, variable: &Value, value: &Value) -> Vec<(ExprId, ExprId)> {
        let pairs: Vec<(ExprId, ExprId)> = match (variable, value) {
            (Value::Scalar(variable), Value::Scalar(value)) => vec![(*variable, *value)],
            (Value::Vector(variable), Value::Vector(value)) => {
                variable.iter().copied().zip(value.iter().copied()).collect()
            }
            _ => {
                let text = format!(
                    "`{}` is {}, and this is {}",
                    given.variable.source(),
                    variable.kind(),
                    value.kind()
                );
                self.eval.faults.report(Fault::new(given.value.extent(), text));
                return Vec::new();
            }
        };
        let graph = &self.eval.bench.graph;
        let is_variable = |e: ExprId| {
            let roles = [Role::Coordinate, Role::QuasiVelocity, Role::State];
            graph.as_symbol(e).is_some() && roles.into_iter().any(|role| graph.roles(e).has(role))
        };
        // Of a vector in the plane the third component stays zero.
        let stays = |(variable, value): &(ExprId, ExprId)| graph.is_zero(*variable) && graph.is_zero(*value);
        let pairs: Vec<_> = pairs.into_iter().filter(|pair| !stays(pair)).collect();
        if pairs.is_empty() || pairs.iter().any(|(variable, _)| !is_variable(*variable)) {
            let text = format!("`{}` is no variable", given.variable.source());
            self.eval.faults.report(Fault::new(given.variable.extent(), text).note(VARIABLES));
            return Vec::new();
        }
        pairs
    }
}
