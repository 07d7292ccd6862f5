//! Derivatives of a motion through modes by its start: the variations within the modes, and the saltations between them.

use super::saltation::{NoSaltation, Saltation};
use crate::hybrid::filled::{filled, table};
use crate::hybrid::interface::mode::Mode;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::TransitionKind;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::hybrid::simulations::kept::Segment;
use crate::hybrid::simulations::trajectory::HybridTrajectory;
use crate::numbers::dual::Dual;
use crate::steppers::{Cause, Checkpoint, Interpolant, Method, StepperRun};
use core::error::Error;
use core::fmt;

/// The derivatives of a transition by the state at the start of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransitionSensitivity<const N: usize> {
    /// The derivatives of its time.
    pub time: [f64; N],
    /// The derivatives of the state right after it, wherever its time then is: `state[i][j]` is that of entry `i` by entry `j` of the
    /// start. That of a Poincaré map from the start to the transition.
    pub state: [[f64; N]; N],
}

/// The reason why the derivatives of a motion through modes could not be computed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SensitivityError {
    /// The motion has no derivative through a transition.
    Transition {
        /// The position of the transition.
        transition: usize,
        /// The time of the transition.
        t: f64,
        /// The reason why there is no derivative.
        why: NoSaltation,
    },
    /// The motion has no derivative by its start: there it is between two cases, as a slip from rest is between its directions, and the sign
    /// of a deviation decides which.
    Start {
        /// The name of the element, switch or reset that is between them.
        element: &'static str,
    },
    /// There is no transition of this position that ends a mode.
    NoTransition {
        /// The position asked for.
        transition: usize,
    },
    /// A controller found inputs on the way, and its derivatives are not known.
    Sampled,
    /// The integration of the variations within a mode failed.
    Integration {
        /// The time that was reached.
        t: f64,
        /// The reason why it could not go on.
        cause: Cause,
    },
}

impl fmt::Display for SensitivityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Transition { transition, t, why } => {
                write!(f, "the motion has no derivative through transition {transition} at t = {t}: {why}")
            }
            Self::Start { element } => {
                write!(
                    f,
                    "the motion has no derivative by its start, where `{element}` is between two cases: the sign of a \
                     deviation decides what happens"
                )
            }
            Self::Sampled => {
                write!(f, "the derivatives of a controller that finds inputs on the way are not known")
            }
            Self::NoTransition { transition } => write!(f, "no mode ends with a transition {transition}"),
            Self::Integration { t, cause } => write!(f, "the variations stop at t = {t}: {cause}"),
        }
    }
}

impl Error for SensitivityError {}

impl<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize>
    HybridTrajectory<H, X, N, W, C, S, P>
