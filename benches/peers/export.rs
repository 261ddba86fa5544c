//! Writes the benchmark's fit for other tools (recordings, constants, constraint rows, expected answers), or times it.
//! It is the Rust half of `benches/peers/run.py` and of no use alone; what it times is what the other tools are timed on.

use rustix::time::{ClockId, clock_gettime};
use serde_json::{Map, Value, json};
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;
use trimtab::fit::objectives::cost::weights;
use trimtab::fit::solver::constraints::{self, Row};
use trimtab::fit::{Derivatives, Fit, FitSettings, fit};
use trimtab::model::Model;
use trimtab::recording::{Run, or_nan};
use trimtab::terms::steering::rudder;

#[path = "../support/case.rs"]
mod case;

/// Sample period \[s\], as in the paper.
const DT: f64 = 3.0;
/// A sample of a short evaluation lasts at least this long \[s\], so that the clocks' resolution does not matter.
const BATCH_SECONDS: f64 = 0.1;
const USAGE: &str = "usage: export_peers DIRECTORY | export_peers --time N";

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["--time", samples] => time(samples.parse()?),
        [directory] => export(Path::new(directory)),
        _ => Err(USAGE.into()),
    }
}

fn export(directory: &Path) -> Result<()> {
    std::fs::create_dir_all(directory)?;
    let (model, runs) = (case::ship_a(), case::recordings(DT));
    write_runs(&directory.join("runs.csv"), &model, &runs)?;
    write_samples(&directory.join("samples.csv"), &runs)?;
    write_json(&directory.join("constants.json"), &constants(&model, &runs))?;
    let rows = constraints::rows(&model, &case::settings().constraints, constraints::speed_range(&runs))?;
    write_constraints(&directory.join("constraints.csv"), &rows)?;
    write_json(&directory.join("expected.json"), &expected(&model, &runs)?)
}

fn write_json(path: &Path, value: &Value) -> Result<()> {
    std::fs::write(path, serde_json::to_string_pretty(value)?)?;
    Ok(())
}

fn header(first: &[&str], prefix: &str) -> Vec<String> {
    let states = trimtab::ship::state::STATE_NAMES.iter().map(|name| format!("{prefix}{name}"));
    first.iter().map(ToString::to_string).chain(states).collect()
}

/// One line a run: initial state and the square of each channel's factor on its residual.
fn write_runs(path: &Path, model: &Model, runs: &[Run]) -> Result<()> {
    let mut file = csv::Writer::from_path(path)?;
    file.write_record(header(&["run"], "initial_").into_iter().chain(header(&[], "weight_")))?;
    for (i, run) in runs.iter().enumerate() {
        let weights = weights(&model.ship, run, FitSettings::default().max_yaw_rate);
        let numbers = run.initial.iter().chain(&weights).map(ToString::to_string);
        file.write_record(std::iter::once(i.to_string()).chain(numbers))?;
    }
    Ok(file.flush()?)
}

/// One line a sample: inputs and measured state.
fn write_samples(path: &Path, runs: &[Run]) -> Result<()> {
    let mut file = csv::Writer::from_path(path)?;
    file.write_record(header(&["run", "step", "n", "delta"], "measured_"))?;
    for (i, run) in runs.iter().enumerate() {
        for (k, (inputs, measured)) in run.inputs.iter().zip(&run.measured).enumerate() {
            let numbers = [inputs.n, inputs.delta].into_iter().chain(or_nan(measured)).map(|x| x.to_string());
            file.write_record([i.to_string(), k.to_string()].into_iter().chain(numbers))?;
        }
    }
    Ok(file.flush()?)
}

/// One line a row: eleven coefficients and the limits of their sum, what fixed parameters contribute taken off.
fn write_constraints(path: &Path, rows: &[Row]) -> Result<()> {
    let mut file = csv::Writer::from_path(path)?;
    let columns = rows.first().map_or(0, |row| row.coefficients.len());
    let names = (0..columns).map(|j| format!("a{j}")).chain(["lower".to_string(), "upper".to_string()]);
    file.write_record(names)?;
    for row in rows {
        let limits = [row.lower - row.constant, row.upper - row.constant];
        file.write_record(row.coefficients.iter().chain(&limits).map(ToString::to_string))?;
    }
    Ok(file.flush()?)
}

