//! Whether a mode that has more rows than freedom has forces inside of all cones, by least squares with nonnegative unknowns: shares nothing
//! with the vertices of the library.

use guen_runtime::hybrid::{Element, ElementState, FreeMotion, Mode};
use nalgebra::{DMatrix, DVector};

/// The forces of a mode in a plane that are in all cones up to a part of their size; none where there are none.
pub fn forces<const N: usize, const W: usize, const C: usize>(
    elements: &[Element; C],
    free: &FreeMotion<f64, N, W, C>,
    mode: &Mode<C>,
) -> Option<DVector<f64>> {
    // Forces are sums of the edges of the cones, each taken at least zero times, and a constant.
    let mut edges: Vec<DVector<f64>> = Vec::new();
    let mut constant = DVector::zeros(W);
    // The rows whose rates vanish; and pairs of edges that make a force between two limits, with the sum of both.
    let (mut held, mut pairs) = (Vec::new(), Vec::new());
    let unit = |row: usize| DVector::from_fn(W, |w, _| if w == row { 1.0 } else { 0.0 });
    for (c, element) in elements.iter().enumerate() {
        let slides = match mode.0[c] {
            ElementState::Open => continue,
            ElementState::SlipForward => Some(1.0),
            ElementState::SlipBackward => Some(-1.0),
            _ => None,
        };
        held.extend(element.normal);
        held.extend(element.tangential.iter().filter(|_| slides.is_none()));
        match (element.normal, element.tangential.first(), slides) {
            (Some(normal), Some(&along), Some(sign)) => {
                edges.push(unit(normal) - unit(along) * (sign * free.friction[c]));
            }
            (Some(normal), Some(&along), None) => {
                edges.push(unit(normal) + unit(along) * free.stiction[c]);
                edges.push(unit(normal) - unit(along) * free.stiction[c]);
            }
            (Some(normal), None, _) => edges.push(unit(normal)),
            (None, Some(&along), Some(sign)) => constant[along] -= sign * free.limits[c],
            (None, Some(&along), None) => {
                pairs.push((edges.len(), 2.0 * free.limits[c]));
                constant[along] -= free.limits[c];
                edges.push(unit(along));
                edges.push(DVector::zeros(W));
            }
            (None, None, _) => {}
        }
    }
    let delassus = DMatrix::from_fn(W, W, |i, j| free.delassus[i][j]);
    let map = if edges.is_empty() { DMatrix::zeros(W, 0) } else { DMatrix::from_columns(&edges) };
    let rates = DVector::from_row_slice(&free.biases) + &delassus * &constant;
    let slopes = &delassus * &map;
    let equations = held.len() + pairs.len();
    let matrix = DMatrix::from_fn(equations, edges.len(), |i, j| match held.get(i) {
        Some(&row) => slopes[(row, j)],
        None => f64::from(u8::from((0..2).any(|k| pairs[i - held.len()].0 + k == j))),
    });
    let right = DVector::from_fn(equations, |i, _| match held.get(i) {
        Some(&row) => -rates[row],
        None => pairs[i - held.len()].1,
    });
    let found = nonnegative(&matrix, &right)?;
    let off = &matrix * &found - &right;
    (off.amax() <= 1e-7 * right.amax().max(1.0)).then(|| map * found + constant)
}

/// The nonnegative numbers with which equations are fulfilled best, by Lawson's and Hanson's exchange of unknowns.
fn nonnegative(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let count = matrix.ncols();
    let mut taken = vec![false; count];
    let mut found: DVector<f64> = DVector::zeros(count);
    let small = 1e-12 * matrix.amax().max(1.0) * right.amax().max(1.0);
    for _ in 0..100 {
        let slopes = matrix.transpose() * (right - matrix * &found);
        let free = (0..count).filter(|j| !taken[*j] && slopes[*j] > small);
        let Some(next) = free.max_by(|a, b| slopes[*a].total_cmp(&slopes[*b])) else { return Some(found) };
        taken[next] = true;
        loop {
            let places: Vec<usize> = (0..count).filter(|j| taken[*j]).collect();
            let part = matrix.select_columns(&places);
            let best = part.clone().svd(true, true).solve(right, 1e-10 * part.amax()).ok()?;
            let below = |k: &usize| best[*k] <= 0.0;
            let step = |k: usize| found[places[k]] / (found[places[k]] - best[k]);
            let least = (0..places.len()).filter(below).map(step).fold(1.0, f64::min);
            for (k, &j) in places.iter().enumerate() {
                found[j] += least * (best[k] - found[j]);
            }
            if (0..places.len()).filter(below).count() == 0 {
                break;
            }
            for &j in &places {
                if found[j] <= small * f64::EPSILON {
                    (found[j], taken[j]) = (0.0, false);
                }
            }
        }
    }
    None
}

#[test]
fn numbers_below_zero_are_left_out() {
    let matrix = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 0.0, 1.0]);
    let inside = nonnegative(&matrix, &DVector::from_row_slice(&[3.0, 1.0])).unwrap();
    assert!((inside - DVector::from_row_slice(&[2.0, 1.0])).amax() < 1e-14);
    let outside = nonnegative(&matrix, &DVector::from_row_slice(&[1.0, 2.0])).unwrap();
    assert!((outside - DVector::from_row_slice(&[0.0, 1.5])).amax() < 1e-14);
}
