//! The angles between neighbours: what the entries of sparse equations are short in.

use crate::algebra::{ExprId, Function, Graph, Node, Rational};
use crate::workbench::Workbench;

/// Sines of base angles in which expressions that depend on two angles each depend on one: differences along a forest
/// of the angles, and one angle of each of its trees. `None` if no expression depends on two.
pub(super) fn between(bench: &mut Workbench, entries: &[ExprId]) -> Option<Vec<ExprId>> {
    let mut angles: Vec<ExprId> = Vec::new();
    // To which tree an angle belongs.
    let mut trees: Vec<usize> = Vec::new();
    let mut differences: Vec<ExprId> = Vec::new();
    for e in entries {
        let own = angles_in(&bench.graph, *e);
        for angle in &own {
            if !angles.contains(angle) {
                trees.push(angles.len());
                angles.push(*angle);
            }
        }
        let [a, b] = own[..] else { continue };
        let place = |angle: ExprId| angles.iter().position(|known| *known == angle);
        let (Some(i), Some(j)) = (place(a), place(b)) else { continue };
        let (first, second) = (trees[i], trees[j]);
        if first != second {
            trees.iter_mut().filter(|tree| **tree == second).for_each(|tree| *tree = first);
            differences.push(shorter(bench, *e, a, b));
        }
    }
    if differences.is_empty() {
        return None;
    }
    let roots = angles.iter().enumerate().filter(|(i, _)| trees[*i] == *i).map(|(_, angle)| *angle);
    let all: Vec<ExprId> = roots.chain(differences).collect();
    Some(all.into_iter().map(|angle| bench.graph.sin(angle)).collect())
}

/// The base angles of an expression's sines and cosines.
fn angles_in(graph: &Graph, e: ExprId) -> Vec<ExprId> {
    let mut found = Vec::new();
    for id in graph.reachable(&[e], |id| graph.roles(id).is_constant()) {
        if let Node::Function(Function::Sin | Function::Cos, x) = graph.node(id) {
            for (angle, _) in graph.angle_parts(*x) {
                if !graph.roles(angle).is_constant() && !found.contains(&angle) {
                    found.push(angle);
                }
            }
        }
    }
    found
}

/// The difference of two angles, or their sum if an expression is shorter in that: one may be measured the other way round.
fn shorter(bench: &mut Workbench, e: ExprId, a: ExprId, b: ExprId) -> ExprId {
    let [difference, sum] = [Rational::MINUS_ONE, Rational::ONE]
        .map(|sign| bench.graph.linear(&[(a, Rational::ONE), (b, sign)]));
    let [short, long] = [difference, sum].map(|angle| {
        let roots = [a, angle].map(|angle| bench.graph.sin(angle));
        let tidy = bench.in_base_angles(&roots, |bench| bench.tidy(e));
        angles_in_written(&bench.graph, tidy)
    });
    if long < short { sum } else { difference }
}

/// How many different arguments the sines and cosines of an expression have.
fn angles_in_written(graph: &Graph, e: ExprId) -> usize {
    let mut found: Vec<ExprId> = Vec::new();
    for id in graph.reachable(&[e], |id| graph.roles(id).is_constant()) {
        if let Node::Function(Function::Sin | Function::Cos, x) = graph.node(id)
            && !found.contains(x)
        {
            found.push(*x);
        }
    }
    found.len()
}
