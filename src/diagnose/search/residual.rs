//! What the model with the selected mechanisms leaves unexplained, and the table of every test that the verdict turns on.
//! It tests and collects; the verdict on the table is made elsewhere.

use super::alike::class;
use super::base::Question;
use super::decide::{Decision, MechanismTest, PlaceTest, PushTest, ResidualTests, TestTable};
use super::screen::{Screen, screen};
use super::select::Selection;
use super::selected::Selected;
use crate::diagnose::evidence::locate::{Location, locate};
use crate::diagnose::evidence::place::Place;
use crate::diagnose::evidence::push::PUSH;
use crate::diagnose::evidence::push::{Push, sharpened};
use crate::likelihood::estimate::Estimate;
use crate::recording::Run;

/// The tests of what the selected mechanisms leave.
pub struct Left {
    /// The score tests of all mechanisms at the estimate.
    pub screen: Screen,
    /// Where unknown forces act.
    pub location: Location,
}

/// The selected mechanisms with the tests of what they leave.
pub struct Residual {
    /// The mechanisms.
    pub selection: Selection,
    /// What they leave; `None` without any.
    pub left: Option<Left>,
}

impl Residual {
    /// Tests what the selected mechanisms leave, as the base model was tested.
    pub fn new(question: &Question, mut selection: Selection) -> Self {
        (question.progress)("checking what is left");
        let latest = selection.latest.take();
        let (tests, found) = (&selection.tests, &selection.estimate);
        let left = (!selection.mechanisms.is_empty()).then(|| {
            let again = || screen(found, tests.fit.integration, &tests.fit.runs, &tests.candidates);
            let screen = latest.unwrap_or_else(again);
            let mut location = locate(found, tests.fit.integration, &tests.fit.runs);
            location.push = tests.search.event(&location.pushes);
            Left { screen, location }
        });
        let classes: Vec<_> =
            selection.mechanisms.iter().map(|m| class(m, found, &tests.screen, &tests.candidates)).collect();
        for (mechanism, class) in selection.mechanisms.iter_mut().zip(classes) {
            mechanism.widen(class, &selection.tests.candidates);
        }
        Self { selection, left }
    }

    /// Every test that the verdict turns on.
    pub fn table(&self, question: &Question) -> TestTable {
        let Selection { tests, push, mechanisms, .. } = &self.selection;
        let admission = &tests.fit.admission;
        let test = |a: &Selected| {
            let m = tests.candidates[a.candidate].mechanism;
            MechanismTest { kind: m.kind, weather: m.is_weather(), statistic: a.statistic, set_size: a.set.len() }
        };
        let hull = &tests.fit.estimate.model.ship.hull;
        let speed = mean_speed(&tests.fit.runs);
        let [surge, sway, _] = self.selection.estimate.noise.mean_force(hull.lpp / speed);
        TestTable {
            audit_blocks: tests.is_blocked(),
            euler_gain: admission.euler_gain,
            runs: tests.fit.runs.len(),
            samples: admission.samples,
            unknown_force: surge.max(sway),
            turning_force: hull.mass * speed * speed / hull.lpp,
            chance: tests.search.chance,
            push_allowed: question.settings.allows(PUSH),
            push_in_base: push.as_ref().map(PushTest::from),
            base: residual_tests(&tests.screen, &tests.location),
            mechanisms: mechanisms.iter().filter(|m| !m.carried).map(test).collect(),
            selected: self.left.as_ref().map(|l| residual_tests(&l.screen, &l.location)),
        }
    }

    /// What is kept of it by a decision.
    pub fn decided(self, decision: &Decision) -> Kept {
        let Self { mut selection, left } = self;
        let place = left.as_ref().and_then(|l| l.location.place.clone());
        let left = left.filter(|_| decision.keeps_mechanisms);
        if !decision.keeps_mechanisms {
            selection.mechanisms.clear();
            selection.estimate = selection.tests.fit.estimate.clone();
        }
        let location = left.as_ref().map_or(&selection.tests.location, |l| &l.location);
        let push = selection.push.take().or_else(|| location.push.clone()).filter(|_| decision.names_push);
        let fit = &selection.tests.fit;
        let push = push.map(|p| sharpened(&p, &selection.estimate, fit.integration, &fit.runs));
        Kept { selection, left, push, place }
    }
}

impl Kept {
    /// The selection without one of its mechanisms, at the estimate without it, tested anew. `push` is that of the selection.
    pub fn without(self, question: &Question, index: usize, estimate: Estimate, push: Option<Push>) -> Residual {
        let mut selection = Selection { push, estimate, ..self.selection };
        selection.mechanisms.remove(index);
        Residual::new(question, selection)
    }

    /// Whether the mechanisms that stay in the model without being named are those that are `carried`.
    pub fn is_marked(&self, carried: &[bool]) -> bool {
        self.selection.mechanisms.iter().zip(carried).all(|(m, c)| m.carried == *c)
    }

