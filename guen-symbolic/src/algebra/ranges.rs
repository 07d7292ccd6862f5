//! Ranges of values: which numbers an expression can be at all, from the ranges of its parts.

use super::function::{Function, Multivariate};
use super::graph::Graph;
use super::id::ExprId;
use super::map::FastMap;
use super::node::Node;
use super::rational::Rational;
use super::symbol::SignBound;

/// Powers beyond this one have no ends but zero and infinity.
const LARGEST_EXPONENT: u32 = 16;

/// An end of a range.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum End {
    Below,
    At(Rational),
    Above,
}

/// An interval: the numbers between two ends, and perhaps the ends.
#[derive(Clone, Debug)]
struct Range {
    low: End,
    high: End,
    /// Whether the lower and the upper end are left out.
    open: [bool; 2],
}

impl End {
    fn zero() -> End {
        End::At(Rational::ZERO)
    }

    fn times(&self, other: &End) -> End {
        let sign = |end: &End| end.cmp(&End::zero()) as i8;
        match (self, other) {
            (End::At(a), End::At(b)) => End::At(a * b),
            _ => match sign(self) * sign(other) {
                0 => End::zero(),
                1 => End::Above,
                _ => End::Below,
            },
        }
    }

    fn inverse(&self) -> End {
        match self {
            End::At(a) => End::At(a.recip().unwrap_or(Rational::ZERO)),
            _ => End::zero(),
        }
    }
}

impl Range {
    const ALL: Range = Range { low: End::Below, high: End::Above, open: [true, true] };

    fn closed(low: Rational, high: Rational) -> Range {
        Range { low: End::At(low), high: End::At(high), open: [false, false] }
    }

    /// The numbers from zero on, or those above.
    fn from_zero(open: bool) -> Range {
        Range { low: End::zero(), high: End::Above, open: [open, true] }
    }

    fn opposite(self) -> Range {
        let turned = |end: End| match end {
            End::Below => End::Above,
            End::Above => End::Below,
            End::At(a) => End::At(-a),
        };
        Range { low: turned(self.high), high: turned(self.low), open: [self.open[1], self.open[0]] }
    }

    fn is_above_zero(&self) -> bool {
        self.low > End::zero() || self.low == End::zero() && self.open[0]
    }

    fn is_below_zero(&self) -> bool {
        self.high < End::zero() || self.high == End::zero() && self.open[1]
    }

    fn has_zero(&self) -> bool {
        !self.is_above_zero() && !self.is_below_zero()
    }

    fn plus(&self, other: &Range) -> Range {
        let sum = |a: &End, b: &End| match (a, b) {
            (End::At(a), End::At(b)) => End::At(a + b),
            (End::At(_), infinite) | (infinite, _) => infinite.clone(),
        };
        Range {
            low: sum(&self.low, &other.low),
            high: sum(&self.high, &other.high),
            open: [0, 1].map(|end| self.open[end] || other.open[end]),
        }
    }

    fn times(&self, other: &Range) -> Range {
        let has_zero = self.has_zero() || other.has_zero();
        let ends = |range: &Range| [(range.low.clone(), range.open[0]), (range.high.clone(), range.open[1])];
        let mut products = Vec::new();
        for (a, a_open) in ends(self) {
            for (b, b_open) in ends(other) {
                let product = a.times(&b);
                let is_open = if product == End::zero() { !has_zero } else { a_open || b_open };
                products.push((product, is_open));
            }
        }
        // Of equal ends one that is taken on counts.
        let low = products.iter().min_by(|a, b| a.cmp(b)).expect("there are four");
        let high = products.iter().max_by(|a, b| a.0.cmp(&b.0).then(b.1.cmp(&a.1))).expect("there are four");
        Range { low: low.0.clone(), high: high.0.clone(), open: [low.1, high.1] }
    }

    /// The least range with both in it.
    fn hull(&self, other: &Range) -> Range {
        let low_open = match self.low.cmp(&other.low) {
            core::cmp::Ordering::Less => self.open[0],
            core::cmp::Ordering::Greater => other.open[0],
            core::cmp::Ordering::Equal => self.open[0] && other.open[0],
        };
        let high_open = match self.high.cmp(&other.high) {
            core::cmp::Ordering::Greater => self.open[1],
            core::cmp::Ordering::Less => other.open[1],
            core::cmp::Ordering::Equal => self.open[1] && other.open[1],
        };
        let low = self.low.clone().min(other.low.clone());
        let high = self.high.clone().max(other.high.clone());
        Range { low, high, open: [low_open, high_open] }
    }

