//! Truncated Taylor series in several variables: all derivatives up to an order at once.
//!
//! Iterated brackets need as many derivatives as there are brackets; duals nested that deep would cost
//! `2^order` per direction, a jet carries each mixed derivative once.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::scalar::Scalar;

/// The monomials of a jet, by degree.
pub struct Shape {
    order: usize,
    monomials: Vec<Vec<u8>>,
    positions: BTreeMap<Vec<u8>, usize>,
    /// `(i, j, k)`: monomial `i` times monomial `j` is monomial `k`.
    products: Vec<(usize, usize, usize)>,
}

impl Shape {
    pub fn new(variables: usize, order: usize) -> Rc<Self> {
        let mut monomials = vec![vec![0; variables]];
        let mut start = 0;
        for _ in 0..order {
            let end = monomials.len();
            for k in start..end {
                // Each monomial once: raise only at or after its last variable.
                let last = monomials[k].iter().rposition(|e| *e > 0).unwrap_or(0);
                for v in last..variables {
                    let mut next: Vec<u8> = monomials[k].clone();
                    next[v] += 1;
                    monomials.push(next);
                }
            }
            start = end;
        }
        let positions: BTreeMap<Vec<u8>, usize> =
            monomials.iter().enumerate().map(|(k, m)| (m.clone(), k)).collect();
        let degrees: Vec<usize> = monomials.iter().map(|m| m.iter().map(|e| usize::from(*e)).sum()).collect();
        let mut products = Vec::new();
        for (i, a) in monomials.iter().enumerate() {
            // Monomials stand by degree, so that those of a small enough one come first.
            let partners = degrees.iter().take_while(|d| **d + degrees[i] <= order).count();
            for (j, b) in monomials[..partners].iter().enumerate() {
                let sum: Vec<u8> = a.iter().zip(b).map(|(a, b)| a + b).collect();
                products.push((i, j, positions[&sum]));
            }
        }
        Rc::new(Shape { order, monomials, positions, products })
    }
}

/// A Taylor polynomial; without a shape a constant.
#[derive(Clone)]
pub struct Jet {
    coefficients: Vec<f64>,
    shape: Option<Rc<Shape>>,
}

impl Jet {
    /// The variable of an index at a value.
    pub fn variable(shape: &Rc<Shape>, index: usize, value: f64) -> Self {
        let mut coefficients = vec![0.0; shape.monomials.len()];
        coefficients[0] = value;
        let unit: Vec<u8> = (0..shape.monomials[0].len()).map(|v| u8::from(v == index)).collect();
        if let Some(k) = shape.positions.get(&unit) {
            coefficients[*k] = 1.0;
        }
        Jet { coefficients, shape: Some(Rc::clone(shape)) }
    }

    /// The partial derivative by a variable; right up to one order less.
    pub fn partial(&self, index: usize) -> Self {
        let Some(shape) = &self.shape else { return Jet::constant(0.0) };
        let mut coefficients = vec![0.0; shape.monomials.len()];
        for (monomial, c) in shape.monomials.iter().zip(&self.coefficients).filter(|(m, _)| m[index] > 0) {
            let mut lower = monomial.clone();
            lower[index] -= 1;
            coefficients[shape.positions[&lower]] = c * f64::from(monomial[index]);
        }
        Jet { coefficients, shape: Some(Rc::clone(shape)) }
    }

    /// `sum derivatives[k]/k! h^k` with `h` the part without constant.
    fn compose(&self, derivative: impl Fn(usize) -> f64) -> Self {
        let Some(shape) = &self.shape else { return Jet::constant(derivative(0)) };
        let mut rest = self.clone();
        rest.coefficients[0] = 0.0;
        let mut sum = Jet::constant(derivative(0));
        let mut power = Jet::constant(1.0);
        let mut factorial = 1.0;
        for k in 1..=shape.order {
            factorial *= k as f64;
            power = power.times(&rest);
            sum = sum.plus(&power.scaled(derivative(k) / factorial));
        }
        sum
    }
}

impl Scalar for Jet {
    fn constant(value: f64) -> Self {
        Jet { coefficients: vec![value], shape: None }
    }
    fn value(&self) -> f64 {
        self.coefficients[0]
    }
    fn plus(&self, other: &Self) -> Self {
        let (long, short) =
            if self.coefficients.len() < other.coefficients.len() { (other, self) } else { (self, other) };
        let mut sum = long.clone();
        for (a, b) in sum.coefficients.iter_mut().zip(&short.coefficients) {
            *a += b;
        }
        sum
    }
    fn times(&self, other: &Self) -> Self {
        let shape = match (&self.shape, &other.shape) {
            (None, _) => return other.scaled(self.coefficients[0]),
            (_, None) => return self.scaled(other.coefficients[0]),
            (Some(shape), _) => shape,
        };
        let mut coefficients = vec![0.0; self.coefficients.len()];
        for &(i, j, k) in &shape.products {
            coefficients[k] += self.coefficients[i] * other.coefficients[j];
        }
        Jet { coefficients, shape: Some(Rc::clone(shape)) }
    }
    fn scaled(&self, factor: f64) -> Self {
        Jet {
            coefficients: self.coefficients.iter().map(|c| c * factor).collect(),
            shape: self.shape.clone(),
        }
    }
    fn reciprocal(&self) -> Self {
        let x = self.coefficients[0];
        // d^k (1/x) = (-1)^k k!/x^(k+1)
        self.compose(|k| (1..=k).fold(1.0 / x, |d, j| -d * j as f64 / x))
    }
    fn sine_cosine(&self) -> (Self, Self) {
        let (s, c) = self.coefficients[0].sin_cos();
        let turns = [s, c, -s, -c];
        (self.compose(|k| turns[k % 4]), self.compose(|k| turns[(k + 1) % 4]))
    }
}
