//! The stages import each other one way: `parse` and `model` know of nothing behind them, `emit` of all before it.

use std::path::{Path, PathBuf};

/// The modules of the crate in the order of the pipeline. Each reads modules that stand before it; `parse` hands over a syntax
/// tree, so nothing reads `parse` but the fronts, which are the root of the crate and `components`.
const ORDER: [&str; 13] = [
    "names",
    "limits",
    "diagnostics",
    "syntax",
    "damage",
    "outline",
    "unfold",
    "parse",
    "model",
    "derive",
    "report",
    "emit",
    "components",
];

/// The modules that a text names by `crate::`.
fn imports(text: &str) -> Vec<String> {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let code: Vec<&str> = code.take_while(|line| !line.starts_with("#[cfg(test)]")).collect();
    let code = code.join("\n");
    let after = code.split("crate::").skip(1);
    after
        .map(|rest| {
            rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default().to_owned()
        })
        .collect()
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { files(&path, found) } else { found.push(path) }
    }
}

#[test]
fn stages_import_those_before_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = Vec::new();
    files(&root, &mut sources);
    let place = |name: &str| ORDER.iter().position(|known| *known == name);
    let (mut count, mut faults) = (0, Vec::new());
    for source in sources {
        let path = source.strip_prefix(&root).unwrap();
        let stage = path.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
        if stage == "lib" {
            continue;
        }
        let own = place(stage).unwrap_or_else(|| panic!("{} belongs to no stage", path.display()));
        for name in imports(&std::fs::read_to_string(&source).unwrap()) {
            let other = place(&name).unwrap_or_else(|| panic!("{}: {name} is no stage", path.display()));
            count += 1;
            if other > own || (ORDER[other] == "parse" && own != other && stage != "components") {
                faults.push(format!("{}: `{name}` stands behind `{stage}`", path.display()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(count > 100, "only {count} imports were found");
}
