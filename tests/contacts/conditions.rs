//! Contacts that close under a condition: a plate that ends, past which a particle falls.

use guen::hybrid::{HybridSystem, TransitionKind};
use guen::prelude::*;

mechanical_system! {
    /// A particle above a plate that ends at `x = 1`, and above a floor without end.
    system Ledge {
        constants { m > 0 = 2, depth = 3 }
        coordinates { x, z }
        parameters { ahead = dot(x); up = dot(z); }
        kinetic_energy = m/2*(ahead^2 + up^2);
        potential_energy = 10*m*z;
        contacts {
            plate: gap = z, when = 1 - x;
            floor: gap = z + depth;
        }
    }
}

#[test]
fn past_its_end_a_plate_lets_a_particle_through() {
    let elements = <ledge::Prepared as HybridSystem<4, 2, 2, 0>>::ELEMENTS;
    assert_eq!(elements.map(|element| element.conditional), [true, false]);
    let ledge = Ledge::default().prepare().unwrap();
    // At the height of the plate after 1/2, at the floor after 1: by `z = 5/4 - 5 t^2` to `z = -15/4`.
    let from = |ahead: f64| ledge::State { z: 1.25, ahead, ..Default::default() };
    let motion = ledge.simulate(&from(4.0), 0.0..2.0).unwrap();
    let [impact] = motion.transitions() else { panic!("{:?}", motion.transitions()) };
    assert!((impact.t - 0.85_f64.sqrt()).abs() < 1e-12, "{impact:?}");
    assert_eq!((impact.kind, impact.elements), (TransitionKind::Impact, [false, true]));
    let end = motion.end();
    assert!((end.z + 3.0).abs() < 1e-12 && (end.x - 8.0).abs() < 1e-12, "{end:?}");
    // Slower it lands on the plate, and stays on it past its end.
    let motion = ledge.simulate(&from(1.0), 0.0..2.0).unwrap();
    let [impact] = motion.transitions() else { panic!("{:?}", motion.transitions()) };
    assert!((impact.t - 0.5).abs() < 1e-12 && impact.elements == [true, false], "{impact:?}");
    assert!(motion.end().z.abs() < 1e-12 && (motion.end().x - 2.0).abs() < 1e-12, "{:?}", motion.end());
}

mechanical_system! {
    /// A particle that a force pushes, held by bolts that a switch, an impact or a reset releases.
    system Bolts {
        constants { m > 0 = 2, e in 0..1 = 0.5 }
        coordinates { a, b, c, d, f, z }
        parameters { of_a = dot(a); of_b = dot(b); of_c = dot(c); of_d = dot(d); of_f = dot(f); up = dot(z); }
        kinetic_energy = m/2*(of_a^2 + of_b^2 + of_c^2 + of_d^2 + of_f^2 + up^2);
        potential_energy = 10*m*z;
        states { dot(signal) = 0; }
        forces { m along of_a; m along of_b; m along of_c; m along of_d; m along of_f; }
        switches { on: t - 1; }
        contacts {
            floor: gap = z, restitution = e;
            first: latch = a, release = on;
            second: latch = b, release = 2*on - 1 + t/4;
            third: latch = c, release = up;
            fourth: latch = d, release = signal - 1/2;
            // Above zero from the start, so that it rises at none of these times.
            fifth: latch = f, release = 9 - t;
        }
        resets { kick: t - 3/2 rises, signal = 1; }
    }
}

#[test]
fn a_latch_is_released_where_its_release_jumps_above_zero() {
    let bolts = Bolts::default().prepare().unwrap();
    // At the floor after two seconds, as the particle above it starts with no velocity.
    let start = bolts::State { z: 20.0, ..Default::default() };
    let motion = bolts.simulate(&start, 0.0..3.0).unwrap();
    let found: Vec<_> = motion
        .transitions()
        .iter()
        .map(|transition| (transition.t, transition.kind, transition.elements))
        .collect();
    let [released, reset, impact, ..] = found[..] else { panic!("{found:?}") };
    assert_eq!(
        (released.1, released.2),
        (TransitionKind::Released, [false, true, true, false, false, false])
    );
    assert_eq!((reset.1, reset.2), (TransitionKind::Reset, [false, false, false, false, true, false]));
    assert_eq!((impact.1, impact.2), (TransitionKind::Impact, [true, false, false, true, false, false]));
    for (found, t) in [(released.0, 1.0), (reset.0, 1.5), (impact.0, 2.0)] {
        assert!((found - t).abs() < 1e-12, "{found}");
    }
    // A unit of acceleration from then on.
    let end = motion.end();
    assert_eq!((end.f, end.of_f), (0.0, 0.0));
    for (place, t) in [(end.a, 1.0), (end.b, 1.0), (end.d, 1.5), (end.c, 2.0)] {
        let since: f64 = 3.0 - t;
        assert!((place - since * since / 2.0).abs() < 1e-11, "{end:?}");
    }
}
