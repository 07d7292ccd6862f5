//! Steppers and what drives them: accuracy, order, samples, events, guards.

mod bounds_of_bounded;
mod driver;
mod failed_ends;
mod guarded_steps;
mod integration;
mod late_starts;
mod long_states;
mod motions;
mod narrow_features;
mod orders;
mod other_reals;
mod simultaneous;
mod stiff;
mod switches;
#[path = "../numbers/wrapper.rs"]
mod wrapper;
