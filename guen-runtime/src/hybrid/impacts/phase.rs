//! One phase of an impact: normal complementarity and Coulomb's law between impulses and the rates after them, solved by enumeration.

use crate::hybrid::filled::{filled, table};
use crate::hybrid::interface::element::Element;
use crate::hybrid::interface::loads;
use crate::numbers::real::Real;
use core::f64::consts::TAU;

/// The reason why there is no impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::hybrid) enum Unsolved {
    /// No impulses satisfy the law, or this implementation does not find them.
    None,
    /// Impulses with different rates satisfy it.
    Several,
    /// The energy grows.
    EnergyGain(f64),
}

/// The part of an element in a phase.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Participant<R = f64> {
    /// No part.
    #[default]
    Absent,
    /// A contact: `0 <= gamma_n` is complementary to `Lambda_n - floor >= 0`.
    Contact { floor: R },
    /// Friction under the impulse of another element.
    Grip,
    /// A rate that vanishes, whatever impulse that takes.
    Locked,
}

impl<R> Participant<R> {
    /// Takes the part over to other reals.
    pub(super) fn map<T>(self, change: impl Fn(R) -> T) -> Participant<T> {
        match self {
            Self::Absent => Participant::Absent,
            Self::Contact { floor } => Participant::Contact { floor: change(floor) },
            Self::Grip => Participant::Grip,
            Self::Locked => Participant::Locked,
        }
    }
}

/// The tangential state of an element in a phase.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Tangential<R = f64> {
    /// There is no tangential impulse to speak of.
    #[default]
    None,
    Stick,
    /// Slip in the direction of this unit vector.
    Slip([R; 2]),
}

impl Tangential {
    /// The slip in the direction of these rates.
    pub(super) fn along<const W: usize>(rows: &[usize], rates: &[f64; W]) -> Self {
        let component = |k: usize| rows.get(k).map_or(0.0, |&row| rates[row]);
        let [x, y] = [component(0), component(1)];
        let length = libm::hypot(x, y);
        if length > 0.0 { Self::Slip([x / length, y / length]) } else { Self::None }
    }
}

/// One phase of an impact.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Phase<'a, R, const W: usize, const C: usize> {
    pub(super) elements: &'a [Element; C],
    pub(super) delassus: &'a [[R; W]; W],
    /// The rates of the rows before it.
    pub(in crate::hybrid) before: [R; W],
    /// The largest rate before the impact, with which rates are compared.
    pub(super) scale: f64,
    pub(super) participants: [Participant<R>; C],
    pub(super) friction: [R; C],
    /// The changes of the impulses of permanent constraints that load grips, by unit impulses along the rows.
    pub(super) loads: &'a [[R; W]; C],
}

/// The solution of a phase.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Solved<R, const W: usize, const C: usize> {
    pub(in crate::hybrid) impulses: [R; W],
    pub(in crate::hybrid) after: [R; W],
    /// The contacts whose normal rate vanishes.
    pub(super) closed: [bool; C],
    pub(super) tangential: [Tangential<R>; C],
}

/// Combinations that are tried in one phase.
const MAX_COMBINATIONS: usize = 1 << 17;
/// Parts of a turn in which directions of spatial slip are looked for.
const DIRECTIONS: usize = 180;
/// The violation of an inequality, relative to the rates before and to impulses that stop them, that is rounding.
const VIOLATION_ROUNDING: f64 = 1e-11;
/// The difference of rates, relative to those before, by which two solutions are two.
const DIFFERENT: f64 = 1e-7;

/// A state of one element that is tried.
#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    closed: bool,
    tangential: Tangential,
    /// Spatial slip in a direction that is to be found.
    turns: bool,
}

