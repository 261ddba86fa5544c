//! Draws the time of a cost with its derivatives against the number of free parameters, from an interleaved measurement.
//! It is the figure `gauss_newton` beside the bench of the engine, which it shares its case with; no test depends on a time.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use trimtab::fit::{Cost, Derivatives};
use trimtab::model::Model;
use trimtab::report::plot::{Axis, BLUE, Figure, GREEN, GREY, Layer, Panel, VERMILLION};

#[path = "support/case.rs"]
#[allow(dead_code, reason = "settings of a fit are for the bench alone")]
mod case;
#[path = "../experiments/src/freed.rs"]
mod free_more;
#[path = "support/freed.rs"]
mod freed;
#[path = "../experiments/src/interleaved.rs"]
mod interleaved;
use case::{cost, recordings};
use freed::{freed, start};
use interleaved::{Task, least};

const ROUNDS: usize = 15;
const COUNTS: [usize; 6] = [11, 20, 30, 40, 50, 60];

fn main() -> Result<(), Box<dyn Error>> {
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    let runs = recordings(3.0);
    let models: Vec<Model> = COUNTS.iter().map(|count| freed(*count, true)).collect();
    let starts: Vec<Vec<f64>> = models.iter().map(start).collect();
    let of = |derivatives| -> Vec<Cost> { models.iter().map(|model| cost(model, &runs, derivatives)).collect() };
    let (lanes, differences) = (of(Derivatives::Lanes), of(Derivatives::FiniteDifferences));
    let mut tasks: Vec<Task> = Vec::new();
    for ((exact, approximate), p) in lanes.iter().zip(&differences).zip(&starts) {
        tasks.push(("rollout".into(), Box::new(move || _ = black_box(exact.value(p)))));
        tasks.push(("gradient".into(), Box::new(move || _ = black_box(exact.with_gradient(p)))));
        tasks.push(("gradient and Gauss-Newton".into(), Box::new(move || _ = black_box(exact.quadratic(p)))));
        let by_differences = move || _ = black_box(approximate.with_gradient(p));
        tasks.push(("gradient by central differences".into(), Box::new(by_differences)));
    }
    let times = least(ROUNDS, &mut tasks);
    let series = tasks.len() / COUNTS.len();
    let line = |s: usize, color| {
        let points = COUNTS.iter().enumerate().map(|(i, count)| (*count as f64, 1e3 * times[i * series + s]));
        Layer::line(tasks[s].0.clone(), color, points)
    };
    let axes = |title: &str| {
        Panel::new(title, Axis::new("free parameters [-]").range(10.0, 61.0), Axis::new("time [ms]").including(0.0))
    };
    let exact = [line(0, GREY), line(1, GREEN), line(2, BLUE)];
    let figure = Figure::new("Cost of 165 runs of 120 steps with its derivatives, one thread")
        .columns(2)
        .with(axes("exact derivatives").with_all(exact.clone()))
        .with(axes("beside central differences").with_all(exact).with(line(3, VERMILLION)));
    for path in figure.save(&Path::new(env!("CARGO_MANIFEST_DIR")).join("figures/gauss_newton"))? {
        println!("{}", path.display());
    }
    Ok(())
}
