//! Resets of scenes: a scene jumps where the whole system does, to the same values.

use guen::hybrid::{HybridCause, HybridSystem, HybridTrajectory, TransitionKind};
use guen::prelude::*;

use crate::drawn::drawn;
use crate::resets::Counter;

/// Compares the resets of a scene with those of its system, bit by bit, at drawn states: their functions, their new values and the rates.
fn compare_bits<
    W,
    L,
    X,
    Y,
    const N: usize,
    const M: usize,
    const R: usize,
    const C: usize,
    const S: usize,
    const T: usize,
>(
    (whole, scene): (&W, &L),
    restricted: impl Fn(&X) -> Y,
    resets: &[&str],
) where
    W: HybridSystem<N, R, C, S>,
    L: HybridSystem<M, R, C, T>,
    X: From<[f64; N]> + Into<[f64; N]> + Copy,
    Y: Into<[f64; M]>,
{
    let place = |of: &[guen::hybrid::Signal], name: &str| of.iter().position(|signal| signal.name == name);
    let signals: Vec<&str> = L::SIGNALS.iter().filter(|signal| !signal.is_switch()).map(|s| s.name).collect();
    assert_eq!(signals, resets);
    let mut seed = 11;
    for _ in 0..100 {
        let state: [f64; N] = core::array::from_fn(|_| 4.0 * drawn(&mut seed) - 2.0);
        let t = drawn(&mut seed);
        let (full, own) = (X::from(state), |state: [f64; N]| restricted(&X::from(state)).into());
        let small: [f64; M] = restricted(&full).into();
        let values: [f64; S] = core::array::from_fn(|s| if s % 2 == 0 { 1.0 } else { 0.0 });
        let held: [f64; T] =
            core::array::from_fn(|s| values[place(&W::SIGNALS, L::SIGNALS[s].name).unwrap()]);
        let (functions, expected) = (scene.signals(t, &small), whole.signals(t, &state));
        for (s, signal) in L::SIGNALS.iter().enumerate() {
            let of_whole = place(&W::SIGNALS, signal.name).unwrap();
            assert_eq!(*signal, W::SIGNALS[of_whole]);
            assert_eq!(functions[s].to_bits(), expected[of_whole].to_bits(), "{}", signal.name);
            if !signal.is_switch() {
                let found = scene.reset(s, t, &small, &held);
                let expected: [f64; M] = own(whole.reset(of_whole, t, &state, &values));
                assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits), "{}", signal.name);
            }
        }
        let (rates, expected) =
            (scene.free_rates(t, &small, &held), own(whole.free_rates(t, &state, &values)));
        assert_eq!(rates.map(f64::to_bits), expected.map(f64::to_bits));
    }
}

