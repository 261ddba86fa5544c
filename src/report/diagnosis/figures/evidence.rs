//! Figures of the evidence: which mechanism explains the data, and which ones are similar in their effects.
//! The statistics are the diagnosis's own.

use super::picture::{Picture, shown};
use crate::diagnose::Diagnosis;
use crate::diagnose::answer::diagnosis::Ranked;
use crate::report::diagnosis::names::title_of;
use crate::report::plot::{
    Axis, Color, FITTED, Figure, GREEN, GREY, LIMIT, Layer, Mark, ORANGE, PURPLE, Panel, RECORDED, SKY,
};
use statrs::distribution::{ContinuousCDF, Normal};

/// Mechanisms in the figure of the ranking, and in that of similarity.
const RANKED: usize = 18;
const COMPARED: usize = 14;

/// Evidence in standard errors: the two-sided normal quantile of a corrected p-value.
fn evidence(r: &Ranked) -> f64 {
    match Normal::new(0.0, 1.0) {
        Ok(normal) if r.p > 1e-300 => -normal.inverse_cdf((0.5 * r.p).min(0.5)),
        // Beyond the smallest number the root of the statistic is as good.
        _ => r.statistic.max(0.0).sqrt(),
    }
}

/// The outcome of a test, in words and as a colour.
const OUTCOMES: [(&str, Color); 6] = [
    ("found", FITTED),
    ("not distinguishable from a finding", SKY),
    ("impossible sign", ORANGE),
    ("the ship's own forces can explain it", PURPLE),
    ("explains the data less well", GREEN),
    ("not significant", GREY),
];

/// Which of [`OUTCOMES`] a mechanism had.
fn outcome(d: &Diagnosis, r: &Ranked) -> usize {
    let m = &r.mechanism;
    if d.findings.iter().any(|f| f.mechanism == *m) {
        0
    } else if d.findings.iter().any(|f| f.confidence_set.contains(m)) {
        1
    } else if r.p >= d.settings.alpha {
        5
    } else if !r.admissible {
        2
    } else if r.second_opinion >= 0.01 {
        3
    } else {
        4
    }
}

/// Evidence for each mechanism, the strongest first.
pub(in crate::report::diagnosis) fn ranking(d: &Diagnosis) -> Option<Picture> {
    if d.ranking.is_empty() {
        return None;
    }
    let mut rows: Vec<&Ranked> = d.ranking.iter().collect();
    rows.sort_by(|a, b| evidence(b).total_cmp(&evidence(a)));
    rows.truncate(RANKED);
    let labels = rows.iter().map(|r| match r.sessions.len() {
        0 => r.title.clone(),
        _ if r.by_session => format!("{} (each session its own)", r.title),
        _ => format!("{} ({})", r.title, r.sessions.join(", ")),
    });
    let mut panel = Panel::new(
        "",
        Axis::new("evidence, corrected for the number of tests [standard errors]").including(0.0),
        Axis::categories("", labels),
    );
    for (i, (name, color)) in OUTCOMES.into_iter().enumerate() {
        let own = rows.iter().enumerate().filter(|(_, r)| outcome(d, r) == i);
        let own: Vec<(f64, f64)> = own.map(|(row, r)| (evidence(r).max(0.0), row as f64)).collect();
        if own.is_empty() {
            continue;
        }
        let stems = own.iter().flat_map(|(x, y)| [(0.0, *y), (*x, *y), (f64::NAN, f64::NAN)]);
        panel = panel.with(Layer::line(name, color, stems).unlisted().width(7.0));
        panel = panel.with(Layer::scatter(name, color, own.iter().copied()));
    }
    let threshold = Normal::new(0.0, 1.0).map_or(1.96, |n| -n.inverse_cdf(0.5 * d.settings.alpha));
    let limit = format!("can be named (alpha {})", d.settings.alpha);
    Some(Picture {
        stem: "ranking",
        part: "VERDICT",
        caption: "Evidence for each mechanism, tested one at a time in the base model and corrected for how many were tested. Only a \
                  mechanism beyond the dashed line can be named."
            .to_owned()
            + &shown(rows.len(), d.ranking.len(), "mechanisms, those with the strongest evidence,"),
        figure: Figure::new("Which mechanism explains the data?")
            .panel_size(1240, 150 + 42 * rows.len() as u32)
            .with(panel.with(Layer::v_line(limit, LIMIT, threshold).dashed())),
    })
}

/// Similarity of the mechanisms with the strongest evidence, as far as they are in a pair at all.
pub(in crate::report::diagnosis) fn confusability(d: &Diagnosis) -> Option<Picture> {
    if d.confusable.is_empty() {
        return None;
    }
    let paired = |m: &str| d.confusable.iter().any(|c| c.a == m || c.b == m);
    let mut names: Vec<&str> = d.ranking.iter().map(|r| r.mechanism.as_str()).filter(|m| paired(m)).collect();
    let all = names.len();
    names.truncate(COMPARED);
    let between = |a: &str, b: &str| {
        if a == b {
            return 1.0;
        }
        let pair = d.confusable.iter().find(|c| (c.a == a && c.b == b) || (c.a == b && c.b == a));
        pair.map_or(f64::NAN, |c| (c.cosine * 100.0).round() / 100.0)
    };
    let values: Vec<Vec<f64>> = names.iter().map(|a| names.iter().map(|b| between(a, b)).collect()).collect();
    let map = Mark::Heatmap { values, range: Some((0.5, 1.0)), annotate: true };
    let numbered = || names.iter().enumerate().map(|(i, m)| (i + 1, title_of(&d.model, m)));
    let short = Axis::categories("", numbered().map(|(number, _)| number.to_string()));
    let long = Axis::categories("", numbered().map(|(number, title)| format!("{title}  {number}")));
    let side = 60 * names.len() as u32;
    Some(Picture {
        stem: "confusability",
        part: "VERDICT",
        caption: "Mechanisms with similar effects on these data: those at 1 cannot be distinguished, those below 0.7 (blank) easily."
            .to_owned()
            + &shown(names.len(), all, "mechanisms that are similar to another, those with the strongest evidence,"),
        figure: Figure::new("Similarity of mechanisms on these data")
            .panel_size(560 + side, 260 + side)
            .with(Panel::new("", short, long).with(Layer::new("similarity (cosine)", RECORDED, map))),
    })
}
