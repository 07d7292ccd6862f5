//! Sparse polynomials over the rationals: packed monomials, products and exact division.

use std::cell::Cell;
use std::collections::BTreeMap;

use crate::algebra::Rational;

/// Exponents are bytes of four words.
pub(super) const MAX_GENERATORS: usize = 32;
const WORDS: usize = 4;
/// The top bit of each byte stays free: it shows overflow and borrow.
const GUARD: u64 = 0x8080_8080_8080_8080;

/// A limit was met; the caller keeps the expression as it is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Exceeded;

pub(super) type Result<T> = std::result::Result<T, Exceeded>;

/// The elementary steps that are left.
#[derive(Debug)]
pub(super) struct Budget {
    steps: Cell<usize>,
    terms: usize,
}

impl Budget {
    pub(super) fn new(steps: usize, terms: usize) -> Self {
        Budget { steps: Cell::new(steps), terms }
    }

    pub(super) fn spend(&self, steps: usize) -> Result<()> {
        self.steps.set(self.steps.get().checked_sub(steps).ok_or(Exceeded)?);
        Ok(())
    }
}

/// A product of powers of generators; the first generator is the most significant one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub(super) struct Mono([u64; WORDS]);

impl Mono {
    pub(super) const ONE: Mono = Mono([0; WORDS]);

    fn shift(generator: usize) -> (usize, u32) {
        (generator / 8, 56 - 8 * (generator % 8) as u32)
    }

    pub(super) fn power(generator: usize, exponent: u32) -> Result<Mono> {
        if exponent > 127 {
            return Err(Exceeded);
        }
        let (word, shift) = Self::shift(generator);
        let mut mono = Mono::ONE;
        mono.0[word] = u64::from(exponent) << shift;
        Ok(mono)
    }

    /// All bits of the given generators.
    pub(super) fn mask(generators: impl IntoIterator<Item = usize>) -> Mono {
        let mut mask = Mono::ONE;
        for generator in generators {
            let (word, shift) = Self::shift(generator);
            mask.0[word] |= 0xff << shift;
        }
        mask
    }

    pub(super) fn exponent(&self, generator: usize) -> u32 {
        let (word, shift) = Self::shift(generator);
        (self.0[word] >> shift) as u32 & 0xff
    }

    pub(super) fn part(&self, mask: &Mono) -> Mono {
        Mono(std::array::from_fn(|i| self.0[i] & mask.0[i]))
    }

    pub(super) fn without(&self, mask: &Mono) -> Mono {
        Mono(std::array::from_fn(|i| self.0[i] & !mask.0[i]))
    }

    pub(super) fn is_one(&self) -> bool {
        self.0 == [0; WORDS]
    }

    pub(super) fn times(&self, other: &Mono) -> Result<Mono> {
        let mut words = self.0;
        let mut guard = 0;
        for (word, o) in words.iter_mut().zip(&other.0) {
            *word += o;
            guard |= *word;
        }
        if guard & GUARD == 0 { Ok(Mono(words)) } else { Err(Exceeded) }
    }

    pub(super) fn over(&self, other: &Mono) -> Option<Mono> {
        let mut words = self.0;
        for (word, o) in words.iter_mut().zip(&other.0) {
            let difference = (*word | GUARD) - o;
            if difference & GUARD != GUARD {
                return None;
            }
            *word = difference & !GUARD;
        }
        Some(Mono(words))
    }

    fn bytewise(&self, other: &Mono, choose: impl Fn(u8, u8) -> u8) -> Mono {
        if self.0 == other.0 {
            return *self;
        }
        Mono(std::array::from_fn(|i| {
            let (a, b) = (self.0[i].to_be_bytes(), other.0[i].to_be_bytes());
            u64::from_be_bytes(std::array::from_fn(|k| choose(a[k], b[k])))
        }))
    }

    pub(super) fn gcd(&self, other: &Mono) -> Mono {
        self.bytewise(other, u8::min)
    }

    pub(super) fn lcm(&self, other: &Mono) -> Mono {
        self.bytewise(other, u8::max)
    }

    pub(super) fn degree(&self) -> u32 {
        self.0.iter().flat_map(|word| word.to_be_bytes()).map(u32::from).sum()
    }
}

/// A polynomial: terms in descending order of their monomials, no coefficient zero.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
pub(super) struct Poly {
    pub(super) terms: Vec<(Mono, Rational)>,
}

impl Poly {
    pub(super) fn zero() -> Self {
        Poly::default()
    }

    pub(super) fn one() -> Self {
        Poly::number(Rational::ONE)
    }

    pub(super) fn number(value: Rational) -> Self {
        Poly::term(Mono::ONE, value)
    }

    pub(super) fn term(mono: Mono, value: Rational) -> Self {
        if value.is_zero() { Poly::zero() } else { Poly { terms: vec![(mono, value)] } }
    }

    pub(super) fn collect(terms: BTreeMap<Mono, Rational>) -> Self {
        Poly { terms: terms.into_iter().rev().filter(|(_, c)| !c.is_zero()).collect() }
    }

    pub(super) fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    pub(super) fn len(&self) -> usize {
        self.terms.len()
    }

    pub(super) fn is_one(&self) -> bool {
        matches!(&self.terms[..], [(mono, c)] if mono.is_one() && c.is_one())
    }

    /// Whether any of the generators of the mask occurs.
    pub(super) fn meets(&self, mask: &Mono) -> bool {
        self.terms.iter().any(|(mono, _)| !mono.part(mask).is_one())
    }

    pub(super) fn max_exponent(&self, generator: usize) -> u32 {
        self.terms.iter().map(|(mono, _)| mono.exponent(generator)).max().unwrap_or(0)
    }

