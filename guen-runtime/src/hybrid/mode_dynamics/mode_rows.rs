//! The rows of a mode without its system: the directions of slip, the equations of the reactions, and what friction adds to them.
//!
//! Nothing here depends on the type of a system, so systems with the same number of rows share the compiled code. Loops stand in place of iterators
//! with closures, because closures make unoptimised code several times as long (`docs/design/build-time.md`).

use super::pivots::Pivots;
use crate::hybrid::filled::{diagonal, negated};
use crate::hybrid::interface::element::Element;
use crate::hybrid::interface::loads::{self, Loads};
use crate::hybrid::interface::mode::Mode;
use crate::hybrid::interface::reactions::Reactions;
use crate::hybrid::interface::system::FreeMotion;
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;

/// The direction of spatial slip next to rest.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::hybrid) struct Leaning {
    /// A unit vector, or zero where the slip tells its direction.
    pub(in crate::hybrid) direction: [f64; 2],
    /// A speed far below which the direction is this one; infinite where it is this one always.
    pub(in crate::hybrid) speed: f64,
}

/// The rows of a mode.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct ModeRows<'a, const W: usize, const C: usize> {
    pub(in crate::hybrid) elements: &'static [Element; C],
    pub(in crate::hybrid) mode: &'a Mode<C>,
    pub(in crate::hybrid) pivots: &'a Pivots<W>,
    /// The directions of spatial slip where the slip itself does not tell one.
    pub(super) leaning: &'a [Leaning; C],
}

impl<const W: usize, const C: usize> ModeRows<'_, W, C> {
    /// The magnitude of every slip; zero where an element does not slip.
    pub(super) fn speeds<R: Lift<f64>>(&self, row_rates: &[R; W]) -> [R; C] {
        let mut speeds = [R::zero(); C];
        for (c, speed) in speeds.iter_mut().enumerate() {
            let direction = self.direction(c, row_rates);
            for (&row, component) in self.elements[c].tangential.iter().zip(direction) {
                *speed = component.times_plus(row_rates[row], *speed);
            }
        }
        speeds
    }

    /// The direction of every slip, by its rows; zero where an element does not slip.
    pub(super) fn directions<R: Lift<f64>>(&self, row_rates: &[R; W]) -> [R; W] {
        let mut directions = [R::zero(); W];
        for (c, element) in self.elements.iter().enumerate() {
            let direction = self.direction(c, row_rates);
            for (&row, component) in element.tangential.iter().zip(direction) {
                directions[row] = component;
            }
        }
        directions
    }

    /// The direction of an element's slip; zero where it does not slip.
    fn direction<R: Lift<f64>>(&self, c: usize, row_rates: &[R; W]) -> [R; 2] {
        let sign = self.mode.0[c].sign();
        match self.elements[c].tangential {
            _ if sign == 0 => [R::zero(); 2],
            &[first, second] => {
                let Leaning { direction: [x, y], speed } = self.leaning[c];
                if speed == f64::INFINITY {
                    return [R::lift(x), R::lift(y)];
                }
                let x = row_rates[first] + R::lift(speed * x);
                let y = row_rates[second] + R::lift(speed * y);
                let inverse = (x * x + y * y).sqrt().recip();
                [x * inverse, y * inverse]
            }
            _ => [R::from_ratio(sign.into(), 1), R::zero()],
        }
    }

    /// The equations `G l = r` of the mode, over all rows.
    pub(super) fn equations<R: Real, const N: usize>(
        &self,
        free: &FreeMotion<R, N, W, C>,
        directions: &[R; W],
    ) -> ([[R; W]; W], [R; W]) {
        let mut matrix = free.delassus;
        let mut right = negated(free.biases);
        for (c, element) in self.elements.iter().enumerate() {
            if !self.mode.0[c].slips() {
                continue;
            }
            for &row in self.pivots.all() {
                let along = along(element, directions, &free.delassus[row]);
                if let Some(load) = element.load {
                    matrix[row][load] = matrix[row][load].minus_times(free.friction[c], along);
                }
                right[row] = free.limits[c].times_plus(along, right[row]);
            }
        }
        (matrix, right)
    }

    /// Adds the reactions of what slips to those of its loads.
    pub(super) fn add_friction<R: Real>(
        &self,
        reactions: &mut [R; W],
        friction: &[R; C],
        directions: &[R; W],
        limits: &[R; C],
    ) {
        for (c, element) in self.elements.iter().enumerate() {
            if self.mode.0[c].slips() {
                let load = match element.load {
                    Some(row) => reactions[row],
                    None => R::zero(),
                };
                let force = friction[c].times_plus(load, limits[c]);
                for &t in element.tangential {
                    reactions[t] = -(force * directions[t]);
                }
            }
        }
    }

    /// Adds the friction of what slips under the reactions of permanent constraints. Where nothing shows that these are always
    /// determined, `regularity` tells whether they are.
    pub(super) fn load<R: Real, const N: usize>(
        &self,
        motion: &mut Reactions<R, N, W, C>,
        matrix: [[R; W]; W],
        loads: &Loads<R, W, C>,
        is_always_determined: bool,
    ) {
        let Reactions { free, directions, .. } = *motion;
        let mut slips = [false; C];
        let mut signed = loads.free;
        for (c, element) in self.elements.iter().enumerate() {
            slips[c] = element.loaded_by_constraint && self.mode.0[c].slips();
            signed[c] += loads::added(&loads.responses[c], &motion.reactions);
        }
        if slips.contains(&true) {
            let sizes = diagonal(&free.delassus);
            // The reactions that a load of one causes, and what they add to all loads.
            let mut caused = [[R::zero(); W]; C];
            let mut coupling = [[R::zero(); C]; C];
            for (c, element) in self.elements.iter().enumerate().filter(|(c, _)| slips[*c]) {
                let mut right = [R::zero(); W];
                for (place, row) in right.iter_mut().zip(&free.delassus) {
                    *place = free.friction[c] * along(element, &directions, row);
                }
                (caused[c], _) = self.pivots.solve(matrix, right, &sizes);
                let mut own = [R::zero(); C];
                own[c] = free.friction[c];
                self.add_friction(&mut caused[c], &free.friction, &directions, &own);
            }
            for (row, responses) in coupling.iter_mut().zip(&loads.responses) {
                for (place, caused) in row.iter_mut().zip(&caused) {
                    *place = loads::added(responses, caused);
                }
            }
            if !is_always_determined {
                motion.regularity *= loads::regularity(&coupling, &slips);
            }
            let found = loads::magnitudes(&signed, &coupling, &slips);
            for (f, caused) in found.iter().zip(&caused) {
                for (reaction, part) in motion.reactions.iter_mut().zip(caused) {
                    *reaction = f.times_plus(*part, *reaction);
                }
            }
            for (load, row) in signed.iter_mut().zip(&coupling) {
                *load += loads::added(row, &found);
            }
        }
        for (load, signed) in motion.loads.iter_mut().zip(&signed) {
            *load = signed.abs();
        }
    }
}

/// The component of a row of the Delassus matrix along an element's slip.
fn along<R: Real, const W: usize>(element: &Element, directions: &[R; W], row: &[R; W]) -> R {
    let mut along = R::zero();
    for &t in element.tangential {
        along = directions[t].times_plus(row[t], along);
    }
    along
}
