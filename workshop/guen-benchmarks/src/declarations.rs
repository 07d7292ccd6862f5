//! Declarations that tests, benchmarks and tables share. Each is a macro that hands its tokens to another one: to
//! `guen::mechanical_system` for items, to `stringify` for the text that the libraries below the macro take. What
//! follows the name and a `;` is added to the declaration: scenes.

/// The hoop of section 3.1, with free kinetic energy in the velocities.
#[macro_export]
macro_rules! hoop {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// The rolling hoop of section 3.1 as the paper has it: three parameters, three constraints, energy in velocities.
        pub system Hoop {
            constants { a > 0, A > 0, C > 0, g = 9.81 }
            coordinates { theta, psi, phi, xi, eta, zeta }
            parameters {
                eta1 = dot(theta);
                eta2 = dot(psi)*sin(theta);
                eta3 = dot(psi)*cos(theta) + dot(phi);
            }
            constraints {
                eta4: dot(xi) = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
                eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
                eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
            }
            kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
            force_function = -a*g*sin(theta);
            $($($more)*)?
        }
    } };
}

/// Appell's system of section 3.2, with the axial inertia of its body.
#[macro_export]
macro_rules! appell {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// Appell's system of section 3.2, with the axial inertia of its body.
        pub system Appell {
            constants { a > 0, A > 0, C > 0, g = 9.81 }
            coordinates { theta, psi, phi, xi, eta, zeta }
            parameters {
                eta1 = dot(theta);
                eta2 = dot(psi)*sin(theta);
                eta3 = dot(psi)*cos(theta) + dot(phi);
            }
            constraints {
                eta4: dot(xi) + a*sin(theta)*dot(theta) = 0;
                eta5: dot(eta) = 0;
                eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
            }
            kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2)
                           + 1/2*(A*eta1^2 + A*eta2^2 + (C + a^2)*eta3^2);
            force_function = -a*g*sin(theta);
            $($($more)*)?
        }
    } };
}

/// Chaplygin's sled of section 3.3.
#[macro_export]
macro_rules! sled {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// Chaplygin's sled of section 3.3 on an incline.
        pub system Sled {
            constants { m > 0, alpha, beta, k > 0, incline, g = 9.81 }
            coordinates { phi, xi, eta }
            parameters {
                eta1 = dot(phi);
                eta2 = dot(xi)*cos(phi) + dot(eta)*sin(phi);
            }
            constraints { eta3: dot(xi)*sin(phi) - dot(eta)*cos(phi) = 0; }
            let x = xi + alpha*cos(phi) - beta*sin(phi);
            let y = eta + alpha*sin(phi) + beta*cos(phi);
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + m/2*k^2*dot(phi)^2;
            force_function = m*g*sin(incline)*x;
            $($($more)*)?
        }
    } };
}

/// The sled in the parameters of the paper's closing remark.
#[macro_export]
macro_rules! sled_in_xi {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        pub system SledInXi {
            constants { m > 0, alpha, beta, k > 0, incline, g = 9.81 }
            coordinates { phi, xi, eta }
            parameters {
                eta1 = dot(phi);
                eta2 = dot(xi);
            }
            constraints { eta3: dot(xi)*sin(phi) - dot(eta)*cos(phi) = 0; }
            let x = xi + alpha*cos(phi) - beta*sin(phi);
            let y = eta + alpha*sin(phi) + beta*cos(phi);
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + m/2*k^2*dot(phi)^2;
            force_function = m*g*sin(incline)*x;
            $($($more)*)?
        }
    } };
}

