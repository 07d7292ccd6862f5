//! Scenes in a single mode in which contacts slip: plain systems with friction, beside the same mode of the whole system, whose reactions
//! another solve finds.

use guen::steppers::Rk4;
use guen::{Level, Simulate, System, mechanical_system};

use crate::drawn::drawn;

mechanical_system! {
    /// A rod on the ground with its tip, as in Painlevé's paradox, whose friction falls with the speed and differs on ice.
    pub system Rod {
        constants { m = 2, J = 1/5, l = 0.7, g = 9.81, mu = 0.6, delta = 0.2 }
        inputs { push }
        coordinates { x, y, tilt }
        parameters { u = dot(x); w = dot(y); turn = dot(tilt); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*turn^2;
        potential_energy = m*g*y + m/3*tilt^2;
        forces { push along u; -turn/4 along turn; }
        let tip = vec(x + l*cos(tilt), y - l*sin(tilt));
        switches { ice: x - 1; }
        contacts { tip_on_ground: gap = tip.y, slip = dot(tip).x + t/3, friction = mu*(1 - ice/2)/(1 + delta*speed); }
        outputs { force = reaction(tip_on_ground); creep = slip(tip_on_ground); }
        scene Ahead { modes { tip_on_ground: slip+; } track x, tilt, u, turn; provide force, creep, reactions(tip_on_ground); }
        scene Back { modes { tip_on_ground: slip-; } track x, tilt, u, turn; provide force; }
    }
}

mechanical_system! {
    /// A heavy ball whose centre of mass is beside its own, sliding on a plane that rises.
    pub system Ball {
        constants { m = 1.3, a = 0.4, b = 0.15, J = 0.2, g = 9.81, mu = 0.45 }
        coordinates { x, y, z, yaw, pitch, roll }
        let axes = rot_z(yaw)*rot_x(pitch)*rot_z(roll);
        bodies { ball { mass: m, inertia: diag(J, 2*J, 3*J), center: vec(x, y, z), orientation: axes } }
        gravity = vec(0, 0, -g);
        let middle = vec(x, y, z) + b*axes.x;
        let lowest = middle - vec(0, 0, a);
        contacts {
            floor: gap = lowest.z - x/5, slip = vec(ball.velocity_at(lowest).x, ball.velocity_at(lowest).y), friction = mu;
        }
        outputs { force = reaction(floor); height = gap(floor); }
        scene Sliding { modes { floor: slip; } track x, y, yaw, pitch, roll; provide force; }
    }
}

mechanical_system! {
    /// A table on two feet that slip the same way, on a floor that is not level.
    pub system Table {
        constants { m = 3, J = 0.4, h = 0.8, b = 0.5, g = 9.81, mu = 0.3, nu = 0.7 }
        inputs { push }
        coordinates { x, z, tilt }
        kinetic_energy = m/2*(dot(x)^2 + dot(z)^2) + J/2*dot(tilt)^2;
        potential_energy = m*g*z;
        forces { push along dot(x) + h/3*dot(tilt); }
        let left = vec(x - b*cos(tilt) + h*sin(tilt), z - b*sin(tilt) - h*cos(tilt));
        let right = vec(x + b*cos(tilt) + h*sin(tilt), z + b*sin(tilt) - h*cos(tilt));
        contacts {
            one: gap = left.y - left.x/7, slip = dot(left).x, friction = mu;
            two: gap = right.y - right.x/7, slip = dot(right).x, friction = nu;
        }
        outputs { first = reaction(one); second = reaction(two); height = gap(one); }
        scene Sliding { modes { one: slip-; two: slip-; } track x; provide first, second; }
    }
}

mechanical_system! {
    /// Grips of all kinds: with a limit, with a load that is written out, loaded by a wall and by a guide.
    pub system Brakes {
        constants { m = 1.1, k = 2.3, limit = 0.9, mu = 0.35, nu = 0.8, g = 9.81 }
        coordinates { x, y, p, q }
        inputs { push }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + dot(p)^2/3 + dot(q)^2/5 + dot(x)*dot(p)/9 + dot(y)*dot(q)/8 + dot(p)*dot(q)/6;
        potential_energy = k/2*x^2 + m*g*y + x*p/4 + q^2;
        forces { push along dot(x); }
        constraints { guide: dot(y) = dot(p)*sin(q)/2 + dot(q)/3; }
        contacts {
            wall: gap = x - p/5;
            clutch: grip = dot(p) - dot(q), limit = limit*(1 + q^2);
            pads: grip = dot(q), friction = nu/(1 + speed), load = 3 + p^2;
            rail: grip = dot(p) + dot(q)/4, friction = nu/2, load = reaction(guide);
            brake: grip = dot(p), friction = mu, load = reaction(wall);
        }
        modes { wall: open, closed; clutch: stick, slip+; pads: slip; brake: slip; rail: slip; }
        outputs { press = reaction(wall); rubs = reaction(brake); slides = reaction(rail); clutches = reaction(clutch); }
        scene Turning {
            modes { wall: closed; clutch: slip+; pads: slip-; brake: slip+; rail: slip-; }
            track p, q; provide press, rubs, slides, clutches;
        }
        scene Loose { modes { wall: open; clutch: stick; pads: slip+; brake: slip-; rail: slip+; } track p, q, x; }
    }
}

/// Asserts that numbers are equal but for rounding.
fn are_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{found:?} {expected:?}");
    }
}

