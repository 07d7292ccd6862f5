//! Combinations of the parameters, modulo the prime: for each parameter an entry, then one for what is there without them.

use crate::motion::Mechanics;
use crate::numbering::Numbering;
use crate::workbench::Workbench;
use crate::zero::field;

/// Adds a multiple of a combination.
pub(in crate::motion) fn add_scaled(sum: &mut [u64], factor: u64, column: &[u64]) {
    if factor == 0 {
        return;
    }
    for (entry, own) in sum.iter_mut().zip(column) {
        *entry = field::add(*entry, field::mul(factor, *own));
    }
}

/// `x' = xi_0 + sum_s eta_s xi_s` at the point: for each coordinate the entries `s = 1..l`, then that of `xi_0`.
pub(in crate::motion) fn rates_of_coordinates(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    system: &Mechanics,
) -> Option<Vec<Vec<u64>>> {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    // A x' = eta - a_0, with a column for each of the first l etas and for -a_0.
    let mut rows: Vec<Vec<u64>> = Vec::new();
    for (j, form) in system.forms.forms.iter().enumerate() {
        let mut row: Vec<u64> = Vec::with_capacity(n + l + 1);
        for a in &form.row {
            row.push(numbers.at_point(bench, *a)?);
        }
        row.extend((0..l).map(|s| u64::from(s == j)));
        row.push(field::neg(numbers.at_point(bench, form.offset)?));
        rows.push(row);
    }
    for i in 0..n {
        let pivot = (i..n).find(|r| rows[*r][i] != 0)?;
        rows.swap(i, pivot);
        let inverse = field::inverse(rows[i][i])?;
        for entry in rows[i].iter_mut().skip(i) {
            *entry = field::mul(*entry, inverse);
        }
        let reduced = rows[i].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            if r != i && row[i] != 0 {
                let factor = field::neg(row[i]);
                add_scaled(&mut row[i..], factor, &reduced[i..]);
            }
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}
