//! Resets, against closed forms: a clock, a ball that is thrown back up, a counter of turns, resets that happen at once.

use guen::hybrid::{HybridCause, HybridSystem, TransitionKind};
use guen::prelude::*;

mechanical_system! {
    /// A slider with a clock that starts anew, and gives it a push each time.
    pub system Clocked {
        constants { m > 0 = 2, period > 0 = 1/2, kick = 3 }
        inputs { force }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        states { dot(clock) = 1; dot(count) = 0; }
        forces { force along v; }
        resets { tick: clock - period rises, clock = 0, v = v + kick/m, count = count + 1; }
    }
}

/// A zero at a sample belongs to the run, which goes on there with other inputs.
#[test]
fn resets_whose_zeros_fall_on_samples_happen() {
    let slider = Clocked::default().prepare().unwrap();
    let start = clocked::State { x: 0.25, v: -0.5, ..Default::default() };
    for period in [0.05, 0.1, 0.125, 0.15, 0.25, 0.5] {
        let held =
            slider.simulation(&start).hold(period, |_, _: &clocked::State| clocked::Inputs { force: 0.75 });
        let motion = held.run(0.0..1.75).unwrap();
        let times: Vec<f64> = motion.transitions().iter().map(|tr| tr.t).collect();
        assert_eq!(times.len(), 3, "{period}: {times:?}");
        assert!(times.iter().zip([0.5, 1.0, 1.5]).all(|(t, k)| (t - k).abs() < 1e-12), "{period}: {times:?}");
        let v = -0.5 + 0.375 * 1.75 + 3.0 * 1.5;
        assert!(
            (motion.end().v - v).abs() < 1e-12 && motion.end().count == 3.0,
            "{period}: {:?}",
            motion.end()
        );
    }
}

#[test]
fn a_clock_starts_anew_and_pushes() {
    let slider = Clocked::default().prepare().unwrap();
    let force = 0.75;
    let driven = slider.driven(clocked::Inputs { force });
    let start = clocked::State { x: 0.25, v: -0.5, ..Default::default() };
    let motion = driven.simulate(&start, 0.0..1.75).unwrap();
    let times: Vec<f64> = motion.transitions().iter().map(|tr| tr.t).collect();
    assert_eq!(times.len(), 3);
    for (k, t) in times.iter().enumerate() {
        assert!((t - 0.5 * (k as f64 + 1.0)).abs() < 1e-12, "{times:?}");
        assert_eq!(motion.transitions()[k].kind, TransitionKind::Reset);
        assert_eq!(motion.transitions()[k].signal, Some(0));
    }
    let end = motion.end();
    let a = force / 2.0;
    // Pushes of 3/2 at 1/2, 1 and 3/2.
    let v = -0.5 + a * 1.75 + 3.0 * 1.5;
    let x = 0.25 - 0.5 * 1.75 + a * 1.75 * 1.75 / 2.0 + 1.5 * (1.25 + 0.75 + 0.25);
    assert!((end.v - v).abs() < 1e-12 && (end.x - x).abs() < 1e-12, "{end:?}");
    assert!((end.clock - 0.25).abs() < 1e-12 && end.count == 3.0, "{end:?}");
}

#[test]
fn the_functions_that_stay_where_they_are_fire_once() {
    mechanical_system! {
        system Alarm {
            constants { when = 1 }
            coordinates { x }
            parameters { v = dot(x); }
            kinetic_energy = v^2/2;
            resets {
                // Nothing changes the function: it stays zero behind the reset, and goes on.
                rings: t - when rises, v = v + 1;
                // It touches zero from below, and is thrown back.
                walls: x - 2 rises, v = -v;
                // It is positive from the beginning and never falls.
                never: t + 1 falls, v = 100;
            }
        }
    }
    let alarm = Alarm::default().prepare().unwrap();
    let motion = alarm.simulate(&alarm::State::default(), 0.0..4.0).unwrap();
    let told: Vec<(f64, Option<usize>)> = motion.transitions().iter().map(|tr| (tr.t, tr.signal)).collect();
    assert_eq!(told, [(1.0, Some(0)), (3.0, Some(1))]);
    assert!((motion.end().x - 1.0).abs() < 1e-12 && motion.end().v == -1.0);
    // A run that begins on a zero has it behind it.
    let start = alarm::State { x: 2.0, v: 0.5 };
    let motion = alarm.simulate(&start, 1.0..2.0).unwrap();
    assert!(motion.transitions().is_empty() && motion.end().x == 2.5);
    // One that comes back to the zero on which it begins is reset there.
    let start = alarm::State { x: 2.0, v: -0.5 };
    let motion = alarm.simulate(&start, 0.0..4.0).unwrap();
    assert_eq!(motion.transitions().len(), 2);
    assert!((motion.transitions()[1].t - 2.0).abs() < 1e-12 && (motion.end().x - 1.0).abs() < 1e-12);
}

