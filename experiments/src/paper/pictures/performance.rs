//! Overall performance: mARI, cVDM improvement and consistency of the fit against both baselines, beside the paper's.
//! It also measures the error of the integration itself; single runs are in other files.

use crate::paper::artefact::Artefact;
use crate::paper::case::Case;
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;
use std::fmt::Write;
use trimtab::evaluate::{Estimate, EvaluationSettings, Judging, Summary, predict, prove};
use trimtab::model::Model;
use trimtab::numbers::numerals::{DASH, fixed};
use trimtab::recording::{Run, Split, measured};
use trimtab::report::Table;
use trimtab::report::plot::{Axis, FITTED, Figure, GREY, Layer, Panel};
use trimtab::ship::state::{STATE_NAMES, STATE_UNITS};
use trimtab::simulate::{Integration, Method};

/// Overall performance.
pub static PERFORMANCE: Artefact = Artefact {
    name: "performance",
    about: "Overall performance on the test runs: mARI, cVDM improvement and consistency, with 95 % intervals",
    make,
};

/// Sub-steps of the RK4 that Euler's own error is measured against.
const AUDIT: Integration = Integration { method: Method::Rk4, substeps: 8 };

/// A number in per cent with its interval.
fn percent(estimate: Option<Estimate>) -> String {
    let Some(estimate) = estimate else { return DASH.into() };
    let ends = estimate
        .ci95
        .map_or(String::new(), |[lo, hi]| format!(" [{}, {}]", fixed(100.0 * lo, 1), fixed(100.0 * hi, 1)));
    format!("{}{ends}", fixed(100.0 * estimate.value, 1))
}

/// The three measures as bars, ours and the paper's, on the test runs.
#[derive(Default)]
struct Bars {
    groups: Vec<String>,
    ours: [Vec<(f64, f64, f64)>; 3],
    paper: [Vec<f64>; 3],
}

impl Bars {
    fn add(&mut self, group: String, metrics: &[Metric; 3]) {
        self.groups.push(group);
        for (i, (_, estimate, printed)) in metrics.iter().enumerate() {
            let value = estimate.map_or(f64::NAN, |e| e.value);
            let [lo, hi] = estimate.and_then(|e| e.ci95).unwrap_or([value; 2]);
            self.ours[i].push((100.0 * value, 100.0 * lo, 100.0 * hi));
            self.paper[i].push(100.0 * printed.unwrap_or(f64::NAN));
        }
    }

    fn figure(&self) -> Figure {
        let titles = ["mARI", "improvement of mean cVDM", "consistency 1 - Var*/Var~"];
        let panels = titles.into_iter().enumerate().map(|(i, title)| {
            Panel::new(title, Axis::categories("", self.groups.clone()), Axis::new("[%]").including(0.0))
                .with(Layer::bars_with_intervals("ours, 95 % interval over runs", FITTED, self.ours[i].clone()))
                .with(Layer::bars("paper (its own ships and baseline)", GREY, self.paper[i].clone()))
        });
        Figure::new("What the fit gains on each baseline, test runs").columns(3).panel_size(1000, 640).with_all(panels)
    }
}

