//! The judge: opens the seal after the diagnosis has spoken and scores what it said, one row a case.
//! It knows the diagnosis only as a file of documented keys and never calls it.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::ConcealError;
use super::baselines::Baselines;
use super::craft::Family;
use super::seal::{Answer, Manifest};

/// A name, alone or with other keys beside it.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum Name {
    Plain(String),
    Keyed { mechanism: String },
}

impl Name {
    fn get(&self) -> &str {
        match self {
            Self::Plain(name) | Self::Keyed { mechanism: name } => name,
        }
    }
}

/// A number, alone or as the `value`, `share` or `held_out` of an object.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum Number {
    Plain(f64),
    Share { share: f64 },
    HeldOut { held_out: f64 },
    Value { value: f64 },
    Other(serde::de::IgnoredAny),
}

impl Number {
    fn get(&self) -> Option<f64> {
        match self {
            Self::Plain(v) | Self::Share { share: v } | Self::HeldOut { held_out: v } | Self::Value { value: v } => {
                Some(*v)
            }
            Self::Other(_) => None,
        }
    }
}

#[derive(Debug, Clone, Deserialize)]
struct Equations {
    #[serde(rename = "X")]
    x: Number,
    #[serde(rename = "Y")]
    y: Number,
    #[serde(rename = "N")]
    n: Number,
}

#[derive(Debug, Clone, Deserialize)]
struct FoundWindow {
    run: Option<String>,
    start: f64,
    end: f64,
}

impl FoundWindow {
    /// The run, without the time that a diagnosis may write behind it where runs are cut in pieces (`r02 120 s`).
    fn run(&self) -> Option<&str> {
        self.run.as_deref().and_then(|r| r.split_whitespace().next())
    }
}

#[derive(Debug, Clone, Deserialize)]
struct FoundParameter {
    name: String,
    value: f64,
    ci95: Option<[f64; 2]>,
}

#[derive(Debug, Clone, Deserialize)]
struct HeldOut {
    before: Option<Number>,
    after: Option<Number>,
}

#[derive(Debug, Clone, Default, Deserialize)]
struct Finding {
    mechanism: String,
    #[serde(default)]
    confidence_set: Vec<Name>,
    equations: Option<Equations>,
    #[serde(default)]
    windows: Vec<FoundWindow>,
    #[serde(default)]
    parameters: Vec<FoundParameter>,
    held_out: Option<HeldOut>,
}

/// What a diagnosis said, as far as it is judged.
#[derive(Debug, Clone, Deserialize)]
pub struct Diagnosis {
    verdict: String,
    #[serde(default)]
    findings: Vec<Finding>,
    #[serde(default)]
    windows: Vec<FoundWindow>,
    held_out: Option<HeldOut>,
    #[serde(default)]
    admission: Admission,
    sides: Option<Sides>,
}

/// What was said of the ship's own two sides.
#[derive(Debug, Clone, Deserialize)]
struct Sides {
    p: f64,
    #[serde(default)]
    parameters: Vec<FoundParameter>,
}

#[derive(Debug, Clone, Default, Deserialize)]
struct Admission {
    #[serde(default)]
    issues: Vec<Issue>,
}

#[derive(Debug, Clone, Deserialize)]
struct Issue {
    #[serde(default)]
    blocking: bool,
}

impl Diagnosis {
    /// Reads a `diagnosis.json`.
    ///
    /// # Errors
    /// [`ConcealError::File`] or [`ConcealError::Content`].
    pub fn read(path: &Path) -> Result<Self, ConcealError> {
        let text = std::fs::read(path).map_err(|source| ConcealError::File { path: path.to_owned(), source })?;
        serde_json::from_slice(&text).map_err(|e| ConcealError::Content {
            path: path.to_owned(),
            message: format!("not a diagnosis: {e}; it needs at least `verdict` and `findings[]` with `mechanism`"),
        })
    }
}

