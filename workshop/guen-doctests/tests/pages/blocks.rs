//! What may stand behind an opening fence. Rust is compiled and run, without a way around.

use guen_doctests::{Page, pages};

#[test]
fn all_rust_is_run() {
    let mut rust = 0;
    for page in pages() {
        for (line, words) in page.fences() {
            // An unnamed block is Rust to rustdoc, and no language to mdBook: say which.
            let known = ["rust", "text", "math", "toml", "sh", "console", "c"].contains(&words);
            assert!(known, "{}:{line}: a block of `{words}`", page.path);
            rust += usize::from(words == "rust");
        }
    }
    assert!(rust > 20, "only {rust} blocks of Rust were found");
}

/// The longest program of a task, beside its declaration.
const LONGEST_TASK: usize = 40;

/// The first block of Rust below the heading with this anchor, as lines.
fn program<'a>(page: &'a Page, anchor: &str) -> Vec<&'a str> {
    let heading =
        |line: &str| line.starts_with('#').then(|| Page { path: String::new(), text: line.to_owned() });
    let named =
        |line: &str| heading(line).is_some_and(|line| line.anchors().iter().any(|name| name == anchor));
    let below = page.text.lines().skip_while(|line| !named(line)).skip(1);
    let section = below.take_while(|line| !line.starts_with("## "));
    section.skip_while(|line| *line != "```rust").skip(1).take_while(|line| *line != "```").collect()
}

#[test]
fn thirteen_tasks_are_short_programs() {
    let pages = pages();
    let tasks = pages.iter().find(|page| page.path == "docs/start/tasks.md").expect("the page of tasks");
    let rows: Vec<&str> = tasks.text.lines().filter(|line| line.starts_with("| ")).skip(2).collect();
    assert!(rows.len() >= 13, "{} tasks", rows.len());
    for row in rows {
        // The first link of a row leads to the program.
        let link = row.split("](").nth(1).and_then(|rest| rest.split(')').next()).expect("a link");
        let (file, anchor) = link.split_once('#').expect("the heading above the program");
        let path = match file.strip_prefix("../") {
            Some(above) => format!("docs/{above}"),
            None if file.is_empty() => tasks.path.clone(),
            None => format!("docs/start/{file}"),
        };
        let page = pages.iter().find(|page| page.path == path).unwrap_or_else(|| panic!("{row}: no page"));
        let program = program(page, anchor);
        assert!(program.iter().any(|line| line.contains("assert")), "{row}: nothing is asserted");
        let declaration = program.iter().skip_while(|line| !line.contains("mechanical_system! {"));
        let declaration = declaration.take_while(|line| **line != "}").count();
        assert!(declaration > 0, "{row}: nothing is declared");
        let beside = program.len() - declaration - 1;
        assert!(beside <= LONGEST_TASK, "{row}: {beside} lines beside the declaration");
    }
}
