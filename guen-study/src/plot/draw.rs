//! Hands lines and texts to plotters, which writes them as SVG.
//!
//! Its pictures have whole pixels as coordinates, on which a slow curve is a staircase. So everything is drawn ten
//! times as large, and the head of the file says that the picture is a tenth of it.

use plotters::backend::SVGBackend;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, DashedPathElement, PathElement, Text};
use plotters::prelude::{Color, FontTransform, IntoFont, RGBColor, ShapeStyle, WHITE};
use plotters::style::text_anchor::{HPos, Pos, VPos};

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
const MANY: usize = 4000;
const COLUMN: f64 = 0.25;

/// The colours of Okabe and Ito without their yellow, which is too faint for a line on white.
const PALETTE: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2), // blue
    RGBColor(0xd5, 0x5e, 0x00), // vermilion
    RGBColor(0x00, 0x9e, 0x73), // bluish green
    RGBColor(0xcc, 0x79, 0xa7), // reddish purple
    RGBColor(0xe6, 0x9f, 0x00), // orange
    RGBColor(0x56, 0xb4, 0xe9), // sky blue
    RGBColor(0x00, 0x00, 0x00),
];
const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const AXIS: RGBColor = RGBColor(0x66, 0x66, 0x66);
const GRID: RGBColor = RGBColor(0xe6, 0xe6, 0xe6);
const ZERO: RGBColor = RGBColor(0xb8, 0xb8, 0xb8);
const BAND: RGBColor = RGBColor(0xd2, 0xd2, 0xd2);

/// Widths of strokes, the radius of a mark at an end, and the dash with its gap, in pixels.
const CURVE_STROKE: f64 = 1.6;
const LINE_STROKE: f64 = 1.0;
const END_RADIUS: f64 = 4.0;
const POINT_RADIUS: f64 = 2.2;
const BAND_STROKE: f64 = 9.0;
const DASH: (f64, f64) = (7.0, 4.0);

type Canvas<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// The picture as the text of an SVG file.
pub(super) fn draw(plot: &Plot) -> Result<String, StudyError> {
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
    Ok(text.replacen(&drawn, &shown, 1))
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
    PALETTE[curve % PALETTE.len()]
}

impl Painter<'_> {
    fn picture(self, plot: &Plot, frame: &Frame) -> Drawn {
        self.canvas.fill(&WHITE)?;
        self.grid(frame)?;
        if let Some(band) = &plot.band {
            for piece in pieces(plot, band, frame) {
                self.canvas.draw(&PathElement::new(piece, stroke(BAND, BAND_STROKE)))?;
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
        self.labels(plot, frame)?;
        self.legend(plot, frame)?;
        self.canvas.present()
    }

    fn grid(&self, frame: &Frame) -> Drawn {
        let (x, y) = (&frame.x, &frame.y);
        let color = |value: f64| if value == 0.0 { ZERO } else { GRID };
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
        self.line(&[(x.from, y.to), (x.from, y.from), (x.to, y.from)], AXIS)
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
            self.canvas.draw(&PathElement::new(sample, stroke(BAND, BAND_STROKE)))?;
            let at = (entry.left + SAMPLE + SAMPLE_GAP, entry.middle);
            self.text(&band.label, at, TEXT_SIZE, beside, FontTransform::None)?;
        }
        if let Some(Entry { left, middle, .. }) = frame.ends {
            let [start, end] = ENDS;
            let second = left + SAMPLE + SAMPLE_GAP + text_width(start, TEXT_SIZE);
            for (text, left) in [(start, left), (end, second)] {
                let at = (left + SAMPLE - END_RADIUS, middle);
                if text == start {
                    self.ring(at, AXIS)?
                } else {
                    self.dot(at, AXIS)?
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
                let (dash, gap) = ((DASH.0 * FINE) as i32, (DASH.1 * FINE) as i32);
                self.canvas.draw(&DashedPathElement::new(points, dash, gap, stroke(color, CURVE_STROKE)))
            }
        }
    }

    fn ring(&self, at: (f64, f64), color: RGBColor) -> Drawn {
        let radius = (END_RADIUS * FINE) as i32;
        self.canvas.draw(&Circle::new(fine(at), radius, WHITE.filled()))?;
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
        self.canvas.draw(&Text::new(text, fine(at), font.color(&INK).pos(pos)))
    }
}

/// The parts of a curve between its gaps, thinned out if it is long.
fn pieces(plot: &Plot, curve: &Curve, frame: &Frame) -> Vec<Vec<(i32, i32)>> {
    let parts = curve.points.split(|point| !plot.can_draw(point)).filter(|part| !part.is_empty());
    parts
        .map(|part| {
            let mut places: Vec<_> = part.iter().map(|&(x, y)| (frame.x.at(x), frame.y.at(y))).collect();
            if curve.points.len() > MANY {
                places = thin(&places, COLUMN);
            }
            let mut drawn: Vec<_> = places.into_iter().map(fine).collect();
            drawn.dedup();
            drawn
        })
        .collect()
}
