//! Pages as small as they have to be: where tracks do not fit, each of them keeps fewer samples.

use super::guests::Guest;
use super::track::{Shown, Track};
use super::{Link, MovingBody, MovingPoint, Panel, Viewer, page, phases};
use crate::error::StudyError;

/// The fewest samples of a track: four of a curve are its ends and extrema.
const FEWEST: usize = 4;

/// The number of times that a page is made anew because it came out larger than estimated.
const ATTEMPTS: usize = 4;

/// The part of the room by which it is too large at least, if the page does not fit.
const SLACK: usize = 500;

/// The number of samples of each track, and the bytes of one.
fn sizes<const N: usize>(viewer: &Viewer<'_, N>) -> Vec<(usize, usize)> {
    fn size<T: Shown>(track: &Track<T>) -> (usize, usize) {
        (track.values.len(), track.bytes_each())
    }
    let bodies = viewer.all_bodies().map(|body| size(&body.poses));
    let paths = viewer.all_paths().map(|path| size(&path.points));
    let links = viewer.all_links().map(|link| size(&link.ends));
    let curves = viewer.all_curves().map(|curve| size(&curve.values));
    bodies.chain(paths).chain(links).chain(curves).collect()
}

/// The bytes of all samples in the file.
pub(super) fn data_bytes<const N: usize>(viewer: &Viewer<'_, N>) -> usize {
    let guests = viewer.guests.iter().map(|guest| guest.steps.len()).sum::<usize>();
    sizes(viewer).iter().map(|(count, each)| count * each).sum::<usize>()
        + (viewer.samples.steps.len() + guests) * 32 / 3
        + phases::bytes(&viewer.marks, &viewer.words)
        + viewer.guests.iter().map(|guest| phases::bytes(&guest.marks, &guest.words)).sum::<usize>()
}

/// The largest number of samples a track with which all samples have at most so many bytes.
fn room(sizes: &[(usize, usize)], bytes: usize) -> usize {
    // A track that is thinned gets times of its own.
    let total =
        |most: usize| sizes.iter().map(|(count, each)| (*count).min(most) * (each + 32 / 3)).sum::<usize>();
    let (mut low, mut high) = (0, sizes.iter().map(|(count, _)| *count).max().unwrap_or(0));
    while low < high {
        let middle = (low + high).div_ceil(2);
        if total(middle) <= bytes {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    low
}

/// Leaves at most so many bytes of samples, or the fewest samples.
fn shrink<const N: usize>(viewer: &mut Viewer<'_, N>, bytes: usize) {
    let most = room(&sizes(viewer), bytes).max(FEWEST);
    let Viewer { bodies, paths, links, panels, .. } = viewer;
    shrink_tracks((bodies, paths, links, panels), most, &viewer.samples.times);
    shrink_steps(&mut viewer.samples.steps, bytes);
    for Guest { bodies, paths, links, panels, times, steps, .. } in &mut viewer.guests {
        shrink_tracks((bodies, paths, links, panels), most, times);
        shrink_steps(steps, bytes);
    }
}

/// Leaves at most so many samples of each track of a run with these times.
fn shrink_tracks(
    (bodies, paths, links, panels): (&mut [MovingBody], &mut [MovingPoint], &mut [Link], &mut [Panel]),
    most: usize,
    times: &[f64],
) {
    for body in bodies {
        body.poses.shrink(most, times);
    }
    for path in paths {
        path.points.shrink(most, times);
    }
    for link in links {
        link.ends.shrink(most, times);
    }
    for curve in panels.iter_mut().flat_map(|panel| &mut panel.curves) {
        curve.values.shrink(most, times);
    }
}

/// Leaves so many times to step through that they take an eighth of so many bytes.
fn shrink_steps(steps: &mut Vec<f64>, bytes: usize) {
    let stride = (steps.len() * 32 / 3).div_ceil((bytes / 8).max(1)).max(1);
    if stride > 1 {
        let last = steps.last().copied();
        *steps = steps.iter().copied().step_by(stride).collect();
        if steps.last().copied() != last {
            steps.extend(last);
        }
    }
}

/// Keeps a description from growing far beyond the file that will be made of it.
pub(super) fn relieve<const N: usize>(viewer: &mut Viewer<'_, N>) {
    if viewer.samples.most.is_some() && data_bytes(viewer) > viewer.limit.saturating_mul(2) {
        let limit = viewer.limit;
        shrink(viewer, limit);
    }
}

/// The page, at most as large as it may be.
pub(super) fn fitting<const N: usize>(viewer: &Viewer<'_, N>) -> Result<String, StudyError> {
    page::check(viewer)?;
    let limit = viewer.limit;
    let too_large = |bytes: usize| StudyError::TooLarge { title: viewer.title.clone(), bytes, limit };
    let mut budget = limit.checked_sub(page::own_bytes()).ok_or_else(|| too_large(page::own_bytes()))?;
    if data_bytes(viewer) <= budget {
        let page = page::html(viewer);
        if page.len() <= limit {
            return Ok(page);
        }
        budget = budget.saturating_sub(page.len() - limit);
    }
    let mut bytes = 0;
    for attempt in 0..ATTEMPTS {
        let mut smaller = viewer.clone();
        shrink(&mut smaller, budget);
        let page = page::html(&smaller);
        bytes = page.len();
        if bytes <= limit {
            return Ok(page);
        }
        // A little less as well, and more each time: what is over may be less than one sample of each track.
        budget = budget.saturating_sub(bytes - limit + ((budget / SLACK) << attempt));
    }
    Err(too_large(bytes))
}
