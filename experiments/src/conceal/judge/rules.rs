//! The rules of the judge: which verdicts and names are right for a case, and the scores that follow.
//! Numbers and time windows are compared in `intervals`.

use super::intervals::{covers, overlap, size};
use super::said::{Diagnosis, Finding, Number};
use super::score::Score;
use crate::conceal::family::Family;
use crate::conceal::seal::{Answer, Manifest};

/// The name in a diagnosis for a mechanism outside its catalogue.
const SURROGATE: &str = "generic";

/// The name scored for a diagnosis that refuses to conclude because its audit found a fault in the recordings.
const AUDIT: &str = "audit";

/// Below this p-value a diagnosis reports that port and starboard of the ship differ.
const DIFFER: f64 = 1e-4;

/// Letters of a verdict alone: `ONE OF`, `one_of` and `OneOf` are equal.
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

/// A diagnosis beside the manifest of its case.
struct Reading<'a> {
    manifest: &'a Manifest,
    diagnosis: &'a Diagnosis,
    verdict: String,
    /// Findings with a name.
    named: Vec<&'a Finding>,
    /// Those of them that are not the truth family's own structure.
    own: Vec<&'a Finding>,
}

impl<'a> Reading<'a> {
    fn new(manifest: &'a Manifest, diagnosis: &'a Diagnosis) -> Self {
        let verdict = verdict_key(&diagnosis.verdict);
        let named: Vec<&Finding> = diagnosis.findings.iter().filter(|f| f.mechanism != SURROGATE).collect();
        let structural = |name: &str| manifest.structure.iter().any(|n| n == name) && !accepts(manifest, name);
        let own = named.iter().copied().filter(|f| !structural(&f.mechanism)).collect();
        Self { manifest, diagnosis, verdict, named, own }
    }

