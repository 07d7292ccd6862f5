//! The struct of constants: `new`, `Default`, defaults of earlier constants, and what `prepare` refuses.

use guen::{ConstantsError, Derived};

cart!(guen::mechanical_system);
sled!(guen::mechanical_system);

guen::mechanical_system! {
    /// Every constant has a default.
    pub system Settled {
        constants { k > 0 = 2, l = 3*k^2 - 1, ratio = k/(l + 1), root = sqrt(k)*pi, tiny = 6.62607015e-34 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = k/2*v^2;
        potential_energy = (l + ratio + root + tiny)/2*x^2;
    }
}

guen::mechanical_system! {
    /// The sled with nothing promised about `alpha` and `k`: their squares may both vanish.
    pub system LightSled {
        constants { m > 0, alpha, k, q != 0 }
        coordinates { phi, xi, eta }
        parameters { turning = dot(phi); running = dot(xi)*cos(phi) + dot(eta)*sin(phi); }
        constraints { blade: dot(xi)*sin(phi) - dot(eta)*cos(phi) = 0; }
        kinetic_energy = m/2*(dot(xi + alpha*cos(phi))^2 + dot(eta + alpha*sin(phi))^2) + m/2*k^2*turning^2;
        potential_energy = q*xi;
    }
}

#[test]
fn new_takes_constants_without_default_in_order() {
    let cart: Cart = Cart::new(2.0, 0.6);
    assert_eq!((cart.M, cart.m, cart.l, cart.c, cart.g), (2.0, 0.6, 0.5, 0.1, 9.81));
    assert_eq!(cart.I, Derived::Follows);
    assert!((cart.resolved().I.value().unwrap() - 0.05).abs() < 1e-16);
    let prepared = cart.prepare().unwrap();
    assert_eq!(prepared.constants(), cart);
}

#[test]
fn default_exists_where_all_have_one() {
    let settled: Settled = Settled::default();
    assert_eq!(settled, Settled::new());
    let values = settled.resolved();
    assert_eq!((values.k, values.l), (2.0, Derived::Set(11.0)));
    assert!((values.ratio.value().unwrap() - 1.0 / 6.0).abs() < 1e-16);
    let root = std::f64::consts::SQRT_2 * std::f64::consts::PI;
    assert!((values.root.value().unwrap() - root).abs() < 1e-15);
    assert_eq!(values.tiny, 6.62607015e-34);
    // What follows does so in a literal too, and what follows what follows.
    let other = Settled { k: 4.0, ..settled };
    assert_eq!(other.resolved().l, 47.0);
    assert_eq!(other.resolved().ratio, 4.0 / 48.0);
    // A number that was set stays, and what follows it goes on from there.
    let set = Settled { k: 4.0, l: 7.0.into(), ..Settled::new() }.resolved();
    assert_eq!((set.l, set.ratio), (Derived::Set(7.0), Derived::Set(0.5)));
    assert!(other.prepare().is_ok());
}

#[test]
fn prepare_refuses_what_is_not_finite() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        match Sled::new(1.0, value, 0.1, 0.5, 0.3).prepare() {
            Err(ConstantsError::NotFinite { name: "alpha", value: found }) => {
                assert_eq!(found.to_bits(), value.to_bits());
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn prepare_refuses_what_is_out_of_bound() {
    let refused = |cart: Cart, name: &str, bound: &str, value: f64| match cart.prepare() {
        Err(ConstantsError::OutOfBound { name: n, bound: b, value: v }) => {
            assert_eq!((n, b, v), (name, bound, value));
        }
        other => panic!("{other:?}"),
    };
    refused(Cart::new(0.0, 0.6), "M", "M > 0", 0.0);
    refused(Cart::new(2.0, -0.6), "m", "m > 0", -0.6);
    refused(Cart { c: -0.1, ..Cart::new(2.0, 0.6) }, "c", "c >= 0", -0.1);
    assert!(Cart { c: 0.0, ..Cart::new(2.0, 0.6) }.prepare().is_ok());
    match LightSled::new(1.0, 0.2, 0.3, 0.0).prepare() {
        Err(ConstantsError::OutOfBound { name: "q", bound: "q != 0", .. }) => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn prepare_refuses_a_pivot_of_constants_that_vanishes() {
    for (alpha, k) in [(0.2, 0.3), (0.0, 0.3), (0.2, 0.0)] {
        assert!(LightSled::new(1.0, alpha, k, 1.0).prepare().is_ok());
    }
    match LightSled::new(1.0, 0.0, 0.0, 1.0).prepare() {
        Err(error @ ConstantsError::SingularPivot { what, value: 0.0 }) => {
            assert!(what.contains("alpha") && what.contains('k'), "{what}");
            assert!(error.to_string().contains(what));
        }
        other => panic!("{other:?}"),
    }
}
