//! Comparing results that were found in two ways.

use crate::algebra::ExprId;
use crate::workbench::Workbench;
use crate::zero::FEWEST_POINTS_WITH_ROOTS;

/// Whether expressions have the same values at random points wherever the constraints on positions hold: at many, where signs may be
/// right by chance.
pub(super) fn agree(bench: &mut Workbench, own: &[ExprId], other: &[ExprId]) -> bool {
    const AGREEMENT_POINTS: usize = 4;
    let differences: Vec<ExprId> = own.iter().zip(other).map(|(a, b)| bench.graph.sub(*a, *b)).collect();
    let signs = differences.iter().any(|e| bench.zero.has_signs_or_roots(&bench.graph, *e));
    // Where no points of the constraints are found, any points do: equality everywhere is enough.
    let on_manifold = bench.zero.manifold_has_points();
    (0..if signs { FEWEST_POINTS_WITH_ROOTS } else { AGREEMENT_POINTS }).all(|point| {
        let residues = bench.zero.residues(&mut bench.graph, point, &differences, on_manifold);
        residues.is_some_and(|residues| residues.iter().all(|residue| *residue == 0))
    })
}
