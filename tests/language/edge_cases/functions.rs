//! Every function of the language, in energies and forces, and numbers far from one.

use super::assert_near;
use guen::prelude::*;

guen::mechanical_system! {
    /// A particle under forces of all kinds.
    pub system Kinds {
        constants { h = 6.62607015e-34, big = 1.5e30, third = 1/3, half = 0.5 }
        inputs { u }
        coordinates { x, y }
        parameters { v = dot(x); w = dot(y); }
        kinetic_energy = 1/2*(v^2 + w^2);
        potential_energy = ln(2 + x^2) + cosh(x/2)*exp(-y) + atan(y) + sinh(x*y/5) + (1 + x^2)^(3/2) + abs(y)^(1/3);
        forces {
            -sqrt(v^2 + w^2)*v - tanh(10*v) + sign(w)*third along v;
            -abs(w)*w + atan2(y, x) + asin(x/4) - acos(y/4) + u*tan(half*x) along w;
            h*big*6e3*cot(y) along dot(x*y);
        }
        outputs { power = (v^2 + w^2).sqrt().powi(3); negative = -x^2; tower = 2^-1; }
    }
}

fn expected(s: &kinds::State, u: f64) -> (f64, f64) {
    let kinds::State { x, y, v, w } = *s;
    let potential_x = 2.0 * x / (2.0 + x * x)
        + 0.5 * (x / 2.0).sinh() * (-y).exp()
        + y / 5.0 * (x * y / 5.0).cosh()
        + 3.0 * x * (1.0 + x * x).sqrt();
    let potential_y = -(x / 2.0).cosh() * (-y).exp()
        + 1.0 / (1.0 + y * y)
        + x / 5.0 * (x * y / 5.0).cosh()
        + y.signum() / 3.0 * y.abs().powf(-2.0 / 3.0);
    let speed = (v * v + w * w).sqrt();
    let both = 6.62607015e-34 * 1.5e30 * 6e3 / y.tan();
    let along_v = -speed * v - (10.0 * v).tanh() + w.signum() / 3.0;
    let along_w = -w.abs() * w + y.atan2(x) + (x / 4.0).asin() - (y / 4.0).acos() + u * (0.5 * x).tan();
    (along_v - potential_x + both * y, along_w - potential_y + both * x)
}

#[test]
fn all_functions() {
    let system = Kinds::default().prepare().unwrap();
    for (k, sign) in [(1.0, 1.0), (2.0, -1.0), (3.0, 1.0), (0.5, -1.0)] {
        let state = kinds::State { x: 0.4 * k, y: sign * (0.9 - 0.2 * k), v: 0.3 - 0.2 * k, w: sign * 0.7 };
        let rate = system.rhs(0.0, &state, &kinds::Inputs { u: 1.3 });
        let (along_x, along_y) = expected(&state, 1.3);
        assert_near(rate.v, along_x, 1e-13);
        assert_near(rate.w, along_y, 1e-13);
        let outputs = system.outputs(0.0, &state, &kinds::Inputs { u: 1.3 });
        assert_near(outputs.power, (state.v * state.v + state.w * state.w).powf(1.5), 1e-14);
        assert_near(outputs.negative, -state.x * state.x, 1e-15);
        assert_eq!(outputs.tower, 0.5);
    }
}

/// Differentiated: the linearisation of all of them against central differences.
#[test]
fn all_derivatives() {
    let system = Kinds::default().prepare().unwrap();
    let (state, inputs) = ([0.7, -0.6, 0.4, -0.8], kinds::Inputs { u: 1.3 });
    let found = system.linearize(0.0, &state.into(), &inputs).a;
    const H: f64 = 1e-6;
    for j in 0..4 {
        let at = |h: f64| {
            let mut moved = state;
            moved[j] += h;
            system.driven(inputs).rhs(0.0, &moved)
        };
        let (ahead, behind) = (at(H), at(-H));
        for i in 0..4 {
            let slope = (ahead[i] - behind[i]) / (2.0 * H);
            assert!((found[i][j] - slope).abs() < 1e-7 * (1.0 + slope.abs()), "a[{i}][{j}]: {slope}");
        }
    }
}
