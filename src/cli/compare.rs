//! `trimtab compare`: several models on the same unseen runs.
//! The library judges them; this file reads the arguments and prints.

use super::shared::answer::Answer;
use super::shared::audited::{AcceptArgs, audited};
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::load::{Loaded, StudyArgs};
use super::shared::output::{Output, OutputArgs, csv_text};
use std::path::PathBuf;
use trimtab::evaluate::{Estimate, Judging, Ranked, Ranking, rank};
use trimtab::numbers::numerals::{DASH, interval, sig};
use trimtab::recording::Split;
use trimtab::report::Table;
use trimtab::report::plot::{Axis, FITTED, Figure, Layer, Panel};

const LONG: &str = "\
Simulates the test runs of a study with each of several models and compares their cVDM (mean deviation in all dimensions, percent of \
    the motion). Differences from the first model are paired: of the same windows, with intervals from a bootstrap that draws whole \
    runs, so that what makes a run hard for every model does not blur them. An interval that contains zero means that these runs do not \
    distinguish the two models.

No model may have been fitted to the test runs.";

const AFTER: &str = "\
Example:
  trimtab compare study.toml published.toml eleven.toml freed.toml --out compared

With --out: compare.json, compare.csv, compare.png with its CSV.
JSON: result.runs, result.trajectories, result.common, result.models[] with model, free, cvdm, difference (each value and ci95) [%], \
    runs_better, runs_worse, diverged; result.resamples, result.seed. A number that does not exist is absent.";

/// Compares several models on the same unseen runs
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// The study: a TOML file that names ship, model and recordings.
    #[arg(value_name = "STUDY")]
    study: PathBuf,
    /// Model files; the others are compared with the first.
    #[arg(value_name = "MODEL", required = true, num_args = 2..)]
    models: Vec<PathBuf>,
    #[command(flatten)]
    accept: AcceptArgs,
    #[command(flatten)]
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("compare", &args.output)?.drawn_as(&args.figures);
    for (i, path) in args.models.iter().enumerate() {
        if args.models[..i].contains(path) {
            let text =
                format!("{} is given twice: a model has no difference from itself; name it once", path.display());
            return Err(CliError::Argument(text));
        }
    }
    let loaded = Loaded::new(&StudyArgs { study: args.study.clone(), model: None })?;
    output.reads(&loaded, true);
    output.reads_files(&args.models);
    let mut models = args.models.iter().map(|path| loaded.other_model(path)).collect::<Result<Vec<_>, _>>()?;
    // Models of one name are distinguished by their files.
    let names: Vec<String> = models.iter().map(|m| m.name.clone()).collect();
    for (model, path) in models.iter_mut().zip(&args.models) {
        if names.iter().filter(|name| **name == model.name).count() > 1 {
            model.name = format!("{} ({})", model.name, path.display());
        }
    }
    output.recordings(audited(&loaded, &args.accept)?);
    let judging = Judging::new(&loaded.fit_settings()?, loaded.evaluation_settings()?);
    output.settings("evaluate", &loaded.evaluation_settings()?)?;
    let test = loaded.windows_of(Split::Test)?;
    let ranking = rank(&models, &test, &judging);
    output.file("compare.csv", &csv(&ranking)?);
    output.figure("compare", || figure(&ranking));
    let Ranking { runs, trajectories, common, seed, .. } = &ranking;
    let text = format!(
        "{}: {} models on {runs} test runs, {trajectories} trajectories, {common} of which every model runs through\n\n{}\n\ncVDM: mean \
         deviation in all dimensions, in % of the motion. 95 % intervals: bootstrap over runs, seed {seed}.",
        loaded.study.name,
        ranking.models.len(),
        table(&ranking)
    );
    output.finish(&text, &ranking)?;
    Ok(Answer::Yes)
}

fn table(ranking: &Ranking) -> Table {
    let mut table = Table::new([
        "model",
        "free",
        "cVDM [%]",
        "95 %",
        "less that of the first",
        "95 %",
        "runs better/worse",
        "diverged",
    ]);
    let cells = |e: Option<Estimate>| {
        let ends = e.and_then(|e| e.ci95).map_or_else(|| DASH.to_owned(), |[low, high]| interval(low, high, 3));
        [e.map_or_else(|| DASH.to_owned(), |e| sig(e.value, 3)), ends]
    };
    for (i, m) in ranking.models.iter().enumerate() {
        let Ranked { model, free, cvdm, difference, runs_better, runs_worse, diverged } = m;
        let [value, ends] = cells(*cvdm);
        let [apart, apart_ends] = cells(*difference);
        let runs = if i == 0 { DASH.to_owned() } else { format!("{runs_better}/{runs_worse}") };
        table.row([model.clone(), free.to_string(), value, ends, apart, apart_ends, runs, diverged.to_string()]);
    }
    table
}

fn csv(ranking: &Ranking) -> Result<Vec<u8>, CliError> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let header = [
        "model",
        "free",
        "cvdm_percent",
        "cvdm_low",
        "cvdm_high",
        "difference_percent",
        "difference_low",
        "difference_high",
        "runs_better",
        "runs_worse",
        "diverged",
    ];
    let rows = ranking.models.iter().map(|m| {
        let of = |e: Option<Estimate>| {
            let ends = e.and_then(|e| e.ci95);
            [number(e.map(|e| e.value)), number(ends.map(|c| c[0])), number(ends.map(|c| c[1]))]
        };
        let counts = [m.runs_better, m.runs_worse, m.diverged].map(|n| n.to_string());
        let mut row = vec![m.model.clone(), m.free.to_string()];
        row.extend(of(m.cvdm));
        row.extend(of(m.difference));
        row.extend(counts);
        row
    });
    csv_text(&header, rows)
}

fn figure(ranking: &Ranking) -> Figure {
    let bars = ranking.models.iter().map(|m| {
        let value = m.cvdm.map_or(f64::NAN, |e| e.value);
        let [low, high] = m.cvdm.and_then(|e| e.ci95).unwrap_or([value, value]);
        (value, low, high)
    });
    let names = ranking.models.iter().map(|m| m.model.clone());
    Figure::new("Models on the same unseen runs")
        .caption("Mean cVDM of each model over the test runs, with 95 % intervals of a bootstrap over runs.")
        .with(
            Panel::new("", Axis::categories("", names), Axis::new("mean cVDM [%]").including(0.0))
                .with(Layer::bars_with_intervals("cVDM", FITTED, bars)),
        )
}
