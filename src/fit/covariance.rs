//! What a fit says of its estimates: active constraints, covariance, and the combinations the data do not determine.
//! Its matrices are in scaled parameters `z = p / scale`; it solves nothing.
//!
//! Linear theory around the solution. With the cost `C = (1/M) sum e^2`, its Gauss-Newton matrix H, the residual variance
//! `s^2` and the null space Z of the active constraints (`A d = 0` for `d = Z y`),
//!
//! ```text
//! Gauss-Newton   Cov = (2 s^2 / M) B,   B = Z (Z^T H Z)^-1 Z^T
//! correlated     Cov = l B H B (2 s^2 / M),   l how many successive residuals count as one (see `doubts`)
//! sandwich       Cov = B (c/(c-1) sum_c g_c g_c^T) B,   g_c the gradient of the part of cluster c (runs of one recording)
//! ```
//!
//! The first takes residuals as independent. Along a simulated trajectory they are not, so that its variances are far too small;
//! the second only takes the recordings as mutually independent, and needs several of them. Source: White, Econometrica
//! 50 (1982) 1-25 and Liang & Zeger, Biometrika 73 (1986) 13-22 for the sandwich.

use crate::fit::objectives::cost::Quadratic;
use crate::fit::objectives::evaluations::Evaluations;
use crate::fit::solver::solve::End;
use crate::fit::solver::subspace::inverse;
use crate::fit::solver::task::Task;
use crate::statistics::clustered_variance;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use std::collections::BTreeMap;

/// Number of recordings from which on standard errors allow for what residuals of one recording share.
pub const SANDWICH_FROM: usize = 8;

/// Which covariance standard errors come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CovarianceKind {
    /// Residuals taken as independent.
    GaussNewton,
    /// As many successive residuals of a run taken for one as their autocorrelation says; recordings are too few for more.
    Correlated,
    /// Recordings taken as independent, residuals of one recording not.
    Sandwich,
}

impl CovarianceKind {
    /// What it takes residuals for, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::GaussNewton => "residuals taken as independent",
            Self::Correlated => "successive residuals taken as one, by their autocorrelation",
            Self::Sandwich => "recordings taken as independent",
        }
    }
}

/// Covariance of the estimates, in the parameters' units and the order of the estimates.
///
/// An entry is absent where the data do not determine one of the two parameters.
pub type Covariance = Vec<Vec<Option<f64>>>;

/// The covariances of a fit's estimates, and what they were made from, by the scaled parameters.
pub(in crate::fit) struct Covariances {
    /// Gauss-Newton matrix of the data's part of the cost.
    pub data: DMatrix<f64>,
    /// Columns that span the directions which active constraints leave free.
    pub directions: DMatrix<f64>,
    /// 2 s^2/M: what turns the inverse of the cost's Hessian into a covariance.
    pub unit: f64,
    /// Covariance with residuals taken as independent.
    pub independent: DMatrix<f64>,
    /// Covariance with recordings taken as independent.
    pub sandwich: DMatrix<f64>,
    /// Covariance with successive residuals taken for one, by their autocorrelation.
    pub correlated: DMatrix<f64>,
    /// How many successive residuals count as one, at least 1 and at least what the settings say of the priors.
    pub likeness: f64,
    /// Which of the three standard errors come from.
    pub kind: CovarianceKind,
    /// Degrees of freedom of the variance behind it.
    pub freedom: usize,
    /// Number of recordings.
    pub clusters: usize,
    /// Ratio of the variances, see [`Fit::design_effect`](super::Fit::design_effect).
    pub design_effect: Option<f64>,
    /// For each parameter, whether the data and the priors determine it.
    determined: Vec<bool>,
}

impl Covariances {
    /// The covariances where a fit ended, from its objective there; `unit` turns the inverse of the objective's Hessian into a covariance.
    ///
    /// `likeness` is how many successive residuals count as one, where that is known.
    pub fn of(task: &Task, evaluations: &Evaluations, unit: f64, end: &End, likeness: Option<f64>) -> Self {
        let n = task.scaling.scales.len();
        let directions = task.free_directions(&end.active);
        let quadratic = evaluations.quadratic(&end.p);
        let own = scores_by_recording(task, quadratic.as_deref());
        let (meat, clusters) = clustered_variance(task.cost.ranks(), &own, n);
        let data = quadratic.map_or_else(|| DMatrix::zeros(n, n), |q| task.scaled(&q.gauss_newton));
        let mut prior = DMatrix::zeros(n, n);
        end.priors.add_hessian(&mut prior);
        let prior = task.scaled(&prior);
        let bread = inverse(&(&data + &prior), &directions);
        let ratio = (&bread.matrix * &meat).trace() / (&bread.matrix * &data * unit).trace();
        let likeness = likeness.unwrap_or(1.0).max(1.0) / task.settings.correlated_samples.max(1.0);
        let likeness = likeness.max(1.0);
        let freedom = task.cost.residuals().saturating_sub(n).max(1);
        let (kind, freedom) = if clusters >= SANDWICH_FROM {
            (CovarianceKind::Sandwich, clusters - 1)
        } else if likeness > 1.0 {
            (CovarianceKind::Correlated, ((freedom as f64 / likeness) as usize).max(1))
        } else {
            (CovarianceKind::GaussNewton, freedom)
        };
        // The data's part of the variance alone: the variance of a prior does not change.
        let inflated = &data * (unit * likeness) + &prior * unit;
        Self {
            data,
            directions,
            unit,
            independent: &bread.matrix * unit,
            correlated: &bread.matrix * inflated * &bread.matrix,
            likeness,
            sandwich: &bread.matrix * (meat + prior * unit) * &bread.matrix,
            kind,
            freedom,
            clusters,
            design_effect: (clusters > 1 && ratio.is_finite()).then_some(ratio),
            determined: bread.determined(),
        }
    }

