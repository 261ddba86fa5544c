//! Where results go: text or JSON to standard output, files to the folder given with `--out`.
//! No other file writes to standard output; progress and errors go to standard error.

use super::arguments::given;
use super::audited::Audited;
use super::error::CliError;
use super::figures::{Captions, Drawing, FigureArgs};
use super::load::Loaded;
use super::style::shown;
use super::terminal::{Escaped, plain};
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use trimtab::files::ranks::Ranks;
use trimtab::files::{FolderError, Kept, Log, Origin, ResultFolder, plain_cell, sha256, utc};
use trimtab::report::Table;
use trimtab::report::diagnosis::{Provenance, SourceFile};
use trimtab::report::plot::{Figure, FigureError};

/// Arguments that every command with results has.
#[derive(Clone, Debug, clap::Args)]
pub struct OutputArgs {
    /// Folder for files: tables as CSV, figures with the CSV behind them and their captions, the result as JSON, and manifest.json, which says
    /// how they came about. Created if absent; what the same command wrote there before is replaced.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the result as one JSON object, and nothing else, to standard output.
    #[arg(long)]
    pub json: bool,
    /// Write each table of the result in these forms too: `latex` (booktabs) and `markdown`, beside the CSV.
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', requires = "out")]
    pub tables: Vec<TableFormat>,
}

/// A form of a table beside CSV.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum TableFormat {
    /// LaTeX with the rules of booktabs.
    Latex,
    /// Markdown.
    Markdown,
}

/// Collects the results of a command.
pub struct Output {
    command: &'static str,
    json: bool,
    silent: bool,
    tables: Vec<TableFormat>,
    folder: Option<ResultFolder>,
    settings: BTreeMap<String, Value>,
    audited: Option<Audited>,
    logs: Vec<Log>,
    drawing: Drawing,
    captions: Captions,
    failure: Option<CliError>,
}

/// Files that a command writes whatever its input is.
fn expected(command: &str) -> &'static [&'static str] {
    match command {
        "import" => &["import.json", "study.toml", "columns.toml", "runs.csv"],
        "split" => &["split.json", "runs.csv"],
        "check" => &["check.json", "channels.csv", "issues.csv"],
        "simulate" => &["simulate.json", "simulations.csv", "tracks.png", "tracks.csv"],
        "fit" => &["fit.json", "fitted.toml", "fit.txt", "parameters.csv", "curves.png", "curves.csv", "best.toml"],
        "evaluate" => &["evaluate.json", "trajectories.csv", "summary.csv", "improvement.png", "tracks.png"],
        "diagnose" => &["diagnosis.json", "improved.toml", "base.toml", "report.html"],
        "dossier" => &["dossier.html", "dossier.json"],
        "maneuver turning" => &["maneuver_turning.json", "turning.png", "turning.csv", "turning_measures.csv"],
        "maneuver zigzag" => &["maneuver_zigzag.json", "zigzag.png", "zigzag.csv", "zigzag_measures.csv"],
        "maneuver stopping" => &["maneuver_stopping.json", "stopping.png", "stopping.csv", "stopping_measures.csv"],
        "maneuver pullout" => &["maneuver_pullout.json", "pullout.png", "pullout.csv", "pullout_measures.csv"],
        "maneuver spiral" => &["maneuver_spiral.json", "spiral.png", "spiral.csv", "spiral_measures.csv"],
        "maneuver measure" => &["maneuver_measure.json", "measured.csv"],
        "plan" => &["plan.json", "trials.csv", "detectable.csv", "isolability.csv", "isolability_map.png"],
        "sweep" => {
            &["sweep.json", "profiles.csv", "intervals.csv", "sensitivities.csv", "pairs.csv", "profile_curves.csv"]
        }
        "compare" => &["compare.json", "compare.csv", "compare.png"],
        "terms" => &["terms.json", "parameters.csv"],
        "man" => &["trimtab.1"],
        "demo" => {
            &["demo.json", "fitted.toml", "fit.txt", "summary.csv", "tracks.png", "report.html", "diagnosis.json"]
        }
        _ => &[],
    }
}

/// Files of a command that are there for the user to edit.
fn edited(command: &str) -> &'static [&'static str] {
    if command == "import" { &["ship.toml", "model.toml"] } else { &[] }
}

