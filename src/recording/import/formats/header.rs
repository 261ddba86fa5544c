//! The names and units of the columns of a text file: one line above the data, two or more, or the last comment before it.
//! What a name means is decided elsewhere.

use super::layout::{Layout, comment};
use crate::recording::import::columns::names::{is_unit, meaning, name_and_unit};

/// Names in a line that has another number of fields than the data, from which it is taken for the header.
const NAMED: usize = 2;

/// The header of a file.
pub struct Header<'a> {
    /// Name and unit of each column; its number where no line names them.
    pub names: Vec<(String, Option<String>)>,
    /// The fields of the line of names, by which its repetitions are known; none where no line names the columns.
    pub fields: Option<Vec<&'a str>>,
    /// First line of the data, counted from 1.
    pub first: usize,
    /// A line that names columns and has another number of fields: its number, and theirs.
    pub misfit: Option<(usize, usize)>,
}

/// How many fields are names that are understood.
fn understood(fields: &[&str]) -> usize {
    fields.iter().filter(|f| meaning(&name_and_unit(f).0).is_some()).count()
}

/// The header of a text; `is_value` says what stands in lines of data.
pub fn header<'a>(text: &'a str, layout: &Layout, is_value: impl Fn(&&str) -> bool) -> Header<'a> {
    let written = |(_, line): &(usize, &str)| !line.trim().is_empty();
    let from = text.lines().enumerate().skip(layout.first - 1);
    let mut lines = from.map(|(i, line)| (i + 1, line)).filter(written).peekable();
    let names_columns = |fields: &[&str]| fields.iter().filter(|f| is_value(f)).count() * 2 < fields.len();
    let above = || text.lines().take(layout.first - 1).enumerate().filter(|(_, line)| !line.trim().is_empty());
    let mut fields: Vec<&str> = lines.peek().map_or_else(Vec::new, |(_, line)| layout.fields(line));
    let mut named = names_columns(&fields);
    if named {
        lines.next();
    } else if let Some(line) = above().last().and_then(|(_, line)| comment(line)) {
        // The names may be in the last comment before the data.
        fields = layout.fields(line);
        named = fields.len() == layout.width && names_columns(&fields);
    }
    if !named {
        let all = above().filter(|(_, line)| comment(line).is_none()).map(|(i, line)| (i + 1, layout.fields(line)));
        let mut misfit =
            all.filter(|(_, fields)| understood(fields) >= NAMED).map(|(line, fields)| (line, fields.len()));
        let names = (1..=layout.width).map(|i| (i.to_string(), None)).collect();
        return Header { names, fields: None, first: layout.first, misfit: misfit.next() };
    }
    let second = |lines: &mut std::iter::Peekable<_>| -> Vec<&'a str> {
        let line: Option<&(usize, &'a str)> = lines.peek();
        line.map_or_else(Vec::new, |(_, line)| layout.fields(line))
    };
    // A line of groups may be above that of the names, which leaves blank what the groups name.
    let below = second(&mut lines);
    let groups = below.len() == fields.len() && names_columns(&below) && understood(&below) > understood(&fields);
    let mut names: Vec<(String, Option<String>)> = if groups {
        lines.next();
        below
            .iter()
            .zip(&fields)
            .map(|(name, group)| name_and_unit(if name.is_empty() { group } else { name }))
            .collect()
    } else {
        fields.iter().map(|f| name_and_unit(f)).collect()
    };
    // The next line may contain the units.
    let below = second(&mut lines);
    let unit_of = |f: &str| f.trim_matches(['[', ']', '(', ')']).trim().to_owned();
    if below.iter().any(|f| is_unit(&unit_of(f))) && !below.iter().any(&is_value) {
        lines.next();
        for (name, unit) in names.iter_mut().zip(below) {
            name.1 = Some(unit_of(unit)).filter(|u| is_unit(u)).or(name.1.take());
        }
    }
    let first = lines.peek().map_or(usize::MAX, |(line, _)| *line);
    Header { names, fields: Some(fields), first, misfit: None }
}

#[cfg(test)]
mod tests {
    use super::super::layout::layout;
    use super::*;

    fn read(text: &str) -> Header<'_> {
        header(text, &layout(text).unwrap(), |f| f.starts_with(|c: char| c.is_ascii_digit()))
    }

    fn names(header: &Header<'_>) -> String {
        header.names.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join("|")
    }

    const ROWS: &str = "0,1,2,3\n1,2,3,4\n2,3,4,5\n3,4,5,6\n4,5,6,7\n5,6,7,8\n";

    #[test]
    fn names_may_be_below_a_line_of_groups_and_units_below_the_names() {
        let text = format!("Time,GPS,,Steering\n,Lat,Lon,Rudder\ns,deg,deg,deg\n{ROWS}");
        let found = read(&text);
        assert_eq!((names(&found).as_str(), found.first), ("Time|Lat|Lon|Rudder", 4));
        assert_eq!(found.names[3].1.as_deref(), Some("deg"));
        assert_eq!(names(&read(&format!("t,lat,lon,rudder\n{ROWS}"))), "t|lat|lon|rudder");
    }

    #[test]
    fn a_line_of_names_with_another_number_of_fields_is_seen() {
        for (text, misfit) in [
            (format!("t,lat,lon,Rudder [deg, + port]\n{ROWS}"), Some((1, 5))),
            (format!("a log\nt,lat,Rudder\n{ROWS}"), Some((2, 3))),
            (format!("a heading test\n{ROWS}"), None),
        ] {
            let found = read(&text);
            assert_eq!(found.misfit, misfit, "{text}");
            assert!(found.fields.is_none());
        }
    }
}
