//! Values of the language in numbers: each carries its rate along the motion, which is what `dot` asks for.

use super::analytic::Analytic;
use super::scalar::{Dual, Scalar};

/// A number and its rate. What contains a velocity has no rate: it is no number.
pub type Moving<R> = Dual<R>;
/// Components in the world.
pub type Vector<R> = [Moving<R>; 3];
/// From the body to the world, by rows.
pub type Matrix<R> = [Vector<R>; 3];

/// What an expression stands for.
#[derive(Clone)]
pub enum Value<R> {
    Scalar(Moving<R>),
    Vector(Vector<R>),
    Rotation(Matrix<R>),
    Body(Box<Rigid<R>>),
}

/// A body as far as it was declared.
#[derive(Clone)]
pub struct Rigid<R> {
    pub center: Option<Vector<R>>,
    pub orientation: Option<Matrix<R>>,
}

/// A number without a rate.
pub fn velocity<R: Scalar>(value: R) -> Moving<R> {
    Dual { re: value, du: R::constant(f64::NAN) }
}

pub fn zero<R: Analytic>() -> Moving<R> {
    Moving::constant(0.0)
}

pub fn added<R: Analytic>(a: &Vector<R>, b: &Vector<R>, sign: f64) -> Vector<R> {
    [0, 1, 2].map(|i| a[i].plus(&b[i].scaled(sign)))
}

pub fn stretched<R: Analytic>(v: &Vector<R>, by: &Moving<R>) -> Vector<R> {
    v.each_ref().map(|e| e.times(by))
}

pub fn inner<R: Analytic>(a: &Vector<R>, b: &Vector<R>) -> Moving<R> {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

pub fn cross<R: Analytic>(a: &Vector<R>, b: &Vector<R>) -> Vector<R> {
    [(1, 2), (2, 0), (0, 1)].map(|(i, k)| a[i].times(&b[k]).minus(&a[k].times(&b[i])))
}

pub fn rates<R: Analytic>(v: &Vector<R>) -> Vector<R> {
    v.each_ref().map(|e| velocity(e.du.clone()))
}

pub fn transposed<R: Analytic>(m: &Matrix<R>) -> Matrix<R> {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| m[k][i].clone()))
}

pub fn applied<R: Analytic>(m: &Matrix<R>, v: &Vector<R>) -> Vector<R> {
    m.each_ref().map(|row| inner(row, v))
}

pub fn composed<R: Analytic>(a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    let columns = transposed(b);
    a.each_ref().map(|row| columns.each_ref().map(|column| inner(row, column)))
}

/// Rodrigues' formula: `v cos + (e x v) sin + e (e . v)(1 - cos)`, of each axis of the body.
pub fn turn<R: Analytic>(axis: &Vector<R>, angle: &Moving<R>) -> Option<Matrix<R>> {
    let (sine, cosine) = (angle.function("sin")?, angle.function("cos")?);
    let rest = Moving::constant(1.0).minus(&cosine);
    let columns = [0, 1, 2].map(|k| {
        let unit = [0, 1, 2].map(|i| Moving::constant(if i == k { 1.0 } else { 0.0 }));
        let along = stretched(axis, &rest.times(&axis[k]));
        let across = stretched(&cross(axis, &unit), &sine);
        added(&added(&stretched(&unit, &cosine), &across, 1.0), &along, 1.0)
    });
    Some(transposed(&columns))
}

/// `q v q*` of each axis, by two products of quaternions.
pub fn quaternion<R: Analytic>(q: &[Moving<R>; 4]) -> Matrix<R> {
    let product = |a: &[Moving<R>; 4], b: &[Moving<R>; 4]| {
        let (u, v) = ([1, 2, 3].map(|i| a[i].clone()), [1, 2, 3].map(|i| b[i].clone()));
        let scalar = a[0].times(&b[0]).minus(&inner(&u, &v));
        let straight = added(&stretched(&v, &a[0]), &stretched(&u, &b[0]), 1.0);
        let [x, y, z] = added(&straight, &cross(&u, &v), 1.0);
        [scalar, x, y, z]
    };
    let conjugate = [q[0].clone(), q[1].scaled(-1.0), q[2].scaled(-1.0), q[3].scaled(-1.0)];
    let columns = [1, 2, 3].map(|k| {
        let unit = [0, 1, 2, 3].map(|i| Moving::constant(if i == k { 1.0 } else { 0.0 }));
        let [_, x, y, z] = product(&product(q, &unit), &conjugate);
        [x, y, z]
    });
    transposed(&columns)
}

/// The axial vector of `R' R^T`, in the world's axes. On `|q| = 1` it is `2 q' q*`.
pub fn spin<R: Analytic>(m: &Matrix<R>) -> Vector<R> {
    let rate = m.each_ref().map(|row| row.each_ref().map(|e| Dual::constant_like(&e.du)));
    let still = m.each_ref().map(|row| row.each_ref().map(|e| Dual::constant_like(&e.re)));
    let turning = composed(&rate, &transposed(&still));
    [(2, 1), (0, 2), (1, 0)].map(|(i, k)| velocity(turning[i][k].re.minus(&turning[k][i].re).scaled(0.5)))
}

impl<R: Analytic> Dual<R> {
    /// At rest.
    fn constant_like(value: &R) -> Self {
        Dual { re: value.clone(), du: R::constant(0.0) }
    }
}

impl<R: Analytic> Rigid<R> {
    /// `v_c + omega x (p - c)`, of the material point that is at `p`.
    pub fn velocity_at(&self, p: &Vector<R>) -> Option<Vector<R>> {
        let center = self.center.as_ref()?;
        let arm = added(p, center, -1.0);
        let turning = cross(&spin(self.orientation.as_ref()?), &arm);
        Some(added(&rates(center), &turning, 1.0))
    }
}
