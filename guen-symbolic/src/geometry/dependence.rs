//! Finds the forms that are linear combinations of others, and the combinations.

use super::Forms;
use super::minors::{ADJUGATE_SIZE, adjugate};
use crate::algebra::{ExprId, Rational};
use crate::workbench::Workbench;

/// The forms are linearly dependent as functions.
#[derive(Clone, Debug)]
pub struct SingularForms {
    /// Forms (by index) and coefficients of a combination whose velocities cancel; coefficients where they are known.
    pub combination: Vec<(usize, Option<ExprId>)>,
    /// The part of the combination without velocities, `sum c_j a_j0`, where the coefficients are known.
    pub rest: Option<ExprId>,
}

/// The combinations of rows that vanish, one for each row that depends on rows before it, by rank modulo p; their
/// coefficients by elimination where rows are few.
pub(super) fn dependencies(bench: &mut Workbench, forms: &Forms) -> Vec<SingularForms> {
    let rows: Vec<Vec<ExprId>> = forms.forms.iter().map(|form| form.row.clone()).collect();
    let full =
        |bench: &mut Workbench, trial: &[Vec<ExprId>]| rank(bench, trial).map(|rank| rank == trial.len());
    let mut found = Vec::new();
    // `None` where no point was found: then nothing is known to be dependent.
    if full(bench, &rows) != Some(false) {
        return found;
    }
    // Grow an independent set; a row that does not enlarge it is dependent on the ones before.
    let mut independent: Vec<usize> = Vec::new();
    for j in 0..rows.len() {
        let mut trial: Vec<Vec<ExprId>> = independent.iter().map(|k| rows[*k].clone()).collect();
        trial.push(rows[j].clone());
        if full(bench, &trial) != Some(false) {
            independent.push(j);
            continue;
        }
        // Keep only the rows that the dependence needs.
        let mut support = independent.clone();
        for k in &independent {
            let without: Vec<usize> = support.iter().copied().filter(|other| other != k).collect();
            let mut trial: Vec<Vec<ExprId>> = without.iter().map(|k| rows[*k].clone()).collect();
            trial.push(rows[j].clone());
            if full(bench, &trial) == Some(false) {
                support = without;
            }
        }
        found.push(combination(bench, forms, &support, j));
    }
    found
}

/// The rank at points of the manifold; at any where none of it is found, so that what depends on others everywhere is still seen.
fn rank(bench: &mut Workbench, rows: &[Vec<ExprId>]) -> Option<usize> {
    let on_manifold = bench.zero.rank(&mut bench.graph, rows, true);
    on_manifold.or_else(|| bench.zero.rank(&mut bench.graph, rows, false))
}

/// The dependent row `j` with its coefficients on the rows of its support, and what their offsets leave.
fn combination(bench: &mut Workbench, forms: &Forms, support: &[usize], j: usize) -> SingularForms {
    let rows: Vec<&[ExprId]> = support.iter().map(|k| &forms.forms[*k].row[..]).collect();
    let Some(coefficients) = dependence(bench, &rows, &forms.forms[j].row) else {
        return SingularForms {
            combination: support.iter().chain([&j]).map(|k| (*k, None)).collect(),
            rest: None,
        };
    };
    let mut combination = Vec::new();
    let mut rest = bench.graph.neg(forms.forms[j].offset);
    for (c, k) in coefficients.into_iter().zip(support) {
        let share = bench.graph.mul(c, forms.forms[*k].offset);
        rest = bench.graph.add(rest, share);
        combination.push((*k, Some(c)));
    }
    combination.push((j, Some(bench.graph.number(Rational::MINUS_ONE))));
    SingularForms { combination, rest: Some(bench.tidy(rest)) }
}

/// The coefficients of `target = sum c_k row_k` over independent rows, by Cramer's rule on columns where the rows
/// are regular; none for many rows.
pub(crate) fn dependence(
    bench: &mut Workbench,
    rows: &[&[ExprId]],
    target: &[ExprId],
) -> Option<Vec<ExprId>> {
    if rows.len() > ADJUGATE_SIZE {
        return None;
    }
    let mut columns: Vec<usize> = Vec::new();
    for c in 0..target.len() {
        let mut trial = columns.clone();
        trial.push(c);
        let minor: Vec<Vec<ExprId>> =
            trial.iter().map(|c| rows.iter().map(|row| row[*c]).collect()).collect();
        if rank(bench, &minor) == Some(trial.len()) {
            columns = trial;
        }
    }
    if columns.len() != rows.len() {
        return None;
    }
    // B^T c = r with B the minor of the rows and r the target on the same columns.
    let matrix: Vec<Vec<ExprId>> = columns.iter().map(|c| rows.iter().map(|row| row[*c]).collect()).collect();
    let (adjugate, determinant) = adjugate(bench, &matrix);
    let target: Vec<ExprId> = columns.iter().map(|c| target[*c]).collect();
    Some(
        adjugate
            .iter()
            .map(|row| {
                let numerator = bench.dot(row, &target);
                let quotient = bench.graph.div(numerator, determinant);
                bench.tidy(quotient)
            })
            .collect(),
    )
}
