//! Vehicles in the plane and upright: a two-wheeled robot, a car with trailers, a snakeboard, a snake on wheels.

use guen::Real;

use crate::by_hand::{
    Body, ByHand, Matrix, Numbers, POINT, Vector, check, column, inner, minus, moving, plus, product, rate,
    real, rot_y, rot_z, times, velocity_at,
};

guen::mechanical_system! {
    /// A robot on two wheels, driven by motors between its chassis and the wheels.
    pub system Robot {
        constants { m > 0, mw > 0, h > 0, b > 0, r > 0, A > 0, B > 0, C > 0, I > 0, J > 0, g = 9.81 }
        inputs { left_torque, right_torque }
        coordinates { x, y, heading, tilt, left, right }
        let H = rot_z(heading);
        let axle = vec(x, y, r);
        let R = H*rot_y(tilt);
        bodies {
            chassis { mass: m, inertia: diag(A, B, C), center: axle + h*R.z, orientation: R }
            one { mass: mw, inertia: diag(I, J, I), center: axle + b*H.y, orientation: H*rot_y(left) }
            other { mass: mw, inertia: diag(I, J, I), center: axle - b*H.y, orientation: H*rot_y(right) }
        }
        gravity = vec(0, 0, -g);
        parameters { speed = inner(H.x, dot(axle)); turn = dot(heading); fall = dot(tilt); }
        constraints {
            rolling: one.velocity_at(one.center - vec(0, 0, r)) = 0;
            other_rolling: inner(H.x, other.velocity_at(other.center - vec(0, 0, r))) = 0;
        }
        forces {
            left_torque*H.y along one.angular_velocity - chassis.angular_velocity;
            right_torque*H.y along other.angular_velocity - chassis.angular_velocity;
        }
    }
}

guen::mechanical_system! {
    /// A car with two trailers, each hitched behind the axle of the one before it.
    pub system Train {
        constants { m > 0, I > 0, l > 0, d > 0, k > 0 }
        inputs { push, steering }
        coordinates { x, y, theta0, theta1, theta2, phi }
        let R0 = rot_z(theta0); let R1 = rot_z(theta1); let R2 = rot_z(theta2);
        let F = R0*rot_z(phi);
        let rear = vec(x, y);
        let front = rear + l*R0.x;
        let axle1 = rear - k*R0.x - d*R1.x;
        let axle2 = axle1 - k*R1.x - d*R2.x;
        bodies {
            car { mass: m, inertia: diag(0, 0, I), center: rear + l/3*R0.x, orientation: R0 }
            wheel { mass: m/10, inertia: diag(0, 0, I/10), center: front, orientation: F }
            trailer1 { mass: m/2, inertia: diag(0, 0, I/2), center: axle1 + d/4*R1.x, orientation: R1 }
            trailer2 { mass: m/2, inertia: diag(0, 0, I/2), center: axle2 + d/4*R2.x, orientation: R2 }
        }
        parameters { speed = inner(R0.x, dot(rear)); steer = dot(phi); }
        constraints {
            rear_axle: inner(R0.y, car.velocity_at(rear)) = 0;
            front_axle: inner(F.y, wheel.velocity_at(front)) = 0;
            first: inner(R1.y, trailer1.velocity_at(axle1)) = 0;
            second: inner(R2.y, trailer2.velocity_at(axle2)) = 0;
        }
        forces { push along speed; steering along dot(phi); }
    }
}

