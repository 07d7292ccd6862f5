//! A step of DOP853: from a state and its slope to the next state, two estimates of the error, and the polynomial
//! between, without any decision about them.

use crate::numbers::decimal::reals;
use crate::numbers::real::Real;
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::run::Checkpoint;
use crate::steppers::explicit::adaptive::Attempt;
use crate::steppers::explicit::dop853_coefficients as published;
use crate::steppers::scaled;
use crate::steppers::{ahead, arrived, is_long, leading, moved, shifted, weighted};
use crate::system::System;

/// The coefficients of the method in the real `R`, converted once.
///
/// In `f64` they are the published decimals, correctly rounded; longer reals get all of the 30 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau<R = f64> {
    c: [R; 11],
    a2: [R; 1],
    a3: [R; 2],
    a4: [R; 2],
    a5: [R; 3],
    a6: [R; 3],
    a7: [R; 4],
    a8: [R; 5],
    a9: [R; 6],
    a10: [R; 7],
    a11: [R; 8],
    a12: [R; 9],
    b: [R; 8],
    e5: [R; 8],
    e3: [R; 8],
    c_dense: [R; 3],
    a14: [R; 8],
    a15: [R; 8],
    a16: [R; 8],
    d: [[R; 12]; 4],
}

/// A step on trial: the new state, and how far formulas of lower order are from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial<R, const N: usize> {
    /// The state at the end of the step, of order eight.
    pub state: [R; N],
    /// The mean slope of the step less that of the formula of order five: `O(h^5)`.
    pub error5: [R; N],
    /// The mean slope of the step less that of the formula of order three: `O(h^3)`.
    pub error3: [R; N],
}

/// The slopes of stages 1 and 6 to 12, which weights and interpolant are made of.
pub(crate) type Stages<R, const N: usize> = [[R; N]; 8];

/// A step with what it was made of. The guess of its end is the argument of the last stage, which is there too and known one slope
/// earlier; the errors are those of order five and three.
pub(in crate::steppers) type Made<R, const N: usize> = Attempt<R, Stages<R, N>, [[R; N]; 2], N>;

/// Room for a step.
#[inline]
pub(in crate::steppers) fn blank<R: Real, const N: usize>() -> Made<R, N> {
    let none = [R::zero(); N];
    Made { state: none, guess: none, stages: [none; 8], errors: [none; 2], end: None }
}

impl<R: Real> Tableau<R> {
    /// Converts the published decimals.
    pub fn new() -> Self {
        let b: [R; 8] = reals(&published::B);
        let [first, ninth, last]: [R; 3] = reals(&published::B3);
        let e3 = [b[0] - first, b[1], b[2], b[3], b[4] - ninth, b[5], b[6], b[7] - last];
        Self {
            c: reals(&published::C),
            a2: reals(&published::A2),
            a3: reals(&published::A3),
            a4: reals(&published::A4),
            a5: reals(&published::A5),
            a6: reals(&published::A6),
            a7: reals(&published::A7),
            a8: reals(&published::A8),
            a9: reals(&published::A9),
            a10: reals(&published::A10),
            a11: reals(&published::A11),
            a12: reals(&published::A12),
            b,
            e5: reals(&published::E5),
            e3,
            c_dense: reals(&published::C_DENSE),
            a14: reals(&published::A14),
            a15: reals(&published::A15),
            a16: reals(&published::A16),
            d: [reals(&published::D4), reals(&published::D5), reals(&published::D6), reals(&published::D7)],
        }
    }

    /// The nodes of stages 2 to 12.
    pub(crate) fn nodes(&self) -> &[R; 11] {
        &self.c
    }

    /// The weights of stages 2 to 12, then those of the step: of the slopes that have some.
    pub(crate) fn rows(&self) -> [&[R]; 12] {
        let Self { a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, b, .. } = self;
        [a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, b]
    }

    /// The weights of the errors of order five and three: of stages 1 and 6 to 12.
    pub(crate) fn error_weights(&self) -> [&[R; 8]; 2] {
        [&self.e5, &self.e3]
    }

    /// The nodes of the three further stages of dense output.
    pub(crate) fn dense_nodes(&self) -> &[R; 3] {
        &self.c_dense
    }

    /// The weights of these stages: of the slopes that have some.
    pub(crate) fn dense_rows(&self) -> [&[R; 8]; 3] {
        [&self.a14, &self.a15, &self.a16]
    }

