//! Whether the rudder angle and the propeller rate of one recording, or of one session, are recorded as in the others: their gain and zero.
//! It tests; it changes no estimate.
//!
//! At the end of a fit each recording has, for an error `a` of an input, the score `s = sum r dr/da` and the information
//! `i = sum (dr/da)^2` of its weighted residuals `r`: those of the simulation, or in a fit by likelihood the standardised innovations, which
//! carry no error on, in the noise of the calmer recordings. `z = s/sqrt(i)` scatters from recording to recording by what the model lacks. Where the
//! input of one recording is wrong its z stands apart, by Grubbs's test (Rosner's for several); where that of one session is, the mean of its recordings differs
//! from that of the others, by Student's t. With `a = -sum s / sum i` the recording would agree with the others (one Gauss-Newton step).

use super::objectives::cost::{Cost, CostOptions, Derivatives};
use super::objectives::innovations::Innovations;
use super::solver::task::Task;
use crate::likelihood::estimate::calm_noise;
use crate::likelihood::filter::Column;
use crate::likelihood::noise::fit::guess;
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::likelihood::parameters::FreeParameter;
use crate::model::Model;
use crate::numerals::sig;
use crate::recording::Runs;
use crate::statistics::{corrected, furthest, means_differ_p, median, most_apart, student_quantile, variance};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Largest chance, all tests together, at which an input is said to be recorded in another way. What a model lacks scatters with longer
/// tails than a normal variable: of 24 sets of simulated recordings with sound inputs two are below 1e-3 and none below 1e-4.
pub const INPUT_CHANCE: f64 = 1e-4;

/// Recordings from which one can stand apart.
pub(in crate::fit) const APART_RECORDINGS: usize = 4;

/// Information of a recording, as a share of the largest, below which it says nothing of an input.
const NOTHING: f64 = 1e-9;

/// What may be wrong with an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum InputErrorKind {
    /// True over recorded value, less one.
    Gain,
    /// True minus recorded value.
    Zero,
}

/// An input that one recording or one session records in another way than the others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InputError {
    /// The input in words, such as `rudder angle`.
    pub input: String,
    /// Gain or zero.
    pub kind: InputErrorKind,
    /// The recording, or the session.
    pub name: String,
    /// Whether that is a session.
    pub is_session: bool,
    /// The error with which it would agree with the others: a share, or rad.
    pub value: f64,
    /// Chance of so large a difference, all tests together.
    pub p: f64,
}

impl InputError {
    /// It as a sentence, with what to do.
    pub fn sentence(&self) -> String {
        let Self { input, kind, name, is_session, value, p } = self;
        let place = if *is_session { "session" } else { "recording" };
        let change = match kind {
            InputErrorKind::Gain => format!("{} times its recorded {input}", sig(1.0 + value, 3)),
            InputErrorKind::Zero => format!("{} deg added to its recorded {input}", sig(value.to_degrees(), 2)),
        };
        format!(
            "{place} `{name}` would agree with the others with {change} (p = {}): is its gain, its zero or its unit another there, did it stand \
             still, or is it that of another run? (compare it with the log; fit without it and compare)",
            sig(*p, 1)
        )
    }
}

/// From which size on an error of an input would be reported in one recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeenInput {
    /// The input in words.
    pub input: String,
    /// Gain or zero.
    pub kind: InputErrorKind,
    /// The size in a recording of middle information: a share, or rad.
    pub smallest: f64,
}

impl SeenInput {
    /// `gain of the rudder angle from 12 %`.
    fn words(&self) -> String {
        let Self { input, kind, smallest } = self;
        match kind {
            InputErrorKind::Gain => format!("gain of the {input} from {} %", sig(100.0 * smallest, 2)),
            InputErrorKind::Zero => format!("zero of the {input} from {} deg", sig(smallest.to_degrees(), 2)),
        }
    }

