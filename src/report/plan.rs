//! A plan for people: its tables, its summary for a terminal, and the isolability matrix as a figure.
//! It converts units and computes nothing else.

use crate::diagnose::plan::{Outlook, Parting, Plan, Sailed};
use crate::numerals::{DASH, fixed, sig};
use crate::report::paragraph::wrapped;
#[cfg(feature = "plot")]
use crate::report::plot::{Axis, Figure, Layer, Mark, Panel, RECORDED};
use crate::report::table::Table;
use crate::report::width::width;

/// Width of the terminal summary \[characters\].
const WIDTH: u16 = 100;

/// The trials, a row for each.
pub fn trials_table(plan: &Plan) -> Table {
    let mut table =
        Table::new(["trial", "kind", "course [deg]", "speed [m/s]", "session", "minutes", "samples", "complete"]);
    for t in &plan.trials {
        let complete = if t.complete { "yes" } else { "no" };
        table.row([
            t.name.clone(),
            t.kind.word().into(),
            t.heading_deg.to_string(),
            sig(t.speed, 3),
            t.session.clone(),
            fixed(t.minutes, 1),
            t.samples.to_string(),
            complete.into(),
        ]);
    }
    table
}

/// The mechanisms, a row for each: what is seen of them, and from which size on.
pub fn detectable_table(plan: &Plan) -> Table {
    let mut table = Table::new(["mechanism", "identifiable", "share left", "smallest size", "unit", "title"]);
    for m in &plan.mechanisms {
        table.row([
            m.mechanism.clone(),
            seen(m).into(),
            fixed(m.retained, 3),
            m.size.map_or_else(|| DASH.into(), |size| sig(size, 2)),
            m.unit.clone().unwrap_or_default(),
            m.title.clone(),
        ]);
    }
    table
}

fn seen(m: &Outlook) -> &'static str {
    match (m.identifiable, m.between_sessions) {
        (false, _) => "no",
        (true, true) => "between sessions",
        (true, false) => "yes",
    }
}

/// The isolability matrix: a row for each mechanism, a column for each mechanism.
pub fn isolability_table(plan: &Plan) -> Table {
    let names = &plan.isolability.mechanisms;
    let mut table = Table::new(std::iter::once("mechanism").chain(names.iter().map(String::as_str)));
    for (name, shares) in names.iter().zip(&plan.isolability.share) {
        table.row(std::iter::once(name.clone()).chain(shares.iter().map(|s| fixed(*s, 4))));
    }
    table
}

/// The plan for a terminal.
#[must_use]
pub fn summary(plan: &Plan) -> String {
    let mut text = line(&programme(plan)) + &line(&sensors(plan)) + "\n" + &grouped(&plan.trials).to_string();
    text += "\n\nSMALLEST SIZES, seen in 80 % of such programmes\n";
    let mut sizes = Table::new(["mechanism", "smallest size", "unit", "share left", "title"]);
    for m in plan.mechanisms.iter().filter(|m| m.identifiable) {
        let note = if m.between_sessions { "; as a difference between sessions" } else { "" };
        sizes.row([
            m.mechanism.clone(),
            m.size.map_or_else(|| DASH.into(), |size| sig(size, 2)),
            m.unit.clone().unwrap_or_default(),
            fixed(m.retained, 3),
            format!("{}{note}", m.title),
        ]);
    }
    text += &sizes.wrapped(WIDTH).to_string();
    text += "\n\n";
    let hidden: Vec<&Outlook> = plan.mechanisms.iter().filter(|m| !m.identifiable).collect();
    for reason in reasons(&hidden) {
        let names: Vec<&str> =
            hidden.iter().filter(|m| m.absorbed_by.as_deref() == Some(reason)).map(|m| m.mechanism.as_str()).collect();
        text += &line(&format!("NOT IDENTIFIABLE, absorbed by {reason}: {}.", names.join(", ")));
    }
    text += &line(&inseparable(plan));
    if let Some(parting) = &plan.parting {
        text += &line(&parted(parting));
    }
    text
}

/// The different reasons why mechanisms are hidden.
fn reasons<'a>(hidden: &[&'a Outlook]) -> Vec<&'a str> {
    let mut out: Vec<&str> = hidden.iter().filter_map(|m| m.absorbed_by.as_deref()).collect();
    out.sort_unstable();
    out.dedup();
    out
}

fn programme(plan: &Plan) -> String {
    let identifiable = plan.mechanisms.iter().filter(|m| m.identifiable).count();
    format!(
        "{} trials of {} minutes in all, approaches not counted: {identifiable} of {} mechanisms of the catalogue are identifiable.",
        plan.trials.len(),
        fixed(plan.minutes, 0),
        plan.mechanisms.len(),
    )
}

