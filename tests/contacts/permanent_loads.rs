//! Grips that the reaction of a permanent constraint loads, beside equations with multipliers and closed forms.

use guen::System;
use guen::hybrid::{HybridCause, TransitionKind};
use guen::mechanical_system;
use guen::steppers::Dop853;
use nalgebra::{DMatrix, DVector};

mechanical_system! {
    /// A bead on a rough wire, a circle of radius 1 in a vertical plane.
    pub system Bead {
        constants { m > 0, mu = 0.3, g = 9.81 }
        coordinates { x, y }
        parameters { u = x*dot(y) - y*dot(x); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*y;
        constraints { wire: x*dot(x) + y*dot(y) = 0; }
        contacts { rub: grip = u, friction = mu, load = reaction(wire); }
    }
}

mechanical_system! {
    /// Three velocities that a constraint couples, with friction along two others: what slips changes the reaction that loads it.
    pub system Coupled {
        constants { a, b, c, ab, ac, bc, l1, l2, l3, d1, d2, d3, e1, e2, e3, f1, f2, f3, mu, nu }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = a/2*dot(x)^2 + b/2*dot(y)^2 + c/2*dot(z)^2
            + ab*dot(x)*dot(y) + ac*dot(x)*dot(z) + bc*dot(y)*dot(z);
        forces { f1 along dot(x); f2 along dot(y); f3 along dot(z); }
        constraints { row: l1*dot(x) + l2*dot(y) + l3*dot(z) = 0; }
        contacts {
            first: grip = d1*dot(x) + d2*dot(y) + d3*dot(z), friction = mu, load = reaction(row);
            second: grip = e1*dot(x) + e2*dot(y) + e3*dot(z), friction = nu, load = reaction(row);
        }
    }
}

mechanical_system! {
    /// A block on a table that is a constraint on its velocity: its weight is the reaction.
    pub system OnTable {
        constants { m > 0, mu = 0.5, g = 9.81 }
        coordinates { x, z }
        inputs { push }
        parameters { u = dot(x); }
        kinetic_energy = m/2*(dot(x)^2 + dot(z)^2);
        potential_energy = m*g*z;
        forces { push along dot(x); }
        constraints { table: dot(z) = 0; }
        contacts { sole: grip = u, friction = mu, load = reaction(table); }
        outputs { weight = reaction(table); rubs = reaction(sole); }
        scene Sliding { track u; provide rubs; }
    }
}

mechanical_system! {
    /// A ball between a table, which is a constraint, and an oblique wall that presses it down; it rubs along the edge.
    pub system Edge {
        constants { m > 0, k, mu, e in 0..1, alpha, g = 9.81 }
        coordinates { x, y, z }
        parameters { aside = dot(x); ahead = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + dot(z)^2) + k*dot(x)*dot(y);
        potential_energy = m*g*z;
        constraints { table: dot(z) = 0; }
        contacts {
            rubs: grip = aside, friction = mu, load = reaction(table);
            wall: gap = (1 - y)*cos(alpha) - z*sin(alpha), restitution = e;
        }
    }
}

mechanical_system! {
    /// The ball at rest against two walls, which press it down differently.
    pub system Corner {
        constants { m > 0, mu, alpha, beta, g = 9.81 }
        coordinates { x, y, z }
        parameters { aside = dot(x); ahead = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + dot(z)^2);
        potential_energy = m*g*z;
        forces { 5 along dot(y); }
        constraints { table: dot(z) = 0; }
        contacts {
            rubs: grip = aside, friction = mu, load = reaction(table);
            left: gap = (1 - y)*cos(alpha) - z*sin(alpha);
            right: gap = (1 - y)*cos(beta) - z*sin(beta);
        }
    }
}

/// Numbers between minus one and one, from a seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

#[test]
fn a_bead_slips_against_the_reaction_of_its_wire_whatever_its_sign() {
    let (m, mu, g) = (0.7, 0.3, 9.81);
    let system = Bead { m, mu, g }.prepare().unwrap();
    let mut signs = [0; 2];
    for k in 0..40 {
        let (angle, speed) = (0.37 * f64::from(k), 5.0 * (0.7 * f64::from(k)).sin());
        let state = [angle.cos(), angle.sin(), speed];
        // m u^2 = m g sin - lambda.
        let reaction = m * g * angle.sin() - m * speed * speed;
        signs[usize::from(reaction > 0.0)] += 1;
        let (rub, sign) =
            if speed > 0.0 { (bead::Rub::SlipForward, 1.0) } else { (bead::Rub::SlipBackward, -1.0) };
        let in_mode = system.in_mode(bead::Mode { rub });
        let rate = System::<f64, 3>::rhs(&in_mode, 0.0, &state)[2];
        let expected = -g * angle.cos() - sign * mu * reaction.abs() / m;
        assert!((rate - expected).abs() < 1e-13 * (1.0 + expected.abs()), "{k}: {rate} {expected}");
        assert!(
            (in_mode.reactions(0.0, &state).loads[0] - reaction.abs()).abs() < 1e-13 * (1.0 + reaction.abs())
        );
    }
    assert!(signs[0] > 5 && signs[1] > 5, "{signs:?}");
}

#[test]
fn a_bead_comes_to_rest_where_friction_holds_it() {
    let (m, mu, g) = (0.7, 0.3, 9.81);
    let system = Bead { m, mu, g }.prepare().unwrap();
    let motion =
        system.simulation(&bead::State { x: 0.8, y: -0.6, u: 4.0 }).tolerance(1e-11).run(0.0..20.0).unwrap();
    let last = motion.transitions().last().unwrap();
    assert_eq!(last.kind, TransitionKind::Sticks);
    let end = motion.end();
    // At rest the weight is within the cone of its own reaction: |x| <= mu |y|.
    assert!(end.u.abs() < 1e-12 && end.x.abs() <= mu * end.y.abs(), "{end:?}");
    // Each turn is where the tangent of the slope, without friction, would lead back.
    assert!(motion.transitions().len() > 2);
    // The motion up to the first reversal again, integrated in the angle of the bead with the midpoint rule.
    let (mut angle, mut speed) = ((-0.6_f64).atan2(0.8), 4.0_f64);
    let first = motion.transitions().iter().find(|t| t.kind == TransitionKind::Reversed).unwrap();
    let rate = |angle: f64, speed: f64| {
        let reaction = m * g * angle.sin() - m * speed * speed;
        -g * angle.cos() - speed.signum() * mu * reaction.abs() / m
    };
    let (steps, mut t) = (200_000, 0.0);
    let h = first.t / f64::from(steps);
    for _ in 0..steps {
        let (k1, l1) = (speed, rate(angle, speed));
        let (k2, l2) = (speed + h / 2.0 * l1, rate(angle + h / 2.0 * k1, speed + h / 2.0 * l1));
        angle += h * k2;
        speed += h * l2;
        t += h;
    }
    assert!((t - first.t).abs() < 1e-9 && speed.abs() < 1e-7, "{speed:e} at {t}");
    let [x, y, _] = first.state_before;
    assert!((y.atan2(x) - angle).sin().abs() < 1e-7, "{angle}");
}

/// The accelerations of a mode by multipliers: of the constraint, and of what sticks; none where no sign of the reaction fits, and the
/// number of signs that do.
fn by_multipliers(
    (masses, forces): (&DMatrix<f64>, &[f64; 3]),
    row: &[f64; 3],
    grips: &[([f64; 3], f64, Option<f64>); 2],
) -> Vec<(DVector<f64>, f64)> {
    let stuck: Vec<&[f64; 3]> = grips.iter().filter(|grip| grip.2.is_none()).map(|grip| &grip.0).collect();
    let size = 4 + stuck.len();
    let mut found = Vec::new();
    for sign in [1.0, -1.0] {
        let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for i in 0..3 {
            right[i] = forces[i];
            for j in 0..3 {
                matrix[(i, j)] = masses[(i, j)];
            }
            // The reaction, with the friction that it causes.
            let friction: f64 =
                grips.iter().map(|(d, mu, slips)| slips.map_or(0.0, |slip| mu * sign * slip * d[i])).sum();
            matrix[(i, 3)] = friction - row[i];
            matrix[(3, i)] = row[i];
            for (k, d) in stuck.iter().enumerate() {
                matrix[(i, 4 + k)] = -d[i];
                matrix[(4 + k, i)] = d[i];
            }
        }
        let Some(solved) = matrix.lu().solve(&right) else { continue };
        if solved[3] * sign >= 0.0 {
            found.push((solved.clone(), solved[3]));
        }
    }
    found
}

#[test]
fn coupled_slips_have_the_accelerations_of_multipliers() {
    let mut random = Random(7);
    let (mut compared, mut coupled) = (0, 0);
    for _ in 0..400 {
        let mut three = || [random.next(), random.next(), random.next()];
        let (factor, l, d, e, f) = ([three(), three(), three()], three(), three(), three(), three());
        let masses = DMatrix::from_fn(3, 3, |i, j| {
            let product: f64 = (0..3).map(|k| factor[i][k] * factor[j][k]).sum();
            product + if i == j { 0.3 } else { 0.0 }
        });
        let (mu, nu) = (0.4 * random.next().abs(), 0.4 * random.next().abs());
        let system = Coupled {
            a: masses[(0, 0)],
            b: masses[(1, 1)],
            c: masses[(2, 2)],
            ab: masses[(0, 1)],
            ac: masses[(0, 2)],
            bc: masses[(1, 2)],
            l1: l[0],
            l2: l[1],
            l3: l[2],
            d1: d[0],
            d2: d[1],
            d3: d[2],
            e1: e[0],
            e2: e[1],
            e3: e[2],
            f1: f[0],
            f2: f[1],
            f3: f[2],
            mu,
            nu,
        };
        let system = system.prepare().unwrap();
        for first in [coupled::First::Stick, coupled::First::SlipForward, coupled::First::SlipBackward] {
            for second in
                [coupled::Second::Stick, coupled::Second::SlipForward, coupled::Second::SlipBackward]
            {
                let slips = |stick: bool, forward: bool| (!stick).then_some(if forward { 1.0 } else { -1.0 });
                let grips = [
                    (d, mu, slips(first == coupled::First::Stick, first == coupled::First::SlipForward)),
                    (e, nu, slips(second == coupled::Second::Stick, second == coupled::Second::SlipForward)),
                ];
                let state = [0.0; 5];
                let in_mode = system.in_mode(coupled::Mode { first, second });
                let motion = in_mode.reactions(0.0, &state);
                if motion.regularity < 1e-3 {
                    continue;
                }
                let found = by_multipliers((&masses, &f), &l, &grips);
                let [(solved, reaction)] = &found[..] else { panic!("{} answers", found.len()) };
                let rates = System::<f64, 5>::rhs(&in_mode, 0.0, &state);
                let scale = 1.0 + solved.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                for i in 0..2 {
                    assert!(
                        (rates[3 + i] - solved[i]).abs() < 1e-9 * scale,
                        "{first:?} {second:?} {rates:?} {solved}"
                    );
                }
                for load in motion.loads {
                    assert!((load - reaction.abs()).abs() < 1e-9 * scale, "{load} {reaction}");
                }
                compared += 1;
                coupled += usize::from(grips.iter().any(|grip| grip.2.is_some()));
            }
        }
    }
    assert!(compared > 3000 && coupled > 2500, "{compared} {coupled}");
}

#[test]
fn a_block_sticks_and_slips_by_its_weight_on_a_constraint() {
    let (m, mu, g) = (2.0, 0.5, 9.81);
    let system = OnTable { m, mu, g }.prepare().unwrap();
    let hold = mu * m * g;
    let start = on_table::State { u: 1.0, ..Default::default() };
    let motion = system.driven(on_table::Inputs { push: 0.9 * hold }).simulate(&start, 0.0..50.0).unwrap();
    // It slows down by 0.1 of the friction's deceleration, and stays.
    let [.., last] = motion.transitions() else { panic!() };
    assert_eq!(last.kind, TransitionKind::Sticks);
    assert!((last.t - 1.0 / (0.1 * mu * g)).abs() < 1e-9, "{}", last.t);
    assert_eq!(motion.end().u, 0.0);
    let motion = system.driven(on_table::Inputs { push: 1.5 * hold }).simulate(&start, 0.0..2.0).unwrap();
    assert!((motion.end().u - (1.0 + 2.0 * 0.5 * mu * g)).abs() < 1e-9, "{:?}", motion.end());
    // A scene that asks for the speed alone knows the load as well.
    assert_eq!(on_table::sliding::State::<f64>::NAMES, ["u"]);
    let sliding = on_table::Sliding::from(OnTable { m, mu, g }).prepare().unwrap();
    let push = on_table::Inputs { push: 0.9 * hold };
    let own = sliding.driven(push.into()).simulate(&on_table::sliding::State { u: 1.0 }, 0.0..50.0).unwrap();
    let [.., last] = own.transitions() else { panic!() };
    assert!(last.kind == TransitionKind::Sticks && (last.t - 1.0 / (0.1 * mu * g)).abs() < 1e-9, "{last:?}");
}

/// The wall presses the ball onto the table with `tan(alpha)` of the impulse that throws it back, in compression and in expansion.
#[test]
fn an_impact_loads_a_grip_through_the_constraint() {
    let (m, e, alpha, g) = (0.7, 0.4, 0.5_f64, 9.81);
    let (fast, v) = (3.0, 2.0);
    for (mu, sticks) in [(0.2, false), (2.0, true)] {
        let system = Edge { m, k: 0.0, mu, e, alpha, g }.prepare().unwrap();
        let start = edge::State { aside: fast, ahead: v, y: 0.9, ..Default::default() };
        let motion = system.simulation(&start).tolerance(1e-12).run(0.0..0.1).unwrap();
        let impact = motion.transitions().iter().find(|t| t.kind == TransitionKind::Impact).unwrap();
        assert!((impact.t - 0.1 / v).abs() < 1e-12, "{}", impact.t);
        let [.., before, _] = impact.state_before;
        let [.., after, back] = impact.state_after;
        assert!((before - (fast - mu * g * impact.t)).abs() < 1e-11, "{before}");
        assert!((back + e * v).abs() < 1e-12, "{back}");
        let braked = before - mu * (1.0 + e) * v * alpha.tan();
        assert_eq!(braked < 0.0, sticks);
        assert!((after - braked.max(0.0)).abs() < 1e-12, "{mu}: {after} {braked}");
        if sticks {
            assert_eq!(impact.after.rubs, edge::Rubs::Stick);
            continue;
        }
        // The derivatives of the speed at the end, by the speeds at the start and by the place, which changes the time of the impact alone.
        let derivatives = motion.sensitivity(&Dop853::new(1e-12, 1e-12)).unwrap();
        let expected = [0.0, 0.0, 0.0, 1.0, -mu * (1.0 + e) * alpha.tan()];
        for (found, expected) in derivatives[3].iter().zip(expected).filter(|(_, expected)| *expected != 0.0)
        {
            assert!((found - expected).abs() < 1e-9, "{derivatives:?}");
        }
        assert!(derivatives[3][1].abs() < 1e-9, "{derivatives:?}");
    }
}

/// With a coupling of both speeds by the masses the friction changes the impulse of the wall, and with it the load.
#[test]
fn friction_and_the_impulse_that_loads_it_are_found_together() {
    let (m, mu, e, alpha, g) = (0.7, 0.3, 0.4, 0.5_f64, 9.81);
    for k in [-0.3, 0.25] {
        for fast in [6.0, -6.0] {
            let system = Edge { m, k, mu, e, alpha, g }.prepare().unwrap();
            let start = edge::State { aside: fast, ahead: 4.0, y: 0.9, ..Default::default() };
            let motion = system.simulation(&start).tolerance(1e-12).run(0.0..0.1).unwrap();
            let impact = motion.transitions().iter().find(|t| t.kind == TransitionKind::Impact).unwrap();
            let [.., before, ahead] = impact.state_before;
            let [.., after, back] = impact.state_after;
            // The inverse of the masses, and what an impulse of one along the wall does with its friction.
            let (own, other) = (m / (m * m - k * k), -k / (m * m - k * k));
            let (across, along) = (-alpha.cos(), -before.signum() * mu * alpha.sin());
            let impulse = ahead / -(own * across + other * along);
            let expected = before + (1.0 + e) * impulse * (own * along + other * across);
            assert!(expected * before > 0.0, "it slips throughout");
            assert!(
                (back + e * ahead).abs() < 1e-12 && (after - expected).abs() < 1e-12,
                "{after} {expected}"
            );
        }
    }
}

/// Through reversals of a bead, beside differences of runs. With the higher speed the wire's reaction passes through zero while the bead
/// slips: the friction has a kink there, at which no step ends, and derivatives lose digits.
#[test]
fn derivatives_of_a_bead_are_those_of_differences() {
    let system = Bead { m: 0.7, mu: 0.3, g: 9.81 }.prepare().unwrap();
    let start = |angle: f64, u: f64| bead::State { x: angle.cos(), y: angle.sin(), u };
    let run =
        |angle: f64, u: f64| system.simulation(&start(angle, u)).tolerance(1e-13).run(0.0..1.0).unwrap();
    for (speed, accuracy) in [(2.0, 1e-7), (4.0, 1e-5)] {
        let motion = run(-0.6, speed);
        assert!(motion.transitions().iter().any(|t| t.kind == TransitionKind::Reversed));
        let matrix = motion.sensitivity(&Dop853::new(1e-13, 1e-13)).unwrap();
        let h = 1e-5;
        let angle_of = |state: &bead::State<f64>| state.y.atan2(state.x);
        let [ahead, behind] = [h, -h].map(|h| run(-0.6, speed + h).end());
        let end = motion.end();
        // The change of the angle is that of the place across the radius.
        let turned = end.x * matrix[1][2] - end.y * matrix[0][2];
        let of_angle = (angle_of(&ahead) - angle_of(&behind)) / (2.0 * h);
        assert!((turned - of_angle).abs() < accuracy, "{speed}: {turned} {of_angle}");
        let of_speed = (ahead.u - behind.u) / (2.0 * h);
        assert!((matrix[2][2] - of_speed).abs() < accuracy, "{speed}: {} {of_speed}", matrix[2][2]);
    }
}

/// The share of each wall is not determined, and with it the load of the grip.
#[test]
fn a_load_that_is_not_determined_ends_the_run() {
    let start = corner::State { y: 1.0, aside: 1.0, ..Default::default() };
    let run = |alpha: f64, beta: f64| {
        let system = Corner { m: 0.7, mu: 0.2, alpha, beta, g: 9.81 }.prepare().unwrap();
        system
            .simulate(&start, 0.0..0.1)
            .map(|motion| motion.end().aside)
            .map_err(|failed| failed.error.cause)
    };
    let found = run(0.5, 0.3).unwrap_err();
    assert!(matches!(found, HybridCause::Undetermined { .. }), "{found:?}");
    // Walls that press alike leave one load.
    let load = 0.7 * 9.81 + 5.0 * 0.5_f64.tan();
    assert!((run(0.5, 0.5).unwrap() - (1.0 - 0.1 * 0.2 * load / 0.7)).abs() < 1e-9);
}

/// The friction along `x + 3 z` changes the reaction of `z` by three times itself: with a coefficient of a half there are two motions or none.
#[test]
fn friction_that_takes_more_of_its_load_than_there_is_ends_the_run() {
    let run = |mu: f64, u: f64| {
        let system = Coupled {
            a: 1.0,
            b: 1.0,
            c: 1.0,
            ab: 0.0,
            ac: 0.0,
            bc: 0.0,
            l1: 0.0,
            l2: 0.0,
            l3: 1.0,
            d1: 1.0,
            d2: 0.0,
            d3: 3.0,
            e1: 0.0,
            e2: 1.0,
            e3: 0.0,
            f1: 0.0,
            f2: 0.0,
            f3: 1.0,
            mu,
            nu: 0.0,
        };
        let start = coupled::State { u, ..Default::default() };
        let motion = system.prepare().unwrap().simulate(&start, 0.0..0.01);
        motion.map(|motion| motion.end().u).map_err(|failed| failed.error.cause)
    };
    for u in [1.0, -1.0] {
        assert_eq!(run(0.5, u), Err(HybridCause::Inconsistent));
        // f = |1 - 0.9 sign(u) f|.
        let load = if u > 0.0 { 1.0 / 1.9 } else { 10.0 };
        let found = run(0.3, u).unwrap();
        assert!((found - (u - 0.01 * 0.3 * load * u)).abs() < 1e-9, "{found}");
    }
}
