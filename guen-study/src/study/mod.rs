//! The trade of speed for accuracy, measured on a system of the user's own.
//!
//! A [`Study`] holds what is to be done: `variant` and `standard` say what can be pulled, `measure` what counts as error,
//! `reference` and `extrapolation` where the truth comes from, in the real of `digits71`; `scan` looks for what these might step
//! over, and `known` is what it found. `run` does it, in stages within a `budget`; `timing` and `front` are what is known of costs. Out comes a [`Trade`]: a [`StudyReport`] (`row`,
//! `report`, `choice`, `files`, `picture`, `code`), and the means to ask whether a choice holds elsewhere (`trade`, `probes`).

mod budget;
mod choice;
mod code;
mod digits31;
mod digits71;
mod extrapolation;
mod files;
mod front;
mod known;
mod measure;
mod picture;
mod probes;
mod reference;
mod report;
mod row;
mod run;
mod scan;
mod standard;
mod timing;
mod trade;
mod variant;

use std::ops::Range;
use std::rc::Rc;
use std::time::Duration;

use guen_runtime::steppers::{Method, Taylor};
use guen_runtime::{Guarded, Real, System, TaylorSeries, WithScalar};

pub use choice::{Caveat, Choice, NoChoice};
pub use digits71::Digits71;
pub use front::pareto_front;
pub use known::ScanReport;
pub use reference::ReferenceReport;
pub use report::{Ending, StudyReport, Unit};
pub use row::{Failure, FailureKind, Knob, Nearby, Row};
pub use timing::{Cost, Stopwatch};
pub use trade::{Forecast, Trade, Tried};
pub use variant::Settings;

use known::Scanner;
use measure::{Measure, Scales, Tells};
use reference::{Named, References};
use variant::{Run, Variant};

/// Told the part of the study that is done; says whether to stop.
type Stop = Box<dyn FnMut(f64) -> bool>;

/// The work-precision of every variant on one system: what to measure.
///
/// By default: the error of the end state, every method over every real, at most a minute, times by the machine's clock.
///
/// # Errors of entries
///
/// An error is the largest one over entries, sample times and initial states. That of an entry is relative to
/// `max(1, |reference|)`: absolute for small entries and relative for large ones, as the tolerances of the adaptive methods are with
/// equal relative and absolute parts. It depends on units: where an entry's natural size is far from one, give
/// [`scales`](Study::scales).
///
/// # The reference
///
/// Extrapolation of the midpoint rule (order 24, tolerance 1e-24) in [`Digits71`], checked by DOP853 in the same real at
/// 1e-17, which shares no code with it but the right-hand side. What they differ by, in the measure of the study, is stated as the
/// reference's error; settings with an error below ten times that are marked, and not chosen. Where 71 digits
/// take longer than the study has for them, both are computed in 31 digits, the sum of two doubles, and the report says so.
///
/// Both land in kicks and steep layers that they would step over, which are looked for at a million times of the motion:
/// [`scan`](Study::scan).
///
/// ```
/// use guen_runtime::{Equations, Real, generic};
/// use guen_study::Study;
///
/// #[derive(Clone)]
/// struct Oscillator;
/// impl Equations<2> for Oscillator {
///     fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
///         [v, -x]
///     }
/// }
///
/// let trade = Study::new(generic(Oscillator), [0.0, 1.0], 0.0..5.0)?
///     .title("oscillator")
///     .keep(|method, real| method == "DOP853" && real == "f64")
/// #   .scan(1 << 12)
///     .count_evaluations()
///     .run();
/// let choice = trade.report.fastest_within(1e-6)?;
/// assert!(choice.row.error < Some(1e-6));
/// assert!(choice.row.code.contains("Dop853::new("));
/// // The same from another state, before it is relied upon.
/// assert!(trade.forecast(choice.index, choice.asked, &[0.3, -0.5], 0.0..5.0).holds());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Study<S, const N: usize> {
    system: S,
    title: String,
    starts: Vec<[f64; N]>,
    t0: f64,
    t1: f64,
    samples: usize,
    measure: Measure<N>,
    scales: Scales<N>,
    variants: Vec<Variant<N>>,
    reference: Named<N>,
    check: Option<Named<N>>,
    /// The reference of states nearby and of trials.
    elsewhere: Named<N>,
    /// The references in 31 digits, if those in 71 take too long.
    shorter: Option<References<N>>,
    tells: Tells<N>,
    /// DOP853 in doubles at a tolerance, for forecasts.
    tight: Rc<dyn Fn(f64) -> Run<N>>,
    scanner: Scanner<N>,
    points: usize,
    unit: Unit,
    budget: Duration,
    progress: bool,
    stop: Stop,
    stopwatch: Box<dyn Stopwatch>,
    probes: usize,
    spread: f64,
}

