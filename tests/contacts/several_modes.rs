//! Scenes that run through several modes: they move as the whole system does, with fewer variables.

use guen::hybrid::{HybridCause, HybridSystem, TransitionKind};
use guen::mechanical_system;

use crate::declared::{Feet, HoopOnFloor, feet, hoop_on_floor};
use crate::drawn::drawn;

mechanical_system! {
    /// A wheel on a plane: nobody asks where it is.
    pub system Roller {
        constants { m > 0 = 20, a > 0 = 3/10, J > 0 = 1, c >= 0 = 1/2, g = 9.81, mu >= 0 = 2/5, e in 0..1 = 1/3 }
        inputs { torque, lift }
        coordinates { x, z, phi }
        bodies { wheel { mass: m, center: vec(x, z), inertia: diag(0, 0, J), orientation: rot_z(-phi) } }
        gravity = vec(0, -g);
        parameters { ahead = dot(x); up = dot(z); spin = dot(phi); }
        forces { torque along spin; lift along up; -c*ahead along ahead; }
        switches { ice: x - 1; }
        let p = vec(x, z - a);
        contacts {
            tyre: gap = z - a, slip = wheel.velocity_at(p).x, friction = mu, restitution = e;
        }
        outputs { force = reaction(tyre); slippery = ice*ahead; }
        scene Ground { modes { tyre: stick, slip; } track ahead; provide force; }
        scene Air { track z; provide force; }
        scene Iced { modes { tyre: stick, slip; } track ahead; provide slippery; }
        scene Light { fix m = 10, e = 1/2; track z; }
    }
}

fn roller() -> (roller::Driven<f64>, roller::Inputs) {
    let inputs = roller::Inputs { torque: 20.0, lift: 0.0 };
    (Roller::default().prepare().unwrap().driven(inputs), inputs)
}

/// Neither the place nor the height enters what happens on the ground; above it the height does.
#[test]
fn a_scene_of_several_modes_keeps_what_its_modes_need() {
    assert_eq!(roller::ground::State::<f64>::NAMES, ["ahead", "spin"]);
    assert_eq!(roller::air::State::<f64>::NAMES, ["z", "ahead", "up", "spin"]);
    assert_eq!(roller::iced::State::<f64>::NAMES, ["x", "ahead", "spin"]);
    use roller::ground::{MODES, Mode, Tyre};
    let modes = [Tyre::Stick, Tyre::SlipForward, Tyre::SlipBackward].map(|tyre| Mode { tyre });
    assert_eq!(MODES, modes);
    assert_eq!(roller::air::MODES, roller::MODES);
    assert_eq!(MODES.len(), roller::ground::MODE_INFO.len());
}

fn is_of_contacts(kind: TransitionKind) -> bool {
    kind != TransitionKind::Switched
}

/// Compares a run of a scene with one of the system: transitions of contacts, and what the scene keeps.
macro_rules! same_motion {
    ($found:expr, $expected:expr, $times:expr, [$($name:ident)*]) => {
        let (found, expected) = ($found, $expected);
        // Of switches the scene has those that it needs.
        let found_ones: Vec<_> = found.transitions().iter().filter(|own| is_of_contacts(own.kind)).collect();
        let expected_ones: Vec<_> = expected.transitions().iter().filter(|whole| is_of_contacts(whole.kind)).collect();
        assert_eq!(found_ones.len(), expected_ones.len());
        for (own, whole) in found_ones.iter().zip(expected_ones) {
            assert_eq!((own.before, own.after), (whole.before, whole.after));
            assert!((own.t - whole.t).abs() < 1e-12, "{} {}", own.t, whole.t);
        }
        for t in $times {
            let (own, whole) = (found.at(t), expected.at(t));
            $(assert!((own.$name - whole.$name).abs() < 1e-12 * (1.0 + whole.$name.abs()), "{t} {own:?} {whole:?}");)*
        }
    };
}

