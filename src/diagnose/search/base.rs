//! The base model: what is free in it, and its fit to recordings that were audited, with parameters and noise.
//! What physics it lacks is tested elsewhere; here recordings and integration step are audited.

use super::decide::is_euler;
use super::problem::Problem;
use crate::diagnose::evidence::admit::{Admission, admit, followed};
use crate::diagnose::settings::{
    EULER_EXACT, EULER_HOPELESS, Effort, FIRST, LEFT_TO_GAIN, LOSS_ROUNDS, REFIT, SETTLE, Settings,
};
use crate::fit::backwards::{Estimated, backwards, unequal};
use crate::likelihood::estimate::{Estimate, estimate, left_to_gain, log_posterior, passes};
use crate::likelihood::noise::fit::{guess, little_force};
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::likelihood::parameters::base_parameters;
use crate::model::{Model, ModelError};
use crate::recording::audit::{Issue, Severity, settled};
use crate::recording::{Measured, Run};
use crate::simulate::{Integration, Method};
use std::borrow::Cow;

/// The inputs that all steps of a diagnosis share.
pub struct Question<'a> {
    /// The model as the user gave it.
    pub model: &'a Model,
    /// The user's model with every term of the catalogue at its neutral value.
    pub full: Model,
    /// The user's settings.
    pub settings: &'a Settings,
    /// Receives the name of each step.
    pub progress: &'a (dyn Fn(&str) + Sync),
}

impl<'a> Question<'a> {
    /// Adds the catalogue's terms to the user's model.
    ///
    /// # Errors
    /// When they cannot be added (a singular mass matrix, for instance).
    pub fn new(
        model: &'a Model,
        settings: &'a Settings,
        progress: &'a (dyn Fn(&str) + Sync),
    ) -> Result<Self, ModelError> {
        Ok(Self { model, full: model.complete()?, settings, progress })
    }
}

/// Recordings without the faults of their receivers.
pub struct AuditedRuns {
    /// Runs to locate, name and model with.
    pub runs: Vec<Run>,
    /// What was mended in them.
    pub issues: Vec<Issue>,
}

impl AuditedRuns {
    /// Parts runs where positions jump and leaves out what was not measured; `length` is that of the ship \[m\].
    pub fn new<'r>(runs: impl Into<Cow<'r, [Run]>>, length: f64) -> Self {
        let (runs, issues) = settled(runs, length);
        Self { runs, issues }
    }
}

/// The base model fitted to audited runs.
pub struct BaseFit {
    /// Its estimate.
    pub estimate: Estimate,
    /// The same within bounds and constraints, where it is known.
    pub within: Option<Estimate>,
    /// The prior of every noise estimate.
    pub prior: NoisePrior,
    /// The runs, without what the filter cannot follow.
    pub runs: Vec<Run>,
    /// How steps are integrated.
    pub integration: Integration,
    /// The audit of runs and integration.
    pub admission: Admission,
}

impl BaseFit {
    /// Fits parameters and noise, leaves out what the filter cannot follow, and audits recordings and integration step.
    pub fn new(question: &Question, audited: AuditedRuns) -> Self {
        let AuditedRuns { runs: mut kept, mut issues } = audited;
        let integration = question.settings.integration();
        (question.progress)("estimating parameters and noise of the base model");
        let free = base_parameters(&question.full, question.settings.nuisance);
        let first_noise = guess(&kept, &question.full);
        let prior = NoisePrior::around(&first_noise);
        let fit = |runs: &[Run]| {
            let from = |noise: &Noise| estimate(&question.full, integration, runs, &free, noise, &prior, FIRST);
            let density = |e: &Estimate| e.log_posterior + prior.log_density(&e.noise.to_log());
            let [first, second] = [first_noise, little_force(&first_noise)].map(|noise| from(&noise));
            if density(&second) > density(&first) { second } else { first }
        };
        let mut base = fit(&kept);
        let filtered = |base: &Estimate, runs: &[Run]| passes(&base.model, integration, &[], runs, &base.noise, false);
        let mut at = filtered(&base, &kept);
        // Without these stretches the estimate is better, and further stretches may show.
        for _ in 0..LOSS_ROUNDS {
            let (without, lost) = followed(&kept, &at);
            issues.extend(lost);
            let Some(without) = without else { break };
            kept = without;
            base = fit(&kept);
            at = filtered(&base, &kept);
        }
        (question.progress)("auditing recordings and integration step");
        let mut admission = admit(&base.model, integration, &base.noise, &kept, &at);
        admission.issues.extend(issues);
        Self { estimate: base, within: None, prior, runs: kept, integration, admission }
            .read_as_euler()
            .settled(question.settings)
            .with_backwards()
    }

