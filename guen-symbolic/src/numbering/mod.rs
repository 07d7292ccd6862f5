//! Expressions numbered by value: a further expression whose value at a random point modulo the prime is that of an older
//! one, up to its sign, *is* that one.
//!
//! So `c^2 + s^2`, entries that vanish and rows that depend on each other are found while a system is put together, whatever
//! they are written as. What comes in are expressions of the graph; what goes out are expressions of the graph again, whose
//! shared parts are kept whole. Two different functions have the same value with a probability of some `10^-11` for a
//! system of ten thousand expressions; whoever uses the result proves it at other points.

mod evaluate;
mod export;
mod import;
mod rate;
#[cfg(test)]
mod tests;

pub(crate) use rate::Rates;

use crate::algebra::{ExprId, FastMap, Graph, Key, Rational, spread};
use crate::workbench::Workbench;
use crate::zero::{DrawnRoots, field};

/// A number of an expression, with a sign.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub(crate) struct Num(u32);

impl Num {
    pub(crate) const ZERO: Num = Num(0);
    pub(crate) const ONE: Num = Num(2);

    fn new(index: usize, negative: bool) -> Self {
        if index == 0 { Num::ZERO } else { Num((index as u32) << 1 | u32::from(negative)) }
    }

    fn index(self) -> usize {
        (self.0 >> 1) as usize
    }

    fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    pub(crate) fn is_zero(self) -> bool {
        self == Num::ZERO
    }

    pub(crate) fn neg(self) -> Num {
        if self.is_zero() { self } else { Num(self.0 ^ 1) }
    }

    /// Returns the number without its sign.
    pub(crate) fn abs(self) -> Num {
        Num(self.0 & !1)
    }

    fn signed(self, negative: bool) -> Num {
        if negative { self.neg() } else { self }
    }
}

impl Key for Num {
    fn hash(&self) -> u32 {
        spread(self.0.into())
    }
}

/// A residue, or the smaller of it and its opposite.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Residue(u64);

impl Key for Residue {
    fn hash(&self) -> u32 {
        spread(self.0)
    }
}

/// An operation, as an expression is numbered.
#[derive(Clone, PartialEq, Debug)]
enum Op {
    /// An expression of the graph that is not looked into.
    Expr(ExprId),
    /// A function of the graph whose arguments are numbered.
    Function(ExprId, [Option<Num>; 3]),
    Sum(Num, Num),
    Product(Num, Num),
    Quotient(Num, Num),
    SquareRoot(Num),
}

impl Op {
    /// The opposite, where that is an operation too.
    fn signed(self, negative: bool) -> Option<Op> {
        if !negative {
            return Some(self);
        }
        Some(match self {
            Op::Sum(a, b) => Op::Sum(a.neg(), b.neg()),
            Op::Product(a, b) => Op::Product(a.neg(), b),
            Op::Quotient(a, b) => Op::Quotient(a.neg(), b),
            Op::Expr(_) | Op::Function(..) | Op::SquareRoot(_) => return None,
        })
    }
}

/// The table of numbered expressions.
#[derive(Clone)]
pub(crate) struct Numbering {
    ops: Vec<Op>,
    residues: Vec<u64>,
    constant: Vec<bool>,
    known: FastMap<Residue, u32>,
    imported: FastMap<ExprId, Num>,
    /// The multiples of numbered expressions that sums are looked up as.
    multiples: Vec<Rational>,
    /// Rates of imported functions that are known otherwise.
    rates: FastMap<Num, Num>,
    /// The point of the zero test, and whether it lies on the constraints on positions.
    point: (usize, bool),
    /// The roots at the point, where these are drawn.
    roots: Option<DrawnRoots>,
    generation: u32,
    /// An expression has no value at the point: whatever comes of it is of no use.
    failed: bool,
}

