//! Writes a case: the study that the diagnosis may see, and the manifest that it may not see, sealed with SHA-256.
//! In the study only recorded values and channels depend on the concealed effects, not even a file name.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::case::Case;
use super::effects::effect::{Class, Compare};
use super::effects::hull::THRUSTER;
use super::error::ConcealError;
use super::family::Family;
use super::sailing::craft::LENGTH;
use super::sailing::sail::Active;
use super::sailing::track::PERIOD;
use super::spec::Spec;

/// One concealed effect, as the judge reads it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Name of the effect.
    pub effect: String,
    /// `force`, `sensor`, `random`, `absorbed` or `withheld`.
    pub class: String,
    /// Names of the diagnosis that are right.
    pub accepted: Vec<String>,
    /// Names that are wrong but near.
    pub near: Vec<String>,
    /// Physical size.
    pub size: f64,
    /// Its unit.
    pub unit: String,
    /// Signal-to-noise ratio reached, where it was measured.
    pub snr: Option<f64>,
    /// Its law.
    pub law: String,
    /// Sessions in which it acts.
    pub sessions: Vec<String>,
    /// True values of parameters that the diagnosis may report: (name after the dot, value, unit).
    pub parameters: Vec<(String, f64, String)>,
    /// Root mean square of its force over all runs: X, Y \[N\], N \[N m\]; absent for sensors.
    pub force: Option<[f64; 3]>,
    /// Its share by equation, X, Y, N, the moment divided by a quarter of the length; absent for sensors.
    pub equations: Option<[f64; 3]>,
    /// Runs, of those to train on, and times on the recordings' clock \[s\] in which it acts, for effects of limited duration.
    pub windows: Vec<(String, f64, f64)>,
}

/// The truth of a case, as the judge reads it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The specification.
    pub spec: Spec,
    /// The right verdict.
    pub expected: String,
    /// Names that describe the truth family itself and are no false alarm.
    pub structure: Vec<String>,
    /// The effects.
    pub answers: Vec<Answer>,
    /// Port-starboard difference of the flow straightening, where there is one ([`super::sailing::craft::Craft::asymmetry`]).
    pub asymmetry: Option<f64>,
    /// SHA-256 of every file of the study.
    pub files: BTreeMap<String, String>,
}

/// The base model that every case is given: the paper's eleven parameters.
pub(super) const MODEL: &str = "name = \"base model\"\n";

