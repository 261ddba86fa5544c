//! The likelihood of runs with the gains of the Kalman filter fixed, as a function of the free parameters: its value, the innovations
//! one by one, and exact derivatives. It estimates no parameter: the fit by likelihood does, and renews noise and gains on its way.

use super::cost::{Compared, Quadratic, Residuals, check};
use crate::fit::error::FitError;
use crate::likelihood::estimate::{fitted_noise, restrictions, run_evidence};
use crate::likelihood::evidence::RunEvidence;
use crate::likelihood::filter::{Column, Filter, Gains, Pass, Wanted};
use crate::likelihood::noise::fit::{KeptInformation, guess};
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::likelihood::parameters::{FreeParameter, base_parameters, uncertain_coefficients};
use crate::likelihood::settings::FIRST;
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;
use crate::state::STATES;
use nalgebra::{DMatrix, DVector};

/// Iterations of the noise estimate in a round.
pub(in crate::fit) const NOISE_ITERATIONS: usize = FIRST.noise_iterations;

/// Minus the log-likelihood of runs with the filter's gains fixed, up to a constant: half the sum of squared standardised innovations.
///
/// ```text
/// f(p) = 1/2 sum_k e_k^2 / s_k
/// ```
///
/// e_k is what a sensor reports less what the filter expects of it, and s_k its variance when the gains were made. What was an outlier then
/// is left out. Priors are not part of it. A fit with [`Goal::Likelihood`](crate::fit::Goal::Likelihood) minimises it with the priors of
/// [`with_uncertain_coefficients`], and makes noise ([`noise_at`]) and gains anew where it ends, until the
/// likelihood rises no more, and then gains alone, until this falls no more.
pub struct Innovations<'a> {
    model: &'a Model,
    runs: &'a [Run],
    integration: Integration,
    noise: Noise,
    gains: Vec<Gains>,
    /// The free parameters of the model that act in all runs, and what some sessions add to parameters: the variables, in this order.
    common: Vec<usize>,
    deviations: Vec<FreeParameter>,
    columns: Vec<Column>,
    /// The sessions in which each variable acts, `None` for all of them.
    sessions: Vec<Option<Vec<String>>>,
}

/// The model of a fit by likelihood: hull, propeller and rudder coefficients that are never known exactly are free too, with their own
/// priors or else with the model's values as means and the spreads of their terms as standard deviations.
pub fn with_uncertain_coefficients(model: &Model) -> Model {
    let mut model = model.clone();
    for i in uncertain_coefficients(&model) {
        if model.parameters[i].free {
            continue;
        }
        let prior = model.parameters[i].prior.or(FreeParameter::uncertain(&model, i).prior);
        let p = &mut model.parameters[i];
        // Whatever the prior says, no ship has a value beyond its bounds.
        (p.free, p.prior) = (true, prior);
    }
    model
}

/// The noise of runs by maximum likelihood with the free parameters of a model at `p`; its search begins `from` an earlier noise, or from a
/// guess of the recordings alone.
pub fn noise_at(model: &Model, runs: &[Run], integration: Integration, from: Option<&Noise>, p: &[f64]) -> Noise {
    let first = guess(runs, model);
    let at = model_at(model, &model.free(), &[], p);
    let (prior, kept) = (NoisePrior::around(&first), &mut KeptInformation::default());
    fitted_noise(&at, integration, runs, from.unwrap_or(&first), &prior, NOISE_ITERATIONS, kept)
}

/// A model with some parameters, and then what sessions add to parameters, at `p`.
pub(in crate::fit) fn model_at(model: &Model, common: &[usize], deviations: &[FreeParameter], p: &[f64]) -> Model {
    let mut model = model.clone();
    for (i, value) in common.iter().zip(p) {
        model.parameters[*i].value = *value;
    }
    for (deviation, value) in deviations.iter().zip(&p[common.len()..]) {
        deviation.set(&mut model, *value);
    }
    model
}

