//! Measures of the trials in a recording: over ground, through the water where a current is known, and beside them the same trial
//! with a model. What is a trial is decided in `recorded`; no current is estimated here.

use super::approach::ManeuverSettings;
use super::calm::calm_water_of_depth;
use super::found::{Found, Kind, PassedOver, approach_change, approach_speed, find};
use super::imo::{self, Criterion};
use super::measures::{Turning, Zigzag};
use super::track::Track;
use super::trial::{Ended, Side};
use super::trials::turning::{turning, turning_trial};
use super::trials::zigzag::{zigzag, zigzag_trial};
use crate::dynamics::Dynamics;
use crate::model::Model;
use crate::recording::Run;
use crate::ship::Ship;
use crate::state::State;
use serde::Serialize;

/// The measures of one trial of either kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Measures {
    /// Of a turning circle.
    Turning(Turning),
    /// Of a zigzag.
    Zigzag(Zigzag),
}

/// Measures of one track with the IMO criteria beside them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Taken {
    /// The measures.
    pub measures: Measures,
    /// IMO criteria that apply.
    pub criteria: Vec<Criterion>,
}

/// The same trial with a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Simulated {
    /// Propeller rate that holds the approach speed \[rps\].
    pub n: f64,
    /// How it ended.
    pub ended: Ended,
    /// Measures and criteria.
    #[serde(flatten)]
    pub taken: Taken,
}

/// A trial of a recording and its measures.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredTrial {
    /// The recording.
    pub run: String,
    /// Its session.
    pub session: String,
    /// In words: `turning 35 deg starboard`.
    pub name: String,
    /// First rudder.
    pub side: Side,
    /// Time of the first execute on the recording's clock \[s\].
    pub at: f64,
    /// By which share of its mean the speed over ground changed over the approach; a trial with much of it did not begin steadily.
    pub approach_change: f64,
    /// Rate of the rudder \[rad/s\]; absent where it is over within one sample, as an order is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rudder_rate: Option<f64>,
    /// Over ground, as recorded.
    pub recorded: Taken,
    /// Mean current over the trial, (north, east) of where it sets to \[m/s\]; absent where the model and the recording have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub current: Option<[f64; 2]>,
    /// Through the water, which that current carried.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub through_water: Option<Taken>,
    /// The same trial with the model in calm water, from the same speed and with the same rudder rate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulated: Option<Simulated>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_simulated: Option<String>,
}

/// The trials in a run, measured, and what looked like a trial and is none.
///
/// Currents are those of the recording and of the model's terms, with what the model adds in the run's session. Speeds that a log
/// measured through the water (term `water_log`) are put over ground first.
pub fn measured(run: &Run, model: &Model, settings: &ManeuverSettings) -> (Vec<MeasuredTrial>, Vec<PassedOver>) {
    let length = model.ship.hull.lpp;
    let (ground, current) = over_ground(run, model);
    let (found, passed) = find(&ground, length);
    let trials = found.iter().map(|f| one(run, model, settings, &ground, current.as_deref(), f));
    (trials.collect(), passed)
}

/// The recorded track with velocities over ground, and the current at each sample where there is any.
fn over_ground(run: &Run, model: &Model) -> (Track, Option<Vec<[f64; 2]>>) {
    let mut track = Track::recorded(run);
    for (k, inputs) in run.inputs.iter().enumerate() {
        [track.delta[k], track.n[k]] = model.ship.helm_and_shaft(inputs);
    }
    let theta = model.values_in(&run.session);
    let through = model.part("water_log", &theta).first().copied().unwrap_or(0.0);
    let dynamics = Dynamics::new(model, theta);
    let mut current = Vec::with_capacity(run.inputs.len());
    for (k, inputs) in run.inputs.iter().enumerate() {
        // The current depends on the inputs alone.
        let state = State::from_array([0.0; 6]);
        let [north, east] = dynamics.flow(&dynamics.instant(&state, inputs)).adjust.current;
        current.push([north, east]);
        let (sin, cos) = track.states[k][2].sin_cos();
        track.states[k][3] += through * (north * cos + east * sin);
        track.states[k][4] += through * (east * cos - north * sin);
    }
    let any = current.iter().flatten().any(|v| *v != 0.0);
    (track, any.then_some(current))
}

