//! From evidence to a verdict: runs the steps in order, accepts mechanisms one after the other with backward and swap checks,
//! and says what was found, what cannot be told, and what would have been seen. The arithmetic is in the other files.

use super::admit::{Admission, admit, followed};
use super::candidate::{Candidate, Extent, applies, candidates};
use super::compete::{
    Accepted, Arena, Fall, REFIT, SETTLE, Wald, acceptable, acceptable_beside, backward, compete, positions, swap, wald,
};
use super::estimate::{Effort, Estimate, FreeParameter, calm_noise, estimate, log_posterior, passes};
use super::evidence::{KINDS, Scatter};
use super::filter::Column;
use super::forces::forces_of;
use super::locate::{EquationShare, Location, Place, Push, RegionTest, Window, locate, sharpened};
use super::noise::{Noise, NoisePrior, guess};
use super::prove::{HeldOut, prove};
use super::refit::refit;
use super::screen::{Row, Screen, screen};
use super::sides::{Sides, sides};
use crate::audit::{Issue, settled};
use crate::evaluate::{EvaluationSettings, Judging};
use crate::fit::FitSettings;
use crate::model::{Model, ModelError};
use crate::physics::Kind;
use crate::physics::Probe;
use crate::recording::Run;
use crate::simulate::{Integration, Method};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};
use std::collections::{BTreeMap, BTreeSet};

/// Settings of a diagnosis, the `[diagnose]` table of a study.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Chance of naming anything when nothing is missing.
    pub alpha: f64,
    /// At most this many mechanisms.
    pub most: usize,
    /// Mechanisms that must not be considered.
    pub withhold: Vec<String>,
    /// Whether unknown hull, propeller and rudder coefficients are carried along with their priors.
    pub nuisance: bool,
    /// Sub-steps of RK4 in one sample period.
    pub substeps: usize,
    /// Seed of the bootstrap.
    pub seed: u64,
    /// How the proof simulates and weighs the runs kept aside. A study has it in the tables `[fit]` and `[evaluate]`, so that a
    /// diagnosis and an evaluation print the same numbers.
    #[serde(skip, default = "judging")]
    pub judging: Judging,
}

/// As a fit would judge, but by the integration of a diagnosis.
fn judging() -> Judging {
    let integration = Integration { method: Method::Rk4, substeps: 1 };
    Judging { integration, ..Judging::new(&FitSettings::default(), EvaluationSettings::default()) }
}

impl Settings {
    /// How steps are integrated.
    pub fn integration(&self) -> Integration {
        Integration { method: Method::Rk4, substeps: self.substeps.max(1) }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            alpha: 0.01,
            most: 3,
            withhold: Vec::new(),
            nuisance: true,
            substeps: 1,
            seed: 20250226,
            judging: judging(),
        }
    }
}

/// What a diagnosis concludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing is missing that these data could show.
    NothingMissing,
    /// One mechanism (or several together) is named.
    Named,
    /// One of several that these data cannot tell apart.
    OneOf,
    /// Something is missing that the catalogue does not hold.
    NotInCatalogue,
    /// A sensor, not the ship.
    Sensor,
    /// The integration step, not the ship.
    Numerics,
    /// Force is there, but nothing repeats.
    Random,
    /// The recordings cannot answer.
    Insufficient,
}

/// A value with its interval.
#[derive(Clone, Debug, Serialize)]
pub struct Amplitude {
    /// Dotted name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// Standard error.
    pub error: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

impl Amplitude {
    /// A value with its standard error, as normally distributed.
    pub(super) fn new(name: String, value: f64, unit: &str, error: f64) -> Self {
        Self::within(name, value, unit, error, 1.96)
    }

    /// A value with its standard error, whose 95 % interval reaches so many errors to either side.
    pub(super) fn within(name: String, value: f64, unit: &str, error: f64, reach: f64) -> Self {
        Self { name, value, unit: unit.into(), error, ci95: [value - reach * error, value + reach * error] }
    }
}

/// Shares of the unexplained force by equation.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Equations {
    /// Surge.
    #[serde(rename = "X")]
    pub x: EquationShare,
    /// Sway.
    #[serde(rename = "Y")]
    pub y: EquationShare,
    /// Yaw.
    #[serde(rename = "N")]
    pub n: EquationShare,
}

impl From<[EquationShare; 3]> for Equations {
    fn from([x, y, n]: [EquationShare; 3]) -> Self {
        Self { x, y, n }
    }
}

/// One thing that was found.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// Name of the mechanism; `push` for a time-local force, `generic` when the catalogue does not hold it.
    pub mechanism: String,
    /// Plain words.
    pub title: String,
    /// What kind of thing it is.
    pub kind: Kind,
    /// Every mechanism that these data allow in its place, itself first.
    pub confidence_set: Vec<String>,
    /// Why the set is what it is.
    pub why: String,
    /// Sessions in which it acts; empty for all.
    pub sessions: Vec<String>,
    /// Whether each of these sessions has an amplitude of its own, `parameters` naming the session in brackets.
    pub by_session: bool,
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// Corrected p-value.
    pub p: f64,
    /// Share of the force it brings, by equation.
    pub equations: Equations,
    /// Time windows, for a time-local force.
    pub windows: Vec<Window>,
    /// Where in state and inputs the force stood out.
    pub region: Option<String>,
    /// Its signature in words.
    pub signature: String,
    /// Its parameters.
    pub parameters: Vec<Amplitude>,
    /// Before and after on held-out runs, for all findings together.
    pub held_out: Option<HeldOut>,
}

/// One row of the ranking.
#[derive(Clone, Debug, Serialize)]
pub struct Ranked {
    /// Mechanism.
    pub mechanism: String,
    /// Plain words.
    pub title: String,
    /// Twice the gain in log-likelihood that the scores promise.
    pub statistic: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// Corrected p-value.
    pub p: f64,
    /// Amplitudes \[units of the parameters\]; one session after the other where each has its own.
    pub amplitude: Vec<f64>,
    /// Size over the smallest size worth naming.
    pub size: f64,
    /// Whether the sign is possible.
    pub admissible: bool,
    /// Share of information left after base parameters and nuisances.
    pub retained: f64,
    /// p-value with a free mirror-symmetric discrepancy as rival.
    pub second_opinion: f64,
    /// Sessions in which it acts; empty for all.
    pub sessions: Vec<String>,
    /// Whether each of these sessions has an amplitude of its own.
    pub by_session: bool,
}

