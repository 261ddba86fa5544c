//! Makes a case from its plan: reads the recordings, gives them as the configuration says, injects, and writes study and seal.
//! In the study only recorded values depend on what is injected, not even a file name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use toml::Value;

use super::configuration::{Configuration, Sessions, Wind, change};
use super::error::InjectedError;
use super::operation::without_wind;
use super::plan::{Kind, Planned};
use super::record::{Column, Record};
use super::seal::{Manifest, Witness, write_sealed};
use super::set::Listed;

/// Keys of the committed study that a case keeps, with the power of time by which they grow under Froude's law.
const KEPT: [(&str, i32); 4] = [("discard_start", 1), ("discard_end", 1), ("initial_state", 0), ("initial_span", 1)];

/// Where the origins of positions \[m\] and of time \[s\] are moved to.
const ORIGIN: [f64; 2] = [1234.5, -678.9];
const TIME: f64 = 10_000.0;

/// One recording of a case.
struct Run {
    /// Its place in the committed study.
    run: usize,
    listed: Listed,
    session: String,
    unseen: bool,
    record: Record,
}

impl Configuration {
    /// A recording as this configuration gives it.
    fn given(&self, record: &mut Record, run: usize) {
        record.turn(self.angle(run));
        if self.mirrored {
            record.mirror();
        }
        if self.moved[0] {
            record.shift_origin(ORIGIN[0], ORIGIN[1]);
        }
        if self.moved[1] {
            record.shift_time(TIME);
        }
    }

    /// First and last time used of a recording \[s\]; `None` for all of it.
    fn used(&self, record: &Record) -> Option<[f64; 2]> {
        let t = &record[Column::T];
        let (first, last) = (*t.first()?, *t.last()?);
        (self.span != [0.0, 1.0]).then(|| self.span.map(|share| first + share * (last - first)))
    }

    /// The study file.
    fn study(&self, runs: &[Run]) -> Result<toml::Table, InjectedError> {
        let committed = self.set.study()?;
        let time = self.scale.sqrt();
        let mut study = toml::Table::new();
        let mut put = |key: &str, value: Value| {
            study.insert(key.to_owned(), value);
        };
        put("name", "case".into());
        put("ship", "ship.toml".into());
        put("model", "model.toml".into());
        put("gaps", "split".into());
        put("step", Value::Float(self.step * time));
        if let Some(window) = self.window {
            put("window", Value::Float(window * time));
        }
        for (key, power) in KEPT {
            let Some(value) = committed.get(key) else { continue };
            put(key, value.as_float().map_or_else(|| value.clone(), |v| Value::Float(v * time.powi(power))));
        }
        let mut list: Vec<Value> = runs.iter().flat_map(|r| self.entries(r)).map(Value::Table).collect();
        if self.reversed {
            list.reverse();
        }
        put("runs", Value::Array(list));
        if let Some(mut fit) = committed.get("fit").and_then(Value::as_table).cloned() {
            change(&mut fit, &["max_yaw_rate"], |v| v / time);
            change(&mut fit, &["constraints", "resistance", "upper"], |v| v * self.scale * self.scale);
            put("fit", Value::Table(fit));
        }
        Ok(study)
    }

    /// The entries of a recording in the study: one, or one for each half.
    fn entries(&self, run: &Run) -> Vec<toml::Table> {
        let name = Self::run_name(run.run);
        let entry = |name: String, times: Option<[f64; 2]>| {
            let mut entry = toml::Table::new();
            entry.insert("file".to_owned(), file_name(run.run).into());
            entry.insert("name".to_owned(), name.into());
            entry.insert("manoeuvre".to_owned(), run.listed.manoeuvre.clone().into());
            entry.insert("split".to_owned(), if run.unseen { "test" } else { "train" }.into());
            // The halves of a recording share what is unknown of it.
            if self.sessions != Sessions::None || self.cut {
                entry.insert("session".to_owned(), run.session.clone().into());
            }
            if let Some([from, to]) = times {
                entry.insert("from".to_owned(), Value::Float(from));
                entry.insert("to".to_owned(), Value::Float(to));
            }
            entry
        };
        let used = self.used(&run.record);
        let t = &run.record[Column::T];
        let Some([from, to]) = used.or_else(|| Some([*t.first()?, *t.last()?])).filter(|_| self.cut) else {
            return vec![entry(name, used)];
        };
        let middle = 0.5 * (from + to);
        vec![entry(format!("{name} a"), Some([from, middle])), entry(format!("{name} b"), Some([middle, to]))]
    }
}

