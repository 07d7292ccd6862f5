//! Recovers the variables that a scene left out from a run of those that it keeps.

mod rule;

use std::error::Error;
use std::fmt;

use guen_runtime::{Level, System};

use rule::{FINE, Rule, chebyshev, points};

/// The times at which [`recover`] wants a run to be sampled: nine in each interval of a grid, ends included.
///
/// They are Chebyshev's points `t_k + (t_(k+1) - t_k) (1 - cos(j pi/8))/2`, dense at the ends, so that integrals to each
/// of them are as good as the integral over the interval.
///
/// ```
/// use guen_study::Nodes;
///
/// let nodes = Nodes::new(&[0.0, 1.0, 3.0])?;
/// assert_eq!(nodes.times().len(), 17);
/// assert_eq!((nodes.times()[4], nodes.times()[8]), (0.5, 1.0));
/// # Ok::<(), guen_study::RecoveryError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes {
    times: Vec<f64>,
}

impl Nodes {
    /// The nodes of a grid of times, which rise or fall.
    ///
    /// An interval is to be short enough that a polynomial of degree 8 follows the rates on it; [`recover`] refuses grids
    /// on which it does not.
    ///
    /// # Errors
    ///
    /// [`RecoveryError::Grid`] if there are less than two times, or they are not finite, or neither rise nor fall.
    pub fn new(grid: &[f64]) -> Result<Self, RecoveryError> {
        let rises = |pair: &[f64]| pair[0] < pair[1];
        let falls = |pair: &[f64]| pair[0] > pair[1];
        let is_ordered = grid.windows(2).all(rises) || grid.windows(2).all(falls);
        if grid.len() < 2 || !is_ordered || !grid.iter().all(|t| t.is_finite()) {
            return Err(RecoveryError::Grid);
        }
        let points = points();
        let mut times = vec![grid[0]];
        for pair in grid.windows(2) {
            let inside = points[1..FINE].iter().map(|c| pair[0] + c * (pair[1] - pair[0]));
            times.extend(inside.chain([pair[1]]));
        }
        Ok(Self { times })
    }

    /// Returns all times, in order; those of the grid are every eighth.
    pub fn times(&self) -> &[f64] {
        &self.times
    }
}

/// A motion of the whole system, from a run of a part of it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Recovered<const FULL: usize> {
    /// The times of the grid.
    pub times: Vec<f64>,
    /// The states of the system at these times.
    pub states: Vec<[f64; FULL]>,
    /// The stated error of each entry, for every time: see [`recover`]. Infinite for a variable that the run does not
    /// determine; it has its initial value in `states`.
    pub errors: Vec<[f64; FULL]>,
}

impl<const FULL: usize> Recovered<FULL> {
    /// An entry of the state over time, for [`Plot::line`](crate::Plot::line).
    pub fn curve(&self, entry: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.times.iter().zip(&self.states).map(move |(t, state)| (*t, state[entry]))
    }

    /// Returns one entry of the state against another: a path.
    pub fn track(&self, x: usize, y: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.states.iter().map(move |state| (state[x], state[y]))
    }

    /// The stated error of an entry at the end, which is its largest.
    pub fn error(&self, entry: usize) -> f64 {
        self.errors.last().map_or(f64::INFINITY, |errors| errors[entry])
    }
}

