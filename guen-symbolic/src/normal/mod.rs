//! Normal forms: rational functions of symbols, sines and cosines of base angles, roots and exponentials.
//!
//! What comes in is an expression; what goes out is an equal one, expanded, cancelled and written with few
//! operations, the same for differently written polynomials and quotients. Everything is exact. Work is
//! limited: whoever asks keeps the expression as it is where the answer is `None`.

mod convert;
mod poly;
mod rebuild;
mod ring;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use crate::algebra::{ExprId, Function, Graph, Node, Rational};
use crate::program::weighted_cost;
use convert::Angles;
use poly::{Exceeded, Mono, Poly, Result};
use ring::{Fraction, Ring};

/// Limits on a normal form. An expression beyond a limit has none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Terms of a polynomial.
    pub terms: usize,
    /// Symbols, sines, cosines and other functions; at most 32.
    pub generators: usize,
    /// The degree of a numerator in all generators together.
    pub degree: u32,
    /// Nodes of the expression.
    pub nodes: usize,
    /// Elementary steps, each about a product of two terms.
    pub steps: usize,
}

impl Default for Limits {
    /// Expressions that reach these limits took some milliseconds without optimisation.
    fn default() -> Self {
        Limits { terms: 400, generators: 32, degree: 48, nodes: 2_000, steps: 20_000 }
    }
}

impl Limits {
    /// Returns the limits for expressions that should be simplified only if that is easy.
    pub fn small() -> Self {
        Limits { terms: 60, generators: 24, degree: 24, nodes: 300, steps: 2_000 }
    }
}

/// An equal expression in normal form, or `None` beyond the limits.
///
/// ```
/// use guen_symbolic::{Graph, Limits, Role, normal_form};
/// let mut g = Graph::new();
/// let x = g.symbol("x", Role::Coordinate);
/// let (s, c) = g.sin_cos(x);
/// let (c2, one) = (g.powi(c, 2), g.one());
/// let e = g.sub(one, c2);
/// let e = g.div(e, s);
/// assert_eq!(normal_form(&mut g, e, &Limits::default()), Some(s));
/// ```
pub fn normal_form(g: &mut Graph, e: ExprId, limits: &Limits) -> Option<ExprId> {
    let prepared = prepare(g, e, limits);
    normalized(g, prepared, limits, false).ok()
}

/// The coefficients of an expression that is a polynomial in some symbols, each in normal form.
///
/// Exponents are in the order of `variables`, rows in descending order of exponents. `None` if it is no such
/// polynomial, or beyond the limits.
pub fn normal_coefficients(
    g: &mut Graph,
    e: ExprId,
    variables: &[ExprId],
    limits: &Limits,
) -> Option<Vec<(Vec<u32>, ExprId)>> {
    let prepared = prepare(g, e, limits);
    coefficients(g, prepared, variables, limits).ok()
}

fn coefficients(
    g: &mut Graph,
    e: ExprId,
    variables: &[ExprId],
    limits: &Limits,
) -> Result<Vec<(Vec<u32>, ExprId)>> {
    let (ring, f) = convert::convert(g, e, limits, Angles::Apart)?;
    let places: Vec<_> = variables.iter().map(|v| ring.generators.iter().position(|id| id == v)).collect();
    let mask = Mono::mask(places.iter().flatten().copied());
    if !f.den.mono.part(&mask).is_one() || f.den.polys.keys().any(|poly| poly.meets(&mask)) {
        return Err(Exceeded);
    }
    // A function of a variable is no polynomial in it.
    let used = |i: &usize| f.num.max_exponent(*i) > 0 || f.den.mono.exponent(*i) > 0;
    let functions: Vec<_> = (0..ring.generators.len())
        .filter(|i| used(i) || f.den.polys.keys().any(|poly| poly.max_exponent(*i) > 0))
        .map(|i| ring.generators[i])
        .filter(|id| g.as_symbol(*id).is_none())
        .collect();
    let inside = g.symbols_in(&functions);
    if variables.iter().any(|v| g.as_symbol(*v).is_none_or(|symbol| inside.contains(&symbol))) {
        return Err(Exceeded);
    }
    let mut rows: BTreeMap<Vec<u32>, BTreeMap<Mono, Rational>> = BTreeMap::new();
    for (mono, c) in &f.num.terms {
        let exponents = places.iter().map(|place| place.map_or(0, |i| mono.exponent(i))).collect();
        rows.entry(exponents).or_default().insert(mono.without(&mask), c.clone());
    }
    let mut result = Vec::new();
    for (exponents, terms) in rows.into_iter().rev() {
        let part = ring.cancel(Fraction { num: Poly::collect(terms), den: f.den.clone() })?;
        result.push((exponents, finish(g, &ring, &part, limits, DOUBLINGS)?));
    }
    Ok(result)
}

/// Fractions of an angle with denominators up to 12 are doubled three times at most. With base angles of several terms one
/// doubled angle can bring back half of another for ever: after so many rounds the expression stays as it is.
const DOUBLINGS: u32 = 4;

fn normalized(g: &mut Graph, e: ExprId, limits: &Limits, flat: bool) -> Result<ExprId> {
    let (ring, f) = convert::convert(g, e, limits, Angles::Apart)?;
    if flat { rebuild::expanded(g, &ring, &f) } else { finish(g, &ring, &f, limits, DOUBLINGS) }
}

/// The normal form of an argument in which sines and cosines are what they are.
fn with_whole_angles(g: &mut Graph, e: ExprId, limits: &Limits) -> Result<ExprId> {
    let (ring, f) = convert::convert(g, e, limits, Angles::Whole)?;
    rebuild::expanded(g, &ring, &f)
}

