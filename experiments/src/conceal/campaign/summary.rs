//! The summary of a campaign: shares and medians of the scores, line by line against the aims.
//! It draws nothing; the selections are in `arms`.

use trimtab::report::Table;

use super::arms::{
    DIAGNOSIS, LOPSIDED, MODELS, WAYS, arm, lopsided, named_right, nulls, other_hull, right_side, single,
};
use super::plan::OTHERS;
use crate::conceal::judge::score::Score;
use trimtab::numbers::statistics::{Share, mean, median};

/// The result of one line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Found {
    /// A share of cases.
    Share(Share),
    /// A number.
    Number(f64),
}

/// One line of the summary.
#[derive(Debug, Clone)]
pub struct Line {
    /// What is counted.
    pub what: String,
    /// The aim, in words.
    pub target: String,
    /// The result; `None` without a case.
    pub found: Option<Found>,
    /// Whether the value itself (not its interval) meets the aim; `None` without an aim or without a case.
    pub met: Option<bool>,
}

/// An aim.
#[derive(Clone, Copy)]
enum Aim {
    /// No more than this.
    Most(f64),
    /// No less than this.
    Least(f64),
    /// Coverage of a 90 % interval.
    Calibrated,
    /// No aim; a word for the row.
    Word(&'static str),
}

/// A row without an aim.
const NO_AIM: Aim = Aim::Word("-");

impl Aim {
    fn met(self, value: f64) -> Option<bool> {
        match self {
            Self::Most(limit) => Some(value <= limit),
            Self::Least(limit) => Some(value >= limit),
            Self::Calibrated => Some((0.86..=0.94).contains(&value)),
            Self::Word(_) => None,
        }
    }

    /// The aim of a share in words.
    fn of_share(self) -> String {
        match self {
            Self::Most(0.0) => "none".to_owned(),
            Self::Most(limit) => format!("<= {:.0} %", 100.0 * limit),
            Self::Least(limit) => format!(">= {:.0} %", 100.0 * limit),
            Self::Calibrated => "86 to 94 %".to_owned(),
            Self::Word(word) => word.to_owned(),
        }
    }
}

/// The lines so far.
struct Lines<'a> {
    scores: &'a [Score],
    lines: Vec<Line>,
}

