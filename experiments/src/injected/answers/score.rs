//! What a row is worth beside its partner: names right and wrong, sizes as differences, and answers that contradict themselves.
//! It counts nothing over cases.

use std::collections::BTreeSet;

use serde::Serialize;

use super::row::{Found, Proof, Row, cell};
use crate::injected::set::Set;
use crate::rivals::NOTHING;

/// Mechanisms that a calm basin does not have.
pub const WEATHER: [&str; 8] = ["wind", "mean_wind", "current", "tide", "waves", "wave_drift", "earth_force", "push"];

/// Mechanisms of which the measured wind may be the cause, or that cannot be distinguished from it.
const WINDY: [&str; 5] = ["mean_wind", "wind", "wave_drift", "current", "earth_force"];

/// Mean wind above which its direction is compared \[m/s\], and the largest deviation that counts as near \[rad\].
const WINDS: f64 = 1.0;
const NEAR: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// Parameters of mechanisms with more than one, in the order of a ranking.
const ORDERS: [(&str, [&str; 2]); 4] = [
    ("current", ["north", "east"]),
    ("time_skew", ["position", "heading"]),
    ("antenna", ["x", "y"]),
    ("position_lever", ["x", "y"]),
];

/// Scores of one case. A score that does not apply is absent.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Score {
    /// Key of the case.
    pub case: String,
    /// Nothing injected: a name that the recordings do not carry.
    pub alarm: Option<bool>,
    /// A basin: a finding is weather.
    pub weather: Option<bool>,
    /// A name and its refutation in one answer.
    pub contradicted: Option<bool>,
    /// The answer is the partner's, where it should be.
    pub same: Option<bool>,
    /// The improved model, diagnosed again, lacks nothing further.
    pub fixed: Option<bool>,
    /// Every effect is named, alone or in its class; absent where the partner names it too.
    pub right: Option<bool>,
    /// Some effect is named, and no name is wrong.
    pub some_right: Option<bool>,
    /// A name is given in confidence that is neither right nor near, and that the partner does not give.
    pub wrong: Option<bool>,
    /// A fault of a sensor or logger is called ship or weather.
    pub miscalled: Option<bool>,
    /// The sessions of a right finding are those in which the effect acts.
    pub sessions: Option<bool>,
    /// Recordings with a user's mistake are refused, or the mistake is named.
    pub refused: Option<bool>,
    /// Found with it less found without it, along the truth, over the truth.
    pub ratio: Option<f64>,
    /// Error of that difference over the truth.
    pub size_error: Option<f64>,
    /// The 95 % interval, moved by what is found without it, contains the truth.
    pub covered: Option<bool>,
    /// A name that the measured wind may be the cause of.
    pub windy: Option<bool>,
    /// Windy sessions whose direction is given.
    pub directions: usize,
    /// Of these, within 20 degrees of the anemometer.
    pub near: usize,
    /// The criterion's mechanism is right; where nothing is injected, that it names none or what the recordings carry.
    pub bic: Option<bool>,
    /// The same of sparse regression.
    pub sindy: Option<bool>,
    /// Unseen runs are predicted better with the model that was written than by a refit of the base model.
    pub beats_refit: Option<bool>,
    /// Confirmed findings with a known improvement in free simulation.
    pub confirmed: usize,
    /// Of these, better.
    pub better: usize,
}

fn names(text: &str, by: char) -> Vec<&str> {
    text.split(by).filter(|n| !n.is_empty()).collect()
}

/// One finding of a row.
struct Named<'a> {
    mechanism: &'a str,
    kind: &'a str,
    grade: &'a str,
    set: Vec<&'a str>,
    sessions: Vec<&'a str>,
}

/// One entry of a list within a cell.
fn entry(list: &str, index: usize) -> &str {
    list.split('+').nth(index).unwrap_or_default()
}

