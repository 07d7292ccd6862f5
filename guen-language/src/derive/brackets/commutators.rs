//! The brackets that are emitted and shown.

use guen_symbolic::{Derivation, ExprId};

use super::commutator::Commutator;
use crate::derive::quantities::parts;
use crate::derive::selections::{fixed, manifold};
use crate::model::Model;

/// The brackets that do not vanish identically: among `X_0 .. X_l`, or among all operators if the system or a scene
/// provides operators.
pub(in crate::derive) fn commutators(model: &mut Model<'_>, derivation: &mut Derivation) -> Vec<Commutator> {
    let n = derivation.system.forms.len();
    if derivation.frame.brackets.are_zero() {
        return Vec::new();
    }
    let last = model.last_operator();
    // What is constant on a unit sphere is that constant.
    let mut holding = fixed::Holding::new(model, &[]);
    let (bench, brackets) = (&mut model.bench, &mut derivation.frame.brackets);
    let mut spheres = manifold::Replacement::all(bench, &derivation.system, &mut holding);
    spheres.retain(|replacement| replacement.is_trial);
    let mut found = Vec::new();
    for (r, s) in (1..=last).flat_map(|s| (0..s).map(move |r| (r, s))) {
        let mut coefficients: Vec<ExprId> = (1..=n).map(|t| brackets.coefficient(bench, r, s, t)).collect();
        for c in &mut coefficients {
            if bench.graph.roles(*c).is_constant() {
                continue;
            }
            let image = parts::replaced(bench, &mut spheres, *c);
            if bench.graph.roles(image).is_constant() {
                *c = image;
            }
        }
        if coefficients.iter().any(|c| !bench.graph.is_zero(*c)) {
            found.push(Commutator { r, s, coefficients });
        }
    }
    found
}
