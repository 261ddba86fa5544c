//! Recordings made by the model itself, with gusts and coloured sensors, for the tests of the diagnosis.
//! The steps are fine RK4 steps; the concealed cases, made by other simulators, are in the experiments.

#![allow(dead_code)]

#[cfg(feature = "cli")]
pub mod study;
pub mod written;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::path::Path;
use trimtab::likelihood::noise::{GROUP_OF, Noise, SensorNoise};
use trimtab::model::Model;
use trimtab::model::dynamics::Dynamics;
use trimtab::physics::Form;
use trimtab::recording::{Measured, Run, Split, measured};
use trimtab::ship::Ship;
use trimtab::ship::state::{Force, Inputs, State};
use trimtab::simulate::{Integration, Method, driven, step};

/// Says on the terminal why a test is skipped: what the macros print is captured while a test passes.
pub fn skipped(why: &str) {
    drop(std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("skipped: {why}\n")));
}

pub const STAR: [f64; 11] = [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370];

pub fn model() -> Model {
    let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
    let mut model = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
    model.set_eleven(&STAR);
    model
}

pub fn truth_noise() -> Noise {
    let sensor = |s: f64| SensorNoise { white: 0.8 * s, coloured: 0.6 * s, time: 10.0 };
    Noise {
        sensors: [sensor(0.5), sensor(0.1f64.to_radians()), sensor(0.04), sensor(0.02f64.to_radians())],
        force: [2e3, 2e3, 6e4],
        force_time: 20.0,
    }
}

/// Adds to what was measured in one channel.
pub fn add(m: &mut Measured, channel: usize, amount: f64) {
    m[channel] = m[channel].map(|v| v + amount);
}

pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Runs of 120 steps of 2 s: turns, zigzags, random steps, stops.
pub fn runs(model: &Model, noise: &Noise, count: usize, seed: u64) -> Vec<Run> {
    commanded(model, noise, count, seed, &|_, _| 0.0)
}

/// [`runs`] with a bow thruster, whose command is given by run and time \[s\].
pub fn commanded(
    model: &Model,
    noise: &Noise,
    count: usize,
    seed: u64,
    thruster: &dyn Fn(usize, f64) -> f64,
) -> Vec<Run> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count)
        .map(|i| {
            let n0 = 2.0 + 1.5 * normal(&mut rng).tanh();
            let inputs = orders(i, n0, thruster);
            let heading = std::f64::consts::TAU * (i as f64 * 0.618_034).fract();
            let session = format!("s{}", (i / 4) % 4);
            let theta = model.values_in(&session);
            let states = reported(model, &theta, noise, &inputs, DT, [0.0, 0.0, heading, 1.8 * n0, 0.0, 0.0], &mut rng);
            recorded(i, session, DT, inputs, &states)
        })
        .collect()
}

/// Sample period \[s\].
const DT: f64 = 2.0;

/// The recorded orders of run `i` with a first propeller rate \[rps\].
fn orders(i: usize, n0: f64, thruster: &dyn Fn(usize, f64) -> f64) -> Vec<Inputs<f64>> {
    let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut delta: f64 = 0.0;
    let mut n = n0;
    let at = |k: i32| {
        let t = f64::from(k) * DT;
        let goal = match i % 4 {
            0 => side * 0.5,
            1 => side * 0.35 * (t / 25.0).sin().signum(),
            2 => 0.3 * (t / 17.0 + i as f64).sin(),
            _ => 0.1 * side,
        };
        let n_goal = if i % 4 == 3 && t > 80.0 { -2.0 } else { n0 };
        delta += (goal - delta).clamp(-0.09, 0.09);
        n += (n_goal - n).clamp(-0.2, 0.2);
        Inputs { thruster: thruster(i, t), ..Inputs::actuators(t, n, delta) }
    };
    (0..121).map(at).collect()
}

/// A catamaran of 1.2 m with a thruster in each hull, called left and right, and nothing else.
pub fn catamaran() -> Model {
    let thruster = |name: &str, y: f64| {
        format!("[[actuator]]\nname = {name:?}\nx = -0.4\ny = {y:?}\nangle = 0\nlaw = \"thruster\"\n")
    };
    let (left, right) = (thruster("left", -0.3), thruster("right", 0.3));
    let text = format!("name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n{left}{right}");
    let ship = Ship::parse(&text, Path::new("ship.toml")).unwrap();
    Model::new(ship, "cat", Form::General, &[]).unwrap()
}

