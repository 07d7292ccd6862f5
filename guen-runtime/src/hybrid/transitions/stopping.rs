//! The end of spatial slip: its last part, in which the direction of the slip no longer turns.

use super::select::unit;
use crate::hybrid::filled::filled;
use crate::hybrid::interface::mode::ElementState;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::hybrid::mode_dynamics::mode_rows::Leaning;
use crate::steppers::Checkpoint;

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// The time and state at which a slow spatial slip ends, with its direction as it is now.
    pub(in crate::hybrid) fn stopped(&self, c: usize, t: f64, state: &[f64; N]) -> (f64, [f64; N]) {
        /// Steps of Newton's method for the time that is left.
        const NEWTON_STEPS: u32 = 5;
        /// The number of times by which a slip may be faster that ends together with it.
        const TOGETHER: f64 = 10.0;

        let &[first, second] = H::ELEMENTS[c].tangential else { return (t, *state) };
        let rates = self.system.row_rates(t, state);
        let Some(direction) = unit([rates[first], rates[second]]) else { return (t, *state) };
        let mut straight = self.clone();
        straight.leaning[c] = Leaning { direction, speed: f64::INFINITY };
        // Slips that are as slow end together with it, as those of two feet of a body that turns about a third: they turn no more either.
        let slip = libm::hypot(rates[first], rates[second]);
        for (other, element) in H::ELEMENTS.iter().enumerate() {
            if let &[first, second] = element.tangential
                && self.mode.0[other] == ElementState::Slip
                && libm::hypot(rates[first], rates[second]) <= TOGETHER * slip
                && let Some(direction) = unit([rates[first], rates[second]])
            {
                straight.leaning[other] = Leaning { direction, speed: f64::INFINITY };
            }
        }
        let along = |rates: &[f64; W]| direction[0] * rates[first] + direction[1] * rates[second];
        let mut left = 0.0;
        let mut end = *state;
        for _ in 0..NEWTON_STEPS {
            let motion = straight.reactions(t + left, &end);
            let (slip, change) = (along(&motion.free.row_rates), along(&motion.row_accelerations()));
            if !(change < 0.0) {
                break;
            }
            left -= slip / change;
            end = straight.after(t, state, left);
        }
        (t + left, end)
    }

    /// The first spatial slip that ends within a step which goes on past that end, with the time and state of the end. A step does that
    /// where the slip is as small as the error that the step may have, and where the step has a fixed length. `middle` is the state halfway.
    pub(in crate::hybrid) fn stop_within(
        &self,
        slow: &[f64; C],
        before: &Checkpoint<f64, N>,
        middle: impl Fn(f64) -> [f64; N],
        after: &Checkpoint<f64, N>,
    ) -> Option<(usize, f64, [f64; N])> {
        /// The part of the slip that may be left in its direction at the end of the step, and where its end was found.
        const GONE: f64 = 0.5;
        const FOUND: f64 = 1e-6;

        // A slip that has hardly begun is not looked at.
        let ends = |c: usize| self.mode.0[c] == ElementState::Slip && slow[c] > 0.0;
        if !(0..C).any(ends) {
            return None;
        }
        let rates = self.system.row_rates(before.time, &before.state);
        let later = self.system.row_rates(after.time, &after.state);
        let mut earliest: Option<(usize, f64, [f64; N])> = None;
        for (c, element) in H::ELEMENTS.iter().enumerate().filter(|(c, _)| ends(*c)) {
            let &[first, second] = element.tangential else { continue };
            let pair = |rates: &[f64; W]| [rates[first], rates[second]];
            let Some(direction) = unit(pair(&rates)) else { continue };
            let along = |rates: &[f64; W]| direction[0] * rates[first] + direction[1] * rates[second];
            let slip = along(&rates);
            // Most steps of a slip are far from its end.
            if along(&later) > GONE * slip {
                continue;
            }
            let length = after.time - before.time;
            let changes = |t: f64, state: &[f64; N]| self.reactions(t, state).row_accelerations();
            let begin = changes(before.time, &before.state);
            if !(slip < -along(&begin) * length) {
                continue;
            }
            let half = before.time + 0.5 * length;
            let between = [begin, changes(half, &middle(half)), changes(after.time, &after.state)];
            if is_followed([pair(&rates), pair(&later)], between.map(|changes| pair(&changes)), length) {
                continue;
            }
            let (t, state) = self.stopped(c, before.time, &before.state);
            let left = along(&self.system.row_rates(t, &state));
            if left.abs() <= FOUND * slip
                && before.time < t
                && t <= after.time
                && earliest.is_none_or(|(_, sooner, _)| t < sooner)
            {
                earliest = Some((c, t, state));
            }
        }
        earliest
    }

    /// One step of the classical method of order four.
    fn after(&self, t: f64, x: &[f64; N], h: f64) -> [f64; N] {
        let ahead = |part: f64, slope: &[f64; N]| filled(|i| x[i] + part * h * slope[i]);
        let a: [f64; N] = self.rates(t, x);
        let b = self.rates(t + 0.5 * h, &ahead(0.5, &a));
        let c = self.rates(t + 0.5 * h, &ahead(0.5, &b));
        let d = self.rates(t + h, &ahead(1.0, &c));
        filled(|i| x[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]))
    }
}

/// Whether a step follows a slip: it changes as its accelerations say at both ends and between them, as where it turns without an end.
fn is_followed([from, to]: [[f64; 2]; 2], [begin, middle, end]: [[f64; 2]; 3], length: f64) -> bool {
    /// The part of the accelerations by which a step is off that goes past the end of a slip, where they turn around.
    const OFF: f64 = 0.05;

    let size =
        [begin, middle, end].into_iter().flatten().fold(0.0, |most: f64, change| most.max(change.abs()));
    (0..2).all(|i| {
        let mean = (begin[i] + 4.0 * middle[i] + end[i]) / 6.0;
        ((to[i] - from[i]) / length - mean).abs() <= OFF * size
    })
}
