//! What acts in a recording that differs from all others: every error of a sensor or an actuator and every force of the surroundings, acting in
//! that recording alone, against the forces that are left there. It is asked only where nothing is named, and changes no
//! verdict: one recording proves nothing.

use crate::diagnose::evidence::candidate::Extent;
use crate::diagnose::evidence::push::Window;
use crate::diagnose::evidence::wald::Wald;
use crate::diagnose::proof::finding::Amplitude;
use crate::diagnose::search::compete::{amplitudes, form_tolerance, start_with};
use crate::diagnose::search::event::BaseTests;
use crate::diagnose::search::problem::{Problem, total};
use crate::diagnose::search::screen::screen_by_session;
use crate::diagnose::settings::{
    BEYOND_DOUBT, IDENTIFIABLE_SHARE, INDISTINGUISHABLE, PARAMETER_PRICE, REFIT, RIVALS, Settings,
};
use crate::likelihood::estimate::{Estimate, FreeParameter};
use crate::physics::Kind;
use crate::recording::Run;
use serde::Serialize;

/// A mechanism that explains a recording, acting in it alone.
#[derive(Clone, Debug, Serialize)]
pub struct Cause {
    /// The recording.
    pub recording: String,
    /// Name of the mechanism.
    pub mechanism: &'static str,
    /// Its name in words.
    pub title: &'static str,
    /// Log-likelihood that it gains, less the price of its parameters.
    pub gain: f64,
    /// Its size in that recording, beside what the model has.
    pub parameters: Vec<Amplitude>,
    /// Names in words of the mechanisms that explain it as well.
    pub alike: Vec<&'static str>,
}

/// What explains each of the recordings that differ, where anything of the catalogue does.
pub fn causes(tests: &BaseTests, differing: &[&str], settings: &Settings) -> Vec<Cause> {
    differing.iter().filter_map(|name| cause(tests, name, settings)).collect()
}

/// The mechanism that explains a recording best; `None` where all explain less than constant forces in its windows do, by more than the form of a
/// force is known, or nothing that can be told from chance.
///
/// Each is tested in the recording alone, beside the parameters of all; those of most gain are refitted there with everything free.
fn cause(tests: &BaseTests, recording: &str, settings: &Settings) -> Option<Cause> {
    let (runs, current) = apart(&tests.fit.runs, &tests.fit.estimate, recording);
    let problem = Problem { runs: &runs, ..tests.problem(settings) };
    let screen = screen_by_session(&current, problem.integration, &runs, problem.candidates, true);
    let extent = Extent::In(vec![recording.to_owned()]);
    let price = |parameters: usize| PARAMETER_PRICE * parameters as f64;
    let tested = |candidate: usize| {
        let test = screen.test(candidate, &extent);
        let c = &problem.candidates[candidate];
        // The ship is the same in all recordings.
        let may_be = c.mechanism.kind != Kind::Ship
            && test.degrees > 0
            && test.retained > IDENTIFIABLE_SHARE
            && c.admissible(&current.model, &test);
        may_be.then(|| (candidate, 0.5 * test.statistic - price(test.degrees), test.amplitude))
    };
    let mut tested: Vec<_> = (0..problem.candidates.len()).filter_map(tested).collect();
    tested.sort_by(|a, b| b.1.total_cmp(&a.1));
    tested.truncate(RIVALS);
    let refit = |(candidate, _, amplitude): (usize, f64, _)| {
        let (model, free) = start_with(&screen, candidate, &extent, &amplitude, &current, problem, &current.noise);
        let found = problem.estimate(&model, &free, &current.noise, REFIT);
        let gain = found.log_posterior - current.log_posterior - price(free.len() - current.free.len());
        (candidate, gain, found)
    };
    let is_free =
        |(_, _, found): &(usize, f64, Estimate)| !found.free[current.free.len()..].iter().any(|f| at_limit(f, found));
    let mut refitted: Vec<(usize, f64, Estimate)> = tested.into_iter().map(refit).filter(is_free).collect();
    refitted.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (candidate, gain, found) = refitted.first()?;
    let forces = forces(&tests.location.windows, recording);
    if *gain < (forces - form_tolerance(forces)).max(INDISTINGUISHABLE) {
        return None;
    }
    let c = &problem.candidates[*candidate];
    let size = amplitudes(&Wald::at(found, problem.integration, &runs), found, c, &extent);
    let amplitude = |(i, name): (usize, &String)| {
        let (scale, p) = (c.columns[i].scale, &found.model.parameters[c.columns[i].parameter]);
        let error = size.covariance[(i, i)].max(0.0).sqrt() * scale.abs();
        Amplitude::new(name.clone(), size.value[i] * scale, p.info.unit, error)
    };
    let tolerance = form_tolerance(*gain);
    let alike = refitted[1..].iter().filter(|other| gain - other.1 < tolerance);
    Some(Cause {
        recording: recording.to_owned(),
        mechanism: c.mechanism.name,
        title: c.mechanism.title,
        gain: *gain,
        parameters: c.names.iter().enumerate().map(amplitude).collect(),
        alike: alike.map(|other| problem.candidates[other.0].mechanism.title).collect(),
    })
}

