//! Functions that the program supplies to components: against the same system with the functions in its own braces.

use guen::lanes::{LaneTask, Lanes, Width, dispatch};
use guen::prelude::*;
use guen::{Laned, Smooth, Table, WithScalar};

guen::mechanical_component! {
    /// A motor whose torque depends on its speed.
    pub component Motor(speed: scalar) {
        constants { gear > 0 = 3, loss >= 0 }
        functions {
            /// The torque at a speed of the rotor.
            torque(speed);
        }
        let power = gear*torque(gear*speed) - loss*speed;
        forces  { power along speed; }
        outputs { rotor = torque(gear*speed); }
    }
}

guen::mechanical_component! {
    /// A road, which has no constants.
    pub component Road(x: scalar) {
        functions { height(x); }
        let z = height(x);
    }
}

guen::mechanical_component! {
    /// Two wheels with a motor each, on roads of their own.
    pub component Axle(left: scalar, right: scalar, speed: scalar) {
        constants { m > 0 }
        functions { rest(a, b); }
        use Motor as motor { speed }
        for i in 0..2 { use Road as road[i] { x: left + i*(right - left) } }
        potential_energy = m*(road[0].z + road[1].z) + rest(left, right);
    }
}

guen::mechanical_system! {
    /// A cart with axles from a component, and a motor of a component in its braces.
    pub system Cart {
        component Brake(speed: scalar) { functions { drag(v); } forces { -drag(speed) along speed; } }
        constants   { M > 0 }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        use Axle as front { left: x, right: 2*x, speed: u }
        for i in 0..2 { use Axle as back[i] { left: y, right: x + i, speed: v } }
        use Brake as brake { speed: u }
        functions { wind(u, v); }
        kinetic_energy = M/2*(u^2 + v^2);
        forces { wind(u, v) along v; }
        outputs { near = front.road[1].z; }
        scene Still { track x; fix M = 2, back[1].motor.loss = 0; provide front.motor.rotor; }
        scene Bare { fix front.motor.gear = 3, front.motor.loss = 1/2, front.m = 1; }
    }
}

guen::mechanical_system! {
    /// The same with all functions in its own braces.
    pub system Written {
        constants   { M > 0, m[3] > 0, gear[3] > 0 = 3, loss[3] >= 0 }
        functions   {
            front_torque(w); back_torque(w); front_height(x); back_height(x); front_rest(a, b); back_rest(a, b); drag(v);
            wind(u, v);
        }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy = M/2*(u^2 + v^2);
        for i in 0..3 { let right[i] = x + i - 1; }
        potential_energy = m[0]*(front_height(x) + front_height(2*x)) + front_rest(x, 2*x)
            + sum(i in 1..3: m[i]*(back_height(y) + back_height(right[i])) + back_rest(y, right[i]));
        forces {
            gear[0]*front_torque(gear[0]*u) - loss[0]*u along u;
            for i in 1..3 { gear[i]*back_torque(gear[i]*v) - loss[i]*v along v; }
            -drag(u) along u;
            wind(u, v) along v;
        }
    }
}

/// `a x^2 + b sin(y)`, or of one argument its first part.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Law {
    a: f64,
    b: f64,
}

impl Smooth<1> for Law {
    fn value<R: Real>(&self, [x]: [R; 1]) -> R {
        R::from_f64(self.a) * x * x + R::from_f64(self.b)
    }

    fn is_same(&self, other: &Self) -> bool {
        self == other
    }
}

impl Smooth<2> for Law {
    fn value<R: Real>(&self, [x, y]: [R; 2]) -> R {
        R::from_f64(self.a) * x * x + R::from_f64(self.b) * y.sin()
    }

    fn is_same(&self, other: &Self) -> bool {
        self == other
    }
}

const LAW: Law = Law { a: 0.3, b: 0.7 };

fn torque() -> Table<3> {
    Table::monotone([(-10.0, 3.0), (0.0, 2.0), (10.0, -1.0)]).unwrap()
}

type Front = Axle<f64, Table<3>, Law, Law>;

fn front() -> Front {
    Axle {
        m: 1.0,
        rest: LAW,
        motor: Motor { gear: 3.0, loss: 0.5, torque: torque() },
        road: [Road::new(LAW); 2],
    }
}

fn back(loss: f64) -> Axle<f64, f64, f64, Table<2>> {
    let line = Table::new([(0.0, 1.0), (1.0, 3.0)]).unwrap();
    Axle { m: 2.0, rest: 0.0, motor: Motor { gear: 2.0, loss, torque: 0.25 }, road: [Road::new(line); 2] }
}

#[test]
fn rates_are_those_of_functions_in_the_system() {
    let cart = Cart {
        M: 2.0,
        front: front(),
        back: [back(0.1), back(0.0)],
        brake: cart::Brake::new(LAW),
        wind: LAW,
    };
    let cart = cart.prepare().unwrap();
    let line = Table::new([(0.0, 1.0), (1.0, 3.0)]).unwrap();
    let written = Written {
        M: 2.0,
        m: [1.0, 2.0, 2.0],
        gear: [3.0, 2.0, 2.0],
        loss: [0.5, 0.1, 0.0],
        front_torque: torque(),
        back_torque: 0.25,
        front_height: LAW,
        back_height: line,
        front_rest: LAW,
        back_rest: 0.0,
        drag: LAW,
        wind: LAW,
    };
    let written = written.prepare().unwrap();
    let state = cart::State { x: 0.4, y: -0.3, u: 1.2, v: 0.8 };
    let other = written::State { x: 0.4, y: -0.3, u: 1.2, v: 0.8 };
    let (rate, expected) = (cart.rhs(0.0, &state), written.rhs(0.0, &other));
    for (found, expected) in
        [(rate.x, expected.x), (rate.y, expected.y), (rate.u, expected.u), (rate.v, expected.v)]
    {
        assert!((found - expected).abs() < 1e-14, "{rate:?} {expected}");
    }
    assert!(rate.u != 0.0 && rate.v != 0.0);
    assert!((cart.energy(0.0, &state) - written.energy(0.0, &other)).abs() < 1e-14);
}

