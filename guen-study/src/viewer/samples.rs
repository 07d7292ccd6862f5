//! The samples of a recording in the order of time, and the tracks that are made of them.

use super::drawable::is_drawable;
use super::track::{Shown, Track};
use crate::recording::Recording;

/// A recording as a page needs it: forwards in time.
#[derive(Clone, Debug)]
pub(super) struct Samples<'a, const N: usize> {
    recording: &'a Recording<N>,
    is_backwards: bool,
    /// The time of the first one.
    pub(super) start: f64,
    /// The times, since the first.
    pub(super) times: Vec<f64>,
    /// The times that the page steps through.
    pub(super) steps: Vec<f64>,
    /// The most values of a track; nothing if all are to be kept.
    pub(super) most: Option<usize>,
    /// The first time that is not finite or not after the one before.
    pub(super) disorder: Option<f64>,
}

impl<'a, const N: usize> Samples<'a, N> {
    /// Keeps all samples if these are at most `shown` or no bound is given, else at most `most` a track.
    pub(super) fn new(recording: &'a Recording<N>, bounds: Option<(usize, usize)>) -> Self {
        let given = recording.times();
        // A run backwards in time is shown forwards.
        let is_backwards = matches!(given, [first, .., last] if last < first);
        let count = given.len();
        let at = |k: usize| given[if is_backwards { count - 1 - k } else { k }];
        let start = if count > 0 { at(0) } else { 0.0 };
        let disorder = (0..count).find(|&k| !is_drawable(&[at(k)]) || k > 0 && at(k) <= at(k - 1)).map(at);
        let times: Vec<f64> = (0..count).map(|k| at(k) - start).collect();
        let bounds = bounds.filter(|(shown, _)| count > *shown && disorder.is_none());
        let steps = match bounds {
            None => times.clone(),
            Some((shown, _)) => {
                let mut steps: Vec<f64> = recording.spread(shown).map(|(t, _)| t - start).collect();
                if is_backwards {
                    steps.reverse();
                }
                steps
            }
        };
        Self { recording, is_backwards, start, times, steps, most: bounds.map(|(_, most)| most), disorder }
    }

    pub(super) fn len(&self) -> usize {
        self.times.len()
    }

    /// The names of the entries of a state.
    pub(super) fn names(&self) -> &'static [&'static str] {
        self.recording.names()
    }

    pub(super) fn units(&self) -> &'static [&'static str] {
        self.recording.units()
    }

    /// Samples that the run has shown, kept in the recording or not.
    pub(super) fn seen(&self) -> u64 {
        self.recording.seen()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (f64, &'a [f64; N])> + Clone + use<'a, N> {
        let (recording, is_backwards, count) = (self.recording, self.is_backwards, self.len());
        (0..count).map(move |k| {
            let k = if is_backwards { count - 1 - k } else { k };
            (recording.times()[k], &recording.states()[k])
        })
    }

    pub(super) fn first(&self) -> Option<(f64, &'a [f64; N])> {
        self.iter().next()
    }

    /// A track of values at all samples.
    ///
    /// # Errors
    ///
    /// The first time whose value is not sound.
    pub(super) fn track<T: Shown>(
        &self,
        values: Vec<T>,
        is_sound: impl Fn(&T) -> bool,
    ) -> Result<Track<T>, f64> {
        if let Some(k) = values.iter().position(|value| !is_sound(value)) {
            return Err(self.start + self.times[k]);
        }
        Ok(match self.most {
            Some(most) if self.len() > 2 => Track::thinned(&self.times, &values, most),
            _ => Track::whole(values),
        })
    }
}