/// A mechanism that cannot be seen, and why.
#[derive(Clone, Debug, Serialize)]
pub struct Absorbed {
    /// Mechanism.
    pub mechanism: String,
    /// Share of information left.
    pub retained: f64,
    /// What mimics it.
    pub by: String,
}

/// The smallest size of a mechanism that would have been seen.
#[derive(Clone, Debug, Serialize)]
pub struct Detectable {
    /// Mechanism.
    pub mechanism: String,
    /// Size that is seen in 80 % of such data sets.
    pub size: f64,
    /// Unit.
    pub unit: String,
}

/// How far a parameter moved.
#[derive(Clone, Debug, Serialize)]
pub struct Move {
    /// Dotted name.
    pub name: String,
    /// Before the findings.
    pub before: f64,
    /// After.
    pub after: f64,
    /// Standard error after.
    pub error: f64,
    /// Difference in standard errors.
    pub moved: f64,
}

/// How much of what was allowed for in the hull coefficients was used.
#[derive(Clone, Debug, Serialize)]
pub struct Budget {
    /// Dotted name.
    pub name: String,
    /// Prior mean.
    pub prior: f64,
    /// Prior standard deviation.
    pub sd: f64,
    /// Estimate.
    pub value: f64,
    /// Distance from the prior mean in prior standard deviations.
    pub used: f64,
}

/// Tests of a generic discrepancy.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Adequacy {
    /// p-value of mirror-symmetric force terms: the ship's own forces have another form.
    pub symmetric: f64,
    /// p-value of mirror-breaking and earth-fixed force terms.
    pub asymmetric: f64,
}

/// Two mechanisms and how alike they are on these data.
#[derive(Clone, Debug, Serialize)]
pub struct Likeness {
    /// One.
    pub a: String,
    /// The other.
    pub b: String,
    /// Cosine of the principal angle after the base is projected out: 1 when they cannot be told apart.
    pub cosine: f64,
}

/// A trial worth sailing next.
#[derive(Clone, Debug, Serialize)]
pub struct NextTrial {
    /// The trial.
    pub trial: String,
    /// What it would decide.
    pub why: String,
}

/// One equation of a sparse surrogate force law.
#[derive(Clone, Debug, Serialize)]
pub struct SurrogateTerm {
    /// Dotted name of the monomial.
    pub name: String,
    /// Coefficient.
    pub value: f64,
    /// Standard error.
    pub error: f64,
}

/// The unknown force along one run, as the filter estimates it.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Index of the run.
    pub index: usize,
    /// The run.
    pub run: String,
    /// Its session.
    pub session: String,
    /// Time \[s\].
    pub time: Vec<f64>,
    /// Filtered state `[x, y, psi, u, v, r]`.
    pub state: Vec<[f64; 6]>,
    /// Propeller rate \[1/s\] and rudder angle \[rad\].
    pub inputs: Vec<[f64; 2]>,
    /// Unknown force under the base model: X, Y \[N\], N \[N m\].
    pub before: Vec<[f64; 3]>,
    /// Unknown force with the findings.
    pub after: Vec<[f64; 3]>,
    /// Standard deviation of the former.
    pub sd: Vec<[f64; 3]>,
}

/// Everything a diagnosis says.
#[derive(Clone, Debug, Serialize)]
pub struct Diagnosis {
    /// Layout of this document.
    pub schema: &'static str,
    /// The verdict.
    pub verdict: Verdict,
    /// One sentence.
    pub headline: String,
    /// What was found, strongest first.
    pub findings: Vec<Finding>,
    /// Audit of recordings and numerics.
    pub admission: Admission,
    /// Noise under the base model.
    pub noise_before: Noise,
    /// Noise with the findings.
    pub noise_after: Noise,
    /// Unexplained force under the base model.
    pub location: Location,
    /// Unexplained force that is left.
    pub location_after: Option<Location>,
    /// The ranking under the base model.
    pub ranking: Vec<Ranked>,
    /// Mechanisms that cannot be seen.
    pub absorbed: Vec<Absorbed>,
    /// Sizes that would have been seen.
    pub detectable: Vec<Detectable>,
    /// Pairs of mechanisms that look alike on these data.
    pub confusable: Vec<Likeness>,
    /// Generic tests under the base model.
    pub adequacy_before: Adequacy,
    /// Generic tests with the findings.
    pub adequacy_after: Adequacy,
    /// A sparse surrogate for what the catalogue does not hold.
    pub surrogate: Vec<SurrogateTerm>,
    /// How far the model's own parameters moved.
    pub moves: Vec<Move>,
    /// Whether the ship's own two sides differ.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sides: Option<Sides>,
    /// Hull error budget used.
    pub hull_budget: Vec<Budget>,
    /// Which trial to sail next.
    pub next_trial: Option<NextTrial>,
    /// Proof on held-out runs.
    pub held_out: Option<HeldOut>,
    /// Settings used.
    pub settings: Settings,
    /// The unknown force along every run, before and after, for pictures.
    #[serde(skip)]
    pub traces: Vec<Trace>,
    /// The improved model, as a model file.
    #[serde(skip)]
    pub model: Model,
    /// The base model, refitted.
    #[serde(skip)]
    pub base: Model,
}

fn traces(runs: &[Run], before: &Screen, after: Option<&Screen>) -> Vec<Trace> {
    let force = |z: &[f64; super::covariance::Z]| [z[6], z[7], z[8]];
    runs.iter()
        .enumerate()
        .map(|(index, r)| Trace {
            index,
            run: r.name.clone(),
            session: r.session.clone(),
            time: r.inputs.iter().map(|i| i.t).collect(),
            state: before.passes[index].filtered.iter().map(|z| [z[0], z[1], z[2], z[3], z[4], z[5]]).collect(),
            inputs: r.inputs.iter().map(|i| [i.n, i.delta]).collect(),
            before: before.passes[index].filtered.iter().map(force).collect(),
            after: after.unwrap_or(before).passes[index].filtered.iter().map(force).collect(),
            sd: before.passes[index].force_sd.clone(),
        })
        .collect()
}