impl<const W: usize, const C: usize> Phase<'_, f64, W, C> {
    /// The impulses that satisfy the laws of all elements.
    pub(in crate::hybrid) fn solve(&self) -> Result<Solved<f64, W, C>, Unsolved> {
        let mut best: Option<(f64, Solved<f64, W, C>)> = None;
        let mut several = false;
        self.visit(&mut |solved, violation| {
            several |= best.as_ref().is_some_and(|(_, best)| !self.is_same(solved, best));
            if best.as_ref().is_none_or(|(least, _)| violation < *least) {
                best = Some((violation, *solved));
            }
        })?;
        match best {
            _ if several => Err(Unsolved::Several),
            Some((_, solved)) => Ok(solved),
            None => Err(Unsolved::None),
        }
    }

    /// Whether two solutions have the same rates.
    pub(in crate::hybrid) fn is_same(&self, one: &Solved<f64, W, C>, other: &Solved<f64, W, C>) -> bool {
        let same = |(a, b): (&f64, &f64)| (a - b).abs() <= DIFFERENT * self.scale;
        one.after.iter().zip(&other.after).all(same)
    }

    /// Visits the states of all elements whose impulses satisfy the laws, with their violation by rounding.
    pub(in crate::hybrid) fn visit(
        &self,
        visit: &mut dyn FnMut(&Solved<f64, W, C>, f64),
    ) -> Result<(), Unsolved> {
        let choices: [([Candidate; 8], usize); C] = filled(|c| self.choices(c));
        let count = choices.iter().fold(1_usize, |product, (_, length)| product.saturating_mul(*length));
        if count > MAX_COMBINATIONS {
            return Err(Unsolved::None);
        }
        let mut judge = |solved: &Solved<f64, W, C>| {
            let violation = self.violation(solved, self.scale);
            if violation <= VIOLATION_ROUNDING {
                visit(solved, violation);
            }
        };
        for index in 0..count {
            let mut rest = index;
            let chosen = choices.map(|(states, length)| {
                let state = states[rest % length];
                rest /= length;
                state
            });
            let closed = chosen.map(|choice| choice.closed);
            let tangential = chosen.map(|choice| choice.tangential);
            let turning = chosen.iter().filter(|choice| choice.turns).count();
            match chosen.iter().position(|choice| choice.turns) {
                None => {
                    if let Some(solved) = self.with_states(&closed, &tangential) {
                        judge(&solved);
                    }
                }
                Some(_) if turning > 1 => {
                    let turns = chosen.map(|choice| choice.turns);
                    self.turned_together(&turns, &closed, &tangential, &mut judge);
                }
                Some(turning) => self.turned(turning, &closed, tangential, &mut judge),
            }
        }
        Ok(())
    }

    /// The states of an element that are tried.
    fn choices(&self, c: usize) -> ([Candidate; 8], usize) {
        let nothing = Candidate { closed: false, tangential: Tangential::None, turns: false };
        let mut all = [nothing; 8];
        let mut count = 0;
        let mut add = |choice| {
            all[count] = choice;
            count += 1;
        };
        let slides = |add: &mut dyn FnMut(Candidate), closed: bool| match self.elements[c].tangential.len() {
            0 => add(Candidate { closed, ..nothing }),
            components => {
                add(Candidate { closed, tangential: Tangential::Stick, turns: false });
                if components == 1 {
                    for sign in [1.0, -1.0] {
                        add(Candidate { closed, tangential: Tangential::Slip([sign, 0.0]), turns: false });
                    }
                } else {
                    add(Candidate { closed, tangential: Tangential::Slip([1.0, 0.0]), turns: true });
                }
            }
        };
        match self.participants[c] {
            Participant::Absent => add(nothing),
            Participant::Locked => add(Candidate { closed: true, ..nothing }),
            Participant::Grip if !self.elements[c].is_loaded() => add(nothing),
            Participant::Grip => slides(&mut add, false),
            Participant::Contact { floor } => {
                // Without an impulse there is no friction.
                if floor == 0.0 {
                    add(nothing)
                } else {
                    slides(&mut add, false)
                }
                slides(&mut add, true);
            }
        }
        (all, count)
    }

    /// The largest violation of an inequality: of rates relative to `scale`, of impulses relative to those that stop such rates.
    fn violation(&self, solved: &Solved<f64, W, C>, scale: f64) -> f64 {
        let Solved { impulses, after, closed, tangential } = solved;
        if scale == 0.0 {
            return 0.0;
        }
        let mut most = 0.0_f64;
        // Differences below zero, and NaN, count.
        let mut at_least_zero = |value: f64| most = if value >= -most { most } else { -value };
        for (c, element) in self.elements.iter().enumerate() {
            if let (Some(row), Participant::Contact { floor }) = (element.normal, self.participants[c]) {
                let size = scale / self.delassus[row][row];
                if closed[c] {
                    at_least_zero((impulses[row] - floor) / size);
                } else {
                    at_least_zero(after[row] / scale);
                }
            }
            match tangential[c] {
                Tangential::None => {}
                Tangential::Stick => {
                    if !element.is_loaded() {
                        continue;
                    }
                    let load = element
                        .load
                        .map_or(loads::added(&self.loads[c], impulses).abs(), |row| impulses[row]);
                    let square: f64 = element.tangential.iter().map(|&t| impulses[t] * impulses[t]).sum();
                    let size =
                        element.tangential.iter().map(|&t| scale / self.delassus[t][t]).fold(0.0, f64::max);
                    at_least_zero((self.friction[c] * load - libm::sqrt(square)) / size);
                }
                Tangential::Slip(direction) => {
                    let along: f64 =
                        element.tangential.iter().zip(direction).map(|(&t, d)| d * after[t]).sum();
                    at_least_zero(along / scale);
                }
            }
        }
        most
    }

    /// All directions of one spatial slip in which the slip after the phase is along the direction.
    fn turned(
        &self,
        turning: usize,
        closed: &[bool; C],
        mut tangential: [Tangential; C],
        judge: &mut dyn FnMut(&Solved<f64, W, C>),
    ) {
        let &[first, second] = self.elements[turning].tangential else { return };
        let mut at = |angle: f64| {
            let (y, x) = (libm::sin(angle), libm::cos(angle));
            tangential[turning] = Tangential::Slip([x, y]);
            let solved = self.with_states(closed, &tangential)?;
            Some((x * solved.after[second] - y * solved.after[first], solved))
        };
        let part = TAU / DIRECTIONS as f64;
        let mut before = at(0.0).map(|(aside, _)| aside);
        for k in 1..=DIRECTIONS {
            let (mut low, mut high) = (part * (k - 1) as f64, part * k as f64);
            let here = at(high).map(|(aside, _)| aside);
            if let (Some(a), Some(b)) = (before, here)
                && (a <= 0.0) != (b <= 0.0)
            {
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    match at(middle) {
                        Some((aside, _)) if (aside <= 0.0) == (a <= 0.0) => low = middle,
                        _ => high = middle,
                    }
                }
                if let Some((_, solved)) = at(0.5 * (low + high)) {
                    judge(&solved);
                }
            }
            before = here;
        }
    }
}

