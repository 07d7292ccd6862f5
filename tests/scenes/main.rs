//! Scenes: the least model that yields what somebody looks at.

#[macro_use]
#[path = "../systems/mod.rs"]
mod systems;

mod golden;
