//! Measures exact gradients and finite differences: errors over the step, the course of a fit, and times.
//! Work is counted, so that it repeats bit by bit; times are measured and are ratios within one run. Nothing is drawn here.

use std::time::Instant;

use trimtab::fit::{Cost, CostOptions, Derivatives, FitSettings, Hessian, Progress, fit};
use trimtab::model::Model;
use trimtab::plot::{BLUE, Color, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION};
use trimtab::recording::Run;
use trimtab::simulate::{Integration, Method};

use crate::paper::case::Case;
use crate::paper::error::PaperError;

/// Steps of the accuracy study, in units of each parameter's scale: decades from the first exponent to the last.
const EXPONENTS: std::ops::RangeInclusive<i32> = -12..=0;
/// A fit has reached the best when its cost is within this share of the lowest.
const NEAR: f64 = 1e-3;
/// Largest violation of a (scaled) constraint at which a cost counts as reached.
const FEASIBLE: f64 = 1e-6;
/// Iterations after which a fit has failed.
const PATIENCE: usize = 300;
/// One Euler step a sample: the comparison is of gradients, and needs many fits.
const INTEGRATION: Integration = Integration { method: Method::Euler, substeps: 1 };

/// One way to fit.
pub struct Way {
    /// Name.
    pub name: &'static str,
    /// Colour of its curve.
    pub color: Color,
    derivatives: Derivatives,
    step: f64,
    hessian: Hessian,
}

impl Way {
    const fn exact(name: &'static str, hessian: Hessian, color: Color) -> Self {
        Self { name, color, derivatives: Derivatives::Lanes, step: 1e-5, hessian }
    }

    const fn differences(name: &'static str, step: f64, hessian: Hessian, color: Color) -> Self {
        Self { name, color, derivatives: Derivatives::FiniteDifferences, step, hessian }
    }

    /// Whether its gradients are exact.
    pub fn is_exact(&self) -> bool {
        self.derivatives == Derivatives::Lanes
    }
}

/// Every way, the reference first.
pub const WAYS: [Way; 7] = [
    Way::exact("exact, Gauss-Newton", Hessian::GaussNewton, BLUE),
    Way::exact("exact, exact Hessian", Hessian::Exact, SKY),
    Way::exact("exact, limited memory", Hessian::LimitedMemory, GREEN),
    Way::differences("differences 1e-5, Gauss-Newton", 1e-5, Hessian::GaussNewton, VERMILLION),
    Way::differences("differences 1e-5, limited memory", 1e-5, Hessian::LimitedMemory, ORANGE),
    Way::differences("differences 1e-1, limited memory", 1e-1, Hessian::LimitedMemory, PURPLE),
    Way::differences("differences 1e-9, limited memory", 1e-9, Hessian::LimitedMemory, GREY),
];

/// The course of a fit.
pub struct Course {
    /// Iterations.
    pub iterations: usize,
    /// Whether it converged.
    pub converged: bool,
    /// Final cost.
    pub cost: f64,
    /// Evaluations of the cost, and of its gradient.
    pub evaluations: [usize; 2],
    /// Cost, violation and time \[s\] at each iteration.
    pub path: Vec<(f64, f64, f64)>,
    /// Time of the whole fit \[s\].
    pub seconds: f64,
}

impl Course {
    /// The first iteration that keeps the constraints within 0.1 % of the cost `best`.
    pub fn reached(&self, best: f64) -> Option<usize> {
        let near = |(cost, violation, _): &(f64, f64, f64)| *cost <= best * (1.0 + NEAR) && *violation <= FEASIBLE;
        self.path.iter().position(near)
    }
}

/// Relative errors of gradients at the initial guess.
pub struct Accuracies {
    /// Of central differences, by step.
    pub steps: Vec<(f64, f64)>,
    /// Of the exact gradient, against that of the num-dual crate.
    pub oracle: f64,
}

/// The gradient at the model's values by scaled parameters, as the solver sees it; absent where a simulation diverges.
fn gradient(model: &Model, runs: &[Run], derivatives: Derivatives, step: f64) -> Result<Option<Vec<f64>>, PaperError> {
    let cost = cost(model, runs, derivatives, step)?;
    let p: Vec<f64> = model.free().iter().map(|i| model.parameters[*i].value).collect();
    let scaled = |gradient: &[f64]| -> Vec<f64> {
        model.free().iter().zip(gradient).map(|(i, g)| g * model.parameters[*i].scale).collect()
    };
    Ok(cost.with_gradient(&p).map(|q| scaled(q.gradient.as_slice())))
}

