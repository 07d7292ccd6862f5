//! Designs: which points of which axes a sweep visits. Every point is computed from its number, so that a part of a sweep needs none
//! of the others, and a design takes no memory for its points.

mod axes;
mod fault;
mod point;

use guen_runtime::Real;

use super::error::SweepError;
use super::normal;
use super::random::{Permutation, Philox, unit};

pub use axes::{Grid, Sampling};
pub use fault::DesignFault;
pub use point::{Point, UnknownAxis, UnknownEntry};

/// The points of a sweep: so many numbers with names each, one point for each motion.
///
/// | design | points |
/// | --- | --- |
/// | [`grid`](Self::grid) | every combination of the values of its axes |
/// | [`random`](Self::random) | independent points |
/// | [`latin_hypercube`](Self::latin_hypercube) | one point in each of `count` equal layers of every axis |
/// | `sobol`, feature `sobol` | the quasi-random sequence of Sobol, shifted at random |
/// | [`points`](Self::points) | those of a table |
///
/// The points depend on the design and its seed alone: they have the same bits on every machine.
///
/// ```
/// use guen_study::Design;
///
/// let grid = Design::grid().linear("c", 0.0, 1.0, 11).values("m", [1.0, 2.0, 5.0]).design();
/// assert_eq!(grid.len(), 33);
/// let drawn = Design::latin_hypercube(1000, 7).uniform("c", 0.0, 1.0).normal("m", 2.0, 0.1).design();
/// let point = drawn.point(17).unwrap();
/// assert!(point[0] > 0.0 && point[0] < 1.0 && (point[1] - 2.0).abs() < 0.5);
/// ```
#[derive(Clone, Debug)]
pub struct Design {
    names: Vec<String>,
    kind: Kind,
    count: u64,
}

#[derive(Clone, Debug)]
enum Kind {
    Grid(Vec<Vec<f64>>),
    Sampled {
        sampling: Method,
        seed: u64,
        axes: Vec<Distribution>,
    },
    /// Values row by row, and whether every row has one for each name.
    Points {
        values: Vec<f64>,
        fits: bool,
    },
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Method {
    Random,
    LatinHypercube,
    #[cfg(feature = "sobol")]
    Sobol,
}

/// A distribution along an axis.
#[derive(Clone, Debug)]
enum Distribution {
    Uniform { low: f64, high: f64 },
    LogUniform { low: f64, high: f64 },
    Normal { mean: f64, deviation: f64 },
    Choice(Vec<f64>),
}

impl Distribution {
    /// The number at this part of the distribution, inside of the unit interval.
    fn at(&self, part: f64) -> f64 {
        match self {
            // Rounding brings no number out of its range.
            Self::Uniform { low, high } => between(*low, *high, part).min(*high).max(*low),
            Self::LogUniform { low, high } => between_quotients(*low, *high, part).min(*high).max(*low),
            Self::Normal { mean, deviation } => mean + deviation * normal::quantile(part),
            Self::Choice(values) => {
                let place = (part * values.len() as f64) as usize;
                values.get(place).or(values.last()).copied().unwrap_or(f64::NAN)
            }
        }
    }

    fn fault(&self) -> Option<DesignFault> {
        match self {
            Self::Uniform { low, high } => (!is_range(*low, *high)).then_some(DesignFault::Range),
            Self::LogUniform { low, high } => {
                (!is_range(*low, *high) || *low <= 0.0).then_some(DesignFault::LogarithmicRange)
            }
            Self::Normal { mean, deviation } => {
                let is_finite = (mean.abs() + MOST_DEVIATIONS * deviation).is_finite();
                (!is_finite || *deviation < 0.0).then_some(DesignFault::Normal)
            }
            Self::Choice(values) => of_values(values),
        }
    }
}

/// More standard deviations than any point is away from its mean.
const MOST_DEVIATIONS: f64 = 9.0;

fn is_range(low: f64, high: f64) -> bool {
    low <= high && low.is_finite() && high.is_finite()
}

/// The number at a part of the way between two ends, whose distance may be beyond the largest number.
fn between(low: f64, high: f64, part: f64) -> f64 {
    let way = high - low;
    if way.is_finite() { low + part * way } else { low * (1.0 - part) + high * part }
}

/// The number at a part of the way between two ends in logarithms. Their quotient may be beyond the largest number: then its fourth root is
/// taken four times.
fn between_quotients(low: f64, high: f64, part: f64) -> f64 {
    let quotient = high / low;
    if quotient.is_finite() {
        return low * Real::exp(part * Real::ln(quotient));
    }
    let root = Real::exp(part * (Real::ln(high) - Real::ln(low)) / 4.0);
    [root; 4].into_iter().fold(low, |product, root| product * root)
}

fn of_values(values: &[f64]) -> Option<DesignFault> {
    if values.is_empty() {
        Some(DesignFault::NoValues)
    } else if values.iter().any(|value| !value.is_finite()) {
        Some(DesignFault::NotFinite)
    } else {
        None
    }
}

impl Design {
    /// A grid, to be given axes.
    pub fn grid() -> Grid {
        Grid::default()
    }