impl<S, const N: usize> std::fmt::Debug for Study<S, N> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Study")
            .field("title", &self.title)
            .field("starts", &self.starts)
            .field("span", &(self.t0, self.t1))
            .field("measure", &self.measure.text())
            .field("variants", &self.variants.len())
            .finish_non_exhaustive()
    }
}

impl<S, const N: usize> Study<S, N> {
    /// Sets the title of report and picture.
    #[must_use]
    pub fn title(self, title: impl Into<String>) -> Self {
        Self { title: title.into(), ..self }
    }

    /// Adds initial states. Errors are the largest over all of them, costs the mean.
    #[must_use]
    pub fn starts(mut self, starts: impl IntoIterator<Item = [f64; N]>) -> Self {
        self.starts.extend(starts);
        self
    }

    /// The error is that of the states at so many equidistant times, the end among them; from the dense output, where a
    /// method has one.
    #[must_use]
    pub fn trajectory(self, samples: usize) -> Self {
        Self { measure: Measure::Trajectory, samples: samples.max(1), ..self }
    }

    /// The error is that of an output at so many equidistant times, the end among them, relative to `max(1, |output|)`.
    /// The output is computed in doubles from the states of both, so errors below its rounding mean nothing.
    #[must_use]
    pub fn output(
        self,
        name: impl Into<String>,
        samples: usize,
        function: impl Fn(f64, &[f64; N]) -> f64 + 'static,
    ) -> Self {
        let measure = Measure::Output { name: name.into(), function: Rc::new(function) };
        Self { measure, samples: samples.max(1), ..self }
    }

    /// The error is the largest change of the energy since the start at so many equidistant times, relative to the
    /// largest `|T| + |U|`, evaluated in 71 digits; of a system that keeps it. No reference is computed.
    ///
    /// A small change of the energy does not mean a small error of the state.
    #[must_use]
    pub fn energy(self, samples: usize) -> Self {
        Self { measure: Measure::Energy, samples: samples.max(1), ..self }
    }

    /// The error is the largest left side of the constraints on positions at so many equidistant times, in its own unit,
    /// evaluated in 71 digits. No reference is computed.
    #[must_use]
    pub fn residual(self, samples: usize) -> Self {
        Self { measure: Measure::Residual, samples: samples.max(1), ..self }
    }

    /// Sets the sizes by which errors of entries are divided in place of `max(1, |reference|)`; infinity leaves an
    /// entry out.
    #[must_use]
    pub fn scales(self, scales: [f64; N]) -> Self {
        Self { scales: Some(scales), ..self }
    }

    /// Keeps those variants only whose method and real the function wants: `RK4`, `RK8`, `Tsit5`, `DOP853`, `Euler`,
    /// `Gauss 4`, `Gauss 6`, `Radau 5`, `Bounded DOP853`, `Bounded Tsit5` and what was added; `f64`, `f32`, `Std`,
    /// `Approx13`, `Approx7`, `Fused` and lanes.
    #[must_use]
    pub fn keep(mut self, wanted: impl Fn(&str, &str) -> bool) -> Self {
        self.variants.retain(|variant| wanted(&variant.method, &variant.real));
        self
    }

