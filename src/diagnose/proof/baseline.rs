//! Rival methods that the diagnosis is compared with: what a user would do otherwise, and the best that could be done.
//! None of it is part of a diagnosis: a rival names by other rules ([`Refitted`]) or is given the answer ([`oracle`]).

use super::prove::mean_cvdm;
use crate::diagnose::evidence::candidate::{Candidate, Extent, append, applies, candidates};
use crate::diagnose::search::compete::start_with;
use crate::diagnose::search::problem::Problem;
use crate::diagnose::search::screen::screen_by_session;
use crate::diagnose::settings::{GIVEN_FINISH, GIVEN_START, Settings};
use crate::evaluate::Judging;
use crate::likelihood::covariance::Z;
use crate::likelihood::estimate::{Estimate, FreeParameter, base_of, estimate, evidence, moved, restrictions};
use crate::likelihood::evidence::Evidence;
use crate::likelihood::filter::{Column, Filter, Gains, Pass, Wanted};
use crate::likelihood::noise::fit::guess;
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::likelihood::optimise::{Damping, Proposal};
use crate::likelihood::parameters::base_parameters;
use crate::model::{Model, ModelError};
use crate::recording::Run;
use crate::simulate::Integration;
use crate::state::STATES;
use nalgebra::DVector;

/// The model refitted to whole trajectories: its own free parameters by least squares, every residual taken as independent of
/// every other. This is the paper's way to improve a model, without its constraints.
///
/// Minus twice the log-likelihood is, up to a constant, `sum_j n_j ln(sum_k e_kj^2 / n_j)` over the measured channels j, with the
/// residuals e of free simulations from the first measured state.
#[derive(Clone, Debug)]
pub struct Refitted {
    /// The model, every term of the catalogue in it at neutral values.
    pub model: Model,
    /// Mean square residual by channel \[unit of the channel squared\].
    pub variance: [f64; STATES],
    /// Number of scalar measurements.
    pub used: usize,
    free: Vec<FreeParameter>,
    integration: Integration,
    noise: Noise,
}

/// What the Bayesian information criterion says of one mechanism added to the refitted model.
#[derive(Clone, Debug, PartialEq)]
pub struct BicGain {
    /// The mechanism.
    pub mechanism: String,
    /// Amplitudes that the trajectories can see.
    pub degrees: usize,
    /// Decrease of the criterion: `N ln(RSS_0/RSS_1) - k ln N`; the mechanism is worth having when this is positive.
    pub gain: f64,
}

/// Free simulations and their derivatives.
struct Trajectories {
    passes: Vec<Pass>,
    variance: [f64; STATES],
    used: [f64; STATES],
}

impl Trajectories {
    /// Simulates all runs. A filter whose gains are zero never corrects its state: its innovations are the residuals of the
    /// free simulation, its scores and information those of least squares with residuals of these variances.
    fn new(filter: &Filter, runs: &[Run], noise: &Noise, variance: &[f64; STATES], exact: bool) -> Self {
        let open =
            |samples: usize| Gains { variance: vec![*variance; samples], gain: vec![[[0.0; Z]; STATES]; samples] };
        let open: Vec<Gains> = runs.iter().map(|r| open(r.measured.len())).collect();
        let passes = filter.passes(runs, noise, Wanted { frozen: Some(&open), exact, ..Wanted::default() });
        let (mut sums, mut used) = ([0.0; STATES], [0.0; STATES]);
        for innovation in passes.iter().flat_map(|p| &p.innovations) {
            for j in (0..STATES).filter(|j| !innovation[*j].is_nan()) {
                sums[j] += innovation[j] * innovation[j];
                used[j] += 1.0;
            }
        }
        let mean = |j: usize| if used[j] > 0.0 { variance[j] * sums[j] / used[j] } else { variance[j] };
        // A channel that is met exactly would outweigh all others.
        let variance = std::array::from_fn(|j| mean(j).max(1e-12));
        Self { passes, variance, used }
    }

    /// Minus twice the log-likelihood at the variances that fit best; infinite when a simulation diverged.
    fn misfit(&self) -> f64 {
        let sum: f64 = (0..STATES).map(|j| self.used[j] * self.variance[j].ln()).sum();
        // Residuals that are not a number were not counted: the likelihood shows them.
        if self.passes.iter().all(|p| p.log_likelihood.is_finite()) { sum } else { f64::INFINITY }
    }

