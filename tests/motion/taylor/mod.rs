//! Taylor series: every recurrence against the equation that it solves, in 71 digits; the method against references.

#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

mod method;
mod recurrences;
mod unseen;
