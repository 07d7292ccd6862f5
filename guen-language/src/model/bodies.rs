//! Particles, rigid bodies and gravity: what they add to the kinetic energy and to the force function.

use guen_symbolic::{BodyNode, ExprId, Graph, Rational, Workbench};

use super::evaluate::{Evaluated, Evaluator};
use super::expression_place::ExpressionPlace;
use super::spatial::inner;
use super::value::{BodyValue, Value, Vector};
use crate::diagnostics::Fault;
use crate::syntax::{Body, Inertia, Particle};

/// A mass at a position, for gravity.
pub(super) type Weight = (ExprId, Vector);

impl Evaluator<'_> {
    /// `1/2 mass |dot(position)|^2`, (2.1)-(2.4).
    pub(super) fn particle(&mut self, particle: &Particle) -> Evaluated<(ExprId, Weight)> {
        let mass = self.scalar_at(ExpressionPlace::Mass, &particle.mass);
        let position = self.vector_at(ExpressionPlace::Position, &particle.position);
        let (mass, position) = (mass?, position?);
        let velocity = self.vector_rate(&position);
        let square = inner(&mut self.bench, &velocity, &velocity);
        let energy = self.bench.graph.mul(mass, square);
        Ok((self.bench.graph.scale(energy, &Rational::new(1, 2)), (mass, position)))
    }

    /// `1/2 mass |v|^2 + 1/2 omega.I omega` in body axes, and the body as a value.
    pub(super) fn body(&mut self, body: &Body) -> Evaluated<(ExprId, Option<Weight>, BodyValue)> {
        let mut energy = Vec::new();
        let mut weight = None;
        let name = body.name.text.clone();
        let mut value = BodyValue { name, center: None, orientation: None, mass: None, inertia: None };
        let mass =
            body.mass.as_ref().map(|mass| self.scalar_at(ExpressionPlace::Mass, &mass.value)).transpose();
        let center = body
            .center
            .as_ref()
            .map(|center| self.vector_at(ExpressionPlace::Position, &center.value))
            .transpose();
        let orientation = body.orientation.as_ref().map(|orientation| {
            match self.at(ExpressionPlace::Position, &orientation.value)? {
                Value::Rotation(rotation) => Ok(*rotation),
                other => self.fail(
                    Fault::new(
                        orientation.value.extent(),
                        format!("an orientation is a rotation, and this is {}", other.kind()),
                    )
                    .help("rotations are made by `rot_x`, `rot_y`, `rot_z`, `rot` and `quaternion`"),
                ),
            }
        });
        let inertia = body.inertia.as_ref().map(|inertia| self.inertia(&inertia.value));
        let (mass, center) = (mass?, center?);
        let (orientation, inertia) = (orientation.transpose()?, inertia.transpose()?);
        (value.mass, value.inertia) = (mass, inertia);
        if let Some(position) = center {
            let velocity = self.vector_rate(&position);
            if let Some(mass) = mass {
                let square = inner(&mut self.bench, &velocity, &velocity);
                energy.push(self.bench.graph.mul(mass, square));
                weight = Some((mass, position));
            }
            value.center = Some((position, velocity));
        }
        if let Some(rotation) = orientation {
            if let Some([xx, yy, zz, xy, yz, zx]) = inertia {
                let [p, q, r] = rotation.body_rate;
                // Two components may be one expression: which terms are products is said by place.
                let (once, twice) = (Rational::integer(1), Rational::integer(2));
                let squares = [(xx, p, p), (yy, q, q), (zz, r, r)].map(|term| (term, &once));
                let products = [(xy, p, q), (yz, q, r), (zx, r, p)].map(|term| (term, &twice));
                for ((moment, a, b), times) in squares.into_iter().chain(products) {
                    let product = self.bench.graph.product(&[(moment, 1), (a, 1), (b, 1)]);
                    energy.push(self.bench.graph.scale(product, times));
                }
            }
            value.orientation = Some(rotation);
        }
        let sum = self.bench.graph.sum(energy);
        Ok((self.bench.graph.scale(sum, &Rational::new(1, 2)), weight, value))
    }

    /// A particle in the system graph.
    pub(super) fn particle_node(&mut self, (mass, position): Weight) {
        let graph = &self.bench.graph;
        let center = Some(self.shapes.place(graph, &position));
        let inertia = [graph.zero(); 6];
        self.shapes.system.bodies.push(BodyNode { name: String::new(), frame: None, center, mass, inertia });
    }

    /// A body in the system graph. Without a mass a centre moves nothing, and without inertia an orientation.
    pub(super) fn body_node(&mut self, body: &BodyValue) {
        let graph = &self.bench.graph;
        let zero = graph.zero();
        let frame = body.inertia.and(body.orientation.as_ref()).map(|rotation| rotation.frame);
        let center = body.mass.and(body.center).map(|(position, _)| self.shapes.place(graph, &position));
        if let Some(orientation) = &body.orientation {
            self.shapes.system.name(orientation.frame, &body.name);
        }
        self.shapes.system.bodies.push(BodyNode {
            name: body.name.clone(),
            frame,
            center,
            mass: body.mass.unwrap_or(zero),
            inertia: body.inertia.unwrap_or([zero; 6]),
        });
    }

    /// The matrix entries `xx, yy, zz, xy, yz, zx`.
    fn inertia(&mut self, inertia: &Inertia) -> Evaluated<[ExprId; 6]> {
        let zero = self.bench.graph.zero();
        let mut entries = [zero; 6];
        let written: &[crate::syntax::Expression] = match inertia {
            Inertia::Missing => return Err(self.faults.reported_before()),
            Inertia::Diagonal(entries) => entries.as_slice(),
            Inertia::Symmetric(entries) => entries.as_slice(),
        };
        let mut healthy = Ok(());
        for (entry, e) in entries.iter_mut().zip(written) {
            match self.scalar_at(ExpressionPlace::Mass, e) {
                Ok(value) => *entry = value,
                Err(reported) => healthy = Err(reported),
            }
        }
        healthy.map(|()| entries)
    }
}

