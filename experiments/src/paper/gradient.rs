//! Exact gradients against finite differences: accuracy over the step, cost of a gradient, and what a fit makes of either.
//! Work is counted, so that the figure repeats bit by bit; time is measured too, and kept apart as ratios within one run.

use super::case::{Case, initial_model};
use super::sheet::{cell, save};
use super::{Artefact, PaperError};
use std::path::Path;
use std::time::Instant;
use trimtab::fit::{Cost, CostOptions, Derivatives, FitSettings, Hessian, Progress, fit};
use trimtab::model::Model;
use trimtab::recording::Run;
use trimtab::report::{
    Axis, BLUE, Color, DASH, Figure, GREEN, Layer, ORANGE, PURPLE, Panel, SKY, Table, VERMILLION, fixed, sig,
};
use trimtab::simulate::{Integration, Method};

/// Exact gradient against finite differences.
pub static GRADIENT: Artefact = Artefact {
    name: "gradient",
    about: "Exact gradient against finite differences: accuracy, cost, iterations, final cost, time to a given cost",
    make,
};

/// Steps of the accuracy study, in units of each parameter's scale: decades from the first exponent to the last.
const EXPONENTS: std::ops::RangeInclusive<i32> = -12..=0;
/// A fit is there when its cost is within this share of the lowest.
const NEAR: f64 = 1e-3;
/// Largest violation of a (scaled) constraint at which a cost counts as reached.
const FEASIBLE: f64 = 1e-6;
/// Iterations after which a way has failed.
const PATIENCE: usize = 300;
/// One Euler step a sample: the comparison is of gradients, and needs many fits.
const INTEGRATION: Integration = Integration { method: Method::Euler, substeps: 1 };

/// One way to fit.
struct Way {
    name: &'static str,
    derivatives: Derivatives,
    step: f64,
    hessian: Hessian,
    color: Color,
    dashed: bool,
}

const WAYS: [Way; 7] = [
    Way {
        name: "exact, Gauss-Newton",
        derivatives: Derivatives::Lanes,
        step: 1e-5,
        hessian: Hessian::GaussNewton,
        color: BLUE,
        dashed: false,
    },
    Way {
        name: "exact, exact Hessian",
        derivatives: Derivatives::Lanes,
        step: 1e-5,
        hessian: Hessian::Exact,
        color: SKY,
        dashed: false,
    },
    Way {
        name: "exact, limited memory",
        derivatives: Derivatives::Lanes,
        step: 1e-5,
        hessian: Hessian::LimitedMemory,
        color: GREEN,
        dashed: false,
    },
    Way {
        name: "differences 1e-5, Gauss-Newton",
        derivatives: Derivatives::FiniteDifferences,
        step: 1e-5,
        hessian: Hessian::GaussNewton,
        color: VERMILLION,
        dashed: true,
    },
    Way {
        name: "differences 1e-5, limited memory",
        derivatives: Derivatives::FiniteDifferences,
        step: 1e-5,
        hessian: Hessian::LimitedMemory,
        color: ORANGE,
        dashed: true,
    },
    Way {
        name: "differences 1e-1, limited memory",
        derivatives: Derivatives::FiniteDifferences,
        step: 1e-1,
        hessian: Hessian::LimitedMemory,
        color: PURPLE,
        dashed: true,
    },
    Way {
        name: "differences 1e-9, limited memory",
        derivatives: Derivatives::FiniteDifferences,
        step: 1e-9,
        hessian: Hessian::LimitedMemory,
        color: trimtab::report::GREY,
        dashed: true,
    },
];

/// How a fit went.
struct Course {
    iterations: usize,
    converged: bool,
    cost: f64,
    /// Evaluations of the cost, and of its gradient.
    evaluations: [usize; 2],
    /// Cost, violation and time \[s\] at each iteration.
    path: Vec<(f64, f64, f64)>,
    seconds: f64,
}

