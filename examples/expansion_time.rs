//! How long the macro takes: the expansion of every example system, stage by stage.
//!
//! ```text
//! cargo run --example expansion_time
//! ```
//!
//! Without `--release`: cargo builds procedural macros without optimisation, in a user's dev profile and in the release
//! profile too, so these are the times that a user waits. (Only the tokens come from this program and not from the
//! compiler.) The declarations of the examples are cut out of their files; beside them stand the chains of the benchmarks,
//! with absolute angles, and the largest systems of the tests: vehicles, snakes, contacts with a square root, moving
//! belts, prescribed motions. Systems with five scenes stand below themselves without: what scenes cost while the macro
//! runs. In the program a scene that is not used costs nothing, for what is emitted is generic.
//!
//! The times of the stages and their sum are medians of several expansions, followed by the shares of deriving and
//! emitting in percent. The last column is the mean time on a processor, which depends less on what else the machine
//! does; it is known on Linux only.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use guen_benchmarks::chains::{Angles, declaration as declaration_of_chain};
use guen_benchmarks::timing::processor_time;
use guen_language::diagnostics::collect;
use guen_language::{derive, emit, expand, model, parse};
use guen_study::{Progress, Table};
use proc_macro2::{TokenStream, TokenTree};

#[path = "../tests/systems/large.rs"]
mod large;
#[path = "../tests/systems/scenes.rs"]
mod scenes;

/// The files whose first declarations are expanded.
const FILES: [(&str, &str); 4] = [
    ("hoop", include_str!("hoop.rs")),
    ("appell", include_str!("appell.rs")),
    ("chaplygin_sled", include_str!("chaplygin_sled.rs")),
    ("bicycle", include_str!("../tests/spatial/bicycle.rs")),
];
const CHAINS: [usize; 4] = [2, 5, 10, 20];
const SNAKES: [usize; 3] = [5, 7, 10];
/// A system is expanded this often, but not again once it took this long.
const REPEATS: usize = 15;
const LONG: Duration = Duration::from_secs(5);

/// The times of the stages: parse, resolve, derive, emit.
type Stages = [Duration; 4];

fn main() -> ExitCode {
    if !cfg!(debug_assertions) {
        println!(
            "this is an optimised build, and the compiler's macro is none: see `cargo run --example expansion_time`\n"
        );
    }
    let mut systems: Vec<(String, TokenStream)> = Vec::new();
    for (name, source) in FILES {
        let tokens = scenes::declaration(source);
        systems.push((name.to_owned(), tokens.clone()));
        if let Some((_, five)) = scenes::FIVE.iter().find(|(owner, _)| *owner == name) {
            systems.push(("  with scenes".to_owned(), scenes::added(tokens, five)));
        }
    }
    let mut add = |name: String, text: &str| systems.push((name, text.parse().expect("these are tokens")));
    CHAINS.iter().for_each(|&links| {
        add(format!("chain of {links}"), &declaration_of_chain("Chain", links, Angles::Absolute));
    });
    SNAKES.iter().for_each(|&links| add(format!("snake of {links}"), &large::snake(links)));
    add("tricycle".to_owned(), large::TRICYCLE);
    add("ellipsoid".to_owned(), large::LADEN_ELLIPSOID);

    let mut healthy = true;
    let mut names = vec!["system"];
    let mut table = Table::new(&[
        "tokens",
        "emitted",
        "parse",
        "resolve",
        "derive",
        "emit",
        "sum in ms",
        "derive %",
        "emit %",
        "on processor",
    ])
    .digits(3);
    let mut progress = Progress::new(0.0, systems.len() as f64);
    for (k, (name, tokens)) in systems.iter().enumerate() {
        progress.at(k as f64);
        let (count, stages, processor) = measured(tokens);
        let [first, second] = [(); 2].map(|()| expand(tokens.clone()).to_string());
        if first != second {
            eprintln!("{name}: two expansions differ");
            healthy = false;
        }
        let milliseconds = stages.map(|stage| stage.as_secs_f64() * 1e3);
        let [_, _, derive, emit] = milliseconds;
        let sum: f64 = milliseconds.into_iter().sum();
        let shares = [derive, emit].map(|time| 100.0 * time / sum);
        let sizes = [size(tokens.clone()) as f64, count as f64];
        table.row(&[&sizes[..], &milliseconds, &[sum], &shares, &[processor]].concat());
        names.push(name);
    }
    progress.finish();
    // The names stand beside the table, whose cells are numbers.
    let text = table.to_string();
    let mut names = names.into_iter();
    for (index, line) in text.lines().enumerate() {
        let name = if index == 1 { "--------------" } else { names.next().unwrap_or_default() };
        println!("{name:14}  {line}");
    }
    if healthy { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The number of tokens emitted, the medians of the stages, and the mean time on a processor in
/// milliseconds.
fn measured(tokens: &TokenStream) -> (usize, Stages, f64) {
    let mut runs: Vec<Stages> = Vec::new();
    let mut emitted = 0;
    let begin = Instant::now();
    let processor = processor_time();
    while runs.len() < REPEATS && (runs.is_empty() || begin.elapsed() < LONG) {
        let (tokens, stages) = staged(tokens.clone());
        emitted = size(tokens);
        runs.push(stages);
    }
    let median = |stage: usize| {
        let mut times: Vec<Duration> = runs.iter().map(|run| run[stage]).collect();
        times.sort();
        times[times.len() / 2]
    };
    let processor = (processor_time() - processor) * 1e3 / runs.len() as f64;
    (emitted, std::array::from_fn(median), processor)
}

/// What `expand` does, with a clock between the stages.
fn staged(tokens: TokenStream) -> (TokenStream, Stages) {
    let start = Instant::now();
    let (declaration, report) = parse::parse(tokens);
    assert!(report.is_empty(), "{report}");
    let declaration = declaration.expect("there is a declaration where there is no fault");
    let parsed = Instant::now();
    let (model, report) = collect(|faults| model::resolve(&declaration, faults));
    assert!(report.is_empty(), "{report}");
    let model = model.expect("there is a model where there is no fault");
    let resolved = Instant::now();
    let (derived, report) = collect(|faults| derive::derive(model, faults));
    assert!(report.is_empty(), "{report}");
    let derived = derived.expect("there is a derivation where there is no fault");
    let done = Instant::now();
    let items = emit::emit(derived);
    (items, [parsed - start, resolved - parsed, done - resolved, done.elapsed()])
}

/// The number of tokens, those in groups included.
fn size(tokens: TokenStream) -> usize {
    let inside = |token| match token {
        TokenTree::Group(group) => 1 + size(group.stream()),
        _ => 1,
    };
    tokens.into_iter().map(inside).sum()
}
