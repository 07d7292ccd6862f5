//! How long the declarations of these tests take to expand, and that none takes longer than a person waits.

use std::sync::LazyLock;
use std::time::{Duration, Instant};

use proc_macro2::{TokenStream, TokenTree};

use crate::large_systems::{LADEN_ELLIPSOID, TRICYCLE, snake};

/// The files with their declarations.
const FILES: [&str; 9] = [
    include_str!("balls.rs"),
    include_str!("bicycle.rs"),
    include_str!("hoop.rs"),
    include_str!("linkages.rs"),
    include_str!("pendulums.rs"),
    include_str!("rotations.rs"),
    include_str!("snakes.rs"),
    include_str!("tops.rs"),
    include_str!("vehicles.rs"),
];

/// Two seconds on a quiet machine of today; the tests run on others too.
const LONGEST: Duration = Duration::from_secs(6);

#[test]
fn every_system_expands_in_seconds() {
    // Tokens stay in their thread, and the machines that this runs on have two cores.
    let half = |part: usize| {
        let others = [TRICYCLE, LADEN_ELLIPSOID].map(|text| text.parse().unwrap());
        let all = FILES.iter().flat_map(|file| declarations(file.parse().unwrap())).chain(others);
        all.skip(part).step_by(2).for_each(expands);
    };
    std::thread::scope(|scope| {
        scope.spawn(|| half(1));
        half(0);
    });
}

/// The hoop's expansion once had 46,760 bytes; half of that is allowed, because code that is the same for every system is in the runtime.
/// 6,800 bytes are the hoop's program, and as many its report.
#[test]
fn the_expansion_of_a_hoop_is_short() {
    const MOST: usize = 23_380;
    let hoop: TokenStream = guen_benchmarks::hoop!(core::stringify).parse().unwrap();
    let bytes = guen_language::expand(hoop).to_string().len();
    assert!(bytes <= MOST, "{bytes}");
}

fn expands(declaration: TokenStream) {
    let name = declaration.clone().into_iter().filter_map(|token| match token {
        TokenTree::Ident(name) => Some(name.to_string()),
        _ => None,
    });
    let name = name.skip_while(|name| name != "system").nth(1).unwrap_or_default();
    let start = clock();
    let items = guen_language::expand(declaration).to_string();
    let time = clock() - start;
    assert!(!items.contains("compile_error") && items.contains("reported !"), "{name} does not expand");
    println!("{name:16} {:6.0} ms, {:4} kB", time.as_secs_f64() * 1e3, items.len() / 1024);
    assert!(time < LONGEST, "{name} took {time:?}");
}

/// A snake of ten links: twelve coordinates, ten constraints. Its brackets go on for longer than anybody waits, and its
/// equations of motion do not depend on them.
#[test]
fn a_long_snake_is_derived_though_not_wholly_classified() {
    const LINKS: usize = 10;
    let start = clock();
    let items = guen_language::expand(snake(LINKS).parse().unwrap()).to_string();
    let time = clock() - start;
    println!("snake of {LINKS}      {:6.0} ms", time.as_secs_f64() * 1e3);
    assert!(items.contains("were not followed to the end") && time < LONGEST, "{time:?}");
}

/// The time that this thread has run, where the system tells; elsewhere the time of day.
fn clock() -> Duration {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let spent = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = spent.as_deref().and_then(|text| text.split_whitespace().next()?.parse().ok());
    nanoseconds.map_or_else(|| START.elapsed(), Duration::from_nanos)
}

/// The groups after `mechanical_system!`.
fn declarations(source: TokenStream) -> Vec<TokenStream> {
    let tokens: Vec<TokenTree> = source.into_iter().collect();
    let found = tokens.windows(3).filter_map(|three| match three {
        [TokenTree::Ident(name), TokenTree::Punct(mark), TokenTree::Group(group)]
            if name == "mechanical_system" && mark.as_char() == '!' =>
        {
            Some(group.stream())
        }
        _ => None,
    });
    found.collect()
}
