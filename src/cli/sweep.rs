//! `trimtab sweep`: what the recordings of a study determine of its model's parameters.
//! The library fits; this file reads the arguments, prints and writes files.

use super::fit::fit_windows;
use super::shared::answer::Answer;
use super::shared::audited::{AcceptArgs, audited};
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::load::{Loaded, StudyArgs};
use super::shared::output::{Output, OutputArgs, csv_text};
use super::shared::progress::progress;
use serde::Serialize;
use trimtab::evaluate::sweep::{Pair, Profile, Sensitivity, SweepSettings, pair, profile, sensitivities};
use trimtab::files::ranks::Ranks;
use trimtab::fit::Fit;
use trimtab::numbers::statistics::student_quantile;
use trimtab::recording::{Runs, Split};
use trimtab::report::Table;
use trimtab::report::sweep::{
    pairs_figure, pairs_table, points_table, profiles_figure, profiles_table, sensitivities_table,
};

const LONG: &str = "\
Fits the model to the training runs, and then asks what these runs determine: each parameter is fixed at values around its \
    estimate and all others are fitted again (the profile of the likelihood), and each is moved by its standard error to see what \
    that does to the tracks and to the standard trials in calm water.

A parameter whose profile stays below the 95 % line is not determined: fix it, give it a prior (`prior = \"default\"`), or record \
    runs that show it (`trimtab plan`). Two whose pair has a long valley cannot be distinguished. Many starts: `trimtab fit --starts N`.";

const AFTER: &str = "\
Example:
  trimtab sweep study.toml --pair rudder.lift1,rudder.lift3 --out swept

With --out: sweep.json, profiles.csv (a row a value), intervals.csv, sensitivities.csv, pairs.csv, profiles.png, pairs.png, each figure \
    with its CSV.
JSON: result.fit (name of the model, cost, freedom), result.profiles[] with parameter, unit, estimate, standard_error, points[] (value, \
    fall), interval, better_elsewhere; result.pairs[] with parameters, values, fall; result.sensitivities[] with parameter, \
    standard_error, position [m], heading [rad], trials. The fall is twice that of the log-likelihood. A number that does not exist is \
    absent.";

/// Says what the recordings determine: profiles of the likelihood, and what each parameter moves
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// Profile only these parameters, by dotted name; every free one if not given.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    parameter: Vec<String>,
    /// Profile two parameters together; may be repeated.
    #[arg(long, value_name = "A,B")]
    pair: Vec<String>,
    /// Values on each side of an estimate.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u8).range(2..=50))]
    points: u8,
    /// Distance of the outermost values from the estimate, in standard errors, 0.1 to 20.
    #[arg(long, value_name = "S", default_value_t = 3.0)]
    span: f64,
    #[command(flatten)]
    accept: AcceptArgs,
    #[command(flatten)]
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Report<'a> {
    fit: Fitted<'a>,
    profiles: &'a [Profile],
    pairs: &'a [Pair],
    sensitivities: &'a [Sensitivity],
}

#[derive(Serialize)]
struct Fitted<'a> {
    model: &'a str,
    converged: bool,
    cost: f64,
    freedom: usize,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("sweep", &args.output)?.drawn_as(&args.figures);
    if !(0.1..=20.0).contains(&args.span) {
        return Err(CliError::Argument(format!("--span {}: give 0.1 to 20 standard errors", args.span)));
    }
    let settings = SweepSettings { points: args.points.into(), span: args.span };
    let loaded = Loaded::new(&args.study)?;
    let pairs = named_pairs(&loaded, &args.pair)?;
    let wanted = named(&loaded, &args.parameter)?;
    output.reads(&loaded, true);
    output.settings("fit", &loaded.fit_settings()?)?;
    output.settings("maneuver", &loaded.maneuver_settings()?)?;
    output.settings("sweep", &settings)?;
    output.recordings(audited(&loaded, &args.accept)?);
    let train = loaded.windows_of(Split::Train)?;
    let found = fit_windows(Ranks::one(), &loaded, &loaded.model, Runs::from(&train), None)?;
    let bar = progress("profiling");
    let chosen = found.estimates.iter().filter(|e| wanted.is_empty() || wanted.contains(&e.name));
    let profiles: Vec<Profile> = chosen
        .filter_map(|e| {
            bar.set_message(format!("profiling {}", e.name));
            profile(&found, &train, &e.name, &settings)
        })
        .collect();
    let pairs: Vec<Pair> = pairs
        .iter()
        .filter_map(|[a, b]| {
            bar.set_message(format!("profiling {a} and {b}"));
            pair(&found, &train, [a, b], &settings)
        })
        .collect();
    bar.set_message("moving each parameter");
    let moved = sensitivities(&found, &train, &loaded.maneuver_settings()?);
    bar.finish_and_clear();
    write(&mut output, &found, &profiles, &pairs, &moved)?;
    let fit = Fitted { model: &found.model.name, converged: found.converged, cost: found.cost, freedom: found.freedom };
    let report = Report { fit, profiles: &profiles, pairs: &pairs, sensitivities: &moved };
    output.finish(&text(&found, &profiles, &moved), &report)?;
    Ok(if found.converged { Answer::Yes } else { Answer::No })
}

