//! Building expressions in normal form: sums, products, powers.
//!
//! A sum lists its terms once each, with exact coefficients; a product lists its bases once each, with
//! integer exponents, and carries no number: numbers belong to the sums above. Sums inside products are
//! primitive (content one, first coefficient positive). Nothing distributes products over sums.

use super::graph::{COSINES, Graph, Order, SINE_SQUARED};
use super::node::{Node, PowerError, content_of};
use super::{ExprId, Function, Rational};

/// Sums with more terms stay nested: flattening them would copy their terms into every user.
const FLATTEN_TERMS: usize = 8;

/// Integer powers beyond this are refused where they are written.
pub(crate) const MAX_EXPONENT: i64 = 64;

/// Numbers with more bits than this (about 10^400) are refused where they are written.
const MAX_NUMBER_BITS: u64 = 1330;

/// The terms `c m sin(x)^2` and `c m cos(x)^2` of a sum, and the factors of `m`.
type SquarePair = (ExprId, ExprId, Vec<(ExprId, i32)>);

/// Adds `c * term` to terms in the graph's order.
fn add_term(graph: &Graph, terms: &mut Vec<(ExprId, Rational)>, term: ExprId, c: Rational) {
    match graph.place_of(terms, term) {
        Ok(at) => {
            let slot = &mut terms[at].1;
            *slot = &*slot + &c;
        }
        Err(at) if at == terms.len() => terms.push((term, c)),
        Err(at) => terms.insert(at, (term, c)),
    }
}

/// Multiplies factors in the graph's order, or in the reverse, by `base^e`.
fn add_power(graph: &Graph, factors: &mut Vec<(ExprId, i32)>, base: ExprId, e: i32, order: Order) {
    match graph.place_in(factors, base, order) {
        Ok(at) => factors[at].1 += e,
        Err(at) if at == factors.len() => factors.push((base, e)),
        Err(at) => factors.insert(at, (base, e)),
    }
}

