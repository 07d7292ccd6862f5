//! Looks for kicks and steep layers that the references might step over, by evaluating the rates much more closely
//! than any setting does.
//!
//! A method that steps over a kick has nothing to show for it: neither its error estimate nor a second method does. So
//! the motion is followed in doubles, and the rates are evaluated at up to a million equidistant times of it. Between
//! neighbours the change of the state has to be the integral of the rates,
//!
//! ```text
//! x_(k+1) - x_k = h sum_j b_j f(t_j, x_j)       six neighbours, error of order h^7
//! ```
//!
//! and where it is not, the step is made again with a landing at every one of these times. If that ends elsewhere, something was
//! stepped over, and the motion goes on from what was found. So its steps are short wherever something is abrupt; there
//! references land as well. Source of the weights: the formulas of Adams and Moulton and those of their kind in between,
//! Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, section III.1.

use std::cell::RefCell;
use std::ops::ControlFlow;

use guen_runtime::steppers::{Dop853, Integration, Outcome};
use guen_runtime::{Cause, System};

use super::reference::Problem;

/// The number of intervals between evaluations that something has to last to be seen, wherever it lies.
const INTERVALS_SEEN: f64 = 2.0;
/// Steps of fewer intervals are not looked into: the nodes of DOP853 are no further apart than from 1/3 to 3/5, which is less than
/// two intervals then.
const LEAST_INTERVALS: usize = 7;
/// Intervals between landings of the motion, so that few times have to be listed.
const INTERVALS_AT_ONCE: usize = 1 << 16;
/// The tolerance of the motion.
pub(super) const TOLERANCE: f64 = 1e-13;
const EVALUATIONS_OF_STEP: u64 = 12;
/// The difference between a change of the state and the integral of the rates above which a step is made again.
const SUSPECT: f64 = 2e-12;
/// The change of the state by landings above which something was stepped over.
const MISSED: f64 = 1e-11;
/// Everything may take so many evaluations, and so many for each of the times. Beyond, rates vary too fast everywhere.
const MOST_EVALUATIONS: u64 = 2_000_000;
pub(super) const MOST_STEPS: u64 = MOST_EVALUATIONS / EVALUATIONS_OF_STEP;
const MOST_OF_EACH: u64 = 16;
/// A jump of the rates is stepped over by so many spacings of numbers, twice as many at each further try.
const JUMP: f64 = 4.0;
/// Steps that are shorter by so much than those that half of the motion is made of are at something abrupt: references
/// land so often in a row of them, unless it is the beginning of a run.
const SHORTER_THAN_USUAL: f64 = 16.0;
const LANDINGS: usize = 8;
const BEGINNING: usize = 10;

/// Returns how long something has to last to be seen, wherever it lies.
pub(super) fn width(span: f64, points: usize) -> f64 {
    INTERVALS_SEEN * span / points as f64
}

/// The closeness of a scan.
#[derive(Clone, Copy)]
pub(super) enum ScanDepth {
    /// The rates, at so many equidistant times of the span.
    At(usize),
    /// The motion alone, with a tolerance.
    Nowhere(f64),
}

/// The result of a scan.
pub(super) struct Seen<const N: usize> {
    /// The states at the times.
    pub states: Vec<[f64; N]>,
    /// The times at which references have to land, because steps are short there.
    pub landings: Vec<f64>,
    /// The number of places where a step in doubles went over something, and of jumps.
    pub abrupt: usize,
    pub evaluations: u64,
    /// The uncertainty of a state that jumps leave, relative to the sizes of its entries.
    pub uncertain: f64,
}

/// Follows a motion; `watch` says whether to go on. None if the motion fails, if there is no time, or if the rates vary too fast
/// everywhere for so few evaluations.
pub(super) fn scan<S, const N: usize>(
    system: &S,
    problem: &Problem<'_, N>,
    depth: ScanDepth,
    watch: &mut dyn FnMut() -> bool,
) -> Option<Seen<N>>
where
    S: System<f64, N>,
{
    let span = problem.span();
    let (interval, tolerance, most) = match depth {
        ScanDepth::At(points) => {
            (span / points as f64, TOLERANCE, MOST_EVALUATIONS + MOST_OF_EACH * points as u64)
        }
        ScanDepth::Nowhere(tolerance) => (f64::INFINITY, tolerance, MOST_EVALUATIONS),
    };
    let mut march = March {
        system,
        interval,
        method: Dop853::new(tolerance, tolerance).with_max_steps(most / EVALUATIONS_OF_STEP),
        t: problem.t0,
        x: *problem.start,
        steps: vec![problem.t0],
        spacing: f64::EPSILON * problem.t0.abs().max((problem.t0 + span).abs()).max(span),
        most,
        seen: Seen { states: Vec::new(), landings: Vec::new(), abrupt: 0, evaluations: 0, uncertain: 0.0 },
    };
    for (stop, wanted) in problem.stops() {
        march.scan_until(stop, watch)?;
        if wanted {
            march.seen.states.push(march.x);
        }
    }
    let short = short_steps(&march.steps);
    march.seen.landings.extend(short);
    Some(march.seen)
}