    /// The weights of the further terms of the polynomial: of stages 1 and 6 to 16, of which stage 13 is the slope at the end.
    pub(crate) fn dense_terms(&self) -> &[[R; 12]; 4] {
        &self.d
    }

    /// Makes one step on trial from the state `x` at `t`, where the slope is `k1 = f(t, x)`.
    ///
    /// ```text
    /// k_i = f(t + c_i h, x + h sum_j a_ij k_j)      i = 2 .. 12, j < i
    /// x(t + h) = x + h sum_i b_i k_i + O(h^9)
    /// ```
    ///
    /// `h` may be negative. Nothing is checked. Eleven evaluations, about `150 N` further operations, no
    /// allocation. The slope at the end, if the step is accepted, is `k1` of the next step.
    ///
    /// ```
    /// use guen_runtime::{System, from_fn, steppers::dop853::Tableau};
    ///
    /// let growth = from_fn(|_t: f64, &[x]: &[f64; 1]| [x]);
    /// let trial = Tableau::new().trial(&growth, 0.0, &[1.0], &growth.rhs(0.0, &[1.0]), 0.25);
    /// assert!((trial.state[0] - 0.25_f64.exp()).abs() < 1e-11);
    /// assert!(trial.error5[0].abs() < 1e-6 && trial.error3[0].abs() < 1e-3);
    /// ```
    #[inline]
    pub fn trial<S, const N: usize>(&self, system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> Trial<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        let mut made = blank();
        self.late(system, t, x, k1, h, &mut made);
        let Made { state, errors: [error5, error3], .. } = made;
        Trial { state, error5, error3 }
    }

    /// A step of [`Dop853`](crate::steppers::Dop853): [`stepped`](Self::stepped) as a function of its own, with `EARLY`.
    #[inline]
    pub(in crate::steppers) fn step<S, const N: usize>(
        &self,
        system: &S,
        t: R,
        x: &[R; N],
        k1: &[R; N],
        h: R,
        made: &mut Made<R, N>,
    ) where
        S: System<R, N> + ?Sized,
    {
        self.stepped::<true, S, N>(system, t, x, k1, h, made);
    }

    /// [`stepped`](Self::stepped) as a function of its own, without `EARLY`.
    // Inlined into the loop over the steps, RK8 took 1.8 times as long on the hoop in a default build.
    #[inline]
    pub(in crate::steppers) fn late<S, const N: usize>(
        &self,
        system: &S,
        t: R,
        x: &[R; N],
        k1: &[R; N],
        h: R,
        made: &mut Made<R, N>,
    ) where
        S: System<R, N> + ?Sized,
    {
        R::vectorize(
            #[inline(always)]
            || self.stepped::<false, S, N>(system, t, x, k1, h, made),
        );
    }

    /// The coefficients in another real that has those of this one.
    pub(in crate::steppers) fn over<T: Real>(&self, number: impl Fn(R) -> T) -> Tableau<T> {
        let number = &number;
        Tableau {
            c: self.c.map(number),
            a2: self.a2.map(number),
            a3: self.a3.map(number),
            a4: self.a4.map(number),
            a5: self.a5.map(number),
            a6: self.a6.map(number),
            a7: self.a7.map(number),
            a8: self.a8.map(number),
            a9: self.a9.map(number),
            a10: self.a10.map(number),
            a11: self.a11.map(number),
            a12: self.a12.map(number),
            b: self.b.map(number),
            e5: self.e5.map(number),
            e3: self.e3.map(number),
            c_dense: self.c_dense.map(number),
            a14: self.a14.map(number),
            a15: self.a15.map(number),
            a16: self.a16.map(number),
            d: self.d.map(|d| d.map(number)),
        }
    }

