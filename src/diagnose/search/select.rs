//! Forward selection of mechanisms, one after the other, with removal of those that a later one makes needless and replacement
//! of those in whose place another explains more. Tests and refits are in other files; the verdict is not made here.

use super::base::Question;
use super::compete::{amplitudes, compare, compete, form_tolerance};
use super::decide::is_euler;
use super::eligible::{Beside, Further, eligible, may_be_further, may_be_named};
use super::event::{BaseTests, Opening};
use super::present::Present;
use super::problem::Problem;
use super::screen::{Row, Screen, screen};
use super::selected::Selected;
use crate::diagnose::evidence::admit::followed;
use crate::diagnose::evidence::push::Push;
use crate::diagnose::evidence::wald::Wald;
use crate::diagnose::settings::{PARAMETER_PRICE, REFIT, SETTLE, Settings};
use crate::likelihood::estimate::{Estimate, passes};
use crate::physics::Kind;

/// The mechanisms that were selected, in the model that contains them.
pub struct Selection {
    /// The tests of the base model.
    pub tests: BaseTests,
    /// The push that was put into the base model.
    pub push: Option<Push>,
    /// The mechanisms, in the order in which they were found.
    pub mechanisms: Vec<Selected>,
    /// The estimate with them; that of the base model without any.
    pub estimate: Estimate,
    /// The score tests at that estimate, where they were made and none led to a further mechanism.
    pub latest: Option<Screen>,
}

impl Selection {
    /// Selects mechanisms one after the other while a further one may be named. Recordings with a wrong unit or sign give none.
    pub fn new(question: &Question, Opening { tests, push, mut first }: Opening) -> Self {
        let estimate = tests.fit.estimate.clone();
        let mut out = Self { tests, push, mechanisms: Vec::new(), estimate, latest: None };
        if out.tests.is_blocked() {
            return out;
        }
        for _ in 0..question.settings.most {
            let Some((mechanism, estimate)) = first.take().or_else(|| out.next(question)) else { break };
            out.mechanisms.push(mechanism);
            out.estimate = estimate;
            out.remove_needless(question.settings);
            out.leave_out_lost(question.settings);
        }
        out.replace(question.settings);
        out
    }

    /// Whether a mechanism of this name stays in the model without being named.
    pub fn carries(&self, name: &str) -> bool {
        self.mechanisms.iter().any(|m| m.carried && self.tests.candidates[m.candidate].mechanism.name == name)
    }

    /// The best further mechanism, with the estimate that contains it.
    fn next(&mut self, question: &Question) -> Option<(Selected, Estimate)> {
        let problem = self.tests.problem(question.settings);
        let latest = (!self.mechanisms.is_empty())
            .then(|| screen(&self.estimate, problem.integration, problem.runs, problem.candidates));
        let screen = latest.as_ref().unwrap_or(&self.tests.screen);
        // A push that was found first is a finding already, and so is a coarse step.
        let by_euler = is_euler(self.tests.fit.admission.euler_gain);
        let present = self.tests.present();
        let nothing_else = self.push.is_none() && !by_euler;
        let beside = Beside { present: &present, selected: &self.mechanisms, nothing_else };
        let leaders = eligible(screen, problem.candidates, beside, question.settings);
        // A base biased by what it lacks is no start for what is either so or not; with what was found in the model its test is enough.
        let given = self.mechanisms.is_empty().then_some(&question.full);
        let next = compete(screen, &leaders, beside, given, &self.estimate, problem, question.progress);
        if next.is_none() {
            self.latest = latest;
        }
        next
    }

    /// Removes a mechanism that a later one made needless.
    fn remove_needless(&mut self, settings: &Settings) {
        let Some((_, earlier)) = self.mechanisms.split_last().filter(|(_, earlier)| !earlier.is_empty()) else {
            return;
        };
        let problem = self.tests.problem(settings);
        let all = Wald::at(&self.estimate, problem.integration, problem.runs);
        let needless = earlier.iter().position(|a| {
            let c = &problem.candidates[a.candidate];
            let w = amplitudes(&all, &self.estimate, c, &a.extent);
            self.tests.screen.by_chance(a.candidate, &a.extent, w.statistic(), w.value.len(), problem.runs)
                > settings.alpha
        });
        let Some(i) = needless else { return };
        let needless = self.mechanisms.remove(i);
        let (model, free) = problem.candidates[needless.candidate].removed(&self.estimate, &needless.extent);
        self.estimate = problem.estimate(&model, &free, &self.estimate.noise, SETTLE);
    }

