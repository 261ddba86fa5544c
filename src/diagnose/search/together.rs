//! The errors of sensors, before any mechanism of the ship. The noise estimated with a model that lacks an error may include that error: a
//! speed log that reads 8 % too much has a noise of 8 % where nothing else explains it, and no test against that noise is significant.
//! What is named, and whether a refit confirms it, is decided elsewhere.

use super::eligible::{Beside, Further};
use super::problem::Problem;
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::evidence::kinematic::{Disagreement, disagreements};
use crate::diagnose::settings::TOGETHER_EFFORT;
use crate::likelihood::estimate::{Estimate, FreeParameter, log_posterior};
use crate::likelihood::noise::Noise;
use crate::model::Model;
use nalgebra::DVector;

/// The error of a sensor that stands out most beside all others, with a model and a noise that a refit can start from.
pub struct Leading {
    /// The candidate, and those that the kinematic consistency does not distinguish from it.
    pub set: Vec<usize>,
    /// All sessions with one amplitude, or each with its own.
    pub extent: Extent,
    /// Its amplitudes beyond what the model already has, in units of its columns.
    pub amplitude: DVector<f64>,
    /// Twice what it adds to the log-likelihood of the kinematic consistency.
    pub statistic: f64,
    /// Its p-value, corrected for the number of sensors compared.
    pub p: f64,
    /// The model with it, and without the other sensors' errors.
    pub model: Model,
    /// What is free then.
    pub free: Vec<FreeParameter>,
    /// The noise to start from.
    pub noise: Noise,
}

/// The errors of sensors that may be named beside what the model had and what was selected: those that the kinematic
/// consistency shows significantly and throughout, the most significant first. Ship and noise are estimated beside the first, which is fixed
/// where the sensors agree best: a noise that includes an error falls only once the model has the error. From there or from where they were,
/// whichever is likelier with the error, a refit starts. None where the sensors agree and where their consistency cannot be computed.
pub fn leading(current: &Estimate, problem: Problem, beside: Beside) -> Vec<Leading> {
    let shown = shown(current, problem, beside);
    let Some((first, extent, d)) = shown.first() else { return Vec::new() };
    let mut start = current.model.clone();
    problem.candidates[*first].add(&mut start, extent, &d.amplitude);
    let found = problem.estimate(&start, &current.free, &current.noise, TOGETHER_EFFORT);
    let lead = |(place, (candidate, extent, d)): (usize, &(usize, Extent, Disagreement))| {
        let c = &problem.candidates[*candidate];
        let mut free = current.free.clone();
        free.extend(c.parameters(extent));
        let start = |from: &Estimate| {
            let mut model = current.model.clone();
            current.free.iter().for_each(|f| f.set(&mut model, f.value(&from.model)));
            c.add(&mut model, extent, &d.amplitude);
            let value = log_posterior(&model, problem.integration, problem.runs, &current.free, &from.noise);
            (value, model, from.noise)
        };
        let (beside, before) = (start(&found), start(current));
        let (_, model, noise) = if before.0 > beside.0 { before } else { beside };
        let like = shown[place + 1..].iter().filter(|other| !d.is_ahead_of(&other.2)).map(|other| other.0);
        Leading {
            set: std::iter::once(*candidate).chain(like).collect(),
            extent: extent.clone(),
            amplitude: d.amplitude.clone(),
            statistic: d.statistic,
            p: d.p,
            model,
            free,
            noise,
        }
    };
    shown.iter().enumerate().map(lead).collect()
}

