//! A quadratic form and forces over variables, and how single variables leave them: by what they are combinations of, by
//! turns of pairs, by their own equations.

use std::collections::BTreeMap;

use crate::motion::formulations::multibody::velocities::relations::Linear;
use crate::motion::formulations::multibody::velocities::variables::{Class, Var, Variables};
use crate::numbering::{Num, Numbering};

/// `1/2 v^T D v` and `f`.
#[derive(Clone, Default)]
pub(in crate::motion) struct Form {
    rows: BTreeMap<Var, BTreeMap<Var, Num>>,
    forces: BTreeMap<Var, Num>,
    /// Variables that left by their own equations, with force over diagonal and row over diagonal.
    eliminated: Vec<(Var, Num, Linear)>,
    /// The divisors of the elimination.
    pub(super) pivots: Vec<Num>,
}

impl Form {
    /// The entry of two variables.
    pub(in crate::motion) fn entry(&self, i: Var, j: Var) -> Num {
        self.rows.get(&i).and_then(|row| row.get(&j)).copied().unwrap_or(Num::ZERO)
    }

    /// The force along a variable.
    pub(super) fn force(&self, i: Var) -> Num {
        self.forces.get(&i).copied().unwrap_or(Num::ZERO)
    }

    fn add_entry(&mut self, numbers: &mut Numbering, i: Var, j: Var, e: Num) {
        if e.is_zero() {
            return;
        }
        let sum = numbers.add(self.entry(i, j), e);
        for (a, b) in [(i, j), (j, i)] {
            let row = self.rows.entry(a).or_default();
            if sum.is_zero() {
                row.remove(&b);
            } else {
                row.insert(b, sum);
            }
        }
    }

    fn add_force(&mut self, numbers: &mut Numbering, i: Var, e: Num) {
        if e.is_zero() {
            return;
        }
        let sum = numbers.add(self.force(i), e);
        self.forces.insert(i, sum);
    }

    /// Adds `e v_i v_j`, once for a square, to the form; of any variables, for the one that stands for them.
    pub(super) fn add(&mut self, numbers: &mut Numbering, variables: &Variables, i: Var, j: Var, e: Num) {
        let (Class::Of(a, f), Class::Of(b, g)) = (variables.class(i), variables.class(j)) else { return };
        let product = numbers.mul(f, g);
        let e = numbers.mul(product, e);
        if i != j && a == b {
            // Two variables of one class: both products.
            let twice = numbers.add(e, e);
            self.add_entry(numbers, a, a, twice);
        } else {
            self.add_entry(numbers, a, b, e);
        }
    }

    /// Adds a force along any variable.
    pub(super) fn push(&mut self, numbers: &mut Numbering, variables: &Variables, i: Var, e: Num) {
        if let Class::Of(a, f) = variables.class(i) {
            let e = numbers.mul(f, e);
            self.add_force(numbers, a, e);
        }
    }

