//! The signal-to-noise ratio of an effect, and the size that gives a ratio asked for.
//! A [`Meter`] measures the ratio; the meter here works in force alone and needs no model.

use super::effects::effect::Entry;
use super::error::ConcealError;
use super::sailing::recorded::Recorded;
use super::sailing::sail::GUST_TIME;
use super::sailing::track::PERIOD;

/// Measures how visible an effect is: sqrt of the noncentrality of the best test for it, from recordings with and without it
/// that have the same ship, plans, gusts and noise.
pub trait Meter: Sync {
    /// The signal-to-noise ratio.
    ///
    /// # Errors
    /// [`ConcealError::Meter`] when it cannot be measured.
    fn snr(&self, effect: &Entry, with: &Recorded, without: &Recorded) -> Result<f64, ConcealError>;
}

/// A meter without a model: the effect's force against gusts of known strength, and its change of the reported states against
/// sensor noise within short windows. Nothing is projected out, so it is an upper bound, loose for what parameters can mimic.
#[derive(Debug, Clone, Copy)]
pub struct ForceMeter {
    /// Standard deviation of the force noise: X, Y \[N\], N \[N m\].
    pub gusts: [f64; 3],
    /// Standard deviation of the sensors, `[x, y, psi, u, v, r]`, SI.
    pub sensors: [f64; 6],
}

impl Default for ForceMeter {
    fn default() -> Self {
        let degree = std::f64::consts::PI / 180.0;
        Self { gusts: [800.0, 800.0, 24_000.0], sensors: [0.5, 0.5, 0.1 * degree, 0.04, 0.04, 0.02 * degree] }
    }
}

/// Rows over which the mean of a sensor defect is compared with the sensor noise: 20 s.
const WINDOW: usize = 10;

impl Meter for ForceMeter {
    /// sqrt(sum F^2 T/(2 tau sigma^2) + sum over windows of the mean square of the defect reported): a force compared with an
    /// Ornstein-Uhlenbeck process of time tau has one independent sample in 2 tau.
    fn snr(&self, _effect: &Entry, with: &Recorded, _without: &Recorded) -> Result<f64, ConcealError> {
        let mut sum = 0.0;
        for track in &with.tracks {
            let duration = track.truth.len() as f64 * PERIOD;
            for energy in &track.energy {
                for (e, sigma) in energy.iter().zip(self.gusts) {
                    sum += e * duration / (2.0 * GUST_TIME * sigma * sigma);
                }
            }
            for (reported, truth) in track.reported.chunks(WINDOW).zip(track.truth.chunks(WINDOW)) {
                for i in 0..6 {
                    let mean = reported.iter().zip(truth).map(|(y, s)| y[i] - s.to_array()[i]).sum::<f64>()
                        / reported.len().max(1) as f64;
                    sum += (mean / self.sensors[i]).powi(2);
                }
            }
        }
        Ok(sum.sqrt())
    }
}

/// The size at which `snr` gives `target`, within a tenth, and the ratio there; at most three secant steps from the default size.
/// An effect that is still weaker at its largest size stays at that size.
///
/// # Errors
/// [`ConcealError::Invisible`] when the default size cannot be seen at all, or what `snr` fails with.
pub fn solve(
    entry: &'static Entry,
    target: f64,
    snr: impl Fn(f64) -> Result<f64, ConcealError>,
) -> Result<(f64, f64), ConcealError> {
    let mut size = entry.size;
    let mut found = snr(size)?;
    if !(found.is_finite() && found > 1e-6) {
        return Err(ConcealError::Invisible { effect: entry.name, size, unit: entry.unit, snr: found });
    }
    // In logarithms: most ratios grow as a power of the size, at first taken as the first power.
    let mut power = 1.0;
    for _ in 0..3 {
        if (found / target - 1.0).abs() < 0.1 {
            break;
        }
        let next = (size * (target / found).powf(1.0 / power)).min(entry.most);
        if next == size {
            break;
        }
        let reached = snr(next)?;
        if !(reached.is_finite() && reached > 0.0) {
            break;
        }
        // A power far from 1 comes from rounding or saturation, and would overshoot.
        power = ((reached / found).ln() / (next / size).ln()).clamp(0.4, 3.0);
        (size, found) = (next, reached);
    }
    Ok((size, found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::effects::catalogue::find;

    #[test]
    fn size_is_found_for_linear_and_for_quadratic_effects() {
        let entry = find("current").unwrap();
        for (power, factor) in [(1.0, 40.0), (2.0, 500.0), (1.5, 90.0)] {
            for target in [3.0, 6.0, 12.0] {
                let (size, snr) = solve(entry, target, |s| Ok(factor * f64::powf(s, power))).unwrap();
                assert!((snr / target - 1.0).abs() < 0.1, "{snr} for {target}");
                assert_eq!(snr, factor * size.powf(power));
            }
        }
    }

    #[test]
    fn a_weak_effect_stops_at_its_largest_size() {
        let entry = find("sternway").unwrap();
        assert_eq!(solve(entry, 100.0, |s| Ok(2.0 * s)).unwrap(), (entry.most, 2.0 * entry.most));
    }

    #[test]
    fn an_invisible_effect_is_an_error_not_a_number() {
        let entry = find("rudder_offset").unwrap();
        assert!(matches!(solve(entry, 6.0, |_| Ok(0.0)), Err(ConcealError::Invisible { .. })));
    }
}
