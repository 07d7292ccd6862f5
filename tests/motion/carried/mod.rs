//! Carried forms: the same motion without elementary calls.
#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

mod functions;
mod hoop;
