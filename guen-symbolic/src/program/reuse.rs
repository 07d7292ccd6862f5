//! Values of a program that are products of two others: one multiplication in place of the operations that computed them.
//!
//! No pass over expressions finds that `w^2 i^2 + w^2 j^2 + ..` is `(w^2 + k^2)(i^2 + j^2)` where both factors are computed for something
//! else. Here numbers find it: every value is compared with all products of two others at random points, and what agrees there
//! in 237 bits is that product. A value is replaced where the operations that nothing else needs cost more than the multiplication. Unlike
//! sums, products do not cancel.
//!
//! Factors may divide by what the value divided by and by nothing else, so that a program is defined where it was. What depends on
//! a branch (absolute values, inverse functions, `select`) is left alone: points show one branch.

use f256::f256;

use super::accuracy::Point;
use super::cost::OperationCount;
use super::evaluate::{Arithmetic, run};
use super::instruction::{Instruction, Operation, Value};
use super::lower::Code;
use super::thresholds::{REUSE_INSTRUCTIONS, REUSE_ROUNDS};
use crate::algebra::{ExprId, FastMap, Function, Graph, Node, SymbolId};
use crate::zero::{Real, evaluate};

/// Points at which values are compared: a root of a square has a sign at each.
const REUSE_POINTS: usize = 24;
/// Points at which values are compared in 237 bits.
const LONG_POINTS: usize = 2;
/// The relative difference up to which values may be equal in double precision.
const NEAR: f64 = 1e-7;
/// The relative difference up to which values are equal in 237 bits.
const EQUAL: f64 = 1e-55;
/// Programs with roots are also compared in 237 bits at coordinates that are so many times larger, at so many points of each size: `sqrt((q - 3)^2)` is
/// `3 - q` only where `q` is small, and `sqrt(cos(q)^2)` is `cos(q)` only within a quarter turn.
const FAR_SIZES: [f64; 5] = [2.0, 5.0, 20.0, 1e3, 1e6];
const POINTS_OF_SIZE: u64 = 4;
/// The relative difference up to which values are equal there: sums of large terms cancel.
const FAR_EQUAL: f64 = 1e-30;

/// A way to compute a value by one multiplication, or by none.
#[derive(Clone, Copy)]
struct Way {
    /// The cost that is saved.
    gain: u64,
    value: Value,
    factors: (Value, Option<Value>),
    /// Whether the value is the opposite of the product.
    is_negative: bool,
}

/// The code with values by products of others; none where nothing is cheaper so.
pub(super) fn reused(graph: &Graph, code: &Code, prepared: &[ExprId]) -> Option<Code> {
    if code.instructions.len() > REUSE_INSTRUCTIONS {
        return None;
    }
    let before = code;
    let mut code = before.clone();
    let loads = Loads::new(graph, prepared);
    for _ in 0..REUSE_ROUNDS {
        let points = Points::new(graph, &code, prepared, &loads);
        let ways = Search::new(&code, &points, &loads).ways();
        if ways.is_empty() {
            break;
        }
        let long = points.long(graph, &code, prepared);
        let mut progress = false;
        for way in ways {
            // An earlier replacement of this round may have removed a factor, or changed the gain.
            let search = Search::new(&code, &points, &loads);
            if search.gain(way.value, way.factors, way.is_negative) != Some(way.gain) || !way.is_exact(&long)
            {
                continue;
            }
            let turned = if way.is_negative { search.with_opposite(way.value) } else { None };
            let is_turned = turned.is_some();
            code = search.replaced(&way, turned);
            progress = true;
            // Some values have the opposite sign now: the values at the points have to be computed anew.
            if is_turned {
                break;
            }
        }
        if !progress {
            break;
        }
    }
    (code.instructions != before.instructions).then_some(code)
}

/// The constants that a program loads.
struct Loads {
    /// Whether each depends on a branch.
    is_branch: Vec<bool>,
    /// Whether each is undefined for some constants.
    is_partial: Vec<bool>,
    has_root: bool,
}

