//! The operators and their brackets against vector fields whose derivatives come from dual numbers.

use nalgebra::DMatrix;

use crate::declared::{Declared, lift};
use crate::derived::Derived;
use crate::tape::Tape;

/// The derived `C_ijt` at a state.
pub struct Coefficients {
    n: usize,
    values: Vec<f64>,
}

impl Coefficients {
    /// The values of [`coefficients`] at a state.
    pub fn new(tape: &Tape, n: usize, point: &[f64]) -> Self {
        Coefficients { n, values: tape.at(point) }
    }

    /// `C_ijt` with the paper's indices: `i, j` from 0, `t` from 1.
    pub fn at(&self, i: usize, j: usize, t: usize) -> f64 {
        self.values[((i * (self.n + 1)) + j) * self.n + t - 1]
    }
}

/// All derived `C_ijt`, `i` the slowest index.
pub fn coefficients(derived: &mut Derived, n: usize) -> Tape {
    let mut roots = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            for t in 1..=n {
                let brackets = &mut derived.derivation.frame.brackets;
                roots.push(brackets.coefficient(&mut derived.bench, i, j, t));
            }
        }
    }
    derived.tape(&roots)
}

/// Differences in units of what rounding allows.
pub struct Differences {
    pub operators: f64,
    pub commutators: f64,
    pub jacobi: f64,
}

/// Compares operators and commutators, and looks at Jacobi's identity.
pub fn compare(
    derived: &Derived,
    tape: &Tape,
    declared: &Declared,
    point: &[f64],
) -> (Coefficients, Differences) {
    let n = declared.n;
    let c = Coefficients::new(tape, n, point);
    let fields = declared.fields_at(point);
    let forms = declared.forms_at(point);
    let matrix = DMatrix::from_fn(n, n, |j, i| forms[j][i]);
    let singular = matrix.svd(false, false).singular_values;
    // A coefficient holds the inverse twice.
    let condition = (singular.max() / singular.min()).powi(2);
    let mut differences = Differences { operators: 0.0, commutators: 0.0, jacobi: 0.0 };
    let grow = |worst: &mut f64, difference: f64, size: f64| {
        let ratio = difference.abs() / (condition * size.max(1.0));
        // NaN is worse than anything.
        if ratio.is_nan() || ratio > *worst {
            *worst = ratio;
        }
    };

    let flat: Vec<_> = derived.derivation.frame.operators.xi.iter().flatten().copied().collect();
    for (k, value) in derived.tape(&flat).at(point).into_iter().enumerate() {
        let reference = fields[k / n][k % n + 1];
        grow(&mut differences.operators, value - reference, reference.abs());
    }

    // X_i applied to the components of all fields, and to all derived coefficients.
    let rates: Vec<Vec<f64>> = fields.iter().map(|field| declared.along_field(point, field)).collect();
    let moving: Vec<_> = rates.iter().map(|rates| declared.fields_at(&lift(point, |k| rates[k]))).collect();
    let slopes: Vec<Vec<f64>> = rates
        .iter()
        .map(|rates| tape.at(&lift(point, |k| rates[k])).iter().map(|d| d.du).collect())
        .collect();
    let slope = |i: usize, j: usize, k: usize, s: usize| slopes[i][((j * (n + 1)) + k) * n + s - 1];
    let largest = moving.iter().flatten().flatten().map(|d| d.du.abs()).fold(1.0, f64::max);
    for (i, by_i) in moving.iter().enumerate() {
        for (j, by_j) in moving.iter().enumerate() {
            for t in 1..=n {
                // C_ijt = eta_t on X_i X_j - X_j X_i
                let reference: f64 =
                    (1..=n).map(|k| forms[t - 1][k - 1] * (by_i[j][k].du - by_j[i][k].du)).sum();
                grow(&mut differences.commutators, c.at(i, j, t) - reference, largest);
                grow(&mut differences.commutators, c.at(i, j, t) + c.at(j, i, t), largest);
            }
            for k in 0..j.min(i) {
                for s in 1..=n {
                    let mut sum = 0.0;
                    let mut size = 0.0;
                    for (a, b, d) in [(i, j, k), (j, k, i), (k, i, j)] {
                        let products = (1..=n).map(|t| c.at(b, d, t) * c.at(a, t, s));
                        for term in products.chain([slope(a, b, d, s)]) {
                            sum += term;
                            size += term.abs();
                        }
                    }
                    grow(&mut differences.jacobi, sum, size);
                }
            }
        }
    }
    (c, differences)
}
