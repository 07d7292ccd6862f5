//! The motions of a design, to be told what is kept of them.

use std::fmt::{self, Debug, Display};
use std::ops::Range;

use guen_runtime::steppers::LaneMethod;
use guen_runtime::{Laned, OutputMap, Simulate, Simulation};

use super::Sweep;
use super::block::Column;
use super::design::{Design, Point, UnknownEntry};
use super::engine::{AnyError, Build, Members};
use super::in_lanes::{InLanes, Keep, Outputs};
use super::simulated::Simulated;

impl<'a> Sweep<'a> {
    /// The motions of a design's points: the closure makes a prepared system and its start of each. Constants, starts and laws of inputs may
    /// depend on the point. An error of the closure, as one of `prepare`, is a row with its cause.
    pub fn over<S, const N: usize>(
        design: impl Into<Design>,
        motion: impl Fn(&Point<'_>) -> Result<(S, S::State), AnyError> + Send + Sync + 'a,
    ) -> Motions<'a, S, N>
    where
        S: Simulate<f64, N>,
    {
        let build = move |point: &Point<'_>| motion(point).map(|(system, start)| (system, start.into()));
        Motions { design: design.into(), build: Box::new(build) }
    }

    /// The motions of one system from many states: axes with the names of entries of the state replace those of `start`. An axis of
    /// another name is refused: [`SweepError::UnknownEntry`](super::SweepError::UnknownEntry).
    ///
    /// ```
    /// use guen_runtime::{Simulate, System};
    /// use guen_study::{Design, Sweep};
    ///
    /// /// What the macro generates for a declared system.
    /// #[derive(Clone, Copy)]
    /// struct Pendulum;
    /// impl System<f64, 2> for Pendulum {
    ///     fn rhs(&self, _t: f64, &[q, w]: &[f64; 2]) -> [f64; 2] {
    ///         [w, -q.sin()]
    ///     }
    /// }
    /// impl Simulate<f64, 2> for Pendulum {
    ///     type State = [f64; 2];
    ///     const STATES: &'static [&'static str] = &["q", "w"];
    /// }
    ///
    /// let starts = Design::grid().linear("q", 0.1, 3.0, 30);
    /// // The time at which each passes its lowest point: a quarter of its period.
    /// let sweep = Sweep::of_starts(starts, Pendulum, [0.0, 0.0]).simulations([("quarter", "s")], |simulation| {
    ///     simulation.stop_at(|_t, &[q, _]| q).run(0.0..20.0).map(|motion| [motion.end_time()])
    /// });
    /// let quarters = sweep.run()?;
    /// let quarter = quarters.statistics().column("quarter").unwrap();
    /// assert!(quarter.minimum().unwrap() > std::f64::consts::FRAC_PI_2);
    /// # Ok::<(), guen_study::SweepError>(())
    /// ```
    pub fn of_starts<S, const N: usize>(
        design: impl Into<Design>,
        system: S,
        start: S::State,
    ) -> Motions<'a, S, N>
    where
        S: Simulate<f64, N> + Clone + Send + Sync + 'a,
    {
        let start: [f64; N] = start.into();
        Self::over(design, move |point| {
            let mut state = start;
            for (name, value) in point.names.iter().zip(point.values) {
                let place = S::STATES.iter().position(|own| own == name);
                let place = place.ok_or_else(|| UnknownEntry { name: name.clone(), known: S::STATES })?;
                state[place] = *value;
            }
            Ok((system.clone(), state.into()))
        })
    }
}

/// The motions of a design's points; what is kept of them makes a [`Sweep`].
///
/// | kept | columns | computed |
/// | --- | --- | --- |
/// | [`end_states`](Self::end_states) | the state's entries at the end | in lanes |
/// | [`end_states_with_errors`](Self::end_states_with_errors) | the same with estimates of their errors | in lanes, twice |
/// | [`end_outputs`](Self::end_outputs) | the state's entries and the declared outputs at the end | in lanes |
/// | [`samples`](Self::samples) | a row for each time: `t` and the state | in lanes |
/// | [`extrema`](Self::extrema) | the smallest and the largest value of each entry at some times | in lanes |
/// | [`simulations`](Self::simulations) | what a closure says: events, extrema, errors of invariants | one by one |
/// | [`simulation_rows`](Self::simulation_rows) | several rows of a motion, as one for each event | one by one |
///
/// Rows begin with the number of the motion and the point of the design; an axis that has the name of something kept is called `design_NAME`.
#[must_use = "motions become a sweep by what is kept of them"]
pub struct Motions<'a, S, const N: usize> {
    design: Design,
    build: Build<'a, S, N>,
}

impl<S, const N: usize> Debug for Motions<'_, S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Motions").field("design", &self.design.text()).finish_non_exhaustive()
    }
}

