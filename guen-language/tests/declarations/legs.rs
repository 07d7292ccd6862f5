//! Legs from the ground to a body, whose lengths are coordinates: `norm(p)^2 = l^2` says nothing of the sign of `l`.

use crate::common::derived;

fn legs(count: usize, force: &str) -> String {
    format!(
        "pub system Legs {{
            count n = {count};
            constants {{ M > 0, J[3] > 0, m > 0, r > 0, R > 0, k >= 0, g = 9.81 }}
            coordinates {{ x, y, z, q0, q1, q2, q3, l[n] }}
            bodies {{ top {{ mass: M, center: vec(x, y, z), inertia: diag(J[0], J[1], J[2]), orientation: quaternion(q0, q1, q2, q3) }} }}
            for i in 0..n {{
                let foot[i] = R*vec(cos(pi/3*i + 0.2), sin(pi/3*i + 0.2), 0);
                let head[i] = top.center + top.orientation*vec(r*cos(pi/3*i), r*sin(pi/3*i), 0);
            }}
            holonomic {{ unit_q: q0^2 + q1^2 + q2^2 + q3^2 = 1; for i in 0..n {{ leg[i]: norm(head[i] - foot[i])^2 = l[i]^2; }} }}
            kinetic_energy = sum(i in 0..n: m/2*dot(l[i])^2);
            gravity = vec(0, 0, -g);
            forces {{ for i in 0..n {{ {force} along dot(l[i]); }} }}
        }}"
    )
}

#[test]
fn lengths_of_either_sign_go_through_the_bodies() {
    for count in [1, 2, 6] {
        for force in ["k", "-k*(l[i] - 1)"] {
            derived(&legs(count, force), |legs| assert!(legs.system.derivation.is_by("bodies"), "{count}"));
        }
    }
}
