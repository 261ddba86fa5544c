//! What every refit of one diagnosis shares: runs, integration, candidates, the noise's prior and the user's settings.
//! It decides nothing.

use crate::diagnose::evidence::candidate::Candidate;
use crate::diagnose::settings::{Effort, REFIT, Settings};
#[cfg(feature = "ipopt")]
use crate::fit::within_limits;
use crate::likelihood::estimate::{Estimate, FreeParameter, estimate, log_posterior, moved};
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::model::Model;
use crate::physics::Kind;
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::DVector;

/// What every refit shares.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// How steps are integrated.
    pub integration: Integration,
    /// The runs.
    pub runs: &'a [Run],
    /// The mechanisms that may be named.
    pub candidates: &'a [Candidate],
    /// The prior of every noise estimate.
    pub prior: &'a NoisePrior,
    /// The user's settings.
    pub settings: &'a Settings,
}

impl Problem<'_> {
    /// Estimates free parameters and noise from where a model is.
    pub fn estimate(&self, model: &Model, free: &[FreeParameter], noise: &Noise, effort: Effort) -> Estimate {
        estimate(model, self.integration, self.runs, free, noise, self.prior, effort)
    }

    /// The errors of sensors among the candidates of which nothing is free in an estimate yet.
    pub fn sensor_errors(&self, current: &Estimate) -> Vec<usize> {
        let is_free = |parameter: usize| current.free.iter().any(|f| f.column.parameter == parameter);
        let may_be = |i: &usize| {
            let c = &self.candidates[*i];
            c.mechanism.kind == Kind::Sensor && !c.columns.iter().any(|c| is_free(c.parameter))
        };
        (0..self.candidates.len()).filter(may_be).collect()
    }

    /// Estimates again from where an estimate is.
    pub fn again(&self, found: &Estimate, effort: Effort) -> Estimate {
        self.estimate(&found.model, &found.free, &found.noise, effort)
    }

    /// An estimate inside its bounds. A hull coefficient that is carried is limited by its prior alone, which allows either sign: where it
    /// ends outside its bounds (a damping of the wrong sign) it is put at the bound, and the rest is estimated again, until none is outside.
    pub fn inside_bounds(&self, estimate: &Estimate) -> Estimate {
        let mut found = estimate.clone();
        loop {
            let free: Vec<FreeParameter> =
                found.free.iter().filter(|f| !is_outside(f, &found.model)).cloned().collect();
            if free.len() == found.free.len() {
                return found;
            }
            found = self.estimate(&self.moved_inside(&found), &free, &found.noise, REFIT);
        }
    }

    /// The model with what is outside its bounds moved to them, and the rest moved along: `I_rr d_r = -I_ro d_o`, where the information I of what
    /// moves (o) and of the rest (r) gives the most likely values of the rest beside those of the others. Where that is no better, the rest stays.
    fn moved_inside(&self, found: &Estimate) -> Model {
        let Estimate { model, free, noise, .. } = found;
        let (out, rest): (Vec<usize>, Vec<usize>) = (0..free.len()).partition(|i| is_outside(&free[*i], model));
        let mut alone = model.clone();
        out.iter().for_each(|i| put_inside(&free[*i], &mut alone));
        let moves = out.iter().map(|i| (free[*i].value(&alone) - free[*i].value(model)) / free[*i].column.scale);
        let moves = DVector::from_iterator(out.len(), moves);
        let of_rest = found.information(self.integration, self.runs).select_rows(&rest);
        let Some(factor) = of_rest.select_columns(&rest).cholesky() else { return alone };
        let along = factor.solve(&-(of_rest.select_columns(&out) * moves));
        let rest: Vec<FreeParameter> = rest.into_iter().map(|i| free[i].clone()).collect();
        let together = moved(&alone, &rest, &along);
        let [one, all] =
            [&alone, &together].map(|model| log_posterior(model, self.integration, self.runs, free, noise));
        if all > one { together } else { alone }
    }

    /// An estimate as it is written to a file: a fit by likelihood through Ipopt, within bounds and constraints, of all its parameters;
    /// where no such fit is possible, or this build has no Ipopt, the estimate inside its bounds.
    pub fn written(&self, estimate: &Estimate) -> Estimate {
        let inside = self.inside_bounds(estimate);
        #[cfg(feature = "ipopt")]
        {
            let all = Estimate { free: estimate.free.clone(), ..inside.clone() };
            let fitted = within_limits(&all, self.integration, self.runs, self.prior, self.settings.constraints);
            if let Ok(fitted) = fitted {
                return fitted;
            }
        }
        inside
    }
}

