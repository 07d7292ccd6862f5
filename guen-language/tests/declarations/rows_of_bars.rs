//! Many loops in a row, and long chains: the work of a derivation and the operations of its program grow with their number and not with
//! a power of it.

use crate::common::{derived, derived_without, evaluated};
use guen_language::derive::{DerivedSystem, function};
use guen_symbolic::SymbolId;
use nalgebra::{DMatrix, DVector};

use crate::families::chains::{self, Angles};
use crate::families::{bars, robots};

const G: f64 = 9.81;

/// A number between -1 and 1 for a name.
fn draw(name: &str) -> f64 {
    (7.3 * (1.0 + name.bytes().fold(0.0, |sum, byte| 1.7 * sum + f64::from(byte)))).sin()
}

/// The rates of the program where symbols have these values.
fn rates(derived: &DerivedSystem<'_>, value: &dyn Fn(&str) -> f64) -> Vec<f64> {
    let graph = &derived.model.bench.graph;
    let named = |symbol: SymbolId| value(&graph.symbol_info(symbol).name);
    evaluated(&derived.system, function::RHS, named).unwrap()
}

/// `M x'' = f + J^T lambda`, `J x'' = -d`: the accelerations of coordinates that are all free.
fn by_multipliers(
    mass: &DMatrix<f64>,
    force: &DVector<f64>,
    rows: &DMatrix<f64>,
    drift: &DVector<f64>,
) -> Vec<f64> {
    let (n, m) = (mass.nrows(), rows.nrows());
    let mut all = DMatrix::zeros(n + m, n + m);
    all.view_mut((0, 0), (n, n)).copy_from(mass);
    all.view_mut((0, n), (n, m)).copy_from(&-rows.transpose());
    all.view_mut((n, 0), (m, n)).copy_from(rows);
    let mut right = DVector::zeros(n + m);
    right.rows_mut(0, n).copy_from(force);
    right.rows_mut(n, m).copy_from(&-drift);
    all.lu().solve(&right).unwrap().as_slice()[..n].to_vec()
}

/// The velocities of which the first combination is one and the others vanish.
fn velocities(first: &[f64], rows: &DMatrix<f64>, turn: f64) -> Vec<f64> {
    let n = first.len();
    let mut all = DMatrix::zeros(n, n);
    all.row_mut(0).copy_from_slice(first);
    all.rows_mut(1, n - 1).copy_from(rows);
    let mut right = DVector::zeros(n);
    right[0] = turn;
    all.lu().solve(&right).unwrap().as_slice().to_vec()
}

fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().fold(1.0, |size: f64, e| size.max(e.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-9 * size, "{found:?}\n{expected:?}");
    }
}

/// What bars of angles `q` are by multipliers. A place is a sum of bars, each with the coordinate of its angle and its length.
fn expected_in_angles(loops: usize, q: &[f64], turn: f64) -> Vec<f64> {
    let n = q.len();
    let (upright, bar) = (|i: usize| i, |i: usize| loops + i);
    let mut centers: Vec<Vec<(usize, f64)>> = (0..=loops).map(|i| vec![(upright(i), 0.5)]).collect();
    centers.extend((1..=loops).map(|i| vec![(upright(i - 1), 1.0), (bar(i), 0.5)]));
    let closing: Vec<Vec<(usize, f64)>> =
        (1..=loops).map(|i| vec![(upright(i - 1), 1.0), (bar(i), 1.0), (upright(i), -1.0)]).collect();
    let mut rows = DMatrix::zeros(2 * loops, n);
    for (k, sum) in closing.iter().enumerate() {
        for (c, length) in sum {
            rows[(2 * k, *c)] -= length * q[*c].sin();
            rows[(2 * k + 1, *c)] += length * q[*c].cos();
        }
    }
    let mut first = vec![0.0; n];
    first[0] = 1.0;
    let v = velocities(&first, &rows, turn);
    let bias = |sum: &[(usize, f64)]| {
        let along =
            |of: fn(f64) -> f64| -> f64 { sum.iter().map(|(c, l)| -l * of(q[*c]) * v[*c] * v[*c]).sum() };
        [along(f64::cos), along(f64::sin)]
    };
    let mut drift = DVector::zeros(2 * loops);
    for (k, sum) in closing.iter().enumerate() {
        [drift[2 * k], drift[2 * k + 1]] = bias(sum);
    }
    let (mut mass, mut force) = (DMatrix::identity(n, n) / 12.0, DVector::zeros(n));
    for sum in &centers {
        let [x, y] = bias(sum);
        for (a, l) in sum {
            let (s, c) = q[*a].sin_cos();
            force[*a] += l * (s * x - c * (y + G));
            for (b, k) in sum {
                mass[(*a, *b)] += l * k * (q[*a] - q[*b]).cos();
            }
        }
    }
    let accelerations = by_multipliers(&mass, &force, &rows, &drift);
    [&v[..], &accelerations[..1]].concat()
}

