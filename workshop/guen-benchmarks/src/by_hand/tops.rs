//! The free rigid body by Euler's equations, and the ball on a turntable by Newton's and Euler's.

use guen::{Real, System, from_fn};

/// Euler's equations and the rates of Euler's angles.
pub fn euler_top<R: Real>([i1, i2, i3]: [R; 3]) -> impl System<R, 6> {
    let [k1, k2, k3] = [(i2 - i3) / i1, (i3 - i1) / i2, (i1 - i2) / i3];
    from_fn(move |_t, &[_psi, theta, phi, p, q, r]: &[R; 6]| {
        let ((sin, cos), (s, c)) = R::sin_cos_pair(theta, phi);
        let turning = (p * s + q * c) / sin;
        [turning, p * c - q * s, r - turning * cos, k1 * q * r, k2 * r * p, k3 * p * q]
    })
}

/// The ball on a table that turns with `omega`: its angular acceleration is `5 omega / 7 a` times its velocity.
pub fn turntable<R: Real>([a, omega]: [R; 2]) -> impl System<R, 8> {
    let k = R::from_ratio(5, 7) * omega / a;
    from_fn(move |_t, &[x, y, psi, theta, _phi, eta1, eta2, eta3]: &[R; 8]| {
        let ((sin, cos), (s, c)) = R::sin_cos_pair(theta, psi);
        let east = a * eta2 - omega * y;
        let north = omega * x - a * eta1;
        let spinning = (eta1 * s - eta2 * c) / sin;
        [east, north, eta3 - spinning * cos, eta1 * c + eta2 * s, spinning, k * east, k * north, R::zero()]
    })
}
