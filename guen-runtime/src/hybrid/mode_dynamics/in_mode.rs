//! A system in one mode: reactions from one small solve over the Delassus matrix, and the smooth system that they make.

use super::mode_rows::{Leaning, ModeRows};
use super::pivots::Pivots;
use crate::hybrid::filled::{diagonal, filled, negated};
use crate::hybrid::interface::element::{Effect, Element, Signal};
use crate::hybrid::interface::mode::{ElementState, Mode};
use crate::hybrid::interface::reactions::Reactions;
use crate::hybrid::interface::system::{FreeMotion, HybridSystem};
use crate::numbers::dual::Dual;
use crate::numbers::lift::Lift;
use crate::numbers::power_series::PowerSeries;
use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::system::System;
use crate::system::constraints::positions_error::PositionsError;
use crate::system::derivatives::differentiable::Differentiable;
use crate::system::derivatives::linearization::seeded;
use crate::system::derivatives::series::{Coefficients, TaylorSeries};
use crate::system::guarded::Guarded;

/// A system in one of its modes, as a smooth [`System`] that every stepper runs.
///
/// ```text
/// eta' = M^-1 (Q - b) + sum_w (M^-1 W_w^T) l_w,     l = -G^-1 (biases),     G = W M^-1 C
/// ```
///
/// with the rows `W` and the columns `C` of the mode: `C = W_n^T - mu W_t^T d` where a contact slips in the direction `d`. The
/// matrix `G` is made of entries of the Delassus matrix, so that a mode costs one small solve. After every step the state is put back to
/// where closed contacts touch and what sticks does not slip.
#[derive(Clone, Copy, Debug)]
pub struct InMode<H, const N: usize, const W: usize, const C: usize, const S: usize> {
    pub(in crate::hybrid) system: H,
    pub(in crate::hybrid) mode: Mode<C>,
    pub(in crate::hybrid) switches: [f64; S],
    /// Whether branches of piecewise functions follow the state, and are not held.
    pub(super) follows: bool,
    pub(in crate::hybrid) pivots: Pivots<W>,
    /// The place among the modes that have a program of their own.
    eliminated: Option<usize>,
    /// The directions of spatial slip where the slip itself does not tell one.
    pub(in crate::hybrid) leaning: [Leaning; C],
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// The system in a mode, with the values of its switches at a time and state; the order of elimination is chosen there, and rows
    /// that depend on others are found.
    pub fn new(system: H, mode: Mode<C>, t: f64, state: &[f64; N]) -> Self {
        let switches = values_of_switches::<H, N, W, C, S>(&system.signals(t, state));
        Self::with_switches(system, mode, switches, t, state)
    }

    /// The system in a mode, with these values of the switches, wherever the state will be: the order of elimination is chosen, and
    /// rows that depend on others are found, at a state without symmetry. Branches of piecewise functions follow the state, whatever
    /// values they are given.
    pub fn anywhere(system: H, mode: Mode<C>, switches: [bool; S]) -> Self {
        let state = filled(|i| 0.37 + 0.061 * i as f64);
        let switches = switches.map(|value| f64::from(u8::from(value)));
        let chosen = Self { follows: true, ..Self::with_switches(system, mode, switches, 0.29, &state) };
        if chosen.pivots.independent().is_empty() {
            // The state is outside of where the system is defined.
            let pivots = Pivots::in_order(unknown_rows(&H::ELEMENTS, &mode));
            return Self { pivots, ..chosen };
        }
        chosen
    }

    /// The system in a mode, with these values of the switches.
    pub(in crate::hybrid) fn with_switches(
        system: H,
        mode: Mode<C>,
        switches: [f64; S],
        t: f64,
        state: &[f64; N],
    ) -> Self {
        let pivots = Pivots::in_order(unknown_rows(&H::ELEMENTS, &mode));
        let eliminated = H::ELIMINATED.iter().position(|known| *known == mode);
        let leaning = [Leaning::default(); C];
        let mut in_mode = Self { system, mode, switches, follows: false, pivots, eliminated, leaning };
        in_mode.choose_pivots(t, state);
        in_mode
    }

