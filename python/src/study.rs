//! A study in Python: ship, model and recordings, and what can be asked of them.
//! It reads as the commands do, with the same checks and the same words; the library computes.

use crate::cli::evaluate::judge;
use crate::cli::shared::audited::{AcceptArgs, audited, examined};
use crate::cli::shared::error::CliError;
use crate::cli::shared::load::{Loaded, StudyArgs};
use crate::convert::{SEEDS, Words, counted, document, no_others, warn, whole_number};
use crate::diagnosis::{Asked, Diagnosis};
use crate::errors::{Raised, StudyError, of_a_call};
use crate::evaluation::Evaluation;
use crate::fit::{Fit, Settings, run};
use crate::model::Model;
use crate::objective::{Objective, Wanted};
use crate::ship::Ship;
use crate::window::Window;
use crate::work::{Line, whole};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use trimtab::FitSettings;
use trimtab::files::suggestion;
use trimtab::recording::audit::audit_study;
use trimtab::recording::{Run, Runs, Split};

/// Which runs of a study are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Train,
    Test,
    All,
}

impl Side {
    /// The side of a word.
    pub fn named(word: &str) -> PyResult<Self> {
        match word {
            "train" => Ok(Self::Train),
            "test" => Ok(Self::Test),
            "all" => Ok(Self::All),
            _ => {
                let near = suggestion(word, ["train", "test", "all"].into_iter());
                Err(PyValueError::new_err(format!("split = \"{word}\"{near}: give \"train\", \"test\" or \"all\"")))
            }
        }
    }

    /// The word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Test => "test",
            Self::All => "all",
        }
    }

    fn has(self, split: Split) -> bool {
        match self {
            Self::Train => split == Split::Train,
            Self::Test => split == Split::Test,
            Self::All => true,
        }
    }
}

/// What was read of a study's recordings, once.
#[derive(Default)]
struct Read {
    windows: Option<Arc<Vec<Run>>>,
    train: Option<Arc<Vec<Run>>>,
    test: Option<Arc<Vec<Run>>>,
    /// The faults that were accepted when the audit let the recordings pass.
    passed: Option<Vec<String>>,
}

/// A study: a TOML file that names ship, model and recordings. Recordings are read when they are first needed, and audited before the
/// first fit: those that contradict themselves (unit, sign, axes) raise `RecordingsError` unless the fault is accepted by name.
#[pyclass(module = "trimtab", frozen)]
pub struct Study {
    loaded: Loaded,
    path: PathBuf,
    model_path: Option<PathBuf>,
    model: Py<Model>,
    read: Mutex<Read>,
    /// What the study's files live in, where they are temporary.
    folder: Option<Py<PyAny>>,
    /// Whether a call has made it of tables or logs, so that units and columns are arguments of that call.
    imported: bool,
}

/// Keywords of `Study.fit`.
const OF_FIT: [&str; 9] =
    ["model", "objective", "hessian", "tolerance", "max_iterations", "max_seconds", "settings", "accept", "progress"];

impl Study {
    /// The runs of a side, of which there must be some.
    pub fn windows_of(&self, py: Python<'_>, side: Side) -> PyResult<Arc<Vec<Run>>> {
        let all = self.read(py)?;
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = match side {
            Side::All => return Ok(all),
            Side::Train => &mut read.train,
            Side::Test => &mut read.test,
        };
        let of_side = || Arc::new(all.iter().filter(|run| side.has(run.split)).cloned().collect::<Vec<Run>>());
        let runs = Arc::clone(kept.get_or_insert_with(of_side));
        let split = if side == Side::Test { Split::Test } else { Split::Train };
        if runs.is_empty() { Err(self.loaded.nothing(split).raised()) } else { Ok(runs) }
    }

