//! Follows code with loops turn by turn, and compares it with the code that it was made of.

use super::{Arrays, Operand, Rolled, RolledStep};
use crate::program::instruction::{Instruction, Operation, Value};

/// Whether rolled code does exactly the operations of some code, each with its operands made before.
pub(super) fn is_equal(
    (instructions, outputs, values): (&[Instruction], &[Value], usize),
    rolled: &Rolled,
    given: &dyn Arrays,
) -> bool {
    let mut known: Simulation<'_> = Simulation {
        instructions,
        given,
        is_made: vec![false; values],
        is_named: vec![false; values],
        arrays: rolled.arrays.iter().map(|length| vec![None; *length]).collect(),
        users: vec![Vec::new(); values],
        loads: Default::default(),
    };
    known.prepare();
    let mut results: Vec<Option<Value>> = vec![None; outputs.len()];
    known.run(rolled, &mut results).is_some()
        && results.iter().zip(outputs).all(|(written, output)| match written {
            Some(written) => written == output,
            None => known.is_named[output.index()],
        })
}

struct Simulation<'a> {
    instructions: &'a [Instruction],
    given: &'a dyn Arrays,
    is_made: Vec<bool>,
    /// Whether a value can be read by its name.
    is_named: Vec<bool>,
    arrays: Vec<Vec<Option<Value>>>,
    /// The instructions with each operand.
    users: Vec<Vec<usize>>,
    /// The values of what the function is given.
    loads: std::collections::BTreeMap<(char, usize), Value>,
}

impl Simulation<'_> {
    fn prepare(&mut self) {
        for (place, Instruction { result, operation }) in self.instructions.iter().enumerate() {
            let load = match operation {
                Operation::Symbol(symbol) => self.given.symbol(*symbol),
                Operation::Prepared(k) => Some(('k', *k)),
                _ => None,
            };
            if let Some(load) = load {
                self.loads.insert(load, *result);
            }
            if matches!(operation, Operation::Symbol(_) | Operation::Prepared(_)) {
                self.is_made[result.index()] = true;
                self.is_named[result.index()] = true;
            }
            for operand in operation.operands() {
                self.users[operand.index()].push(place);
            }
        }
    }

    /// Marks what an instruction makes, if its operands are there.
    fn make(&mut self, instruction: &Instruction) -> Option<()> {
        if !instruction.operation.operands().all(|v| self.is_made[v.index()]) {
            return None;
        }
        self.is_made[instruction.result.index()] = true;
        if let Operation::SinCos { cosine, .. } = instruction.operation {
            self.is_made[cosine.index()] = true;
        }
        Some(())
    }

    fn element(&self, array: usize, at: i64) -> Option<Value> {
        *self.arrays.get(array)?.get(usize::try_from(at).ok()?)?
    }

    fn store(&mut self, array: usize, at: i64, value: Value) -> Option<()> {
        *self.arrays.get_mut(array)?.get_mut(usize::try_from(at).ok()?)? = Some(value);
        Some(())
    }

    /// `None` where something differs.
    fn run(&mut self, rolled: &Rolled, results: &mut [Option<Value>]) -> Option<()> {
        for step in &rolled.steps {
            match step {
                RolledStep::Once(instruction) => {
                    if !instruction.operation.operands().all(|v| self.is_named[v.index()]) {
                        return None;
                    }
                    self.make(instruction)?;
                    self.is_named[instruction.result.index()] = true;
                    if let Operation::SinCos { cosine, .. } = instruction.operation {
                        self.is_named[cosine.index()] = true;
                    }
                }
                RolledStep::Store { array, at, value } => {
                    if !self.is_named[value.index()] {
                        return None;
                    }
                    self.store(*array, *at as i64, *value)?;
                }
                RolledStep::Load { array, at, value } => {
                    if self.element(*array, *at as i64) != Some(*value) {
                        return None;
                    }
                    self.is_named[value.index()] = true;
                }
                RolledStep::Loop(turns) => {
                    for turn in 0..turns.to - turns.from {
                        let turn = if turns.descends { turns.to - 1 - turn } else { turns.from + turn };
                        let mut made: Vec<[Option<Value>; 2]> = Vec::new();
                        for line in &turns.lines {
                            let mut operands = Vec::new();
                            for operand in &line.operands {
                                operands.push(match *operand {
                                    Operand::Outside(value) if self.is_named[value.index()] => value,
                                    Operand::Outside(_) => return None,
                                    Operand::Given { array, first, stride } => {
                                        let at = first as i64 + stride * (turn - turns.from);
                                        *self.loads.get(&(array, usize::try_from(at).ok()?))?
                                    }
                                    Operand::Line(line, second) => made.get(line)?[usize::from(second)]?,
                                    Operand::Element(array, offset) => self.element(array, turn + offset)?,
                                });
                            }
                            let place = self.found(&line.operation, &operands)?;
                            let instruction = &self.instructions[place];
                            self.make(instruction)?;
                            let second = match instruction.operation {
                                Operation::SinCos { cosine, .. } => Some(cosine),
                                _ => None,
                            };
                            let both = [Some(instruction.result), second];
                            for ((value, store), output) in
                                both.into_iter().zip(line.stores).zip(line.outputs)
                            {
                                if let Some((array, offset)) = store {
                                    self.store(array, turn + offset, value?)?;
                                }
                                if let Some(run) = output {
                                    *results.get_mut(usize::try_from(run.at(turn)).ok()?)? = Some(value?);
                                }
                            }
                            made.push(both);
                        }
                    }
                }
            }
        }
        Some(())
    }

    /// The instruction that does an operation on these operands.
    fn found(&self, like: &Operation, operands: &[Value]) -> Option<usize> {
        let users = operands.iter().map(|operand| &self.users[operand.index()]);
        let places = users.min_by_key(|places| places.len())?;
        places.iter().copied().find(|place| {
            let operation = &self.instructions[*place].operation;
            let is_commutative = matches!(operation, Operation::Add(..) | Operation::Mul(..));
            let own: Vec<Value> = operation.operands().collect();
            let is_same = match (like, operation) {
                (Operation::Call(a, _), Operation::Call(b, _)) => a == b,
                (Operation::Apply(a, _), Operation::Apply(b, _)) => a == b,
                _ => std::mem::discriminant(like) == std::mem::discriminant(operation),
            };
            is_same
                && (own == operands
                    || is_commutative && own.len() == 2 && own[0] == operands[1] && own[1] == operands[0])
        })
    }
}
