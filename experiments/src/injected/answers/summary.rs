//! The summary of the campaign on real recordings: each aim with its share, interval and number of cases, met or short.
//! It draws nothing and judges no single case.

use std::collections::HashMap;

use trimtab::numbers::statistics::{Share, median};
use trimtab::report::Table;

use super::row::Row;
use super::score::{Score, score};
pub use crate::conceal::campaign::summary::table;
use crate::conceal::campaign::summary::{Found, Line};
use crate::injected::plan::is_strong;
use crate::injected::set::SETS;

/// A row with its score.
pub type Scored<'a> = (&'a Row, Score);

/// A question about a case; `None` where it does not apply.
type Question = fn(&Score) -> Option<bool>;

/// Scores every row beside its partner.
pub fn scored(rows: &[Row]) -> Vec<Scored<'_>> {
    let by_key: HashMap<&str, &Row> = rows.iter().map(|r| (r.case.as_str(), r)).collect();
    rows.iter().map(|r| (r, score(r, by_key.get(r.partner.as_str()).copied()))).collect()
}

/// The aim of a line.
#[derive(Clone, Copy)]
enum Aim {
    Most(f64),
    Least(f64),
    Within(f64, f64),
    None,
}

impl Aim {
    fn words(self) -> String {
        let percent = |v: f64| format!("{:.0} %", 100.0 * v);
        match self {
            Self::Most(0.0) => "never".to_owned(),
            Self::Most(limit) => format!("<= {}", percent(limit)),
            Self::Least(limit) => format!(">= {}", percent(limit)),
            Self::Within(low, high) => format!("{:.0} to {}", 100.0 * low, percent(high)),
            Self::None => "-".to_owned(),
        }
    }

    fn met(self, value: f64) -> Option<bool> {
        match self {
            Self::Most(limit) => Some(value <= limit),
            Self::Least(limit) => Some(value >= limit),
            Self::Within(low, high) => Some((low..=high).contains(&value)),
            Self::None => None,
        }
    }
}

/// The lines so far.
struct Lines<'a> {
    all: &'a [Scored<'a>],
    lines: Vec<Line>,
}

/// Whether a case has the strength of a current of a tenth of the speed, or more.
pub fn strong(row: &Row) -> bool {
    is_strong(row.strength)
}

