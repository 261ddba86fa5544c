//! One row of the results: the case, its truth once the seal is open, and what was said. Rows alone are summarised.
//! It scores nothing.

use serde::{Deserialize, Serialize};

use super::said::{Finding, HeldOut, Interval, Said};
use crate::conceal::error::ConcealError;
use crate::injected::effect::{Expected, Injection};
use crate::injected::plan::Planned;
use crate::injected::seal::{Manifest, Witness};
use crate::process::Ended;
use crate::rivals::Refit;

/// A row of the results. Lists within a cell are joined by `+`, the names of a set by `|`; numbers with names are JSON.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Key of the case.
    pub case: String,
    /// The set.
    pub set: String,
    /// The kind.
    pub kind: String,
    /// Seed of the case.
    pub seed: u64,
    /// How the set was given, in words.
    pub configuration: String,
    /// How the recordings were turned: `no`, `together` or `each`.
    pub turned: String,
    /// The case with the same configuration and nothing injected, or for `same` with the other configuration.
    pub partner: String,
    /// Effects injected.
    pub injected: String,
    /// Strength, as a part of the reference size.
    pub strength: Option<f64>,
    /// Size of the first effect.
    pub size: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// Sessions in which the effects act; empty for all.
    pub sessions: String,
    /// What should come of it: `named`, `silent`, `either` or `refused`.
    pub expected: String,
    /// Names that are right, effect by effect.
    pub accepted: String,
    /// Names that are not wrong.
    pub near: String,
    /// Whether all that was injected are faults of sensors or loggers.
    pub sensor: bool,
    /// True parameters: `[["current.north", 0.1], ...]`.
    pub truth: String,
    /// Winds by the anemometer: `[["day 1", north, east], ...]` \[m/s\].
    pub winds: String,
    /// The verdict.
    pub verdict: String,
    /// Mechanisms named.
    pub named: String,
    /// Their confidence sets.
    pub sets: String,
    /// Their kinds.
    pub kinds: String,
    /// Their grades; blank without grades.
    pub grades: String,
    /// Sessions of each finding, joined by `|`; blank for all.
    pub found_sessions: String,
    /// Parameters of all findings: `[["current.north", value, low, high, "m/s"], ...]`.
    pub parameters: String,
    /// Estimates under the base model of mechanisms that were injected: `[["current", [0.01, 0.02]], ...]`.
    pub ranked: String,
    /// Mechanisms withdrawn, with their grades: `tide:refuted`.
    pub withdrawn: String,
    /// Their parameters, as those of the findings.
    pub withdrawn_parameters: String,
    /// Proof of each finding: `[[gain, low, high, improvement, low, high], ...]`, of all together where that alone is given.
    pub proof: String,
    /// Repetitions with the same answer.
    pub stable: Option<usize>,
    /// Repetitions.
    pub stable_of: Option<usize>,
    /// Faults for which the recordings were refused.
    pub faults: String,
    /// Names in the diagnosis of the improved model; `-` where it was not asked.
    pub again: String,
    /// Mean cVDM of unseen runs with the model that was written \[%\].
    pub unseen: Option<f64>,
    /// The same of a refit of the base model to whole trajectories, where rivals were asked.
    pub refit: Option<f64>,
    /// The mechanism that the Bayesian information criterion takes from that refit; a message in brackets where it failed.
    pub bic: String,
    /// The mechanism that sparse regression names.
    pub sindy: String,
    /// The verdict in a sentence.
    pub headline: String,
    /// Time of the diagnosis \[s\].
    pub seconds: Option<f64>,
    /// Exit code.
    pub rc: Option<i32>,
    /// Why there is no diagnosis.
    pub error: String,
}

/// A named parameter: value, interval and unit.
pub type Found = (String, Option<f64>, Option<f64>, Option<f64>, String);

/// Six numbers of a proof: gain in log-likelihood and improvement, each with its interval.
pub type Proof = [Option<f64>; 6];

fn json(value: &impl Serialize) -> String {
    // Tuples of numbers and text always have a JSON form; what is not finite becomes null.
    serde_json::to_string(value).unwrap_or_default()
}

/// The value of a JSON cell; the empty list of a blank one.
pub fn cell<T: for<'a> Deserialize<'a> + Default>(text: &str) -> T {
    serde_json::from_str(text).unwrap_or_default()
}

/// One line, without line ends.
fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn proof(h: &HeldOut) -> Proof {
    let ends = |interval: Interval| interval.unwrap_or([None; 2]);
    let ([a, b], [c, d]) = (ends(h.log_likelihood_ci95), ends(h.improvement_ci95.or(h.ci95)));
    [h.log_likelihood_gain, a, b, h.improvement, c, d]
}

