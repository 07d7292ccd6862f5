//! Points with drawn roots: of points modulo the prime one in 2^n has all of n roots.
//!
//! A root has a number there that is drawn for its radicand. What vanishes for any numbers vanishes for the true roots.

use super::{DrawnRoots, POINTS, Sample, ZeroTest};
use crate::algebra::{ExprId, Graph};

impl ZeroTest {
    /// The square roots at the point of a number with drawn roots.
    pub(crate) fn drawn_roots(&mut self, g: &Graph, point: usize, on_manifold: bool) -> Option<DrawnRoots> {
        let point = self.drawn(g, point, on_manifold)?;
        Some(point.roots())
    }

    /// The value of an expression at the point of a number with drawn roots.
    pub(crate) fn drawn_value_at(
        &mut self,
        g: &Graph,
        point: usize,
        e: ExprId,
        on_manifold: bool,
    ) -> Option<u64> {
        self.table.scan(g);
        self.drawn(g, point, on_manifold)?;
        let domain = if on_manifold && self.manifold.is_some() { &mut self.bound } else { &mut self.free };
        domain.drawn[point].value(g, &self.table, e)
    }

    /// Makes sure that the point of a number with drawn roots exists.
    fn drawn(&mut self, g: &Graph, number: usize, on_manifold: bool) -> Option<&Sample> {
        self.sample(g, number, on_manifold)?;
        let domain = if on_manifold && self.manifold.is_some() { &mut self.bound } else { &mut self.free };
        while domain.drawn.len() <= number {
            let point = domain.samples[domain.drawn.len()].with_drawn_roots();
            domain.drawn.push(point);
        }
        Some(&domain.drawn[number])
    }

    /// Whether an expression vanishes at points with drawn roots. Three points are enough, as for an expression without roots.
    pub(super) fn vanishes_whatever_roots_are(&mut self, g: &Graph, e: ExprId, on_manifold: bool) -> bool {
        (0..POINTS).all(|number| self.drawn_value_at(g, number, e, on_manifold) == Some(0))
    }
}
