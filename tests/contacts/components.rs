//! Contacts of components: what instances bring, against the same system written by hand.

use guen::components::{Foot as GroundFoot, HingeStops};
use guen::hybrid::{Hybrid, HybridSystem};
use guen::prelude::*;

mechanical_component! {
    /// A foot that may lift off, stick and slip.
    component Foot(point: vector) {
        constants {
            /// The friction at rest, which falls with the speed.
            mu >= 0 = 1/2,
            e in 0..1 = 0,
        }
        let speed = dot(point).x;
        switches { wet: point.x; }
        contacts {
            /// The sole.
            sole: gap = point.y, slip = speed, friction = mu*(1 - wet/2)/(1 + speed), restitution = e;
        }
        outputs { push = reaction(sole); height = gap(sole); sliding = slip(sole); }
    }
}

mechanical_component! {
    /// A leg that is two feet, a toe and a heel.
    component Pair(middle: vector, across: vector) {
        use Foot as heel { point: middle - across }
        use Foot as toe  { point: middle + across }
        modes { heel.sole: open, stick, slip; never heel.sole.stick with toe.sole.slip; }
    }
}

mechanical_system! {
    /// A plank on two feet, by hand.
    system ByHand {
        constants { m > 0 = 2, J > 0 = 1, g = 9.81, left_mu >= 0 = 1/2, left_e in 0..1 = 0, right_mu >= 0 = 1/2, right_e in 0..1 = 0 }
        coordinates { x, z, tilt }
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        let a = vec(x - cos(tilt), z - sin(tilt));
        let b = vec(x + cos(tilt), z + sin(tilt));
        switches { left_wet: a.x; right_wet: b.x; }
        contacts {
            left_sole: gap = a.y, slip = dot(a).x, friction = left_mu*(1 - left_wet/2)/(1 + speed), restitution = left_e;
            right_sole: gap = b.y, slip = dot(b).x, friction = right_mu*(1 - right_wet/2)/(1 + speed), restitution = right_e;
        }
        modes { left_sole: open, stick, slip; never left_sole.stick with right_sole.slip; }
        outputs { push = reaction(left_sole); height = gap(left_sole); sliding = slip(left_sole); }
    }
}

mechanical_system! {
    /// The plank with two instances.
    system OfInstances {
        constants { m > 0 = 2, J > 0 = 1, g = 9.81 }
        coordinates { x, z, tilt }
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        use Foot as left  { point: vec(x - cos(tilt), z - sin(tilt)) }
        use Foot as right { point: vec(x + cos(tilt), z + sin(tilt)) }
        modes { left.sole: open, stick, slip; never left.sole.stick with right.sole.slip; }
        outputs { push = reaction(left.sole); height = gap(left.sole); sliding = slip(left.sole); }
        scene Falling { track tilt; provide push; }
    }
}

mechanical_system! {
    /// The plank with an array of instances.
    system OfArray {
        count n = 2;
        constants { m > 0 = 2, J > 0 = 1, g = 9.81 }
        coordinates { x, z, tilt }
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        for i in 0..n { let side[i] = 2*i - 1; }
        for i in 0..n { use Foot as foot[i] { point: vec(x + side[i]*cos(tilt), z + side[i]*sin(tilt)) } }
        modes { for i in 0..n { foot[i].sole: open, stick, slip; } never foot[0].sole.stick with foot[n-1].sole.slip; }
        outputs { push = reaction(foot[0].sole); }
        scene Falling { track tilt; }
    }
}

mechanical_system! {
    /// The plank as an instance of an instance.
    system OfPair {
        constants { m > 0 = 2, J > 0 = 1, g = 9.81 }
        coordinates { x, z, tilt }
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        use Pair as pair { middle: vec(x, z), across: vec(cos(tilt), sin(tilt)) }
        outputs { push = reaction(pair.heel.sole); }
        scene Falling { track tilt; }
    }
}

mechanical_system! {
    /// A plank whose feet are declared by a loop in `contacts`.
    system ByLoop {
        count n = 2;
        constants { m > 0 = 2, J > 0 = 1, g = 9.81, mu[n] >= 0 = 1/2, e[n] in 0..1 = 0 }
        coordinates { x, z, tilt }
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        for i in 0..n { let side[i] = 2*i - 1; }
        for i in 0..n { let p[i] = vec(x + side[i]*cos(tilt), z + side[i]*sin(tilt)); }
        switches { for i in 0..n { wet[i]: p[i].x; } }
        contacts {
            for i in 0..n {
                sole[i]: gap = p[i].y, slip = dot(p[i]).x, friction = mu[i]*(1 - wet[i]/2)/(1 + speed), restitution = e[i];
            }
        }
        modes { sole: open, stick, slip; never sole[0].stick with sole[1].slip; }
        outputs { for i in 0..n { push[i] = reaction(sole[i]); } }
        scene Falling { track tilt; }
        scene Lying { modes { sole[0]: slip; sole[1]: slip, stick; } track x; }
    }
}