/// What the equations need: the ship, the values of all parameters, and the free ones with start, bounds and scale.
fn constants(model: &Model, runs: &[Run]) -> Value {
    let ship = &model.ship;
    let values: Map<String, Value> = model.parameters.iter().map(|p| (p.name.clone(), json!(p.value))).collect();
    let bound = |x: f64| x.is_finite().then_some(x);
    let free = model.free().into_iter().map(|i| &model.parameters[i]).map(|p| {
        json!({
            "name": p.name, "symbol": p.info.symbol, "start": p.value, "scale": p.scale,
            "lower": bound(p.lower), "upper": bound(p.upper),
        })
    });
    let samples: usize = runs.iter().map(|r| r.measured.len()).sum();
    json!({
        "dt": DT,
        "objective_factor": runs.len() as f64 / samples as f64,
        "ship": {
            "lpp": ship.hull.lpp,
            "water_density": ship.hull.water_density,
            "small_speed": ship.small_speed(),
            "propeller_diameter": ship.propeller.diameter,
            "propeller_x": ship.propeller_x(),
            "rudder_area": ship.rudder.area,
            "rudder_span": ship.rudder.span,
            "rudder_x": ship.rudder_x(),
        },
        "rudder_curve_limit": rudder::CURVE_LIMIT,
        "rudder_plate_limit": rudder::PLATE_LIMIT,
        "rudder_plate_normal": rudder::PLATE_NORMAL,
        "parameters": values,
        "free": free.collect::<Vec<_>>(),
    })
}

fn start(model: &Model) -> Vec<f64> {
    model.free().into_iter().map(|i| model.parameters[i].value).collect()
}

/// The answers a tool that does the same fit must give.
fn expected(model: &Model, runs: &[Run]) -> Result<Value> {
    let cost = case::cost(model, runs, Derivatives::Dual);
    let p = start(model);
    let at_start = cost.quadratic(&p).ok_or("the simulation diverges at the start")?;
    let mut settings = case::settings();
    settings.tolerance = 1e-10;
    let tight = fit(model, runs, &settings, &mut |_| true)?;
    let default = fit(model, runs, &case::settings(), &mut |_| true)?;
    if !(tight.converged && default.converged) {
        return Err(format!("the fit did not converge: {}; {}", tight.status, default.status).into());
    }
    let optimum = |fit: &Fit| fit.estimates.iter().map(|e| e.value).collect::<Vec<f64>>();
    Ok(json!({
        "start": {
            "p": p,
            "cost": at_start.value,
            "gradient": at_start.gradient.as_slice(),
            "gauss_newton": at_start.gauss_newton.row_iter().map(|r| r.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
        },
        "optimum": { "p": optimum(&tight), "cost": tight.cost, "iterations": tight.iterations },
        "default": { "p": optimum(&default), "cost": default.cost, "iterations": default.iterations },
    }))
}

/// Processor time of this process so far, all threads together \[s\].
fn processor_seconds() -> f64 {
    let t = clock_gettime(ClockId::ProcessCPUTime);
    t.tv_sec as f64 + 1e-9 * t.tv_nsec as f64
}

/// Prints one line a sample: what, wall time and processor time of one evaluation \[s\].
fn sample(what: &str, count: usize, mut evaluate: impl FnMut()) {
    let (wall, processor) = (Instant::now(), processor_seconds());
    for _ in 0..count {
        evaluate();
    }
    let (wall, processor) = (wall.elapsed().as_secs_f64(), processor_seconds() - processor);
    println!("{what},{:e},{:e}", wall / count as f64, processor / count as f64);
}

/// Prints `samples` samples of one evaluation, each a batch that lasts long enough to be measured, after a warm-up.
fn samples(what: &str, samples: usize, mut evaluate: impl FnMut()) {
    let clock = Instant::now();
    evaluate();
    let count = (BATCH_SECONDS / clock.elapsed().as_secs_f64()).ceil().max(1.0) as usize;
    for _ in 0..samples {
        sample(what, count, &mut evaluate);
    }
}

/// Times trimtab's own evaluations and its whole fit, uncertainties included, on as many threads as rayon is given.
fn time(count: usize) -> Result<()> {
    let (model, runs, settings) = (case::ship_a(), case::recordings(DT), case::settings());
    let cost = case::cost(&model, &runs, Derivatives::default());
    let p = start(&model);
    println!("what,wall_s,processor_s");
    samples("cost", count, || {
        black_box(cost.value(&p));
    });
    samples("gradient", count, || {
        black_box(cost.with_gradient(&p));
    });
    samples("gradient+Gauss-Newton", count, || {
        black_box(cost.quadratic(&p));
    });
    samples("full fit", count, || {
        drop(black_box(fit(&model, &runs, &settings, &mut |_| true)));
    });
    Ok(())
}
