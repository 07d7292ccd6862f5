//! The first end of a mode within a step: falling zeros of the functions watched, pairs of them included.

use super::vanishing::{is_rounding, vanishes};
use super::watched::{Function, Sides, Watched};
use crate::hybrid::interface::element::Effect;
use crate::hybrid::interface::mode::ElementState;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::numbers::dual::Dual;
use crate::numbers::running_error::RunningError;
use crate::steppers::root::{Bracket, narrow};

/// The first thing that happens within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::hybrid) struct Found {
    pub(in crate::hybrid) function: Function,
    pub(in crate::hybrid) t: f64,
    pub(in crate::hybrid) does: Does,
}

/// The way in which a function meets zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::hybrid) enum Does {
    Falls,
    /// Touches zero, as far as can be told, and goes back.
    Touches,
    /// Is below zero by so much, and has been: a gap whose zero was not seen.
    IsBelow(f64),
    /// Is NaN, or its condition is.
    IsNoNumber,
}

/// The number of times that a part is halved in search of a place at which a function is positive.
const PART_HALVINGS: u32 = 50;
/// The part of a step within which a touch is the one before.
const AGAIN: f64 = 1e-7;
/// The parts of a step at whose ends functions are looked at.
const PARTS: u32 = 4;
/// The most looks at functions that swing within a step.
const MOST_LOOKS: u32 = 2048;
/// The largest error of a cubic interpolation between looks, relative to the least of the values: with more, a zero may be hidden.
const UNSEEN: f64 = 0.25;
/// The error of a cubic interpolation that is ignored, relative to the largest of the values.
const NEGLIGIBLE: f64 = 1e-7;
/// The number of times that the first part of the first step of a mode is divided by eight.
const FIRST_DIVISIONS: u32 = 10;
/// The part of the time itself after its beginning before which nothing is looked at: the time at which a mode begins is known no better.
const SETTLING: f64 = 1e-12;

/// The functions watched at one time, with the rates of their changes.
#[derive(Clone, Copy)]
struct Look<const C: usize, const S: usize> {
    t: f64,
    values: Watched<Dual<f64, 1>, C, S>,
}

