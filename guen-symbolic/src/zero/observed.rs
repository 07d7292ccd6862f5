//! Facts that real points show, in 237 bits, beside what residues say: ranks where the holonomic constraints hold, and functions that jump.

use super::real::{RealPoint, RealRank};
use super::table::{ATOM, PIECEWISE, ROOT, SIGN};
use super::{LEAST_WITNESSES, REAL_POINTS, REAL_WITNESSES, Redundant, ZeroTest};
use crate::algebra::{ExprId, Graph};

impl ZeroTest {
    /// The rank of a matrix at general points of the manifold, observed at real points in 237 bits where there are none modulo the prime: all rows
    /// at one of them, fewer at [`REAL_WITNESSES`], or at [`LEAST_WITNESSES`] if there are no more; `None` without as many.
    pub(crate) fn observed_rank(&mut self, g: &mut Graph, rows: &[Vec<ExprId>]) -> Option<usize> {
        if self.manifold_is_solved() {
            return self.rank(g, rows, true);
        }
        let (mut rank, mut witnesses) = (0, 0);
        for number in 0..REAL_POINTS {
            let Some(point) = self.real_point(g, number, true) else { continue };
            let Some(RealRank { rank: observed, is_certain }) = point.rank(g, rows) else { continue };
            (rank, witnesses) = (rank.max(observed), witnesses + usize::from(is_certain));
            if rank == rows.len() || witnesses == REAL_WITNESSES {
                break;
            }
        }
        (rank == rows.len() || witnesses >= LEAST_WITNESSES).then_some(rank)
    }

    /// Whether a function without derivatives by what moves has several values, as `sign(x)` has, and `atan(x) + atan(1/x)`: seen at real points
    /// with the same constants. Roots are what they are on the manifold, and such points do not lie there.
    pub(crate) fn has_several_values(&mut self, g: &Graph, e: ExprId) -> bool {
        self.table.scan(g);
        let flags = self.table.flags[e.index()];
        // Anything else is meromorphic, and one constant everywhere.
        let may_jump = if self.manifold.is_some() { PIECEWISE } else { PIECEWISE | SIGN | ROOT | ATOM };
        if flags & may_jump == 0 {
            return false;
        }
        let mut values = (0..REAL_POINTS as u64).map(|number| RealPoint::with_first_constants(g, e, number));
        let Some(first) = values.find(Option::is_some).flatten() else { return false };
        values.flatten().any(|value| value.differs(first))
    }

    /// The rows of velocities, with their parts without velocities, that are combinations of others at all points of the manifold, though not
    /// everywhere. Rows that stay are never among them. What is a combination of others everywhere, or contradicts them, is none of them.
    ///
    /// That is observed at real points: one at which a row is independent is enough to keep it.
    ///
    /// ```
    /// use guen_symbolic::{Graph, Redundant, Role, ZeroTest};
    /// let mut g = Graph::new();
    /// let [a, b] = ["a", "b"].map(|name| g.symbol(name, Role::Coordinate));
    /// let equation = g.sub(a, b);
    /// let (one, zero) = (g.one(), g.zero());
    /// let mut test = ZeroTest::new();
    /// test.set_manifold(&mut g, &[equation]);
    /// let rows = [(vec![one, a], zero), (vec![one, b], zero), (vec![one, b], one)];
    /// let found = test.redundant_rows(&mut g, &rows, &[false; 3]);
    /// assert_eq!(found, [Redundant { equation: 1, beside: vec![0] }]);
    /// ```
    pub fn redundant_rows(
        &mut self,
        g: &mut Graph,
        rows: &[(Vec<ExprId>, ExprId)],
        stays: &[bool],
    ) -> Vec<Redundant> {
        let coefficients = |places: &[usize]| places.iter().map(|i| rows[*i].0.clone()).collect::<Vec<_>>();
        let all: Vec<usize> = (0..rows.len()).collect();
        if self.manifold.is_none()
            || self.observed_rank(g, &coefficients(&all)).is_none_or(|rank| rank == rows.len())
        {
            return Vec::new();
        }
        let (mut kept, others): (Vec<usize>, Vec<usize>) = all.into_iter().partition(|i| stays[*i]);
        let mut found = Vec::new();
        for row in others {
            // A row of which nothing is left there says nothing of others.
            if self.is_dependent(g, &coefficients(&[row])) {
                continue;
            }
            let with = [&kept[..], &[row]].concat();
            if !self.is_dependent(g, &coefficients(&with)) {
                kept.push(row);
                continue;
            }
            let whole: Vec<Vec<ExprId>> =
                with.iter().map(|i| [&rows[*i].0[..], &[rows[*i].1]].concat()).collect();
            let is_everywhere = self.rank(g, &coefficients(&with), false) != Some(with.len());
            if is_everywhere || !self.is_dependent(g, &whole) {
                continue;
            }
            let mut beside = kept.clone();
            for other in &kept {
                let fewer: Vec<usize> = beside.iter().copied().filter(|k| k != other).collect();
                if self.is_dependent(g, &coefficients(&[&fewer[..], &[row]].concat())) {
                    beside = fewer;
                }
            }
            found.push(Redundant { equation: row, beside });
        }
        found
    }

    /// Whether rows are dependent at all points of the manifold that are looked at.
    fn is_dependent(&mut self, g: &mut Graph, rows: &[Vec<ExprId>]) -> bool {
        if self.manifold_is_solved() && self.rank(g, rows, true) == Some(rows.len()) {
            return false;
        }
        let mut points = 0;
        for number in 0..REAL_POINTS {
            let Some(point) = self.real_point(g, number, true) else { continue };
            let Some(RealRank { rank, is_certain }) = point.rank(g, rows) else { continue };
            if rank == rows.len() {
                return false;
            }
            points += usize::from(is_certain);
        }
        points >= LEAST_WITNESSES
    }
}
