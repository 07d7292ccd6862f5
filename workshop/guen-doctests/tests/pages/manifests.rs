//! What the pages say of features, limits and versions, against the manifests and the code; and what a package needs to be
//! published. Cargo is asked for nothing but what the build of this test has brought.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use guen_doctests::{Page, pages, root};
use serde_json::Value;

/// The packages that are published, from the innermost.
const PUBLISHED: [&str; 7] =
    ["guen-symbolic", "guen-language", "guen-macros", "guen-runtime", "guen-study", "guen-adapters", "guen"];

/// What cargo prints in the repository, without a network.
fn cargo(arguments: &[&str]) -> Vec<u8> {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let out = Command::new(cargo)
        .args(arguments)
        .arg("--offline")
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    out.stdout
}

/// The manifests of the workspace. Without those of its dependencies, some of which no build downloads.
fn metadata() -> Value {
    let text = cargo(&["metadata", "--format-version", "1", "--no-deps"]);
    serde_json::from_slice(&text).expect("cargo writes JSON")
}

/// The manifests of all packages that the published ones are built from, by their identities: this package stands on all of
/// those, so it is built, or found built.
fn built() -> BTreeMap<String, String> {
    let mut arguments =
        vec!["build", "--package", "guen-doctests", "--lib", "--message-format=json", "--target-dir"];
    let program = std::env::current_exe().expect("a program has a place");
    // .../debug/deps/pages
    let target = program
        .ancestors()
        .nth(3)
        .and_then(|path| path.to_str())
        .expect("a target folder with a name in UTF-8");
    arguments.push(target);
    let text = String::from_utf8(cargo(&arguments)).expect("cargo writes UTF-8");
    let artifact = |line: &str| {
        let message: Value = serde_json::from_str(line).ok()?;
        let path = message["manifest_path"].as_str()?;
        let manifest = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
        (message["reason"] == "compiler-artifact").then(|| (message["package_id"].to_string(), manifest))
    };
    text.lines().filter_map(artifact).collect()
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
    let code = std::fs::read_to_string(root().join("guen-language/src/limits.rs")).expect("limits.rs");
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
    let packages = built();
    for (id, manifest) in &packages {
        // Ours say `rust-version.workspace = true`; those of a registry are written out by cargo.
        let asked = manifest.lines().find_map(|line| line.strip_prefix("rust-version = "));
        let asked = asked.unwrap_or("0").trim_matches('"');
        assert!(version(asked) <= ours, "{id} asks for Rust {asked}");
    }
    assert!(packages.len() > 15, "only {} packages were seen", packages.len());
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

/// What the macro stands on is built once for the whole workspace, as a library and for the macro, with tests and without. Features
/// that a dev-dependency adds would be there in some builds and not in others.
#[test]
fn tests_add_no_features_to_the_macro() {
    let metadata = metadata();
    let members = members(&metadata);
    let macros = ["guen-symbolic", "guen-language", "guen-macros"].map(|name| members[name]);
    let all = || macros.iter().flat_map(|package| list(&package["dependencies"]));
    let features = |dependency: &Value| -> BTreeSet<String> {
        list(&dependency["features"]).iter().map(|feature| feature.to_string()).collect()
    };
    let mut own: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for dependency in all().filter(|dependency| dependency["kind"].is_null()) {
        own.entry(text(dependency, "name")).or_default().extend(features(dependency));
    }
    assert!(own.len() > 8, "{own:?}");
    for dependency in all().filter(|dependency| dependency["kind"] == "dev") {
        let Some(own) = own.get(text(dependency, "name")) else { continue };
        assert!(features(dependency).is_subset(own), "{dependency} asks for more than {own:?}");
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