/// The wheel spins before it rolls: on the ground, where the scene knows neither place nor height, and after a fall.
#[test]
fn a_scene_of_several_modes_moves_as_the_whole_system() {
    let (whole, inputs) = roller();
    let constants = Roller::default();
    let times = [0.1, 0.3, 0.5, 1.5, 2.5];
    let start = roller::State { x: -3.0, z: 0.3, phi: 1.0, ahead: 2.0, up: 0.0, spin: 0.0 };
    let run = |start: &roller::State<f64>| whole.simulation(start).tolerance(1e-12).run(0.0..3.0).unwrap();
    let ground = roller::Ground::from(constants).prepare().unwrap().driven(inputs.into());
    let found = ground.simulation(&start.into()).tolerance(1e-12).run(0.0..3.0).unwrap();
    assert!(found.transitions().iter().any(|transition| transition.kind == TransitionKind::Sticks));
    same_motion!(&found, run(&start), times, [ahead spin]);
    let iced = roller::Iced::from(constants).prepare().unwrap().driven(inputs.into());
    same_motion!(&iced.simulation(&start.into()).tolerance(1e-12).run(0.0..3.0).unwrap(), run(&start), times, [x ahead spin]);
    let high = roller::State { z: 0.8, ..start };
    let air = roller::Air::from(constants).prepare().unwrap().driven(inputs.into());
    let found = air.simulation(&high.into()).tolerance(1e-12).run(0.0..3.0).unwrap();
    assert!(found.transitions().len() > 4);
    same_motion!(&found, run(&high), times, [z ahead up spin]);
    // Reactions too.
    let (own, mode) = (found.at(2.5), found.mode_at(2.5));
    let force = air.outputs_in_mode(mode, 2.5, &own).force;
    let expected = whole.outputs_in_mode(mode, 2.5, &run(&high).at(2.5)).force;
    assert!(force.iter().zip(expected).all(|(own, whole)| (own - whole).abs() < 1e-9) && force[0] > 100.0);
}

/// Constants that a scene fixes are those of its contacts, too.
#[test]
fn fixed_constants_enter_contacts() {
    let constants = Roller { m: 10.0, e: 0.5, ..Roller::default() };
    let inputs = roller::Inputs { torque: 5.0, lift: 10.0 };
    let whole = constants.prepare().unwrap().driven(inputs);
    let light = roller::Light::try_from(constants).unwrap().prepare().unwrap().driven(inputs.into());
    let start = roller::State { z: 0.8, ahead: 1.0, ..Default::default() };
    let found = light.simulation(&start.into()).tolerance(1e-12).run(0.0..3.0).unwrap();
    let expected = whole.simulation(&start).tolerance(1e-12).run(0.0..3.0).unwrap();
    assert!(found.transitions().len() > 4);
    same_motion!(&found, expected, [0.2, 0.6, 2.0], [z ahead up spin]);
}

/// What no mode of a scene allows ends its run: the wheel cannot leave the ground there.
#[test]
fn a_mode_that_a_scene_excludes_ends_its_run() {
    let constants = Roller::default();
    let lifted = roller::Inputs { torque: 1.0, lift: 250.0 };
    let whole = constants.prepare().unwrap().driven(lifted);
    let start = roller::State { z: 0.3, ahead: 1.0, ..Default::default() };
    assert!(whole.simulate(&start, 0.0..1.0).unwrap().end().z > 0.4);
    let ground = roller::Ground::from(constants).prepare().unwrap().driven(lifted.into());
    let error = ground.simulate(&start.into(), 0.0..1.0).unwrap_err().error;
    let open = roller::Mode { tyre: roller::Tyre::Open };
    assert!(
        matches!(error.cause, HybridCause::Excluded { mode } if roller::Mode::from(mode) == open),
        "{error}"
    );
    // What lifts less is carried on the ground.
    let light = roller::Inputs { torque: 1.0, lift: 150.0 };
    let ground = roller::Ground::from(constants).prepare().unwrap().driven(light.into());
    let motion = ground.simulate(&start.into(), 0.0..1.0).unwrap();
    assert!((motion.reactions_at(1.0)[0] - (20.0 * 9.81 - 150.0)).abs() < 1e-9);
}

fn assert_near<const N: usize>(found: [f64; N], expected: [f64; N]) {
    let size = expected.iter().fold(1.0, |most: f64, rate| most.max(rate.abs()));
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12 * size), "{found:?} {expected:?}");
}

