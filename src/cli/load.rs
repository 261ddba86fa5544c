//! Reads what a command works on from a study's path: ship, model, settings and windows.
//! It checks and computes nothing beyond that.

use super::error::CliError;
use super::progress::progress;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};
use trimtab::diagnose::Settings;
use trimtab::error::suggestion;
use trimtab::evaluate::EvaluationSettings;
use trimtab::fit::FitSettings;
use trimtab::maneuver::ManeuverSettings;
use trimtab::model::{Model, ModelError};
use trimtab::plan::PlanSettings;
use trimtab::ranges::Limited;
use trimtab::ranks::Ranks;
use trimtab::recording::{Run, Split, Windows};
use trimtab::ship::{Ship, parameter_line};
use trimtab::study::{Listed, Study};
use trimtab::uncertainty::Uncertainty;

/// Arguments of every command on a study.
#[derive(Clone, Debug, clap::Args)]
pub struct StudyArgs {
    /// The study: a TOML file that names ship, model and recordings.
    #[arg(value_name = "STUDY")]
    pub study: PathBuf,
    /// Model file to use instead of the study's, such as the `fitted.toml` written by `trimtab fit --out`.
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
}

/// A study with its ship and model.
pub struct Loaded {
    /// The study.
    pub study: Study,
    /// The model, with its ship.
    pub model: Model,
    /// The file that the model is from.
    model_path: PathBuf,
}

impl Loaded {
    /// Reads study, ship and model.
    pub fn new(args: &StudyArgs) -> Result<Self, CliError> {
        let study = Study::read(&args.study)?;
        let path = args.model.clone().unwrap_or_else(|| study.model.clone());
        let model = read_model(&path, Ship::read(&study.ship)?).map_err(|error| in_ship_file(error, &study.ship))?;
        Ok(Self { study, model, model_path: path })
    }

    /// The files that were read, and those of the recordings that are to be read if `recordings` says so.
    pub fn files(&self, recordings: bool) -> Vec<PathBuf> {
        let mut files = self.study.files();
        if recordings {
            files.extend(self.study.runs.iter().flat_map(|run| run.column_map.iter().chain([&run.file]).cloned()));
        }
        files.push(self.model_path.clone());
        files.sort();
        files.dedup();
        files
    }

    /// Reads study, ship and model, not the list of recordings, which need not exist.
    pub fn without_runs(args: &StudyArgs) -> Result<Self, CliError> {
        let study = Study::read_without_runs(&args.study)?;
        let path = args.model.clone().unwrap_or_else(|| study.model.clone());
        let model = read_model(&path, Ship::read(&study.ship)?).map_err(|error| in_ship_file(error, &study.ship))?;
        Ok(Self { study, model, model_path: path })
    }

    /// The covariance of the model's parameters, where its file has one, and that file.
    pub fn uncertainty(&self) -> Result<(&Path, Option<Uncertainty>), CliError> {
        let path = self.model_path.as_path();
        let read = Model::read_uncertainty(path).map_err(|error| CliError::Model { path: None, error })?;
        Ok((path, read))
    }

    /// Another model of the same ship.
    pub fn other_model(&self, path: &Path) -> Result<Model, CliError> {
        read_model(path, self.model.ship.clone())
    }

    /// The recordings, cut into windows.
    pub fn windows(&self) -> Result<Windows, CliError> {
        let bar = progress(format!("reading {} recordings", self.study.runs.len()));
        let windows = self.study.windows(self.model.ship.hull.draught);
        bar.finish_and_clear();
        Ok(windows?)
    }

    /// Reads the runs for which `wanted` says so and hands the windows of each to `work`, without keeping them; what `work`
    /// makes of them goes to `take` in the order listed.
    pub fn each<T: Send>(
        &self,
        doing: &str,
        wanted: impl Fn(&Listed) -> bool,
        work: impl Fn(Vec<Run>) -> T + Sync,
        mut take: impl FnMut(T) -> Result<(), CliError>,
    ) -> Result<(), CliError> {
        let (mut done, of) = (0, self.study.runs.iter().filter(|run| wanted(run)).count());
        let bar = progress(format!("{doing} {of} recordings"));
        let draught = self.model.ship.hull.draught;
        let result = self.study.each(
            draught,
            wanted,
            |windows| work(windows.windows),
            |one| {
                done += 1;
                bar.part(format!("{doing}: {done} of {of} recordings"), done, of);
                take(one)
            },
        );
        bar.finish_and_clear();
        result
    }