fn make(cases: &[Case], out: &Path) -> Result<String, PaperError> {
    let mut fits = Table::new([
        "ship",
        "way",
        "iterations",
        "final cost",
        "over the best",
        "cost evaluations",
        "gradients",
        "iterations to the best + 0.1 %",
        "ended",
    ]);
    let mut speed = Table::new(["ship", "what", "time, as a ratio"]);
    let (mut accuracy_rows, mut fit_rows, mut ratio_rows) = (Vec::new(), Vec::new(), Vec::new());
    let mut accuracy = Panel::new(
        "gradient: error over step",
        Axis::new("step, in units of each parameter's scale").log(),
        Axis::new("relative error").log(),
    );
    let mut courses_panels = Vec::new();
    for (i, case) in cases.iter().enumerate() {
        let model = initial_model(case.ship, case.setup.form)?;
        let runs = case.training();

        let errors = accuracies(case, &model, &runs)?;
        for (step, error) in &errors.steps {
            accuracy_rows.push([
                case.ship.name().to_owned(),
                "central differences".to_owned(),
                cell(*step),
                cell(*error),
            ]);
        }
        accuracy_rows.push([case.ship.name().to_owned(), "num-dual".to_owned(), String::new(), cell(errors.oracle)]);
        let color = [VERMILLION, ORANGE][i % 2];
        accuracy =
            accuracy.with(Layer::line(format!("central differences, {}", case.label()), color, errors.steps.clone()));
        // On a logarithmic axis an error of exactly 0 has no place.
        accuracy = accuracy.with(
            Layer::h_line(
                format!("trimtab's duals against num-dual, {}", case.label()),
                [BLUE, SKY][i % 2],
                errors.oracle.max(1e-17),
            )
            .dashed(),
        );

        let courses: Vec<(&Way, Course)> =
            WAYS.iter().map(|way| Ok((way, course(case, &model, &runs, way)?))).collect::<Result<_, PaperError>>()?;
        let best = courses.iter().map(|(_, c)| c.cost).fold(f64::INFINITY, f64::min);
        let reached = |c: &Course| {
            c.path.iter().position(|(cost, violation, _)| *cost <= best * (1.0 + NEAR) && *violation <= FEASIBLE)
        };
        let reference = courses.first().and_then(|(_, c)| Some(c.path[reached(c)?].2));
        let mut panel = Panel::new(
            format!("{}: fit", case.label()),
            Axis::new("iteration + 1").log(),
            Axis::new("cost over the best - 1").log().range(1e-9, 1e2),
        );
        for (way, c) in &courses {
            let at = reached(c);
            fits.row([
                case.label().to_owned(),
                way.name.to_owned(),
                c.iterations.to_string(),
                sig(c.cost, 6),
                sig(c.cost / best - 1.0, 2),
                c.evaluations[0].to_string(),
                c.evaluations[1].to_string(),
                at.map_or(DASH.into(), |i| i.to_string()),
                if c.converged { "converged" } else { "not converged" }.to_owned(),
            ]);
            fit_rows.push([
                case.ship.name().to_owned(),
                way.name.to_owned(),
                c.iterations.to_string(),
                c.converged.to_string(),
                cell(c.cost),
                cell(c.cost / best - 1.0),
                c.evaluations[0].to_string(),
                c.evaluations[1].to_string(),
                at.map(|i| i.to_string()).unwrap_or_default(),
            ]);
            let ratio = at.and_then(|i| Some(c.path[i].2 / reference?));
            speed.row([
                case.label().to_owned(),
                format!("time to the best cost + 0.1 %: {} / {}", way.name, WAYS[0].name),
                ratio.map_or(DASH.into(), |r| fixed(r, 1)),
            ]);
            ratio_rows.push([
                case.ship.name().to_owned(),
                format!("time to the best cost + 0.1 % over that of {}", WAYS[0].name),
                way.name.to_owned(),
                ratio.map(|r| fixed(r, 2)).unwrap_or_default(),
            ]);
            let total = c.seconds / courses[0].1.seconds;
            ratio_rows.push([
                case.ship.name().to_owned(),
                format!("time of the whole fit over that of {}", WAYS[0].name),
                way.name.to_owned(),
                fixed(total, 2),
            ]);
            // Below the best cost only where constraints are still broken: those points have no place on the axis.
            let points = c.path.iter().enumerate().map(|(i, (cost, _, _))| ((i + 1) as f64, cost / best - 1.0 + 1e-12));
            let line = Layer::line(way.name, way.color, points);
            panel = panel.with(if way.dashed { line.dashed() } else { line });
        }
        courses_panels.push(panel);

        for (name, ratio) in gradient_times(&model, &runs)? {
            speed.row([case.label().to_owned(), format!("gradient / cost, {name}"), fixed(ratio, 1)]);
            ratio_rows.push([
                case.ship.name().to_owned(),
                "time of a gradient over that of a cost".into(),
                name.into(),
                fixed(ratio, 2),
            ]);
        }
    }
    save(out, "gradient_accuracy", ["ship", "gradient", "step", "relative_error"], accuracy_rows)?;
    let header = [
        "ship",
        "way",
        "iterations",
        "converged",
        "cost",
        "over_best",
        "cost_evaluations",
        "gradients",
        "iterations_to_best_plus_0.1_percent",
    ];
    save(out, "gradient_fits", header, fit_rows)?;
    save(out, "gradient_time_ratios", ["ship", "ratio_of_times_in_one_run", "way", "ratio"], ratio_rows)?;
    Figure::new("Exact gradient against finite differences")
        .columns(3)
        .panel_size(900, 640)
        .legend(trimtab::report::Legend::EachPanel)
        .with(accuracy)
        .with_all(courses_panels)
        .save(&out.join("gradient"))?;
    Ok(format!("{fits}\n\nTimes, as ratios within this run:\n{speed}\n"))
}

/// Relative errors of gradients at the initial guess.
struct Accuracies {
    /// Of central differences, by step.
    steps: Vec<(f64, f64)>,
    /// Of the exact gradient, against that of the num-dual crate.
    oracle: f64,
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

fn accuracies(case: &Case, model: &Model, runs: &[Run]) -> Result<Accuracies, PaperError> {
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

fn course(case: &Case, model: &Model, runs: &[Run], way: &Way) -> Result<Course, PaperError> {
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
fn gradient_times(model: &Model, runs: &[Run]) -> Result<[(&'static str, f64); 4], PaperError> {
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
