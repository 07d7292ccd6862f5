//! A contact that stays in one state: what it holds becomes constraints.

use super::*;
use crate::syntax::HeldContact;

impl<'a> Resolver<'a, '_> {
    /// Declares the constraints of a contact in its state, and returns it as outputs see it.
    pub(super) fn hold(&mut self, entry: &ContactEntry<'a>, held: &'a HeldContact) -> ContactValue {
        let first = self.constraints.len();
        match &held.gap {
            Some(rate) if held.gap_by_rate => self.eval.constraint(rate, &mut self.constraints),
            Some(gap) => {
                self.eval.holonomic(gap, &mut self.constraints);
                self.judge_on_positions();
            }
            None => {}
        }
        held.slip.iter().for_each(|slip| self.eval.constraint(slip, &mut self.constraints));
        let mut forms = Vec::new();
        for form in &mut self.constraints[first..] {
            form.entry.written = entry.name;
            forms.push(form.symbol);
        }
        let zero = self.eval.bench.graph.zero();
        let unknown = held.is_undetermined.then(|| {
            let name = format!("reaction({})", entry.name);
            self.eval.bench.graph.symbol(&name, Role::Input)
        });
        self.undetermined.extend(unknown);
        let mut forms = forms.into_iter();
        let mut of_rows: Vec<ExprId> = held
            .rows
            .iter()
            .map(|is_held| if *is_held { forms.next().unwrap_or(zero) } else { zero })
            .map(|form| unknown.unwrap_or(form))
            .collect();
        let reaction = match of_rows[..] {
            [row] => Value::Scalar(row),
            _ => {
                of_rows.resize(3, zero);
                Value::Vector([of_rows[0], of_rows[1], of_rows[2]])
            }
        };
        ContactValue { reaction, is_held: true, ..self.value_of(entry) }
    }
}
