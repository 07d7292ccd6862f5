//! Velocities of points along and across the axle that a constraint gives them.
//!
//! In the world's axes the velocity of an axle is that of the one before it less what the constraint takes away: where the
//! angle of the axle is small, a small difference of large numbers. Along itself it is `v cos(bend)`, and what turns it
//! `v sin(bend)`, with the angle between it and the axle before. So where a form is `-X sin(phi) + Y cos(phi)` of a vector
//! `X + i Y` (`planar`), the vector has two velocities of its own,
//!
//! ```text
//! u + i w = e^{-i phi} (X + i Y),
//! ```
//!
//! by those of the axle that it differs least from. The form is `w`, and with it one of them is known from the start.

use super::planar::{Part, Planar, Scalar, turned};
use super::unknowns::Unknowns;
use super::{Point, Written};
use crate::algebra::{ExprId, Function, Graph, Node, Rational, Role};
use crate::motion::definition::projection::MeasuredForms;
use crate::motion::quasi_velocities::velocity_forms::VELOCITIES;
use crate::motion::thresholds::PRODUCTS_OF_AN_ANGLE;
use crate::motion::{KineticTerm, Mechanics};
use crate::workbench::Workbench;

/// A vector that a form takes apart.
struct Axle {
    vector: Planar,
    angle: ExprId,
    /// The symbols of `u` and `w`.
    symbols: [ExprId; 2],
    /// `u` and `w` by those of other axles.
    values: [ExprId; 2],
}

/// A form `factor*w + rest`, or with `u`.
struct Contact {
    form: usize,
    vector: Planar,
    angle: ExprId,
    factor: ExprId,
    /// Whether it is `u`.
    along: bool,
    rest: ExprId,
}

/// The forms of a system by the velocities of axles; `None` where no axle is known from another one.
pub(super) fn written(
    bench: &mut Workbench,
    system: &Mechanics,
    unknowns: &mut Unknowns,
    in_world: &Written,
    measured: &MeasuredForms,
) -> Option<Written> {
    let contacts = in_world.forms.iter().enumerate();
    let mut contacts: Vec<Contact> = contacts.filter_map(|(v, e)| contact(bench, v, *e)).collect();
    // Stable: those of one length in the order of the declaration.
    contacts.sort_by_key(|contact| contact.vector.0.len());
    if contacts.windows(2).all(|pair| pair[0].vector == pair[1].vector) {
        return None;
    }
    let mut found: Vec<Axle> = Vec::new();
    let mut own = Written { forms: in_world.forms.clone(), ..Written::default() };
    let mut is_nested = false;
    for Contact { form, vector, angle, factor, along, rest } in contacts {
        let known = found.iter().position(|axle| axle.angle == angle && axle.vector == vector);
        let place = match known {
            Some(place) => place,
            None => {
                let near = nearest(bench, &found, &vector);
                is_nested |= near.is_some();
                let (axle, rest) = near.map_or((None, vector.0.clone()), |(axle, rest)| (Some(axle), rest));
                let values = taken_apart(bench, axle, &rest, angle);
                let symbols = [0; 2].map(|_| bench.graph.symbol("", Role::QuasiVelocity));
                own.definitions.insert(symbols[0], values[0]);
                own.definitions.insert(symbols[1], values[1]);
                found.push(Axle { vector, angle, symbols, values });
                found.len() - 1
            }
        };
        let component = usize::from(!along);
        let Axle { symbols, values, .. } = &found[place];
        if !bench.graph.roles(rest).meets(VELOCITIES) {
            let part = bench.graph.sub(system.etas[form], rest);
            let part = bench.graph.div(part, factor);
            own.definitions.insert(symbols[component], part);
        }
        let value = bench.graph.mul(factor, values[component]);
        own.forms[form] = bench.graph.add(value, rest);
    }
    if !is_nested {
        return None;
    }
    energy(bench, unknowns, &found, &in_world.terms, measured, &mut own);
    Some(own)
}

