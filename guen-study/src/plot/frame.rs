//! The layout of a picture: the ranges of the axes, their marks, the margins around them, and the map from values to
//! the picture. Lengths are in pixels; nothing is drawn here.

use super::Plot;
use super::ticks::{Tick, decades, ticks};

/// Sizes of letters.
pub(super) const TITLE_SIZE: f64 = 16.0;
pub(super) const TEXT_SIZE: f64 = 13.0;
pub(super) const TICK_SIZE: f64 = 12.0;
/// The mean width of a letter over its size: viewers choose the font, so widths are only estimates.
const LETTER: f64 = 0.64;
/// The room around everything.
pub(super) const MARGIN: f64 = 12.0;
/// The room between the edge of the picture and the text nearest to it, where texts reach into the margin.
const EDGE: f64 = 4.0;
/// The room between an axis and the labels of its marks.
pub(super) const TICK_GAP: f64 = 7.0;
/// The height of a line of the legend.
pub(super) const LEGEND_LINE: f64 = 19.0;
/// A sample of a curve in the legend, and the room after it and after its text.
pub(super) const SAMPLE: f64 = 24.0;
pub(super) const SAMPLE_GAP: f64 = 6.0;
const ENTRY_GAP: f64 = 18.0;

/// The width that a text will have, about.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * LETTER
}

/// An axis: the values at its ends, the pixels at its ends, and its marks.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// The values at the ends; of a logarithmic axis their decimal logarithms.
    low: f64,
    high: f64,
    logarithmic: bool,
    pub from: f64,
    pub to: f64,
    pub ticks: Vec<Tick>,
}

impl Axis {
    /// The pixel of a value.
    pub fn at(&self, value: f64) -> f64 {
        let value = if self.logarithmic { value.log10() } else { value };
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    fn length(&self) -> f64 {
        (self.to - self.from).abs()
    }

    /// Returns at most so many marks.
    fn marks(&self, most: usize) -> Vec<Tick> {
        if self.logarithmic { decades(self.low, self.high, most) } else { ticks(self.low, self.high, most) }
    }
}

/// An entry of the legend: the position of its sample, the middle of its line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub curve: usize,
    pub left: f64,
    pub middle: f64,
}

/// The layout of a picture.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub x: Axis,
    pub y: Axis,
    pub legend: Vec<Entry>,
    /// The position of the entry for the band, if there is one.
    pub band: Option<Entry>,
    /// The position of the entry for the marks at the ends, if there are any.
    pub ends: Option<Entry>,
}

/// The entry for the marks at the ends, as two texts.
pub(super) const ENDS: [&str; 2] = ["start", "end"];

impl Frame {
    /// Whether title, legend and labels leave enough of the picture to the curves.
    pub fn has_room(&self) -> bool {
        const ENOUGH: f64 = 30.0;
        self.x.to - self.x.from >= ENOUGH && self.y.from - self.y.to >= ENOUGH
    }

    /// `None` if there is no point to draw.
    pub fn new(plot: &Plot) -> Option<Self> {
        const ROUNDS: usize = 5;
        let (x_range, y_range) = ranges(plot)?;
        let (width, height) = (f64::from(plot.width), f64::from(plot.height));

        // The legend is laid out first, for it needs no axis: its left end is moved to the axis at the end.
        let title = if plot.title.is_empty() { 0.0 } else { TITLE_SIZE + 10.0 };
        let Legend { mut entries, mut band, mut ends, lines } =
            legend(plot, MARGIN + title, width - 2.0 * MARGIN);
        let top = MARGIN + title + lines as f64 * LEGEND_LINE + 4.0;
        let x_text = if plot.x_label.is_empty() { 0.0 } else { TEXT_SIZE + 8.0 };
        let bottom = height - (MARGIN + x_text + TICK_SIZE + TICK_GAP);
        let mut right = width - MARGIN;
        let y_text = if plot.y_label.is_empty() { 0.0 } else { TEXT_SIZE + 8.0 };

        // The margins hold the labels of the marks, which depend on the length of the axes and so on the margins.
        // After the first round margins only grow, so that the rounds settle.
        let mut left = MARGIN + y_text + 4.0 * TICK_SIZE;
        let mut axes = None;
        for round in 0..ROUNDS {
            let axis = |range: (f64, f64), from, to| Axis {
                low: range.0,
                high: range.1,
                logarithmic: plot.logarithmic,
                from,
                to,
                ticks: Vec::new(),
            };
            let mut x = axis(x_range, left, right);
            let mut y = axis(y_range, bottom, top);
            if plot.equal_scale {
                equalise(&mut x, &mut y);
            }
            x.ticks = x_ticks(&x);
            y.ticks = y.marks((y.length() / 45.0) as usize);
            let widest = y.ticks.iter().map(|tick| text_width(&tick.label, TICK_SIZE)).fold(0.0, f64::max);
            let (before, after) = overhang(&x);
            let needed = f64::max(MARGIN + y_text + widest + TICK_GAP, EDGE + before);
            left = if round == 0 { needed } else { needed.max(left) };
            right = right.min(width - EDGE - after);
            axes = Some((x, y));
        }
        let (x, y) = axes?;
        for entry in entries.iter_mut().chain(&mut band).chain(&mut ends) {
            entry.left += x.from;
        }
        Some(Self { x, y, legend: entries, band, ends })
    }
}

