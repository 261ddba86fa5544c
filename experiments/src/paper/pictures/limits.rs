//! What limits the fit: the same data fitted without constraints, in the other low-speed form, and with hull and propulsion coefficients set free.
//! The paper has no such table. The eleven parameters alone gain less on our captive baseline than the paper's fit on its own
//! baseline, and these are the possible reasons.

use crate::paper::artefact::Artefact;
use crate::paper::case::{Case, initial_model};
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;
use trimtab::evaluate::{EvaluationSettings, Judging, prove};
use trimtab::fit::{Fit, FitSettings, fit};
use trimtab::model::{Model, Prior};
use trimtab::numbers::numerals::{DASH, fixed, sig};
use trimtab::physics::Form;
use trimtab::report::Table;

/// What limits the fit.
pub static LIMITS: Artefact = Artefact {
    name: "limits",
    about: "What limits the fit: form, constraints, and coefficients set free with priors (test runs)",
    make,
};

/// Successive samples that count as one where residuals are weighed against priors: without noise, residuals are correlated over
/// some 20 samples.
const CORRELATED: f64 = 20.0;

/// One way to fit.
struct Variant {
    name: &'static str,
    form: Form,
    constrained: bool,
    /// Terms whose coefficients are free beside the eleven, with their priors.
    free: &'static [&'static str],
}

const VARIANTS: [Variant; 5] = [
    Variant { name: "as in the paper", form: Form::Paper, constrained: true, free: &[] },
    Variant { name: "regular form astern", form: Form::Regular, constrained: true, free: &[] },
    Variant { name: "no constraints", form: Form::Paper, constrained: false, free: &[] },
    Variant { name: "regular form, hull free with priors", form: Form::Regular, constrained: true, free: &["hull"] },
    Variant {
        name: "regular form, hull, wake, thrust and race free with priors",
        form: Form::Regular,
        constrained: true,
        free: &["hull", "flow"],
    },
];

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut table = Table::new([
        "ship",
        "variant",
        "free",
        "ended",
        "train cost",
        "cVDM* [%]",
        "baseline",
        "mARI [%]",
        "cVDM gain [%]",
        "consistency [%]",
    ]);
    let header = [
        "ship",
        "variant",
        "free",
        "converged",
        "train_cost",
        "test_cvdm",
        "baseline",
        "mari",
        "cvdm_improvement",
        "consistency",
    ];
    let mut sheet = Sheet::new("limits_values", header);
    for case in cases {
        for variant in &VARIANTS {
            let (model, settings) = variant.prepare(case)?;
            let fit = fit(&model, &case.training(), &settings, &mut |_| true)?;
            for (baseline, name) in case.baselines() {
                let [cvdm, mari, gain, consistency] = test_scores(case, baseline, &fit, &settings)?;
                let percent = |v: Option<f64>| v.map_or(DASH.into(), |v| fixed(100.0 * v, 1));
                let free = fit.estimates.len().to_string();
                table.row([
                    case.label().to_owned(),
                    variant.name.to_owned(),
                    free.clone(),
                    if fit.converged { "converged" } else { "not converged" }.to_owned(),
                    sig(fit.cost, 4),
                    cvdm.map_or(DASH.into(), |v| fixed(v, 1)),
                    name.to_owned(),
                    percent(mari),
                    percent(gain),
                    percent(consistency),
                ]);
                sheet.row([
                    case.ship.name().to_owned(),
                    variant.name.to_owned(),
                    free,
                    fit.converged.to_string(),
                    cell(fit.cost),
                    cell(cvdm),
                    name.to_owned(),
                    cell(mari),
                    cell(gain),
                    cell(consistency),
                ]);
            }
        }
    }
    sheet.save(&to.folder)?;
    to.table("limits", &table)?;
    let gains: String =
        cases.iter().filter_map(|case| Some((case, captive_over_published(case)?))).map(sentence).collect();
    Ok(format!("{table}\n{gains}"))
}

/// Mean cVDM of the fit \[%\], mARI, cVDM improvement and consistency against a baseline on the test runs.
fn test_scores(
    case: &Case,
    baseline: &Model,
    fit: &Fit,
    settings: &FitSettings,
) -> Result<[Option<f64>; 4], PaperError> {
    let bootstrap = EvaluationSettings { seed: case.setup.seed, ..EvaluationSettings::default() };
    let evaluation = prove(baseline, &fit.model, &case.windows, &Judging::new(settings, bootstrap));
    let empty = PaperError::Empty { ship: case.ship.name(), what: "test runs" };
    let s = evaluation.summary("test").ok_or(empty)?;
    Ok([s.cvdm_fitted, s.mari, s.cvdm_improvement, s.consistency].map(|e| e.map(|e| e.value)))
}

fn sentence((case, gain): (&Case, f64)) -> String {
    format!(
        "{}: captive tests alone take {} % off the mean cVDM of the published p~; a gain on them is of what remains.\n",
        case.label(),
        fixed(100.0 * gain, 1)
    )
}

/// Improvement of the mean cVDM of the captive baseline over the published one, test runs \[-\].
fn captive_over_published(case: &Case) -> Option<f64> {
    let mean = |model: &Model| case.evaluate(model).summary("test")?.cvdm_baseline.map(|e| e.value);
    Some(1.0 - mean(&case.captive_baseline)? / mean(&case.published_baseline)?)
}

impl Variant {
    fn prepare(&self, case: &Case) -> Result<(Model, FitSettings), PaperError> {
        let mut model = initial_model(case.ship, self.form)?;
        let mut settings = case.setup.fit;
        settings.constraints.off = !self.constrained;
        if !self.free.is_empty() {
            settings.correlated_samples = CORRELATED;
            // From the captive tests: with this many parameters a start far off costs hundreds of iterations.
            model.set_eleven(&case.captive_baseline.eleven());
            let ship = model.ship.clone();
            let chosen = |name: &str| name.split_once('.').is_some_and(|(term, _)| self.free.contains(&term));
            for parameter in model.parameters.iter_mut().filter(|p| chosen(&p.name)) {
                parameter.free = true;
                parameter.prior = Some(Prior { mean: parameter.value, sd: (parameter.info.spread)(&ship) });
            }
        }
        Ok((model, settings))
    }
}
