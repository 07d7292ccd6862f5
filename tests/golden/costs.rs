//! The operations of every benchmark system are golden values: `tests/costs.txt`. A change of the optimiser that moves a
//! count, up or down, has to change that file, where a reviewer sees it.
//!
//! ```text
//! GUEN_BLESS=1 cargo test -p guen-tests --test golden      # writes the file anew
//! ```

use std::fmt::Write;
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};

use guen::Cost;
use guen_benchmarks::chains::{Angles, declaration};
use guen_benchmarks::{Subject, Visitor, arms, bars, parallel, robots, visit_all};
use guen_language::derive::function::RHS;

use crate::lines::{changes, compared, counts, derived, row, six};

const HEADER: &str = "\
# Operations of the benchmark systems, written by `GUEN_BLESS=1 cargo test -p guen-tests --test golden`.
# One evaluation of the right-hand side, then the preparation of its constants: additions, negations,
# multiplications, divisions, roots, calls. With an apostrophe: the carried form. With `-0`: no sign is promised
# of any constant. With a slash: momenta, mass matrix with bias, reactions, where they are large, or outputs.
";

/// Chains of so many links are not compiled.
const LONG: usize = 40;

/// The counts that an expansion states.
fn counted(cost: Cost) -> [u32; 6] {
    let Cost { additions, negations, multiplications, divisions, roots, calls } = cost;
    [additions, negations, multiplications, divisions, roots, calls]
}

/// One line for each system: its name, then two programs of six counts.
struct Lines(String);

impl Visitor for Lines {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        let _ = writeln!(
            self.0,
            "{:11} {}  |{}",
            S::NAME,
            counts(counted(S::COST)),
            counts(counted(S::PREPARE_COST))
        );
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
            (counts(six(rates)), counts(six(level.programs.prepare_cost)))
        });
        let _ = writeln!(self.0, "{:11} {rates}  |{prepare}", format!("{}'", S::NAME));
    }
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

/// Chains of six links that something pulls: the end, or each particle.
fn pulled_chains() -> String {
    let end = "p6 - vec(a, b)";
    let forces = [
        ("spring", format!("potential_energy = c/2*inner({end}, {end});")),
        ("rope", format!("potential_energy = c/2*max(norm({end}) - b, 0)^2;")),
        ("wall", "potential_energy = c/2*max(p6.x - a, 0)^2;".to_owned()),
        ("damper", "forces { -c*dot(p6) along dot(p6); }".to_owned()),
        ("air", {
            let drag = |i: usize| format!("-c*norm(dot(p{i}))*dot(p{i}) along dot(p{i});");
            format!("forces {{ {} }}", (1..=6).map(drag).collect::<String>())
        }),
    ];
    let row = |(name, item): &(&str, String)| {
        let text = declaration("Chain", 6, Angles::Absolute);
        let text = text.replace("g = 9.81", "g = 9.81, a, b, c >= 0");
        let end = text.rfind('}').unwrap();
        row(&format!("chain6-{name}"), &format!("{} {item} }}", &text[..end]))
    };
    forces.iter().map(row).collect()
}

/// An arm of six joints whose tool something pulls.
fn pulled_arms() -> String {
    let tool = "let tool = c6 + R6*vec(0, 0, l/3);";
    let forces = [
        ("spring", "potential_energy = s/2*inner(tool - vec(a, b, h), tool - vec(a, b, h));"),
        ("rope", "potential_energy = s/2*max(norm(tool - vec(a, b, h)) - b, 0)^2;"),
        ("floor", "potential_energy = s/2*max(h - tool.z, 0)^2;"),
        ("damper", "forces { -s*dot(tool) along dot(tool); }"),
        ("follow", "inputs { x, y, z } forces { s*(vec(x, y, z) - tool) - b*dot(tool) along dot(tool); }"),
    ];
    let row = |(name, item): &(&str, &str)| {
        let text =
            arms::declaration("Arm", &arms::AXES[..6]).replace("g = 9.81", "g = 9.81, a, b, h, s >= 0");
        let end = text.rfind('}').unwrap();
        row(&format!("arm6-{name}"), &format!("{} {tool} {item} }}", &text[..end]))
    };
    forces.iter().map(row).collect()
}

