//! The pages that are made of a report: each line of it in each of them, as it was.

use guen_language::report::ReportLines;
use guen_runtime::ReportSection;

use super::latex;

/// What is not as it was.
pub fn faults(report: &ReportLines) -> Vec<String> {
    let mut faults = Vec::new();
    let text = report.to_text();
    let page = report.to_page();
    for section in &report.sections {
        for line in &section.text {
            if !text.lines().any(|own| own.trim_start() == line.trim_start()) {
                faults.push(format!("text without {line}"));
            }
        }
        for (formula, line) in section.latex.iter().zip(&section.text) {
            if !page.contains(&format!("\n$${formula}$$\n"))
                && !page.contains(&format!("```text\n{line}\n```"))
            {
                faults.push(format!("the page without {formula}"));
            }
        }
        for words in &section.text[section.latex.len()..] {
            let told = page.lines().filter_map(|own| own.strip_prefix("- "));
            if !told.map(unescaped).any(|own| own == *words) {
                faults.push(format!("the page without {words}"));
            }
        }
    }
    faults.extend(documents(report));
    faults
}

/// The documents that a compiled report writes.
fn documents(report: &ReportLines) -> Vec<String> {
    let leak = |lines: &[String]| -> &'static [&'static str] {
        let lines: Vec<&'static str> = lines.iter().map(|line| &*line.clone().leak()).collect();
        lines.leak()
    };
    let sections: Vec<ReportSection> = report
        .sections
        .iter()
        .map(|section| ReportSection {
            title: section.title,
            lines: leak(&section.text),
            formulas: leak(&section.latex),
        })
        .collect();
    let compiled = guen_runtime::Report {
        name: report.name.clone().leak(),
        summary: report.summary.clone().leak(),
        sections: sections.leak(),
    };
    let (markdown, document) = (compiled.markdown(1).to_string(), compiled.latex().to_string());
    let mut faults = Vec::new();
    let mut formulas = document.lines().filter_map(|line| {
        line.strip_prefix(r"{\raggedright\hangindent=2em\hangafter=1$\displaystyle ")?
            .strip_suffix(r"$\par}\smallskip")
    });
    let mut items = document
        .lines()
        .filter_map(|line| line.trim_start_matches(r"\begin{itemize}").strip_prefix(r"\item "));
    let mut list = markdown.lines().filter_map(|line| line.strip_prefix("- "));
    for section in &report.sections {
        for formula in &section.latex {
            let own = formulas.next().unwrap_or_default();
            match (latex::read(own), latex::read(formula)) {
                (Ok(own), Ok(formula)) if own == formula => {}
                _ => faults.push(format!("the document has {own} for {formula}")),
            }
            if !markdown.contains(&format!("\n$${formula}$$\n")) {
                faults.push(format!("Markdown without {formula}"));
            }
        }
        for words in &section.text[section.latex.len()..] {
            let (item, own) = (items.next().unwrap_or_default(), list.next().unwrap_or_default());
            if prose(item) != *words {
                faults.push(format!("the document has {item} for {words}"));
            }
            if unescaped(own) != *words {
                faults.push(format!("Markdown has {own} for {words}"));
            }
        }
    }
    faults
}

/// Words of Markdown: without the backslashes before marks that would mean something; between backticks there are none.
fn unescaped(line: &str) -> String {
    let mut text = String::new();
    let (mut in_code, mut escaped) = (false, false);
    for c in line.chars() {
        in_code ^= c == '`';
        let is_mark = c == '\\' && !in_code && !escaped;
        if !is_mark {
            text.push(c);
        }
        escaped = is_mark;
    }
    text
}

/// Words of a LaTeX document.
fn prose(item: &str) -> String {
    const COMMANDS: [(&str, &str); 8] = [
        ("\\textbackslash{}", "\\"),
        ("\\textasciicircum{}", "^"),
        ("\\textasciitilde{}", "~"),
        ("\\texttt{", "`"),
        // The only groups that are open are those of code.
        ("}", "`"),
        ("$^\\circ$", "°"),
        ("$\\mathit{o}$", "ο"),
        ("$\\varsigma$", "ς"),
    ];
    let (mut text, mut rest) = (String::new(), item);
    while let Some(c) = rest.chars().next() {
        if let Some((command, letter)) = COMMANDS.iter().find(|(command, _)| rest.starts_with(command)) {
            text.push_str(letter);
            rest = &rest[command.len()..];
            continue;
        }
        rest = &rest[c.len_utf8()..];
        match (c, rest.split_once('$')) {
            ('\\', _) => {
                let mark = rest.chars().next().unwrap_or(c);
                text.push(mark);
                rest = &rest[mark.len_utf8()..];
            }
            ('$', Some((inner, after))) => {
                let letter = inner.strip_prefix('\\').and_then(super::names::greek);
                text.push_str(letter.unwrap_or(inner));
                rest = after;
            }
            _ => text.push(c),
        }
    }
    text
}
