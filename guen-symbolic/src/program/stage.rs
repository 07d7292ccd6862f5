//! Straight-line code while it is written.

use super::{Instruction, Operation, Value};
use crate::algebra::FastMap;

/// A stage of code: equal operations are one instruction.
#[derive(Default)]
pub(super) struct Stage {
    pub(super) instructions: Vec<Instruction>,
    pub(super) numbering: FastMap<Operation, Value>,
    pub(super) values: u32,
}

impl Stage {
    /// Returns the value of an operation: of the instruction that has it already, or of a new one.
    pub(super) fn emit(&mut self, operation: Operation) -> Value {
        let operation = match operation {
            Operation::Add(a, b) if b < a => Operation::Add(b, a),
            Operation::Mul(a, b) if b < a => Operation::Mul(b, a),
            other => other,
        };
        if let Some(value) = self.numbering.get(&operation) {
            return *value;
        }
        let result = self.fresh();
        self.numbering.insert(operation.clone(), result);
        self.instructions.push(Instruction { result, operation });
        result
    }

    /// Returns a new value.
    pub(super) fn fresh(&mut self) -> Value {
        self.values += 1;
        Value(self.values - 1)
    }
}
