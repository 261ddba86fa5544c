//! Lays a figure out: margins that align its panels, titles, legends, and the order in which a panel is drawn.
//! It decides nothing about the data: ranges and ticks come from `frame`, layers from `marks`, pixels from `canvas`.

use super::axes::{Margins, grid, least_height, margins, title_lines, x_axis, y_axis};
use super::extent::{has_data, is_grouped, is_span};
use super::frame::Frame;
use super::heatmap::{color_bar, heatmap};
use super::legend::Strip;
use super::marks::{draw_layer, draw_remarks};
use super::style::{EDGE, FRAME, HEADING, LEADING, TITLE, bold, fit_lines, ink};
use crate::report::plot::figure::{Figure, Legend, Panel};
use crate::report::plot::sheet::canvas::{Anchor, Canvas, Run, Type};
use crate::report::plot::sheet::geometry::{Px, Rect};

/// The sheet of a figure.
pub(in crate::report::plot) fn draw(figure: &Figure) -> Canvas {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let cell = (figure.panel_width.max(300) as f32, figure.panel_height.max(200) as f32);
    let width = cell.0 * columns as f32 + 2.0 * EDGE;

    let title = fit_lines(&figure.title, TITLE, true, width - 2.0 * EDGE, 3).0;
    let shared = match figure.legend {
        Legend::Shared => Strip::new(figure.panels.iter().flat_map(|p| &p.layers), width - 2.0 * EDGE),
        Legend::EachPanel | Legend::Off => Strip::default(),
    };
    let title_height = title.len() as f32 * TITLE * LEADING;
    let mut top = EDGE + title_height + if title.is_empty() { 0.0 } else { 12.0 };
    let strip_top = top;
    top += shared.height();

    let rows = lay_out(figure, columns, cell);
    let height = top + rows.iter().map(|row| row.height).sum::<f32>() + EDGE;
    let mut canvas = Canvas::new(width.ceil() as u32, height.ceil() as u32);

    let line = |k: f32| (EDGE, EDGE + (k + 0.5) * TITLE * LEADING);
    canvas.lines(&title, Anchor::Start, Run::Across, bold(TITLE), line);
    shared.draw(&mut canvas, (EDGE, strip_top));
    for row in rows {
        for (j, cell_of_row) in row.cells.iter().enumerate() {
            cell_of_row.draw(&mut canvas, (EDGE + j as f32 * cell.0, top), cell.0);
        }
        top += row.height;
    }
    canvas
}

/// A row of panels.
struct Row<'a> {
    height: f32,
    cells: Vec<Cell<'a>>,
}

/// A panel with its place: `plot` is measured from the corner of the cell.
struct Cell<'a> {
    panel: &'a Panel,
    strip: Strip<'a>,
    strip_height: f32,
    plot: Rect,
}

/// Finds margins that align the plots of each column and each row. Labels depend on the size of the plot and the plot
/// on its labels, so the margins are refined a few times.
fn lay_out(figure: &Figure, columns: usize, (cell_w, cell_h): (f32, f32)) -> Vec<Row<'_>> {
    let mut rows: Vec<Row<'_>> =
        figure.panels.chunks(columns).map(|panels| Row::new(panels, figure.legend, cell_w, cell_h)).collect();
    let first = Margins { left: 110.0, right: 30.0, top: 40.0, bottom: 80.0 };
    let mut all = vec![vec![first; columns]; rows.len()];
    let place = |rows: &mut [Row<'_>], all: &[Vec<Margins>]| {
        for (row, margins) in rows.iter_mut().zip(all) {
            row.cells.iter_mut().zip(margins).for_each(|(cell, m)| cell.plot = plot(*m, cell_w, row.height));
        }
    };
    for _ in 0..3 {
        place(&mut rows, &all);
        for (row, own) in rows.iter().zip(&mut all) {
            for (cell, own) in row.cells.iter().zip(own) {
                *own = margins(&Frame::new(cell.panel, cell.plot), cell.panel, cell_w, cell.strip_height);
            }
        }
        align(&mut all, columns);
    }
    // Names along y that need more lines than a row has make the panels higher.
    for row in &mut rows {
        let missing = row.cells.iter().map(|c| least_height(c.panel, cell_w) - c.plot.height()).fold(0.0, f32::max);
        row.height += missing.ceil();
    }
    place(&mut rows, &all);
    rows
}

/// The plot in a cell of this size.
fn plot(m: Margins, width: f32, height: f32) -> Rect {
    Rect {
        left: m.left,
        top: m.top,
        right: (width - m.right).max(m.left + 40.0),
        bottom: (height - m.bottom).max(m.top + 40.0),
    }
}