    /// Adds a variant of the user's own: a method on any system in doubles, with its settings and the code that the
    /// report shows for a setting. The system may be another one of the same state, such as a form that is cheaper.
    ///
    /// ```
    /// use guen_runtime::{from_fn, steppers::Rk4};
    /// use guen_study::{Settings, Study};
    ///
    /// /// A study of an oscillator, with its right-hand side by hand besides.
    /// fn with_the_one_by_hand<S>(study: Study<S, 2>) -> Study<S, 2> {
    ///     let by_hand = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
    ///     study.with_method_on(
    ///         by_hand,
    ///         ["RK4", "f64", "by hand"],
    ///         Settings::Steps,
    ///         Rk4::new,
    ///         |step| format!("Rk4::new({step}) on `by_hand`"),
    ///     )
    /// }
    /// ```
    #[must_use]
    pub fn with_method_on<T, M>(
        mut self,
        system: T,
        [method, real, form]: [&str; 3],
        settings: Settings,
        make: impl Fn(f64) -> M + 'static,
        code: impl Fn(f64) -> String + 'static,
    ) -> Self
    where
        T: System<f64, N> + 'static,
        M: Method<f64, T, N> + 'static,
    {
        let system = Rc::new(system);
        self.variants.push(variant::variant::<f64, T, M, N>(
            [method, real, form],
            &system,
            settings,
            make,
            code,
        ));
        self
    }

    /// Adds the explicit methods on another form of the equations, whose state is another one: a system of `M`
    /// variables with the way there and back, such as the carried form of a system that says `provide carried;`.
    /// Errors are those of the state that comes back. The way there and back counts as the form's cost.
    ///
    /// ```
    /// use guen_runtime::from_fn;
    /// use guen_study::Study;
    ///
    /// /// A study of a pendulum, with its carried form besides: `s = sin q` and `c = cos q` as states, and a right-hand side
    /// /// without a call.
    /// fn with_the_carried_form<S>(study: Study<S, 2>) -> Study<S, 2> {
    ///     let carried = from_fn(|_t: f64, &[_, w, s, c]: &[f64; 4]| [w, -s, c * w, -s * w]);
    ///     study.with_form(
    ///         "carried",
    ///         carried,
    ///         |&[q, w]: &[f64; 2]| [q, w, q.sin(), q.cos()],
    ///         |&[q, w, _, _]| [q, w],
    ///     )
    /// }
    /// ```
    #[must_use]
    pub fn with_form<T, const M: usize>(
        mut self,
        name: &str,
        system: T,
        to: impl Fn(&[f64; N]) -> [f64; M] + 'static,
        back: impl Fn(&[f64; M]) -> [f64; N] + 'static,
    ) -> Self
    where
        T: System<f64, M> + 'static,
    {
        let variants = variant::explicit_variants::<f64, T, M>(
            "f64",
            &Rc::new(system),
            self.span(),
            code::Origin::Given,
        );
        let way = Rc::new((to, back));
        self.variants.extend(variants.into_iter().map(|variant| variant.of_form(name, Rc::clone(&way))));
        self
    }

    /// Costs are evaluations, not times, a Jacobian as many as there are variables: the same on every machine and in
    /// every run. They say nothing of what a real or a form costs.
    #[must_use]
    pub fn count_evaluations(self) -> Self {
        Self { unit: Unit::Evaluations, ..self }
    }

    /// Limits the time of the whole study; a minute by default. The stages share it: 10 parts of a hundred to look
    /// for kicks, 20 for the reference and 15 for one in 31 digits where that did not suffice, 15 to find errors, 12
    /// for states nearby, 28 for times, and what a stage leaves is the next one's.
    #[must_use]
    pub fn within(self, budget: Duration) -> Self {
        Self { budget, ..self }
    }

    /// Shows how much is done and how much is left, once two seconds are over: a [`Progress`](crate::Progress).
    #[must_use]
    pub fn show_progress(self) -> Self {
        Self { progress: true, ..self }
    }

    /// Asks now and then, with the part that is done, whether to stop; what was measured by then is in the report.
    #[must_use]
    pub fn stop_when(self, stop: impl FnMut(f64) -> bool + 'static) -> Self {
        Self { stop: Box::new(stop), ..self }
    }

    /// Sets the clock.
    #[must_use]
    pub fn stopwatch(self, stopwatch: impl Stopwatch + 'static) -> Self {
        Self { stopwatch: Box::new(stopwatch), ..self }
    }

