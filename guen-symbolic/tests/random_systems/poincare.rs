//! (2.7) term by term, each with a sign that can be turned.
//!
//! ```text
//! d/dt dT/d eta_s - X_s T - X_s U - sum_t C_0st p_t - sum_rt eta_r C_rst p_t
//!                 - sum_v C_0sv p_v - sum_rv eta_r C_rsv p_v - Q_s = 0
//! ```

use crate::brackets::Coefficients;
use crate::declared::{Declared, lift};
use crate::derived::Derived;
use crate::energies::momenta;

/// The terms in the order of [`Terms`].
pub const NAMES: [&str; 8] = ["d/dt dT/d eta_s", "X_s T", "X_s U", "C_0st", "C_rst", "C_0sv", "C_rsv", "Q_s"];

/// The terms of one equation with the signs they have in it.
pub type Terms = [f64; 8];

/// The terms of all equations at a state, with `eta'` from elsewhere.
pub fn terms(
    derived: &Derived,
    declared: &Declared,
    c: &Coefficients,
    point: &[f64],
    accelerations: &[f64],
) -> Vec<Terms> {
    let (n, l) = (declared.n, declared.degrees);
    let momenta = momenta(derived);
    let rates = declared.rates(point, accelerations);
    let p = momenta.at(&lift(point, |k| rates[k]));
    let kinetic = derived.tape(&[derived.derivation.energies.kinetic]);
    let q = derived.tape(&derived.derivation.generalised_forces).at(point);
    let xi = derived.derivation.frame.operators.xi.iter().flatten().copied().collect::<Vec<_>>();
    let xi = derived.tape(&xi).at(point);
    (1..=l)
        .map(|s| {
            let field: Vec<f64> = [0.0].iter().chain(&xi[s * n..(s + 1) * n]).copied().collect();
            let along = declared.along_field(point, &field);
            let moving = lift(point, |k| along[k]);
            let (mut free, mut turning) = ([0.0; 2], [0.0; 2]);
            for t in 1..=n {
                let dropped = usize::from(t > l);
                free[dropped] += c.at(0, s, t) * p[t - 1].re;
                for r in 1..=l {
                    turning[dropped] += point[declared.etas[r - 1]] * c.at(r, s, t) * p[t - 1].re;
                }
            }
            [
                p[s - 1].du,
                -kinetic.at(&moving)[0].du,
                -declared.potential(&moving).du,
                -free[0],
                -turning[0],
                -free[1],
                -turning[1],
                -q[s - 1],
            ]
        })
        .collect()
}

/// The largest residual over the equations in units of their terms, with the sign of one term turned.
pub fn residual(equations: &[Terms], turned: Option<usize>) -> f64 {
    equations
        .iter()
        .map(|terms| {
            let size: f64 = terms.iter().map(|term| term.abs()).sum();
            let sum: f64 =
                terms.iter().enumerate().map(|(k, term)| if turned == Some(k) { -term } else { *term }).sum();
            if sum.is_nan() { f64::INFINITY } else { sum.abs() / size.max(1.0) }
        })
        .fold(0.0, f64::max)
}
