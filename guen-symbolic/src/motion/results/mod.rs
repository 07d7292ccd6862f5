//! Results beside the rates: energies and momenta, equations and reactions of bodies, and the rates of further states.

mod agreement;
pub(super) mod energy;
mod freed;
pub(super) mod outputs;
pub(super) mod state_rates;
