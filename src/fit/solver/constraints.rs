//! The constraints of a fit as data: each rule bounds a curve of the model at the samples of a grid, one row a sample.
//! Every curve here is linear in the parameters, so that a row is a fixed vector; nothing here calls the solver.
//!
//! | rule | curve | paper | imposed on (default) |
//! |---|---|---|---|
//! | `resistance` | R(u) \[N\] | (i) 0 <= R <= 80 kN | 0 <= u <= largest recorded u; upper limit only if set |
//! | `resistance_slope` | R'(u) \[N s/m\] | (ii) R' > 0 | recorded u |
//! | `side_force` | p0 \[-\] | (iii) abs(p0) <= 0.05 | once |
//! | `lift_port` | c_L(a) \[-\] | (iv) -1 <= c_L <= 0, a < 0 | -45 to -1 deg |
//! | `lift_starboard` | c_L(a) \[-\] | (iv) 0 <= c_L <= 1, a >= 0 | 1 to 45 deg |
//! | `drag` | c_D(a) \[-\] | (v) 0 <= c_D <= 1.5 | -45 to 45 deg |
//! | `drag_zero` | c_D(0) \[-\] | (v) c_D(0) <= 0.05 | once |
//! | `thrust` | K_T(J) \[-\] | not there: K_T >= 0 | advance ratios J from 0 to 0.5 |
//!
//! Readings of the paper (Papandreou et al. 2025, arXiv 2502.18696), whose own p* breaks the printed text: (i) cannot hold
//! over the recorded speeds of its ships, `limits = "paper"` imposes it up to 5.4 m/s; (iii) is printed with the rudder's
//! subscript; (iv) at a = 0 would force p4 = 0, so the grid leaves zero out, and it cannot hold beyond 45 degrees, where
//! every such cubic changes sign. A propeller that drives a ship pushes: up to the advance ratios of a loaded propeller its
//! thrust coefficient is positive. The model's c_L includes the rudder's pull on the hull (1 + a_H, 1.2 to 1.4), so that it may exceed
//! the 1 of a rudder alone: for any ship its limit is 2, and 1 with `limits = "paper"`.

use crate::fit::error::FitError;
use crate::model::Model;
use crate::physics::Form;
use crate::ranges::{Limited, OutOfRange, within};
use crate::recording::Runs;
use crate::terms::hydrodynamics::resistance::Resistance;
use crate::terms::propulsion::flow::FlowTerm;
use crate::terms::steering::rudder::Rudder;
use serde::{Deserialize, Serialize};
use trimtab_ad::{Dual, Scalar, VectorFunction, jacobian};

/// Which limits the rules default to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Limits {
    /// For any ship: no upper limit on resistance, which depends on the ship's size, and a lift of at most 2.
    #[default]
    General,
    /// As in the paper for its two container ships: R <= 80 kN, imposed up to 5.4 m/s.
    Paper,
}

/// What a study may say of one rule; what is left out keeps its default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rule {
    /// Whether the rule is imposed (default: yes).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<bool>,
    /// First sample: surge speed \[m/s\], angle of attack \[deg\] or advance ratio \[-\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last sample, same unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Spacing of the samples, same unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Lower limit of the curve, in its own unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// Upper limit of the curve, in its own unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
}

/// Section `[fit.constraints]` of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ConstraintSettings {
    /// Which limits the rules default to.
    pub limits: Limits,
    /// Switches every rule off.
    pub off: bool,
    /// Share of its own size by which each limit is moved outwards (a limit of 0 stays).
    pub tolerance: f64,
    /// Limits of R(u) \[N\] over u \[m/s\].
    pub resistance: Rule,
    /// dR/du \[N s/m\] over u \[m/s\].
    pub resistance_slope: Rule,
    /// p0 \[-\].
    pub side_force: Rule,
    /// c_L at negative angles \[deg\].
    pub lift_port: Rule,
    /// c_L at positive angles \[deg\].
    pub lift_starboard: Rule,
    /// c_D over angles \[deg\].
    pub drag: Rule,
    /// c_D at zero angle.
    pub drag_zero: Rule,
    /// K_T over advance ratios \[-\].
    pub thrust: Rule,
}