    /// Chooses the order of elimination anew.
    pub(in crate::hybrid) fn choose_pivots(&mut self, t: f64, state: &[f64; N]) {
        let free = self.free_motion(t, state);
        let directions = self.rows().directions(&free.row_rates);
        let (matrix, _) = self.rows().equations(&free, &directions);
        self.pivots = self.pivots.chosen(matrix, &diagonal(&free.delassus));
    }

    /// The rows of the mode, without the system.
    pub(in crate::hybrid) fn rows(&self) -> ModeRows<'_, W, C> {
        let Self { mode, pivots, leaning, .. } = self;
        ModeRows { elements: const { &H::ELEMENTS }, mode, pivots, leaning }
    }

    /// The mode.
    pub fn mode(&self) -> Mode<C> {
        self.mode
    }

    /// The values of the switches, zero or one.
    pub fn switches(&self) -> [f64; S] {
        self.switches
    }

    /// The system in whatever mode.
    pub fn system(&self) -> &H {
        &self.system
    }

    /// Whether some reactions of the mode are not determined, because rows depend on each other. The motion is.
    pub fn is_redundant(&self) -> bool {
        self.pivots.is_redundant()
    }

    /// The values of the switches as they are held, those of branches that follow the state from there.
    pub(super) fn lifted_switches<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> [R; S] {
        let mut held = self.switches.map(R::lift);
        if self.follows && H::SIGNALS.iter().any(|signal| signal.effect == Effect::Branch) {
            let values = self.system.signals(t, state);
            for (s, signal) in H::SIGNALS.iter().enumerate() {
                if signal.effect == Effect::Branch {
                    let (half, zero) = (R::from_ratio(1, 2), R::zero());
                    let below = (-values[s]).where_above(zero, zero, half);
                    held[s] = values[s].where_above(zero, R::one(), below);
                }
            }
        }
        held
    }

    /// The free motion in this mode.
    fn free_motion<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> FreeMotion<R, N, W, C> {
        let switches = self.lifted_switches(t, state);
        let mut speeds = [R::zero(); C];
        let needed = |(element, state): (&Element, &ElementState)| element.friction_of_speed && state.slips();
        if H::ELEMENTS.iter().zip(&self.mode.0).any(needed) {
            speeds = self.rows().speeds(&self.system.row_rates(t, state));
        }
        self.system.free_motion(t, state, &switches, &speeds)
    }

    /// The reactions in this mode at a time and state. Where rows depend on each other they are those with zero along the rows
    /// that were left out.
    pub fn reactions<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> Reactions<R, N, W, C> {
        let free = self.free_motion(t, state);
        let directions = self.rows().directions(&free.row_rates);
        let regularity = R::one();
        let mut motion =
            Reactions { free, reactions: [R::zero(); W], directions, loads: [R::zero(); C], regularity };
        self.solve(t, state, &mut motion);
        motion
    }

    /// Finds the reactions of a motion.
    // A function of its own: without optimisation its copies of matrices would stand in the frame below which the system is evaluated.
    fn solve<R: Lift<f64>>(&self, t: R, state: &[R; N], motion: &mut Reactions<R, N, W, C>) {
        let rows = self.rows();
        let (matrix, right) = rows.equations(&motion.free, &motion.directions);
        let sizes = diagonal(&motion.free.delassus);
        (motion.reactions, motion.regularity) = self.pivots.solve(matrix, right, &sizes);
        let FreeMotion { friction, limits, .. } = &motion.free;
        rows.add_friction(&mut motion.reactions, friction, &motion.directions, limits);
        if H::ELEMENTS.iter().any(|element| element.loaded_by_constraint) {
            let loads = self.system.loads(t, state, &self.lifted_switches(t, state));
            rows.load(motion, matrix, &loads, H::PAINLEVE_FREE);
        }
    }

    /// The rates of the state in this mode.
    #[inline]
    pub fn rates<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> [R; N] {
        if let Some(place) = self.eliminated {
            return self.system.eliminated_rates(place, t, state);
        }
        if self.pivots.all().is_empty() && !self.mode.0.iter().any(|state| state.slips()) {
            return self.system.free_rates(t, state, &self.lifted_switches(t, state));
        }
        self.reactions(t, state).rates()
    }

    /// The state after impulses along these rows have made their rates vanish.
    pub(in crate::hybrid) fn at_rest<R: Lift<f64>>(&self, t: R, state: &[R; N], rows: &Pivots<W>) -> [R; N] {
        let switches = self.lifted_switches(t, state);
        let free = self.system.free_motion(t, state, &switches, &[R::zero(); C]);
        let (impulses, _) = rows.solve(free.delassus, negated(free.row_rates), &[R::one(); W]);
        moved(state, &impulses, &free.responses)
    }

    /// The state with coordinates at which these gaps vanish, displaced as the reactions along the gaps would: one step of Newton's method.
    pub(in crate::hybrid) fn touching<R: Lift<f64>>(&self, t: R, state: &[R; N], rows: &Pivots<W>) -> [R; N] {
        let switches = self.lifted_switches(t, state);
        let free = self.system.free_motion(t, state, &switches, &[R::zero(); C]);
        let mut right = [R::zero(); W];
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            if let Some(row) = element.normal {
                right[row] = -free.gaps[c];
            }
        }
        let (shifts, _) = rows.solve(free.delassus, right, &[R::one(); W]);
        let mut still = *state;
        still[H::COORDINATES.min(N)..].fill(R::zero());
        let at_rest = self.system.free_rates(t, &still, &switches);
        let mut displaced = *state;
        for &row in rows.independent() {
            let mut pushed = still;
            for (entry, change) in pushed.iter_mut().zip(&free.responses[row]) {
                *entry += *change;
            }
            let velocities = self.system.free_rates(t, &pushed, &switches);
            for i in 0..H::COORDINATES.min(N) {
                displaced[i] += shifts[row] * (velocities[i] - at_rest[i]);
            }
        }
        displaced
    }

    /// The rows of gaps that are closed.
    fn closed_rows(&self) -> Pivots<W> {
        let closed = |row: usize| {
            H::ELEMENTS.iter().zip(&self.mode.0).any(|(e, state)| e.normal == Some(row) && state.is_closed())
        };
        Pivots::in_order(self.pivots.independent().iter().copied().filter(|&row| closed(row)))
    }

    /// The state with permanent constraints on positions fulfilled, closed gaps and what does not slip at zero: positions first, then
    /// velocities.
    pub(in crate::hybrid) fn restored<R: Lift<f64>>(
        &self,
        t: R,
        state: &[R; N],
    ) -> Result<[R; N], PositionsError> {
        let state = self.system.onto_constraints(t, state)?;
        if self.pivots.all().is_empty() {
            return Ok(state);
        }
        let closed = self.closed_rows();
        let state = if closed.all().is_empty() { state } else { self.touching(t, &state, &closed) };
        Ok(self.at_rest(t, &state, &Pivots::in_order(self.pivots.independent().iter().copied())))
    }
}