impl<R: Real, const W: usize, const C: usize> Phase<'_, R, W, C> {
    /// The impulses with which these contacts close and these elements stick or slip, whatever the inequalities say; none where
    /// they are not determined.
    pub(super) fn with_states(
        &self,
        closed: &[bool; C],
        tangential: &[Tangential<R>; C],
    ) -> Option<Solved<R, W, C>> {
        let zero = R::zero();
        let (mut known, mut unknown) = ([zero; W], [false; W]);
        for (c, element) in self.elements.iter().enumerate() {
            if let (Some(row), Participant::Contact { floor }) = (element.normal, self.participants[c]) {
                (known[row], unknown[row]) = (if closed[c] { zero } else { floor }, closed[c]);
            }
            if let (Some(row), Participant::Locked) = (element.normal, self.participants[c]) {
                unknown[row] = true;
            }
            if tangential[c] == Tangential::Stick {
                for &row in element.tangential {
                    unknown[row] = true;
                }
            }
        }
        // The matrix with the columns of friction added to those of the loads.
        let mut matrix = *self.delassus;
        for (c, element) in self.elements.iter().enumerate() {
            let (Tangential::Slip(direction), Some(load)) = (tangential[c], element.load) else { continue };
            for (w, row) in matrix.iter_mut().enumerate() {
                for (&t, d) in element.tangential.iter().zip(direction) {
                    row[load] -= self.friction[c] * d * self.delassus[w][t];
                }
            }
        }
        let right: [R; W] = filled(|w| -added(self.before[w], &known, &matrix[w]));
        let found = solve_some(&matrix, &right, &unknown)?;
        let mut impulses: [R; W] = filled(|w| known[w] + found[w]);
        let add_friction = |impulses: &mut [R; W]| {
            for (c, element) in self.elements.iter().enumerate() {
                let (Tangential::Slip(direction), Some(load)) = (tangential[c], element.load) else {
                    continue;
                };
                for (&t, d) in element.tangential.iter().zip(direction) {
                    impulses[t] = -(self.friction[c] * d * impulses[load]);
                }
            }
        };
        add_friction(&mut impulses);
        let slips: [bool; C] =
            filled(|c| self.elements[c].loaded_by_constraint && matches!(tangential[c], Tangential::Slip(_)));
        if slips.contains(&true) {
            // The impulses that a load of one causes.
            let mut caused = [[zero; W]; C];
            for (c, element) in self.elements.iter().enumerate() {
                let (Tangential::Slip(direction), true) = (tangential[c], slips[c]) else { continue };
                let along = |w: usize| {
                    let parts = element.tangential.iter().zip(direction);
                    parts.fold(zero, |sum, (&t, d)| sum + d * self.delassus[w][t])
                };
                let right: [R; W] = filled(|w| self.friction[c] * along(w));
                caused[c] = solve_some(&matrix, &right, &unknown)?;
                add_friction(&mut caused[c]);
                for (&t, d) in element.tangential.iter().zip(direction) {
                    caused[c][t] = -(self.friction[c] * d);
                }
            }
            let free = filled(|c| loads::added(&self.loads[c], &impulses));
            let coupling = table(|c, e| loads::added(&self.loads[c], &caused[e]));
            let found = loads::magnitudes(&free, &coupling, &slips);
            for (f, caused) in found.iter().zip(&caused) {
                for (impulse, part) in impulses.iter_mut().zip(caused) {
                    *impulse = f.times_plus(*part, *impulse);
                }
            }
        }
        let after: [R; W] = filled(|w| added(self.before[w], &impulses, &self.delassus[w]));
        let finite = after.iter().all(|rate| rate.to_f64().is_finite());
        finite.then_some(Solved { impulses, after, closed: *closed, tangential: *tangential })
    }
}

