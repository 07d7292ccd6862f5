//! Integration of a function from its values at Chebyshev's points of an interval.

use std::f64::consts::PI;

/// The points of the finer rule on an interval, both ends counted, less one. Every second one is a point of the coarser.
pub(super) const FINE: usize = 8;

/// Returns the points of the finer rule on `0..=1`: `(1 - cos(j pi/8))/2`.
pub(super) fn points() -> [f64; FINE + 1] {
    std::array::from_fn(|j| match j {
        0 => 0.0,
        _ if 2 * j == FINE => 0.5,
        FINE => 1.0,
        _ => 0.5 * (1.0 - (PI * j as f64 / FINE as f64).cos()),
    })
}

/// The integrals of the polynomial through the values at `m + 1` points `(1 - cos(j pi/m))/2`: the last one is the
/// rule of Clenshaw and Curtis (Numerische Mathematik 2, 1960, 197), exact for polynomials of degree `m`.
pub(super) struct Rule {
    /// The number of points of the finer rule from one point of this rule to the next.
    pub(super) stride: usize,
    /// `weights[i][j]`: the share of value `j` in the integral from 0 to point `i`.
    pub(super) weights: Vec<Vec<f64>>,
}

impl Rule {
    /// The rule on every `stride`-th point.
    pub(super) fn new(stride: usize) -> Rule {
        let m = FINE / stride;
        let half = |k: usize| if k == 0 || k == m { 0.5 } else { 1.0 };
        let angle = |j: usize| PI * j as f64 / m as f64;
        // In x = -cos(angle): T_k(x) = (-1)^k cos(k angle).
        let chebyshev = |k: usize, i: usize| {
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * (k as f64 * angle(i)).cos()
        };
        // The antiderivatives of T_k without a constant.
        let primitive = |k: usize, i: usize| match k {
            0 => chebyshev(1, i),
            1 => chebyshev(2, i) / 4.0,
            _ => (chebyshev(k + 1, i) / (k + 1) as f64 - chebyshev(k - 1, i) / (k - 1) as f64) / 2.0,
        };
        let weight = |i: usize, j: usize| {
            let terms = (0..=m).map(|k| half(k) * chebyshev(k, j) * (primitive(k, i) - primitive(k, 0)));
            // The interval has half the length of -1..1.
            0.5 * half(j) * 2.0 / m as f64 * terms.sum::<f64>()
        };
        let weights = (0..=m).map(|i| (0..=m).map(|j| weight(i, j)).collect()).collect();
        Rule { stride, weights }
    }
}

/// The coefficients of the polynomial through the values at the points of the finer rule, by Chebyshev's polynomials.
pub(super) fn chebyshev(values: &[f64]) -> [f64; FINE + 1] {
    let half = |k: usize| if k == 0 || k == FINE { 0.5 } else { 1.0 };
    std::array::from_fn(|k| {
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let terms = values
            .iter()
            .enumerate()
            .map(|(j, value)| half(j) * value * (PI * (k * j) as f64 / FINE as f64).cos());
        sign * half(k) * 2.0 / FINE as f64 * terms.sum::<f64>()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly_to_every_point() {
        let points = points();
        for stride in [1, 2] {
            let rule = Rule::new(stride);
            let m = FINE / stride;
            for degree in 0..=m {
                for i in 0..=m {
                    let value = |j: usize| points[j * stride].powi(degree as i32);
                    let sum: f64 = (0..=m).map(|j| rule.weights[i][j] * value(j)).sum();
                    let exact = points[i * stride].powi(degree as i32 + 1) / (degree + 1) as f64;
                    assert!((sum - exact).abs() < 4e-16, "{stride} {degree} {i}: {sum} or {exact}");
                }
            }
        }
    }
}
