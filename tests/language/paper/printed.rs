//! Golden texts: what is printed of the paper's systems, in the paper's notation.

hoop!(guen::mechanical_system);
appell!(guen::mechanical_system);
sled!(guen::mechanical_system);
sled_in_xi!(guen::mechanical_system);

#[test]
fn hoop_is_printed_as_in_the_paper() {
    assert_eq!(
        hoop::REPORT.lines("Operators"),
        [
            "X0 = d/dt",
            "X1 = d/dtheta + a*sin(theta)*sin(psi) d/dxi - a*sin(theta)*cos(psi) d/deta + a*cos(theta) d/dzeta",
            "X2 = 1/sin(theta) d/dpsi - cot(theta) d/dphi",
            "X3 = d/dphi - a*cos(psi) d/dxi - a*sin(psi) d/deta",
            "X4 = d/dxi",
            "X5 = d/deta",
            "X6 = d/dzeta",
        ]
    );
    assert_eq!(
        hoop::REPORT.lines("Brackets"),
        [
            "(X1, X2) = -cot(theta) X2 + X3",
            "(X2, X3) = a*sin(psi)/sin(theta) X4 - a*cos(psi)/sin(theta) X5",
            "(X0, X1) = (X0, X2) = (X0, X3) = (X1, X3) = 0",
        ]
    );
    assert_eq!(
        hoop::REPORT.lines("Equations of motion"),
        [
            "(A + a^2)*eta1' - A*cot(theta)*eta2^2 + (C + a^2)*eta2*eta3 + a*g*cos(theta) = 0",
            "A*eta2' + A*cot(theta)*eta1*eta2 - C*eta1*eta3 = 0",
            "(C + a^2)*eta3' - a^2*eta1*eta2 = 0",
        ]
    );
    assert_eq!(hoop::DOMAIN, ["sin(theta)"]);
}

#[test]
fn hoop_in_latex() {
    assert_eq!(hoop::LATEX.lines("Brackets")[0], r"(X_{1}, X_{2}) = -\cot\theta\,X_{2} + X_{3}",);
    assert_eq!(hoop::LATEX.lines("Operators")[0], r"X_{0} = \frac{\partial}{\partial t}");
    assert_eq!(
        hoop::LATEX.lines("Operators")[2],
        r"X_{2} = \frac{1}{\sin\theta}\,\frac{\partial}{\partial \psi} - \cot\theta\,\frac{\partial}{\partial \phi}"
    );
    assert_eq!(hoop::LATEX.lines("Forms")[1], r"\eta_{2} = \sin\theta\,\dot{\psi}");
    let equations = hoop::LATEX.lines("Equations of motion");
    assert_eq!(equations.len(), 3);
    assert!(
        equations.iter().all(|line| line.contains(r"\dot{\eta}_") && line.ends_with("= 0")),
        "{equations:?}"
    );
}

#[test]
fn appell_is_printed_as_in_the_paper() {
    assert_eq!(
        appell::REPORT.lines("Brackets"),
        ["(X1, X2) = -cot(theta) X2 + X3", "(X0, X1) = (X0, X2) = (X0, X3) = (X1, X3) = (X2, X3) = 0",]
    );
    assert_eq!(
        appell::REPORT.lines("Equations of motion"),
        [
            "(A + a^2)*eta1' - A*cot(theta)*eta2^2 + (C + a^2)*eta2*eta3 + a*g*cos(theta) = 0",
            "A*eta2' + A*cot(theta)*eta1*eta2 - (C + a^2)*eta1*eta3 = 0",
            "(C + a^2)*eta3' = 0",
        ]
    );
}

#[test]
fn sled_is_printed_as_in_the_paper() {
    assert_eq!(sled::REPORT.lines("Brackets"), ["(X1, X2) = -X3", "(X0, X1) = (X0, X2) = 0"]);
    assert_eq!(
        sled::REPORT.lines("Velocities"),
        ["dot(phi) = eta1", "dot(xi) = cos(phi)*eta2", "dot(eta) = sin(phi)*eta2"]
    );
    assert_eq!(
        sled::REPORT.lines("Classification")[0],
        "nonholonomic, an incomplete Lie group; growth vector (2, 3)"
    );
    assert_eq!(sled_in_xi::REPORT.lines("Brackets")[0], "(X1, X2) = -1/cos(phi) X3");
}
