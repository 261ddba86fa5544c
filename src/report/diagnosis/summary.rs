//! A diagnosis for a terminal: numbered parts with a hanging margin.
//! What they say is in `parts`.

use super::parts::parts;
use super::verdict::subject;
use crate::diagnose::Diagnosis;
use crate::report::paragraph::wrapped;
use crate::report::width::width;

/// Width of the terminal summary \[characters\].
const WIDTH: usize = 100;
/// Width of its left margin with number and heading.
const MARGIN: usize = 16;

/// The diagnosis for a terminal.
#[must_use]
pub fn summary(d: &Diagnosis, study: &str) -> String {
    let mut text = wrapped(&format!("{:<MARGIN$}", "DIAGNOSIS"), MARGIN, width().min(WIDTH), &subject(d, study));
    for (i, part) in parts(d).iter().enumerate() {
        for (j, line) in part.lines.iter().enumerate() {
            let lead = if j == 0 { format!(" {} {:<13}", i + 1, part.heading) } else { " ".repeat(MARGIN) };
            text += &wrapped(&lead, MARGIN, width().min(WIDTH), line);
        }
    }
    text
}
