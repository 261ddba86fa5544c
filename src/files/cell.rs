//! Text in a cell of a CSV file that a spreadsheet shows and does not run.
//! How cells are separated and quoted is with the CSV writer.

use super::plain::plain;
use std::borrow::Cow;

/// The text with an apostrophe before it where a spreadsheet would take it for a formula: after `=`, `+`, `@`, `-`, a tabulator
/// or a carriage return (OWASP, CSV injection). Numbers, and a dash alone, stay as they are; what controls a terminal is shown as its number.
pub fn plain_cell(text: &str) -> Cow<'_, str> {
    let text = plain(text);
    let runs = text.starts_with(['=', '+', '@', '-', '\t', '\n', '＝', '＋', '＠', '－']);
    if runs && text != "-" && text.parse::<f64>().is_err() {
        return Cow::Owned(format!("'{text}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_get_an_apostrophe_and_numbers_none() {
        for text in ["=1+1", "+cmd|' /C calc'!A0", "@SUM(A1)", "-2+3", "-run", "\t=1", "＝1+1", "=", "--1"] {
            assert_eq!(plain_cell(text), format!("'{text}"));
        }
        for text in ["-1.5", "+3", "-1e-12", "-inf", "-", "", "ship_a_001", "1-2", "a=b", "'=1"] {
            assert_eq!(plain_cell(text), text);
        }
    }
}
