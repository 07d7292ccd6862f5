//! Velocities of points of a plane, taken apart by the angles that they turn with.
//!
//! Two forms `X`, `Y` are the components of one vector if they turn together: as a number `X + i Y` of the complex plane
//! they are
//!
//! ```text
//! Z = sum_j (a_j + i b_j) w_j e^{i alpha_j}
//! ```
//!
//! with velocities `w_j` and coefficients `a_j`, `b_j` that know of no angle. A link of length `d` behind an axle has the
//! part `-i d theta' e^{i theta}`; the rates of Cartesian coordinates have no angle at all.

use crate::algebra::{ExprId, Function, Graph, Node, Rational};
use crate::motion::quasi_velocities::velocity_forms::VELOCITIES;
use crate::workbench::Workbench;

/// The velocity and the angle that an entry of a form belongs to: no velocity for an entry at rest, no angle for the
/// world's axes.
type Key = (Option<ExprId>, Option<ExprId>);

/// A form by velocities and by sines and cosines of single angles, in the order of these.
pub(super) struct Scalar(Vec<(Key, [ExprId; 2])>);

/// `(along + i across) velocity e^{i angle}`
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) velocity: Option<ExprId>,
    pub(super) angle: Option<ExprId>,
    pub(super) along: ExprId,
    pub(super) across: ExprId,
}

/// A velocity; equal ones have equal parts.
#[derive(Clone, PartialEq, Eq, Default)]
pub(super) struct Planar(pub(super) Vec<Part>);

impl Scalar {
    /// `None` for what is not affine as it is written, or has products of sines and cosines.
    pub(super) fn new(bench: &mut Workbench, e: ExprId) -> Option<Self> {
        let mut terms: Vec<(Key, [ExprId; 2])> = Vec::new();
        let mut stack = vec![(e, bench.graph.one())];
        while let Some((e, factor)) = stack.pop() {
            let graph = &mut bench.graph;
            if !graph.roles(e).meets(VELOCITIES) {
                terms.push(((None, None), [graph.mul(factor, e), graph.zero()]));
                continue;
            }
            match graph.node(e).clone() {
                Node::Symbol(_) => opened(graph, factor, &mut |graph, factor| {
                    terms.push(entry(graph, e, factor)?);
                    Some(())
                })?,
                Node::Kept(x) => stack.push((x, factor)),
                Node::Sum { constant, terms: own } => {
                    if !constant.is_zero() {
                        terms.push(((None, None), [graph.scale(factor, &constant), graph.zero()]));
                    }
                    for (term, c) in own.iter() {
                        stack.push((*term, graph.scale(factor, c)));
                    }
                }
                Node::Product(factors) => {
                    let moves = |(base, _): &&(ExprId, i32)| graph.roles(*base).meets(VELOCITIES);
                    let mut moving = factors.iter().filter(moves);
                    let (Some((base, 1)), None) = (moving.next(), moving.next()) else { return None };
                    let base = *base;
                    let others: Vec<_> = factors.iter().copied().filter(|own| own.0 != base).collect();
                    let others = graph.product(&others);
                    stack.push((base, graph.mul(factor, others)));
                }
                _ => return None,
            }
        }
        terms.sort_by_key(|(key, _)| *key);
        let mut merged: Vec<(Key, [ExprId; 2])> = Vec::new();
        for (key, own) in terms {
            match merged.last_mut() {
                Some((known, sums)) if *known == key => {
                    *sums = [0, 1].map(|k| bench.graph.add(sums[k], own[k]));
                }
                _ => merged.push((key, own)),
            }
        }
        merged.retain(|(_, own)| own.iter().any(|e| !bench.graph.is_zero(*e)));
        Some(Scalar(merged))
    }
}