mechanical_system! {
    /// A ball that a racket throws up with the same speed, above a floor that it never reaches, and beside a wall.
    pub system Racket {
        constants { m > 0 = 0.3, up = 5, height = 1, g = 10, e in 0..1 = 1/2 }
        coordinates { z, y }
        parameters { v = dot(z); w = dot(y); }
        particles { m at vec(y, z); }
        gravity = vec(0, -g);
        contacts { floor: gap = z, restitution = e; wall: gap = y; }
        resets { racket: z - height falls, v = up; }
        modes { wall: open; }
    }
}

#[test]
fn a_ball_is_thrown_back_up() {
    let ball = Racket::default().prepare().unwrap();
    let start = racket::State { z: 1.0, v: 5.0, y: 1.0, w: 0.5 };
    let motion = ball.simulate(&start, 0.0..4.5).unwrap();
    let times: Vec<f64> = motion.transitions().iter().map(|tr| tr.t).collect();
    assert_eq!(times.len(), 4, "{times:?}");
    for (k, t) in times.iter().enumerate() {
        assert!((t - (k as f64 + 1.0)).abs() < 1e-11, "{times:?}");
        let tr = &motion.transitions()[k];
        // The state before, [z, y, v, w], and the one behind it.
        assert!(tr.kind == TransitionKind::Reset && (tr.state_before[2] + 5.0).abs() < 1e-11);
        assert_eq!(tr.state_after[2..], [5.0, 0.5]);
    }
    // Below the racket it meets the floor as any ball does.
    let low = racket::State { z: 0.5, v: 0.0, y: 1.0, w: 0.0 };
    let motion = ball.simulate(&low, 0.0..0.5).unwrap();
    assert_eq!(motion.transitions()[0].kind, TransitionKind::Impact);
}

mechanical_system! {
    /// Three variables that two resets exchange at the same time: each sees the state before both.
    pub system Exchange {
        coordinates { a, b, c }
        kinetic_energy = 1/2*(dot(a)^2 + dot(b)^2 + dot(c)^2);
        resets {
            first: t - 1 rises, a = b;
            second: 1 - t falls, b = a, c = c + 1;
        }
    }
}

mechanical_system! {
    /// The same in the other order.
    pub system Turned {
        coordinates { a, b, c }
        kinetic_energy = 1/2*(dot(a)^2 + dot(b)^2 + dot(c)^2);
        resets {
            second: 1 - t falls, c = c + 1, b = a;
            first: t - 1 rises, a = b;
        }
    }
}

#[test]
fn resets_at_once_see_the_state_before() {
    let start = exchange::State { a: 1.0, b: 2.0, c: 3.0, ..Default::default() };
    let there = Exchange::default().prepare().unwrap().simulate(&start, 0.0..2.0).unwrap();
    assert_eq!(there.transitions().len(), 1);
    let end = there.end();
    assert_eq!((end.a, end.b, end.c), (2.0, 1.0, 4.0));
    let start = turned::State { a: 1.0, b: 2.0, c: 3.0, ..Default::default() };
    let back = Turned::default().prepare().unwrap().simulate(&start, 0.0..2.0).unwrap();
    assert_eq!((back.end().a, back.end().b, back.end().c), (2.0, 1.0, 4.0));
}

mechanical_system! {
    pub system Contradiction {
        coordinates { x }
        kinetic_energy = 1/2*dot(x)^2;
        resets { one: t - 1 rises, x = 1; other: t - 1 rises, x = 2; }
    }
}

#[test]
fn resets_that_contradict_each_other_end_the_run() {
    let system = Contradiction::default().prepare().unwrap();
    let failed = system.simulate(&contradiction::State { x: 0.5, ..Default::default() }, 0.0..2.0);
    let error = failed.unwrap_err().error;
    assert_eq!(error.cause, HybridCause::ContradictingResets { resets: ["one", "other"] });
    assert_eq!(error.t, 1.0);
    assert!(error.to_string().contains("`one` and `other`"), "{error}");
}

