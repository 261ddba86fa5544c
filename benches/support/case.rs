//! The fit that the benchmarks time: ship A, 165 runs of 120 steps, recordings made with the published p* and disturbed.
//! It times nothing itself; the bench and the export for other tools include this file, so that both use one case.

use std::path::Path;
use trimtab::fit::{Cost, CostOptions, Derivatives, FitSettings, Limits};
use trimtab::model::Model;
use trimtab::physics::Form;
use trimtab::recording::{Run, Split, measured};
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;
use trimtab::simulate::{Integration, Scenario, simulate};

const STAR: [f64; 11] = [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370];
const RUNS: usize = 165;
const STEPS: usize = 120;

/// Ship A in the paper's form, its eleven parameters free and at the published baseline p~.
pub fn ship_a() -> Model {
    let path = format!("{}/experiments/ships/a.toml", env!("CARGO_MANIFEST_DIR"));
    Ship::read(Path::new(&path))
        .map_err(|e| e.to_string())
        .and_then(|ship| Model::new(ship, "HD", Form::Paper, &[]).map_err(|e| e.to_string()))
        .unwrap_or_else(|e| unreachable!("{e}"))
}

/// Runs of the model with p*, ahead and astern, with the rudder weaving, and a disturbance that no parameter explains.
pub fn recordings(dt: f64) -> Vec<Run> {
    let mut truth = ship_a();
    truth.set_eleven(&STAR);
    (0..RUNS)
        .map(|i| {
            let phase = i as f64;
            let input = |k: usize| {
                let t = k as f64 * dt;
                let n = 1.6 + 1.8 * (0.7 * phase).sin() + 1.5 * (t / 50.0 + phase).sin();
                Inputs::actuators(t, n, 0.5 * (t / (15.0 + 20.0 * (1.3 * phase).sin().abs()) + 2.0 * phase).sin())
            };
            let inputs: Vec<Inputs<f64>> = (0..STEPS).map(input).collect();
            let initial = [0.0, 0.0, phase, 3.3 + 2.0 * (2.1 * phase).sin(), 0.0, 0.0];
            let scenario = Scenario { dt, inputs: inputs.clone(), initial };
            let mut states = simulate(&truth, &truth.values(), Integration::default(), &scenario).states;
            for (k, m) in states.iter_mut().enumerate() {
                m[0] += (0.1 * k as f64 + phase).sin();
                m[1] += (0.1 * k as f64 + 2.0 * phase).cos();
                m[4] += 0.02 * (0.2 * k as f64 + phase).cos();
            }
            Run {
                name: format!("run {i}"),
                recording: format!("run {i}"),
                session: String::new(),
                manoeuvre: String::new(),
                split: Split::Train,
                dt,
                recorded_dt: dt,
                inputs,
                measured: measured(&states),
                initial,
                disturbed: Vec::new(),
                derived: [false; 6],
            }
        })
        .collect()
}

/// The cost of a model against runs, its derivatives from the source named.
pub fn cost<'a>(model: &'a Model, runs: &'a [Run], derivatives: Derivatives) -> Cost<'a> {
    let options =
        CostOptions { max_yaw_rate: 0.0314, derivatives, difference_step: 1e-5, integration: Integration::default() };
    Cost::new(model, runs, options).unwrap_or_else(|e| unreachable!("{e}"))
}

/// Settings of a fit under the paper's constraints, 298 rows for these recordings.
pub fn settings() -> FitSettings {
    let mut settings = FitSettings::default();
    settings.constraints.limits = Limits::Paper;
    settings.constraints.tolerance = 2e-3;
    settings
}
