//! Table 2 of the paper: fitted parameters with 95 % intervals, beside both baselines, the initial guess and the paper's p*.
//! The paper's p* belongs to ships that are not ours: it stands beside, it is no target.

use super::case::Case;
use super::sheet::{cell, save};
use super::{Artefact, PaperError};
use std::fmt::Write;
use std::path::Path;
use trimtab::fit::Fit;
use trimtab::model::ELEVEN;
use trimtab::numerals::{DASH, sig};
use trimtab::plot::{Axis, BASELINE, FITTED, Figure, GREEN, GREY, Layer, Marker, ORANGE, PURPLE, Panel};
use trimtab::report::Table;

/// Table 2.
pub static TABLE2: Artefact = Artefact {
    name: "table2",
    about: "Table 2: parameters: baselines p~, initial guess, the paper's p*, and ours with 95 % intervals",
    make,
};

/// Value and 95 % interval of each of the eleven, in their order. An interval is absent where the data do not determine it.
pub fn estimates(fit: &Fit) -> Vec<(&'static str, &'static str, f64, Option<[f64; 2]>)> {
    ELEVEN
        .iter()
        .filter_map(|name| fit.estimates.iter().find(|e| e.name == *name))
        .map(|e| (e.symbol, e.unit, e.value, e.interval))
        .collect()
}

fn make(cases: &[Case], out: &Path) -> Result<String, PaperError> {
    let mut text = String::new();
    let mut rows = Vec::new();
    for case in cases {
        let published = &case.published;
        let captive = case.captive_baseline.eleven();
        let mut table =
            Table::new(["", "unit", "p~ paper", "p~ captive", "guess", "p* paper", "p* ours", "95 % interval"]);
        let mut figure = Figure::new(format!("{}: parameters (Table 2)", case.label())).columns(4).panel_size(720, 430);
        for (i, (symbol, unit, value, interval)) in estimates(&case.fit).into_iter().enumerate() {
            // A parameter on a limit is off it by what the solver tolerates.
            let least = 1e-6 * case.fit.model.parameters[case.fit.model.find(symbol)?].scale;
            let show = |v: f64| sig(if v.abs() < least { 0.0 } else { v }, 4);
            let ends = match interval {
                None => DASH.to_owned(),
                Some([lo, hi]) if lo == hi => "held by constraints".to_owned(),
                Some([lo, hi]) => trimtab::numerals::interval(lo, hi, 4),
            };
            table.row([
                symbol.to_owned(),
                unit.to_owned(),
                show(published.baseline[i]),
                show(captive[i]),
                show(published.initial[i]),
                show(published.fitted[i]),
                show(value),
                ends,
            ]);
            rows.push([
                case.ship.name().to_owned(),
                symbol.to_owned(),
                unit.to_owned(),
                cell(published.baseline[i]),
                cell(captive[i]),
                cell(published.initial[i]),
                cell(published.fitted[i]),
                cell(value),
                cell(interval.map(|[lo, _]| lo)),
                cell(interval.map(|[_, hi]| hi)),
            ]);
            let label = if unit == "-" { symbol.to_owned() } else { format!("{symbol} [{unit}]") };
            let slots = ["p~", "captive", "guess", "p*", "ours"];
            let [lo, hi] = interval.unwrap_or([value, value]);
            figure = figure.with(
                Panel::new("", Axis::categories("", slots), Axis::new(label).including(0.0))
                    .with(Layer::h_line("zero", GREY, 0.0).unlisted().dotted())
                    .with(Layer::scatter("baseline p~, paper", BASELINE, [(0.0, published.baseline[i])]))
                    .with(
                        Layer::scatter("baseline from captive tests", ORANGE, [(1.0, captive[i])])
                            .marker(Marker::Square),
                    )
                    .with(
                        Layer::scatter("initial guess, paper", GREEN, [(2.0, published.initial[i])])
                            .marker(Marker::Triangle),
                    )
                    .with(
                        Layer::scatter("p*, paper (its own ships)", PURPLE, [(3.0, published.fitted[i])])
                            .marker(Marker::Diamond),
                    )
                    .with(Layer::errors("p*, ours, with 95 % interval", FITTED, [(4.0, value, lo, hi)])),
            );
        }
        figure.save(&out.join(format!("table2_{}", case.ship.name())))?;
        let _ = writeln!(text, "{}: {}\n{table}", case.label(), case.fit.status);
        let _ = writeln!(text, "Held back by {}.", list(&case.fit));
        let effect = case.fit.design_effect.map_or(DASH.to_owned(), |e| sig(e, 3));
        let _ = writeln!(
            text,
            "Intervals take runs as independent, not residuals: {effect} times the variance of independent residuals.\n"
        );
    }
    let header =
        ["ship", "symbol", "unit", "baseline_paper", "baseline_captive", "guess", "fitted_paper", "fitted", "lo", "hi"];
    save(out, "table2_values", header, rows)?;
    Ok(text)
}

fn list(fit: &Fit) -> String {
    if fit.active.is_empty() {
        return "no constraint".into();
    }
    fit.active.iter().map(|a| a.sentence.as_str()).collect::<Vec<_>>().join("; ")
}
