//! The hoop of the paper by hand: the smallest program known.

use guen::Real;

/// The radius, and what else of the constants occurs.
#[derive(Clone, Copy)]
pub struct ByHand<R> {
    pub a: R,
    pub k: [R; 5],
}

impl ByHand<f64> {
    pub fn new(a: f64, inertia: f64, axial: f64, g: f64) -> Self {
        let square = a * a;
        let tilt = inertia + square;
        let k = [
            inertia / tilt,
            (axial + square) / tilt,
            a * g / tilt,
            axial / inertia,
            square / (axial + square),
        ];
        Self { a, k }
    }
}

impl<R: Real> ByHand<R> {
    #[inline(always)]
    pub fn rhs(&self, &[theta, psi, _, _, _, _, eta1, eta2, eta3]: &[R; 9]) -> [R; 9] {
        let [k1, k2, k3, k4, k5] = self.k;
        let ((sin, cos), (sin_psi, cos_psi)) = R::sin_cos_pair(theta, psi);
        let w = eta2 / sin;
        let c = cos * w;
        let p = self.a * eta1;
        let (u, v) = (p * sin, self.a * eta3);
        [
            eta1,
            w,
            eta3 - c,
            u * sin_psi - v * cos_psi,
            -u * cos_psi - v * sin_psi,
            p * cos,
            k1 * eta2 * c - k2 * eta2 * eta3 - k3 * cos,
            eta1 * (k4 * eta3 - c),
            k5 * eta1 * eta2,
        ]
    }
}
