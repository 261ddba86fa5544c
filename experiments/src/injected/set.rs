//! The sets of real recordings: where they are, their layout as text, and the sizes against which injections are graded.
//! It reads tables of numbers; what the studies of these ships say is read from the committed files.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::InjectedError;
use super::record::{COLUMNS, Column, Record, unwrap};

/// A set of recordings of one ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Set {
    /// KVLCC2 at MARIN, full scale: zigzags and turning circles in a calm basin.
    Marin,
    /// KVLCC2 at HSVA, the 7 m model: zigzags in a calm basin.
    Hsva,
    /// Esso Osaka, the 3 m model on a pond with wind.
    Esso,
}

/// Every set.
pub const SETS: [Set; 3] = [Set::Marin, Set::Hsva, Set::Esso];

/// One recording of a set, as its study lists it.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// File below the folder of the set.
    pub file: String,
    /// Kind of manoeuvre.
    pub manoeuvre: String,
    /// Session, where the study gives one.
    pub session: Option<String>,
    /// Whether the study tests on it.
    pub test: bool,
}

/// What is known of a set beside its recordings.
#[derive(Debug, Clone, Copy)]
pub struct Facts {
    /// Name in keys.
    pub name: &'static str,
    /// Folder below the folder of the data.
    pub folder: &'static str,
    /// The committed study, its ship and its models.
    pub study: &'static str,
    /// Ship file.
    pub ship: &'static str,
    /// Model with the hull freed.
    pub freed: &'static str,
    /// Length of the ship \[m\].
    pub length: f64,
    /// Speed of approach \[m/s\].
    pub speed: f64,
    /// Fastest turn \[rad/s\].
    pub turn: f64,
    /// Time between two rows \[s\].
    pub row: f64,
    /// Grid steps of an analysis \[s\], the study's second.
    pub steps: &'static [f64],
    /// Mechanisms that the recordings carry by themselves: what is known of them without a model.
    pub carried: &'static [&'static str],
    /// Whether there was no wind, no current and no wave.
    pub calm: bool,
    /// Whether the recorded rudder angle is measured, not ordered.
    pub rudder_measured: bool,
}

/// Time between two rows of MARIN's recordings \[s\].
const MARIN_ROW: f64 = 0.1353;

/// What Esso Osaka's recordings carry: any name for the weather of the pond may be right, velocities lag the positions, and rudder and
/// propeller are recorded as ordered (in every run the rudder leaps by up to 60 deg and the propeller by 8 to 20 rps in 0.1 s), so that the
/// steering gear and the engine are missing.
const CARRIED_BY_ESSO: [&str; 11] = [
    "time_skew",
    "mean_wind",
    "wind",
    "wave_drift",
    "current",
    "earth_force",
    "tide",
    "water_log",
    "rudder_lag",
    "rudder_rate",
    "engine_lag",
];

impl Set {
    /// What is known of it.
    pub fn facts(self) -> Facts {
        match self {
            Self::Marin => Facts {
                name: "marin",
                folder: "kvlcc2_marin",
                study: include_str!("../../studies/kvlcc2/study.toml"),
                ship: include_str!("../../studies/kvlcc2/kvlcc2.toml"),
                freed: include_str!("../../studies/kvlcc2/freed.toml"),
                length: 320.0,
                speed: 8.0,
                turn: 0.0122,
                row: MARIN_ROW,
                steps: &[1.0, 2.0, 3.0, 4.0],
                // The heading leads the yaw rate by 0.26 s in every recording, positions are rounded to three digits, and in the turning
                // circles track and velocities agree for a point 11.0 and 11.2 m aft of that of the velocities, midship and centre of
                // gravity being 11.2 m apart (`diagnose_kvlcc2` prints them).
                carried: &["time_skew", "yaw_rate_bias", "position_lever"],
                calm: true,
                rudder_measured: true,
            },
            Self::Hsva => Facts {
                name: "hsva",
                folder: "kvlcc2_hsva",
                study: include_str!("../../studies/kvlcc2_hsva/study.toml"),
                ship: include_str!("../../studies/kvlcc2_hsva/kvlcc2_7m.toml"),
                freed: include_str!("../../studies/kvlcc2_hsva/freed.toml"),
                length: 7.0,
                speed: 1.18,
                turn: 0.0826,
                row: 0.05,
                steps: &[0.1, 0.25, 0.4, 0.5, 0.6],
                carried: &[],
                calm: true,
                rudder_measured: true,
            },
            Self::Esso => Facts {
                name: "esso",
                folder: "esso_osaka",
                study: include_str!("../../studies/esso_osaka/study.toml"),
                ship: include_str!("../../studies/esso_osaka/esso_osaka.toml"),
                freed: include_str!("../../studies/esso_osaka/freed.toml"),
                length: 3.0,
                speed: 0.35,
                turn: 0.1,
                row: 0.1,
                steps: &[0.4, 0.5, 1.0],
                carried: &CARRIED_BY_ESSO,
                calm: false,
                rudder_measured: false,
            },
        }
    }

