//! Carried forms: the same motion without elementary calls.

mod functions;
mod hoop;
