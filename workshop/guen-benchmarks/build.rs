//! Writes the declarations of the chains and of the arms, and tells the library how it is being built.

use std::{env, fs, path::Path};

#[path = "src/arms.rs"]
#[allow(dead_code, reason = "longer arms are not compiled")]
mod arms;
#[path = "src/chains.rs"]
mod chains;

fn main() {
    let folder = env::var_os("OUT_DIR").expect("cargo names a folder for what is generated");
    for (file, text) in [("chains.rs", chains::declarations()), ("arms.rs", arms::declarations())] {
        fs::write(Path::new(&folder).join(file), text).expect("the folder can be written");
    }
    let variable = |name: &str| env::var(name).ok().filter(|value| !value.is_empty());
    let setting = |name: &str, otherwise: &str| variable(name).unwrap_or_else(|| otherwise.to_owned());
    println!("cargo::rerun-if-changed=src/chains.rs");
    println!("cargo::rerun-if-changed=src/arms.rs");
    println!("cargo::rustc-env=GUEN_TARGET={}", setting("TARGET", "unknown"));
    println!("cargo::rustc-env=GUEN_OPT_LEVEL={}", setting("OPT_LEVEL", "unknown"));
    println!("cargo::rustc-env=GUEN_TARGET_FEATURES={}", setting("CARGO_CFG_TARGET_FEATURE", "none"));
    let flags = setting("CARGO_ENCODED_RUSTFLAGS", "none").replace('\u{1f}', " ");
    println!("cargo::rustc-env=GUEN_RUSTFLAGS={flags}");
    let lto = ["CARGO_PROFILE_BENCH_LTO", "CARGO_PROFILE_RELEASE_LTO"];
    for name in lto {
        println!("cargo::rerun-if-env-changed={name}");
    }
    let lto = lto.iter().find_map(|name| variable(name)).unwrap_or_else(|| "as cargo has it".to_owned());
    println!("cargo::rustc-env=GUEN_LTO={lto}");
}
