//! Transitions: what a run tells of the end of one mode and the beginning of the next.

use core::fmt;

/// The kind of a [`Transition`].
///
/// ```
/// use guen_runtime::hybrid::TransitionKind;
/// assert_eq!(format!("{}", TransitionKind::Lifted), "lifted");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TransitionKind {
    /// Velocities jump.
    Impact,
    /// A gap closes without an impulse.
    Closed,
    /// A normal reaction falls to zero, and the contact opens.
    Lifted,
    /// A tangential reaction reaches its limit, and slip begins.
    Slips,
    /// A slip ends, and the element sticks.
    Sticks,
    /// A slip goes through zero into the other direction.
    Reversed,
    /// A latch locks.
    Locked,
    /// A latch is released.
    Released,
    /// A switch changes its value, or inputs change.
    Switched,
    /// A reset gives a new state.
    Reset,
    /// Infinitely many impacts come to an end: they are left out from the time of the transition on.
    Rest {
        /// The impacts of the sequence that were computed.
        impacts: u32,
        /// The time at which the sequence ends.
        until: f64,
    },
    /// A gap touches zero and opens again, or a reaction does and stays. The mode does not change.
    Touch,
}

impl fmt::Display for TransitionKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Impact => "impact",
            Self::Closed => "closed",
            Self::Lifted => "lifted",
            Self::Slips => "slips",
            Self::Sticks => "sticks",
            Self::Reversed => "reversed",
            Self::Locked => "locked",
            Self::Released => "released",
            Self::Switched => "switched",
            Self::Reset => "reset",
            Self::Rest { until, .. } => return write!(f, "rest at t = {until}"),
            Self::Touch => "touch",
        })
    }
}

/// The end of one mode and the beginning of the next, at one time: what [`Hybrid::transitions`](crate::hybrid::Hybrid::transitions)
/// tells, with an example in the [module](crate::hybrid).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition<M, const N: usize, const W: usize, const C: usize> {
    /// The time.
    pub t: f64,
    /// The kind. Where several things happen at once, the first of the list of kinds that applies.
    pub kind: TransitionKind,
    /// The elements that took part: whose functions reached zero, and which an impact gave impulses.
    pub elements: [bool; C],
    /// The signal that changed, by its position.
    pub signal: Option<usize>,
    /// The mode before.
    pub before: M,
    /// The mode after.
    pub after: M,
    /// The state before.
    pub state_before: [f64; N],
    /// The state after.
    pub state_after: [f64; N],
    /// The impulses along all rows; zeros where nothing jumps.
    pub impulses: [f64; W],
    /// The change of the kinetic energy by the impulses.
    pub energy: f64,
    pub(in crate::hybrid) facts: Facts<C>,
}

/// The facts of a transition that its derivative depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::hybrid) struct Facts<const C: usize> {
    /// The functions of the elements that reached zero, as [`Fired`](crate::hybrid::transitions::hybrid_state::Fired) lists them.
    pub(in crate::hybrid) gap: [bool; C],
    pub(in crate::hybrid) normal: [bool; C],
    pub(in crate::hybrid) cone: [[bool; 2]; C],
    pub(in crate::hybrid) slip: [bool; C],
    pub(in crate::hybrid) shared: bool,
    /// The number of signals that reached zero.
    pub(in crate::hybrid) signals: usize,
    /// The elements that took part in an impact; none where there was none.
    pub(in crate::hybrid) takes_part: Option<[bool; C]>,
    /// Whether the run began here.
    pub(in crate::hybrid) begins: bool,
    /// Whether inputs change at this time.
    pub(in crate::hybrid) inputs: bool,
}

impl<const C: usize> Facts<C> {
    /// Nothing has reached zero.
    pub(in crate::hybrid) fn none() -> Self {
        let no = [false; C];
        let cone = [[false; 2]; C];
        Self {
            gap: no,
            normal: no,
            cone,
            slip: no,
            shared: false,
            signals: 0,
            takes_part: None,
            begins: false,
            inputs: false,
        }
    }
}
