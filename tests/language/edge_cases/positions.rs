//! Constraints on positions that depend on time.

use super::assert_near;
use guen::prelude::*;

guen::mechanical_system! {
    /// A particle on a circle that grows: `x^2 + y^2 = (1 + t)^2`, without any force.
    pub system Growing {
        constants { m > 0 }
        coordinates { x, y }
        parameters { areal = x*dot(y) - y*dot(x); }
        holonomic { circle: x^2 + y^2 = (1 + t)^2; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
    }
}

guen::mechanical_system! {
    /// Two positions and one velocity constraint: a bead on a moving line in space.
    pub system Line {
        constants { k > 0 }
        coordinates { x, y, z }
        parameters { v = dot(x); }
        holonomic {
            plane: z = x*sin(t);
            wall: y + z = t^2;
        }
        kinetic_energy = 1/2*(dot(x)^2 + dot(y)^2 + dot(z)^2);
        potential_energy = k/2*x^2;
    }
}

/// The moment of momentum is kept: `x y' - y x' = const`, so the angle is `c (1 - 1/(1 + t))`; the pull is by hand.
#[test]
fn growing_circle() {
    let m = 0.7;
    let system = Growing::new(m).prepare().unwrap();
    let (t, c) = (2.0, 1.4);
    let start = growing::State { x: 1.0, y: 0.0, areal: c };
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-13, 1e-13), t).unwrap().state;
    let (sin, cos) = (c * (1.0 - 1.0 / (1.0 + t))).sin_cos();
    assert_near(end[0], (1.0 + t) * cos, 1e-12);
    assert_near(end[1], (1.0 + t) * sin, 1e-12);
    assert_near(end[2], c, 1e-14);
    assert!(system.residuals(t, &end.into()).circle.abs() < 1e-11);
    // m r'' - m r angle'^2 = 2 lambda r, with r = 1 + t and angle' = c / r^2.
    let lambda = -m * c * c / (2.0 * (1.0 + t).powi(4));
    assert_near(system.reactions(t, &end.into()).circle, lambda, 1e-12);
    const { assert!(growing::CLASS.is_holonomic() && !growing::SCLERONOMIC && !growing::CATASTATIC) };
    assert_eq!(growing::INTEGRABLE, 1);
}

/// With `z = x sin t` and `y = t^2 - z`, Lagrange's equation in `x` alone.
#[test]
fn moving_line() {
    let k = 3.0;
    let system = Line::new(k).prepare().unwrap();
    let (t, x, v) = (0.8_f64, 0.4, -0.7);
    let (sin, cos) = t.sin_cos();
    let state = line::State { x, y: t * t - x * sin, z: x * sin, v };
    // T = 1/2 (v^2 + (2 t - w)^2 + w^2), w = v sin + x cos.
    let w = v * sin + x * cos;
    let rates = system.rhs(t, &state);
    assert_near(rates.z, w, 1e-15);
    assert_near(rates.y, 2.0 * t - w, 1e-15);
    // d/dt (v + (2 w - 2 t) sin) - (2 w - 2 t) cos + k x = 0, w' = v' sin + 2 v cos - x sin.
    let acceleration = (-k * x - 2.0 * sin * (2.0 * v * cos - x * sin) + 2.0 * sin) / (1.0 + 2.0 * sin * sin);
    assert_near(rates.v, acceleration, 1e-14);
    let residuals = <[f64; 2]>::from(system.residuals(t, &state));
    assert!(residuals.iter().all(|r| r.abs() < 1e-15));
}