fn sensors(plan: &Plan) -> String {
    let n = &plan.noise;
    let without: Vec<String> = n.without.iter().map(|s| format!("{s:?}").to_lowercase()).collect();
    let missing = if without.is_empty() { String::new() } else { format!("; not on board: {}", without.join(", ")) };
    format!(
        "Sensors (standard deviations): position {} m, heading {} deg, speed {} m/s, yaw rate {} deg/s, every {} s{missing}. \
         Unknown force: {} N ahead, {} N across, {} N m, correlated over {} s. Chance of a false name: {}.",
        sig(n.position, 2),
        sig(n.heading.to_degrees(), 2),
        sig(n.speed, 2),
        sig(n.yaw_rate.to_degrees(), 2),
        sig(n.step, 2),
        sig(n.force[0], 2),
        sig(n.force[1], 2),
        sig(n.force[2], 2),
        sig(n.force_time, 2),
        sig(plan.alpha, 2),
    )
}

/// The trials, those on several courses in one row.
fn grouped(trials: &[Sailed]) -> Table {
    let mut table = Table::new(["trial", "courses [deg]", "sailed", "minutes in all"]);
    let stem = |t: &Sailed| t.name.split(", course").next().unwrap_or_default().to_owned();
    for group in trials.chunk_by(|a, b| stem(a) == stem(b)) {
        let mut courses: Vec<String> = group.iter().map(|t| t.heading_deg.to_string()).collect();
        courses.dedup();
        let note = if group.iter().all(|t| t.complete) { "" } else { " (cut off)" };
        let minutes: f64 = group.iter().map(|t| t.minutes).sum();
        table.row([stem(&group[0]) + note, courses.join(", "), group.len().to_string(), fixed(minutes, 1)]);
    }
    table.wrapped(WIDTH)
}

/// Mechanisms that cannot be distinguished.
fn inseparable(plan: &Plan) -> String {
    let i = &plan.isolability;
    let limit = fixed(100.0 * i.tolerance, 0);
    if i.classes.is_empty() {
        return format!(
            "CANNOT BE DISTINGUISHED: none; no mechanism takes over more than {limit} % of the gain of another."
        );
    }
    let class = |c: &Vec<String>| c.join(" / ");
    let classes: Vec<String> = i.classes.iter().map(class).collect();
    format!(
        "CANNOT BE DISTINGUISHED by these trials (one takes over more than {limit} % of the gain of another): {}. `--part A,B` \
         looks for trials that distinguish two of them.",
        classes.join("; ")
    )
}

/// The trials that distinguish the pair.
fn parted(p: &Parting) -> String {
    let (a, b, share) = (&p.pair.a, &p.pair.b, fixed(100.0 * p.pair.share, 0));
    let (minutes, trials) = (fixed(p.minutes, 1), p.trials.join("; "));
    let limit = fixed(100.0 * p.tolerance, 0);
    if p.parted {
        return format!(
            "TO DISTINGUISH {a} and {b}: {minutes} minutes, {share} % of the gain is taken over (at most {limit} % allowed): {trials}. Chosen \
             one by one out of {} trials, what is not needed removed; a cheaper set is possible.",
            p.of
        );
    }
    if p.trials.is_empty() {
        let hidden = p.unidentifiable.join(" and ");
        return format!(
            "TO DISTINGUISH {a} and {b}: none of {} trials adds to what is known of {hidden}, alone or together.",
            p.of
        );
    }
    let hidden = if p.unidentifiable.is_empty() {
        format!("{share} % of the gain is taken over, more than the {limit} % allowed")
    } else {
        format!("they do not identify {}", p.unidentifiable.join(" and "))
    };
    format!(
        "TO DISTINGUISH {a} and {b}: no set found out of {} trials. The best ({minutes} minutes): {trials}; {hidden}.",
        p.of
    )
}

/// A paragraph of the plan.
fn line(paragraph: &str) -> String {
    wrapped("", 0, width().min(WIDTH.into()), paragraph)
}

/// The isolability matrix as a heat map.
#[cfg(feature = "plot")]
pub fn isolability_figure(plan: &Plan) -> Figure {
    let i = &plan.isolability;
    let map = Mark::Heatmap { values: i.share.clone(), range: Some((0.0, 1.0)), annotate: true };
    let axis = || Axis::categories("", i.mechanisms.iter().cloned());
    let side = 54 * i.mechanisms.len().max(4) as u32;
    Figure::new("Share of the gain of a mechanism that another takes over")
        .panel_size(420 + side, 280 + side)
        .caption(
            "Share of the gain in log-likelihood of the mechanism of a row that the mechanism of a column takes over on these trials: 1 for \
             two that they do not distinguish.",
        )
        .with(Panel::new("", axis(), axis()).with(Layer::new("share taken over", RECORDED, map)))
}
