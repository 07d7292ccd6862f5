//! Constants and marker traits of the classification, costs, and the texts.

use guen::{Class, Conservative, Cost, Holonomic, LieGroup, Nonholonomic, Report, Rheonomic, Scleronomic};

cart!(guen::mechanical_system);
hoop!(guen::mechanical_system);
particle_pendulum!(guen::mechanical_system);
turntable!(guen::mechanical_system);

/// Demands as an integrator makes them, on systems and on references to them.
#[test]
fn markers_are_bounds() {
    fn energy_method<S: Conservative + Scleronomic>(_: &S) {}
    fn nonholonomic_method<S: Nonholonomic>(_: S) {}
    fn moving<S: Rheonomic>(_: S) {}
    fn group<S: LieGroup + Holonomic>(_: S) {}
    let hoop = Hoop::new(0.8, 0.5, 1.1).prepare().unwrap();
    energy_method(&hoop);
    fn shared<S: Nonholonomic>(system: &S) {
        nonholonomic_method(system);
    }
    nonholonomic_method(hoop);
    shared(&hoop);
    moving(Turntable::new(0.7, 0.25, 1.5, 0.8, 1.3).prepare().unwrap());
    let cart = Cart::new(2.0, 0.6).prepare().unwrap();
    group(cart);
    group(cart.driven(cart::Inputs { push: 0.0, wind: 0.0 }));
}

#[test]
fn constants_say_the_same() {
    const CLASS: Class = hoop::CLASS;
    const { assert!(!CLASS.is_holonomic() && hoop::SCLERONOMIC && hoop::CATASTATIC && hoop::CONSERVATIVE) };
    const { assert!(cart::CLASS.is_holonomic() && cart::CLASS.has_constant_coefficients()) };
    // Forces work on the cart: its energy changes.
    const { assert!(!cart::CONSERVATIVE && cart::CATASTATIC) };
    const { assert!(!turntable::SCLERONOMIC && !turntable::CATASTATIC && !turntable::CONSERVATIVE) };
    const { assert!(particle_pendulum::CLASS.is_holonomic() && particle_pendulum::CONSERVATIVE) };
    assert_eq!(Hoop::CLASS, hoop::CLASS);
    assert_eq!(Hoop::GROWTH, hoop::GROWTH);
    assert_eq!(Hoop::COST, hoop::COST);
    assert_eq!(particle_pendulum::INTEGRABLE, 1);
}

/// No more operations than the equations have when written by hand with common factors shared.
#[test]
fn costs_are_counted() {
    const COST: Cost = hoop::COST;
    assert_eq!(COST.calls, 2, "sine and cosine of theta and of psi");
    assert!(COST.total() <= 26, "{COST}");
    const { assert!(COST.divisions <= 1 && COST.roots == 0) };
    assert!(hoop::PREPARE_COST.total() > 0, "what depends on constants alone is hoisted");
}

#[test]
fn texts_are_there() {
    let filled = |report: Report| {
        assert!(report.sections.len() >= 6, "{report}");
        assert!(report.sections.iter().all(|s| !s.lines.is_empty() && !s.title.is_empty()));
        assert!(report.sections.iter().all(|s| s.lines.iter().all(|line| !line.trim().is_empty())));
    };
    for report in [hoop::REPORT, hoop::LATEX, cart::REPORT, turntable::REPORT, particle_pendulum::REPORT] {
        filled(report);
    }
    assert_eq!(
        hoop::REPORT.summary,
        "6 coordinates, 3 degrees of freedom, 3 constraints: nonholonomic, with variable coefficients."
    );
    let rod = particle_pendulum::REPORT.lines("Forms")[1];
    assert!(rod.starts_with("rod = 2*x dot(x) + 2*y dot(y) = 0 ") && rod.contains("the rate of "), "{rod}");
    assert!(hoop::REPORT.to_string().contains("(X1, X2) = -cot(theta) X2 + X3"));
    assert!(hoop::LATEX.sections.iter().all(|s| s.lines.iter().all(|line| braces_match(line))));
}

fn braces_match(line: &str) -> bool {
    let mut depth = 0_i32;
    line.chars().all(|c| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        depth >= 0
    }) && depth == 0
}