impl Loads {
    fn new(graph: &Graph, prepared: &[ExprId]) -> Self {
        let mut loads = Loads { is_branch: Vec::new(), is_partial: Vec::new(), has_root: false };
        for e in prepared {
            let (mut branches, mut partial) = (false, false);
            for id in graph.reachable(&[*e], |_| false) {
                match graph.node(id) {
                    Node::Function(function, _) => {
                        branches |= has_branches(*function);
                        partial |= matches!(function, Function::Root(_) | Function::Ln);
                        loads.has_root |= matches!(function, Function::Root(_));
                    }
                    Node::Multivariate(..) => branches = true,
                    Node::Product(factors) => {
                        let divides = |(base, exponent): &(ExprId, i32)| {
                            *exponent < 0 && !graph.manifestly_nonzero(*base)
                        };
                        partial |= factors.iter().any(divides);
                    }
                    _ => {}
                }
            }
            loads.is_branch.push(branches);
            loads.is_partial.push(partial);
        }
        loads
    }
}

impl Way {
    /// Whether the value is that product in 237 bits, wherever it is defined.
    fn is_exact(&self, points: &[(f64, Vec<f256>)]) -> bool {
        let (a, b) = self.factors;
        let agrees = |(equal, values): &(f64, Vec<f256>)| {
            let product = b.map_or(values[a.index()], |b| values[a.index()] * values[b.index()]);
            let product = if self.is_negative { -product } else { product };
            let own = values[self.value.index()];
            own.is_finite().then(|| f256::abs(&(own - product)) <= f256::from(*equal) * f256::abs(&own))
        };
        let defined: Vec<bool> = points.iter().filter_map(agrees).collect();
        !defined.is_empty() && defined.into_iter().all(|agrees| agrees)
    }
}

/// Points, and the values of a program there.
struct Points {
    points: Vec<Point>,
    values: Vec<Vec<f64>>,
    has_root: bool,
}

impl Points {
    fn new(graph: &Graph, code: &Code, prepared: &[ExprId], loads: &Loads) -> Self {
        let has_root = |i: &Instruction| matches!(i.operation, Operation::Call(Function::Root(_), _));
        let has_root = loads.has_root || code.instructions.iter().any(has_root);
        let wanted = if has_root { REUSE_POINTS } else { LONG_POINTS };
        let mut drawn: Vec<(usize, Point, Vec<f64>)> = Vec::new();
        for seed in 0..wanted as u64 {
            let point = Point::anywhere(seed);
            let values = values_at(code, prepared, graph, |symbol| point.value(graph, symbol));
            drawn.push((values.iter().filter(|value| !value.is_finite()).count(), point, values));
        }
        // Those at which most is defined come first.
        drawn.sort_by_key(|(undefined, ..)| *undefined);
        let (points, values) = drawn.into_iter().map(|(_, point, values)| (point, values)).unzip();
        Points { points, values, has_root }
    }

    /// The values in 237 bits at the first points, and at some that are far away where roots occur; with the relative difference up to which
    /// they are equal.
    fn long(&self, graph: &Graph, code: &Code, prepared: &[ExprId]) -> Vec<(f64, Vec<f256>)> {
        let sizes = FAR_SIZES.iter().filter(|_| self.has_root);
        let far = sizes.flat_map(|size| (0..POINTS_OF_SIZE).map(|seed| Point::far(seed, *size)));
        let near = self.points.iter().take(LONG_POINTS).map(|point| (EQUAL, *point));
        near.chain(far.map(|point| (FAR_EQUAL, point)))
            .map(|(equal, point)| {
                let value = |symbol| f256::from(point.value(graph, symbol));
                (equal, values_at(code, prepared, graph, value))
            })
            .collect()
    }

