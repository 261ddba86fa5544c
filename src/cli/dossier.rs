//! `trimtab dossier`: the validation dossier of a model on one page, in the order of ITTC 7.5-02-06-03.
//! The library computes what `evaluate`, `maneuver`, `diagnose` and `check` do; this file reads, calls and writes.

use super::diagnose::prepared;
use super::evaluate::{baseline, baseline_path};
use super::shared::answer::Answer;
use super::shared::audited::{AcceptArgs, audited};
use super::shared::error::CliError;
use super::shared::load::{Loaded, StudyArgs};
use super::shared::output::{Output, OutputArgs, Pruned};
use super::shared::progress::progress;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use trimtab::diagnose::{Settings, diagnose};
use trimtab::evaluate::Judging;
use trimtab::evaluate::maneuver::SEED;
use trimtab::files::{Manifest, settle, sha256_of};
use trimtab::recording::audit::{audit_model, audit_study};
use trimtab::recording::{Run, Split};
use trimtab::report::diagnosis::document;
use trimtab::report::dossier::content::{Question, dossier};
use trimtab::report::dossier::{page, summary};

const LONG: &str = "\
Puts on one page what a reviewer of a manoeuvring simulation model asks for, in the order of ITTC Recommended Procedure \
    7.5-02-06-03: claim and intended use; ship, sensors and clocks; inputs with checksums, version, seeds and build; the terms of the \
    model with their ranges of validity beside what the recordings visit; verification; errors on unseen runs and standard \
    manoeuvres with intervals; the study's own error rates; causes of error found, refuted and not excluded; known limits.

Errors, manoeuvres and causes are those of `trimtab evaluate`, `maneuver` and `diagnose` on the same study, to the last digit. \
    Verification is computed on this study's model and inputs: step size, derivatives, mirror symmetry, conservation of momentum and \
    energy, each with its limit. What was not computed is said to be missing.";

const AFTER: &str = "\
Example:
  trimtab dossier study.toml --model results/fitted.toml --use \"harbour approach in a training simulator\" --out dossier

With --out: dossier.html (one page, readable offline), dossier.json.
JSON: result.sections[] (key, title, missing[]) in their order, and a member of result for each key: claim, ship, inputs, model, \
    verification (checks[] with key, what, number, unit, at, limit, passed, runs), validation (test, groups[] and runs[] as \
    `trimtab evaluate` has them, manoeuvres with turning[] and zigzag[] as `trimtab maneuver` has them), error_rates and causes \
    (as `trimtab diagnose` has them), limits[].

Exit code 0 if the dossier was made and every check of the verification passed; 1 if a check failed; 2 if it could not be made.";

/// Makes the validation dossier of a model on one page
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// Model file of the baseline that the model is compared with.
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// The intended use of the model, in your words.
    #[arg(long = "use", value_name = "TEXT")]
    intended_use: Option<String>,
    /// diagnosis.json of an earlier `trimtab diagnose` on this study and model, instead of a new diagnosis.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["repeat", "once", "calibrate", "no_diagnosis"])]
    diagnosis: Option<PathBuf>,
    /// Makes no diagnosis; causes of error and error rates are then missing.
    #[arg(long, conflicts_with_all = ["repeat", "once", "calibrate"])]
    no_diagnosis: bool,
    /// Repeats the diagnosis on changed recordings, as `trimtab diagnose --repeat`.
    #[arg(long, conflicts_with = "once")]
    repeat: bool,
    /// Does not repeat the diagnosis, whatever the study says.
    #[arg(long)]
    once: bool,
    /// Simulated studies for the error rates, as for `trimtab diagnose`.
    #[arg(long, value_name = "N")]
    calibrate: Option<usize>,
    #[command(flatten)]
    accept: AcceptArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("dossier", &args.output)?;
    let loaded = Loaded::new(&args.study)?;
    let mut files = loaded.files(true);
    files.push(baseline_path(&loaded, args.baseline.as_ref())?);
    files.extend(args.diagnosis.iter().cloned());
    files.sort();
    files.dedup();
    output.reads_files(&files);
    let (fit, maneuver) =
        (loaded.fit_settings()?, loaded.maneuver_settings()?.of_recordings(&loaded.study, &loaded.model.ship));
    let judging = Judging::new(&fit, loaded.evaluation_settings()?);
    let settings = diagnosis_settings(&loaded, args)?;
    output.settings("fit", &fit)?;
    output.settings("evaluate", &judging.settings)?;
    output.settings("maneuver", &maneuver)?;
    output.settings("diagnose", &settings)?;
    let baseline = baseline(&loaded, args.baseline.as_ref())?;
    output.recordings(audited(&loaded, &args.accept)?);
    let mut audit = audit_study(&loaded.study, &loaded.model.ship);
    audit.issues.extend(audit_model(&loaded.model));
    let runs = loaded.windows()?.windows;
    let (model_file, uncertainty) = loaded.uncertainty()?;
    let diagnosis = match &args.diagnosis {
        Some(file) => Some((read(file, &loaded)?, source_of(file, &loaded)?)),
        None if args.no_diagnosis => None,
        None => made(&loaded, &runs, &settings)?,
    };
    let seed = diagnosis.as_ref().map(|(d, _)| d["settings"]["seed"].clone());
    let question = Question {
        study: &loaded.study.name,
        model: &loaded.model,
        baseline: &baseline,
        uncertainty: uncertainty.as_ref(),
        runs: &runs,
        audit: &audit,
        fit: &fit,
        judging: &judging,
        maneuver: &maneuver,
        diagnosis: diagnosis.as_ref().map(|(d, source)| (d, source.clone())),
        intended_use: args.intended_use.clone(),
        inputs: inputs(&output, &files, model_file, judging.settings.seed, seed),
    };
    let bar = progress("dossier");
    let made = dossier(&question, &|step| bar.set_message(format!("dossier: {step}")));
    bar.finish_and_clear();
    let document = serde_json::to_value(Pruned(&made))?;
    output.file("dossier.html", page(&document).render().as_bytes());
    output.finish(&summary(&made), &document)?;
    let passed = made.verification.checks.iter().all(|c| c.passed);
    Ok(if passed { Answer::Yes } else { Answer::No })
}

