//! The facts about a scene that its documentation tells.

use guen_symbolic::ExprId;

use super::closure::{Quadrature, Reason};

/// The facts about a scene that its documentation tells beside its formulas.
pub struct SceneFacts {
    /// The index in the model.
    pub index: usize,
    /// The reason why each variable is kept, by its place in the whole state; none for those that left.
    pub reasons: Vec<Option<Reason>>,
    /// Variables that left and are pure quadratures, in layers: the rates of each depend on what is kept and on the layers
    /// before.
    pub quadratures: Vec<Vec<Quadrature>>,
    /// Coordinates that left and that holonomic equations say of what is kept, with what they say.
    pub determined: Vec<(usize, ExprId)>,
    /// Parameters that follow from what is kept, with what they are.
    pub followers: Vec<(String, ExprId)>,
    /// Coordinates that holonomic equations eliminated.
    pub eliminated: Vec<usize>,
    /// The constants that are fixed, by index, and their values.
    pub fixes: Vec<(usize, ExprId)>,
    /// Whether the right-hand side is a part of the whole system's, operation by operation.
    pub is_part: bool,
}
