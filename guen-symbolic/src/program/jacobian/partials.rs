//! The linearised computational graph of a function: an edge for every partial derivative of an instruction.

use super::eliminate::LinearGraph;
use super::factors::{Code, Factor, Size};
use crate::algebra::{Function, Multivariate, Rational, SymbolId};
use crate::program::instruction::{FunctionProgram, Operation, Value};

/// The place of a value of the function in the new code, and the vertex that carries its differential.
#[derive(Clone, Copy)]
struct Slot {
    size: Size,
    negative: bool,
    vertex: Option<usize>,
}

/// Writes the function's own code, and the graph of its partial derivatives: variables are its first vertices.
pub(super) fn graph(
    code: &mut Code,
    function: &FunctionProgram,
    variables: &[SymbolId],
    is_constant: &impl Fn(SymbolId) -> bool,
) -> LinearGraph {
    let mut builder = Builder {
        code,
        graph: LinearGraph::new(variables.len()),
        places: vec![Slot { size: Size::One, negative: false, vertex: None }; function.values],
    };
    for instruction in &function.instructions {
        builder.instruction(instruction.result, &instruction.operation, variables, is_constant);
    }
    let outputs = function.outputs.iter().map(|v| builder.places[v.index()].vertex).collect::<Vec<_>>();
    builder.graph.set_outputs(outputs);
    builder.graph
}

struct Builder<'a> {
    code: &'a mut Code,
    graph: LinearGraph,
    places: Vec<Slot>,
}

