//! Times of the parts of a fit of the paper's size, 165 runs of 120 steps, and their ratios, all on one thread.
//! The questions and results are in README.md; no test depends on a time.

use criterion::Criterion;
use std::hint::black_box;
use trimtab::fit::{Cost, Derivatives, FitSettings, Hessian, fit};
use trimtab::likelihood::filter::{Column, Filter, Gains, Wanted};
use trimtab::likelihood::noise::fit::guess;
use trimtab::model::Model;
use trimtab::recording::Run;
use trimtab::simulate::{Integration, Method};

#[path = "support/by_hand.rs"]
mod by_hand;
#[path = "support/case.rs"]
mod case;
#[path = "../experiments/src/freed.rs"]
mod free_more;
#[path = "support/freed.rs"]
mod freed;
#[path = "../experiments/src/interleaved.rs"]
mod interleaved;
use by_hand::ByHand;
use case::{cost, recordings, settings, ship_a};
use freed::{freed, start};
use interleaved::{Task, least};

/// Rounds of the interleaved measurement; its figures are minima over them.
const ROUNDS: usize = 30;
const FEWER_ROUNDS: usize = 7;

/// Runs and free parameters of the likelihood that is timed.
const LIKELIHOOD_RUNS: usize = 40;
const LIKELIHOOD_FREE: usize = 42;

const SOURCES: [(&str, Derivatives); 4] = [
    ("lanes", Derivatives::Lanes),
    ("dual", Derivatives::Dual),
    ("num-dual", Derivatives::NumDual),
    ("finite differences", Derivatives::FiniteDifferences),
];

const FITS: [(&str, Derivatives, Hessian); 6] = [
    ("lanes, Gauss-Newton", Derivatives::Lanes, Hessian::GaussNewton),
    ("lanes, exact Hessian", Derivatives::Lanes, Hessian::Exact),
    ("lanes, limited memory", Derivatives::Lanes, Hessian::LimitedMemory),
    ("num-dual, Gauss-Newton", Derivatives::NumDual, Hessian::GaussNewton),
    ("finite differences, Gauss-Newton", Derivatives::FiniteDifferences, Hessian::GaussNewton),
    ("finite differences, limited memory", Derivatives::FiniteDifferences, Hessian::LimitedMemory),
];

/// The library and the code written by hand must compute the same cost, or their times say nothing.
fn assert_same_cost(model: &Model, by_hand: &ByHand, cost: &Cost) {
    let (hand, library) = (by_hand.value(), cost.value(&start(model)).unwrap_or(f64::NAN));
    let difference = (hand - library).abs() / library;
    assert!(difference < 1e-10, "by hand {hand}, library {library}");
    println!("cost {library}, by hand within {difference:.1e} of it");
}

fn evaluations(c: &mut Criterion, model: &Model, runs: &[Run]) {
    let p = start(model);
    let lanes = cost(model, runs, Derivatives::Lanes);
    let by_hand = ByHand::new(model, runs);

    let mut group = c.benchmark_group("rollout");
    group.bench_function("by hand over lanes", |b| b.iter(|| black_box(by_hand.value())));
    group.bench_function("lanes", |b| b.iter(|| black_box(lanes.value(&p))));
    let single = cost(model, runs, Derivatives::Dual);
    group.bench_function("f64", |b| b.iter(|| black_box(single.value(&p))));
    group.finish();

    for (title, with_matrix) in [("gradient", false), ("gradient and Gauss-Newton", true)] {
        let mut group = c.benchmark_group(title);
        group.sample_size(30);
        for (name, derivatives) in SOURCES {
            let cost = cost(model, runs, derivatives);
            group.bench_function(name, |b| b.iter(|| black_box(evaluate(&cost, &p, with_matrix))));
        }
        group.finish();
    }

    let mut group = c.benchmark_group("exact Hessian");
    group.sample_size(10);
    group.bench_function("second-order duals", |b| b.iter(|| black_box(lanes.hessian(&p))));
    group.finish();
}

/// Value and gradient, with the Gauss-Newton matrix where it is asked for.
fn evaluate(cost: &Cost, p: &[f64], with_matrix: bool) -> Option<f64> {
    let quadratic = if with_matrix { cost.quadratic(p) } else { cost.with_gradient(p) };
    quadratic.map(|q| q.value)
}