/// The errors that the kinematic consistency shows and that may be named, the most significant first, with p-values corrected for the number
/// of sensors compared.
fn shown(current: &Estimate, problem: Problem, beside: Beside) -> Vec<(usize, Extent, Disagreement)> {
    let Problem { runs, candidates, settings, .. } = problem;
    let sensors = problem.sensor_errors(current);
    let all: Vec<&Candidate> = sensors.iter().map(|i| &candidates[*i]).collect();
    let extent = |d: &Disagreement| if d.sessions.is_empty() { Extent::All } else { Extent::Each(d.sessions.clone()) };
    let errors = disagreements(&current.model, runs, &all, settings.alpha).unwrap_or_default();
    let of = |(i, mut d): (usize, Disagreement)| {
        d.p *= all.len() as f64;
        (i, extent(&d), d)
    };
    let is_shown = |(candidate, extent, d): &(usize, Extent, Disagreement)| {
        let further = Further { candidate: *candidate, extent, statistic: d.statistic, p: d.p };
        d.p < settings.alpha && d.is_steady && beside.allows(&further, candidates)
    };
    let mut shown: Vec<_> = sensors.iter().copied().zip(errors).map(of).filter(is_shown).collect();
    shown.sort_by(|a, b| b.2.statistic.total_cmp(&a.2.statistic));
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{RK4, at, erring, model};
    use crate::diagnose::search::screen::screen;
    use crate::diagnose::search::selected::Selected;
    use crate::diagnose::settings::{SETTLE, Settings};
    use crate::likelihood::noise::NoisePrior;
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
        let found = leading(&base, problem, beside).into_iter().next();
        (list, base, found)
    }

    #[test]
    fn a_log_error_that_the_noise_has_taken_in_leads_at_its_size_with_the_noise_of_the_sound_log() {
        let runs = erring(&[("log_scale.error", 0.08)], 12);
        let (list, base, found) = of(&runs, &[], None);
        let found = found.unwrap();
        assert_eq!(list[found.set[0]].mechanism.name, "log_scale");
        let scale = list[found.set[0]].columns[0].scale;
        assert!((found.amplitude[0] * scale - 0.08).abs() < 0.01, "{}", found.amplitude[0] * scale);
        let speed = |n: &Noise| n.sensors[2].white.hypot(n.sensors[2].coloured);
        assert!(speed(&base.noise) > 3.0 * speed(&found.noise), "{:?} {:?}", base.noise, found.noise);
        let row = screen(&base, RK4, &runs, &list).rows.into_iter().find(|r| r.candidate == found.set[0]).unwrap();
        assert!(row.test.statistic < found.statistic);
        assert!(found.free.len() == base.free.len() + 1 && found.free.last().is_some_and(|f| f.prior.is_none()));
    }

    #[test]
    fn nothing_leads_where_the_sensors_are_sound_and_what_is_withheld_is_not_asked() {
        let sound = crate::diagnose::example::runs(&model(), 12);
        assert!(of(&sound, &[], None).2.is_none());
        let runs = erring(&[("log_scale.error", 0.08)], 12);
        let (list, _, found) = of(&runs, &["log_scale"], None);
        assert!(found.is_none_or(|l| list[l.set[0]].mechanism.name != "log_scale"));
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
            leading(&base, problem, NOTHING).first().map(|l| {
                let c = &list[l.set[0]];
                (
                    c.mechanism.name,
                    l.amplitude[0] * c.columns[0].scale,
                    l.model.parameters[c.columns[0].parameter].value,
                )
            })
        };
        assert!(of(2.0).is_none(), "{:?}", of(2.0));
        let (name, more, value) = of(4.0).unwrap();
        // A start for the refit: 4 s are more than a sample of 3 s, and no longer linear in the yaw acceleration.
        assert!(name == "yaw_rate_skew" && (more - 2.0).abs() < 0.6 && value == 2.0 + more, "{more} {value}");
    }

    #[test]
    fn beside_clocks_a_look_alike_must_explain_more_than_they_leave_and_another_error_leads_instead() {
        let runs = erring(&[("position_lever.x", 20.0), ("yaw_rate_bias.bias", 0.0002)], 12);
        let name = |taken: Option<f64>| {
            let (list, _, found) = of(&runs, &[], taken);
            found.map(|l| list[l.set[0]].mechanism.name)
        };
        assert_eq!((name(None), name(Some(10.0))), (Some("position_lever"), Some("position_lever")));
        assert_eq!(name(Some(1e9)), Some("yaw_rate_bias"));
    }
}