fn cost<'a>(
    model: &'a Model,
    runs: &'a [Run],
    derivatives: Derivatives,
    difference_step: f64,
) -> Result<Cost<'a>, PaperError> {
    let max_yaw_rate = FitSettings::default().max_yaw_rate;
    let options = CostOptions { max_yaw_rate, derivatives, difference_step, integration: INTEGRATION };
    Ok(Cost::new(model, runs, options)?)
}

/// Errors of the gradients of a case at the initial guess.
///
/// # Errors
/// [`PaperError::Diverged`] where a simulation diverges there.
pub fn accuracies(case: &Case, model: &Model, runs: &[Run]) -> Result<Accuracies, PaperError> {
    let diverged = || PaperError::Diverged { ship: case.ship.name() };
    let exact = gradient(model, runs, Derivatives::Lanes, 1e-5)?.ok_or_else(diverged)?;
    let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
    let size = norm(&mut exact.iter().copied());
    let error = |other: &[f64]| norm(&mut exact.iter().zip(other).map(|(a, b)| a - b)) / size;
    let steps = EXPONENTS
        .map(|exponent| {
            let step = 10.0_f64.powi(exponent);
            // The largest steps leave the parameters that can be simulated: a gap.
            let other = gradient(model, runs, Derivatives::FiniteDifferences, step)?;
            Ok((step, other.map_or(f64::NAN, |g| error(&g))))
        })
        .collect::<Result<_, PaperError>>()?;
    let oracle = gradient(model, runs, Derivatives::NumDual, 1e-5)?.ok_or_else(diverged)?;
    Ok(Accuracies { steps, oracle: error(&oracle) })
}

/// Fits in one way.
///
/// # Errors
/// [`PaperError::Fit`].
pub fn course(case: &Case, model: &Model, runs: &[Run], way: &Way) -> Result<Course, PaperError> {
    let settings = FitSettings {
        derivatives: way.derivatives,
        difference_step: way.step,
        hessian: way.hessian,
        integration: INTEGRATION,
        max_iterations: PATIENCE,
        polish_steps: 0,
        ..case.setup.fit
    };
    let clock = Instant::now();
    let mut path = Vec::new();
    let mut watch = |p: &Progress| {
        path.push((p.cost, p.violation, clock.elapsed().as_secs_f64()));
        true
    };
    let fit = fit(model, runs, &settings, &mut watch)?;
    Ok(Course {
        iterations: fit.iterations,
        converged: fit.converged,
        cost: fit.cost,
        evaluations: [fit.counts.objective, fit.counts.gradient],
        path,
        seconds: fit.seconds,
    })
}

/// Time of a gradient over that of a cost, both eight runs side by side.
///
/// # Errors
/// [`PaperError::Fit`].
pub fn gradient_times(model: &Model, runs: &[Run]) -> Result<[(&'static str, f64); 4], PaperError> {
    let p: Vec<f64> = model.free().iter().map(|i| model.parameters[*i].value).collect();
    let shortest = |work: &dyn Fn() -> bool| {
        let time = || {
            let clock = Instant::now();
            std::hint::black_box(work());
            clock.elapsed().as_secs_f64()
        };
        (0..5).map(|_| time()).fold(f64::INFINITY, f64::min)
    };
    let plain = cost(model, runs, Derivatives::Lanes, 1e-5)?;
    let unit = shortest(&|| plain.value(&p).is_some());
    let timed = |name, derivatives| -> Result<(&'static str, f64), PaperError> {
        let cost = cost(model, runs, derivatives, 1e-5)?;
        Ok((name, shortest(&|| cost.with_gradient(&p).is_some()) / unit))
    };
    Ok([
        timed("exact, duals over lanes", Derivatives::Lanes)?,
        timed("exact, duals run by run", Derivatives::Dual)?,
        timed("exact, num-dual run by run", Derivatives::NumDual)?,
        timed("central differences over lanes", Derivatives::FiniteDifferences)?,
    ])
}