    fn power(&self, exponent: i32) -> Range {
        let is_even = exponent % 2 == 0;
        if exponent < 0 {
            return match self.has_zero() {
                true if is_even => Range::from_zero(true),
                true => Range::ALL,
                false => self.power(exponent.saturating_neg()).inverse(),
            };
        }
        let size = exponent.unsigned_abs();
        if size > LARGEST_EXPONENT {
            return match () {
                () if is_even || self.is_above_zero() => Range::from_zero(!self.has_zero()),
                () if self.is_below_zero() => Range::from_zero(true).opposite(),
                () => Range::ALL,
            };
        }
        let whole = (1..size).fold(self.clone(), |power, _| power.times(self));
        if is_even && whole.low < End::zero() {
            // A number and itself have no product below zero.
            return Range { low: End::zero(), open: [false, whole.open[1]], high: whole.high };
        }
        whole
    }

    /// The inverse of what has no zero.
    fn inverse(&self) -> Range {
        let end = |end: &End, is_open: bool, infinite: End| match end {
            End::At(a) if a.is_zero() => (infinite, true),
            _ => (end.inverse(), is_open || !matches!(end, End::At(_))),
        };
        let (low, low_open) = end(&self.high, self.open[1], End::Below);
        let (high, high_open) = end(&self.low, self.open[0], End::Above);
        Range { low, high, open: [low_open, high_open] }
    }
}

impl Graph {
    /// Whether an expression is seen to vanish nowhere where it is defined: beyond
    /// [`manifestly_nonzero`](Graph::manifestly_nonzero) by the ranges of its terms, so that `sin(x) - 2` and `1/x` are. `false`
    /// means unknown.
    pub fn vanishes_nowhere(&self, id: ExprId) -> bool {
        match self.node(id) {
            Node::Kept(x) | Node::Function(Function::Root(_) | Function::Abs, x) => self.vanishes_nowhere(*x),
            Node::Product(factors) => {
                factors.iter().all(|(base, exponent)| *exponent < 0 || self.vanishes_nowhere(*base))
            }
            _ => self.manifestly_nonzero(id) || !self.range(id, &mut FastMap::default()).has_zero(),
        }
    }

    /// Whether an expression is seen to be above zero where it is defined, by the ranges of its terms.
    pub fn is_above_zero(&self, id: ExprId) -> bool {
        self.manifestly_positive(id) || self.range(id, &mut FastMap::default()).is_above_zero()
    }

    /// The signs that an expression may have where some symbols lie between numbers: an end that is `None` is infinite.
    ///
    /// ```
    /// use guen_symbolic::{Graph, PossibleSigns, Rational, Role};
    ///
    /// let mut g = Graph::new();
    /// let e = g.symbol("e", Role::Constant);
    /// let one = g.one();
    /// let rest = g.sub(one, e);
    /// let to_one = [(e, [Some(Rational::ZERO), Some(Rational::ONE)])];
    /// let never_below = PossibleSigns { below: false, zero: true, above: true };
    /// assert_eq!(g.signs_within(rest, &to_one), never_below);
    /// assert!(g.signs_within(rest, &[]).below);
    /// ```
    pub fn signs_within(&self, id: ExprId, limits: &[(ExprId, [Option<Rational>; 2])]) -> PossibleSigns {
        let mut known = FastMap::default();
        for (symbol, [low, high]) in limits {
            let open = [low.is_none(), high.is_none()];
            let low = low.clone().map_or(End::Below, End::At);
            let high = high.clone().map_or(End::Above, End::At);
            known.insert(*symbol, Range { low, high, open });
        }
        let range = self.range(id, &mut known);
        let (below, above) = (range.low < End::zero(), range.high > End::zero());
        let is_above = self.manifestly_positive(id);
        PossibleSigns { below: below && !is_above, zero: range.has_zero() && !is_above, above }
    }

