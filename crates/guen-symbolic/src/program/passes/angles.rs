//! Which sines and cosines are computed from those of base angles.
//!
//! `sin(2 theta)` and `cos(theta_1 - theta_2)` are a few multiplications where the sines and cosines of `theta`,
//! `theta_1`, `theta_2` are there anyway; whether that is cheaper is decided for all angles together.

use std::collections::BTreeMap;

use crate::algebra::{ExprId, FastMap, Function, Graph, Node, Rational};

/// Multiples beyond this are computed by a call of their own: errors grow with the multiple.
const LARGEST_MULTIPLE: i64 = 4;

/// The price of a sine and cosine, and of one function after one rotation, in units of a multiplication.
const PAIR: usize = 20;
const ROTATION: usize = 3;

/// `sum multiple * base`.
pub(in super::super) type Angle = Vec<(ExprId, i32)>;

type Parts = Vec<(ExprId, Rational)>;

/// The angles to be computed from base angles.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Angles(FastMap<ExprId, Angle>);

impl Angles {
    /// Decides for all sines and cosines among some nodes.
    pub(in super::super) fn of(graph: &mut Graph, nodes: &[ExprId]) -> Self {
        // The arguments, and how many of sine and cosine are needed.
        let mut arguments: BTreeMap<ExprId, usize> = BTreeMap::new();
        for id in nodes {
            if let Node::Function(Function::Sin | Function::Cos, x) = graph.node(*id) {
                *arguments.entry(*x).or_default() += 1;
            }
        }
        let parts: Vec<(ExprId, usize, Parts)> = arguments
            .into_iter()
            .filter_map(|(x, needed)| Some((x, needed, linear_parts(graph, x)?)))
            .collect();
        let mut units: BTreeMap<ExprId, Rational> = BTreeMap::new();
        for (term, c) in parts.iter().flat_map(|(_, _, parts)| parts) {
            let unit = units.entry(*term).or_insert_with(|| c.abs());
            *unit = unit.content_gcd(c);
        }
        let (mut direct, mut rotated) = (0, 0);
        let mut angles = FastMap::default();
        let mut bases: FastMap<ExprId, ()> = FastMap::default();
        for (x, needed, parts) in parts {
            let multiples: Option<Vec<(ExprId, i64)>> = parts
                .iter()
                .map(|(term, c)| {
                    let multiple = (c / &units[term]).to_i64()?;
                    (multiple.abs() <= LARGEST_MULTIPLE).then_some((*term, multiple))
                })
                .collect();
            let Some(multiples) = multiples else { continue };
            direct += PAIR + multiples.len() - 1;
            let rotations = multiples.iter().map(|(_, k)| k.unsigned_abs() as usize).sum::<usize>() - 1;
            rotated += needed * rotations * ROTATION;
            for (term, _) in &multiples {
                if bases.insert(*term, ()).is_none() {
                    rotated += PAIR;
                }
            }
            if rotations > 0 {
                angles.insert(x, multiples);
            }
        }
        if rotated >= direct {
            return Angles::default();
        }
        let angles = angles
            .into_pairs()
            .map(|(x, multiples)| {
                let angle = multiples
                    .into_iter()
                    .map(|(term, k)| (graph.scale(term, &units[&term]), k as i32))
                    .collect();
                (x, angle)
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
fn linear_parts(graph: &Graph, x: ExprId) -> Option<Parts> {
    match graph.node(x) {
        Node::Sum { constant, terms } => (constant.is_zero()
            && terms.iter().all(|(term, _)| !graph.roles(*term).is_constant()))
        .then(|| terms.to_vec()),
        _ => Some(vec![(x, Rational::ONE)]),
    }
}
