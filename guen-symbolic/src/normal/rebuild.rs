//! Converts polynomials back into expressions: the cheapest of a few readable forms.

use std::collections::{BTreeMap, BTreeSet};

use crate::algebra::{ExprId, Graph, Rational};

use super::poly::{Exceeded, Mono, Poly, Result};
use super::ring::{Angle, Denominator, Fraction, Ring};

/// Coefficients with more terms than this are not searched for common factors.
const FACTORED_TERMS: usize = 40;
/// The number of different sums that are tried as factors of the others.
const CANDIDATES: usize = 8;
/// Nesting `m*(x + y) + z` deeper than this helps nobody.
const NESTING: u32 = 4;

/// The expression of a fraction whose common factors are cancelled.
pub(super) fn rebuild(graph: &mut Graph, ring: &Ring, f: &Fraction) -> Result<ExprId> {
    let (mut num, mut den) = (f.num.clone(), f.den.clone());
    if num.is_zero() {
        return Ok(graph.zero());
    }
    let roots = roots_below(ring, &mut num, &mut den)?;
    num = fewest_terms(ring, num, &den.mono)?;

    let den_constant = den.mono.part(&ring.constants);
    let den_variable = den.mono.without(&ring.constants);
    let mut constant_polys = Vec::new();
    let mut variable_polys = Vec::new();
    for (poly, k) in &den.polys {
        let constant = poly.terms.iter().all(|(mono, _)| mono.without(&ring.constants).is_one());
        if constant { constant_polys.push((poly, *k)) } else { variable_polys.push((poly, *k)) }
    }

    // Statics factor as a whole; equations of motion stay sums of their terms.
    let mut outside = Mono::ONE;
    if num.len() > 1 && !num.meets(&ring.motion) {
        outside = num.split().1;
        num = num.over_mono(&outside).ok_or(Exceeded)?;
    }

    let mut groups: BTreeMap<Mono, BTreeMap<Mono, Rational>> = BTreeMap::new();
    for (mono, c) in &num.terms {
        groups
            .entry(mono.without(&ring.constants))
            .or_default()
            .insert(mono.part(&ring.constants), c.clone());
    }
    let groups: Vec<(Mono, Poly)> =
        groups.into_iter().rev().map(|(m, terms)| (m, Poly::collect(terms))).collect();
    let candidates = candidates(&groups);
    // Denominators go to the terms if some term cancels with them.
    let spread = groups.len() == 1 || groups.iter().any(|(mono, _)| !mono.gcd(&den_variable).is_one());
    let mut terms = Vec::new();
    for (mono, coefficient) in &groups {
        let mut factors = Vec::new();
        let scale = constant_factors(
            graph,
            ring,
            coefficient,
            &den_constant,
            &constant_polys,
            &candidates,
            &mut factors,
        )?;
        monomial(ring, mono, 1, &mut factors);
        if spread {
            monomial(ring, &den_variable, -1, &mut factors);
        }
        terms.push((graph.product(&factors), scale));
    }
    let sum = graph.linear(&terms);
    let mut factors = vec![(sum, 1)];
    monomial(ring, &outside, 1, &mut factors);
    factors.extend(roots);
    if !spread {
        monomial(ring, &den_variable, -1, &mut factors);
    }
    for (poly, k) in variable_polys {
        let poly = fewest_terms(ring, poly.clone(), &Mono::ONE)?;
        factors.push((collected(graph, ring, &poly, 0)?, -(k as i32)));
    }
    Ok(graph.product(&factors))
}

/// A sum of terms without any factoring; arguments of functions are wanted so.
pub(super) fn expanded(graph: &mut Graph, ring: &Ring, f: &Fraction) -> Result<ExprId> {
    if !f.den.polys.is_empty() {
        return rebuild(graph, ring, f);
    }
    let mut terms = Vec::new();
    for (mono, c) in &f.num.terms {
        let mut factors = Vec::new();
        monomial(ring, mono, 1, &mut factors);
        monomial(ring, &f.den.mono, -1, &mut factors);
        terms.push((graph.product(&factors), c.clone()));
    }
    Ok(graph.linear(&terms))
}

fn monomial(ring: &Ring, mono: &Mono, sign: i32, factors: &mut Vec<(ExprId, i32)>) {
    if mono.is_one() {
        return;
    }
    for (i, id) in ring.generators.iter().enumerate() {
        let e = mono.exponent(i) as i32;
        if e != 0 {
            factors.push((*id, sign * e));
        }
    }
}

