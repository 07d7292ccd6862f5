//! The plant: a robot that balances on two wheels.

guen::mechanical_system! {
    /// A robot on two wheels, driven by motors between its chassis and the wheels.
    pub system Robot {
        constants {
            /// Masses of the chassis and of one wheel.
            m > 0, mw > 0,
            /// Height of the chassis' mass centre above the axle, half the track, radius of the wheels.
            h > 0, b > 0, r > 0,
            /// Moments of inertia of the chassis: roll, pitch, yaw.
            A > 0, B > 0, C > 0,
            /// Moments of inertia of a wheel: about a diameter, about its axle.
            I > 0, J > 0,
            /// Friction in each motor, in newton metres per radian per second.
            c >= 0,
            /// What a motor can give at most, in newton metres.
            torque_max > 0,
            g = 9.81,
        }
        inputs {
            left_torque in -torque_max..torque_max,
            right_torque in -torque_max..torque_max,
            /// Somebody pushes the chassis at its mass centre, along the heading: a disturbance, zero for the controller.
            push,
        }
        coordinates {
            /// The middle of the axle.
            x, y,
            heading,
            /// The lean of the chassis, forwards.
            tilt,
            /// The angles of the wheels, in the ground's axes.
            left, right,
        }
        let H = rot_z(heading);
        let axle = vec(x, y, r);
        let R = H*rot_y(tilt);
        bodies {
            chassis { mass: m, inertia: diag(A, B, C), center: axle + h*R.z, orientation: R }
            left_wheel { mass: mw, inertia: diag(I, J, I), center: axle + b*H.y, orientation: H*rot_y(left) }
            right_wheel { mass: mw, inertia: diag(I, J, I), center: axle - b*H.y, orientation: H*rot_y(right) }
        }
        gravity = vec(0, 0, -g);
        parameters {
            speed = inner(H.x, dot(axle));
            turn = dot(heading);
            fall = dot(tilt);
        }
        constraints {
            left_grip: left_wheel.velocity_at(left_wheel.center - vec(0, 0, r)) = 0;
            right_grip: inner(H.x, right_wheel.velocity_at(right_wheel.center - vec(0, 0, r))) = 0;
        }
        forces {
            left_torque - c*(dot(left) - fall) along dot(left) - fall;
            right_torque - c*(dot(right) - fall) along dot(right) - fall;
            push along inner(H.x, chassis.velocity_at(chassis.center));
        }
    }
}