impl Row {
    fn findings(&self) -> Vec<Named<'_>> {
        let named = |(i, mechanism)| Named {
            mechanism,
            kind: entry(&self.kinds, i),
            grade: entry(&self.grades, i),
            set: names(entry(&self.sets, i), '|'),
            sessions: names(entry(&self.found_sessions, i), '|'),
        };
        names(&self.named, '+').into_iter().enumerate().map(named).collect()
    }

    /// Whether there is an answer.
    pub fn answered(&self) -> bool {
        self.error.is_empty() && !self.verdict.is_empty()
    }

    /// Whether a rival's answer is right: an accepted name, or where nothing is injected none but what the recordings carry. `None` where
    /// it was not asked or failed, and where a name is not expected.
    fn rival(&self, said: &str) -> Option<bool> {
        if said.is_empty() || said.starts_with('(') {
            return None;
        }
        match self.kind.as_str() {
            "null" => Some(said == NOTHING || self.carried().contains(&said)),
            _ => (self.expected == "named").then(|| self.accepted.split(['+', '|']).any(|name| name == said)),
        }
    }

    /// Names that the recordings of the set carry by themselves.
    fn carried(&self) -> &'static [&'static str] {
        Set::named(&self.set).map_or(&[], |s| s.facts().carried)
    }

    /// Estimate and half width of the 95 % interval of a parameter of a finding.
    fn found(&self, name: &str, acting: &[&str]) -> Option<(f64, f64)> {
        Self::estimate(&self.parameters, name, acting)
    }

    /// Estimate and half width of the 95 % interval of a parameter among others; where each session has its own, their mean over the
    /// sessions in which `acting` says that the effect acts.
    fn estimate(parameters: &str, name: &str, acting: &[&str]) -> Option<(f64, f64)> {
        let all: Vec<Found> = cell(parameters);
        let of = |(full, value, low, high, _): &Found| {
            let (own, session) = full.split_once(" [").map_or((full.as_str(), None), |(n, s)| (n, s.strip_suffix(']')));
            let acts = session.is_none_or(|s| acting.is_empty() || acting.contains(&s));
            let half = low.zip(*high).map_or(f64::NAN, |(low, high)| 0.5 * (high - low));
            (own == name && acts).then(|| value.map(|v| (v, half))).flatten()
        };
        let found: Vec<(f64, f64)> = all.iter().filter_map(of).collect();
        let count = found.len() as f64;
        (count > 0.0)
            .then(|| (found.iter().map(|f| f.0).sum::<f64>() / count, found.iter().map(|f| f.1).sum::<f64>() / count))
    }

    /// Estimate of a parameter where nothing was injected: of a finding, or of what was withdrawn, or without any finding of the
    /// ranking; 0 otherwise.
    fn found_without(&self, name: &str) -> f64 {
        let known = [&self.parameters, &self.withdrawn_parameters];
        if let Some((value, _)) = known.into_iter().find_map(|p| Self::estimate(p, name, &[])) {
            return value;
        }
        let Some((mechanism, parameter)) = name.split_once('.').filter(|_| self.named.is_empty()) else { return 0.0 };
        let order = ORDERS.iter().find(|o| o.0 == mechanism);
        let index = order.and_then(|o| o.1.iter().position(|p| *p == parameter)).unwrap_or(0);
        let ranked: Vec<(String, Vec<Option<f64>>)> = cell(&self.ranked);
        let row = ranked.iter().find(|(n, _)| n == mechanism);
        row.and_then(|(_, amplitude)| amplitude.get(index).copied().flatten()).unwrap_or(0.0)
    }
}

/// A row beside its partner.
struct Reading<'a> {
    row: &'a Row,
    partner: Option<&'a Row>,
    findings: Vec<Named<'a>>,
}

