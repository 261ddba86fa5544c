//! `trimtab demo`: a complete study, from recordings to a fitted model, in seconds and without any file of the user's.
//! It calls the other commands' functions, and writes the study so that a user can repeat each command on it.

use super::answer::Answer;
use super::error::CliError;
use super::load::{Loaded, StudyArgs};
use super::output::{Output, OutputArgs};
use super::{evaluate, fit};
use serde::Serialize;
use std::path::{Path, PathBuf};
use trimtab::demo;
use trimtab::evaluate::Evaluation;
use trimtab::files::{Origin, ResultFolder};
use trimtab::fit::Fit;
use trimtab::maneuver::{Side, turning_trial};
use trimtab::model::Model;
use trimtab::numerals::{DASH, interval, sig};
use trimtab::ranks::Ranks;
use trimtab::recording::{Runs, Split};
use trimtab::report::Table;
use trimtab::report::maneuver::{measures_table, turning_figure};

const LONG: &str = "\
Runs the whole job on a built-in example: forty recordings of a coastal container ship of 85 m (made by a simulator with \
    more physics than the model has), a model with eleven unknown parameters, a fit to 32 of the runs, and an evaluation on \
    the other 8 against a published baseline. The study is written to the folder, ready to be copied.";

const AFTER: &str = "\
Example:
  trimtab demo --out tour
  trimtab maneuver zigzag tour/study.toml --model tour/results/fitted.toml --out tour/zigzag

JSON: result.folder, result.fit (as of `trimtab fit`), result.evaluation (as of `trimtab evaluate`).";

/// Runs the whole job on a built-in example
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// Folder for study and results; created if absent.
    #[arg(long, value_name = "DIR", default_value = "trimtab-demo")]
    out: PathBuf,
    /// Print the result as one JSON object, and nothing else, to standard output.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    folder: &'a PathBuf,
    fit: &'a Fit,
    evaluation: &'a Evaluation,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let study = args.out.join("study.toml");
    let results = OutputArgs { out: Some(args.out.join("results")), json: args.json, tables: Vec::new() };
    let mut output = Output::new("demo", &results)?;
    let written = write_study(&args.out)?;
    let loaded = Loaded::new(&StudyArgs { study: study.clone(), model: None })?;
    output.reads(&loaded, true);
    output.reads_files(&[evaluate::baseline_path(&loaded, None)?]);
    output.settings("fit", &loaded.fit_settings()?)?;
    output.settings("evaluate", &loaded.evaluation_settings()?)?;
    let train = loaded.windows_of(Split::Train)?;
    let test = loaded.windows_of(Split::Test)?;
    let fit = fit::fit_windows(Ranks::one(), &loaded, &loaded.model, Runs::from(&train), None)?;
    fit::write(&mut output, &loaded.model, &fit, fit::speeds(Ranks::one(), Runs::from(&train)))?;
    let baseline = evaluate::baseline(&loaded, None)?;
    let evaluation = evaluate::judge(&loaded, &baseline, &fit.model, &test)?;
    let integration = loaded.fit_settings()?.integration;
    evaluate::write(&mut output, &evaluation, [&baseline, &fit.model], &test, integration)?;

    let turns = turning_circles(&mut output, &loaded, &fit.model)?;
    let (dir, model) = (args.out.display(), args.out.join("results/fitted.toml"));
    let (study, model) = (study.display(), model.display());
    let text = format!(
        "Wrote an example study to {dir} ({written} files): {} and 40 recordings of 4 minutes.\n\n\
         1. Fitted the model to {} runs, from the paper's initial guess\n\n{}\n\n{}\n\n\
         2. Judged it on the {} test runs\n\n{}{turns}\n\
         Look at {dir}/results: tracks.png, curves.png, improvement.png, turning.png, fit.txt\n\
         Try next:\n  \
         trimtab check {study}\n  \
         trimtab maneuver zigzag {study} --model {model} --out {dir}/zigzag\n  \
         trimtab terms\n\
         For your own ship copy {dir} and replace ship.toml, runs.csv and the recordings.",
        fit.model.ship.name,
        train.len(),
        fit.brief(),
        parameters(&fit),
        test.len(),
        evaluate::text(&loaded.study.name, &evaluation),
    );
    output.finish(&text, &Report { folder: &args.out, fit: &fit, evaluation: &evaluation })?;
    Ok(if fit.converged { Answer::Yes } else { Answer::No })
}

/// Writes the example study, over one that nobody has edited; gives the number of files.
fn write_study(folder: &Path) -> Result<usize, CliError> {
    let files = demo::files();
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let mut study = ResultFolder::open(folder, "demo", &names)?;
    files.iter().try_for_each(|(name, text)| study.write(name, text.as_bytes()))?;
    study.complete(Origin { arguments: vec!["demo".to_owned()], ..Origin::default() })?;
    Ok(files.len())
}

/// The turning circles of the fitted ship as a section of the report, and their figure.
fn turning_circles(output: &mut Output, loaded: &Loaded, model: &Model) -> Result<String, CliError> {
    let settings = loaded.maneuver_settings()?;
    let (theta, ship) = (model.values(), &model.ship);
    // With a poor fit no propeller rate may hold the speed: the demo then has no turning circles.
    let Ok(approach) = settings.approach(model, &theta) else { return Ok(String::new()) };
    let trials = Side::BOTH.map(|side| turning_trial(model, &theta, &approach, side, settings.turning_angle()));
    output.figure("turning", || turning_figure(ship, &trials));
    let table = measures_table(ship, &trials);
    Ok(format!("\n\n3. Turning circles of the fitted ship at {:.0} m/s\n\n{table}\n", approach.speed))
}

/// The estimates as a short table; the whole report is in `fit.txt`.
fn parameters(fit: &Fit) -> Table {
    let mut table = Table::new(["parameter", "symbol", "unit", "start", "estimate", "95 % interval"]);
    for e in &fit.estimates {
        let range = match (e.interval, e.standard_error) {
            (_, Some(0.0)) => "held by constraints".into(),
            (Some([low, high]), _) => interval(low, high, 3),
            (None, _) => DASH.into(),
        };
        let row = [e.name.clone(), e.symbol.into(), e.unit.into(), sig(e.start, 4), sig(e.value, 4), range];
        table.row(row);
    }
    table
}
