//! Code without what nothing uses.

use crate::algebra::{FastMap, Function};
use crate::program::cost::OperationCount;
use crate::program::instruction::{FunctionProgram, Instruction, Operation, Value};

/// Tells for each value whether the outputs depend on it.
fn used(instructions: &[Instruction], outputs: &[Value]) -> Vec<bool> {
    let values = instructions.iter().flat_map(Instruction::defined).map(|v| v.index() + 1).max().unwrap_or(0);
    let mut used = vec![false; values];
    outputs.iter().for_each(|v| used[v.index()] = true);
    for instruction in instructions.iter().rev() {
        if instruction.defined().any(|v| used[v.index()]) {
            instruction.operation.operands().for_each(|v| used[v.index()] = true);
        }
    }
    used
}

/// The instructions that outputs need, in a function of its own; a sine without its cosine is called alone.
pub(super) fn function(name: &str, instructions: &[Instruction], outputs: Vec<Value>) -> FunctionProgram {
    let used = used(instructions, &outputs);
    let mut numbers: FastMap<Value, Value> = FastMap::default();
    let mut values = 0;
    let mut fresh = |numbers: &mut FastMap<Value, Value>, v: Value| {
        let new = Value(values);
        values += 1;
        numbers.insert(v, new);
        new
    };
    let mut kept = Vec::new();
    for Instruction { result, operation } in instructions {
        let (first, second) = (used[result.index()], operation.cosine().is_some_and(|v| used[v.index()]));
        if !first && !second {
            continue;
        }
        let of = |v: &Value| numbers[v];
        let (result, operation) = match operation {
            Operation::SinCos { angle, cosine } => {
                let angle = of(angle);
                match (first, second) {
                    (true, true) => {
                        let sine = fresh(&mut numbers, *result);
                        let cosine = fresh(&mut numbers, *cosine);
                        (sine, Operation::SinCos { angle, cosine })
                    }
                    (true, false) => (fresh(&mut numbers, *result), Operation::Call(Function::Sin, angle)),
                    _ => (fresh(&mut numbers, *cosine), Operation::Call(Function::Cos, angle)),
                }
            }
            other => {
                let operation = other.renamed(&of);
                (fresh(&mut numbers, *result), operation)
            }
        };
        kept.push(Instruction { result, operation });
    }
    let outputs = outputs.iter().map(|v| numbers[v]).collect();
    let cost = OperationCount::of(&kept);
    FunctionProgram { name: name.to_owned(), instructions: kept, outputs, values: values as usize, cost }
}

/// Lets a function load from the list of prepared values, which grows by those that are new and needed.
pub(super) fn renumber_prepared(program: &mut FunctionProgram, prepared: &mut Vec<Value>, stored: &[Value]) {
    let known = prepared.len();
    let mut places: Vec<Option<usize>> = vec![None; stored.len()];
    for instruction in &mut program.instructions {
        if let Operation::Prepared(index) = &mut instruction.operation
            && *index >= known
        {
            *index = *places[*index].get_or_insert_with(|| {
                prepared.push(stored[*index]);
                prepared.len() - 1
            });
        }
    }
}

/// The first instructions, and of the others those that the outputs need.
pub(super) fn instructions(all: &[Instruction], outputs: &[Value], keep: usize) -> Vec<Instruction> {
    let used = used(all, outputs);
    all.iter()
        .enumerate()
        .filter(|(place, instruction)| *place < keep || instruction.defined().any(|v| used[v.index()]))
        .map(|(_, instruction)| instruction.clone())
        .collect()
}