fn full_fits(c: &mut Criterion, model: &Model, runs: &[Run]) {
    let mut group = c.benchmark_group("full fit");
    group.sample_size(10);
    // A fit with the exact Hessian takes seconds: `shares` times it, a few times only.
    for (name, derivatives, hessian) in FITS.into_iter().filter(|(_, _, hessian)| *hessian != Hessian::Exact) {
        let settings = FitSettings { derivatives, hessian, ..settings() };
        let run = || fit(model, runs, &settings, &mut |_| true);
        group.bench_function(name, |b| b.iter(|| black_box(run().map(|fit| fit.cost))));
    }
    group.finish();
}

fn row(question: &str, target: &str, measured: f64) {
    println!("| {question} | {target} | {measured:.2} |");
}

/// Rollout, gradient and Gauss-Newton matrix over the eleven parameters, as ratios.
fn ratios(model: &Model, runs: &[Run], rounds: usize) {
    let p = start(model);
    let by_hand = ByHand::new(model, runs);
    let costs = SOURCES.map(|(name, derivatives)| (name, cost(model, runs, derivatives)));
    let mut tasks: Vec<Task> = vec![("rollout by hand".into(), Box::new(|| _ = black_box(by_hand.value())))];
    for (name, cost) in &costs {
        let p = &p;
        tasks.push((format!("rollout, {name}"), Box::new(move || _ = black_box(cost.value(p)))));
        tasks.push((format!("gradient, {name}"), Box::new(move || _ = black_box(evaluate(cost, p, false)))));
        tasks.push((format!("with Gauss-Newton, {name}"), Box::new(move || _ = black_box(evaluate(cost, p, true)))));
    }
    let times = least(rounds, &mut tasks);
    println!("\n| eleven parameters | least processor time, ms |\n|---|---|");
    for ((name, _), time) in tasks.iter().zip(&times) {
        println!("| {name} | {:.3} |", 1e3 * time);
    }
    println!("\n| ratio | target | measured |\n|---|---|---|");
    row("rollout over rollout by hand", "<= 1.5", times[1] / times[0]);
    row("gradient over rollout", "<= 3", times[2] / times[1]);
    row("gradient and Gauss-Newton over rollout", "<= 5", times[3] / times[1]);
    row("central differences over gradient, 11 free", ">= 7", times[11] / times[2]);
}

/// Growth with the number of free parameters, and central differences where many are free.
fn growth(runs: &[Run], rounds: usize) {
    let models: Vec<Model> = [(11, false), (30, false), (40, false), (11, true), (30, true), (40, true), (60, true)]
        .map(|(count, symmetric)| freed(count, symmetric))
        .into();
    let starts: Vec<Vec<f64>> = models.iter().map(start).collect();
    let costs: Vec<Cost> = models.iter().map(|model| cost(model, runs, Derivatives::Lanes)).collect();
    let differences = cost(&models[2], runs, Derivatives::FiniteDifferences);
    let mut tasks: Vec<Task> = Vec::new();
    for ((model, cost), p) in models.iter().zip(&costs).zip(&starts) {
        let terms = if model.term_names().contains(&"symmetric") { "with `symmetric`" } else { "base terms" };
        let name = format!("{} | {terms}", p.len());
        tasks.push((format!("{name} | rollout"), Box::new(move || _ = black_box(cost.value(p)))));
        tasks.push((format!("{name} | gradient"), Box::new(move || _ = black_box(evaluate(cost, p, false)))));
        tasks.push((format!("{name} | with Gauss-Newton"), Box::new(move || _ = black_box(evaluate(cost, p, true)))));
    }
    tasks.push((
        "40 | base terms | gradient by central differences".into(),
        Box::new(|| _ = black_box(evaluate(&differences, &starts[2], false))),
    ));
    let times = least(rounds, &mut tasks);
    println!("\n| free | model | what | least processor time, ms |\n|---|---|---|---|");
    for ((name, _), time) in tasks.iter().zip(&times) {
        println!("| {name} | {:.3} |", 1e3 * time);
    }
    println!("\n| ratio | target | measured |\n|---|---|---|");
    row("central differences over gradient, 40 free", ">= 12", times[21] / times[7]);
    row("with Gauss-Newton: 60 free over 11 free, both with `symmetric`", "<= 5.5", times[20] / times[11]);
}

