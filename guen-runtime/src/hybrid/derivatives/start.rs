//! Starts between two cases, by which a motion has no derivative.

use super::saltation::{along, unit_matrix};
use crate::hybrid::events::vanishing::vanishes;
use crate::hybrid::events::watched::{Function, Sides};
use crate::hybrid::interface::element::Kind;
use crate::hybrid::interface::mode::ElementState;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::numbers::dual::Dual;
use crate::numbers::running_error::RunningError;

/// The part of the largest derivative of a function below which one along an allowed deviation is rounding.
const ROUNDING: f64 = 1e-9;

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// The rates with another value of a switch.
    fn rates_with(&self, signal: usize, value: f64, t: f64, state: &[f64; N]) -> [f64; N] {
        let mut other = self.clone();
        other.switches[signal] = value;
        other.rates(t, state)
    }

    /// The element or signal whose function is zero where a run begins in this mode, so that the sign of a deviation decides what happens:
    /// a slip from rest, a contact that opens without a speed, a switch.
    pub(super) fn divides(
        &self,
        t: f64,
        state: &[f64; N],
        deviations: &[[f64; N]; N],
    ) -> Option<&'static str> {
        let sides = Sides { latches: [1.0; C], signals: [1.0; S], slow: [0.0; C] };
        let (time, rounded) = (RunningError::once(t), state.map(RunningError::once));
        let values = self.watched(&sides, time, &rounded);
        let rates = self.system().row_rates(time, &rounded);
        let units = unit_matrix();
        let is_moved = |slope: &dyn Fn(&[f64; N]) -> f64| {
            let largest = |directions: &[[f64; N]; N]| {
                directions.iter().fold(0.0, |most: f64, direction| most.max(slope(direction).abs()))
            };
            largest(deviations) > ROUNDING * largest(&units)
        };
        let moves = |function: Function| {
            is_moved(&|direction| {
                let values = self.watched(&sides, Dual::constant(t), &along(state, direction));
                values.get(function).map_or(0.0, |value| value.tangent[0])
            })
        };
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            let is_still = |row: &usize| vanishes(rates[*row]);
            let row_moves = |&row: &usize| {
                is_moved(&|direction| {
                    self.system().row_rates(Dual::constant(t), &along(state, direction))[row].tangent[0]
                })
            };
            let on_zero = |function| values.get(function).is_some_and(vanishes) && moves(function);
            let divides = match self.mode().0[c] {
                mode if mode.slips() => {
                    element.tangential.iter().all(is_still) && element.tangential.iter().any(row_moves)
                }
                // Starts with a gap below zero are none, and behind a latch there are some.
                ElementState::Open => {
                    on_zero(Function::Gap(c))
                        && element.normal.iter().all(is_still)
                        && element.kind != Kind::Grip
                }
                ElementState::Free => on_zero(Function::Gap(c)),
                _ => {
                    let cones = [Function::Cone(c, true), Function::Cone(c, false)];
                    on_zero(Function::Normal(c)) || cones.into_iter().any(on_zero)
                }
            };
            if divides {
                return Some(element.name);
            }
        }
        let signals = self.system().signals(time, &rounded);
        let motion = along(state, &self.rates(t, state));
        let pace = self.system().signals(Dual { value: t, tangent: [1.0] }, &motion);
        let is_at_zero = |s: &usize| {
            // A kink that the motion leaves at once changes no derivative.
            let is_kink = H::SIGNALS[*s].is_switch()
                && pace[*s].tangent[0] != 0.0
                && self.rates_with(*s, 0.0, t, state) == self.rates_with(*s, 1.0, t, state);
            vanishes(signals[*s])
                && !is_kink
                && is_moved(&|direction| {
                    self.system().signals(Dual::constant(t), &along(state, direction))[*s].tangent[0]
                })
        };
        (0..S).find(is_at_zero).map(|s| H::SIGNALS[s].name)
    }
}
