//! Laws of the filter behind the diagnosis: its scores are unbiased at the truth and as large as their information says.
//! The recordings are made here, by the model itself with gusts and coloured sensors.

#![allow(clippy::unwrap_used)]

mod support;

use rayon::prelude::*;
use support::{STAR, model, runs, truth_noise};
use trimtab::diagnose::evidence::{Evidence, RunEvidence};
use trimtab::diagnose::filter::{Column, Filter, Probe, Wanted};
use trimtab::diagnose::noise::{NoisePrior, fit_noise, guess};
use trimtab::model::{ELEVEN, Model};
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
fn scores_at_the_truth_are_as_large_as_their_information() {
    let model = model();
    let noise = truth_noise();
    let mut names = ELEVEN.to_vec();
    names.extend(["hull.Yv", "hull.Nv", "hull.Nr", "hull.Xudot"]);
    let columns = columns(&model, &names);
    let filter = Filter::new(&model, RK4, &columns);
    let start = std::time::Instant::now();
    let passes: Vec<_> =
        runs(&model, &noise, 60, 7).par_iter().map(|r| filter.pass(r, &noise, Wanted::default())).collect();
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

#[test]
fn with_gains_held_fixed_the_score_is_the_exact_gradient() {
    let model = model();
    let noise = truth_noise();
    let data = runs(&model, &noise, 4, 3);
    let names = ["rudder.lift1", "resistance.linear", "hull.Yv", "flow.wake"];
    let columns = columns(&model, &names);
    for run in &data {
        let filter = Filter::new(&model, RK4, &columns);
        let gains = filter.pass(run, &noise, Wanted { gains: true, ..Wanted::default() }).gains.unwrap();
        let frozen = Wanted { frozen: Some(&gains), exact: true, ..Wanted::default() };
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
