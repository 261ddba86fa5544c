//! The dossier as one HTML page: opening, then the sections in the order of the document, each with what is missing first.
//! What stands in a section is in `tables`.

use super::reader::{Digits, Reader};
use super::tables;
use crate::report::html::{Page, Section};
use maud::{Markup, html};
use serde_json::Value;

/// The page of a document, that of `trimtab dossier` under its key `result`.
pub fn page(document: &Value) -> Page {
    let d = Reader::new(document);
    let page = Page::new(format!("Validation dossier: {}", d.at("study").text())).opening(opening(&d));
    let page = d.at("sections").entries().iter().enumerate().fold(page, |page, (i, s)| {
        let section = Section::new(format!("{}. {}", i + 1, s.at("title").text()));
        page.section(body(&d, s.at("key").text(), section.markup(missing(s))))
    });
    page.footer(format!(
        "Made by trimtab {}. This page needs nothing outside itself; every number in it is in dossier.json.",
        d.path(&["inputs", "version"]).text()
    ))
}

/// What a reader sees first: the claim, and three numbers.
fn opening(d: &Reader) -> Markup {
    let test = d.path(&["validation", "test"]);
    let checks = d.path(&["verification", "checks"]).entries();
    let passed = checks.iter().filter(|c| c.at("passed").holds()).count();
    let missing: Vec<Reader> =
        d.at("sections").entries().into_iter().filter(|s| !s.at("missing").entries().is_empty()).collect();
    html! {
        p.subject { "In the order of " (d.at("procedure").text()) "." }
        p.verdict { (d.path(&["claim", "statement"]).text()) }
        div.numbers {
            @if test.is_there() {
                div {
                    strong { (test.path(&["md_fitted", "x", "value"]).number(1.0, Digits::Significant(3))) " m, "
                        (test.path(&["md_fitted", "psi", "value"]).number(1f64.to_degrees(), Digits::Significant(3))) " deg" }
                    span { "mean deviation of position north and of heading on " (test.at("runs").count()) " test runs" }
                }
                div {
                    strong { (test.path(&["cvdm_fitted", "value"]).number(1.0, Digits::Significant(3))) " %" }
                    span { "mean cVDM " (test.path(&["cvdm_fitted", "ci95"]).interval(1.0, Digits::Significant(3))) " on test runs" }
                }
            }
            div {
                strong { @if passed == checks.len() { "All passed" } @else { "Not all passed" } }
                span { "checks of the verification; see section " (section_of(d, "verification")) }
            }
        }
        @if !missing.is_empty() {
            p.subject {
                "Something is missing in: "
                @for (i, s) in missing.iter().enumerate() { @if i > 0 { "; " } (s.at("title").text()) }
                ". Each section says what."
            }
        }
    }
}

/// The number of a section, as its heading has it.
fn section_of(d: &Reader, key: &str) -> String {
    let place = d.at("sections").entries().iter().position(|s| s.at("key").text() == key);
    place.map_or(String::new(), |i| (i + 1).to_string())
}

/// What a section lacks.
fn missing(section: &Reader) -> Markup {
    let all = section.at("missing").entries();
    html! {
        @if !all.is_empty() {
            p { span class="grade suspected" { "missing" } }
            ul { @for m in &all { li { (m.text()) } } }
        }
    }
}

fn body(d: &Reader, key: &str, section: Section) -> Section {
    match key {
        "claim" => section.markup(tables::claim(&d.at(key))),
        "ship" => section.markup(tables::ship(&d.at(key))),
        "inputs" => section.markup(tables::inputs(&d.at(key))),
        "model" => section.markup(tables::model(&d.at(key))),
        "verification" => section.markup(tables::verification(&d.at(key))),
        "validation" => section.markup(tables::validation(&d.at(key))),
        "error_rates" => section.markup(tables::error_rates(&d.at(key))),
        "causes" => section.markup(tables::causes(&d.at(key))),
        "limits" => section.markup(html! { ul { @for l in d.at(key).entries() { li { (l.text()) } } } }),
        _ => section,
    }
}