/// Scores of one case. What does not apply is left out: a null has no right name, a sensor no equation.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Key of the case in the campaign.
    pub case: String,
    /// Part of the campaign.
    pub arm: String,
    /// Truth family.
    pub family: String,
    /// Concealed effects, joined by `+`; empty for a null.
    pub effects: String,
    /// Background.
    pub background: String,
    /// Design.
    pub design: String,
    /// Whether some sessions were a reference.
    pub contrast: bool,
    /// Seed.
    pub seed: u64,
    /// Signal-to-noise ratio asked for.
    pub snr_asked: Option<f64>,
    /// The one reached by the first effect.
    pub snr: Option<f64>,
    /// Size of the first effect.
    pub size: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// Verdict called for.
    pub expected: String,
    /// Verdict given.
    pub verdict: String,
    /// Mechanisms named, joined by `+`.
    pub named: String,
    /// The verdict is one that the case calls for.
    pub verdict_right: Option<bool>,
    /// Nulls: a mechanism was named that is not the family's own structure, or missing physics was claimed.
    pub false_alarm: Option<bool>,
    /// Effects: something was said to be missing.
    pub detected: Option<bool>,
    /// Detected cases: the first name is right.
    pub first_right: Option<bool>,
    /// Detected cases: a right name is in the first confidence set.
    pub in_set: Option<bool>,
    /// Size of that set.
    pub set_size: Option<f64>,
    /// Detected forces: the equation with most of the force.
    pub right_equation: Option<bool>,
    /// Effects of limited duration: overlap of found and true windows over their union.
    pub window_iou: Option<f64>,
    /// |found - true|/true of the size, where one number is comparable.
    pub size_error: Option<f64>,
    /// The true size lies in the 90 % interval.
    pub covered: Option<bool>,
    /// Share of the held-out gap between the diagnosis' base model and the oracle that was closed.
    pub gap_closed: Option<f64>,
    /// One name was given with confidence, and it is neither right nor near.
    pub wrong_confident: Option<bool>,
    /// Absorbed effects: a mechanism was named all the same.
    pub absorbed_named: Option<bool>,
    /// Several effects: at least one right and none wrong.
    pub some_right_none_wrong: Option<bool>,
    /// Several effects: exactly those.
    pub exact: Option<bool>,
    /// Names given that describe the truth family itself.
    pub structural: usize,
    /// Held-out score of the refit of trajectories, the paper's way: median cVDM \[%\].
    pub refit_held_out: Option<f64>,
    /// Of the base model that the diagnosis estimated, hull and propeller coefficients along.
    pub base_held_out: Option<f64>,
    /// Of the model with what was named.
    pub named_held_out: Option<f64>,
    /// Of the oracle.
    pub oracle_held_out: Option<f64>,
    /// iid BIC on trajectories over the same catalogue: what it named, `nothing` for none.
    pub bic_named: String,
    /// Whether that is right: the effect, or nothing on a null.
    pub bic_right: Option<bool>,
    /// Sparse regression on residual accelerations: what it named.
    pub sindy_named: String,
    /// Whether that is right.
    pub sindy_right: Option<bool>,
    /// Ships whose flow straightening has two sides: half its true difference.
    pub asymmetry: Option<f64>,
    /// What was found of it.
    pub asymmetry_found: Option<f64>,
    /// The true one lies in the 90 % interval.
    pub asymmetry_covered: Option<bool>,
    /// Port and starboard of the ship herself were said to differ.
    pub sides_differ: Option<bool>,
    /// Time of the diagnosis \[s\].
    pub seconds: Option<f64>,
    /// Why there is no score.
    pub error: String,
}

/// What a diagnosis writes in the place of a mechanism when its catalogue does not hold it.
const SURROGATE: &str = "generic";

/// Letters of a verdict alone: `ONE OF`, `one_of` and `OneOf` are the same.
fn verdict_key(verdict: &str) -> String {
    let letters: String = verdict.chars().filter(char::is_ascii_alphabetic).collect::<String>().to_lowercase();
    match letters.as_str() {
        "nothing" => "nothingmissing",
        "notincatalogue" | "notinlibrary" => "notinthecatalogue",
        "randomonly" => "random",
        other => other,
    }
    .to_owned()
}

/// What a diagnosis says by refusing to conclude: that its audit found the recordings at fault.
const AUDIT: &str = "audit";

