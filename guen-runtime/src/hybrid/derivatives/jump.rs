//! The jump of the state at a transition with its derivative along one direction: resets, and impacts with the states that their contacts take.

use super::saltation::NoSaltation;
use crate::hybrid::filled::filled;
use crate::hybrid::impacts::impact::Impact;
use crate::hybrid::impacts::phase::{Phase, Solved};
use crate::hybrid::impacts::turning::Along;
use crate::hybrid::interface::loads::Loads;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::{Transition, TransitionKind};
use crate::hybrid::mode_dynamics::in_mode::{InMode, moved};
use crate::numbers::dual::Dual;
use crate::numbers::real::Real;

impl<M, const N: usize, const W: usize, const C: usize> Transition<M, N, W, C> {
    /// The state after the jump.
    pub(super) fn jumped<H, const S: usize>(
        &self,
        before: &InMode<H, N, W, C, S>,
        after: &InMode<H, N, W, C, S>,
        t: Along,
        state: &[Along; N],
    ) -> Result<[Along; N], NoSaltation>
    where
        H: HybridSystem<N, W, C, S>,
    {
        let system = after.system();
        let (mut state, mut switches) = (*state, before.switches);
        if let Some(s) = self.signal {
            if H::SIGNALS[s].is_switch() {
                switches[s] = 1.0 - switches[s];
            } else {
                state = system.reset(s, t, &state, &before.switches.map(Dual::constant));
            }
        }
        let Some(takes_part) = self.facts.takes_part else { return Ok(state) };
        let rates = system.row_rates(t, &state);
        let speeds = filled(|c| {
            let square = H::ELEMENTS[c]
                .tangential
                .iter()
                .fold(Along::zero(), |sum, &row| sum + rates[row] * rates[row]);
            if square.value == 0.0 { Along::zero() } else { square.sqrt() }
        });
        let free = system.free_motion(t, &state, &switches.map(Dual::constant), &speeds);
        let restitutions = system.restitutions();
        let loads = match H::ELEMENTS.iter().any(|element| element.loaded_by_constraint) {
            true => system.loads(t, &state, &switches.map(Dual::constant)),
            false => Loads::none(),
        };
        let values = Impact {
            elements: &H::ELEMENTS,
            delassus: &free.delassus.map(|row| row.map(|entry| entry.value)),
            before: free.row_rates.map(|rate| rate.value),
            takes_part,
            friction: free.friction.map(|friction| friction.value),
            loads: &loads.responses.map(|row| row.map(|entry| entry.value)),
            restitutions,
        };
        let moving = Impact {
            elements: &H::ELEMENTS,
            delassus: &free.delassus,
            before: free.row_rates,
            takes_part,
            friction: free.friction,
            loads: &loads.responses,
            restitutions,
        };
        let closes = matches!(self.kind, TransitionKind::Rest { .. });
        let direction = state.iter().fold(t.tangent[0].abs(), |most, along| most.max(along.tangent[0].abs()));
        let impulses = impulses(&values, &moving, closes, direction)?;
        Ok(moved(&state, &impulses, &free.responses))
    }
}

/// The impulses of an impact with their derivatives along a direction whose largest component has this size.
fn impulses<const W: usize, const C: usize>(
    values: &Impact<'_, f64, W, C>,
    moving: &Impact<'_, Along, W, C>,
    closes: bool,
    direction: f64,
) -> Result<[Along; W], NoSaltation> {
    /// The part of rates before an impact by which their derivatives along a direction of size one are rounded, amply: an impact need not
    /// depend on the direction.
    const NOISE: f64 = 1e-12;

    let unsolved = |_| NoSaltation::Divided;
    if closes {
        let struck = values.solve().map_err(unsolved)?;
        let solved = values.closed_like(&struck).ok_or(NoSaltation::Divided)?;
        let closed = moving.compression().with_derivative(&solved).ok_or(NoSaltation::Divided)?;
        return Ok(closed.impulses);
    }
    let noise = values.before.iter().fold(0.0, |most: f64, rate| most.max(rate.abs())) * direction * NOISE;
    let phase = values.compression();
    let compression = phase.solve().map_err(unsolved)?;
    let compressed = undivided(&phase, &moving.compression(), &compression, noise)?;
    let phase = values.expansion(&compression);
    let expansion = phase.solve().map_err(unsolved)?;
    let expanded = undivided(&phase, &moving.expansion(&compressed), &expansion, noise)?;
    Ok(filled(|w| compressed.impulses[w] + expanded.impulses[w]))
}