    /// Sets the number of states nearby, 20 by default, on which settings that may be chosen have to prove
    /// themselves; none chooses by the initial states alone. An entry differs by at most `spread max(|x|, 1/3)`, with
    /// a spread of 0.4 by default. States that violate the constraints on positions are replaced by others of the
    /// same motion.
    #[must_use]
    pub fn probes(self, count: usize, spread: f64) -> Self {
        Self { probes: count, spread, ..self }
    }

    /// Sets the number of evaluations of the rates along each motion, 1,048,576 by default, to see kicks and steep
    /// layers that methods would step over; a sixteenth of them for states nearby and forecasts. References land in
    /// what is found, and the report says how long something has to last to be seen. A tenth of the study's time may
    /// go into it; what takes longer is looked at less closely.
    #[must_use]
    pub fn scan(self, evaluations: usize) -> Self {
        Self { points: evaluations.max(1), ..self }
    }

    /// Does it. Never fails: what could not be measured is said in the report. Nothing is where the span is empty, or one of its ends or a
    /// number of a start is not finite ([`NoChoice::NoMotion`]), for the energy of a system that keeps none ([`NoChoice::NoEnergy`]), and in
    /// sizes that are not positive ([`NoChoice::NoScales`]).
    #[must_use]
    pub fn run(self) -> Trade<N> {
        run::run(self)
    }

    /// The times at which errors are measured.
    fn times(&self) -> Vec<f64> {
        sample_times(self.t0, self.t1, self.samples)
    }
}

fn sample_times(t0: f64, t1: f64, samples: usize) -> Vec<f64> {
    let mut times: Vec<f64> = (1..samples).map(|k| t0 + (t1 - t0) * (k as f64 / samples as f64)).collect();
    times.push(t1);
    times
}

impl<S: WithScalar<N>, const N: usize> Study<S, N> {
    /// Adds a variant of the user's own: a method on the system in doubles.
    ///
    /// # Errors
    ///
    /// Those of `prepare`.
    ///
    /// ```
    /// use guen_runtime::{ConstantsError, WithScalar, steppers::Dop853};
    /// use guen_study::{Settings, Study};
    ///
    /// /// A study with DOP853 with a relative tolerance only.
    /// fn with_relative<S: WithScalar<2>>(study: Study<S, 2>) -> Result<Study<S, 2>, ConstantsError> {
    ///     study.with_method(
    ///         "DOP853, relative",
    ///         Settings::Tolerances,
    ///         |tolerance| Dop853::new(tolerance, 1e-300),
    ///         |tolerance| format!("Dop853::new({tolerance:?}, 1e-300)"),
    ///     )
    /// }
    /// ```
    pub fn with_method<M>(
        self,
        name: &str,
        settings: Settings,
        make: impl Fn(f64) -> M + 'static,
        code: impl Fn(f64) -> String + 'static,
    ) -> Result<Self, guen_runtime::ConstantsError>
    where
        M: Method<f64, S::Over<f64>, N> + 'static,
    {
        let system = self.system.with_scalar::<f64>()?;
        Ok(self.with_method_on(system, [name, "f64", "declared"], settings, make, code))
    }

    /// Adds Taylor series, of a system that says `provide taylor;`.
    ///
    /// # Errors
    ///
    /// Those of `prepare`.
    pub fn with_taylor(self) -> Result<Self, guen_runtime::ConstantsError>
    where
        S::Over<f64>: TaylorSeries<f64, N>,
    {
        let span = self.span();
        let method = |tolerance| Taylor::<f64>::new(tolerance, tolerance);
        self.with_method("Taylor", Settings::Tolerances, method, move |tolerance| {
            code::run(code::Origin::WithScalar, "f64", "Taylor", code::Argument::Tolerances, tolerance, span)
        })
    }

    /// Sets other methods for references, for systems that explicit ones are too slow for: the first is the
    /// reference, the second its check.
    ///
    /// # Errors
    ///
    /// Those of `prepare`.
    pub fn reference_by<A, B>(
        mut self,
        [name, check_name]: [&str; 2],
        method: A,
        check: B,
    ) -> Result<Self, guen_runtime::ConstantsError>
    where
        A: Method<Digits71, S::Over<Digits71>, N> + 'static,
        B: Method<Digits71, S::Over<Digits71>, N> + 'static,
    {
        let system = Rc::new(self.system.with_scalar::<Digits71>()?);
        self.reference = reference::by_method(name.to_owned(), Rc::clone(&system), method);
        self.check = Some(reference::by_method(check_name.to_owned(), system, check));
        self.shorter = None;
        Ok(self)
    }
}

