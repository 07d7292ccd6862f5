//! Converts expressions into a ring: finds generators, then converts nodes, children first.

use std::collections::BTreeMap;

use crate::algebra::{AngleParts, ExprId, FastMap, Function, Graph, Node, Rational, Role, Roles, sort_ids};

use super::Limits;
use super::poly::{Budget, Exceeded, MAX_GENERATORS, Mono, Poly, Result};
use super::ring::{Angle, Denominator, Fraction, Relation, Ring};

/// Multiples of a base angle are expanded up to here; others are angles of their own.
const MAX_MULTIPLE: i64 = 6;
/// Multiples of the exponent of an exponential.
const MAX_EXPONENTIAL: i64 = 16;
/// Denominators of fractions of angles.
const MAX_FRACTION: i64 = 12;
/// Angles that are added in one argument.
const MAX_SUMMANDS: usize = 4;

pub(super) const MOTION: Roles =
    Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity)).or(Roles::of(Role::QuasiAcceleration));

/// The image of a node in the ring.
#[derive(Clone, Debug)]
enum Image {
    Generator,
    /// A sine or cosine: multiples of base angles.
    Angle(Vec<(ExprId, i64)>),
    Exponential(Vec<(ExprId, i64)>),
}

fn fits(parts: &[(ExprId, Rational)]) -> bool {
    parts.len() <= MAX_SUMMANDS
        && parts.iter().all(|(_, c)| {
            c.to_i64_pair()
                .is_some_and(|(n, d)| n.abs() <= MAX_FRACTION * MAX_EXPONENTIAL && d <= MAX_FRACTION)
        })
}

struct Collector<'g> {
    graph: &'g mut Graph,
    images: BTreeMap<ExprId, Image>,
    generators: Vec<ExprId>,
    angles: Vec<(ExprId, ExprId, ExprId, Option<ExprId>)>,
    are_whole: bool,
}

impl Collector<'_> {
    fn generator(&mut self, id: ExprId) {
        if !self.generators.contains(&id) {
            self.generators.push(id);
        }
    }

    fn angle(&mut self, base: ExprId, double: Option<ExprId>) -> bool {
        if self.angles.iter().any(|angle| angle.0 == base) {
            return true;
        }
        let (sin, cos) = (self.graph.sin(base), self.graph.cos(base));
        let is = |f, id| matches!(*self.graph.node(id), Node::Function(g, x) if g == f && x == base);
        if !is(Function::Sin, sin) || !is(Function::Cos, cos) {
            return false;
        }
        self.angles.push((base, sin, cos, double));
        self.generator(sin);
        self.generator(cos);
        true
    }

    /// The terms of an argument: of sines and cosines by base angles.
    fn parts(&self, x: ExprId, exponential: bool) -> AngleParts {
        if exponential { self.graph.linear_parts(x) } else { self.graph.angle_parts(x) }
    }

    /// Base angles, or exponents, of all functions of one family, and each function as multiples of them.
    fn family(&mut self, nodes: &[(ExprId, Function, ExprId)], exponential: bool) {
        let most = if exponential { MAX_EXPONENTIAL } else { MAX_MULTIPLE };
        let mut lcm: BTreeMap<ExprId, i64> = BTreeMap::new();
        let parts: Vec<AngleParts> = nodes.iter().map(|(_, _, x)| self.parts(*x, exponential)).collect();
        for (term, c) in parts.iter().filter(|parts| fits(parts)).flatten() {
            let d = c.to_i64_pair().map_or(1, |pair| pair.1);
            let slot = lcm.entry(*term).or_insert(1);
            let common = num_integer::lcm(*slot, d);
            *slot = if common <= MAX_FRACTION { common } else { *slot };
        }
        for ((id, _, x), parts) in nodes.iter().zip(parts) {
            let mut multiples = Some(Vec::new()).filter(|_| !self.are_whole && fits(&parts));
            for (term, c) in &parts {
                let l = lcm.get(term).copied().unwrap_or(1);
                let k = (c * &Rational::integer(l)).to_i64().filter(|k| k.abs() <= most);
                let Some(k) = k.filter(|_| multiples.is_some()) else {
                    multiples = None;
                    break;
                };
                let base = self.graph.scale(*term, &Rational::new(1, l));
                let known = if exponential {
                    let value = self.graph.exp(base);
                    let known =
                        matches!(*self.graph.node(value), Node::Function(Function::Exp, y) if y == base);
                    if known {
                        self.generator(value);
                    }
                    known
                } else {
                    let double = (l % 2 == 0).then(|| self.graph.scale(base, &Rational::integer(2)));
                    self.angle(base, double)
                };
                if !known {
                    multiples = None;
                    break;
                }
                if let Some(list) = &mut multiples {
                    list.push((base, k));
                }
            }
            let image = match multiples {
                Some(multiples) if exponential => Image::Exponential(multiples),
                Some(multiples) => Image::Angle(multiples),
                None if exponential => {
                    self.generator(*id);
                    Image::Generator
                }
                None => {
                    // The whole argument is an angle of its own.
                    if self.angle(*x, None) {
                        Image::Angle(vec![(*x, 1)])
                    } else {
                        self.generator(*id);
                        Image::Generator
                    }
                }
            };
            self.images.insert(*id, image);
        }
    }
}