/// SHA-256 in hexadecimal.
pub fn digest(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(64);
    for byte in Sha256::digest(bytes) {
        // Writing into a String cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// Paths of the study file, the seal and the manifest in the folder of a case.
pub fn paths(folder: &Path) -> (PathBuf, PathBuf, PathBuf) {
    let study = folder.join("study");
    (study.join("study.toml"), study.join("SEAL"), folder.join("sealed").join("manifest.json"))
}

fn write(path: &Path, text: &[u8]) -> Result<(), ConcealError> {
    let fail = |source| ConcealError::file(path, source);
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(fail)?;
    }
    std::fs::write(path, text).map_err(fail)
}

fn read(path: &Path) -> Result<Vec<u8>, ConcealError> {
    std::fs::read(path).map_err(|source| ConcealError::file(path, source))
}

/// Opens a sealed manifest, if no byte of it and of the study has changed.
///
/// # Errors
/// [`ConcealError::Broken`] when a byte has changed, [`ConcealError::File`] or [`ConcealError::Content`] when a file is unreadable.
pub fn open(folder: &Path) -> Result<Manifest, ConcealError> {
    let (study, seal, manifest) = paths(folder);
    let bytes = read(&manifest)?;
    let sealed = String::from_utf8_lossy(&read(&seal)?).trim().to_owned();
    let check = |path: PathBuf, bytes: &[u8], sealed: &str| {
        let found = digest(bytes);
        if found == sealed { Ok(()) } else { Err(ConcealError::Broken { path, found, sealed: sealed.to_owned() }) }
    };
    check(manifest.clone(), &bytes, &sealed)?;
    let content: Manifest = serde_json::from_slice(&bytes)
        .map_err(|e| ConcealError::content(&manifest, &format!("not a manifest: {e}")))?;
    for (name, digest) in &content.files {
        let path = study.with_file_name(name);
        check(path.clone(), &read(&path)?, digest)?;
    }
    Ok(content)
}

fn session(index: usize) -> String {
    format!("day {}", index + 1)
}

impl Case {
    /// The files of the study by name, in the order in which they are written.
    pub fn study_files(&self) -> Vec<(String, String)> {
        let mut files = vec![
            ("ship.toml".to_owned(), ship_file(self.spec.family)),
            ("model.toml".to_owned(), MODEL.to_owned()),
            ("columns.toml".to_owned(), "bridge = 8.0\n".to_owned()),
        ];
        let mut study = String::from(
            "name = \"case\"\nship = \"ship.toml\"\nmodel = \"model.toml\"\ncolumn_map = \"columns.toml\"\ngaps = \"split\"\n",
        );
        for (i, plan) in self.recorded.plans.iter().enumerate() {
            let split = if plan.test { "test" } else { "train" };
            let _ = write!(
                study,
                "\n[[runs]]\nfile = \"{name}.csv\"\nsession = \"{session}\"\nmanoeuvre = \"{what}\"\nsplit = \"{split}\"\n",
                name = plan.name,
                session = session(plan.session),
                what = plan.manoeuvre,
            );
            files.push((format!("{}.csv", plan.name), self.csv(i)));
        }
        // The proof is judged as the recordings were made: by steps as fine as they are.
        study += "\n[fit]\nintegration = { method = \"rk4\", substeps = 1 }\n";
        files.push(("study.toml".to_owned(), study));
        files
    }

    /// One run as CSV, with the resolution of ordinary loggers; a dropped row is absent.
    fn csv(&self, run: usize) -> String {
        let (track, rows) = (&self.recorded.tracks[run], &self.recorded.rows[run]);
        // The logger's clock runs on from session to session, so that a tide is the same for all.
        let clock = self.recorded.plans[run].clock;
        let mut text = String::from("t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]");
        for (header, _) in &track.channels {
            text.push(',');
            text.push_str(header);
        }
        text.push('\n');
        for (i, row) in rows.iter().enumerate() {
            let (Some([x, y, psi, u, v, r]), Some(order)) = (row, track.orders.get(i)) else { continue };
            let _ = write!(
                text,
                "{:.1},{x:.3},{y:.3},{psi:.6},{u:.4},{v:.4},{r:.7},{:.5},{:.6}",
                clock + i as f64 * PERIOD,
                order.n,
                order.delta
            );
            for (_, values) in &track.channels {
                let _ = write!(text, ",{:.4}", values.get(i).copied().unwrap_or_default());
            }
            text.push('\n');
        }
        text
    }

    /// The truth of the case, with the digest of every file.
    pub fn manifest(&self, files: &[(String, String)]) -> Manifest {
        Manifest {
            spec: self.spec.clone(),
            expected: self.expected().to_owned(),
            structure: self.spec.family.structure().iter().map(ToString::to_string).collect(),
            answers: self.effects.iter().enumerate().map(|(i, e)| self.answer(i, e)).collect(),
            asymmetry: self.recorded.asymmetry,
            files: files.iter().map(|(name, text)| (name.clone(), digest(text.as_bytes()))).collect(),
        }
    }

    /// Mean square of an effect's force over all runs: X, Y \[N^2\], N \[N^2 m^2\].
    fn mean_square_force(&self, effect: usize) -> [f64; 3] {
        let runs = self.recorded.tracks.len().max(1) as f64;
        let mut square = [0.0; 3];
        for track in &self.recorded.tracks {
            for (sum, part) in square.iter_mut().zip(track.energy.get(effect).copied().unwrap_or_default()) {
                *sum += part / runs;
            }
        }
        square
    }

    fn answer(&self, i: usize, e: &Active) -> Answer {
        let square = self.mean_square_force(i);
        let sensor = e.entry.class == Class::Sensor;
        // A quarter of the length is about the radius of gyration: a force and a moment with equal motion count alike.
        let weighed = [square[0], square[1], square[2] / (0.25 * LENGTH).powi(2)];
        let total: f64 = weighed.iter().sum();
        let owned = |names: &[&str]| names.iter().map(ToString::to_string).collect();
        let on_clock = |(run, start, end): (usize, f64, f64)| {
            let plan = &self.recorded.plans[run];
            (plan.name.clone(), plan.clock + start, plan.clock + end)
        };
        let reported = |(name, value, unit): (&str, f64, &str)| (name.to_owned(), value, unit.to_owned());
        Answer {
            effect: e.entry.name.to_owned(),
            class: format!("{:?}", e.entry.class).to_lowercase(),
            accepted: owned(e.entry.accepted),
            near: owned(e.entry.near),
            size: e.size,
            unit: e.entry.unit.to_owned(),
            snr: self.snr.get(i).copied().flatten(),
            law: e.entry.law.to_owned(),
            sessions: (0..e.sessions.len()).filter(|s| e.sessions[*s]).map(session).collect(),
            parameters: match e.entry.compare {
                Compare::No => Vec::new(),
                Compare::Size(name) => vec![reported((name, e.size, e.entry.unit))],
                Compare::Truth => e.physics.truth().into_iter().map(reported).collect(),
            },
            force: (!sensor).then(|| square.map(f64::sqrt)),
            equations: (!sensor && total > 0.0).then(|| weighed.map(|w| w / total)),
            windows: e.windows(&self.recorded.plans).into_iter().map(on_clock).collect(),
        }
    }

    /// Writes the case into `folder`: `study/` with its `SEAL`, and `sealed/manifest.json`. Gives the study file.
    ///
    /// # Errors
    /// [`ConcealError::File`].
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ConcealError> {
        let (study, seal, sealed) = paths(folder);
        let files = self.study_files();
        for (name, text) in &files {
            write(&study.with_file_name(name), text.as_bytes())?;
        }
        let manifest =
            serde_json::to_string_pretty(&self.manifest(&files)).map_err(|e| ConcealError::content(&sealed, &e))?;
        write(&sealed, manifest.as_bytes())?;
        write(&seal, format!("{}\n", digest(manifest.as_bytes())).as_bytes())?;
        Ok(study)
    }
}

/// The family's ship file with a thruster, which every case's ship has, used or not.
pub(super) fn ship_file(family: Family) -> String {
    let [thrust, x] = THRUSTER;
    format!("{}\n[thruster]\nthrust = {thrust:.1}\nx = {x:.1}\n", family.ship_file().trim_end())
}
