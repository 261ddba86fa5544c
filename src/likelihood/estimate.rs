//! The best model of a given structure: parameters with priors by Fisher scoring on the filter's scores, noise by maximum
//! likelihood, in turn. Which parameters are free, and what is concluded, is decided elsewhere.

use super::evidence::{Base, Evidence, RunEvidence};
use super::filter::{Column, Filter, GATE, Pass, Tangent, Wanted};
use super::noise::fit::{KeptInformation, fit_noise};
use super::noise::{Noise, NoisePrior};
use super::optimise::{Outcome, Proposal, Quadratic};
pub use super::parameters::FreeParameter;
pub use super::settings::Effort;
use super::settings::{
    CALM_ITERATIONS, CALM_SHARE, OUTLIER_SHARE, STEP_DAMPING, STEP_GAIN, STEP_LONGEST, STEP_SHORTEST,
};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::{DMatrix, DVector};

/// A fitted structure.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The model with its estimated values.
    pub model: Model,
    /// The noise.
    pub noise: Noise,
    /// What was free.
    pub free: Vec<FreeParameter>,
    /// Log-likelihood plus log-prior at the estimate.
    pub log_posterior: f64,
    /// Information of the free parameters in the runs that it was estimated from, where the last pass over them gave it.
    pub seen: Option<DMatrix<f64>>,
}

impl Estimate {
    /// Information of the free parameters in the runs that it was estimated from, and of their priors, in units of their columns.
    pub fn information(&self, integration: Integration, runs: &[Run]) -> DMatrix<f64> {
        let by_a_pass = || {
            let columns: Vec<Column> = self.free.iter().map(|f| f.column).collect();
            let filter = Filter::new(&self.model, integration, &columns);
            Sums::of(&filter, runs, &self.noise, &restrictions(&self.free), false).evidence.total.information
        };
        let mut information = self.seen.clone().unwrap_or_else(by_a_pass);
        for (i, free) in self.free.iter().enumerate() {
            information[(i, i)] += free.prior_terms(&self.model).0;
        }
        information
    }
}

/// One pass over all runs, for scores, information and innovations; filtered states are dropped.
pub fn passes(
    model: &Model,
    integration: Integration,
    columns: &[Column],
    runs: &[Run],
    noise: &Noise,
    tangent: bool,
) -> Vec<Pass> {
    let filter = Filter::new(model, integration, columns);
    let mut out = Vec::with_capacity(runs.len());
    let kept = |_: &Run, pass: Pass| Pass { filtered: Vec::new(), force_sd: Vec::new(), ..pass };
    filter.each(runs, noise, Wanted { tangent, ..Wanted::default() }, kept, |pass| out.push(pass));
    out
}

/// Scores and information of passes over runs.
///
/// `sessions[c]` restricts column c to runs of those sessions; columns beyond the slice act in every run.
pub fn evidence(runs: &[Run], passes: &[Pass], sessions: &[Option<Vec<String>>]) -> Evidence {
    let of = |(r, p): (&Run, &Pass)| run_evidence(r, p.score.clone(), p.information.clone(), sessions);
    Evidence::new(runs.iter().zip(passes).map(of).collect())
}

/// Score and information of one run, without those of columns that are restricted to other sessions.
pub fn run_evidence(
    run: &Run,
    mut score: DVector<f64>,
    mut information: DMatrix<f64>,
    sessions: &[Option<Vec<String>>],
) -> RunEvidence {
    for (c, only) in sessions.iter().enumerate() {
        if only.as_ref().is_some_and(|s| !s.contains(&run.session)) {
            score[c] = 0.0;
            information.row_mut(c).fill(0.0);
            information.column_mut(c).fill(0.0);
        }
    }
    RunEvidence { session: run.session.clone(), score, information }
}

/// What passes over all runs add up to.
pub struct Sums {
    /// Scores and information.
    pub evidence: Evidence,
    /// Log-likelihood.
    pub log_likelihood: f64,
    used: usize,
    outliers: usize,
}