    /// Whether a value is that product at all points where it is defined, and with which sign.
    fn agree(&self, value: Value, (a, b): (Value, Option<Value>)) -> Option<bool> {
        let mut sign = None;
        for values in &self.values {
            let product = values[a.index()] * b.map_or(1.0, |b| values[b.index()]);
            let own = values[value.index()];
            if !own.is_finite() {
                continue;
            }
            let is_negative = (own < 0.0) != (product < 0.0);
            let is_near = (own.abs() - product.abs()).abs() <= NEAR * own.abs();
            if own == 0.0 || !is_near || *sign.get_or_insert(is_negative) != is_negative {
                return None;
            }
        }
        sign
    }
}

/// All values of a program, in the order of their numbers.
fn values_at<R: Arithmetic + Real>(
    code: &Code,
    prepared: &[ExprId],
    graph: &Graph,
    symbols: impl Fn(SymbolId) -> R,
) -> Vec<R> {
    let all: Vec<Value> = (0..code.values).map(Value::new).collect();
    let constants = evaluate(graph, prepared, &symbols);
    run(&code.instructions, code.values, &all, &constants, symbols)
}

/// A program, and what its values depend on.
struct Search<'a> {
    code: &'a Code,
    points: &'a Points,
    /// The instruction of each value.
    defined: Vec<Option<usize>>,
    /// The number of operands and outputs that are each value.
    uses: Vec<u32>,
    /// The divisions and roots that each value depends on, a bit for each, constants with such ones among them; none where it depends on a
    /// branch.
    domains: Vec<Option<Vec<u64>>>,
}

impl<'a> Search<'a> {
    fn new(code: &'a Code, points: &'a Points, loads: &Loads) -> Self {
        let mut search = Search {
            code,
            points,
            defined: vec![None; code.values],
            uses: vec![0; code.values],
            domains: vec![None; code.values],
        };
        let words = code.instructions.len().div_ceil(64);
        for (place, instruction) in code.instructions.iter().enumerate() {
            let mut domain = (!is_branch(&instruction.operation, loads)).then(|| vec![0; words]);
            for operand in instruction.operation.operands() {
                search.uses[operand.index()] += 1;
                match (&mut domain, &search.domains[operand.index()]) {
                    (Some(own), Some(other)) => {
                        own.iter_mut().zip(other).for_each(|(own, other)| *own |= other)
                    }
                    _ => domain = None,
                }
            }
            let is_partial = match instruction.operation {
                Operation::Div(..) | Operation::Call(Function::Root(_) | Function::Ln, _) => true,
                Operation::Prepared(k) => loads.is_partial[k],
                _ => false,
            };
            if let Some(own) = domain.as_mut().filter(|_| is_partial) {
                own[place / 64] |= 1 << (place % 64);
            }
            for value in instruction.defined() {
                search.defined[value.index()] = Some(place);
                search.domains[value.index()] = domain.clone();
            }
        }
        code.outputs.iter().for_each(|output| search.uses[output.index()] += 1);
        search
    }

