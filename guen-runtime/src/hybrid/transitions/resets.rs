//! Resets: new values for variables, all from the state before.

use super::hybrid_state::{Fired, HybridState};
use crate::hybrid::interface::error::HybridCause;
use crate::hybrid::interface::system::HybridSystem;

/// The part of the largest coordinate by which a reset may miss the constraints on positions: its formula is rounded.
const MISSED: f64 = 1e-9;

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> HybridState<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// Gives the state the values of all resets that have fired. Says whether there is one.
    ///
    /// Resets that happen at once see the same state, so that their order is irrelevant; two that give one variable different values
    /// contradict each other.
    pub(super) fn reset(&mut self, fired: &Fired<C, S>) -> Result<bool, HybridCause<C>> {
        let system = &self.in_mode.system;
        let before = self.state;
        let mut giver: [Option<usize>; N] = [None; N];
        let mut was_reset = false;
        for (s, signal) in H::SIGNALS.iter().enumerate() {
            if !fired.signals[s] || signal.is_switch() {
                continue;
            }
            was_reset = true;
            let given = system.reset(s, self.t, &before, &self.in_mode.switches);
            for i in 0..N {
                if given[i] == before[i] {
                    continue;
                }
                if let Some(first) = giver[i].filter(|_| self.state[i] != given[i]) {
                    let resets = [H::SIGNALS[first].name, signal.name];
                    return Err(HybridCause::ContradictingResets { resets });
                }
                (giver[i], self.state[i]) = (Some(s), given[i]);
            }
        }
        if was_reset {
            self.keeps_constraints()?;
        }
        Ok(was_reset)
    }

    /// Whether the permanent constraints on positions hold behind a reset, as far as rounding lets it tell; then they do to the last digit.
    fn keeps_constraints(&mut self) -> Result<(), HybridCause<C>> {
        let broken = HybridCause::ConstraintBrokenByReset;
        let onto = self.in_mode.system.onto_constraints(self.t, &self.state).map_err(|_| broken)?;
        let coordinates = || onto.iter().zip(&self.state).take(H::COORDINATES);
        let largest = coordinates().fold(0.0, |most: f64, (x, _)| most.max(x.abs()));
        // What is no number is not kept.
        if coordinates().all(|(onto, given)| (onto - given).abs() <= MISSED * largest) {
            self.state = onto;
            Ok(())
        } else {
            Err(broken)
        }
    }
}