/// Gives every row one top and bottom, and every column one left and right.
fn align(all: &mut [Vec<Margins>], columns: usize) {
    let largest = |margins: &mut dyn Iterator<Item = &Margins>| margins.fold(Margins::default(), |m, &n| m.max(n));
    let of_columns: Vec<Margins> = (0..columns).map(|j| largest(&mut all.iter().map(|row| &row[j]))).collect();
    for row in all {
        let Margins { top, bottom, .. } = largest(&mut row.iter());
        for (own, of_column) in row.iter_mut().zip(&of_columns) {
            *own = Margins { top, bottom, ..*of_column };
        }
    }
}

impl<'a> Row<'a> {
    fn new(panels: &'a [Panel], legend: Legend, cell_w: f32, cell_h: f32) -> Self {
        let strips: Vec<Strip<'_>> = panels
            .iter()
            .map(|panel| match legend {
                Legend::EachPanel => Strip::new(&panel.layers, cell_w - 160.0),
                Legend::Shared | Legend::Off => Strip::default(),
            })
            .collect();
        let strip_height = strips.iter().map(Strip::height).fold(0.0, f32::max);
        let plot = Rect { left: 0.0, top: 0.0, right: 0.0, bottom: 0.0 };
        let cell = |(panel, strip)| Cell { panel, strip, strip_height, plot };
        Self { height: cell_h + strip_height, cells: panels.iter().zip(strips).map(cell).collect() }
    }
}

impl Cell<'_> {
    fn draw(&self, canvas: &mut Canvas, (left, top): Px, width: f32) {
        let plot = Rect {
            left: left + self.plot.left,
            top: top + self.plot.top,
            right: left + self.plot.right,
            bottom: top + self.plot.bottom,
        };
        let title = title_lines(self.panel, plot.width());
        let title_height = title.len() as f32 * HEADING * LEADING;
        let strip_top = plot.top - 12.0 - self.strip_height;
        let line = |k: f32| (plot.left, strip_top - title_height + (k + 0.5) * HEADING * LEADING);
        canvas.lines(&title, Anchor::Start, Run::Across, bold(HEADING), line);
        self.strip.draw(canvas, (plot.left, strip_top));
        draw_panel(&Frame::new(self.panel, plot), canvas, self.panel, width);
    }
}