impl<'a> Innovations<'a> {
    /// Of the free parameters of a model, with the gains of the filter at `p`.
    ///
    /// # Errors
    /// No runs, nothing free, a run without samples or of unequal lengths, or a filter that leaves the numbers at `p`.
    pub fn new(
        model: &'a Model,
        runs: &'a [Run],
        integration: Integration,
        noise: Noise,
        p: &[f64],
    ) -> Result<Self, FitError> {
        runs.iter().try_for_each(|run| check(run, &[0.0; STATES]))?;
        let free = base_parameters(model, false);
        if runs.is_empty() {
            return Err(FitError::NoRuns);
        }
        if free.is_empty() {
            return Err(FitError::NothingFree);
        }
        let (all, passes) = Self::with_passes(model, runs, integration, &free, noise, p);
        for (run, pass) in runs.iter().zip(&passes) {
            if let Some(k) = pass.filtered.iter().position(|z| !z.iter().all(|z| z.is_finite())) {
                let time = run.start_time() + k as f64 * run.dt;
                return Err(FitError::Diverged { run: run.recording.clone(), time });
            }
        }
        Ok(all)
    }

    /// As [`Innovations::new`] of what was checked, by variables of which the last may act in some sessions only.
    #[cfg(feature = "ipopt")]
    pub(in crate::fit) fn of(
        model: &'a Model,
        runs: &'a [Run],
        integration: Integration,
        free: &[FreeParameter],
        noise: Noise,
        p: &[f64],
    ) -> Self {
        Self::with_passes(model, runs, integration, free, noise, p).0
    }

    /// With the passes from which the gains are.
    fn with_passes(
        model: &'a Model,
        runs: &'a [Run],
        integration: Integration,
        free: &[FreeParameter],
        noise: Noise,
        p: &[f64],
    ) -> (Self, Vec<Pass>) {
        let (common, deviations): (Vec<&FreeParameter>, Vec<&FreeParameter>) =
            free.iter().partition(|f| f.sessions.is_none());
        let mut all = Self {
            model,
            runs,
            integration,
            noise,
            gains: Vec::new(),
            common: common.into_iter().map(|f| f.column.parameter).collect(),
            deviations: deviations.into_iter().cloned().collect(),
            columns: free.iter().map(|f| f.column).collect(),
            sessions: restrictions(free),
        };
        let at = all.model_at(p);
        let filter = Filter::new(&at, integration, &[]);
        let mut passes = filter.passes(runs, &noise, Wanted { gains: true, ..Wanted::default() });
        all.gains = passes.iter_mut().map(|pass| pass.gains.take().unwrap_or_default()).collect();
        (all, passes)
    }

    /// Number of samples of all runs.
    #[cfg(feature = "ipopt")]
    pub(in crate::fit) fn samples(&self) -> usize {
        samples(self.runs)
    }

    fn model_at(&self, p: &[f64]) -> Model {
        model_at(self.model, &self.common, &self.deviations, p)
    }

    /// What each innovation of [`Innovations::residuals_at`] is of.
    pub fn compared(&self) -> Vec<Compared> {
        let mut all = Vec::new();
        for (run, gains) in self.gains.iter().enumerate() {
            for (sample, variance) in gains.variance.iter().enumerate() {
                let counts = |channel: &usize| variance[*channel].is_finite();
                all.extend((0..STATES).filter(counts).map(|channel| Compared { run, sample, channel }));
            }
        }
        all
    }

    /// Half the sum of squared innovations, and what `take` makes of each pass; `None` where the model left the numbers.
    fn passes(&self, p: &[f64], columns: &[Column], mut take: impl FnMut(DVector<f64>, DMatrix<f64>)) -> Option<f64> {
        let model = self.model_at(p);
        let filter = Filter::new(&model, self.integration, columns);
        let sessions = if columns.is_empty() { &[] } else { &self.sessions[..] };
        let wanted = Wanted { frozen: Some(&self.gains), exact: true, ..Wanted::default() };
        let work = |run: &Run, pass: Pass| {
            let finite = is_finite(&pass);
            let Pass { score, information, innovations, .. } = pass;
            let RunEvidence { score, information, .. } = run_evidence(run, score, information, sessions);
            let square: f64 = innovations.iter().flatten().filter(|e| !e.is_nan()).map(|e| e * e).sum();
            (0.5 * square, finite, score, information)
        };
        let (mut value, mut all_finite) = (0.0, true);
        filter.each(self.runs, &self.noise, wanted, work, |(square, finite, score, information)| {
            value += square;
            all_finite &= finite;
            take(score, information);
        });
        (all_finite && value.is_finite()).then_some(value)
    }

    /// The value at the free parameters `p`; `None` where the model leaves the numbers.
    pub fn value(&self, p: &[f64]) -> Option<f64> {
        self.passes(p, &[], |_, _| ())
    }

