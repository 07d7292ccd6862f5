//! `guen::components` against closed forms and calculations that share no code with the derivation.
#![allow(clippy::needless_range_loop, reason = "indices are those of the formulas")]

use guen::components::{
    Blade, Cable, Caster, GearMotor, PlanarArm, RelaxationTyre, ResistiveGearMotor, RollingWheel,
    SideslipWheel, SpatialArm, SpringDamper, StribeckFriction,
};
use guen::prelude::*;

/// Runs a system with RK8 in steps so small that what remains is rounding.
fn after<S, const N: usize>(system: &S, start: [f64; N], end: f64) -> [f64; N]
where
    S: System<f64, N>,
{
    let steps = 4000;
    let h = end / f64::from(steps);
    let (mut t, mut x) = (0.0, start);
    for _ in 0..steps {
        // The classical method, written here: errors of 1e-11 for what follows.
        let f = |t: f64, x: &[f64; N]| System::rhs(system, t, x);
        let moved = |k: &[f64; N], c: f64| std::array::from_fn::<f64, N, _>(|i| x[i] + c * k[i]);
        let k1 = f(t, &x);
        let k2 = f(t + h / 2.0, &moved(&k1, h / 2.0));
        let k3 = f(t + h / 2.0, &moved(&k2, h / 2.0));
        let k4 = f(t + h, &moved(&k3, h));
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        t += h;
    }
    x
}

guen::mechanical_system! {
    system Towed {
        constants   { M > 0 }
        coordinates { x }
        particles   { M at vec(x, 0, 0); }
        parameters  { speed = dot(x); }
        use Caster as caster { mount: vec(x, 0, 0), frame: rot_z(0) }
    }
}

#[test]
fn a_towed_caster_follows_a_tractrix() {
    let caster = Caster { trail: 0.3, radius: 0.1, mass: 0.5, spin_inertia: 0.01, swivel_inertia: 0.02 };
    let towed = Towed { M: 2.0, caster }.prepare().unwrap();
    let mut start = towed::State { x: 0.0, speed: 1.0, ..Default::default() };
    start.caster.swivel = 1.2;
    let energy = towed.energy(0.0, &start);
    let end = towed::State::from(after(&towed, start.into(), 0.7));
    assert!((end.caster.swivel / 2.0).tan() < 0.3);
    let expected = 2.0 * ((1.2_f64 / 2.0).tan() * (-end.x / 0.3).exp()).atan();
    assert!((end.caster.swivel - expected).abs() < 1e-10, "{end:?} {expected}");
    assert!((towed.energy(0.7, &end) - energy).abs() < 1e-10);
}

guen::mechanical_system! {
    system Unicycle {
        constants   { J > 0, r > 0 }
        coordinates { x, y, heading }
        kinetic_energy = J/2*dot(heading)^2;
        let ahead = vec(cos(heading), sin(heading));
        let side  = vec(-sin(heading), cos(heading));
        use RollingWheel as wheel { hub: vec(x, y, r), axle: side, forward: ahead, radius: r }
        parameters  { turning = dot(heading); spin = dot(wheel.angle); }
    }
}

#[test]
fn a_rolling_wheel_runs_in_a_circle() {
    let wheel = RollingWheel { mass: 1.3, spin_inertia: 0.2 };
    let unicycle = Unicycle { J: 0.4, r: 0.25, wheel }.prepare().unwrap();
    let start = unicycle::State { turning: 0.8, spin: 3.0, ..Default::default() };
    let end = unicycle::State::from(after(&unicycle, start.into(), 2.0));
    let (v, w, t) = (0.25 * 3.0, 0.8, 2.0_f64);
    assert!((end.x - v / w * (w * t).sin()).abs() < 1e-10, "{end:?}");
    assert!((end.y - v / w * (1.0 - (w * t).cos())).abs() < 1e-10);
    assert!((end.wheel.angle - 6.0).abs() < 1e-10 && (end.spin - 3.0).abs() < 1e-10);
}