/// Returns the lengths by which the labels of the outermost marks of a horizontal axis reach beyond its ends.
fn overhang(axis: &Axis) -> (f64, f64) {
    let half = |tick: &Tick| text_width(&tick.label, TICK_SIZE) / 2.0;
    let before = axis.ticks.first().map(|tick| half(tick) - (axis.at(tick.value) - axis.from));
    let after = axis.ticks.last().map(|tick| half(tick) - (axis.to - axis.at(tick.value)));
    (before.unwrap_or(0.0), after.unwrap_or(0.0))
}

/// Returns as many marks as have room side by side.
fn x_ticks(axis: &Axis) -> Vec<Tick> {
    /// The least distance between marks, and between their labels.
    const DISTANCE: f64 = 70.0;
    const GAP: f64 = 14.0;
    let mut most = (axis.length() / DISTANCE).max(2.0) as usize;
    loop {
        let found = axis.marks(most);
        let fits = found.windows(2).all(|pair| {
            let room = (axis.at(pair[1].value) - axis.at(pair[0].value)).abs();
            let text = text_width(&pair[0].label, TICK_SIZE) + text_width(&pair[1].label, TICK_SIZE);
            text / 2.0 + GAP <= room
        });
        if fits || most <= 1 {
            return found;
        }
        most -= 1;
    }
}

/// Widens the range of one axis around its middle until a unit is as long on both.
fn equalise(x: &mut Axis, y: &mut Axis) {
    let unit = f64::max((x.high - x.low) / x.length(), (y.high - y.low) / y.length());
    for axis in [x, y] {
        let (middle, half) = (axis.low / 2.0 + axis.high / 2.0, unit * axis.length() / 2.0);
        (axis.low, axis.high) = (middle - half, middle + half);
    }
}

/// The ranges of both axes, with some room beyond the points.
fn ranges(plot: &Plot) -> Option<((f64, f64), (f64, f64))> {
    // A curve over time begins at the axis; a track keeps off it.
    let (x_room, y_room) = if plot.equal_scale { (0.05, 0.05) } else { (0.0, 0.05) };
    let place = |value: f64| if plot.logarithmic { value.log10() } else { value };
    let points = || plot.drawn().flat_map(|curve| &curve.points).filter(|point| plot.can_draw(point));
    let x_room = if plot.logarithmic { 0.03 } else { x_room };
    let ranged = |values: &mut dyn Iterator<Item = f64>, room| range(values, room, plot.logarithmic);
    Some((
        ranged(&mut points().map(|p| place(p.0)), x_room)?,
        ranged(&mut points().map(|p| place(p.1)), y_room)?,
    ))
}

/// The range of values, not narrower than can be labelled, with room at both ends.
fn range(values: &mut dyn Iterator<Item = f64>, room: f64, logarithmic: bool) -> Option<(f64, f64)> {
    /// The narrowest range over the size of its values: labels have ten digits then.
    const NARROW: f64 = 1e-9;
    /// The size up to which values count as zero: their differences have no digits.
    const TINY: f64 = 1e-300;
    let (low, high) = values.fold(None, |found: Option<(f64, f64)>, value| match found {
        None => Some((value, value)),
        Some((low, high)) => Some((low.min(value), high.max(value))),
    })?;
    let size = low.abs().max(high.abs());
    let least = if size <= TINY { 1.0 } else { NARROW * size };
    let (middle, span) = (low / 2.0 + high / 2.0, (high - low).max(least));
    // A constant is drawn against its size, which on a logarithmic axis is a decade.
    let span = match low == high {
        true if logarithmic => 1.0,
        true if size > TINY => 0.2 * size,
        _ => span,
    };
    let half = (0.5 + room) * span;
    Some((middle - half, middle + half))
}

/// The entries of the legend, and the count of their lines. Their left ends are still relative to that of the axis.
struct Legend {
    entries: Vec<Entry>,
    band: Option<Entry>,
    ends: Option<Entry>,
    lines: usize,
}