    fn evidence(&self, runs: &[Run], free: &[FreeParameter]) -> Evidence {
        evidence(runs, &self.passes, &restrictions(free))
    }
}

/// How a step is damped, in units of the information's diagonal.
const DAMPING: Damping =
    Damping { attempts: 30, least_promise: 0.0, loss: 0.0, first: 0.0, most: 1e6, shrink: 0.2, off: 0.0, trusted: 0.0 };

/// Least damping.
const LEAST_DAMPING: f64 = 1e-9;

/// The step of least squares with the information's diagonal raised by a factor, and the priors.
fn damped_step(e: &Evidence, model: &Model, free: &[FreeParameter], damping: f64) -> DVector<f64> {
    let damped = free.iter().enumerate().map(|(i, f)| {
        let (precision, pull) = f.prior_terms(model);
        (precision + damping * e.total.information[(i, i)], pull)
    });
    let (precision, pull): (Vec<f64>, Vec<f64>) = damped.unzip();
    e.base(&(0..free.len()).collect::<Vec<_>>(), &precision, &pull).step()
}

impl Refitted {
    /// Refits the free parameters of a model by the method of Levenberg and Marquardt. `None` when the model as given runs
    /// away in a free simulation, so that there is nothing to start from.
    ///
    /// # Errors
    /// When the catalogue's terms cannot be added to the model.
    pub fn new(model: &Model, runs: &[Run], settings: &Settings) -> Result<Option<Self>, ModelError> {
        let mut model = model.complete()?;
        let integration = settings.integration();
        let free = base_parameters(&model, false);
        let columns: Vec<Column> = free.iter().map(|f| f.column).collect();
        // A pass asks for noise, but with the gains given it changes nothing.
        let noise = guess(runs, &model);
        let at = |m: &Model, variance: &[f64; STATES]| {
            Trajectories::new(&Filter::new(m, integration, &columns), runs, &noise, variance, true)
        };
        // Twice, so that the scores are in units of the residuals there are.
        let first = at(&model, &[1.0; STATES]);
        let mut current = at(&model, &first.variance);
        if !current.misfit().is_finite() {
            return Ok(None);
        }
        let (mut damping, mut attempts) = (1e-3, 30);
        while attempts > 0 {
            let e = current.evidence(runs, &free);
            let propose =
                |damping: f64| Some(Proposal { step: damped_step(&e, &model, &free, damping), promise: f64::INFINITY });
            let evaluate = |step: &DVector<f64>| {
                let trial = moved(&model, &free, step);
                let next = at(&trial, &current.variance);
                let value = -next.misfit();
                ((trial, next), value)
            };
            let value = -current.misfit();
            let out = Damping { attempts, ..DAMPING }.search(value, &mut damping, propose, evaluate);
            attempts -= out.evaluated;
            damping = damping.max(LEAST_DAMPING);
            let Some((next, reached)) = out.taken else { break };
            (model, current) = next;
            // A step that changes the likelihood by less changes no decision.
            if reached - value < 0.1 {
                break;
            }
        }
        let used = current.used.iter().sum::<f64>() as usize;
        Ok(Some(Self { variance: current.variance, model, used, free, integration, noise }))
    }

    /// Every mechanism of the catalogue by its gain in the Bayesian information criterion, best first: each added alone, with
    /// one amplitude in all sessions, by linear least squares in its amplitudes with the free parameters along.
    pub fn ranking(&self, runs: &[Run], withhold: &[String]) -> Vec<BicGain> {
        let list: Vec<Candidate> =
            candidates(&self.model, withhold).into_iter().filter(|c| applies(c.mechanism, runs)).collect();
        let mut columns: Vec<Column> = self.free.iter().map(|f| f.column).collect();
        let groups = append(&mut columns, &list);
        let filter = Filter::new(&self.model, self.integration, &columns);
        let simulated = Trajectories::new(&filter, runs, &self.noise, &self.variance, false);
        let e = simulated.evidence(runs, &self.free);
        let base = base_of(&e, &self.model, &self.free);
        // In units of their own mean squares the residuals' sum of squares is their number.
        let n = self.used as f64;
        let mut out: Vec<BicGain> = list
            .iter()
            .zip(&groups)
            .map(|(c, group)| {
                let test = e.test(&base, group);
                let left = (n - test.statistic).max(1.0);
                let gain = n * (n / left).ln() - test.degrees as f64 * n.ln();
                BicGain { mechanism: c.mechanism.name.into(), degrees: test.degrees, gain }
            })
            .filter(|g| g.degrees > 0)
            .collect();
        out.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        out
    }