/// Scores a diagnosis against the manifest of its case.
pub fn judge(manifest: &Manifest, diagnosis: &Diagnosis) -> Score {
    let mut diagnosis = diagnosis.clone();
    if diagnosis.findings.is_empty() && diagnosis.admission.issues.iter().any(|i| i.blocking) {
        diagnosis.findings.push(Finding { mechanism: AUDIT.to_owned(), ..Finding::default() });
    }
    let diagnosis = &diagnosis;
    let answers = &manifest.answers;
    let accepts = |name: &str| answers.iter().any(|a| a.accepted.iter().any(|n| n == name));
    let structural = |name: &str| manifest.structure.iter().any(|n| n == name) && !accepts(name);
    // A surrogate for what no catalogue holds is not a name.
    let names = || diagnosis.findings.iter().filter(|f| f.mechanism != SURROGATE);
    let own: Vec<&Finding> = names().filter(|f| !structural(&f.mechanism)).collect();
    let verdict = verdict_key(&diagnosis.verdict);
    let claims = matches!(verdict.as_str(), "named" | "oneof" | "sensor" | "notinthecatalogue");
    let spec = &manifest.spec;
    let null = answers.is_empty();
    let first = own.first().copied();
    let first_right = first.is_some_and(|f| accepts(&f.mechanism));
    let numerics = |name: &str| name == "integration_step" || name == "numerics";

    let mut score = Score {
        family: spec.family.name().to_owned(),
        effects: answers.iter().map(|a| a.effect.as_str()).collect::<Vec<_>>().join("+"),
        background: spec.background.name().to_owned(),
        design: spec.design.name().to_owned(),
        contrast: spec.contrast,
        seed: spec.seed,
        snr: answers.first().and_then(|a| a.snr),
        size: answers.first().map(|a| a.size),
        unit: answers.first().map(|a| a.unit.clone()).unwrap_or_default(),
        expected: manifest.expected.clone(),
        verdict: diagnosis.verdict.clone(),
        named: names().map(|f| f.mechanism.as_str()).collect::<Vec<_>>().join("+"),
        structural: names().count() - own.len(),
        verdict_right: Some(verdict_fits(manifest, &verdict, first_right, own.is_empty())),
        ..Score::default()
    };
    held_out(diagnosis, first, &mut score);
    own_sides(manifest, diagnosis, &mut score);
    if null {
        let euler = verdict_key(&manifest.expected) == "numerics";
        let alarming = own.iter().any(|f| !(euler && numerics(&f.mechanism)));
        // What the other family lacks against the fitted one is real: to say "not in the catalogue" of it is no false name.
        let unnamed = spec.family == Family::Hd && claims && names().count() == 0;
        score.false_alarm = Some(alarming || unnamed);
        return score;
    }
    let confident = matches!(verdict.as_str(), "named" | "sensor");
    let near = |name: &str| answers.iter().any(|a| a.near.iter().any(|n| n == name));
    score.wrong_confident = Some(confident && first.is_some_and(|f| !accepts(&f.mechanism) && !near(&f.mechanism)));
    if verdict_key(&manifest.expected) == "absorbed" {
        score.absorbed_named = Some(!own.is_empty());
        return score;
    }
    let detected = !own.is_empty() || (claims && names().count() == 0);
    score.detected = Some(detected);
    let withheld = answers.iter().any(|a| a.class == "withheld");
    if detected && let Some(answer) = answers.first() {
        score.right_equation = first.and_then(|f| equation_right(answer, f));
        if !withheld {
            score.first_right = Some(first_right);
            let set = |f: &Finding| -> Vec<String> {
                let mut names: Vec<String> = f.confidence_set.iter().map(|n| n.get().to_owned()).collect();
                if !names.contains(&f.mechanism) {
                    names.push(f.mechanism.clone());
                }
                names
            };
            score.in_set = Some(first.is_some_and(|f| set(f).iter().any(|n| accepts(n))));
            score.set_size = first.map(|f| set(f).len() as f64);
        }
        if let Some(right) = own.iter().find(|f| answer.accepted.contains(&f.mechanism))
            && let Some((error, covered)) = size(answer, right)
        {
            (score.size_error, score.covered) = (Some(error), covered);
        }
    }
    if let Some(answer) = answers.iter().find(|a| !a.windows.is_empty())
        && detected
    {
        let found = own.iter().flat_map(|f| &f.windows).chain(&diagnosis.windows);
        score.window_iou = Some(overlap(&answer.windows, &found.collect::<Vec<_>>()));
    }
    if answers.len() > 1 {
        let right = |a: &Answer| own.iter().any(|f| a.accepted.contains(&f.mechanism));
        let none_wrong = own.iter().all(|f| accepts(&f.mechanism));
        score.some_right_none_wrong = Some(answers.iter().any(right) && none_wrong);
        score.exact = Some(answers.iter().all(right) && none_wrong && own.len() == answers.len());
    }
    score
}

