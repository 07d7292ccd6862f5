//! Turns a program of rates into recurrences: finds the values that move, the products that are one, and the
//! functions that are carried along.

use std::collections::BTreeMap;

use super::super::{FunctionProgram, Instruction, Operation, Value};
use super::{NotAnalytic, SeriesProgram, SeriesStep, Start, SymbolInStep};
use crate::algebra::{Function, Multivariate, Rational, SymbolId};

/// The part of a step by which equal steps are found.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Time,
    State,
    Input,
    StillAdd,
    StillSub,
    StillNeg,
    StillMul,
    StillDiv,
    Add,
    Sub,
    Neg,
    Scale,
    Product,
    Quotient,
    SquareRoot,
    Derivative,
}

type KeyOf = (Kind, u32, u32);

/// A value with a still factor before it, and perhaps a sign.
struct Scaled {
    negative: bool,
    factor: Option<Value>,
    base: Value,
}

/// A function carried along, while its rate is not known yet.
struct Carried {
    start: Start,
    /// The argument.
    angle: Value,
    /// The function whose product with the argument's rate is the rate, and whether with a sign.
    partner: Value,
    negative: bool,
}

struct Builder {
    steps: Vec<SeriesStep>,
    known: BTreeMap<KeyOf, Value>,
    integrals: BTreeMap<Start, Value>,
    carried: Vec<Carried>,
    /// The number of variables of the state.
    states: usize,
    one: Option<Value>,
}

pub(super) fn build(
    program: &FunctionProgram,
    source: &dyn Fn(SymbolId) -> SymbolInStep,
) -> Result<SeriesProgram, NotAnalytic> {
    let mut builder = Builder {
        steps: Vec::new(),
        known: BTreeMap::new(),
        integrals: BTreeMap::new(),
        carried: Vec::new(),
        states: program.outputs.len(),
        one: None,
    };
    let mut moved: Vec<Option<Value>> = vec![None; program.values];
    for instruction in &program.instructions {
        // Operands are defined before their use.
        let at = |v: &Value| moved[v.index()].unwrap_or(Value(0));
        let value = match &instruction.operation {
            Operation::Symbol(symbol) => match source(*symbol) {
                SymbolInStep::Still => builder.push(SeriesStep::Still(instruction.operation.clone())),
                SymbolInStep::Time => builder.once((Kind::Time, 0, 0), SeriesStep::Time),
                SymbolInStep::Input(i) => builder.once((Kind::Input, i as u32, 0), SeriesStep::Input(i)),
                SymbolInStep::State(i) => builder.once((Kind::State, i as u32, 0), SeriesStep::Variable(i)),
            },
            Operation::Number(_) | Operation::Pi | Operation::Prepared(_) => {
                builder.push(SeriesStep::Still(instruction.operation.clone()))
            }
            Operation::Add(a, b) => builder.add(at(a), at(b)),
            Operation::Sub(a, b) => builder.sub(at(a), at(b)),
            Operation::Neg(a) => builder.neg(at(a)),
            Operation::Mul(a, b) => builder.mul(at(a), at(b)),
            Operation::Div(a, b) => builder.div(at(a), at(b)),
            Operation::SinCos { angle, cosine } => {
                let (sine, cosine_value) = builder.sine_cosine(at(angle));
                moved[cosine.index()] = Some(cosine_value);
                sine
            }
            Operation::Call(function, a) => {
                let a = at(a);
                builder.call(*function, a).ok_or_else(|| not_analytic(program, instruction))?
            }
            Operation::Apply(function, arguments) => {
                let arguments: Vec<Value> = arguments.iter().map(at).collect();
                if arguments.iter().all(|a| builder.is_still(*a)) {
                    builder.push(SeriesStep::Still(Operation::Apply(*function, arguments.into())))
                } else if *function == Multivariate::Atan2 {
                    builder.atan2(arguments[0], arguments[1])
                } else {
                    return Err(not_analytic(program, instruction));
                }
            }
        };
        moved[instruction.result.index()] = Some(value);
    }
    let rates: Vec<Value> = program.outputs.iter().map(|v| moved[v.index()].unwrap_or(Value(0))).collect();
    Ok(builder.finish(rates))
}

fn not_analytic(program: &FunctionProgram, call: &Instruction) -> NotAnalytic {
    NotAnalytic { operation: call.operation.clone(), output: first_output(program, call.result) }
}

