//! A real hull: its study, ship and fit settings, and fits of its models.
//! Recordings are read from the user's folder; none is copied.

use std::path::Path;

use trimtab::evaluate::outcome;
use trimtab::fit::{Fit, FitSettings, fit};
use trimtab::model::Model;
use trimtab::recording::{Run, Split};
use trimtab::ship::Ship;
use trimtab::simulate::Trajectory;
use trimtab::study::Study;

use super::error::RealError;

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
    /// [`RealError`]; [`super::error::is_absent`] is true if the recordings are absent.
    pub fn open(name: &str) -> Result<Self, RealError> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies").join(name).join("study.toml");
        let study = Study::read(&path)?;
        let ship = study.read_ship()?;
        let fit = settings(&study, "fit", &study.fit)?;
        Ok(Self { study, ship, fit })
    }

    /// A model file in the folder of the study.
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

    /// cVDM of a prediction of a window \[%\]; infinite where it diverges.
    pub fn cvdm(&self, window: &Run, predicted: &Trajectory) -> f64 {
        let outcome = outcome(window, predicted, &self.ship, self.fit.max_yaw_rate);
        outcome.deviation().map_or(f64::INFINITY, |d| d.cvdm)
    }

    /// Fits a model to windows, with the settings of the study. A fit that did not converge has this in its name.
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
