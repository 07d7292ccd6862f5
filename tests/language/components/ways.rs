//! The ways of a component to a system: the same module, another one, a body of a function, twice imported, inside of another component.

/// A module with components of every visibility.
mod parts {
    pub mod springs {
        guen::mechanical_component! {
            /// A mass on a spring.
            pub component Spring(
                /// Where it hangs.
                anchor: vector,
            ) {
                constants   { m > 0, k > 0 = 2, rest >= 0 = 0.1 }
                coordinates { length }
                let end = anchor - vec(0, 0, length);
                particles   { m at end; }
                potential_energy = k/2*(length - rest)^2;
                inputs      { pull }
                forces      { pull along dot(length); }
                outputs     { place = end; stretch = length - rest; }
            }
        }
    }
    guen::mechanical_component! {
        pub(crate) component Pair(anchor: vector) {
            constants { c >= 0 }
            use springs::Spring as upper { anchor }
            for i in 0..2 { use springs::Spring as lower[i] { anchor: upper.end + vec(i, 0, 0) } }
            forces { -c*upper.length_rate along dot(upper.length); }
        }
    }
    guen::mechanical_component! {
        component Hidden(x: scalar) { constants { stiffness > 0 } potential_energy = stiffness*x^2; }
    }
    mod inner {
        use super::{Hidden, Pair};
        guen::mechanical_system! {
            system Hung {
                constants { M > 0, g = 9.81 }
                coordinates { z }
                particles { M at vec(0, 0, z); }
                gravity = vec(0, 0, -g);
                use Hidden as ground { x: z }
                use Pair as pair { anchor: vec(0, 0, z) }
            }
        }
        #[test]
        fn of_parents() {
            let ground = Hidden { stiffness: 3.0 };
            let spring = super::springs::Spring::new(1.0);
            let pair = Pair { c: 0.0, upper: spring, lower: [spring; 2] };
            let hung = Hung { M: 2.0, g: 9.81, ground, pair }.prepare().unwrap();
            assert_eq!(
                hung::State::NAMES[..4],
                ["z", "pair.upper.length", "pair.lower[0].length", "pair.lower[1].length"]
            );
            let mut state = hung::State::default();
            state.pair.lower[1].length = 0.5;
            state.z = 0.25;
            let energy = hung.energy(0.0, &state);
            let heights = [2.0 * 0.25, 0.25, 0.25, 0.25 - 0.5];
            let springs = 3.0 * 0.25 * 0.25 + 2.0 * 0.01 + 0.4 * 0.4;
            let own = 9.81 * heights.iter().sum::<f64>() + springs;
            assert!((energy - own).abs() < 1e-13, "{energy} {own}");
        }
    }
}

mod user {
    use super::parts::springs::Spring;
    use super::parts::springs::Spring as Elastic;

    guen::mechanical_system! {
        /// Two springs under a beam.
        pub system Beam {
            constants   { M > 0, g = 9.81 }
            coordinates { z, tilt }
            parameters  { tilting = dot(tilt); }
            particles   { M at vec(0, 0, z); }
            kinetic_energy = M*dot(tilt)^2;
            gravity     = vec(0, 0, -g);
            /// At the left end.
            use Spring as left  { anchor: vec(-1, 0, z - tilt) };
            use Elastic as right { anchor: vec(1, 0, z + tilt) }
            use super::parts::springs::Spring as middle { anchor: vec(0, 0, z) }
            outputs { height = z; }
            scene Quiet { track left; fix right.k = 2; provide left.stretch; }
            provide taylor;
        }
    }
}

use parts::springs::Spring;
use user::{Beam, beam};

fn a_beam() -> Beam {
    let spring = Spring { m: 0.5, k: 2.0, rest: 0.1 };
    Beam { M: 1.0, g: 9.81, left: spring, right: Spring { k: 3.0, ..spring }, middle: spring }
}

#[test]
fn names_and_their_order() {
    assert_eq!(
        beam::State::NAMES,
        [
            "z",
            "tilt",
            "left.length",
            "right.length",
            "middle.length",
            "tilting",
            "z_rate",
            "left.length_rate",
            "right.length_rate",
            "middle.length_rate"
        ]
    );
    let array: [f64; 10] = std::array::from_fn(|i| i as f64);
    let state = beam::State::from(array);
    assert_eq!((state.left.length, state.left.length_rate, state.middle.length_rate), (2.0, 7.0, 9.0));
    assert_eq!(<[f64; 10]>::from(state), array);
    let literal =
        beam::State { left: beam::left::State { length: 1.0, length_rate: 0.0 }, ..Default::default() };
    assert_eq!(literal.left.length, 1.0);
    assert_eq!(beam::Inputs::NAMES, ["left.pull", "right.pull", "middle.pull"]);
    assert!(format!("{state:?}").contains("left: State { length: 2.0, length_rate: 7.0 }"), "{state:?}");
}

