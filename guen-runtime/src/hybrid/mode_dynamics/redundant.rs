//! Modes whose reactions are not determined: which combinations of inequalities have to hold for some reactions to lie in all cones.

use super::in_mode::InMode;
use super::mode_rows::ModeRows;
use crate::hybrid::interface::element::Kind;
use crate::hybrid::interface::mode::ElementState;
use crate::hybrid::interface::reactions::Reactions;
use crate::hybrid::interface::system::HybridSystem;
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;

/// Reactions that move nothing which are combined exactly: with more of them the reactions of least norm are judged alone.
const MAX_FREE: usize = 2;
/// Inequalities of an element: the normal reaction and two margins of its cone.
const PER_ELEMENT: usize = 3;
/// The part of the largest coefficient below which one vanishes.
const VANISHING: f64 = 1e-10;

/// An inequality that is linear in the reactions: its value at some reactions, and its changes along those that move nothing.
#[derive(Clone, Copy, Debug)]
struct Inequality<R> {
    value: R,
    changes: [R; MAX_FREE],
}

impl<R: Real> Inequality<R> {
    /// The largest change.
    fn size(&self) -> f64 {
        let mut most = 0.0_f64;
        for change in self.changes {
            most = most.max(change.to_f64().abs());
        }
        most
    }

    /// The length of the changes, by the sum of their magnitudes.
    fn length(&self) -> R {
        self.changes[0].abs() + self.changes[1].abs()
    }

    fn cross(&self, other: &Self) -> R {
        self.changes[0] * other.changes[1] - self.changes[1] * other.changes[0]
    }
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// Whether the motion itself is not determined: some reactions that move nothing along the rows of the mode move the system all the
    /// same, by the friction of contacts that slip with different coefficients.
    pub(in crate::hybrid) fn is_undetermined(&self, t: f64, state: &[f64; N]) -> bool {
        /// The part of what idle reactions do one by one below which they do nothing together: rows that depend on each other to `1e-10` of
        /// the Delassus matrix do so to its root.
        const NOTHING: f64 = 1e-4;

        let slips = |c: usize| self.mode.0[c].slips() && H::ELEMENTS[c].load.is_some();
        let is_loaded = H::ELEMENTS.iter().any(|element| element.loaded_by_constraint);
        if !self.is_redundant() || !((0..C).any(slips) || is_loaded) {
            return false;
        }
        let motion = self.reactions(t, state);
        let loads = is_loaded.then(|| self.system.loads(t, state, &self.lifted_switches(t, state)));
        let rows = self.rows();
        let (matrix, _) = rows.equations(&motion.free, &motion.directions);
        self.pivots.dependent().iter().any(|&row| {
            let idle = rows.idle(&motion, &matrix, row);
            // The load of a grip has to be one number.
            let responses = loads.iter().flat_map(|loads| &loads.responses);
            let mut changes = responses.map(|responses| {
                let parts = || idle.iter().zip(responses).map(|(l, response)| l * response);
                (parts().sum::<f64>(), parts().map(f64::abs).sum::<f64>())
            });
            if changes.any(|(sum, size)| sum.abs() > NOTHING * size) {
                return true;
            }
            (0..N).any(|i| {
                let parts = || idle.iter().zip(&motion.free.responses).map(|(l, response)| l * response[i]);
                let (sum, size): (f64, f64) = (parts().sum(), parts().map(f64::abs).sum());
                sum.abs() > NOTHING * size
            })
        })
    }

    /// The reactions of least norm among those with the same motion: the same where they are determined.
    #[must_use]
    pub fn with_least_norm<R: Lift<f64>>(&self, motion: &Reactions<R, N, W, C>) -> Reactions<R, N, W, C> {
        self.rows().with_least_norm(motion)
    }
}

