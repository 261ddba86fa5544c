//! Whether an answer is the same when the same recordings are transformed: turned, mirrored, cut, thinned, started elsewhere.
//! It makes the variants and compares the answers; the pipeline finds each answer.

use super::finding::Finding;
use super::grade::is_unstable;
use crate::diagnose::search::decide::Verdict;
use crate::model::Model;
use crate::parameter::Parity;
use crate::recording::Run;
use crate::recording::audit::piece;
use crate::ship::Ship;
use crate::ship::actuator::{Actuator, Drive};
use crate::state::Inputs;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// The same analysis on the same recordings, transformed.
#[derive(Clone, Debug, Serialize)]
pub struct Variant {
    /// What was changed.
    pub name: &'static str,
    /// The verdict.
    pub verdict: Verdict,
    /// What was found.
    pub findings: Vec<String>,
    /// Whether this is the same answer.
    pub same: bool,
}

/// How stable an answer is.
#[derive(Clone, Debug, Serialize)]
pub struct Stability {
    /// Variants with the same answer.
    pub same: usize,
    /// Variants.
    pub of: usize,
    /// What the improved model still lacks when it is diagnosed on the same recordings: nothing, if the answer is complete.
    pub further: Vec<String>,
    /// The variants.
    pub variants: Vec<Variant>,
}

/// What a diagnosis answers, as far as answers are compared.
#[derive(Clone, Debug)]
pub struct Brief {
    /// The verdict.
    pub verdict: Verdict,
    /// Each finding with its confidence set.
    pub findings: Vec<(String, Vec<String>)>,
}

impl Brief {
    /// The brief of an answer.
    pub fn new(verdict: Verdict, findings: &[Finding]) -> Self {
        Self { verdict, findings: findings.iter().map(|f| (f.mechanism.clone(), f.confidence_set.clone())).collect() }
    }

    /// Whether finding `i` is found in another answer, by name or as a member of one of its confidence sets.
    pub fn is_found_in(&self, i: usize, other: &Self) -> bool {
        let (name, set) = &self.findings[i];
        other.findings.iter().any(|(n, s)| n == name || set.contains(n) || s.contains(name))
    }

    /// Whether both say the same: each finds what the other finds.
    pub fn is_same(&self, other: &Self) -> bool {
        let covers = |a: &Self, b: &Self| (0..a.findings.len()).all(|i| a.is_found_in(i, b));
        if self.findings.is_empty() && other.findings.is_empty() {
            return self.verdict == other.verdict;
        }
        self.findings.len() == other.findings.len() && covers(self, other) && covers(other, self)
    }

    /// Which of its findings the other answers do not find.
    pub fn doubts(&self, others: &[Self]) -> Doubts {
        let found: Vec<usize> =
            (0..self.findings.len()).map(|f| others.iter().filter(|o| self.is_found_in(f, o)).count()).collect();
        let named = |is: &dyn Fn(usize) -> bool| -> Vec<String> {
            self.names().into_iter().zip(&found).filter(|(_, n)| is(**n)).map(|(name, _)| name).collect()
        };
        Doubts { unstable: named(&|n| is_unstable(n, others.len())), doubtful: named(&|n| n < others.len()) }
    }

    /// The names of what was found.
    pub fn names(&self) -> Vec<String> {
        self.findings.iter().map(|(name, _)| name.clone()).collect()
    }
}

/// Findings that not every repetition finds, by name.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubts {
    /// Those that most repetitions do not find.
    pub unstable: Vec<String>,
    /// Those that at least one does not find.
    pub doubtful: Vec<String>,
}

/// What is changed in recordings and model.
#[derive(Clone, Copy)]
pub struct Change {
    /// In words.
    pub name: &'static str,
    /// The model.
    pub model: fn(&Model) -> Model,
    /// A run of a ship, as one or more.
    pub run: fn(&Run, &Ship) -> Vec<Run>,
}

/// The changes under which an answer must stay the same.
pub const CHANGES: [Change; 6] = [
    Change { name: "turned by 90 deg", model: turned_model, run: |r, _| vec![turned(r)] },
    Change { name: "mirrored", model: mirrored_model, run: |r, ship| vec![mirrored(r, ship)] },
    Change { name: "every recording cut in two", model: Model::clone, run: |r, _| halved(r) },
    Change { name: "without the first fifth of each run", model: Model::clone, run: |r, _| shortened(r) },
    Change { name: "every second sample", model: Model::clone, run: |r, _| vec![thinned(r)] },
    Change { name: "free parameters started at half their values", model: started_low, run: |r, _| vec![r.clone()] },
];

