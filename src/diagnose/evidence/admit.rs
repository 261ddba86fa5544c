//! The audit of recordings and integration step by the base model, before any physics is claimed.
//! It judges data and numerics only; what recordings show by themselves is in `audit`.

use crate::diagnose::settings::{COMPARED, FEW_LOST_SHARE, LOST_MEASUREMENTS};
use crate::likelihood::filter::{Filter, GATE, Pass, Wanted};
use crate::likelihood::noise::Noise;
use crate::model::Model;
use crate::numerals::sig;
use crate::recording::audit::{Issue, Severity, audit_runs, piece};
use crate::recording::{Channel, Run, STATE_CHANNELS};
use crate::simulate::{Integration, Method};
use crate::state::{STATE_NAMES, STATES};
use serde::Serialize;

/// The admission of the recordings.
#[derive(Clone, Debug, Serialize)]
pub struct Admission {
    /// Runs admitted.
    pub runs: usize,
    /// Samples admitted.
    pub samples: usize,
    /// Sessions.
    pub sessions: usize,
    /// Spread of headings: 0 all the same, 1 all round.
    pub heading_spread: f64,
    /// What is wrong or odd.
    #[serde(serialize_with = "as_admitted")]
    pub issues: Vec<Issue>,
    /// The integration used by the diagnosis.
    pub integration: Integration,
    /// Largest change of a standardised innovation when the step is refined eight times.
    pub integration_error: f64,
    /// Gain in log-posterior when the model is fitted as explicit Euler at one step a sample instead of with the integration
    /// used; large and positive for recordings that a coarse simulator made.
    pub euler_gain: f64,
}

/// An issue under the keys of `diagnosis.json`.
#[derive(Serialize)]
struct Admitted<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    channel: Option<&'static str>,
    mechanism: &'static str,
    text: &'a str,
    next_step: &'a str,
    blocking: bool,
}

fn as_admitted<S: serde::Serializer>(issues: &[Issue], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(issues.iter().map(|i| Admitted {
        channel: i.channel.map(Channel::name),
        mechanism: i.fault,
        text: &i.text,
        next_step: &i.next_step,
        blocking: i.blocking(),
    }))
}

/// Measurements of a channel in a row beyond the gate: too many for outliers, so that the filter has lost the ship.
struct Loss {
    channel: usize,
    first: usize,
    count: usize,
}

/// The runs without the stretches in which the filter loses the ship, and an issue for each: no unknown force of the size that the
/// other runs show explains these stretches, and they would bias every estimate.
///
/// `None` where it is lost nowhere, and where it is lost in many runs, with one issue for all of them: then the model is at fault
/// and the runs stay whole.
pub fn followed(runs: &[Run], passes: &[Pass]) -> (Option<Vec<Run>>, Vec<Issue>) {
    let losses: Vec<Option<Loss>> = runs.iter().zip(passes).map(|(r, p)| loss(r, p)).collect();
    let lost: Vec<(&Run, &Loss)> = runs.iter().zip(&losses).filter_map(|(r, l)| Some((r, l.as_ref()?))).collect();
    if lost.is_empty() {
        return (None, Vec::new());
    }
    if lost.len() as f64 > FEW_LOST_SHARE * runs.len() as f64 {
        let (run, first) = lost[0];
        let text = format!("the ship is lost in {} of {} runs, first in {}", lost.len(), runs.len(), words(run, first));
        let next_step =
            "look at ship, model and units before anything that is named below: they are far from these recordings";
        let channel = STATE_CHANNELS[first.channel];
        return (None, vec![Issue::new(Severity::Warning, "lost", text, next_step).of(channel)]);
    }
    let next_step = "these samples are left out; look there for inputs that were not recorded, a sensor that failed or \
                     something that touched the ship";
    let issue = |(run, loss): (&Run, &Loss)| {
        Issue::new(Severity::Warning, "lost", words(run, loss), next_step).of(STATE_CHANNELS[loss.channel])
    };
    let issues = lost.into_iter().map(issue).collect();
    let without = |(run, loss): (&Run, &Option<Loss>)| match loss {
        None => vec![run.clone()],
        Some(l) => {
            [piece(run, 0, l.first), piece(run, l.first + l.count, run.measured.len())].into_iter().flatten().collect()
        }
    };
    (Some(runs.iter().zip(&losses).flat_map(without).collect()), issues)
}

/// A loss in words.
fn words(run: &Run, loss: &Loss) -> String {
    format!(
        "{}: from {} s on {} measurements of {} in a row lie beyond {GATE} standard deviations of what the model and the \
         earlier measurements predict",
        run.name,
        sig(run.inputs[loss.first].t, 5),
        loss.count,
        STATE_NAMES[loss.channel]
    )
}

