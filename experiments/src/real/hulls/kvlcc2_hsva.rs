//! KVLCC2 at HSVA: fitted to nine zigzags of the 7 m model, judged on four that no fit has seen; and the same fit repeated
//! from other starts and under other limits of the resistance, which should all end at one optimum.

use super::kvlcc2;
use crate::real::error::RealError;
use crate::real::hull::{Hull, settings};
use trimtab::evaluate::maneuver::ManeuverSettings;
use trimtab::evaluate::predict_all;
use trimtab::fit::{Fit, FitError, MultiStart, Rule, fit, multi_start};
use trimtab::model::Model;
use trimtab::numbers::numerals::{fixed, sig};
use trimtab::recording::{Run, Split};
use trimtab::report::Table;
use trimtab::report::plot::Figure;

/// Upper limits of the resistance under which the freed fit is repeated \[N\]; about 35 N is right.
pub const LIMITS: [Option<f64>; 5] = [Some(60.0), Some(100.0), Some(200.0), Some(400.0), None];

/// Random starts of the freed fit: every free value up to 30 % off.
pub const STARTS: MultiStart = MultiStart { count: 20, spread: 0.3, seed: 20_250_226 };

/// Mean cVDM of a model over the windows of one run.
pub struct RunError {
    /// Name of the run.
    pub run: String,
    /// Whether the fits have seen it.
    pub split: Split,
    /// Number of its windows.
    pub windows: usize,
    /// By each model \[%\]; infinite where a simulation diverges.
    pub cvdm: Vec<f64>,
}

/// The results of the experiment.
pub struct Predicted {
    /// The zigzags as tested and as simulated by each model, and the two fits.
    pub trials: kvlcc2::Outcome,
    /// cVDM by run, test runs first.
    pub errors: Vec<RunError>,
}

/// The freed fit from one start under one limit of the resistance.
pub struct Repeat {
    /// Upper limit of the resistance \[N\].
    pub limit: Option<f64>,
    /// Number of the random start; absent for the empirical values.
    pub start: Option<usize>,
    /// The fit.
    pub outcome: Result<Fit, FitError>,
    /// Mean cVDM over the test windows \[%\]; infinite without a fit.
    pub cvdm: f64,
}

/// Fits the eleven parameters and the freed hull, and simulates the zigzags that neither has seen.
///
/// # Errors
/// [`RealError`].
pub fn run() -> Result<Predicted, RealError> {
    let hull = Hull::open("kvlcc2_hsva")?;
    let train = hull.windows(Split::Train)?;
    let test = hull.windows(Split::Test)?;
    let mut empirical = hull.model("model.toml")?;
    let fits = vec![hull.fitted(&empirical, &train)?, hull.fitted(&hull.model("freed.toml")?, &train)?];
    empirical.name = "empirical".into();
    let models: Vec<&Model> = std::iter::once(&empirical).chain(fits.iter().map(|f| &f.model)).collect();

    let trial: ManeuverSettings = settings(&hull.study, "maneuver", &hull.study.maneuver)?;
    let mut trials = kvlcc2::Outcome::new(&models);
    for whole in hull.study.whole_runs(hull.ship.hull.draught)?.windows.iter().filter(|w| w.split == Split::Test) {
        if let Some(angles) = angles(&whole.recording) {
            trials.add_zigzag(whole, angles, &models, &trial)?;
        }
    }
    // Trials end at the fifth execute, tests long after it.
    for zigzag in &mut trials.zigzags {
        let last = zigzag.predicted.iter().filter_map(|t| t.t.last().copied()).fold(0.0, f64::max);
        zigzag.end = zigzag.end.min(last);
    }
    let by_model: Vec<Vec<f64>> = models.iter().map(|m| cvdm(&hull, m, &[&test[..], &train[..]].concat())).collect();
    let mut errors: Vec<RunError> = Vec::new();
    for (i, window) in test.iter().chain(&train).enumerate() {
        let at = errors.iter().position(|e| e.run == window.recording).unwrap_or_else(|| {
            errors.push(RunError {
                run: window.recording.clone(),
                split: window.split,
                windows: 0,
                cvdm: vec![0.0; models.len()],
            });
            errors.len() - 1
        });
        errors[at].windows += 1;
        for (sum, model) in errors[at].cvdm.iter_mut().zip(&by_model) {
            *sum += model[i];
        }
    }
    for error in &mut errors {
        error.cvdm.iter_mut().for_each(|c| *c /= error.windows as f64);
    }
    trials.fits = fits;
    Ok(Predicted { trials, errors })
}

/// Rudder angle and heading \[rad\] of a zigzag by its name, `zigzag 20/10 port first`.
fn angles(name: &str) -> Option<[f64; 2]> {
    let (rudder, heading) = name.split(' ').find_map(|word| word.split_once('/'))?;
    Some([rudder.parse::<f64>().ok()?.to_radians(), heading.parse::<f64>().ok()?.to_radians()])
}

