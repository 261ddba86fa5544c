//! `trimtab diagnose`: where the simulation differs from the recordings, which physics is missing, and the proof on unseen runs.
//! The library makes the diagnosis, its report and its figures; this file calls it, shows progress and writes files.

use super::fit::{fitted_text, model_text};
use super::shared::answer::Answer;
use super::shared::audited::{AcceptArgs, examined};
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::lines::{WIDTH, filled};
use super::shared::load::{Loaded, StudyArgs, no_mechanism};
use super::shared::output::{Output, OutputArgs, print, print_json};
use super::shared::progress::progress;
use serde_json::Value;
use trimtab::diagnose::answer::models::Whose;
use trimtab::diagnose::{Diagnosis, Settings, Verdict, diagnose};
use trimtab::evaluate::Judging;
use trimtab::physics::Catalogue;
use trimtab::recording::audit::Issue;
use trimtab::recording::{Run, Runs, Split};
use trimtab::report::diagnosis::{NEXT_WORDS, document, keys_listing, next_commands, page, pictures, summary};

const LONG: &str = "\
Compares the recordings of a study with its model in four steps:
  locates    in which equation, when, and in which region of state and inputs a force acts that
             the model lacks
  names      which mechanism of the catalogue explains the force, or which mechanisms these data
             do not distinguish
  models     adds the mechanism, with its size in physical units, and says which parameters had
             absorbed it
  proves     errors before and after on the test runs, which no earlier step has used
The verdict can also be: nothing is missing, only gusts act, a sensor or the integration step is
at fault, the catalogue has no such mechanism, or the recordings do not decide.

The training runs of the study locate, name and model; its test runs only prove. Settings are in
the table [diagnose] of the study: alpha (chance of naming anything when nothing is missing,
0.01), most (largest number of mechanisms, 3), withhold (mechanisms not to be considered),
nuisance (estimate unknown hull, propeller and rudder coefficients too, true), substeps (RK4 steps in a sample
period, 1), repeat (repeat the analysis on the recordings turned, mirrored, cut, thinned and with
other start values to see whether what is named is stable, false), calibrate (simulated studies for
the error rates of this study, 0), seed (of bootstrap and simulations).

Every finding has a grade. Confirmed: test runs are better with it, by log-likelihood or by free
simulation (interval above zero), not worse by the other, and, where the analysis is repeated, every
repetition finds it. Suspected: the training runs support it, test runs do not decide or there are none. What test runs refute, what
has zero in the interval of its size, what is too small to matter and what most repetitions do not find is
not named, and is listed with the reason. Without test runs every fourth recording is set aside for
the proof, from eight on.";

const EXAMPLE: &str = "\
Example:
  trimtab diagnose study.toml --out results
  trimtab evaluate study.toml --model results/improved.toml --baseline results/base.toml

With --out: report.html (everything on one page, readable offline), diagnosis.json,
improved.toml (a model file with the mechanisms found, which every command takes as --model),
base.toml (the study's model, refitted alike), figures/ with the CSV behind each and
figures.md with their captions. The answer then ends with the commands to run next: the comparison
of improved.toml with base.toml on every run, and a trial.

Exit code 0 if any verdict was reached; 1 if the recordings cannot answer (verdict
`insufficient`, or a fault in them that must be mended first or accepted); 2 if it could not run.

diagnosis.json (and --json), in SI units and radians; a number that does not exist or is not
finite is absent:
";

/// Names the physics a model lacks, adds it, and proves the gain on unseen runs
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = format!("{EXAMPLE}{}", keys_listing()))]
pub struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// A mechanism that must not be considered; may be given several times (see `trimtab terms`).
    #[arg(long, value_name = "NAME")]
    withhold: Vec<String>,
    /// Seed of the bootstrap, instead of the study's.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Repeats the analysis on the recordings turned, mirrored, cut, thinned and with other start values, to see whether what it names is
    /// stable: five to seven times as long.
    #[arg(long, conflicts_with = "once")]
    repeat: bool,
    /// Does not repeat the analysis, whatever the study says.
    #[arg(long)]
    once: bool,
    /// Analyses N simulated studies with nothing missing, and N with what was found, for the error rates of this study; each takes as
    /// long as one analysis.
    #[arg(long, value_name = "N")]
    calibrate: Option<usize>,
    #[command(flatten)]
    accept: AcceptArgs,
    #[command(flatten)]
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("diagnose", &args.output)?.drawn_as(&args.figures);
    let loaded = Loaded::new(&args.study)?;
    output.reads(&loaded, true);
    let settings = prepared(&loaded, settings(args, loaded.diagnose_settings()?, loaded.model.catalogue())?)?;
    let audited = examined(&loaded, &args.accept)?;
    output.recordings(audited.clone());
    output.settings("fit", &loaded.fit_settings()?)?;
    output.settings("evaluate", &loaded.evaluation_settings()?)?;
    output.settings("diagnose", &settings)?;
    let windows = loaded.windows()?.windows;
    let (train, held_out): (Vec<Run>, Vec<Run>) = windows.into_iter().partition(|w| w.split == Split::Train);
    if train.is_empty() {
        return Err(loaded.nothing(Split::Train));
    }
    loaded.compare_yaw_rates(Runs::from(&train));
    let bar = progress("diagnosing");
    let diagnosis =
        diagnose(&loaded.model, train, &held_out, &settings, &|step| bar.set_message(format!("diagnosing: {step}")));
    bar.finish_and_clear();
    let diagnosis = diagnosis.map_err(|error| CliError::Diagnose { path: loaded.study.path.clone(), error })?;

    let name = &loaded.study.name;
    let unanswered = diagnosis.verdict == Verdict::Insufficient
        || audited.refused()
        || diagnosis.admission.issues.iter().any(Issue::blocking);
    let next = args.output.out.as_ref().filter(|_| !unanswered);
    let next = next.map(|folder| Next(next_commands(&args.study.study, folder, args.accept.faults())));
    let mut json = document(&diagnosis, name)?;
    json["recordings"] = serde_json::to_value(&audited)?;
    if let Some(next) = &next {
        json["next_commands"] = serde_json::to_value(&next.0)?;
    }
    write_files(&mut output, &diagnosis, name, &json, next.as_ref())?;
    let written = output.close();
    let printed = if args.output.json {
        print_json(&json)
    } else {
        let where_to = match (&args.output.out, written.is_there()) {
            (None, _) => "\nGive --out DIR to keep the improved model, the figures and the report.\n".to_owned(),
            (Some(folder), true) => format!(
                "\nWritten to {}: report.html, diagnosis.json, improved.toml, base.toml, figures/\n{}",
                folder.display(),
                next.as_ref().map_or_else(String::new, Next::text)
            ),
            (Some(_), false) => String::new(),
        };
        print(&(audited.lines() + &audited.caution() + &summary(&diagnosis, name) + &where_to))
    };
    written.ended(printed)?;
    Ok(if unanswered { Answer::No } else { Answer::Yes })
}

