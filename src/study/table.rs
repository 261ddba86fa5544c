//! The table of runs beside a study: a CSV file with the keys of `[[runs]]` as columns, read with all its mistakes reported at once.
//! What the runs mean for the study is decided in `listed`.

use super::error::StudyError;
use super::file::RunEntry;
use crate::files::suggestion;
use crate::files::written::{Mistake, joined, read_text};
use crate::recording::Split;
use csv::StringRecord;
use std::path::Path;

/// The columns that a table of runs may have.
const COLUMNS: [&str; 8] = ["file", "name", "session", "manoeuvre", "split", "from", "to", "column_map"];

/// Reads a CSV table of runs, in any order of columns; a blank cell is a key left out.
///
/// # Errors
/// The file cannot be read, or every mistake in it.
pub(super) fn read_table(path: &Path) -> Result<Vec<(usize, RunEntry)>, StudyError> {
    let read = |source| StudyError::Read { path: path.to_owned(), what: "table of runs", source };
    let text = read_text(path).map_err(read)?;
    parse(&text).map_err(|mistakes| {
        let (line, message) = joined(mistakes, path);
        StudyError::Parse { path: path.to_owned(), line, message }
    })
}

/// The runs of a table, each with its line.
fn parse(text: &str) -> Result<Vec<(usize, RunEntry)>, Vec<Mistake>> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .flexible(true)
        .has_headers(false)
        .from_reader(text.as_bytes());
    let (mut columns, mut mistakes, mut entries) = (None, Vec::new(), Vec::new());
    for record in reader.records() {
        let record = match record {
            Ok(record) => record,
            Err(error) => {
                let line = error.position().map_or(1, |p| p.line() as usize);
                mistakes.push(Mistake::new(line, format!("{error}; correct the line")));
                break;
            }
        };
        let line = record.position().map_or(1, |p| p.line() as usize);
        match &columns {
            None => {
                let header = header(&record).map_err(|messages| {
                    messages.into_iter().map(|m| Mistake::new(line, m)).collect::<Vec<Mistake>>()
                })?;
                columns = Some(header);
            }
            Some(columns) => match entry(columns, &record) {
                Ok(entry) => entries.push((line, entry)),
                Err(messages) => mistakes.extend(messages.into_iter().map(|m| Mistake::new(line, m))),
            },
        }
    }
    if mistakes.is_empty() { Ok(entries) } else { Err(mistakes) }
}

/// The columns by the first line, checked.
fn header(record: &StringRecord) -> Result<Vec<String>, Vec<String>> {
    let list = COLUMNS.join(", ");
    let columns: Vec<String> = record.iter().map(str::to_owned).collect();
    let known = |name: &&String| COLUMNS.contains(&name.as_str());
    if let (false, [only]) = (columns.iter().any(|c| known(&c)), &columns[..])
        && let Some(separator) = [';', '\t'].into_iter().find(|s| only.contains(*s))
    {
        let named = if separator == ';' { "semicolons" } else { "tabulators" };
        return Err(vec![format!(
            "the fields are separated by {named}; separate them by commas, with a decimal point in numbers"
        )]);
    }
    if !columns.iter().any(|c| known(&c)) {
        return Err(vec![format!("this is no table of runs: its first line must name the columns, which are {list}")]);
    }
    let unknown = columns.iter().filter(|c| !known(c)).map(|name| {
        format!("unknown column `{name}`{}; columns are {list}", suggestion(name, COLUMNS.iter().copied()))
    });
    let twice = COLUMNS.iter().filter(|name| columns.iter().filter(|c| c == name).count() > 1);
    let mut wrong: Vec<String> =
        unknown.chain(twice.map(|name| format!("the column `{name}` is there twice; keep one"))).collect();
    if !columns.iter().any(|c| c == "file") {
        wrong.push("the column `file` is missing: it names the recording of each run".to_owned());
    }
    if wrong.is_empty() { Ok(columns) } else { Err(wrong) }
}

/// A run by a line of the table.
fn entry(columns: &[String], record: &StringRecord) -> Result<RunEntry, Vec<String>> {
    let surplus = record.iter().skip(columns.len()).any(|field| !field.is_empty());
    if record.len() < columns.len() || surplus {
        let (found, expected) = (record.len(), columns.len());
        return Err(vec![format!(
            "{found} fields where the first line has {expected}; is a comma too many or too few?"
        )]);
    }
    let cell = |column: &str| {
        let at = columns.iter().position(|c| c == column)?;
        record.get(at).filter(|text| !text.is_empty())
    };
    let mut wrong = Vec::new();
    let file = cell("file").unwrap_or_else(|| {
        wrong.push("the cell `file` is blank: name the recording of this run, or remove the line".to_owned());
        ""
    });
    let split = cell("split").and_then(|word| match word {
        "train" => Some(Split::Train),
        "test" => Some(Split::Test),
        other => {
            let near = suggestion(other, ["train", "test"].into_iter());
            wrong.push(format!("unknown word `{other}` as `split`{near}; it must be one of `train`, `test`"));
            None
        }
    });
    let mut time = |column| {
        let text = cell(column)?;
        let value = text.parse::<f64>().ok();
        if value.is_none() {
            let text = format!(
                "`{column}` = {text} is not a number of seconds; write it with a decimal point, or leave it blank"
            );
            wrong.push(text);
        }
        value
    };
    let (from, to) = (time("from"), time("to"));
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let text = |column| cell(column).map(str::to_owned);
    Ok(RunEntry {
        file: file.into(),
        name: text("name"),
        session: text("session"),
        manoeuvre: text("manoeuvre"),
        split,
        from,
        to,
        column_map: cell("column_map").map(Into::into),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrong(text: &str) -> Vec<(usize, String)> {
        parse(text).err().unwrap_or_default().into_iter().map(|m| (m.line, m.message)).collect()
    }

    #[test]
    fn mistakes_of_every_line_are_reported_at_once() {
        let found = wrong("file,split,from\na.csv,training,\n,train,\nc.csv,test,\"0,5\"\nd.csv,test\n");
        let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [2, 3, 4, 5], "{found:?}");
        for ((_, message), words) in found.iter().zip([
            "did you mean `train`?",
            "is blank",
            "decimal point",
            "2 fields where the first line has 3",
        ]) {
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn a_first_line_that_names_no_columns_is_reported() {
        for (text, words) in [
            ("file;split\na.csv;train\n", "separated by semicolons"),
            ("a.csv,train\nb.csv,test\n", "its first line must name the columns"),
            ("t [s],x [m]\n0,1\n", "this is no table of runs"),
            ("file,sesion\na.csv,day 1\n", "did you mean `session`?"),
            ("file,from,from\na.csv,,\n", "is there twice"),
            ("name,split\na,train\n", "the column `file` is missing"),
        ] {
            let found = wrong(text);
            assert!(found.len() == 1 && found[0].0 == 1 && found[0].1.contains(words), "{text}{found:?}");
        }
    }
}