    /// All runs, cut as the study says.
    fn read(&self, py: Python<'_>) -> PyResult<Arc<Vec<Run>>> {
        if let Some(known) = &self.read.lock().unwrap_or_else(PoisonError::into_inner).windows {
            return Ok(Arc::clone(known));
        }
        let draught = self.loaded.model.ship.hull.draught;
        let work = |line: &Line<()>| {
            let mut runs = Vec::new();
            let take = |one: trimtab::recording::Windows| {
                runs.extend(one.windows);
                let stopped = || CliError::Argument("the recordings were not read to the end".into());
                if line.is_stopped() { Err(stopped()) } else { Ok(()) }
            };
            self.loaded.study.each(draught, |_| true, |one| one, take).map(|()| runs)
        };
        let runs = Arc::new(whole(py, |()| Ok(true), work)?.map_err(|error| self.refused(error))?);
        self.read.lock().unwrap_or_else(PoisonError::into_inner).windows = Some(Arc::clone(&runs));
        Ok(runs)
    }

    /// The given model as it is now, or the study's.
    fn chosen(&self, model: Option<&Model>) -> crate::model::Inner {
        model.map_or_else(|| self.model.get().snapshot(), Model::snapshot)
    }

    /// What the audit says, as whoever made the study mends it.
    fn told(&self, words: &str) -> String {
        if self.imported { of_a_call(words) } else { words.to_owned() }
    }

    /// The exception of recordings that cannot be used, as whoever made the study mends it.
    fn refused(&self, error: CliError) -> PyErr {
        match error {
            CliError::Faulty { path, what, fault } => CliError::Faulty { path, what: self.told(&what), fault }.raised(),
            CliError::Study(error) => StudyError::new_err(self.told(&error.to_string())),
            error => error.raised(),
        }
    }

    /// Audits the recordings, once for the same faults accepted.
    fn audit(&self, py: Python<'_>, accept: Words, refuse: bool) -> PyResult<()> {
        let Words(accept) = accept;
        if self.read.lock().unwrap_or_else(PoisonError::into_inner).passed.as_ref() == Some(&accept) {
            return Ok(());
        }
        let args = AcceptArgs { accept };
        let work = |_: &Line<()>| if refuse { audited(&self.loaded, &args) } else { examined(&self.loaded, &args) };
        let found = whole(py, |()| Ok(true), work)?.map_err(|error| self.refused(error))?;
        found.sentences().iter().try_for_each(|words| warn(py, &self.told(words)))?;
        if refuse {
            self.read.lock().unwrap_or_else(PoisonError::into_inner).passed = Some(args.accept);
        }
        Ok(())
    }

    fn doubt_yaw_rate(&self, py: Python<'_>, runs: &[Run]) -> PyResult<()> {
        self.loaded.yaw_rate_doubt(Runs::from(runs)).map_or(Ok(()), |words| warn(py, &words))
    }

    fn settings(&self, given: &Settings<'_, '_>) -> PyResult<trimtab::FitSettings> {
        given.over(self.loaded.fit_settings().map_err(Raised::raised)?)
    }
}

#[pymethods]
impl Study {
    /// Reads a study file with its ship and model; everything that is wrong with them is reported at once. A folder stands for its
    /// `study.toml`. `model` is a model file to use instead of the study's, such as `fitted.toml`.
    #[staticmethod]
    #[pyo3(signature = (path, *, model=None, _folder=None, _imported=false))]
    fn load(
        py: Python<'_>,
        path: PathBuf,
        model: Option<PathBuf>,
        _folder: Option<Py<PyAny>>,
        _imported: bool,
    ) -> PyResult<Self> {
        let path = if path.is_dir() { path.join("study.toml") } else { path };
        let args = StudyArgs { study: path.clone(), model: model.clone() };
        let study = trimtab::Study::read(&path).map_err(Raised::raised)?;
        let loaded = Loaded::read(&args, study).map_err(Raised::raised)?;
        loaded.unreached().iter().try_for_each(|words| warn(py, words))?;
        let (_, uncertainty) = loaded.uncertainty().map_err(Raised::raised)?;
        let own = Py::new(py, Model::of(loaded.model.clone(), uncertainty))?;
        let (read, folder, imported) = (Mutex::default(), _folder, _imported);
        Ok(Self { loaded, path, model_path: model, model: own, read, folder, imported })
    }