guen::mechanical_system! {
    system Sleigh {
        constants   { m > 0, J > 0, a }
        coordinates { x, y, heading }
        let ahead = vec(cos(heading), sin(heading));
        let runner = vec(x, y);
        particles   { m at runner + a*ahead; }
        kinetic_energy = J/2*dot(heading)^2;
        parameters  { v = inner(dot(runner), ahead); w = dot(heading); }
        use Blade as blade { point: runner, across: vec(-sin(heading), cos(heading)) }
    }
}

#[test]
fn a_blade_makes_a_sleigh() {
    let (m, j, a) = (2.0, 0.3, 0.4);
    let sleigh = Sleigh { m, J: j, a }.prepare().unwrap();
    let state = sleigh::State { heading: 0.7, v: 1.1, w: -0.6, ..Default::default() };
    let rate = sleigh.rhs(0.0, &state);
    assert!((rate.v - a * 0.36).abs() < 1e-14, "{rate:?}");
    assert!((rate.w - m * a * 1.1 * 0.6 / (j + m * a * a)).abs() < 1e-14, "{rate:?}");
}

guen::mechanical_system! {
    system Cart {
        constants   { m > 0, r > 0 }
        coordinates { s, side }
        let hub = vec(s, side, r);
        use SideslipWheel as wheel { hub, axle: vec(0, 1, 0), forward: vec(1, 0, 0), radius: r }
        particles   { m at hub; }
        parameters  { v = dot(s); u = dot(side); }
        use SpringDamper as spring { from: vec(0, 0, 0), to: vec(2/3*s, -2/3*s, 1/3*s) }
        use StribeckFriction as friction { speed: v }
        use ResistiveGearMotor as motor { angle: wheel.angle }
    }
}

#[test]
fn a_cart_with_spring_friction_motor_and_sideslip() {
    let wheel = SideslipWheel { mass: 0.5, spin_inertia: 0.02, side_damping: 3.0 };
    let spring = SpringDamper { stiffness: 7.0, damping: 0.4, rest: 0.6 };
    let friction =
        StribeckFriction { kinetic: 0.5, breakaway: 0.9, stribeck: 0.2, viscous: 0.1, smoothing: 0.05 };
    let motor = ResistiveGearMotor { resistance: 2.0, constant: 0.3, ratio: 4.0, rotor_inertia: 0.001 };
    let (m, r) = (1.5, 0.2);
    let cart = Cart { m, r, wheel, spring, friction, motor }.prepare().unwrap();
    let inputs = cart::Inputs { motor: cart::motor::Inputs { voltage: 5.0 } };
    let state = cart::State { s: 0.8, side: 0.1, v: 0.15, u: -0.7, ..Default::default() };
    let rate = cart.rhs(0.0, &state, &inputs);
    let inertia = m + 0.5 + 0.02 / (r * r) + 0.001 * 16.0 / (r * r);
    let pull = 7.0 * (0.8 - 0.6) + 0.4 * 0.15;
    let drag = (0.5 + 0.4 * (-(0.15_f64 / 0.2).powi(2)).exp()) * (0.15_f64 / 0.05).tanh() + 0.1 * 0.15;
    let current = (5.0 - 0.3 * 4.0 * 0.15 / r) / 2.0;
    let v = (4.0 * 0.3 * current / r - pull - drag) / inertia;
    assert!((rate.v - v).abs() < 1e-13, "{rate:?} {v}");
    assert!((rate.u - 3.0 * 0.7 / (m + 0.5)).abs() < 1e-13);
    assert!((rate.wheel.angle - 0.15 / r).abs() < 1e-15);
    let outputs = cart.outputs(0.0, &state, &inputs);
    assert!((outputs.motor.winding_current - current).abs() < 1e-14);
    assert!((outputs.spring.tension - pull).abs() < 1e-14 && (outputs.friction.force - drag).abs() < 1e-14);
    assert_eq!(outputs.wheel.sideslip_speed, -0.7);
}

