//! The linear forms of a system, (1.1) and (1.6): what comes in.

use crate::algebra::{ExprId, Graph};

/// A form `eta = sum_i a_i(t, x) x_i' + a_0(t, x)`.
#[derive(Clone, Debug)]
pub struct Form {
    /// The coefficients `a_1..a_n` of the velocities.
    pub row: Vec<ExprId>,
    /// The term `a_0` without velocity.
    pub offset: ExprId,
}

/// The `n` forms over their coordinates: first the parameters `eta_1..eta_l`, then the constraints.
#[derive(Clone, Debug)]
pub struct Forms {
    /// The symbol of time.
    pub time: ExprId,
    /// The symbols `x_1..x_n`.
    pub coordinates: Vec<ExprId>,
    /// The forms, parameters first.
    pub forms: Vec<Form>,
    /// The number `l` of parameters: the degrees of freedom.
    pub degrees: usize,
}

impl Forms {
    /// The number `n` of coordinates.
    pub fn len(&self) -> usize {
        self.coordinates.len()
    }

    /// Each form over the symbols of the velocities, with nothing in common.
    pub fn over(&self, graph: &mut Graph, velocities: &[ExprId]) -> Vec<ExprId> {
        let over = |form: &Form| {
            let mut terms = vec![form.offset];
            terms.extend(form.row.iter().zip(velocities).map(|(a, v)| graph.mul(*a, *v)));
            graph.sum(terms)
        };
        self.forms.iter().map(over).collect()
    }

    /// Whether there are no coordinates.
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// `a_tp` with `p = 0` for the time component `a_t0`.
    pub fn component(&self, t: usize, p: usize) -> ExprId {
        if p == 0 { self.forms[t].offset } else { self.forms[t].row[p - 1] }
    }

    /// The symbol of `x_p`, with `x_0 = t`.
    pub fn variable(&self, p: usize) -> ExprId {
        if p == 0 { self.time } else { self.coordinates[p - 1] }
    }

    /// Whether every constraint lacks its term `a_v0`: the constraints are catastatic.
    pub(crate) fn is_catastatic(&self, graph: &Graph) -> bool {
        self.forms[self.degrees..].iter().all(|form| graph.is_zero(form.offset))
    }
}