/// A rate with what impulses add to it.
fn added<R: Real, const W: usize>(rate: R, impulses: &[R; W], row: &[R; W]) -> R {
    impulses.iter().zip(row).fold(R::zero(), |sum, (l, d)| sum + *l * *d) + rate
}

/// Solves the equations of the unknown rows, with zeros elsewhere, by elimination with complete pivoting. Unknowns that the equations do
/// not determine are zero if the equations then hold; none if they do not.
pub(super) fn solve_some<R: Real, const W: usize>(
    matrix: &[[R; W]; W],
    right: &[R; W],
    unknown: &[bool; W],
) -> Option<[R; W]> {
    /// The part of the largest entry below which a pivot is rounding, and of a right side.
    const DEPENDENT: f64 = 1e-11;

    let (mut matrix, mut right) = (*matrix, *right);
    let mut rows: [usize; W] = filled(|w| w);
    let mut columns = rows;
    let mut count = 0;
    for w in 0..W {
        if unknown[w] {
            (rows[count], columns[count]) = (w, w);
            count += 1;
        }
    }
    let entry = |matrix: &[[R; W]; W], w: usize, v: usize| matrix[w][v].to_f64().abs();
    let mut largest = 0.0_f64;
    for &w in &rows[..count] {
        largest = columns[..count].iter().fold(largest, |most, &v| most.max(entry(&matrix, w, v)));
    }
    let size = right.iter().fold(0.0, |most: f64, r| most.max(r.to_f64().abs()));
    let mut rank = 0;
    while rank < count {
        let (mut best, mut most) = ((rank, rank), 0.0);
        for i in rank..count {
            for j in rank..count {
                let size = entry(&matrix, rows[i], columns[j]);
                if size > most {
                    (best, most) = ((i, j), size);
                }
            }
        }
        if !(most > DEPENDENT * largest) {
            break;
        }
        rows.swap(rank, best.0);
        columns.swap(rank, best.1);
        let (row, column) = (rows[rank], columns[rank]);
        for &other in &rows[rank + 1..count] {
            let factor = matrix[other][column] / matrix[row][column];
            for &v in &columns[rank..count] {
                let entry = matrix[row][v];
                matrix[other][v] -= factor * entry;
            }
            let entry = right[row];
            right[other] -= factor * entry;
        }
        rank += 1;
    }
    if rows[rank..count].iter().any(|&row| !(right[row].to_f64().abs() <= DEPENDENT * size)) {
        return None;
    }
    let mut solution = [R::zero(); W];
    for k in (0..rank).rev() {
        let (row, column) = (rows[k], columns[k]);
        let mut rest = R::zero();
        for &v in &columns[k + 1..rank] {
            rest += matrix[row][v] * solution[v];
        }
        solution[column] = (right[row] - rest) / matrix[row][column];
    }
    Some(solution)
}
