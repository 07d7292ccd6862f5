//! The values of switches and branches where the state has jumped, and where a branch of a piecewise function begins on its zero.

use super::hybrid_state::{Fired, HybridState};
use super::select::Sign;
use crate::hybrid::events::located::side;
use crate::hybrid::events::vanishing::VANISHING_ROUNDING;
use crate::hybrid::events::watched::Function;
use crate::hybrid::interface::element::Effect;
use crate::hybrid::interface::system::HybridSystem;
use crate::numbers::running_error::RunningError;

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> HybridState<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// Sets switches and branches by the state, which has jumped here. What is no more than rounding keeps its side; a branch that has none
    /// yet, or none any more, stands on its zero.
    pub(super) fn set_switches(&mut self, crossed: &[bool; S]) {
        if !H::SIGNALS.iter().any(crate::hybrid::interface::element::Signal::is_switch) {
            return;
        }
        let state = self.state.map(RunningError::once);
        let functions = self.in_mode.system.signals(RunningError::once(self.t), &state);
        for (s, signal) in H::SIGNALS.iter().enumerate().filter(|(_, signal)| signal.is_switch()) {
            let function: RunningError<f64> = functions[s];
            if function.value.abs() > VANISHING_ROUNDING * function.error {
                self.stand(s, if function.value > 0.0 { 1.0 } else { -1.0 });
            } else if signal.effect == Effect::Branch && !crossed[s] {
                self.stand(s, 0.0);
            }
        }
    }

    /// Finds out which resets have functions that have come to the side from which they go through zero: the others wait until they do.
    pub(in crate::hybrid) fn arm_resets(&mut self) {
        for (s, _) in H::SIGNALS.iter().enumerate().filter(|(_, signal)| !signal.is_switch()) {
            if self.sides.signals[s] == 0.0 && self.side_of_signal(s, &self.state) > 0 {
                self.sides.signals[s] = 1.0;
            }
        }
    }

    /// Finds it out within a step, up to a time at which something happens: a function may leave zero and be back by then. Just before it is
    /// back it is further from zero than where a mode begins, which is a zero that was located up to rounding.
    pub(in crate::hybrid) fn arm_resets_until(
        &mut self,
        (start, until): (f64, f64),
        first: bool,
        at: &dyn Fn(f64) -> [f64; N],
    ) {
        /// The number of times that the step is halved.
        const HALVINGS: i32 = 50;

        for (s, _) in H::SIGNALS.iter().enumerate().filter(|(_, signal)| !signal.is_switch()) {
            if self.sides.signals[s] != 0.0 {
                continue;
            }
            let value = |t: f64| self.in_mode.system.signals(t, &at(t))[s];
            let least = if first { value(start) } else { f64::NEG_INFINITY };
            let leaves = |t: f64| {
                side(&self.in_mode, &self.sides, Function::Signal(s), t, &at(t)) > 0 && value(t) > least
            };
            if (1..=HALVINGS).any(|k| leaves(until - (until - start) * libm::exp2(-f64::from(k)))) {
                self.sides.signals[s] = 1.0;
            }
        }
    }

    /// Finds it out anew where a mode begins. A reset that waited no longer, and whose zero is where the mode begins, has not happened yet
    /// if neither it nor anything else that happens here has moved its function: inputs that change there do not take it away.
    pub(super) fn arm_resets_anew(&mut self, ready: &[f64; S], fired: &Fired<C, S>, before: &[f64; N]) {
        for (s, _) in H::SIGNALS.iter().enumerate().filter(|(_, signal)| !signal.is_switch()) {
            let is_ready = match self.side_of_signal(s, &self.state) {
                0 => ready[s] != 0.0 && !fired.signals[s] && self.side_of_signal(s, before) == 0,
                side => side > 0,
            };
            self.sides.signals[s] = if is_ready { 1.0 } else { 0.0 };
        }
    }

    /// The side of zero on which the function of a signal is at a state: zero where it is no more than rounding.
    fn side_of_signal(&self, s: usize, state: &[f64; N]) -> i8 {
        side(&self.in_mode, &self.sides, Function::Signal(s), self.t, state)
    }

    /// Lets resets wait that have happened and have left their functions where they were: there they are zero, whatever rounding says.
    pub(super) fn wait_at_zeros(&mut self, fired: &Fired<C, S>, before: &[f64; N]) {
        let functions = |state: &[f64; N]| self.in_mode.system.signals(self.t, state);
        let (was, is) = (functions(before), functions(&self.state));
        for (s, signal) in H::SIGNALS.iter().enumerate() {
            if fired.signals[s] && !signal.is_switch() && is[s].abs() <= was[s].abs() {
                self.sides.signals[s] = 0.0;
            }
        }
    }

    /// Lets branches that stand on their zeros leave them, as the motion does in the present mode. Says whether one does.
    pub(super) fn leave_zeros(&mut self) -> bool {
        let mut leaves = false;
        for (s, signal) in H::SIGNALS.iter().enumerate() {
            if signal.effect != Effect::Branch || self.sides.signals[s] != 0.0 {
                continue;
            }
            let side = match self.in_mode.sign_of_signal(s, self.t, &self.state) {
                Sign::Positive => 1.0,
                Sign::Negative => -1.0,
                Sign::Unknown => continue,
            };
            self.stand(s, side);
            leaves = true;
        }
        leaves
    }

    /// Puts a signal on a side of its zero; on the zero itself by `0.0`.
    fn stand(&mut self, s: usize, side: f64) {
        self.sides.signals[s] = side;
        self.in_mode.switches[s] = 0.5 + 0.5 * side;
    }
}
