//! The engines of a sweep: they compute the rows of some motions.

use std::error::Error;
use std::ops::Range;

use guen_runtime::Simulate;
use guen_runtime::lanes::{Backend, Width};

use super::block::{Block, Column, Fault};
use super::design::{Design, Point, PointsAt, UnknownAxis, UnknownEntry};
use super::error::SweepError;
use super::sha256::Sha256;

/// Any error of the closure that makes a motion of a point.
pub(super) type AnyError = Box<dyn Error + Send + Sync>;

/// Computes rows.
pub(super) trait Engine: Send + Sync {
    /// The columns of a row, without those of the design.
    fn columns(&self) -> &[Column];

    /// The digest of the declaration; zero where there is none.
    fn declaration(&self) -> u64;

    /// The rows of a motion that have statistics of their own, one by one.
    fn groups(&self) -> usize;

    /// The fewest motions that are worth a chunk: of quick ones, the file takes longer than they do.
    fn fewest(&self) -> u64;

    /// The method, the span and what is kept, in words.
    fn text(&self) -> String;

    /// Appends the rows of these motions to a block.
    fn fill(&self, design: &PointsAt<'_>, motions: Range<u64>, lanes: (Backend, Width), block: &mut Block);

    /// Takes systems and starts of these motions into a digest.
    fn probe(&self, design: &PointsAt<'_>, motions: &[u64], digest: &mut Sha256) -> Result<(), SweepError>;
}

/// The closure that makes a system and its start of a point.
pub(super) type Build<'a, S, const N: usize> =
    Box<dyn Fn(&Point<'_>) -> Result<(S, [f64; N]), AnyError> + Send + Sync + 'a>;

/// A motion that can begin: its number, the point, the system and the start.
pub(super) struct Member<S, const N: usize> {
    pub(super) motion: u64,
    pub(super) point: Vec<f64>,
    pub(super) system: S,
    pub(super) start: [f64; N],
}

/// The motions of a design.
pub(super) struct Members<'a, S, const N: usize> {
    pub(super) names: Vec<String>,
    pub(super) build: Build<'a, S, N>,
}

impl<S, const N: usize> Members<'_, S, N> {
    /// The motion of a point; or the reason for which there is none, with the point.
    pub(super) fn member(
        &self,
        design: &PointsAt<'_>,
        motion: u64,
    ) -> Result<Member<S, N>, (Vec<f64>, AnyError)> {
        let mut point = Vec::with_capacity(self.names.len());
        design.at(motion, &mut point);
        match (self.build)(&Point { index: motion, names: &self.names, values: &point }) {
            Ok((system, start)) => Ok(Member { motion, point, system, start }),
            Err(error) => Err((point, error)),
        }
    }

    /// The motion of a point; a motion that cannot begin becomes a row.
    pub(super) fn member_or_row(
        &self,
        design: &PointsAt<'_>,
        motion: u64,
        block: &mut Block,
    ) -> Option<Member<S, N>> {
        match self.member(design, motion) {
            Ok(member) => Some(member),
            Err((point, error)) => {
                block.push_fault(motion, &point, Fault { time: None, cause: error.to_string() });
                None
            }
        }
    }

    /// Takes points, starts and rates into a digest: of another declaration or other constants they have other bits.
    pub(super) fn probe(
        &self,
        design: &PointsAt<'_>,
        motions: &[u64],
        times: [f64; 3],
        digest: &mut Sha256,
    ) -> Result<(), SweepError>
    where
        S: Simulate<f64, N>,
    {
        let mut take = |values: &[f64]| {
            values.iter().for_each(|value| digest.update(&value.to_bits().to_le_bytes()));
        };
        for motion in motions {
            match self.member(design, *motion) {
                Ok(Member { point, system, start, .. }) => {
                    take(&point);
                    take(&start);
                    for t in times {
                        take(&system.rhs(t, &start));
                        // Away from a start at rest, where terms vanish.
                        let away = std::array::from_fn(|i| start[i] + 0.1 + 0.01 * i as f64);
                        take(&system.rhs(t, &away));
                    }
                }
                Err((point, error)) => {
                    if let Some(unknown) = error.downcast_ref::<UnknownAxis>() {
                        return Err(SweepError::UnknownAxis(unknown.clone()));
                    }
                    if let Some(unknown) = error.downcast_ref::<UnknownEntry>() {
                        return Err(SweepError::UnknownEntry(unknown.clone()));
                    }
                    take(&point);
                }
            }
        }
        Ok(())
    }
}

/// The columns of a system's state.
pub(super) fn state_columns<S: Simulate<f64, N>, const N: usize>() -> Vec<Column> {
    let name = |k: usize| S::STATES.get(k).map_or_else(|| k.to_string(), |name| (*name).to_owned());
    (0..N).map(|k| Column::new(name(k), S::UNITS.get(k).copied().unwrap_or_default())).collect()
}

/// The motions that a design is told apart from others by: a few that are spread over it.
pub(super) fn probes(design: &Design) -> Vec<u64> {
    const PROBES: u64 = 16;
    let count = design.len();
    (0..PROBES.min(count))
        .map(|k| (u128::from(k) * u128::from(count) / u128::from(PROBES.min(count))) as u64)
        .collect()
}