impl Lines<'_> {
    fn share(&mut self, what: &str, aim: Aim, cases: impl IntoIterator<Item = Option<bool>>) {
        let found = Share::of(cases);
        let met = found.and_then(|f| aim.met(f.value()));
        self.lines.push(Line { what: what.into(), target: aim.of_share(), found: found.map(Found::Share), met });
    }

    fn number(&mut self, what: &str, target: &str, aim: Aim, found: Option<f64>) {
        let met = found.and_then(|f| aim.met(f));
        self.lines.push(Line { what: what.into(), target: target.into(), found: found.map(Found::Number), met });
    }

    fn nulls(&mut self) {
        let s = self.scores;
        let alarms = |family| nulls(s, family).filter(|s| s.background != "euler").map(|s| s.false_alarm);
        self.share("false alarms, nulls of the HD family", Aim::Most(0.05), alarms("hd"));
        self.share("false alarms, nulls of the MMG family", Aim::Most(0.10), alarms("mmg"));
        let hull = nulls(s, "hd").filter(|s| s.background == "hull").map(|s| s.false_alarm);
        self.share("false names with 10 % hull errors, HD", Aim::Most(0.05), hull);
        let euler = arm(s, "null").filter(|s| s.background == "euler").map(|s| s.verdict_right);
        self.share("Euler-made data answered NUMERICS", Aim::Least(0.95), euler);
    }

    /// Detection and first names by strength.
    fn strengths(&mut self) {
        for (family, name) in [("hd", "HD"), ("mmg", "MMG")] {
            let first = |hd: f64| Aim::Least(if family == "mmg" { 0.80 } else { hd });
            for (snr, power, right) in [
                (3.0, NO_AIM, NO_AIM),
                (6.0, Aim::Least(0.80), first(0.85)),
                (12.0, Aim::Least(0.98), first(0.95)),
                (24.0, NO_AIM, NO_AIM),
            ] {
                let cases = single(self.scores, Some(family), snr);
                self.share(&format!("detection at SNR {snr}, {name}"), power, cases.clone().map(|s| s.detected));
                let what = format!("first name right, given detection, at SNR {snr}, {name}");
                self.share(&what, right, cases.map(|s| s.first_right));
            }
        }
        let twelve = single(self.scores, None, 12.0);
        self.share("truth in the confidence set at SNR 12", Aim::Least(0.9), twelve.clone().map(|s| s.in_set));
        self.share("right equation at SNR 12", Aim::Least(0.95), twelve.clone().map(|s| s.right_equation));
        self.share("true size in the 90 % interval at SNR 12", Aim::Calibrated, twelve.map(|s| s.covered));
    }

    /// One line or two for each other arm.
    fn arms(&mut self) {
        let s = self.scores;
        self.share("absorbed effects named", Aim::Most(0.0), arm(s, "absorbed").map(|s| s.absorbed_named));
        let wrong = |name| arm(s, name).map(|s| s.wrong_confident);
        self.share("wrong confident name, effects outside the catalogue", Aim::Most(0.1), wrong("withheld"));
        let pairs = arm(s, "compound").map(|s| s.some_right_none_wrong);
        self.share("pairs and triples: some right, none wrong", Aim::Least(0.95), pairs);
        self.share("pairs and triples: all named and no other", NO_AIM, arm(s, "compound").map(|s| s.exact));
        self.share(
            "effects that need a reference session, without one: wrong confident name",
            Aim::Most(0.1),
            wrong("pooled"),
        );
        self.share("effect in some sessions only: first name right", NO_AIM, arm(s, "contrast").map(named_right));
        self.share("designs with poor excitation: wrong confident name", Aim::Most(0.1), wrong("design"));
    }

    /// The other hulls, and the two sides of every ship with a known asymmetry.
    fn hulls(&mut self) {
        for family in OTHERS {
            let here = other_hull(self.scores, family);
            let mut line = |what: &str, aim: Aim, of: fn(&Score) -> Option<bool>| {
                self.share(&format!("{}: {what}", family.name()), aim, here.clone().map(of));
            };
            line("false alarms on nulls", Aim::Most(0.1), |s| s.false_alarm);
            line("detection at SNR 12", Aim::Least(0.98), |s| s.detected);
            line("first name right, given detection", Aim::Least(0.8), |s| s.first_right);
            line("truth in the confidence set", Aim::Least(0.9), |s| s.in_set);
            line("true size in the 90 % interval", Aim::Calibrated, |s| s.covered);
        }
        for family in LOPSIDED {
            let here = lopsided(self.scores, family);
            let mut line = |what: &str, aim: Aim, of: fn(&Score) -> Option<bool>| {
                self.share(&format!("{}: {what}", family.name()), aim, here.clone().map(of));
            };
            line("port and starboard reported to differ", NO_AIM, |s| s.sides_differ);
            line("of these, sign of the flow's asymmetry right", NO_AIM, right_side);
            line("true asymmetry of the flow in the 90 % interval", Aim::Calibrated, |s| s.asymmetry_covered);
        }
    }

    /// The diagnosis beside the other methods.
    fn rivals(&mut self) {
        let baseline = Aim::Word("(baseline)");
        for (family, of) in [("hd", "nulls of the HD family"), ("mmg", "nulls of the MMG family")] {
            for way in &WAYS[1..] {
                let here = nulls(self.scores, family).filter(|s| s.background != "euler");
                let wrong = here.map(|s| (way.right)(s).map(|r| !r));
                self.share(&format!("false alarms, {of}: {}", way.name), baseline, wrong);
            }
        }
        for snr in [6.0, 12.0] {
            for way in &WAYS {
                let aim = if way.name == DIAGNOSIS { NO_AIM } else { baseline };
                let what = format!("right name, detected or not, at SNR {snr}: {}", way.name);
                self.share(&what, aim, single(self.scores, None, snr).map(way.right));
            }
        }
    }

    /// Sizes, sets, windows, held-out errors and time. `all` are the scores with those that failed.
    fn numbers(&mut self, all: &[Score]) {
        let scores = self.scores;
        for family in OTHERS {
            let sizes = other_hull(scores, family).filter_map(|s| s.size_error);
            let what = format!("{}: median error of the size", family.name());
            self.number(&what, "<= 0.10", Aim::Most(0.1), median(sizes));
        }
        for family in LOPSIDED {
            let here = || lopsided(scores, family);
            let error = |s: &Score| Some((s.asymmetry_found? - s.asymmetry?).abs());
            let what = |what: &str| format!("{}: median {what} of the flow at the rudder", family.name());
            self.number(&what("true asymmetry"), "-", NO_AIM, median(here().filter_map(|s| s.asymmetry.map(f64::abs))));
            self.number(&what("error of the asymmetry"), "-", NO_AIM, median(here().filter_map(error)));
        }
        let twelve = || single(scores, None, 12.0);
        let sets = mean(twelve().filter_map(|s| s.set_size));
        self.number("mean size of the confidence set at SNR 12", "<= 1.6", Aim::Most(1.6), sets);
        let windows = mean(twelve().filter(|s| s.effects == "push").filter_map(|s| s.window_iou));
        self.number("mean window overlap (IoU) at SNR 12", ">= 0.8", Aim::Least(0.8), windows);
        let sizes = median(twelve().filter_map(|s| s.size_error));
        self.number("median error of the size at SNR 12", "<= 0.10", Aim::Most(0.1), sizes);
        let gap = median(twelve().filter_map(|s| s.gap_closed));
        self.number("median share of the held-out gap closed at SNR 12", ">= 0.90", Aim::Least(0.9), gap);
        for model in &MODELS {
            // One set of cases for all models: those with an oracle.
            let compared = twelve().filter(|s| s.oracle_held_out.is_some());
            let what = format!("median held-out cVDM at SNR 12 [%]: {}", model.name);
            self.number(&what, model.target, NO_AIM, median(compared.filter_map(model.score)));
        }
        let seconds = median(scores.iter().filter_map(|s| s.seconds));
        self.number("median time of a diagnosis [s]", "<= 5", Aim::Most(5.0), seconds);
        let failed = Some((all.len() - scores.len()) as f64);
        self.number("cases without a score", "0", Aim::Most(0.0), failed);
    }
}

