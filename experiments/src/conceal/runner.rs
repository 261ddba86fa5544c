//! Runs cases from plan to score: conceal and seal, diagnose in a process of its own, open the seal, judge.
//! The plan lists the cases and the summary counts the scores; neither is here.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use trimtab::files::{file_name, write_whole};

use super::baselines::{self, Wanted};
use super::campaign::plan::Planned;
use super::case::Case;
use super::error::ConcealError;
use super::judge::rules::{baseline_right, judge};
use super::judge::said::Diagnosis;
use super::judge::score::Score;
use super::meter::DiagnosisMeter;
use super::seal;
use super::spec::Strength;
use super::strength::Meter;
use crate::process::{self, Ended};
use crate::{rivals, workers};

/// How cases are run.
#[derive(Debug, Clone)]
pub struct Runner {
    /// The program that diagnoses, called as `TOOL --threads 1 diagnose STUDY --json --once`.
    pub tool: PathBuf,
    /// Longest time for one diagnosis.
    pub limit: Duration,
    /// Folder for the cases while they run.
    pub folder: PathBuf,
    /// Keep them.
    pub keep: bool,
    /// Run the baselines too.
    pub baselines: bool,
    /// Run sparse regression too, with this Python.
    pub sindy: Option<PathBuf>,
}

impl Runner {
    /// Runs cases, `workers` at a time, and hands out each score as it comes, in no fixed order.
    ///
    /// # Errors
    /// No program, no meter, or an error of `each`; a case that fails is a score with its error.
    pub fn all(
        &self,
        plan: &[Planned],
        workers: usize,
        each: &(dyn Fn(Score) -> Result<(), ConcealError> + Sync),
    ) -> Result<(), ConcealError> {
        process::is_there(&self.tool)?;
        workers::each(plan, workers, &|planned| {
            // A meter of its own: a meter keeps its last fit, which two cases at a time would overwrite.
            let meter = DiagnosisMeter::new(planned.spec.family)?;
            each(self.one(planned, &meter))
        })
    }

    /// One case from plan to score; a failure becomes the row's error.
    pub fn one(&self, planned: &Planned, meter: &dyn Meter) -> Score {
        let folder = self.folder.join(file_name(&planned.key));
        // What a campaign that was killed left there is of no use to this one.
        let _ = std::fs::remove_dir_all(&folder);
        let outcome = self.attempt(planned, meter, &folder);
        if !self.keep {
            // A folder that cannot be removed is overwritten by the next call.
            let _ = std::fs::remove_dir_all(&folder);
        }
        let mut score = outcome.unwrap_or_else(|e| Score {
            family: planned.spec.family.name().to_owned(),
            effects: planned.spec.effects.iter().map(|e| e.0.as_str()).collect::<Vec<_>>().join("+"),
            background: planned.spec.background.name().to_owned(),
            design: planned.spec.design.name().to_owned(),
            contrast: planned.spec.contrast,
            seed: planned.spec.seed,
            error: e.to_string(),
            ..Score::default()
        });
        score.case.clone_from(&planned.key);
        score.arm = planned.arm.to_owned();
        score.snr_asked = planned.spec.effects.iter().find_map(|(_, s)| match s {
            Strength::Snr(snr) => Some(*snr),
            _ => None,
        });
        score
    }

    fn attempt(&self, planned: &Planned, meter: &dyn Meter, folder: &Path) -> Result<Score, ConcealError> {
        // Sealed before the diagnosis begins, opened after it has ended.
        let study = Case::make(&planned.spec, meter)?.write(folder)?;
        let answer = folder.join("diagnosis.json");
        let mut command = Command::new(&self.tool);
        command.args(["--threads", "1", "diagnose"]).arg(&study).args(["--json", "--once"]);
        let Ended { output, seconds, .. } = process::answer(command, &self.tool, self.limit)?;
        write_whole(&answer, output.as_bytes()).map_err(|source| ConcealError::file(&answer, source))?;
        let diagnosis = Diagnosis::read(&answer)?;
        let manifest = seal::open(folder)?;
        let mut score = judge(&manifest, &diagnosis);
        score.seconds = Some(seconds);
        let wanted = Wanted::on(planned);
        if self.baselines {
            baselines::ask(&study, &manifest, wanted)?.add_to(&mut score, &manifest);
        }
        if let Some(python) = self.sindy.as_ref().filter(|_| wanted.rivals) {
            score.sindy_named = rivals::sparse_regression(python, folder, self.limit)?;
            score.sindy_right = Some(baseline_right(&manifest, &score.sindy_named));
        }
        Ok(score)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_of_the_plan_has_a_folder_of_its_own() {
        let mut names = trimtab::files::Names::default();
        for planned in crate::conceal::campaign::plan::plan(1) {
            assert_eq!(names.take(&planned.key), file_name(&planned.key));
        }
    }

    #[test]
    fn a_case_that_cannot_be_diagnosed_is_a_score_with_its_error() {
        let folder = tempfile::tempdir().unwrap();
        let runner = Runner {
            tool: "false".into(),
            limit: Duration::from_secs(20),
            folder: folder.path().to_owned(),
            keep: false,
            baselines: false,
            sindy: None,
        };
        let plan = crate::conceal::campaign::plan::plan(1);
        let score = runner.one(&plan[0], &crate::conceal::strength::ForceMeter::default());
        assert_eq!((score.case.as_str(), score.arm.as_str(), score.detected), (plan[0].key.as_str(), "null", None));
        assert!(score.error.contains("diagnosis.json"), "{}", score.error);
        // The folder of the case is removed, and without a program no case is begun.
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let missing = Runner { tool: folder.path().join("none"), ..runner };
        assert!(missing.all(&plan[..1], 1, &|_| Ok(())).is_err());
    }
}
