//! Slips in space that end: as slow as the error that a step may have, several together, and with room in the stack of a test.

use guen::hybrid::{Hybrid, TransitionKind};
use guen::mechanical_system;
use guen::steppers::Dop853;

mechanical_system! {
    /// A puck whose mass along `x` is not that along `y`, and which drags another one along: its slip turns as it ends.
    pub system Puck {
        constants { m > 0 = 1, k = 1, g = 9.81, mu in 0..1 = 0.4 }
        coordinates { x, y, z, q }
        particles { m at vec(x, y, z); }
        kinetic_energy = k*dot(x)^2 + dot(q)^2 + dot(q)*dot(y)/2;
        gravity = vec(0, 0, -g);
        contacts { foot: gap = z, slip = vec(dot(x), dot(y)), friction = mu; }
    }
}

mechanical_system! {
    /// A body on three rough feet.
    pub system Tripod {
        count n = 3;
        constants { m > 0 = 1, J[3] > 0 = 0.05, a > 0 = 0.4, h > 0 = 0.3, g = 9.81, mu in 0..1 = 0.4 }
        coordinates { x, y, z, q0, q1, q2, q3 }
        holonomic { unit_q: q0^2 + q1^2 + q2^2 + q3^2 = 1; }
        bodies { top { mass: m, center: vec(x, y, z), inertia: diag(J[0], J[1], J[2]), orientation: quaternion(q0, q1, q2, q3) } }
        parameters { v = dot(top.center); w = top.angular_velocity; }
        gravity = vec(0, 0, -g);
        for i in 0..n {
            let p[i] = top.center + top.orientation*vec(a*cos(2*pi*i/n), a*sin(2*pi*i/n), -h);
            let u[i] = top.velocity_at(p[i]);
        }
        contacts { for i in 0..n { foot[i]: gap = p[i].z, slip = vec(u[i].x, u[i].y), friction = mu; } }
    }
}

#[test]
fn a_slip_as_slow_as_the_tolerance_sticks() {
    let puck = Puck::default().prepare().unwrap();
    // Equal slips end after equal times, divided by their speeds.
    let reference = 0.517_256_158_6;
    for tolerance in [1e-4, 1e-6, 1e-9, 1e-12] {
        for speed in [1e-2, 1e-4, 1e-6, 1e-7, 1e-9] {
            let start = puck::State { x_rate: 0.6 * speed, y_rate: 0.8 * speed, ..Default::default() };
            let mut told = Vec::new();
            let done = Hybrid::new(&puck, 0.0, &start.into())
                .transitions(&mut |transition| {
                    told.push((transition.t, transition.kind));
                    std::ops::ControlFlow::Continue(())
                })
                .run(&Dop853::new(tolerance, tolerance), 0.1)
                .unwrap();
            let [(t, TransitionKind::Sticks)] = told[..] else { panic!("{tolerance} {speed}: {told:?}") };
            // A step may be off by the tolerance, which the slip loses in the tolerance over its deceleration.
            assert!(
                (t - reference * speed).abs() < 1e-8 * speed + 10.0 * tolerance,
                "{tolerance} {speed}: {t}"
            );
            assert!(done.work.accepted < 100, "{tolerance} {speed}: {:?}", done.work);
        }
    }
}

#[test]
fn three_feet_that_slide_and_turn_come_to_rest() {
    let tripod = Tripod { J: [0.05, 0.06, 0.08], ..Tripod::default() }.prepare().unwrap();
    for (v, w) in [([0.3, 0.1], 0.8), ([0.0, 0.0], 1.0), ([0.02, -0.3], -2.0)] {
        let start = tripod::State { z: 0.3, q0: 1.0, v_x: v[0], v_y: v[1], w_z: w, ..Default::default() };
        let motion = tripod.simulation(&start).tolerance(1e-8).run(0.0..0.5).unwrap();
        assert_eq!(motion.mode_at(0.5), tripod::Mode { foot: [tripod::Foot::Stick; 3] });
        let energies: Vec<f64> = motion.sample(0.01).map(|(t, state)| tripod.energy(t, &state)).collect();
        assert!(energies.windows(2).all(|pair| pair[1] < pair[0] + 1e-9));
        let end = motion.end();
        assert!([end.v_x, end.v_y, end.w_z].iter().all(|rate| rate.abs() < 1e-9), "{end:?}");
    }
}