/// Whether a parameter ended at a limit other than nothing: there it stands for a part of something else.
fn at_limit(f: &FreeParameter, found: &Estimate) -> bool {
    let p = &found.model.parameters[f.column.parameter];
    let value = total(f, &found.model);
    [p.lower, p.upper].iter().any(|limit| *limit != 0.0 && (value - limit).abs() < 1e-3 * p.scale)
}

/// The runs and the estimate, with a recording as a session of its own that has what its session had.
fn apart(runs: &[Run], estimate: &Estimate, recording: &str) -> (Vec<Run>, Estimate) {
    let (mut runs, mut estimate) = (runs.to_vec(), estimate.clone());
    for run in runs.iter_mut().filter(|r| r.recording == recording) {
        let before = std::mem::replace(&mut run.session, recording.to_owned());
        if let Some(own) = estimate.model.sessions.get(&before).cloned() {
            estimate.model.sessions.insert(recording.to_owned(), own);
        }
        let acts = |f: &&mut Vec<String>| f.contains(&before) && !f.contains(&recording.to_owned());
        estimate
            .free
            .iter_mut()
            .filter_map(|f| f.sessions.as_mut())
            .filter(acts)
            .for_each(|s| s.push(recording.to_owned()));
    }
    (runs, estimate)
}

/// What constant forces in the windows of a recording gain, less the price of their parameters.
fn forces(windows: &[Window], recording: &str) -> f64 {
    let own = windows.iter().filter(|w| w.run == recording && w.p < BEYOND_DOUBT);
    own.map(|w| 0.5 * w.statistic - 3.0 * PARAMETER_PRICE).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{model, runs, with};
    use crate::diagnose::search::base::{AuditedRuns, BaseFit, Question};

    /// The cause in the third of nine recordings, of another truth than the others.
    fn of_third(truth: &[(&str, f64)]) -> Option<Cause> {
        let (model, settings) = (model(), Settings { nuisance: false, ..Settings::default() });
        let mut all = runs(&model, 9);
        all[2] = runs(&with(truth), 9).swap_remove(2);
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let tests = BaseTests::new(&question, BaseFit::new(&question, AuditedRuns::new(all.clone(), 85.0)));
        cause(&tests, &all[2].recording, &settings)
    }

    #[test]
    fn a_rudder_that_is_off_in_one_recording_is_its_cause_at_its_size() {
        let found = of_third(&[("rudder_offset.offset", 0.12)]).unwrap();
        assert_eq!(found.mechanism, "rudder_offset", "{found:?}");
        let [low, high] = found.parameters[0].ci95;
        assert!(low < 0.12 && 0.12 < high, "{found:?}");
    }

    #[test]
    fn a_recording_like_the_others_has_no_cause() {
        assert!(of_third(&[]).is_none());
    }
}