/// The terms of a sum of products, one by one.
fn opened(
    graph: &mut Graph,
    e: ExprId,
    visit: &mut impl FnMut(&mut Graph, ExprId) -> Option<()>,
) -> Option<()> {
    match graph.node(e).clone() {
        Node::Sum { constant, terms } => {
            if !constant.is_zero() {
                let constant = graph.number(constant);
                visit(graph, constant)?;
            }
            terms.iter().try_for_each(|(term, c)| {
                let term = graph.scale(*term, c);
                visit(graph, term)
            })
        }
        _ => visit(graph, e),
    }
}

/// A velocity with a coefficient that has one sine or cosine, or none.
fn entry(graph: &mut Graph, velocity: ExprId, coefficient: ExprId) -> Option<(Key, [ExprId; 2])> {
    let zero = graph.zero();
    let (c, monomial) = graph.split_coefficient(coefficient);
    let turning = |graph: &Graph, e: ExprId| match graph.node(e) {
        Node::Function(function @ (Function::Sin | Function::Cos), x) if !graph.roles(e).is_constant() => {
            Some((*function, *x))
        }
        _ => None,
    };
    let factors = match graph.node(monomial) {
        Node::Product(factors) => factors.to_vec(),
        _ => vec![(monomial, 1)],
    };
    let mut found = None;
    let mut others = Vec::with_capacity(factors.len());
    for (base, k) in factors {
        match turning(graph, base) {
            Some(own) if k == 1 && found.is_none() => found = Some(own),
            _ => others.push((base, k)),
        }
    }
    let others = graph.product(&others);
    let has_angles = !graph.roles(others).is_constant()
        && graph.reachable(&[others], |_| false).into_iter().any(|e| turning(graph, e).is_some());
    if has_angles {
        return None;
    }
    let others = graph.scale(others, &c);
    Some(match found {
        None => ((Some(velocity), None), [others, zero]),
        Some((Function::Cos, angle)) => ((Some(velocity), Some(angle)), [others, zero]),
        Some((_, angle)) => ((Some(velocity), Some(angle)), [zero, others]),
    })
}

impl Planar {
    /// `X + i Y`, or `X - i Y`, if that is one vector.
    pub(super) fn new(bench: &mut Workbench, x: &Scalar, y: &Scalar, mirrored: bool) -> Option<Self> {
        let turning = |own: &Scalar| own.0.iter().filter(|((_, angle), _)| angle.is_some()).count();
        if turning(x) != turning(y) {
            return None;
        }
        let zero = bench.graph.zero();
        let mut parts = Vec::new();
        let (mut xs, mut ys) = (x.0.iter().peekable(), y.0.iter().peekable());
        loop {
            let key = match (xs.peek(), ys.peek()) {
                (Some((a, _)), Some((b, _))) => *a.min(b),
                (Some((a, _)), None) | (None, Some((a, _))) => *a,
                (None, None) => break,
            };
            let own = xs.next_if(|(known, _)| *known == key).map_or([zero; 2], |(_, own)| *own);
            let other = ys.next_if(|(known, _)| *known == key).map_or([zero; 2], |(_, own)| *own);
            let other = if mirrored { other.map(|e| bench.graph.neg(e)) } else { other };
            let (velocity, angle) = key;
            // a cos - b sin, and a sin + b cos
            if angle.is_some() && [own[0], bench.graph.neg(own[1])] != [other[1], other[0]] {
                return None;
            }
            parts.push(Part { velocity, angle, along: own[0], across: other[0] });
        }
        Some(Planar(parts))
    }

