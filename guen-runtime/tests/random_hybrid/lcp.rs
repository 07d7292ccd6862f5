//! Linear complementarity problems by Lemke's pivoting, over dense matrices: shares nothing with the enumeration of the library.

use nalgebra::{DMatrix, DVector};

/// Solves `w = A z + b`, `0 <= w` complementary to `0 <= z`; none where the pivoting ends in a ray.
pub fn lemke(a: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    let n = b.len();
    if b.iter().all(|entry| *entry >= 0.0) {
        return Some(DVector::zeros(n));
    }
    // The columns of w, of z, of the artificial variable, and the right side: `w - A z - 1 s = b`.
    let mut table = DMatrix::zeros(n, 2 * n + 2);
    for i in 0..n {
        table[(i, i)] = 1.0;
        for j in 0..n {
            table[(i, n + j)] = -a[(i, j)];
        }
        table[(i, 2 * n)] = -1.0;
        table[(i, 2 * n + 1)] = b[i];
    }
    let mut basis: Vec<usize> = (0..n).collect();
    let mut row = (0..n).fold(0, |least, i| if b[i] < b[least] { i } else { least });
    let mut entering = 2 * n;
    for _ in 0..60 * n {
        let pivot = table[(row, entering)];
        for j in 0..2 * n + 2 {
            table[(row, j)] /= pivot;
        }
        for i in (0..n).filter(|i| *i != row) {
            let factor = table[(i, entering)];
            for j in 0..2 * n + 2 {
                table[(i, j)] -= factor * table[(row, j)];
            }
        }
        let leaving = core::mem::replace(&mut basis[row], entering);
        if leaving == 2 * n {
            let mut z = DVector::zeros(n);
            for (i, variable) in basis.iter().enumerate() {
                if (n..2 * n).contains(variable) {
                    z[variable - n] = table[(i, 2 * n + 1)];
                }
            }
            return Some(z);
        }
        entering = if leaving < n { leaving + n } else { leaving - n };
        let mut best: Option<(f64, usize)> = None;
        for i in 0..n {
            let entry = table[(i, entering)];
            if entry > 1e-11 {
                let ratio = table[(i, 2 * n + 1)] / entry;
                // Of equal ratios that of the artificial variable, which ends the pivoting.
                let sooner = best.is_none_or(|(least, _)| ratio < least - 1e-13);
                let ends = best.is_some_and(|(least, _)| ratio <= least + 1e-13) && basis[i] == 2 * n;
                if sooner || ends {
                    best = Some((ratio, i));
                }
            }
        }
        (_, row) = best?;
    }
    None
}

/// The part of an element in a problem over rows.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    /// No part.
    None,
    /// A contact that touches: its normal row, at least so much force, and its friction.
    Contact { normal: usize, floor: f64, tangent: Option<Tangent> },
    /// A grip with a limit.
    Grip { row: usize, limit: f64, slips: Option<f64> },
}

/// The friction of a contact in the plane: at rest, or slipping with a sign.
#[derive(Clone, Copy, Debug)]
pub struct Tangent {
    pub row: usize,
    pub friction: f64,
    pub slips: Option<f64>,
}

/// The forces along the rows that satisfy all laws, with `rates = biases + D forces`; none where Lemke's pivoting ends in a ray.
pub fn forces(delassus: &DMatrix<f64>, biases: &DVector<f64>, parts: &[Part]) -> Option<DVector<f64>> {
    let rows = biases.len();
    // Forces are affine in the unknowns `z`: `l = L z + c`. An unknown has a partner `w`: the rate of a row plus unknowns, or unknowns alone.
    let mut count = 0;
    let mut unknown = || {
        count += 1;
        count - 1
    };
    enum Partner {
        Rate(usize, Option<usize>),
        Rest(Vec<(usize, f64)>, f64),
    }
    let mut columns: Vec<(usize, usize, f64)> = Vec::new();
    let mut constant = DVector::zeros(rows);
    let mut partners: Vec<Partner> = Vec::new();
    for part in parts {
        match *part {
            Part::None => {}
            Part::Contact { normal, floor, tangent } => {
                let pressing = unknown();
                columns.push((normal, pressing, 1.0));
                constant[normal] += floor;
                partners.push(Partner::Rate(normal, None));
                match tangent {
                    None => {}
                    Some(Tangent { row, friction, slips: Some(sign) }) => {
                        columns.push((row, pressing, -friction * sign));
                        constant[row] -= friction * sign * floor;
                    }
                    Some(Tangent { row, friction, slips: None }) => {
                        let (right, back) = (unknown(), unknown());
                        columns.push((row, right, 1.0));
                        columns.push((row, pressing, -friction));
                        constant[row] -= friction * floor;
                        partners.push(Partner::Rate(row, Some(back)));
                        let rest = vec![(pressing, 2.0 * friction), (right, -1.0)];
                        partners.push(Partner::Rest(rest, 2.0 * friction * floor));
                    }
                }
            }
            Part::Grip { row, limit, slips: Some(sign) } => constant[row] -= limit * sign,
            Part::Grip { row, limit, slips: None } => {
                let (right, back) = (unknown(), unknown());
                columns.push((row, right, 1.0));
                constant[row] -= limit;
                partners.push(Partner::Rate(row, Some(back)));
                partners.push(Partner::Rest(vec![(right, -1.0)], 2.0 * limit));
            }
        }
    }
    let mut from = DMatrix::zeros(rows, count);
    for (row, unknown, factor) in columns {
        from[(row, unknown)] += factor;
    }
    let (slopes, rates) = (delassus * &from, biases + delassus * &constant);
    let (mut a, mut b) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for (i, partner) in partners.iter().enumerate() {
        match partner {
            Partner::Rate(row, back) => {
                for j in 0..count {
                    a[(i, j)] = slopes[(*row, j)];
                }
                if let Some(back) = back {
                    a[(i, *back)] += 1.0;
                }
                b[i] = rates[*row];
            }
            Partner::Rest(terms, rest) => {
                for (j, factor) in terms {
                    a[(i, *j)] = *factor;
                }
                b[i] = *rest;
            }
        }
    }
    Some(from * lemke(&a, &b)? + constant)
}

#[test]
fn lemke_solves_what_can_be_solved_by_hand() {
    let a = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]);
    let z = lemke(&a, &DVector::from_row_slice(&[-5.0, -6.0])).unwrap();
    assert!((z[0] - 4.0 / 3.0).abs() < 1e-14 && (z[1] - 7.0 / 3.0).abs() < 1e-14);
    // One rises by itself when the other is pushed.
    let z = lemke(&a, &DVector::from_row_slice(&[-5.0, -1.0])).unwrap();
    assert!((z[0] - 2.5).abs() < 1e-14 && z[1] == 0.0);
    // A block on a rough floor: pushed with less than the friction it stays, with more it slips.
    let d = DMatrix::identity(2, 2);
    let block = |push: f64| {
        let tangent = Some(Tangent { row: 1, friction: 0.5, slips: None });
        let parts = [Part::Contact { normal: 0, floor: 0.0, tangent }];
        forces(&d, &DVector::from_row_slice(&[-10.0, push]), &parts).unwrap()
    };
    assert!((block(3.0)[1] + 3.0).abs() < 1e-13 && (block(-7.0)[1] - 5.0).abs() < 1e-13);
}