/// The motion within a step, watched.
pub(in crate::hybrid) struct Step<'a, H, const N: usize, const W: usize, const C: usize, const S: usize> {
    pub(in crate::hybrid) in_mode: &'a InMode<H, N, W, C, S>,
    pub(in crate::hybrid) sides: &'a Sides<C, S>,
    pub(in crate::hybrid) start: f64,
    pub(in crate::hybrid) end: f64,
    /// The time of the step after which events are looked for.
    pub(in crate::hybrid) from: f64,
    /// Whether the mode begins with the step: functions may leave zero there.
    pub(in crate::hybrid) first: bool,
    pub(in crate::hybrid) at: &'a mut dyn FnMut(f64) -> [f64; N],
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> Step<'_, H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// The first falling zero, or touch of zero.
    pub(in crate::hybrid) fn first(&mut self) -> Option<Found> {
        let (from, start, end) = (self.from, self.start, self.end);
        let part = (end - start) / f64::from(PARTS);
        let mut looks = [self.look(start); PARTS as usize + 1];
        for (k, look) in (0..=PARTS).zip(&mut looks).skip(1) {
            *look = self.look(if k == PARTS { end } else { start + part * f64::from(k) });
        }
        let mut swings = [false; PARTS as usize];
        for (k, three) in looks.windows(3).enumerate() {
            if !is_resolved([&three[0], &three[1], &three[2]]) {
                swings[k..k + 2].fill(true);
            }
        }
        let mut before = if from == start { looks[0] } else { self.look(from) };
        let divisions = if self.first { FIRST_DIVISIONS } else { 0 };
        for k in 0..divisions {
            let t = start + part * libm::exp2(-3.0 * f64::from(divisions - k));
            if t <= from || t - start <= SETTLING * start.abs() {
                continue;
            }
            let after = self.look(t);
            let found = self.earliest(&before, &after);
            if found.is_some() {
                return found;
            }
            before = after;
        }
        let mut left = MOST_LOOKS;
        for (after, swings) in looks.iter().skip(1).zip(swings) {
            let t = after.t;
            if t <= from || t < end && t - start <= SETTLING * start.abs() {
                continue;
            }
            let found = match swings {
                true => self.between(&before, after, &mut left),
                false => self.earliest(&before, after),
            };
            if found.is_some() {
                return found;
            }
            before = *after;
        }
        None
    }

    /// The first event between two looks, in halves as long as a function swings between them: the motion may be simple, and take long steps,
    /// while a floor shakes. So many looks are left.
    fn between(&mut self, before: &Look<C, S>, after: &Look<C, S>, left: &mut u32) -> Option<Found> {
        let middle = before.t + 0.5 * (after.t - before.t);
        if *left == 0 || !(before.t < middle && middle < after.t) {
            return self.earliest(before, after);
        }
        *left -= 1;
        let middle = self.look(middle);
        if is_resolved([before, &middle, after]) {
            return self.earliest(before, after);
        }
        let first = self.between(before, &middle, left);
        if first.is_some() { first } else { self.between(&middle, after, left) }
    }

    /// The first event that the values and rates of two looks show.
    fn earliest(&mut self, before: &Look<C, S>, after: &Look<C, S>) -> Option<Found> {
        let again = self.from + AGAIN * (self.end - self.start);
        let mut earliest: Option<Found> = None;
        for function in Function::all(C, S) {
            if let Some(found) = self.within(function, before, after)
                // A touch from which the search goes on is not found again.
                && !(found.does == Does::Touches && found.t <= again)
                && earliest.is_none_or(|sooner| found.t < sooner.t)
            {
                earliest = Some(found);
            }
        }
        earliest
    }

    fn look(&mut self, t: f64) -> Look<C, S> {
        let state = (self.at)(t);
        Look { t, values: self.in_mode.watched_along(self.sides, t, &state) }
    }

    fn value(&mut self, function: Function, t: f64) -> f64 {
        let state = (self.at)(t);
        self.in_mode.watched(self.sides, t, &state).get(function).unwrap_or(f64::NAN)
    }

    fn rate(&mut self, function: Function, t: f64) -> f64 {
        self.look(t).values.get(function).map_or(f64::NAN, |value| value.tangent[0])
    }

    /// The sign of a function at a time, zero where it is no more than rounding.
    fn side(&mut self, function: Function, t: f64) -> i8 {
        let state = (self.at)(t);
        side(self.in_mode, self.sides, function, t, &state)
    }

    /// The zero or touch of a function between two times.
    fn within(&mut self, function: Function, before: &Look<C, S>, after: &Look<C, S>) -> Option<Found> {
        let (a, b) = (before.values.get(function)?, after.values.get(function)?);
        if b.value.is_nan() || a.value.is_nan() {
            return self.without_number(function, before, after);
        }
        if let Function::Signal(s) = function
            && !H::SIGNALS[s].is_switch()
        {
            let waits = self.sides.signals[s] == 0.0 && !self.has_left(function, (before.t, a.value));
            if a.value < 0.0 && a.tangent[0] > 0.0 && b.value < 0.0 && b.tangent[0] < 0.0 {
                let found = self.rises_between(function, before, after);
                if found.is_some() || !waits {
                    return found;
                }
            }
            if waits {
                return self.comes_back(function, before.t, (after.t, b.value));
            }
        }
        if b.value <= 0.0 {
            // Past zero already before, or no further past it than rounding.
            if (a.value <= 0.0 && self.side(function, before.t) < 0) || self.side(function, after.t) >= 0 {
                let t = after.t;
                return self.below(function, t).map(|gap| Found { function, t, does: Does::IsBelow(gap) });
            }
            // A function that leaves zero and is on its way up has not come back: the polynomial is off by as much.
            if self.first && before.t == self.start && a.value <= 0.0 && b.tangent[0] > 0.0 {
                return None;
            }
            return self.falling(function, (before.t, a.value), (after.t, b.value));
        }
        // A gap that was no further below zero than rounding may have been on its way down: then it dips.
        let dips = matches!(function, Function::Gap(_))
            && !(self.first && before.t == self.start)
            && self.side(function, before.t) == 0;
        if (a.value > 0.0 || dips) && a.tangent[0] < 0.0 && b.tangent[0] > 0.0 {
            return self.least(function, before.t, after.t, (a.tangent[0], b.tangent[0]));
        }
        None
    }

    /// The falling zero between two times, at the second of which the function is negative.
    fn falling(&mut self, function: Function, (a, high): (f64, f64), (b, low): (f64, f64)) -> Option<Found> {
        let (mut from, mut to) = ((a, high), (b, low));
        if high <= 0.0 && a > self.from {
            // By no more than rounding it has been below zero for a while: it fell from its last top.
            (from, to) = (self.top_before(function, a), (a, high));
        } else if high <= 0.0 {
            // It leaves zero here, and comes back.
            let mut parts = (1..=PART_HALVINGS).map(|k| a + (b - a) * libm::exp2(-f64::from(k)));
            if let Some(found) = parts.find_map(|t| {
                let value = self.value(function, t);
                (value > 0.0).then_some((t, value))
            }) {
                from = found;
            }
        }
        let mut t = from.0;
        if from.1 > 0.0 {
            let bracket = Bracket { before: from.0, after: to.0 };
            t = narrow(bracket, (from.1, to.1), &spacing, &mut |t| self.value(function, t)).after;
        }
        self.counted(function, t, Does::Falls)
    }

    /// A function of the declaration that is NaN at one of two looks, unless it vanishes before. A branch may be, where it is not taken, and
    /// what depends on reactions is with them.
    fn without_number(
        &mut self,
        function: Function,
        before: &Look<C, S>,
        after: &Look<C, S>,
    ) -> Option<Found> {
        let is_declared = match function {
            Function::Gap(_) => true,
            Function::Signal(s) => H::SIGNALS[s].effect != Effect::Branch,
            _ => false,
        };
        if !is_declared {
            return None;
        }
        let is_known =
            |look: &Look<C, S>| look.values.get(function).is_some_and(|value| !value.value.is_nan());
        if !is_known(before) {
            return Some(Found { function, t: before.t, does: Does::IsNoNumber });
        }
        let (mut from, mut to) = (before.t, after.t);
        for _ in 0..PART_HALVINGS {
            let middle = from + 0.5 * (to - from);
            if self.value(function, middle).is_nan() {
                to = middle;
            } else {
                from = middle;
            }
        }
        // Next to the end of a root its error is without bounds, and its sign not known.
        let last = self.look(from - libm::exp2(-20.0) * (from - before.t));
        let found =
            if last.t > before.t && is_known(&last) { self.within(function, before, &last) } else { None };
        found.or(Some(Found { function, t: after.t, does: Does::IsNoNumber }))
    }

    /// The top of a function before a time at which it falls, and its value there: where its rate vanishes, or where the search began if it
    /// fell from there. The time itself, with zero, if it was not above zero before.
    fn top_before(&mut self, function: Function, t: f64) -> (f64, f64) {
        let (from, here) = (self.from, self.rate(function, t));
        let rises = self.rate(function, from);
        if rises > 0.0 && here < 0.0 {
            let bracket = Bracket { before: from, after: t };
            let top = narrow(bracket, (rises, here), &spacing, &mut |t| self.rate(function, t)).after;
            return (top, self.value(function, top));
        }
        let value = self.value(function, from);
        if value > 0.0 { (from, value) } else { (t, 0.0) }
    }

    /// The falling zero of the function of a reset that has not been positive yet: it goes above zero between two times, and back.
    fn comes_back(&mut self, function: Function, a: f64, (b, low): (f64, f64)) -> Option<Found> {
        if low > 0.0 || self.side(function, b) >= 0 {
            return None;
        }
        let mut parts = (1..=PART_HALVINGS).map(|k| a + (b - a) * libm::exp2(-f64::from(k)));
        let (above, high) = parts.find_map(|t| {
            let value = self.value(function, t);
            self.has_left(function, (t, value)).then_some((t, value))
        })?;
        self.falling(function, (above, high), (b, low))
    }

    /// Whether the function of a reset that waits is on the side from which it goes through zero: further from it than where the mode
    /// begins, which is a zero that was located up to rounding.
    fn has_left(&mut self, function: Function, (t, value): (f64, f64)) -> bool {
        self.side(function, t) > 0 && !(self.first && value <= self.value(function, self.start))
    }

    /// The falling zero between two times at which the function of a reset is negative, if it is positive between them.
    fn rises_between(
        &mut self,
        function: Function,
        before: &Look<C, S>,
        after: &Look<C, S>,
    ) -> Option<Found> {
        let (a, b) = (before.values.get(function)?, after.values.get(function)?);
        let bracket = Bracket { before: before.t, after: after.t };
        let rates = (a.tangent[0], b.tangent[0]);
        let top = narrow(bracket, rates, &spacing, &mut |t| self.rate(function, t)).before;
        if self.side(function, top) <= 0 {
            return None;
        }
        let high = self.value(function, top);
        self.falling(function, (top, high), (after.t, b.value))
    }

    /// The least value between two times at which a function is positive and between which its rate rises through zero: a falling
    /// zero before it, a touch, or nothing.
    fn least(&mut self, function: Function, a: f64, b: f64, (falls, rises): (f64, f64)) -> Option<Found> {
        let bottom = narrow(Bracket { before: a, after: b }, (-falls, -rises), &spacing, &mut |t| {
            -self.rate(function, t)
        })
        .after;
        // Right after the beginning of a mode a slip that hardly accelerates is no larger than the roundings of the step's polynomial:
        // a minimum there says nothing.
        if self.first && bottom - self.start <= SETTLING * self.start.abs() {
            return None;
        }
        let value = self.value(function, bottom);
        match self.side(function, bottom) {
            -1 => {
                let high = self.value(function, a);
                self.falling(function, (a, high), (bottom, value))
            }
            0 if matches!(function, Function::Gap(_))
                && self.side(function, a) > 0
                && self.side(function, b) > 0 =>
            {
                self.counted(function, bottom, Does::Touches)
            }
            _ => None,
        }
    }

    /// The gap of an open contact that is below zero by more than counts as zero where a run begins, and has no condition that let it pass.
    fn below(&mut self, function: Function, t: f64) -> Option<f64> {
        let Function::Gap(c) = function else { return None };
        if self.in_mode.mode.0[c] != ElementState::Open || H::ELEMENTS[c].conditional {
            return None;
        }
        let state = (self.at)(t).map(RunningError::once);
        let gap = self.in_mode.watched(self.sides, RunningError::once(t), &state).get(function)?;
        (gap.value < 0.0 && !vanishes(gap)).then_some(gap.value)
    }

    /// The zero of a function, if it counts: a contact closes, and a latch locks, only while its condition is positive.
    fn counted(&mut self, function: Function, t: f64, does: Does) -> Option<Found> {
        let found = Found { function, t, does };
        let Function::Gap(c) = function else { return Some(found) };
        if self.in_mode.mode.0[c].is_closed() {
            return Some(found);
        }
        let state = (self.at)(t);
        let when = self.in_mode.system.conditions(t, &state, &self.in_mode.switches).when[c];
        if when.is_nan() {
            return Some(Found { does: Does::IsNoNumber, ..found });
        }
        (when > 0.0).then_some(found)
    }
}

