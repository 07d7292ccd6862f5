//! Rates of numbered expressions along the motion, forwards through the operations.

use super::{Num, Numbering, Op};
use crate::algebra::{ExprId, Function, Node};
use crate::workbench::Workbench;

/// The rates of a motion: the symbols of time and coordinates with the numbers of their rates.
pub(crate) struct Rates {
    pub(crate) symbols: Vec<(ExprId, Num)>,
}

impl Numbering {
    /// Says what the rate of a number is; that of its opposite follows.
    pub(crate) fn set_rate(&mut self, a: Num, rate: Num) {
        if !self.is_constant(a) {
            self.rates.insert(a.abs(), rate.signed(a.is_negative()));
        }
    }

    /// The rates of numbers along another motion, of which the rates of some numbers are known.
    pub(crate) fn rates_along(
        &mut self,
        bench: &mut Workbench,
        rates: &Rates,
        known: &[(Num, Num)],
        of: &[Num],
    ) -> Vec<Num> {
        let others = std::mem::take(&mut self.rates);
        for (a, rate) in known {
            self.set_rate(*a, *rate);
        }
        let found = of.iter().map(|a| self.rate(bench, rates, *a)).collect();
        self.rates = others;
        found
    }

    /// The rate of a number.
    pub(crate) fn rate(&mut self, bench: &mut Workbench, rates: &Rates, a: Num) -> Num {
        if self.is_constant(a) {
            return Num::ZERO;
        }
        let own = a.abs();
        let rate = match self.rates.get(&own) {
            Some(known) => *known,
            None => {
                let rate = self.step(bench, rates, own);
                self.rates.insert(own, rate);
                rate
            }
        };
        rate.signed(a.is_negative())
    }

    fn step(&mut self, bench: &mut Workbench, rates: &Rates, a: Num) -> Num {
        match self.ops[a.index()].clone() {
            Op::Sum(x, y) => {
                let (x, y) = (self.rate(bench, rates, x), self.rate(bench, rates, y));
                self.add(x, y)
            }
            Op::Product(x, y) => {
                let (dx, dy) = (self.rate(bench, rates, x), self.rate(bench, rates, y));
                let (first, second) = (self.mul(dx, y), self.mul(x, dy));
                self.add(first, second)
            }
            Op::Quotient(x, y) => {
                let (dx, dy) = (self.rate(bench, rates, x), self.rate(bench, rates, y));
                let back = self.mul(a, dy);
                let above = self.sub(dx, back);
                self.div(above, y)
            }
            Op::SquareRoot(x) => {
                let dx = self.rate(bench, rates, x);
                let two = self.number_two();
                let twice = self.mul(two, a);
                self.div(dx, twice)
            }
            Op::Expr(e) | Op::Function(e, _) => self.rate_of(bench, rates, e),
        }
    }

    /// The rate of an expression of the graph that is not looked into.
    fn rate_of(&mut self, bench: &mut Workbench, rates: &Rates, e: ExprId) -> Num {
        if let Some((_, rate)) = rates.symbols.iter().find(|(symbol, _)| *symbol == e) {
            return *rate;
        }
        match *bench.graph.node(e) {
            Node::Function(function @ (Function::Sin | Function::Cos), x) => {
                let argument = self.slope_of(bench, rates, x);
                let other = if function == Function::Sin { bench.graph.cos(x) } else { bench.graph.sin(x) };
                let other = self.import(bench, other);
                self.mul(other, argument).signed(function == Function::Cos)
            }
            _ => self.slope_of(bench, rates, e),
        }
    }

    /// `sum_i dx_i/dt d e/d x_i` by the partial derivatives of the graph.
    pub(crate) fn slope_of(&mut self, bench: &mut Workbench, rates: &Rates, e: ExprId) -> Num {
        let mut sum = Num::ZERO;
        for (symbol, rate) in &rates.symbols {
            if rate.is_zero() {
                continue;
            }
            let slope = bench.partial(e, *symbol);
            let slope = self.import(bench, slope);
            let term = self.mul(slope, *rate);
            sum = self.add(sum, term);
        }
        sum
    }
}
