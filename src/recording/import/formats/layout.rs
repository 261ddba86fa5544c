//! The layout of a text file of numbers: what separates fields, where the header is, and its lines as fields.
//! It decides no meaning and no unit.

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
            Self::Character('|') => "upright strokes",
            Self::Character(_) => "commas",
            Self::Blanks => "blanks",
        }
    }

    /// The fields of a line, without blanks around them and without their quotes. A quote opens only at the start of a field: within
    /// one it may stand for seconds of an arc.
    pub fn fields(self, line: &str) -> Vec<&str> {
        let Self::Character(separator) = self else { return line.split_whitespace().map(bare).collect() };
        let (mut fields, mut start, mut quoted) = (Vec::new(), 0, false);
        for (at, c) in line.char_indices() {
            if c == '"' && (quoted || line[start..at].trim().is_empty()) {
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
    let within = |quote: char| field.strip_prefix(quote).and_then(|f| f.strip_suffix(quote));
    within('"').or_else(|| within('\'')).unwrap_or(field).trim()
}

/// A line of a comment without its mark: `#`, `%` or `//`; `None` for any other line.
pub fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    ["#", "%", "//"].iter().find_map(|mark| line.strip_prefix(mark))
}

/// Text of a file, whatever its encoding: UTF-8, UTF-16 or Latin-1. Lines may end as on any system, and noughts that a logger left
/// at the end of a file are no text.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        // A text without a mark that begins with two letters of the alphabet.
        [a, 0, b, 0, ..] if *a > 0 && *b > 0 => wide(bytes, u16::from_le_bytes),
        [0, a, 0, b, ..] if *a > 0 && *b > 0 => wide(bytes, u16::from_be_bytes),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text.trim_start_matches('\u{feff}').trim_end_matches('\0')),
            Err(_) => Cow::Owned(bytes.iter().map(|b| char::from(*b)).collect()),
        },
    };
    let text = if text.contains('\r') && !text.contains('\n') { Cow::Owned(text.replace('\r', "\n")) } else { text };
    if text.contains('"') { joined(&text).map_or(text, Cow::Owned) } else { text }
}

/// Lines that a row with breaks in its quotes may have.
const QUOTED_LINES: usize = 64;

/// A text without line breaks inside of quotes (RFC 4180, 2.6), which become blanks; blank lines follow, so that every line keeps its number.
/// `None` where there are none.
fn joined(text: &str) -> Option<String> {
    const SEPARATORS: [char; 4] = [',', ';', '\t', '|'];
    let odd = |line: &str| line.bytes().filter(|b| *b == b'"').count() % 2 == 1;
    // A quote that begins a field, and one that ends it: one after a number is that of inches.
    let opens = |line: &str| {
        let before = line.rfind('"').map(|at| line[..at].trim_end_matches(' '));
        odd(line) && before.is_some_and(|before| before.is_empty() || before.ends_with(SEPARATORS))
    };
    let closes = |line: &str| {
        let after = line.find('"').map(|at| line[at + 1..].trim());
        odd(line) && after.is_some_and(|after| after.is_empty() || after.starts_with(SEPARATORS))
    };
    let lines: Vec<&str> = text.lines().collect();
    // Most logs in quotes have none: they are not copied.
    if !lines.iter().any(|line| opens(line)) {
        return None;
    }
    let (mut out, mut next, mut any) = (String::with_capacity(text.len()), 0, false);
    while next < lines.len() {
        let mut below = next + 1..lines.len().min(next + QUOTED_LINES);
        let last = if opens(lines[next]) { below.find(|l| odd(lines[*l])).filter(|l| closes(lines[*l])) } else { None };
        let last = last.unwrap_or(next);
        let whole: Vec<&str> = lines[next..=last].iter().map(|line| line.trim_end_matches('\r')).collect();
        out += &whole.join(" ");
        out += &"\n".repeat(whole.len());
        any |= whole.len() > 1;
        next = last + 1;
    }
    any.then_some(out)
}

fn wide(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Cow<'static, str> {
    let units = bytes.chunks_exact(2).map(|b| unit([b[0], b[1]]));
    Cow::Owned(char::decode_utf16(units).map(|c| c.unwrap_or('\u{fffd}')).collect())
}

/// Lines that are looked at to determine a layout.
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

/// Fields that a line of a log has at most: the largest voyage recorders write a few thousand channels.
const MOST_FIELDS: usize = 20_000;

/// Fields of a line that has more than any log, among the first ones.
pub fn too_wide(text: &str) -> Option<usize> {
    let lines = text.lines().take(LOOKED_AT);
    let widest = |line: &str| {
        let count = |mark: u8| line.bytes().filter(|b| *b == mark).count();
        [b';', b'\t', b',', b'|', b' '].map(count).into_iter().max().unwrap_or(0)
    };
    lines.map(|line| widest(line) + 1).find(|fields| *fields > MOST_FIELDS)
}