/// Hull, propeller and rudder coefficients that are never known exactly, carried along with their priors.
const NUISANCE: [&str; 31] = [
    "hull.inertia",
    "hull.Xudot",
    "hull.Yvdot",
    "hull.Yrdot",
    "hull.Nvdot",
    "hull.Nrdot",
    "hull.Xvr",
    "hull.Yv",
    "hull.Yr",
    "hull.Nv",
    "hull.Nr",
    "hull.Yvv",
    "hull.Yvr",
    "hull.Yrr",
    "hull.Nrr",
    "hull.Nrrv",
    "hull.Nvvr",
    "flow.wake",
    "flow.kt0",
    "flow.kt1",
    "flow.astern",
    "flow.wake_ratio",
    "flow.race",
    "flow.race_astern",
    "flow.straightening",
    "flow.asymmetry",
    "flow.lever",
    "crossflow.drag",
    "hull_nonlinear.X_vv",
    "hull_nonlinear.X_rr",
    "sternway.share",
];

/// The free parameters of the base: those of the model, and the nuisances with their priors.
pub(super) fn base_parameters(model: &Model, nuisance: bool) -> Vec<FreeParameter> {
    let mut free: Vec<FreeParameter> = model
        .free()
        .into_iter()
        .map(|i| FreeParameter::common(Column::tangent(model, i), model.parameters[i].prior))
        .collect();
    if nuisance {
        for name in NUISANCE {
            let Some(i) = model.index(name).filter(|i| !model.parameters[*i].free) else { continue };
            free.push(FreeParameter::uncertain(model, i));
        }
    }
    free
}

/// The statistic by which a push across the keel is an event: the same force in many recordings is soon beyond chance, in one or
/// two it must stand out far, as the ship's own forces in another form make such windows in manoeuvres like crash stops.
fn needed_statistic(recordings: usize, form_holds: bool) -> f64 {
    match recordings {
        0..=2 => ALONE,
        3 => 120.0,
        4 => 50.0,
        _ if form_holds => 25.0,
        _ => 40.0,
    }
}

/// A push across the keel holds at least this share of its evidence there. Along the keel a ship's own thrust and resistance in
/// another form make such windows too: where that form is in doubt there is no push along it, and elsewhere it must stand out far.
const SIDEWAYS: f64 = 0.7;
/// So many times what is needed across the keel.
const ALONG: f64 = 2.5;

/// A push across the keel whose mirror image holds at least this share of its evidence is no push: it comes to both sides, as
/// what the ship's own motion brings does.
const MIRRORED: f64 = 0.2;

/// What a force for a limited time is called.
pub(super) const PUSH: &str = "push";

/// The same in plain words.
pub(super) const PUSH_TITLE: &str = "a push for a limited time (tug, thruster, line)";

/// What stands in a confidence set for physics that the catalogue does not hold.
pub(super) const GENERIC: &str = "generic";

/// In at most so many recordings a push cannot be told from the ship's own forces in a state that no other recording visits.
const FEW_RECORDINGS: usize = 2;

/// A force goes with the place below this p-value.
const PLACED: f64 = 1e-4;

/// Weather that leaves more than this share of what it explains behind, in forces that go with the place, is none.
const PLACED_SHARE: f64 = 0.3;

/// Above this p-value of the mirror-symmetric discrepancy the ship's own forces have the form that the model gives them.
const FORM_HOLDS: f64 = 0.05;

/// The statistic that a push in one or two recordings must reach to be called an event, or one in a few beside a mechanism.
const ALONE: f64 = 250.0;

/// In so many recordings or more what is left beside a mechanism is an event from this statistic on.
const MANY_RECORDINGS: usize = 5;
const BESIDE: f64 = 60.0;

/// Forces that break symmetry or stand on the earth are missing from the catalogue below this p-value: the ship's own
/// port-starboard difference in another form reaches 1e-6 or so.
const UNLISTED: f64 = 1e-8;

/// Where a mechanism leaves less than this share of what windows of time explained, they were its traces.
const MIMICKED: f64 = 0.5;

/// A fit does not win back more than this in log-posterior.
const EULER_HOPELESS: f64 = 1000.0;

/// So often stretches in which the filter loses the ship are looked for.
const LOSSES: usize = 4;

const FIRST: Effort = Effort { rounds: 12, noise_rounds: 4, noise_iterations: 14, noise_runs: 12 };

