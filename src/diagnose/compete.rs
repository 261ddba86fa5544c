//! Which mechanism explains the data best: refits the leaders of a screen with everything else free, compares them, and keeps
//! every one that the data allow. What is tested, and what is said of the outcome, is decided elsewhere.

use super::candidate::{Candidate, Extent};
use super::conclude::Settings;
use super::estimate::{
    Effort, Estimate, FreeParameter, base_of, estimate, estimate_above, evidence, log_posterior, passes, restrictions,
};
use super::evidence::{chi_squared_p, pick};
use super::filter::Column;
use super::forces::undoes;
use super::noise::{Noise, NoisePrior};
use super::screen::{Row, Screen, screen};
use crate::model::Model;
use crate::physics::Kind;
use crate::physics::Probe;
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::{DMatrix, DVector};

/// A refit at given noise.
pub(super) const REFIT: Effort = Effort { rounds: 10, noise_rounds: 0, noise_iterations: 0, noise_runs: 10 };
/// A refit with the noise estimated along.
pub(super) const SETTLE: Effort = Effort { rounds: 10, noise_rounds: 1, noise_iterations: 4, noise_runs: 10 };

/// Log-likelihood that a further parameter must bring to be worth having.
const PRICE: f64 = 2.0;

/// Mechanisms closer than this in log-likelihood are not told apart.
const CLOSE: f64 = 3.0;
/// Share of the gain of a force that the form of its law may cost.
const FORM_UNKNOWN: f64 = 0.1;

/// A mechanism with what it costs and brings.
#[derive(Clone)]
pub(super) struct Accepted {
    /// Index into the candidates.
    pub candidate: usize,
    /// Where it acts.
    pub extent: Extent,
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// Corrected p-value.
    pub p: f64,
    /// Candidates that the data allow in its place, itself first.
    pub set: Vec<usize>,
    /// Why the set is what it is.
    pub why: String,
}

/// The circumstances of a competition.
#[derive(Clone, Copy)]
pub(super) struct Arena<'a> {
    pub integration: Integration,
    pub runs: &'a [Run],
    pub list: &'a [Candidate],
    pub prior: &'a NoisePrior,
    pub settings: &'a Settings,
}

/// The free parameters of a candidate.
fn candidate_parameters(c: &Candidate, extent: &Extent) -> Vec<FreeParameter> {
    let of = |sessions: Option<Vec<String>>| {
        c.columns.iter().map(move |col| FreeParameter {
            column: Column { probe: Probe::Tangent, ..*col },
            sessions: sessions.clone(),
            prior: None,
        })
    };
    extent.parts().into_iter().flat_map(of).collect()
}

/// Where the model holds the coefficients that are not known exactly once a candidate acts.
fn companions(c: &Candidate, model: &Model) -> Vec<usize> {
    c.mechanism.companions.iter().filter_map(|name| model.index(&format!("{}.{name}", c.term))).collect()
}

/// Where a candidate's parameters stand among the free ones.
pub(super) fn positions(free: &[FreeParameter], c: &Candidate, extent: &Extent) -> Vec<usize> {
    let same = |f: &FreeParameter, own: &FreeParameter| {
        f.column.parameter == own.column.parameter && f.prior.is_none() && f.sessions == own.sessions
    };
    candidate_parameters(c, extent).iter().filter_map(|own| free.iter().position(|f| same(f, own))).collect()
}

/// Standard deviations of their priors that a mechanism's own coefficients may be off before it is another mechanism's force
/// in this one's clothes.
const PLAUSIBLE: f64 = 2.0;

/// Whether a candidate's companions stayed where such coefficients are.
fn plausible(found: &Estimate, c: &Candidate) -> bool {
    let companions = companions(c, &found.model);
    let stayed = |f: &FreeParameter| f.prior.is_none_or(|p| (f.value(&found.model) - p.mean).abs() <= PLAUSIBLE * p.sd);
    found.free.iter().all(|f| !companions.contains(&f.column.parameter) || stayed(f))
}

/// A candidate's amplitudes as far as they say that it acts: its companions held, as an amplitude that only counts times a
/// coefficient is as uncertain as the coefficient and yet not nothing.
fn presence(all: &Wald, free: &[FreeParameter], model: &Model, c: &Candidate, extent: &Extent) -> Wald {
    let companions = companions(c, model);
    let held: Vec<usize> = (0..free.len()).filter(|i| companions.contains(&free[*i].column.parameter)).collect();
    all.given(&positions(free, c, extent), &held)
}

