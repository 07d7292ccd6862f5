//! Constants that follow others until they are set, in every way of making a system.

use guen::prelude::*;
use guen::{Approx7, ConstantsError, Derived, WithScalar, mechanical_system};

mechanical_system! {
    /// A disc that is turned, with a wheel whose moment follows the disc's.
    pub system Disc {
        constants { m > 0 = 1, r > 0 = 1, J > 0 = m*r^2/2, wheel = J/4 + 1, k }
        coordinates { q }
        parameters { w = dot(q); }
        kinetic_energy = (J + wheel)/2*w^2;
        potential_energy = k/2*q^2;
        scene Heavy { track w; fix m = 3; }
        scene Given { track w; fix J = 2; }
        scene Whole { track w; }
        // The mass is that of the wheel, which follows the moment, which follows the mass.
        scene Round { track w; fix m = wheel; }
    }
}

/// `k/(J + wheel)`, which the moments are known by.
fn rate(system: disc::Prepared) -> f64 {
    -system.rhs(0.0, &disc::State { q: 1.0, w: 0.0 }).w
}

fn expected(m: f64, r: f64, k: f64) -> f64 {
    let moment = m * r * r / 2.0;
    k / (moment + moment / 4.0 + 1.0)
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-15 * (1.0 + expected.abs()), "{found} and not {expected}");
}

#[test]
fn literals_and_what_is_taken_over() {
    let disc = Disc { m: 1.7, r: 0.6, ..Disc::new(0.3) };
    near(rate(disc.prepare().unwrap()), expected(1.7, 0.6, 0.3));
    let literal = Disc { m: 1.7, r: 0.6, J: Derived::Follows, wheel: Derived::Follows, k: 0.3 };
    assert_eq!(literal, disc);
    // Of a prepared system too: what it follows is not what it was.
    let other = Disc { m: 2.5, ..disc.prepare().unwrap().constants() };
    near(rate(other.prepare().unwrap()), expected(2.5, 0.6, 0.3));
    // A number that was set stays where others change, and what follows it follows that.
    let set = Disc { J: 2.0.into(), ..disc };
    near(rate(set.prepare().unwrap()), 0.3 / (2.0 + 1.5));
    let again = Disc { m: 9.0, ..set.prepare().unwrap().constants() };
    assert_eq!((again.J, again.wheel), (Derived::Set(2.0), Derived::Follows));
    near(rate(again.prepare().unwrap()), 0.3 / 3.5);
    assert_eq!(again.resolved().wheel, 1.5);
}

#[test]
fn what_follows_is_checked_as_what_is_given() {
    let bad = Disc { J: (-1.0).into(), ..Disc::new(0.3) };
    assert!(
        matches!(bad.prepare(), Err(ConstantsError::OutOfBound { name: "J", .. })),
        "{:?}",
        bad.prepare()
    );
    let bad = Disc { wheel: f64::NAN.into(), ..Disc::new(0.3) };
    assert!(matches!(bad.prepare(), Err(ConstantsError::NotFinite { name: "wheel", .. })));
    let large = Disc { m: 1e200, r: 1e200, ..Disc::new(0.3) };
    assert!(matches!(large.prepare(), Err(ConstantsError::NotFinite { name: "J", .. })));
}

#[test]
fn other_reals() {
    let disc = Disc { m: 1.7, r: 0.6, ..Disc::new(0.3) };
    let single = Disc::<f32> { m: 1.7, r: 0.6, ..Disc::new(0.3) }.prepare().unwrap();
    assert_eq!(disc.with_scalar::<f32>().unwrap(), single);
    assert_eq!(disc.prepare().unwrap().with_scalar::<f32>().unwrap(), single);
    let long = disc.prepare().unwrap().with_scalar::<Approx7>().unwrap();
    assert_eq!((long.constants().J, long.constants().wheel), (Derived::Follows, Derived::Follows));
    let set = Disc { J: 2.0.into(), ..disc }.with_scalar::<f32>().unwrap();
    assert_eq!(set.constants().J, 2.0_f32);
    // The derivative by the mass goes through what follows it: `d/dm k/(5/8 m r^2 + 1)`.
    let varied = Disc {
        m: Dual::<f64, 1>::variable(1.7, 0),
        r: Dual::constant(0.6),
        ..Disc::new(Dual::constant(0.3))
    };
    let rate = varied
        .prepare()
        .unwrap()
        .rhs(Dual::constant(0.0), &disc::State::from([1.0, 0.0].map(Dual::constant)));
    let slope = 0.625 * 0.36;
    near(rate.w.tangent[0], 0.3 * slope / (slope * 1.7 + 1.0_f64).powi(2));
    let lifted: disc::Prepared<Dual<f64, 1>> = disc.prepare().unwrap().lift();
    assert_eq!(lifted.constants().J, Derived::Follows);
}

