//! The campaign: which cases are made, the table of their scores, and what the table says against the targets.
//! Making, diagnosing and judging a case is the runner's work; nothing here runs anything.

use std::collections::BTreeSet;

use serde::Serialize;
use trimtab::report::{
    Axis, BASELINE, BLUE, Color, FITTED, Figure, GREEN, GREY, LIMIT, Layer, ORACLE, ORANGE, PURPLE, Panel, SKY, Table,
};
use trimtab::statistics::{Share, mean, median};

use super::craft::Family;
use super::design::Design;
use super::effects::{Class, Entry, catalogue, find};
use super::judge::Score;
use super::seal::digest;
use super::{Background, Spec, Strength};

/// Seed of the committed campaign, fixed before any case was diagnosed.
pub const SEED: u64 = 20_250_226;

/// One case of the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// Key in the results, unique: `hd/current/snr12/1`.
    pub key: String,
    /// Part of the campaign: `null`, `single`, `pooled`, `contrast`, `withheld`, `absorbed`, `compound`, `design`,
    /// `hulls`.
    pub arm: &'static str,
    /// The case.
    pub spec: Spec,
}

/// Pairs and triples that look alike or hide each other.
const COMPOUNDS: [&[&str]; 11] = [
    &["current", "walk_astern"],
    &["mean_wind", "wave_drift"],
    &["current", "mean_wind"],
    &["rudder_lag", "heading_bias"],
    &["current", "time_skew"],
    &["mean_wind", "yaw_rate_bias"],
    &["log_scale", "engine_lag"],
    &["thruster", "wave_drift"],
    &["current", "walk_astern", "rudder_lag"],
    &["mean_wind", "log_scale", "thruster"],
    &["wave_drift", "heading_bias", "push"],
];

/// Effects that more or other data would tell from their look-alikes, for the designs that cannot.
const AMBIGUOUS: [&str; 6] = ["current", "mean_wind", "heading_bias", "log_scale", "shallow", "crossflow"];

/// Effects that a reference session makes visible.
const CONTRASTED: [&str; 12] = [
    "current",
    "mean_wind",
    "walk_astern",
    "rudder_lag",
    "heading_bias",
    "wave_drift",
    "engine_lag",
    "wind",
    "fouling",
    "thrust_loss",
    "rudder_offset",
    "race",
];

/// The arm of the campaign with other hulls than the one that thresholds were set on.
const OTHER_HULLS: &str = "hulls";

/// The hulls in it.
const OTHERS: [Family; 2] = [Family::Tanker, Family::Flap];

/// Seed of a case: from the campaign's seed and the key, so that no case moves when another is added.
fn seed(campaign: u64, key: &str) -> u64 {
    let hex = digest(format!("{campaign} {key}").as_bytes());
    // 48 bits: exact as a number in every JSON reader.
    u64::from_str_radix(&hex[..12], 16).unwrap_or(campaign)
}

struct Planner {
    campaign: u64,
    cases: Vec<Planned>,
}

impl Planner {
    fn add(&mut self, arm: &'static str, name: &str, count: usize, spec: impl Fn(u64) -> Spec) {
        for i in 1..=count {
            let key = format!("{name}/{i}");
            let spec = spec(seed(self.campaign, &key));
            self.cases.push(Planned { key, arm, spec });
        }
    }
}