#[test]
fn everything_falls_alike_and_springs_swing() {
    // In free fall, with all springs at rest, the lengths stay: the particles fall with the beam.
    let beam = a_beam().prepare().unwrap();
    let mut state = beam::State::<f64>::default();
    (state.left.length, state.right.length, state.middle.length) = (0.1, 0.1, 0.1);
    let rate = beam.rhs(0.0, &state, &beam::Inputs::default());
    assert!((rate.z_rate + 9.81).abs() < 1e-12, "{rate:?}");
    assert!(rate.left.length_rate.abs() < 1e-12 && rate.middle.length_rate.abs() < 1e-12);
    // A force that pulls one mass down lengthens its spring with F/m + F/M_rest: Newton for the two sides of the spring alone.
    let inputs = beam::Inputs { middle: beam::middle::Inputs { pull: 0.3 }, ..Default::default() };
    let rate = beam.rhs(0.0, &state, &inputs);
    // Without tilt the beam has M, and the springs on both sides do not move against it: their masses hang in free fall.
    let along = 0.3 / 0.5;
    assert!((rate.middle.length_rate - rate.z_rate - 9.81 - along).abs() < 1e-9, "{rate:?}");
    let outputs = beam.outputs(0.0, &state, &inputs);
    assert_eq!(outputs.left.place, [-1.0, 0.0, -0.1]);
    assert_eq!(outputs.height, 0.0);
}

#[test]
fn scenes_of_instances() {
    let beam = a_beam();
    let mut state = beam::State::<f64>::default();
    state.left.length = 0.4;
    let wrong = beam::Quiet::of(&beam, &state);
    assert!(wrong.unwrap_err().to_string().contains("right.k"));
    let scene = beam::Quiet::of(&Beam { right: beam.left, ..beam }, &state).unwrap();
    let small = beam::quiet::State::from(&state);
    assert_eq!(small.left.length, 0.4);
    let prepared = scene.prepare().unwrap();
    assert_eq!(scene.left, beam.left);
    let _ = prepared;
}

#[test]
fn constants_are_checked_with_their_paths() {
    let mut beam = a_beam();
    beam.right.k = -1.0;
    let error = beam.prepare().unwrap_err();
    assert!(error.to_string().contains("right.k > 0"), "{error}");
}

#[test]
fn in_a_body_of_a_function() {
    guen::mechanical_component! {
        component Weight(place: vector) { constants { mass > 0 = 2 } particles { mass at place; } }
    }
    guen::mechanical_system! {
        system Here {
            constants   { g = 9.81 }
            coordinates { z }
            gravity     = vec(0, 0, -g);
            use Weight as weight { place: vec(0, 0, z) }
            use parts::springs::Spring as spring { anchor: vec(0, 0, 0) }
        }
    }
    let here = Here { g: 1.0, weight: Weight::default(), spring: Spring::new(1.0) }.prepare().unwrap();
    assert_eq!(here.rhs(0.0, &here::State::default(), &here::Inputs::default()).z_rate, -1.0);
}

guen::mechanical_system! {
    /// Components in its braces.
    pub system Inside {
        component Mass(to: scalar) { constants { mass > 0 } coordinates { q } kinetic_energy = mass/2*(dot(q) + dot(to))^2; }
        component Two(to: scalar) {
            use Mass as first  { to }
            use Mass as second { to: first.q }
        }
        constants   { M > 0 }
        coordinates { x }
        kinetic_energy = M*dot(x)^2;
        use Two as two { to: x }
        for i in 0..2 { use Mass as mass[i] { to: x + two.second.q }; }
        potential_energy = two.first.q^2 + sum(i in 0..2: mass[i].q^2);
    }
}

#[test]
fn declared_in_the_braces_of_a_system() {
    let mass = inside::Mass { mass: 1.5 };
    let two = inside::Two { first: mass, second: mass };
    let system = Inside { M: 1.0, two, mass: [mass; 2] }.prepare().unwrap();
    let mut state = inside::State::default();
    state.mass[1].q_rate = 2.0;
    assert_eq!(system.energy(0.0, &state), 3.0);
    assert_eq!(system.constants().two.second.mass, 1.5);
}

guen::mechanical_component! {
    /// A motor whose winding has an inductance.
    component Winding(angle: scalar) {
        constants { k > 0, R > 0, L > 0 }
        inputs    { voltage }
        states    { dot(current) = (voltage - R*current - k*dot(angle))/L; }
        forces    { k*current along dot(angle); }
        outputs   { slope = dot(current); }
    }
}

guen::mechanical_system! {
    system TwoMotors {
        constants   { J > 0 }
        coordinates { a, b }
        kinetic_energy = J/2*(dot(a)^2 + dot(b)^2);
        parameters  { u = dot(a); v = dot(b); }
        use Winding as first  { angle: a }
        use Winding as second { angle: b }
        states      { dot(error) = first.current - second.current; }
    }
}

#[test]
fn states_of_instances() {
    assert_eq!(two_motors::State::NAMES, ["a", "b", "u", "v", "error", "first.current", "second.current"]);
    let winding = Winding { k: 0.5, R: 2.0, L: 0.1 };
    let motors = TwoMotors { J: 0.2, first: winding, second: winding }.prepare().unwrap();
    let mut state = two_motors::State::<f64> { u: 1.5, v: -1.0, ..Default::default() };
    (state.first.current, state.second.current) = (3.0, 4.0);
    let inputs =
        two_motors::Inputs { first: two_motors::first::Inputs { voltage: 12.0 }, ..Default::default() };
    let rate = motors.rhs(0.0, &state, &inputs);
    assert!((rate.u - 0.5 * 3.0 / 0.2).abs() < 1e-14 && (rate.v - 0.5 * 4.0 / 0.2).abs() < 1e-14);
    assert!((rate.first.current - (12.0 - 6.0 - 0.75) / 0.1).abs() < 1e-12, "{rate:?}");
    assert!((rate.second.current - (-8.0 + 0.5) / 0.1).abs() < 1e-12 && rate.error == -1.0);
    assert_eq!(motors.outputs(0.0, &state, &inputs).first.slope, rate.first.current);
}