fn drop_zeros(terms: &mut Vec<(ExprId, Rational)>) {
    let mut index = 0;
    while index < terms.len() {
        if terms[index].1.is_zero() {
            terms.retain(|(_, c)| !c.is_zero());
            return;
        }
        index += 1;
    }
}

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

    /// A degree, `pi/180`.
    pub fn degree(&mut self) -> ExprId {
        let (pi, half_turn) = (self.pi(), self.number(Rational::integer(180)));
        self.div(pi, half_turn)
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
        match self.node(a) {
            Node::Sum { constant, terms } if terms.len() <= FLATTEN_TERMS && !factor.is_zero() => {
                // What has no square to fold has none as a multiple.
                let constant = constant * factor;
                let old: &[(ExprId, Rational)] = terms;
                let mut terms = Vec::with_capacity(old.len());
                let mut index = 0;
                while index < old.len() {
                    terms.push((old[index].0, &old[index].1 * factor));
                    index += 1;
                }
                self.finish_sum(constant, terms)
            }
            Node::Number(_) | Node::Undefined | Node::Sum { .. } => self.linear(&[(a, factor.clone())]),
            _ if factor.is_one() => a,
            _ if factor.is_zero() => self.linear(&[]),
            _ => self.intern_sum(Rational::ZERO, vec![(a, factor.clone())]),
        }
    }

    /// The sum of many expressions.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = ExprId>) -> ExprId {
        let mut list: Vec<(ExprId, Rational)> = Vec::new();
        for term in terms {
            // Entries of matrices are zeros more often than not.
            if !self.is_zero(term) {
                list.push((term, Rational::ONE));
            }
        }
        self.linear(&list)
    }

    /// `sum coefficient * term`, in normal form.
    pub fn linear(&mut self, terms: &[(ExprId, Rational)]) -> ExprId {
        match terms {
            [] => return self.zero(),
            [(id, c)] if c.is_one() => return *id,
            _ => {}
        }
        let mut constant = Rational::ZERO;
        let mut collected: Vec<(ExprId, Rational)> = Vec::with_capacity(terms.len() + FLATTEN_TERMS);
        let mut next = 0;
        while next < terms.len() {
            let (id, coefficient) = &terms[next];
            next += 1;
            if coefficient.is_zero() {
                continue;
            }
            match self.node(*id) {
                Node::Undefined => return *id,
                Node::Number(value) => constant = constant + value * coefficient,
                Node::Sum { constant: inner, terms } if self.is_flattened(terms) => {
                    if !inner.is_zero() {
                        constant = constant + inner * coefficient;
                    }
                    let terms: &[(ExprId, Rational)] = terms;
                    let mut index = 0;
                    while index < terms.len() {
                        let (term, c) = &terms[index];
                        add_term(self, &mut collected, *term, c * coefficient);
                        index += 1;
                    }
                }
                Node::Sum { .. } => {
                    let (content, primitive) = self.split_content(*id);
                    add_term(self, &mut collected, primitive, &content * coefficient);
                }
                _ => add_term(self, &mut collected, *id, coefficient.clone()),
            }
        }
        drop_zeros(&mut collected);
        if self.nests {
            self.open_nested(&mut collected, &mut constant);
        }
        self.fold_squares(&mut collected, &mut constant);
        self.finish_sum(constant, collected)
    }

    /// Whether a sum is flattened into sums of it.
    fn is_flattened(&self, terms: &[(ExprId, Rational)]) -> bool {
        terms.len() <= FLATTEN_TERMS
            && !(self.nests && terms.iter().any(|(term, _)| matches!(self.node(*term), Node::Sum { .. })))
    }

    /// Opens nested sums that have a term beside them: `(a + b) - a` is `b`.
    fn open_nested(&self, collected: &mut Vec<(ExprId, Rational)>, constant: &mut Rational) {
        let is_met = |collected: &[(ExprId, Rational)], id: ExprId| match self.node(id) {
            Node::Sum { terms, .. } => terms.iter().any(|(term, _)| self.place_of(collected, *term).is_ok()),
            _ => false,
        };
        while collected.len() > 1
            && let Some(at) = collected.iter().position(|(id, _)| is_met(collected, *id))
        {
            let (id, c) = collected.remove(at);
            let Node::Sum { constant: inner, terms } = self.node(id) else { return };
            *constant = &*constant + &(inner * &c);
            for (term, k) in terms {
                add_term(self, collected, *term, k * &c);
            }
            drop_zeros(collected);
        }
    }

    fn finish_sum(&mut self, constant: Rational, terms: Vec<(ExprId, Rational)>) -> ExprId {
        if terms.is_empty() {
            return self.intern(Node::Number(constant));
        }
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
                return self.intern_sum(constant, terms);
            }
        }
        self.intern_sum(constant, terms)
    }

    /// `c m sin(x)^2 + c m cos(x)^2 = c m`, for as long as such a pair is left.
    fn fold_squares(&mut self, collected: &mut Vec<(ExprId, Rational)>, constant: &mut Rational) {
        while let Some((sine_term, cosine_term, rest)) = self.square_pair(collected) {
            let mut take = |id: ExprId| match self.place_of(collected, id) {
                Ok(at) => collected.remove(at).1,
                Err(_) => unreachable!("the pair comes from this list"),
            };
            let c = take(sine_term);
            take(cosine_term);
            let rest = self.product(&rest);
            let (inner, terms) = match self.node(rest) {
                Node::Number(value) => (value.clone(), Vec::new()),
                Node::Sum { constant, terms } => (constant.clone(), terms.to_vec()),
                _ => (Rational::ZERO, vec![(rest, Rational::ONE)]),
            };
            *constant = &*constant + &(&inner * &c);
            for (term, k) in terms {
                add_term(self, collected, term, &k * &c);
            }
            drop_zeros(collected);
        }
    }

    /// Two terms `c m sin(x)^2` and `c m cos(x)^2` with the same `c`, and the factors of `m`.
    fn square_pair(&self, collected: &[(ExprId, Rational)]) -> Option<SquarePair> {
        let mut looks = 0;
        let mut next = 0;
        while next < collected.len() {
            looks |= self.looks(collected[next].0);
            next += 1;
        }
        if collected.len() < 2 || looks & SINE_SQUARED == 0 || looks & COSINES == 0 {
            return None;
        }
        next = 0;
        while next < collected.len() {
            let (id, c) = &collected[next];
            next += 1;
            if self.looks(*id) & SINE_SQUARED == 0 {
                continue;
            }
            let Node::Product(factors) = self.node(*id) else { continue };
            let factors: &[(ExprId, i32)] = factors;
            let mut i = 0;
            while i < factors.len() {
                let (base, e) = factors[i];
                if e >= 2
                    && let Node::Function(Function::Sin, x) = *self.node(base)
                {
                    let mut rest = factors.to_vec();
                    rest[i].1 -= 2;
                    if let Some(partner) = self.existing_partner(x, &rest)
                        && let Ok(at) = self.place_of(collected, partner)
                        && collected[at].1 == *c
                    {
                        return Some((*id, partner, rest));
                    }
                }
                i += 1;
            }
        }
        None
    }

    /// The monomial `cos(x)^2 * rest`, if the graph has it already: only then can it be a term of a sum.
    fn existing_partner(&self, x: ExprId, rest: &[(ExprId, i32)]) -> Option<ExprId> {
        let cosine = self.find(&Node::Function(Function::Cos, x))?;
        let mut factors: Vec<(ExprId, i32)> = Vec::with_capacity(rest.len() + 1);
        for (base, e) in rest.iter().copied().chain([(cosine, 2)]) {
            add_power(self, &mut factors, base, e, Order::Ascending);
        }
        factors.retain(|(_, e)| *e != 0);
        match &factors[..] {
            [] => None,
            [(base, 1)] => Some(*base),
            _ => self.find_product(&factors),
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
        let is_undefined = |id| matches!(self.node(id), Node::Undefined);
        if self.is_zero(a) && !is_undefined(b) || self.is_zero(b) && !is_undefined(a) {
            return self.zero();
        }
        self.product(&[(a, 1), (b, 1)])
    }

    /// `a / b`; the caller knows that `b` is not zero.
    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if b == self.one() {
            return a;
        }
        self.product(&[(a, 1), (b, -1)])
    }

    /// `a^n`.
    pub fn powi(&mut self, a: ExprId, n: i32) -> ExprId {
        self.product(&[(a, n)])
    }

    /// `product base^exponent`, in normal form.
    pub fn product(&mut self, factors: &[(ExprId, i32)]) -> ExprId {
        let mut coefficient = Rational::ONE;
        let mut collected: Vec<(ExprId, i32)> = Vec::with_capacity(factors.len() + 4);
        let mut exponentials: Vec<(ExprId, Rational)> = Vec::new();
        let mut undefined = false;
        // From the last factor to the first: lists come in order, so that each is put behind those before.
        let mut next = factors.len();
        while next > 0 {
            next -= 1;
            let (id, e) = factors[next];
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
                    if !content.is_one() {
                        // A positive or negative content leaves the product; it cannot be zero.
                        coefficient = coefficient * content.powi(e).expect("contents are not zero");
                    }
                    self.collect_factor(&mut collected, &mut exponentials, primitive, e);
                }
                _ => self.collect_factor(&mut collected, &mut exponentials, id, e),
            }
        }
        let turned: &mut [(ExprId, i32)] = &mut collected;
        let (mut low, mut high) = (0, turned.len());
        while low + 1 < high {
            high -= 1;
            (turned[low], turned[high]) = (turned[high], turned[low]);
            low += 1;
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
                add_power(self, &mut collected, exponential, 1, Order::Ascending);
            } else if exponential != self.one() {
                // exp(ln(x y) + z) exp(-z) is a product itself.
                collected.push((exponential, 1));
                let rest = self.product(&collected);
                return self.scale(rest, &coefficient);
            }
        }
        // q-th powers of q-th roots, and even powers of absolute values, are what is below them.
        let mut reducible: Vec<(ExprId, ExprId, i32, i32)> = Vec::new();
        let mut zeros = false;
        let mut index = 0;
        while index < collected.len() {
            let (id, e) = collected[index];
            zeros |= e == 0;
            match self.node(id) {
                Node::Function(Function::Root(q), x) if e.unsigned_abs() >= *q => {
                    reducible.push((id, *x, *q as i32, e));
                }
                Node::Function(Function::Abs, x) if e % 2 == 0 && e != 0 => reducible.push((id, *x, 1, e)),
                _ => {}
            }
            index += 1;
        }
        if !reducible.is_empty() {
            let mut again: Vec<(ExprId, i32)> = Vec::new();
            for (id, x, q, e) in reducible {
                collected.retain(|(other, _)| *other != id);
                again.push((x, e / q));
                again.push((id, e % q));
            }
            again.extend(collected);
            let rest = self.product(&again);
            return self.scale(rest, &coefficient);
        }
        if zeros {
            collected.retain(|(_, e)| *e != 0);
        }
        let monomial = match &collected[..] {
            [] => return self.intern(Node::Number(coefficient)),
            [(base, 1)] => *base,
            _ => self.intern_product(collected),
        };
        if coefficient.is_one() { monomial } else { self.scale(monomial, &coefficient) }
    }

    /// Adds a power of what is neither a number nor a sum with a content to the factors of a product, in descending
    /// order.
    fn collect_factor(
        &self,
        collected: &mut Vec<(ExprId, i32)>,
        exponentials: &mut Vec<(ExprId, Rational)>,
        id: ExprId,
        e: i32,
    ) {
        match self.node(id) {
            Node::Product(inner) => {
                let inner: &[(ExprId, i32)] = inner;
                let mut index = inner.len();
                while index > 0 {
                    index -= 1;
                    let (base, k) = inner[index];
                    match self.node(base) {
                        Node::Function(Function::Exp, x) => {
                            exponentials.push((*x, Rational::integer((k * e).into())));
                        }
                        _ => add_power(self, collected, base, k * e, Order::Descending),
                    }
                }
            }
            Node::Function(Function::Exp, x) => exponentials.push((*x, Rational::integer(e.into()))),
            _ => add_power(self, collected, id, e, Order::Descending),
        }
    }

    /// Content and primitive part of a sum: `sum = content * primitive`, the first coefficient of the primitive positive.
    pub fn split_content(&mut self, id: ExprId) -> (Rational, ExprId) {
        if self.is_primitive(id) {
            return (Rational::ONE, id);
        }
        let Node::Sum { constant, terms } = self.node(id) else { return (Rational::ONE, id) };
        if let [(term, content)] = &terms[..]
            && constant.is_zero()
        {
            return (content.clone(), *term);
        }
        if let Some(known) = self.contents.get(&id) {
            // The same work as the first time: limits on work do not depend on what is remembered.
            self.spend(1 + terms.len());
            return known.clone();
        }
        let content = content_of(constant, terms);
        let inverse = content.recip().expect("a sum has a term");
        let constant = constant * &inverse;
        let terms = terms.iter().map(|(term, c)| (*term, c * &inverse)).collect();
        let primitive = self.intern_sum(constant, terms);
        self.contents.insert(id, (content.clone(), primitive));
        (content, primitive)
    }

    /// A term's coefficient and monomial: `3*x` is `(3, x)`, a number is itself times one.
    pub(crate) fn split_coefficient(&mut self, id: ExprId) -> (Rational, ExprId) {
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
            Node::Multivariate(..) => false,
            Node::Sum { constant, terms } => {
                constant.is_zero() && terms.len() == 1 && self.is_small_product(terms[0].0)
            }
            Node::Product(_) => self.is_small_product(e),
        };
        if small || self.roles(e).is_constant() { e } else { self.intern(Node::Kept(e)) }
    }

    /// The expression kept whole, as by [`keep`](Self::keep), where a sum that varies is in it: a product merges with what uses it.
    ///
    /// ```
    /// use guen_symbolic::{Graph, Role};
    /// let mut g = Graph::new();
    /// let [k, x, y] = [("k", Role::Constant), ("x", Role::State), ("y", Role::State)].map(|(name, role)| g.symbol(name, role));
    /// let product = g.product(&[(k, 1), (x, 1), (y, 1)]);
    /// assert_eq!(g.keep_sums(product), product);
    /// let sum = g.add(product, x);
    /// assert_ne!(g.keep_sums(sum), sum);
    /// ```
    pub fn keep_sums(&mut self, e: ExprId) -> ExprId {
        let varies = |id: ExprId| !self.roles(id).is_constant();
        let sums = self.reachable(&[e], |id| !varies(id) || matches!(self.node(id), Node::Function(..)));
        let is_sum = |id: &ExprId| matches!(self.node(*id), Node::Sum { constant, terms } if terms.len() > 1 || !constant.is_zero());
        if sums.iter().any(is_sum) { self.keep(e) } else { e }
    }

    /// The expression kept whole, as by [`keep`](Self::keep), short products as well: for what is known to be used more than once.
    pub(crate) fn keep_whole(&mut self, e: ExprId) -> ExprId {
        let is_leaf = match self.node(e) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined | Node::Kept(_) => true,
            Node::Function(_, x) => self.as_symbol(*x).is_some(),
            _ => self.roles(e).is_constant(),
        };
        if is_leaf { e } else { self.intern(Node::Kept(e)) }
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
            Node::Sum { .. } | Node::Multivariate(..) => false,
            _ => true,
        }
    }
}
