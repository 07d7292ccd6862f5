//! The motion in a mode with its reactions.

use super::system::FreeMotion;
use crate::numbers::real::Real;

/// The motion in a mode at one time and state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reactions<R, const N: usize, const W: usize, const C: usize> {
    /// The motion without reactions, and what reactions do to it.
    pub free: FreeMotion<R, N, W, C>,
    /// The reaction along every row, friction included; zero where a contact is open.
    pub reactions: [R; W],
    /// The direction of every slip by its rows: the components of a unit vector, zero where nothing slips.
    pub directions: [R; W],
    /// The magnitudes of the reactions of permanent constraints that load grips; zero for other elements.
    pub loads: [R; C],
    /// The determinant of the mode's matrix `G`, relative to that of the same rows without friction and without coupling: it vanishes
    /// where the reactions of slipping contacts become infinite.
    pub regularity: R,
}

impl<R: Real, const N: usize, const W: usize, const C: usize> Reactions<R, N, W, C> {
    /// The rates of the state.
    pub fn rates(&self) -> [R; N] {
        let mut rates = self.free.rates;
        for (reaction, response) in self.reactions.iter().zip(&self.free.responses) {
            for (rate, entry) in rates.iter_mut().zip(response) {
                *rate = reaction.times_plus(*entry, *rate);
            }
        }
        rates
    }

    /// The rates of the rows, `biases + D l`.
    pub fn row_accelerations(&self) -> [R; W] {
        let mut sums = self.free.biases;
        for (sum, entries) in sums.iter_mut().zip(&self.free.delassus) {
            for (reaction, entry) in self.reactions.iter().zip(entries) {
                *sum = reaction.times_plus(*entry, *sum);
            }
        }
        sums
    }
}