    /// The value with its gradient and the Fisher information, which is its Gauss-Newton matrix `J^T J`.
    pub fn quadratic(&self, p: &[f64]) -> Option<Quadratic> {
        let n = self.columns.len();
        let (mut gradient, mut information, mut by_run) = (DVector::zeros(n), DMatrix::zeros(n, n), Vec::new());
        // From the units of the columns to those of the variables.
        let units = DVector::from_iterator(n, self.columns.iter().map(|column| column.scale));
        let value = self.passes(p, &self.columns, |score, own| {
            let score = score.component_div(&units);
            gradient -= &score;
            information += own;
            by_run.push(-score);
        })?;
        information.component_div_assign(&(&units * units.transpose()));
        let finite = gradient.iter().chain(information.iter()).all(|v: &f64| v.is_finite());
        finite.then_some(Quadratic { value, gradient, gauss_newton: information, by_run })
    }

    /// For each run and each variable p_j, `[sum e de/dp_j, sum (de/dp_j)^2]` over the standardised innovations e of the run; `None` where the
    /// model leaves the numbers.
    #[cfg(feature = "ipopt")]
    pub(in crate::fit) fn scores_by_run(&self, p: &[f64]) -> Option<Vec<Vec<[f64; 2]>>> {
        let mut by_run = Vec::with_capacity(self.runs.len());
        self.passes(p, &self.columns, |score, information| {
            let of = |(j, column): (usize, &Column)| {
                [-score[j] / column.scale, information[(j, j)] / (column.scale * column.scale)]
            };
            by_run.push(self.columns.iter().enumerate().map(of).collect());
        })?;
        Some(by_run)
    }

    /// The standardised innovations e_k / sqrt(s_k), recorded less expected, run after run, sample after sample, channel after channel:
    /// half the sum of their squares is the value. `None` where the model leaves the numbers.
    pub fn residuals_at(&self, p: &[f64]) -> Option<Residuals> {
        self.one_by_one(p, &[])
    }

    /// As [`Innovations::residuals_at`], with their exact derivatives by the variables.
    pub fn jacobian_at(&self, p: &[f64]) -> Option<Residuals> {
        self.one_by_one(p, &self.columns)
    }

    fn one_by_one(&self, p: &[f64], columns: &[Column]) -> Option<Residuals> {
        let model = self.model_at(p);
        let filter = Filter::new(&model, self.integration, columns);
        let wanted =
            Wanted { frozen: Some(&self.gains), exact: true, slopes: !columns.is_empty(), ..Wanted::default() };
        let work = |run: &Run, pass: Pass| is_finite(&pass).then(|| self.of_pass(run, &pass, columns));
        let mut all = Some(Residuals::default());
        filter.each(self.runs, &self.noise, wanted, work, |own| {
            all = all.take().zip(own).map(|(mut all, own)| {
                all.values.extend(own.values);
                all.slopes.extend(own.slopes);
                all
            });
        });
        all.filter(|all| all.values.iter().chain(&all.slopes).all(|v| v.is_finite()))
    }

    /// The innovations of a pass, with their slopes by the variables where it has columns.
    fn of_pass(&self, run: &Run, pass: &Pass, columns: &[Column]) -> Residuals {
        let acts = |only: &Option<Vec<String>>| only.as_ref().is_none_or(|only| only.contains(&run.session));
        let unit =
            |(column, only): (&Column, &Option<Vec<String>>)| if acts(only) { column.scale.recip() } else { 0.0 };
        let units: Vec<f64> = columns.iter().zip(&self.sessions).map(unit).collect();
        let mut own = Residuals::default();
        for (k, innovations) in pass.innovations.iter().enumerate() {
            let slopes = if units.is_empty() { &[][..] } else { &pass.slopes[k * units.len()..(k + 1) * units.len()] };
            for j in (0..STATES).filter(|j| !innovations[*j].is_nan()) {
                own.values.push(innovations[j]);
                own.slopes.extend(slopes.iter().zip(&units).map(|(slope, unit)| slope[j] * unit));
            }
        }
        own
    }
}

/// Number of samples of some runs.
#[cfg(feature = "ipopt")]
pub(in crate::fit) fn samples(runs: &[Run]) -> usize {
    runs.iter().map(|run| run.measured.len()).sum()
}

