//! A diagnosis as one HTML page with its figures.
//! What it says is in `parts`.

use super::parts::parts;
use super::picture::Picture;
use super::verdict::subject;
use crate::diagnose::Diagnosis;
use crate::numerals::{fixed, sig};
use crate::report::html::{Page, Section};
use crate::report::table::Table;

/// The diagnosis as one page that carries its figures.
pub fn page(d: &Diagnosis, study: &str, pictures: &[Picture]) -> Page {
    let mut page = Page::new(format!("Diagnosis: {study}")).lede(d.headline.clone()).lede(subject(d, study));
    for part in parts(d) {
        let mut section = Section::new(sentence_case(part.heading)).list(&part.lines);
        for p in pictures.iter().filter(|p| p.part == part.heading) {
            section = section.png(&p.png, &p.title, p.caption);
        }
        if part.heading == "MODEL" && !d.moves.is_empty() {
            section =
                section.table(&moves_table(d), "The model's own parameters without and with the findings (SI units).");
        }
        page = page.section(section);
    }
    let footer = format!(
        "trimtab {} · alpha {} · at most {} mechanisms · seed {}{}",
        env!("CARGO_PKG_VERSION"),
        d.settings.alpha,
        d.settings.most,
        d.settings.seed,
        if d.settings.withhold.is_empty() {
            String::new()
        } else {
            format!(" · withheld: {}", d.settings.withhold.join(", "))
        }
    );
    page.footer(footer)
}

fn sentence_case(heading: &str) -> String {
    let mut letters = heading.chars();
    letters.next().map_or(String::new(), |first| first.to_string() + &letters.as_str().to_lowercase())
}

fn moves_table(d: &Diagnosis) -> Table {
    let mut table = Table::new(["parameter", "before", "after", "standard error", "moved [s.e.]"]);
    for m in &d.moves {
        table.row([m.name.clone(), sig(m.before, 4), sig(m.after, 4), sig(m.error, 2), fixed(m.moved, 1)]);
    }
    table
}