/// Whether a baseline that names one mechanism or `nothing` is right.
pub fn baseline_right(manifest: &Manifest, name: &str) -> bool {
    let silent = name == "nothing";
    if manifest.answers.is_empty() || verdict_key(&manifest.expected) == "absorbed" {
        return silent || manifest.structure.iter().any(|n| n == name);
    }
    manifest.answers.iter().any(|a| a.accepted.iter().any(|n| n == name))
}

/// Whether a verdict is one that the case calls for.
fn verdict_fits(manifest: &Manifest, verdict: &str, first_right: bool, silent: bool) -> bool {
    match verdict_key(&manifest.expected).as_str() {
        "nothingmissing" => silent && (verdict == "nothingmissing" || manifest.spec.family != Family::Hd),
        // A ship that is pushed at random has nothing missing, and one that has not been noticed to be is no mistake.
        "random" => silent && matches!(verdict, "random" | "nothingmissing"),
        "absorbed" => silent && matches!(verdict, "absorbed" | "nothingmissing" | "random"),
        "named" | "sensor" => first_right && matches!(verdict, "named" | "sensor"),
        "oneof" => match verdict {
            "named" | "sensor" => first_right,
            "oneof" | "insufficient" | "absorbed" | "nothingmissing" => true,
            _ => false,
        },
        expected => verdict == expected,
    }
}

fn equation_right(answer: &Answer, finding: &Finding) -> Option<bool> {
    let truth = answer.equations?;
    let e = finding.equations.as_ref()?;
    let found = [e.x.get()?, e.y.get()?, e.n.get()?];
    let dominant = (0..3).max_by(|a, b| found[*a].total_cmp(&found[*b]))?;
    let most = truth.iter().copied().fold(0.0, f64::max);
    // Two equations that share the force within a tenth are both dominant.
    Some(truth[dominant] >= most - 0.1)
}

/// Error of the size and whether its 90 % interval holds the truth; `None` when not all parameters were reported.
fn size(answer: &Answer, finding: &Finding) -> Option<(f64, Option<bool>)> {
    if answer.parameters.is_empty() {
        return None;
    }
    let mut pairs = Vec::new();
    for (name, truth, _) in &answer.parameters {
        let last = |p: &&FoundParameter| p.name.rsplit('.').next() == Some(name.as_str());
        pairs.push((*truth, finding.parameters.iter().find(last)?));
    }
    let length = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let truth = length(&mut pairs.iter().map(|p| p.0));
    if truth == 0.0 {
        return None;
    }
    // One component keeps its sign; of a vector the length is compared.
    let single = pairs.len() == 1;
    let found = if single { pairs[0].1.value } else { length(&mut pairs.iter().map(|p| p.1.value)) };
    let error = (found - if single { pairs[0].0 } else { truth }).abs() / truth;
    // Along the true direction, components taken as independent.
    let along: f64 = pairs.iter().map(|(t, p)| (p.value - t) * t / truth).sum();
    let mut variance = 0.0;
    for (t, p) in &pairs {
        let Some(ci95) = p.ci95 else { return Some((error, None)) };
        variance += (standard_error(ci95) * t / truth).powi(2);
    }
    Some((error, Some(along.abs() <= NINETY * variance.sqrt())))
}

/// Standard errors that a 90 % interval reaches to either side.
const NINETY: f64 = 1.644_854;

/// The standard error behind a 95 % interval, as if normal.
fn standard_error([low, high]: [f64; 2]) -> f64 {
    (high - low) / (2.0 * 1.959_964)
}

/// Below this chance a diagnosis says that port and starboard of the ship differ.
const DIFFER: f64 = 1e-4;

/// What was said of the ship's own two sides beside what is true of the flow at her rudder.
fn own_sides(manifest: &Manifest, diagnosis: &Diagnosis, score: &mut Score) {
    let (Some(truth), Some(sides)) = (manifest.asymmetry, &diagnosis.sides) else { return };
    (score.asymmetry, score.sides_differ) = (Some(truth), Some(sides.p < DIFFER));
    let Some(found) = sides.parameters.iter().find(|p| p.name == "flow.asymmetry") else { return };
    score.asymmetry_found = Some(found.value);
    score.asymmetry_covered = found.ci95.map(|ci| (found.value - truth).abs() <= NINETY * standard_error(ci));
}