    fn instruction(&self, value: Value) -> Option<&'a Instruction> {
        self.defined[value.index()].map(|place| &self.code.instructions[place])
    }

    /// The ways to replace values, the best first.
    fn ways(&self) -> Vec<Way> {
        let there: Vec<Value> = (0..self.code.values)
            .map(Value::new)
            .filter(|value| self.defined[value.index()].is_some())
            .collect();
        let first = &self.points.values[0];
        let mut by_size: Vec<(u64, Value)> =
            there.iter().map(|value| (size(first[value.index()]), *value)).collect();
        by_size.sort_unstable();
        let mut found: Vec<Way> = Vec::new();
        for instruction in &self.code.instructions {
            let value = instruction.result;
            // A load, and one operation on loads, is as cheap as it can be.
            if matches!(instruction.operation, Operation::SinCos { .. }) || self.own_cost(value, &[]) < 2 {
                continue;
            }
            let above = self.above(value);
            let mut best: Option<Way> = None;
            let own = first[value.index()];
            if !own.is_finite() {
                continue;
            }
            for a in &there {
                let factor = first[a.index()];
                if factor == 0.0 || !factor.is_finite() || above[a.index()] {
                    continue;
                }
                let other = size(own / factor);
                let start = by_size.partition_point(|(size, _)| *size + 1 < other);
                let others = by_size[start..].iter().take_while(|(size, _)| *size <= other + 1);
                let others = others.map(|(_, b)| *b).filter(|b| b <= a && !above[b.index()]);
                let products = others.map(|b| (*a, Some(b)));
                let is_own = size(own).abs_diff(size(factor)) <= 1;
                for factors in products.chain(is_own.then_some((*a, None))) {
                    let Some(is_negative) = self.points.agree(value, factors) else { continue };
                    // Of equal ones the first in the order of the code: points must not decide.
                    if let Some(gain) = self.gain(value, factors, is_negative)
                        && best.is_none_or(|best| (best.gain, factors) < (gain, best.factors))
                    {
                        best = Some(Way { gain, value, factors, is_negative });
                    }
                }
            }
            found.extend(best);
        }
        found.sort_by_key(|way| core::cmp::Reverse(way.gain));
        found
    }

    /// The cost that is saved where a value is that product; none where it may not be.
    fn gain(&self, value: Value, (a, b): (Value, Option<Value>), is_negative: bool) -> Option<u64> {
        let above = self.above(value);
        let is_there = |other: Value| self.defined[other.index()].is_some() && !above[other.index()];
        if self.defined[value.index()].is_none() || !is_there(a) || !b.is_none_or(is_there) {
            return None;
        }
        let own = self.domains[value.index()].as_ref()?;
        for factor in [Some(a), b].into_iter().flatten() {
            let domain = self.domains[factor.index()].as_ref()?;
            if domain.iter().zip(own).any(|(other, own)| other & !own != 0) {
                return None;
            }
        }
        let kept: Vec<Value> = [Some(a), b].into_iter().flatten().collect();
        let is_turned = is_negative && self.with_opposite(value).is_none();
        let cost = u64::from(b.is_some()) + u64::from(is_turned);
        self.own_cost(value, &kept).checked_sub(cost).filter(|gain| *gain > 0)
    }

    /// The code where a value is its opposite, and outputs are what they were; none where that takes a further operation.
    fn with_opposite(&self, value: Value) -> Option<Vec<Instruction>> {
        let mut is_opposite = vec![false; self.code.values];
        is_opposite[value.index()] = true;
        let mut instructions = self.code.instructions.clone();
        for instruction in &mut instructions {
            let turned = |operand: Value| is_opposite[operand.index()];
            if !instruction.operation.operands().any(turned) || instruction.result == value {
                continue;
            }
            let (operation, is_turned) = match instruction.operation {
                Operation::Add(a, b) => match (turned(a), turned(b)) {
                    (true, true) => (Operation::Add(a, b), true),
                    (true, false) => (Operation::Sub(b, a), false),
                    _ => (Operation::Sub(a, b), false),
                },
                Operation::Sub(a, b) => match (turned(a), turned(b)) {
                    (true, true) => (Operation::Sub(b, a), false),
                    (true, false) => (Operation::Add(a, b), true),
                    _ => (Operation::Add(a, b), false),
                },
                Operation::Mul(a, b) => (Operation::Mul(a, b), turned(a) != turned(b)),
                Operation::Div(a, b) => (Operation::Div(a, b), turned(a) != turned(b)),
                _ => return None,
            };
            instruction.operation = operation;
            is_opposite[instruction.result.index()] = is_turned;
        }
        let is_other = |output: &Value| is_opposite[output.index()];
        (!self.code.outputs.iter().any(is_other)).then_some(instructions)
    }

    /// The cost of what only a value needs, without what some others need.
    fn own_cost(&self, value: Value, kept: &[Value]) -> u64 {
        let mut left: FastMap<Value, u32> = FastMap::default();
        let mut stack = vec![value];
        let mut gone = Vec::new();
        while let Some(next) = stack.pop() {
            let Some(instruction) = self.instruction(next) else { continue };
            gone.push(instruction.clone());
            for operand in instruction.operation.operands() {
                // Both values of an angle stay together.
                let is_pair =
                    matches!(self.instruction(operand).map(|i| &i.operation), Some(Operation::SinCos { .. }));
                let uses = left.or_insert_with(operand, || self.uses[operand.index()]);
                *uses -= 1;
                if *uses == 0 && !is_pair && !kept.contains(&operand) {
                    stack.push(operand);
                }
            }
        }
        OperationCount::of(&gone).weighted()
    }

    /// The values that depend on a value, itself among them.
    fn above(&self, value: Value) -> Vec<bool> {
        let mut above = vec![false; self.code.values];
        above[value.index()] = true;
        let start = self.defined[value.index()].unwrap_or(0);
        for instruction in &self.code.instructions[start..] {
            if instruction.operation.operands().any(|operand| above[operand.index()]) {
                instruction.defined().for_each(|value| above[value.index()] = true);
            }
        }
        above
    }

    /// The code with a value replaced, in that where it is its opposite if there is one; everything in the order in which it is needed.
    fn replaced(&self, way: &Way, turned: Option<Vec<Instruction>>) -> Code {
        let (mut outputs, mut values) = (self.code.outputs.clone(), self.code.values);
        let is_opposite = way.is_negative && turned.is_none();
        let mut instructions = turned.unwrap_or_else(|| self.code.instructions.clone());
        let product = match way.factors {
            (a, None) => a,
            (a, Some(b)) => {
                let result = Value::new(values);
                values += 1;
                instructions.push(Instruction { result, operation: Operation::Mul(a, b) });
                result
            }
        };
        if is_opposite {
            let own = instructions.iter_mut().find(|instruction| instruction.result == way.value);
            own.into_iter().for_each(|own| own.operation = Operation::Neg(product));
        } else {
            let read = instructions.iter_mut().flat_map(|instruction| instruction.operation.operands_mut());
            let read = read.chain(&mut outputs).filter(|operand| **operand == way.value);
            read.for_each(|operand| *operand = product);
        }
        Code { instructions: in_order(&instructions, &outputs, values), outputs, values }
    }
}

