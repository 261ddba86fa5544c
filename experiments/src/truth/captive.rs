//! Virtual captive tests: a truth simulator fixed in a planar motion mechanism and measured, as baseline parameters are made.
//! It measures and fits resistance and side force; lift and drag need the fitted model's inflow and are read in `paper::captive_baseline`.

use nalgebra::{Matrix3, Vector3};

use super::motion::Contributions;
use super::simulator::Truth;

/// One measured point: the fixed motion and inputs, and the forces by origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Surge velocity through the water \[m/s\].
    pub u: f64,
    /// Sway velocity \[m/s\].
    pub v: f64,
    /// Yaw rate \[rad/s\].
    pub r: f64,
    /// Propeller rate \[rps\].
    pub n: f64,
    /// Rudder angle \[rad\].
    pub delta: f64,
    /// Measured forces, with a dynamometer each for hull, propeller and rudder.
    pub force: Contributions,
}

fn measure(truth: &dyn Truth, u: f64, v: f64, r: f64, n: f64, delta: f64) -> Row {
    Row { u, v, r, n, delta, force: truth.force(u, v, r, n, delta) }
}

/// A range of `count` equally spaced values, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values.
    pub count: usize,
}

impl Range {
    /// The values, rising from `from`; only `from` itself for a count of 1.
    pub fn values(&self) -> impl Iterator<Item = f64> + use<> {
        let Self { from, to, count } = *self;
        let last = count.saturating_sub(1).max(1) as f64;
        (0..count).map(move |i| from + (to - from) * i as f64 / last)
    }
}

/// Towing runs on a straight course without propeller and rudder forces: only [`Contributions::hull`] is used.
pub fn towing(truth: &dyn Truth, speeds: Range) -> Vec<Row> {
    speeds.values().map(|u| measure(truth, u, 0.0, 0.0, 0.0, 0.0)).collect()
}

/// Rudder angle sweeps: every angle at every pair of speed \[m/s\] and propeller rate \[rps\], at the drift `v` = -u tan(drift)
/// given by each drift angle \[rad\] and without yaw. Give `&[0.0]` as drift for the plain test.
pub fn rudder_sweep(truth: &dyn Truth, points: &[(f64, f64)], drifts: &[f64], angles: Range) -> Vec<Row> {
    let mut rows = Vec::new();
    for &(u, n) in points {
        for &drift in drifts {
            rows.extend(angles.values().map(|delta| measure(truth, u, -u * drift.tan(), 0.0, n, delta)));
        }
    }
    rows
}

/// Propeller runs with the rudder amidships: every rate \[rps\] at every speed \[m/s\].
pub fn propeller_runs(truth: &dyn Truth, speeds: Range, rates: Range) -> Vec<Row> {
    speeds.values().flat_map(|u| rates.values().map(move |n| measure(truth, u, 0.0, 0.0, n, 0.0))).collect()
}

/// Resistance R(u) = p1 u + p2 u^2 + p3 u^3 \[N\] by least squares over towing runs; R = -X of the hull.
///
/// None if the runs do not determine the three parameters (fewer than three different speeds).
pub fn fit_resistance(runs: &[Row]) -> Option<[f64; 3]> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    // Speeds relative to the largest, so that the normal equations are of order one.
    let top = runs.iter().map(|row| row.u.abs()).fold(0.0, f64::max);
    for row in runs {
        let s = row.u / top;
        let basis = Vector3::new(s, s * s, s * s * s);
        normal += basis * basis.transpose();
        right -= basis * row.force.hull.x;
    }
    let solution = normal.cholesky()?.solve(&right);
    let p = [solution[0] / top, solution[1] / (top * top), solution[2] / (top * top * top)];
    p.iter().all(|x| x.is_finite()).then_some(p)
}

/// Side force of the propeller over its effective thrust, p0 in Y_n = p0 X_n, by least squares over propeller runs.
///
/// None if no run has any thrust.
pub fn fit_side_force(runs: &[Row]) -> Option<f64> {
    let thrust = |row: &Row| row.force.propeller.x;
    let square: f64 = runs.iter().map(|row| thrust(row) * thrust(row)).sum();
    let product: f64 = runs.iter().map(|row| thrust(row) * row.force.propeller.y).sum();
    (square > 0.0).then(|| product / square)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::ships::{ship_a, ship_b};

    #[test]
    fn resistance_fit_recovers_a_cubic_and_refuses_two_speeds() {
        let mut runs = towing(&ship_b(), Range { from: 0.5, to: 6.0, count: 12 });
        for row in &mut runs {
            row.force.hull.x = -(5669.0 * row.u - 1127.0 * row.u.powi(2) + 538.0 * row.u.powi(3));
        }
        let p = fit_resistance(&runs).expect("twelve speeds determine a cubic");
        for (found, expected) in p.iter().zip([5669.0, -1127.0, 538.0]) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{found}");
        }
        assert_eq!(fit_resistance(&runs[..1]), None);
    }

    #[test]
    fn towed_resistance_is_a_pure_square_for_ship_b() {
        let p = fit_resistance(&towing(&ship_b(), Range { from: 0.5, to: 6.0, count: 12 })).expect("determined");
        let expected = ship_b().particulars.force_scale() * ship_b().hull.r0;
        assert!((p[1] / expected - 1.0).abs() < 1e-9 && p[0].abs() < 1e-3 && p[2].abs() < 1e-4, "{p:?}");
    }

    #[test]
    fn rudder_sweep_gives_odd_side_forces_on_a_straight_course() {
        let rows = rudder_sweep(&ship_a(), &[(4.0, 2.0)], &[0.0], Range { from: -0.6, to: 0.6, count: 13 });
        assert_eq!(rows.len(), 13);
        for (a, b) in rows.iter().zip(rows.iter().rev()) {
            assert!((a.force.rudder.y + b.force.rudder.y).abs() < 1e-6);
        }
        assert!(rows[12].force.rudder.y < 0.0 && rows[12].force.rudder.n > 0.0);
    }

    #[test]
    fn side_force_over_thrust_is_zero_ahead_and_positive_astern() {
        let ship = ship_a();
        let ahead =
            propeller_runs(&ship, Range { from: 0.0, to: 6.0, count: 7 }, Range { from: 1.0, to: 4.0, count: 4 });
        assert_eq!(fit_side_force(&ahead), Some(0.0));
        let astern =
            propeller_runs(&ship, Range { from: 0.0, to: 2.0, count: 3 }, Range { from: -4.0, to: -1.0, count: 4 });
        assert!(fit_side_force(&astern).expect("thrust astern") > 0.0);
    }
}
