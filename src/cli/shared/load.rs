//! Reads what a command works on from a study's path: ship, model, settings and windows.
//! It checks and computes nothing beyond that.

use super::error::CliError;
use super::progress::progress;
use super::terminal::tell;
use super::unreached::unreached;
use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use trimtab::diagnose::Settings;
use trimtab::diagnose::plan::PlanSettings;
use trimtab::evaluate::EvaluationSettings;
use trimtab::evaluate::maneuver::ManeuverSettings;
use trimtab::files::ranks::Ranks;
use trimtab::files::{settle, suggestion};
use trimtab::fit::{FitError, FitSettings};
use trimtab::model::{Model, ModelError};
use trimtab::numbers::numerals::sig;
use trimtab::numbers::ranges::Limited;
use trimtab::numbers::uncertainty::Uncertainty;
use trimtab::physics::Catalogue;
use trimtab::recording::{ColumnMap, Run, Runs, Split, Windows};
use trimtab::report::diagnosis::mechanism_names;
use trimtab::ship::{Ship, parameter_line};
use trimtab::study::{Listed, Study, StudyError};
use trimtab::terms;

/// A largest yaw rate that is so many times the one recorded, or its inverse, was hardly meant: degrees for radians are 57 times.
const FAR_YAW_RATE: f64 = 20.0;

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

/// Arguments of the commands that need no recording.
#[derive(Clone, Debug, clap::Args)]
pub struct ShipArgs {
    /// The study: a TOML file that names ship and model; its recordings need not exist.
    #[arg(value_name = "STUDY", required_unless_present = "ship")]
    study: Option<PathBuf>,
    /// Ship file, where there is no study; needs --model.
    #[arg(long, value_name = "FILE", conflicts_with = "study", requires = "model")]
    ship: Option<PathBuf>,
    /// Model file, instead of the study's, such as the `fitted.toml` written by `trimtab fit --out`.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
}

impl ShipArgs {
    /// The study that `read` makes of its path, or one of ship and model alone.
    pub fn load(&self, read: impl Fn(&Path) -> Result<Study, StudyError>) -> Result<Loaded, CliError> {
        let (path, study) = match (&self.study, &self.ship, &self.model) {
            (Some(path), ..) => {
                settle(path)?;
                (path, read(path)?)
            }
            (None, Some(ship), Some(model)) => (ship, Study::of_ship(ship, model)?),
            _ => return Err(CliError::Argument("give a STUDY, or --ship and --model".into())),
        };
        Loaded::read(&StudyArgs { study: path.clone(), model: self.model.clone() }, study)
    }
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
    /// Reads study, ship, model, settings and column maps; what is wrong with any of them is reported at once.
    pub fn new(args: &StudyArgs) -> Result<Self, CliError> {
        settle(&args.study)?;
        let loaded = Self::read(args, Study::read(&args.study)?)?;
        for doubt in loaded.unreached() {
            tell(&format!("warning: {doubt}"));
        }
        Ok(loaded)
    }

