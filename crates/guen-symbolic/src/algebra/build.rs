//! Building expressions in normal form: sums, products, powers.
//!
//! A sum lists its terms once each, with exact coefficients; a product lists its bases once each, with
//! integer exponents, and carries no number: numbers belong to the sums above. Sums inside products are
//! primitive (content one, first coefficient positive). Nothing distributes products over sums.

use std::collections::BTreeMap;

use super::graph::{ExprId, Graph, Node, PowerError};
use super::{Function, Rational};

/// Sums with more terms stay nested: flattening them would copy their terms into every user.
const FLATTEN_TERMS: usize = 8;

/// Integer powers beyond this are refused where they are written.
pub(crate) const MAX_EXPONENT: i64 = 64;

/// Numbers with more bits than this (about 10^400) are refused where they are written.
const MAX_NUMBER_BITS: u64 = 1330;

/// The terms `c m sin(x)^2` and `c m cos(x)^2` of a sum, and the factors of `m`.
type SquarePair = (ExprId, ExprId, Vec<(ExprId, i32)>);

impl Graph {
    /// An exact number.
    pub fn number(&mut self, value: impl Into<Rational>) -> ExprId {
        self.intern(Node::Number(value.into()))
    }

    /// The ratio of two integers.
    pub fn ratio(&mut self, numerator: i64, denominator: i64) -> ExprId {
        self.number(Rational::new(numerator, denominator))
    }

    /// The number pi.
    pub fn pi(&mut self) -> ExprId {
        self.intern(Node::Pi)
    }

    /// `a + b`.
    pub fn add(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if self.is_zero(a) {
            return b;
        }
        if self.is_zero(b) {
            return a;
        }
        self.linear(&[(a, Rational::ONE), (b, Rational::ONE)])
    }

    /// `a - b`.
    pub fn sub(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if self.is_zero(b) {
            return a;
        }
        self.linear(&[(a, Rational::ONE), (b, Rational::MINUS_ONE)])
    }

    /// `-a`.
    pub fn neg(&mut self, a: ExprId) -> ExprId {
        self.scale(a, &Rational::MINUS_ONE)
    }

    /// `factor * a`.
    pub fn scale(&mut self, a: ExprId, factor: &Rational) -> ExprId {
        self.linear(&[(a, factor.clone())])
    }