impl Sums {
    /// Passes over all runs; `sessions` as for [`evidence`]. Sums by session are kept where `apart`.
    pub fn of(filter: &Filter, runs: &[Run], noise: &Noise, sessions: &[Option<Vec<String>>], apart: bool) -> Self {
        Self::and_step_maps(filter, runs, noise, sessions, apart, None)
    }

    /// As [`Self::of`]; the step maps of the runs, linearised along their filtered paths, are added to `maps`.
    fn and_step_maps(
        filter: &Filter,
        runs: &[Run],
        noise: &Noise,
        sessions: &[Option<Vec<String>>],
        apart: bool,
        mut maps: Option<&mut Vec<Tangent>>,
    ) -> Self {
        let mut out = Self { evidence: Evidence::default(), log_likelihood: 0.0, used: 0, outliers: 0 };
        let work = |run: &Run, pass: Pass| {
            let Pass { score, information, log_likelihood, used, outliers, tangent, .. } = pass;
            (run_evidence(run, score, information, sessions), log_likelihood, used, outliers, tangent)
        };
        let wanted = Wanted { tangent: maps.is_some(), sums_only: true, ..Wanted::default() };
        filter.each(runs, noise, wanted, work, |(one, log_likelihood, used, outliers, tangent)| {
            out.evidence.add(one, apart);
            out.log_likelihood += log_likelihood;
            out.used += used;
            out.outliers += outliers;
            if let Some(maps) = &mut maps {
                maps.extend(tangent);
            }
        });
        out
    }

    /// Share of the measurements that were set aside as outliers.
    fn outlier_share(&self) -> f64 {
        self.outliers as f64 / (self.outliers + self.used).max(1) as f64
    }
}

/// The step maps of some runs, linearised along their filtered paths.
fn tangents(model: &Model, integration: Integration, runs: &[&Run], noise: &Noise) -> Vec<Tangent> {
    let filter = Filter::new(model, integration, &[]);
    let wanted = Wanted { tangent: true, sums_only: true, ..Wanted::default() };
    let mut out = Vec::with_capacity(runs.len());
    let tangent = |_: &Run, pass: Pass| pass.tangent.unwrap_or_default();
    filter.each(runs, noise, wanted, tangent, |tangent| out.push(tangent));
    out
}

/// The session restrictions of free parameters, in their order.
pub fn restrictions(free: &[FreeParameter]) -> Vec<Option<Vec<String>>> {
    free.iter().map(|f| f.sessions.clone()).collect()
}

/// The base block of free parameters that are the first columns of the evidence.
pub fn base_of(evidence: &Evidence, model: &Model, free: &[FreeParameter]) -> Base {
    let (precision, pull): (Vec<f64>, Vec<f64>) = free.iter().map(|f| f.prior_terms(model)).unzip();
    evidence.base(&(0..free.len()).collect::<Vec<_>>(), &precision, &pull)
}

/// The quadratic model of the log-posterior in the free parameters, in units of their columns.
fn quadratic(Evidence { total, .. }: &Evidence, model: &Model, free: &[FreeParameter]) -> Quadratic {
    let (mut information, mut score) = (total.information.clone(), total.score.clone());
    let mut room = Vec::with_capacity(free.len());
    for (i, f) in free.iter().enumerate() {
        let (precision, pull) = f.prior_terms(model);
        information[(i, i)] += precision;
        score[i] += pull;
        let (now, (least, most)) = (f.value(model) / f.column.scale, f.bounds(model));
        room.push((least - now, most - now));
    }
    Quadratic { information, score, room }
}

/// The model after a step of the free parameters, in units of their columns; values stay inside their bounds.
pub fn moved(model: &Model, free: &[FreeParameter], step: &DVector<f64>) -> Model {
    let mut out = model.clone();
    for (f, s) in free.iter().zip(step.iter()) {
        f.set(&mut out, f.value(model) + s * f.column.scale);
    }
    out
}