impl Output {
    /// Opens the output of a command and makes its folder ready, so that a long computation does not fail at its end.
    pub fn new(command: &'static str, args: &OutputArgs) -> Result<Self, CliError> {
        let open = |folder: &PathBuf| ResultFolder::open_with(folder, command, expected(command), edited(command));
        let folder = args.out.as_ref().map(open).transpose()?;
        let (settings, audited, logs, failure) = (BTreeMap::new(), None, Vec::new(), None);
        let (drawing, captions) = (Drawing::default(), Captions::default());
        Ok(Self {
            command,
            json: args.json,
            silent: false,
            tables: args.tables.clone(),
            folder,
            settings,
            audited,
            logs,
            drawing,
            captions,
            failure,
        })
    }

    /// The same output with its figures drawn as they were asked for.
    pub fn drawn_as(self, args: &FigureArgs) -> Self {
        Self { drawing: args.into(), ..self }
    }

    /// The output of one of several ranks: the first one's as [`Self::new`] has it, no output of the others.
    pub fn of_rank(ranks: &Ranks, command: &'static str, args: &OutputArgs) -> Result<Self, CliError> {
        if ranks.is_first() {
            return Self::new(command, args);
        }
        Ok(Self { silent: true, ..Self::new(command, &OutputArgs { out: None, json: false, tables: Vec::new() })? })
    }

    /// Notes the files of a study and their digests for the manifest; with its recordings, if the command reads them.
    pub fn reads(&mut self, loaded: &Loaded, recordings: bool) {
        self.reads_files(&loaded.files(recordings));
    }

    /// Notes further files that the command reads.
    pub fn reads_files(&mut self, files: &[PathBuf]) {
        if let Some(folder) = &mut self.folder {
            folder.reads(files);
        }
    }

    /// Notes settings for the manifest.
    pub fn settings(&mut self, table: &str, settings: &impl Serialize) -> Result<(), CliError> {
        self.settings.insert(table.to_owned(), without_nulls(serde_json::to_value(settings)?));
        Ok(())
    }

    /// The command line and the files that were noted, for a report that names them.
    pub fn provenance(&self) -> Provenance {
        let file = |(path, sha256, changed): (&Path, Option<&str>, Option<SystemTime>)| SourceFile {
            path: path.display().to_string(),
            changed: changed.map(utc),
            sha256: sha256.map(str::to_owned),
        };
        let files = self.folder.iter().flat_map(ResultFolder::inputs).map(file).collect();
        let given = arguments(given().into_iter());
        let doubts = self.audited.as_ref().map(Audited::sentences);
        Provenance { command: format!("trimtab {}", given.join(" ")), next: None, files, doubts }
    }

    /// A file in the folder, if there is one, that can be seen while the command runs.
    pub fn kept(&self, name: &str) -> Option<Kept> {
        self.folder.as_ref().map(|folder| folder.kept(name))
    }

    /// The log of a long work in the folder, if there is one, and the parts of it that an earlier command on the same input and
    /// settings has done; [`Self::done_with`] ends it.
    pub fn log<T: DeserializeOwned>(&self, work: &str) -> Result<Option<(Log, Vec<T>)>, CliError> {
        let Some(folder) = &self.folder else { return Ok(None) };
        let path = folder.path().join(format!(".trimtab-{work}"));
        let settings = serde_json::to_string(&self.settings)?;
        let key = sha256(format!("{} {} {settings}", env!("CARGO_PKG_VERSION"), folder.inputs_digest()).as_bytes());
        Log::open(&path, &key).map(Some).map_err(|source| CliError::Write { path, source })
    }

    /// Keeps a log until the files of the result are in their places.
    pub fn done_with(&mut self, log: Log) {
        self.logs.push(log);
    }

    /// Takes what is to be said of the recordings: before the answer, and as `recordings` in JSON.
    pub fn recordings(&mut self, audited: Audited) {
        self.audited = Some(audited);
    }

    /// Whether files are wanted.
    pub fn has_folder(&self) -> bool {
        self.folder.is_some()
    }

    /// Writes a file in the folder, if there is one; `name` may have folders of its own. What cannot be written is reported when the
    /// command ends, after its answer.
    pub fn file(&mut self, name: impl AsRef<Path>, bytes: &[u8]) {
        self.put(|folder| Ok(folder.write(name, bytes)?));
    }