struct March<'a, S, const N: usize> {
    system: &'a S,
    /// Between two evaluations of the rates.
    interval: f64,
    method: Dop853<f64>,
    t: f64,
    x: [f64; N],
    /// The ends of all steps.
    steps: Vec<f64>,
    /// The spacing of numbers at the largest time.
    spacing: f64,
    /// Evaluations that there may be.
    most: u64,
    seen: Seen<N>,
}

/// A step that may have gone over something: a state before that, where to land from there, and what the step says of the state at
/// the last landing.
struct Suspicion<const N: usize> {
    begin: (f64, [f64; N]),
    landings: Vec<f64>,
    claimed: [f64; N],
}

impl<S: System<f64, N>, const N: usize> March<'_, S, N> {
    /// Goes to a time and looks into all steps on the way.
    fn scan_until(&mut self, to: f64, watch: &mut dyn FnMut() -> bool) -> Option<()> {
        while self.t != to {
            let left = (to - self.t).abs() / self.interval;
            if left <= LEAST_INTERVALS as f64 {
                return self.land(to, watch);
            }
            if left < 2.0 * LEAST_INTERVALS as f64 {
                let half = self.t + 0.5 * (to - self.t);
                self.land(half, watch)?;
                continue;
            }
            let at_once = INTERVALS_AT_ONCE as f64;
            let (end, count) = if left > 1.5 * at_once {
                (self.t + (to - self.t) * (at_once / left), INTERVALS_AT_ONCE)
            } else {
                (to, left.ceil() as usize)
            };
            self.advance(end, count, watch)?;
        }
        Some(())
    }

    /// Goes to a time, or to the end of the first step that went over something.
    fn advance(&mut self, to: f64, count: usize, watch: &mut dyn FnMut() -> bool) -> Option<()> {
        self.goes_on(watch)?;
        let from = self.t;
        let mut times: Vec<f64> =
            (0..=count).map(|k| from + (to - from) * (k as f64 / count as f64)).collect();
        times[count] = to;
        // Times of the step that is being made, the last one of the step before in front of them, and the states there.
        let points = RefCell::new(Points { times: Vec::new(), states: Vec::new() });
        let mut found: Option<Suspicion<N>> = None;
        let (system, steps, seen) = (self.system, &mut self.steps, &mut self.seen);
        let mut visit = |_: usize, t: f64, x: &[f64; N]| points.borrow_mut().push(t, x);
        let mut observe = |t: f64, x: &[f64; N]| {
            steps.push(t);
            let mut points = points.borrow_mut();
            if points.times.len() > LEAST_INTERVALS {
                seen.evaluations += points.times.len() as u64;
                found = points.suspicion(system, (t, *x));
            }
            points.keep_last();
            if found.is_some() || !watch() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let run = Integration::new(system, from, &self.x).sample(&times, &mut visit).observe(&mut observe);
        let ended = run.run(&self.method, to);
        match ended {
            Ok(done) => {
                self.seen.evaluations += done.statistics.evaluations;
                (self.t, self.x) = (done.time, done.state);
                match found {
                    Some(suspicion) => self.verify(suspicion, watch),
                    None if done.outcome == Outcome::Arrived => Some(()),
                    None => None,
                }
            }
            Err(error) => {
                self.seen.evaluations += error.statistics.evaluations;
                (self.t, self.x) = (error.time, error.state);
                self.jump(&error.cause, to)
            }
        }
    }

    /// Makes a step again, with landings. If that shows nothing, the step was right.
    fn verify(&mut self, suspicion: Suspicion<N>, watch: &mut dyn FnMut() -> bool) -> Option<()> {
        let after = (self.t, self.x);
        let (begin, jumps) = (suspicion.begin.0, self.seen.abrupt);
        let made: Vec<f64> = std::mem::take(&mut self.steps);
        (self.t, self.x) = suspicion.begin;
        for &next in &suspicion.landings {
            self.land(next, watch)?;
        }
        let again = std::mem::replace(&mut self.steps, made);
        if difference(&self.x, &suspicion.claimed) > MISSED {
            let forwards = (after.0 - begin).signum();
            while self.steps.last().is_some_and(|t| (t - begin) * forwards > 0.0) {
                self.steps.pop();
            }
            self.steps.push(begin);
            self.steps.extend(again);
            self.seen.abrupt = jumps + 1;
        } else {
            (self.t, self.x) = after;
        }
        Some(())
    }

    fn goes_on(&self, watch: &mut dyn FnMut() -> bool) -> Option<()> {
        (watch() && self.seen.evaluations <= self.most).then_some(())
    }

    /// Goes to a time without looking, over jumps.
    fn land(&mut self, to: f64, watch: &mut dyn FnMut() -> bool) -> Option<()> {
        while self.t != to {
            self.goes_on(watch)?;
            let steps = &mut self.steps;
            let mut observe = |t: f64, _: &[f64; N]| {
                steps.push(t);
                ControlFlow::Continue(())
            };
            let run = Integration::new(self.system, self.t, &self.x).observe(&mut observe);
            match run.run(&self.method, to) {
                Ok(done) => {
                    self.seen.evaluations += done.statistics.evaluations;
                    (self.t, self.x) = (to, done.state);
                }
                Err(error) => {
                    self.seen.evaluations += error.statistics.evaluations;
                    (self.t, self.x) = (error.time, error.state);
                    self.jump(&error.cause, to)?;
                }
            }
        }
        Some(())
    }

    /// Steps over a jump of the rates, where steps in doubles become too short for them; none where that is no jump.
    fn jump(&mut self, cause: &Cause, to: f64) -> Option<()> {
        let mut length = JUMP * self.spacing;
        // Where the last one was just before, that was too short.
        if let [.., before, after] = self.seen.landings[..] {
            let last = (after - before).abs();
            if (self.t - after).abs() <= last {
                length = 2.0 * last;
            }
        }
        if *cause != Cause::StepUnderflow || length > self.interval {
            return None;
        }
        let forwards = (to - self.t).signum();
        let next = if length >= (to - self.t).abs() { to } else { self.t + forwards * length };
        let (first, second) = (self.system.rhs(self.t, &self.x), self.system.rhs(next, &self.x));
        let h = next - self.t;
        let x = std::array::from_fn(|i| self.x[i] + 0.5 * h * (first[i] + second[i]));
        let change: [f64; N] = std::array::from_fn(|i| self.x[i] + h * (second[i] - first[i]));
        self.seen.uncertain += difference(&change, &self.x);
        self.seen.evaluations += 2;
        self.seen.abrupt += 1;
        self.seen.landings.extend([self.t, next]);
        self.steps.push(next);
        (self.t, self.x) = (next, x);
        x.iter().all(|x| x.is_finite()).then_some(())
    }
}

