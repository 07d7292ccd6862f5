//! A few doubles as whole numbers of one unit: sums of them and of their products are sums of integers, and enter exact sums at once.

use super::exact_sum::{ExactSum, Parts};

/// The most numbers that are taken at a time.
pub(super) const ROWS: usize = 64;
/// The bits that numbers have beyond the 53 of a double: as many products of two as there are rows fit 127 bits and a sign.
const SPARE: i32 = 7;

/// Finite doubles of about the size of the largest as whole numbers; smaller ones that have bits below the unit are told apart.
pub(super) struct Scaled {
    /// Zero in the place of those that are told apart.
    wholes: Vec<i64>,
    /// The exponent of two of the unit.
    unit: i32,
    /// A bit for each number: whether it is told apart.
    apart: u64,
    parts: Vec<Parts>,
}

impl Scaled {
    pub(super) fn new() -> Self {
        Self { wholes: Vec::with_capacity(ROWS), unit: 0, apart: 0, parts: Vec::with_capacity(ROWS) }
    }

    /// Takes other numbers, at most [`ROWS`] of them.
    pub(super) fn take(&mut self, values: impl Iterator<Item = f64>) {
        self.parts.clear();
        self.parts.extend(values.map(Parts::of));
        let largest = self.parts.iter().map(|x| x.exponent).max().unwrap_or(0);
        // No double has a bit below the least exponent.
        self.unit = (largest - SPARE).max(Parts::LEAST);
        self.apart = 0;
        self.wholes.clear();
        for (row, x) in self.parts.iter().enumerate() {
            let up = x.exponent - self.unit;
            let fits = up >= 0 || x.whole == 0;
            self.apart |= u64::from(!fits) << row;
            let size = if fits { x.whole << up.max(0) } else { 0 };
            self.wholes.push(size as i64 * i64::from(x.sign));
        }
    }

    /// Adds all numbers to a sum.
    pub(super) fn add_to(&self, sum: &mut ExactSum) {
        let wholes: i128 = self.wholes.iter().map(|x| i128::from(*x)).sum();
        sum.add_whole(wholes, self.unit);
        places(self.apart).for_each(|row| sum.add(self.parts[row]));
    }

    /// Adds the products with other numbers in the same rows to a sum.
    pub(super) fn add_products_to(&self, other: &Self, sum: &mut ExactSum) {
        let products = self.wholes.iter().zip(&other.wholes);
        let wholes: i128 = products.map(|(x, y)| i128::from(*x) * i128::from(*y)).sum();
        sum.add_whole(wholes, self.unit + other.unit);
        places(self.apart | other.apart).for_each(|row| sum.add_product(self.parts[row], other.parts[row]));
    }
}

/// The places of the bits that are set.
fn places(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (place < u64::BITS).then_some(place as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::random::Philox;

    /// Both sums, term by term and by whole numbers.
    fn check(x: &[f64], y: &[f64]) {
        let [mut sum, mut products, mut by_wholes, mut products_by_wholes]: [ExactSum; 4] =
            Default::default();
        for (x, y) in x.iter().zip(y) {
            sum.add(Parts::of(*x));
            products.add_product(Parts::of(*x), Parts::of(*y));
        }
        let [mut first, mut second] = [Scaled::new(), Scaled::new()];
        first.take(x.iter().copied());
        second.take(y.iter().copied());
        first.add_to(&mut by_wholes);
        first.add_products_to(&second, &mut products_by_wholes);
        assert_eq!(by_wholes.text(), sum.text(), "{x:?}");
        assert_eq!(products_by_wholes.text(), products.text(), "{x:?} {y:?}");
    }

    #[test]
    fn sums_are_those_of_terms() {
        let random = Philox::new(17);
        for round in 0..300 {
            let count = random.bits(round, 99) as usize % (ROWS + 1);
            // From alike to sizes that have nothing to do with each other.
            let spread = [0.0, 3.0, 20.0, 600.0][round as usize % 4];
            let value = |row: usize, stream: u64| {
                let size = (spread * (random.unit(round, stream + 1000 * row as u64) - 0.5)).exp2();
                size * (random.unit(round, stream + 7 + 1000 * row as u64) - 0.5)
            };
            let x: Vec<f64> = (0..count).map(|row| value(row, 1)).collect();
            let y: Vec<f64> = (0..count).map(|row| value(row, 2)).collect();
            check(&x, &y);
        }
    }

    #[test]
    fn the_most_of_the_largest_fit() {
        let below_two = f64::from_bits(0x3fff_ffff_ffff_ffff);
        for (first, second) in [
            (f64::MAX, f64::MAX),
            (f64::MIN, f64::MAX),
            (below_two, below_two),
            (below_two, -below_two),
            (5e-324, 5e-324),
            (f64::MIN_POSITIVE, 5e-324),
            (0.0, -0.0),
            (0.0, f64::MAX),
            (-0.0, 5e-324),
        ] {
            check(&[first; ROWS], &[second; ROWS]);
        }
        // Sizes around the last that fits, in one row each.
        for spare in SPARE - 2..SPARE + 3 {
            let mut x = [below_two; ROWS];
            x[5] = -below_two * 2.0_f64.powi(-spare);
            x[63] = 2.0_f64.powi(-spare - 1);
            check(&x, &[below_two; ROWS]);
            check(&[-below_two; ROWS], &x);
        }
    }
}