/// `r/x` with `r^2 = x` is `1/r`.
fn roots_below(ring: &Ring, num: &mut Poly, den: &mut Denominator) -> Result<Vec<(ExprId, i32)>> {
    let mut roots = Vec::new();
    for relation in ring.relations.iter().rev().filter(|relation| relation.order == 2) {
        let root = Mono::power(relation.generator, 1)?;
        let Some(quotient) = num.over_mono(&root) else { continue };
        let (content, mono, rest) = ring.extract(&relation.value)?;
        let Some(left) = den.mono.over(&mono) else { continue };
        if !rest.is_one() {
            let Some(k) = den.polys.get_mut(&rest) else { continue };
            *k -= 1;
            if *k == 0 {
                den.polys.remove(&rest);
            }
        }
        den.mono = left;
        *num = quotient.scaled(&content);
        roots.push((ring.generators[relation.generator], -1));
    }
    Ok(roots)
}

/// Squares of sines against squares of cosines, angle by angle, whichever needs fewer terms over this denominator.
fn fewest_terms(ring: &Ring, mut p: Poly, den: &Mono) -> Result<Poly> {
    for angle in &ring.angles {
        if p.max_exponent(angle.sin) >= 2 {
            p = fewest_terms_of(ring, &p, angle, den.exponent(angle.cos) / 2)?;
        }
    }
    Ok(p)
}

/// `half` is half of the exponent of the cosine in the denominator.
fn fewest_terms_of(ring: &Ring, p: &Poly, angle: &Angle, half: u32) -> Result<Poly> {
    let mask = Mono::mask([angle.sin]);
    // Everything but even powers of the sine -> coefficients by powers of w = sin^2; what differs in constants alone together.
    let mut classes: BTreeMap<Mono, BTreeMap<Mono, Vec<Rational>>> = BTreeMap::new();
    for (mono, c) in &p.terms {
        let e = mono.exponent(angle.sin);
        let rest = mono.without(&mask).times(&Mono::power(angle.sin, e % 2)?)?;
        let groups = classes.entry(rest.without(&ring.constants)).or_default();
        let row = groups.entry(rest).or_default();
        let place = (e / 2) as usize;
        if row.len() <= place {
            row.resize(place + 1, Rational::ZERO);
        }
        row[place] = c.clone();
    }
    let mut terms: BTreeMap<Mono, Rational> = BTreeMap::new();
    for groups in classes.into_values() {
        let written: Vec<(Mono, Squares)> =
            groups.iter().map(|(rest, row)| (*rest, fewest_squares(row))).collect();
        // `1 + tan^2` next to other terms, and not `1/cos^2`: squares of tangents and numbers take nothing from each other.
        let in_tangents: Option<Vec<(Mono, Squares)>> =
            groups.iter().map(|(rest, row)| Some((*rest, tangents(row, half as usize)?))).collect();
        let count = |written: &[(Mono, Squares)]| {
            let powers = written.iter().flat_map(|(_, squares)| squares.iter().map(|(s, k, _)| (*s, *k)));
            powers.collect::<BTreeSet<_>>().len()
        };
        let written = match in_tangents {
            Some(other) if count(&other) <= count(&written) => other,
            _ => written,
        };
        for (rest, squares) in written {
            for (s, k, c) in squares {
                let powers =
                    Mono::power(angle.sin, 2 * s as u32)?.times(&Mono::power(angle.cos, 2 * k as u32)?)?;
                let slot = terms.entry(rest.times(&powers)?).or_default();
                *slot = &*slot + &c;
            }
        }
    }
    ring.budget.spend(p.len())?;
    Ok(Poly::collect(terms))
}

/// Terms `c sin^2s cos^2k`, as `s`, `k` and `c`.
type Squares = Vec<(usize, usize, Rational)>;

/// A polynomial in `w = sin^2`, with powers of `1 - w` where these are fewer.
fn fewest_squares(row: &[Rational]) -> Squares {
    let low = row.iter().position(|c| !c.is_zero()).unwrap_or(0);
    let mut row = row[low..].to_vec();
    let mut cosines = 0;
    // Divisible by 1 - w as long as the coefficients add up to zero.
    while row.len() > 1 && row.iter().cloned().sum::<Rational>().is_zero() {
        let mut sum = Rational::ZERO;
        for c in &mut row {
            sum = &sum + c;
            *c = sum.clone();
        }
        row.pop();
        cosines += 1;
    }
    let in_cosines = complemented(&row);
    let count = |row: &[Rational]| row.iter().filter(|c| !c.is_zero()).count();
    let turned = count(&in_cosines) < count(&row);
    let found = if turned { in_cosines } else { row };
    let powers = |i: usize| if turned { (low, cosines + i) } else { (low + i, cosines) };
    found
        .into_iter()
        .enumerate()
        .filter(|(_, c)| !c.is_zero())
        .map(|(i, c)| (powers(i).0, powers(i).1, c))
        .collect()
}

