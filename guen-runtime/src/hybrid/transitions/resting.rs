//! Sequences of impacts that accumulate: when one is so slow that what is left of it is closed early.

use super::hybrid_state::HybridState;
use super::select::{Known, Rate, Unselected, select};
use crate::hybrid::events::vanishing::VANISHING_ROUNDING;
use crate::hybrid::filled::filled;
use crate::hybrid::impacts::impact::{Impact, STILL, Struck};
use crate::hybrid::interface::element::Kind;
use crate::hybrid::interface::error::HybridCause;
use crate::hybrid::interface::mode::{ElementState, Mode};
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::TransitionKind;
use crate::hybrid::mode_dynamics::in_mode::{InMode, moved};
use crate::numbers::running_error::RunningError;

/// The difference of ratios that agree, relative to them, and to what they are below one.
const AGREEMENT: f64 = 1e-2;

/// The impacts of late, as far as the end of a sequence is judged by them.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Resting<const C: usize> {
    /// The error of the time at which a sequence ends that is allowed.
    accuracy: f64,
    /// The length of the step in which the last impact was found.
    step: f64,
    speeds: [f64; 4],
    count: u32,
    last: f64,
    took_part: [bool; C],
}

impl<const C: usize> Resting<C> {
    pub(in crate::hybrid) fn new(accuracy: f64) -> Self {
        let (speeds, last) = ([0.0; 4], f64::NEG_INFINITY);
        Self { accuracy, step: 0.0, speeds, count: 0, last, took_part: [false; C] }
    }

    /// With the length of the step in which something was found.
    pub(in crate::hybrid) fn within(self, step: f64) -> Self {
        Self { step, ..self }
    }

    /// Records an impact with the largest speed of closing. Returns the ratio of the last two speeds, if the last three ratios agree and
    /// are below one.
    pub(super) fn record(&mut self, t: f64, speed: f64, meets: &[bool; C]) -> Option<f64> {
        self.took_part = filled(|c| self.took_part[c] || meets[c]);
        self.last = t;
        self.speeds.rotate_right(1);
        self.speeds[0] = speed;
        self.count = self.count.saturating_add(1);
        if self.count < 4 {
            return None;
        }
        let [a, b, c, d] = self.speeds;
        let ratios = [a / b, b / c, c / d];
        let agree = |x: f64, y: f64| (x - y).abs() <= AGREEMENT * f64::min(y, 1.0 - y);
        let [first, second, third] = ratios;
        (first < 1.0 && agree(first, second) && agree(second, third)).then_some(first)
    }

    /// The rebound below which a sequence is closed, with the acceleration `back` towards the contact. What is left out is wrong by the
    /// third order of the rebound; where an impact sticks also by the second, as far as the contact accelerates `aside` between impacts.
    pub(super) fn slowest(&self, back: f64, aside: f64) -> f64 {
        if !(back > 0.0) {
            return 0.0;
        }
        let third = libm::cbrt(self.accuracy * back * back);
        let second = libm::sqrt(self.accuracy * back * back / aside);
        if second < third { second } else { third }
    }

    /// The ratio of the last two speeds, as far as it is below a half; zero elsewhere.
    pub(super) fn last_ratio(&self) -> f64 {
        let ratio = self.speeds[0] / self.speeds[1];
        if self.count > 1 && ratio < 0.5 { ratio } else { 0.0 }
    }

    /// Ends the sequence, and returns the number of its impacts.
    pub(super) fn finish(&mut self) -> u32 {
        let count = self.count;
        *self = Self::new(self.accuracy);
        count
    }

    /// Forgets the impacts: something else happened.
    pub(in crate::hybrid) fn interrupt(&mut self) {
        *self = Self::new(self.accuracy);
    }
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> HybridState<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// The sizes of gaps below which they are rounding.
    pub(super) fn resolution(&self) -> [f64; C] {
        let exact = |value: f64| RunningError::exact(value);
        let switches = self.in_mode.switches.map(exact);
        let state = self.state.map(RunningError::once);
        let time = RunningError::once(self.t);
        let free = self.in_mode.system.free_motion(time, &state, &switches, &[exact(0.0); C]);
        free.gaps.map(|gap| VANISHING_ROUNDING * gap.error)
    }