impl Lines<'_> {
    fn add(&mut self, what: String, aim: Aim, share: Option<Share>) {
        let met = share.and_then(|s| aim.met(s.value()));
        self.lines.push(Line { what, target: aim.words(), found: share.map(Found::Share), met });
    }

    /// The share of cases that the filter takes.
    fn share(&mut self, what: &str, aim: Aim, takes: impl Fn(&Row) -> bool, of: Question) {
        let share = Share::of(self.all.iter().filter(|(r, _)| takes(r)).map(|(_, s)| of(s)));
        self.add(what.to_owned(), aim, share);
    }

    fn number(&mut self, what: &str, target: &str, met: fn(f64) -> Option<bool>, found: Option<f64>) {
        let met = found.and_then(met);
        self.lines.push(Line { what: what.into(), target: target.into(), found: found.map(Found::Number), met });
    }

    fn nulls(&mut self) {
        self.share("weather named in a basin, nothing injected", Aim::Most(0.02), |_| true, |s| s.weather);
        for set in SETS.into_iter().filter(|s| s.facts().calm) {
            for turned in ["no", "together", "each"] {
                let what = format!("of these {}, recordings turned: {turned}", set.name());
                self.share(&what, Aim::None, |r| r.set == set.name() && r.turned == turned, |s| s.weather);
            }
        }
        for set in SETS {
            let what = format!("{}: a name that the recordings do not carry, nothing injected", set.name());
            self.share(&what, Aim::None, |r| r.set == set.name() && r.kind == "null", |s| s.alarm);
        }
        self.share("a name and its refutation in one answer", Aim::Most(0.0), |_| true, |s| s.contradicted);
    }

    fn invariances(&mut self) {
        let what = "same answer under a change that changes nothing physical";
        self.share(what, Aim::Least(0.95), |r| r.kind == "same", |s| s.same);
        for change in changes(self.all) {
            let of = |r: &Row| r.kind == "same" && self::change(r) == Some(change.as_str());
            let share = Share::of(self.all.iter().filter(|(r, _)| of(r)).map(|(_, s)| s.same));
            self.add(format!("of these: {change}"), Aim::None, share);
        }
        let what = "improved model diagnosed again: nothing further";
        self.share(what, Aim::Least(0.95), |r| r.kind == "again", |s| s.fixed);
        let stable = self.all.iter().filter_map(|(r, _)| Some(r.stable? == r.stable_of?));
        let share = Share::of(stable.map(Some));
        self.add("the program calls its answer stable in all repetitions".to_owned(), Aim::None, share);
    }

    fn effects(&mut self) {
        let single = |r: &Row| r.kind == "single" && strong(r);
        self.share("named alone or in its class, strength 1 and 2", Aim::Least(0.9), single, |s| s.right);
        self.share("wrong name in confidence, strength 1 and 2", Aim::Most(0.02), single, |s| s.wrong);
        for set in SETS {
            let here = |r: &Row| single(r) && r.set == set.name();
            self.share(&format!("of these {}: named", set.name()), Aim::None, here, |s| s.right);
            self.share(&format!("of these {}: wrong name in confidence", set.name()), Aim::None, here, |s| s.wrong);
        }
        let weak = |r: &Row| r.kind == "single" && !strong(r);
        self.share("named alone or in its class, strength 0.25 and 0.5", Aim::None, weak, |s| s.right);
        self.share("wrong name in confidence, strength 0.25 and 0.5", Aim::None, weak, |s| s.wrong);
        let what = "size as a difference: 95 % interval holds it, strength 1 and 2";
        self.share(what, Aim::Within(0.90, 0.98), single, |s| s.covered);
        let errors = self.all.iter().filter(|(r, _)| single(r)).filter_map(|(_, s)| s.size_error);
        let what = "size as a difference: median error over the size, strength 1 and 2";
        self.number(what, "<= 0.10", |v| Some(v <= 0.1), median(errors));
        self.share("fault of a sensor called ship or weather", Aim::Most(0.02), |_| true, |s| s.miscalled);
        self.share("faults of a logger: wrong name in confidence", Aim::None, |r| r.kind == "logger", |s| s.wrong);
        self.share("effect in some sessions: named", Aim::None, |r| r.kind == "some", |s| s.right);
        self.share("effect in some sessions: its sessions are right", Aim::None, |r| r.kind == "some", |s| s.sessions);
        self.share("pairs: both named", Aim::None, |r| r.kind == "pair", |s| s.right);
        self.share("pairs: some right, none wrong", Aim::None, |r| r.kind == "pair", |s| s.some_right);
        self.share("mistakes of a user refused or named", Aim::None, |_| true, |s| s.refused);
    }

    fn winds(&mut self) {
        let what = "Esso Osaka without its anemometer: wind, current, wave drift or earth-fixed force named";
        self.share(what, Aim::Least(0.9), |r| r.kind == "wind", |s| s.windy);
        let sum = |of: fn(&Score) -> usize| self.all.iter().map(|(_, s)| of(s)).sum::<usize>();
        let (near, of, better, confirmed) =
            (sum(|s| s.near), sum(|s| s.directions), sum(|s| s.better), sum(|s| s.confirmed));
        let share = |hits, of| (of > 0).then(|| Share::new(hits, of));
        let what = "its direction within 20 deg, sessions with over 1 m/s";
        self.add(what.to_owned(), Aim::Least(0.9), share(near, of));
        self.share("measured wind without a load in the model: named", Aim::None, |r| r.kind == "load", |s| s.right);
        let what = "confirmed findings that are better in free simulation of unseen runs";
        self.add(what.to_owned(), Aim::Least(0.95), share(better, confirmed));
    }

    /// The diagnosis and its rivals on the cases that the rivals were asked of.
    fn rivals(&mut self) {
        type Asked = fn(&Score) -> Option<bool>;
        let rivals: [(&str, Asked); 2] =
            [("BIC after a refit of trajectories", |s| s.bic), ("sparse regression", |s| s.sindy)];
        for (name, of) in rivals {
            for (what, kind) in [("named, strength 1 and 2", "single"), ("no false name, nothing injected", "null")] {
                self.share(&format!("{name}: {what}"), Aim::None, |r| r.kind == kind, of);
            }
            let own = |s: &Score| of(s).and(s.right);
            let share = Share::of(self.all.iter().filter(|(r, _)| r.kind == "single").map(|(_, s)| own(s)));
            if share.is_some() {
                self.add(format!("the diagnosis where {name} answers: named, strength 1 and 2"), Aim::None, share);
            }
        }
        let what = "unseen runs predicted better than by a refit of trajectories, strength 1 and 2";
        self.share(what, Aim::None, |r| r.kind == "single", |s| s.beats_refit);
    }

    fn times(&mut self) {
        for set in SETS {
            let seconds = self.all.iter().filter(|(r, _)| r.set == set.name()).filter_map(|(r, _)| r.seconds);
            self.number(&format!("{}: median time of a diagnosis [s]", set.name()), "-", |_| None, median(seconds));
        }
        let silent = self.all.iter().filter(|(r, s)| !r.answered() && s.refused != Some(true)).count();
        self.number("cases without an answer", "0", |v| Some(v == 0.0), Some(silent as f64));
    }
}