/// Runs of 150 steps of 0.2 s of a catamaran: turns to both sides, weaving, stops and random steps of its thrusters.
pub fn catamaran_runs(model: &Model, count: usize, seed: u64) -> Vec<Run> {
    const STEP: f64 = 0.2;
    let sensor = |s: f64| SensorNoise { white: 0.8 * s, coloured: 0.6 * s, time: 1.0 };
    let noise = Noise {
        sensors: [sensor(0.02), sensor(0.002), sensor(0.01), sensor(0.003)],
        force: [0.05, 0.05, 0.01],
        force_time: 2.0,
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count)
        .map(|i| {
            let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let (speed, mut steps) = (12.0 + 6.0 * normal(&mut rng).tanh(), [0.0; 2]);
            let mut at = |k: i32| {
                let t = f64::from(k) * STEP;
                if k % 20 == 0 {
                    steps = [10.0 * normal(&mut rng), 10.0 * normal(&mut rng)];
                }
                let [ahead, turning] = match i % 4 {
                    0 => [speed, 6.0 * side],
                    1 => [speed, 8.0 * (t / 2.5 + i as f64).sin()],
                    2 => [if t > 15.0 { -speed } else { speed }, 4.0 * side],
                    _ => steps,
                };
                let mut inputs = Inputs::actuators(t, 0.0, 0.0);
                (inputs.commands[0], inputs.commands[1]) = (ahead + turning, ahead - turning);
                inputs
            };
            let inputs: Vec<Inputs<f64>> = (0..151).map(&mut at).collect();
            let heading = std::f64::consts::TAU * (i as f64 * 0.618_034).fract();
            let session = format!("s{}", (i / 4) % 4);
            let theta = model.values_in(&session);
            let states = reported(model, &theta, &noise, &inputs, STEP, [0.0, 0.0, heading, 0.8, 0.0, 0.0], &mut rng);
            recorded(i, session, STEP, inputs, &states)
        })
        .collect()
}

/// Run number `i`, a recording of its own, of states reported each `dt` \[s\] under these orders.
fn recorded(i: usize, session: String, dt: f64, inputs: Vec<Inputs<f64>>, states: &[[f64; 6]]) -> Run {
    Run {
        name: format!("run {i}"),
        recording: format!("run {i}"),
        session,
        manoeuvre: String::new(),
        split: Split::Train,
        dt,
        recorded_dt: dt,
        inputs,
        initial: states[0],
        measured: measured(states),
        disturbed: Vec::new(),
        derived: [false; 6],
    }
}

/// The states that noisy sensors report of a ship under these orders, one each `dt` \[s\], and an Ornstein-Uhlenbeck force.
fn reported(
    model: &Model,
    theta: &[f64],
    noise: &Noise,
    orders: &[Inputs<f64>],
    dt: f64,
    initial: [f64; 6],
    rng: &mut ChaCha8Rng,
) -> Vec<[f64; 6]> {
    let mut state = initial;
    let mut force = [0.0; 3];
    let mut colour = [0.0; 6];
    for c in 0..6 {
        colour[c] = noise.sensors[GROUP_OF[c]].coloured * normal(rng);
    }
    // The actuators that follow from the orders.
    let fine = Integration { method: Method::Rk4, substeps: 8 };
    let one = Integration { substeps: 1, ..fine };
    let dynamics = Dynamics::new(model, theta.to_vec());
    let series = driven(&dynamics, fine, dt, orders);
    let h = dt / fine.substeps as f64;
    let mut states = Vec::new();
    for k in 0..orders.len() {
        let now = State::from_array(state);
        let at = k * fine.instants();
        let (rates, flow) = dynamics.rates(&now, &series[at], &Force::zero());
        let mut y = dynamics.measure(&now, &series[at], &rates, &flow);
        for c in 0..6 {
            let s = noise.sensors[GROUP_OF[c]];
            y[c] += colour[c] + s.white * normal(rng);
            let rho = (-dt / s.time).exp();
            colour[c] = rho * colour[c] + s.coloured * (1.0 - rho * rho).sqrt() * normal(rng);
        }
        states.push(y);
        if k + 1 == orders.len() {
            break;
        }
        for f in 0..fine.substeps {
            let push = Force { x: force[0], y: force[1], n: force[2] };
            state = step(&dynamics, one, h, &state, &series[at + f * one.instants()..], &push);
            let rho = (-h / noise.force_time).exp();
            for e in 0..3 {
                force[e] = rho * force[e] + noise.force[e] * (1.0 - rho * rho).sqrt() * normal(rng);
            }
        }
    }
    states
}
