//! Equations on constraints on positions: what vanishes or is constant there is not computed, and what is computed loses
//! nothing, against 71 digits on the constraint, entry by entry.

use crate::common::{derived, evaluated};
use f256::f256;
use guen_language::derive::function;
use guen_symbolic::{Class, ExprId, Graph, evaluate};

/// A hoop that rolls on the plane, in quaternions.
const HOOP: &str = "pub system Hoop {
    constants { a > 0, A > 0, C > 0, g = 9.81 }
    coordinates { w, i, j, k, xi, eta, zeta }
    let R = quaternion(w, i, j, k);
    bodies { hoop { mass: 1, inertia: diag(A, A, C), center: vec(xi, eta, zeta), orientation: R } }
    let up = vec(0, 0, 1);
    let contact = hoop.center - a*unit(up - inner(up, R.z)*R.z);
    gravity = -g*up;
    parameters { spin = angular_velocity_body(R); }
    constraints { rolling: hoop.velocity_at(contact) = 0; }
    holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
}";

#[test]
fn the_third_spin_of_a_hoop_depends_on_the_others_alone() {
    derived(HOOP, |derived| {
        let (graph, derivation) = (&derived.model.bench.graph, &derived.system.derivation);
        let equations = &derivation.equations;
        assert!((0..2).all(|s| graph.is_zero(equations.mass[2][s]) && graph.is_zero(equations.mass[s][2])));
        assert_eq!(graph.text_limited(equations.mass[2][2], 40).as_deref(), Some("C + a^2"));
        let spins: Vec<_> =
            derivation.system.etas[..3].iter().map(|eta| graph.as_symbol(*eta).unwrap()).collect();
        let occurring = graph.symbols_in(&[equations.forces[2]]);
        assert!(
            occurring.contains(&spins[0]) && occurring.contains(&spins[1]) && !occurring.contains(&spins[2])
        );
        let g = occurring.iter().any(|symbol| graph.symbol_info(*symbol).name == "g");
        assert!(!g, "gravity has no moment about the axle");
        // The contact has no difference in it that vanishes where the hoop is flat.
        assert!(derivation.solution.accelerations.iter().all(|e| radicands(graph, *e).len() == 1));
    });
}

/// The same where the energy of the spins is written beside the body: then the axes are those of the world.
#[test]
fn the_same_in_the_axes_of_the_world() {
    let energy = "kinetic_energy = A/2*(spin_x^2 + spin_y^2) + C/2*spin_z^2;";
    let text = HOOP
        .replace("diag(A, A, C)", "diag(0, 0, 0)")
        .replace("constraints {", &format!("{energy} constraints {{"));
    derived(&text, |derived| {
        let (graph, derivation) = (&derived.model.bench.graph, &derived.system.derivation);
        let equations = &derivation.equations;
        assert!((0..2).all(|s| graph.is_zero(equations.mass[2][s]) && graph.is_zero(equations.mass[s][2])));
        let third = graph.as_symbol(derivation.system.etas[2]).unwrap();
        assert!(!graph.symbols_in(&[derivation.solution.accelerations[2]]).contains(&third));
        assert!(graph.symbols_in(&[derivation.solution.accelerations[0]]).contains(&third));
    });
}

/// The radicands of an expression.
fn radicands(graph: &Graph, e: ExprId) -> Vec<ExprId> {
    use guen_symbolic::{Function, Node};
    let mut found: Vec<ExprId> = Vec::new();
    for id in graph.reachable(&[e], |_| false) {
        if let Node::Function(Function::Root(_), x) = *graph.node(id) {
            found.push(x);
        }
    }
    found
}

/// Roundings that an entry may lose beyond those of its own terms.
const ROUNDINGS: f64 = 4.0;