guen::mechanical_system! {
    /// A board on two steered axles with a rotor.
    pub system Snakeboard {
        constants { m > 0, I > 0, J > 0, K > 0, l > 0 }
        inputs { swing, steer_front, steer_back }
        coordinates { x, y, theta, psi, front, back }
        let R = rot_z(theta);
        let p = vec(x, y);
        let E = rot_z(theta + front); let D = rot_z(theta + back);
        bodies {
            board { mass: m, inertia: diag(0, 0, I), center: p, orientation: R }
            rotor { inertia: diag(0, 0, J), orientation: rot_z(theta + psi) }
            front_axle { inertia: diag(0, 0, K), orientation: E }
            back_axle { inertia: diag(0, 0, K), orientation: D }
        }
        parameters { speed = inner(R.x, dot(p)); spin = dot(psi); bend = dot(front); turn = dot(back); }
        constraints {
            no_slip_front: inner(E.y, board.velocity_at(p + l*R.x)) = 0;
            no_slip_back: inner(D.y, board.velocity_at(p - l*R.x)) = 0;
        }
        forces { swing along spin; steer_front along bend; steer_back along turn; }
    }
}

guen::mechanical_system! {
    /// Six links, each with a pair of wheels under its middle, and motors in the joints.
    pub system Snake {
        constants { m > 0, I > 0, l > 0, c >= 0 }
        inputs { u1, u2, u3, u4, u5 }
        coordinates { x, y, q1, q2, q3, q4, q5, q6 }
        let A1 = rot_z(q1); let A2 = rot_z(q2); let A3 = rot_z(q3);
        let A4 = rot_z(q4); let A5 = rot_z(q5); let A6 = rot_z(q6);
        let p1 = vec(x, y);
        let p2 = p1 - l*A1.x - l*A2.x;
        let p3 = p2 - l*A2.x - l*A3.x;
        let p4 = p3 - l*A3.x - l*A4.x;
        let p5 = p4 - l*A4.x - l*A5.x;
        let p6 = p5 - l*A5.x - l*A6.x;
        bodies {
            b1 { mass: m, inertia: diag(0, 0, I), center: p1, orientation: A1 }
            b2 { mass: m, inertia: diag(0, 0, I), center: p2, orientation: A2 }
            b3 { mass: m, inertia: diag(0, 0, I), center: p3, orientation: A3 }
            b4 { mass: m, inertia: diag(0, 0, I), center: p4, orientation: A4 }
            b5 { mass: m, inertia: diag(0, 0, I), center: p5, orientation: A5 }
            b6 { mass: m, inertia: diag(0, 0, I), center: p6, orientation: A6 }
        }
        parameters { speed = inner(A1.x, dot(p1)); turn = dot(q1); }
        constraints {
            w1: inner(A1.y, dot(p1)) = 0; w2: inner(A2.y, dot(p2)) = 0; w3: inner(A3.y, dot(p3)) = 0;
            w4: inner(A4.y, dot(p4)) = 0; w5: inner(A5.y, dot(p5)) = 0; w6: inner(A6.y, dot(p6)) = 0;
        }
        forces {
            u1 along dot(q1) - dot(q2); u2 along dot(q2) - dot(q3); u3 along dot(q3) - dot(q4);
            u4 along dot(q4) - dot(q5); u5 along dot(q5) - dot(q6);
            -c*dot(p1) along dot(p1);
        }
    }
}

/// The rates of a point given as a function, without the point itself.
fn ahead<R: Real>(angle: R, length: f64) -> Vector<R> {
    let (s, c) = angle.sin_cos();
    [real::<R>(length) * c, real::<R>(length) * s, R::zero()]
}

/// The sideways velocity of a point of a body.
fn sideways<R: Real>(body: &Body<guen::Dual<R, 1>>, direction: R, point: &Vector<R>) -> R {
    let (s, c) = direction.sin_cos();
    let v = velocity_at(body, point);
    c * v[1] - s * v[0]
}

fn flat(moment: f64) -> Matrix<f64> {
    let mut inertia = POINT;
    inertia[2][2] = moment;
    inertia
}

