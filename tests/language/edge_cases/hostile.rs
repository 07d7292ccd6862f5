//! Declared where little of the usual surroundings is left: no prelude, names of `core` taken, lints denied.

/// Nothing is in scope but what the module itself names.
mod bare {
    #![no_implicit_prelude]
    #![deny(missing_docs, unused_qualifications, unreachable_pub, warnings)]

    ::guen::mechanical_system! {
        /// An oscillator.
        pub system Oscillator {
            constants {
                /// Stiffness.
                k > 0 = 4
            }
            inputs {
                /// Push.
                push
            }
            coordinates {
                /// Place.
                q
            }
            parameters { v = dot(q); }
            kinetic_energy = 1/2*v^2;
            potential_energy = k/2*q^2;
            forces { push along v; }
            outputs { pull = -k*q; }
        }
    }
}

/// Names that macros like to use are something else here.
mod taken {
    #![allow(dead_code, non_camel_case_types, reason = "they are in the way on purpose")]

    pub struct Option;
    pub struct Result;
    pub struct Some;
    pub struct None;
    pub struct Default;
    pub struct From;
    pub struct Into;
    pub struct Real;
    pub struct System;
    pub struct f64;
    pub struct usize;
    pub struct str;
    pub mod core {}
    pub mod std {}

    ::guen::mechanical_system! {
        pub system Rolling {
            constants { m > 0, a > 0 }
            coordinates { x, angle }
            parameters { spin = dot(angle); }
            constraints { contact: dot(x) = a*dot(angle); }
            kinetic_energy = m/2*dot(x)^2 + m*a^2/4*dot(angle)^2;
            force_function = m*x;
        }
    }
}

/// Through a macro of one's own, with expressions as fragments, and privately.
mod wrapped {
    macro_rules! spring {
        ($name:ident, $x:ident, $energy:expr) => {
            ::guen::mechanical_system! {
                system $name {
                    coordinates { $x }
                    parameters { v = dot($x); }
                    kinetic_energy = v^2/2;
                    potential_energy = 2*$energy;
                }
            }
        };
    }
    spring!(Soft, q, q + q ^ 2);

    pub(super) fn pull(q: f64) -> f64 {
        Soft::new().prepare().unwrap().rhs(0.0, &soft::State { q, v: 0.0 }).v
    }
}

#[test]
fn without_a_prelude() {
    let system = bare::Oscillator::default().prepare().unwrap();
    let rate =
        system.rhs(0.0, &bare::oscillator::State { q: 0.5, v: 0.0 }, &bare::oscillator::Inputs { push: 3.0 });
    assert_eq!(rate.v, 1.0);
}

#[test]
fn among_other_names() {
    let system = taken::Rolling::new(2.0, 0.5).prepare().unwrap();
    let rate = system.rhs(0.0, &taken::rolling::State { x: 0.0, angle: 0.0, spin: 1.0 });
    // Three halves of m a^2 turn under the moment m a.
    let expected: f64 = 1.0 / (1.5 * 0.5);
    assert!((rate.spin - expected).abs() < 1e-15);
}

/// A fragment counts as parenthesised: `2*(q + q^2)`.
#[test]
fn through_a_macro() {
    assert_eq!(wrapped::pull(1.0), -6.0);
}
