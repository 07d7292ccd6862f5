//! The independent route: Lagrange's equations with multipliers, solved densely.
//!
//! ```text
//! d/dt dT°/dx_i' - dT°/dx_i - dU/dx_i - Q_i = sum_v lambda_v a_vi,    A_c x'' + A_c' x' + a_c0' = 0,
//! eta_s' = a_s x'' + a_s' x' + a_s0'.
//! ```
//!
//! Derivatives come from dual numbers, `T°` is a function of `t, x, x'` with the forms put in for the `eta`.

use nalgebra::{DMatrix, DVector};

use super::declared::{Declared, lift};
use super::scalar::hyper;

/// What the dense system gives.
pub struct Multipliers {
    /// `x_1''..x_n''`.
    pub second: Vec<f64>,
    /// `eta_1'..eta_l'`.
    pub accelerations: Vec<f64>,
    /// `lambda_v`.
    pub reactions: Vec<f64>,
    /// `R_i = sum_v lambda_v a_vi`.
    pub covector: Vec<f64>,
    /// The condition number of the solved system, which holds `x''`, `eta'` and `lambda`.
    pub condition: f64,
    /// The largest entry of its solution, at least one.
    pub scale: f64,
}

/// Beyond this condition number a draw is rejected.
pub const LARGEST_CONDITION: f64 = 1e8;

/// Solves for the motion at a state; `None` if the system is worse conditioned than [`LARGEST_CONDITION`].
pub fn solve(system: &Declared, point: &[f64]) -> Option<Multipliers> {
    pushed(system, point, &vec![0.0; system.n])
}

/// Solves for the motion under one more generalised force, with a component for each coordinate.
pub fn pushed(system: &Declared, point: &[f64], force: &[f64]) -> Option<Multipliers> {
    let (n, l) = (system.n, system.degrees);
    let m = n - l;
    let rates = system.rates(point, &[]);
    let size = n + l + m;
    let mut matrix = DMatrix::<f64>::zeros(size, size);
    let mut right = DVector::<f64>::zeros(size);
    let q = system.generalised_forces(point);
    for i in 0..n {
        let moving = |k: usize| if k == system.velocities[i] { 1.0 } else { 0.0 };
        // d/dt dT°/dx_i' at x'' = 0
        let along = point.iter().enumerate().map(|(k, p)| hyper(*p, moving(k), rates[k])).collect();
        let drift = system.kinetic(along).du.du;
        for k in 0..=i {
            let other = |s: usize| if s == system.velocities[k] { 1.0 } else { 0.0 };
            let both = point.iter().enumerate().map(|(s, p)| hyper(*p, moving(s), other(s))).collect();
            let entry = system.kinetic(both).du.du;
            matrix[(i, k)] = entry;
            matrix[(k, i)] = entry;
        }
        let position = lift(point, |k| if k == system.x[i] { 1.0 } else { 0.0 });
        let slope = system.potential(&position).du + system.kinetic(position).du;
        right[i] = slope + q[i] + force[i] - drift;
    }
    let forms = system.forms_at(&lift(point, |k| rates[k]));
    for (j, row) in forms.iter().enumerate() {
        let turning: f64 =
            row[n].du + row[..n].iter().zip(&system.velocities).map(|(a, v)| a.du * point[*v]).sum::<f64>();
        right[n + j] = -turning;
        for (i, a) in row[..n].iter().enumerate() {
            matrix[(n + j, i)] = a.re;
            if j >= l {
                matrix[(i, n + j)] = -a.re;
            }
        }
        if j < l {
            matrix[(n + j, n + j)] = -1.0;
        }
    }
    // The iteration for singular values does not end at a NaN.
    if size == 0 || !matrix.iter().all(|e| e.is_finite()) {
        return None;
    }
    let singular = matrix.clone().svd(false, false).singular_values;
    let condition = singular.max() / singular.min();
    // NaN is not below either.
    if condition.is_nan() || condition > LARGEST_CONDITION {
        return None;
    }
    // Outside of the domain of a function there is no motion.
    let solution = matrix.full_piv_lu().solve(&right).filter(|found| found.iter().all(|e| e.is_finite()))?;
    let reactions: Vec<f64> = solution.rows(n + l, m).iter().copied().collect();
    let covector = (0..n)
        .map(|i| reactions.iter().zip(&forms[l..]).map(|(lambda, row)| lambda * row[i].re).sum())
        .collect();
    Some(Multipliers {
        second: solution.rows(0, n).iter().copied().collect(),
        accelerations: solution.rows(n, l).iter().copied().collect(),
        reactions,
        covector,
        condition,
        scale: solution.amax().max(1.0),
    })
}