/// The longest stretch of a run in which the filter loses the ship.
fn loss(run: &Run, pass: &Pass) -> Option<Loss> {
    let of = |channel: usize| {
        let measured = (0..run.measured.len()).filter(|k| !pass.innovations[*k][channel].is_nan());
        let beyond: Vec<(usize, bool)> = measured.map(|k| (k, pass.innovations[k][channel].abs() > GATE)).collect();
        let longest = beyond.chunk_by(|a, b| a.1 == b.1).filter(|s| s[0].1).max_by_key(|s| s.len())?;
        let (first, last) = (longest[0].0, longest[longest.len() - 1].0);
        (longest.len() >= LOST_MEASUREMENTS).then_some(Loss { channel, first, count: last + 1 - first })
    };
    (0..STATES).filter_map(of).max_by_key(|l| l.count)
}

/// Audits the recordings' kinematics and the numerics; `at` are the passes over the runs.
pub fn admit(model: &Model, integration: Integration, noise: &Noise, runs: &[Run], at: &[Pass]) -> Admission {
    let issues = audit_runs(runs);
    let (mut cos, mut sin, mut count) = (0.0, 0.0, 0.0);
    for heading in runs.iter().flat_map(|r| r.measured.iter().filter_map(|m| m[2])) {
        cos += heading.cos();
        sin += heading.sin();
        count += 1.0;
    }
    let refined = Integration { method: Method::Rk4, substeps: integration.substeps.max(1) * 8 };
    let filter = Filter::new(model, refined, &[]);
    let error = |(some, as_used): (&[Run], &[Pass])| {
        let refined = filter.passes(some, noise, Wanted::default());
        let pairs = as_used.iter().zip(&refined).flat_map(|(a, b)| a.innovations.iter().zip(&b.innovations));
        let differences = pairs.flat_map(|(a, b)| (0..STATES).map(|j| (a[j] - b[j]).abs()));
        differences.filter(|e| e.is_finite()).fold(0.0, f64::max)
    };
    let largest = runs.chunks(COMPARED).zip(at.chunks(COMPARED)).map(error).fold(0.0, f64::max);
    let sessions: std::collections::BTreeSet<&str> = runs.iter().map(|r| r.session.as_str()).collect();
    Admission {
        runs: runs.len(),
        samples: runs.iter().map(|r| r.measured.len()).sum(),
        sessions: sessions.len(),
        heading_spread: if count > 0.0 { 1.0 - (cos * cos + sin * sin).sqrt() / count } else { 0.0 },
        issues,
        integration,
        integration_error: largest,
        euler_gain: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, SAMPLES, model, noise, runs};
    use crate::likelihood::estimate::passes;

    /// Twelve runs, in some of which the position is 300 m off for eight samples.
    fn lost_in(some: &[usize]) -> (Vec<Run>, Vec<Pass>) {
        let model = model();
        let mut runs = runs(&model, 12);
        for i in some {
            for m in &mut runs[*i].measured[25..33] {
                m[0] = m[0].map(|x| x + 300.0);
            }
        }
        let passes = passes(&model, RK4, &[], &runs, &noise(), false);
        (runs, passes)
    }

    #[test]
    fn runs_that_the_filter_follows_stay_as_they_are() {
        let (runs, passes) = lost_in(&[]);
        let (kept, issues) = followed(&runs, &passes);
        assert!(kept.is_none() && issues.is_empty());
    }

    #[test]
    fn a_run_in_which_the_ship_is_lost_is_divided_around_the_loss_with_an_issue_that_does_not_block() {
        let (runs, passes) = lost_in(&[4]);
        let (kept, issues) = followed(&runs, &passes);
        let kept = kept.unwrap();
        assert_eq!((kept.len(), issues.len()), (13, 1));
        assert_eq!((kept[4].measured.len(), kept[5].measured.len()), (25, SAMPLES - 33));
        assert_eq!((kept[4].recording.as_str(), kept[5].recording.as_str()), ("run 4", "run 4"));
        let issue = &issues[0];
        assert!(issue.fault == "lost" && issue.text.contains("run 4") && !issue.blocking(), "{issue:?}");
    }

    #[test]
    fn a_model_that_loses_the_ship_in_many_runs_is_at_fault_and_they_stay_whole() {
        let (runs, passes) = lost_in(&[1, 4, 7]);
        let (kept, issues) = followed(&runs, &passes);
        assert!(kept.is_none() && issues.len() == 1 && issues[0].text.contains("3 of 12"), "{issues:?}");
    }

    #[test]
    fn headings_all_round_have_a_spread_near_one_and_a_step_that_is_fine_enough_a_small_error() {
        let model = model();
        let mut runs = runs(&model, 6);
        let at = passes(&model, RK4, &[], &runs, &noise(), false);
        let all = admit(&model, RK4, &noise(), &runs, &at);
        assert_eq!((all.runs, all.samples, all.sessions), (6, 6 * SAMPLES, 2));
        assert!(all.heading_spread > 0.5 && all.integration_error < 0.2, "{all:?}");
        runs.iter_mut().flat_map(|r| &mut r.measured).for_each(|m| m[2] = Some(0.3));
        assert!(admit(&model, RK4, &noise(), &runs, &at).heading_spread < 1e-12);
    }
}
