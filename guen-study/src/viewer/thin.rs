//! The choice of the samples of a track that are shown: those without which the picture would be another one.

use std::cmp::Ordering;

/// Spans that a track is cut into before it is refined, so that the work stays near the number of samples.
const SPANS: usize = 256;

/// Samples of a longer span that are looked at first: where one of them is drawn too badly, the others need no look.
const PROBES: usize = 48;

/// Samples that stand for all of a track.
pub(super) struct Chosen {
    /// The numbers of the samples, rising, with the first and the last.
    pub(super) kept: Vec<usize>,
    /// The largest deviation of a sample that is left out from what is drawn there, in units of the tolerance.
    pub(super) miss: f64,
}

/// A span between two kept samples, and the sample in it that is drawn worst.
struct Span {
    miss: f64,
    from: usize,
    worst: usize,
    to: usize,
    /// Whether all samples were looked at; else there may be worse ones.
    is_exact: bool,
}

/// Spans that are drawn outside of the tolerance, the worst ones first: by ranks that are a quarter of a factor of two wide, so
/// that none has to be sorted.
#[derive(Default)]
struct Queue {
    ranks: Vec<Vec<Span>>,
    /// The worst span within the tolerance.
    within: f64,
}

impl Queue {
    fn push(&mut self, span: Span) {
        if span.miss <= 1.0 {
            self.within = self.within.max(span.miss);
            return;
        }
        // Of a number above one: its exponent, and two bits of its mantissa.
        const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
        let rank = ((span.miss.to_bits() - 1.0_f64.to_bits()) >> (MANTISSA - 2)) as usize;
        if self.ranks.len() <= rank {
            self.ranks.resize_with(rank + 1, Vec::new);
        }
        self.ranks[rank].push(span);
    }

    fn pop(&mut self) -> Option<Span> {
        while self.ranks.last().is_some_and(Vec::is_empty) {
            self.ranks.pop();
        }
        self.ranks.last_mut()?.pop()
    }
}

/// Chooses at most `most` samples of `count`: those `required`, and then, always where the drawing is worst, one more, until
/// it is within its tolerance everywhere. `worst` looks at every so many of the samples between two others, and finds the one that is
/// drawn worst, and how badly in units of the tolerance.
///
/// A span that is cut is looked at by probes, one that stays by all its samples: so most samples are looked at once or twice,
/// however often a span is cut.
pub(super) fn refined(
    count: usize,
    required: impl IntoIterator<Item = usize>,
    most: usize,
    worst: impl Fn(usize, usize, usize) -> (usize, f64),
) -> Chosen {
    let last = count.saturating_sub(1);
    let mut kept: Vec<usize> = required.into_iter().chain([0, last]).collect();
    let in_order = |kept: &mut Vec<usize>| {
        kept.sort_unstable();
        kept.dedup();
    };
    in_order(&mut kept);
    // Where there is room: evenly.
    let spans = SPANS.min(most.saturating_sub(kept.len()) / 2);
    kept.extend((1..spans).map(|k| (last as u128 * k as u128 / spans as u128) as usize));
    in_order(&mut kept);
    let measured = |from: usize, to: usize| {
        let stride = (to - from) / PROBES;
        let (at, miss) = worst(from, to, stride.max(1));
        if stride <= 1 || miss > 1.0 {
            return Span { miss, from, worst: at, to, is_exact: stride <= 1 };
        }
        let (at, miss) = worst(from, to, 1);
        Span { miss, from, worst: at, to, is_exact: true }
    };
    let mut queue = Queue::default();
    for pair in kept.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
        queue.push(measured(pair[0], pair[1]));
    }
    while kept.len() < most
        && let Some(Span { from, worst, to, .. }) = queue.pop()
    {
        // No sample is chosen twice: it lies between two that are.
        kept.push(worst);
        for (a, b) in [(from, worst), (worst, to)].into_iter().filter(|(a, b)| *b > a + 1) {
            queue.push(measured(a, b));
        }
    }
    kept.sort_unstable();
    let left = queue.ranks.iter().flatten();
    let found = left.map(|span| if span.is_exact { span.miss } else { worst(span.from, span.to, 1).1 });
    Chosen { kept, miss: found.fold(queue.within, f64::max) }
}

/// Numbers of the samples that a curve needs: ends and all minima and maxima if these are at most `most`, and whether they
/// are; else first, last, least and greatest of so many equal parts of the time as that allows.
pub(super) fn extrema(times: &[f64], values: &[f64], most: usize) -> (Vec<usize>, bool) {
    let all = turning_points(values, most);
    match all {
        Some(all) => (all, true),
        None => (columns(times, values, most / 4), false),
    }
}

/// Ends and local extrema; nothing if these are more than `most`. Of what is level, the sample where it begins and the one
/// where it ends.
fn turning_points(values: &[f64], most: usize) -> Option<Vec<usize>> {
    let mut found = vec![0];
    let mut before = Ordering::Equal;
    for (k, pair) in values.windows(2).enumerate() {
        let now = pair[1].total_cmp(&pair[0]);
        if k > 0 && now != before {
            found.push(k);
            if found.len() >= most {
                return None;
            }
        }
        before = now;
    }
    found.push(values.len() - 1);
    Some(found)
}

