//! Sine and cosine together.
//!
//! ```text
//! x = n pi/2 + r,  |r| <= pi/4 (1 + 2^-20)
//! n mod 4:   0              1               2                3
//!            ( sin r, cos r) (cos r, -sin r) (-sin r, -cos r) (-cos r, sin r)
//! ```
//!
//! The reduction is W. J. Cody's and W. Waite's (Software Manual for the Elementary Functions, 1980): `pi/2` is split
//! into parts so short that their products with `n` are exact. The polynomials of the accurate version have the
//! coefficients of fdlibm (Sun Microsystems 1993, `k_sin.c` and `k_cos.c`: relative errors of `2^-58`); those of the
//! shorter versions come from a Remez exchange on `[0, pi/4 (1 + 2^-20)]`, and are minimax in the absolute error.

use crate::numbers::elementary::argument_reduction::remainder;
use crate::numbers::lanes::register::{Register, Vector};

/// The largest magnitude of an argument that the straight line serves: `2^18`.
///
/// `n` has 18 bits there. Products are exact up to 20 bits, but then two numbers next to a multiple of `pi/2`, near
/// 4.13e5 and 8.27e5, would be in error by 1.06 ulp: the third part of `pi/2` is too short for them.
const RANGE: f64 = 262_144.0;

/// `2^52 + 2^51`: adding it to a number below `2^51` rounds that to an integer, and leaves the integer in the low
/// bits of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// `pi/2` in parts: twice 33 bits, then the rest to 53 bits; and after the first one, the rest at once.
const FIRST: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
const SECOND: f64 = f64::from_bits(0x3dd0_b461_1a60_0000);
const THIRD: f64 = f64::from_bits(0x3ba3_198a_2e03_7073);
const REST: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);

/// `sin r / r = 1 + sum S_k r^2k`
#[allow(clippy::excessive_precision, reason = "the digits that were published")]
const S: [f64; 6] = [
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
];
/// `cos r = 1 - r^2 / 2 + sum C_k r^(2k + 2)`
#[allow(clippy::excessive_precision, reason = "the digits that were published")]
const C: [f64; 6] = [
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
];

/// `sin r = r + sum S_k r^(2k + 1)` and `cos r = 1 + sum C_k r^2k` with errors of 2.2e-15 and 6.2e-14.
const S_13: [f64; 5] = [
    -0.16666666666606086,
    0.00833333332192847,
    -0.00019841262368078868,
    2.7555099304654166e-06,
    -2.474548617605939e-08,
];
const C_13: [f64; 5] = [
    -0.4999999999954513,
    0.04166666656208379,
    -0.0013888881079038005,
    2.479904110186518e-05,
    -2.7180104984548233e-07,
];

/// Coefficients with errors of 1.8e-9 and 3.3e-8.
const S_7: [f64; 3] = [-0.16666650669251834, 0.008331978660298233, -0.00019495635819927922];
const C_7: [f64; 3] = [-0.49999894780838217, 0.04165629454211713, -0.0013597822590581219];

/// Sine and cosine, to 0.8 ulp.
#[inline(always)]
pub(crate) fn sin_cos<V: Register>(x: Vector<V>) -> (Vector<V>, Vector<V>) {
    if x.magnitude().0.some_above(RANGE) {
        return beyond(&x, scalar);
    }
    let (quadrant, r, tail) = reduced(x);
    turned(quadrant, sin_kernel(r, tail), cos_kernel(r, tail))
}

/// Sine alone: the bits of [`sin_cos`], at the cost of one polynomial instead of two.
///
/// The polynomial is chosen by a branch on the quadrant. A processor predicts it where the argument changes slowly, as
/// angles do during a motion; mispredicted for every second argument it is still quicker than both polynomials.
#[inline]
pub(crate) fn sin(x: f64) -> f64 {
    if x.abs() > RANGE {
        return scalar(x).0;
    }
    let (quadrant, r, tail) = reduced(Vector(x));
    let n = quadrant.0.to_bits();
    let value = if n & 1 == 0 { sin_kernel(r, tail) } else { cos_kernel(r, tail) };
    value.signed_by(Vector(f64::from_bits(n << 62))).0
}

/// Cosine alone, as [`sin`].
#[inline]
pub(crate) fn cos(x: f64) -> f64 {
    if x.abs() > RANGE {
        return scalar(x).1;
    }
    let (quadrant, r, tail) = reduced(Vector(x));
    let n = quadrant.0.to_bits();
    let value = if n & 1 == 0 { cos_kernel(r, tail) } else { sin_kernel(r, tail) };
    value.signed_by(Vector(f64::from_bits((n << 62) ^ (n << 63)))).0
}

/// Returns `(n, r, tail)` with `x = n pi/2 + r + tail`; the two lowest bits of the first number are those of `n`.
#[inline(always)]
fn reduced<V: Register>(x: Vector<V>) -> (Vector<V>, Vector<V>, Vector<V>) {
    let (quadrant, n) = multiple(x);
    // The first difference is exact, the second is kept with its error, and r + tail is the third.
    let far = x - n * FIRST;
    let step = n * SECOND;
    let near = far - step;
    let lost = (far - near) - step;
    let step = n * THIRD - lost;
    let r = near - step;
    (quadrant, r, (near - r) - step)
}

