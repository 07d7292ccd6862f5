//! Along which directions the components of a vector that vanishes are taken: those that say least, and that span space.

use super::plan::Planner;
use super::safety::{STATES, independent, real_value};
use crate::motion::formulations::multibody::places::tree::{Vec3, cross};
use crate::motion::formulations::multibody::velocities::declared::Group;
use crate::motion::formulations::multibody::velocities::definitions::Plan;
use crate::motion::formulations::multibody::velocities::forms::{Direction, Functional};
use crate::numbering::Num;
use crate::zero::field;

impl Planner<'_> {
    /// Takes the components of vectors that vanish along the directions in which they say least.
    pub(super) fn turn_directions(&mut self, plan: &mut Plan, groups: &[Group]) {
        let etas = self.variables.columns[0].len() - 1;
        for group in groups {
            if plan.unknowns.is_empty() || group.rows.iter().any(|row| plan.used[*row]) {
                continue;
            }
            let mut known = vec![None; self.variables.len()];
            let mut found: Vec<(usize, usize, usize, Direction, Functional, Vec<u64>)> = Vec::new();
            for vector in self.directions(group.axes) {
                let direction = Direction { axes: group.axes, vector, is_free: true };
                let mut row = Functional::default();
                row.add(self.numbers, (self.tree, self.variables), &direction, &group.parts);
                let terms = self.reduced(&row.terms.clone());
                let vector = self.expanded_terms(plan, &terms, &mut known);
                let unknown = vector[etas..].iter().filter(|entry| **entry != 0).count();
                let all = vector.iter().filter(|entry| **entry != 0).count();
                if unknown > 0 {
                    found.push((unknown, all, found.len(), direction, row, vector));
                }
            }
            found.sort_by_key(|(unknown, all, place, ..)| (*unknown, *all, *place));
            let mut chosen: Vec<Functional> = Vec::new();
            let mut vectors: Vec<Vec<u64>> = Vec::new();
            for (.., row, vector) in found {
                if chosen.len() == group.rows.len() {
                    break;
                }
                let mut trial = vectors.clone();
                trial.push(vector);
                if field::rank(&trial) == trial.len() && self.spans(&chosen, &row) {
                    vectors = trial;
                    chosen.push(row);
                }
            }
            for (place, index) in group.rows.iter().enumerate() {
                match chosen.get(place) {
                    Some(row) => plan.rows[*index] = row.clone(),
                    None => plan.used[*index] = true,
                }
            }
        }
    }

    /// Whether the directions of some rows and a further one are independent at the rest position and elsewhere.
    fn spans(&mut self, rows: &[Functional], further: &Functional) -> bool {
        let all: Vec<Vec3> = rows.iter().chain([further]).map(|row| row.directions[0].vector).collect();
        (0..STATES).all(|state| {
            let values: Vec<[f64; 3]> =
                all.iter().map(|v| v.map(|e| real_value(self.bench, self.numbers, e, state))).collect();
            independent(&values)
        })
    }

    /// Directions along which components may be short: the axes on the way to the root, and the normals of pairs of them.
    fn directions(&mut self, axes: usize) -> Vec<Vec3> {
        let unit = |q: usize| {
            let mut unit = [Num::ZERO; 3];
            unit[q] = Num::ONE;
            unit
        };
        let mut found: Vec<Vec3> = Vec::new();
        let mut place = axes;
        loop {
            for q in 0..3 {
                let seen = self.tree.seen_in(self.numbers, axes, place, &unit(q));
                if !found.contains(&seen) {
                    found.push(seen);
                }
            }
            if place == 0 {
                break;
            }
            place = self.tree.axes[place].parent;
        }
        let world: Vec<Vec3> = (0..3).map(|q| self.tree.seen_in(self.numbers, axes, 0, &unit(q))).collect();
        for q in 0..3 {
            for normal in &world {
                let level = cross(self.numbers, normal, &unit(q));
                if level.iter().any(|e| !e.is_zero()) && !found.contains(&level) {
                    found.push(level);
                }
            }
        }
        found
    }
}
