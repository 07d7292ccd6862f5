//! Notes of a page about its data: what was left out, by which rule, and how near the rest is.

use super::Viewer;
use super::page::Space;
use super::track::{ANGLE, PLACE, Shown, Track};

/// A turn between samples from which on one cannot be sure which way it went, in degrees.
const WIDE_TURN: f64 = 90.0;

/// The sentences below the title.
pub(super) fn of<const N: usize>(viewer: &Viewer<'_, N>, space: &Space) -> Vec<String> {
    [viewer.told_ends(), lost(viewer), thinned(viewer), turns(viewer), moved(space), forces(space)]
        .into_iter()
        .flatten()
        .collect()
}

/// The number of samples that the recording itself did not keep.
fn lost<const N: usize>(viewer: &Viewer<'_, N>) -> Option<String> {
    let (kept, seen) = (viewer.samples.len(), viewer.samples.seen());
    if seen == 1 {
        return Some("The recording has one sample: nothing moves.".to_owned());
    }
    (seen > kept as u64).then(|| format!("The recording kept {kept} of the {seen} samples of the run."))
}

/// The number of samples that are shown, and the rule.
fn thinned<const N: usize>(viewer: &Viewer<'_, N>) -> Option<String> {
    let mut told = Told { least: usize::MAX, ..Told::default() };
    viewer.all_bodies().for_each(|body| told.motion(&body.poses));
    viewer.all_paths().for_each(|path| told.motion(&path.points));
    viewer.all_links().for_each(|link| told.motion(&link.ends));
    viewer.all_curves().for_each(|curve| told.curve(&curve.values));
    if !told.is_thinned {
        return None;
    }
    let runs =
        || std::iter::once(viewer.samples.len()).chain(viewer.guests.iter().map(|guest| guest.times.len()));
    let (fewest, most) = (runs().min().unwrap_or(0), runs().max().unwrap_or(0));
    let all = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
    let count = if told.least == told.most {
        told.most.to_string()
    } else {
        format!("{} to {}", told.least, told.most)
    };
    let mut text = format!("Shown are {count} of {all} samples.");
    if told.has_motion {
        text += &format!(
            " Places are drawn within {} % of their track's size and turns within {}° of all samples.",
            digits(100.0 * PLACE * told.miss.max(1.0)),
            digits((ANGLE * told.miss.max(1.0)).to_degrees().min(180.0))
        );
    }
    if told.has_curves {
        text += if told.has_envelopes {
            " Curves show the least and the greatest value of each small part of the time."
        } else {
            " Curves show each of their minima and maxima."
        };
    }
    Some(text)
}

#[derive(Default)]
struct Told {
    least: usize,
    most: usize,
    is_thinned: bool,
    has_motion: bool,
    miss: f64,
    has_curves: bool,
    has_envelopes: bool,
}

impl Told {
    fn any<T>(&mut self, track: &Track<T>) -> bool {
        self.least = self.least.min(track.values.len());
        self.most = self.most.max(track.values.len());
        self.is_thinned |= track.times.is_some();
        track.times.is_some()
    }

    fn motion<T: Shown>(&mut self, track: &Track<T>) {
        if self.any(track) {
            self.has_motion = true;
            self.miss = self.miss.max(track.miss);
        }
    }

    fn curve(&mut self, track: &Track<f64>) {
        if self.any(track) {
            self.has_curves = true;
            self.has_envelopes |= track.is_envelope;
        }
    }
}

/// Samples so far apart that turns are guessed.
fn turns<const N: usize>(viewer: &Viewer<'_, N>) -> Option<String> {
    let degrees = viewer.all_bodies().map(|body| body.largest_turn.to_degrees()).fold(0.0, f64::max);
    (degrees.round() > WIDE_TURN)
        .then(|| format!("Samples are far apart: a body turns by {degrees:.0}° or more between two of them."))
}

/// The origin that was subtracted.
fn moved(space: &Space) -> Option<String> {
    let [x, y, z] = space.origin?;
    Some(format!("Places are relative to ({x}, {y}, {z})."))
}

/// The scale of forces.
fn forces(space: &Space) -> Option<String> {
    let scale = space.per_force?;
    Some(format!("Arrows of forces have the length {} for a force of 1.", digits(scale)))
}

/// Two digits.
fn digits(value: f64) -> String {
    crate::table::significant(value, 2)
}