    fn first(&self) -> Option<&'a Finding> {
        self.own.first().copied()
    }

    fn first_right(&self) -> bool {
        self.first().is_some_and(|f| accepts(self.manifest, &f.mechanism))
    }

    /// Whether the diagnosis reports missing physics without a name.
    fn claims_unnamed(&self) -> bool {
        self.named.is_empty() && ["named", "oneof", "sensor", "notinthecatalogue"].contains(&self.verdict.as_str())
    }

    /// Whether the verdict is right for the case.
    fn verdict_fits(&self) -> bool {
        let (verdict, silent) = (self.verdict.as_str(), self.own.is_empty());
        match verdict_key(&self.manifest.expected).as_str() {
            "nothingmissing" => silent && (verdict == "nothingmissing" || self.manifest.spec.family != Family::Hd),
            // Under random forces no physics is missing; not to notice them is no mistake.
            "random" => silent && matches!(verdict, "random" | "nothingmissing"),
            "absorbed" => silent && matches!(verdict, "absorbed" | "nothingmissing" | "random"),
            "named" | "sensor" => self.first_right() && matches!(verdict, "named" | "sensor"),
            "oneof" => match verdict {
                "named" | "sensor" => self.first_right(),
                "oneof" | "insufficient" | "absorbed" | "nothingmissing" => true,
                _ => false,
            },
            expected => verdict == expected,
        }
    }

    /// Scores of a null.
    fn null(&self, score: &mut Score) {
        let euler = verdict_key(&self.manifest.expected) == "numerics";
        let numerics = |name: &str| name == "integration_step" || name == "numerics";
        let alarming = self.own.iter().any(|f| !(euler && numerics(&f.mechanism)));
        // The other families do lack physics of the fitted model: "not in the catalogue" is no false name for them.
        let unnamed = self.manifest.spec.family == Family::Hd && self.claims_unnamed();
        score.false_alarm = Some(alarming || unnamed);
    }

    /// Whether one mechanism was named with confidence that is neither right nor near.
    fn wrong_confident(&self) -> bool {
        let near = |name: &str| self.manifest.answers.iter().any(|a| a.near.iter().any(|n| n == name));
        let wrong = |f: &Finding| !accepts(self.manifest, &f.mechanism) && !near(&f.mechanism);
        matches!(self.verdict.as_str(), "named" | "sensor") && self.first().is_some_and(wrong)
    }

    /// Scores of a detected effect.
    fn detected(&self, score: &mut Score) {
        let answers = &self.manifest.answers;
        let Some(answer) = answers.first() else { return };
        score.right_equation = self.first().and_then(|f| equation_right(answer, f));
        if !answers.iter().any(|a| a.class == "withheld") {
            score.first_right = Some(self.first_right());
            let set = self.first().map(confidence_set).unwrap_or_default();
            score.in_set = Some(set.iter().any(|n| accepts(self.manifest, n)));
            score.set_size = self.first().map(|_| set.len() as f64);
        }
        if let Some(right) = self.own.iter().find(|f| answer.accepted.contains(&f.mechanism))
            && let Some(error) = size(answer, right)
        {
            (score.size_error, score.size_errors, score.covered) = (Some(error.share), error.errors, error.covered());
        }
        if let Some(answer) = answers.iter().find(|a| !a.windows.is_empty()) {
            let found = self.own.iter().flat_map(|f| &f.windows).chain(&self.diagnosis.windows);
            score.window_iou = Some(overlap(&answer.windows, &found.collect::<Vec<_>>()));
        }
    }

    /// Scores of several effects.
    fn several(&self, score: &mut Score) {
        let answers = &self.manifest.answers;
        let right = |a: &Answer| self.own.iter().any(|f| a.accepted.contains(&f.mechanism));
        let none_wrong = self.own.iter().all(|f| accepts(self.manifest, &f.mechanism));
        score.some_right_none_wrong = Some(answers.iter().any(right) && none_wrong);
        score.exact = Some(answers.iter().all(right) && none_wrong && self.own.len() == answers.len());
    }

    /// Held-out scores of the base model and of the model with the mechanisms named.
    fn held_out(&self, score: &mut Score) {
        let of_finding = self.diagnosis.findings.last().or(self.first()).and_then(|f| f.held_out.as_ref());
        let last = self.diagnosis.held_out.as_ref().or(of_finding);
        score.base_held_out = last.and_then(|h| h.before.as_ref()).and_then(Number::get);
        // A model without an improvement is as good as the base.
        score.named_held_out = last.and_then(|h| h.after.as_ref()).and_then(Number::get).or(score.base_held_out);
    }

    /// The report on the ship's two sides beside the true asymmetry of the flow at the rudder.
    fn sides(&self, score: &mut Score) {
        let (Some(truth), Some(sides)) = (self.manifest.asymmetry, &self.diagnosis.sides) else { return };
        (score.asymmetry, score.sides_differ) = (Some(truth), Some(sides.p < DIFFER));
        let Some(found) = sides.parameters.iter().find(|p| p.name == "flow.asymmetry") else { return };
        score.asymmetry_found = Some(found.value);
        score.asymmetry_covered = found.ci95.map(|ci| covers(found.value, ci, truth));
    }

    /// The columns that describe the case and the answer.
    fn description(&self) -> Score {
        let (spec, answers) = (&self.manifest.spec, &self.manifest.answers);
        Score {
            family: spec.family.name().to_owned(),
            effects: answers.iter().map(|a| a.effect.as_str()).collect::<Vec<_>>().join("+"),
            background: spec.background.name().to_owned(),
            design: spec.design.name().to_owned(),
            contrast: spec.contrast,
            seed: spec.seed,
            snr: answers.first().and_then(|a| a.snr),
            size: answers.first().map(|a| a.size),
            unit: answers.first().map(|a| a.unit.clone()).unwrap_or_default(),
            expected: self.manifest.expected.clone(),
            verdict: self.diagnosis.verdict.clone(),
            lead_p: self.diagnosis.ranking.iter().map(|r| r.p).reduce(f64::min),
            named: self.named.iter().map(|f| f.mechanism.as_str()).collect::<Vec<_>>().join("+"),
            structural: self.named.len() - self.own.len(),
            verdict_right: Some(self.verdict_fits()),
            ..Score::default()
        }
    }
}