/// The solution of `x' = a x + b` for two variables at a time, from the eigenvalues: these are complex or real, and differ.
fn linear(a: [[f64; 2]; 2], b: [f64; 2], start: [f64; 2], t: f64) -> [f64; 2] {
    let (trace, det) = (a[0][0] + a[1][1], a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    let rest = [(a[0][1] * b[1] - a[1][1] * b[0]) / det, (a[1][0] * b[0] - a[0][0] * b[1]) / det];
    let from = [start[0] - rest[0], start[1] - rest[1]];
    // exp(a t) = exp(trace t/2) (c 1 + s (a - trace/2)), with s = sinh(w t)/w.
    let square = trace * trace / 4.0 - det;
    let w = square.abs().sqrt();
    let (c, s) =
        if square > 0.0 { ((w * t).cosh(), (w * t).sinh() / w) } else { ((w * t).cos(), (w * t).sin() / w) };
    let shifted =
        |i: usize| (0..2).map(|j| (a[i][j] - if i == j { trace / 2.0 } else { 0.0 }) * from[j]).sum::<f64>();
    std::array::from_fn(|i| rest[i] + (trace * t / 2.0).exp() * (c * from[i] + s * shifted(i)))
}

guen::mechanical_system! {
    system Winch {
        constants   { J > 0 }
        coordinates { q }
        kinetic_energy = J/2*dot(q)^2;
        parameters  { w = dot(q); }
        use GearMotor as motor { angle: q }
    }
}

#[test]
fn a_motor_with_a_winding_follows_its_closed_form() {
    for inductance in [0.004, 0.2] {
        let motor = GearMotor { resistance: 2.0, inductance, constant: 0.3, ratio: 4.0, rotor_inertia: 0.01 };
        let winch = Winch { J: 0.5, motor }.prepare().unwrap();
        let driven = winch.driven(winch::Inputs { motor: winch::motor::Inputs { voltage: 6.0 } });
        assert_eq!(winch::State::NAMES, ["q", "w", "motor.current"]);
        let mut start = winch::State { w: -0.5, ..Default::default() };
        start.motor.current = 0.7;
        let end = winch::State::from(after(&driven, start.into(), 0.4));
        let inertia = 0.5 + 16.0 * 0.01;
        let a = [[0.0, 4.0 * 0.3 / inertia], [-0.3 * 4.0 / inductance, -2.0 / inductance]];
        let [w, current] = linear(a, [0.0, 6.0 / inductance], [-0.5, 0.7], 0.4);
        assert!((end.w - w).abs() < 1e-9, "{end:?} {w}");
        assert!((end.motor.current - current).abs() < 1e-9, "{end:?} {current}");
    }
}

guen::mechanical_system! {
    system Drawn {
        constants   { V }
        coordinates { s, side }
        let hub = vec(V*s, side, 1/5);
        use RelaxationTyre as tyre { hub, axle: vec(0, 1, 0), forward: vec(1, 0, 0), radius: 1/5 }
        parameters  { v = dot(s); u = dot(side); }
    }
}

#[test]
fn a_tyre_relaxes_over_its_length() {
    // Nothing brakes the wheel: it rolls forwards, or backwards, at its speed, while the tyre swings against its mass.
    for speed in [3.0, -3.0] {
        let tyre = RelaxationTyre { mass: 2.0, spin_inertia: 0.02, stiffness: 90.0, relaxation: 0.4 };
        let drawn = Drawn { V: speed, tyre }.prepare().unwrap();
        let start = drawn::State { v: 1.0, u: 0.5, ..Default::default() };
        let end = drawn::State::from(after(&drawn, start.into(), 0.6));
        let a = [[0.0, -90.0 / 2.0], [1.0, -3.0 / 0.4]];
        let [u, deflection] = linear(a, [0.0; 2], [0.5, 0.0], 0.6);
        assert!((end.u - u).abs() < 1e-9 && (end.tyre.deflection - deflection).abs() < 1e-9, "{end:?} {u}");
        assert!((end.tyre.angle - speed * 0.6 / 0.2).abs() < 1e-9);
        assert_eq!(drawn.outputs(0.0, &end).tyre.side_force, -90.0 * end.tyre.deflection);
    }
}

guen::mechanical_system! {
    system Sliding {
        constants   { m > 0 }
        coordinates { s }
        particles   { m at vec(s, 0); }
        parameters  { v = dot(s); }
        use StribeckFriction as friction { speed: v }
    }
}

#[test]
fn smooth_friction_ends_a_motion_as_its_closed_form_says() {
    let friction =
        StribeckFriction { kinetic: 0.5, breakaway: 0.5, stribeck: 0.2, viscous: 0.0, smoothing: 0.3 };
    let sliding = Sliding { m: 2.0, friction }.prepare().unwrap();
    let end = sliding::State::from(after(&sliding, [0.0, 1.0], 3.0));
    let expected = 0.3 * ((1.0_f64 / 0.3).sinh() * (-0.5_f64 * 3.0 / (2.0 * 0.3)).exp()).asinh();
    assert!((end.v - expected).abs() < 1e-10, "{end:?} {expected}");
}

guen::mechanical_system! {
    /// Nothing but a cable between two nails.
    system Nailed {
        constants { span > 0 }
        use Cable as cable { from: vec(0, 0, 0), to: vec(span, 0, 0), segments: 8 }
    }
}

#[test]
fn a_stretched_cable_swings_like_a_chain_of_masses() {
    let cable = Cable { mass: 0.8, length: 1.0, stiffness: 50.0, damping: 0.3 };
    let nailed = Nailed { span: 1.2, cable }.prepare().unwrap();
    let tension = 50.0 * 0.2;
    for mode in [1.0, 3.0, 7.0_f64] {
        let mut state = nailed::State::default();
        let shape = |i: f64| 1e-6 * (std::f64::consts::PI * mode * i / 8.0).sin();
        for i in 0..7 {
            let k = (i + 1) as f64;
            state.cable.x[i] = 1.2 * k / 8.0;
            state.cable.y[i] = shape(k);
        }
        let rate = nailed.rhs(0.0, &state);
        let square = 4.0 * tension / (0.1 * 0.15) * (std::f64::consts::PI * mode / 16.0).sin().powi(2);
        for i in 0..7 {
            let expected = -square * state.cable.y[i];
            assert!((rate.cable.y_rate[i] - expected).abs() < 1e-5 * square * 1e-6, "{mode} {i}");
            assert!(rate.cable.x_rate[i].abs() < 1e-6 && rate.cable.z_rate[i] == 0.0);
        }
    }
    // Along the cable: stiffness and damping.
    let mut state = nailed::State::default();
    (0..7).for_each(|i| state.cable.x[i] = 1.2 * (i + 1) as f64 / 8.0);
    state.cable.x_rate[2] = 0.01;
    state.cable.x[5] += 0.001;
    let rate = nailed.rhs(0.0, &state);
    let damping = -2.0 * 0.3 * 8.0 / 1.0 * 0.01 / 0.1;
    assert!((rate.cable.x_rate[2] - damping).abs() < 1e-9, "{rate:?}");
    let spring = -2.0 * 50.0 * 8.0 * 0.001 / 0.1;
    assert!((rate.cable.x_rate[5] - spring).abs() < 1e-8, "{rate:?}");
}

guen::mechanical_system! {
    /// Two cables with other numbers of segments.
    system Strung {
        count n = 3;
        constants { span > 0 }
        use Cable as three { from: vec(0, 0, 0), to: vec(span, 0, 0), segments: n }
        use Cable as two   { from: vec(0, 1, 0), to: vec(span, 1, 0), segments: n - 1 }
    }
}

#[test]
fn cables_have_as_many_segments_as_their_use_says() {
    let cable = Cable { mass: 0.8, length: 1.0, stiffness: 50.0, damping: 0.3 };
    let strung = Strung { span: 1.2, three: cable, two: cable }.prepare().unwrap();
    let mut state = strung::State::default();
    state.three.x = [0.4, 0.8];
    state.three.y = [1e-6, 1e-6];
    state.two.x = [0.6];
    state.two.y = [1.0 + 1e-6];
    let rate = strung.rhs(0.0, &state);
    // Of n masses m/n at distances s/n the slowest swing has (2 sin(pi/(2n)))^2 T n^2/(m s).
    let square =
        |n: f64| (2.0 * (std::f64::consts::PI / (2.0 * n)).sin()).powi(2) * 10.0 * n * n / (0.8 * 1.2);
    assert!((rate.three.y_rate[0] + square(3.0) * 1e-6).abs() < 1e-10, "{rate:?}");
    assert!((rate.three.y_rate[1] + square(3.0) * 1e-6).abs() < 1e-10, "{rate:?}");
    assert!((rate.two.y_rate[0] + square(2.0) * 1e-6).abs() < 1e-10, "{rate:?}");
}

guen::mechanical_system! {
    system Bench {
        constants { g = 9.81 }
        gravity = vec(0, -g, 0);
        use PlanarArm as arm { base: vec(0.5, 0.2, 0), frame: rot_z(0) }
    }
}

fn planar() -> PlanarArm {
    PlanarArm {
        length: [0.5, 0.4, 0.3],
        center: [0.2, 0.25, 0.1],
        mass: [2.0, 1.5, 0.7],
        inertia: [0.05, 0.03, 0.01],
    }
}

#[test]
fn a_planar_arm_against_its_formulas() {
    let arm = planar();
    let bench = Bench { g: 9.81, arm }.prepare().unwrap();
    let (q, w) = ([0.3, -0.8, 1.1], [0.7, -0.2, 0.5]);
    let mut state = bench::State::default();
    (state.arm.angle, state.arm.angle_rate) = (q, w);
    // Absolute angles and rates.
    let phi: [f64; 3] = std::array::from_fn(|i| q[..=i].iter().sum());
    let spin: [f64; 3] = std::array::from_fn(|i| w[..=i].iter().sum());
    let place = |i: usize, at: f64| {
        let mut p = [0.5, 0.2];
        for k in 0..=i {
            let l = if k == i { at } else { arm.length[k] };
            p = [p[0] + l * phi[k].cos(), p[1] + l * phi[k].sin()];
        }
        p
    };
    let mut energy = 0.0;
    for i in 0..3 {
        let mut v = [0.0, 0.0];
        for k in 0..=i {
            let l = if k == i { arm.center[i] } else { arm.length[k] };
            v = [v[0] - l * phi[k].sin() * spin[k], v[1] + l * phi[k].cos() * spin[k]];
        }
        energy += arm.mass[i] / 2.0 * (v[0] * v[0] + v[1] * v[1]) + arm.inertia[i] / 2.0 * spin[i] * spin[i];
        energy += arm.mass[i] * 9.81 * place(i, arm.center[i])[1];
    }
    assert!((bench.energy(0.0, &state) - energy).abs() < 1e-12);
    // Torques that carry the weight keep an arm at rest.
    let mut torque = [0.0; 3];
    for (joint, torque) in torque.iter_mut().enumerate() {
        for i in joint..3 {
            for k in joint..=i {
                let l = if k == i { arm.center[i] } else { arm.length[k] };
                *torque += arm.mass[i] * 9.81 * l * phi[k].cos();
            }
        }
    }
    let mut rest = bench::State::default();
    rest.arm.angle = q;
    let inputs = bench::Inputs { arm: bench::arm::Inputs { torque } };
    let rate = bench.rhs(0.0, &rest, &inputs);
    assert!(rate.arm.angle_rate.iter().all(|rate| rate.abs() < 1e-11), "{rate:?}");
    let tip = bench.outputs(0.0, &rest, &inputs).arm.tip_place;
    let own = place(2, 0.3);
    assert!((tip[0] - own[0]).abs() < 1e-14 && (tip[1] - own[1]).abs() < 1e-14);
}

guen::mechanical_system! {
    system Robot {
        constants { g = 9.81 }
        gravity = vec(0, 0, -g);
        use SpatialArm as arm { base: vec(0, 0, 0), frame: rot_z(0) }
    }
}

type Frame = ([[f64; 3]; 3], [f64; 3]);

/// The frames of the links, by products of matrices.
fn frames(arm: &SpatialArm, q: &[f64; 6]) -> [Frame; 6] {
    let mut r = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut p = [0.0; 3];
    std::array::from_fn(|i| {
        let ((s, c), (sa, ca)) = (q[i].sin_cos(), arm.alpha[i].sin_cos());
        // The matrix of Denavit and Hartenberg.
        let own = [[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0.0, sa, ca]];
        let step = [arm.a[i] * c, arm.a[i] * s, arm.d[i]];
        p = std::array::from_fn(|row| p[row] + (0..3).map(|k| r[row][k] * step[k]).sum::<f64>());
        r = std::array::from_fn(|row| {
            std::array::from_fn(|col| (0..3).map(|k| r[row][k] * own[k][col]).sum())
        });
        (r, p)
    })
}

#[test]
fn a_spatial_arm_against_matrices() {
    use std::f64::consts::FRAC_PI_2;
    let arm = SpatialArm {
        a: [0.0, 0.43, 0.02, 0.0, 0.0, 0.05],
        alpha: [FRAC_PI_2, 0.1, -FRAC_PI_2, FRAC_PI_2, -FRAC_PI_2, 0.2],
        d: [0.6, 0.15, 0.0, 0.43, 0.0, 0.1],
        mass: [4.0, 3.0, 2.0, 1.0, 0.5, 0.3],
        cx: [0.01, -0.2, 0.0, 0.02, 0.0, 0.01],
        cy: [0.05, 0.0, 0.03, 0.0, 0.01, 0.0],
        cz: [0.1, 0.02, 0.0, -0.1, 0.0, 0.03],
        Ixx: [0.1, 0.2, 0.05, 0.02, 0.01, 0.005],
        Iyy: [0.12, 0.25, 0.06, 0.02, 0.012, 0.004],
        Izz: [0.09, 0.1, 0.03, 0.01, 0.008, 0.006],
    };
    let robot = Robot { g: 9.81, arm }.prepare().unwrap();
    let (q, w) = ([0.3, -0.7, 1.1, 0.4, -0.9, 0.2], [0.5, -0.3, 0.8, 1.2, -0.4, 0.9]);
    let mut state = robot::State::default();
    (state.arm.angle, state.arm.angle_rate) = (q, w);
    let moved = |h: f64| frames(&arm, &std::array::from_fn(|i| q[i] + h * w[i]));
    let h = 1e-5;
    let (before, now, behind) = (moved(-h), moved(0.0), moved(h));
    let mut energy = 0.0;
    for i in 0..6 {
        let center = |frame: &Frame| -> [f64; 3] {
            let c = [arm.cx[i], arm.cy[i], arm.cz[i]];
            std::array::from_fn(|row| frame.1[row] + (0..3).map(|k| frame.0[row][k] * c[k]).sum::<f64>())
        };
        let (a, b) = (center(&before[i]), center(&behind[i]));
        let square: f64 = (0..3).map(|k| ((b[k] - a[k]) / (2.0 * h)).powi(2)).sum();
        // The spin in the axes of the link, from the rate of its matrix.
        let rate = |row: usize, col: usize| (behind[i].0[row][col] - before[i].0[row][col]) / (2.0 * h);
        let entry = |row: usize, col: usize| (0..3).map(|k| now[i].0[k][row] * rate(k, col)).sum::<f64>();
        let spin = [entry(2, 1), entry(0, 2), entry(1, 0)];
        let moments = [arm.Ixx[i], arm.Iyy[i], arm.Izz[i]];
        energy += arm.mass[i] / 2.0 * square + arm.mass[i] * 9.81 * center(&now[i])[2];
        energy += (0..3).map(|k| moments[k] / 2.0 * spin[k] * spin[k]).sum::<f64>();
    }
    let own = robot.energy(0.0, &state);
    assert!((own - energy).abs() < 1e-8, "{own} {energy}");
    let tip = robot.outputs(0.0, &state, &robot::Inputs::default()).arm.tip_place;
    assert!((0..3).all(|k| (tip[k] - now[5].1[k]).abs() < 1e-14), "{tip:?}");
}
