//! Straight-line code: one operation per instruction, every value defined once and before its use.

use super::OperationCount;
use crate::algebra::{Function, Key, Multivariate, Rational, SymbolId, mix, spread};

/// A value of one program, numbered from 0 in the order of definition.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Value(pub(crate) u32);

impl Value {
    /// The value of a number.
    pub fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// The number of the value.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The operation of an instruction.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Operation {
    /// An exact number.
    Number(Rational),
    /// The number pi.
    Pi,
    /// The value of a symbol: time, coordinate, velocity, input, or a physical constant as it was given.
    Symbol(SymbolId),
    /// A value that *prepare* stored, by its index in [`Programs::prepared`].
    Prepared(usize),
    /// `a + b`.
    Add(Value, Value),
    /// `a - b`.
    Sub(Value, Value),
    /// `-a`.
    Neg(Value),
    /// `a * b`.
    Mul(Value, Value),
    /// `a / b`.
    Div(Value, Value),
    /// Sine and cosine of one angle: the result is the sine.
    SinCos {
        /// The angle.
        angle: Value,
        /// The second value that this instruction defines.
        cosine: Value,
    },
    /// An elementary function, roots (of an order above one) included.
    Call(Function, Value),
    /// A function of several arguments.
    Apply(Multivariate, Box<[Value]>),
}

impl Operation {
    /// The values that are read.
    pub fn operands(&self) -> impl Iterator<Item = Value> {
        let (a, b) = match *self {
            Operation::Number(_) | Operation::Pi | Operation::Symbol(_) | Operation::Prepared(_) => {
                (None, None)
            }
            Operation::Neg(a) | Operation::Call(_, a) | Operation::SinCos { angle: a, .. } => (Some(a), None),
            Operation::Add(a, b) | Operation::Sub(a, b) | Operation::Mul(a, b) | Operation::Div(a, b) => {
                (Some(a), Some(b))
            }
            Operation::Apply(..) => (None, None),
        };
        let several: &[Value] = if let Operation::Apply(_, arguments) = self { arguments } else { &[] };
        a.into_iter().chain(b).chain(several.iter().copied())
    }
}

impl Operation {
    /// The values that are read, to be changed.
    pub(super) fn operands_mut(&mut self) -> impl Iterator<Item = &mut Value> {
        let cosine = self.cosine();
        self.values_mut().filter(move |value| Some(**value) != cosine)
    }

    /// The operation over other values.
    pub(super) fn renamed(&self, of: &dyn Fn(&Value) -> Value) -> Self {
        let mut renamed = self.clone();
        renamed.values_mut().for_each(|value| *value = of(value));
        renamed
    }

    /// The second value that is defined.
    pub(super) fn cosine(&self) -> Option<Value> {
        match *self {
            Operation::SinCos { cosine, .. } => Some(cosine),
            _ => None,
        }
    }

    /// The values that are read, and the second one that is defined.
    pub(super) fn values_mut(&mut self) -> impl Iterator<Item = &mut Value> {
        let mut several: &mut [Value] = &mut [];
        let (a, b) = match self {
            Operation::Number(_) | Operation::Pi | Operation::Symbol(_) | Operation::Prepared(_) => {
                (None, None)
            }
            Operation::Neg(a) | Operation::Call(_, a) => (Some(a), None),
            Operation::Add(a, b)
            | Operation::Sub(a, b)
            | Operation::Mul(a, b)
            | Operation::Div(a, b)
            | Operation::SinCos { angle: a, cosine: b } => (Some(a), Some(b)),
            Operation::Apply(_, arguments) => {
                several = arguments;
                (None, None)
            }
        };
        a.into_iter().chain(b).chain(several)
    }
}

impl Key for Value {
    fn hash(&self) -> u32 {
        spread(self.0 as u64)
    }
}

impl Key for Operation {
    fn hash(&self) -> u32 {
        let pair = |a: u32, b: u32| (a as u64) << 32 | b as u64;
        let (kind, content) = match self {
            Operation::Number(value) => (1, value.hash64()),
            Operation::Pi => (2, 0),
            Operation::Symbol(symbol) => (3, symbol.0 as u64),
            Operation::Prepared(index) => (4, *index as u64),
            Operation::Add(a, b) => (5, pair(a.0, b.0)),
            Operation::Sub(a, b) => (6, pair(a.0, b.0)),
            Operation::Neg(a) => (7, a.0 as u64),
            Operation::Mul(a, b) => (8, pair(a.0, b.0)),
            Operation::Div(a, b) => (9, pair(a.0, b.0)),
            Operation::SinCos { angle, cosine } => (10, pair(angle.0, cosine.0)),
            Operation::Call(function, a) => (11, mix(function.code() << 32 ^ a.0 as u64)),
            Operation::Apply(function, arguments) => (
                12,
                arguments.iter().fold(function.code(), |hash, v| mix(hash << 32 ^ hash >> 32 ^ v.0 as u64)),
            ),
        };
        spread(mix(content ^ kind << 60))
    }
}

/// An instruction: `result = operation`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Instruction {
    /// The value defined.
    pub result: Value,
    /// The operation.
    pub operation: Operation,
}

impl Instruction {
    /// The values that the instruction defines.
    pub fn defined(&self) -> impl Iterator<Item = Value> + use<> {
        std::iter::once(self.result).chain(self.operation.cosine())
    }
}

/// A function of the state over the prepared values.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FunctionProgram {
    /// The name given to [`ProgramBuilder::add_function`](super::ProgramBuilder::add_function).
    pub name: String,
    /// The code, loads first used last: every instruction directly before it is needed.
    pub instructions: Vec<Instruction>,
    /// The results, in the order given.
    pub outputs: Vec<Value>,
    /// The number of values that the instructions define.
    pub values: usize,
    /// The operations per call.
    pub cost: OperationCount,
}

/// The functions of a system and what they share.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Programs {
    /// The code that runs once per set of physical constants.
    pub prepare: Vec<Instruction>,
    /// The values of `prepare` that are stored, each used by some function.
    pub prepared: Vec<Value>,
    /// The number of values that `prepare` defines.
    pub prepare_values: usize,
    /// The operations of `prepare`.
    pub prepare_cost: OperationCount,
    /// The functions, in the order in which they were added.
    pub functions: Vec<FunctionProgram>,
}

impl OperationCount {
    /// The count of some code; numbers and loads are free.
    pub fn of(instructions: &[Instruction]) -> Self {
        let mut count = OperationCount::default();
        // One evaluation of a function that the program supplies gives its derivatives, too.
        let mut evaluated: Vec<(u16, &[Value])> = Vec::new();
        for instruction in instructions {
            match &instruction.operation {
                Operation::Number(_) | Operation::Pi | Operation::Symbol(_) | Operation::Prepared(_) => {}
                Operation::Add(..) | Operation::Sub(..) => count.additions += 1,
                Operation::Mul(..) => count.multiplications += 1,
                Operation::Div(..) => count.divisions += 1,
                Operation::Neg(_) => count.negations += 1,
                Operation::SinCos { .. } | Operation::Call(Function::Sin | Function::Cos, _) => {
                    count.sines += 1
                }
                Operation::Call(Function::Root(_), _) => count.roots += 1,
                Operation::Apply(Multivariate::Supplied { function, .. }, arguments) => {
                    if !evaluated.contains(&(*function, arguments)) {
                        evaluated.push((*function, arguments));
                        count.calls += 1;
                    }
                }
                Operation::Call(..) | Operation::Apply(..) => count.calls += 1,
            }
        }
        count
    }
}