/// What bars of which the tips are at `p` are by multipliers.
fn expected_in_points(loops: usize, p: &[f64], turn: f64) -> Vec<f64> {
    let n = p.len();
    let mut ends: Vec<[Option<usize>; 2]> = (0..=loops).map(|i| [None, Some(i)]).collect();
    ends.extend((1..=loops).map(|i| [Some(i - 1), Some(i)]));
    let place = |end: Option<usize>, foot: usize, axis: usize| match end {
        Some(i) => p[2 * i + axis],
        None => [foot as f64, 0.0][axis],
    };
    let mut rows = DMatrix::zeros(ends.len(), n);
    let (mut mass, mut force) = (DMatrix::zeros(n, n), DVector::zeros(n));
    for (k, [a, b]) in ends.iter().enumerate() {
        let foot = b.unwrap();
        for axis in 0..2 {
            let across = place(*b, foot, axis) - place(*a, foot, axis);
            for (end, sign) in [(a, -1.0), (b, 1.0)] {
                let Some(i) = end else { continue };
                rows[(k, 2 * i + axis)] += sign * across;
                mass[(2 * i + axis, 2 * i + axis)] += 1.0 / 3.0;
                if axis == 1 {
                    force[2 * i + 1] -= G / 2.0;
                }
            }
            if let (Some(i), Some(j)) = (a, b) {
                mass[(2 * i + axis, 2 * j + axis)] += 1.0 / 6.0;
                mass[(2 * j + axis, 2 * i + axis)] += 1.0 / 6.0;
            }
        }
    }
    let mut first = vec![0.0; n];
    [first[0], first[1]] = [-p[1], p[0]];
    let v = velocities(&first, &rows, turn);
    let speed = |end: Option<usize>, axis: usize| end.map_or(0.0, |i| v[2 * i + axis]);
    let drift =
        ends.iter().map(|[a, b]| (0..2).map(|axis| (speed(*b, axis) - speed(*a, axis)).powi(2)).sum());
    let drift = DVector::from_iterator(ends.len(), drift);
    let accelerations = by_multipliers(&mass, &force, &rows, &drift);
    [&v[..], &[p[0] * accelerations[1] - p[1] * accelerations[0]]].concat()
}

/// Checks bars in both descriptions: by angles at states of any shape, for what is derived there asks of velocities what the constraints
/// do, wherever they hold. Returns what both cost.
fn checked(loops: usize) -> [u32; 2] {
    let count = |derived: &DerivedSystem<'_>| {
        let cost = derived.system.program(function::RHS).unwrap().cost;
        cost.operations() + cost.sines + cost.calls
    };
    let turn = 0.7;
    let number = |name: &str| name[1..].parse::<f64>().unwrap_or(0.0);
    let angle = |name: &str| if name.starts_with('a') { 1.2 + 0.4 * draw(name) } else { 0.4 * draw(name) };
    let in_angles = derived(&bars::in_angles(loops), |derived| {
        let value = |name: &str| match name {
            "g" => G,
            "turn" => turn,
            name => angle(name),
        };
        let names = (0..=loops).map(|i| format!("a{i}")).chain((1..=loops).map(|i| format!("b{i}")));
        let q: Vec<f64> = names.map(|name| angle(&name)).collect();
        assert_close(&rates(derived, &value), &expected_in_angles(loops, &q, turn));
        count(derived)
    });
    // On the constraints the bars are parallel.
    let (s, c) = 0.9_f64.sin_cos();
    let coordinate = |name: &str| if name.starts_with('x') { number(name) + c } else { s };
    let in_points = derived(&bars::in_points(loops), |derived| {
        let value = |name: &str| match name {
            "g" => G,
            "turn" => turn,
            name => coordinate(name),
        };
        let p: Vec<f64> = (0..=loops)
            .flat_map(|i| [format!("x{i}"), format!("y{i}")])
            .map(|name| coordinate(&name))
            .collect();
        assert_close(&rates(derived, &value), &expected_in_points(loops, &p, turn));
        count(derived)
    });
    [in_angles, in_points]
}

