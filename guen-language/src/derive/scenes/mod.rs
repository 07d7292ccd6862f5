//! Scenes as levels of detail: what they ask for, the variables they keep, and the cheapest programs for these.

mod asked;
mod cheapest;
mod kept;
pub(super) mod scene;
