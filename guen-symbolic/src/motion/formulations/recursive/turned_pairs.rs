//! Squares of two forms that are one form turned by an angle.
//!
//! A trailer's axle moves with `X cos(phi)`, and its link turns with `X sin(phi)/d`, where `X` is the velocity of the axle before it. With
//! `a = X cos(phi)` and `b = k X sin(phi)`, and their components `a_s`, `b_s`, `X_s`, their part of an equation is that of other squares,
//!
//! ```text
//! w_a a' a_s + w_b b' b_s = k^2 w_b X' X_s + (w_a - k^2 w_b) a' a_s,
//! ```
//!
//! in which the rate of the sine does not occur. `X` is the cosine of the trailer before, so that a train keeps one square for each trailer.

use crate::algebra::{ExprId, Flow, Function, Graph, Node, Role};
use crate::motion::definition::projection::{Measured, MeasuredForms};
use crate::motion::{KineticTerm, Mechanics};
use crate::workbench::Workbench;

/// The components of a form as multiples of the sine or cosine of an angle.
struct Turned {
    function: Function,
    angle: ExprId,
    /// The multiples, that of the drift first.
    of: Vec<ExprId>,
}

/// A square of the energy of which an equation has the rate and the components alone.
struct Square {
    /// The place of the term.
    place: usize,
    /// The components, that of the drift first.
    components: Vec<ExprId>,
    /// All ways to write them by one sine or cosine.
    turned: Vec<Turned>,
}

/// Puts all such pairs of an energy together.
pub(super) fn merge(
    bench: &mut Workbench,
    system: &Mechanics,
    motion: &mut Flow,
    terms: &mut Vec<KineticTerm>,
    forms: &mut MeasuredForms,
) {
    let mut squares: Vec<Square> = Vec::new();
    for (place, term) in terms.iter().enumerate() {
        let Some(components) = components(bench, motion, term, forms) else { continue };
        let turned = turned(&mut bench.graph, &components);
        squares.push(Square { place, components, turned });
    }
    while let Some((cosine, sine, ratio, of)) = pair(&mut bench.graph, &squares) {
        let sine = squares.remove(sine).place;
        let weight = bench.graph.product(&[(ratio, 2), (terms[sine].weight, 1)]);
        terms[sine].weight = bench.graph.zero();
        terms[cosine].weight = bench.graph.sub(terms[cosine].weight, weight);
        let known = squares.iter().find_map(|square| {
            Some((square.place, constant_ratio(&mut bench.graph, &square.components, &of)?))
        });
        if let Some((place, ratio)) = known {
            let weight = bench.graph.product(&[(ratio, 2), (weight, 1)]);
            terms[place].weight = bench.graph.add(terms[place].weight, weight);
        } else {
            let form = bench.graph.symbol("", Role::QuasiVelocity);
            forms.insert(form, measured(bench, system, motion, &of));
            let turned = turned(&mut bench.graph, &of);
            squares.push(Square { place: terms.len(), components: of, turned });
            terms.push(KineticTerm { weight, forms: vec![form, form] });
        }
    }
    terms.retain(|term| !bench.graph.is_zero(term.weight));
}

/// A cosine and a sine of one form, with the ratio `k` and the components of `X`: the place of the first among the terms, that of the second among
/// the squares.
fn pair(graph: &mut Graph, squares: &[Square]) -> Option<(usize, usize, ExprId, Vec<ExprId>)> {
    for Square { place, turned, .. } in squares {
        for own in turned.iter().filter(|own| own.function == Function::Cos) {
            for (sine, other) in squares.iter().enumerate() {
                let is_its_sine =
                    |other: &&Turned| other.function == Function::Sin && other.angle == own.angle;
                let mut sines = other.turned.iter().filter(is_its_sine);
                let ratio = sines.find_map(|other| constant_ratio(graph, &own.of, &other.of));
                if let Some(ratio) = ratio {
                    return Some((*place, sine, ratio, own.of.clone()));
                }
            }
        }
    }
    None
}

/// The components of a form that occurs in a square of constant weight, that of the drift first; `None` where the part of the term in an equation is
/// more than its rate and its components.
fn components(
    bench: &mut Workbench,
    motion: &mut Flow,
    term: &KineticTerm,
    forms: &MeasuredForms,
) -> Option<Vec<ExprId>> {
    let [u, v] = term.forms[..] else { return None };
    let Measured { value, components, drift, acceleration, turning } = &forms[&u];
    let graph = &mut bench.graph;
    let rate = motion.of(graph, *value);
    let is_plain = u == v
        && graph.roles(term.weight).is_constant()
        && inside(graph, rate) == inside(graph, *acceleration)
        && turning.iter().all(|e| graph.is_zero(*e));
    is_plain.then(|| core::iter::once(drift).chain(components).copied().collect())
}

/// An expression, a multiple of which may be kept whole.
fn inside(graph: &mut Graph, e: ExprId) -> ExprId {
    let (coefficient, own) = graph.split_coefficient(e);
    match *graph.node(own) {
        Node::Kept(x) => graph.scale(x, &coefficient),
        _ => e,
    }
}

