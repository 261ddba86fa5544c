//! Distributions of the errors over all runs: mean deviation of each dimension and cVDM, baselines beside the fit.
//! It makes no summary; the overall performance does.

use super::scenarios::SHOWN;
use crate::paper::artefact::Artefact;
use crate::paper::case::Case;
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;
use trimtab::evaluate::{Comparison, Outcome};
use trimtab::numbers::numerals::sig;
use trimtab::numbers::statistics::quantile;
use trimtab::recording::Split;
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BASELINE, Color, FITTED, Figure, Layer, ORANGE, Panel};
use trimtab::ship::state::STATES;

/// Error distributions.
pub static DISTRIBUTIONS: Artefact = Artefact {
    name: "distributions",
    about: "Distributions of the errors over all runs: MD of each dimension, and cVDM",
    make,
};

/// Which of the two outcomes of a comparison.
type Which = fn(&Comparison) -> &Outcome;
/// A quantity of a run's outcome; absent where the simulation diverged.
type Quantity = Box<dyn Fn(&Outcome) -> Option<f64>>;

fn quantities() -> Vec<(String, Quantity)> {
    let md = (0..STATES).map(|i| {
        let (label, factor) = SHOWN[i];
        let value: Quantity = Box::new(move |o| Some(o.deviation()?.md[i]? * factor));
        (format!("MD of {label}"), value)
    });
    let cvdm: Quantity = Box::new(|o| Some(o.deviation()?.cvdm));
    md.chain([("cVDM [%]".to_owned(), cvdm)]).collect()
}

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut table = Table::new(["ship", "part", "quantity", "model", "quarter", "median", "three quarters", "worst"]);
    let header = ["ship", "part", "quantity", "model", "quarter", "median", "three_quarters", "worst", "runs"];
    let mut sheet = Sheet::new("distributions_values", header);
    for case in cases {
        let [published, captive] = case.baselines().map(|(model, _)| case.evaluate(model).trajectories);
        let models: [(&str, Color, &[Comparison], Which); 3] = [
            ("baseline, published p~", BASELINE, &published, |c| &c.baseline),
            ("baseline, captive tests", ORANGE, &captive, |c| &c.baseline),
            ("fitted", FITTED, &published, |c| &c.fitted),
        ];
        let mut figure = Figure::new(format!("{}: errors over all runs", case.label())).columns(4).panel_size(620, 560);
        for (label, value) in quantities() {
            let mut panel = Panel::new("", Axis::categories("", ["train", "test"]), Axis::new(&label).log());
            for (name, color, comparisons, outcome) in models {
                let mut samples = Vec::new();
                for (split, part) in [(Split::Train, "train"), (Split::Test, "test")] {
                    let all = comparisons.iter().filter(|c| c.split == split);
                    let mut values: Vec<f64> = all.filter_map(|c| value(outcome(c))).collect();
                    values.sort_by(f64::total_cmp);
                    let summary = [0.25, 0.5, 0.75, 1.0].map(|share| quantile(&values, share));
                    if part == "test" && (label.starts_with("cVDM")) {
                        let shown = summary.map(|v| sig(v.unwrap_or(f64::NAN), 3));
                        table.row([case.label(), part, &label, name].map(str::to_owned).into_iter().chain(shown));
                    }
                    let [quarter, median, three, worst] = summary.map(cell);
                    sheet.row([
                        case.ship.name().to_owned(),
                        part.to_owned(),
                        label.clone(),
                        name.to_owned(),
                        quarter,
                        median,
                        three,
                        worst,
                        values.len().to_string(),
                    ]);
                    samples.push(values);
                }
                panel = panel.with(Layer::boxes(name, color, samples));
            }
            figure = figure.with(panel);
        }
        to.figure(&format!("distributions_{}", case.ship.name()), figure)?;
    }
    sheet.save(&to.folder)?;
    to.table("distributions", &table)?;
    Ok(format!("{table}\n"))
}
