//! The results file of a campaign: a row a case, appended whole, so that a campaign that was killed goes on where it was.
//! Which cases are run, and what their rows say together, is elsewhere.

use std::collections::{BTreeSet, HashMap};
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use trimtab::files::write_whole;

use super::plan::Planned;
use crate::conceal::error::ConcealError;
use crate::conceal::judge::score::Score;

/// The results file, open for further rows.
pub struct Rows {
    path: PathBuf,
    file: Mutex<File>,
}

impl Rows {
    /// Opens a results file, without the row that was torn when a campaign was killed, and gives the cases that have a row.
    ///
    /// # Errors
    /// Those of the file system, and a file with other columns.
    pub fn open(path: &Path) -> Result<(Self, BTreeSet<String>), ConcealError> {
        let fail = |source| ConcealError::file(path, source);
        let file = OpenOptions::new().create(true).append(true).open(path).map_err(fail)?;
        let text = std::fs::read(path).map_err(fail)?;
        let whole = whole_rows(&text);
        file.set_len(whole as u64).map_err(fail)?;
        let rows = Self { path: path.to_owned(), file: Mutex::new(file) };
        if whole == 0 {
            rows.append(&header()?)?;
        }
        Ok((rows, read(path)?.into_iter().map(|score| score.case).collect()))
    }

    /// Appends a row, as [`row`] gives it.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn append(&self, row: &str) -> Result<(), ConcealError> {
        // A panic in another thread cannot leave half a row: a row is written whole.
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let written = file.write_all(row.as_bytes()).and_then(|()| file.sync_data());
        written.map_err(|source| ConcealError::file(&self.path, source))
    }
}

/// How many bytes of a results file are whole rows: those up to the last end of line outside quotes.
fn whole_rows(text: &[u8]) -> usize {
    let (mut quoted, mut end) = (false, 0);
    for (i, byte) in text.iter().enumerate() {
        match byte {
            b'"' => quoted = !quoted,
            b'\n' if !quoted => end = i + 1,
            _ => {}
        }
    }
    end
}

/// The rows of a results file, without one that was torn; none without a file.
///
/// # Errors
/// Those of the file system, and a file with other columns.
pub fn read(path: &Path) -> Result<Vec<Score>, ConcealError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = std::fs::read(path).map_err(|source| ConcealError::file(path, source))?;
    let text = &text[..whole_rows(&text)];
    if !text.is_empty() && !text.starts_with(header()?.as_bytes()) {
        let message = "the columns are not those of this version; move the file away, and the campaign begins anew";
        return Err(ConcealError::content(path, &message));
    }
    csv::Reader::from_reader(text).deserialize().collect::<Result<_, _>>().map_err(|e| ConcealError::content(path, &e))
}

/// A score as a row of the results file.
///
/// # Errors
/// A score that CSV cannot express.
pub fn row(score: &Score) -> Result<String, ConcealError> {
    text(score, false)
}

/// Scores as a file with the columns of the results.
///
/// # Errors
/// A score that CSV cannot express.
pub fn listed<'a>(mut scores: impl Iterator<Item = &'a Score>) -> Result<String, ConcealError> {
    scores.try_fold(header()?, |all, score| Ok(all + &row(score)?))
}

/// The line of the column names.
fn header() -> Result<String, ConcealError> {
    let both = text(&Score::default(), true)?;
    Ok(both.split_inclusive('\n').next().unwrap_or_default().to_owned())
}