mechanical_system! {
    /// A bead on a ring under `holonomic`, and a block on the floor.
    pub system Kept {
        constants { r > 0 = 2, g = 9.81, to = 0, lift = 0 }
        coordinates { x, y, z }
        parameters { spin = inner(vec(-y, x), vec(dot(x), dot(y))); v = dot(z); }
        holonomic { ring: x^2 + y^2 - r^2 = 0; }
        kinetic_energy = 1/2*(dot(x)^2 + dot(y)^2 + v^2);
        potential_energy = g*z;
        contacts { floor: gap = z; }
        resets {
            // A quarter of a turn further on keeps the ring, where `to` is zero.
            jump: t - 1 rises, x = -y + to, y = x;
            raise: t - 2 rises, z = z + lift, v = 1;
        }
    }
}

#[test]
fn resets_keep_constraints_and_closed_contacts() {
    let start = kept::State { x: 2.0, spin: 0.5, ..Default::default() };
    let run = |to: f64, lift: f64| {
        let constants = Kept { to, lift, ..Default::default() };
        let motion = constants.prepare().unwrap().simulate(&start, 0.0..2.5);
        motion.map(|motion| motion.end()).map_err(|failed| (failed.error.t, failed.error.cause))
    };
    let end = run(0.0, 0.0).unwrap();
    // The angle grows by 0.5/r^2 in a unit of time, and by a quarter of a turn.
    let angle = std::f64::consts::FRAC_PI_2 + 2.5 * 0.5 / 4.0;
    assert!((end.x - 2.0 * angle.cos()).abs() < 1e-8 && (end.y - 2.0 * angle.sin()).abs() < 1e-8, "{end:?}");
    // Thrown up at 2, without leaving the floor in the reset itself.
    assert!((end.z - (0.5 - 9.81 / 8.0)).abs() < 1e-9 || end.z.abs() < 1e-9, "{end:?}");
    assert_eq!(run(1e-3, 0.0).unwrap_err(), (1.0, HybridCause::ConstraintBrokenByReset));
    assert_eq!(run(0.0, 1e-3).unwrap_err(), (2.0, HybridCause::BrokenByReset { contact: "floor" }));
}

mechanical_system! {
    /// Two carts on a rail, of which a latch couples the one on a spring to the heavier one. A clock kicks the former, with the latch or after
    /// it has set the latch free.
    system Coupled {
        constants { m > 0 = 1, k > 0 = 4, kick = 3, frees = 0 }
        coordinates { x, y }
        particles { m at vec(x, 0); 2*m at vec(y, 0); }
        parameters { v = dot(x); w = dot(y); }
        potential_energy = k/2*x^2;
        states { dot(clock) = 1; dot(open) = 0; }
        contacts { bolt: latch = x - y, release = open - 1/2; }
        resets { push: clock - 1 rises, v = kick, open = frees, clock = -100; }
    }
}

/// A locked latch takes its part of a velocity that a reset gives, as it does in an impact: the carts go on together. One that the same reset
/// sets free holds nothing.
#[test]
fn locked_latches_carry_the_kicks_of_resets() {
    let start = coupled::State { x: 0.5, v: -1.0, ..Default::default() };
    // On the spring alone the cart comes to the other one after an eighth of pi, with the root of two; then both swing.
    let (locked, after) = (std::f64::consts::FRAC_PI_8, 2.0 / 3.0_f64.sqrt());
    let swing = |x: f64, v: f64, rate: f64, t: f64| {
        let (sin, cos) = (rate * t).sin_cos();
        [x * cos + v / rate * sin, v * cos - x * rate * sin]
    };
    let [x, v] = swing(0.0, -(2.0_f64.sqrt()) / 3.0, after, 1.0 - locked);
    for frees in [0.0, 1.0] {
        let carts = Coupled { frees, ..Default::default() }.prepare().unwrap();
        let motion = carts.simulation(&start).tolerance(1e-12).run(0.0..2.5).unwrap();
        let reset = &motion.transitions()[1];
        assert_eq!((reset.kind, reset.elements), (TransitionKind::Reset, [true]));
        assert_eq!(reset.after.bolt == coupled::Bolt::Free, frees == 1.0);
        let end = motion.end();
        let together = (3.0 + 2.0 * v) / 3.0;
        let [[x, dx], [y, dy]] = match frees {
            0.0 => [swing(x, together, after, 1.5); 2],
            _ => [swing(x, 3.0, 2.0, 1.5), [x + 1.5 * v, v]],
        };
        let impulse = if frees == 0.0 { together - 3.0 } else { 0.0 };
        assert!((reset.impulses[0] - impulse).abs() < 1e-9, "{frees}: {:?}", reset.impulses);
        assert!((end.x - x).abs() < 1e-9 && (end.v - dx).abs() < 1e-9, "{frees}: {end:?} {x} {dx}");
        assert!((end.y - y).abs() < 1e-9 && (end.w - dy).abs() < 1e-9, "{frees}: {end:?} {y} {dy}");
    }
}