#[test]
fn a_rod_slips_both_ways() {
    use rod::{Inputs, Mode, State, TipOnGround, ahead, back};
    let system = Rod::default().prepare().unwrap();
    let (forward, backward) =
        (rod::Ahead::default().prepare().unwrap(), rod::Back::default().prepare().unwrap());
    let mut seed = 5;
    for _ in 0..40 {
        let (t, push) = (drawn(&mut seed), drawn(&mut seed) * 8.0);
        let (x, tilt) = (2.0 * drawn(&mut seed), 0.3 + drawn(&mut seed));
        let (u, turn) = (4.0 * (drawn(&mut seed) - 0.5), drawn(&mut seed) - 0.5);
        let (y, w) = (0.7 * tilt.sin(), 0.7 * tilt.cos() * turn);
        let slip = u - 0.7 * tilt.sin() * turn + t / 3.0;
        let driven = system.driven(Inputs { push });
        let whole = State { x, y, tilt, u, w, turn };
        let state = if slip > 0.0 { TipOnGround::SlipForward } else { TipOnGround::SlipBackward };
        let mode = Mode { tip_on_ground: state };
        let rates = System::<f64, 6>::rhs(&driven.in_mode(mode, [x > 1.0]), t, &whole.into());
        let outputs = driven.outputs_in_mode(mode, t, &whole);
        if slip > 0.0 {
            let state = ahead::State { x, tilt, u, turn };
            let rate = forward.rhs(t, &state, &ahead::Inputs { push });
            are_close(&<[f64; 4]>::from(rate), &[rates[0], rates[2], rates[3], rates[5]]);
            let own = forward.outputs(t, &state, &ahead::Inputs { push });
            are_close(&own.force, &outputs.force);
            are_close(&[own.creep], &[slip]);
            are_close(
                &[forward.reactions(t, &state, &ahead::Inputs { push }).tip_on_ground_n],
                &outputs.force[..1],
            );
        } else {
            let state = back::State { x, tilt, u, turn };
            let rate = backward.rhs(t, &state, &back::Inputs { push });
            are_close(&<[f64; 4]>::from(rate), &[rates[0], rates[2], rates[3], rates[5]]);
            are_close(&backward.outputs(t, &state, &back::Inputs { push }).force, &outputs.force);
        }
    }
}

