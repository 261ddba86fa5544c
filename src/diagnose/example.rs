//! Small models and runs for the tests of the steps: a ship, and manoeuvres that a model sails with white sensor noise.
//! It is no recording and no truth simulator; concealed cases are made in the experiments.

#![allow(clippy::unwrap_used)]

use super::evidence::candidate::{Candidate, candidates};
use super::proof::finding::{Amplitude, Equations, Finding};
use super::proof::grade::Grade;
use crate::dynamics::Dynamics;
use crate::likelihood::estimate::Estimate;
use crate::likelihood::filter::Column;
use crate::likelihood::noise::{Noise, SensorNoise};
use crate::model::Model;
use crate::physics::{Form, Kind};
use crate::recording::{Run, Split, measured};
use crate::ship::Ship;
use crate::simulate::{Integration, Method, Scenario, simulate};
use crate::state::Inputs;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::path::Path;

pub const RK4: Integration = Integration { method: Method::Rk4, substeps: 1 };

/// Explicit Euler steps of one sample period.
pub const EULER: Integration = Integration { method: Method::Euler, substeps: 1 };

/// Samples in a run.
pub const SAMPLES: usize = 60;

/// A ship of 85 m with every term of the catalogue at its neutral value.
pub fn model() -> Model {
    let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
    let mut model = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
    model.set_eleven(&[-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370]);
    model.complete().unwrap()
}

/// A model with some parameters set.
pub fn with(values: &[(&str, f64)]) -> Model {
    let mut model = model();
    model.set(values).unwrap();
    model
}

/// A craft with two azimuths abreast and a force as logged, with every term at its neutral value.
pub fn craft() -> Model {
    let azimuth =
        |name: &str, y: f64| format!("[[actuator]]\nname = {name:?}\nx = 0.5\ny = {y:?}\nlaw = \"thruster\"\n");
    let (left, right) = (azimuth("left", -0.3), azimuth("right", 0.3));
    let tau = "[[actuator]]\nname = \"tau\"\nx = -0.4\ny = 0.1\nlaw = \"force\"\n";
    let text = format!("name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n{left}{right}{tau}");
    let ship = Ship::parse(&text, Path::new("ship.toml")).unwrap();
    Model::new(ship, "cat", Form::General, &[]).unwrap().complete().unwrap()
}

/// A run that a craft of [`craft`] sails, measured exactly.
pub fn craft_run(model: &Model) -> Run {
    let dt = 0.1;
    let input = |k: usize| {
        let t = dt * k as f64;
        let mut input = Inputs::actuators(t, 0.0, 0.0);
        let [left, right] = [10.0 + 6.0 * (0.7 * t).sin(), 9.0 + 8.0 * (0.4 * t).cos()];
        let commands = [left, 0.3 * t.sin(), right, 0.1 + 0.2 * t.cos(), 1.0, 0.5 * t.sin(), 0.2 * t.cos()];
        input.commands[..commands.len()].copy_from_slice(&commands);
        input
    };
    let inputs: Vec<Inputs<f64>> = (0..SAMPLES).map(input).collect();
    let initial = [1.0, 2.0, 0.3, 0.5, 0.05, 0.1];
    let scenario = Scenario { dt, inputs: inputs.clone(), initial };
    let states = simulate(model, &model.values_in("a"), RK4, &scenario).states;
    Run { dt, recorded_dt: dt, inputs, initial, measured: measured(&states), ..runs(&self::model(), 1).remove(0) }
}

/// Sensors of a good survey ship, and little unknown force.
pub fn noise() -> Noise {
    let sensor = |white: f64| SensorNoise { white, coloured: 0.3 * white, time: 8.0 };
    Noise { sensors: [0.3, 0.002, 0.02, 0.0005].map(sensor), force: [5e2, 5e2, 2e4], force_time: 20.0 }
}

/// Turns to both sides, zigzags and stops on headings all round, in the sessions `a` and `b` by turns.
pub fn runs(model: &Model, count: usize) -> Vec<Run> {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    (0..count).map(|i| run(model, i, &mut rng)).collect()
}

