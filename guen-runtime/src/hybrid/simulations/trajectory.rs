//! Trajectories through modes: the motion at every time of its span, its modes and transitions.

use alloc::vec::Vec;
use core::fmt;

use super::kept::Log;
use crate::hybrid::interface::mode::Mode;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::Transition;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::numbers::real::Real;
use crate::steppers::{Dense, Interpolant, Statistics};

/// The motion of a system with contacts over a span of time: states and modes at any time of it, and the transitions.
///
/// `X` is the type of its states: a `State` with named fields, or an array. At a transition [`at`](Self::at) is the limit from later times, and
/// [`before`](Self::before) that from earlier ones.
pub struct HybridTrajectory<
    H,
    X,
    const N: usize,
    const W: usize,
    const C: usize,
    const S: usize,
    P = Dense<f64, N>,
> where
    H: HybridSystem<N, W, C, S>,
{
    pub(in crate::hybrid) log: Log<H, P, N, W, C, S>,
    start: (f64, X),
    end: (f64, X),
    pub(in crate::hybrid) transitions: Vec<Transition<H::Mode, N, W, C>>,
    work: Statistics,
    /// Whether a controller found inputs on the way.
    pub(in crate::hybrid) is_sampled: bool,
}

impl<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize> fmt::Debug
    for HybridTrajectory<H, X, N, W, C, S, P>
where
    H: HybridSystem<N, W, C, S>,
    X: fmt::Debug,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HybridTrajectory")
            .field("start", &self.start)
            .field("end", &self.end)
            .field("steps", &self.log.steps.len())
            .field("transitions", &self.transitions.len())
            .finish_non_exhaustive()
    }
}

impl<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize>
    HybridTrajectory<H, X, N, W, C, S, P>
where
    H: HybridSystem<N, W, C, S> + Clone,
    X: Copy + From<[f64; N]> + Into<[f64; N]>,
    P: Interpolant<f64, N>,
{
    pub(super) fn new(
        log: Log<H, P, N, W, C, S>,
        start: (f64, X),
        end: (f64, X),
        transitions: Vec<Transition<H::Mode, N, W, C>>,
        work: Statistics,
    ) -> Self {
        Self { log, start, end, transitions, work, is_sampled: false }
    }

    /// Notes whether a controller found inputs on the way.
    pub(super) fn sampled(self, is_sampled: bool) -> Self {
        Self { is_sampled, ..self }
    }

    /// The state at the beginning.
    pub fn start(&self) -> X {
        self.start.1
    }

    /// The time of the beginning.
    pub fn start_time(&self) -> f64 {
        self.start.0
    }

    /// The state at the end, from which a further run can go on.
    pub fn end(&self) -> X {
        self.end.1
    }

    /// The time of the end: that asked for, that at which a receiver of transitions stopped or, in an error, the last good one.
    pub fn end_time(&self) -> f64 {
        self.end.0
    }

    /// The transitions, in the order of time.
    pub fn transitions(&self) -> &[Transition<H::Mode, N, W, C>] {
        &self.transitions
    }

    /// The transitions in which an element took part, by the name of its declaration.
    pub fn transitions_of<'a>(
        &'a self,
        element: &'a str,
    ) -> impl Iterator<Item = &'a Transition<H::Mode, N, W, C>> + 'a {
        let place = H::ELEMENTS.iter().position(|candidate| candidate.name == element);
        self.transitions.iter().filter(move |transition| place.is_some_and(|c| transition.elements[c]))
    }

    /// The work done.
    pub fn work(&self) -> Statistics {
        self.work
    }

    /// The times of all steps, and the end: at a transition a step begins.
    pub fn times(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        self.log.steps.iter().map(|(start, _)| *start).filter(|start| *start < self.end.0).chain([self.end.0])
    }

    /// The state at time `t`; at a transition the one after it. A time outside of the span counts as the nearer end of it.
    pub fn at(&self, t: f64) -> X {
        if t >= self.end.0 {
            return self.end.1;
        }
        if t <= self.start.0 {
            return self
                .log
                .segments
                .iter()
                .rev()
                .find(|part| part.start <= t)
                .map_or(self.start.1, |part| part.state.into());
        }
        self.within(t, self.log.segments.partition_point(|part| part.start <= t))
    }

    /// The state at time `t`; at a transition the one before it.
    pub fn before(&self, t: f64) -> X {
        if t <= self.start.0 {
            return self.start.1;
        }
        let t = t.min(self.end.0);
        match self.transitions.iter().find(|transition| transition.t == t) {
            Some(transition) => transition.state_before.into(),
            None => self.within(t, self.log.segments.partition_point(|part| part.start < t)),
        }
    }

    /// The state in the segment before a position.
    fn within(&self, t: f64, place: usize) -> X {
        if t.is_nan() {
            return [t; N].into();
        }
        let Some(segment) = place.checked_sub(1).and_then(|place| self.log.segments.get(place)) else {
            return self.start.1;
        };
        let last = self.log.segments.get(place).map_or(self.log.steps.len(), |next| next.first);
        let steps = self.log.steps.get(segment.first..last).unwrap_or(&[]);
        let step = steps.partition_point(|(start, _)| *start <= t);
        match step.checked_sub(1).and_then(|step| steps.get(step)) {
            Some((start, polynomial)) if *start < t => {
                let state = polynomial.at(t);
                segment.in_mode.restored(t, &state).unwrap_or(state).into()
            }
            Some((start, polynomial)) => polynomial.at(*start).into(),
            None => segment.state.into(),
        }
    }

    /// The system in the mode at time `t`, with the inputs and switches that hold there; at a transition those after it.
    pub fn in_mode_at(&self, t: f64) -> Option<&InMode<H, N, W, C, S>> {
        let place = self.log.segments.partition_point(|part| part.start <= t).max(1);
        self.log.segments.get(place - 1).map(|part| &part.in_mode)
    }

    /// The mode at time `t`; at a transition the one after it.
    pub fn mode_at(&self, t: f64) -> H::Mode {
        self.in_mode_at(t).map_or(Mode::free(&H::ELEMENTS), InMode::mode).into()
    }

    /// The reactions along all rows at time `t`, those of least norm where they are not determined; at a transition those after it.
    pub fn reactions_at(&self, t: f64) -> [f64; W] {
        let Some(in_mode) = self.in_mode_at(t) else { return [f64::zero(); W] };
        let motion = in_mode.reactions(t, &self.at(t).into());
        in_mode.with_least_norm(&motion).reactions
    }

    /// The reactions along all rows just before time `t`, in the mode that ends there; none at the start.
    pub fn reactions_before(&self, t: f64) -> Option<[f64; W]> {
        let place = self.log.segments.partition_point(|part| part.start < t);
        let in_mode = &self.log.segments.get(place.checked_sub(1)?)?.in_mode;
        let motion = in_mode.reactions(t, &self.before(t).into());
        Some(in_mode.with_least_norm(&motion).reactions)
    }

    /// The states at multiples of `dt` after the start, and at the end. Of a duration that is not positive, start and end.
    pub fn sample(&self, dt: f64) -> impl Iterator<Item = (f64, X)> + '_ {
        let (start, end) = (self.start.0, self.end.0);
        let parts = (end - start) / dt;
        let whole = if parts.is_finite() && parts > 0.0 {
            libm::ceil(parts * (1.0 - 4.0 * f64::EPSILON))
        } else {
            1.0
        };
        let count = if end > start { whole as u64 } else { 0 };
        (0..count).map(move |k| start + k as f64 * dt).chain([end]).map(|t| (t, self.at(t)))
    }
}
