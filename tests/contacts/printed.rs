//! What the reports of systems with contacts say.

use super::declared::{stick_slip, walker};

#[test]
fn short_entries_of_d_are_printed() {
    let expected = [
        "belt_n = w",
        "belt_t = u - vb",
        "D[belt_n, belt_n] = 1/m",
        "D[belt_t, belt_t] = 1/m",
        "belt is a contact with friction along a line: open, stick, slip",
        "4 modes",
        "in every mode a slip has one reaction: D couples no slip with a gap that is closed then",
    ];
    assert_eq!(stick_slip::REPORT.lines("Contacts"), expected);
}

#[test]
fn long_entries_of_d_are_counted() {
    let lines = walker::REPORT.lines("Contacts");
    let printed = lines.iter().filter(|line| line.starts_with("D["));
    assert!(printed.clone().all(|line| line.len() < 350), "{lines:?}");
    // Seven rows: two of each foot, one of each other contact, so that 28 entries make the lower half.
    let long = 28 - printed.count();
    let counted = format!("{long} entries of D = W M^-1 W^T are too long to print");
    assert!(lines.contains(&counted.as_str()), "{lines:?}");
}

#[test]
fn states_that_no_mode_has_are_not_told() {
    let lines = walker::REPORT.lines("Contacts");
    let says = |words: &str| lines.contains(&words);
    assert!(says("heel is a contact with friction along a line: open, stick"), "{lines:?}");
    assert!(says("toe is a contact with friction along a line: open, slip"));
    assert!(says("where toe slips, its reaction may have no value, or several (Painlevé)"));
    assert!(!lines.iter().any(|line| line.starts_with("where heel slips")));
}
