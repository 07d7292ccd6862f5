//! Linear algebra on arrays of fixed size: factors and eigenvalues of square matrices, and bases of subspaces with a stated
//! tolerance.

pub(crate) mod dense;
pub(crate) mod eigenvalues;
pub(crate) mod lu;

pub(crate) use eigenvalues::eigenvalues;
pub(crate) use lu::Lu;
