//! Programs with some of their symbols at constant values.

use super::{Instruction, Operation, OperationCount, Programs, Value};
use crate::algebra::SymbolId;

impl Programs {
    /// Returns the programs, operation by operation, with symbols at values that depend on constants alone: the
    /// outputs of the one function of `values`, in the order of the symbols.
    ///
    /// ```
    /// use guen_symbolic::{Graph, ProgramBuilder, Role};
    /// let mut g = Graph::new();
    /// let (x, m, k) = (g.symbol("x", Role::Coordinate), g.symbol("m", Role::Constant), g.symbol("k", Role::Constant));
    /// let square = g.powi(m, 2);
    /// let force = g.mul(square, x);
    /// let of = |g: &mut Graph, e| {
    ///     let mut builder = ProgramBuilder::new(g);
    ///     builder.add_function("f", &[e]);
    ///     builder.finish()
    /// };
    /// let whole = of(&mut g, force);
    /// let root = g.root(k, 2);
    /// let values = of(&mut g, root);
    /// let fixed = whole.with_values(&[g.as_symbol(m).unwrap()], &values);
    /// assert_eq!(fixed.functions[0].cost, whole.functions[0].cost);
    /// let reads = |s| fixed.prepare.iter().any(|i| i.operation == guen_symbolic::Operation::Symbol(s));
    /// assert!(reads(g.as_symbol(k).unwrap()) && !reads(g.as_symbol(m).unwrap()));
    /// ```
    pub fn with_values(&self, symbols: &[SymbolId], values: &Programs) -> Programs {
        let mut fixed = Programs {
            prepare: values.prepare.clone(),
            prepared: Vec::new(),
            prepare_values: values.prepare_values,
            prepare_cost: OperationCount::default(),
            functions: self.functions.clone(),
        };
        let known =
            fixed.placed(&values.functions[0].instructions, values.functions[0].values, |operation| {
                match operation {
                    Operation::Prepared(k) => Some(values.prepared[*k]),
                    _ => None,
                }
            });
        let known: Vec<Value> =
            values.functions[0].outputs.iter().map(|value| known[value.index()]).collect();
        let value_of = |operation: &Operation| match operation {
            Operation::Symbol(symbol) => {
                symbols.iter().position(|fixed| fixed == symbol).map(|place| known[place])
            }
            _ => None,
        };
        let moved = fixed.placed(&self.prepare, self.prepare_values, value_of);
        fixed.prepared = self.prepared.iter().map(|value| moved[value.index()]).collect();
        let first = fixed.prepared.len();
        fixed.prepared.extend(&known);
        for instruction in fixed.functions.iter_mut().flat_map(|function| &mut function.instructions) {
            if let Operation::Symbol(symbol) = &instruction.operation
                && let Some(place) = symbols.iter().position(|fixed| fixed == symbol)
            {
                instruction.operation = Operation::Prepared(first + place);
            }
        }
        fixed.prepare_cost = OperationCount::of(&fixed.prepare);
        // What is read of the values is kept, and no more.
        let all: Vec<(&str, Vec<usize>)> =
            self.functions.iter().map(|f| (&f.name[..], (0..f.outputs.len()).collect())).collect();
        fixed.part(&all)
    }

    /// Adds instructions to the preparation, those left out that are known there; where each of their values is then.
    fn placed(
        &mut self,
        instructions: &[Instruction],
        count: usize,
        known: impl Fn(&Operation) -> Option<Value>,
    ) -> Vec<Value> {
        let mut moved = vec![Value(u32::MAX); count];
        for instruction in instructions {
            if let Some(value) = known(&instruction.operation) {
                moved[instruction.result.index()] = value;
                continue;
            }
            let mut next = || {
                self.prepare_values += 1;
                Value(self.prepare_values as u32 - 1)
            };
            let result = next();
            moved[instruction.result.index()] = result;
            if let Operation::SinCos { cosine, .. } = instruction.operation {
                moved[cosine.index()] = next();
            }
            let mut operation = instruction.operation.clone();
            operation.values_mut().for_each(|value| *value = moved[value.index()]);
            self.prepare.push(Instruction { result, operation });
        }
        moved
    }
}
