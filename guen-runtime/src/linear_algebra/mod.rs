//! Linear algebra on arrays of fixed size: factors of square matrices, and bases of subspaces with a stated tolerance.

pub(crate) mod dense;
pub(crate) mod lu;

pub(crate) use lu::Lu;
