//! Tables and numbers as text: one table type for the terminal and for HTML, and number formatting that never prints NaN.
//! It decides how values read, not which values are worth reporting.

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, presets};
use std::fmt;

/// What stands where there is no value.
pub const DASH: &str = "–";

/// `x` with `digits` significant digits; a dash when it is not finite.
///
/// Plain decimals from 1e-4 up to 1e6, scientific notation (`1.23e-7`) outside.
#[must_use]
pub fn sig(x: f64, digits: usize) -> String {
    if !x.is_finite() {
        return DASH.to_owned();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.clamp(1, 17);
    // Rounding first decides the exponent: 9.96 with two digits is 10, not 10.0.
    let scientific = format!("{x:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return format!("{mantissa}e{exponent}");
    }
    let decimals = digits as i32 - 1 - exponent;
    if decimals >= 0 {
        format!("{x:.*}", decimals as usize)
    } else {
        let unit = 10f64.powi(-decimals);
        format!("{:.0}", (x / unit).round() * unit)
    }
}

/// `x` with `decimals` digits after the point; a dash when it is not finite, and no minus sign on zero.
#[must_use]
pub fn fixed(x: f64, decimals: usize) -> String {
    if !x.is_finite() {
        return DASH.to_owned();
    }
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

/// `[lo, hi]` with `digits` significant digits; a dash for an end that is not finite.
#[must_use]
pub fn interval(lo: f64, hi: f64, digits: usize) -> String {
    format!("[{}, {}]", sig(lo, digits), sig(hi, digits))
}

/// `3` as `³`, `-6` as `⁻⁶`.
pub(super) fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    n.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])).collect()
}

/// A table of text cells. Columns of numbers are set to the right, others to the left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    width: Option<u16>,
}

impl Table {
    /// An empty table with these column headings.
    #[must_use]
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
    #[must_use]
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
    fn sig_keeps_the_digits_that_count() {
        for (x, digits, text) in [
            (34187.03, 5, "34187"),
            (34187.03, 3, "34200"),
            (0.0123456, 3, "0.0123"),
            (1.2, 3, "1.20"),
            (9.96, 2, "10"),
            (-0.0469, 2, "-0.047"),
            (1.234e-7, 3, "1.23e-7"),
            (2.5e9, 2, "2.5e9"),
            (999_999.9, 3, "1.00e6"),
            (0.0, 3, "0"),
            (-0.0, 3, "0"),
        ] {
            assert_eq!(sig(x, digits), text, "sig({x}, {digits})");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_print_as_a_dash() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(sig(x, 3), DASH);
            assert_eq!(fixed(x, 2), DASH);
        }
        assert_eq!(interval(f64::NEG_INFINITY, 1.5, 2), "[–, 1.5]");
    }

    #[test]
    fn sig_is_within_half_a_unit_of_the_last_digit() {
        let mut x = 1.7e-9;
        while x < 1e9 {
            for digits in 1..8 {
                let read: f64 = sig(x, digits).parse().unwrap();
                assert!((read / x - 1.0).abs() <= 0.5001 * 10f64.powi(1 - digits as i32), "{x} {digits} {read}");
            }
            x *= 3.9;
        }
    }

    #[test]
    fn fixed_never_prints_minus_zero() {
        assert_eq!(fixed(-0.001, 1), "0.0");
        assert_eq!(fixed(-0.06, 1), "-0.1");
    }

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
