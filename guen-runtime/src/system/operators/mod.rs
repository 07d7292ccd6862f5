//! Operators of displacement, their brackets, and the properties that are proved of them.

pub(crate) mod bracket;
pub(crate) mod classification;
pub(crate) mod frame;
pub(crate) mod operator;
