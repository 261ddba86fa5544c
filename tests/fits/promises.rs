//! Promises of a fit beyond recovery: it never ends above its start, what it writes can be read, and it says what is in doubt.
//! Recordings are made by the model itself, with noise or with an effect that the fitted model lacks.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::path::Path;
use trimtab::fit::{
    ConstraintSettings, Cost, CovarianceKind, DoubtKind, Fit, FitSettings, MultiStart, Rule, fit, multi_start,
};
use trimtab::model::Model;
use trimtab::physics::Form;
use trimtab::recording::{Run, RunStore, Runs, Split};
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;
use trimtab::simulate::{Integration, Scenario, simulate};

const DT: f64 = 1.0;
const SAMPLES: usize = 121;
/// Noise of x, y \[m\], psi \[rad\], u, v \[m/s\] and r \[rad/s\].
const NOISE: [f64; 6] = [0.2, 0.2, 2e-3, 0.01, 0.01, 2e-4];
const P: [f64; 11] = [-0.017, 8000.0, -1200.0, 400.0, 0.0, 2.5, 0.0, -3.0, 0.02, 0.0, 1.3];

fn ship() -> Ship {
    Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap()
}

fn model() -> Model {
    let mut model = Model::new(ship(), "HD", Form::Regular, &[]).unwrap();
    model.set_eleven(&P);
    model
}

/// A ship whose hull coefficients are off their estimates by up to a third.
fn truth() -> Model {
    let mut model = model();
    for (name, factor) in [("Yv", 0.8), ("Nv", 1.15), ("Nr", 0.9), ("Yr", 0.7), ("Yvv", 1.3), ("Nvvr", 1.2)] {
        let i = model.index(&format!("hull.{name}")).unwrap();
        model.parameters[i].value *= factor;
    }
    model
}

fn integration() -> Integration {
    Integration { method: trimtab::simulate::Method::Rk4, substeps: 1 }
}

fn settings() -> FitSettings {
    FitSettings { integration: integration(), ..FitSettings::default() }
}

/// Zigzags of 5 to 35 degrees and turns, two windows each, started from the true state; `extra` is added to what is measured.
fn recordings(truth: &Model, count: usize, noise: f64, extra: impl Fn(usize, usize) -> [f64; 6]) -> Vec<Run> {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut runs = Vec::new();
    for i in 0..count {
        let angle = (5.0 + 30.0 * (i as f64 * 0.618).fract()).to_radians() * if i % 2 == 0 { 1.0 } else { -1.0 };
        let period = 50.0 + 10.0 * (i % 5) as f64;
        let inputs: Vec<Inputs<f64>> = (0..2 * SAMPLES - 1)
            .map(|k| {
                let t = k as f64 * DT;
                let delta = if i % 4 == 3 { angle } else { angle * (4.0 * (t / period).sin()).tanh() };
                Inputs::actuators(t, 2.0 + 0.3 * (i % 3) as f64, delta)
            })
            .collect();
        let initial = [0.0, 0.0, i as f64, 4.0 + 0.3 * (i % 3) as f64, 0.0, 0.0];
        let scenario = Scenario { dt: DT, inputs: inputs.clone(), initial };
        let states = simulate(truth, &truth.values(), integration(), &scenario).states;
        assert_eq!(states.len(), inputs.len());
        for (w, start) in [0, SAMPLES - 1].into_iter().enumerate() {
            let samples = start..start + SAMPLES;
            let measured = samples.clone().map(|k| {
                let added = extra(2 * i + w, k - start);
                std::array::from_fn(|c| {
                    let white: f64 = StandardNormal.sample(&mut rng);
                    Some(states[k][c] + noise * NOISE[c] * white + added[c])
                })
            });
            runs.push(Run {
                name: format!("run {i} from {start}"),
                recording: format!("run {i}"),
                session: String::new(),
                manoeuvre: String::new(),
                split: Split::Train,
                dt: DT,
                recorded_dt: DT,
                inputs: inputs[samples.clone()].to_vec(),
                measured: measured.collect(),
                initial: states[start],
                disturbed: Vec::new(),
                derived: [false; 6],
            });
        }
    }
    runs
}

fn unspoiled(_: usize, _: usize) -> [f64; 6] {
    [0.0; 6]
}

fn quiet(model: &Model, runs: &[Run], settings: &FitSettings) -> Fit {
    fit(model, runs, settings, &mut |_| true).unwrap()
}

fn freed() -> Model {
    let mut model = model();
    model.free_hull();
    model
}

