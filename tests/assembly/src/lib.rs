//! Right-hand sides as functions that can be found in the assembly by their names.

#[macro_use]
#[path = "../../../workshop/guen-benchmarks/src/declarations.rs"]
mod declarations;

hoop!(guen::mechanical_system);
sled!(guen::mechanical_system);

/// The hoop's right-hand side, inlined.
#[unsafe(no_mangle)]
pub fn hoop_rates(system: &hoop::Prepared<f64>, state: &[f64; 9], rates: &mut [f64; 9]) {
    *rates = guen::System::rhs(system, 0.0, state);
}

/// The sled's right-hand side, inlined.
#[unsafe(no_mangle)]
pub fn sled_rates(system: &sled::Prepared<f64>, state: &[f64; 5], rates: &mut [f64; 5]) {
    *rates = guen::System::rhs(system, 0.0, state);
}

/// What the check has to find: a bounds check.
#[unsafe(no_mangle)]
pub fn spoiled_by_an_index(state: &[f64], i: usize, rates: &mut [f64; 5]) {
    rates[0] = state[i] * state[i + 1];
}

/// What the check has to find: a branch that nothing licenses.
#[unsafe(no_mangle)]
pub fn spoiled_by_a_branch(state: &[f64; 5], rates: &mut [f64; 5]) {
    if state[0] > 0.0 {
        *rates = state.map(|x| x + 1.0);
    }
}

/// What the check has to find: an allocation.
#[unsafe(no_mangle)]
pub fn spoiled_by_an_allocation(state: &[f64; 5]) -> Vec<f64> {
    state.to_vec()
}
