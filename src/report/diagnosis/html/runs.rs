//! The first picture of the page: runs as recorded and as both models simulate them, one of them shown, the others to choose.
//! The numbers are thinned to what a screen shows; errors are taken from the proof.

use crate::diagnose::Diagnosis;
use crate::diagnose::answer::sailed::{MOST_RUNS, Sailed};
use crate::numerals::sig;
use crate::report::plot::{Axis, BASELINE, Color, FITTED, Figure, FigureError, Layer, Panel, RECORDED, east_north};
use crate::state::STATES;
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

/// The three series of every run: name, colour, dashes and width.
const SERIES: [(&str, Color, u8, f64); 3] =
    [("recorded", RECORDED, 0, 1.8), ("base model, refitted", BASELINE, 1, 1.8), ("improved model", FITTED, 0, 1.8)];

/// The numbers of the runs for the script of the page; nothing without a run.
pub(in crate::report::diagnosis) fn numbers(d: &Diagnosis) -> Option<Value> {
    let series: Vec<Value> = SERIES
        .iter()
        .map(|(name, c, dash, width)| {
            let color = format!("#{:02x}{:02x}{:02x}", c.r, c.g, c.b);
            json!({ "name": name, "color": color, "dash": dash, "width": width })
        })
        .collect();
    let runs: Vec<Value> = d.sailed.iter().map(|s| run(d, s)).collect();
    let hull = &d.base.ship.hull;
    let first = first(d)?;
    Some(json!({ "series": series, "runs": runs, "first": first, "length": hull.lpp, "breadth": hull.breadth }))
}

/// A number with as many digits as a screen can show.
fn short(v: f64) -> Option<f64> {
    v.is_finite().then(|| format!("{v:.5e}").parse().ok()).flatten()
}

fn run(d: &Diagnosis, s: &Sailed) -> Value {
    let columns = |states: &[[f64; STATES]]| -> Vec<Vec<Option<f64>>> {
        (0..STATES).map(|c| states.iter().map(|z| short(z[c])).collect()).collect()
    };
    let input = |i: usize| s.inputs.iter().map(|v| short(v[i])).collect::<Vec<_>>();
    json!({
        "name": s.run,
        "note": note(d, s),
        "t": s.time.iter().map(|t| short(*t)).collect::<Vec<_>>(),
        "z": [Some(columns(&s.recorded)), Some(columns(&s.base)), s.improved.as_deref().map(columns)],
        "n": input(0),
        "d": input(1),
    })
}

/// cVDM of a run in the proof, before and after.
fn errors(d: &Diagnosis, s: &Sailed) -> Option<[f64; 2]> {
    let h = d.held_out.as_ref()?;
    let i = h.runs_before.iter().position(|r| r.run == s.run)?;
    Some([h.runs_before[i].cvdm?, h.runs_after.get(i)?.cvdm?])
}

/// What a run is, and its errors.
fn note(d: &Diagnosis, s: &Sailed) -> String {
    let kind = if s.train { "a training run" } else { "unseen by every step of the analysis" };
    let session = if s.session.is_empty() { String::new() } else { format!(", session {}", s.session) };
    match (errors(d, s), &s.improved) {
        (Some([before, after]), Some(_)) => {
            format!("{kind}{session}; cVDM {} % → {} %", sig(before, 3), sig(after, 3))
        }
        (Some([before, _]), None) => format!("{kind}{session}; cVDM {} %", sig(before, 3)),
        (None, _) => format!("{kind}{session}"),
    }
}

/// The run that is shown first: the one with the median improvement, so that neither the best nor the worst stands for all.
fn first(d: &Diagnosis) -> Option<usize> {
    let gain = |s: &Sailed| errors(d, s).map_or(f64::NAN, |[b, a]| if s.improved.is_some() { a / b } else { b });
    let mut order: Vec<usize> = (0..d.sailed.len()).collect();
    order.sort_by(|a, b| gain(&d.sailed[*a]).total_cmp(&gain(&d.sailed[*b])));
    order.get(order.len() / 2).copied()
}

/// The picture: what the script draws, and before it the track alone for a reader without scripts; nothing without a run.
///
/// # Errors
/// As [`Figure::svg`].
pub(in crate::report::diagnosis) fn picture(d: &Diagnosis, all: usize) -> Result<Option<Markup>, FigureError> {
    let Some(s) = first(d).map(|i| &d.sailed[i]) else { return Ok(None) };
    let svg = track(s).svg()?;
    // Inside a page the element needs no name space, and its width follows from the style.
    let svg = svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    let which = if s.train { "training run" } else { "test run" };
    let of = if d.sailed.len() < all {
        format!(
            "On a screen {} of {all} {which}s can be chosen, at equal distances in their list (at most {MOST_RUNS}).",
            d.sailed.len()
        )
    } else if all == 1 {
        format!("It is the only {which}.")
    } else {
        format!("On a screen all {all} {which}s can be chosen.")
    };
    let models = if s.improved.is_some() {
        "the base model and the improved model simulate"
    } else {
        "the base model simulates"
    };
    Ok(Some(html! {
        figure {
            h3 { "Recorded and simulated" }
            div id="run-picture" { p { (s.run) ", " (note(d, s)) } (PreEscaped(svg)) }
            figcaption {
                "A " (which) " as recorded and as " (models) " it from its first sample on, without correction. The run shown first has "
                "the median " @if s.improved.is_some() { "improvement" } @else { "error" } ". " (of)
                span class="screen" { " Point at a curve for its values, draw a frame to zoom, click twice to see all again." }
            }
        }
    }))
}

/// The track of a run, recorded and simulated.
fn track(s: &Sailed) -> Figure {
    let points = |states: &[[f64; STATES]]| states.iter().map(|z| east_north(z[0], z[1])).collect::<Vec<_>>();
    let mut panel = Panel::new("", Axis::new("east y [m]"), Axis::new("north x [m]"))
        .with(Layer::line(SERIES[0].0, RECORDED, points(&s.recorded)))
        .with(Layer::line(SERIES[1].0, BASELINE, points(&s.base)).dashed());
    if let Some(improved) = &s.improved {
        panel = panel.with(Layer::line(SERIES[2].0, FITTED, points(improved)));
    }
    panel.equal_aspect = true;
    Figure::new("").panel_size(680, 560).with(panel)
}
