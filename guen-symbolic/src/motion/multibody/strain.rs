//! The effect of a displacement on bodies where the matrix of a frame is a rotation on the constraints alone.
//!
//! A quaternion turns where its length is one, and the displacement along the operator of that constraint stretches. Along `X` a
//! frame `B` has `B^T X(B) = [theta]x + e`, with the turn `theta` of its angular velocity. Beyond what a turn does, the places `s`,
//! the axes `e` and the angular velocities `F` of what hangs on it change by
//!
//! ```text
//! s_c = B^T (s_p + e_p r),   e_c = B^T e_p B + e,   F_c = B^T F_p - e^T B^T omega_p + d omega(x', X) + omega x theta
//! ```
//!
//! and by d'Alembert's principle the inertia of a body does the work `m a.s + (I omega).F` there, beside that of its turns. Forms that
//! speak of places have `s` as the coefficient of the parameter that belongs to `X`.

use super::assembly::Assembly;
use super::axes::{Matrix, Turned};
use super::kinematics::Kinematics;
use super::tree::{Mat3, Seat, Tree, Turn, Vec3, cross, plus};
use super::variables::{Var, Variables};
use crate::algebra::ExprId;
use crate::motion::velocity_forms::VelocityPartials;
use crate::motion::{Frame, Mechanics};
use crate::numbering::{Num, Numbering, Rates};
use crate::workbench::Workbench;

const NOTHING: Vec3 = [Num::ZERO; 3];

/// A displacement along the operator of a form, beside its turns.
pub(super) struct Strain {
    /// The form, counted from 0.
    pub(super) form: usize,
    /// `e`, in the axes.
    axes: Vec<Mat3>,
}

impl Strain {
    /// Finds the displacements that strain axes, along the operators of these forms.
    pub(super) fn all(
        bench: &mut Workbench,
        numbers: &mut Numbering,
        (system, frame): (&Mechanics, &Frame),
        tree: &Tree,
        forms: std::ops::Range<usize>,
    ) -> Vec<Strain> {
        let mut found = Vec::new();
        for form in forms {
            let mut axes: Vec<Mat3> = Vec::new();
            for (index, node) in tree.axes.iter().enumerate() {
                let mut whole = [NOTHING; 3];
                if index > 0 {
                    let parent = columns(&axes[node.parent]).map(|e| tree.outwards(numbers, index, &e));
                    whole = columns(&parent).map(|e| tree.outwards(numbers, index, &e));
                }
                if let Some((matrix, along)) = displaced(bench, numbers, (system, frame), tree, (index, form))
                {
                    let own = own(bench, numbers, (system, tree), (index, matrix), &along);
                    whole = [0, 1, 2].map(|q| plus(numbers, &whole[q], &own[q]));
                }
                axes.push(whole);
            }
            if axes.iter().flatten().flatten().any(|e| !e.is_zero()) {
                found.push(Strain { form, axes });
            }
        }
        found
    }

    /// Strains a vector of some axes.
    pub(super) fn of(&self, numbers: &mut Numbering, axes: usize, v: &Vec3) -> Vec3 {
        applied(numbers, &self.axes[axes], v)
    }

    fn is_at(&self, axes: usize) -> bool {
        self.axes[axes].iter().flatten().any(|e| !e.is_zero())
    }
}

/// The matrix of axes that are turned by one that moves, and the coordinates of it with what they are displaced by.
fn displaced<'a>(
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
fn displacement(system: &Mechanics, along: &Rates, coordinate: usize) -> Num {
    let x = system.forms.coordinates[coordinate];
    along.symbols.iter().find(|(symbol, _)| *symbol == x).map_or(Num::ZERO, |(_, xi)| *xi)
}

/// `theta`.
fn turn(numbers: &mut Numbering, (system, tree): (&Mechanics, &Tree), axes: usize, along: &Rates) -> Vec3 {
    let Turn::By { spin, .. } = &tree.axes[axes].turn else { return NOTHING };
    [0, 1, 2].map(|q| {
        let terms = spin[q].terms.iter().map(|(i, c)| (*c, displacement(system, along, *i)));
        let (coefficients, displacements): (Vec<Num>, Vec<Num>) = terms.unzip();
        numbers.dot(&coefficients, &displacements)
    })
}

