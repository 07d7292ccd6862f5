//! Bodies that could be made, and bodies that could not.

use guen::{BodyFault, ConstantsError};
use guen_benchmarks::systems::BodyHoop;

guen::mechanical_system! {
    /// A brick with a weight of its own, on a telescope whose inertia changes and is nobody's to check.
    pub system Brick {
        constants { m, A, B, C, D, E, F }
        coordinates { q, s }
        bodies {
            brick { mass: m, inertia: sym(A, B, C, D, E, F), center: s*rot_z(q).x, orientation: rot_z(q) }
            tube { mass: 1, inertia: diag(0, 0, s^2), center: vec(0, 0), orientation: rot_z(q) }
        }
        parameters { turn = dot(q); slide = dot(s); }
    }
}

#[test]
fn the_limits_are_those_of_the_principal_moments() {
    let hoop = |A, C| BodyHoop { a: 1.0, A, C, g: 9.81 }.prepare_physical();
    // A ring reaches the limit: C = A + A.
    assert!(hoop(0.1, 0.2).is_ok() && hoop(0.3, 0.6).is_ok());
    assert_eq!(
        hoop(0.1, 0.21).unwrap_err(),
        ConstantsError::NotPhysical { body: "hoop", fault: BodyFault::Inertia }
    );
    assert!(BodyHoop { a: 1.0, A: 0.1, C: 0.21, g: 9.81 }.prepare().is_ok(), "only on request");
}

/// Turned principal axes: the moments 1, 2 and `c` about axes that no coordinate plane contains.
#[test]
fn products_of_inertia_count() {
    let brick = |c: f64| {
        let rotation = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3);
        let i = rotation.matrix()
            * nalgebra::Matrix3::from_diagonal(&[1.0, 2.0, c].into())
            * rotation.matrix().transpose();
        Brick { m: 1.0, A: i[(0, 0)], B: i[(1, 1)], C: i[(2, 2)], D: i[(0, 1)], E: i[(1, 2)], F: i[(2, 0)] }
    };
    for c in [1.0, 1.5, 2.9, 3.0] {
        assert!(brick(c).prepare_physical().is_ok(), "{c}");
    }
    for c in [3.01, 0.99, -1.0, 7.0] {
        let error = brick(c).prepare_physical().unwrap_err();
        assert_eq!(error, ConstantsError::NotPhysical { body: "brick", fault: BodyFault::Inertia }, "{c}");
    }
    let error = Brick { m: -1.0, ..brick(2.0) }.prepare_physical().unwrap_err();
    assert_eq!(error.to_string(), "body `brick` has a negative mass");
}
