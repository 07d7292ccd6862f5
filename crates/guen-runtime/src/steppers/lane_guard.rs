//! The guard of runs in lanes: energy, residuals and edges of every lane, with the limits that a run alone has.

use super::edges::EDGES;
use super::guard::{Guard, exceeds, relative};
use crate::error::Cause;
use crate::lanes::{Lanes, Mask};
use crate::rounded::Rounded;
use crate::system::System;

/// The most lanes that there are.
pub(super) const MOST: usize = 8;

/// What looks have learned of every lane.
pub(super) struct LaneGuard<L, const N: usize> {
    guard: Guard,
    energy: Option<L>,
    scale: [f64; MOST],
    edges: usize,
    negative: [Mask; EDGES],
    /// The largest absolute value of each entry of the state.
    largest: [L; N],
}

/// The causes of the lanes that fail, and which these are.
pub(super) struct Faults {
    pub lanes: Mask,
    pub causes: [Option<Cause>; MOST],
}

impl<L: Lanes, const N: usize> LaneGuard<L, N> {
    /// Looks at the start.
    pub fn new<S: System<L, N> + ?Sized>(system: &S, time: f64, state: &[L; N]) -> (Self, Faults) {
        let vitals = system.vitals(L::from_f64(time), state);
        let mut guard = Self {
            guard: Guard::default(),
            energy: vitals.energy,
            scale: core::array::from_fn(|lane| if lane < L::COUNT { vitals.scale.lane(lane) } else { 0.0 }),
            edges: 0,
            negative: [Mask::all(0); EDGES],
            largest: state.map(crate::Real::abs),
        };
        let (edges, values) = guard.values(system, time, state);
        guard.edges = edges;
        guard.negative = values.map(|value| {
            let bits = (0..L::COUNT).map(|lane| u32::from(value.value.lane(lane) < 0.0) << lane);
            Mask::from_bits(bits.sum())
        });
        let faults = guard.look(system, time, state, Mask::all(L::COUNT));
        (guard, faults)
    }

    /// Looks at the lanes that are going.
    #[inline(never)]
    pub fn look<S>(&mut self, system: &S, time: f64, state: &[L; N], going: Mask) -> Faults
    where
        S: System<L, N> + ?Sized,
    {
        for (largest, entry) in self.largest.iter_mut().zip(state) {
            let (before, now) = (*largest, entry.abs());
            *largest = L::from_fn(|lane| {
                if now.lane(lane) > before.lane(lane) { now.lane(lane) } else { before.lane(lane) }
            });
        }
        let vitals = system.vitals(L::from_f64(time), state);
        let (_, values) = self.values(system, time, state);
        let mut faults = Faults { lanes: Mask::all(0), causes: [None; MOST] };
        let mut bits = 0;
        for lane in going.lanes() {
            let cause = self.energy_of(lane, time, vitals.energy, vitals.scale).or_else(|| {
                let residual = vitals.residual.lane(lane);
                let limit = self.guard.residual;
                exceeds(residual, limit).then_some(Cause::Residual { found: time, residual, limit })
            });
            faults.causes[lane] = cause.or_else(|| self.edge_of(lane, time, &values));
            bits |= u32::from(faults.causes[lane].is_some()) << lane;
        }
        faults.lanes = Mask::from_bits(bits);
        faults
    }

    fn energy_of(&mut self, lane: usize, found: f64, energy: Option<L>, scale: L) -> Option<Cause> {
        let (energy, before) = (energy?.lane(lane), self.energy?.lane(lane));
        let limit = self.guard.energy;
        self.scale[lane] = self.scale[lane].max(scale.lane(lane));
        let change = relative((energy - before).abs(), self.scale[lane]);
        exceeds(change, limit).then_some(Cause::Energy { found, change, limit })
    }

    fn edge_of(&self, lane: usize, found: f64, values: &[Rounded<L>; EDGES]) -> Option<Cause> {
        let limit = self.guard.edge;
        values.iter().take(self.edges).enumerate().find_map(|(function, value)| {
            let left = value.left().lane(lane);
            let same = (value.value.lane(lane) < 0.0) == self.negative[function].contains(lane);
            let distance = if same { left } else { -left };
            (distance <= limit || distance.is_nan()).then_some(Cause::Edge {
                found,
                function,
                distance,
                limit,
            })
        })
    }

    fn values<S>(&self, system: &S, time: f64, state: &[L; N]) -> (usize, [Rounded<L>; EDGES])
    where
        S: System<L, N> + ?Sized,
    {
        let mut values = [Rounded::exact(L::from_f64(0.0)); EDGES];
        let state = core::array::from_fn(|i| Rounded { value: state[i], error: self.largest[i] });
        let edges = system.edges(Rounded::once(L::from_f64(time)), &state, &mut values);
        (edges.min(EDGES), values)
    }
}