    /// A study with its ship and model, or everything that is wrong with these and with the settings.
    pub fn read(args: &StudyArgs, study: Study) -> Result<Self, CliError> {
        let path = args.model.clone().unwrap_or_else(|| study.model.clone());
        let files = study.runs.iter().flat_map(|run| run.column_map.iter().chain([&run.file]));
        let folders: BTreeSet<&Path> = files.chain([&path, &study.ship]).filter_map(|file| file.parent()).collect();
        folders.into_iter().try_for_each(settle)?;
        let mut errors = Vec::new();
        let model = match study.read_ship() {
            Ok(ship) => read_model(&path, ship).map_err(|e| errors.push(in_ship_file(e, &study.ship))).ok(),
            Err(error) => {
                errors.push(error.into());
                // Without a ship there is no model, but its file may be read.
                errors.extend(Model::read_uncertainty(&path).err().map(|error| CliError::Model { path: None, error }));
                None
            }
        };
        let tables = [
            settings::<FitSettings>(&study, "fit").err(),
            settings::<EvaluationSettings>(&study, "evaluate").err(),
            diagnose_settings(&study, model.as_ref().map_or(terms::standard(), Model::catalogue)).err(),
            settings::<ManeuverSettings>(&study, "maneuver").err(),
            settings::<PlanSettings>(&study, "plan").err(),
        ];
        errors.extend(tables.into_iter().flatten());
        let unread = study.column_maps().into_iter().filter_map(|map| ColumnMap::read(map).err());
        errors.extend(unread.map(|error| CliError::Study(error.into())));
        match model.filter(|_| errors.is_empty()) {
            Some(model) => Ok(Self { study, model, model_path: path }),
            None => Err(CliError::all(errors)),
        }
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

    /// The warnings of what model and column maps say that no run reaches.
    pub fn unreached(&self) -> Vec<String> {
        unreached(&self.study, &self.model, &self.model_path)
    }

    /// The covariance of the model's parameters, where its file has one, and that file.
    pub fn uncertainty(&self) -> Result<(&Path, Option<Uncertainty>), CliError> {
        let path = self.model_path.as_path();
        let read = Model::read_uncertainty(path).map_err(|error| CliError::Model { path: None, error })?;
        Ok((path, read))
    }

    /// Another model of the same ship.
    pub fn other_model(&self, path: &Path) -> Result<Model, CliError> {
        settle(path)?;
        read_model(path, self.model.ship.clone())
    }

    /// The recordings, cut into windows.
    pub fn windows(&self) -> Result<Windows, CliError> {
        let bar = progress(format!("reading {} recordings", self.study.runs.len()));
        let windows = self.study.windows(self.model.ship.hull.draught);
        bar.finish_and_clear();
        Ok(windows?)
    }

    /// Warns of a largest yaw rate in the study that is far from all that were recorded in some runs.
    pub fn compare_yaw_rates(&self, runs: Runs<'_>) {
        if let Some(doubt) = self.yaw_rate_doubt(runs) {
            tell(&format!("warning: {doubt}"));
        }
    }

    /// The words of that warning; `None` where there is nothing to warn of.
    pub fn yaw_rate_doubt(&self, runs: Runs<'_>) -> Option<String> {
        self.study.fit.get("max_yaw_rate")?;
        let set = self.fit_settings().ok()?.max_yaw_rate;
        let largest = |run: &Run| run.measured.iter().filter_map(|m| m[5]).fold(0.0_f64, |most, r| most.max(r.abs()));
        let recorded = runs.iter().map(|run| largest(&run)).fold(0.0, f64::max);
        let times = set / recorded;
        if recorded == 0.0 || (1.0 / FAR_YAW_RATE..FAR_YAW_RATE).contains(&times) {
            return None;
        }
        let (path, line) = (self.study.path.display(), self.study.line_of("fit", "max_yaw_rate"));
        let (far, effect) = if times > 1.0 {
            (format!("{} times the largest", sig(times, 2)), "the yaw rate hardly counts in the cost")
        } else {
            (format!("1/{} of the largest", sig(1.0 / times, 2)), "the cost is of the yaw rate alone")
        };
        Some(format!(
            "{path}:{line}: [fit] `max_yaw_rate` = {} rad/s is {far} yaw rate recorded, {} rad/s, so that {effect}; it is in rad/s: \
             if deg/s are meant, write {}",
            sig(set, 3),
            sig(recorded, 3),
            sig(set.to_radians(), 3)
        ))
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

    /// An error of a fit, reported with the study file and the line of a constraint that cannot be imposed.
    pub fn of_fit(&self, error: FitError) -> CliError {
        let path = match &error {
            FitError::BadRule { rule, .. } => {
                format!("{}:{}", self.study.path.display(), self.study.line_of("fit.constraints", rule)).into()
            }
            _ => self.study.path.clone(),
        };
        CliError::Fit { path, error }
    }

    /// Table `[fit]`.
    pub fn fit_settings(&self) -> Result<FitSettings, CliError> {
        settings(&self.study, "fit")
    }

    /// Table `[evaluate]`.
    pub fn evaluation_settings(&self) -> Result<EvaluationSettings, CliError> {
        settings(&self.study, "evaluate")
    }

    /// Table `[diagnose]`.
    pub fn diagnose_settings(&self) -> Result<Settings, CliError> {
        diagnose_settings(&self.study, self.model.catalogue())
    }

    /// Table `[maneuver]`.
    pub fn maneuver_settings(&self) -> Result<ManeuverSettings, CliError> {
        settings(&self.study, "maneuver")
    }

    /// Table `[plan]`.
    pub fn plan_settings(&self) -> Result<PlanSettings, CliError> {
        settings(&self.study, "plan")
    }
}

/// A table of the study as settings, or all that is wrong with it.
fn settings<T: DeserializeOwned + Limited>(study: &Study, table: &'static str) -> Result<T, CliError> {
    let fail = |line, message| CliError::Table { path: study.path.clone(), line, table, message };
    let settings: T = study.section(table).map_err(|mistakes| {
        CliError::all(mistakes.into_iter().map(|mistake| fail(mistake.line, mistake.message)).collect())
    })?;
    settings.limits().map_err(|outside| fail(study.line_of(table, outside.key), outside.to_string()))?;
    Ok(settings)
}

/// Table `[diagnose]`, with every name that it withholds checked.
fn diagnose_settings(study: &Study, catalogue: &Catalogue) -> Result<Settings, CliError> {
    let read: Settings = settings(study, "diagnose")?;
    let fail = |message| CliError::Table {
        path: study.path.clone(),
        line: study.line_of("diagnose", "withhold"),
        table: "diagnose",
        message,
    };
    match read.withhold.iter().find_map(|name| no_mechanism(name, catalogue)) {
        Some(message) => Err(fail(message)),
        None => Ok(read),
    }
}

/// What is wrong with the name of a mechanism that is not to be considered in a model of these terms, if anything.
pub fn no_mechanism(name: &str, catalogue: &Catalogue) -> Option<String> {
    let known: Vec<&str> = mechanism_names(catalogue).collect();
    let message = || {
        let meant = suggestion(name, known.iter().copied());
        format!("there is no mechanism `{name}` to withhold{meant}; they are {}", known.join(", "))
    };
    (!known.contains(&name)).then(message)
}

/// An error that a model raises over its ship, reported with the ship file.
fn in_ship_file(error: CliError, ship: &Path) -> CliError {
    match error {
        CliError::Model { error: ModelError::ShipParameter { name, suggestion }, .. } => {
            let place = format!("{}:{}", ship.display(), parameter_line(ship, &name));
            CliError::Model { path: Some(place.into()), error: ModelError::ShipParameter { name, suggestion } }
        }
        other => other,
    }
}

pub(in crate::cli) fn read_model(path: &Path, ship: Ship) -> Result<Model, CliError> {
    Model::read(path, ship).map_err(|error| {
        // The texts of these two errors begin with the path.
        let named = matches!(error, ModelError::Read { .. } | ModelError::Parse { .. } | ModelError::Several(_));
        CliError::Model { path: (!named).then(|| path.to_owned()), error }
    })
}
