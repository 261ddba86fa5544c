//! The residuals of a cost one by one, and their exact derivatives: what least-squares solvers outside the library ask for.
//! It adds nothing up; the sums of the solver inside are in `sums`.

use super::{Block, Blocks, Cost};
use crate::sensitivity::chain::StateSlope;
use crate::sensitivity::{Plain, Sensitivity};
use crate::state::STATES;

/// The residuals at a point, run after run, sample after sample, channel after channel; only what was measured and weighs.
///
/// They are scaled so that the sum of their squares is the cost: `r = W^(1/2) (xi_bar - xi) / sqrt(M)` for M runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Residuals {
    /// The residuals.
    pub values: Vec<f64>,
    /// Their derivatives by the free parameters, one row a residual; empty where they were not asked for.
    pub slopes: Vec<f64>,
}

impl Residuals {
    /// Room for so many residuals with so many derivatives each.
    fn of(residuals: usize, slopes: usize) -> Self {
        Self { values: Vec::with_capacity(residuals), slopes: Vec::with_capacity(residuals * slopes) }
    }
}

/// What one residual compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Compared {
    /// Index of the run.
    pub run: usize,
    /// Index of the sample in the run.
    pub sample: usize,
    /// Index of the channel in `[x, y, psi, u, v, r]`.
    pub channel: usize,
}

impl Cost<'_> {
    /// What each residual of [`Cost::residuals_at`] compares; `None` where a run cannot be read.
    pub fn compared(&self) -> Option<Vec<Compared>> {
        let mut all = Vec::with_capacity(self.residuals());
        for (run, weights) in self.weights.iter().enumerate() {
            let read = self.runs.get(run)?;
            for (sample, measured) in read.measured.iter().enumerate() {
                let counts = |c: &usize| weights[*c] > 0.0 && measured[*c].is_some();
                all.extend((0..STATES).filter(counts).map(|channel| Compared { run, sample, channel }));
            }
        }
        Some(all)
    }

    /// The residuals of this rank's runs at the free parameters `p`, or `None` where a simulation diverges.
    pub fn residuals_at(&self, p: &[f64]) -> Option<Residuals> {
        self.one_by_one(p, false)
    }

    /// As [`Cost::residuals_at`], with their derivatives by the free parameters: exact, wherever those of the cost come from.
    pub fn jacobian_at(&self, p: &[f64]) -> Option<Residuals> {
        self.one_by_one(p, true)
    }

    fn one_by_one(&self, p: &[f64], with_slopes: bool) -> Option<Residuals> {
        if self.lanes.is_empty() {
            self.one_by_one_over(&self.single, p, with_slopes)
        } else {
            self.one_by_one_over(&self.lanes, p, with_slopes)
        }
    }

    fn one_by_one_over<P: Plain>(&self, blocks: &Blocks<P>, p: &[f64], with_slopes: bool) -> Option<Residuals> {
        let by_run = self.by_run(blocks, |block| self.of_block(block, p, with_slopes))?;
        let mut all = Residuals::of(by_run.iter().map(|own| own.values.len()).sum(), self.slopes(with_slopes));
        for own in by_run {
            all.values.extend_from_slice(&own.values);
            all.slopes.extend_from_slice(&own.slopes);
        }
        Some(all)
    }

    /// What `work` makes of the runs of each block, in the order of the runs; `None` where it makes nothing of one.
    fn by_run<P: Plain, T: Send + Default>(
        &self,
        blocks: &Blocks<P>,
        work: impl Fn(&Block<P>) -> Option<Vec<T>> + Sync,
    ) -> Option<Vec<T>> {
        let mut by_run: Vec<T> = (0..self.runs.len()).map(|_| T::default()).collect();
        self.each(blocks, work, |runs, part| {
            for (run, own) in runs.iter().zip(part?) {
                by_run[*run] = own;
            }
            Some(())
        })?;
        Some(by_run)
    }

    /// For each run of this rank and each free parameter p_j, `[sum r dr/dp_j, sum (dr/dp_j)^2]` over the run's residuals r; `None` where a
    /// simulation diverges.
    #[cfg(feature = "ipopt")]
    pub(in crate::fit) fn scores_by_run(&self, p: &[f64]) -> Option<Vec<Vec<[f64; 2]>>> {
        if self.lanes.is_empty() { self.scores_over(&self.single, p) } else { self.scores_over(&self.lanes, p) }
    }

    #[cfg(feature = "ipopt")]
    fn scores_over<P: Plain>(&self, blocks: &Blocks<P>, p: &[f64]) -> Option<Vec<Vec<[f64; 2]>>> {
        let n = self.free().len();
        let sums = |own: &Residuals| {
            let mut sums = vec![[0.0; 2]; n];
            for (r, row) in own.values.iter().zip(own.slopes.chunks(n)) {
                for ([score, information], slope) in sums.iter_mut().zip(row) {
                    *score += r * slope;
                    *information += slope * slope;
                }
            }
            sums
        };
        self.by_run(blocks, |block| Some(self.of_block(block, p, true)?.iter().map(sums).collect()))
    }

    /// Derivatives of each residual.
    fn slopes(&self, with_slopes: bool) -> usize {
        if with_slopes { self.free().len() } else { 0 }
    }

    /// The residuals of each run of a block; `None` where one diverges.
    fn of_block<P: Plain>(&self, block: &Block<P>, p: &[f64], with_slopes: bool) -> Option<Vec<Residuals>> {
        let scale = (self.runs() as f64).sqrt().recip();
        let weighs = |lane: usize| block.root.iter().flatten().filter(|root| root.in_lane(lane) > 0.0).count();
        let room = |lane: usize| Residuals::of(weighs(lane), self.slopes(with_slopes));
        let mut lanes: Vec<Residuals> = (0..block.runs.len()).map(room).collect();
        let mut rows: Vec<[P; STATES]> = Vec::with_capacity(self.slopes(with_slopes));
        let mut fastest = 0.0_f64;
        let mut take = |k: usize, y: &[P; STATES], slopes: &[StateSlope<P>]| {
            let residuals = block.residuals(k, y);
            rows.clear();
            rows.extend(slopes.iter().map(|slope| block.row(k, slope)));
            for (lane, own) in lanes.iter_mut().enumerate() {
                if block.root[k][3].in_lane(lane) > 0.0 {
                    fastest = fastest.max(y[3].in_lane(lane).hypot(y[4].in_lane(lane)));
                }
                for c in (0..STATES).filter(|c| block.root[k][*c].in_lane(lane) > 0.0) {
                    own.values.push(scale * residuals[c].in_lane(lane));
                    own.slopes.extend(rows.iter().map(|row| scale * row[c].in_lane(lane)));
                }
            }
        };
        if with_slopes {
            let sensitivity = Sensitivity::new(self.dynamics(block, p), &self.columns, self.sensed);
            let (initial, channels) = (&block.initial, &block.channels);
            sensitivity.rollout(self.integration, block.dt, &block.inputs, initial, channels, take);
        } else {
            self.rollout(block, p, |k, y| take(k, y, &[]));
        }
        let finite = |own: &Residuals| own.values.iter().chain(&own.slopes).all(|v| v.is_finite());
        (fastest < self.limit && lanes.iter().all(finite)).then_some(lanes)
    }
}