impl Row {
    /// The row of a case before it is diagnosed: what the plan says, without the truth.
    pub fn planned(case: &Planned) -> Self {
        let c = &case.configuration;
        Self {
            case: case.key.clone(),
            set: c.set.name().to_owned(),
            kind: case.kind.name().to_owned(),
            seed: case.seed,
            configuration: c.words(),
            turned: format!("{:?}", c.turned).to_lowercase(),
            partner: case.partner.clone().unwrap_or_default(),
            strength: case.strength,
            again: "-".to_owned(),
            ..Self::default()
        }
    }

    /// Adds what a process left, and what it said.
    pub fn add_answer(&mut self, ended: &Ended) -> Option<Said> {
        (self.seconds, self.rc) = (Some(ended.seconds), ended.code);
        match Said::read(&ended.output) {
            Ok(said) if !ended.stopped => {
                self.add_said(&said);
                Some(said)
            }
            read => {
                let last = ended.messages.lines().rev().find(|l| !l.trim().is_empty()).unwrap_or_default();
                let why = read.err().unwrap_or_default();
                let stopped = format!("stopped after {:.0} s", ended.seconds);
                self.error = line(if ended.stopped {
                    &stopped
                } else if last.is_empty() {
                    &why
                } else {
                    last
                });
                None
            }
        }
    }

    fn add_said(&mut self, said: &Said) {
        let joined = |of: &dyn Fn(&Finding) -> String| said.findings.iter().map(of).collect::<Vec<_>>().join("+");
        self.verdict.clone_from(&said.verdict);
        self.headline = line(&said.headline);
        self.named = joined(&|f| f.mechanism.clone());
        self.sets = joined(&|f| f.set().join("|"));
        self.kinds = joined(&|f| f.kind.clone());
        self.grades = joined(&|f| f.grade.clone());
        self.found_sessions = joined(&|f| f.sessions.join("|"));
        let found = |p: &super::said::Parameter| -> Found {
            (p.name.clone(), p.value, p.ci95.and_then(|c| c[0]), p.ci95.and_then(|c| c[1]), p.unit.clone())
        };
        self.parameters = json(&said.findings.iter().flat_map(|f| &f.parameters).map(found).collect::<Vec<_>>());
        let withdrawn = said.withdrawn.iter().flat_map(|w| &w.parameters);
        self.withdrawn_parameters = json(&withdrawn.map(found).collect::<Vec<_>>());
        let withdrawn = said.withdrawn.iter().map(|w| format!("{}:{}", w.mechanism, w.grade));
        self.withdrawn = withdrawn.collect::<Vec<_>>().join("+");
        let own: Vec<Proof> = said.findings.iter().filter_map(|f| f.held_out.as_ref()).map(proof).collect();
        let all: Vec<Proof> = said.held_out.iter().map(proof).collect();
        // A program without grades repeats the proof of all findings with the first one.
        let each = own.len() == said.findings.len() && !said.findings.iter().any(|f| f.grade.is_empty());
        self.proof = json(if each { &own } else { &all });
        (self.stable, self.stable_of) = (said.stability.map(|s| s.same), said.stability.map(|s| s.of));
        self.faults = said.faults().join("+");
        self.unseen = said.held_out.as_ref().and_then(|h| if said.improved_is_base { h.before } else { h.after });
        let usable = |r: &&super::said::Ranked| !r.by_session && r.sessions.is_empty();
        let ranked: Vec<(&str, &[Option<f64>])> =
            said.ranking.iter().filter(usable).map(|r| (r.mechanism.as_str(), r.amplitude.as_slice())).collect();
        self.ranked = json(&ranked);
    }

    /// Adds what rivals say of the same study.
    pub fn add_rivals(
        &mut self,
        refit: Result<Option<Refit>, ConcealError>,
        sindy: Option<Result<String, ConcealError>>,
    ) {
        let failed = |e: ConcealError| format!("({})", line(&e.to_string()));
        match refit {
            Ok(refit) => {
                self.refit = refit.as_ref().and_then(|r| r.held_out);
                self.bic = refit.map_or_else(|| "(the base model diverges)".to_owned(), |r| r.bic);
            }
            Err(e) => self.bic = failed(e),
        }
        self.sindy = sindy.map_or_else(String::new, |said| said.unwrap_or_else(failed));
    }

    /// Adds the truth, once the seal is open.
    pub fn add_truth(&mut self, manifest: &Manifest) {
        let of = &manifest.injections;
        let joined = |each: &dyn Fn(&Injection) -> String| of.iter().map(each).collect::<Vec<_>>().join("+");
        self.injected = joined(&|i| i.effect.clone());
        (self.size, self.unit) = (of.first().map(|i| i.size), of.first().map_or(String::new(), |i| i.unit.clone()));
        self.sessions = manifest.sessions.join("+");
        self.expected = expected(of).name().to_owned();
        self.accepted = joined(&|i| i.accepted.join("|"));
        self.near = joined(&|i| i.near.join("|"));
        self.sensor = !of.is_empty() && of.iter().all(|i| i.sensor);
        self.truth = json(&of.iter().flat_map(|i| &i.parameters).collect::<Vec<_>>());
        let wind = |w: &Witness| (w.session.clone(), w.wind[0], w.wind[1]);
        self.winds = json(&manifest.winds.iter().map(wind).collect::<Vec<_>>());
        if of.is_empty() {
            return;
        }
        // Of what is not injected the estimates are not needed.
        let wanted: Vec<&String> = of.iter().flat_map(|i| &i.accepted).collect();
        let all: Vec<(String, Vec<Option<f64>>)> = cell(&self.ranked);
        self.ranked = json(&all.into_iter().filter(|(name, _)| wanted.contains(&name)).collect::<Vec<_>>());
    }
}

