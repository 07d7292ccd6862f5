//! The end of a mode as exactly as the method computes it, and everything that ends it.

use super::run::Run;
use crate::hybrid::events::located::{Does, Found};
use crate::hybrid::events::watched::Function;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::hybrid::transitions::hybrid_state::{Fired, HybridState};
use crate::steppers::{Checkpoint, Method, Statistics, StepperRun};

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> Run<'_, H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// The time and state of what was found on the polynomial, computed once more by the method itself where the polynomial is less
    /// exact; where spatial slip ends, at its end. None if it does not happen there.
    pub(super) fn located<M>(
        &mut self,
        method: &M,
        in_mode: &InMode<H, N, W, C, S>,
        before: &Checkpoint<f64, N>,
        found: Found,
        state: [f64; N],
        polished: bool,
    ) -> Option<(f64, [f64; N])>
    where
        M: Method<f64, InMode<H, N, W, C, S>, N>,
    {
        /// Steps of Newton's method.
        const CORRECTIONS: u32 = 4;

        let (mut t, mut here) = (found.t, state);
        if polished && t > before.time {
            for _ in 0..CORRECTIONS {
                let Some(exact) = self.by_method(method, in_mode, before, t) else { break };
                here = exact;
                if found.does != Does::Falls {
                    break;
                }
                let watched = in_mode.watched_along(&self.place.sides, t, &here);
                let Some(value) = watched.get(found.function) else { break };
                // The polynomial was off: the function is positive there, and rises.
                if value.value >= 0.0 && value.tangent[0] > 0.0 {
                    return None;
                }
                let change = -value.value / value.tangent[0];
                // Not where the function hardly moves.
                if !(change.abs() <= 1e-3 * (t - before.time)) || change.abs() <= f64::EPSILON * t.abs() {
                    break;
                }
                t += change;
            }
        }
        Some(match found.function {
            Function::Slip(c) if H::ELEMENTS[c].tangential.len() == 2 => in_mode.stopped(c, t, &here),
            _ => (t, here),
        })
    }

    /// The state at a time by steps of the method from the beginning of a step.
    fn by_method<M>(
        &mut self,
        method: &M,
        in_mode: &InMode<H, N, W, C, S>,
        before: &Checkpoint<f64, N>,
        t: f64,
    ) -> Option<[f64; N]>
    where
        M: Method<f64, InMode<H, N, W, C, S>, N>,
    {
        let mut start = *before;
        start.statistics = Statistics::default();
        let mut run = method.start(&start);
        run.try_first(t - before.time);
        while run.checkpoint().time != t {
            let made = run.advance(in_mode, t, false);
            if made.is_err() {
                break;
            }
        }
        let Checkpoint { time, state, statistics, .. } = *run.checkpoint();
        self.work += statistics;
        (time == t).then_some(state)
    }

    /// All functions that reach zero where one was found, at a time known to `bracket`.
    pub(super) fn fired(&self, found: Found, bracket: f64) -> Fired<C, S> {
        /// The most brackets of a time by which it is taken to be off.
        const MOST_OFF: f64 = 64.0;

        let HybridState { t, state, in_mode, sides, .. } = &self.place;
        let watched = in_mode.watched_along(sides, *t, state);
        let mut fired = Fired::default();
        fired.add(found.function);
        // Where spatial slip ends its direction turns without bounds, and with it the reactions and their rates: they say nothing there.
        let ends_slip = matches!(found.function, Function::Slip(c) if H::ELEMENTS[c].tangential.len() == 2);
        // At the time that was found its function is not quite zero: the time is off by some brackets.
        let off = watched.get(found.function).map_or(0.0, |value| (value.value / value.tangent[0]).abs());
        let off = if off.is_finite() { off.min(MOST_OFF * bracket) } else { 0.0 };
        let bracket = if ends_slip { 0.0 } else { bracket.max(2.0 * off) };
        for function in Function::all(C, S).filter(|function| *function != found.function) {
            if ends_slip && function.is_of_reactions() {
                continue;
            }
            let Some(value) = watched.get(function) else { continue };
            if let Function::Gap(c) = function
                && !in_mode.mode.0[c].is_closed()
                && !(in_mode.system.conditions(*t, state, &in_mode.switches).when[c] > 0.0)
            {
                continue;
            }
            // A reset whose function has not left zero yet does not happen.
            if let Function::Signal(s) = function
                && !H::SIGNALS[s].is_switch()
                && sides.signals[s] == 0.0
            {
                continue;
            }
            if self.place.fires_too(function, value.value, value.tangent[0], bracket) {
                fired.add(function);
            }
        }
        fired
    }
}