/// Where friction presses the tip into the ground there is no motion, or another one beside it.
#[test]
fn a_rod_has_no_motion_in_a_paradox() {
    let rod = |mu: f64| rod::Ahead { mu, ..Default::default() }.prepare().unwrap();
    let start = rod::ahead::State { x: 0.0, tilt: 1.0, u: 1.0, turn: 0.0 };
    let inputs = rod::ahead::Inputs { push: 0.0 };
    assert!(rod(0.5).driven(inputs).simulate(&start, 0.0..0.01).is_ok());
    let error = rod(3.0).driven(inputs).simulate(&start, 0.0..0.01).unwrap_err().to_string();
    assert!(error.contains("must not vanish"), "{error}");
    let reason =
        rod::ahead::DOMAIN_REASONS.iter().any(|reason| reason.contains("the friction of tip_on_ground"));
    assert!(reason, "{:?}", rod::ahead::DOMAIN_REASONS);
}

#[test]
fn a_ball_slips_in_all_directions() {
    let system = Ball::default().prepare().unwrap();
    let sliding = ball::Sliding::default().prepare().unwrap();
    let mode = ball::Mode { floor: ball::Floor::Slip };
    let mut seed = 9;
    for _ in 0..40 {
        let own = ball::sliding::State::from(core::array::from_fn(|_| 0.3 + drawn(&mut seed)));
        let mut whole = [0.0; 12];
        sliding.determine(0.0, &own.into(), &mut whole);
        let mut whole = own.within(ball::State::from(whole));
        whole.z -= system.outputs_in_mode(mode, 0.0, &whole).height;
        let rates = System::<f64, 12>::rhs(&system.in_mode(mode), 0.0, &whole.into());
        let found = sliding.rhs(0.0, &own).within(ball::State::from(rates));
        are_close(&<[f64; 12]>::from(found), &rates);
        let force = system.outputs_in_mode(mode, 0.0, &whole).force;
        are_close(&sliding.outputs(0.0, &own).force, &force);
        // Friction is `mu` times the load, against the slip.
        assert!((force[1].hypot(force[2]) - 0.45 * force[0].abs()).abs() < 1e-12 * force[0].abs());
    }
}

#[test]
fn two_feet_slip_at_once() {
    let system = Table::default().prepare().unwrap();
    let sliding = table::Sliding::default().prepare().unwrap();
    let mode = table::Mode { one: table::One::SlipBackward, two: table::Two::SlipBackward };
    let tilt = (1.0_f64 / 7.0).atan();
    for k in 0..20 {
        let push = f64::from(k) - 7.0;
        let own = table::sliding::State { x: 0.3 * f64::from(k), tilt, x_rate: -0.2 - f64::from(k) };
        let mut whole = [0.0; 6];
        sliding.determine(0.0, &own.into(), &mut whole);
        let mut whole = own.within(table::State { tilt, ..table::State::from(whole) });
        let driven = system.driven(table::Inputs { push });
        whole.z -= driven.outputs_in_mode(mode, 0.0, &whole).height;
        let rates = System::<f64, 6>::rhs(&driven.in_mode(mode), 0.0, &whole.into());
        let inputs = table::sliding::Inputs { push };
        let found = sliding.rhs(0.0, &own, &inputs).within(table::State::from(rates));
        are_close(&<[f64; 6]>::from(found), &rates);
        let (outputs, expected) =
            (sliding.outputs(0.0, &own, &inputs), driven.outputs_in_mode(mode, 0.0, &whole));
        are_close(&[outputs.first, outputs.second].concat(), &[expected.first, expected.second].concat());
        assert!((outputs.first[1] - 0.3 * outputs.first[0]).abs() < 1e-12 * outputs.first[0].abs());
    }
}

