//! The loop of a run through modes: steps within a mode, its end, the transition, and so on.

use super::driver::{Hybrid, HybridResult};
use crate::hybrid::events::located::{Does, Found, Step};
use crate::hybrid::events::watched::{Function, Sides};
use crate::hybrid::interface::error::{HybridCause, HybridError};
use crate::hybrid::interface::mode::Mode;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::{Facts, Transition, TransitionKind};
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::hybrid::transitions::hybrid_state::{Fired, HybridState};
use crate::hybrid::transitions::resting::Resting;
use crate::steppers::guard::part::{Failed, PartWatch};
use crate::steppers::{Cause, Checkpoint, Interpolant, Method, Setting, Statistics, StepperRun};

/// Transitions between the same two modes, one after the other.
#[derive(Clone, Copy)]
struct Pair<const C: usize> {
    modes: [Mode<C>; 2],
    count: u32,
    since: f64,
}

/// A run on its way.
pub(super) struct Run<'a, H, const N: usize, const W: usize, const C: usize, const S: usize>
where
    H: HybridSystem<N, W, C, S>,
{
    pub(super) hybrid: Hybrid<'a, H, N, W, C, S>,
    pub(super) place: HybridState<H, N, W, C, S>,
    pub(super) resting: Resting<C>,
    pub(super) visited: usize,
    pub(super) switched: usize,
    pub(super) transitions: u64,
    pub(super) work: Statistics,
    /// The size of the last step, and of the longest one.
    pub(super) step: Option<f64>,
    longest: f64,
    pair: Pair<C>,
}

/// Is told of every mode that begins, with its time and state.
pub(super) type Witness<'a, H, const N: usize, const W: usize, const C: usize, const S: usize> =
    &'a mut dyn FnMut(f64, &[f64; N], &InMode<H, N, W, C, S>) -> Result<(), Cause>;

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> Hybrid<'_, H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// Runs to a time, which is not before the start.
    ///
    /// # Errors
    ///
    /// [`HybridError`]: the cause that ended the run, with the last valid time, state and mode.
    pub fn run<M>(self, method: &M, end: f64) -> Result<HybridResult<H::Mode, N>, HybridError<N, C>>
    where
        M: Method<f64, InMode<H, N, W, C, S>, N>,
    {
        self.witnessed(method, end, &mut |_, _, _| Ok(()))
    }

    /// Runs to a time, and tells a witness of every mode that begins.
    pub(in crate::hybrid) fn witnessed<M>(
        self,
        method: &M,
        end: f64,
        witness: Witness<'_, H, N, W, C, S>,
    ) -> Result<HybridResult<H::Mode, N>, HybridError<N, C>>
    where
        M: Method<f64, InMode<H, N, W, C, S>, N>,
    {
        let mode = Mode::free(&H::ELEMENTS);
        let fail = |cause| HybridError {
            t: self.t,
            mode,
            state: self.state,
            cause: HybridCause::Integration(cause),
            work: Statistics::default(),
        };
        if !self.t.is_finite() || !end.is_finite() {
            return Err(fail(Cause::Setting(Setting::Time)));
        }
        if end < self.t {
            return Err(fail(Cause::Setting(Setting::Backwards)));
        }
        let inputs = self.inputs.iter().map(|(time, _)| *time);
        let is_late = self.samples.last().is_some_and(|sample| *sample > end);
        if is_late || !in_order(self.t, self.samples.iter().copied()) || !in_order(self.t, inputs) {
            return Err(fail(Cause::Setting(Setting::Samples)));
        }
        if !(self.resting_accuracy >= 0.0 && self.resting_accuracy.is_finite()) {
            return Err(fail(Cause::Setting(Setting::Accuracy)));
        }
        if let Some(sampler) = &self.sampler {
            sampler.check((self.t, end)).map_err(fail)?;
        }
        if !self.state.iter().all(|entry| entry.is_finite()) {
            return Err(fail(Cause::NotFinite));
        }
        let state = self.system.onto_constraints(self.t, &self.state);
        let state = state.map_err(|error| fail(Cause::of_positions(error)))?;
        let in_mode = InMode::new(self.system.clone(), mode, self.t, &state);
        let signals = in_mode.switches.map(|value| 2.0 * value - 1.0);
        let sides = Sides { latches: [1.0; C], signals, slow: [0.0; C] };
        let place = HybridState { t: self.t, state, in_mode, sides, begins: true };
        let resting = Resting::new(self.resting_accuracy);
        let run = Run {
            place,
            resting,
            hybrid: self,
            visited: 0,
            switched: 0,
            transitions: 0,
            work: Statistics::default(),
            step: None,
            longest: 0.0,
            pair: Pair { modes: [mode; 2], count: 0, since: f64::NEG_INFINITY },
        };
        run.to(method, end, witness)
    }
}