    /// Independent points, to be given axes.
    pub fn random(count: u64, seed: u64) -> Sampling {
        Sampling::new(Method::Random, count, seed)
    }

    /// A Latin hypercube, to be given axes: every axis is cut into `count` layers of equal probability, and each layer has one point.
    /// Means over it are much closer than those over random points where the result depends on each axis by itself.
    pub fn latin_hypercube(count: u64, seed: u64) -> Sampling {
        Sampling::new(Method::LatinHypercube, count, seed)
    }

    /// The first `count` points of the sequence of Sobol, with a random shift of their digits, to be given axes. Powers of two are the best counts.
    #[cfg(feature = "sobol")]
    #[cfg_attr(docsrs, doc(cfg(feature = "sobol")))]
    pub fn sobol(count: u64, seed: u64) -> Sampling {
        Sampling::new(Method::Sobol, count, seed)
    }

    /// The rows of a table, one point each.
    pub fn points<R: AsRef<[f64]>>(
        names: impl IntoIterator<Item = impl Into<String>>,
        rows: impl IntoIterator<Item = R>,
    ) -> Self {
        let names: Vec<String> = names.into_iter().map(Into::into).collect();
        let (mut values, mut count, mut fits) = (Vec::new(), 0, true);
        for row in rows {
            fits &= row.as_ref().len() == names.len();
            values.extend_from_slice(row.as_ref());
            count += 1;
        }
        Self { names, kind: Kind::Points { values, fits }, count }
    }

    /// The number of points.
    pub fn len(&self) -> u64 {
        self.count
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The names of the axes.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The point with this number, one value for each axis; none if there are fewer points. A point of a Sobol sequence takes a look at tables
    /// that are unpacked for it, some milliseconds.
    pub fn point(&self, index: u64) -> Option<Vec<f64>> {
        let mut values = Vec::new();
        (index < self.count).then(|| self.points_at().at(index, &mut values))?;
        Some(values)
    }

    /// The design, or why it is none.
    pub(super) fn checked(self) -> Result<Self, SweepError> {
        const MOST: u64 = 1 << 53;
        let fault = |axis: Option<&String>, fault| Err(SweepError::Design { axis: axis.cloned(), fault });
        if let Some((place, _)) =
            self.names.iter().enumerate().find(|(k, name)| self.names[..*k].contains(*name))
        {
            return fault(self.names.get(place), DesignFault::Duplicate);
        }
        let faulty = |place: usize, found: Option<DesignFault>| found.map(|found| (place, found));
        let found = match &self.kind {
            Kind::Grid(axes) => axes.iter().enumerate().find_map(|(k, values)| faulty(k, of_values(values))),
            Kind::Sampled { axes, .. } => {
                axes.iter().enumerate().find_map(|(k, axis)| faulty(k, axis.fault()))
            }
            Kind::Points { fits: false, .. } => return fault(None, DesignFault::Rows),
            Kind::Points { values, .. } => values
                .iter()
                .position(|value| !value.is_finite())
                .map(|place| (place % self.names.len(), DesignFault::NotFinite)),
        };
        if let Some((place, found)) = found {
            return fault(self.names.get(place), found);
        }
        #[cfg(feature = "sobol")]
        if matches!(self.kind, Kind::Sampled { sampling: Method::Sobol, .. }) && self.names.len() > MOST_AXES
        {
            return fault(None, DesignFault::TooManyAxes);
        }
        match self.count {
            0 => fault(None, DesignFault::NoPoints),
            count if count > MOST => fault(None, DesignFault::TooManyPoints),
            _ => Ok(self),
        }
    }

    /// The points, with the tables that computing them takes.
    pub(super) fn points_at(&self) -> PointsAt<'_> {
        #[cfg(feature = "sobol")]
        let directions = match self.kind {
            Kind::Sampled { sampling: Method::Sobol, .. } => directions(self.names.len()),
            _ => Vec::new(),
        };
        /// Streams of permutations begin here, and those of points below.
        const PERMUTATIONS: u64 = 1 << 32;
        let layers = match self.kind {
            Kind::Sampled { sampling: Method::LatinHypercube, seed, .. } => (0..self.names.len() as u64)
                .map(|axis| Permutation::new(Philox::new(seed), PERMUTATIONS + axis, self.count))
                .collect(),
            _ => Vec::new(),
        };
        PointsAt {
            design: self,
            layers,
            #[cfg(feature = "sobol")]
            directions,
        }
    }

