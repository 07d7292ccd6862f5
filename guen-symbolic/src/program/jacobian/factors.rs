//! Products and sums of partial derivatives: signs and ones cost nothing, equal operations are one, and what depends
//! on constants alone becomes code of *prepare*.

use crate::algebra::{FastMap, Function, Rational};
use crate::program::instruction::{Instruction, Operation, Value};
use crate::program::stage::Stage;

/// A partial derivative that is not zero: a sign and a size.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Factor {
    pub(super) negative: bool,
    pub(super) size: Size,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Size {
    /// One.
    One,
    /// A value of the *prepare* stage.
    Constant(Value),
    /// A value of the function.
    Value(Value),
}

impl Factor {
    pub(super) const ONE: Factor = Factor { negative: false, size: Size::One };

    pub(super) fn negated(self) -> Factor {
        Factor { negative: !self.negative, ..self }
    }
}

/// Whether the operation is a load, and no work to prepare.
fn is_plain(operation: &Operation) -> bool {
    matches!(operation, Operation::Number(_) | Operation::Pi | Operation::Symbol(_))
}

/// The code of a function and of what it prepares, while it is written.
pub(super) struct Code {
    function: Stage,
    constants: Stage,
    /// The values of *prepare* that functions load, those known before first, and where each is.
    stored: Vec<Value>,
    places: FastMap<Value, usize>,
    /// Values of *prepare* that are loaded as they are: numbers, pi, physical constants.
    plain: FastMap<Value, Operation>,
}

impl Code {
    /// Code after what is prepared already.
    pub(super) fn new(prepare: &[Instruction], prepared: &[Value], values: usize) -> Self {
        let mut constants = Stage { values: values as u32, ..Stage::default() };
        let mut plain = FastMap::default();
        for Instruction { result, operation } in prepare {
            constants.numbering.insert(operation.clone(), *result);
            if is_plain(operation) {
                plain.insert(*result, operation.clone());
            }
        }
        constants.instructions = prepare.to_vec();
        Code {
            function: Stage::default(),
            constants,
            stored: prepared.to_vec(),
            places: prepared.iter().enumerate().map(|(place, value)| (*value, place)).collect(),
            plain,
        }
    }

    /// The instructions of the function.
    pub(super) fn instructions(&self) -> &[Instruction] {
        &self.function.instructions
    }

    /// The code of *prepare*, and the values of it that functions load.
    pub(super) fn into_constants(self) -> (Vec<Instruction>, Vec<Value>) {
        (self.constants.instructions, self.stored)
    }

    /// An operation of the function.
    pub(super) fn emit(&mut self, operation: Operation) -> Value {
        self.function.emit(operation)
    }

    /// Sine and cosine of a value, always together: one is the derivative of the other.
    pub(super) fn sine_cosine(&mut self, angle: Value) -> (Value, Value) {
        // Keys that no instruction has: those with both are written here alone.
        let sine_key = Operation::Call(Function::Sin, angle);
        let cosine_key = Operation::Call(Function::Cos, angle);
        let stage = &mut self.function;
        if let (Some(sine), Some(cosine)) = (stage.numbering.get(&sine_key), stage.numbering.get(&cosine_key))
        {
            return (*sine, *cosine);
        }
        let (sine, cosine) = (stage.fresh(), stage.fresh());
        stage.instructions.push(Instruction { result: sine, operation: Operation::SinCos { angle, cosine } });
        stage.numbering.insert(sine_key, sine);
        stage.numbering.insert(cosine_key, cosine);
        (sine, cosine)
    }

    /// A value that *prepare* stores, by its index, as a factor.
    pub(super) fn prepared(&self, index: usize) -> Size {
        Size::Constant(self.stored[index])
    }

    /// A constant of *prepare* that is loaded as it is: a number, pi, a physical constant.
    pub(super) fn constant(&mut self, operation: Operation) -> Size {
        if let Operation::Number(number) = &operation
            && number.is_one()
        {
            return Size::One;
        }
        Size::Constant(self.constant_value(operation))
    }

    fn constant_value(&mut self, operation: Operation) -> Value {
        let plain = is_plain(&operation).then(|| operation.clone());
        let value = self.constants.emit(operation);
        if let Some(plain) = plain {
            self.plain.insert(value, plain);
        }
        value
    }

    /// An exact number that is not zero.
    pub(super) fn number(&mut self, number: Rational) -> Factor {
        let negative = number.is_negative();
        let size = self.constant(Operation::Number(number.abs()));
        Factor { negative, size }
    }

