//! The interface of a component as documentation.

use std::fmt::Write;

use crate::syntax::{Component, Docs, Item, Name};

/// The arguments of a component, and what can be read of its instances.
pub(crate) fn interface(component: &Component) -> String {
    let mut text = String::new();
    let name = &component.name;
    let arguments: Vec<String> =
        component.arguments.iter().map(|argument| format!("{}: ..", argument.name)).collect();
    let braces =
        if arguments.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", arguments.join(", ")) };
    // Writing into a string cannot fail.
    let _ = writeln!(text, "# Use in a system\n\n```text\nuse {name} as name {braces}\n```\n");
    if !component.arguments.is_empty() {
        let _ = writeln!(text, "| argument | kind | |\n| --- | --- | --- |");
        for argument in &component.arguments {
            let (name, kind, docs) = (&argument.name, argument.kind.word(), line(&argument.docs));
            let _ = writeln!(text, "| `{name}` | {kind} | {docs} |");
        }
        text.push('\n');
    }
    let rows: Vec<(&str, &Name, String)> = component.items.iter().flat_map(rows).collect();
    if !rows.is_empty() {
        let _ = writeln!(text, "| of an instance | is | |\n| --- | --- | --- |");
        for (what, name, docs) in rows {
            let _ = writeln!(text, "| `{name}` | {what} | {docs} |");
        }
    }
    let has_functions = component.items.iter().any(|item| matches!(item, Item::Functions(_)));
    text.push_str(match has_functions {
        true => "\nThe fields are the constants of the component, and the functions that the program supplies to it.",
        false => "\nThe fields are the constants of the component.",
    });
    text
}

/// The names that an item declares for readers, each with its kind and documentation.
fn rows(item: &Item) -> Vec<(&'static str, &Name, String)> {
    let mut found: Vec<(&'static str, &Name, String)> = match item {
        Item::Inputs(section) => {
            section.entries.iter().map(|entry| ("an input", &entry.name, line(&entry.docs))).collect()
        }
        Item::Coordinates(section) => {
            section.entries.iter().map(|entry| ("a coordinate", &entry.name, line(&entry.docs))).collect()
        }
        Item::Let(entry) => vec![("a value", &entry.name, line(&entry.docs))],
        Item::Parameters(section) => {
            section.entries.iter().map(|entry| ("a parameter", &entry.name, line(&entry.docs))).collect()
        }
        Item::States(section) => {
            section.entries.iter().map(|entry| ("a state", &entry.name, line(&entry.docs))).collect()
        }
        Item::Constraints(section) => {
            section.entries.iter().map(|entry| ("a constraint", &entry.name, line(&entry.docs))).collect()
        }
        Item::Holonomic(section) => section
            .entries
            .iter()
            .map(|entry| ("a holonomic constraint", &entry.name, line(&entry.docs)))
            .collect(),
        Item::Bodies(section) => {
            section.entries.iter().map(|entry| ("a body", &entry.name, line(&entry.docs))).collect()
        }
        Item::Outputs(section) => {
            section.entries.iter().map(|entry| ("an output", &entry.name, line(&entry.docs))).collect()
        }
        Item::Switches(section) => {
            section.entries.iter().map(|entry| ("a switch", &entry.name, line(&entry.docs))).collect()
        }
        Item::Contacts(section) => {
            section.entries.iter().map(|entry| ("a contact", &entry.name, line(&entry.docs))).collect()
        }
        Item::Resets(section) => {
            section.entries.iter().map(|entry| ("a reset", &entry.name, line(&entry.docs))).collect()
        }
        Item::Use(instance) => vec![("an instance", &instance.name, line(&instance.docs))],
        _ => Vec::new(),
    };
    found.retain(|(_, name, _)| !name.text.starts_with('_'));
    found
}

/// Documentation in one line of a table.
fn line(docs: &Docs) -> String {
    docs.lines.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ").replace('|', "\\|")
}
