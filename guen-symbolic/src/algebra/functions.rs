//! The elementary functions: normal forms at special values, parity, and derivatives, one table each.

use super::Rational;
use super::function::{Function, Multivariate};
use super::graph::Graph;
use super::id::ExprId;
use super::node::Node;
use super::symbol::SignBound;

impl Graph {
    /// A function of one argument, in normal form.
    pub fn function(&mut self, function: Function, x: ExprId) -> ExprId {
        match function {
            Function::Sin => self.sin(x),
            Function::Cos => self.cos(x),
            Function::Exp => self.exp(x),
            Function::Root(q) => self.root(x, q),
            Function::Abs => self.abs(x),
            Function::Ln if x == self.one() => self.zero(),
            Function::Ln => match *self.node(x) {
                Node::Function(Function::Exp, inner) => inner,
                _ => self.intern(Node::Function(Function::Ln, x)),
            },
            Function::Cosh if self.is_zero(x) => self.one(),
            Function::Sign if self.manifestly_positive(x) => self.one(),
            Function::Floor => self.floor(x),
            Function::Acos => self.acos(x),
            _ if function.is_odd() && self.is_zero(x) => self.zero(),
            _ => self.with_parity(function, x),
        }
    }

    /// Sine.
    pub fn sin(&mut self, x: ExprId) -> ExprId {
        self.sin_cos(x).0
    }

    /// Cosine.
    pub fn cos(&mut self, x: ExprId) -> ExprId {
        self.sin_cos(x).1
    }

    /// Tangent, `sin/cos`.
    pub fn tan(&mut self, x: ExprId) -> ExprId {
        let (s, c) = self.sin_cos(x);
        self.div(s, c)
    }

    /// Cotangent, `cos/sin`.
    pub fn cot(&mut self, x: ExprId) -> ExprId {
        let (s, c) = self.sin_cos(x);
        self.div(c, s)
    }

    /// Square root.
    pub fn sqrt(&mut self, x: ExprId) -> ExprId {
        self.root(x, 2)
    }

    /// Sine and cosine: inverse functions in the argument and quarter turns are resolved.
    pub fn sin_cos(&mut self, x: ExprId) -> (ExprId, ExprId) {
        let (zero, one) = (self.zero(), self.one());
        if self.is_zero(x) {
            return (zero, one);
        }
        let (parts, constant) = match self.node(x) {
            Node::Sum { constant, terms } => (terms.to_vec(), constant.clone()),
            _ => (vec![(x, Rational::ONE)], Rational::ZERO),
        };
        // sin(u + v) with v an inverse function is algebraic in v: split it off.
        for (i, (term, c)) in parts.iter().enumerate() {
            if let Some(pair) = self.inverse_pair(*term)
                && let Some(multiple) = c.to_i64().filter(|k| k.abs() <= 4)
            {
                let mut rest = parts.clone();
                rest.remove(i);
                let rest = self.linear(&rest);
                let shift = self.number(constant);
                let rest = self.add(rest, shift);
                let mut turned = self.sin_cos(rest);
                for _ in 0..multiple.abs() {
                    let pair = if multiple < 0 { (self.neg(pair.0), pair.1) } else { pair };
                    turned = self.rotate(turned, pair);
                }
                return turned;
            }
        }
        // Quarter turns: sin(u + k pi/2).
        let pi = self.pi();
        if let Some(i) = parts.iter().position(|(term, _)| *term == pi) {
            let c = &parts[i].1;
            let quarters = c * &Rational::integer(2);
            let whole = floor(&quarters);
            let rest_turn = &quarters - &Rational::from_big(whole.clone(), 1.into());
            if !num_traits::Zero::is_zero(&whole) || (parts.len() == 1 && constant.is_zero()) {
                let mut rest = parts.clone();
                rest.remove(i);
                let half_turns = &rest_turn * &Rational::new(1, 2);
                let (mut s, mut c) = if rest.is_empty() && constant.is_zero() {
                    self.first_quadrant(&half_turns)
                } else {
                    rest.push((pi, half_turns));
                    let rest = self.linear(&rest);
                    let shift = self.number(constant);
                    let rest = self.add(rest, shift);
                    self.sin_cos(rest)
                };
                let quadrant = num_integer::Integer::mod_floor(&whole, &4.into());
                for _ in 0..u32::try_from(quadrant).unwrap_or(0) {
                    (s, c) = (c, self.neg(s));
                }
                return (s, c);
            }
        }
        (self.with_parity(Function::Sin, x), self.with_parity(Function::Cos, x))
    }

