//! Times of the parts of a fit of the paper's size: 165 runs of 120 steps, 11 parameters.
//! The questions and results are in README.md; no test depends on a time.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use trimtab::fit::{Derivatives, FitSettings, Hessian, fit};

#[path = "support/case.rs"]
mod case;
use case::{cost, recordings, settings, ship_a};

const SOURCES: [(&str, Derivatives); 4] = [
    ("lanes", Derivatives::Lanes),
    ("dual", Derivatives::Dual),
    ("num-dual", Derivatives::NumDual),
    ("finite differences", Derivatives::FiniteDifferences),
];

fn evaluations(c: &mut Criterion) {
    let (model, runs) = (ship_a(), recordings(3.0));
    let p: Vec<f64> = model.free().iter().map(|i| model.parameters[*i].value).collect();

    let mut group = c.benchmark_group("rollout");
    for (number, derivatives) in [("lanes", Derivatives::Lanes), ("f64", Derivatives::Dual)] {
        let cost = cost(&model, &runs, derivatives);
        group.bench_function(number, |b| b.iter(|| black_box(cost.value(&p))));
    }
    group.finish();

    let mut group = c.benchmark_group("gradient");
    group.sample_size(30);
    for (name, derivatives) in SOURCES {
        let cost = cost(&model, &runs, derivatives);
        group.bench_function(name, |b| b.iter(|| black_box(cost.with_gradient(&p))));
    }
    group.finish();

    let mut group = c.benchmark_group("gradient and Gauss-Newton");
    group.sample_size(30);
    for (name, derivatives) in SOURCES {
        let cost = cost(&model, &runs, derivatives);
        group.bench_function(name, |b| b.iter(|| black_box(cost.quadratic(&p))));
    }
    group.finish();

    let mut group = c.benchmark_group("exact Hessian");
    group.sample_size(10);
    let cost = cost(&model, &runs, Derivatives::Lanes);
    group.bench_function("second-order duals", |b| b.iter(|| black_box(cost.hessian(&p))));
    group.finish();
}

fn full_fits(c: &mut Criterion) {
    let (model, runs) = (ship_a(), recordings(3.0));
    let settings = settings();
    let mut group = c.benchmark_group("full fit");
    group.sample_size(10);
    for (name, derivatives, hessian) in [
        ("lanes, Gauss-Newton", Derivatives::Lanes, Hessian::GaussNewton),
        ("lanes, exact Hessian", Derivatives::Lanes, Hessian::Exact),
        ("lanes, limited memory", Derivatives::Lanes, Hessian::LimitedMemory),
        ("num-dual, Gauss-Newton", Derivatives::NumDual, Hessian::GaussNewton),
        ("finite differences, Gauss-Newton", Derivatives::FiniteDifferences, Hessian::GaussNewton),
        ("finite differences, limited memory", Derivatives::FiniteDifferences, Hessian::LimitedMemory),
    ] {
        let settings = FitSettings { derivatives, hessian, ..settings };
        let run = || fit(&model, &runs, &settings, &mut |_| true);
        match run() {
            Ok(fit) => println!("{name}: {}", fit.brief()),
            Err(error) => println!("{name}: {error}"),
        }
        group.bench_function(name, |b| b.iter(|| black_box(run().map(|fit| fit.cost))));
    }
    group.finish();
}

criterion_group!(benches, evaluations, full_fits);
criterion_main!(benches);
