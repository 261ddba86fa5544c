//! Noise for the tests of the audit, the same at every run.

/// Numbers from -0.5 to 0.5 by a xorshift generator of 32 bits (Marsaglia 2003, J. Statistical Software 8(14), p. 4).
pub fn noise(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(2_654_435_761) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        f64::from(state) / f64::from(u32::MAX) - 0.5
    }
}
