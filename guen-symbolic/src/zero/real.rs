//! Values at real points: plain evaluation in any real arithmetic, and points in about 200 bits with error bounds.

use core::ops::{Add, Div, Mul, Neg, Sub};

use f256::f256;

use crate::algebra::{
    ExprId, FastMap, Function, Graph, Multivariate, Node, Rational, Role, SignBound, SymbolId, mix,
};

/// The operations that evaluation needs of a kind of real number.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The nearest value.
    fn rational(value: &Rational) -> Self;
    /// The number pi.
    fn pi() -> Self;
    /// An integer power.
    fn power(self, n: i32) -> Self;
    /// An elementary function.
    fn of(self, function: Function) -> Self;
    /// The angle of the point `(x, self)`.
    fn angle(self, x: Self) -> Self;
    /// `above` where this is at least zero, `below` elsewhere.
    fn choose(self, above: Self, below: Self) -> Self;
}

impl Real for f64 {
    fn rational(value: &Rational) -> Self {
        value.to_f64()
    }

    fn pi() -> Self {
        core::f64::consts::PI
    }

    fn power(self, n: i32) -> Self {
        self.powi(n)
    }

    fn of(self, function: Function) -> Self {
        match function {
            Function::Sin => self.sin(),
            Function::Cos => self.cos(),
            Function::Asin => self.asin(),
            Function::Acos => self.acos(),
            Function::Atan => self.atan(),
            Function::Exp => self.exp(),
            Function::Ln => self.ln(),
            Function::Sinh => self.sinh(),
            Function::Cosh => self.cosh(),
            Function::Tanh => self.tanh(),
            Function::Abs => self.abs(),
            Function::Sign if self == 0.0 => 0.0,
            Function::Sign => self.signum(),
            Function::Floor => self.floor(),
            Function::Root(2) => self.sqrt(),
            Function::Root(3) => self.cbrt(),
            Function::Root(q) if q % 2 == 1 => self.abs().powf(1.0 / f64::from(q)).copysign(self),
            Function::Root(q) => self.powf(1.0 / f64::from(q)),
        }
    }

    fn angle(self, x: Self) -> Self {
        self.atan2(x)
    }

    fn choose(self, above: Self, below: Self) -> Self {
        if self >= 0.0 { above } else { below }
    }
}

impl Real for f256 {
    fn rational(value: &Rational) -> Self {
        if let Some((n, d)) = value.to_i64_pair() {
            let n = f256::from(n);
            return if d == 1 { n } else { n / f256::from(d) };
        }
        let (n, d) = value.to_big_pair();
        let word = f256::from(u64::MAX) + f256::ONE;
        let magnitude = |x: &num_bigint::BigInt| {
            x.magnitude()
                .iter_u64_digits()
                .rev()
                .fold(f256::ZERO, |sum, digit| sum * word + f256::from(digit))
        };
        let ratio = magnitude(&n) / magnitude(&d);
        if value.is_negative() { -ratio } else { ratio }
    }

    fn pi() -> Self {
        ::f256::consts::PI
    }

    fn power(self, n: i32) -> Self {
        let mut base = if n < 0 { f256::ONE / self } else { self };
        let mut n = n.unsigned_abs();
        let mut result = f256::ONE;
        while n > 0 {
            if n & 1 == 1 {
                result *= base;
            }
            n >>= 1;
            if n > 0 {
                base *= base;
            }
        }
        result
    }

    fn of(self, function: Function) -> Self {
        match function {
            Function::Sin => self.sin(),
            Function::Cos => self.cos(),
            Function::Asin => f256::asin(&self),
            Function::Acos => f256::acos(&self),
            Function::Atan => f256::atan(&self),
            Function::Exp => f256::exp(&self),
            Function::Ln => f256::ln(&self),
            // Differences of exponentials would cancel near zero, and `e + 1` for large negative arguments.
            Function::Sinh => {
                let e = f256::exp_m1(&f256::abs(&self));
                ((e + e / (e + f256::ONE)) / f256::TWO).copysign(self)
            }
            Function::Cosh => {
                let e = f256::exp(&self);
                (e + f256::ONE / e) / f256::TWO
            }
            Function::Tanh => {
                let e = f256::exp_m1(&(self + self));
                e / (e + f256::TWO)
            }
            Function::Abs => f256::abs(&self),
            Function::Sign if self.eq_zero() => f256::ZERO,
            Function::Sign => f256::ONE.copysign(self),
            Function::Floor => f256::floor(&self),
            Function::Root(2) => f256::sqrt(self),
            Function::Root(q) => {
                if self.eq_zero() || (q % 2 == 0 && self < f256::ZERO) {
                    return f256::sqrt(self);
                }
                let size = f256::exp(&(f256::ln(&f256::abs(&self)) / f256::from(q)));
                size.copysign(self)
            }
        }
    }

