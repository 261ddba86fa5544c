//! A table of text cells, the same one for the terminal and for HTML.
//! It lays cells out; how a number reads is decided in `numerals`, and which values are worth a row by the caller.

use super::paragraph::wrapped;
use super::width::width;
use crate::files::plain;
use crate::numerals::{DASH, sig};
use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Width, presets};
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

    /// Whether column `i` contains numbers (and dashes) only.
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
    /// The table within the width that is set ([`super::width`]): long cells are divided between words, and where even that does not do, each
    /// row becomes a block of lines `heading  value`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.width.map_or(usize::MAX, usize::from).min(width());
        if self.least_width() > width {
            return f.write_str(&self.blocks(width));
        }
        let mut table = comfy_table::Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
        table.set_content_arrangement(ContentArrangement::Dynamic).set_width(u16::try_from(width).unwrap_or(u16::MAX));
        table.set_header(self.header.clone());
        for row in &self.rows {
            table.add_row(row.clone());
        }
        for i in 0..self.header.len() {
            let least = self.longest_word(i);
            if let Some(column) = table.column_mut(i) {
                column.set_cell_alignment(if self.is_numeric(i) { CellAlignment::Right } else { CellAlignment::Left });
                // No word and no number is cut in two; a column counts its blanks too.
                let least = u16::try_from(least + 2).unwrap_or(u16::MAX);
                column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(least)));
            }
        }
        // Trailing blanks would make copied tables and golden files noisy.
        let lines: Vec<String> = table.lines().map(|line| line.trim_end().to_owned()).collect();
        if lines.iter().any(|line| line.chars().count() > width) {
            return f.write_str(&self.blocks(width));
        }
        f.write_str(&lines.join("\n"))
    }
}

impl Table {
    /// Length of the longest word of a column, heading included.
    fn longest_word(&self, i: usize) -> usize {
        let cells = self.rows.iter().filter_map(|row| row.get(i)).chain(self.header.get(i));
        cells.flat_map(|cell| cell.split_whitespace()).map(|word| word.chars().count()).max().unwrap_or(0)
    }

    /// Width below which words would be cut: every column has a blank on each side.
    fn least_width(&self) -> usize {
        (0..self.header.len()).map(|i| self.longest_word(i) + 2).sum::<usize>()
    }

    /// Each row as a block: its first cell, then a line for each of the others that is not empty.
    fn blocks(&self, width: usize) -> String {
        let longest = self.header.iter().skip(1).map(|h| h.chars().count()).max().unwrap_or(0).min(width / 2);
        let block = |row: &Vec<String>| {
            let cells = row.iter().zip(&self.header).skip(1).filter(|(cell, _)| !cell.is_empty());
            let line = |(cell, heading): (&String, &String)| {
                wrapped(&format!("  {heading:<longest$}  "), longest + 4, width, cell)
            };
            let first = row.first().map_or("", String::as_str);
            format!("{first}\n{}", cells.map(line).collect::<String>())
        };
        self.rows.iter().map(block).collect::<String>().trim_end().to_owned()
    }

    /// The table as LaTeX with the rules of booktabs, numbers to four significant digits.
    #[must_use]
    pub fn latex(&self) -> String {
        let columns: String = (0..self.header.len()).map(|i| if self.is_numeric(i) { 'r' } else { 'l' }).collect();
        let line = |cells: &[String]| cells.iter().map(|c| latex_cell(&short(c))).collect::<Vec<_>>().join(" & ");
        let rows: String = self.rows.iter().map(|row| format!("  {} \\\\\n", line(row))).collect();
        let header = line(&self.header);
        format!(
            "\\begin{{tabular}}{{{columns}}}\n  \\toprule\n  {header} \\\\\n  \\midrule\n{rows}  \\bottomrule\n\\end{{tabular}}\n"
        )
    }

