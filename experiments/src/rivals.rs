//! Rival methods on the study of a case: what a user would do otherwise. They read what the diagnosis read, and no seal; which answer of
//! theirs is right is judged elsewhere.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use trimtab::diagnose::Settings;
use trimtab::diagnose::proof::baseline::Refitted;
use trimtab::evaluate::{EvaluationSettings, Judging};
use trimtab::files::written::Mistake;
use trimtab::fit::FitSettings;
use trimtab::model::Model;
use trimtab::recording::{Run, Split};
use trimtab::study::Study;

use crate::conceal::error::ConcealError;
use crate::process;

/// The script of sparse regression.
const SINDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/peers/sindy.py");

/// What a rival answers where it names no mechanism.
pub const NOTHING: &str = "nothing";

/// A study as the rivals read it.
pub struct Content {
    /// The base model.
    pub model: Model,
    /// Runs for training.
    pub train: Vec<Run>,
    /// Unseen runs.
    pub held_out: Vec<Run>,
    /// The settings of a diagnosis, which judges predictions as the study says.
    pub settings: Settings,
}

impl Content {
    /// Reads a study.
    ///
    /// # Errors
    /// [`ConcealError::Content`] when the library refuses it.
    pub fn read(study: &Path) -> Result<Self, ConcealError> {
        let fail = |e: &dyn std::fmt::Display| ConcealError::content(study, e);
        let content = Study::read(study).map_err(|e| fail(&e))?;
        let ship = content.read_ship().map_err(|e| fail(&e))?;
        let model = Model::read(&content.model, ship).map_err(|e| fail(&e))?;
        let windows = content.windows(model.ship.hull.draught).map_err(|e| fail(&e))?.windows;
        let (train, held_out) = windows.into_iter().partition(|w| w.split == Split::Train);
        let mistaken = |all: Vec<Mistake>| fail(&all.into_iter().map(|m| m.message).collect::<Vec<_>>().join("; "));
        let fit: FitSettings = content.section("fit").map_err(mistaken)?;
        let evaluation: EvaluationSettings = content.section("evaluate").map_err(mistaken)?;
        let settings = Settings { judging: Judging::new(&fit, evaluation), ..Settings::default() };
        Ok(Self { model, train, held_out, settings })
    }
}

/// The refit of whole trajectories, and the mechanism that the Bayesian information criterion takes from what it leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct Refit {
    /// Mean cVDM of unseen runs \[%\], where there are any.
    pub held_out: Option<f64>,
    /// The mechanism; [`NOTHING`] when none lowers the criterion.
    pub bic: String,
}

impl Refit {
    /// Refits the free parameters of a study's model; `None` where the model as given runs away.
    ///
    /// # Errors
    /// [`ConcealError::Content`] when the library refuses the study.
    pub fn new(study: &Path, content: &Content) -> Result<Option<Self>, ConcealError> {
        let Content { model, train, held_out, settings } = content;
        let refitted = Refitted::new(model, train, settings).map_err(|e| ConcealError::content(study, &e))?;
        Ok(refitted.map(|refitted| {
            let ranking = refitted.ranking(train, &settings.withhold);
            let best = ranking.first().filter(|best| best.gain > 0.0);
            Self {
                held_out: (!held_out.is_empty()).then(|| refitted.held_out(held_out, &settings.judging)),
                bic: best.map_or(NOTHING, |b| b.mechanism.as_str()).to_owned(),
            }
        }))
    }
}

/// The mechanism that sparse regression names on the study in a case's folder, by a Python that has `PySINDy`.
///
/// # Errors
/// [`ConcealError::Content`] with the script's last message.
pub fn sparse_regression(python: &Path, folder: &Path, limit: Duration) -> Result<String, ConcealError> {
    // Otherwise numerical libraries start one thread a processor for each worker.
    let mut command = Command::new(python);
    command.arg(SINDY).arg(folder).env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1");
    let said = process::answer(command, python, limit)?.output;
    Ok(said.lines().last().unwrap_or_default().trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::case::Case;
    use crate::conceal::family::Family;
    use crate::conceal::spec::{Spec, Strength};
    use crate::conceal::strength::ForceMeter;

    #[test]
    fn a_refit_predicts_unseen_runs_and_its_residuals_name_a_mechanism_where_a_strong_one_is_concealed() {
        let folder = tempfile::tempdir().unwrap();
        let effects = vec![("current".to_owned(), Strength::Times(2.0))];
        let spec = Spec { effects, ..Spec::null(Family::Hd, 12) };
        let study = Case::make(&spec, &ForceMeter::default()).unwrap().write(folder.path()).unwrap();
        let mut content = Content::read(&study).unwrap();
        assert!(!content.train.is_empty() && !content.held_out.is_empty());
        let of = |content: &Content| Refit::new(&study, content).unwrap().unwrap();
        let said = of(&content);
        assert!(said.held_out.is_some_and(|cvdm| cvdm > 0.0) && said.bic != NOTHING);
        content.held_out.clear();
        assert_eq!(of(&content), Refit { held_out: None, ..said });
    }

    #[test]
    fn the_last_line_of_the_script_is_its_answer_and_its_failure_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let python = folder.path().join("python");
        std::fs::write(&python, "#!/bin/sh\necho first; echo current; exit $(basename $2)\n").unwrap();
        let mut mode = std::fs::metadata(&python).unwrap().permissions();
        std::os::unix::fs::PermissionsExt::set_mode(&mut mode, 0o755);
        std::fs::set_permissions(&python, mode).unwrap();
        let of = |code: &str| sparse_regression(&python, Path::new(code), Duration::from_secs(20));
        assert_eq!(of("0").unwrap(), "current");
        assert!(of("2").is_err());
    }
}
