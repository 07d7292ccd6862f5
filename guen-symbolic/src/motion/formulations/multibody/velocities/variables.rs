//! Velocities as variables: which of them vanish, and which are multiples of each other, at a point modulo the prime.
//!
//! On the constraints every velocity is a combination of the parameters. Where two of these combinations are proportional by
//! a constant that is known, the velocities are one variable: the spin of a link that is a parameter, the velocity of a hub
//! that is a radius times a rate, the side of a wheel that cannot move.

use crate::motion::Mechanics;
use crate::motion::formulations::multibody::places::combinations::{add_scaled, rates_of_coordinates};
use crate::motion::formulations::multibody::places::tree::{RateForm, Tree, Turn};
use crate::numbering::{Num, Numbering};
use crate::workbench::Workbench;
use crate::zero::field;

/// A velocity: an index into the list of all.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(in crate::motion) struct Var(pub(in crate::motion) u32);

/// The value of a variable on the constraints: zero, or a multiple of the variable that stands for its class.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::motion) enum Class {
    Zero,
    /// A multiple of a variable that stands for its class; of itself once.
    Of(Var, Num),
}

/// The variables of a tree.
pub(in crate::motion) struct Variables {
    etas: usize,
    coordinates: usize,
    axes: usize,
    points: usize,
    /// Combinations of the parameters, the last entry for what is there without them.
    pub(in crate::motion) columns: Vec<Vec<u64>>,
    pub(super) classes: Vec<Class>,
    /// Components of the spin of axes against their parent that are multiples of a parameter.
    joints: Vec<[Option<(Var, Num)>; 3]>,
}

/// The velocity that a variable is: of a parameter, a point, a spin.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::motion) enum Kind {
    /// A parameter.
    Eta(usize),
    /// The rate of a coordinate.
    Rate(usize),
    /// A component of the angular velocity of axes.
    Spin(usize, usize),
    /// A component of the velocity of a point, in the axes of the point that it is seen from.
    Before(usize, usize),
    /// A component of the velocity of a point in its own axes.
    Velocity(usize, usize),
}

impl Variables {
    pub(in crate::motion) fn eta(&self, s: usize) -> Var {
        Var(s as u32)
    }

    pub(in crate::motion) fn rate(&self, i: usize) -> Var {
        Var((self.etas + i) as u32)
    }

    pub(in crate::motion) fn spin(&self, axes: usize, q: usize) -> Var {
        Var((self.etas + self.coordinates + 3 * axes + q) as u32)
    }

    pub(in crate::motion) fn before(&self, point: usize, q: usize) -> Var {
        Var((self.etas + self.coordinates + 3 * self.axes + 6 * point + q) as u32)
    }

    pub(in crate::motion) fn velocity(&self, point: usize, q: usize) -> Var {
        Var((self.etas + self.coordinates + 3 * self.axes + 6 * point + 3 + q) as u32)
    }

    pub(in crate::motion) fn len(&self) -> usize {
        self.etas + self.coordinates + 3 * self.axes + 6 * self.points
    }

    pub(in crate::motion) fn kind(&self, var: Var) -> Kind {
        let mut index = var.0 as usize;
        if index < self.etas {
            return Kind::Eta(index);
        }
        index -= self.etas;
        if index < self.coordinates {
            return Kind::Rate(index);
        }
        index -= self.coordinates;
        if index < 3 * self.axes {
            return Kind::Spin(index / 3, index % 3);
        }
        index -= 3 * self.axes;
        let (point, q) = (index / 6, index % 6);
        if q < 3 { Kind::Before(point, q) } else { Kind::Velocity(point, q - 3) }
    }

    pub(in crate::motion) fn class(&self, var: Var) -> Class {
        self.classes[var.0 as usize]
    }