/// Log-likelihood plus log-prior of a model.
pub fn log_posterior(
    model: &Model,
    integration: Integration,
    runs: &[Run],
    free: &[FreeParameter],
    noise: &Noise,
) -> f64 {
    let likelihood = Sums::of(&Filter::new(model, integration, &[]), runs, noise, &[], false).log_likelihood;
    likelihood + free.iter().map(|f| f.log_prior(model)).sum::<f64>()
}

/// The noise of the calmer runs, from that of all of them: what disturbs some runs only is no noise.
pub fn calm_noise(model: &Model, noise: &Noise, integration: Integration, runs: &[Run], prior: &NoisePrior) -> Noise {
    let filter = Filter::new(model, integration, &[]);
    let wanted = Wanted { sums_only: true, ..Wanted::default() };
    let share = |run: &Run, pass: Pass| pass.log_likelihood / run.measured.len() as f64;
    let mut likelihood = Vec::with_capacity(runs.len());
    filter.each(runs, noise, wanted, share, |share| likelihood.push(share));
    let mut order: Vec<usize> = (0..runs.len()).collect();
    order.sort_by(|a, b| likelihood[*b].total_cmp(&likelihood[*a]));
    order.truncate((CALM_SHARE * runs.len() as f64).ceil() as usize);
    order.sort_unstable();
    let some: Vec<&Run> = order.iter().map(|i| &runs[*i]).collect();
    let tangents = tangents(model, integration, &some, noise);
    let tangents: Vec<&Tangent> = tangents.iter().collect();
    let kept = &mut KeptInformation::default();
    fit_noise(&some, &tangents, model, noise, prior, GATE, CALM_ITERATIONS, kept)
}

/// The noise of all runs by maximum likelihood, under step maps that are linearised along their filtered paths.
///
/// Where many measurements are beyond the gate the noise is too small by far, and a gate hides that: everything counts first.
pub fn fitted_noise(
    model: &Model,
    integration: Integration,
    runs: &[Run],
    noise: &Noise,
    prior: &NoisePrior,
    iterations: usize,
    kept: &mut KeptInformation,
) -> Noise {
    let all: Vec<&Run> = runs.iter().collect();
    let filter = Filter::new(model, integration, &[]);
    let mut maps = Vec::with_capacity(runs.len());
    let sums = Sums::and_step_maps(&filter, runs, noise, &[], false, Some(&mut maps));
    gated_noise(&all, &maps, model, noise, prior, sums.outlier_share(), iterations, kept)
}

fn gated_noise(
    runs: &[&Run],
    maps: &[Tangent],
    model: &Model,
    noise: &Noise,
    prior: &NoisePrior,
    outliers: f64,
    iterations: usize,
    kept: &mut KeptInformation,
) -> Noise {
    let maps: Vec<&Tangent> = maps.iter().collect();
    let gates = if outliers > OUTLIER_SHARE { &[f64::INFINITY, GATE][..] } else { &[GATE] };
    gates.iter().fold(*noise, |noise, gate| fit_noise(runs, &maps, model, &noise, prior, *gate, iterations, kept))
}

/// Fits the free parameters and the noise, starting from the model's values.
///
/// A step that lowers the log-posterior is tried again with more damping, at most five times. Values stay inside the parameters'
/// bounds.
pub fn estimate(
    start: &Model,
    integration: Integration,
    runs: &[Run],
    free: &[FreeParameter],
    noise: &Noise,
    prior: &NoisePrior,
    effort: Effort,
) -> Estimate {
    estimate_above(f64::NEG_INFINITY, start, integration, runs, free, noise, prior, effort)
}