/// The sine of `r + tail`, where the tail is below an ulp of `r`.
#[inline(always)]
fn sin_kernel<V: Register>(r: Vector<V>, tail: Vector<V>) -> Vector<V> {
    let [s1, s2, s3, s4, s5, s6] = S;
    let z = r * r;
    let cube = z * r;
    let series = (z * (z * s4 + s3) + s2) + z * (z * z) * (z * s6 + s5);
    // sin(r + e) = r - (r^2 (e/2 - r^3 (S_1 + ..)) - e - S_0 r^3): a difference, which keeps the sign of zero
    r - ((z * (tail * 0.5 - cube * series) - tail) - cube * s1)
}

/// The cosine of `r + tail`, where the tail is below an ulp of `r`.
#[inline(always)]
fn cos_kernel<V: Register>(r: Vector<V>, tail: Vector<V>) -> Vector<V> {
    let [c1, c2, c3, c4, c5, c6] = C;
    let z = r * r;
    let w = z * z;
    let half = z * 0.5;
    let series = z * (z * (z * c3 + c2) + c1) + w * w * (z * (z * c6 + c5) + c4);
    let main = -half + 1.0;
    // cos(r + e) = (1 - r^2/2) + ((1 - (1 - r^2/2)) - r^2/2 + (r^4 (C_0 + ..) - r e))
    main + (((-main + 1.0) - half) + (z * series - r * tail))
}

/// Sine and cosine with an absolute error below 1e-13.
#[inline(always)]
pub(crate) fn sin_cos_13<V: Register>(x: Vector<V>) -> (Vector<V>, Vector<V>) {
    if x.magnitude().0.some_above(RANGE) {
        return beyond(&x, scalar_13);
    }
    let (quadrant, n) = multiple(x);
    let r = (x - n * FIRST) - n * REST;
    let z = r * r;
    let w = z * z;
    let [s1, s2, s3, s4, s5] = S_13;
    let [c1, c2, c3, c4, c5] = C_13;
    let sin = r * (z * ((z * s2 + s1) + w * ((z * s4 + s3) + w * s5)) + 1.0);
    let cos = z * ((z * c2 + c1) + w * ((z * c4 + c3) + w * c5)) + 1.0;
    turned(quadrant, sin, cos)
}

/// Sine and cosine with an absolute error below 4e-8.
#[inline(always)]
pub(crate) fn sin_cos_7<V: Register>(x: Vector<V>) -> (Vector<V>, Vector<V>) {
    if x.magnitude().0.some_above(RANGE) {
        return beyond(&x, scalar_7);
    }
    let (quadrant, n) = multiple(x);
    let r = x - n * core::f64::consts::FRAC_PI_2;
    let z = r * r;
    let [s1, s2, s3] = S_7;
    let [c1, c2, c3] = C_7;
    let sin = r * (z * (z * (z * s3 + s2) + s1) + 1.0);
    let cos = z * (z * (z * c3 + c2) + c1) + 1.0;
    turned(quadrant, sin, cos)
}

/// The nearest integer `n` to `x` over `pi/2`: with its two lowest bits as those of the first number, and itself.
#[inline(always)]
fn multiple<V: Register>(x: Vector<V>) -> (Vector<V>, Vector<V>) {
    let quadrant = x * core::f64::consts::FRAC_2_PI + ROUND;
    (quadrant, quadrant - ROUND)
}

/// Sine and cosine of `r + n pi/2`: exchanged for odd `n`; the sine's sign is bit 1 of `n`, that of the cosine the
/// sum of both bits.
#[inline(always)]
fn turned<V: Register>(quadrant: Vector<V>, sin: Vector<V>, cos: Vector<V>) -> (Vector<V>, Vector<V>) {
    let odd = Vector(quadrant.0.raised::<63>());
    let upper = Vector(quadrant.0.raised::<62>());
    let turned_sin = Vector(odd.0.by_sign(cos.0, sin.0));
    let turned_cos = Vector(odd.0.by_sign(sin.0, cos.0));
    (turned_sin.signed_by(upper), turned_cos.signed_by(Vector(upper.0.xor(odd.0))))
}

/// Each lane by itself, because some argument is out of range.
#[cold]
#[inline(never)]
fn beyond<V: Register>(x: &Vector<V>, within: fn(f64) -> (f64, f64)) -> (Vector<V>, Vector<V>) {
    let one = |i| {
        let x: f64 = x.lane(i);
        if x.abs() > RANGE { large(x) } else { within(x) }
    };
    (Vector::from_fn(|i| one(i).0), Vector::from_fn(|i| one(i).1))
}

fn large(x: f64) -> (f64, f64) {
    let (quadrant, r, tail) = remainder(x);
    let (r, tail) = (Vector(r), Vector(tail));
    let (sin, cos) = turned(Vector(f64::from_bits(quadrant)), sin_kernel(r, tail), cos_kernel(r, tail));
    (if x < 0.0 { -sin.0 } else { sin.0 }, cos.0)
}

/// Functions of one number, out of line: for lanes in range that have a neighbour out of it.
macro_rules! scalars {
    ($($scalar:ident $function:ident;)*) => {
        $(fn $scalar(x: f64) -> (f64, f64) {
            let (sin, cos) = $function(Vector(x));
            (sin.0, cos.0)
        })*
    };
}

scalars! {
    scalar sin_cos;
    scalar_13 sin_cos_13;
    scalar_7 sin_cos_7;
}