/// Spins of a hundredth beside one of the order of one, and contacts next to the edge: where the third rate was a sum of
/// terms with all three spins, two of its digits were lost.
#[test]
fn every_entry_keeps_its_digits() {
    derived(HOOP, |derived| {
        let (graph, derivation) = (&derived.model.bench.graph, &derived.system.derivation);
        let exact = &derivation.solution.accelerations;
        let state = derivation.system.forms.coordinates.iter().chain(&derivation.system.etas[..3]);
        let state: Vec<_> = state.map(|e| graph.as_symbol(*e).unwrap()).collect();
        for round in 0..200_u32 {
            let letters = |k: usize| (1.7 * f64::from(round) + 2.3 * k as f64 + 0.4).sin();
            let mut x: Vec<f64> = (0..state.len()).map(letters).collect();
            if round % 2 == 0 {
                // Nearly flat.
                let distance = 10.0_f64.powf(-f64::from(round) / 20.0);
                x[..4].iter_mut().for_each(|q| *q *= distance);
                x[round as usize / 2 % 4] = 1.0;
            }
            let length = x[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
            x[..4].iter_mut().for_each(|q| *q /= length);
            if round % 3 == 0 {
                (x[7], x[8]) = (0.01 * x[7], 0.01 * x[8]);
            }
            let value = |symbol| match state.iter().position(|other| *other == symbol) {
                Some(k) => x[k],
                None => match &graph.symbol_info(symbol).name[..] {
                    "a" => 0.75,
                    "A" => 0.5,
                    "C" => 1.25,
                    _ => 9.8125,
                },
            };
            let at = |moved: Option<usize>| {
                let step = f256::from(1e-25);
                let exact = evaluate(graph, exact, &|symbol| {
                    let moves = moved.is_some_and(|k| state[k] == symbol);
                    f256::from(value(symbol)) + if moves { step } else { f256::ZERO }
                });
                (exact, step)
            };
            let (exact, _) = at(None);
            let slopes: Vec<Vec<f256>> = (0..state.len())
                .map(|k| {
                    let (moved, step) = at(Some(k));
                    moved.iter().zip(&exact).map(|(a, b)| (*a - *b).abs() / step).collect()
                })
                .collect();
            let found = evaluated(&derived.system, function::RHS, value).expect("rates");
            let found = &found[found.len() - exact.len()..];
            for (s, (exact, found)) in exact.iter().zip(found).enumerate() {
                let error = (*exact - f256::from(*found)).abs();
                // What a rounding of each entry of the state does to it, and of itself.
                let sensitivity = slopes.iter().zip(&x);
                let terms =
                    sensitivity.fold(exact.abs(), |sum, (slope, x)| sum + slope[s] * f256::from(x.abs()));
                let allowed = terms * f256::from(ROUNDINGS * f64::EPSILON);
                assert!(error <= allowed, "entry {s} at {x:?}: {exact:e} is {found:e}");
            }
        }
    });
}

/// A structure coefficient is a constant where it is one on `|q| = 1`: `(X_u, X_z) = N X_s` with `N = w^2 + i^2 + j^2 + k^2`.
#[test]
fn structure_coefficients_that_are_constant_on_the_sphere() {
    for (factor, class) in [("w^2 + i^2 + j^2 + k^2", Class::LieGroup), ("w^2 + 2*i^2", Class::Holonomic)] {
        let text = format!(
            "system Carried {{
                constants {{ m > 0, A > 0 }}
                coordinates {{ w, i, j, k, x, y, z }}
                holonomic {{ unit_length: w^2 + i^2 + j^2 + k^2 = 1; }}
                let q = quaternion(w, i, j, k);
                bodies {{ ball {{ mass: 0, inertia: diag(A, A, A), center: vec(0, 0, 0), orientation: q }} }}
                parameters {{
                    spin = angular_velocity_body(q);
                    u = dot(x);
                    v = dot(z);
                    s = dot(y) - ({factor})*x*dot(z);
                }}
                kinetic_energy = m/2*(u^2 + v^2 + s^2);
            }}"
        );
        derived(&text, |derived| {
            let derivation = &derived.system.derivation;
            assert_eq!(derivation.class, class, "{factor}");
            let graph = &derived.model.bench.graph;
            let mut all = derived.system.brackets.iter().flat_map(|bracket| &bracket.coefficients);
            assert_eq!(all.all(|c| graph.roles(*c).is_constant()), class == Class::LieGroup, "{factor}");
        });
    }
}
