//! What is free in an estimate: parameters with their priors, bounds and sessions, and the coefficients of a ship that are never known
//! exactly. It estimates nothing.

use super::pass::Column;
use crate::model::{BASE, Model, Prior};
use crate::physics::Form;
use crate::terms::propulsion::actuator::ActuatorTerm;

/// Hull, propeller and rudder coefficients that are never known exactly, carried along with their priors.
pub(crate) const NUISANCE: [&str; 31] = [
    "hull.inertia",
    "hull.Xudot",
    "hull.Yvdot",
    "hull.Yrdot",
    "hull.Nvdot",
    "hull.Nrdot",
    "hull.Xvr",
    "hull.Yv",
    "hull.Yr",
    "hull.Nv",
    "hull.Nr",
    "hull.Yvv",
    "hull.Yvr",
    "hull.Yrr",
    "hull.Nrr",
    "hull.Nrrv",
    "hull.Nvvr",
    "flow.wake",
    "flow.kt0",
    "flow.kt1",
    "flow.astern",
    "flow.wake_ratio",
    "flow.race",
    "flow.race_astern",
    "flow.straightening",
    "flow.asymmetry",
    "flow.lever",
    "crossflow.drag",
    "hull_nonlinear.X_vv",
    "hull_nonlinear.X_rr",
    "sternway.share",
];

/// The coefficients of a model that are never known exactly: in forms `mmg` and `general` those of their terms for those that these replace.
/// A general hull has drag across the flow and further powers by itself: terms that add them to another hull are none of it.
pub(crate) fn uncertain_coefficients(model: &Model) -> Vec<usize> {
    let of_craft = |name: &&&str| !model.lacks_owner(name);
    let listed = NUISANCE
        .iter()
        .filter(of_craft)
        .filter_map(|name| model.index(name))
        .filter(|i| !model.replaced(model.parameters[*i].info))
        .filter(|i| model.form != Form::General || of_terms(&model.parameters[*i].name, &BASE));
    let of_form = |i: &usize| of_terms(&model.parameters[*i].name, model.of_form());
    let of_actuator = |i: &usize| {
        let own = |(name, parameter): (&str, &str)| {
            model.ship.actuator(name).is_some() && ActuatorTerm::is_uncertain(parameter)
        };
        model.parameters[*i].name.split_once('.').is_some_and(own)
    };
    listed.chain((0..model.parameters.len()).filter(|i| of_form(i) || of_actuator(i))).collect()
}

/// Whether a parameter belongs to one of these terms.
fn of_terms(parameter: &str, terms: &[&str]) -> bool {
    parameter.split_once('.').is_some_and(|(term, _)| terms.contains(&term))
}

/// The free parameters of the base: those of the model, and where asked for the nuisance coefficients with their priors.
pub fn base_parameters(model: &Model, nuisance: bool) -> Vec<FreeParameter> {
    let mut free: Vec<FreeParameter> = model
        .free()
        .into_iter()
        .map(|i| FreeParameter::common(Column::tangent(model, i), model.parameters[i].prior))
        .collect();
    if nuisance {
        for i in uncertain_coefficients(model).into_iter().filter(|i| !model.parameters[*i].free) {
            free.push(FreeParameter::uncertain(model, i));
        }
    }
    free
}

/// A free parameter of the estimate.
#[derive(Clone, Debug)]
pub struct FreeParameter {
    /// Its column.
    pub column: Column,
    /// Sessions in which it acts, added there to the common value; `None` for all of them.
    pub sessions: Option<Vec<String>>,
    /// What is known of it beforehand \[unit of the parameter\].
    pub prior: Option<Prior>,
}

impl FreeParameter {
    /// A parameter that acts in every run.
    pub fn common(column: Column, prior: Option<Prior>) -> Self {
        Self { column, sessions: None, prior }
    }