    /// Sine and cosine of a sum from those of its parts.
    pub(crate) fn rotate(&mut self, a: (ExprId, ExprId), b: (ExprId, ExprId)) -> (ExprId, ExprId) {
        let (ss, cc) = (self.mul(a.0, b.0), self.mul(a.1, b.1));
        let (sc, cs) = (self.mul(a.0, b.1), self.mul(a.1, b.0));
        (self.add(sc, cs), self.sub(cc, ss))
    }

    /// Sine and cosine of `turn * pi` for `0 <= turn < 1/2`.
    fn first_quadrant(&mut self, turn: &Rational) -> (ExprId, ExprId) {
        if turn.is_zero() {
            return (self.zero(), self.one());
        }
        let half = self.ratio(1, 2);
        let surd = |g: &mut Graph, n: i64| {
            let n = g.number(n);
            let root = g.sqrt(n);
            g.mul(root, half)
        };
        match turn.to_i64_pair() {
            Some((1, 6)) => (half, surd(self, 3)),
            Some((1, 3)) => (surd(self, 3), half),
            Some((1, 4)) => {
                let s = surd(self, 2);
                (s, s)
            }
            _ => {
                let pi = self.pi();
                let x = self.scale(pi, turn);
                (self.intern(Node::Function(Function::Sin, x)), self.intern(Node::Function(Function::Cos, x)))
            }
        }
    }

    /// Sine and cosine of an inverse function, which are algebraic.
    fn inverse_pair(&mut self, x: ExprId) -> Option<(ExprId, ExprId)> {
        let one = self.one();
        match *self.node(x) {
            Node::Function(Function::Atan, u) => {
                let u2 = self.powi(u, 2);
                let h2 = self.add(one, u2);
                let h = self.sqrt(h2);
                Some((self.div(u, h), self.div(one, h)))
            }
            Node::Multivariate(Multivariate::Atan2, ref arguments) => {
                let (y, x) = (arguments[0], arguments[1]);
                let (y2, x2) = (self.powi(y, 2), self.powi(x, 2));
                let h2 = self.add(y2, x2);
                let h = self.sqrt(h2);
                Some((self.div(y, h), self.div(x, h)))
            }
            Node::Function(function @ (Function::Asin | Function::Acos), u) => {
                let u2 = self.powi(u, 2);
                let v2 = self.sub(one, u2);
                let v = self.sqrt(v2);
                Some(if function == Function::Asin { (u, v) } else { (v, u) })
            }
            _ => None,
        }
    }

    /// Exponential.
    pub fn exp(&mut self, x: ExprId) -> ExprId {
        if self.is_zero(x) {
            return self.one();
        }
        match *self.node(x) {
            Node::Function(Function::Ln, inner) => inner,
            _ => self.intern(Node::Function(Function::Exp, x)),
        }
    }

    fn acos(&mut self, x: ExprId) -> ExprId {
        let value = self.as_number(x).and_then(Rational::to_i64);
        let pi = self.pi();
        match value {
            Some(1) => self.zero(),
            Some(0) => self.scale(pi, &Rational::new(1, 2)),
            Some(-1) => pi,
            _ => self.intern(Node::Function(Function::Acos, x)),
        }
    }

    /// The largest integer that is not larger: whole numbers leave it.
    fn floor(&mut self, x: ExprId) -> ExprId {
        let constant = match self.node(x) {
            Node::Number(value) => value.clone(),
            Node::Sum { constant, .. } => constant.clone(),
            _ => Rational::ZERO,
        };
        let whole = Rational::from_big(floor(&constant), 1.into());
        let whole = self.number(whole);
        if self.as_number(x).is_some() {
            return whole;
        }
        let rest = self.sub(x, whole);
        let below = self.intern(Node::Function(Function::Floor, rest));
        self.add(below, whole)
    }

    fn abs(&mut self, x: ExprId) -> ExprId {
        if let Some(value) = self.as_number(x) {
            let value = value.abs();
            return self.number(value);
        }
        if self.manifestly_nonnegative(x) {
            return x;
        }
        let negated = self.neg(x);
        if self.manifestly_nonnegative(negated) {
            return negated;
        }
        self.with_parity(Function::Abs, x)
    }

