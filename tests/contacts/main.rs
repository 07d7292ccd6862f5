//! Declarations with contacts: what is generated for them, against independent calculations.

mod components;
mod conditions;
mod declared;
mod directions;
mod drawn;
mod ensembles;
mod free_motion;
mod in_mode;
#[path = "../../guen-runtime/tests/hybrid/json.rs"]
mod json;
mod laws;
mod one_mode;
mod one_mode_that_slips;
mod permanent;
mod permanent_loads;
mod piecewise;
mod printed;
mod reference;
mod resets;
mod resets_in_scenes;
mod seen;
mod several_modes;
mod simulated;
mod slow_slips;
mod states;
mod unaware;
