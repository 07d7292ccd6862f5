//! Elements: what can touch, slip, stop and lock, as a table that is known at compile time.

/// The kind of an [`Element`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A contact without friction: open or closed.
    Smooth,
    /// A contact with Coulomb friction: open, stick or slip.
    Rough,
    /// A constraint on velocities that gives way where its force reaches a limit: stick or slip.
    Grip,
    /// A constraint on positions that is locked and released: free or locked.
    Latch,
}

/// A contact, a grip or a latch: its name, its kind and its rows.
///
/// A *row* is a form `gamma_w = W_w eta + w_w` of the velocities, with a reaction along it. Rows are numbered over all elements.
///
/// - A smooth contact has one row, the rate of its gap; a rough one the rate of its gap and one or two components of its slip.
/// - A grip has one or two components of its slip, and no normal row.
/// - A latch has one row, the rate of its gap.
///
/// ```
/// use guen_runtime::hybrid::{Element, Kind};
///
/// const ELEMENTS: [Element; 3] =
///     [Element::smooth("stop", 0), Element::rough("tyre", 1, &[2]).with_friction_of_speed(), Element::latch("bolt", 3)];
/// assert_eq!((ELEMENTS[1].kind, ELEMENTS[1].load), (Kind::Rough, Some(1)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Element {
    /// The name in the declaration.
    pub name: &'static str,
    /// The kind.
    pub kind: Kind,
    /// The row of the gap's rate; none for a grip.
    pub normal: Option<usize>,
    /// The rows of the slip's components: none, one or two.
    pub tangential: &'static [usize],
    /// The row whose reaction, times the coefficient of friction, limits the tangential reaction: of a rough contact its own
    /// normal row. The limit is `limit + friction * reaction`; without a load it is `limit` alone.
    pub load: Option<usize>,
    /// Whether the magnitude of a permanent constraint's reaction takes the place of that row's: see [`Loads`](crate::hybrid::Loads).
    pub loaded_by_constraint: bool,
    /// Whether the coefficient of friction depends on the magnitude of the slip.
    pub friction_of_speed: bool,
    /// Whether it closes, or locks, only under a condition `when`: an open contact without one is never below zero.
    pub conditional: bool,
}

impl Element {
    const fn new(
        name: &'static str,
        kind: Kind,
        normal: Option<usize>,
        tangential: &'static [usize],
        load: Option<usize>,
    ) -> Self {
        Self {
            name,
            kind,
            normal,
            tangential,
            load,
            loaded_by_constraint: false,
            friction_of_speed: false,
            conditional: false,
        }
    }

    /// A contact without friction, with the row of its gap's rate.
    pub const fn smooth(name: &'static str, normal: usize) -> Self {
        Self::new(name, Kind::Smooth, Some(normal), &[], None)
    }

    /// A contact with friction: the row of its gap's rate, and one or two rows of its slip.
    pub const fn rough(name: &'static str, normal: usize, tangential: &'static [usize]) -> Self {
        Self::new(name, Kind::Rough, Some(normal), tangential, Some(normal))
    }

    /// A grip, with one or two rows of its slip.
    pub const fn grip(name: &'static str, tangential: &'static [usize]) -> Self {
        Self::new(name, Kind::Grip, None, tangential, None)
    }

    /// A latch, with the row of its gap's rate.
    pub const fn latch(name: &'static str, normal: usize) -> Self {
        Self::new(name, Kind::Latch, Some(normal), &[], None)
    }

    /// A grip whose limit grows with the reaction of a row, the normal row of a smooth contact: `load = reaction(contact)`.
    #[must_use]
    pub const fn loaded_by(self, row: usize) -> Self {
        Self { load: Some(row), ..self }
    }

    /// A grip whose limit grows with the magnitude of the reaction of a permanent constraint: `load = reaction(constraint)`.
    #[must_use]
    pub const fn loaded_by_constraint(self) -> Self {
        Self { loaded_by_constraint: true, ..self }
    }

    /// Whether a reaction limits its tangential reaction.
    pub const fn is_loaded(&self) -> bool {
        self.load.is_some() || self.loaded_by_constraint
    }

    /// An element whose coefficient of friction depends on the magnitude of the slip.
    #[must_use]
    pub const fn with_friction_of_speed(self) -> Self {
        Self { friction_of_speed: true, ..self }
    }

    /// An element that closes, or locks, only where its [`when`](crate::hybrid::Conditions::when) is positive.
    #[must_use]
    pub const fn with_condition(self) -> Self {
        Self { conditional: true, ..self }
    }
}

/// A located function of time and state that belongs to no element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// The name in the declaration.
    pub name: &'static str,
    /// The effect of its crossings of zero.
    pub effect: Effect,
}

/// The effect of the crossings of a [`Signal`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Either crossing changes the value of a switch: one where the function is positive, zero elsewhere.
    Switch,
    /// A rise through zero resets the state: [`HybridSystem::reset`](crate::hybrid::HybridSystem::reset) gives a new state.
    ResetWhenRising,
    /// A fall through zero resets the state: [`HybridSystem::reset`](crate::hybrid::HybridSystem::reset) gives a new state.
    ResetWhenFalling,
    /// Either crossing changes the branch of a piecewise function: its value is one where the function is positive, zero where it is
    /// negative, and a half where it vanishes for a while. In a mode by itself it follows the state.
    Branch,
}

impl Signal {
    /// A switch.
    pub const fn switch(name: &'static str) -> Self {
        Self { name, effect: Effect::Switch }
    }

    /// A reset where the function rises through zero.
    pub const fn reset_rising(name: &'static str) -> Self {
        Self { name, effect: Effect::ResetWhenRising }
    }

    /// A branch of a piecewise function: `abs`, `sign`, `min`, `max`, `select`.
    pub const fn branch(name: &'static str) -> Self {
        Self { name, effect: Effect::Branch }
    }

    /// Whether it has a value that is held within a mode: a switch, or a branch of a piecewise function.
    pub const fn is_switch(&self) -> bool {
        matches!(self.effect, Effect::Switch | Effect::Branch)
    }

    /// A reset where the function falls through zero.
    pub const fn reset_falling(name: &'static str) -> Self {
        Self { name, effect: Effect::ResetWhenFalling }
    }
}
