//! The declared systems. Beside the items of each stands its declaration as text, for those who expand it themselves.

/// A declared system, and its declaration as a constant of text: one that is shared, by its name, or one of this file.
macro_rules! declared {
    ($text:ident, $declaration:ident) => {
        $declaration! { guen::mechanical_system }
        /// The declaration.
        pub const $text: &str = $declaration! { stringify };
    };
    ($text:ident, $($declaration:tt)*) => {
        ::guen::mechanical_system! { $($declaration)* }
        /// The declaration.
        pub const $text: &str = stringify!($($declaration)*);
    };
}

declared! { HOOP_TEXT, hoop }

declared! { BODYHOOP_TEXT,
    /// The same hoop as a body that rolls: what the paper writes out follows from the material point at the contact.
    pub system BodyHoop {
        constants { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters { eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = dot(psi)*cos(theta) + dot(phi); }
        let frame = rot_z(psi)*rot_x(theta);
        bodies { hoop { mass: 1, inertia: diag(A, A, C), center: vec(xi, eta, zeta), orientation: frame*rot_z(phi) } }
        gravity = vec(0, 0, -g);
        constraints { rolling: hoop.velocity_at(hoop.center - a*frame.y) = 0; }
    }
}

declared! { RATEHOOP_TEXT,
    /// The same hoop in velocities alone: the parameters are the rates of the angles.
    pub system RateHoop {
        constants { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters { tilting = dot(theta); turning = dot(psi); rolling = dot(phi); }
        constraints {
            east: dot(xi) = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            north: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            up: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2)
                       + A/2*dot(theta)^2 + A/2*dot(psi)^2*sin(theta)^2 + C/2*(dot(psi)*cos(theta) + dot(phi))^2;
        potential_energy = a*g*sin(theta);
    }
}

declared! { SLED_TEXT, sled }

declared! { APPELL_TEXT, appell }

declared! { TURNTABLE_TEXT, even_turntable }

declared! { EULERTOP_TEXT, euler_top }

/// A car, its mass above the middle of the rear axle, and trailers, each hitched to the axle before it. Given for each
/// trailer: its angle, its axle, the axle before, its constraint.
macro_rules! car {
    ($text:ident, $docs:literal, $name:ident: $($angle:ident $axle:ident $before:ident $constraint:ident,)*) => {
        declared! { $text,
            #[doc = $docs]
            pub system $name {
                constants { m > 0, J > 0, I > 0, l > 0, M > 0, K > 0, d > 0 }
                coordinates { x, y, heading, steering $(, $angle)* }
                parameters {
                    speed = dot(x)*cos(heading) + dot(y)*sin(heading);
                    turning = dot(steering);
                }
                let rear = vec(x, y);
                let front = rear + l*vec(cos(heading), sin(heading));
                $(let $axle = $before - d*vec(cos($angle), sin($angle));)*
                constraints {
                    rear_axle: dot(x)*sin(heading) - dot(y)*cos(heading) = 0;
                    front_axle: inner(vec(-sin(heading + steering), cos(heading + steering)), dot(front)) = 0;
                    $($constraint: inner(vec(-sin($angle), cos($angle)), dot($axle)) = 0;)*
                }
                kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + J/2*dot(heading)^2 + I/2*(dot(heading) + dot(steering))^2
                    $(+ M/2*inner(dot($axle), dot($axle)) + K/2*dot($angle)^2)*;
            }
        }
    };
}

car!(CAR1_TEXT, "A car with one trailer, coasting.", Car1: first axle1 rear hitch1,);
car!(CAR2_TEXT, "A car with two trailers, coasting.", Car2: first axle1 rear hitch1, second axle2 axle1 hitch2,);
car!(CAR3_TEXT, "A car with three trailers, coasting.", Car3:
    first axle1 rear hitch1, second axle2 axle1 hitch2, third axle3 axle2 hitch3,);

include!(concat!(env!("OUT_DIR"), "/chains.rs"));
include!(concat!(env!("OUT_DIR"), "/arms.rs"));