/// Time common to true and found windows over the time of their union, all runs together.
fn overlap(truth: &[(String, f64, f64)], found: &[&FoundWindow]) -> f64 {
    let mut runs: Vec<&str> = truth.iter().map(|w| w.0.as_str()).collect();
    runs.extend(found.iter().filter_map(|w| w.run()));
    runs.sort_unstable();
    runs.dedup();
    let (mut common, mut all) = (0.0, 0.0);
    for run in runs {
        let real: Vec<[f64; 2]> = truth.iter().filter(|w| w.0 == run).map(|w| [w.1, w.2]).collect();
        let said: Vec<[f64; 2]> = found.iter().filter(|w| w.run() == Some(run)).map(|w| [w.start, w.end]).collect();
        let mut edges: Vec<f64> = real.iter().chain(&said).flatten().copied().collect();
        edges.sort_by(f64::total_cmp);
        for pair in edges.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let within = |windows: &[[f64; 2]]| windows.iter().any(|w| w[0] <= middle && middle <= w[1]);
            let (a, b) = (within(&real), within(&said));
            let length = pair[1] - pair[0];
            common += if a && b { length } else { 0.0 };
            all += if a || b { length } else { 0.0 };
        }
    }
    if all > 0.0 { common / all } else { 0.0 }
}

fn held_out(diagnosis: &Diagnosis, first: Option<&Finding>, score: &mut Score) {
    let of_finding = diagnosis.findings.last().or(first).and_then(|f| f.held_out.as_ref());
    let last = diagnosis.held_out.as_ref().or(of_finding);
    score.base_held_out = last.and_then(|h| h.before.as_ref()).and_then(Number::get);
    // What was not improved is as good as the base.
    score.named_held_out = last.and_then(|h| h.after.as_ref()).and_then(Number::get).or(score.base_held_out);
}