/// Everything that is made, in a fixed order: over 1000 cases.
pub fn plan(campaign: u64) -> Vec<Planned> {
    let mut p = Planner { campaign, cases: Vec::new() };
    for family in [Family::Hd, Family::Mmg] {
        let f = family.name();
        let fits = |e: &&'static Entry| family == Family::Hd || e.in_mmg;
        let base = |seed: u64| Spec::null(family, seed);
        let one = |name: &str, strength: Strength, seed: u64| Spec {
            effects: vec![(name.to_owned(), strength)],
            ..base(seed)
        };
        for (background, count) in [
            (Background::Ordinary, 30),
            (Background::Gusts, 20),
            (Background::Coloured, 15),
            (Background::Hull, 20),
            (Background::Euler, 10),
            (Background::Outliers, 10),
            (Background::Dropouts, 10),
        ] {
            p.add("null", &format!("{f}/null/{}", background.name()), count, |seed| Spec { background, ..base(seed) });
        }
        let told = |e: &&'static Entry| matches!(e.class, Class::Force | Class::Sensor);
        for e in catalogue().filter(told).filter(fits) {
            // A wrong sign or unit is there or not.
            if e.name == "sign_error" || e.name == "unit_error" {
                p.add("single", &format!("{f}/{}", e.name), 2, |seed| one(e.name, Strength::Times(1.0), seed));
                continue;
            }
            for snr in [3.0, 6.0, 12.0, 24.0] {
                let count = if family == Family::Hd && snr > 3.0 && snr < 24.0 { 3 } else { 2 };
                // What unknown hull coefficients can mimic has a reference session, in which it is absent.
                p.add("single", &format!("{f}/{}/snr{snr}", e.name), count, |seed| Spec {
                    contrast: e.reference,
                    ..one(e.name, Strength::Snr(snr), seed)
                });
            }
            if e.reference {
                p.add("pooled", &format!("{f}/pooled/{}", e.name), 2, |seed| one(e.name, Strength::Times(1.0), seed));
            }
        }
        for e in catalogue().filter(|e| e.class == Class::Withheld) {
            for times in [0.5, 1.0, 2.0] {
                p.add("withheld", &format!("{f}/{}/x{times}", e.name), 2, |seed| {
                    one(e.name, Strength::Times(times), seed)
                });
            }
        }
        for e in catalogue().filter(|e| e.class == Class::Absorbed) {
            for times in [1.0, 2.0] {
                p.add("absorbed", &format!("{f}/{}/x{times}", e.name), 2, |seed| {
                    one(e.name, Strength::Times(times), seed)
                });
            }
        }
        for names in COMPOUNDS {
            p.add("compound", &format!("{f}/{}/snr16", names.join("+")), 3, |seed| Spec {
                effects: names.iter().map(|n| ((*n).to_owned(), Strength::Snr(16.0))).collect(),
                ..base(seed)
            });
        }
        for name in CONTRASTED {
            // What is absorbed has no ratio of its own without a reference: it is graded by size.
            let absorbed = find(name).is_some_and(|e| e.class == Class::Absorbed);
            let strength = if absorbed { Strength::Times(1.5) } else { Strength::Snr(12.0) };
            p.add("contrast", &format!("{f}/contrast/{name}"), 2, |seed| Spec {
                contrast: true,
                ..one(name, strength, seed)
            });
        }
        for design in [Design::OneHeading, Design::Straight, Design::Few] {
            for name in AMBIGUOUS {
                p.add("design", &format!("{f}/{}/{name}", design.name()), 2, |seed| Spec {
                    design,
                    ..one(name, Strength::Times(1.5), seed)
                });
            }
        }
    }
    for family in OTHERS {
        let f = family.name();
        let base = |seed: u64| Spec::null(family, seed);
        for (background, count) in [(Background::Ordinary, 10), (Background::Gusts, 5), (Background::Coloured, 5)] {
            let key = format!("{f}/null/{}", background.name());
            p.add(OTHER_HULLS, &key, count, |seed| Spec { background, ..base(seed) });
        }
        let told = |e: &&'static Entry| matches!(e.class, Class::Force | Class::Sensor) && e.in_mmg;
        // A wrong sign or unit is found before any ship is looked at.
        for e in catalogue().filter(told).filter(|e| e.name != "sign_error" && e.name != "unit_error") {
            p.add(OTHER_HULLS, &format!("{f}/{}/snr12", e.name), 2, |seed| Spec {
                effects: vec![(e.name.to_owned(), Strength::Snr(12.0))],
                contrast: e.reference,
                ..base(seed)
            });
        }
    }
    p.cases
}