/// Diagnoses a model against recordings.
///
/// `runs` are used to locate, name and model; `held_out` only to prove. `progress` is told each step in words. The result is
/// the same bits on any number of threads.
///
/// # Errors
/// When the catalogue's terms cannot be added to the model (a singular mass matrix, for instance).
pub fn diagnose(
    model: &Model,
    runs: &[Run],
    held_out: &[Run],
    settings: &Settings,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Diagnosis, ModelError> {
    let full = model.complete()?;
    let (mut sound, mut odd) = settled(runs, full.ship.hull.lpp);
    let mut integration = settings.integration();
    let free = base_parameters(&full, settings.nuisance);
    progress("estimating parameters and noise of the base model");
    let first_noise = guess(&sound, &full);
    let prior = NoisePrior::around(&first_noise);
    let mut null = estimate(&full, integration, &sound, &free, &first_noise, &prior, FIRST);
    // Without what the filter cannot follow the rest is told better, and then more may show.
    for _ in 0..LOSSES {
        let at = passes(&null.model, integration, &[], &sound, &null.noise, false);
        let (kept, lost) = followed(&sound, &at);
        odd.extend(lost);
        let Some(kept) = kept else { break };
        sound = kept;
        null = estimate(&full, integration, &sound, &free, &first_noise, &prior, FIRST);
    }
    let runs = sound.as_slice();
    progress("auditing recordings and integration step");
    let mut admission = admit(&null.model, integration, &null.noise, runs);
    admission.issues.extend(odd);
    // Both readings with parameters of their own: a fit bends them to hide the error of a step.
    let coarse = Integration { method: Method::Euler, substeps: 1 };
    let unfitted = log_posterior(&null.model, coarse, runs, &free, &null.noise) - null.log_posterior;
    let mut euler = None;
    admission.euler_gain = unfitted;
    if unfitted > -EULER_HOPELESS {
        let fitted = estimate(&null.model, coarse, runs, &free, &null.noise, &prior, REFIT);
        admission.euler_gain = fitted.log_posterior - null.log_posterior;
        euler = Some(fitted).filter(|_| admission.euler_gain > 15.0);
    }
    let numerics = euler.is_some();
    if let Some(euler) = euler {
        integration = coarse;
        null = estimate(&euler.model, integration, runs, &free, &euler.noise, &prior, SETTLE);
        admission.integration = integration;
    }
    let list: Vec<Candidate> =
        candidates(&full, &settings.withhold).into_iter().filter(|c| applies(c.mechanism, runs)).collect();
    progress("locating unknown forces");
    let mut runs = runs.to_vec();
    let mut location = locate(&null, integration, &runs);
    progress("testing every mechanism");
    let mut first = screen(&null, integration, &runs, &list);
    let blocked = admission.issues.iter().any(Issue::blocking);

    let form_holds = first.symmetric_test.p > FORM_HOLDS;
    let null_noise = null.noise;
    let is_event = |push: &Push| {
        if push.sideways > SIDEWAYS {
            push.statistic > needed_statistic(push.recordings(), form_holds) && push.mirrored < MIRRORED
        } else {
            push.statistic > ALONG * needed_statistic(push.recordings(), form_holds) && form_holds
        }
    };
    // The strongest that is an event, or else the strongest.
    let event_of = |l: &Location| l.pushes.iter().find(|p| is_event(p)).or(l.pushes.first()).cloned();
    // An event inflates the noise it must stand out of; where the ship's own forces fit, calmer runs tell the noise better.
    let push_of = |found: &Estimate, runs: &[Run]| {
        let noise = if form_holds { calm_noise(found, integration, runs, &prior) } else { null_noise };
        event_of(&locate(&Estimate { noise, ..found.clone() }, integration, runs))
    };
    location.push = if form_holds { push_of(&null, &runs) } else { event_of(&location) };

    // A strong event in time inflates the noise and gets a hull's name: explain it first.
    let mut pushes: Option<Push> = None;
    let best_gain = first.rows.iter().find(|r| acceptable(r, &list, settings)).map_or(0.0, |r| r.test.statistic);
    // What a smooth law of state and heading would explain.
    let smooth = |s: &Screen| s.asymmetric_test.statistic - s.asymmetric_test.degrees as f64;
    let may_push = !blocked && !settings.withhold.iter().any(|w| w == "push");
    let mut opening: Option<(Accepted, Estimate)> = None;
    if may_push
        && let Some(push) =
            location.push.as_ref().filter(|p| is_event(p) && p.statistic > (2.0 * best_gain).max(smooth(&first)))
    {
        let arena = Arena { integration, runs: &runs, list: &list, prior: &prior, settings };
        let may = |r: &Row| acceptable(r, &list, settings);
        let rival = if numerics { None } else { contest(&first, &null, arena, &may, progress) };
        let left = rival.as_ref().map(|(_, found)| push_of(found, &runs));
        let mimicked = left.is_some_and(|left| left.map_or(0.0, |p| p.statistic) < MIMICKED * push.statistic);
        if mimicked {
            opening = rival;
        } else {
            for w in &push.windows {
                runs[w.index].disturbed.push(w.samples);
            }
            pushes = Some(push.clone());
            null = estimate(&null.model, integration, &runs, &free, &null.noise, &prior, SETTLE);
            first = screen(&null, integration, &runs, &list);
            let again = locate(&null, integration, &runs);
            location.regions = again.regions;
        }
    }

    let mut current = null.clone();
    let mut accepted: Vec<Accepted> = Vec::new();
    if !blocked {
        for step in 0..settings.most {
            let arena = Arena { integration, runs: &runs, list: &list, prior: &prior, settings };
            let latest;
            let s: &Screen = if step == 0 {
                &first
            } else {
                latest = screen(&current, integration, &runs, &list);
                &latest
            };
            // A push that was found first is a finding already, and so is a coarse step.
            let alone = step == 0 && pushes.is_none() && !numerics;
            let may = |r: &Row| acceptable(r, &list, settings) && (alone || acceptable_beside(r, &accepted, &list));
            let outcome = opening.take().or_else(|| contest(s, &current, arena, &may, progress));
            let Some((entry, found)) = outcome else { break };
            accepted.push(entry);
            current = found;
            backward(&mut accepted, &mut current, arena);
            // With more physics in it the model may follow in so many runs that where it still loses the ship is not its fault.
            let at = passes(&current.model, integration, &[], &runs, &current.noise, false);
            if let (Some(kept), lost) = followed(&runs, &at) {
                admission.issues.extend(lost);
                runs = kept;
                let again = |e: &Estimate| estimate(&e.model, integration, &runs, &e.free, &e.noise, &prior, SETTLE);
                (null, current) = (again(&null), again(&current));
                first = screen(&null, integration, &runs, &list);
            }
        }
        swap(&mut accepted, &mut current, Arena { integration, runs: &runs, list: &list, prior: &prior, settings });
    }
    if !accepted.is_empty() {
        progress("refitting the whole model through Ipopt");
        // Without Ipopt's answer the estimate by Fisher scoring stands.
        if let Ok(refitted) = refit(&current, integration, &runs) {
            current = refitted;
        }
    }
    progress("checking what is left");
    let mut last = (!accepted.is_empty()).then(|| screen(&current, integration, &runs, &list));
    // A name that leaves more unexplained than it explains, in forces that break symmetry or stand on the earth, is the nearest
    // thing in the catalogue and not what is missing.
    let explained: f64 = accepted.iter().map(|a| a.statistic).sum();
    let nearest = last.as_ref().is_some_and(|s| s.asymmetric_test.p < UNLISTED && smooth(s) > explained);
    let mut location_after = (last.is_some() && !nearest).then(|| {
        let mut after = locate(&current, integration, &runs);
        after.push = event_of(&after);
        after
    });
    // Weather is the same wherever the ship sails: what leaves more behind that goes with the place is something else.
    let local = |p: &Place| p.p < PLACED && p.statistic - p.degrees as f64 > PLACED_SHARE * explained;
    let weather = |a: &Accepted| list[a.candidate].mechanism.is_weather();
    let left = location_after.as_ref().filter(|_| accepted.iter().any(weather)).and_then(|l| l.place.clone());
    let placed = left.filter(local);
    if nearest || placed.is_some() {
        accepted.clear();
        current = null.clone();
        (last, location_after) = (None, None);
    }
    let adequacy = |s: &Screen| Adequacy { symmetric: s.symmetric_test.p, asymmetric: s.asymmetric_test.p };
    let adequacy_before = adequacy(&first);
    let adequacy_after = last.as_ref().map_or(adequacy_before, adequacy);
    if pushes.is_none() && may_push {
        let left = location_after.as_ref().unwrap_or(&location);
        // Beside a mechanism, a push must be beyond what the form of that mechanism leaves behind.
        let law = smooth(last.as_ref().unwrap_or(&first));
        let beside = |p: &Push| p.statistic > if p.recordings() >= MANY_RECORDINGS { BESIDE } else { ALONE };
        let stands = |p: &Push| is_event(p) && p.statistic > law && (accepted.is_empty() || beside(p));
        pushes = left.push.clone().filter(stands);
    }
    let few_recordings = |p: &Push| p.recordings() <= FEW_RECORDINGS;
    // Beside a mechanism a force in one or two recordings is no finding.
    pushes = pushes
        .filter(|p| accepted.is_empty() || !few_recordings(p))
        .map(|p| sharpened(&p, &current, integration, &runs));
    let named_something = !accepted.is_empty() || pushes.is_some();
    let unlisted = if blocked || named_something {
        None
    } else if let Some(place) = &placed {
        Some(Unlisted::Place(place))
    } else {
        (adequacy_after.asymmetric < UNLISTED).then(|| Unlisted::Law(surrogate(&first, &null.model)))
    };

    progress("proving on held-out runs");
    let generic = generic_model(&first, &null);
    let proof = (!held_out.is_empty()).then(|| {
        prove(
            (&null.model, &null.noise),
            (&current.model, &null.noise),
            Some(&generic),
            integration,
            held_out,
            &settings.judging,
        )
    });

    let mut findings = if blocked { sensor_findings(&admission) } else { Vec::new() };
    if let Some(last) = &last {
        findings.extend(describe(&accepted, &current, &runs, &list, &location, &first, last));
    }
    findings.extend(pushes.as_ref().map(|p| push_finding(p, &location)));
    if let Some(f) = findings.first_mut() {
        f.held_out.clone_from(&proof);
    }
    let few = runs.len() < 4 || admission.samples < 150;
    let verdict = if blocked {
        Verdict::Sensor
    } else if let Some(f) = findings.first() {
        if f.confidence_set.len() > 1 {
            Verdict::OneOf
        } else if f.kind == Kind::Sensor {
            Verdict::Sensor
        } else {
            Verdict::Named
        }
    } else if numerics {
        Verdict::Numerics
    } else if unlisted.is_some() {
        Verdict::NotInCatalogue
    } else if few {
        Verdict::Insufficient
    } else if gusty(&null, &runs) {
        Verdict::Random
    } else {
        Verdict::NothingMissing
    };
    let headline = headline(verdict, &findings, &admission, unlisted.as_ref());
    let trial = unlisted.as_ref().map(Unlisted::next_trial).or_else(|| next_trial(verdict, &findings, &list));
    let surrogate = if let Some(Unlisted::Law(terms)) = unlisted { terms } else { Vec::new() };
    let detectable = detectable(&first, &list, settings, &full);
    Ok(Diagnosis {
        schema: "trimtab-diagnosis/1",
        verdict,
        headline,
        admission,
        noise_before: null.noise,
        noise_after: current.noise,
        location,
        location_after,
        ranking: first.rows.iter().map(|r| ranked(r, &list)).collect(),
        absorbed: absorbed(&first, &list),
        detectable,
        confusable: confusable(&first, &list),
        adequacy_before,
        adequacy_after,
        surrogate,
        moves: moves(&null, &current, integration, &runs, model),
        sides: sides(last.as_ref().unwrap_or(&first), &current, null.free.len(), &kinds(&runs)),
        hull_budget: budget(&current),
        next_trial: trial,
        held_out: proof,
        findings,
        settings: settings.clone(),
        traces: traces(&runs, &first, last.as_ref()),
        model: trimmed(&current.model, model, &current.free),
        base: trimmed(&null.model, model, &null.free),
    })
}

/// What is missing and not in the catalogue, as far as it can be told.
enum Unlisted<'a> {
    /// A law of state and inputs, with a surrogate for it.
    Law(Vec<SurrogateTerm>),
    /// A force in one part of the water.
    Place(&'a Place),
}

impl Unlisted<'_> {
    fn headline(&self) -> String {
        let sig = |v: f64| crate::report::sig(v, 3);
        match self {
            Self::Law(surrogate) => {
                let terms: Vec<&str> = surrogate.iter().map(|t| t.name.as_str()).collect();
                let terms = terms.join(", ");
                format!(
                    "Something is missing that the catalogue does not hold; a surrogate for it (not physics): {terms}."
                )
            }
            Self::Place(place) => {
                let [south, north] = place.north.map(|v| v.round());
                let [west, east] = place.east.map(|v| v.round());
                let [to_north, to_east] = place.force.map(sig);
                format!(
                    "Something is missing that the catalogue does not hold, and it goes with the place: strongest from {south} to \
                     {north} m north and {west} to {east} m east, {to_north} N to north and {to_east} N to east there beyond what \
                     acts everywhere."
                )
            }
        }
    }

    fn next_trial(&self) -> NextTrial {
        let (trial, why) = match self {
            Self::Law(_) => (
                "straight runs at several speeds on opposite headings, and turning circles to both sides",
                "they part what goes with speed, with heading and with the side",
            ),
            Self::Place(_) => (
                "straight runs through that part of the water and past it, on opposite headings",
                "they show how far it reaches and whether it turns with the ship",
            ),
        };
        NextTrial { trial: trial.into(), why: why.into() }
    }
}

