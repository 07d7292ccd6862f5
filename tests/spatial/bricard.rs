//! Bricard's mechanism: five bars and the ground, six hinges at right angles. It closes by five equations, of which one follows
//! from the others wherever all hold, and so it moves.

use guen::PositionsError;
use guen::prelude::*;

use crate::by_hand::Numbers;

guen::mechanical_system! {
    /// Five uniform bars; each hinge is at right angles to both of its bars.
    pub system Bricard {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { q1, q2, q3, q4, q5 }
        let R1 = rot_z(q1);
        let R2 = R1*rot_x(pi/2)*rot_z(q2);
        let R3 = R2*rot_x(-pi/2)*rot_z(q3);
        let R4 = R3*rot_x(pi/2)*rot_z(q4);
        let R5 = R4*rot_x(-pi/2)*rot_z(q5);
        let p1 = l*R1.x;
        let p2 = p1 + l*R2.x;
        let p3 = p2 + l*R3.x;
        let p4 = p3 + l*R4.x;
        bodies {
            one { mass: m, inertia: diag(0, m*l^2/12, m*l^2/12), center: p1/2, orientation: R1 }
            two { mass: m, inertia: diag(0, m*l^2/12, m*l^2/12), center: p1 + l/2*R2.x, orientation: R2 }
            three { mass: m, inertia: diag(0, m*l^2/12, m*l^2/12), center: p2 + l/2*R3.x, orientation: R3 }
            four { mass: m, inertia: diag(0, m*l^2/12, m*l^2/12), center: p3 + l/2*R4.x, orientation: R4 }
            five { mass: m, inertia: diag(0, m*l^2/12, m*l^2/12), center: p4 + l/2*R5.x, orientation: R5 }
        }
        gravity = vec(0, -g, 0);
        // All ways round cos(q1) + cos(q2) + cos(q1)*cos(q2) = 0, of which the first hinge alone turns back.
        parameters { v = sin(q1)*(1 + cos(q2))*dot(q2) - sin(q2)*(1 + cos(q1))*dot(q1); }
        holonomic {
            end: p4 + l*R5.x = vec(-l, 0, 0);
            across: R5.y.x = 0;
            /// The last hinge lies in the plane of the first.
            side: R5.y.z = 0;
        }
    }
}

fn mechanism() -> bricard::Prepared {
    Bricard { m: 1.0, l: 1.0, g: 9.81 }.prepare().unwrap()
}

/// The bars along edges of a cube.
const CUBE: bricard::State = {
    let right = core::f64::consts::FRAC_PI_2;
    bricard::State { q1: right, q2: right, q3: right, q4: right, q5: right, v: 0.0 }
};

#[test]
fn one_equation_is_no_form_and_is_watched() {
    let text = "side is no form: it follows from end_x, end_y, end_z and across wherever all hold";
    assert!(bricard::REPORT.lines("Forms").iter().any(|line| line.starts_with(text)));
    let mechanism = mechanism();
    let bent = bricard::State { q2: 1.1, q3: 1.0, q4: 1.2, ..CUBE };
    let left = mechanism.residuals(0.0, &bent);
    assert!(left.side.abs() > 0.1, "{left:?}");
    assert!(mechanism.residual(0.0, &bent.into()) >= left.side.abs());
}

/// Energy and five equations at one degree of freedom leave no other motion.
#[test]
fn the_mechanism_moves_and_stays_closed() {
    let mechanism = mechanism();
    let energy = mechanism.energy(0.0, &CUBE);
    let (mut drift, mut gap, mut path) = (0.0_f64, 0.0_f64, 0.0_f64);
    let end = Dop853::new(1e-11, 1e-11).integrate(&mechanism, 0.0, &CUBE.into(), 10.0, |t, state| {
        let state = bricard::State::from(*state);
        drift = drift.max((mechanism.energy(t, &state) - energy).abs());
        gap = gap.max(mechanism.residual(t, &state.into()));
        path = path.max((state.q1 - CUBE.q1).abs());
        ControlFlow::Continue(())
    });
    assert!(end.is_ok() && drift < 1e-7 && gap < 1e-8 && path > 0.5, "{drift:e} {gap:e} {path} {end:?}");
}

/// The equations that are solved hold on branches, too, where the one that is watched does not.
#[test]
fn what_is_consistent_fulfils_all_equations() {
    let mechanism = mechanism();
    let mut numbers = Numbers::new();
    let mut found = 0;
    for _ in 0..200 {
        let [q1, q2, q3, q4, q5] = [0; 5].map(|_| 3.0 * numbers.next());
        let guess = bricard::Coordinates { q1, q2, q3, q4, q5 };
        if let Ok(bricard::Coordinates { q1, q2, q3, q4, q5 }) = mechanism.consistent(0.0, &guess, &[]) {
            found += 1;
            let state = bricard::State { q1, q2, q3, q4, q5, v: 0.0 };
            let residual = mechanism.residual(0.0, &state.into());
            assert!(residual < 1e-7, "{residual:e}");
        }
    }
    assert!(found > 60, "{found}");
}

guen::mechanical_system! {
    /// Where both equations hold, the second follows from the first; on the branch `x = 1 - y` of the first it does not.
    pub system Branches {
        coordinates { x, y }
        kinetic_energy = 1/2*(dot(x)^2 + dot(y)^2);
        parameters { v = dot(y); }
        holonomic { either: x^2 = x*(1 - y); zero: x = 0; }
    }
}

#[test]
fn a_branch_where_a_redundant_equation_fails_is_left_or_refused() {
    assert!(
        branches::REPORT
            .lines("Forms")
            .iter()
            .any(|line| line.starts_with("zero is no form: it follows from either"))
    );
    let system = Branches::new().prepare().unwrap();
    let near = |x| system.consistent(0.0, &branches::Coordinates { x, y: 0.0 }, &[]);
    assert!(near(0.1).unwrap().x.abs() < 1e-12 && near(0.9).unwrap().x.abs() < 1e-12);
    let Err(PositionsError::NotFound { residual }) = guen::project(&system, 0.0, &mut [0.9, 0.0, 0.0]) else {
        panic!("another branch")
    };
    assert!((0.9..1.0).contains(&residual), "{residual}");
}