/// The state and the number of transitions after a second of hopping, rocking and sliding.
fn ran<H: HybridSystem<6, 4, 2, 2, Inputs = ()> + Clone>(system: &H) -> ([f64; 6], u64) {
    let start = [-0.3, 0.4, 0.2, 0.7, 0.0, 0.1];
    let run = Hybrid::new(system, 0.0, &start).run(&Dop853::new(1e-10, 1e-10), 1.0).unwrap();
    (run.state, run.transitions)
}

/// A scene that needs every variable moves as its system, and its modes have the same types.
#[test]
fn scenes_run_with_the_modes_of_instances_and_arrays() {
    let near = |found: ([f64; 6], u64), expected: ([f64; 6], u64)| {
        assert_eq!(found.1, expected.1);
        assert!(found.0.iter().zip(expected.0).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    };
    let system = OfInstances::default();
    let falling = of_instances::Falling::from(system).prepare().unwrap();
    near(ran(&falling), ran(&system.prepare().unwrap()));
    let left: of_instances::falling::left::Mode = of_instances::falling::MODES[0].left;
    assert_eq!(left.sole, of_instances::left::Sole::Open);
    let (array, pair, by_loop) = (OfArray::default(), OfPair::default(), ByLoop::default());
    near(ran(&of_array::Falling::from(array).prepare().unwrap()), ran(&array.prepare().unwrap()));
    near(ran(&of_pair::Falling::from(pair).prepare().unwrap()), ran(&pair.prepare().unwrap()));
    near(ran(&by_loop::Falling::from(by_loop).prepare().unwrap()), ran(&by_loop.prepare().unwrap()));
    assert!(by_loop::lying::MODES.len() == 6 && by_loop::lying::State::<f64>::NAMES.len() > 1);
}

#[test]
fn instances_run_as_what_is_written_by_hand() {
    let hand = ByHand { left_e: 0.5, right_e: 0.25, left_mu: 0.3, ..Default::default() }.prepare().unwrap();
    let (left, right) = (Foot { mu: 0.3, e: 0.5 }, Foot { mu: 0.5, e: 0.25 });
    let instances = OfInstances { left, right, ..Default::default() }.prepare().unwrap();
    let array = OfArray { foot: [left, right], ..Default::default() }.prepare().unwrap();
    let pair = OfPair { pair: Pair { heel: left, toe: right }, ..Default::default() }.prepare().unwrap();
    let looped = ByLoop { mu: [0.3, 0.5], e: [0.5, 0.25], ..Default::default() }.prepare().unwrap();
    let expected = ran(&hand);
    assert!(expected.1 > 6, "{} transitions", expected.1);
    assert_eq!(ran(&instances), expected);
    assert_eq!(ran(&array), expected);
    assert_eq!(ran(&pair), expected);
    assert_eq!(ran(&looped), expected);
}

#[test]
fn modes_are_structs_and_arrays_as_states_are() {
    use {by_hand as h, by_loop as l, of_array as a, of_instances as i, of_pair as p};
    assert_eq!(h::MODES.len(), 14);
    let modes = h::MODES.iter().map(|mode| guen::hybrid::Mode::from(*mode));
    assert!(modes.clone().eq(i::MODES.iter().map(|mode| guen::hybrid::Mode::from(*mode))));
    assert!(modes.clone().eq(a::MODES.iter().map(|mode| guen::hybrid::Mode::from(*mode))));
    assert!(modes.clone().eq(p::MODES.iter().map(|mode| guen::hybrid::Mode::from(*mode))));
    assert!(modes.clone().eq(l::MODES.iter().map(|mode| guen::hybrid::Mode::from(*mode))));

    let left = i::left::Mode { sole: i::left::Sole::Stick };
    let mode = i::Mode { left, right: i::right::Mode { sole: i::right::Sole::Open } };
    assert_eq!(mode.to_string(), "left.sole stick, right.sole open");
    let soles = [a::foot::Sole::Stick, a::foot::Sole::Open];
    let of_array = a::Mode { foot: soles.map(|sole| a::foot::Mode { sole }) };
    assert_eq!(of_array.to_string(), "foot[0].sole stick, foot[1].sole open");
    let by_loop = l::Mode { sole: [l::Sole::Stick, l::Sole::Open] };
    assert_eq!(by_loop.to_string(), "sole[0] stick, sole[1] open");
    let heel = p::pair::heel::Mode { sole: p::pair::heel::Sole::SlipForward };
    let toe = p::pair::toe::Mode { sole: p::pair::toe::Sole::Open };
    assert_eq!(
        p::Mode { pair: p::pair::Mode { heel, toe } }.to_string(),
        "pair.heel.sole slip+, pair.toe.sole open"
    );
    assert_eq!(guen::hybrid::Mode::from(mode), guen::hybrid::Mode::from(of_array));
}

#[test]
fn reactions_of_instances_are_outputs() {
    let system = OfInstances::default().prepare().unwrap();
    let hand = ByHand::default().prepare().unwrap();
    let state = of_instances::State { x: -3.0, u: 0.5, ..Default::default() };
    let (left, right) = (of_instances::left::Sole::SlipForward, of_instances::right::Sole::SlipForward);
    let mode = of_instances::Mode {
        left: of_instances::left::Mode { sole: left },
        right: of_instances::right::Mode { sole: right },
    };
    let outputs = system.outputs_in_mode(mode, 0.0, &state);
    let by_hand = by_hand::Mode {
        left_sole: by_hand::LeftSole::SlipForward,
        right_sole: by_hand::RightSole::SlipForward,
    };
    let expected =
        hand.outputs_in_mode(by_hand, 0.0, &by_hand::State { x: -3.0, u: 0.5, ..Default::default() });
    assert_eq!(outputs.push, expected.push);
    assert_eq!((outputs.left.push, outputs.left.height, outputs.left.sliding), (expected.push, 0.0, 0.5));
    // Both together carry the weight.
    assert!((outputs.left.push[0] + outputs.right.push[0] - 2.0 * 9.81).abs() < 1e-12);
}

mechanical_system! {
    /// A wheel on a hinge with stops, without gravity.
    system Stopped {
        constants { J > 0 = 2 }
        coordinates { q }
        kinetic_energy = J/2*dot(q)^2;
        parameters { w = dot(q); }
        use HingeStops as stops { angle: q }
    }
}

#[test]
fn a_hinge_bounces_between_its_stops() {
    let stops = HingeStops { restitution: 0.5, ..HingeStops::new(-1.0, 1.0) };
    let system = Stopped { stops, J: 2.0 }.prepare().unwrap();
    assert_eq!(stopped::MODES.len(), 3);
    // At 1 after one unit of time, at -1 after four more, and on with a quarter of the speed.
    let done = Hybrid::new(&system, 0.0, &[0.0, 1.0]).run(&Dop853::new(1e-11, 1e-11), 7.0).unwrap();
    assert_eq!(done.transitions, 2);
    assert!((done.state[0] + 0.5).abs() < 1e-10 && (done.state[1] - 0.25).abs() < 1e-12, "{:?}", done.state);
    let pressed = stopped::Mode {
        stops: stopped::stops::Mode {
            lower_stop: stopped::stops::LowerStop::Open,
            upper_stop: stopped::stops::UpperStop::Closed,
        },
    };
    assert_eq!(system.outputs_in_mode(pressed, 0.0, &stopped::State { q: 1.0, w: 0.0 }).stops.torque, 0.0);
}

mechanical_system! {
    /// A block that slides on the ground, by one foot.
    system Block {
        constants { m > 0 = 3, g = 10 }
        coordinates { x, y, z }
        particles { m at vec(x, y, z); }
        gravity = vec(0, 0, -g);
        parameters { u = dot(x); v = dot(y); w = dot(z); }
        use GroundFoot as foot { point: vec(x, y, z), up: vec(0, 0, 1) }
    }
}

mechanical_system! {
    /// The block in a plane.
    system FlatBlock {
        constants { m > 0 = 3, g = 10 }
        coordinates { x, y }
        particles { m at vec(x, y); }
        gravity = vec(0, -g);
        parameters { u = dot(x); v = dot(y); }
        use GroundFoot as foot { point: vec(x, y), up: vec(0, 1, 0) }
    }
}

#[test]
fn a_foot_slides_to_rest() {
    // From a speed of 5 at 5 per unit of time it stops after one, 2.5 further.
    let foot = GroundFoot::new(0.5);
    let block = Block { foot, m: 3.0, g: 10.0 }.prepare().unwrap();
    let done = Hybrid::new(&block, 0.0, &[0.0, 0.0, 0.0, 3.0, 4.0, 0.0])
        .run(&Dop853::new(1e-11, 1e-11), 2.0)
        .unwrap();
    assert!((done.state[0] - 1.5).abs() < 1e-6 && (done.state[1] - 2.0).abs() < 1e-6, "{:?}", done.state);
    assert_eq!(done.mode.foot.sole, block::foot::Sole::Stick);
    let flat = FlatBlock { foot, m: 3.0, g: 10.0 }.prepare().unwrap();
    let done = Hybrid::new(&flat, 0.0, &[0.0, 0.0, -5.0, 0.0]).run(&Dop853::new(1e-11, 1e-11), 2.0).unwrap();
    assert!((done.state[0] + 2.5).abs() < 1e-10, "{:?}", done.state);
    let slips =
        flat_block::Mode { foot: flat_block::foot::Mode { sole: flat_block::foot::Sole::SlipBackward } };
    let state = flat_block::State { u: -1.0, ..Default::default() };
    let load = flat.outputs_in_mode(slips, 0.0, &state).foot.load;
    assert!((load[0] - 30.0).abs() < 1e-12 && (load[1] - 15.0).abs() < 1e-12, "{load:?}");
}