/// Likeness below which two mechanisms explain different things.
const UNLIKE: f64 = 0.3;

/// Refits the leaders among the mechanisms that may be named, and returns the best with its confidence set. Where the first is
/// something else in its clothes, what explains other things has its turn; where it fades, promises are not to be trusted.
fn contest(
    s: &Screen,
    current: &Estimate,
    arena: Arena,
    may: &dyn Fn(&Row) -> bool,
    progress: &dyn Fn(&str),
) -> Option<(Accepted, Estimate)> {
    let mut leaders: Vec<&Row> = s.rows.iter().filter(|r| may(r)).collect();
    loop {
        let leader = leaders.first()?.candidate;
        progress(&format!("refitting with {}", arena.list[leader].mechanism.title));
        match compete(s, &leaders, current, arena) {
            Ok(outcome) => return Some(outcome),
            Err(Fall::Faded) => return None,
            Err(Fall::Disguised) => {}
        }
        leaders.retain(|r| r.candidate != leader && s.likeness(leader, r.candidate) < UNLIKE);
    }
}

/// Whether the unknown force is a material part of the forces on the ship.
fn gusty(found: &Estimate, runs: &[Run]) -> bool {
    let m = &found.model.ship.hull;
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
    let u = speed / f64::max(count, 1.0);
    // Against 2 % of the force that turns the ship, m u^2 / L.
    let force = 0.02 * m.mass * u * u / m.lpp;
    found.noise.force[0] > force || found.noise.force[1] > force
}