/// The legend in lines below `top`.
fn legend(plot: &Plot, top: f64, width: f64) -> Legend {
    /// About what the marks and the text of the vertical axis take from the width.
    const LEFT: f64 = 80.0;
    let mut lines = 0;
    let mut x = 0.0;
    let mut place = |curve: usize, text: f64| {
        let entry = SAMPLE + SAMPLE_GAP + text + ENTRY_GAP;
        if lines == 0 || x > 0.0 && x + entry - ENTRY_GAP > width - LEFT {
            lines += 1;
            x = 0.0;
        }
        let left = x;
        x += entry;
        Entry { curve, left, middle: top + (lines as f64 - 0.5) * LEGEND_LINE }
    };
    let mut entries = Vec::new();
    for (index, curve) in plot.curves.iter().enumerate() {
        if !curve.label.is_empty() {
            entries.push(place(index, text_width(&curve.label, TEXT_SIZE)));
        }
    }
    let named = plot.band.as_ref().filter(|band| !band.label.is_empty());
    let band = named.map(|band| place(0, text_width(&band.label, TEXT_SIZE)));
    let ends_width = ENDS.iter().map(|text| text_width(text, TEXT_SIZE)).sum::<f64>() + SAMPLE;
    let ends = plot.mark_ends.then(|| place(0, ends_width));
    Legend { entries, band, ends, lines }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(plot: Plot) -> Frame {
        Frame::new(&plot).unwrap()
    }

    #[test]
    fn all_points_lie_inside() {
        let frame = frame(Plot::new("t").line("a", [(0.0, -3.0), (10.0, 5.0)]));
        for (axis, values) in [(&frame.x, [0.0, 10.0]), (&frame.y, [-3.0, 5.0])] {
            for value in values {
                let inside = axis.from.min(axis.to)..=axis.from.max(axis.to);
                assert!(inside.contains(&axis.at(value)));
            }
        }
        assert!(frame.y.at(1.0) < frame.y.at(0.0), "up is up");
    }

    #[test]
    fn equal_scales_are_equal() {
        for size in [(800, 300), (300, 800)] {
            let frame = frame(
                Plot::new("t").size(size.0, size.1).equal_scale(true).line("a", [(0.0, 0.0), (4.0, 1.0)]),
            );
            let unit = |axis: &Axis| (axis.at(1.0) - axis.at(0.0)).abs();
            assert!((unit(&frame.x) - unit(&frame.y)).abs() < 1e-9);
        }
    }

    #[test]
    fn labels_do_not_meet() {
        for (low, high) in
            [(0.0, 1.0), (-1e6, 2e6), (1.0, 1.0 + 1e-8), (-3e-13, 4e-13), (0.0, 0.0), (7.0, 7.0)]
        {
            for width in (240..2000).step_by(80) {
                let frame = frame(Plot::new("t").size(width, 400).line("a", [(low, 0.0), (high, 1.0)]));
                let ticks = &frame.x.ticks;
                assert!(!ticks.is_empty(), "{low} {high} {width}");
                for pair in ticks.windows(2) {
                    let room = frame.x.at(pair[1].value) - frame.x.at(pair[0].value);
                    assert!(room > text_width(&pair[0].label, TICK_SIZE));
                }
            }
        }
    }

    #[test]
    fn labels_stay_in_the_picture() {
        for (low, high) in [(0.0, 1e-5), (-2.1, 1.8), (1.0, 1.0 + 1e-7), (0.0, 20.0), (0.0, 99_999.0)] {
            for width in (240..1200).step_by(13) {
                for equal in [false, true] {
                    let plot = Plot::new("t").size(width, width).axes("x", "y").equal_scale(equal);
                    let frame = frame(plot.line("a", [(low, low), (high, high)]));
                    for tick in &frame.x.ticks {
                        let half = text_width(&tick.label, TICK_SIZE) / 2.0;
                        let at = frame.x.at(tick.value);
                        assert!(at - half >= 0.0 && at + half <= f64::from(width), "{low} {high} {width}");
                    }
                    for tick in &frame.y.ticks {
                        let left = frame.x.from - TICK_GAP - text_width(&tick.label, TICK_SIZE);
                        assert!(left >= MARGIN + TEXT_SIZE, "{low} {high} {width}: {}", tick.label);
                    }
                }
            }
        }
    }

    #[test]
    fn the_legend_wraps() {
        let mut plot = Plot::new("t").size(400, 400);
        for k in 0..9 {
            plot = plot.line(format!("curve number {k}"), [(0.0, 0.0), (1.0, 1.0)]);
        }
        let frame = frame(plot.line("", [(0.0, 0.0)]).mark_ends(true));
        assert_eq!(frame.legend.len(), 9);
        let lowest = frame.ends.unwrap().middle;
        assert!(frame.legend.iter().all(|entry| entry.left < 400.0 && entry.middle <= lowest));
        assert!(lowest < frame.y.to);
    }
}
