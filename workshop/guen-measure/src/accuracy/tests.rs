//! Simplification may not lose accuracy against the raw program, and errors stay below stated bounds.

use super::measure;
use guen_benchmarks::{Subject, Visitor, visit_all};

/// Beyond this many operations the reference takes longer than a test should.
const LARGEST: u32 = 350;
/// Up to here the program by hand is a bound as well. In chains it is another method, with smaller errors.
const SMALL: u32 = 100;
/// Both programs round differently, so the largest error of one set of states may exceed the other's by chance.
const CHANCE: f64 = 2.0;
/// Errors of a few roundings are none: units of `2^-53`.
const ROUNDINGS: f64 = 8.0;
const UNIT: f64 = 0.5 * f64::EPSILON;

struct Check(usize);

impl Visitor for Check {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        let operations = S::COST.total();
        if operations > LARGEST {
            return;
        }
        self.0 += 1;
        for (errors, kind) in measure::errors::<S, N>(60).into_iter().zip(["random", "near singular"]) {
            let measure::Errors { declared, raw, by_hand } = errors;
            let best = if operations <= SMALL { raw.min(by_hand) } else { raw };
            let best = CHANCE * best;
            assert!(declared <= best.max(ROUNDINGS * UNIT), "{} at {kind} states: {errors:?}", S::NAME);
        }
    }
}

#[test]
fn declared_systems_are_as_accurate_as_the_raw_program_and_small_ones_as_the_one_by_hand() {
    let mut check = Check(0);
    visit_all(&mut check);
    assert!(check.0 >= 12, "{} systems", check.0);
}
