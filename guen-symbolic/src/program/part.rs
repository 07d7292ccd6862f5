//! A part of programs: some outputs of some functions, and only what they need.

use std::ops::Range;

use super::{FunctionProgram, Instruction, Operation, OperationCount, Programs, Value};
use crate::algebra::SymbolId;

impl Programs {
    /// The programs of chosen outputs of chosen functions, in the order given: the instructions that they need and the
    /// prepared values that these need, each as it is in the whole, so that every result is the same to the bit.
    /// Functions that are not there are left out.
    ///
    /// ```
    /// use guen_symbolic::{Graph, ProgramBuilder, Role};
    /// let mut g = Graph::new();
    /// let (x, m, k) = (g.symbol("x", Role::Coordinate), g.symbol("m", Role::Constant), g.symbol("k", Role::Constant));
    /// let (u, v) = (g.mul(m, x), g.mul(k, x));
    /// let (u, v) = (g.sin(u), g.exp(v));
    /// let mut builder = ProgramBuilder::new(&mut g);
    /// builder.add_function("both", &[u, v]);
    /// let whole = builder.finish();
    /// let part = whole.part(&[("both", vec![1])]);
    /// assert_eq!((whole.functions[0].cost.operations(), part.functions[0].cost.operations()), (2, 1));
    /// assert_eq!(part.functions[0].cost.sines, 0);
    /// ```
    pub fn part(&self, wanted: &[(&str, Vec<usize>)]) -> Programs {
        let mut functions: Vec<FunctionProgram> = Vec::new();
        for (name, places) in wanted {
            let Some(whole) = self.functions.iter().find(|function| function.name == *name) else { continue };
            let outputs: Vec<Value> = places.iter().map(|place| whole.outputs[*place]).collect();
            let instructions = needed(&whole.instructions, whole.values, &outputs);
            let cost = OperationCount::of(&instructions);
            functions.push(FunctionProgram {
                name: whole.name.clone(),
                instructions,
                outputs,
                values: whole.values,
                cost,
            });
        }
        let mut used = vec![false; self.prepared.len()];
        for instruction in functions.iter().flat_map(|function| &function.instructions) {
            if let Operation::Prepared(k) = instruction.operation {
                used[k] = true;
            }
        }
        let kept: Vec<usize> = (0..used.len()).filter(|k| used[*k]).collect();
        let mut moved = vec![0; used.len()];
        for (new, old) in kept.iter().enumerate() {
            moved[*old] = new;
        }
        for instruction in functions.iter_mut().flat_map(|function| &mut function.instructions) {
            if let Operation::Prepared(k) = &mut instruction.operation {
                *k = moved[*k];
            }
        }
        let prepared: Vec<Value> = kept.iter().map(|k| self.prepared[*k]).collect();
        let prepare = needed(&self.prepare, self.prepare_values, &prepared);
        let prepare_cost = OperationCount::of(&prepare);
        Programs { prepare, prepared, prepare_values: self.prepare_values, prepare_cost, functions }
    }

    /// Adds the functions of other programs behind one's own, and their preparation behind one's own.
    ///
    /// ```
    /// use guen_symbolic::{Graph, ProgramBuilder, Role};
    /// let mut g = Graph::new();
    /// let (x, m, k) = (g.symbol("x", Role::Coordinate), g.symbol("m", Role::Constant), g.symbol("k", Role::Constant));
    /// let (u, v) = (g.powi(m, 2), g.powi(k, 3));
    /// let (u, v) = (g.mul(u, x), g.mul(v, x));
    /// let of = |g: &mut Graph, name: &str, e| {
    ///     let mut builder = ProgramBuilder::new(g);
    ///     builder.add_function(name, &[e]);
    ///     builder.finish()
    /// };
    /// let (mut programs, others) = (of(&mut g, "first", u), of(&mut g, "second", v));
    /// programs.append(others);
    /// assert_eq!((programs.functions.len(), programs.prepared.len()), (2, 2));
    /// ```
    pub fn append(&mut self, mut other: Programs) {
        let values = self.prepare_values as u32;
        for instruction in &mut other.prepare {
            instruction.result.0 += values;
            instruction.operation.values_mut().for_each(|value| value.0 += values);
        }
        for function in &mut other.functions {
            for instruction in &mut function.instructions {
                if let Operation::Prepared(k) = &mut instruction.operation {
                    *k += self.prepared.len();
                }
            }
        }
        self.prepare.extend(other.prepare);
        self.prepared.extend(other.prepared.into_iter().map(|value| Value(value.0 + values)));
        self.prepare_values += other.prepare_values;
        self.prepare_cost = OperationCount::of(&self.prepare);
        self.functions.extend(other.functions);
    }
}

