//! Hands lines and texts to plotters, which writes them as SVG.
//!
//! Its pictures have whole pixels as coordinates, on which a slow curve is a staircase. So everything is drawn ten
//! times as large, and the head of the file says that the picture is a tenth of it.

use plotters::backend::SVGBackend;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, DashedPathElement, PathElement, Text};
use plotters::prelude::{Color, FontTransform, IntoFont, RGBColor, ShapeStyle, WHITE};
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::ends::beside;
use super::frame::{
    ENDS, Entry, Frame, MARGIN, SAMPLE, SAMPLE_GAP, TEXT_SIZE, TICK_GAP, TICK_SIZE, TITLE_SIZE, text_width,
};
use super::thin::thin;
use super::{Curve, Plot};
use crate::error::StudyError;

/// Drawn units to a pixel.
const FINE: f64 = 10.0;
/// The sizes that a picture may have, in pixels. The smallest leaves room between the margins; the largest keeps
/// coordinates far from overflow.
const WIDTHS: std::ops::RangeInclusive<u32> = 240..=20_000;
const HEIGHTS: std::ops::RangeInclusive<u32> = 180..=20_000;
/// A curve of more points than this is thinned out, to columns of this width in pixels.
const DRAWN_POINTS: usize = 4000;
const COLUMN: f64 = 0.25;

/// Hues that stay apart for the common kinds of colour blindness, each in a tone for white and in one for a dark
/// background; either has a contrast of at least 3:1 there. The viewer has the same.
const PALETTE: [[RGBColor; 2]; 6] = [
    [RGBColor(0x00, 0x72, 0xb2), RGBColor(0x56, 0xb4, 0xe9)], // blue
    [RGBColor(0xc2, 0x4a, 0x00), RGBColor(0xf0, 0x88, 0x3e)], // vermilion
    [RGBColor(0x00, 0x7a, 0x58), RGBColor(0x2f, 0xc7, 0x9a)], // bluish green
    [RGBColor(0xa8, 0x3f, 0x80), RGBColor(0xe5, 0x9a, 0xc5)], // reddish purple
    [RGBColor(0x8a, 0x64, 0x00), RGBColor(0xe8, 0xb6, 0x4a)], // ochre
    [RGBColor(0x4d, 0x56, 0x61), RGBColor(0xb9, 0xc2, 0xcc)], // grey
];
const PAPER: [RGBColor; 2] = [WHITE, RGBColor(0x1b, 0x1f, 0x24)];
const INK: [RGBColor; 2] = [RGBColor(0x22, 0x22, 0x22), RGBColor(0xe8, 0xea, 0xed)];
const AXIS: [RGBColor; 2] = [RGBColor(0x66, 0x66, 0x66), RGBColor(0x9a, 0xa3, 0xac)];
const GRID: [RGBColor; 2] = [RGBColor(0xe6, 0xe6, 0xe6), RGBColor(0x34, 0x3b, 0x43)];
const ZERO: [RGBColor; 2] = [RGBColor(0xb8, 0xb8, 0xb8), RGBColor(0x5a, 0x65, 0x70)];
const BAND: [RGBColor; 2] = [RGBColor(0xd2, 0xd2, 0xd2), RGBColor(0x4a, 0x50, 0x57)];

/// Widths of strokes, the radius of a mark at an end, and the dash with its gap, in pixels.
const CURVE_STROKE: f64 = 1.6;
/// Letters of labels at the ends of faint curves.
const END_SIZE: f64 = 11.0;
const LINE_STROKE: f64 = 1.0;
const END_RADIUS: f64 = 4.0;
const POINT_RADIUS: f64 = 2.2;
const BAND_STROKE: f64 = 9.0;
/// The dashes of curves from the seventh on, from the thirteenth on, from the nineteenth on.
const DASHES: [(f64, f64); 3] = [(7.0, 4.0), (2.0, 3.0), (14.0, 4.0)];