    /// Closes a sequence of impacts early, where the rebound is slow enough: the impact becomes the one that closes.
    pub(super) fn rests(
        &self,
        impact: &Impact<'_, f64, W, C>,
        struck: &mut Struck<W, C>,
        resting: &mut Resting<C>,
        meets: [bool; C],
        known: &[Known; C],
    ) -> Result<Option<TransitionKind>, HybridCause<C>> {
        /// Roundings by which the end of a flight may be off.
        const INSTANTS: f64 = 4.0;

        let rate = |c: usize, rates: &[f64; W]| H::ELEMENTS[c].normal.map_or(0.0, |row| rates[row]);
        let speed = (0..C).filter(|c| meets[*c]).fold(0.0, |most: f64, c| most.max(-rate(c, &impact.before)));
        let ratio = resting.record(self.t, speed, &meets);
        let rebounds = |c: usize| impact.takes_part[c] && rate(c, &struck.after) > STILL * speed;
        let mut until = self.t;
        let mut slowest = false;
        let mut opened = self.in_mode.mode;
        for c in (0..C).filter(|c| rebounds(*c)) {
            opened = opened.with(c, ElementState::Open);
            slowest = true;
        }
        if !slowest {
            return Ok(None);
        }
        // The acceleration with which the contacts that rebound come back.
        for c in (0..C).filter(|c| impact.takes_part[*c] && H::ELEMENTS[*c].normal.is_some() && !rebounds(*c))
        {
            let held = match H::ELEMENTS[c].tangential {
                [] => ElementState::Closed,
                _ if struck.sticks[c] => ElementState::Stick,
                &[row] if struck.after[row] > 0.0 => ElementState::SlipForward,
                [_] => ElementState::SlipBackward,
                _ => ElementState::Slip,
            };
            opened = opened.with(c, held);
        }
        let state = moved(&self.state, &struck.impulses, &self.free().responses);
        let flight =
            InMode::with_switches(self.in_mode.system.clone(), opened, self.in_mode.switches, self.t, &state);
        let accelerations = flight.reactions(self.t, &state).row_accelerations();
        let aside = |c: usize| {
            let tangential = if struck.sticks[c] { H::ELEMENTS[c].tangential } else { &[] };
            tangential.iter().map(|&row| accelerations[row].abs()).fold(0.0, f64::max)
        };
        let aside = (0..C).filter(|c| rebounds(*c)).map(aside).fold(0.0, f64::max);
        let resolution = self.resolution();
        // Whether all flights are lower than that.
        let mut lowest = true;
        let mut flight_time: f64 = 0.0;
        for c in (0..C).filter(|c| rebounds(*c)) {
            let (back, away) = (-rate(c, &accelerations), rate(c, &struck.after));
            if !(back > 0.0) {
                continue;
            }
            flight_time = flight_time.max(2.0 * away / back);
            // Lower than the digits of the gap tell, whatever the ratio: such a flight has no end that could be located.
            // So is one of which an impact takes less than the digits of the time, or of a step's polynomial, tell.
            let taken = 2.0 * away / back * (1.0 - impact.restitutions[c]);
            let instant = INSTANTS * f64::EPSILON * self.t.abs().max(resting.step);
            let is_taken = |part: f64| taken > 0.0 && part * taken <= instant;
            let unresolved = away * away <= 2.0 * back * resolution[c] || is_taken(1.0);
            // Ratios agree only as far as the ends of flights are known.
            let known = ratio.is_some() || is_taken(AGREEMENT);
            let slow = known && away <= resting.slowest(back, aside);
            if !(unresolved || slow) {
                return Ok(None);
            }
            lowest &= unresolved;
            let ratio = ratio.unwrap_or_else(|| resting.last_ratio());
            until = f64::max(until, self.t + 2.0 * away / (back * (1.0 - ratio)));
        }
        // A contact that would not come back by itself: until the others do it is no higher than the digits of its gap tell.
        for c in (0..C).filter(|c| rebounds(*c)) {
            let (acceleration, away) = (rate(c, &accelerations), rate(c, &struck.after));
            let rises = flight_time * (away + 0.5 * flight_time * acceleration);
            if acceleration >= 0.0 && !(flight_time > 0.0 && rises <= resolution[c]) {
                return Ok(None);
            }
        }
        // Only where a mode with these contacts closed goes on.
        let goes_on = |next: &Mode<C>| (0..C).all(|c| !rebounds(c) || next.0[c].is_closed());
        let mut closing = None;
        match self.closed(impact, struck) {
            Some((closed, Ok(next))) if goes_on(&next) => closing = Some(closed),
            // Without an end of the flights that digits could tell, and without a mode that they lead to, there is no motion.
            Some((_, Err(why))) if lowest => return Err(why.into()),
            _ => {}
        }
        if closing.is_none() && lowest {
            // What does not slip before an impact is torn off by it for a time in which nothing moves that digits tell.
            let still = |c: usize| impact.takes_part[c] && known[c].slip == Rate::Still;
            let held = Struck { sticks: filled(|c| struck.sticks[c] || still(c)), ..*struck };
            closing = match self.closed(impact, &held) {
                Some((closed, Ok(next))) if goes_on(&next) => Some(closed),
                _ => None,
            };
        }
        let Some(closing) = closing else { return Ok(None) };
        *struck = closing;
        let impacts = resting.finish();
        Ok(Some(TransitionKind::Rest { impacts, until }))
    }

