//! Fits of studies drawn at random: which runs, cut into which windows, which parameters free, from which start, by which objective and
//! Hessian. Each is to end by itself, well inside a minute; how good the models are is not judged here.

use std::path::{Path, PathBuf};
use std::time::Instant;

use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};
use trimtab::fit::{FitSettings, Goal, Hessian, fit};
use trimtab::model::Model;
use trimtab::recording::{Run, Split};
use trimtab::study::Study;

use crate::conceal::error::ConcealError;

/// Time within which a fit is to end \[s\].
pub const LIMIT: f64 = 60.0;

/// What may be free beside the parameters that the model frees.
const FREE: [&[&str]; 7] = [&[], &["hull"], &["flow"], &["hull", "flow"], &["rudder"], &["resistance"], &["crossflow"]];

/// Lengths of windows \[s\]; none: runs as they are.
const WINDOWS: [Option<f64>; 5] = [None, None, Some(60.0), Some(150.0), Some(400.0)];

/// Standard deviations of the start's parameters, as a share of each.
const STARTS: [f64; 4] = [0.0, 0.05, 0.2, 0.5];

/// A study from which fits are drawn.
pub struct Source {
    /// The folder of its file.
    name: String,
    study: Study,
    model: Model,
    settings: FitSettings,
}

/// One fit: what was drawn, and how it ended.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the draw.
    pub case: usize,
    /// The folder of the study.
    pub study: String,
    /// Windows that were fitted to.
    pub windows: usize,
    /// Length of a window \[s\]; blank where runs are whole.
    pub window: Option<f64>,
    /// What was free beside the model's own, separated by blanks.
    pub free: String,
    /// Number of free parameters.
    pub parameters: usize,
    /// Standard deviation of the start's parameters, as a share of each.
    pub start: f64,
    /// What was minimised: `trajectory` or `likelihood`.
    pub objective: String,
    /// Where the second derivatives came from: `gauss-newton` or `limited-memory`.
    pub hessian: String,
    /// Whether it converged.
    pub converged: bool,
    /// Whether it ended by itself within [`LIMIT`], converged or not, or was refused with an error that says why.
    pub ended: bool,
    /// Time \[s\].
    pub seconds: f64,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Evaluations of the objective.
    pub evaluations: usize,
    /// Value of the cost at the start and at the end.
    pub start_cost: f64,
    /// The same at the end.
    pub cost: f64,
    /// How it ended, in the program's words.
    pub status: String,
}

impl Source {
    /// Reads a study with its ship and model.
    ///
    /// # Errors
    /// [`ConcealError`], with what the study's file lacks.
    pub fn read(path: &Path) -> Result<Self, ConcealError> {
        let fail = |error: &dyn std::fmt::Display| ConcealError::content(path, &error.to_string());
        let study = Study::read(path).map_err(|e| fail(&e))?;
        let ship = study.read_ship().map_err(|e| fail(&e))?;
        let model = Model::read(&study.model, ship).map_err(|e| fail(&e))?;
        let settings = study.section::<FitSettings>("fit").map_err(|_| fail(&"its section [fit] cannot be read"))?;
        let folder = path.parent().and_then(Path::file_name).unwrap_or_default();
        Ok(Self { name: folder.to_string_lossy().into_owned(), study, model, settings })
    }

    /// The windows of some of its runs, drawn at random; none of a run that is for the test.
    fn windows(&self, window: Option<f64>, random: &mut ChaCha8Rng) -> Vec<Run> {
        let mut study = self.study.clone();
        if window.is_some() {
            study.windows.window = window;
        }
        let share = random.random_range(0.05..1.0);
        study.runs.retain(|run| run.labels.split == Split::Train && random.random_bool(share));
        // A run that cannot be cut so has no part in it.
        let draught = self.model.ship.hull.draught;
        study.runs.iter().filter_map(|run| study.cut(run, draught).ok()).flat_map(|cut| cut.windows).collect()
    }
}

