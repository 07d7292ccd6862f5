//! The operations in the tables of the pages, against the golden counts.

use std::collections::BTreeMap;

use guen_doctests::{pages, root};

/// The names that pages give to the systems of `tests/costs.txt`; a program by hand that they are compared with stands behind a comma.
const NAMES: [(&str, &str); 22] = [
    ("hoop", "hoop"),
    ("hoop, as in the paper", "hoop"),
    ("hoop, as a body", "hoop-body"),
    ("hoop, as a body that rolls", "hoop-body"),
    ("hoop, in velocities", "hoop-rates"),
    ("hoop, in velocities alone", "hoop-rates"),
    ("sled", "sled"),
    ("Appell's system", "appell"),
    ("ball on a turntable", "turntable"),
    ("Euler's top", "top"),
    ("car, 1 trailer", "car1"),
    ("car, 2 trailers", "car2"),
    ("car, 3 trailers", "car3"),
    ("chain of 2 links", "chain2"),
    ("chain of 5", "chain5"),
    ("chain of 10", "chain10"),
    ("chain of 20", "chain20"),
    ("2 links, relative angles", "joints2"),
    ("5 links, relative angles", "joints5"),
    ("10 links, relative angles", "joints10"),
    ("arm of 3 joints", "arm3"),
    ("arm of 6 joints", "arm6"),
];

/// The rows of the tables in `docs/design/floors.md` and `docs/design/bodies.md` with today's operations, each with the systems of the golden
/// files whose counts stand in its second column; one without a golden count has no name.
const REACHED: [(&str, &[&str]); 23] = [
    ("chain of 5, 10, 20, 40 links, absolute angles", &["chain5", "chain10", "chain20", "chain40"]),
    ("the same in relative angles", &["joints5", "joints10", "joints20", "joints40"]),
    ("car with 1, 2, 3 trailers", &["car1", "car2", "car3"]),
    ("hoop in quaternions", &["hoop-quat"]),
    ("rods on hinges with quaternions and centres, 1, 2, 3", &["hinged1", "hinged2", "hinged3"]),
    ("rods on ball joints with quaternions in the world, 2, 3, 4", &["rods2", "", "rods4"]),
    ("rattleback", &["rattleback"]),
    ("chain of seven oblique joints, tip held", &["held7"]),
    ("planar snake of six wheeled links", &["snake6"]),
    ("arm3", &["arm3"]),
    ("arm6", &["arm6"]),
    (
        "arms of 3 to 9 joints, general offsets and inertias",
        &["general3", "general4", "general5", "general6", "general7", "general8", "general9"],
    ),
    ("bicycle with its inputs", &["bicycle"]),
    ("the same, its hub anywhere in space, both wheels on holonomic equations", &["bicycle-free"]),
    ("four-bar", &["four-bar"]),
    ("quadruped, humanoid, floating", &["quadruped", "humanoid"]),
    ("four-bars in a row, 2, 10, 40 loops, in angles", &["bars2", "bars10", "bars40"]),
    ("the same in points", &["bars2-xy", "bars10-xy", "bars40-xy"]),
    ("bicycle of `tests/spatial`", &["bicycle"]),
    ("four-bar linkage", &["four-bar"]),
    ("arms with the axes z y y x y x, general ones with 3 and 6 joints", &["arm6", "general3", "general6"]),
    ("four legs with three joints each on a floating base, general inertias", &["quadruped"]),
    ("tricycle with a rider, ellipsoid with a rod (`tests/language`)", &["", ""]),
];

/// The operations of one evaluation by the name of the system.
fn golden() -> BTreeMap<String, u32> {
    let read = |file: &str| std::fs::read_to_string(root().join(file)).expect("the counts are there");
    let text = read("tests/costs.txt") + &read("tests/costs_of_large.txt");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let rates = line.split('|').next().unwrap_or_default();
            let mut words = rates.split_whitespace();
            let name = words.next().expect("a line has a name").to_owned();
            (name, words.map(|word| word.parse::<u32>().expect("a count")).sum())
        })
        .collect()
}

#[test]
fn tables_of_the_pages_have_the_golden_counts() {
    let golden = golden();
    let (mut tells, mut seen, mut wrong) = (false, 0, Vec::new());
    let pages = pages();
    for line in pages.iter().flat_map(|page| page.text.lines()) {
        let cells: Vec<&str> = line.trim_matches(['|', ' ']).split('|').map(str::trim).collect();
        let [label, said, ..] = cells[..] else {
            tells = false;
            continue;
        };
        if label == "system" {
            tells = said == "ops";
            continue;
        }
        if !tells || said.starts_with('-') {
            continue;
        }
        let plain = label.trim_end_matches(", by its matrix").trim_end_matches(", by tensions");
        let name = NAMES.iter().find(|(known, _)| *known == plain).map(|(_, name)| *name);
        let name = name.unwrap_or_else(|| panic!("which system is `{label}`?"));
        seen += 1;
        if said != golden[name].to_string() {
            wrong.push(format!("{label}: {said}, counted {}", golden[name]));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(seen > 40, "{seen} rows");
}

/// Tables with the header `system | reached` or `system | now`.
#[test]
fn pages_on_floors_and_bodies_have_the_golden_counts() {
    let golden = golden();
    // `joints20` is counted without bounds, which cost nothing.
    let count = |name: &str| golden.get(name).or_else(|| golden.get(&format!("{name}-0")));
    let (mut tells, mut seen, mut wrong) = (false, 0, Vec::new());
    let pages = ["docs/design/floors.md", "docs/design/bodies.md"];
    let text = pages.map(|page| std::fs::read_to_string(root().join(page)).expect("a page")).concat();
    for line in text.lines() {
        let cells: Vec<&str> = line.trim_matches(['|', ' ']).split('|').map(str::trim).collect();
        let [label, said, ..] = cells[..] else {
            tells = false;
            continue;
        };
        if label == "system" {
            tells = matches!(said, "reached" | "now");
            continue;
        }
        if !tells || said.starts_with('-') {
            continue;
        }
        let (_, names) = REACHED
            .iter()
            .find(|(known, _)| *known == label)
            .unwrap_or_else(|| panic!("which systems are `{label}`?"));
        let figures: Vec<String> = said.split(", ").map(|figure| figure.replace(',', "")).collect();
        assert_eq!(figures.len(), names.len(), "{label}");
        seen += 1;
        for (figure, name) in figures.iter().zip(*names).filter(|(_, name)| !name.is_empty()) {
            let counted = count(name).unwrap_or_else(|| panic!("{name} is in no golden file"));
            if *figure != counted.to_string() {
                wrong.push(format!("{label}: {figure}, counted {counted}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(seen > 20, "{seen} rows");
}
