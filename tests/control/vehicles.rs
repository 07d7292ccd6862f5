//! A robot that balances on two wheels, and a car with two trailers.

guen::mechanical_system! {
    /// A robot on two wheels, driven by motors between its chassis and the wheels.
    pub system Robot {
        constants { m > 0, mw > 0, h > 0, b > 0, r > 0, A > 0, B > 0, C > 0, I > 0, J > 0, g = 9.81 }
        inputs { left_torque, right_torque }
        coordinates { x, y, heading, tilt, left, right }
        let H = rot_z(heading);
        let axle = vec(x, y, r);
        let R = H*rot_y(tilt);
        bodies {
            chassis { mass: m, inertia: diag(A, B, C), center: axle + h*R.z, orientation: R }
            one { mass: mw, inertia: diag(I, J, I), center: axle + b*H.y, orientation: H*rot_y(left) }
            other { mass: mw, inertia: diag(I, J, I), center: axle - b*H.y, orientation: H*rot_y(right) }
        }
        gravity = vec(0, 0, -g);
        parameters { speed = inner(H.x, dot(axle)); turn = dot(heading); fall = dot(tilt); }
        constraints {
            rolling: one.velocity_at(one.center - vec(0, 0, r)) = 0;
            other_rolling: inner(H.x, other.velocity_at(other.center - vec(0, 0, r))) = 0;
        }
        forces {
            left_torque*H.y along one.angular_velocity - chassis.angular_velocity;
            right_torque*H.y along other.angular_velocity - chassis.angular_velocity;
        }
        outputs {
            /// What an accelerometer in the chassis measures, in the world's axes.
            felt = dot(dot(chassis.center)) + vec(0, 0, g);
            pitching = dot(fall);
            grip = reaction(rolling);
        }
    }
}

guen::mechanical_system! {
    /// A car with two trailers, each hitched behind the axle of the one before it.
    pub system Train {
        constants { m > 0, I > 0, l > 0, d > 0, k > 0 }
        inputs { push, steering }
        coordinates { x, y, theta0, theta1, theta2, phi }
        let R0 = rot_z(theta0); let R1 = rot_z(theta1); let R2 = rot_z(theta2);
        let F = R0*rot_z(phi);
        let rear = vec(x, y);
        let front = rear + l*R0.x;
        let axle1 = rear - k*R0.x - d*R1.x;
        let axle2 = axle1 - k*R1.x - d*R2.x;
        bodies {
            car { mass: m, inertia: diag(0, 0, I), center: rear + l/3*R0.x, orientation: R0 }
            wheel { mass: m/10, inertia: diag(0, 0, I/10), center: front, orientation: F }
            trailer1 { mass: m/2, inertia: diag(0, 0, I/2), center: axle1 + d/4*R1.x, orientation: R1 }
            trailer2 { mass: m/2, inertia: diag(0, 0, I/2), center: axle2 + d/4*R2.x, orientation: R2 }
        }
        parameters { speed = inner(R0.x, dot(rear)); steer = dot(phi); }
        constraints {
            rear_axle: inner(R0.y, car.velocity_at(rear)) = 0;
            front_axle: inner(F.y, wheel.velocity_at(front)) = 0;
            first: inner(R1.y, trailer1.velocity_at(axle1)) = 0;
            second: inner(R2.y, trailer2.velocity_at(axle2)) = 0;
        }
        forces { push along speed; steering along steer; }
    }
}

/// The robot with figures of a small one.
pub fn small_robot() -> robot::Prepared {
    Robot { m: 10.0, mw: 1.0, h: 0.5, b: 0.3, r: 0.1, A: 0.5, B: 0.4, C: 0.2, I: 0.003, J: 0.005, g: 9.81 }
        .prepare()
        .unwrap()
}

/// The car with its trailers.
pub fn small_train() -> train::Prepared {
    Train { m: 3.0, I: 1.3, l: 1.1, d: 0.9, k: 0.3 }.prepare().unwrap()
}