    /// Leaves a file in the folder as it is.
    pub fn leave(&mut self, name: &str) {
        if let Some(folder) = &mut self.folder {
            folder.leave(name);
        }
    }

    /// Writes a table of the result, CSV text of [`csv_text`], and the same in the other forms that are asked for.
    pub fn table(&mut self, name: &str, csv: &[u8]) {
        self.file(name, csv);
        for format in self.tables.clone() {
            let Some(table) = table_of(csv) else { continue };
            let (end, text) = match format {
                TableFormat::Latex => ("tex", table.latex()),
                TableFormat::Markdown => ("md", table.markdown()),
            };
            self.file(Path::new(name).with_extension(end), text.as_bytes());
        }
    }

    /// Draws a figure into the folder, if there is one; a failure is reported as that of [`Self::file`].
    pub fn figure(&mut self, stem: &str, figure: impl FnOnce() -> Figure) {
        if self.folder.is_some() {
            self.figures(vec![(stem.to_owned(), figure())]);
        }
    }

    /// Draws figures into the folder, if there is one, as many at a time as there are threads.
    pub fn figures(&mut self, figures: Vec<(String, Figure)>) {
        let Drawing { formats, .. } = &self.drawing;
        let laid_out = |(stem, figure): (String, Figure)| (stem, self.drawing.laid_out(figure));
        let figures: Vec<(String, Figure)> = figures.into_iter().map(laid_out).collect();
        figures.iter().for_each(|(stem, figure)| self.captions.add(stem, figure, formats));
        let formats = formats.clone();
        self.put(|folder| {
            let draw = |(stem, figure): &(String, Figure)| {
                let images = formats.iter().map(|f| Ok((format!("{stem}.{}", f.extension()), figure.image(*f)?)));
                images.chain([figure.csv().map(|csv| (format!("{stem}.csv"), csv.into_bytes()))]).collect()
            };
            let drawn: Vec<Vec<(String, Vec<u8>)>> =
                figures.par_iter().map(draw).collect::<Result<_, FigureError>>()?;
            Ok(drawn.iter().flatten().try_for_each(|(name, bytes)| folder.write(name, bytes))?)
        });
    }

    /// Writes into the folder, if there is one and nothing has failed.
    fn put(&mut self, write: impl FnOnce(&mut ResultFolder) -> Result<(), CliError>) {
        if let (Some(folder), None) = (&mut self.folder, &self.failure) {
            self.failure = write(folder).err();
        }
    }

    /// Ends the command: prints `text`, or the result as JSON; writes the JSON into the folder too.
    ///
    /// Object members without a value are left out, so that `null` occurs only in arrays, for entries that do not exist.
    pub fn finish(self, text: &str, result: &impl Serialize) -> Result<(), CliError> {
        self.finish_long(text, &Pruned(result))
    }

    /// As [`Self::finish`], with a result that is written piece by piece and has no member without a value; its members are in
    /// the order of their names.
    pub fn finish_long(mut self, text: &str, result: &impl Serialize) -> Result<(), CliError> {
        let (command, json, silent, audited) = (self.command, self.json, self.silent, self.audited.take());
        if silent {
            return Ok(());
        }
        self.put(|folder| {
            let document = Document::new(command, None, audited.as_ref(), result);
            let fill = |file: &mut dyn Write| {
                serde_json::to_writer_pretty(&mut *file, &document)?;
                file.write_all(b"\n")
            };
            Ok(folder.fill(format!("{}.json", command.replace(' ', "_")), fill)?)
        });
        let written = self.close();
        let printed = if json {
            print_json(&Document::new(command, written.files(), audited.as_ref(), result))
        } else {
            let doubts = audited.as_ref().map_or_else(String::new, Audited::lines);
            print(&(doubts + text.trim_end() + "\n" + &written.line()))
        };
        written.ended(printed)
    }

