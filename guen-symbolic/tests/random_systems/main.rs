//! Random mechanical systems: what is derived against Lagrange's equations with multipliers and duals.

mod arms;
mod brackets;
mod closure;
mod declared;
mod derived;
mod draw;
mod energies;
mod invariance;
mod jet;
mod multipliers;
mod poincare;
mod rotating;
mod rows;
mod scalar;
mod sweep;
mod system;
mod tape;
mod trains;
mod trees;
mod words;

use closure::Shapes;
use sweep::Tally;

/// Systems drawn in every run; `GUEN_ROUNDS` asks for others, as `.ci/run` does in an optimised build.
const DRAWN: u64 = 60;

/// How many are drawn.
fn rounds(quick: u64) -> u64 {
    std::env::var("GUEN_ROUNDS").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(quick)
}
/// The machines that this runs on have two cores.
const THREADS: u64 = 2;

#[test]
fn equations_of_drawn_systems_are_those_with_multipliers() {
    let rounds = rounds(DRAWN);
    let tallies: Vec<Tally> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS)
            .map(|thread| {
                scope.spawn(move || {
                    let (mut tally, mut shapes) = (Tally::default(), Shapes::default());
                    for seed in (thread..rounds).step_by(THREADS as usize) {
                        tally.examine(seed, &mut shapes);
                    }
                    tally
                })
            })
            .collect();
        threads.into_iter().map(|thread| thread.join().expect("no comparison fails")).collect()
    });
    let tally = tallies.into_iter().fold(Tally::default(), Tally::joined);
    let rejected = tally.drawn - tally.compared();
    let rate = 100.0 * rejected as f64 / tally.drawn as f64;
    println!(
        "drawn {}, compared {}, rejected {rejected} ({rate:.1} percent):",
        tally.drawn,
        tally.compared()
    );
    println!("  condition above 1e8: {}, singular: {}", tally.ill_conditioned, tally.singular);
    println!("differs from zero in systems: {:?}", tally.features);
    println!("largest differences, allowed 1e-12: {:?}", tally.worst);
    println!("signs of (2.7) turned, seen in systems:");
    for (name, count) in poincare::NAMES.iter().zip(tally.turned) {
        println!("  {name}: {count}");
    }
    assert!(
        tally.compared() as u64 >= rounds - rounds / 12,
        "few are left when ill-conditioned ones are left out"
    );
    // Systems in which each feature must differ from zero.
    let shown = rounds as usize / 11;
    assert!(rate < 20.0, "too many draws are rejected");
    for name in [
        "C_0st",
        "C_0sv",
        "C_rvt",
        "linear part of T°",
        "constant part of T°",
        "integrable row, not exact",
        "integrable only in combination",
        "rates in other words",
    ] {
        assert!(tally.features[name] >= shown, "{name} differs from zero in too few systems");
    }
    for (name, count) in poincare::NAMES.iter().zip(tally.turned) {
        assert!(count >= shown, "the sign of {name} is seen in too few systems");
    }
}