impl<'a> Reading<'a> {
    /// Findings that neither the recordings carry nor the partner names.
    fn new_ones(&self) -> impl Iterator<Item = &Named<'a>> {
        let partners = self.partner.map_or(Vec::new(), |p| names(&p.named, '+'));
        let carried = self.row.carried();
        self.findings.iter().filter(move |f| !carried.contains(&f.mechanism) && !partners.contains(&f.mechanism))
    }

    /// Whether a finding is an injected effect, or near one.
    fn fits(&self, finding: &Named, near: bool) -> bool {
        let accepted = self.row.accepted.split(['+', '|']).filter(|n| !n.is_empty());
        let near = self.row.near.split(['+', '|']).filter(|n| near && !n.is_empty());
        accepted.chain(near).any(|n| finding.set.contains(&n) || finding.mechanism == n)
    }

    fn is_wrong(&self, finding: &Named) -> bool {
        let alone = matches!(self.row.verdict.as_str(), "named" | "sensor");
        let confident = finding.grade == "confirmed" || (finding.grade.is_empty() && alone);
        confident && !self.fits(finding, true)
    }

    /// Whether each effect is named, alone or in its class; absent for one that has no name or that the partner names too.
    fn effects(&self) -> Vec<Option<bool>> {
        let partners = self.partner.map_or(Vec::new(), Row::findings);
        let one = |accepted: &str| {
            let accepted = names(accepted, '|');
            let named = |f: &Named| accepted.iter().any(|n| f.set.contains(n) || f.mechanism == *n);
            (!accepted.is_empty() && !partners.iter().any(named)).then(|| self.findings.iter().any(named))
        };
        self.row.accepted.split('+').map(one).collect()
    }

    fn injected(&self, score: &mut Score) {
        let (row, effects) = (self.row, self.effects());
        score.wrong = Some(self.new_ones().any(|f| self.is_wrong(f)));
        if row.sensor {
            score.miscalled = Some(self.new_ones().any(|f| f.kind != "sensor" && !self.fits(f, true)));
        }
        if row.expected == "named" {
            let known: Vec<bool> = effects.into_iter().flatten().collect();
            score.right = (!known.is_empty()).then(|| known.iter().all(|k| *k));
            let right = known.iter().any(|k| *k);
            score.some_right = (!known.is_empty()).then(|| right && score.wrong == Some(false));
        }
        if !row.sessions.is_empty()
            && let Some(finding) = self.findings.iter().find(|f| self.fits(f, false))
        {
            let found: BTreeSet<&str> = finding.sessions.iter().copied().collect();
            score.sessions = Some(found == names(&row.sessions, '+').into_iter().collect());
        }
        self.size(score);
    }

    /// Size of what was injected, as a difference.
    fn size(&self, score: &mut Score) {
        let (row, Some(partner)) = (self.row, self.partner.filter(|p| p.answered())) else { return };
        let truth: Vec<(String, f64)> = cell(&row.truth);
        let acting = names(&row.sessions, '+');
        // Of a pair the first effect's alone.
        let first = truth.first().and_then(|t| t.0.split_once('.')).map(|t| t.0.to_owned());
        let (mut pairs, mut interval) = (Vec::new(), true);
        for (name, value) in truth.iter().filter(|t| first.as_deref() == t.0.split('.').next()) {
            let Some((found, half)) = row.found(name, &acting) else { return };
            interval &= half.is_finite();
            pairs.push((*value, found - partner.found_without(name), half));
        }
        let length = pairs.iter().map(|p| p.0 * p.0).sum::<f64>().sqrt();
        if length == 0.0 {
            return;
        }
        let along: f64 = pairs.iter().map(|(t, d, _)| d * t / length).sum();
        let error = pairs.iter().map(|(t, d, _)| (d - t) * (d - t)).sum::<f64>().sqrt();
        (score.ratio, score.size_error) = (Some(along / length), Some(error / length));
        let half = pairs.iter().map(|(t, _, h)| (h * t / length).powi(2)).sum::<f64>().sqrt();
        score.covered = interval.then_some((along - length).abs() <= half);
    }

    /// Proofs beside names.
    fn proofs(&self, score: &mut Score) {
        let proofs: Vec<Proof> = cell(&self.row.proof);
        let refuted = |name: &str| names(&self.row.withdrawn, '+').contains(&format!("{name}:refuted").as_str());
        let below = |p: &Proof| [p[2], p[5]].into_iter().flatten().any(|high| high < 0.0);
        let named = !self.findings.is_empty();
        score.contradicted =
            Some(self.findings.iter().any(|f| refuted(f.mechanism)) || named && proofs.iter().any(below));
        if proofs.len() == self.findings.len() {
            let confirmed = self.findings.iter().zip(&proofs).filter(|(f, _)| f.grade == "confirmed");
            for improvement in confirmed.filter_map(|(_, p)| p[3]) {
                score.confirmed += 1;
                score.better += usize::from(improvement > 0.0);
            }
        }
    }

    /// Directions of a withheld wind beside the anemometer's.
    fn directions(&self, score: &mut Score) {
        let winds: Vec<(String, f64, f64)> = cell(&self.row.winds);
        score.windy = Some(self.findings.iter().any(|f| WINDY.contains(&f.mechanism)));
        let Some(finding) = self.findings.iter().find(|f| WINDY.contains(&f.mechanism)) else { return };
        let all = winds.iter().fold([0.0; 2], |s, w| [s[0] + w.1, s[1] + w.2]).map(|s| s / winds.len().max(1) as f64);
        let parameters: Vec<Found> = cell(&self.row.parameters);
        let own = parameters.iter().any(|p| p.0.starts_with(finding.mechanism) && p.0.contains(" ["));
        let pooled = [("all".to_owned(), all[0], all[1])];
        for (session, north, east) in if own { &winds[..] } else { &pooled[..] } {
            let acting = [session.as_str()];
            let part = |axis: &str| self.row.found(&format!("{}.{axis}", finding.mechanism), &acting);
            let (Some((n, _)), Some((e, _))) = (part("north"), part("east")) else { continue };
            if north.hypot(*east) > WINDS {
                let off = (e.atan2(n) - east.atan2(*north)).sin_cos();
                score.directions += 1;
                score.near += usize::from(off.0.atan2(off.1).abs() <= NEAR);
            }
        }
    }
}

