//! Figure 2 of the paper: resistance, lift and drag curves, fitted beside both baselines, with the bands the constraints leave.
//! Captive tests on the truth simulators are shown as points; no fit has used them.

use crate::paper::artefact::Artefact;
use crate::paper::captive_baseline::{rudder_points, rudder_rows};
use crate::paper::case::Case;
use crate::paper::error::PaperError;
use crate::paper::target::Target;
use crate::truth::captive::{Range, towing};
use trimtab::fit::{CovarianceKind, Fit};
use trimtab::model::Model;
use trimtab::numbers::numerals::{DASH, fixed, sig};
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BASELINE, FITTED, Figure, LIMIT, Layer, Marker, ORANGE, PURPLE, Panel, TRUTH};
use trimtab::terms::hydrodynamics::resistance::Resistance;
use trimtab::terms::steering::rudder::Rudder;

/// Figure 2.
pub static CURVES: Artefact = Artefact {
    name: "figure2",
    about: "Figure 2: R(u), c_L and c_D, fitted beside the baselines, with the constraint bands",
    make,
};

/// A curve linear in some of the eleven parameters.
struct Curve {
    title: &'static str,
    x: &'static str,
    y: &'static str,
    /// Factor from the axis to the unit of the curve's argument, and from the curve to the axis.
    units: [f64; 2],
    /// Range of the axis.
    range: fn(&Case) -> [f64; 2],
    /// Parameters, from p0.
    parameters: std::ops::Range<usize>,
    value: fn(&[f64; 11], f64) -> f64,
    /// Limits that a constraint leaves: from, to (axis), lower, upper (axis).
    limits: &'static [[f64; 4]],
    shown: [f64; 2],
}

const CURVES_SHOWN: [Curve; 3] = [
    Curve {
        title: "resistance",
        x: "surge speed u [m/s]",
        y: "R [kN]",
        units: [1.0, 1e-3],
        range: |case| [0.0, case.windows.iter().flat_map(|w| &w.measured).filter_map(|s| s[3]).fold(0.0, f64::max)],
        parameters: 1..4,
        value: |p, u| Resistance::curve(&p[1..4], u),
        limits: &[[0.0, 5.4, 0.0, 80.0]],
        shown: [-10.0, 200.0],
    },
    Curve {
        title: "rudder lift",
        x: "angle of attack [deg]",
        y: "c_L [-]",
        units: [std::f64::consts::PI / 180.0, 1.0],
        range: |_| [-45.0, 45.0],
        parameters: 4..8,
        value: |p, a| Rudder::lift_polynomial(&p[4..11], a),
        limits: &[[-45.0, 0.0, -1.0, 0.0], [0.0, 45.0, 0.0, 1.0]],
        shown: [-1.6, 1.6],
    },
    Curve {
        title: "rudder drag",
        x: "angle of attack [deg]",
        y: "c_D [-]",
        units: [std::f64::consts::PI / 180.0, 1.0],
        range: |_| [-45.0, 45.0],
        parameters: 8..11,
        value: |p, a| Rudder::drag_polynomial(&p[4..11], a),
        limits: &[[-45.0, 45.0, 0.0, 1.5]],
        shown: [-0.2, 1.6],
    },
];

/// Intervals of a curve's axis.
const SAMPLES: usize = 90;

impl Curve {
    fn grid(&self, case: &Case) -> Vec<f64> {
        let [from, to] = (self.range)(case);
        (0..=SAMPLES).map(|i| from + (to - from) * i as f64 / SAMPLES as f64).collect()
    }

    fn line(&self, p: &[f64; 11], x: f64) -> f64 {
        self.units[1] * (self.value)(p, self.units[0] * x)
    }