type Canvas<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// The picture as the text of an SVG file.
pub(super) fn draw(plot: &Plot) -> Result<String, StudyError> {
    let (head, rest) = drawn(plot)?;
    Ok([&head, "\n", &described(plot), &dark_style(""), &rest].concat())
}

/// The picture as an element of a page, which has the colours for the dark.
#[cfg(feature = "viewer")]
pub(super) fn draw_inline(plot: &Plot) -> Result<String, StudyError> {
    let (head, rest) = drawn(plot)?;
    // The size of the page decides.
    let head = head.replacen("<svg ", "<svg role=\"img\" ", 1);
    Ok([&head, "\n", &described(plot), &rest].concat())
}

/// The first tag of the picture, and all after it.
fn drawn(plot: &Plot) -> Result<(String, String), StudyError> {
    let size_error =
        || StudyError::Size { title: plot.title.clone(), width: plot.width, height: plot.height };
    if !WIDTHS.contains(&plot.width) || !HEIGHTS.contains(&plot.height) {
        return Err(size_error());
    }
    let Some(frame) = Frame::new(plot) else {
        return Err(StudyError::NothingToDraw { title: plot.title.clone() });
    };
    if !frame.has_room() {
        return Err(size_error());
    }
    let size = (plot.width * FINE as u32, plot.height * FINE as u32);
    let mut text = String::new();
    Painter { canvas: SVGBackend::with_string(&mut text, size).into_drawing_area() }
        .picture(plot, &frame)
        .map_err(|error| StudyError::Drawing { title: plot.title.clone(), source: Box::new(error) })?;
    // Round joins, for those of a thinned curve would end in spikes.
    let drawn = format!("<svg width=\"{}\" height=\"{}\" ", size.0, size.1);
    let shown = format!(
        "<svg width=\"{}\" height=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"round\" ",
        plot.width, plot.height
    );
    let text = text.replacen(&drawn, &shown, 1);
    // The first tag is that of the picture.
    let (head, rest) = text.split_at(text.find('>').map_or(0, |end| end + 1));
    Ok((head.to_owned(), rest.trim_start_matches('\n').to_owned()))
}

/// A text without the characters that no XML may have, not even as references: one such would make the file no picture.
fn legible(text: &str) -> String {
    let is_forbidden =
        |c: char| c.is_control() && !matches!(c, '\t' | '\n' | '\r') || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.replace(is_forbidden, "\u{fffd}")
}

/// Title and description, which browsers and screen readers tell.
fn described(plot: &Plot) -> String {
    let escaped = |text: &str| {
        legible(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
    };
    let labels: Vec<_> =
        plot.drawn().map(|curve| escaped(&curve.label)).filter(|label| !label.is_empty()).collect();
    let title = if plot.title.is_empty() { labels.join(", ") } else { escaped(&plot.title) };
    let axes: Vec<_> = [&plot.x_label, &plot.y_label]
        .map(|label| escaped(label))
        .into_iter()
        .filter(|label| !label.is_empty())
        .collect();
    let axes = if axes.is_empty() { String::new() } else { format!(" on axes {}", axes.join(" and ")) };
    let mut text = format!("<title>{title}</title>\n");
    let moments = match &plot.moments {
        Some((label, places)) if !places.is_empty() => {
            let ending = if places.len() == 1 { "" } else { "s" };
            format!("; dashed lines at {} {}{ending}", places.len(), escaped(label))
        }
        _ => String::new(),
    };
    if !labels.is_empty() {
        text += &format!("<desc>Curves{axes}: {}{moments}</desc>\n", labels.join(", "));
    }
    text
}

/// A colour as SVG writes it.
fn code(RGBColor(r, g, b): RGBColor) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// The number of hues before they come again.
#[cfg(feature = "viewer")]
pub(crate) const INKS: usize = PALETTE.len();

/// The colour of the curve or thing with this number, of what is behind it, and of a grid, in light.
#[cfg(feature = "viewer")]
pub(crate) fn ink(number: usize) -> String {
    code(color_of(number))
}
#[cfg(feature = "viewer")]
pub(crate) fn paper() -> String {
    code(PAPER[0])
}
#[cfg(feature = "viewer")]
pub(crate) fn grid() -> String {
    code(GRID[0])
}

/// Other colours for readers whose system is dark: rules of a style win over the colours of the elements. `media` restricts
/// them further.
pub(crate) fn dark_style(media: &str) -> String {
    let colors = PALETTE.iter().chain([&PAPER, &INK, &AXIS, &GRID, &ZERO, &BAND]);
    let rules = colors.map(|&[light, dark]| {
        let (light, dark) = (code(light), code(dark));
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    });
    format!("<style>@media {media}(prefers-color-scheme:dark){{{}}}</style>\n", rules.collect::<String>())
}

struct Painter<'a> {
    canvas: Canvas<'a>,
}