/// The times of the resets of these names in a run, in order, with the names.
fn resets_of<H, X, const N: usize, const W: usize, const C: usize, const S: usize>(
    motion: &HybridTrajectory<H, X, N, W, C, S>,
    names: &[&str],
) -> Vec<(f64, &'static str)>
where
    H: HybridSystem<N, W, C, S> + Clone,
    X: Copy + From<[f64; N]> + Into<[f64; N]>,
{
    let told = motion.transitions().iter().filter_map(|tr| Some((tr.t, H::SIGNALS[tr.signal?].name)));
    told.filter(|(_, name)| names.contains(name)).collect()
}

/// Whether two runs have the same resets at the same times.
fn assert_resets(found: &[(f64, &str)], expected: &[(f64, &str)], least: usize) {
    assert!(found.len() == expected.len() && found.len() >= least, "{found:?} {expected:?}");
    for (own, whole) in found.iter().zip(expected) {
        assert!(own.1 == whole.1 && (own.0 - whole.0).abs() < 1e-11, "{found:?} {expected:?}");
    }
}

mechanical_system! {
    /// Two sliders on springs: one between walls that count, one whose spring stiffens with every tick of a clock.
    pub system Apart {
        constants { m > 0 = 2, k > 0 = 3, e = 3/4, period > 0 = 2/5, kick = 1/2 }
        inputs { push }
        coordinates { x, y }
        parameters { v = dot(x); w = dot(y); }
        kinetic_energy = m/2*(v^2 + w^2);
        states { dot(clock) = 1; dot(hits) = 0; dot(gain) = 0; dot(watch) = x^2; dot(late) = sin(clock); }
        switches { far: y - 3/10; }
        forces { -k*x + push along v; -k*(1 + gain)*y along w; }
        resets {
            wall: x + 1/2 falls, v = -e*v, hits = hits + 1;
            tick: clock - period rises, clock = 0, gain = gain/2 + far + push/4;
            kicked: y falls, w = w + kick, watch = 0;
        }
        outputs { seen = x + y; }
        scene Left { track x; }
        scene Counted { track hits; }
        scene Right { track y; }
        scene Clock { track clock; }
        scene Both { track watch; provide seen; }
        scene Late { track late; }
        scene Stiff { fix k = 5; track y; }
    }
}

mechanical_system! {
    /// `Apart` without resets.
    pub system Smooth {
        constants { m > 0 = 2, k > 0 = 3 }
        coordinates { x, y }
        parameters { v = dot(x); w = dot(y); }
        kinetic_energy = m/2*(v^2 + w^2);
        states { dot(clock) = 1; }
        forces { -k*x along v; -k*y along w; }
        scene Left { track x; }
    }
}

mechanical_system! {
    /// `Apart` with a reset that changes the other slider alone.
    pub system Beside {
        constants { m > 0 = 2, k > 0 = 3 }
        coordinates { x, y }
        parameters { v = dot(x); w = dot(y); }
        kinetic_energy = m/2*(v^2 + w^2);
        states { dot(clock) = 1; }
        forces { -k*x along v; -k*y along w; }
        resets { tick: clock - 1 rises, clock = 0, w = w + x; }
        scene Left { track x; }
    }
}

fn apart() -> (apart::Driven<f64>, apart::Inputs, apart::State<f64>) {
    let inputs = apart::Inputs { push: 0.2 };
    let start = apart::State { x: 0.7, v: 0.3, y: 0.4, w: -0.2, ..Default::default() };
    (Apart::default().prepare().unwrap().driven(inputs), inputs, start)
}

/// Each scene has the resets of what it keeps, and jumps as the system does.
#[test]
fn a_scene_jumps_where_the_system_does() {
    let (whole, inputs, start) = apart();
    let expected = whole.simulation(&start).tolerance(1e-12).run(0.0..4.0).unwrap();
    macro_rules! compare {
        ($Scene:ident $scene:ident [$($name:ident)*] [$($reset:literal)*] $least:literal) => {
            assert_eq!(apart::$scene::State::<f64>::NAMES, [$(stringify!($name)),*]);
            let scene = apart::$Scene::from(Apart::default()).prepare().unwrap().driven(inputs.into());
            let resets = [$($reset),*];
            compare_bits((&whole, &scene), |x: &apart::State<f64>| apart::$scene::State::from(x), &resets);
            let found = scene.simulation(&start.into()).tolerance(1e-12).run(0.0..4.0).unwrap();
            assert_resets(&resets_of(&found, &resets), &resets_of(&expected, &resets), $least);
            for t in [0.3, 1.1, 2.9, 4.0] {
                let (own, whole) = (found.at(t), expected.at(t));
                $(assert!((own.$name - whole.$name).abs() < 1e-10, "{} at {t}: {own:?} {whole:?}", stringify!($name));)*
            }
        };
    }
    compare!(Left left [x v] ["wall"] 1);
    compare!(Counted counted [x v hits] ["wall"] 1);
    compare!(Right right [y w clock gain] ["tick" "kicked"] 10);
    compare!(Both both [x y v w clock gain watch] ["wall" "tick" "kicked"] 11);
    let clock = apart::Clock::from(Apart::default()).prepare().unwrap();
    compare_bits((&whole, &clock), |x: &apart::State<f64>| apart::clock::State::from(x), &["tick"]);
    let late = apart::Late::from(Apart::default()).prepare().unwrap();
    compare_bits((&whole, &late), |x: &apart::State<f64>| apart::late::State::from(x), &["tick"]);
    let found = late.simulation(&start.into()).tolerance(1e-12).run(0.0..4.0).unwrap();
    assert_resets(&resets_of(&found, &["tick"]), &resets_of(&expected, &["tick"]), 9);
    assert!((found.end().late - expected.end().late).abs() < 1e-11);
}

/// Constants that a scene fixes are fixed in its resets, too.
#[test]
fn resets_have_the_constants_that_a_scene_fixes() {
    let (_, inputs, start) = apart();
    let constants = Apart { k: 5.0, ..Default::default() };
    let whole = constants.prepare().unwrap().driven(inputs);
    let stiff = apart::Stiff::try_from(constants).unwrap().prepare().unwrap().driven(inputs.into());
    let found = stiff.simulation(&start.into()).tolerance(1e-12).run(0.0..4.0).unwrap();
    let expected = whole.simulation(&start).tolerance(1e-12).run(0.0..4.0).unwrap();
    let names = ["tick", "kicked"];
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 10);
    assert!((found.end().w - expected.end().w).abs() < 1e-10);
}