    /// The base fit at its optimum: where a step still promises more, it is solved within its bounds and constraints first, and estimated on from
    /// there.
    fn settled(mut self, settings: &Settings) -> Self {
        let Self { estimate, prior, runs, integration, .. } = &self;
        if left_to_gain(estimate, *integration, runs) > LEFT_TO_GAIN {
            let problem = Problem { integration: *integration, runs, candidates: &[], prior, settings };
            let solved = problem.written(estimate);
            if solved.log_posterior > estimate.log_posterior {
                self.estimate = problem.again(&solved, SETTLE);
            }
            self.within = Some(solved);
        }
        self
    }

    /// The same with a note on each actuator of the craft that pushes against its order, or less than its twin: nothing that is named later
    /// mends that.
    fn with_backwards(mut self) -> Self {
        let Self { estimate, runs, integration, .. } = &self;
        let Estimate { model, free, .. } = estimate;
        if model.ship.actuators.is_empty() {
            return self;
        }
        let covariance = estimate.information(*integration, runs).try_inverse();
        let estimated: Vec<Estimated> = free
            .iter()
            .enumerate()
            .map(|(i, f)| {
                let p = &model.parameters[f.column.parameter];
                let error = covariance.as_ref().map(|c| c[(i, i)].max(0.0).sqrt() * f.column.scale);
                (p.name.as_str(), f.value(model), error, p.info.unit)
            })
            .collect();
        let turned = |(_, sentence)| Issue::new(Severity::Warning, "backwards", sentence, "correct that first");
        let weak = |(_, sentence)| Issue::new(Severity::Warning, "unequal", sentence, "look at it");
        let noted = backwards(&model.ship, estimated.iter().copied()).into_iter().map(turned);
        let noted: Vec<Issue> = noted.chain(unequal(&model.ship, &estimated).into_iter().map(weak)).collect();
        self.admission.issues.extend(noted);
        self
    }

    /// The base fit with explicit Euler steps of one sample period, where the recordings were made so: such steps reproduce them to
    /// rounding. A late clock of noisy recordings looks alike and is no reason.
    fn read_as_euler(mut self) -> Self {
        if !is_made_by_euler(&self.runs) {
            return self;
        }
        let coarse = Integration { method: Method::Euler, substeps: 1 };
        let Estimate { model, noise, free, log_posterior: fine, .. } = &self.estimate;
        self.admission.euler_gain = log_posterior(model, coarse, &self.runs, free, noise) - fine;
        if self.admission.euler_gain > -EULER_HOPELESS {
            // Each integration with its own fitted parameters: a fit shifts them to compensate the error of a step.
            let fit = |e: &Estimate, effort: Effort| {
                estimate(&e.model, coarse, &self.runs, &e.free, &e.noise, &self.prior, effort)
            };
            let fitted = fit(&self.estimate, REFIT);
            self.admission.euler_gain = fitted.log_posterior - fine;
            if is_euler(self.admission.euler_gain) {
                self.estimate = fit(&fitted, SETTLE);
                (self.integration, self.admission.integration) = (coarse, coarse);
            }
        }
        self
    }
}

