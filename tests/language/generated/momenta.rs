//! Momenta that the kinetic energy does not speak of are unknown, not zero.

use guen::prelude::*;

/// A point whose second coordinate is bound to the first; its energy is completed by the caller.
macro_rules! point {
    ($module:ident, $($energy:tt)*) => {
        mod $module {
            guen::mechanical_system! {
                /// A point on a line.
                pub system Point {
                    constants { m > 0 }
                    coordinates { x, y }
                    parameters { u = dot(x); }
                    constraints { bound: dot(y) = 2*dot(x); }
                    kinetic_energy = $($energy)*;
                }
            }
        }
    };
}

point!(given_on_the_constraints, 5 / 2 * m * u ^ 2);
point!(stated_as_zero, 5 / 2 * m * u ^ 2 + 0 * bound);
point!(in_velocities, m / 2 * (dot(x) ^ 2 + dot(y) ^ 2));

#[test]
fn what_is_not_stated_is_no_field() {
    let unknown = "(dT°/dbound) is unknown: T is given on the constraints";
    assert_eq!(given_on_the_constraints::point::Momenta::NAMES, ["u"]);
    assert!(given_on_the_constraints::point::REPORT.lines("Momenta").contains(&unknown));
    assert_eq!(stated_as_zero::point::Momenta::NAMES, ["u", "bound"]);
    assert_eq!(stated_as_zero::point::Reactions::NAMES, ["bound"]);
    assert_eq!(in_velocities::point::Momenta::NAMES, ["u", "bound"]);
}

#[test]
fn what_is_stated_has_its_value() {
    let system = in_velocities::Point { m: 3.0 }.prepare().unwrap();
    let state = in_velocities::point::State { x: 0.0, y: 0.0, u: 1.5 };
    let momenta = system.momenta(0.0, &state);
    // T° = m/2 (u^2 + (bound + 2 u)^2): m 5 u along u, m 2 u along the constraint.
    assert_eq!((momenta.u, momenta.bound), (22.5, 9.0));
    let other = stated_as_zero::Point { m: 3.0 }.prepare().unwrap();
    let momenta = other.momenta(0.0, &stated_as_zero::point::State { x: 0.0, y: 0.0, u: 1.5 });
    assert_eq!((momenta.u, momenta.bound), (22.5, 0.0));
    assert_eq!(System::rhs(&system, 0.0, &[0.0, 0.0, 1.5]), System::rhs(&other, 0.0, &[0.0, 0.0, 1.5]));
}

#[test]
fn brackets_of_small_systems_are_followed_to_the_end() {
    const { assert!(in_velocities::point::GROWTH_IS_COMPLETE && in_velocities::point::INTEGRABLE == 1) }
}