/// Recovers what a scene left out, along a recorded run: what is an integral of what it keeps, variables in
/// [`Level::QUADRATURES`](guen_runtime::Level::QUADRATURES), layer by layer, and the coordinates that holonomic equations
/// say of it, [`Level::DETERMINED`](guen_runtime::Level::DETERMINED).
///
/// `core` is the prepared scene, and `full` the prepared system with the same constants. `run` are the states of the
/// scene at [`Nodes::times`], as [`Integration::sample`](guen_runtime::steppers::Integration::sample) gives them, and
/// `check` those of a second run with tolerances ten to a thousand times as large. `rest` is the initial state of the system.
///
/// # Errors of the result
///
/// The steps of the run were chosen without what is recovered here, so its errors are found here: everything is done
/// twice, from `run` with polynomials of degree 8 in time (an error of `O(h^10)` over an interval of length `h`), and
/// from `check` with those of degree 4 on every second node (`O(h^6)`). The stated error of a variable at a time is the
/// largest difference of the two up to then, plus the roundings of the sum. It contains the error of the steps, of the
/// dense output and of the integrals, as they are in the coarser of the two, and so exceeds the true one by far as a
/// rule. Where `check` is `run`, it tells of the integrals alone, and where the tolerances of both are too coarse for the
/// motion, of nothing.
///
/// Two polynomials that do not follow a rate can agree by chance. So a grid is refused as [`RecoveryError::Coarse`]
/// where, on an interval, one of the three highest Chebyshev coefficients of a rate is more than 7 percent of the largest
/// one beside the constant, unless it is no more than what `run` and `check` differ by. This is a test of what nine
/// points show, and no proof. Of 20,000 runs with rates of five kinds, whose fastest phase moves by 0.5 to 60 over an
/// interval, 11,390 were accepted. Of these, 2 were off by more than is stated, at most 3.5 times, and in both the phase moves
/// by more than 25. Of the 10,371 where it moves by less than 6, 56 were refused
/// (`cargo test -p guen-study --lib recovery -- --include-ignored --nocapture`).
///
/// # Cost
///
/// Fourteen right-hand sides of the system for each interval and layer.
///
/// ```
/// use guen_runtime::{Cost, Level, LevelInfo, System, from_fn, steppers::{Dop853, Integration}};
/// use guen_study::{Nodes, recover};
///
/// /// Of `x, y, v` with `x' = v, y' = x, v' = -x` only `x, v` are kept.
/// struct Swing;
/// impl System<f64, 2> for Swing {
///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
///         [v, -x]
///     }
/// }
/// impl Level<f64, 2, 3> for Swing {
///     const PLACES: [usize; 2] = [0, 2];
///     const QUADRATURES: &'static [&'static [usize]] = &[&[1]];
///     const INFO: LevelInfo =
///         LevelInfo { name: "Swing", variables: &["x", "v"], cost: Cost::ZERO, prepare_cost: Cost::ZERO };
/// }
/// let full = from_fn(|_t: f64, &[x, _y, v]: &[f64; 3]| [v, x, -x]);
///
/// let grid: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k)).collect();
/// let nodes = Nodes::new(&grid)?;
/// let sampled = |tolerance: f64| {
///     let mut states = Vec::new();
///     Integration::new(&Swing, 0.0, &[1.0, 0.0])
///         .sample(nodes.times(), &mut |_k, _t, state| states.push(*state))
///         .run(&Dop853::new(tolerance, tolerance), 10.0)
///         .map(|_| states)
/// };
/// let recovered = recover(&Swing, &full, &nodes, &sampled(1e-12)?, &sampled(1e-10)?, &[1.0, 0.0, 0.0])?;
/// let off = (recovered.states[20][1] - 10.0_f64.sin()).abs();
/// assert!(off <= recovered.error(1) && recovered.error(1) < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`RecoveryError::Samples`] if a run has not as many states as there are nodes, [`RecoveryError::NotFinite`] where a
/// rate cannot be computed, [`RecoveryError::Coarse`] where nine points in an interval do not follow it.
pub fn recover<S, F, const N: usize, const FULL: usize>(
    core: &S,
    full: &F,
    nodes: &Nodes,
    run: &[[f64; N]],
    check: &[[f64; N]],
    rest: &[f64; FULL],
) -> Result<Recovered<FULL>, RecoveryError>
where
    S: Level<f64, N, FULL>,
    F: System<f64, FULL>,
{
    for states in [run, check] {
        let (expected, found) = (nodes.times.len(), states.len());
        if expected != found {
            return Err(RecoveryError::Samples { expected, found });
        }
    }
    let path = Path { core, full, nodes, rest };
    let (fine, coarse) = (path.integrated(&Rule::new(1), run)?, path.integrated(&Rule::new(2), check)?);
    path.resolved(&fine.rates, &coarse.rates)?;
    let (fine, coarse) = (fine.states, coarse.states);

    let known = |place: &usize| {
        S::DETERMINED.contains(place) || S::QUADRATURES.iter().any(|layer| layer.contains(place))
    };
    // What the scene holds is exact: `hold` writes there, and nowhere else.
    let mut held = [f64::NAN; FULL];
    core.hold(&mut held);
    let mut bound = held.map(|value| if value.is_nan() { f64::INFINITY } else { 0.0 });
    let mut roundings = [0.0; FULL];
    let mut errors = Vec::with_capacity(fine.len());
    for place in (0..FULL).filter(known).chain(S::PLACES) {
        bound[place] = 0.0;
    }
    for (a, b) in fine.iter().zip(&coarse) {
        for place in (0..FULL).filter(known).chain(S::PLACES) {
            let before = bound[place] - roundings[place];
            // Every sum over an interval is rounded to the size of what it is added to.
            roundings[place] += f64::EPSILON * a[place].abs();
            bound[place] = before.max((a[place] - b[place]).abs()) + roundings[place];
        }
        errors.push(bound);
    }
    let times = nodes.times.iter().copied().step_by(FINE).collect();
    Ok(Recovered { times, states: fine, errors })
}

struct Path<'a, S, F, const FULL: usize> {
    core: &'a S,
    full: &'a F,
    nodes: &'a Nodes,
    rest: &'a [f64; FULL],
}

/// The integrals over a grid.
struct Integrated<const FULL: usize> {
    /// The states of the system at the times of the grid.
    states: Vec<[f64; FULL]>,
    /// The rates of what is integrated, for every interval, layer by layer: the entry, and its values at the points.
    rates: Vec<Vec<(usize, Vec<f64>)>>,
}

