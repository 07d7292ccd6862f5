//! Events that end a mode: `watched` has the functions, `located` finds their first falling zero in a step, `vanishing` says what counts as zero.

pub(super) mod located;
pub(super) mod vanishing;
pub(super) mod watched;
