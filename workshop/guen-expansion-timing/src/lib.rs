//! How long the expansion of a declaration takes inside of a compiler: a procedural macro, because there its tokens are the
//! compiler's own, and `proc_macro2` works otherwise than outside. The example `expansion_time` calls it.
#![forbid(unsafe_code)]

use std::time::{Duration, Instant};

use guen_language::diagnostics::collect;
use guen_language::{derive, emit, model, parse};
use proc_macro::TokenStream;

#[path = "../../guen-benchmarks/src/processor.rs"]
mod processor;

/// A system is expanded this often, but not again once it took this long; once only where the compiler runs with `GUEN_ONCE`.
const REPEATS: usize = 15;
const LONG: Duration = Duration::from_secs(5);

/// Expands a declaration several times and prints the milliseconds: the medians of the stages parse, resolve, derive and emit,
/// then the least of the sums, and the mean time on a processor. Its own expansion is nothing.
#[proc_macro]
pub fn stages(tokens: TokenStream) -> TokenStream {
    let mut runs: Vec<[f64; 4]> = Vec::new();
    let begin = Instant::now();
    let processor = processor::processor_time();
    let repeats = if std::env::var_os("GUEN_ONCE").is_some() { 1 } else { REPEATS };
    while runs.len() < repeats && (runs.is_empty() || begin.elapsed() < LONG) {
        match staged(tokens.clone()) {
            Some(times) => runs.push(times),
            None => return guen_language::expand(tokens.into()).into(),
        }
    }
    let mut least = f64::INFINITY;
    for run in &runs {
        least = least.min(run.iter().sum());
    }
    for stage in 0..4 {
        let mut times: Vec<f64> = runs.iter().map(|run| run[stage]).collect();
        times.sort_by(f64::total_cmp);
        print!("{} ", times[times.len() / 2]);
    }
    let processor = (processor::processor_time() - processor) * 1e3 / runs.len() as f64;
    println!("{least} {processor}");
    TokenStream::new()
}

/// What `expand` does, with a clock between the stages; nothing for a declaration that has a fault.
fn staged(tokens: TokenStream) -> Option<[f64; 4]> {
    let start = Instant::now();
    let (declaration, report) = parse::parse(tokens.into());
    let declaration = declaration.filter(|_| report.is_empty())?;
    let parsed = Instant::now();
    let (model, _) = collect(|faults| model::resolve(&declaration, faults));
    let model = model?;
    let resolved = Instant::now();
    let (derived, _) = collect(|faults| derive::derive(model, faults));
    let derived = derived?;
    let done = Instant::now();
    // With what hands the tokens to the compiler.
    let items = TokenStream::from(emit::emit(derived));
    let end = Instant::now();
    drop(items);
    let times = [parsed - start, resolved - parsed, done - resolved, end - done];
    Some(times.map(|time| time.as_secs_f64() * 1e3))
}
