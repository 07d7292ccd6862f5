//! Steppers and what drives them: accuracy, order, samples, events, guards.

mod bounds_of_bounded;
mod clock;
mod driver;
mod extended;
mod hidden;
mod integration;
mod judged;
mod motions;
mod orders;
mod simultaneous;
mod stiff;