/// The layout of a text; `None` where its lines have no number of fields in common.
pub fn layout(text: &str) -> Option<Layout> {
    let wanted = |line: &str| !line.trim().is_empty() && comment(line).is_none();
    let lines: Vec<(usize, &str)> = text.lines().enumerate().filter(|(_, l)| wanted(l)).take(LOOKED_AT).collect();
    let candidates = [';', '\t', ',', '|'].map(Delimiter::Character).into_iter().chain([Delimiter::Blanks]);
    for delimiter in candidates {
        let fields: Vec<Vec<&str>> = lines.iter().map(|(_, line)| delimiter.fields(line)).collect();
        let widths: Vec<usize> = fields.iter().map(Vec::len).collect();
        let usual = most_common(&widths)?;
        let share = widths.iter().filter(|w| **w == usual).count() as f64 / widths.len() as f64;
        // A delimiter at the end of each line separates nothing.
        let trailing = |f: &Vec<&str>| f.len() < usual || f.last().is_some_and(|last| last.is_empty());
        let width = if fields.iter().all(trailing) { usual - 1 } else { usual };
        if width >= 2 && share >= AGREE {
            let fits = |f: &&Vec<&str>| f.len() >= width && f[width..].iter().all(|f| f.is_empty());
            let first = lines.iter().zip(&fields).find(|(_, f)| fits(f)).map_or(1, |((i, _), _)| i + 1);
            return Some(Layout { delimiter, width, first });
        }
    }
    None
}

impl Layout {
    /// The fields of a line, without empty ones beyond the last column.
    pub fn fields<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let mut fields = self.delimiter.fields(line);
        if fields.len() > self.width && fields[self.width..].iter().all(|f| f.is_empty()) {
            fields.truncate(self.width);
        }
        fields
    }
}

fn most_common(widths: &[usize]) -> Option<usize> {
    widths.iter().copied().max_by_key(|w| (widths.iter().filter(|other| *other == w).count(), *w))
}

/// Words for a value that is missing.
const MISSING: [&str; 27] = [
    "",
    "nan",
    "-nan",
    "na",
    "n/a",
    "null",
    "none",
    "-",
    "--",
    "---",
    "inf",
    "-inf",
    "?",
    "*",
    "***",
    "nil",
    "(null)",
    "<na>",
    "\\n",
    "#n/a",
    "#nv",
    "#value!",
    "#div/0!",
    "nan(ind)",
    "-nan(ind)",
    "1.#qnan",
    "-1.#ind",
];

/// A field as a number: `Some(NaN)` for a missing value, `None` for what is no number. A comma may separate the fraction where it
/// does not separate fields.
pub fn number(field: &str, decimal_comma: bool) -> Option<f64> {
    let field = field.trim();
    if MISSING.iter().any(|m| field.eq_ignore_ascii_case(m)) {
        return Some(f64::NAN);
    }
    if !field.starts_with(|c: char| c.is_ascii_digit() || "+-.,".contains(c)) {
        return None;
    }
    let value: f64 = plain(field, decimal_comma)?.parse().ok()?;
    Some(if value.is_finite() { value } else { f64::NAN })
}

/// Whether points part a number into thousands: `1.400`, `-12.345.678`.
fn groups_of_three(field: &str) -> bool {
    let mut groups = field.trim_start_matches(['+', '-']).split('.');
    let is_first = groups.next().is_some_and(|g| (1..=3).contains(&g.len()) && !g.starts_with('0'));
    is_first && groups.all(|g| g.len() == 3 && g.bytes().all(|b| b.is_ascii_digit()))
}

/// A number with a point before its fraction and nothing between its thousands; `None` where marks do not part thousands.
fn plain(field: &str, decimal_comma: bool) -> Option<Cow<'_, str>> {
    let part = |c: char| [',', ' ', '\u{a0}', '\u{202f}', '\''].contains(&c);
    // `1.400` beside `985,5` is a thousand and four hundred.
    let pointed = decimal_comma && field.contains('.');
    if !field.contains(part) && !pointed {
        return Some(Cow::Borrowed(field));
    }
    let (point, comma) = (field.rfind('.'), field.rfind(','));
    // Of a point and a comma the last is the one before the fraction.
    let decimal = match (point, comma) {
        (Some(point), Some(comma)) => Some(point.max(comma)),
        (None, Some(comma)) if decimal_comma && field.matches(',').count() == 1 => Some(comma),
        (Some(_), None) if pointed && groups_of_three(field) => None,
        (point, _) => point,
    };
    let (whole, fraction) = decimal.map_or((field, ""), |at| (&field[..at], &field[at + 1..]));
    let mut groups = whole.split(|c| part(c) || c == '.');
    let first = groups.next()?.trim_start_matches(['+', '-']);
    let parted = whole.contains(|c| part(c) || c == '.');
    let three = groups.all(|g| g.len() == 3 && g.bytes().all(|b| b.is_ascii_digit()));
    if parted && !(three && (1..=3).contains(&first.len()) && !first.starts_with('0')) {
        return None;
    }
    let whole: String = whole.chars().filter(|c| !part(*c) && *c != '.').collect();
    Some(Cow::Owned(format!("{whole}.{fraction}")))
}