/// Whether times follow each other from a first one on.
fn in_order(first: f64, mut times: impl Iterator<Item = f64>) -> bool {
    times.try_fold(first, |last, time| (time >= last && time.is_finite()).then_some(time)).is_some()
}

/// The end of a part of a run.
enum Part<const C: usize, const S: usize> {
    Arrived,
    Fired(Fired<C, S>),
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> Run<'_, H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// Runs to a time.
    pub(super) fn to<M>(
        mut self,
        method: &M,
        end: f64,
        witness: Witness<'_, H, N, W, C, S>,
    ) -> Result<HybridResult<H::Mode, N>, HybridError<N, C>>
    where
        M: Method<f64, InMode<H, N, W, C, S>, N>,
    {
        let mut due = Some(Fired::default());
        loop {
            let mut switched = false;
            while let Some(&(time, inputs)) = self.hybrid.inputs.get(self.switched)
                && time <= self.place.t
            {
                self.place.in_mode.system = self.place.in_mode.system.with_inputs(inputs);
                self.switched += 1;
                switched = true;
            }
            switched |= self.sample(end);
            if switched {
                due.get_or_insert_with(Fired::default);
            }
            if let Some(fired) = due {
                let stops = self.turn(&fired, switched, end)?;
                let HybridState { t, state, in_mode, .. } = &self.place;
                let kept = witness(*t, state, in_mode);
                kept.map_err(|cause| self.failed(HybridCause::Integration(cause)))?;
                if stops {
                    return Ok(self.result(true));
                }
            }
            self.visit_until(self.place.t, true);
            if self.place.t >= end {
                return Ok(self.result(false));
            }
            let next = self.hybrid.inputs.get(self.switched).map_or(end, |(time, _)| time.min(end));
            let sampled = self.hybrid.sampler.as_ref().and_then(|sampler| sampler.next((self.hybrid.t, end)));
            let next = sampled.map_or(next, |time| time.min(next));
            due = match self.part(method, next).map_err(|cause| self.failed(cause))? {
                Part::Arrived => None,
                Part::Fired(fired) => Some(fired),
            };
        }
    }

    /// Holds the inputs that the controller finds here, where it is its time. Says whether it is.
    fn sample(&mut self, end: f64) -> bool {
        let Some(sampler) = &mut self.hybrid.sampler else { return false };
        let is_due = sampler.next((self.hybrid.t, end)).is_some_and(|time| time <= self.place.t);
        if is_due {
            let inputs = sampler.sample(self.place.t, &self.place.state);
            self.place.in_mode.system = self.place.in_mode.system.with_inputs(inputs);
        }
        is_due
    }

    fn result(&self, stopped: bool) -> HybridResult<H::Mode, N> {
        let HybridState { t, state, in_mode, .. } = &self.place;
        let (transitions, work) = (self.transitions, self.work);
        HybridResult { t: *t, state: *state, mode: in_mode.mode.into(), stopped, transitions, work }
    }