/// Whether three looks at equal distances are close enough to find all zeros between them: the cubic polynomials through the outer two
/// predict the values and rates of the middle one. Both are compared, because one of them may agree by chance.
fn is_resolved<const C: usize, const S: usize>([first, middle, last]: [&Look<C, S>; 3]) -> bool {
    let length = last.t - first.t;
    Function::all(C, S).filter(|function| !matches!(function, Function::Regularity | Function::Shared)).all(
        |function| {
            let of =
                |look: &Look<C, S>| look.values.get(function).map(|value| (value.value, value.tangent[0]));
            let (Some((a, leaves)), Some((m, passes)), Some((b, arrives))) =
                (of(first), of(middle), of(last))
            else {
                return true;
            };
            let value = 0.5 * (a + b) + length * (leaves - arrives) / 8.0;
            let change = 1.5 * (b - a) - 0.25 * length * (leaves + arrives);
            let missed = (m - value).abs().max((length * passes - change).abs() / 8.0);
            let least = a.abs().min(m.abs()).min(b.abs());
            let largest = a.abs().max(m.abs()).max(b.abs());
            !(missed > UNSEEN * least && missed > NEGLIGIBLE * largest)
        },
    )
}

/// The spacing of times at a time.
fn spacing(t: f64) -> f64 {
    f64::EPSILON * t.abs()
}