    fn angle(self, x: Self) -> Self {
        f256::atan2(&self, &x)
    }

    fn choose(self, above: Self, below: Self) -> Self {
        if self >= f256::ZERO { above } else { below }
    }
}

/// The values of expressions at given values of the symbols; not finite outside the domain.
pub fn evaluate<R: Real>(graph: &Graph, roots: &[ExprId], values: &dyn Fn(SymbolId) -> R) -> Vec<R> {
    let order = graph.reachable(roots, |_| false);
    evaluate_in(graph, &order, roots, values)
}

/// Evaluates expressions, given all their nodes in an order in which they can be evaluated: for many evaluations.
pub(super) fn evaluate_in<R: Real>(
    graph: &Graph,
    order: &[ExprId],
    roots: &[ExprId],
    values: &dyn Fn(SymbolId) -> R,
) -> Vec<R> {
    let mut known: FastMap<ExprId, R> = FastMap::default();
    for id in order.iter().copied() {
        let value = match graph.node(id) {
            Node::Number(value) => R::rational(value),
            Node::Pi => R::pi(),
            Node::Undefined => R::rational(&Rational::ONE) / R::rational(&Rational::ZERO),
            Node::Symbol(symbol) => values(*symbol),
            Node::Sum { constant, terms } => {
                terms.iter().fold(R::rational(constant), |sum, (term, c)| sum + R::rational(c) * known[term])
            }
            Node::Product(factors) => factors
                .iter()
                .fold(R::rational(&Rational::ONE), |product, (base, e)| product * known[base].power(*e)),
            Node::Function(function, x) => known[x].of(*function),
            Node::Kept(x) => known[x],
            Node::Multivariate(function, arguments) => {
                let arguments: Vec<R> = arguments.iter().map(|e| known[e]).collect();
                apply(*function, &arguments)
            }
        };
        known.insert(id, value);
    }
    roots.iter().map(|root| known[root]).collect()
}

/// The values of expressions in double precision.
pub fn evaluate_f64(graph: &Graph, roots: &[ExprId], values: &dyn Fn(SymbolId) -> f64) -> Vec<f64> {
    evaluate(graph, roots, values)
}

/// The relative error of one operation, as a power of two; the format has 237 bits.
const ROUNDING: f64 = -232.0;

/// The relative error of a symbol that a constraint determines, as a power of two.
const SOLVED: f64 = -205.0;

/// A value below `2^DISTINCT` times its error bound is not told from zero.
const DISTINCT: f64 = 20.0;

/// A value whose error bound exceeds this many bits relative to the terms it came from says nothing.
const USELESS_BOUND: f64 = -150.0;

/// The power of two of a finite number, rounded down; minus infinity for zero.
pub(super) fn exponent(x: f256) -> f64 {
    const FRACTION_BITS: u32 = 108;
    const BIAS: i32 = 262_143;
    if x.eq_zero() {
        return f64::NEG_INFINITY;
    }
    f64::from(((x.to_bits().0 >> FRACTION_BITS) & 0x7_ffff) as i32 - BIAS)
}

/// `log2(2^a + 2^b)`.
fn plus(a: f64, b: f64) -> f64 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    if low == f64::NEG_INFINITY { high } else { high + (low - high).exp2().ln_1p() / core::f64::consts::LN_2 }
}

/// A function of several arguments; a smooth function stands in for one that the program supplies.
pub(crate) fn apply<R: Real>(function: Multivariate, arguments: &[R]) -> R {
    match (function, arguments) {
        (Multivariate::Supplied { function, orders }, _) => stand_in(function, &orders, arguments),
        (Multivariate::Atan2, [y, x]) => y.angle(*x),
        (Multivariate::Select, [c, a, b]) => c.choose(*a, *b),
        (Multivariate::Maximum, [a, b]) => (*a - *b).choose(*a, *b),
        (Multivariate::Minimum, [a, b]) => (*a - *b).choose(*b, *a),
        _ => unreachable!("the number of arguments is checked"),
    }
}

