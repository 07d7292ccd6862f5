//! Tracks: what one thing on the page shows over time, at those samples that are kept.

use super::shape::Pose;
use super::thin::{Chosen, extrema, refined};
use super::turn::{Turn, norm};

/// A place is drawn within this part of the track's own size: half a pixel where it fills 2000 of them.
pub(super) const PLACE: f64 = 1.0 / 4000.0;

/// An orientation is drawn within this angle, in radians.
pub(super) const ANGLE: f64 = 0.01;

/// A curve is drawn within this part of its range.
const VALUE: f64 = 1.0 / 2000.0;

/// The part of a number within which a difference is rounding, and no motion.
const NUMBER_ROUNDING: f64 = 1e-12;

/// Values over time.
#[derive(Clone, Debug, Default)]
pub(super) struct Track<T> {
    /// The times of the values, since the first; nothing if these are the page's own.
    pub(super) times: Option<Vec<f64>>,
    pub(super) values: Vec<T>,
    /// The largest deviation of what is left out, in units of its tolerance.
    pub(super) miss: f64,
    /// Whether only the envelope of a curve is here, and not each of its extrema.
    pub(super) is_envelope: bool,
}

/// A value of a track, as the page holds it.
pub(super) trait Shown: Copy {
    /// The reals on the page.
    const WIDTH: usize;

    /// The places in it.
    fn places(&self) -> impl Iterator<Item = [f64; 3]>;

    /// The numbers of the samples to keep.
    fn chosen(times: &[f64], values: &[Self], most: usize) -> (Chosen, bool);
}

/// The sample between two others that is farthest from what is drawn between these, and how far it is; of every `stride`th one.
/// `square` is the square of a sample's deviation, at a part of the way between the two.
fn worst_between<T: Copy>(
    times: &[f64],
    values: &[T],
    (a, b, stride): (usize, usize, usize),
    mut square: impl FnMut(f64, T) -> f64,
) -> (usize, f64) {
    let (start, scale) = (times[a], 1.0 / (times[b] - times[a]));
    let mut worst = (a + 1, 0.0);
    for k in (a + 1..b).step_by(stride) {
        let found = square((times[k] - start) * scale, values[k]);
        if found > worst.1 {
            worst = (k, found);
        }
    }
    (worst.0, worst.1.sqrt())
}

/// A point on the way from one to another.
pub(super) fn between(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * part)
}

/// The square of a distance, each length as many times as large.
fn distance_squared(a: [f64; 3], b: [f64; 3], factor: f64) -> f64 {
    let [x, y, z] = super::shape::difference(a, b).map(|e| e * factor);
    x * x + y * y + z * z
}

/// Returns the distance within which a track's places have to be drawn.
fn tolerance(places: impl Iterator<Item = [f64; 3]>) -> f64 {
    let (least, most) = bounds(places);
    let size = norm(super::shape::difference(most, least));
    let far = least.into_iter().chain(most).map(f64::abs).fold(0.0, f64::max);
    (PLACE * size).max(NUMBER_ROUNDING * far).max(f64::MIN_POSITIVE)
}

/// The box around points: its corners, which are infinite if there is no point.
pub(super) fn bounds(points: impl Iterator<Item = [f64; 3]>) -> ([f64; 3], [f64; 3]) {
    points.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(least, most), p| {
        (std::array::from_fn(|i| f64::min(least[i], p[i])), std::array::from_fn(|i| f64::max(most[i], p[i])))
    })
}

impl Shown for Pose {
    const WIDTH: usize = 7;

    fn places(&self) -> impl Iterator<Item = [f64; 3]> {
        [self.place].into_iter()
    }

    fn chosen(times: &[f64], values: &[Self], most: usize) -> (Chosen, bool) {
        let nearness = 1.0 / tolerance(values.iter().map(|pose| pose.place));
        let worst = |a: usize, b: usize, stride: usize| {
            let (from, to) = (values[a], values[b]);
            let turn = Turning::new(from.turn, to.turn);
            worst_between(times, values, (a, b, stride), |part, pose| {
                let place = distance_squared(between(from.place, to.place, part), pose.place, nearness);
                place.max(4.0 / (ANGLE * ANGLE) * turn.chord_squared(part, pose.turn))
            })
        };
        (refined(values.len(), [], most, worst), false)
    }
}

/// The shortest turn from one orientation to another, as the page makes it: `from` by `cos`, `across` by `sin` of a part of the angle.
pub(super) struct Turning {
    from: Turn,
    /// A unit quaternion normal to `from`; zero where there is no turn.
    across: Turn,
    angle: f64,
}