/// The sign of a function at a time and state, zero where it is no more than rounding.
pub(in crate::hybrid) fn side<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    in_mode: &InMode<H, N, W, C, S>,
    sides: &Sides<C, S>,
    function: Function,
    t: f64,
    state: &[f64; N],
) -> i8
where
    H: HybridSystem<N, W, C, S>,
{
    let (time, state) = (RunningError::once(t), state.map(RunningError::once));
    let Some(found) = in_mode.watched(sides, time, &state).get(function) else { return 0 };
    if is_rounding(found) {
        return 0;
    }
    if found.value > 0.0 { 1 } else { -1 }
}

#[cfg(test)]
mod tests {
    use super::{Does, Found, Step};
    use crate::hybrid::events::watched::{Function, Sides};
    use crate::hybrid::interface::element::{Element, Signal};
    use crate::hybrid::interface::mode::{ElementState, Mode};
    use crate::hybrid::interface::system::{FreeMotion, HybridSystem};
    use crate::hybrid::mode_dynamics::in_mode::InMode;
    use crate::numbers::lift::Lift;

    /// A particle at `x` above a floor at `x = 1`, whose acceleration is 2.
    #[derive(Clone, Copy)]
    struct Particle<const CONDITIONAL: bool>;

    impl<const CONDITIONAL: bool> HybridSystem<2, 1, 1, 0> for Particle<CONDITIONAL> {
        const ELEMENTS: [Element; 1] = [if CONDITIONAL {
            Element::smooth("floor", 0).with_condition()
        } else {
            Element::smooth("floor", 0)
        }];
        const SIGNALS: [Signal; 0] = [];
        const COORDINATES: usize = 1;