fn ranked(r: &Row, list: &[Candidate]) -> Ranked {
    let c = &list[r.candidate];
    Ranked {
        mechanism: c.mechanism.name.into(),
        title: c.mechanism.title.into(),
        statistic: r.test.statistic,
        degrees: r.test.degrees,
        p: r.p,
        amplitude: r.test.amplitude.iter().zip(c.columns.iter().cycle()).map(|(a, col)| a * col.scale).collect(),
        size: r.size,
        admissible: r.admissible,
        retained: r.test.retained,
        second_opinion: r.second_opinion,
        sessions: r.extent.sessions().to_vec(),
        by_session: matches!(r.extent, Extent::Each(_)),
    }
}

fn absorbed(s: &Screen, list: &[Candidate]) -> Vec<Absorbed> {
    let mut out: Vec<Absorbed> = s
        .rows
        .iter()
        .filter(|r| !r.visible)
        .map(|r| {
            let c = &list[r.candidate];
            let by = if c.mechanism.needs_reference {
                "the ship's own hull, propeller and rudder coefficients, which are not known well enough; \
                 a session without it would show it"
            } else {
                "the model's own parameters, or there is nothing in these data that it acts on"
            };
            Absorbed { mechanism: c.mechanism.name.into(), retained: r.pooled.retained, by: by.into() }
        })
        .collect();
    out.sort_by(|a, b| a.mechanism.cmp(&b.mechanism));
    out
}

fn detectable(s: &Screen, list: &[Candidate], settings: &Settings, model: &Model) -> Vec<Detectable> {
    let Ok(normal) = Normal::new(0.0, 1.0) else { return Vec::new() };
    let visible: Vec<&Row> = s.rows.iter().filter(|r| r.visible).collect();
    let quantile = normal.inverse_cdf(1.0 - 0.5 * settings.alpha / visible.len().max(1) as f64);
    let needed = quantile + normal.inverse_cdf(0.8);
    let mut out: Vec<Detectable> = visible
        .iter()
        .map(|r| {
            let c = &list[r.candidate];
            let k = c.columns.len();
            // The least visible direction decides; quadratic effects grow with the square root.
            let test = if matches!(r.extent, Extent::Each(_)) { &r.pooled } else { &r.test };
            let mut sd = (0..k).map(|i| test.covariance[(i, i)].max(0.0).sqrt()).fold(0.0, f64::max) * needed;
            if c.mechanism.probe == Probe::Odd {
                sd = sd.sqrt();
            }
            let p = &model.parameters[c.columns[0].parameter];
            Detectable { mechanism: c.mechanism.name.into(), size: sd * c.columns[0].scale, unit: p.info.unit.into() }
        })
        .collect();
    out.sort_by(|a, b| a.mechanism.cmp(&b.mechanism));
    out
}

fn confusable(s: &Screen, list: &[Candidate]) -> Vec<Likeness> {
    let shown: Vec<usize> = s.rows.iter().filter(|r| r.visible).map(|r| r.candidate).collect();
    let mut out = Vec::new();
    for (i, a) in shown.iter().enumerate() {
        for b in &shown[i + 1..] {
            let cosine = s.likeness(*a, *b);
            if cosine > 0.7 {
                out.push(Likeness { a: list[*a].mechanism.name.into(), b: list[*b].mechanism.name.into(), cosine });
            }
        }
    }
    out.sort_by(|a, b| b.cosine.total_cmp(&a.cosine));
    out
}

/// The base model with the best linear generic correction, shrunk by its priors: as much as any force law could do.
fn generic_model(s: &Screen, null: &Estimate) -> Model {
    let mut model = null.model.clone();
    let columns: Vec<usize> = s.symmetric.iter().chain(&s.asymmetric).copied().collect();
    let mut shrunk = s.evidence.clone();
    for c in &columns {
        shrunk.total.information[(*c, *c)] += 1.0;
    }
    let test = shrunk.test(&s.base, &columns);
    for (name, a) in s.basis_names.iter().zip(test.amplitude.iter()) {
        if let Some(i) = model.index(name) {
            model.parameters[i].value += a * model.parameters[i].scale;
        }
    }
    model
}

/// Forward selection of at most four generic monomials.
fn surrogate(s: &Screen, model: &Model) -> Vec<SurrogateTerm> {
    let columns: Vec<usize> = s.asymmetric.iter().chain(&s.symmetric).copied().collect();
    let shift = s.symmetric.first().copied().unwrap_or(0);
    let name_of = |c: usize| s.basis_names[c - shift].clone();
    let mut base = s.base.clone();
    let mut chosen: Vec<usize> = Vec::new();
    for _ in 0..4 {
        let best = columns
            .iter()
            .filter(|c| !chosen.contains(c))
            .map(|c| (s.evidence.test(&base, &[*c]), *c))
            .max_by(|a, b| a.0.statistic.total_cmp(&b.0.statistic));
        let Some((test, c)) = best else { break };
        if test.p * columns.len() as f64 > 0.01 {
            break;
        }
        chosen.push(c);
        base = s.evidence.extend(&s.base, &chosen);
    }
    if chosen.is_empty() {
        return Vec::new();
    }
    let test = s.evidence.test(&s.base, &chosen);
    chosen
        .iter()
        .enumerate()
        .map(|(i, c)| {
            let name = name_of(*c);
            let scale = model.index(&name).map_or(1.0, |j| model.parameters[j].scale);
            SurrogateTerm {
                value: test.amplitude[i] * scale,
                error: test.covariance[(i, i)].max(0.0).sqrt() * scale,
                name,
            }
        })
        .collect()
}