    /// The design in words, as a manifest has it.
    pub(super) fn text(&self) -> String {
        let kind = match &self.kind {
            Kind::Grid(axes) => format!("grid {axes:?}"),
            Kind::Sampled { sampling, seed, axes } => format!("{sampling:?} seed {seed} {axes:?}"),
            Kind::Points { .. } => "points of a table".to_owned(),
        };
        format!("{} points, axes {:?}, {kind}", self.count, self.names)
    }

    /// The numbers of a table, for a digest.
    pub(super) fn table(&self) -> &[f64] {
        if let Kind::Points { values, .. } = &self.kind { values } else { &[] }
    }
}

/// The most axes that there are direction numbers for (Joe and Kuo, 2008).
#[cfg(feature = "sobol")]
const MOST_AXES: usize = 21_201;

/// The direction numbers of so many axes.
#[cfg(feature = "sobol")]
fn directions(axes: usize) -> Vec<Vec<u64>> {
    use sobol::Sobol;
    use sobol::params::JoeKuoD6;
    /// The axes of the short table, which is quickly unpacked.
    const FEW: usize = 100;
    let parameters = if axes <= FEW { JoeKuoD6::minimal() } else { JoeKuoD6::extended() };
    if axes == 0 { Vec::new() } else { Sobol::<u64>::init_direction_vals::<u32>(axes, 64, &parameters) }
}

/// The points of a design by their numbers.
pub(super) struct PointsAt<'a> {
    design: &'a Design,
    /// The layer of each point of a Latin hypercube, for each axis.
    layers: Vec<Permutation>,
    #[cfg(feature = "sobol")]
    directions: Vec<Vec<u64>>,
}

impl PointsAt<'_> {
    /// Writes the values of a point, over those that are there.
    pub(super) fn at(&self, index: u64, values: &mut Vec<f64>) {
        values.clear();
        match &self.design.kind {
            Kind::Grid(axes) => {
                let mut rest = index;
                values.resize(axes.len(), 0.0);
                for (value, axis) in values.iter_mut().zip(axes).rev() {
                    let length = axis.len() as u64;
                    *value = axis[(rest % length) as usize];
                    rest /= length;
                }
            }
            Kind::Points { values: all, .. } => {
                let width = self.design.names.len();
                let first = index as usize * width;
                values.extend_from_slice(all.get(first..first + width).unwrap_or_default());
            }
            Kind::Sampled { sampling, seed, axes } => {
                let random = Philox::new(*seed);
                let parts = axes
                    .iter()
                    .enumerate()
                    .map(|(axis, distribution)| distribution.at(self.part(*sampling, &random, index, axis)));
                values.extend(parts);
            }
        }
    }

    /// The part of the distribution of an axis at which a point lies.
    fn part(&self, sampling: Method, random: &Philox, index: u64, axis: usize) -> f64 {
        let own = random.unit(index, axis as u64);
        match sampling {
            Method::Random => own,
            Method::LatinHypercube => {
                let layer = self.layers[axis].at(index);
                inside((layer as f64 + own) / self.design.count as f64)
            }
            #[cfg(feature = "sobol")]
            Method::Sobol => {
                let digits = self.directions[axis].iter().enumerate();
                let point =
                    digits.fold(0, |sum, (bit, direction)| sum ^ (direction * ((index >> bit.min(63)) & 1)));
                unit(point ^ random.bits(u64::MAX, axis as u64))
            }
        }
    }
}