/// As [`estimate`], given up where even twice the gain that the quadratic model predicts ends below a log-posterior of `least`.
pub fn estimate_above(
    least: f64,
    start: &Model,
    integration: Integration,
    runs: &[Run],
    free: &[FreeParameter],
    noise: &Noise,
    prior: &NoisePrior,
    effort: Effort,
) -> Estimate {
    let columns = free.iter().map(|f| f.column).collect();
    let fit = Fit { integration, runs, free, columns, prior, effort };
    let mut point = fit.at(start.clone(), *noise, if effort.rounds > 0 { Beside::Slopes } else { Beside::Nothing });
    let (mut damping, mut refused, mut kept) = (0.0, false, KeptInformation::default());
    for round in 0..effort.rounds {
        point = fit.differentiated(point);
        let quadratic = quadratic(&point.sums.evidence, &point.model, free);
        // A nonlinear law may gain more than its slope at the start predicts: never before the first step.
        if round > 0 && least.is_finite() && point.value + 2.0 * quadratic.promise(&quadratic.step(0.0)) < least {
            break;
        }
        let (fits_noise, last) = (round < effort.noise_rounds, round + 1 == effort.rounds);
        let beside = match (fits_noise, last) {
            (true, _) => Beside::StepMaps,
            (false, true) => Beside::Nothing,
            (false, false) => Beside::Slopes,
        };
        let (next, length) = fit.step(&point, &quadratic, &mut damping, beside);
        let settled = match &next {
            None => true,
            Some(next) => length < STEP_SHORTEST || next.value - point.value < STEP_GAIN,
        };
        // A noise that was refused at this point would be refused again.
        refused &= next.is_none();
        point = next.unwrap_or(point);
        let before = point.value;
        if fits_noise && !refused {
            let better = fit.better_noise(&mut point, if last { Beside::Nothing } else { Beside::Slopes }, &mut kept);
            refused = better.is_none();
            point = better.unwrap_or(point);
        }
        if settled && point.value - before < STEP_GAIN {
            break;
        }
    }
    let Point { model, noise, sums, value, differentiated, .. } = point;
    let seen = differentiated.then_some(sums.evidence.total.information);
    Estimate { model, noise, free: free.to_vec(), log_posterior: value, seen }
}

/// What a Newton step inside the bounds promises from where an estimate ended, in likelihood units.
pub fn left_to_gain(found: &Estimate, integration: Integration, runs: &[Run]) -> f64 {
    let columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let filter = Filter::new(&found.model, integration, &columns);
    let Sums { evidence, .. } = Sums::of(&filter, runs, &found.noise, &restrictions(&found.free), false);
    let quadratic = quadratic(&evidence, &found.model, &found.free);
    quadratic.promise(&quadratic.step(0.0))
}

/// A fit of free parameters and noise to runs.
struct Fit<'a> {
    integration: Integration,
    runs: &'a [Run],
    free: &'a [FreeParameter],
    columns: Vec<Column>,
    prior: &'a NoisePrior,
    effort: Effort,
}

/// A model and a noise with the sums of the passes over all runs.
struct Point {
    model: Model,
    noise: Noise,
    sums: Sums,
    /// Log-likelihood plus log-prior.
    value: f64,
    /// Whether the sums contain scores and information.
    differentiated: bool,
    /// The step maps along the filtered paths, where they were asked for.
    step_maps: Option<Vec<Tangent>>,
}

/// What the passes at a point give beside its value.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    Nothing,
    /// Scores and information, from which a step is taken.
    Slopes,
    /// The linearised step maps, to which a noise is fitted.
    StepMaps,
}