#[test]
fn runs_in_a_file_are_fitted_to_the_same_bits_as_runs_in_memory() {
    let mut runs = recordings(&truth(), 6, 1.0, unspoiled);
    // Lengths, a session and a channel that differ from run to run.
    runs[3].inputs.truncate(80);
    runs[3].measured.truncate(80);
    runs[5].measured.iter_mut().step_by(3).for_each(|m| m[4] = None);
    let mut store = RunStore::new(0);
    runs.iter().for_each(|run| store.push(run.clone()).unwrap());
    let model = freed();
    let options = settings().cost_options();
    let costs = [Cost::new(&model, &runs, options).unwrap(), Cost::new(&model, &store, options).unwrap()];
    let p: Vec<f64> = model.free().iter().map(|i| 1.01 * model.parameters[*i].value).collect();
    let [kept, stored] = costs.each_ref().map(|cost| cost.quadratic(&p).unwrap());
    assert_eq!(
        (kept.value, &kept.gradient, &kept.gauss_newton),
        (stored.value, &stored.gradient, &stored.gauss_newton)
    );
    assert_eq!(costs[0].squares(&p), costs[1].squares(&p));
    assert_eq!(costs[0].residuals(), costs[1].residuals());
    // The stages of a freed hull cut the runs and fit the pieces first.
    let settings = FitSettings { max_iterations: 12, ..settings() };
    let [kept, stored] =
        [Runs::from(&runs), Runs::from(&store)].map(|r| fit(&model, r, &settings, &mut |_| true).unwrap());
    assert!(kept.first_stage_parts > 1 && kept.iterations <= 12, "{} {}", kept.first_stage_parts, kept.iterations);
    let said = |f: &Fit| serde_json::to_value(Fit { seconds: 0.0, ..f.clone() }).unwrap();
    assert_eq!(said(&kept), said(&stored));
    assert!(store.failure().is_none());
}

#[test]
fn a_fit_stopped_anywhere_is_no_worse_than_its_start() {
    let runs = recordings(&truth(), 4, 1.0, unspoiled);
    for last in [0, 1, 2, 3, 5, 8, 13] {
        let mut count = 0;
        let stopped = fit(&freed(), &runs, &settings(), &mut |_| {
            count += 1;
            count <= last
        });
        let fit = stopped.unwrap();
        let (start, end) = (fit.start_cost + fit.start_prior_cost, fit.cost + fit.prior_cost);
        assert!(end <= start, "stopped after {last} iterations: {start} -> {end}");
        assert!(!fit.converged && fit.headline.starts_with("NOT CONVERGED"), "{}", fit.headline);
        assert!(fit.status.contains("stopped"), "{}", fit.status);
    }
}

#[test]
fn a_fit_with_an_active_limit_takes_hardly_more_evaluations_than_one_inside_its_limits() {
    let runs = recordings(&model(), 4, 1.0, unspoiled);
    let mut start = model();
    start.set_eleven(&P.map(|p| 1.2 * p));
    let inside = quiet(&start, &runs, &settings());
    assert!(inside.converged && inside.active.is_empty() && inside.constraints > 0, "{}", inside.report());
    assert!(inside.counts.objective <= 80, "{}", inside.report());
    let drag = |fit: &Fit| fit.estimates.iter().find(|e| e.symbol == "p8").unwrap().value;
    let mut settings = settings();
    settings.constraints.drag_zero = Rule { upper: Some(0.5 * drag(&inside)), ..Rule::default() };
    let limited = quiet(&start, &runs, &settings);
    assert!(limited.converged && limited.cost > inside.cost, "{}", limited.report());
    assert!(2 * limited.counts.objective <= 3 * inside.counts.objective, "{}", limited.report());
    assert!(limited.active.iter().any(|a| a.rule == "drag_zero"), "{}", limited.report());
    assert!((drag(&limited) / drag(&inside) - 0.5).abs() < 1e-6);
}

#[test]
fn a_freed_hull_ends_at_one_optimum_whatever_limits_the_resistance_and_wherever_it_starts() {
    let runs = recordings(&truth(), 6, 1.0, unspoiled);
    let mut ends = Vec::new();
    for upper in [Some(200e3), Some(400e3), None] {
        let mut settings = settings();
        settings.constraints.resistance = Rule { upper, ..Rule::default() };
        let fit = quiet(&freed(), &runs, &settings);
        assert!(fit.converged && fit.cost < 0.1 * fit.start_cost, "{upper:?}: {}", fit.brief());
        ends.push(fit);
    }
    let starts = MultiStart { count: 4, spread: 0.3, seed: 5 };
    for start in multi_start(&freed(), &runs, &settings(), &starts, |_| {}) {
        ends.push(start.outcome.unwrap());
    }
    let total = |fit: &Fit| fit.cost + fit.prior_cost;
    for fit in &ends {
        assert!(
            (total(fit) / total(&ends[0]) - 1.0).abs() < 1e-3,
            "{} {:?}",
            fit.brief(),
            ends.iter().map(total).collect::<Vec<_>>()
        );
    }
}

#[test]
fn damping_and_added_masses_keep_their_signs() {
    // Noise large enough to make the unbounded optimum of some coefficients cross zero.
    let runs = recordings(&truth(), 3, 20.0, unspoiled);
    let mut loose = freed();
    loose.parameters.iter_mut().for_each(|p| p.prior = None);
    let fit = quiet(&loose, &runs, &settings());
    for name in ["Xudot", "Yvdot", "Nrdot", "Yv", "Nr", "Yvv", "Nrr"] {
        let value = fit.model.parameters[fit.model.index(&format!("hull.{name}")).unwrap()].value;
        assert!(value <= 0.0, "{name} = {value}");
    }
}