/// The first output that a value leads to.
fn first_output(program: &FunctionProgram, value: Value) -> usize {
    let mut reached = vec![false; program.values];
    reached[value.index()] = true;
    for instruction in &program.instructions {
        if instruction.operation.operands().any(|operand| reached[operand.index()]) {
            reached[instruction.result.index()] = true;
            if let Operation::SinCos { cosine, .. } = instruction.operation {
                reached[cosine.index()] = true;
            }
        }
    }
    program.outputs.iter().position(|output| reached[output.index()]).unwrap_or(0)
}

impl Builder {
    fn push(&mut self, step: SeriesStep) -> Value {
        self.steps.push(step);
        Value(self.steps.len() as u32 - 1)
    }

    fn once(&mut self, key: KeyOf, step: SeriesStep) -> Value {
        if let Some(value) = self.known.get(&key) {
            return *value;
        }
        let value = self.push(step);
        self.known.insert(key, value);
        value
    }

    fn is_still(&self, value: Value) -> bool {
        matches!(self.steps[value.index()], SeriesStep::Still(_))
    }

    fn still(&mut self, kind: Kind, a: Value, b: Value, operation: Operation) -> Value {
        self.once((kind, a.0, b.0), SeriesStep::Still(operation))
    }

    fn number_one(&mut self) -> Value {
        match self.one {
            Some(one) => one,
            None => {
                let one = self.push(SeriesStep::Still(Operation::Number(Rational::integer(1))));
                self.one = Some(one);
                one
            }
        }
    }

    fn add(&mut self, a: Value, b: Value) -> Value {
        let (a, b) = if b < a { (b, a) } else { (a, b) };
        if self.is_still(a) && self.is_still(b) {
            return self.still(Kind::StillAdd, a, b, Operation::Add(a, b));
        }
        self.once((Kind::Add, a.0, b.0), SeriesStep::Add(a, b))
    }

    fn sub(&mut self, a: Value, b: Value) -> Value {
        if self.is_still(a) && self.is_still(b) {
            return self.still(Kind::StillSub, a, b, Operation::Sub(a, b));
        }
        self.once((Kind::Sub, a.0, b.0), SeriesStep::Sub(a, b))
    }

    fn neg(&mut self, a: Value) -> Value {
        match self.steps[a.index()] {
            SeriesStep::Still(_) => self.still(Kind::StillNeg, a, a, Operation::Neg(a)),
            SeriesStep::Neg(inner) => inner,
            _ => self.once((Kind::Neg, a.0, 0), SeriesStep::Neg(a)),
        }
    }

    /// `k a` with a still `k`.
    fn scale(&mut self, k: Value, a: Value) -> Value {
        match self.steps[a.index()] {
            SeriesStep::Scale(inner, base) => {
                let k = self.mul(k, inner);
                self.scale(k, base)
            }
            SeriesStep::Neg(inner) => {
                let k = self.neg(k);
                self.scale(k, inner)
            }
            _ => self.once((Kind::Scale, k.0, a.0), SeriesStep::Scale(k, a)),
        }
    }

    fn scaled(&self, value: Value) -> Scaled {
        match self.steps[value.index()] {
            SeriesStep::Neg(inner) => {
                let inner = self.scaled(inner);
                Scaled { negative: !inner.negative, ..inner }
            }
            // Scales do not nest, and have no sign inside.
            SeriesStep::Scale(k, base) => Scaled { negative: false, factor: Some(k), base },
            _ => Scaled { negative: false, factor: None, base: value },
        }
    }

    /// A product. Still factors and signs go before it, so that products of the same series are one.
    fn mul(&mut self, a: Value, b: Value) -> Value {
        match (self.is_still(a), self.is_still(b)) {
            (true, true) => {
                let (a, b) = if b < a { (b, a) } else { (a, b) };
                return self.still(Kind::StillMul, a, b, Operation::Mul(a, b));
            }
            (true, false) => return self.scale(a, b),
            (false, true) => return self.scale(b, a),
            (false, false) => {}
        }
        let (a, b) = (self.scaled(a), self.scaled(b));
        let (first, second) = if b.base < a.base { (b.base, a.base) } else { (a.base, b.base) };
        let product = self.once((Kind::Product, first.0, second.0), SeriesStep::Product(first, second, 0));
        let factor = match (a.factor, b.factor) {
            (Some(a), Some(b)) => Some(self.mul(a, b)),
            (one, other) => one.or(other),
        };
        let product = factor.map_or(product, |k| self.scale(k, product));
        if a.negative != b.negative { self.neg(product) } else { product }
    }

