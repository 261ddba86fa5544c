//! Measures exact gradients and finite differences: errors over the step, the course of a fit, and times.
//! Work is counted, so that it repeats bit by bit; times are measured and are ratios within one run. Nothing is drawn here.

use trimtab::fit::{Cost, CostOptions, Derivatives, Fit, FitSettings, Hessian, Progress, fit};
use trimtab::model::Model;
use trimtab::recording::Run;
use trimtab::report::plot::{BLUE, Color, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION};
use trimtab::simulate::{Integration, Method};

use crate::interleaved::{Repeats, Task, processor_time, repeats};
use crate::paper::case::Case;
use crate::paper::error::PaperError;

/// Steps of the accuracy study, in units of each parameter's scale: decades from the first exponent to the last.
const EXPONENTS: std::ops::RangeInclusive<i32> = -12..=0;
/// A fit has reached the best when its cost is within this share of the lowest.
const NEAR: f64 = 1e-3;
/// Rounds in which each fit, and each gradient, is repeated; repeats that differ by more than this share are refused.
const FIT_ROUNDS: usize = 3;
const GRADIENT_ROUNDS: usize = 15;
const SCATTER: f64 = 0.1;

/// Iterations after which a fit has failed.
const PATIENCE: usize = 300;
/// One Euler step a sample: the comparison is of gradients, and needs many fits.
pub(super) const INTEGRATION: Integration = Integration { method: Method::Euler, substeps: 1 };

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

    fn settings(&self, case: &Case) -> FitSettings {
        FitSettings {
            derivatives: self.derivatives,
            difference_step: self.step,
            hessian: self.hessian,
            integration: INTEGRATION,
            max_iterations: PATIENCE,
            polish_steps: 0,
            ..case.setup.fit
        }
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
    /// Lowest cost of all runs so far that keeps the constraints, and processor time \[s\], at each iteration.
    pub path: Vec<(f64, f64)>,
    /// Processor time of the whole fit \[s\].
    pub seconds: f64,
}

impl Course {
    /// The course of a fit that is done.
    fn of(fit: &Fit, path: Vec<(f64, f64)>, seconds: f64) -> Self {
        Self {
            iterations: fit.iterations,
            converged: fit.converged,
            cost: fit.cost,
            evaluations: [fit.counts.objective, fit.counts.gradient],
            path,
            seconds,
        }
    }

    /// The lowest cost on the way.
    pub fn lowest(&self) -> Option<f64> {
        self.path.last().map(|(cost, _)| *cost)
    }

