//! The functions watched in a mode: inequalities that hold inside of it, each with a falling zero where the mode ends.

use crate::hybrid::filled::filled;
use crate::hybrid::interface::element::{Effect, Kind};
use crate::hybrid::interface::mode::ElementState;
use crate::hybrid::interface::reactions::Reactions;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::hybrid::mode_dynamics::mode_rows::ModeRows;
use crate::numbers::dual::Dual;
use crate::numbers::lift::Lift;

/// Functions watched for each element.
pub(super) const SLOTS: usize = 5;

/// A function among those watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::hybrid) enum Function {
    /// The gap of an open contact, the distance of a free latch, what keeps a locked latch from being released.
    Gap(usize),
    /// The normal reaction of a closed contact.
    Normal(usize),
    /// A margin of the friction cone of what sticks: on the side of a positive reaction for `true`.
    Cone(usize, bool),
    /// The slip of what slips, in its direction.
    Slip(usize),
    /// A signal.
    Signal(usize),
    /// The determinant of the equations of the reactions.
    Regularity,
    /// The least of the functions that are nonnegative if some reactions lie in all cones, where reactions are not determined.
    Shared,
}

/// The values of all functions watched in a mode; none where a function is not watched.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Watched<R, const C: usize, const S: usize> {
    elements: [[Option<R>; SLOTS]; C],
    signals: [Option<R>; S],
    regularity: Option<R>,
    shared: Option<R>,
}

impl<R: Copy, const C: usize, const S: usize> Watched<R, C, S> {
    /// The value of a function.
    pub(in crate::hybrid) fn get(&self, function: Function) -> Option<R> {
        let slot = |c: usize, k: usize| self.elements.get(c).and_then(|slots| slots[k]);
        match function {
            Function::Gap(c) => slot(c, 0),
            Function::Normal(c) => slot(c, 1),
            Function::Cone(c, positive) => slot(c, if positive { 2 } else { 3 }),
            Function::Slip(c) => slot(c, 4),
            Function::Signal(s) => self.signals.get(s).copied().flatten(),
            Function::Regularity => self.regularity,
            Function::Shared => self.shared,
        }
    }
}

impl Function {
    /// All functions that a system of so many elements and signals can watch.
    pub(in crate::hybrid) fn all(elements: usize, signals: usize) -> impl Iterator<Item = Self> + Clone {
        let of_element =
            |c| [Self::Gap(c), Self::Normal(c), Self::Cone(c, true), Self::Cone(c, false), Self::Slip(c)];
        (0..elements)
            .flat_map(of_element)
            .chain((0..signals).map(Self::Signal))
            .chain([Self::Regularity, Self::Shared])
    }

    /// Whether the value depends on the reactions.
    pub(in crate::hybrid) fn is_of_reactions(self) -> bool {
        matches!(self, Self::Normal(_) | Self::Cone(..) | Self::Regularity | Self::Shared)
    }

    /// The name in the declaration of what the function belongs to.
    pub(in crate::hybrid) fn name<H, const N: usize, const W: usize, const C: usize, const S: usize>(
        self,
    ) -> &'static str
    where
        H: HybridSystem<N, W, C, S>,
    {
        match self {
            Self::Signal(s) => H::SIGNALS[s].name,
            other => other.element().map_or("", |c| H::ELEMENTS[c].name),
        }
    }

    /// The element that the function belongs to.
    pub(in crate::hybrid) fn element(self) -> Option<usize> {
        match self {
            Self::Gap(c) | Self::Normal(c) | Self::Cone(c, _) | Self::Slip(c) => Some(c),
            Self::Signal(_) | Self::Regularity | Self::Shared => None,
        }
    }
}

/// The facts of a run that watched functions depend on, beside mode, time and state.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Sides<const C: usize, const S: usize> {
    /// The sides on which latches were when they became free, and signals when the mode began: zero for a branch that stays where it
    /// vanishes, and for a reset whose function has not been on the side from which it goes through zero.
    pub(in crate::hybrid) latches: [f64; C],
    pub(in crate::hybrid) signals: [f64; S],
    /// The speeds of spatial slip below which it is taken to its end in one step.
    pub(in crate::hybrid) slow: [f64; C],
}

