//! Plots of runs: curves on a pair of axes, as an SVG picture.
//!
//! A picture is made in four steps, each in its file: `frame` finds ranges and margins, with the marks that `ticks`
//! chooses for an axis; `thin` reduces a curve to what can be seen of it; `draw` hands lines and texts to plotters.

mod draw;
mod ends;
mod frame;
mod thin;
mod ticks;

use std::path::Path;

use crate::error::StudyError;
use crate::file::replace_file;
#[cfg(feature = "viewer")]
pub(crate) use draw::{INKS, dark_style, grid, ink, paper};

/// Curves on a pair of axes, drawn as SVG.
///
/// - Colours stay apart for the common kinds of colour blindness and have a contrast of at least 3:1; from the seventh
///   curve on they repeat, dashed. Where the reader's system is dark, so is the picture.
/// - The file begins with the title and what its curves are, for browsers and screen readers.
/// - The legend stands above the axes, so it hides no curve; curves with an empty label are not in it.
/// - A point that is not finite, or beyond `1e300`, is a gap in its curve.
/// - Where values differ by less than `1e-9` of their size, the axis does not magnify further and the curve looks
///   flat: draw differences, such as a [`drift`](crate::drift), to see more.
/// - A curve of more than 4000 points is thinned out: of successive points in one column of a quarter pixel, only
///   the first, the lowest, the highest and the last are drawn. The drawn line is nowhere farther than a
///   quarter pixel from the curve, nor the curve from it, and the extremes of `y` are kept exactly. So a curve over
///   time makes at most 16 points per pixel of its width, however long it is; a track that goes to and fro makes
///   more.
///
/// ```
/// use guen_study::Plot;
///
/// let circle = (0..=100).map(|k| f64::from(k) * 0.0628).map(|s| (s.cos(), s.sin()));
/// let path = std::env::temp_dir().join("guen-study-example").join("circle.svg");
/// Plot::new("Track of the contact point")
///     .size(480, 480)
///     .axes("x in m", "y in m")
///     .equal_scale(true)
///     .line("hoop", circle)
///     .mark_ends(true)
///     .save(&path)?;
/// # Ok::<(), guen_study::StudyError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use = "a plot is a description: `save` or `to_svg` draws it"]
pub struct Plot {
    title: String,
    width: u32,
    height: u32,
    x_label: String,
    y_label: String,
    equal_scale: bool,
    mark_ends: bool,
    mark_points: bool,
    logarithmic: bool,
    curves: Vec<Curve>,
    faint: Vec<Curve>,
    band: Option<Curve>,
    moments: Option<(String, Vec<f64>)>,
}

#[derive(Clone, Debug, PartialEq)]
struct Curve {
    label: String,
    points: Vec<(f64, f64)>,
}

