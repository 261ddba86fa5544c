//! Table 2 of the paper: fitted parameters with 95 % intervals, beside both baselines, the initial guess and the paper's p*.
//! The paper's p* belongs to other ships: it is a comparison, not a target.

use crate::paper::artefact::Artefact;
use crate::paper::case::Case;
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;
use std::fmt::Write;
use trimtab::fit::Fit;
use trimtab::model::ELEVEN;
use trimtab::numbers::numerals::{DASH, sig};
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BASELINE, FITTED, Figure, GREEN, GREY, Layer, Marker, ORANGE, PURPLE, Panel};

/// Table 2.
pub static TABLE2: Artefact = Artefact {
    name: "table2",
    about: "Table 2: parameters: baselines p~, initial guess, the paper's p*, and ours with 95 % intervals",
    make,
};

/// Symbol, unit, value and 95 % interval of a parameter.
type Estimate = (&'static str, &'static str, f64, Option<[f64; 2]>);

/// The estimates of the eleven, in their order. An interval is absent where the data do not determine it.
fn estimates(fit: &Fit) -> Vec<Estimate> {
    ELEVEN
        .iter()
        .filter_map(|name| fit.estimates.iter().find(|e| e.name == *name))
        .map(|e| (e.symbol, e.unit, e.value, e.interval))
        .collect()
}

/// The values of one parameter and our 95 % interval.
struct Row {
    symbol: &'static str,
    unit: &'static str,
    baseline: f64,
    captive: f64,
    guess: f64,
    paper: f64,
    ours: f64,
    interval: Option<[f64; 2]>,
}

fn rows(case: &Case) -> Vec<Row> {
    let (published, captive) = (&case.published, case.captive_baseline.eleven());
    let row = |(i, (symbol, unit, ours, interval)): (usize, Estimate)| Row {
        symbol,
        unit,
        baseline: published.baseline[i],
        captive: captive[i],
        guess: published.initial[i],
        paper: published.fitted[i],
        ours,
        interval,
    };
    estimates(&case.fit).into_iter().enumerate().map(row).collect()
}

impl Row {
    /// The line of the printed table; `least` is the size below which the solver's tolerance makes a number zero.
    fn printed(&self, least: f64) -> [String; 8] {
        let show = |v: f64| sig(if v.abs() < least { 0.0 } else { v }, 4);
        let ends = match self.interval {
            None => DASH.to_owned(),
            Some([lo, hi]) if lo == hi => "fixed by constraints".to_owned(),
            Some([lo, hi]) => trimtab::numbers::numerals::interval(lo, hi, 4),
        };
        let [a, b, c, d, e] = [self.baseline, self.captive, self.guess, self.paper, self.ours].map(show);
        [self.symbol.to_owned(), self.unit.to_owned(), a, b, c, d, e, ends]
    }

    fn panel(&self) -> Panel {
        let Self { symbol, unit, .. } = self;
        let label = if *unit == "-" { (*symbol).to_owned() } else { format!("{symbol} [{unit}]") };
        let [lo, hi] = self.interval.unwrap_or([self.ours; 2]);
        let point = |name: &str, color, x: f64, y: f64| Layer::scatter(name, color, [(x, y)]);
        Panel::new("", Axis::categories("", ["p~", "captive", "guess", "p*", "ours"]), Axis::new(label).including(0.0))
            .with(Layer::h_line("zero", GREY, 0.0).unlisted().dotted())
            .with(point("baseline p~, paper", BASELINE, 0.0, self.baseline))
            .with(point("baseline from captive tests", ORANGE, 1.0, self.captive).marker(Marker::Square))
            .with(point("initial guess, paper", GREEN, 2.0, self.guess).marker(Marker::Triangle))
            .with(point("p*, paper (its own ships)", PURPLE, 3.0, self.paper).marker(Marker::Diamond))
            .with(Layer::errors("p*, ours, with 95 % interval", FITTED, [(4.0, self.ours, lo, hi)]))
    }
}

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut text = String::new();
    let header =
        ["ship", "symbol", "unit", "baseline_paper", "baseline_captive", "guess", "fitted_paper", "fitted", "lo", "hi"];
    let mut sheet = Sheet::new("table2_values", header);
    for case in cases {
        let mut table =
            Table::new(["", "unit", "p~ paper", "p~ captive", "guess", "p* paper", "p* ours", "95 % interval"]);
        let mut figure = Figure::new(format!("{}: parameters (Table 2)", case.label())).columns(4).panel_size(720, 430);
        for row in rows(case) {
            // A parameter on a limit is off it by the solver's tolerance.
            table.row(row.printed(1e-6 * case.fit.model.parameters[case.fit.model.find(row.symbol)?].scale));
            let [lo, hi] = [row.interval.map(|i| i[0]), row.interval.map(|i| i[1])].map(cell);
            let [a, b, c, d, e] = [row.baseline, row.captive, row.guess, row.paper, row.ours].map(cell);
            let [ship, symbol, unit] = [case.ship.name(), row.symbol, row.unit].map(str::to_owned);
            sheet.row([ship, symbol, unit, a, b, c, d, e, lo, hi]);
            figure = figure.with(row.panel());
        }
        to.figure(&format!("table2_{}", case.ship.name()), figure)?;
        to.table(&format!("table2_{}", case.ship.name()), &table)?;
        let _ = writeln!(text, "{}: {}\n{table}", case.label(), case.fit.status);
        let _ = writeln!(text, "Active constraints: {}.", list(&case.fit));
        let effect = case.fit.design_effect.map_or(DASH.to_owned(), |e| sig(e, 3));
        let _ = writeln!(
            text,
            "Intervals take runs as independent, not residuals: {effect} times the variance of independent residuals.\n"
        );
    }
    sheet.save(&to.folder)?;
    Ok(text)
}

fn list(fit: &Fit) -> String {
    if fit.active.is_empty() {
        return "none".into();
    }
    fit.active.iter().map(|a| a.sentence.as_str()).collect::<Vec<_>>().join("; ")
}