/// All positions, headings and earth-fixed vectors turned by 90 deg to starboard.
fn turned(run: &Run) -> Run {
    let vector = |v: &mut [f64; 2]| *v = [-v[1], v[0]];
    let input = |i: &Inputs<f64>| {
        let mut out = *i;
        [&mut out.wind, &mut out.current, &mut out.waves].into_iter().for_each(vector);
        out
    };
    let [x, y, psi, u, v, r] = run.initial;
    Run {
        inputs: run.inputs.iter().map(input).collect(),
        measured: run
            .measured
            .iter()
            .map(|m| [m[1].map(|y| -y), m[0], m[2].map(|p| p + FRAC_PI_2), m[3], m[4], m[5]])
            .collect(),
        initial: [-y, x, psi + FRAC_PI_2, u, v, r],
        ..run.clone()
    }
}

/// The model with its vectors fixed on the earth turned along.
fn turned_model(model: &Model) -> Model {
    let mut out = model.clone();
    for north in 0..model.parameters.len() {
        let Some(term) = model.parameters[north].name.strip_suffix(".north") else { continue };
        let Some(east) = model.index(&format!("{term}.east")) else { continue };
        out.parameters[north].value = -model.parameters[east].value;
        out.parameters[east].value = model.parameters[north].value;
        for list in out.sessions.values_mut() {
            for (i, value) in list.iter_mut() {
                if *i == north {
                    *i = east;
                } else if *i == east {
                    (*i, *value) = (north, -*value);
                }
            }
        }
    }
    out
}

/// The run in a mirror that stands along north: y, heading, sway, yaw rate, rudder and what comes from the side change sign, and of the named
/// actuators, which change sides with the ship, angles, side forces and moments.
fn mirrored(run: &Run, ship: &Ship) -> Run {
    let signs = [1.0, -1.0, -1.0, 1.0, -1.0, -1.0];
    let sideways = |drive: &Drive| matches!(drive, Drive::Angle | Drive::Y | Drive::N);
    let drives: Vec<Drive> = ship.actuators.iter().flat_map(Actuator::drives).collect();
    let input = |i: &Inputs<f64>| {
        let mut out = *i;
        for v in [&mut out.wind, &mut out.current, &mut out.waves] {
            v[1] = -v[1];
        }
        (out.delta, out.thruster, out.bank) = (-i.delta, -i.thruster, -i.bank);
        for (command, _) in out.commands.iter_mut().zip(&drives).filter(|(_, drive)| sideways(drive)) {
            *command = -*command;
        }
        out
    };
    Run {
        inputs: run.inputs.iter().map(input).collect(),
        measured: run.measured.iter().map(|m| std::array::from_fn(|c| m[c].map(|v| signs[c] * v))).collect(),
        initial: std::array::from_fn(|c| signs[c] * run.initial[c]),
        ..run.clone()
    }
}

/// The model of the mirrored ship: parameters that make port and starboard differ change sign, bounds and priors with them, and named actuators
/// stand on the other side.
fn mirrored_model(model: &Model) -> Model {
    let mut out = model.with_sides_exchanged();
    for p in out.parameters.iter_mut().filter(|p| p.info.parity == Parity::Odd) {
        p.value = -p.value;
        (p.lower, p.upper) = (-p.upper, -p.lower);
        if let Some(prior) = &mut p.prior {
            prior.mean = -prior.mean;
        }
    }
    let odd: Vec<bool> = out.parameters.iter().map(|p| p.info.parity == Parity::Odd).collect();
    for (i, value) in out.sessions.values_mut().flatten() {
        if odd[*i] {
            *value = -*value;
        }
    }
    out
}

/// The run in two halves; whole where it is too short.
fn halved(run: &Run) -> Vec<Run> {
    let (samples, middle) = (run.measured.len(), run.measured.len() / 2);
    match (piece(run, 0, middle), piece(run, middle, samples)) {
        (Some(first), Some(second)) => vec![first, second],
        _ => vec![run.clone()],
    }
}

/// The run without its first fifth; whole where it is too short.
fn shortened(run: &Run) -> Vec<Run> {
    vec![piece(run, run.measured.len() / 5, run.measured.len()).unwrap_or_else(|| run.clone())]
}

/// Every second sample.
fn thinned(run: &Run) -> Run {
    let disturbed = run.disturbed.iter().map(|(a, b)| (a / 2, b / 2)).collect();
    Run {
        dt: 2.0 * run.dt,
        inputs: run.inputs.iter().step_by(2).copied().collect(),
        measured: run.measured.iter().step_by(2).copied().collect(),
        disturbed,
        ..run.clone()
    }
}