    /// A step with its stages, by eleven evaluations.
    ///
    /// Everything but the term of the slope computed last is summed up before that slope is asked for: the processor does it
    /// while it waits, and no slope is read in registers longer than those it was just written from, which stalls it. The
    /// same holds for the new state and for both errors.
    /// With `EARLY` the state and the step are in that sum too, so that a stage waits for one product and one sum in place of
    /// two of each: `(x + h sum_j a_j k_j) + (h a) k` and not `x + h (sum_j a_j k_j + a k)`. The product `h a` is rounded,
    /// with a fixed step always to the same side, which compensated sums would show. Without `EARLY` the two of each are
    /// [`moved`]: inside of [`Real::vectorize`], please.
    #[inline(always)]
    pub(in crate::steppers) fn stepped<const EARLY: bool, S, const N: usize>(
        &self,
        system: &S,
        t: R,
        x: &[R; N],
        k1: &[R; N],
        h: R,
        made: &mut Made<R, N>,
    ) where
        S: System<R, N> + ?Sized,
    {
        if const { is_long::<N>() } {
            return self.stepped_in_place::<EARLY, S, N>(system, t, x, k1, h, made);
        }
        let c = &self.c;
        let at2 = shifted(x, h, &weighted(&self.a2, [k1]));
        let near3 = ahead::<EARLY, _, _, _>(x, h, &self.a3, [k1]);
        let k2 = system.rhs(t + c[0] * h, &at2);
        let at3 = arrived::<EARLY, _, _>(x, h, &near3, self.a3[1], &k2);
        let near4 = ahead::<EARLY, _, _, _>(x, h, &self.a4, [k1]);
        let k3 = system.rhs(t + c[1] * h, &at3);
        let at4 = arrived::<EARLY, _, _>(x, h, &near4, self.a4[1], &k3);
        let near5 = ahead::<EARLY, _, _, _>(x, h, &self.a5, [k1, &k3]);
        let k4 = system.rhs(t + c[2] * h, &at4);
        let at5 = arrived::<EARLY, _, _>(x, h, &near5, self.a5[2], &k4);
        let near6 = ahead::<EARLY, _, _, _>(x, h, &self.a6, [k1, &k4]);
        let k5 = system.rhs(t + c[3] * h, &at5);
        let at6 = arrived::<EARLY, _, _>(x, h, &near6, self.a6[2], &k5);
        let near7 = ahead::<EARLY, _, _, _>(x, h, &self.a7, [k1, &k4, &k5]);
        let head8 = head::<EARLY, _, _, _>(x, h, &self.a8, [k1, &k4, &k5]);
        let k6 = system.rhs(t + c[4] * h, &at6);
        let at7 = arrived::<EARLY, _, _>(x, h, &near7, self.a7[3], &k6);
        let near8 = further::<EARLY, _, _>(h, &head8, self.a8[3], &k6);
        let head9 = head::<EARLY, _, _, _>(x, h, &self.a9, [k1, &k4, &k5, &k6]);
        let k7 = system.rhs(t + c[5] * h, &at7);
        let at8 = arrived::<EARLY, _, _>(x, h, &near8, self.a8[4], &k7);
        let near9 = further::<EARLY, _, _>(h, &head9, self.a9[4], &k7);
        let head10 = head::<EARLY, _, _, _>(x, h, &self.a10, [k1, &k4, &k5, &k6, &k7]);
        let k8 = system.rhs(t + c[6] * h, &at8);
        let at9 = arrived::<EARLY, _, _>(x, h, &near9, self.a9[5], &k8);
        let near10 = further::<EARLY, _, _>(h, &head10, self.a10[5], &k8);
        let head11 = head::<EARLY, _, _, _>(x, h, &self.a11, [k1, &k4, &k5, &k6, &k7, &k8]);
        let k9 = system.rhs(t + c[7] * h, &at9);
        let at10 = arrived::<EARLY, _, _>(x, h, &near10, self.a10[6], &k9);
        let near11 = further::<EARLY, _, _>(h, &head11, self.a11[6], &k9);
        let head12 = head::<EARLY, _, _, _>(x, h, &self.a12, [k1, &k4, &k5, &k6, &k7, &k8, &k9]);
        let k10 = system.rhs(t + c[8] * h, &at10);
        let at11 = arrived::<EARLY, _, _>(x, h, &near11, self.a11[7], &k10);
        let near12 = further::<EARLY, _, _>(h, &head12, self.a12[7], &k10);
        let heads = self.heads::<EARLY, _>(x, h, [k1, &k6, &k7, &k8, &k9, &k10]);
        let k11 = system.rhs(t + c[9] * h, &at11);
        let at12 = arrived::<EARLY, _, _>(x, h, &near12, self.a12[8], &k11);
        let near = further::<EARLY, _, _>(h, &heads[0], self.b[6], &k11);
        let five = shifted(&heads[1], self.e5[6], &k11);
        let three = shifted(&heads[2], self.e3[6], &k11);
        let k12 = system.rhs(t + c[10] * h, &at12);
        let state = arrived::<EARLY, _, _>(x, h, &near, self.b[7], &k12);
        let errors = [shifted(&five, self.e5[7], &k12), shifted(&three, self.e3[7], &k12)];
        *made = Made { state, guess: at12, stages: [*k1, k6, k7, k8, k9, k10, k11, k12], errors, end: None };
    }