/// A scene that has none of the resets is a smooth system, with the same operations as without them.
#[test]
fn a_scene_without_its_resets_is_smooth() {
    assert_eq!(beside::left::COST, smooth::left::COST);
    let left = beside::Left::default().prepare().unwrap();
    let by_hand = smooth::Left::default().prepare().unwrap();
    let start = beside::left::State { x: 0.4, v: -0.3 };
    // A smooth run has the trajectory of smooth runs.
    let motion: guen::Trajectory<_, 2, f64> = left.simulate(&start, 0.0..2.5).unwrap();
    let expected: guen::Trajectory<_, 2, f64> =
        by_hand.simulate(&smooth::left::State { x: 0.4, v: -0.3 }, 0.0..2.5).unwrap();
    let (end, same) = (motion.end(), expected.end());
    assert_eq!([end.x, end.v].map(f64::to_bits), [same.x, same.v].map(f64::to_bits));
}

mechanical_system! {
    /// Two carts: where the second overtakes the first, the first takes its speed and a light goes on that slows the second.
    pub system Carts {
        constants { c = 1/4 }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y); w = dot(z); }
        kinetic_energy = 1/2*(u^2 + v^2 + w^2);
        states { dot(light) = -c*light; dot(meetings) = 0; }
        forces { -light*v along v; -c*w along w; }
        resets {
            meets: y - x rises, u = 2*v, light = abs(light) + 1, meetings = meetings + 1, z = x, w = 0;
            other: z - 5 rises, w = -w;
        }
        scene First { track x; }
        scene Second { track v; }
        scene Third { track z; }
    }
}

/// A reset that reads another body keeps that body, and what it gives to others leaves.
#[test]
fn a_reset_keeps_what_it_reads() {
    let whole = Carts::default().prepare().unwrap();
    let start = carts::State { x: 1.0, u: 0.2, y: 0.0, v: 1.0, z: 4.0, w: 2.0, ..Default::default() };
    let expected = whole.simulation(&start).tolerance(1e-12).run(0.0..6.0).unwrap();
    assert_eq!(carts::first::State::<f64>::NAMES, ["x", "y", "u", "v", "light"]);
    assert_eq!(carts::second::State::<f64>::NAMES, ["x", "y", "u", "v", "light"]);
    assert_eq!(carts::third::State::<f64>::NAMES, ["x", "y", "z", "u", "v", "w", "light"]);
    let first = carts::First::from(Carts::default()).prepare().unwrap();
    compare_bits((&whole, &first), |x: &carts::State<f64>| carts::first::State::from(x), &["meets"]);
    let third = carts::Third::from(Carts::default()).prepare().unwrap();
    compare_bits((&whole, &third), |x: &carts::State<f64>| carts::third::State::from(x), &["meets", "other"]);
    let found = first.simulation(&start.into()).tolerance(1e-12).run(0.0..6.0).unwrap();
    assert_resets(&resets_of(&found, &["meets"]), &resets_of(&expected, &["meets"]), 1);
    let (own, of_whole) = (found.end(), expected.end());
    assert!((own.x - of_whole.x).abs() < 1e-10 && (own.light - of_whole.light).abs() < 1e-11, "{own:?}");
    let found = third.simulation(&start.into()).tolerance(1e-12).run(0.0..6.0).unwrap();
    let names = ["meets", "other"];
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 2);
    assert!((found.end().z - expected.end().z).abs() < 1e-10);
}

