//! What the derivation finds out about the paper's systems and some that the paper does not have.

use guen::prelude::*;
use guen::{
    Catastatic, Class, Coefficient, Conservative, Holonomic, IncompleteLieGroup, LieGroup, Nonholonomic,
    Rheonomic, Scleronomic,
};

hoop!(guen::mechanical_system);
appell!(guen::mechanical_system);
sled!(guen::mechanical_system);
sled_in_xi!(guen::mechanical_system);
trailer!(guen::mechanical_system);
turntable!(guen::mechanical_system);
even_turntable!(guen::mechanical_system);
euler_top!(guen::mechanical_system);

fn all_at_rest<S: Scleronomic + Catastatic + Conservative>() {}

#[test]
fn hoop_is_nonholonomic_with_one_integrable_constraint() {
    fn found<S: Nonholonomic>() {}
    found::<hoop::Prepared>();
    all_at_rest::<hoop::Prepared>();
    assert_eq!(hoop::CLASS, Class::NonholonomicVariable);
    assert_eq!(hoop::GROWTH, [3, 4, 5]);
    assert_eq!(hoop::INTEGRABLE, 1);
    // The one is the height: zeta - a sin(theta).
    assert!(hoop::REPORT.lines("Classification").contains(&"integrable: eta6"));
}

#[test]
fn appell_is_holonomic() {
    fn found<S: Holonomic>() {}
    found::<appell::Prepared>();
    all_at_rest::<appell::Prepared>();
    assert_eq!(appell::CLASS, Class::HolonomicVariable);
    assert_eq!(appell::GROWTH, [3]);
    assert_eq!(appell::INTEGRABLE, 3);
}

#[test]
fn sled_is_an_incomplete_lie_group_in_the_papers_parameters() {
    fn found<S: Nonholonomic + IncompleteLieGroup>() {}
    found::<sled::Prepared>();
    all_at_rest::<sled::Prepared>();
    assert_eq!(sled::CLASS, Class::NonholonomicConstant);
    assert_eq!(sled::GROWTH, [2, 3]);
    assert_eq!(sled::INTEGRABLE, 0);
}

#[test]
fn sled_is_none_in_others() {
    fn found<S: Nonholonomic>() {}
    found::<sled_in_xi::Prepared>();
    assert_eq!(sled_in_xi::CLASS, Class::NonholonomicVariable);
    assert_eq!(sled_in_xi::GROWTH, [2, 3]);
    type Turned = sled_in_xi::Bracket<1, 2>;
    const KNOWN: [Coefficient; 3] = Turned::COEFFICIENTS;
    assert_eq!(KNOWN, [Coefficient::Zero, Coefficient::Zero, Coefficient::Variable]);
    let system = SledInXi::new(1.0, 0.2, 0.1, 0.5, 0.3).prepare().unwrap();
    let [_, _, found] = Turned::coefficients(&system, 0.0, &[0.7, 1.0, -2.0]);
    assert!((found + 1.0 / 0.7_f64.cos()).abs() < 1e-15);
}

/// The motion does not depend on the parameters, as long as `cos(phi) > 0` lets these be a chart.
#[test]
fn sled_moves_alike_in_both_parameters() {
    let one = Sled::new(1.0, 0.2, 0.1, 0.5, 0.3).prepare().unwrap();
    let other = SledInXi::new(1.0, 0.2, 0.1, 0.5, 0.3).prepare().unwrap();
    let start = sled::State { phi: 0.2, xi: 0.1, eta: -0.3, eta1: 0.4, eta2: 1.1 };
    let turned = sled_in_xi::State { phi: 0.2, xi: 0.1, eta: -0.3, eta1: 0.4, eta2: 1.1 * 0.2_f64.cos() };
    let times: Vec<f64> = (1..=12).map(|k| 0.25 * f64::from(k)).collect();
    let mut seen = Vec::new();
    let method = Dop853::new(1e-13, 1e-14);
    method.sample(&one, 0.0, &start.into(), &times, |_, _, x| seen.push(*x)).unwrap();
    let mut least = 1.0_f64;
    method
        .sample(&other, 0.0, &turned.into(), &times, |k, t, x| {
            least = least.min(x[0].cos());
            let expected = [seen[k][0], seen[k][1], seen[k][2], seen[k][3], seen[k][4] * seen[k][0].cos()];
            for (x, y) in x.iter().zip(&expected) {
                assert!((x - y).abs() < 1e-11 * (1.0 + y.abs()), "t = {t}: {x} and {y}");
            }
        })
        .unwrap();
    assert!(least > 0.0, "the span stays in the chart");
    assert!((seen[11][0] - seen[0][0]).abs() > 0.1, "the sled turns");
}

#[test]
fn unicycle_with_trailer_grows_to_everything() {
    fn found<S: Nonholonomic>() {}
    found::<trailer::Prepared>();
    assert_eq!(trailer::GROWTH, [2, 3, 4]);
    assert_eq!(trailer::INTEGRABLE, 0);
    // The coefficients are constant, and the axle's are all zero: read off `C_rsv` alone, it would seem integrable.
    assert_eq!(trailer::CLASS, Class::NonholonomicConstant);
    let known = trailer::Bracket::<1, 2>::COEFFICIENTS;
    assert!(known.iter().all(|c| c.is_constant()) && known[3] == Coefficient::Zero);
}

#[test]
fn ball_on_a_turntable_conserves_no_energy() {
    fn even<S: Nonholonomic + Scleronomic>() {}
    fn varying<S: Nonholonomic + Rheonomic>() {}
    even::<even_turntable::Prepared>();
    varying::<turntable::Prepared>();
    const { assert!(!even_turntable::CONSERVATIVE && !turntable::CONSERVATIVE) };
    const { assert!(!even_turntable::CATASTATIC && !turntable::CATASTATIC) };
    const { assert!(even_turntable::SCLERONOMIC && !turntable::SCLERONOMIC) };
    let system = EvenTurntable::new(0.7, 0.25, 1.5).prepare().unwrap();
    let start = even_turntable::State {
        x: 0.4,
        y: -0.2,
        psi: 0.3,
        theta: 1.2,
        phi: -0.5,
        eta1: 0.6,
        eta2: -0.9,
        eta3: 0.5,
    };
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-12, 1e-12), 2.0).unwrap();
    let change = system.energy(2.0, &end.state.into()) - system.energy(0.0, &start);
    assert!(change.abs() > 1e-3, "{change}");
}

#[test]
fn rigid_body_is_a_lie_group() {
    fn found<S: LieGroup + Holonomic>() {}
    found::<euler_top::Prepared>();
    all_at_rest::<euler_top::Prepared>();
    assert_eq!(euler_top::CLASS, Class::HolonomicConstant);
    assert_eq!(euler_top::GROWTH, [3]);
    // Rotations about body axes: (X_p, X_q) = -(-X_r) and cyclically, so all three have one sign.
    let one = Coefficient::Number { numerator: 1, denominator: 1 };
    const ZERO: Coefficient = Coefficient::Zero;
    assert_eq!(euler_top::Bracket::<1, 2>::COEFFICIENTS, [ZERO, ZERO, one]);
    assert_eq!(euler_top::Bracket::<2, 3>::COEFFICIENTS, [one, ZERO, ZERO]);
    assert_eq!(euler_top::Bracket::<3, 1>::COEFFICIENTS, [ZERO, one, ZERO]);
}