impl ConstraintSettings {
    /// The rules by their keys.
    fn rules(&self) -> [(&'static str, Rule); 8] {
        [
            ("resistance", self.resistance),
            ("resistance_slope", self.resistance_slope),
            ("side_force", self.side_force),
            ("lift_port", self.lift_port),
            ("lift_starboard", self.lift_starboard),
            ("drag", self.drag),
            ("drag_zero", self.drag_zero),
            ("thrust", self.thrust),
        ]
    }
}

/// Samples that a rule may have: more cost time and bind nothing that these do not.
const MOST_SAMPLES: f64 = 10_000.0;

impl Limited for ConstraintSettings {
    fn limits(&self) -> Result<(), OutOfRange> {
        within(
            "tolerance",
            self.tolerance,
            &(0.0..=10.0),
            "the share of its size by which each limit is moved outwards",
        )?;
        for (key, rule) in self.rules() {
            let numbers = [rule.from, rule.to, rule.step, rule.lower, rule.upper];
            if let Some(value) = numbers.into_iter().flatten().find(|v| !v.is_finite()) {
                let expected = "a finite number; leave out what is not to be limited".into();
                return Err(OutOfRange { key, value, expected });
            }
            if let (Some(from), Some(to), Some(step)) = (rule.from, rule.to, rule.step)
                && !(step > 0.0 && (to - from) / step <= MOST_SAMPLES)
            {
                let expected = format!("a step above 0 that divides the range into {MOST_SAMPLES} samples at most");
                return Err(OutOfRange { key, value: step, expected });
            }
        }
        Ok(())
    }
}

/// A curve of the model, linear in the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Curve {
    Resistance,
    ResistanceSlope,
    SideForce,
    Lift,
    Drag,
    Thrust,
}

impl Curve {
    fn at<S: Scalar<Coefficient = S>>(self, model: &Model, theta: &[S], x: f64) -> S {
        let part = |term| model.part(term, theta);
        match self {
            Curve::Resistance => Resistance::curve(part("resistance"), S::from_f64(x)),
            Curve::ResistanceSlope => {
                // In the fore-aft consistent form R is odd in u, and its slope even.
                let u = S::from_f64(if model.form == Form::Regular { x.abs() } else { x });
                let constants: Vec<Dual<S, 1>> = part("resistance").iter().map(|p| Dual::constant(*p)).collect();
                Resistance::curve(&constants, Dual::variable(u, 0)).eps[0]
            }
            Curve::SideForce => part("propeller")[0],
            Curve::Lift => Rudder::lift_polynomial(part("rudder"), S::from_f64(x.to_radians())),
            Curve::Drag => Rudder::drag_polynomial(part("rudder"), S::from_f64(x.to_radians())),
            Curve::Thrust => FlowTerm::thrust_coefficient(part("flow"), S::from_f64(x)),
        }
    }

    fn describe(self, x: f64) -> String {
        match self {
            Curve::Resistance => format!("R({x:.2} m/s)"),
            Curve::ResistanceSlope => format!("R'({x:.2} m/s)"),
            Curve::SideForce => "p0".into(),
            Curve::Lift => format!("c_L({x:.1} deg)"),
            Curve::Drag => format!("c_D({x:.1} deg)"),
            Curve::Thrust => format!("K_T(J = {x:.2})"),
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Curve::Resistance => "N",
            Curve::ResistanceSlope => "N s/m",
            Curve::SideForce | Curve::Lift | Curve::Drag | Curve::Thrust => "",
        }
    }
}

/// One sample of a rule: `lower <= constant + coefficients . p <= upper` for the free parameters p.
#[derive(Clone, Debug)]
pub struct Row {
    /// The rule's key in the settings.
    pub rule: &'static str,
    /// What is bounded, in words, e.g. `R'(1.31 m/s)`.
    pub quantity: String,
    /// Its unit, empty for none.
    pub unit: &'static str,
    /// Derivative by each free parameter.
    pub coefficients: Vec<f64>,
    /// What the fixed parameters contribute.
    pub constant: f64,
    /// Lower limit, tolerance included.
    pub lower: f64,
    /// Upper limit, tolerance included.
    pub upper: f64,
}