    /// Returns the parts of the new state and of both errors that are known two slopes before the end.
    #[inline(always)]
    fn heads<const EARLY: bool, const N: usize>(
        &self,
        x: &[R; N],
        h: R,
        slopes: [&[R; N]; 6],
    ) -> [[R; N]; 3] {
        if EARLY { self.heads_apart(x, h, slopes) } else { self.three_sums(slopes) }
    }

    #[inline(never)]
    fn heads_apart<const N: usize>(&self, x: &[R; N], h: R, slopes: [&[R; N]; 6]) -> [[R; N]; 3] {
        let [state, five, three] = self.three_sums(slopes);
        [shifted(x, h, &state), five, three]
    }

    #[inline(always)]
    fn three_sums<const N: usize>(&self, slopes: [&[R; N]; 6]) -> [[R; N]; 3] {
        [leading(&self.b, slopes), leading(&self.e5, slopes), leading(&self.e3, slopes)]
    }

    /// The mean slope of order eight.
    #[inline(always)]
    pub(in crate::steppers) fn slope<const N: usize>(&self, stages: &Stages<R, N>) -> [R; N] {
        weighted(&self.b, stages.each_ref())
    }

    /// The mean slope less those of the formulas of order five and three.
    #[inline(always)]
    pub(in crate::steppers) fn errors<const N: usize>(&self, stages: &Stages<R, N>) -> [[R; N]; 2] {
        [weighted(&self.e5, stages.each_ref()), weighted(&self.e3, stages.each_ref())]
    }

    /// The interpolant of order seven over the step from `from` to `to` with these stages, and the slope `end` at its
    /// end: three evaluations.
    ///
    /// ```text
    /// r4 .. r7 = h sum_i d_i k_i      i = 1, 6 .. 16
    /// ```
    pub(in crate::steppers) fn dense<S, const N: usize>(
        &self,
        system: &S,
        stages: &Stages<R, N>,
        from: &Checkpoint<R, N>,
        to: &Checkpoint<R, N>,
        end: &[R; N],
        h: R,
    ) -> Dense<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        let at = |i: usize, slope: [R; N]| {
            system.rhs(from.time + self.c_dense[i] * h, &shifted(&from.state, h, &slope))
        };
        let [k1, k6, k7, k8, k9, k10, k11, k12] = stages;
        let k14 = at(0, weighted(&self.a14, [k1, k7, k8, k9, k10, k11, k12, end]));
        let k15 = at(1, weighted(&self.a15, [k1, k6, k7, k8, k11, k12, end, &k14]));
        let k16 = at(2, weighted(&self.a16, [k1, k6, k7, k8, k9, end, &k14, &k15]));
        let mut dense = Dense::hermite(from.time, h, &from.state, k1, &to.state, end);
        let slopes = [k1, k6, k7, k8, k9, k10, k11, k12, end, &k14, &k15, &k16];
        dense.add_terms::<4>(|j| scaled(h, &weighted(&self.d[j], slopes)));
        dense
    }
}

impl<R: Real> Default for Tableau<R> {
    fn default() -> Self {
        Self::new()
    }
}

/// The part of a stage's argument that is known two slopes before it, with `EARLY` from a function of its own: there the
/// compiler takes the longest registers, and what it computes is done before the processor begins with the slope that comes
/// next, in whose middle the compiler would put it otherwise.
#[inline(always)]
fn head<const EARLY: bool, R: Real, const N: usize, const M: usize>(
    x: &[R; N],
    h: R,
    weights: &[R],
    slopes: [&[R; N]; M],
) -> [R; N] {
    if EARLY { head_apart(x, h, weights, slopes) } else { leading(weights, slopes) }
}

#[inline(never)]
fn head_apart<R: Real, const N: usize, const M: usize>(
    x: &[R; N],
    h: R,
    weights: &[R],
    slopes: [&[R; N]; M],
) -> [R; N] {
    shifted(x, h, &leading(weights, slopes))
}

/// Adds one slope to the sums.
#[inline(always)]
fn further<const EARLY: bool, R: Real, const N: usize>(
    h: R,
    head: &[R; N],
    weight: R,
    slope: &[R; N],
) -> [R; N] {
    if EARLY { shifted(head, h * weight, slope) } else { moved(head, weight, slope) }
}
