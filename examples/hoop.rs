//! scratch
use guen::prelude::*;
guen::mechanical_system! {
    /// A hoop of radius `a` that rolls without slipping on a horizontal plane.
    pub system Hoop {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        let rolling = dot(psi)*cos(theta) + dot(phi);
        parameters { eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = rolling; }
        constraints {
            eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
    }
}
fn main() {
    println!("{}", hoop::REPORT);
    println!("{}", hoop::COST);
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    let state = hoop::State {
        theta: 1.2,
        psi: 0.3,
        phi: 0.0,
        xi: 0.0,
        eta: 0.0,
        zeta: 0.932,
        eta1: 0.1,
        eta2: 0.4,
        eta3: 5.0,
    };
    println!("{:?}", hoop.rhs(0.0, &state));
    let end = Dop853::new(1e-12, 1e-12)
        .integrate(&hoop, 0.0, &state.into(), 10.0, |_, _| ControlFlow::Continue(()))
        .unwrap();
    println!("{:?}", end);
    println!("{:?} {:?}", hoop.energy(0.0, &state), hoop.energy(10.0, &hoop::State::from(end.state)));
    println!("{:?}", hoop.reactions(0.0, &state));
    println!("{:?}", hoop.residuals(0.0, &state));
    println!("{:?}", hoop.linearize(0.0, &state).a[6]);
    println!(
        "{:?}",
        hoop::X1.apply(&hoop, &hoop::X2.of(&hoop, Coordinate::<1>), 0.0, &state.coordinates().into())
    );
}
