//! Whether a mode that has more rows than freedom has forces inside of all cones, by projections onto convex sets: shares nothing with the
//! vertices of the library.

use guen_runtime::hybrid::{Element, ElementState, FreeMotion, Mode};
use nalgebra::{DMatrix, DVector};

/// The forces of a mode in a plane that are in all cones up to a part of their size; none where the projections do not meet.
pub fn forces<const N: usize, const W: usize, const C: usize>(
    elements: &[Element; C],
    free: &FreeMotion<f64, N, W, C>,
    mode: &Mode<C>,
) -> Option<DVector<f64>> {
    // Forces are affine in one unknown for each row that is held: `l = L y + c`.
    let mut held: Vec<usize> = Vec::new();
    let mut columns: Vec<DVector<f64>> = Vec::new();
    let mut constant = DVector::zeros(W);
    let unit = |row: usize| DVector::from_fn(W, |w, _| if w == row { 1.0 } else { 0.0 });
    // Of each element the places of its unknowns: the normal one, the tangential one.
    let mut places = [(None, None); C];
    for (c, element) in elements.iter().enumerate() {
        let slides = match mode.0[c] {
            ElementState::Open => continue,
            ElementState::SlipForward => 1.0,
            ElementState::SlipBackward => -1.0,
            _ => 0.0,
        };
        if let Some(row) = element.normal {
            let along = element.tangential.first().filter(|_| slides != 0.0);
            let friction = along.map_or(DVector::zeros(W), |&row| unit(row) * (slides * free.friction[c]));
            places[c].0 = Some(held.len());
            held.push(row);
            columns.push(unit(row) - friction);
        }
        for &row in element.tangential {
            if slides == 0.0 {
                places[c].1 = Some(held.len());
                held.push(row);
                columns.push(unit(row));
            } else if element.normal.is_none() {
                constant[row] -= slides * free.limits[c];
            }
        }
    }
    let delassus = DMatrix::from_fn(W, W, |i, j| free.delassus[i][j]);
    let (count, map) = (held.len(), DMatrix::from_columns(&columns));
    let rates = DVector::from_row_slice(&free.biases) + &delassus * &constant;
    let slopes = &delassus * &map;
    let matrix = DMatrix::from_fn(count, count, |i, j| slopes[(held[i], j)]);
    let right = DVector::from_fn(count, |i, _| -rates[held[i]]);
    let size = matrix.amax();
    let inverse = matrix.clone().pseudo_inverse(1e-9 * size).ok()?;
    let mut unknowns: DVector<f64> = &inverse * &right;
    for _ in 0..20_000 {
        let outside = unknowns.clone();
        for (c, element) in elements.iter().enumerate() {
            match places[c] {
                (Some(n), Some(t)) => {
                    (unknowns[n], unknowns[t]) = in_cone(free.stiction[c], unknowns[n], unknowns[t]);
                }
                (Some(n), None) => unknowns[n] = unknowns[n].max(0.0),
                (None, Some(t)) if element.normal.is_none() => {
                    unknowns[t] = unknowns[t].clamp(-free.limits[c], free.limits[c]);
                }
                _ => {}
            }
        }
        let off = &matrix * &unknowns - &right;
        if off.amax() <= 1e-7 * right.amax().max(1.0)
            && (&outside - &unknowns).amax() <= 1e-7 * unknowns.amax().max(1.0)
        {
            return Some(map * unknowns + constant);
        }
        unknowns -= &inverse * off;
    }
    None
}

/// The nearest point of the cone `|t| <= mu n`.
fn in_cone(mu: f64, n: f64, t: f64) -> (f64, f64) {
    if t.abs() <= mu * n {
        return (n, t);
    }
    let along = ((n + mu * t.abs()) / (1.0 + mu * mu)).max(0.0);
    (along, (mu * along).copysign(t))
}

#[test]
fn points_are_put_on_the_nearest_edge() {
    assert_eq!(in_cone(0.5, 2.0, 1.0), (2.0, 1.0));
    assert_eq!(in_cone(1.0, 0.0, 2.0), (1.0, 1.0));
    assert_eq!(in_cone(1.0, 0.0, -2.0), (1.0, -1.0));
    assert_eq!(in_cone(0.5, -2.0, 1.0).0, 0.0);
}
