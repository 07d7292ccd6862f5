//! Selects the mode that follows a transition: every inequality of every mode that fits is expanded in time, and its first derivative that does
//! not vanish decides.

use crate::hybrid::events::vanishing::{
    VANISHING, VANISHING_ROUNDING, is_rounding, vanishes, vanishes_within,
};
use crate::hybrid::filled::filled;
use crate::hybrid::interface::element::Kind;
use crate::hybrid::interface::error::HybridCause;
use crate::hybrid::interface::mode::{ElementState, Mode};
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::mode_dynamics::in_mode::{InMode, motion_series};
use crate::hybrid::mode_dynamics::mode_rows::Leaning;
use crate::numbers::power_series::PowerSeries;
use crate::numbers::running_error::RunningError;

/// A rate that is known to vanish, or not to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rate {
    Still,
    Moving,
}

/// The facts of an element from which a mode is selected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    /// Whether the contact touches: its gap is zero.
    pub(super) touches: bool,
    /// The rate of the gap: still, or opening.
    pub(super) normal: Rate,
    /// The slip: still, or moving as the state says.
    pub(super) slip: Rate,
    /// Functions that vanish because their zero was located: the normal reaction, the two margins of the cone.
    pub(super) normal_reaction_fired: bool,
    pub(super) cone_fired: [bool; 2],
    /// The state of a latch, which is not selected.
    pub(super) latch: ElementState,
}

impl Default for Known {
    fn default() -> Self {
        Self {
            touches: false,
            normal: Rate::Moving,
            slip: Rate::Moving,
            normal_reaction_fired: false,
            cone_fired: [false; 2],
            latch: ElementState::Free,
        }
    }
}

/// The reason why no mode was selected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unselected<const C: usize> {
    /// No mode fits.
    Inconsistent,
    /// Two modes fit.
    Ambiguous([Mode<C>; 2]),
    /// There are too many modes to compare.
    TooMany,
}

impl<const C: usize> From<Unselected<C>> for HybridCause<C> {
    fn from(why: Unselected<C>) -> Self {
        match why {
            Unselected::Inconsistent => Self::Inconsistent,
            Unselected::Ambiguous(modes) => Self::Ambiguous { modes },
            Unselected::TooMany => Self::TooManyModes,
        }
    }
}

/// The order to which inequalities are expanded.
const HIGHEST: usize = 5;
/// Modes that are compared at one transition.
const MAX_CANDIDATES: usize = 1 << 14;

type Jet = PowerSeries<RunningError<f64>>;

/// The sign of a function next, as its first terms say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sign {
    Positive,
    Negative,
    /// All terms vanish that are known.
    Unknown,
}

/// The sign of a function, from the term of this order on; terms vanish within a part of what they are made of.
fn sign(jet: &Jet, from: usize, order: usize, part: f64) -> Sign {
    for k in from..=order.min(jet.order()) {
        let term = jet.coefficient(k);
        if term.value.is_nan() {
            return Sign::Negative;
        }
        if !vanishes_within(term, part) {
            return if term.value > 0.0 { Sign::Positive } else { Sign::Negative };
        }
    }
    Sign::Unknown
}

/// A mode that was tried, as far as its inequalities have been expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Consistent,
    Inconsistent,
    /// Further terms decide.
    Open,
}

