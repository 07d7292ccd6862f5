//! One digest for each system: on one and two threads, in four and eight lanes, in one part and in seven, after kills.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use guen::lanes::{Backend, Width};

use crate::Failure;
use crate::systems::{SYSTEMS, sweep};

/// A folder of its own, removed at the end.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn folder(name: &str) -> Folder {
    let path = std::env::temp_dir().join(format!("guen-sweeps-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    Folder(path)
}

/// The digests of all files of a finished sweep.
fn sums(folder: &Path) -> Result<String, Failure> {
    Ok(std::fs::read_to_string(folder.join("SHA256SUMS"))?)
}

/// The program that runs a part.
fn part(system: &str, motions: u64, folder: &Path, part: u64, parts: u64) -> Result<Command, Failure> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["part", system, &motions.to_string()]).arg(folder);
    command.args([part.to_string(), parts.to_string()]).stdout(Stdio::null());
    Ok(command)
}

/// Runs one part again and again and kills it at random times, then lets it finish. Returns the number of kills that came before its end.
fn killed(system: &str, motions: u64, folder: &Path, kills: u32, whole: Duration) -> Result<u32, Failure> {
    // Always the same times: the generator of splitmix64.
    let mut state = 19_u64;
    let mut random = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (bits ^ (bits >> 31)) as f64 / 2.0_f64.powi(64)
    };
    let mut before_the_end = 0;
    for _ in 0..kills {
        let mut program = part(system, motions, folder, 0, 1)?.spawn()?;
        std::thread::sleep(whole.mul_f64(0.15 * random()));
        program.kill()?;
        before_the_end += u32::from(!program.wait()?.success());
    }
    if part(system, motions, folder, 0, 1)?.status()?.success() {
        Ok(before_the_end)
    } else {
        Err("a part failed".into())
    }
}

/// Compares the digests of so many motions of each system.
pub fn compare(motions: u64, kills: u32) -> Result<(), Failure> {
    for system in SYSTEMS {
        let one = folder("one");
        let start = Instant::now();
        let whole = sweep(system, motions)?.with_threads(2).run_in(&one.0)?;
        let took = start.elapsed();
        let expected = sums(&one.0)?;
        let statistics = whole.statistics();
        println!(
            "\n{system}: {} motions, {} faults, {:.1} s",
            statistics.motions(),
            statistics.faults(),
            took.as_secs_f64()
        );
        println!("  {}", whole.digest());
        let check = |what: &str, digest: &str| -> Result<(), Failure> {
            println!("  {what}: {}", if digest == whole.digest() { "equal" } else { "DIFFERENT" });
            if digest == whole.digest() { Ok(()) } else { Err(format!("{system}, {what}").into()) }
        };
        for (what, threads, width) in [
            ("one thread, four lanes", 1, Width::Four),
            ("one thread, eight lanes", 1, Width::Eight),
            ("two threads, four lanes", 2, Width::Four),
        ] {
            let other =
                sweep(system, motions)?.with_threads(threads).with_lanes(Backend::best(), width).run()?;
            check(what, other.digest())?;
            if other.statistics() != statistics {
                return Err(format!("{system}, {what}: statistics").into());
            }
        }
        let (seven, merged) = (folder("seven"), folder("merged"));
        for k in (0..7).rev() {
            if !part(system, motions, &seven.0, k, 7)?.status()?.success() {
                return Err("a part failed".into());
            }
        }
        check("seven parts", sweep(system, motions)?.merge([&seven.0], &merged.0)?.digest())?;
        let killed_in = folder("killed");
        let before = killed(system, motions, &killed_in.0, kills, took)?;
        let what = format!("{kills} kills, {before} of them before the end");
        check(&what, sweep(system, motions)?.merge([&killed_in.0], &killed_in.0)?.digest())?;
        for (what, other) in [("seven parts", &merged.0), ("kills", &killed_in.0)] {
            if sums(other)? != expected {
                return Err(format!("{system}, {what}: files differ").into());
            }
        }
        println!("  all files of the parts, and after the kills: equal");
    }
    Ok(())
}
