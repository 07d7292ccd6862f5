//! Declarations derived, and the programs that were made of them evaluated.

use std::sync::atomic::{AtomicUsize, Ordering};

use guen_language::derive::{DerivedLevel, DerivedSystem, derive};
use guen_language::diagnostics::collect;
use guen_language::{model, parse};
use guen_symbolic::{REFUTED, SymbolId, evaluate_function, evaluate_prepare, formulation_names};

/// How many a test draws: so many in every run, and more with `GUEN_ROUNDS`, as `.ci/run` asks for them in an optimised build.
pub fn rounds(quick: u64) -> u64 {
    std::env::var("GUEN_ROUNDS").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(quick)
}

/// Applies `look` to every item in two threads and returns the results in the order of the items. A thread that is done with
/// one item takes the next, because some take much longer than others.
pub fn by_two_threads<I: Sync, T: Send>(all: &[I], look: impl Fn(&I) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let run = || -> Vec<(usize, T)> {
        let mine = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)));
        mine.map_while(|place| all.get(place).map(|one| (place, look(one)))).collect()
    };
    let mut found = std::thread::scope(|scope| {
        let other = scope.spawn(run);
        let mut own = run();
        own.extend(other.join().expect("the other thread"));
        own
    });
    found.sort_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, found)| found).collect()
}

/// Looks at what follows from a declaration in which nothing is wrong.
pub fn derived<T>(text: &str, look: impl FnOnce(&DerivedSystem<'_>) -> T) -> T {
    derived_without(text, |_| false, look)
}

/// Looks at what follows from a declaration in which nothing is wrong where some formulations are not tried.
pub fn derived_without<T>(
    text: &str,
    is_left_out: impl Fn(&str) -> bool,
    look: impl FnOnce(&DerivedSystem<'_>) -> T,
) -> T {
    let (declaration, report) = parse::parse(text.parse().expect("tokens"));
    assert!(report.is_empty(), "{}\n{text}", report.to_compile_errors());
    let declaration = declaration.expect("a declaration");
    let (derived, report) = collect(|faults| {
        let mut model = model::resolve(&declaration, faults)?;
        formulation_names().filter(|name| is_left_out(name)).for_each(|name| model.bench.leave_out(name));
        derive(model, faults)
    });
    assert!(report.is_empty(), "{}\n{text}", report.to_compile_errors());
    let derived = derived.expect("a derivation");
    let declined = &derived.system.derivation.declined;
    assert!(declined.iter().all(|(_, reason)| *reason != REFUTED), "{declined:?}\n{text}");
    look(&derived)
}

/// The messages about a declaration whose grammar is right.
pub fn fault_messages(text: &str) -> Vec<String> {
    let (declaration, report) = parse::parse(text.parse().expect("tokens"));
    assert!(report.is_empty(), "{text}\n{report}");
    let declaration = declaration.expect("a declaration");
    let (_, report) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults).map(|_| ()));
    report.faults().iter().map(|fault| fault.message().to_owned()).collect()
}

/// What a program of a level computes where its symbols have these values; `None` if there is none of that name.
#[allow(dead_code, reason = "some tests look at costs only")]
pub fn evaluated(level: &DerivedLevel, name: &str, value: impl Fn(SymbolId) -> f64) -> Option<Vec<f64>> {
    let programs = &level.programs;
    let place = programs.functions.iter().position(|own| own.name == name)?;
    Some(evaluate_function(programs, place, &evaluate_prepare(programs, &value), &value))
}
