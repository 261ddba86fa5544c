//! A resistance that resists: an estimate under R(u) >= 0 at every surge speed that was sailed, the rule that a fit upholds too. The filter's
//! estimate knows bounds of single parameters alone, and three powers of u can each be inside theirs and drive the ship together.
//!
//! Steps of the quadratic model of the log-posterior, each to its best point under the rule, which is linear in the parameters:
//!
//! ```text
//! maximise g's - s'Hs/2   subject to   R(u)/u = p1 + p2 u + p3 u^2 >= 0   for 0 <= u <= largest recorded u
//! ```

use super::estimate::{Estimate, FreeParameter, around, log_posterior, moved};
use super::optimise::Quadratic;
use super::problem::Problem;
use super::settings::{RESISTANCE_HELD, RESISTANCE_ROUNDING, RESISTANCE_SPEEDS, RESISTANCE_STEPS};
use crate::fit::constraints::speed_range;
use crate::fit::quadratic_program::minimise;
use crate::model::Model;
use nalgebra::{DMatrix, DVector};

/// Powers of u in the resistance.
const POWERS: [&str; 3] = ["resistance.linear", "resistance.quadratic", "resistance.cubic"];

/// The estimate, moved to the best one whose resistance drives the ship at no speed between 0 and the largest recorded u. What no step can
/// mend (a resistance that is not free) stays as it is.
pub fn resisting(found: Estimate, problem: Problem) -> Estimate {
    let [_, fastest] = speed_range(problem.runs);
    let mut best = found.clone();
    for _ in 0..RESISTANCE_STEPS {
        let limits = Limits::new(&best, fastest);
        if limits.hold() {
            break;
        }
        let quadratic = around(&best, problem.integration, problem.runs);
        let Some(step) = limits.step(&quadratic) else { return found };
        let mut model = moved(&best.model, &best.free, &step);
        // On a limit a value is 0 but for rounding.
        for f in best.free.iter().filter(|f| power(f, &best.model).is_some()) {
            if f.value(&model).abs() < RESISTANCE_ROUNDING * f.column.scale {
                f.set(&mut model, 0.0);
            }
        }
        let log_posterior = log_posterior(&model, problem.integration, problem.runs, &best.free, &best.noise);
        if !log_posterior.is_finite() {
            return found;
        }
        best = Estimate { model, log_posterior, seen: None, ..best };
    }
    best
}

/// R(u)/u at a grid of speeds: its values at an estimate, and their slopes by the columns of the free parameters.
struct Limits {
    values: DVector<f64>,
    /// A column a speed.
    slopes: DMatrix<f64>,
    /// Largest size of a value that is rounding.
    rounding: f64,
}

impl Limits {
    fn new(at: &Estimate, fastest: f64) -> Self {
        let speeds: Vec<f64> = (0..=RESISTANCE_SPEEDS).map(|k| fastest * k as f64 / RESISTANCE_SPEEDS as f64).collect();
        let slope = |f: &FreeParameter, u: f64| match power(f, &at.model) {
            Some(k) => f.column.scale * u.powi(k as i32),
            None => 0.0,
        };
        let parts = |u: f64| coefficients(&at.model).into_iter().enumerate().map(move |(k, p)| p * u.powi(k as i32));
        Self {
            values: DVector::from_iterator(speeds.len(), speeds.iter().map(|u| parts(*u).sum())),
            slopes: DMatrix::from_fn(at.free.len(), speeds.len(), |i, k| slope(&at.free[i], speeds[k])),
            rounding: RESISTANCE_ROUNDING * parts(fastest).map(f64::abs).sum::<f64>(),
        }
    }

    fn hold(&self) -> bool {
        self.values.iter().all(|v| *v >= -self.rounding)
    }

