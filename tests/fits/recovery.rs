//! The fit on problems with a known answer: recordings made by the model itself, and small problems computed by hand.
//! It tests the fit, not the quality of any model.

use std::f64::consts::TAU;
use std::path::Path;
use trimtab::fit::{
    Cost, CostOptions, Derivatives, Fit, FitError, FitSettings, Hessian, Limits, MultiStart, Rule, fit, multi_start,
};
use trimtab::model::{Model, Prior};
use trimtab::physics::Form;
use trimtab::recording::{Measured, Run, Split, measured};
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;
use trimtab::simulate::{Integration, Scenario, simulate};

const STAR: [f64; 11] = [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370];
const TILDE: [f64; 11] = [0.0, 10500.0, -1900.0, 346.0, -0.012, 0.864, 0.182, -1.191, 0.005, -0.1230, 0.779];
/// Table 2 of the paper prints this in the order p1, p2, p3, p0, p4..p10.
const INITIAL: [f64; 11] = [0.0, 34187.03, -12569.98, 1586.29, -0.02, 2.70, 0.42, -3.23, 0.06, -0.11, 1.97];

fn model(p: &[f64; 11]) -> Model {
    let path = format!("{}/experiments/ships/a.toml", env!("CARGO_MANIFEST_DIR"));
    let mut model = Model::new(Ship::read(Path::new(&path)).unwrap(), "HD", Form::Paper, &[]).unwrap();
    model.set_eleven(p);
    model
}

/// Propeller rate \[1/s\] and rudder angle \[rad\] at time t \[s\].
type Helm = fn(f64) -> (f64, f64);

/// Manoeuvres that between them determine all eleven parameters, each with its initial surge speed \[m/s\].
const MANOEUVRES: [(&str, f64, Helm); 10] = [
    ("turn to starboard", 5.0, |_| (3.0, 0.52)),
    ("turn to port", 5.0, |_| (3.0, -0.52)),
    ("slow turn", 3.0, |_| (1.8, 0.35)),
    ("zigzag", 5.5, |t| (3.2, 0.35 * (TAU * t / 90.0).sin().signum())),
    ("gentle zigzag", 4.0, |t| (2.5, 0.17 * (TAU * t / 120.0).sin().signum())),
    ("crash stop", 6.0, |t| (if t < 20.0 { 3.3 } else { -2.5 }, 0.05 * (t / 15.0).sin())),
    ("acceleration", 1.0, |t| (3.5, 0.1 * (t / 30.0).sin())),
    ("steps of speed", 4.5, |t| (if (TAU * t / 120.0).sin() >= 0.0 { 3.8 } else { 1.2 }, 0.0)),
    ("astern", 0.5, |t| (-1.5, 0.2 * (t / 40.0).cos())),
    ("coasting", 5.0, |t| (0.4, 0.3 * (t / 25.0).sin())),
];

/// What was measured, with something added in one channel.
fn add(m: &mut Measured, channel: usize, amount: f64) {
    m[channel] = m[channel].map(|v| v + amount);
}

/// Noise-free recordings of the manoeuvres; lengths differ, so that lanes have to be padded.
fn recordings(truth: &Model, dt: f64, samples: usize) -> Vec<Run> {
    let mut runs = Vec::new();
    for (i, (name, speed, helm)) in MANOEUVRES.iter().enumerate() {
        let inputs: Vec<Inputs<f64>> = (0..samples - 3 * i)
            .map(|k| {
                let (n, delta) = helm(k as f64 * dt);
                Inputs::actuators(k as f64 * dt, n, delta)
            })
            .collect();
        let initial = [10.0, -20.0, 0.3 * i as f64, *speed, 0.0, 0.0];
        let scenario = Scenario { dt, inputs: inputs.clone(), initial };
        let trajectory = simulate(truth, &truth.values(), Integration::default(), &scenario);
        assert!(trajectory.diverged_at.is_none(), "{name}");
        runs.push(Run {
            name: (*name).into(),
            recording: (*name).into(),
            session: "pond".into(),
            manoeuvre: (*name).into(),
            split: Split::Train,
            dt,
            recorded_dt: dt,
            inputs,
            measured: measured(&trajectory.states),
            initial,
            disturbed: Vec::new(),
            derived: [false; 6],
        });
    }
    runs
}

/// The paper's constraints, widened just enough to contain its p*, whose lift exceeds 1 by 0.001.
fn settings() -> FitSettings {
    let mut settings = FitSettings::default();
    settings.constraints.limits = Limits::Paper;
    settings.constraints.tolerance = 2e-3;
    settings
}

