//! Functions of the program in everything that is generated: constructors, scenes, contacts, operators, other reals, names of all kinds.

use guen::prelude::*;
use guen::{Approx13, Smooth, Table, WithScalar};

/// `a + b sin x`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wave {
    a: f64,
    b: f64,
}

impl Smooth<1> for Wave {
    fn value<R: Real>(&self, [x]: [R; 1]) -> R {
        R::from_f64(self.a) + R::from_f64(self.b) * x.sin()
    }
}

guen::mechanical_system! {
    /// A cart on a hill, seen by scenes.
    pub system Cart {
        constants   { m > 0 = 2, g = 9.81, limit = 2*m }
        functions   {
            /// The height above sea level.
            r#type(x);
            drag(speed);
        }
        coordinates { x, free }
        parameters  { u = dot(x); v = dot(free); }
        kinetic_energy = m/2*(u^2 + v^2) + 0*limit;
        potential_energy = m*g*r#type(x);
        forces      { -drag(u) along u; }
        outputs     { height = r#type(x); }
        scene Along { track x; fix m = 2; provide energy, height, linearization; }
        scene Still { track free; }
    }
}

guen::mechanical_system! {
    /// A chart that ends, a stop and a function of the program at once.
    pub system Stopped {
        functions { law(a); }
        coordinates { f }
        parameters { p = f*dot(f); }
        kinetic_energy = p^2/2;
        forces { law(f) along p; }
        contacts { tip: gap = f - 1, restitution = 1; }
    }
}

#[test]
fn contacts_where_the_chart_ends_and_the_program_supplies_a_force() {
    let stopped = Stopped::new(Wave { a: -2.0, b: 0.0 }).prepare().unwrap();
    // With s = f^2/2 it is s'' = -2, from 2 to the stop at 1/2.
    let motion = stopped.simulate(&stopped::State { f: 2.0, p: 0.0 }, 0.0..1.3).unwrap();
    let [impact] = motion.transitions() else { panic!("{:?}", motion.transitions()) };
    assert!((impact.t - 1.5_f64.sqrt()).abs() < 1e-9);
}

#[test]
fn constructors_take_functions_behind_constants() {
    let wave = Wave { a: 1.0, b: 0.5 };
    let cart = Cart::new(wave, 0.0);
    assert_eq!((cart.m, cart.g, cart.r#type), (2.0, 9.81, wave));
    let default: Cart<f64, Wave, f64> = Cart::default();
    assert_eq!((default.r#type, default.drag), (Wave::default(), 0.0));
    assert_eq!(default.resolved().limit.value(), Some(4.0));
    let prepared = cart.prepare().unwrap();
    assert_eq!(prepared.constants().r#type, wave);
    assert_eq!(prepared, prepared.constants().prepare().unwrap());
}

#[test]
fn scenes_have_the_functions_of_the_system() {
    let wave = Wave { a: 1.0, b: 0.5 };
    let cart = Cart::new(wave, Wave { a: 0.0, b: 3.0 });
    let state = cart::State { x: 0.4, u: 0.7, ..Default::default() };
    let along = cart::Along::try_from(cart).unwrap().prepare().unwrap();
    let whole = cart.prepare().unwrap();
    let (own, all) = (along.rhs(0.0, &cart::along::State::from(&state)), whole.rhs(0.0, &state));
    assert_eq!((own.x, own.u), (all.x, all.u));
    assert!((all.u + 9.81 * 0.5 * 0.4_f64.cos() + 3.0 * 0.7_f64.sin() / 2.0).abs() < 1e-14);
    assert_eq!(along.outputs(0.0, &cart::along::State::from(&state)).height, wave.value([0.4]));
    assert_eq!(along.constants().system().r#type, wave);
    let still = cart::Still::of(&cart, &state).unwrap().prepare().unwrap();
    assert_eq!(still.rhs(0.0, &cart::still::State { free: 1.0, v: 2.0 }).v, 0.0);
}

#[test]
fn functions_go_over_to_other_reals() {
    let cart = Cart::new(Wave { a: 1.0, b: 0.5 }, 0.0);
    let (state, short) = (cart::State { x: 0.4, ..Default::default() }, cart.with_scalar::<f32>().unwrap());
    let rate = cart.prepare().unwrap().rhs(0.0, &state).u;
    let of_short = short.rhs(0.0_f32, &cart::State { x: 0.4, ..Default::default() }).u;
    assert!((f64::from(of_short) - rate).abs() < 1e-6);
    let approximate = cart.prepare().unwrap().with_scalar::<Approx13>().unwrap();
    let of_approximate =
        approximate.rhs(Approx13::zero(), &cart::State { x: Approx13::from_f64(0.4), ..Default::default() });
    assert!((of_approximate.u.to_f64() - rate).abs() < 1e-12);
}

guen::mechanical_system! {
    /// A wheel that is steered by a law of the program; its constraint has the function in it.
    pub system Steered {
        functions   { steering(s); }
        coordinates { x, y, s }
        parameters  { u = dot(x); w = dot(s); }
        constraints { steered: dot(y) = steering(s)*dot(x); }
        kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(s)^2)/2;
        provide operators;
    }
}

#[test]
fn operators_and_brackets_have_functions() {
    let wave = Wave { a: 0.0, b: 1.0 };
    let steered = Steered::new(wave).prepare();
    let steered = steered.unwrap();
    let x = [0.1, 0.2, 0.5];
    // X1 = d/dx + steering(s) d/dy, X2 = d/ds: (X1, X2) = -steering'(s) d/dy, or its negative.
    let along = steered::X1().apply(&steered, &Coordinate::<1>, 0.0, &x);
    assert_eq!(along, 0.5_f64.sin());
    assert!(!steered::CLASS.is_holonomic());
    let state = steered::State { x: 0.1, y: 0.2, s: 0.5, u: 2.0, w: 3.0 };
    // (1 + f^2) u' + f f' w u = 0
    let (f, slope) = (0.5_f64.sin(), 0.5_f64.cos());
    let expected = -f * slope * 3.0 * 2.0 / (1.0 + f * f);
    assert!((steered.rhs(0.0, &state).u - expected).abs() < 1e-14);
}

guen::mechanical_system! {
    /// A ball above a track that the program supplies.
    pub system Bouncer {
        constants   { m > 0, g = 9.81, e in 0..1 = 0.5 }
        functions   { track(x); }
        coordinates { x, z }
        parameters  { u = dot(x); w = dot(z); }
        particles   { m at vec(x, z); }
        gravity     = vec(0, -g);
        contacts    { floor: gap = z - track(x), restitution = e; }
    }
}

#[test]
fn a_contact_has_a_gap_above_a_function() {
    // A slope of one half: falling from 1, the ball arrives with speed sqrt(2 g h).
    let track = Table::new([(0.0, 0.0), (2.0, 1.0)]).unwrap();
    let bouncer = Bouncer::new(1.0, track).prepare().unwrap();
    let start = bouncer::State { x: 1.0, z: 1.5, u: 0.0, w: 0.0 };
    let arrival = (2.0_f64 / 9.81).sqrt();
    let motion = bouncer.simulate(&start, 0.0..1.05 * arrival).unwrap();
    // Along the normal (-1, 2)/sqrt 5 the speed is turned and halved.
    let speed = (2.0 * 9.81_f64).sqrt();
    let impulse = 1.5 * speed * 2.0 / 5.0_f64.sqrt();
    let u = -impulse / 5.0_f64.sqrt();
    assert!((motion.end().u - u).abs() < 1e-7, "{:?} {u}", motion.end());
}

/// A table of a program that lives as long as the program does.
static ROAD: std::sync::LazyLock<Table<100>> = std::sync::LazyLock::new(|| {
    let points: Vec<(f64, f64)> = (0..80).map(|i| (0.1 * f64::from(i), (0.1 * f64::from(i)).sin())).collect();
    Table::spline_through(&points).expect("the points are sorted")
});

#[test]
fn a_large_table_is_lent() {
    let cart = Cart::new(&*ROAD, 0.0).prepare().unwrap();
    let rate = cart.rhs(0.0, &cart::State { x: 3.0, ..Default::default() }).u;
    // A spline of spacing h has slopes within h^3/24 of its function, times the fourth derivative.
    assert!((rate + 9.81 * 3.0_f64.cos()).abs() < 9.81 * 1e-3 / 24.0);
    assert!(std::mem::size_of_val(&cart) < 200);
}

guen::mechanical_system! {
    /// The name of the system is the one that the parameter of its function would have.
    pub system GroundFunction {
        functions   { ground(x); Ground(x); state(x); }
        coordinates { x }
        parameters  { u = dot(x); }
        kinetic_energy = u^2/2 + 0*state(x);
        potential_energy = ground(x) + Ground(x);
    }
}

#[test]
fn parameters_of_types_have_names_of_their_own() {
    let system = GroundFunction::new(1.0, Wave { a: 0.0, b: 1.0 }, 2.0);
    let rate = system.prepare().unwrap().rhs(0.0, &ground_function::State { x: 0.3, u: 0.0 }).u;
    assert!((rate + 0.3_f64.cos()).abs() < 1e-15);
}
