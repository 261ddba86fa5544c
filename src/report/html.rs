//! One HTML page that carries everything it shows: headings, paragraphs, tables, and figures as embedded images.
//! No scripts and nothing from outside the file, so that it reads the same offline, printed, and years later.

use super::table::Table;
use crate::plot::{Figure, FigureError};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "
:root { color-scheme: light; }
body { font: 16px/1.5 'DejaVu Sans', Verdana, sans-serif; color: #1e1e1e; background: #fff; margin: 0 auto; padding: 2rem 1.25rem 4rem; max-width: 62rem; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .5rem; }
h2 { font-size: 1.25rem; line-height: 1.3; margin: 2.5rem 0 .6rem; padding-top: .8rem; border-top: 1px solid #ccc; }
p { margin: .5rem 0; max-width: 48rem; }
.lede { font-size: 1.1rem; }
nav { font-size: .9rem; margin: 1rem 0; }
nav a { color: #005a8f; margin-right: 1rem; white-space: nowrap; }
.scroll { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
caption, figcaption { text-align: left; font-size: .9rem; color: #444; padding: .3rem 0; }
th, td { padding: .3rem .8rem; text-align: left; vertical-align: top; border-bottom: 1px solid #ddd; }
thead th { border-bottom: 2px solid #444; }
.number { text-align: right; white-space: nowrap; }
figure { margin: 1.2rem 0; }
figure img { max-width: 100%; height: auto; }
footer { margin-top: 3rem; font-size: .8rem; color: #555; border-top: 1px solid #ccc; padding-top: .6rem; }
@media print { body { max-width: none; padding: 0; font-size: 10pt; } nav { display: none; } figure, tr { break-inside: avoid; } h2 { break-after: avoid; } }
";

/// A part of a page under one heading.
#[derive(Clone, Debug)]
#[must_use]
pub struct Section {
    heading: String,
    blocks: Vec<Markup>,
}

impl Section {
    /// An empty section.
    pub fn new(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), blocks: vec![] }
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

    /// The same section with a figure as an embedded PNG, shown at half its size in px.
    ///
    /// # Errors
    /// As [`Figure::png`].
    pub fn figure(self, figure: &Figure, caption: &str) -> Result<Self, FigureError> {
        Ok(self.png(&figure.png()?, &figure.title, caption))
    }

    /// The same section with a figure that is drawn already, as [`Self::figure`].
    pub fn png(self, png: &[u8], title: &str, caption: &str) -> Self {
        // The width is in the PNG header, big-endian at byte 16.
        let width = png.get(16..20).and_then(|b| b.try_into().ok()).map(|b| u32::from_be_bytes(b) / 2);
        let source = format!("data:image/png;base64,{}", STANDARD.encode(png));
        let says = if title.is_empty() { caption } else { title };
        self.markup(html! {
            figure {
                img src=(source) alt=(says) width=[width];
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
    lede: Vec<String>,
    sections: Vec<Section>,
    footer: String,
}

impl Page {
    /// An empty page.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), lede: vec![], sections: vec![], footer: String::new() }
    }

    /// The same page with one more opening paragraph: what was found, before any heading.
    pub fn lede(mut self, paragraph: impl Into<String>) -> Self {
        self.lede.push(paragraph.into());
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

    /// The page as one HTML document.
    #[must_use]
    pub fn render(&self) -> String {
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
                    @for paragraph in &self.lede { p.lede { (paragraph) } }
                    @if self.sections.len() > 2 {
                        nav { @for (i, s) in self.sections.iter().enumerate() { a href={ "#s" (i + 1) } { (s.heading) } " " } }
                    }
                    @for (i, section) in self.sections.iter().enumerate() {
                        section id={ "s" (i + 1) } {
                            h2 { (section.heading) }
                            @for block in &section.blocks { (block) }
                        }
                    }
                    @if !self.footer.is_empty() { footer { (self.footer) } }
                }
            }
        }
        .into_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, FITTED, Layer, Panel};

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
            .lede("A steady force was found.")
            .section(Section::new("Where").text("a < b").table(&table, "Findings").list(["one", "two"]))
            .section(Section::new("Proof").figure(&figure, "caption").unwrap())
            .section(Section::new("Open"))
            .footer("seed 1")
            .render()
    }

    #[test]
    fn a_page_needs_nothing_from_outside_itself() {
        let page = page();
        assert!(page.starts_with("<!DOCTYPE html>"));
        for outside in ["http:", "https:", "<script", "<link", "url(", "src=\"/"] {
            assert!(!page.contains(outside), "{outside}");
        }
        assert!(page.contains("data:image/png;base64,iVBORw0KGgo"));
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