/// Sets a candidate's parameters to amplitudes in units of their scales, on top of what they are.
fn start_at(model: &mut Model, c: &Candidate, extent: &Extent, amplitude: &DVector<f64>) {
    for (p, a) in candidate_parameters(c, extent).iter().zip(amplitude.iter()) {
        let value = a * p.column.scale;
        p.set(model, value + if p.sessions.is_none() { p.value(model) } else { 0.0 });
    }
}

/// Values of some free parameters of an estimate, with their covariance, in units of their columns.
pub(super) struct Wald {
    pub value: DVector<f64>,
    pub covariance: DMatrix<f64>,
}

impl Wald {
    /// All free parameters of an estimate.
    pub fn of(found: &Estimate, covariance: DMatrix<f64>) -> Self {
        let value = |f: &FreeParameter| f.value(&found.model) / f.column.scale;
        Self { value: DVector::from_iterator(found.free.len(), found.free.iter().map(value)), covariance }
    }

    /// Squared distance from zero in units of the covariance.
    pub fn statistic(&self) -> f64 {
        let inverse = self.covariance.clone().try_inverse();
        inverse.map_or(0.0, |inverse| (self.value.transpose() * inverse * &self.value)[(0, 0)])
    }

    /// The same with some parameters held where they are.
    fn given(&self, of: &[usize], held: &[usize]) -> Self {
        let mut part = self.part(of);
        if let Some(inverse) = pick(&self.covariance, held, held).try_inverse() {
            let cross = pick(&self.covariance, of, held);
            part.covariance -= &cross * inverse * cross.transpose();
        }
        part
    }

    /// The part that concerns some of the parameters.
    pub fn part(&self, of: &[usize]) -> Self {
        Self { value: DVector::from_fn(of.len(), |i, _| self.value[of[i]]), covariance: pick(&self.covariance, of, of) }
    }
}

/// All free parameters of an estimate with their covariance.
pub(super) fn wald(found: &Estimate, integration: Integration, runs: &[Run]) -> Wald {
    let columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let p = passes(&found.model, integration, &columns, runs, &found.noise, false);
    let e = evidence(runs, &p, &restrictions(&found.free));
    Wald::of(found, base_of(&e, &found.model, &found.free).inverse)
}

/// A mechanism may be named: seen, significant, of possible sign and worthwhile size, and not just the ship's own forces in
/// another form.
pub(super) fn acceptable(r: &Row, list: &[Candidate], settings: &Settings) -> bool {
    let m = list[r.candidate].mechanism;
    // Sessions differ in what was sailed, and a ship's forces in another form then differ between them: its own physics must
    // stand out further.
    let alpha = if m.needs_reference && m.kind == Kind::Ship { 0.02 * settings.alpha } else { settings.alpha };
    r.visible && r.admissible && r.p < alpha && r.size >= 1.0 && r.second_opinion < 0.01
}

/// Whether a further mechanism may be named beside those that are: it must be beyond doubt, and more than what an imperfect
/// form of an earlier one leaves behind.
pub(super) fn acceptable_beside(r: &Row, taken: &[Accepted], list: &[Candidate]) -> bool {
    let m = list[r.candidate].mechanism;
    let leftover = |a: &Accepted| {
        let first = list[a.candidate].mechanism;
        let alike = m.looks_like(first);
        // Changes of the ship's own forces between sessions: the form of the first cannot be told from a second.
        let same_parting =
            a.extent != Extent::All && r.extent != Extent::All && m.needs_reference && first.needs_reference;
        same_parting || (alike && r.test.statistic < 0.4 * a.statistic)
    };
    r.p < 1e-6 && taken.iter().all(|a| a.candidate != r.candidate && !leftover(a))
}