    /// The real root of order `q`; squares of manifestly nonnegative factors leave even roots.
    pub fn root(&mut self, x: ExprId, q: u32) -> ExprId {
        if q == 1 || self.is_zero(x) || x == self.one() {
            return x;
        }
        let (coefficient, monomial) = match self.node(x) {
            Node::Sum { .. } => self.split_content(x),
            _ => self.split_coefficient(x),
        };
        if q % 2 == 1 {
            if coefficient.is_negative() {
                let positive = self.neg(x);
                let root = self.root(positive, q);
                return self.neg(root);
            }
        } else if coefficient.is_negative() {
            return self.intern(Node::Function(Function::Root(q), x));
        }
        let (outer, inner_coefficient) = split_power(&coefficient, q);
        let factors = match self.node(monomial) {
            Node::Product(factors) => factors.to_vec(),
            Node::Number(_) => Vec::new(),
            _ => vec![(monomial, 1)],
        };
        let mut outside = Vec::new();
        let mut inside = Vec::new();
        for (base, e) in factors {
            let whole = e.div_euclid(q as i32);
            if whole != 0 && (q % 2 == 1 || self.manifestly_nonnegative(base)) {
                outside.push((base, whole));
                inside.push((base, e - whole * q as i32));
            } else {
                inside.push((base, e));
            }
        }
        let inside = self.product(&inside);
        let inside = self.scale(inside, &inner_coefficient);
        let root = if inside == self.one() {
            inside
        } else {
            self.intern(Node::Function(Function::Root(q), inside))
        };
        outside.push((root, 1));
        let product = self.product(&outside);
        self.scale(product, &outer)
    }

    fn with_parity(&mut self, function: Function, x: ExprId) -> ExprId {
        if !function.is_odd() && !function.is_even() {
            return self.intern(Node::Function(function, x));
        }
        let negative = match self.node(x) {
            Node::Number(value) => value.is_negative(),
            Node::Sum { terms, .. } => terms[0].1.is_negative(),
            _ => false,
        };
        if !negative {
            return self.intern(Node::Function(function, x));
        }
        let x = self.neg(x);
        let value = self.intern(Node::Function(function, x));
        if function.is_odd() { self.neg(value) } else { value }
    }

    /// The derivative of a function at `x`, given the function's own node.
    pub(crate) fn function_derivative(&mut self, function: Function, x: ExprId, value: ExprId) -> ExprId {
        let one = self.one();
        match function {
            Function::Sin => self.cos(x),
            Function::Cos => {
                let s = self.sin(x);
                self.neg(s)
            }
            Function::Asin | Function::Acos => {
                let x2 = self.powi(x, 2);
                let rest = self.sub(one, x2);
                let root = self.sqrt(rest);
                let slope = self.powi(root, -1);
                if function == Function::Asin { slope } else { self.neg(slope) }
            }
            Function::Atan => {
                let x2 = self.powi(x, 2);
                let h2 = self.add(one, x2);
                self.powi(h2, -1)
            }
            Function::Exp => value,
            Function::Ln => self.powi(x, -1),
            Function::Sinh => self.function(Function::Cosh, x),
            Function::Cosh => self.function(Function::Sinh, x),
            Function::Tanh => {
                let squared = self.powi(value, 2);
                self.sub(one, squared)
            }
            Function::Abs => self.function(Function::Sign, x),
            Function::Sign | Function::Floor => self.zero(),
            Function::Root(q) => {
                let slope = self.product(&[(value, 1), (x, -1)]);
                self.scale(slope, &Rational::new(1, q.into()))
            }
        }
    }

    /// Whether an expression is seen to be at least zero wherever it is defined; `false` means unknown.
    pub fn manifestly_nonnegative(&self, id: ExprId) -> bool {
        match self.node(id) {
            Node::Kept(x) => self.manifestly_nonnegative(*x),
            Node::Number(value) => !value.is_negative(),
            Node::Symbol(symbol) => {
                matches!(self.symbol_info(*symbol).bound, SignBound::Positive | SignBound::NonNegative)
            }
            Node::Sum { constant, terms } => {
                !constant.is_negative()
                    && terms.iter().all(|(term, c)| {
                        if c.is_negative() {
                            self.manifestly_nonpositive_symbol(*term)
                        } else {
                            self.manifestly_nonnegative(*term)
                        }
                    })
            }
            Node::Product(factors) => {
                factors.iter().all(|(base, e)| e % 2 == 0 || self.manifestly_nonnegative(*base))
            }
            Node::Pi => true,
            Node::Function(Function::Exp | Function::Cosh | Function::Abs | Function::Acos, _) => true,
            Node::Function(Function::Root(q), _) => q % 2 == 0,
            Node::Function(Function::Floor, x) => self.manifestly_nonnegative(*x),
            Node::Multivariate(Multivariate::Select, arguments) => {
                self.manifestly_nonnegative(arguments[1]) && self.manifestly_nonnegative(arguments[2])
            }
            Node::Multivariate(Multivariate::Minimum, arguments) => {
                arguments.iter().all(|e| self.manifestly_nonnegative(*e))
            }
            Node::Multivariate(Multivariate::Maximum, arguments) => {
                arguments.iter().any(|e| self.manifestly_nonnegative(*e))
            }
            _ => false,
        }
    }