/// Images of sines and cosines of multiples and sums of angles, and of exponentials.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Angles {
    /// Polynomials of those of base angles.
    Apart,
    /// Generators of their own.
    Whole,
}

/// The ring of an expression and the expression in it.
pub(super) fn convert(
    graph: &mut Graph,
    e: ExprId,
    limits: &Limits,
    angles: Angles,
) -> Result<(Ring, Fraction)> {
    // Radicands are converted, arguments of all other functions are not entered.
    let mut nodes = Vec::new();
    let mut stack = vec![e];
    let mut seen: FastMap<ExprId, ()> = FastMap::default();
    while let Some(id) = stack.pop() {
        if seen.insert(id, ()).is_some() {
            continue;
        }
        if seen.len() > limits.nodes {
            return Err(Exceeded);
        }
        nodes.push(id);
        match graph.node(id) {
            Node::Sum { .. } | Node::Product(_) | Node::Function(Function::Root(_) | Function::Abs, _) => {
                graph.visit_children(id, |child| stack.push(child));
            }
            _ => {}
        }
    }
    sort_ids(&mut nodes);
    let are_whole = angles == Angles::Whole;
    let mut collector =
        Collector { graph, images: BTreeMap::new(), generators: Vec::new(), angles: Vec::new(), are_whole };
    let (mut trigonometric, mut exponentials) = (Vec::new(), Vec::new());
    for id in &nodes {
        match *collector.graph.node(*id) {
            Node::Undefined => return Err(Exceeded),
            Node::Function(f @ (Function::Sin | Function::Cos), x) => trigonometric.push((*id, f, x)),
            Node::Function(f @ Function::Exp, x) => exponentials.push((*id, f, x)),
            Node::Symbol(_) | Node::Pi | Node::Function(..) | Node::Multivariate(..) | Node::Kept(_) => {
                collector.generator(*id)
            }
            _ => {}
        }
    }
    collector.family(&trigonometric, false);
    collector.family(&exponentials, true);
    let Collector { images, mut generators, mut angles, .. } = collector;
    if generators.len() > limits.generators.min(MAX_GENERATORS) {
        return Err(Exceeded);
    }
    generators.sort_by_key(|id| (class(graph, *id), graph.key(*id)));
    angles.sort_by_key(|angle| graph.key(angle.0));
    let index = |id: ExprId| generators.iter().position(|g| *g == id).ok_or(Exceeded);
    let angles = angles
        .iter()
        .map(|(base, sin, cos, double)| {
            Ok(Angle { base: *base, sin: index(*sin)?, cos: index(*cos)?, double: *double })
        })
        .collect::<Result<Vec<_>>>()?;
    let of_class = |wanted: fn(Roles) -> bool| {
        Mono::mask((0..generators.len()).filter(|i| wanted(graph.roles(generators[*i]))))
    };
    let constants = of_class(|roles| roles.is_constant());
    let motion = of_class(|roles| roles.meets(MOTION));
    let mut ring = Ring {
        constants,
        motion,
        generators,
        angles,
        relations: Vec::new(),
        budget: Budget::new(limits.steps, limits.terms),
    };
    let mut values: FastMap<ExprId, Fraction> = FastMap::default();
    for id in nodes {
        let value = node_value(graph, &mut ring, &values, &images, id)?;
        if value.num.exceeds(limits.degree) {
            return Err(Exceeded);
        }
        values.insert(id, value);
    }
    let value = values.get(&e).cloned().ok_or(Exceeded)?;
    let value = ring.settle(value)?;
    Ok((ring, value))
}

