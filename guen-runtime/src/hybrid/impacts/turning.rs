//! Directions of spatial slip in an impact: how the slip across them changes as they turn, and several of them at once by Newton's method.

use super::phase::{Phase, Solved, Tangential, solve_some};
use crate::hybrid::filled::filled;
use crate::numbers::dual::Dual;

/// A number with its derivative along one direction.
pub(in crate::hybrid) type Along = Dual<f64, 1>;

/// The parts of a turn from which directions are looked for, by the number of slips that turn: a hundred starts or two.
const STARTS: [usize; 5] = [1, 24, 8, 5, 4];
/// The slip across its direction, relative to the rates before, that is none.
const ACROSS: f64 = 1e-13;

/// A direction that turns with this derivative of its angle.
fn turn(state: Tangential<Along>, angle: f64) -> Tangential<Along> {
    let Tangential::Slip([x, y]) = state else { return state };
    let slope = |value: Along, slope: f64| Dual { value: value.value, tangent: [slope] };
    Tangential::Slip([slope(x, -y.value * angle), slope(y, x.value * angle)])
}

impl<const W: usize, const C: usize> Phase<'_, Along, W, C> {
    /// The slips across the directions of those that turn; zero elsewhere.
    fn across(
        &self,
        turns: &[bool; C],
        tangential: &[Tangential<Along>; C],
        solved: &Solved<Along, W, C>,
    ) -> [Along; C] {
        filled(|c| match (tangential[c], self.elements[c].tangential) {
            (Tangential::Slip([x, y]), &[first, second]) if turns[c] => {
                x * solved.after[second] - y * solved.after[first]
            }
            _ => Dual::constant(0.0),
        })
    }

    /// The changes of the angles of slips that make the slips across their directions vanish: those `of` values, to first order. The directions
    /// themselves have no derivatives yet.
    fn angles(
        &self,
        turns: &[bool; C],
        closed: &[bool; C],
        tangential: &[Tangential<Along>; C],
        of: impl Fn(Along) -> f64,
    ) -> Option<[f64; C]> {
        let still = self.across(turns, tangential, &self.with_states(closed, tangential)?);
        let mut by_angles = [[0.0; C]; C];
        for c in (0..C).filter(|c| turns[*c]) {
            let mut turned = *tangential;
            turned[c] = turn(tangential[c], 1.0);
            let moved = self.across(turns, &turned, &self.with_states(closed, &turned)?);
            for (row, (moved, still)) in by_angles.iter_mut().zip(moved.iter().zip(&still)) {
                row[c] = moved.tangent[0] - still.tangent[0];
            }
        }
        solve_some(&by_angles, &still.map(|value| -of(value)), turns)
    }

    /// The solution of a phase in which elements keep their states, with its derivative: directions of spatial slip turn with the slip.
    pub(in crate::hybrid) fn with_derivative(
        &self,
        solved: &Solved<f64, W, C>,
    ) -> Option<Solved<Along, W, C>> {
        let mut tangential = solved.tangential.map(constant);
        let turns: [bool; C] = filled(|c| {
            matches!(tangential[c], Tangential::Slip(_)) && self.elements[c].tangential.len() == 2
        });
        if turns.contains(&true) {
            let angles = self.angles(&turns, &solved.closed, &tangential, |value| value.tangent[0])?;
            tangential = filled(|c| if turns[c] { turn(tangential[c], angles[c]) } else { tangential[c] });
        }
        self.with_states(&solved.closed, &tangential)
    }
}

/// A state whose direction does not change.
fn constant(state: Tangential) -> Tangential<Along> {
    match state {
        Tangential::None => Tangential::None,
        Tangential::Stick => Tangential::Stick,
        Tangential::Slip(direction) => Tangential::Slip(direction.map(Dual::constant)),
    }
}

impl<const W: usize, const C: usize> Phase<'_, f64, W, C> {
    /// Directions of several spatial slips in which the slips after the phase are along them: by Newton's method from directions all around.
    pub(super) fn turned_together(
        &self,
        turns: &[bool; C],
        closed: &[bool; C],
        tangential: &[Tangential; C],
        judge: &mut dyn FnMut(&Solved<f64, W, C>),
    ) {
        /// Steps of Newton's method from one start, and the largest change of an angle in one of them.
        const NEWTON_STEPS: usize = 20;
        const LARGEST: f64 = 0.5;

        let slips = turns.iter().filter(|turns| **turns).count();
        let Some(&parts) = STARTS.get(slips) else { return };
        let delassus = self.delassus.map(|row| row.map(Dual::constant));
        let loads = self.loads.map(|row| row.map(Dual::constant));
        let phase = Phase {
            elements: self.elements,
            delassus: &delassus,
            before: self.before.map(Dual::constant),
            scale: self.scale,
            participants: self.participants.map(|participant| participant.map(Dual::constant)),
            friction: self.friction.map(Dual::constant),
            loads: &loads,
        };
        let part = core::f64::consts::TAU / parts as f64;
        let starts = (0..slips).fold(1_usize, |product, _| product * parts);
        for start in 0..starts {
            let mut rest = start;
            let mut angles: [f64; C] = filled(|c| {
                if !turns[c] {
                    return 0.0;
                }
                let angle = part * (rest % parts) as f64;
                rest /= parts;
                angle
            });
            for _ in 0..NEWTON_STEPS {
                let directed: [Tangential; C] = filled(|c| match turns[c] {
                    true => Tangential::Slip([libm::cos(angles[c]), libm::sin(angles[c])]),
                    false => tangential[c],
                });
                let lifted = directed.map(constant);
                let Some(solved) = self.with_states(closed, &directed) else { break };
                let aside = |c: usize| match (directed[c], self.elements[c].tangential) {
                    (Tangential::Slip([x, y]), &[first, second]) if turns[c] => {
                        (x * solved.after[second] - y * solved.after[first]).abs()
                    }
                    _ => 0.0,
                };
                if (0..C).all(|c| aside(c) <= ACROSS * self.scale) {
                    judge(&solved);
                    break;
                }
                let Some(changes) = phase.angles(turns, closed, &lifted, |value| value.value) else { break };
                angles = filled(|c| angles[c] + changes[c].clamp(-LARGEST, LARGEST));
            }
        }
    }
}
