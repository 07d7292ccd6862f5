//! Layouts: the sizes, names, fields and parameters of generated types, which all other items are written by.
//!
//! `fields` puts flat lists of values into fields, arrays and structs, `parts` those of instances into structs of their own; `layout` has all of a level together.

pub(super) mod fields;
pub(super) mod layout;
pub(super) mod parts;
pub(super) mod signatures;
pub(super) mod supplied;
pub(super) mod text;
