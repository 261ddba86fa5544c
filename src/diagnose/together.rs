//! The errors of all sensors at once. One after the other they fail where the noise of a sensor has taken one of them in: a speed log
//! that reads 8 % too much has a noise of 8 % where nothing else explains it, and no test against that noise sees it.
//! What is named, and whether a refit confirms it, is decided elsewhere.

use super::candidate::{Candidate, Extent};
use super::eligible::{Beside, Further};
use super::estimate::{Estimate, FreeParameter, log_posterior};
use super::evidence::chi_squared_p;
use super::kinematic::{Disagreement, disagreements};
use super::noise::Noise;
use super::problem::Problem;
use super::settings::{SENSOR_SPREAD, TOGETHER_EFFORT};
use super::wald::Wald;
use crate::model::{Model, Prior};
use crate::physics::Kind;
use nalgebra::DVector;

/// The error of a sensor that stands out most beside all others, with a model and a noise that a refit can start from.
pub struct Leading {
    /// Index into the candidates.
    pub candidate: usize,
    /// Its amplitudes beyond what the model already has, in units of its columns.
    pub amplitude: DVector<f64>,
    /// Squared distance from zero in units of the covariance.
    pub statistic: f64,
    /// Its p-value, corrected for the sensors that were asked.
    pub p: f64,
    /// The model with it, and without the other sensors' errors.
    pub model: Model,
    /// What is free then.
    pub free: Vec<FreeParameter>,
    /// The noise beside the errors of all sensors.
    pub noise: Noise,
}

/// The leading error of a sensor that may be named beside what the model had and what was selected. What the sensors show of each other beyond
/// chance is free, with a weak prior and one amplitude in all sessions; it starts where they agree best, and parameters and noise are
/// estimated in turn. `None` where the sensors agree, where they cannot be held against each other, and where no error is both
/// significant.
pub fn leading(current: &Estimate, problem: Problem, beside: Beside) -> Option<Leading> {
    let Problem { integration, runs, candidates, settings, .. } = problem;
    let is_free = |parameter: usize| current.free.iter().any(|f| f.column.parameter == parameter);
    let may_be = |i: &usize| {
        let c = &candidates[*i];
        c.mechanism.kind == Kind::Sensor && !c.columns.iter().any(|c| is_free(c.parameter))
    };
    let sensors: Vec<usize> = (0..candidates.len()).filter(may_be).collect();
    let all: Vec<&Candidate> = sensors.iter().map(|i| &candidates[*i]).collect();
    let shown = disagreements(&current.model, runs, &all)?;
    let shown = sensors.iter().copied().zip(shown).filter(|(_, d)| d.p * (sensors.len() as f64) < settings.alpha);
    let (asked, shown): (Vec<usize>, Vec<Disagreement>) = shown.unzip();
    if asked.is_empty() {
        return None;
    }
    let (mut free, mut start) = (current.free.clone(), current.model.clone());
    let mut places = Vec::with_capacity(asked.len());
    for (i, Disagreement { amplitude, .. }) in asked.iter().zip(&shown) {
        let from = free.len();
        free.extend(candidates[*i].parameters(&Extent::All).into_iter().map(|f| weak(f, &current.model)));
        candidates[*i].add(&mut start, &Extent::All, amplitude);
        places.push((from..free.len()).collect::<Vec<usize>>());
    }
    let value = |model: &Model| log_posterior(model, integration, runs, &free, &current.noise);
    let start = if value(&start) > value(&current.model) { &start } else { &current.model };
    let found = problem.estimate(start, &free, &current.noise, TOGETHER_EFFORT);
    let wald = Wald::at(&found, integration, runs);
    let may_lead = |candidate: usize, statistic: f64, p: f64| {
        let further = Further { candidate, extent: &Extent::All, statistic, p };
        p < settings.alpha && beside.allows(&further, candidates)
    };
    let row = |(i, own): (&usize, &Vec<usize>)| {
        let part = wald.part(own).less(&candidates[*i].held(&Extent::All));
        let statistic = part.statistic();
        let p = chi_squared_p(statistic, own.len()) * sensors.len() as f64;
        may_lead(*i, statistic, p).then_some((*i, part.value, statistic, p))
    };
    let (candidate, amplitude, statistic, p) =
        asked.iter().zip(&places).filter_map(row).max_by(|a, b| a.2.total_cmp(&b.2))?;
    let mut model = current.model.clone();
    for f in &current.free {
        f.set(&mut model, f.value(&found.model));
    }
    candidates[candidate].add(&mut model, &Extent::All, &amplitude);
    let mut free = current.free.clone();
    free.extend(candidates[candidate].parameters(&Extent::All));
    Some(Leading { candidate, amplitude, statistic, p, model, free, noise: found.noise })
}

