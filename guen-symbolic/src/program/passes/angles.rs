//! Chooses the sines and cosines that are computed from those of base angles.
//!
//! `sin(2 theta)` and `cos(theta_1 - theta_2)` are a few multiplications where the sines and cosines of `theta`,
//! `theta_1`, `theta_2` are there anyway. Base angles are those of the normal form: angles that the declaration uses,
//! sums of coordinates among them.

use std::collections::{BTreeMap, BTreeSet};

use crate::algebra::{AngleParts, ExprId, FastMap, Function, Graph, Node, Rational};

/// Multiples beyond this are computed by a call of their own: errors grow with the multiple.
const LARGEST_MULTIPLE: i64 = 4;

/// The cost of a sine with its cosine by a call, and of either by rotating known ones, in multiplications.
const PAIR: usize = 20;
const ROTATION: usize = 3;

/// `sum multiple * base`.
pub(in super::super) type Angle = Vec<(ExprId, i32)>;

/// The angles to be computed from base angles.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Angles(FastMap<ExprId, Angle>);

/// An argument as a combination of base angles.
struct Argument {
    x: ExprId,
    /// The number of sine and cosine that are needed.
    needed: usize,
    multiples: Vec<(ExprId, i64)>,
}

impl Argument {
    fn direct(&self) -> usize {
        PAIR + self.multiples.len() - 1
    }

    fn rotations(&self) -> usize {
        self.multiples.iter().map(|(_, k)| k.unsigned_abs() as usize).sum::<usize>() - 1
    }

    /// The price by rotation, where some base angles are computed anyway.
    fn rotated(&self, known: &BTreeSet<ExprId>) -> usize {
        let missing = self.multiples.iter().filter(|(base, _)| !known.contains(base)).count();
        PAIR * missing + self.needed * self.rotations() * ROTATION
    }
}

impl Angles {
    /// Decides for all sines and cosines among some nodes.
    pub(in super::super) fn of(graph: &mut Graph, nodes: &[ExprId]) -> Self {
        let mut needed: BTreeMap<ExprId, usize> = BTreeMap::new();
        for id in nodes {
            if let Node::Function(Function::Sin | Function::Cos, x) = graph.node(*id) {
                *needed.entry(*x).or_default() += 1;
            }
        }
        let parts: Vec<(ExprId, usize, AngleParts)> = needed
            .into_iter()
            .filter_map(|(x, needed)| Some((x, needed, variable_parts(graph, x)?)))
            .collect();
        let mut units: BTreeMap<ExprId, Rational> = BTreeMap::new();
        for (term, c) in parts.iter().flat_map(|(_, _, parts)| parts) {
            let unit = units.entry(*term).or_insert_with(|| c.abs());
            *unit = unit.content_gcd(c);
        }
        let arguments: Vec<Argument> = parts
            .into_iter()
            .filter_map(|(x, needed, parts)| {
                let multiples: Option<Vec<(ExprId, i64)>> = parts
                    .iter()
                    .map(|(term, c)| {
                        let multiple = (c / &units[term]).to_i64()?;
                        (multiple.abs() <= LARGEST_MULTIPLE).then_some((*term, multiple))
                    })
                    .collect();
                Some(Argument { x, needed, multiples: multiples? })
            })
            .collect();
        // All by base angles, or each where that is cheaper.
        let mut all = BTreeSet::new();
        let (mut together, mut direct) = (0, 0);
        for argument in &arguments {
            together += argument.rotated(&all);
            direct += argument.direct();
            all.extend(argument.multiples.iter().map(|(base, _)| *base));
        }
        let mut known: BTreeSet<ExprId> = BTreeSet::new();
        let single = |argument: &&Argument| argument.rotations() == 0;
        known.extend(arguments.iter().filter(single).map(|argument| argument.multiples[0].0));
        let mut each = PAIR * known.len();
        let mut chosen: Vec<&Argument> = Vec::new();
        for argument in arguments.iter().filter(|argument| argument.rotations() > 0) {
            let rotated = argument.rotated(&known);
            if rotated < argument.direct() {
                chosen.push(argument);
                known.extend(argument.multiples.iter().map(|(base, _)| *base));
            }
            each += rotated.min(argument.direct());
        }
        if together < each.min(direct) {
            chosen = arguments.iter().filter(|argument| argument.rotations() > 0).collect();
        }
        let angles = chosen
            .into_iter()
            .map(|argument| {
                let angle = argument
                    .multiples
                    .iter()
                    .map(|(term, k)| (graph.scale(*term, &units[term]), *k as i32))
                    .collect();
                (argument.x, angle)
            })
            .collect();
        Angles(angles)
    }

    /// The parts of an angle that is not to be computed directly.
    pub(in super::super) fn get(&self, x: ExprId) -> Option<&Angle> {
        self.0.get(&x)
    }
}

/// The angle as a combination of terms that all depend on the state.
fn variable_parts(graph: &Graph, x: ExprId) -> Option<AngleParts> {
    let parts = graph.angle_parts(x);
    (!parts.is_empty() && parts.iter().all(|(term, _)| !graph.roles(*term).is_constant())).then_some(parts)
}
