//! Markers as bounds, classes and coefficients as values.

use guen_runtime::{Class, Coefficient, Conservative, Cost, Holonomic, Scleronomic};

struct Pendulum;

impl Holonomic for Pendulum {}
impl Scleronomic for Pendulum {}
impl Conservative for Pendulum {}

/// What an integrator writes that relies on a kept energy.
fn demand<S: Holonomic + Scleronomic + Conservative>(_: S) {}

#[test]
fn markers_hold_for_references() {
    demand(&Pendulum);
    demand(Pendulum);
}

#[test]
fn classes_are_holonomic_or_not_and_constant_or_not() {
    const CLASS: Class = Class::NonholonomicConstant;
    const { assert!(!CLASS.is_holonomic() && CLASS.has_constant_coefficients()) };
    assert!(Class::HolonomicVariable.is_holonomic() && !Class::HolonomicVariable.has_constant_coefficients());
    assert_eq!(Class::HolonomicConstant.to_string(), "holonomic, a Lie group");
    assert_eq!(CLASS.to_string(), "nonholonomic, an incomplete Lie group");
}

#[test]
fn coefficients_say_what_is_known() {
    let half = Coefficient::Number { numerator: -1, denominator: 2 };
    let texts =
        [Coefficient::Zero, half, Coefficient::Constant, Coefficient::Variable].map(|c| c.to_string());
    assert_eq!(texts, ["0", "-1/2", "constant", "variable"]);
    assert!(half.is_constant() && !Coefficient::Variable.is_constant());
}

#[test]
fn costs_add_up_at_compile_time() {
    const ONE: Cost =
        Cost { additions: 2, negations: 0, multiplications: 3, divisions: 0, roots: 1, calls: 1 };
    const TWICE: Cost = ONE.plus(ONE);
    assert_eq!(TWICE.total(), 14);
    assert_eq!(ONE.to_string(), "7 operations (2 additions, 3 multiplications, 1 root, 1 call)");
}
