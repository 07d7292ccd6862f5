//! A chain of a thousand links: its rates balance every link.

use std::thread;

use guen::mechanical_system;
use guen::prelude::*;

use super::{angles_and_rates, lengths, masses};

mechanical_system! {
    /// A chain of a thousand links, each with a mass and a length of its own.
    pub system Thousand {
        count n = 1000;
        constants   { m[n] > 0, l[n] > 0 = 0.01, c >= 0, g = 9.81 }
        coordinates { q[n] }
        let p[0] = l[0]*vec(sin(q[0]), -cos(q[0]));
        for i in 1..n { let p[i] = p[i-1] + l[i]*vec(sin(q[i]), -cos(q[i])); }
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        particles  { for i in 0..n { m[i] at p[i]; } }
        forces     { for i in 1..n { -c*(w[i] - w[i-1]) along w[i] - w[i-1]; } }
        gravity = vec(0, -g);
    }
}

const N: usize = 1000;

/// Debug builds keep many copies of a state of 2,000 numbers, and of 13,000 prepared values.
const STACK: usize = 8 << 20;

fn in_a_thread(run: fn()) {
    thread::Builder::new().stack_size(STACK).spawn(run).unwrap().join().unwrap();
}

fn constants(c: f64) -> Thousand {
    Thousand { m: masses(), l: lengths(0.005), c, g: 9.81 }
}

fn start() -> thousand::State {
    let [q, w] = angles_and_rates();
    thousand::State { q, w }
}

/// d'Alembert: what hangs on a link, with its inertia, has no work on a turn of the link beside that of the dampers,
/// `l_i t_i sum_{k >= i} m_k (p_k'' - g) = Q_i`. The places are summed from the hinge, the forces from the tip.
#[test]
fn rates_of_a_thousand_links_balance_every_link() {
    in_a_thread(|| {
        let (system, state) = (constants(0.03), start());
        let rates = system.prepare().unwrap().rhs(0.0, &state);
        assert_eq!(rates.q, state.w);
        let mut places = vec![[0.0_f64, system.g]; N];
        let mut acceleration = [0.0, system.g];
        for (i, place) in places.iter_mut().enumerate() {
            let (sine, cosine) = state.q[i].sin_cos();
            let (turn, pull) = (system.l[i] * rates.w[i], system.l[i] * state.w[i] * state.w[i]);
            acceleration[0] += turn * cosine - pull * sine;
            acceleration[1] += turn * sine + pull * cosine;
            *place = acceleration;
        }
        let (mut force, mut size) = ([0.0; 2], 0.0);
        for i in (0..N).rev() {
            let (sine, cosine) = state.q[i].sin_cos();
            for (sum, a) in force.iter_mut().zip(places[i]) {
                *sum += system.m[i] * a;
                size += (system.m[i] * a).abs();
            }
            let mut torque = system.l[i] * (cosine * force[0] + sine * force[1]);
            if i > 0 {
                torque += system.c * (state.w[i] - state.w[i - 1]);
            }
            if i + 1 < N {
                torque -= system.c * (state.w[i + 1] - state.w[i]);
            }
            // The links below pull with thousands of newtons, of which a few remain.
            assert!(torque.abs() < 1e-10 * system.l[i] * size, "{i}: {torque} {size}");
        }
    });
}

#[test]
fn a_thousand_links_keep_their_energy() {
    in_a_thread(|| {
        let chain = constants(0.0).prepare().unwrap();
        let start = start();
        let before = chain.energy(0.0, &start);
        let steps = Integration::new(&chain, 0.0, &start.into()).run(&Rk4::new(1e-5), 1e-4).unwrap();
        let bounded =
            Integration::new(&chain, 0.0, &start.into()).run(&Dop853::new(1e-9, 1e-9), 1e-3).unwrap();
        for state in [steps.state, bounded.state] {
            let after = chain.energy(0.0, &thousand::State::from(state));
            assert!((after - before).abs() < 1e-7 * before.abs(), "{before} {after}");
        }
    });
}

#[test]
fn names_and_bounds_of_a_thousand_links_have_their_numbers() {
    in_a_thread(|| {
        let names = thousand::State::<f64>::NAMES;
        assert_eq!((names[0], names[9], names[999]), ("q[0]", "q[9]", "q[999]"));
        assert_eq!((names[1000], names[1999]), ("w[0]", "w[999]"));
        let mut system = constants(0.0);
        system.l[437] = -1.0;
        let error = system.prepare().map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("l[437] > 0"), "{error}");
        let mut system = constants(0.0);
        system.m[12] = f64::NAN;
        let error = system.prepare().map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("m[12]"), "{error}");
        let prepared = constants(0.25).prepare().unwrap();
        assert_eq!(prepared.constants(), constants(0.25));
    });
}