    /// Leaves out stretches that the filter does not follow: with more physics in it the model may follow in so many runs that
    /// the few left are not its fault.
    fn leave_out_lost(&mut self, settings: &Settings) {
        let fit = &mut self.tests.fit;
        let at = passes(&self.estimate.model, fit.integration, &[], &fit.runs, &self.estimate.noise, false);
        let (Some(kept), lost) = followed(&fit.runs, &at) else { return };
        fit.admission.issues.extend(lost);
        fit.runs = kept;
        let problem = self.tests.problem(settings);
        let again = [&self.tests.fit.estimate, &self.estimate].map(|e| problem.again(e, SETTLE));
        let screen = screen(&again[0], problem.integration, problem.runs, problem.candidates);
        self.tests.screen = screen;
        [self.tests.fit.estimate, self.estimate] = again;
        self.tests.fit.within = None;
    }

    /// Compares every mechanism from outside the ship again, beside those that were found after it: what it explained alone,
    /// another may explain better beside them.
    fn replace(&mut self, settings: &Settings) {
        let present = self.tests.present();
        for i in 0..self.mechanisms.len().saturating_sub(1) {
            let problem = self.tests.problem(settings);
            let Some((entry, found)) = rival_of(&self.mechanisms, &present, i, &self.estimate, problem) else {
                continue;
            };
            self.mechanisms[i] = entry;
            if let Some(found) = found {
                (self.estimate, self.latest) = (found, None);
            }
        }
    }
}

