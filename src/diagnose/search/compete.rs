//! Which mechanism explains the data best: refits the leader of a ranking and its rivals with everything else free, compares
//! them, and keeps every one that the data allow. What is tested, and what is said of the outcome, is decided elsewhere.

use super::eligible::Beside;
use super::problem::Problem;
use super::saturated::{hidden, over_any_force};
use super::screen::{Row, Screen};
use super::selected::Selected;
use super::together::{Leading, leading};
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::evidence::forces::only_cancels;
use crate::diagnose::evidence::kinematic::{agreements, gain};
use crate::diagnose::evidence::wald::Wald;
use crate::diagnose::settings::{
    BEYOND_DOUBT, Effort, FORM_TOLERANCE, INDISTINGUISHABLE, LIKENESS, PARAMETER_PRICE, REFIT, REMAINDER,
    RESOLVED_SAMPLES, RIVAL_GAP, RIVALS, SETTLE, STARTS, STARTS_OF_SQUARES, TOGETHER_EFFORT, WHOLE_SHARE,
};
use crate::likelihood::estimate::{Estimate, FreeParameter, estimate_above, log_posterior};
use crate::likelihood::evidence::chi_squared_p;
use crate::likelihood::noise::Noise;
use crate::model::Model;
use crate::physics::{Kind, Probe};
use crate::statistics::{corrected, mean, median};
use nalgebra::DVector;

/// A candidate's amplitudes in an estimate beyond what the model already had, its companions fixed: an amplitude that only counts times a
/// coefficient is as uncertain as that coefficient and yet not zero.
pub fn amplitudes(all: &Wald, found: &Estimate, c: &Candidate, extent: &Extent) -> Wald {
    let companions = c.companions(&found.model);
    let is_held = |i: &usize| companions.contains(&found.free[*i].column.parameter);
    let held: Vec<usize> = (0..found.free.len()).filter(is_held).collect();
    all.given(&c.positions(&found.free, extent), &held).less(&c.held(extent))
}

/// That a mechanism acts, where it acts, and how large a score test has it.
struct Hypothesis {
    candidate: usize,
    extent: Extent,
    amplitude: DVector<f64>,
    statistic: f64,
    p: f64,
}

impl Hypothesis {
    fn of(row: &Row) -> Self {
        Self {
            candidate: row.candidate,
            extent: row.extent.clone(),
            amplitude: row.test.amplitude.clone(),
            statistic: row.test.statistic,
            p: row.p,
        }
    }

    /// A look-alike in the leader's place: where a law is nonlinear, its slope at zero predicts less than its gain, so that it is tried
    /// in the leader's sessions whatever its own test says. A coefficient of the ship does not change from session to session.
    fn in_place_of(row: &Row, leader: &Row, s: &Screen, candidates: &[Candidate]) -> Option<Self> {
        let by_session = matches!(leader.extent, Extent::Each(_));
        if row.extent == leader.extent || (by_session && !candidates[row.candidate].mechanism.by_session) {
            return Some(Self::of(row));
        }
        let test = s.test(row.candidate, &leader.extent);
        (test.degrees > 0).then(|| Self {
            extent: leader.extent.clone(),
            amplitude: test.amplitude,
            statistic: test.statistic,
            ..Self::of(row)
        })
    }

    /// Log-likelihood that its parameters must bring.
    fn price(&self) -> f64 {
        PARAMETER_PRICE * self.amplitude.len() as f64
    }
}

/// The hypotheses that are refitted beside the leader: look-alikes from outside the ship or among its sensors, and whatever has nearly
/// as large a predicted gain.
fn rivals(s: &Screen, leaders: &[&Row], candidates: &[Candidate]) -> Vec<Hypothesis> {
    let leader = leaders[0];
    let first = candidates[leader.candidate].mechanism;
    let alike = |r: &&Row| {
        let m = candidates[r.candidate].mechanism;
        r.candidate != leader.candidate && m.kind == first.kind && r.visible && m.looks_like(first)
    };
    let mut out: Vec<Hypothesis> = Vec::new();
    if matches!(first.kind, Kind::Environment | Kind::Sensor) {
        out.extend(s.rows.iter().filter(alike).filter_map(|r| Hypothesis::in_place_of(r, leader, s, candidates)));
    }
    // A rival whose predicted gain is far below the leader's does not overtake it.
    let gain_needed = leader.test.statistic - f64::max(RIVAL_GAP, REMAINDER * leader.test.statistic);
    let near = leaders[1..]
        .iter()
        .filter(|r| r.test.statistic > gain_needed)
        // What acts in some sessions only is alike by what those sessions sailed.
        .filter(|r| r.extent != Extent::All || s.likeness(leader.candidate, r.candidate) > LIKENESS);
    for r in near {
        if out.iter().all(|c| c.candidate != r.candidate) {
            out.push(Hypothesis::of(r));
        }
    }
    out.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    out.truncate(RIVALS);
    out
}

