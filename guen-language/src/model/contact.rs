//! Contacts, grips, latches, switches and their modes, checked.

use guen_symbolic::{ExprId, Mechanics};
use proc_macro2::Span;

use crate::syntax::{Crossing, Docs, Name};

/// Everything that a declaration says of contacts.
pub struct Contacts<'a> {
    /// The contacts in order.
    pub entries: Vec<ContactEntry<'a>>,
    /// The switches in order.
    pub switches: Vec<SwitchEntry<'a>>,
    /// The resets in order.
    pub resets: Vec<ResetEntry<'a>>,
    /// The states that a mode may combine: one for each contact, in the order of [`ContactEntry::states`].
    pub modes: Vec<Vec<usize>>,
    /// The mode-free system with a force along every row of the contacts, and with switches that are held.
    pub mechanics: Mechanics,
}

impl Contacts<'_> {
    /// All rows, contact by contact.
    pub fn rows(&self) -> impl Iterator<Item = &ContactRow> {
        self.entries.iter().flat_map(|entry| &entry.rows)
    }

    /// The contact that a row belongs to.
    pub fn of_row(&self, row: usize) -> usize {
        let mut last = 0;
        let ends = self.entries.iter().map(|entry| {
            last += entry.rows.len();
            last
        });
        ends.take_while(|end| *end <= row).count()
    }
}

/// The kinds of contact.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ContactKind {
    /// A gap without friction.
    Smooth,
    /// A gap with friction along a line.
    Planar,
    /// A gap with friction in a plane.
    Spatial,
    /// A velocity that vanishes until its force is too large.
    Grip,
    /// A function of positions that locks at zero.
    Latch,
}

/// A state of a contact.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ContactState {
    /// The gap is positive, or no force acts.
    Open,
    /// The gap stays zero.
    Closed,
    /// Gap and slip stay zero.
    Stick,
    /// The slip is positive.
    SlipPlus,
    /// The slip is negative.
    SlipMinus,
    /// The slip in space differs from zero.
    Slip,
    /// A latch that moves.
    Free,
    /// A latch that is locked.
    Locked,
}

impl ContactState {
    /// The state in a declaration; both directions of a slip along a line have one word.
    pub fn word(self) -> &'static str {
        match self {
            ContactState::Open => "open",
            ContactState::Closed => "closed",
            ContactState::Stick => "stick",
            ContactState::SlipPlus | ContactState::SlipMinus | ContactState::Slip => "slip",
            ContactState::Free => "free",
            ContactState::Locked => "locked",
        }
    }

    /// Whether the contact slips.
    pub fn slips(self) -> bool {
        matches!(self, ContactState::Slip | ContactState::SlipPlus | ContactState::SlipMinus)
    }

    /// The word with the sign of one direction, where there are two.
    pub fn signed_word(self) -> &'static str {
        match self {
            ContactState::SlipPlus => "slip+",
            ContactState::SlipMinus => "slip-",
            other => other.word(),
        }
    }
}

/// A velocity of a contact, with the force along it.
#[derive(Clone, Debug)]
pub struct ContactRow {
    /// The velocity, affine in the velocities and quasi-velocities.
    pub form: ExprId,
    /// The symbol of the force.
    pub force: ExprId,
}

/// A contact, a grip or a latch.
pub struct ContactEntry<'a> {
    /// Name as written.
    pub name: &'a Name,
    /// Documentation as written.
    pub docs: &'a Docs,
    /// The kind.
    pub kind: ContactKind,
    /// The gap, or the function of a latch.
    pub gap: Option<ExprId>,
    /// The place of the gap as written.
    pub gap_span: Span,
    /// The places of the components of the slip or the grip as written, row by row.
    pub along_spans: Vec<Span>,
    /// The rows: that of the gap, then those of the slip.
    pub rows: Vec<ContactRow>,
    /// The components of a slip that was written as a vector, row by row.
    pub axes: Vec<&'static str>,
    /// The coefficient of friction of a moving contact, with [`ContactEntry::speed`] in it.
    pub friction: Option<ExprId>,
    /// The coefficient of friction of a contact that sticks.
    pub stiction: Option<ExprId>,
    /// Whether a coefficient depends on the magnitude of the slip.
    pub friction_of_speed: bool,
    /// The symbol of the magnitude of the slip.
    pub speed: Option<ExprId>,
    /// The coefficient of restitution.
    pub restitution: ExprId,
    /// The largest force of a grip.
    pub limit: Option<ExprId>,
    /// The row whose force, times the coefficient of friction, limits that of a grip.
    pub loaded_by: Option<usize>,
    /// The reaction of a permanent constraint whose magnitude does that in place of a row's force.
    pub load_reaction: Option<ExprId>,
    /// The condition under which an open contact closes.
    pub when: Option<ExprId>,
    /// The function whose rise unlocks a latch.
    pub release: Option<ExprId>,
}

impl ContactEntry<'_> {
    /// The states in order.
    pub fn states(&self) -> &'static [ContactState] {
        use ContactState::{Closed, Free, Locked, Open, Slip, SlipMinus, SlipPlus, Stick};
        match (self.kind, self.rows.len()) {
            (ContactKind::Smooth, _) => &[Open, Closed],
            (ContactKind::Planar, _) => &[Open, Stick, SlipPlus, SlipMinus],
            (ContactKind::Spatial, _) => &[Open, Stick, Slip],
            (ContactKind::Grip, 1) => &[Stick, SlipPlus, SlipMinus],
            (ContactKind::Grip, _) => &[Stick, Slip],
            (ContactKind::Latch, _) => &[Free, Locked],
        }
    }
}

/// A switch: 1 where its function is positive, 0 elsewhere.
pub struct SwitchEntry<'a> {
    /// Name as written.
    pub name: &'a Name,
    /// Documentation as written.
    pub docs: &'a Docs,
    /// The symbol of its value.
    pub symbol: ExprId,
    /// The function.
    pub function: ExprId,
}

/// A reset: where its function goes through zero, variables have new values.
pub struct ResetEntry<'a> {
    /// Name as written.
    pub name: &'a Name,
    /// Documentation as written.
    pub docs: &'a Docs,
    /// The function.
    pub function: ExprId,
    /// The direction in which it goes through zero.
    pub crossing: Crossing,
    /// The variables with their new values, by the state before.
    pub assignments: Vec<(ExprId, ExprId)>,
}
