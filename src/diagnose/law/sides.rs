//! Whether port and starboard of the ship differ: the effect of a single screw on the flow and of a rudder off its zero, by
//! parameters that are free in every estimate. It is reported beside the verdict and is no finding: no physics is missing for it.

use crate::diagnose::evidence::wald::Wald;
use crate::diagnose::proof::finding::Amplitude;
use crate::diagnose::search::screen::Screen;
use crate::diagnose::settings::SIDES_DIFFER;
use crate::likelihood::estimate::{Estimate, FreeParameter};
use crate::likelihood::evidence::chi_squared_p;
use crate::parameter::Parity;
use crate::physics::Group;
use nalgebra::DMatrix;
use serde::Serialize;

/// A test of everything in the base that breaks mirror symmetry.
#[derive(Clone, Debug, Serialize)]
pub struct Sides {
    /// Squared distance of all parameters together from a ship whose sides are alike, in units of their covariance, without priors.
    pub statistic: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// p-value.
    pub p: f64,
    /// The parameters, the most significant first.
    pub parameters: Vec<Amplitude>,
}

impl Sides {
    /// The parameters whose interval excludes zero, the most significant first; none where the sides do not differ.
    pub fn clear(&self) -> impl Iterator<Item = &Amplitude> {
        let apart = self.p < SIDES_DIFFER;
        self.parameters.iter().filter(move |a| apart && a.ci95[0] * a.ci95[1] > 0.0)
    }
}

/// Tests the parameters of the base, the first `base` free ones of the estimate, that differ between port and starboard; `None` when
/// it has none. `s` is the screen at the estimate and `kinds` the kind of manoeuvre of each run, between which the parameters may
/// scatter more than their information says ([`crate::likelihood::evidence::Evidence::scatter`]).
pub fn sides(s: &Screen, found: &Estimate, base: usize, kinds: &[&str]) -> Option<Sides> {
    // The offset of a sensor is no asymmetry of the ship.
    let of_the_ship = |name: &str| {
        let term = name.split('.').next().and_then(|name| found.model.catalogue().find(name));
        term.is_some_and(|t| matches!(t.info().group, Group::Hull | Group::Propulsion | Group::Rudder))
    };
    let differs = |i: &usize| {
        let p = &found.model.parameters[found.free[*i].column.parameter];
        p.info.parity == Parity::Odd && of_the_ship(&p.name)
    };
    let odd: Vec<usize> = (0..base).filter(differs).collect();
    if odd.is_empty() {
        return None;
    }
    // A prior that the sides are alike is no evidence that they are.
    let terms =
        |(i, f): (usize, &FreeParameter)| if odd.contains(&i) { (0.0, 0.0) } else { f.prior_terms(&found.model) };
    let (precision, pull): (Vec<f64>, Vec<f64>) = found.free.iter().enumerate().map(terms).unzip();
    let free = s.evidence.base(&(0..found.free.len()).collect::<Vec<_>>(), &precision, &pull);
    let step = free.step();
    let scatter = s.evidence.scatter(&free, kinds, &s.mechanism_columns());
    let factors = &scatter.factors;
    let n = factors.len();
    let mut all = Wald::of(found, DMatrix::from_fn(n, n, |i, j| free.inverse[(i, j)] * factors[i] * factors[j]));
    all.value += step;
    let tested = all.part(&odd);
    let amplitude = |(k, i): (usize, &usize)| {
        let column = &found.free[*i].column;
        let p = &found.model.parameters[column.parameter];
        let (value, error) =
            (tested.value[k] * column.scale, tested.covariance[(k, k)].max(0.0).sqrt() * column.scale.abs());
        Amplitude::within(p.name.clone(), value, p.info.unit, error, scatter.reach(*i))
    };
    let mut parameters: Vec<Amplitude> = odd.iter().enumerate().map(amplitude).collect();
    let weight = |a: &Amplitude| (a.value / a.error.max(f64::MIN_POSITIVE)).abs();
    parameters.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    let statistic = tested.statistic();
    Some(Sides { statistic, degrees: odd.len(), p: chi_squared_p(statistic, odd.len()), parameters })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, at, model, runs, with};
    use crate::diagnose::search::screen::screen;
    use crate::likelihood::parameters::base_parameters;
    use crate::model::Model;

    /// The test of the sides of a ship, at its own values, with the nuisance coefficients free.
    fn of(model: &Model) -> Option<Sides> {
        let free = base_parameters(model, true);
        let runs = runs(model, 9);
        let found = Estimate { free, ..at(model) };
        let s = screen(&found, RK4, &runs, &[]);
        let kinds: Vec<&str> = runs.iter().map(|r| r.recording.as_str()).collect();
        sides(&s, &found, found.free.len(), &kinds)
    }

    #[test]
    fn a_ship_whose_sides_differ_is_significant_and_one_whose_sides_are_alike_is_not() {
        let zero = ["propeller.side_force", "rudder.lift0", "rudder.lift2", "rudder.drag1"].map(|n| (n, 0.0));
        let alike = of(&with(&zero));
        let other = of(&with(&[("propeller.side_force", 0.1), ("rudder.lift0", 0.2)]));
        let (alike, other) = (alike.map_or(0.0, |s| s.p), other.map_or(1.0, |s| s.p));
        assert!(alike > 0.01 && other < 1e-6, "{alike} {other}");
    }

    #[test]
    fn a_base_without_asymmetric_parameters_says_nothing() {
        let model = model();
        let found = Estimate { free: Vec::new(), ..at(&model) };
        let s = screen(&found, RK4, &runs(&model, 4), &[]);
        assert!(sides(&s, &found, 0, &["all"; 4]).is_none());
    }
}
