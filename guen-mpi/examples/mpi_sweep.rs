//! A sweep over the ranks of MPI, and the same one in a single process: both leave the same files.
//!
//! ```text
//! mpirun -n 4 mpi_sweep ranks MOTIONS FOLDER
//! mpi_sweep one MOTIONS FOLDER
//! ```
//!
//! Every rank prints how many chunks it has computed; rank 0 prints the report and the digest of all rows. `mpirun -n 4 mpi_sweep panics MOTIONS FOLDER` has a closure
//! that panics at the last motion: then all ranks end.

use std::error::Error;
use std::f64::consts::TAU;
use std::process::ExitCode;

use guen_mpi::mpi::traits::Communicator;
use guen_mpi::mpi::{self, Threading};
use guen_runtime::from_fn;
use guen_runtime::steppers::Dop853;
use guen_study::{Design, Sweep};

/// Twenty revolutions of a planet on ellipses that are drawn: the longer ones take several times the steps of round ones. What comes from beyond the sun's
/// neighbourhood is refused, and becomes a row with its cause.
fn orbits(motions: u64, panics: bool) -> Sweep<'static> {
    let design = Design::latin_hypercube(motions, 1).uniform("eccentricity", 0.0, 1.01);
    Sweep::over(design, move |point| {
        assert!(!panics || point.index() < motions - 1, "the last motion panics, as it was asked for");
        let e = point.get("eccentricity")?;
        if e >= 1.0 {
            return Err(format!("an orbit of eccentricity {e} has no period").into());
        }
        let gravity = |_t: f64, &[x, y, u, v]: &[f64; 4]| {
            let cube = (x * x + y * y).powi(2) / x.hypot(y);
            [u, v, -x / cube, -y / cube]
        };
        let fastest = ((1.0 + e) / (1.0 - e)).sqrt();
        Ok((from_fn(gravity), [1.0 - e, 0.0, 0.0, fastest]))
    })
    .simulations([("x", ""), ("y", ""), ("u", ""), ("v", "")], |simulation| {
        simulation.method(Dop853::new(1e-10, 1e-12)).run(0.0..20.0 * TAU).map(|motion| motion.end())
    })
    .named("orbits")
    .with_chunk(40)
    .silent()
}

fn over_ranks(sweep: &Sweep<'_>, folder: &str) -> Result<(), Box<dyn Error>> {
    let (universe, _) =
        mpi::initialize_with_threading(Threading::Funneled).ok_or("MPI is initialised already")?;
    let world = universe.world();
    let share = guen_mpi::run(sweep, folder, &world)?;
    println!("rank {} of {}: {} chunks", world.rank(), world.size(), share.computed);
    if let Some((report, summary)) = share.whole {
        println!("found {} computed {} rewritten {}", report.found, report.computed, report.rewritten);
        println!("{}", summary.digest());
    }
    Ok(())
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["ranks", motions, folder] => over_ranks(&orbits(motions.parse()?, false), folder),
        ["panics", motions, folder] => over_ranks(&orbits(motions.parse()?, true), folder),
        ["one", motions, folder] => {
            println!("{}", orbits(motions.parse()?, false).run_in(folder)?.digest());
            Ok(())
        }
        _ => Err("ranks MOTIONS FOLDER, or one MOTIONS FOLDER".into()),
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