/// The model with a mechanism at the amplitudes of a screen, everything else moved along as far as the quadratic model holds,
/// and what is free then: what was, the mechanism's companions, and its own parameters.
pub(super) fn enter(
    s: &Screen,
    list: &[Candidate],
    candidate: usize,
    extent: &Extent,
    amplitude: &DVector<f64>,
    current: &Estimate,
    integration: Integration,
    runs: &[Run],
    noise: &Noise,
) -> (Model, Vec<FreeParameter>) {
    let c = &list[candidate];
    let shift = s.base_shift(s.columns(candidate), extent, amplitude);
    let at = |length: f64, amplitude: &DVector<f64>| {
        let mut model = current.model.clone();
        for (f, d) in current.free.iter().zip(shift.iter()) {
            f.set(&mut model, f.value(&current.model) + length * d * f.column.scale);
        }
        start_at(&mut model, c, extent, amplitude);
        let value = log_posterior(&model, integration, runs, &current.free, noise);
        (model, value)
    };
    let mut starts: Vec<_> = [1.0, 0.3, 0.1].map(|share| at(share, &(amplitude * share))).into();
    if c.mechanism.probe == Probe::Odd {
        // An effect that grows with the square of its amplitude: the slope where it was probed says little of its size.
        let mut rooted = amplitude.clone();
        for i in (0..amplitude.len()).step_by(c.columns.len().max(1)) {
            let mut own = rooted.rows_mut(i, c.columns.len());
            own /= own.norm().max(1e-12).sqrt();
        }
        starts.push(at(1.0, &rooted));
        starts.extend([3.0, 10.0, 30.0].map(|share| at(0.0, &(amplitude * share))));
    }
    let best = starts.into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a });
    let model = best.map_or_else(|| current.model.clone(), |(model, _)| model);
    let mut free = current.free.clone();
    // Uncertain once it acts, and free with what is known of them.
    for parameter in companions(c, &model) {
        if free.iter().all(|f| f.column.parameter != parameter) {
            free.push(FreeParameter::uncertain(&model, parameter));
        }
    }
    free.extend(candidate_parameters(c, extent));
    (model, free)
}

/// A mechanism that may enter, and how a screen would have it start.
struct Contender {
    candidate: usize,
    extent: Extent,
    amplitude: DVector<f64>,
    statistic: f64,
    p: f64,
}

impl Contender {
    fn of(row: &Row) -> Self {
        Self {
            candidate: row.candidate,
            extent: row.extent.clone(),
            amplitude: row.test.amplitude.clone(),
            statistic: row.test.statistic,
            p: row.p,
        }
    }