type Back = Axle<f64, f64, f64, Table<2>>;

fn cart() -> Cart<f64, Table<3>, Law, Law, f64, f64, Table<2>, Law, Law> {
    let back: [Back; 2] = [back(0.1), back(0.0)];
    Cart::new(2.0, front(), back, cart::Brake::new(LAW), LAW)
}

#[test]
fn scenes_have_the_functions_of_instances() {
    let state = cart::State { x: 0.4, y: -0.3, u: 1.2, v: 0.8 };
    let whole = cart();
    let still = cart::Still::of(&whole, &state).unwrap();
    assert_eq!((still.front, still.system()), (whole.front, whole));
    assert_eq!(still.back_0_motor_loss, 0.1);
    let rate = still.prepare().unwrap().rhs(0.0, &cart::still::State::from(&state));
    assert_eq!(rate.u, whole.prepare().unwrap().rhs(0.0, &state).u);
    // Nothing is left of `front.motor` but its function.
    let bare = cart::Bare::of(&whole, &state).unwrap();
    assert_eq!(bare.front.motor.torque, torque());
    assert_eq!(bare.system(), whole);
    let rate = bare.prepare().unwrap().rhs(0.0, &cart::bare::State::from(&state));
    assert!((rate.u - whole.prepare().unwrap().rhs(0.0, &state).u).abs() < 1e-14);
}

#[test]
fn constants_come_back_and_go_to_other_reals() {
    let whole = cart();
    let prepared = whole.prepare().unwrap();
    assert_eq!(prepared.constants(), whole);
    assert!(format!("{whole:?}").contains("torque: Table"), "{whole:?}");
    let longer = whole.with_scalar::<guen::Approx13>().unwrap();
    let state = cart::State { x: 0.4, y: -0.3, u: 1.2, v: 0.8 };
    let at = <[f64; 4]>::from(state).map(guen::Approx13::from_f64);
    let (rate, expected) = (longer.rhs(guen::Approx13::zero(), &at.into()), prepared.rhs(0.0, &state));
    assert!((rate.u.to_f64() - expected.u).abs() < 1e-11 * expected.u.abs());
    // The rate of an output and its parts.
    let outputs = prepared.outputs(0.0, &state);
    assert_eq!(outputs.near, LAW.value([0.8]));
    assert_eq!(outputs.back[1].motor.rotor, 0.25);
}

#[test]
fn types_have_the_functions_of_their_constants() {
    let front: cart::front::Constants<f64, Table<3>, Law, Law> = front();
    let motor: motor::Constants<f64, Table<3>> = front.motor;
    let _: cart::back::road::Constants<f64, Law> = Road::new(LAW);
    assert_eq!(Motor::new(0.5, torque()), motor);
    let literal = cart::front::Constants { m: 1.0, ..front };
    assert_eq!(literal, front);
}

guen::mechanical_system! {
    /// A system whose constants all have defaults, with functions of instances.
    system Ready {
        component Push(v: scalar) { constants { k = 1/3, twice = 2*k } functions { push(v); } forces { twice*push(v) along v; } }
        constants   { m > 0 = 3/2 }
        coordinates { x }
        parameters  { v = dot(x); }
        kinetic_energy = m/2*v^2;
        for i in 0..2 { use Push as push[i] { v } }
    }
}

#[test]
fn a_default_has_those_of_the_functions() {
    let ready: Ready<f64, f64> = Ready::default();
    assert_eq!((ready.push[1].k, ready.push[1].push, ready.m), (1.0 / 3.0, 0.0, 1.5));
    assert_eq!(ready.resolved().push[0].twice.value(), Some(2.0 / 3.0));
    let push = ready::Push { push: 3.0, ..ready.push[0] };
    let ready = Ready::new([push, ready.push[0]]).prepare().unwrap();
    assert!((ready.rhs(0.0, &ready::State::default()).v - 2.0 / 1.5).abs() < 1e-15);
}

struct InLanes;

impl LaneTask for InLanes {
    type Output = ();

    fn run<L: Lanes>(self) {
        let members: Vec<_> = (0..L::COUNT)
            .map(|i| {
                let other = Law { a: 0.1 * i as f64, b: 0.2 };
                let mut cart = cart();
                cart.brake.drag = other;
                cart.front.road[1] = Road::new(other);
                cart.prepare().unwrap()
            })
            .collect();
        let all = Laned::gather::<L>(|lane| &members[lane]);
        let state = [0.4, -0.3, 1.2, 0.8];
        let rates = System::rhs(&all, L::from_f64(0.0), &state.map(L::from_f64));
        for (lane, member) in members.iter().enumerate() {
            assert_eq!(rates.map(|rate| rate.lane(lane)), System::rhs(member, 0.0, &state));
        }
    }
}

#[test]
fn every_lane_has_its_own_functions() {
    for width in [Width::One, Width::Four, Width::Eight] {
        dispatch(width, InLanes);
    }
}
