//! Fits the same recordings with exact gradients and with finite differences: `cargo run --release --example gradients`
//! It shows what exactness costs and buys: time, iterations, and how far a finite difference is off for any step.

use std::error::Error;
use trimtab::fit::{Cost, CostOptions, Derivatives};
use trimtab::{FitSettings, fit, study::demo};

fn main() -> Result<(), Box<dyn Error>> {
    let study = demo::example()?;
    let settings = FitSettings::default();
    let runs = &study.train;

    println!("A fit of {} recordings, eleven parameters:", runs.len());
    println!("{:38} {:>10} {:>10} {:>10} {:>10}", "derivatives", "iterations", "gradients", "seconds", "cost");
    for (words, derivatives, step) in [
        ("exact, dual numbers over SIMD lanes", Derivatives::Lanes, 1e-5),
        ("exact, dual numbers one by one", Derivatives::Dual, 1e-5),
        ("central differences, step 1e-1", Derivatives::FiniteDifferences, 1e-1),
        ("central differences, step 1e-5", Derivatives::FiniteDifferences, 1e-5),
        ("central differences, step 1e-10", Derivatives::FiniteDifferences, 1e-10),
    ] {
        let settings = FitSettings { derivatives, difference_step: step, ..settings };
        let fitted = fit(&study.model, runs, &settings, &mut |_| true)?;
        let end = if fitted.converged { format!("{:.6}", fitted.cost) } else { "no end".into() };
        println!("{words:38} {:10} {:10} {:10.2} {end:>10}", fitted.iterations, fitted.counts.gradient, fitted.seconds);
    }

    let gradient = |derivatives, difference_step| -> Result<Vec<f64>, Box<dyn Error>> {
        let options = CostOptions {
            max_yaw_rate: settings.max_yaw_rate,
            derivatives,
            difference_step,
            integration: settings.integration,
        };
        let cost = Cost::new(&study.model, runs, options)?;
        let start: Vec<f64> = cost.free().iter().map(|i| study.model.parameters[*i].value).collect();
        Ok(cost.with_gradient(&start).ok_or("the simulation diverges at the start")?.gradient.as_slice().to_vec())
    };
    let exact = gradient(Derivatives::Dual, 1e-5)?;
    let apart = |g: &[f64]| {
        exact.iter().zip(g).map(|(a, b)| ((a - b) / a.abs().max(f64::MIN_POSITIVE)).abs()).fold(0.0, f64::max)
    };
    println!("\nLargest relative error of an entry of the gradient at the start, against dual numbers:");
    println!("{:38} {:10.1e}", "dual numbers over SIMD lanes", apart(&gradient(Derivatives::Lanes, 1e-5)?));
    for step in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10] {
        let words = format!("central differences, step {step:.0e}");
        println!("{words:38} {:10.1e}", apart(&gradient(Derivatives::FiniteDifferences, step)?));
    }
    Ok(())
}