    fn failed(&self, cause: HybridCause<C>) -> HybridError<N, C> {
        let HybridState { t, state, in_mode, .. } = &self.place;
        let cause = match cause {
            // Steps become too small where a reaction grows beyond all bounds.
            HybridCause::Integration(Cause::StepUnderflow | Cause::NotFinite) if self.place.jams() => {
                self.place.painleve()
            }
            cause => cause,
        };
        HybridError { t: *t, mode: in_mode.mode, state: *state, cause, work: self.work }
    }

    /// Goes over to the next mode, and tells of it. Says whether the receiver ends the run.
    fn turn(&mut self, fired: &Fired<C, S>, inputs: bool, end: f64) -> Result<bool, HybridError<N, C>> {
        let begins = self.place.begins;
        let mut resting = self.resting.within(self.step.unwrap_or(0.0));
        let turned = self.place.turn(fired, inputs, &mut resting).map_err(|cause| self.failed(cause))?;
        let (next, mut transition) = turned;
        transition.facts.inputs = inputs;
        self.resting = resting;
        let changes = transition.before != transition.after || transition.impulses != [0.0; W];
        let happened = fired.any() || !begins && changes;
        if begins && transition.impulses == [0.0; W] {
            self.place = next;
            return Ok(false);
        }
        if !matches!(
            transition.kind,
            TransitionKind::Impact | TransitionKind::Rest { .. } | TransitionKind::Touch
        ) {
            // Contacts that take turns open and close on the way.
            if !matches!(
                transition.kind,
                TransitionKind::Lifted | TransitionKind::Slips | TransitionKind::Sticks
            ) {
                self.resting.interrupt();
            }
        }
        let before = core::mem::replace(&mut self.place, next);
        if !happened && !changes {
            return Ok(false);
        }
        self.transitions += 1;
        if self.transitions > self.hybrid.max_transitions {
            let limit = self.hybrid.max_transitions;
            return Err(self.failed(HybridCause::TooManyTransitions { limit }));
        }
        self.chatters(&transition, end).map_err(|cause| self.failed(cause))?;
        Ok(self.tell(&transition, Some(&before.in_mode)))
    }

    /// Tells of a transition, with the system in the mode that it ends.
    fn tell(
        &mut self,
        transition: &Transition<Mode<C>, N, W, C>,
        ended: Option<&InMode<H, N, W, C, S>>,
    ) -> bool {
        if self.hybrid.receiver.is_none() && self.hybrid.between.is_none() {
            return false;
        }
        let Transition {
            t,
            kind,
            elements,
            signal,
            before,
            after,
            state_before,
            state_after,
            impulses,
            energy,
            facts,
        } = *transition;
        let (before, after) = (before.into(), after.into());
        let told = Transition {
            t,
            kind,
            elements,
            signal,
            before,
            after,
            state_before,
            state_after,
            impulses,
            energy,
            facts,
        };
        let mut breaks = false;
        if let Some(receiver) = &mut self.hybrid.receiver {
            breaks |= receiver(&told).is_break();
        }
        if let (Some(receiver), Some(ended)) = (&mut self.hybrid.between, ended) {
            breaks |= receiver(&told, ended, &self.place.in_mode).is_break();
        }
        breaks
    }

    /// Refuses transitions between the same two modes that hardly move time.
    fn chatters(
        &mut self,
        transition: &Transition<Mode<C>, N, W, C>,
        end: f64,
    ) -> Result<(), HybridCause<C>> {
        /// Transitions, and the part of the longest step, or of the span of the run if that is shorter, within which they are too many.
        const TRANSITIONS: u32 = 50;
        const SPAN: f64 = 1e-9;

        let (a, b) = (transition.before, transition.after);
        let same = self.pair.modes == [a, b] || self.pair.modes == [b, a];
        let within = SPAN * (end - self.hybrid.t).min(self.longest);
        if !same || transition.t - self.pair.since > within {
            self.pair = Pair { modes: [a, b], count: 0, since: transition.t };
        }
        self.pair.count += 1;
        if self.pair.count > TRANSITIONS {
            let span = transition.t - self.pair.since;
            return Err(HybridCause::Chattering { count: self.pair.count, span });
        }
        Ok(())
    }

