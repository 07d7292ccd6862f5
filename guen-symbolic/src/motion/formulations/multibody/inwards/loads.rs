//! Declared forces, and those of potentials of places, along the velocities of the bodies.

use super::assembly::Assembly;
use crate::algebra::Role;
use crate::motion::Force;
use crate::motion::formulations::multibody::outwards::kinematics::Kinematics;
use crate::motion::formulations::multibody::velocities::forms::Functional;
use crate::motion::formulations::multibody::velocities::relations::{Linear, in_steps, reduced};

impl Assembly<'_> {
    /// The forces along forms. What acts along the components of one velocity is one vector, whatever the axes in which it was given;
    /// between bodies it acts along what moves them against each other.
    pub(in crate::motion) fn loads(&mut self, loads: &[Functional]) {
        let Kinematics { tree, variables, plan, system, .. } = self.kinematics;
        let shapes = &system.structure.loads;
        let velocity = |k: usize| shapes.get(k)?.as_ref()?.components.first().map(|part| &part.velocity);
        self.number_velocities(loads);
        let mut own = Linear::new();
        for (k, (force, load)) in system.forces.iter().zip(loads).enumerate() {
            let magnitude = self.kinematics.numbers.import(self.kinematics.bench, force.magnitude);
            let numbers = &mut *self.kinematics.numbers;
            own.extend(load.terms.iter().map(|(var, c)| (*var, numbers.mul(magnitude, *c))));
            if velocity(k).is_some() && velocity(k) == velocity(k + 1) {
                continue;
            }
            let whole = reduced(numbers, variables, &std::mem::take(&mut own));
            let relative = in_steps(numbers, tree, variables, plan, whole.clone());
            for (var, e) in if relative.len() <= whole.len() { relative } else { whole } {
                self.push(var, e);
            }
        }
    }

    /// Numbers the velocities along which forces act that depend on velocities: a damper has its own in its force.
    fn number_velocities(&mut self, loads: &[Functional]) {
        let Kinematics { system, bench, .. } = &self.kinematics;
        let moves = |force: &Force| bench.graph.roles(force.magnitude).has(Role::QuasiVelocity);
        if !system.forces.iter().any(moves) {
            return;
        }
        for load in loads {
            let mut sum = load.offset;
            for (var, c) in &load.terms {
                let value = self.kinematics.value(*var);
                let numbers = &mut *self.kinematics.numbers;
                let part = numbers.mul(*c, value);
                sum = numbers.add(sum, part);
            }
        }
    }
}
