//! Runs cases from plan to row: make and seal, diagnose in a process of its own, open the seal.
//! What a row is worth is the summary's.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use super::answers::row::Row;
use super::answers::said::Said;
use super::error::InjectedError;
use super::plan::{Kind, Planned};
use super::seal;
use crate::process::{self, Ended};
use crate::rivals::{Content, Refit, sparse_regression};
use crate::workers;
use trimtab::files::file_name;

/// How cases are run.
#[derive(Debug, Clone)]
pub struct Runner {
    /// The program that diagnoses, called as `TOOL --threads 1 diagnose STUDY --json`.
    pub tool: PathBuf,
    /// Longest time for one diagnosis.
    pub limit: Duration,
    /// Folder for the cases while they run.
    pub folder: PathBuf,
    /// Keep them.
    pub keep: bool,
    /// Ask the rivals too, where nothing or one effect of full strength is injected.
    pub rivals: bool,
    /// Run sparse regression too, with this Python.
    pub sindy: Option<PathBuf>,
}

impl Runner {
    /// Runs cases, `workers` at a time, and hands out each row as it comes, in no fixed order.
    ///
    /// # Errors
    /// No program, no recordings, or an error of `each`; a case that fails otherwise is a row with its error.
    pub fn all(
        &self,
        cases: &[Planned],
        workers: usize,
        each: &(dyn Fn(Row) -> Result<(), InjectedError> + Sync),
    ) -> Result<(), InjectedError> {
        process::is_there(&self.tool)?;
        for case in cases {
            case.configuration.set.folder()?;
        }
        workers::each(cases, workers, &|case| each(self.one(case)?))
    }

    /// One case from plan to row.
    ///
    /// # Errors
    /// [`InjectedError`] if the case cannot be made, the program cannot be started, or the seal is broken.
    pub fn one(&self, case: &Planned) -> Result<Row, InjectedError> {
        let folder = self.folder.join(file_name(&case.key));
        // What a killed call left there.
        let _ = std::fs::remove_dir_all(&folder);
        let study = case.make(&folder)?;
        let mut row = Row::planned(case);
        let improved = (case.kind == Kind::Again).then(|| folder.join("out"));
        let said = row.add_answer(&self.diagnose(case, &study, improved.as_deref(), None)?);
        if let (Some(said), Some(out)) = (said, improved) {
            row.again = self.again(case, &study, &said, &out)?;
        }
        if self.rivals && case.suits_rivals() {
            let refit = Content::read(&study).and_then(|content| Refit::new(&study, &content));
            let sindy = self.sindy.as_ref().map(|python| sparse_regression(python, &folder, self.limit));
            row.add_rivals(refit, sindy);
        }
        row.add_truth(&seal::open(&folder)?);
        if !self.keep {
            // A folder that cannot be removed is removed by the next call.
            let _ = std::fs::remove_dir_all(&folder);
        }
        Ok(row)
    }

    fn diagnose(
        &self,
        case: &Planned,
        study: &Path,
        out: Option<&Path>,
        model: Option<&Path>,
    ) -> Result<Ended, InjectedError> {
        let mut command = Command::new(&self.tool);
        // The repetitions would take seven times as long, and what is stable is asked by cases of its own.
        command
            .arg("--threads")
            .arg(case.configuration.threads.to_string())
            .arg("diagnose")
            .arg(study)
            .args(["--json", "--once"]);
        if let Some(out) = out {
            command.arg("--out").arg(out);
        }
        if let Some(model) = model {
            command.arg("--model").arg(model);
        }
        process::run(command, self.limit).map_err(|source| InjectedError::file(&self.tool, source))
    }

    /// The names in the diagnosis of the improved model; blank if there are none, `-` if there is no improved model or it is the base
    /// model.
    fn again(&self, case: &Planned, study: &Path, said: &Said, out: &Path) -> Result<String, InjectedError> {
        let model = out.join("improved.toml");
        if said.findings.is_empty() || said.improved_is_base || !model.is_file() {
            return Ok("-".to_owned());
        }
        let ended = self.diagnose(case, study, None, Some(&model))?;
        Ok(match Said::read(&ended.output) {
            Ok(said) => said.findings.iter().map(|f| f.mechanism.as_str()).collect::<Vec<_>>().join("+"),
            Err(why) => format!("({why})").replace('+', " "),
        })
    }
}
