//! The ring that an expression lives in: its generators and the relations between them.
//!
//! Working form: powers of a cosine above one are replaced by `1 - sin^2`, powers of a root at or above its
//! order by the radicand. Both sides of each relation are reached by rewriting, so that divisibility by a
//! sine *and* by a cosine can be decided.

use std::collections::BTreeMap;

use crate::algebra::{ExprId, Rational};

use super::poly::{Budget, Exceeded, Mono, Poly, Result};

/// Conjugation multiplies sizes; larger products of numerator and divisor are not tried.
const CONJUGATION_TERMS: usize = 400;

/// A base angle with the generators of its sine and cosine.
#[derive(Clone, Debug)]
pub(super) struct Angle {
    pub(super) base: ExprId,
    pub(super) sin: usize,
    pub(super) cos: usize,
    /// The angle doubled, if the base is a fraction with an even denominator.
    pub(super) double: Option<ExprId>,
}

/// `generator^order = value`.
#[derive(Clone, Debug)]
pub(super) struct Relation {
    pub(super) generator: usize,
    pub(super) order: u32,
    pub(super) value: Poly,
}

/// Generators, relations, and the work that is left.
#[derive(Debug)]
pub(super) struct Ring {
    pub(super) generators: Vec<ExprId>,
    pub(super) angles: Vec<Angle>,
    /// Roots and absolute values; those that occur in others' radicands come first.
    pub(super) relations: Vec<Relation>,
    pub(super) constants: Mono,
    pub(super) motion: Mono,
    pub(super) budget: Budget,
}

/// `num / (mono * product poly^k)`; the polynomials are primitive and without monomial factors.
#[derive(Clone, Debug)]
pub(super) struct Fraction {
    pub(super) num: Poly,
    pub(super) den: Denominator,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Denominator {
    pub(super) mono: Mono,
    pub(super) polys: BTreeMap<Poly, u32>,
}

impl Denominator {
    pub(super) fn is_one(&self) -> bool {
        self.mono.is_one() && self.polys.is_empty()
    }

    fn remove(&mut self, poly: &Poly) {
        if let Some(k) = self.polys.get_mut(poly) {
            *k -= 1;
            if *k == 0 {
                self.polys.remove(poly);
            }
        }
    }
}

impl Fraction {
    pub(super) fn whole(num: Poly) -> Self {
        Fraction { num, den: Denominator::default() }
    }
}

impl Ring {
    /// `1 - generator^2`.
    fn complement(generator: usize) -> Result<Poly> {
        Ok(Poly {
            terms: vec![(Mono::power(generator, 2)?, Rational::MINUS_ONE), (Mono::ONE, Rational::ONE)],
        })
    }

    /// Powers of a generator from `order` on replaced by powers of `value`.
    fn rewrite(&self, p: Poly, generator: usize, order: u32, value: &Poly) -> Result<Poly> {
        if p.max_exponent(generator) < order {
            return Ok(p);
        }
        let mask = Mono::mask([generator]);
        // By powers of the generator's power: within one of them all monomials differ.
        let mut parts: Vec<Vec<(Mono, Rational)>> = Vec::new();
        for (mono, c) in p.terms {
            let e = mono.exponent(generator);
            let mono = mono.without(&mask).times(&Mono::power(generator, e % order)?)?;
            let k = (e / order) as usize;
            while parts.len() <= k {
                parts.push(Vec::new());
            }
            parts[k].push((mono, c));
        }
        let mut result = Poly::zero();
        let (mut power, mut exponent) = (Poly::one(), 0);
        for (k, part) in parts.into_iter().enumerate() {
            if part.is_empty() {
                continue;
            }
            while exponent < k {
                power = power.times(value, &self.budget)?;
                exponent += 1;
            }
            result = result.plus(&Poly::from_unsorted(part).times(&power, &self.budget)?, &self.budget)?;
        }
        Ok(result)
    }

    /// The working form.
    pub(super) fn reduce(&self, mut p: Poly) -> Result<Poly> {
        // Exponents of one generator fall, those of others may rise: they are counted again after each rewriting.
        let mut most = p.max_exponents();
        for relation in self.relations.iter().rev() {
            if most.exponent(relation.generator) >= relation.order {
                p = self.rewrite(p, relation.generator, relation.order, &relation.value)?;
                most = p.max_exponents();
            }
        }
        let angles: &[Angle] = &self.angles;
        let mut index = 0;
        while index < angles.len() {
            let angle = &angles[index];
            if most.exponent(angle.cos) >= 2 {
                p = self.rewrite(p, angle.cos, 2, &Self::complement(angle.sin)?)?;
                most = p.max_exponents();
            }
            index += 1;
        }
        Ok(p)
    }