/// A number that rounding has not brought to an end of the unit interval.
fn inside(part: f64) -> f64 {
    part.clamp(unit(0), unit(u64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_visit_every_combination_and_meet_their_ends() {
        let grid = Design::grid().values("a", [1.0, 2.0]).linear("b", 0.0, 0.3, 4).design();
        let points: Vec<Vec<f64>> = (0..8).filter_map(|k| grid.point(k)).collect();
        assert_eq!(points[0], [1.0, 0.0]);
        assert_eq!(points[3], [1.0, 0.3]);
        assert_eq!(points[7], [2.0, 0.3]);
        assert_eq!(grid.point(8), None);
        let logarithmic = Design::grid().logarithmic("k", 0.01, 100.0, 5).design();
        for (k, expected) in [0.01, 0.1, 1.0, 10.0, 100.0].into_iter().enumerate() {
            assert!((logarithmic.point(k as u64).unwrap()[0] / expected - 1.0).abs() < 1e-14);
        }
        let one = Design::grid().linear("b", 4.0, 9.0, 1).design();
        assert_eq!(one.point(0), Some(vec![4.0]));
    }

    #[test]
    fn ranges_may_be_as_wide_as_numbers_are() {
        let first = |grid: Grid, k| grid.design().point(k).unwrap()[0];
        let wide = |k| first(Design::grid().linear("a", -1.5e308, 1.5e308, 5), k);
        assert_eq!([wide(1), wide(2), wide(3)], [-0.75e308, 0.0, 0.75e308]);
        for (low, high) in [(1e-200, 1e200), (5e-324, f64::MAX)] {
            let middle = first(Design::grid().logarithmic("a", low, high, 3), 1);
            assert!((middle / (low.sqrt() * high.sqrt()) - 1.0).abs() < 1e-12, "{middle}");
        }
        let drawn = Design::random(400, 1)
            .log_uniform("a", 1e-200, 1e200)
            .uniform("b", f64::MIN, f64::MAX)
            .log_uniform("c", 1.9, 1.9_f64.next_up())
            .uniform("d", -1e-17, 1.0);
        let design = drawn.design().checked().unwrap();
        let points: Vec<Vec<f64>> = (0..400).filter_map(|k| design.point(k)).collect();
        let ranges = [(1e-200, 1e200), (f64::MIN, f64::MAX), (1.9, 1.9_f64.next_up()), (-1e-17, 1.0)];
        for (axis, (low, high)) in ranges.into_iter().enumerate() {
            assert!(points.iter().all(|point| low <= point[axis] && point[axis] <= high), "{axis}");
        }
        let mean = points.iter().map(|point| point[0].log10()).sum::<f64>() / 400.0;
        assert!(mean.abs() < 25.0, "{mean}");
        // The far points of a normal distribution count as well as those that are usual.
        let normal = |deviation| Design::random(1, 1).normal("a", 0.0, deviation).design().checked();
        assert!(normal(1e307).is_ok());
        assert!(matches!(normal(1e308), Err(SweepError::Design { fault: DesignFault::Normal, .. })));
    }

    #[test]
    fn a_latin_hypercube_has_one_point_in_every_layer_of_every_axis() {
        let design =
            Design::latin_hypercube(500, 3).uniform("a", -1.0, 1.0).uniform("b", 0.0, 500.0).design();
        let points: Vec<Vec<f64>> = (0..500).filter_map(|k| design.point(k)).collect();
        for (axis, scale, low) in [(0, 250.0, -1.0), (1, 1.0, 0.0)] {
            let mut layers: Vec<usize> =
                points.iter().map(|point| ((point[axis] - low) * scale) as usize).collect();
            layers.sort_unstable();
            assert!(layers.into_iter().eq(0..500));
        }
        // Axes do not follow each other.
        let cross: f64 = points.iter().map(|p| p[0] * (p[1] / 250.0 - 1.0)).sum();
        assert!((cross / 500.0).abs() < 0.1, "{cross}");
    }

    #[cfg(feature = "sobol")]
    #[test]
    fn a_sobol_sequence_fills_boxes_evenly() {
        let axes = ["a", "b", "c", "d"];
        let sampling = axes.iter().fold(Design::sobol(1 << 12, 9), |all, name| all.uniform(*name, 0.0, 1.0));
        let design = sampling.design();
        let at = design.points_at();
        let mut point = Vec::new();
        // The first two axes are a (0, 2)-sequence: every box of this area has exactly one point, a digital shift or not.
        for (across, down) in [(64, 64), (1, 4096), (4096, 1), (16, 256)] {
            let mut boxes = vec![0; 4096];
            for k in 0..4096 {
                at.at(k, &mut point);
                let column = (point[0] * f64::from(across)) as usize;
                boxes[column * down + (point[1] * down as f64) as usize] += 1;
            }
            assert!(boxes.iter().all(|count| *count == 1), "{across} by {down}");
        }
        // The error of a mean is far below that of random points, 1 / sqrt(12 * 4096) = 0.0045.
        for axis in 0..4 {
            let mut value = |k| {
                at.at(k, &mut point);
                point[axis]
            };
            let sum: f64 = (0..4096).map(&mut value).sum();
            assert!((sum / 4096.0 - 0.5).abs() < 2e-4);
        }
        assert_ne!(design.point(0), Design::sobol(1 << 12, 8).uniform("a", 0.0, 1.0).design().point(0));
    }

    #[test]
    fn distributions_have_their_moments() {
        let design = Design::random(20_000, 1)
            .normal("n", 3.0, 2.0)
            .log_uniform("l", 0.1, 10.0)
            .choice("c", [1.0, 5.0])
            .design();
        let at = design.points_at();
        let (mut sums, mut point) = ([0.0; 4], Vec::new());
        for k in 0..20_000 {
            at.at(k, &mut point);
            let terms = [point[0], (point[0] - 3.0).powi(2), point[1].log10(), point[2]];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term / 20_000.0);
        }
        // Three to four deviations of each mean.
        for (found, expected, error) in
            [(sums[0], 3.0, 0.05), (sums[1], 4.0, 0.14), (sums[2], 0.0, 0.015), (sums[3], 3.0, 0.05)]
        {
            assert!((found - expected).abs() < error, "{found} for {expected}");
        }
    }

    #[test]
    fn designs_that_make_no_sense_are_refused_at_their_axis() {
        let name = |axis: &str| Some(axis.to_owned());
        for (design, axis, fault) in [
            (Design::grid().values("a", []).design(), name("a"), DesignFault::NoValues),
            (Design::grid().values("a", [1.0, f64::NAN]).design(), name("a"), DesignFault::NotFinite),
            (Design::random(0, 0).design(), None, DesignFault::NoPoints),
            (Design::random(1 << 60, 0).design(), None, DesignFault::TooManyPoints),
            (
                Design::grid().values("a", [1.0]).values("a", [2.0]).design(),
                name("a"),
                DesignFault::Duplicate,
            ),
            (Design::random(1, 0).uniform("u", 1.0, 0.0).design(), name("u"), DesignFault::Range),
            (
                Design::random(1, 0).log_uniform("u", 0.0, 1.0).design(),
                name("u"),
                DesignFault::LogarithmicRange,
            ),
            (Design::random(1, 0).normal("u", 0.0, -1.0).design(), name("u"), DesignFault::Normal),
            (Design::points(["a", "b"], [[1.0, 2.0].as_slice(), &[3.0]]), None, DesignFault::Rows),
            (Design::points(["a", "b"], [[1.0, f64::NAN]]), name("b"), DesignFault::NotFinite),
        ] {
            match design.checked() {
                Err(SweepError::Design { axis: found, fault: told }) => {
                    assert_eq!((found, told), (axis, fault));
                }
                other => panic!("{other:?} where {fault:?}"),
            }
        }
    }
}
