//! Planned trials as runs with exact measurements: orders from the closed-loop trials, motion from the simulation.
//! What the runs show of a mechanism is computed elsewhere.

use super::error::PlanError;
use super::settings::{Kind, PlannedTrial, SensorSettings};
use crate::evaluate::maneuver::{
    Approach, Ended, ManeuverSettings, Side, Track, stopping_trial, turning_trial, zigzag_trial,
};
use crate::model::Model;
use crate::recording::{Run, Split, measured};
use crate::simulate::{Integration, Scenario, simulate};
use crate::state::{Inputs, STATES};
use serde::Serialize;

/// Samples that a trial may have.
const SAMPLES: std::ops::RangeInclusive<usize> = 10..=100_000;
/// Ship lengths of a straight run and of an acceleration, where no duration is given.
const STRAIGHT_LENGTHS: f64 = 15.0;
const ACCELERATION_LENGTHS: f64 = 20.0;

/// A trial on one course, simulated.
#[derive(Clone, Debug, Serialize)]
pub struct Sailed {
    /// In words.
    pub name: String,
    /// Kind of trial.
    pub kind: Kind,
    /// Course at the start \[deg\].
    pub heading_deg: f64,
    /// Session.
    pub session: String,
    /// Speed at the start \[m/s\].
    pub speed: f64,
    /// Duration \[min\], approach not counted.
    pub minutes: f64,
    /// Number of samples.
    pub samples: usize,
    /// False where the trial was not complete after 200 ship lengths at approach speed, or after its `duration`.
    pub complete: bool,
    /// Inputs and exact measurements.
    #[serde(skip)]
    pub run: Run,
}

/// What all trials share.
pub(super) struct Basin<'a> {
    pub model: &'a Model,
    pub maneuver: &'a ManeuverSettings,
    pub sensors: &'a SensorSettings,
    pub integration: Integration,
    /// Sample period \[s\].
    pub step: f64,
}

/// Orders of a trial at each sample.
struct Ordered {
    name: String,
    inputs: Vec<Inputs<f64>>,
    speed: f64,
    complete: bool,
}

