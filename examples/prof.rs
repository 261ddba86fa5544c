#![allow(clippy::unwrap_used, dead_code, unused_imports, missing_docs)]
//! Time of what a fit of the paper's size is made of: 165 runs of 120 steps, 11 parameters.
//! Results and the questions they answer are in README.md; no test depends on them.

use std::hint::black_box;
use std::path::Path;
use trimtab::fit::{Cost, CostOptions, Derivatives, FitSettings, Hessian, Limits, fit};
use trimtab::model::Model;
use trimtab::physics::Form;
use trimtab::recording::{Run, Split, measured};
use trimtab::ship::Ship;
use trimtab::simulate::{Integration, Scenario, simulate};
use trimtab::state::Inputs;

const STAR: [f64; 11] = [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370];
const RUNS: usize = 165;
const STEPS: usize = 120;

fn ship_a() -> Model {
    let path = format!("{}/experiments/ships/a.toml", env!("CARGO_MANIFEST_DIR"));
    Ship::read(Path::new(&path))
        .map_err(|e| e.to_string())
        .and_then(|ship| Model::new(ship, "HD", Form::Paper, &[]).map_err(|e| e.to_string()))
        .unwrap_or_else(|e| unreachable!("{e}"))
}

/// Runs of the model with p*, ahead and astern, with the rudder weaving, and a disturbance that no parameter explains.
fn recordings(dt: f64) -> Vec<Run> {
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
                inputs,
                measured: measured(&states),
                initial,
                disturbed: Vec::new(),
            }
        })
        .collect()
}

fn cost<'a>(model: &'a Model, runs: &'a [Run], derivatives: Derivatives) -> Cost<'a> {
    let options =
        CostOptions { max_yaw_rate: 0.0314, derivatives, difference_step: 1e-5, integration: Integration::default() };
    Cost::new(model, runs, options).unwrap_or_else(|e| unreachable!("{e}"))
}

fn main() {
    let (model, runs) = (ship_a(), recordings(3.0));
    let mut model = model;
    for name in std::env::args().skip(3) {
        let i = model.find(&name).unwrap();
        model.parameters[i].free = true;
    }
    let p: Vec<f64> = model.free().iter().map(|i| model.parameters[*i].value).collect();
    let what = std::env::args().nth(1).unwrap();
    let n: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let d = if what.starts_with("d") { Derivatives::FiniteDifferences } else { Derivatives::Lanes };
    let cost = cost(&model, &runs, d);
    let mut best = [f64::INFINITY; 3];
    for _ in 0..n {
        for (i, b) in best.iter_mut().enumerate() {
            let t = std::time::Instant::now();
            match i {
                0 => {
                    if what.contains('r') {
                        black_box(cost.value(&p));
                    }
                }
                1 => {
                    if what.contains('g') {
                        black_box(cost.with_gradient(&p));
                    }
                }
                _ => {
                    if what.contains('q') {
                        black_box(cost.quadratic(&p));
                    }
                }
            }
            *b = b.min(t.elapsed().as_secs_f64() * 1e3);
        }
    }
    println!("{} free; min ms rollout {:.3} gradient {:.3} quadratic {:.3}", p.len(), best[0], best[1], best[2]);
}
