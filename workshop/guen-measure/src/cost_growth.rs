//! How cost grows with the size of a system: planar chains, in absolute and in relative angles.
//!
//! ```text
//! cargo run -p guen-measure --bin cost_growth            # up to 20 links
//! cargo run -p guen-measure --bin cost_growth -- 12      # up to 12
//! ```
//!
//! For each number of links: the operations of the right-hand side, the time of the expansion, and the time that rustc
//! then spends on what was emitted, with one instance of the right-hand side in `f64`: for checking alone, without
//! optimisation, and with it. What rustc takes for an empty crate is not in these figures. All times are those on processors,
//! the mean of several expansions and the least of several compilations, which depend little on what else the machine does; they are
//! known on Linux only. Below each table stand the exponents `p` of fits `c links^p`.
//!
//! Then the hoop and Chaplygin's sled, each without scenes and with five that nobody uses; and systems without their Taylor
//! series, with it declared and not used, and with an instance of it in `f64`.
//!
//! Without `--release`: cargo builds procedural macros without optimisation, so that is the time that a user waits.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs, io};

use guen_benchmarks::chains::{Angles, declaration};
use guen_benchmarks::timing::{processor_time, processor_time_of_children};
use guen_language::diagnostics::collect;
use guen_language::{derive, emit, model, parse};
use guen_study::{Progress, Table};

#[path = "../../../examples/common/arguments.rs"]
mod arguments;
#[path = "some_scenes.rs"]
mod scenes;

const MOST: usize = 20;
/// Below this, costs that do not grow are most of the whole: the fits leave it out.
const ASYMPTOTIC: usize = 5;
/// An expansion is repeated so often, for the mean: the clock is read in steps of milliseconds. A compilation, for the least
/// time: what else the machine does empties the caches of a processor too.
const EXPANSIONS: usize = 7;
const COMPILATIONS: usize = 3;
/// The numbers of links that are shown.
const LINKS: [usize; 8] = [1, 2, 3, 5, 7, 10, 14, 20];
const COLUMNS: [&str; 6] = ["links", "operations", "expand/ms", "check/ms", "opt 0/ms", "opt 3/ms"];

