//! Cargo, the compiler and the linker as tests call them: without a network, without the user's flags, and in the target
//! folder of the tests, where the macro is built already.
//!
//! Libraries are built from packages of the workspace in its dev profile, with settings of this call alone. Cargo then
//! finds the macro, which takes most of the time, as the tests have built it: see `[profile.dev.build-override]`.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use serde_json::Value;

/// The folder of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ is in the repository")
}

/// The target folder, wherever the user wants it.
fn target() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("cargo makes it in the target folder")
}

/// A folder for the files of one test.
pub fn scratch(name: &str) -> PathBuf {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&place).unwrap_or_else(|error| panic!("{}: {error}", place.display()));
    place
}

/// A program of the toolchain: what the variable names, or what is found.
fn program(variable: &str, name: &str) -> OsString {
    env::var_os(variable).unwrap_or_else(|| name.into())
}

/// Runs a command that has to succeed; returns what it prints and what it complains of.
pub fn run(command: &mut Command) -> (String, String) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{command:?}: {text}");
    (String::from_utf8_lossy(&output.stdout).into_owned(), text)
}

/// The C compiler, which is the linker that Rust itself needs.
pub fn cc() -> Command {
    let mut command = Command::new(program("CC", "cc"));
    command.args(["-std=c11", "-Wall", "-Werror", "-O1", "-Wl,--gc-sections"]);
    command
}

/// Cargo in the repository.
pub fn cargo(subcommand: &str) -> Command {
    let mut command = Command::new(program("CARGO", "cargo"));
    command.args([subcommand, "--offline", "--target-dir"]).arg(target()).current_dir(root());
    for flags in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_TARGET"] {
        command.env_remove(flags);
    }
    command
}

/// The name of the machine that the tests run on.
pub fn host() -> &'static str {
    static HOST: OnceLock<String> = OnceLock::new();
    HOST.get_or_init(|| {
        let (version, _) = run(Command::new(program("RUSTC", "rustc")).arg("-vV"));
        let host = version.lines().find_map(|line| line.strip_prefix("host: "));
        host.expect("rustc says what its host is").to_owned()
    })
}

/// What `[profile.bare]` says, for the dev profile: optimised, nothing checked, panics abort.
const OPTIMISED: [&str; 7] = [
    "profile.dev.codegen-units=1",
    "profile.dev.debug=0",
    "profile.dev.debug-assertions=false",
    "profile.dev.incremental=false",
    "profile.dev.opt-level=3",
    "profile.dev.overflow-checks=false",
    "profile.dev.panic=\"abort\"",
];

/// Builds the library of a package, optimised; returns the folder it is in, and what cargo says.
///
/// The target is named although it is the host: flags are for the library then, and not for the macro.
pub fn optimised(package: &str, target_name: &str, kind: &str, flags: &[&str]) -> (PathBuf, String) {
    let mut command = cargo("rustc");
    command.args(["--lib", "-p", package, "--target", target_name, "--crate-type", kind]);
    for setting in OPTIMISED {
        command.args(["--config", setting]);
    }
    // Dependencies that can be optimised together with what uses them.
    command.arg("--config").arg(format!("target.{target_name}.rustflags=[\"-Cembed-bitcode=yes\"]"));
    let (_, text) = run(command.arg("--").args(flags));
    (target().join(target_name).join("debug"), text)
}

/// A static library for this machine, optimised across all its crates: its place.
pub fn static_library(package: &str) -> PathBuf {
    let (folder, _) = optimised(package, host(), "staticlib", &["-Clto=fat"]);
    folder.join(format!("lib{}.a", package.replace('-', "_")))
}

/// The compiler with the facade `guen` under some name, for programs that are not built by cargo.
pub fn compiler(compiler: &str, name_of_facade: &str) -> Command {
    static FACADE: OnceLock<PathBuf> = OnceLock::new();
    let facade = FACADE.get_or_init(|| {
        let (messages, _) = run(cargo("check").args([
            "-p",
            "guen",
            // The macro of the tests is built with its features.
            "-p",
            "guen-unified",
            "--lib",
            "--no-default-features",
            "--features",
            "guen/std",
            "--message-format=json",
        ]));
        let artifact = |line: &str| {
            let message: Value = serde_json::from_str(line).ok()?;
            let ours = message["reason"] == "compiler-artifact" && message["target"]["name"] == "guen";
            let files = message["filenames"].as_array().filter(|_| ours)?;
            files.iter().filter_map(Value::as_str).find(|file| file.ends_with(".rmeta")).map(PathBuf::from)
        };
        messages.lines().find_map(artifact).expect("cargo says where the facade is")
    });
    let mut command = Command::new(compiler);
    let mut with = OsString::from(format!("{name_of_facade}="));
    with.push(facade);
    let mut dependencies = OsString::from("dependency=");
    dependencies.push(facade.parent().expect("it is in a folder"));
    command
        .args(["--edition=2024", "--emit=metadata", "--extern"])
        .arg(with)
        .arg("-L")
        .arg(dependencies)
        .arg("--out-dir")
        .arg(scratch("compiled"))
        .current_dir(root());
    command
}

/// `rustc`, or the one that the user names.
pub fn rustc() -> String {
    program("RUSTC", "rustc").to_string_lossy().into_owned()
}
