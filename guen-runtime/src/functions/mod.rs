//! Functions that the program supplies: smooth scalar functions of scalars, with their derivatives.
//!
//! A declaration names them in `functions { ground(x, y); }`, and the generated struct has a field for each. Tables and grids
//! interpolate given values; a type of one's own implements [`Smooth`].

pub(crate) mod derivatives;
pub(crate) mod error;
pub(crate) mod grid;
pub(crate) mod hoisted;
pub(crate) mod in_lanes;
pub(crate) mod knots;
pub(crate) mod smooth;
pub(crate) mod table;
