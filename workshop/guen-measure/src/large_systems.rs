//! Declarations as text, for those who ask how long an expansion takes: families by their number of links, and systems as
//! large as the language is meant for.

/// A planar snake of links with a wheel each: two coordinates more than links, a constraint for each of them.
pub fn snake(links: usize) -> String {
    let list = |first: usize, entry: &dyn Fn(usize) -> String| (first..=links).map(entry).collect::<String>();
    format!(
        "pub system Snake {{
            constants {{ m > 0, I > 0, l > 0 }}
            coordinates {{ x, y, {} }}
            {}
            let p1 = vec(x, y);
            {}
            bodies {{ {} }}
            parameters {{ speed = inner(A1.x, dot(p1)); turn = dot(q1); }}
            constraints {{ {} }}
        }}",
        list(1, &|i| format!("q{i}, ")),
        list(1, &|i| format!("let A{i} = rot_z(q{i});")),
        list(2, &|i| format!("let p{i} = p{0} - l*A{0}.x - l*A{i}.x;", i - 1)),
        list(1, &|i| format!("b{i} {{ mass: m, inertia: diag(0, 0, I), center: p{i}, orientation: A{i} }}")),
        list(1, &|i| format!("w{i}: inner(A{i}.y, dot(p{i})) = 0;")),
    )
}

/// Ten coordinates and five constraints: a tricycle on a belt that moves in two directions, its front contact found with
/// a square root, with a rider of three bodies whose arm is swung by a prescribed motion.
pub const TRICYCLE: &str = "pub system Tricycle {
    constants {
        rr > 0, rf > 0, base > 0, track > 0, mr > 0, mb > 0, mh > 0, mf > 0, I > 0, J > 0, K > 0, L > 0, v, e, nu, g = 9.81
    }
    inputs { pedal, handle }
    coordinates { x, y, yaw, steer, left, right, front, tilt, arm, hook }
    let up = vec(0, 0, 1);
    let B = rot_z(yaw);
    let axle = vec(x, y, rr);
    let H = B*rot_y(-0.3)*rot_z(steer);
    let W = H*rot_y(front);
    let tip = axle + base*B.x + H.x*e;
    let contact = tip - rf*unit(up - inner(up, H.y)*H.y);
    let P = B*rot_x(tilt);
    let Q = P*rot_y(arm + e*cos(nu*t));
    let Z = Q*rot_x(hook);
    let drift = vec(v, v*sin(nu*t), 0);
    let seat = axle + base/3*B.x;
    bodies {
        frame { mass: mb, inertia: sym(J, K, L, 0, 0, -J/4), center: axle + base/2*B.x, orientation: B }
        l { mass: mr, inertia: diag(I, 2*I, I), center: axle + track*B.y, orientation: B*rot_y(left) }
        r { mass: mr, inertia: diag(I, 2*I, I), center: axle - track*B.y, orientation: B*rot_y(right) }
        fork { mass: mh, inertia: diag(I, I, I/3), center: tip + e*H.z, orientation: H }
        wheel { mass: mf, inertia: diag(I, 2*I, I), center: tip, orientation: W }
        rider { mass: mb, inertia: diag(J, K, L), center: seat + e*P.z, orientation: P }
        limb { mass: mh, inertia: diag(J, K, L), center: seat + base*P.z + e*Q.z, orientation: Q }
        hand { mass: mh, inertia: diag(J, K, L), center: seat + base*P.z + base*Q.z + e*Z.z, orientation: Z }
    }
    gravity = -g*up;
    parameters {
        speed = inner(B.x, dot(axle) - drift); turn = dot(steer); lean = dot(tilt); bend = dot(arm); grab = dot(hook);
    }
    constraints {
        one: inner(B.x, l.velocity_at(axle + track*B.y - rr*up) - drift) = 0;
        two: inner(B.x, r.velocity_at(axle - track*B.y - rr*up) - drift) = 0;
        three: inner(B.y, dot(axle) - drift) = 0;
        ahead: inner(cross(up, H.y), wheel.velocity_at(contact) - drift) = 0;
        side: inner(H.y, wheel.velocity_at(contact) - drift) = 0;
    }
    forces {
        pedal*B.y along r.angular_velocity - frame.angular_velocity;
        handle*H.z along fork.angular_velocity - frame.angular_velocity;
    }
}";