fn main() -> ExitCode {
    if !cfg!(debug_assertions) {
        println!(
            "this is an optimised build, and the compiler's macro is none: see `cargo run -p guen-measure --bin cost_growth`\n"
        );
    }
    let about =
        "How cost grows with the size of a system: planar chains, in absolute and in relative angles.";
    let links = |word: &str| word.parse().ok().filter(|links| *links > 0);
    let most = match arguments::read(about, "LINKS", "of the longest chain; 20 by default", MOST, links) {
        Ok(most) => most,
        Err(status) => return status,
    };
    let compiler = match Compiler::new() {
        Ok(compiler) => compiler,
        Err(error) => {
            eprintln!("rustc's times need a build of guen: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut healthy = true;
    // The whole takes minutes: the line says how far it is, counted in links.
    let shown = || LINKS.into_iter().filter(|links| *links <= most);
    let (mut done, all) = (0, 2 * shown().sum::<usize>());
    let mut progress = Progress::new(0.0, all as f64);
    for (angles, name) in [(Angles::Absolute, "absolute"), (Angles::Relative, "relative")] {
        let mut rows: Vec<[f64; 6]> = Vec::new();
        let mut table = Table::new(&COLUMNS).digits(4);
        for links in shown() {
            match row(&compiler, links, angles) {
                Ok(row) => {
                    table.row(&row);
                    rows.push(row);
                }
                Err(error) => {
                    eprintln!("{links} links in {name} angles: {error}");
                    healthy = false;
                }
            }
            done += links;
            progress.at(done as f64);
        }
        println!("chains in {name} angles\n{table}");
        let exponents: Vec<String> =
            (1..6).map(|column| format!("{} {:.2}", COLUMNS[column], exponent(&rows, column))).collect();
        println!("exponents from {ASYMPTOTIC} links on: {}\n", exponents.join(", "));
    }
    progress.finish();
    if let Err(error) = unused_scenes(&compiler).and_then(|()| taylor_series(&compiler)) {
        eprintln!("systems with scenes or series: {error}");
        return ExitCode::FAILURE;
    }
    if healthy { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Prints the costs of the hoop and of the sled without scenes and with five.
fn unused_scenes(compiler: &Compiler) -> Result<(), String> {
    let systems = [
        ("hoop", include_str!("../../../examples/hoop.rs"), 9),
        ("sled", include_str!("../../../examples/chaplygin_sled.rs"), 5),
    ];
    for ((module, source, variables), (_, five)) in systems.into_iter().zip(scenes::FIVE) {
        let mut table = Table::new(&[&["scenes"], &COLUMNS[1..]].concat()).digits(4);
        let bare = scenes::declaration(source);
        // The first expansion of a process is slower than the others.
        expanded(&bare.to_string())?;
        for (count, tokens) in [(0.0, bare.clone()), (5.0, scenes::added(bare, five))] {
            let costs = costs(compiler, &tokens.to_string(), module, variables, "")?;
            table.row(&[&[count], &costs[..]].concat());
        }
        println!("{module}, without scenes and with five that are not used\n{table}\n");
    }
    Ok(())
}

/// Prints the costs of systems without Taylor series, with one that is not used, and with one that is.
fn taylor_series(compiler: &Compiler) -> Result<(), String> {
    let chains = [5, 10, 20].map(|links| (links, declaration("Chain", links, Angles::Absolute)));
    let mut systems = vec![(
        "hoop".to_owned(),
        "hoop",
        scenes::declaration(include_str!("../../../examples/hoop.rs")).to_string(),
        9,
    )];
    for (links, text) in chains {
        systems.push((format!("chain of {links}"), "chain", text, 2 * links));
    }
    for (name, module, text, variables) in systems {
        let mut table = Table::new(&[&["provided", "used"], &COLUMNS[1..]].concat()).digits(4);
        let end = text.rfind('}').ok_or("a declaration ends with a brace")?;
        let provided = format!("{} provide taylor; }}", &text[..end]);
        expanded(&text)?;
        for (provides, uses) in [(false, false), (true, false), (true, true)] {
            let text = if provides { &provided } else { &text };
            let call = format!(
                "pub fn series(it: &{module}::Prepared<f64>, state: &[f64; {variables}], to: &mut guen::Coefficients<f64, {variables}>) {{ guen::TaylorSeries::series(it, 0.0, state, 0.125, 20, to) }}",
            );
            let costs = costs(compiler, text, module, variables, if uses { &call } else { "" })?;
            table.row(&[&[f64::from(u8::from(provides)), f64::from(u8::from(uses))], &costs[..]].concat());
        }
        println!("{name}, without its Taylor series and with it\n{table}\n");
    }
    Ok(())
}

/// One line of the table.
fn row(compiler: &Compiler, links: usize, angles: Angles) -> Result<[f64; 6], String> {
    let text = declaration("Chain", links, angles);
    let [operations, expansion, check, plain, optimised] = costs(compiler, &text, "chain", 2 * links, "")?;
    Ok([links as f64, operations, expansion, check, plain, optimised])
}

/// Operations, and the milliseconds of the expansion and of what rustc is asked for; with more items beside it.
fn costs(
    compiler: &Compiler,
    text: &str,
    module: &str,
    variables: usize,
    more: &str,
) -> Result<[f64; 5], String> {
    let (mut code, mut operations) = (String::new(), 0);
    let start = processor_time();
    for _ in 0..EXPANSIONS {
        (code, operations) = expanded(text)?;
    }
    let expansion = (processor_time() - start) * 1e3 / EXPANSIONS as f64;
    let source = format!(
        "{code}\npub fn rates(it: &{module}::Prepared<f64>, state: &[f64; {variables}]) -> [f64; {variables}] {{ guen::System::rhs(it, 0.0, state) }}\n{more}",
    );
    let mut times = [0.0; 3];
    for (time, mode) in times.iter_mut().zip(Mode::ALL) {
        let least = |source: &str| -> Result<f64, String> {
            let mut least = f64::INFINITY;
            for _ in 0..COMPILATIONS {
                least = least.min(compiler.time(source, mode).map_err(|error| error.to_string())?);
            }
            Ok(least)
        };
        *time = (least(&source)? - least("")?).max(0.0);
    }
    let [check, plain, optimised] = times;
    Ok([f64::from(operations), expansion, check, plain, optimised])
}

/// What the macro makes of a declaration, and the operations of its right-hand side.
fn expanded(text: &str) -> Result<(String, u32), String> {
    let tokens = text.parse().map_err(|error| format!("{error:?}"))?;
    let (parsed, report) = parse::parse(tokens);
    let parsed = parsed.ok_or_else(|| report.to_string())?;
    let (resolved, report) = collect(|faults| model::resolve(&parsed, faults));
    let resolved = resolved.ok_or_else(|| report.to_string())?;
    let (derived, report) = collect(|faults| derive::derive(resolved, faults));
    let derived = derived.ok_or_else(|| report.to_string())?;
    let rates =
        derived.system.programs.functions.iter().find(|program| program.name == derive::function::RHS);
    let cost = rates.map(|program| program.cost).unwrap_or_default();
    let operations = cost.operations() + cost.sines + cost.calls;
    Ok((emit::emit(derived).to_string(), operations))
}

/// The slope of the regression of logarithms.
fn exponent(rows: &[[f64; 6]], column: usize) -> f64 {
    let points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| row[0] >= ASYMPTOTIC as f64 && row[column] > 0.0)
        .map(|row| (row[0].ln(), row[column].ln()))
        .collect();
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / n, y + point.1 / n));
    let (xy, xx) = points
        .iter()
        .fold((0.0, 0.0), |(xy, xx), point| (xy + (point.0 - x) * (point.1 - y), xx + (point.0 - x).powi(2)));
    xy / xx
}

/// What rustc is asked for.
#[derive(Clone, Copy)]
enum Mode {
    Check,
    Plain,
    Optimised,
}

impl Mode {
    const ALL: [Mode; 3] = [Mode::Check, Mode::Plain, Mode::Optimised];

    fn arguments(self) -> &'static [&'static str] {
        match self {
            Mode::Check => &["--emit=metadata"],
            Mode::Plain => &["--emit=metadata,link", "-Copt-level=0", "-Cdebuginfo=2"],
            Mode::Optimised => &["--emit=metadata,link", "-Copt-level=3"],
        }
    }
}

/// rustc with a `guen` to link to.
struct Compiler {
    folder: PathBuf,
    library: PathBuf,
}

impl Compiler {
    /// Builds `guen`, or finds it built, in this program's own target folder.
    fn new() -> io::Result<Self> {
        let program = env::current_exe()?;
        // .../debug/cost_growth
        let target = program.ancestors().nth(2).ok_or_else(|| io::Error::other("no target folder"))?;
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["build", "--offline", "-p", "guen", "--lib", "--message-format=json", "--target-dir"])
            .arg(target)
            .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
            .output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let library = text
            .split('"')
            .filter(|word| word.ends_with(".rlib"))
            .find(|word| Path::new(word).file_name().is_some_and(|name| name == "libguen.rlib"));
        let library =
            library.ok_or_else(|| io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned()))?;
        let folder = target.join("guen/cost_growth");
        fs::create_dir_all(&folder)?;
        Ok(Compiler { folder, library: PathBuf::from(library) })
    }

    /// The milliseconds that rustc takes for a crate.
    fn time(&self, source: &str, mode: Mode) -> io::Result<f64> {
        let file = self.folder.join("growth.rs");
        fs::write(&file, source)?;
        let mut dependencies = std::ffi::OsString::from("dependency=");
        // The library is in the folder above that of what it depends on, or beside it.
        let place = self.library.parent().unwrap_or(&self.folder);
        dependencies.push(if place.ends_with("deps") { place.to_owned() } else { place.join("deps") });
        let mut library = std::ffi::OsString::from("guen=");
        library.push(&self.library);
        let start = processor_time_of_children();
        let output = Command::new("rustc")
            .args(["--edition=2024", "--crate-type=lib", "--cap-lints=allow", "--out-dir"])
            .arg(&self.folder)
            .args(mode.arguments())
            .arg("-L")
            .arg(dependencies)
            .arg("--extern")
            .arg(library)
            .arg(&file)
            .output()?;
        if output.status.success() {
            Ok((processor_time_of_children() - start) * 1e3)
        } else {
            Err(io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned()))
        }
    }
}