    /// What would be reported of the inputs of single recordings, and what of all of them is not visible.
    pub fn sentences(seen: &[Self], recordings: usize) -> String {
        let mut text = if recordings < APART_RECORDINGS {
            format!("Inputs of single recordings were not compared: that takes {APART_RECORDINGS} recordings.")
        } else {
            // What is beyond what it is a share of is no size.
            let sizes: Vec<String> = seen.iter().filter(|s| s.smallest < 1.0).map(Self::words).collect();
            match sizes.len() {
                0 => "The recordings show no error of the inputs of a single one.".to_owned(),
                _ => format!("An error of the inputs of one recording would be reported: {}.", sizes.join("; ")),
            }
        };
        text += " Not visible is what the coefficients take up: the same gain in all recordings, and mass, draught, propeller and rudder of the \
                 ship file; compare them with the drawings.";
        text
    }
}

/// What a fit says of the inputs of its recordings.
#[derive(Default)]
pub(in crate::fit) struct Inputs {
    /// The error that is most significant, where one is.
    pub error: Option<InputError>,
    /// What would be reported.
    pub seen: Vec<SeenInput>,
}

/// An error that is asked for.
struct Asked {
    input: String,
    kind: InputErrorKind,
    /// Name of its parameter.
    parameter: String,
}

/// What a recording says of each error.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct OfRecording {
    name: String,
    session: String,
    /// Score and information.
    sums: Vec<[f64; 2]>,
}

/// What the recordings show of their inputs at the estimates `p`; `noise` is that of a fit by likelihood.
pub(in crate::fit) fn inputs(task: &Task, p: &[f64], noise: Option<&Noise>) -> Inputs {
    compared(task, p, noise).unwrap_or_default()
}

fn compared(task: &Task, p: &[f64], noise: Option<&Noise>) -> Option<Inputs> {
    let (model, asked) = with_errors(task.model_at(p));
    if asked.is_empty() {
        return None;
    }
    let ranks = task.cost.ranks();
    let free = model.free();
    let at: Vec<f64> = free.iter().map(|i| model.parameters[*i].value).collect();
    let scores = match (noise, task.runs) {
        (Some(noise), Runs::Held(runs)) => {
            let variables: Vec<FreeParameter> =
                free.iter().map(|i| FreeParameter::common(Column::tangent(&model, *i), None)).collect();
            let integration = task.settings.integration;
            // In the noise of all recordings one that differs hides itself.
            let prior = NoisePrior::around(&guess(runs, &model));
            let calm = calm_noise(&model, noise, integration, runs, &prior);
            Innovations::of(&model, runs, integration, &variables, calm, &at).scores_by_run(&at)
        }
        _ => {
            let options = CostOptions { derivatives: Derivatives::Lanes, ..task.settings.cost_options() };
            Cost::over(ranks, &model, task.runs, options).ok()?.scores_by_run(&at)
        }
    };
    let mut own: BTreeMap<String, OfRecording> = BTreeMap::new();
    let is_lost = ranks.largest(&[f64::from(u8::from(scores.is_none()))])[0] > 0.0;
    for (run, scores) in task.runs.iter().zip(scores.unwrap_or_default()) {
        let entry = own.entry(run.recording.clone()).or_insert_with(|| OfRecording {
            name: run.recording.clone(),
            session: run.session.clone(),
            sums: vec![[0.0; 2]; scores.len()],
        });
        for (sum, score) in entry.sums.iter_mut().zip(scores) {
            (0..2).for_each(|i| sum[i] += score[i]);
        }
    }
    let mut all: Vec<OfRecording> =
        ranks.gather(&own.into_values().collect::<Vec<_>>()).into_iter().flatten().collect();
    all.sort_by(|a, b| a.name.cmp(&b.name));
    let place = |a: &Asked| free.iter().position(|i| model.parameters[*i].name == a.parameter);
    let tests = 2.0 * asked.len() as f64;
    let found = asked.iter().filter_map(|a| most_significant(a, &all, place(a)?, &model));
    let found = found.map(|error| InputError { p: corrected(error.p, tests), ..error });
    let first = found.min_by(|a, b| a.p.total_cmp(&b.p));
    let seen = asked.iter().filter_map(|a| smallest(a, &all, place(a)?, &model, INPUT_CHANCE / tests));
    (!is_lost).then(|| Inputs { error: first.filter(|error| error.p < INPUT_CHANCE), seen: seen.collect() })
}

