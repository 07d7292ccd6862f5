//! Reduction of large arguments by `pi/2`, after M. Payne and R. Hanek (SIGNUM Newsletter 18, 1983), in integers.
//!
//! ```text
//! x = m 2^e,   x 2/pi mod 4 = m (bits of 2/pi from weight 2^(1-e) on) 2^e mod 4
//! ```
//!
//! What comes before these bits contributes multiples of four. Of the bits that follow 192 are used: the nearest that
//! an `f64` comes to a multiple of `pi/2` is `2^-62` of the distance between multiples, so that more than 60 bits of
//! the remainder are right. Nothing here can panic.

/// The bits of `2/pi` after the point, behind one word of zeros.
const TWO_OVER_PI: [u64; 20] = [
    0,
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
];

/// `2^128 pi/4`.
const QUARTER_PI: u128 = 0xc90f_daa2_2168_c234_c4c6_628b_80dc_1cd1;

/// The remainder of a number of at least `2^-10`: `|x| = n pi/2 + r + tail`, as `(n mod 4, r, tail)`; for infinity
/// and NaN the remainder is NaN.
pub(super) fn remainder(x: f64) -> (u64, f64, f64) {
    const FRACTION: u64 = (1 << 52) - 1;
    const EXPONENT: u64 = 0x7ff;

    let bits = x.abs().to_bits();
    let exponent = bits >> 52;
    if exponent == EXPONENT {
        return (0, f64::NAN, f64::NAN);
    }
    let mantissa = u128::from((bits & FRACTION) | (1 << 52));
    // With |x| = m 2^e, `e = exponent - 1075`: bits are wanted from that of weight 2^(1 - e) on, which is number
    // `e - 2` behind the point.
    let first = (exponent + 64).saturating_sub(1077);
    let (word, shift) = ((first / 64) as usize, first % 64);
    let at = |i: usize| u128::from(TWO_OVER_PI.get(word + i).copied().unwrap_or(0));
    let window = |i: usize| (((at(i) << 64 | at(i + 1)) << shift) >> 64) & u128::from(u64::MAX);
    // The product modulo 2^192.
    let low = mantissa * window(2);
    let middle = mantissa * window(1) + (low >> 64);
    let high = (mantissa * window(0) + (middle >> 64)) & u128::from(u64::MAX);
    let quadrant = (high >> 62) as u64;
    let product = high << 64 | (middle & u128::from(u64::MAX));
    let fraction = product << 2 | (low & u128::from(u64::MAX)) >> 62;
    // To the nearest multiple.
    let above = fraction >> 127 == 1;
    let size = if above { fraction.wrapping_neg() } else { fraction };
    let zeros = size.leading_zeros();
    let r = high_product(size.checked_shl(zeros).unwrap_or(0), QUARTER_PI);
    // r 2^-127 in 53 bits and the next 64.
    let (leading, rest) = ((r >> 75) as u64, (r << 53 >> 64) as u64);
    let zeros = u64::from(zeros);
    let scale = |down: u64| f64::from_bits((1023_u64.saturating_sub(down)) << 52);
    let (r, tail) = (leading as f64 * scale(52 + zeros), rest as f64 * scale(116 + zeros));
    if above { (quadrant + 1, -r, -tail) } else { (quadrant, r, tail) }
}

/// The upper half of a product, less at most three units.
fn high_product(a: u128, b: u128) -> u128 {
    let low = u128::from(u64::MAX);
    let (a1, a0, b1, b0) = (a >> 64, a & low, b >> 64, b & low);
    a1 * b1 + ((a1 * b0) >> 64) + ((a0 * b1) >> 64)
}
