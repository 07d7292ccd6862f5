//! Arms in space, the state being `J` angles and their rates (`N = 2 J`): forces by the recursive Newton-Euler algorithm,
//! the mass matrix by that of composite rigid bodies, both in the axes of each link (Featherstone, Rigid Body Dynamics
//! Algorithms, 2008), then a factorisation `L D L^T`.
#![allow(clippy::needless_range_loop, reason = "indices as in the formulas")]

use guen::{Real, System, from_fn};

type Vector<R> = [R; 3];

/// About which axis of the link before it a link turns: 0 is x.
pub fn arm<R: Real, const J: usize, const N: usize>(
    axes: [usize; J],
    [m, l, a, b, c, d, g]: [R; 7],
) -> impl System<R, N> {
    let part = |n: i64, d: i64| R::from_ratio(n, d) * l;
    let (tip, center) = ([l, R::zero(), part(1, 4)], [part(1, 2), part(1, 8), part(-1, 4)]);
    let moment = center.map(|e| m * e);
    // About the joint.
    let square = dot(&center, &center);
    let steiner = |i: usize, k: usize| m * (if i == k { square } else { R::zero() } - center[i] * center[k]);
    let own = [a, b, c, d, R::zero(), R::zero()];
    let places = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
    let inertia: [R; 6] = core::array::from_fn(|p| own[p] + steiner(places[p].0, places[p].1));
    from_fn(move |_t, state: &[R; N]| {
        let (zero, one) = (R::zero(), R::one());
        let mut turns = [(zero, one); J];
        let mut forces = [[zero; 3]; J];
        let mut torques = [[zero; 3]; J];
        let (mut spin, mut rate, mut fall) = ([zero; 3], [zero; 3], [zero, zero, g]);
        let mut gradient = [[zero; 3]; 3];
        for j in 0..J {
            let (s, c) = state[j].sin_cos();
            turns[j] = (s, c);
            let k = axes[j];
            let speed = state[J + j];
            if j > 0 {
                for i in 0..3 {
                    fall[i] += dot(&gradient[i], &tip);
                }
            }
            (spin, rate, fall) = (back(k, s, c, &spin), back(k, s, c, &rate), back(k, s, c, &fall));
            let (p, q) = ((k + 1) % 3, (k + 2) % 3);
            rate[p] += spin[q] * speed;
            rate[q] -= spin[p] * speed;
            spin[k] += speed;
            let [x, y, z] = spin;
            let (xx, yy, zz, xy, yz, zx) = (x * x, y * y, z * z, x * y, y * z, z * x);
            gradient = [
                [-(yy + zz), xy - rate[2], zx + rate[1]],
                [xy + rate[2], -(zz + xx), yz - rate[0]],
                [zx - rate[1], yz + rate[0], -(xx + yy)],
            ];
            let lever = cross(&moment, &fall);
            let [ixx, iyy, izz, ixy, iyz, izx] = inertia;
            for i in 0..3 {
                forces[j][i] = m * fall[i] + dot(&gradient[i], &moment);
            }
            torques[j] = [
                ixx * rate[0] + (izz - iyy) * yz + izx * gradient[1][0] - ixy * gradient[2][0]
                    + iyz * (yy - zz)
                    + lever[0],
                iyy * rate[1] + (ixx - izz) * zx + ixy * gradient[2][1] - iyz * gradient[0][1]
                    + izx * (zz - xx)
                    + lever[1],
                izz * rate[2] + (iyy - ixx) * xy + iyz * gradient[0][2] - izx * gradient[1][2]
                    + ixy * (xx - yy)
                    + lever[2],
            ];
        }
        // Inwards, with the composite bodies.
        let mut matrix = [[zero; J]; J];
        let mut right = [zero; J];
        let (mut carried, mut weight, mut load) = (moment, m, inertia);
        for j in (0..J).rev() {
            let k = axes[j];
            right[j] = -torques[j][k];
            // The momentum of what the joint carries, for a turn by one.
            let (p, q) = ((k + 1) % 3, (k + 2) % 3);
            let mut momentum = [zero; 3];
            momentum[p] = -carried[q];
            momentum[q] = carried[p];
            let mut angular = column(&load, k);
            matrix[j][j] = angular[k];
            for i in (0..j).rev() {
                let (s, c) = turns[i + 1];
                momentum = there(axes[i + 1], s, c, &momentum);
                angular = there(axes[i + 1], s, c, &angular);
                let lever = cross(&tip, &momentum);
                for e in 0..3 {
                    angular[e] += lever[e];
                }
                matrix[j][i] = angular[axes[i]];
            }
            if j == 0 {
                break;
            }
            let (s, c) = turns[j];
            let force = there(k, s, c, &forces[j]);
            let torque = there(k, s, c, &torques[j]);
            let lever = cross(&tip, &force);
            for e in 0..3 {
                forces[j - 1][e] += force[e];
                torques[j - 1][e] += torque[e] + lever[e];
            }
            let turned = there(k, s, c, &carried);
            let square = turned_inertia(k, s, c, &load);
            let along = dot(&turned, &tip);
            let two = one + one;
            let length = weight * dot(&tip, &tip);
            for (place, (i, e)) in places.into_iter().enumerate() {
                let straight = if i == e { two * along + length } else { zero };
                let shifted = straight - turned[i] * tip[e] - tip[i] * turned[e] - weight * tip[i] * tip[e];
                load[place] = inertia[place] + square[place] + shifted;
            }
            for e in 0..3 {
                carried[e] = moment[e] + turned[e] + weight * tip[e];
            }
            weight += m;
        }
        // From the last joint to the first.
        let mut inverse = [zero; J];
        for j in (0..J).rev() {
            inverse[j] = matrix[j][j].recip();
            for i in 0..j {
                let factor = matrix[j][i] * inverse[j];
                for e in 0..=i {
                    matrix[i][e] -= factor * matrix[j][e];
                }
                right[i] -= factor * right[j];
            }
        }
        let mut rates = [zero; N];
        for j in 0..J {
            let mut rest = right[j];
            for i in 0..j {
                rest -= matrix[j][i] * rates[J + i];
            }
            rates[j] = state[J + j];
            rates[J + j] = rest * inverse[j];
        }
        rates
    })
}