/// The state with impulses or displacements of velocity along rows added.
pub(in crate::hybrid) fn moved<R: Real, const N: usize, const W: usize>(
    state: &[R; N],
    impulses: &[R; W],
    responses: &[[R; N]; W],
) -> [R; N] {
    let mut moved = *state;
    for (impulse, response) in impulses.iter().zip(responses) {
        for (entry, change) in moved.iter_mut().zip(response) {
            *entry = impulse.times_plus(*change, *entry);
        }
    }
    moved
}

/// The rows whose reactions are unknowns of a mode: normals of what is closed, slips of what sticks.
fn unknown_rows<const C: usize>(elements: &[Element; C], mode: &Mode<C>) -> impl Iterator<Item = usize> {
    let states = mode.0;
    (0..C).flat_map({
        let elements = *elements;
        move |c| {
            let normal = elements[c].normal.filter(|_| states[c].is_closed());
            let tangential = if states[c] == ElementState::Stick { elements[c].tangential } else { &[] };
            normal.into_iter().chain(tangential.iter().copied())
        }
    })
}

impl<R: Lift<f64>, H, const N: usize, const W: usize, const C: usize, const S: usize> System<R, N>
    for InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    #[inline]
    fn rhs(&self, t: R, state: &[R; N]) -> [R; N] {
        self.rates(t, state)
    }

    fn restore(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError> {
        let restored = self.restored(t, state)?;
        if !restored.iter().all(|entry| entry.is_finite()) {
            return Err(PositionsError::NotFinite);
        }
        // A state that changes by rounding alone stays as it is, so that the slope at the end of a step stays its slope. Each lane is asked
        // by itself.
        let (zero, rounding) = (R::zero(), R::from_f64(4.0 * f64::EPSILON));
        let moved = restored.iter().zip(state.iter()).fold(-R::one(), |most, (new, old)| {
            let beyond = (*new - *old).abs() - rounding * old.abs();
            beyond.where_above(most, beyond, most)
        });
        for (old, new) in state.iter_mut().zip(restored) {
            *old = moved.where_above(zero, new, *old);
        }
        Ok(())
    }

    /// The branches of piecewise functions, where they follow the state.
    fn switches(&self, t: R, state: &[R; N], values: &mut [R]) -> usize {
        let is_branch = |signal: &Signal| signal.effect == Effect::Branch;
        if !self.follows || !H::SIGNALS.iter().any(is_branch) {
            return 0;
        }
        let found = self.system.signals(t, state);
        let branches = H::SIGNALS.iter().zip(found).filter(|(signal, _)| is_branch(signal));
        values.iter_mut().zip(branches).map(|(place, (_, value))| *place = value).count()
    }

    #[inline]
    fn guarded(&self) -> impl Guarded<R, N> {
        self
    }
}

