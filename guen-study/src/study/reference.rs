//! The reference: states in 71 digits by one method, and by another one, so that their difference is known; or in 31
//! digits, where 71 take too long.

use std::ops::ControlFlow;
use std::rc::Rc;

use guen_runtime::steppers::{Dop853, Integration, Method, Outcome};
use guen_runtime::{Ordered, System};

use super::digits31::Digits31;
use super::digits71::Digits71;
use super::extrapolation::{Stop, extrapolate};

type Long = Digits71;

/// A real that references are computed in.
pub(super) trait Extended: Ordered + 'static {
    /// The name in a report.
    const NAME: &'static str;
    /// Returns the number in the longest of these reals.
    fn lengthened(self) -> Long;
}

impl Extended for Digits71 {
    const NAME: &'static str = "71 digits";
    fn lengthened(self) -> Long {
        self
    }
}

impl Extended for Digits31 {
    const NAME: &'static str = "31 digits";
    fn lengthened(self) -> Long {
        Self::lengthened(self)
    }
}

/// A function that computes a reference. `watch` is told the time reached, and says whether to go on.
pub(super) type Source<const N: usize> =
    Box<dyn Fn(&Problem<'_, N>, &mut dyn FnMut(f64) -> bool) -> Result<Vec<[Long; N]>, String>>;

/// An initial state, and the times at which states are wanted.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a, const N: usize> {
    pub start: &'a [f64; N],
    pub t0: f64,
    pub times: &'a [f64],
    /// Further times to land on, because something abrupt is there.
    pub landings: &'a [f64],
}

impl<const N: usize> Problem<'_, N> {
    /// Returns the times to land on, in the direction of the motion, and whether the state there is wanted.
    pub fn stops(&self) -> Vec<(f64, bool)> {
        let Some(&end) = self.times.last() else { return Vec::new() };
        let inside = |t: f64| (t - self.t0) * (end - t) > 0.0;
        let wanted = self.times.iter().map(|t| (*t, true));
        let besides = self.landings.iter().filter(|t| inside(**t)).map(|t| (*t, false));
        let mut stops: Vec<(f64, bool)> = wanted.chain(besides).collect();
        // The sort keeps the order of equals: what is wanted comes before what is not.
        stops.sort_by(|a, b| (a.0 - self.t0).abs().total_cmp(&(b.0 - self.t0).abs()));
        stops.dedup_by(|later, first| later.0 == first.0 && !later.1);
        stops
    }

    /// Returns the length of the motion.
    pub fn span(&self) -> f64 {
        self.times.last().map_or(0.0, |end| (end - self.t0).abs())
    }
}

/// Returns the wanted states among those at all stops.
fn wanted<R: Extended, const N: usize>(stops: &[(f64, bool)], states: Vec<[R; N]>) -> Vec<[Long; N]> {
    let kept = stops.iter().zip(states).filter(|(stop, _)| stop.1);
    kept.map(|(_, state)| state.map(Extended::lengthened)).collect()
}

/// A source with what is to be said of it.
pub(super) struct Named<const N: usize> {
    pub name: String,
    pub source: Source<N>,
}

/// A reference, its check, and the reference of states nearby.
pub(super) struct References<const N: usize> {
    pub reference: Named<N>,
    pub check: Named<N>,
    pub elsewhere: Named<N>,
}

/// References in a real, the first of them at this tolerance.
pub(super) fn references_in<R, S, const N: usize>(system: &Rc<S>, tolerance: f64) -> References<N>
where
    R: Extended,
    S: System<R, N> + 'static,
{
    /// The number of steps that no reference can afford.
    const UNAFFORDABLE_STEPS: u64 = 100_000_000;
    let check = Dop853::<R>::new(CHECK_TOLERANCE, CHECK_TOLERANCE).with_max_steps(UNAFFORDABLE_STEPS);
    let check_name = format!("DOP853 at {CHECK_TOLERANCE:e} in {}", R::NAME);
    References {
        reference: by_extrapolation::<R, S, N>(Rc::clone(system), tolerance),
        elsewhere: by_extrapolation::<R, S, N>(Rc::clone(system), ELSEWHERE_TOLERANCE),
        check: by_method(check_name, Rc::clone(system), check),
    }
}