impl Numbering {
    /// An empty table for a point of the zero test.
    pub(crate) fn new(graph: &mut Graph, point: (usize, bool), generation: u32) -> Self {
        let mut numbering = Numbering {
            ops: Vec::new(),
            residues: Vec::new(),
            constant: Vec::new(),
            known: FastMap::default(),
            imported: FastMap::default(),
            multiples: Vec::new(),
            rates: FastMap::default(),
            point,
            roots: None,
            generation,
            failed: false,
        };
        // Small numbers are there from the start, so that what has their value is one of them.
        let numbers =
            [(0, 1), (1, 1), (2, 1), (1, 2), (3, 1), (4, 1), (1, 4), (1, 3), (3, 2), (2, 3), (6, 1), (1, 6)];
        for (n, d) in numbers {
            let number = Rational::new(n, d);
            let residue = field::residue(&number).expect("small numbers have residues");
            let e = graph.number(number);
            let own = numbering.push(Op::Expr(e), residue, true);
            numbering.imported.insert(e, own);
        }
        numbering
    }

    /// Returns the table with square roots that are drawn for their radicands: not every point has all roots of many.
    pub(crate) fn with_drawn_roots(mut self, bench: &mut Workbench) -> Self {
        let (point, on_manifold) = self.point;
        self.roots = bench.zero.drawn_roots(&bench.graph, point, on_manifold);
        self
    }

    /// Whether everything had a value so far.
    pub(crate) fn is_sound(&self) -> bool {
        !self.failed
    }

    pub(crate) fn is_constant(&self, a: Num) -> bool {
        self.constant[a.index()]
    }

    /// The value at the point.
    pub(crate) fn residue(&self, a: Num) -> u64 {
        let residue = self.residues[a.index()];
        if a.is_negative() { field::neg(residue) } else { residue }
    }

    /// The expression with a value, if there is one.
    pub(crate) fn with_residue(&self, residue: u64) -> Option<Num> {
        let smaller = residue.min(field::neg(residue));
        let index = *self.known.get(&Residue(smaller))? as usize;
        Some(Num::new(index, self.residues[index] != residue))
    }

    /// `a/b`, if that has the value of something that is there.
    pub(crate) fn ratio(&self, a: Num, b: Num) -> Option<Num> {
        let inverse = field::inverse(self.residue(b))?;
        self.with_residue(field::mul(self.residue(a), inverse))
    }

    fn push(&mut self, op: Op, residue: u64, constant: bool) -> Num {
        let smaller = residue.min(field::neg(residue));
        if let Some(index) = self.known.get(&Residue(smaller)) {
            let index = *index as usize;
            let negative = self.residues[index] != residue;
            // What turns out to be constant is prepared.
            if constant
                && !self.constant[index]
                && let Some(op) = op.signed(negative)
            {
                self.ops[index] = op;
                self.constant[index] = true;
            }
            return Num::new(index, negative);
        }
        let index = self.ops.len();
        self.known.insert(Residue(smaller), index as u32);
        self.ops.push(op);
        self.residues.push(residue);
        self.constant.push(constant);
        Num::new(index, false)
    }

    fn fail(&mut self) -> Num {
        self.failed = true;
        Num::ZERO
    }

    /// `c x` as `c` and `x`, where `c` is constant and `x` is not.
    fn scaled_parts(&self, a: Num) -> Option<(Num, Num)> {
        match &self.ops[a.index()] {
            Op::Product(c, x) if !self.is_constant(a) && self.is_constant(*c) => {
                Some((c.signed(a.is_negative()), *x))
            }
            _ => None,
        }
    }

    pub(crate) fn add(&mut self, a: Num, b: Num) -> Num {
        if a.is_zero() || b.is_zero() {
            return if a.is_zero() { b } else { a };
        }
        let residue = field::add(self.residue(a), self.residue(b));
        let constant = self.is_constant(a) && self.is_constant(b);
        if let Some(known) = self.with_residue(residue)
            && (self.is_constant(known) || !constant)
        {
            return known;
        }
        if a == b {
            let two = self.number_two();
            return self.mul(two, a);
        }
        // c x + d x = (c + d) x
        let parts = |this: &Self, a: Num| {
            if this.is_constant(a) { None } else { Some(this.scaled_parts(a).unwrap_or((Num::ONE, a))) }
        };
        if let (Some((c, x)), Some((d, y))) = (parts(self, a), parts(self, b))
            && x.abs() == y.abs()
        {
            let d = d.signed(x != y);
            let c = self.add(c, d);
            return self.mul(c, x);
        }
        let (a, b) = if a.abs() <= b.abs() { (a, b) } else { (b, a) };
        if a.is_negative() {
            // The first term of a sum is positive.
            return self.push(Op::Sum(a.neg(), b.neg()), field::neg(residue), constant).neg();
        }
        self.push(Op::Sum(a, b), residue, constant)
    }

