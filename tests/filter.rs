//! Laws of the filter behind the diagnosis: its scores are unbiased at the truth and as large as their information says.
//! The recordings are made here, by the model itself with gusts and coloured sensors.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use std::path::Path;
use trimtab::diagnose::evidence::{Evidence, RunEvidence};
use trimtab::diagnose::filter::{Column, Filter, Probe, Run};
use trimtab::diagnose::noise::{GROUP_OF, Noise, NoisePrior, SensorNoise, fit_noise, guess};
use trimtab::model::{ELEVEN, Model};
use trimtab::ship::Ship;
use trimtab::simulate::{Integration, Method, step};
use trimtab::state::{Force, Inputs};
use trimtab::terms::Form;

const STAR: [f64; 11] = [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370];

fn model() -> Model {
    let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
    let mut model = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
    model.set_eleven(&STAR);
    model
}

fn truth_noise() -> Noise {
    let sensor = |s: f64| SensorNoise { white: 0.8 * s, coloured: 0.6 * s, time: 10.0 };
    Noise {
        sensors: [sensor(0.5), sensor(0.1f64.to_radians()), sensor(0.04), sensor(0.02f64.to_radians())],
        force: [2e3, 2e3, 6e4],
        force_time: 20.0,
    }
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Runs of 120 steps of 2 s: turns, zigzags, random steps, stops.
fn runs(model: &Model, noise: &Noise, count: usize, seed: u64) -> Vec<Run> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let theta = model.values();
    (0..count)
        .map(|i| {
            let dt = 2.0;
            let n0 = 2.0 + 1.5 * normal(&mut rng).tanh();
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let mut delta: f64 = 0.0;
            let mut n = n0;
            let mut inputs = Vec::new();
            for k in 0..121 {
                let t = k as f64 * dt;
                let goal = match i % 4 {
                    0 => side * 0.5,
                    1 => side * 0.35 * (t / 25.0).sin().signum(),
                    2 => 0.3 * (t / 17.0 + i as f64).sin(),
                    _ => 0.1 * side,
                };
                let n_goal = if i % 4 == 3 && t > 80.0 { -2.0 } else { n0 };
                delta += (goal - delta).clamp(-0.09, 0.09);
                n += (n_goal - n).clamp(-0.2, 0.2);
                inputs.push(Inputs::actuators(t, n, delta));
            }
            let heading = 6.28 * (i as f64 / count as f64);
            let initial = [0.0, 0.0, heading, 1.8 * n0, 0.0, 0.0];
            let mut state = initial;
            let mut force = [0.0; 3];
            let mut colour = [0.0; 6];
            for c in 0..6 {
                colour[c] = noise.sensors[GROUP_OF[c]].coloured * normal(&mut rng);
            }
            let fine = 8;
            let h = dt / fine as f64;
            let mut measured = Vec::new();
            for k in 0..121 {
                let mut y = state;
                for c in 0..6 {
                    let s = noise.sensors[GROUP_OF[c]];
                    y[c] += colour[c] + s.white * normal(&mut rng);
                    let rho = (-dt / s.time).exp();
                    colour[c] = rho * colour[c] + s.coloured * (1.0 - rho * rho).sqrt() * normal(&mut rng);
                }
                measured.push(y);
                if k == 120 {
                    break;
                }
                for f in 0..fine {
                    let at = |x: f64| inputs[k].between(&inputs[k + 1], x);
                    let (a, b) = (at(f as f64 / fine as f64), at((f + 1) as f64 / fine as f64));
                    let push = Force { x: force[0], y: force[1], n: force[2] };
                    let rk4 = Integration { method: Method::Rk4, substeps: 1 };
                    state = step(model, &theta, rk4, h, &state, &a, &b, &push);
                    let rho = (-h / noise.force_time).exp();
                    for e in 0..3 {
                        force[e] = rho * force[e] + noise.force[e] * (1.0 - rho * rho).sqrt() * normal(&mut rng);
                    }
                }
            }
            Run {
                name: format!("run {i}"),
                session: format!("s{}", i % 4),
                manoeuvre: String::new(),
                dt,
                inputs,
                initial: measured[0],
                measured,
                channels: [true; 6],
            }
        })
        .collect()
}

fn columns(model: &Model, names: &[&str]) -> Vec<Column> {
    names
        .iter()
        .map(|n| {
            let parameter = model.index(n).unwrap();
            Column { parameter, scale: model.parameters[parameter].scale, probe: Probe::Tangent }
        })
        .collect()
}

