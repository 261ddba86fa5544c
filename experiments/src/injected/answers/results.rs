//! The results of the campaign on real recordings: which cases have no row yet, and the rows in the order of the plan.
//! How rows are kept is in `rows`.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use super::row::Row;
use crate::injected::error::InjectedError;
use crate::injected::plan::Planned;
use crate::rows::Rows;

/// The file of results, open for further rows.
pub type Results = Rows<Row>;

/// The cases of a plan that have no row yet. A row without an answer because the program was stopped or missing has one.
///
/// # Errors
/// [`InjectedError::Case`] if a row is of a plan with another seed.
pub fn missing(results: &Results, plan: &[Planned]) -> Result<Vec<Planned>, InjectedError> {
    let seeds: BTreeMap<&str, u64> = results.rows.iter().map(|r| (r.case.as_str(), r.seed)).collect();
    let mut missing = Vec::new();
    for case in plan {
        match seeds.get(case.key.as_str()) {
            None => missing.push(case.clone()),
            Some(seed) if *seed == case.seed => {}
            Some(_) => {
                let message = format!("case {} is of a campaign with another seed; give another folder", case.key);
                return Err(InjectedError::content(results.path(), &message));
            }
        }
    }
    Ok(missing)
}

/// Reads the rows of a file and puts them in the order of the plan: they end in another order each time.
///
/// # Errors
/// [`InjectedError::Case`].
pub fn in_order(path: &Path, plan: &[Planned]) -> Result<Vec<Row>, InjectedError> {
    let fail = |source| InjectedError::file(path, source);
    let mut rows = Results::read(path)?;
    let place: HashMap<&str, usize> = plan.iter().enumerate().map(|(i, c)| (c.key.as_str(), i)).collect();
    rows.sort_by_key(|r| place.get(r.case.as_str()).copied().unwrap_or(usize::MAX));
    let written = path.with_extension("part");
    let all = Results::table(&rows)?;
    // Renamed whole: a kill leaves the old order or the new one.
    std::fs::write(&written, all).map_err(|source| InjectedError::file(&written, source))?;
    std::fs::rename(&written, path).map_err(fail)?;
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::plan::plan;

    fn row(case: &Planned) -> Row {
        Row { truth: "[[\"a\",1.0]]".into(), headline: "one, \"two\"".into(), ..Row::planned(case) }
    }

    #[test]
    fn a_row_that_was_cut_off_at_any_byte_is_dropped_and_its_case_run_again() {
        let all = plan(31).unwrap();
        let cases = &all[..3];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        let results = Results::open(&path).unwrap();
        for case in cases {
            results.append(&row(case)).unwrap();
        }
        drop(results);
        let bytes = std::fs::read(&path).unwrap();
        let lines: Vec<usize> = (0..bytes.len()).filter(|i| bytes[*i] == b'\n').map(|i| i + 1).collect();
        assert_eq!(lines.len(), 4);
        let near = |cut: &usize| cut.is_multiple_of(97) || lines.iter().any(|end| end.abs_diff(*cut) < 2);
        for cut in (0..=bytes.len()).filter(near) {
            std::fs::write(&path, &bytes[..cut]).unwrap();
            let results = Results::open(&path).unwrap();
            let kept = lines.iter().filter(|end| **end <= cut).count().saturating_sub(1);
            assert_eq!(results.rows.len(), kept, "cut at byte {cut}");
            let left = missing(&results, cases).unwrap();
            assert_eq!(left.len(), 3 - kept);
            for case in &left {
                results.append(&row(case)).unwrap();
            }
            assert_eq!(std::fs::read(&path).unwrap(), bytes, "cut at byte {cut}");
        }
    }

    #[test]
    fn rows_are_put_in_the_order_of_the_plan_and_those_of_another_seed_are_refused() {
        let all = plan(31).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        let results = Results::open(&path).unwrap();
        for case in all[..3].iter().rev() {
            results.append(&row(case)).unwrap();
        }
        let rows = in_order(&path, &all).unwrap();
        assert!(rows.iter().zip(&all).all(|(r, c)| r.case == c.key) && rows.len() == 3);
        let again = Results::open(&path).unwrap();
        assert_eq!(again.rows, rows);
        assert!(missing(&again, &plan(32).unwrap()).is_err());
        std::fs::write(&path, "other,columns\n1,2\n").unwrap();
        assert!(Results::open(&path).is_err());
    }
}
