//! Counts, arrays, loops and sums: the same systems written out by hand and by loop.

mod chains;
mod entries;
mod long;
mod thousand;
mod vectors;