fn largest_relative_error(fit: &Fit, truth: &[f64; 11]) -> f64 {
    let values = fit.model.eleven();
    (0..11).map(|i| ((values[i] - truth[i]) / truth[i]).abs()).fold(0.0, f64::max)
}

fn quiet(model: &Model, runs: &[Run], settings: &FitSettings) -> Fit {
    fit(model, runs, settings, &mut |_| true).unwrap()
}

#[test]
fn the_published_parameters_are_recovered_from_the_published_baseline() {
    let truth = model(&STAR);
    let runs = recordings(&truth, 2.0, 120);
    let fit = quiet(&model(&TILDE), &runs, &settings());
    println!("{}", fit.report());
    let error = largest_relative_error(&fit, &STAR);
    assert!(fit.converged && error < 1e-6, "largest relative error {error:.1e}\n{}", fit.report());
    assert!(!fit.report().contains("NaN"));
}

#[test]
fn the_published_parameters_are_recovered_from_the_papers_infeasible_guess() {
    let runs = recordings(&model(&STAR), 2.0, 120);
    let fit = quiet(&model(&INITIAL), &runs, &settings());
    let error = largest_relative_error(&fit, &STAR);
    assert!(fit.converged && error < 1e-6, "largest relative error {error:.1e}\n{}", fit.report());
}

#[test]
fn random_starts_recover_the_truth_or_report_that_they_did_not() {
    let truth = model(&STAR);
    let runs = recordings(&truth, 2.0, 120);
    let outcomes = multi_start(&truth, &runs, &settings(), &MultiStart::default(), |_| ());
    assert_eq!(outcomes.len(), 20);
    let mut recovered = 0;
    for (i, outcome) in outcomes.iter().enumerate() {
        println!("start {i}: {}", outcome.brief());
        let Ok(fit) = &outcome.outcome else { continue };
        let error = largest_relative_error(fit, &STAR);
        println!("         largest relative error {error:.1e}");
        if error < 1e-6 {
            recovered += 1;
        } else {
            assert!(!fit.converged || fit.cost > 1e-6, "start {i} claims the optimum but is {error:.1e} off the truth");
        }
    }
    assert!(recovered >= 15, "only {recovered} of 20 starts recovered the truth");
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| quiet(&model(&TILDE), &runs, &settings()))
    };
    let (one, two) = (on(1), on(2));
    assert_eq!(one.iterations, two.iterations);
    let bits = |fit: &Fit| fit.model.eleven().map(f64::to_bits);
    assert_eq!(bits(&one), bits(&two));
    assert_eq!(one.cost.to_bits(), two.cost.to_bits());
}

fn cost<'a>(model: &'a Model, runs: &'a [Run], derivatives: Derivatives) -> Cost<'a> {
    let options =
        CostOptions { max_yaw_rate: 0.0314, derivatives, difference_step: 1e-5, integration: Integration::default() };
    Cost::new(model, runs, options).unwrap()
}

fn free_values(model: &Model) -> Vec<f64> {
    model.free().iter().map(|i| model.parameters[*i].value).collect()
}

fn scales(model: &Model) -> Vec<f64> {
    model.free().iter().map(|i| model.parameters[*i].scale).collect()
}

/// Largest difference of two lists, entry by entry, relative to the largest entry.
fn difference(a: impl IntoIterator<Item = f64>, b: impl IntoIterator<Item = f64>) -> f64 {
    let pairs: Vec<(f64, f64)> = a.into_iter().zip(b).collect();
    let size = pairs.iter().map(|p| p.0.abs()).fold(0.0, f64::max);
    pairs.iter().map(|p| (p.0 - p.1).abs()).fold(0.0, f64::max) / size
}

/// Frees enough hull coefficients that the derivatives no longer fit into one chunk.
fn with_hull_free(mut model: Model) -> Model {
    for name in ["hull.Yv", "hull.Nv", "hull.Nr", "hull.Yr", "hull.Nrr", "flow.wake"] {
        let i = model.index(name).unwrap();
        model.parameters[i].free = true;
    }
    model
}

