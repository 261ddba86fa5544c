//! Which mechanisms of a ranking may be named, alone and beside others, before any of them is refitted.
//! It compares numbers of the score tests with the settings; it estimates nothing.

use super::present::Present;
use super::screen::{Row, Screen};
use super::selected::Selected;
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::settings::{BEYOND_DOUBT, REMAINDER, Settings};
use crate::physics::{Kind, Mechanism};

/// What a mechanism would be named beside.
#[derive(Clone, Copy)]
pub struct Beside<'a> {
    /// What the model had before.
    pub present: &'a [Present],
    /// The mechanisms that were selected.
    pub selected: &'a [Selected],
    /// Whether nothing else was found, neither a push nor a coarse integration step.
    pub nothing_else: bool,
}

impl Beside<'_> {
    /// Whether a mechanism would be the first that is named.
    pub fn is_nothing(&self) -> bool {
        self.nothing_else && self.present.is_empty() && self.selected.is_empty()
    }

    /// Whether a mechanism may be named beside all this, as far as that decides.
    pub fn allows(&self, f: &Further, candidates: &[Candidate]) -> bool {
        self.is_nothing() || may_be_further(f, self, candidates)
    }
}

/// The mechanisms that may be named beside those that were selected, the most significant first.
pub fn eligible<'s>(s: &'s Screen, candidates: &[Candidate], beside: Beside, settings: &Settings) -> Vec<&'s Row> {
    let may = |r: &&Row| may_be_named(r, candidates, settings) && beside.allows(&Further::from(*r), candidates);
    s.rows.iter().filter(may).collect()
}

/// Whether a mechanism may be named: identifiable, significant, of possible sign, and not just the ship's own forces in another
/// form. Whether it is large enough to matter is asked of what it changes in predictions, once it is in a model.
pub fn may_be_named(r: &Row, candidates: &[Candidate], settings: &Settings) -> bool {
    let m = candidates[r.candidate].mechanism;
    r.visible && r.admissible && r.p < significance(m, settings) && r.second_opinion < settings.alpha
}

/// The chance of a false name that a mechanism's test is allowed. Sessions differ in what was sailed, and a ship's forces in
/// another form then differ between them: the ship's own physics must be more significant.
fn significance(m: &Mechanism, settings: &Settings) -> f64 {
    let own = m.needs_reference && m.kind == Kind::Ship;
    if own { settings.strict() } else { settings.alpha }
}

/// What a mechanism that may be named beside others is judged by.
pub struct Further<'a> {
    /// Index into the candidates.
    pub candidate: usize,
    /// Where it acts.
    pub extent: &'a Extent,
    /// The statistic of its test.
    pub statistic: f64,
    /// The corrected p-value.
    pub p: f64,
}

impl<'a> From<&'a Row> for Further<'a> {
    fn from(r: &'a Row) -> Self {
        Self { candidate: r.candidate, extent: &r.extent, statistic: r.test.statistic, p: r.p }
    }
}