#[test]
fn loops_cost_each_what_the_others_do() {
    let [few, many] = [checked(2), checked(6)];
    for (few, many) in few.into_iter().zip(many) {
        assert!(many < 4 * few, "{few} operations, and {many} for three times as many loops");
    }
}

#[test]
#[ignore = "takes minutes without optimisation; `.ci/run` runs it in a release build"]
fn forty_loops_are_derived() {
    let [in_angles, in_points] = checked(40);
    // 2,632 and 4,325 as this is written.
    assert!(in_angles <= 2_700 && in_points <= 4_500, "{in_angles}, {in_points}");
}

/// Bars that stay parallel: `((n+1)/3 + n) a'' = -g cos(a) ((n+1)/2 + n)`.
#[test]
fn parallel_bars_turn_as_one_does() {
    let loops = 3;
    let n = loops as f64;
    let a: f64 = 0.9;
    let expected = -G * a.cos() * ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n);
    let by_name = |name: &str| match name.as_bytes()[0] {
        b'g' => G,
        b't' => 0.7,
        b'a' => a,
        b'b' => 0.0,
        b'x' => name[1..].parse::<f64>().unwrap() + a.cos(),
        _ => a.sin(),
    };
    for text in [bars::in_angles(loops), bars::in_points(loops)] {
        let found = derived(&text, |derived| *rates(derived, &by_name).last().unwrap());
        assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
    }
}

/// A chain that is too long to be multiplied out in relative angles has the accelerations that it has in absolute ones.
#[test]
fn a_long_chain_of_relative_angles_is_that_of_absolute_ones() {
    let links = 24;
    let bend = |i: usize| 0.5 * draw(&format!("bend{i}"));
    let rate = |i: usize| draw(&format!("rate{i}"));
    let found = [Angles::Absolute, Angles::Relative].map(|angles| {
        let sum = |of: &dyn Fn(usize) -> f64, i: usize| match angles {
            Angles::Relative => of(i),
            Angles::Absolute => (1..=i).map(of).sum(),
        };
        derived(&chains::declaration("Chain", links, angles), |derived| {
            let value = |name: &str| match (name.as_bytes()[0], name[1..].parse::<usize>()) {
                (b'q', Ok(i)) => sum(&bend, i),
                (b'w', Ok(i)) => sum(&rate, i),
                (b'g', _) => G,
                _ => 1.25,
            };
            assert!(derived.system.derivation.is_by("constraint forces"));
            rates(derived, &value)[links..].to_vec()
        })
    });
    let [absolute, relative] = found;
    let summed: Vec<f64> = (1..=links).map(|i| relative[..i].iter().sum()).collect();
    assert_close(&summed, &absolute);
}

/// A load on a cable: the body at the end of a chain has three rates and six forms, its spins and the speed of its centre relative to the hook.
/// Its rates by the reactions between the forms are those of the mass matrix.
#[test]
fn a_load_on_a_cable_moves_as_by_its_mass_matrix() {
    let text = robots::crane(3);
    let rates_of = |derived: &DerivedSystem<'_>| -> Vec<Vec<f64>> {
        (0..5).map(|k| rates(derived, &|name| 0.2 + draw(&format!("{name}{k}")).abs())).collect()
    };
    let found = derived(&text, |derived| {
        assert!(derived.system.derivation.is_by("constraint forces"));
        rates_of(derived)
    });
    let expected = derived_without(&text, |name| name == "constraint forces", rates_of);
    for (found, expected) in found.iter().zip(&expected) {
        assert_close(found, expected);
    }
}

#[test]
fn a_crane_grows_with_its_cable() {
    let [short, middle, long] = [4, 8, 12].map(|n| {
        derived(&robots::crane(n), |derived| derived.system.program(function::RHS).unwrap().cost.operations())
    });
    assert!(long - middle < 2 * (middle - short) && long < 1600, "{short} {middle} {long}");
}
