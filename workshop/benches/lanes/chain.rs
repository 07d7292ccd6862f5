//! A planar chain of ten links by hand.

use guen::Real;

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
