//! Chaplygin's sled, from (3.16) of the paper.

use guen::{Real, System, from_fn};

/// The sled on its incline: 14 operations, one sine and cosine. The constants: `alpha, beta, k` and the gravity along
/// the slope, `g sin(incline)`.
pub fn sled<R: Real>([alpha, beta, k, gravity]: [R; 4]) -> impl System<R, 5> {
    let k1 = alpha / (alpha * alpha + k * k);
    let k2 = k1 * gravity;
    from_fn(move |_t, &[phi, _xi, _eta, eta1, eta2]: &[R; 5]| {
        let (sin, cos) = phi.sin_cos();
        let turning = k1 * eta1 * (beta * eta1 - eta2) - k2 * sin;
        [eta1, eta2 * cos, eta2 * sin, turning, beta * turning + alpha * eta1 * eta1 + gravity * cos]
    })
}