impl<H, const N: usize, const W: usize, const C: usize, const S: usize> InMode<H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// The functions watched in this mode.
    pub(in crate::hybrid) fn watched<R: Lift<f64>>(
        &self,
        sides: &Sides<C, S>,
        t: R,
        state: &[R; N],
    ) -> Watched<R, C, S> {
        self.watched_with(sides, t, state, &self.reactions(t, state))
    }

    /// The functions watched in this mode with the rates of their changes along it.
    pub(in crate::hybrid) fn watched_along(
        &self,
        sides: &Sides<C, S>,
        t: f64,
        state: &[f64; N],
    ) -> Watched<Dual<f64, 1>, C, S> {
        let rates = self.rates(t, state);
        let time = Dual { value: t, tangent: [1.0] };
        let state = filled(|i| Dual { value: state[i], tangent: [rates[i]] });
        self.watched(sides, time, &state)
    }

    fn watched_with<R: Lift<f64>>(
        &self,
        sides: &Sides<C, S>,
        t: R,
        state: &[R; N],
        motion: &Reactions<R, N, W, C>,
    ) -> Watched<R, C, S> {
        let mut elements = [[None; SLOTS]; C];
        let (mut slips, mut locked) = (false, false);
        for (c, slots) in elements.iter_mut().enumerate() {
            *slots = self.rows().of_element(sides, c, motion);
            slips |= self.mode.0[c].slips() && H::ELEMENTS[c].is_loaded();
            locked |= self.mode.0[c] == ElementState::Locked;
        }
        if locked {
            let conditions = self.system.conditions(t, state, &self.switches.map(R::lift));
            for (c, slots) in elements.iter_mut().enumerate() {
                if self.mode.0[c] == ElementState::Locked {
                    slots[0] = Some(-conditions.release[c]);
                }
            }
        }
        let values = self.system.signals(t, state);
        let signals = filled(|s| match H::SIGNALS[s].effect {
            Effect::Switch | Effect::Branch => {
                (sides.signals[s] != 0.0).then(|| values[s] * R::lift(sides.signals[s]))
            }
            Effect::ResetWhenRising => Some(-values[s]),
            Effect::ResetWhenFalling => Some(values[s]),
        });
        let regularity = (slips && !H::PAINLEVE_FREE).then_some(motion.regularity);
        let mut shared: Option<R> = None;
        if self.is_redundant() {
            self.rows().visit_shared(motion, &mut |value| {
                if shared.is_none_or(|least| value.to_f64() < least.to_f64()) {
                    shared = Some(value);
                }
            });
        }
        Watched { elements, signals, regularity, shared }
    }
}

impl<const W: usize, const C: usize> ModeRows<'_, W, C> {
    /// The functions watched for an element.
    fn of_element<R: Lift<f64>, const N: usize, const S: usize>(
        &self,
        sides: &Sides<C, S>,
        c: usize,
        motion: &Reactions<R, N, W, C>,
    ) -> [Option<R>; SLOTS] {
        let (element, state) = (&self.elements[c], self.mode.0[c]);
        let Reactions { free, reactions, directions, .. } = motion;
        let normal = match element.normal {
            Some(row) if element.kind != Kind::Latch && !self.pivots.is_redundant() => Some(reactions[row]),
            _ => None,
        };
        let mut slip = R::zero();
        for &row in element.tangential {
            slip = directions[row].times_plus(free.row_rates[row], slip);
        }
        match state {
            ElementState::Open => [Some(free.gaps[c]), None, None, None, None],
            ElementState::Free => [Some(free.gaps[c] * R::lift(sides.latches[c])), None, None, None, None],
            // Its condition is filled in by the caller.
            ElementState::Locked => [None; SLOTS],
            ElementState::Closed => [None, normal, None, None, None],
            ElementState::SlipForward | ElementState::SlipBackward => [None, normal, None, None, Some(slip)],
            // A slip that has hardly begun is not looked at: its direction is still the one in which it begins.
            ElementState::Slip => {
                let slow = sides.slow[c];
                let above = if slow > 0.0 { Some(slip - R::lift(slow)) } else { None };
                [None, normal, None, None, above]
            }
            ElementState::Stick => {
                let [plus, minus] =
                    if self.pivots.is_redundant() { [None; 2] } else { self.margins(c, motion) };
                [None, normal, plus, minus, None]
            }
        }
    }

    /// The margins of the cone of an element that sticks: of one component on both sides, of two the difference of squares.
    pub(in crate::hybrid) fn margins<R: Lift<f64>, const N: usize>(
        &self,
        c: usize,
        motion: &Reactions<R, N, W, C>,
    ) -> [Option<R>; 2] {
        let Reactions { free, reactions, .. } = motion;
        let load = match self.elements[c].load {
            Some(row) => reactions[row],
            None => motion.loads[c],
        };
        let limit = free.stiction[c].times_plus(load, free.limits[c]);
        match self.elements[c].tangential {
            &[row] => [Some(limit - reactions[row]), Some(limit + reactions[row])],
            rows => {
                let mut square = R::zero();
                for &row in rows {
                    square += reactions[row] * reactions[row];
                }
                [Some(limit * limit - square), None]
            }
        }
    }
}