/// From which size on an error would be reported in a recording of middle information, at a chance: the quantile of [`furthest`] times the
/// scatter of z, over the root of the information.
fn smallest(asked: &Asked, all: &[OfRecording], place: usize, model: &Model, chance: f64) -> Option<SeenInput> {
    let known = known(all, place)?;
    let n = known.len() as f64;
    let z: Vec<f64> = known.iter().map(|r| r.z(place)).collect();
    let compared = most_apart(known.len()) as f64;
    let quantile = student_quantile(1.0 - 0.5 * chance / (n * compared), n - 2.0);
    let scatter = (variance(&z)? * n / (n - 1.0)).sqrt();
    let middle = median(known.iter().map(|r| r.of(place)[1]))?;
    let smallest = quantile * scatter / middle.sqrt() / asked.unit(model);
    smallest.is_finite().then(|| SeenInput { input: asked.input.clone(), kind: asked.kind, smallest: smallest.abs() })
}

impl Asked {
    /// What the parameter is a share of: a gain of the craft's own is one of what it is.
    fn unit(&self, model: &Model) -> f64 {
        model.index(&self.parameter).map(|i| model.parameters[i].value).filter(|v| *v != 0.0).unwrap_or(1.0)
    }
}

impl OfRecording {
    /// Score and information of the error at a place.
    fn of(&self, place: usize) -> [f64; 2] {
        self.sums.get(place).copied().unwrap_or([0.0; 2])
    }

    fn z(&self, place: usize) -> f64 {
        let [score, information] = self.of(place);
        score / information.sqrt()
    }
}

/// The recordings that say something of an error, where they are enough to be compared.
fn known(all: &[OfRecording], place: usize) -> Option<Vec<&OfRecording>> {
    let largest = all.iter().map(|r| r.of(place)[1]).fold(0.0, f64::max);
    let known: Vec<&OfRecording> = all.iter().filter(|r| r.of(place)[1] > NOTHING * largest).collect();
    (known.len() >= APART_RECORDINGS).then_some(known)
}

/// The model with the errors of its inputs free and nothing else.
fn with_errors(mut model: Model) -> (Model, Vec<Asked>) {
    use InputErrorKind::{Gain, Zero};
    model.parameters.iter_mut().for_each(|p| p.free = false);
    let (rudder, propeller) = (model.ship.has_rudder(), model.ship.has_propeller());
    let of_terms = [
        (rudder, "rudder angle", Gain, "rudder_gain", "gain"),
        (rudder, "rudder angle", Zero, "rudder_offset", "offset"),
        (propeller, "propeller rate", Gain, "rate_gain", "gain"),
    ];
    let mut asked = Vec::new();
    for (has, input, kind, term, parameter) in of_terms {
        if has && model.add_term(term).is_ok() {
            asked.push(Asked { input: input.into(), kind, parameter: format!("{term}.{parameter}") });
        }
    }
    for actuator in &model.ship.actuators {
        let (input, parameter) = (format!("push of `{}`", actuator.name), format!("{}.gain", actuator.name));
        if model.index(&parameter).is_some_and(|i| model.parameters[i].value != 0.0) {
            asked.push(Asked { input, kind: Gain, parameter });
        }
    }
    for a in &asked {
        if let Some(i) = model.index(&a.parameter) {
            model.parameters[i].free = true;
        }
    }
    (model, asked)
}