impl Turning {
    pub(super) fn new(from: Turn, to: Turn) -> Self {
        let cosine: f64 = from.dot(to);
        let to = if cosine < 0.0 { Turn(to.0.map(|e| -e)) } else { to };
        let cosine = cosine.abs().min(1.0);
        let rest = Turn(std::array::from_fn(|i| to.0[i] - cosine * from.0[i]));
        let sine = rest.dot(rest).sqrt();
        let across = Turn(rest.0.map(|e| if sine > 0.0 { e / sine } else { 0.0 }));
        Self { from, across, angle: sine.atan2(cosine) }
    }

    pub(super) fn at(&self, part: f64) -> Turn {
        let (sine, cosine) = (part * self.angle).sin_cos();
        Turn(std::array::from_fn(|i| cosine * self.from.0[i] + sine * self.across.0[i]))
    }

    /// The square of the chord from an orientation to that at a part of the turn, to 2e-7.
    fn chord_squared(&self, part: f64, turn: Turn) -> f64 {
        let (sine, cosine) = sine_cosine(part * self.angle);
        2.0 - 2.0 * (cosine * self.from.dot(turn) + sine * self.across.dot(turn)).abs().min(1.0)
    }
}

/// Sine and cosine of an angle from 0 to a right one by their series, to 6e-8: several times quicker than to the last digit.
fn sine_cosine(x: f64) -> (f64, f64) {
    // Each term is the one before by minus the square over these: 2 3, 4 5, .. and 1 2, 3 4, ..
    const SINE: [f64; 5] = [1.0 / 6.0, 1.0 / 20.0, 1.0 / 42.0, 1.0 / 72.0, 1.0 / 110.0];
    const COSINE: [f64; 6] = [1.0 / 2.0, 1.0 / 12.0, 1.0 / 30.0, 1.0 / 56.0, 1.0 / 90.0, 1.0 / 132.0];
    let y = x * x;
    let series = |steps: &[f64]| steps.iter().rev().fold(1.0, |rest, step| 1.0 - (y * step) * rest);
    (x * series(&SINE), series(&COSINE))
}

impl Shown for [f64; 3] {
    const WIDTH: usize = 3;

    fn places(&self) -> impl Iterator<Item = [f64; 3]> {
        [*self].into_iter()
    }

    fn chosen(times: &[f64], values: &[Self], most: usize) -> (Chosen, bool) {
        let nearness = 1.0 / tolerance(values.iter().copied());
        let worst = |a: usize, b: usize, stride: usize| {
            let (from, to) = (values[a], values[b]);
            worst_between(times, values, (a, b, stride), |part, place| {
                distance_squared(between(from, to, part), place, nearness)
            })
        };
        (refined(values.len(), [], most, worst), false)
    }
}

impl Shown for [[f64; 3]; 2] {
    const WIDTH: usize = 6;

    fn places(&self) -> impl Iterator<Item = [f64; 3]> {
        (*self).into_iter()
    }

    fn chosen(times: &[f64], values: &[Self], most: usize) -> (Chosen, bool) {
        let nearness = [0, 1].map(|end| 1.0 / tolerance(values.iter().map(|ends| ends[end])));
        let worst = |a: usize, b: usize, stride: usize| {
            let (from, to) = (values[a], values[b]);
            worst_between(times, values, (a, b, stride), |part, ends| {
                let miss = |end: usize| {
                    distance_squared(between(from[end], to[end], part), ends[end], nearness[end])
                };
                miss(0).max(miss(1))
            })
        };
        (refined(values.len(), [], most, worst), false)
    }
}

impl Shown for f64 {
    const WIDTH: usize = 1;

    fn places(&self) -> impl Iterator<Item = [f64; 3]> {
        [].into_iter()
    }

    fn chosen(times: &[f64], values: &[Self], most: usize) -> (Chosen, bool) {
        let (low, high) = range(values);
        let near =
            (VALUE * (high - low)).max(NUMBER_ROUNDING * low.abs().max(high.abs())).max(f64::MIN_POSITIVE);
        let nearness = 1.0 / near;
        let (required, all) = extrema(times, values, most);
        let worst = |a: usize, b: usize, stride: usize| {
            let (from, to) = (values[a], values[b]);
            worst_between(times, values, (a, b, stride), |part, value| {
                ((from + (to - from) * part - value) * nearness).powi(2)
            })
        };
        // Inside the parts of an envelope the curve is not followed.
        let most = if all { most } else { required.len() };
        (refined(values.len(), required, most, worst), !all)
    }
}

/// The least and the greatest of numbers.
pub(super) fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}