/// What was sailed in each run: the manoeuvre, or the recording where there are few manoeuvres or no names for them.
fn kinds(runs: &[Run]) -> Vec<&str> {
    let manoeuvres: BTreeSet<&str> = runs.iter().map(|r| r.manoeuvre.as_str()).collect();
    let by_manoeuvre = manoeuvres.len() >= KINDS;
    runs.iter().map(|r| if by_manoeuvre { r.manoeuvre.as_str() } else { r.recording.as_str() }).collect()
}

fn describe(
    accepted: &[Accepted],
    found: &Estimate,
    runs: &[Run],
    list: &[Candidate],
    location: &Location,
    before: &Screen,
    after: &Screen,
) -> Vec<Finding> {
    // The ship's own forces may have another form: intervals hold what that does to a parameter, and how far what is sailed alike
    // pulls it apart.
    let n = found.free.len();
    let all = Wald::of(found, after.widened.inverse.view((0, 0), (n, n)).into_owned());
    let Scatter { factors, reach } = after.evidence.scatter(&after.widened, &kinds(runs));
    let mut out = Vec::new();
    for a in accepted {
        let c = &list[a.candidate];
        let places = positions(&found.free, c, &a.extent);
        let Wald { value, covariance } = all.part(&places);
        let parameters = (0..value.len())
            .map(|i| {
                let k = c.columns.len();
                let col = &c.columns[i % k];
                let p = &found.model.parameters[col.parameter];
                let v = value[i] * col.scale;
                let error = covariance[(i, i)].max(0.0).sqrt() * factors[places[i]] * col.scale;
                let name = &c.names[i % k];
                let name = match &a.extent {
                    Extent::Each(sessions) => format!("{name} [{}]", sessions[i / k]),
                    Extent::All | Extent::In(_) => name.clone(),
                };
                Amplitude::within(name, v, p.info.unit, error, reach)
            })
            .collect();
        out.push(Finding {
            mechanism: c.mechanism.name.into(),
            title: c.mechanism.title.into(),
            kind: c.mechanism.kind,
            confidence_set: a.set.iter().map(|i| list[*i].mechanism.name.to_string()).collect(),
            why: a.why.clone(),
            sessions: a.extent.sessions().to_vec(),
            by_session: matches!(a.extent, Extent::Each(_)),
            statistic: a.statistic,
            p: a.p,
            equations: force_shares(c, found, runs, location),
            windows: Vec::new(),
            region: strongest_region(&location.regions),
            signature: signature(c, before),
            parameters,
            held_out: None,
        });
    }
    out
}

/// Mean square force that a mechanism brings, by equation: with it less without it, at the filtered states, in units in which
/// the equations compare.
fn force_shares(c: &Candidate, found: &Estimate, runs: &[Run], location: &Location) -> Equations {
    if c.mechanism.kind == Kind::Sensor {
        return location.equations.into();
    }
    let own: Vec<usize> = c.columns.iter().map(|col| col.parameter).collect();
    let forces = forces_of(&found.model, &own, runs);
    let mut sums = [0.0; 3];
    for f in &forces {
        for e in 0..3 {
            sums[e] += f[e] * f[e];
        }
    }
    let count = forces.len() as f64;
    let l = found.model.ship.hull.lpp;
    let rms: [f64; 3] = std::array::from_fn(|e| (sums[e] / count.max(1.0)).sqrt());
    // A moment counts by the force pair at a quarter of the length.
    let weight = [rms[0].powi(2), rms[1].powi(2), (rms[2] / (0.25 * l)).powi(2)];
    let total = weight.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let share = |e: usize| EquationShare { share: weight[e] / total, rms: rms[e], sigma: location.equations[e].sigma };
    Equations { x: share(0), y: share(1), n: share(2) }
}

fn strongest_region(regions: &[RegionTest]) -> Option<String> {
    regions.first().filter(|r| r.p < 0.01).map(|r| r.region.clone())
}

fn signature(c: &Candidate, s: &Screen) -> String {
    let mut words = match c.mechanism.kind {
        Kind::Environment => "earth-fixed: it turns with the heading in body axes".to_string(),
        Kind::Ship => "body-fixed: it goes with the ship's own motion".to_string(),
        Kind::Actuator => "it goes with the actuator's history".to_string(),
        Kind::Sensor => "no force: positions and velocities do not agree with each other".to_string(),
    };
    if s.asymmetric_test.p < 1e-3 {
        words.push_str("; it breaks port-starboard symmetry or depends on heading");
    }
    words
}

/// A blocking fault of a channel in words.
fn title_of_fault(issue: &Issue) -> String {
    let what = match issue.fault {
        "sign_error" => "the sign",
        "axes_error" => "the axes",
        _ => "the unit",
    };
    format!("{what} of `{}`", issue.channel.map_or("the recordings", crate::recording::Channel::name))
}

/// What the audit of the recordings already shows to be wrong: a unit or a sign.
fn sensor_findings(admission: &Admission) -> Vec<Finding> {
    admission
        .issues
        .iter()
        .filter(|i| i.blocking())
        .map(|i| Finding {
            mechanism: i.fault.into(),
            title: title_of_fault(i),
            kind: Kind::Sensor,
            confidence_set: vec![i.fault.into()],
            why: i.text.clone(),
            sessions: Vec::new(),
            by_session: false,
            statistic: 0.0,
            p: 0.0,
            equations: Equations::default(),
            windows: Vec::new(),
            region: None,
            signature: "no force: channels contradict each other by a factor that units or signs explain".into(),
            parameters: Vec::new(),
            held_out: None,
        })
        .collect()
}

fn push_finding(push: &Push, location: &Location) -> Finding {
    let names = [("push.x", "N"), ("push.y", "N"), ("push.n", "N m")];
    let mut confidence_set = vec![PUSH.to_owned()];
    let mut why = "the same unknown force stands in windows of time, is absent outside them, and no smooth law of the ship's state \
                   gives it"
        .to_owned();
    if push.recordings() <= FEW_RECORDINGS {
        confidence_set.push(GENERIC.into());
        why.push_str("; in so few recordings it may as well be the ship's own forces in a state that no other visits");
    }
    Finding {
        mechanism: PUSH.into(),
        title: PUSH_TITLE.into(),
        kind: Kind::Environment,
        confidence_set,
        why,
        sessions: Vec::new(),
        by_session: false,
        statistic: push.statistic,
        p: push.windows.iter().map(|w| w.p).fold(1.0, f64::min),
        equations: location.equations.into(),
        windows: push.windows.clone(),
        region: None,
        signature: "time-local".into(),
        parameters: (0..3)
            .map(|e| Amplitude::new(names[e].0.into(), push.force[e], names[e].1, push.error[e]))
            .collect(),
        held_out: None,
    }
}