/// How much less than the best of so much gain in log-likelihood a rival may explain and yet be the true form: the law of a force
/// is known only so well.
pub fn form_tolerance(gain: f64) -> f64 {
    (FORM_TOLERANCE * gain).max(INDISTINGUISHABLE)
}

/// The model with a mechanism at the amplitudes of a score test, everything else moved along as far as the quadratic model
/// is valid, and what is free then: what was, the mechanism's companions, and its own parameters.
pub fn start_with(
    s: &Screen,
    candidate: usize,
    extent: &Extent,
    amplitude: &DVector<f64>,
    current: &Estimate,
    problem: Problem,
    noise: &Noise,
) -> (Model, Vec<FreeParameter>) {
    let c = &problem.candidates[candidate];
    let shift = s.base_shift(s.columns(candidate), extent, amplitude);
    let at = |length: f64, amplitude: &DVector<f64>| {
        let mut model = current.model.clone();
        for (f, d) in current.free.iter().zip(shift.iter()) {
            f.set(&mut model, f.value(&current.model) + length * d * f.column.scale);
        }
        c.add(&mut model, extent, amplitude);
        let value = log_posterior(&model, problem.integration, problem.runs, &current.free, noise);
        (model, value)
    };
    let mut starts: Vec<_> = STARTS.map(|share| at(share, &(amplitude * share))).into();
    if c.mechanism.probe == Probe::Odd {
        starts.push(at(1.0, &rooted(amplitude, c.columns.len().max(1))));
        starts.extend(STARTS_OF_SQUARES.map(|share| at(0.0, &(amplitude * share))));
    }
    if c.mechanism.probe == Probe::Forward {
        // Where it was probed, too; what exists on one side of zero may have no slope there, and shows once the rest has followed.
        starts.push(at(1.0, &amplitude.map(f64::signum)));
        for (model, value) in &mut starts {
            let found = problem.estimate(model, &current.free, noise, TOGETHER_EFFORT);
            (*model, *value) = (found.model, found.log_posterior);
        }
    }
    let best = starts.into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a });
    let model = best.map_or_else(|| current.model.clone(), |(model, _)| model);
    let mut free = current.free.clone();
    // Uncertain once the mechanism acts, and free with what is known of them.
    for parameter in c.companions(&model) {
        if free.iter().all(|f| f.column.parameter != parameter) {
            free.push(FreeParameter::uncertain(&model, parameter));
        }
    }
    free.extend(c.parameters(extent));
    (model, free)
}

/// Amplitudes of an effect that grows with their square, probed at one: each group of `size` over the root of its norm.
fn rooted(amplitude: &DVector<f64>, size: usize) -> DVector<f64> {
    let mut out = amplitude.clone();
    for i in (0..amplitude.len()).step_by(size) {
        let mut own = out.rows_mut(i, size);
        own /= own.norm().max(1e-12).sqrt();
    }
    out
}

/// A hypothesis with its refit.
struct Refit {
    hypothesis: Hypothesis,
    estimate: Estimate,
    /// Log-posterior less the price of the parameters.
    value: f64,
}

/// The refits of one ranking.
struct Contest {
    refitted: Vec<Refit>,
    /// Candidates whose noise was estimated along.
    settled: Vec<usize>,
    /// Errors of sensors that the kinematic consistency does not distinguish from the leader.
    alike: Vec<usize>,
    /// The leader's p-value.
    p: f64,
    /// The value below which a rival was given up.
    least: f64,
}