    /// The first point on the way within 0.1 % of the cost `best`.
    pub fn reached(&self, best: f64) -> Option<usize> {
        self.path.iter().position(|(cost, _)| *cost <= best * (1.0 + NEAR))
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

/// Fits in each way, several times in turn, with the least processor time of each point on the way.
///
/// # Errors
/// [`PaperError::Fit`]; [`PaperError::Scatter`] where the times do not repeat.
pub fn courses(case: &Case, model: &Model, runs: &[Run]) -> Result<Vec<Course>, PaperError> {
    let mut all: Vec<Vec<Course>> = WAYS.iter().map(|_| Vec::with_capacity(FIT_ROUNDS)).collect();
    for _ in 0..FIT_ROUNDS {
        for (way, courses) in WAYS.iter().zip(&mut all) {
            courses.push(course(model, runs, &way.settings(case))?);
        }
    }
    WAYS.iter().zip(all).map(|(way, courses)| of_rounds(case, way.name, courses)).collect()
}

/// The course of a fit that was repeated, with the least of its times.
///
/// # Errors
/// [`PaperError::Scatter`] where the times do not repeat.
pub(super) fn of_rounds(case: &Case, way: &str, courses: Vec<Course>) -> Result<Course, PaperError> {
    let seconds = checked(case, way, repeats_of(&courses))?;
    let mut courses = courses.into_iter();
    let Some(mut out) = courses.next() else { return Err(PaperError::Empty { ship: case.ship.name(), what: "fit" }) };
    for other in courses {
        out.path.iter_mut().zip(&other.path).for_each(|(own, other)| own.1 = own.1.min(other.1));
    }
    out.seconds = seconds;
    Ok(out)
}

fn repeats_of(courses: &[Course]) -> Repeats {
    Repeats::of(&courses.iter().map(|c| c.seconds).collect::<Vec<_>>())
}

/// Whether the times of a fit that was repeated agree.
pub(super) fn repeat(courses: &[Course]) -> bool {
    repeats_of(courses).scatter <= SCATTER
}

/// The least time of repeats, where they agree.
fn checked(case: &Case, what: &str, Repeats { least, scatter }: Repeats) -> Result<f64, PaperError> {
    if scatter <= SCATTER {
        return Ok(least);
    }
    Err(PaperError::Scatter { ship: case.ship.name(), what: what.to_owned(), percent: 100.0 * scatter })
}

/// The course of one fit by the cost of all whole runs at the best feasible point so far, whatever its solver minimises on the way: a stage
/// over shorter pieces or a few of the runs, and the check of an optimum, have costs that cannot be compared. The clock stands still for
/// these costs.
///
/// # Errors
/// [`PaperError::Fit`].
pub(super) fn course(model: &Model, runs: &[Run], settings: &FitSettings) -> Result<Course, PaperError> {
    let mut points: Vec<(Vec<f64>, f64)> = Vec::new();
    let (fit, seconds) =
        watched(model, runs, settings, |p, time| points.extend(p.best.map(|best| (best.to_vec(), time))))?;
    let whole = Cost::new(model, runs, CostOptions { derivatives: Derivatives::Lanes, ..settings.cost_options() })?;
    let mut end = fit.estimates.iter().map(|e| e.value).collect::<Vec<f64>>();
    end.truncate(model.free().len());
    points.push((end, seconds));
    let mut least = f64::INFINITY;
    let lowered = |(p, time): &(Vec<f64>, f64)| {
        least = whole.value(p).map_or(least, |value| value.min(least));
        (least, *time)
    };
    let path = points.iter().map(lowered).filter(|(cost, _)| cost.is_finite()).collect();
    Ok(Course::of(&fit, path, seconds))
}

/// A fit whose progress is seen with the processor time so far \[s\], and the time of all of it.
///
/// # Errors
/// [`PaperError::Fit`].
fn watched(
    model: &Model,
    runs: &[Run],
    settings: &FitSettings,
    mut see: impl FnMut(&Progress, f64),
) -> Result<(Fit, f64), PaperError> {
    let begin = processor_time();
    let mut watch = |p: &Progress| {
        see(p, processor_time() - begin);
        true
    };
    let fit = fit(model, runs, settings, &mut watch)?;
    Ok((fit, processor_time() - begin))
}

/// Processor time of a gradient over that of a cost, both eight runs side by side, measured in turn.
///
/// # Errors
/// [`PaperError::Fit`]; [`PaperError::Scatter`] where the times do not repeat.
pub fn gradient_times(case: &Case, model: &Model, runs: &[Run]) -> Result<[(&'static str, f64); 4], PaperError> {
    let p: Vec<f64> = model.free().iter().map(|i| model.parameters[*i].value).collect();
    let of = |derivatives| cost(model, runs, derivatives, 1e-5);
    let plain = of(Derivatives::Lanes)?;
    let ways = [
        ("exact, duals over lanes", of(Derivatives::Lanes)?),
        ("exact, duals run by run", of(Derivatives::Dual)?),
        ("exact, num-dual run by run", of(Derivatives::NumDual)?),
        ("central differences over lanes", of(Derivatives::FiniteDifferences)?),
    ];
    let p = &p;
    let alone = || {
        std::hint::black_box(plain.value(p));
    };
    let mut tasks: Vec<Task> = vec![("cost".to_owned(), Box::new(alone))];
    for (name, cost) in &ways {
        tasks.push(((*name).to_owned(), Box::new(move || drop(std::hint::black_box(cost.with_gradient(p))))));
    }
    let times = repeats(GRADIENT_ROUNDS, &mut tasks);
    let unit = checked(case, "cost", times[0])?;
    let ratio = |k: usize| Ok::<f64, PaperError>(checked(case, ways[k].0, times[k + 1])? / unit);
    Ok([(ways[0].0, ratio(0)?), (ways[1].0, ratio(1)?), (ways[2].0, ratio(2)?), (ways[3].0, ratio(3)?)])
}