impl Basin<'_> {
    /// Sails every trial on each of its courses, as often as it is repeated, one after the other.
    pub fn sail(&self, trials: &[PlannedTrial]) -> Result<Vec<Sailed>, PlanError> {
        let mut sailed: Vec<Sailed> = Vec::new();
        let mut clock = 0.0;
        for trial in trials {
            let ordered = self.ordered(trial)?;
            for course in trial.heading_deg.all() {
                let one = self.simulated(trial, &ordered, *course)?;
                for repeat in 1..=trial.repeat {
                    let mut one = one.clone();
                    if repeat > 1 {
                        one.name += &format!(" ({repeat})");
                    }
                    one.run.inputs.iter_mut().for_each(|i| i.t += clock);
                    one.run.name.clone_from(&one.name);
                    one.run.recording.clone_from(&one.name);
                    clock += one.run.duration();
                    sailed.push(one);
                }
            }
        }
        Ok(sailed)
    }

    /// The approach of a trial, its integration step a whole part of the sample period.
    fn approach(&self, trial: &PlannedTrial) -> Result<Approach, PlanError> {
        let given = match (trial.speed, trial.n_rpm) {
            _ if trial.kind == Kind::Acceleration => (self.maneuver.speed, trial.n_rpm.or(self.maneuver.n_rpm)),
            (None, None) => (self.maneuver.speed, self.maneuver.n_rpm),
            given => given,
        };
        let settings = ManeuverSettings { speed: given.0, n_rpm: given.1, step: None, ..self.maneuver.clone() };
        let fail = |error| PlanError::Approach { trial: trial.kind.word().into(), error };
        let mut approach = settings.approach(self.model, &self.theta(trial)).map_err(fail)?;
        approach.step = self.step / (self.step / approach.step).ceil();
        Ok(approach)
    }

    fn theta(&self, trial: &PlannedTrial) -> Vec<f64> {
        self.model.values_in(&trial.session)
    }

    /// The orders of a trial: of the closed-loop trial on course north, or constant.
    fn ordered(&self, trial: &PlannedTrial) -> Result<Ordered, PlanError> {
        let (approach, theta) = (self.approach(trial)?, self.theta(trial));
        let side = Side::of(trial.rudder());
        let rudder = trial.rudder().abs();
        let (name, track, ended, speed) = match trial.kind {
            Kind::Turning => {
                let t = turning_trial(self.model, &theta, &approach, side, rudder);
                (t.name, t.track, t.ended, approach.speed)
            }
            Kind::Zigzag => {
                let t = zigzag_trial(self.model, &theta, &approach, side, [rudder, trial.heading_change()]);
                (t.name, t.track, t.ended, approach.speed)
            }
            Kind::Stopping => {
                let t = stopping_trial(self.model, &theta, &approach);
                (t.name, t.track, t.ended, approach.speed)
            }
            Kind::Straight | Kind::Acceleration => return self.steady(trial, &approach),
        };
        if let Ended::Diverged { after } = ended {
            return Err(PlanError::Diverged { trial: name, after });
        }
        let inputs = self.sampled(&track, &approach);
        let samples = inputs.len();
        let kept = trial.duration.map_or(samples, |d| samples.min((d / self.step).round() as usize + 1));
        let inputs = inputs[..kept].to_vec();
        let at =
            if trial.speed.is_some() || trial.n_rpm.is_some() { format!(" at {speed:.2} m/s") } else { String::new() };
        Ok(Ordered { name: name + &at, complete: ended == Ended::Complete && kept == samples, inputs, speed })
    }

    /// Constant propeller rate with the rudder amidships.
    fn steady(&self, trial: &PlannedTrial, approach: &Approach) -> Result<Ordered, PlanError> {
        let accelerates = trial.kind == Kind::Acceleration;
        let lengths = if accelerates { ACCELERATION_LENGTHS } else { STRAIGHT_LENGTHS };
        let speed = if accelerates { trial.speed.unwrap_or(0.5 * approach.speed) } else { approach.speed };
        let duration = trial.duration.unwrap_or(lengths * self.model.ship.hull.lpp / approach.speed);
        let samples = (duration / self.step).round().min(1e9) as usize + 1;
        let name = format!("{} at {speed:.2} m/s", if accelerates { "acceleration" } else { "straight" });
        self.counted(&name, samples)?;
        let inputs =
            (0..samples).map(|k| self.model.ship.inputs_ordered(k as f64 * self.step, approach.n, 0.0)).collect();
        Ok(Ordered { name, inputs, speed, complete: true })
    }

    /// The actuators of a track at the sample period.
    fn sampled(&self, track: &Track, approach: &Approach) -> Vec<Inputs<f64>> {
        let every = (self.step / approach.step).round().max(1.0) as usize;
        let at = |k: usize| self.model.ship.inputs_ordered(track.t[k], track.n[k], track.delta[k]);
        (0..track.len()).step_by(every).map(at).collect()
    }

    fn counted(&self, name: &str, samples: usize) -> Result<(), PlanError> {
        if SAMPLES.contains(&samples) {
            return Ok(());
        }
        Err(PlanError::Samples { trial: name.into(), samples, step: self.step })
    }

    /// The motion under the orders, on a course \[deg\].
    fn simulated(&self, trial: &PlannedTrial, ordered: &Ordered, course: f64) -> Result<Sailed, PlanError> {
        let name = format!("{}, course {course:03}", ordered.name);
        self.counted(&name, ordered.inputs.len())?;
        let initial: [f64; STATES] = [0.0, 0.0, course.to_radians(), ordered.speed, 0.0, 0.0];
        let scenario = Scenario { dt: self.step, inputs: ordered.inputs.clone(), initial };
        let motion = simulate(self.model, &self.theta(trial), self.integration, &scenario);
        if let Some(k) = motion.diverged_at {
            return Err(PlanError::Diverged { trial: name, after: k as f64 * self.step });
        }
        let mut samples = measured(&motion.states);
        samples.iter_mut().for_each(|s| (0..STATES).filter(|c| !self.sensors.measures(*c)).for_each(|c| s[c] = None));
        let run = Run {
            name: name.clone(),
            recording: name.clone(),
            session: trial.session.clone(),
            manoeuvre: trial.kind.word().into(),
            split: Split::Train,
            dt: self.step,
            recorded_dt: self.step,
            inputs: scenario.inputs,
            measured: samples,
            initial,
            disturbed: Vec::new(),
            derived: [false; STATES],
        };
        Ok(Sailed {
            name,
            kind: trial.kind,
            heading_deg: course,
            session: trial.session.clone(),
            speed: ordered.speed,
            minutes: run.duration() / 60.0,
            samples: run.inputs.len(),
            complete: ordered.complete,
            run,
        })
    }
}