    /// A study from tables in memory: a DataFrame of pandas, a dictionary of columns, or a dictionary of name and table.
    ///
    /// The tables are imported like logs (see `import_log`, which has the arguments that are not named here): columns are taken by name
    /// for t or a date, x and y or lat and lon, psi, u, v, r, n, delta and so on; `columns` says which column is which quantity, as in
    /// `{"psi": "HDT"}`, and `units` in which unit it is, as in `{"psi": "deg", "n": "rpm"}`. Each is cut into runs unless `split` is
    /// False. The study is written into `folder`, or into a temporary one that lasts as long as the study.
    #[staticmethod]
    #[pyo3(signature = (data, *, ship, units=None, columns=None, model=None, folder=None, name=None, split=true, antenna=None,
                        session_gap=None, bridge=None))]
    fn from_dataframe<'py>(
        py: Python<'py>,
        data: &Bound<'py, PyAny>,
        ship: &Bound<'py, PyAny>,
        units: Option<&Bound<'py, PyAny>>,
        columns: Option<&Bound<'py, PyAny>>,
        model: Option<&Bound<'py, PyAny>>,
        folder: Option<&Bound<'py, PyAny>>,
        name: Option<&Bound<'py, PyAny>>,
        split: bool,
        antenna: Option<&Bound<'py, PyAny>>,
        session_gap: Option<&Bound<'py, PyAny>>,
        bridge: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let arguments = PyDict::new(py);
        arguments.set_item("ship", ship)?;
        arguments.set_item("split", split)?;
        for (key, value) in [
            ("units", units),
            ("columns", columns),
            ("model", model),
            ("folder", folder),
            ("name", name),
            ("antenna", antenna),
            ("session_gap", session_gap),
            ("bridge", bridge),
        ] {
            arguments.set_item(key, value)?;
        }
        py.import("trimtab._frames")?.call_method("from_dataframe", (data,), Some(&arguments))
    }

    /// Name.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.study.name
    }

    /// The study file.
    #[getter]
    fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// The model that is fitted; what is freed, fixed or set of it counts in the calls that follow.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<Model> {
        self.model.clone_ref(py)
    }

    /// The ship.
    #[getter]
    fn ship(&self) -> PyResult<Ship> {
        Ship::of(self.loaded.model.ship.clone())
    }

    /// The runs as they are listed: records with name, file, session, manoeuvre and split. Recordings are not opened.
    #[getter]
    fn runs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let record = |run: &trimtab::study::Listed| {
            serde_json::json!({
                "name": run.labels.run, "file": run.file, "session": run.labels.session, "manoeuvre": run.labels.manoeuvre,
                "split": run.labels.split, "from": run.from, "to": run.to,
            })
        };
        document(py, &self.loaded.study.runs.iter().map(record).collect::<Vec<_>>())
    }

    /// The recordings, read and cut as the study says; `split` is "train", "test" or "all".
    #[pyo3(signature = (split="all"))]
    fn windows(&self, py: Python<'_>, split: &str) -> PyResult<Vec<Window>> {
        let runs = self.windows_of(py, Side::named(split)?)?;
        let commands: Arc<[String]> = self.loaded.model.ship.commands().into();
        let window = |index| Window { runs: Arc::clone(&runs), index, commands: Arc::clone(&commands) };
        Ok((0..runs.len()).map(window).collect())
    }

    /// Audits the recordings as `trimtab check` does (units, signs, gaps, frozen channels, clocks): records with run, severity, fault,
    /// channel, lines, text and next_step, the gravest of each run first; run is None for what concerns the study as a whole.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let audit = whole(py, |()| Ok(true), |_: &Line<()>| audit_study(&self.loaded.study, &self.loaded.model.ship))?;
        let whole_study = audit.issues.iter().map(|issue| (None, issue));
        let of_runs = audit.recordings.iter().flat_map(|a| a.issues.iter().map(|issue| (Some(&a.run), issue)));
        let mut all = Vec::new();
        for (run, issue) in whole_study.chain(of_runs) {
            all.push(serde_json::json!({
                "run": run, "severity": issue.severity, "fault": issue.fault, "channel": issue.channel,
                "lines": issue.lines, "text": issue.text, "next_step": self.told(&issue.next_step),
            }));
        }
        document(py, &all)
    }

    /// Fits the free parameters of the model to the training runs: nonlinear least squares through the simulation, exact gradients,
    /// under the constraints of [fit.constraints], solved by Ipopt; or by likelihood.
    ///
    /// `objective` is "trajectory" or "likelihood"; `hessian` is "gauss-newton", "exact" or "limited-memory"; `settings` has any other
    /// key of [fit], nested as there. What is None is as the study says. `progress` is called with a FitProgress once an iteration;
    /// the fit stops when it returns False, or at Ctrl-C, and gives the best point so far (`interrupted` is then True).
    /// A fit that does not converge is a result: `converged` is False, and `status` says why.
    // The others are taken only to be refused: the signature that Python shows has none.
    #[pyo3(signature = (*, model=None, objective=None, hessian=None, tolerance=None, max_iterations=None, max_seconds=None,
                        settings=None, accept=Words::default(), progress=None, **others),
           text_signature = "($self, /, *, model=None, objective=None, hessian=None, tolerance=None, max_iterations=None, \
                             max_seconds=None, settings=None, accept=..., progress=None)")]
    fn fit(
        &self,
        py: Python<'_>,
        model: Option<&Model>,
        objective: Option<&str>,
        hessian: Option<&str>,
        tolerance: Option<f64>,
        max_iterations: Option<i128>,
        max_seconds: Option<f64>,
        settings: Option<&Bound<'_, PyDict>>,
        accept: Words,
        progress: Option<Py<PyAny>>,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Fit> {
        no_others("Study.fit", others, &OF_FIT)?;
        let none = FitSettings { max_iterations: 0, ..FitSettings::default() };
        let max_iterations = max_iterations.map(|given| counted(given, &none)).transpose()?;
        let given = Settings { objective, hessian, tolerance, max_iterations, max_seconds, more: settings };
        let settings = self.settings(&given)?;
        self.audit(py, accept, true)?;
        let runs = self.windows_of(py, Side::Train)?;
        self.doubt_yaw_rate(py, &runs)?;
        let model = self.chosen(model).model;
        run(py, &model, &runs, &settings, progress, |error| self.loaded.of_fit(error).raised())
    }

    /// What a fit minimises, as a function with exact derivatives for an optimiser of one's own: see Objective.
    ///
    /// `objective` is "trajectory" or "likelihood", and as the study says without; `split` says which runs it is of. `prior_weight` is the
    /// weight w of the priors: without, 1/2 in a likelihood, and in a trajectory cost what a fit gives them at its start (a fit sets it
    /// anew from its residuals: `Fit.prior_weight`). In a likelihood the coefficients of hull, propeller and rudder that are never known
    /// exactly are free too, with priors, as in a fit; `uncertain=False` leaves them where they are. `settings` has keys of [fit].
    #[pyo3(signature = (*, model=None, split="train", prior_weight=None, objective=None, uncertain=true, settings=None,
                        accept=Words::default()))]
    fn objective(
        slf: &Bound<'_, Self>,
        model: Option<&Model>,
        split: &str,
        prior_weight: Option<f64>,
        objective: Option<&str>,
        uncertain: bool,
        settings: Option<&Bound<'_, PyDict>>,
        accept: Words,
    ) -> PyResult<Objective> {
        let (py, own) = (slf.py(), slf.get());
        let settings = own.settings(&Settings { objective, more: settings, ..Settings::default() })?;
        let side = Side::named(split)?;
        own.audit(py, accept, true)?;
        let runs = own.windows_of(py, side)?;
        own.doubt_yaw_rate(py, &runs)?;
        let model = own.chosen(model).model;
        let wanted = Wanted { model, settings, side, weight: prior_weight, uncertain };
        Objective::new(py, slf.clone().unbind(), wanted, runs, None)
    }

    /// How well a model predicts runs beside a baseline, with 95 % intervals over runs: see Evaluation.
    ///
    /// `model` is the study's without; `baseline` a Model, or that of the study's [evaluate], or else the study's model as it was read.
    #[pyo3(signature = (*, model=None, baseline=None, split="all", accept=Words::default()))]
    fn evaluate(
        &self,
        py: Python<'_>,
        model: Option<&Model>,
        baseline: Option<&Model>,
        split: &str,
        accept: Words,
    ) -> PyResult<Evaluation> {
        self.audit(py, accept, true)?;
        let runs = self.windows_of(py, Side::named(split)?)?;
        let model = self.chosen(model).model;
        let baseline = match baseline {
            Some(baseline) => baseline.snapshot().model,
            None => crate::cli::evaluate::baseline(&self.loaded, None).map_err(Raised::raised)?,
        };
        let inner = whole(py, |()| Ok(true), |_: &Line<()>| judge(&self.loaded, &baseline, &model, &runs))?;
        Ok(Evaluation { inner: inner.map_err(Raised::raised)? })
    }

    /// Names the physics that the model lacks, with its size, and proves the gain on runs that no earlier step has used: see Diagnosis.
    ///
    /// `repeat` repeats the analysis on the recordings turned, mirrored, cut, thinned and with other start values, to see whether what it
    /// names is stable (five to seven times as long), `once` does not, whatever the study says; `withhold` names mechanisms that must not be
    /// considered; `progress` is called with each step in words, and its False ends the diagnosis.
    #[pyo3(signature = (*, model=None, repeat=false, once=false, withhold=Words::default(), seed=None, accept=Words::default(),
                        progress=None))]
    fn diagnose(
        &self,
        py: Python<'_>,
        model: Option<&Model>,
        repeat: bool,
        once: bool,
        withhold: Words,
        seed: Option<i128>,
        accept: Words,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Diagnosis> {
        let seed = seed.map(|given| whole_number("seed", given, SEEDS)).transpose()?;
        let asked = Asked { repeat, once, withhold: withhold.0, seed };
        let settings = asked.settings(&self.loaded)?;
        self.audit(py, accept, false)?;
        let (train, all) = (self.windows_of(py, Side::Train)?, self.read(py)?);
        let test: Vec<Run> = all.iter().filter(|run| run.split == Split::Test).cloned().collect();
        self.doubt_yaw_rate(py, &train)?;
        Diagnosis::new(py, &self.loaded, &self.chosen(model).model, &train, &test, &settings, progress)
    }

    fn __repr__(&self) -> String {
        let study = &self.loaded.study;
        format!("<Study {}: {}, {}>", study.name, self.loaded.model.ship.name, study.split_in_words())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        if self.folder.is_some() {
            return Err(PyTypeError::new_err(
                "a study in a temporary folder cannot be pickled; give Study.from_dataframe a `folder` that stays",
            ));
        }
        let absolute = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let arguments = (absolute(&self.path), self.model_path.as_ref().map(absolute), self.model.clone_ref(py));
        Ok((py.get_type::<Self>().getattr("_restore")?, arguments.into_pyobject(py)?))
    }

    /// A study from what a pickle keeps of it.
    #[staticmethod]
    fn _restore(py: Python<'_>, path: PathBuf, model_path: Option<PathBuf>, model: Py<Model>) -> PyResult<Self> {
        Ok(Self { model, ..Self::load(py, path, model_path, None, false)? })
    }
}