/// Draws a panel in a cell this wide: spans, grid, layers, axes, remarks, in this order.
fn draw_panel(frame: &Frame, canvas: &mut Canvas, panel: &Panel, cell_w: f32) {
    let plot = frame.plot;
    canvas.clip_to(plot);
    for layer in panel.layers.iter().filter(|l| is_span(l)) {
        draw_layer(frame, canvas, panel, layer, 0);
    }
    let heatmap = heatmap(panel);
    if heatmap.is_none() {
        grid(frame, canvas, panel);
    }
    let mut group = 0;
    for layer in panel.layers.iter().filter(|l| !is_span(l)) {
        draw_layer(frame, canvas, panel, layer, group);
        group += usize::from(is_grouped(layer));
    }
    canvas.clip_to(canvas.bounds());
    canvas.stroke_rect(plot, 1.5, FRAME);
    x_axis(frame, canvas, &panel.x);
    y_axis(frame, canvas, &panel.y, cell_w);
    if !panel.layers.iter().any(has_data) {
        canvas.text("no data", plot.center(), Anchor::Middle, Run::Across, Type { color: FRAME, ..ink(HEADING) });
    }
    draw_remarks(frame, canvas, panel);
    if let Some((name, range)) = heatmap {
        color_bar(plot, canvas, name, range);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::axis::Axis;
    use crate::report::plot::figure::Width;
    use crate::report::plot::layer::Layer;
    use crate::report::plot::palette::{BASELINE, FITTED};
    use crate::report::plot::sheet::canvas::Shape;
    use crate::report::plot::sheet::font::text_width;

    /// Figures of the kinds that the commands draw.
    fn figures() -> Vec<Figure> {
        let names =
            ["steady current", "another loading condition (mass, trim) in the sessions of both days", "rudder lag"];
        let bars = |v: &[f64]| Layer::bars_with_intervals("force", FITTED, v.iter().map(|v| (*v, v - 1.0, v + 1.0)));
        let lying = Panel::new("", Axis::new("evidence [standard errors]"), Axis::categories("", names))
            .with(bars(&[3.0, 1.0, 0.2]));
        let standing =
            Panel::new("", Axis::categories("", ["MD x", "MD psi", "consistency"]), Axis::new("improvement [%]"))
                .with(bars(&[30.0, -1.0, 2.0]));
        let wave = |k: f64| {
            Layer::line(format!("run {k}"), BASELINE, (0..90).map(move |i| (f64::from(i), (k * f64::from(i)).sin())))
        };
        let track = Panel::track("best: ship_a_030, cVDM 4.1 %").with(Layer::line(
            "recorded",
            FITTED,
            [(-9e4, 10.0), (4e5, 2e4)],
        ));
        let time = Panel::new("", Axis::new("time [s]"), Axis::new("heading psi [deg]").every(90.0))
            .with(wave(0.1))
            .with(wave(0.3));
        let log = Panel::new("", Axis::new("SNR").log(), Axis::new("cost").log()).with(Layer::line(
            "cost",
            FITTED,
            [(2.0, 3e-9), (7.5, 2e4)],
        ));
        vec![
            Figure::new("Which mechanism explains the data?").panel_size(1240, 280).with(lying),
            Figure::new("Improvement on the baseline").panel_size(1200, 620).with(standing),
            Figure::new("Tracks").columns(3).panel_size(680, 600).with_all([track, time.clone(), log.clone()]),
            Figure::new("Unknown force over time").columns(4).panel_size(520, 400).with_all([
                time.clone(),
                log,
                time.clone(),
                time,
            ]),
        ]
    }

    /// All figures as they are, and at both widths of a page.
    fn at_all_widths() -> Vec<Figure> {
        let widths = [Width::One, Width::Two];
        figures().into_iter().flat_map(|f| widths.map(|w| f.clone().to_width(w)).into_iter().chain([f])).collect()
    }

    #[test]
    fn every_text_is_whole_and_inside_the_sheet_at_every_width() {
        for figure in at_all_widths() {
            let sheet = draw(&figure);
            let (width, height) = (sheet.width as f32, sheet.height as f32);
            for shape in &sheet.shapes {
                let Shape::Text { text, at, anchor, run, style } = shape else { continue };
                assert!(!text.ends_with('…'), "{}: cut to {text}", figure.title);
                let long = text_width(text, style.size, style.bold);
                let before = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => 0.5 * long,
                    Anchor::End => long,
                };
                let (from, to, limit) = match run {
                    Run::Across => (at.0 - before, at.0 - before + long, width),
                    Run::Up => (at.1 + before - long, at.1 + before, height),
                };
                assert!(from >= 0.0 && to <= limit, "{} at {}: {text} from {from} to {to}", figure.title, sheet.width);
            }
        }
    }

    #[test]
    fn every_axis_of_numbers_has_three_ticks_at_every_width() {
        for figure in at_all_widths() {
            let columns = figure.columns;
            let cell = (figure.panel_width as f32, figure.panel_height as f32);
            for cell in lay_out(&figure, columns, cell).iter().flat_map(|row| &row.cells) {
                let frame = Frame::new(cell.panel, cell.plot);
                for (axis, ruler) in [(&cell.panel.x, &frame.x), (&cell.panel.y, &frame.y)] {
                    let seen = ruler
                        .ticks
                        .iter()
                        .filter(|(v, _)| ruler.fraction(*v).is_some_and(|f| (-1e-6..=1.0 + 1e-6).contains(&f)));
                    assert!(
                        axis.labels().is_some() || seen.count() >= 3,
                        "{} {}: {:?}",
                        figure.title,
                        axis.label,
                        ruler.ticks
                    );
                }
            }
        }
    }

    #[test]
    fn a_figure_for_a_page_is_as_wide_as_its_columns_of_text() {
        for figure in figures() {
            for width in [Width::One, Width::Two] {
                let sheet = draw(&figure.clone().to_width(width));
                let millimetres = sheet.width as f32 / 192.0 * 25.4;
                assert!((millimetres - width.millimetres() as f32).abs() < 1.0, "{} {millimetres}", figure.title);
            }
        }
    }

    #[test]
    fn labels_of_categories_are_cut_to_the_same_width_in_every_column() {
        let label = "a mechanism with a name that is far too long for the margin of a small panel";
        let panel = || Panel::new("", Axis::new("x"), Axis::categories("", [label, "short"]));
        let sheet = draw(&Figure::new("").columns(3).panel_size(600, 300).with_all([panel(), panel(), panel()]));
        let is_label = |text: &&String| text.starts_with("a mechanism") || text.ends_with('…');
        let texts =
            sheet.shapes.iter().filter_map(|s| if let Shape::Text { text, .. } = s { Some(text) } else { None });
        let labels: Vec<&String> = texts.filter(is_label).collect();
        assert_eq!(labels.len() % 3, 0, "{labels:?}");
        let (first, rest) = labels.split_at(labels.len() / 3);
        assert!(!first.is_empty() && rest.chunks(first.len()).all(|column| column == first), "{labels:?}");
    }
}
