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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Graph, Role};

    /// `(c^2 + s^2 n) a' = g s` for an angle with sine `s` and cosine `c`, by the numbers `n` and `g`, and a coordinate that is one
    /// on the constraint.
    fn equations(bench: &mut Workbench, x: ExprId, [n, g]: [i64; 2], factor: ExprId) -> Equations {
        let (sine, cosine) = bench.graph.sin_cos(x);
        let graph = &mut bench.graph;
        let (s2, c2) = (graph.powi(sine, 2), graph.powi(cosine, 2));
        let mass = graph.linear(&[(c2, Rational::ONE), (s2, Rational::integer(n))]);
        let force = graph.linear(&[(sine, Rational::integer(g))]);
        Equations { mass: vec![vec![graph.mul(mass, factor)]], forces: vec![graph.mul(force, factor)] }
    }

    #[test]
    fn equal_equations_are_proved_and_others_refused() {
        let mut bench = Workbench::new(Graph::new());
        let x = bench.graph.symbol("x", Role::Coordinate);
        let one = bench.graph.one();
        let own = equations(&mut bench, x, [1, 3], one);
        let same = Equations { mass: vec![vec![one]], forces: own.forces.clone() };
        assert_eq!(are_same(&mut bench, &own, &same).ok(), Some(true));
        for wrong in [[2, 3], [1, -3], [1, 4]] {
            let other = equations(&mut bench, x, wrong, one);
            assert!(are_same(&mut bench, &own, &other).is_err(), "{wrong:?}");
            let along = are_same_along(&mut bench, &[5], (&own.mass[0], own.forces[0]), &other);
            assert!(along.is_err(), "{wrong:?}");
            let rates = [own.forces[0], other.forces[0]];
            if rates[0] != rates[1] {
                assert!(are_equal(&mut bench, &rates[..1], &rates[1..], 0).is_err(), "{wrong:?}");
                assert!(solve_equations(&mut bench, &own, &rates[1..]).is_err(), "{wrong:?}");
            }
        }
        assert_eq!(solve_equations(&mut bench, &own, &own.forces).ok(), Some(true));
    }

    #[test]
    fn on_a_constraint_they_need_be_equal_there_only() {
        let mut bench = Workbench::new(Graph::new());
        let x = bench.graph.symbol("x", Role::Coordinate);
        let length = bench.graph.symbol("r", Role::Coordinate);
        let one = bench.graph.one();
        let constraint = bench.graph.sub(length, one);
        let (own, other) = (equations(&mut bench, x, [1, 3], one), equations(&mut bench, x, [1, 3], length));
        assert!(are_same(&mut bench, &own, &other).is_err());
        bench.zero.set_manifold(&mut bench.graph, &[constraint]);
        assert_eq!(are_same(&mut bench, &own, &other).ok(), Some(true));
        let wrong = equations(&mut bench, x, [1, -3], length);
        assert!(are_same(&mut bench, &own, &wrong).is_err());
    }
}
