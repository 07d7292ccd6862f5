//! Lagrange's expressions at points modulo p, along all displacements at once: what equations of motion and rates are held against.
//!
//! With `L(t, x, x')` for `T° + U` with all `eta` written in the velocities, `E_i = d/dt dL/dx_i' - dL/dx_i` are numbers as soon as
//! `x'` and `x''` are, by one pass back through what `L` is made of; and `sum_i xi_s^i E_i` is the left side of (2.7) on
//! every motion that the constraints allow: d'Alembert's principle in Lagrange's form. Operators are solved for as numbers, too; neither
//! brackets nor momenta occur, so that the proof shares nothing with what it proves.

use crate::algebra::ExprId;
use crate::motion::Mechanics;
use crate::workbench::Workbench;
use crate::zero::Sample;
use crate::zero::field::{add, eliminate, mul, sub};
use crate::zero::jets::{Jet, Moving, Tape};

/// The Lagrangian and the forms, as a tape that is differentiated at points.
pub(super) struct Lagrange {
    tape: Tape,
    /// Nodes of the tape that belong to the forms; those of `L` follow.
    of_forms: usize,
    nodes: usize,
}

impl Lagrange {
    pub(super) fn new(bench: &mut Workbench, system: &Mechanics) -> Self {
        let mut tape = Tape::default();
        let forms = system.forms.forms.iter();
        let entries: Vec<ExprId> =
            forms.flat_map(|form| form.row.iter().chain([&form.offset])).copied().collect();
        let of_forms = tape.extend(&mut bench.graph, &entries);
        let nodes = tape.extend(&mut bench.graph, &[system.kinetic_energy, system.force_function]);
        Lagrange { tape, of_forms, nodes }
    }

    /// A point where the constraints hold for the velocities; `None` where the forms have no values or are dependent.
    pub(super) fn point<'a>(
        &'a self,
        bench: &'a Workbench,
        system: &'a Mechanics,
        sample: Sample,
    ) -> Option<Point<'a>> {
        let mut moving = Moving::new(&bench.graph, &bench.zero, &self.tape, sample);
        let (n, l) = (system.forms.len(), system.forms.degrees);
        for eta in &system.etas[l..] {
            moving.place(*eta, 0);
        }
        let etas = moving.values(&system.etas)?;
        let mut rows: Vec<Vec<u64>> = Vec::with_capacity(n);
        let mut parts = Vec::with_capacity(n);
        for (s, (form, eta)) in system.forms.forms.iter().zip(&etas).enumerate() {
            let mut row = moving.values(&form.row)?;
            row.extend((0..n).map(|k| u64::from(k == s)));
            rows.push(row);
            parts.push(sub(*eta, moving.value(form.offset)?));
        }
        if eliminate(&mut rows).iter().enumerate().any(|(row, pivot)| row != *pivot) {
            return None;
        }
        let inverse: Vec<Vec<u64>> = rows.into_iter().map(|row| row[n..].to_vec()).collect();
        let velocities: Vec<u64> = inverse.iter().map(|row| dot(row, &parts)).collect();
        for (symbol, velocity) in system.velocities.iter().zip(&velocities) {
            moving.place(*symbol, *velocity);
        }
        moving.set_rate(system.forms.time, 1);
        for (x, velocity) in system.forms.coordinates.iter().zip(&velocities) {
            moving.set_rate(*x, *velocity);
        }
        moving.pass(0..self.of_forms)?;
        Some(Point { lagrange: self, system, moving, inverse, velocities })
    }
}

/// A point of the states.
pub(super) struct Point<'a> {
    lagrange: &'a Lagrange,
    system: &'a Mechanics,
    moving: Moving<'a>,
    /// `xi_j^i`, a row for each coordinate.
    inverse: Vec<Vec<u64>>,
    /// `x_1'..x_n'`.
    pub(super) velocities: Vec<u64>,
}

impl Point<'_> {
    /// The values of expressions of `t`, `x` and `eta_1..eta_l`.
    pub(super) fn values(&mut self, es: &[ExprId]) -> Option<Vec<u64>> {
        self.moving.values(es)
    }

    /// The left sides of (2.7) for these `eta_1'..eta_l'`, those of the reactions included.
    pub(super) fn left_sides(&mut self, accelerations: &[u64]) -> Option<Vec<u64>> {
        let Point { lagrange, system, moving, inverse, velocities } = self;
        let forms = &system.forms;
        // A x'' = eta' - a_0' - A' x'
        let parts: Vec<u64> = forms
            .forms
            .iter()
            .enumerate()
            .map(|(s, form)| {
                let turning = form.row.iter().zip(velocities.iter()).filter_map(|(a, v)| {
                    let rate = moving.rate(*a);
                    (rate != 0).then(|| mul(rate, *v))
                });
                let turning = turning.fold(moving.rate(form.offset), add);
                sub(accelerations.get(s).copied().unwrap_or(0), turning)
            })
            .collect();
        let second: Vec<u64> = inverse.iter().map(|row| dot(row, &parts)).collect();
        for (velocity, rate) in system.velocities.iter().zip(&second) {
            moving.set_rate(*velocity, *rate);
        }
        for (eta, rate) in system.etas.iter().zip(accelerations) {
            moving.set_rate(*eta, *rate);
        }
        moving.pass(lagrange.of_forms..lagrange.nodes)?;
        let mut slopes = moving.no_slopes();
        for part in [system.kinetic_energy, system.force_function] {
            slopes.add(part, Jet::ONE);
        }
        moving.go_back(lagrange.of_forms..lagrange.nodes, &mut slopes)?;
        // What depends on eta depends on velocities and on the forms: d eta_j = a_ji dx_i' + x_i' da_ji + da_j0.
        let mut momenta: Vec<Jet> = system.velocities.iter().map(|velocity| slopes.of(*velocity)).collect();
        for (form, eta) in forms.forms.iter().zip(&system.etas) {
            let by_eta = slopes.of(*eta);
            if by_eta == Jet::default() {
                continue;
            }
            slopes.add(form.offset, by_eta);
            for (i, a) in form.row.iter().enumerate() {
                let entry = moving.jet(*a)?;
                momenta[i] = momenta[i].plus(by_eta.times(entry));
                slopes.add(*a, by_eta.times(Jet { value: velocities[i], rate: second[i] }));
            }
        }
        moving.go_back(0..lagrange.of_forms, &mut slopes)?;
        let along = forms.coordinates.iter().zip(&momenta);
        let along: Vec<u64> = along.map(|(x, momentum)| sub(momentum.rate, slopes.of(*x).value)).collect();
        let left = (0..forms.len()).map(|s| {
            let products = inverse.iter().zip(&along).map(|(row, e)| mul(row[s], *e));
            products.fold(0, add)
        });
        Some(left.collect())
    }
}

fn dot(a: &[u64], b: &[u64]) -> u64 {
    a.iter().zip(b).filter(|(a, b)| **a != 0 && **b != 0).fold(0, |sum, (a, b)| add(sum, mul(*a, *b)))
}
