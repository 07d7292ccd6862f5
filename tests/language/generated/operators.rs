//! Operators and brackets: on coordinates, on functions, nested, with and without time.

use guen::Coefficient;
use guen::prelude::*;

hoop!(guen::mechanical_system);
sled!(guen::mechanical_system);
turntable!(guen::mechanical_system);

/// A function of everything, with no symmetry to hide behind.
struct Mixed;
impl<B, const N: usize> Function<N, B> for Mixed {
    fn at<R: Real>(&self, t: R, x: &[R; N]) -> R {
        let mut value = (t * x[0]).sin();
        for i in 0..N {
            let weight = R::from_ratio(2 * i as i64 + 1, 7);
            value += (weight * x[i] + x[(i + 1) % N]).sin() * x[(i + 2) % N] + t * t * weight * x[i];
        }
        value
    }
}

const PLACE: [f64; 6] = [1.1, 0.4, -0.3, 0.8, -0.6, 0.2];

fn hoop_of(a: f64) -> hoop::Prepared {
    Hoop::new(a, 0.5, 1.1).prepare().unwrap()
}

#[test]
fn an_operator_of_a_coordinate_is_its_coefficient() {
    let hoop = hoop_of(0.8);
    let (sin, cos) = PLACE[0].sin_cos();
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-15, "{found}, {expected}");
    near(hoop::X1.apply(&hoop, &Coordinate::<3>, 0.0, &PLACE), 0.8 * sin * PLACE[1].sin());
    near(hoop::X2.apply(&hoop, &Coordinate::<1>, 0.0, &PLACE), 1.0 / sin);
    near(hoop::X2.apply(&hoop, &Coordinate::<2>, 0.0, &PLACE), -cos / sin);
    near(hoop::X4.apply(&hoop, &Coordinate::<3>, 0.0, &PLACE), 1.0);
    let coefficients = <hoop::X3 as Operator<f64, 6>>::coefficients(&hoop, 0.0, &PLACE);
    assert_eq!(coefficients[..3], [0.0, 0.0, 1.0]);
    near(coefficients[4], -0.8 * PLACE[1].sin());
    assert_eq!(size_of::<hoop::X1>(), 0);
}

/// `X_2 X_1 theta`-like values by hand: `X_1 (X_2 psi) = d/dtheta (1/sin theta)`.
#[test]
fn nested_operators_are_exact() {
    let hoop = hoop_of(0.8);
    let (sin, cos) = PLACE[0].sin_cos();
    let inner = hoop::X2.of(&hoop, Coordinate::<1>);
    let found = hoop::X1.apply(&hoop, &inner, 0.0, &PLACE);
    assert!((found + cos / (sin * sin)).abs() < 1e-14);
    let twice = hoop::X1.apply(&hoop, &hoop::X1.of(&hoop, inner), 0.0, &PLACE);
    assert!((twice - (1.0 + cos * cos) / (sin * sin * sin)).abs() < 1e-13);
}

/// The values `X f` of all given operators.
macro_rules! values {
    ($module:ident, $system:expr, $t:expr, $place:expr, [$($X:ident),*]) => {
        [$($module::$X.apply($system, &Mixed, $t, $place)),*]
    };
}

/// `X_i (X_j f) - X_j (X_i f) = sum_t C_ijt X_t f`.
macro_rules! commutes {
    ($module:ident, $system:expr, $n:literal, $t:expr, $place:expr, $all:tt, $(($i:literal, $j:literal, $Xi:ident, $Xj:ident)),*) => {
        $({
            let (system, place) = (&$system, &$place);
            let left = $module::$Xi.apply(system, &$module::$Xj.of(system, Mixed), $t, place)
                - $module::$Xj.apply(system, &$module::$Xi.of(system, Mixed), $t, place);
            let all = values!($module, system, $t, place, $all);
            let c = $module::Bracket::<$i, $j>::coefficients(system, $t, place);
            let right: f64 = c.iter().zip(&all).map(|(c, x)| c * x).sum();
            assert!((left - right).abs() < 1e-12, "({}, {}): {left} and {right}", $i, $j);
            let turned =
                $module::Bracket::<$j, $i>::coefficients(system, $t, place);
            assert_eq!(turned, c.map(|c| -c));
        })*
    };
}

#[test]
fn commutators_are_brackets() {
    let hoop = hoop_of(0.8);
    commutes!(
        hoop,
        hoop,
        6,
        0.0,
        PLACE,
        [X1, X2, X3, X4, X5, X6],
        (1, 2, X1, X2),
        (1, 3, X1, X3),
        (2, 3, X2, X3)
    );
    let sled = Sled::new(1.0, 0.2, 0.1, 0.5, 0.3).prepare().unwrap();
    commutes!(sled, sled, 3, 0.0, [0.7, 0.2, -0.4], [X1, X2, X3], (1, 2, X1, X2), (0, 2, X0, X2));
}

/// With time: `X_0` holds `d/dt` and what the table does by itself.
#[test]
fn commutators_with_time() {
    let table = Turntable::new(0.7, 0.25, 1.5, 0.8, 1.3).prepare().unwrap();
    let place = [0.4, -0.2, 0.3, 1.2, -0.5];
    let t = 0.6;
    commutes!(
        turntable,
        table,
        5,
        t,
        place,
        [X1, X2, X3, X4, X5],
        (0, 1, X0, X1),
        (0, 2, X0, X2),
        (0, 3, X0, X3),
        (1, 2, X1, X2),
        (2, 3, X2, X3)
    );
    struct Time;
    impl<B, const N: usize> Function<N, B> for Time {
        fn at<R: Real>(&self, t: R, _x: &[R; N]) -> R {
            t * t
        }
    }
    assert_eq!(turntable::X0.apply(&table, &Time, t, &place), 2.0 * t);
    assert_eq!(turntable::X1.apply(&table, &Time, t, &place), 0.0);
    const { assert!(<turntable::X0 as Operator<f64, 5>>::TIME && !<turntable::X1 as Operator<f64, 5>>::TIME) };
    let drift = turntable::X0.apply(&table, &Coordinate::<0>, t, &place);
    assert!((drift - (1.5 + 0.8 * (1.3 * t).sin()) * 0.2).abs() < 1e-15, "{drift}");
}

#[test]
fn what_is_known_of_coefficients() {
    const ZERO: Coefficient = Coefficient::Zero;
    const ONE: Coefficient = Coefficient::Number { numerator: 1, denominator: 1 };
    const MINUS: Coefficient = Coefficient::Number { numerator: -1, denominator: 1 };
    assert_eq!(hoop::Bracket::<1, 2>::COEFFICIENTS, [ZERO, Coefficient::Variable, ONE, ZERO, ZERO, ZERO]);
    assert_eq!(hoop::Bracket::<1, 3>::COEFFICIENTS, [ZERO; 6]);
    assert_eq!(sled::Bracket::<1, 2>::COEFFICIENTS, [ZERO, ZERO, MINUS]);
    assert_eq!(sled::Bracket::<2, 1>::COEFFICIENTS, [ZERO, ZERO, ONE]);
    // Affine constraints: the speed of the table is a function of time.
    let known = turntable::Bracket::<0, 1>::COEFFICIENTS;
    assert!(known.contains(&Coefficient::Variable), "{known:?}");
    const { assert!(sled::Bracket::<1, 2>::COEFFICIENTS[2].is_constant()) };
}
