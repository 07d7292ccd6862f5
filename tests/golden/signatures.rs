//! Methods that a scene lacks have the signatures of the system's: those that the language writes, and those of the runtime's macros.

use std::fs;
use std::path::Path;

use guen_language::expand;

/// A system that has all methods, and a scene that has none of those that a scene can lack.
const SYSTEM: &str = "pub system Rider {
    constants { m > 0, L > 0 }
    inputs { push }
    coordinates { x, y, angle }
    parameters { speed = dot(x); }
    constraints { ahead: dot(y) = x*dot(x); }
    holonomic { hinge: angle = x/L; }
    kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2;
    force_function = -m*x^2;
    forces { push along speed; }
    outputs { place = vec(x, y); quickness = speed; }
    scene Bare { track y; }
}";

const METHODS: [&str; 11] = [
    "energy",
    "reactions",
    "outputs",
    "linearize",
    "linearize_outputs",
    "residuals",
    "velocities",
    "kinetic_energy",
    "force_function",
    "momenta",
    "power",
];

/// A text without blanks and documentation.
fn bare(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.flat_map(str::split_whitespace).collect()
}

/// The macros of the runtime, as they write the methods of a system with inputs.
fn macros() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ is in the repository");
    let text =
        fs::read_to_string(root.join("guen-runtime/src/generated/emitted/motion.rs")).expect("the macros");
    bare(&text).replace("$(,$inputs:&Inputs<R>)?", ",inputs:&Inputs<R>").replace("$crate::", "__guen::")
}

/// The parameters and the type of a method, from the first time that it is written.
fn signature<'a>(text: &'a str, method: &str, end: &str) -> Option<&'a str> {
    let start = format!("pubfn{method}(");
    let rest = &text[text.find(&start)? + start.len()..];
    Some(&rest[..rest.find(end)?])
}

#[test]
fn methods_that_a_scene_lacks_have_the_signatures_of_the_system() {
    let text = bare(&expand(SYSTEM.parse().unwrap()).to_string());
    let (system, scene) = text.split_once("modmissing").expect("methods are missing");
    let macros = macros();
    assert_eq!(scene.matches("pubtrait").count(), METHODS.len(), "{scene}");
    for method in METHODS {
        let missing = signature(scene, method, "where").unwrap_or_else(|| panic!("{method} in {scene}"));
        let real = if macros.contains(&format!("quantity!{{{method}}}")) {
            signature(&macros, "$method", "{")
        } else {
            signature(system, method, "{").or_else(|| signature(&macros, method, "{"))
        };
        let real = real.unwrap_or_else(|| panic!("the system has no {method}"));
        // By duals, a linearisation says of which reals it is one.
        let real = real.split("where").next().unwrap_or(real);
        // The scene has fewer variables; its records are those of the system.
        let missing = missing.replace("super::", "");
        assert_eq!(missing.replace("<R,3usize", "<R,SIZE"), real.replace("<R,4usize", "<R,SIZE"), "{method}");
    }
}
