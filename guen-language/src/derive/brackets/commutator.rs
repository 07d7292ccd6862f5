//! One bracket of two operators, as it is emitted and shown.

use guen_symbolic::ExprId;

/// A bracket `(X_r, X_s)`, `r < s`, that does not vanish identically.
pub struct Commutator {
    /// The first operator.
    pub r: usize,
    /// The second operator.
    pub s: usize,
    /// `C_rs1 .. C_rsn`.
    pub coefficients: Vec<ExprId>,
}
