//! Lanes: the bits of plain `f64`, and guards for each lane as if it ran alone.

mod guarded_lanes;
mod lanes;
