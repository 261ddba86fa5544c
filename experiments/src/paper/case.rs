//! One ship of the paper: data set, fitted parameters, and the baselines for comparison.
//! It draws and prints nothing; the evaluation measures how good a fit is.

use super::captive_baseline::captive_baseline;
use super::error::PaperError;
use super::published::{Published, published};
use crate::truth::dataset::{self, Run, dataset};
use crate::truth::ships::ShipId;
use std::path::Path;
use trimtab::evaluate::{Evaluation, EvaluationSettings, Judging, prove};
use trimtab::fit::{Fit, FitSettings, Limits, fit};
use trimtab::model::Model;
use trimtab::physics::Form;
use trimtab::recording::{self, Split, measured};
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;
use trimtab::simulate::{Integration, Method};

/// Settings that may differ from the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Seed of the data set.
    pub seed: u64,
    /// Low-speed form of hull and resistance.
    pub form: Form,
    /// Settings of the fit, the integration of every simulation among them.
    pub fit: FitSettings,
}

impl Default for Setup {
    fn default() -> Self {
        let mut fit = FitSettings { integration: INTEGRATION, tolerance: TOLERANCE, ..FitSettings::default() };
        fit.constraints.limits = Limits::Paper;
        Self { seed: dataset::SEED, form: Form::Paper, fit }
    }
}

/// Explicit Euler as in the paper, in sub-steps of 0.5 s (ship A) and 0.75 s (ship B).
///
/// The paper prints no step. One step a sample is stable, but its own error is a sixth of the error of ship B's fitted model;
/// with four sub-steps it is a twentieth and less. The overall performance prints that error beside the results.
const INTEGRATION: Integration = Integration { method: Method::Euler, substeps: 4 };
/// The simulated ships leave residuals far above noise, where Gauss-Newton converges linearly: the solver stops early, and the
/// polish after it gives the last digits.
const TOLERANCE: f64 = 1e-7;

/// A ship with its data, its fit and its baselines.
pub struct Case {
    /// Which ship.
    pub ship: ShipId,
    /// The paper's numbers for the ship.
    pub published: Published,
    /// The data set of the truth simulator.
    pub runs: Vec<Run>,
    /// The data set as windows of the model, in this order.
    pub windows: Vec<recording::Run>,
    /// Model with the published p~.
    pub published_baseline: Model,
    /// Model with parameters from captive tests on the truth simulator.
    pub captive_baseline: Model,
    /// The fit to the training runs, from the paper's initial guess.
    pub fit: Fit,
    /// The settings of all this.
    pub setup: Setup,
}

impl Case {
    /// Simulates the data set, fits the model and makes the baselines.
    ///
    /// # Errors
    /// An unreadable ship file, captive tests that do not determine a parameter, an impossible fit.
    pub fn prepare(ship: ShipId, setup: Setup) -> Result<Self, PaperError> {
        let runs = dataset(ship, setup.seed);
        Self::from_runs(ship, runs, setup)
    }

    /// [`Case::prepare`] for a data set at hand.
    ///
    /// # Errors
    /// As [`Case::prepare`].
    pub fn from_runs(ship: ShipId, runs: Vec<Run>, setup: Setup) -> Result<Self, PaperError> {
        let published = published(ship);
        let model = initial_model(ship, setup.form)?;
        let mut published_baseline = model.clone();
        published_baseline.name = "published".into();
        published_baseline.set_eleven(&published.baseline);
        let captive_baseline = captive_baseline(ship, &model)?;
        let windows: Vec<recording::Run> = runs.iter().map(|run| window(ship, run)).collect();
        let training = training(&windows);
        let fit = fit(&model, &training, &setup.fit, &mut |_| true)?;
        Ok(Self { ship, published, runs, windows, published_baseline, captive_baseline, fit, setup })
    }

    /// `Ship A`.
    pub fn label(&self) -> &'static str {
        label(self.ship)
    }

    /// Both baselines with their names.
    pub fn baselines(&self) -> [(&Model, &'static str); 2] {
        [(&self.published_baseline, "published p~"), (&self.captive_baseline, "captive tests")]
    }

    /// The training runs as runs of the cost.
    pub fn training(&self) -> Vec<recording::Run> {
        training(&self.windows)
    }

    /// The fit judged against a baseline, on all runs; the summary `test` is of those held out.
    pub fn evaluate(&self, baseline: &Model) -> Evaluation {
        let bootstrap = EvaluationSettings { seed: self.setup.seed, ..EvaluationSettings::default() };
        prove(baseline, &self.fit.model, &self.windows, &Judging::new(&self.setup.fit, bootstrap))
    }
}

/// `Ship A`.
pub fn label(ship: ShipId) -> &'static str {
    match ship {
        ShipId::A => "Ship A",
        ShipId::B => "Ship B",
    }
}

/// The model of a ship with the paper's initial guess, the eleven parameters free.
///
/// # Errors
/// A ship file that cannot be read.
pub fn initial_model(ship: ShipId, form: Form) -> Result<Model, PaperError> {
    let file = match ship {
        ShipId::A => "ships/a.toml",
        ShipId::B => "ships/b.toml",
    };
    let particulars = Ship::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file))?;
    let mut model = Model::new(particulars, "fitted", form, &[])?;
    model.set_eleven(&published(ship).initial);
    Ok(model)
}

/// A run as a window of the model: every channel measured without error, started from its first row.
fn window(ship: ShipId, run: &Run) -> recording::Run {
    recording::Run {
        name: run.name.clone(),
        recording: run.name.clone(),
        session: String::new(),
        manoeuvre: run.manoeuvre.into(),
        split: match run.split {
            dataset::Split::Train => Split::Train,
            dataset::Split::Test => Split::Test,
        },
        dt: dataset::period(ship),
        recorded_dt: dataset::period(ship),
        inputs: (0..run.t.len()).map(|i| Inputs::actuators(run.t[i], run.n[i], run.delta[i])).collect(),
        measured: measured(&run.state),
        initial: run.state[0],
        disturbed: Vec::new(),
        derived: [false; 6],
    }
}

fn training(windows: &[recording::Run]) -> Vec<recording::Run> {
    windows.iter().filter(|w| w.split == Split::Train).cloned().collect()
}
