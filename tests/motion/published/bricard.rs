//! Bricard's mechanism of the IFToMM library of multibody benchmarks (A04): five rods of a square section and the ground, six hinges at right
//! angles. The library has its results as curves; the digits come from an independent integration in 45 digits, `tests/data/bricard.py`.

use super::close;
use guen::prelude::*;
use guen::projected;

guen::mechanical_system! {
    /// Closed by five equations, of which one follows from the others.
    pub system Bricard {
        constants { g = 9.81 }
        coordinates { q1, q2, q3, q4, q5 }
        let R1 = rot_z(q1);
        let R2 = R1*rot_x(pi/2)*rot_z(q2);
        let R3 = R2*rot_x(-pi/2)*rot_z(q3);
        let R4 = R3*rot_x(pi/2)*rot_z(q4);
        let R5 = R4*rot_x(-pi/2)*rot_z(q5);
        let p2 = R1.x + R2.x;
        let p3 = p2 + R3.x;
        let p4 = p3 + R4.x;
        // A kilogramme and a metre, a side of a decimetre.
        bodies {
            one { mass: 1, inertia: diag(1/600, 1.01/12, 1.01/12), center: R1.x/2, orientation: R1 }
            two { mass: 1, inertia: diag(1/600, 1.01/12, 1.01/12), center: R1.x + R2.x/2, orientation: R2 }
            three { mass: 1, inertia: diag(1/600, 1.01/12, 1.01/12), center: p2 + R3.x/2, orientation: R3 }
            four { mass: 1, inertia: diag(1/600, 1.01/12, 1.01/12), center: p3 + R4.x/2, orientation: R4 }
            five { mass: 1, inertia: diag(1/600, 1.01/12, 1.01/12), center: p4 + R5.x/2, orientation: R5 }
        }
        gravity = vec(0, -g, 0);
        // All ways round the curve of its positions.
        parameters { v = sin(q1)*(1 + cos(q2))*dot(q2) - sin(q2)*(1 + cos(q1))*dot(q1); }
        holonomic {
            end: p4 + R5.x = vec(-1, 0, 0);
            across: R5.y.x = 0;
            side: R5.y.z = 0;
        }
    }
}

/// The rows of the file with the digits.
fn rows() -> Vec<[f64; 5]> {
    let text = include_str!("../../data/bricard.txt");
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect()
}

/// The rods along edges of a cube, from where they are let go.
pub(super) fn cube() -> bricard::State {
    let right = std::f64::consts::FRAC_PI_2;
    bricard::State { q1: right, q2: right, q3: right, q4: right, q5: right, v: 0.0 }
}

#[test]
fn bricard_s_mechanism_moves_as_computed_in_45_digits() {
    let rows = rows();
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let mechanism = Bricard::default().prepare().unwrap();
    let mut seen = 0;
    Integration::new(&projected(&mechanism), 0.0, &cube().into())
        .sample(&times, &mut |k, time, state| {
            let [_, first, second, first_rate, second_rate] = rows[k];
            close("angles", &state[..5], &[first, second, first, second, first], 1.0, 1e-10);
            let rates: [f64; 5] = mechanism.velocities(time, &(*state).into()).into();
            let expected = [first_rate, second_rate, first_rate, second_rate, first_rate];
            close("rates", &rates, &expected, 1.0, 1e-9);
            seen += 1;
        })
        .run(&Dop853::new(1e-13, 1e-13), 10.0)
        .unwrap();
    assert_eq!(seen, rows.len());
}

/// Where the cosines of all angles vanish nothing is divided by them. Half a unit of each angle is a unit of `v` there, by which the centres
/// fall with `1/2`; twice the energy is 1.2525, of which 0.0025 is that of the square sections.
#[test]
fn the_cube_is_no_place_to_divide_by_a_cosine() {
    let mechanism = Bricard::default().prepare().unwrap();
    let start = cube();
    close("v'", &[mechanism.rhs(0.0, &start).v], &[0.5 * 9.81 / 1.2525], 1.0, 1e-12);
    let rates: [f64; 5] = mechanism.velocities(0.0, &bricard::State { v: 1.0, ..start }).into();
    close("rates", &rates, &[-0.5, 0.5, -0.5, 0.5, -0.5], 1.0, 1e-12);
}