impl<R: Lift<f64>, H, const N: usize, const W: usize, const C: usize, const S: usize> Guarded<R, N>
    for InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    #[inline]
    fn singularities(
        &self,
        t: RunningError<R>,
        state: &[RunningError<R>; N],
        values: &mut [RunningError<R>],
    ) -> usize {
        self.system.singularities(t, state, values)
    }
}

/// The values of switches and branches by those of their functions; zero for other signals.
pub(super) fn values_of_switches<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    functions: &[f64; S],
) -> [f64; S]
where
    H: HybridSystem<N, W, C, S>,
{
    filled(|s| match H::SIGNALS[s].effect {
        Effect::Branch if functions[s] == 0.0 => 0.5,
        Effect::Switch | Effect::Branch => f64::from(u8::from(functions[s] > 0.0)),
        Effect::ResetWhenRising | Effect::ResetWhenFalling => 0.0,
    })
}

impl<R, H, const N: usize, const W: usize, const C: usize, const S: usize> Differentiable<R, N>
    for InMode<H, N, W, C, S>
where
    R: Lift<f64>,
    H: HybridSystem<N, W, C, S>,
{
    fn jacobian(&self, t: R, state: &[R; N]) -> [[R; N]; N] {
        self.rates(Dual::constant(t), &seeded(state)).map(|rate| rate.tangent)
    }

    fn along(&self, t: R, state: &[R; N], dt: R, dx: &[R; N]) -> [R; N] {
        let time = Dual { value: t, tangent: [dt] };
        let state = filled(|i| Dual { value: state[i], tangent: [dx[i]] });
        self.rates(time, &state).map(|rate| rate.tangent[0])
    }
}

/// The motion through a state as power series in a unit of time: one evaluation of the rates for each order.
pub(in crate::hybrid) fn motion_series<R: Lift<f64>, const N: usize>(
    (t, state): (R, &[R; N]),
    unit: R,
    order: usize,
    rates: impl Fn(PowerSeries<R>, &[PowerSeries<R>; N]) -> [PowerSeries<R>; N],
) -> [PowerSeries<R>; N] {
    let mut series = state.map(|entry| PowerSeries::known([entry]));
    for k in 1..=order {
        let slopes = rates(PowerSeries::line(t, unit), &series);
        let part = unit / R::from_ratio(k as i64, 1);
        for (entry, slope) in series.iter_mut().zip(&slopes) {
            entry.know(k, slope.coefficient(k - 1) * part);
        }
    }
    series
}

impl<R, H, const N: usize, const W: usize, const C: usize, const S: usize> TaylorSeries<R, N>
    for InMode<H, N, W, C, S>
where
    R: Lift<f64>,
    H: HybridSystem<N, W, C, S>,
{
    // The series come from the program of the rates over power series, not from recurrences with sums of their own.
    const PRODUCTS: usize = 0;

    fn series(&self, t: R, state: &[R; N], scale: R, order: usize, coefficients: &mut Coefficients<R, N>) {
        let series = motion_series((t, state), scale, order, |t, state| self.rates(t, state));
        for (k, coefficients) in coefficients.iter_mut().enumerate().take(order + 1) {
            *coefficients = filled(|i| series[i].coefficient(k));
        }
    }
}
