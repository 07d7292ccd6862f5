//! Derivatives of transitions: what becomes of a small deviation of the state, by the motions before and after and by the jump between.

use crate::hybrid::events::vanishing::vanishes;
use crate::hybrid::events::watched::{Function, Sides};
use crate::hybrid::filled::{filled, table};
use crate::hybrid::impacts::turning::Along;
use crate::hybrid::interface::mode::{ElementState, Mode};
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::{Facts, Transition, TransitionKind};
use crate::hybrid::mode_dynamics::in_mode::{InMode, motion_series};
use crate::numbers::dual::Dual;
use crate::numbers::power_series::PowerSeries;
use crate::numbers::running_error::RunningError;
use core::error::Error;
use core::fmt;

/// The derivative of the motion through one transition by the state before it.
///
/// A deviation `d` of the state just before the transition shifts its time by `time . d`; where both motions have passed it, the state
/// deviates by
///
/// ```text
/// matrix d,     matrix = J + (f+ - J f- - J_t) time^T,     time = -h_x / (h_t + h_x f-)
/// ```
///
/// with the rates `f-` and `f+` before and after, the jump `J` of the state, and the function `h` that reaches zero. Deviations that closed
/// gaps or what sticks would not allow are put back first, as a run does after every step.
///
/// [`Transition::saltation`] computes it, with an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saltation<const N: usize> {
    /// The deviation after the transition by that before it, both at the same time: `matrix[i][j]` is that of entry `i` by entry `j`.
    pub matrix: [[f64; N]; N],
    /// The derivatives of the time of the transition.
    pub time: [f64; N],
    /// The rates of the state right after it, `f+`.
    pub rates_after: [f64; N],
}

impl<const N: usize> Saltation<N> {
    /// The derivatives of the state right after the transition, wherever its time then is: `matrix + f+ time^T`, what a Poincaré map needs.
    pub fn at_transition(&self) -> [[f64; N]; N] {
        table(|i, j| self.matrix[i][j] + self.rates_after[i] * self.time[j])
    }
}

/// The reason why a motion has no derivative through a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoSaltation {
    /// A function touches zero and hardly crosses it: a small deviation misses it, or meets it at a time that changes without bound.
    Grazing,
    /// Several functions reach zero at once, or a whole sequence of impacts does: a deviation separates them.
    Simultaneous,
    /// A spatial slip ends: its direction turns without bounds there, and only a deviation among many leads through rest.
    SpatialSlip,
    /// An impact between two cases: a contact that takes part neither presses nor opens, or neither sticks nor slips, and what
    /// deviations do depends on their sign.
    Divided,
    /// The modes that were given are not those of the transition.
    OtherModes,
    /// A derivative is not finite.
    NotFinite,
}

impl fmt::Display for NoSaltation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Grazing => "a function touches zero without crossing it",
            Self::Simultaneous => "several functions reach zero at once",
            Self::SpatialSlip => "a spatial slip ends",
            Self::Divided => "an impact is between two cases",
            Self::OtherModes => "the modes are not those of the transition",
            Self::NotFinite => "a derivative is not finite",
        })
    }
}

impl Error for NoSaltation {}

/// Numbers with their derivatives along a direction.
pub(super) fn along<const N: usize>(values: &[f64; N], direction: &[f64; N]) -> [Along; N] {
    filled(|i| Dual { value: values[i], tangent: [direction[i]] })
}