    /// The form in which an angle's sine, not its cosine, occurs at most once in a term.
    fn in_cosines(&self, p: &Poly, angle: &Angle) -> Result<Poly> {
        self.rewrite(p.clone(), angle.sin, 2, &Self::complement(angle.cos)?)
    }

    pub(super) fn times(&self, a: &Poly, b: &Poly) -> Result<Poly> {
        self.reduce(a.times(b, &self.budget)?)
    }

    fn powers(&self, p: &Poly, n: u32) -> Result<Poly> {
        let mut result = Poly::one();
        for _ in 0..n {
            result = self.times(&result, p)?;
        }
        Ok(result)
    }

    /// The quotient in the ring, if the divisor is found to divide.
    fn divide(&self, num: &Poly, divisor: &Poly) -> Result<Option<Poly>> {
        if let Some(quotient) = num.over(divisor, &self.budget)? {
            return Ok(Some(quotient));
        }
        let (mut num, mut divisor) = (num.clone(), divisor.clone());
        let square_roots = self.relations.iter().filter(|relation| relation.order == 2).map(|r| r.generator);
        let generators: Vec<_> =
            square_roots.rev().chain(self.angles.iter().map(|angle| angle.cos)).collect();
        let mut changed = false;
        for generator in generators {
            if divisor.max_exponent(generator) == 0 {
                continue;
            }
            // n/d = n d*/(d d*), and d d* is free of the generator.
            if num.len() * divisor.len() > CONJUGATION_TERMS {
                return Ok(None);
            }
            let conjugate = divisor.conjugate(generator);
            num = self.times(&num, &conjugate)?;
            divisor = self.times(&divisor, &conjugate)?;
            if divisor.is_zero() {
                return Ok(None);
            }
            changed = true;
        }
        if !changed {
            return Ok(None);
        }
        num.over(&divisor, &self.budget)
    }

    /// `content * mono * rest`, where sines and cosines that are hidden in the rest have become part of the monomial.
    pub(super) fn extract(&self, p: &Poly) -> Result<(Rational, Mono, Poly)> {
        let (mut content, mut mono, mut rest) = p.split();
        for angle in &self.angles {
            if rest.len() < 2 || rest.max_exponent(angle.sin) + rest.max_exponent(angle.cos) == 0 {
                continue;
            }
            let cosines = self.in_cosines(&rest, angle)?;
            let (_, m, _) = cosines.split();
            let power = m.exponent(angle.cos);
            if power > 0 {
                let power = Mono::power(angle.cos, power)?;
                mono = mono.times(&power)?;
                let quotient = cosines.over_mono(&power).ok_or(Exceeded)?;
                let (c, m, r) = self.reduce(quotient)?.split();
                content = content * c;
                mono = mono.times(&m)?;
                rest = r;
            }
        }
        Ok((content, mono, rest))
    }

    /// The product of a denominator's factors.
    pub(super) fn expand(&self, den: &Denominator) -> Result<Poly> {
        let mut product = self.reduce(Poly::term(den.mono, Rational::ONE))?;
        for (poly, k) in &den.polys {
            product = self.times(&product, &self.powers(poly, *k)?)?;
        }
        Ok(product)
    }

    /// `1 / f`; a numerator that is zero has no inverse.
    pub(super) fn invert(&self, f: &Fraction) -> Result<Fraction> {
        if f.num.is_zero() {
            return Err(Exceeded);
        }
        let num = self.expand(&f.den)?;
        let inverse = self.inverse_of(&f.num, 0)?;
        self.product(&Fraction::whole(num), &inverse)
    }

    fn inverse_of(&self, p: &Poly, depth: u32) -> Result<Fraction> {
        // Radicands of radicands: nobody nests deeper.
        if depth > 4 {
            return Err(Exceeded);
        }
        let (content, mut mono, rest) = self.extract(p)?;
        let mut result = Fraction::whole(Poly::number(content.recip().ok_or(Exceeded)?));
        for relation in &self.relations {
            // 1/r^k = r^(q-k)/value
            let k = mono.exponent(relation.generator);
            if k > 0 {
                mono = mono.without(&Mono::mask([relation.generator]));
                let above = Poly::term(Mono::power(relation.generator, relation.order - k)?, Rational::ONE);
                let inverse = self.inverse_of(&relation.value, depth + 1)?;
                result = self.product(&result, &inverse)?;
                result.num = self.times(&result.num, &above)?;
            }
        }
        result.den.mono = result.den.mono.times(&mono)?;
        if rest.is_one() {
            return Ok(result);
        }
        *result.den.polys.entry(rest).or_default() += 1;
        Ok(result)
    }