    fn manifestly_nonpositive_symbol(&self, id: ExprId) -> bool {
        self.as_symbol(id).is_some_and(|s| {
            matches!(self.symbol_info(s).bound, SignBound::Negative | SignBound::NonPositive)
        })
    }

    /// Whether an expression is seen to be above zero wherever it is defined; `false` means unknown.
    pub fn manifestly_positive(&self, id: ExprId) -> bool {
        match self.node(id) {
            Node::Kept(x) => self.manifestly_positive(*x),
            Node::Number(value) => !value.is_negative() && !value.is_zero(),
            Node::Symbol(symbol) => self.symbol_info(*symbol).bound == SignBound::Positive,
            Node::Sum { constant, terms } => {
                self.manifestly_nonnegative(id)
                    && (!constant.is_zero()
                        || terms.iter().any(|(term, c)| !c.is_negative() && self.manifestly_positive(*term)))
            }
            Node::Product(factors) => {
                self.manifestly_nonnegative(id)
                    && factors.iter().all(|(base, _)| self.manifestly_nonzero(*base))
            }
            Node::Pi | Node::Function(Function::Exp | Function::Cosh, _) => true,
            Node::Function(Function::Root(_), x) => self.manifestly_positive(*x),
            Node::Multivariate(Multivariate::Select, arguments) => {
                self.manifestly_positive(arguments[1]) && self.manifestly_positive(arguments[2])
            }
            Node::Multivariate(Multivariate::Minimum, arguments) => {
                arguments.iter().all(|e| self.manifestly_positive(*e))
            }
            Node::Multivariate(Multivariate::Maximum, arguments) => {
                arguments.iter().any(|e| self.manifestly_positive(*e))
            }
            _ => false,
        }
    }

    /// Whether an expression is seen to vanish nowhere; `false` means unknown. This licenses pivots.
    pub fn manifestly_nonzero(&self, id: ExprId) -> bool {
        match self.node(id) {
            Node::Kept(x) => self.manifestly_nonzero(*x),
            Node::Number(value) => !value.is_zero(),
            Node::Symbol(symbol) => {
                matches!(
                    self.symbol_info(*symbol).bound,
                    SignBound::Positive | SignBound::Negative | SignBound::NonZero
                )
            }
            Node::Sum { constant, terms } if constant.is_zero() && terms.len() == 1 => {
                self.manifestly_nonzero(terms[0].0)
            }
            Node::Product(factors) => factors.iter().all(|(base, _)| self.manifestly_nonzero(*base)),
            Node::Function(Function::Root(_) | Function::Abs, x) => self.manifestly_nonzero(*x),
            _ => self.manifestly_positive(id),
        }
    }
}

/// The largest integer not above a rational number.
fn floor(value: &Rational) -> num_bigint::BigInt {
    let (n, d) = value.to_big_pair();
    num_integer::Integer::div_floor(&n, &d)
}

/// `c = outer^q * inner` with as much as is quickly found in `outer`.
fn split_power(c: &Rational, q: u32) -> (Rational, Rational) {
    // Enough for the surds that people write; larger factors stay under the root.
    const LARGEST_TRIAL: i64 = 100;
    if let Some(root) = c.exact_root(q) {
        return (root, Rational::ONE);
    }
    let Some((n, d)) = c.to_i64_pair() else { return (Rational::ONE, c.clone()) };
    let split = |mut n: i64| {
        let mut outer = 1_i64;
        for p in 2..=LARGEST_TRIAL {
            let Some(power) = p.checked_pow(q) else { break };
            while n % power == 0 {
                n /= power;
                outer *= p;
            }
        }
        (outer, n)
    };
    let ((no, ni), (d_o, di)) = (split(n), split(d));
    (Rational::new(no, d_o), Rational::new(ni, di))
}
