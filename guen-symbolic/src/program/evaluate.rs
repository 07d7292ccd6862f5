//! Running programs directly, over any numbers: the reference that emitted code is tested against.

use f256::f256;

use super::{Instruction, Operation, Programs, Value};
use crate::algebra::{Function, Multivariate, Rational, SymbolId};
use crate::zero::{Real, apply};

/// Numbers that programs can be run over.
pub trait Arithmetic: Clone {
    /// The nearest number.
    fn from_rational(value: &Rational) -> Self;
    /// The number pi.
    fn pi() -> Self;
    /// `a + b`.
    fn add(&self, other: &Self) -> Self;
    /// `a - b`.
    fn sub(&self, other: &Self) -> Self;
    /// `-a`.
    fn neg(&self) -> Self;
    /// `a * b`.
    fn mul(&self, other: &Self) -> Self;
    /// `a / b`.
    fn div(&self, other: &Self) -> Self;
    /// An elementary function.
    fn call(function: Function, x: &Self) -> Self;
    /// A function of several arguments.
    fn apply(function: Multivariate, arguments: &[Self]) -> Self;
}

impl Arithmetic for f64 {
    fn from_rational(value: &Rational) -> Self {
        value.to_f64()
    }
    fn pi() -> Self {
        std::f64::consts::PI
    }
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    fn neg(&self) -> Self {
        -self
    }
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
    fn div(&self, other: &Self) -> Self {
        self / other
    }
    fn call(function: Function, x: &Self) -> Self {
        let x = *x;
        match function {
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Asin => x.asin(),
            Function::Acos => x.acos(),
            Function::Atan => x.atan(),
            Function::Exp => x.exp(),
            Function::Ln => x.ln(),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Abs => x.abs(),
            Function::Sign if x == 0.0 => 0.0,
            Function::Sign => x.signum(),
            Function::Floor => x.floor(),
            Function::Root(2) => x.sqrt(),
            Function::Root(q) if q % 2 == 1 => x.signum() * x.abs().powf(1.0 / f64::from(q)),
            Function::Root(q) => x.powf(1.0 / f64::from(q)),
        }
    }
    fn apply(function: Multivariate, arguments: &[Self]) -> Self {
        apply(function, arguments)
    }
}

impl Arithmetic for f256 {
    fn from_rational(value: &Rational) -> Self {
        Real::rational(value)
    }
    fn pi() -> Self {
        Real::pi()
    }
    fn add(&self, other: &Self) -> Self {
        *self + *other
    }
    fn sub(&self, other: &Self) -> Self {
        *self - *other
    }
    fn neg(&self) -> Self {
        -*self
    }
    fn mul(&self, other: &Self) -> Self {
        *self * *other
    }
    fn div(&self, other: &Self) -> Self {
        *self / *other
    }
    fn call(function: Function, x: &Self) -> Self {
        x.of(function)
    }
    fn apply(function: Multivariate, arguments: &[Self]) -> Self {
        apply(function, arguments)
    }
}

/// The prepared values for given constants.
pub fn evaluate_prepare<R: Arithmetic>(programs: &Programs, symbols: impl Fn(SymbolId) -> R) -> Vec<R> {
    run(&programs.prepare, programs.prepare_values, &programs.prepared, &[], symbols)
}

/// The outputs of a function, by its index, in a given state.
pub fn evaluate_function<R: Arithmetic>(
    programs: &Programs,
    function: usize,
    prepared: &[R],
    symbols: impl Fn(SymbolId) -> R,
) -> Vec<R> {
    let function = &programs.functions[function];
    run(&function.instructions, function.values, &function.outputs, prepared, symbols)
}

pub(super) fn run<R: Arithmetic>(
    instructions: &[Instruction],
    count: usize,
    outputs: &[Value],
    prepared: &[R],
    symbols: impl Fn(SymbolId) -> R,
) -> Vec<R> {
    // Values are defined before their use.
    let mut all = vec![R::from_rational(&Rational::ZERO); count];
    let values: &mut [R] = &mut all;
    for instruction in instructions {
        let at = |v: &Value| &values[v.0 as usize];
        let mut second = None;
        let result = match &instruction.operation {
            Operation::Number(value) => R::from_rational(value),
            Operation::Pi => R::pi(),
            Operation::Symbol(symbol) => symbols(*symbol),
            Operation::Prepared(k) => prepared[*k].clone(),
            Operation::Add(a, b) => at(a).add(at(b)),
            Operation::Sub(a, b) => at(a).sub(at(b)),
            Operation::Neg(a) => at(a).neg(),
            Operation::Mul(a, b) => at(a).mul(at(b)),
            Operation::Div(a, b) => at(a).div(at(b)),
            Operation::SinCos { angle, cosine } => {
                let angle = at(angle);
                second = Some((cosine, R::call(Function::Cos, angle)));
                R::call(Function::Sin, angle)
            }
            Operation::Call(function, x) => R::call(*function, at(x)),
            Operation::Apply(function, arguments) => {
                let arguments: Vec<R> = arguments.iter().map(|v| at(v).clone()).collect();
                R::apply(*function, &arguments)
            }
        };
        values[instruction.result.0 as usize] = result;
        if let Some((value, result)) = second {
            values[value.0 as usize] = result;
        }
    }
    outputs.iter().map(|v| values[v.0 as usize].clone()).collect()
}
