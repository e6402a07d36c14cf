//! Reproducible mixing of bits, for orders of insertion and seeded inputs.

/// SplitMix64's step and finaliser (Steele, Lea and Flood 2014): a bijection that mixes all bits.
#[inline]
pub(crate) fn random_bits(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