/// A pixel in drawn units.
fn fine((x, y): (f64, f64)) -> (i32, i32) {
    ((x * FINE).round() as i32, (y * FINE).round() as i32)
}

fn stroke(color: RGBColor, width: f64) -> ShapeStyle {
    color.stroke_width((width * FINE) as u32)
}

fn color_of(curve: usize) -> RGBColor {
    PALETTE[curve % PALETTE.len()][0]
}

impl Painter<'_> {
    fn picture(self, plot: &Plot, frame: &Frame) -> Drawn {
        self.canvas.fill(&PAPER[0])?;
        self.grid(frame)?;
        if let Some(band) = &plot.band {
            for piece in pieces(plot, band, frame) {
                self.canvas.draw(&PathElement::new(piece, stroke(BAND[0], BAND_STROKE)))?;
            }
        }
        self.moments(plot, frame)?;
        for curve in &plot.faint {
            for piece in pieces(plot, curve, frame) {
                self.canvas.draw(&PathElement::new(piece, stroke(ZERO[0], LINE_STROKE)))?;
            }
        }
        for (index, curve) in plot.curves.iter().enumerate() {
            for piece in pieces(plot, curve, frame) {
                self.curve(index, piece)?;
            }
            if plot.mark_points {
                for point in curve.points.iter().filter(|point| plot.can_draw(point)) {
                    self.point((frame.x.at(point.0), frame.y.at(point.1)), color_of(index))?;
                }
            }
        }
        if plot.mark_ends {
            for (index, curve) in plot.curves.iter().enumerate() {
                let place = |point: &(f64, f64)| (frame.x.at(point.0), frame.y.at(point.1));
                let mut drawable = curve.points.iter().filter(|point| plot.can_draw(point)).map(place);
                if let Some(start) = drawable.next() {
                    self.ring(start, color_of(index))?;
                    self.dot(drawable.next_back().unwrap_or(start), color_of(index))?;
                }
            }
        }
        self.at_ends(plot, frame)?;
        self.labels(plot, frame)?;
        self.legend(plot, frame)?;
        self.canvas.present()
    }

    /// Lines across the picture; of those that fall onto the same pixel one.
    fn moments(&self, plot: &Plot, frame: &Frame) -> Drawn {
        let (dash, gap) = DASHES[0];
        let (dash, gap) = ((dash * FINE) as i32, (gap * FINE) as i32);
        let mut last = f64::NAN;
        for &place in plot.moments.iter().flat_map(|(_, places)| places) {
            let at = frame.x.at(place).round();
            if plot.can_draw(&(place, 1.0)) && (frame.x.from..=frame.x.to).contains(&at) && at != last {
                let ends = [(at, frame.y.from), (at, frame.y.to)].map(fine).to_vec();
                self.canvas.draw(&DashedPathElement::new(ends, dash, gap, stroke(ZERO[0], LINE_STROKE)))?;
                last = at;
            }
        }
        Ok(())
    }

    /// The labels of faint curves.
    fn at_ends(&self, plot: &Plot, frame: &Frame) -> Drawn {
        let last = |curve: &Curve| curve.points.iter().rfind(|point| plot.can_draw(point)).copied();
        let (points, texts): (Vec<_>, Vec<_>) = plot
            .faint
            .iter()
            .filter_map(|curve| Some((last(curve)?, curve.label.as_str())))
            .map(|((x, y), label)| ((frame.x.at(x), frame.y.at(y)), label))
            .unzip();
        let labels = beside(&points, &texts, END_SIZE, frame.x.to, [frame.y.to, frame.y.from]);
        for (label, text) in labels.into_iter().zip(texts) {
            if let Some(label) = label {
                let at = (label.left, label.middle);
                self.text(text, at, END_SIZE, Pos::new(HPos::Left, VPos::Center), FontTransform::None)?;
            }
        }
        Ok(())
    }

    fn grid(&self, frame: &Frame) -> Drawn {
        let (x, y) = (&frame.x, &frame.y);
        let color = |value: f64| if value == 0.0 { ZERO[0] } else { GRID[0] };
        // The lines through zero come last, to lie above the others where they cross.
        for zero in [false, true] {
            for tick in x.ticks.iter().filter(|tick| (tick.value == 0.0) == zero) {
                let at = x.at(tick.value);
                self.line(&[(at, y.from), (at, y.to)], color(tick.value))?;
            }
            for tick in y.ticks.iter().filter(|tick| (tick.value == 0.0) == zero) {
                let at = y.at(tick.value);
                self.line(&[(x.from, at), (x.to, at)], color(tick.value))?;
            }
        }
        self.line(&[(x.from, y.to), (x.from, y.from), (x.to, y.from)], AXIS[0])
    }

    fn labels(&self, plot: &Plot, frame: &Frame) -> Drawn {
        let (x, y) = (&frame.x, &frame.y);
        for tick in &x.ticks {
            let at = (x.at(tick.value), y.from + TICK_GAP);
            self.text(&tick.label, at, TICK_SIZE, Pos::new(HPos::Center, VPos::Top), FontTransform::None)?;
        }
        for tick in &y.ticks {
            let at = (x.from - TICK_GAP, y.at(tick.value));
            self.text(&tick.label, at, TICK_SIZE, Pos::new(HPos::Right, VPos::Center), FontTransform::None)?;
        }
        let below = ((x.from + x.to) / 2.0, f64::from(plot.height) - MARGIN);
        self.text(
            &plot.x_label,
            below,
            TEXT_SIZE,
            Pos::new(HPos::Center, VPos::Bottom),
            FontTransform::None,
        )?;
        let beside = (MARGIN, (y.from + y.to) / 2.0);
        let turned = FontTransform::Rotate270;
        self.text(&plot.y_label, beside, TEXT_SIZE, Pos::new(HPos::Center, VPos::Top), turned)?;
        let above = (x.from, MARGIN);
        self.text(&plot.title, above, TITLE_SIZE, Pos::new(HPos::Left, VPos::Top), FontTransform::None)
    }

    fn legend(&self, plot: &Plot, frame: &Frame) -> Drawn {
        let beside = Pos::new(HPos::Left, VPos::Center);
        for &Entry { curve, left, middle } in &frame.legend {
            let sample = [(left, middle), (left + SAMPLE, middle)];
            self.curve(curve, sample.map(fine).to_vec())?;
            let at = (left + SAMPLE + SAMPLE_GAP, middle);
            self.text(&plot.curves[curve].label, at, TEXT_SIZE, beside, FontTransform::None)?;
        }
        if let (Some(entry), Some(band)) = (&frame.band, &plot.band) {
            let sample = [(entry.left, entry.middle), (entry.left + SAMPLE, entry.middle)];
            let sample = sample.map(fine).to_vec();
            self.canvas.draw(&PathElement::new(sample, stroke(BAND[0], BAND_STROKE)))?;
            let at = (entry.left + SAMPLE + SAMPLE_GAP, entry.middle);
            self.text(&band.label, at, TEXT_SIZE, beside, FontTransform::None)?;
        }
        if let Some(Entry { left, middle, .. }) = frame.ends {
            let [start, end] = ENDS;
            let second = left + SAMPLE + SAMPLE_GAP + text_width(start, TEXT_SIZE);
            for (text, left) in [(start, left), (end, second)] {
                let at = (left + SAMPLE - END_RADIUS, middle);
                if text == start {
                    self.ring(at, AXIS[0])?
                } else {
                    self.dot(at, AXIS[0])?
                }
                self.text(
                    text,
                    (left + SAMPLE + SAMPLE_GAP, middle),
                    TEXT_SIZE,
                    beside,
                    FontTransform::None,
                )?;
            }
        }
        Ok(())
    }

    fn curve(&self, index: usize, points: Vec<(i32, i32)>) -> Drawn {
        let color = color_of(index);
        match points[..] {
            // A point without neighbours has no line.
            [(x, y)] => self.dot((f64::from(x) / FINE, f64::from(y) / FINE), color),
            _ if index < PALETTE.len() => {
                self.canvas.draw(&PathElement::new(points, stroke(color, CURVE_STROKE)))
            }
            _ => {
                let (dash, gap) = DASHES[(index / PALETTE.len() - 1) % DASHES.len()];
                let (dash, gap) = ((dash * FINE) as i32, (gap * FINE) as i32);
                self.canvas.draw(&DashedPathElement::new(points, dash, gap, stroke(color, CURVE_STROKE)))
            }
        }
    }

    fn ring(&self, at: (f64, f64), color: RGBColor) -> Drawn {
        let radius = (END_RADIUS * FINE) as i32;
        self.canvas.draw(&Circle::new(fine(at), radius, PAPER[0].filled()))?;
        self.canvas.draw(&Circle::new(fine(at), radius, stroke(color, CURVE_STROKE)))
    }

    fn dot(&self, at: (f64, f64), color: RGBColor) -> Drawn {
        self.canvas.draw(&Circle::new(fine(at), (END_RADIUS * FINE) as i32, color.filled()))
    }

    fn point(&self, at: (f64, f64), color: RGBColor) -> Drawn {
        self.canvas.draw(&Circle::new(fine(at), (POINT_RADIUS * FINE) as i32, color.filled()))
    }

    fn line(&self, points: &[(f64, f64)], color: RGBColor) -> Drawn {
        let points: Vec<_> = points.iter().copied().map(fine).collect();
        self.canvas.draw(&PathElement::new(points, stroke(color, LINE_STROKE)))
    }

    fn text(&self, text: &str, at: (f64, f64), size: f64, pos: Pos, transform: FontTransform) -> Drawn {
        /// plotters writes sizes divided by this.
        const EM: f64 = 1.24;
        if text.is_empty() {
            return Ok(());
        }
        let font = ("sans-serif", size * FINE * EM).into_font().transform(transform);
        self.canvas.draw(&Text::new(legible(text), fine(at), font.color(&INK[0]).pos(pos)))
    }
}

/// The parts of a curve between its gaps, thinned out if it is long.
fn pieces(plot: &Plot, curve: &Curve, frame: &Frame) -> Vec<Vec<(i32, i32)>> {
    let parts = curve.points.split(|point| !plot.can_draw(point)).filter(|part| !part.is_empty());
    parts
        .map(|part| {
            let mut places: Vec<_> = part.iter().map(|&(x, y)| (frame.x.at(x), frame.y.at(y))).collect();
            if curve.points.len() > DRAWN_POINTS {
                places = thin(&places, COLUMN);
            }
            let mut drawn: Vec<_> = places.into_iter().map(fine).collect();
            drawn.dedup();
            drawn
        })
        .collect()
}