fn moves(null: &Estimate, found: &Estimate, integration: Integration, runs: &[Run], user: &Model) -> Vec<Move> {
    let Wald { covariance, .. } = wald(found, integration, runs);
    null.free
        .iter()
        .enumerate()
        .filter(|(_, f)| user.parameters.get(f.column.parameter).is_some_and(|p| p.free))
        .map(|(i, f)| {
            let (before, after) = (f.value(&null.model), f.value(&found.model));
            let error = covariance[(i, i)].max(0.0).sqrt() * f.column.scale;
            Move {
                name: found.model.parameters[f.column.parameter].name.clone(),
                before,
                after,
                error,
                moved: if error > 0.0 { (after - before) / error } else { 0.0 },
            }
        })
        .collect()
}

fn budget(found: &Estimate) -> Vec<Budget> {
    found
        .free
        .iter()
        .filter_map(|f| {
            let prior = f.prior?;
            let value = f.value(&found.model);
            Some(Budget {
                name: found.model.parameters[f.column.parameter].name.clone(),
                prior: prior.mean,
                sd: prior.sd,
                value,
                used: (value - prior.mean) / prior.sd,
            })
        })
        .collect()
}

/// The model as a file should hold it: the user's terms and those that were found to act, nothing that is neutral.
fn trimmed(found: &Model, user: &Model, free: &[FreeParameter]) -> Model {
    let mut model = user.clone();
    let wanted = |name: &str| {
        let prefix = format!("{name}.");
        found.parameters.iter().enumerate().any(|(i, p)| {
            p.name.starts_with(&prefix)
                && (p.value != (p.info.default)(&found.ship)
                    || found.sessions.values().flatten().any(|(j, v)| *j == i && *v != 0.0))
        })
    };
    for term in found.term_names() {
        if wanted(term) {
            // Every term of the catalogue was added to the same ship before, so this cannot fail.
            let _ = model.add_term(term);
        }
    }
    for p in &mut model.parameters {
        if let Some(i) = found.index(&p.name) {
            p.value = found.parameters[i].value;
            p.free |= free.iter().any(|f| f.column.parameter == i && f.prior.is_none());
        }
    }
    model.sessions = BTreeMap::new();
    for (session, additions) in &found.sessions {
        let list: Vec<(usize, f64)> = additions
            .iter()
            .filter(|(_, v)| *v != 0.0)
            .filter_map(|(i, v)| model.index(&found.parameters[*i].name).map(|j| (j, *v)))
            .collect();
        if !list.is_empty() {
            model.sessions.insert(session.clone(), list);
        }
    }
    model
}

fn next_trial(verdict: Verdict, findings: &[Finding], list: &[Candidate]) -> Option<NextTrial> {
    let by_name = |n: &str| list.iter().find(|c| c.mechanism.name == n).map(|c| c.mechanism);
    match verdict {
        Verdict::OneOf => {
            let set = &findings.first()?.confidence_set;
            if set.iter().any(|m| m == GENERIC) {
                return Some(NextTrial {
                    trial: "the same manoeuvre again, twice, without help from outside".into(),
                    why: "a push does not come again, the ship's own forces do".into(),
                });
            }
            let rival = by_name(set.get(1)?)?;
            Some(NextTrial {
                trial: rival.trial.into(),
                why: format!("it parts {} from {}", by_name(set.first()?)?.title, rival.title),
            })
        }
        Verdict::Named | Verdict::Sensor => {
            let m = by_name(&findings.first()?.mechanism)?;
            Some(NextTrial { trial: m.trial.into(), why: format!("it shows {} best", m.title) })
        }
        Verdict::Insufficient => Some(NextTrial {
            trial: "turning circles both ways, a zigzag and a crash stop, each on two headings, in two sessions".into(),
            why: "with fewer runs no mechanism can be told from another".into(),
        }),
        _ => None,
    }
}

fn headline(verdict: Verdict, findings: &[Finding], admission: &Admission, unlisted: Option<&Unlisted>) -> String {
    let values = |f: &Finding| {
        let one = |p: &Amplitude| format!("{} = {} {}", p.name, crate::report::sig(p.value, 3), p.unit);
        f.parameters.iter().map(one).collect::<Vec<_>>().join(", ")
    };
    let list = |f: &Finding| {
        if f.by_session {
            return format!("{} (another in each of {} sessions)", f.title, f.sessions.len());
        }
        format!("{} ({})", f.title, values(f))
    };
    match verdict {
        Verdict::Named => {
            let all: Vec<String> = findings.iter().map(list).collect();
            format!("Missing physics: {}.", all.join("; and "))
        }
        Verdict::OneOf => findings.first().map_or(String::new(), |f| {
            if f.mechanism == PUSH {
                let one = |w: &Window| format!("{} from {:.0} to {:.0} s", w.run, w.start, w.end);
                let windows: Vec<String> = f.windows.iter().map(one).collect();
                return format!(
                    "Something acts for a time: {} in {}; a push, or the ship's own forces in a state that no other recording visits.",
                    values(f),
                    windows.join(" and ")
                );
            }
            format!("Something is missing, and these data cannot tell which of: {}.", f.confidence_set.join(", "))
        }),
        Verdict::Sensor => findings.first().map_or_else(
            || {
                let first = admission.issues.iter().find(|i| i.blocking());
                format!("Your sensor, not your ship: {}.", first.map_or("", |i| i.text.as_str()))
            },
            |f| format!("Your sensor, not your ship: {}.", list(f)),
        ),
        Verdict::Numerics => {
            "The integration step, not the ship: these recordings are what explicit Euler makes of the \
                              model at one step a sample."
                .into()
        }
        Verdict::NotInCatalogue => unlisted.map_or(String::new(), Unlisted::headline),
        Verdict::Random => "Force is there that the model lacks, but nothing about it repeats: gusts.".into(),
        Verdict::Insufficient => "These recordings cannot answer: too few runs.".into(),
        Verdict::NothingMissing => "Nothing is missing that these data could show.".into(),
    }
}
