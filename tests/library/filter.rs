//! Laws of the filter behind the diagnosis: its scores are unbiased at the truth, with the variance of their information.
//! The recordings are made here, by the model itself with gusts and coloured sensors.

use crate::support::{STAR, model, runs, truth_noise};
use rayon::prelude::*;
use trimtab::likelihood::estimate::{Effort, FreeParameter, estimate, log_posterior};
use trimtab::likelihood::evidence::{Evidence, RunEvidence};
use trimtab::likelihood::filter::{Column, Filter, GATE, Wanted};
use trimtab::likelihood::noise::fit::{KeptInformation, fit_noise, guess};
use trimtab::likelihood::noise::{NOISE_PARAMETERS, Noise, NoisePrior, SensorNoise};
use trimtab::model::{ELEVEN, Model};
use trimtab::physics::Probe;
use trimtab::simulate::{Integration, Method};

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
fn scores_at_the_truth_have_the_variance_of_their_information() {
    let model = model();
    let noise = truth_noise();
    let mut names = ELEVEN.to_vec();
    names.extend(["hull.Yv", "hull.Nv", "hull.Nr", "hull.Xudot"]);
    let columns = columns(&model, &names);
    let filter = Filter::new(&model, RK4, &columns);
    let start = std::time::Instant::now();
    let passes: Vec<_> = filter.passes(&runs(&model, &noise, 60, 7), &noise, Wanted::default());
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
        let passes: Vec<_> =
            data.par_iter().map(|r| filter.pass(r, &estimate, Wanted { tangent: true, ..Wanted::default() })).collect();
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
        if (1..4).contains(&round) {
            let clock = std::time::Instant::now();
            let tangents: Vec<_> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
            let r: Vec<_> = data.iter().collect();
            estimate = fit_noise(&r, &tangents, &model, &estimate, &prior, GATE, 12, &mut KeptInformation::default());
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

#[test]
fn fitted_noise_is_the_most_likely_one() {
    let (model, truth) = (model(), truth_noise());
    let data = runs(&model, &truth, 12, 31);
    let filter = Filter::new(&model, RK4, &[]);
    let start = guess(&data, &model);
    let prior = NoisePrior::around(&start);
    let pass = |noise: &Noise| -> Vec<_> {
        data.iter().map(|r| filter.pass(r, noise, Wanted { tangent: true, ..Wanted::default() })).collect()
    };
    let mut noise = start;
    for _ in 0..3 {
        let passes = pass(&noise);
        let tangents: Vec<_> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
        let all: Vec<_> = data.iter().collect();
        noise = fit_noise(&all, &tangents, &model, &noise, &prior, GATE, 20, &mut KeptInformation::default());
    }
    let likelihood = |noise: &Noise| pass(noise).iter().map(|p| p.log_likelihood).sum::<f64>();
    let best = likelihood(&noise);
    assert!(best > likelihood(&start) && best > likelihood(&truth) - 1.0);
    // The weak priors move it a little.
    for i in 0..NOISE_PARAMETERS {
        for factor in [0.8f64, 1.25] {
            let mut v = noise.to_log();
            v[i] += factor.ln();
            let beside = likelihood(&Noise::from_log(&v));
            assert!(beside < best + 0.5, "parameter {i} times {factor}: {beside} over {best}");
        }
    }
}

#[test]
fn noise_is_recovered_from_a_start_that_is_far_too_small() {
    let (model, truth) = (model(), truth_noise());
    let data = runs(&model, &truth, 12, 32);
    let mut start = guess(&data, &model);
    for s in &mut start.sensors {
        (s.white, s.coloured) = (0.05 * s.white, 0.05 * s.coloured);
    }
    start.force = start.force.map(|f| 0.01 * f);
    let aside = |noise: &Noise| -> usize {
        let filter = Filter::new(&model, RK4, &[]);
        data.iter().map(|r| filter.pass(r, noise, Wanted::default()).outliers).sum()
    };
    assert!(aside(&start) > 1000, "{}", aside(&start));
    let effort = Effort { rounds: 4, noise_rounds: 4, noise_iterations: 14 };
    let found = estimate(&model, RK4, &data, &[], &start, &NoisePrior::around(&start), effort).noise;
    assert!(aside(&found) < 10, "{}", aside(&found));
    for (found, truth) in found.sensors.iter().zip(truth.sensors) {
        let total = |s: &SensorNoise| s.white.hypot(s.coloured);
        assert!((total(found) / total(&truth)).ln().abs() < 0.3, "{found:?} for {truth:?}");
    }
}

#[test]
fn an_estimate_at_a_bound_is_the_optimum_within_the_bound() {
    let model = model().complete().unwrap();
    let noise = truth_noise();
    // The ship has a negative cross-flow drag, which the model does not allow.
    let mut truth = model.clone();
    let drag = truth.find("crossflow.drag").unwrap();
    truth.parameters[drag].value = -0.3;
    let data = runs(&truth, &noise, 16, 8);
    let mut names = ELEVEN.to_vec();
    let hull = ["hull.Yv", "hull.Yr", "hull.Nv", "hull.Nr", "hull.Yvv", "hull.Nrr", "hull.inertia", "hull.Nrdot"];
    names.extend(hull);
    names.extend(["flow.wake_ratio", "flow.straightening", "crossflow.drag"]);
    let free: Vec<FreeParameter> =
        names.iter().map(|n| FreeParameter::uncertain(&model, model.index(n).unwrap())).collect();
    let effort = Effort { rounds: 20, noise_rounds: 0, noise_iterations: 0 };
    let from = |start: &Model| estimate(start, RK4, &data, &free, &noise, &NoisePrior::around(&noise), effort);
    let found = from(&model);
    assert_eq!(found.model.parameters[drag].value, 0.0);
    let mut elsewhere = model.clone();
    elsewhere.parameters[drag].value = 0.4;
    for f in &free[ELEVEN.len()..ELEVEN.len() + hull.len()] {
        f.set(&mut elsewhere, f.value(&model) + 0.5 * f.column.scale);
    }
    let again = from(&elsewhere);
    let apart = (found.log_posterior - again.log_posterior).abs();
    assert!(apart < 1.0, "{} and {}", found.log_posterior, again.log_posterior);
    // No setting by hand is more likely.
    for f in &free {
        for side in [-0.05, 0.05] {
            let mut beside = found.model.clone();
            f.set(&mut beside, f.value(&found.model) + side * f.column.scale);
            let value = log_posterior(&beside, RK4, &data, &free, &noise);
            assert!(value < found.log_posterior + 0.5, "{}: {value}", model.parameters[f.column.parameter].name);
        }
    }
}

#[test]
fn with_fixed_gains_the_score_is_the_exact_gradient() {
    let model = model();
    let noise = truth_noise();
    let data = runs(&model, &noise, 4, 3);
    let names = ["rudder.lift1", "resistance.linear", "hull.Yv", "flow.wake"];
    let columns = columns(&model, &names);
    for run in &data {
        let filter = Filter::new(&model, RK4, &columns);
        let gains = filter.pass(run, &noise, Wanted { gains: true, ..Wanted::default() }).gains.unwrap();
        let frozen = Wanted { frozen: Some(std::slice::from_ref(&gains)), exact: true, ..Wanted::default() };
        let objective = |model: &trimtab::model::Model| -> f64 {
            let pass = Filter::new(model, RK4, &[]).pass(run, &noise, frozen);
            pass.innovations.iter().flatten().filter(|e| e.is_finite()).map(|e| 0.5 * e * e).sum()
        };
        let score = filter.pass(run, &noise, frozen).score;
        for (c, column) in columns.iter().enumerate() {
            let step = 1e-4 * column.scale;
            let at = |side: f64| {
                let mut moved = model.clone();
                moved.parameters[column.parameter].value += side * step;
                objective(&moved)
            };
            let difference = (at(1.0) - at(-1.0)) / 2e-4;
            let error = (score[c] + difference).abs();
            assert!(error < 1e-5 * (1.0 + difference.abs()), "{}: {} against {}", names[c], -score[c], difference);
        }
    }
}