    /// A coefficient that is not known exactly: common to all runs, its value the mean and its spread (its scale where it has
    /// none) the standard deviation of its prior.
    pub fn uncertain(model: &Model, parameter: usize) -> Self {
        let p = &model.parameters[parameter];
        let spread = (p.info.spread)(&model.ship);
        let sd = if spread.is_finite() { spread } else { p.scale };
        Self::common(Column::tangent(model, parameter), Some(Prior { mean: p.value, sd }))
    }

    /// Its present value \[unit of the parameter\].
    pub fn value(&self, model: &Model) -> f64 {
        let i = self.column.parameter;
        match self.sessions.as_ref().and_then(|s| s.first()) {
            None => model.parameters[i].value,
            Some(first) => {
                model.sessions.get(first).into_iter().flatten().filter(|(j, _)| *j == i).map(|(_, v)| v).sum()
            }
        }
    }

    /// The parameter's least and greatest value, in its own unit. A hull coefficient that is carried with a prior is limited by the
    /// prior alone: a limit on its sign would make its estimate one-sided, and the score tests with it.
    fn limits(&self, model: &Model) -> (f64, f64) {
        let p = &model.parameters[self.column.parameter];
        if self.prior.is_some() && (p.name.starts_with("hull.") || p.name.starts_with("mmg_hull.")) {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        (p.lower, p.upper)
    }

    /// Sets its value, kept inside the parameter's bounds.
    pub fn set(&self, model: &mut Model, value: f64) {
        let i = self.column.parameter;
        let (lower, upper) = self.limits(model);
        let p = &mut model.parameters[i];
        let Some(sessions) = &self.sessions else {
            p.value = value.clamp(lower, upper);
            return;
        };
        let value = (p.value + value).clamp(lower, upper) - p.value;
        for session in sessions {
            let list = model.sessions.entry(session.clone()).or_default();
            match list.iter_mut().find(|(j, _)| *j == i) {
                Some(entry) => entry.1 = value,
                None => list.push((i, value)),
            }
        }
    }

    /// Its least and greatest value, in units of the column.
    pub(crate) fn bounds(&self, model: &Model) -> (f64, f64) {
        let p = &model.parameters[self.column.parameter];
        // An addition in some sessions is bounded by what the sum may be.
        let common = if self.sessions.is_some() { p.value } else { 0.0 };
        let (lower, upper) = self.limits(model);
        let (a, b) = ((lower - common) / self.column.scale, (upper - common) / self.column.scale);
        (a.min(b), a.max(b))
    }

    /// Precision of the prior, and the pull of the prior on the score, in units of the column.
    pub(crate) fn prior_terms(&self, model: &Model) -> (f64, f64) {
        self.prior.map_or((0.0, 0.0), |prior| {
            let precision = (self.column.scale / prior.sd).powi(2);
            let away = (self.value(model) - prior.mean) / self.column.scale;
            (precision, -precision * away)
        })
    }

    /// Logarithm of the prior density at the present value, up to a constant.
    pub(crate) fn log_prior(&self, model: &Model) -> f64 {
        self.prior.map_or(0.0, |prior| -0.5 * ((self.value(model) - prior.mean) / prior.sd).powi(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship::Ship;
    use std::path::Path;

    #[test]
    fn what_no_particulars_say_of_an_actuator_is_estimated_along_and_its_faults_are_not() {
        let text = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n[[actuator]]\nname = \"left\"\nx = -0.4\ny = -0.3\n\
                    law = \"thruster\"\nangle = 0\n";
        let ship = Ship::parse(text, Path::new("ship.toml")).unwrap();
        let model = Model::new(ship, "cat", Form::General, &[]).unwrap();
        let of = |name: &str| {
            let free =
                base_parameters(&model, true).into_iter().find(|f| f.column.parameter == model.index(name).unwrap());
            free.map(|f| f.prior.is_some())
        };
        assert_eq!(["left.loss", "left.astern", "general_hull.surge_linear"].map(of), [Some(true); 3]);
        assert_eq!(of("left.gain"), Some(false));
        assert_eq!(["left.lost", "left.zero", "left.lag", "rudder.lift1"].map(of), [None; 4]);
    }
}