impl Programs {
    /// Adds a function that computes some outputs of another one, as that does, and nothing else.
    ///
    /// ```
    /// use guen_symbolic::{Graph, ProgramBuilder, Role};
    /// let mut g = Graph::new();
    /// let x = g.symbol("x", Role::Coordinate);
    /// let (sine, square) = (g.sin(x), g.powi(x, 2));
    /// let mut builder = ProgramBuilder::new(&mut g);
    /// builder.add_function("both", &[sine, square]);
    /// let mut programs = builder.finish();
    /// programs.add_excerpt("square", "both", 1..2);
    /// assert_eq!((programs.functions[1].cost.operations(), programs.functions[1].cost.sines), (1, 0));
    /// ```
    pub fn add_excerpt(&mut self, name: &str, of: &str, outputs: Range<usize>) {
        let Some(whole) = self.functions.iter().find(|function| function.name == of) else { return };
        let outputs = whole.outputs[outputs].to_vec();
        let instructions = needed(&whole.instructions, whole.values, &outputs);
        let cost = OperationCount::of(&instructions);
        let excerpt =
            FunctionProgram { name: name.to_owned(), instructions, outputs, values: whole.values, cost };
        self.functions.push(excerpt);
    }

    /// Divides a function: its outputs from a place on become those of a function of their own, each of the two computes what
    /// it needs.
    ///
    /// ```
    /// use guen_symbolic::{Graph, ProgramBuilder, Role};
    /// let mut g = Graph::new();
    /// let x = g.symbol("x", Role::Coordinate);
    /// let (sine, square) = (g.sin(x), g.powi(x, 2));
    /// let mut builder = ProgramBuilder::new(&mut g);
    /// builder.add_function("sine", &[sine, square]);
    /// let mut programs = builder.finish();
    /// programs.divide("sine", 1, "square");
    /// let costs: Vec<_> = programs.functions.iter().map(|f| (f.cost.operations(), f.cost.sines)).collect();
    /// assert_eq!(costs, [(0, 1), (1, 0)]);
    /// ```
    pub fn divide(&mut self, name: &str, at: usize, rest: &str) {
        let Some(place) = self.functions.iter().position(|function| function.name == name) else { return };
        let count = self.functions[place].outputs.len();
        self.add_excerpt(rest, name, at..count);
        let whole = &mut self.functions[place];
        whole.outputs.truncate(at);
        whole.instructions = needed(&whole.instructions, whole.values, &whole.outputs);
        whole.cost = OperationCount::of(&whole.instructions);
    }
}

impl FunctionProgram {
    /// The symbols that the function reads.
    pub fn symbols(&self) -> impl Iterator<Item = SymbolId> {
        self.instructions.iter().filter_map(|instruction| match instruction.operation {
            Operation::Symbol(symbol) => Some(symbol),
            _ => None,
        })
    }
}

/// The instructions that some values need, in their order.
pub(super) fn needed(instructions: &[Instruction], count: usize, values: &[Value]) -> Vec<Instruction> {
    let mut live = vec![false; count];
    for value in values {
        live[value.index()] = true;
    }
    let mut kept: Vec<Instruction> = Vec::new();
    for instruction in instructions.iter().rev() {
        let second = match instruction.operation {
            Operation::SinCos { cosine, .. } => live[cosine.index()],
            _ => false,
        };
        if live[instruction.result.index()] || second {
            instruction.operation.operands().for_each(|operand| live[operand.index()] = true);
            kept.push(instruction.clone());
        }
    }
    kept.reverse();
    kept
}