#[test]
fn every_source_of_derivatives_gives_the_same_gradient_and_gauss_newton_matrix() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    for model in [model(&TILDE), with_hull_free(model(&TILDE))] {
        let p = free_values(&model);
        let s = scales(&model);
        let oracle = cost(&model, &runs, Derivatives::NumDual).quadratic(&p).unwrap();
        for (derivatives, tolerance) in [
            (Derivatives::Lanes, 1e-9),
            (Derivatives::Dual, 1e-9),
            (Derivatives::FiniteDifferences, 1e-5),
            (Derivatives::ForwardDifferences, 1e-2),
        ] {
            let found = cost(&model, &runs, derivatives).quadratic(&p).unwrap();
            assert!((found.value / oracle.value - 1.0).abs() < 1e-10);
            let scaled = |g: &nalgebra::DVector<f64>| (0..s.len()).map(|i| g[i] * s[i]).collect::<Vec<_>>();
            let off = difference(scaled(&oracle.gradient), scaled(&found.gradient));
            assert!(off < tolerance, "{derivatives:?}: gradient off by {off:.1e}");
            let scaled = |h: &nalgebra::DMatrix<f64>| {
                (0..s.len())
                    .flat_map(|i| (0..s.len()).map(move |j| (i, j)))
                    .map(|(i, j)| h[(i, j)] * s[i] * s[j])
                    .collect::<Vec<_>>()
            };
            let off = difference(scaled(&oracle.gauss_newton), scaled(&found.gauss_newton));
            assert!(off < tolerance, "{derivatives:?}: Gauss-Newton matrix off by {off:.1e}");
        }
    }
}

#[test]
fn the_gradient_matches_central_differences_of_the_cost() {
    let model = model(&TILDE);
    let runs = recordings(&self::model(&STAR), 2.0, 60);
    let cost = cost(&model, &runs, Derivatives::Lanes);
    let (p, s) = (free_values(&model), scales(&model));
    let exact = cost.quadratic(&p).unwrap().gradient;
    let estimate: Vec<f64> = (0..p.len())
        .map(|j| {
            let at = |sign: f64| {
                let mut moved = p.clone();
                moved[j] += sign * 1e-4 * s[j];
                cost.value(&moved).unwrap()
            };
            (at(1.0) - at(-1.0)) / 2e-4
        })
        .collect();
    let off = difference((0..p.len()).map(|j| exact[j] * s[j]), estimate);
    assert!(off < 1e-6, "gradient off by {off:.1e}");
}

#[test]
fn the_exact_hessian_matches_differences_of_gradients() {
    let runs = recordings(&self::model(&STAR), 2.0, 60);
    let model = with_hull_free(model(&TILDE));
    let cost = cost(&model, &runs, Derivatives::Lanes);
    let (p, s) = (free_values(&model), scales(&model));
    let n = p.len();
    let exact = cost.hessian(&p).unwrap();
    let mut estimate = nalgebra::DMatrix::zeros(n, n);
    for j in 0..n {
        let at = |sign: f64| {
            let mut moved = p.clone();
            moved[j] += sign * 1e-4 * s[j];
            cost.quadratic(&moved).unwrap().gradient
        };
        let column = (at(1.0) - at(-1.0)) / 2e-4;
        for i in 0..n {
            estimate[(i, j)] = column[i] * s[i];
        }
    }
    let entries = |f: &dyn Fn(usize, usize) -> f64| (0..n * n).map(|k| f(k / n, k % n)).collect::<Vec<_>>();
    let off = difference(entries(&|i, j| exact[(i, j)] * s[i] * s[j]), entries(&|i, j| estimate[(i, j)]));
    assert!(off < 1e-5, "Hessian off by {off:.1e}");
}

#[test]
fn an_unmeasured_channel_has_no_weight() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let mut blind = runs.clone();
    for run in &mut blind {
        run.measured.iter_mut().for_each(|m| m[4] = None);
    }
    blind[0].measured[7][0] = None;
    let model = model(&TILDE);
    let p = free_values(&model);
    let all = cost(&model, &runs, Derivatives::Lanes);
    let fewer = cost(&model, &blind, Derivatives::Lanes);
    let quadratic = fewer.quadratic(&p).unwrap();
    assert!(quadratic.value < all.value(&p).unwrap() && quadratic.value > 0.0);
    assert_eq!(fewer.residuals(), all.residuals() * 5 / 6 - 1);
    let oracle = cost(&model, &blind, Derivatives::NumDual).quadratic(&p).unwrap();
    assert!((quadratic.value / oracle.value - 1.0).abs() < 1e-10);
}