    /// The windows of one split, of which there must be some.
    pub fn windows_of(&self, split: Split) -> Result<Vec<Run>, CliError> {
        let mut windows = self.windows()?.windows;
        windows.retain(|w| w.split == split);
        if windows.is_empty() {
            return Err(self.nothing(split));
        }
        Ok(windows)
    }

    /// The same study with this rank's part of the runs for which `wanted` says so.
    pub fn part(&self, ranks: &Ranks, wanted: impl Fn(&Listed) -> bool) -> Self {
        let mut study = self.study.clone();
        study.runs.retain(wanted);
        study.runs = study.runs[ranks.share(study.runs.len())].to_vec();
        Self { study, model: self.model.clone(), model_path: self.model_path.clone() }
    }

    /// The error of a study without a run on one side of its split.
    pub fn nothing(&self, split: Split) -> CliError {
        let (word, verb) = match split {
            Split::Train => ("train", "fit to"),
            Split::Test => ("test", "judge by"),
        };
        CliError::Nothing {
            path: self.study.path.clone(),
            message: format!("there is no run to {verb}; mark one with `split = \"{word}\"`, or set a [split] rule"),
        }
    }

    /// Table `[fit]`.
    pub fn fit_settings(&self) -> Result<FitSettings, CliError> {
        self.table("fit", &self.study.fit)
    }

    /// Table `[evaluate]`.
    pub fn evaluation_settings(&self) -> Result<EvaluationSettings, CliError> {
        self.table("evaluate", &self.study.evaluate)
    }

    /// Table `[diagnose]`.
    pub fn diagnose_settings(&self) -> Result<Settings, CliError> {
        self.table("diagnose", &self.study.diagnose)
    }

    /// Table `[maneuver]`.
    pub fn maneuver_settings(&self) -> Result<ManeuverSettings, CliError> {
        self.table("maneuver", &self.study.maneuver)
    }

    /// Table `[plan]`.
    pub fn plan_settings(&self) -> Result<PlanSettings, CliError> {
        self.table("plan", &self.study.plan)
    }

    /// A table of the study as settings.
    fn table<T: DeserializeOwned + Limited>(&self, name: &'static str, table: &toml::Table) -> Result<T, CliError> {
        let settings: T = table.clone().try_into().map_err(|e: toml::de::Error| {
            let message = e.message().trim().replace('\n', " ");
            // serde writes: unknown field `found`, expected one of `a`, `b`
            let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
            let unknown = message.starts_with("unknown ");
            let (found, known) = quoted.split_first().map_or(("", &[][..]), |(f, k)| (*f, k));
            let near = if unknown { suggestion(found, known.iter().copied()) } else { String::new() };
            let key =
                if unknown { found } else { table.keys().find(|k| message.contains(*k)).map_or("", String::as_str) };
            CliError::Table {
                path: self.study.path.clone(),
                line: self.study.line_of(name, key),
                table: name,
                message: format!("{message}{near}"),
            }
        })?;
        settings.limits().map_err(|outside| CliError::Table {
            path: self.study.path.clone(),
            line: self.study.line_of(name, outside.key),
            table: name,
            message: outside.to_string(),
        })?;
        Ok(settings)
    }
}

/// An error that a model raises over its ship, told of the ship file.
fn in_ship_file(error: CliError, ship: &Path) -> CliError {
    match error {
        CliError::Model { error: ModelError::ShipParameter { name, suggestion }, .. } => {
            let place = format!("{}:{}", ship.display(), parameter_line(ship, &name));
            CliError::Model { path: Some(place.into()), error: ModelError::ShipParameter { name, suggestion } }
        }
        other => other,
    }
}

pub(super) fn read_model(path: &Path, ship: Ship) -> Result<Model, CliError> {
    Model::read(path, ship).map_err(|error| {
        // The texts of these two errors begin with the path.
        let named = matches!(error, ModelError::Read { .. } | ModelError::Parse { .. });
        CliError::Model { path: (!named).then(|| path.to_owned()), error }
    })
}
