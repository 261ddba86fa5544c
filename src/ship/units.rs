//! Constants of nature in SI units, each written once.
//! Units of recorded values and their conversion are in `recording::unit`.

/// Standard gravity \[m/s2\].
pub const GRAVITY: f64 = 9.80665;
