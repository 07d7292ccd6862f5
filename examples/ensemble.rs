//! Four thousand hoops that are made almost alike and start almost alike: how a small uncertainty spreads.
//!
//! ```text
//! cargo run --release --example ensemble              # 4096 hoops
//! cargo run --release --example ensemble -- 100000    # any other number
//! ```
//!
//! Integrates all of them in lanes and on all threads, prints how far apart they are in the course of time, writes
//! pictures to `target/guen/ensemble`, and ends with a nonzero status if a hoop loses energy.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use guen::lanes::Backend;
use guen::mechanical_system;
use guen::prelude::*;
use guen_study::{Ensemble, Plot, Progress, Sampled, Table};

#[path = "common/arguments.rs"]
mod arguments;
#[path = "common/folder.rs"]
mod folder;

mechanical_system! {
    /// A hoop of radius `a` and mass one that rolls without slipping on a horizontal plane.
    pub system Hoop {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        constraints {
            eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
        outputs { contact = vec(xi + a*cos(theta)*sin(psi), eta - a*cos(theta)*cos(psi)); }
    }
}

/// The number of hoops, unless another one is asked for.
const HOOPS: usize = 4096;
/// The time of the run in seconds, and the number of times looked at.
const UNTIL: f64 = 20.0;
const LOOKS: usize = 401;
/// The largest relative error of the energy that a hoop may have at the end.
const ENERGY_ERROR: f64 = 1e-7;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "Thousands of hoops that are made almost alike: how a small uncertainty spreads.";
    let hoops = |word: &str| word.parse().ok().filter(|count| *count > 0);
    let count = match arguments::read(about, "HOOPS", "how many; 4096 by default", HOOPS, hoops) {
        Ok(count) => count,
        Err(status) => return Ok(status),
    };

    // 1. The hoops: their inertia, their tilt and their turn are known to one in a hundred. The first is in the middle.
    let hoops = (0..count).map(|i| {
        let [inertia, tilt, turn] = even(i).map(|part| 1.0 + 0.02 * (part - 0.5));
        let hoop = Hoop { a: 1.0, A: 0.5 * inertia, C: inertia, g: 9.81 }.prepare()?;
        let start = hoop::State {
            theta: tilt,
            zeta: f64::sin(tilt),
            eta2: 3.0 * turn,
            eta3: 0.9,
            ..Default::default()
        };
        Ok((hoop, start))
    });
    let hoops: Vec<(hoop::Prepared, hoop::State)> = hoops.collect::<Result<_, guen::ConstantsError>>()?;

    // 2. Their motions, all at once.
    let times: Vec<f64> = (0..LOOKS).map(|k| UNTIL * k as f64 / (LOOKS - 1) as f64).collect();
    let begin = Instant::now();
    let method = Rk4::new(2e-3);
    let mut progress = Progress::new(0.0, count as f64);
    let mut motions = Vec::with_capacity(count);
    for part in hoops.chunks(HOOPS) {
        motions.extend(Ensemble::of_systems(part.iter().copied()).sample(&method, 0.0, &times));
        progress.at(motions.len() as f64);
    }
    progress.finish();
    let seconds = begin.elapsed().as_secs_f64();

    // 3. Each ended by itself: one that leaves the domain keeps its states until then, and does not touch the others.
    let steps: u64 = motions.iter().map(|motion| statistics(motion).accepted).sum();
    let failed = motions.iter().filter(|motion| motion.end.is_err()).count();
    println!(
        "{count} hoops for {UNTIL} s: {steps} steps in {seconds:.2} s, {:.1} ns each, in lanes of {:?}; {failed} failed",
        seconds * 1e9 / steps as f64,
        Backend::best(),
    );
    let lost = motions.iter().zip(&hoops).filter_map(|(motion, (hoop, start))| {
        let end = motion.end.as_ref().ok()?;
        Some((hoop.energy(UNTIL, &end.state.into()) / hoop.energy(0.0, start) - 1.0).abs())
    });
    let lost = lost.fold(0.0, f64::max);
    println!("largest relative error of the energy: {lost:.1e}\n");

    // 4. How far from the one in the middle are their points of contact?
    let mut table = Table::new(&["t", "nearest tenth", "half", "farthest tenth", "farthest"]).digits(3);
    let mut curves = [const { Vec::new() }; 4];
    for (k, &t) in times.iter().enumerate() {
        let contact = |i: usize| {
            let state = motions[i].states.get(k)?;
            Some(hoops[i].0.outputs(t, &hoop::State::from(*state)).contact)
        };
        let Some([x, y, _]) = contact(0) else { break };
        let mut apart: Vec<f64> =
            (0..count).filter_map(contact).map(|[u, v, _]| (u - x).hypot(v - y)).collect();
        apart.sort_by(f64::total_cmp);
        let part = |part: f64| apart[(part * (apart.len() - 1) as f64) as usize];
        let row = [part(0.1), part(0.5), part(0.9), part(1.0)];
        for (curve, distance) in curves.iter_mut().zip(row) {
            curve.push((t, distance));
        }
        if k % 40 == 0 {
            table.row(&[t, row[0], row[1], row[2], row[3]]);
        }
    }
    println!("{table}\n");

    // 5. The same as a picture, and a few of the tracks.
    let pictures = folder::folder("ensemble");
    let [tenth, half, most, all] = curves;
    Plot::new(format!("How far {count} hoops are from the one in the middle"))
        .axes("t in s", "distance in m")
        .line("nearest tenth", tenth)
        .line("half", half)
        .line("nine tenths", most)
        .line("all", all)
        .save(pictures.join("spread.svg"))?;
    let mut tracks =
        Plot::new("Tracks of some of them").size(640, 640).axes("x in m", "y in m").equal_scale(true);
    for (motion, (hoop, _)) in motions.iter().zip(&hoops).take(7) {
        let points = motion.states.iter().zip(&times).map(|(state, t)| {
            let [x, y, _] = hoop.outputs(*t, &hoop::State::from(*state)).contact;
            (x, y)
        });
        tracks = tracks.line("", points);
    }
    tracks.mark_ends(true).save(pictures.join("tracks.svg"))?;
    println!("pictures: spread.svg and tracks.svg in {}", pictures.display());

    if failed == 0 && lost <= ENERGY_ERROR {
        Ok(ExitCode::SUCCESS)
    } else {
        eprintln!("a hoop failed or lost energy");
        Ok(ExitCode::FAILURE)
    }
}

/// Points that fill the unit cube evenly, without chance, from its centre on: multiples of the roots of
/// `x^4 = x + 1` to the powers -1, -2, -3, after M. Roberts.
fn even(i: usize) -> [f64; 3] {
    const ROOT: f64 = 1.220_744_084_605_759_5;
    [1, 2, 3].map(|power| (0.5 + i as f64 * ROOT.powi(-power)).fract())
}

/// The work that a motion took, whether it arrived or not.
fn statistics(motion: &Sampled<9>) -> Statistics {
    match &motion.end {
        Ok(done) => done.statistics,
        Err(error) => error.statistics,
    }
}
