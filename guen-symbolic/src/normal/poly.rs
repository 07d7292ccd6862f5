//! Sparse polynomials over the rationals: packed monomials, products and exact division.

use std::cell::Cell;
use std::cmp::Ordering;
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

    /// Returns all bits of the given generators.
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
        let (a, b) = (&self.0, &mask.0);
        Mono([a[0] & b[0], a[1] & b[1], a[2] & b[2], a[3] & b[3]])
    }

    pub(super) fn without(&self, mask: &Mono) -> Mono {
        let (a, b) = (&self.0, &mask.0);
        Mono([a[0] & !b[0], a[1] & !b[1], a[2] & !b[2], a[3] & !b[3]])
    }

    pub(super) fn is_one(&self) -> bool {
        self.0[0] | self.0[1] | self.0[2] | self.0[3] == 0
    }

    pub(super) fn times(&self, other: &Mono) -> Result<Mono> {
        let (a, b) = (&self.0, &other.0);
        let words = [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]];
        if (words[0] | words[1] | words[2] | words[3]) & GUARD == 0 { Ok(Mono(words)) } else { Err(Exceeded) }
    }

    /// Compares as numbers: derived comparisons are several calls.
    fn compare(&self, other: &Mono) -> Ordering {
        let mut word = 0;
        while word < WORDS {
            if self.0[word] != other.0[word] {
                return if self.0[word] < other.0[word] { Ordering::Less } else { Ordering::Greater };
            }
            word += 1;
        }
        Ordering::Equal
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

    /// Returns all bits of those bytes in which this is not less: the guards stay where nothing was borrowed.
    fn not_less(a: u64, b: u64) -> u64 {
        ((((a | GUARD) - b) & GUARD) >> 7) * 0xff
    }

    pub(super) fn gcd(&self, other: &Mono) -> Mono {
        let mut words = self.0;
        let mut word = 0;
        while word < WORDS {
            let (a, b) = (words[word], other.0[word]);
            if a != b {
                let larger = Self::not_less(a, b);
                words[word] = a & !larger | b & larger;
            }
            word += 1;
        }
        Mono(words)
    }

    pub(super) fn lcm(&self, other: &Mono) -> Mono {
        let mut words = self.0;
        let mut word = 0;
        while word < WORDS {
            let (a, b) = (words[word], other.0[word]);
            if a != b {
                let larger = Self::not_less(a, b);
                words[word] = a & larger | b & !larger;
            }
            word += 1;
        }
        Mono(words)
    }

    pub(super) fn degree(&self) -> u32 {
        const PAIRS: u64 = 0x00ff_00ff_00ff_00ff;
        let mut sum = 0;
        let mut word = 0;
        while word < WORDS {
            let pairs = (self.0[word] & PAIRS) + (self.0[word] >> 8 & PAIRS);
            let fours = pairs + (pairs >> 32);
            sum += (fours & 0xffff) + (fours >> 16 & 0xffff);
            word += 1;
        }
        sum as u32
    }
}

/// Monomials in descending order with the places of their coefficients.
type Row = Vec<(Mono, u32)>;

