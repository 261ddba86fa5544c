//! Before any physics is claimed: are the recordings consistent with themselves, and is the integration step fine enough?
//! It judges data and numerics only.

use super::filter::{Filter, GATE, Pass, Wanted};
use super::noise::Noise;
use crate::audit::{Issue, Severity, audit_runs, piece};
use crate::model::Model;
use crate::numerals::sig;
use crate::recording::{Channel, Run, STATE_CHANNELS};
use crate::simulate::{Integration, Method};
use crate::state::{STATE_NAMES, STATES};
use rayon::prelude::*;
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

/// So many measurements of a channel in a row beyond the gate are no outliers: the ship is elsewhere than the filter believes.
const LOST: usize = 5;

/// Where the ship is lost in more than this share of the runs, the model is at fault and not the recordings.
const FEW_LOST: f64 = 0.1;

/// Measurements in a row in which the filter loses the ship.
struct Loss {
    channel: usize,
    first: usize,
    count: usize,
}

/// The runs without the stretches in which the filter loses the ship, and a note on each: what an input or a sensor that was not
/// recorded does there no force of the size that the others show explains, and it would bend everything that is estimated.
///
/// `None` where she is lost nowhere, and where she is lost in many runs, with one note for all of them: they stay whole.
pub fn followed(runs: &[Run], passes: &[Pass]) -> (Option<Vec<Run>>, Vec<Issue>) {
    let losses: Vec<Option<Loss>> = runs.iter().zip(passes).map(|(r, p)| loss(r, p)).collect();
    let lost: Vec<(&Run, &Loss)> = runs.iter().zip(&losses).filter_map(|(r, l)| Some((r, l.as_ref()?))).collect();
    if lost.is_empty() {
        return (None, Vec::new());
    }
    if lost.len() as f64 > FEW_LOST * runs.len() as f64 {
        let (run, first) = lost[0];
        let text = format!("the ship is lost in {} of {} runs, first in {}", lost.len(), runs.len(), told(run, first));
        let next_step =
            "look at ship, model and units before anything that is named below: they are far from these recordings";
        let channel = STATE_CHANNELS[first.channel];
        return (None, vec![Issue::new(Severity::Warning, "lost", text, next_step).of(channel)]);
    }
    let next_step = "these samples are left out; look there for inputs that were not recorded, a sensor that failed or \
                     something that touched the ship";
    let issue = |(run, loss): (&Run, &Loss)| {
        Issue::new(Severity::Warning, "lost", told(run, loss), next_step).of(STATE_CHANNELS[loss.channel])
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
fn told(run: &Run, loss: &Loss) -> String {
    format!(
        "{}: from {} s on {} measurements of {} in a row lie beyond {GATE} standard deviations of what the model and the \
         measurements before let expect",
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
        (longest.len() >= LOST).then_some(Loss { channel, first, count: last + 1 - first })
    };
    (0..STATES).filter_map(of).max_by_key(|l| l.count)
}

/// Audits the recordings' kinematics and the numerics.
pub fn admit(model: &Model, integration: Integration, noise: &Noise, runs: &[Run]) -> Admission {
    let issues = audit_runs(runs);
    let (mut cos, mut sin, mut count) = (0.0, 0.0, 0.0);
    for heading in runs.iter().flat_map(|r| r.measured.iter().filter_map(|m| m[2])) {
        cos += heading.cos();
        sin += heading.sin();
        count += 1.0;
    }
    let passes = |integration: Integration| -> Vec<Vec<[f64; 6]>> {
        let filter = Filter::new(model, integration, &[]);
        runs.par_iter().map(|r| filter.pass(r, noise, Wanted::default()).innovations).collect()
    };
    let innovations = passes(integration);
    let refined = passes(Integration { method: Method::Rk4, substeps: integration.substeps.max(1) * 8 });
    let error = innovations
        .iter()
        .flatten()
        .zip(refined.iter().flatten())
        .flat_map(|(a, b)| (0..6).map(move |j| (a[j] - b[j]).abs()))
        .filter(|e| e.is_finite())
        .collect::<Vec<f64>>();
    let largest = error.iter().copied().fold(0.0, f64::max);
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