#[inline(always)]
fn dot<R: Real>(a: &Vector<R>, b: &Vector<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<R: Real>(a: &Vector<R>, b: &Vector<R>) -> Vector<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// From the axes of a link to those of the one before it.
#[inline(always)]
fn there<R: Real>(k: usize, s: R, c: R, &[x, y, z]: &Vector<R>) -> Vector<R> {
    match k {
        0 => [x, c * y - s * z, s * y + c * z],
        1 => [c * x + s * z, y, c * z - s * x],
        _ => [c * x - s * y, s * x + c * y, z],
    }
}

/// The way back.
#[inline(always)]
fn back<R: Real>(k: usize, s: R, c: R, v: &Vector<R>) -> Vector<R> {
    there(k, -s, c, v)
}

/// A column of a symmetric matrix given by `xx, yy, zz, xy, yz, zx`.
#[inline(always)]
fn column<R: Real>(&[xx, yy, zz, xy, yz, zx]: &[R; 6], k: usize) -> Vector<R> {
    match k {
        0 => [xx, xy, zx],
        1 => [xy, yy, yz],
        _ => [zx, yz, zz],
    }
}

/// `R I R^T`.
#[inline(always)]
fn turned_inertia<R: Real>(k: usize, s: R, c: R, &[xx, yy, zz, xy, yz, zx]: &[R; 6]) -> [R; 6] {
    // In the plane of the turn: sine and cosine of the double angle from the products.
    let plane = |p: R, q: R, pq: R| {
        let (u, v) = (c * p - s * pq, c * pq - s * q);
        let (first, mixed) = (c * u - s * v, s * u + c * v);
        (first, p + q - first, mixed)
    };
    match k {
        0 => {
            let (yy, zz, yz) = plane(yy, zz, yz);
            [xx, yy, zz, c * xy - s * zx, yz, s * xy + c * zx]
        }
        1 => {
            let (zz, xx, zx) = plane(zz, xx, zx);
            [xx, yy, zz, s * yz + c * xy, c * yz - s * xy, zx]
        }
        _ => {
            let (xx, yy, xy) = plane(xx, yy, xy);
            [xx, yy, zz, xy, s * zx + c * yz, c * zx - s * yz]
        }
    }
}