#[test]
fn a_foot_slips_beside_another_that_slips_slowly() {
    let constants = Tripod { J: [0.05, 0.06, 0.08], mu: 0.531_014_929_678_914_2, ..Tripod::default() };
    let tripod = constants.prepare().unwrap();
    // It falls over two feet: one sticks and reaches its cone, the other slips by 0.2 mm/s.
    let start = tripod::State {
        x: -0.240_406_320_156_486_75,
        y: 0.489_593_202_284_249_35,
        z: 0.219_515_462_257_676_96,
        q0: 0.705_109_924_871_525_8,
        q1: -0.660_140_899_639_700_2,
        q2: 0.175_925_353_564_211_35,
        q3: 0.189_958_565_071_085_13,
        v_x: -0.002_342_163_498_474_039_4,
        v_y: 0.861_096_967_746_234_7,
        v_z: -1.122_005_823_563_821_5,
        w_x: -3.922_676_167_639_379_8,
        w_y: -0.010_636_051_877_397_227,
        w_z: 2.573_686_798_600_533_5e-5,
    };
    let motion = tripod.simulation(&start).tolerance(1e-9).run(0.0..0.005).unwrap();
    let feet = |mode: &tripod::Mode| mode.foot;
    let slips =
        motion.transitions().iter().find(|transition| transition.kind == TransitionKind::Slips).unwrap();
    assert!((slips.t - 0.001_568_191_9).abs() < 1e-8, "{}", slips.t);
    use tripod::Foot::{Open, Slip, Stick};
    assert_eq!((feet(&slips.before), feet(&slips.after)), ([Slip, Stick, Open], [Slip, Slip, Open]));
}

#[test]
fn a_slip_ends_beside_a_foot_that_sticks() {
    let constants = Tripod { J: [0.05, 0.06, 0.08], mu: 0.518_705_549_761_714_2, ..Tripod::default() };
    let tripod = constants.prepare().unwrap();
    // Two feet slip by half a millimetre a second, and end half a nanosecond apart.
    let start = tripod::State {
        x: 0.247_417_484_707_624_37,
        y: 0.349_621_084_860_218_76,
        z: 0.349_517_554_463_795_9,
        q0: 0.875_357_642_492_354_4,
        q1: -0.091_237_020_428_830_68,
        q2: 0.142_431_300_870_025_34,
        q3: -0.452_921_768_483_221_63,
        v_x: -0.069_843_363_035_208_24,
        v_y: -0.005_611_674_836_122_91,
        v_z: -0.017_823_576_624_296_313,
        w_x: 0.018_543_354_132_762_892,
        w_y: -0.200_473_366_028_585_6,
        w_z: -0.000_628_980_169_229_729_5,
    };
    let motion = tripod.simulation(&start).tolerance(1e-9).run(0.0..0.0005).unwrap();
    use tripod::Foot::{Open, Stick};
    assert_eq!(motion.mode_at(0.0005).foot, [Stick, Stick, Open]);
    let ends: Vec<f64> = motion.transitions().iter().map(|transition| transition.t).collect();
    assert!(ends.len() == 2 && ends.iter().all(|t| (t - 0.000_192_569).abs() < 1e-8), "{ends:?}");
}

#[test]
fn a_search_that_finds_the_same_place_again_ends() {
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let constants = Tripod { J: [0.05, 0.06, 0.08], mu: 0.400_006_265_361_652_5, ..Tripod::default() };
        let tripod = constants.prepare().unwrap();
        // Two feet stick, and one begins to slip across the line between them, as slowly as roundings allow.
        let start = tripod::State {
            x: -0.217_368_858_442_612_25,
            y: 0.201_356_190_531_399_08,
            z: 0.324_860_550_993_386_5,
            q0: 0.809_245_092_424_312_9,
            q1: -0.069_228_207_785_421_84,
            q2: -0.007_014_306_462_137_511,
            q3: 0.583_335_782_494_815_9,
            v_x: 0.392_792_956_242_570_16,
            v_y: -0.442_863_062_921_228_7,
            v_z: -0.285_017_733_182_076_5,
            w_x: 1.363_240_509_095_376_5,
            w_y: 1.209_112_510_095_344,
            w_z: 1.498_683_123_322_748_7e-17,
        };
        let run = Hybrid::new(&tripod, 0.0, &start.into());
        let end = run.run(&Dop853::new(1e-9, 1e-9), 0.000_5).map_or_else(|error| error.t, |done| done.t);
        sender.send(end).unwrap();
    });
    // It took for ever; the feet stick until 0.153 ms.
    let end = receiver.recv_timeout(std::time::Duration::from_secs(120)).expect("the run ends");
    assert!(end > 0.000_153, "{end}");
}