#[test]
fn the_heading_difference_is_wrapped() {
    let mut runs = recordings(&model(&STAR), 2.0, 60);
    let model = model(&TILDE);
    let p = free_values(&model);
    let before = cost(&model, &runs, Derivatives::Lanes).value(&p).unwrap();
    runs.iter_mut().for_each(|run| run.measured.iter_mut().for_each(|m| add(m, 2, 2.0 * TAU)));
    let after = cost(&model, &runs, Derivatives::Lanes).value(&p).unwrap();
    assert!((before / after - 1.0).abs() < 1e-10);
}

#[test]
fn additions_of_a_session_change_only_its_runs() {
    let mut runs = recordings(&model(&STAR), 2.0, 60);
    runs[3].session = "windy".into();
    let mut model = model(&STAR);
    let lift = model.index("rudder.lift0").unwrap();
    let p = free_values(&model);
    let squares = |model: &Model| cost(model, &runs, Derivatives::Lanes).squares(&p).unwrap();
    let before = squares(&model);
    model.sessions.insert("windy".into(), vec![(lift, 0.05)]);
    let after = squares(&model);
    for i in 0..runs.len() {
        if i == 3 {
            assert!(after[i] > 1e-3, "{}", after[i]);
        } else {
            assert_eq!(before[i].to_bits(), after[i].to_bits());
        }
    }
}

/// A model in which p0 alone is free, and unconstrained.
fn side_force_alone() -> (Model, FitSettings) {
    let mut model = model(&STAR);
    model.parameters.iter_mut().for_each(|p| p.free = p.info.symbol == "p0");
    let mut settings = FitSettings::default();
    settings.constraints.off = true;
    (model, settings)
}

#[test]
fn a_prior_pulls_the_estimate_as_computed_by_hand() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let (mut model, settings) = side_force_alone();
    let i = model.index("propeller.side_force").unwrap();
    // Around the truth the cost is H/2 (p - truth)^2. With a weight w on ((p - mean)/sd)^2 the estimate is the weighted mean.
    let truth = model.parameters[i].value;
    let h = cost(&model, &runs, Derivatives::Lanes).quadratic(&[truth]).unwrap().gauss_newton[(0, 0)];
    let (mean, sd) = (truth + 1e-4, 1e-6);
    model.parameters[i].prior = Some(Prior { mean, sd });
    model.parameters[i].value = truth + 2e-4;
    let fit = quiet(&model, &runs, &FitSettings { prior_updates: 0, ..settings });
    // Weight set by the residuals at the start: w = s^2/M, s^2 = sum e^2/(N - 1).
    let start = cost(&model, &runs, Derivatives::Lanes);
    let variance = fit.start_cost * runs.len() as f64 / (start.residuals() - 1) as f64;
    let k = 2.0 * (variance / runs.len() as f64) / (sd * sd);
    let expected = (h * truth + k * mean) / (h + k);
    let pulled = (fit.estimates[0].value - truth) / (expected - truth);
    assert!((pulled - 1.0).abs() < 1e-2, "pulled by {pulled} of what was expected");
    assert!((expected - truth) > 1e-7);
}

#[test]
fn the_weight_of_a_prior_follows_the_residuals() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let (mut model, settings) = side_force_alone();
    let i = model.index("propeller.side_force").unwrap();
    let truth = model.parameters[i].value;
    model.parameters[i].prior = Some(Prior { mean: 0.03, sd: 0.01 });
    model.parameters[i].value = 0.0;
    // The model is the truth: the residuals vanish, and with them the weight of a prior.
    let fit = quiet(&model, &runs, &FitSettings { prior_updates: 20, ..settings });
    assert!((fit.estimates[0].value - truth).abs() < 1e-4, "{}", fit.report());
}

#[test]
fn an_active_bound_leaves_its_parameter_what_lies_inside_and_the_others_their_errors() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let mut model = model(&TILDE);
    let i = model.index("rudder.lift1").unwrap();
    model.parameters[i].upper = 2.5;
    let fit = quiet(&model, &runs, &settings());
    let estimate = fit.estimates.iter().find(|e| e.symbol == "p5").unwrap();
    assert_eq!(estimate.at_bound, Some("upper"), "{}", fit.report());
    assert!((estimate.value - 2.5).abs() < 1e-6);
    // Nothing is beyond the bound, and what is inside is as unsure as the recordings are steep there.
    let (error, [low, high]) = (estimate.standard_error.unwrap(), estimate.interval.unwrap());
    assert!(0.0 < error && error < 0.3 && low < 2.5 && high == 2.5, "{error} {low} {high}");
    assert!(fit.active.iter().any(|a| a.sentence == "p5 <= 2.5"));
    assert!(fit.estimates.iter().filter(|e| e.symbol == "p0").all(|e| e.standard_error.unwrap() > 0.0));
}