impl Builder<'_> {
    fn factor(&self, value: Value) -> Factor {
        let Slot { size, negative, .. } = self.places[value.index()];
        Factor { negative, size }
    }

    fn load(&mut self, value: Value) -> Value {
        let factor = self.factor(value);
        self.code.loaded(factor)
    }

    /// Records a value with its partial derivatives by operands; it gets a vertex if one of them has one.
    fn define(&mut self, result: Value, size: Size, partials: &[(Value, Factor)]) {
        let edges: Vec<(usize, Factor)> = partials
            .iter()
            .filter_map(|(operand, factor)| Some((self.places[operand.index()].vertex?, *factor)))
            .collect();
        let vertex = (!edges.is_empty()).then(|| self.graph.vertex(self.code, &edges));
        self.places[result.index()] = Slot { size, negative: false, vertex };
    }

    fn is_active(&self, value: Value) -> bool {
        self.places[value.index()].vertex.is_some()
    }

    fn instruction(
        &mut self,
        result: Value,
        operation: &Operation,
        variables: &[SymbolId],
        is_constant: &impl Fn(SymbolId) -> bool,
    ) {
        match operation {
            Operation::Number(number) if number.is_zero() => {
                let size = Size::Value(self.code.emit(operation.clone()));
                self.define(result, size, &[]);
            }
            Operation::Number(number) => {
                let factor = self.code.number(number.clone());
                self.places[result.index()] =
                    Slot { size: factor.size, negative: factor.negative, vertex: None };
            }
            Operation::Pi => {
                let size = self.code.constant(Operation::Pi);
                self.define(result, size, &[]);
            }
            Operation::Prepared(index) => {
                let size = self.code.prepared(*index);
                self.define(result, size, &[]);
            }
            Operation::Symbol(symbol) if is_constant(*symbol) => {
                let size = self.code.constant(Operation::Symbol(*symbol));
                self.define(result, size, &[]);
            }
            Operation::Symbol(symbol) => {
                let size = Size::Value(self.code.emit(operation.clone()));
                let vertex = variables.iter().position(|variable| variable == symbol);
                self.places[result.index()] = Slot { size, negative: false, vertex };
            }
            Operation::SinCos { angle, cosine } => {
                let (s, c) = self.sine_cosine(*angle);
                self.define(result, s.size, &[(*angle, c)]);
                self.define(*cosine, c.size, &[(*angle, s.negated())]);
            }
            Operation::Call(function @ (Function::Sin | Function::Cos), angle) => {
                let (s, c) = self.sine_cosine(*angle);
                let (value, slope) = if *function == Function::Sin { (s, c) } else { (c, s.negated()) };
                self.define(result, value.size, &[(*angle, slope)]);
            }
            other => self.arithmetic(result, other),
        }
    }

    fn sine_cosine(&mut self, angle: Value) -> (Factor, Factor) {
        let x = self.load(angle);
        let (sine, cosine) = self.code.sine_cosine(x);
        let factor = |value| Factor { negative: false, size: Size::Value(value) };
        (factor(sine), factor(cosine))
    }

    fn arithmetic(&mut self, result: Value, operation: &Operation) {
        let one = Factor::ONE;
        match *operation {
            Operation::Apply(function, ref arguments) => self.apply(result, function, arguments),
            Operation::Add(a, b) => {
                let value = self.binary(a, b, Operation::Add);
                self.define(result, value, &[(a, one), (b, one)]);
            }
            Operation::Sub(a, b) => {
                let value = self.binary(a, b, Operation::Sub);
                self.define(result, value, &[(a, one), (b, one.negated())]);
            }
            Operation::Neg(a) => {
                let x = self.load(a);
                let value = Size::Value(self.code.emit(Operation::Neg(x)));
                self.define(result, value, &[(a, one.negated())]);
            }
            Operation::Mul(a, b) => {
                let (fa, fb) = (self.factor(a), self.factor(b));
                let value = self.binary(a, b, Operation::Mul);
                self.define(result, value, &[(a, fb), (b, fa)]);
            }
            Operation::Div(a, b) => {
                // d(a/b) = (da - (a/b) db)/b
                let value = self.binary(a, b, Operation::Div);
                let mut partials = Vec::new();
                if self.is_active(a) || self.is_active(b) {
                    let divisor = self.factor(b);
                    let reciprocal = self.code.reciprocal(divisor);
                    partials.push((a, reciprocal));
                    if self.is_active(b) {
                        let quotient = Factor { negative: true, size: value };
                        partials.push((b, self.code.product(quotient, reciprocal)));
                    }
                }
                self.define(result, value, &partials);
            }
            Operation::Call(function, x) => self.call(result, function, x),
            // Loads, and sines with cosines, are done by the caller.
            _ => {}
        }
    }

    fn binary(&mut self, a: Value, b: Value, operation: fn(Value, Value) -> Operation) -> Size {
        let (a, b) = (self.load(a), self.load(b));
        Size::Value(self.code.emit(operation(a, b)))
    }

    /// A function of several arguments with its partial derivatives.
    fn apply(&mut self, result: Value, function: Multivariate, arguments: &[Value]) {
        let loaded: Vec<Value> = arguments.iter().map(|v| self.load(*v)).collect();
        let value = self.code.emit(Operation::Apply(function, loaded.clone().into()));
        let mut partials = Vec::new();
        for (place, argument) in arguments.iter().enumerate() {
            if self.is_active(*argument)
                && let Some((negative, slope)) = self.slope_by(function, &loaded, place)
            {
                partials.push((*argument, Factor { negative, size: Size::Value(slope) }));
            }
        }
        self.define(result, Size::Value(value), &partials);
    }

    /// The partial derivative of a function by the argument at a place; none where it vanishes.
    fn slope_by(
        &mut self,
        function: Multivariate,
        arguments: &[Value],
        place: usize,
    ) -> Option<(bool, Value)> {
        let code = &mut *self.code;
        match function {
            Multivariate::Atan2 => {
                let squares = [0, 1].map(|i| code.emit(Operation::Mul(arguments[i], arguments[i])));
                let square = code.emit(Operation::Add(squares[0], squares[1]));
                Some((place == 1, code.emit(Operation::Div(arguments[1 - place], square))))
            }
            Multivariate::Select if place == 0 => None,
            Multivariate::Select => Some((false, branch(code, arguments[0], place == 1))),
            Multivariate::Minimum | Multivariate::Maximum => {
                let difference = code.emit(Operation::Sub(arguments[0], arguments[1]));
                let above = (place == 0) == (function == Multivariate::Maximum);
                Some((false, branch(code, difference, above)))
            }
            Multivariate::Supplied { function, mut orders } => {
                orders[place] = orders[place].saturating_add(1);
                let slope = Multivariate::Supplied { function, orders };
                Some((false, code.emit(Operation::Apply(slope, arguments.into()))))
            }
        }
    }

    /// An elementary function with its slope.
    fn call(&mut self, result: Value, function: Function, argument: Value) {
        let x = self.load(argument);
        let value = self.code.emit(Operation::Call(function, x));
        let mut partials = Vec::new();
        if self.is_active(argument)
            && let Some((negative, slope)) = self.slope_of(function, x, value)
        {
            partials.push((argument, Factor { negative, size: Size::Value(slope) }));
        }
        self.define(result, Size::Value(value), &partials);
    }

    /// The derivative of a function at `x`, where its value is `f`; none where it vanishes.
    fn slope_of(&mut self, function: Function, x: Value, f: Value) -> Option<(bool, Value)> {
        let code = &mut *self.code;
        let one = code.emit(Operation::Number(Rational::integer(1)));
        Some(match function {
            // 1/sqrt((1 - x)(1 + x)): as a product the radicand keeps its digits near the ends.
            Function::Asin | Function::Acos => {
                let (left, right) = (code.emit(Operation::Sub(one, x)), code.emit(Operation::Add(one, x)));
                let square = code.emit(Operation::Mul(left, right));
                let root = code.emit(Operation::Call(Function::Root(2), square));
                (function == Function::Acos, code.emit(Operation::Div(one, root)))
            }
            Function::Atan => {
                let square = code.emit(Operation::Mul(x, x));
                let below = code.emit(Operation::Add(one, square));
                (false, code.emit(Operation::Div(one, below)))
            }
            Function::Exp => (false, f),
            Function::Ln => (false, code.emit(Operation::Div(one, x))),
            Function::Sinh => (false, code.emit(Operation::Call(Function::Cosh, x))),
            Function::Cosh => (false, code.emit(Operation::Call(Function::Sinh, x))),
            // 1/cosh^2 and not 1 - tanh^2, which cancels for large arguments.
            Function::Tanh => {
                let cosh = code.emit(Operation::Call(Function::Cosh, x));
                let reciprocal = code.emit(Operation::Div(one, cosh));
                (false, code.emit(Operation::Mul(reciprocal, reciprocal)))
            }
            Function::Abs => (false, code.emit(Operation::Call(Function::Sign, x))),
            Function::Sign | Function::Floor => return None,
            // root' = 1/(q root^(q - 1))
            Function::Root(q) => {
                let mut power = f;
                for _ in 2..q {
                    power = code.emit(Operation::Mul(power, f));
                }
                let q = code.emit(Operation::Number(Rational::integer(i64::from(q))));
                let below = code.emit(Operation::Mul(q, power));
                (false, code.emit(Operation::Div(one, below)))
            }
            Function::Sin | Function::Cos => return None,
        })
    }
}

/// One where `c >= 0` and zero elsewhere, or the other way round.
fn branch(code: &mut Code, c: Value, above: bool) -> Value {
    let [one, zero] = [1, 0].map(|n| code.emit(Operation::Number(Rational::integer(n))));
    let values = if above { [c, one, zero] } else { [c, zero, one] };
    code.emit(Operation::Apply(Multivariate::Select, values.into()))
}
