//! What can be wrong with a recording or its column map, each with the place and the next step.
//! Doubts that do not prevent use are not errors: they are issues of `check`.

use super::channel::Channel;
use std::path::PathBuf;

/// Why a recording could not be read or cut into windows.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file could not be opened.
    #[error("{path}: cannot read the recording ({source}); check the path", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The column map could not be opened.
    #[error("{path}: cannot read the column map ({source}); check the path given as `column_map` in the study", path = path.display())]
    ReadMap {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file could not be written.
    #[error("{path}: cannot write the recording ({source}); check that the folder exists and is writable", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// No header or no rows.
    #[error("{path}:{line}: the recording is empty: {what}; export it again, or leave the run out of the study", path = path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// Line at which something was expected.
        line: usize,
        /// What is not there.
        what: String,
    },
    /// The column map is not usable.
    #[error("{path}:{line}: {message}", path = path.display())]
    Map {
        /// The column map.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong and what is expected.
        message: String,
    },
    /// The file is no text: a spreadsheet, or text in two bytes a letter.
    #[error("{path}: this is no plain text; export it as CSV in UTF-8 (a spreadsheet: Save as, CSV UTF-8)", path = path.display())]
    NoText {
        /// The file.
        path: PathBuf,
    },
    /// The header is one field because the file has another delimiter than the map says.
    #[error("{path}:{line}: the columns are separated by `{separator}` ({header}); set `delimiter = \"{name}\"` in a column map, and `decimal = \"comma\"` if numbers are written 1,5", path = path.display())]
    Delimiter {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: usize,
        /// The delimiter found.
        separator: char,
        /// Its name in a column map.
        name: &'static str,
        /// The header.
        header: String,
    },
    /// A column is not in the header.
    #[error("{path}:{line}: no column `{column}` for channel `{channel}`{suggestion}; the columns are {found}. Rename it in the header, or name it in a column map: [columns] {key} = \"...\"", path = path.display(), key = key(*channel))]
    MissingColumn {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: usize,
        /// The column looked for.
        column: String,
        /// The channel it is for.
        channel: Channel,
        /// `, did you mean ...?` or nothing.
        suggestion: String,
        /// The columns there are.
        found: String,
    },
    /// Two columns have the same name.
    #[error("{path}:{line}: column `{column}` appears twice in the header; name the one to use by its index in a column map", path = path.display())]
    RepeatedColumn {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: usize,
        /// The repeated name.
        column: String,
    },
    /// A column has no unit or one that is not of its quantity.
    #[error("{path}:{line}: column `{column}` {problem}; expected one of {}, as in `{channel} [{}]`{suggestion}", channel.info().quantity.choices(), channel.info().quantity.si(), path = path.display())]
    Unit {
        /// The file that gave the unit.
        path: PathBuf,
        /// Line.
        line: usize,
        /// The column.
        column: String,
        /// `has no unit` or `has the unit ..`.
        problem: String,
        /// The channel.
        channel: Channel,
        /// `, did you mean ...?` or nothing.
        suggestion: String,
    },
    /// A row has another number of fields than the header.
    #[error("{path}:{line}: {found} fields where {expected} are expected; is the row cut short, or the delimiter another?", path = path.display())]
    Ragged {
        /// The file.
        path: PathBuf,
        /// Line.
        line: usize,
        /// Fields in the header.
        expected: usize,
        /// Fields in the row.
        found: usize,
    },
    /// A field is not a number.
    #[error("{path}:{line}: column `{column}` contains `{found}`, which is not a number; {next}", path = path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// Line.
        line: usize,
        /// The column.
        column: String,
        /// What is there.
        found: String,
        /// What to do.
        next: &'static str,
    },
    /// A value no ship reaches.
    #[error("{path}:{line}: {} {found} {unit} is outside {limits}; {hint}", channel.info().words, path = path.display())]
    OutOfRange {
        /// The file.
        path: PathBuf,
        /// First such line.
        line: usize,
        /// The channel.
        channel: Channel,
        /// The value as written.
        found: f64,
        /// The unit it was declared in.
        unit: String,
        /// The range, as text, in that unit.
        limits: String,
        /// What it may be, and how many rows.
        hint: String,
    },
    /// Time does not increase.
    #[error("{path}:{line}: time {found} s {problem} {previous} s of line {previous_line}; {next}", path = path.display())]
    Time {
        /// The file.
        path: PathBuf,
        /// Line.
        line: usize,
        /// Time there \[s\].
        found: f64,
        /// `repeats` or `goes back from`.
        problem: &'static str,
        /// Time before \[s\].
        previous: f64,
        /// Line before.
        previous_line: usize,
        /// Next step.
        next: String,
    },
    /// Values are missing and the study does not say to cut the run there.
    #[error("{path}:{line}: {what} missing (NaN or blank) from line {line} to {last_line}, {rows} rows in the file in all; fill them, bridge short ones with `bridge` in a column map, or set `gaps = \"split\"` in the study to cut the run there", path = path.display())]
    Dropout {
        /// The file.
        path: PathBuf,
        /// First line of the first dropout.
        line: usize,
        /// Last line of the first dropout.
        last_line: usize,
        /// Channels missing there, with the verb.
        what: String,
        /// Rows with something missing in the whole file.
        rows: usize,
    },
    /// Time jumps and the study does not say to cut the run there.
    #[error("{path}:{line}: {gap:.3} s pass since the row before, where the step is {step:.3} s; restore the missing rows, or set `gaps = \"split\"` in the study to cut the run there", path = path.display())]
    Gap {
        /// The file.
        path: PathBuf,
        /// Line after the gap.
        line: usize,
        /// Length of the gap \[s\].
        gap: f64,
        /// Usual step \[s\].
        step: f64,
    },
    /// Nothing is left once rows with missing values are taken out.
    #[error("{path}:{line}: no two consecutive rows have every channel ({what}); leave out the channel that is missing, or bridge short dropouts with `bridge` in a column map (`--bridge SECONDS` of an import)", path = path.display())]
    NothingUsable {
        /// The file.
        path: PathBuf,
        /// First data line.
        line: usize,
        /// Missing counts by channel.
        what: String,
    },
    /// A channel that is needed was not recorded.
    #[error("{path}:{line}: channel `{channel}` ({words}) is needed {purpose} and was not recorded; {next}", path = path.display())]
    MissingChannel {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: usize,
        /// The channel.
        channel: Channel,
        /// The channel in words.
        words: &'static str,
        /// What for, beginning with `to` or `for`.
        purpose: &'static str,
        /// Next step.
        next: String,
    },
    /// No stretch of the run is as long as a window, or as the fewest steps where the study gives no window.
    #[error("{path}:{line}: the longest unbroken stretch lasts {have:.2} s, shorter than {least} {need:.2} s; set a shorter `{key}` in the study, or leave the run out", path = path.display())]
    TooShort {
        /// The file.
        path: PathBuf,
        /// First line of that stretch.
        line: usize,
        /// Its length \[s\].
        have: f64,
        /// Length that is needed \[s\].
        need: f64,
        /// Of what: `a window of`.
        least: &'static str,
        /// The key of the study that sets it.
        key: &'static str,
    },
    /// A setting of the windows that cannot be.
    #[error("{path}: {message}", path = path.display())]
    Setting {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        message: String,
    },
    /// Channels given as arrays do not fit together.
    #[error(
        "recording `{name}`: channel `{channel}` has {found} rows where `t` has {expected}; give every channel one value a row"
    )]
    Lengths {
        /// Name of the recording.
        name: String,
        /// The channel.
        channel: Channel,
        /// Rows of time.
        expected: usize,
        /// Rows of the channel.
        found: usize,
    },
}

/// A channel as the key of a table of TOML: with a point in it, it stands in quotes.
fn key(channel: Channel) -> String {
    if channel.name().contains('.') { format!("{:?}", channel.name()) } else { channel.name().to_owned() }
}
