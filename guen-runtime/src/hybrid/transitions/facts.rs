//! The facts of the elements at a transition before it is judged: who touches, what is still.

use super::hybrid_state::{Fired, HybridState};
use super::select::{Known, Rate};
use crate::hybrid::events::vanishing::{is_rounding, vanishes};
use crate::hybrid::filled::filled;
use crate::hybrid::interface::element::Kind;
use crate::hybrid::interface::error::HybridCause;
use crate::hybrid::interface::mode::ElementState;
use crate::hybrid::interface::system::HybridSystem;
use crate::numbers::running_error::RunningError;

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> HybridState<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// The contacts that touch: those that were closed, and those whose gap has reached zero, with those whose gap is then rounding
    /// alone; at the start and after a reset those whose gap is zero.
    pub(super) fn touching(&self, fired: &Fired<C, S>, anew: bool) -> Result<[bool; C], HybridCause<C>> {
        let system = &self.in_mode.system;
        let when = system.conditions(self.t, &self.state, &self.in_mode.switches).when;
        let known: [bool; C] =
            filled(|c| self.in_mode.mode.0[c].is_closed() && H::ELEMENTS[c].kind != Kind::Grip);
        if !anew && !self.begins {
            let contact = |c: usize| !matches!(H::ELEMENTS[c].kind, Kind::Grip | Kind::Latch);
            if !fired.gap.contains(&true) {
                return Ok(known);
            }
            let (gaps, resolution) = (self.free().gaps, self.resolution());
            // A few roundings: bounces that digits tell apart are not touches.
            let at_zero = |c: usize| when[c] > 0.0 && 64.0 * gaps[c].abs() <= resolution[c];
            return Ok(filled(|c| known[c] || contact(c) && (fired.gap[c] || at_zero(c))));
        }
        let zero = |_| RunningError::exact(0.0);
        let switches = self.in_mode.switches.map(RunningError::exact);
        let state = self.state.map(RunningError::once);
        let gaps = system.free_motion(RunningError::once(self.t), &state, &switches, &filled(zero)).gaps;
        let mut touches = [false; C];
        for c in 0..C {
            let contact = H::ELEMENTS[c].name;
            let closes = known[c] || when[c] > 0.0 && H::ELEMENTS[c].kind != Kind::Latch;
            let is_zero = vanishes(gaps[c]);
            if H::ELEMENTS[c].kind == Kind::Grip {
                continue;
            }
            if known[c] && !is_zero {
                return Err(HybridCause::BrokenByReset { contact });
            }
            if closes && !is_zero && gaps[c].value < 0.0 {
                return Err(HybridCause::Penetrating { contact, gap: gaps[c].value });
            }
            touches[c] = closes && is_zero;
        }
        Ok(touches)
    }

    /// Locks the latches that a run begins with at zero and at rest.
    pub(super) fn lock_at_start(&self, known: &mut [Known; C]) {
        let zero = |_| RunningError::exact(0.0);
        let switches = self.in_mode.switches.map(RunningError::exact);
        let state = self.state.map(RunningError::once);
        let free =
            self.in_mode.system.free_motion(RunningError::once(self.t), &state, &switches, &filled(zero));
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            if let (Kind::Latch, Some(row)) = (element.kind, element.normal)
                && vanishes(free.gaps[c])
                && vanishes(free.row_rates[row])
            {
                known[c].latch = ElementState::Locked;
            }
        }
    }

    /// Frees locked latches whose release has jumped from zero or below to above zero, with a switch, in a reset or in an impact: such a
    /// rise has no zero that is located.
    pub(super) fn free_latches(&self, before: &Self, known: &mut [Known; C]) {
        let locked = |c: usize| before.in_mode.mode.0[c] == ElementState::Locked;
        if !(0..C).any(locked) {
            return;
        }
        let conditions =
            |place: &Self| place.in_mode.system.conditions(place.t, &place.state, &place.in_mode.switches);
        let [was, is] = [conditions(before), conditions(self)].map(|conditions| conditions.release);
        for c in 0..C {
            if locked(c) && was[c] <= 0.0 && is[c] > 0.0 {
                known[c].latch = ElementState::Free;
            }
        }
    }

    /// The facts of the elements before an impact.
    pub(super) fn known(&self, fired: &Fired<C, S>, touches: &[bool; C], anew: bool) -> [Known; C] {
        let rates =
            self.in_mode.system.row_rates(RunningError::once(self.t), &self.state.map(RunningError::once));
        let anew = anew || self.begins;
        let scale = rates.iter().fold(0.0, |most: f64, rate| most.max(rate.value.abs()));
        // A slip that is rounding alone, as where it has only begun: its direction is not known.
        let rounds = |rows: &[usize]| rows.len() == 1 && rates[rows[0]].value.abs() <= f64::EPSILON * scale;
        // Times are known to their last digit, and rates to what their accelerations make of it.
        let accelerations = self.in_mode.reactions(self.t, &self.state).row_accelerations();
        let instant = f64::EPSILON * self.t.abs();
        let is_momentary =
            |&row: &usize| !anew && rates[row].value.abs() <= instant * accelerations[row].abs();
        filled(|c| {
            let (element, state) = (&H::ELEMENTS[c], self.in_mode.mode.0[c]);
            let vanish = |rows: &[usize]| rows.iter().all(|&row| vanishes(rates[row]));
            let closed = state.is_closed() && !anew && element.kind != Kind::Grip;
            // Where a gap has come to zero its rate is known to roundings: slower impacts are impacts.
            let still = |row: usize| match anew {
                true => vanishes(rates[row]),
                false => is_rounding(rates[row]) || is_momentary(&row),
            };
            // A flight that is shorter than a step can tell is none.
            let stays = |row: usize| fired.grounded[c] && rates[row].value >= 0.0;
            let normal_still = closed || element.normal.is_some_and(|row| still(row) || stays(row));
            // A slip before a contact closes is known to roundings, too.
            let slip_still = !anew && (state == ElementState::Stick || fired.slip[c])
                || anew && vanish(element.tangential)
                || !state.slips() && element.tangential.iter().all(|&row| is_rounding(rates[row]))
                || rounds(element.tangential)
                || !element.tangential.is_empty() && element.tangential.iter().all(is_momentary);
            let rate = |still| if still { Rate::Still } else { Rate::Moving };
            Known {
                touches: touches[c],
                normal: rate(normal_still),
                slip: rate(slip_still),
                normal_reaction_fired: fired.normal[c],
                cone_fired: fired.cone[c],
                latch: state,
            }
        })
    }
}
