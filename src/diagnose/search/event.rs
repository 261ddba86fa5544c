//! The tests of the base model, and whether an event in time is put into it before any mechanism is refitted: a strong one
//! inflates the noise and is given the name of a ship's force. Which mechanisms are selected beside it is another step.

use super::base::{BaseFit, Question};
use super::compete::compete;
use super::decide::{Chance, PushTest, form_holds, is_euler};
use super::eligible::{Beside, eligible, may_be_named};
use super::present::{Present, present};
use super::problem::Problem;
use super::screen::{Screen, screen};
use super::selected::Selected;
use crate::diagnose::evidence::candidate::{Candidate, applies, candidates};
use crate::diagnose::evidence::locate::{Location, locate, pushes_left};
use crate::diagnose::evidence::push::PUSH;
use crate::diagnose::evidence::push::Push;
use crate::diagnose::settings::{SETTLE, Settings};
use crate::likelihood::estimate::{Estimate, calm_noise};
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::recording::Run;
use crate::recording::audit::Issue;
use crate::simulate::Integration;

/// The base model with every test of what it lacks.
pub struct BaseTests {
    /// Its fit.
    pub fit: BaseFit,
    /// The mechanisms that these recordings can show.
    pub candidates: Vec<Candidate>,
    /// Where unknown forces act.
    pub location: Location,
    /// The score tests of all mechanisms.
    pub screen: Screen,
    /// How pushes are sought.
    pub search: PushSearch,
}

impl BaseTests {
    /// Locates unknown forces and tests every mechanism.
    pub fn new(question: &Question, fit: BaseFit) -> Self {
        let mut candidates = candidates(&question.full, &question.settings.withhold);
        candidates.retain(|c| applies(c.mechanism, &fit.runs));
        let BaseFit { estimate, runs, integration, prior, .. } = &fit;
        (question.progress)("locating unknown forces");
        let mut location = locate(estimate, *integration, runs);
        (question.progress)("testing every mechanism");
        let screen = screen(estimate, *integration, runs, &candidates);
        let alpha = question.settings.alpha;
        let chance = Chance { alpha, form_holds: form_holds(screen.symmetric_test.p, alpha) };
        let search = PushSearch { chance, integration: *integration, prior: *prior, noise: estimate.noise };
        location.push = if chance.form_holds { search.push(estimate, runs) } else { search.event(&location.pushes) };
        Self { candidates, location, screen, search, fit }
    }

    /// What every refit shares.
    pub fn problem<'a>(&'a self, settings: &'a Settings) -> Problem<'a> {
        let BaseFit { runs, integration, prior, .. } = &self.fit;
        Problem { integration: *integration, runs, candidates: &self.candidates, prior, settings }
    }

    /// What the base model has of errors of sensors and actuators and of weather.
    pub fn present(&self) -> Vec<Present> {
        present(&self.screen, &self.fit.estimate, &self.candidates)
    }

    /// Whether the audit found a unit or a sign that is wrong.
    pub fn is_blocked(&self) -> bool {
        self.fit.admission.issues.iter().any(Issue::blocking)
    }

    /// The tests with the windows of a push disturbed: there the unknown force may be anything.
    fn disturbed(mut self, push: &Push, settings: &Settings) -> Self {
        for w in &push.windows {
            self.fit.runs[w.index].disturbed.push(w.samples);
        }
        self.fit.estimate = self.problem(settings).again(&self.fit.estimate, SETTLE);
        self.fit.within = None;
        let BaseFit { estimate, runs, integration, .. } = &self.fit;
        self.screen = screen(estimate, *integration, runs, &self.candidates);
        self.location.regions = locate(estimate, *integration, runs).regions;
        self
    }
}

/// How pushes are sought in what a model leaves.
#[derive(Clone, Copy)]
pub struct PushSearch {
    /// What the test of a push is compared with.
    pub chance: Chance,
    integration: Integration,
    prior: NoisePrior,
    /// Noise of the base model before any push.
    noise: Noise,
}

impl PushSearch {
    /// The strongest push that is an event, or else the strongest, of pushes of which the strongest is first.
    pub fn event(&self, pushes: &[Push]) -> Option<Push> {
        let is_event = |p: &&Push| PushTest::from(*p).is_event(self.chance);
        pushes.iter().find(is_event).or(pushes.first()).cloned()
    }

    /// The push that an estimate leaves. An event inflates the noise that it is tested against; where the ship's own forces have
    /// the model's form, calmer runs give a better estimate of the noise.
    fn push(&self, found: &Estimate, runs: &[Run]) -> Option<Push> {
        let Estimate { model, noise, .. } = found;
        let calm = || calm_noise(model, noise, self.integration, runs, &self.prior);
        let noise = if self.chance.form_holds { calm() } else { self.noise };
        self.event(&pushes_left(&Estimate { noise, seen: None, ..found.clone() }, self.integration, runs))
    }
}

impl From<&Push> for PushTest {
    fn from(p: &Push) -> Self {
        Self { statistic: p.statistic, across: p.sideways, mirrored: p.mirrored, recordings: p.recordings() }
    }
}