/// Vehicles, linkages, arms and robots that are not compiled here.
fn mechanisms() -> String {
    let in_file = |source: &str| declared(source.parse().unwrap(), 0).to_string();
    let bicycles = include_str!("../spatial/bicycle.rs");
    let rows = [
        ("bicycle", in_file(bicycles)),
        // In nine coordinates, with holonomic equations for both contacts.
        ("bicycle-free", declared(bicycles.parse().unwrap(), 1).to_string()),
        ("snake6", crate::large_systems::snake(6)),
        ("rattleback", guen_benchmarks::rattleback!(stringify).to_owned()),
        ("hoop-quat", guen_benchmarks::quaternion_hoop!(stringify).to_owned()),
        ("four-bar", in_file(include_str!("../spatial/linkages.rs"))),
        ("arm4", arms::declaration("Arm", &arms::AXES[..4])),
        ("arm5", arms::declaration("Arm", &arms::AXES[..5])),
        ("general3", arms::general(3)),
        ("general4", arms::general(4)),
        ("general5", arms::general(5)),
        ("general6", arms::general(6)),
        ("quadruped", robots::quadruped()),
        ("tripod", robots::tripod()),
        ("biped-quat", robots::biped_on_quaternion()),
        ("rods2", robots::rods(2, false)),
        ("rods4", robots::rods(4, false)),
        ("rods4-rel", robots::rods(4, true)),
        ("rods2-pins", robots::pinned_rods(2)),
        ("rods3-pins", robots::pinned_rods(3)),
        ("bars2", bars::in_angles(2)),
        ("bars2-xy", bars::in_points(2)),
        ("delta", parallel::delta("for i in 0..n { w[i] = dot(q[i]); }")),
        ("delta-plate", parallel::delta("vx = dot(x); vy = dot(y); vz = dot(z);")),
        ("two-arms", parallel::two_arms(3)),
        ("legs", parallel::platform("for i in 0..n { v[i] = dot(s[i]); }")),
        ("legs-quat", parallel::platform_on_quaternion("for i in 0..n { v[i] = dot(s[i]); }")),
        (
            "legs-plate",
            parallel::platform("vx = dot(x); vy = dot(y); vz = dot(z); w = angular_velocity_body(R);"),
        ),
    ];
    rows.iter().map(|(name, text)| row(name, text)).collect()
}

/// The declaration at a place in a file.
pub fn declared(source: TokenStream, place: usize) -> TokenStream {
    let tokens: Vec<TokenTree> = source.into_iter().collect();
    let mut found = tokens.windows(3).filter_map(|three| match three {
        [TokenTree::Ident(name), TokenTree::Punct(mark), TokenTree::Group(group)]
            if name == "mechanical_system" && mark.as_char() == '!' =>
        {
            Some(group.stream())
        }
        _ => None,
    });
    found.nth(place).expect("the file declares the system")
}

#[test]
fn costs_are_those_of_the_file() {
    let mut lines = Lines(HEADER.to_owned());
    visit_all(&mut lines);
    let mut carried = CarriedLines(String::new());
    // Each takes as long as the other.
    let others = std::thread::scope(|scope| {
        let others = scope
            .spawn(|| chains() + &pulled_chains() + &pulled_arms() + &mechanisms() + &crate::sensors::rows());
        visit_all(&mut carried);
        others.join().unwrap()
    });
    lines.0.push_str(&carried.0);
    lines.0.push_str(&others);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("costs.txt");
    compared(&file, &lines.0, "cargo test -p guen-tests --test golden");
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
