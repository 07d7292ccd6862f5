//! The stiff flyball governor of the IFToMM library of multibody benchmarks (A05): a turning shaft, two arms with balls that hang from its top, a
//! slider on the shaft, and from the slider to each arm's middle a spring with a damper, whose relaxation takes a ten-thousandth of a second.
//! The library has its results as curves; the digits come from an independent integration in 45 digits, `tests/data/governor.py`.

use super::close;
use guen::prelude::*;

guen::mechanical_system! {
    /// Four degrees of freedom: both arms swing for themselves.
    pub system Governor {
        constants { k > 0 = 8e5, c >= 0 = 4e4, d = 0.5, g = 9.81 }
        coordinates { phi, one, two, z }
        let shaft = rot_z(phi);
        let right = shaft*rot_y(-one);
        let left = shaft*rot_y(two);
        let right_hinge = shaft*vec(0.05, 0, 1);
        let left_hinge = shaft*vec(-0.05, 0, 1);
        let half = vec(0, 0, -1/2);
        let right_coupler = right_hinge + right*half - shaft*vec(0.05, 0, z);
        let left_coupler = left_hinge + left*half - shaft*vec(-0.05, 0, z);
        let right_length = sqrt(inner(right_coupler, right_coupler));
        let left_length = sqrt(inner(left_coupler, left_coupler));
        bodies {
            axle   { inertia: diag(5e-6, 5e-6, 5e-6), orientation: shaft }
            slider { mass: 3, inertia: diag(0.005, 0.005, 0.005), center: vec(0, 0, z), orientation: shaft }
            first  { mass: 0.3, inertia: diag(0.0250025, 0.0250025, 5e-6), center: right_hinge + right*half, orientation: right }
            second { mass: 0.3, inertia: diag(0.0250025, 0.0250025, 5e-6), center: left_hinge + left*half, orientation: left }
        }
        particles { 5 at right_hinge + 2*right*half; 5 at left_hinge + 2*left*half; }
        gravity = vec(0, 0, -g);
        potential_energy = k/2*(right_length - d)^2 + k/2*(left_length - d)^2;
        parameters { spin = dot(phi); swing_one = dot(one); swing_two = dot(two); rise = dot(z); }
        forces {
            -c*dot(right_length) along dot(right_length);
            -c*dot(left_length) along dot(left_length);
        }
    }
}

#[test]
fn flyball_governor_moves_as_computed_in_45_digits() {
    let text = include_str!("../../data/governor.txt");
    let rows: Vec<[f64; 6]> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let governor = Governor::default().prepare().unwrap();
    let angle = core::f64::consts::FRAC_PI_3;
    let spin = core::f64::consts::TAU;
    let start = governor::State { one: angle, two: angle, z: 0.5, spin, ..Default::default() };
    let mut seen = 0;
    Integration::new(&governor, 0.0, &start.into())
        .sample(&times, &mut |k, _, state| {
            let [_, angle, z, swing, rise, phi] = rows[k];
            let found: governor::State = (*state).into();
            let expected = [angle, angle, z, swing, swing, rise, phi];
            let governor::State { phi, one, two, z, swing_one, swing_two, rise, .. } = found;
            close("state", &[one, two, z, swing_one, swing_two, rise, phi], &expected, 1.0, 1e-9);
            seen += 1;
        })
        .run(&Radau5::new(1e-11, 1e-11), 10.0)
        .unwrap();
    assert_eq!(seen, rows.len());
}
