//! Mechanisms whose effects are alike on the manoeuvres that were sailed, so that they can only be named together.
//! It compares what the manoeuvres would show of each; how well each fits the recordings is compared elsewhere.

use super::screen::Screen;
use super::selected::Selected;
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::settings::{FORM_TOLERANCE, INDISTINGUISHABLE};
use crate::likelihood::estimate::Estimate;
use crate::physics::Kind;
use nalgebra::DVector;

/// The mechanisms that could take over nearly all of the gain of a selected one, the largest share first: once base parameters and
/// nuisances are fitted too, their effects on these manoeuvres differ by no more than the law of a force is known, and those of errors of
/// records and of actuators, whose laws are exact, by no more than can be distinguished. A force without a cause takes over the gain of any
/// other and is not among them.
pub fn class(of: &Selected, found: &Estimate, s: &Screen, candidates: &[Candidate]) -> Vec<(usize, f64)> {
    if of.extent != Extent::All {
        return Vec::new();
    }
    let own = &candidates[of.candidate];
    let places = own.positions(&found.free, &of.extent);
    let value = |i: &usize| found.free[*i].value(&found.model) / found.free[*i].column.scale;
    let amplitude = DVector::from_iterator(places.len(), places.iter().map(value));
    let mut class: Vec<(usize, f64)> = s
        .rows
        .iter()
        .filter(|r| r.candidate != of.candidate && r.visible && r.admissible && r.extent == Extent::All)
        .filter(|r| !candidates[r.candidate].mechanism.stand_in)
        .map(|r| (r.candidate, s.share_taken(of.candidate, &amplitude, r.candidate)))
        .filter(|(rival, share)| {
            let both_exact =
                [own, &candidates[*rival]].iter().all(|c| matches!(c.mechanism.kind, Kind::Sensor | Kind::Actuator));
            let within = if both_exact {
                INDISTINGUISHABLE / (0.5 * of.statistic).max(INDISTINGUISHABLE)
            } else {
                FORM_TOLERANCE
            };
            *share > 1.0 - within.min(FORM_TOLERANCE)
        })
        .collect();
    class.sort_by(|a, b| b.1.total_cmp(&a.1));
    class
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::applies;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{RK4, at, model, runs, with};
    use crate::diagnose::search::screen::screen;
    use crate::recording::{Run, measured};
    use crate::simulate::{Scenario, simulate};

    fn selected(candidates: &[Candidate], name: &str) -> Selected {
        let candidate = candidates.iter().position(|c| c.mechanism.name == name).unwrap();
        let (set, why) = (vec![candidate], "alone".into());
        Selected { candidate, extent: Extent::All, statistic: 0.0, p: 0.0, set, why, carried: false }
    }

    /// The names alike to a current in these runs.
    fn alike_to_a_current(runs: &[Run]) -> Vec<&'static str> {
        let model = with(&[("current.north", 0.3)]);
        let mut list = candidates(&model, &[]);
        list.retain(|c| applies(c.mechanism, runs));
        let mut found = at(&model);
        let mut of = selected(&list, "current");
        found.free.extend(list[of.candidate].parameters(&Extent::All));
        let s = screen(&at(&model), RK4, runs, &list);
        let class = class(&of, &found, &s, &list);
        assert!(class.iter().all(|(_, share)| (0.9..=1.0).contains(share)));
        of.widen(class.clone(), &list);
        assert_eq!(of.set.len(), 1 + class.len());
        assert_eq!(of.why == "alone", class.is_empty());
        class.iter().map(|(i, _)| list[*i].mechanism.name).collect()
    }

    #[test]
    fn on_headings_all_round_a_current_is_alone() {
        let alike = alike_to_a_current(&runs(&model(), 12));
        assert!(alike.is_empty(), "{alike:?}");
    }

    #[test]
    fn a_mechanism_takes_over_all_of_its_own_gain() {
        let model = model();
        let list = candidates(&model, &[]);
        let s = screen(&at(&model), RK4, &runs(&model, 6), &list);
        let current = selected(&list, "current").candidate;
        let share = s.share_taken(current, &DVector::from_column_slice(&[1.0, -0.5]), current);
        assert!((share - 1.0).abs() < 1e-6, "{share}");
    }

    #[test]
    fn on_one_straight_course_others_can_take_over_what_a_current_explains() {
        let model = model();
        let mut straight = runs(&model, 6);
        for r in &mut straight {
            r.inputs.iter_mut().for_each(|i| (i.n, i.delta) = (2.0, 0.0));
            r.initial = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0];
            let scenario = Scenario { dt: r.dt, inputs: r.inputs.clone(), initial: r.initial };
            r.measured = measured(&simulate(&model, &model.values(), RK4, &scenario).states);
        }
        let alike = alike_to_a_current(&straight);
        assert!(!alike.is_empty(), "{alike:?}");
    }
}
