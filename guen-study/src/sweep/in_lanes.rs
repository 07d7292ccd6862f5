//! Motions with fixed steps, several at once in lanes.

use std::fmt::{Debug, Write as _};
use std::ops::Range;

use guen_runtime::lanes::{Backend, Width};
use guen_runtime::steppers::LaneMethod;
use guen_runtime::{Cause, IntegrationError, Laned, Simulate};

use super::block::{Block, Column, Fault};
use super::design::PointsAt;
use super::engine::{Engine, Member, Members, state_columns};
use super::error::SweepError;
use super::sha256::Sha256;
use super::statistics::widen;
use crate::ensemble::{Ensemble, Sampled};

/// Motions that are made ready at a time.
const BATCH: u64 = 256;

/// The rows that are kept of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Keep {
    /// The state at the end.
    End,
    /// The states at all times, each with its time.
    Samples,
    /// The smallest and the largest value of every entry at these times.
    Extrema,
}

/// Values that are computed of a state, with their columns.
pub(super) struct Outputs<S, const N: usize> {
    pub(super) columns: Vec<Column>,
    #[allow(clippy::type_complexity, reason = "a function of a system, a time and a state")]
    pub(super) values: fn(&S, f64, &[f64; N], &mut Vec<f64>),
}

/// An engine of motions in lanes.
pub(super) struct InLanes<'a, S, const N: usize, M> {
    members: Members<'a, S, N>,
    method: M,
    /// A method whose distance from the first estimates its error.
    finer: Option<M>,
    t0: f64,
    times: Vec<f64>,
    keep: Keep,
    outputs: Option<Outputs<S, N>>,
    columns: Vec<Column>,
}

impl<'a, S, const N: usize, M> InLanes<'a, S, N, M>
where
    S: Simulate<f64, N>,
{
    pub(super) fn new(
        members: Members<'a, S, N>,
        (method, finer): (M, Option<M>),
        (t0, times): (f64, Vec<f64>),
        keep: Keep,
        outputs: Option<Outputs<S, N>>,
    ) -> Self {
        let mut of_state = state_columns::<S, N>();
        of_state.extend(outputs.iter().flat_map(|outputs| outputs.columns.iter().cloned()));
        let named = |suffix: &str| {
            let column =
                |column: &Column| Column::new(format!("{}{suffix}", column.name), column.unit.clone());
            of_state.iter().map(column).collect::<Vec<Column>>()
        };
        let time_unit = if S::UNITS.is_empty() { "" } else { "s" };
        let mut columns = match keep {
            Keep::End => of_state.clone(),
            Keep::Samples => {
                std::iter::once(Column::new("t", time_unit)).chain(of_state.iter().cloned()).collect()
            }
            Keep::Extrema => named("_min").into_iter().chain(named("_max")).collect(),
        };
        if finer.is_some() {
            columns.extend(named("_error"));
        }
        Self { members, method, finer, t0, times, keep, outputs, columns }
    }

    /// A state with what is computed of it.
    fn values(&self, system: &S, t: f64, state: &[f64; N]) -> Vec<f64> {
        let mut values = state.to_vec();
        if let Some(outputs) = &self.outputs {
            (outputs.values)(system, t, state, &mut values);
        }
        values
    }

    fn rows(
        &self,
        member: &Member<S, N>,
        sampled: &Sampled<N>,
        finer: Option<&Sampled<N>>,
        block: &mut Block,
    ) {
        let Member { motion, point, system, .. } = member;
        let values = |(t, state): (&f64, &[f64; N])| self.values(system, *t, state);
        let end = finer.map_or(sampled, |finer| if sampled.end.is_err() { sampled } else { finer });
        let is_whole = end.end.is_ok();
        match self.keep {
            Keep::End if is_whole => {
                if let (Some(t), Ok(end)) = (self.times.last(), &sampled.end) {
                    let state = &end.state;
                    let other = finer.and_then(|finer| finer.end.as_ref().ok()).map(|end| &end.state);
                    if self.outputs.is_none() && other.is_none() {
                        block.push(*motion, point, 0, state.iter().copied());
                    } else {
                        let values = values((t, state));
                        let errors = other.map(|other| self.errors(system, *t, &values, other));
                        block.push(
                            *motion,
                            point,
                            0,
                            values.iter().copied().chain(errors.into_iter().flatten()),
                        );
                    }
                }
            }
            Keep::Samples => {
                for (place, (t, state)) in self.times.iter().zip(&sampled.states).enumerate() {
                    let row = std::iter::once(*t).chain(values((t, state)));
                    block.push(*motion, point, place as u32, row);
                }
            }
            Keep::Extrema if is_whole => {
                let mut all = self.times.iter().zip(&sampled.states).map(values);
                let first = all.next().unwrap_or_default();
                let mut ends: Vec<[f64; 2]> = first.into_iter().map(|x| [x, x]).collect();
                all.for_each(|values| ends.iter_mut().zip(values).for_each(|(ends, x)| widen(ends, x)));
                let [low, high] = [0, 1].map(|end| ends.iter().map(move |ends| ends[end]));
                block.push(*motion, point, 0, low.chain(high));
            }
            Keep::End | Keep::Extrema => {}
        }
        if let Err(error) = &end.end {
            block.push_fault(*motion, point, fault::<S, N>(error));
        }
    }

    /// The distances of values from those of another state.
    fn errors(&self, system: &S, t: f64, values: &[f64], other: &[f64; N]) -> Vec<f64> {
        let others = self.values(system, t, other);
        values.iter().zip(others).map(|(value, other)| (value - other).abs()).collect()
    }
}

