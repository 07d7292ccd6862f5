//! A transition: from what fired in one mode to the next mode, with the impact in between.

use super::hybrid_state::{Fired, HybridState};
use super::resting::Resting;
use super::select::{Known, Rate, select};
use crate::hybrid::events::located::side;
use crate::hybrid::events::watched::Function;
use crate::hybrid::filled::filled;
use crate::hybrid::impacts::impact::{Impact, STILL};
use crate::hybrid::impacts::phase::Unsolved;
use crate::hybrid::interface::element::{Kind, Signal};
use crate::hybrid::interface::error::HybridCause;
use crate::hybrid::interface::loads::Loads;
use crate::hybrid::interface::mode::{ElementState, Mode};
use crate::hybrid::interface::system::{FreeMotion, HybridSystem};
use crate::hybrid::interface::transition::{Facts, Transition, TransitionKind};
use crate::hybrid::mode_dynamics::in_mode::{InMode, moved};
use crate::hybrid::mode_dynamics::mode_rows::Leaning;
use crate::hybrid::mode_dynamics::pivots::Pivots;

/// The next place, and the transition that led to it.
pub(super) type Turned<H, const N: usize, const W: usize, const C: usize, const S: usize> =
    (HybridState<H, N, W, C, S>, Transition<Mode<C>, N, W, C>);

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> HybridState<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// The place after what has fired, and the transition; `inputs` where these have changed here.
    pub(in crate::hybrid) fn turn(
        &self,
        fired: &Fired<C, S>,
        inputs: bool,
        resting: &mut Resting<C>,
    ) -> Result<Turned<H, N, W, C, S>, HybridCause<C>> {
        if fired.regularity {
            return Err(self.painleve());
        }
        let (t, system) = (self.t, &self.in_mode.system);
        let mut next = self.clone();
        next.in_mode.leaning = [Leaning::default(); C];

        let fired = &self.with_gaps_that_follow(fired);

        // Zeros are made zero: gaps first, then the rates of what is closed, of what sticks and of slips that ended.
        let zero_rows = |positions: bool| {
            H::ELEMENTS.iter().enumerate().flat_map(move |(c, element)| {
                let state = self.in_mode.mode.0[c];
                let normal = element.normal.filter(|_| state.is_closed() || positions && fired.gap[c]);
                // Whether a grip slips is not known yet where the run begins.
                let sticks = state == ElementState::Stick && !self.begins;
                let still = !positions && (sticks || fired.slip[c]);
                normal.into_iter().chain(if still { element.tangential } else { &[] }.iter().copied())
            })
        };
        next.state = next.in_mode.touching(t, &next.state, &next.independent(zero_rows(true)));
        next.state = next.in_mode.at_rest(t, &next.state, &next.independent(zero_rows(false)));
        let state_before = next.state;

        let was_reset = next.reset(fired)?;
        let crosses = |(s, signal): &(usize, &Signal)| fired.signals[*s] && signal.is_switch();
        for (s, _) in H::SIGNALS.iter().enumerate().filter(crosses) {
            next.in_mode.switches[s] = 1.0 - next.in_mode.switches[s];
            next.sides.signals[s] = -next.sides.signals[s];
        }

        let touches = next.touching(fired, was_reset)?;
        let mut known = next.known(fired, &touches, was_reset);
        let mut locks = [false; C];
        for c in 0..C {
            if H::ELEMENTS[c].kind == Kind::Latch && fired.gap[c] {
                let locked = self.in_mode.mode.0[c] == ElementState::Locked;
                known[c].latch = if locked { ElementState::Free } else { ElementState::Locked };
                locks[c] = !locked;
            }
        }
        if self.begins {
            next.lock_at_start(&mut known);
        }
        // A latch that the same reset frees takes no impulse.
        if was_reset {
            next.free_latches(self, &mut known);
        }
        let Strike { impulses, energy, rests, takes_part } =
            next.strike(&touches, &locks, &mut known, resting)?;
        let struck = impulses.iter().any(|impulse| *impulse != 0.0);

        // Where nothing has fired the run begins.
        if was_reset || struck || inputs || !fired.any() {
            next.set_switches(&fired.signals);
        }
        next.free_latches(self, &mut known);
        next.in_mode = next.selected(&known)?;
        if next.leave_zeros() {
            next.in_mode = next.selected(&known)?;
        }
        let (before, after) = (self.in_mode.mode, next.in_mode.mode);
        if next.in_mode.is_undetermined(t, &next.state) {
            return Err(HybridCause::Undetermined { mode: after });
        }
        if !system.allows(&after) {
            return Err(HybridCause::Excluded { mode: after });
        }
        next.begins = false;
        next.begin_mode(self, &locks, was_reset);
        // A run that begins on a zero has it behind it.
        let ready = if self.begins { [0.0; S] } else { self.sides.signals };
        next.arm_resets_anew(&ready, fired, &state_before);
        next.wait_at_zeros(fired, &state_before);

        let mut elements = fired.elements();
        for (c, takes_part) in elements.iter_mut().enumerate() {
            *takes_part |= before.0[c] == ElementState::Locked && after.0[c] == ElementState::Free;
            let row = |&row: &usize| impulses[row] != 0.0;
            *takes_part |= H::ELEMENTS[c].normal.iter().chain(H::ELEMENTS[c].tangential).any(row);
        }
        let kind = match rests {
            Some(rest) => rest,
            None if was_reset => TransitionKind::Reset,
            None if struck => match locks.iter().any(|locks| *locks) {
                true => TransitionKind::Locked,
                false => TransitionKind::Impact,
            },
            None => kind_of(fired, &before, &after),
        };
        let signal = fired.signals.iter().position(|fired| *fired);
        let transition = Transition {
            t,
            kind,
            elements,
            signal,
            before,
            after,
            state_before,
            state_after: next.state,
            impulses,
            energy,
            facts: Facts {
                gap: fired.gap,
                normal: fired.normal,
                cone: fired.cone,
                slip: fired.slip,
                shared: fired.shared,
                signals: fired.signals.iter().filter(|fired| **fired).count(),
                takes_part,
                begins: self.begins,
                inputs: false,
            },
        };
        Ok((next, transition))
    }

    /// The functions that fired, with the gaps of open contacts that fall below zero where those that fired are put to zero: of contacts
    /// that take turns the last flights are as low as the gaps' own rounding. So do gaps that are below zero by little more than that, and
    /// fall: their zeros were too near to that of another gap to be told from it.
    fn with_gaps_that_follow(&self, fired: &Fired<C, S>) -> Fired<C, S> {
        /// Resolutions of a gap within which it is below zero by an error of the motion and not because its contact was not to close.
        const SHALLOW: f64 = 1e3;

        let mut fired = *fired;
        let sinks = |c: usize| {
            let rates = self.in_mode.system.row_rates(self.t, &self.state);
            let falls = H::ELEMENTS[c].normal.is_some_and(|row| rates[row] < 0.0);
            falls && -self.free().gaps[c] <= SHALLOW * self.resolution()[c]
        };
        for _ in 0..C {
            let rows = H::ELEMENTS.iter().enumerate().filter_map(|(c, element)| {
                element.normal.filter(|_| self.in_mode.mode.0[c].is_closed() || fired.gap[c])
            });
            let state = self.in_mode.touching(self.t, &self.state, &self.independent(rows));
            let side = |c: usize, state: &[f64; N]| {
                side(&self.in_mode, &self.sides, Function::Gap(c), self.t, state)
            };
            let when = self.in_mode.system.conditions(self.t, &state, &self.in_mode.switches).when;
            let follows = |c: usize| {
                let was = side(c, &self.state);
                self.in_mode.mode.0[c] == ElementState::Open
                    && when[c] > 0.0
                    && (was >= 0 && side(c, &state) < 0 || was < 0 && sinks(c))
            };
            let more: [bool; C] = filled(|c| !fired.gap[c] && follows(c));
            if !more.contains(&true) {
                break;
            }
            fired.gap = filled(|c| fired.gap[c] || more[c]);
        }
        fired
    }

    /// The mode that goes on from here.
    fn selected(&self, known: &[Known; C]) -> Result<InMode<H, N, W, C, S>, HybridCause<C>> {
        let selected =
            select(self.in_mode.system.clone(), self.in_mode.switches, (self.t, &self.state), known);
        selected.map_err(HybridCause::from)
    }

    /// The rows of these that do not depend on each other.
    fn independent(&self, rows: impl Iterator<Item = usize>) -> Pivots<W> {
        let delassus = self.free().delassus;
        Pivots::in_order(rows).chosen(delassus, &filled(|w| delassus[w][w]))
    }

    /// The free motion here, with friction at the present slips.
    pub(super) fn free(&self) -> FreeMotion<f64, N, W, C> {
        let system = &self.in_mode.system;
        let rates = system.row_rates(self.t, &self.state);
        let speeds = filled(|c| {
            let square: f64 = H::ELEMENTS[c].tangential.iter().map(|&row| rates[row] * rates[row]).sum();
            libm::sqrt(square)
        });
        system.free_motion(self.t, &self.state, &self.in_mode.switches, &speeds)
    }

    /// Changes the velocities by an impact, if some contact that touches closes, a latch locks, or one that is locked is to move by a reset.
    fn strike(
        &mut self,
        touches: &[bool; C],
        locks: &[bool; C],
        known: &mut [Known; C],
        resting: &mut Resting<C>,
    ) -> Result<Strike<W, C>, HybridCause<C>> {
        let free = self.free();
        let before = free.row_rates;
        let meets = |c: usize| {
            let rate = H::ELEMENTS[c].normal.map_or(0.0, |row| before[row]);
            touches[c] && H::ELEMENTS[c].kind != Kind::Latch && known[c].normal == Rate::Moving && rate < 0.0
        };
        let holds = |c: usize| known[c].latch == ElementState::Locked && known[c].normal == Rate::Moving;
        if !(0..C).any(|c| meets(c) || locks[c] || holds(c)) {
            return Ok(Strike { impulses: [0.0; W], energy: 0.0, rests: None, takes_part: None });
        }
        let takes_part: [bool; C] = filled(|c| {
            touches[c]
                || locks[c]
                || known[c].latch == ElementState::Locked
                || H::ELEMENTS[c].kind == Kind::Grip
        });
        let loads = match H::ELEMENTS.iter().any(|element| element.loaded_by_constraint) {
            true => self.in_mode.system.loads(self.t, &self.state, &self.in_mode.switches),
            false => Loads::none(),
        };
        let impact = Impact {
            elements: &H::ELEMENTS,
            delassus: &free.delassus,
            before,
            takes_part,
            friction: free.friction,
            loads: &loads.responses,
            restitutions: self.in_mode.system.restitutions(),
        };
        let mut struck = impact.solve().map_err(|why| match why {
            Unsolved::None => HybridCause::NoImpact,
            Unsolved::Several => HybridCause::SeveralImpacts,
            Unsolved::EnergyGain(gain) => HybridCause::EnergyGain { gain },
        })?;
        // What was on its way up and got no impulse has no part in a sequence that is closed.
        let rises = |row: usize| before[row] > 0.0 && struck.impulses[row] == 0.0 && struck.after[row] > 0.0;
        let leaves = |c: usize| known[c].normal == Rate::Moving && H::ELEMENTS[c].normal.is_some_and(rises);
        let pressed = Impact { takes_part: filled(|c| takes_part[c] && !leaves(c)), ..impact };
        let rests = self.rests(&pressed, &mut struck, resting, filled(meets), known)?;
        let scale = before.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        for c in 0..C {
            let element = &H::ELEMENTS[c];
            let vanish = |rows: &[usize]| rows.iter().all(|&row| struck.after[row].abs() <= STILL * scale);
            if takes_part[c] && element.normal.is_some() {
                let still = struck.closed[c] || element.normal.is_some_and(|row| vanish(&[row]));
                known[c].normal = if still { Rate::Still } else { Rate::Moving };
            }
            let still = struck.sticks[c] || vanish(element.tangential);
            known[c].slip = if still { Rate::Still } else { Rate::Moving };
            // What fired did so in the motion before.
            known[c].normal_reaction_fired = false;
            known[c].cone_fired = [false; 2];
        }
        self.state = moved(&self.state, &struck.impulses, &free.responses);
        let drifts = self.in_mode.system.row_drifts(self.t, &self.state);
        let by_drift: f64 = struck.impulses.iter().zip(&drifts).map(|(l, w)| l * w).sum();
        let (impulses, energy) = (struck.impulses, struck.energy - by_drift);
        let takes_part = if rests.is_some() { pressed.takes_part } else { takes_part };
        Ok(Strike { impulses, energy, rests, takes_part: Some(takes_part) })
    }

    /// Sets what begins with a mode: sides of latches that became free, directions of slip, speeds that count as slow.
    fn begin_mode(&mut self, before: &Self, locks: &[bool; C], was_reset: bool) {
        let switches = self.in_mode.switches;
        let motion = self.in_mode.reactions(self.t, &self.state);
        let accelerations = motion.row_accelerations();
        for c in 0..C {
            let (element, state) = (&H::ELEMENTS[c], self.in_mode.mode.0[c]);
            let was = before.in_mode.mode.0[c];
            if let (Kind::Latch, ElementState::Free, Some(row)) = (element.kind, state, element.normal)
                && !locks[c]
                && (was == ElementState::Locked || before.begins || was_reset)
            {
                let gap = self.in_mode.system.free_motion(self.t, &self.state, &switches, &[0.0; C]).gaps[c];
                let rate = motion.free.row_rates[row];
                let away = if was == ElementState::Locked { 0.0 } else { gap };
                let first = [away, rate, accelerations[row]].into_iter().find(|value| value.abs() > 1e-12);
                self.sides.latches[c] = first.map_or(1.0, |value| if value > 0.0 { 1.0 } else { -1.0 });
            }
            if state != ElementState::Slip || self.in_mode.leaning[c].speed == f64::INFINITY {
                self.sides.slow[c] = 0.0;
            }
            if self.in_mode.leaning[c].speed == f64::INFINITY {
                // What friction takes from the slip in a unit of time.
                let taken = element.tangential.iter().map(|&row| {
                    let along = |&w: &usize| motion.free.delassus[row][w] * motion.reactions[w];
                    element.tangential.iter().map(along).sum::<f64>().abs()
                });
                let taken = taken.fold(0.0, f64::max);
                let size =
                    element.tangential.iter().map(|&row| accelerations[row].abs()).fold(taken, f64::max);
                self.in_mode.leaning[c].speed = LEANING * size;
            }
        }
    }

    /// The error where the reactions of a slipping contact become infinite.
    pub(in crate::hybrid) fn painleve(&self) -> HybridCause<C> {
        let motion = self.in_mode.reactions(self.t, &self.state);
        let (mut contact, mut p) = ("", f64::INFINITY);
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            if !self.in_mode.mode.0[c].slips() {
                continue;
            }
            if element.loaded_by_constraint && !(motion.regularity >= p) {
                (contact, p) = (element.name, motion.regularity);
            }
            let Some(load) = element.load else { continue };
            let along: f64 = element
                .tangential
                .iter()
                .map(|&t| motion.directions[t] * motion.free.delassus[load][t])
                .sum();
            let own = 1.0 - motion.free.friction[c] * along / motion.free.delassus[load][load];
            if own < p {
                (contact, p) = (element.name, own);
            }
        }
        HybridCause::Painleve { contact, p }
    }

    /// Whether one of the slipping contacts is next to where its reaction becomes infinite.
    pub(in crate::hybrid) fn jams(&self) -> bool {
        /// The part of `D_nn` that is left where steps become too small.
        const JAMMED_PART: f64 = 1e-2;
        matches!(self.painleve(), HybridCause::Painleve { p, .. } if p.abs() < JAMMED_PART)
    }

    /// Whether another function has reached zero together with one that was located to `bracket`.
    pub(in crate::hybrid) fn fires_too(
        &self,
        function: Function,
        value: f64,
        rate: f64,
        bracket: f64,
    ) -> bool {
        rate < 0.0
            && (value.abs() <= -rate * bracket
                || side(&self.in_mode, &self.sides, function, self.t, &self.state) == 0)
    }
}

