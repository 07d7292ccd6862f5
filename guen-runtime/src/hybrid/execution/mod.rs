//! The execution of a run: `driver` is what its user sets up, `run` the loop of steps and transitions, `polished` makes the end of a mode exact, `held` has inputs at equal
//! intervals.

pub(super) mod driver;
mod held;
mod polished;
mod run;