/// The derivative of a smooth function that stands in for one that the program supplies: a sine of a linear function whose
/// coefficients lie between one and two.
fn stand_in<R: Real>(function: u16, orders: &[u8], arguments: &[R]) -> R {
    let mut angle = R::rational(&Rational::new(i64::from(function) * 7 + 3, 10));
    let mut factor = R::rational(&Rational::ONE);
    let mut order = 0;
    for (place, (x, times)) in arguments.iter().zip(orders).enumerate() {
        let slope = R::rational(&Rational::new(17 + 2 * place as i64 + i64::from(function) % 3, 16));
        angle = angle + slope * *x;
        factor = factor * slope.power(i32::from(*times));
        order += u32::from(*times);
    }
    let value = match order % 4 {
        0 => angle.of(Function::Sin),
        1 => angle.of(Function::Cos),
        2 => -angle.of(Function::Sin),
        _ => -angle.of(Function::Cos),
    };
    factor * value
}

/// A value with the power of two that bounds its absolute error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    value: f256,
    error: f64,
}

impl Ball {
    fn exact(value: f256) -> Self {
        Ball { value, error: f64::NEG_INFINITY }
    }

    fn rounded(value: f256) -> Self {
        Ball { value, error: exponent(value) + 1.0 + ROUNDING }
    }

    fn is_distinct(self) -> bool {
        exponent(self.value) > self.error + DISTINCT
    }

    /// Whether two values are clearly not the same.
    pub(super) fn differs(self, other: Ball) -> bool {
        self.minus(other).is_distinct()
    }

    fn minus(self, other: Ball) -> Ball {
        let value = self.value - other.value;
        let rounding = exponent(self.value).max(exponent(other.value)) + 2.0 + ROUNDING;
        Ball { value, error: plus(plus(self.error, other.error), rounding) }
    }

    fn times(self, other: Ball) -> Ball {
        let value = self.value * other.value;
        let carried = plus(
            self.error + plus(exponent(other.value) + 1.0, other.error),
            other.error + exponent(self.value) + 1.0,
        );
        Ball { value, error: plus(carried, exponent(value) + 1.0 + ROUNDING) }
    }

    /// The quotient by a value that is distinct from zero.
    fn over(self, other: Ball) -> Ball {
        let value = self.value / other.value;
        let divisor = exponent(other.value);
        let carried = plus(self.error - divisor, exponent(value) + 1.0 + other.error - divisor) + 1.0;
        Ball { value, error: plus(carried, exponent(value) + 1.0 + ROUNDING) }
    }
}

/// The verdict of a real point on a value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sighting {
    /// Clearly not zero.
    Nonzero,
    /// Zero to all digits that are left.
    Small,
    /// Outside the domain, or no digits are left.
    Nothing,
}

/// The rank of a matrix at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct RealRank {
    /// The rank is no smaller.
    pub(super) rank: usize,
    /// Whether it is no larger: all that is left is zero to all digits.
    pub(super) is_certain: bool,
}

/// A random point of the domain.
#[derive(Debug, Default)]
pub(super) struct RealPoint {
    seed: u64,
    scale: f64,
    signs: u64,
    round: u64,
    pub(super) fixed: FastMap<SymbolId, f256>,
    memo: FastMap<ExprId, Option<Ball>>,
}

impl RealPoint {
    /// The point of a number: sizes vary, and signs take turns.
    pub(super) fn new(number: u64) -> Self {
        // Inverse functions want small arguments, differences under roots want unequal ones.
        const SCALES: [f64; 5] = [1.0, 0.4, 2.5, 0.15, 6.0];
        RealPoint {
            seed: mix(number ^ 0x7265_616c),
            scale: SCALES[(number % 5) as usize],
            signs: number % 4,
            round: number / 4,
            ..RealPoint::default()
        }
    }

    /// The value of a symbol.
    pub(super) fn symbol(&self, graph: &Graph, symbol: SymbolId) -> f256 {
        self.fixed.get(&symbol).copied().unwrap_or_else(|| f256::from(self.draw(graph, symbol)))
    }

    /// The drawn value of a symbol, which has few digits and is exact.
    pub(super) fn draw(&self, graph: &Graph, symbol: SymbolId) -> f64 {
        let bits = mix(self.seed ^ mix(symbol.index() as u64));
        let coin = mix(symbol.index() as u64 ^ self.round) & 1 == 1;
        let size = self.scale * (0.2 + 1.3 * ((bits >> 12) as f64 / (1_u64 << 52) as f64));
        let negative = match graph.symbol_info(symbol).bound {
            SignBound::Positive | SignBound::NonNegative => false,
            SignBound::Negative | SignBound::NonPositive => true,
            // Mixed, all positive, mixed the other way, all negative.
            SignBound::Free | SignBound::NonZero => match self.signs {
                0 => coin,
                1 => false,
                2 => !coin,
                _ => true,
            },
        };
        if negative { -size } else { size }
    }

