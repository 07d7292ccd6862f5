//! Vehicles whose contacts are found with a square root: a bicycle of four bodies, a skew ellipsoid, a motor disc.

use guen::{Real, System};

use crate::by_hand::{
    Body, ByHand, Numbers, Vector, check, column, cross, diagonal, inner, minus, moving, plus, product, real,
    rot_x, rot_y, rot_z, times, velocity_at,
};

guen::mechanical_system! {
    /// Rear wheel, frame, fork and front wheel; the fork turns about an axis that is tilted in the frame by a constant
    /// angle. The first two coordinates are the rear contact.
    pub system Bicycle {
        constants {
            rr > 0, rf > 0, base > 0, trail, rake, mr > 0, mb > 0, mh > 0, mf > 0, I > 0, J > 0, K > 0, L > 0, g = 9.81
        }
        inputs { pedal, handle }
        coordinates { x, y, yaw, lean, pitch, steer, rear, front }
        let up = vec(0, 0, 1);
        let F = rot_z(yaw)*rot_x(lean);
        let B = F*rot_y(pitch);
        let H = B*rot_y(rake)*rot_z(steer);
        let W = H*rot_y(front);
        let hub = vec(x, y, 0) + rr*F.z;
        let nose = hub + base*B.x;
        let tip = nose + trail*H.x - base/2*H.z;
        let contact = tip - rf*unit(up - inner(up, H.y)*H.y);
        bodies {
            back { mass: mr, inertia: diag(I, 2*I, I), center: hub, orientation: F*rot_y(rear) }
            frame { mass: mb, inertia: sym(J, K, L, 0, 0, -J/4), center: hub + base/2*B.x + base/3*B.z, orientation: B }
            fork { mass: mh, inertia: diag(I, I, I/3), center: nose + trail/2*H.x, orientation: H }
            wheel { mass: mf, inertia: diag(I, 2*I, I), center: tip, orientation: W }
        }
        gravity = -g*up;
        parameters { fall = dot(lean); turn = dot(steer); drive = dot(rear); }
        constraints {
            behind: back.velocity_at(vec(x, y, 0)) = 0;
            ahead: wheel.velocity_at(contact) = 0;
        }
        forces {
            pedal*F.y along back.angular_velocity - frame.angular_velocity;
            handle*H.z along fork.angular_velocity - frame.angular_velocity;
        }
        outputs { height = contact.z; }
    }
}

guen::mechanical_system! {
    /// A bicycle as above in redundant coordinates: its rear hub has three coordinates, and holonomic equations keep both wheels on the ground.
    pub system FreeBicycle {
        constants {
            rr > 0, rf > 0, base > 0, trail, rake, mr > 0, mb > 0, mh > 0, mf > 0, I > 0, J > 0, K > 0, L > 0, g = 9.81
        }
        inputs { pedal, handle }
        coordinates { x, y, z, yaw, lean, pitch, steer, rear, front }
        let up = vec(0, 0, 1);
        let F = rot_z(yaw)*rot_x(lean);
        let B = F*rot_y(pitch);
        let H = B*rot_y(rake)*rot_z(steer);
        let W = H*rot_y(front);
        let hub = vec(x, y, z);
        let under = hub - rr*F.z;
        let nose = hub + base*B.x;
        let tip = nose + trail*H.x - base/2*H.z;
        let contact = tip - rf*unit(up - inner(up, H.y)*H.y);
        bodies {
            back { mass: mr, inertia: diag(I, 2*I, I), center: hub, orientation: F*rot_y(rear) }
            frame { mass: mb, inertia: sym(J, K, L, 0, 0, -J/4), center: hub + base/2*B.x + base/3*B.z, orientation: B }
            fork { mass: mh, inertia: diag(I, I, I/3), center: nose + trail/2*H.x, orientation: H }
            wheel { mass: mf, inertia: diag(I, 2*I, I), center: tip, orientation: W }
        }
        gravity = -g*up;
        parameters { fall = dot(lean); turn = dot(steer); drive = dot(rear); }
        holonomic { standing: under.z = 0; touching: contact.z = 0; }
        constraints {
            behind_x: back.velocity_at(under).x = 0;
            behind_y: back.velocity_at(under).y = 0;
            ahead_x: wheel.velocity_at(contact).x = 0;
            ahead_y: wheel.velocity_at(contact).y = 0;
        }
        forces {
            pedal*F.y along back.angular_velocity - frame.angular_velocity;
            handle*H.z along fork.angular_velocity - frame.angular_velocity;
        }
    }
}

