//! What compensated sums and Taylor series keep of the energy of simple systems, over a number of steps.
//!
//! ```text
//! cargo run --release -p guen-measure --bin sums            # 10^6 steps of 16 motions of each system
//! cargo run --release -p guen-measure --bin sums -- --quick # 10^4 steps
//! ```
//!
//! Prints the error of the energy, relative, as the root of the mean square over the motions, and beside it the part of it that all
//! motions share: near one where errors have a sign and grow like the number of steps, near zero where they are a random walk. The
//! energy is evaluated with 71 digits from the states in `f64`.

use guen::mechanical_system;
use guen::prelude::*;
use guen::steppers::Method;
use guen_study::Digits71;

mechanical_system! {
    /// A mass on a spring.
    system Spring {
        constants { k = 1 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
        potential_energy = k*x^2/2;
        provide taylor;
    }
}

mechanical_system! {
    /// A spring that becomes harder.
    system Hard {
        constants { k = 1 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
        potential_energy = x^2/2 + k*x^4/4;
        provide taylor;
    }
}

mechanical_system! {
    /// The potential of Henon and Heiles.
    system Galaxy {
        constants { k = 1 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = (u^2 + v^2)/2;
        potential_energy = (x^2 + y^2)/2 + k*(x^2*y - y^3/3);
        provide taylor;
    }
}

mechanical_system! {
    /// A planet.
    system Planet {
        constants { k = 1 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = (u^2 + v^2)/2;
        potential_energy = -k/sqrt(x^2 + y^2);
        provide taylor;
    }
}

/// The motions of each system.
const MOTIONS: u32 = 16;

/// Runs all motions of a system with one method and prints its line of the table.
fn line<S, M, const N: usize>(
    name: &str,
    system: &S,
    (method, settings): (String, &M),
    start: impl Fn(f64) -> [f64; N],
    energy: impl Fn(&[f64; N]) -> Digits71,
    marks: &[u64],
) where
    S: System<f64, N>,
    M: Method<f64, S, N>,
{
    let mut errors = vec![Vec::new(); marks.len()];
    for motion in 0..MOTIONS {
        let start = start(f64::from(motion) / f64::from(MOTIONS));
        let before = energy(&start);
        let mut steps = 0;
        let run = Integration::new(system, 0.0, &start)
            .guard(Guard::FINITE)
            .observe(&mut |_, x| {
                steps += 1;
                for (errors, _) in errors.iter_mut().zip(marks).filter(|(_, mark)| **mark == steps) {
                    errors.push(((energy(x) - before) / before).to_f64());
                }
                if marks.last() <= Some(&steps) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
            .run(settings, 1e9);
        if let Err(error) = run {
            println!("{name}, {method}: {error}");
        }
    }
    let cells = errors.iter().map(|errors| {
        let count = errors.len() as f64;
        let size = (errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt();
        format!(" {size:.1e}, {:.2} |", (errors.iter().sum::<f64>() / count / size).abs())
    });
    println!("| {name} | {method} |{}", cells.collect::<String>());
}

/// Runs a system, whose fastest motion takes about a radian in a unit of time, with every method.
macro_rules! lines {
    ($name:literal, $System:ident, $module:ident, $size:literal, $start:expr, $marks:expr) => {{
        let system = $System { k: 1.0 }.prepare().unwrap();
        let exact = $System { k: Digits71::one() }.prepare().unwrap();
        let energy = |x: &[f64; $size]| {
            exact.energy(Digits71::zero(), &$module::State::from(x.map(Digits71::from_f64)))
        };
        for step in [0.02, 0.01] {
            let [plain, compensated] = ["RK8", "RK8 compensated"].map(|name| format!("{name}, {step}"));
            line($name, &system, (plain, &Rk8::new(step)), $start, energy, $marks);
            line($name, &system, (compensated, &Rk8::new(step).compensated()), $start, energy, $marks);
        }
        for tolerance in [1e-15, 1e-18] {
            let method = Taylor::new(tolerance, tolerance).with_max_steps(u64::MAX);
            line($name, &system, (format!("Taylor, {tolerance:e}"), &method), $start, energy, $marks);
        }
    }};
}

fn main() {
    let quick = std::env::args().any(|word| word == "--quick");
    let marks: &[u64] = if quick { &[1_000, 10_000] } else { &[1_000, 10_000, 100_000, 1_000_000] };
    println!("| system | method, step or tolerance | {marks:?} steps |");
    lines!("spring", Spring, spring, 2, |part: f64| [(6.0 * part).cos(), (6.0 * part).sin()], marks);
    lines!("x'' = -x - x^3", Hard, hard, 2, |part: f64| [0.5 + 1.1 * part, 0.3], marks);
    lines!("Henon and Heiles", Galaxy, galaxy, 4, |part: f64| [0.05 + 0.16 * part, 0.1, 0.2, 0.15], marks);
    let planet = |part: f64| {
        let e = 0.2 + 0.2 * part;
        [1.0 - e, 0.0, 0.0, ((1.0 + e) / (1.0 - e)).sqrt()]
    };
    lines!("planet", Planet, planet, 4, planet, marks);
}
