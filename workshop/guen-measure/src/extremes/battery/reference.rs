//! Motions in 71 digits: by Taylor's method with a tolerance of 1e-20, checked by DOP853 with 1e-16; where a system has no
//! series, by DOP853 with 1e-18.

use guen::Lift;
use guen::TaylorSeries;
use guen::prelude::*;
use guen::steppers::Method;
use guen_study::Digits71;

/// Parts of the span between which the reference is kept.
pub const PARTS: usize = 32;

/// Steps that a reference may take.
const MOST_STEPS: u64 = 500_000;

fn dop853(tolerance: f64) -> Dop853<Digits71> {
    Dop853::new(tolerance, 1e-12 * tolerance).with_max_steps(MOST_STEPS)
}

/// A motion: where it is on the way and at its end, and how large each entry is.
pub struct Reference<const N: usize> {
    /// Times and states, from the start to the end.
    pub path: Vec<(Digits71, [Digits71; N])>,
    /// The largest value of each entry and the absolute tolerance, in units of the relative one.
    pub sizes: [f64; N],
    absolute: f64,
    /// What two methods, or two settings of one, differ by at the end.
    pub doubt: f64,
}

impl<const N: usize> Reference<N> {
    /// Runs it; the text of the error if there is no motion over the whole span.
    pub fn new<G>(long: &G, start: &[f64; N], span: (f64, f64), absolute: f64) -> Result<Self, String>
    where
        G: TaylorSeries<Digits71, N>,
    {
        let taylor = Taylor::new(1e-20, 1e-30).with_max_steps(MOST_STEPS);
        Self::by(&taylor, long, start, span, absolute)
    }

    /// The same for a system that has no series.
    pub fn without_series<G>(
        long: &G,
        start: &[f64; N],
        span: (f64, f64),
        absolute: f64,
    ) -> Result<Self, String>
    where
        G: System<Digits71, N>,
    {
        Self::by(&dop853(1e-18), long, start, span, absolute)
    }

    fn by<M, G>(
        method: &M,
        long: &G,
        start: &[f64; N],
        (t0, t1): (f64, f64),
        absolute: f64,
    ) -> Result<Self, String>
    where
        G: System<Digits71, N>,
        M: Method<Digits71, G, N>,
    {
        let start: [Digits71; N] = start.map(Digits71::from_f64);
        let (t0, t1) = (Digits71::from_f64(t0), Digits71::from_f64(t1));
        let times: [Digits71; PARTS + 1] = std::array::from_fn(|k| match k {
            PARTS => t1,
            _ => t0 + Digits71::from_ratio(k as i64, PARTS as i64) * (t1 - t0),
        });
        let mut path = Vec::new();
        let mut visit = |k: usize, _: Digits71, x: &[Digits71; N]| path.push((times[k], *x));
        let run = Integration::new(long, t0, &start).sample(&times, &mut visit).run(method, t1);
        run.map_err(|error| format!("{error}"))?;
        let check = Integration::new(long, t0, &start).run(&dop853(1e-16), t1);
        let check = check.map_err(|error| format!("{error}"))?.state;
        let sizes = sizes(&path, absolute);
        let mut reference = Self { path, sizes, absolute, doubt: 0.0 };
        reference.doubt = reference.error(&check);
        Ok(reference)
    }

    /// The sizes of the entries about a point of the path: over it and the two on both sides.
    pub fn sizes_about(&self, index: usize) -> [f64; N] {
        let last = self.path.len().min(index + 3);
        sizes(&self.path[index.saturating_sub(2)..last], self.absolute)
    }

    /// The largest relative error of a state at the end.
    pub fn error<R: Exact>(&self, state: &[R; N]) -> f64 {
        let Some((_, end)) = self.path.last() else { return f64::NAN };
        let errors = state.iter().zip(end).zip(self.sizes).map(|((x, exact), size)| {
            let off = x.long() - *exact;
            off.to_f64().abs() / size
        });
        errors.fold(0.0, |most, error| if error > most || error.is_nan() { error } else { most })
    }
}

/// The largest value of each entry, and the absolute tolerance.
fn sizes<const N: usize>(path: &[(Digits71, [Digits71; N])], absolute: f64) -> [f64; N] {
    let largest = |i: usize| path.iter().fold(0.0_f64, |most, (_, x)| most.max(x[i].to_f64().abs()));
    std::array::from_fn(|i| absolute + largest(i))
}

/// Reals that long ones contain.
pub trait Exact: Ordered + Lift<Self> {
    /// The same number.
    fn long(self) -> Digits71;
}

impl Exact for Digits71 {
    fn long(self) -> Digits71 {
        self
    }
}

impl Exact for f64 {
    fn long(self) -> Digits71 {
        Digits71::from_f64(self)
    }
}

impl Exact for f32 {
    fn long(self) -> Digits71 {
        Digits71::from_f64(f64::from(self))
    }
}