/// `B^T X(B) - [theta]x`.
fn own(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    (system, tree): (&Mechanics, &Tree),
    (axes, matrix): (usize, &Matrix),
    along: &Rates,
) -> Mat3 {
    let displaced = matrix.map(|row| row.map(|e| numbers.slope_of(bench, along, e)));
    let pulled = columns(&displaced).map(|column| tree.outwards(numbers, axes, &column));
    let mut strain = columns(&pulled);
    for (q, turn) in turn(numbers, (system, tree), axes, along).into_iter().enumerate() {
        let (i, j) = ((q + 1) % 3, (q + 2) % 3);
        strain[j][i] = numbers.sub(strain[j][i], turn);
        strain[i][j] = numbers.add(strain[i][j], turn);
    }
    strain
}

/// The velocities of the bodies that are strained.
pub(super) fn needed(tree: &Tree, variables: &Variables, strains: &[Strain]) -> Vec<Var> {
    let is_strained = |seat: &&Seat| strains.iter().any(|strain| strain.is_at(seat.axes));
    let velocities = tree.seats.iter().filter(is_strained).flat_map(|seat| {
        let spins = (0..3).map(|q| variables.spin(seat.axes, q));
        spins
            .chain(seat.point.into_iter().flat_map(|point| (0..3).map(move |q| variables.velocity(point, q))))
    });
    velocities.collect()
}

impl Kinematics<'_> {
    /// `s`, in the axes of each point.
    fn strained_points(&mut self, strain: &Strain) -> Vec<Vec3> {
        let tree = self.tree;
        let mut points = vec![NOTHING];
        for node in &tree.points[1..] {
            let axes = tree.points[node.parent].axes;
            let before = strain.of(self.numbers, axes, &node.offset);
            let before = plus(self.numbers, &before, &points[node.parent]);
            let turned = node.axes != axes;
            points.push(if turned { tree.outwards(self.numbers, node.axes, &before) } else { before });
        }
        points
    }

    /// `F`, in the axes; `None` where an angular velocity is written in parameters.
    fn curls(&mut self, partials: &mut VelocityPartials, strain: &Strain) -> Option<Vec<Vec3>> {
        let (tree, system, frame) = (self.tree, self.system, self.frame);
        let mut curls: Vec<Vec3> = vec![NOTHING];
        for (index, node) in tree.axes.iter().enumerate().skip(1) {
            let mut curl = tree.outwards(self.numbers, index, &curls[node.parent]);
            let of = displaced(self.bench, self.numbers, (system, frame), tree, (index, strain.form));
            if let Some((matrix, along)) = of {
                let strain = own(self.bench, self.numbers, (system, tree), (index, matrix), &along);
                let carried = self.spin(node.parent);
                let carried = tree.outwards(self.numbers, index, &carried);
                let back = columns(&strain).map(|column| self.numbers.dot(&column, &carried).neg());
                let turn = turn(self.numbers, (system, tree), index, &along);
                let relative = self.relative_spin(index);
                let turning = cross(self.numbers, &relative, &turn);
                let own = self.curl_of(partials, index, &along)?;
                curl = [0, 1, 2].map(|q| self.numbers.sum([curl[q], back[q], turning[q], own[q]]));
            }
            curls.push(curl);
        }
        Some(curls)
    }

    /// `d omega(x', X)` of axes against their parent.
    fn curl_of(&mut self, partials: &mut VelocityPartials, axes: usize, along: &Rates) -> Option<Vec3> {
        let Turned::By { spin, .. } = &self.tree.all.list[axes].turned else { return None };
        let motion = self.motion();
        let mut curl = NOTHING;
        for (q, component) in spin.iter().enumerate() {
            let form = partials.affine(self.bench, *component).filter(|form| form.on_etas.is_empty())?;
            curl[q] = self.numbers.slope_of(self.bench, along, form.offset).neg();
            for (i, b) in form.on_velocities {
                let rate = self.numbers.slope_of(self.bench, &motion, b);
                let slope = self.numbers.slope_of(self.bench, along, b);
                let velocity = self.value(self.variables.rate(i));
                let first = self.numbers.mul(rate, displacement(self.system, along, i));
                let second = self.numbers.mul(slope, velocity);
                curl[q] = self.numbers.sum([curl[q], first, second.neg()]);
            }
        }
        Some(curl)
    }
}