/// What should come of several injections: the strongest of their expectations, `refused` first, then `named` and `either`.
fn expected(injections: &[Injection]) -> Expected {
    let asks = |e: Expected| injections.iter().any(|i| i.expected == e);
    [Expected::Refused, Expected::Named, Expected::Either].into_iter().find(|e| asks(*e)).unwrap_or(Expected::Silent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::plan::plan;

    #[test]
    fn an_answer_becomes_a_row_of_single_lines_that_is_read_back() {
        let all = plan(31).unwrap();
        let mut row = Row::planned(all.iter().find(|c| c.key.contains("/single/current/x1/")).unwrap());
        let output = r#"{"verdict": "named", "headline": "two\nlines", "findings": [
            {"mechanism": "current", "kind": "environment", "confidence_set": ["current", "tide"], "grade": "confirmed",
             "parameters": [{"name": "current.north [day 1]", "value": 0.1, "ci95": [0.0, 0.2], "unit": "m/s"}],
             "held_out": {"log_likelihood_gain": 3.0}}], "withdrawn": [{"mechanism": "munk", "grade": "refuted",
             "parameters": [{"name": "munk.yaw", "value": 0.5, "ci95": [0.4, 0.6], "unit": "-"}]}],
            "ranking": [{"mechanism": "current", "amplitude": [0.1, null]}]}"#;
        let ended =
            Ended { code: Some(0), stopped: false, output: output.into(), messages: String::new(), seconds: 1.5 };
        assert!(row.add_answer(&ended).is_some());
        assert_eq!(
            (row.named.as_str(), row.sets.as_str(), row.headline.as_str()),
            ("current", "current|tide", "two lines")
        );
        assert_eq!(row.withdrawn, "munk:refuted");
        assert_eq!(row.withdrawn_parameters, r#"[["munk.yaw",0.5,0.4,0.6,"-"]]"#);
        let found: Vec<Found> = cell(&row.parameters);
        assert_eq!(found[0], ("current.north [day 1]".into(), Some(0.1), Some(0.0), Some(0.2), "m/s".into()));
        let proof: Vec<Proof> = cell(&row.proof);
        assert_eq!(proof, [[Some(3.0), None, None, None, None, None]]);
        let ranked: Vec<(String, Vec<Option<f64>>)> = cell(&row.ranked);
        assert_eq!(ranked, [("current".to_owned(), vec![Some(0.1), None])]);
    }

    #[test]
    fn rivals_leave_a_name_an_error_of_unseen_runs_or_a_message() {
        let mut row = Row::default();
        let refit = Refit { held_out: Some(4.0), bic: "current".into() };
        row.add_rivals(Ok(Some(refit)), Some(Ok("nothing".into())));
        assert_eq!((row.refit, row.bic.as_str(), row.sindy.as_str()), (Some(4.0), "current", "nothing"));
        row.add_rivals(Ok(None), Some(Err(ConcealError::content("case".as_ref(), &"no\nrows"))));
        assert_eq!((row.refit, row.bic.as_str()), (None, "(the base model diverges)"));
        assert!(row.sindy.starts_with('(') && row.sindy.ends_with("no rows)"), "{}", row.sindy);
    }

    #[test]
    fn the_error_of_unseen_runs_is_that_of_the_model_that_was_written() {
        let of = |is_base: bool| {
            let said: Said = serde_json::from_str(&format!(
                r#"{{"verdict": "named", "improved_is_base": {is_base}, "held_out": {{"before": 6.0, "after": 5.0}}}}"#
            ))
            .unwrap();
            let mut row = Row::default();
            row.add_said(&said);
            row.unseen
        };
        assert_eq!((of(true), of(false)), (Some(6.0), Some(5.0)));
    }

    #[test]
    fn without_a_diagnosis_a_row_has_the_last_message() {
        let mut row = Row::default();
        let ended = Ended {
            code: Some(2),
            stopped: false,
            output: String::new(),
            messages: "reading\nrun_01.csv:3: rudder angle 212 deg\n\n".into(),
            seconds: 0.1,
        };
        assert!(row.add_answer(&ended).is_none());
        assert_eq!((row.rc, row.error.as_str()), (Some(2), "run_01.csv:3: rudder angle 212 deg"));
        row.add_answer(&Ended { stopped: true, code: None, seconds: 300.0, ..ended });
        assert_eq!(row.error, "stopped after 300 s");
    }
}
