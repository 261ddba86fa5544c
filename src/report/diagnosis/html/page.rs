//! A diagnosis as one HTML page to forward: verdict, numbers and picture first, then a section a finding, and what it rests on.
//! The order is decided here; what each part says is in its own file.

use super::appendix::{Provenance, command, data, glossary, ship};
use super::finding::{section, withdrawn_section};
use super::opening::opening;
use super::runs::{numbers, picture};
use crate::diagnose::Diagnosis;
use crate::numerals::{fixed, sig};
use crate::report::diagnosis::figures::picture::Picture;
use crate::report::diagnosis::findings::model;
use crate::report::diagnosis::limits::{limits, next_trial, still_open};
use crate::report::diagnosis::location::location;
use crate::report::diagnosis::proof::proof;
use crate::report::diagnosis::verdict::{error_rates, notes, stability, strongest};
use crate::report::html::{Page, Section};
use crate::report::plot::FigureError;
use crate::report::table::Table;
use crate::report::units::Units;
use maud::html;

/// The diagnosis as one page that carries its figures.
///
/// # Errors
/// When the first picture cannot be drawn.
pub fn page(d: &Diagnosis, study: &str, pictures: &[Picture], from: &Provenance) -> Result<Page, FigureError> {
    let runs = d.held_out.as_ref().map_or(d.traces.len(), |h| h.runs);
    let mut page = Page::new(format!("Diagnosis: {study}")).opening(opening(d, study));
    if let Some(first) = picture(d, runs)? {
        page = page.opening(first);
    }
    if let Some(numbers) = numbers(d) {
        page = page.numbers("runs", numbers);
    }
    let mut sections: Vec<Section> = (0..d.findings.len()).filter_map(|i| section(d, i)).collect();
    sections.extend(crate::report::diagnosis::law::section(d));
    sections.extend(withdrawn_section(d));
    sections.extend(body(d, pictures, from));
    sections.extend([glossary(), ship(d), data(d, from), command(d, from)]);
    let page = sections.into_iter().fold(page, Page::section);
    Ok(page.footer(format!("trimtab {}. This page needs nothing outside itself.", env!("CARGO_PKG_VERSION"))))
}

/// The sections on all findings together, each with its figures.
fn body(d: &Diagnosis, pictures: &[Picture], from: &Provenance) -> Vec<Section> {
    let with = |section: Section, part: &str| {
        pictures.iter().filter(|p| p.part == part).fold(section, |s, p| s.figure(p.stem, &p.figure, &p.caption))
    };
    let mut changed = with(Section::new("What changed in the model").list(model(d)), "MODEL");
    if !d.moves.is_empty() {
        changed =
            changed.table(&moves_table(d), "The model's own parameters without and with the findings (SI units).");
    }
    let open = with(Section::new("What is still unexplained").list(still_open(d)), "STILL OPEN");
    let mut out = vec![
        with(Section::new("Where the unexplained force acts").list(location(d)), "WHERE"),
        with(Section::new("Evidence for each mechanism").list(evidence(d)), "VERDICT"),
        changed,
        with(Section::new("Proof on test runs").list(proof(d)), "PROOF"),
        open,
        cannot_show(d),
        Section::new("Trial to sail next").list(next_trial(d)),
    ];
    out.extend(next_commands(from));
    out.extend(reliability(d));
    out
}

/// What the figures of evidence are read with.
fn evidence(d: &Diagnosis) -> Vec<String> {
    let mut lines = vec![format!("{} mechanisms were tested one at a time in the base model", d.ranking.len())];
    lines.extend(strongest(d));
    lines
}

/// What these data could not have shown, and from which size on they would have shown the rest.
fn cannot_show(d: &Diagnosis) -> Section {
    let units = Units::of(&d.base.ship);
    let hidden: Vec<String> = limits(d).into_iter().filter(|line| !line.starts_with("detected with")).collect();
    let section = Section::new("What these data cannot show").list(hidden);
    let mut table = Table::new(["mechanism", "detected from", "unit"]);
    for s in d.detectable.iter().filter(|s| s.size.is_finite()) {
        let (factor, unit) = units.human(&s.unit);
        let of = if s.of_change { ", a change between sessions" } else { "" };
        table.row([
            format!("{}{of}", crate::report::diagnosis::names::title_of(&d.model, &s.mechanism)),
            sig(s.size * factor, 3),
            unit.to_owned(),
        ]);
    }
    if table.rows().is_empty() {
        return section;
    }
    section.table(&table, "Smallest sizes that are detected with a probability of 80 % in such recordings.")
}

/// What to run next; nothing where no model was improved.
fn next_commands(from: &Provenance) -> Option<Section> {
    let (why, commands) = from.next.as_ref()?;
    let lines = html! { @for command in commands { p { code { (command) } } } };
    Some(Section::new("Commands to run next").text(why).markup(lines))
}

/// Repetitions, error rates and notes on the recordings; nothing where there are none.
fn reliability(d: &Diagnosis) -> Option<Section> {
    let mut lines: Vec<String> = d.stability.as_ref().map(stability).into_iter().collect();
    lines.extend(d.error_rates.as_ref().map(error_rates));
    lines.extend(notes(&d.admission.issues));
    (!lines.is_empty()).then(|| Section::new("How far to trust it").list(lines))
}

fn moves_table(d: &Diagnosis) -> Table {
    let mut table = Table::new(["parameter", "before", "after", "standard error", "moved [s.e.]"]);
    for m in &d.moves {
        table.row([m.name.clone(), sig(m.before, 4), sig(m.after, 4), sig(m.error, 2), fixed(m.moved, 1)]);
    }
    table
}
