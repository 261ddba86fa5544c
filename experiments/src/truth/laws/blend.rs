//! Smooth transitions between laws that are valid in different ranges.
//! It has no law of its own.

/// 0 below `from`, 1 above `to`, and twice continuously differentiable between.
pub fn smooth_step(x: f64, from: f64, to: f64) -> f64 {
    let s = ((x - from) / (to - from)).clamp(0.0, 1.0);
    s * s * s * (10.0 - s * (15.0 - 6.0 * s))
}

/// Share of the law for astern rotation: 0 at n >= 0, and 1 from |n| D = 0.3 |u| on.
///
/// The laws for ahead and for astern rotation do not meet at n = 0; this blends them over a narrow range of the advance ratio.
pub fn astern_weight(n: f64, diameter: f64, u: f64) -> f64 {
    // 1 cm/s keeps the ratio defined at rest, where every force it blends is below a newton or scales with n^2 anyway.
    smooth_step(-n * diameter, 0.0, 0.3 * u.hypot(0.01))
}

#[cfg(test)]
mod tests {
    use super::smooth_step;

    #[test]
    fn smooth_step_runs_from_zero_to_one() {
        assert_eq!(smooth_step(-1.0, 0.0, 2.0), 0.0);
        assert_eq!(smooth_step(3.0, 0.0, 2.0), 1.0);
        assert!((smooth_step(1.0, 0.0, 2.0) - 0.5).abs() < 1e-15);
    }
}