/// Where a mode has a program of its own, its rates are those that the common program gives on the constraints.
#[test]
fn rates_of_eliminated_modes_are_those_of_the_common_program() {
    let mut seed = 5;
    let hoop = HoopOnFloor::default();
    let whole = hoop.prepare().unwrap();
    let scene = hoop_on_floor::Bouncing::from(hoop).prepare().unwrap();
    assert_eq!(eliminated(&scene), 1);
    let sticks = hoop_on_floor::Mode { floor: hoop_on_floor::Floor::Stick };
    let (own, common) = (scene.in_mode(sticks), whole.in_mode(sticks));
    for _ in 0..50 {
        let [theta, psi, phi, eta1, eta2, eta3] = core::array::from_fn(|_| 0.2 + drawn(&mut seed));
        let (s, c) = theta.sin_cos();
        let (a, turning) = (hoop.a, eta2 / s);
        let zeta = a * s;
        let u = a * (s * psi.sin() * eta1 - psi.cos() * eta3);
        let v = -a * (s * psi.cos() * eta1 + psi.sin() * eta3);
        let w = a * c * eta1;
        assert!(turning.is_finite());
        let state =
            hoop_on_floor::State { theta, psi, phi, xi: 0.3, eta: 0.1, zeta, eta1, eta2, eta3, u, v, w };
        let full: [f64; 12] = guen::System::rhs(&common, 0.0, &state.into());
        let kept = hoop_on_floor::bouncing::State::from(&state);
        let found = guen::System::rhs(&own, 0.0, &kept.into());
        let expected = hoop_on_floor::bouncing::State::from(hoop_on_floor::State::from(full));
        assert_near(found, expected.into());
    }
    let constants = Roller::default();
    let inputs = roller::Inputs { torque: 7.0, lift: 3.0 };
    let ground = roller::Ground::from(constants).prepare().unwrap().driven(inputs.into());
    assert_eq!(eliminated(&ground), 3);
    let in_mode = |tyre| ground.in_mode(roller::Mode { tyre });
    let rate = guen::System::rhs(&in_mode(roller::Tyre::Stick), 0.0, &[3.0, 10.0]);
    // (m + J/a^2) v' = torque/a - c v.
    let ahead = (7.0 / 0.3 - 0.5 * 3.0) / (20.0 + 1.0 / 0.09);
    assert_near(rate, [ahead, ahead / 0.3]);
    // m v' = -mu N d - c v and J w' = torque + a mu N d with N = m g - lift.
    for (tyre, direction, spin) in
        [(roller::Tyre::SlipForward, 1.0, 8.0), (roller::Tyre::SlipBackward, -1.0, 12.0)]
    {
        let rate = guen::System::rhs(&in_mode(tyre), 0.0, &[3.0, spin]);
        let friction = 0.4 * (20.0 * 9.81 - 3.0) * direction;
        assert_near(rate, [(-friction - 0.5 * 3.0) / 20.0, 7.0 + 0.3 * friction]);
    }
    // Of the feet of a table one alone sticks; where two do nothing moves, and the common program serves.
    let feet = Feet::default();
    let (whole, tipping) = (feet.prepare().unwrap(), feet::Tipping::from(feet).prepare().unwrap());
    assert_eq!((feet::tipping::MODES.len(), eliminated(&tipping)), (3, 2));
    for mode in feet::tipping::MODES {
        let side = match mode.leg {
            [feet::Leg::Stick, _, feet::Leg::Open] => -1.0,
            [feet::Leg::Open, _, feet::Leg::Stick] => 1.0,
            _ => continue,
        };
        let (tilt, omega): (f64, f64) = (0.3, 0.7);
        let (u, w) = (side * tilt.sin() * omega, -side * tilt.cos() * omega);
        let state = feet::State { x: 0.2, z: -side * tilt.sin(), tilt, u, w, omega };
        let expected = feet::State::from(guen::System::rhs(&whole.in_mode(*mode), 0.0, &state.into()));
        let kept = feet::tipping::State::from(&state);
        let found = guen::System::rhs(&tipping.in_mode(*mode), 0.0, &kept.into());
        assert_near(found, feet::tipping::State::from(expected).into());
    }
}

/// The number of modes that have a program of their own.
fn eliminated<H, const N: usize, const W: usize, const C: usize, const S: usize>(_: &H) -> usize
where
    H: HybridSystem<N, W, C, S>,
{
    H::ELIMINATED.len()
}
