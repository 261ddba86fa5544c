//! What the filter is asked for and what one pass over one run gives.
//! It computes nothing: the filter does.

use super::covariance::Z;
pub use super::settings::GATE;
use crate::model::Model;
use crate::physics::Probe;
use crate::recording::Run;
use crate::sensitivity::columns;
use crate::state::{Inputs, STATES, State};
use nalgebra::{DMatrix, DVector};

/// Factor on the variance of the unknown force at a sample: where a known event pushed the ship, the force may be anything.
pub fn boost(run: &Run, sample: usize) -> f64 {
    if run.disturbed_at(sample) { 1e4 } else { 1.0 }
}

/// A direction in parameter space along which sensitivities are carried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Index of the parameter in the model.
    pub parameter: usize,
    /// Unit of the column: the sensitivity is to `parameter / scale`.
    pub scale: f64,
    /// How the derivative is taken.
    pub probe: Probe,
}

impl Column {
    /// The column without its probe.
    pub(super) fn exact(&self) -> columns::Column {
        columns::Column { parameter: self.parameter, scale: self.scale }
    }

    /// The exact derivative with respect to a parameter, in units of its scale.
    pub fn tangent(model: &Model, parameter: usize) -> Self {
        Self { parameter, scale: model.parameters[parameter].scale, probe: Probe::Tangent }
    }
}

/// Forces on the body axes as functions of the state, added as further columns after the parameters. They are asked for by the index
/// of the run and that of the sample.
pub type ForceBasis<'a> = &'a (dyn Fn((usize, usize), &State<f64>, &Inputs<f64>, &mut Vec<[f64; 3]>) + Sync);

/// What one pass over one run gives.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Log-likelihood of the run.
    pub log_likelihood: f64,
    /// Number of scalar measurements used.
    pub used: usize,
    /// Number of scalar measurements set aside as outliers.
    pub outliers: usize,
    /// Score by column.
    pub score: DVector<f64>,
    /// Information by pairs of columns.
    pub information: DMatrix<f64>,
    /// Standardised innovations by sample and channel; NaN where there was no measurement.
    pub innovations: Vec<[f64; STATES]>,
    /// Derivatives of the standardised innovations by the columns, sample after sample, column after column; empty where not asked for.
    pub slopes: Vec<[f64; STATES]>,
    /// Filtered state by sample.
    pub filtered: Vec<[f64; Z]>,
    /// Standard deviation of the filtered unknown force in X, Y \[N\], N \[N m\] by sample.
    pub force_sd: Vec<[f64; 3]>,
    /// The linearisation, where asked for.
    pub tangent: Option<Tangent>,
    /// The gains, where asked for.
    pub gains: Option<Gains>,
}

/// The step maps of a run, linearised along its filtered path.
#[derive(Clone, Debug, Default)]
pub struct Tangent {
    /// Point of linearisation by sample.
    pub state: Vec<[f64; STATES]>,
    /// Its image one sample later without unknown force.
    pub image: Vec<[f64; STATES]>,
    /// State Jacobian.
    pub a: Vec<[[f64; STATES]; STATES]>,
    /// Force Jacobian.
    pub gamma: Vec<[[f64; 3]; STATES]>,
    /// What the sensors report where the state is zero, by the report's linearisation at the predicted state.
    pub offset: Vec<[f64; STATES]>,
    /// How the report changes with the state, by channel; empty where the sensors report the state itself.
    pub report: Vec<[[f64; STATES]; STATES]>,
}

/// The gains of a filter along one run: with them fixed, the innovations are a smooth function of the parameters whose
/// derivative is exactly what the sensitivities say.
#[derive(Clone, Debug, Default)]
pub struct Gains {
    /// Innovation variance by sample and channel; NaN where the channel was not used.
    pub variance: Vec<[f64; STATES]>,
    /// Gain by sample and channel.
    pub gain: Vec<[[f64; Z]; STATES]>,
}

/// What a pass is asked for beyond scores.
#[derive(Clone, Copy, Default)]
pub struct Wanted<'a> {
    /// Forces added as further columns: how many, and their values.
    pub basis: Option<(usize, ForceBasis<'a>)>,
    /// Store the linearised step maps.
    pub tangent: bool,
    /// Store the gains.
    pub gains: bool,
    /// Use these gains, run by run, instead of computing them.
    pub frozen: Option<&'a [Gains]>,
    /// Leave out what is kept by sample: innovations, filtered states and the unknown force's standard deviations.
    pub sums_only: bool,
    /// Store the derivatives of the standardised innovations; of the parameters alone, without a basis.
    pub slopes: bool,
    /// Differentiate the parameters through every stage of the step, instead of by the trapezoidal rule over it.
    pub exact: bool,
}
