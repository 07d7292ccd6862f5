//! How many operations a system takes without each of the formulations that solve it, and by each alone.
//!
//! ```text
//! cargo run --release -p guen-measure --bin formulations              # the systems of `tests/costs.txt`
//! cargo run --release -p guen-measure --bin formulations -- chain     # those whose names begin so
//! ```
//!
//! A row has the operations of the right-hand side as they are, then without each formulation that has rates to give and whose absence
//! changes them, then by each of them alone. Where none has rates to give the equations are solved as they are stated. Below stand the
//! formulations without which nothing changes in any of these systems.

use std::collections::BTreeMap;
use std::process::ExitCode;

use guen_benchmarks::chains::{Angles, declaration};
use guen_benchmarks::{Subject, Visitor, arms, bars, robots, visit_all};
use guen_language::derive::function::RHS;
use guen_language::diagnostics::collect;
use guen_language::{derive, model, parse};
use guen_symbolic::formulation_names;

#[path = "../../../examples/common/arguments.rs"]
mod arguments;
#[allow(dead_code, reason = "the others belong to other programs")]
mod large_systems;
#[path = "some_scenes.rs"]
#[allow(dead_code, reason = "the scenes belong to other programs")]
mod scenes;

/// Systems with names.
struct Systems(Vec<(String, String)>);

impl Visitor for Systems {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        self.0.push((S::NAME.to_owned(), S::DECLARATION.to_owned()));
    }
}

impl Systems {
    fn all() -> Self {
        let mut systems = Systems(Vec::new());
        visit_all(&mut systems);
        let in_file = |source: &str| scenes::declaration(source).to_string();
        let others = [
            ("chain40", declaration("Chain", 40, Angles::Absolute)),
            ("joints20", declaration("Chain", 20, Angles::Relative)),
            ("joints40", declaration("Chain", 40, Angles::Relative)),
            ("bicycle", in_file(include_str!("../../../tests/spatial/bicycle.rs"))),
            ("snake6", large_systems::snake(6)),
            ("rattleback", guen_benchmarks::rattleback!(stringify).to_owned()),
            ("hoop-quat", guen_benchmarks::quaternion_hoop!(stringify).to_owned()),
            ("four-bar", in_file(include_str!("../../../tests/spatial/linkages.rs"))),
            ("arm4", arms::declaration("Arm", &arms::AXES[..4])),
            ("arm5", arms::declaration("Arm", &arms::AXES[..5])),
            ("quadruped", robots::quadruped()),
            ("biped-quat", robots::biped_on_quaternion()),
            ("rods2", robots::rods(2, false)),
            ("rods4", robots::rods(4, false)),
            ("rods4-rel", robots::rods(4, true)),
            ("rods2-pins", robots::pinned_rods(2)),
            ("rods3-pins", robots::pinned_rods(3)),
            ("rods3-hinges", robots::hinged_rods(3)),
            ("bars2", bars::in_angles(2)),
            ("bars2-xy", bars::in_points(2)),
            ("bars10", bars::in_angles(10)),
            ("bars10-xy", bars::in_points(10)),
            ("held7", robots::held()),
            ("crane4", robots::crane(4)),
            ("crane12", robots::crane(12)),
        ];
        systems.0.extend(others.map(|(name, text)| (name.to_owned(), text)));
        systems
    }
}

/// The operations of a right-hand side, and the formulations that had rates to give; `None` where it cannot be derived so.
fn cost(text: &str, is_left_out: impl Fn(&str) -> bool) -> Option<(u32, Vec<&'static str>)> {
    let (declaration, _) = parse::parse(text.parse().expect("these are tokens"));
    let declaration = declaration.expect("this is a declaration");
    let (derived, _) = collect(|faults| {
        let mut model = model::resolve(&declaration, faults)?;
        formulation_names().filter(|name| is_left_out(name)).for_each(|name| model.bench.leave_out(name));
        derive::derive(model, faults)
    });
    let derived = derived?;
    let names = derived.system.derivation.formulations.iter().map(|found| found.name);
    let mut names: Vec<&str> = names.collect();
    names.dedup();
    let cost = derived.system.program(RHS)?.cost;
    Some((cost.operations(), names))
}

fn main() -> ExitCode {
    let about = "How many operations a system takes without each of the formulations that solve it.";
    let start = |word: &str| Some(word.to_owned());
    let meaning = "the beginning of the names of the systems; all by default";
    let start = match arguments::read(about, "NAME", meaning, String::new(), start) {
        Ok(start) => start,
        Err(status) => return status,
    };
    let shown = |cost: Option<(u32, Vec<&str>)>| cost.map_or("none".to_owned(), |(cost, _)| cost.to_string());
    let mut wins: BTreeMap<&str, usize> = formulation_names().map(|name| (name, 0)).collect();
    for (name, text) in Systems::all().0 {
        if !name.starts_with(&start) {
            continue;
        }
        let Some((whole, found)) = cost(&text, |_| false) else {
            println!("{name}: cannot be derived");
            continue;
        };
        let (mut without, mut alone) = (Vec::new(), Vec::new());
        for formulation in &found {
            let rest = cost(&text, |other| other == *formulation);
            if rest.as_ref().is_none_or(|(rest, _)| *rest != whole) {
                without.push(format!("{formulation} {}", shown(rest)));
                *wins.entry(formulation).or_default() += 1;
            }
            alone.push(format!("{formulation} {}", shown(cost(&text, |other| other != *formulation))));
        }
        let without = if without.is_empty() { "the same".to_owned() } else { without.join(", ") };
        println!("{name}: {whole}; without {without}; by {} alone", alone.join(", "));
    }
    let idle: Vec<&str> = wins.iter().filter(|(_, wins)| **wins == 0).map(|(name, _)| *name).collect();
    println!(
        "\nnothing changes without: {}",
        if idle.is_empty() { "none".to_owned() } else { idle.join(", ") }
    );
    ExitCode::SUCCESS
}
