//! The free motion and what forces of contacts do to it, against systems that have these forces as inputs.

use guen::Dual;
use guen::hybrid::{Element, HybridSystem, Kind, Mode as States};

use crate::declared::*;
use crate::drawn::drawn;

#[test]
fn a_ball_above_its_floor() {
    let ball = BouncingBall::default().prepare().unwrap();
    let free = ball.free_motion(0.0, &[2.0, -1.0], &[], &[0.0]);
    assert_eq!((free.rates, free.gaps, free.row_rates), ([-1.0, -9.81], [2.0], [-1.0]));
    assert_eq!((free.biases, free.delassus, free.responses), ([-9.81], [[1.0]], [[0.0, 1.0]]));
    assert_eq!(ball.restitutions(), [0.8]);
}

#[test]
fn the_wheel_of_the_design() {
    let wheel = Wheel::default().prepare().unwrap().driven(wheel::Inputs { torque: 3.0 });
    let state = wheel::State { z: 0.3, speed_ahead: 5.0, spin: 16.0, ..Default::default() };
    for ice in [0.0, 1.0] {
        let free = wheel.free_motion(0.0, &state.into(), &[ice], &[0.2]);
        assert_eq!(free.rates, [5.0, 0.0, 16.0, -2.5 / 20.0, -9.81, 3.0]);
        assert_eq!(free.row_rates, [0.0, 5.0 - 0.3 * 16.0]);
        assert_eq!((free.delassus[0], free.delassus[1][0]), ([0.05, 0.0], 0.0));
        assert!((free.delassus[1][1] - 0.14).abs() < 1e-15);
        assert!((free.friction[0] - (0.8 - 0.7 * ice)).abs() < 1e-15);
    }
    const { assert!(<wheel::Driven as HybridSystem<6, 2, 1, 1>>::PAINLEVE_FREE) };
    assert_eq!(<wheel::Driven as HybridSystem<6, 2, 1, 1>>::ELEMENTS, [Element::rough("tyre", 0, &[1])]);
    assert_eq!(wheel.signals(0.0, &[6.0, 0.3, 0.0, 0.0, 0.0, 0.0]), [3.0]);
    let mode = wheel::Mode { tyre: wheel::Tyre::Stick };
    assert_eq!((mode.to_string().as_str(), wheel::MODES.len()), ("tyre stick", 4));
    assert!(wheel.allows(&States::from(mode)));
    assert_eq!(wheel::Mode::from(States::from(mode)), mode);
}

/// What is known of each mode: its rows, and whether Painlevé's paradox is excluded there.
#[test]
fn modes_tell_their_rows() {
    let rows: Vec<&[&str]> = wheel::MODE_INFO.iter().map(|info| info.rows).collect();
    assert_eq!(rows, [&[][..], &["tyre_n", "tyre_t"], &["tyre_n"], &["tyre_n"]]);
    assert!(wheel::MODE_INFO.iter().all(|info| info.painleve_free && info.cost.total() > 0));
    assert!(wheel::MODE_INFO.iter().map(|info| info.mode).eq(wheel::MODES.iter().copied()));
    // The rod's reaction may have no value where its end slips, and there alone.
    let free: Vec<bool> = painleve_rod::MODE_INFO.iter().map(|info| info.painleve_free).collect();
    assert_eq!(free, [true, true, false, false]);
    // Rows of a grip that sticks and of a latch that is locked.
    let locked =
        walker::MODE_INFO.iter().find(|info| info.mode.to_string().contains("lock locked, brake stick"));
    let rows = locked.unwrap().rows;
    assert!(rows.ends_with(&["lock_n", "brake_t"]), "{rows:?}");
}

#[test]
fn kinds_follow_from_what_is_declared() {
    let kind = |element: Element| (element.kind, element.tangential.len());
    assert_eq!(<two_balls::Prepared as HybridSystem<4, 2, 2, 0>>::ELEMENTS.map(kind), [(Kind::Smooth, 0); 2]);
    assert_eq!(<puck_incline::Prepared as HybridSystem<6, 3, 1, 0>>::ELEMENTS.map(kind), [(Kind::Rough, 2)]);
    const { assert!(<stick_slip::Prepared as HybridSystem<4, 2, 1, 0>>::ELEMENTS[0].friction_of_speed) };
    const { assert!(!<painleve_rod::Prepared as HybridSystem<6, 2, 1, 0>>::PAINLEVE_FREE) };
}

#[test]
fn rows_that_move_by_themselves() {
    let belt = StickSlip::default().prepare().unwrap();
    let free = belt.free_motion(0.0, &[1.5, 0.0, 0.5, 0.0], &[], &[0.3]);
    assert_eq!((free.row_rates, belt.row_drifts(0.0, &[0.0; 4])), ([0.0, 0.3], [0.0, -0.2]));
    assert_eq!((free.friction, free.stiction), ([0.1 / 1.9], [0.1]));
}