    /// The value of an expression at the point of a number, with the constants of the first; `None` outside its domain.
    pub(super) fn with_first_constants(graph: &Graph, e: ExprId, number: u64) -> Option<Ball> {
        let (mut point, first) = (RealPoint::new(number), RealPoint::new(0));
        let symbols = graph.symbols_in(&[e]);
        let constants = symbols.into_iter().filter(|s| graph.symbol_info(*s).role == Role::Constant);
        point.fixed = constants.map(|s| (s, f256::from(first.draw(graph, s)))).collect();
        point.ball(graph, e)
    }

    /// The value of an expression; `None` outside its domain.
    fn ball(&mut self, graph: &Graph, e: ExprId) -> Option<Ball> {
        for id in graph.reachable(&[e], |id| self.memo.contains_key(&id)) {
            let ball = self.step(graph, id).filter(|ball| ball.value.is_finite() && !ball.error.is_nan());
            self.memo.insert(id, ball);
        }
        self.memo[&e]
    }

    /// The rank of a matrix as far as this point shows it: the number of rows with an entry that is clearly not zero, beside those
    /// before; `None` where an entry has no value.
    pub(super) fn rank(&mut self, graph: &Graph, rows: &[Vec<ExprId>]) -> Option<RealRank> {
        let values = rows.iter().map(|row| row.iter().map(|e| self.ball(graph, *e)).collect());
        let mut rows = values.collect::<Option<Vec<Vec<Ball>>>>()?;
        let mut rank = 0;
        while let Some((place, column)) = rows.iter().enumerate().find_map(|(place, row)| {
            row.iter().position(|entry| entry.is_distinct()).map(|column| (place, column))
        }) {
            rank += 1;
            let row = rows.swap_remove(place);
            for other in &mut rows {
                let factor = other[column].over(row[column]);
                for (entry, own) in other.iter_mut().zip(&row) {
                    *entry = entry.minus(factor.times(*own));
                }
            }
        }
        let is_certain = rows.iter().flatten().all(|entry| entry.error < USELESS_BOUND);
        Some(RealRank { rank, is_certain })
    }

    /// Returns the verdict of this point on an expression.
    pub(super) fn sight(&mut self, graph: &Graph, e: ExprId) -> Sighting {
        match self.ball(graph, e) {
            None => Sighting::Nothing,
            Some(ball) if ball.is_distinct() => Sighting::Nonzero,
            Some(ball) if ball.error < USELESS_BOUND => Sighting::Small,
            Some(_) => Sighting::Nothing,
        }
    }

