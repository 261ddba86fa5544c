//! Published regressions of a rudder behind a hull, from what every ship file has.
//! They say where estimates begin; what a rudder does is in the terms.

/// Slope of the normal-force coefficient \[-\] of a rudder of an aspect ratio, 6.13 A/(A + 2.25).
///
/// Source: Fujii & Tsuda 1961, as in Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20.
pub fn normal_slope(aspect: f64) -> f64 {
    6.13 * aspect / (aspect + 2.25)
}

/// Steering resistance deduction t_R \[-\] behind a hull of a block coefficient, 0.45 - 0.28 C_b.
pub fn steering_deduction(block: f64) -> f64 {
    0.45 - 0.28 * block
}

/// Hull force that a rudder induces over its own, a_H \[-\], 0.627 C_b - 0.153.
///
/// Source: Kijima 1990.
pub fn induced_force(block: f64) -> f64 {
    0.627 * block - 0.153
}
