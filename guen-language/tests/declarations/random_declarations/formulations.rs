//! For how many declarations drawn at random each formulation is needed: the operations of the rates without it.
//!
//! ```text
//! GUEN_ROUNDS=500 cargo test --release -p guen-language --test declarations without_each -- --ignored --nocapture
//! ```

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use guen_language::derive::function::RHS;
use guen_language::diagnostics::collect;
use guen_language::{derive, model, parse};
use guen_symbolic::formulation_names;

use super::{grammar, mechanisms};
use crate::common::{by_two_threads, rounds};

/// The operations of the rates without some formulations and the formulations that gave rates; `None` where the declaration is refused.
fn cost(text: &str, is_left_out: impl Fn(&str) -> bool) -> Option<(u32, Vec<&'static str>)> {
    let (declaration, _) = parse::parse(text.parse().ok()?);
    let declaration = declaration?;
    let (derived, report) = collect(|faults| {
        let mut model = model::resolve(&declaration, faults)?;
        formulation_names().filter(|name| is_left_out(name)).for_each(|name| model.bench.leave_out(name));
        derive::derive(model, faults)
    });
    if !report.is_empty() {
        return None;
    }
    let derived = derived?;
    let mut names: Vec<&str> =
        derived.system.derivation.formulations.iter().map(|found| found.name).collect();
    names.dedup();
    Some((derived.system.program(RHS)?.cost.operations(), names))
}

/// The operations with all formulations, and without one of them.
type Pair = (u32, Option<u32>);

/// The operations with all formulations, and without each that gave rates.
type Counts = (u32, Vec<(&'static str, Option<u32>)>);

fn counts(text: &str) -> Option<Counts> {
    let (whole, names) = cost(text, |_| false)?;
    let without = |name: &'static str| (name, cost(text, |other| other == name).map(|(count, _)| count));
    Some((whole, names.into_iter().map(without).collect()))
}

/// A kind of declarations, and how one is drawn.
type Kind = (&'static str, fn(u64) -> String);

#[test]
#[ignore = "a measurement, of some minutes for 500 of each kind"]
fn operations_without_each_formulation() {
    let seeds: Vec<u64> = (0..rounds(20)).collect();
    let kinds: [Kind; 2] = [
        ("over expressions", grammar::with_functions),
        ("of bodies", |seed| mechanisms::drawn(seed).text(|_| false)),
    ];
    for (kind, text) in kinds {
        let found = by_two_threads(&seeds, |seed| {
            catch_unwind(AssertUnwindSafe(|| counts(&text(*seed)))).ok().flatten()
        });
        let accepted: Vec<&Counts> = found.iter().flatten().collect();
        let sum: u32 = accepted.iter().map(|(whole, _)| whole).sum();
        println!("{} declarations {kind}, {sum} operations", accepted.len());
        let mut by_name: BTreeMap<&str, Vec<Pair>> = BTreeMap::new();
        for (whole, without) in accepted {
            without.iter().for_each(|(name, rest)| by_name.entry(name).or_default().push((*whole, *rest)));
        }
        for (name, counts) in by_name {
            let both = counts.iter().filter_map(|(whole, rest)| Some((*whole, (*rest)?)));
            let costlier: Vec<(u32, u32)> = both.clone().filter(|(whole, rest)| rest > whole).collect();
            let cheaper: Vec<(u32, u32)> = both.filter(|(whole, rest)| rest < whole).collect();
            let lost = counts.iter().filter(|(_, rest)| rest.is_none()).count();
            let sum =
                |pairs: &[(u32, u32)]| pairs.iter().map(|(whole, rest)| whole.abs_diff(*rest)).sum::<u32>();
            let most =
                costlier.iter().map(|(whole, rest)| f64::from(*rest) / f64::from(*whole)).fold(1.0, f64::max);
            println!(
                "{name}: rates of {}; without it {} cost more, {} operations in all, at most {most:.2} times; {} cost less, {}; {lost} refused",
                counts.len(),
                costlier.len(),
                sum(&costlier),
                cheaper.len(),
                sum(&cheaper),
            );
        }
    }
}
