//! The rolling disc of SymPy's tests of Kane's method, whose equations are printed there in closed form.

use super::close;

guen::mechanical_system! {
    pub system Disc {
        constants { m > 0, r > 0, g = 9.81 }
        coordinates { yaw, lean, spin, x, y }
        let L = rot_z(yaw)*rot_x(lean);
        let center = vec(x, y, 0) + r*L.z;
        bodies { disc { mass: m, inertia: diag(m*r^2/4, m*r^2/2, m*r^2/4), center: center, orientation: L*rot_y(spin) } }
        gravity = vec(0, 0, -g);
        parameters {
            u1 = inner(L.x, disc.angular_velocity);
            u2 = inner(L.y, disc.angular_velocity);
            u3 = inner(L.z, disc.angular_velocity);
        }
        constraints { rolling: disc.velocity_at(vec(x, y, 0)) = 0; }
    }
}

#[test]
fn rolling_disc_has_the_rates_that_are_printed() {
    let (r, g) = (0.7, 9.81);
    let system = Disc { m: 1.3, r, g }.prepare().unwrap();
    let mut numbers = guen_benchmarks::Random::new(7);
    for _ in 0..50 {
        let mut number = || numbers.between(-1.0, 1.0);
        let (lean, u1, u2, u3) = (number(), 5.0 * number(), 5.0 * number(), 5.0 * number());
        let state = disc::State { yaw: number(), lean, spin: number(), u1, u2, u3, ..Default::default() };
        let rate = system.rhs(0.0, &state);
        let printed = [
            (4.0 * g * lean.sin() + 6.0 * r * u2 * u3 - r * u3 * u3 * lean.tan()) / (5.0 * r),
            -2.0 / 3.0 * u1 * u3,
            (-2.0 * u2 + u3 * lean.tan()) * u1,
        ];
        close("rates", &[rate.u1, rate.u2, rate.u3], &printed, 10.0, 1e-14);
    }
}

#[test]
fn rolling_disc_is_stable_above_its_critical_spin() {
    // With m = r = g = 1 the upright disc that rolls straight is stable from a spin of 1/sqrt(3) on.
    let system = Disc { m: 1.0, r: 1.0, g: 1.0 }.prepare().unwrap();
    let critical = 1.0 / 3.0_f64.sqrt();
    let fastest = |spin: f64| {
        let a = system.linearize(0.0, &disc::State { u2: spin, ..Default::default() }).a;
        let values = nalgebra::SMatrix::<f64, 8, 8>::from_fn(|i, j| a[i][j]).complex_eigenvalues();
        values.iter().map(|value| value.re).fold(0.0, f64::max)
    };
    assert!(fastest(0.99 * critical) > 0.05 && fastest(1.01 * critical) < 1e-6);
}
