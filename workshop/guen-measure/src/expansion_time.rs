//! How long the macro takes: the expansion of every example system, stage by stage, inside of a compiler.
//!
//! ```text
//! cargo run -p guen-measure --bin expansion_time
//! cargo run -p guen-measure --bin expansion_time -- --quick     # every system once: that it works, and no figures to compare
//! ```
//!
//! Without `--release`: cargo builds procedural macros without optimisation, in a user's dev profile and in the release
//! profile too, so these are the times that a user waits. They are taken by a macro inside of rustc (`workshop/guen-expansion-timing`),
//! whose lexer and tokens are others than those that a program without a compiler has. The declarations of the examples
//! are cut out of their files; beside them stand the chains of the benchmarks, with absolute angles and with relative ones,
//! and the largest systems of the tests: vehicles, snakes, contacts with a square root, moving belts, prescribed motions, an arm, a quadruped and
//! a humanoid.
//! Systems with five scenes stand below themselves without: what scenes cost while the macro runs. In the program a scene
//! that is not used costs nothing, for what is emitted is generic.
//!
//! The times of the stages and their sum are medians of several expansions, followed by the shares of deriving and
//! emitting in percent, the least sum, and the mean time on a processor, known on Linux only: both depend less on what
//! else the machine does.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs, io};

use guen_benchmarks::chains::{Angles, declaration as declaration_of_chain};
use guen_benchmarks::{arms, robots};
use guen_language::expand;
use guen_study::{Progress, Table};
use proc_macro2::{TokenStream, TokenTree};

mod large_systems;
#[path = "some_scenes.rs"]
mod scenes;

/// The files whose first declarations are expanded.
const FILES: [(&str, &str); 5] = [
    ("hoop", include_str!("../../../examples/hoop.rs")),
    ("appell", include_str!("../../../examples/appell.rs")),
    ("chaplygin_sled", include_str!("../../../examples/chaplygin_sled.rs")),
    ("bicycle", include_str!("../../../tests/spatial/bicycle.rs")),
    ("wheel on ice", include_str!("../../../examples/spinning_wheel.rs")),
];
const CHAINS: [usize; 4] = [2, 5, 10, 20];
const SNAKES: [usize; 4] = [5, 6, 7, 10];