impl Fit<'_> {
    /// The point of a model and a noise; its value has the same bits whatever is asked for beside it.
    fn at(&self, model: Model, noise: Noise, beside: Beside) -> Point {
        let differentiated = beside == Beside::Slopes;
        let (columns, restrictions) = if differentiated {
            (self.columns.as_slice(), restrictions(self.free))
        } else {
            (Default::default(), Vec::new())
        };
        let filter = Filter::new(&model, self.integration, columns);
        let mut step_maps = (beside == Beside::StepMaps).then(|| Vec::with_capacity(self.runs.len()));
        let sums = Sums::and_step_maps(&filter, self.runs, &noise, &restrictions, false, step_maps.as_mut());
        let log_prior = self.free.iter().map(|f| f.log_prior(&model)).sum::<f64>();
        let value = sums.log_likelihood + log_prior;
        Point { model, noise, sums, value, differentiated, step_maps }
    }

    /// The point with its scores and information.
    fn differentiated(&self, point: Point) -> Point {
        if point.differentiated { point } else { self.at(point.model, point.noise, Beside::Slopes) }
    }

    /// The point after a step of the parameters, where one gains, and the length of the last step that was tried.
    ///
    /// A pass with derivatives costs three without: of the steps that are tried only the first has them, and only where it is no end by
    /// its length. Steps after it are mostly refused.
    fn step(&self, from: &Point, quadratic: &Quadratic, damping: &mut f64, beside: Beside) -> (Option<Point>, f64) {
        let propose = |damping: f64| {
            let mut step = quadratic.step(damping);
            let length = step.amax();
            if length > STEP_LONGEST {
                step *= STEP_LONGEST / length;
            }
            let promise = quadratic.promise(&step);
            Some(Proposal { step: (step, length.min(STEP_LONGEST)), promise })
        };
        let mut first = true;
        let evaluate = |(step, length): &(DVector<f64>, f64)| {
            let ends = beside == Beside::Slopes && (!first || *length < STEP_SHORTEST);
            let point =
                self.at(moved(&from.model, self.free, step), from.noise, if ends { Beside::Nothing } else { beside });
            first = false;
            let value = point.value;
            (point, value)
        };
        let Outcome { taken, last, .. } = STEP_DAMPING.search(from.value, damping, propose, evaluate);
        (taken.map(|(point, _)| point), last.map_or(0.0, |(_, length)| length))
    }

    /// The point with the noise fitted to all runs, linearised; `None` where that is no better than the noise of the point.
    fn better_noise(&self, point: &mut Point, beside: Beside, kept: &mut KeptInformation) -> Option<Point> {
        let trial = self.at(point.model.clone(), self.noise(point, kept), beside);
        (trial.value > point.value).then_some(trial)
    }

    /// The noise of the runs at a point, whose step maps it takes. Of all of them: from a part of them the answer would depend on
    /// their order.
    fn noise(&self, point: &mut Point, kept: &mut KeptInformation) -> Noise {
        let all: Vec<&Run> = self.runs.iter().collect();
        let maps = point.step_maps.take();
        let Point { model, noise, sums, .. } = point;
        let tangents = maps.unwrap_or_else(|| tangents(model, self.integration, &all, noise));
        gated_noise(&all, &tangents, model, noise, self.prior, sums.outlier_share(), self.effort.noise_iterations, kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, at, column, model, noise, runs, with};
    use crate::likelihood::settings::{REFIT, SETTLE};

    #[test]
    fn a_value_stays_inside_its_bounds_and_so_does_its_sum_with_the_addition_of_a_session() {
        let mut m = with(&[("rudder_offset.offset", 0.3)]);
        let c = column(&m, "rudder_offset.offset");
        let addition = FreeParameter { column: c, sessions: Some(vec!["a".into(), "b".into()]), prior: None };
        let (least, most) = addition.bounds(&m);
        assert!((least * c.scale + 0.65).abs() < 1e-12 && (most * c.scale - 0.05).abs() < 1e-12);
        addition.set(&mut m, 0.2);
        assert!((addition.value(&m) - 0.05).abs() < 1e-12);
        assert!((m.values_in("b")[c.parameter] - 0.35).abs() < 1e-12 && m.values_in("c")[c.parameter] == 0.3);
        FreeParameter::common(c, None).set(&mut m, -1.0);
        assert_eq!(m.parameters[c.parameter].value, -0.35);
    }

    #[test]
    fn the_terms_of_a_prior_are_the_slope_and_curvature_of_its_logarithm() {
        let mut m = model();
        let f = FreeParameter::uncertain(&m, m.find("hull.Yv").unwrap());
        assert_eq!((f.prior_terms(&m).1, f.log_prior(&m)), (0.0, 0.0));
        let unit = f.column.scale;
        let start = f.value(&m);
        let mut at = |steps: f64| {
            f.set(&mut m, start + steps * unit);
            (f.log_prior(&m), f.prior_terms(&m))
        };
        let (low, high) = (at(0.9).0, at(1.1).0);
        let (middle, (precision, pull)) = at(1.0);
        assert!(((high - low) / 0.2 - pull).abs() < 1e-9 * pull.abs());
        assert!(((high - 2.0 * middle + low) / 0.01 + precision).abs() < 1e-6 * precision);
    }

    #[test]
    fn a_column_of_some_sessions_takes_no_evidence_from_the_others() {
        let m = model();
        let runs = runs(&m, 4);
        let columns = [column(&m, "rudder.lift1"), column(&m, "current.north")];
        let p = passes(&m, RK4, &columns, &runs, &noise(), false);
        let e = evidence(&runs, &p, &[None, Some(vec!["a".into()])]);
        let in_a: f64 = p.iter().zip(&runs).filter(|(_, r)| r.session == "a").map(|(p, _)| p.score[1]).sum();
        assert_eq!(e.total.score[1], in_a);
        assert_eq!((e.sessions["b"].score[1], e.sessions["b"].information[(0, 1)]), (0.0, 0.0));
        assert!(e.sessions["b"].information[(0, 0)] > 0.0);
    }

    #[test]
    fn a_point_has_the_same_value_and_step_maps_whatever_is_asked_for_beside_it() {
        let m = model();
        let (runs, free, prior) = (runs(&m, 5), at(&m).free, NoisePrior::around(&noise()));
        for method in [crate::simulate::Method::Rk4, crate::simulate::Method::Euler] {
            let integration = Integration { method, substeps: 1 };
            let columns = free.iter().map(|f| f.column).collect();
            let fit = Fit { integration, runs: &runs, free: &free, columns, prior: &prior, effort: REFIT };
            let [with, without, maps] =
                [Beside::Slopes, Beside::Nothing, Beside::StepMaps].map(|b| fit.at(m.clone(), noise(), b));
            assert_eq!((with.value, maps.value), (without.value, without.value));
            let all: Vec<&Run> = runs.iter().collect();
            let by_themselves = tangents(&m, integration, &all, &noise());
            let same = |(a, b): (&Tangent, &Tangent)| a.state == b.state && a.a == b.a && a.offset == b.offset;
            let kept = maps.step_maps.expect("asked for");
            assert!(kept.len() == all.len() && kept.iter().zip(&by_themselves).all(same));
            assert_eq!((with.sums.used, with.sums.outliers), (without.sums.used, without.sums.outliers));
            let later = fit.differentiated(without);
            assert!(later.differentiated && later.sums.evidence.total.score == with.sums.evidence.total.score);
        }
    }

    #[test]
    fn parameters_off_by_a_tenth_come_back_within_their_standard_errors() {
        let truth = model();
        let runs = runs(&truth, 9);
        let mut start = truth.clone();
        for i in start.free() {
            start.parameters[i].value *= 1.1;
        }
        let e = at(&truth);
        let found = estimate(&start, RK4, &runs, &e.free, &noise(), &NoisePrior::around(&noise()), REFIT);
        assert!(found.log_posterior >= log_posterior(&truth, RK4, &runs, &e.free, &noise()));
        let p = passes(&found.model, RK4, &e.free.iter().map(|f| f.column).collect::<Vec<_>>(), &runs, &noise(), false);
        let base = base_of(&evidence(&runs, &p, &restrictions(&e.free)), &found.model, &e.free);
        for (i, f) in e.free.iter().enumerate() {
            let off = (f.value(&found.model) - f.value(&truth)) / (f.column.scale * base.inverse[(i, i)].sqrt());
            assert!(off.abs() < 4.0, "{}: {off}", truth.parameters[f.column.parameter].name);
        }
    }

    #[test]
    fn the_information_of_the_last_pass_is_that_of_a_pass_of_its_own() {
        let truth = model();
        let runs = runs(&truth, 5);
        let (free, prior) = (at(&truth).free, NoisePrior::around(&noise()));
        let found = estimate(&truth, RK4, &runs, &free, &noise(), &prior, REFIT);
        let again = Estimate { seen: None, ..found.clone() };
        assert!(found.seen.is_some());
        assert_eq!(found.information(RK4, &runs), again.information(RK4, &runs));
    }

    #[test]
    fn a_noise_that_had_taken_over_a_force_settles_where_one_that_had_not_does() {
        let truth = model();
        let runs = runs(&truth, 9);
        let (free, prior) = (at(&truth).free, NoisePrior::around(&noise()));
        let settled = |start: &Noise| estimate(&truth, RK4, &runs, &free, start, &prior, SETTLE);
        let taken = Noise { force: noise().force.map(|f| 15.0 * f), force_time: 10.0 * noise().force_time, ..noise() };
        let (near, far) = (settled(&noise()), settled(&taken));
        for (a, b) in near.noise.force.into_iter().zip(far.noise.force) {
            assert!((a / b).ln().abs() < 0.4, "{:?} {:?}", near.noise, far.noise);
        }
        assert!((near.log_posterior - far.log_posterior).abs() < 0.5, "{} {}", near.log_posterior, far.log_posterior);
    }

    #[test]
    fn an_estimate_that_cannot_reach_the_least_log_posterior_ends_early() {
        let truth = model();
        let runs = runs(&truth, 3);
        let mut start = truth.clone();
        start.parameters[truth.find("rudder.lift1").unwrap()].value *= 1.5;
        let (free, prior) = (at(&truth).free, NoisePrior::around(&noise()));
        let of = |least: f64| estimate_above(least, &start, RK4, &runs, &free, &noise(), &prior, REFIT).log_posterior;
        let whole = of(f64::NEG_INFINITY);
        assert!(of(whole + 1e6) < whole && of(whole - 1.0) == whole);
    }

    #[test]
    fn the_score_of_a_column_does_not_depend_on_the_columns_beside_it_nor_much_on_the_rule_over_a_step() {
        use crate::diagnose::evidence::candidate::{append, candidates};
        use crate::diagnose::evidence::generic::GenericLaw;
        let m = with(&[("current.north", 0.1), ("mean_wind.east", 5.0)]);
        let runs = runs(&model(), 3);
        let mut columns: Vec<Column> =
            crate::likelihood::parameters::base_parameters(&m, true).iter().map(|f| f.column).collect();
        append(&mut columns, &candidates(&m, &[]));
        GenericLaw::append(&mut columns, &m);
        let pass = |columns: &[Column], exact: bool| {
            let filter = Filter::new(&m, RK4, columns);
            filter.pass(&runs[2], &noise(), Wanted { exact, ..Wanted::default() })
        };
        let (all, exact) = (pass(&columns, false), pass(&columns, true));
        for (i, c) in columns.iter().enumerate() {
            let alone = pass(&[*c], false);
            let name = &m.parameters[c.parameter].name;
            let near = |a: f64, b: f64, by: f64| (a - b).abs() <= by * a.abs().max(b.abs()) + 1e-9;
            let (h, own) = (all.information[(i, i)], alone.information[(0, 0)]);
            assert!(near(h, own, 1e-9) && near(all.score[i], alone.score[0], 1e-9), "{name}: {h} {own}");
            // An actuator's lag acts within a step too, where the rule over a step does not look.
            let lags = ["engine_lag.", "rudder_lag.", "rudder_rate."].iter().any(|term| name.starts_with(term));
            assert!(lags || near(h, exact.information[(i, i)], 0.1), "{name}: {h} {}", exact.information[(i, i)]);
        }
    }
}
