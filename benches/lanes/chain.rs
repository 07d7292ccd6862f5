//! A planar chain of ten links: declared, and by hand.

use guen::{Real, mechanical_system};

mechanical_system! {
    /// Point masses on massless links, hanging from the origin; the angles are absolute, zero downwards.
    pub system Chain {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { q1, q2, q3, q4, q5, q6, q7, q8, q9, q10 }
        parameters {
            w1 = dot(q1);
            w2 = dot(q2);
            w3 = dot(q3);
            w4 = dot(q4);
            w5 = dot(q5);
            w6 = dot(q6);
            w7 = dot(q7);
            w8 = dot(q8);
            w9 = dot(q9);
            w10 = dot(q10);
        }
        let x1 = l*sin(q1);
        let y1 = -l*cos(q1);
        let x2 = x1 + l*sin(q2);
        let y2 = y1 - l*cos(q2);
        let x3 = x2 + l*sin(q3);
        let y3 = y2 - l*cos(q3);
        let x4 = x3 + l*sin(q4);
        let y4 = y3 - l*cos(q4);
        let x5 = x4 + l*sin(q5);
        let y5 = y4 - l*cos(q5);
        let x6 = x5 + l*sin(q6);
        let y6 = y5 - l*cos(q6);
        let x7 = x6 + l*sin(q7);
        let y7 = y6 - l*cos(q7);
        let x8 = x7 + l*sin(q8);
        let y8 = y7 - l*cos(q8);
        let x9 = x8 + l*sin(q9);
        let y9 = y8 - l*cos(q9);
        let x10 = x9 + l*sin(q10);
        let y10 = y9 - l*cos(q10);
        particles {
            m at vec(x1, y1);
            m at vec(x2, y2);
            m at vec(x3, y3);
            m at vec(x4, y4);
            m at vec(x5, y5);
            m at vec(x6, y6);
            m at vec(x7, y7);
            m at vec(x8, y8);
            m at vec(x9, y9);
            m at vec(x10, y10);
        }
        gravity = vec(0, -g);
    }
}

/// The number of links.
pub const LINKS: usize = 10;

/// `g/l`, which is all that the motion depends on.
#[derive(Clone, Copy)]
pub struct ByHand<R> {
    pub ratio: R,
}

impl<R: Real> ByHand<R> {
    /// `M_ij = (N - max(i, j)) cos(q_i - q_j)`, solved by `L D L^T` in place; loops of constant length.
    #[allow(clippy::needless_range_loop, reason = "indices as in the formulas")]
    #[inline(always)]
    pub fn rhs(&self, state: &[R; 2 * LINKS]) -> [R; 2 * LINKS] {
        let mut sines = [R::zero(); LINKS];
        let mut cosines = [R::zero(); LINKS];
        for i in 0..LINKS {
            (sines[i], cosines[i]) = state[i].sin_cos();
        }
        let mut matrix = [[R::zero(); LINKS]; LINKS];
        let mut force = [R::zero(); LINKS];
        let squares: [R; LINKS] = {
            let mut squares = [R::zero(); LINKS];
            for i in 0..LINKS {
                squares[i] = state[LINKS + i] * state[LINKS + i];
            }
            squares
        };
        for i in 0..LINKS {
            let weight = R::from_ratio((LINKS - i) as i64, 1);
            matrix[i][i] = weight;
            force[i] -= weight * self.ratio * sines[i];
            for j in 0..i {
                let sine = weight * (sines[i] * cosines[j] - cosines[i] * sines[j]);
                matrix[i][j] = weight * (cosines[i] * cosines[j] + sines[i] * sines[j]);
                force[i] -= sine * squares[j];
                force[j] += sine * squares[i];
            }
        }
        let mut inverse = [R::zero(); LINKS];
        for j in 0..LINKS {
            inverse[j] = matrix[j][j].recip();
            for i in j + 1..LINKS {
                let factor = matrix[i][j] * inverse[j];
                for k in j + 1..i {
                    let product = factor * matrix[k][j];
                    matrix[i][k] -= product;
                }
                matrix[i][i] -= factor * matrix[i][j];
                let product = factor * force[j];
                force[i] -= product;
            }
        }
        for i in (0..LINKS).rev() {
            let mut sum = force[i];
            for k in i + 1..LINKS {
                sum -= matrix[k][i] * force[k];
            }
            force[i] = sum * inverse[i];
        }
        let mut rates = [R::zero(); 2 * LINKS];
        rates[..LINKS].copy_from_slice(&state[LINKS..]);
        rates[LINKS..].copy_from_slice(&force);
        rates
    }
}
