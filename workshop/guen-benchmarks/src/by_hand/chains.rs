//! Planar chains of `L` equal point masses, the state being `L` angles and their rates (`N = 2 L`).
//!
//! By elimination in the mass matrix, as textbooks have it, and by the tensions of the links. The latter is what
//! somebody writes who knows that each mass feels its two links only: work in proportion to the number of links.
#![allow(clippy::needless_range_loop, reason = "indices as in the formulas")]

use guen::{Real, System, from_fn};

/// Absolute angles, `sum_j n_ij cos(q_i - q_j) w_j' = -sum_j n_ij sin(q_i - q_j) w_j^2 - n_ii g/l sin(q_i)` with the
/// number `n_ij` of masses below both links, by a factorisation `L D L^T`.
pub fn chain_by_elimination<R: Real, const L: usize, const N: usize>([l, g]: [R; 2]) -> impl System<R, N> {
    let gravity = g / l;
    let below: [R; L] = core::array::from_fn(|i| R::from_ratio((L - i) as i64, 1));
    from_fn(move |_t, state: &[R; N]| {
        let mut rates = [R::zero(); N];
        let solved = eliminated::<R, L>(&below, gravity, &angles(state), &angular_rates(state));
        rates[..L].copy_from_slice(&state[L..]);
        rates[L..].copy_from_slice(&solved);
        rates
    })
}

#[inline(always)]
fn eliminated<R: Real, const L: usize>(below: &[R; L], gravity: R, q: &[R; L], w: &[R; L]) -> [R; L] {
    let turn: [(R, R); L] = turns(q);
    // Sums of `n_ij cos(q_j) w_j^2` and of the sines, the part above each link running upwards.
    let square: [R; L] = core::array::from_fn(|i| w[i] * w[i]);
    let mut force = [R::zero(); L];
    let (mut sines, mut cosines) = (R::zero(), R::zero());
    for i in (0..L).rev() {
        let (s, c) = turn[i];
        force[i] = c * sines - s * (cosines + below[i] * gravity);
        let weighted = below[i] * square[i];
        sines += weighted * s;
        cosines += weighted * c;
    }
    let (mut sines, mut cosines) = (R::zero(), R::zero());
    for i in 0..L {
        let (s, c) = turn[i];
        force[i] += below[i] * (c * sines - s * cosines);
        sines += square[i] * s;
        cosines += square[i] * c;
    }
    // `M = L D L^T` column by column, columns times their pivots; the right side goes along.
    let mut column = [[R::zero(); L]; L];
    let mut inverse = [R::zero(); L];
    for j in 0..L {
        let (s, c) = turn[j];
        for i in j..L {
            let (s_i, c_i) = turn[i];
            column[j][i] = if i == j { below[i] } else { below[i] * (c * c_i + s * s_i) };
        }
    }
    for j in 0..L {
        inverse[j] = column[j][j].recip();
        for i in j + 1..L {
            let factor = column[j][i] * inverse[j];
            for k in i..L {
                column[i][k] -= factor * column[j][k];
            }
            force[i] -= factor * force[j];
        }
    }
    for i in (0..L).rev() {
        let mut rest = force[i];
        for k in i + 1..L {
            rest -= column[i][k] * force[k];
        }
        force[i] = rest * inverse[i];
    }
    force
}

/// Absolute angles, by the tensions `sigma_i` of the links in units of `m l`:
///
/// ```text
/// 2 sigma_i - cos(q_i - q_i-1) sigma_i-1 - cos(q_i+1 - q_i) sigma_i+1 = w_i^2
/// w_i' = sin(q_i+1 - q_i) sigma_i+1 - sin(q_i - q_i-1) sigma_i-1
/// ```
///
/// and for the first link, which hangs from a point at rest, `sigma_1 - .. = w_1^2 + g/l cos(q_1)` and
/// `w_1' = .. - g/l sin(q_1)`.
pub fn chain_by_tensions<R: Real, const L: usize, const N: usize>([l, g]: [R; 2]) -> impl System<R, N> {
    let gravity = g / l;
    from_fn(move |_t, state: &[R; N]| {
        let mut rates = [R::zero(); N];
        let solved = by_tensions::<R, L>(gravity, &angles(state), &angular_rates(state));
        rates[..L].copy_from_slice(&state[L..]);
        rates[L..].copy_from_slice(&solved);
        rates
    })
}

