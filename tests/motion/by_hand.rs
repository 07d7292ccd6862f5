//! The benchmarks' systems as declared and as written by hand.

use guen::System;
use guen_benchmarks::{ByHand, Random, Subject, Visitor, visit_all};

/// What the macro derived against what was derived on paper. Rates of a state agree within roundings, of which
/// the largest part is the condition of the mass matrix.
struct Agreement;

impl Visitor for Agreement {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        S::all_by_hand(&mut Against { declared: S::declared(), name: S::NAME, state: S::state });
    }
}

struct Against<D, const N: usize> {
    name: &'static str,
    declared: D,
    state: fn(&mut Random) -> [f64; N],
}

impl<D: System<f64, N>, const N: usize> ByHand<N> for Against<D, N> {
    fn program(&mut self, note: &str, program: impl System<f64, N>) {
        let mut random = Random::new(4);
        for _ in 0..200 {
            let state = (self.state)(&mut random);
            let (ours, hand) = (self.declared.rhs(0.0, &state), program.rhs(0.0, &state));
            let size = hand.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
            for i in 0..N {
                let error = (ours[i] - hand[i]).abs();
                assert!(error <= 1e-9 * size, "{} {note}: rate {i}: {} or {}", self.name, ours[i], hand[i]);
            }
        }
    }
}

#[test]
fn declared_systems_agree_with_programs_written_by_hand() {
    visit_all(&mut Agreement);
}
