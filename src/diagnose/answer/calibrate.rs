//! The error rates of one study: how often the same analysis names something in simulated recordings in which nothing is missing, and
//! how often it finds again what it found, at the size at which it found it.
//! The recordings are simulated with this study's inputs, sampling, sessions and noise; nothing here looks at the measured values.

use super::analysis::Answer;
use crate::diagnose::error::DiagnoseError;
use crate::diagnose::proof::finding::Finding;
use crate::diagnose::proof::stability::Brief;
use crate::diagnose::search::base::Question;
use crate::diagnose::settings::Settings;
use crate::dynamics::Dynamics;
use crate::likelihood::estimate::Estimate;
use crate::likelihood::noise::{GROUP_OF, Noise};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::{Integration, driven, step};
use crate::state::{Force, STATES};
use crate::statistics::Share;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;

/// Error rates of a study by simulation.
#[derive(Clone, Debug, Serialize)]
pub struct ErrorRates {
    /// Simulated studies with nothing missing in which something was named.
    pub false_alarms: Share,
    /// Simulated studies with the findings in which the first of them was found again; absent without findings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub found_again: Option<Share>,
    /// 95 % intervals of its parameters that contained the simulated value, where it was found again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covered: Option<Share>,
    /// Seed of the simulations.
    pub seed: u64,
}

impl ErrorRates {
    /// Analyses `count` simulated studies with nothing missing, and as many with what was found.
    ///
    /// # Errors
    /// When the catalogue's terms cannot be added to the model.
    pub fn new(
        question: &Question,
        answer: &Answer,
        runs: &[Run],
        held_out: &[Run],
        count: usize,
    ) -> Result<Option<Self>, DiagnoseError> {
        if count == 0 {
            return Ok(None);
        }
        let seed = question.settings.seed;
        let again = |truth: &Estimate, i: usize| {
            let mut random = ChaCha8Rng::seed_from_u64(seed.wrapping_add(1 + i as u64));
            let integration = question.settings.integration();
            let mut of = |all: &[Run]| -> Vec<Run> {
                all.iter().map(|r| simulated(&truth.model, &truth.noise, integration, r, &mut random)).collect()
            };
            let (runs, held_out) = (of(runs), of(held_out));
            analysed(question.settings, question.model, &runs, &held_out)
        };
        let base = &answer.kept.selection.tests.fit.estimate;
        let mut alarms = 0;
        for i in 0..count {
            (question.progress)(&format!("simulating studies with nothing missing ({} of {count})", i + 1));
            alarms += usize::from(!again(base, i)?.findings.is_empty());
        }
        let (mut found, mut covered) = (Vec::new(), Vec::new());
        if let Some(first) = answer.findings.first() {
            let own = Brief::new(answer.verdict, &answer.findings);
            for i in 0..count {
                (question.progress)(&format!("simulating studies with what was found ({} of {count})", i + 1));
                let other = again(answer.improved(), count + i)?;
                found.push(Some(own.is_found_in(0, &Brief::new(other.verdict, &other.findings))));
                covered.extend(covers(first, &other.findings));
            }
        }
        Ok(Some(Self {
            false_alarms: Share::new(alarms, count),
            found_again: Share::of(found),
            covered: Share::of(covered),
            seed,
        }))
    }
}

/// The analysis of other recordings with the user's model, without repetitions.
fn analysed(settings: &Settings, model: &Model, runs: &[Run], held_out: &[Run]) -> Result<Answer, DiagnoseError> {
    let question = Question::new(model, settings, &|_| ())?;
    Ok(Answer::new(&question, runs, held_out))
}

/// Whether each interval of the finding's parameters in other findings contains the finding's value.
fn covers(truth: &Finding, found: &[Finding]) -> Vec<Option<bool>> {
    let Some(same) = found.iter().find(|f| f.mechanism == truth.mechanism && f.sessions == truth.sessions) else {
        return Vec::new();
    };
    let value = |name: &str| truth.parameters.iter().find(|p| p.name == name).map(|p| p.value);
    let of = |p: &crate::diagnose::proof::finding::Amplitude| value(&p.name).map(|v| p.ci95[0] <= v && v <= p.ci95[1]);
    same.parameters.iter().map(of).collect()
}

