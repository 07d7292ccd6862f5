//! Declarations of bodies that roll, shared like those of `declarations.rs`.

/// A ball with three moments of inertia on a belt, in quaternions.
#[macro_export]
macro_rules! belt_ball {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// A ball with three moments of inertia on a belt that goes to and fro along the first axis.
        pub system BeltBall {
            constants { m > 0, a > 0, A > 0, B > 0, C > 0, u, nu }
            coordinates { w, i, j, k, x, y }
            let R = quaternion(w, i, j, k);
            bodies { ball { mass: m, inertia: diag(A, B, C), center: vec(x, y, a), orientation: R } }
            parameters { spin = angular_velocity_body(R); }
            constraints { rolling: ball.velocity_at(vec(x, y, 0)) = vec(u*cos(nu*t), 0, 0); }
            holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
            $($($more)*)?
        }
    } };
}

/// The hoop in quaternions, its contact found from the axle.
#[macro_export]
macro_rules! quaternion_hoop {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// The contact is found from the axle: the lowest point of the rim. Quaternions in place of angles.
        pub system QuaternionHoop {
            constants { a > 0, A > 0, C > 0, g = 9.81 }
            coordinates { w, i, j, k, xi, eta, zeta }
            let R = quaternion(w, i, j, k);
            bodies { hoop { mass: 1, inertia: diag(A, A, C), center: vec(xi, eta, zeta), orientation: R } }
            let up = vec(0, 0, 1);
            let contact = hoop.center - a*unit(up - inner(up, R.z)*R.z);
            gravity = -g*up;
            parameters { spin = angular_velocity_body(R); }
            constraints { rolling: hoop.velocity_at(contact) = 0; }
            holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
            outputs { axle = R.z; touch = contact; }
            $($($more)*)?
        }
    } };
}

/// A rattleback.
#[macro_export]
macro_rules! rattleback {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// A rattleback: an ellipsoid on the plane whose axes of inertia are turned against its own.
        pub system Rattleback {
            constants { m > 0, a > 0, b > 0, c > 0, h, A > 0, B > 0, C > 0, D, g = 9.81 }
            coordinates { yaw, roll, pitch, x, y, z }
            let R = rot_z(yaw)*rot_x(roll)*rot_y(pitch);
            let n = transpose(R)*vec(0, 0, 1);
            let size = sqrt((a*n.x)^2 + (b*n.y)^2 + (c*n.z)^2);
            let lowest = vec(a^2*n.x, b^2*n.y, c^2*n.z)/-size;
            let p = vec(x, y, z);
            bodies { stone { mass: m, inertia: sym(A, B, C, D, 0, 0), center: p, orientation: R } }
            gravity = vec(0, 0, -g);
            parameters { spin = angular_velocity_body(R); }
            constraints { rolling: stone.velocity_at(p + R*(lowest + vec(0, 0, h))) = 0; }
            $($($more)*)?
        }
    } };
}

/// The rattleback in quaternions, by its spins.
#[macro_export]
macro_rules! quaternion_rattleback {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $crate::quaternion_rattleback_by! {
        $($consumer)::+, QuaternionRattleback, { spin = angular_velocity_body(R); }, $($($more)*)?
    } };
}

/// The rattleback in quaternions, by the rates of three entries: the fourth has an edge at zero.
#[macro_export]
macro_rules! rate_rattleback {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $crate::quaternion_rattleback_by! {
        $($consumer)::+, RateRattleback, { u = dot(i); v = dot(j); r = dot(k); }, $($($more)*)?
    } };
}

/// The rattleback in quaternions, by some parameters.
#[doc(hidden)]
#[macro_export]
macro_rules! quaternion_rattleback_by {
    ($($consumer:ident)::+, $System:ident, { $($parameters:tt)* }, $($more:tt)*) => { $($consumer)::+! {
        /// The rattleback, quaternions in place of angles.
        pub system $System {
            constants { m > 0, a > 0, b > 0, c > 0, h, A > 0, B > 0, C > 0, D, g = 9.81 }
            coordinates { w, i, j, k, x, y, z }
            let R = quaternion(w, i, j, k);
            let n = transpose(R)*vec(0, 0, 1);
            let size = sqrt((a*n.x)^2 + (b*n.y)^2 + (c*n.z)^2);
            let lowest = vec(a^2*n.x, b^2*n.y, c^2*n.z)/-size;
            let p = vec(x, y, z);
            bodies { stone { mass: m, inertia: sym(A, B, C, D, 0, 0), center: p, orientation: R } }
            gravity = vec(0, 0, -g);
            parameters { $($parameters)* }
            constraints { rolling: stone.velocity_at(p + R*(lowest + vec(0, 0, h))) = 0; }
            holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
            $($more)*
        }
    } };
}

/// A car with a trailer on five wheels that roll, by the angle at the hitch.
#[macro_export]
macro_rules! rig {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// A car with a trailer on five rolling wheels: ten coordinates and eight constraints.
        pub system Rig {
            constants { m > 0, I > 0, w > 0, J > 0, r > 0, l > 0, b > 0, d > 0 }
            inputs { push, handle }
            coordinates { x, y, yaw, steer, trailing, left, right, front, near, off }
            let up = vec(0, 0, r);
            let C = rot_z(yaw); let F = C*rot_z(steer); let T = C*rot_z(trailing);
            let rear = vec(x, y, r);
            let nose = rear + l*C.x;
            let axle = rear - d*T.x;
            bodies {
                car     { mass: m, inertia: diag(0, 0, I), center: rear + l/2*C.x, orientation: C }
                trailer { mass: m/2, inertia: diag(0, 0, I/2), center: axle, orientation: T }
                one     { mass: w, inertia: diag(J/2, J, J/2), center: rear + b*C.y, orientation: C*rot_y(left) }
                two     { mass: w, inertia: diag(J/2, J, J/2), center: rear - b*C.y, orientation: C*rot_y(right) }
                three   { mass: w, inertia: diag(J/2, J, J/2), center: nose, orientation: F*rot_y(front) }
                four    { mass: w, inertia: diag(J/2, J, J/2), center: axle + b*T.y, orientation: T*rot_y(near) }
                five    { mass: w, inertia: diag(J/2, J, J/2), center: axle - b*T.y, orientation: T*rot_y(off) }
            }
            parameters { speed = inner(C.x, dot(rear)); steering = dot(steer); }
            constraints {
                rear_axle:    inner(C.y, dot(rear)) = 0;
                front_axle:   inner(F.y, dot(nose)) = 0;
                trailer_axle: inner(T.y, dot(axle)) = 0;
                roll_one:     inner(C.x, one.velocity_at(rear + b*C.y - up)) = 0;
                roll_two:     inner(C.x, two.velocity_at(rear - b*C.y - up)) = 0;
                roll_three:   inner(F.x, three.velocity_at(nose - up)) = 0;
                roll_four:    inner(T.x, four.velocity_at(axle + b*T.y - up)) = 0;
                roll_five:    inner(T.x, five.velocity_at(axle - b*T.y - up)) = 0;
            }
            forces { push along speed; handle along steering; }
            $($($more)*)?
        }
    } };
}