/// One trial of a run.
fn one(
    run: &Run,
    model: &Model,
    settings: &ManeuverSettings,
    ground: &Track,
    current: Option<&[[f64; 2]]>,
    found: &Found,
) -> MeasuredTrial {
    let recorded = taken(&model.ship, ground, found);
    let carried = current.map(|all| {
        let part = &all[found.samples.clone()];
        let mean = |j: usize| part.iter().map(|c| c[j]).sum::<f64>() / part.len() as f64;
        (taken(&model.ship, &ground.through_water(all), found), [mean(0), mean(1)])
    });
    let (through_water, mean) = carried.unzip();
    let speed = approach_of(&through_water.as_ref().unwrap_or(&recorded).measures);
    let (simulated, not_simulated) = match simulated(model, settings, found, speed) {
        Ok(simulated) => (Some(simulated), None),
        Err(why) => (None, Some(why)),
    };
    MeasuredTrial {
        run: run.recording.clone(),
        session: run.session.clone(),
        name: name(found),
        side: found.side,
        at: ground.t[found.executes[0]],
        approach_change: approach_change(ground, model.ship.hull.lpp, found.executes[0]),
        rudder_rate: found.rudder_rate,
        recorded,
        current: mean,
        through_water,
        simulated,
        not_simulated,
    }
}

/// The trial in words.
fn name(found: &Found) -> String {
    let (rudder, side) = (found.rudder.to_degrees(), found.side.word());
    match found.kind {
        Kind::Turning => format!("turning {rudder:.0} deg {side}"),
        Kind::Zigzag { heading } => format!("zigzag {rudder:.0}/{:.0}, {side} first", heading.to_degrees()),
    }
}

/// Measures and criteria of a trial on a track. The approach speed is the mean over the last ship length: one recorded sample has noise.
fn taken(ship: &Ship, track: &Track, found: &Found) -> Taken {
    let speed = approach_speed(track, ship.hull.lpp, found.executes[0]);
    let from = *found.samples.start();
    let part = track.part(found.samples.clone());
    match found.kind {
        Kind::Turning => {
            let mut m = turning(&part, found.executes[0] - from);
            m.approach_speed = speed;
            if let Some(steady) = &mut m.steady {
                steady.speed_loss = 1.0 - steady.speed / speed;
            }
            Taken { criteria: imo::turning(ship, &m), measures: Measures::Turning(m) }
        }
        Kind::Zigzag { heading } => {
            let executes: Vec<usize> = found.executes.iter().map(|k| k - from).collect();
            let mut m = zigzag(&part, &executes, heading);
            (m.approach_speed, m.rudder) = (speed, found.side.sign() * found.rudder);
            Taken { criteria: imo::zigzag(ship, &m), measures: Measures::Zigzag(m) }
        }
    }
}

fn approach_of(measures: &Measures) -> f64 {
    match measures {
        Measures::Turning(m) => m.approach_speed,
        Measures::Zigzag(m) => m.approach_speed,
    }
}

/// The trial with the model in calm water, from an approach in balance at `speed` \[m/s\] and with the recorded rudder rate, else that of the
/// settings.
fn simulated(model: &Model, settings: &ManeuverSettings, found: &Found, speed: f64) -> Result<Simulated, String> {
    let (calm, _) = calm_water_of_depth(model, settings.depth).map_err(|error| error.to_string())?;
    let theta = calm.values();
    let rudder_rate_deg_s = found.rudder_rate.map(f64::to_degrees).or(settings.rudder_rate_deg_s);
    let settings = ManeuverSettings { speed: Some(speed), n_rpm: None, rudder_rate_deg_s, ..settings.clone() };
    let approach = settings.approach(&calm, &theta).map_err(|error| error.to_string())?;
    let (ended, taken) = match found.kind {
        Kind::Turning => {
            let t = turning_trial(&calm, &theta, &approach, found.side, found.rudder);
            (t.ended, Taken { measures: Measures::Turning(t.measures), criteria: t.criteria })
        }
        Kind::Zigzag { heading } => {
            let t = zigzag_trial(&calm, &theta, &approach, found.side, [found.rudder, heading]);
            (t.ended, Taken { measures: Measures::Zigzag(t.measures), criteria: t.criteria })
        }
    };
    match ended {
        Ended::Diverged { after } => Err(format!("the simulation diverged after {after:.1} s")),
        Ended::Complete | Ended::TimeOut { .. } => Ok(Simulated { n: approach.n, ended, taken }),
    }
}