/// The expression of a fraction; half angles that occur in pairs become whole ones first, at most so many times. Half angles stay where the
/// fraction is divided by their sine or cosine: near a zero of `cos(x/2)`, `1 + cos(x)` cancels.
fn finish(g: &mut Graph, ring: &Ring, f: &Fraction, limits: &Limits, doublings: u32) -> Result<ExprId> {
    let mut doubled = false;
    let mut replaced: Vec<Option<(ExprId, ExprId, ExprId)>> = vec![None; ring.angles.len()];
    for (i, angle) in ring.angles.iter().enumerate() {
        let Some(double) = angle.double else { continue };
        let parity = |mono: &Mono| (mono.exponent(angle.sin) + mono.exponent(angle.cos)).is_multiple_of(2);
        let even = |p: &Poly| p.terms.iter().all(|(mono, _)| parity(mono));
        let occurs = |p: &Poly| p.max_exponent(angle.sin) + p.max_exponent(angle.cos) > 0;
        let polys = || f.den.polys.keys().chain([&f.num]);
        let den = f.den.mono.exponent(angle.sin) + f.den.mono.exponent(angle.cos) > 0;
        if !den && polys().all(even) && polys().any(occurs) {
            let (s, c) = g.sin_cos(double);
            // sin^2, cos^2 and sin cos of the half angle.
            let one = g.one();
            let half = Rational::new(1, 2);
            let below = g.linear(&[(one, half.clone()), (c, -half.clone())]);
            let above = g.linear(&[(one, half.clone()), (c, half.clone())]);
            replaced[i] = Some((below, above, g.scale(s, &half)));
            doubled = true;
        }
    }
    if !doubled || doublings == 0 {
        return rebuild::rebuild(g, ring, f);
    }
    let term = |g: &mut Graph, mono: &Mono| {
        let mut factors = Vec::new();
        for (i, id) in ring.generators.iter().enumerate() {
            let e = mono.exponent(i) as i32;
            let place = ring.angles.iter().position(|angle| angle.sin == i || angle.cos == i);
            match place.and_then(|place| replaced[place].map(|images| (&ring.angles[place], images))) {
                _ if e == 0 => {}
                Some((angle, (below, above, both))) => {
                    if angle.sin == i {
                        factors.push((below, e / 2));
                        if e % 2 == 1 {
                            factors.push((both, 1));
                        }
                    } else {
                        factors.push((above, e / 2));
                    }
                }
                None => factors.push((*id, e)),
            }
        }
        g.product(&factors)
    };
    let sum = |g: &mut Graph, p: &Poly| {
        let terms: Vec<_> = p.terms.iter().map(|(mono, c)| (term(g, mono), c.clone())).collect();
        g.linear(&terms)
    };
    let mut factors = vec![(sum(g, &f.num), 1), (sum(g, &Poly::term(f.den.mono, Rational::ONE)), -1)];
    for (poly, k) in &f.den.polys {
        factors.push((sum(g, poly), -(*k as i32)));
    }
    let e = g.product(&factors);
    let (ring, f) = convert::convert(g, e, limits, Angles::Apart)?;
    finish(g, &ring, &f, limits, doublings - 1)
}

/// Arguments of functions in normal form, innermost first. Sines and cosines in an argument stay whole where that is as cheap: `sin(2 t)`
/// is no product. Of arguments with one normal form all are written as the first.
fn prepare(g: &mut Graph, e: ExprId, limits: &Limits) -> ExprId {
    // What is kept whole is a generator: nothing inside it is looked at.
    let kept = |g: &Graph, id: ExprId| matches!(g.node(id), Node::Kept(_));
    let pending = g.reachable(&[e], |id| kept(g, id));
    let simple = pending.iter().all(|id| match g.node(*id) {
        Node::Function(_, x) => g.is_sum_of_monomials(*x),
        Node::Multivariate(_, arguments) => arguments.iter().all(|x| g.is_sum_of_monomials(*x)),
        _ => true,
    });
    if simple || pending.len() > limits.nodes {
        return e;
    }
    let inside: Vec<ExprId> = g.reachable(&[e], |_| false).into_iter().filter(|id| kept(g, *id)).collect();
    let mut images: BTreeMap<ExprId, ExprId> = inside.iter().map(|id| (*id, *id)).collect();
    let mut written: BTreeMap<(ExprId, bool), ExprId> = BTreeMap::new();
    for id in pending {
        let mut argument = |g: &mut Graph, x: ExprId, flat: bool| {
            let x = images[&x];
            if g.is_sum_of_monomials(x) {
                return x;
            }
            let Ok(normal) = normalized(g, x, limits, flat) else { return x };
            *written.entry((normal, flat)).or_insert_with(|| match with_whole_angles(g, x, limits) {
                Ok(whole) if flat && weighted_cost(g, &[whole]) <= weighted_cost(g, &[normal]) => whole,
                _ => normal,
            })
        };
        let image = match g.node(id).clone() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => id,
            Node::Sum { constant, terms } => {
                let mut terms: Vec<_> = terms.iter().map(|(term, c)| (images[term], c.clone())).collect();
                terms.push((g.number(constant), Rational::ONE));
                g.linear(&terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|(base, e)| (images[base], *e)).collect();
                g.product(&factors)
            }
            Node::Function(function, x) => {
                let flat = matches!(function, Function::Sin | Function::Cos | Function::Exp);
                let x = argument(g, x, flat);
                g.function(function, x)
            }
            Node::Kept(x) => g.keep(images[&x]),
            Node::Multivariate(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|x| argument(g, *x, false)).collect();
                g.multivariate(function, &arguments)
            }
        };
        images.insert(id, image);
    }
    images[&e]
}
