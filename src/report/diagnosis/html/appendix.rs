//! The last sections of the page: words, ship, data with their dates and checksums, and the command that made it.
//! They identify what was diagnosed; nothing in them depends on the answer.

use crate::diagnose::Diagnosis;
use crate::numerals::sig;
use crate::report::html::Section;
use crate::report::table::Table;
use maud::html;
use std::collections::BTreeMap;

/// Files listed one by one.
const MOST_FILES: usize = 400;

/// Where a diagnosis comes from: the command and the files that it read.
#[derive(Clone, Debug, Default)]
pub struct Provenance {
    /// The command line.
    pub command: String,
    /// What to run after a diagnosis, and why; nothing where no model was improved.
    pub next: Option<(String, Vec<String>)>,
    /// The files.
    pub files: Vec<SourceFile>,
    /// What the audit of the recordings reports, a sentence each; absent where none was made.
    pub doubts: Option<Vec<String>>,
}

/// A file that was read.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Its path as it was given.
    pub path: String,
    /// Date and time of its last change, UTC; absent where the system does not report it.
    pub changed: Option<String>,
    /// Its SHA-256; absent where it could not be read twice.
    pub sha256: Option<String>,
}

/// Words of the page with their meaning.
const GLOSSARY: [(&str, &str); 15] = [
    (
        "base model",
        "the model of the study with its own parameters fitted anew to the training runs, without any finding",
    ),
    ("improved model", "the base model with the findings added and everything refitted; improved.toml"),
    ("finding", "a mechanism that the recordings show and the base model lacks, or an error of a sensor"),
    ("mechanism", "a named physical effect or sensor error of the catalogue (`trimtab terms` lists them)"),
    (
        "confirmed",
        "unseen recordings are better with the finding by log-likelihood or by free simulation (the 95 % interval of the gain is above zero), not worse by the other, and every repetition of the analysis finds it",
    ),
    ("suspected", "the training runs support the finding, and unseen recordings do not decide or are missing"),
    ("test run, unseen recording", "a run that only the proof uses: no step before has seen it"),
    (
        "free simulation",
        "motion computed from the first recorded state and the recorded rudder and propeller, never corrected by later measurements",
    ),
    (
        "cVDM",
        "combined variable distance metric: the mean deviation of position, heading, speeds and yaw rate in one number, percent of the size of the motion",
    ),
    (
        "unknown force",
        "the force that would have to act beside the model so that it follows the recordings, as a Kalman filter estimates it: X forward [N], Y to starboard [N], N turning to starboard [N m]",
    ),
    (
        "p-value",
        "the probability of at least such evidence if nothing were missing, corrected for the number of mechanisms tested",
    ),
    ("95 % interval", "contains the true value in 95 of 100 such studies, if the assumptions of the analysis are true"),
    ("standard error, s.e.", "standard deviation of an estimate"),
    (
        "log-likelihood",
        "how probable the recordings are under a model; a gain of 2 or more for a parameter is worth noting",
    ),
    ("session", "recordings that share conditions, such as a day's weather"),
];

/// The glossary.
pub(in crate::report::diagnosis) fn glossary() -> Section {
    Section::new("Words").markup(html! { dl { @for (word, meaning) in GLOSSARY { dt { (word) } dd { (meaning) } } } })
}

/// The ship's particulars.
pub(in crate::report::diagnosis) fn ship(d: &Diagnosis) -> Section {
    let (ship, hull) = (&d.base.ship, &d.base.ship.hull);
    let mut table = Table::new(["particular", "value", "unit"]);
    let rows = [
        ("length between perpendiculars L", hull.lpp, "m"),
        ("breadth B", hull.breadth, "m"),
        ("draught d", hull.draught, "m"),
        ("mass m", hull.mass / 1e3, "t"),
        ("block coefficient C_b", hull.block_coefficient, "-"),
        ("longitudinal centre of gravity x_G, forward of midship", hull.x_g, "m"),
        ("density of water", hull.water_density, "kg/m3"),
        ("propeller diameter D", ship.propeller.diameter, "m"),
    ];
    for (name, value, unit) in rows {
        table.row([name.to_owned(), sig(value, 4), unit.to_owned()]);
    }
    let source = if ship.source.is_empty() { "The ship file names no source." } else { ship.source.as_str() };
    let terms = format!("Base model `{}`, terms: {}.", d.base.name, d.base.term_names().join(", "));
    Section::new("Ship and model").text(&format!("{}. {source}", ship.name)).text(&terms).table(&table, "")
}

/// Sessions with their runs, and the files with dates and checksums.
pub(in crate::report::diagnosis) fn data(d: &Diagnosis, from: &Provenance) -> Section {
    let mut section = Section::new("Data");
    let mut sessions: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for t in &d.traces {
        let entry = sessions.entry(t.session.as_str()).or_default();
        entry.0 += 1;
        entry.1 += t.time.last().zip(t.time.first()).map_or(0.0, |(b, a)| b - a);
    }
    let mut table = Table::new(["session", "training runs", "minutes"]);
    for (name, (runs, seconds)) in sessions {
        table.row([if name.is_empty() { "(one)" } else { name }.to_owned(), runs.to_string(), sig(seconds / 60.0, 3)]);
    }
    section = section.table(&table, "Training runs that the analysis used.");
    section = match from.doubts.as_deref() {
        None => section,
        Some([]) => section.text("The audit of the recordings found neither errors nor warnings."),
        Some(doubts) => section.text("The audit of the recordings found:").list(doubts),
    };
    let mut files = Table::new(["file", "last change (UTC)", "SHA-256"]);
    for f in from.files.iter().take(MOST_FILES) {
        let or_dash = |text: &Option<String>| text.clone().unwrap_or_else(|| crate::numerals::DASH.to_owned());
        files.row([f.path.clone(), or_dash(&f.changed), or_dash(&f.sha256)]);
    }
    if from.files.is_empty() {
        return section;
    }
    let caption = if from.files.len() > MOST_FILES {
        format!("{MOST_FILES} of {} files; manifest.json has all of them.", from.files.len())
    } else {
        format!("All {} files that were read.", from.files.len())
    };
    section.markup(html! {
        details {
            summary { "Files with dates and checksums (" (from.files.len()) ")" }
            div.scroll { table {
                caption { (caption) }
                thead { tr { @for cell in files.header() { th { (cell) } } } }
                tbody { @for row in files.rows() { tr { @for cell in row { td { span.digest { (cell) } } } } } }
            } }
        }
    })
}

/// The command, the version and the settings that decide.
pub(in crate::report::diagnosis) fn command(d: &Diagnosis, from: &Provenance) -> Section {
    let s = &d.settings;
    let withheld = if s.withhold.is_empty() { String::new() } else { format!(" Withheld: {}.", s.withhold.join(", ")) };
    let section = Section::new("Command and version").text(&format!(
        "trimtab {}; chance of naming anything when nothing is missing (alpha) {}; at most {} mechanisms; seed {}.{withheld}",
        env!("CARGO_PKG_VERSION"),
        s.alpha,
        s.most,
        s.seed
    ));
    if from.command.is_empty() {
        return section;
    }
    section.markup(html! { p { code { (from.command) } } })
}
