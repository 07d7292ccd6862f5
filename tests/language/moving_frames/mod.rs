//! Signs that the paper's systems cannot show: moving frames, moving constraints, and other ways to write the forms.

mod bead;
mod frames;
mod rows;

use guen::prelude::*;

/// The states at some times, at tight tolerance.
fn follow<const N: usize>(system: &impl System<f64, N>, start: [f64; N], times: &[f64]) -> Vec<[f64; N]> {
    let mut seen = Vec::new();
    Dop853::new(1e-13, 1e-13).sample(system, 0.0, &start, times, |_, _, x| seen.push(*x)).unwrap();
    seen
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * (1.0 + expected.abs()), "{found} and {expected}");
}
