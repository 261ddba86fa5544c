//! What stays fixed during a fit: model, cost, runs, constraint rows, and the scales, bounds and start of the free parameters.
//! It prepares and translates; it neither solves nor judges a solution.

use super::constraints::{self, Row};
use super::cost::{Cost, FitRun};
use super::error::FitError;
use super::problem::row_size;
use super::settings::FitSettings;
use super::subspace::null_space;
use crate::model::{Model, Parameter};
use nalgebra::{DMatrix, DVector};

/// What stays fixed during a fit.
pub(super) struct Task<'a> {
    pub model: &'a Model,
    pub cost: &'a Cost<'a>,
    pub runs: &'a [FitRun],
    pub settings: &'a FitSettings,
    pub rows: Vec<Row>,
    pub scales: Vec<f64>,
    pub bounds: Vec<(f64, f64)>,
    pub start: Vec<f64>,
    pub start_cost: f64,
}

/// Rows and bounds that hold a point back.
pub(super) struct ActiveSet {
    pub rows: Vec<usize>,
    /// Index of the free parameter, and which bound.
    pub bounds: Vec<(usize, &'static str)>,
}

impl<'a> Task<'a> {
    pub fn new(
        model: &'a Model,
        cost: &'a Cost<'a>,
        runs: &'a [FitRun],
        settings: &'a FitSettings,
    ) -> Result<Self, FitError> {
        let free: Vec<&Parameter> = cost.free().iter().map(|i| &model.parameters[*i]).collect();
        if free.is_empty() {
            return Err(FitError::NothingFree);
        }
        let rows = constraints::rows(model, &settings.constraints, constraints::speed_range(runs))?;
        let bounds: Vec<(f64, f64)> = free.iter().map(|p| (p.lower, p.upper)).collect();
        let start: Vec<f64> = free.iter().map(|p| p.value.max(p.lower).min(p.upper)).collect();
        let Some(start_cost) = cost.value(&start) else {
            let (run, time) = cost.divergence(&start).unwrap_or_else(|| (runs[0].name.clone(), runs[0].start_time));
            return Err(FitError::Diverged { run, time });
        };
        let scales = free.iter().map(|p| if p.scale > 0.0 && p.scale.is_finite() { p.scale } else { 1.0 }).collect();
        Ok(Self { model, cost, runs, settings, rows, scales, bounds, start, start_cost })
    }

    /// One over the mean number of samples of a run.
    pub fn factor(&self) -> f64 {
        let samples: usize = self.runs.iter().map(|r| r.measured.len()).sum();
        self.runs.len() as f64 / samples as f64
    }

    /// Variance of the weighted residuals at a given cost.
    pub fn variance(&self, cost: f64) -> f64 {
        let freedom = self.cost.residuals().saturating_sub(self.scales.len()).max(1);
        cost * self.runs.len() as f64 / freedom as f64
    }

    /// Directions in scaled parameters along which no active constraint changes.
    pub fn free_directions(&self, active: &ActiveSet) -> DMatrix<f64> {
        let n = self.scales.len();
        let mut normals: Vec<DVector<f64>> = Vec::new();
        for i in &active.rows {
            let row = &self.rows[*i];
            let size = row_size(row, &self.scales);
            let scaled = row.coefficients.iter().zip(&self.scales).map(|(a, s)| a * s / size);
            normals.push(DVector::from_iterator(n, scaled));
        }
        for (j, _) in &active.bounds {
            let mut normal = DVector::zeros(n);
            normal[*j] = 1.0;
            normals.push(normal);
        }
        null_space(&normals, n)
    }

    /// A matrix or vector by the parameters, by the scaled parameters.
    pub fn scaled(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] * self.scales[i] * self.scales[j])
    }

    pub fn scaled_vector(&self, vector: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(vector.len(), |i, _| vector[i] * self.scales[i])
    }
}