fn run(model: &Model, i: usize, rng: &mut ChaCha8Rng) -> Run {
    let dt = 3.0;
    let input = |k: usize| {
        let t = dt * k as f64;
        let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let delta = match i % 3 {
            0 => side * 0.4,
            1 => side * 0.3 * (t / 25.0).sin(),
            _ => 0.05 * side,
        };
        let n = if i % 3 == 2 && t > 60.0 { -1.5 } else { 2.0 + 0.3 * (i % 4) as f64 };
        Inputs::actuators(t, n, delta)
    };
    let inputs: Vec<Inputs<f64>> = (0..SAMPLES).map(input).collect();
    let initial = [0.0, 0.0, 2.4 * i as f64, 4.0, 0.0, 0.0];
    let session = if (i / 2).is_multiple_of(2) { "a" } else { "b" };
    let scenario = Scenario { dt, inputs: inputs.clone(), initial };
    let states = simulate(model, &model.values_in(session), RK4, &scenario).states;
    let sizes = [0.3, 0.3, 0.002, 0.02, 0.02, 0.0005];
    let mut measure = |s: &[f64; 6]| -> [f64; 6] {
        std::array::from_fn(|c| {
            let e: f64 = StandardNormal.sample(rng);
            s[c] + sizes[c] * e
        })
    };
    let samples: Vec<[f64; 6]> = states.iter().map(&mut measure).collect();
    Run {
        name: format!("run {i}"),
        recording: format!("run {i}"),
        session: session.into(),
        manoeuvre: ["turn", "zigzag", "stop"][i % 3].into(),
        split: Split::Train,
        dt,
        recorded_dt: dt,
        inputs,
        initial: samples[0],
        measured: measured(&samples),
        disturbed: Vec::new(),
        derived: [false; 6],
    }
}

/// Runs of [`runs`] whose sensors err.
pub fn erring(errors: &[(&str, f64)], count: usize) -> Vec<Run> {
    erring_as(&model(), errors, count)
}

/// As [`erring`], with the sensors of a model.
pub fn erring_as(model: &Model, errors: &[(&str, f64)], count: usize) -> Vec<Run> {
    let mut with = model.clone();
    with.set(errors).unwrap();
    let dynamics = Dynamics::new(&with, with.values_in(""));
    let mut runs = runs(model, count);
    for run in &mut runs {
        for (m, input) in run.measured.iter_mut().zip(&run.inputs) {
            *m = dynamics.report(&m.map(Option::unwrap), input).map(Some);
        }
        run.initial = dynamics.report(&run.initial, &run.inputs[0]);
    }
    runs
}

/// Runs of [`runs`] as a program with explicit Euler steps of one sample period makes them, with the same errors of the sensors.
pub fn made_by_euler(model: &Model, count: usize) -> Vec<Run> {
    let mut runs = runs(model, count);
    for run in &mut runs {
        let [fine, made] = [RK4, EULER].map(|steps| sailed(model, run, steps));
        for ((m, a), b) in run.measured.iter_mut().zip(&fine).zip(&made) {
            (0..6).for_each(|c| m[c] = m[c].map(|v| v + b[c] - a[c]));
        }
    }
    runs
}

/// The states of a run as a model sails it from the run's start.
pub fn sailed(model: &Model, run: &Run, steps: Integration) -> Vec<[f64; 6]> {
    let scenario = Scenario { dt: run.dt, inputs: run.inputs.clone(), initial: run.initial };
    simulate(model, &model.values_in(&run.session), steps, &scenario).states
}

/// An estimate at a model's values with the noise above and its own free parameters.
pub fn at(model: &Model) -> Estimate {
    let free = crate::likelihood::parameters::base_parameters(model, false);
    Estimate { model: model.clone(), noise: noise(), free, log_posterior: 0.0, seen: None }
}

/// A mechanism of the catalogue as a candidate.
pub fn candidate(model: &Model, name: &str) -> Candidate {
    candidates(model, &[]).into_iter().find(|c| c.mechanism.name == name).unwrap()
}

/// A parameter of a model by its dotted name, as a column.
pub fn column(model: &Model, name: &str) -> Column {
    Column::tangent(model, model.find(name).unwrap())
}

/// A suspected finding of a force on the ship, with its confidence set.
pub fn finding(mechanism: &str, title: &str, set: &[&str]) -> Finding {
    Finding {
        mechanism: mechanism.into(),
        title: title.into(),
        kind: Kind::Environment,
        confidence_set: set.iter().map(|s| (*s).to_owned()).collect(),
        why: String::new(),
        sessions: Vec::new(),
        by_session: false,
        statistic: 0.0,
        p: 0.0,
        equations: Equations::default(),
        windows: Vec::new(),
        region: None,
        signature: String::new(),
        parameters: vec![Amplitude::new("current.north".into(), 0.1234, "m/s", 0.01)],
        grade: Grade::Suspected,
        change: None,
        held_out: None,
    }
}