rattleback!(guen::mechanical_system);

const RR: f64 = 0.35;
const RF: f64 = 0.3;
const BASE: f64 = 1.0;
const TRAIL: f64 = 0.05;
const RAKE: f64 = -0.3;

struct BicycleByHand {
    inputs: [f64; 2],
}

impl ByHand for BicycleByHand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let leaning = product(&rot_z(x[2]), &rot_x(x[3]));
        let frame = product(&leaning, &rot_y(x[4]));
        let fork = product(&product(&frame, &rot_y(real(RAKE))), &rot_z(x[5]));
        let ray = |matrix, k, length: f64| times(real(length), &column(matrix, k));
        let hub = plus(&[x[0], x[1], R::zero()], &ray(&leaning, 2, RR));
        let nose = plus(&hub, &ray(&frame, 0, BASE));
        let tip = minus(&plus(&nose, &ray(&fork, 0, TRAIL)), &ray(&fork, 2, BASE / 2.0));
        let middle = plus(&plus(&hub, &ray(&frame, 0, BASE / 2.0)), &ray(&frame, 2, BASE / 3.0));
        let wheel = diagonal([0.1, 0.2, 0.1]);
        let mut heavy = diagonal([4.0, 5.0, 2.0]);
        heavy[0][2] = -1.0;
        heavy[2][0] = -1.0;
        vec![
            Body { mass: 2.0, inertia: wheel, center: hub, rotation: product(&leaning, &rot_y(x[6])) },
            Body { mass: 60.0, inertia: heavy, center: middle, rotation: frame },
            Body {
                mass: 4.0,
                inertia: diagonal([0.1, 0.1, 0.1 / 3.0]),
                center: plus(&nose, &ray(&fork, 0, TRAIL / 2.0)),
                rotation: fork,
            },
            Body { mass: 1.5, inertia: wheel, center: tip, rotation: product(&fork, &rot_y(x[7])) },
        ]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let bodies = self.bodies(time, &path);
        let axle = column(&bodies[3].rotation, 1).map(|e| e.value);
        // The steepest direction in the plane of the wheel is square to its axle and to the level direction in it.
        let level = [axle[1], -axle[0], R::zero()];
        let steep = cross(&level, &axle);
        let down = if steep[2].to_f64() > 0.0 { -R::one() } else { R::one() };
        let arm = times(down * real::<R>(RF) / inner(&steep, &steep).sqrt(), &steep);
        let touch = plus(&bodies[3].center.map(|e| e.value), &arm);
        let mut forms = vec![v[3], v[5], v[6]];
        forms.extend(&velocity_at(&bodies[0], &[x[0], x[1], R::zero()])[..2]);
        forms.extend(velocity_at(&bodies[3], &touch));
        forms
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -9.81]
    }

    fn forces(&self, _t: f64, _x: &[f64], _v: &[f64]) -> Vec<f64> {
        let [pedal, handle] = self.inputs;
        vec![0.0, 0.0, 0.0, 0.0, -pedal, handle, pedal, 0.0]
    }
}

#[test]
fn bicycle() {
    let system = Bicycle {
        rr: RR,
        rf: RF,
        base: BASE,
        trail: TRAIL,
        rake: RAKE,
        mr: 2.0,
        mb: 60.0,
        mh: 4.0,
        mf: 1.5,
        I: 0.1,
        J: 4.0,
        K: 5.0,
        L: 2.0,
        g: 9.81,
    };
    let system = system.prepare().unwrap();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let mut state = numbers.state::<11>().map(|e| 0.4 * e);
        state[10] *= 20.0;
        match round {
            // Upright and straight, at rest and in motion.
            0 => state = [0.0; 11],
            1 => state[2..10].fill(0.0),
            _ => {}
        }
        let inputs = numbers.state::<2>();
        let hand = BicycleByHand { inputs };
        let inputs = bicycle::Inputs { pedal: inputs[0], handle: inputs[1] };
        let driven = system.driven(inputs);
        assert!(driven.rhs(0.0, &state).iter().all(|e| e.is_finite()), "{state:?}");
        let reactions: [f64; 5] = system.reactions(0.0, &state.into(), &inputs).into();
        check(&driven, &hand, 0.0, &state, &reactions, 8);
    }
}

