//! Random numbers by their place: the number of a motion and of an axis, not those drawn before.

/// The generator Philox 4x32 with ten rounds (Salmon, Moraes, Dror, Shaw 2011): bits are a function of a key and a counter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Philox {
    key: [u32; 2],
}

impl Philox {
    pub(super) const fn new(seed: u64) -> Self {
        Self { key: [seed as u32, (seed >> 32) as u32] }
    }

    /// Sixty-four bits for a place.
    pub(super) fn bits(&self, index: u64, stream: u64) -> u64 {
        let counter = [index as u32, (index >> 32) as u32, stream as u32, (stream >> 32) as u32];
        let [a, b, ..] = self.block(counter);
        u64::from(a) | u64::from(b) << 32
    }

    /// A number inside of the unit interval: an odd multiple of 2^-53.
    pub(super) fn unit(&self, index: u64, stream: u64) -> f64 {
        unit(self.bits(index, stream))
    }

    fn block(&self, mut counter: [u32; 4]) -> [u32; 4] {
        const MULTIPLIERS: [u64; 2] = [0xd251_1f53, 0xcd9e_8d57];
        const WEYL: [u32; 2] = [0x9e37_79b9, 0xbb67_ae85];
        let mut key = self.key;
        for _ in 0..10 {
            let products = [MULTIPLIERS[0] * u64::from(counter[0]), MULTIPLIERS[1] * u64::from(counter[2])];
            counter = [
                (products[1] >> 32) as u32 ^ counter[1] ^ key[0],
                products[1] as u32,
                (products[0] >> 32) as u32 ^ counter[3] ^ key[1],
                products[0] as u32,
            ];
            key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
        }
        counter
    }
}

/// The number inside of the unit interval that the highest 52 bits tell: never zero, never one.
pub(super) fn unit(bits: u64) -> f64 {
    const PART: f64 = 1.0 / (1_u64 << 53) as f64;
    ((bits >> 12) * 2 + 1) as f64 * PART
}

/// Rounds of the network below: four make a pseudorandom permutation (Luby and Rackoff 1988), and small ones mix better with two more.
const ROUNDS: usize = 6;

/// A permutation of `0 .. count` that is computed, not stored: a Feistel network over the next power of two, walked until it
/// falls into the range. Less than two walks are needed on average.
#[derive(Clone, Copy, Debug)]
pub(super) struct Permutation {
    keys: [[u64; 2]; ROUNDS / 2],
    count: u64,
    /// Bits of the left and of the right half, which differ by one at most.
    widths: [u32; 2],
}

impl Permutation {
    pub(super) fn new(random: Philox, stream: u64, count: u64) -> Self {
        let bits = 64 - count.saturating_sub(1).leading_zeros();
        let key = |round: usize| random.bits(round as u64, stream);
        let keys = std::array::from_fn(|pair| [key(2 * pair), key(2 * pair + 1)]);
        Self { keys, count, widths: [bits.div_ceil(2), bits / 2] }
    }

    /// The place that `index` goes to.
    pub(super) fn at(&self, index: u64) -> u64 {
        let [left_mask, right_mask] = self.widths.map(|width| (1_u64 << width) - 1);
        let [_, low] = self.widths;
        let mut place = index;
        loop {
            let (mut left, mut right) = (place >> low, place & right_mask);
            // The halves change places in every round, so they are taken in pairs.
            for [first, second] in self.keys {
                left ^= hashed(right, first) & left_mask;
                right ^= hashed(left, second) & right_mask;
            }
            place = left << low | right;
            if place < self.count {
                return place;
            }
        }
    }
}

/// The middle bits of a product with a key, which all lower bits take part in (multiply-shift hashing, Dietzfelbinger and others 1997): enough
/// for one round of the network.
fn hashed(bits: u64, key: u64) -> u64 {
    (bits ^ key).wrapping_mul(key | 1) >> 32
}

/// Bits that depend on all bits of a number: the last steps of splitmix64.
pub(super) fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_answers() {
        // The published test vectors of the generator.
        assert_eq!(Philox::new(0).block([0; 4]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(
            Philox::new(u64::MAX).block([u32::MAX; 4]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
        let pi = Philox { key: [0xa409_3822, 0x299f_31d0] };
        assert_eq!(
            pi.block([0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344]),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn units_are_inside() {
        assert!(unit(0) > 0.0 && unit(u64::MAX) < 1.0);
        assert_eq!(unit(1 << 63), 0.5 + 2.0_f64.powi(-53));
    }

    /// Ranks of axes against the order of motions, and of two axes, as of permutations drawn at random: correlations have the variance `1/(count - 1)`,
    /// and all pairs of sixteenths are equally frequent.
    #[test]
    fn permutations_do_not_follow_each_other() {
        const STREAMS: u64 = 400;
        for count in [64, 100, 1000, 5000] {
            let places = |stream| {
                let permutation = Permutation::new(Philox::new(7), stream, count);
                (0..count).map(|index| permutation.at(index)).collect::<Vec<u64>>()
            };
            let middle = (count - 1) as f64 / 2.0;
            let variance = (count * count - 1) as f64 / 12.0;
            let correlation = |x: &[u64], y: &[u64]| {
                let terms = x.iter().zip(y).map(|(x, y)| (*x as f64 - middle) * (*y as f64 - middle));
                terms.sum::<f64>() / (count as f64 * variance)
            };
            let sixteenths = |x: &[u64], y: &[u64]| {
                let mut frequencies = [0.0; 256];
                let part = |x: u64| (16 * x / count) as usize;
                x.iter().zip(y).for_each(|(x, y)| frequencies[16 * part(*x) + part(*y)] += 1.0);
                let expected = count as f64 / 256.0;
                frequencies.iter().map(|n| (n - expected) * (n - expected) / expected).sum::<f64>()
            };
            let identity: Vec<u64> = (0..count).collect();
            let (mut squares, mut spreads) = ([0.0; 2], [0.0; 2]);
            let mut last = places(0);
            for stream in 1..=STREAMS {
                let own = places(stream);
                for (k, other) in [&identity, &last].into_iter().enumerate() {
                    squares[k] += correlation(&own, other).powi(2) * (count - 1) as f64 / STREAMS as f64;
                    spreads[k] += sixteenths(&own, other) / STREAMS as f64;
                }
                last = own;
            }
            // Four deviations of means over so many streams.
            let one = 4.0 * (2.0 / STREAMS as f64).sqrt();
            let cells = 225.0 * count as f64 / (count - 1) as f64;
            for (square, spread) in squares.into_iter().zip(spreads) {
                assert!((square - 1.0).abs() < one, "{count}: {square}");
                assert!(
                    (spread / cells - 1.0).abs() < 4.0 * (2.0 / 225.0 / STREAMS as f64).sqrt(),
                    "{count}: {spread}"
                );
            }
        }
    }

    #[test]
    fn permutations_take_every_place_once() {
        for count in [1, 2, 3, 10, 16, 17, 100, 128, 513, 1000] {
            for stream in 0..3 {
                let permutation = Permutation::new(Philox::new(5), stream, count);
                let mut places: Vec<u64> = (0..count).map(|index| permutation.at(index)).collect();
                let identity: Vec<u64> = (0..count).collect();
                assert!(count < 10 || places != identity);
                places.sort_unstable();
                assert_eq!(places, identity);
            }
        }
    }
}
