//! Accuracy is not sold: the cheapest rates of a chain, in other words than declared, are as accurate as those in the
//! parameters declared, at random states and near singular ones, against 71 digits.

use f256::f256;
use guen_symbolic::{
    Derivation, ExprId, Flow, Force, Form, Forms, Graph, Mechanics, ProgramBuilder, Role, SignBound,
    Workbench, evaluate, evaluate_function, evaluate_prepare,
};

const LINKS: usize = 5;
/// What the other words may lose: a bit, and the rounding of the last differences.
const FACTOR: f64 = 3.0;
const FLOOR: f64 = 8.0;

/// A chain of point masses in relative angles, with the rates of its joints for parameters, and rotors in the joints or not.
fn chain(graph: &mut Graph, rotors: bool) -> (Mechanics, [ExprId; 3]) {
    let symbols = |graph: &mut Graph, letter: &str, role: Role| -> Vec<ExprId> {
        (1..=LINKS).map(|i| graph.symbol(&format!("{letter}{i}"), role)).collect()
    };
    let time = graph.symbol("t", Role::Time);
    let constants =
        ["m", "l", "g"].map(|name| graph.bounded_symbol(name, Role::Constant, SignBound::Positive));
    let [m, l, g] = constants;
    let x = symbols(graph, "q", Role::Coordinate);
    let velocities = symbols(graph, "v", Role::Velocity);
    let etas = symbols(graph, "w", Role::QuasiVelocity);
    let accelerations = symbols(graph, "dw", Role::QuasiAcceleration);
    let mut rate = Flow::new(graph, x.iter().copied().zip(velocities.iter().copied()).collect::<Vec<_>>());
    let (mut angle, mut places) = (graph.zero(), [graph.zero(); 2]);
    let (mut kinetic, mut force) = (Vec::new(), Vec::new());
    for q in &x {
        angle = graph.add(angle, *q);
        let (s, c) = graph.sin_cos(angle);
        let (right, down) = (graph.mul(l, s), graph.mul(l, c));
        places = [graph.add(places[0], right), graph.sub(places[1], down)];
        for place in places {
            let half = graph.ratio(1, 2);
            let speed = rate.of(graph, place);
            kinetic.push(graph.product(&[(half, 1), (m, 1), (speed, 2)]));
        }
        let weight = graph.product(&[(m, 1), (g, 1), (places[1], 1)]);
        force.push(graph.neg(weight));
    }
    // Rotors in the joints: the energy speaks of the parameters too, and one joint drags the next.
    for eta in etas.iter().filter(|_| rotors) {
        let tenth = graph.ratio(1, 20);
        kinetic.push(graph.product(&[(tenth, 1), (m, 1), (l, 2), (*eta, 2)]));
    }
    let pull = Force { magnitude: graph.neg(etas[1]), along: etas[2] };
    let forms = (0..LINKS)
        .map(|i| {
            let row = (0..LINKS).map(|k| if i == k { graph.one() } else { graph.zero() }).collect();
            Form { row, offset: graph.zero() }
        })
        .collect();
    let forms = Forms { time, coordinates: x, forms, degrees: LINKS };
    let mechanics = Mechanics {
        written: forms.over(graph, &velocities),
        forms,
        velocities,
        etas,
        accelerations,
        inputs: Vec::new(),
        holonomic: Vec::new(),
        redundant: Vec::new(),
        kinetic_energy: graph.sum(kinetic),
        stated: vec![true; LINKS],
        force_function: graph.sum(force),
        multibody: None,
        structure: Default::default(),
        forces: vec![pull],
        outputs: Vec::new(),
        states: Vec::new(),
        motion_symbols: Vec::new(),
        measured: None,
    };
    (mechanics, constants)
}

/// Angles and rates: hanging nearly straight, folded, spread, and turning fast.
fn state(round: usize) -> Vec<f64> {
    let number = |k: usize| ((k * k + 31 * round + 7 * k) as f64 * 0.731).sin();
    let (spread, turn, speed) = [
        (2.0, 0.0, 1.0),
        (1e-8, 0.0, 1.0),
        (1e-4, std::f64::consts::PI, 1.0),
        (1e-8, std::f64::consts::PI, 1e-3),
        (1.0, 0.0, 1e4),
        (1e-6, 0.0, 1e3),
    ][round % 6];
    let angles = (0..LINKS).map(|k| spread * number(k) + if k > 0 { turn } else { 0.0 });
    angles.chain((LINKS..2 * LINKS).map(|k| speed * number(k))).collect()
}

#[test]
fn other_words_are_as_accurate() {
    let derivation = compared(true);
    assert!(!derivation.is_by("constraint forces"), "rotors join each joint to the next");
}

#[test]
fn constraint_forces_are_as_accurate_as_the_mass_matrix() {
    let derivation = compared(false);
    assert!(derivation.is_by("constraint forces"));
    assert!(!derivation.solution.determinants.is_empty(), "the first list is by the mass matrix");
}

/// Compares all rates of a chain with those in the parameters declared.
fn compared(rotors: bool) -> Derivation {
    let mut graph = Graph::new();
    let (mechanics, constants) = chain(&mut graph, rotors);
    let mut bench = Workbench::new(graph);
    let derivation = Derivation::new(&mut bench, mechanics).expect("a chain has equations");
    assert!(derivation.formulations.len() > 1);
    // The first list is by the mass matrix.
    let mut formulations = derivation.formulations.clone();
    formulations.sort_by_key(|formulated| formulated.name != "multiplied out");
    let lists: Vec<Vec<ExprId>> = formulations.into_iter().map(|formulated| formulated.rates).collect();
    let graph = &mut bench.graph;
    let mut builder = ProgramBuilder::new(graph);
    builder.add_function("as declared", &lists[0]);
    assert_ne!(builder.add_equal("the cheapest", &lists), 0, "other words cost less");
    for list in &lists[1..] {
        builder.add_function("others", list);
    }
    let programs = builder.finish();
    let system = &derivation.system;
    let moving: Vec<ExprId> = system.forms.coordinates.iter().chain(&system.etas).copied().collect();
    for round in 0..60 {
        let point = state(round);
        let value = |symbol| {
            let e = graph.symbol_expr(symbol);
            if let Some(k) = moving.iter().position(|x| *x == e) {
                return point[k];
            }
            constants.iter().position(|c| *c == e).map_or(0.0, |k| [0.7, 0.4, 9.81][k])
        };
        let exact = evaluate(graph, &lists[0], &|symbol| f256::from(value(symbol)));
        let prepared = evaluate_prepare(&programs, value);
        let errors: Vec<f64> = (0..programs.functions.len())
            .map(|list| {
                let found = evaluate_function(&programs, list, &prepared, value);
                let pairs = || exact[LINKS..].iter().zip(&found[LINKS..]);
                let error = pairs().map(|(a, b)| (*a - f256::from(*b)).abs()).fold(f256::ZERO, f256::max);
                let size = exact[LINKS..].iter().map(|a| a.abs()).fold(f256::ZERO, f256::max);
                let ratio = error / size / f256::from(f64::EPSILON);
                format!("{ratio:.6}").parse().expect("a number")
            })
            .collect();
        println!("round {round}: as declared, taken, others in units of 2^-52: {errors:?}");
        assert!(errors[1] <= FACTOR * errors[0] + FLOOR, "round {round}: {errors:?}");
    }
    derivation
}