#[test]
fn grips_slip_under_loads_of_all_kinds() {
    use brakes::{Brake, Clutch, Inputs, Mode, Pads, Rail, State, Wall, loose, turning};
    let system = Brakes::default().prepare().unwrap();
    let (closed, open) =
        (brakes::Turning::default().prepare().unwrap(), brakes::Loose::default().prepare().unwrap());
    let mut seed = 3;
    let mut signs = [0; 2];
    for _ in 0..60 {
        let push = 20.0 * (drawn(&mut seed) - 0.5);
        let driven = system.driven(Inputs { push });
        let mode = Mode {
            wall: Wall::Closed,
            clutch: Clutch::SlipForward,
            pads: Pads::SlipBackward,
            brake: Brake::SlipForward,
            rail: Rail::SlipBackward,
        };
        let own = turning::State::from(core::array::from_fn(|_| 3.0 * drawn(&mut seed) - 1.5));
        let mut whole = [0.0; 7];
        closed.determine(0.0, &own.into(), &mut whole);
        let mut whole = own.within(State::from(whole));
        whole.x = whole.p / 5.0;
        let rates = System::<f64, 7>::rhs(&driven.in_mode(mode), 0.0, &whole.into());
        let found = closed.rhs(0.0, &own, &turning::Inputs { push }).within(State::from(rates));
        are_close(&<[f64; 7]>::from(found), &rates);
        let (found, expected) =
            (closed.outputs(0.0, &own, &turning::Inputs { push }), driven.outputs_in_mode(mode, 0.0, &whole));
        let list = |press: f64, rubs: f64, slides: f64, clutches: f64| [press, rubs, slides, clutches];
        are_close(
            &list(found.press, found.rubs, found.slides, found.clutches),
            &list(expected.press, expected.rubs, expected.slides, expected.clutches),
        );
        signs[usize::from(found.press > 0.0)] += 1;
        let mode = Mode {
            wall: Wall::Open,
            clutch: Clutch::Stick,
            pads: Pads::SlipForward,
            brake: Brake::SlipBackward,
            rail: Rail::SlipForward,
        };
        let own = loose::State::from(core::array::from_fn(|_| 3.0 * drawn(&mut seed) - 1.5));
        let mut whole = [0.0; 7];
        open.determine(0.0, &own.into(), &mut whole);
        let whole = own.within(State::from(whole));
        let rates = System::<f64, 7>::rhs(&driven.in_mode(mode), 0.0, &whole.into());
        let found = open.rhs(0.0, &own, &loose::Inputs { push }).within(State::from(rates));
        are_close(&<[f64; 7]>::from(found), &rates);
    }
    assert!(signs[0] > 5 && signs[1] > 5, "{signs:?}");
}

mechanical_system! {
    /// A puck on a table.
    pub system Puck {
        constants { m = 1, mu = 0.25, g = 9.81 }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y); w = dot(z); }
        kinetic_energy = m/2*(u^2 + v^2 + w^2);
        potential_energy = m*g*z;
        contacts { table: gap = z, slip = vec(u, v), friction = mu; }
        scene Sliding { modes { table: slip; } track x, y; }
    }
}

/// With any method a run ends where the slip does, and not behind it.
#[test]
fn a_puck_slides_until_it_stops() {
    let sliding = puck::Sliding::default().prepare().unwrap();
    for u in [3.0_f64, 0.7, 0.0] {
        let start = puck::sliding::State { x: 0.0, y: 0.0, u, v: 4.0 };
        let speed = u.hypot(4.0);
        let (end, deceleration) = (speed / (0.25 * 9.81), 0.25 * 9.81);
        let motion = sliding.simulate(&start, 0.0..0.9 * end).unwrap();
        let t = 0.9 * end;
        let path = t - deceleration / speed * t * t / 2.0;
        let last = motion.at(t);
        are_close(&[last.x, last.y, last.u, last.v], &[u * path, 4.0 * path, 0.1 * u, 0.4]);
        let ends = |error: String, within: f64| {
            assert!(error.contains("`u^2 + v^2` must not vanish"), "{error}");
            let (_, rest) = error.split_once("stopped at t = ").unwrap();
            let time: f64 = rest.split_once(": ").unwrap().0.parse().unwrap();
            assert!(time <= end && end - time < within, "{error}");
        };
        ends(sliding.simulate(&start, 0.0..2.0 * end).unwrap_err().to_string(), 1e-6);
        let by_rk4 = sliding.simulation(&start).method(Rk4::new(0.01)).run(0.0..2.0 * end);
        ends(by_rk4.unwrap_err().to_string(), 0.03);
    }
}