/// Whether a further mechanism may be named beside those that the model had and those that were selected: it must be beyond doubt, and
/// more than what an imperfect form of an earlier one leaves behind.
pub fn may_be_further(f: &Further, beside: &Beside, candidates: &[Candidate]) -> bool {
    let m = candidates[f.candidate].mechanism;
    // What is exact leaves nothing of itself behind.
    let remainder = |first: usize, statistic: f64| {
        let first = candidates[first].mechanism;
        let exact = m.is_kinematic() && first.is_kinematic();
        m.looks_like(first) && !exact && f.statistic < REMAINDER * statistic
    };
    let left_by = |a: &Selected| {
        // Changes of the ship's own forces between sessions: the form of the first cannot be distinguished from a second.
        let between_sessions = a.extent != Extent::All && *f.extent != Extent::All;
        (between_sessions && m.needs_reference && candidates[a.candidate].mechanism.needs_reference)
            || remainder(a.candidate, a.statistic)
    };
    f.p < BEYOND_DOUBT
        && beside.selected.iter().all(|a| a.candidate != f.candidate && !left_by(a))
        && beside.present.iter().all(|p| !remainder(p.candidate, p.statistic))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example;
    use crate::likelihood::evidence::Test;
    use nalgebra::{DMatrix, DVector};

    fn list() -> Vec<Candidate> {
        let model = example::model();
        ["current", "mean_wind", "earth_force", "heading_bias"].map(|n| example::candidate(&model, n)).into()
    }

    /// A row that may be named.
    fn row(candidate: usize, statistic: f64) -> Row {
        let test = Test {
            statistic,
            degrees: 2,
            p: 1e-12,
            amplitude: DVector::zeros(2),
            covariance: DMatrix::identity(2, 2),
            retained: 1.0,
        };
        Row {
            candidate,
            pooled: test.clone(),
            extent: Extent::All,
            test,
            p: 1e-12,
            admissible: true,
            visible: true,
            second_opinion: 1e-6,
        }
    }

    fn selected(candidate: usize, statistic: f64) -> Selected {
        let (set, why) = (vec![candidate], String::new());
        Selected { candidate, extent: Extent::All, statistic, p: 0.0, set, why, carried: false }
    }

    #[test]
    fn a_mechanism_must_be_identifiable_significant_possible_and_more_than_another_form() {
        let (list, settings) = (list(), Settings::default());
        let may = |r: &Row| may_be_named(r, &list, &settings);
        assert!(may(&row(0, 60.0)));
        assert!(may(&Row { p: 0.0099, ..row(0, 60.0) }) && !may(&Row { p: 0.01, ..row(0, 60.0) }));
        assert!(!may(&Row { admissible: false, ..row(0, 60.0) }));
        assert!(!may(&Row { visible: false, ..row(0, 60.0) }));
        assert!(!may(&Row { second_opinion: 0.01, ..row(0, 60.0) }));
    }

    #[test]
    fn physics_of_the_ship_that_needs_a_reference_session_must_be_a_hundred_times_as_significant() {
        let model = example::model();
        let all = crate::diagnose::evidence::candidate::candidates(&model, &[]);
        let own = |c: &Candidate| c.mechanism.needs_reference && c.mechanism.kind == Kind::Ship;
        let (settings, index) = (Settings::default(), all.iter().position(own).unwrap());
        let may = |p: f64| may_be_named(&Row { p, ..row(index, 60.0) }, &all, &settings);
        assert!(may(0.000099) && !may(0.000101));
    }

    #[test]
    fn a_further_mechanism_must_be_beyond_doubt_another_and_no_remainder_of_a_look_alike() {
        let list = list();
        let may = |r: &Row, selected: &[Selected]| {
            may_be_further(&Further::from(r), &Beside { present: &[], selected, nothing_else: true }, &list)
        };
        assert!(may(&row(0, 60.0), &[]) && !may(&Row { p: 1e-6, ..row(0, 60.0) }, &[]));
        assert!(!may(&row(0, 60.0), &[selected(0, 10.0)]));
        // Mean wind and a force fixed on the earth look alike, a compass looks like neither.
        assert!(!may(&row(1, 39.0), &[selected(2, 100.0)]) && may(&row(1, 40.0), &[selected(2, 100.0)]));
        assert!(may(&row(3, 39.0), &[selected(2, 100.0)]));
    }

    #[test]
    fn what_the_model_had_counts_as_selected_and_may_yet_be_more_than_it_had() {
        let list = list();
        let present = [Present { candidate: 2, statistic: 100.0 }];
        let beside = Beside { present: &present, selected: &[], nothing_else: true };
        let may = |r: &Row| beside.allows(&Further::from(r), &list);
        assert!(!beside.is_nothing() && !may(&Row { p: 1e-6, ..row(3, 60.0) }));
        assert!(!may(&row(1, 39.0)) && may(&row(1, 40.0)) && may(&row(3, 39.0)) && may(&row(2, 30.0)));
        let none = Beside { present: &[], ..beside };
        assert!(none.is_nothing() && none.allows(&Further::from(&Row { p: 1e-6, ..row(3, 60.0) }), &list));
    }
}
