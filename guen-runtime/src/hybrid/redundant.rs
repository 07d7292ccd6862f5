//! Modes whose reactions are not determined: which combinations of inequalities have to hold for some reactions to lie in all cones.

use core::array::from_fn;

use crate::hybrid::element::Kind;
use crate::hybrid::in_mode::{InMode, Reactions};
use crate::hybrid::mode::ElementState;
use crate::hybrid::system::HybridSystem;
use crate::numbers::lift::Lift;

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

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// The reactions that move nothing, one for each row that depends on others.
    fn idle<R: Lift<f64>>(&self, motion: &Reactions<R, N, W, C>) -> impl Iterator<Item = [R; W]> {
        let (matrix, _) = self.equations(&motion.free, &motion.directions);
        self.pivots.dependent().iter().map(move |&row| {
            let right = from_fn(|w| -matrix[w][row]);
            let (mut idle, _) = self.pivots.solve(matrix, right, &[R::one(); W]);
            idle[row] = R::one();
            self.add_friction(&mut idle, &motion.free.friction, &motion.directions, |_| R::zero());
            idle
        })
    }

    /// Whether the motion itself is not determined: some reactions that move nothing along the rows of the mode move the system all the
    /// same, by the friction of contacts that slip with different coefficients.
    pub(super) fn is_undetermined(&self, t: f64, state: &[f64; N]) -> bool {
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
        self.idle(&motion).any(|idle| {
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
        let mut least = *motion;
        if !self.is_redundant() {
            return least;
        }
        // One after the other, each made orthogonal to those before.
        let mut before = [[R::zero(); W]; W];
        for (k, mut idle) in self.idle(motion).enumerate() {
            let dot = |a: &[R; W], b: &[R; W]| a.iter().zip(b).fold(R::zero(), |sum, (a, b)| sum + *a * *b);
            let take = |from: &mut [R; W], along: &[R; W]| {
                let part = dot(from, along) / dot(along, along);
                for (entry, direction) in from.iter_mut().zip(along) {
                    *entry = entry.minus_times(part, *direction);
                }
            };
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
    pub(super) fn visit_shared<R: Lift<f64>>(
        &self,
        motion: &Reactions<R, N, W, C>,
        visit: &mut dyn FnMut(R),
    ) {
        let free = self.pivots.dependent().len();
        let mut idle = [[R::zero(); W]; MAX_FREE];
        let motion = if free > MAX_FREE {
            self.with_least_norm(motion)
        } else {
            for (place, vector) in idle.iter_mut().zip(self.idle(motion)) {
                *place = vector;
            }
            *motion
        };
        let inequalities: [[Option<Inequality<R>>; PER_ELEMENT]; C] =
            from_fn(|c| self.inequalities(c, &motion, &idle));
        let all = || inequalities.iter().flatten().flatten().enumerate();
        let size = |inequality: &Inequality<R>| {
            inequality.changes.iter().fold(0.0_f64, |most, change| most.max(change.to_f64().abs()))
        };
        let largest = all().fold(0.0_f64, |most, (_, inequality)| most.max(size(inequality)));
        let none = VANISHING * largest;
        let still = |inequality: &Inequality<R>| size(inequality) <= none;
        for (_, inequality) in all().filter(|(_, inequality)| still(inequality)) {
            visit(inequality.value);
        }
        let moving = || all().filter(|(_, inequality)| !still(inequality));
        let cross =
            |a: &Inequality<R>, b: &Inequality<R>| a.changes[0] * b.changes[1] - a.changes[1] * b.changes[0];
        for (i, a) in moving() {
            for (j, b) in moving().filter(|(j, _)| *j > i) {
                if free == 1 {
                    let (p, q) = (a.changes[0], b.changes[0]);
                    if p.to_f64() * q.to_f64() < 0.0 {
                        visit(a.value * q.abs() + b.value * p.abs());
                    }
                    continue;
                }
                let along = a.changes[0] * b.changes[0] + a.changes[1] * b.changes[1];
                if cross(a, b).to_f64().abs() <= none * largest && along.to_f64() < 0.0 {
                    let length = |x: &Inequality<R>| x.changes[0].abs() + x.changes[1].abs();
                    visit(a.value * length(b) + b.value * length(a));
                }
                for (_, c) in moving().filter(|(k, _)| *k > j) {
                    let parts = [cross(b, c), cross(c, a), cross(a, b)];
                    let signs = parts.map(|part| part.to_f64());
                    let nothing = none * largest;
                    if signs.iter().all(|part| part.abs() <= nothing) {
                        continue;
                    }
                    let sum = parts[0] * a.value + parts[1] * b.value + parts[2] * c.value;
                    if signs.iter().all(|part| *part >= -nothing) {
                        visit(sum);
                    } else if signs.iter().all(|part| *part <= nothing) {
                        visit(-sum);
                    }
                }
            }
        }
    }

    /// The inequalities of an element's reactions.
    fn inequalities<R: Lift<f64>>(
        &self,
        c: usize,
        motion: &Reactions<R, N, W, C>,
        idle: &[[R; W]; MAX_FREE],
    ) -> [Option<Inequality<R>>; PER_ELEMENT] {
        let (element, state) = (&H::ELEMENTS[c], self.mode.0[c]);
        if !state.is_closed() || element.kind == Kind::Latch {
            return [None; PER_ELEMENT];
        }
        let linear = |value: R, form: &dyn Fn(&[R; W]) -> R| {
            Some(Inequality { value, changes: from_fn(|k| form(&idle[k])) })
        };
        let normal = element.normal.and_then(|row| linear(motion.reactions[row], &|l| l[row]));
        if state != ElementState::Stick {
            return [normal, None, None];
        }
        let [plus, minus] = self.margins(c, motion);
        let &[row] = element.tangential else {
            // A spatial cone is not linear: it is judged where it is.
            return [normal, plus.and_then(|value| linear(value, &|_| R::zero())), None];
        };
        let limit = |l: &[R; W]| element.load.map_or(R::zero(), |load| motion.free.stiction[c] * l[load]);
        [
            normal,
            plus.and_then(|value| linear(value, &|l| limit(l) - l[row])),
            minus.and_then(|value| linear(value, &|l| limit(l) + l[row])),
        ]
    }
}