/// The change of a case that changes nothing physical: `marin/same/turned/3`.
fn change(row: &Row) -> Option<&str> {
    row.case.split('/').nth(2)
}

/// Every such change, in the order of the rows.
pub fn changes(all: &[Scored]) -> Vec<String> {
    let mut changes: Vec<String> = Vec::new();
    for (row, _) in all.iter().filter(|(r, _)| r.kind == "same") {
        if let Some(change) = change(row).filter(|c| !changes.iter().any(|d| d == c)) {
            changes.push(change.to_owned());
        }
    }
    changes
}

/// Share of unchanged answers under one change.
pub fn unchanged(all: &[Scored], change: &str) -> Option<Share> {
    let of = |r: &Row| r.kind == "same" && self::change(r) == Some(change);
    Share::of(all.iter().filter(|(r, _)| of(r)).map(|(_, s)| s.same))
}

/// The summary, line by line against the aims.
pub fn summary(rows: &[Row]) -> Vec<Line> {
    let all = scored(rows);
    let mut lines = Lines { all: &all, lines: Vec::new() };
    lines.nulls();
    lines.invariances();
    lines.effects();
    lines.winds();
    lines.rivals();
    lines.times();
    lines.lines
}

/// Single effects and faults of the logger by strength.
pub fn by_strength(rows: &[Row]) -> Table {
    let all = scored(rows);
    let mut table = Table::new([
        "effect",
        "strength",
        "cases",
        "named alone or in its class",
        "wrong name in confidence",
        "called ship or weather",
        "95 % interval holds the difference",
        "median error of the difference",
    ]);
    let mut groups: Vec<(&str, f64)> = Vec::new();
    let graded = |r: &Row| r.kind == "single" || r.kind == "logger";
    for (row, _) in all.iter().filter(|(r, _)| graded(r)) {
        let group = (row.injected.as_str(), row.strength.unwrap_or(0.0));
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    groups.sort_by(|a, b| a.0.cmp(b.0).then(a.1.total_cmp(&b.1)));
    for (effect, strength) in groups {
        let here: Vec<&Scored> =
            all.iter().filter(|(r, _)| graded(r) && r.injected == effect && r.strength == Some(strength)).collect();
        let share = |of: Question| Share::of(here.iter().map(|(_, s)| of(s))).map_or(String::new(), |s| s.to_string());
        let error = median(here.iter().filter_map(|(_, s)| s.size_error));
        table.row([
            effect.to_owned(),
            strength.to_string(),
            here.len().to_string(),
            share(|s| s.right),
            share(|s| s.wrong),
            share(|s| s.miscalled),
            share(|s| s.covered),
            error.map_or(String::new(), |e| format!("{e:.3}")),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(case: &str, named: &str) -> Row {
        let mut parts = case.split('/');
        let mut part = || parts.next().unwrap_or_default().to_owned();
        Row {
            set: part(),
            kind: part(),
            case: case.into(),
            turned: "no".into(),
            verdict: if named.is_empty() { "nothing_missing" } else { "named" }.into(),
            named: named.into(),
            sets: named.into(),
            kinds: "environment".into(),
            ..Row::default()
        }
    }

    #[test]
    fn lines_count_the_cases_they_are_of() {
        let single = Row {
            partner: "hsva/null/001".into(),
            expected: "named".into(),
            accepted: "current".into(),
            injected: "current".into(),
            strength: Some(1.0),
            truth: r#"[["current.north", 0.1]]"#.into(),
            parameters: r#"[["current.north", 0.09, 0.07, 0.11, "m/s"]]"#.into(),
            ..row("hsva/single/current/x1/1", "current")
        };
        let weak = Row { strength: Some(0.25), ..single.clone() };
        let same = Row { partner: "hsva/null/001".into(), ..row("hsva/same/turned/1", "current") };
        let rows = [
            row("hsva/null/001", ""),
            row("marin/null/001", "current"),
            row("esso/null/001", "current"),
            single,
            weak,
            same,
        ];
        let lines = summary(&rows);
        let counts = |what: &str| match lines.iter().find(|l| l.what == what).and_then(|l| l.found) {
            Some(Found::Share(s)) => (s.hits, s.of),
            _ => (0, 0),
        };
        assert_eq!(counts("weather named in a basin, nothing injected"), (2, 3));
        assert_eq!(counts("named alone or in its class, strength 1 and 2"), (1, 1));
        assert_eq!(counts("named alone or in its class, strength 0.25 and 0.5"), (1, 1));
        assert_eq!(counts("size as a difference: 95 % interval holds it, strength 1 and 2"), (1, 1));
        assert_eq!(counts("same answer under a change that changes nothing physical"), (0, 1));
        assert_eq!(counts("of these: turned"), (0, 1));
        assert_eq!(by_strength(&rows).rows().len(), 2);
    }
}