const RK4: Integration = Integration { method: Method::Rk4, substeps: 1 };

#[test]
fn scores_at_the_truth_are_as_large_as_their_information() {
    let model = model();
    let noise = truth_noise();
    let mut names = ELEVEN.to_vec();
    names.extend(["hull.Yv", "hull.Nv", "hull.Nr", "hull.Xudot"]);
    let columns = columns(&model, &names);
    let filter = Filter::new(&model, RK4, &columns);
    let start = std::time::Instant::now();
    let passes: Vec<_> = runs(&model, &noise, 60, 7).par_iter().map(|r| filter.pass(r, &noise, None, false)).collect();
    println!("60 runs in {:?}", start.elapsed());
    // Standardised total scores by column: standard normal if the filter is right.
    let mut squares = Vec::new();
    for c in 0..names.len() {
        let g: f64 = passes.iter().map(|p| p.score[c]).sum();
        let h: f64 = passes.iter().map(|p| p.information[(c, c)]).sum();
        squares.push(g / h.sqrt());
    }
    println!("{squares:.2?}");
    for (name, z) in names.iter().zip(&squares) {
        assert!(z.abs() < 4.0, "{name}: standardised score {z}");
    }
    // Over runs and columns the mean square is one.
    let (mut sum, mut count) = (0.0, 0.0);
    for p in &passes {
        for c in 0..names.len() {
            if p.information[(c, c)] > 1e-6 {
                sum += p.score[c] * p.score[c] / p.information[(c, c)];
                count += 1.0;
            }
        }
    }
    println!("mean square {}", sum / count);
    assert!((0.7..1.3).contains(&(sum / count)), "mean square of standardised scores {}", sum / count);
    let innovations: Vec<f64> =
        passes.iter().flat_map(|p| p.innovations.iter().flatten().copied()).filter(|v| v.is_finite()).collect();
    let variance = innovations.iter().map(|v| v * v).sum::<f64>() / innovations.len() as f64;
    println!("innovation variance {variance}");
    assert!((0.95..1.05).contains(&variance), "variance of standardised innovations {variance}");
}

#[test]
fn noise_is_recovered_and_the_fisher_step_finds_the_parameters() {
    let truth = model();
    let noise = truth_noise();
    let data = runs(&truth, &noise, 30, 11);
    let mut model = truth.clone();
    let mut start = STAR;
    for (i, v) in start.iter_mut().enumerate() {
        *v *= if i % 2 == 0 { 1.15 } else { 0.9 };
    }
    model.set_eleven(&start);
    let columns = columns(&model, &ELEVEN);
    let mut estimate = guess(&data, &model);
    println!("guess {estimate:?}");
    let prior = NoisePrior::around(&estimate);
    for round in 0..6 {
        let clock = std::time::Instant::now();
        let filter = Filter::new(&model, RK4, &columns);
        let passes: Vec<_> = data.par_iter().map(|r| filter.pass(r, &estimate, None, true)).collect();
        let evidence = Evidence::new(
            passes
                .iter()
                .zip(&data)
                .map(|(p, r)| RunEvidence {
                    session: r.session.clone(),
                    score: p.score.clone(),
                    information: p.information.clone(),
                })
                .collect(),
        );
        let all: Vec<usize> = (0..11).collect();
        let step = evidence.base(&all, &[0.0; 11], &[0.0; 11]).step();
        let l: f64 = passes.iter().map(|p| p.log_likelihood).sum();
        println!("round {round}: {l:.1} step {:.3} in {:?}", step.amax(), clock.elapsed());
        for (c, s) in columns.iter().zip(step.iter()) {
            model.parameters[c.parameter].value += s * c.scale;
        }
        if round >= 1 && round < 4 {
            let clock = std::time::Instant::now();
            let tangents: Vec<_> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
            let r: Vec<_> = data.iter().collect();
            estimate = fit_noise(&r, &tangents, &model, &estimate, &prior, 12);
            println!("noise in {:?}: {estimate:?}", clock.elapsed());
        }
    }
    for (found, expected) in estimate.force.iter().zip(noise.force) {
        assert!((found / expected).ln().abs() < 0.4, "force noise {found} for {expected}");
    }
    for (name, expected) in ELEVEN.iter().zip(STAR).filter(|(_, v)| v.abs() > 0.1) {
        let i = model.index(name).unwrap();
        println!("{name}: {} for {expected}", model.parameters[i].value);
    }
    let i = model.index("rudder.lift1").unwrap();
    assert!((model.parameters[i].value - 3.193).abs() < 0.15);
}