/// cVDM of a model on each window \[%\]; infinite where its simulation diverges.
fn cvdm(hull: &Hull, model: &Model, windows: &[Run]) -> Vec<f64> {
    let predicted = predict_all(model, windows, hull.fit.integration);
    windows.iter().zip(&predicted).map(|(w, p)| hull.cvdm(w, p)).collect()
}

/// Repeats the freed fit under each limit of the resistance, from the empirical values and from random starts around them.
///
/// `progress` is called before each limit.
///
/// # Errors
/// [`RealError`]; a fit that fails is a result.
pub fn repeat(
    limits: &[Option<f64>],
    starts: MultiStart,
    mut progress: impl FnMut(Option<f64>),
) -> Result<Vec<Repeat>, RealError> {
    let hull = Hull::open("kvlcc2_hsva")?;
    let model = hull.model("freed.toml")?;
    let train = hull.windows(Split::Train)?;
    let test = hull.windows(Split::Test)?;
    let mut repeats = Vec::new();
    for limit in limits {
        progress(*limit);
        let mut settings = hull.fit;
        settings.constraints.resistance = Rule { upper: *limit, ..settings.constraints.resistance };
        let empirical = (None, fit(&model, &train, &settings, &mut |_| true));
        let random = multi_start(&model, &train, &settings, &starts, |_| {});
        let random = random.into_iter().enumerate().map(|(i, s)| (Some(i + 1), s.outcome));
        for (start, outcome) in std::iter::once(empirical).chain(random) {
            let unseen = outcome.as_ref().map(|fit| cvdm(&hull, &fit.model, &test));
            let cvdm = unseen.map_or(f64::INFINITY, |c| c.iter().sum::<f64>() / c.len() as f64);
            repeats.push(Repeat { limit: *limit, start, outcome, cvdm });
        }
    }
    Ok(repeats)
}

impl Repeat {
    /// Cost and priors at the end, the quantity that a fit minimises; infinite without a fit.
    pub fn total(&self) -> f64 {
        self.outcome.as_ref().map_or(f64::INFINITY, |fit| fit.cost + fit.prior_cost)
    }
}

/// One row for each repeat.
pub fn repeats_table(repeats: &[Repeat]) -> Table {
    let header = [
        "limit of R [N]",
        "start",
        "seed",
        "converged",
        "cost at the start",
        "cost",
        "cost of the priors",
        "cVDM of the test windows [%]",
        "parts of the first stage",
        "iterations",
    ];
    let mut table = Table::new(header);
    for r in repeats {
        let limit = r.limit.map_or("none".into(), |l| fixed(l, 0));
        let start = r.start.map_or("empirical".into(), |s| s.to_string());
        let seed = r.start.map_or(String::new(), |_| STARTS.seed.to_string());
        let mut row = vec![limit, start, seed];
        match &r.outcome {
            Ok(fit) => row.extend([
                if fit.converged { "yes" } else { "no" }.to_owned(),
                sig(fit.start_cost, 5),
                sig(fit.cost, 6),
                sig(fit.prior_cost, 5),
                fixed(r.cvdm, 3),
                fit.first_stage_parts.to_string(),
                fit.iterations.to_string(),
            ]),
            Err(error) => row.extend([
                error.to_string(),
                String::new(),
                String::new(),
                String::new(),
                String::new(),
                String::new(),
                String::new(),
            ]),
        }
        table.row(row);
    }
    table
}

impl Predicted {
    /// Mean cVDM of a model over the windows of the test runs \[%\].
    pub fn test_cvdm(&self, model: usize) -> f64 {
        let test = || self.errors.iter().filter(|e| e.split == Split::Test);
        let sum: f64 = test().map(|e| e.cvdm[model] * e.windows as f64).sum();
        sum / test().map(|e| e.windows).sum::<usize>() as f64
    }

    /// cVDM of each run by each model.
    pub fn cvdm_table(&self) -> Table {
        let mut header = vec!["run".to_owned(), "in the fit".into()];
        header.extend(self.trials.models.iter().map(|m| format!("{m}: cVDM [%]")));
        let mut table = Table::new(header);
        for e in &self.errors {
            let mut row = vec![e.run.clone(), if e.split == Split::Train { "yes" } else { "no" }.into()];
            row.extend(e.cvdm.iter().map(|c| fixed(*c, 2)));
            table.row(row);
        }
        let mut mean = vec!["mean of the test windows".to_owned(), "no".into()];
        mean.extend((0..self.trials.models.len()).map(|m| fixed(self.test_cvdm(m), 2)));
        table.row(mean);
        table
    }

    /// Heading over time of the zigzags that no fit has seen.
    pub fn figure(&self) -> Figure {
        self.trials.zigzags_titled("KVLCC2 at HSVA: zigzags that no fit has seen, measured and simulated by each model")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_read_from_the_name_of_a_zigzag() {
        let [rudder, heading] = angles("zigzag 20/10 port first").unwrap();
        assert!((rudder.to_degrees() - 20.0).abs() < 1e-12 && (heading.to_degrees() - 10.0).abs() < 1e-12);
        assert_eq!(angles("turning circle"), None);
    }
}