/// A slice of the plan small enough for every push: 40 cases, from all arms in proportion but never none.
pub fn ci_slice(plan: &[Planned]) -> Vec<Planned> {
    let quotas = [
        ("null", 12),
        ("single", 12),
        ("pooled", 1),
        ("withheld", 3),
        ("absorbed", 3),
        ("compound", 3),
        ("contrast", 2),
        ("design", 2),
        (OTHER_HULLS, 2),
    ];
    let mut chosen = Vec::new();
    for (arm, quota) in quotas {
        let of_arm: Vec<&Planned> = plan
            .iter()
            .filter(|c| c.arm == arm)
            // One strength: what is hard to see is no test of a single push, and what anyone can see is none either.
            .filter(|c| ["snr3/", "snr6/", "snr24/"].iter().all(|s| !c.key.contains(s)))
            .collect();
        let step = of_arm.len() as f64 / quota as f64;
        chosen.extend((0..quota).filter_map(|i| of_arm.get(((i as f64 + 0.5) * step) as usize)).map(|c| (*c).clone()));
    }
    chosen
}

/// What a target asks of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum Found {
    /// A share of cases.
    Share(Share),
    /// A number.
    Number(f64),
}

/// One line of the summary.
#[derive(Debug, Clone, Serialize)]
pub struct Line {
    /// What is counted.
    pub what: String,
    /// What is aimed at, in words.
    pub target: String,
    /// What came out; `None` when no case says.
    pub found: Option<Found>,
    /// Whether the value itself (not its interval) meets the target.
    pub met: Option<bool>,
}

/// Names that are identifiable: graded by their own ratio, in the standard design.
fn single<'a>(scores: &'a [Score], family: Option<&'a str>, snr: f64) -> impl Iterator<Item = &'a Score> + Clone {
    scores.iter().filter(move |s| {
        s.arm == "single" && s.snr_asked == Some(snr) && family.is_none_or(|f| s.family == f) && reached(s)
    })
}

/// Whether a case is as strong as it was meant to be: an effect stopped at its largest size is not.
fn reached(score: &Score) -> bool {
    match (score.snr_asked, score.snr) {
        (Some(asked), Some(snr)) => snr > 0.7 * asked,
        _ => true,
    }
}

/// Families whose flow at the rudder is straightened differently on her two sides, by a single number that is known.
const LOPSIDED: [Family; 3] = [Family::Mmg, Family::Tanker, Family::Flap];

/// Their cases that say something of her two sides: nulls, and everything of the other hulls.
fn lopsided(scores: &[Score], family: Family) -> impl Iterator<Item = &Score> + Clone {
    let arms = ["null", OTHER_HULLS];
    scores.iter().filter(move |s| s.family == family.name() && arms.contains(&s.arm.as_str()) && s.asymmetry.is_some())
}

/// Whether the flow's asymmetry has its true sign, where her sides were said to differ.
fn right_side(score: &Score) -> Option<bool> {
    let product = score.asymmetry_found? * score.asymmetry?;
    (score.sides_differ?).then_some(product > 0.0)
}

/// The families as figures show them.
const SHOWN: [(&str, Color, Family); 4] = [
    ("HD truth", BLUE, Family::Hd),
    ("MMG truth", ORANGE, Family::Mmg),
    ("tanker", SKY, Family::Tanker),
    ("flapped rudder", BASELINE, Family::Flap),
];

/// A way to answer what is missing.
struct Way {
    name: &'static str,
    color: Color,
    /// Whether it named the effect, or nothing on a null; unknown where it was not asked.
    right: fn(&Score) -> Option<bool>,
}

/// What the diagnosis itself is called beside the others.
const DIAGNOSIS: &str = "diagnosis";

/// The diagnosis, and what a user would do otherwise.
const WAYS: [Way; 3] = [
    Way { name: DIAGNOSIS, color: FITTED, right: named_right },
    Way { name: "iid BIC", color: PURPLE, right: |s| s.bic_right },
    Way { name: "sparse regression", color: GREY, right: |s| s.sindy_right },
];

/// A model to predict unseen runs with.
struct Predictor {
    name: &'static str,
    target: &'static str,
    color: Color,
    score: fn(&Score) -> Option<f64>,
}

