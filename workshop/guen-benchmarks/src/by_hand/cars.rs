//! A car with trailers, each hitched to the axle before it, by projection on its two freedoms.
//!
//! With the speed `v` of the rear axle, `kappa = tan(steering)/l`, and for each trailer behind an axle of speed `v V` the
//! bend `gamma` between the two, its axle has the speed `v V cos(gamma)` and turns by `v V sin(gamma)/d`. The lateral
//! accelerations do no work, so that `v' M = -v (J kappa kappa' + sum m V V' + K W W')`.

use guen::{Real, System, from_fn};

/// The constants of a car: `m, J, I, l` of the car itself, `M, K, d` of each trailer. `N` is six plus the trailers.
pub fn car<R: Real, const N: usize>([m, yaw, _steer, l, mass, inertia, d]: [R; 7]) -> impl System<R, N> {
    let by_length = l.recip();
    let by_distance = d.recip();
    let [c0, c1, c2] = [yaw / m, mass / m, inertia / (m * d * d)];
    from_fn(move |_t, state: &[R; N]| {
        let [speed, turning] = [state[N - 2], state[N - 1]];
        let ((sin, cos), (steer_sin, steer_cos)) = R::sin_cos_pair(state[2], state[3]);
        let kappa = by_length * (steer_sin / steer_cos);
        let kappa_rate = turning * (by_length + l * kappa * kappa);
        let heading_rate = speed * kappa;
        let mut rates = [R::zero(); N];
        rates[0] = speed * cos;
        rates[1] = speed * sin;
        rates[2] = heading_rate;
        rates[3] = turning;
        // `V`, `V'` of the axle in front, then sums of squares and of products with rates.
        let (mut ahead, mut ahead_rate) = (R::one(), R::zero());
        let (mut turn_ahead, mut angle_ahead) = (heading_rate, state[2]);
        let (mut along, mut along_rate) = (R::zero(), R::zero());
        let (mut across, mut across_rate) = (R::zero(), R::zero());
        for i in 4..N - 2 {
            let (s, c) = (angle_ahead - state[i]).sin_cos();
            let (forward, sideways) = (ahead * c, ahead * s);
            let turn = speed * by_distance * sideways;
            let bending = turn_ahead - turn;
            let forward_rate = ahead_rate * c - sideways * bending;
            let sideways_rate = ahead_rate * s + forward * bending;
            along += forward * forward;
            along_rate += forward * forward_rate;
            across += sideways * sideways;
            across_rate += sideways * sideways_rate;
            rates[i] = turn;
            (ahead, ahead_rate, turn_ahead, angle_ahead) = (forward, forward_rate, turn, state[i]);
        }
        let inertia = R::one() + c0 * kappa * kappa + c1 * along + c2 * across;
        let change = c0 * kappa * kappa_rate + c1 * along_rate + c2 * across_rate;
        let slowing = speed * change / inertia;
        rates[N - 2] = -slowing;
        rates[N - 1] = kappa * slowing - speed * kappa_rate;
        rates
    })
}