/// A measure: name, ours, the paper's.
type Metric = (&'static str, Option<Estimate>, Option<f64>);

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut table = Table::new([
        "ship",
        "part",
        "baseline",
        "cVDM~ [%]",
        "cVDM* [%]",
        "mARI [%]",
        "paper",
        "cVDM gain [%]",
        "paper",
        "consistency [%]",
        "paper",
        "better",
    ]);
    let header = ["ship", "baseline", "part", "quantity", "unit", "value", "lo", "hi", "paper"];
    let mut sheet = Sheet::new("performance_values", header);
    let mut bars = Bars::default();
    let mut text = String::new();
    for case in cases {
        for (baseline, name) in case.baselines() {
            let evaluation = case.evaluate(baseline);
            for part in ["test", "train"] {
                let empty = PaperError::Empty { ship: case.ship.name(), what: "runs in one part of the split" };
                let summary = evaluation.summary(part).ok_or(empty)?;
                // The paper's figures are of its test runs.
                let printed = |value: f64| (part == "test").then_some(value);
                let metrics: [Metric; 3] = [
                    ("mARI", summary.mari, printed(case.published.mari)),
                    ("cVDM improvement", summary.cvdm_improvement, printed(case.published.cvdm_improvement)),
                    ("consistency", summary.consistency, printed(case.published.consistency)),
                ];
                if part == "test" {
                    bars.add(format!("{}: {name}", &case.label()[5..]), &metrics);
                }
                let mean = |e: Option<Estimate>| e.map_or(DASH.into(), |e| fixed(e.value, 1));
                let beside = |value: Option<f64>| value.map_or(DASH.into(), |v| fixed(100.0 * v, 1));
                let start = [case.label(), part, name].map(str::to_owned);
                let means = [mean(summary.cvdm_baseline), mean(summary.cvdm_fitted)];
                let measured = metrics.iter().flat_map(|(_, ours, paper)| [percent(*ours), beside(*paper)]);
                let better = format!("{} of {}", summary.better, summary.trajectories);
                table.row(start.into_iter().chain(means).chain(measured).chain([better]));
                numbers(case, name, part, summary, &metrics).into_iter().for_each(|row| sheet.row(row));
            }
        }
        let _ = writeln!(text, "{}", integration(case));
    }
    sheet.save(&to.folder)?;
    to.table("performance", &table)?;
    to.figure("performance", bars.figure())?;
    Ok(format!("{table}\n\n{text}"))
}

/// The rows of one baseline and one part of the split, for the CSV.
fn numbers(case: &Case, baseline: &str, part: &str, summary: &Summary, metrics: &[Metric; 3]) -> Vec<[String; 9]> {
    let row = |quantity: &str, unit: &str, estimate: Option<Estimate>, paper: Option<f64>| {
        let interval = estimate.and_then(|e| e.ci95);
        [
            case.ship.name().to_owned(),
            baseline.to_owned(),
            part.to_owned(),
            quantity.to_owned(),
            unit.to_owned(),
            cell(estimate.map(|e| e.value)),
            cell(interval.map(|i| i[0])),
            cell(interval.map(|i| i[1])),
            cell(paper),
        ]
    };
    let mut rows: Vec<_> = metrics.iter().map(|(name, estimate, paper)| row(name, "-", *estimate, *paper)).collect();
    rows.push(row("mean cVDM of the baseline", "%", summary.cvdm_baseline, None));
    rows.push(row("mean cVDM of the fit", "%", summary.cvdm_fitted, None));
    for i in 0..STATE_NAMES.len() {
        let name = STATE_NAMES[i];
        rows.push(row(&format!("mean MD of {name}, baseline"), STATE_UNITS[i], summary.md_baseline[i], None));
        rows.push(row(&format!("mean MD of {name}, fit"), STATE_UNITS[i], summary.md_fitted[i], None));
        rows.push(row(&format!("improvement of mean MD of {name}"), "-", summary.md_improvement[i], None));
    }
    rows
}

/// The error of explicit Euler itself, in words.
fn integration(case: &Case) -> String {
    let used = case.setup.fit.integration;
    let error =
        |integration| integration_error(&case.fit.model, &case.windows, integration, case.setup.fit.max_yaw_rate);
    let one = Integration { substeps: 1, ..used };
    format!(
        "{}: explicit Euler, {} sub-steps of {} s; its own error is a mean cVDM of {} % on the test runs ({} % without sub-steps)",
        case.label(),
        used.substeps,
        case.windows[0].dt / used.substeps as f64,
        error(used).map_or(DASH.into(), |e| fixed(e, 2)),
        error(one).map_or(DASH.into(), |e| fixed(e, 2)),
    )
}

/// Mean cVDM \[%\] between a model's test trajectories under an integration and under a fine RK4.
fn integration_error(model: &Model, windows: &[Run], integration: Integration, max_yaw_rate: f64) -> Option<f64> {
    let exact: Vec<Run> = windows
        .iter()
        .filter(|w| w.split == Split::Test)
        .filter_map(|w| {
            let trajectory = predict(model, w, AUDIT);
            trajectory.diverged_at.is_none().then(|| Run { measured: measured(&trajectory.states), ..w.clone() })
        })
        .collect();
    let settings = EvaluationSettings { resamples: 0, ..EvaluationSettings::default() };
    let judging = Judging { integration, max_yaw_rate, settings };
    prove(model, model, &exact, &judging).summary("test")?.cvdm_fitted.map(|e| e.value)
}
