//! States nearby: where else a setting has to be as good as it was where it was measured.

use std::ops::Range;

use guen_runtime::Real;

use super::digits71::Digits71;
use super::known::{Scanner, landings_elsewhere};
use super::measure::{Measure, Tells, against, kept};
use super::reference::{Problem, Source};
use super::{Scales, lengthened};

/// A state with the truth from there.
pub(super) struct Probe<const N: usize> {
    pub start: [f64; N],
    /// Empty where the measure needs no reference.
    pub reference: Vec<[Digits71; N]>,
}

/// A state that violates the constraints by more than the one it was made of, and by more than this, is no state of the
/// system.
const RESIDUAL: f64 = 1e-9;
/// The size of an entry below which it is moved by an absolute amount.
const ABSOLUTE_BELOW: f64 = 1.0 / 3.0;

/// Numbers in `[-1, 1)`, always the same: Knuth's multiplicative generator of 64 bits.
pub(super) struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Moves every entry at random, by at most `spread max(|x|, 1/3)`.
pub(super) fn moved<const N: usize>(state: &[f64; N], spread: f64, draw: &mut Draw) -> [f64; N] {
    state.map(|x| x + spread * x.abs().max(ABSOLUTE_BELOW) * draw.next())
}

/// Returns as many states around the initial ones as asked for: moved ones, unless that violates a constraint on
/// positions, and else states of the same motion, out of `along`.
pub(super) fn states<const N: usize>(
    starts: &[[f64; N]],
    along: &[[f64; N]],
    t0: f64,
    tells: &Tells<N>,
    (count, spread): (usize, f64),
) -> Vec<[f64; N]> {
    let mut draw = Draw::new(1969);
    let t0 = Digits71::from_f64(t0);
    let residual = |state: &[f64; N]| tells(t0, &lengthened(state)).residual.abs().to_f64();
    let allowed = starts.iter().map(residual).fold(RESIDUAL, f64::max);
    let mut later = along.iter().filter(|state| residual(state) <= allowed);
    let mut found = Vec::with_capacity(count);
    for start in starts.iter().cycle().take(if starts.is_empty() { 0 } else { count }) {
        let state = moved(start, spread, &mut draw);
        if residual(&state) <= allowed {
            found.push(state);
        } else if let Some(state) = later.next() {
            found.push(*state);
        }
    }
    found
}

/// The states with their references; those are left out from where none can be computed, because the motion leaves the
/// chart, and those whose motions cannot be looked at where the study's own were. Stops early where `watch` says so.
pub(super) fn with_references<const N: usize>(
    states: impl IntoIterator<Item = [f64; N]>,
    measure: &Measure<N>,
    (t0, times): (f64, &[f64]),
    source: &Source<N>,
    (scanner, landings, points, scanned): (&Scanner<N>, &[f64], usize, bool),
    watch: &mut dyn FnMut() -> bool,
) -> Vec<Probe<N>> {
    let mut probes = Vec::new();
    for start in states {
        if !watch() {
            break;
        }
        if !measure.needs_reference() {
            probes.push(Probe { start, reference: Vec::new() });
            continue;
        }
        let problem = Problem { start: &start, t0, times, landings };
        // What could not be looked at from the states of the study is not tried again.
        let found = if scanned {
            landings_elsewhere(scanner, &problem, points, watch)
        } else {
            Some(landings.to_vec())
        };
        let Some(landings) = found else { continue };
        let problem = Problem { landings: &landings, ..problem };
        if let Ok(reference) = source(&problem, &mut |_| watch()) {
            probes.push(Probe { start, reference });
        }
    }
    probes
}

/// The error of states at the times, against the probe's reference or by what the system keeps.
pub(super) fn error_of<const N: usize>(
    probe: &Probe<N>,
    states: &[[f64; N]],
    measure: &Measure<N>,
    scales: &Scales<N>,
    tells: &Tells<N>,
    (t0, times): (f64, &[f64]),
) -> f64 {
    if measure.needs_reference() {
        against(measure, scales, times, states.iter().map(lengthened), &probe.reference)
    } else {
        kept(measure, tells, (t0, &probe.start), times, states)
    }
}

/// The span of `times` moved to begin and end elsewhere.
pub(super) fn times_for(span: &Range<f64>, samples: usize) -> Vec<f64> {
    super::sample_times(span.start, span.end, samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_fill_their_range_evenly() {
        let mut draw = Draw::new(1);
        let values: Vec<f64> = (0..10_000).map(|_| draw.next()).collect();
        assert!(values.iter().all(|x| (-1.0..1.0).contains(x)));
        let mean = values.iter().sum::<f64>() / 1e4;
        let square = values.iter().map(|x| x * x).sum::<f64>() / 1e4;
        assert!(mean.abs() < 0.03 && (square - 1.0 / 3.0).abs() < 0.02, "{mean} {square}");
    }

    #[test]
    fn moved_states_stay_near() {
        let mut draw = Draw::new(2);
        for _ in 0..100 {
            let [a, b] = moved(&[10.0, 0.0], 0.3, &mut draw);
            assert!((a - 10.0).abs() <= 3.0 && b.abs() <= 0.1 && b != 0.0);
        }
    }

    #[test]
    fn constraints_leave_states_of_the_motion_only() {
        // On the circle x^2 + y^2 = 1.
        let tells: Tells<2> = Box::new(|_, &[x, y]| guen_runtime::Invariants {
            residual: x * x + y * y - Digits71::one(),
            ..Default::default()
        });
        let along = [[0.6, 0.8], [2.0, 0.0], [0.0, 1.0]];
        let found = states(&[[1.0, 0.0]], &along, 0.0, &tells, (8, 0.3));
        assert_eq!(found, [[0.6, 0.8], [0.0, 1.0]]);
    }
}
