//! The operations of every benchmark system are golden values: `tests/costs.txt`. A change of the optimiser that moves a
//! count, up or down, has to change that file, where a reviewer sees it.
//!
//! ```text
//! GUEN_BLESS=1 cargo test -p guen-tests --test golden      # writes the file anew
//! ```

use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

use proc_macro2::{TokenStream, TokenTree};

use guen::Cost;
use guen_benchmarks::chains::{Angles, declaration};
use guen_benchmarks::{Subject, Visitor, arms, bars, robots, visit_all};
use guen_language::derive::Derived;
use guen_language::derive::function::{MASS_FORM, MOMENTA, REACTIONS, RHS};

const HEADER: &str = "\
# Operations of the benchmark systems, written by `GUEN_BLESS=1 cargo test -p guen-tests --test golden`.
# One evaluation of the right-hand side, then the preparation of its constants: additions, negations,
# multiplications, divisions, roots, calls. With an apostrophe: the carried form. With `-0`: no sign is promised
# of any constant. With a slash: momenta, mass matrix with bias, reactions, where they are large.
";

const HEADER_OF_LARGE: &str = "\
# Operations of large systems, written by `GUEN_BLESS=1 cargo test -p guen-tests --test golden -- --ignored`.
# As in costs.txt.
";

/// Momenta, mass forms and reactions of more operations have a line.
const LARGE: u32 = 200;

/// Chains of so many links are not compiled.
const LONG: usize = 40;

/// One line for each system: its name, then two programs of six counts.
struct Lines(String);

impl Visitor for Lines {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        let _ = writeln!(self.0, "{:11} {}  |{}", S::NAME, counts(S::COST), counts(S::PREPARE_COST));
    }
}

/// The same for the carried forms, whose programs are derived here: no call is left in any of them.
struct CarriedLines(String);

impl Visitor for CarriedLines {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        let end = S::DECLARATION.rfind('}').unwrap();
        let text = format!("{} provide carried; }}", &S::DECLARATION[..end]);
        let (rates, prepare) = derived(S::NAME, &text, |derived| {
            let level = derived.system.carried.as_ref().unwrap();
            let rates = level.program(RHS).unwrap().cost;
            assert_eq!((rates.sines, rates.calls), (0, 0), "{}", S::NAME);
            (counts(cost(rates)), counts(cost(level.programs.prepare_cost)))
        });
        let _ = writeln!(self.0, "{:11} {rates}  |{prepare}", format!("{}'", S::NAME));
    }
}

