//! A chain of more links than equations are written out for, beside its dense equations in numbers.

use std::thread;

use guen::prelude::*;

use super::{angles_and_rates, lengths, masses};
use guen::{Bodies, mechanical_system};

mechanical_system! {
    /// A chain of a hundred links, each with a mass and a length of its own.
    pub system Chain {
        count n = 100;
        constants   { m[n] > 0, l[n] > 0, c >= 0, g = 9.81 }
        coordinates { q[n] }
        let p[0] = l[0]*vec(sin(q[0]), -cos(q[0]));
        for i in 1..n { let p[i] = p[i-1] + l[i]*vec(sin(q[i]), -cos(q[i])); }
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        particles  { for i in 0..n { m[i] at p[i]; } }
        forces     { for i in 1..n { -c*(w[i] - w[i-1]) along w[i] - w[i-1]; } }
        gravity = vec(0, -g);
        outputs { tip = p[n-1]; }
    }
}

mechanical_system! {
    /// Masses in a row, each on a spring to the one before.
    pub system Row {
        count n = 40;
        constants { m[n] > 0, k > 0 }
        coordinates { x[n] }
        parameters { for i in 0..n { v[i] = dot(x[i]); } }
        kinetic_energy = sum(i in 0..n: m[i]/2*dot(x[i])^2);
        potential_energy = k/2*x[0]^2 + sum(i in 1..n: k/2*(x[i] - x[i-1])^2);
    }
}

const N: usize = 100;

fn constants(c: f64) -> Chain {
    Chain { m: masses(), l: lengths(0.05), c, g: 9.81 }
}

fn start() -> chain::State {
    let [q, w] = angles_and_rates();
    chain::State { q, w }
}

/// The accelerations by Lagrange's equations, `sum_j M_ij w_j' = Q_i`, with `M_ij = mu_ij l_i l_j cos(q_i - q_j)`, where `mu_ij` is the mass that
/// hangs on both links.
fn dense(Chain { m, l, c, g }: &Chain, chain::State { q, w }: &chain::State) -> Vec<f64> {
    let hanging: Vec<f64> = (0..N).map(|i| m[i..].iter().sum()).collect();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for i in 0..N {
        let mut force = -hanging[i] * g * l[i] * q[i].sin();
        let mut row = Vec::new();
        for j in 0..N {
            let coupling = hanging[i.max(j)] * l[i] * l[j];
            row.push(coupling * (q[i] - q[j]).cos());
            force -= coupling * (q[i] - q[j]).sin() * w[j] * w[j];
        }
        if i > 0 {
            force -= c * (w[i] - w[i - 1]);
        }
        if i + 1 < N {
            force += c * (w[i + 1] - w[i]);
        }
        row.push(force);
        rows.push(row);
    }
    // Gauss's elimination of a positive definite matrix.
    for k in 0..N {
        let (above, below) = rows.split_at_mut(k + 1);
        let pivot = &above[k];
        for row in below {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(pivot).skip(k).for_each(|(a, b)| *a -= factor * b);
        }
    }
    let mut found = vec![0.0; N];
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|j| rows[i][j] * found[j]).sum();
        found[i] = (rows[i][N] - known) / rows[i][i];
    }
    found
}

#[test]
fn rates_are_those_of_the_dense_equations() {
    let (chain, state) = (constants(0.03), start());
    let expected = dense(&chain, &state);
    let rates = chain.prepare().unwrap().rhs(0.0, &state);
    let largest = expected.iter().fold(0.0_f64, |largest, a| largest.max(a.abs()));
    for (own, other) in rates.w.iter().zip(&expected) {
        // The elimination of 100 rows loses some four digits.
        assert!((own - other).abs() < 1e-10 * largest, "{own} {other}");
    }
    assert_eq!(rates.q, state.w);
}

#[test]
fn a_hundred_links_run_in_a_thread_of_two_megabytes() {
    let run = || {
        let chain = constants(0.0).prepare().unwrap();
        let start = start();
        let before = chain.energy(0.0, &start);
        let steps = Integration::new(&chain, 0.0, &start.into()).run(&Rk4::new(1e-5), 0.002).unwrap();
        let bounded =
            Integration::new(&chain, 0.0, &start.into()).run(&Dop853::new(1e-10, 1e-10), 0.01).unwrap();
        for state in [steps.state, bounded.state] {
            let after = chain.energy(0.0, &chain::State::from(state));
            assert!((after - before).abs() < 1e-8 * before.abs(), "{before} {after}");
        }
    };
    thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap().join().unwrap();
}

#[test]
fn a_large_sparse_linearisation_has_its_entries_in_their_places() {
    const MASSES: usize = 40;
    let m = std::array::from_fn(|i| 1.0 + 0.1 * i as f64);
    let row = Row { m, k: 3.0 }.prepare().unwrap();
    assert!(row::LINEARIZATION_COST.is_some());
    let a = row.linearize(0.0, &row::State::default()).a;
    for (i, line) in a.iter().enumerate() {
        for (j, entry) in line.iter().enumerate() {
            let expected = match (i.checked_sub(MASSES), j) {
                (None, j) => f64::from(u8::from(j == i + MASSES)),
                (Some(_), MASSES..) => 0.0,
                (Some(mass), j) if j == mass => -3.0 * if mass + 1 < MASSES { 2.0 } else { 1.0 } / m[mass],
                (Some(mass), j) if j.abs_diff(mass) == 1 => 3.0 / m[mass],
                _ => 0.0,
            };
            assert!((entry - expected).abs() < 1e-14, "{i} {j}: {entry} {expected}");
        }
    }
}

#[test]
fn long_arrays_go_through_files() {
    let m = std::array::from_fn(|i| 1.0 + 0.1 * i as f64);
    let row = Row { m, k: 3.0 };
    let text = serde_json::to_string(&row).unwrap();
    assert!(text.starts_with(r#"{"m":[1.0,1.1,"#) && text.ends_with(r#""k":3.0}"#), "{text}");
    assert_eq!(serde_json::from_str::<Row>(&text).unwrap(), row);
    let state = start();
    let text = serde_json::to_string(&state).unwrap();
    assert_eq!(serde_json::from_str::<chain::State>(&text).unwrap(), state);
    let short = r#"{"m":[1.0],"k":3.0}"#;
    assert!(serde_json::from_str::<Row>(short).is_err());
}

#[test]
fn every_particle_of_a_long_chain_is_a_body() {
    let (system, state) = (constants(0.0), start());
    let prepared = system.prepare().unwrap();
    let bodies = prepared.bodies(0.0, &state.into());
    let mut place = [0.0, 0.0];
    for (i, body) in bodies.iter().enumerate() {
        place = [place[0] + system.l[i] * state.q[i].sin(), place[1] - system.l[i] * state.q[i].cos()];
        assert_eq!((body.name, body.mass), (format!("particle {}", i + 1).as_str(), Some(system.m[i])));
        let center = body.center.unwrap();
        assert!((center[0] - place[0]).abs() < 1e-12 && (center[1] - place[1]).abs() < 1e-12, "{i}");
        assert_eq!(center[2], 0.0);
    }
}
