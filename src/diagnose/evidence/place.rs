//! Whether an earth-fixed force differs from place to place: a force of its own in each part of the water that was sailed.
//! Weather is the same everywhere; a force that differs has another cause, which is not sought here.

use crate::diagnose::settings::{PLACE_PARTS, PLACE_TAIL};
use crate::likelihood::evidence::{Base, Evidence};
use crate::recording::Run;
use serde::Serialize;
use statrs::statistics::{Data, OrderStatistics};

/// A force fixed on the earth that differs between parts of the water.
#[derive(Clone, Debug, Serialize)]
pub struct Place {
    /// Southern and northern limit of the part where the force is most significant \[m\].
    pub north: [f64; 2],
    /// Western and eastern limit \[m\].
    pub east: [f64; 2],
    /// Force there, less what acts everywhere: north, east \[N\].
    pub force: [f64; 2],
    /// Standard errors.
    pub error: [f64; 2],
    /// Twice the gain in log-likelihood of a force of its own in each part over one that is the same everywhere.
    pub statistic: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// p-value.
    pub p: f64,
}

/// Parts of the water.
pub const PARTS: usize = PLACE_PARTS * PLACE_PARTS;

/// The water that was sailed, in parts.
pub struct Chart {
    low: [f64; 2],
    high: [f64; 2],
}

impl Chart {
    /// Of all measured positions but the outermost two per cent each way.
    pub fn of(runs: &[Run]) -> Option<Self> {
        let limits = |axis: usize| {
            let all = runs.iter().flat_map(|r| &r.measured).filter_map(|m| m[axis]);
            let mut all = Data::new(all.collect::<Vec<f64>>());
            (all.quantile(PLACE_TAIL), all.quantile(1.0 - PLACE_TAIL))
        };
        let ((south, north), (west, east)) = (limits(0), limits(1));
        (north > south && east > west).then_some(Self { low: [south, west], high: [north, east] })
    }

    /// Which part a position is in; the outermost parts reach as far as one likes.
    pub fn part(&self, position: [f64; 2]) -> usize {
        let [i, j]: [usize; 2] = std::array::from_fn(|a| {
            let share = (position[a] - self.low[a]) / (self.high[a] - self.low[a]);
            ((share * PLACE_PARTS as f64) as usize).min(PLACE_PARTS - 1)
        });
        i * PLACE_PARTS + j
    }

    /// Limits of a part along an axis.
    fn limits(&self, part: usize, axis: usize) -> [f64; 2] {
        let i = if axis == 0 { part / PLACE_PARTS } else { part % PLACE_PARTS } as f64;
        let width = (self.high[axis] - self.low[axis]) / PLACE_PARTS as f64;
        [self.low[axis] + i * width, self.low[axis] + (i + 1.0) * width]
    }
}

/// Tests whether an earth-fixed force differs between parts of the water. `first` is the first of the forces' columns, north and
/// east of each part and then of all water, and `unit` their scale \[N\].
pub fn place(chart: &Chart, evidence: &Evidence, base: &Base, first: usize, unit: f64) -> Option<Place> {
    let sailed =
        |part: &usize| (0..2).all(|i| evidence.total.information[(first + 2 * part + i, first + 2 * part + i)] > 1e-6);
    let parts: Vec<usize> = (0..PARTS).filter(sailed).collect();
    let own: Vec<usize> = parts.iter().flat_map(|part| [first + 2 * part, first + 2 * part + 1]).collect();
    // A force that is the same everywhere is weather.
    let weather = first + 2 * PARTS;
    let test = evidence.test(&evidence.extend(base, &[weather, weather + 1]), &own);
    let weight = |j: &usize| -> f64 {
        (2 * j..2 * j + 2).map(|i| test.amplitude[i].powi(2) / test.covariance[(i, i)].max(f64::MIN_POSITIVE)).sum()
    };
    let strongest = (0..parts.len()).max_by(|a, b| weight(a).total_cmp(&weight(b))).filter(|_| test.degrees > 0)?;
    let (part, at) = (parts[strongest], |i: usize| 2 * strongest + i);
    Some(Place {
        north: chart.limits(part, 0),
        east: chart.limits(part, 1),
        force: std::array::from_fn(|i| test.amplitude[at(i)] * unit),
        error: std::array::from_fn(|i| test.covariance[(at(i), at(i))].max(0.0).sqrt() * unit),
        statistic: test.statistic,
        degrees: test.degrees,
        p: test.p,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::evidence::RunEvidence;
    use nalgebra::{DMatrix, DVector};

    const CHART: Chart = Chart { low: [0.0, -300.0], high: [300.0, 0.0] };

    #[test]
    fn every_position_is_in_one_part_and_the_outermost_parts_have_no_end() {
        assert_eq!([[10.0, -290.0], [150.0, -150.0], [290.0, -10.0]].map(|p| CHART.part(p)), [0, 4, 8]);
        assert_eq!([[-1e6, -1e6], [1e6, 150.0]].map(|p| CHART.part(p)), [0, 8]);
        assert_eq!((CHART.limits(5, 0), CHART.limits(5, 1)), ([100.0, 200.0], [-100.0, 0.0]));
    }

    /// Forces north and east in nine parts and everywhere, known with information 25 in each part.
    fn evidence(force: impl Fn(usize) -> f64) -> Evidence {
        let n = 2 * PARTS + 2;
        let mut information = DMatrix::zeros(n, n);
        let mut score = DVector::zeros(n);
        for part in 0..PARTS {
            for (axis, f) in [(0, force(part)), (1, 0.0)] {
                let (own, all) = (2 * part + axis, 2 * PARTS + axis);
                for (i, j) in [(own, own), (own, all), (all, own), (all, all)] {
                    information[(i, j)] += 25.0;
                }
                score[own] += 25.0 * f;
                score[all] += 25.0 * f;
            }
        }
        Evidence::new(vec![RunEvidence { session: "a".into(), score, information }])
    }

    #[test]
    fn a_force_that_is_the_same_everywhere_is_no_place_and_one_in_a_part_is() -> Result<(), String> {
        let of = |force: &dyn Fn(usize) -> f64| {
            let e = evidence(force);
            place(&CHART, &e, &e.base(&[], &[], &[]), 0, 1.0).ok_or("no place")
        };
        let everywhere = of(&|_| 3.0)?;
        assert!(everywhere.statistic < 1e-9 && everywhere.degrees == 16, "{everywhere:?}");
        let there = of(&|part| if part == 5 { 3.0 } else { 0.0 })?;
        // 25 (3 - 1/3)^2 in the part and 8 * 25 (1/3)^2 in the others.
        assert!((there.statistic - 200.0).abs() < 1e-6 && there.p < 1e-20, "{there:?}");
        assert_eq!((there.north, there.east), (CHART.limits(5, 0), CHART.limits(5, 1)));
        Ok(())
    }
}