    /// The variables that are left.
    pub(in crate::motion) fn variables(&self) -> Vec<Var> {
        let mut all: Vec<Var> = self.rows.keys().chain(self.forces.keys()).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    fn take(&mut self, i: Var) -> (BTreeMap<Var, Num>, Num, Num) {
        let mut row = self.rows.remove(&i).unwrap_or_default();
        let own = row.remove(&i).unwrap_or(Num::ZERO);
        for j in row.keys() {
            if let Some(other) = self.rows.get_mut(j) {
                other.remove(&i);
            }
        }
        let force = self.forces.remove(&i).unwrap_or(Num::ZERO);
        (row, own, force)
    }

    /// `v_i = sum c_j v_j`, and for its rate the same and a bias.
    pub(super) fn substitute(&mut self, numbers: &mut Numbering, i: Var, terms: &[(Var, Num)], bias: Num) {
        let (row, own, mut force) = self.take(i);
        if !bias.is_zero() {
            let back = numbers.mul(own, bias);
            force = numbers.sub(force, back);
            for (j, d) in &row {
                let back = numbers.mul(*d, bias);
                self.add_force(numbers, *j, back.neg());
            }
        }
        for (j, c) in terms {
            for (k, d) in &row {
                let e = numbers.mul(*c, *d);
                let e = if j == k { numbers.add(e, e) } else { e };
                self.add_entry(numbers, *j, *k, e);
            }
        }
        if !own.is_zero() {
            for (a, (j, c)) in terms.iter().enumerate() {
                let scaled = numbers.mul(*c, own);
                for (k, d) in &terms[a..] {
                    let e = numbers.mul(scaled, *d);
                    self.add_entry(numbers, *j, *k, e);
                }
            }
        }
        for (j, c) in terms {
            let e = numbers.mul(*c, force);
            self.add_force(numbers, *j, e);
        }
    }

    /// Turns all pairs that one angle turns, together: `x = c X + s Y`, `y = c Y - s X` for each `(x, y, X, Y)`.
    pub(super) fn turn(
        &mut self,
        numbers: &mut Numbering,
        variables: &Variables,
        pairs: &[[Var; 4]],
        (c, s): (Num, Num),
    ) {
        let members: Vec<Var> = pairs.iter().flat_map(|[x, y, ..]| [*x, *y]).collect();
        let mut old: BTreeMap<Var, BTreeMap<Var, Num>> = BTreeMap::new();
        let mut forces: BTreeMap<Var, Num> = BTreeMap::new();
        for member in &members {
            let row = self.rows.remove(member).unwrap_or_default();
            for j in row.keys().filter(|j| !members.contains(j)) {
                if let Some(other) = self.rows.get_mut(j) {
                    other.remove(member);
                }
            }
            old.insert(*member, row);
            forces.insert(*member, self.forces.remove(member).unwrap_or(Num::ZERO));
        }
        let get = |a: Var, b: Var| old[&a].get(&b).copied().unwrap_or(Num::ZERO);
        let combine = |numbers: &mut Numbering, a: (Num, Num), b: (Num, Num)| {
            let (first, second) = (numbers.mul(a.0, a.1), numbers.mul(b.0, b.1));
            numbers.add(first, second)
        };
        for (place, [x, y, wx, wy]) in pairs.iter().copied().enumerate() {
            let mut outside: Vec<Var> =
                old[&x].keys().chain(old[&y].keys()).copied().filter(|k| !members.contains(k)).collect();
            outside.sort_unstable();
            outside.dedup();
            for k in outside {
                let (a, b) = (get(x, k), get(y, k));
                let first = combine(numbers, (c, a), (s.neg(), b));
                let second = combine(numbers, (s, a), (c, b));
                for (w, e) in [(wx, first), (wy, second)] {
                    let e = if w == k { numbers.add(e, e) } else { e };
                    self.add(numbers, variables, w, k, e);
                }
            }
            for (other, [u, v, wu, wv]) in pairs.iter().copied().enumerate().skip(place) {
                let (b11, b12, b21, b22) = (get(x, u), get(x, v), get(y, u), get(y, v));
                let d = numbers.sub(b11, b22);
                let e = numbers.add(b12, b21);
                let q = combine(numbers, (s, d), (c, e));
                let (sq, cq) = (numbers.mul(s, q), numbers.mul(c, q));
                let first = numbers.sub(b11, sq);
                let last = numbers.add(b22, sq);
                let cross = numbers.sub(cq, b21);
                self.add(numbers, variables, wx, wu, first);
                self.add(numbers, variables, wy, wv, last);
                self.add(numbers, variables, wx, wv, cross);
                if place != other {
                    let cross = numbers.sub(cq, b12);
                    self.add(numbers, variables, wy, wu, cross);
                }
            }
            let (fx, fy) = (forces[&x], forces[&y]);
            let first = combine(numbers, (c, fx), (s.neg(), fy));
            let second = combine(numbers, (s, fx), (c, fy));
            self.push(numbers, variables, wx, first);
            self.push(numbers, variables, wy, second);
        }
    }

    /// `sum_j D_ij v_j' = f_i` solved for the rate of a free variable, which leaves the others' equations.
    pub(super) fn eliminate(&mut self, numbers: &mut Numbering, i: Var) {
        let (row, own, force) = self.take(i);
        self.pivots.push(own);
        let inverse = numbers.div(Num::ONE, own);
        let scaled: Vec<(Var, Num)> = row.iter().map(|(j, d)| (*j, numbers.mul(*d, inverse))).collect();
        for (place, (j, u)) in scaled.iter().enumerate() {
            for (k, _) in &scaled[place..] {
                let e = numbers.mul(*u, row[k]);
                self.add_entry(numbers, *j, *k, e.neg());
            }
            let e = numbers.mul(*u, force);
            self.add_force(numbers, *j, e.neg());
        }
        let rate = numbers.mul(force, inverse);
        self.eliminated.push((i, rate, scaled));
    }

    /// The rates of the variables that left by their own equations, in the order in which they are found; `rate` is asked for
    /// that of others.
    pub(super) fn solved(
        &self,
        numbers: &mut Numbering,
        mut rate: impl FnMut(&mut Numbering, &BTreeMap<Var, Num>, Var) -> Num,
    ) -> BTreeMap<Var, Num> {
        let mut found = BTreeMap::new();
        for (i, own, scaled) in self.eliminated.iter().rev() {
            let mut sum = *own;
            for (j, u) in scaled {
                let other = match found.get(j) {
                    Some(known) => *known,
                    None => rate(numbers, &found, *j),
                };
                let part = numbers.mul(*u, other);
                sum = numbers.sub(sum, part);
            }
            found.insert(*i, sum);
        }
        found
    }

    /// Whether a variable left by its own equation.
    pub(super) fn is_eliminated(&self, i: Var) -> bool {
        self.eliminated.iter().any(|(other, ..)| *other == i)
    }

    /// Returns the number of other variables that a variable meets.
    pub(super) fn neighbours(&self, i: Var) -> usize {
        self.rows.get(&i).map_or(0, BTreeMap::len)
    }
}
