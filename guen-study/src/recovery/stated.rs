//! Tests how often the error that [`recover`] states is too small: random rates on grids that are fine, coarse, and
//! far too coarse.

use guen_runtime::{Cost, LevelInfo, from_fn};

use super::*;

/// Keeps the time out of `t, y, z` with `y' = f(t)` and `z' = y g(t)`.
struct Clock;

impl Level<f64, 1, 3> for Clock {
    const PLACES: [usize; 1] = [0];
    const QUADRATURES: &'static [&'static [usize]] = &[&[1], &[2]];
    const INFO: LevelInfo =
        LevelInfo { name: "Clock", variables: &["t"], cost: Cost::ZERO, prepare_cost: Cost::ZERO };
}

/// Numbers between zero and one, the same in every run.
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn sign(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }
}

/// A rate: its kind, the fastest phase over an interval, and what else it is made of.
#[derive(Clone, Copy)]
struct Rate {
    kind: usize,
    fastest: f64,
    slower: f64,
    sizes: [f64; 3],
    phases: [f64; 2],
}

impl Rate {
    fn new(draws: &mut Draws) -> Self {
        let fastest = 0.5 * 120.0_f64.powf(draws.next());
        Self {
            kind: (5.0 * draws.next()) as usize,
            fastest,
            slower: fastest * (0.1 + 0.9 * draws.next()),
            sizes: std::array::from_fn(|_| draws.sign()),
            phases: std::array::from_fn(|_| 6.3 * draws.next()),
        }
    }

    fn at(&self, t: f64) -> f64 {
        let Self { fastest, slower, sizes: [a, b, c], phases: [p, q], .. } = *self;
        match self.kind {
            0 => a * (fastest * t + p).cos() + b,
            1 => a * (fastest * t + p).cos() + b * (slower * t + q).cos() + c,
            2 => (a * (fastest / 1.5 * t + p).sin()).exp() + b,
            3 => 1.0 / (1.3 + a * (fastest / 2.0 * t + p).cos()),
            _ => (3.0 * (fastest / 3.0 * t + p).sin() + b).cos(),
        }
    }
}

/// Returns the largest error of a run as a multiple of the stated one; none where the run was refused.
fn worst(draws: &mut Draws) -> (f64, Option<f64>) {
    let (f, g) = (Rate::new(draws), Rate::new(draws));
    let g = Rate { fastest: f.fastest * draws.next(), slower: f.slower * draws.next(), ..g };
    let intervals = [2_u32, 5, 10, 20][(4.0 * draws.next()) as usize];
    let full = from_fn(move |_t: f64, &[t, y, _z]: &[f64; 3]| [1.0, f.at(t), y * g.at(t)]);
    let sampled = |grid: &[f64]| {
        let nodes = Nodes::new(grid).unwrap();
        let run: Vec<[f64; 1]> = nodes.times().iter().map(|t| [*t]).collect();
        recover(&Clock, &full, &nodes, &run, &run, &[0.0; 3])
    };
    let grid: Vec<f64> = (0..=intervals).map(f64::from).collect();
    let Ok(found) = sampled(&grid) else { return (f.fastest, None) };
    // The same on a grid on which every phase moves by half of one at most.
    let parts = (2.0 * f.fastest).ceil() as u32 + 1;
    let fine: Vec<f64> = (0..=intervals * parts).map(|k| f64::from(k) / f64::from(parts)).collect();
    let exact = sampled(&fine).unwrap();
    let mut worst = 0.0_f64;
    for (k, (state, stated)) in found.states.iter().zip(&found.errors).enumerate() {
        let at = k * parts as usize;
        for place in [1, 2] {
            let off = (state[place] - exact.states[at][place]).abs();
            // The reference has an error of its own.
            let known = exact.errors[at][place].min(1e-12);
            worst = worst.max((off - known).max(0.0) / stated[place].max(1e-300));
        }
    }
    (f.fastest, Some(worst))
}

/// The phase below which no run is to be refused, but for a few.
const REFUSED_PHASE: f64 = 6.0;

/// Runs so many draws, and returns: those accepted, those of them that are off by more than is stated, their worst
/// multiple and slowest phase, and those refused although their phase is below [`REFUSED_PHASE`].
fn ask(runs: usize) -> (usize, usize, f64, f64, usize) {
    let mut draws = Draws(11);
    let (mut accepted, mut failed, mut most, mut slowest) = (0, 0, 0.0_f64, f64::INFINITY);
    let (mut needless, mut slow) = (0, 0);
    for _ in 0..runs {
        let (fastest, worst) = worst(&mut draws);
        slow += usize::from(fastest < REFUSED_PHASE);
        let Some(worst) = worst else {
            needless += usize::from(fastest < REFUSED_PHASE);
            continue;
        };
        accepted += 1;
        if worst > 1.0 {
            (failed, most, slowest) = (failed + 1, most.max(worst), slowest.min(fastest));
        }
    }
    println!(
        "{runs} runs: {accepted} accepted, {failed} off by more than stated, {most:.1} times at most, from {slowest:.1} on; refused below 6: {needless} of {slow}"
    );
    (accepted, failed, most, slowest, needless)
}

#[test]
fn stated_errors_hold() {
    let (accepted, failed, _, slowest, needless) = ask(400);
    assert!(
        accepted > 200 && failed == 0 && needless <= 4,
        "{failed} of {accepted}, from {slowest} on; {needless}"
    );
}

#[test]
#[ignore = "forty seconds"]
fn stated_errors_hold_in_twenty_thousand_runs() {
    let (accepted, failed, _, slowest, _) = ask(20_000);
    assert!(failed * 2_000 < accepted && slowest > 20.0, "{failed} of {accepted}, from {slowest} on");
}