where
    H: HybridSystem<N, W, C, S> + Clone,
    X: Copy + From<[f64; N]> + Into<[f64; N]>,
    P: Interpolant<f64, N>,
{
    /// The derivative of the motion through a transition, by its position among [`transitions`](Self::transitions).
    ///
    /// # Errors
    ///
    /// The motion has no derivative there; [`NoSaltation::OtherModes`] where there is no such transition.
    pub fn saltation(&self, transition: usize) -> Result<Saltation<N>, NoSaltation> {
        let told = self.transitions().get(transition).ok_or(NoSaltation::OtherModes)?;
        if told.kind == TransitionKind::Touch {
            return Err(NoSaltation::Grazing);
        }
        let segments = &self.log.segments;
        let place = segments.partition_point(|segment| segment.transitions <= transition);
        let after = segments.get(place).ok_or(NoSaltation::OtherModes)?;
        if told.facts.begins {
            let InMode { system, switches, .. } = after.in_mode.clone();
            let mode = Mode::free(&H::ELEMENTS);
            let before = InMode::with_switches(system, mode, switches, told.t, &told.state_before);
            return told.saltation(&before, &after.in_mode);
        }
        let before = segments.get(place.saturating_sub(1)).unwrap_or(after);
        told.saltation(&before.in_mode, &after.in_mode)
    }

    /// The derivatives of the state at the end by the state at the start, `[i][j]` that of entry `i` by entry `j`: the product of the
    /// variations within the modes, which a method computes in dual numbers, and of the [saltations](Self::saltation) between them.
    ///
    /// A start is put onto what its mode demands before it moves, and deviations of it too. Of a motion that begins on a contact and leaves
    /// it, at once or by an impact, the derivatives are those by starts on the open side of the gap. The method's tolerances judge the motion.
    ///
    /// ```
    /// # use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Mode, Signal};
    /// # use guen_runtime::{Lift, Real};
    /// # #[derive(Clone, Copy)]
    /// # struct Ball;
    /// # impl HybridSystem<2, 1, 1, 0> for Ball {
    /// #     const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0)];
    /// #     const SIGNALS: [Signal; 0] = [];
    /// #     const COORDINATES: usize = 1;
    /// #     type Mode = Mode<1>;
    /// #     type Inputs = ();
    /// #     fn with_inputs(&self, (): ()) -> Self {
    /// #         *self
    /// #     }
    /// #     fn free_motion<R: Lift<f64>>(&self, _t: R, &[z, v]: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
    /// #         let (zero, one, g) = (R::zero(), R::one(), R::lift(9.81));
    /// #         FreeMotion {
    /// #             rates: [v, -g], gaps: [z], row_rates: [v], biases: [-g], delassus: [[one]], responses: [[zero, one]],
    /// #             friction: [zero], stiction: [zero], limits: [zero],
    /// #         }
    /// #     }
    /// #     fn restitutions(&self) -> [f64; 1] {
    /// #         [0.5]
    /// #     }
    /// #     fn signals<R: Lift<f64>>(&self, _t: R, _: &[R; 2]) -> [R; 0] {
    /// #         []
    /// #     }
    /// # }
    /// use guen_runtime::steppers::Dop853;
    ///
    /// let end = |height: f64| Ball.simulation(&[height, 0.0]).tolerance(1e-12).run(0.0..0.8).unwrap();
    /// let by_start = end(1.0).sensitivity(&Dop853::new(1e-12, 1e-12)).unwrap();
    /// let difference = (end(1.0 + 1e-6).end()[0] - end(1.0 - 1e-6).end()[0]) / 2e-6;
    /// assert!((by_start[0][0] - difference).abs() < 1e-8);
    /// ```
    ///
    /// # Errors
    ///
    /// A transition through which the motion has no derivative, a start between two cases, or the method's error.
    pub fn sensitivity<M>(&self, method: &M) -> Result<[[f64; N]; N], SensitivityError>
    where
        M: Method<Dual<f64, N>, InMode<H, N, W, C, S>, N>,
    {
        let (matrix, last) = self.through(self.log.segments.len(), method)?;
        // What is told of after the last mode has begun ends no mode.
        if let Some((transition, told)) = self.transitions.iter().enumerate().nth(self.log.told()) {
            return Err(SensitivityError::Transition { transition, t: told.t, why: NoSaltation::Grazing });
        }
        match last {
            Some(segment) => varied(segment, &matrix, self.end_time(), method),
            None => Ok(matrix),
        }
    }

    /// The derivatives of a transition, by its position among [`transitions`](Self::transitions), by the state at the start: of its time,
    /// and of the state after it. The map from one such event to the next has them as its linearisation, a gait its multipliers.
    ///
    /// # Errors
    ///
    /// A transition through which the motion has no derivative, this one included, or the method's error.
    pub fn sensitivity_of_transition<M>(
        &self,
        transition: usize,
        method: &M,
    ) -> Result<TransitionSensitivity<N>, SensitivityError>
    where
        M: Method<Dual<f64, N>, InMode<H, N, W, C, S>, N>,
    {
        let place = self.log.segments.partition_point(|segment| segment.transitions <= transition);
        let (Some(after), Some(told)) = (self.log.segments.get(place), self.transitions().get(transition))
        else {
            return Err(SensitivityError::NoTransition { transition });
        };
        let (mut matrix, last) = self.through(place, method)?;
        if let Some(segment) = last {
            matrix = varied(segment, &matrix, after.start, method)?;
        }
        let failed = |transition, t, why| SensitivityError::Transition { transition, t, why };
        if let Some(touch) = (last.map_or(0, |before| before.transitions)..transition).next() {
            return Err(failed(touch, self.transitions[touch].t, NoSaltation::Grazing));
        }
        let jump = self.saltation(transition).map_err(|why| failed(transition, told.t, why))?;
        let time = filled(|j| (0..N).map(|k| jump.time[k] * matrix[k][j]).sum());
        Ok(TransitionSensitivity { time, state: product(&jump.at_transition(), &matrix) })
    }

    /// The derivatives at the beginning of the last of some segments by the start, and that segment.
    #[allow(clippy::type_complexity, reason = "a matrix and where it holds")]
    fn through<M>(
        &self,
        count: usize,
        method: &M,
    ) -> Result<([[f64; N]; N], Option<&Segment<H, N, W, C, S>>), SensitivityError>
    where
        M: Method<Dual<f64, N>, InMode<H, N, W, C, S>, N>,
    {
        if self.is_sampled {
            return Err(SensitivityError::Sampled);
        }
        let mut matrix: [[f64; N]; N] = table(|i, j| if i == j { 1.0 } else { 0.0 });
        let mut last: Option<&Segment<H, N, W, C, S>> = None;
        for segment in self.log.segments.iter().take(count) {
            if let Some(before) = last {
                matrix = varied(before, &matrix, segment.start, method)?;
            }
            let told = last.map_or(0, |before| before.transitions);
            for transition in told..segment.transitions {
                let t = self.transitions()[transition].t;
                let jump = self.saltation(transition);
                let jump = jump.map_err(|why| SensitivityError::Transition { transition, t, why })?;
                matrix = product(&jump.matrix, &matrix);
            }
            if told == segment.transitions {
                // A mode that begins without a transition: the start, or other inputs.
                matrix = put_back(segment, &matrix, last.is_none())?;
            }
            last = Some(segment);
        }
        Ok((matrix, last))
    }
}