/// Whether a filter stayed within the numbers: a model that left them has no innovations at all, and would look perfect.
fn is_finite(pass: &Pass) -> bool {
    pass.filtered.iter().flatten().all(|z| z.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, noise, runs};
    use crate::likelihood::settings::GATE;

    /// Runs with channels missing, an outlier, and parameters a little off.
    fn example() -> (Model, Vec<Run>, Vec<f64>) {
        let model = with_uncertain_coefficients(&model());
        let mut runs = runs(&model, 5);
        runs[1].measured[7][3] = Some(90.0);
        runs[2].measured.iter_mut().for_each(|m| m[5] = None);
        runs[3].dt = 2.0;
        let p = model.free().iter().map(|i| model.parameters[*i].value * 1.02).collect();
        (model, runs, p)
    }

    #[test]
    fn innovations_one_by_one_add_up_to_value_gradient_and_information() -> Result<(), FitError> {
        let (model, runs, p) = example();
        let all = Innovations::new(&model, &runs, RK4, noise(), &p)?;
        let moved: Vec<f64> = p.iter().map(|p| p * 1.001).collect();
        let none = || FitError::NothingFree;
        let (own, sums) = (all.jacobian_at(&moved).ok_or_else(none)?, all.quadratic(&moved).ok_or_else(none)?);
        let compared = all.compared();
        assert_eq!(own.values.len(), compared.len());
        assert_eq!(own.values.len(), all.residuals_at(&moved).ok_or_else(none)?.values.len());
        assert!(compared.iter().all(|c| runs[c.run].measured[c.sample][c.channel].is_some()));
        assert!(compared.iter().all(|c| (c.run, c.sample, c.channel) != (1, 7, 3)), "an outlier counts");
        assert!(own.values.iter().all(|e| e.abs() < 2.0 * GATE));
        let value = 0.5 * own.values.iter().map(|e| e * e).sum::<f64>();
        assert!((value - sums.value).abs() < 1e-10 * value);
        let n = p.len();
        for i in 0..n {
            let gradient: f64 = own.values.iter().zip(own.slopes.chunks(n)).map(|(e, row)| e * row[i]).sum();
            let size = (2.0 * value * sums.gauss_newton[(i, i)]).sqrt();
            assert!((gradient - sums.gradient[i]).abs() <= 1e-9 * size, "{i}: {gradient} {}", sums.gradient[i]);
            for j in 0..=i {
                let product: f64 = own.slopes.chunks(n).map(|row| row[i] * row[j]).sum();
                let size = (sums.gauss_newton[(i, i)] * sums.gauss_newton[(j, j)]).sqrt();
                assert!((product - sums.gauss_newton[(i, j)]).abs() <= 1e-9 * size, "{i} {j}");
            }
        }
        Ok(())
    }

    #[test]
    fn slopes_of_innovations_are_their_differences() -> Result<(), FitError> {
        let (model, runs, p) = example();
        let all = Innovations::new(&model, &runs, RK4, noise(), &p)?;
        let none = || FitError::NothingFree;
        let own = all.jacobian_at(&p).ok_or_else(none)?;
        for (j, i) in model.free().into_iter().enumerate() {
            let step = 1e-4 * model.parameters[i].scale;
            let at = |d: f64| {
                let mut p = p.clone();
                p[j] += d;
                all.residuals_at(&p).map(|own| own.values).ok_or_else(none)
            };
            let (above, below) = (at(step)?, at(-step)?);
            let rows = own.slopes.chunks(p.len());
            let worst = above.iter().zip(&below).zip(rows.clone());
            let worst = worst.map(|((a, b), row)| ((a - b) / (2.0 * step) - row[j]).abs()).fold(0.0, f64::max);
            let largest = rows.map(|row| row[j].abs()).fold(0.0, f64::max);
            assert!(worst <= 1e-4 * largest, "{}: {worst:e} of {largest:e}", model.parameters[i].name);
        }
        Ok(())
    }

    #[test]
    fn a_model_that_leaves_the_numbers_is_an_error_where_gains_are_made_and_no_value_elsewhere() -> Result<(), FitError>
    {
        let (model, runs, p) = example();
        let all = Innovations::new(&model, &runs, RK4, noise(), &p)?;
        let far: Vec<f64> = p.iter().map(|p| p * 1e12).collect();
        assert!(all.value(&far).is_none() && all.quadratic(&far).is_none() && all.jacobian_at(&far).is_none());
        let made = Innovations::new(&model, &runs, RK4, noise(), &far);
        assert!(matches!(made, Err(FitError::Diverged { .. })));
        Ok(())
    }
}
