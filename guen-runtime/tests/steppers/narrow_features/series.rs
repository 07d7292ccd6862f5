//! The Taylor series of an oscillator with a hidden feature, by the recurrences of its functions.

use guen_runtime::{Coefficients, HIGHEST_ORDER};

use super::{Hidden, Of};

/// The coefficients of a function by their order.
type Terms = [f64; HIGHEST_ORDER + 1];

/// The coefficient `sum_j a_j b_(k-j)` of a product.
fn product(a: &Terms, b: &Terms, k: usize) -> f64 {
    (0..=k).map(|j| a[j] * b[k - j]).sum()
}

/// The coefficient of order `k >= 1` of `f` with `f' = slope u'`: `sum_j j u_j slope_(k-j) / k`.
fn integral(u: &Terms, slope: &Terms, k: usize) -> f64 {
    (1..=k).map(|j| j as f64 * u[j] * slope[k - j]).sum::<f64>() / k as f64
}

/// The series through a state, of `x' = v` and `v' = force f(s) - x` with `s = (y - place)/width`.
pub fn series(
    hidden: &Hidden,
    t: f64,
    state: &[f64; 2],
    scale: f64,
    order: usize,
    to: &mut Coefficients<f64, 2>,
) {
    let order = order.min(HIGHEST_ORDER);
    let zero = [0.0; HIGHEST_ORDER + 1];
    let (mut s, mut u, mut feature, mut slope) = (zero, zero, zero, zero);
    to[0] = *state;
    for k in 0..order {
        let of = match hidden.of {
            Of::Time => [t, scale].get(k).copied().unwrap_or(0.0),
            Of::Coordinate => to[k][0],
            Of::Velocity => to[k][1],
        };
        s[k] = (if k == 0 { of - hidden.place } else { of }) / hidden.width;
        if hidden.lasting {
            // f = tanh(s), f' = (1 - f^2) s'
            feature[k] = if k == 0 { s[0].tanh() } else { integral(&s, &slope, k) };
            slope[k] = if k == 0 { 1.0 } else { 0.0 } - product(&feature, &feature, k);
        } else {
            // f = exp(u), f' = f u', u = -s^2
            u[k] = -product(&s, &s, k);
            feature[k] = if k == 0 { u[0].exp() } else { integral(&u, &feature, k) };
        }
        let [x, v] = to[k];
        to[k + 1] = [v, hidden.force * feature[k] - x].map(|rate| rate * scale / (k + 1) as f64);
    }
}