    /// The factor as a value of the function.
    pub(super) fn loaded(&mut self, factor: Factor) -> Value {
        if factor.negative {
            return match factor.size {
                Size::One => self.emit(Operation::Number(Rational::integer(-1))),
                Size::Value(value) => self.emit(Operation::Neg(value)),
                Size::Constant(value) => match self.plain.get(&value) {
                    Some(Operation::Number(number)) => {
                        let number = number * &Rational::MINUS_ONE;
                        self.emit(Operation::Number(number))
                    }
                    _ => {
                        let negative = self.constants.emit(Operation::Neg(value));
                        self.load(negative)
                    }
                },
            };
        }
        match factor.size {
            Size::One => self.emit(Operation::Number(Rational::integer(1))),
            Size::Value(value) => value,
            Size::Constant(value) => self.load(value),
        }
    }

    /// A value of *prepare* in the function.
    fn load(&mut self, value: Value) -> Value {
        if let Some(plain) = self.plain.get(&value) {
            let plain = plain.clone();
            return self.emit(plain);
        }
        let next = self.stored.len();
        let place = *self.places.or_insert_with(value, || next);
        if place == next {
            self.stored.push(value);
        }
        self.emit(Operation::Prepared(place))
    }

    /// The product of two factors.
    pub(super) fn product(&mut self, a: Factor, b: Factor) -> Factor {
        let negative = a.negative != b.negative;
        let size = match (a.size, b.size) {
            (Size::One, size) | (size, Size::One) => size,
            (Size::Constant(a), Size::Constant(b)) => match (self.plain.get(&a), self.plain.get(&b)) {
                (Some(Operation::Number(x)), Some(Operation::Number(y))) => {
                    let product = x * y;
                    self.constant(Operation::Number(product))
                }
                _ => Size::Constant(self.constants.emit(Operation::Mul(a, b))),
            },
            (Size::Constant(k), Size::Value(value)) | (Size::Value(value), Size::Constant(k)) => {
                let k = self.load(k);
                Size::Value(self.emit(Operation::Mul(k, value)))
            }
            (Size::Value(a), Size::Value(b)) => Size::Value(self.emit(Operation::Mul(a, b))),
        };
        Factor { negative, size }
    }

    /// The reciprocal of a factor.
    pub(super) fn reciprocal(&mut self, a: Factor) -> Factor {
        let size = match a.size {
            Size::One => Size::One,
            Size::Constant(a) => {
                let one = self.constant_value(Operation::Number(Rational::integer(1)));
                Size::Constant(self.constants.emit(Operation::Div(one, a)))
            }
            Size::Value(a) => {
                let one = self.emit(Operation::Number(Rational::integer(1)));
                Size::Value(self.emit(Operation::Div(one, a)))
            }
        };
        Factor { size, ..a }
    }

    /// The sum of two factors; `None` where they cancel.
    pub(super) fn sum(&mut self, a: Factor, b: Factor) -> Option<Factor> {
        if a.size == b.size {
            if a.negative != b.negative {
                return None;
            }
            let two = self.number(Rational::integer(2));
            return Some(self.product(two, a));
        }
        if let (Some(x), Some(y)) = (self.as_number(a), self.as_number(b)) {
            let sum = &x + &y;
            return (!sum.is_zero()).then(|| self.number(sum));
        }
        let is_constant = |f: Factor| !matches!(f.size, Size::Value(_));
        let both_constant = is_constant(a) && is_constant(b);
        // The difference begins with what is positive; two that are negative are the negative of a sum.
        let (first, second) = if a.negative && !b.negative { (b, a) } else { (a, b) };
        let subtract = first.negative != second.negative;
        let size = if both_constant {
            let [x, y] = [first, second].map(|f| match f.size {
                Size::Constant(value) => value,
                _ => self.constant_value(Operation::Number(Rational::integer(1))),
            });
            let operation = if subtract { Operation::Sub(x, y) } else { Operation::Add(x, y) };
            Size::Constant(self.constants.emit(operation))
        } else {
            let [x, y] = [first, second].map(|f| self.loaded(Factor { negative: false, ..f }));
            let operation = if subtract { Operation::Sub(x, y) } else { Operation::Add(x, y) };
            Size::Value(self.emit(operation))
        };
        Some(Factor { negative: first.negative, size })
    }

    fn as_number(&self, f: Factor) -> Option<Rational> {
        let size = match f.size {
            Size::One => Rational::integer(1),
            Size::Constant(value) => match self.plain.get(&value)? {
                Operation::Number(number) => number.clone(),
                _ => return None,
            },
            Size::Value(_) => return None,
        };
        Some(if f.negative { &size * &Rational::MINUS_ONE } else { size })
    }
}