    /// The impact in which all that touches closes and what sticks is as in another one; and the mode that goes on after it. None where the
    /// impulses are not determined.
    fn closed(
        &self,
        impact: &Impact<'_, f64, W, C>,
        like: &Struck<W, C>,
    ) -> Option<(Struck<W, C>, Result<Mode<C>, Unselected<C>>)> {
        let closing = impact.closing(like)?;
        // Closing all contacts at once may add energy, as where contacts push each other open. Then their flights are not left out.
        if closing.energy > 0.0 {
            return None;
        }
        let state = moved(&self.state, &closing.impulses, &self.free().responses);
        let known: [Known; C] = filled(|c| Known {
            touches: impact.takes_part[c] && H::ELEMENTS[c].kind != Kind::Grip,
            normal: Rate::Still,
            slip: if closing.sticks[c] { Rate::Still } else { Rate::Moving },
            latch: self.in_mode.mode.0[c],
            ..Known::default()
        });
        let next = select(self.in_mode.system.clone(), self.in_mode.switches, (self.t, &state), &known);
        Some((closing, next.map(|next| next.mode)))
    }
}

#[cfg(test)]
mod tests {
    use super::Resting;

    /// The answer after the last of the speeds.
    fn recorded(speeds: &[f64]) -> Option<f64> {
        let mut resting = Resting::<1>::new(1e-9);
        speeds.iter().enumerate().fold(None, |_, (k, speed)| resting.record(k as f64, *speed, &[true]))
    }

    #[test]
    fn a_sequence_comes_to_rest_by_three_equal_ratios() {
        assert_eq!(recorded(&[8.0, 4.0, 2.0, 1.0]), Some(0.5));
        // Three speeds have two ratios.
        assert_eq!(recorded(&[4.0, 2.0, 1.0]), None);
        // The first, the second or the third ratio is another one.
        assert_eq!(recorded(&[9.0, 4.0, 2.0, 1.0]), None);
        assert_eq!(recorded(&[8.0, 4.5, 2.0, 1.0]), None);
        assert_eq!(recorded(&[8.0, 4.0, 2.0, 1.1]), None);
        // Near one ratios agree by what they are below it.
        assert!(recorded(&[1.0, 0.995, 0.990_025, 0.985_074_875]).is_some());
        assert_eq!(recorded(&[1.0, 0.995, 0.990_3, 0.985_3]), None);
        // An elastic contact never rests, nor one that is driven.
        assert_eq!(recorded(&[1.0; 4]), None);
        assert_eq!(recorded(&[1.0, 2.0, 4.0, 8.0]), None);
    }
}
