//! The transitions of a run in words, and numbers beside those that were found independently of it.

use std::fmt::Display;
use std::process::ExitCode;

use guen::hybrid::{HybridSystem, HybridTrajectory};
use guen::steppers::Interpolant;

/// Prints the time, the kind, the elements and the mode of every transition.
pub fn tell<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize>(
    motion: &HybridTrajectory<H, X, N, W, C, S, P>,
) where
    H: HybridSystem<N, W, C, S> + Clone,
    H::Mode: Display,
    X: Copy + From<[f64; N]> + Into<[f64; N]>,
    P: Interpolant<f64, N>,
{
    for at in motion.transitions() {
        let elements = H::ELEMENTS.iter().zip(at.elements).filter(|(_, takes_part)| *takes_part);
        let signal = at.signal.and_then(|signal| H::SIGNALS.get(signal)).map(|signal| signal.name);
        let names: Vec<&str> = elements.map(|(element, _)| element.name).chain(signal).collect();
        println!("  t = {:.9}: {}: {}; then {}", at.t, names.join(" and "), at.kind, at.after);
    }
}

/// Numbers that were found twice, and whether all of them agree.
#[derive(Default)]
pub struct Checks {
    failed: bool,
}

impl Checks {
    /// Prints a number beside what it has to be; a difference of more than the tolerance ends the program with status 1.
    pub fn near(&mut self, what: &str, found: f64, expected: f64, tolerance: f64) {
        let off = (found - expected).abs();
        // What is no number is wrong, too.
        let holds = off <= tolerance;
        println!("  {what}: {found:.9}, off by {off:.1e}{}", if holds { "" } else { ", WRONG" });
        self.failed |= !holds;
    }

    /// Prints a statement, and whether it holds.
    #[allow(dead_code, reason = "some examples compare numbers only")]
    pub fn holds(&mut self, what: &str, holds: bool) {
        println!("  {what}: {}", if holds { "yes" } else { "NO" });
        self.failed |= !holds;
    }

    /// The status to end with.
    pub fn status(&self) -> ExitCode {
        if self.failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
    }
}
