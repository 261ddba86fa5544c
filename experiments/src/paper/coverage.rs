//! The coverage of a data set: smallest, largest and mean value of each channel, ours and as the paper prints them in Table 1.
//! It makes no data and no table.

use crate::truth::dataset::{Run, Split};
use crate::truth::ships::ShipId;

/// Smallest, largest and mean value of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Mean over all rows of all runs; None where the paper prints none.
    pub mean: Option<f64>,
}

/// The channels of the paper's Table 1, in its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Surge velocity \[m/s\].
    pub u: Spread,
    /// Sway velocity \[m/s\].
    pub v: Spread,
    /// Yaw rate \[rad/s\].
    pub r: Spread,
    /// Propeller rate \[rpm\].
    pub n: Spread,
    /// Rudder angle \[deg\].
    pub delta: Spread,
}

impl Statistics {
    /// Name, unit and spread of each channel, in the order of the paper.
    pub fn channels(&self) -> [(&'static str, &'static str, Spread); 5] {
        [
            ("u", "m/s", self.u),
            ("v", "m/s", self.v),
            ("r", "rad/s", self.r),
            ("n", "rpm", self.n),
            ("delta", "deg", self.delta),
        ]
    }
}

/// Statistics over all rows of the runs of one part; None if it has no runs.
pub fn statistics(runs: &[Run], split: Split) -> Option<Statistics> {
    let part: Vec<&Run> = runs.iter().filter(|run| run.split == split).collect();
    let spread = |channel: &dyn Fn(&Run, usize) -> f64| {
        let (mut min, mut max, mut sum, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0_usize);
        for run in &part {
            for i in 0..run.t.len() {
                let value = channel(run, i);
                (min, max, sum, count) = (min.min(value), max.max(value), sum + value, count + 1);
            }
        }
        (count > 0).then(|| Spread { min, max, mean: Some(sum / count as f64) })
    };
    Some(Statistics {
        u: spread(&|run, i| run.state[i][3])?,
        v: spread(&|run, i| run.state[i][4])?,
        r: spread(&|run, i| run.state[i][5])?,
        n: spread(&|run, i| 60.0 * run.n[i])?,
        delta: spread(&|run, i| run.delta[i].to_degrees())?,
    })
}

/// Table 1 of the paper (arXiv 2502.18696), whose data sets ours replace.
pub fn printed_statistics(ship: ShipId, split: Split) -> Statistics {
    let spread = |min, max, mean| Spread { min, max, mean };
    let [u, v, r, n, delta] = match (ship, split) {
        (ShipId::A, Split::Train) => [
            spread(-4.47, 8.23, Some(3.27)),
            spread(-2.05, 1.76, None),
            spread(-0.03, 0.03, None),
            spread(-249.1, 249.4, Some(95.0)),
            spread(-32.5, 33.5, Some(1.2)),
        ],
        (ShipId::A, Split::Test) => [
            spread(1.47, 7.38, Some(4.0)),
            spread(-1.74, 1.76, None),
            spread(-0.03, 0.03, None),
            spread(-129.4, 245.9, Some(129.1)),
            spread(-26.9, 27.9, None),
        ],
        (ShipId::B, Split::Train) => [
            spread(-0.47, 6.17, Some(3.83)),
            spread(-1.04, 1.03, None),
            spread(-0.02, 0.02, None),
            spread(-158.8, 169.7, Some(93.3)),
            spread(-40.0, 40.0, Some(-1.0)),
        ],
        (ShipId::B, Split::Test) => [
            spread(0.1, 5.45, Some(3.71)),
            spread(-0.57, 0.54, None),
            spread(-0.01, 0.01, None),
            spread(-98.9, 168.8, Some(88.8)),
            spread(-39.5, 32.6, None),
        ],
    };
    Statistics { u, v, r, n, delta }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::dataset::{SEED, dataset};

    #[test]
    fn training_statistics_are_near_the_paper_s() {
        for ship in [ShipId::A, ShipId::B] {
            let ours = statistics(&dataset(ship, SEED), Split::Train).expect("there are training runs");
            let paper = printed_statistics(ship, Split::Train);
            for ((name, unit, ours), (_, _, paper)) in ours.channels().into_iter().zip(paper.channels()) {
                let range = paper.max - paper.min;
                let near = |a: f64, b: f64, share: f64| (a - b).abs() <= share * range;
                assert!(near(ours.min, paper.min, 0.25), "{ship:?} min {name} {} {unit}", ours.min);
                assert!(near(ours.max, paper.max, 0.25), "{ship:?} max {name} {} {unit}", ours.max);
                if let (Some(ours), Some(paper)) = (ours.mean, paper.mean) {
                    assert!(near(ours, paper, 0.10), "{ship:?} mean {name} {ours} {unit}");
                }
            }
        }
    }
}
