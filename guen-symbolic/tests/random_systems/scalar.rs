//! The arithmetic that expressions are evaluated in: plain numbers and dual numbers, which nest.
//!
//! `Dual { re: f, du: g }` stands for `f + g e` with `e^2 = 0`, so that `du` is the derivative along one
//! direction; a dual of duals carries the mixed second derivative along two directions.

/// A commutative algebra over the real numbers with the functions that drawn systems use.
pub trait Scalar: Clone {
    fn constant(value: f64) -> Self;
    /// The real part, which decides on pivots.
    fn value(&self) -> f64;
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn scaled(&self, factor: f64) -> Self;
    fn reciprocal(&self) -> Self;
    fn sine_cosine(&self) -> (Self, Self);

    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.scaled(-1.0))
    }

    fn power(&self, exponent: i32) -> Self {
        let base = if exponent < 0 { self.reciprocal() } else { self.clone() };
        (1..exponent.unsigned_abs()).fold(base.clone(), |power, _| power.times(&base))
    }
}

impl Scalar for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn value(&self) -> f64 {
        *self
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn scaled(&self, factor: f64) -> Self {
        self * factor
    }
    fn reciprocal(&self) -> Self {
        1.0 / self
    }
    fn sine_cosine(&self) -> (Self, Self) {
        self.sin_cos()
    }
}

/// `re + du e` with `e^2 = 0`.
#[derive(Clone, Copy)]
pub struct Dual<R> {
    pub re: R,
    pub du: R,
}

impl<R: Scalar> Scalar for Dual<R> {
    fn constant(value: f64) -> Self {
        Dual { re: R::constant(value), du: R::constant(0.0) }
    }
    fn value(&self) -> f64 {
        self.re.value()
    }
    fn plus(&self, other: &Self) -> Self {
        Dual { re: self.re.plus(&other.re), du: self.du.plus(&other.du) }
    }
    fn times(&self, other: &Self) -> Self {
        Dual { re: self.re.times(&other.re), du: self.re.times(&other.du).plus(&self.du.times(&other.re)) }
    }
    fn scaled(&self, factor: f64) -> Self {
        Dual { re: self.re.scaled(factor), du: self.du.scaled(factor) }
    }
    fn reciprocal(&self) -> Self {
        let re = self.re.reciprocal();
        let du = self.du.times(&re.times(&re)).scaled(-1.0);
        Dual { re, du }
    }
    fn sine_cosine(&self) -> (Self, Self) {
        let (sine, cosine) = self.re.sine_cosine();
        let slopes = (self.du.times(&cosine), self.du.times(&sine).scaled(-1.0));
        (Dual { re: sine, du: slopes.0 }, Dual { re: cosine, du: slopes.1 })
    }
}

/// A number with two directions.
pub type Hyper = Dual<Dual<f64>>;

/// `value` moving along the first direction at the rate `first` and along the second at `second`.
pub fn hyper(value: f64, first: f64, second: f64) -> Hyper {
    Dual { re: Dual { re: value, du: first }, du: Dual { re: second, du: 0.0 } }
}

/// Solves `a x = b` for many columns `b` by elimination with row pivoting; the caller knows that `a` is regular.
pub fn solve<R: Scalar>(mut a: Vec<Vec<R>>, mut b: Vec<Vec<R>>) -> Vec<Vec<R>> {
    let n = a.len();
    for c in 0..n {
        let size = |row: &Vec<R>| row[c].value().abs();
        let best = (c..n).max_by(|i, k| size(&a[*i]).total_cmp(&size(&a[*k]))).expect("a row is left");
        a.swap(c, best);
        b.swap(c, best);
        let pivot = a[c][c].reciprocal();
        for row in [&mut a[c], &mut b[c]] {
            row.iter_mut().for_each(|entry| *entry = entry.times(&pivot));
        }
        let (pivot_a, pivot_b) = (a[c].clone(), b[c].clone());
        for r in (0..n).filter(|r| *r != c) {
            let factor = a[r][c].clone();
            for (row, pivot) in [(&mut a[r], &pivot_a), (&mut b[r], &pivot_b)] {
                for (entry, other) in row.iter_mut().zip(pivot) {
                    *entry = entry.minus(&factor.times(other));
                }
            }
        }
    }
    b
}