fn values<R: Real>(v: &Vector<guen::Dual<R, 1>>) -> Vector<R> {
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

struct BoardByHand {
    inputs: [f64; 3],
}

impl ByHand for BoardByHand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let center = [x[0], x[1], R::zero()];
        let body = |mass: f64, moment: f64, angle: R| Body {
            mass,
            inertia: flat(moment),
            center,
            rotation: rot_z(angle),
        };
        vec![
            body(1.8, 0.5, x[2]),
            body(0.0, 0.2, x[2] + x[3]),
            body(0.0, 0.1, x[2] + x[4]),
            body(0.0, 0.1, x[2] + x[5]),
        ]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let board = self.bodies(time, &path).remove(0);
        let (s, c) = x[2].sin_cos();
        let center = values(&board.center);
        vec![
            c * v[0] + s * v[1],
            v[3],
            v[4],
            v[5],
            sideways(&board, x[2] + x[4], &plus(&center, &ahead(x[2], 0.6))),
            sideways(&board, x[2] + x[5], &minus(&center, &ahead(x[2], 0.6))),
        ]
    }

    fn forces(&self, _t: f64, _x: &[f64], _v: &[f64]) -> Vec<f64> {
        let [swing, front, back] = self.inputs;
        vec![0.0, 0.0, 0.0, swing, front, back]
    }
}

#[test]
fn snakeboard() {
    let board = Snakeboard { m: 1.8, I: 0.5, J: 0.2, K: 0.1, l: 0.6 }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let mut state = numbers.state::<10>();
        if round == 0 {
            state[2..6].fill(0.0);
        }
        let inputs = numbers.state::<3>();
        let hand = BoardByHand { inputs };
        let inputs = snakeboard::Inputs { swing: inputs[0], steer_front: inputs[1], steer_back: inputs[2] };
        let reactions: [f64; 2] = board.reactions(0.0, &state.into(), &inputs).into();
        check(&board.driven(inputs), &hand, 0.0, &state, &reactions, 6);
    }
}

struct SnakeByHand {
    inputs: [f64; 5],
}

impl SnakeByHand {
    fn middles<R: Real>(x: &[R]) -> Vec<Vector<R>> {
        let mut middles = vec![[x[0], x[1], R::zero()]];
        for i in 1..6 {
            let joint = minus(&middles[i - 1], &ahead(x[1 + i], 0.4));
            middles.push(minus(&joint, &ahead(x[2 + i], 0.4)));
        }
        middles
    }
}

impl ByHand for SnakeByHand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let middles = Self::middles(x);
        (0..6)
            .map(|i| Body { mass: 0.9, inertia: flat(0.07), center: middles[i], rotation: rot_z(x[2 + i]) })
            .collect()
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (_, path) = moving(t, x, v);
        let (s, c) = x[2].sin_cos();
        let mut forms = vec![c * v[0] + s * v[1], v[2]];
        forms.extend(Self::middles(&path).iter().enumerate().map(|(i, middle)| {
            let [vx, vy, _] = rate(middle);
            let (s, c) = x[2 + i].sin_cos();
            c * vy - s * vx
        }));
        forms
    }

    fn forces(&self, _t: f64, _x: &[f64], v: &[f64]) -> Vec<f64> {
        let u = self.inputs;
        let mut forces = vec![-0.2 * v[0], -0.2 * v[1]];
        forces.extend((0..6).map(|i| u.get(i).unwrap_or(&0.0) - if i > 0 { u[i - 1] } else { 0.0 }));
        forces
    }
}

#[test]
fn snake_of_six_links() {
    let snake = Snake { m: 0.9, I: 0.07, l: 0.4, c: 0.2 }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let mut state = numbers.state::<10>();
        if round == 0 {
            state[2..8].fill(0.3);
        }
        let inputs = numbers.state::<5>();
        let hand = SnakeByHand { inputs };
        let [u1, u2, u3, u4, u5] = inputs;
        let inputs = snake::Inputs { u1, u2, u3, u4, u5 };
        let reactions: [f64; 6] = snake.reactions(0.0, &state.into(), &inputs).into();
        check(&snake.driven(inputs), &hand, 0.0, &state, &reactions, 8);
    }
}