/// Whether a name of the diagnosis is right for the case.
fn accepts(manifest: &Manifest, name: &str) -> bool {
    manifest.answers.iter().any(|a| a.accepted.iter().any(|n| n == name))
}

/// The confidence set of a finding, its own name included.
fn confidence_set(finding: &Finding) -> Vec<String> {
    let mut names: Vec<String> = finding.confidence_set.iter().map(|n| n.get().to_owned()).collect();
    if !names.contains(&finding.mechanism) {
        names.push(finding.mechanism.clone());
    }
    names
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

/// Scores a diagnosis against the manifest of its case.
pub fn judge(manifest: &Manifest, diagnosis: &Diagnosis) -> Score {
    let mut diagnosis = diagnosis.clone();
    if diagnosis.findings.is_empty() && diagnosis.admission.issues.iter().any(|i| i.blocking) {
        diagnosis.findings.push(Finding { mechanism: AUDIT.to_owned(), ..Finding::default() });
    }
    let reading = Reading::new(manifest, &diagnosis);
    let mut score = reading.description();
    reading.held_out(&mut score);
    reading.sides(&mut score);
    if manifest.answers.is_empty() {
        reading.null(&mut score);
        return score;
    }
    score.wrong_confident = Some(reading.wrong_confident());
    if verdict_key(&manifest.expected) == "absorbed" {
        score.absorbed_named = Some(!reading.own.is_empty());
        return score;
    }
    let detected = !reading.own.is_empty() || reading.claims_unnamed();
    score.detected = Some(detected);
    if detected {
        reading.detected(&mut score);
    }
    if manifest.answers.len() > 1 {
        reading.several(&mut score);
    }
    score
}

/// Whether a baseline that names one mechanism or `nothing` is right.
pub fn baseline_right(manifest: &Manifest, name: &str) -> bool {
    if manifest.answers.is_empty() || verdict_key(&manifest.expected) == "absorbed" {
        return name == "nothing" || manifest.structure.iter().any(|n| n == name);
    }
    accepts(manifest, name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::family::Family;
    use crate::conceal::spec::{Background, Spec, Strength};
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
    fn a_right_diagnosis_is_right_in_every_score() {
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
        let s = judge(&manifest, &diagnosis);
        assert_eq!(
            (s.detected, s.first_right, s.in_set, s.right_equation),
            (Some(true), Some(true), Some(true), Some(true))
        );
        assert_eq!((s.set_size, s.false_alarm, s.wrong_confident), (Some(2.0), None, Some(false)));
        assert!((s.window_iou.unwrap() - 40.0 / 60.0).abs() < 1e-12);
        assert!((s.size_error.unwrap() - 0.1).abs() < 1e-12);
        assert_eq!(s.covered, Some(true));
        // 0.05 m/s along the true direction, of which each component has a standard error of 0.0306 m/s.
        assert!((s.size_errors.unwrap() - 0.05 / 0.030_612).abs() < 1e-3, "{:?}", s.size_errors);
        assert_eq!((s.base_held_out, s.named_held_out, s.verdict_right), (Some(2.0), Some(1.1), Some(true)));
    }

    #[test]
    fn a_name_on_a_null_is_a_false_alarm_and_no_name_is_none() {
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
    fn the_report_on_the_two_sides_is_compared_with_the_flow_at_the_rudder() {
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
    fn a_confidence_set_with_the_truth_counts_even_if_its_first_name_is_wrong() {
        let m = manifest(vec![answer("current", &["current"])], Family::Hd);
        let d = said(json!({"verdict": "ONE OF", "findings":
            [{"mechanism": "mean_wind", "confidence_set": ["mean_wind", "current"]}]}));
        let s = judge(&m, &d);
        assert_eq!((s.first_right, s.in_set, s.set_size), (Some(false), Some(true), Some(2.0)));
        assert_eq!(s.wrong_confident, Some(false));
    }

    #[test]
    fn a_pair_is_exact_only_if_both_effects_and_no_other_are_named() {
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
    fn naming_an_absorbed_effect_is_wrong_even_if_the_name_is_right() {
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
