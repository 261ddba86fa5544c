//! Corrections of sensors before a diagnosis: repeated positions, jumps of the receiver, delay and bias of the gyro.
//! Their sizes are read from the recordings' own kinematics; no model is used.

use trimtab::recording::{Channel, Recording, Run};

use super::agreement::wrapped;

/// Corrections of a recording's sensors, derived from its own kinematics before any model is used.
#[derive(Clone, Debug, Default)]
pub struct Mend {
    /// Leave out the velocities, which are late or derived from positions.
    pub no_velocity: bool,
    /// Times in which position and heading were repeated, not measured \[s\].
    pub held: Vec<(f64, f64)>,
    /// Delay of the yaw rate \[s\].
    pub rate_delay: f64,
    /// Bias of the yaw rate \[rad/s\].
    pub rate_bias: f64,
    /// Times at which position or heading jump: windows over them are left out \[s\].
    pub jumps: Vec<f64>,
}

impl Mend {
    /// The run with the gyro corrected and without samples that were not measured; `None` if the receiver jumped.
    pub fn applied(&self, run: &Run) -> Option<Run> {
        let (first, last) = (run.inputs.first()?.t, run.inputs.last()?.t);
        if self.jumps.iter().any(|t| first <= *t && *t <= last) {
            return None;
        }
        let mut out = run.clone();
        for k in 0..run.measured.len() {
            let t = run.inputs[k].t;
            // A sample is the mean of the rows within half a sample period.
            if self.held.iter().any(|(a, b)| a - 0.5 * run.dt <= t && t <= b + 0.5 * run.dt) {
                out.measured[k][..3].fill(None);
            }
            if self.no_velocity {
                out.measured[k][3..5].fill(None);
            }
            let rate = interpolated(run, 5, k as f64 + self.rate_delay / run.dt);
            out.measured[k][5] = rate.map(|r| r - self.rate_bias);
        }
        Some(out)
    }
}

/// A channel between two samples; `None` outside the run, and beside a missing value.
fn interpolated(run: &Run, channel: usize, place: f64) -> Option<f64> {
    let (i, share) = (place.floor(), place - place.floor());
    let value = |i: f64| if i < 0.0 { None } else { run.measured.get(i as usize)?[channel] };
    if share == 0.0 { value(i) } else { Some((1.0 - share) * value(i)? + share * value(i + 1.0)?) }
}

/// Stretches in which position and heading repeat to the last bit for `rows` rows or more: a receiver that repeats its last value.
/// A stretch begins with the first repetition.
pub fn held(recording: &Recording, rows: usize) -> Vec<(f64, f64)> {
    let [t, x, y, psi] = position(recording);
    let repeats = |k: usize| k > 0 && x[k] == x[k - 1] && y[k] == y[k - 1] && psi[k] == psi[k - 1];
    let mut out = Vec::new();
    let mut k = 1;
    while k < x.len() {
        let from = k;
        while k < x.len() && repeats(k) {
            k += 1;
        }
        if k - from >= rows.max(1) {
            out.push((t[from], t[k - 1]));
        }
        k += 1;
    }
    out
}

/// Times at which position or heading move faster than a ship can \[m/s, rad/s\] since they last changed: jumps of the
/// receiver.
pub fn jumps(recording: &Recording, fastest: f64, fastest_turn: f64) -> Vec<f64> {
    let [t, x, y, psi] = position(recording);
    let mut changed = 0;
    let mut out = Vec::new();
    for k in 1..x.len() {
        let (dx, dy, turn) = (x[k] - x[k - 1], y[k] - y[k - 1], wrapped(psi[k] - psi[k - 1]).abs());
        if dx == 0.0 && dy == 0.0 && turn == 0.0 {
            continue;
        }
        let since = t[k] - t[changed];
        if dx.hypot(dy) > fastest * since || turn > fastest_turn * since {
            out.push(t[k]);
        }
        changed = k;
    }
    out
}

/// Time, position and heading; empty where one was not recorded.
fn position(recording: &Recording) -> [&[f64]; 4] {
    let channels = [Channel::T, Channel::X, Channel::Y, Channel::Psi].map(|c| recording.get(c).unwrap_or_default());
    if channels.iter().any(|c| c.is_empty()) { [&[]; 4] } else { channels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::agreement::tests::circle;

    #[test]
    fn repeated_values_and_jumps_of_a_receiver_are_distinguished() {
        let good = circle(0.0, 0.0, 0.0, 0.0);
        assert!(held(&good, 2).is_empty() && jumps(&good, 1.5, 0.5).is_empty());
        let broken = |edit: &dyn Fn(&mut [Vec<f64>; 3])| {
            let mut place = [Channel::X, Channel::Y, Channel::Psi].map(|c| good.get(c).unwrap().to_vec());
            edit(&mut place);
            let others = good.channels().filter(|(c, _)| ![Channel::X, Channel::Y, Channel::Psi].contains(c));
            let mut channels: Vec<(Channel, Vec<f64>)> = others.map(|(c, v)| (c, v.to_vec())).collect();
            let [x, y, psi] = place;
            channels.extend([(Channel::X, x), (Channel::Y, y), (Channel::Psi, psi)]);
            Recording::from_channels("broken", channels).unwrap()
        };
        let holding = broken(&|p| p.iter_mut().for_each(|c| (101..110).for_each(|k| c[k] = c[100])));
        let stretches = held(&holding, 2);
        assert_eq!(stretches.len(), 1);
        assert!((stretches[0].0 - 10.1).abs() < 1e-9 && (stretches[0].1 - 10.9).abs() < 1e-9, "{stretches:?}");
        assert!(jumps(&holding, 1.5, 0.5).is_empty(), "the catching up is no faster than the ship could sail");
        let jumping = broken(&|p| p[0][700..].iter_mut().for_each(|x| *x += 0.4));
        assert_eq!(jumps(&jumping, 1.5, 0.5).len(), 1);
        assert!(held(&jumping, 2).is_empty());
    }
}