    /// The table as Markdown, numbers to four significant digits.
    #[must_use]
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            format!("| {} |\n", cells.iter().map(|c| markdown_cell(&short(c))).collect::<Vec<_>>().join(" | "))
        };
        let sides: String = (0..self.header.len()).map(|i| if self.is_numeric(i) { "---:|" } else { "---|" }).collect();
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        format!("{}|{sides}\n{rows}", line(&self.header))
    }
}

/// A cell as it reads in a paper: a number to four significant digits.
fn short(cell: &str) -> String {
    match cell.parse::<f64>() {
        Ok(x) if x.is_finite() && cell.len() > 5 => sig(x, 4),
        _ => cell.to_owned(),
    }
}

/// A cell without characters that mean something to Markdown, HTML in it, or a terminal.
fn markdown_cell(cell: &str) -> String {
    let mut text = String::with_capacity(cell.len());
    for c in plain(cell).chars() {
        match c {
            '&' => text += "&amp;",
            '<' => text += "&lt;",
            '>' => text += "&gt;",
            '|' | '\\' | '`' | '*' => text.extend(['\\', c]),
            '\n' => text.push(' '),
            other => text.push(other),
        }
    }
    text
}

/// A cell without characters that mean something to LaTeX or a terminal.
fn latex_cell(cell: &str) -> String {
    let mut text = String::with_capacity(cell.len());
    for c in plain(cell).chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => text.extend(['\\', c]),
            '\\' => text += "\\textbackslash{}",
            '~' => text += "\\textasciitilde{}",
            '^' => text += "\\textasciicircum{}",
            '<' => text += "$<$",
            '>' => text += "$>$",
            '\u{2013}' => text += "--",
            '\n' => text.push(' '),
            other => text.push(other),
        }
    }
    // A row that begins with a bracket would be an argument of the line break before it.
    if text.starts_with('[') { format!("{{}}{text}") } else { text }
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

    #[test]
    fn a_table_fits_every_width_and_no_word_is_cut() {
        let mut table = Table::new(["run", "split", "x [m]", "psi [deg]", "verdict"]);
        table.row(["zigzag_20_20_starboard", "train", "12.345", "-0.12345", "met in all of the windows"]);
        for columns in 40..=120 {
            let text = super::super::width::at_width(columns, || table.to_string());
            assert!(text.lines().all(|l| l.chars().count() <= columns), "{columns}:\n{text}");
            for word in ["zigzag_20_20_starboard", "-0.12345", "psi", "windows"] {
                assert!(text.contains(word), "{columns}: {word}\n{text}");
            }
        }
    }

    #[test]
    fn latex_and_markdown_hold_every_cell() {
        let mut table = Table::new(["parameter", "value", "95 %"]);
        table.row(["rudder.lift_1", "3.19312345", "[3.1, 3.3]"]).row(["a|b & c", "-0.017", DASH]);
        let latex = table.latex();
        assert!(latex.starts_with("\\begin{tabular}{lrr}\n  \\toprule\n") && latex.contains("\\bottomrule"), "{latex}");
        assert!(
            latex.contains("rudder.lift\\_1 & 3.193 & {}[3.1, 3.3] \\\\\n") && latex.contains("a|b \\& c"),
            "{latex}"
        );
        let text = "| parameter | value | 95 % |\n|---|---:|---:|\n| rudder.lift_1 | 3.193 | [3.1, 3.3] |\n";
        assert!(table.markdown().starts_with(text) && table.markdown().contains("a\\|b"), "{}", table.markdown());
    }

    #[test]
    fn a_cell_is_neither_html_nor_a_command_to_a_terminal() {
        let mut table = Table::new(["run"]);
        table.row(["<script>alert(1)</script>\u{1b}[2J"]);
        assert!(table.markdown().contains("&lt;script&gt;alert(1)&lt;/script&gt;\\\\u{1b}[2J"), "{}", table.markdown());
        assert!(!table.latex().contains('\u{1b}'), "{}", table.latex());
    }
}