impl<M, const N: usize, const W: usize, const C: usize> Transition<M, N, W, C> {
    /// The derivative of the motion through this transition, from the systems in the modes before and after it.
    ///
    /// [`Hybrid::transitions_between`](crate::hybrid::Hybrid::transitions_between) tells of transitions with both; a trajectory has
    /// them, `HybridTrajectory::saltation`. Of an impact with which a run begins it is the derivative on the side on which the gap is open.
    ///
    /// # Errors
    ///
    /// The motion has no derivative there: see [`NoSaltation`].
    ///
    /// ```
    /// # use core::ops::ControlFlow;
    /// # use guen_runtime::hybrid::{Element, FreeMotion, Hybrid, HybridSystem, Mode, Signal};
    /// # use guen_runtime::steppers::Dop853;
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
    /// // A ball that falls from a height of one and bounces with half of its speed.
    /// let mut saltation = None;
    /// Hybrid::new(&Ball, 0.0, &[1.0, 0.0])
    ///     .transitions_between(&mut |impact, before, after| {
    ///         saltation = Some(impact.saltation(before, after));
    ///         ControlFlow::Break(())
    ///     })
    ///     .run(&Dop853::new(1e-11, 1e-11), 2.0)
    ///     .unwrap();
    /// let saltation = saltation.unwrap().unwrap();
    /// // Heights deviate by minus a half of what they did; higher by `d`, the ball lands later by `d/v`.
    /// let speed = f64::sqrt(2.0 * 9.81);
    /// assert!((saltation.matrix[0][0] + 0.5).abs() < 1e-12);
    /// assert!((saltation.time[0] - 1.0 / speed).abs() < 1e-12);
    /// ```
    pub fn saltation<H, const S: usize>(
        &self,
        before: &InMode<H, N, W, C, S>,
        after: &InMode<H, N, W, C, S>,
    ) -> Result<Saltation<N>, NoSaltation>
    where
        H: HybridSystem<N, W, C, S>,
    {
        let facts = &self.facts;
        let ends_spatial_slip = |c: usize| facts.slip[c] && H::ELEMENTS[c].tangential.len() == 2;
        if self.kind == TransitionKind::Touch {
            return Err(NoSaltation::Grazing);
        }
        if (0..C).any(ends_spatial_slip) {
            return Err(NoSaltation::SpatialSlip);
        }
        if facts.signals > 1 {
            return Err(NoSaltation::Simultaneous);
        }
        let (t, x) = (self.t, &self.state_before);
        let (rates, rates_after) = (before.rates(t, x), after.rates(t, &self.state_after));
        let directions: [[f64; N]; N] = before.allowed(t, x)?;
        let met = match facts.begins {
            true => Some(Function::Gap(before.met_at_start(facts, &after.mode())?)),
            false => None,
        };
        let time = self.shifts(before, &rates, &directions, met)?;
        let mut columns = [[0.0; N]; N];
        for (j, column) in columns.iter_mut().enumerate() {
            // Along the surface on which the function vanishes, and from there at the time of the transition again.
            let to_surface = filled(|i| directions[j][i] + rates[i] * time[j]);
            let moment = Dual { value: t, tangent: [time[j]] };
            let jumped = self.jumped(before, after, moment, &along(x, &to_surface))?;
            let back = filled(|i| jumped[i].tangent[0] - rates_after[i] * time[j]);
            *column = after.allowed_part(t, &self.state_after, &back)?;
        }
        let matrix: [[f64; N]; N] = table(|i, j| columns[j][i]);
        let finite = matrix.iter().flatten().chain(&time).all(|entry| entry.is_finite());
        if finite { Ok(Saltation { matrix, time, rates_after }) } else { Err(NoSaltation::NotFinite) }
    }

    /// The derivatives of the time of the transition along directions. At the start of a run the function that was met is given.
    fn shifts<H, const S: usize>(
        &self,
        before: &InMode<H, N, W, C, S>,
        rates: &[f64; N],
        directions: &[[f64; N]; N],
        met: Option<Function>,
    ) -> Result<[f64; N], NoSaltation>
    where
        H: HybridSystem<N, W, C, S>,
    {
        /// The part of the largest shift by which those of several functions may differ: by rounding of functions of one surface.
        const SAME: f64 = 1e-6;

        let (t, x) = (self.t, &self.state_before);
        // The sides of a function do not change where it vanishes.
        let sides = Sides { latches: [1.0; C], signals: [1.0; S], slow: [0.0; C] };
        let mut shifts: Option<[f64; N]> = None;
        let (mut any, mut largest, mut difference) = (false, 0.0_f64, 0.0_f64);
        for function in Function::all(C, S) {
            if !(met == Some(function) || self.facts.has(function, self.signal)) {
                continue;
            }
            any = true;
            if before.is_grazing(function, &sides, t, x) {
                continue;
            }
            let Some(along_motion) =
                before.watched(&sides, Dual { value: t, tangent: [1.0] }, &along(x, rates)).get(function)
            else {
                continue;
            };
            let of_function = directions.map(|direction| {
                let value = before.watched(&sides, Dual::constant(t), &along(x, &direction)).get(function);
                value.map_or(f64::NAN, |value| -value.tangent[0] / along_motion.tangent[0])
            });
            largest = of_function.iter().fold(largest, |most, shift| most.max(shift.abs()));
            match &shifts {
                None => shifts = Some(of_function),
                Some(first) => {
                    for (a, b) in first.iter().zip(&of_function) {
                        difference = difference.max((a - b).abs());
                    }
                }
            }
        }
        match shifts {
            Some(_) if self.facts.inputs => Err(NoSaltation::Simultaneous),
            // Where inputs change the time is given.
            None if !any => Ok([0.0; N]),
            None => Err(NoSaltation::Grazing),
            Some(_) if difference > SAME * largest => Err(NoSaltation::Simultaneous),
            Some(shifts) => Ok(shifts),
        }
    }
}