/// The solution of a phase with its derivative, which is the same, but for `noise`, in all states of the elements that have this solution.
fn undivided<const W: usize, const C: usize>(
    values: &Phase<'_, f64, W, C>,
    moving: &Phase<'_, Along, W, C>,
    solved: &Solved<f64, W, C>,
    noise: f64,
) -> Result<Solved<Along, W, C>, NoSaltation> {
    /// The part of the largest derivative by which derivatives in two states may differ.
    const SAME: f64 = 1e-6;

    let found = moving.with_derivative(solved).ok_or(NoSaltation::Divided)?;
    let slopes = |solved: &Solved<Along, W, C>| solved.after.map(|rate| rate.tangent[0]);
    let ours = slopes(&found);
    let size = moving.before.iter().map(|rate| rate.tangent[0]).chain(ours);
    let size = size.fold(f64::MIN_POSITIVE, |most: f64, slope| most.max(slope.abs()));
    let mut divided = false;
    let visited = values.visit(&mut |other, _| {
        let other = moving.with_derivative(other).filter(|_| values.is_same(other, solved));
        if let Some(other) = other {
            let differ = |(a, b): (&f64, &f64)| !((a - b).abs() <= SAME * size + noise);
            divided |= ours.iter().zip(&slopes(&other)).any(differ);
        }
    });
    if divided || visited.is_err() { Err(NoSaltation::Divided) } else { Ok(found) }
}

#[cfg(test)]
mod tests {
    use super::{Along, Impact, NoSaltation, impulses};
    use crate::hybrid::filled::{filled, table};
    use crate::hybrid::interface::element::Element;
    use crate::hybrid::interface::loads::Loads;
    use crate::numbers::dual::Dual;

    /// The derivatives of the impulses that stop a rough contact, along a direction of size one.
    fn stopped(slopes: [[f64; 2]; 2], before: [Along; 2]) -> Result<[Along; 2], NoSaltation> {
        const ELEMENTS: [Element; 1] = [Element::rough("foot", 0, &[1])];
        let delassus: [[f64; 2]; 2] = [[1.0, 0.2], [0.2, 1.5]];
        let moving: [[Along; 2]; 2] = table(|i, j| Dual { value: delassus[i][j], tangent: [slopes[i][j]] });
        let (none, lifted) = (Loads::<f64, 2, 1>::none(), Loads::<Along, 2, 1>::none());
        let values = Impact {
            elements: &ELEMENTS,
            delassus: &delassus,
            before: filled(|w| before[w].value),
            takes_part: [true],
            friction: [1.0],
            loads: &none.responses,
            restitutions: [0.0],
        };
        let moving = Impact {
            elements: &ELEMENTS,
            delassus: &moving,
            before,
            takes_part: [true],
            friction: [Dual::constant(1.0)],
            loads: &lifted.responses,
            restitutions: [0.0],
        };
        impulses(&values, &moving, false, 1.0)
    }

    /// A direction on which an impact does not depend has derivatives of rounding alone; they tell no two cases apart.
    #[test]
    fn roundings_of_derivatives_are_no_case() {
        let before = [-1.0, 0.1].map(Dual::constant);
        let rounded = [[3e-17, 1.3e-17], [-0.7e-17, 2e-17]];
        let found = stopped(rounded, before).unwrap();
        assert!(found.iter().all(|impulse| impulse.tangent[0].abs() < 1e-15), "{found:?}");
        // A contact that only just sticks is between two cases.
        let slope = |value, slope| Dual { value, tangent: [slope] };
        assert!(matches!(
            stopped([[0.0; 2]; 2], [slope(-1.0, 0.0), slope(1.625, 1.0)]),
            Err(NoSaltation::Divided)
        ));
    }
}