/// What is found before mechanisms are selected one after the other.
pub struct Opening {
    /// The tests of the base model, a push in it where one is found first.
    pub tests: BaseTests,
    /// That push.
    pub push: Option<Push>,
    /// The first mechanism, where one explains the push that would have been found first.
    pub first: Option<(Selected, Estimate)>,
}

impl Opening {
    /// Puts the strongest push into the base model where it gains more than any mechanism and any smooth force law, and no
    /// mechanism explains it.
    pub fn new(question: &Question, tests: BaseTests) -> Self {
        let settings = question.settings;
        let may_be = |r: &&_| may_be_named(r, &tests.candidates, settings);
        let mechanism = tests.screen.rows.iter().find(may_be).map_or(0.0, |r| r.test.statistic);
        let enters =
            |p: &&Push| PushTest::from(*p).enters_first(tests.search.chance, mechanism, tests.screen.asymmetric_gain());
        let may_push = !tests.is_blocked() && settings.allows(PUSH);
        let Some(push) = tests.location.push.as_ref().filter(|p| may_push && enters(p)).cloned() else {
            return Self { tests, push: None, first: None };
        };
        let problem = tests.problem(settings);
        let rival = if is_euler(tests.fit.admission.euler_gain) {
            None
        } else {
            let present = tests.present();
            let beside = Beside { present: &present, selected: &[], nothing_else: true };
            let leaders = eligible(&tests.screen, &tests.candidates, beside, settings);
            let estimate = &tests.fit.estimate;
            let given = Some(&question.full);
            compete(&tests.screen, &leaders, beside, given, estimate, problem, question.progress)
        };
        let left =
            |(_, found): &(Selected, Estimate)| tests.search.push(found, problem.runs).map_or(0.0, |p| p.statistic);
        if rival.as_ref().is_some_and(|r| PushTest::from(&push).is_explained(left(r))) {
            return Self { tests, push: None, first: rival };
        }
        Self { tests: tests.disturbed(&push, settings), push: Some(push), first: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::push::Window;
    use crate::diagnose::example::{model, noise, runs};
    use crate::diagnose::search::base::AuditedRuns;
    use crate::model::Model;

    fn window(index: usize, samples: (usize, usize)) -> Window {
        Window {
            run: format!("run {index}"),
            session: "a".into(),
            start: 0.0,
            end: 1.0,
            force: [0.0; 3],
            error: [1.0; 3],
            statistic: 100.0,
            p: 0.0,
            index,
            samples,
        }
    }

    fn push(statistic: f64, recordings: usize) -> Push {
        Push {
            force: [0.0, 1e4, 0.0],
            error: [1e2; 3],
            statistic,
            sideways: 0.9,
            mirrored: 0.0,
            windows: (0..recordings).map(|i| window(i, (10, 20))).collect(),
        }
    }

    fn tests(model: &Model, settings: &Settings) -> BaseTests {
        let question = Question { model, full: model.clone(), settings, progress: &|_| () };
        let audited = AuditedRuns::new(runs(model, 6), model.ship.hull.lpp);
        BaseTests::new(&question, BaseFit::new(&question, audited))
    }

    #[test]
    fn an_event_comes_before_a_stronger_push_that_cannot_be_one() {
        let search = PushSearch {
            chance: Chance { alpha: 0.01, form_holds: true },
            integration: Integration::default(),
            prior: NoisePrior::around(&noise()),
            noise: noise(),
        };
        let model = model();
        let found = Estimate { model, noise: noise(), free: Vec::new(), log_posterior: 0.0, seen: None };
        let mut location = locate(&found, Integration::default(), &runs(&found.model, 2));
        location.pushes = vec![push(200.0, 2), push(60.0, 5)];
        assert_eq!(search.event(&location.pushes).map(|p| p.statistic), Some(60.0));
        location.pushes.pop();
        assert_eq!(search.event(&location.pushes).map(|p| p.statistic), Some(200.0));
        location.pushes.clear();
        assert!(search.event(&location.pushes).is_none());
    }

    #[test]
    fn nothing_enters_the_base_model_first_where_nothing_is_missing() {
        let (model, settings) = (model(), Settings { nuisance: false, ..Settings::default() });
        let question = Question { model: &model, full: model.clone(), settings: &settings, progress: &|_| () };
        let opening = Opening::new(&question, tests(&model, &settings));
        assert!(opening.push.is_none() && opening.first.is_none());
        assert!(opening.tests.fit.runs.iter().all(|r| r.disturbed.is_empty()));
    }

    #[test]
    fn a_strong_push_enters_the_base_model_with_its_windows_disturbed_unless_it_is_withheld() {
        let mut settings = Settings { nuisance: false, ..Settings::default() };
        let model = model();
        let of = |settings: &Settings| {
            let question = Question { model: &model, full: model.clone(), settings, progress: &|_| () };
            let mut tests = tests(&model, settings);
            tests.location.push = Some(push(1e4, 5));
            Opening::new(&question, tests)
        };
        let opening = of(&settings);
        assert_eq!(opening.push.map(|p| p.statistic), Some(1e4));
        let disturbed: Vec<usize> = opening.tests.fit.runs.iter().map(|r| r.disturbed.len()).collect();
        assert_eq!(disturbed, [1, 1, 1, 1, 1, 0]);
        settings.withhold.push(PUSH.into());
        assert!(of(&settings).push.is_none());
    }
}
