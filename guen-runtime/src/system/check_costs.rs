//! The costs of a guard's checks for a system.

/// The costs of what a guard asks of one state of a system, in evaluations of the right-hand side. Guards check expensive systems
/// less often.
///
/// ```
/// use guen_runtime::{CheckCosts, Guarded, System};
///
/// /// A mass on a spring, which says no more than its rates.
/// struct Oscillator;
/// impl System<f64, 2> for Oscillator {
///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
///         [v, -x]
///     }
/// }
/// assert_eq!(Oscillator.guarded().check_costs(), CheckCosts { all: 2, singularities: 0.0 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckCosts {
    /// The cost of [`conserved`](crate::Guarded::conserved), [`singularities`](crate::Guarded::singularities) and
    /// [`condition`](crate::Guarded::condition) together.
    pub all: u32,
    /// The cost of [`singularities`](crate::Guarded::singularities) alone, with what a guard makes of them: next to fixed steps it
    /// asks for them more often than for the rest.
    pub singularities: f64,
}

impl CheckCosts {
    /// The costs with those of singularities in hundredths, as generated code states them.
    #[doc(hidden)]
    pub const fn of(all: u32, hundredths: u32) -> Self {
        Self { all, singularities: hundredths as f64 / 100.0 }
    }
}

impl Default for CheckCosts {
    /// The costs of a system that says nothing of them: two for everything, and no singularities to check.
    fn default() -> Self {
        Self { all: 2, singularities: 0.0 }
    }
}