    /// The vector whose imaginary part in axes at `phi` is more by a form, and what there is of the form at rest: `c w` is that of
    /// `i c w e^{i phi}`, `c w cos(psi)` of `i c w e^{i (phi + psi)}`, and `c w sin(psi)` of `c w e^{i (phi + psi)}`.
    pub(super) fn with_component(self, bench: &mut Workbench, form: Scalar, angle: ExprId) -> (Self, ExprId) {
        let graph = &mut bench.graph;
        let mut resting = graph.zero();
        let mut parts = self.0;
        for ((velocity, between), [cosine, sine]) in form.0 {
            if velocity.is_none() {
                resting = cosine;
                continue;
            }
            let (own, along) = match between {
                None => (angle, graph.zero()),
                Some(between) => {
                    let ends = [graph.add(angle, between), graph.sub(angle, between)];
                    let [ahead, behind] = ends.map(|end| graph.linear_parts(end).len());
                    if behind < ahead { (ends[1], graph.neg(sine)) } else { (ends[0], sine) }
                }
            };
            match parts.iter_mut().find(|part| part.velocity == velocity && part.angle == Some(own)) {
                Some(part) => {
                    part.along = graph.add(part.along, along);
                    part.across = graph.add(part.across, cosine);
                }
                None => parts.push(Part { velocity, angle: Some(own), along, across: cosine }),
            }
        }
        parts.retain(|part| !graph.is_zero(part.along) || !graph.is_zero(part.across));
        parts.sort_by_key(|part| (part.velocity, part.angle));
        (Planar(parts), resting)
    }

    /// The vector by one that begins with a velocity `1 w` where that is possible: `Z = factor i^quarter Z~`. Equal velocities that
    /// were written in different multiples, and turned, are equal then.
    pub(super) fn normalised(self, bench: &mut Workbench) -> Option<(ExprId, bool, Self)> {
        let graph = &mut bench.graph;
        let first = self.0.iter().find(|part| part.velocity.is_some())?;
        let turned = graph.is_zero(first.along);
        let factor = if turned { first.across } else { first.along };
        if !graph.roles(factor).is_constant() || !graph.manifestly_nonzero(factor) {
            return None;
        }
        let parts = self.0.into_iter().map(|part| {
            // -i (a + i b) = b - i a
            let (along, across) =
                if turned { (part.across, graph.neg(part.along)) } else { (part.along, part.across) };
            Part { along: graph.div(along, factor), across: graph.div(across, factor), ..part }
        });
        let parts = parts.collect();
        Some((factor, turned, Planar(parts)))
    }

    /// Returns the parts that this vector has beyond another one whose velocities are among its own; `None` if they
    /// are not fewer.
    pub(super) fn beyond(&self, bench: &mut Workbench, other: &Planar) -> Option<Vec<Part>> {
        let same = |a: &Part, b: &Part| a.velocity == b.velocity && a.angle == b.angle;
        let is_there =
            |part: &Part| part.velocity.is_none() || self.0.iter().any(|own| own.velocity == part.velocity);
        if !other.0.iter().all(is_there) {
            return None;
        }
        let mut rest = Vec::new();
        for part in &self.0 {
            match other.0.iter().find(|known| same(known, part)) {
                Some(known) if known == part => {}
                Some(known) => {
                    let along = bench.graph.sub(part.along, known.along);
                    let across = bench.graph.sub(part.across, known.across);
                    rest.push(Part { along, across, ..*part });
                }
                None => rest.push(*part),
            }
        }
        for part in &other.0 {
            if !self.0.iter().any(|own| same(own, part)) {
                let (along, across) = (bench.graph.neg(part.along), bench.graph.neg(part.across));
                rest.push(Part { along, across, ..*part });
            }
        }
        (rest.len() < self.0.len()).then_some(rest)
    }
}

/// `sum_j (a_j + i b_j) e^{i (alpha_j - angle)}`, real and imaginary part, from triples `alpha_j, a_j, b_j`; by the angles between.
pub(super) fn turned(
    bench: &mut Workbench,
    by_angles: &[(Option<ExprId>, ExprId, ExprId)],
    angle: ExprId,
) -> [ExprId; 2] {
    let graph = &mut bench.graph;
    let mut sums: [Vec<(ExprId, Rational)>; 2] = Default::default();
    for (own, along, across) in by_angles {
        let between = match own {
            Some(own) => graph.sub(*own, angle),
            None => graph.neg(angle),
        };
        let (sine, cosine) = graph.sin_cos(between);
        sums[0].push((graph.mul(*along, cosine), Rational::ONE));
        sums[0].push((graph.mul(*across, sine), Rational::MINUS_ONE));
        sums[1].push((graph.mul(*along, sine), Rational::ONE));
        sums[1].push((graph.mul(*across, cosine), Rational::ONE));
    }
    sums.map(|terms| graph.linear(&terms))
}

