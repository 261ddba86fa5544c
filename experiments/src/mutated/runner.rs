//! Runs every command on every changed study, each as a process of its own, and hands out the rows.
//! What is right is judged in `row`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::Value;

use super::answer::{Answer, told};
use super::files::{Files, sound, write};
use super::plan::Planned;
use super::row::Row;
use crate::conceal::error::ConcealError;
use crate::process::{self, Ended};
use crate::workers;

/// The commands; the last one takes longest.
const COMMANDS: [&str; 5] = ["simulate", "fit", "evaluate", "maneuver", "diagnose"];

/// Seed of the sound study.
const STUDY: u64 = 7;

/// How changed studies are run.
pub struct Runner {
    tool: PathBuf,
    limit: Duration,
    folder: PathBuf,
    sound: Files,
    answers: BTreeMap<&'static str, Answer>,
}

impl Runner {
    /// Makes the sound study in a folder, fits it, and asks every command about it.
    ///
    /// # Errors
    /// [`ConcealError`] if the study cannot be made or a command refuses it.
    pub fn new(tool: PathBuf, limit: Duration, folder: PathBuf) -> Result<Self, ConcealError> {
        process::is_there(&tool)?;
        let files = sound(STUDY, &folder.join("case"))?;
        let mut runner = Self { tool, limit, folder, sound: files, answers: BTreeMap::new() };
        let study = runner.folder.join("sound");
        let io = |source| ConcealError::file(&study, source);
        write(&runner.sound, &study).map_err(io)?;
        // The fitted model belongs to the study: evaluate and maneuver read it.
        let mut fit = runner.command(&study, "fit");
        fit.arg("--out").arg(study.join("fit"));
        process::run(fit, limit).map_err(|source| ConcealError::file(&runner.tool, source))?;
        let fitted = std::fs::read(study.join("fit/fitted.toml")).map_err(io)?;
        runner.sound.insert("fitted.toml".to_owned(), fitted);
        write(&runner.sound, &study).map_err(io)?;
        for command in COMMANDS {
            let (ended, answer) = runner.ask(&study, command, 0.0)?;
            let Some(answer) = answer else {
                let message = format!("{command} refuses the sound study: {}", ended.messages.trim());
                return Err(ConcealError::content(&study, &message));
            };
            runner.answers.insert(command, answer);
        }
        Ok(runner)
    }

    /// Runs cases, `workers` at a time, and hands out the rows of each as they come, in no fixed order.
    ///
    /// # Errors
    /// A folder that cannot be written, a program that cannot be started, or an error of `each`.
    pub fn all(
        &self,
        cases: &[Planned],
        workers: usize,
        each: &(dyn Fn(Vec<Row>) -> Result<(), ConcealError> + Sync),
    ) -> Result<(), ConcealError> {
        workers::each(cases, workers, &|planned| each(self.one(planned)?))
    }

    /// The sound study's files.
    pub fn sound(&self) -> &Files {
        &self.sound
    }

    /// The folder of the sound study.
    pub(super) fn sound_folder(&self) -> PathBuf {
        self.folder.join("sound")
    }

    /// The folder for a changed study.
    pub(super) fn folder_of(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// How a command on the study in a folder ended, and all that it said.
    pub(super) fn text(&self, folder: &Path, command: &str) -> Result<(Ended, String), ConcealError> {
        let ended = process::run(self.command(folder, command), self.limit)
            .map_err(|source| ConcealError::file(&self.tool, source))?;
        let text = format!("{}{}", ended.messages, ended.output);
        Ok((ended, text))
    }

    /// By how many of its standard errors the estimate that moved most moved from that of the sound study; `None` without a fit.
    pub(super) fn fit_moved(&self, folder: &Path) -> Result<Option<f64>, ConcealError> {
        let (_, answer) = self.ask(folder, "fit", f64::INFINITY)?;
        Ok(answer.map(|answer| answer.moved(&self.answers["fit"])))
    }

    /// The rows of one case.
    ///
    /// # Errors
    /// As [`Self::all`].
    pub fn one(&self, planned: &Planned) -> Result<Vec<Row>, ConcealError> {
        let folder = self.folder.join(planned.case.to_string());
        let (files, what) = planned.changed(&self.sound);
        write(&files, &folder).map_err(|source| ConcealError::file(&folder, source))?;
        let asked = COMMANDS.iter().filter(|command| planned.diagnosed || **command != "diagnose");
        let rows = asked.map(|command| {
            let (ended, answer) = self.ask(&folder, command, planned.class.limit())?;
            Ok(Row::new(planned, &what, command, &ended, answer.as_ref(), &self.answers[command]))
        });
        let rows = rows.collect();
        // A folder that cannot be removed is written anew by the next call.
        let _ = std::fs::remove_dir_all(&folder);
        rows
    }

    /// A command on the study in a folder.
    fn command(&self, folder: &Path, command: &str) -> Command {
        let mut asked = Command::new(&self.tool);
        asked.args(["--threads", "1", command]);
        if command == "maneuver" {
            asked.arg("turning");
        }
        asked.arg(folder.join("study.toml"));
        match command {
            "evaluate" => drop(asked.arg("--model").arg(folder.join("fitted.toml"))),
            // The draws for the intervals would take sixty times as long.
            "maneuver" => drop(asked.arg("--model").arg(folder.join("fitted.toml")).args(["--draws", "0"])),
            // The repetitions would take seven times as long.
            "diagnose" => drop(asked.arg("--once")),
            _ => {}
        }
        asked
    }

    /// What became of a command on the study in a folder, and what it answered, if it did: the numbers from its JSON, and where they
    /// differ from the sound answer by more than `limit` standard errors the warnings in its text.
    fn ask(&self, folder: &Path, command: &'static str, limit: f64) -> Result<(Ended, Option<Answer>), ConcealError> {
        let run = |command| process::run(command, self.limit).map_err(|source| ConcealError::file(&self.tool, source));
        let mut asked = self.command(folder, command);
        asked.arg("--json");
        let ended = run(asked)?;
        let json = serde_json::from_str::<Value>(&ended.output).ok().filter(|_| matches!(ended.code, Some(0 | 1)));
        let Some(mut answer) = json.map(|json| Answer::new(command, &json)) else { return Ok((ended, None)) };
        if self.answers.get(command).is_none_or(|sound| answer.moved(sound) > limit) {
            let said = run(self.command(folder, command))?;
            answer.told = told(&format!("{}{}", said.messages, said.output));
        }
        Ok((ended, Some(answer)))
    }
}