/// The free motion against the mass matrix and the rows alone: `W` and the rates of the rows by dual numbers, `M^-1` densely. What
/// is left is rounding, for numbers of order one and matrices of up to six rows.
fn is_consistent<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: &H,
    mass: impl Fn(f64, &[f64; N]) -> nalgebra::DMatrix<f64>,
) where
    H: HybridSystem<N, W, C, S>,
{
    let mut seed = 1;
    let n = H::COORDINATES;
    for _ in 0..50 {
        let t = 2.0 * drawn(&mut seed);
        let state: [f64; N] = core::array::from_fn(|_| 2.0 * drawn(&mut seed) - 0.6);
        let switches: [f64; S] = core::array::from_fn(|_| f64::from(u8::from(drawn(&mut seed) > 0.5)));
        let free = system.free_motion(t, &state, &switches, &[0.3; C]);
        let size = mass(t, &state).nrows();
        let rows = nalgebra::DMatrix::from_fn(W, size, |w, s| {
            let mut along = state.map(Dual::<f64, 1>::constant);
            along[n + s].tangent = [1.0];
            system.row_rates(Dual::constant(t), &along)[w].tangent[0]
        });
        let inverse = mass(t, &state).try_inverse().unwrap();
        let responses = &inverse * rows.transpose();
        let delassus = &rows * &responses;
        let mut along: [Dual<f64, 1>; N] =
            core::array::from_fn(|i| Dual { value: state[i], tangent: [free.rates[i]] });
        along[0].tangent = [free.rates[0]];
        let moved = system.row_rates(Dual { value: t, tangent: [1.0] }, &along);
        let close = |found: f64, expected: f64, what: &str| {
            assert!((found - expected).abs() <= 1e-11 * (1.0 + expected.abs()), "{what}: {found} {expected}");
        };
        for w in 0..W {
            close(free.row_rates[w], moved[w].value, "row");
            close(free.biases[w], moved[w].tangent[0], "bias");
            (0..W).for_each(|v| close(free.delassus[w][v], delassus[(w, v)], "D"));
            (0..n).for_each(|i| close(free.responses[w][i], 0.0, "response of a coordinate"));
            (0..size).for_each(|s| close(free.responses[w][n + s], responses[(s, w)], "response"));
        }
        let alone = system.free_rates(t, &state, &switches);
        (0..N).for_each(|i| close(alone[i], free.rates[i], "free rate"));
        // A gap's rate is that of the gap.
        let gap = |c: usize| {
            let velocities: [Dual<f64, 1>; N] =
                core::array::from_fn(|i| Dual { value: state[i], tangent: [free.rates[i]] });
            let time = Dual { value: t, tangent: [1.0] };
            let lifted = switches.map(Dual::constant);
            system.free_motion(time, &velocities, &lifted, &[Dual::constant(0.3); C]).gaps[c].tangent[0]
        };
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            element.normal.into_iter().for_each(|row| close(free.row_rates[row], gap(c), "rate of the gap"));
        }
    }
}

macro_rules! consistent {
    ($($name:ident: $system:expr, $prepared:expr, $N:literal $W:literal $C:literal $S:literal $l:literal;)*) => {
        $(
            #[test]
            fn $name() {
                let mass = |t: f64, state: &[f64; $N]| {
                    let rows: [[f64; $l]; $l] = $prepared.mass_matrix(t, &(*state).into());
                    nalgebra::DMatrix::from_fn($l, $l, |s, k| rows[s][k])
                };
                is_consistent::<_, $N, $W, $C, $S>(&$system, mass);
            }
        )*
    };
}

fn walker() -> walker::Prepared {
    Walker::default().prepare().unwrap()
}

consistent! {
    responses_of_the_hoop: HoopOnFloor::default().prepare().unwrap(), HoopOnFloor::default().prepare().unwrap(), 12 3 1 0 6;
    responses_of_the_rod: PainleveRod::default().prepare().unwrap(), PainleveRod::default().prepare().unwrap(), 6 2 1 0 3;
    responses_of_the_double_pendulum: KaneImpact::new(1.0).prepare().unwrap(), KaneImpact::new(1.0).prepare().unwrap(), 4 2 1 0 2;
    responses_of_the_walker: walker().driven(walker::Inputs { hip: 0.7 }), walker(), 12 7 5 1 6;
}

