//! An extended Kalman filter whose innovations carry exact, predictable sensitivities to any number of parameters.
//! It has no part in mechanisms or verdicts: it turns a run into a log-likelihood, a score vector and an information matrix.
//!
//! State: `[x y psi u v r | w_X w_Y w_N | e_1 .. e_6]`, the ship, an unknown force as three Ornstein-Uhlenbeck processes, and
//! the coloured part of six sensors. The sensitivities follow the filter with its gains fixed,
//! `d_k = H D_k + dh/dp`, `D_{k+1} = F_k (D_k - G_k d_k) + df/dp`, so that `d_k` depends on the past alone and
//! `g = sum d_k' S_k^-1 e_k` is a martingale: unbiased at the truth whatever is left out of `d_k`.

use super::directions::Directions;
use super::noise::Noise;
pub use super::pass::{Column, ForceBasis, GATE, Gains, Pass, Tangent, Wanted, boost};
use super::settings::TOGETHER;
use super::side_by_side;
use crate::model::Model;
use crate::physics::Lanes;
use crate::recording::Run;
use crate::sensitivity::Plain;
use crate::simulate::Integration;
use rayon::prelude::*;
use std::borrow::Borrow;

/// A model prepared for passes over many runs with the same columns.
pub struct Filter<'a> {
    directions: Directions<'a>,
}

impl<'a> Filter<'a> {
    /// Prepares passes with these columns; terms at neutral values that no column needs are left out.
    pub fn new(model: &'a Model, integration: Integration, columns: &[Column]) -> Self {
        Self { directions: Directions::new(model, integration, columns) }
    }

    /// A pass over one run, which has index 0 for what is wanted by run. It has the figures of [`Self::passes`] to rounding.
    pub fn pass(&self, run: &Run, noise: &Noise, wanted: Wanted) -> Pass {
        side_by_side::passes::<f64>(&self.directions, &[(0, run)], noise, &wanted).remove(0)
    }

    /// A pass over each run, in their order; for what does not need all passes at once there is [`Self::each`].
    pub fn passes<R: Borrow<Run> + Sync>(&self, runs: &[R], noise: &Noise, wanted: Wanted) -> Vec<Pass> {
        let mut passes = Vec::with_capacity(runs.len());
        self.each(runs, noise, wanted, |_, pass| pass, |pass| passes.push(pass));
        passes
    }