impl Row {
    /// The bounded quantity at the free parameters `p`.
    pub fn value(&self, p: &[f64]) -> f64 {
        self.constant + self.coefficients.iter().zip(p).map(|(a, p)| a * p).sum::<f64>()
    }

    /// Its change, in its own unit, over one scale in every free parameter: what its unit is for the solver.
    pub fn size(&self, scales: &[f64]) -> f64 {
        self.coefficients.iter().zip(scales).map(|(a, s)| (a * s).powi(2)).sum::<f64>().sqrt()
    }

    /// How far outside its limits the quantity is at `p`; 0 inside.
    pub fn violation(&self, p: &[f64]) -> f64 {
        let value = self.value(p);
        (self.lower - value).max(value - self.upper).max(0.0)
    }

    /// The limit nearest to the value at `p`, as a sentence: `R'(1.31 m/s) >= 0 N s/m`.
    pub fn sentence(&self, p: &[f64]) -> String {
        let value = self.value(p);
        let (sign, limit) = if (value - self.lower).abs() <= (self.upper - value).abs() {
            (">=", self.lower)
        } else {
            ("<=", self.upper)
        };
        format!("{} {sign} {limit} {}", self.quantity, self.unit).trim_end().to_string()
    }
}

/// Smallest and largest recorded surge speed \[m/s\]; `[0, 0]` where none was recorded.
pub fn speed_range<'a>(runs: impl Into<Runs<'a>>) -> [f64; 2] {
    runs.into().iter().fold([0.0, 0.0], |range, run| {
        let recorded = run.measured.iter().filter_map(|m| m[3]).chain([run.initial[3]]);
        recorded.filter(|u| u.is_finite()).fold(range, |[lo, hi], u| [lo.min(u), hi.max(u)])
    })
}

/// The rows of all rules for a model, given the recorded range of surge speed \[m/s\].
///
/// Rows that no free parameter enters are left out: a fit cannot change them.
///
/// # Errors
/// A rule whose limits leave no value or whose grid has no samples.
pub fn rows(model: &Model, settings: &ConstraintSettings, speeds: [f64; 2]) -> Result<Vec<Row>, FitError> {
    if settings.off {
        return Ok(Vec::new());
    }
    let [slowest, fastest] = speeds;
    let speed_step = ((fastest - slowest) / 60.0).max(1e-6);
    let paper = settings.limits == Limits::Paper;
    let (highest, upper) = if paper { (5.4, 80e3) } else { (fastest, f64::INFINITY) };
    // With the rudder's pull on the hull, 1 + a_H.
    let lift = if paper { 1.0 } else { 2.0 };
    let defaults: [(&str, Curve, Rule, [f64; 5]); 8] = [
        ("resistance", Curve::Resistance, settings.resistance, [0.0, highest, highest.max(1e-6) / 54.0, 0.0, upper]),
        (
            "resistance_slope",
            Curve::ResistanceSlope,
            settings.resistance_slope,
            [slowest, fastest, speed_step, 0.0, f64::INFINITY],
        ),
        ("side_force", Curve::SideForce, settings.side_force, [0.0, 0.0, 1.0, -0.05, 0.05]),
        ("lift_port", Curve::Lift, settings.lift_port, [-45.0, -1.0, 1.0, -lift, 0.0]),
        ("lift_starboard", Curve::Lift, settings.lift_starboard, [1.0, 45.0, 1.0, 0.0, lift]),
        ("drag", Curve::Drag, settings.drag, [-45.0, 45.0, 1.0, 0.0, 1.5]),
        ("drag_zero", Curve::Drag, settings.drag_zero, [0.0, 0.0, 1.0, f64::NEG_INFINITY, 0.05]),
        ("thrust", Curve::Thrust, settings.thrust, [0.0, 0.5, 0.05, 0.0, f64::INFINITY]),
    ];
    let mut samples = Vec::new();
    for (name, curve, rule, [from, to, step, lower, upper]) in defaults {
        if rule.on == Some(false) {
            continue;
        }
        let (from, to) = (rule.from.unwrap_or(from), rule.to.unwrap_or(to));
        let step = rule.step.unwrap_or(step);
        let (lower, upper) = (rule.lower.unwrap_or(lower), rule.upper.unwrap_or(upper));
        let bad = |what: String| Err(FitError::BadRule { rule: name.into(), what });
        if lower.is_nan() || upper.is_nan() || lower > upper {
            return bad(format!("lower = {lower} and upper = {upper} leave no value; correct or swap them"));
        }
        if !(from <= to && step > 0.0 && (to - from) / step < 1e5) {
            return bad(format!(
                "from = {from}, to = {to}, step = {step} give no usable grid; it needs from <= to and a positive step"
            ));
        }
        if !(settings.tolerance >= 0.0 && settings.tolerance.is_finite()) {
            return bad(format!("tolerance = {} must be a number of at least 0", settings.tolerance));
        }
        let lower = lower - settings.tolerance * if lower.is_finite() { lower.abs() } else { 0.0 };
        let upper = upper + settings.tolerance * if upper.is_finite() { upper.abs() } else { 0.0 };
        if lower == f64::NEG_INFINITY && upper == f64::INFINITY {
            continue;
        }
        let intervals = ((to - from) / step - 1e-9).ceil().max(0.0) as usize;
        for i in 0..=intervals {
            samples.push(Sample { rule: name, curve, x: (from + i as f64 * step).min(to), lower, upper });
        }
    }
    Ok(linear_rows(&Sampled { model, free: model.free(), fixed: model.values(), samples }))
}