    fn range(&self, id: ExprId, known: &mut FastMap<ExprId, Range>) -> Range {
        if let Some(range) = known.get(&id) {
            return range.clone();
        }
        let range = match self.node(id) {
            Node::Kept(x) => self.range(*x, known),
            Node::Number(value) => Range::closed(value.clone(), value.clone()),
            Node::Pi => Range::closed(Rational::new(31_415, 10_000), Rational::new(31_416, 10_000)),
            Node::Symbol(symbol) => match self.symbol_info(*symbol).bound {
                SignBound::Positive => Range::from_zero(true),
                SignBound::NonNegative => Range::from_zero(false),
                SignBound::Negative => Range::from_zero(true).opposite(),
                SignBound::NonPositive => Range::from_zero(false).opposite(),
                SignBound::Free | SignBound::NonZero => Range::ALL,
            },
            Node::Sum { constant, terms } => {
                let mut sum = Range::closed(constant.clone(), constant.clone());
                for (term, factor) in terms {
                    let scale = Range::closed(factor.clone(), factor.clone());
                    sum = sum.plus(&self.range(*term, known).times(&scale));
                }
                sum
            }
            Node::Product(factors) => {
                let mut product = Range::closed(Rational::ONE, Rational::ONE);
                for (base, exponent) in factors {
                    product = product.times(&self.range(*base, known).power(*exponent));
                }
                product
            }
            Node::Function(function, x) => {
                let x = self.range(*x, known);
                of_function(*function, &x)
            }
            Node::Multivariate(Multivariate::Atan2, _) => within(Rational::new(31_416, 10_000)),
            Node::Multivariate(Multivariate::Supplied { .. }, _) => Range::ALL,
            // One of them, whichever it is.
            Node::Multivariate(function, arguments) => {
                let branches =
                    if *function == Multivariate::Select { &arguments[1..] } else { &arguments[..] };
                let first = self.range(branches[0], known);
                first.hull(&self.range(branches[1], known))
            }
            Node::Undefined => Range::ALL,
        };
        known.insert(id, range.clone());
        range
    }
}

/// The signs that the values of an expression may have, as far as the ranges of its terms tell: a sign that is not among them is proved
/// never to occur.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PossibleSigns {
    /// Whether a value below zero is not excluded.
    pub below: bool,
    /// Whether zero is not excluded.
    pub zero: bool,
    /// Whether a value above zero is not excluded.
    pub above: bool,
}

/// The numbers of at most this size.
fn within(size: Rational) -> Range {
    Range::closed(-size.clone(), size)
}

/// The values of a function of what is in a range.
fn of_function(function: Function, x: &Range) -> Range {
    let sign_of_x = || match () {
        () if x.is_above_zero() => Range::from_zero(true),
        () if x.is_below_zero() => Range::from_zero(true).opposite(),
        () if x.low >= End::zero() => Range::from_zero(false),
        () if x.high <= End::zero() => Range::from_zero(false).opposite(),
        () => Range::ALL,
    };
    let half_turn = || Rational::new(15_708, 10_000);
    match function {
        Function::Sin | Function::Cos | Function::Sign => within(Rational::ONE),
        Function::Asin | Function::Atan => within(half_turn()),
        Function::Acos => Range::closed(Rational::ZERO, Rational::new(31_416, 10_000)),
        Function::Exp if x.low >= End::zero() => {
            Range { low: End::At(Rational::ONE), high: End::Above, open: [x.open[0], true] }
        }
        Function::Exp if x.high <= End::zero() => {
            Range { low: End::zero(), high: End::At(Rational::ONE), open: [true, x.open[1]] }
        }
        Function::Exp => Range::from_zero(true),
        Function::Cosh => Range { low: End::At(Rational::ONE), high: End::Above, open: [false, true] },
        Function::Tanh => Range { open: [true, true], ..within(Rational::ONE) },
        Function::Abs => Range::from_zero(!x.has_zero()),
        Function::Root(order) if order % 2 == 0 => Range::from_zero(!x.has_zero()),
        Function::Sinh | Function::Root(_) => sign_of_x(),
        Function::Floor if x.low >= End::zero() => Range::from_zero(false),
        Function::Ln | Function::Floor => Range::ALL,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::symbol::Role;

    #[test]
    fn an_end_that_is_not_taken_on_stays_so() {
        let (open, closed) = (Range::from_zero(true), Range::from_zero(false));
        assert!(open.plus(&closed).is_above_zero() && !closed.plus(&closed).is_above_zero());
        assert!(open.times(&open).is_above_zero() && !open.times(&closed).is_above_zero());
        assert!(open.clone().opposite().times(&open).is_below_zero());
    }

    #[test]
    fn even_powers_are_not_below_zero() {
        let mut graph = Graph::new();
        let x = graph.symbol("x", Role::Coordinate);
        let sine = graph.sin(x);
        let square = graph.powi(sine, 2);
        let of = |graph: &Graph, id| graph.range(id, &mut FastMap::default());
        let (found, line) = (of(&graph, square), of(&graph, x));
        assert!(found.low == End::zero() && found.high == End::At(Rational::ONE) && !found.open[0]);
        assert!(line.power(-2).is_above_zero() && line.power(-3).has_zero() && line.power(3).has_zero());
        assert!(line.power(2).has_zero() && line.power(LARGEST_EXPONENT as i32 + 2).low >= End::zero());
    }
}