    /// Name in keys.
    pub fn name(self) -> &'static str {
        self.facts().name
    }

    /// The set of that name.
    pub fn named(name: &str) -> Option<Self> {
        SETS.into_iter().find(|s| s.name() == name)
    }

    /// Time in which the ship moves on by its length at the speed of approach \[s\].
    pub fn time(self) -> f64 {
        let facts = self.facts();
        facts.length / facts.speed
    }

    /// Length of the windows of the committed study \[s\].
    ///
    /// # Errors
    /// [`InjectedError::Case`] if the study is no TOML.
    pub fn window(self) -> Result<f64, InjectedError> {
        Ok(self.study()?.get("window").and_then(toml::Value::as_float).unwrap_or(5.0 * self.time()))
    }

    /// The committed study as a table.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if it is no TOML.
    pub fn study(self) -> Result<toml::Table, InjectedError> {
        table(self.facts().study, &format!("study of {}", self.name()))
    }

    /// The recordings that the study lists, in its order.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if the list is not as expected.
    pub fn runs(self) -> Result<Vec<Listed>, InjectedError> {
        if self == Self::Esso {
            return listed_in_csv(include_str!("../../studies/esso_osaka/runs.csv"));
        }
        let study = self.study()?;
        let runs = study.get("runs").and_then(toml::Value::as_array).map(Vec::as_slice).unwrap_or_default();
        let text = |run: &toml::Value, key: &str| run.get(key).and_then(toml::Value::as_str).map(str::to_owned);
        let listed = |run: &toml::Value| Listed {
            file: text(run, "file").unwrap_or_default(),
            manoeuvre: text(run, "manoeuvre").unwrap_or_default(),
            session: text(run, "session"),
            test: text(run, "split").as_deref() == Some("test"),
        };
        Ok(runs.iter().map(listed).collect())
    }

    /// The folder of the recordings: below `$TRIMTAB_DATA`, or below `shared/data` beside the checkout.
    ///
    /// # Errors
    /// [`InjectedError::NoData`].
    pub fn folder(self) -> Result<PathBuf, InjectedError> {
        let folder = self.facts().folder;
        let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
        let roots = std::env::var_os("TRIMTAB_DATA").map(PathBuf::from).into_iter().chain([beside]);
        let tried: Vec<PathBuf> = roots.map(|root| root.join(folder)).collect();
        let found = tried.iter().find(|path| path.is_dir()).cloned();
        found.ok_or(InjectedError::NoData { folder, tried })
    }

    /// Reads one recording.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if the file is absent or not laid out as expected.
    pub fn read(self, file: &str) -> Result<Record, InjectedError> {
        let path = self.folder()?.join(file);
        let bytes = std::fs::read(&path).map_err(|source| InjectedError::file(&path, source))?;
        // The titles of HSVA are no UTF-8.
        self.parse(&String::from_utf8_lossy(&bytes)).ok_or_else(|| {
            InjectedError::content(
                &path,
                &"not laid out as the recordings of this set are; compare it with the original",
            )
        })
    }

    /// Reads a table in the layout of the set.
    fn parse(self, text: &str) -> Option<Record> {
        let mut record = match self {
            Self::Marin => numbers(text, 3, Some('\t'), &MARIN)?,
            Self::Hsva => numbers(text, 4, None, &HSVA)?,
            Self::Esso => numbers(text, 1, Some(','), &ESSO)?,
        };
        if self == Self::Marin {
            // Printed with three digits: rebuilt from the step.
            record[Column::T] = (0..record.len()).map(|row| MARIN_ROW * row as f64).collect();
        }
        // Rows of a logger that had stopped have no time either.
        let timed: Vec<bool> = record[Column::T].iter().map(|t| t.is_finite()).collect();
        record.retain(|row| timed[row]);
        unwrap(&mut record[Column::Psi]);
        if self != Self::Esso {
            // Velocities are earth-fixed.
            for row in 0..record.len() {
                let (sin, cos) = record[Column::Psi][row].sin_cos();
                let (north, east) = (record[Column::U][row], record[Column::V][row]);
                record[Column::U][row] = north * cos + east * sin;
                record[Column::V][row] = east * cos - north * sin;
            }
        }
        (!record.is_empty()).then_some(record)
    }
}

/// A text as TOML.
pub(super) fn table(text: &str, what: &str) -> Result<toml::Table, InjectedError> {
    toml::from_str(text).map_err(|e| InjectedError::content(Path::new(what), &e))
}

fn listed_in_csv(text: &str) -> Result<Vec<Listed>, InjectedError> {
    let fail = |e: csv::Error| InjectedError::content(Path::new("runs.csv"), &e);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let mut runs = Vec::new();
    for row in reader.records() {
        let row = row.map_err(fail)?;
        let cell = |i: usize| row.get(i).unwrap_or_default().to_owned();
        runs.push(Listed { file: cell(0), session: Some(cell(1)), manoeuvre: cell(2), test: cell(3) == "test" });
    }
    Ok(runs)
}

