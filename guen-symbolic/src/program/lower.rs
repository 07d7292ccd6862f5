//! Lowers a net to instructions: one operation each, equal operations once, in the order of first use.

use super::instruction::{Instruction, Operation, Value};
use super::marks::Marks;
use super::net::{Linear, Net, NetNode, split_sign};
use super::stage::Stage;
use super::terms::NetId;
use crate::algebra::{ExprId, FastMap, Function, Graph, Node, Rational};

/// Flags of the functions of an angle that are needed.
const SINE: u32 = 1;
const COSINE: u32 = 2;

/// The constants that functions load, as expressions, in the order of first use.
#[derive(Clone, Debug, Default)]
pub(super) struct PreparedTable {
    pub(super) expressions: Vec<ExprId>,
    indices: FastMap<ExprId, usize>,
}

impl PreparedTable {
    /// The place of a constant, a new one where it is not there.
    pub(super) fn index(&mut self, k: ExprId) -> usize {
        let next = self.expressions.len();
        let index = *self.indices.or_insert_with(k, || next);
        if index == next {
            self.expressions.push(k);
        }
        index
    }
}

/// The code of one function.
#[derive(Clone, Debug)]
pub(super) struct Code {
    pub(super) instructions: Vec<Instruction>,
    pub(super) outputs: Vec<Value>,
    pub(super) values: usize,
}

/// Writes the code for the roots.
pub(super) fn lower(graph: &mut Graph, net: &Net, roots: &[NetId], prepared: &mut PreparedTable) -> Code {
    let (nodes, uses) = net.reachable(roots);
    let mut lowering = Lowering {
        graph,
        net,
        prepared,
        uses,
        denominators: net.marks(),
        turned: net.marks(),
        done: net.marks(),
        stage: Stage::default(),
    };
    for id in &nodes {
        match net.node(*id) {
            NetNode::Product(factors) => {
                for (base, _) in factors.iter().filter(|(_, e)| *e < 0) {
                    lowering.denominators.set(*base, lowering.denominators.get(*base) + 1);
                }
            }
            NetNode::Call(Function::Sin, x) => lowering.turned.set(*x, lowering.turned.get(*x) | SINE),
            NetNode::Call(Function::Cos, x) => lowering.turned.set(*x, lowering.turned.get(*x) | COSINE),
            _ => {}
        }
    }
    let outputs = roots.iter().map(|root| lowering.value(*root)).collect();
    Code { instructions: lowering.stage.instructions, outputs, values: lowering.stage.values as usize }
}

struct Lowering<'a> {
    graph: &'a mut Graph,
    net: &'a Net,
    prepared: &'a mut PreparedTable,
    uses: Marks,
    /// The number of products that divide by each node.
    denominators: Marks,
    /// Whether sine and cosine of a node are needed.
    turned: Marks,
    /// The value of each node, plus one, zero for none.
    done: Marks,
    stage: Stage,
}