/// Scores a row beside its partner.
pub fn score(row: &Row, partner: Option<&Row>) -> Score {
    let mut score = Score { case: row.case.clone(), ..Score::default() };
    let partner = partner.filter(|p| p.answered());
    let reading = Reading { row, partner, findings: row.findings() };
    if row.kind == "mistake" {
        let named = reading.findings.iter().any(|f| reading.fits(f, true));
        score.refused = Some((row.rc == Some(2) && !row.error.is_empty()) || !row.faults.is_empty() || named);
    }
    if !row.answered() {
        return score;
    }
    reading.proofs(&mut score);
    (score.bic, score.sindy) = (row.rival(&row.bic), row.rival(&row.sindy));
    score.beats_refit = row.unseen.zip(row.refit).map(|(own, refit)| own < refit);
    match row.kind.as_str() {
        "null" | "same" => {
            score.alarm = Some(reading.findings.iter().any(|f| !row.carried().contains(&f.mechanism)));
            let calm = Set::named(&row.set).is_some_and(|s| s.facts().calm);
            let weather = |f: &Named| f.kind == "environment" || WEATHER.contains(&f.mechanism);
            score.weather = calm.then(|| reading.findings.iter().any(weather));
            if let Some(partner) = partner {
                let sorted = |r: &Row| names(&r.named, '+').into_iter().map(str::to_owned).collect::<BTreeSet<_>>();
                score.same = Some(partner.verdict == row.verdict && sorted(partner) == sorted(row));
            }
        }
        "again" => score.fixed = (row.again != "-").then_some(row.again.is_empty()),
        "wind" => reading.directions(&mut score),
        "load" => score.right = Some(reading.findings.iter().any(|f| f.set.contains(&"wind"))),
        "mistake" => score.wrong = score.refused.map(|r| !r && reading.new_ones().any(|f| reading.is_wrong(f))),
        _ => reading.injected(&mut score),
    }
    score
}

#[cfg(test)]
mod tests {
    use super::*;

