//! How text is shown on a terminal: as wide as it is, and with colour where there is one.
//! What is said, and how tables are laid out, is decided elsewhere.

use std::io::{IsTerminal, stderr, stdout};

/// Width of standard output: that of the variable COLUMNS, else of the terminal; nothing where there is neither.
pub fn columns() -> Option<usize> {
    let given = std::env::var("COLUMNS").ok().and_then(|text| text.trim().parse().ok()).filter(|n| *n > 0);
    let size = || terminal_size::terminal_size_of(stdout()).map(|(terminal_size::Width(n), _)| usize::from(n));
    given.or_else(|| stdout().is_terminal().then(size).flatten())
}

/// Whether colours are wanted on a stream: on a terminal without NO_COLOR, or with CLICOLOR_FORCE.
fn colours(is_terminal: bool) -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty() && v != "0");
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    !set("NO_COLOR") && (set("CLICOLOR_FORCE") || (is_terminal && !dumb))
}

/// A text for standard output.
pub fn shown(text: &str) -> String {
    let wrapped = columns().map_or_else(|| text.to_owned(), |width| fitted(text, width));
    if colours(stdout().is_terminal()) { painted(&wrapped) } else { wrapped }
}

/// A line for standard error.
pub fn on_stderr(line: &str) -> String {
    if colours(stderr().is_terminal()) { painted(line) } else { line.to_owned() }
}

/// A text whose lines end at a width; what goes on is indented by two more than its line. A word longer than the width stays whole, so
/// that a path can be copied.
fn fitted(text: &str, width: usize) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        if line.trim_end().chars().count() <= width {
            out += line;
            continue;
        }
        let indent = line.chars().take_while(|c| *c == ' ').count();
        let mut column = 0;
        for word in line.trim_end().split_inclusive(' ') {
            let length = word.trim_end().chars().count();
            if column > indent + 2 && column + length > width {
                out.truncate(out.trim_end_matches(' ').len());
                out += &format!("\n{}", " ".repeat(indent + 2));
                column = indent + 2;
            }
            out += word;
            column += word.chars().count();
        }
        out.truncate(out.trim_end_matches(' ').len());
        if line.ends_with('\n') {
            out.push('\n');
        }
    }
    out
}

const RED: &str = "\u{1b}[31m";
const GREEN: &str = "\u{1b}[32m";
const YELLOW: &str = "\u{1b}[33m";
const PLAIN: &str = "\u{1b}[0m";

/// A text with its verdicts in colour: `met` green and `NOT met` red at the end of a line, `warning` and `error` at its beginning.
fn painted(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let body = line.trim_end();
        let tail = &line[body.len()..];
        let verdict = [("NOT met", RED), (" met", GREEN)].iter().find(|(word, _)| body.ends_with(word)).copied();
        let begin = [("warning", YELLOW), ("error", RED), ("trimtab:", RED)];
        let level = begin.iter().find(|(word, _)| body.starts_with(word)).copied();
        match (verdict, level) {
            (Some((word, colour)), _) => {
                let (before, word) = body.split_at(body.len() - word.len());
                out += &format!("{before}{colour}{word}{PLAIN}");
            }
            (None, Some((word, colour))) => out += &format!("{colour}{word}{PLAIN}{}", &body[word.len()..]),
            (None, None) => out += body,
        }
        out += tail;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_go_on_indented_and_long_words_stay_whole() {
        let text = "short\n  one two three four five\n/a/very/long/path/that/has/no/blank then\n";
        assert_eq!(
            fitted(text, 16),
            "short\n  one two three\n    four five\n/a/very/long/path/that/has/no/blank\n  then\n"
        );
        assert_eq!(fitted("one line", 40), "one line");
    }

    #[test]
    fn verdicts_and_warnings_have_a_colour_and_words_within_a_line_have_none() {
        let text = painted("advance  3.1  met\ndiameter  5.2  NOT met\nit has met them all\nwarning: x\n");
        assert!(text.contains(&format!("3.1 {GREEN} met{PLAIN}\n")), "{text:?}");
        assert!(
            text.contains(&format!("{RED}NOT met{PLAIN}\n")) && text.contains(&format!("{YELLOW}warning{PLAIN}: x"))
        );
        assert!(text.contains("it has met them all\n"));
    }
}
