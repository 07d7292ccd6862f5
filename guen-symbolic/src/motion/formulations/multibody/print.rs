//! The plan and the quadratic form of a system of bodies in lines, for pages and tests.

use std::fmt::Write;

use super::inwards::assembly::{Assembly, ORDERS};
use super::outwards::kinematics::Kinematics;
use super::velocities::variables::{Kind, Var};
use super::{InertialForces, POINTS, Posed, assembled};
use crate::geometry::Operators;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::{Frame, Mechanics};
use crate::numbering::Numbering;
use crate::workbench::Workbench;

/// The names of components.
const COMPONENTS: [char; 3] = ['x', 'y', 'z'];

/// The unknowns that the constraints determine, each with what it follows from, and the patterns of the quadratic form of the
/// velocities: where it is put up, and where only parameters and unknowns are left. `c` is an entry of constants, `x` any other, a point
/// none. `None` where there are no bodies, or they are not understood.
///
/// Sets of axes and points have the numbers in which they follow from each other; of a point `before` stands for its velocity in the axes
/// of the one that it is seen from.
pub fn elimination_text(bench: &mut Workbench, system: &Mechanics) -> Option<String> {
    if system.structure.bodies.is_empty() {
        return None;
    }
    bench.choose_base_angles(&[], &system.expressions());
    let operators = Operators::new(bench, &system.forms).ok()?;
    let frame = Frame::new(bench, system, operators);
    let mut partials = VelocityPartials::of_system(bench, system);
    let posed = Posed { system, inertial: InertialForces::OfBodies, declared: None };
    let context = (posed, system.forms.degrees);
    (0..POINTS).find_map(|point| {
        let generation = bench.zero.generation();
        let mut numbers = Numbering::new(&mut bench.graph, (point, false), generation);
        assembled(bench, &mut numbers, context, &frame, &mut partials, |assembly, _| assembly.text())
    })
}

impl Assembly<'_> {
    fn text(&mut self) -> Option<String> {
        let mut text = String::new();
        let (plan, core) = (self.kinematics.plan, self.kinematics.core);
        for (unknown, solution) in plan.unknowns.iter().zip(&core.solutions) {
            let from: Vec<String> = solution.iter().map(|(var, _)| self.kinematics.label(*var)).collect();
            let _ = writeln!(text, "{} follows from {}", self.kinematics.label(*unknown), from.join(", "));
        }
        text.push_str(&self.pattern());
        let bias = self.core_bias();
        self.inwards(ORDERS[0], &bias)?;
        text.push_str(&self.pattern());
        Some(text)
    }

    /// The entries of the form that are there, a line for each velocity, after an empty one.
    fn pattern(&self) -> String {
        let vars = self.form.variables();
        let labels: Vec<String> = vars.iter().map(|var| self.kinematics.label(*var)).collect();
        let width = labels.iter().map(String::len).max().unwrap_or(0);
        let mut text = "\n".to_owned();
        for (label, row) in labels.iter().zip(&vars) {
            let entries = vars.iter().map(|column| match self.form.entry(*row, *column) {
                entry if entry.is_zero() => '.',
                entry if self.kinematics.numbers.is_constant(entry) => 'c',
                _ => 'x',
            });
            let _ = writeln!(text, "{label:width$}  {}", entries.collect::<String>());
        }
        text
    }
}

impl Kinematics<'_> {
    /// The name of a velocity.
    fn label(&self, var: Var) -> String {
        let graph = &self.bench.graph;
        match self.variables.kind(var) {
            Kind::Eta(s) => graph.text(self.system.etas[s]),
            Kind::Rate(i) => format!("rate of {}", graph.text(self.system.forms.coordinates[i])),
            Kind::Spin(axes, q) => format!("spin {axes}, {}", COMPONENTS[q]),
            Kind::Before(point, q) => format!("before {point}, {}", COMPONENTS[q]),
            Kind::Velocity(point, q) => format!("point {point}, {}", COMPONENTS[q]),
        }
    }
}
