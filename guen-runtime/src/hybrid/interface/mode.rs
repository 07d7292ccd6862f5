//! Modes: one state for every element, as plain data.

use core::fmt;

use super::element::{Element, Kind};

/// The state of one element in a mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ElementState {
    /// A contact that does not touch.
    #[default]
    Open,
    /// A smooth contact that touches.
    Closed,
    /// A rough contact or a grip that holds.
    Stick,
    /// A planar contact or grip whose slip is positive.
    SlipForward,
    /// A planar contact or grip whose slip is negative.
    SlipBackward,
    /// A spatial contact or grip that slips; the direction is that of its slip.
    Slip,
    /// A latch that is not locked.
    Free,
    /// A latch that is locked.
    Locked,
}

impl ElementState {
    /// Whether a contact touches, or a latch is locked.
    ///
    /// ```
    /// use guen_runtime::hybrid::ElementState;
    /// assert!(ElementState::SlipForward.is_closed() && !ElementState::Open.is_closed());
    /// ```
    pub fn is_closed(self) -> bool {
        !matches!(self, Self::Open | Self::Free)
    }

    /// Whether the element slips.
    pub fn slips(self) -> bool {
        matches!(self, Self::SlipForward | Self::SlipBackward | Self::Slip)
    }

    /// The sign of the slip: one and minus one for the two planar directions, one for spatial slip, zero elsewhere.
    pub fn sign(self) -> i8 {
        match self {
            Self::SlipForward | Self::Slip => 1,
            Self::SlipBackward => -1,
            _ => 0,
        }
    }

    /// The states that an element of this kind can have.
    pub fn of(element: &Element) -> &'static [Self] {
        match (element.kind, element.tangential.len()) {
            (Kind::Smooth, _) => &[Self::Open, Self::Closed],
            (Kind::Rough, 1) => &[Self::Open, Self::Stick, Self::SlipForward, Self::SlipBackward],
            (Kind::Rough, _) => &[Self::Open, Self::Stick, Self::Slip],
            (Kind::Grip, 1) => &[Self::Stick, Self::SlipForward, Self::SlipBackward],
            (Kind::Grip, _) => &[Self::Stick, Self::Slip],
            (Kind::Latch, _) => &[Self::Free, Self::Locked],
        }
    }

    /// The word of the declaration.
    pub fn word(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Closed => "closed",
            Self::Stick => "stick",
            Self::SlipForward => "slip+",
            Self::SlipBackward => "slip-",
            Self::Slip => "slip",
            Self::Free => "free",
            Self::Locked => "locked",
        }
    }
}

impl fmt::Display for ElementState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// A mode: the states of all elements, in the order of their declaration.
///
/// ```
/// use guen_runtime::hybrid::{ElementState, Mode};
///
/// let mode = Mode([ElementState::Stick, ElementState::Open]);
/// assert_eq!(format!("{mode}"), "stick, open");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mode<const C: usize>(pub [ElementState; C]);

impl<const C: usize> Mode<C> {
    /// The mode in which nothing touches and every grip holds.
    pub fn free(elements: &[Element; C]) -> Self {
        Self(elements.map(|element| match element.kind {
            Kind::Smooth | Kind::Rough => ElementState::Open,
            Kind::Grip => ElementState::Stick,
            Kind::Latch => ElementState::Free,
        }))
    }

    /// The mode with another state of one element.
    #[must_use]
    pub fn with(mut self, element: usize, state: ElementState) -> Self {
        if let Some(place) = self.0.get_mut(element) {
            *place = state;
        }
        self
    }
}

impl<const C: usize> Default for Mode<C> {
    fn default() -> Self {
        Self([ElementState::Open; C])
    }
}

impl<const C: usize> fmt::Display for Mode<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, state) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str(", ")?;
            }
            f.write_str(state.word())?;
        }
        Ok(())
    }
}