/// An error in the names of the system.
fn fault<S: Simulate<f64, N>, const N: usize>(error: &IntegrationError<f64, N>) -> Fault {
    let named = |what: String, names: &[&str], place: usize| {
        let name = names.get(place).map(|name| format!("`{name}`"));
        (what.clone(), name.unwrap_or(what))
    };
    // Room for most of them: a text that grows is copied several times.
    let mut text = String::with_capacity(160);
    let _ = write!(text, "{}", error.cause);
    let cause = match error.cause {
        Cause::Step { entry, .. } => {
            let (index, name) = named(format!("entry {entry} of the state"), S::STATES, entry);
            text.replace(&index, &name)
        }
        Cause::ChartSingularity { function, .. } | Cause::ApproachingSingularity { function, .. } => {
            let (index, name) = named(format!("function {function} of the domain"), S::DOMAIN, function);
            text.replace(&index, &name)
        }
        _ => text,
    };
    Fault { time: Some(error.time), cause }
}

impl<S, const N: usize, M> Engine for InLanes<'_, S, N, M>
where
    S: Laned<N> + Simulate<f64, N> + Send + Sync,
    M: LaneMethod + Debug + Send + Sync,
{
    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn fewest(&self) -> u64 {
        512
    }

    fn declaration(&self) -> u64 {
        S::DECLARATION
    }

    fn groups(&self) -> usize {
        if self.keep == Keep::Samples { self.times.len() } else { 1 }
    }

    fn text(&self) -> String {
        let Self { method, finer, t0, times, keep, .. } = self;
        let finer = finer.as_ref().map_or(String::new(), |finer| format!(", error by {finer:?}"));
        format!("{keep:?} by {method:?}{finer} from t = {t0:?} through {times:?}")
    }

    fn fill(&self, design: &PointsAt<'_>, motions: Range<u64>, lanes: (Backend, Width), block: &mut Block) {
        let Range { start, end } = motions;
        for first in (start..end).step_by(BATCH as usize) {
            // Motions that cannot begin have their rows in order: so rows are made after all have run.
            let batch: Vec<Result<Member<S, N>, _>> = (first..end.min(first + BATCH))
                .map(|motion| self.members.member(design, motion).map_err(|fault| (motion, fault)))
                .collect();
            let members = batch.iter().flatten().map(|member| (&member.system, member.start));
            let ensemble =
                Ensemble::of_systems(members).with_threads(1).with_lanes(lanes.0, lanes.1).silent();
            let run = |method: &M| match (self.keep, self.times.last()) {
                (Keep::End, Some(end)) => {
                    let ends = ensemble.integrate(method, self.t0, *end).into_iter();
                    ends.map(|end| Sampled { states: Vec::new(), end }).collect()
                }
                _ => ensemble.sample(method, self.t0, &self.times),
            };
            let sampled = run(&self.method);
            let finer = self.finer.as_ref().map(run);
            let mut place = 0;
            for member in batch {
                match member {
                    Ok(member) => {
                        let finer = finer.as_ref().map(|all| &all[place]);
                        self.rows(&member, &sampled[place], finer, block);
                        place += 1;
                    }
                    Err((motion, (point, error))) => {
                        block.push_fault(motion, &point, Fault { time: None, cause: error.to_string() });
                    }
                }
            }
        }
    }

    fn probe(&self, design: &PointsAt<'_>, motions: &[u64], digest: &mut Sha256) -> Result<(), SweepError> {
        let end = self.times.last().copied().unwrap_or(self.t0);
        self.members.probe(design, motions, [self.t0, (self.t0 + end) / 2.0, end], digest)
    }
}
