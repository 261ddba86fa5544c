//! Tables, CSV files and the figure of the gradient study.
//! It computes nothing but ratios.

use trimtab::model::Model;
use trimtab::numbers::numerals::{DASH, fixed, sig};
use trimtab::recording::Run;
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BLUE, Figure, Layer, Legend, ORANGE, Panel, SKY, VERMILLION};

use super::measure::{Course, WAYS, Way, accuracies, courses, gradient_times};
use crate::paper::artefact::Artefact;
use crate::paper::case::{Case, initial_model};
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;

/// Exact gradient against finite differences.
pub static GRADIENT: Artefact = Artefact {
    name: "gradient",
    about: "Exact gradient against finite differences: accuracy, cost, iterations, final cost, time to a given cost",
    make,
};

/// What is reported, case by case.
struct Report {
    fits: Table,
    speed: Table,
    accuracy_sheet: Sheet<4>,
    fit_sheet: Sheet<9>,
    ratio_sheet: Sheet<4>,
    accuracy: Panel,
    courses: Vec<Panel>,
}

impl Report {
    fn new() -> Self {
        Self {
            fits: Table::new([
                "ship",
                "way",
                "iterations",
                "final cost",
                "over the best",
                "cost evaluations",
                "gradients",
                "iterations to the best + 0.1 %",
                "ended",
            ]),
            speed: Table::new(["ship", "what", "time, as a ratio"]),
            accuracy_sheet: Sheet::new("gradient_accuracy", ["ship", "gradient", "step", "relative_error"]),
            fit_sheet: Sheet::new(
                "gradient_fits",
                [
                    "ship",
                    "way",
                    "iterations",
                    "converged",
                    "cost",
                    "over_best",
                    "cost_evaluations",
                    "gradients",
                    "iterations_to_best_plus_0.1_percent",
                ],
            ),
            ratio_sheet: Sheet::new("gradient_time_ratios", ["ship", "ratio_of_times_in_one_run", "way", "ratio"]),
            accuracy: Panel::new(
                "gradient: error over step",
                Axis::new("step, in units of each parameter's scale").log(),
                Axis::new("relative error").log(),
            ),
            courses: Vec::new(),
        }
    }

    fn add_accuracy(&mut self, i: usize, case: &Case, model: &Model, runs: &[Run]) -> Result<(), PaperError> {
        let ship = case.ship.name();
        let errors = accuracies(case, model, runs)?;
        for (step, error) in &errors.steps {
            self.accuracy_sheet.row([ship.into(), "central differences".into(), cell(*step), cell(*error)]);
        }
        self.accuracy_sheet.row([ship.into(), "num-dual".into(), String::new(), cell(errors.oracle)]);
        let name = format!("central differences, {}", case.label());
        let differences = Layer::line(name, [VERMILLION, ORANGE][i % 2], errors.steps);
        // On a logarithmic axis an error of exactly 0 has no place.
        let name = format!("trimtab's duals against num-dual, {}", case.label());
        let oracle = Layer::h_line(name, [BLUE, SKY][i % 2], errors.oracle.max(1e-17)).dashed();
        self.accuracy = std::mem::replace(&mut self.accuracy, Panel::new("", Axis::new(""), Axis::new("")))
            .with(differences)
            .with(oracle);
        Ok(())
    }

    fn add_courses(&mut self, case: &Case, model: &Model, runs: &[Run]) -> Result<(), PaperError> {
        let courses: Vec<(&Way, Course)> = WAYS.iter().zip(courses(case, model, runs)?).collect();
        let best = courses.iter().map(|(_, c)| c.cost).fold(f64::INFINITY, f64::min);
        let reference = &courses[0].1;
        let mut panel = Panel::new(
            format!("{}: fit", case.label()),
            Axis::new("iteration + 1").log(),
            Axis::new("cost over the best - 1").log().range(1e-9, 1e2),
        );
        for (way, c) in &courses {
            self.add_fit(case, way, c, best);
            self.add_time(case, way, c, reference, best);
            let points = c.path.iter().enumerate().map(|(i, (cost, _))| ((i + 1) as f64, cost / best - 1.0 + 1e-12));
            let line = Layer::line(way.name, way.color, points);
            panel = panel.with(if way.is_exact() { line } else { line.dashed() });
        }
        self.courses.push(panel);
        Ok(())
    }

    fn add_fit(&mut self, case: &Case, way: &Way, c: &Course, best: f64) {
        let at = c.reached(best);
        let [costs, gradients] = c.evaluations.map(|n| n.to_string());
        let over = c.cost / best - 1.0;
        self.fits.row([
            case.label().to_owned(),
            way.name.to_owned(),
            c.iterations.to_string(),
            sig(c.cost, 6),
            sig(over, 2),
            costs.clone(),
            gradients.clone(),
            at.map_or(DASH.into(), |i| i.to_string()),
            if c.converged { "converged" } else { "not converged" }.to_owned(),
        ]);
        self.fit_sheet.row([
            case.ship.name().to_owned(),
            way.name.to_owned(),
            c.iterations.to_string(),
            c.converged.to_string(),
            cell(c.cost),
            cell(over),
            costs,
            gradients,
            at.map(|i| i.to_string()).unwrap_or_default(),
        ]);
    }

    fn add_time(&mut self, case: &Case, way: &Way, c: &Course, reference: &Course, best: f64) {
        let time = |c: &Course| c.reached(best).map(|i| c.path[i].1);
        let ratio = time(c).and_then(|t| Some(t / time(reference)?));
        self.speed.row([
            case.label().to_owned(),
            format!("time to the best cost + 0.1 %: {} / {}", way.name, WAYS[0].name),
            ratio.map_or(DASH.into(), |r| fixed(r, 1)),
        ]);
        self.ratio_sheet.row([
            case.ship.name().to_owned(),
            format!("time to the best cost + 0.1 % over that of {}", WAYS[0].name),
            way.name.to_owned(),
            ratio.map(|r| fixed(r, 2)).unwrap_or_default(),
        ]);
        self.ratio_sheet.row([
            case.ship.name().to_owned(),
            format!("time of the whole fit over that of {}", WAYS[0].name),
            way.name.to_owned(),
            fixed(c.seconds / reference.seconds, 2),
        ]);
    }

    fn add_gradient_times(&mut self, case: &Case, model: &Model, runs: &[Run]) -> Result<(), PaperError> {
        for (name, ratio) in gradient_times(case, model, runs)? {
            self.speed.row([case.label().to_owned(), format!("gradient / cost, {name}"), fixed(ratio, 1)]);
            let what = "time of a gradient over that of a cost";
            self.ratio_sheet.row([case.ship.name().to_owned(), what.into(), name.into(), fixed(ratio, 2)]);
        }
        Ok(())
    }
}

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut report = Report::new();
    for (i, case) in cases.iter().enumerate() {
        let model = initial_model(case.ship, case.setup.form)?;
        let runs = case.training();
        report.add_accuracy(i, case, &model, &runs)?;
        report.add_courses(case, &model, &runs)?;
        report.add_gradient_times(case, &model, &runs)?;
    }
    report.accuracy_sheet.save(&to.folder)?;
    report.fit_sheet.save(&to.folder)?;
    report.ratio_sheet.save(&to.folder)?;
    let figure = Figure::new("Exact gradient against finite differences")
        .columns(3)
        .panel_size(900, 640)
        .legend(Legend::EachPanel)
        .with(report.accuracy)
        .with_all(report.courses);
    to.figure("gradient", figure)?;
    Ok(format!("{}\n\nTimes, as ratios within this run:\n{}\n", report.fits, report.speed))
}