/// Whether the entries `xx, yy, zz, xy, yz, zx` of an inertia are numbers that no distribution of mass has: `tr(I)/2 1 - I`, the
/// integral of `r r^T dm`, has a negative principal minor.
pub(super) fn is_no_inertia(graph: &Graph, entries: &[ExprId; 6]) -> bool {
    /// Limits are meant to be reached: what is below them by this part of the trace is rounding.
    const TRACE_ROUNDING: f64 = 1e-14;
    let numbers: Option<Vec<f64>> = entries.iter().map(|e| Some(graph.as_number(*e)?.to_f64())).collect();
    let Some([xx, yy, zz, xy, yz, zx]) = numbers.as_deref() else { return false };
    let half = (xx + yy + zz) / 2.0;
    let scale = numbers.iter().flatten().fold(0.0_f64, |most, entry| most.max(entry.abs()));
    if scale == 0.0 {
        return false;
    }
    let [a, b, c] = [xx, yy, zz].map(|moment| (half - moment) / scale);
    let [d, e, f] = [xy, yz, zx].map(|product| -product / scale);
    let determinant = a * b * c + 2.0 * d * e * f - a * e * e - b * f * f - c * d * d;
    [a, b, c, a * b - d * d, b * c - e * e, c * a - f * f, determinant]
        .iter()
        .any(|minor| *minor < -TRACE_ROUNDING)
}

/// Whether an angular velocity, in body axes, has more than one direction.
pub(super) fn turns_about_several_axes(
    bench: &mut Workbench,
    rate: &[ExprId; 3],
    velocities: &[ExprId],
) -> bool {
    let rows: Vec<Vec<ExprId>> = velocities
        .iter()
        .map(|v| rate.iter().map(|component| bench.partial(*component, *v)).collect())
        .collect();
    bench.zero.rank(&mut bench.graph, &rows, false).is_some_and(|rank| rank > 1)
}
