//! Rates of coordinates that nothing in the tree needs: by the spin of the axes that they turn, or by the place where a point is pinned.
//!
//! The operators have these rates too, from the inverse of all forms at once. Here a quaternion has `q' = 1/2 q w`, whatever holds its
//! body, and a mass centre that is pinned to other bodies `p' = sum of w x r` over the levers that lead to it.

use super::kinematics::Kinematics;
use crate::motion::formulations::multibody::places::tree::{DeclaredSpin, cross};
use crate::motion::formulations::multibody::planning::core::inverse;
use crate::motion::formulations::multibody::velocities::variables::Kind;
use crate::numbering::Num;

impl Kinematics<'_> {
    /// The rate of a coordinate of axes or of a pinned point; `None` where it is neither.
    pub(super) fn rate_of_coordinate(&mut self, coordinate: usize) -> Option<Num> {
        self.rate_by_spin(coordinate).or_else(|| self.rate_by_pin(coordinate))
    }

    /// The rate of a coordinate of general axes: their spin, and the forms that speak of their coordinates alone, as that of the length of
    /// a quaternion, solved for the rates of all of these.
    fn rate_by_spin(&mut self, coordinate: usize) -> Option<Num> {
        let tree = self.tree;
        let turned = tree.spins.iter().find(|turned| turned.coordinates().any(|i| i == coordinate))?;
        let mut coordinates: Vec<usize> = turned.coordinates().collect();
        coordinates.sort_unstable();
        coordinates.dedup();
        let place = |i: usize| coordinates.iter().position(|own| *own == i);
        let (mut matrix, mut sides) = (Vec::new(), Vec::new());
        let relative = self.declared_spin(turned);
        for (form, spin) in turned.spin.iter().zip(relative) {
            let mut row = vec![Num::ZERO; coordinates.len()];
            for (i, c) in &form.terms {
                row[place(*i)?] = *c;
            }
            matrix.push(row);
            sides.push(self.numbers.sub(spin, form.offset.unwrap_or(Num::ZERO)));
        }
        let (plan, variables) = (self.plan, self.variables);
        for form in &plan.rows {
            let mut row = vec![Num::ZERO; coordinates.len()];
            let mut others = Vec::new();
            for (var, c) in &form.terms {
                match variables.kind(*var) {
                    Kind::Rate(i) if place(i).is_some() => row[place(i)?] = *c,
                    _ => others.push((*var, *c)),
                }
            }
            let is_own = others.iter().all(|(var, _)| matches!(variables.kind(*var), Kind::Eta(_)));
            if !is_own || row.iter().all(|c| c.is_zero()) {
                continue;
            }
            let mut side = form.offset;
            for (var, c) in others {
                let value = self.value(var);
                let part = self.numbers.mul(c, value);
                side = self.numbers.add(side, part);
            }
            matrix.push(row);
            sides.push(side.neg());
        }
        if matrix.len() != coordinates.len() {
            return None;
        }
        let inverse = inverse(self.numbers, &matrix);
        Some(self.numbers.dot(&inverse[place(coordinate)?], &sides))
    }

    /// The spin of axes against those that they are declared against, in their own.
    fn declared_spin(&mut self, turned: &DeclaredSpin) -> [Num; 3] {
        let own = self.spin(turned.axes);
        let carrier = self.spin(turned.against);
        let carried = self.tree.seen_in(self.numbers, turned.axes, turned.against, &carrier);
        [0, 1, 2].map(|q| self.numbers.sub(own[q], carried[q]))
    }

    /// The rate of a coordinate of a point that is pinned.
    fn rate_by_pin(&mut self, coordinate: usize) -> Option<Num> {
        let tree = self.tree;
        let pin = tree.pins.iter().find(|pin| pin.point.contains(&Some(coordinate)))?;
        let k = pin.point.iter().position(|i| *i == Some(coordinate))?;
        let mut sum = self.form(&pin.others[k]);
        for (axes, arm) in &pin.arms {
            let spin = self.spin(*axes);
            let swept = cross(self.numbers, &spin, arm);
            let seen = tree.in_world(self.numbers, *axes, &swept);
            sum = self.numbers.add(sum, seen[k]);
        }
        Some(self.numbers.div(sum, pin.factor).neg())
    }
}