/// A pass over 40 runs of 120 steps that gives log-likelihood, score and Fisher matrix of 42 parameters: with the gains of each point, and
/// with fixed gains and every stage of a step differentiated, as a fit by likelihood has it.
fn likelihood(runs: &[Run], rounds: usize) {
    let (model, runs) = (freed(LIKELIHOOD_FREE, true), &runs[..LIKELIHOOD_RUNS]);
    let noise = guess(runs, &model);
    let integration = Integration { method: Method::Rk4, substeps: 1 };
    let columns: Vec<Column> = model.free().into_iter().map(|i| Column::tangent(&model, i)).collect();
    let [alone, with] = [Filter::new(&model, integration, &[]), Filter::new(&model, integration, &columns)];
    let kept = alone.passes(runs, &noise, Wanted { gains: true, ..Wanted::default() });
    let gains: Vec<Gains> = kept.into_iter().filter_map(|pass| pass.gains).collect();
    let moving = Wanted { sums_only: true, ..Wanted::default() };
    let fixed = Wanted { frozen: Some(&gains), exact: true, ..Wanted::default() };
    let pass = |filter: &Filter, wanted: Wanted| {
        let mut sum = 0.0;
        filter.each(runs, &noise, wanted, |_, pass| pass.log_likelihood, |value| sum += value);
        _ = black_box(sum);
    };
    let mut tasks: Vec<Task> = vec![
        ("log-likelihood".into(), Box::new(|| pass(&alone, moving))),
        ("with score and Fisher matrix".into(), Box::new(|| pass(&with, moving))),
        ("gains fixed, without derivatives".into(), Box::new(|| pass(&alone, fixed))),
        ("gains fixed, with gradient and Fisher matrix".into(), Box::new(|| pass(&with, fixed))),
    ];
    let times = least(rounds, &mut tasks);
    println!("\n| 40 runs of 120 steps, 42 parameters, a pass | least processor time, ms |\n|---|---|");
    for ((name, _), time) in tasks.iter().zip(&times) {
        println!("| {name} | {:.2} |", 1e3 * time);
    }
}

/// The time of each fit, and the share of it that is not the solver's evaluations of the cost.
fn shares(model: &Model, runs: &[Run], rounds: usize) {
    println!("\n| full fit | iterations | evaluations | least processor time, s |\n|---|---|---|---|");
    for (name, derivatives, hessian) in FITS {
        let settings = FitSettings { derivatives, hessian, ..settings() };
        let mut last = None;
        let p = start(model);
        let cost = cost(model, runs, derivatives);
        let mut tasks: Vec<Task> = vec![
            ("fit".into(), Box::new(|| last = Some(fit(model, runs, &settings, &mut |_| true)))),
            ("evaluation".into(), Box::new(|| _ = black_box(evaluate(&cost, &p, true)))),
        ];
        let times = least(rounds, &mut tasks);
        drop(tasks);
        match last {
            Some(Ok(fit)) => {
                let evaluations = fit.counts.objective;
                println!("| {name} | {} | {evaluations} | {:.3} |", fit.iterations, times[0]);
                if hessian == Hessian::GaussNewton {
                    let outside = 1.0 - evaluations as f64 * times[1] / times[0];
                    println!("  {:.0} % of it outside the solver's evaluations of the cost", 100.0 * outside);
                }
            }
            Some(Err(error)) => println!("| {name} | {error} | | |"),
            None => {}
        }
    }
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
    assert!(pool.is_ok(), "times are those of one thread: {pool:?}");
    let timing = std::env::args().any(|argument| argument == "--bench");
    let (rounds, fewer) = if timing { (ROUNDS, FEWER_ROUNDS) } else { (1, 1) };
    let (model, runs) = (ship_a(), recordings(3.0));
    assert_same_cost(&model, &ByHand::new(&model, &runs), &cost(&model, &runs, Derivatives::Lanes));
    ratios(&model, &runs, rounds);
    growth(&runs, fewer);
    likelihood(&runs, rounds);
    shares(&model, &runs, if timing { 3 } else { 1 });
    let mut criterion = Criterion::default().configure_from_args();
    evaluations(&mut criterion, &model, &runs);
    full_fits(&mut criterion, &model, &runs);
    criterion.final_summary();
}
