//! What a sweep costs beside a loop over ensembles of the same motions, and its memory.

use std::hint::black_box;

use guen::prelude::*;
use guen_study::{Ensemble, Rows};

use crate::Failure;
use crate::systems::{hoop_design, hoop_of, hoops};

/// The steps of a motion: ten seconds of the hoop.
const STEPS: f64 = 1000.0;
const METHOD: Rk4 = Rk4::new(0.01);
/// The times that are aimed at, in parts of the bare loop. They are printed, and fail nothing: a busy machine makes
/// single ratios of 1.3.
const STATISTICS: f64 = 1.03;
const PARQUET: f64 = 1.10;

/// The time that this thread has had a processor, in seconds: what others do on the machine does not count. The system brings it up to date
/// every few milliseconds, and when a thread yields.
fn processor_time() -> Result<f64, Failure> {
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    Ok(text.split(' ').next().unwrap_or_default().parse::<f64>()? / 1e9)
}

fn timed(work: impl FnOnce() -> Result<(), Failure>) -> Result<f64, Failure> {
    let start = processor_time()?;
    work()?;
    Ok(processor_time()? - start)
}

/// Motions made and integrated in lanes, 256 at a time, and their ends added up.
fn bare(points: &[[f64; 3]]) -> Result<(), Failure> {
    const BATCH: usize = 256;
    let mut sum = [0.0; 9];
    for points in points.chunks(BATCH) {
        let members: Vec<_> =
            points.iter().filter_map(|[a, lean, spin]| hoop_of(*a, *lean, *spin).ok()).collect();
        let ensemble =
            Ensemble::of_systems(members.iter().map(|(hoop, start)| (hoop, *start))).with_threads(1);
        for end in ensemble.integrate(&METHOD, 0.0, 0.01 * STEPS).iter().flatten() {
            sum.iter_mut().zip(end.state).for_each(|(sum, x)| *sum += x);
        }
    }
    black_box(sum);
    Ok(())
}

/// Compares the time of a bare loop with that of a sweep, with statistics alone and with Parquet of end states.
pub fn compare(motions: u64, rounds: usize) -> Result<(), Failure> {
    let folder = std::env::temp_dir().join(format!("guen-sweeps-cost-{}", std::process::id()));
    let design = hoop_design(motions).design();
    let points: Vec<[f64; 3]> =
        (0..motions).filter_map(|motion| design.point(motion)?.try_into().ok()).collect();
    let sweep = || hoops(motions).end_states(METHOD, 0.0..0.01 * STEPS).with_threads(1).silent();
    let mut times: [Vec<f64>; 3] = Default::default();
    for _ in 0..rounds {
        let _ = std::fs::remove_dir_all(&folder);
        let round = [
            timed(|| bare(&points))?,
            timed(|| {
                black_box(sweep().run()?);
                Ok(())
            })?,
            timed(|| {
                black_box(sweep().with_rows(Rows::Parquet).part(0, 1)?.run_in(&folder)?);
                Ok(())
            })?,
        ];
        times.iter_mut().zip(round).for_each(|(all, one)| all.push(one));
    }
    let bytes: u64 = std::fs::read_dir(folder.join("rows"))?
        .flatten()
        .flat_map(|file| file.metadata())
        .map(|file| file.len())
        .sum();
    std::fs::remove_dir_all(&folder)?;
    // The least of each is the least disturbed.
    let least = times.map(|all| all.into_iter().fold(f64::INFINITY, f64::min));
    println!(
        "\n{motions} hoops, {STEPS} steps of RK4 each, processor time of one thread, least of {rounds} rounds"
    );
    println!("  bare loop over ensembles   {:8.2} us a motion", 1e6 * least[0] / motions as f64);
    for (what, time, limit) in
        [("with statistics ", least[1], STATISTICS), ("with Parquet too", least[2], PARQUET)]
    {
        let ratio = time / least[0];
        println!(
            "  {what}           {:8.2} us a motion, {ratio:.3} of it; aimed at {limit}",
            1e6 * time / motions as f64
        );
    }
    println!("  {:.0} bytes of Parquet a motion", bytes as f64 / motions as f64);
    Ok(())
}

/// The most memory that this process has had, in MB.
fn peak() -> Result<f64, Failure> {
    let text = std::fs::read_to_string("/proc/self/status")?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no peak of memory")?;
    Ok(line.trim().trim_end_matches(" kB").trim().parse::<f64>()? / 1e3)
}

/// The memory of a sweep of so many short motions, rows as Parquet.
pub fn memory(motions: u64) -> Result<(), Failure> {
    let folder = std::env::temp_dir().join(format!("guen-sweeps-memory-{}", std::process::id()));
    let sweep = hoops(motions).end_states(METHOD, 0.0..0.1).with_rows(Rows::Parquet).with_threads(2).silent();
    let report = sweep.part(0, 1)?.run_in(&folder)?;
    let after = peak()?;
    std::fs::remove_dir_all(&folder)?;
    println!("{motions} motions in {} chunks: {after:.0} MB at most", report.computed);
    if after < 200.0 { Ok(()) } else { Err(format!("{after:.0} MB").into()) }
}