/// The summary, line by line against the aims.
pub fn summary(all: &[Score]) -> Vec<Line> {
    let scores: Vec<Score> = all.iter().filter(|s| s.error.is_empty()).cloned().collect();
    let mut lines = Lines { scores: &scores, lines: Vec::new() };
    lines.nulls();
    lines.strengths();
    lines.arms();
    lines.hulls();
    lines.rivals();
    lines.numbers(all);
    lines.lines
}

/// The summary as a table for the terminal or a file.
pub fn table(lines: &[Line]) -> Table {
    let mut table = Table::new(["what", "target", "found", "met"]);
    for line in lines {
        let found = match line.found {
            None => "no case".to_owned(),
            Some(Found::Share(s)) => s.to_string(),
            Some(Found::Number(v)) => format!("{v:.3}"),
        };
        let met = match line.met {
            Some(true) => "yes",
            Some(false) => "no",
            None => "",
        };
        table.row([line.what.as_str(), line.target.as_str(), found.as_str(), met]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_the_cases_that_apply_and_leaves_out_failed_ones() {
        let score = |arm: &str, alarm: Option<bool>, right: Option<bool>, error: &str| Score {
            arm: arm.into(),
            family: "hd".into(),
            background: "ordinary".into(),
            snr_asked: (arm == "single").then_some(12.0),
            snr: (arm == "single").then_some(12.1),
            false_alarm: alarm,
            detected: right.map(|_| true),
            first_right: right,
            error: error.into(),
            ..Score::default()
        };
        let compared = Score {
            bic_right: Some(false),
            refit_held_out: Some(3.0),
            named_held_out: Some(2.0),
            oracle_held_out: Some(1.0),
            ..score("single", None, Some(true), "")
        };
        let lines = summary(&[
            score("null", Some(false), None, ""),
            score("null", Some(true), None, ""),
            score("null", Some(true), None, "diagnose failed"),
            compared,
            // Not seen, and nobody else was asked.
            Score { detected: Some(false), refit_held_out: Some(90.0), ..score("single", None, None, "") },
        ]);
        let find = |what: &str| lines.iter().find(|l| l.what == what).and_then(|l| l.found);
        assert!(
            matches!(find("false alarms, nulls of the HD family"), Some(Found::Share(s)) if (s.hits, s.of) == (1, 2))
        );
        let name = "first name right, given detection, at SNR 12, HD";
        assert!(matches!(find(name), Some(Found::Share(s)) if (s.hits, s.of) == (1, 1)));
        let counts = |what: &str| match find(what) {
            Some(Found::Share(s)) => (s.hits, s.of),
            _ => (0, 0),
        };
        assert_eq!(counts("right name, detected or not, at SNR 12: diagnosis"), (1, 2));
        assert_eq!(counts("right name, detected or not, at SNR 12: iid BIC"), (0, 1));
        assert_eq!(counts("right name, detected or not, at SNR 12: sparse regression"), (0, 0));
        let of = |name: &str| find(&format!("median held-out cVDM at SNR 12 [%]: {name}"));
        assert_eq!(of("refit only, the paper's method"), Some(Found::Number(3.0)));
        assert_eq!(
            (of("with the mechanisms named"), of("oracle")),
            (Some(Found::Number(2.0)), Some(Found::Number(1.0)))
        );
        assert_eq!(find("cases without a score"), Some(Found::Number(1.0)));
    }
}