    /// The selection with those marked that stay in the model without being named, with the tests of what they leave as they are. `push` is
    /// that of the selection.
    pub fn marked(self, carried: &[bool], push: Option<Push>) -> Residual {
        let mut selection = Selection { push, ..self.selection };
        for (mechanism, carried) in selection.mechanisms.iter_mut().zip(carried) {
            mechanism.carried = *carried;
        }
        Residual { selection, left: self.left }
    }

    /// What the mechanisms that are named leave; `None` where none is.
    pub fn left_by_named(&self) -> Option<&Left> {
        self.left.as_ref().filter(|_| self.selection.mechanisms.iter().any(|m| !m.carried))
    }
}

/// What a decision keeps of the selected mechanisms, and what is named beside them.
pub struct Kept {
    /// The mechanisms; none where they were refuted.
    pub selection: Selection,
    /// What they leave; `None` without any.
    pub left: Option<Left>,
    /// The push that is named.
    pub push: Option<Push>,
    /// Whether an earth-fixed force differs from place to place beside the mechanisms, refuted ones included.
    pub place: Option<Place>,
}

/// The tests of what a model leaves, from a screen and a location at it.
fn residual_tests(s: &Screen, location: &Location) -> ResidualTests {
    ResidualTests {
        asymmetric_p: s.asymmetric_test.p,
        asymmetric_gain: s.asymmetric_gain(),
        push: location.push.as_ref().map(PushTest::from),
        place: location.place.as_ref().map(|p| PlaceTest { statistic: p.statistic, degrees: p.degrees, p: p.p }),
    }
}

/// Mean speed of the ship through all samples \[m/s\].
fn mean_speed(runs: &[Run]) -> f64 {
    let (mut speed, mut count) = (0.0, 0.0);
    for r in runs {
        let mut surge = r.measured.iter().filter_map(|s| s[3]).peekable();
        if surge.peek().is_none() {
            speed += r.mean_speed() * r.measured.len() as f64;
            count += r.measured.len() as f64;
        }
        for u in surge {
            speed += u.abs();
            count += 1.0;
        }
    }
    speed / f64::max(count, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{SAMPLES, model, runs, with};
    use crate::diagnose::search::base::{AuditedRuns, BaseFit};
    use crate::diagnose::search::decide::{Verdict, decide};
    use crate::diagnose::search::event::{BaseTests, Opening};
    use crate::diagnose::settings::Settings;
    use crate::model::Model;

    #[test]
    fn the_mean_speed_is_that_of_all_samples_whatever_its_sign() {
        let mut runs = runs(&model(), 2);
        runs.iter_mut().flat_map(|r| &mut r.measured).for_each(|m| m[3] = Some(-2.0));
        runs[0].measured[3][3] = None;
        assert!((mean_speed(&runs) / 2.0 - 1.0).abs() < 1e-12);
    }

    fn residual(question: &Question, truth: &Model) -> Residual {
        let audited = AuditedRuns::new(runs(truth, 12), truth.ship.hull.lpp);
        let tests = BaseTests::new(question, BaseFit::new(question, audited));
        Residual::new(question, Selection::new(question, Opening { tests, push: None, first: None }))
    }

    #[test]
    fn the_table_lists_what_was_selected_and_a_refuted_selection_leaves_the_base_model() {
        let (model, settings) = (model(), Settings { nuisance: false, ..Settings::default() });
        let question = Question { model: &model, full: model.clone(), settings: &settings, progress: &|_| () };
        let residual = residual(&question, &with(&[("current.north", 0.3)]));
        let table = residual.table(&question);
        assert_eq!((table.runs, table.samples, table.audit_blocks), (12, 12 * SAMPLES, false));
        assert!(table.mechanisms.len() == 1 && table.mechanisms[0].weather && table.mechanisms[0].statistic > 100.0);
        // What the current explains is no longer left.
        let left = table.selected.map_or(f64::NAN, |s| s.asymmetric_gain);
        assert!(left < 0.1 * table.base.asymmetric_gain, "{left} {}", table.base.asymmetric_gain);
        let decision = decide(&table);
        assert_eq!((decision.verdict, decision.keeps_mechanisms), (Verdict::Named, true));
        // What stays in the model without being named is in no table, and what it explains is not left.
        let residual = residual.decided(&decision).marked(&[true], None);
        let carrying = residual.table(&question);
        assert!(carrying.mechanisms.is_empty() && residual.selection.carries("current"));
        assert_eq!(carrying.selected.map_or(f64::NAN, |s| s.asymmetric_gain), left);
        assert_eq!(decide(&carrying).verdict, Verdict::NothingMissing);
        let kept = residual.decided(&decide(&carrying));
        assert!(kept.is_marked(&[true]) && !kept.is_marked(&[false]) && kept.left_by_named().is_none());
        let residual = kept.marked(&[false], None);
        let base = residual.selection.tests.fit.estimate.clone();
        let kept = residual.decided(&Decision { keeps_mechanisms: false, ..decision });
        assert!(kept.selection.mechanisms.is_empty() && kept.left.is_none());
        assert_eq!(kept.selection.estimate.log_posterior, base.log_posterior);
    }
}
