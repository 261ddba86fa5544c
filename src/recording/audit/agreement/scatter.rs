//! How velocities scatter from row to row: a sensor has the same noise in every run, so that a run in another unit stands out by it.
//! It also serves on a straight course, where a comparison of a velocity with the other channels is lost in noise.

use crate::numerals::sig;
use crate::recording::audit::issue::{Issue, Severity, Shared};
use crate::recording::audit::limits::{ENOUGH, POOLED_RUNS, SCATTER_ALIKE, SCATTER_SAME};
use crate::recording::audit::motion::sources::Sources;
use crate::recording::{Channel, Recording};
use crate::statistics::median;
use serde::{Deserialize, Serialize};

/// Channels that are compared, and the factors between their units: km/h and m/s. Knots are too near to m/s: gusts and waves may do as much.
const ASKED: [Channel; 2] = [Channel::U, Channel::V];
const FACTORS: [f64; 2] = [3.6, 1.0 / 3.6];

/// Scatter of the velocities of a run \[m/s\]; `None` where a channel was not recorded, or is too coarse or too short for an estimate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scatter([Option<f64>; 2]);

impl Scatter {
    /// That of a recording: standard deviation of what is left of three successive values less their line, by its median size,
    /// `1.48 |v_(i-1) - 2 v_i + v_(i+1)| / sqrt(6)`.
    pub fn of(recording: &Recording) -> Self {
        let of = |channel: Channel| {
            let values = recording.get(channel).filter(|_| !recording.derived().contains(&channel))?;
            let bends = values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]).abs());
            let bends: Vec<f64> = bends.filter(|b| b.is_finite()).collect();
            let usual = median(bends.iter().copied()).filter(|_| bends.len() >= ENOUGH)?;
            (usual > 0.0).then(|| 1.4826 * usual / 6.0_f64.sqrt())
        };
        Self(ASKED.map(of))
    }
}

/// Velocities of single runs that scatter by the factor between two units as much as those of all other runs, which scatter alike.
pub fn scatters(runs: &[(&str, Scatter)], sources: &Sources) -> Vec<Shared> {
    let mut found = Vec::new();
    for (at, channel) in ASKED.into_iter().enumerate() {
        let values = sources.medians(&runs.iter().map(|(_, s)| s.0[at]).collect::<Vec<_>>());
        // A fault of a recording is reported for the first of its runs.
        let first = |run: usize| sources.beside(run).find(|other| values[*other].is_some()) == Some(run);
        let of = |run: usize| Some((runs[run].0, values[run].filter(|_| first(run))?));
        let known: Vec<(&str, f64)> = (0..runs.len()).filter_map(of).collect();
        let Some(usual) = median(known.iter().map(|(_, s)| *s)).filter(|_| known.len() > POOLED_RUNS) else { continue };
        let apart = |s: f64, than: f64| (s / than).max(than / s);
        let unlike: Vec<&(&str, f64)> = known.iter().filter(|(_, s)| apart(*s, usual) > SCATTER_ALIKE).collect();
        let [(run, scatter)] = unlike[..] else { continue };
        let ratio = scatter / usual;
        if FACTORS.iter().any(|f| apart(ratio, *f) < SCATTER_SAME) {
            let text = format!(
                "scatters {} times as much from row to row as in the other runs, which are alike",
                sig(ratio, 2)
            );
            let next = format!(
                "is its unit that of the other runs? set `unit` for `{channel}` in a column map of this run, or look for a filter"
            );
            let issue = Issue::new(Severity::Warning, "unit_error", text, next).of(channel);
            found.push(Shared { runs: vec![(*run).to_owned()], issue });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::audit::example::noise;

    /// Eight runs that sail straight on; v of the first is recorded so many times too large.
    fn study(factor: f64, of_each: impl Fn(u32) -> f64) -> Vec<Shared> {
        let run = |seed: u32| {
            let mut noise = noise(seed);
            let scale = of_each(seed) * if seed == 1 { factor } else { 1.0 };
            let v: Vec<f64> = (0..150).map(|_| scale * 0.1 * noise()).collect();
            let t = (0..150).map(f64::from).collect();
            let columns = vec![(Channel::T, t), (Channel::U, vec![4.0; 150]), (Channel::V, v)];
            Scatter::of(&Recording::from_channels("run", columns).unwrap())
        };
        let runs: Vec<(String, Scatter)> = (1..9).map(|i| (format!("r{i}"), run(i))).collect();
        scatters(&runs.iter().map(|(name, s)| (name.as_str(), *s)).collect::<Vec<_>>(), &Sources::of(0..8))
    }

    #[test]
    fn noise_of_another_unit_is_reported_where_the_other_runs_are_alike() {
        for factor in [3.6, 1.0 / 3.6] {
            let found = study(factor, |_| 1.0);
            assert!(found.len() == 1 && found[0].runs == ["r1"], "{factor}: {found:?}");
            assert_eq!(found[0].issue.channel, Some(Channel::V));
        }
        assert_eq!(study(1.0, |_| 1.0), []);
        assert_eq!(study(12.0, |_| 1.0), []);
        assert_eq!(study(3.6, |seed| 1.0 + 0.3 * f64::from(seed)), []);
    }
}