mechanical_system! {
    /// A ball on a floor under a racket, with a clock that pushes it along, and a lamp.
    pub system Ball {
        constants { m > 0 = 1/2, g = 9.81, mu >= 0 = 1/5, e in 0..1 = 1/2, up = 3, height = 1/2, period > 0 = 7/10 }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = m/2*(u^2 + w^2);
        potential_energy = m*g*z;
        states { dot(clock) = 1; dot(lamp) = 0; }
        switches { ahead: x - 1; }
        forces { -m*ahead*u along u; }
        contacts { floor: gap = z, slip = u, friction = mu, restitution = e; }
        resets {
            racket: z - height falls, w = up;
            push: clock - period rises, clock = 0, u = u + 1 + ahead;
            lamps: x - 2 rises, lamp = 1;
        }
        outputs { force = reaction(floor); }
        scene Along { modes { floor: stick, slip; } track u; }
        scene Sliding { modes { floor: slip+; } track u; provide force; }
        scene Flying { modes { floor: open; } track w; }
        scene All { track z; }
        scene Lit { modes { floor: open; } track clock; }
    }
}

/// Contacts, switches and resets of one scene: in all modes, in some and in one.
#[test]
fn scenes_in_modes_jump_as_the_system_does() {
    let whole = Ball::default().prepare().unwrap();
    assert_eq!(ball::all::State::<f64>::NAMES, ["x", "z", "u", "w", "clock"]);
    assert_eq!(ball::all::MODES, ball::MODES);
    assert_eq!(ball::sliding::MODES.len(), 1);
    let start = ball::State { z: 0.7, u: 0.5, ..Default::default() };
    let all = ball::All::from(Ball::default()).prepare().unwrap();
    let names = ["racket", "push"];
    compare_bits((&whole, &all), |x: &ball::State<f64>| ball::all::State::from(x), &names);
    let expected = whole.simulation(&start).tolerance(1e-12).run(0.0..3.0).unwrap();
    let found = all.simulation(&start.into()).tolerance(1e-12).run(0.0..3.0).unwrap();
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 6);
    assert_eq!(resets_of(&expected, &["lamps"]).len(), 1);
    assert!(
        (found.end().x - expected.end().x).abs() < 1e-10 && (found.end().z - expected.end().z).abs() < 1e-10
    );
    // On the floor, with sticks and slips.
    let start = ball::State { u: 0.3, ..Default::default() };
    let expected = whole.simulation(&start).tolerance(1e-12).run(0.0..3.0).unwrap();
    let along = ball::Along::from(Ball::default()).prepare().unwrap();
    let found = along.simulation(&start.into()).tolerance(1e-12).run(0.0..3.0).unwrap();
    assert!(found.transitions().iter().any(|tr| tr.kind == TransitionKind::Sticks));
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 4);
    for t in [0.5, 0.9, 2.2, 3.0] {
        assert!((found.at(t).u - expected.at(t).u).abs() < 1e-10, "{t}");
    }
    // A scene in one mode goes on until the system would leave the mode.
    let sliding = ball::Sliding::from(Ball::default()).prepare().unwrap();
    let start = ball::State { u: 2.0, ..Default::default() };
    let found = sliding.simulate(&start.into(), 0.0..1.0).unwrap();
    let expected = whole.simulate(&start, 0.0..1.0).unwrap();
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 1);
    assert!((found.end().u - expected.end().u).abs() < 1e-8);
    assert!((found.reactions_at(1.0)[0] - 0.5 * 9.81).abs() < 1e-12);
    let slow = ball::State { u: 0.3, ..Default::default() };
    let error = sliding.simulate(&slow.into(), 0.0..1.5).unwrap_err().error;
    assert!(matches!(error.cause, HybridCause::Excluded { .. }), "{error}");
    assert!((error.t - 0.3 / (0.2 * 9.81)).abs() < 1e-9, "{error}");
    // In flight it meets the racket, whose throw stays in the mode.
    let flying = ball::Flying::from(Ball::default()).prepare().unwrap();
    let high = ball::State { z: 0.7, ..Default::default() };
    let found = flying.simulate(&high.into(), 0.0..2.0).unwrap();
    let expected = whole.simulate(&high, 0.0..2.0).unwrap();
    assert_resets(&resets_of(&found, &["racket"]), &resets_of(&expected, &["racket"]), 3);
    assert!((found.end().w - expected.end().w).abs() < 1e-8);
}