#[test]
fn an_undetermined_parameter_is_named_and_has_no_standard_error() {
    // Straight ahead with the rudder amidships and no steering force: without an angle of attack p5 and p6 have no effect.
    let mut straight = STAR;
    (straight[0], straight[4]) = (0.0, 0.0);
    let truth = model(&straight);
    let mut run = recordings(&truth, 2.0, 60).remove(7);
    run.measured.iter_mut().enumerate().for_each(|(k, m)| add(m, 3, 0.02 * (0.5 * k as f64).sin()));
    let mut blind = truth.clone();
    blind.parameters.iter_mut().for_each(|p| p.free = ["p1", "p5", "p6"].contains(&p.info.symbol));
    let mut settings = settings();
    settings.constraints.off = true;
    let fit = quiet(&blind, &[run], &settings);
    let error = |symbol: &str| fit.estimates.iter().find(|e| e.symbol == symbol).unwrap().standard_error;
    assert!(error("p1").unwrap() > 0.0);
    assert_eq!((error("p5"), error("p6")), (None, None));
    let words: Vec<&str> = fit.undetermined.iter().map(|c| c.words.as_str()).collect();
    assert_eq!(fit.undetermined.len(), 2, "{words:?}");
    assert!(words.iter().all(|w| w.contains("p5") || w.contains("p6")), "{words:?}");
    assert!(!fit.report().contains("NaN"), "{}", fit.report());
    assert!(!serde_json::to_string(&fit).unwrap().contains("NaN"));
}

#[test]
fn limits_that_contradict_each_other_are_named() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let mut settings = settings();
    // c_D(0) <= 0.05 against c_D >= 0.2 everywhere.
    settings.constraints.drag = Rule { lower: Some(0.2), ..Rule::default() };
    let error = fit(&model(&TILDE), &runs, &settings, &mut |_| true).unwrap_err();
    let FitError::Infeasible { rule, .. } = &error else { panic!("{error}") };
    assert!(["drag", "drag_zero"].contains(rule));
    assert!(error.to_string().contains("contradict"), "{error}");
}

#[test]
fn a_simulation_that_diverges_at_the_start_names_run_and_time() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let mut away = TILDE;
    away[1] = -1e9;
    let error = fit(&model(&away), &runs, &settings(), &mut |_| true).unwrap_err();
    assert!(matches!(&error, FitError::Diverged { .. }), "{error}");
    assert!(error.to_string().contains("turn to starboard"), "{error}");
}

#[test]
fn an_impossible_fit_gives_its_reason() {
    let runs = recordings(&model(&STAR), 2.0, 60);
    let mut fixed = model(&TILDE);
    fixed.parameters.iter_mut().for_each(|p| p.free = false);
    assert!(matches!(fit(&fixed, &runs, &settings(), &mut |_| true), Err(FitError::NothingFree)));
    assert!(matches!(fit(&model(&TILDE), &[], &settings(), &mut |_| true), Err(FitError::NoRuns)));
    let short = FitSettings { max_iterations: 2, ..settings() };
    let fit = quiet(&model(&TILDE), &runs, &short);
    assert!(!fit.converged && fit.status.contains("raise max_iterations"), "{}", fit.status);
}

#[test]
fn every_hessian_leads_to_the_same_optimum() {
    let mut runs = recordings(&model(&STAR), 2.0, 60);
    // A disturbance no parameter explains, so that the residuals do not vanish at the optimum.
    for (i, run) in runs.iter_mut().enumerate() {
        for (k, m) in run.measured.iter_mut().enumerate() {
            add(m, 0, (0.3 * k as f64 + i as f64).sin());
            add(m, 4, 0.02 * (0.2 * k as f64 + 2.0 * i as f64).cos());
        }
    }
    let start = model(&TILDE);
    let mut costs = Vec::new();
    for hessian in [Hessian::GaussNewton, Hessian::Exact, Hessian::LimitedMemory] {
        let fit = quiet(&start, &runs, &FitSettings { hessian, ..settings() });
        println!("{hessian:?}: {}", fit.brief());
        assert!(fit.converged, "{hessian:?}: {}", fit.status);
        costs.push(fit.cost);
    }
    for cost in &costs[1..] {
        assert!((cost / costs[0] - 1.0).abs() < 1e-6, "{costs:?}");
    }
}