/// Draws fit number `case` of a seed and makes it.
///
/// # Errors
/// [`ConcealError`] if a model cannot free what is drawn.
pub fn drawn(sources: &[Source], seed: u64, case: usize) -> Result<Row, ConcealError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(case as u64);
    let fail = |error: &dyn std::fmt::Display| ConcealError::content(Path::new("a drawn fit"), &error.to_string());
    let source = sources.choose(&mut random).ok_or_else(|| fail(&"there is no study"))?;
    let window = *WINDOWS.choose(&mut random).unwrap_or(&None);
    let free = *FREE.choose(&mut random).unwrap_or(&FREE[0]);
    let start = *STARTS.choose(&mut random).unwrap_or(&0.0);
    let goal = if random.random_bool(0.5) { Goal::Trajectory } else { Goal::Likelihood };
    let hessian = if random.random_bool(0.8) { Hessian::GaussNewton } else { Hessian::LimitedMemory };
    let mut model = source.model.clone();
    for name in free {
        model.release(name).map_err(|e| fail(&e))?;
    }
    for p in model.parameters.iter_mut().filter(|p| p.free) {
        let normal: f64 = random.sample(StandardNormal);
        p.value = (p.value * (1.0 + start * normal)).clamp(p.lower, p.upper);
    }
    let runs = source.windows(window, &mut random);
    let settings = FitSettings { objective: goal, hessian, max_seconds: LIMIT, ..source.settings };
    let clock = Instant::now();
    let outcome = fit(&model, &runs[..], &settings, &mut |_| true);
    let seconds = clock.elapsed().as_secs_f64();
    let word = |value: serde_json::Result<serde_json::Value>| {
        value.ok().and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default()
    };
    let row = Row {
        case,
        study: source.name.clone(),
        windows: runs.len(),
        window,
        free: free.join(" "),
        parameters: model.free().len(),
        start,
        objective: word(serde_json::to_value(goal)),
        hessian: word(serde_json::to_value(hessian)),
        seconds,
        ended: seconds < LIMIT,
        ..Row::default()
    };
    Ok(match outcome {
        Ok(fit) => Row {
            converged: fit.converged,
            iterations: fit.iterations,
            evaluations: fit.counts.objective,
            start_cost: fit.start_cost,
            cost: fit.cost,
            status: fit.status,
            ..row
        },
        Err(error) => Row { status: error.to_string().replace('\n', " "), ..row },
    })
}

/// The two studies of the program itself, written to a folder.
///
/// # Errors
/// [`ConcealError`] if they cannot be written.
pub fn own(folder: &Path) -> Result<Vec<PathBuf>, ConcealError> {
    let mut out = Vec::new();
    for (name, files) in [("example", trimtab::study::demo::files()), ("trials", trimtab::study::demo::trials())] {
        for (file, text) in files {
            let path = folder.join(name).join(file);
            let fail = |source| ConcealError::file(&path, source);
            path.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(fail)?;
            std::fs::write(&path, text).map_err(fail)?;
        }
        out.push(folder.join(name).join("study.toml"));
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slice of the campaign.
    #[test]
    fn fits_drawn_at_random_end() -> Result<(), ConcealError> {
        let folder = tempfile::tempdir().map_err(|source| ConcealError::file(Path::new("."), source))?;
        let sources = own(folder.path())?.iter().map(|path| Source::read(path)).collect::<Result<Vec<_>, _>>()?;
        let rows = (0..12).map(|case| drawn(&sources, 1, case)).collect::<Result<Vec<_>, _>>()?;
        assert!(rows.iter().all(|row| row.ended), "{rows:#?}");
        assert!(rows.iter().filter(|row| row.converged).count() >= 8, "{rows:#?}");
        // What is drawn depends on seed and number alone.
        let again = drawn(&sources, 1, 3)?;
        assert_eq!(Row { seconds: 0.0, ..again }, Row { seconds: 0.0, ..rows[3].clone() });
        Ok(())
    }
}