    /// The columns and classes of a tree's velocities; `None` where the forms have no inverse at the point.
    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        numbers: &mut Numbering,
        system: &Mechanics,
        tree: &Tree,
    ) -> Option<Self> {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        let rates = rates_of_coordinates(bench, numbers, system)?;
        let mut all = Variables {
            etas: l,
            coordinates: n,
            axes: tree.axes.len(),
            points: tree.points.len(),
            columns: Vec::new(),
            classes: Vec::new(),
            joints: Vec::new(),
        };
        all.columns = vec![vec![0; l + 1]; all.len()];
        for s in 0..l {
            all.columns[s][s] = 1;
        }
        for (i, rate) in rates.into_iter().enumerate() {
            all.columns[l + i] = rate;
        }
        all.joints = tree.axes.iter().map(|node| all.joint(numbers, &node.turn)).collect();
        all.fill(numbers, tree);
        all.classify(numbers, tree);
        Some(all)
    }

    /// A component of the spin of axes against their parent, where that is a multiple of a parameter: that of a ball joint
    /// is, and the rates of its quaternion need not be known. None where the whole spin is known: then these follow from it.
    pub(in crate::motion) fn of_joint(&self, axes: usize, q: usize) -> Option<(Var, Num)> {
        let var = self.spin(axes, q);
        self.joints[axes][q].filter(|_| self.class(var) == Class::Of(var, Num::ONE))
    }

    fn joint(&self, numbers: &Numbering, turn: &Turn) -> [Option<(Var, Num)>; 3] {
        let Turn::By { spin, .. } = turn else { return [None; 3] };
        [0, 1, 2].map(|q| {
            let column = self.form(numbers, &spin[q]);
            if self.etas > 0 && column.iter().all(|entry| *entry == 0) {
                return Some((self.eta(0), Num::ZERO));
            }
            let mut nonzero = (0..).zip(&column).filter(|(_, entry)| **entry != 0);
            let (Some((place, factor)), None) = (nonzero.next(), nonzero.next()) else { return None };
            let factor = numbers.with_residue(*factor).filter(|factor| numbers.is_constant(*factor))?;
            (place < self.etas).then(|| (self.eta(place), factor))
        })
    }

    /// Whether a velocity vanishes or is a multiple of a parameter.
    pub(in crate::motion) fn is_known(&self, var: Var) -> bool {
        match self.class(var) {
            Class::Zero => true,
            Class::Of(representative, _) => matches!(self.kind(representative), Kind::Eta(_)),
        }
    }

    fn column(&self, var: Var) -> &[u64] {
        &self.columns[var.0 as usize]
    }

    fn form(&self, numbers: &Numbering, form: &RateForm) -> Vec<u64> {
        let mut sum = vec![0; self.etas + 1];
        for (i, c) in &form.terms {
            add_scaled(&mut sum, numbers.residue(*c), self.column(self.rate(*i)));
        }
        if let Some(offset) = form.offset {
            sum[self.etas] = field::add(sum[self.etas], numbers.residue(offset));
        }
        sum
    }

    /// Outwards along the tree.
    fn fill(&mut self, numbers: &Numbering, tree: &Tree) {
        for (index, axes) in tree.axes.iter().enumerate().skip(1) {
            let parent = [0, 1, 2].map(|q| self.column(self.spin(axes.parent, q)).to_vec());
            let mut own = turned(numbers, &axes.turn, &parent);
            match &axes.turn {
                Turn::World => {}
                Turn::About { axis, rate, .. } => add_scaled(&mut own[*axis], 1, &self.form(numbers, rate)),
                Turn::By { spin, .. } => {
                    for (own, spin) in own.iter_mut().zip(spin) {
                        add_scaled(own, 1, &self.form(numbers, spin));
                    }
                }
            }
            for (q, column) in own.into_iter().enumerate() {
                let var = self.spin(index, q);
                self.columns[var.0 as usize] = column;
            }
        }
        for (index, point) in tree.points.iter().enumerate().skip(1) {
            let parent = &tree.points[point.parent];
            let mut seen = [0, 1, 2].map(|q| self.column(self.velocity(point.parent, q)).to_vec());
            for q in 0..3 {
                let (j, k) = ((q + 1) % 3, (q + 2) % 3);
                let offset = |i: usize| numbers.residue(point.offset[i]);
                add_scaled(&mut seen[q], offset(k), self.column(self.spin(parent.axes, j)));
                add_scaled(&mut seen[q], field::neg(offset(j)), self.column(self.spin(parent.axes, k)));
                if let Some(rate) = &point.rate {
                    add_scaled(&mut seen[q], 1, &self.form(numbers, &rate[q]));
                }
            }
            let own = if point.axes == parent.axes {
                seen.clone()
            } else {
                turned(numbers, &tree.axes[point.axes].turn, &seen)
            };
            for (q, (seen, own)) in seen.into_iter().zip(own).enumerate() {
                let (before, velocity) = (self.before(index, q), self.velocity(index, q));
                self.columns[before.0 as usize] = seen;
                self.columns[velocity.0 as usize] = own;
            }
        }
    }

    fn classify(&mut self, numbers: &mut Numbering, tree: &Tree) {
        let mut known: Vec<(Vec<u64>, Var, u64)> = Vec::new();
        for index in 0..self.len() {
            let var = Var(index as u32);
            let class = self.class_of(numbers, tree, var, &mut known);
            self.classes.push(class);
        }
    }

    fn class_of(
        &self,
        numbers: &mut Numbering,
        tree: &Tree,
        var: Var,
        known: &mut Vec<(Vec<u64>, Var, u64)>,
    ) -> Class {
        let column = self.column(var);
        let Some(first) = column.iter().copied().find(|entry| *entry != 0) else { return Class::Zero };
        // What a point has in the axes before is what it is seen from has, where it is at the same place.
        match self.kind(var) {
            Kind::Before(point, q) if tree.is_at_rest(point) => {
                return self.class(self.velocity(tree.points[point].parent, q));
            }
            Kind::Velocity(point, q) => {
                let node = &tree.points[point];
                let is_kept = match tree.axes[node.axes].turn {
                    _ if node.axes == tree.points[node.parent].axes => true,
                    Turn::About { axis, .. } => axis == q,
                    _ => false,
                };
                if is_kept {
                    return self.class(self.before(point, q));
                }
            }
            _ => {}
        }
        let inverse = field::inverse(first).expect("it is not zero");
        let direction: Vec<u64> = column.iter().map(|entry| field::mul(*entry, inverse)).collect();
        for (other, representative, size) in known.iter() {
            if *other != direction {
                continue;
            }
            let ratio = field::mul(first, field::inverse(*size).expect("it is not zero"));
            if let Some(factor) = numbers.with_residue(ratio)
                && numbers.is_constant(factor)
            {
                return Class::Of(*representative, factor);
            }
        }
        // The velocity of a point stands for itself alone: what its rate is depends on its axes.
        if matches!(self.kind(var), Kind::Eta(_) | Kind::Rate(_) | Kind::Spin(..)) {
            known.push((direction, var, first));
        }
        Class::Of(var, Num::ONE)
    }
}

/// `R^T` of three columns.
fn turned(numbers: &Numbering, turn: &Turn, v: &[Vec<u64>; 3]) -> [Vec<u64>; 3] {
    match turn {
        Turn::World => v.clone(),
        Turn::About { axis, cosine, sine, .. } => {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let (c, s) = (numbers.residue(*cosine), numbers.residue(*sine));
            let mut image = v.clone();
            let zero = vec![0; v[0].len()];
            image[i] = zero.clone();
            image[j] = zero;
            add_scaled(&mut image[i], c, &v[i]);
            add_scaled(&mut image[i], s, &v[j]);
            add_scaled(&mut image[j], c, &v[j]);
            add_scaled(&mut image[j], field::neg(s), &v[i]);
            image
        }
        Turn::By { matrix, .. } => [0, 1, 2].map(|q| {
            let mut sum = vec![0; v[0].len()];
            for r in 0..3 {
                add_scaled(&mut sum, numbers.residue(matrix[r][q]), &v[r]);
            }
            sum
        }),
    }
}