    /// Puts the files of the result into their places. What went wrong is reported by [`Written::ended`], after the answer.
    pub fn close(mut self) -> Written {
        for (name, text) in self.captions.files(self.command) {
            self.file(name, text.as_bytes());
        }
        let Some(folder) = self.folder.take() else { return Written { files: Ok(None) } };
        if let Some(failure) = self.failure {
            return Written { files: Err(failure) };
        }
        let path = folder.path().to_owned();
        let origin = Origin { arguments: arguments(given().into_iter()), settings: self.settings };
        let files = folder.complete(origin).map(|files| Some((path, files))).map_err(CliError::from);
        if files.is_ok() {
            self.logs.into_iter().for_each(Log::remove);
        }
        Written { files }
    }
}

/// What became of the files of a result: the folder and their paths, if files were wanted.
pub struct Written {
    files: Result<Option<(PathBuf, Vec<PathBuf>)>, CliError>,
}

impl Written {
    /// The paths of the files; none where they are not in their places.
    fn files(&self) -> Option<&[PathBuf]> {
        match &self.files {
            Ok(written) => Some(written.as_ref().map_or(&[], |(_, files)| files)),
            Err(_) => None,
        }
    }

    /// Whether files were wanted, and are in their places.
    pub fn is_there(&self) -> bool {
        matches!(self.files, Ok(Some(_)))
    }

    /// What was written where, as the last lines of an answer; nothing without files.
    pub fn line(&self) -> String {
        let Ok(Some((folder, files))) = &self.files else { return String::new() };
        let names = files.iter().map(|f| f.strip_prefix(folder).unwrap_or(f).display().to_string());
        format!("\nWritten to {}: {}\n", folder.display(), abridged(names.collect()))
    }

    /// Ends the command after its answer was printed.
    ///
    /// # Errors
    /// What went wrong with the files, or else with standard output.
    pub fn ended(self, printed: Result<(), CliError>) -> Result<(), CliError> {
        self.files.and(printed)
    }
}

/// The arguments that a result depends on: all but the folder it goes to, how it is printed, and the number of threads.
fn arguments(all: impl Iterator<Item = String>) -> Vec<String> {
    let (mut kept, mut value_of_left) = (Vec::new(), false);
    for argument in all {
        let left = ["--out", "--threads", "--json"].iter().find(|name| argument == **name);
        let joined = argument.starts_with("--out=") || argument.starts_with("--threads=");
        if !value_of_left && left.is_none() && !joined {
            kept.push(argument);
            continue;
        }
        value_of_left = !value_of_left && left.is_some_and(|name| *name != "--json");
    }
    kept
}

impl From<FolderError> for CliError {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::Write { path, source } => Self::Write { path, source },
            other => Self::Folder(other),
        }
    }
}

/// The JSON document of a command, its members in the order of their names.
#[derive(Serialize)]
struct Document<'a, T: Serialize> {
    command: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    files: Option<&'a [PathBuf]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recordings: Option<&'a Audited>,
    result: &'a T,
    version: &'static str,
}

impl<'a, T: Serialize> Document<'a, T> {
    fn new(command: &'a str, files: Option<&'a [PathBuf]>, recordings: Option<&'a Audited>, result: &'a T) -> Self {
        Self { command, files, recordings, result, version: env!("CARGO_PKG_VERSION") }
    }
}

/// A value in JSON without object members that are null, its members in the order of their names.
pub struct Pruned<'a, T>(pub &'a T);

impl<T: Serialize> Serialize for Pruned<'_, T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = serde_json::to_value(self.0).map_err(serde::ser::Error::custom)?;
        without_nulls(value).serialize(serializer)
    }
}

/// Values in JSON, each [`Pruned`] when its turn comes.
pub struct Each<'a, T>(pub &'a [T]);

impl<T: Serialize> Serialize for Each<'_, T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(Pruned))
    }
}

/// File names as a sentence; for files in a folder, the folder and their number.
fn abridged(names: Vec<String>) -> String {
    let (deep, mut shown): (Vec<String>, Vec<String>) = names.into_iter().partition(|n| n.contains('/'));
    let mut folders: Vec<&str> = deep.iter().filter_map(|n| n.split('/').next()).collect();
    folders.sort_unstable();
    folders.dedup();
    for folder in folders {
        let count = deep.iter().filter(|n| n.split('/').next() == Some(folder)).count();
        shown.push(format!("{folder}/ ({count} files)"));
    }
    shown.join(", ")
}

