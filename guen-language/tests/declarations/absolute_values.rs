//! Absolute values: at a point modulo p they are one of a number and its opposite, and in a state the other.

use crate::common::{derived, evaluated};
use guen_language::derive::function;
use guen_symbolic::SymbolId;

#[test]
fn loads_of_bodies_keep_their_signs() {
    let text = "pub system Bar {
        constants { m > 0, l > 0, I > 0, k > 0, stop }
        coordinates { q }
        let R = rot_z(q);
        bodies { bar { mass: m, inertia: diag(I, I, I), center: R*vec(l, 0, 0), orientation: R } }
        parameters { w = dot(q); }
        potential_energy = k*abs(q^3 - stop);
        forces { -k*abs(w)*w along w; }
    }";
    derived(text, |derived| {
        let graph = &derived.model.bench.graph;
        for (stop, w) in [(-3.0, 0.3), (-3.0, -0.3), (5.0, 0.3), (5.0, -0.3)] {
            let (m, l, inertia, k, q): (f64, f64, f64, f64, f64) = (1.3, 0.7, 0.2, 2.1, 0.9);
            let value = |symbol: SymbolId| match graph.symbol_info(symbol).name.as_str() {
                "m" => m,
                "l" => l,
                "I" => inertia,
                "k" => k,
                "stop" => stop,
                "q" => q,
                _ => w,
            };
            let rates = evaluated(&derived.system, function::RHS, value).unwrap();
            let slope = 3.0 * k * q * q * (q.powi(3) - stop).signum();
            let expected = (-slope - k * w.abs() * w) / (inertia + m * l * l);
            assert!((rates[1] - expected).abs() < 1e-13, "{rates:?} {expected}");
        }
    });
}