    fn div(&mut self, a: Value, b: Value) -> Value {
        if self.is_still(b) {
            if self.is_still(a) {
                return self.still(Kind::StillDiv, a, b, Operation::Div(a, b));
            }
            let one = self.number_one();
            let reciprocal = self.still(Kind::StillDiv, one, b, Operation::Div(one, b));
            return self.scale(reciprocal, a);
        }
        self.once((Kind::Quotient, a.0, b.0), SeriesStep::Quotient(a, b, 0))
    }

    fn square_root(&mut self, a: Value) -> Value {
        self.once((Kind::SquareRoot, a.0, 0), SeriesStep::SquareRoot(a, 0))
    }

    fn derivative(&mut self, a: Value) -> Value {
        self.once((Kind::Derivative, a.0, 0), SeriesStep::Derivative(a))
    }

    fn integral(&mut self, start: Start, rate: Value) -> Value {
        let value = self.push(SeriesStep::Integral(start, rate));
        self.integrals.insert(start, value);
        value
    }

    /// Whether a value is a linear combination of the state and time with still coefficients.
    fn is_linear(&self, value: Value) -> bool {
        let mut stack = vec![value];
        while let Some(value) = stack.pop() {
            match self.steps[value.index()] {
                SeriesStep::Still(_) | SeriesStep::Time => {}
                SeriesStep::Variable(i) if i < self.states => {}
                SeriesStep::Add(a, b) | SeriesStep::Sub(a, b) => stack.extend([a, b]),
                SeriesStep::Neg(a) | SeriesStep::Scale(_, a) => stack.push(a),
                _ => return false,
            }
        }
        true
    }

    /// The rate of a linear value; none where it is still.
    fn rate(&mut self, value: Value, rates: &[Value]) -> Option<Value> {
        match self.steps[value.index()] {
            SeriesStep::Time => Some(self.number_one()),
            SeriesStep::Variable(i) => Some(rates[i]),
            SeriesStep::Add(a, b) => match (self.rate(a, rates), self.rate(b, rates)) {
                (Some(a), Some(b)) => Some(self.add(a, b)),
                (one, other) => one.or(other),
            },
            SeriesStep::Sub(a, b) => match (self.rate(a, rates), self.rate(b, rates)) {
                (Some(a), Some(b)) => Some(self.sub(a, b)),
                (None, Some(b)) => Some(self.neg(b)),
                (one, None) => one,
            },
            SeriesStep::Neg(a) => self.rate(a, rates).map(|a| self.neg(a)),
            SeriesStep::Scale(k, a) => self.rate(a, rates).map(|a| self.mul(k, a)),
            _ => None,
        }
    }

    /// Two functions of one argument of which each is the other's derivative, one perhaps with a sign.
    fn couple(&mut self, [f, g]: [Function; 2], angle: Value, negative: bool) -> (Value, Value) {
        let (first, second) = (Start::Call(f, angle), Start::Call(g, angle));
        if let (Some(first), Some(second)) = (self.integrals.get(&first), self.integrals.get(&second)) {
            return (*first, *second);
        }
        let next = Value(self.steps.len() as u32);
        if self.is_linear(angle) {
            let place = self.states + self.carried.len();
            let (a, b) = (next, Value(next.0 + 1));
            self.push(SeriesStep::Variable(place));
            self.push(SeriesStep::Variable(place + 1));
            self.carried.push(Carried { start: first, angle, partner: b, negative: false });
            self.carried.push(Carried { start: second, angle, partner: a, negative });
            self.integrals.extend([(first, a), (second, b)]);
            return (a, b);
        }
        // f* = g a*, g* = +- f a*
        let rate = self.derivative(angle);
        let next = self.steps.len() as u32;
        let (a, b) = (Value(next + 2), Value(next + if negative { 4 } else { 3 }));
        let along_b = self.push(SeriesStep::Along(rate, b, 0));
        let along_a = self.push(SeriesStep::Along(rate, a, 0));
        self.integral(first, along_b);
        let along_a = if negative { self.push(SeriesStep::Neg(along_a)) } else { along_a };
        self.integral(second, along_a);
        (a, b)
    }