/// The settings of the diagnosis that is made here.
fn diagnosis_settings(loaded: &Loaded, args: &Args) -> Result<Settings, CliError> {
    let mut settings = prepared(loaded, loaded.diagnose_settings()?)?;
    settings.repeat = (settings.repeat || args.repeat) && !args.once;
    settings.calibrate = args.calibrate.unwrap_or(settings.calibrate);
    Ok(settings)
}

/// A diagnosis made here, as `trimtab diagnose` makes it; none without training runs.
fn made(loaded: &Loaded, runs: &[Run], settings: &Settings) -> Result<Option<(Value, String)>, CliError> {
    let (train, held_out): (Vec<Run>, Vec<Run>) = runs.iter().cloned().partition(|w| w.split == Split::Train);
    if train.is_empty() {
        return Ok(None);
    }
    let bar = progress("diagnosing");
    let show = |step: &str| bar.set_message(format!("diagnosing: {step}"));
    let diagnosis = diagnose(&loaded.model, train, &held_out, settings, &show);
    bar.finish_and_clear();
    let diagnosis = diagnosis.map_err(|error| CliError::Diagnose { path: loaded.study.path.clone(), error })?;
    Ok(Some((document(&diagnosis, &loaded.study.name)?, "made with this dossier".to_owned())))
}

/// The document of an earlier diagnosis of this study.
fn read(file: &Path, loaded: &Loaded) -> Result<Value, CliError> {
    let wrong = |what: String| CliError::Argument(format!("{}: {what} (--diagnosis)", file.display()));
    settle(file)?;
    let text = std::fs::read_to_string(file).map_err(|e| wrong(format!("cannot read ({e})")))?;
    let value: Value = serde_json::from_str(&text).map_err(|e| wrong(format!("it is not JSON: {e}")))?;
    if !value["schema"].as_str().is_some_and(|s| s.starts_with("trimtab-diagnosis/")) {
        return Err(wrong(
            "it is not a diagnosis; give the diagnosis.json that `trimtab diagnose --out` writes".into(),
        ));
    }
    if value["study"].as_str() != Some(&loaded.study.name) {
        let other = value["study"].as_str().unwrap_or("another study");
        return Err(wrong(format!("it is of the study `{other}`, not of `{}`", loaded.study.name)));
    }
    Ok(value)
}

/// Where a diagnosis is from, after a comparison of the files that it was made of with those of this study.
fn source_of(file: &Path, loaded: &Loaded) -> Result<String, CliError> {
    let folder = file.parent().unwrap_or(Path::new("."));
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let manifest = Manifest::read(folder).unwrap_or_default();
    let unverified = format!("{}; no manifest beside it says which files it was made of", file.display());
    let Some(entry) = manifest.results.get("diagnose").filter(|e| e.files.contains_key(name.as_ref())) else {
        return Ok(unverified);
    };
    let digest = |path: &Path| sha256_of(path).ok();
    let mut own: Vec<Option<String>> = loaded.files(true).iter().map(|p| digest(p)).collect();
    let mut its: Vec<Option<String>> = entry.inputs.iter().map(|i| i.sha256.clone()).collect();
    own.sort();
    its.sort();
    if own != its || entry.files.get(name.as_ref()) != digest(file).as_ref() {
        return Err(CliError::Argument(format!(
            "{}: it was made of other files than this study and model are now; diagnose again, or leave --diagnosis out",
            file.display()
        )));
    }
    Ok(format!("{}, made of the same files by trimtab {}", file.display(), entry.version))
}

/// Files, version, build and seeds.
fn inputs(output: &Output, files: &[PathBuf], model: &Path, bootstrap: u64, diagnosis: Option<Value>) -> Value {
    let file = |path: &PathBuf| json!({"path": path.display().to_string(), "sha256": sha256_of(path).ok()});
    let profile = if cfg!(debug_assertions) { "debug" } else { "release" };
    let processor = if cfg!(target_feature = "avx2") { "with AVX2" } else { "without AVX2" };
    let program = std::env::current_exe().ok().and_then(|path| sha256_of(&path).ok());
    json!({
        "command": output.provenance().command,
        "version": env!("CARGO_PKG_VERSION"),
        "build": {
            "target": format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
            "profile": profile,
            "processor": processor,
            "executable_sha256": program,
        },
        "seeds": {"bootstrap": bootstrap, "manoeuvres": SEED, "diagnosis": diagnosis},
        "model": model.display().to_string(),
        "files": files.iter().map(file).collect::<Vec<Value>>(),
    })
}