/// A curve at one abscissa, with its limits.
struct Sample {
    rule: &'static str,
    curve: Curve,
    x: f64,
    lower: f64,
    upper: f64,
}

/// The curves of all samples as a function of the free parameters.
struct Sampled<'a> {
    model: &'a Model,
    free: Vec<usize>,
    /// Values of all parameters, of which the free ones are replaced.
    fixed: Vec<f64>,
    samples: Vec<Sample>,
}

impl VectorFunction for Sampled<'_> {
    fn outputs(&self) -> usize {
        self.samples.len()
    }

    fn eval<S: Scalar<Coefficient = S>>(&self, p: &[S], y: &mut [S]) {
        let mut theta: Vec<S> = self.fixed.iter().map(|value| S::from_f64(*value)).collect();
        for (i, p) in self.free.iter().zip(p) {
            theta[*i] = *p;
        }
        for (y, sample) in y.iter_mut().zip(&self.samples) {
            *y = sample.curve.at(self.model, &theta, sample.x);
        }
    }
}

/// The rows of curves that are linear in the parameters: their values where the free parameters are 0, and their slopes.
fn linear_rows(curves: &Sampled) -> Vec<Row> {
    let (constants, slopes) = jacobian(curves, &vec![0.0; curves.free.len()]);
    let row = |(i, sample): (usize, &Sample)| Row {
        rule: sample.rule,
        quantity: sample.curve.describe(sample.x),
        unit: sample.curve.unit(),
        coefficients: slopes.row(i).iter().copied().collect(),
        constant: constants[i],
        lower: sample.lower,
        upper: sample.upper,
    };
    let all = curves.samples.iter().enumerate().map(row);
    all.filter(|row| row.coefficients.iter().any(|a| *a != 0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship::Ship;
    use std::path::Path;

    fn model() -> Model {
        let path = format!("{}/experiments/ships/a.toml", env!("CARGO_MANIFEST_DIR"));
        Model::new(Ship::read(Path::new(&path)).unwrap(), "HD", Form::Paper, &[]).unwrap()
    }

    fn free_values(model: &Model) -> Vec<f64> {
        model.free().iter().map(|i| model.parameters[*i].value).collect()
    }

    #[test]
    fn a_row_gives_the_curve_it_samples() {
        let model = model();
        let rows = rows(&model, &ConstraintSettings::default(), [-4.0, 8.0]).unwrap();
        let p = free_values(&model);
        let value = |quantity: &str| rows.iter().find(|r| r.quantity == quantity).unwrap().value(&p);
        let [p0, p1, p2, p3, p4, p5, p6, p7, p8, p9, p10] = model.eleven();
        let a = 30f64.to_radians();
        let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()));
        close(value("p0"), p0);
        close(value("R(8.00 m/s)"), 8.0 * p1 + 64.0 * p2 + 512.0 * p3);
        close(value("R'(-4.00 m/s)"), p1 - 8.0 * p2 + 48.0 * p3);
        close(value("c_L(30.0 deg)"), p4 + p5 * a + p6 * a * a + p7 * a * a * a);
        close(value("c_D(-30.0 deg)"), p8 - p9 * a + p10 * a * a);
    }

    #[test]
    fn a_fixed_parameter_moves_into_the_constant() {
        let mut model = model();
        let all = rows(&model, &ConstraintSettings::default(), [0.0, 8.0]).unwrap();
        let before: Vec<f64> = all.iter().map(|r| r.value(&free_values(&model))).collect();
        let i = model.index("rudder.lift1").unwrap();
        model.parameters[i].free = false;
        let fewer = rows(&model, &ConstraintSettings::default(), [0.0, 8.0]).unwrap();
        let after: Vec<f64> = fewer.iter().map(|r| r.value(&free_values(&model))).collect();
        for (a, b) in before.iter().zip(&after) {
            assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs()));
        }
        assert_eq!(fewer[0].coefficients.len(), 10);
    }

    #[test]
    fn the_published_parameters_break_the_printed_limits_only_where_the_reading_says() {
        let mut model = model();
        model.set_eleven(&[-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370]);
        let settings = ConstraintSettings { limits: Limits::Paper, ..Default::default() };
        let broken: Vec<Row> = rows(&model, &settings, [-4.47, 8.23]).unwrap();
        let broken: Vec<&Row> = broken.iter().filter(|r| r.violation(&free_values(&model)) > 0.0).collect();
        assert!(!broken.is_empty());
        // The lift just tops 1: the printed digits round it up.
        assert!(broken.iter().all(|r| r.rule == "lift_starboard" && r.violation(&free_values(&model)) < 2e-3));
    }

    #[test]
    fn lift_with_the_pull_on_the_hull_may_exceed_that_of_a_rudder_alone_but_in_the_paper() {
        let limits = |limits: Limits| {
            let settings = ConstraintSettings { limits, tolerance: 0.0, ..Default::default() };
            let rows = rows(&model(), &settings, [0.0, 8.0]).unwrap();
            let of = |rule: &str| rows.iter().find(|r| r.rule == rule).map(|r| [r.lower, r.upper]);
            (of("lift_port"), of("lift_starboard"))
        };
        assert_eq!(limits(Limits::General), (Some([-2.0, 0.0]), Some([0.0, 2.0])));
        assert_eq!(limits(Limits::Paper), (Some([-1.0, 0.0]), Some([0.0, 1.0])));
    }

    #[test]
    fn contradictory_limits_are_refused_by_the_name_of_the_rule() {
        let crossed = Rule { lower: Some(2.0), upper: Some(1.0), ..Rule::default() };
        let settings = ConstraintSettings { drag: crossed, ..Default::default() };
        let error = rows(&model(), &settings, [0.0, 8.0]).unwrap_err().to_string();
        assert!(error.contains("drag") && error.contains("leave no value"), "{error}");
    }

    #[test]
    fn settings_are_read_from_a_study_and_misspelt_ones_refused() {
        let text = "limits = \"paper\"\nresistance = { upper = 90e3 }\nlift_port = { on = false }\n";
        let settings: ConstraintSettings = toml::from_str(text).unwrap();
        let rows = rows(&model(), &settings, [0.0, 8.0]).unwrap();
        let resistance: Vec<&Row> = rows.iter().filter(|r| r.rule == "resistance").collect();
        // 55 samples, less the one at u = 0, which no parameter enters.
        assert_eq!(resistance.len(), 54);
        assert!(resistance.iter().all(|r| r.upper == 90e3 * (1.0 + settings.tolerance)));
        assert!(rows.iter().all(|r| r.rule != "lift_port"));
        assert!(toml::from_str::<ConstraintSettings>("resistence = { upper = 1.0 }").is_err());
    }
}