/// Relative angles: the same in absolute ones, by sums and differences.
pub fn joints<R: Real, const L: usize, const N: usize>([l, g]: [R; 2]) -> impl System<R, N> {
    let gravity = g / l;
    from_fn(move |_t, state: &[R; N]| {
        let (mut q, mut w) = (angles::<R, L, N>(state), angular_rates::<R, L, N>(state));
        for i in 1..L {
            q[i] = q[i - 1] + q[i];
            w[i] = w[i - 1] + w[i];
        }
        let solved = by_tensions(gravity, &q, &w);
        let mut rates = [R::zero(); N];
        for i in 0..L {
            rates[i] = state[L + i];
            rates[L + i] = if i == 0 { solved[0] } else { solved[i] - solved[i - 1] };
        }
        rates
    })
}

/// Sines and cosines of all angles, two at a time.
#[inline(always)]
fn turns<R: Real, const L: usize>(q: &[R; L]) -> [(R, R); L] {
    let mut turns = [(R::zero(), R::one()); L];
    let mut i = 0;
    while i + 1 < L {
        (turns[i], turns[i + 1]) = R::sin_cos_pair(q[i], q[i + 1]);
        i += 2;
    }
    if i < L {
        turns[i] = q[i].sin_cos();
    }
    turns
}

#[inline(always)]
fn by_tensions<R: Real, const L: usize>(gravity: R, q: &[R; L], w: &[R; L]) -> [R; L] {
    let two = R::from_ratio(2, 1);
    let turn: [(R, R); L] = turns(q);
    // Sine and cosine from each link to the next; nothing follows the last one.
    let bend: [(R, R); L] = core::array::from_fn(|i| {
        let ((s, c), (s_next, c_next)) = (turn[i], turn[if i + 1 < L { i + 1 } else { i }]);
        (s_next * c - c_next * s, c * c_next + s * s_next)
    });
    // From the tip upwards: `sigma_i = loads[i] + factors[i] sigma_i-1`.
    let (mut loads, mut factors) = ([R::zero(); L], [R::zero(); L]);
    let mut sigma = [R::zero(); L];
    for i in (0..L).rev() {
        let (mut pivot, mut load) = (if i == 0 { R::one() } else { two }, w[i] * w[i]);
        if i + 1 < L {
            let cosine = bend[i].1;
            pivot -= cosine * factors[i + 1];
            load += cosine * loads[i + 1];
        }
        let inverse = pivot.recip();
        if i == 0 {
            sigma[0] = (load + gravity * turn[0].1) * inverse;
        } else {
            loads[i] = load * inverse;
            factors[i] = bend[i - 1].1 * inverse;
        }
    }
    for i in 1..L {
        sigma[i] = loads[i] + factors[i] * sigma[i - 1];
    }
    core::array::from_fn(|i| {
        let above = if i == 0 { gravity * turn[0].0 } else { bend[i - 1].0 * sigma[i - 1] };
        if i + 1 < L { bend[i].0 * sigma[i + 1] - above } else { -above }
    })
}

#[inline(always)]
fn angles<R: Real, const L: usize, const N: usize>(state: &[R; N]) -> [R; L] {
    core::array::from_fn(|i| state[i])
}

#[inline(always)]
fn angular_rates<R: Real, const L: usize, const N: usize>(state: &[R; N]) -> [R; L] {
    core::array::from_fn(|i| state[L + i])
}
