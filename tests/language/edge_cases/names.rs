//! Names that need care: raw identifiers, Greek letters, names that the generated code might use itself.

use super::assert_near;

guen::mechanical_system! {
    /// Keywords as names.
    pub system Raw {
        constants { r#struct > 0, r#match = 2 }
        coordinates { r#type, r#fn }
        parameters { r#loop = dot(r#type); r#if = dot(r#fn)*r#match; }
        kinetic_energy = r#struct/2*(r#loop^2 + r#if^2);
        potential_energy = r#type*r#fn;
        outputs { r#where = r#type + r#fn; }
    }
}

guen::mechanical_system! {
    /// A pendulum in Greek.
    pub system Εκκρεμές {
        constants { μ > 0, λ > 0, g = 9.81 }
        coordinates { θ }
        parameters { ω_1 = dot(θ); }
        kinetic_energy = μ/2*λ^2*ω_1^2;
        potential_energy = -μ*g*λ*cos(θ);
    }
}

guen::mechanical_system! {
    /// Names of arguments, arrays and modules in the generated code.
    pub system Shadows {
        constants { c > 0, k > 0, R = 2, self_ = 1, values = 1 }
        coordinates { s, x, state, system }
        parameters { u = dot(s); w = dot(x); rate = dot(state); program = dot(system); }
        kinetic_energy = c/2*(u^2 + w^2) + R/2*rate^2 + self_*values/2*program^2;
        potential_energy = k/2*(s^2 + x^2 + state^2 + system^2);
    }
}

#[test]
fn keywords() {
    let system = Raw::new(1.5).prepare().unwrap();
    let state = raw::State { r#type: 0.3, r#fn: -0.4, r#loop: 1.0, r#if: 3.0 };
    let rate = system.rhs(0.0, &state);
    assert_near(rate.r#fn, 1.5, 1e-15);
    assert_near(rate.r#loop, 0.4 / 1.5, 1e-15);
    // m 4 fn'' = -type, and the parameter is 2 fn'.
    assert_near(rate.r#if, -0.3 / (1.5 * 2.0), 1e-15);
    assert_near(system.outputs(0.0, &state).r#where, -0.1, 1e-15);
    assert_eq!(raw::State::NAMES, ["type", "fn", "loop", "if"]);
    assert!(raw::REPORT.to_string().contains("loop = dot(type)"));
}

#[test]
fn greek() {
    let system = Εκκρεμές::new(0.5, 2.0).prepare().unwrap();
    let rate = system.rhs(0.0, &εκκρεμές::State { θ: 0.6, ω_1: 0.2 });
    assert_near(rate.θ, 0.2, 1e-15);
    assert_near(rate.ω_1, -9.81 / 2.0 * 0.6_f64.sin(), 1e-14);
    assert_eq!(εκκρεμές::LATEX.lines("Forms"), [r"\omega_{1} = \dot{\theta}"]);
}

#[test]
fn names_of_the_generated_code() {
    let system = Shadows::new(2.0, 3.0).prepare().unwrap();
    let state =
        shadows::State { s: 0.1, x: 0.2, state: 0.3, system: 0.4, u: 1.0, w: 2.0, rate: 3.0, program: 4.0 };
    let found = <[f64; 8]>::from(system.rhs(0.0, &state));
    let expected = [1.0, 2.0, 3.0, 4.0, -0.15, -0.3, -0.45, -1.2];
    for (x, y) in found.iter().zip(expected) {
        assert_near(*x, y, 1e-15);
    }
}