impl<const C: usize> Facts<C> {
    /// Whether a function reached zero, or one of them did of which the signal is the only one.
    fn has(&self, function: Function, signal: Option<usize>) -> bool {
        match function {
            Function::Gap(c) => self.gap[c],
            Function::Normal(c) => self.normal[c],
            Function::Cone(c, positive) => self.cone[c][usize::from(!positive)],
            Function::Slip(c) => self.slip[c],
            Function::Signal(s) => signal == Some(s),
            Function::Shared => self.shared,
            Function::Regularity => false,
        }
    }
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// The part of a deviation that closed gaps and what sticks allow.
    pub(super) fn allowed_part(
        &self,
        t: f64,
        state: &[f64; N],
        deviation: &[f64; N],
    ) -> Result<[f64; N], NoSaltation> {
        let restored = self.restored(Dual::constant(t), &along(state, deviation));
        Ok(restored.map_err(|_| NoSaltation::NotFinite)?.map(|entry| entry.tangent[0]))
    }

    /// The parts of all unit deviations that are allowed, one after the other.
    pub(super) fn allowed(&self, t: f64, state: &[f64; N]) -> Result<[[f64; N]; N], NoSaltation> {
        let mut parts = unit_matrix();
        for part in &mut parts {
            *part = self.allowed_part(t, state, part)?;
        }
        Ok(parts)
    }

    /// The contact whose gap closes in an impact with which a run begins, if nothing else touches, grips or locks: a start with a larger gap
    /// meets it later. With more than one contact a deviation separates them.
    fn met_at_start(&self, facts: &Facts<C>, after: &Mode<C>) -> Result<usize, NoSaltation> {
        let takes_part = facts.takes_part.unwrap_or([false; C]);
        let mut met = (0..C).filter(|c| takes_part[*c]);
        let (Some(contact), None) = (met.next(), met.next()) else { return Err(NoSaltation::Simultaneous) };
        let is_free = |c: usize| matches!(after.0[c], ElementState::Open | ElementState::Free);
        let alone = (0..C).all(|c| c == contact || is_free(c));
        if alone { Ok(contact) } else { Err(NoSaltation::Simultaneous) }
    }

    /// Whether a function that vanishes hardly crosses zero.
    fn is_grazing(&self, function: Function, sides: &Sides<C, S>, t: f64, state: &[f64; N]) -> bool {
        /// The square of the part of a function's own size within which it turns back.
        const TURNS: f64 = 1e-14;

        let (time, unit) = (RunningError::once(t), RunningError::exact(1.0));
        let start = state.map(RunningError::once);
        let series = motion_series((time, &start), unit, 2, |t, state| self.rates(t, state));
        let watched = self.watched(sides, PowerSeries::line(time, unit), &series);
        let Some(function) = watched.get(function) else { return true };
        let [size, rate, bend] = [0, 1, 2].map(|k| function.coefficient(k));
        vanishes(rate) || !(rate.value * rate.value > TURNS * size.error * bend.value.abs())
    }
}

/// The unit vectors.
pub(super) fn unit_matrix<const N: usize>() -> [[f64; N]; N] {
    table(|i, j| if i == j { 1.0 } else { 0.0 })
}