    fn sine_cosine(&mut self, angle: Value) -> (Value, Value) {
        if self.is_still(angle) {
            let sine = self.push(SeriesStep::Still(Operation::Call(Function::Sin, angle)));
            let cosine = self.push(SeriesStep::Still(Operation::Call(Function::Cos, angle)));
            return (sine, cosine);
        }
        self.couple([Function::Sin, Function::Cos], angle, true)
    }

    fn call(&mut self, function: Function, a: Value) -> Option<Value> {
        if self.is_still(a) {
            return Some(self.push(SeriesStep::Still(Operation::Call(function, a))));
        }
        let start = Start::Call(function, a);
        if let Some(value) = self.integrals.get(&start) {
            return Some(*value);
        }
        Some(match function {
            Function::Abs | Function::Sign | Function::Floor => return None,
            Function::Sin => self.sine_cosine(a).0,
            Function::Cos => self.sine_cosine(a).1,
            Function::Sinh => self.couple([Function::Sinh, Function::Cosh], a, false).0,
            Function::Cosh => self.couple([Function::Sinh, Function::Cosh], a, false).1,
            Function::Exp if self.is_linear(a) => {
                let place = self.states + self.carried.len();
                let value = self.push(SeriesStep::Variable(place));
                self.carried.push(Carried { start, angle: a, partner: value, negative: false });
                self.integrals.insert(start, value);
                value
            }
            Function::Exp => {
                let rate = self.derivative(a);
                let itself = Value(self.steps.len() as u32 + 1);
                let along = self.push(SeriesStep::Along(rate, itself, 0));
                self.integral(start, along)
            }
            Function::Ln => {
                let rate = self.derivative(a);
                let quotient = self.div(rate, a);
                self.integral(start, quotient)
            }
            Function::Atan => {
                let square = self.mul(a, a);
                let one = self.number_one();
                let denominator = self.add(one, square);
                let rate = self.derivative(a);
                let quotient = self.div(rate, denominator);
                self.integral(start, quotient)
            }
            Function::Asin | Function::Acos => {
                let square = self.mul(a, a);
                let one = self.number_one();
                let cosine = self.sub(one, square);
                let cosine = self.square_root(cosine);
                let rate = self.derivative(a);
                let quotient = self.div(rate, cosine);
                let rate = if function == Function::Acos { self.neg(quotient) } else { quotient };
                self.integral(start, rate)
            }
            // y* = (1 - y^2) a*
            Function::Tanh => {
                let (one, rate) = (self.number_one(), self.derivative(a));
                let next = self.steps.len() as u32;
                let along = self.push(SeriesStep::Along(rate, Value(next + 3), 0));
                let value = self.integral(start, along);
                let square = self.push(SeriesStep::Product(value, value, 0));
                self.push(SeriesStep::Sub(one, square));
                value
            }
            Function::Root(2) => self.square_root(a),
            // y* = y a* / (q a)
            Function::Root(q) => {
                let number = Operation::Number(Rational::integer(i64::from(q)));
                let (one, order) = (self.number_one(), self.push(SeriesStep::Still(number)));
                let part = self.push(SeriesStep::Still(Operation::Div(one, order)));
                let rate = self.derivative(a);
                let next = self.steps.len() as u32;
                let along = self.push(SeriesStep::Along(rate, Value(next + 3), 0));
                let quotient = self.push(SeriesStep::Quotient(along, a, 0));
                let rate = self.push(SeriesStep::Scale(part, quotient));
                self.integral(start, rate)
            }
        })
    }

    /// `z* = (x y* - y x*) / (x^2 + y^2)`
    fn atan2(&mut self, y: Value, x: Value) -> Value {
        let squares = (self.mul(x, x), self.mul(y, y));
        let denominator = self.add(squares.0, squares.1);
        let part = |builder: &mut Self, moving: Value, other: Value| {
            (!builder.is_still(moving)).then(|| {
                let rate = builder.derivative(moving);
                builder.mul(rate, other)
            })
        };
        let rate = match (part(self, y, x), part(self, x, y)) {
            (Some(first), Some(second)) => self.sub(first, second),
            (Some(first), None) => first,
            (None, Some(second)) => self.neg(second),
            (None, None) => self.number_one(),
        };
        let quotient = self.div(rate, denominator);
        self.integral(Start::Atan2(y, x), quotient)
    }