impl<S, F, const FULL: usize> Path<'_, S, F, FULL> {
    /// Refuses intervals on which a polynomial does not follow a rate.
    fn resolved<const N: usize>(
        &self,
        fine: &[Vec<(usize, Vec<f64>)>],
        coarse: &[Vec<(usize, Vec<f64>)>],
    ) -> Result<(), RecoveryError>
    where
        S: Level<f64, N, FULL>,
    {
        /// The part of the largest coefficient that the highest may be.
        const TAIL: f64 = 0.07;
        /// The rounding that a constant rate may show, relative to its largest value.
        const CONSTANT_RATE_ROUNDING: f64 = 1e-10;

        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let mut sizes = [0.0_f64; FULL];
        for (entry, rates) in fine.iter().flatten() {
            sizes[*entry] = sizes[*entry].max(largest(rates));
        }
        for (k, (fine, coarse)) in fine.iter().zip(coarse).enumerate() {
            for ((entry, rates), (_, others)) in fine.iter().zip(coarse) {
                let differences: Vec<f64> =
                    rates.iter().step_by(2).zip(others).map(|(rate, other)| rate - other).collect();
                let noise = (CONSTANT_RATE_ROUNDING * sizes[*entry]).max(largest(&differences));
                let coefficients = chebyshev(rates);
                let tail = largest(&coefficients[FINE - 2..]);
                if tail > noise && tail > TAIL * largest(&coefficients[1..]) {
                    return Err(RecoveryError::Coarse { t: self.nodes.times[k * FINE], entry: *entry });
                }
            }
        }
        Ok(())
    }

    /// The states of the system at the times of the grid, with the rates on the way.
    fn integrated<const N: usize>(
        &self,
        rule: &Rule,
        states: &[[f64; N]],
    ) -> Result<Integrated<FULL>, RecoveryError>
    where
        S: Level<f64, N, FULL>,
        F: System<f64, FULL>,
    {
        let times = &self.nodes.times;
        let embed = |place: usize, rest: &[f64; FULL]| {
            let mut full = self.core.embed(&states[place], rest);
            self.core.determine(times[place], &states[place], &mut full);
            full
        };
        let mut now = embed(0, self.rest);
        let (mut motion, mut seen) = (vec![now], Vec::new());
        for first in (0..times.len() - 1).step_by(FINE) {
            let places: Vec<usize> = (first..=first + FINE).step_by(rule.stride).collect();
            let length = times[first + FINE] - times[first];
            let mut along: Vec<[f64; FULL]> = places.iter().map(|place| embed(*place, &now)).collect();
            let mut here = Vec::new();
            for layer in S::QUADRATURES {
                let rates: Vec<[f64; FULL]> = places
                    .iter()
                    .zip(&along)
                    .map(|(place, state)| self.full.rhs(times[*place], state))
                    .collect();
                for entry in layer.iter().copied() {
                    if let Some(k) = rates.iter().position(|rate| !rate[entry].is_finite()) {
                        return Err(RecoveryError::NotFinite { t: times[places[k]], entry });
                    }
                    here.push((entry, rates.iter().map(|rate| rate[entry]).collect()));
                    for (state, weights) in along.iter_mut().zip(&rule.weights) {
                        let sum: f64 = weights.iter().zip(&rates).map(|(w, rate)| w * rate[entry]).sum();
                        state[entry] = now[entry] + length * sum;
                    }
                }
            }
            now = along[along.len() - 1];
            motion.push(now);
            seen.push(here);
        }
        Ok(Integrated { states: motion, rates: seen })
    }
}

/// The reason why what a scene left out could not be recovered.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RecoveryError {
    /// A grid of less than two times, or of times that are not finite or neither rise nor fall.
    Grid,
    /// A run was not sampled at the nodes.
    Samples {
        /// The number of nodes.
        expected: usize,
        /// The number of states.
        found: usize,
    },
    /// A rate that is integrated changes faster on an interval than nine points follow: a finer grid is needed there.
    Coarse {
        /// The time at which the interval begins.
        t: f64,
        /// The entry of the state of the system.
        entry: usize,
    },
    /// A rate that is integrated is not finite.
    NotFinite {
        /// The time.
        t: f64,
        /// The entry of the state of the system.
        entry: usize,
    },
}

impl fmt::Display for RecoveryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grid => f.write_str("a grid needs two finite times or more that rise, or that fall"),
            Self::Samples { expected, found } => {
                write!(
                    f,
                    "a run has {found} states where the nodes are {expected}: sample it at `Nodes::times`"
                )
            }
            Self::Coarse { t, entry } => write!(
                f,
                "the grid is too coarse at t = {t}: the rate of entry {entry} of the system's state changes faster than \
                 nine points in an interval follow"
            ),
            Self::NotFinite { t, entry } => {
                write!(f, "the rate of entry {entry} of the system's state is not finite at t = {t}")
            }
        }
    }
}

impl Error for RecoveryError {}

#[cfg(test)]
mod stated;
#[cfg(test)]
mod tests;