/// Motion first, then functions of coordinates and time, then constants: the leading term is the one a reader would name.
fn class(graph: &Graph, id: ExprId) -> u8 {
    let roles = graph.roles(id);
    if roles.meets(MOTION) {
        0
    } else if !roles.is_constant() {
        1
    } else {
        2
    }
}

fn node_value(
    graph: &mut Graph,
    ring: &mut Ring,
    values: &FastMap<ExprId, Fraction>,
    images: &BTreeMap<ExprId, Image>,
    id: ExprId,
) -> Result<Fraction> {
    let position = |ring: &Ring, id: ExprId| ring.generators.iter().position(|g| *g == id).ok_or(Exceeded);
    let generator = |ring: &Ring, id: ExprId| {
        Ok(Fraction::whole(Poly::term(Mono::power(position(ring, id)?, 1)?, Rational::ONE)))
    };
    ring.budget.spend(1)?;
    match graph.node(id).clone() {
        Node::Number(value) => Ok(Fraction::whole(Poly::number(value))),
        Node::Sum { constant, terms } => {
            let mut parts = vec![(Fraction::whole(Poly::number(constant)), Rational::ONE)];
            parts.extend(terms.iter().map(|(term, c)| (values[term].clone(), c.clone())));
            ring.sum(&parts)
        }
        Node::Product(factors) => {
            let mut product: Option<Fraction> = None;
            for (base, e) in &factors {
                let power = ring.power(&values[base], *e)?;
                product = Some(match product {
                    None => power,
                    Some(product) => ring.product(&product, &power)?,
                });
            }
            Ok(product.unwrap_or_else(|| Fraction::whole(Poly::one())))
        }
        Node::Function(f @ (Function::Root(_) | Function::Abs), x) => {
            let (order, value) = match f {
                Function::Root(q) => (q, values[&x].clone()),
                _ => (2, ring.power(&values[&x], 2)?),
            };
            // A root of a quotient stays without a relation: the graph itself knows enough of it.
            if value.den.is_one() {
                ring.relations.push(Relation { generator: position(ring, id)?, order, value: value.num });
            }
            generator(ring, id)
        }
        Node::Function(f @ (Function::Sin | Function::Cos), _) => match images.get(&id) {
            Some(Image::Angle(multiples)) => {
                let (mut sin, mut cos) = (Poly::zero(), Poly::one());
                for (base, k) in multiples {
                    let angle = ring.angles.iter().find(|angle| angle.base == *base).ok_or(Exceeded)?;
                    let power = |generator| Ok(Poly::term(Mono::power(generator, 1)?, Rational::ONE));
                    let (s, c) = (power(angle.sin)?, power(angle.cos)?);
                    let s = if *k < 0 { s.scaled(&Rational::MINUS_ONE) } else { s };
                    if sin.is_zero() && k.abs() == 1 {
                        // The two sums of the first turn.
                        ring.budget.spend(2)?;
                        (sin, cos) = (s, c);
                        continue;
                    }
                    for _ in 0..k.abs() {
                        let next = ring.times(&sin, &c)?.plus(&ring.times(&cos, &s)?, &ring.budget)?;
                        let minus = ring.times(&sin, &s)?.scaled(&Rational::MINUS_ONE);
                        cos = ring.times(&cos, &c)?.plus(&minus, &ring.budget)?;
                        sin = next;
                    }
                }
                Ok(Fraction::whole(if f == Function::Sin { sin } else { cos }))
            }
            _ => generator(ring, id),
        },
        Node::Function(Function::Exp, _) => match images.get(&id) {
            Some(Image::Exponential(multiples)) => {
                let (mut above, mut below) = (Mono::ONE, Mono::ONE);
                for (base, k) in multiples {
                    let value = graph.exp(*base);
                    let power = Mono::power(position(ring, value)?, k.unsigned_abs() as u32)?;
                    let side = if *k > 0 { &mut above } else { &mut below };
                    *side = side.times(&power)?;
                }
                let den = Denominator { mono: below, polys: BTreeMap::new() };
                Ok(Fraction { num: Poly::term(above, Rational::ONE), den })
            }
            _ => generator(ring, id),
        },
        Node::Undefined => Err(Exceeded),
        Node::Symbol(_) | Node::Pi | Node::Function(..) | Node::Multivariate(..) | Node::Kept(_) => {
            generator(ring, id)
        }
    }
}