        type Mode = Mode<1>;
        type Inputs = ();

        fn with_inputs(&self, (): ()) -> Self {
            *self
        }

        fn free_motion<R: Lift<f64>>(
            &self,
            _t: R,
            &[x, v]: &[R; 2],
            _switches: &[R; 0],
            _speeds: &[R; 1],
        ) -> FreeMotion<R, 2, 1, 1> {
            let (zero, one) = (R::zero(), R::one());
            let acceleration = one + one;
            FreeMotion {
                rates: [v, acceleration],
                gaps: [x - one],
                row_rates: [v],
                biases: [acceleration],
                delassus: [[one]],
                responses: [[zero, one]],
                friction: [zero],
                stiction: [zero],
                limits: [zero],
            }
        }

        fn restitutions(&self) -> [f64; 1] {
            [0.0]
        }

        fn signals<R: Lift<f64>>(&self, _t: R, _state: &[R; 2]) -> [R; 0] {
            []
        }
    }

    /// The first end of the open mode in a step of a tenth, with a gap at its beginning and its rate there.
    fn found(gap: f64, rate: f64) -> Option<Found> {
        found_of(Particle::<false>, gap, rate)
    }

    fn found_of<const CONDITIONAL: bool>(
        particle: Particle<CONDITIONAL>,
        gap: f64,
        rate: f64,
    ) -> Option<Found> {
        let in_mode = InMode::new(particle, Mode([ElementState::Open]), 0.0, &[1.0, 0.0]);
        let sides = Sides { latches: [0.0], signals: [], slow: [0.0] };
        let mut at = |t: f64| [1.0 + gap + (rate + t) * t, rate + 2.0 * t];
        let mut step = Step {
            in_mode: &in_mode,
            sides: &sides,
            start: 0.0,
            end: 0.1,
            from: 0.0,
            first: false,
            at: &mut at,
        };
        step.first()
    }

    #[test]
    fn a_gap_that_dips_from_zero_within_rounding_ends_the_mode_there() {
        let rounding = -f64::EPSILON;
        let dip = found(rounding, -1e-3).unwrap();
        assert_eq!((dip.function, dip.t, dip.does), (Function::Gap(0), 0.0, Does::Falls));
        // It rises, or does not get below what rounding hides.
        assert_eq!(found(rounding, 1e-3), None);
        assert_eq!(found(rounding, -1e-9), None);
        // From above it is located.
        let fall = found(1e-10, -1e-3).unwrap();
        assert!((fall.t - 1e-7).abs() < 1e-10 && fall.does == Does::Falls, "{fall:?}");
    }

    #[test]
    fn a_gap_that_stays_below_zero_is_told() {
        let below = found(-1e-6, -1.0).unwrap();
        assert!(matches!(below.does, Does::IsBelow(gap) if gap < -1e-6), "{below:?}");
        // So much counts as zero where a run begins; and where a condition let the gap pass it may be below.
        assert_eq!(found(-1e-10, -1e-9), None);
        assert_eq!(found_of(Particle::<true>, -1e-6, -1.0), None);
    }
}
