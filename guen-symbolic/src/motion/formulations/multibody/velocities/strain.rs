//! The effect of a displacement on bodies where the matrix of a frame is a rotation on the constraints alone.
//!
//! A quaternion turns where its length is one, and the displacement along the operator of that constraint stretches, the same in all
//! directions. Along `X` a frame `B` has `B^T X(B) = [theta]x + e`, with the turn `theta` of its angular velocity and a number `e`.
//! Beyond what a turn does, the places `s`, the axes `e` and the angular velocities `F` of what hangs on it change by
//!
//! ```text
//! s_c = B^T (s_p + e_p r),   e_c = e_p + e,   F_c = B^T F_p - e B^T omega_p + d omega(x', X) + omega x theta
//! ```
//!
//! and by d'Alembert's principle the inertia of a body does the work `m a.s + (I omega).F` there, beside that of its turns. Forms that
//! speak of places have `s` as the coefficient of the parameter that belongs to `X`.

use super::variables::{Var, Variables};
use crate::algebra::ExprId;
use crate::motion::formulations::multibody::places::rotations::Matrix;
use crate::motion::formulations::multibody::places::shifts::Turned;
use crate::motion::formulations::multibody::places::tree::{Mat3, Seat, Tree, Turn, Vec3, columns};
use crate::motion::{Frame, Mechanics};
use crate::numbering::{Num, Numbering, Rates};
use crate::workbench::Workbench;

pub(in crate::motion) const NOTHING: Vec3 = [Num::ZERO; 3];

/// A displacement along the operator of a form, beside its turns.
pub(in crate::motion) struct Strain {
    /// The form, counted from 0.
    pub(in crate::motion) form: usize,
    /// `e` of each set of axes.
    axes: Vec<Num>,
}

impl Strain {
    /// Finds the displacements that strain axes, along the operators of these forms; `None` where one strains in some directions more
    /// than in others.
    pub(in crate::motion) fn all(
        bench: &mut Workbench,
        numbers: &mut Numbering,
        (system, frame): (&Mechanics, &Frame),
        tree: &Tree,
        forms: std::ops::Range<usize>,
    ) -> Option<Vec<Strain>> {
        let mut found = Vec::new();
        for form in forms {
            let mut axes: Vec<Num> = Vec::new();
            for (index, node) in tree.axes.iter().enumerate() {
                let mut whole = if index > 0 { axes[node.parent] } else { Num::ZERO };
                if let Some((matrix, along)) = displaced(bench, numbers, (system, frame), tree, (index, form))
                {
                    let own = own(bench, numbers, (system, tree), (index, matrix), &along)?;
                    whole = numbers.add(whole, own);
                }
                axes.push(whole);
            }
            if axes.iter().any(|e| !e.is_zero()) {
                found.push(Strain { form, axes });
            }
        }
        Some(found)
    }

    /// Strains a vector of some axes.
    pub(in crate::motion) fn of(&self, numbers: &mut Numbering, axes: usize, v: &Vec3) -> Vec3 {
        v.map(|v| numbers.mul(self.axes[axes], v))
    }

    pub(in crate::motion) fn is_at(&self, axes: usize) -> bool {
        !self.axes[axes].is_zero()
    }
}

/// The matrix of axes that are turned by one that moves, and the coordinates of it with what they are displaced by.
pub(in crate::motion) fn displaced<'a>(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    (system, frame): (&Mechanics, &Frame),
    tree: &'a Tree,
    (axes, form): (usize, usize),
) -> Option<(&'a Matrix, Rates)> {
    let Turned::By { matrix, spin } = &tree.all.list[axes].turned else { return None };
    let entries: Vec<ExprId> = matrix.iter().flatten().chain(spin).copied().collect();
    let occurring = bench.graph.symbols_in(&entries);
    let mut symbols = Vec::new();
    for (x, xi) in system.forms.coordinates.iter().zip(&frame.operators.xi[form + 1]) {
        if bench.graph.as_symbol(*x).is_some_and(|x| occurring.contains(&x)) {
            symbols.push((*x, numbers.import(bench, *xi)));
        }
    }
    (!symbols.is_empty()).then_some((matrix, Rates { symbols }))
}

/// The displacement of a coordinate.
pub(in crate::motion) fn displacement(system: &Mechanics, along: &Rates, coordinate: usize) -> Num {
    let x = system.forms.coordinates[coordinate];
    along.symbols.iter().find(|(symbol, _)| *symbol == x).map_or(Num::ZERO, |(_, xi)| *xi)
}

/// `theta`.
pub(in crate::motion) fn turn(
    numbers: &mut Numbering,
    (system, tree): (&Mechanics, &Tree),
    axes: usize,
    along: &Rates,
) -> Vec3 {
    let Turn::By { spin, .. } = &tree.axes[axes].turn else { return NOTHING };
    [0, 1, 2].map(|q| {
        let terms = spin[q].terms.iter().map(|(i, c)| (*c, displacement(system, along, *i)));
        let (coefficients, displacements): (Vec<Num>, Vec<Num>) = terms.unzip();
        numbers.dot(&coefficients, &displacements)
    })
}

/// `B^T X(B) - [theta]x`, a number times the unit matrix; `None` where it is none.
pub(in crate::motion) fn own(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    (system, tree): (&Mechanics, &Tree),
    (axes, matrix): (usize, &Matrix),
    along: &Rates,
) -> Option<Num> {
    let displaced = matrix.map(|row| row.map(|e| numbers.slope_of(bench, along, e)));
    let pulled = columns(&displaced).map(|column| tree.outwards(numbers, axes, &column));
    let mut strain = columns(&pulled);
    for (q, turn) in turn(numbers, (system, tree), axes, along).into_iter().enumerate() {
        let (i, j) = ((q + 1) % 3, (q + 2) % 3);
        strain[j][i] = numbers.sub(strain[j][i], turn);
        strain[i][j] = numbers.add(strain[i][j], turn);
    }
    let is_number =
        (0..3).all(|i| (0..3).all(|j| strain[i][j] == if i == j { strain[0][0] } else { Num::ZERO }));
    is_number.then_some(strain[0][0])
}

/// The velocities of the bodies that are strained.
pub(in crate::motion) fn needed(tree: &Tree, variables: &Variables, strains: &[Strain]) -> Vec<Var> {
    let is_strained = |seat: &&Seat| strains.iter().any(|strain| strain.is_at(seat.axes));
    let velocities = tree.seats.iter().filter(is_strained).flat_map(|seat| {
        let spins = (0..3).map(|q| variables.spin(seat.axes, q));
        spins
            .chain(seat.point.into_iter().flat_map(|point| (0..3).map(move |q| variables.velocity(point, q))))
    });
    velocities.collect()
}

pub(in crate::motion) fn applied(numbers: &mut Numbering, m: &Mat3, v: &Vec3) -> Vec3 {
    m.map(|row| numbers.dot(&row, v))
}
