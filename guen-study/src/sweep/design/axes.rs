//! The axes of grids and of drawn points, as they are declared.

use super::{Design, Distribution, Kind, Method, between, between_quotients};

/// The axes of a grid, of which the last one changes fastest.
#[derive(Clone, Debug, Default)]
#[must_use = "a grid becomes a design by `design`, or in a sweep"]
pub struct Grid {
    names: Vec<String>,
    axes: Vec<Vec<f64>>,
}

impl Grid {
    /// Adds an axis with these values.
    pub fn values(mut self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        self.names.push(name.into());
        self.axes.push(values.into_iter().collect());
        self
    }

    /// Adds an axis of `count` values at equal distances, both ends included.
    pub fn linear(self, name: impl Into<String>, low: f64, high: f64, count: usize) -> Self {
        self.spaced(name, (low, high), count, between)
    }

    /// Adds an axis of `count` values with equal quotients, both ends included, which have to be positive.
    pub fn logarithmic(self, name: impl Into<String>, low: f64, high: f64, count: usize) -> Self {
        self.spaced(name, (low, high), count, between_quotients)
    }

    /// Adds an axis of `count` values: its ends, and what is so far between them.
    fn spaced(
        self,
        name: impl Into<String>,
        (low, high): (f64, f64),
        count: usize,
        at: fn(f64, f64, f64) -> f64,
    ) -> Self {
        let values = (0..count).map(|k| match k {
            0 => low,
            k if k + 1 == count => high,
            k => at(low, high, k as f64 / (count - 1) as f64),
        });
        self.values(name, values)
    }

    /// The design of these axes.
    pub fn design(self) -> Design {
        let Self { names, axes } = self;
        let count = axes.iter().fold(1_u64, |count, values| count.saturating_mul(values.len() as u64));
        Design { names, kind: Kind::Grid(axes), count }
    }
}

/// The axes of a design whose points are drawn, each with its distribution.
#[derive(Clone, Debug)]
#[must_use = "a sampling becomes a design by `design`, or in a sweep"]
pub struct Sampling {
    names: Vec<String>,
    method: Method,
    seed: u64,
    count: u64,
    axes: Vec<Distribution>,
}

impl Sampling {
    pub(super) fn new(method: Method, count: u64, seed: u64) -> Self {
        Self { names: Vec::new(), method, seed, count, axes: Vec::new() }
    }

    fn with(mut self, name: impl Into<String>, axis: Distribution) -> Self {
        self.names.push(name.into());
        self.axes.push(axis);
        self
    }

    /// Adds an axis whose values are equally likely between two ends.
    pub fn uniform(self, name: impl Into<String>, low: f64, high: f64) -> Self {
        self.with(name, Distribution::Uniform { low, high })
    }

    /// Adds an axis whose logarithms are equally likely between those of two positive ends.
    pub fn log_uniform(self, name: impl Into<String>, low: f64, high: f64) -> Self {
        self.with(name, Distribution::LogUniform { low, high })
    }

    /// Adds an axis with a normal distribution of this mean and standard deviation.
    pub fn normal(self, name: impl Into<String>, mean: f64, deviation: f64) -> Self {
        self.with(name, Distribution::Normal { mean, deviation })
    }

    /// Adds an axis with these values, equally likely.
    pub fn choice(self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        self.with(name, Distribution::Choice(values.into_iter().collect()))
    }

    /// The design of these axes.
    pub fn design(self) -> Design {
        let Self { names, method: sampling, seed, count, axes } = self;
        Design { names, kind: Kind::Sampled { sampling, seed, axes }, count }
    }
}

impl From<Grid> for Design {
    fn from(grid: Grid) -> Self {
        grid.design()
    }
}

impl From<Sampling> for Design {
    fn from(sampling: Sampling) -> Self {
        sampling.design()
    }
}
