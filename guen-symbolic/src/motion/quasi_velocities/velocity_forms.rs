//! Expressions affine in the velocities `x'` and the quasi-velocities `eta`, taken apart.

use crate::algebra::{ExprId, FastMap, Flow, Role, Roles, Substitution, gradient};
use crate::motion::Mechanics;
use crate::motion::thresholds::WRITTEN_OUT_PARAMETERS;
use crate::workbench::Workbench;

/// The kinds of symbol that stand for velocities.
pub(crate) const VELOCITIES: Roles = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity));

/// `u = sum_i b_i x_i' + sum_j c_j eta_j + u_0`; coefficients that vanish are left out.
#[derive(Clone, Debug)]
pub struct VelocityForm {
    /// `(i, b_i)`, `i` from 0.
    pub on_velocities: Vec<(usize, ExprId)>,
    /// `(j, c_j)`, `j` from 0.
    pub on_etas: Vec<(usize, ExprId)>,
    /// `u_0`.
    pub offset: ExprId,
}

/// Derivatives by every velocity symbol, each with its memory.
pub struct VelocityPartials {
    by_velocity: Vec<Flow>,
    by_eta: Vec<Flow>,
    symbols: Vec<ExprId>,
    at_rest: Substitution,
    known: FastMap<ExprId, Option<VelocityForm>>,
}

impl VelocityPartials {
    /// Collects the partial derivatives by the velocity symbols of a system.
    pub fn new(bench: &Workbench, velocities: &[ExprId], etas: &[ExprId]) -> Self {
        let partials =
            |symbols: &[ExprId]| symbols.iter().map(|symbol| Flow::partial(&bench.graph, *symbol)).collect();
        let zero = bench.graph.zero();
        VelocityPartials {
            by_velocity: partials(velocities),
            by_eta: partials(etas),
            symbols: [velocities, etas].concat(),
            at_rest: Substitution::new(velocities.iter().chain(etas).map(|symbol| (*symbol, zero))),
            known: FastMap::default(),
        }
    }

    /// Collects them for a declared system.
    pub fn of_system(bench: &Workbench, system: &Mechanics) -> Self {
        Self::new(bench, &system.velocities, &system.etas)
    }

    /// Takes an expression apart, or `None` if it is not affine, after algebra.
    pub fn affine(&mut self, bench: &mut Workbench, e: ExprId) -> Option<VelocityForm> {
        if let Some(known) = self.known.get(&e) {
            return known.clone();
        }
        let form = self.take_apart(bench, e);
        self.known.insert(e, form.clone());
        form
    }

    fn take_apart(&mut self, bench: &mut Workbench, e: ExprId) -> Option<VelocityForm> {
        let count = self.by_velocity.len();
        let (mut on_velocities, mut on_etas) = (Vec::new(), Vec::new());
        // Of many velocities few occur in a form: one pass back finds all slopes.
        let slopes = (count > WRITTEN_OUT_PARAMETERS).then(|| gradient(&mut bench.graph, e, &self.symbols));
        for index in 0..self.len() {
            let slope = match &slopes {
                Some(slopes) => slopes[index],
                None => self.by(bench, index, e),
            };
            if bench.graph.is_zero(slope) {
                continue;
            }
            let slope = self.velocity_free(bench, slope)?;
            if bench.graph.is_zero(slope) {
                continue;
            }
            if index < count {
                on_velocities.push((index, slope));
            } else {
                on_etas.push((index - count, slope));
            }
        }
        let offset = self.at_rest.of(&mut bench.graph, e);
        let offset = bench.tidy(offset);
        Some(VelocityForm { on_velocities, on_etas, offset })
    }

    /// The expression without the velocities that only seem to occur in it, or `None` if some do.
    fn velocity_free(&mut self, bench: &mut Workbench, e: ExprId) -> Option<ExprId> {
        if !bench.graph.roles(e).meets(VELOCITIES) {
            return Some(bench.tidy(e));
        }
        // At rest it has no velocities; the difference must vanish.
        let resting = self.at_rest.of(&mut bench.graph, e);
        let difference = bench.graph.sub(e, resting);
        bench.vanishes(difference).then(|| bench.tidy(resting))
    }

    /// The partial derivative by one velocity symbol: `x_i'` for `i < n`, then the `eta_j`.
    pub(crate) fn by(&mut self, bench: &mut Workbench, index: usize, e: ExprId) -> ExprId {
        let n = self.by_velocity.len();
        let flow = if index < n { &mut self.by_velocity[index] } else { &mut self.by_eta[index - n] };
        flow.of(&mut bench.graph, e)
    }

    /// The expression at rest: every velocity symbol zero.
    pub(crate) fn at_rest(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        self.at_rest.of(&mut bench.graph, e)
    }

    /// Number of velocity symbols of both kinds.
    pub(crate) fn len(&self) -> usize {
        self.by_velocity.len() + self.by_eta.len()
    }
}