/// A hoop that sticks to its floor is the rolling hoop, which is derived with its constraints.
#[test]
fn a_stuck_hoop_rolls() {
    let (floor, hoop) = (HoopOnFloor::default().prepare().unwrap(), Hoop::default().prepare().unwrap());
    let stuck = floor.in_mode(hoop_on_floor::Mode { floor: hoop_on_floor::Floor::Stick });
    let mut seed = 7;
    for _ in 0..50 {
        let state: [f64; 9] = core::array::from_fn(|_| 0.2 + drawn(&mut seed));
        let mut rolling = hoop::State::from(state);
        rolling.zeta = 2.0 * rolling.theta.sin();
        let rate = hoop.rhs(0.0, &rolling);
        let hoop::State { theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3 } = rolling;
        let (u, v, w) = (rate.xi, rate.eta, rate.zeta);
        let state = hoop_on_floor::State { theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3, u, v, w };
        let found = guen::System::rhs(&stuck, 0.0, &state.into());
        let expected: [f64; 9] = rate.into();
        for i in 0..9 {
            let scale = 1.0 + expected[i].abs();
            assert!((found[i] - expected[i]).abs() < 1e-12 * scale, "{i}: {} {}", found[i], expected[i]);
        }
        let mode = hoop_on_floor::Mode { floor: hoop_on_floor::Floor::Stick };
        let outputs = floor.outputs_in_mode(mode, 0.0, &state);
        let reactions = hoop.reactions(0.0, &rolling);
        assert!(outputs.above.abs() < 1e-15 && outputs.across.iter().all(|slip| slip.abs() < 1e-13));
        // The weight acts on the tilt of the one hoop and on the height of the other.
        let normal = (outputs.force[0] - (reactions.eta6 + 9.81)).abs();
        assert!(normal < 1e-11 * (1.0 + reactions.eta6.abs()), "{outputs:?} {reactions:?}");
        assert!((outputs.force[1] - reactions.eta4).abs() < 1e-11 * (1.0 + reactions.eta4.abs()));
        assert!((outputs.force[2] - reactions.eta5).abs() < 1e-11 * (1.0 + reactions.eta5.abs()));
    }
}

#[test]
fn the_walker_has_what_it_declares() {
    let elements = <walker::Driven as HybridSystem<12, 7, 5, 1>>::ELEMENTS;
    let kinds = [Kind::Rough, Kind::Rough, Kind::Smooth, Kind::Latch, Kind::Grip];
    assert_eq!(elements.map(|element| element.kind), kinds);
    assert_eq!((elements[4].load, elements[4].tangential), (Some(4), &[6][..]));
    assert!(elements[0].friction_of_speed && !elements[1].friction_of_speed);
    // 2 states of the heel, 3 of the toe, 2 of the knee and the lock, 3 of the brake.
    assert_eq!(walker::MODES.len(), 2 * 3 * 2 * 2 * 3 - 12);
    let driven = walker().driven(walker::Inputs { hip: 0.0 });
    let free = driven.free_motion(0.0, &[0.5; 12], &[0.0], &[1.0; 5]);
    assert_eq!(free.friction, [0.7 * 1.5, 0.7, 0.0, 0.0, 0.7]);
    assert_eq!(free.stiction, [1.4, 1.0, 0.0, 0.0, 0.7]);
    assert_eq!(driven.restitutions(), [0.25, 0.0, 0.0, 0.0, 0.0]);
    let conditions = driven.conditions(0.5, &[0.4; 12], &[0.0]);
    assert_eq!(
        (conditions.when, conditions.release),
        ([1.0, 1.0, 1.0, 0.4, 1.0], [-1.0, -1.0, -1.0, -1.5, -1.0])
    );
    assert_eq!(driven.signals(0.25, &[0.0; 12]), [-0.75]);
    assert_eq!(driven.row_drifts(0.5, &[0.0; 12])[1], -(1.5_f64.sin()));
}

#[test]
fn contacts_of_a_loop() {
    let feet = Feet::default().prepare().unwrap();
    assert_eq!(
        <feet::Prepared as HybridSystem<6, 6, 3, 0>>::ELEMENTS.map(|leg| leg.name),
        ["leg[0]", "leg[1]", "leg[2]"]
    );
    assert_eq!(feet::MODES.len(), 6);
    let mode = feet::Mode { leg: [feet::Leg::Stick, feet::Leg::Open, feet::Leg::Stick] };
    assert_eq!(mode.to_string(), "leg[0] stick, leg[1] open, leg[2] stick");
    // Two feet that stick carry half of the weight each, up to the forces along the table that are not determined.
    let outputs = feet.outputs_in_mode(mode, 0.0, &feet::State::default());
    assert!((outputs.load - 9.81).abs() < 1e-13, "{outputs:?}");
}