/// All ways to write components as multiples of one sine or cosine.
fn turned(graph: &mut Graph, components: &[ExprId]) -> Vec<Turned> {
    let components: Vec<ExprId> = components.iter().map(|e| inside(graph, *e)).collect();
    let Some(first) = components.iter().find(|e| !graph.is_zero(**e)) else { return Vec::new() };
    let mut found = Vec::new();
    for call in factors(graph, *first) {
        let own = inside(graph, call);
        let Node::Function(function @ (Function::Sin | Function::Cos), angle) = *graph.node(own) else {
            continue;
        };
        let of = components.iter().map(|e| {
            let has_call = graph.is_zero(*e) || factors(graph, *e).contains(&call);
            has_call.then(|| graph.div(*e, call))
        });
        found.extend(of.collect::<Option<_>>().map(|of| Turned { function, angle, of }));
    }
    found
}

/// The factors that occur once in a product.
fn factors(graph: &mut Graph, e: ExprId) -> Vec<ExprId> {
    let (_, own) = graph.split_coefficient(e);
    match graph.factors(own) {
        [] => vec![own],
        factors => factors.iter().filter(|(_, k)| *k == 1).map(|(base, _)| *base).collect(),
    }
}

/// A product, of which factors may be kept whole, as one of these factors' own factors.
fn multiplied(graph: &mut Graph, e: ExprId) -> ExprId {
    let (coefficient, own) = graph.split_coefficient(e);
    let product = match graph.node(own).clone() {
        Node::Kept(x) => multiplied(graph, x),
        Node::Product(factors) => {
            let factors: Vec<_> = factors.iter().map(|(base, k)| (multiplied(graph, *base), *k)).collect();
            graph.product(&factors)
        }
        _ => own,
    };
    graph.scale(product, &coefficient)
}

/// The constant `k` of `b = k a`.
fn constant_ratio(graph: &mut Graph, a: &[ExprId], b: &[ExprId]) -> Option<ExprId> {
    let mut found = None;
    for (a, b) in
        a.iter().zip(b).filter(|(a, b)| !graph.is_zero(**a) || !graph.is_zero(**b)).collect::<Vec<_>>()
    {
        if graph.is_zero(*a) || graph.is_zero(*b) {
            return None;
        }
        let ratio = graph.div(*b, *a);
        let ratio = multiplied(graph, ratio);
        if !graph.roles(ratio).is_constant() || found.is_some_and(|known| known != ratio) {
            return None;
        }
        found = Some(ratio);
    }
    found
}

/// A form with these components, that of the drift first.
fn measured(bench: &mut Workbench, system: &Mechanics, motion: &mut Flow, components: &[ExprId]) -> Measured {
    let (drift, components) = (components[0], components[1..].to_vec());
    let turning = vec![bench.graph.zero(); components.len()];
    let moving = bench.dot(&components, &system.etas[..components.len()]);
    let value = bench.graph.add(drift, moving);
    let acceleration = motion.of(&mut bench.graph, value);
    Measured {
        value: bench.keep_large(value),
        components,
        drift,
        acceleration: bench.keep_large(acceleration),
        turning,
    }
}

#[cfg(test)]
mod tests {
    use super::{Square, constant_ratio, pair, turned};
    use crate::algebra::{ExprId, Graph, Role};

    fn square(graph: &mut Graph, place: usize, component: ExprId) -> Square {
        let components = vec![graph.zero(), component];
        let turned = turned(graph, &components);
        Square { place, components, turned }
    }

    #[test]
    fn an_axle_and_its_link_are_the_axle_before_turned_whatever_is_kept_whole() {
        let mut g = Graph::new();
        let [a, b] = ["a", "b"].map(|name| g.symbol(name, Role::Coordinate));
        let d = g.symbol("d", Role::Constant);
        // An axle that two angles turn, the first of them in a difference, so that its cosine is kept whole.
        let bend = g.sub(a, b);
        let (_, before) = g.sin_cos(bend);
        let before = g.keep(before);
        let (sine, cosine) = g.sin_cos(b);
        let axle = g.mul(before, cosine);
        let link = g.product(&[(before, 1), (sine, 1), (d, -1)]);
        let link = g.neg(link);
        let link = g.keep(link);
        let squares = [square(&mut g, 0, axle), square(&mut g, 7, link), square(&mut g, 8, before)];
        let (place, link, ratio, of) = pair(&mut g, &squares).unwrap();
        assert_eq!((place, link), (0, 1));
        let by_length = g.powi(d, -1);
        assert_eq!(ratio, g.neg(by_length));
        let one = g.one();
        assert_eq!(constant_ratio(&mut g, &squares[2].components, &of), Some(one));
        // A sine of another angle, and one of another form.
        let (other, _) = g.sin_cos(a);
        for other in [g.mul(before, other), g.mul(a, sine)] {
            let squares = [square(&mut g, 0, axle), square(&mut g, 1, other)];
            assert!(pair(&mut g, &squares).is_none(), "{}", g.text(other));
        }
    }
}