/// A parameter of a sensor's error with a prior around no error.
fn weak(f: FreeParameter, model: &Model) -> FreeParameter {
    let p = &model.parameters[f.column.parameter];
    let prior = Some(Prior { mean: p.value, sd: SENSOR_SPREAD * p.scale });
    FreeParameter { prior, ..f }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::candidate::candidates;
    use crate::diagnose::example::{RK4, at, erring, model};
    use crate::diagnose::noise::NoisePrior;
    use crate::diagnose::screen::screen;
    use crate::diagnose::selected::Selected;
    use crate::diagnose::settings::{SETTLE, Settings};
    use crate::recording::Run;

    const NOTHING: Beside = Beside { present: &[], selected: &[], nothing_else: true };

    /// What leads on runs, alone or beside clocks of some statistic, with the noise that the model alone has there.
    fn of(runs: &[Run], withhold: &[&str], taken: Option<f64>) -> (Vec<Candidate>, Estimate, Option<Leading>) {
        let (model, settings) = (model(), Settings::default());
        let list = candidates(&model, &withhold.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>());
        let prior = NoisePrior::around(&at(&model).noise);
        let problem = Problem { integration: RK4, runs, candidates: &list, prior: &prior, settings: &settings };
        let base = problem.again(&at(&model), SETTLE);
        let clocks = list.iter().position(|c| c.mechanism.name == "time_skew").unwrap();
        let selected = taken.map(|statistic| {
            let (set, why) = (vec![clocks], String::new());
            Selected { candidate: clocks, extent: Extent::All, statistic, p: 0.0, set, why, carried: false }
        });
        let beside = Beside { present: &[], selected: selected.as_slice(), nothing_else: true };
        let found = leading(&base, problem, beside);
        (list, base, found)
    }

    #[test]
    fn a_log_error_that_the_noise_has_taken_in_leads_at_its_size_with_the_noise_of_the_sound_log() {
        let runs = erring(&[("log_scale.error", 0.08)], 12);
        let (list, base, found) = of(&runs, &[], None);
        let found = found.unwrap();
        assert_eq!(list[found.candidate].mechanism.name, "log_scale");
        let scale = list[found.candidate].columns[0].scale;
        assert!((found.amplitude[0] * scale - 0.08).abs() < 0.01, "{}", found.amplitude[0] * scale);
        let speed = |n: &Noise| n.sensors[2].white.hypot(n.sensors[2].coloured);
        assert!(speed(&base.noise) > 3.0 * speed(&found.noise), "{:?} {:?}", base.noise, found.noise);
        let row = screen(&base, RK4, &runs, &list).rows.into_iter().find(|r| r.candidate == found.candidate).unwrap();
        assert!(row.test.statistic < found.statistic);
        assert!(found.free.len() == base.free.len() + 1 && found.free.last().is_some_and(|f| f.prior.is_none()));
    }

    #[test]
    fn nothing_leads_where_the_sensors_are_sound_and_what_is_withheld_is_not_asked() {
        let sound = crate::diagnose::example::runs(&model(), 12);
        assert!(of(&sound, &[], None).2.is_none());
        let runs = erring(&[("log_scale.error", 0.08)], 12);
        let (list, _, found) = of(&runs, &["log_scale"], None);
        assert!(found.is_none_or(|l| list[l.candidate].mechanism.name != "log_scale"));
    }

    #[test]
    fn an_error_that_the_model_already_has_leads_no_more_and_one_twice_as_large_leads_by_what_it_is_more() {
        let errors = |a: f64| [("time_skew.yaw_rate", a)];
        let of = |a: f64| {
            let (model, settings) = (crate::diagnose::example::with(&errors(2.0)), Settings::default());
            let (list, runs) = (candidates(&model, &[]), erring(&errors(a), 12));
            let prior = NoisePrior::around(&at(&model).noise);
            let problem =
                Problem { integration: RK4, runs: &runs, candidates: &list, prior: &prior, settings: &settings };
            let base = problem.again(&at(&model), SETTLE);
            leading(&base, problem, NOTHING).map(|l| {
                let c = &list[l.candidate];
                (
                    c.mechanism.name,
                    l.amplitude[0] * c.columns[0].scale,
                    l.model.parameters[c.columns[0].parameter].value,
                )
            })
        };
        assert!(of(2.0).is_none(), "{:?}", of(2.0));
        let (name, more, value) = of(4.0).unwrap();
        assert!(name == "yaw_rate_skew" && (more - 2.0).abs() < 0.3 && (value - 4.0).abs() < 0.3, "{more} {value}");
    }

    #[test]
    fn beside_clocks_a_look_alike_must_explain_more_than_they_leave_and_another_error_leads_instead() {
        let runs = erring(&[("position_lever.x", 12.0), ("yaw_rate_bias.bias", 0.0005)], 12);
        let name = |taken: Option<f64>| {
            let (list, _, found) = of(&runs, &[], taken);
            found.map(|l| list[l.candidate].mechanism.name)
        };
        assert_eq!((name(None), name(Some(10.0))), (Some("position_lever"), Some("position_lever")));
        assert_eq!(name(Some(1e9)), Some("yaw_rate_bias"));
    }
}
