//! Rolls straight-line code up: what is done for each member of a family becomes the body of a loop.
//!
//! What comes in is the code of a function, written regularly (`regular`); what goes out does the same operations on the same
//! operands, so that every result is the same to the bit. `classes` finds operations that differ in their indices alone, `schedule` puts classes
//! that go through the members in one direction into one loop, and `simulate` follows the loops turn by turn and compares every operand with the code that came
//! in: nothing is taken that differs. Where members are few or irregular, nothing is rolled up.

mod classes;
mod schedule;
mod simulate;
#[cfg(test)]
mod tests;

use super::instruction::{Instruction, Operation, Programs, Value};
use super::shape::{Indices, Shape};
use crate::algebra::{Graph, Multivariate, SymbolId};

/// An array that a function takes, by its letter, and an index of it.
pub type ArrayIndex = (char, usize);

/// The places of values in the arrays that a function takes.
pub trait Arrays {
    /// The place of a symbol.
    fn symbol(&self, symbol: SymbolId) -> Option<ArrayIndex>;
}

/// Code with loops.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Rolled {
    /// The lengths of the arrays of intermediate values.
    pub arrays: Vec<usize>,
    /// The steps in order.
    pub steps: Vec<RolledStep>,
}

/// A step of code with loops.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum RolledStep {
    /// One instruction.
    Once(Instruction),
    /// A value becomes an element of an array.
    Store {
        /// The array.
        array: usize,
        /// The element.
        at: usize,
        /// The value.
        value: Value,
    },
    /// A value is read out of an array under its own name.
    Load {
        /// The array.
        array: usize,
        /// The element.
        at: usize,
        /// The value.
        value: Value,
    },
    /// Lines for each turn.
    Loop(Loop),
}

/// A loop.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Loop {
    /// The least turn.
    pub from: i64,
    /// One more than the largest turn.
    pub to: i64,
    /// Whether turns go downwards.
    pub descends: bool,
    /// The lines of a turn.
    pub lines: Vec<Line>,
}

/// A line of a loop.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Line {
    /// The operation in the turn [`Loop::from`]; in other turns it has other operands.
    pub operation: Operation,
    /// The operands.
    pub operands: Vec<Operand>,
    /// The arrays whose elements `turn + offset` take the result, and the second result.
    pub stores: [Option<(usize, i64)>; 2],
    /// The elements of the results of the function that are these.
    pub outputs: [Option<Places>; 2],
}

/// Elements of an array at equal distances, one for each turn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Places {
    /// The element in the turn 0, which need not be one of the loop.
    pub origin: i64,
    /// The distance to the element of the next turn.
    pub stride: i64,
}

impl Places {
    /// The element of a turn.
    #[must_use]
    pub fn at(self, turn: i64) -> i64 {
        self.origin + self.stride * turn
    }
}

/// An operand of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Operand {
    /// A value from outside, the same in every turn.
    Outside(Value),
    /// An element `first + stride*(turn - from)` of an array that the function takes.
    Given {
        /// The array.
        array: char,
        /// The element in the first turn.
        first: usize,
        /// The distance to the element of the next turn.
        stride: i64,
    },
    /// The result of a line before in this turn, or its second one.
    Line(usize, bool),
    /// The element `turn + offset` of an array of intermediate values.
    Element(usize, i64),
}

/// The fewest turns of a loop.
pub(super) const FEWEST_TURNS: i64 = 12;

/// The most steps and lines of code with loops: each `let` opens a scope in the one before.
const MOST_STEPS: usize = 3_000;

/// The most operations in all loops of a function.
const MOST_CLASSES: usize = 100;