/// The states that an element may have next.
fn candidates(kind: Kind, components: usize, known: &Known, sign: f64) -> ([ElementState; 4], usize) {
    use ElementState::{Closed, Free, Locked, Open, Slip, SlipBackward, SlipForward, Stick};
    let closed = known.touches && known.normal == Rate::Still;
    let list = |states: &[ElementState]| {
        let mut all = [Open; 4];
        all[..states.len()].copy_from_slice(states);
        (all, states.len())
    };
    let along = if sign > 0.0 { SlipForward } else { SlipBackward };
    match (kind, components, known.slip) {
        (Kind::Latch, ..) => list(&[if known.latch == Locked { Locked } else { Free }]),
        (Kind::Smooth | Kind::Rough, ..) if !closed => list(&[Open]),
        (Kind::Smooth, ..) => list(&[Open, Closed]),
        (Kind::Rough, 1, Rate::Still) => list(&[Open, Stick, SlipForward, SlipBackward]),
        (Kind::Rough, 1, Rate::Moving) => list(&[Open, along]),
        (Kind::Rough, _, Rate::Still) => list(&[Open, Stick, Slip]),
        (Kind::Rough, _, Rate::Moving) => list(&[Open, Slip]),
        (Kind::Grip, 1, Rate::Still) => list(&[Stick, SlipForward, SlipBackward]),
        (Kind::Grip, 1, Rate::Moving) => list(&[along]),
        (Kind::Grip, _, Rate::Still) => list(&[Stick, Slip]),
        (Kind::Grip, _, Rate::Moving) => list(&[Slip]),
    }
}

/// The part of the largest force or acceleration by which values may break the laws of a mode before they contradict it.
const VIOLATED: f64 = 1e-6;

/// The part of the largest acceleration below which a row that is left out of the solve counts as held by the others.
const HELD: f64 = 1e-8;

/// Selects the mode that goes on from a time and state. Terms that are small beside what they are made of count as zero. If no mode fits then,
/// or one that the values themselves contradict, as where rows nearly depend on each other, roundings alone count as zero.
pub(super) fn select<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: H,
    switches: [f64; S],
    (t, state): (f64, &[f64; N]),
    known: &[Known; C],
) -> Result<InMode<H, N, W, C, S>, Unselected<C>>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    let within = |part| select_within(system.clone(), switches, (t, state), known, part);
    let violation = |mode: &InMode<H, N, W, C, S>| mode.violation(t, state, known);
    let first = within(VANISHING);
    let contradicted = match &first {
        Ok(mode) => violation(mode),
        Err(Unselected::Inconsistent) => f64::INFINITY,
        Err(_) => 0.0,
    };
    if contradicted <= VIOLATED {
        return first;
    }
    match within(VANISHING_ROUNDING) {
        Ok(mode) if violation(&mode) < contradicted => Ok(mode),
        _ => first,
    }
}

/// Selects a mode where terms vanish within a part of what they are made of.
fn select_within<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: H,
    switches: [f64; S],
    (t, state): (f64, &[f64; N]),
    known: &[Known; C],
    part: f64,
) -> Result<InMode<H, N, W, C, S>, Unselected<C>>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    let rates = system.row_rates(t, state);
    let lists: [([ElementState; 4], usize); C] = filled(|c| {
        let element = &H::ELEMENTS[c];
        let slip = element.tangential.first().map_or(0.0, |&row| rates[row]);
        candidates(element.kind, element.tangential.len(), &known[c], slip)
    });
    let count = lists.iter().fold(1_usize, |product, (_, length)| product.saturating_mul(*length));
    if count > MAX_CANDIDATES {
        return Err(Unselected::TooMany);
    }
    let mut found: Option<InMode<H, N, W, C, S>> = None;
    for index in 0..count {
        let mut rest = index;
        let mode = Mode(lists.map(|(states, length)| {
            let state = states[rest % length];
            rest /= length;
            state
        }));
        let mut in_mode = InMode::with_switches(system.clone(), mode, switches, t, state);
        if !in_mode.lean(t, state, known) || !in_mode.is_consistent(t, state, known, part) {
            continue;
        }
        let Some(before) = found else {
            found = Some(in_mode);
            continue;
        };
        // What jets could not tell from zero, because rows nearly depend on each other, the values themselves may.
        let [first, second] = [&before, &in_mode].map(|mode| mode.violation(t, state, known) > VIOLATED);
        let is_first = if first == second { preferred(known, &before, &in_mode) } else { Some(second) };
        found = match is_first {
            Some(true) => Some(before),
            Some(false) => Some(in_mode),
            None => return Err(Unselected::Ambiguous([before.mode, mode])),
        };
    }
    found.ok_or(Unselected::Inconsistent)
}