impl Assembly<'_> {
    /// The inertia of all bodies along the parameter of a displacement, so far as they are strained.
    pub(super) fn strained(&mut self, partials: &mut VelocityPartials, strain: &Strain) -> Option<()> {
        let own = self.kinematics.variables.eta(strain.form);
        let points = self.kinematics.strained_points(strain);
        let curls = self.kinematics.curls(partials, strain)?;
        for seat in &self.kinematics.tree.seats {
            if let Some(point) = seat.point {
                self.strained_mass(own, (strain, &points[point]), (seat, point));
            }
            self.strained_turn(own, &curls[seat.axes], seat);
        }
        Some(())
    }

    /// `m a.s` of a mass centre at `c`, with `s + e c` for `s`; its momentum goes to the velocities of the point.
    fn strained_mass(&mut self, own: Var, (strain, s): (&Strain, &Vec3), (seat, point): (&Seat, usize)) {
        if !strain.is_at(seat.axes) && s.iter().all(|e| e.is_zero()) {
            return;
        }
        let variables = self.kinematics.variables;
        let acceleration = [0, 1, 2].map(|q| self.kinematics.acceleration(point, q));
        let gradient = self.kinematics.gradient(seat.axes);
        let w = self.kinematics.spin(seat.axes);
        let alpha = self.kinematics.spin_rates(seat.axes);
        let n = &mut *self.kinematics.numbers;
        let c = &seat.center;
        let h = c.map(|c| n.mul(seat.mass, c));
        let stretched = strain.of(n, seat.axes, &h);
        let shifted = s.map(|s| n.mul(seat.mass, s));
        let whole = plus(n, &shifted, &stretched);
        // m (s + e c).(a + U c), what is quadratic in c by its symmetric part.
        let turned = applied(n, &gradient, &h);
        let (straight, mixed) = (n.dot(&whole, &acceleration), n.dot(s, &turned));
        let mut force = n.add(straight, mixed);
        let mut moment = cross(n, &h, s);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (above, below) = (n.mul(stretched[i], c[j]), n.mul(stretched[j], c[i]));
            let (even, odd) = (n.add(above, below), n.sub(below, above));
            let product = n.mul(w[i], w[j]);
            let diagonal = n.mul(stretched[k], c[k]);
            let own = n.mul(diagonal, gradient[k][k]);
            let (across, along) = (n.mul(even, product), n.mul(odd, alpha[k]));
            force = n.sum([force, own, across, along]);
            moment[k] = n.add(moment[k], odd);
        }
        self.push(own, force.neg());
        for q in 0..3 {
            self.add(own, variables.velocity(point, q), whole[q]);
            self.add(own, variables.spin(seat.axes, q), moment[q]);
        }
    }

    /// `(I omega).F`.
    fn strained_turn(&mut self, own: Var, curl: &Vec3, seat: &Seat) {
        if curl.iter().all(|e| e.is_zero()) || seat.inertia.iter().all(|e| e.is_zero()) {
            return;
        }
        let w = self.kinematics.spin(seat.axes);
        let [xx, yy, zz, xy, yz, zx] = seat.inertia;
        let n = &mut *self.kinematics.numbers;
        let momentum = applied(n, &[[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]], &w);
        let force = n.dot(&momentum, curl);
        self.push(own, force.neg());
    }
}

fn columns(m: &Mat3) -> Mat3 {
    [0, 1, 2].map(|q| m.map(|row| row[q]))
}

fn applied(numbers: &mut Numbering, m: &Mat3, v: &Vec3) -> Vec3 {
    m.map(|row| numbers.dot(&row, v))
}