impl<'a, S, const N: usize> Motions<'a, S, N>
where
    S: Laned<N> + Simulate<f64, N> + Send + Sync + 'a,
{
    /// Keeps the state at the end of the span.
    pub fn end_states<M>(self, method: M, span: Range<f64>) -> Sweep<'a>
    where
        M: LaneMethod + Debug + Send + Sync + 'a,
    {
        self.in_lanes((method, None), (span.start, vec![span.end]), Keep::End, None)
    }

    /// Keeps the state at the end, and in columns `NAME_error` its distance from that of a finer method, as one with half of the step.
    pub fn end_states_with_errors<M>(self, method: M, finer: M, span: Range<f64>) -> Sweep<'a>
    where
        M: LaneMethod + Debug + Send + Sync + 'a,
    {
        self.in_lanes((method, Some(finer)), (span.start, vec![span.end]), Keep::End, None)
    }

    /// Keeps the state and the declared outputs at the end of the span.
    pub fn end_outputs<M, const K: usize>(self, method: M, span: Range<f64>) -> Sweep<'a>
    where
        S: OutputMap<f64, N, K>,
        M: LaneMethod + Debug + Send + Sync + 'a,
    {
        let units = |k: usize| S::OUTPUT_UNITS.get(k).copied().unwrap_or_default();
        let columns = S::OUTPUTS.iter().enumerate().map(|(k, name)| Column::new(*name, units(k))).collect();
        let values = |system: &S, t: f64, state: &[f64; N], all: &mut Vec<f64>| {
            all.extend(system.output_values(t, state))
        };
        self.in_lanes(
            (method, None),
            (span.start, vec![span.end]),
            Keep::End,
            Some(Outputs { columns, values }),
        )
    }

    /// Keeps the states at these times, which may turn back: a row for each, with the time. Each time has statistics of its own:
    /// [`Statistics::at`](super::Statistics::at).
    pub fn samples<M>(self, method: M, t0: f64, times: impl IntoIterator<Item = f64>) -> Sweep<'a>
    where
        M: LaneMethod + Debug + Send + Sync + 'a,
    {
        self.in_lanes((method, None), (t0, times.into_iter().collect()), Keep::Samples, None)
    }

    /// Keeps the smallest and the largest value of each entry of the state at these times, in columns `NAME_min` and `NAME_max`.
    pub fn extrema<M>(self, method: M, t0: f64, times: impl IntoIterator<Item = f64>) -> Sweep<'a>
    where
        M: LaneMethod + Debug + Send + Sync + 'a,
    {
        self.in_lanes((method, None), (t0, times.into_iter().collect()), Keep::Extrema, None)
    }

    fn in_lanes<M>(
        self,
        methods: (M, Option<M>),
        times: (f64, Vec<f64>),
        keep: Keep,
        outputs: Option<Outputs<S, N>>,
    ) -> Sweep<'a>
    where
        M: LaneMethod + Debug + Send + Sync + 'a,
    {
        let Self { design, build } = self;
        let members = Members { names: design.names().to_vec(), build };
        Sweep::new(design, Box::new(InLanes::new(members, methods, times, keep, outputs)))
    }
}

impl<'a, S, const N: usize> Motions<'a, S, N>
where
    S: Simulate<f64, N> + Clone + Send + Sync + 'a,
{
    /// Keeps of each simulation the numbers that a closure returns, in columns with these names and units. The closure gives the simulation its
    /// method, events and limits, and runs it; a number that there is not, as the time of an event that did not happen, is NaN. Its error is a row
    /// with the cause.
    pub fn simulations<const K: usize, E: Display>(
        self,
        columns: [(&str, &str); K],
        run: impl Fn(Simulation<'_, S, N>) -> Result<[f64; K], E> + Send + Sync + 'a,
    ) -> Sweep<'a> {
        self.simulation_rows(columns, move |simulation| run(simulation).map(|row| vec![row]))
    }

    /// Keeps several rows of each simulation, or none, as one for each event. Statistics are over all rows.
    pub fn simulation_rows<const K: usize, E: Display>(
        self,
        columns: [(&str, &str); K],
        run: impl Fn(Simulation<'_, S, N>) -> Result<Vec<[f64; K]>, E> + Send + Sync + 'a,
    ) -> Sweep<'a> {
        let Self { design, build } = self;
        let members = Members { names: design.names().to_vec(), build };
        let columns = columns.iter().map(|(name, unit)| Column::new(*name, *unit)).collect();
        let run = move |simulation: Simulation<'_, S, N>| run(simulation).map_err(|error| error.to_string());
        Sweep::new(design, Box::new(Simulated { members, columns, run: Box::new(run) }))
    }
}
