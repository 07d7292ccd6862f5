//! The facts about a mode that are known while a system is compiled.

use crate::report::cost::Cost;

/// A mode with what was derived of it.
///
/// Generated systems with contacts list them, one for each of their modes, as `MODE_INFO`.
///
/// ```
/// use guen_runtime::{Cost, hybrid::ModeInfo};
/// let sticks = ModeInfo { mode: "tyre stick", rows: &["tyre_n", "tyre_t"], painleve_free: true, cost: Cost::ZERO };
/// assert_eq!(sticks.rows.len(), 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModeInfo<M: 'static> {
    /// The mode.
    pub mode: M,
    /// The velocities that are held at zero, each with a reaction: of a contact `tyre` along its gap `tyre_n`, along its slip `tyre_t`.
    pub rows: &'static [&'static str],
    /// Whether it is proved that the reactions of the mode have one value: nothing slips with friction, or no slip changes how a gap
    /// answers to its own force.
    pub painleve_free: bool,
    /// The operations of what every mode evaluates: the rates without contacts and the entries of `D`. The solve for the reactions of the
    /// mode's rows comes on top of it.
    pub cost: Cost,
}
