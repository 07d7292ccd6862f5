//! The paper's three systems: operators, brackets and equations as expressions, and the class of each.

mod classes;
mod formulas;
mod printed;

use formulas::derive;

const HOOP: &str = hoop!(stringify);
const APPELL: &str = appell!(stringify);
const SLED: &str = sled!(stringify);
const SLED_IN_XI: &str = sled_in_xi!(stringify);

const NONE: [&str; 6] = ["0"; 6];

#[test]
fn hoop_operators_3_3() {
    derive(HOOP, |hoop| {
        hoop.operator(0, &NONE);
        hoop.operator(1, &["1", "0", "0", "a*sin(theta)*sin(psi)", "-a*sin(theta)*cos(psi)", "a*cos(theta)"]);
        hoop.operator(2, &["0", "1/sin(theta)", "-cot(theta)", "0", "0", "0"]);
        hoop.operator(3, &["0", "0", "1", "-a*cos(psi)", "-a*sin(psi)", "0"]);
        hoop.operator(4, &["0", "0", "0", "1", "0", "0"]);
        hoop.operator(5, &["0", "0", "0", "0", "1", "0"]);
        hoop.operator(6, &["0", "0", "0", "0", "0", "1"]);
    });
}

#[test]
fn hoop_brackets_3_4() {
    derive(HOOP, |hoop| {
        hoop.bracket(1, 2, &["0", "-cot(theta)", "1", "0", "0", "0"]);
        hoop.bracket(1, 3, &NONE);
        hoop.bracket(2, 3, &["0", "0", "0", "a*sin(psi)/sin(theta)", "-a*cos(psi)/sin(theta)", "0"]);
        for s in 1..=3 {
            hoop.bracket(0, s, &NONE);
        }
    });
}

/// On the constraints, and with all parameters free as far as `eta_4 .. eta_6` enter.
#[test]
fn hoop_energies_3_5() {
    const T: &str = "1/2*((A + a^2)*eta1^2 + A*eta2^2 + (C + a^2)*eta3^2)";
    const FREE: &str = "1/2*(eta4^2 + eta5^2 + eta6^2 + 2*a*sin(theta)*sin(psi)*eta1*eta4
        - 2*a*sin(theta)*cos(psi)*eta1*eta5 + 2*a*cos(theta)*eta1*eta6
        - 2*a*cos(psi)*eta3*eta4 - 2*a*sin(psi)*eta3*eta5)";
    derive(HOOP, |hoop| {
        let kinetic = hoop.derivation.energies.kinetic;
        hoop.holds("T", kinetic, T);
        for v in 4..=6 {
            let (found, expected) = (hoop.free_momentum(v), hoop.formula_by(v, FREE));
            hoop.equal(&format!("dT°/d eta{v}"), found, expected);
        }
    });
}

#[test]
fn hoop_equations_3_6() {
    derive(HOOP, |hoop| {
        hoop.equation(1, "(A + a^2)*dot(eta1) - A*cot(theta)*eta2^2 + (C + a^2)*eta2*eta3 + a*g*cos(theta)");
        hoop.equation(2, "A*dot(eta2) + A*cot(theta)*eta1*eta2 - C*eta1*eta3");
        hoop.equation(3, "(C + a^2)*dot(eta3) - a^2*eta1*eta2");
    });
}

/// With the correction of the printed last term of `X_1`, which has to be `d/dzeta`.
#[test]
fn appell_operators_3_8() {
    derive(APPELL, |appell| {
        appell.operator(0, &NONE);
        appell.operator(1, &["1", "0", "0", "-a*sin(theta)", "0", "a*cos(theta)"]);
        appell.operator(2, &["0", "1/sin(theta)", "-cot(theta)", "0", "0", "0"]);
        appell.operator(3, &["0", "0", "1", "0", "0", "0"]);
        appell.operator(4, &["0", "0", "0", "1", "0", "0"]);
        appell.operator(5, &["0", "0", "0", "0", "1", "0"]);
        appell.operator(6, &["0", "0", "0", "0", "0", "1"]);
    });
}

#[test]
fn appell_brackets_3_9() {
    derive(APPELL, |appell| {
        appell.bracket(1, 2, &["0", "-cot(theta)", "1", "0", "0", "0"]);
        appell.bracket(1, 3, &NONE);
        appell.bracket(2, 3, &NONE);
        for s in 1..=3 {
            appell.bracket(0, s, &NONE);
        }
    });
}