/// Whether points show one branch of an operation.
fn is_branch(operation: &Operation, loads: &Loads) -> bool {
    match operation {
        Operation::Call(function, _) => has_branches(*function),
        Operation::Apply(..) => true,
        Operation::Prepared(k) => loads.is_branch[*k],
        _ => false,
    }
}

/// Whether a function is another one at other points: not so a root, whose sign is seen at the points that are drawn for it.
fn has_branches(function: Function) -> bool {
    use Function::{Cos, Cosh, Exp, Ln, Root, Sin, Sinh, Tanh};
    !matches!(function, Sin | Cos | Exp | Ln | Sinh | Cosh | Tanh | Root(_))
}

/// A number that is the same, or differs by one, for numbers of nearly the same size.
fn size(value: f64) -> u64 {
    value.abs().to_bits() >> 24
}

/// The instructions that the outputs need, each directly before it is needed first.
pub(super) fn in_order(instructions: &[Instruction], outputs: &[Value], values: usize) -> Vec<Instruction> {
    let mut defined: Vec<Option<&Instruction>> = vec![None; values];
    for instruction in instructions {
        instruction.defined().for_each(|value| defined[value.index()] = Some(instruction));
    }
    let mut done = vec![false; values];
    let mut ordered = Vec::new();
    let mut stack: Vec<(Value, bool)> = outputs.iter().rev().map(|output| (*output, false)).collect();
    while let Some((value, entered)) = stack.pop() {
        let Some(instruction) = defined[value.index()].filter(|_| !done[value.index()]) else { continue };
        if entered {
            instruction.defined().for_each(|value| done[value.index()] = true);
            ordered.push(instruction.clone());
            continue;
        }
        stack.push((value, true));
        let operands: Vec<Value> = instruction.operation.operands().collect();
        stack.extend(operands.into_iter().rev().map(|operand| (operand, false)));
    }
    ordered
}
