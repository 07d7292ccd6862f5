//! Contacts: the trait by which they run, and the type of their modes.

pub(super) mod contacts;
pub(super) mod modes;
