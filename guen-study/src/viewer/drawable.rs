//! Numbers that can be drawn.

use super::turn;

/// Single precision and the squares of lengths have to hold it.
pub(super) const LARGEST_COORDINATE: f64 = 1e18;

/// Whether numbers can be drawn: finite, and not too large.
pub(super) fn is_drawable(values: &[f64]) -> bool {
    values.iter().all(|value| value.abs() <= LARGEST_COORDINATE)
}

/// Whether a vector has a direction that can be drawn.
pub(super) fn is_direction(vector: [f64; 3]) -> bool {
    is_drawable(&vector) && turn::norm(vector) > 0.0
}
