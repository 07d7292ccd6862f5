//! Places of labels beside the last points of curves, where they meet neither each other nor the edge.

use super::frame::text_width;

/// The height of a line of labels, and the room between a point and its label, in pixels.
const LINE: f64 = 13.0;
const BESIDE: f64 = 5.0;

/// A label beside a point: its left end and the middle of its line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Label {
    pub left: f64,
    pub middle: f64,
    width: f64,
}

impl Label {
    fn meets(&self, other: &Label) -> bool {
        (self.middle - other.middle).abs() < LINE
            && self.left < other.left + other.width
            && other.left < self.left + self.width
    }
}

/// Labels beside points, each as near to its point as those before it leave room; to the left of its point where the right edge
/// is too near. `None` where there is no room between `top` and `bottom`.
pub(super) fn beside(
    points: &[(f64, f64)],
    texts: &[&str],
    size: f64,
    right: f64,
    [top, bottom]: [f64; 2],
) -> Vec<Option<Label>> {
    let mut placed: Vec<Option<Label>> = Vec::new();
    for (&(x, y), text) in points.iter().zip(texts) {
        let width = text_width(text, size);
        let left = if x + BESIDE + width <= right { x + BESIDE } else { x - BESIDE - width };
        // By half lines, below and above by turns.
        let steps = ((bottom - top) / LINE).ceil() as usize * 4;
        let shifts =
            (0..=steps).map(|k| LINE / 2.0 * k.div_ceil(2) as f64 * if k % 2 == 0 { -1.0 } else { 1.0 });
        let free = shifts.map(|shift| Label { left, middle: y + shift, width }).find(|label| {
            let inside = label.middle - LINE / 2.0 >= top && label.middle + LINE / 2.0 <= bottom;
            inside && placed.iter().flatten().all(|other| !label.meets(other))
        });
        placed.push(free);
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_at_one_point_do_not_meet() {
        let texts = ["one", "two", "three", "four", "five"];
        let labels = beside(&[(100.0, 50.0); 5], &texts, 12.0, 400.0, [0.0, 200.0]);
        let labels: Vec<Label> = labels.into_iter().map(Option::unwrap).collect();
        for (k, label) in labels.iter().enumerate() {
            assert!(labels[..k].iter().all(|other| !label.meets(other)), "{labels:?}");
            assert!((label.middle - 50.0).abs() <= 3.0 * LINE);
        }
        assert_eq!(labels[0].middle, 50.0);
    }

    #[test]
    fn labels_stay_inside_or_away() {
        let [label] = beside(&[(390.0, 195.0)], &["a long label"], 12.0, 400.0, [0.0, 200.0])[..] else {
            panic!()
        };
        let label = label.unwrap();
        assert!(label.left + label.width <= 390.0 && label.middle + LINE / 2.0 <= 200.0, "{label:?}");
        let crowded = beside(&[(10.0, 5.0); 4], &["a"; 4], 12.0, 400.0, [0.0, 2.5 * LINE]);
        assert!(crowded.iter().flatten().count() >= 1 && crowded.contains(&None), "{crowded:?}");
    }
}
