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
//! An active limit is an inequality: what it blocks is not known exactly, as the truth may lie inside. Along the direction d in which the cost
//! rises least as limit k alone is left by t, with slope y and variance v there, the likelihood is that of a normal distribution of mean
//! `-y / (d^T H d)` cut at t = 0, and each covariance takes in `E[t^2] d d^T`. At y = 0 that is the variance without the limit. Source: Geweke,
//! J. Applied Econometrics 1 (1986) 127-141, the linear model under inequality constraints.
//!
//! The first takes residuals as independent. Along a simulated trajectory they are not, so that its variances are far too small;
//! the second only takes the recordings as mutually independent, and needs several of them. Source: White, Econometrica
//! 50 (1982) 1-25 and Liang & Zeger, Biometrika 73 (1986) 13-22 for the sandwich.

use crate::fit::objectives::cost::Quadratic;
use crate::fit::objectives::evaluations::Evaluations;
use crate::fit::solver::solve::End;
use crate::fit::solver::subspace::{inverse, null_space};
use crate::fit::solver::task::Task;
use crate::statistics::clustered_variance;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use statrs::distribution::{Continuous, ContinuousCDF, Normal};
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
        let normals = task.normals(&end.active);
        let directions = null_space(&normals, n);
        let quadratic = evaluations.quadratic(&end.p);
        let own = scores_by_recording(task, quadratic.as_deref());
        let (meat, clusters) = clustered_variance(task.cost.ranks(), &own, n);
        let data = quadratic.as_ref().map_or_else(|| DMatrix::zeros(n, n), |q| task.scaled(&q.gauss_newton));
        let mut prior = DMatrix::zeros(n, n);
        end.priors.add_hessian(&mut prior);
        let prior = task.scaled(&prior);
        let hessian = &data + &prior;
        let bread = inverse(&hessian, &directions);
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
        let mut gradient = quadratic.map_or_else(|| DVector::zeros(n), |q| q.gradient.clone());
        let slope = task.scaled_vector(&gradient);
        end.priors.add_gradient(&end.p, &mut gradient);
        let limits = Limits { normals, hessian, gradient: task.scaled_vector(&gradient) };
        // What the scores vary by: of a prior as it says, of the data by each of the three.
        let matrix =
            |scores: DMatrix<f64>| limits.covariance(&bread.matrix, &directions, &scores) + limits.beyond(&scores);
        // The mean of the recordings' scores is zero but across a limit, where it is the slope there.
        let sandwich = meat + &prior * unit;
        let about_mean = &sandwich - &slope * slope.transpose() / (clusters.max(2) - 1) as f64;
        Self {
            unit,
            independent: matrix((&data + &prior) * unit),
            correlated: matrix(&data * (unit * likeness) + &prior * unit),
            likeness,
            sandwich: limits.covariance(&bread.matrix, &directions, &sandwich) + limits.beyond(&about_mean),
            kind,
            freedom,
            clusters,
            design_effect: (clusters > 1 && ratio.is_finite()).then_some(ratio),
            determined: bread.determined(),
            data,
            directions,
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

    /// Standard error of a parameter in its own unit; 0 where active limits leave nothing of it to the data.
    pub fn standard_error(&self, task: &Task, j: usize) -> Option<f64> {
        self.error(task, j)
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

/// The active limits of a fit, and its cost about the end, by the scaled parameters.
struct Limits {
    /// Normals of the limits, of length one.
    normals: Vec<DVector<f64>>,
    hessian: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Limits {
    /// The covariance `B S B` of scores of variance S on the limits, with B the inverse of the Hessian within the directions that they leave.
    fn covariance(&self, bread: &DMatrix<f64>, directions: &DMatrix<f64>, scores: &DMatrix<f64>) -> DMatrix<f64> {
        let n = bread.nrows();
        let mut all = bread * scores * bread;
        for j in 0..n {
            // Rounding in the projection leaves 1e-16 where active limits leave nothing.
            if directions.row(j).norm() < 1e-9 {
                all.row_mut(j).fill(0.0);
                all.column_mut(j).fill(0.0);
            }
        }
        all
    }

    /// `E[t^2] d d^T` of each limit, for scores of variance S.
    fn beyond(&self, scores: &DMatrix<f64>) -> DMatrix<f64> {
        let n = scores.nrows();
        let mut all = DMatrix::zeros(n, n);
        for (k, normal) in self.normals.iter().enumerate() {
            let others: Vec<DVector<f64>> =
                self.normals.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, other)| other.clone()).collect();
            let without = inverse(&self.hessian, &null_space(&others, n));
            let yielding = &without.matrix * normal;
            let along = yielding.dot(normal);
            // A limit that follows from others, or beyond which the data say nothing.
            if along <= 0.0 || without.loose(normal) {
                continue;
            }
            let direction = &yielding / along;
            let variance = yielding.dot(&(scores * &yielding));
            let square = squared_distance(self.gradient.dot(&direction).abs() * along, variance);
            all += &direction * direction.transpose() * square;
        }
        all
    }
}

/// `E[t^2]` of a normal distribution of mean `-distance` and a variance, cut to t >= 0: with `a = distance / sqrt(variance)` and the hazard
/// `h = phi(a) / Phi(-a)`, `variance (1 + a^2 - a h)`; where a is large `variance (2 / a^2 - 10 / a^4)`, close to that of an exponential
/// distribution.
fn squared_distance(distance: f64, variance: f64) -> f64 {
    if variance.is_nan() || variance <= 0.0 {
        return 0.0;
    }
    let (a, normal) = (distance / variance.sqrt(), Normal::standard());
    if a > 20.0 {
        return variance * (2.0 - 10.0 / (a * a)) / (a * a);
    }
    variance * (1.0 + a * a - a * normal.pdf(a) / normal.cdf(-a))
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
    fn the_squared_distance_from_a_limit_goes_from_the_variance_to_that_of_an_exponential_distribution() {
        assert!((squared_distance(0.0, 4.0) - 4.0).abs() < 1e-12);
        let [below, above] = [19.999, 20.001].map(|a| squared_distance(a, 1.0) * a * a);
        assert!((below - above).abs() < 1e-3 && (above - 2.0).abs() < 0.03, "{below} {above}");
        // By numerical integration of t^2 exp(-(t + 1)^2 / 2) over that of exp(-(t + 1)^2 / 2), t from 0.
        let at = |t: f64| (-0.5 * (t + 1.0) * (t + 1.0)).exp();
        let (mut square, mut all) = (0.0, 0.0);
        for i in 0..100_000 {
            let t = (f64::from(i) + 0.5) * 1e-4;
            (square, all) = (square + t * t * at(t), all + at(t));
        }
        assert!((squared_distance(1.0, 1.0) - square / all).abs() < 1e-6);
        assert_eq!(squared_distance(1.0, 0.0), 0.0);
    }

    #[test]
    fn a_limit_without_slope_leaves_the_covariance_that_is_there_without_it() {
        let hessian = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]);
        let normals = vec![vector(&[1.0, 0.0])];
        let directions = null_space(&normals, 2);
        let bread = inverse(&hessian, &directions).matrix;
        let free = inverse(&hessian, &DMatrix::identity(2, 2)).matrix;
        let flat = Limits { normals, hessian: hessian.clone(), gradient: vector(&[0.0, 0.0]) };
        let covariance = |limits: &Limits| limits.covariance(&bread, &directions, &hessian) + limits.beyond(&hessian);
        assert!((covariance(&flat) - &free).norm() < 1e-12);
        // The steeper the cost at the limit, the less is left of what lies inside.
        let steep = Limits { gradient: vector(&[10.0, 0.0]), ..flat };
        let left = covariance(&steep);
        assert!(left[(0, 0)] > 0.0 && left[(0, 0)] < 0.03 * free[(0, 0)], "{left}");
        assert!(left[(1, 1)] > bread[(1, 1)] && left[(1, 1)] < free[(1, 1)], "{left}");
    }

    #[test]
    fn a_direction_is_named_by_its_largest_entries() {
        assert_eq!(in_words(&vector(&[-0.45, 0.89, 0.0]), &["x", "y", "w"]), "0.89 y - 0.45 x");
    }
}
