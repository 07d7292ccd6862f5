//! One direction of a slip along a line as a state of its own.

use guen::hybrid::HybridCause;
use guen::mechanical_system;

mechanical_system! {
    /// A block that is pulled back only.
    pub system Pulled {
        constants { m > 0 = 2, g = 10, mu = 1/2 }
        inputs { pull }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        particles { m at vec(x, z); }
        gravity = vec(0, -g);
        forces { -pull along u; }
        contacts { floor: gap = z, slip = u, friction = mu; }
        modes { floor: stick, slip; never floor.slip+; }
        scene Back { modes { floor: stick, slip-; } }
    }
}

#[test]
fn a_direction_that_is_left_out_is_excluded() {
    use pulled::{Floor, Inputs, MODES, Mode, State};
    assert_eq!(MODES, [Mode { floor: Floor::Stick }, Mode { floor: Floor::SlipBackward }]);
    assert_eq!(pulled::back::MODES, MODES);
    let told = "floor is a contact with friction along a line: stick, slip-";
    assert!(pulled::REPORT.lines("Contacts").contains(&told));
    let block = Pulled::default().prepare().unwrap();
    // Friction takes 10 of 14: 2 of acceleration.
    let motion = block.driven(Inputs { pull: 14.0 }).simulate(&State::default(), 0.0..3.0).unwrap();
    assert!((motion.end().x + 9.0).abs() < 1e-12 && motion.mode_at(3.0) == MODES[1]);
    let pushed = block.driven(Inputs { pull: -14.0 }).simulate(&State::default(), 0.0..3.0).unwrap_err();
    assert!(matches!(pushed.error.cause, HybridCause::Excluded { .. }), "{pushed}");
}