fn text(score: &Score, header: bool) -> Result<String, ConcealError> {
    let fail = |e: &dyn std::fmt::Display| ConcealError::content(Path::new(&score.case), &e.to_string());
    let mut writer = csv::WriterBuilder::new().has_headers(header).from_writer(Vec::new());
    writer.serialize(score).map_err(|e| fail(&e))?;
    let bytes = writer.into_inner().map_err(|e| fail(&e))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Puts the rows of the results file in the order of the plan, each case once: they end in another order each time.
///
/// # Errors
/// Those of the file system, and a file that is no table.
pub fn put_in_order(path: &Path, plan: &[Planned]) -> Result<(), ConcealError> {
    if !path.exists() {
        return Ok(());
    }
    let fail = |e: &dyn std::fmt::Display| ConcealError::content(path, &e.to_string());
    let file = |source| ConcealError::file(path, source);
    let text = std::fs::read(path).map_err(file)?;
    let mut reader = csv::Reader::from_reader(&text[..whole_rows(&text)]);
    let header = reader.headers().map_err(|e| fail(&e))?.clone();
    let place: HashMap<&str, usize> = plan.iter().enumerate().map(|(i, c)| (c.key.as_str(), i)).collect();
    let case = header.iter().position(|name| name == "case").unwrap_or(0);
    let mut records: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>().map_err(|e| fail(&e))?;
    let mut seen = BTreeSet::new();
    records.retain(|r| seen.insert(r.get(case).unwrap_or_default().to_owned()));
    records.sort_by_key(|r| r.get(case).and_then(|key| place.get(key)).copied().unwrap_or(usize::MAX));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header).map_err(|e| fail(&e))?;
    for record in &records {
        writer.write_record(record).map_err(|e| fail(&e))?;
    }
    write_whole(path, &writer.into_inner().map_err(|e| fail(&e))?).map_err(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::campaign::plan::plan;

    fn scored(case: &str, error: &str) -> Score {
        Score { case: case.to_owned(), error: error.to_owned(), snr: Some(2.5), ..Score::default() }
    }

    /// What a campaign does with the cases of a plan: those without a row are run, each appends its row.
    fn go_on(path: &Path, cases: &[Score]) {
        let (rows, done) = Rows::open(path).unwrap();
        cases.iter().filter(|c| !done.contains(&c.case)).for_each(|c| rows.append(&row(c).unwrap()).unwrap());
    }

    #[test]
    fn a_campaign_killed_at_any_byte_goes_on_with_no_case_lost_or_doubled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        let cases =
            [scored("a/0", ""), scored("b, \"c\"/1", "line one\nline \"two\"\n"), scored("d/2", "ünreadable, twice")];
        go_on(&path, &cases);
        let whole = std::fs::read(&path).unwrap();
        for end in 0..=whole.len() {
            std::fs::write(&path, &whole[..end]).unwrap();
            // A summary of what is there reads what is whole.
            let before = read(&path).unwrap().len();
            go_on(&path, &cases);
            assert!(std::fs::read(&path).unwrap() == whole, "cut at byte {end} with {before} rows");
            assert_eq!(read(&path).unwrap(), cases);
        }
        // An interrupted campaign whose cases ended in another order has them all, once.
        let torn = whole.len() - 3;
        std::fs::write(&path, &whole[..torn]).unwrap();
        go_on(&path, &[cases[2].clone(), cases[0].clone(), cases[1].clone()]);
        assert_eq!(read(&path).unwrap().len(), 3);
    }

    #[test]
    fn rows_are_put_in_the_order_of_the_plan_each_case_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        let plan = &plan(1)[..3];
        let (rows, _) = Rows::open(&path).unwrap();
        for i in [2, 0, 2, 1] {
            rows.append(&row(&scored(&plan[i].key, "")).unwrap()).unwrap();
        }
        put_in_order(&path, plan).unwrap();
        let keys: Vec<String> = read(&path).unwrap().into_iter().map(|s| s.case).collect();
        assert_eq!(keys, plan.iter().map(|c| c.key.clone()).collect::<Vec<_>>());
    }

    #[test]
    fn a_file_of_other_columns_is_refused_and_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        std::fs::write(&path, "case,arm\na,b\n").unwrap();
        let error = Rows::open(&path).err().unwrap().to_string();
        assert!(error.contains("columns are not those") && error.contains("move the file away"), "{error}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "case,arm\na,b\n");
    }
}
