//! Counts of the outcomes, by class and kind of change.
//! It judges nothing.

use std::collections::BTreeMap;

use trimtab::report::Table;

use super::row::{Outcome, Row};

/// The table of outcomes by kind of change: cases, commands, and how often each outcome came about.
pub fn table(rows: &[Row]) -> Table {
    let mut kinds: BTreeMap<(&str, &str), Vec<&Row>> = BTreeMap::new();
    for row in rows {
        kinds.entry((&row.class, &row.kind)).or_default().push(row);
        kinds.entry((&row.class, "~ all")).or_default().push(row);
    }
    let mut table = Table::new([
        "class", "change", "studies", "answers", "panics", "hangs", "unclear", "refused", "same", "told", "silent",
        "wrong",
    ]);
    for ((class, kind), rows) in kinds {
        let count = |outcome: Outcome| rows.iter().filter(|r| r.outcome == outcome).count();
        let mut cases: Vec<usize> = rows.iter().map(|r| r.case).collect();
        cases.sort_unstable();
        cases.dedup();
        let wrong = rows.iter().filter(|r| !r.right).count();
        let outcomes = [
            Outcome::Panicked,
            Outcome::Hung,
            Outcome::Unclear,
            Outcome::Refused,
            Outcome::Same,
            Outcome::Told,
            Outcome::Silent,
        ];
        let numbers = [cases.len(), rows.len()].into_iter().chain(outcomes.map(count)).chain([wrong]);
        let names = [class.to_owned(), kind.trim_start_matches("~ ").to_owned()];
        table.row(names.into_iter().chain(numbers.map(|n| n.to_string())));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outcomes_are_counted_by_kind_and_a_study_once() {
        let row = |case: usize, kind: &str, outcome: Outcome| Row {
            case,
            class: "damage".into(),
            kind: kind.into(),
            outcome,
            right: outcome != Outcome::Silent,
            ..Row::default()
        };
        let rows = [row(1, "a", Outcome::Same), row(1, "a", Outcome::Silent), row(2, "b", Outcome::Told)];
        let table = table(&rows);
        let of = |i: usize| table.rows()[i].join(",");
        assert_eq!(of(0), "damage,a,1,2,0,0,0,0,1,0,1,1");
        assert_eq!(of(1), "damage,b,1,1,0,0,0,0,0,1,0,0");
        assert_eq!(of(2), "damage,all,2,3,0,0,0,0,1,1,1,1");
    }
}