    fn null() -> Row {
        Row {
            case: "hsva/null/001".into(),
            set: "hsva".into(),
            kind: "null".into(),
            verdict: "nothing_missing".into(),
            ranked: r#"[["current", [0.01, -0.02]]]"#.into(),
            ..Row::default()
        }
    }

    fn current() -> Row {
        Row {
            case: "hsva/single/current/x1/1".into(),
            set: "hsva".into(),
            kind: "single".into(),
            expected: "named".into(),
            accepted: "current".into(),
            near: "tide".into(),
            truth: r#"[["current.north", 0.08], ["current.east", 0.06]]"#.into(),
            verdict: "named".into(),
            named: "current".into(),
            sets: "current".into(),
            kinds: "environment".into(),
            grades: "confirmed".into(),
            parameters: r#"[["current.north", 0.09, 0.08, 0.1, "m/s"], ["current.east", 0.04, 0.03, 0.05, "m/s"]]"#
                .into(),
            proof: "[[9.0, 2.0, 16.0, 0.3, 0.1, 0.5]]".into(),
            ..Row::default()
        }
    }

    #[test]
    fn a_size_is_what_is_found_with_it_less_what_is_found_without_it() {
        let s = score(&current(), Some(&null()));
        assert_eq!((s.right, s.wrong, s.covered, s.contradicted), (Some(true), Some(false), Some(true), Some(false)));
        assert!((s.ratio.unwrap() - 1.0).abs() < 1e-12 && s.size_error.unwrap() < 1e-12);
        assert_eq!((s.confirmed, s.better), (1, 1));
        // Named without it too: the name is no achievement, the size is.
        let carried = Row {
            named: "current".into(),
            sets: "current".into(),
            parameters: r#"[["current.north", 0.05, 0.0, 0.1, "m/s"], ["current.east", 0.01, 0.0, 0.1, "m/s"]]"#.into(),
            ..null()
        };
        let s = score(&current(), Some(&carried));
        assert_eq!(s.right, None);
        assert!((s.size_error.unwrap() - 0.5).abs() < 1e-12 && s.covered == Some(false));
        // Withdrawn without it, as too small to matter: that estimate, and not the one of the ranking, is the recordings' own.
        let small = Row {
            withdrawn: "current:immaterial".into(),
            withdrawn_parameters:
                r#"[["current.north", 0.05, 0.0, 0.1, "m/s"], ["current.east", 0.01, 0.0, 0.1, "m/s"]]"#.into(),
            ..null()
        };
        let s = score(&current(), Some(&small));
        assert!(s.right == Some(true) && (s.size_error.unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(score(&current(), None).size_error, None);
    }

    #[test]
    fn a_class_with_the_effect_in_it_is_right_and_a_confident_other_name_is_wrong() {
        let class = Row { named: "mean_wind".into(), sets: "mean_wind|current".into(), ..current() };
        let s = score(&class, Some(&null()));
        assert_eq!((s.right, s.wrong), (Some(true), Some(false)));
        let other = Row { named: "mean_wind".into(), sets: "mean_wind".into(), ..current() };
        let s = score(&other, Some(&null()));
        assert_eq!((s.right, s.wrong), (Some(false), Some(true)));
        let suspected = Row { grades: "suspected".into(), ..other.clone() };
        assert_eq!(score(&suspected, Some(&null())).wrong, Some(false));
        // An older program has no grades: its verdict says whether it is sure.
        let sure = Row { grades: String::new(), ..other.clone() };
        assert_eq!(score(&sure, Some(&null())).wrong, Some(true));
        assert_eq!(score(&Row { verdict: "one_of".into(), ..sure }, Some(&null())).wrong, Some(false));
        let near = Row { named: "tide".into(), sets: "tide".into(), ..current() };
        assert_eq!(score(&near, Some(&null())).wrong, Some(false));
    }

    #[test]
    fn weather_in_a_basin_a_contradiction_and_a_changed_answer_are_seen() {
        let windy =
            Row { kind: "null".into(), accepted: String::new(), withdrawn: "current:refuted".into(), ..current() };
        let s = score(&windy, None);
        assert_eq!((s.weather, s.alarm, s.contradicted), (Some(true), Some(true), Some(true)));
        let worse = Row { proof: "[[-9.0, -16.0, -2.0, null, null, null]]".into(), withdrawn: String::new(), ..windy };
        assert_eq!(score(&worse, None).contradicted, Some(true));
        let same = Row { kind: "same".into(), ..null() };
        assert_eq!(score(&same, Some(&null())).same, Some(true));
        assert_eq!(score(&Row { kind: "same".into(), ..current() }, Some(&null())).same, Some(false));
        let pond = Row { set: "esso".into(), kind: "null".into(), ..current() };
        let s = score(&pond, None);
        assert_eq!((s.weather, s.alarm), (None, Some(false)));
    }

    #[test]
    fn a_rival_is_right_by_name_and_on_recordings_with_nothing_injected_by_none() {
        let asked = |row: Row, bic: &str| score(&Row { bic: bic.into(), ..row }, None).bic;
        assert_eq!([asked(current(), "current"), asked(current(), "roll")], [Some(true), Some(false)]);
        assert_eq!([asked(null(), "nothing"), asked(null(), "roll")], [Some(true), Some(false)]);
        assert_eq!([asked(current(), ""), asked(current(), "(no rows)")], [None, None]);
        assert_eq!(asked(Row { expected: "either".into(), ..current() }, "current"), None);
        let unseen = |own, refit| score(&Row { unseen: own, refit, ..current() }, None).beats_refit;
        assert_eq!(
            [unseen(Some(4.0), Some(5.0)), unseen(Some(4.0), Some(3.0)), unseen(None, Some(3.0))],
            [Some(true), Some(false), None]
        );
    }

    #[test]
    fn faults_of_sensors_mistakes_and_winds_have_scores_of_their_own() {
        let fault =
            Row { sensor: true, expected: "silent".into(), accepted: String::new(), near: String::new(), ..current() };
        assert_eq!(score(&fault, Some(&null())).miscalled, Some(true));
        assert_eq!(score(&Row { kinds: "sensor".into(), ..fault }, Some(&null())).miscalled, Some(false));
        let mistake =
            Row { kind: "mistake".into(), rc: Some(2), error: "psi".into(), verdict: String::new(), ..null() };
        assert_eq!(score(&mistake, None).refused, Some(true));
        let missed = Row { kind: "mistake".into(), rc: Some(0), accepted: "unit_error".into(), ..null() };
        assert_eq!(score(&missed, None).refused, Some(false));
        let wind = Row {
            set: "esso".into(),
            kind: "wind".into(),
            winds: r#"[["a", 2.0, 0.0], ["b", 0.0, 2.0], ["c", 0.1, 0.0]]"#.into(),
            parameters: r#"[["current.north [a]", 1.0, 0.0, 2.0, "m/s"], ["current.east [a]", 0.1, 0.0, 2.0, "m/s"],
                ["current.north [b]", 1.0, 0.0, 2.0, "m/s"], ["current.east [b]", 0.1, 0.0, 2.0, "m/s"]]"#
                .into(),
            ..current()
        };
        let s = score(&wind, None);
        assert_eq!((s.windy, s.directions, s.near), (Some(true), 2, 1));
        let again = Row { kind: "again".into(), again: "munk".into(), ..current() };
        assert_eq!(score(&again, None).fixed, Some(false));
        assert_eq!(score(&Row { again: "-".into(), ..again }, None).fixed, None);
    }

    #[test]
    fn an_effect_in_some_sessions_is_right_with_those_sessions() {
        let some = Row { kind: "some".into(), sessions: "day 1".into(), found_sessions: "day 1".into(), ..current() };
        assert_eq!(score(&some, Some(&null())).sessions, Some(true));
        let all = Row { found_sessions: String::new(), ..some };
        assert_eq!(score(&all, Some(&null())).sessions, Some(false));
    }
}
