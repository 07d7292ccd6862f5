//! Reduced bases against the motion in coordinates on the leaf that were made by hand.

use guen::control::{Component, ReduceError};

use crate::jacobians::{Hoop, hoop, numbers};
use crate::vehicles::{robot, small_robot, train};

guen::mechanical_system! {
    /// A heavy top about a fixed point, in quaternions.
    pub system Top {
        constants { A > 0, C > 0, weight > 0 }
        inputs { torque }
        coordinates { w, i, j, k }
        let R = quaternion(w, i, j, k);
        bodies { top { inertia: diag(A, A, C), orientation: R } }
        potential_energy = weight*R.z.z;
        parameters { spin = angular_velocity_body(R); }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
        forces { torque along spin_x; }
    }
}

/// Central differences of a vector function.
fn differences<const N: usize, const P: usize>(
    at: [f64; N],
    f: impl Fn(&[f64; N]) -> [f64; P],
) -> [[f64; N]; P] {
    let h = 1e-5;
    let columns: [[f64; P]; N] = std::array::from_fn(|j| {
        let moved = |by: f64| {
            let mut x = at;
            x[j] += by;
            f(&x)
        };
        let (above, below) = (moved(h), moved(-h));
        std::array::from_fn(|i| (above[i] - below[i]) / (2.0 * h))
    });
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

fn assert_matrix<const N: usize, const P: usize>(found: &[[f64; N]; P], expected: &[[f64; N]; P]) {
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        for (j, (a, b)) in a.iter().zip(b).enumerate() {
            assert!((a - b).abs() < 1e-8 * (1.0 + b.abs()), "({i}, {j}): {a} and {b}");
        }
    }
}

/// Far from any equilibrium: the height of the hoop is a sine of its tilt, and leaves the basis.
#[test]
fn the_hoop_without_its_height() {
    const { assert!(hoop::REDUCED == 8) }
    let system = Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
    let mut state = numbers::<9>(3);
    state[0] += 1.5;
    state[5] = 0.7 * state[0].sin();
    let reduced = system.reduce(0.0, &state.into(), &["theta"]).unwrap();
    assert!(!reduced.components.contains(&Component::Coordinate(5)), "{:?}", reduced.components);
    assert_eq!(reduced.names, ["theta", "psi", "phi", "xi", "eta", "eta1", "eta2", "eta3"]);
    assert_eq!((reduced.place("eta2"), reduced.place("zeta")), (Some(6), None));
    let z = [0, 1, 2, 3, 4, 6, 7, 8];
    let rates = |z_values: &[f64; 8]| {
        let mut s = state;
        z.iter().zip(z_values).for_each(|(place, value)| s[*place] = *value);
        s[5] = 0.7 * s[0].sin();
        let rates: [f64; 9] = system.rhs(0.0, &s.into()).into();
        z.map(|place| rates[place])
    };
    assert_matrix(&reduced.linear.a, &differences(z.map(|place| state[place]), rates));
    assert_eq!(reduced.rates, rates(&z.map(|place| state[place])));
    // The other way round the tilt follows from the height.
    let by_height = system.reduce(0.0, &state.into(), &["zeta"]).unwrap();
    assert!(by_height.components.contains(&Component::Coordinate(5)));
    assert!(!by_height.components.contains(&Component::Coordinate(0)));
    // A step along the basis stays on the leaf to first order, and its components come back.
    let dz = numbers::<8>(4);
    let lifted = by_height.lift(&dz);
    assert!((lifted[5] - 0.7 * state[0].cos() * lifted[0]).abs() < 1e-14);
    let back = by_height.project(&lifted);
    assert!(back.iter().zip(&dz).all(|(a, b)| (a - b).abs() < 1e-14));
}

#[test]
fn too_many_independent_names() {
    let system = Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
    let state = hoop::State { theta: 1.0, ..Default::default() };
    let found = system.reduce(0.0, &state, &["theta", "zeta"]);
    assert_eq!(found.unwrap_err(), ReduceError::Dependent { rank: 0, needed: 1 });
    let found = system.reduce(0.0, &state, &["eta1"]);
    assert_eq!(found.unwrap_err(), ReduceError::UnknownCoordinate { name: "eta1" });
}

