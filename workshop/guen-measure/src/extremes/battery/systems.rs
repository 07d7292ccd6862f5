//! The systems, with Taylor series where Taylor's method is asked, and every one in doubles and in 71 digits.

/// A system with the same constants in doubles, in 71 digits, prepared.
#[macro_export]
macro_rules! both {
    ($System:ident { $($constant:ident: $value:expr),* $(,)? }) => {{
        use guen::Real as _;
        let double = $System { $($constant: $value),* }.prepare();
        let long = $System { $($constant: guen_study::Digits71::from_f64($value)),* }.prepare();
        (double.expect("constants in their bounds"), long.expect("constants in their bounds"))
    }};
}

guen_benchmarks::hoop!(guen::mechanical_system; provide taylor;);
guen_benchmarks::sled!(guen::mechanical_system; provide taylor;);
guen_benchmarks::euler_top!(guen::mechanical_system; provide taylor;);

guen::mechanical_system! {
    /// A mass on a spring, damped: `m v' = -k q - c v`.
    pub system Damped {
        constants { m > 0, k, c >= 0 }
        coordinates { q }
        parameters { v = dot(q); }
        kinetic_energy   = m/2*v^2;
        potential_energy = k/2*q^2;
        forces { -c*v along v; }
        provide taylor;
    }
}

guen::mechanical_system! {
    /// A pendulum on a stiff rod: a slow swing and a fast spring, without damping.
    pub system Rod {
        constants { m > 0, l > 0, k > 0, g = 9.81 }
        coordinates { r, q }
        parameters { u = dot(r); w = dot(q); }
        kinetic_energy   = m/2*(u^2 + r^2*w^2);
        potential_energy = k/2*(r - l)^2 - m*g*r*cos(q);
        provide taylor;
    }
}

guen::mechanical_system! {
    /// A ball on a table whose speed swings through zero.
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
        provide taylor;
    }
}

guen::mechanical_system! {
    /// A pendulum as a particle on a circle.
    pub system Circle {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { x, y }
        parameters { omega = (x*dot(y) - y*dot(x))/l^2; }
        holonomic { rod: x^2 + y^2 = l^2; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*y;
        provide taylor;
    }
}

/// A chain of point masses on massless links, the last mass of its own.
macro_rules! chain {
    ($docs:literal, $Name:ident: $($q:ident $w:ident $here:ident $before:ident,)* ; $last:ident $($more:tt)*) => {
        guen::mechanical_system! {
            #[doc = $docs]
            pub system $Name {
                constants { m > 0, M > 0, l > 0, g = 9.81 }
                coordinates { $($q),* }
                let origin = vec(0, 0);
                $(let $here = $before + vec(l*sin($q), -l*cos($q));)*
                parameters { $($w = dot($q);)* }
                particles { $(m at $here;)* M at $last; }
                gravity = vec(0, -g);
                $($more)*
            }
        }
    };
}

chain!("A double pendulum.", Chain2: q1 w1 p1 origin, q2 w2 p2 p1, ; p2 provide taylor;);
chain!("A chain of twenty links.", Chain20:
    q1 w1 p1 origin, q2 w2 p2 p1, q3 w3 p3 p2, q4 w4 p4 p3, q5 w5 p5 p4,
    q6 w6 p6 p5, q7 w7 p7 p6, q8 w8 p8 p7, q9 w9 p9 p8, q10 w10 p10 p9,
    q11 w11 p11 p10, q12 w12 p12 p11, q13 w13 p13 p12, q14 w14 p14 p13, q15 w15 p15 p14,
    q16 w16 p16 p15, q17 w17 p17 p16, q18 w18 p18 p17, q19 w19 p19 p18, q20 w20 p20 p19, ; p20);
