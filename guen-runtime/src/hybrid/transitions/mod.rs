//! Transitions from one mode to the next, after an event.
//!
//! `turn` is the whole of one: `facts` gathers who touches, `resets` and impacts change the state, `signals` sets switches and branches anew, and `select` finds the mode that
//! follows. `resting` closes sequences of impacts early, `stopping` ends a spatial slip, `hybrid_state` is what a run knows between two steps.

mod facts;
pub(super) mod hybrid_state;
mod resets;
pub(super) mod resting;
mod select;
mod signals;
mod stopping;
mod turn;