/// What to run after a diagnosis.
struct Next([String; 2]);

impl Next {
    /// The sentence and the commands, which a shell takes in several lines.
    fn text(&self) -> String {
        let lines = self.0.iter().map(|command| format!("  {}\n", continued(command)));
        format!("\n{}{}", filled(NEXT_WORDS, 0), lines.collect::<String>())
    }
}

/// A command in lines of at most 80 characters, each but the last ended as a shell wants it; an option stays with its value.
pub fn continued(command: &str) -> String {
    let mut text = String::new();
    let mut column = 2;
    for (i, part) in command.split(" --").enumerate() {
        let part = if i == 0 { part.to_owned() } else { format!("--{part}") };
        let length = part.chars().count();
        if i > 0 && column + 1 + length + 2 > WIDTH {
            text += " \\\n      ";
            column = 6;
        } else if i > 0 {
            text.push(' ');
            column += 1;
        }
        text += &part;
        column += length;
    }
    text
}

/// Settings whose proof judges as the study's tables `[fit]` and `[evaluate]` say.
pub fn prepared(loaded: &Loaded, settings: Settings) -> Result<Settings, CliError> {
    let fit = loaded.fit_settings()?;
    let judging = Judging::new(&fit, loaded.evaluation_settings()?);
    Ok(Settings { judging, constraints: fit.constraints, ..settings })
}

/// Writes the files of a diagnosis, as this command has them, for another command; gives its document.
pub fn write_diagnosis(output: &mut Output, diagnosis: &Diagnosis, name: &str) -> Result<Value, CliError> {
    let json = document(diagnosis, name)?;
    write_files(output, diagnosis, name, &json, None)?;
    Ok(json)
}

fn write_files(
    output: &mut Output,
    diagnosis: &Diagnosis,
    name: &str,
    json: &Value,
    next: Option<&Next>,
) -> Result<(), CliError> {
    if output.has_folder() {
        output.file("diagnosis.json", (serde_json::to_string_pretty(json)? + "\n").as_bytes());
        let mut improved = diagnosis.model.clone();
        improved.name += if diagnosis.written == Whose::Own { "" } else { ", improved" };
        let improved = fitted_text(&improved, diagnosis.uncertainty.clone())?;
        let mut base = diagnosis.base.clone();
        base.name += ", refitted";
        output.file("improved.toml", improved.as_bytes());
        output.file("base.toml", model_text(&base)?.as_bytes());
        let (pictures, mut from) = (pictures(diagnosis), output.provenance());
        from.next = next.map(|next| (NEXT_WORDS.to_owned(), next.0.to_vec()));
        output.file("report.html", page(diagnosis, name, &pictures, &from)?.render().as_bytes());
        output.figures(
            pictures.into_iter().map(|p| (format!("figures/{}", p.stem), p.figure.caption(p.caption))).collect(),
        );
    }
    Ok(())
}

/// The study's settings, changed by the arguments, with every name that these withhold checked.
fn settings(args: &Args, mut settings: Settings, catalogue: &Catalogue) -> Result<Settings, CliError> {
    settings.seed = args.seed.unwrap_or(settings.seed);
    settings.repeat = (settings.repeat || args.repeat) && !args.once;
    settings.calibrate = args.calibrate.unwrap_or(settings.calibrate);
    match args.withhold.iter().find_map(|name| no_mechanism(name, catalogue)) {
        Some(message) => Err(CliError::Argument(format!("--withhold: {message}"))),
        None => {
            settings.withhold.extend(args.withhold.iter().cloned());
            Ok(settings)
        }
    }
}