/// A run as a model would sail it under an unknown force and be measured with this noise: the run's inputs, start and measured
/// channels. The unknown force is a first-order Gauss-Markov process an equation, constant over a step; so is the coloured part of each
/// channel's noise. Where the ship is lost, the run ends.
fn simulated(model: &Model, noise: &Noise, integration: Integration, run: &Run, random: &mut ChaCha8Rng) -> Run {
    let dynamics = Dynamics::new(model, model.values_in(&run.session));
    let series = driven(&dynamics, integration, run.dt, &run.inputs);
    let mut normal = || -> f64 { StandardNormal.sample(&mut *random) };
    let keep = (-run.dt / noise.force_time).exp();
    let mut force: [f64; 3] = std::array::from_fn(|e| noise.force[e] * normal());
    let mut coloured: [f64; STATES] = std::array::from_fn(|c| noise.sensors[GROUP_OF[c]].coloured * normal());
    let mut state = run.initial;
    let mut measured = Vec::with_capacity(run.measured.len());
    for (k, m) in run.measured.iter().enumerate() {
        let report = dynamics.report(&state, &run.inputs[k]);
        measured.push(std::array::from_fn(|c| {
            let sensor = &noise.sensors[GROUP_OF[c]];
            let error = coloured[c] + sensor.white * normal();
            let stay = (-run.dt / sensor.time).exp();
            coloured[c] = stay * coloured[c] + sensor.coloured * (1.0 - stay * stay).sqrt() * normal();
            m[c].map(|_| report[c] + error)
        }));
        let at = k * integration.instants();
        if k + 1 == run.measured.len() || at + integration.instants() >= series.len() {
            break;
        }
        let push = Force { x: force[0], y: force[1], n: force[2] };
        state = step(&dynamics, integration, run.dt, &state, &series[at..], &push);
        if state.iter().any(|v| !v.is_finite()) {
            break;
        }
        for e in 0..3 {
            force[e] = keep * force[e] + noise.force[e] * (1.0 - keep * keep).sqrt() * normal();
        }
    }
    let initial = std::array::from_fn(|c| measured[0][c].unwrap_or(run.initial[c]));
    Run { inputs: run.inputs[..measured.len()].to_vec(), initial, measured, ..run.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, noise, runs, with};

    #[test]
    fn a_simulated_run_scatters_about_the_models_own_by_the_noise_and_keeps_what_was_not_measured_blank() {
        let model = model();
        let mut run = runs(&model, 1).remove(0);
        run.measured.iter_mut().for_each(|m| m[4] = None);
        let quiet = Noise { force: [0.0; 3], ..noise() };
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let out = simulated(&model, &quiet, RK4, &run, &mut random);
        let clean = crate::evaluate::predict(&model, &run, RK4);
        let errors = |c: usize| -> Vec<f64> {
            out.measured.iter().zip(&clean.states).filter_map(|(m, s)| Some(m[c]? - s[c])).collect()
        };
        let sd = crate::statistics::variance(&errors(5)).unwrap().sqrt();
        assert!((0.6..1.6).contains(&(sd / 0.0005)), "{sd}");
        assert!(errors(4).is_empty() && out.measured.len() == run.measured.len());
        let other = simulated(&model, &quiet, RK4, &run, &mut random);
        assert!(other.measured != out.measured);
    }

    #[test]
    fn a_current_is_found_again_in_simulated_studies_and_nothing_where_there_is_none() -> Result<(), DiagnoseError> {
        let settings = Settings { nuisance: false, calibrate: 3, ..Settings::default() };
        let truth = runs(&with(&[("current.north", 0.3)]), 16);
        let d = crate::diagnose::diagnose(&model(), &truth[..12], &truth[12..], &settings, &|_| ())?;
        let rates = d.error_rates.unwrap();
        assert_eq!((rates.false_alarms.hits, rates.false_alarms.of), (0, 3));
        assert_eq!(rates.found_again.map(|s| (s.hits, s.of)), Some((3, 3)));
        assert!(rates.covered.is_some_and(|s| s.of == 6 && s.hits >= 3), "{:?}", rates.covered);
        Ok(())
    }
}
