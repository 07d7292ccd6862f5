//! Mechanisms with figures that others have published, or that a closed form gives.
//!
//! Each module names the source of its figures and says how many digits of them are right. Tolerances are those digits, or
//! what the method of the test can reach where that is less.

mod bicycle;
mod closed_forms;
mod disc;
mod linkages;
mod rattleback;
mod tops;

/// Fails where two lists differ by more than the tolerance, relative to the larger of the expected entry and `scale`.
#[track_caller]
fn close(what: &str, found: &[f64], expected: &[f64], scale: f64, tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        let error = (a - b).abs() / b.abs().max(scale);
        assert!(error <= tolerance, "{what}, entry {i}: {a} instead of {b}, off by {error:.1e}");
    }
}
