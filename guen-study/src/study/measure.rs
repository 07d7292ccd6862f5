//! Measures of error.

use std::rc::Rc;

use guen_runtime::{Invariants, Real};

use super::digits71::Digits71;

/// A function of time and state.
pub(super) type Output<const N: usize> = Rc<dyn Fn(f64, &[f64; N]) -> f64>;

/// A function that returns the invariants of a state, in the long real.
pub(super) type Tells<const N: usize> = Box<dyn Fn(Digits71, &[Digits71; N]) -> Invariants<Digits71>>;

/// The measure of error: see the methods of [`Study`](super::Study) that set it.
#[derive(Clone)]
pub(super) enum Measure<const N: usize> {
    EndState,
    Trajectory,
    Output { name: String, function: Output<N> },
    Energy,
    Residual,
}

impl<const N: usize> Measure<N> {
    pub fn text(&self) -> String {
        match self {
            Self::EndState => "the end state".to_owned(),
            Self::Trajectory => "the states at all sample times".to_owned(),
            Self::Output { name, .. } => format!("`{name}` at all sample times"),
            Self::Energy => "the change of the energy at all sample times, relative to |T| + |U|".to_owned(),
            Self::Residual => "the left sides of the constraints on positions at all sample times".to_owned(),
        }
    }

    /// Whether the error is measured against a reference.
    pub fn needs_reference(&self) -> bool {
        matches!(self, Self::EndState | Self::Trajectory | Self::Output { .. })
    }
}

/// The sizes that errors of the entries are relative to: given, or `max(1, |reference|)`.
pub(super) type Scales<const N: usize> = Option<[f64; N]>;

/// The error of a run against the reference states at the same times: the largest over times and entries. Not a number
/// becomes infinite.
pub(super) fn against<const N: usize>(
    measure: &Measure<N>,
    scales: &Scales<N>,
    times: &[f64],
    states: impl Iterator<Item = [Digits71; N]>,
    reference: &[[Digits71; N]],
) -> f64 {
    let mut largest = 0.0;
    for ((&t, state), exact) in times.iter().zip(states).zip(reference) {
        match measure {
            Measure::Output { function, .. } => {
                let value = function(t, &state.map(Real::to_f64));
                let expected = function(t, &exact.map(Real::to_f64));
                take(&mut largest, (value - expected).abs() / expected.abs().max(1.0));
            }
            _ => {
                for i in 0..N {
                    let scale = scales.map_or_else(|| exact[i].to_f64().abs().max(1.0), |scales| scales[i]);
                    take(&mut largest, (state[i] - exact[i]).abs().to_f64() / scale);
                }
            }
        }
    }
    largest
}

/// The error of a run that needs no reference: what the system should keep, and did not.
pub(super) fn kept<const N: usize>(
    measure: &Measure<N>,
    tells: &Tells<N>,
    (t0, start): (f64, &[f64; N]),
    times: &[f64],
    states: &[[f64; N]],
) -> f64 {
    let at = |t: f64, x: &[f64; N]| tells(Digits71::from_f64(t), &x.map(Digits71::from_f64));
    let first = at(t0, start);
    let mut scale = first.scale.to_f64();
    let mut largest = 0.0;
    for (&t, state) in times.iter().zip(states) {
        let now = at(t, state);
        match (measure, first.energy, now.energy) {
            (Measure::Energy, Some(before), Some(after)) => {
                scale = scale.max(now.scale.to_f64());
                take(&mut largest, (after - before).abs().to_f64() / scale);
            }
            _ => take(&mut largest, now.residual.abs().to_f64()),
        }
    }
    largest
}

fn take(largest: &mut f64, error: f64) {
    *largest = if error.is_nan() { f64::INFINITY } else { largest.max(error) };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn long(values: [f64; 2]) -> [Digits71; 2] {
        values.map(Digits71::from_f64)
    }

    #[test]
    fn large_entries_count_relative_and_small_ones_absolute() {
        let reference = [long([100.0, 0.01])];
        let error = |state, scales: &Scales<2>| {
            against(&Measure::EndState, scales, &[1.0], [long(state)].into_iter(), &reference)
        };
        assert!((error([101.0, 0.01], &None) - 0.01).abs() < 1e-15);
        assert!((error([100.0, 0.02], &None) - 0.01).abs() < 1e-15);
        // Weights of the user's own.
        assert!((error([101.0, 0.02], &Some([1e3, 1e-2])) - 1.0).abs() < 1e-12);
        assert_eq!(error([f64::NAN, 0.01], &None), f64::INFINITY);
    }

    #[test]
    fn not_a_number_stays_the_worst() {
        let mut largest = 0.0;
        for error in [1.0, f64::NAN, 2.0] {
            take(&mut largest, error);
        }
        assert_eq!(largest, f64::INFINITY);
    }
}