/// Equidistant times and the states there.
struct Points<const N: usize> {
    times: Vec<f64>,
    states: Vec<[f64; N]>,
}

impl<const N: usize> Points<N> {
    fn push(&mut self, t: f64, x: &[f64; N]) {
        self.times.push(t);
        self.states.push(*x);
    }

    fn keep_last(&mut self) {
        let all_but_one = self.times.len().saturating_sub(1);
        self.times.drain(..all_but_one);
        self.states.drain(..all_but_one);
    }

    /// Whether a step to `end` may have gone over something between these times.
    fn suspicion<S: System<f64, N>>(&self, system: &S, end: (f64, [f64; N])) -> Option<Suspicion<N>> {
        /// Intervals that are landed in before the first suspect and after the last one.
        const ROOM: usize = 3;
        let rates: Vec<[f64; N]> =
            self.times.iter().zip(&self.states).map(|(t, x)| system.rhs(*t, x)).collect();
        let mut suspects = (0..rates.len() - 1).filter(|k| self.off(*k, &rates) > SUSPECT);
        let first = suspects.next()?;
        let last = suspects.next_back().unwrap_or(first);
        let (from, to) = (first.saturating_sub(ROOM), last + 1 + ROOM);
        let mut landings: Vec<f64> = self.times.iter().take(to + 1).skip(from + 1).copied().collect();
        let claimed = self.states.get(to).copied().unwrap_or_else(|| {
            landings.extend((landings.last() != Some(&end.0)).then_some(end.0));
            end.1
        });
        Some(Suspicion { begin: (self.times[from], self.states[from]), landings, claimed })
    }

    /// Returns the difference between the change of the state in an interval and the integral of the rates.
    fn off(&self, k: usize, rates: &[[f64; N]]) -> f64 {
        /// The integral over the first, the second and the third of five intervals; the others are the mirrored ones.
        const WEIGHTS: [[f64; 6]; 3] = [
            [475.0, 1427.0, -798.0, 482.0, -173.0, 27.0],
            [-27.0, 637.0, 1022.0, -258.0, 77.0, -11.0],
            [11.0, -93.0, 802.0, 802.0, -93.0, 11.0],
        ];
        const DIVISOR: f64 = 1440.0;
        // Six points around the interval, as far in the middle as there are so many.
        let first = k.saturating_sub(2).min(rates.len() - 6);
        let place = k - first;
        let weight = |j: usize| if place < 3 { WEIGHTS[place][j] } else { WEIGHTS[4 - place][5 - j] };
        let h = self.times[k + 1] - self.times[k];
        let integrated = std::array::from_fn(|i| {
            let sum: f64 = (0..6).map(|j| weight(j) * rates[first + j][i]).sum();
            self.states[k][i] + h * sum / DIVISOR
        });
        difference(&integrated, &self.states[k + 1])
    }
}

