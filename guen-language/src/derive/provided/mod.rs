//! Further forms of a level that a declaration provides: series, texts of C, the carried form; and functions that the program supplies.

pub(super) mod carried;
pub(super) mod series;
pub(super) mod source;
pub(super) mod supplied;