/// One radian in degrees, inverted.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Column in the file, counted from 0, and factor to SI.
type Layout = [(Column, usize, f64)];

const MARIN: [(Column, usize, f64); 9] = [
    (Column::T, 0, 1.0),
    (Column::X, 1, 1.0),
    (Column::Y, 2, 1.0),
    (Column::Psi, 4, DEGREE),
    (Column::U, 5, 1.0),
    (Column::V, 6, 1.0),
    (Column::R, 8, DEGREE),
    (Column::Delta, 9, -DEGREE),
    (Column::N, 10, 1.0 / 60.0),
];

const HSVA: [(Column, usize, f64); 9] = [
    (Column::T, 0, 1.0),
    (Column::X, 1, 1.0),
    (Column::Y, 2, 1.0),
    (Column::Psi, 3, DEGREE),
    (Column::U, 4, 1.0),
    (Column::V, 5, 1.0),
    (Column::R, 6, DEGREE),
    (Column::Delta, 8, -DEGREE),
    (Column::N, 9, 1.0),
];

const ESSO: [(Column, usize, f64); 13] = [
    (Column::T, 0, 1.0),
    (Column::X, 1, 1.0),
    (Column::U, 2, 1.0),
    (Column::Y, 3, 1.0),
    (Column::V, 4, 1.0),
    (Column::Psi, 5, 1.0),
    (Column::R, 6, 1.0),
    (Column::N, 7, 1.0),
    (Column::Delta, 8, 1.0),
    (Column::ApparentSpeed, 9, 1.0),
    (Column::ApparentFrom, 10, 1.0),
    (Column::WindSpeed, 11, 1.0),
    (Column::WindFrom, 12, 1.0),
];

/// The columns of a text after some lines of titles; blank lines are left out, blank fields are NaN.
fn numbers(text: &str, titles: usize, delimiter: Option<char>, layout: &Layout) -> Option<Record> {
    let mut record = Record::default();
    for line in text.lines().skip(titles).filter(|l| !l.trim().is_empty()) {
        let fields: Vec<&str> = match delimiter {
            Some(delimiter) => line.split(delimiter).collect(),
            None => line.split_whitespace().collect(),
        };
        for (column, index, factor) in layout {
            let field = fields.get(*index)?.trim();
            let value: f64 = if field.is_empty() { f64::NAN } else { field.parse().ok()? };
            record[*column].push(factor * value);
        }
    }
    debug_assert!(COLUMNS.iter().all(|c| record[*c].is_empty() || record[*c].len() == record.len()));
    Some(record)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn studies_list_their_recordings_on_both_sides_of_the_split() {
        let counts = SETS.map(|set| {
            let runs = set.runs().unwrap();
            (runs.iter().filter(|r| !r.test).count(), runs.iter().filter(|r| r.test).count())
        });
        assert_eq!(counts, [(4, 2), (9, 4), (14, 6)]);
        assert!(Set::Esso.runs().unwrap().iter().all(|r| r.session.is_some() && !r.manoeuvre.is_empty()));
    }

    #[test]
    fn layouts_are_read_in_si_units_with_body_velocities_and_the_rudder_to_starboard() {
        let marin = "MARIN\nzigzag\n\n0.00E+00\t1.0E+00\t2.0E+00\t0\t9.0E+01\t0.0E+00\t8.0E+00\t0\t1.8E+01\t1.0E+01\t6.0E+01\n\
                     1.35E-01\t1.0E+00\t3.0E+00\t0\t9.0E+01\t0.0E+00\t8.0E+00\t0\t1.8E+01\t1.0E+01\t6.0E+01\n\n";
        let record = Set::Marin.parse(marin).unwrap();
        assert_eq!((record.len(), record[Column::T][1]), (2, 0.1353));
        // Eastward on heading east.
        assert!((record[Column::U][0] - 8.0).abs() < 1e-12 && record[Column::V][0].abs() < 1e-12);
        assert!((record[Column::Delta][0] + 10.0 * DEGREE).abs() < 1e-12 && (record[Column::N][0] - 1.0).abs() < 1e-12);
        let hsva = " a\n b\n c\n d\n .05 1.5 -.25 90.0 .0 1.2 .5 .01 -10.0 10.2 41. 1.\n";
        let record = Set::Hsva.parse(hsva).unwrap();
        assert!((record[Column::U][0] - 1.2).abs() < 1e-12 && (record[Column::Y][0] + 0.25).abs() < 1e-12);
        let esso = "header\n0.0,1,0.3,2,0.1,3,,10,0.2,1,2,3,4\n,,,,,,,,,,,,\n";
        let record = Set::Esso.parse(esso).unwrap();
        assert_eq!(record.len(), 1);
        assert!(record[Column::R][0].is_nan());
        assert_eq!((record[Column::U][0], record[Column::Y][0], record[Column::WindFrom][0]), (0.3, 2.0, 4.0));
        assert!(Set::Esso.parse("header\n0.0,1\n").is_none() && Set::Hsva.parse("").is_none());
    }
}
