//! Vehicles: a robot that balances on two wheels, a car with two trailers.

use guen::Real;

use crate::by_hand::{
    Body, ByHand, Matrix, Numbers, POINT, Vector, check, column, inner, minus, moving, plus, product, real,
    rot_y, rot_z, times, velocity_at,
};

robot!(guen::mechanical_system);
train!(guen::mechanical_system);

/// A level vector of some length, its angle from the first axis.
pub fn ahead<R: Real>(angle: R, length: f64) -> Vector<R> {
    let (s, c) = angle.sin_cos();
    [real::<R>(length) * c, real::<R>(length) * s, R::zero()]
}

/// The sideways velocity of a point of a body.
pub fn sideways<R: Real>(body: &Body<guen::Dual<R, 1>>, direction: R, point: &Vector<R>) -> R {
    let (s, c) = direction.sin_cos();
    let v = velocity_at(body, point);
    c * v[1] - s * v[0]
}

/// The inertia of a body that moves in the plane.
pub fn flat(moment: f64) -> Matrix<f64> {
    let mut inertia = POINT;
    inertia[2][2] = moment;
    inertia
}

/// The vector itself, on a path.
pub fn values<R: Real>(v: &Vector<guen::Dual<R, 1>>) -> Vector<R> {
    v.map(|e| e.value)
}

struct RobotByHand {
    torques: [f64; 2],
}

impl ByHand for RobotByHand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let heading = rot_z(x[2]);
        let axle = [x[0], x[1], real(0.2)];
        let rotation = product(&heading, &rot_y(x[3]));
        let side = times(real(0.3), &column(&heading, 1));
        let wheel = |center, angle| Body {
            mass: 0.6,
            inertia: crate::by_hand::diagonal([0.05, 0.09, 0.05]),
            center,
            rotation: product(&heading, &rot_y(angle)),
        };
        vec![
            Body {
                mass: 3.0,
                inertia: crate::by_hand::diagonal([0.5, 0.6, 0.4]),
                center: plus(&axle, &times(real(0.7), &column(&rotation, 2))),
                rotation,
            },
            wheel(plus(&axle, &side), x[4]),
            wheel(minus(&axle, &side), x[5]),
        ]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let bodies = self.bodies(time, &path);
        let ahead = column(&rot_z(x[2]), 0);
        let below = [R::zero(), R::zero(), real(-0.2)];
        let touch = |b: usize| velocity_at(&bodies[b], &plus(&values(&bodies[b].center), &below));
        let mut forms = vec![inner(&ahead, &[v[0], v[1], R::zero()]), v[2], v[3]];
        forms.extend(&touch(1)[..2]);
        forms.push(inner(&ahead, &touch(2)));
        forms
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -9.81]
    }

    fn forces(&self, _t: f64, _x: &[f64], _v: &[f64]) -> Vec<f64> {
        let [left, right] = self.torques;
        vec![0.0, 0.0, 0.0, -left - right, left, right]
    }
}

#[test]
fn two_wheeled_robot() {
    let robot =
        Robot { m: 3.0, mw: 0.6, h: 0.7, b: 0.3, r: 0.2, A: 0.5, B: 0.6, C: 0.4, I: 0.05, J: 0.09, g: 9.81 };
    let robot = robot.prepare().unwrap();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let mut state = numbers.state::<9>();
        if round == 0 {
            state[2..].fill(0.0);
        }
        let torques = numbers.state::<2>();
        let inputs = robot::Inputs { left_torque: torques[0], right_torque: torques[1] };
        let reactions: [f64; 3] = robot.reactions(0.0, &state.into(), &inputs).into();
        check(&robot.driven(inputs), &RobotByHand { torques }, 0.0, &state, &reactions, 6);
    }
}

struct TrainByHand {
    inputs: [f64; 2],
}

const L: f64 = 1.5;
const D: f64 = 1.1;
const K: f64 = 0.3;

impl TrainByHand {
    fn axles<R: Real>(x: &[R]) -> [Vector<R>; 4] {
        let rear = [x[0], x[1], R::zero()];
        let first = minus(&minus(&rear, &ahead(x[2], K)), &ahead(x[3], D));
        let second = minus(&minus(&first, &ahead(x[3], K)), &ahead(x[4], D));
        [rear, plus(&rear, &ahead(x[2], L)), first, second]
    }
}

impl ByHand for TrainByHand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let [rear, front, first, second] = Self::axles(x);
        let body = |mass: f64, moment: f64, center, angle| Body {
            mass,
            inertia: flat(moment),
            center,
            rotation: rot_z(angle),
        };
        vec![
            body(2.0, 1.4, plus(&rear, &ahead(x[2], L / 3.0)), x[2]),
            body(0.2, 0.14, front, x[2] + x[5]),
            body(1.0, 0.7, plus(&first, &ahead(x[3], D / 4.0)), x[3]),
            body(1.0, 0.7, plus(&second, &ahead(x[4], D / 4.0)), x[4]),
        ]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let bodies = self.bodies(time, &path);
        let [rear, front, first, second] = Self::axles(x);
        let (s, c) = x[2].sin_cos();
        vec![
            c * v[0] + s * v[1],
            v[5],
            sideways(&bodies[0], x[2], &rear),
            sideways(&bodies[1], x[2] + x[5], &front),
            sideways(&bodies[2], x[3], &first),
            sideways(&bodies[3], x[4], &second),
        ]
    }

    fn forces(&self, _t: f64, x: &[f64], _v: &[f64]) -> Vec<f64> {
        let [push, steering] = self.inputs;
        vec![push * x[2].cos(), push * x[2].sin(), 0.0, 0.0, 0.0, steering]
    }
}

#[test]
fn car_with_two_trailers() {
    let train = Train { m: 2.0, I: 1.4, l: L, d: D, k: K }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let mut state = numbers.state::<8>();
        if round == 0 {
            state[2..6].fill(0.0);
        }
        let inputs = numbers.state::<2>();
        let hand = TrainByHand { inputs };
        let inputs = train::Inputs { push: inputs[0], steering: inputs[1] };
        let reactions: [f64; 4] = train.reactions(0.0, &state.into(), &inputs).into();
        check(&train.driven(inputs), &hand, 0.0, &state, &reactions, 6);
    }
    assert!(!train::CLASS.is_holonomic() && train::INTEGRABLE == 0);
}
