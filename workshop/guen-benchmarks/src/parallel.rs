//! The texts of declarations of robots whose links close loops.

/// Three legs that carry a plate without turns (Clavel's delta robot): upper arms turned by the motors, lower arms on universal joints.
pub fn delta(parameters: &str) -> String {
    format!(
        "pub system Delta {{
            count n = 3;
            constants {{ M > 0, m1 > 0, m2 > 0, J1 > 0, J2 > 0, g = 9.81, a > 0, b > 0, r > 0 }}
            inputs {{ u[n] }}
            coordinates {{ x, y, z, q[n], s[n], d[n] }}
            let c = vec(x, y, z);
            for i in 0..n {{
                let F[i] = rot_z(2*pi*i/3);
                let U[i] = F[i]*rot_y(q[i]);
                let L[i] = F[i]*rot_y(s[i])*rot_z(d[i]);
                let elbow[i] = F[i]*vec(r, 0, 0) + U[i]*vec(a, 0, 0);
            }}
            bodies {{
                plate {{ mass: M, center: c }}
                for i in 0..n {{
                    upper[i] {{ mass: m1, inertia: diag(0, J1, J1), center: elbow[i] - U[i]*vec(a/2, 0, 0), orientation: U[i] }}
                    lower[i] {{ mass: m2, inertia: diag(0, J2, J2), center: elbow[i] + L[i]*vec(b/2, 0, 0), orientation: L[i] }}
                }}
            }}
            holonomic {{ for i in 0..n {{ closed[i]: elbow[i] + L[i]*vec(b, 0, 0) = c; }} }}
            gravity = vec(0, 0, -g);
            parameters {{ {parameters} }}
            forces {{ for i in 0..n {{ u[i] along dot(q[i]); }} }}
        }}"
    )
}

/// Two arms in a plane that hold a box between them, each with a motor at every joint.
pub fn two_arms(links: usize) -> String {
    let free = 2 * links - 1;
    format!(
        "pub system TwoArms {{
            count n = {links};
            constants {{ m > 0, J > 0, l > 0, M > 0, C > 0, w > 0, g = 9.81 }}
            inputs {{ u[n], v[n] }}
            coordinates {{ a[n], b[n], x, y, phi }}
            let A[0] = rot_z(a[0]);
            let B[0] = rot_z(b[0]);
            for i in 1..n {{ let A[i] = A[i-1]*rot_z(a[i]); let B[i] = B[i-1]*rot_z(b[i]); }}
            let pa[0] = vec(0, 0, 0);
            let pb[0] = vec(2*w, 0, 0);
            for i in 0..n {{ let pa[i+1] = pa[i] + A[i]*vec(l, 0, 0); let pb[i+1] = pb[i] + B[i]*vec(l, 0, 0); }}
            let O = rot_z(phi);
            let c = vec(x, y, 0);
            bodies {{
                for i in 0..n {{
                    left[i] {{ mass: m, inertia: diag(0, J, J), center: pa[i] + A[i]*vec(l/2, 0, 0), orientation: A[i] }}
                    right[i] {{ mass: m, inertia: diag(0, J, J), center: pb[i] + B[i]*vec(l/2, 0, 0), orientation: B[i] }}
                }}
                load {{ mass: M, inertia: diag(C, C, C), center: c, orientation: O }}
            }}
            holonomic {{ at_left: pa[n] = c - O*vec(w/2, 0, 0); at_right: pb[n] = c + O*vec(w/2, 0, 0); }}
            gravity = vec(0, -g, 0);
            parameters {{ for i in 0..n {{ wa[i] = dot(a[i]); }} wb[0] = dot(b[0]); for i in 1..{free} - n {{ wb[i] = dot(b[n - i]); }} }}
            forces {{ for i in 0..n {{ u[i] along dot(a[i]); v[i] along dot(b[i]); }} }}
        }}"
    )
}

/// A plate on six legs of variable length (Gough and Stewart), each of two bodies on a universal joint.
pub fn platform(parameters: &str) -> String {
    format!(
        "pub system Platform {{
            count n = 6;
            constants {{
                M > 0, A > 0, B > 0, C > 0, g = 9.81, ax[n], ay[n], bx[n], by[n], bz,
                m1 > 0, J1 > 0, K1 > 0, m2 > 0, J2 > 0, K2 > 0, c1 > 0, c2 > 0
            }}
            inputs {{ f[n] }}
            coordinates {{ x, y, z, yaw, pitch, roll, al[n], be[n], s[n] }}
            let R = rot_z(yaw)*rot_y(pitch)*rot_x(roll);
            let c = vec(x, y, z);
            for i in 0..n {{
                let foot[i] = vec(ax[i], ay[i], 0);
                let L[i] = rot_x(al[i])*rot_y(be[i]);
                let top[i] = c + R*vec(bx[i], by[i], bz);
            }}
            bodies {{
                plate {{ mass: M, inertia: diag(A, B, C), center: c, orientation: R }}
                for i in 0..n {{
                    lower[i] {{ mass: m1, inertia: diag(J1, J1, K1), center: foot[i] + c1*L[i].z, orientation: L[i] }}
                    upper[i] {{ mass: m2, inertia: diag(J2, J2, K2), center: foot[i] + (s[i] - c2)*L[i].z, orientation: L[i] }}
                }}
            }}
            holonomic {{ for i in 0..n {{ closed[i]: foot[i] + s[i]*L[i].z = top[i]; }} }}
            gravity = vec(0, 0, -g);
            parameters {{ {parameters} }}
            forces {{ for i in 0..n {{ f[i] along dot(s[i]); }} }}
        }}"
    )
}

/// The same, with the plate on a quaternion.
pub fn platform_on_quaternion(parameters: &str) -> String {
    platform(parameters)
        .replace("yaw, pitch, roll", "q0, q1, q2, q3")
        .replace("rot_z(yaw)*rot_y(pitch)*rot_x(roll)", "quaternion(q0, q1, q2, q3)")
        .replace("holonomic {", "holonomic { size: q0^2 + q1^2 + q2^2 + q3^2 = 1;")
}

/// A plate in the plane on three legs of two links, with motors at the feet; a leg is stretched where `e[i]` is zero.
pub fn planar_platform() -> String {
    "pub system Planar {
        count n = 3;
        constants { M > 0, C > 0, m > 0, J > 0, l > 0, px[n], py[n], bx[n], by[n], g = 9.81 }
        inputs { u[n] }
        coordinates { q[n], e[n], x, y, phi }
        let O = rot_z(phi);
        let c = vec(x, y, 0);
        for i in 0..n {
            let A[i] = rot_z(q[i]);
            let B[i] = A[i]*rot_z(e[i]);
            let elbow[i] = vec(px[i], py[i], 0) + l*A[i].x;
        }
        bodies {
            plate { mass: M, inertia: diag(C, C, C), center: c, orientation: O }
            for i in 0..n {
                upper[i] { mass: m, inertia: diag(0, J, J), center: elbow[i] - l/2*A[i].x, orientation: A[i] }
                lower[i] { mass: m, inertia: diag(0, J, J), center: elbow[i] + l/2*B[i].x, orientation: B[i] }
            }
        }
        holonomic { for i in 0..n { closed[i]: elbow[i] + l*B[i].x = c + O*vec(bx[i], by[i], 0); } }
        gravity = vec(0, -g, 0);
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        forces { for i in 0..n { u[i] along w[i]; } }
    }"
    .to_owned()
}
