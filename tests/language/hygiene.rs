//! The expansion in hostile surroundings: shadowed names, no prelude, functions, macros, strict lints.
//!
//! What compiles has passed; a few lines run as well. The facade under another name, and lints that are denied for a
//! whole crate, are in `tests/hygiene/strict.rs`, which `tests/toolchain/hygiene.rs` compiles.

#![allow(dead_code, reason = "most systems here only have to compile")]

/// Every name that the expansion might have taken from its surroundings means something else here.
mod shadowed {
    #![allow(non_camel_case_types, reason = "the names are the point")]

    pub struct Result;
    pub struct Option;
    pub struct Some;
    pub struct None;
    pub struct Ok;
    pub struct Err;
    pub struct Vec;
    pub struct String;
    pub struct Copy;
    pub struct Clone;
    pub struct Default;
    pub struct Debug;
    pub struct From;
    pub struct Into;
    pub struct PartialEq;
    pub struct Real;
    pub struct State;
    pub struct Prepared;
    pub struct f64;
    pub struct usize;
    pub mod core {}
    pub mod std {}
    pub mod guen_runtime {}
    pub mod program {}

    ::guen::mechanical_system! {
        pub system Bead {
            constants { m > 0, R > 0, g = 9.81, J = m*R^2 }
            inputs { u }
            coordinates { theta }
            parameters { omega = dot(theta); }
            kinetic_energy = (m*R^2 + J)/2*omega^2;
            potential_energy = -m*g*R*cos(theta);
            forces { u along omega; }
            outputs { height = R*cos(theta); place = vec(theta, 0); }
        }
    }
}

/// No prelude, so that not even `Option` has a name.
mod without_prelude {
    #![no_implicit_prelude]

    ::guen::mechanical_system! {
        pub system Sled {
            constants { m > 0, k > 0, alpha }
            coordinates { phi, x, y }
            parameters { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
            constraints { blade: dot(x)*sin(phi) = dot(y)*cos(phi); }
            let center_x = x + alpha*cos(phi);
            let center_y = y + alpha*sin(phi);
            kinetic_energy = m/2*(dot(center_x)^2 + dot(center_y)^2) + m/2*k^2*turning^2;
        }
    }
}

/// Two systems side by side, one named like the module of the other would be.
mod neighbours {
    guen::mechanical_system! {
        pub system Hoop {
            coordinates { x }
            parameters { u = dot(x); }
            kinetic_energy = u^2/2;
        }
    }
    guen::mechanical_system! {
        pub(crate) system hoops {
            coordinates { x }
            parameters { u = dot(x); }
            kinetic_energy = u^2;
        }
    }
}

/// Every visibility.
mod visibilities {
    pub mod inner {
        guen::mechanical_system! {
            pub(super) system Above { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2/2; }
        }
        guen::mechanical_system! {
            system Private { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2/2; }
        }
        guen::mechanical_system! {
            pub(in crate::hygiene::visibilities) system Within { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2/2; }
        }
        pub fn rate() -> f64 {
            let system = Private::<f64>::default().prepare().unwrap();
            system.rhs(0.0, &private::State { x: 0.0, u: 2.0 }).x
        }
    }

    #[test]
    fn are_respected() {
        assert_eq!(inner::rate(), 2.0);
        assert!(
            inner::Above::<f64>::default().prepare().is_ok()
                && inner::Within::<f64>::default().prepare().is_ok()
        );
        let _ = inner::above::State::<f64>::default();
    }
}

/// Names that collide with what is generated: operators, constants, variants, keywords; and Greek letters.
mod names {
    guen::mechanical_system! {
        pub system Odd {
            constants { CLASS > 0, X0, None, Some = 2, t0, state = CLASS*3, COST, DOMAIN }
            coordinates { X1, X2, r#type, θ, system, value }
            parameters {
                η_1 = dot(θ);
                r#fn = dot(r#type);
                rate = dot(X1);
                inputs = dot(X2);
                s = dot(system);
                k = dot(value);
            }
            kinetic_energy = CLASS/2*(η_1^2 + r#fn^2 + rate^2 + inputs^2 + s^2 + k^2);
            force_function = -X0*X1 - None*θ^2 - Some*r#type - t0*t*value - state*X2 - COST*DOMAIN*system;
        }
    }

    #[test]
    fn are_kept() {
        let odd = Odd::new(1.0, 2.0, 3.0, 0.5, 0.0, 0.0).prepare().unwrap();
        let state = odd::State { X1: 0.0, r#type: 0.0, θ: 1.0, η_1: 4.0, r#fn: 5.0, ..Default::default() };
        let rate = odd.rhs(0.0, &state);
        assert_eq!((rate.θ, rate.r#type, rate.rate, rate.r#fn, rate.inputs), (4.0, 5.0, -2.0, -2.0, -3.0));
        assert_eq!(odd::State::NAMES[2], "type");
    }
}

/// A path of one's own: a macro of another crate that exports this one.
mod exported {
    pub mod elsewhere {
        pub use guen as mechanics;
    }

    guen::__private::mechanical_system! {
        crate = crate::hygiene::exported::elsewhere::mechanics;
        pub system Free { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2/2; }
    }
}

/// Expressions and names that come through `macro_rules!` stand in invisible groups.
macro_rules! oscillator {
    ($visibility:vis $name:ident, $mass:expr, $potential:expr, $x:ident, $two:literal) => {
        guen::mechanical_system! {
            $visibility system $name {
                coordinates { $x }
                parameters { u = dot($x); }
                kinetic_energy = $mass*u^$two/$two;
                potential_energy = $potential;
            }
        }
    };
}

oscillator!(pub Spring, 1 + 2, 6*q^2 + q, q, 2);

#[test]
fn groups_of_macros_are_parentheses() {
    let spring = Spring::<f64>::default().prepare().unwrap();
    // 3 q'' = -12 q - 1
    let rate = spring.rhs(0.0, &spring::State { q: 1.0, u: 0.0 });
    assert!((rate.u + 13.0 / 3.0_f64).abs() < 1e-15);
}

#[test]
fn inside_of_a_function() {
    guen::mechanical_system! {
        system Local {
            constants { g = 9.81 }
            coordinates { x }
            parameters { u = dot(x); }
            kinetic_energy = u^2/2;
            force_function = -g*x;
        }
    }
    let local = Local::<f64>::default().prepare().unwrap();
    assert_eq!(local.rhs(0.0, &local::State { x: 0.0, u: 1.0 }).u, -9.81);
}

/// No parameter at all, or no constant.
mod sparse {
    guen::mechanical_system! {
        pub system Guided {
            constants { a > 0 }
            coordinates { x }
            holonomic { path: x = a*sin(t); }
            kinetic_energy = dot(x)^2/2;
        }
    }

    #[test]
    fn a_guided_system_moves_by_itself() {
        let guided = Guided { a: 2.0 }.prepare().unwrap();
        assert_eq!(guided.rhs(0.0, &guided::State { x: 0.0 }).x, 2.0);
    }
}
