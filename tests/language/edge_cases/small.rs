//! Next to nothing: no degree of freedom, one coordinate, no constants, no force.

use super::assert_near;
use guen::prelude::*;

guen::mechanical_system! {
    /// Everything is prescribed; what is left are the reactions.
    pub system Prescribed {
        constants { m > 0, g = 9.81 }
        coordinates { x, y }
        constraints {
            east: dot(x) = cos(t);
            north: dot(y) = 2*t*x;
        }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*y;
    }
}

guen::mechanical_system! {
    /// One coordinate, no constants, nothing else.
    pub system Free {
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
    }
}

guen::mechanical_system! {
    /// No constants, but numbers.
    pub system Oscillator {
        coordinates { q }
        parameters { p = 3*dot(q); }
        kinetic_energy = dot(q)^2/2;
        potential_energy = 2*q^2;
    }
}

#[test]
fn no_degree_of_freedom() {
    let m = 1.5;
    let system = Prescribed::new(m).prepare().unwrap();
    let (t, x, y) = (0.7_f64, 0.4, -0.3);
    let state = prescribed::State { x, y };
    let rates = system.rhs(t, &state);
    assert_near(rates.x, t.cos(), 1e-15);
    assert_near(rates.y, 2.0 * t * x, 1e-15);
    let reactions = system.reactions(t, &state);
    assert_near(reactions.east, -m * t.sin(), 1e-14);
    assert_near(reactions.north, m * (2.0 * x + 2.0 * t * t.cos()) + m * 9.81, 1e-14);
    // T° has no parameter: h = x' dT°/dx' - T° - U is the energy all the same.
    let energy = 0.5 * m * (t.cos().powi(2) + (2.0 * t * x).powi(2)) + m * 9.81 * y;
    assert_near(system.energy(t, &state), energy, 1e-14);
    assert_eq!(system.linearize(t, &state).a, [[0.0, 0.0], [2.0 * t, 0.0]]);
    assert_eq!(prescribed::GROWTH, [0]);
    assert_eq!(prescribed::INTEGRABLE, 2);
    let end = Integration::new(&system, 0.0, &[0.0, 0.0]).run(&Dop853::new(1e-13, 1e-13), 2.0).unwrap().state;
    assert_near(end[0], 2.0_f64.sin(), 1e-12);
    // The integral of 2 t sin(t).
    assert_near(end[1], 2.0 * (2.0_f64.sin() - 2.0 * 2.0_f64.cos()), 1e-12);
}

#[test]
fn one_coordinate_and_no_constants() {
    let system = Free::new().prepare().unwrap();
    assert_eq!(Free::<f64>::default(), Free::new());
    assert_eq!(system.rhs(0.0, &free::State { x: 3.0, v: 2.0 }), free::State { x: 2.0, v: 0.0 });
    assert_eq!(free::COST.total(), 0);
    let system: oscillator::Prepared<f32> = Oscillator::with_defaults::<f32>().prepare().unwrap();
    let rate = system.rhs(0.0, &oscillator::State { q: 0.5, p: 6.0 });
    assert_eq!((rate.q, rate.p), (2.0, -6.0));
}
