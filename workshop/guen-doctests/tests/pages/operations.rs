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

/// The operations of one evaluation by the name of the system.
fn golden() -> BTreeMap<String, u32> {
    let text = std::fs::read_to_string(root().join("tests/costs.txt")).expect("the counts are there");
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
