//! The hoop and Appell's system: section 3 of the paper, solved for the accelerations by hand.

use guen::{Real, System, from_fn};

/// The hoop in the paper's parameters: 17 multiplications, 6 additions, a negation, a division, two sines and cosines.
pub fn hoop<R: Real>([a, A, C, g]: [R; 4]) -> impl System<R, 9> {
    #![allow(non_snake_case, reason = "the paper's names")]
    let [k1, k2, k3] = [A / (A + a * a), (C + a * a) / (A + a * a), a * g / (A + a * a)];
    let [k4, k5] = [C / A, a * a / (C + a * a)];
    from_fn(move |_t, &[theta, psi, _phi, _xi, _eta, _zeta, eta1, eta2, eta3]: &[R; 9]| {
        let ((sin, cos), (sin_psi, cos_psi)) = R::sin_cos_pair(theta, psi);
        let w = eta2 / sin;
        let c = cos * w;
        let p = a * eta1;
        let (u, v) = (p * sin, a * eta3);
        [
            eta1,
            w,
            eta3 - c,
            u * sin_psi - v * cos_psi,
            -(u * cos_psi + v * sin_psi),
            p * cos,
            eta2 * (k1 * c - k2 * eta3) - k3 * cos,
            eta1 * (k4 * eta3 - c),
            k5 * eta1 * eta2,
        ]
    })
}

/// The hoop in the rates of its angles.
pub fn rate_hoop<R: Real>([a, A, C, g]: [R; 4]) -> impl System<R, 9> {
    #![allow(non_snake_case, reason = "the paper's names")]
    let [k1, k2, k3] = [A / (A + a * a), (C + a * a) / (A + a * a), a * g / (A + a * a)];
    let [k4, k6] = [C / A, R::one() + a * a / (C + a * a)];
    from_fn(move |_t, &[theta, psi, _phi, _xi, _eta, _zeta, tilting, turning, rolling]: &[R; 9]| {
        let ((sin, cos), (sin_psi, cos_psi)) = R::sin_cos_pair(theta, psi);
        let c = turning * cos;
        let across = turning * sin;
        let axial = c + rolling;
        let p = a * tilting;
        let (u, v) = (p * sin, a * axial);
        let turning_rate = tilting * (k4 * axial - (c + c)) / sin;
        [
            tilting,
            turning,
            rolling,
            u * sin_psi - v * cos_psi,
            -(u * cos_psi + v * sin_psi),
            p * cos,
            across * (k1 * c - k2 * axial) - k3 * cos,
            turning_rate,
            k6 * tilting * across - turning_rate * cos,
        ]
    })
}

/// Appell's system.
pub fn appell<R: Real>([a, A, C, g]: [R; 4]) -> impl System<R, 9> {
    #![allow(non_snake_case, reason = "the paper's names")]
    let across = A + a * a;
    let [k1, k2, k3, k4] = [A / across, (C + a * a) / across, a * g / across, (C + a * a) / A];
    from_fn(move |_t, &[theta, _psi, _phi, _xi, _eta, _zeta, eta1, eta2, eta3]: &[R; 9]| {
        let (sin, cos) = theta.sin_cos();
        let w = eta2 / sin;
        let c = cos * w;
        let p = a * eta1;
        [
            eta1,
            w,
            eta3 - c,
            -(p * sin),
            R::zero(),
            p * cos,
            eta2 * (k1 * c - k2 * eta3) - k3 * cos,
            eta1 * (k4 * eta3 - c),
            R::zero(),
        ]
    })
}