    /// Shows the samples before a time, or up to it, which are those of the present place.
    fn visit_until(&mut self, time: f64, including: bool) {
        while let Some(&sample) = self.hybrid.samples.get(self.visited)
            && (sample < time || including && sample == time)
        {
            let state = self.place.state;
            self.show(sample, &state);
        }
    }

    fn show(&mut self, time: f64, state: &[f64; N]) {
        let mode = self.place.in_mode.mode.into();
        if let Some(visitor) = &mut self.hybrid.visitor {
            visitor(self.visited, time, state, &mode);
        }
        self.visited += 1;
    }

    /// Goes on in the present mode until it ends, or to a time.
    fn part<M>(&mut self, method: &M, target: f64) -> Result<Part<C, S>, HybridCause<C>>
    where
        M: Method<f64, InMode<H, N, W, C, S>, N>,
    {
        /// The part of a step after which a place is looked for that was found twice and was none.
        const PART: f64 = 1.0 / 256.0;
        /// The part of a step that a flight takes at least, which ends where its polynomial says.
        const SHORTEST_FLIGHT: f64 = 1e-13;

        let state = self.place.state;
        self.slow_down(&state);
        let in_mode = self.place.in_mode.clone();
        let mut checkpoint = Checkpoint::new(self.place.t, &self.place.state);
        checkpoint.statistics = self.work;
        let watch = PartWatch::new::<_, M>(self.hybrid.guard, &in_mode, &checkpoint);
        let mut watch = watch.map_err(HybridCause::Integration)?;
        let mut run = method.start(&checkpoint);
        if let Some(step) = self.step {
            run.try_first(step);
        }
        let mut first = true;
        loop {
            let before = *run.checkpoint();
            if before.time == target {
                return Ok(Part::Arrived);
            }
            let made = run.advance(&in_mode, target, true);
            self.work = run.checkpoint().statistics;
            made.map_err(|cause| self.back_to(watch.stopped(&in_mode, run.checkpoint(), cause)))?;
            let polynomial = run.dense(&in_mode);
            let after = *run.checkpoint();
            self.longest = self.longest.max(after.time - before.time);
            self.work = after.statistics;
            let at = |t: f64| {
                if t == after.time {
                    after.state
                } else if t == before.time {
                    before.state
                } else {
                    polynomial.at(t)
                }
            };
            let mut from = before.time;
            let stop = in_mode.stop_within(&self.place.sides.slow, &before, at, &after);
            loop {
                let sides = self.place.sides;
                let mut state_at = at;
                let mut step = Step {
                    in_mode: &in_mode,
                    sides: &sides,
                    start: before.time,
                    end: after.time,
                    from,
                    first,
                    at: &mut state_at,
                };
                let found = step.first();
                if let Some((c, t, state)) = stop
                    && found.is_none_or(|found| t <= found.t)
                {
                    self.samples_before(&in_mode, t, &at);
                    watch.finish(&in_mode, t, &state).map_err(|failed| self.back_to(failed))?;
                    self.step = Some(after.time - before.time);
                    (self.place.t, self.place.state) = (t, state);
                    let found = Found { function: Function::Slip(c), t, does: Does::Falls };
                    return Ok(Part::Fired(self.fired(found, 4.0 * f64::EPSILON * t.abs())));
                }
                let Some(found) = found else { break };
                if let (Does::IsBelow(gap), Some(c)) = (found.does, found.function.element()) {
                    return Err(HybridCause::Penetrating { contact: H::ELEMENTS[c].name, gap });
                }
                if found.does == Does::IsNoNumber {
                    self.samples_before(&in_mode, found.t, &at);
                    (self.place.t, self.place.state) = (found.t, at(found.t));
                    return Err(HybridCause::NoNumber { function: found.function.name::<H, N, W, C, S>() });
                }
                let polished = M::Run::COARSE_POLYNOMIAL;
                let located = self.located(method, &in_mode, &before, found, at(found.t), polished);
                // The end of a flight that is shorter than the polynomial tells.
                let is_flight = first && matches!(found.function, Function::Gap(_)) && from == before.time;
                let is_short = found.t - before.time <= SHORTEST_FLIGHT * (after.time - before.time);
                let located = located.or((is_flight && is_short).then_some((before.time, before.state)));
                let Some((t, state)) = located else {
                    // Where the same place is found again, the search goes on behind it.
                    let behind = from + PART * (after.time - before.time);
                    from = if found.t == from { behind } else { found.t };
                    if (after.time - from) * (after.time - before.time) <= 0.0 {
                        break;
                    }
                    continue;
                };
                self.samples_before(&in_mode, t, &at);
                if found.does == Does::Touches {
                    self.touched(found, t, &state);
                    from = found.t;
                    continue;
                }
                watch.finish(&in_mode, t, &state).map_err(|failed| self.back_to(failed))?;
                self.step = Some(after.time - before.time);
                (self.place.t, self.place.state) = (t, state);
                self.place.arm_resets_until((before.time, t), first, &at);
                let bracket = (t - found.t).abs() + 4.0 * f64::EPSILON * t.abs();
                let mut fired = self.fired(found, bracket);
                if first && t == before.time {
                    fired.add_at_beginning(found.function);
                }
                return Ok(Part::Fired(fired));
            }
            first = false;
            watch.step(&in_mode, &run, &before).map_err(|failed| self.back_to(failed))?;
            if after.time == target {
                watch.finish(&in_mode, after.time, &after.state).map_err(|failed| self.back_to(failed))?;
            }
            self.samples_before(&in_mode, after.time, &at);
            (self.place.t, self.place.state) = (after.time, after.state);
            self.place.arm_resets();
            self.slow_down(&after.state);
        }
    }