/// The model with its free parameters at half their values, inside their bounds.
fn started_low(model: &Model) -> Model {
    let mut out = model.clone();
    for p in out.parameters.iter_mut().filter(|p| p.free) {
        p.value = (0.5 * p.value).clamp(p.lower, p.upper);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, craft, craft_run, model, runs, with};
    use crate::evaluate::predict;

    /// The largest error of a model's prediction of a run, in each channel.
    fn errors(model: &Model, run: &Run) -> [f64; 6] {
        let predicted = predict(model, run, RK4);
        let mut worst = [0.0_f64; 6];
        for (s, m) in predicted.states.iter().zip(&run.measured) {
            (0..6).for_each(|c| worst[c] = worst[c].max(m[c].map_or(0.0, |m| (s[c] - m).abs())));
        }
        worst
    }

    #[test]
    fn a_turned_and_a_mirrored_run_are_sailed_by_the_turned_and_the_mirrored_ship() {
        let truth = with(&[("flow.asymmetry", 0.05), ("current.north", 0.4)]);
        let calm = with(&[("flow.asymmetry", 0.05)]);
        let run = &runs(&calm, 1)[0];
        let close = |a: [f64; 6], b: [f64; 6]| a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + a.abs()));
        let own = errors(&calm, run);
        let (t, m) = (errors(&calm, &turned(run)), errors(&mirrored_model(&calm), &mirrored(run, &calm.ship)));
        assert!(close([t[1], t[0], t[2], t[3], t[4], t[5]], own) && close(m, own), "{own:?} {t:?} {m:?}");
        let drift = with(&[("current.north", 0.3), ("current.east", -0.1)]);
        let carried = &runs(&drift, 1)[0];
        let (own, t) = (errors(&drift, carried), errors(&turned_model(&drift), &turned(carried)));
        assert!(close([t[1], t[0], t[2], t[3], t[4], t[5]], own), "{own:?} {t:?}");
        // The ship itself does not sail its mirror image, nor does a current turn along.
        assert!(!close(errors(&calm, &mirrored(run, &calm.ship)), own));
        let drifting = &runs(&truth, 1)[0];
        assert!(!close(errors(&truth, &turned(drifting)), errors(&truth, drifting)));
    }

    #[test]
    fn a_mirrored_craft_sails_the_mirrored_run_with_its_actuators_on_the_other_side() {
        let mut craft = craft();
        craft.set(&[("left.gain", 0.02), ("right.lost", 0.3), ("left.swap", 0.4), ("right.zero", 0.1)]).unwrap();
        craft.sessions.insert("a".into(), vec![(craft.find("left.zero").unwrap(), 0.05)]);
        let run = craft_run(&craft);
        let worst = |model: &Model, run: &Run| errors(model, run).into_iter().fold(0.0, f64::max);
        let image = mirrored(&run, &craft.ship);
        assert!(worst(&craft, &run) < 1e-12 && worst(&mirrored_model(&craft), &image) < 1e-9);
        assert!(worst(&craft, &image) > 0.1);
    }

    #[test]
    fn cut_and_thinned_runs_keep_their_samples_and_recordings() {
        let run = &runs(&model(), 1)[0];
        let (halves, rest, thin) = (halved(run), shortened(run), thinned(run));
        assert_eq!((halves.len(), halves[0].measured.len(), halves[1].measured.len()), (2, 30, 30));
        assert_eq!((rest[0].measured.len(), thin.measured.len(), thin.dt), (48, 30, 2.0 * run.dt));
        assert_eq!((halves[1].measured[0], thin.measured[1]), (run.measured[30], run.measured[2]));
        assert!(halves.iter().chain(&rest).all(|r| r.recording == run.recording));
        let low = started_low(&model());
        let i = low.find("rudder.lift1").unwrap();
        assert!((low.parameters[i].value / model().parameters[i].value - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_finding_is_unstable_if_most_repetitions_miss_it_and_doubtful_if_one_does() {
        let brief = |names: &[&str]| Brief {
            verdict: Verdict::Named,
            findings: names.iter().map(|n| ((*n).to_owned(), vec![(*n).to_owned()])).collect(),
        };
        let own = brief(&["current", "drag", "lag"]);
        let others =
            [brief(&["current", "drag"]), brief(&["current", "drag"]), brief(&["current"]), brief(&["current"])];
        let doubts = own.doubts(&others);
        assert!(doubts.unstable.contains(&"lag".to_owned()) && !doubts.unstable.contains(&"current".to_owned()));
        assert_eq!(doubts.doubtful, ["drag", "lag"]);
    }

    #[test]
    fn answers_are_the_same_where_each_finds_what_the_other_finds_by_name_or_in_a_set() {
        let brief = |verdict, list: &[(&str, &[&str])]| Brief {
            verdict,
            findings: list
                .iter()
                .map(|(n, s)| ((*n).to_owned(), s.iter().map(|m| (*m).to_owned()).collect()))
                .collect(),
        };
        let current = brief(Verdict::Named, &[("current", &["current"])]);
        let class = brief(Verdict::OneOf, &[("mean_wind", &["mean_wind", "current"])]);
        let both = brief(Verdict::Named, &[("current", &["current"]), ("log_scale", &["log_scale"])]);
        let nothing = brief(Verdict::NothingMissing, &[]);
        assert!(current.is_same(&current) && current.is_same(&class) && class.is_same(&current));
        assert!(!current.is_same(&both) && !current.is_same(&nothing) && nothing.is_same(&nothing));
        assert!(!nothing.is_same(&brief(Verdict::Insufficient, &[])));
        assert!(both.is_found_in(0, &current) && !both.is_found_in(1, &current));
    }
}
