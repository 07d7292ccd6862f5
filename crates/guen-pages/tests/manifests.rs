//! What the pages say of features, limits and versions, against the manifests and the code; and what a package needs to be
//! published. `cargo metadata` answers without a network from what is built anyway.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use guen_pages::{Page, pages, root};
use serde_json::Value;

/// The packages that are published, from the innermost.
const PUBLISHED: [&str; 7] =
    ["guen-symbolic", "guen-language", "guen-macros", "guen-runtime", "guen-study", "guen-adapters", "guen"];

fn metadata() -> Value {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let out = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--offline", "--locked"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    serde_json::from_slice(&out.stdout).expect("cargo writes JSON")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

/// The packages of the workspace by their names.
fn members(metadata: &Value) -> BTreeMap<&str, &Value> {
    let ids: BTreeSet<&str> = list(&metadata["workspace_members"]).iter().filter_map(Value::as_str).collect();
    let ours = list(&metadata["packages"]).iter().filter(|package| ids.contains(text(package, "id")));
    ours.map(|package| (text(package, "name"), package)).collect()
}

fn page(path: &str) -> Page {
    pages().into_iter().find(|page| page.path == path).unwrap_or_else(|| panic!("no page {path}"))
}

/// The rows of the tables of a page, cell by cell, without backticks.
fn rows(page: &Page) -> Vec<Vec<String>> {
    let cells =
        |line: &str| line.trim_matches('|').split(" | ").map(|cell| cell.trim().replace('`', "")).collect();
    page.prose().filter(|(_, line)| line.starts_with('|')).map(|(_, line)| cells(line)).collect()
}

#[test]
fn the_table_of_features_is_that_of_the_manifests() {
    let metadata = metadata();
    let members = members(&metadata);
    let mut declared = BTreeSet::new();
    for name in PUBLISHED {
        let features = members[name]["features"].as_object().expect("features");
        let defaults: BTreeSet<&str> =
            list(&members[name]["features"]["default"]).iter().filter_map(Value::as_str).collect();
        for feature in features.keys().filter(|feature| *feature != "default") {
            let default = if defaults.contains(feature.as_str()) { "yes" } else { "no" };
            declared.insert([name.to_owned(), feature.clone(), default.to_owned()]);
        }
    }
    let written: BTreeSet<[String; 3]> = rows(&page("docs/features.md"))
        .into_iter()
        .filter(|cells| cells.len() == 4 && PUBLISHED.contains(&cells[0].as_str()))
        .map(|cells| [cells[0].clone(), cells[1].clone(), cells[2].clone()])
        .collect();
    assert_eq!(declared, written, "docs/features.md and the manifests differ");
}

#[test]
fn the_table_of_limits_is_that_of_the_code() {
    let code = std::fs::read_to_string(root().join("crates/guen-language/src/limits.rs")).expect("limits.rs");
    let mut declared = BTreeSet::new();
    for line in code.lines().filter_map(|line| line.strip_prefix("pub const ")) {
        let (name, rest) = line.split_once(':').expect("a type");
        let value = rest.split_once('=').expect("a value").1.trim().trim_end_matches(';').replace('_', "");
        declared.insert([value, name.to_owned()]);
    }
    let written: BTreeSet<[String; 2]> = rows(&page("docs/limits.md"))
        .into_iter()
        .filter(|cells| cells.len() == 3 && cells[1].starts_with("MAX_"))
        .map(|cells| [cells[0].clone(), cells[1].clone()])
        .collect();
    assert!(declared.len() > 8);
    assert_eq!(declared, written, "docs/limits.md and limits.rs differ");
}

/// A version with two or three numbers.
fn version(text: &str) -> [u64; 3] {
    let mut numbers = text.split('.').map(|number| number.parse().unwrap_or(0));
    std::array::from_fn(|_| numbers.next().unwrap_or(0))
}

#[test]
fn no_dependency_asks_for_a_newer_rust() {
    let metadata = metadata();
    let ours = version(text(members(&metadata)["guen"], "rust_version"));
    let packages: BTreeMap<&str, &Value> =
        list(&metadata["packages"]).iter().map(|package| (text(package, "id"), package)).collect();
    let nodes: BTreeMap<&str, &Value> =
        list(&metadata["resolve"]["nodes"]).iter().map(|node| (text(node, "id"), node)).collect();
    let mut open: Vec<&str> = packages
        .iter()
        .filter(|(_, package)| PUBLISHED.contains(&text(package, "name")))
        .map(|(id, _)| *id)
        .collect();
    let mut seen = BTreeSet::new();
    while let Some(id) = open.pop() {
        if !seen.insert(id) {
            continue;
        }
        let package = packages[id];
        let asked = text(package, "rust_version");
        assert!(version(asked) <= ours, "{} asks for Rust {asked}", text(package, "name"));
        for dependency in list(&nodes[id]["deps"]) {
            let built = |kind: &Value| kind["kind"].is_null() || kind["kind"] == "build";
            if list(&dependency["dep_kinds"]).iter().any(built) {
                open.push(text(dependency, "pkg"));
            }
        }
    }
    assert!(seen.len() > 15, "only {} packages were seen", seen.len());
    // What is said of it in words.
    let [major, minor, _] = ours;
    for (path, before) in [
        ("README.md", "Rust toolchain, "),
        ("docs/versioning.md", ""),
        ("docs/start/first-system.md", "toolchain, "),
    ] {
        let said = format!("{before}{major}.{minor}");
        assert!(page(path).text.contains(&said), "{path} does not say `{said}`");
    }
}

#[test]
fn packages_are_ready_to_be_published() {
    let metadata = metadata();
    for (name, package) in members(&metadata) {
        let published = package["publish"].is_null();
        assert_eq!(published, PUBLISHED.contains(&name), "{name}: published or not?");
        if !published {
            continue;
        }
        for key in ["description", "license", "repository", "readme", "rust_version"] {
            assert!(!text(package, key).is_empty(), "{name} has no {key}");
        }
        // The registry's bounds.
        assert!((1..=5).contains(&list(&package["keywords"]).len()), "{name}: keywords");
        assert!((1..=5).contains(&list(&package["categories"]).len()), "{name}: categories");
        assert!(package["metadata"]["docs"]["rs"]["all-features"] == true, "{name}: docs.rs");
        let folder = std::path::Path::new(text(package, "manifest_path")).parent().expect("a folder");
        for file in ["LICENSE-MIT", "LICENSE-APACHE", text(package, "readme")] {
            assert!(folder.join(file).is_file(), "{name} has no {file}");
        }
        // What it is built from is published too, in a version that is named.
        for dependency in
            list(&package["dependencies"]).iter().filter(|d| !d["path"].is_null() && d["kind"].is_null())
        {
            assert!(
                PUBLISHED.contains(&text(dependency, "name")) && text(dependency, "req") != "*",
                "{name}: {dependency}"
            );
        }
    }
}
