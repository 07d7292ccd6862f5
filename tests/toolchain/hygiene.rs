//! A user's crate that forgives nothing, with the facade under another name: it compiles without a warning.

use std::collections::BTreeSet;
use std::fmt::Write;

use proc_macro2::{TokenStream, TokenTree};

use crate::commands;

/// Clippy's compiler, if it is installed beside the other one: the crate denies its pedantic group.
fn strictest() -> String {
    let mut rustc = std::process::Command::new(commands::rustc());
    let (sysroot, _) = commands::run(rustc.args(["--print", "sysroot"]));
    let driver = std::path::Path::new(sysroot.trim()).join("bin/clippy-driver");
    if driver.exists() { driver.display().to_string() } else { commands::rustc() }
}

#[test]
fn a_strict_crate_with_a_renamed_dependency() {
    let mut compiler = commands::compiler(&strictest(), "mechanics");
    let (_, text) = commands::run(compiler.args(["--crate-type=lib", "tests/hygiene/strict.rs"]));
    assert_eq!(text, "", "a strict crate compiles without a word");
}

/// A declaration with what an expansion has generics for: inputs, outputs, positions, a scene.
const GENERAL: &str = "
    constants { m > 0, r > 0 }
    inputs { force }
    coordinates { x, z }
    parameters { speed = dot(x); }
    holonomic { on_ground: z = r; }
    kinetic_energy = m/2*(dot(x)^2 + dot(z)^2);
    forces { force along dot(x); }
    outputs { height = z; place = vec(x, 0, z); }
    scene Smaller { track speed; provide height; }
";

/// The names of types that a text of Rust declares, and its single letters, which are generic parameters.
fn names_of_types(stream: TokenStream, found: &mut BTreeSet<String>) {
    let mut declares = false;
    for token in stream {
        if let TokenTree::Ident(name) = &token {
            let name = name.to_string();
            let is_letter = name.len() == 1 && name.starts_with(char::is_uppercase);
            let is_keyword = ["struct", "enum", "type", "trait", "mod", "as"].contains(&name.as_str());
            if (declares || is_letter) && !is_keyword && name.starts_with(char::is_uppercase) {
                found.insert(name);
            }
            declares = is_keyword;
        } else if let TokenTree::Group(group) = token {
            names_of_types(group.stream(), found);
        }
    }
}

/// A system may have every name that the expansion has for a type or a generic parameter, or the macro says at the name that
/// it is taken.
#[test]
fn a_system_may_have_any_name_that_an_expansion_mentions() {
    let expansion =
        |name: &str| guen_language::expand(format!("pub system {name} {{ {GENERAL} }}").parse().unwrap());
    let mut mentioned = BTreeSet::new();
    names_of_types(expansion("Cart"), &mut mentioned);
    for file in ["", "/facts", "/methods", "/motion"] {
        let path = commands::root().join(format!("guen-runtime/src/generated/emitted{file}.rs"));
        names_of_types(std::fs::read_to_string(path).unwrap().parse().unwrap(), &mut mentioned);
    }
    assert!(["R", "S", "B", "I", "L"].iter().all(|letter| mentioned.contains(*letter)), "{mentioned:?}");
    mentioned.extend(["N", "P", "Q", "T", "State", "cart", "placed", "program", "smaller"].map(String::from));
    let mut program = String::from("#![allow(non_camel_case_types)]\n");
    for (i, name) in mentioned.iter().enumerate() {
        if expansion(name).to_string().contains("compile_error") {
            assert!(name.len() > 1, "a letter is a name");
        } else {
            let system = format!("guen::mechanical_system! {{ pub system {name} {{ {GENERAL} }} }}");
            let _ = writeln!(program, "mod m{i} {{ {system} }}");
        }
    }
    let path = commands::scratch("names").join("names.rs");
    std::fs::write(&path, program).unwrap();
    let mut compiler = commands::compiler(&commands::rustc(), "guen");
    let (_, text) = commands::run(compiler.arg("--crate-type=lib").arg(path));
    assert_eq!(text, "");
}

/// A system without constants is a value by its name; and no message speaks of what a struct hides.
#[test]
fn a_system_without_constants_is_a_value() {
    const TEXT: &str = "guen::mechanical_system! {
        pub system Spring { coordinates { x } parameters { v = dot(x); } kinetic_energy = v^2/2; potential_energy = x^2/2; }
    }
    fn main() {
        let _ = [Spring.prepare(), Spring::new().prepare(), Spring::default().prepare()];
        let _ = Spring::with_defaults::<f32>().prepare();
        WRONG
    }";
    let path = commands::scratch("names").join("spring.rs");
    let compile = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let mut compiler = commands::compiler(&commands::rustc(), "guen");
        let output = compiler.arg("--crate-type=bin").arg(&path).output().unwrap();
        (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(compile(&TEXT.replace("WRONG", "")), (true, String::new()));
    let (compiles, message) = compile(&TEXT.replace("WRONG", "let _ = Spring {};"));
    assert!(!compiles && message.contains("Spring::new()"), "{message}");
    assert!(!message.contains("__guen"), "{message}");
}
