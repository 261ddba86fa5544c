//! The two real hulls: what their experiments share, from study files to fitted models and numbers to compare.
//! Recordings are read where their users keep them; only what is derived from them (errors, measures, pictures) is written.

pub mod diagnosis;
pub mod esso_osaka;
pub mod esso_osaka_diagnosed;
pub mod kinematics;
pub mod kvlcc2;
pub mod kvlcc2_diagnosed;
pub mod published;

use std::path::{Path, PathBuf};
use trimtab::fit::{Fit, FitSettings, fit};
use trimtab::model::{Model, ModelError};
use trimtab::recording::{Run, Split};
use trimtab::report::{Figure, FigureError, Table};
use trimtab::ship::{Ship, ShipError};
use trimtab::study::{Study, StudyError};

/// Why an experiment on a real hull could not run.
#[derive(Debug, thiserror::Error)]
pub enum RealError {
    /// The study or its recordings.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The ship file.
    #[error(transparent)]
    Ship(#[from] ShipError),
    /// A model file.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A table of the study.
    #[error("{path}: [{table}] {message}; correct the study", path = path.display())]
    Settings {
        /// The study.
        path: PathBuf,
        /// Its table.
        table: &'static str,
        /// What is wrong.
        message: String,
    },
    /// The fit.
    #[error(transparent)]
    Fit(#[from] trimtab::fit::FitError),
    /// A standard trial.
    #[error(transparent)]
    Maneuver(#[from] trimtab::maneuver::ManeuverError),
    /// The published parameters.
    #[error(transparent)]
    Published(#[from] published::PublishedError),
    /// A figure.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A file could not be written.
    #[error("{path}: cannot write ({source}); check that the folder exists and is writable", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// A study of a real hull with its ship and settings.
pub struct Hull {
    /// The study.
    pub study: Study,
    /// The ship.
    pub ship: Ship,
    /// Table `[fit]`.
    pub fit: FitSettings,
}

impl Hull {
    /// Opens the study `studies/NAME/study.toml`; the recordings are found as the study says.
    ///
    /// # Errors
    /// [`RealError`]; [`is_absent`] tells whether it is for want of the recordings.
    pub fn open(name: &str) -> Result<Self, RealError> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies").join(name).join("study.toml");
        let study = Study::read(&path)?;
        let ship = Ship::read(&study.ship)?;
        let fit = settings(&study, "fit", &study.fit)?;
        Ok(Self { study, ship, fit })
    }

    /// A model file that stands beside the study.
    ///
    /// # Errors
    /// [`RealError::Model`].
    pub fn model(&self, file: &str) -> Result<Model, RealError> {
        Ok(Model::read(&self.study.model.with_file_name(file), self.ship.clone())?)
    }

    /// The windows of one split.
    ///
    /// # Errors
    /// [`RealError::Study`].
    pub fn windows(&self, split: Split) -> Result<Vec<Run>, RealError> {
        let windows = self.study.windows(self.ship.hull.draught)?.windows;
        Ok(windows.into_iter().filter(|w| w.split == split).collect())
    }

    /// Fits a model to windows, with the settings of the study. A fit that did not converge says so in its name.
    ///
    /// # Errors
    /// [`RealError::Fit`].
    pub fn fitted(&self, model: &Model, windows: &[Run]) -> Result<Fit, RealError> {
        let mut fit = fit(model, windows, &self.fit, &mut |_| true)?;
        if !fit.converged {
            fit.model.name += " (not converged)";
        }
        Ok(fit)
    }
}

/// A table of a study as settings.
///
/// # Errors
/// [`RealError::Settings`].
pub fn settings<T: serde::de::DeserializeOwned>(
    study: &Study,
    name: &'static str,
    table: &toml::Table,
) -> Result<T, RealError> {
    table.clone().try_into().map_err(|e: toml::de::Error| RealError::Settings {
        path: study.path.clone(),
        table: name,
        message: e.message().trim().replace('\n', " "),
    })
}

/// Whether an experiment cannot run for want of the recordings, which are not part of the project.
pub fn is_absent(error: &RealError) -> bool {
    matches!(error, RealError::Study(StudyError::NoData { .. }))
}

/// The folder of the project's figures.
pub fn figures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../figures")
}

/// Writes a table as CSV.
///
/// # Errors
/// [`RealError::Write`].
pub fn write_csv(path: &Path, table: &Table) -> Result<(), RealError> {
    let quoted = |cell: &String| if cell.contains(',') { format!("\"{cell}\"") } else { cell.clone() };
    let line = |cells: &[String]| cells.iter().map(quoted).collect::<Vec<_>>().join(",") + "\n";
    let text = std::iter::once(line(table.header())).chain(table.rows().iter().map(|r| line(r))).collect::<String>();
    std::fs::write(path, text).map_err(|source| RealError::Write { path: path.to_owned(), source })
}

/// Writes a figure as PNG alone: the series behind it are recordings, which are not ours to pass on.
///
/// # Errors
/// [`RealError::Figure`] or [`RealError::Write`].
pub fn write_png(path: &Path, figure: &Figure) -> Result<(), RealError> {
    std::fs::write(path, figure.png()?).map_err(|source| RealError::Write { path: path.to_owned(), source })
}