#[test]
fn scenes() {
    let disc = Disc { m: 1.7, r: 0.6, ..Disc::new(0.3) };
    let whole = disc::Whole::from(disc);
    assert_eq!((whole.J, whole.system()), (Derived::Follows, disc));
    let rates = |rates: [f64; 2]| -rates[1];
    let at = [1.0, 0.0];
    near(rates(System::rhs(&whole.prepare().unwrap(), 0.0, &at)), expected(1.7, 0.6, 0.3));
    // Fixed values are followed.
    let heavy = disc::Heavy { r: 0.6, ..disc::Heavy::new(0.3) };
    near(rates(System::rhs(&heavy.prepare().unwrap(), 0.0, &at)), expected(3.0, 0.6, 0.3));
    near(rate(heavy.system().prepare().unwrap()), expected(3.0, 0.6, 0.3));
    assert!(disc::Heavy::try_from(disc).is_err());
    assert_eq!(disc::Heavy::try_from(Disc { m: 3.0, ..disc }).unwrap(), heavy);
    // What follows is compared by its value.
    assert!(disc::Given::try_from(disc).is_err());
    let given = disc::Given::try_from(Disc { m: 4.0, r: 1.0, ..disc }).unwrap();
    assert_eq!(given.system().J, 2.0);
    near(rates(System::rhs(&given.prepare().unwrap(), 0.0, &at)), 0.3 / 3.5);
    // Nothing follows itself: `m = wheel` and `wheel = m r^2/8 + 1`.
    let of_whole = Disc { m: 1.0 / (1.0 - 0.045), r: 0.6, ..disc };
    let round = disc::Round::try_from(of_whole);
    let round = round.unwrap_or_else(|_| {
        disc::Round::of(&Disc { wheel: of_whole.m.into(), ..of_whole }, &Default::default()).unwrap()
    });
    assert!((round.wheel - of_whole.m).abs() < 1e-15);
    assert_eq!(round.system().wheel, round.wheel);
}

#[test]
fn in_files() {
    let disc = Disc { m: 1.7, r: 0.6, ..Disc::new(0.3) };
    let text = serde_json::to_string(&disc).unwrap();
    assert_eq!(text, r#"{"m":1.7,"r":0.6,"J":null,"wheel":null,"k":0.3}"#);
    let read = |text: &str| serde_json::from_str::<Disc>(text);
    assert_eq!(read(&text).unwrap(), disc);
    assert_eq!(read(r#"{"m":1.7,"r":0.6,"k":0.3}"#).unwrap(), disc);
    let set = Disc { J: 2.0.into(), ..disc };
    assert_eq!(serde_json::to_string(&set).unwrap(), r#"{"m":1.7,"r":0.6,"J":2.0,"wheel":null,"k":0.3}"#);
    assert_eq!(read(r#"{"m":1.7,"r":0.6,"J":2,"k":0.3}"#).unwrap(), set);
    assert_eq!(read("[1.7, 0.6, 2.0, null, 0.3]").unwrap(), set);
    for wrong in [
        r#"{"m":1.7,"r":0.6}"#,
        r#"{"m":null,"r":0.6,"k":0.3}"#,
        r#"{"m":1.7,"r":0.6,"J":null,"J":2.0,"k":0.3}"#,
        r#"{"m":1.7,"r":0.6,"K":2.0,"k":0.3}"#,
        "[1.7, 0.6]",
    ] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}

/// Over lanes a constant follows where it does in every one of them.
#[test]
fn lanes() {
    use guen::Laned;
    let disc = Disc { m: 1.7, r: 0.6, ..Disc::new(0.3) };
    let members = [disc.prepare().unwrap(), Disc { J: 2.0.into(), ..disc }.prepare().unwrap()];
    let gathered: disc::Prepared<f64> = Laned::gather::<f64>(|_| &members[1]);
    assert_eq!(gathered, members[1]);
}

mechanical_system! {
    /// A pendulum whose stop and stretch are declared in degrees, between others.
    pub system Tilted {
        constants { E: J = 1, I: kg*m^2 = 1, a: deg = 30, n: deg in -a..a = 5, l: deg in a..90 = 40, twice: deg in 0..3*a = 2*a }
        coordinates { q: rad }
        parameters { w = dot(q); }
        kinetic_energy = I/2*w^2;
        potential_energy = E*(n*q + l*q + twice*q);
    }
}

#[test]
fn limits_in_degrees_are_compared_in_degrees() {
    let tilted = Tilted::default().prepare().unwrap();
    // 5, 40 and 60 degrees.
    near(-tilted.rhs(0.0, &tilted::State::default()).w, 105.0_f64.to_radians());
    let refused = |tilted: Tilted, bound: &str| {
        let error = tilted.prepare().unwrap_err();
        assert!(error.to_string().contains(bound), "{error}");
    };
    for n in [-29.9, 0.53, 29.9] {
        Tilted { n, ..Tilted::default() }.prepare().unwrap();
    }
    refused(Tilted { n: 30.1, ..Tilted::default() }, "`n in -a..a`");
    refused(Tilted { n: -30.1, ..Tilted::default() }, "`n in -a..a`");
    refused(Tilted { l: 1.0, ..Tilted::default() }, "`l in a..90`");
    refused(Tilted { a: 50.0, ..Tilted::default() }, "`l in a..90`");
    refused(Tilted { twice: 91.0.into(), ..Tilted::default() }, "`twice in 0..3*a`");
}
