//! A declared system made anew over other reals: from its constants, prepared, and with inputs held.

use guen::prelude::*;
use guen::{Approx7, WithScalar, mechanical_system};

mechanical_system! {
    /// A pendulum.
    pub system Pendulum {
        constants   { l > 0, g = 9.81 }
        coordinates { q }
        parameters  { w = dot(q); }
        kinetic_energy   = l^2*w^2/2;
        potential_energy = -g*l*cos(q);
    }
}

mechanical_system! {
    pub system Free {
        coordinates { x }
        parameters  { v = dot(x); }
        kinetic_energy = v^2/2;
    }
}

mechanical_system! {
    pub system Cart {
        constants   { m > 0 }
        coordinates { x }
        parameters  { v = dot(x); }
        inputs      { f }
        kinetic_energy = m*v^2/2;
        forces { f along v; }
    }
}

#[test]
fn constants_and_prepared_systems_are_made_anew() {
    let pendulum = Pendulum { l: 0.1, g: 9.81 };
    let long = pendulum.with_scalar::<Approx7>().unwrap();
    assert_eq!(long.constants().l.value, 0.1);
    // Hoisted values are computed again, in the arithmetic of the other real.
    let short = pendulum.prepare().unwrap().with_scalar::<f32>().unwrap();
    assert_eq!(short, Pendulum { l: 0.1_f32, g: 9.81 }.prepare().unwrap());
    let free = Free::<f64>::new().with_scalar::<f32>().unwrap();
    assert_eq!(free.rhs(0.0_f32, &free::State { x: 1.0, v: 2.0 }).x, 2.0);
}

#[test]
fn a_constant_too_large_for_a_short_real_is_refused() {
    let pendulum = Pendulum { l: 1e100, g: 9.81 };
    assert!(pendulum.with_scalar::<f64>().is_ok());
    let error = pendulum.with_scalar::<f32>().unwrap_err();
    assert!(matches!(error, guen::ConstantsError::NotFinite { name: "l", .. }), "{error}");
}

#[test]
fn inputs_are_held_over_the_other_real() {
    let driven = Cart { m: 2.0 }.prepare().unwrap().driven(cart::Inputs { f: 3.0 });
    let short = driven.with_scalar::<f32>().unwrap();
    assert_eq!(System::rhs(&short, 0.0_f32, &[0.0, 1.0]), [1.0, 1.5]);
}
