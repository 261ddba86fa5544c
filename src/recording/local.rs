//! Local quadratic fits of a sampled signal: value and slope at a point, from the samples around it (Savitzky and Golay 1964).
//! It works on any sampling and at the ends; it is no filter of the stored channels.

use std::ops::Range;

/// Value, slope and curvature (second derivative) at `at` of the least-squares quadratic through the samples.
///
/// Fewer than three distinct times give a lower degree; `None` when there is no finite sample.
pub(crate) fn local_fit(t: &[f64], v: &[f64], at: f64) -> Option<[f64; 3]> {
    let scale = t.iter().map(|t| (t - at).abs()).fold(0.0, f64::max);
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut right = nalgebra::Vector3::<f64>::zeros();
    let mut rows = 0;
    // The first value is taken out and put back, so that large offsets (positions, times) cost no digits.
    let base = v.iter().copied().find(|v| v.is_finite())?;
    for (&t, &v) in t.iter().zip(v).filter(|(_, v)| v.is_finite()) {
        let s = (t - at) / scale;
        let basis = nalgebra::Vector3::new(1.0, s, s * s);
        normal += basis * basis.transpose();
        right += basis * (v - base);
        rows += 1;
    }
    for degree in (0..=2_usize.min(rows - 1)).rev() {
        let size = degree + 1;
        let a = normal.view((0, 0), (size, size)).into_owned();
        let b = right.rows(0, size).into_owned();
        if let Some(c) = a.cholesky().map(|c| c.solve(&b)).filter(|c| c.iter().all(|x| x.is_finite())) {
            let at_most = |i: usize| if i < size { c[i] } else { 0.0 };
            return Some([base + at_most(0), at_most(1) / scale, 2.0 * at_most(2) / (scale * scale)]);
        }
    }
    None
}

/// Value, slope and curvature of `v` at every row of `rows`, from quadratics over `span` seconds around each; five samples at
/// least.
///
/// Near the ends the span is cut off, not moved. Rows outside `rows` are not looked at.
pub(crate) fn local(t: &[f64], v: &[f64], rows: Range<usize>, span: f64) -> Vec<[f64; 3]> {
    let half = 0.5 * span * (1.0 + 1e-9);
    let (mut lo, mut hi) = (rows.start, rows.start);
    rows.clone()
        .map(|row| {
            while t[row] - t[lo] > half {
                lo += 1;
            }
            while hi < rows.end && t[hi] - t[row] <= half {
                hi += 1;
            }
            let from = lo.min(row.saturating_sub(2)).max(rows.start);
            let to = hi.max(row + 3).min(rows.end);
            local_fit(&t[from..to], &v[from..to], t[row]).unwrap_or([f64::NAN; 3])
        })
        .collect()
}

/// Slope of `v` at every row of `rows`; see [`local`].
pub(crate) fn slope(t: &[f64], v: &[f64], rows: Range<usize>, span: f64) -> Vec<f64> {
    local(t, v, rows, span).into_iter().map(|c| c[1]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(crate::recording::seeded())]
        #[test]
        fn a_quadratic_is_recovered_from_any_sampling(
            c in prop::array::uniform3(-5.0..5.0f64), at in -1.0..11.0f64, jitter in prop::collection::vec(0.0..0.5f64, 11)
        ) {
            let t: Vec<f64> = jitter.iter().enumerate().map(|(i, j)| i as f64 + j).collect();
            let v: Vec<f64> = t.iter().map(|t| c[0] + c[1] * t + c[2] * t * t).collect();
            let got = local_fit(&t, &v, at).unwrap();
            let want = [c[0] + c[1] * at + c[2] * at * at, c[1] + 2.0 * c[2] * at, 2.0 * c[2]];
            for (g, w) in got.iter().zip(want) {
                prop_assert!((g - w).abs() < 1e-7 * (1.0 + w.abs()), "{got:?} {want:?}");
            }
        }
    }

    #[test]
    fn the_slope_of_a_parabola_is_exact_up_to_the_ends() {
        let t: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let v: Vec<f64> = t.iter().map(|t| 3.0 + 2.0 * t - t * t).collect();
        for (t, s) in t.iter().zip(slope(&t, &v, 0..40, 0.8)) {
            assert!((s - (2.0 - 2.0 * t)).abs() < 1e-9);
        }
    }
}