/// From the paper's way to the best that could be reached.
const MODELS: [Predictor; 4] = [
    Predictor {
        name: "refit only, the paper's way",
        target: "(baseline)",
        color: BASELINE,
        score: |s| s.refit_held_out,
    },
    Predictor { name: "base model of the diagnosis", target: "-", color: SKY, score: |s| s.base_held_out },
    Predictor { name: "with what it named", target: "-", color: FITTED, score: |s| s.named_held_out },
    Predictor { name: "oracle", target: "(bound)", color: ORACLE, score: |s| s.oracle_held_out },
];

/// Whether the diagnosis named the effect first, seen or not; on a null, whether it raised no alarm.
fn named_right(score: &Score) -> Option<bool> {
    match (score.false_alarm, score.detected) {
        (Some(alarm), _) => Some(!alarm),
        (None, Some(false)) => Some(false),
        (None, _) => score.first_right,
    }
}

/// The table of the summary, line by line against the targets.
pub fn summary(all: &[Score]) -> Vec<Line> {
    let scores: Vec<Score> = all.iter().filter(|s| s.error.is_empty()).cloned().collect();
    let scores = scores.as_slice();
    let arm = |arm: &'static str| scores.iter().filter(move |s| s.arm == arm);
    let null = |family: &'static str| arm("null").filter(move |s| s.family == family);
    let mut lines = Vec::new();
    let mut share = |what: &str, target: &str, found: Option<Share>, met: &dyn Fn(f64) -> bool| {
        let met = found.map(|f| met(f.value()));
        lines.push(Line { what: what.into(), target: target.into(), found: found.map(Found::Share), met });
    };
    let (hd, mmg) = (Some("hd"), Some("mmg"));
    let at_most = |limit: f64| move |v: f64| v <= limit;
    let at_least = |limit: f64| move |v: f64| v >= limit;
    let calibrated = |v: f64| (0.86..=0.94).contains(&v);
    share(
        "false alarms, nulls of the HD family",
        "<= 5 %",
        Share::of(null("hd").filter(|s| s.background != "euler").map(|s| s.false_alarm)),
        &at_most(0.05),
    );
    share(
        "false alarms, nulls of the MMG family",
        "<= 10 %",
        Share::of(null("mmg").filter(|s| s.background != "euler").map(|s| s.false_alarm)),
        &at_most(0.10),
    );
    share(
        "false names with 10 % hull errors, HD",
        "<= 5 %",
        Share::of(null("hd").filter(|s| s.background == "hull").map(|s| s.false_alarm)),
        &at_most(0.05),
    );
    share(
        "Euler-made data answered NUMERICS",
        ">= 95 %",
        Share::of(arm("null").filter(|s| s.background == "euler").map(|s| s.verdict_right)),
        &at_least(0.95),
    );
    for (family, name) in [(hd, "HD"), (mmg, "MMG")] {
        for (snr, power, right) in
            [(3.0, None, None), (6.0, Some(0.80), Some(0.85)), (12.0, Some(0.98), Some(0.95)), (24.0, None, None)]
        {
            let right = if family == mmg && right.is_some() { Some(0.80) } else { right };
            let words = |limit: Option<f64>| limit.map_or("-".into(), |l| format!(">= {:.0} %", 100.0 * l));
            let cases = single(scores, family, snr);
            share(
                &format!("detection at SNR {snr}, {name}"),
                &words(power),
                Share::of(cases.clone().map(|s| s.detected)),
                &at_least(power.unwrap_or(0.0)),
            );
            share(
                &format!("first name right, given detection, at SNR {snr}, {name}"),
                &words(right),
                Share::of(cases.map(|s| s.first_right)),
                &at_least(right.unwrap_or(0.0)),
            );
        }
    }
    let twelve = || single(scores, None, 12.0);
    share("truth in the confidence set at SNR 12", ">= 90 %", Share::of(twelve().map(|s| s.in_set)), &at_least(0.9));
    share("right equation at SNR 12", ">= 95 %", Share::of(twelve().map(|s| s.right_equation)), &at_least(0.95));
    share(
        "true size in the 90 % interval at SNR 12",
        "86 to 94 %",
        Share::of(twelve().map(|s| s.covered)),
        &calibrated,
    );
    share(
        "absorbed effects named all the same",
        "none",
        Share::of(arm("absorbed").map(|s| s.absorbed_named)),
        &at_most(0.0),
    );
    share(
        "wrong confident name, effects outside the catalogue",
        "<= 10 %",
        Share::of(arm("withheld").map(|s| s.wrong_confident)),
        &at_most(0.1),
    );
    share(
        "pairs and triples: some right, none wrong",
        ">= 95 %",
        Share::of(arm("compound").map(|s| s.some_right_none_wrong)),
        &at_least(0.95),
    );
    share("pairs and triples: exactly those", "-", Share::of(arm("compound").map(|s| s.exact)), &|_| true);
    share(
        "no reference session for what needs one: wrong confident name",
        "<= 10 %",
        Share::of(arm("pooled").map(|s| s.wrong_confident)),
        &at_most(0.1),
    );
    share("effect in some sessions only: first name right", "-", Share::of(arm("contrast").map(named_right)), &|_| {
        true
    });
    share(
        "designs that cannot tell: wrong confident name",
        "<= 10 %",
        Share::of(arm("design").map(|s| s.wrong_confident)),
        &at_most(0.1),
    );
    let mut line = |family: Family, what: &str, target: &str, found: Option<Share>, met: &dyn Fn(f64) -> bool| {
        share(&format!("{}: {what}", family.name()), target, found, met);
    };
    for family in OTHERS {
        let here = || arm(OTHER_HULLS).filter(move |s| s.family == family.name() && reached(s));
        line(family, "false alarms on nulls", "<= 10 %", Share::of(here().map(|s| s.false_alarm)), &at_most(0.1));
        line(family, "detection at SNR 12", ">= 98 %", Share::of(here().map(|s| s.detected)), &at_least(0.98));
        line(
            family,
            "first name right, given detection",
            ">= 80 %",
            Share::of(here().map(|s| s.first_right)),
            &at_least(0.8),
        );
        line(family, "truth in the confidence set", ">= 90 %", Share::of(here().map(|s| s.in_set)), &at_least(0.9));
        line(family, "true size in the 90 % interval", "86 to 94 %", Share::of(here().map(|s| s.covered)), &calibrated);
    }
    for family in LOPSIDED {
        let here = || lopsided(scores, family);
        line(family, "her two sides said to differ", "-", Share::of(here().map(|s| s.sides_differ)), &|_| true);
        line(family, "of those, with the right sign of the flow's", "-", Share::of(here().map(right_side)), &|_| true);
        let covered = Share::of(here().map(|s| s.asymmetry_covered));
        line(family, "true asymmetry of the flow in the 90 % interval", "86 to 94 %", covered, &calibrated);
    }
    for (family, of) in [("hd", "nulls of the HD family"), ("mmg", "nulls of the MMG family")] {
        for way in &WAYS[1..] {
            let wrong = null(family).filter(|s| s.background != "euler").map(|s| (way.right)(s).map(|r| !r));
            share(&format!("false alarms, {of}: {}", way.name), "(baseline)", Share::of(wrong), &|_| true);
        }
    }
    for snr in [6.0, 12.0] {
        for way in &WAYS {
            let right = single(scores, None, snr).map(way.right);
            let target = if way.name == DIAGNOSIS { "-" } else { "(baseline)" };
            share(&format!("right name, seen or not, at SNR {snr}: {}", way.name), target, Share::of(right), &|_| true);
        }
    }
    let mut number = |what: &str, target: &str, found: Option<f64>, met: &dyn Fn(f64) -> bool| {
        let met = found.map(met);
        lines.push(Line { what: what.into(), target: target.into(), found: found.map(Found::Number), met });
    };
    for family in OTHERS {
        let sizes = arm(OTHER_HULLS).filter(|s| s.family == family.name() && reached(s)).filter_map(|s| s.size_error);
        number(&format!("{}: median error of the size", family.name()), "<= 0.10", median(sizes), &at_most(0.1));
    }
    for family in LOPSIDED {
        let here = || lopsided(scores, family);
        let error = |s: &Score| Some((s.asymmetry_found? - s.asymmetry?).abs());
        let what = |what: &str| format!("{}: median {what} of the flow at the rudder", family.name());
        number(&what("true asymmetry"), "-", median(here().filter_map(|s| s.asymmetry.map(f64::abs))), &|_| true);
        number(&what("error of the asymmetry"), "-", median(here().filter_map(error)), &|_| true);
    }
    number(
        "mean size of the confidence set at SNR 12",
        "<= 1.6",
        mean(twelve().filter_map(|s| s.set_size)),
        &at_most(1.6),
    );
    number(
        "mean window overlap (IoU) at SNR 12",
        ">= 0.8",
        mean(twelve().filter(|s| s.effects == "push").filter_map(|s| s.window_iou)),
        &at_least(0.8),
    );
    number(
        "median error of the size at SNR 12",
        "<= 0.10",
        median(twelve().filter_map(|s| s.size_error)),
        &at_most(0.1),
    );
    number(
        "median share of the held-out gap closed at SNR 12",
        ">= 0.90",
        median(twelve().filter_map(|s| s.gap_closed)),
        &at_least(0.9),
    );
    // The same cases in all four rows: those of which the oracle could be told.
    let compared = || twelve().filter(|s| s.oracle_held_out.is_some());
    for model in &MODELS {
        let what = format!("median held-out cVDM at SNR 12 [%]: {}", model.name);
        number(&what, model.target, median(compared().filter_map(model.score)), &|_| true);
    }
    number("median time of a diagnosis [s]", "<= 5", median(scores.iter().filter_map(|s| s.seconds)), &at_most(5.0));
    number("cases without a score", "0", Some((all.len() - scores.len()) as f64), &at_most(0.0));
    lines
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
        let targeted = line.target.starts_with(['<', '>', '0', '8', 'n']);
        let met = match line.met {
            Some(met) if targeted => {
                if met {
                    "yes"
                } else {
                    "no"
                }
            }
            _ => "",
        };
        table.row([line.what.as_str(), line.target.as_str(), found.as_str(), met]);
    }
    table
}

