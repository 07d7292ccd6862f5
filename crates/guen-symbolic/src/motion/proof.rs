//! Proofs that what was found in different ways is equal: before anything is emitted, at points modulo p.

use super::{DerivationError, Equations};
use crate::algebra::{ExprId, Rational};
use crate::workbench::Workbench;

/// Whether the two routes agree at points modulo p: if so they are equal but for roots of other sign; if not, the zero
/// test looks closer at each equation.
pub(super) fn routes_agree(bench: &mut Workbench, a: &Equations, b: &Equations, l: usize) -> bool {
    let differences: Vec<ExprId> = (0..l)
        .flat_map(|s| {
            let masses = (0..l).map(move |t| (a.mass[s][t], b.mass[s][t]));
            masses.chain([(a.forces[s], b.forces[s])])
        })
        .map(|(a, b)| bench.graph.sub(a, b))
        .collect();
    vanish_where(bench, &differences, false)
}

/// Whether the rates in other words agree wherever constraints on positions hold, at points modulo p. Where only the sign of
/// a root may differ they are not taken; a proved difference is a mistake of ours.
pub(super) fn are_equal(
    bench: &mut Workbench,
    own: &[ExprId],
    other: &[ExprId],
    velocities: usize,
) -> Result<bool, DerivationError> {
    let differences: Vec<ExprId> = own.iter().zip(other).map(|(a, b)| bench.graph.sub(*a, *b)).collect();
    if vanish_where(bench, &differences, true) {
        return Ok(true);
    }
    for (place, e) in differences.into_iter().enumerate() {
        if bench.zero.is_shown_nonzero(&mut bench.graph, e, true) {
            // Velocities come first.
            return Err(DerivationError::RoutesDisagree { equation: place.saturating_sub(velocities) });
        }
    }
    Ok(false)
}

/// Whether accelerations solve the equations of both routes, wherever constraints on positions hold, at points modulo p; a
/// proved difference is a mistake of ours.
pub(super) fn solve_equations(
    bench: &mut Workbench,
    equations: &Equations,
    accelerations: &[ExprId],
) -> Result<bool, DerivationError> {
    let residuals: Vec<ExprId> = equations
        .mass
        .iter()
        .zip(&equations.forces)
        .map(|(row, force)| {
            let inertia = bench.dot(row, accelerations);
            bench.graph.sub(inertia, *force)
        })
        .collect();
    if vanish_where(bench, &residuals, true) {
        return Ok(true);
    }
    for (equation, e) in residuals.into_iter().enumerate() {
        if bench.zero.is_shown_nonzero(&mut bench.graph, e, true) {
            return Err(DerivationError::RoutesDisagree { equation });
        }
    }
    Ok(false)
}

/// Whether equations that were found in another way are these, wherever constraints on positions hold, at points modulo p;
/// a proved difference is a mistake of ours.
pub(super) fn are_same(bench: &mut Workbench, a: &Equations, b: &Equations) -> Result<bool, DerivationError> {
    let mut rows: Vec<Vec<ExprId>> = Vec::new();
    for (s, (row, other)) in a.mass.iter().zip(&b.mass).enumerate() {
        let pairs = row.iter().zip(other).chain([(&a.forces[s], &b.forces[s])]);
        rows.push(pairs.map(|(a, b)| bench.graph.sub(*a, *b)).collect());
    }
    let all: Vec<ExprId> = rows.iter().flatten().copied().collect();
    if vanish_where(bench, &all, true) {
        return Ok(true);
    }
    for (equation, row) in rows.into_iter().enumerate() {
        if row.into_iter().any(|e| bench.zero.is_shown_nonzero(&mut bench.graph, e, true)) {
            return Err(DerivationError::RoutesDisagree { equation });
        }
    }
    Ok(false)
}

/// Whether equations that were found in another way are (2.7) along a displacement, `sum_s w_s X_s`, wherever constraints on
/// positions hold, at points modulo p; a proved difference is a mistake of ours.
pub(super) fn are_same_along(
    bench: &mut Workbench,
    weights: &[i64],
    (mass, force): (&[ExprId], ExprId),
    equations: &Equations,
) -> Result<bool, DerivationError> {
    let sum = |bench: &mut Workbench, column: &mut dyn Iterator<Item = ExprId>| {
        let parts: Vec<(ExprId, Rational)> =
            column.zip(weights.iter().map(|w| Rational::integer(*w))).collect();
        bench.graph.linear(&parts)
    };
    let mut differences = Vec::new();
    for (t, own) in mass.iter().enumerate() {
        let other = sum(bench, &mut equations.mass.iter().map(|row| row[t]));
        differences.push(bench.graph.sub(*own, other));
    }
    let other = sum(bench, &mut equations.forces.iter().copied());
    differences.push(bench.graph.sub(force, other));
    if vanish_where(bench, &differences, true) {
        return Ok(true);
    }
    for (equation, e) in differences.into_iter().enumerate() {
        if bench.zero.is_shown_nonzero(&mut bench.graph, e, true) {
            return Err(DerivationError::RoutesDisagree { equation: equation.min(mass.len() - 1) });
        }
    }
    Ok(false)
}

/// Whether all of them vanish at a few points modulo p, which the constraints on positions may bind.
fn vanish_where(bench: &mut Workbench, es: &[ExprId], on_manifold: bool) -> bool {
    (0..3).all(|sample| {
        bench
            .zero
            .residues(&mut bench.graph, sample, es, on_manifold)
            .is_some_and(|residues| residues.iter().all(|residue| *residue == 0))
    })
}
