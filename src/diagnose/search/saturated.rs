//! The errors of sensors that only the dynamics show, by the saturated model: every error estimated along with the ship under its prior, and
//! the noise with them. Noise and rudder of a base model that lacks an error take it up (a compass that is off makes a rudder that is off),
//! and no test at that base and under that noise is significant; nothing hides in the noise of the saturated model, as Mallows' C_p takes its
//! variance from the model with everything in it (Mallows 1973, Technometrics 15, p. 661).
//! It proposes where refits start; whether one confirms an error is decided elsewhere.

use super::eligible::{Beside, Further};
use super::problem::Problem;
use super::together::Leading;
use crate::diagnose::evidence::candidate::Extent;
use crate::diagnose::evidence::generic::GenericLaw;
use crate::diagnose::evidence::wald::Wald;
use crate::diagnose::law::sparse::select;
use crate::diagnose::settings::{
    BEYOND_DOUBT, IDENTIFIABLE_SHARE, INDISTINGUISHABLE, PARAMETER_PRICE, REFIT, REMAINDER, RIVAL_GAP, RIVALS,
    SENSOR_SPREAD, SETTLE,
};
use crate::likelihood::estimate::{Estimate, FreeParameter, Sums, base_of, restrictions};
use crate::likelihood::evidence::chi_squared_p;
use crate::likelihood::filter::{Column, Filter};
use crate::model::Prior;
use crate::physics::Probe;
use crate::statistics::corrected;
use nalgebra::DVector;

/// The errors of sensors without which, and with all others zero, the saturated model would lose significantly more than with them: those of
/// most gain first, each with a model, a noise and what is free for a refit to start from. None where all errors together gain nothing. No test at the
/// base shows them, and another optimum of the base may gain as chance does not: only what is beyond doubt is proposed.
///
/// With the estimates theta of all errors and their covariance C, keeping the error e alone loses
///
/// ```text
/// theta_R' C_RR^-1 theta_R / 2,   R = all errors but e
/// ```
///
/// in log-likelihood; with R = all errors it is what they gain together.
pub fn hidden(current: &Estimate, problem: Problem, beside: Beside) -> Vec<Leading> {
    let candidates = problem.candidates;
    let errors = problem.sensor_errors(current);
    let Saturated { found, places } = Saturated::new(current, problem, &errors);
    if found.log_posterior - current.log_posterior < INDISTINGUISHABLE {
        return Vec::new();
    }
    let held = current.free.len()..found.free.len();
    let all = Wald::at(&found, problem.integration, problem.runs);
    let lost = |kept: &[usize]| {
        let rest: Vec<usize> = held.clone().filter(|i| !kept.contains(i)).collect();
        let before = rest.iter().map(|i| found.free[*i].value(&current.model) / found.free[*i].column.scale);
        let before = DVector::from_iterator(rest.len(), before);
        if rest.is_empty() { 0.0 } else { all.part(&rest).less(&before).statistic() }
    };
    let together = lost(&[]);
    let gained = |(candidate, places): (usize, &Vec<usize>)| {
        let statistic = together - lost(places);
        let p = corrected(chi_squared_p(statistic.max(0.0), places.len()), errors.len() as f64);
        let further = Further { candidate, extent: &Extent::All, statistic, p };
        let may_be = p < BEYOND_DOUBT && beside.allows(&further, candidates);
        may_be.then(|| (candidate, places.clone(), statistic, p))
    };
    let mut gained: Vec<_> = errors.iter().copied().zip(&places).filter_map(gained).collect();
    gained.sort_by(|a, b| b.2.total_cmp(&a.2));
    gained.truncate(RIVALS);
    // One whose gain is far below that of the first does not overtake it.
    let most = gained.first().map_or(0.0, |first| first.2);
    gained.retain(|one| one.2 > most - f64::max(RIVAL_GAP, REMAINDER * most));
    let start = |(candidate, places, statistic, p): (usize, Vec<usize>, f64, f64)| {
        let c = &candidates[candidate];
        let mut model = current.model.clone();
        let own = places.iter().map(|i| &found.free[*i]);
        current.free.iter().chain(own).for_each(|f| f.set(&mut model, f.value(&found.model)));
        let amplitude = c.parameters(&Extent::All).into_iter().map(|f| f.value(&model) / f.column.scale);
        let amplitude = DVector::from_iterator(c.columns.len(), amplitude) - c.held(&Extent::All);
        let free = current.free.iter().cloned().chain(c.parameters(&Extent::All)).collect();
        let (set, extent, noise) = (vec![candidate], Extent::All, found.noise);
        Leading { set, extent, amplitude, statistic, p, model, free, noise }
    };
    gained.into_iter().map(start).collect()
}