/// First, last, least and greatest of equal parts of the time; ends, least and greatest of all if there is no part.
fn columns(times: &[f64], values: &[f64], parts: usize) -> Vec<usize> {
    let last = values.len() - 1;
    let span = times[last] - times[0];
    let part_of = |k: usize| ((times[k] - times[0]) / span * parts as f64) as usize;
    let mut found = Vec::with_capacity(4 * parts.max(1));
    let mut from = 0;
    while from <= last {
        let part = part_of(from).min(parts.saturating_sub(1));
        let [mut low, mut high, mut to] = [from; 3];
        while to <= last && (parts <= 1 || part_of(to).min(parts - 1) == part) {
            low = if values[to] < values[low] { to } else { low };
            high = if values[to] > values[high] { to } else { high };
            to += 1;
        }
        let mut four = [from, low, high, to - 1];
        four.sort_unstable();
        found.extend(four);
        from = to;
    }
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(values: &[f64]) -> impl Fn(usize, usize, usize) -> (usize, f64) {
        |a, b, stride| {
            (a + 1..b)
                .step_by(stride)
                .map(|k| {
                    let part = (k - a) as f64 / (b - a) as f64;
                    (k, (values[a] + (values[b] - values[a]) * part - values[k]).abs() / 1e-3)
                })
                .max_by(|x, y| x.1.total_cmp(&y.1))
                .unwrap()
        }
    }

    #[test]
    fn what_is_left_out_is_within_the_tolerance() {
        let values: Vec<f64> = (0..100_000).map(|k| (f64::from(k) * 1e-3).sin()).collect();
        let chosen = refined(values.len(), [], 10_000, line(&values));
        assert!(chosen.miss <= 1.0 && chosen.kept.len() < 3000, "{} {}", chosen.miss, chosen.kept.len());
        assert!(chosen.kept.is_sorted() && chosen.kept[0] == 0 && chosen.kept.last() == Some(&99_999));
        // Found again by brute force.
        let worst =
            chosen.kept.windows(2).filter(|p| p[1] > p[0] + 1).map(|p| line(&values)(p[0], p[1], 1).1);
        assert_eq!(worst.fold(0.0, f64::max), chosen.miss);
        // With less room it tells how bad it is.
        let coarse = refined(values.len(), [], 100, line(&values));
        assert!(coarse.kept.len() == 100 && coarse.miss > 10.0, "{} {}", coarse.kept.len(), coarse.miss);
        let worst = coarse.kept.windows(2).map(|p| line(&values)(p[0], p[1], 1).1).fold(0.0, f64::max);
        assert_eq!(worst, coarse.miss);
    }

    #[test]
    fn samples_are_looked_at_a_few_times_only() {
        let looked = std::cell::Cell::new(0);
        let values: Vec<f64> = (0..400_000).map(|k| (f64::from(k) * 0.003).sin()).collect();
        let counted = |a: usize, b: usize, stride: usize| {
            looked.set(looked.get() + (b - a - 1).div_ceil(stride));
            line(&values)(a, b, stride)
        };
        let chosen = refined(values.len(), [], 100_000, counted);
        assert!(chosen.miss <= 1.0 && chosen.kept.len() > 3000, "{} {}", chosen.miss, chosen.kept.len());
        // Eight cuts of each of the first spans would look at all samples as often.
        assert!(looked.get() < 4 * values.len(), "{}", looked.get() as f64 / values.len() as f64);
    }

    #[test]
    fn a_jump_keeps_both_its_sides() {
        let values: Vec<f64> = (0..50_000).map(|k| f64::from(u8::from(k >= 31_234))).collect();
        let chosen = refined(values.len(), [], 1000, line(&values));
        assert!(chosen.kept.contains(&31_233) && chosen.kept.contains(&31_234));
    }

    #[test]
    fn every_extremum_where_there_is_room_and_the_envelope_where_not() {
        let times: Vec<f64> = (0..100_000).map(f64::from).collect();
        let slow: Vec<f64> = times.iter().map(|t| (t * 1e-3).sin()).collect();
        let (kept, all) = extrema(&times, &slow, 4000);
        // pi/2 + k pi below 100, and the ends.
        assert!(all && kept.len() == 32 + 2, "{}", kept.len());
        // Fast, with one spike that no even choice would hit.
        let mut fast: Vec<f64> = times.iter().map(|t| (t * 2.0).sin()).collect();
        fast[77_777] = 5.0;
        let (kept, all) = extrema(&times, &fast, 4000);
        assert!(!all && kept.len() <= 4000 && kept.is_sorted() && kept.contains(&77_777), "{}", kept.len());
        for part in 0..1000 {
            let all = &fast[100 * part..100 * (part + 1)];
            let shown = kept.iter().filter(|k| **k / 100 == part).map(|k| fast[*k]);
            assert_eq!(
                shown.clone().fold(f64::INFINITY, f64::min),
                all.iter().copied().fold(f64::INFINITY, f64::min)
            );
            assert_eq!(shown.fold(0.0, f64::max), all.iter().copied().fold(0.0, f64::max));
        }
    }

    #[test]
    fn few_samples_and_little_room() {
        let (times, values) = ([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 1.0, -1.0, 1.0, 0.0]);
        assert_eq!(extrema(&times, &values, 2).0, [0, 1, 2, 4]);
        assert_eq!(extrema(&times, &values, 5).0, [0, 1, 2, 3, 4]);
        assert_eq!(refined(2, [], 2, |_, _, _| unreachable!()).kept, [0, 1]);
        assert_eq!(extrema(&times[..2], &[1.0, 1.0], 9).0, [0, 1]);
    }
}