/// The product of two matrices.
fn product<const N: usize>(a: &[[f64; N]; N], b: &[[f64; N]; N]) -> [[f64; N]; N] {
    table(|i, j| (0..N).map(|k| a[i][k] * b[k][j]).sum())
}

/// The deviations that a mode allows where it begins, `first` where the motion does.
fn put_back<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    segment: &Segment<H, N, W, C, S>,
    matrix: &[[f64; N]; N],
    first: bool,
) -> Result<[[f64; N]; N], SensitivityError>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    let Segment { start, state, in_mode, .. } = segment;
    let parts = in_mode.allowed(*start, state);
    let parts = parts.map_err(|_| SensitivityError::Integration { t: *start, cause: Cause::NotFinite })?;
    if first && let Some(element) = in_mode.divides(*start, state, &parts) {
        return Err(SensitivityError::Start { element });
    }
    Ok(product(&table(|i, j| parts[j][i]), matrix))
}

/// The deviations at a time, from those at the beginning of a segment.
fn varied<H, M, const N: usize, const W: usize, const C: usize, const S: usize>(
    segment: &Segment<H, N, W, C, S>,
    matrix: &[[f64; N]; N],
    end: f64,
    method: &M,
) -> Result<[[f64; N]; N], SensitivityError>
where
    H: HybridSystem<N, W, C, S>,
    M: Method<Dual<f64, N>, InMode<H, N, W, C, S>, N>,
{
    if end <= segment.start {
        return Ok(*matrix);
    }
    let state = filled(|i| Dual { value: segment.state[i], tangent: matrix[i] });
    let mut run = method.start(&Checkpoint::new(Dual::constant(segment.start), &state));
    let target = Dual::constant(end);
    while run.checkpoint().time.value != end {
        run.advance(&segment.in_mode, target, false)
            .map_err(|cause| SensitivityError::Integration { t: run.checkpoint().time.value, cause })?;
    }
    let failed = |cause| SensitivityError::Integration { t: end, cause };
    let state = run.checkpoint().state;
    let state = segment.in_mode.restored(target, &state);
    let state = state.map_err(|error| failed(Cause::of_positions(error)))?;
    if !state.iter().flat_map(|entry| entry.tangent).all(f64::is_finite) {
        return Err(failed(Cause::NotFinite));
    }
    Ok(state.map(|entry| entry.tangent))
}
