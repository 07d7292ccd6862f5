//! Forces of potentials: of a function of lengths, products and components of vectors, `U(t, s_1, s_2, ..)`, the force `dU/ds_k` does
//! work along the rate of each.
//!
//! The place of a spring's end is a sum to which all bodies add that carry it; its velocity is one that the bodies have.

use crate::algebra::{ExprId, Flow, Node, Role, Substitution};
use crate::motion::{Force, Frame, Mechanics};
use crate::workbench::Workbench;

/// The system with the terms of the force function that depend on the coordinates through functions of places only as forces, and
/// forces over the parameters.
pub(in crate::motion) fn as_forces(bench: &mut Workbench, system: &Mechanics, frame: &Frame) -> Mechanics {
    let mut other = system.clone();
    let pairs = system.velocities.iter().copied().zip(frame.velocities.iter().copied());
    let mut by_parameters = Substitution::new(pairs);
    for force in &mut other.forces {
        force.magnitude = by_parameters.of(&mut bench.graph, force.magnitude);
    }
    let Some(multibody) = &mut other.multibody else { return other };
    let below = bench.graph.reachable(&[multibody.other_force_function], |_| false);
    let mut named = Substitution::default();
    let mut written = Vec::new();
    for (k, (scalar, shape)) in system.structure.scalars.iter().enumerate() {
        if bench.graph.roles(*scalar).has(Role::Coordinate) && below.contains(scalar) {
            let symbol = bench.graph.symbol(&format!("function {k} of places"), Role::Input);
            named.add(*scalar, symbol);
            written.push((symbol, *scalar, shape));
        }
    }
    let terms = match bench.graph.node(multibody.other_force_function).clone() {
        Node::Sum { terms, .. } => terms.iter().map(|(term, c)| bench.graph.scale(*term, c)).collect(),
        _ => vec![multibody.other_force_function],
    };
    let (mut of_places, mut left) = (Vec::new(), Vec::new());
    for term in terms {
        let image = named.of(&mut bench.graph, term);
        let is_of_places = !bench.graph.roles(image).has(Role::Coordinate);
        if is_of_places { of_places.push(image) } else { left.push(term) }
    }
    let of_places = bench.graph.sum(of_places);
    multibody.other_force_function = bench.graph.sum(left);
    other.structure.loads.resize(system.forces.len(), None);
    let mut back = Substitution::new(written.iter().map(|(symbol, scalar, _)| (*symbol, *scalar)));
    let rates = system.forms.coordinates.iter().copied().zip(system.velocities.iter().copied());
    let mut motion = Flow::new(&bench.graph, rates);
    for (symbol, scalar, shape) in written {
        let slope = Flow::partial(&bench.graph, symbol).of(&mut bench.graph, of_places);
        if !bench.graph.is_zero(slope) {
            let magnitude: ExprId = back.of(&mut bench.graph, slope);
            let along = motion.of(&mut bench.graph, scalar);
            other.forces.push(Force { magnitude, along });
            other.structure.loads.push(Some(shape.clone()));
        }
    }
    other
}