    /// A look-alike in the leader's place: where a law bends, its slope at nothing promises less than it holds, so that it is
    /// tried in the leader's sessions whatever its own test says. A coefficient does not change with the day.
    fn in_place_of(row: &Row, leader: &Row, s: &Screen, list: &[Candidate]) -> Option<Self> {
        let by_day = matches!(leader.extent, Extent::Each(_));
        if row.extent == leader.extent || (by_day && !list[row.candidate].mechanism.is_weather()) {
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
}

/// Most rivals that are refitted beside a leader.
const RIVALS: usize = 3;

/// Who is refitted beside the leader: look-alikes from outside the ship, and whoever promises nearly as much.
fn rivals(s: &Screen, leaders: &[&Row], list: &[Candidate]) -> Vec<Contender> {
    let leader = leaders[0];
    let first = list[leader.candidate].mechanism;
    let alike = |r: &&Row| {
        let m = list[r.candidate].mechanism;
        r.candidate != leader.candidate && m.kind == Kind::Environment && r.visible && m.looks_like(first)
    };
    let mut out: Vec<Contender> = Vec::new();
    if first.kind == Kind::Environment {
        out.extend(s.rows.iter().filter(alike).filter_map(|r| Contender::in_place_of(r, leader, s, list)));
    }
    // A rival whose promised gain is far below the leader's does not overtake it.
    let gain_needed = leader.test.statistic - f64::max(60.0, 0.3 * leader.test.statistic);
    let near = leaders[1..]
        .iter()
        .filter(|r| r.test.statistic > gain_needed)
        // What acts in some sessions only is alike by what those sessions sailed.
        .filter(|r| r.extent != Extent::All || s.likeness(leader.candidate, r.candidate) > 0.3);
    for r in near {
        if out.iter().all(|c| c.candidate != r.candidate) {
            out.push(Contender::of(r));
        }
    }
    out.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    out.truncate(RIVALS);
    out
}

/// How much less than the best of what gains so much log-likelihood a rival may explain and yet be the truer form: the law of a
/// force is known only so well.
fn form(gain: f64) -> f64 {
    (FORM_UNKNOWN * gain).max(CLOSE)
}

/// Why a competition has no winner.
pub(super) enum Fall {
    /// What the leader promised is not there once it is refitted, or undoes something else.
    Faded,
    /// It is there, but the leader's own coefficients are not where such coefficients are: something else, in its clothes.
    Disguised,
}

/// Refits the leader and its rivals, and returns the best with its confidence set.
pub(super) fn compete(
    s: &Screen,
    leaders: &[&Row],
    current: &Estimate,
    arena: Arena,
) -> Result<(Accepted, Estimate), Fall> {
    let Arena { integration, runs, list, prior, settings } = arena;
    let leader = *leaders.first().ok_or(Fall::Faded)?;
    let refit = |c: &Contender, noise: &Noise, effort: Effort, least: f64| {
        let (model, free) = enter(s, list, c.candidate, &c.extent, &c.amplitude, current, integration, runs, noise);
        estimate_above(least, &model, integration, runs, &free, noise, prior, effort)
    };
    let is_there = |(r, e, _): &(Contender, Estimate, f64)| {
        let c = &list[r.candidate];
        let w = presence(&wald(e, integration, runs), &e.free, &e.model, c, &r.extent);
        // The likelihood itself must hold what the scores promised.
        let gain = 2.0 * (e.log_posterior - current.log_posterior);
        let statistic = w.statistic().min(gain.max(0.0));
        chi_squared_p(statistic, w.value.len()) * (leaders.len().max(1) as f64) < settings.alpha
            && c.size(w.value.as_slice()) >= 1.0
            && !undoes(c, e, runs)
    };
    let as_itself = |(r, e, _): &(Contender, Estimate, f64)| plausible(e, &list[r.candidate]);
    let price = |c: &Contender| PRICE * c.amplitude.len() as f64;
    let own = Contender::of(leader);
    let lead = refit(&own, &current.noise, SETTLE, f64::NEG_INFINITY);
    let noise = lead.noise;
    let v = lead.log_posterior - price(&own);
    let first = (own, lead, v);
    // Behind a leader that stands, a rival that stays further back than any set is wide changes nothing.
    let there = is_there(&first);
    let fall = if there { Fall::Disguised } else { Fall::Faded };
    let (least, mut field) = if there && as_itself(&first) {
        (v - form(v - current.log_posterior), vec![first])
    } else {
        (f64::NEG_INFINITY, Vec::new())
    };
    for r in rivals(s, leaders, list) {
        let price = price(&r);
        let e = refit(&r, &noise, REFIT, least + price);
        let v = e.log_posterior - price;
        let rival = (r, e, v);
        if v < least || (as_itself(&rival) && is_there(&rival)) {
            field.push(rival);
        }
    }
    field.sort_by(|a, b| b.2.total_cmp(&a.2));
    let best = field.first().ok_or(fall)?.2;
    let width = match list[field[0].0.candidate].mechanism.kind {
        Kind::Sensor | Kind::Actuator => CLOSE,
        Kind::Environment | Kind::Ship => form(best - current.log_posterior),
    };
    let near = |(_, _, v): &(Contender, Estimate, f64)| best - v < width;
    // A force without a cause gives way to any cause that comes near.
    let stands_in = |f: &(Contender, Estimate, f64)| list[f.0.candidate].mechanism.stand_in;
    if field.iter().any(|f| near(f) && !stands_in(f)) {
        field.retain(|f| !stands_in(f));
    }
    let set: Vec<usize> = field.iter().filter(|f| near(f)).map(|(c, _, _)| c.candidate).collect();
    let why = if set.len() > 1 {
        let alike: Vec<String> = set[1..]
            .iter()
            .map(|c| format!("{} (likeness {:.2})", list[*c].mechanism.title, s.likeness(set[0], *c)))
            .collect();
        format!("these fit within {width:.0} units of log-likelihood of each other: {}", alike.join(", "))
    } else if let Some((r, _, v)) = field.get(1) {
        let title = list[r.candidate].mechanism.title;
        // Who was given up may have been further ahead than it got.
        let (over, by) = if *v < least { ("over ", best - least) } else { ("", best - v) };
        format!("next best, {title}, fits {over}{by:.0} units of log-likelihood worse")
    } else {
        "no other mechanism of the catalogue comes near".into()
    };
    let (r, e, _) = field.swap_remove(0);
    // The leader's noise was estimated with it; a rival that won deserves the same.
    let e = if r.candidate == leader.candidate {
        e
    } else {
        estimate(&e.model, integration, runs, &e.free, &e.noise, prior, SETTLE)
    };
    let entry = Accepted {
        candidate: r.candidate,
        statistic: 2.0 * (e.log_posterior - current.log_posterior).max(0.5 * r.statistic),
        p: r.p.min(leader.p),
        extent: r.extent,
        set,
        why,
    };
    Ok((entry, e))
}

/// Drops an accepted mechanism that a later one made needless.
pub(super) fn backward(accepted: &mut Vec<Accepted>, current: &mut Estimate, arena: Arena) {
    let Arena { integration, runs, list, prior, settings } = arena;
    if accepted.len() < 2 {
        return;
    }
    let all = wald(current, integration, runs);
    let needless = accepted[..accepted.len() - 1].iter().position(|a| {
        let c = &list[a.candidate];
        let w = presence(&all, &current.free, &current.model, c, &a.extent);
        chi_squared_p(w.statistic(), w.value.len()) > 0.1 * settings.alpha || c.size(w.value.as_slice()) < 1.0
    });
    let Some(i) = needless else { return };
    let needless = accepted.remove(i);
    let (model, free) = without(current, &list[needless.candidate], &needless.extent);
    *current = estimate(&model, integration, runs, &free, &current.noise, prior, SETTLE);
}

/// The model and what is free in it once a mechanism is taken out.
fn without(current: &Estimate, c: &Candidate, extent: &Extent) -> (Model, Vec<FreeParameter>) {
    let (mut model, mut free) = (current.model.clone(), current.free.clone());
    let mut places = positions(&free, c, extent);
    places.sort_unstable();
    for at in places.into_iter().rev() {
        let f = free.remove(at);
        let neutral = (model.parameters[f.column.parameter].info.default)(&model.ship);
        f.set(&mut model, if f.sessions.is_some() { 0.0 } else { neutral });
    }
    (model, free)
}

/// Lets every mechanism from outside the ship compete again beside those that were found after it: what it stood for alone may
/// have another name now.
pub(super) fn swap(accepted: &mut [Accepted], current: &mut Estimate, arena: Arena) {
    let Arena { integration, runs, list, prior, settings } = arena;
    let outside = |candidate: usize| list[candidate].mechanism.kind == Kind::Environment;
    for i in 0..accepted.len().saturating_sub(1) {
        if !outside(accepted[i].candidate) {
            continue;
        }
        let (model, free) = without(current, &list[accepted[i].candidate], &accepted[i].extent);
        let rest = estimate(&model, integration, runs, &free, &current.noise, prior, REFIT);
        let others: Vec<Accepted> =
            accepted.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, a)| a.clone()).collect();
        let s = screen(&rest, integration, runs, list);
        let may =
            |r: &&Row| outside(r.candidate) && acceptable(r, list, settings) && acceptable_beside(r, &others, list);
        let leaders: Vec<&Row> = s.rows.iter().filter(may).collect();
        let Ok((entry, found)) = compete(&s, &leaders, &rest, arena) else { continue };
        if entry.candidate != accepted[i].candidate || entry.extent != accepted[i].extent {
            // Who is in was estimated to the end, beside what came after it: a newcomer must do better than that, and a force
            // without a cause better than any cause that comes near.
            let value = |a: &Accepted, e: &Estimate| {
                e.log_posterior - PRICE * positions(&e.free, &list[a.candidate], &a.extent).len() as f64
            };
            let stands_in = |a: &Accepted| list[a.candidate].mechanism.stand_in;
            let needed = if stands_in(&entry) && !stands_in(&accepted[i]) {
                form(found.log_posterior - rest.log_posterior)
            } else {
                0.0
            };
            if value(&entry, &found) - value(&accepted[i], current) <= needed {
                continue;
            }
            *current = found;
        }
        accepted[i] = entry;
    }
}