/// Pairs of squares that are those of a vector, by the axle that it differs least from.
fn energy(
    bench: &mut Workbench,
    unknowns: &mut Unknowns,
    axles: &[Axle],
    terms: &[KineticTerm],
    forms: &MeasuredForms,
    written: &mut Written,
) {
    // Components along and across are those of accelerations only where the exterior derivatives vanish.
    let is_closed = |bench: &Workbench, u: &ExprId| forms[u].turning.iter().all(|e| bench.graph.is_zero(*e));
    let scalars: Vec<Option<Scalar>> = terms
        .iter()
        .map(|term| match term.forms[..] {
            [u, v] if u == v && is_closed(bench, &u) => {
                let u = unknowns.form(bench, u);
                Scalar::new(bench, u)
            }
            _ => None,
        })
        .collect();
    let mut taken = vec![false; terms.len()];
    for i in 0..terms.len() {
        let Some(x) = scalars[i].as_ref().filter(|_| !taken[i]) else { continue };
        let pair = (i + 1..terms.len()).find_map(|j| {
            let y = scalars[j].as_ref().filter(|_| !taken[j] && terms[j].weight == terms[i].weight)?;
            [false, true].into_iter().find_map(|mirrored| {
                let (factor, _, vector) = Planar::new(bench, x, y, mirrored)?.normalised(bench)?;
                let (axle, rest) = nearest(bench, axles, &vector)?;
                Some((j, factor, axle, rest))
            })
        });
        let Some((j, factor, axle, rest)) = pair else { continue };
        (taken[i], taken[j]) = (true, true);
        // In the axes of what turns last.
        let angle = rest.iter().filter_map(|part| part.angle).next_back().unwrap_or(axle.angle);
        let velocities = taken_apart(bench, Some(axle), &rest, angle);
        let weight = bench.graph.product(&[(terms[i].weight, 1), (factor, 2)]);
        let forms = [0; 2].map(|_| bench.graph.symbol("", Role::QuasiVelocity));
        written.terms.extend(forms.map(|u| KineticTerm { weight, forms: vec![u, u] }));
        written.points.push(Point { angle, forms, velocities });
    }
    let others = terms.iter().zip(&taken).filter(|(_, taken)| !**taken).map(|(term, _)| term.clone());
    written.terms.extend(others);
}

/// The axle that a vector differs least from, if one is near, and what there is beyond it.
fn nearest<'a>(bench: &mut Workbench, axles: &'a [Axle], vector: &Planar) -> Option<(&'a Axle, Vec<Part>)> {
    let mut best: Option<(&Axle, Vec<Part>)> = None;
    for axle in axles {
        let Some(rest) = vector.beyond(bench, &axle.vector) else { continue };
        if best.as_ref().is_none_or(|(_, shortest)| rest.len() < shortest.len()) {
            best = Some((axle, rest));
        }
    }
    best
}

/// A vector by an axle and what there is beyond it, in axes at an angle.
fn taken_apart(bench: &mut Workbench, axle: Option<&Axle>, rest: &[Part], angle: ExprId) -> [ExprId; 2] {
    // What turns together is added before it is turned.
    let mut by_angles: Vec<(Option<ExprId>, [Vec<ExprId>; 2])> = Vec::new();
    if let Some(axle) = axle {
        by_angles.push((Some(axle.angle), axle.symbols.map(|symbol| vec![symbol])));
    }
    for part in rest {
        let place = by_angles.iter().position(|(known, _)| *known == part.angle).unwrap_or_else(|| {
            by_angles.push((part.angle, Default::default()));
            by_angles.len() - 1
        });
        for (sum, coefficient) in by_angles[place].1.iter_mut().zip([part.along, part.across]) {
            let velocity = part.velocity.unwrap_or(bench.graph.one());
            sum.push(bench.graph.mul(coefficient, velocity));
        }
    }
    let by_angles: Vec<_> = by_angles
        .into_iter()
        .map(|(own, [along, across])| (own, bench.graph.sum(along), bench.graph.sum(across)))
        .collect();
    turned(bench, &by_angles, angle)
}