#[test]
fn bicycle_on_holonomic_equations_moves_as_the_other() {
    macro_rules! system {
        ($system:ident) => {
            $system {
                rr: RR,
                rf: RF,
                base: BASE,
                trail: TRAIL,
                rake: RAKE,
                mr: 2.0,
                mb: 60.0,
                mh: 4.0,
                mf: 1.5,
                I: 0.1,
                J: 4.0,
                K: 5.0,
                L: 2.0,
                g: 9.81,
            }
        };
    }
    let other = system!(Bicycle).prepare().unwrap();
    let free = system!(FreeBicycle).prepare().unwrap();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let mut state = numbers.state::<11>().map(|e| 0.4 * e);
        state[10] *= 20.0;
        if round == 0 {
            state = [0.0; 11];
        }
        let [pedal, handle] = numbers.state::<2>();
        let expected = other.driven(bicycle::Inputs { pedal, handle }).rhs(0.0, &state);
        let [x, y, yaw, lean, ..] = state;
        // The hub stands over the contact.
        let [(sin_yaw, cos_yaw), (sin_lean, cos_lean)] = [yaw.sin_cos(), lean.sin_cos()];
        let (ahead, aside) = (sin_yaw * sin_lean, -cos_yaw * sin_lean);
        let mut placed = [0.0; 12];
        placed[..3].copy_from_slice(&[x + RR * ahead, y + RR * aside, RR * cos_lean]);
        placed[3..].copy_from_slice(&state[2..]);
        let found = free.driven(free_bicycle::Inputs { pedal, handle }).rhs(0.0, &placed);
        let [x_rate, y_rate, yaw_rate, lean_rate, ..] = expected;
        let hub = [
            x_rate + RR * (cos_yaw * sin_lean * yaw_rate + sin_yaw * cos_lean * lean_rate),
            y_rate + RR * (sin_yaw * sin_lean * yaw_rate - cos_yaw * cos_lean * lean_rate),
            -RR * sin_lean * lean_rate,
        ];
        for (k, (found, expected)) in found.iter().zip(hub.iter().chain(&expected[2..])).enumerate() {
            let size = expected.abs().max(1.0);
            assert!((found - expected).abs() < 1e-12 * size, "{k}: {found} instead of {expected}");
        }
    }
}

struct Stone;

const AXES: [f64; 3] = [1.3, 0.6, 0.4];

impl ByHand for Stone {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let mut inertia = diagonal([0.3, 0.8, 0.9]);
        inertia[0][1] = 0.1;
        inertia[1][0] = 0.1;
        let rotation = product(&product(&rot_z(x[0]), &rot_x(x[1])), &rot_y(x[2]));
        vec![Body { mass: 1.1, inertia, center: [x[3], x[4], x[5]], rotation }]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let body = self.bodies(time, &path).remove(0);
        let axes = [0, 1, 2].map(|k| column(&body.rotation, k).map(|e| e.value));
        let omega = crate::by_hand::spin(&body.rotation);
        // The support function of the ellipsoid, downwards: its gradient is the lowest point.
        let weighted = |k: usize| real::<R>(AXES[k] * AXES[k]) * axes[k][2];
        let size = (0..3).fold(R::zero(), |sum, k| sum + weighted(k) * axes[k][2]).sqrt();
        let mut touch = plus(&body.center.map(|e| e.value), &times(real(0.1), &axes[2]));
        for (k, axis) in axes.iter().enumerate() {
            touch = minus(&touch, &times(weighted(k) / size, axis));
        }
        let mut forms: Vec<R> = axes.iter().map(|axis| inner(axis, &omega)).collect();
        forms.extend(velocity_at(&body, &touch));
        forms
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -9.81]
    }
}

#[test]
fn rattleback() {
    let [a, b, c] = AXES;
    let stone =
        Rattleback { m: 1.1, a, b, c, h: 0.1, A: 0.3, B: 0.8, C: 0.9, D: 0.1, g: 9.81 }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let mut state = numbers.state::<9>();
        if round == 0 {
            state[..6].fill(0.0);
        }
        let reactions: [f64; 3] = stone.reactions(0.0, &state.into()).into();
        check(&stone, &Stone, 0.0, &state, &reactions, 6);
    }
}