#[cfg(test)]
mod tests {
    use super::{Part, Planar, Scalar, turned};
    use crate::algebra::{ExprId, Flow, Graph, Rational, Role};
    use crate::workbench::Workbench;

    /// The angles of links, and the velocities of the points that they join, the first of which moves.
    struct Chain {
        bench: Workbench,
        angles: Vec<ExprId>,
        velocities: Vec<[ExprId; 2]>,
    }

    impl Chain {
        fn last(&self) -> [ExprId; 2] {
            self.velocities[self.velocities.len() - 1]
        }
    }

    fn chain(links: usize) -> Chain {
        let mut g = Graph::new();
        let names = ["x", "y", "p", "q", "r"];
        let coordinates = names.map(|name| g.symbol(name, Role::Coordinate));
        let rates = names.map(|name| g.symbol(name, Role::Velocity));
        let [x, y, angles @ ..] = coordinates;
        let mut place = [x, y];
        let mut places = vec![place];
        for angle in &angles[..links] {
            let length = g.symbol("l", Role::Constant);
            let (s, c) = g.sin_cos(*angle);
            for (e, direction) in place.iter_mut().zip([c, s]) {
                let part = g.mul(length, direction);
                *e = g.sub(*e, part);
            }
            places.push(place);
        }
        let mut rate = Flow::new(&g, coordinates.into_iter().zip(rates));
        let velocities = places.into_iter().map(|place| place.map(|e| rate.of(&mut g, e))).collect();
        Chain { bench: Workbench::new(g), angles: angles.to_vec(), velocities }
    }

    fn planar(bench: &mut Workbench, [x, y]: [ExprId; 2], mirrored: bool) -> Option<Planar> {
        let (x, y) = (Scalar::new(bench, x)?, Scalar::new(bench, y)?);
        Planar::new(bench, &x, &y, mirrored)
    }

    /// The vector in axes at an angle.
    fn at(bench: &mut Workbench, parts: &[Part], angle: ExprId) -> [ExprId; 2] {
        let one = bench.graph.one();
        let by_angles: Vec<_> = parts
            .iter()
            .map(|part| {
                let [along, across] =
                    [part.along, part.across].map(|e| bench.graph.mul(e, part.velocity.unwrap_or(one)));
                (part.angle, along, across)
            })
            .collect();
        turned(bench, &by_angles, angle)
    }

    fn assert_equal(bench: &mut Workbench, a: ExprId, b: ExprId) {
        let difference = bench.graph.sub(a, b);
        assert!(bench.vanishes(difference), "{}", bench.graph.text(difference));
    }

    /// `X cos(phi) + Y sin(phi)` and `-X sin(phi) + Y cos(phi)`.
    fn expected(bench: &mut Workbench, [x, y]: [ExprId; 2], angle: ExprId) -> [ExprId; 2] {
        let (s, c) = bench.graph.sin_cos(angle);
        let minus = bench.graph.neg(s);
        [bench.dot(&[x, y], &[c, s]), bench.dot(&[x, y], &[minus, c])]
    }

    #[test]
    fn a_vector_in_axes_at_an_angle_is_what_it_was() {
        let chain = chain(3);
        let velocity = chain.last();
        let Chain { mut bench, angles, .. } = chain;
        let vector = planar(&mut bench, velocity, false).unwrap();
        for angle in angles {
            let found = at(&mut bench, &vector.0, angle);
            let expected = expected(&mut bench, velocity, angle);
            (0..2).for_each(|k| assert_equal(&mut bench, found[k], expected[k]));
        }
    }

