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