impl Plot {
    /// A picture of 800 by 480 pixels with a title, which may be empty, and no curves yet.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            width: 800,
            height: 480,
            x_label: String::new(),
            y_label: String::new(),
            equal_scale: false,
            mark_ends: false,
            mark_points: false,
            logarithmic: false,
            curves: Vec::new(),
            faint: Vec::new(),
            band: None,
            moments: None,
        }
    }

    /// Sets the size in pixels, from 240 by 180 to 20000 by 20000. A long legend needs more.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        (self.width, self.height) = (width, height);
        self
    }

    /// Sets the texts at the axes; an empty one takes no room.
    pub fn axes(mut self, x: impl Into<String>, y: impl Into<String>) -> Self {
        (self.x_label, self.y_label) = (x.into(), y.into());
        self
    }

    /// Makes a unit as long on one axis as on the other, or not: for tracks on a plane, so that a circle is round.
    pub fn equal_scale(mut self, equal: bool) -> Self {
        self.equal_scale = equal;
        self
    }

    /// Marks where each curve starts with a ring and where it ends with a dot, or does not.
    pub fn mark_ends(mut self, mark: bool) -> Self {
        self.mark_ends = mark;
        self
    }

    /// Marks every point of every curve with a dot, or does not: for measurements.
    pub fn mark_points(mut self, mark: bool) -> Self {
        self.mark_points = mark;
        self
    }

    /// Makes both axes logarithmic, or not. Points that are not positive are gaps then, and `equal_scale` means a
    /// decade as long on one axis as on the other.
    ///
    /// ```
    /// use guen_study::Plot;
    ///
    /// let errors = (1..=8).map(|k| 0.5_f64.powi(k)).map(|h| (h, h.powi(4)));
    /// let text = Plot::new("order four").axes("step", "error").logarithmic(true).line("RK4", errors).to_svg()?;
    /// assert!(text.contains("10⁻²"));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn logarithmic(mut self, logarithmic: bool) -> Self {
        self.logarithmic = logarithmic;
        self
    }

    /// Adds a broad grey line behind all curves, and its label.
    pub fn band(mut self, label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.band = Some(Curve { label: label.into(), points: points.into_iter().collect() });
        self
    }

    /// Adds a thin grey line behind the curves, with its label at its last point: for what the curves are compared with.
    ///
    /// ```
    /// use guen_study::Plot;
    ///
    /// let power = |n: i32| (1..=8).map(move |k| 0.5_f64.powi(k)).map(move |h| (h, h.powi(n)));
    /// let orders = (1..=5).fold(Plot::new("orders").logarithmic(true), |plot, n| plot.faint(format!("h^{n}"), power(n)));
    /// let text = orders.line("measured", power(3)).to_svg()?;
    /// assert!(text.contains("h^5"));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn faint(mut self, label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.faint.push(Curve { label: label.into(), points: points.into_iter().collect() });
        self
    }

    /// Draws a thin dashed line across the picture at each of these places of the first axis, behind the curves: for events and transitions.
    /// The description of the picture counts them by the label. Places outside of the axis are not drawn.
    ///
    /// ```
    /// use guen_study::Plot;
    ///
    /// let bounces = Plot::new("a ball").line("height", [(0.0, 1.0), (1.0, 0.0), (2.0, 0.5)]).moments("impact", [1.0]);
    /// assert!(bounces.to_svg()?.contains("1 impact"));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn moments(mut self, label: impl Into<String>, places: impl IntoIterator<Item = f64>) -> Self {
        self.moments = Some((label.into(), places.into_iter().collect()));
        self
    }

    /// Everything in the order in which it is drawn: the band first.
    fn drawn(&self) -> impl Iterator<Item = &Curve> {
        self.band.iter().chain(&self.faint).chain(&self.curves)
    }

    /// Whether a point can be drawn. The bound keeps differences of coordinates finite.
    fn can_draw(&self, &(x, y): &(f64, f64)) -> bool {
        const LARGEST_VALUE: f64 = 1e300;
        x.abs() <= LARGEST_VALUE && y.abs() <= LARGEST_VALUE && (!self.logarithmic || x > 0.0 && y > 0.0)
    }

    /// Adds a curve.
    pub fn line(mut self, label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.curves.push(Curve { label: label.into(), points: points.into_iter().collect() });
        self
    }

    /// The picture as the text of an SVG file.
    ///
    /// ```
    /// use guen_study::{Plot, StudyError};
    ///
    /// let text = Plot::new("two points").line("", [(0.0, 1.0), (1.0, 3.0)]).to_svg()?;
    /// assert!(text.contains("two points"));
    /// assert!(matches!(Plot::new("none").to_svg(), Err(StudyError::NothingToDraw { .. })));
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A size out of its range, or too small for the legend; no finite point in any curve; a complaint of the drawing library.
    pub fn to_svg(&self) -> Result<String, StudyError> {
        draw::draw(self)
    }

    /// The picture as an element of a page that has [`dark_style`].
    #[cfg(feature = "viewer")]
    pub(crate) fn to_inline_svg(&self) -> Result<String, StudyError> {
        draw::draw_inline(self)
    }

    /// Writes the picture to a file, whole or not at all: see [`replace_file`].
    ///
    /// # Errors
    ///
    /// Those of [`to_svg`](Plot::to_svg), and [`StudyError::Io`] with the path.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        let text = self.to_svg()?;
        replace_file(path, |out| out.write_all(text.as_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(samples: u32) -> impl Iterator<Item = (f64, f64)> {
        (0..=samples).map(move |k| f64::from(k) * 20.0 / f64::from(samples)).map(|t| (t, t.sin()))
    }

    #[test]
    fn a_faint_curve_is_drawn_with_its_label_at_its_end() {
        let lines = |text: &str| text.matches("<polyline").count();
        let plain = Plot::new("sine").line("sin", sine(20)).to_svg().unwrap();
        let both = Plot::new("sine").line("sin", sine(20)).faint("half", sine(20).map(|(t, x)| (t, x / 2.0)));
        let both = both.to_svg().unwrap();
        assert_eq!(lines(&both), lines(&plain) + 1);
        let texts: Vec<&str> = both.split("<text").skip(1).filter(|text| text.contains("half")).collect();
        assert_eq!(texts.len(), 1, "{both}");
    }

    #[test]
    fn a_long_curve_makes_a_short_file() {
        let text = Plot::new("sine").line("sin", sine(1_000_000)).to_svg().unwrap();
        assert!(text.len() < 200_000, "{} bytes", text.len());
    }

    #[test]
    fn a_gap_where_a_point_is_not_finite() {
        let pieces = |points: &[(f64, f64)]| {
            let text = Plot::new("").line("", points.iter().copied()).to_svg().unwrap();
            text.lines().filter(|line| line.starts_with("<polyline") && line.contains("#0072B2")).count()
        };
        assert_eq!(pieces(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 1.0), (4.0, 1.0)]), 1);
        assert_eq!(pieces(&[(0.0, 0.0), (1.0, 1.0), (2.0, f64::NAN), (3.0, 1.0), (4.0, 1.0)]), 2);
        assert_eq!(pieces(&[(0.0, 0.0), (1.0, 1.0), (f64::INFINITY, 0.0)]), 1);
    }

    #[test]
    fn texts_are_escaped() {
        let text = Plot::new("a < b & c").axes("<x>", "\"y\"").line("p & q", sine(10)).to_svg().unwrap();
        assert!(
            text.contains("a &lt; b &amp; c") && text.contains("&lt;x&gt;") && text.contains("p &amp; q")
        );
    }

    #[test]
    fn titles_are_told_and_dark_readers_have_their_colours() {
        let text =
            Plot::new("a < b").axes("t in s", "").line("p", sine(10)).line("q", sine(5)).to_svg().unwrap();
        let (_, rest) = text.split_once(">\n").unwrap();
        assert!(
            rest.starts_with("<title>a &lt; b</title>\n<desc>Curves on axes t in s: p, q</desc>"),
            "{rest}"
        );
        // Every colour that is drawn has a rule of its own, so nothing stays light in the dark.
        let (style, drawn) = text.split_once("</style>").unwrap();
        for part in drawn.split("=\"#").skip(1) {
            assert!(style.contains(&format!("=\"#{}\"]", &part[..6])), "{}", &part[..6]);
        }
        let untitled = Plot::new("").line("p & q", sine(10)).to_svg().unwrap();
        assert!(untitled.contains("<title>p &amp; q</title>"));
    }

    #[test]
    fn colours_of_lines_are_seen() {
        let luminance = |hex: &str| {
            let part = |k: usize| f64::from(u8::from_str_radix(&hex[k..k + 2], 16).unwrap()) / 255.0;
            let linear = |c: f64| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
            0.2126 * linear(part(0)) + 0.7152 * linear(part(2)) + 0.0722 * linear(part(4))
        };
        let text =
            (0..6).fold(Plot::new("t"), |plot, k| plot.line(format!("{k}"), sine(3 + k))).to_svg().unwrap();
        let (style, _) = text.split_once("</style>").unwrap();
        let contrast = |a: f64, b: f64| (f64::max(a, b) + 0.05) / (f64::min(a, b) + 0.05);
        let mut seen = 0;
        for rule in style.split("[stroke=\"#").skip(1).take(6) {
            let (light, dark) = (&rule[..6], &rule.split_once(":#").unwrap().1[..6]);
            assert!(contrast(luminance(light), 1.0) >= 3.0, "{light}");
            assert!(contrast(luminance(dark), luminance("1B1F24")) >= 3.0, "{dark}");
            seen += 1;
        }
        assert_eq!(seen, 6);
    }

    #[test]
    fn refusals_are_typed() {
        let empty = Plot::new("e").line("x", [(f64::NAN, 0.0), (0.0, f64::INFINITY)]);
        assert!(matches!(empty.to_svg(), Err(StudyError::NothingToDraw { .. })));
        for (width, height) in [(0, 0), (239, 400), (400, 179), (u32::MAX, 400)] {
            let plot = Plot::new("s").size(width, height).line("x", sine(10));
            assert!(matches!(plot.to_svg(), Err(StudyError::Size { .. })));
        }
        let crowded =
            (0..40).fold(Plot::new("c").size(240, 180), |plot, k| plot.line(format!("curve {k}"), sine(3)));
        assert!(matches!(crowded.to_svg(), Err(StudyError::Size { .. })));
    }

    #[test]
    fn strange_data_is_drawn() {
        for points in [
            vec![(0.0, 0.0)],
            vec![(1.0, 5.0), (1.0, 5.0)],
            vec![(1e300, -1e300), (-1e300, 1e300)],
            vec![(0.0, 5e-324), (1.0, 0.0)],
            vec![(1e15, 1.0), (1e15 + 1.0, 1.0 + 1e-15)],
        ] {
            for equal in [false, true] {
                for size in [(240, 180), (2000, 300)] {
                    let plot = Plot::new("t").axes("x", "y").line("l", points.clone()).mark_ends(true);
                    let text = plot.size(size.0, size.1).equal_scale(equal).to_svg().unwrap();
                    assert!(!text.contains("NaN") && text.ends_with("</svg>\n"), "{points:?}");
                }
            }
        }
    }

    #[test]
    fn a_file_in_a_new_folder() {
        let folder = std::env::temp_dir().join(format!("guen-study-svg-{}", std::process::id()));
        let path = folder.join("deep/sine.svg");
        let plot = Plot::new("sine").line("sin", sine(100));
        plot.save(&path).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), plot.to_svg().unwrap());
        assert!(matches!(plot.save(&folder), Err(StudyError::Io { .. })));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