mechanical_system! {
    /// A lift that a clock raises off the floor on which it stands.
    pub system Lift {
        constants { g = 9.81, rise = 1/10, speed = 2 }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = 1/2*(u^2 + w^2);
        potential_energy = g*z;
        states { dot(clock) = 1; }
        contacts { floor: gap = z; wall: gap = 5 - x; }
        resets { jump: clock - 1 rises, w = speed; raise: clock - 2 rises, z = z + rise; }
        scene Standing { modes { floor: closed; } track u; }
        scene Here { modes { floor: closed; wall: open; } track u; }
    }
}

/// A reset moves the gap of a contact that a scene never opens: the scene ends there, as it does where the motion lifts off.
#[test]
fn a_reset_that_opens_a_closed_gap_ends_the_scene() {
    let start = lift::State { u: 0.5, ..Default::default() };
    for (speed, t) in [(2.0, 1.0), (0.0, 2.0)] {
        let constants = Lift { speed, ..Default::default() };
        let standing = lift::Standing::from(constants).prepare().unwrap();
        let here = lift::Here::from(constants).prepare().unwrap();
        let ends = [
            standing.simulate(&start.into(), 0.0..3.0).unwrap_err().error.to_string(),
            here.simulate(&start.into(), 0.0..3.0).unwrap_err().error.to_string(),
        ];
        let [first, second] = [
            standing.simulate(&start.into(), 0.0..3.0).unwrap_err().error,
            here.simulate(&start.into(), 0.0..3.0).unwrap_err().error,
        ]
        .map(|error| (error.t, error.cause));
        for (at, cause) in [first, second] {
            assert!((at - t).abs() < 1e-9, "{ends:?}");
            match speed == 0.0 {
                true => assert_eq!(cause, HybridCause::BrokenByReset { contact: "floor" }),
                false => assert!(matches!(cause, HybridCause::Excluded { .. }), "{ends:?}"),
            }
        }
        let constants = Lift { speed: 0.0, rise: 0.0, ..constants };
        let standing = lift::Standing::from(constants).prepare().unwrap();
        assert_eq!(
            resets_of(&standing.simulate(&start.into(), 0.0..3.0).unwrap(), &["jump", "raise"]).len(),
            2
        );
    }
}

mechanical_system! {
    /// Two counters and a loop of sliders between walls, each with a tally.
    system Counted {
        count n = 3;
        constants { width = 1 }
        coordinates { q[n] }
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        kinetic_energy = 1/2*sum(i in 0..n: w[i]^2);
        states { for i in 0..n { dot(tally[i]) = 0; } }
        use Counter as left { turned: 1/10 }
        use Counter as right { turned: left.spin/20 }
        resets {
            for i in 0..n {
                right_end[i]: q[i] - width rises, w[i] = -w[i], tally[i] = tally[i] + 1;
                left_end[i]: q[i] + width falls, w[i] = -w[i];
            }
            both: left.angle + q[1] - 3/2 rises, left.spin = left.spin/2, w[2] = w[2]/2;
        }
        scene Port { track left; }
        scene Starboard { track right.angle; }
        scene First { track q[0], tally[0]; }
        scene Some { for i in 1..n { track w[i]; } }
    }
}

