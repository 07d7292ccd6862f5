//! Numbers of 106 bits as sums of two, and the elementary functions on them: references for many arguments, good to `1e-24`
//! at the least. Error-free sums and products after T. J. Dekker, *A floating-point technique for extending the available
//! precision*, Numerische Mathematik 18 (1971) 224-242.

use std::ops::{Add, Div, Mul, Neg, Sub};

#[derive(Clone, Copy, Debug)]
pub struct Pair(pub f64, pub f64);

fn quick(a: f64, b: f64) -> Pair {
    let sum = a + b;
    Pair(sum, b - (sum - a))
}

fn sum(a: f64, b: f64) -> Pair {
    let sum = a + b;
    let part = sum - a;
    Pair(sum, (a - (sum - part)) + (b - part))
}

fn product(a: f64, b: f64) -> Pair {
    let product = a * b;
    Pair(product, a.mul_add(b, -product))
}

impl From<f64> for Pair {
    fn from(x: f64) -> Self {
        Self(x, 0.0)
    }
}

impl Add for Pair {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.0, other.0), sum(self.1, other.1));
        let next = quick(high.0, high.1 + low.0);
        quick(next.0, next.1 + low.1)
    }
}

impl Neg for Pair {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Sub for Pair {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Pair {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = product(self.0, other.0);
        quick(high.0, high.1 + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Div for Pair {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.0 / other.0;
        let rest = self - other * first.into();
        let second = rest.0 / other.0;
        let rest = rest - other * second.into();
        quick(first, second) + (rest.0 / other.0).into()
    }
}

impl Pair {
    pub fn ratio(self, n: u32) -> Self {
        self / f64::from(n).into()
    }

    /// `sum_k x^first ..`: `x^first/first! + x^(first+2)/(first+2)! ..`, with signs that alternate or not.
    fn every_second(self, first: u32, alternating: bool) -> Self {
        let square = if alternating { -(self * self) } else { self * self };
        let mut term = if first == 0 { 1.0.into() } else { self };
        let mut total = term;
        for k in (first + 2..40).step_by(2) {
            term = term * square * INVERSES[(k - 1) as usize] * INVERSES[k as usize];
            total = total + term;
            if term.0.abs() < 1e-35 * total.0.abs() {
                break;
            }
        }
        total
    }

    pub fn sin_cos(self) -> (Self, Self) {
        // pi/2 in three parts.
        const HALF: [f64; 3] =
            [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];
        let turns = (self.0 / HALF[0]).round();
        let rest = HALF.iter().fold(self, |rest, part| rest - product(turns, *part));
        let (sin, cos) = (rest.every_second(1, true), rest.every_second(0, true));
        match (turns as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    pub fn exp(self) -> Self {
        const LN_2: [f64; 2] = [std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17];
        let doublings = (self.0 / LN_2[0]).round();
        let rest = LN_2.iter().fold(self, |rest, part| rest - product(doublings, *part));
        let rest = Pair(rest.0 / 256.0, rest.1 / 256.0);
        // exp - 1 keeps the digits while it is squared: (1 + a)^2 - 1 = 2 a + a^2.
        let mut less = rest.every_second(1, false) + (rest.every_second(0, false) - 1.0.into());
        for _ in 0..8 {
            less = less + less + less * less;
        }
        let whole = less + 1.0.into();
        let power = (0.5 * doublings).floor().exp2();
        let other = (doublings - (0.5 * doublings).floor()).exp2();
        Pair(whole.0 * power * other, whole.1 * power * other)
    }

    pub fn sqrt(self) -> Self {
        let root = self.0.sqrt();
        let rest = self - product(root, root);
        quick(root, rest.0 / (2.0 * root))
    }

    /// The root of order `q` of a positive number.
    pub fn root(self, q: u32) -> Self {
        let root = Pair::from(self.0.powf(1.0 / f64::from(q)));
        let power = (1..q).fold(Pair::from(1.0), |power, _| power * root);
        let step = (self / power - root).ratio(q);
        // What Newton leaves: (q - 1)/2 d^2 / root, which is below 1e-30.
        root + step
    }

    pub fn ln(self) -> Self {
        let z = self - 1.0.into();
        if z.0.abs() < 1e-3 {
            let mut total = Pair::from(0.0);
            for k in (1..=14).rev() {
                total = Pair::from(1.0).ratio(k) - z * total;
            }
            return total * z;
        }
        let guess = Pair::from(self.0.ln());
        let z = self * (-guess).exp() - 1.0.into();
        guess + (z - (z * z).ratio(2))
    }

    pub fn atan2(self, x: Self) -> Self {
        let guess = Pair::from(self.0.atan2(x.0));
        let (s, c) = guess.sin_cos();
        guess + (self * c - x * s) / (x * c + self * s)
    }

    pub fn asin(self) -> Self {
        if self.0.abs() > 0.7 {
            let half = Pair::from(std::f64::consts::FRAC_PI_2) + 6.123_233_995_736_766e-17.into();
            let rest = ((Pair::from(1.0) - if self.0 < 0.0 { -self } else { self }).ratio(2)).sqrt().asin();
            let asin = half - rest - rest;
            return if self.0 < 0.0 { -asin } else { asin };
        }
        let guess = Pair::from(self.0.asin());
        let (s, c) = guess.sin_cos();
        guess + (self - s) / c
    }

    pub fn acos(self) -> Self {
        let half = Pair::from(std::f64::consts::FRAC_PI_2) + 6.123_233_995_736_766e-17.into();
        if self.0 > 0.7 {
            let rest = (Pair::from(1.0) - self).ratio(2).sqrt().asin();
            return rest + rest;
        }
        half - self.asin()
    }

    pub fn sinh(self) -> Self {
        if self.0.abs() < 0.5 {
            return self.every_second(1, false);
        }
        let exp = self.exp();
        (exp - Pair::from(1.0) / exp).ratio(2)
    }

    pub fn cosh(self) -> Self {
        let exp = self.exp();
        (exp + Pair::from(1.0) / exp).ratio(2)
    }

    pub fn tanh(self) -> Self {
        if self.0.abs() > 40.0 {
            return self.0.signum().into();
        }
        self.sinh() / self.cosh()
    }
}

/// `1/k`.
const INVERSES: [Pair; 40] = {
    let mut list = [Pair(0.0, 0.0); 40];
    let mut k = 1;
    while k < 40 {
        let inverse = 1.0 / k as f64;
        // What is left of one, exactly: in twice the bits, by splitting.
        list[k] = Pair(inverse, rest_of_inverse(inverse, k as f64) / k as f64);
        k += 1;
    }
    list
};

/// `1 - x k`, where `k` has few bits: both parts of `x` times `k` are exact.
const fn rest_of_inverse(x: f64, k: f64) -> f64 {
    let scaled = x * 134_217_729.0;
    let high = scaled - (scaled - x);
    let low = x - high;
    (1.0 - high * k) - low * k
}
