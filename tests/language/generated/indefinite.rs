//! Masses and inertias that are negative numbers: refused where the mass matrix becomes indefinite.

use guen::{ConstantsError, mechanical_system};

mechanical_system! {
    pub system Light {
        coordinates { x, y }
        particles { -1 at vec(x, y); }
        parameters { u = dot(x); v = dot(y); }
    }
}

mechanical_system! {
    pub system Top {
        inputs { push }
        coordinates { a, b, c }
        bodies { top { inertia: diag(1, -1, 5), orientation: rot_z(a)*rot_x(b)*rot_z(c) } }
        parameters { u = dot(a); v = dot(b); w = dot(c); }
        forces { push along w; }
    }
}

mechanical_system! {
    /// A plate with a hole.
    pub system Plate {
        constants { m > 0 }
        coordinates { x, turn }
        let R = rot_z(turn);
        bodies {
            plate { mass: m, inertia: diag(0, 0, m), center: vec(x, 0), orientation: R }
            hole { mass: -1, inertia: diag(0, 0, -1/8), center: vec(x, 0) + R*vec(1/2, 0), orientation: R }
        }
        parameters { u = dot(x); w = dot(turn); }
    }
}

#[test]
fn negative_numbers_are_refused_where_nothing_outweighs_them() {
    assert!(matches!(Light::<f64>::new().prepare(), Err(ConstantsError::Indefinite { body: "particles" })));
    let error = Top::<f64>::new().prepare().unwrap_err();
    assert!(matches!(error, ConstantsError::Indefinite { body: "top" }));
    assert!(error.to_string().contains("makes the mass matrix indefinite"));
    assert!(matches!(Plate { m: 0.5 }.prepare(), Err(ConstantsError::Indefinite { body: "plate" | "hole" })));
    assert!(Plate { m: 4.0 }.prepare().is_ok());
    assert!(plate::REPORT.markdown(1).to_string().contains("the mass of hole is negative"));
}