/// Prefers, of two consistent modes, the one in which elements go on sticking, where that is the only difference: so with more friction
/// at rest than in motion; but for those that have just left their cones. Whether it is the first; none where they differ otherwise.
fn preferred<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    known: &[Known; C],
    first: &InMode<H, N, W, C, S>,
    second: &InMode<H, N, W, C, S>,
) -> Option<bool> {
    let mut answer = None;
    for ((a, b), known) in first.mode.0.iter().zip(&second.mode.0).zip(known) {
        // A contact whose margin has just fallen through zero slips. Its derivatives do not show that where another slip is slow: the
        // direction of that one turns quickly, and their errors are larger than they are.
        let holds = !known.cone_fired.contains(&true);
        let sticks = match (a, b) {
            _ if a == b => continue,
            (ElementState::Stick, b) if b.slips() && known.slip == Rate::Still => holds,
            (a, ElementState::Stick) if a.slips() && known.slip == Rate::Still => !holds,
            _ => return None,
        };
        if answer.is_some_and(|answer| answer != sticks) {
            return None;
        }
        answer = Some(sticks);
    }
    answer
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// The amount by which forces of contacts pull, or leave their cones, relative to the largest force, or by which contacts that open, or begin to
    /// slip, accelerate the other way, relative to the largest acceleration; zero where forces are not determined.
    fn violation(&self, t: f64, state: &[f64; N], known: &[Known; C]) -> f64 {
        if self.is_redundant() {
            return 0.0;
        }
        let motion = self.reactions(t, state);
        let accelerations = motion.row_accelerations();
        let most =
            |values: &[f64; W]| values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
        let (largest, fastest) = (most(&motion.reactions), most(&motion.free.biases));
        let mut worst: f64 = 0.0;
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            let still = known[c].touches && known[c].normal == Rate::Still;
            if let (ElementState::Open, Some(row)) = (self.mode.0[c], element.normal.filter(|_| still)) {
                worst = worst.max(-accelerations[row] / fastest);
            }
            if self.mode.0[c].slips() && known[c].slip == Rate::Still {
                let along = |&row: &usize| motion.directions[row] * accelerations[row];
                worst = worst.max(-element.tangential.iter().map(along).sum::<f64>() / fastest);
            }
            if self.mode.0[c].is_closed()
                && let Some(row) = element.normal.filter(|_| element.kind != Kind::Latch)
            {
                worst = worst.max(-motion.reactions[row] / largest);
            }
            if self.mode.0[c] == ElementState::Stick {
                // Of two components the margin is a difference of squares.
                let size = if element.tangential.len() == 2 { largest * largest } else { largest };
                for margin in self.rows().margins(c, &motion).into_iter().flatten() {
                    worst = worst.max(-margin / size);
                }
            }
        }
        worst
    }

    /// The series of the state in this mode, to an order.
    fn jets(&self, t: f64, state: &[f64; N], order: usize) -> [Jet; N] {
        let (time, unit) = (RunningError::once(t), RunningError::exact(1.0));
        motion_series((time, &state.map(RunningError::once)), unit, order, |t, state| self.rates(t, state))
    }

    /// The sign of a signal right after this time, as the motion goes on in this mode.
    pub(super) fn sign_of_signal(&self, s: usize, t: f64, state: &[f64; N]) -> Sign {
        let series = self.jets(t, state, HIGHEST);
        let time = Jet::line(RunningError::once(t), RunningError::exact(1.0));
        let function = self.system.signals(time, &series)[s];
        let is_number = |k: usize| function.coefficient(k).value.is_finite();
        let known = (1..=HIGHEST).take_while(|k| is_number(*k)).count();
        sign(&function, 1, known, VANISHING)
    }

    /// Whether every inequality of the mode holds in it right after this time.
    fn is_consistent(&self, t: f64, state: &[f64; N], known: &[Known; C], part: f64) -> bool {
        for order in 1..=HIGHEST {
            match self.verdict(t, state, known, order, part) {
                Verdict::Open if order < HIGHEST => {}
                // What vanishes identically: margins hold, gaps and slips that never open do not.
                Verdict::Open | Verdict::Inconsistent => return false,
                Verdict::Consistent => return true,
            }
        }
        false
    }

    fn verdict(&self, t: f64, state: &[f64; N], known: &[Known; C], order: usize, part: f64) -> Verdict {
        let series = self.jets(t, state, order);
        let time = Jet::line(RunningError::once(t), RunningError::exact(1.0));
        let motion = self.reactions(time, &series);
        // Where friction may take more of a load than there is, no load is the one.
        let is_loaded = |c: usize| H::ELEMENTS[c].loaded_by_constraint && self.mode.0[c].slips();
        if (0..C).any(is_loaded) && !(motion.regularity.coefficient(0).value > 0.0) {
            return Verdict::Inconsistent;
        }
        let mut verdict = Verdict::Consistent;
        // A function that must hold: `strict` where one that vanishes identically does not.
        let mut demand = |jet: &Jet, from: usize, strict: bool| match sign(jet, from, order, part) {
            Sign::Positive => {}
            Sign::Negative => verdict = Verdict::Inconsistent,
            Sign::Unknown if (order < HIGHEST || strict) && verdict == Verdict::Consistent => {
                verdict = Verdict::Open;
            }
            Sign::Unknown => {}
        };
        let redundant = self.is_redundant();
        if redundant {
            // Rows that are left out have to be held by the others: at a dead centre they are not, though they depend on them there.
            let accelerations = motion.row_accelerations();
            let sizes = motion.free.biases.iter().map(|bias| bias.coefficient(0).value.abs());
            let fastest = sizes.fold(f64::MIN_POSITIVE, f64::max);
            let held = |row: &usize| {
                let acceleration = accelerations[*row].coefficient(0);
                let is_small = acceleration.value.abs() <= HELD * fastest;
                vanishes(acceleration) && (is_small || is_rounding(acceleration))
            };
            if !self.pivots.dependent().iter().all(held) {
                return Verdict::Inconsistent;
            }
            self.rows().visit_shared(&motion, &mut |function| demand(&function, 0, false));
        }
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            let (state, known) = (self.mode.0[c], &known[c]);
            if state == ElementState::Open {
                if known.touches && known.normal == Rate::Still {
                    let gap = &motion.free.gaps[c];
                    let is_zero = |k: usize| gap.coefficient(k) == RunningError::exact(0.0);
                    match element.normal {
                        // A scene lacks a gap that none of its modes opens.
                        Some(row) if (0..=order).all(is_zero) => {
                            demand(&motion.row_accelerations()[row], 0, true);
                        }
                        _ => demand(gap, 2, true),
                    }
                }
                continue;
            }
            if element.kind == Kind::Latch {
                continue;
            }
            if let Some(row) = element.normal.filter(|_| !redundant) {
                demand(&motion.reactions[row], usize::from(known.normal_reaction_fired), false);
            }
            if state.slips() && known.slip == Rate::Still {
                let slip = element.tangential.iter().fold(Jet::default(), |sum, &row| {
                    sum + motion.directions[row] * motion.free.row_rates[row]
                });
                demand(&slip, 1, true);
            }
            if state == ElementState::Stick && !redundant {
                for (margin, fired) in self.rows().margins(c, &motion).into_iter().zip(known.cone_fired) {
                    if let Some(margin) = margin {
                        demand(&margin, usize::from(fired), false);
                    }
                }
            }
        }
        verdict
    }

    /// Finds the directions in which spatial slips leave rest: against the reaction that held them, and where the slip then has an
    /// acceleration, along it. False where there is none.
    fn lean(&mut self, t: f64, state: &[f64; N], known: &[Known; C]) -> bool
    where
        H: Clone,
    {
        /// Iterations for the direction, and the change that is none.
        const DIRECTION_ITERATIONS: usize = 100;
        const STEADY: f64 = 1e-14;

        for c in 0..C {
            if self.mode.0[c] != ElementState::Slip || known[c].slip != Rate::Still {
                continue;
            }
            let &[first, second] = H::ELEMENTS[c].tangential else { continue };
            let held = InMode::<H, N, W, C, S>::with_switches(
                self.system.clone(),
                self.mode.with(c, ElementState::Stick),
                self.switches,
                t,
                state,
            );
            let reactions = held.reactions(t, state).reactions;
            let Some(mut direction) = unit([-reactions[first], -reactions[second]]) else { return false };
            let mut steady = false;
            for _ in 0..DIRECTION_ITERATIONS {
                let [x, y] = self.leaves_along(c, direction, t, state);
                steady = vanishes(x) && vanishes(y);
                if steady {
                    break;
                }
                let Some(next) = unit([x.value, y.value]) else { return false };
                let change = f64::max((next[0] - direction[0]).abs(), (next[1] - direction[1]).abs());
                direction = next;
                steady = change <= STEADY;
                if steady {
                    break;
                }
            }
            if !steady {
                let Some(found) = self.direction_around(c, direction, t, state) else { return false };
                direction = found;
            }
            self.leaning[c] = Leaning { direction, speed: f64::INFINITY };
        }
        true
    }

    /// The acceleration of a spatial slip that leaves rest in a direction.
    fn leaves_along(
        &mut self,
        c: usize,
        direction: [f64; 2],
        t: f64,
        state: &[f64; N],
    ) -> [RunningError<f64>; 2] {
        let &[first, second] = H::ELEMENTS[c].tangential else { return [RunningError::exact(0.0); 2] };
        self.leaning[c] = Leaning { direction, speed: f64::INFINITY };
        self.choose_pivots(t, state);
        let motion = self.reactions(RunningError::once(t), &state.map(RunningError::once));
        let accelerations = motion.row_accelerations();
        [accelerations[first], accelerations[second]]
    }

    /// The direction nearest to another one along which a slip accelerates that leaves rest in it. Where iterations lead nowhere, because the
    /// acceleration is small beside what friction takes from it, it is looked for around the circle.
    fn direction_around(&mut self, c: usize, near: [f64; 2], t: f64, state: &[f64; N]) -> Option<[f64; 2]> {
        /// The parts of the circle, and the times that one is halved.
        const PARTS: i32 = 64;
        const ARC_HALVINGS: usize = 60;

        let turned = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            [cos * near[0] - sin * near[1], sin * near[0] + cos * near[1]]
        };
        // The components of the acceleration across the direction and along it.
        let mut parts = |angle: f64| {
            let d = turned(angle);
            let [x, y] = self.leaves_along(c, d, t, state);
            (d[0] * y.value - d[1] * x.value, d[0] * x.value + d[1] * y.value)
        };
        let angle = |k: i32| core::f64::consts::PI * f64::from(k) / f64::from(PARTS / 2);
        let mut nearest: Option<f64> = None;
        for k in -PARTS / 2..PARTS / 2 {
            let (mut low, mut high) = (angle(k), angle(k + 1));
            let (below, above) = (parts(low).0, parts(high).0);
            if !(below * above <= 0.0) {
                continue;
            }
            for _ in 0..ARC_HALVINGS {
                let middle = 0.5 * (low + high);
                if parts(middle).0 * below > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            if parts(high).1 > 0.0 && nearest.is_none_or(|angle| high.abs() < angle.abs()) {
                nearest = Some(high);
            }
        }
        nearest.map(turned)
    }
}

/// The unit vector along another one; none where that is zero.
pub(super) fn unit([x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let length = libm::hypot(x, y);
    (length > 0.0 && length.is_finite()).then(|| [x / length, y / length])
}