/// A unicycle with a trailer of length `d`, hitched to the unicycle's axle.
#[macro_export]
macro_rules! trailer {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        pub system Trailer {
            constants { m > 0, J > 0, M > 0, K > 0, d > 0 }
            coordinates { x, y, heading, trailing }
            parameters {
                speed = dot(x)*cos(heading) + dot(y)*sin(heading);
                turning = dot(heading);
            }
            constraints {
                wheel: dot(x)*sin(heading) - dot(y)*cos(heading) = 0;
                axle: dot(x - d*cos(trailing))*sin(trailing) - dot(y - d*sin(trailing))*cos(trailing) = 0;
            }
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + J/2*turning^2
                           + M/2*(dot(x - d*cos(trailing))^2 + dot(y - d*sin(trailing))^2)
                           + K/2*dot(trailing)^2;
            $($($more)*)?
        }
    } };
}

/// A ball on a table that turns at a varying speed; `eta1..eta3` are its angular velocity in space.
#[macro_export]
macro_rules! turntable {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        pub system Turntable {
            constants { m > 0, a > 0, Omega, swing, nu }
            coordinates { x, y, psi, theta, phi }
            let speed = Omega + swing*sin(nu*t);
            parameters {
                eta1 = dot(theta)*cos(psi) + dot(phi)*sin(theta)*sin(psi);
                eta2 = dot(theta)*sin(psi) - dot(phi)*sin(theta)*cos(psi);
                eta3 = dot(psi) + dot(phi)*cos(theta);
            }
            constraints {
                east: dot(x) - a*eta2 + speed*y = 0;
                north: dot(y) + a*eta1 - speed*x = 0;
            }
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + m*a^2/5*(eta1^2 + eta2^2 + eta3^2);
            $($($more)*)?
        }
    } };
}

/// The same ball on a table that turns evenly.
#[macro_export]
macro_rules! even_turntable {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// A homogeneous ball on a table that turns evenly; the parameters are its angular velocity in space.
        pub system EvenTurntable {
            constants { m > 0, a > 0, Omega }
            coordinates { x, y, psi, theta, phi }
            parameters {
                eta1 = dot(theta)*cos(psi) + dot(phi)*sin(theta)*sin(psi);
                eta2 = dot(theta)*sin(psi) - dot(phi)*sin(theta)*cos(psi);
                eta3 = dot(psi) + dot(phi)*cos(theta);
            }
            constraints {
                east: dot(x) - a*eta2 + Omega*y = 0;
                north: dot(y) + a*eta1 - Omega*x = 0;
            }
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + m*a^2/5*(eta1^2 + eta2^2 + eta3^2);
            $($($more)*)?
        }
    } };
}

/// A free rigid body in Euler's angles and its angular velocity in the body.
#[macro_export]
macro_rules! euler_top {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// A free rigid body in Euler's angles and its angular velocity in the body.
        pub system EulerTop {
            constants { I1 > 0, I2 > 0, I3 > 0 }
            coordinates { psi, theta, phi }
            parameters {
                p = dot(psi)*sin(theta)*sin(phi) + dot(theta)*cos(phi);
                q = dot(psi)*sin(theta)*cos(phi) - dot(theta)*sin(phi);
                r = dot(psi)*cos(theta) + dot(phi);
            }
            kinetic_energy = 1/2*(I1*p^2 + I2*q^2 + I3*r^2);
            $($($more)*)?
        }
    } };
}

/// A pendulum on a cart that is pushed, with friction in the joint and wind: inputs, outputs, a default of earlier
/// constants.
#[macro_export]
macro_rules! cart {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        pub system Cart {
            constants { M > 0, m > 0, l > 0 = 1/2, I > 0 = m*l^2/3, c >= 0 = 0.1, g = 9.81 }
            inputs { push, wind }
            coordinates { x, phi }
            parameters { v = dot(x); omega = dot(phi); }
            let bob = vec(x + l*sin(phi), -l*cos(phi));
            kinetic_energy = M/2*v^2 + m/2*inner(dot(bob), dot(bob)) + I/2*omega^2;
            potential_energy = m*g*bob.y;
            forces {
                push along v;
                -c*omega along omega;
                wind*exp(-t) along dot(x + l*sin(phi));
            }
            outputs {
                height = bob.y;
                hinge = push - (M + m)*g;
                pointer = bob;
            }
            $($($more)*)?
        }
    } };
}

