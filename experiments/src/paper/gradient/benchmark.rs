//! One fit by several sources of derivatives, all through Ipopt: how fast its cost falls from the paper's p~, and which share of random
//! starts reaches the optimum in which time, with 11, 30 and 60 parameters free. Gradients alone are compared in `measure`.

use std::fmt::Write;
use trimtab::fit::{Cost, CostOptions, Derivatives, FitSettings, Hessian, MultiStart};
use trimtab::model::Model;
use trimtab::numbers::numerals::{DASH, fixed, sig};
use trimtab::recording::Run;
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BLUE, Color, Figure, Layer, Legend, ORANGE, Panel, SKY, VERMILLION};

use super::measure::{Course, INTEGRATION, course, of_rounds, repeat};
use crate::freed::free_more;
use crate::interleaved::{Task, least};
use crate::paper::artefact::Artefact;
use crate::paper::case::{Case, initial_model};
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;

/// The benchmark.
pub static BENCHMARK: Artefact = Artefact {
    name: "benchmark",
    about: "The same fit through Ipopt with exact gradients and with differences: time to the optimum from p~ and from random starts",
    make,
};

/// Numbers of free parameters.
const SIZES: [usize; 3] = [11, 30, 60];

/// Of the training runs every how many are fitted to.
const EVERY: usize = 12;

/// Random starts around p~.
const STARTS: MultiStart = MultiStart { count: 20, spread: 0.5, seed: 20_261_127 };

/// Rounds in which the fits from p~ are repeated, the fewest and the most until their times repeat; the least time of each point counts.
const ROUNDS: [usize; 2] = [3, 12];
/// Rounds of the time of one simulation of all runs, the unit of time, and of an exact matrix of second derivatives.
const UNIT_ROUNDS: usize = 15;

/// Time \[s\] and iterations after which a fit has failed: a time that no fit needs, since a fit that it ends takes more or less of the
/// processor as the machine has other work.
const LIMIT: f64 = 60.0;
const PATIENCE: usize = 300;

/// Sources of derivatives, with their colours.
const SOURCES: [(&str, Derivatives, Color); 4] = [
    ("exact, duals over lanes", Derivatives::Lanes, BLUE),
    ("exact, num-dual", Derivatives::NumDual, SKY),
    ("central differences", Derivatives::FiniteDifferences, VERMILLION),
    ("forward differences", Derivatives::ForwardDifferences, ORANGE),
];

/// Second derivatives.
const HESSIANS: [(&str, Hessian); 2] =
    [("Gauss-Newton", Hessian::GaussNewton), ("limited memory", Hessian::LimitedMemory)];

/// One way to fit, with its fits.
struct Way {
    source: &'static str,
    hessian: &'static str,
    color: Color,
    is_dashed: bool,
    /// From p~.
    course: Course,
    /// From random starts: none where a start could not be simulated. Empty for num-dual, whose derivatives are those over lanes to
    /// rounding, so that it takes the same steps.
    starts: Vec<Option<Course>>,
}

impl Way {
    /// Times to the best cost from the starts that reach it \[s\], in rising order.
    fn reached(&self, best: f64) -> Vec<f64> {
        let time = |c: &Course| c.reached(best).map(|i| c.path[i].1);
        let mut times: Vec<f64> = self.starts.iter().flatten().filter_map(time).collect();
        times.sort_by(f64::total_cmp);
        times
    }
}

/// All ways to fit one model.
fn ways(case: &Case, model: &Model, runs: &[Run]) -> Result<Vec<Way>, PaperError> {
    let starts = STARTS.models(model);
    let mut ways = Vec::new();
    for (source, derivatives, color) in SOURCES {
        for (hessian, kind) in HESSIANS {
            let settings = FitSettings {
                derivatives,
                hessian: kind,
                integration: INTEGRATION,
                max_iterations: PATIENCE,
                max_seconds: LIMIT,
                polish_steps: 0,
                ..case.setup.fit
            };
            let mut rounds = Vec::new();
            while rounds.len() < ROUNDS[0] || (rounds.len() < ROUNDS[1] && !repeat(&rounds)) {
                rounds.push(course(model, runs, &settings)?);
            }
            let name = format!("{} free: {source}, {hessian}", model.free().len());
            let times: Vec<String> = rounds.iter().map(|c| sig(c.seconds, 3)).collect();
            eprintln!("{name}: fits from p~ took {} s of processor time", times.join(", "));
            ways.push(Way {
                source,
                hessian,
                color,
                is_dashed: kind == Hessian::LimitedMemory,
                course: of_rounds(case, &name, rounds)?,
                starts: if derivatives == Derivatives::NumDual {
                    Vec::new()
                } else {
                    starts.iter().map(|from| course(from, runs, &settings).ok()).collect()
                },
            });
        }
    }
    Ok(ways)
}

/// Processor time of one simulation of all runs \[s\], and that of an exact matrix of second derivatives over that of a gradient.
fn unit(model: &Model, runs: &[Run]) -> Result<[f64; 2], PaperError> {
    let options = CostOptions { integration: INTEGRATION, ..FitSettings::default().cost_options() };
    let cost = Cost::new(model, runs, options)?;
    let p: Vec<f64> = model.free().iter().map(|i| model.parameters[*i].value).collect();
    let alone = || {
        std::hint::black_box(cost.value(&p));
    };
    let mut simulated: [Task; 2] = [
        ("cost".to_owned(), Box::new(alone)),
        ("gradient".to_owned(), Box::new(|| drop(std::hint::black_box(cost.with_gradient(&p))))),
    ];
    let times = least(UNIT_ROUNDS, &mut simulated);
    let mut second: [Task; 1] = [("hessian".to_owned(), Box::new(|| drop(std::hint::black_box(cost.hessian(&p)))))];
    Ok([times[0], least(1, &mut second)[0] / times[1]])
}