/// Resets of instances and of loops are those of the scenes that keep what they change.
#[test]
fn instances_and_loops_have_resets_in_scenes() {
    let whole = Counted::default().prepare().unwrap();
    let mut start = counted::State { w: [1.0, -2.0, 0.25], ..Default::default() };
    (start.left.spin, start.right.spin) = (1.6, 0.4);
    let expected = whole.simulation(&start).tolerance(1e-12).run(0.0..4.0).unwrap();
    let first = counted::First::from(Counted::default()).prepare().unwrap();
    let names = ["right_end[0]", "left_end[0]"];
    compare_bits((&whole, &first), |x: &counted::State<f64>| counted::first::State::from(x), &names);
    let found = first.simulation(&start.into()).tolerance(1e-12).run(0.0..4.0).unwrap();
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 2);
    assert_eq!(<[f64; 3]>::from(found.end())[2], expected.end().tally[0]);
    let left = counted::Port::from(Counted::default()).prepare().unwrap();
    let names = ["left.around", "right_end[1]", "left_end[1]", "both"];
    let found = left.simulation(&start.into()).tolerance(1e-12).run(0.0..4.0).unwrap();
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 6);
    let (own, of_whole) = (found.end().left, expected.end().left);
    assert!(
        (own.angle - of_whole.angle).abs() < 1e-10 && own.turns == of_whole.turns,
        "{own:?} {of_whole:?}"
    );
    let right = counted::Starboard::from(Counted::default()).prepare().unwrap();
    let found = right.simulation(&start.into()).tolerance(1e-12).run(0.0..4.0).unwrap();
    let names = ["right.around", "left.around", "both"];
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 4);
    assert!((found.end().right.angle - expected.end().right.angle).abs() < 1e-10);
    let some = counted::Some::from(Counted::default()).prepare().unwrap();
    let found = some.simulation(&start.into()).tolerance(1e-12).run(0.0..4.0).unwrap();
    let names = ["right_end[1]", "left_end[1]", "right_end[2]", "left_end[2]", "both", "left.around"];
    assert_resets(&resets_of(&found, &names), &resets_of(&expected, &names), 5);
}

mechanical_system! {
    /// A bead on a ring, and a slider: a reset of the bead keeps the ring, or does not.
    pub system Ring {
        constants { r > 0 = 2, to = 0 }
        coordinates { x, y, s }
        parameters { spin = inner(vec(-y, x), vec(dot(x), dot(y))); v = dot(s); }
        holonomic { ring: x^2 + y^2 - r^2 = 0; }
        kinetic_energy = 1/2*(dot(x)^2 + dot(y)^2 + v^2);
        resets { jump: t - 1 rises, x = -y + to, y = x; back: s - 1 rises, v = -v; }
        scene Bead { track x; }
        scene Slider { track s; }
    }
}

/// A scene sees whether a reset breaks the equations on positions.
#[test]
fn a_reset_that_breaks_a_constraint_ends_the_scene() {
    assert_eq!(ring::bead::State::<f64>::NAMES, ["x", "y", "spin"]);
    assert_eq!(ring::slider::State::<f64>::NAMES, ["s", "v"]);
    let start = ring::State { x: 2.0, spin: 0.5, v: 1.0, ..Default::default() };
    let run = |to: f64| {
        let bead = ring::Bead::from(Ring { to, ..Default::default() }).prepare().unwrap();
        bead.simulate(&start.into(), 0.0..2.5)
            .map(|motion| motion.end())
            .map_err(|f| (f.error.t, f.error.cause))
    };
    let angle = std::f64::consts::FRAC_PI_2 + 2.5 * 0.5 / 4.0;
    let end = run(0.0).unwrap();
    assert!((end.x - 2.0 * angle.cos()).abs() < 1e-8 && (end.y - 2.0 * angle.sin()).abs() < 1e-8, "{end:?}");
    assert_eq!(run(1e-3).unwrap_err(), (1.0, HybridCause::ConstraintBrokenByReset));
    let slider = ring::Slider::from(Ring::default()).prepare().unwrap();
    let motion = slider.simulate(&start.into(), 0.0..2.5).unwrap();
    assert!((motion.end().s + 0.5).abs() < 1e-12);
}
