//! Invariants: the quantities that a system tells the guards of a stepper, and that its exact solutions keep.

/// Quantities of one state that a guard compares with those of the start: see
/// [`Guarded::conserved`](crate::Guarded::conserved).
///
/// ```
/// use guen_runtime::Invariants;
///
/// // A system that says nothing is not guarded, except that its states must be finite.
/// assert_eq!(Invariants::<f64>::default().energy, None);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Invariants<R> {
    /// The energy integral, if the system keeps it.
    pub energy: Option<R>,
    /// A size for errors of the energy to be relative to, such as `|T| + |U|`: not negative, in units of energy.
    pub scale: R,
    /// The largest left side of the constraints on positions, each relative to the size of its terms: in units of
    /// what a relative change of one in everything that enters would make of it, positions of less than `1e-10` of the largest
    /// counted as that. Zero without any.
    pub residual: R,
    /// The distance of carried functions from their values, relative to one and their size; zero without any.
    pub carried: R,
}