/// The result of an impact, if there was one.
struct Strike<const W: usize, const C: usize> {
    impulses: [f64; W],
    /// The change of the kinetic energy.
    energy: f64,
    /// The kind of the transition where a sequence of impacts is closed early.
    rests: Option<TransitionKind>,
    takes_part: Option<[bool; C]>,
}

/// The speed, relative to an acceleration and a unit of time, far below which spatial slip has the direction in which it begins.
const LEANING: f64 = 1e-9;

/// The kind of a transition without jumps.
fn kind_of<const C: usize, const S: usize>(
    fired: &Fired<C, S>,
    before: &Mode<C>,
    after: &Mode<C>,
) -> TransitionKind {
    let changes = |c: usize| (before.0[c], after.0[c]);
    for c in 0..C {
        let kind = match changes(c) {
            (ElementState::Free, ElementState::Locked) => TransitionKind::Locked,
            (ElementState::Locked, ElementState::Free) => TransitionKind::Released,
            (ElementState::Open, state) if state.is_closed() => TransitionKind::Closed,
            (state, ElementState::Open) if state.is_closed() => TransitionKind::Lifted,
            _ => continue,
        };
        return kind;
    }
    for c in 0..C {
        let kind = match changes(c) {
            (ElementState::Stick, state) if state.slips() => TransitionKind::Slips,
            (state, ElementState::Stick) if state.slips() => TransitionKind::Sticks,
            (from, to) if from.slips() && to.slips() && (from != to || fired.slip[c]) => {
                TransitionKind::Reversed
            }
            _ => continue,
        };
        return kind;
    }
    if fired.signals.iter().any(|fired| *fired) { TransitionKind::Switched } else { TransitionKind::Touch }
}