    fn number_two(&self) -> Num {
        Num::new(2, false)
    }

    pub(crate) fn sub(&mut self, a: Num, b: Num) -> Num {
        self.add(a, b.neg())
    }

    pub(crate) fn sum(&mut self, terms: impl IntoIterator<Item = Num>) -> Num {
        terms.into_iter().fold(Num::ZERO, |sum, term| self.add(sum, term))
    }

    pub(crate) fn mul(&mut self, a: Num, b: Num) -> Num {
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.abs(), b.abs());
        if a.is_zero() || b.is_zero() {
            return Num::ZERO;
        }
        if a == Num::ONE || b == Num::ONE {
            return if a == Num::ONE { b } else { a }.signed(negative);
        }
        // The square of a root that is drawn has another value than the radicand.
        if a == b
            && self.roots.is_some()
            && let Op::SquareRoot(radicand) = self.ops[a.index()]
        {
            return radicand.signed(negative);
        }
        let residue = field::mul(self.residue(a), self.residue(b));
        let constant = self.is_constant(a) && self.is_constant(b);
        if let Some(known) = self.with_residue(residue)
            && (self.is_constant(known) || !constant)
        {
            return known.signed(negative);
        }
        let (a, b) = if self.is_constant(b) && !self.is_constant(a) { (b, a) } else { (a, b) };
        if self.is_constant(a) && !constant {
            // c (d x) = (c d) x
            if let Some((d, x)) = self.scaled_parts(b) {
                let c = self.mul(a, d);
                return self.mul(c, x).signed(negative);
            }
            return self.push(Op::Product(a, b), residue, constant).signed(negative);
        }
        let (a, b) = if a <= b { (a, b) } else { (b, a) };
        self.push(Op::Product(a, b), residue, constant).signed(negative)
    }

    pub(crate) fn div(&mut self, a: Num, b: Num) -> Num {
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.abs(), b.abs());
        if a.is_zero() || b == Num::ONE {
            return a.signed(negative);
        }
        let Some(inverse) = field::inverse(self.residue(b)) else { return self.fail() };
        let residue = field::mul(self.residue(a), inverse);
        let constant = self.is_constant(a) && self.is_constant(b);
        if let Some(known) = self.with_residue(residue)
            && (self.is_constant(known) || !constant)
        {
            return known.signed(negative);
        }
        if self.is_constant(b) && a != Num::ONE {
            let inverse = self.div(Num::ONE, b);
            return self.mul(a, inverse).signed(negative);
        }
        self.push(Op::Quotient(a, b), residue, constant).signed(negative)
    }

    pub(crate) fn sqrt(&mut self, a: Num) -> Num {
        let Some(root) = self.root_of(a) else { return self.fail() };
        let constant = self.is_constant(a);
        self.push(Op::SquareRoot(a), root, constant)
    }

    /// The square root, if it is there.
    pub(crate) fn known_root(&self, a: Num) -> Option<Num> {
        self.root_of(a).and_then(|root| self.with_residue(root))
    }

    fn root_of(&self, a: Num) -> Option<u64> {
        match self.roots {
            Some(roots) => Some(roots.of(self.residue(a))),
            None => field::sqrt(self.residue(a)),
        }
    }

    pub(crate) fn square(&mut self, a: Num) -> Num {
        self.mul(a, a)
    }

    /// `sum a_i b_i`.
    pub(crate) fn dot(&mut self, a: &[Num], b: &[Num]) -> Num {
        let mut sum = Num::ZERO;
        for (a, b) in a.iter().zip(b) {
            let product = self.mul(*a, *b);
            sum = self.add(sum, product);
        }
        sum
    }

    fn children(&self, index: usize) -> [Option<Num>; 3] {
        match self.ops[index] {
            Op::Expr(_) => [None; 3],
            Op::Function(_, arguments) => arguments,
            Op::SquareRoot(a) => [Some(a), None, None],
            Op::Sum(a, b) | Op::Product(a, b) | Op::Quotient(a, b) => [Some(a), Some(b), None],
        }
    }
}
