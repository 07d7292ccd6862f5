//! Steppers and what drives them: accuracy, order, samples, events, guards.

mod clock;
mod driver;
mod extended;
mod integration;
mod judged;
mod motions;
mod orders;
mod simultaneous;
mod stiff;
