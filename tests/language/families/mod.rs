//! Counts, arrays, loops and sums: the same systems written out by hand and by loop.

mod chains;
mod entries;
mod long;
mod thousand;
mod vectors;

/// Masses of the links of a chain.
fn masses<const N: usize>() -> [f64; N] {
    std::array::from_fn(|i| 0.1 + 0.01 * ((7 * i) % 13) as f64)
}

/// Lengths of the links of a chain, of which the least is given.
fn lengths<const N: usize>(least: f64) -> [f64; N] {
    std::array::from_fn(|i| least * (1.0 + 0.1 * ((5 * i) % 11) as f64))
}

/// Angles of the links of a chain, and the rates of these.
fn angles_and_rates<const N: usize>() -> [[f64; N]; 2] {
    [
        std::array::from_fn(|i| 0.4 + 0.8 * f64::sin(1.7 * i as f64)),
        std::array::from_fn(|i| f64::cos(2.3 * i as f64)),
    ]
}