impl Score {
    /// Adds what the baselines say of the same case.
    pub fn compare(&mut self, manifest: &Manifest, baselines: &Baselines) {
        self.refit_held_out = baselines.refit;
        self.oracle_held_out = baselines.oracle;
        if let Some(name) = &baselines.bic {
            self.bic_named.clone_from(name);
            self.bic_right = Some(baseline_right(manifest, name));
        }
        if let (Some(base), Some(named), Some(oracle)) = (self.base_held_out, self.named_held_out, self.oracle_held_out)
            && base - oracle > 0.02 * base.abs()
        {
            self.gap_closed = Some((base - named) / (base - oracle));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::{Background, Spec, Strength};
    use serde_json::json;

    fn answer(effect: &str, accepted: &[&str]) -> Answer {
        Answer {
            effect: effect.into(),
            class: "force".into(),
            accepted: accepted.iter().map(ToString::to_string).collect(),
            near: vec!["earth_force".into()],
            size: 0.5,
            unit: "m/s".into(),
            snr: Some(12.0),
            law: String::new(),
            sessions: vec![],
            parameters: vec![("north".into(), 0.3, "m/s".into()), ("east".into(), 0.4, "m/s".into())],
            force: Some([1.0, 3.0, 10.0]),
            equations: Some([0.1, 0.8, 0.1]),
            windows: vec![("r02".into(), 100.0, 150.0)],
        }
    }

    fn manifest(answers: Vec<Answer>, family: Family) -> Manifest {
        let effects = answers.iter().map(|a| (a.effect.clone(), Strength::Snr(12.0))).collect();
        Manifest {
            spec: Spec { effects, ..Spec::null(family, 1) },
            expected: if answers.is_empty() { "NOTHING MISSING" } else { "NAMED" }.into(),
            structure: family.structure().iter().map(ToString::to_string).collect(),
            answers,
            asymmetry: None,
            files: Default::default(),
        }
    }

    fn said(value: serde_json::Value) -> Diagnosis {
        serde_json::from_value(value).unwrap()
    }

    fn named(mechanism: &str) -> serde_json::Value {
        json!({"verdict": "NAMED", "findings": [{"mechanism": mechanism, "confidence_set": [mechanism]}]})
    }

    #[test]
    fn a_true_positive_scores_on_every_count() {
        let diagnosis = said(json!({
            "verdict": "NAMED",
            "findings": [{
                "mechanism": "current",
                "confidence_set": ["current", {"mechanism": "mean_wind", "p": 0.1}],
                "equations": {"X": 0.2, "Y": {"share": 0.7}, "N": 0.1},
                "windows": [{"run": "r02", "start": 110.0, "end": 160.0, "amplitude": 1.0}],
                "parameters": [
                    {"name": "current.north", "value": 0.33, "unit": "m/s", "ci95": [0.27, 0.39]},
                    {"name": "current.east", "value": 0.44, "unit": "m/s", "ci95": [0.38, 0.50]},
                ],
                "held_out": {"before": 2.0, "after": 1.1, "improvement": 0.45},
            }],
            "absorbed": [], "detectable": [],
        }));
        let manifest = manifest(vec![answer("current", &["current", "tide"])], Family::Hd);
        let mut s = judge(&manifest, &diagnosis);
        assert_eq!(
            (s.detected, s.first_right, s.in_set, s.right_equation),
            (Some(true), Some(true), Some(true), Some(true))
        );
        assert_eq!((s.set_size, s.false_alarm, s.wrong_confident), (Some(2.0), None, Some(false)));
        assert!((s.window_iou.unwrap() - 40.0 / 60.0).abs() < 1e-12);
        assert!((s.size_error.unwrap() - 0.1).abs() < 1e-12);
        assert_eq!(s.covered, Some(true));
        assert_eq!((s.gap_closed, s.bic_right), (None, None));
        s.compare(&manifest, &Baselines { refit: Some(3.0), bic: Some("wind".into()), oracle: Some(1.0) });
        assert!((s.gap_closed.unwrap() - 0.9).abs() < 1e-12);
        assert_eq!((s.refit_held_out, s.base_held_out, s.named_held_out), (Some(3.0), Some(2.0), Some(1.1)));
        assert_eq!((s.bic_named.as_str(), s.bic_right, s.verdict_right), ("wind", Some(false), Some(true)));
    }

    #[test]
    fn a_name_on_a_null_is_a_false_alarm_and_silence_is_not() {
        let null = manifest(vec![], Family::Hd);
        assert_eq!(judge(&null, &said(named("current"))).false_alarm, Some(true));
        let silent = said(json!({"verdict": "NOTHING MISSING", "findings": []}));
        let s = judge(&null, &silent);
        assert_eq!((s.false_alarm, s.verdict_right, s.detected), (Some(false), Some(true), None));
        let unknown = said(json!({"verdict": "NOT IN THE CATALOGUE"}));
        assert_eq!(judge(&null, &unknown).false_alarm, Some(true));
    }

    #[test]
    fn structure_of_the_other_family_is_no_false_alarm_but_an_environment_is() {
        let null = manifest(vec![], Family::Mmg);
        let hull = judge(&null, &said(named("crossflow")));
        assert_eq!((hull.false_alarm, hull.structural), (Some(false), 1));
        assert_eq!(judge(&null, &said(named("mean_wind"))).false_alarm, Some(true));
    }

    #[test]
    fn what_is_said_of_the_two_sides_is_held_against_the_flow_at_the_rudder() {
        let of = |asymmetry, p: f64, value: f64| {
            let sides = json!({"p": p, "parameters": [
                {"name": "rudder.lift0", "value": 1.0, "ci95": [0.0, 2.0]},
                {"name": "flow.asymmetry", "value": value, "ci95": [value - 0.0196, value + 0.0196]},
            ]});
            let said = said(json!({"verdict": "NOTHING MISSING", "findings": [], "sides": sides}));
            judge(&Manifest { asymmetry, ..manifest(vec![], Family::Tanker) }, &said)
        };
        // A standard error of 0.01: the 90 % interval reaches 0.0164 to either side.
        let s = of(Some(-0.12), 1e-5, -0.104);
        assert_eq!((s.sides_differ, s.asymmetry_covered, s.asymmetry_found), (Some(true), Some(true), Some(-0.104)));
        let s = of(Some(-0.12), 1e-3, -0.103);
        assert_eq!((s.sides_differ, s.asymmetry_covered, s.asymmetry), (Some(false), Some(false), Some(-0.12)));
        let s = of(None, 1e-5, -0.104);
        assert_eq!((s.sides_differ, s.asymmetry_found), (None, None), "a ship of polynomials has no such number");
    }

    #[test]
    fn a_wrong_name_is_detected_and_wrong_and_a_near_one_is_not_confidently_wrong() {
        let m = manifest(vec![answer("current", &["current"])], Family::Hd);
        let s = judge(&m, &said(named("shallow")));
        assert_eq!((s.detected, s.first_right, s.wrong_confident), (Some(true), Some(false), Some(true)));
        assert_eq!(judge(&m, &said(named("earth_force"))).wrong_confident, Some(false));
        let missed = judge(&m, &said(json!({"verdict": "nothing_missing", "findings": []})));
        assert_eq!((missed.detected, missed.first_right), (Some(false), None));
    }

    #[test]
    fn a_set_with_the_truth_in_it_counts_though_its_first_name_is_wrong() {
        let m = manifest(vec![answer("current", &["current"])], Family::Hd);
        let d = said(json!({"verdict": "ONE OF", "findings":
            [{"mechanism": "mean_wind", "confidence_set": ["mean_wind", "current"]}]}));
        let s = judge(&m, &d);
        assert_eq!((s.first_right, s.in_set, s.set_size), (Some(false), Some(true), Some(2.0)));
        assert_eq!(s.wrong_confident, Some(false));
    }

    #[test]
    fn pairs_are_exact_only_with_both_and_nothing_else() {
        let m = manifest(
            vec![answer("current", &["current"]), answer("walk_astern", &["propeller_walk_astern"])],
            Family::Hd,
        );
        let of = |names: &[&str]| {
            let findings: Vec<_> = names.iter().map(|n| json!({"mechanism": n})).collect();
            let s = judge(&m, &said(json!({"verdict": "NAMED", "findings": findings})));
            (s.some_right_none_wrong, s.exact)
        };
        assert_eq!(of(&["propeller_walk_astern", "current"]), (Some(true), Some(true)));
        assert_eq!(of(&["propeller_walk_astern"]), (Some(true), Some(false)));
        assert_eq!(of(&["propeller_walk_astern", "shallow"]), (Some(false), Some(false)));
    }

    #[test]
    fn windows_overlap_by_time_and_by_run() {
        let truth = [("r02".to_owned(), 100.0, 150.0)];
        let w = |run: &str, start, end| FoundWindow { run: Some(run.into()), start, end };
        let iou = |found: &[FoundWindow]| overlap(&truth, &found.iter().collect::<Vec<_>>());
        assert_eq!(iou(&[w("r02", 100.0, 150.0)]), 1.0);
        assert_eq!(iou(&[w("r02 0 s", 125.0, 175.0)]), 25.0 / 75.0);
        assert_eq!(iou(&[w("r03", 100.0, 150.0)]), 0.0);
        assert_eq!(iou(&[w("r02", 100.0, 150.0), w("r05", 0.0, 50.0)]), 0.5);
        assert_eq!(iou(&[]), 0.0);
    }

    #[test]
    fn an_absorbed_effect_must_not_be_named_even_rightly() {
        let mut m = manifest(vec![answer("rudder_offset", &["rudder_offset"])], Family::Hd);
        m.expected = "ABSORBED".into();
        assert_eq!(judge(&m, &said(named("rudder_offset"))).absorbed_named, Some(true));
        let s = judge(&m, &said(json!({"verdict": "ABSORBED", "findings": []})));
        assert_eq!((s.absorbed_named, s.verdict_right), (Some(false), Some(true)));
    }

    #[test]
    fn a_refusal_by_the_audit_is_an_answer_to_a_faulty_sensor_and_an_alarm_on_a_null() {
        let refusal = said(json!({"verdict": "sensor", "findings": [],
            "admission": {"issues": [{"text": "r does not turn psi", "blocking": true}]}}));
        let m = manifest(vec![answer("sign_error", &["sign_error", "audit"])], Family::Hd);
        let s = judge(&m, &refusal);
        assert_eq!((s.detected, s.first_right, s.verdict_right), (Some(true), Some(true), Some(true)));
        assert_eq!(judge(&manifest(vec![], Family::Hd), &refusal).false_alarm, Some(true));
        let m = manifest(vec![answer("current", &["current"])], Family::Hd);
        assert_eq!(judge(&m, &refusal).wrong_confident, Some(true));
    }

    #[test]
    fn numerics_is_the_answer_to_euler_data() {
        let mut m = manifest(vec![], Family::Hd);
        (m.spec.background, m.expected) = (Background::Euler, "NUMERICS".into());
        let s = judge(&m, &said(json!({"verdict": "Numerics", "findings": [{"mechanism": "integration_step"}]})));
        assert_eq!((s.false_alarm, s.verdict_right), (Some(false), Some(true)));
        assert_eq!(judge(&m, &said(named("antenna"))).false_alarm, Some(true));
    }
}
