//! What the model that is diagnosed already has of errors of sensors and actuators and of weather, as a diagnosis before it has written
//! them there. They count as selected, so that the answer to a model does not change once the model contains it.

use super::screen::Screen;
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::likelihood::algebra::{pick, pseudo_inverse};
use crate::likelihood::estimate::{Estimate, FreeParameter};
use crate::physics::{Kind, Mechanism};
use nalgebra::DVector;

/// A mechanism that the base model contains.
pub struct Present {
    /// Index into the candidates.
    pub candidate: usize,
    /// Squared distance of its amplitudes from zero in units of their covariance: what a test would gain by it if it were missing.
    pub statistic: f64,
}

/// The mechanisms that an estimate of the base model contains. The ship's own physics belongs to every model, and what acts through a
/// recorded input to every model of that ship: whether a diagnosis found them cannot be seen, so neither counts.
pub fn present(screen: &Screen, estimate: &Estimate, candidates: &[Candidate]) -> Vec<Present> {
    let sessions: Vec<String> = screen.evidence.sessions.keys().cloned().collect();
    let statistic = |i: usize| {
        let extents = [Extent::All, Extent::Each(sessions.clone())];
        extents.iter().map(|extent| distance(screen, estimate, i, &candidates[i], extent)).sum::<f64>()
    };
    (0..candidates.len())
        .filter(|i| counts(candidates[*i].mechanism))
        .map(|candidate| Present { candidate, statistic: statistic(candidate) })
        .filter(|p| p.statistic > 0.0)
        .collect()
}

/// Whether a mechanism is no part of the ship.
fn counts(m: &Mechanism) -> bool {
    matches!(m.kind, Kind::Sensor | Kind::Actuator) || m.is_weather()
}

/// The squared distance of a mechanism's values from zero where it acts, in units of their covariance.
fn distance(screen: &Screen, estimate: &Estimate, index: usize, c: &Candidate, extent: &Extent) -> f64 {
    let own: Vec<FreeParameter> = c.parameters(extent);
    let value = DVector::from_iterator(own.len(), own.iter().map(|f| f.value(&estimate.model) / f.column.scale));
    if own.is_empty() || value.amax() == 0.0 {
        return 0.0;
    }
    // What is free has its covariance in the base; a score test beside the same free parameter would show nothing.
    let places = c.positions(&estimate.free, extent);
    let covariance = if places.len() == own.len() {
        pick(&screen.base.inverse, &places, &places)
    } else {
        screen.test(index, extent).covariance
    };
    (value.transpose() * pseudo_inverse(&covariance) * &value)[(0, 0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{RK4, at, erring, model, runs, with};
    use crate::diagnose::search::screen::screen;
    use crate::model::Model;
    use crate::recording::Run;

    /// What a model contains, by name, with its statistic and that of a test of the same amount missing from the plain model.
    fn held(base: &Model, runs: &[Run]) -> Vec<(&'static str, f64, f64)> {
        let list = candidates(base, &[]);
        let screened = |m: &Model| screen(&at(m), RK4, runs, &list);
        let (own, plain) = (screened(base), screened(&model()));
        let missing = |i: usize| plain.rows.iter().find(|r| r.candidate == i).map_or(0.0, |r| r.pooled.statistic);
        let all = present(&own, &at(base), &list);
        all.iter().map(|p| (list[p.candidate].mechanism.name, p.statistic, missing(p.candidate))).collect()
    }

    #[test]
    fn a_model_contains_the_clock_and_the_current_that_were_put_into_it_with_what_a_test_would_gain_by_them() {
        assert!(held(&model(), &runs(&model(), 6)).is_empty());
        let clock = [("time_skew.heading", 0.5)];
        let truth = with(&[("current.north", 0.02)]);
        for (base, runs, name) in
            [(with(&clock), erring(&clock, 6), "time_skew"), (truth.clone(), runs(&truth, 6), "current")]
        {
            let found = held(&base, &runs);
            assert_eq!(found.len(), 1, "{found:?}");
            let (own, statistic, missing) = found[0];
            assert!(own == name && (0.5..2.0).contains(&(statistic / missing)), "{found:?}");
        }
    }

    #[test]
    fn what_is_free_in_the_model_and_what_acts_in_one_session_only_is_present_and_the_ship_itself_is_not() {
        let clock = [("time_skew.heading", 0.5)];
        let (mut base, runs) = (with(&clock), erring(&clock, 6));
        let statistic = |m: &Model| held(m, &runs).first().map(|h| h.1);
        let fixed = statistic(&base).unwrap();
        let heading = base.find("time_skew.heading").unwrap();
        for name in ["time_skew.heading", "time_skew.position"] {
            let i = base.find(name).unwrap();
            base.parameters[i].free = true;
        }
        let free = statistic(&base).unwrap();
        assert!((0.5..2.0).contains(&(free / fixed)), "{free} {fixed}");
        let mut single = model();
        single.sessions.insert(runs[0].session.clone(), vec![(heading, 0.5)]);
        // One of two sessions with the clock of both has part of what both have.
        let part = statistic(&single).unwrap();
        assert!(part > 0.0 && part < fixed, "{part} {fixed}");
        assert!(
            held(
                &with(&[("rudder.lift1", 0.9 * model().parameters[model().find("rudder.lift1").unwrap()].value)]),
                &runs
            )
            .is_empty()
        );
    }
}