/// Names of free parameters of the model, checked.
fn named(loaded: &Loaded, names: &[String]) -> Result<Vec<String>, CliError> {
    for name in names {
        let known = loaded.model.index(name).is_some_and(|i| loaded.model.parameters[i].free);
        if !known {
            let free: Vec<&str> = loaded.model.parameters.iter().filter(|p| p.free).map(|p| p.name.as_str()).collect();
            let free = free.join(", ");
            return Err(CliError::Argument(format!("`{name}` is no free parameter of the model; they are {free}")));
        }
    }
    Ok(names.to_vec())
}

fn named_pairs(loaded: &Loaded, pairs: &[String]) -> Result<Vec<[String; 2]>, CliError> {
    let two = |pair: &String| {
        let names: Vec<String> = pair.split(',').map(|n| n.trim().to_owned()).collect();
        match <[String; 2]>::try_from(named(loaded, &names)?) {
            Ok([a, b]) if a != b => Ok([a, b]),
            _ => Err(CliError::Argument(format!("--pair {pair}: give two parameters, as in `--pair a.b,c.d`"))),
        }
    };
    pairs.iter().map(two).collect()
}

fn write(
    output: &mut Output,
    found: &Fit,
    profiles: &[Profile],
    pairs: &[Pair],
    moved: &[Sensitivity],
) -> Result<(), CliError> {
    let tables = [
        ("profiles.csv", points_table(profiles)),
        ("intervals.csv", profiles_table(profiles)),
        ("sensitivities.csv", sensitivities_table(moved)),
    ];
    for (name, table) in tables {
        output.file(name, &csv(&table)?);
    }
    let limit = student_quantile(0.975, found.freedom.max(1) as f64).powi(2);
    if !profiles.is_empty() {
        output.figure("profile_curves", || profiles_figure(profiles, limit));
    }
    if !pairs.is_empty() {
        output.file("pairs.csv", &csv(&pairs_table(pairs))?);
        output.figure("pair_maps", || pairs_figure(pairs));
    }
    Ok(())
}

fn csv(table: &Table) -> Result<Vec<u8>, CliError> {
    let header: Vec<&str> = table.header().iter().map(String::as_str).collect();
    csv_text(&header, table.rows().iter().cloned())
}

fn text(found: &Fit, profiles: &[Profile], moved: &[Sensitivity]) -> String {
    let unknown: Vec<&str> =
        found.estimates.iter().filter(|e| e.standard_error.is_none()).map(|e| e.name.as_str()).collect();
    let fixed: Vec<&str> =
        found.estimates.iter().filter(|e| e.standard_error == Some(0.0)).map(|e| e.name.as_str()).collect();
    let list = |title: &str, names: &[&str]| {
        if names.is_empty() { String::new() } else { format!("\n{title}: {}", names.join(", ")) }
    };
    format!(
        "{}\n\nProfiles of the likelihood\n\n{}{}{}\n\nWhat one standard error of each parameter moves: tracks of the training runs, trials in \
         calm water\n\n{}",
        found.headline,
        profiles_table(profiles),
        list("Not determined by these data", &unknown),
        list("Fixed by constraints or bounds", &fixed),
        sensitivities_table(moved)
    )
}