/// What is reported.
struct Report {
    table: Table,
    sheet: Sheet<10>,
    panels: [Vec<Panel>; 2],
    text: String,
}

impl Report {
    fn new() -> Self {
        Self {
            table: Table::new([
                "free",
                "derivatives",
                "second derivatives",
                "iterations",
                "time to the best + 0.1 %",
                "starts that reach it",
                "their median time",
            ]),
            sheet: Sheet::new(
                "benchmark_fits",
                [
                    "free",
                    "derivatives",
                    "hessian",
                    "iterations",
                    "cost_evaluations",
                    "gradients",
                    "cost_over_best",
                    "time_to_best_in_simulations",
                    "starts_that_reach_it",
                    "their_median_time_in_simulations",
                ],
            ),
            panels: [Vec::new(), Vec::new()],
            text: String::new(),
        }
    }

    /// Adds all ways to fit with so many parameters free; times in units of one simulation of all runs.
    fn add(&mut self, free: usize, ways: &[Way], simulation: f64) {
        let all = ways.iter().flat_map(|way| way.starts.iter().flatten().chain([&way.course]));
        let best = all.filter_map(Course::lowest).fold(f64::INFINITY, f64::min);
        let title = format!("{free} parameters free");
        let time = || Axis::new("processor time over that of one simulation of all runs").log();
        let falls = Axis::new("cost over the best - 1").log().range(1e-9, 1e2);
        let mut from_guess = Panel::new(format!("{title}: from p~"), time(), falls);
        let share = Axis::new("share at the best cost + 0.1 % [%]").range(0.0, 100.0);
        let mut from_starts = Panel::new(format!("{title}: from {} random starts", STARTS.count), time(), share);
        for way in ways {
            self.add_way(free, way, best, simulation);
            let name = format!("{}, {}", way.source, way.hessian);
            let style = |layer: Layer| if way.is_dashed { layer.dashed() } else { layer };
            let points = way.course.path.iter().map(|(cost, t)| (t / simulation, cost / best - 1.0 + 1e-12));
            from_guess = from_guess.with(style(Layer::line(name.clone(), way.color, points)));
            if !way.starts.is_empty() {
                let steps = steps(&way.reached(best), simulation);
                from_starts = from_starts.with(style(Layer::line(name, way.color, steps)));
            }
        }
        self.panels[0].push(from_guess);
        self.panels[1].push(from_starts);
    }

    fn add_way(&mut self, free: usize, way: &Way, best: f64, simulation: f64) {
        let c = &way.course;
        let to_best = c.reached(best).map(|i| c.path[i].1 / simulation);
        let times = way.reached(best);
        let median = times.get(times.len() / 2).map(|t| t / simulation);
        let dash = |value: Option<f64>| value.map_or(DASH.into(), |t| sig(t, 3));
        self.table.row([
            free.to_string(),
            way.source.to_owned(),
            way.hessian.to_owned(),
            c.iterations.to_string(),
            dash(to_best),
            if way.starts.is_empty() { DASH.into() } else { format!("{} of {}", times.len(), STARTS.count) },
            dash(median),
        ]);
        let rounded = |value: Option<f64>| value.map(|t| fixed(t, 0)).unwrap_or_default();
        self.sheet.row([
            free.to_string(),
            way.source.to_owned(),
            way.hessian.to_owned(),
            c.iterations.to_string(),
            c.evaluations[0].to_string(),
            c.evaluations[1].to_string(),
            cell(c.cost / best - 1.0),
            rounded(to_best),
            if way.starts.is_empty() { String::new() } else { times.len().to_string() },
            rounded(median),
        ]);
    }
}

/// The share of the starts, in per cent, that have reached the optimum by a time, as the corners of a staircase.
fn steps(times: &[f64], unit: f64) -> Vec<(f64, f64)> {
    let share = |count: usize| 100.0 * count as f64 / STARTS.count as f64;
    times.iter().enumerate().flat_map(|(i, t)| [(t / unit, share(i)), (t / unit, share(i + 1))]).collect()
}

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut report = Report::new();
    if let Some(case) = cases.first() {
        let runs: Vec<Run> = case.training().into_iter().step_by(EVERY).collect();
        let _ = writeln!(
            report.text,
            "{}, {} runs; a time is processor time over that of one simulation of all runs; seed of the starts {}",
            case.label(),
            runs.len(),
            STARTS.seed
        );
        for size in SIZES {
            let mut model = initial_model(case.ship, case.setup.form)?;
            free_more(&mut model, size)?;
            let [simulation, hessian] = unit(&model, &runs)?;
            let second = sig(hessian, 2);
            let _ =
                writeln!(report.text, "{size} free: an exact matrix of second derivatives costs {second} gradients");
            report.add(size, &ways(case, &model, &runs)?, simulation);
        }
    }
    report.sheet.save(&to.folder)?;
    let [from_guess, from_starts] = report.panels;
    let figure = Figure::new("One fit through Ipopt: exact gradients against differences")
        .columns(SIZES.len())
        .panel_size(900, 560)
        .legend(Legend::Shared)
        .with_all(from_guess)
        .with_all(from_starts);
    to.figure("benchmark", figure)?;
    Ok(format!("{}\n\n{}", report.table, report.text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_that_has_reached_the_optimum_rises_by_one_start_at_each_of_their_times() {
        assert_eq!(steps(&[2.0, 6.0], 2.0), [(1.0, 0.0), (1.0, 5.0), (3.0, 5.0), (3.0, 10.0)]);
    }
}