    #[test]
    fn turned_and_longer_vectors_are_recognised() {
        let chain = chain(2);
        let velocity = chain.last();
        let mut bench = chain.bench;
        let plain = planar(&mut bench, velocity, false).unwrap().normalised(&mut bench).unwrap();
        assert!(plain.0 == bench.graph.one() && !plain.1);
        // 3 i (X + i Y)
        let [x, y] = velocity.map(|e| bench.graph.scale(e, &Rational::integer(3)));
        let other = [bench.graph.neg(y), x];
        let (factor, turned, vector) =
            planar(&mut bench, other, false).unwrap().normalised(&mut bench).unwrap();
        assert!(vector == plain.2 && turned && factor == bench.graph.number(3));
        // The sign of a component.
        let [x, y] = velocity;
        let mirrored = [x, bench.graph.neg(y)];
        assert!(planar(&mut bench, mirrored, false).is_none());
        assert!(planar(&mut bench, mirrored, true).unwrap() == plain.2);
    }

    #[test]
    fn components_of_different_points_are_no_vector() {
        let Chain { mut bench, velocities, .. } = chain(2);
        let ([x1, y1], [x, y]) = (velocities[1], velocities[2]);
        for pair in [[x, y1], [x1, y], [x, x], [y, y]] {
            assert!(planar(&mut bench, pair, false).is_none());
        }
    }

    #[test]
    fn what_a_form_has_besides_becomes_part_of_its_vector() {
        let Chain { mut bench, angles, velocities } = chain(0);
        let g = &mut bench.graph;
        let [a, b, c, resting] = ["a", "b", "c", "t"].map(|name| g.symbol(name, Role::Constant));
        let rates = ["p'", "q'", "r'"].map(|name| g.symbol(name, Role::Velocity));
        // Whichever way round the graph writes a difference: one angle is between the others.
        for (own, angle) in angles.iter().copied().enumerate() {
            // a w cos(alpha - phi) + b w sin(alpha - phi) of the others, c phi' and what is there at rest.
            let g = &mut bench.graph;
            let mut terms = vec![g.mul(c, rates[own])];
            for other in (0..3).filter(|other| *other != own) {
                let between = g.sub(angles[other], angle);
                let (s, c) = g.sin_cos(between);
                terms.push(g.product(&[(a, 1), (c, 1), (rates[other], 1)]));
                terms.push(g.product(&[(b, 1), (s, 1), (rates[other], 1)]));
            }
            let moving = g.sum(terms);
            let rest = g.add(moving, resting);
            let vector = planar(&mut bench, velocities[0], false).unwrap();
            let rest = Scalar::new(&mut bench, rest).unwrap();
            let (vector, still) = vector.with_component(&mut bench, rest, angle);
            assert_eq!(still, resting);
            // Each part at the shorter of two angles.
            let found: Vec<_> = vector.0.iter().filter_map(|part| part.angle).collect();
            assert!(found.len() == 3 && angles.iter().all(|angle| found.contains(angle)));
            let [_, found] = at(&mut bench, &vector.0, angle);
            let [_, expected] = expected(&mut bench, velocities[0], angle);
            let expected = bench.graph.add(expected, moving);
            assert_equal(&mut bench, found, expected);
        }
    }

    #[test]
    fn what_an_axle_has_beyond_another_is_a_link() {
        let chain = chain(3);
        let velocity = chain.last();
        let Chain { mut bench, angles, .. } = chain;
        let vector = planar(&mut bench, velocity, false).unwrap();
        let before = Planar(vector.0.iter().copied().filter(|part| part.angle != Some(angles[2])).collect());
        let rest = vector.beyond(&mut bench, &before).unwrap();
        assert!(rest.len() == 1 && rest[0].angle == Some(angles[2]));
        // Not the other way round: the longer one has a velocity that the shorter has not.
        assert!(before.beyond(&mut bench, &vector).is_none());
        assert!(vector.beyond(&mut bench, &vector).unwrap().is_empty());
    }
}