    /// The one that standard errors come from.
    pub fn chosen(&self) -> &DMatrix<f64> {
        match self.kind {
            CovarianceKind::Sandwich => &self.sandwich,
            CovarianceKind::Correlated => &self.correlated,
            CovarianceKind::GaussNewton => &self.independent,
        }
    }

    fn entry(&self, task: &Task, matrix: &DMatrix<f64>, i: usize, j: usize) -> Option<f64> {
        let value = matrix[(i, j)] * task.scaling.scales[i] * task.scaling.scales[j];
        (self.determined[i] && self.determined[j] && value.is_finite()).then_some(value)
    }

    fn error(&self, task: &Task, j: usize) -> Option<f64> {
        self.entry(task, self.chosen(), j, j).map(|v| v.max(0.0).sqrt())
    }

    /// Standard error of a parameter in its own unit; 0 where active constraints fix it.
    pub fn standard_error(&self, task: &Task, j: usize) -> Option<f64> {
        // Rounding in the projection leaves 1e-16 where active constraints leave nothing.
        let fixed = self.directions.row(j).norm() < 1e-9;
        self.error(task, j).map(|e| if fixed { 0.0 } else { e })
    }

    /// A covariance matrix in the parameters' own units.
    pub fn table(&self, task: &Task, matrix: &DMatrix<f64>) -> Covariance {
        square(task.scaling.scales.len(), |i, j| self.entry(task, matrix, i, j))
    }

    /// Correlations of the estimates.
    pub fn correlations(&self, task: &Task) -> Covariance {
        square(task.scaling.scales.len(), |i, j| {
            let (si, sj, cij) = (self.error(task, i)?, self.error(task, j)?, self.entry(task, self.chosen(), i, j)?);
            let r = cij / (si * sj);
            r.is_finite().then_some(r.clamp(-1.0, 1.0))
        })
    }
}

fn square(n: usize, entry: impl Fn(usize, usize) -> Option<f64>) -> Covariance {
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// The gradient of the part of the cost of each recording of this rank.
fn scores_by_recording(task: &Task, quadratic: Option<&Quadratic>) -> Vec<DVector<f64>> {
    let mut clusters: Vec<DVector<f64>> = Vec::new();
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    for (run, score) in task.runs.iter().zip(quadratic.map_or(&[][..], |q| &q.by_run)) {
        let score = task.scaled_vector(score);
        if let Some(cluster) = known.get(&run.recording) {
            clusters[*cluster] += score;
        } else {
            known.insert(run.recording.clone(), clusters.len());
            clusters.push(score);
        }
    }
    clusters
}

/// A direction in words: its largest entries by name, `0.71 p5 - 0.70 p7`.
pub(in crate::fit) fn in_words(direction: &DVector<f64>, names: &[&str]) -> String {
    let mut entries: Vec<usize> = (0..direction.len()).filter(|i| direction[*i].abs() > 0.15).collect();
    entries.sort_by(|a, b| direction[*b].abs().total_cmp(&direction[*a].abs()));
    entries.truncate(5);
    // A direction has no sense of its own: the largest entry is written positive.
    let sign = entries.first().map_or(1.0, |i| direction[*i].signum());
    let mut text = String::new();
    for i in entries {
        let value = sign * direction[i];
        let joint = match (text.is_empty(), value < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text += &format!("{joint}{:.2} {}", value.abs(), names[i]);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(values: &[f64]) -> DVector<f64> {
        DVector::from_row_slice(values)
    }

    #[test]
    fn a_direction_is_named_by_its_largest_entries() {
        assert_eq!(in_words(&vector(&[-0.45, 0.89, 0.0]), &["x", "y", "w"]), "0.89 y - 0.45 x");
    }
}