/// A share as a bar with its interval; nothing where no case says.
fn bar(share: Option<Share>) -> (f64, f64, f64) {
    share.map_or((f64::NAN, f64::NAN, f64::NAN), |s| (s.value(), s.low, s.high))
}

/// The asymmetry of the flow at the rudder, found against true.
fn sides(scores: &[Score]) -> Panel {
    let ends = [-0.18, 0.06];
    let mut panel = Panel::new(
        "single screw: asymmetry at the rudder",
        Axis::new("true [-]").range(ends[0], ends[1]),
        Axis::new("found [-]"),
    )
    .with(Layer::line("found is true", LIMIT, ends.map(|v| (v, v))));
    for (name, color, family) in SHOWN.into_iter().filter(|shown| LOPSIDED.contains(&shown.2)) {
        let points = lopsided(scores, family).filter_map(|s| Some((s.asymmetry?, s.asymmetry_found?)));
        panel = panel.with(Layer::scatter(name, color, points));
    }
    panel
}

/// Detection and first names against strength, both families, false alarms by background, other hulls, wrong names,
/// and the ship's own two sides.
pub fn figure(scores: &[Score]) -> Figure {
    let steps = [3.0, 6.0, 12.0, 24.0];
    let strength = || Axis::new("signal-to-noise ratio").log().range(2.5, 30.0);
    let curve = |name: &str, color: Color, family: &'static str, of: fn(&Score) -> Option<bool>| {
        let point = |snr: f64| {
            let s = Share::of(single(scores, Some(family), snr).map(of))?;
            Some((snr, s.value(), s.low, s.high))
        };
        let points: Vec<_> = steps.into_iter().filter_map(point).collect();
        let line = Layer::line(name, color, points.iter().map(|p| (p.0, p.1)));
        [line, Layer::errors(name, color, points).unlisted()]
    };
    let panel = |title: &str, of: fn(&Score) -> Option<bool>| {
        let mut panel = Panel::new(title, strength(), Axis::new("share of cases").range(0.0, 1.0));
        for (name, color, family) in [("HD truth", BLUE, "hd"), ("MMG truth", ORANGE, "mmg")] {
            panel = panel.with_all(curve(name, color, family, of));
        }
        panel
    };
    let names: BTreeSet<&str> = scores.iter().filter(|s| s.arm == "null").map(|s| s.background.as_str()).collect();
    let bars = |family: Option<&str>, right: fn(&Score) -> Option<bool>| -> Vec<(f64, f64, f64)> {
        let share = |name: &&str| {
            let here = scores.iter().filter(|s| s.arm == "null" && s.background == *name);
            let here = here.filter(|s| family.is_none_or(|f| s.family == f));
            bar(Share::of(here.map(|s| right(s).map(|r| !r))))
        };
        names.iter().map(share).collect()
    };
    let mut alarms = Panel::new(
        "false alarms on nulls",
        Axis::categories("background", names.iter().copied()),
        Axis::new("share of cases").range(0.0, 1.0),
    )
    .with(Layer::bars_with_intervals("HD truth", BLUE, bars(Some("hd"), named_right)))
    .with(Layer::bars_with_intervals("MMG truth", ORANGE, bars(Some("mmg"), named_right)));
    for way in &WAYS[1..] {
        let wrong = bars(None, way.right);
        if wrong.iter().any(|b| b.0.is_finite()) {
            alarms = alarms.with(Layer::bars_with_intervals(format!("{}, both", way.name), way.color, wrong));
        }
    }
    let alarms = alarms.with(Layer::h_line("target", LIMIT, 0.05));
    let sets = |snr: f64| single(scores, None, snr).map(|s| s.in_set);
    let set_points: Vec<_> =
        steps.into_iter().filter_map(|snr| Share::of(sets(snr)).map(|s| (snr, s.value(), s.low, s.high))).collect();
    let set = Panel::new("truth in the confidence set", strength(), Axis::new("share of cases").range(0.0, 1.0))
        .with(Layer::line("both families", GREEN, set_points.iter().map(|p| (p.0, p.1))))
        .with(Layer::errors("both families", GREEN, set_points).unlisted());
    let hulls = scores.iter().filter(|s| {
        s.arm == OTHER_HULLS || (matches!(s.arm.as_str(), "null" | "single") && s.snr_asked.is_none_or(|r| r == 12.0))
    });
    let hulls: Vec<&Score> = hulls.filter(|s| reached(s) && s.background != "euler").collect();
    let counted: [(&str, fn(&Score) -> Option<bool>); 4] = [
        ("false alarm", |s| s.false_alarm),
        ("seen", |s| s.detected),
        ("first right", |s| s.first_right),
        ("in the set", |s| s.in_set),
    ];
    let mut others = Panel::new(
        "ship A and other hulls, SNR 12",
        Axis::categories("", counted.iter().map(|c| c.0)),
        Axis::new("share of cases").range(0.0, 1.0),
    );
    for (name, color, family) in SHOWN {
        let of_hull = |(_, of): &(&str, fn(&Score) -> Option<bool>)| {
            bar(Share::of(hulls.iter().filter(|s| s.family == family.name()).map(|s| of(s))))
        };
        others = others.with(Layer::bars_with_intervals(name, color, counted.iter().map(of_hull).collect::<Vec<_>>()));
    }
    let silent: [(&str, &str, fn(&Score) -> Option<bool>); 4] = [
        ("not in the catalogue", "withheld", |s| s.wrong_confident),
        ("absorbed", "absorbed", |s| s.absorbed_named),
        ("no reference", "pooled", |s| s.wrong_confident),
        ("poor design", "design", |s| s.wrong_confident),
    ];
    let wrong = silent.map(|(_, arm, of)| bar(Share::of(scores.iter().filter(|s| s.arm == arm).map(of))));
    let wrong = Panel::new(
        "what cannot be told: wrong name all the same",
        Axis::categories("", silent.iter().map(|c| c.0)),
        Axis::new("share of cases").range(0.0, 1.0),
    )
    .with(Layer::bars_with_intervals("both families", GREEN, wrong.to_vec()))
    .with(Layer::h_line("target", LIMIT, 0.1));
    let mut ways =
        Panel::new("right name, seen or not, both families", strength(), Axis::new("share of cases").range(0.0, 1.0));
    for way in &WAYS {
        let at =
            |snr: f64| Share::of(single(scores, None, snr).map(way.right)).map(|s| (snr, s.value(), s.low, s.high));
        let points: Vec<_> = steps.into_iter().filter_map(at).collect();
        if points.is_empty() {
            continue;
        }
        ways = ways
            .with(Layer::line(way.name, way.color, points.iter().map(|p| (p.0, p.1))))
            .with(Layer::errors(way.name, way.color, points).unlisted());
    }
    let mut errors = Panel::new("error on unseen runs, median", strength(), Axis::new("cVDM [%]").including(0.0));
    for model in &MODELS {
        // The same cases for all: those of which the oracle could be told.
        let at = |snr: f64| {
            let cases = single(scores, None, snr).filter(|s| s.oracle_held_out.is_some());
            median(cases.filter_map(model.score)).map(|value| (snr, value))
        };
        errors = errors.with(Layer::line(model.name, model.color, steps.into_iter().filter_map(at)));
    }
    let figure = Figure::new("Concealed effects: what was found")
        .columns(3)
        .with(panel("something is missing: seen", |s| s.detected))
        .with(panel("first name right, given seen", |s| s.first_right))
        .with(set)
        .with(alarms)
        .with(others)
        .with(wrong)
        .with(ways);
    // A campaign without the oracle has no such panel.
    let figure = if scores.iter().any(|s| s.oracle_held_out.is_some()) { figure.with(errors) } else { figure };
    figure.with(sides(scores))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plan_has_over_800_cases_with_keys_and_seeds_of_their_own() {
        let all = plan(SEED);
        assert!(all.len() >= 800, "{}", all.len());
        let keys: BTreeSet<&str> = all.iter().map(|c| c.key.as_str()).collect();
        let seeds: BTreeSet<u64> = all.iter().map(|c| c.spec.seed).collect();
        assert_eq!((keys.len(), seeds.len()), (all.len(), all.len()));
        let mmg = all.iter().filter(|c| c.spec.family != Family::Hd).count() as f64 / all.len() as f64;
        assert!((0.4..0.6).contains(&mmg), "half the cases are of the other family: {mmg}");
        assert!(all.iter().all(|c| c.spec.entries().is_ok()));
    }

    #[test]
    fn the_slice_for_every_push_has_40_cases_of_all_arms() {
        let slice = ci_slice(&plan(SEED));
        let arms: BTreeSet<&str> = slice.iter().map(|c| c.arm).collect();
        let keys: BTreeSet<&str> = slice.iter().map(|c| c.key.as_str()).collect();
        assert_eq!((slice.len(), keys.len(), arms.len()), (40, 40, 9));
    }

    #[test]
    fn another_campaign_has_the_same_cases_with_other_seeds() {
        let (a, b) = (plan(1), plan(2));
        assert!(a.iter().zip(&b).all(|(a, b)| a.key == b.key && a.spec.seed != b.spec.seed));
    }

    #[test]
    fn the_summary_counts_what_applies_and_leaves_out_what_failed() {
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
        assert_eq!(counts("right name, seen or not, at SNR 12: diagnosis"), (1, 2));
        assert_eq!(counts("right name, seen or not, at SNR 12: iid BIC"), (0, 1));
        assert_eq!(counts("right name, seen or not, at SNR 12: sparse regression"), (0, 0));
        let of = |name: &str| find(&format!("median held-out cVDM at SNR 12 [%]: {name}"));
        assert_eq!(of("refit only, the paper's way"), Some(Found::Number(3.0)));
        assert_eq!((of("with what it named"), of("oracle")), (Some(Found::Number(2.0)), Some(Found::Number(1.0))));
        assert_eq!(find("cases without a score"), Some(Found::Number(1.0)));
    }
}