/// A pendulum as a particle on a circle: a constraint on positions, and its reaction.
#[macro_export]
macro_rules! particle_pendulum {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        pub system ParticlePendulum {
            constants { m > 0, l > 0, g = 9.81 }
            coordinates { x, y }
            parameters { omega = (x*dot(y) - y*dot(x))/l^2; }
            holonomic { rod: x^2 + y^2 = l^2; }
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
            potential_energy = m*g*y;
            $($($more)*)?
        }
    } };
}

/// A robot on two wheels, driven by motors between its chassis and the wheels.
#[macro_export]
macro_rules! robot {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
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
            $($($more)*)?
        }
    } };
}

/// A car with two trailers, each hitched behind the axle of the one before it.
#[macro_export]
macro_rules! train {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
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
            $($($more)*)?
        }
    } };
}

/// A car with five trailers, each hitched behind the axle of the one before it, by the angles at the hitches.
#[macro_export]
macro_rules! road_train {
    ($($consumer:ident)::+ $(; $($more:tt)*)?) => { $($consumer)::+! {
        /// A car with five trailers, each hitched behind the axle of the one before it, their loads ahead of their axles.
        pub system RoadTrain {
            constants { m > 0, J > 0, I > 0, l > 0, M > 0, K > 0, d > 0, k > 0 }
            coordinates { x, y, heading, steering, bend1, bend2, bend3, bend4, bend5 }
            let theta1 = heading + bend1;
            let theta2 = theta1 + bend2;
            let theta3 = theta2 + bend3;
            let theta4 = theta3 + bend4;
            let theta5 = theta4 + bend5;
            let e0 = vec(cos(heading), sin(heading));
            let e1 = vec(cos(theta1), sin(theta1));
            let e2 = vec(cos(theta2), sin(theta2));
            let e3 = vec(cos(theta3), sin(theta3));
            let e4 = vec(cos(theta4), sin(theta4));
            let e5 = vec(cos(theta5), sin(theta5));
            let rear = vec(x, y);
            let front = rear + l*e0;
            let axle1 = rear - k*e0 - d*e1;
            let axle2 = axle1 - k*e1 - d*e2;
            let axle3 = axle2 - k*e2 - d*e3;
            let axle4 = axle3 - k*e3 - d*e4;
            let axle5 = axle4 - k*e4 - d*e5;
            let load1 = axle1 + d/4*e1;
            let load2 = axle2 + d/4*e2;
            let load3 = axle3 + d/4*e3;
            let load4 = axle4 + d/4*e4;
            let load5 = axle5 + d/4*e5;
            parameters { speed = inner(e0, dot(rear)); turning = dot(steering); }
            constraints {
                rear_axle: dot(x)*sin(heading) - dot(y)*cos(heading) = 0;
                front_axle: inner(vec(-sin(heading + steering), cos(heading + steering)), dot(front)) = 0;
                first: inner(vec(-sin(theta1), cos(theta1)), dot(axle1)) = 0;
                second: inner(vec(-sin(theta2), cos(theta2)), dot(axle2)) = 0;
                third: inner(vec(-sin(theta3), cos(theta3)), dot(axle3)) = 0;
                fourth: inner(vec(-sin(theta4), cos(theta4)), dot(axle4)) = 0;
                fifth: inner(vec(-sin(theta5), cos(theta5)), dot(axle5)) = 0;
            }
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + J/2*dot(heading)^2 + I/2*dot(heading + steering)^2
                           + M/2*(inner(dot(load1), dot(load1)) + inner(dot(load2), dot(load2))
                                + inner(dot(load3), dot(load3)) + inner(dot(load4), dot(load4))
                                + inner(dot(load5), dot(load5)))
                           + K/2*(dot(theta1)^2 + dot(theta2)^2 + dot(theta3)^2 + dot(theta4)^2 + dot(theta5)^2);
            $($($more)*)?
        }
    } };
}