/// The saturated model.
struct Saturated {
    found: Estimate,
    /// Where the parameters of each error are among the free ones; errors may share some.
    places: Vec<Vec<usize>>,
}

impl Saturated {
    fn new(current: &Estimate, problem: Problem, errors: &[usize]) -> Self {
        let mut free = current.free.clone();
        let mut place = |f: FreeParameter| {
            let same = |other: &FreeParameter| other.column.parameter == f.column.parameter;
            free.iter().position(same).unwrap_or_else(|| {
                let p = &current.model.parameters[f.column.parameter];
                let prior = Prior { mean: p.value, sd: SENSOR_SPREAD * p.scale };
                free.push(FreeParameter { prior: Some(prior), ..f });
                free.len() - 1
            })
        };
        let of = |i: &usize| problem.candidates[*i].parameters(&Extent::All).into_iter().map(&mut place).collect();
        let places = errors.iter().map(of).collect();
        let found = problem.estimate(&current.model, &free, &current.noise, SETTLE);
        Self { found, places }
    }
}

/// By how much in log-likelihood an error that a refit found explains the recordings better than any law of a force in its place, both under
/// the noise of that refit: what a force may explain as well is no evidence for a sensor. The law has the monomials that the recordings ask for,
/// and is refitted; parameters pay their price. Nought for an error that the ship's own parameters can take over.
pub fn over_any_force(found: &Estimate, candidate: usize, extent: &Extent, problem: Problem) -> f64 {
    let Problem { candidates, integration, runs, .. } = problem;
    let c = &candidates[candidate];
    let (model, free) = c.removed(found, extent);
    let base = problem.estimate(&model, &free, &found.noise, REFIT);
    let mut columns: Vec<Column> = free.iter().map(|f| f.column).collect();
    let own: Vec<usize> = (columns.len()..columns.len() + c.columns.len()).collect();
    columns.extend(&c.columns);
    let law = GenericLaw::append(&mut columns, &base.model);
    let filter = Filter::new(&base.model, integration, &columns);
    let evidence = Sums::of(&filter, runs, &found.noise, &restrictions(&free), false).evidence;
    let block = base_of(&evidence, &base.model, &free);
    if evidence.test(&block, &own).retained < IDENTIFIABLE_SHARE {
        return 0.0;
    }
    let recordings: Vec<&str> = runs.iter().map(|r| r.recording.as_str()).collect();
    let chosen = select(&evidence, &block, &law.columns(), &recordings);
    let few =
        chosen.iter().map(|column| FreeParameter::common(Column { probe: Probe::Tangent, ..columns[*column] }, None));
    let few: Vec<FreeParameter> = free.into_iter().chain(few).collect();
    let refitted = problem.estimate(&base.model, &few, &found.noise, REFIT).log_posterior - base.log_posterior;
    let price = |parameters: usize| PARAMETER_PRICE * parameters as f64;
    found.log_posterior - base.log_posterior - price(c.columns.len()) - (refitted - price(chosen.len())).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{RK4, at, erring, model, runs};
    use crate::diagnose::settings::Settings;
    use crate::likelihood::noise::NoisePrior;
    use crate::recording::Run;

    const NOTHING: Beside = Beside { present: &[], selected: &[], nothing_else: true };

    /// What is proposed first for runs whose sway nobody measured, with its size, and by how much it is better than any force.
    fn proposed(mut runs: Vec<Run>) -> Option<(&'static str, f64, f64)> {
        runs.iter_mut().flat_map(|r| &mut r.measured).for_each(|m| m[4] = None);
        let (model, settings) = (model(), Settings::default());
        let list = candidates(&model, &[]);
        let prior = NoisePrior::around(&at(&model).noise);
        let problem = Problem { integration: RK4, runs: &runs, candidates: &list, prior: &prior, settings: &settings };
        let base = problem.again(&at(&model), SETTLE);
        let first = hidden(&base, problem, NOTHING).into_iter().next()?;
        let c = &list[first.set[0]];
        let refit = problem.estimate(&first.model, &first.free, &first.noise, SETTLE);
        let over = over_any_force(&refit, first.set[0], &Extent::All, problem);
        Some((c.mechanism.name, c.parameters(&Extent::All)[0].value(&refit.model), over))
    }

    #[test]
    fn a_compass_that_is_off_is_proposed_at_its_size_where_only_the_dynamics_show_it() {
        let (name, bias, over) = proposed(erring(&[("heading_bias.bias", 0.03)], 12)).unwrap();
        assert_eq!(name, "heading_bias");
        assert!((bias - 0.03).abs() < 0.006 && over > 20.0, "{bias} {over}");
    }

    #[test]
    fn sound_sensors_propose_nothing() {
        assert!(proposed(runs(&model(), 12)).is_none());
    }
}