/// The parameter with what is added to it where it acts.
pub(in crate::diagnose) fn total(f: &FreeParameter, model: &Model) -> f64 {
    let addition = if f.sessions.is_some() { f.value(model) } else { 0.0 };
    model.parameters[f.column.parameter].value + addition
}

fn is_outside(f: &FreeParameter, model: &Model) -> bool {
    let p = &model.parameters[f.column.parameter];
    !(p.lower..=p.upper).contains(&total(f, model))
}

fn put_inside(f: &FreeParameter, model: &mut Model) {
    let p = &model.parameters[f.column.parameter];
    let inside = total(f, model).clamp(p.lower, p.upper);
    let value = if f.sessions.is_some() { inside - p.value } else { inside };
    f.set(model, value);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{RK4, at, column, model, runs};
    use crate::diagnose::settings::{AS_IT_IS, SETTLE};
    use crate::model::Prior;

    #[test]
    fn a_carried_coefficient_that_ends_outside_its_bounds_is_written_at_the_bound_and_the_rest_is_estimated_again() {
        let (m, settings) = (model(), Settings::default());
        let (list, prior, runs) = (candidates(&m, &[]), NoisePrior::around(&at(&m).noise), runs(&m, 6));
        let problem = Problem { integration: RK4, runs: &runs, candidates: &list, prior: &prior, settings: &settings };
        let damping = column(&m, "hull.Nrr");
        let p = &m.parameters[damping.parameter];
        // A narrow prior around a damping of the wrong sign, against the runs.
        let sure = Prior { mean: p.upper + 3.0 * p.scale, sd: 1e-3 * p.scale };
        let free =
            [FreeParameter::common(damping, Some(sure)), FreeParameter::common(column(&m, "rudder.lift1"), None)];
        let mut start = m.clone();
        start.parameters[damping.parameter].value = sure.mean;
        let outside = problem.estimate(&start, &free, &at(&m).noise, SETTLE);
        assert!(free[0].value(&outside.model) > p.upper);
        let inside = problem.inside_bounds(&outside);
        assert_eq!((inside.model.parameters[damping.parameter].value, inside.free.len()), (p.upper, 1));
        assert!(inside.log_posterior > outside.log_posterior, "{} {}", inside.log_posterior, outside.log_posterior);
        // What is inside stays as it is.
        let again = problem.inside_bounds(&inside);
        assert_eq!((again.log_posterior, again.free.len()), (inside.log_posterior, 1));
        // What is written has every parameter, at its limit where its optimum is beyond.
        let written = problem.written(&outside);
        let reached = written.model.parameters[damping.parameter].value;
        assert!(reached <= p.upper && reached > p.upper - 1e-3 * p.scale, "{reached} {}", p.upper);
        let lift = |e: &Estimate| free[1].value(&e.model);
        assert!((lift(&written) - lift(&inside)).abs() < 0.02 * lift(&inside).abs() && written.free.len() == 2);
    }

    #[test]
    fn what_is_tied_to_a_coefficient_moves_along_with_it_to_its_bound() {
        let (m, settings) = (model(), Settings::default());
        let (list, prior, runs) = (candidates(&m, &[]), NoisePrior::around(&at(&m).noise), runs(&m, 6));
        let problem = Problem { integration: RK4, runs: &runs, candidates: &list, prior: &prior, settings: &settings };
        let damping = column(&m, "hull.Nrr");
        let free = ["hull.Nrr", "hull.Nr", "rudder.lift1"].map(|name| FreeParameter::common(column(&m, name), None));
        let mut narrow = m.clone();
        let p = &mut narrow.parameters[damping.parameter];
        p.upper = p.value - 0.1 * p.value.abs();
        let upper = p.upper;
        let outside = problem.estimate(&narrow, &free, &at(&m).noise, AS_IT_IS);
        let (together, mut alone) = (problem.moved_inside(&outside), narrow.clone());
        put_inside(&free[0], &mut alone);
        let value = |model: &Model| log_posterior(model, RK4, &runs, &free, &at(&m).noise);
        assert_eq!(together.parameters[damping.parameter].value, upper);
        assert!(value(&together) > value(&alone) + 1.0, "{} {}", value(&together), value(&alone));
    }
}