mechanical_system! {
    /// A ball that counts where it meets the floor.
    system Counting {
        constants { g > 0 = 10, e in 0..1 = 1/2 }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = g*z;
        states { dot(floors) = 0; }
        contacts { floor: gap = z, restitution = e; }
        resets { down: z falls, floors = floors + 1; }
    }
}

/// The function of a reset may be that of a gap: it leaves zero with every bounce, and is back within one step, as a parabola is one step.
#[test]
fn every_bounce_is_counted() {
    for tolerance in [1e-4, 1e-6, 1e-9, 1e-12] {
        for e in [0.5, 0.6, 0.8, 0.9, 1.0] {
            for z in [1.0, 0.7, 0.31, 1e-3, 1e5] {
                let ball = Counting { e, ..Default::default() }.prepare().unwrap();
                let start = counting::State { z, ..Default::default() };
                // Just past the top of the fourth flight.
                let span = f64::sqrt(z / 5.0) * (1.0 + 2.0 * (e + e * e + e * e * e) + 1.1 * e.powi(4));
                let end = ball.simulation(&start).tolerance(tolerance).run(0.0..span).unwrap().end();
                assert_eq!(end.floors, 4.0, "{tolerance} {e} {z}");
            }
        }
    }
}

mechanical_component! {
    /// A wheel that counts its turns and keeps its angle small.
    pub(crate) component Counter(turned: scalar) {
        constants { whole > 0 = 1 }
        coordinates { angle }
        parameters { spin = dot(angle); }
        states { dot(turns) = 0; }
        kinetic_energy = 1/2*spin^2;
        forces { turned along spin; }
        resets { around: angle - whole rises, angle = angle - whole, turns = turns + 1; }
    }
}

mechanical_system! {
    /// Two counters and a loop of sliders that go to and fro.
    system Counted {
        count n = 3;
        constants { width = 1 }
        coordinates { q[n] }
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        kinetic_energy = 1/2*sum(i in 0..n: w[i]^2);
        use Counter as left { turned: 0 }
        use Counter as right { turned: 0 }
        resets {
            for i in 0..n {
                right_end[i]: q[i] - width rises, w[i] = -w[i];
                left_end[i]: q[i] + width falls, w[i] = -w[i];
            }
            both: left.angle + right.angle - 10 rises, left.spin = 0;
        }
    }
}

#[test]
fn components_and_loops_have_resets() {
    let counted = Counted::default().prepare().unwrap();
    let mut start = counted::State { w: [1.0, -2.0, 0.25], ..Default::default() };
    (start.left.spin, start.right.spin) = (1.6, 0.4);
    let motion = counted.simulate(&start, 0.0..4.0).unwrap();
    let end = motion.end();
    assert!((end.left.turns, end.right.turns) == (6.0, 1.0), "{end:?}");
    assert!((end.left.angle - 0.4).abs() < 1e-9 && (end.right.angle - 0.6).abs() < 1e-9, "{end:?}");
    assert_eq!(end.w.map(f64::abs), [1.0, 2.0, 0.25]);
    assert!(end.q.iter().all(|q| q.abs() <= 1.0 + 1e-9), "{end:?}");
    let names: Vec<&str> = <counted::Prepared as HybridSystem<12, 0, 0, 9>>::SIGNALS.map(|s| s.name).to_vec();
    assert!(names.contains(&"left.around") && names.contains(&"left_end[2]"), "{names:?}");
}