    /// Adds the rates of what is carried along, drops what nothing needs, and numbers the sums.
    fn finish(mut self, mut rates: Vec<Value>) -> SeriesProgram {
        let states = rates.clone();
        for place in 0..self.carried.len() {
            let Carried { angle, partner, negative, .. } = self.carried[place];
            let rate = match self.rate(angle, &states) {
                Some(rate) => self.mul(rate, partner),
                // An angle that is linear and not still has a rate.
                None => self.number_one(),
            };
            rates.push(if negative { self.neg(rate) } else { rate });
        }
        self.trimmed(&rates)
    }

    fn trimmed(self, rates: &[Value]) -> SeriesProgram {
        let Self { steps, carried, states, .. } = self;
        let mut live = vec![false; steps.len()];
        let mut stack: Vec<Value> = rates[..states].to_vec();
        while let Some(value) = stack.pop() {
            if std::mem::replace(&mut live[value.index()], true) {
                continue;
            }
            let step = &steps[value.index()];
            stack.extend(step.operands());
            if let SeriesStep::Variable(i) = step
                && let Some(place) = i.checked_sub(states)
            {
                stack.push(rates[*i]);
                stack.extend(carried[place].start.operands());
            }
        }
        // New places, in order; of the carried functions only those in use.
        let mut places = vec![Value(0); steps.len()];
        for (new, old) in (0..steps.len()).filter(|i| live[*i]).enumerate() {
            places[old] = Value(new as u32);
        }
        let at = |v: &Value| places[v.index()];
        let used: Vec<usize> = (0..carried.len())
            .filter(|place| {
                steps
                    .iter()
                    .enumerate()
                    .any(|(i, step)| live[i] && *step == SeriesStep::Variable(states + place))
            })
            .collect();
        let moved_start = |start: &Start| match start {
            Start::Call(function, a) => Start::Call(*function, at(a)),
            Start::Atan2(y, x) => Start::Atan2(at(y), at(x)),
        };
        let mut sums: Vec<[Value; 2]> = Vec::new();
        let mut sum = |a: Value, b: Value| {
            sums.push([a, b]);
            sums.len() - 1
        };
        let mut kept = Vec::new();
        for (old, step) in steps.iter().enumerate().filter(|(i, _)| live[*i]) {
            kept.push(match step {
                SeriesStep::Still(operation) => SeriesStep::Still(operation.renamed(&at)),
                SeriesStep::Time => SeriesStep::Time,
                SeriesStep::Input(i) => SeriesStep::Input(*i),
                SeriesStep::Variable(i) => SeriesStep::Variable(match i.checked_sub(states) {
                    None => *i,
                    Some(place) => states + used.iter().position(|known| *known == place).unwrap_or_default(),
                }),
                SeriesStep::Add(a, b) => SeriesStep::Add(at(a), at(b)),
                SeriesStep::Sub(a, b) => SeriesStep::Sub(at(a), at(b)),
                SeriesStep::Neg(a) => SeriesStep::Neg(at(a)),
                SeriesStep::Scale(k, a) => SeriesStep::Scale(at(k), at(a)),
                SeriesStep::Product(a, b, _) => SeriesStep::Product(at(a), at(b), sum(at(a), at(b))),
                SeriesStep::Along(a, b, _) => SeriesStep::Along(at(a), at(b), sum(at(a), at(b))),
                SeriesStep::Quotient(a, b, _) => {
                    SeriesStep::Quotient(at(a), at(b), sum(at(&Value(old as u32)), at(b)))
                }
                SeriesStep::SquareRoot(a, _) => {
                    let itself = at(&Value(old as u32));
                    SeriesStep::SquareRoot(at(a), sum(itself, itself))
                }
                SeriesStep::Derivative(a) => SeriesStep::Derivative(at(a)),
                SeriesStep::Integral(start, rate) => SeriesStep::Integral(moved_start(start), at(rate)),
            });
        }
        let rates = rates[..states].iter().chain(used.iter().map(|place| &rates[states + place]));
        SeriesProgram {
            rates: rates.map(at).collect(),
            carried: used.iter().map(|place| moved_start(&carried[*place].start)).collect(),
            steps: kept,
            sums,
        }
    }
}
