//! The layout of a text file of numbers: what separates fields, where the header is, and its lines as fields.
//! It tells no meaning and no unit.

use std::borrow::Cow;

/// What separates the fields of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// One character.
    Character(char),
    /// Any run of blanks.
    Blanks,
}

impl Delimiter {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Character(';') => "semicolons",
            Self::Character('\t') => "tabs",
            Self::Character(_) => "commas",
            Self::Blanks => "blanks",
        }
    }

    /// The fields of a line, without blanks around them and without their quotes.
    pub fn fields(self, line: &str) -> Vec<&str> {
        let Self::Character(separator) = self else { return line.split_whitespace().collect() };
        let (mut fields, mut start, mut quoted) = (Vec::new(), 0, false);
        for (at, c) in line.char_indices() {
            if c == '"' {
                quoted = !quoted;
            } else if c == separator && !quoted {
                fields.push(bare(&line[start..at]));
                start = at + c.len_utf8();
            }
        }
        fields.push(bare(&line[start..]));
        fields
    }
}

fn bare(field: &str) -> &str {
    let field = field.trim();
    field.strip_prefix('"').and_then(|f| f.strip_suffix('"')).unwrap_or(field).trim()
}

/// Text of a file, whatever its encoding: UTF-8, UTF-16 with a mark, or Latin-1.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let wide = |swap: bool| {
        let units =
            bytes[2..].chunks_exact(2).map(|b| u16::from_le_bytes(if swap { [b[1], b[0]] } else { [b[0], b[1]] }));
        Cow::Owned(char::decode_utf16(units).map(|c| c.unwrap_or('\u{fffd}')).collect())
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(false),
        [0xfe, 0xff, ..] => wide(true),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text.trim_start_matches('\u{feff}')),
            Err(_) => Cow::Owned(bytes.iter().map(|b| char::from(*b)).collect()),
        },
    }
}

/// Lines that are looked at to tell a layout.
const LOOKED_AT: usize = 200;
/// Share of them that must agree.
const AGREE: f64 = 0.6;

/// The layout of a text.
#[derive(Clone, Debug)]
pub struct Layout {
    /// What separates fields.
    pub delimiter: Delimiter,
    /// Fields of a line.
    pub width: usize,
    /// First line with so many fields, counted from 1.
    pub first: usize,
}

/// The layout of a text; `None` where its lines have no number of fields in common.
pub fn layout(text: &str) -> Option<Layout> {
    let lines: Vec<(usize, &str)> =
        text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty() && !l.starts_with('#')).take(LOOKED_AT).collect();
    let candidates = [';', '\t', ','].map(Delimiter::Character).into_iter().chain([Delimiter::Blanks]);
    for delimiter in candidates {
        let widths: Vec<usize> = lines.iter().map(|(_, line)| delimiter.fields(line).len()).collect();
        let usual = most_common(&widths)?;
        let share = widths.iter().filter(|w| **w == usual).count() as f64 / widths.len() as f64;
        if usual >= 2 && share >= AGREE {
            let first = lines.iter().zip(&widths).find(|(_, w)| **w == usual).map_or(1, |((i, _), _)| i + 1);
            return Some(Layout { delimiter, width: usual, first });
        }
    }
    None
}

fn most_common(widths: &[usize]) -> Option<usize> {
    widths.iter().copied().max_by_key(|w| (widths.iter().filter(|other| *other == w).count(), *w))
}

/// Words for a value that is missing.
const MISSING: [&str; 12] = ["", "nan", "-nan", "na", "n/a", "null", "none", "-", "--", "---", "inf", "?"];

/// A field as a number: `Some(NaN)` for a missing value, `None` for what is no number. A comma may separate the fraction where it
/// does not separate fields; a letter N, S, E or W after a number gives its sign.
pub fn number(field: &str, decimal_comma: bool) -> Option<f64> {
    let field = field.trim();
    if MISSING.iter().any(|m| field.eq_ignore_ascii_case(m)) {
        return Some(f64::NAN);
    }
    let (field, sign) = match field.char_indices().last() {
        Some((at, 'N' | 'E')) => (field[..at].trim_end(), 1.0),
        Some((at, 'S' | 'W')) => (field[..at].trim_end(), -1.0),
        Some((at, '°')) => (field[..at].trim_end(), 1.0),
        _ => (field, 1.0),
    };
    let field = field.trim_end_matches('°');
    if !field.starts_with(|c: char| c.is_ascii_digit() || "+-.,".contains(c)) {
        return None;
    }
    let value: f64 = if decimal_comma && field.contains(',') {
        // Dots before a comma part thousands.
        let whole = if field.contains('.') { field.replace('.', "") } else { field.to_owned() };
        whole.replace(',', ".").parse().ok()?
    } else {
        field.parse().ok()?
    };
    Some(sign * if value.is_finite() { value } else { f64::NAN })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layout_is_told_from_the_lines() {
        let cases = [
            ("t;x\n0,5;1,5\n1,0;2,5\n", Delimiter::Character(';'), 2, 1),
            ("logger 7\n\nt\tx\ty\n0\t1\t2\n1\t1\t2\n2\t1\t3\n3\t1\t3\n", Delimiter::Character('\t'), 3, 3),
            ("# a, comment\nt,\"x, y\"\n0,1\n", Delimiter::Character(','), 2, 2),
            ("t   x\n0.0 1.0\n 1.0  2.0\n", Delimiter::Blanks, 2, 1),
        ];
        for (text, delimiter, width, first) in cases {
            let found = layout(text).unwrap();
            assert_eq!((found.delimiter, found.width, found.first), (delimiter, width, first), "{text}");
        }
        assert!(layout("one\ntwo\nthree\n").is_none() && layout("").is_none());
    }

    #[test]
    fn numbers_are_read_as_people_write_them() {
        assert_eq!(number("1.234,5", true), Some(1234.5));
        assert_eq!(number("-0,25", true), Some(-0.25));
        assert_eq!(number("54.5 S", false), Some(-54.5));
        assert!(number("n/a", false).unwrap().is_nan() && number("abc", false).is_none());
    }

    #[test]
    fn any_encoding_is_text() {
        assert_eq!(decoded(b"psi [\xb0]"), "psi [°]");
        assert_eq!(decoded(&[0xff, 0xfe, b't', 0, b'\n', 0]), "t\n");
    }
}