/// The tells of a system in the long real.
fn tells_of<L, const N: usize>(system: Rc<L>) -> Tells<N>
where
    L: System<Digits71, N> + 'static,
{
    Box::new(move |t, x| system.guarded().conserved(t, x))
}

impl<S, const N: usize> Study<S, N> {
    /// Creates a study with everything but variants.
    fn bare<D, L>(system: S, doubles: &Rc<D>, long: &Rc<L>, start: [f64; N], span: Range<f64>) -> Self
    where
        D: System<f64, N> + 'static,
        L: System<Digits71, N> + 'static,
    {
        use guen_runtime::steppers::Dop853;
        /// The number of evaluations that a motion which is looked at closely may take: stiff ones take more.
        const SCAN_STEPS: u64 = scan::MOST_STEPS;
        let (tight, scanned) = (Rc::clone(doubles), Rc::clone(doubles));
        let References { reference, check, elsewhere } =
            reference::references_in::<Digits71, L, N>(long, reference::EXTRAPOLATION_TOLERANCE);
        Self {
            system,
            title: "study".to_owned(),
            starts: vec![start],
            t0: span.start,
            t1: span.end,
            samples: 1,
            measure: Measure::EndState,
            scales: None,
            variants: Vec::new(),
            reference,
            check: Some(check),
            elsewhere,
            shorter: None,
            tells: tells_of(Rc::clone(long)),
            tight: Rc::new(move |tolerance| {
                let method = Dop853::<f64>::new(tolerance, tolerance).with_max_steps(SCAN_STEPS);
                variant::run_of::<f64, D, _, N>(Rc::clone(&tight), method)
            }),
            scanner: Rc::new(move |problem, look, watch| scan::scan(&*scanned, problem, look, watch)),
            points: known::SCANNED_POINTS,
            unit: Unit::Seconds,
            budget: Duration::from_secs(60),
            progress: false,
            stop: Box::new(|_| false),
            stopwatch: Box::new(timing::Wall),
            probes: 20,
            spread: 0.4,
        }
    }

    fn span(&self) -> (f64, f64) {
        (self.t0, self.t1)
    }
}

/// The marker of a study that was made of closures.
#[derive(Clone, Copy, Debug)]
pub struct Closures;

impl<const N: usize> Study<Closures, N> {
    /// A study of a right-hand side that exists as closures only: one over doubles, and one over [`Digits71`] for the
    /// reference. Explicit methods in doubles are its variants. Where the right-hand side can be written once for every real, as
    /// [`Equations`](guen_runtime::Equations), [`Study::new`] with [`generic`](guen_runtime::generic) has all of them.
    ///
    /// ```
    /// use guen_study::{Digits71, Study};
    ///
    /// let study = Study::of_closures(
    ///     |_t: f64, &[x, v]: &[f64; 2]| [v, -x],
    ///     |_t: Digits71, &[x, v]: &[Digits71; 2]| [v, -x],
    ///     [0.0, 1.0],
    ///     0.0..5.0,
    /// );
    /// ```
    pub fn of_closures(
        doubles: impl Fn(f64, &[f64; N]) -> [f64; N] + 'static,
        long: impl Fn(Digits71, &[Digits71; N]) -> [Digits71; N] + 'static,
        start: [f64; N],
        span: Range<f64>,
    ) -> Self {
        let doubles = Rc::new(guen_runtime::from_fn(doubles));
        let long = Rc::new(guen_runtime::from_fn(long));
        let mut study = Self::bare(Closures, &doubles, &long, start, span);
        study.variants = standard::of_doubles("f64", &doubles, study.span(), code::Origin::Given);
        study
    }
}

/// Every state entry as a long real.
fn lengthened<const N: usize>(state: &[f64; N]) -> [Digits71; N] {
    state.map(Digits71::from_f64)
}
