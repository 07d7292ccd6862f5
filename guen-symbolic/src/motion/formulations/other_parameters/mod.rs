//! Formulations that state a system again in other parameters, solve it there, and turn back.
//!
//! `restated` does so for all: `spins` of bodies, base angles without `headings`, rates of base angles (`base_parameters`).

pub(super) mod base_parameters;
pub(super) mod headings;
pub(super) mod restated;
pub(super) mod spins;
