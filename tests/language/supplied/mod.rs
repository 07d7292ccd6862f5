//! Functions that the program supplies: against declarations with the same functions written out, and against right-hand sides by hand.

mod by_hand;
mod everywhere;
mod in_components;
mod in_lanes;
mod written_out;