/// Whether a comma separates the fraction in numbers that have one: `Some(false)` where it parts thousands, `None` where neither
/// is shown. In `1,234` beside `5.6` it parts thousands, as in `1,234.5`; `1,23` has a fraction.
pub fn decimal_comma<'a>(fields: impl Iterator<Item = &'a str>) -> Option<bool> {
    let (mut points, mut commas) = (false, false);
    for field in fields.filter(|f| f.starts_with(|c: char| c.is_ascii_digit() || "+-.,".contains(c))) {
        let number = |comma: bool| number(field, comma).is_some();
        match (field.rfind('.'), field.rfind(',')) {
            (Some(point), Some(comma)) if number(true) => return Some(comma > point),
            (Some(_), None) => points |= number(false),
            (None, Some(_)) if number(true) && !number(false) => return Some(true),
            (None, Some(_)) => commas |= number(true),
            _ => {}
        }
    }
    if !commas {
        return Some(!points);
    }
    points.then_some(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layout_is_determined_from_the_lines() {
        let cases = [
            ("t;x\n0,5;1,5\n1,0;2,5\n", Delimiter::Character(';'), 2, 1),
            ("logger 7\n\nt\tx\ty\n0\t1\t2\n1\t1\t2\n2\t1\t3\n3\t1\t3\n", Delimiter::Character('\t'), 3, 3),
            ("# a, comment\nt,\"x, y\"\n0,1\n", Delimiter::Character(','), 2, 2),
            ("t   x\n0.0 1.0\n 1.0  2.0\n", Delimiter::Blanks, 2, 1),
            ("t | x\n0 | 1\n", Delimiter::Character('|'), 2, 1),
            ("t,x\n0,1,\n1,2,\n", Delimiter::Character(','), 2, 1),
            ("t,x,\n0,1\n1,2\n", Delimiter::Character(','), 2, 1),
            ("% a; b; c\n// d; e\nt;lat\n0;54°02'33\"N\n1;54°02'34\"N\n", Delimiter::Character(';'), 2, 3),
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
        for text in ["1,234.5", "1.234,5", "1 234,5", "1\u{a0}234.5"] {
            assert_eq!(number(text, true), Some(1234.5), "{text}");
        }
        assert_eq!((number("1,234", false), number("1,234", true)), (Some(1234.0), Some(1.234)));
        assert_eq!((number("12,34", false), number("51 30.25", false)), (None, None));
        for missing in ["n/a", "#N/A", "(null)", "1.#QNAN", "-Infinity"] {
            assert!(number(missing, false).unwrap().is_nan(), "{missing}");
        }
        assert!(number("abc", false).is_none());
        let comma = |fields: &[&'static str]| decimal_comma(fields.iter().copied());
        assert_eq!(
            (comma(&["1,5", "2"]), comma(&["1,234", "5.6"]), comma(&["1,234.5"])),
            (Some(true), Some(false), Some(false))
        );
        assert_eq!((comma(&["1,234", "20:15"]), comma(&["1.234,5"])), (None, Some(true)));
    }

    #[test]
    fn a_line_break_in_quotes_is_a_blank_and_lines_keep_their_numbers() {
        let of = |text: &str| decoded(text.as_bytes()).into_owned();
        assert_eq!(of("\"Time\n(UTC)\",\"Rudder\r\n(deg)\"\r\n1,2\n"), "\"Time (UTC)\",\"Rudder (deg)\"\n\n\n1,2\n");
        // Inches, and a quote that nothing closes.
        for text in ["t,size\n1,12\"\n2,12\"\n", "t,\"size\n1,12\n2,12\n"] {
            assert_eq!(of(text), text);
        }
    }

    #[test]
    fn any_encoding_is_text() {
        assert_eq!(decoded(b"psi [\xb0]"), "psi [°]");
        assert_eq!(decoded(&[0xff, 0xfe, b't', 0, b'\n', 0]), "t\n");
        assert_eq!(decoded(&[b't', 0, b'\n', 0]), "t\n");
        assert_eq!((decoded(b"t\r0\r"), decoded(b"t\n0\n\0\0")), ("t\n0\n".into(), "t\n0\n".into()));
    }
}