impl<const W: usize, const C: usize> ModeRows<'_, W, C> {
    /// The reactions that move nothing, one along this row, which depends on others; `matrix` is that of the equations.
    fn idle<R: Lift<f64>, const N: usize>(
        &self,
        motion: &Reactions<R, N, W, C>,
        matrix: &[[R; W]; W],
        row: usize,
    ) -> [R; W] {
        let mut right = [R::zero(); W];
        for (place, entries) in right.iter_mut().zip(matrix) {
            *place = -entries[row];
        }
        let (mut idle, _) = self.pivots.solve(*matrix, right, &[R::one(); W]);
        idle[row] = R::one();
        self.add_friction(&mut idle, &motion.free.friction, &motion.directions, &[R::zero(); C]);
        idle
    }

    /// The reactions of least norm among those with the same motion.
    fn with_least_norm<R: Lift<f64>, const N: usize>(
        &self,
        motion: &Reactions<R, N, W, C>,
    ) -> Reactions<R, N, W, C> {
        let mut least = *motion;
        if !self.pivots.is_redundant() {
            return least;
        }
        let (matrix, _) = self.equations(&motion.free, &motion.directions);
        // One after the other, each made orthogonal to those before.
        let mut before = [[R::zero(); W]; W];
        for (k, &row) in self.pivots.dependent().iter().enumerate() {
            let mut idle = self.idle(motion, &matrix, row);
            for earlier in &before[..k] {
                take(&mut idle, earlier);
            }
            take(&mut least.reactions, &idle);
            before[k] = idle;
        }
        least
    }

    /// Visits functions all of which are nonnegative exactly if some reactions with the same motion lie in all cones: the
    /// combinations of inequalities, with nonnegative coefficients, that no reaction without an effect changes.
    pub(in crate::hybrid) fn visit_shared<R: Lift<f64>, const N: usize>(
        &self,
        motion: &Reactions<R, N, W, C>,
        visit: &mut dyn FnMut(R),
    ) {
        let free = self.pivots.dependent().len();
        let mut idle = [[R::zero(); W]; MAX_FREE];
        let mut motion = *motion;
        if free > MAX_FREE {
            motion = self.with_least_norm(&motion);
        } else {
            let (matrix, _) = self.equations(&motion.free, &motion.directions);
            for (place, &row) in idle.iter_mut().zip(self.pivots.dependent()) {
                *place = self.idle(&motion, &matrix, row);
            }
        }
        let none = Inequality { value: R::zero(), changes: [R::zero(); MAX_FREE] };
        let mut listed = [[none; PER_ELEMENT]; C];
        let mut count = 0;
        for c in 0..C {
            for inequality in self.inequalities(c, &motion, &idle).into_iter().flatten() {
                listed.as_flattened_mut()[count] = inequality;
                count += 1;
            }
        }
        visit_combined(&listed.as_flattened()[..count], free, visit);
    }

    /// The inequalities of an element's reactions.
    fn inequalities<R: Lift<f64>, const N: usize>(
        &self,
        c: usize,
        motion: &Reactions<R, N, W, C>,
        idle: &[[R; W]; MAX_FREE],
    ) -> [Option<Inequality<R>>; PER_ELEMENT] {
        let (element, state) = (&self.elements[c], self.mode.0[c]);
        let mut found = [None; PER_ELEMENT];
        if !state.is_closed() || element.kind == Kind::Latch {
            return found;
        }
        if let Some(row) = element.normal {
            let changes = [idle[0][row], idle[1][row]];
            found[0] = Some(Inequality { value: motion.reactions[row], changes });
        }
        if state != ElementState::Stick {
            return found;
        }
        let [plus, minus] = self.margins(c, motion);
        let &[row] = element.tangential else {
            // A spatial cone is not linear: it is judged where it is.
            found[1] = plus.map(|value| Inequality { value, changes: [R::zero(); MAX_FREE] });
            return found;
        };
        let (mut above, mut below) = ([R::zero(); MAX_FREE], [R::zero(); MAX_FREE]);
        for (k, idle) in idle.iter().enumerate() {
            let limit = match element.load {
                Some(load) => motion.free.stiction[c] * idle[load],
                None => R::zero(),
            };
            (above[k], below[k]) = (limit - idle[row], limit + idle[row]);
        }
        found[1] = plus.map(|value| Inequality { value, changes: above });
        found[2] = minus.map(|value| Inequality { value, changes: below });
        found
    }
}

/// Takes from a vector its part along another one.
fn take<R: Real, const W: usize>(from: &mut [R; W], along: &[R; W]) {
    let part = dot(from, along) / dot(along, along);
    for (entry, direction) in from.iter_mut().zip(along) {
        *entry = entry.minus_times(part, *direction);
    }
}

fn dot<R: Real, const W: usize>(a: &[R; W], b: &[R; W]) -> R {
    let mut sum = R::zero();
    for (a, b) in a.iter().zip(b) {
        sum += *a * *b;
    }
    sum
}

/// Visits the combinations of inequalities that `free` independent reactions without an effect leave as they are.
fn visit_combined<R: Real>(all: &[Inequality<R>], free: usize, visit: &mut dyn FnMut(R)) {
    let mut largest = 0.0_f64;
    for inequality in all {
        largest = largest.max(inequality.size());
    }
    let none = VANISHING * largest;
    for inequality in all {
        if inequality.size() <= none {
            visit(inequality.value);
        }
    }
    let nothing = none * largest;
    for (i, a) in all.iter().enumerate() {
        if a.size() <= none {
            continue;
        }
        for (j, b) in all.iter().enumerate().skip(i + 1) {
            if b.size() <= none {
                continue;
            }
            if free == 1 {
                let (p, q) = (a.changes[0], b.changes[0]);
                if p.to_f64() * q.to_f64() < 0.0 {
                    visit(a.value * q.abs() + b.value * p.abs());
                }
                continue;
            }
            let along = a.changes[0] * b.changes[0] + a.changes[1] * b.changes[1];
            if a.cross(b).to_f64().abs() <= nothing && along.to_f64() < 0.0 {
                visit(a.value * b.length() + b.value * a.length());
            }
            for c in &all[j + 1..] {
                if c.size() > none {
                    visit_triple([a, b, c], nothing, visit);
                }
            }
        }
    }
}

/// Visits the combination of three inequalities that two reactions without an effect leave as it is, if its coefficients have one sign.
fn visit_triple<R: Real>([a, b, c]: [&Inequality<R>; 3], nothing: f64, visit: &mut dyn FnMut(R)) {
    let parts = [b.cross(c), c.cross(a), a.cross(b)];
    let signs = parts.map(Real::to_f64);
    if signs.iter().all(|part| part.abs() <= nothing) {
        return;
    }
    let sum = parts[0] * a.value + parts[1] * b.value + parts[2] * c.value;
    if signs.iter().all(|part| *part >= -nothing) {
        visit(sum);
    } else if signs.iter().all(|part| *part <= nothing) {
        visit(-sum);
    }
}