    /// The sum of many expressions.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = ExprId>) -> ExprId {
        let terms: Vec<_> = terms.into_iter().map(|term| (term, Rational::ONE)).collect();
        self.linear(&terms)
    }

    /// `sum coefficient * term`, in normal form.
    pub fn linear(&mut self, terms: &[(ExprId, Rational)]) -> ExprId {
        let mut constant = Rational::ZERO;
        let mut collected: BTreeMap<(u64, ExprId), Rational> = BTreeMap::new();
        let mut add = |graph: &Graph, id: ExprId, c: &Rational| {
            let slot = collected.entry(graph.key(id)).or_default();
            *slot = &*slot + c;
        };
        for (id, coefficient) in terms {
            if coefficient.is_zero() {
                continue;
            }
            match self.node(*id) {
                Node::Undefined => return *id,
                Node::Number(value) => constant = constant + value * coefficient,
                Node::Sum { constant: inner, terms } if terms.len() <= FLATTEN_TERMS => {
                    constant = constant + inner * coefficient;
                    for (term, c) in terms {
                        add(self, *term, &(c * coefficient));
                    }
                }
                Node::Sum { .. } => {
                    let (content, primitive) = self.split_content(*id);
                    add(self, primitive, &(&content * coefficient));
                }
                _ => add(self, *id, coefficient),
            }
        }
        collected.retain(|_, c| !c.is_zero());
        self.fold_squares(&mut collected, &mut constant);
        self.finish_sum(constant, collected)
    }

    fn finish_sum(&mut self, constant: Rational, collected: BTreeMap<(u64, ExprId), Rational>) -> ExprId {
        if collected.is_empty() {
            return self.intern(Node::Number(constant));
        }
        let terms: Box<[_]> = collected.into_iter().map(|((_, id), c)| (id, c)).collect();
        if terms.len() == 1 && constant.is_zero() {
            let (id, c) = &terms[0];
            if c.is_one() {
                return *id;
            }
            // A multiple of a nested sum is that sum with other coefficients if it is short.
            if let Node::Sum { constant: inner, terms: inner_terms } = self.node(*id)
                && inner_terms.len() <= FLATTEN_TERMS
            {
                let constant = inner * c;
                let terms = inner_terms.iter().map(|(term, k)| (*term, k * c)).collect();
                return self.intern(Node::Sum { constant, terms });
            }
        }
        self.intern(Node::Sum { constant, terms })
    }

    /// `c m sin(x)^2 + c m cos(x)^2 = c m`, for as long as such a pair is left.
    fn fold_squares(&mut self, collected: &mut BTreeMap<(u64, ExprId), Rational>, constant: &mut Rational) {
        while let Some((sine_term, cosine_term, rest)) = self.square_pair(collected) {
            let c = collected.remove(&self.key(sine_term)).expect("the pair comes from this map");
            collected.remove(&self.key(cosine_term));
            let rest = self.product(&rest);
            let (inner, terms) = match self.node(rest) {
                Node::Number(value) => (value.clone(), Vec::new()),
                Node::Sum { constant, terms } => (constant.clone(), terms.to_vec()),
                _ => (Rational::ZERO, vec![(rest, Rational::ONE)]),
            };
            *constant = &*constant + &(&inner * &c);
            for (term, k) in terms {
                let slot = collected.entry(self.key(term)).or_default();
                *slot = &*slot + &(&k * &c);
            }
            collected.retain(|_, c| !c.is_zero());
        }
    }

    /// Two terms `c m sin(x)^2` and `c m cos(x)^2` with the same `c`, and the factors of `m`.
    fn square_pair(&self, collected: &BTreeMap<(u64, ExprId), Rational>) -> Option<SquarePair> {
        if collected.len() < 2 {
            return None;
        }
        for ((_, id), c) in collected {
            let Node::Product(factors) = self.node(*id) else { continue };
            for (i, (base, e)) in factors.iter().enumerate() {
                let Node::Function(Function::Sin, x) = *self.node(*base) else { continue };
                if *e < 2 {
                    continue;
                }
                let mut rest = factors.to_vec();
                rest[i].1 -= 2;
                if let Some(partner) = self.existing_partner(x, &rest)
                    && collected.get(&self.key(partner)) == Some(c)
                {
                    return Some((*id, partner, rest));
                }
            }
        }
        None
    }

    /// The monomial `cos(x)^2 * rest`, if the graph has it already: only then can it be a term of a sum.
    fn existing_partner(&self, x: ExprId, rest: &[(ExprId, i32)]) -> Option<ExprId> {
        let cosine = self.find(&Node::Function(Function::Cos, x))?;
        let mut factors: BTreeMap<(u64, ExprId), i32> = BTreeMap::new();
        for (base, e) in rest.iter().copied().chain([(cosine, 2)]) {
            *factors.entry(self.key(base)).or_default() += e;
        }
        let factors: Box<[_]> =
            factors.into_iter().filter(|(_, e)| *e != 0).map(|((_, base), e)| (base, e)).collect();
        match &factors[..] {
            [] => None,
            [(base, 1)] => Some(*base),
            _ => self.find(&Node::Product(factors)),
        }
    }

    /// `a * b`.
    pub fn mul(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if a == self.one() {
            return b;
        }
        if b == self.one() {
            return a;
        }
        self.product(&[(a, 1), (b, 1)])
    }

    /// `a / b`; the caller knows that `b` is not zero.
    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.product(&[(a, 1), (b, -1)])
    }

    /// `a^n`.
    pub fn powi(&mut self, a: ExprId, n: i32) -> ExprId {
        self.product(&[(a, n)])
    }

    /// `product base^exponent`, in normal form.
    pub fn product(&mut self, factors: &[(ExprId, i32)]) -> ExprId {
        let mut coefficient = Rational::ONE;
        let mut collected: BTreeMap<(u64, ExprId), i32> = BTreeMap::new();
        let mut exponentials: Vec<(ExprId, Rational)> = Vec::new();
        let mut undefined = false;
        let mut stack: Vec<(ExprId, i32)> = factors.to_vec();
        while let Some((id, e)) = stack.pop() {
            if e == 0 {
                continue;
            }
            match self.node(id) {
                Node::Undefined => undefined = true,
                Node::Number(value) => match value.powi(e) {
                    Some(power) => coefficient = coefficient * power,
                    None => undefined = true,
                },
                Node::Sum { .. } => {
                    let (content, primitive) = self.split_content(id);
                    // A positive or negative content leaves the product; it cannot be zero.
                    coefficient = coefficient * content.powi(e).expect("contents are not zero");
                    if matches!(self.node(primitive), Node::Sum { .. }) {
                        *collected.entry(self.key(primitive)).or_default() += e;
                    } else {
                        stack.push((primitive, e));
                    }
                }
                Node::Product(inner) => stack.extend(inner.iter().map(|(base, k)| (*base, k * e))),
                Node::Function(Function::Exp, x) => exponentials.push((*x, Rational::integer(e.into()))),
                _ => *collected.entry(self.key(id)).or_default() += e,
            }
        }
        if undefined {
            return self.intern(Node::Undefined);
        }
        if coefficient.is_zero() {
            return self.zero();
        }
        if !exponentials.is_empty() {
            // exp(x)^m exp(y)^n = exp(m x + n y).
            let argument = self.linear(&exponentials);
            let exponential = self.exp(argument);
            if matches!(self.node(exponential), Node::Function(Function::Exp, _)) {
                *collected.entry(self.key(exponential)).or_default() += 1;
            } else if exponential != self.one() {
                // exp(ln(x y) + z) exp(-z) is a product itself.
                let mut again: Vec<_> = collected.into_iter().map(|((_, id), e)| (id, e)).collect();
                again.push((exponential, 1));
                let rest = self.product(&again);
                return self.scale(rest, &coefficient);
            }
        }
        // q-th powers of q-th roots, and even powers of absolute values, are what is below them.
        let reducible: Vec<_> = collected
            .iter()
            .filter_map(|((_, id), e)| match self.node(*id) {
                Node::Function(Function::Root(q), x) if e.unsigned_abs() >= *q => {
                    Some((*id, *x, *q as i32, *e))
                }
                Node::Function(Function::Abs, x) if *e % 2 == 0 && *e != 0 => Some((*id, *x, 1, *e)),
                _ => None,
            })
            .collect();
        if !reducible.is_empty() {
            let mut again: Vec<(ExprId, i32)> = Vec::new();
            for (id, x, q, e) in reducible {
                collected.remove(&self.key(id));
                again.push((x, e / q));
                again.push((id, e % q));
            }
            again.extend(collected.into_iter().map(|((_, id), e)| (id, e)));
            let rest = self.product(&again);
            return self.scale(rest, &coefficient);
        }
        let factors: Box<[_]> =
            collected.into_iter().filter(|(_, e)| *e != 0).map(|((_, id), e)| (id, e)).collect();
        let monomial = match &factors[..] {
            [] => return self.intern(Node::Number(coefficient)),
            [(base, 1)] => *base,
            _ => self.intern(Node::Product(factors)),
        };
        if coefficient.is_one() { monomial } else { self.scale(monomial, &coefficient) }
    }

    /// Content and primitive part of a sum: `sum = content * primitive`, the first coefficient of the primitive positive.
    pub(crate) fn split_content(&mut self, id: ExprId) -> (Rational, ExprId) {
        let Node::Sum { constant, terms } = self.node(id) else { return (Rational::ONE, id) };
        let mut content = terms.iter().fold(constant.abs(), |g, (_, c)| g.content_gcd(c));
        if terms[0].1.is_negative() {
            content = -content;
        }
        if content.is_one() {
            return (content, id);
        }
        let inverse = content.recip().expect("a sum has a term");
        if let [(term, _)] = &terms[..]
            && constant.is_zero()
        {
            return (content, *term);
        }
        let constant = constant * &inverse;
        let terms = terms.iter().map(|(term, c)| (*term, c * &inverse)).collect();
        (content, self.intern(Node::Sum { constant, terms }))
    }

    /// A term's coefficient and monomial: `3*x` is `(3, x)`, a number is itself times one.
    pub fn split_coefficient(&mut self, id: ExprId) -> (Rational, ExprId) {
        match self.node(id) {
            Node::Number(value) => (value.clone(), self.one()),
            Node::Sum { constant, terms } if constant.is_zero() && terms.len() == 1 => {
                (terms[0].1.clone(), terms[0].0)
            }
            _ => (Rational::ONE, id),
        }
    }

    /// `base^exponent` as a person writes it: the exponent must be a number, its root must exist.
    pub fn power(&mut self, base: ExprId, exponent: ExprId) -> Result<ExprId, PowerError> {
        let Some(exponent) = self.as_number(exponent).cloned() else {
            return Err(PowerError::ExponentNotNumber);
        };
        let (n, q) = exponent.to_i64_pair().ok_or(PowerError::TooLarge)?;
        let q =
            u32::try_from(q).ok().filter(|q| i64::from(*q) <= MAX_EXPONENT).ok_or(PowerError::TooLarge)?;
        if let Some(value) = self.as_number(base) {
            if value.is_zero() && n < 0 {
                return Err(PowerError::DivisionByZero);
            }
            if n.unsigned_abs().saturating_mul(value.bits()) > 4 * MAX_NUMBER_BITS {
                return Err(PowerError::TooLarge);
            }
            if value.is_negative() && q % 2 == 0 {
                return Err(PowerError::NegativeBase);
            }
        } else if n.abs() > MAX_EXPONENT {
            return Err(PowerError::TooLarge);
        }
        let n = i32::try_from(n).map_err(|_| PowerError::TooLarge)?;
        let root = self.root(base, q);
        let power = self.powi(root, n);
        match self.as_number(power) {
            Some(value) if value.bits() > MAX_NUMBER_BITS => Err(PowerError::TooLarge),
            _ => Ok(power),
        }
    }

    /// The expression kept whole, so that its users share it: for intermediate results that many expressions use.
    /// What is a number, a symbol, constant or a product of two at most stays as it is.
    pub fn keep(&mut self, e: ExprId) -> ExprId {
        let small = match self.node(e) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined | Node::Kept(_) => true,
            Node::Function(_, x) => self.as_symbol(*x).is_some(),
            Node::Atan2(..) => false,
            Node::Sum { constant, terms } => {
                constant.is_zero() && terms.len() == 1 && self.is_small_product(terms[0].0)
            }
            Node::Product(_) => self.is_small_product(e),
        };
        if small || self.roles(e).is_constant() { e } else { self.intern(Node::Kept(e)) }
    }

    fn is_small_product(&self, e: ExprId) -> bool {
        match self.node(e) {
            Node::Product(factors) => {
                factors.len() <= 2
                    && factors.iter().all(|(base, k)| {
                        k.abs() == 1
                            && (self.roles(*base).is_constant()
                                || matches!(
                                    self.node(*base),
                                    Node::Symbol(_) | Node::Function(..) | Node::Kept(_)
                                ))
                    })
            }
            Node::Sum { .. } | Node::Atan2(..) => false,
            _ => true,
        }
    }

    /// Whether a number is beyond what declarations may contain.
    pub fn number_overflows(&self, id: ExprId) -> bool {
        self.as_number(id).is_some_and(|value| value.bits() > MAX_NUMBER_BITS)
    }
}
