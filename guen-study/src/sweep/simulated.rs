//! Motions that are simulated one by one: with events, step control, and whatever a closure keeps of them.

use std::ops::Range;

use guen_runtime::lanes::{Backend, Width};
use guen_runtime::{Simulate, Simulation};

use super::block::{Block, Column, Fault};
use super::design::PointsAt;
use super::engine::{Engine, Members};
use super::error::SweepError;
use super::sha256::Sha256;

/// The rows that are kept of a simulation, or why there are none.
type Run<'a, S, const N: usize, const K: usize> =
    Box<dyn Fn(Simulation<'_, S, N>) -> Result<Vec<[f64; K]>, String> + Send + Sync + 'a>;

/// An engine of simulations.
pub(super) struct Simulated<'a, S: Simulate<f64, N>, const N: usize, const K: usize> {
    pub(super) members: Members<'a, S, N>,
    pub(super) columns: Vec<Column>,
    pub(super) run: Run<'a, S, N, K>,
}

impl<S, const N: usize, const K: usize> Engine for Simulated<'_, S, N, K>
where
    S: Simulate<f64, N> + Clone + Send + Sync,
{
    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn fewest(&self) -> u64 {
        16
    }

    fn declaration(&self) -> u64 {
        S::DECLARATION
    }

    fn groups(&self) -> usize {
        1
    }

    fn text(&self) -> String {
        "simulations, and what a closure keeps of them".to_owned()
    }

    fn fill(&self, design: &PointsAt<'_>, motions: Range<u64>, _lanes: (Backend, Width), block: &mut Block) {
        for motion in motions {
            let Some(member) = self.members.member_or_row(design, motion, block) else { continue };
            match (self.run)(member.system.simulation(&member.start.into())) {
                Ok(rows) => {
                    for (place, row) in rows.into_iter().enumerate() {
                        block.push(motion, &member.point, place as u32, row.into_iter());
                    }
                }
                Err(cause) => block.push_fault(motion, &member.point, Fault { time: None, cause }),
            }
        }
    }

    fn probe(&self, design: &PointsAt<'_>, motions: &[u64], digest: &mut Sha256) -> Result<(), SweepError> {
        self.members.probe(design, motions, [0.0, 1.0, 2.0], digest)
    }
}