/// Whether explicit Euler steps of one sample period, `x' - x = dt (u cos psi - v sin psi)` and alike for y, reproduce the recorded
/// positions, and steps of second order do not.
fn is_made_by_euler(runs: &[Run]) -> bool {
    let (mut euler, mut trapezoid) = (0.0, 0.0);
    for run in runs {
        let rate = |m: &Measured| {
            let (sin, cos) = m[2]?.sin_cos();
            let (u, v) = (m[3]?, m[4]?);
            Some([u * cos - v * sin, u * sin + v * cos])
        };
        for pair in run.measured.windows(2) {
            let (Some(a), Some(b)) = (rate(&pair[0]), rate(&pair[1])) else { continue };
            for c in 0..2 {
                let (Some(from), Some(to)) = (pair[0][c], pair[1][c]) else { continue };
                euler += (to - from - run.dt * a[c]).powi(2);
                trapezoid += (to - from - 0.5 * run.dt * (a[c] + b[c])).powi(2);
            }
        }
    }
    euler < EULER_EXACT * EULER_EXACT * trapezoid
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{EULER, SAMPLES, made_by_euler, model, runs, sailed};
    use crate::likelihood::parameters::NUISANCE;

    fn question<'a>(model: &'a Model, settings: &'a Settings) -> Question<'a> {
        Question { model, full: model.clone(), settings, progress: &|_| () }
    }

    #[test]
    fn every_nuisance_coefficient_has_a_prior_and_the_models_own_parameters_come_first() {
        let model = model();
        let (own, all) = (base_parameters(&model, false), base_parameters(&model, true));
        assert_eq!((own.len(), all.len()), (11, 11 + NUISANCE.len()));
        assert!(own.iter().all(|f| f.prior.is_none()) && all[11..].iter().all(|f| f.prior.is_some()));
    }

    #[test]
    fn a_sound_recording_is_fitted_whole_and_not_read_as_euler() {
        let (model, settings) = (model(), Settings { nuisance: false, ..Settings::default() });
        let audited = AuditedRuns::new(runs(&model, 6), model.ship.hull.lpp);
        let base = BaseFit::new(&question(&model, &settings), audited);
        assert!(!is_euler(base.admission.euler_gain), "{}", base.admission.euler_gain);
        assert_eq!((base.admission.samples, base.integration), (6 * SAMPLES, settings.integration()));
        assert!(base.admission.issues.is_empty(), "{:?}", base.admission.issues);
    }

    #[test]
    fn recordings_made_by_explicit_euler_are_read_as_euler() {
        let (model, settings) = (model(), Settings { nuisance: false, ..Settings::default() });
        let mut runs = made_by_euler(&model, 6);
        // With errors of sensors this cannot be detected.
        assert!(!is_made_by_euler(&runs));
        for r in &mut runs {
            // As they are in a file, to a hundredth of a millimetre.
            r.measured = sailed(&model, r, EULER).iter().map(|s| s.map(|v| Some((v * 1e5).round() / 1e5))).collect();
        }
        assert!(is_made_by_euler(&runs));
        let base = BaseFit::new(&question(&model, &settings), AuditedRuns::new(runs, 85.0));
        assert!(is_euler(base.admission.euler_gain), "{}", base.admission.euler_gain);
        assert_eq!((base.integration, base.admission.integration), (EULER, EULER));
    }

    #[test]
    fn the_base_is_the_better_of_its_two_starts() {
        let (model, settings) = (model(), Settings::default());
        let base = BaseFit::new(&question(&model, &settings), AuditedRuns::new(runs(&model, 6), model.ship.hull.lpp));
        let (free, first) = (base_parameters(&model, true), guess(&base.runs, &model));
        let density = |e: &Estimate| e.log_posterior + base.prior.log_density(&e.noise.to_log());
        for noise in [first, little_force(&first)] {
            let one = estimate(&model, base.integration, &base.runs, &free, &noise, &base.prior, FIRST);
            assert!(density(&base.estimate) >= density(&one) - LEFT_TO_GAIN);
        }
    }

    #[test]
    fn a_base_that_begins_far_from_its_values_ends_at_the_optimum_of_one_that_begins_there() {
        let (truth, settings) = (model(), Settings { nuisance: false, ..Settings::default() });
        let mut far = truth.clone();
        for p in far.parameters.iter_mut().filter(|p| p.free) {
            p.value = (p.value + 3.0 * p.scale).clamp(p.lower, p.upper);
        }
        let fitted = |model: &Model| {
            let audited = AuditedRuns::new(runs(&truth, 8), truth.ship.hull.lpp);
            let base = BaseFit::new(&question(model, &settings), audited);
            let left = left_to_gain(&base.estimate, base.integration, &base.runs);
            assert!(left <= LEFT_TO_GAIN, "{left}");
            base.estimate.log_posterior
        };
        let (near, from_far) = (fitted(&truth), fitted(&far));
        assert!((near - from_far).abs() < 2.0 * LEFT_TO_GAIN, "{near} {from_far}");
    }
}