/// The recording or the session that stands furthest apart by one error, with its chance among all of them.
fn most_significant(asked: &Asked, all: &[OfRecording], place: usize, model: &Model) -> Option<InputError> {
    let known = known(all, place)?;
    let z = |r: &OfRecording| r.z(place);
    let step = |of: &mut dyn Iterator<Item = &&OfRecording>| {
        let [score, information] = of.fold([0.0; 2], |[s, i], r| [s + r.of(place)[0], i + r.of(place)[1]]);
        -score / information
    };
    let unit = asked.unit(model);
    let error = |name: &str, is_session: bool, value: f64, p: f64| InputError {
        input: asked.input.clone(),
        kind: asked.kind,
        name: name.to_owned(),
        is_session,
        value: value / unit,
        p,
    };
    let (worst, p) = furthest(&known.iter().map(|r| z(r)).collect::<Vec<_>>())?;
    let one = error(&known[worst].name, false, step(&mut known[worst..=worst].iter()), p);
    let sessions: BTreeSet<&str> = known.iter().map(|r| r.session.as_str()).collect();
    let count = sessions.len() as f64;
    let of_sessions = sessions.into_iter().map(|session| {
        let (own, others): (Vec<&OfRecording>, Vec<&OfRecording>) = known.iter().partition(|r| r.session == session);
        let [a, b] = [&own, &others].map(|some| some.iter().map(|r| z(r)).collect::<Vec<f64>>());
        error(session, true, step(&mut own.iter()), corrected(means_differ_p(&a, &b), count))
    });
    of_sessions.chain([one]).min_by(|a, b| a.p.total_cmp(&b.p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, runs};
    use crate::fit::{FitSettings, Goal, fit};

    #[test]
    fn inputs_that_are_recorded_alike_are_not_doubted() {
        let all = runs(&model(), 16);
        for objective in [Goal::Trajectory, Goal::Likelihood] {
            let mut settings = FitSettings { objective, integration: RK4, ..FitSettings::default() };
            settings.constraints.off = true;
            let fitted = fit(&model(), &all, &settings, &mut |_| true).unwrap();
            assert_eq!(fitted.input_error, None);
            assert_eq!(fitted.seen_inputs.len(), 3);
            assert!(
                fitted.seen_inputs.iter().all(|seen| (1e-4..1.0).contains(&seen.smallest)),
                "{:?}",
                fitted.seen_inputs
            );
            let few = fit(&model(), &all[..3], &settings, &mut |_| true).unwrap();
            assert!(few.seen_inputs.is_empty());
            assert!(
                SeenInput::sentences(&few.seen_inputs, 3).starts_with("Inputs of single recordings were not compared")
            );
        }
    }

    #[test]
    fn an_error_of_the_size_that_would_be_reported_is_at_the_limit() {
        let asked =
            Asked { input: "rudder angle".into(), kind: InputErrorKind::Gain, parameter: "rudder_gain.gain".into() };
        let of = |z: f64| OfRecording { name: format!("{z}"), session: "a".into(), sums: vec![[z * 20.0, 400.0]] };
        let sound: Vec<OfRecording> = (0..12).map(|i| of(f64::from(i % 4) - 1.5)).collect();
        let seen = smallest(&asked, &sound, 0, &model(), 1e-4).unwrap();
        // One more recording, with the error of that size beside the mean of the others.
        let z: Vec<f64> = sound.iter().map(|r| r.z(0)).chain([-seen.smallest * 20.0]).collect();
        let (worst, p) = furthest(&z).unwrap();
        assert!(worst == 12 && (3e-5..3e-4).contains(&p), "{p}");
        let said = SeenInput::sentences(&[seen], 12);
        assert!(said.contains("gain of the rudder angle from ") && said.contains("Not visible"), "{said}");
    }

    #[test]
    fn the_sentence_names_place_input_and_size() {
        let gain = InputError {
            input: "rudder angle".into(),
            kind: InputErrorKind::Gain,
            name: "trial 10".into(),
            is_session: false,
            value: 0.25,
            p: 1e-9,
        };
        let said = gain.sentence();
        assert!(
            said.starts_with("recording `trial 10`") && said.contains("1.25 times its recorded rudder angle"),
            "{said}"
        );
        let zero = InputError { kind: InputErrorKind::Zero, is_session: true, value: -0.0524, ..gain };
        let said = zero.sentence();
        assert!(said.starts_with("session `trial 10`") && said.contains("-3.0 deg added"), "{said}");
    }
}