impl Contest {
    /// Enters a refit with its noise, in the place of a worse one of the same candidate.
    fn enter(&mut self, found: Refit) {
        let candidate = found.hypothesis.candidate;
        let known = self.refitted.iter().position(|r| r.hypothesis.candidate == candidate);
        if known.is_some_and(|i| self.refitted[i].value >= found.value) {
            return;
        }
        if let Some(i) = known {
            self.refitted.remove(i);
        }
        self.refitted.push(found);
        self.settled.push(candidate);
    }
}

/// The comparison of refitted hypotheses on one ranking.
struct Competition<'a> {
    screen: &'a Screen,
    current: &'a Estimate,
    problem: Problem<'a>,
}

impl Competition<'_> {
    /// Refits with a hypothesis; given up where its value stays below `least`.
    fn refit(&self, hypothesis: Hypothesis, noise: &Noise, effort: Effort, least: f64) -> Refit {
        let Problem { integration, runs, prior, .. } = self.problem;
        let Hypothesis { candidate, extent, amplitude, .. } = &hypothesis;
        let (model, free) = start_with(self.screen, *candidate, extent, amplitude, self.current, self.problem, noise);
        let price = hypothesis.price();
        let estimate = estimate_above(least + price, &model, integration, runs, &free, noise, prior, effort);
        let value = estimate.log_posterior - price;
        Refit { hypothesis, estimate, value }
    }

    /// Errors of sensors, compared by the kinematic consistency: the one that is significantly better than the leader takes its place,
    /// those that are significantly worse than it are no rivals, and it returns the leader and the candidates that are not distinguished
    /// from it.
    fn by_consistency(&self, first: &mut Hypothesis, rivals: &mut Vec<Hypothesis>) -> Vec<usize> {
        let Problem { runs, candidates, .. } = self.problem;
        let is_sensor =
            |h: &Hypothesis| candidates[h.candidate].mechanism.kind == Kind::Sensor && h.extent == Extent::All;
        if !is_sensor(first) || !rivals.iter().any(is_sensor) {
            return Vec::new();
        }
        let asked: Vec<&Candidate> = std::iter::once(&*first)
            .chain(rivals.iter().filter(|h| is_sensor(h)))
            .map(|h| &candidates[h.candidate])
            .collect();
        let Some(mut agreements) = agreements(&self.current.model, runs, &asked) else { return Vec::new() };
        let (mut sensors, mut others): (Vec<Hypothesis>, Vec<Hypothesis>) = rivals.drain(..).partition(is_sensor);
        let ahead = |i: &usize| agreements[*i].over(&agreements[0]).filter(|[low, _]| *low > 0.0);
        let best = (1..agreements.len()).filter_map(|i| Some((i, ahead(&i)?)));
        if let Some((i, _)) = best.max_by(|a, b| a.1[0].total_cmp(&b.1[0])) {
            agreements.swap(0, i);
            std::mem::swap(first, &mut sensors[i - 1]);
            first.amplitude = agreements[0].amplitude.clone();
        }
        let behind = |i: usize| agreements[i].over(&agreements[0]).is_some_and(|[_, high]| high < 0.0);
        let kept = sensors.into_iter().enumerate().filter(|(i, _)| !behind(i + 1)).map(|(_, h)| h);
        rivals.extend(kept);
        let alike = std::iter::once(first.candidate).chain(rivals.iter().map(|h| h.candidate)).collect();
        rivals.append(&mut others);
        alike
    }

    /// Whether the refit confirms the mechanism.
    fn is_confirmed(&self, found: &Refit) -> bool {
        self.is_confirmed_at(self.problem.settings.alpha, found)
    }

    /// Whether the refit confirms the mechanism at a chance: significant by Wald's test and by the likelihood itself.
    fn is_confirmed_at(&self, alpha: f64, Refit { hypothesis, estimate, .. }: &Refit) -> bool {
        let Problem { integration, runs, candidates, .. } = self.problem;
        let c = &candidates[hypothesis.candidate];
        let w = amplitudes(&Wald::at(estimate, integration, runs), estimate, c, &hypothesis.extent);
        let gain = 2.0 * (estimate.log_posterior - self.current.log_posterior);
        let statistic = w.statistic().min(gain.max(0.0));
        let p = self.screen.by_chance(hypothesis.candidate, &hypothesis.extent, statistic, w.value.len(), runs);
        let is_so = c.mechanism.probe != Probe::Whole || w.value.iter().all(|share| *share > WHOLE_SHARE);
        is_so && p < alpha && !only_cancels(c, estimate, runs)
    }

    /// What is either so or not (two actuators swapped), refitted from where it is wholly so in the model as it was given, where a refit
    /// confirms it. The rest is estimated first with its amplitude fixed: gains that are far off would else be taken for a share of it.
    fn whole(&self, given: &Model) -> Vec<Refit> {
        let Problem { candidates, .. } = self.problem;
        let visible = self.screen.rows.iter().filter(|r| r.visible).count();
        let refit = |candidate: usize| {
            let (c, extent) = (&candidates[candidate], Extent::All);
            let amplitude = DVector::from_element(c.columns.len(), 1.0);
            let (mut model, mut free) = (self.current.model.clone(), self.current.free.clone());
            free.iter().for_each(|f| f.set(&mut model, f.value(given)));
            c.add(&mut model, &extent, &amplitude);
            let held = self.problem.estimate(&model, &free, &self.current.noise, TOGETHER_EFFORT);
            free.extend(c.parameters(&extent));
            let hypothesis = Hypothesis { candidate, extent, amplitude, statistic: 0.0, p: 1.0 };
            let mut found = self.settled(hypothesis, &held.model, &free, &held.noise);
            let gain = 2.0 * (found.estimate.log_posterior - self.current.log_posterior).max(0.0);
            found.hypothesis.statistic = gain;
            found.hypothesis.p = corrected(chi_squared_p(gain, c.columns.len()), visible.max(1) as f64);
            found
        };
        let is_either = |i: &usize| candidates[*i].mechanism.probe == Probe::Whole;
        (0..candidates.len()).filter(is_either).map(refit).filter(|found| self.is_confirmed(found)).collect()
    }

    /// A hypothesis refitted from where a model stands, to convergence.
    fn settled(&self, hypothesis: Hypothesis, model: &Model, free: &[FreeParameter], noise: &Noise) -> Refit {
        let estimate = self.problem.estimate(model, free, noise, SETTLE);
        Refit { value: estimate.log_posterior - hypothesis.price(), hypothesis, estimate }
    }

    /// The mechanism of a refit where it acts otherwise, from these amplitudes.
    fn elsewhere(&self, from: &Refit, extent: Extent, amplitude: DVector<f64>, noise: &Noise) -> Refit {
        let Hypothesis { candidate, extent: before, statistic, p, .. } = &from.hypothesis;
        let c = &self.problem.candidates[*candidate];
        let (mut model, mut free) = c.removed(&from.estimate, before);
        c.add(&mut model, &extent, &amplitude);
        free.extend(c.parameters(&extent));
        let hypothesis = Hypothesis { candidate: *candidate, extent, amplitude, statistic: *statistic, p: *p };
        self.settled(hypothesis, &model, &free, noise)
    }

    /// Refits the error of a sensor from where the sensors agree best. Where the error may differ from day to day and one amplitude is
    /// enough for the kinematic consistency, it is also refitted with one a session, and that is kept if it explains clearly more.
    fn refit_from(&self, leading: Leading) -> Refit {
        let Leading { set, extent, amplitude, statistic, p, model, free, noise } = leading;
        let candidate = set[0];
        let hypothesis = Hypothesis { candidate, extent, amplitude: amplitude.clone(), statistic, p };
        let found = self.settled(hypothesis, &model, &free, &noise);
        let sessions: Vec<String> = self.screen.evidence.sessions.keys().cloned().collect();
        let by_session = self.problem.candidates[candidate].mechanism.by_session && sessions.len() > 1;
        if !by_session || found.hypothesis.extent != Extent::All {
            return found;
        }
        let amplitudes = DVector::from_fn(amplitude.len() * sessions.len(), |i, _| amplitude[i % amplitude.len()]);
        let each = self.elsewhere(&found, Extent::Each(sessions), amplitudes, &noise);
        if each.value > found.value + INDISTINGUISHABLE { each } else { found }
    }

    /// The error of a sensor that the kinematic consistency shows, where a refit confirms it and it is shown at the size of the refit too.
    fn shown(&self, leading: Leading) -> Option<(Selected, Estimate)> {
        let Problem { runs, candidates, .. } = self.problem;
        let set = leading.set.clone();
        let found = self.refit_from(leading);
        let (agreement, interval) = gain(&self.current.model, &found.estimate.model, runs, candidates)?;
        let is_shown = agreement > INDISTINGUISHABLE && interval.is_none_or(|[low, _]| low > 0.0);
        let p = found.hypothesis.p;
        let others: Vec<&str> = set[1..].iter().map(|i| candidates[*i].mechanism.title).collect();
        let why = if others.is_empty() {
            "the kinematic consistency of the sensors shows it and no other error of theirs".to_owned()
        } else {
            format!("the kinematic consistency of the sensors does not distinguish it from {}", others.join(", "))
        };
        (is_shown && self.is_confirmed(&found)).then(|| self.selected(self.pooled(found), true, p, set, why))
    }

    /// The error of a sensor that the saturated model shows, where a refit confirms it beyond doubt, as no test at the base does, and no law of
    /// a force explains it.
    fn hidden(&self, error: Leading) -> Option<Refit> {
        let Leading { set, extent, amplitude, statistic, p, model, free, noise } = error;
        let hypothesis = Hypothesis { candidate: set[0], extent, amplitude, statistic, p };
        let found = self.settled(hypothesis, &model, &free, &noise);
        let over = || over_any_force(&found.estimate, set[0], &found.hypothesis.extent, self.problem);
        (self.is_confirmed_at(BEYOND_DOUBT, &found) && over() > INDISTINGUISHABLE).then_some(found)
    }

    /// Refits the leader of a ranking and its rivals.
    fn contest(&self, leaders: &[&Row]) -> Contest {
        let mut out =
            Contest { refitted: Vec::new(), settled: Vec::new(), alike: Vec::new(), p: 1.0, least: f64::NEG_INFINITY };
        let Some(leader) = leaders.first() else { return out };
        let mut first = Hypothesis::of(leader);
        let mut rivals = rivals(self.screen, leaders, self.problem.candidates);
        out.alike = self.by_consistency(&mut first, &mut rivals);
        (out.settled, out.p) = (vec![first.candidate], first.p);
        let first = self.refit(first, &self.current.noise, SETTLE, f64::NEG_INFINITY);
        let noise = first.estimate.noise;
        if self.is_confirmed(&first) {
            // A rival further below the leader than the tolerance of any confidence set changes nothing.
            out.least = first.value - form_tolerance(first.value - self.current.log_posterior);
            out.refitted.push(first);
        }
        for rival in rivals {
            let rival = self.refit(rival, &noise, REFIT, out.least);
            if rival.value < out.least || self.is_confirmed(&rival) {
                out.refitted.push(rival);
            }
        }
        out
    }

    /// Refits the leader of a ranking and its rivals, beside them errors of sensors that are hidden in the base and its noise, and what is
    /// either so or not in the model as it was given, and returns the best with its confidence set; `None` where no refit confirms the gain that its test predicted.
    fn best(&self, leaders: &[&Row], hidden: Vec<Leading>, given: Option<&Model>) -> Option<(Selected, Estimate)> {
        let candidates = self.problem.candidates;
        let mut contest = self.contest(leaders);
        hidden.into_iter().filter_map(|error| self.hidden(error)).for_each(|found| contest.enter(found));
        given.into_iter().flat_map(|model| self.whole(model)).for_each(|found| contest.enter(found));
        let Contest { mut refitted, settled, alike, p, least } = contest;
        let entry = |(place, r): (usize, &Refit)| {
            let m = candidates[r.hypothesis.candidate].mechanism;
            let tolerance = match m.kind {
                Kind::Sensor | Kind::Actuator => INDISTINGUISHABLE,
                Kind::Environment | Kind::Ship => form_tolerance(r.value - self.current.log_posterior),
            };
            Entry { place, value: r.value, tolerance, stand_in: m.stand_in }
        };
        let ranking = Ranking::new(refitted.iter().enumerate().map(entry).collect())?;
        let candidate = |e: &Entry| refitted[e.place].hypothesis.candidate;
        let mut set: Vec<usize> = ranking.set().iter().map(candidate).collect();
        let mut why = self.why(&ranking, &candidate, least);
        if alike.contains(&set[0]) {
            let reach = form_tolerance(ranking.best - self.current.log_posterior);
            let near = ranking.entries.iter().filter(|e| ranking.best - e.value < reach).map(candidate);
            let more: Vec<usize> = near.filter(|c| alike.contains(c) && !set.contains(c)).collect();
            if !more.is_empty() {
                let titles: Vec<&str> = more.iter().map(|c| candidates[*c].mechanism.title).collect();
                why = format!("{why}; the sensors' kinematics do not distinguish it from {}", titles.join(", "));
                set.extend(more);
            }
        }
        let winner = refitted.swap_remove(ranking.entries[0].place);
        let is_settled = settled.contains(&winner.hypothesis.candidate);
        Some(self.selected(self.pooled(winner), is_settled, p, set, why))
    }

    /// A clock with one value in all sessions, where those of the sessions differ by less than is resolved: that they differ would be
    /// significant and immaterial.
    fn pooled(&self, winner: Refit) -> Refit {
        let Hypothesis { candidate, extent, .. } = &winner.hypothesis;
        let (c, found) = (&self.problem.candidates[*candidate], &winner.estimate);
        let Extent::Each(sessions) = extent else { return winner };
        let own: Vec<&FreeParameter> = c.positions(&found.free, extent).into_iter().map(|i| &found.free[i]).collect();
        let is_time = |f: &&FreeParameter| found.model.parameters[f.column.parameter].info.unit == "s";
        let Some(period) = median(self.problem.runs.iter().map(|r| r.recorded_dt)) else { return winner };
        if c.mechanism.kind != Kind::Sensor || !own.iter().all(is_time) {
            return winner;
        }
        let columns = own.len() / sessions.len();
        // The addition in each session, by column of the mechanism.
        let values = |k: usize| own.iter().skip(k).step_by(columns).map(|f| f.value(&found.model));
        let spread = |k: usize| values(k).fold(f64::MIN, f64::max) - values(k).fold(f64::MAX, f64::min);
        if (0..columns).any(|k| spread(k) > RESOLVED_SAMPLES * period) {
            return winner;
        }
        let amplitude = DVector::from_fn(columns, |k, _| mean(values(k)).unwrap_or(0.0) / own[k].column.scale);
        self.elsewhere(&winner, Extent::All, amplitude, &found.noise)
    }

    /// Why the confidence set is what it is.
    fn why(&self, ranking: &Ranking, candidate: &dyn Fn(&Entry) -> usize, least: f64) -> String {
        let title = |e: &Entry| self.problem.candidates[candidate(e)].mechanism.title;
        let Ranking { entries, best, width } = ranking;
        if let [first, others @ ..] = ranking.set()
            && !others.is_empty()
        {
            let alike = |e: &Entry| {
                let likeness = self.screen.likeness(candidate(first), candidate(e));
                format!("{} (likeness {likeness:.2})", title(e))
            };
            let alike: Vec<String> = others.iter().map(alike).collect();
            return format!("these fit equally well, within {width:.0} units of log-likelihood: {}", alike.join(", "));
        }
        let Some(next) = entries.get(1) else {
            return "no other mechanism of the catalogue fits nearly as well".into();
        };
        // A refit that was given up is only known to be below `least`.
        let (over, by) = if next.value < least { ("over ", best - least) } else { ("", best - next.value) };
        format!("next best, {}, fits {over}{by:.0} units of log-likelihood worse", title(next))
    }

    /// The winner, with the noise estimated along as the leader's was.
    fn selected(&self, winner: Refit, is_settled: bool, p: f64, set: Vec<usize>, why: String) -> (Selected, Estimate) {
        let Refit { hypothesis: h, estimate, .. } = winner;
        let estimate = if is_settled { estimate } else { self.problem.again(&estimate, SETTLE) };
        let gain = (estimate.log_posterior - self.current.log_posterior).max(0.5 * h.statistic);
        let p = h.p.min(p);
        let statistic = 2.0 * gain;
        let entry = Selected { candidate: h.candidate, statistic, p, extent: h.extent, set, why, carried: false };
        (entry, estimate)
    }
}