/// Writes the polynomial over `cos^2h` in the square of the tangent: with `w^j (w + v)^(h - j)` for `w^j`. `None`
/// where the degree is larger, or nothing is divided by.
fn tangents(row: &[Rational], h: usize) -> Option<Squares> {
    if h == 0 || row.len() > h + 1 {
        return None;
    }
    let mut found = vec![Rational::ZERO; h + 1];
    for (j, c) in row.iter().enumerate() {
        let mut binomial = Rational::ONE;
        for i in 0..=h - j {
            found[j + i] = &found[j + i] + &(c * &binomial);
            binomial =
                &(&binomial * &Rational::integer((h - j - i) as i64)) * &Rational::new(1, i as i64 + 1);
        }
    }
    Some(found.into_iter().enumerate().filter(|(_, c)| !c.is_zero()).map(|(s, c)| (s, h - s, c)).collect())
}

/// The coefficients of `r(1 - v)` by powers of `v`.
fn complemented(row: &[Rational]) -> Vec<Rational> {
    let mut result: Vec<Rational> = Vec::new();
    for c in row.iter().rev() {
        // result * (1 - v) + c
        let mut next = result.clone();
        next.push(Rational::ZERO);
        for (i, r) in result.iter().enumerate() {
            next[i + 1] = &next[i + 1] - r;
        }
        next[0] = &next[0] + c;
        result = next;
    }
    result
}

/// Sums among the coefficients that may be factors of others.
fn candidates(groups: &[(Mono, Poly)]) -> Vec<Poly> {
    let mut found: Vec<Poly> = groups
        .iter()
        .filter(|(_, poly)| poly.len() > 1 && poly.len() <= FACTORED_TERMS)
        .map(|(_, poly)| poly.split().2)
        .filter(|poly| poly.len() > 1)
        .collect();
    found.sort_by(|a, b| a.len().cmp(&b.len()).then_with(|| a.cmp(b)));
    found.dedup();
    found.truncate(CANDIDATES);
    found
}

/// The factors of a constant coefficient over constant denominators; what is returned is the number in front.
fn constant_factors(
    graph: &mut Graph,
    ring: &Ring,
    coefficient: &Poly,
    den: &Mono,
    den_polys: &[(&Poly, u32)],
    candidates: &[Poly],
    factors: &mut Vec<(ExprId, i32)>,
) -> Result<Rational> {
    let (scale, mono, mut rest) = coefficient.split();
    monomial(ring, &mono, 1, factors);
    monomial(ring, den, -1, factors);
    for (poly, k) in den_polys {
        let mut left = *k;
        while left > 0 && rest.len() >= poly.len() {
            let Some(quotient) = rest.over(poly, &ring.budget)? else { break };
            rest = quotient;
            left -= 1;
        }
        if left > 0 {
            factors.push((collected(graph, ring, poly, 0)?, -(left as i32)));
        }
    }
    for candidate in candidates {
        while rest.len() > candidate.len() {
            let Some(quotient) = rest.over(candidate, &ring.budget)? else { break };
            factors.push((collected(graph, ring, candidate, 0)?, 1));
            rest = quotient;
        }
    }
    if !rest.is_one() {
        factors.push((collected(graph, ring, &rest, 0)?, 1));
    }
    Ok(scale)
}

/// A sum with shared powers of generators taken out: `m*(x + y) + z`.
fn collected(graph: &mut Graph, ring: &Ring, p: &Poly, depth: u32) -> Result<ExprId> {
    let (scale, mono, rest) = p.split();
    let mut factors = Vec::new();
    monomial(ring, &mono, 1, &mut factors);
    if rest.len() == 1 {
        let product = graph.product(&factors);
        return Ok(graph.scale(product, &scale));
    }
    let mut best: Option<(usize, Mono)> = None;
    if rest.len() > 2 && rest.len() <= FACTORED_TERMS && depth < NESTING {
        let mut counts: BTreeMap<Mono, usize> = BTreeMap::new();
        for (term, _) in &rest.terms {
            for i in 0..ring.generators.len() {
                let e = term.exponent(i);
                if e > 0 {
                    *counts.entry(Mono::power(i, e)?).or_default() += 1;
                }
            }
        }
        ring.budget.spend(rest.len())?;
        best = counts.into_iter().map(|(mono, n)| (n, mono)).max().filter(|(n, _)| *n > 1);
    }
    let sum = if let Some((_, power)) = best {
        let generator = Mono::mask((0..ring.generators.len()).filter(|i| power.exponent(*i) > 0));
        let (with, without): (Vec<_>, Vec<_>) =
            rest.terms.iter().cloned().partition(|(mono, _)| mono.part(&generator) == power);
        let with = collected(graph, ring, &Poly { terms: with }, depth + 1)?;
        let without = Poly { terms: without };
        let without =
            if without.is_zero() { graph.zero() } else { collected(graph, ring, &without, depth + 1)? };
        graph.add(with, without)
    } else {
        let mut terms = Vec::new();
        for (mono, c) in &rest.terms {
            let mut factors = Vec::new();
            monomial(ring, mono, 1, &mut factors);
            terms.push((graph.product(&factors), c.clone()));
        }
        graph.linear(&terms)
    };
    factors.push((sum, 1));
    let product = graph.product(&factors);
    Ok(graph.scale(product, &scale))
}