    pub(super) fn scaled(&self, factor: &Rational) -> Poly {
        if factor.is_one() {
            return self.clone();
        }
        if factor.is_zero() {
            return Poly::zero();
        }
        Poly { terms: self.terms.iter().map(|(mono, c)| (*mono, c * factor)).collect() }
    }

    pub(super) fn times_mono(&self, factor: &Mono) -> Result<Poly> {
        if factor.is_one() {
            return Ok(self.clone());
        }
        let terms =
            self.terms.iter().map(|(mono, c)| Ok((mono.times(factor)?, c.clone()))).collect::<Result<_>>()?;
        Ok(Poly { terms })
    }

    /// Division by a monomial that divides every term.
    pub(super) fn over_mono(&self, divisor: &Mono) -> Option<Poly> {
        if divisor.is_one() {
            return Some(self.clone());
        }
        let terms = self
            .terms
            .iter()
            .map(|(mono, c)| Some((mono.over(divisor)?, c.clone())))
            .collect::<Option<_>>()?;
        Some(Poly { terms })
    }

    pub(super) fn plus(&self, other: &Poly, budget: &Budget) -> Result<Poly> {
        budget.spend((self.len() + other.len()) / 4 + 1)?;
        let mut terms = Vec::with_capacity(self.len() + other.len());
        let (mut a, mut b) = (self.terms.iter().peekable(), other.terms.iter().peekable());
        loop {
            match (a.peek(), b.peek()) {
                (Some(x), Some(y)) if x.0 == y.0 => {
                    let sum = &x.1 + &y.1;
                    if !sum.is_zero() {
                        terms.push((x.0, sum));
                    }
                    a.next();
                    b.next();
                }
                (Some(x), y) if y.is_none_or(|y| x.0 > y.0) => {
                    terms.push((*x).clone());
                    a.next();
                }
                (_, Some(y)) => {
                    terms.push((*y).clone());
                    b.next();
                }
                _ => break,
            }
        }
        if terms.len() > budget.terms { Err(Exceeded) } else { Ok(Poly { terms }) }
    }

    pub(super) fn times(&self, other: &Poly, budget: &Budget) -> Result<Poly> {
        if let [(mono, c)] = &other.terms[..] {
            return Ok(self.times_mono(mono)?.scaled(c));
        }
        if let [(mono, c)] = &self.terms[..] {
            return Ok(other.times_mono(mono)?.scaled(c));
        }
        budget.spend(self.len() * other.len())?;
        let mut terms: BTreeMap<Mono, Rational> = BTreeMap::new();
        for (m, c) in &self.terms {
            for (n, d) in &other.terms {
                let slot = terms.entry(m.times(n)?).or_default();
                *slot = &*slot + &(c * d);
            }
            if terms.len() > 4 * budget.terms {
                return Err(Exceeded);
            }
        }
        let product = Poly::collect(terms);
        if product.len() > budget.terms { Err(Exceeded) } else { Ok(product) }
    }

    /// The quotient, if the division leaves nothing.
    pub(super) fn over(&self, divisor: &Poly, budget: &Budget) -> Result<Option<Poly>> {
        let Some((lead, lead_c)) = divisor.terms.first() else { return Ok(None) };
        let inverse = lead_c.recip().ok_or(Exceeded)?;
        if divisor.len() == 1 {
            return Ok(self.over_mono(lead).map(|quotient| quotient.scaled(&inverse)));
        }
        // The last terms must divide too: this refuses most divisions at once.
        if let (Some((last, _)), Some((divisor_last, _))) = (self.terms.last(), divisor.terms.last())
            && last.over(divisor_last).is_none()
        {
            return Ok(None);
        }
        let mut rest: BTreeMap<Mono, Rational> = self.terms.iter().cloned().collect();
        let mut quotient = Vec::new();
        while let Some((mono, c)) = rest.pop_last() {
            let Some(q) = mono.over(lead) else { return Ok(None) };
            let k = &c * &inverse;
            budget.spend(divisor.len())?;
            for (m, d) in &divisor.terms[1..] {
                let Ok(m) = m.times(&q) else { return Ok(None) };
                let slot = rest.entry(m).or_default();
                *slot = &*slot - &(d * &k);
                if slot.is_zero() {
                    rest.remove(&m);
                }
            }
            quotient.push((q, k));
            if quotient.len() > budget.terms {
                return Err(Exceeded);
            }
        }
        Ok(Some(Poly { terms: quotient }))
    }

    /// `content * mono * rest`: the rest has coprime integer coefficients, the first one positive, and no common monomial.
    pub(super) fn split(&self) -> (Rational, Mono, Poly) {
        let Some((first, lead)) = self.terms.first() else { return (Rational::ONE, Mono::ONE, Poly::zero()) };
        let mut content = Rational::ZERO;
        let mut mono = *first;
        for (m, c) in &self.terms {
            content = content.content_gcd(c);
            mono = mono.gcd(m);
        }
        if lead.is_negative() {
            content = -content;
        }
        let rest = self.over_mono(&mono).unwrap_or_else(|| self.clone());
        let rest = match content.recip() {
            Some(inverse) => rest.scaled(&inverse),
            None => rest,
        };
        (content, mono, rest)
    }

    /// The polynomial with the sign of a generator's odd powers turned.
    pub(super) fn conjugate(&self, generator: usize) -> Poly {
        let turn = |(mono, c): &(Mono, Rational)| {
            (*mono, if mono.exponent(generator) % 2 == 1 { -c.clone() } else { c.clone() })
        };
        Poly { terms: self.terms.iter().map(turn).collect() }
    }
}
