//! The lines as text: for a terminal, and as the table of `docs/design/battery.md`.

use std::fmt::Write;

use super::{Line, Verdict};

/// A line as a paragraph: what was asked, and what every method answered.
pub fn paragraph(line: &Line) -> String {
    let mut text = format!("{}: {}\n    (against {})\n", line.system, line.asked, line.against);
    let width = line.answers.iter().map(|answer| answer.by.chars().count()).max().unwrap_or(0);
    for answer in &line.answers {
        let _ = writeln!(text, "    {:width$}  {}", answer.by, answer.verdict);
    }
    text
}

/// An answer as a cell.
fn cell(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Right { error: 0.0, .. } => "0".to_owned(),
        Verdict::Right { error, .. } => format!("{error:.0e}"),
        Verdict::Refused { short, .. } => format!("*{short}*"),
        Verdict::Silent { error, .. } => format!("**SILENT {error:.0e}**"),
        Verdict::Failed { .. } => "**FAILED**".to_owned(),
    }
}

/// All lines as Markdown: those of the methods as one table, the others as lists.
pub fn markdown(lines: &[Line]) -> String {
    let methods: Vec<&str> = lines
        .iter()
        .map(|line| line.answers.iter().map(|answer| answer.by).collect::<Vec<_>>())
        .max_by_key(|names| if names.contains(&"DOP853") { names.len() } else { 0 })
        .unwrap_or_default();
    let in_table =
        |line: &&Line| line.answers.len() > 1 && line.answers.iter().all(|a| methods.contains(&a.by));
    let mut text = format!("| system | asked | {} |\n", methods.join(" | "));
    let _ = writeln!(text, "|{}", " --- |".repeat(methods.len() + 2));
    for line in lines.iter().filter(in_table) {
        let cells: Vec<String> = methods
            .iter()
            .map(|by| line.answers.iter().find(|a| a.by == *by).map_or(String::new(), |a| cell(&a.verdict)))
            .collect();
        let _ = writeln!(text, "| {} | {} | {} |", line.system, line.asked, cells.join(" | "));
    }
    text.push_str("\n| system | asked | what came back |\n| --- | --- | --- |\n");
    for line in lines.iter().filter(|line| !in_table(line)) {
        let answers: Vec<String> =
            line.answers.iter().map(|a| format!("{}: {}", a.by, cell(&a.verdict))).collect();
        let _ = writeln!(text, "| {} | {} | {} |", line.system, line.asked, answers.join("; "));
    }
    text
}

/// How many answers are right, typed errors, and failures.
pub fn count(lines: &[Line]) -> (usize, usize, usize) {
    let mut counts = (0, 0, 0);
    for answer in lines.iter().flat_map(|line| &line.answers) {
        match answer.verdict {
            Verdict::Right { .. } => counts.0 += 1,
            Verdict::Refused { .. } => counts.1 += 1,
            Verdict::Silent { .. } | Verdict::Failed { .. } => counts.2 += 1,
        }
    }
    counts
}