/// One refitted hypothesis in a ranking by value.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry {
    /// Its place among the refits.
    place: usize,
    /// Log-posterior less the price of its parameters.
    value: f64,
    /// How much less in value another may have and yet be the true one, if this is the best.
    tolerance: f64,
    /// Whether it is a force without a cause.
    stand_in: bool,
}

/// Refitted hypotheses, the best first.
struct Ranking {
    entries: Vec<Entry>,
    /// Value of the best, a force without a cause included.
    best: f64,
    /// Its tolerance.
    width: f64,
}

impl Ranking {
    /// Sorts by value and drops forces without a cause where a cause is within the tolerance. `None` for no entries.
    fn new(mut entries: Vec<Entry>) -> Option<Self> {
        entries.sort_by(|a, b| b.value.total_cmp(&a.value));
        let Entry { value: best, tolerance: width, .. } = *entries.first()?;
        if entries.iter().any(|e| best - e.value < width && !e.stand_in) {
            entries.retain(|e| !e.stand_in);
        }
        Some(Self { entries, best, width })
    }

    /// The entries within the tolerance of the best.
    fn set(&self) -> &[Entry] {
        let count = self.entries.iter().take_while(|e| self.best - e.value < self.width).count();
        &self.entries[..count]
    }
}

/// Refits the leader among mechanisms that may be named (the most significant first) and its rivals, and returns the best with
/// its confidence set; `None` where there is no leader or no refit confirms it.
pub fn compare(
    screen: &Screen,
    leaders: &[&Row],
    current: &Estimate,
    problem: Problem,
) -> Option<(Selected, Estimate)> {
    Competition { screen, current, problem }.best(leaders, Vec::new(), None)
}