/// Two rows as one; coefficients of equal monomials are added in the place of the first.
fn merge(a: &[(Mono, u32)], b: &[(Mono, u32)], coefficients: &mut [Rational]) -> Row {
    let mut merged = Row::with_capacity(a.len() + b.len());
    let (mut i, mut k) = (0, 0);
    while i < a.len() && k < b.len() {
        match a[i].0.compare(&b[k].0) {
            Ordering::Greater => {
                merged.push(a[i]);
                i += 1;
            }
            Ordering::Less => {
                merged.push(b[k]);
                k += 1;
            }
            Ordering::Equal => {
                let (first, second) = (a[i].1 as usize, b[k].1 as usize);
                coefficients[first] = &coefficients[first] + &coefficients[second];
                merged.push(a[i]);
                i += 1;
                k += 1;
            }
        }
    }
    merged.extend_from_slice(&a[i..]);
    merged.extend_from_slice(&b[k..]);
    merged
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

    /// Builds a polynomial from different monomials in any order, with coefficients that are not zero.
    pub(super) fn from_unsorted(mut terms: Vec<(Mono, Rational)>) -> Self {
        const INSERTION_SORTED: usize = 24;
        if terms.len() > INSERTION_SORTED {
            terms.sort_unstable_by(|a, b| b.0.compare(&a.0));
        } else {
            let mut next = 1;
            while next < terms.len() {
                let mut at = next;
                while at > 0 && terms[at - 1].0.compare(&terms[at].0) == Ordering::Less {
                    terms.swap(at - 1, at);
                    at -= 1;
                }
                next += 1;
            }
        }
        Poly { terms }
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
        let (word, shift) = Mono::shift(generator);
        let terms: &[(Mono, Rational)] = &self.terms;
        let mut most = 0;
        let mut index = 0;
        while index < terms.len() {
            let exponent = terms[index].0.0[word] >> shift & 0xff;
            if exponent > most {
                most = exponent;
            }
            index += 1;
        }
        most as u32
    }

    /// Whether a term has a larger degree.
    pub(super) fn exceeds(&self, degree: u32) -> bool {
        let terms: &[(Mono, Rational)] = &self.terms;
        let mut index = 0;
        while index < terms.len() {
            if terms[index].0.degree() > degree {
                return true;
            }
            index += 1;
        }
        false
    }

    /// The largest exponents of all generators.
    pub(super) fn max_exponents(&self) -> Mono {
        let terms: &[(Mono, Rational)] = &self.terms;
        let mut most = Mono::ONE;
        let mut index = 0;
        while index < terms.len() {
            most = most.lcm(&terms[index].0);
            index += 1;
        }
        most
    }

    pub(super) fn scaled(&self, factor: &Rational) -> Poly {
        if factor.is_one() {
            return self.clone();
        }
        if factor.is_zero() {
            return Poly::zero();
        }
        let mut terms = Vec::with_capacity(self.terms.len());
        for (mono, c) in &self.terms {
            terms.push((*mono, c * factor));
        }
        Poly { terms }
    }

    fn times_term(&self, factor: &Mono, k: &Rational) -> Result<Poly> {
        let mut terms = Vec::with_capacity(self.terms.len());
        for (mono, c) in &self.terms {
            terms.push((mono.times(factor)?, c * k));
        }
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
        let a: &[(Mono, Rational)] = &self.terms;
        let b: &[(Mono, Rational)] = &other.terms;
        let (mut i, mut k) = (0, 0);
        while i < a.len() && k < b.len() {
            match a[i].0.compare(&b[k].0) {
                Ordering::Greater => {
                    terms.push((a[i].0, a[i].1.clone()));
                    i += 1;
                }
                Ordering::Less => {
                    terms.push((b[k].0, b[k].1.clone()));
                    k += 1;
                }
                Ordering::Equal => {
                    let sum = &a[i].1 + &b[k].1;
                    if !sum.is_zero() {
                        terms.push((a[i].0, sum));
                    }
                    i += 1;
                    k += 1;
                }
            }
        }
        for (mono, c) in a[i..].iter().chain(&b[k..]) {
            terms.push((*mono, c.clone()));
        }
        if terms.len() > budget.terms { Err(Exceeded) } else { Ok(Poly { terms }) }
    }

    pub(super) fn times(&self, other: &Poly, budget: &Budget) -> Result<Poly> {
        if let [(mono, c)] = &other.terms[..] {
            return self.times_term(mono, c);
        }
        if let [(mono, c)] = &self.terms[..] {
            return other.times_term(mono, c);
        }
        budget.spend(self.len() * other.len())?;
        // Row by row the products are in order: rows are merged in pairs. What is moved are monomials with the places of
        // their coefficients.
        let mut coefficients: Vec<Rational> = Vec::with_capacity(self.len() * other.len());
        let mut rows: Vec<Row> = Vec::with_capacity(self.len());
        for (m, c) in &self.terms {
            let mut row = Row::with_capacity(other.len());
            for (n, d) in &other.terms {
                row.push((m.times(n)?, coefficients.len() as u32));
                coefficients.push(c * d);
            }
            rows.push(row);
        }
        while rows.len() > 1 {
            let mut merged = Vec::with_capacity(rows.len() / 2 + 1);
            for pair in rows.chunks(2) {
                merged.push(match pair {
                    [a, b] => merge(a, b, &mut coefficients),
                    _ => pair.concat(),
                });
            }
            rows = merged;
        }
        let row = rows.pop().unwrap_or_default();
        if row.len() > 4 * budget.terms {
            return Err(Exceeded);
        }
        let mut terms = Vec::with_capacity(row.len());
        for (mono, place) in row {
            let c = std::mem::take(&mut coefficients[place as usize]);
            if !c.is_zero() {
                terms.push((mono, c));
            }
        }
        if terms.len() > budget.terms { Err(Exceeded) } else { Ok(Poly { terms }) }
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
