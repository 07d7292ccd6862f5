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

/// A permutation of `0 .. count` that is computed, not stored: a Feistel network over the next power of four, walked until it
/// falls into the range.
#[derive(Clone, Copy, Debug)]
pub(super) struct Permutation {
    keys: [u64; ROUNDS],
    count: u64,
    half: u32,
}

impl Permutation {
    pub(super) fn new(random: Philox, stream: u64, count: u64) -> Self {
        let bits = 64 - count.saturating_sub(1).leading_zeros();
        let keys = std::array::from_fn(|round| random.bits(round as u64, stream));
        Self { keys, count, half: bits.div_ceil(2).max(1) }
    }

    /// The place that `index` goes to.
    pub(super) fn at(&self, index: u64) -> u64 {
        let mask = (1_u64 << self.half) - 1;
        let mut place = index;
        loop {
            let (mut left, mut right) = (place >> self.half, place & mask);
            for key in self.keys {
                (left, right) = (right, left ^ (mixed(right ^ key) & mask));
            }
            place = left << self.half | right;
            if place < self.count {
                return place;
            }
        }
    }
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

    #[test]
    fn permutations_take_every_place_once() {
        for count in [1, 2, 3, 10, 16, 17, 1000] {
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