    /// The best step under the limits and within the bounds of every parameter; `None` where there is none.
    fn step(&self, quadratic: &Quadratic) -> Option<DVector<f64>> {
        let n = quadratic.score.len();
        let can_be_mended = |k: usize| self.values[k] < -self.rounding && self.slopes.column(k).amax() > 0.0;
        if !(0..self.values.len()).any(can_be_mended) {
            return None;
        }
        // Each limit in units of its slope, so that none is broken by rounding of the others.
        let kept: Vec<usize> = (0..self.values.len()).filter(|k| self.slopes.column(*k).amax() > 0.0).collect();
        let mut rows: Vec<(DVector<f64>, f64)> = kept
            .iter()
            .map(|k| {
                let size = self.slopes.column(*k).norm();
                (self.slopes.column(*k) / size, -self.values[*k] / size)
            })
            .collect();
        for (i, (least, most)) in quadratic.room.iter().enumerate() {
            let unit = DVector::from_fn(n, |j, _| f64::from(u8::from(i == j)));
            rows.extend(most.is_finite().then(|| (-&unit, -most)));
            rows.extend(least.is_finite().then_some((unit, *least)));
        }
        let (normals, bounds): (Vec<DVector<f64>>, Vec<f64>) = rows.into_iter().unzip();
        let held = RESISTANCE_HELD * quadratic.information.diagonal().max();
        let information = &quadratic.information + DMatrix::from_diagonal_element(n, n, held);
        let normals = if normals.is_empty() { DMatrix::zeros(n, 0) } else { DMatrix::from_columns(&normals) };
        minimise(&information, &-&quadratic.score, &normals, &DVector::from_vec(bounds)).map(|m| m.x)
    }
}

/// The power of u less one that a free parameter multiplies in every run.
fn power(f: &FreeParameter, model: &Model) -> Option<usize> {
    let name = &model.parameters[f.column.parameter].name;
    POWERS.iter().position(|power| name == power).filter(|_| f.sessions.is_none())
}

/// p1, p2 and p3.
fn coefficients(model: &Model) -> [f64; 3] {
    POWERS.map(|name| model.index(name).map_or(0.0, |i| model.parameters[i].value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::candidate::candidates;
    use crate::diagnose::example::{RK4, at, column, model, runs};
    use crate::diagnose::noise::NoisePrior;
    use crate::diagnose::settings::Settings;

    fn drives(model: &Model, fastest: f64) -> bool {
        let [p1, p2, p3] = coefficients(model);
        (1..=540).any(|k| {
            let u = fastest * f64::from(k) / 540.0;
            p1 + p2 * u + p3 * u * u < -1e-4 * (p1.abs() + p2.abs() * u + p3.abs() * u * u)
        })
    }

    #[test]
    fn a_resistance_that_drives_at_low_speed_is_moved_to_the_best_that_does_not() {
        let (m, settings) = (model(), Settings::default());
        let (list, prior, runs) = (candidates(&m, &[]), NoisePrior::around(&at(&m).noise), runs(&m, 6));
        let problem = Problem { integration: RK4, runs: &runs, candidates: &list, prior: &prior, settings: &settings };
        let [_, fastest] = speed_range(&runs[..]);
        let free: Vec<FreeParameter> =
            POWERS.iter().map(|name| FreeParameter::common(column(&m, name), None)).collect();
        // As far as it resists, it stays as it is.
        let own = Estimate { free, ..at(&m) };
        assert!(!drives(&own.model, fastest));
        assert_eq!(coefficients(&resisting(own.clone(), problem).model), coefficients(&m));
        // The same resistance at the largest speed, and one that drives below a third of it.
        let [p1, p2, p3] = coefficients(&m);
        let at_most = p1 + p2 * fastest + p3 * fastest * fastest;
        let mut wrong = own;
        wrong
            .free
            .iter()
            .zip([-0.4 * at_most, 1.2 * at_most / fastest, 0.2 * at_most / fastest.powi(2)])
            .for_each(|(f, v)| f.set(&mut wrong.model, v));
        assert!(drives(&wrong.model, fastest));
        let held = resisting(wrong, problem);
        assert!(!drives(&held.model, fastest), "{:?}", coefficients(&held.model));
        // What is free to move finds back to the truth, which resists.
        let truth = log_posterior(&m, RK4, &runs, &held.free, &held.noise);
        assert!(held.log_posterior > truth - 20.0, "{} {truth}", held.log_posterior);
    }

    #[test]
    fn a_resistance_that_is_not_free_stays_as_it_is() {
        let (m, settings) = (model(), Settings::default());
        let (list, prior, runs) = (candidates(&m, &[]), NoisePrior::around(&at(&m).noise), runs(&m, 3));
        let problem = Problem { integration: RK4, runs: &runs, candidates: &list, prior: &prior, settings: &settings };
        let mut found = Estimate { free: vec![FreeParameter::common(column(&m, "rudder.lift1"), None)], ..at(&m) };
        found.model.set(&[("resistance.linear", -1e5)]).unwrap();
        assert_eq!(resisting(found.clone(), problem).model.values(), found.model.values());
    }
}