fn file_name(run: usize) -> String {
    format!("run_{:02}.csv", run + 1)
}

impl Planned {
    /// The recordings of the case before anything is injected.
    fn runs(&self) -> Result<Vec<Run>, InjectedError> {
        let c = &self.configuration;
        let listed = c.set.runs()?;
        let mut runs = Vec::new();
        for (place, run) in c.runs.iter().enumerate() {
            let Some(listed) = listed.get(*run) else { continue };
            let mut record = c.set.read(&listed.file)?;
            c.given(&mut record, *run);
            runs.push(Run {
                run: *run,
                session: c.session(place, listed.session.as_deref()),
                unseen: c.is_unseen(listed.test),
                listed: listed.clone(),
                record,
            });
        }
        Ok(runs)
    }

    /// Sessions in which the injections act; empty for all.
    fn acting(&self, runs: &[Run]) -> Vec<String> {
        if !self.partial {
            return Vec::new();
        }
        let mut sessions: Vec<String> = Vec::new();
        for run in runs.iter().filter(|r| !r.unseen).chain(runs) {
            if !sessions.contains(&run.session) {
                sessions.push(run.session.clone());
            }
        }
        // A mistake is made in one session; an effect acts in every other one.
        let every = if self.kind == Kind::Mistake { sessions.len() } else { 2 };
        sessions.into_iter().step_by(every.max(1)).collect()
    }

    /// Makes the case in a folder and gives the study file.
    ///
    /// # Errors
    /// [`InjectedError::NoData`] without the recordings, [`InjectedError::Case`] if a file cannot be read or written.
    pub fn make(&self, folder: &Path) -> Result<PathBuf, InjectedError> {
        let c = &self.configuration;
        let mut runs = self.runs()?;
        let sessions = self.acting(&runs);
        for run in &mut runs {
            if sessions.is_empty() || sessions.contains(&run.session) {
                for injection in &self.injections {
                    injection.operation.apply(&mut run.record, run.run);
                }
            }
            run.record.scale(c.scale);
        }
        let winds = witnesses(&runs);
        if c.wind == Wind::Withheld {
            runs.iter_mut().for_each(|r| without_wind(&mut r.record));
        }
        let mut files = vec![
            ("ship.toml".to_owned(), text(&c.ship()?)?),
            ("model.toml".to_owned(), text(&c.model()?)?),
            ("study.toml".to_owned(), text(&c.study(&runs)?)?),
        ];
        files.extend(runs.iter().map(|r| (file_name(r.run), r.record.csv())));
        let manifest = Manifest {
            case: self.key.clone(),
            kind: self.kind.name().to_owned(),
            set: c.set,
            injections: self.injections.clone(),
            sessions,
            winds,
            files: BTreeMap::new(),
        };
        write_sealed(folder, &files, manifest)
    }
}

fn text(table: &toml::Table) -> Result<String, InjectedError> {
    toml::to_string(table).map_err(|e| InjectedError::content(Path::new("a file of the case"), &e))
}

/// The mean wind of each session over its training recordings.
fn witnesses(runs: &[Run]) -> Vec<Witness> {
    let mut sums: BTreeMap<&str, ([f64; 2], f64)> = BTreeMap::new();
    for run in runs.iter().filter(|r| !r.unseen) {
        let Some(wind) = run.record.mean_wind() else { continue };
        let (rows, sum) = (run.record.len() as f64, sums.entry(run.session.as_str()).or_default());
        sum.1 += rows;
        for (s, w) in sum.0.iter_mut().zip(wind) {
            *s += rows * w;
        }
    }
    let mean = |(session, (sum, rows)): (&str, ([f64; 2], f64))| Witness {
        session: session.to_owned(),
        wind: sum.map(|s| s / rows),
    };
    sums.into_iter().map(mean).collect()
}