/// The best explanation in the place of mechanism `i`, from outside the ship: with its estimate where it is another mechanism and
/// better than the present one, without where it is the same; `None` where the present one is kept as it is.
fn rival_of(
    selected: &[Selected],
    present: &[Present],
    i: usize,
    current: &Estimate,
    problem: Problem,
) -> Option<(Selected, Option<Estimate>)> {
    let Problem { integration, runs, candidates, settings, .. } = problem;
    let outside = |candidate: usize| candidates[candidate].mechanism.kind == Kind::Environment;
    let own = &selected[i];
    if !outside(own.candidate) {
        return None;
    }
    let (model, free) = candidates[own.candidate].removed(current, &own.extent);
    let rest = problem.estimate(&model, &free, &current.noise, REFIT);
    let others: Vec<Selected> = selected.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, a)| a.clone()).collect();
    let beside = Beside { present, selected: &others, nothing_else: false };
    let s = screen(&rest, integration, runs, candidates);
    let may = |r: &&Row| {
        outside(r.candidate)
            && may_be_named(r, candidates, settings)
            && may_be_further(&Further::from(*r), &beside, candidates)
    };
    let leaders: Vec<&Row> = s.rows.iter().filter(may).collect();
    let (entry, found) = compare(&s, &leaders, &rest, problem)?;
    if entry.candidate == own.candidate && entry.extent == own.extent {
        return Some((entry, None));
    }
    // The present one was estimated to the end, beside what came after it: another must do better than that, and a force without
    // a cause better than any cause within its tolerance.
    let value = |a: &Selected, e: &Estimate| {
        let parameters = candidates[a.candidate].positions(&e.free, &a.extent).len();
        e.log_posterior - PARAMETER_PRICE * parameters as f64
    };
    let is_stand_in = |a: &Selected| candidates[a.candidate].mechanism.stand_in;
    let tolerance = if is_stand_in(&entry) && !is_stand_in(own) {
        form_tolerance(found.log_posterior - rest.log_posterior)
    } else {
        0.0
    };
    (value(&entry, &found) - value(own, current) > tolerance).then_some((entry, Some(found)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::Extent;
    use crate::diagnose::example::{model, runs, with};
    use crate::diagnose::search::base::{AuditedRuns, BaseFit};
    use crate::model::Model;
    use crate::recording::Run;

    /// The selection on twelve runs of a truth, the model's own parameters free.
    fn selection(truth: &Model, settings: &Settings) -> Selection {
        selection_on(runs(truth, 12), settings)
    }

    fn selection_on(runs: Vec<Run>, settings: &Settings) -> Selection {
        let model = model();
        let question = Question { model: &model, full: model.clone(), settings, progress: &|_| () };
        let audited = AuditedRuns::new(runs, model.ship.hull.lpp);
        let tests = BaseTests::new(&question, BaseFit::new(&question, audited));
        Selection::new(&question, Opening { tests, push: None, first: None })
    }

    fn names(s: &Selection) -> Vec<&str> {
        s.mechanisms.iter().map(|m| s.tests.candidates[m.candidate].mechanism.name).collect()
    }

    fn plain() -> Settings {
        Settings { nuisance: false, ..Settings::default() }
    }

    #[test]
    fn nothing_is_selected_where_nothing_is_missing_and_a_current_where_one_flows() {
        assert!(names(&selection(&model(), &plain())).is_empty());
        let s = selection(&with(&[("current.north", 0.3)]), &plain());
        assert_eq!(names(&s), ["current"]);
        let north = s.estimate.model.find("current.north").unwrap();
        assert!((s.estimate.model.parameters[north].value - 0.3).abs() < 0.03);
        assert!(s.estimate.log_posterior > s.tests.fit.estimate.log_posterior + 50.0);
    }

    #[test]
    fn what_the_kinematic_consistency_shows_comes_before_what_the_ship_shows_more_strongly() {
        let mut all = runs(&with(&[("current.north", 0.6)]), 12);
        all.iter_mut().flat_map(|r| &mut r.measured).for_each(|m| m[5] = m[5].map(|r| r + 0.001));
        let s = selection_on(all, &plain());
        assert_eq!(names(&s), ["yaw_rate_bias", "current"]);
        let bias = s.estimate.model.find("yaw_rate_bias.bias").unwrap();
        assert!((s.estimate.model.parameters[bias].value - 0.001).abs() < 1e-4);
    }

    #[test]
    fn at_most_so_many_mechanisms_are_selected_as_the_user_allows() {
        let settings = Settings { most: 0, ..plain() };
        assert!(selection(&with(&[("current.north", 0.3)]), &settings).mechanisms.is_empty());
    }

    /// A selection with mechanisms in it that were never refitted.
    fn holding(s: &mut Selection, names: &[&str]) {
        for name in names {
            let candidate = s.tests.candidates.iter().position(|c| c.mechanism.name == *name).unwrap();
            s.estimate.free.extend(s.tests.candidates[candidate].parameters(&Extent::All));
            let (set, why) = (vec![candidate], String::new());
            let (extent, carried) = (Extent::All, false);
            s.mechanisms.push(Selected { candidate, extent, statistic: 0.0, p: 0.0, set, why, carried });
        }
        let problem = s.tests.problem(&Settings::default()).again(&s.estimate, SETTLE);
        s.estimate = problem;
    }

    #[test]
    fn an_earlier_mechanism_that_does_nothing_beside_a_later_one_is_removed_and_one_that_acts_is_not() {
        let settings = Settings { most: 0, ..plain() };
        let mut s = selection(&with(&[("current.north", 0.3)]), &settings);
        holding(&mut s, &["earth_force", "current"]);
        let free = s.estimate.free.len();
        s.remove_needless(&plain());
        assert_eq!((names(&s), s.estimate.free.len()), (vec!["current"], free - 2));
        s.remove_needless(&plain());
        assert_eq!(names(&s), ["current"]);
    }

    #[test]
    fn a_look_alike_that_explains_better_beside_a_later_mechanism_takes_the_place_of_the_earlier() {
        let settings = Settings { most: 0, ..plain() };
        let mut s = selection(&with(&[("current.north", 0.3)]), &settings);
        holding(&mut s, &["earth_force", "heading_bias"]);
        let before = s.estimate.log_posterior;
        s.replace(&plain());
        assert_eq!(names(&s), ["current", "heading_bias"]);
        assert!(s.estimate.log_posterior > before);
        // Compared again, the better one stays.
        s.replace(&plain());
        assert_eq!(names(&s), ["current", "heading_bias"]);
    }
}