    pub(super) fn product(&self, a: &Fraction, b: &Fraction) -> Result<Fraction> {
        if a.den.is_one() && b.den.is_one() {
            return Ok(Fraction::whole(self.times(&a.num, &b.num)?));
        }
        let mut den = a.den.clone();
        den.mono = den.mono.times(&b.den.mono)?;
        for (poly, k) in &b.den.polys {
            *den.polys.entry(poly.clone()).or_default() += k;
        }
        self.cancel(Fraction { num: self.times(&a.num, &b.num)?, den })
    }

    pub(super) fn power(&self, f: &Fraction, n: i32) -> Result<Fraction> {
        let inverse = if n < 0 { Some(self.invert(f)?) } else { None };
        let base = inverse.as_ref().unwrap_or(f);
        let mut result = base.clone();
        for _ in 1..n.unsigned_abs() {
            result = self.product(&result, base)?;
        }
        Ok(result)
    }

    /// The sum over a common denominator.
    pub(super) fn sum(&self, parts: &[(Fraction, Rational)]) -> Result<Fraction> {
        let mut den = Denominator::default();
        for (part, _) in parts {
            den.mono = den.mono.lcm(&part.den.mono);
            for (poly, k) in &part.den.polys {
                let slot = den.polys.entry(poly.clone()).or_default();
                *slot = (*slot).max(*k);
            }
        }
        let mut num = Poly::zero();
        for (part, c) in parts {
            let mut scaled = part.num.scaled(c);
            if part.den != den {
                let mut missing = den.clone();
                missing.mono = missing.mono.over(&part.den.mono).ok_or(Exceeded)?;
                for (poly, k) in &part.den.polys {
                    for _ in 0..*k {
                        missing.remove(poly);
                    }
                }
                scaled = self.times(&scaled, &self.expand(&missing)?)?;
            }
            num = num.plus(&scaled, &self.budget)?;
        }
        self.cancel(Fraction { num, den })
    }

    /// Common factors of numerator and denominator removed.
    pub(super) fn cancel(&self, mut f: Fraction) -> Result<Fraction> {
        if f.num.is_zero() {
            return Ok(Fraction::whole(Poly::zero()));
        }
        if f.den.is_one() {
            return Ok(f);
        }
        let common = f.num.split().1.gcd(&f.den.mono);
        if !common.is_one()
            && let (Some(num), Some(mono)) = (f.num.over_mono(&common), f.den.mono.over(&common))
        {
            (f.num, f.den.mono) = (num, mono);
        }
        for angle in &self.angles {
            let below = f.den.mono.exponent(angle.cos);
            if below > 0 {
                let cosines = self.in_cosines(&f.num, angle)?;
                let power = cosines.split().1.exponent(angle.cos).min(below);
                if power > 0 {
                    let power = Mono::power(angle.cos, power)?;
                    let quotient = cosines.over_mono(&power).ok_or(Exceeded)?;
                    f.num = self.reduce(quotient)?;
                    f.den.mono = f.den.mono.over(&power).ok_or(Exceeded)?;
                    // What is left may have a sine to give.
                    let sines = Mono::power(angle.sin, f.den.mono.exponent(angle.sin))?;
                    let common = f.num.split().1.gcd(&sines);
                    if !common.is_one() {
                        f.num = f.num.over_mono(&common).ok_or(Exceeded)?;
                        f.den.mono = f.den.mono.over(&common).ok_or(Exceeded)?;
                    }
                }
            }
        }
        for poly in f.den.polys.keys().cloned().collect::<Vec<_>>() {
            while f.den.polys.contains_key(&poly) {
                let Some(quotient) = self.divide(&f.num, &poly)? else { break };
                f.num = quotient;
                f.den.remove(&poly);
            }
        }
        Ok(f)
    }

    /// Denominators that divide one another taken apart, then everything cancelled again.
    pub(super) fn settle(&self, mut f: Fraction) -> Result<Fraction> {
        // Each round splits a factor, which lowers its degree.
        for _ in 0..16 {
            let polys: Vec<_> = f.den.polys.keys().cloned().collect();
            let mut split = None;
            'search: for large in &polys {
                for small in &polys {
                    if small != large
                        && small.len() <= large.len()
                        && let Some(quotient) = self.divide(large, small)?
                    {
                        split = Some((large.clone(), small.clone(), quotient));
                        break 'search;
                    }
                }
            }
            let Some((large, small, quotient)) = split else { break };
            let k = f.den.polys.remove(&large).ok_or(Exceeded)?;
            *f.den.polys.entry(small).or_default() += k;
            let rest = self.power(&self.inverse_of(&quotient, 0)?, k as i32)?;
            f = self.product(&f, &rest)?;
        }
        self.cancel(f)
    }
}
