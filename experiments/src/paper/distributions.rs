//! Distributions of the errors over all runs: mean deviation of each dimension and cVDM, baselines beside the fit.
//! It makes no summary; the overall performance does.

use super::artefact::Artefact;
use super::case::Case;
use super::error::PaperError;
use super::scenarios::SHOWN;
use super::sheet::{Sheet, cell};
use std::path::Path;
use trimtab::evaluate::{Comparison, Outcome};
use trimtab::numerals::sig;
use trimtab::plot::{Axis, BASELINE, Color, FITTED, Figure, Layer, ORANGE, Panel};
use trimtab::recording::Split;
use trimtab::report::Table;
use trimtab::state::STATES;

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

/// Value below which a share of the sorted samples lies, by linear interpolation.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let position = share * last as f64;
    let (below, above) = (sorted[position.floor() as usize], sorted[position.ceil() as usize]);
    Some(below + (above - below) * position.fract())
}

fn make(cases: &[Case], out: &Path) -> Result<String, PaperError> {
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
        figure.save(&out.join(format!("distributions_{}", case.ship.name())))?;
    }
    sheet.save(out)?;
    Ok(format!("{table}\n"))
}

#[cfg(test)]
mod tests {
    use super::quantile;

    #[test]
    fn quantiles_interpolate_between_samples() {
        let sorted = [1.0, 2.0, 4.0, 8.0, 16.0];
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(|q| quantile(&sorted, q)), [Some(1.0), Some(2.0), Some(4.0), Some(16.0)]);
        assert_eq!(quantile(&sorted, 0.125), Some(1.5));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
