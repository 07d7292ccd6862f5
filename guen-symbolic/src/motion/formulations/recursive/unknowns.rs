//! The velocities that the constraints are solved for.
//!
//! In relative angles every link turns with all joints before it, and the rate of the last joint is what is left of two
//! turns. So the unknowns are the rates of base angles: each takes the place of one coordinate of its sum.

use crate::algebra::{ExprId, Rational, Substitution};
use crate::motion::Mechanics;
use crate::workbench::Workbench;

/// `x' = C w` and `w = B x'`. The symbol of `x_i'` stands for `w_i` in what is written in the unknowns.
pub(super) struct Unknowns {
    /// `C`, a row for each `x_i'`.
    of_velocities: Vec<Vec<Rational>>,
    /// `B`, a row for each `w_i`.
    by_velocities: Vec<Vec<Rational>>,
    into: Substitution,
}

impl Unknowns {
    pub(super) fn new(bench: &mut Workbench, system: &Mechanics) -> Self {
        let n = system.forms.len();
        let mut sums: Vec<Vec<Rational>> = Vec::new();
        for angle in bench.graph.base_angles() {
            let mut row = vec![Rational::ZERO; n];
            let parts = bench.graph.linear_parts(*angle);
            let is_sum = parts.iter().all(|(e, c)| {
                match system.forms.coordinates.iter().position(|x| x == e) {
                    Some(i) => row[i] = c.clone(),
                    None => return bench.graph.roles(*e).is_constant(),
                }
                true
            });
            if is_sum && row.iter().filter(|c| !c.is_zero()).count() > 1 {
                sums.push(row);
            }
        }
        let (of_velocities, by_velocities) = changed(n, sums);
        let mut images = Vec::new();
        for (i, row) in of_velocities.iter().enumerate() {
            let image = combined(bench, row, &system.velocities);
            if image != system.velocities[i] {
                images.push((system.velocities[i], image));
            }
        }
        Unknowns { of_velocities, by_velocities, into: Substitution::new(images) }
    }

    /// A form of velocities in the unknowns.
    pub(super) fn form(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        self.into.of(&mut bench.graph, e)
    }

    /// The coefficients of a row of velocities, `row C`.
    pub(super) fn row(&self, bench: &mut Workbench, row: &[ExprId]) -> Vec<ExprId> {
        (0..row.len())
            .map(|j| {
                let own: Vec<_> = row
                    .iter()
                    .zip(&self.of_velocities)
                    .filter(|(_, coefficients)| !coefficients[j].is_zero())
                    .map(|(a, coefficients)| (*a, coefficients[j].clone()))
                    .collect();
                let sum = bench.graph.linear(&own);
                if own.len() > 1 { bench.tidy(sum) } else { sum }
            })
            .collect()
    }

    /// `w_i` of velocities.
    pub(super) fn unknown(&self, bench: &mut Workbench, i: usize, velocities: &[ExprId]) -> ExprId {
        let sum = combined(bench, &self.by_velocities[i], velocities);
        bench.tidy(sum)
    }

    /// `x_i'` of unknowns.
    pub(super) fn velocity(&self, bench: &mut Workbench, i: usize, unknowns: &[ExprId]) -> ExprId {
        combined(bench, &self.of_velocities[i], unknowns)
    }
}

/// `C` and its inverse `B`, with the rates of sums in place of those of their youngest coordinates.
fn changed(n: usize, mut sums: Vec<Vec<Rational>>) -> (Vec<Vec<Rational>>, Vec<Vec<Rational>>) {
    let unit = |i: usize| (0..n).map(|k| if k == i { Rational::ONE } else { Rational::ZERO }).collect();
    let mut of_velocities: Vec<Vec<Rational>> = (0..n).map(unit).collect();
    let mut by_velocities = of_velocities.clone();
    let youngest = |row: &[Rational]| row.iter().rposition(|c| !c.is_zero());
    sums.sort_by_key(|row| youngest(row));
    sums.dedup_by_key(|row| youngest(row));
    for row in sums {
        let Some(i) = youngest(&row) else { continue };
        let Some(inverse) = row[i].recip() else { continue };
        // x_i' = (w_i - sum c_k x_k')/c_i, and the others are known in the unknowns.
        let mut solved: Vec<Rational> = (0..n)
            .map(|j| (0..i).map(|k| &row[k] * &of_velocities[k][j]).fold(Rational::ZERO, |sum, c| &sum - &c))
            .collect();
        solved[i] = &solved[i] + &Rational::ONE;
        solved.iter_mut().for_each(|c| *c = &*c * &inverse);
        of_velocities[i] = solved;
        by_velocities[i] = row;
    }
    (of_velocities, by_velocities)
}

fn combined(bench: &mut Workbench, row: &[Rational], of: &[ExprId]) -> ExprId {
    let terms: Vec<_> = of.iter().copied().zip(row.iter().cloned()).filter(|(_, c)| !c.is_zero()).collect();
    bench.graph.linear(&terms)
}

#[cfg(test)]
mod tests {
    use super::changed;
    use crate::algebra::Rational;

    #[test]
    fn velocities_of_unknowns_of_velocities_are_what_they_were() {
        // Sums of the second and third coordinate, of the first three with the last one, and nothing of the fourth.
        let sums = [[0, 1, 2, 0, 0], [3, -1, 1, 0, -2]];
        let sums = sums.map(|row| row.map(Rational::integer).to_vec()).to_vec();
        let (c, b) = changed(5, sums.clone());
        assert_eq!([&b[2], &b[4]], [&sums[0], &sums[1]]);
        for (i, row) in b.iter().enumerate() {
            for j in 0..5 {
                let entry = row.iter().zip(&c).fold(Rational::ZERO, |sum, (x, y)| &sum + &(x * &y[j]));
                assert_eq!(entry, if i == j { Rational::ONE } else { Rational::ZERO }, "{i}, {j}");
            }
        }
    }
}
