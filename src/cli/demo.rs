//! `trimtab demo`: the whole mission on an embedded case, from recordings to the physics that the model lacks.
//! It calls the other commands' functions, and writes the study so that a user can repeat each command on it.

use super::diagnose::{continued, prepared, write_diagnosis};
use super::shared::answer::Answer;
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::lines::filled;
use super::shared::load::{Loaded, StudyArgs};
use super::shared::output::{Output, OutputArgs};
use super::shared::progress::progress;
use super::{evaluate, fit};
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use trimtab::diagnose::{Diagnosis, Grade, diagnose};
use trimtab::evaluate::{Estimate, Evaluation};
use trimtab::files::ranks::Ranks;
use trimtab::files::{Origin, ResultFolder};
use trimtab::fit::Fit;
use trimtab::numbers::numerals::{DASH, number_of, sig};
use trimtab::recording::audit::{Severity, audit_study};
use trimtab::recording::{Run, Runs, Split};
use trimtab::report::diagnosis::next_commands;
use trimtab::study::demo::{self, Concealed};

const LONG: &str = "\
Runs the whole job on a built-in case: forty recordings of a coastal container ship of 85 m, with the noise of ordinary \
    sensors, made by another simulator (MMG) under an effect that no file of the study names. The demo checks the recordings, fits \
    the model to 30 of the runs, judges the fit on the other 10, diagnoses which physics the model lacks, and then says what \
    was concealed and whether it was found. Study and results are written to the folder, ready to be copied.";

const AFTER: &str = "\
Example:
  trimtab demo --out tour
  trimtab maneuver turning tour/study.toml --model tour/results/improved.toml --out tour/turning

The study is written again only where its files are as trimtab wrote them. Exit code 1: the concealed effect was not found.

JSON: result.folder, result.check (runs, errors, warnings), result.fit (as of `trimtab fit`), result.evaluation (as of \
    `trimtab evaluate`), result.diagnosis (as of `trimtab diagnose`), result.concealed (effect, words, found, confirmed, and \
    sizes[] with parameter, concealed, estimate, ci95).";

/// Runs the whole job on a built-in case with a concealed effect
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// Folder for study and results; created if absent.
    #[arg(long, value_name = "DIR", default_value = "trimtab-demo")]
    out: PathBuf,
    #[command(flatten)]
    figures: FigureArgs,
    /// Print the result as one JSON object, and nothing else, to standard output.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    folder: &'a PathBuf,
    check: &'a Checked,
    fit: &'a Fit,
    evaluation: &'a Evaluation,
    diagnosis: &'a Value,
    concealed: &'a Revealed,
}

/// What the audit of the recordings counted.
#[derive(Serialize)]
struct Checked {
    runs: usize,
    errors: usize,
    warnings: usize,
}

/// The concealed effect beside what the diagnosis names.
#[derive(Serialize)]
struct Revealed {
    effect: String,
    words: String,
    found: bool,
    confirmed: bool,
    sizes: Vec<Size>,
}

#[derive(Serialize)]
struct Size {
    parameter: String,
    concealed: f64,
    estimate: Option<f64>,
    ci95: Option<[f64; 2]>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let study = args.out.join("study.toml");
    let results = OutputArgs { out: Some(args.out.join("results")), json: args.json, tables: Vec::new() };
    let mut output = Output::new("demo", &results)?.drawn_as(&args.figures);
    let files = write_study(&args.out)?;
    let loaded = Loaded::new(&StudyArgs { study: study.clone(), model: None })?;
    output.reads(&loaded, true);
    let baseline = evaluate::baseline(&loaded, None)?;
    output.reads_files(&[evaluate::baseline_path(&loaded, None)?]);
    output.settings("fit", &loaded.fit_settings()?)?;
    output.settings("evaluate", &loaded.evaluation_settings()?)?;

    let checked = check(&loaded);
    let (train, test) = (loaded.windows_of(Split::Train)?, loaded.windows_of(Split::Test)?);
    let fit = fit::fit_windows(Ranks::one(), &loaded, &loaded.model, Runs::from(&train), None)?;
    fit::write(&mut output, &loaded.model, &fit, fit::speeds(Ranks::one(), Runs::from(&train)))?;
    let evaluation = evaluate::judge(&loaded, &baseline, &fit.model, &test)?;
    let integration = loaded.fit_settings()?.integration;
    evaluate::write(&mut output, &evaluation, [&baseline, &fit.model], &test, integration)?;

    let diagnosis = diagnosed(&mut output, &loaded, train, &test)?;
    let document = write_diagnosis(&mut output, &diagnosis, &loaded.study.name)?;
    let revealed = reveal(demo::concealed()?, &diagnosis);
    let text = [
        format!("Wrote a study of {} recordings to {} ({files} files).", checked.runs, args.out.display()),
        section(1, "Checked the recordings", &checked.sentence()),
        section(2, "Fitted the model", &fit.brief()),
        section(3, "Judged the fit on runs it has not seen", &judged(&evaluation)),
        section(4, "Diagnosed what the model lacks", &diagnosis.headline),
        section(5, "Opened what was concealed", &revealed.sentence(&diagnosis)),
        next(&args.out),
    ];
    let report = Report {
        folder: &args.out,
        check: &checked,
        fit: &fit,
        evaluation: &evaluation,
        diagnosis: &document,
        concealed: &revealed,
    };
    output.finish(&text.join("\n\n"), &report)?;
    Ok(if fit.converged && revealed.found { Answer::Yes } else { Answer::No })
}

