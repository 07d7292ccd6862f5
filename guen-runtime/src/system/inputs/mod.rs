//! Inputs: systems that take them, laws for them, and the systems that these make together.

pub(crate) mod actuated;
pub(crate) mod input_law;
pub(crate) mod input_values;
mod with_inputs;