/// What is derived from a declaration while the test runs.
fn derived<T>(name: &str, text: &str, look: impl FnOnce(&Derived<'_>) -> T) -> T {
    let (declaration, _) = guen_language::parse::parse(text.parse().unwrap());
    let declaration = declaration.unwrap();
    let (derived, report) = guen_language::diagnostics::collect(|faults| {
        let model = guen_language::model::resolve(&declaration, faults)?;
        guen_language::derive::derive(model, faults)
    });
    assert!(report.is_empty(), "{name}: {:?}", report.to_compile_errors().to_string());
    look(&derived.unwrap())
}

/// Chains that are longer than those that are compiled, and chains of which no constant has a bound.
fn chains() -> String {
    let mut lines = String::new();
    for (angles, family, lengths) in
        [(Angles::Absolute, "chain", &[5, 10, 20, 40][..]), (Angles::Relative, "joints", &[5, 10, 20])]
    {
        for links in lengths {
            let text = declaration("Chain", *links, angles);
            if *links >= LONG {
                lines.push_str(&row(&format!("{family}{links}"), &text));
            }
            lines.push_str(&row(&format!("{family}{links}-0"), &text.replace(" > 0", "")));
        }
    }
    lines
}

/// The lines of a declaration that is derived here: of its rates and their preparation, then of what is large beside them.
fn row(name: &str, text: &str) -> String {
    derived(name, text, |derived| {
        let program = |function: &str| derived.system.program(function).map(|program| program.cost);
        let [rates, preparation] =
            [program(RHS).unwrap(), derived.system.programs.prepare_cost].map(|count| counts(cost(count)));
        let mut lines = format!("{name:11} {rates}  |{preparation}\n");
        for function in [MOMENTA, MASS_FORM, REACTIONS] {
            if let Some(count) = program(function).filter(|count| count.operations() > LARGE) {
                let _ = writeln!(lines, "{:21} {}  |", format!("{name}/{function}"), counts(cost(count)));
            }
        }
        lines
    })
}

/// Vehicles, linkages, arms and robots that are not compiled here.
fn mechanisms() -> String {
    let in_file = |source: &str| declared(source.parse().unwrap()).to_string();
    let rows = [
        ("bicycle", in_file(include_str!("../spatial/bicycle.rs"))),
        ("snake6", crate::large::snake(6)),
        ("rattleback", guen_benchmarks::rattleback!(stringify).to_owned()),
        ("hoop-quat", guen_benchmarks::quaternion_hoop!(stringify).to_owned()),
        ("four-bar", in_file(include_str!("../spatial/linkages.rs"))),
        ("arm4", arms::declaration("Arm", &AXES[..4])),
        ("arm5", arms::declaration("Arm", &AXES[..5])),
        ("quadruped", robots::quadruped()),
        ("biped-quat", robots::biped_on_quaternion()),
        ("bars2", bars::in_angles(2)),
        ("bars2-xy", bars::in_points(2)),
    ];
    rows.iter().map(|(name, text)| row(name, text)).collect()
}

/// The joints of the longest arm, of which the others are the first ones.
const AXES: &str = "zyyxyxyxy";

/// The first declaration of a file.
fn declared(source: TokenStream) -> TokenStream {
    let tokens: Vec<TokenTree> = source.into_iter().collect();
    let found = tokens.windows(3).find_map(|three| match three {
        [TokenTree::Ident(name), TokenTree::Punct(mark), TokenTree::Group(group)]
            if name == "mechanical_system" && mark.as_char() == '!' =>
        {
            Some(group.stream())
        }
        _ => None,
    });
    found.expect("the file declares a system")
}

fn cost(count: guen_symbolic::OperationCount) -> Cost {
    Cost {
        additions: count.additions,
        negations: count.negations,
        multiplications: count.multiplications,
        divisions: count.divisions,
        roots: count.roots,
        calls: count.sines + count.calls,
    }
}

fn counts(cost: Cost) -> String {
    let Cost { additions, negations, multiplications, divisions, roots, calls } = cost;
    [additions, negations, multiplications, divisions, roots, calls]
        .map(|count| format!(" {count:4}"))
        .concat()
}

/// What the kinds of operations cost in units of a multiplication, as the optimiser weighs them.
const WEIGHTS: [u32; 6] = [1, 1, 1, 4, 6, 20];

/// The weighted cost of the right-hand side in a line, and with its preparation.
fn totals(line: &str) -> (u32, u32) {
    let (rates, preparation) = line.split_once('|').unwrap_or((line, ""));
    let numbers =
        |part: &str| -> Vec<u32> { part.split_whitespace().filter_map(|word| word.parse().ok()).collect() };
    let sum =
        |part: &str| numbers(part).iter().zip(WEIGHTS).map(|(count, weight)| count * weight).sum::<u32>();
    (sum(rates), sum(rates) + sum(preparation))
}

#[test]
fn costs_are_those_of_the_file() {
    let mut lines = Lines(HEADER.to_owned());
    visit_all(&mut lines);
    let mut carried = CarriedLines(String::new());
    // Each takes as long as the other.
    let others = std::thread::scope(|scope| {
        let others = scope.spawn(|| chains() + &mechanisms());
        visit_all(&mut carried);
        others.join().unwrap()
    });
    lines.0.push_str(&carried.0);
    lines.0.push_str(&others);
    compared("costs.txt", &lines.0, "");
}

/// Those that take a minute without optimisation.
#[test]
#[ignore = "takes a minute: cargo test -p guen-tests --test golden -- --ignored"]
fn costs_of_large_systems_are_those_of_the_file() {
    let rows = [
        ("arm7", arms::declaration("Arm", &AXES[..7])),
        ("arm8", arms::declaration("Arm", &AXES[..8])),
        ("arm9", arms::declaration("Arm", AXES)),
        ("humanoid", robots::declaration(&robots::HUMANOID)),
        ("humanoid-quat", robots::on_quaternion(&robots::declaration(&robots::HUMANOID))),
        ("held7", robots::held()),
        ("joints40", declaration("Chain", 40, Angles::Relative)),
        ("joints40-0", declaration("Chain", 40, Angles::Relative).replace(" > 0", "")),
        ("bars10", bars::in_angles(10)),
        ("bars10-xy", bars::in_points(10)),
        ("bars40", bars::in_angles(40)),
        ("bars40-xy", bars::in_points(40)),
    ];
    let lines = rows.iter().fold(HEADER_OF_LARGE.to_owned(), |lines, (name, text)| lines + &row(name, text));
    compared("costs_of_large.txt", &lines, " -- --ignored");
}

/// Compares lines with a file, or writes it anew.
fn compared(file: &str, lines: &str, arguments: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if env::var_os("GUEN_BLESS").is_some() {
        guen_study::replace_file(&path, |out| out.write_all(lines.as_bytes())).unwrap();
        return;
    }
    let changes = changes(&fs::read_to_string(&path).unwrap(), lines);
    assert!(
        changes.is_empty(),
        "{changes}if this is meant, write tests/{file} anew with `GUEN_BLESS=1 cargo test -p guen-tests --test golden{arguments}`"
    );
}

/// What differs, a line for each system; empty if nothing does.
fn changes(golden: &str, found: &str) -> String {
    let name = |line: &str| line.split_whitespace().next().unwrap_or_default().to_owned();
    let lines = |text: &str| -> Vec<String> {
        text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
    };
    let (golden, found) = (lines(golden), lines(found));
    let mut changes = String::new();
    for line in &found {
        match golden.iter().find(|known| name(known) == name(line)) {
            Some(known) if known == line => {}
            Some(known) => {
                let verdict = if totals(line) > totals(known) { "REGRESSION" } else { "no dearer" };
                let _ = writeln!(changes, "{verdict}\n  was {known}\n  is  {line}");
            }
            None => {
                let _ = writeln!(changes, "a new system\n  is  {line}");
            }
        }
    }
    for line in golden.iter().filter(|line| found.iter().all(|new| name(new) != name(line))) {
        let _ = writeln!(changes, "a system that is gone\n  was {line}");
    }
    changes
}

#[test]
fn a_raised_count_is_called_a_regression() {
    let golden = "# text\nhoop  6  1 17 1 0 2 | 3 0 4 5 0 0\nsled 5 0 9 0 0 1 | 1 1 1 1 0 0\n";
    assert_eq!(changes(golden, golden), "");
    let dearer = changes(golden, &golden.replace("17 1", "18 1"));
    assert!(dearer.starts_with("REGRESSION\n  was hoop"), "{dearer}");
    assert!(!dearer.contains("sled"), "{dearer}");
    // The preparation counts too, where the right-hand side is the same; a cheaper one at its expense is no loss.
    assert!(changes(golden, &golden.replace("| 1 1", "| 2 1")).starts_with("REGRESSION\n  was sled"));
    assert!(
        changes(golden, &golden.replace("5 0 9 0", "2 0 9 1")).starts_with("REGRESSION"),
        "a division is dearer"
    );
    assert!(changes(golden, &golden.replace("5 0 9 0 0 1 | 1", "4 0 9 0 0 1 | 9")).starts_with("no dearer"));
    assert!(changes(golden, "hoop  6  1 17 1 0 2 | 3 0 4 5 0 0\n").starts_with("a system that is gone"));
    assert!(changes("", golden).starts_with("a new system"));
}