#[test]
fn appell_energies_3_10() {
    const T: &str = "1/2*((A + a^2)*eta1^2 + A*eta2^2 + (C + a^2)*eta3^2)";
    const FREE: &str = "1/2*(eta4^2 + eta5^2 + eta6^2 - 2*a*sin(theta)*eta1*eta4 + 2*a*cos(theta)*eta1*eta6)";
    derive(APPELL, |appell| {
        let kinetic = appell.derivation.energies.kinetic;
        appell.holds("T", kinetic, T);
        for v in 4..=6 {
            let (found, expected) = (appell.free_momentum(v), appell.formula_by(v, FREE));
            appell.equal(&format!("dT°/d eta{v}"), found, expected);
        }
    });
}

#[test]
fn appell_equations_3_11() {
    derive(APPELL, |appell| {
        appell
            .equation(1, "(A + a^2)*dot(eta1) - A*cot(theta)*eta2^2 + (C + a^2)*eta2*eta3 + a*g*cos(theta)");
        appell.equation(2, "A*dot(eta2) + A*cot(theta)*eta1*eta2 - (C + a^2)*eta1*eta3");
        appell.equation(3, "(C + a^2)*dot(eta3)");
    });
}

#[test]
fn sled_operators_3_13() {
    derive(SLED, |sled| {
        sled.operator(0, &["0", "0", "0"]);
        sled.operator(1, &["1", "0", "0"]);
        sled.operator(2, &["0", "cos(phi)", "sin(phi)"]);
        sled.operator(3, &["0", "sin(phi)", "-cos(phi)"]);
    });
}

#[test]
fn sled_bracket_3_14() {
    derive(SLED, |sled| {
        sled.bracket(1, 2, &["0", "0", "-1"]);
        sled.bracket(0, 1, &["0", "0", "0"]);
        sled.bracket(0, 2, &["0", "0", "0"]);
    });
}

#[test]
fn sled_energies_3_15() {
    derive(SLED, |sled| {
        let (kinetic, force) = (sled.derivation.energies.kinetic, sled.derivation.system.force_function);
        let squared = "(alpha^2 + beta^2 + k^2)";
        sled.holds("T", kinetic, &format!("m/2*({squared}*eta1^2 + eta2^2 - 2*beta*eta1*eta2)"));
        sled.holds("U", force, "m*g*sin(incline)*(xi + alpha*cos(phi) - beta*sin(phi))");
        let (found, expected) =
            (sled.free_momentum(3), sled.formula_by(3, "m/2*(eta3^2 - 2*alpha*eta1*eta3)"));
        sled.equal("dT°/d eta3", found, expected);
    });
}

#[test]
fn sled_equations_3_16_and_3_17() {
    derive(SLED, |sled| {
        // gamma^2 - beta^2, and gamma^2 itself.
        let (rest, squared) = ("(alpha^2 + k^2)", "(alpha^2 + beta^2 + k^2)");
        let [turning, running] = sled.derivation.solution.accelerations[..] else { panic!("two equations") };
        sled.holds(
            "eta1'",
            turning,
            &format!("alpha*eta1*(beta*eta1 - eta2)/{rest} - alpha*g*sin(incline)*sin(phi)/{rest}"),
        );
        sled.holds(
            "eta2'",
            running,
            &format!(
                "alpha*eta1*({squared}*eta1 - beta*eta2)/{rest}
                 + g*sin(incline)*({rest}*cos(phi) - alpha*beta*sin(phi))/{rest}"
            ),
        );
        for (i, formula) in ["eta1", "eta2*cos(phi)", "eta2*sin(phi)"].iter().enumerate() {
            let velocity = sled.derivation.frame.velocities[i];
            sled.holds("velocity", velocity, formula);
        }
    });
}

/// The closing remark: other parameters, and a coefficient that varies.
#[test]
fn sled_in_other_parameters() {
    derive(SLED_IN_XI, |sled| sled.bracket(1, 2, &["0", "0", "-1/cos(phi)"]));
}

/// What is compared can differ: a wrong sign is seen.
#[test]
#[should_panic(expected = "equation 2")]
fn a_wrong_sign_is_seen() {
    derive(HOOP, |hoop| hoop.equation(2, "A*dot(eta2) + A*cot(theta)*eta1*eta2 + C*eta1*eta3"));
}