    fn step(&self, graph: &Graph, id: ExprId) -> Option<Ball> {
        let at = |id: ExprId| self.memo[&id];
        match graph.node(id) {
            Node::Undefined => None,
            Node::Number(value) => Some(Ball::rounded(f256::rational(value))),
            Node::Pi => Some(Ball::rounded(f256::pi())),
            Node::Symbol(symbol) => Some(match self.fixed.get(symbol) {
                Some(value) => Ball { value: *value, error: exponent(*value).max(-20.0) + SOLVED },
                None => Ball::exact(self.symbol(graph, *symbol)),
            }),
            Node::Sum { constant, terms } => {
                let mut sum = Ball::rounded(f256::rational(constant));
                for (term, c) in terms {
                    let term = at(*term)?;
                    let c = f256::rational(c);
                    let product = c * term.value;
                    sum.value += product;
                    sum.error = plus(sum.error, term.error + exponent(c) + 1.0);
                    sum.error = plus(sum.error, exponent(product).max(exponent(sum.value)) + 2.0 + ROUNDING);
                }
                Some(sum)
            }
            Node::Product(factors) => {
                let mut value = f256::ONE;
                let mut relative = f64::NEG_INFINITY;
                for (base, e) in factors {
                    let base = at(*base)?;
                    if *e < 0 && !base.is_distinct() {
                        return None;
                    }
                    value *= base.value.power(*e);
                    let own = plus(base.error - exponent(base.value), ROUNDING);
                    relative = plus(relative, own + f64::from(e.unsigned_abs()).log2() + 1.0);
                }
                if value.eq_zero() {
                    return self.vanishing_product(factors);
                }
                Some(Ball { value, error: exponent(value) + 1.0 + relative })
            }
            Node::Function(function, x) => function_ball(*function, at(*x)?),
            Node::Kept(x) => at(*x),
            Node::Multivariate(Multivariate::Supplied { function, orders }, arguments) => {
                let arguments: Vec<Ball> = arguments.iter().map(|e| at(*e)).collect::<Option<_>>()?;
                let values: Vec<f256> = arguments.iter().map(|x| x.value).collect();
                // Slopes of the stand-in are below a power of two for each order.
                let order: u32 = orders.iter().map(|order| u32::from(*order)).sum();
                let carried = arguments.iter().fold(f64::NEG_INFINITY, |sum, x| plus(sum, x.error));
                let size = values.iter().fold(0.0, |size: f64, x| size.max(exponent(*x)));
                let error = plus(carried, size + 4.0 + ROUNDING) + f64::from(order) + 2.0;
                Some(Ball { value: stand_in(*function, orders, &values), error })
            }
            Node::Multivariate(Multivariate::Select, arguments) => {
                let c = at(arguments[0])?;
                if !c.is_distinct() {
                    return None;
                }
                at(if c.value >= f256::ZERO { arguments[1] } else { arguments[2] })
            }
            Node::Multivariate(function @ (Multivariate::Minimum | Multivariate::Maximum), arguments) => {
                let (a, b) = (at(arguments[0])?, at(arguments[1])?);
                let larger = (a.value >= b.value) == (*function == Multivariate::Maximum);
                Some(Ball { value: if larger { a.value } else { b.value }, error: plus(a.error, b.error) })
            }
            Node::Multivariate(Multivariate::Atan2, arguments) => {
                let (y, x) = (at(arguments[0])?, at(arguments[1])?);
                let radius = exponent(x.value).max(exponent(y.value));
                let error = plus(y.error, x.error);
                let off_cut = y.is_distinct() || x.is_distinct() && x.value > f256::ZERO;
                if !off_cut || radius <= error + DISTINCT {
                    return None;
                }
                let value = y.value.angle(x.value);
                Some(Ball { value, error: plus(error - radius + 1.0, exponent(value) + 2.0 + ROUNDING) })
            }
        }
    }

    /// The bound of a product with a factor that is zero: the other factors times that factor's error.
    fn vanishing_product(&self, factors: &[(ExprId, i32)]) -> Option<Ball> {
        let mut error = 0.0;
        for (base, e) in factors {
            let base = self.memo[base]?;
            error += f64::from(*e) * plus(exponent(base.value) + 1.0, base.error);
        }
        Some(Ball { value: f256::ZERO, error })
    }
}

/// A function of a value with its error bound; `None` outside the domain or too near its edge.
fn function_ball(function: Function, x: Ball) -> Option<Ball> {
    let size = exponent(x.value);
    let relative = x.error - size;
    let value = x.value.of(function);
    if !value.is_finite() {
        return None;
    }
    let own = exponent(value) + 2.0 + ROUNDING;
    let carried = match function {
        // Reducing the argument costs the bits of its size.
        Function::Sin | Function::Cos => plus(x.error, size.max(0.0) + ROUNDING),
        Function::Atan | Function::Tanh | Function::Abs => x.error,
        Function::Asin | Function::Acos => {
            let rest = f256::ONE - x.value * x.value;
            if exponent(rest) < x.error + DISTINCT {
                return None;
            }
            x.error - exponent(rest) / 2.0 + 1.0
        }
        Function::Exp | Function::Sinh | Function::Cosh => {
            exponent(value).max(0.0).max(size) + plus(x.error, size.max(0.0) + ROUNDING) + 1.0
        }
        Function::Ln if relative > -DISTINCT => return None,
        Function::Ln => relative + 1.0,
        // Next to a whole number it may be this one or the one before.
        Function::Floor if exponent(x.value - value) < x.error + DISTINCT => return None,
        Function::Floor if exponent(value + f256::ONE - x.value) < x.error + DISTINCT => return None,
        Function::Floor => f64::NEG_INFINITY,
        Function::Sign if relative > -DISTINCT => return None,
        Function::Sign => f64::NEG_INFINITY,
        Function::Root(_) if relative > -DISTINCT => return None,
        Function::Root(2) => exponent(value) + relative + 1.0,
        // By logarithm and exponential.
        Function::Root(_) => exponent(value) + plus(relative, size.abs().max(1.0).log2() + ROUNDING) + 2.0,
    };
    Some(Ball { value, error: plus(own, carried) })
}
