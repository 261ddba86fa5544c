//! Before any physics is claimed: are the recordings consistent with themselves, and is the integration step fine enough?
//! It judges data and numerics only.

use super::filter::{Filter, GATE, Pass, Wanted};
use super::noise::Noise;
use super::receiver::piece;
use crate::model::Model;
use crate::recording::{Run, or_nan};
use crate::report::sig;
use crate::simulate::{Integration, Method};
use crate::state::{STATE_NAMES, STATES};
use rayon::prelude::*;
use serde::Serialize;

/// One thing wrong or odd with the recordings.
#[derive(Clone, Debug, Serialize)]
pub struct Issue {
    /// The channel concerned.
    pub channel: String,
    /// What it is: `sign_error`, `unit_error`, `frozen`, `held`, `start`, `jump` or `lost`.
    pub mechanism: &'static str,
    /// What is seen, with numbers.
    pub text: String,
    /// What to do.
    pub next_step: String,
    /// True when no physics can be concluded before it is mended.
    pub blocking: bool,
}

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
    pub issues: Vec<Issue>,
    /// The integration used by the diagnosis.
    pub integration: Integration,
    /// Largest change of a standardised innovation when the step is refined eight times.
    pub integration_error: f64,
    /// Gain in log-posterior when the model is fitted as explicit Euler at one step a sample instead of with the integration
    /// used; large and positive for recordings that a coarse simulator made.
    pub euler_gain: f64,
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
            "look at ship, model and units before anything that is named below: they are far from these recordings"
                .into();
        let channel = STATE_NAMES[first.channel].into();
        return (None, vec![Issue { channel, mechanism: "lost", text, next_step, blocking: false }]);
    }
    let next_step = "these samples are left out; look there for inputs that were not recorded, a sensor that failed or \
                     something that touched the ship";
    let issue = |(run, loss): (&Run, &Loss)| Issue {
        channel: STATE_NAMES[loss.channel].into(),
        mechanism: "lost",
        text: told(run, loss),
        next_step: next_step.into(),
        blocking: false,
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

/// Slope of `y` on `x` through the origin of the means, and their correlation.
fn gain(pairs: &[(f64, f64)]) -> Option<(f64, f64)> {
    let n = pairs.len() as f64;
    if n < 20.0 {
        return None;
    }
    let (mx, my) = pairs.iter().fold((0.0, 0.0), |a, p| (a.0 + p.0 / n, a.1 + p.1 / n));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in pairs {
        xx += (x - mx) * (x - mx);
        xy += (x - mx) * (y - my);
        yy += (y - my) * (y - my);
    }
    (xx > 0.0 && yy > 0.0).then(|| (xy / xx, xy / (xx * yy).sqrt()))
}

/// Units and signs that are confused: the factor between what is recorded and what is.
const CONFUSIONS: [(f64, &str); 7] = [
    (-1.0, "its sign is reversed"),
    (57.2958, "it is in degrees where radians are declared"),
    (1.0 / 57.2958, "it is in radians where degrees are declared"),
    (1.94384, "it is in knots where m/s are declared"),
    (0.514444, "it is in m/s where knots are declared"),
    (60.0, "it is per minute where per second is declared"),
    (-57.2958, "it is in degrees with reversed sign"),
];

/// Audits the recordings' kinematics and the numerics.
pub fn admit(model: &Model, integration: Integration, noise: &Noise, runs: &[Run]) -> Admission {
    let mut issues = Vec::new();
    let mut rate = Vec::new();
    let mut surge = Vec::new();
    let (mut cos, mut sin, mut count) = (0.0, 0.0, 0.0);
    for r in runs {
        // Differences over several samples, so that sensor noise does not drown the motion.
        let span = 3.min(r.measured.len().saturating_sub(1)).max(1);
        for w in r.measured.windows(2 * span + 1) {
            let w: Vec<[f64; STATES]> = w.iter().map(or_nan).collect();
            let (a, m, b) = (&w[0], &w[span], &w[2 * span]);
            let dt = 2.0 * span as f64 * r.dt;
            let mean = w.iter().map(|s| s[5]).sum::<f64>() / w.len() as f64;
            if (b[2] - a[2]).is_finite() && mean.is_finite() {
                rate.push(((b[2] - a[2]) / dt, mean));
            }
            let (dx, dy) = ((b[0] - a[0]) / dt, (b[1] - a[1]) / dt);
            let along = dx * m[2].cos() + dy * m[2].sin();
            let mean = w.iter().map(|s| s[3]).sum::<f64>() / w.len() as f64;
            if along.is_finite() && mean.is_finite() {
                surge.push((along, mean));
            }
        }
        for heading in r.measured.iter().filter_map(|m| m[2]) {
            cos += heading.cos();
            sin += heading.sin();
            count += 1.0;
        }
        for j in 0..6 {
            let values: Vec<f64> = r.measured.iter().filter_map(|m| m[j]).collect();
            let frozen = values.len() > 20 && values.windows(2).all(|w| w[0] == w[1]);
            if frozen {
                issues.push(Issue {
                    channel: STATE_NAMES[j].into(),
                    mechanism: "frozen",
                    text: format!("{}: the channel holds one value throughout", r.name),
                    next_step: "leave the run or the channel out".into(),
                    blocking: false,
                });
            }
        }
    }
    for (channel, against, pairs) in [("r", "the change of heading", &rate), ("u", "the change of position", &surge)] {
        let Some((slope, correlation)) = gain(pairs) else { continue };
        if correlation.abs() < 0.8 {
            continue;
        }
        if let Some((factor, words)) = CONFUSIONS.iter().find(|(f, _)| (slope / f - 1.0).abs() < 0.12) {
            issues.push(Issue {
                channel: channel.into(),
                mechanism: if *factor < 0.0 { "sign_error" } else { "unit_error" },
                text: format!("{channel} is {slope:.3} times {against} (correlation {correlation:.3}): {words}"),
                next_step: format!("correct the unit or sign of `{channel}` in the column map"),
                blocking: true,
            });
        }
    }
    // A rudder that turns the ship the wrong way.
    let turn: Vec<(f64, f64)> = runs
        .iter()
        .flat_map(|r| {
            r.measured.iter().zip(&r.inputs).filter(|(_, i)| i.n > 0.0).filter_map(|(m, i)| Some((i.delta, m[5]?)))
        })
        .filter(|(d, _)| d.is_finite())
        .collect();
    if let Some((slope, correlation)) = gain(&turn)
        && correlation < -0.5
        && slope < 0.0
    {
        issues.push(Issue {
            channel: "delta".into(),
            mechanism: "sign_error",
            text: format!(
                "rudder to starboard goes with a turn to port (correlation {correlation:.2}): the rudder's sign is reversed"
            ),
            next_step: "set `sign = -1` for the rudder in the column map".into(),
            blocking: true,
        });
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