    /// Goes back to the last time and state at which a guard found no fault.
    fn back_to(&mut self, failed: Failed<N>) -> HybridCause<C> {
        (self.place.t, self.place.state) = (failed.time, failed.state);
        HybridCause::Integration(failed.cause)
    }

    /// Shows the samples of the last step before a time.
    fn samples_before(&mut self, in_mode: &InMode<H, N, W, C, S>, time: f64, at: &dyn Fn(f64) -> [f64; N]) {
        while let Some(&sample) = self.hybrid.samples.get(self.visited)
            && sample < time
        {
            let state = at(sample);
            let state = in_mode.restored(sample, &state).unwrap_or(state);
            self.show(sample, &state);
        }
    }

    /// Tells of a gap that touches zero.
    fn touched(&mut self, found: Found, t: f64, state: &[f64; N]) {
        let mode = self.place.in_mode.mode;
        let mut elements = [false; C];
        if let Some(c) = found.function.element() {
            elements[c] = true;
        }
        let transition = Transition {
            t,
            kind: TransitionKind::Touch,
            elements,
            signal: None,
            before: mode,
            after: mode,
            state_before: *state,
            state_after: *state,
            impulses: [0.0; W],
            energy: 0.0,
            facts: Facts::none(),
        };
        self.transitions += 1;
        self.tell(&transition, None);
    }

    /// Updates the speeds of spatial slip that count as slow.
    fn slow_down(&mut self, state: &[f64; N]) {
        /// The part of the largest slip of a mode at which it is taken to its end.
        const SLOW: f64 = 1e-5;
        /// The number of times by which a slip from rest is faster than the speed below which its direction is held, when it has begun.
        const BEGUN: f64 = 1e4;

        if !H::ELEMENTS.iter().any(|element| element.tangential.len() == 2) {
            return;
        }
        let rates = self.place.in_mode.system.row_rates(self.place.t, state);
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            if let &[first, second] = element.tangential
                && self.place.in_mode.mode.0[c].slips()
            {
                let slip = libm::hypot(rates[first], rates[second]);
                if BEGUN * self.place.in_mode.leaning[c].speed > slip {
                    continue;
                }
                self.place.sides.slow[c] = f64::max(self.place.sides.slow[c], SLOW * slip);
            }
        }
    }
}
