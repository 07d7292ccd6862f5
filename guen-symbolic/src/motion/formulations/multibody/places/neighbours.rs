//! Neighbours: axes that turn in any way hang on those against which their spin has the fewest components.
//!
//! Bodies whose orientations are all given in the world, by quaternions say, are held together by constraints alone. On these, at a point
//! modulo the prime, the spin of a body against the one that it is hinged to has one component in its own axes, a multiple of a parameter,
//! where that in the world has three.

use super::axes::{AllAxes, Axes, DeclaredTurn};
use super::combinations::add_scaled;
use super::rotations::transposed;
use super::shifts::Turned;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::numbering::Numbering;
use crate::workbench::Workbench;
use crate::zero::field::{add, mul, neg};

/// Axes at a point modulo the prime.
struct Sample {
    /// The matrix to the axes against which they are declared.
    matrix: [[u64; 3]; 3],
    /// The components of the spin against these, in their own: combinations of the parameters.
    spin: [Vec<u64>; 3],
}

impl AllAxes {
    /// Lets general axes hang on others that are declared against the same ones, given the rates of the coordinates as combinations of the
    /// parameters; `None` where something has no value at the point.
    pub(super) fn settle_neighbours(
        &mut self,
        bench: &mut Workbench,
        numbers: &mut Numbering,
        partials: &mut VelocityPartials,
        rates: &[Vec<u64>],
    ) -> Option<()> {
        let mut older: Vec<(DeclaredTurn, Sample)> = Vec::new();
        for turn in self.general.clone() {
            let own = Sample::new(bench, numbers, partials, (&turn, rates))?;
            let among = older.iter().filter(|(other, _)| other.against == turn.against);
            let among = among.map(|(other, sample)| (own.components_against(sample), other));
            // Of equal ones the one declared against comes first, then the oldest.
            let best = among.min_by_key(|(count, _)| *count).filter(|(count, _)| *count < own.components());
            if let Some((_, other)) = best {
                self.hang(bench, &turn, other);
            }
            older.push((turn, own));
        }
        Some(())
    }

    /// Lets axes hang on others: `R_o^T R`, and `w - R^T R_o w_o`.
    fn hang(&mut self, bench: &mut Workbench, own: &DeclaredTurn, other: &DeclaredTurn) {
        let (back, columns) = (transposed(&other.matrix), transposed(&own.matrix));
        let matrix = back.map(|row| columns.map(|column| bench.dot(&row, &column)));
        let seen = transposed(&matrix).map(|row| bench.dot(&row, &other.spin));
        let spin = [0, 1, 2].map(|q| bench.graph.sub(own.spin[q], seen[q]));
        self.list[own.axes] = Axes { parent: other.axes, turned: Turned::By { matrix, spin } };
    }
}

impl Sample {
    fn new(
        bench: &mut Workbench,
        numbers: &mut Numbering,
        partials: &mut VelocityPartials,
        (turn, rates): (&DeclaredTurn, &[Vec<u64>]),
    ) -> Option<Self> {
        let width = rates.first().map_or(0, Vec::len);
        let mut sample = Sample { matrix: [[0; 3]; 3], spin: [0; 3].map(|_| vec![0; width]) };
        for (column, e) in sample.spin.iter_mut().zip(turn.spin) {
            let form = partials.affine(bench, e)?;
            for (i, b) in &form.on_velocities {
                add_scaled(column, numbers.at_point(bench, *b)?, &rates[*i]);
            }
            let last = column.last_mut()?;
            *last = add(*last, numbers.at_point(bench, form.offset)?);
        }
        for (residue, e) in sample.matrix.iter_mut().flatten().zip(turn.matrix.iter().flatten()) {
            *residue = numbers.at_point(bench, *e)?;
        }
        Some(sample)
    }

    fn components(&self) -> usize {
        count(&self.spin)
    }

    /// The number of components of the spin against other axes.
    fn components_against(&self, other: &Sample) -> usize {
        let mut relative = self.spin.clone();
        for (i, column) in relative.iter_mut().enumerate() {
            for (k, theirs) in other.spin.iter().enumerate() {
                let entry = (0..3).fold(0, |sum, r| add(sum, mul(self.matrix[r][i], other.matrix[r][k])));
                add_scaled(column, neg(entry), theirs);
            }
        }
        count(&relative)
    }
}

fn count(spin: &[Vec<u64>; 3]) -> usize {
    spin.iter().filter(|component| component.iter().any(|entry| *entry != 0)).count()
}