impl Lowering<'_> {
    fn number(&mut self, n: i64) -> Value {
        self.stage.emit(Operation::Number(Rational::integer(n)))
    }

    fn constant(&mut self, k: ExprId) -> Value {
        let operation = match self.graph.node(k) {
            Node::Number(value) => Operation::Number(value.clone()),
            Node::Symbol(symbol) => Operation::Symbol(*symbol),
            Node::Pi => Operation::Pi,
            _ => Operation::Prepared(self.prepared.index(k)),
        };
        self.stage.emit(operation)
    }

    /// The value of a node; everything below it first, without recursion.
    fn value(&mut self, root: NetId) -> Value {
        let mut stack = vec![(root, false)];
        while let Some((id, entered)) = stack.pop() {
            if self.done.get(id) != 0 {
                continue;
            }
            if entered {
                let value = self.step(id);
                self.done.set(id, value.0 + 1);
                continue;
            }
            stack.push((id, true));
            let start = stack.len();
            self.net.children(id, |child| stack.push((child, false)));
            if stack.len() > start + 1 {
                stack[start..].reverse();
            }
        }
        self.get(root)
    }

    fn get(&self, id: NetId) -> Value {
        // Children come before their parents.
        Value(self.done.get(id) - 1)
    }

    fn step(&mut self, id: NetId) -> Value {
        match self.net.node(id) {
            NetNode::Atom(e) => match *self.graph.node(*e) {
                Node::Symbol(symbol) => self.stage.emit(Operation::Symbol(symbol)),
                Node::Pi => self.stage.emit(Operation::Pi),
                // Whoever divides asks first; a mistake of ours shows as a value that is not a number.
                _ => {
                    let zero = self.number(0);
                    self.stage.emit(Operation::Div(zero, zero))
                }
            },
            NetNode::Constant(k) => self.constant(*k),
            NetNode::Sum(linear) => self.sum(linear),
            NetNode::Product(factors) => self.product(None, factors),
            NetNode::Call(function @ (Function::Sin | Function::Cos), x) => {
                let angle = self.get(*x);
                if self.turned.get(*x) != SINE | COSINE {
                    return self.stage.emit(Operation::Call(*function, angle));
                }
                let key = Operation::Call(*function, angle);
                if let Some(value) = self.stage.numbering.get(&key) {
                    return *value;
                }
                let (sine, cosine) = (self.stage.fresh(), self.stage.fresh());
                let operation = Operation::SinCos { angle, cosine };
                self.stage.instructions.push(Instruction { result: sine, operation });
                self.stage.numbering.insert(Operation::Call(Function::Sin, angle), sine);
                self.stage.numbering.insert(Operation::Call(Function::Cos, angle), cosine);
                if *function == Function::Sin { sine } else { cosine }
            }
            NetNode::Call(function, x) => {
                let x = self.get(*x);
                self.stage.emit(Operation::Call(*function, x))
            }
            NetNode::Apply(function, arguments) => {
                let arguments = arguments.iter().map(|x| self.get(*x)).collect();
                self.stage.emit(Operation::Apply(*function, arguments))
            }
        }
    }

    fn sum(&mut self, linear: &Linear) -> Value {
        let mut parts: Vec<(bool, ExprId, Option<NetId>)> = Vec::with_capacity(linear.terms.len() + 1);
        for (node, k) in &linear.terms {
            let (negative, k) = split_sign(self.graph, *k);
            parts.push((negative, k, Some(*node)));
        }
        if !self.graph.is_zero(linear.constant) {
            let (negative, k) = split_sign(self.graph, linear.constant);
            parts.push((negative, k, None));
        }
        let mut negate = false;
        if parts.iter().all(|(negative, ..)| *negative) {
            // A coefficient takes the sign where there is one to take it.
            let one = self.graph.one();
            match parts.iter().position(|(_, k, node)| *k != one || node.is_none()) {
                Some(i) => parts[i] = (false, self.graph.neg(parts[i].1), parts[i].2),
                None => {
                    negate = true;
                    parts.iter_mut().for_each(|part| part.0 = false);
                }
            }
        }
        let first = parts.iter().position(|part| !part.0).expect("some part is positive by now");
        parts[..=first].rotate_right(1);
        let mut total: Option<Value> = None;
        for (negative, k, node) in parts {
            let value = self.term(k, node);
            total = Some(match total {
                None => value,
                Some(sum) if negative => self.stage.emit(Operation::Sub(sum, value)),
                Some(sum) => self.stage.emit(Operation::Add(sum, value)),
            });
        }
        let total = total.expect("sums are not empty");
        if negate { self.stage.emit(Operation::Neg(total)) } else { total }
    }

    fn term(&mut self, k: ExprId, node: Option<NetId>) -> Value {
        let Some(node) = node else { return self.constant(k) };
        if k == self.graph.one() {
            return self.get(node);
        }
        // k/d is one division, not a reciprocal and a multiplication.
        if let NetNode::Product(factors) = self.net.node(node)
            && self.is_lone_reciprocal(node, factors)
        {
            return self.product(Some(k), factors);
        }
        let k = self.constant(k);
        let value = self.get(node);
        self.stage.emit(Operation::Mul(k, value))
    }

    fn is_lone_reciprocal(&self, node: NetId, factors: &[(NetId, i32)]) -> bool {
        self.uses.get(node) == 1
            && factors.iter().all(|(base, e)| *e < 0 && self.denominators.get(*base) == 1)
    }

    /// `k * product base^e`: shared denominators as reciprocals, all others in one division.
    fn product(&mut self, k: Option<ExprId>, factors: &[(NetId, i32)]) -> Value {
        let mut above: Vec<Value> = Vec::new();
        let mut below: Vec<Value> = Vec::new();
        for (base, e) in factors {
            let value = self.get(*base);
            let n = e.unsigned_abs();
            if *e > 0 {
                above.push(self.power(value, n));
            } else if self.denominators.get(*base) > 1 {
                let one = self.number(1);
                let reciprocal = self.stage.emit(Operation::Div(one, value));
                above.push(self.power(reciprocal, n));
            } else {
                below.push(self.power(value, n));
            }
        }
        if let Some(k) = k {
            above.insert(0, self.constant(k));
        }
        let numerator = self.multiply(above);
        match (numerator, self.multiply(below)) {
            (Some(numerator), None) => numerator,
            (Some(numerator), Some(denominator)) => self.stage.emit(Operation::Div(numerator, denominator)),
            (None, Some(denominator)) => {
                let one = self.number(1);
                self.stage.emit(Operation::Div(one, denominator))
            }
            (None, None) => self.number(1),
        }
    }

    fn multiply(&mut self, values: Vec<Value>) -> Option<Value> {
        values.into_iter().reduce(|a, b| self.stage.emit(Operation::Mul(a, b)))
    }

    /// `value^n` by repeated squaring; shared powers are shared operations.
    fn power(&mut self, value: Value, mut n: u32) -> Value {
        let mut square = value;
        let mut power: Option<Value> = None;
        while n > 0 {
            if n & 1 == 1 {
                power = Some(match power {
                    None => square,
                    Some(power) => self.stage.emit(Operation::Mul(power, square)),
                });
            }
            n >>= 1;
            if n > 0 {
                square = self.stage.emit(Operation::Mul(square, square));
            }
        }
        power.expect("exponents are not zero")
    }
}