/// Writes the study, over one that nobody has edited; gives the number of files.
fn write_study(folder: &Path) -> Result<usize, CliError> {
    let files = demo::trials();
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let mut study = ResultFolder::open(folder, "demo", &names)?;
    files.iter().try_for_each(|(name, text)| study.write(name, text.as_bytes()))?;
    study.complete(Origin { arguments: vec!["demo".to_owned()], ..Origin::default() })?;
    Ok(files.len())
}

fn check(loaded: &Loaded) -> Checked {
    let bar = progress(format!("auditing {} recordings", loaded.study.runs.len()));
    let audit = audit_study(&loaded.study, &loaded.model.ship);
    bar.finish_and_clear();
    let issues = || audit.issues.iter().chain(audit.recordings.iter().flat_map(|a| &a.issues));
    let count = |severity: Severity| issues().filter(|i| i.severity == severity).count();
    Checked { runs: audit.recordings.len(), errors: count(Severity::Error), warnings: count(Severity::Warning) }
}

/// The diagnosis of the study's own model, as `trimtab diagnose` makes it.
fn diagnosed(output: &mut Output, loaded: &Loaded, train: Vec<Run>, test: &[Run]) -> Result<Diagnosis, CliError> {
    let settings = prepared(loaded, loaded.diagnose_settings()?)?;
    output.settings("diagnose", &settings)?;
    let bar = progress("diagnosing");
    let diagnosis =
        diagnose(&loaded.model, train, test, &settings, &|step| bar.set_message(format!("diagnosing: {step}")));
    bar.finish_and_clear();
    diagnosis.map_err(|error| CliError::Diagnose { path: loaded.study.path.clone(), error })
}

/// Sets the concealed effect beside the findings.
fn reveal(concealed: Concealed, diagnosis: &Diagnosis) -> Revealed {
    let finding = diagnosis.findings.iter().find(|f| concealed.accepted.contains(&f.mechanism));
    let size = |(parameter, value): (String, f64)| {
        let estimate = finding.and_then(|f| f.parameters.iter().find(|p| p.name == parameter));
        Size { parameter, concealed: value, estimate: estimate.map(|p| p.value), ci95: estimate.map(|p| p.ci95) }
    };
    Revealed {
        effect: concealed.effect,
        words: concealed.words,
        found: finding.is_some(),
        confirmed: finding.is_some_and(|f| f.grade == Grade::Confirmed),
        sizes: concealed.sizes.into_iter().map(size).collect(),
    }
}

impl Checked {
    fn sentence(&self) -> String {
        let Self { runs, errors, warnings } = self;
        let count = |n: &usize, what: &str| match n {
            0 => format!("no {what}"),
            1 => format!("1 {what}"),
            n => format!("{n} {what}s"),
        };
        format!("{runs} recordings: {}, {} (`trimtab check`).", count(errors, "error"), count(warnings, "warning"))
    }
}

impl Revealed {
    /// What was hidden, whether it was found, and how near its size is.
    fn sentence(&self, diagnosis: &Diagnosis) -> String {
        let hidden = format!("The recordings were made under {}, which no file of the study names.", self.words);
        let others = diagnosis.findings.len() - usize::from(self.found);
        let verdict = match (self.found, self.confirmed) {
            (true, true) => "The diagnosis found it, and unseen runs confirm it",
            (true, false) => "The diagnosis found it, but only suspects it",
            (false, _) => "The diagnosis did not find it",
        };
        let others =
            if others > 0 { format!("; it names {others} more, which nobody concealed") } else { String::new() };
        let sizes = self.sizes.iter().map(|s| match (s.estimate, s.ci95) {
            (Some(estimate), Some([low, high])) => format!(
                "\n  {}: {} concealed, {} found ({} to {})",
                s.parameter,
                sig(s.concealed, 3),
                sig(estimate, 3),
                sig(low, 3),
                sig(high, 3)
            ),
            _ => format!("\n  {}: {} concealed, not estimated", s.parameter, sig(s.concealed, 3)),
        });
        format!("{hidden}\n{verdict}{others}.{}", sizes.collect::<String>())
    }
}

fn section(number: usize, title: &str, text: &str) -> String {
    let lines: String =
        text.lines().map(|line| if line.starts_with(' ') { format!("{line}\n") } else { filled(line, 0) }).collect();
    format!("{number}. {title}\n\n{}", lines.trim_end())
}

fn judged(evaluation: &Evaluation) -> String {
    let Some(test) = evaluation.summary("test") else { return "There is no test run.".to_owned() };
    let percent = |cvdm: Option<Estimate>| cvdm.map_or_else(|| DASH.to_owned(), |e| sig(e.value, 3));
    format!(
        "cVDM (mean deviation from the recording, in % of the motion) on {}: {} % with the published parameters, {} % \
         fitted; better on {}, worse on {}.",
        number_of(test.runs, "test run"),
        percent(test.cvdm_baseline),
        percent(test.cvdm_fitted),
        test.runs_better,
        test.runs_worse
    )
}

fn next(folder: &Path) -> String {
    let dir = folder.display();
    let [compare, turning] =
        next_commands(&folder.join("study.toml"), &folder.join("results"), &[]).map(|c| continued(&c));
    format!(
        "Read {dir}/results/report.html first: the diagnosis on one page.\nTry next:\n  \
         trimtab check {dir}/study.toml\n  \
         trimtab diagnose {dir}/study.toml\n  \
         {compare}\n  \
         {turning}\n  \
         trimtab help tutorial\n\
         For your own ship copy {dir} and replace ship.toml, runs.csv and the recordings."
    )
}
