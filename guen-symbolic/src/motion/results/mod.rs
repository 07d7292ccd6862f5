//! Results beside the rates: energies and momenta, equations and reactions of bodies, and the rates of further states.

pub(super) mod energy;
mod freed;
pub(super) mod state_rates;
