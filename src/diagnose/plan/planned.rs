//! The plan from end to end: trials sailed, tested as recordings without error, and read.
//! It prints and draws nothing.

use super::error::PlanError;
use super::outlook::{Isolability, Outlook, outlooks};
use super::part::{Parting, part};
use super::sail::{Basin, Sailed};
use super::sensors::Level;
use super::settings::{COURSES, Kind, PlanSettings, PlannedTrial};
use crate::diagnose::evidence::candidate::{Candidate, applies, candidates};
use crate::diagnose::search::screen::screen;
use crate::diagnose::settings::Settings;
use crate::evaluate::maneuver::ManeuverSettings;
use crate::files::suggestion;
use crate::likelihood::estimate::Estimate;
use crate::likelihood::parameters::base_parameters;
use crate::model::Model;
use crate::ranges::{Limited, within};
use crate::recording::Run;
use serde::Serialize;

/// Share of the ship length that is sailed at approach speed in a sample period, where none is given.
const STEP_LENGTHS: f64 = 0.1;

/// What is asked: a model, trials and sensors, and the settings of the diagnosis that will follow.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The model, with its ship.
    pub model: &'a Model,
    /// Trials and sensors.
    pub plan: &'a PlanSettings,
    /// Approach of the trials, rudder and engine rate.
    pub maneuver: &'a ManeuverSettings,
    /// Chance of a false name, nuisance coefficients, mechanisms that are not considered.
    pub diagnose: &'a Settings,
}

/// What planned trials would show.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// The trials in the order in which they are sailed.
    pub trials: Vec<Sailed>,
    /// Sum of their durations \[min\], approaches not counted.
    pub minutes: f64,
    /// Sensors and unknown force.
    pub noise: Level,
    /// Chance of naming anything when nothing is missing.
    pub alpha: f64,
    /// What is seen of every mechanism, by name.
    pub mechanisms: Vec<Outlook>,
    /// Which of them take over each other's gain.
    pub isolability: Isolability,
    /// Which trials part the pair that was asked for.
    pub parting: Option<Parting>,
}

/// What the trials of a plan would show, and with `pair` the cheapest set of trials that parts two mechanisms, out of the planned
/// ones and the usual ones on four courses. `progress` receives each step in words. The result is the same bits on any number of
/// threads.
///
/// # Errors
/// [`PlanError`]: an impossible trial or setting, no approach, an unknown mechanism.
pub fn plan(question: &Question, pair: Option<[&str; 2]>, progress: &(dyn Fn(&str) + Sync)) -> Result<Plan, PlanError> {
    let Question { model, plan, maneuver, diagnose } = question;
    for (i, trial) in plan.trials.iter().enumerate() {
        trial.limits().map_err(|error| PlanError::Trial { number: i + 1, error })?;
    }
    plan.limits()?;
    diagnose.limits()?;
    let full = model.complete()?;
    let all = candidates(&full, &diagnose.withhold);
    let pair = pair.map(|names| chosen(&all, names)).transpose()?;

    progress("sailing the trials");
    let usual = |error| PlanError::Approach { trial: "trials".into(), error };
    let approach = maneuver.approach(model, &model.values()).map_err(usual)?;
    let length_time = model.ship.hull.lpp / approach.speed;
    let step = plan.sensors.step.unwrap_or(STEP_LENGTHS * length_time);
    // What is simulated and tested grows with the samples; what they show does not, below a thousandth of the time of a ship length.
    within(
        "step",
        step,
        &(1e-3 * length_time..=length_time),
        "the sample period, a tenth of the time in which the ship sails its length",
    )?;
    let basin = Basin { model, maneuver, sensors: &plan.sensors, integration: diagnose.integration(), step };
    let programme = PlannedTrial::programme(approach.speed);
    let trials = basin.sail(if plan.trials.is_empty() { &programme } else { &plan.trials })?;

    progress("testing every mechanism");
    let runs: Vec<Run> = trials.iter().map(|t| t.run.clone()).collect();
    let (noise, level) = plan.sensors.noise(&full, &runs, step);
    let free = base_parameters(&full, diagnose.nuisance);
    let found = Estimate { model: full, noise, free, log_posterior: 0.0, seen: None };
    let list: Vec<Candidate> = all.into_iter().filter(|c| applies(c.mechanism, &runs)).collect();
    let screen = screen(&found, basin.integration, &runs, &list);
    let parting = match &pair {
        None => None,
        Some(pair) => {
            progress("choosing trials");
            let catalogue = basin.sail(&catalogue(&plan.trials, programme))?;
            Some(part(&found, basin.integration, &catalogue, pair))
        }
    };
    Ok(Plan {
        minutes: trials.iter().map(|t| t.minutes).sum(),
        trials,
        noise: level,
        alpha: diagnose.alpha,
        mechanisms: outlooks(&screen, &list, diagnose, &found.model),
        isolability: Isolability::new(&screen, &list),
        parting,
    })
}

/// Two candidates by name.
fn chosen(all: &[Candidate], names: [&str; 2]) -> Result<[Candidate; 2], PlanError> {
    let known = || all.iter().map(|c| c.mechanism.name);
    let find = |name: &str| {
        all.iter().find(|c| c.mechanism.name == name).cloned().ok_or_else(|| {
            let near = suggestion(name, known());
            let list = known().collect::<Vec<_>>().join(", ");
            PlanError::Mechanism(format!("there is no mechanism `{name}` to part{near}; they are {list}"))
        })
    };
    if names[0] == names[1] {
        return Err(PlanError::Mechanism(format!("`{}` cannot be parted from itself; name two mechanisms", names[0])));
    }
    Ok([find(names[0])?, find(names[1])?])
}

/// The trials that a set is chosen from, each once: the planned ones, the usual ones and an acceleration, on four courses.
fn catalogue(planned: &[PlannedTrial], programme: Vec<PlannedTrial>) -> Vec<PlannedTrial> {
    let session = planned.first().map_or_else(|| programme[0].session.clone(), |t| t.session.clone());
    let mut out: Vec<PlannedTrial> = Vec::new();
    let usual = programme.into_iter().chain([PlannedTrial::new(Kind::Acceleration)]);
    for trial in planned.iter().cloned().chain(usual) {
        let mut courses = COURSES.to_vec();
        courses.extend(trial.heading_deg.all().iter().filter(|c| !COURSES.contains(c)));
        let trial = PlannedTrial { repeat: 1, session: session.clone(), ..trial.on(&courses) };
        if !out.contains(&trial) {
            out.push(trial);
        }
    }
    out
}