/// The first error of a sensor that a refit confirms: the kinematic consistency of the sensors comes before every mechanism of the ship. Else as
/// [`compare`], and beside the leaders errors of sensors that are hidden in the base, and what is either so or not, whatever gain its test predicts, in the model as it was `given`.
pub fn compete(
    screen: &Screen,
    leaders: &[&Row],
    beside: Beside,
    given: Option<&Model>,
    current: &Estimate,
    problem: Problem,
    progress: &dyn Fn(&str),
) -> Option<(Selected, Estimate)> {
    let refitting = |i: usize| progress(&format!("refitting with {}", problem.candidates[i].mechanism.title));
    for sensor in leading(current, problem, beside) {
        refitting(sensor.set[0]);
        let shown = Competition { screen, current, problem }.shown(sensor);
        if shown.is_some() {
            return shown;
        }
    }
    if let Some(first) = leaders.first() {
        refitting(first.candidate);
    }
    Competition { screen, current, problem }.best(leaders, hidden(current, problem, beside), given)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(place: usize, value: f64, stand_in: bool) -> Entry {
        Entry { place, value, tolerance: form_tolerance(value), stand_in }
    }

    fn places(entries: &[Entry]) -> Vec<usize> {
        entries.iter().map(|e| e.place).collect()
    }

    #[test]
    fn mechanisms_within_three_units_or_a_tenth_of_the_gain_are_indistinguishable() {
        assert_eq!((form_tolerance(10.0), form_tolerance(100.0)), (3.0, 10.0));
    }

    #[test]
    fn the_confidence_set_contains_the_mechanisms_within_the_tolerance_of_the_best() {
        let r = Ranking::new(vec![entry(0, 91.0, false), entry(1, 100.0, false), entry(2, 89.9, false)]).unwrap();
        assert_eq!((places(&r.entries), places(r.set())), (vec![1, 0, 2], vec![1, 0]));
        assert!(Ranking::new(Vec::new()).is_none());
    }

    #[test]
    fn a_force_without_a_cause_is_dropped_where_a_cause_is_within_its_tolerance() {
        let near = Ranking::new(vec![entry(0, 100.0, true), entry(1, 95.0, false), entry(2, 85.0, false)]).unwrap();
        assert_eq!((places(&near.entries), places(near.set())), (vec![1, 2], vec![1]));
        let far = Ranking::new(vec![entry(0, 100.0, true), entry(1, 85.0, false)]).unwrap();
        assert_eq!((places(&far.entries), places(far.set())), (vec![0, 1], vec![0]));
    }

    #[test]
    fn equal_values_keep_the_order_in_which_they_were_refitted() {
        let r = Ranking::new(vec![entry(0, 50.0, false), entry(1, 50.0, false)]).unwrap();
        assert_eq!(places(r.set()), [0, 1]);
    }

    #[test]
    fn amplitudes_that_count_by_their_square_start_at_their_root_group_by_group() {
        let a = DVector::from_column_slice(&[9.0, 0.0, 0.0, -16.0]);
        let expected = DVector::from_column_slice(&[3.0, 0.0, 0.0, -4.0]);
        assert!((rooted(&a, 2) - expected).amax() < 1e-12);
    }
}