/// Nine coordinates and three constraints: an ellipsoid that rolls on a turning table, with a rod on it that swings by a
/// prescribed motion and slides, and a particle in a tube.
pub const LADEN_ELLIPSOID: &str = "pub system LadenEllipsoid {
    constants {
        m > 0, mr > 0, mp > 0, a > 0, b > 0, c > 0, A > 0, B > 0, C > 0, l > 0, Omega, e, nu, g = 9.81
    }
    coordinates { x, y, z, yaw, roll, pitch, swing, slide, depth }
    let R = rot_z(yaw)*rot_x(roll)*rot_y(pitch);
    let n = transpose(R)*vec(0, 0, 1);
    let size = sqrt((a*n.x)^2 + (b*n.y)^2 + (c*n.z)^2);
    let lowest = vec(a^2*n.x, b^2*n.y, c^2*n.z)/-size;
    let p = vec(x, y, z);
    let S = R*rot_y(swing + e*sin(nu*t));
    let foot = p + R*lowest;
    bodies {
        stone { mass: m, inertia: diag(A, B, C), center: p, orientation: R }
        rod { mass: mr, inertia: diag(A, B, 0), center: p + (l + slide)*S.x, orientation: S }
    }
    particles { mp at p + depth*R.z; }
    gravity = vec(0, 0, -g);
    parameters { spin = angular_velocity_body(R); w = dot(swing); u = dot(slide); k = dot(depth); }
    constraints { rolling: stone.velocity_at(foot) = cross(vec(0, 0, Omega), foot); }
}";

/// A planar biped of seven bodies on heels and toes with friction, with stops in its knees and ankles: eight contacts, of whose combinations
/// twelve modes are left.
pub const BIPED: &str = "pub system Biped {
    constants {
        mt > 0 = 30, mh > 0 = 8, ms > 0 = 4, mf > 0 = 1, Jt > 0 = 2, Jh > 0 = 3/20, Js > 0 = 1/20, Jf > 0 = 1/200,
        lt > 0 = 3/10, lh > 0 = 2/5, ls > 0 = 2/5, lf > 0 = 1/5, mu >= 0 = 4/5, g = 9.81
    }
    inputs { hip[2], knee[2], ankle[2] }
    coordinates { x, z, trunk, thigh[2], shank[2], foot[2] }
    count n = 2;
    let H = vec(x, z);
    for i in 0..n {
        let K[i] = H + lh*vec(sin(thigh[i]), -cos(thigh[i]));
        let A[i] = K[i] + ls*vec(sin(shank[i]), -cos(shank[i]));
        let heel_at[i] = A[i] - lf/4*vec(cos(foot[i]), sin(foot[i]));
        let toe_at[i] = A[i] + 3*lf/4*vec(cos(foot[i]), sin(foot[i]));
    }
    bodies {
        torso { mass: mt, center: H + lt*vec(-sin(trunk), cos(trunk)), inertia: diag(0, 0, Jt), orientation: rot_z(trunk) }
        for i in 0..n {
            upper[i] { mass: mh, center: (H + K[i])/2, inertia: diag(0, 0, Jh), orientation: rot_z(thigh[i]) }
            lower[i] { mass: ms, center: (K[i] + A[i])/2, inertia: diag(0, 0, Js), orientation: rot_z(shank[i]) }
            sole[i] { mass: mf, center: (heel_at[i] + toe_at[i])/2, inertia: diag(0, 0, Jf), orientation: rot_z(foot[i]) }
        }
    }
    gravity = vec(0, -g);
    forces {
        for i in 0..n {
            hip[i] along dot(thigh[i]) - dot(trunk);
            knee[i] along dot(shank[i]) - dot(thigh[i]);
            ankle[i] along dot(foot[i]) - dot(shank[i]);
        }
    }
    contacts {
        for i in 0..n {
            heel[i]: gap = heel_at[i].y, slip = dot(heel_at[i]).x, friction = mu;
            toe[i]: gap = toe_at[i].y, slip = dot(toe_at[i]).x, friction = mu;
            kneecap[i]: gap = thigh[i] - shank[i];
            heel_cord[i]: gap = foot[i] - shank[i] + 1;
        }
    }
    modes {
        heel[0]: open, stick; toe[0]: open, stick; heel[1]: open, stick; toe[1]: open, stick;
        kneecap[0]: open, closed; kneecap[1]: open; heel_cord[0]: open; heel_cord[1]: open;
        never heel[0].stick with heel[1].stick;
        never toe[0].stick with toe[1].stick;
        never heel[1].stick with toe[0].stick;
        never heel[0].stick with toe[1].stick;
        never toe[1].stick with kneecap[0].closed;
    }
}";