#[test]
fn what_a_fit_writes_can_be_read_again() {
    let runs = recordings(&truth(), 3, 20.0, unspoiled);
    for inertias in [false, true] {
        let mut model = freed();
        if inertias {
            for name in ["hull.mass", "hull.inertia", "hull.x_g"] {
                let i = model.index(name).unwrap();
                (model.parameters[i].free, model.parameters[i].prior) = (true, Some(model.default_prior(i)));
            }
        }
        for prior in [true, false] {
            let mut model = model.clone();
            if !prior {
                model.parameters.iter_mut().for_each(|p| p.prior = None);
            }
            let fit = quiet(&model, &runs, &FitSettings { max_iterations: 30, ..settings() });
            let text = toml::to_string(&fit.model.to_file()).unwrap();
            let again = Model::parse(&text, Path::new("fitted.toml"), ship()).unwrap();
            assert_eq!(again.values(), fit.model.values());
            assert_eq!(again.free(), fit.model.free());
        }
    }
}

#[test]
fn a_model_that_is_the_ship_is_not_doubted() {
    let runs = recordings(&truth(), 10, 1.0, unspoiled);
    let fit = quiet(&freed(), &runs, &settings());
    assert!(fit.doubts.is_empty(), "{}", fit.headline);
    assert!(fit.report().starts_with("Converged: solved"), "{}", fit.report());
    assert!(fit.residual_statistics.model_error.unwrap() < 1.5, "{:?}", fit.residual_statistics);
}

#[test]
fn an_effect_that_the_model_lacks_is_in_the_first_line() {
    // A sensor that wanders by ten times the noise over some 30 samples.
    let wander = |w: usize, k: usize| {
        let wave = 10.0 * (0.2 * k as f64 + w as f64).sin();
        std::array::from_fn(|c| wave * NOISE[c])
    };
    let runs = recordings(&truth(), 10, 1.0, wander);
    let fit = quiet(&model(), &runs, &settings());
    // That residuals are alike is no doubt: the intervals count them.
    assert!(fit.residual_statistics.likeness.unwrap() > 2.0, "{:?}", fit.residual_statistics);
    let kinds: Vec<DoubtKind> = fit.doubts.iter().map(|d| d.kind).collect();
    assert_eq!(kinds, [DoubtKind::ModelError], "{}", fit.headline);
    let report = fit.report();
    let first = report.lines().next().unwrap();
    assert!(first.contains("IN DOUBT") && first.contains("variance of the sensors' noise"), "{first}");
    let json = serde_json::to_value(&fit).unwrap();
    assert_eq!(json["doubts"][0]["kind"], "model-error");
    assert_eq!(json["headline"], first);
}

#[test]
fn windows_over_which_an_open_loop_runs_away_are_distinguished_from_those_over_which_it_does_not() {
    // The recorded ship ends up elsewhere, by a distance that grows with the cube of time.
    let away = |_: usize, k: usize| {
        let grown = 2e3 * (k as f64 / SAMPLES as f64).powi(3);
        std::array::from_fn(|c| grown * NOISE[c])
    };
    let exponent = |runs: &[Run]| {
        let mut fixed = truth();
        fixed.parameters.iter_mut().for_each(|p| p.free = p.name == "propeller.side_force");
        quiet(&fixed, runs, &settings())
    };
    let grown = exponent(&recordings(&truth(), 10, 1.0, away));
    let steady = exponent(&recordings(&truth(), 10, 1.0, unspoiled));
    let too_long = |fit: &Fit| fit.doubts.iter().any(|d| d.kind == DoubtKind::WindowsTooLong);
    assert!(too_long(&grown), "{:?}", grown.residual_statistics);
    assert!(!too_long(&steady), "{:?}", steady.residual_statistics);
}

#[test]
fn intervals_of_few_recordings_allow_for_residuals_that_are_alike() {
    let wander = |w: usize, k: usize| std::array::from_fn(|c| 5.0 * (0.15 * k as f64 + w as f64).sin() * NOISE[c]);
    // Without limits, inside which the variance is another.
    let constraints = ConstraintSettings { off: true, ..ConstraintSettings::default() };
    let mut unbounded = model();
    for p in &mut unbounded.parameters {
        (p.lower, p.upper) = (f64::NEG_INFINITY, f64::INFINITY);
    }
    let fit = quiet(&unbounded, &recordings(&truth(), 4, 1.0, wander), &FitSettings { constraints, ..settings() });
    assert_eq!(fit.covariance_kind, CovarianceKind::Correlated);
    assert!(fit.active.is_empty(), "{:?}", fit.active);
    let likeness = fit.residual_statistics.likeness.unwrap();
    assert!(likeness > 3.0, "{likeness}");
    let j = fit.estimates.iter().position(|e| e.symbol == "p0").unwrap();
    let independent = fit.covariance_gauss_newton[j][j].unwrap().sqrt();
    let error = fit.estimates[j].standard_error.unwrap();
    assert!((error / independent / likeness.sqrt() - 1.0).abs() < 1e-6, "{error} {independent} {likeness}");
}