/// Times within runs of short steps: much shorter than the length up to which steps make up half of the motion.
fn short_steps(ends: &[f64]) -> Vec<f64> {
    let length = |pair: &[f64]| (pair[1] - pair[0]).abs();
    let mut lengths: Vec<f64> = ends.windows(2).map(length).collect();
    lengths.sort_by(f64::total_cmp);
    let half = 0.5 * lengths.iter().sum::<f64>();
    let mut sum = 0.0;
    let usual = lengths.into_iter().find(|length| {
        sum += length;
        sum >= half
    });
    let limit = usual.unwrap_or(0.0) / SHORTER_THAN_USUAL;
    let mut found = Vec::new();
    let mut k = 0;
    while k + 1 < ends.len() {
        let begin = k;
        while k + 1 < ends.len() && length(&ends[k..k + 2]) < limit {
            k += 1;
        }
        if k - begin >= BEGINNING {
            let count = (k - begin).min(LANDINGS);
            found.extend((0..=count).map(|j| ends[begin + (k - begin) * j / count]));
        }
        k += 1;
    }
    found
}

fn difference<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let parts = a.iter().zip(b).map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
    parts.fold(0.0, |largest: f64, part| if part.is_nan() { f64::INFINITY } else { largest.max(part) })
}

#[cfg(test)]
mod tests {
    use guen_runtime::from_fn;

    use super::*;

    fn scanned<S: System<f64, 2>>(system: &S, times: &[f64], depth: ScanDepth) -> Option<Seen<2>> {
        let problem = Problem { start: &[1.0, 0.0], t0: 0.0, times, landings: &[] };
        scan(system, &problem, depth, &mut || true)
    }

    #[test]
    fn a_box_is_gone_through_from_edge_to_edge() {
        const FORCE: f64 = 3e3;
        let (on, off) = (33.29925, 33.30075);
        let kicked =
            from_fn(|t: f64, &[x, v]: &[f64; 2]| [v, -x + if (on..off).contains(&t) { FORCE } else { 0.0 }]);
        let seen = scanned(&kicked, &[20.0, 50.0], ScanDepth::At(1 << 16)).unwrap();
        // The force moves the place that the body turns around.
        let turned = |angle: f64, middle: f64, [x, v]: [f64; 2]| {
            let (sin, cos) = angle.sin_cos();
            let x = x - middle;
            [middle + x * cos + v * sin, v * cos - x * sin]
        };
        let exact = turned(50.0 - off, 0.0, turned(off - on, FORCE, turned(on, 0.0, [1.0, 0.0])));
        assert!(difference(&seen.states[0], &turned(20.0, 0.0, [1.0, 0.0])) < 1e-12);
        assert!(difference(&seen.states[1], &exact) < seen.uncertain && seen.uncertain < 1e-9);
        for edge in [on, off] {
            assert!(seen.landings.iter().any(|t| (t - edge).abs() < 1e-13), "{edge}: {:?}", seen.landings);
        }
        assert!(seen.abrupt >= 1 && seen.landings.len() < 60, "{:?}", seen.landings);
        // Without looking the same motion is without the kick.
        let blind = scanned(&kicked, &[50.0], ScanDepth::Nowhere(TOLERANCE)).unwrap();
        assert!(difference(&blind.states[0], &turned(50.0, 0.0, [1.0, 0.0])) < 1e-11);
    }

    #[test]
    fn rates_that_vary_as_fast_everywhere_cost_no_more_than_is_said() {
        let shaken = from_fn(|t: f64, &[x, v]: &[f64; 2]| [v, -x + (1e6 * t).sin()]);
        let seen = scanned(&shaken, &[50.0], ScanDepth::At(1 << 12));
        assert!(seen.is_none_or(|seen| seen.evaluations < 2 * MOST_EVALUATIONS));
    }

    #[test]
    fn backwards_and_nowhere() {
        let free = from_fn(|_: f64, &[_, v]: &[f64; 2]| [v, 0.0]);
        let seen = scanned(&free, &[-1.0, -2.0], ScanDepth::At(64)).unwrap();
        assert_eq!((seen.states, seen.landings), (vec![[1.0, 0.0]; 2], vec![]));
        assert_eq!(scanned(&free, &[0.0], ScanDepth::At(64)).unwrap().states, [[1.0, 0.0]]);
    }
}
