//! One HTML page that carries everything it shows: headings, paragraphs, tables, and figures drawn from numbers in the page.
//! Nothing comes from outside the file, so that it reads the same offline, printed, and years later.

use super::table::Table;
use crate::report::plot::Figure;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::{Map, Value};

const STYLE: &str = include_str!("assets/page.css");
/// What draws the figures, with hover and zoom.
const SCRIPT: &str = include_str!("assets/figures.js");
/// What a reader sees in place of a figure where no script runs.
const NO_SCRIPT: &str =
    "This figure needs a browser that runs the script in this page; the same figure is in the folder `figures`.";

/// A part of a page under one heading.
#[derive(Clone, Debug)]
#[must_use]
pub struct Section {
    heading: String,
    /// Words beside the heading, and their class.
    badge: Option<(String, &'static str)>,
    blocks: Vec<Markup>,
    figures: Vec<(String, Value)>,
}

impl Section {
    /// An empty section.
    pub fn new(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), badge: None, blocks: vec![], figures: vec![] }
    }

    /// The same section with words beside its heading, in the style of a class.
    pub fn badge(self, words: impl Into<String>, class: &'static str) -> Self {
        Self { badge: Some((words.into(), class)), ..self }
    }

    /// The same section with one more paragraph.
    pub fn text(self, paragraph: &str) -> Self {
        self.markup(html! { p { (paragraph) } })
    }

    /// The same section with a list.
    pub fn list<S: AsRef<str>>(self, items: impl IntoIterator<Item = S>) -> Self {
        self.markup(html! { ul { @for item in items { li { (item.as_ref()) } } } })
    }

    /// The same section with a table. An empty caption is left out.
    pub fn table(self, table: &Table, caption: &str) -> Self {
        let class = |i: usize| table.is_numeric(i).then_some("number");
        self.markup(html! {
            div.scroll { table {
                @if !caption.is_empty() { caption { (caption) } }
                thead { tr { @for (i, cell) in table.header().iter().enumerate() { th class=[class(i)] { (cell) } } } }
                tbody {
                    @for row in table.rows() {
                        tr { @for (i, cell) in row.iter().enumerate() { td class=[class(i)] { (cell) } } }
                    }
                }
            } }
        })
    }

    /// The same section with a figure: its numbers go into the page, and are drawn where it is read.
    pub fn figure(mut self, stem: &str, figure: &Figure, caption: &str) -> Self {
        self.figures.push((stem.to_owned(), figure.data()));
        self.markup(html! {
            figure {
                @if !figure.title.is_empty() { h3 { (figure.title) } }
                div data-figure=(stem) { noscript { (NO_SCRIPT) } }
                @if !caption.is_empty() { figcaption { (caption) } }
            }
        })
    }

    /// The same section with markup of the caller's own.
    pub fn markup(mut self, block: Markup) -> Self {
        self.blocks.push(block);
        self
    }
}

/// A page.
#[derive(Clone, Debug)]
#[must_use]
pub struct Page {
    title: String,
    opening: Vec<Markup>,
    sections: Vec<Section>,
    footer: String,
    numbers: Map<String, Value>,
}