/// The wheels' angles follow from the path and the heading only in sum: one combination is integrable.
#[test]
fn the_robot_loses_one_wheel() {
    const { assert!(robot::REDUCED == 8 && train::REDUCED == 8) }
    let (t, state) = (0.0, robot::State::from(numbers::<9>(5)));
    let inputs = robot::Inputs { left_torque: 0.3, right_torque: -0.2 };
    let system = small_robot();
    let reduced = system.reduce(t, &state, &inputs, &["x", "y", "heading", "tilt", "left"]).unwrap();
    let z = [0, 1, 2, 3, 4, 6, 7, 8];
    // left - right = const + 2 b heading/r, b = 0.3 and r = 0.1, up to a sign. No rate depends on a wheel's angle, so
    // that what is left are rows and columns of the full matrices.
    let full = system.linearize(t, &state, &inputs);
    assert_matrix(&reduced.linear.a, &z.map(|i| z.map(|j| full.a[i][j])));
    assert_matrix(&reduced.linear.b, &z.map(|i| full.b[i]));
    let mut turned = [0.0; 8];
    turned[2] = 1.0;
    let slope = reduced.lift(&turned)[5];
    let velocities = system.velocities(t, &state);
    assert!((slope - (velocities.right - velocities.left) / state.turn).abs() < 1e-12);
    assert!((slope.abs() - 6.0).abs() < 1e-12);
}

/// A turning top: three rotation components in place of four coordinates, in a frame that turns with it.
#[test]
fn a_top_in_quaternions() {
    const { assert!(top::REDUCED == 6) }
    let system = Top { A: 1.2, C: 0.7, weight: 3.0 }.prepare().unwrap();
    let mut s = numbers::<7>(6);
    let norm = s[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
    s[..4].iter_mut().for_each(|q| *q /= norm);
    let inputs = top::Inputs { torque: 0.4 };
    let state = top::State::from(s);
    let reduced = system.reduce(0.0, &state, &inputs, &[]).unwrap();
    let rotation = |axis| Component::Rotation { quaternion: 0, axis };
    assert_eq!(reduced.components[..3], [rotation(0), rotation(1), rotation(2)]);
    assert_eq!(
        reduced.names.map(|name| name.to_string())[..4],
        ["rotation_x(w)", "rotation_y(w)", "rotation_z(w)", "spin_x"]
    );
    assert_eq!((reduced.place("rotation_y(w)"), reduced.place("rotation_y(i)")), (Some(1), None));

    let base: [f64; 4] = [s[0], s[1], s[2], s[3]];
    let product = |[a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]| {
        [
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        ]
    };
    let conjugate = |[w, x, y, z]: [f64; 4]| [w, -x, -y, -z];
    let base_rate = system.velocities(0.0, &state);
    let base_rate = [base_rate.w, base_rate.i, base_rate.j, base_rate.k];
    // z = (theta, spin): q = base (1 + theta/2)/|..|, and theta = 2 Im(base* q).
    let rates = |z: &[f64; 6]| {
        let turn = [1.0, z[0] / 2.0, z[1] / 2.0, z[2] / 2.0];
        let length = turn.iter().map(|q| q * q).sum::<f64>().sqrt();
        let q = product(base, turn.map(|q| q / length));
        let moved: [f64; 7] = [q[0], q[1], q[2], q[3], z[3], z[4], z[5]];
        let rate: [f64; 7] = system.rhs(0.0, &moved.into(), &inputs).into();
        let own = product(conjugate(base), [rate[0], rate[1], rate[2], rate[3]]);
        let frame = product(conjugate(base_rate), q);
        let theta: [f64; 3] = std::array::from_fn(|k| 2.0 * (own[k + 1] + frame[k + 1]));
        [theta[0], theta[1], theta[2], rate[4], rate[5], rate[6]]
    };
    let at = [0.0, 0.0, 0.0, s[4], s[5], s[6]];
    assert_matrix(&reduced.linear.a, &differences(at, rates));
    assert!(reduced.linear.b[3][0] > 0.0);
}
