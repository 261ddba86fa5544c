//! A table of text cells, the same one for the terminal and for HTML.
//! It lays cells out; how a number reads is decided in `numerals`, and which values are worth a row by the caller.

use crate::numerals::DASH;
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, presets};
use std::fmt;

/// A table of text cells. Columns of numbers are set to the right, others to the left.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    width: Option<u16>,
}

impl Table {
    /// An empty table with these column headings.
    pub fn new<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        Self { header: header.into_iter().map(Into::into).collect(), rows: vec![], width: None }
    }

    /// Appends a row. A short row is filled with empty cells; cells beyond the headings are dropped.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) -> &mut Self {
        let mut row: Vec<String> = cells.into_iter().map(Into::into).collect();
        row.resize(self.header.len(), String::new());
        self.rows.push(row);
        self
    }

    /// The same table, its long cells wrapped so that it is at most `columns` characters wide in a terminal.
    pub fn wrapped(self, columns: u16) -> Self {
        Self { width: Some(columns), ..self }
    }

    /// The column headings.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// The rows, each as long as the header.
    #[must_use]
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// Whether column `i` holds numbers (and dashes) only.
    #[must_use]
    pub fn is_numeric(&self, i: usize) -> bool {
        let mut cells = self.rows.iter().filter_map(|row| row.get(i)).filter(|c| !c.is_empty()).peekable();
        cells.peek().is_some() && cells.all(|c| reads_as_number(c))
    }
}

/// Numbers, intervals, percentages, dashes and numbers followed by `(...)`.
fn reads_as_number(cell: &str) -> bool {
    cell == DASH
        || (cell.chars().any(|c| c.is_ascii_digit())
            && cell.chars().all(|c| c.is_ascii_digit() || " .,+-−–±×%eE[]()/<>≤≥".contains(c)))
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = comfy_table::Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
        if let Some(width) = self.width {
            table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
        }
        table.set_header(self.header.clone());
        for row in &self.rows {
            table.add_row(row.clone());
        }
        for i in 0..self.header.len() {
            if let Some(column) = table.column_mut(i) {
                column.set_cell_alignment(if self.is_numeric(i) { CellAlignment::Right } else { CellAlignment::Left });
            }
        }
        // Trailing blanks would make copied tables and golden files noisy.
        let lines: Vec<String> = table.lines().map(|line| line.trim_end().to_owned()).collect();
        f.write_str(&lines.join("\n"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_numbers_are_set_to_the_right() {
        let mut table = Table::new(["parameter", "value", "95 %"]);
        table.row(["rudder.lift1", "3.193", "[3.1, 3.3]"]).row(["p0", "-0.017", DASH]).row(["short"]);
        let text = table.to_string();
        assert!(table.is_numeric(1) && table.is_numeric(2) && !table.is_numeric(0));
        let ends: Vec<_> = text.lines().filter(|l| l.contains("3.193") || l.contains("-0.017")).collect();
        assert_eq!(ends.len(), 2);
        let end_of = |line: &str, cell: &str| line[..line.find(cell).unwrap() + cell.len()].chars().count();
        assert_eq!(end_of(ends[0], "3.193"), end_of(ends[1], "-0.017"));
        assert!(text.lines().all(|l| l == l.trim_end()));
    }

    #[test]
    fn a_wrapped_table_keeps_to_its_width() {
        let mut table = Table::new(["mechanism", "in words"]);
        table.row(["current", "a steady current that carries the ship over the ground, the same on every heading"]);
        let text = table.wrapped(50).to_string();
        assert!(text.lines().all(|l| l.chars().count() <= 50), "{text}");
        assert!(text.contains("heading"));
    }
}