/// A form as what it takes of a vector, by the angle in which the vector is the shortest.
fn contact(bench: &mut Workbench, form: usize, e: ExprId) -> Option<Contact> {
    let terms = products(&mut bench.graph, e);
    let mut angles: Vec<ExprId> = Vec::new();
    for (monomial, _) in &terms {
        for (_, angle) in turning(&bench.graph, *monomial) {
            if !angles.contains(&angle) {
                angles.push(angle);
            }
        }
    }
    if angles.len() * terms.len() > PRODUCTS_OF_AN_ANGLE {
        return None;
    }
    let contacts: Vec<Contact> =
        angles.into_iter().filter_map(|angle| contact_at(bench, form, &terms, angle)).collect();
    let length = |part: &Part| part.angle.map_or(0, |angle| bench.graph.linear_parts(angle).len());
    contacts.into_iter().min_by_key(|contact| contact.vector.0.iter().map(length).sum::<usize>())
}

/// `-X sin(phi) + Y cos(phi)`, and what else there is, by one angle.
fn contact_at(
    bench: &mut Workbench,
    form: usize,
    terms: &[(ExprId, Rational)],
    angle: ExprId,
) -> Option<Contact> {
    let [mut sines, mut cosines, mut rest]: [Vec<(ExprId, Rational)>; 3] = Default::default();
    for (monomial, c) in terms {
        let mut own = turning(&bench.graph, *monomial);
        own.retain(|(_, own)| *own == angle);
        let list = match own[..] {
            [] => &mut rest,
            [(Function::Sin, _)] => &mut sines,
            [_] => &mut cosines,
            _ => return None,
        };
        list.push((*monomial, c.clone()));
    }
    if sines.is_empty() || cosines.is_empty() {
        return None;
    }
    let (sine, cosine) = bench.graph.sin_cos(angle);
    let [x, y] = [(sines, sine), (cosines, cosine)].map(|(terms, call)| {
        let terms: Vec<_> = terms.into_iter().map(|(e, c)| (bench.graph.div(e, call), c)).collect();
        bench.graph.linear(&terms)
    });
    let (x, rest) = (bench.graph.neg(x), bench.graph.linear(&rest));
    let (x, y) = (Scalar::new(bench, x)?, Scalar::new(bench, y)?);
    let vector = Planar::new(bench, &x, &y, false)?;
    let (vector, rest) = match Scalar::new(bench, rest) {
        Some(own) => vector.with_component(bench, own, angle),
        None => (vector, rest),
    };
    let (factor, along, vector) = vector.normalised(bench)?;
    Some(Contact { form, vector, angle, factor, along, rest })
}

/// A sum as products with their coefficients; factors that are constant sums stay.
fn products(graph: &mut Graph, e: ExprId) -> Vec<(ExprId, Rational)> {
    let mut found = Vec::new();
    let mut stack = vec![(e, Rational::ONE)];
    while let Some((e, c)) = stack.pop() {
        match graph.node(e) {
            Node::Kept(x) => stack.push((*x, c)),
            Node::Sum { constant, terms } => {
                stack.extend(terms.iter().rev().map(|(term, k)| (*term, k * &c)));
                if !constant.is_zero() {
                    found.push((graph.one(), constant * &c));
                }
            }
            _ => found.push((e, c)),
        }
    }
    found
}

/// The sines and cosines of the state among the factors of a product.
fn turning(graph: &Graph, monomial: ExprId) -> Vec<(Function, ExprId)> {
    let own = |(base, k): &(ExprId, i32)| match graph.node(*base) {
        Node::Function(function @ (Function::Sin | Function::Cos), x)
            if *k == 1 && !graph.roles(*x).is_constant() =>
        {
            Some((*function, *x))
        }
        _ => None,
    };
    graph.factors(monomial).iter().filter_map(own).collect()
}
