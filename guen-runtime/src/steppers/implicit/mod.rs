//! Implicit methods, for stiff systems and long runs.

mod collocation;
pub(crate) mod gauss;
pub(crate) mod radau5;