    /// Mean cVDM \[%\] on held-out runs, as the diagnosis' proof measures it.
    pub fn held_out(&self, runs: &[Run], judging: &Judging) -> f64 {
        let judging = Judging { integration: self.integration, ..judging.clone() };
        mean_cvdm(&self.model, runs, &judging).unwrap_or(DIVERGED)
    }
}

/// A model that diverges on a test run counts as this far off \[%\], not as missing.
const DIVERGED: f64 = 1e4;

/// A mechanism that the oracle is given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GivenMechanism {
    /// Its name in the catalogue.
    pub mechanism: String,
    /// Where it acts.
    pub extent: Extent,
}

/// Mean cVDM \[%\] on held-out runs, as the diagnosis' proof measures it, of a model that was given the mechanisms that
/// act, and their sessions: estimated and refitted as the diagnosis does with what it finds. How far the held-out error can fall when the
/// name is right. `None` when the catalogue lacks one of them.
///
/// # Errors
/// When the catalogue's terms cannot be added to the model.
pub fn oracle(
    model: &Model,
    runs: &[Run],
    held_out: &[Run],
    settings: &Settings,
    given: &[GivenMechanism],
) -> Result<Option<f64>, ModelError> {
    let full = model.complete()?;
    let integration = settings.integration();
    let list = candidates(&full, &[]);
    let of = |t: &GivenMechanism| list.iter().find(|c| c.mechanism.name == t.mechanism);
    let Some(chosen) = given.iter().map(of).collect::<Option<Vec<_>>>() else { return Ok(None) };
    let first = guess(runs, &full);
    let prior = NoisePrior::around(&first);
    let free = base_parameters(&full, settings.nuisance);
    let mut current = estimate(&full, integration, runs, &free, &first, &prior, GIVEN_START);
    for (given, candidate) in given.iter().zip(chosen) {
        let candidates = std::slice::from_ref(candidate);
        let problem = Problem { integration, runs, candidates, prior: &prior, settings };
        let (start, free) = started(&current, problem, &given.extent);
        current = problem.estimate(&start, &free, &current.noise, GIVEN_FINISH);
    }
    let judging = Judging { integration, ..Settings::default().judging };
    Ok(Some(mean_cvdm(&current.model, held_out, &judging).unwrap_or(DIVERGED)))
}

/// The model with the problem's one mechanism at the amplitudes that a linear step from the estimate gives, and everything else
/// moved along.
fn started(found: &Estimate, problem: Problem, extent: &Extent) -> (Model, Vec<FreeParameter>) {
    let s = screen_by_session(found, problem.integration, problem.runs, problem.candidates, true);
    let test = s.test(0, extent);
    start_with(&s, 0, extent, &test.amplitude, found, problem, &found.noise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, noise, runs};
    use crate::simulate::{Scenario, simulate};

    #[test]
    fn a_filter_without_gains_is_a_free_simulation() {
        let (model, runs) = (model(), runs(&model(), 3));
        let filter = Filter::new(&model, RK4, &[]);
        let t = Trajectories::new(&filter, &runs, &noise(), &[4.0; STATES], true);
        for (run, pass) in runs.iter().zip(&t.passes) {
            let scenario = Scenario { dt: run.dt, inputs: run.inputs.clone(), initial: run.initial };
            let states = simulate(&model, &model.values_in(&run.session), RK4, &scenario).states;
            for ((s, m), e) in states.iter().zip(&run.measured).zip(&pass.innovations) {
                for c in [0, 1, 3, 4, 5] {
                    assert!((2.0 * e[c] - (m[c].unwrap() - s[c])).abs() < 1e-9, "{} channel {c}", run.name);
                }
            }
        }
        // The variances are the mean squares of the residuals, 4 e^2.
        let squares: f64 = t.passes.iter().flat_map(|p| &p.innovations).map(|e| 4.0 * e[3] * e[3]).sum();
        assert!((t.variance[3] / (squares / t.used[3]) - 1.0).abs() < 1e-12);
    }
}
