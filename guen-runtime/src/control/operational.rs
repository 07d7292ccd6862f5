//! The inertia that is felt at a point.

use crate::linear_algebra::dense::{product, solve, transpose};
use crate::numbers::real::Ordered;

/// The operational-space inertia of a point: what a force on it accelerates,
///
/// ```text
/// Lambda = (J M^-1 J^T)^-1        Lambda (y'' - J' eta) + Lambda J M^-1 (C + g) = F
/// ```
///
/// - `mass` is the mass matrix `M`, `L` by `L`; `jacobian` is `J`, `K` by `L`, of `K` quantities by the `L` quasi-velocities.
/// - In units of mass for a place and of moments of inertia for an angle.
/// - `None` where the point cannot move in one of its directions (a stretched arm along itself), or `M` is singular.
/// - Cost: two solutions by elimination, some `L^3/3 + L^2 K + L K^2 + K^3` multiplications; no allocation.
/// - Source: O. Khatib, *A unified approach for motion and force control of robot manipulators: the operational space
///   formulation*, IEEE Journal on Robotics and Automation 3 (1987) 43-53.
///
/// ```
/// use guen_runtime::control::operational_inertia;
/// // Two carts beside each other, and the middle between them.
/// let [[inertia]] = operational_inertia(&[[2.0_f64, 0.0], [0.0, 3.0]], &[[0.5, 0.5]]).ok_or("fixed")?;
/// assert!((inertia - 4.0 / (1.0 / 2.0 + 1.0 / 3.0)).abs() < 1e-14);
/// assert_eq!(operational_inertia(&[[2.0, 0.0], [0.0, 3.0]], &[[0.0, 0.0]]), None);
/// # Ok::<(), &str>(())
/// ```
pub fn operational_inertia<R: Ordered, const L: usize, const K: usize>(
    mass: &[[R; L]; L],
    jacobian: &[[R; L]; K],
) -> Option<[[R; K]; K]> {
    // M = D N D and J = K D: N has a diagonal of ones whatever the units are.
    let scales = lengths(mass);
    let moved = core::array::from_fn(|k| core::array::from_fn(|s| jacobian[k][s] / scales[s]));
    let mobility = product(&moved, &solve(&without(mass, &scales), &transpose(&moved))?);
    let scales = lengths(&mobility);
    let unit = core::array::from_fn(|i| core::array::from_fn(|k| if i == k { R::one() } else { R::zero() }));
    solve(&without(&mobility, &scales), &unit).map(|inertia| without(&inertia, &scales))
}

/// The roots of the diagonal of a symmetric matrix; one where an entry is zero.
fn lengths<R: Ordered, const N: usize>(matrix: &[[R; N]; N]) -> [R; N] {
    core::array::from_fn(|i| {
        let entry = matrix[i][i].abs();
        if entry > R::zero() { entry.sqrt() } else { R::one() }
    })
}

/// A matrix with its rows and columns divided by their scales.
fn without<R: Ordered, const N: usize>(matrix: &[[R; N]; N], scales: &[R; N]) -> [[R; N]; N] {
    core::array::from_fn(|i| core::array::from_fn(|k| matrix[i][k] / scales[i] / scales[k]))
}