    /// A pass over each run, up to four that follow each other with one sample period side by side. What `work` makes of the pass of
    /// a run goes to `take` in the order of the runs, so that sums have the same bits on any number of threads; no more of it is
    /// in memory at once than a few runs give.
    pub fn each<R: Borrow<Run> + Sync, T: Send>(
        &self,
        runs: &[R],
        noise: &Noise,
        wanted: Wanted,
        work: impl Fn(&Run, Pass) -> T + Sync,
        mut take: impl FnMut(T),
    ) {
        let indexed: Vec<(usize, &Run)> = runs.iter().map(Borrow::borrow).enumerate().collect();
        let alike = indexed.chunk_by(|(_, a), (_, b)| a.dt == b.dt);
        let blocks: Vec<&[(usize, &Run)]> = alike.flat_map(|alike| alike.chunks(Lanes::WIDTH)).collect();
        let pass = |block: &&[(usize, &Run)]| -> Vec<T> {
            let passes = side_by_side::passes::<Lanes>(&self.directions, block, noise, &wanted);
            block.iter().zip(passes).map(|((_, run), pass)| work(run, pass)).collect()
        };
        for some in blocks.chunks(TOGETHER.div_ceil(Lanes::WIDTH) * rayon::current_num_threads()) {
            let done: Vec<Vec<T>> = some.par_iter().map(pass).collect();
            done.into_iter().flatten().for_each(&mut take);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::{append, candidates};
    use crate::diagnose::example::{RK4, column, craft, craft_run, model, noise, runs, with};
    use crate::likelihood::noise::SensorNoise;
    use crate::simulate::Method;
    use crate::state::STATES;

    /// Runs of two sample periods and several lengths, with channels missing, an outlier and a disturbed span.
    fn uneven() -> Vec<Run> {
        let mut runs = runs(&model(), 7);
        for (i, run) in runs.iter_mut().enumerate() {
            run.inputs.truncate(60 - 5 * i);
            run.measured.truncate(60 - 5 * i);
            run.measured.iter_mut().skip(3).step_by(3 + i).for_each(|m| m[i % STATES] = None);
        }
        runs[1].measured[7][3] = Some(90.0);
        runs[2].disturbed.push((10, 14));
        runs[3].dt = 2.0;
        runs[5].dt = 2.0;
        runs
    }

    fn assert_near(a: f64, b: f64, size: f64, what: &str) {
        assert!((a - b).abs() <= 1e-8 * size, "{what}: {a:e} beside others, {b:e} alone");
    }

    fn assert_alike(all: &Pass, one: &Pass, name: &str) {
        assert_eq!((all.used, all.outliers), (one.used, one.outliers), "{name}");
        assert_near(all.log_likelihood, one.log_likelihood, one.log_likelihood.abs(), name);
        for (c, score) in all.score.iter().enumerate() {
            let h = one.information[(c, c)];
            assert_near(*score, one.score[c], h.sqrt() + one.score[c].abs(), &format!("{name}, score {c}"));
            for l in 0..=c {
                let size = (h * one.information[(l, l)]).sqrt() + 1e-300;
                assert_near(all.information[(c, l)], one.information[(c, l)], size, &format!("{name}, {c} {l}"));
            }
        }
        assert_eq!(all.innovations.len(), one.innovations.len());
        for (a, b) in all.innovations.iter().flatten().zip(one.innovations.iter().flatten()) {
            assert_eq!(a.is_nan(), b.is_nan(), "{name}");
            assert!(a.is_nan() || (a - b).abs() < 1e-8 * b.abs().max(1.0), "{name}: {a} {b}");
        }
        let gains = |pass: &Pass| pass.gains.clone().unwrap_or_default().gain.concat().concat();
        assert_eq!(gains(all).len(), gains(one).len());
        assert!(gains(all).iter().zip(gains(one)).all(|(a, b)| (a - b).abs() < 1e-8 * b.abs().max(1.0)), "{name}");
    }

    #[test]
    fn a_named_actuator_pushes_at_its_defaults_as_it_does_next_to_them() {
        let model = craft();
        let run = craft_run(&model);
        let small = |s: SensorNoise| SensorNoise { white: 0.01 * s.white, coloured: 0.01 * s.coloured, ..s };
        let noise = Noise { sensors: noise().sensors.map(small), force: [0.1, 0.1, 0.02], ..noise() };
        let likelihood = |gain: f64| {
            let mut model = model.clone();
            for name in ["left.gain", "right.gain", "tau.gain_x", "tau.gain_y", "tau.gain_n"] {
                let i = model.find(name).unwrap();
                model.parameters[i].value *= gain;
            }
            Filter::new(&model, RK4, &[]).pass(&run, &noise, Wanted::default()).log_likelihood
        };
        let (at, near, far) = (likelihood(1.0), likelihood(1.0 + 1e-9), likelihood(0.0));
        assert!((at - near).abs() < 1e-3 && at - far > 1.0, "{at} {near} {far}");
    }

    #[test]
    fn runs_side_by_side_have_the_passes_that_each_has_alone() {
        // A current, and a log that reads wrong: a term that drives the flow and a term of a sensor.
        let m = with(&[("current.north", 0.1), ("log_scale.error", 0.02)]);
        let mut columns: Vec<Column> =
            ["rudder.lift1", "hull.Xudot", "flow.wake", "hull.Nr"].map(|name| column(&m, name)).into();
        append(&mut columns, &candidates(&m, &[]));
        let (runs, noise) = (uneven(), noise());
        let euler = Integration { method: Method::Euler, substeps: 2 };
        for (integration, exact) in [(RK4, false), (RK4, true), (euler, true), (euler, false)] {
            let filter = Filter::new(&m, integration, &columns);
            let wanted = Wanted { tangent: true, gains: true, exact, ..Wanted::default() };
            let passes = filter.passes(&runs, &noise, wanted);
            assert!(passes.iter().map(|pass| pass.outliers).sum::<usize>() > 0);
            for (run, pass) in runs.iter().zip(&passes) {
                assert_alike(pass, &filter.pass(run, &noise, wanted), &run.name);
                let tangent = pass.tangent.as_ref().map_or([0; 2], |t| [t.a.len(), t.offset.len()]);
                assert_eq!(tangent, [run.measured.len() - 1, run.measured.len()]);
            }
        }
    }

    #[test]
    fn gains_that_are_given_belong_to_their_runs() {
        let (m, runs, noise) = (model(), uneven(), noise());
        let filter = Filter::new(&m, RK4, &[column(&m, "rudder.lift1")]);
        let first = filter.passes(&runs, &noise, Wanted { gains: true, ..Wanted::default() });
        let gains: Vec<Gains> = first.iter().filter_map(|pass| pass.gains.clone()).collect();
        let again = filter.passes(&runs, &noise, Wanted { frozen: Some(&gains), ..Wanted::default() });
        for (a, b) in again.iter().zip(&first) {
            assert_eq!((a.used, a.outliers), (b.used, 0));
            assert_near(a.score[0], b.score[0], b.information[(0, 0)].sqrt(), "score");
        }
    }
}