/// A JSON value without object members that are null.
fn without_nulls(value: Value) -> Value {
    match value {
        Value::Object(members) => Value::Object(
            members.into_iter().filter(|(_, v)| !v.is_null()).map(|(k, v)| (k, without_nulls(v))).collect(),
        ),
        Value::Array(entries) => Value::Array(entries.into_iter().map(without_nulls).collect()),
        other => other,
    }
}

/// Prints to standard output, without what would control a terminal. A reader that closed it early, as in `trimtab terms | head`,
/// has what it wanted.
pub fn print(text: &str) -> Result<(), CliError> {
    let mut stdout = std::io::stdout().lock();
    printed(stdout.write_all(shown(&plain(text)).as_bytes()).and_then(|()| stdout.flush()))
}

/// Refuses a file that is there already: it may be an input, or be edited.
pub fn is_new(path: &Path) -> Result<(), CliError> {
    if path.exists() {
        let path = path.display();
        return Err(CliError::Argument(format!("{path} is there already and is not overwritten; give another name")));
    }
    Ok(())
}

/// Prints the content of a file to standard output as it is, neither wrapped nor coloured.
pub fn print_file(text: &str) -> Result<(), CliError> {
    let mut stdout = std::io::stdout().lock();
    printed(stdout.write_all(plain(text).as_bytes()).and_then(|()| stdout.flush()))
}

/// Prints a value as JSON, as [`print`] does.
pub fn print_json(value: &impl Serialize) -> Result<(), CliError> {
    let mut stdout = BufWriter::new(Escaped(std::io::stdout().lock()));
    let written = serde_json::to_writer_pretty(&mut stdout, value).map_err(std::io::Error::from);
    printed(written.and_then(|()| stdout.write_all(b"\n")).and_then(|()| stdout.flush()))
}

fn printed(outcome: std::io::Result<()>) -> Result<(), CliError> {
    match outcome {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(CliError::Stdout),
    }
}

/// CSV text of a header and rows of fields; a spreadsheet runs none of them.
pub fn csv_text<R: IntoIterator<Item = String>>(
    header: &[&str],
    rows: impl IntoIterator<Item = R>,
) -> Result<Vec<u8>, CliError> {
    let fail = |message: String| CliError::Format { format: "CSV", message };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header.iter().map(|name| plain_cell(name).into_owned())).map_err(|e| fail(e.to_string()))?;
    for row in rows {
        let row: Vec<String> = row.into_iter().map(|cell| plain_cell(&cell).into_owned()).collect();
        writer.write_record(row).map_err(|e| fail(e.to_string()))?;
    }
    writer.into_inner().map_err(|e| fail(e.to_string()))
}

/// CSV text as a table.
fn table_of(csv: &[u8]) -> Option<Table> {
    let mut reader = csv::Reader::from_reader(csv);
    let mut table = Table::new(reader.headers().ok()?.iter().map(str::to_owned));
    for record in reader.records() {
        table.row(record.ok()?.iter().map(str::to_owned));
    }
    Some(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn members_without_a_value_are_left_out_and_array_entries_stay() {
        let value = json!({"a": null, "b": [1.0, null, {"c": null, "d": 2}], "e": f64::NAN});
        assert_eq!(without_nulls(value), json!({"b": [1.0, null, {"d": 2}]}));
    }

    #[test]
    fn arguments_that_no_result_depends_on_are_left_out() {
        let given = "fit study.toml --out r --threads 2 --starts 5 --json --model --out=x --threads=3 m.toml";
        let kept = arguments(given.split(' ').map(str::to_owned));
        assert_eq!(kept, ["fit", "study.toml", "--starts", "5", "--model", "m.toml"]);
    }

    #[test]
    fn cells_of_a_table_are_run_by_no_spreadsheet() {
        let rows = [["=HYPERLINK(1)", "-1.5", "-x, y"].map(str::to_owned)];
        let text = String::from_utf8(csv_text(&["@a", "b", "c"], rows).unwrap_or_default()).unwrap_or_default();
        assert_eq!(text, "'@a,b,c\n'=HYPERLINK(1),-1.5,\"'-x, y\"\n");
    }

    #[test]
    fn many_files_in_a_folder_are_counted() {
        let names = ["a.csv", "runs/1.csv", "runs/2.csv"].map(str::to_owned).to_vec();
        assert_eq!(abridged(names), "a.csv, runs/ (2 files)");
    }
}