impl<T: Shown> Track<T> {
    /// Every value, at the page's own times.
    pub(super) fn whole(values: Vec<T>) -> Self {
        Self { times: None, values, miss: 0.0, is_envelope: false }
    }

    /// Returns at most `most` of values, with times of their own.
    pub(super) fn thinned(times: &[f64], values: &[T], most: usize) -> Self {
        let (Chosen { kept, miss }, is_envelope) = T::chosen(times, values, most);
        Self {
            times: Some(kept.iter().map(|k| times[*k]).collect()),
            values: kept.iter().map(|k| values[*k]).collect(),
            miss,
            is_envelope,
        }
    }

    /// Bytes of a value in the file: single precision, a time in double where it has its own, three bytes as four letters.
    pub(super) fn bytes_each(&self) -> usize {
        (4 * T::WIDTH + if self.times.is_some() { 8 } else { 0 }) * 4 / 3
    }

    /// Leaves at most `most` values; what was left out before stays so.
    pub(super) fn shrink(&mut self, most: usize, own: &[f64]) {
        if self.values.len() > most {
            let times = self.times.as_deref().unwrap_or(own);
            let less = Self::thinned(times, &self.values, most);
            *self = Self {
                miss: self.miss + less.miss,
                is_envelope: self.is_envelope || less.is_envelope,
                ..less
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_are_those_of_the_turns_themselves() {
        let to = |k: f64| Turn::about([k.sin(), (2.0 * k).cos(), 0.3], 3.0 * k.sin());
        for k in (0..200).map(f64::from) {
            let turning = Turning::new(to(k), to(k + 1.0));
            assert!(turning.at(0.0).angle(to(k)) < 1e-7 && turning.at(1.0).angle(to(k + 1.0)) < 1e-7);
            for part in [0.0, 0.2, 0.7, 1.0] {
                let exact = turning.at(part).chord(to(3.0 * k)).powi(2);
                assert!((turning.chord_squared(part, to(3.0 * k)) - exact).abs() < 2e-7, "{k} {part}");
            }
        }
    }

    /// The pose that the page shows at a time.
    fn shown(track: &Track<Pose>, time: f64) -> Pose {
        let times = track.times.as_ref().unwrap();
        let k = times.partition_point(|t| *t <= time).clamp(1, times.len() - 1) - 1;
        let part = (time - times[k]) / (times[k + 1] - times[k]);
        let (a, b) = (track.values[k], track.values[k + 1]);
        Pose { place: between(a.place, b.place, part), turn: Turning::new(a.turn, b.turn).at(part) }
    }

    #[test]
    fn a_fast_wheel_on_a_long_way_turns_as_it_does() {
        let times: Vec<f64> = (0..200_000).map(|k| 1e-4 * f64::from(k)).collect();
        // The whole way takes 20 s; the wheel turns at 300 rad/s, and stops for a moment.
        let at = |t: f64| {
            let angle = 300.0 * t + 100.0 * (t - 10.0).tanh();
            Pose::at([t, t.sin(), 0.0]).turned([0.0, 1.0, 0.0], angle)
        };
        let poses: Vec<Pose> = times.iter().map(|t| at(*t)).collect();
        let track = Track::thinned(&times, &poses, 20_000);
        assert!(track.miss <= 1.0 && track.values.len() < 5000, "{} {}", track.miss, track.values.len());
        for (t, pose) in times.iter().zip(&poses) {
            let shown = shown(&track, *t);
            assert!(shown.turn.angle(pose.turn) <= 1.001 * ANGLE, "at {t}");
            assert!(distance_squared(shown.place, pose.place, 1.0).sqrt() < 20.1 * PLACE, "at {t}");
        }
    }

    #[test]
    fn a_track_at_rest_far_away_needs_two_samples_of_its_own() {
        let times: Vec<f64> = (0..10_000).map(f64::from).collect();
        let noise: Vec<[f64; 3]> = times.iter().map(|t| [6.4e6 + 1e-9 * (t * t).sin(), 0.0, 0.0]).collect();
        let track = Track::thinned(&times, &noise, 5000);
        assert!(track.values.len() <= 257, "{}", track.values.len());
    }

    #[test]
    fn what_was_kept_can_be_thinned_again() {
        let times: Vec<f64> = (0..50_000).map(f64::from).collect();
        let values: Vec<f64> = times.iter().map(|t| (t * 0.7).sin() + 1e-4 * t).collect();
        let mut track = Track::thinned(&times, &values, 8000);
        assert!(track.is_envelope && track.values.len() <= 8000);
        track.shrink(400, &[]);
        assert!(track.values.len() <= 400);
        let (low, high) = range(&track.values);
        assert_eq!((low, high), range(&values));
    }
}
