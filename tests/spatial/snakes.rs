//! What moves by bending: a snakeboard with a rotor, and a snake of six links on wheels.

use guen::Real;

use crate::by_hand::{Body, ByHand, Numbers, Vector, check, minus, moving, plus, rate, rot_z};
use crate::vehicles::{ahead, flat, sideways, values};

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