pub(super) const CANCELLED: &str = "it was cancelled, or took longer than the study had for it";

/// The order of the reference is high, so that digits are cheap: 1e-24 is not twice the work of 1e-18.
pub(super) const EXTRAPOLATION_TOLERANCE: f64 = 1e-24;
/// The tolerance of the reference in 31 digits, of which the table of extrapolation leaves some 25.
pub(super) const SHORTER_TOLERANCE: f64 = 1e-20;
/// The tolerance for states nearby: far below the rounding of doubles.
const ELSEWHERE_TOLERANCE: f64 = 1e-18;
/// The check is of order eight, where ten times the digits is twelve times the work: as tight as it has to be for
/// differences below the rounding of doubles.
const CHECK_TOLERANCE: f64 = 1e-17;

fn by_extrapolation<R, S, const N: usize>(system: Rc<S>, tolerance: f64) -> Named<N>
where
    R: Extended,
    S: System<R, N> + 'static,
{
    let source = Box::new(move |problem: &Problem<'_, N>, watch: &mut dyn FnMut(f64) -> bool| {
        let (start, t0) = (problem.start.map(R::from_f64), R::from_f64(problem.t0));
        let stops = problem.stops();
        let times: Vec<R> = stops.iter().map(|(t, _)| R::from_f64(*t)).collect();
        extrapolate(&*system, t0, &start, &times, tolerance, |t| watch(t.to_f64()))
            .map(|(states, _)| wanted(&stops, states))
            .map_err(|stop| match stop {
                Stop::Underflow => "the step became too short: the motion has a singularity".to_owned(),
                Stop::Cancelled => CANCELLED.to_owned(),
            })
    });
    Named {
        name: format!("extrapolated midpoint rule of order 24, tolerance {tolerance:e}, in {}", R::NAME),
        source,
    }
}

/// A method of guen's, or of the user's, that lands on every time.
pub(super) fn by_method<R, S, M, const N: usize>(name: String, system: Rc<S>, method: M) -> Named<N>
where
    R: Extended,
    S: System<R, N> + 'static,
    M: Method<R, S, N> + 'static,
{
    let source = Box::new(move |problem: &Problem<'_, N>, watch: &mut dyn FnMut(f64) -> bool| {
        let stops = problem.stops();
        let mut states = Vec::with_capacity(stops.len());
        let (mut t, mut x) = (R::from_f64(problem.t0), problem.start.map(R::from_f64));
        for (next, _) in &stops {
            let next = R::from_f64(*next);
            let mut look = |t: R, _: &[R; N]| {
                if watch(t.to_f64()) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            };
            let done = Integration::new(&*system, t, &x)
                .observe(&mut look)
                .run(&method, next)
                .map_err(|error| error.to_string())?;
            if done.outcome != Outcome::Arrived {
                return Err(CANCELLED.to_owned());
            }
            (t, x) = (next, done.state);
            states.push(x);
        }
        Ok(wanted(&stops, states))
    });
    Named { name, source }
}

/// The reason why there is no motion to measure.
pub(super) const NO_MOTION: &str =
    "the span is empty, or one of its ends or a number of a start is not finite";
/// The reason why the error of the energy cannot be measured.
pub(super) const NO_ENERGY: &str = "the system does not conserve an energy";
/// The reason why errors are not measured in the sizes that were given.
pub(super) const NO_SCALES: &str = "a size that errors are to be divided by is not a positive number";

/// The reference, as a report tells it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ReferenceReport {
    /// The method that computed it.
    pub method: String,
    /// The method that checked it.
    pub check: String,
    /// The largest difference between the two over all initial states, in the measure of the study, or, if that is larger, from a
    /// motion in doubles that lands in more places: the stated error. None if one of them failed.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact::option"))]
    pub error: Option<f64>,
    /// The reason why there is no reference, or no check of it.
    pub failure: Option<String>,
    /// The seconds that both took.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub seconds: f64,
}

impl ReferenceReport {
    /// Of a study that has nothing to measure, for this reason.
    pub(super) fn of_nothing(reason: &str) -> Self {
        let none = || "none".to_owned();
        Self { method: none(), check: none(), error: None, failure: Some(reason.to_owned()), seconds: 0.0 }
    }
}
