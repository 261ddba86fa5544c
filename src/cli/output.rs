//! Where results go: text or JSON to standard output, files to the folder given with `--out`.
//! No other file writes to standard output; progress and errors go to standard error.

use super::audited::Audited;
use super::error::CliError;
use serde::Serialize;
use serde_json::Value;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use trimtab::files::{fill_whole, write_whole};
use trimtab::plot::Figure;
use trimtab::ranks::Ranks;

/// Arguments that every command with results has.
#[derive(Clone, Debug, clap::Args)]
pub struct OutputArgs {
    /// Folder for files: tables as CSV, figures as PNG with the CSV behind them, the result as JSON. Created if absent.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the result as one JSON object, and nothing else, to standard output.
    #[arg(long)]
    pub json: bool,
}

/// Collects the results of a command.
pub struct Output {
    command: &'static str,
    json: bool,
    silent: bool,
    folder: Option<PathBuf>,
    files: Vec<PathBuf>,
    audited: Option<Audited>,
}

impl Output {
    /// Opens the output of a command and makes its folder, so that a long computation does not fail at its end.
    pub fn new(command: &'static str, args: &OutputArgs) -> Result<Self, CliError> {
        if let Some(folder) = &args.out {
            std::fs::create_dir_all(folder).map_err(|source| CliError::Write { path: folder.clone(), source })?;
        }
        Ok(Self { command, json: args.json, silent: false, folder: args.out.clone(), files: Vec::new(), audited: None })
    }

    /// The output of one of several ranks: the first one's as [`Self::new`] has it, no output of the others.
    pub fn of_rank(ranks: &Ranks, command: &'static str, args: &OutputArgs) -> Result<Self, CliError> {
        if ranks.is_first() {
            return Self::new(command, args);
        }
        Ok(Self { command, json: false, silent: true, folder: None, files: Vec::new(), audited: None })
    }

    /// The path of a file in the folder, if there is one.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(name))
    }

    /// Takes what is to be said of the recordings: before the answer, and as `recordings` in JSON.
    pub fn recordings(&mut self, audited: Audited) {
        self.audited = Some(audited);
    }

    /// Whether files are wanted.
    pub fn has_folder(&self) -> bool {
        self.folder.is_some()
    }

    /// Writes a file in the folder, if there is one; `name` may have folders of its own.
    pub fn file(&mut self, name: impl AsRef<Path>, bytes: &[u8]) -> Result<(), CliError> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let path = folder.join(name);
        let fail = |source| CliError::Write { path: path.clone(), source };
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(fail)?;
        }
        write_whole(&path, bytes).map_err(fail)?;
        self.files.push(path);
        Ok(())
    }

    /// Draws a figure into the folder, if there is one.
    pub fn figure(&mut self, stem: &str, figure: impl FnOnce() -> Figure) -> Result<(), CliError> {
        if let Some(folder) = &self.folder {
            self.files.extend(figure().save(&folder.join(stem))?);
        }
        Ok(())
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
        if self.silent {
            return Ok(());
        }
        let name = format!("{}.json", self.command.replace(' ', "_"));
        if let Some(folder) = &self.folder {
            let path = folder.join(name);
            let document = Document::new(self.command, None, self.audited.as_ref(), result);
            let fill = |file: &mut dyn Write| {
                serde_json::to_writer_pretty(&mut *file, &document)?;
                file.write_all(b"\n")
            };
            fill_whole(&path, fill).map_err(|source| CliError::Write { path: path.clone(), source })?;
            self.files.push(path);
        }
        if self.json {
            let document = Document::new(self.command, Some(&self.files), self.audited.as_ref(), result);
            let mut stdout = BufWriter::new(std::io::stdout().lock());
            return serde_json::to_writer_pretty(&mut stdout, &document)
                .map_err(std::io::Error::from)
                .and_then(|()| stdout.write_all(b"\n"))
                .and_then(|()| stdout.flush())
                .map_err(unprinted);
        }
        let doubts = self.audited.as_ref().map_or_else(String::new, Audited::lines);
        let mut text = doubts + text.trim_end() + "\n";
        if let Some(folder) = &self.folder {
            let names = self.files.iter().map(|f| f.strip_prefix(folder).unwrap_or(f).display().to_string());
            text += &format!("\nWritten to {}: {}\n", folder.display(), abridged(names.collect()));
        }
        print(&text)
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

/// Prints to standard output.
pub fn print(text: &str) -> Result<(), CliError> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(unprinted)
}

/// The error of standard output that takes no more.
fn unprinted(error: std::io::Error) -> CliError {
    match error.kind() {
        ErrorKind::BrokenPipe => CliError::Closed,
        _ => CliError::Stdout(error),
    }
}

/// CSV text of a header and rows of fields.
pub fn csv_text<R: IntoIterator<Item = String>>(
    header: &[&str],
    rows: impl IntoIterator<Item = R>,
) -> Result<Vec<u8>, CliError> {
    let fail = |message: String| CliError::Format { format: "CSV", message };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).map_err(|e| fail(e.to_string()))?;
    for row in rows {
        writer.write_record(row.into_iter().collect::<Vec<String>>()).map_err(|e| fail(e.to_string()))?;
    }
    writer.into_inner().map_err(|e| fail(e.to_string()))
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
    fn many_files_in_a_folder_are_counted() {
        let names = ["a.csv", "runs/1.csv", "runs/2.csv"].map(str::to_owned).to_vec();
        assert_eq!(abridged(names), "a.csv, runs/ (2 files)");
    }
}