impl Page {
    /// An empty page.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), opening: vec![], sections: vec![], footer: String::new(), numbers: Map::new() }
    }

    /// The same page with more before its first section: what a reader must see first.
    pub fn opening(mut self, block: Markup) -> Self {
        self.opening.push(block);
        self
    }

    /// The same page with one more section.
    pub fn section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }

    /// The same page with a last line: what made it, from what, with which seed.
    pub fn footer(self, text: impl Into<String>) -> Self {
        Self { footer: text.into(), ..self }
    }

    /// The same page with numbers that its script draws, under a name that the script knows.
    pub fn numbers(mut self, name: &str, numbers: Value) -> Self {
        self.numbers.insert(name.to_owned(), numbers);
        self
    }

    /// The page as one HTML document.
    #[must_use]
    pub fn render(&self) -> String {
        let numbers = self.script_numbers();
        html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    h1 { (self.title) }
                    @for block in &self.opening { (block) }
                    @if self.sections.len() > 2 {
                        nav { @for (i, s) in self.sections.iter().enumerate() { a href={ "#s" (i + 1) } { (s.heading) } " " } }
                    }
                    @for (i, section) in self.sections.iter().enumerate() {
                        section id={ "s" (i + 1) } {
                            h2 {
                                (section.heading)
                                @if let Some((words, class)) = &section.badge { " " span class={ "grade " (class) } { (words) } }
                            }
                            @for block in &section.blocks { (block) }
                        }
                    }
                    @if !self.footer.is_empty() { footer { (self.footer) } }
                    @if let Some(numbers) = numbers {
                        script type="application/json" id="figures" { (PreEscaped(numbers)) }
                        script { (PreEscaped(SCRIPT)) }
                    }
                }
            }
        }
        .into_string()
    }

    /// The numbers of all figures as JSON that can be in a script element; nothing on a page without figures.
    fn script_numbers(&self) -> Option<String> {
        let figures: Map<String, Value> = self.sections.iter().flat_map(|s| s.figures.iter().cloned()).collect();
        let mut all = self.numbers.clone();
        (!figures.is_empty() || !all.is_empty()).then(|| {
            all.insert("figures".into(), Value::Object(figures));
            // No text in it can end the element.
            Value::Object(all).to_string().replace('<', "\\u003c")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::{Axis, FITTED, Layer, Panel};

    fn page() -> String {
        let figure = Figure::new("R(u) < 80 kN").with(
            Panel::new("", Axis::new("u [m/s]"), Axis::new("R [kN]")).with(Layer::line(
                "fitted",
                FITTED,
                [(0.0, 0.0), (7.0, 50.0)],
            )),
        );
        let mut table = Table::new(["mechanism", "size"]);
        table.row(["<current> & drift", "0.31"]);
        Page::new("Diagnosis of \"Esso <Osaka>\"")
            .opening(html! { p { "A steady force was found." } })
            .section(Section::new("Where").text("a < b").table(&table, "Findings").list(["one", "two"]))
            .section(Section::new("Proof").badge("confirmed", "confirmed").figure("proof", &figure, "caption"))
            .section(Section::new("Open"))
            .footer("seed 1")
            .render()
    }

    #[test]
    fn a_page_needs_nothing_from_outside_itself() {
        let page = page();
        assert!(page.starts_with("<!DOCTYPE html>"));
        for outside in ["http:", "https:", "<link", "src=", "@import", "fetch(", "XMLHttpRequest"] {
            assert!(!page.contains(outside), "{outside}");
        }
        assert!(page.contains("<div data-figure=\"proof\">") && page.contains("<h3>R(u) &lt; 80 kN</h3>"));
    }

    #[test]
    fn the_numbers_of_a_figure_are_json_that_no_name_in_it_can_end() {
        let figure = Figure::new("").with(Panel::new("</script><b>", Axis::new("x"), Axis::new("y")));
        let page = Page::new("").section(Section::new("a").figure("f", &figure, "")).render();
        let (_, rest) = page.split_once("id=\"figures\">").unwrap();
        let (json, _) = rest.split_once("</script>").unwrap();
        let value: Value = serde_json::from_str(json).unwrap();
        assert_eq!(value["figures"]["f"]["panels"][0]["t"], "</script><b>");
    }

    #[test]
    fn what_is_written_is_escaped() {
        let page = page();
        assert!(page.contains("&lt;current&gt; &amp; drift"));
        assert!(page.contains("a &lt; b"));
        assert!(page.contains("<h1>Diagnosis of &quot;Esso &lt;Osaka&gt;&quot;</h1>"));
    }

    #[test]
    fn columns_of_numbers_are_set_to_the_right() {
        assert!(page().contains("<td class=\"number\">0.31</td>"));
    }
}
