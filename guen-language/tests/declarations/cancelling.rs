//! Sums of which nothing is left while programs are built.

use crate::common::derived;

/// Terms that cancel while common factors are taken out of a sum leave nothing between the brackets.
#[test]
fn factors_of_terms_that_cancel_are_no_sums() {
    let text = "pub system Cancelling {
        coordinates { x0, x1, x2, x3, x4, x5, x6 }
        let y = x5 + abs(x3)*x3*x4;
        constraints {
            c0: dot(x4) - x0*dot(x2) + y*dot(x1) = 0;
            c1: (dot(x6) - x0*dot(y) + x1*dot(x2)) + t^3*(dot(x4) - x0*dot(x2) + y*dot(x1)) = 0;
            c2: dot(x3) - x0*dot(x1) + x2*dot(y) = 0;
        }
        kinetic_energy = 1/2*(dot(x0)^2 + dot(x1)^2 + dot(x2)^2 + dot(x3)^2 + dot(x4)^2 + dot(x5)^2 + dot(x6)^2);
    }";
    derived(text, |derived| assert_eq!(derived.system.derivation.closure.growth, [4, 7]));
}