fn main() -> ExitCode {
    if !cfg!(debug_assertions) {
        println!(
            "this is an optimised build, and the compiler's macro is none: see `cargo run -p guen-measure --bin expansion_time`\n"
        );
    }
    let mut systems: Vec<(String, TokenStream)> = Vec::new();
    for (name, source) in FILES {
        let tokens = scenes::declaration(source);
        systems.push((name.to_owned(), tokens.clone()));
        if let Some((_, five)) = scenes::FIVE.iter().find(|(owner, _)| *owner == name) {
            systems.push(("  with scenes".to_owned(), scenes::added(tokens, five)));
        }
    }
    let mut add = |name: String, text: &str| systems.push((name, text.parse().expect("these are tokens")));
    for (angles, name) in [(Angles::Absolute, "chain"), (Angles::Relative, "joints")] {
        for links in CHAINS {
            add(format!("{name} of {links}"), &declaration_of_chain("Chain", links, angles));
        }
    }
    SNAKES.iter().for_each(|&links| add(format!("snake of {links}"), &large_systems::snake(links)));
    add("tricycle".to_owned(), large_systems::TRICYCLE);
    add("ellipsoid".to_owned(), large_systems::LADEN_ELLIPSOID);
    add("biped".to_owned(), large_systems::BIPED);
    add("arm of 6".to_owned(), &arms::declaration("Arm", &arms::AXES[..6]));
    add("quadruped".to_owned(), &robots::quadruped());
    add("humanoid".to_owned(), &robots::declaration(&robots::HUMANOID));

    let compiler = match Compiler::new() {
        Ok(compiler) => compiler,
        Err(error) => {
            eprintln!("times inside of a compiler need a build of guen-expansion-timing: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut healthy = true;
    let mut names = vec!["system"];
    let columns = [
        "tokens",
        "emitted",
        "parse",
        "resolve",
        "derive",
        "emit",
        "sum in ms",
        "derive %",
        "emit %",
        "least",
        "on processor",
    ];
    let mut table = Table::new(&columns).digits(3);
    let mut progress = Progress::new(0.0, systems.len() as f64);
    for (k, (name, tokens)) in systems.iter().enumerate() {
        progress.at(k as f64);
        let items = expand(tokens.clone());
        if items.to_string() != expand(tokens.clone()).to_string() {
            eprintln!("{name}: two expansions differ");
            healthy = false;
        }
        let sizes = [size(tokens.clone()) as f64, size(items) as f64];
        match compiler.stages(tokens) {
            Ok([parse, resolve, derive, emit, least, processor]) => {
                let sum = parse + resolve + derive + emit;
                let shares = [derive, emit].map(|time| 100.0 * time / sum);
                let times = [parse, resolve, derive, emit, sum];
                table.row(&[&sizes[..], &times, &shares, &[least, processor]].concat());
                names.push(name);
            }
            Err(error) => {
                eprintln!("{name}: {error}");
                healthy = false;
            }
        }
    }
    progress.finish();
    // The names stand beside the table, whose cells are numbers.
    let text = table.to_string();
    let mut names = names.into_iter();
    for (index, line) in text.lines().enumerate() {
        let name = if index == 1 { "--------------" } else { names.next().unwrap_or_default() };
        println!("{name:14}  {line}");
    }
    if healthy { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// rustc with the macro that measures.
struct Compiler {
    folder: PathBuf,
    clock: PathBuf,
}

impl Compiler {
    /// Builds `guen-expansion-timing`, or finds it built, in this program's own target folder.
    fn new() -> io::Result<Self> {
        let program = env::current_exe()?;
        // .../debug/expansion_time
        let target = program.ancestors().nth(2).ok_or_else(|| io::Error::other("no target folder"))?;
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args([
                "build",
                "--offline",
                "-p",
                "guen-expansion-timing",
                "--message-format=json",
                "--target-dir",
            ])
            .arg(target)
            .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
            .output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let is_clock = |word: &&str| {
            let name = Path::new(word).file_name().and_then(|name| name.to_str()).unwrap_or_default();
            word.ends_with(env::consts::DLL_SUFFIX) && name.contains("guen_expansion_timing")
        };
        let clock = text.split('"').find(is_clock);
        let clock =
            clock.ok_or_else(|| io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned()))?;
        let folder = target.join("guen/expansion_time");
        fs::create_dir_all(&folder)?;
        Ok(Compiler { folder, clock: PathBuf::from(clock) })
    }

    /// The milliseconds of the stages parse, resolve, derive and emit, the least sum, and the mean on a processor.
    fn stages(&self, declaration: &TokenStream) -> io::Result<[f64; 6]> {
        let file = self.folder.join("stages.rs");
        fs::write(&file, format!("guen_expansion_timing::stages! {{ {declaration} }}"))?;
        let mut clock = std::ffi::OsString::from("guen_expansion_timing=");
        clock.push(&self.clock);
        let mut rustc = Command::new("rustc");
        if env::args().any(|argument| argument == "--quick") {
            rustc.env("GUEN_ONCE", "");
        }
        let output = rustc
            .args(["--edition=2024", "--crate-type=lib", "--emit=metadata", "--out-dir"])
            .arg(&self.folder)
            .arg("--extern")
            .arg(clock)
            .arg(&file)
            .output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let times: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        times.try_into().map_err(|_| io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned()))
    }
}

/// The number of tokens, those in groups included.
fn size(tokens: TokenStream) -> usize {
    let inside = |token| match token {
        TokenTree::Group(group) => 1 + size(group.stream()),
        _ => 1,
    };
    tokens.into_iter().map(inside).sum()
}
