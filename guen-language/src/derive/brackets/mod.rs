//! Brackets and the written form of a derivation, as they are emitted and shown.

pub(super) mod commutator;
pub(super) mod commutators;
pub(super) mod readable;
