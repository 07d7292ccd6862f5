//! Systems at the edges of the language: very small, very large, oddly named, with every function; each against an
//! independent formula.

mod functions;
mod hostile;
mod many_coordinates;
mod names;
mod positions;
mod small;

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * (1.0 + expected.abs()), "{found} and {expected}");
}