/// The code with loops; `None` where it would hardly be shorter. `prepared` has the shapes of prepared values.
pub(super) fn roll(
    code: (&[Instruction], &[Value], usize),
    (graph, arrays): (&Graph, &dyn Arrays),
    prepared: &[Shape],
) -> Option<Rolled> {
    /// The depths of shapes that are looked at, the nearest first: deeper ones tell more classes apart, and leave more members out.
    const DEPTHS: [usize; 3] = [5, 8, 12];
    // One evaluation of a function that the program supplies gives several values.
    let is_supplied =
        |operation: &Operation| matches!(operation, Operation::Apply(Multivariate::Supplied { .. }, _));
    if code.0.iter().any(|instruction| is_supplied(&instruction.operation)) {
        return None;
    }
    let indices = Indices::new(graph);
    /// Code of which so small a part is left is short.
    const SHORT: usize = 6;
    let least = (code.0.len() / 3).min(MOST_STEPS);
    let mut best: Option<(usize, Rolled)> = None;
    for depth in DEPTHS {
        let found = classes::find(code, (&indices, arrays), prepared, depth);
        // Operations for each pair of members fit into no loop, and to search for one takes minutes.
        if found.classes.iter().filter(|class| !class.places.is_empty()).count() > MOST_CLASSES {
            continue;
        }
        let Some(rolled) = schedule::scheduled(code, found) else { continue };
        let size = rolled.size();
        if size <= least
            && best.as_ref().is_none_or(|best| size < best.0)
            && simulate::is_equal(code, &rolled, arrays)
        {
            best = Some((size, rolled));
            // Other classes would hardly make it shorter.
            if SHORT * size <= code.0.len() {
                break;
            }
        }
    }
    best.map(|(_, rolled)| rolled)
}

impl Programs {
    /// The code of `prepare` and of every function with loops, where it has some: see [`Rolled`].
    #[must_use]
    pub fn rolled(&self, graph: &Graph, arrays: &dyn Arrays) -> (Option<Rolled>, Vec<Option<Rolled>>) {
        /// The depth of the shapes of prepared values.
        const PREPARED_DEPTH: usize = 8;
        let indices = Indices::new(graph);
        let leaf = |operation: &Operation| match operation {
            Operation::Symbol(symbol) => indices.of(*symbol),
            Operation::Number(value) => Shape::of_kind(value.hash64() | 1),
            _ => Shape::of_kind(5),
        };
        let of_prepare = shapes(&self.prepare, self.prepare_values, &leaf, PREPARED_DEPTH);
        let prepared: Vec<Shape> = self.prepared.iter().map(|value| of_prepare[value.index()]).collect();
        let prepare = roll((&self.prepare, &self.prepared, self.prepare_values), (graph, arrays), &[]);
        let functions = self.functions.iter().map(|function| {
            let code = (&function.instructions[..], &function.outputs[..], function.values);
            roll(code, (graph, arrays), &prepared)
        });
        (prepare, functions.collect())
    }
}

impl Rolled {
    /// The number of steps and lines.
    fn size(&self) -> usize {
        let lines = self.steps.iter().map(|step| match step {
            RolledStep::Loop(turns) => turns.lines.len(),
            _ => 1,
        });
        lines.sum()
    }
}

/// The shapes of all values of some code.
pub(super) fn shapes(
    instructions: &[Instruction],
    values: usize,
    leaf: &dyn Fn(&Operation) -> Shape,
    depth: usize,
) -> Vec<Shape> {
    let mut shapes = vec![Shape::default(); values];
    for round in 0..=depth {
        let before = shapes.clone();
        for Instruction { result, operation } in instructions {
            let kind = kind(operation);
            let mut parts: [Shape; 2] = Default::default();
            let mut count = 0;
            for operand in operation.operands().take(2) {
                parts[count] = before[operand.index()];
                count += 1;
            }
            let shape = match operation {
                Operation::Number(_) | Operation::Pi | Operation::Symbol(_) | Operation::Prepared(_) => {
                    leaf(operation)
                }
                _ if round == 0 => Shape::of_kind(kind),
                Operation::Add(..) | Operation::Mul(..) => Shape::joined(kind, &mut parts[..count]),
                Operation::Apply(_, arguments) => {
                    let parts: Vec<Shape> = arguments.iter().map(|v| before[v.index()]).collect();
                    Shape::ordered(kind, &parts)
                }
                _ => Shape::ordered(kind, &parts[..count]),
            };
            shapes[result.index()] = shape;
            if let Operation::SinCos { cosine, .. } = operation {
                shapes[cosine.index()] = shape.raised(7);
            }
        }
    }
    shapes
}

/// A number for the kind of an operation.
fn kind(operation: &Operation) -> u64 {
    match operation {
        Operation::Number(_) | Operation::Pi | Operation::Symbol(_) | Operation::Prepared(_) => 0,
        Operation::Add(..) => 1,
        Operation::Sub(..) => 2,
        Operation::Neg(_) => 3,
        Operation::Mul(..) => 4,
        Operation::Div(..) => 5,
        Operation::SinCos { .. } => 6,
        Operation::Call(function, _) => 16 + function.code(),
        Operation::Apply(function, _) => 1 << 20 | function.code(),
    }
}