#[cfg(test)]
mod tests {
    use crate::fit::FitSettings;
    use crate::fit::objectives::cost::{Cost, Derivatives};

    #[test]
    fn residuals_one_by_one_add_up_to_cost_gradient_and_gauss_newton() {
        let example = crate::study::demo::example().unwrap();
        for derivatives in [Derivatives::Lanes, Derivatives::NumDual] {
            let options = FitSettings { derivatives, ..FitSettings::default() }.cost_options();
            let cost = Cost::new(&example.model, &example.train, options).unwrap();
            let p: Vec<f64> = cost.free().iter().map(|i| example.model.parameters[*i].value).collect();
            let (all, sums) = (cost.jacobian_at(&p).unwrap(), cost.quadratic(&p).unwrap());
            let n = p.len();
            assert_eq!(all.values.len(), cost.residuals());
            assert_eq!(all.values.len(), cost.compared().unwrap().len());
            assert_eq!(all.slopes.len(), n * all.values.len());
            assert_eq!(all.values.len(), cost.residuals_at(&p).unwrap().values.len());
            let value: f64 = all.values.iter().map(|r| r * r).sum();
            assert!((value - sums.value).abs() < 1e-12 * sums.value);
            for i in 0..n {
                let gradient: f64 = all.values.iter().zip(all.slopes.chunks(n)).map(|(r, row)| 2.0 * r * row[i]).sum();
                let size = 2.0 * (value * sums.gauss_newton[(i, i)] / 2.0).sqrt();
                assert!((gradient - sums.gradient[i]).abs() < 1e-12 * size, "{gradient} {}", sums.gradient[i]);
                for j in 0..n {
                    let product: f64 = all.slopes.chunks(n).map(|row| 2.0 * row[i] * row[j]).sum();
                    let size = (sums.gauss_newton[(i, i)] * sums.gauss_newton[(j, j)]).sqrt();
                    assert!((product - sums.gauss_newton[(i, j)]).abs() < 1e-12 * size);
                }
            }
        }
    }

    #[test]
    fn what_a_residual_compares_is_where_its_value_was_measured() {
        let example = crate::study::demo::example().unwrap();
        let mut runs = example.train[..3].to_vec();
        runs[1].measured.iter_mut().for_each(|m| m[4] = None);
        runs[2].measured[7][0] = None;
        let cost = Cost::new(&example.model, &runs, FitSettings::default().cost_options()).unwrap();
        let compared = cost.compared().unwrap();
        assert!(compared.iter().all(|c| runs[c.run].measured[c.sample][c.channel].is_some()));
        let p: Vec<f64> = cost.free().iter().map(|i| example.model.parameters[*i].value).collect();
        assert_eq!(cost.residuals_at(&p).unwrap().values.len(), compared.len());
    }
}
