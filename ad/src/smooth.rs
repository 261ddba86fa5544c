//! Smooth replacements for the corners of physics, so that a derivative exists at every point a solver may visit.
//! These are shapes without units or meaning; each use states which effect it blends over which range.

use crate::Scalar;
use std::f64::consts::TAU;

/// `sqrt(x^2 + eps^2)`: `|x|` with its corner rounded over the width `eps > 0`.
///
/// It is too large by `eps` at 0 and by less than `eps^2 / (2 |x|)` away from it; the slope is within (-1, 1).
#[inline(always)]
pub fn smooth_abs<S: Scalar>(x: S, eps: f64) -> S {
    (x * x + eps * eps).sqrt()
}

/// `6 x^5 - 15 x^4 + 10 x^3` on [0, 1], 0 below and 1 above: a step with continuous first and second derivatives.
#[inline(always)]
pub fn smooth_step<S: Scalar>(x: S) -> S {
    let t = x.clamp(0.0, 1.0);
    t * t * t * ((t * 6.0 - 15.0) * t + 10.0)
}

/// `a` where `x <= lo`, `b` where `x >= hi`, and a [`smooth_step`] from one to the other between them. Needs `lo < hi`.
///
/// Both `a` and `b` must be finite everywhere, since each is multiplied by its weight, be it zero.
#[inline(always)]
pub fn blend<S: Scalar>(x: S, lo: f64, hi: f64, a: S, b: S) -> S {
    let weight = smooth_step((x - lo) / (hi - lo));
    // Not `a + (b - a) weight`: this form is exactly `b` at the far end.
    a * (-weight + 1.0) + b * weight
}

/// `ln(1 + e^x)`: the smooth `max(x, 0)`, without overflow at either end. For a corner of width `w`, use `softplus(x / w) w`.
#[inline(always)]
pub fn softplus<S: Scalar>(x: S) -> S {
    /// Below this, `1 + e` drops more digits of `e` than the series of `ln(1 + e)` does after three terms.
    const SMALL: f64 = 1e-4;
    let e = (-x.abs()).exp();
    let series = e * (e * (e * (1.0 / 3.0) - 0.5) + 1.0);
    x.max(S::zero()) + S::select(e.less(S::from_f64(SMALL)), series, (e + 1.0).ln())
}

/// The angle `x` brought into (-pi, pi] by whole turns; the derivative is 1.
///
/// Accurate to the rounding of `x` itself: at 1000 turns the result is good to 1e-12 rad.
#[inline(always)]
pub fn wrap_angle<S: Scalar>(x: S) -> S {
    x - (x / TAU).nearest() * TAU
}
