//! The Lie closure of `X_0..X_l` in numbers: brackets of Taylor jets of the fields, ranks by singular values.

use std::collections::BTreeMap;
use std::rc::Rc;

use nalgebra::DMatrix;

use crate::declared::Declared;
use crate::jet::{Jet, Shape};
use crate::scalar::Scalar;

/// Unit vectors whose smallest singular value is below this count as dependent.
const DEPENDENT: f64 = 1e-7;

/// The shapes of jets, each made once.
#[derive(Default)]
pub struct Shapes(BTreeMap<(usize, usize), Rc<Shape>>);

/// The closure at one state.
pub struct Closure {
    /// Ranks less one of `D_1`, `D_2`, ..., until they stay.
    pub growth: Vec<usize>,
    /// Unit vectors over `t, x_1..x_n` that span it.
    pub basis: Vec<Vec<f64>>,
}

impl Closure {
    pub fn new(shapes: &mut Shapes, declared: &Declared, point: &[f64]) -> Self {
        let (n, l) = (declared.n, declared.degrees);
        // Each bracket costs an order, and at most n - l of them can add to the rank.
        let order = n - l;
        let shape = shapes.0.entry((n + 1, order)).or_insert_with(|| Shape::new(n + 1, order));
        let mut jets: Vec<Jet> = point.iter().map(|value| Jet::constant(*value)).collect();
        for (index, place) in [declared.time].iter().chain(&declared.x).enumerate() {
            jets[*place] = Jet::variable(shape, index, point[*place]);
        }
        let mut generators = declared.fields_at(&jets);
        generators.truncate(l + 1);
        let mut basis: Vec<Vec<f64>> = generators.iter().map(|field| unit(field).expect("fields")).collect();
        let mut growth = vec![l];
        let mut level = generators.clone();
        while basis.len() <= n && growth.len() <= order {
            let mut fresh = Vec::new();
            for field in &level {
                for generator in &generators {
                    let bracket = bracket(generator, field);
                    let Some(direction) = unit(&bracket) else { continue };
                    basis.push(direction);
                    if independent(&basis) {
                        fresh.push(bracket);
                    } else {
                        basis.pop();
                    }
                }
            }
            if fresh.is_empty() {
                break;
            }
            growth.push(basis.len() - 1);
            level = fresh;
        }
        Closure { growth, basis }
    }

    /// The number `n - r` of integrable combinations of constraints.
    pub fn integrable(&self, n: usize) -> usize {
        n + 1 - self.basis.len()
    }

    /// Whether a form `a_1..a_n, a_0` annihilates the closure.
    pub fn annihilates(&self, form: &[f64]) -> bool {
        let n = form.len() - 1;
        let size = form.iter().map(|a| a.abs()).fold(1e-30, f64::max);
        self.basis.iter().all(|y| {
            let value = form[n] * y[0] + form[..n].iter().zip(&y[1..]).map(|(a, y)| a * y).sum::<f64>();
            value.abs() < DEPENDENT * size
        })
    }
}

/// `X Y - Y X`, a component for each variable.
fn bracket(x: &[Jet], y: &[Jet]) -> Vec<Jet> {
    let along = |field: &[Jet], f: &Jet| {
        field
            .iter()
            .enumerate()
            .map(|(p, component)| component.times(&f.partial(p)))
            .fold(Jet::constant(0.0), |sum, term| sum.plus(&term))
    };
    x.iter().zip(y).map(|(x_k, y_k)| along(x, y_k).minus(&along(y, x_k))).collect()
}

/// The field's direction, `None` where it vanishes up to rounding.
fn unit(field: &[Jet]) -> Option<Vec<f64>> {
    let length = field.iter().map(|c| c.value().powi(2)).sum::<f64>().sqrt();
    (length > 1e-9).then(|| field.iter().map(|c| c.value() / length).collect())
}

fn independent(vectors: &[Vec<f64>]) -> bool {
    let (rows, columns) = (vectors.len(), vectors[0].len());
    rows <= columns
        && DMatrix::from_fn(rows, columns, |i, k| vectors[i][k]).svd(false, false).singular_values.min()
            > DEPENDENT
}