    /// Standard error of the curve, from the covariance of its parameters; absent where the data do not determine it.
    fn error(&self, fit: &Fit, x: f64) -> Option<f64> {
        let basis: Vec<(usize, f64)> = self
            .parameters
            .clone()
            .filter_map(|i| {
                let mut unit = [0.0; 11];
                unit[i] = 1.0;
                let row = fit.estimates.iter().position(|e| e.name == trimtab::model::ELEVEN[i])?;
                Some((row, self.line(&unit, x)))
            })
            .collect();
        let covariance = match (fit.covariance_kind, &fit.covariance_sandwich) {
            (CovarianceKind::Sandwich, Some(covariance)) => covariance,
            _ => &fit.covariance_gauss_newton,
        };
        let mut variance = 0.0;
        for (i, a) in &basis {
            for (j, b) in &basis {
                variance += a * b * covariance[*i][*j]?;
            }
        }
        Some(variance.max(0.0).sqrt())
    }

    /// What captive tests measure on the truth, as points (x, y) of the axes.
    fn measured(&self, case: &Case) -> Vec<(f64, f64)> {
        let truth = case.ship.truth();
        if self.parameters.start == 1 {
            let [from, to] = (self.range)(case);
            let rows = towing(truth.as_ref(), Range { from, to, count: 18 });
            return rows.iter().map(|row| (row.u, -row.force.hull.x * self.units[1])).collect();
        }
        let points = rudder_points(&case.captive_baseline, &rudder_rows(case.ship, truth.as_ref()));
        let y =
            |p: &crate::paper::captive_baseline::RudderPoint| if self.parameters.start == 4 { p.lift } else { p.drag };
        // One in five is enough to see the scatter.
        points.iter().step_by(5).map(|p| (p.attack / self.units[0], y(p))).collect()
    }

    fn panel(&self, case: &Case) -> Panel {
        let grid = self.grid(case);
        let of = |model: &Model| {
            let p = model.eleven();
            grid.iter().map(|&x| (x, self.line(&p, x))).collect::<Vec<_>>()
        };
        let p = case.fit.model.eleven();
        let band = grid.iter().filter_map(|&x| {
            let (y, e) = (self.line(&p, x), 1.96 * self.error(&case.fit, x)?);
            Some((x, y - e, y + e))
        });
        let mut panel = Panel::new(
            format!("{}: {}", case.label(), self.title),
            Axis::new(self.x),
            Axis::new(self.y).range(self.shown[0], self.shown[1]),
        );
        for [from, to, lower, upper] in self.limits {
            let points = [(*from, *lower, *upper), (*to, *lower, *upper)];
            panel = panel.with(Layer::band("allowed by the constraints", LIMIT, points));
        }
        let paper = grid.iter().map(|&x| (x, self.line(&case.published.fitted, x)));
        panel
            .with(Layer::scatter("captive tests on the truth", TRUTH, self.measured(case)).marker(Marker::Cross))
            .with(Layer::band("95 % band of the fit", FITTED, band))
            .with(Layer::line("baseline, published p~", BASELINE, of(&case.published_baseline)).dashed())
            .with(Layer::line("baseline, captive tests", ORANGE, of(&case.captive_baseline)))
            .with(Layer::line("paper's p* (its own ships)", PURPLE, paper).dotted())
            .with(Layer::line("fitted", FITTED, of(&case.fit.model)))
    }
}

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut table = Table::new(["ship", "curve", "at", "p~ paper", "p~ captive", "p* paper", "p* ours", "+-95 %"]);
    let mut figure = Figure::new("Resistance and rudder curves (figure 2)").columns(3).panel_size(820, 640);
    for case in cases {
        for curve in &CURVES_SHOWN {
            figure = figure.with(curve.panel(case));
            let [from, to] = (curve.range)(case);
            for share in [0.25, 0.5, 0.75] {
                let x = from + share * (to - from);
                let of = |p: &[f64; 11]| fixed(curve.line(p, x), 3);
                table.row([
                    case.label().to_owned(),
                    curve.y.to_owned(),
                    sig(x, 3),
                    of(&case.published.baseline),
                    of(&case.captive_baseline.eleven()),
                    of(&case.published.fitted),
                    of(&case.fit.model.eleven()),
                    curve.error(&case.fit, x).map_or(DASH.into(), |e| fixed(1.96 * e, 3)),
                ]);
            }
        }
    }
    to.figure("figure2", figure)?;
    to.table("figure2", &table)?;
    Ok(format!("{table}\n"))
}
