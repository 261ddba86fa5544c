//! The data behind a figure as CSV, one row for each point.
//! It writes the numbers that the caller gave, not those that fit on the axes.

use super::axis::Axis;
use super::drawing::extent::lies;
use super::error::FigureError;
use super::figure::{Figure, Panel};
use super::layer::{Layer, Mark};
use crate::files::plain_cell;

impl Figure {
    /// The data behind the figure, one row for each point: `panel,series,kind,x,y,z,lo,hi`.
    ///
    /// `x` and `y` are as on the axes, categories by their label; `z` is the value of a heat map cell and the heading
    /// (rad) of a hull; `lo` and `hi` are the ends of an interval, band or span. What is missing is an empty field.
    /// A name that a spreadsheet would run has an apostrophe before it. An arrow is two rows, `arrow-from` and `arrow-to`; boxes are given by their samples.
    ///
    /// # Errors
    /// [`FigureError::Csv`] if the writer fails.
    pub fn csv(&self) -> Result<String, FigureError> {
        let mut writer = csv::Writer::from_writer(vec![]);
        writer.write_record(["panel", "series", "kind", "x", "y", "z", "lo", "hi"])?;
        for (i, panel) in self.panels.iter().enumerate() {
            let name = if panel.title.is_empty() { format!("{}", i + 1) } else { panel.title.clone() };
            for layer in &panel.layers {
                for row in rows(panel, layer) {
                    let values = row.values.map(|v| v.unwrap_or_default());
                    let cells = [&name, &layer.name, row.kind].into_iter().chain(values.iter().map(String::as_str));
                    writer.write_record(cells.map(|cell| plain_cell(cell).into_owned()))?;
                }
            }
        }
        let bytes = writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

/// One line of the CSV: x, y, z, lo, hi.
struct Row {
    kind: &'static str,
    values: [Option<String>; 5],
}

fn rows(panel: &Panel, layer: &Layer) -> Vec<Row> {
    let number = |v: f64| v.is_finite().then(|| v.to_string());
    let row = |kind, x, y, z: f64, lo: f64, hi: f64| Row { kind, values: [x, y, number(z), number(lo), number(hi)] };
    let point = |kind, x: f64, y: f64, z: f64, lo: f64, hi: f64| row(kind, number(x), number(y), z, lo, hi);
    let category = |axis: &Axis, i: usize| {
        Some(axis.labels().and_then(|labels| labels.get(i).cloned()).unwrap_or_else(|| i.to_string()))
    };
    let lying = lies(panel);
    let slot = |kind, i: usize, v: f64, lo, hi| {
        if lying {
            row(kind, number(v), category(&panel.y, i), f64::NAN, lo, hi)
        } else {
            row(kind, category(&panel.x, i), number(v), f64::NAN, lo, hi)
        }
    };
    const NO: f64 = f64::NAN;
    match &layer.mark {
        Mark::Line(points) => points.iter().map(|&(x, y)| point("line", x, y, NO, NO, NO)).collect(),
        Mark::Scatter(points, _) => points.iter().map(|&(x, y)| point("scatter", x, y, NO, NO, NO)).collect(),
        Mark::Errors(points, _) => points.iter().map(|&(x, y, lo, hi)| point("errors", x, y, NO, lo, hi)).collect(),
        Mark::Band(points) => points.iter().map(|&(x, lo, hi)| point("band", x, NO, NO, lo, hi)).collect(),
        Mark::HSpan(lo, hi) => vec![point("h-span", NO, NO, NO, *lo, *hi)],
        Mark::VSpan(lo, hi) => vec![point("v-span", NO, NO, NO, *lo, *hi)],
        Mark::HLine(y) => vec![point("h-line", NO, *y, NO, NO, NO)],
        Mark::VLine(x) => vec![point("v-line", *x, NO, NO, NO, NO)],
        Mark::Bars { values, intervals } => values
            .iter()
            .enumerate()
            .map(|(i, &v)| {
                let (lo, hi) = intervals.get(i).copied().unwrap_or((NO, NO));
                slot("bar", i, v, lo, hi)
            })
            .collect(),
        Mark::Boxes(samples) => samples
            .iter()
            .enumerate()
            .flat_map(|(i, values)| values.iter().map(move |&v| (i, v)))
            .map(|(i, v)| slot("sample", i, v, NO, NO))
            .collect(),
        Mark::Hulls { poses, .. } => poses.iter().map(|&[x, y, psi]| point("hull", y, x, psi, NO, NO)).collect(),
        Mark::Arrows(arrows) => arrows
            .iter()
            .flat_map(|&[a, b]| [point("arrow-from", a.0, a.1, NO, NO, NO), point("arrow-to", b.0, b.1, NO, NO, NO)])
            .collect(),
        Mark::Heatmap { values, .. } => values
            .iter()
            .enumerate()
            .flat_map(|(i, cells)| cells.iter().enumerate().map(move |(j, &v)| (i, j, v)))
            .map(|(i, j, v)| row("cell", category(&panel.x, j), category(&panel.y, i), v, NO, NO))
            .collect(),
        Mark::Text((x, y)) => vec![point("text", *x, *y, NO, NO, NO)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::palette::BLUE;

    const NAN: f64 = f64::NAN;

    #[test]
    fn the_csv_reads_back_to_the_same_numbers() {
        let points = [(0.1 + 0.2, -1.0 / 3.0), (1e-17, 6.02e23), (f64::MIN_POSITIVE, NAN)];
        let figure = Figure::new("").with(
            Panel::new("track, \"A\"", Axis::new("x"), Axis::new("y"))
                .with(Layer::line("fitted, 95 %", BLUE, points))
                .with(Layer::band("band", BLUE, [(1.0, 2.0, 3.0)]))
                .with(Layer::hulls("hull", BLUE, [[10.0, 20.0, 0.5]], 80.0, 12.0)),
        );
        let text = figure.csv().unwrap();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        assert_eq!(reader.headers().unwrap(), vec!["panel", "series", "kind", "x", "y", "z", "lo", "hi"]);
        let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        for (record, (x, y)) in records.iter().zip(points) {
            assert_eq!((&record[0], &record[1], &record[2]), ("track, \"A\"", "fitted, 95 %", "line"));
            assert_eq!(record[3].parse(), Ok(x));
            assert_eq!(record[4].parse().ok(), y.is_finite().then_some(y));
        }
        assert_eq!(records[3].iter().skip(2).collect::<Vec<_>>(), ["band", "1", "", "", "2", "3"]);
        assert_eq!(records[4].iter().skip(2).collect::<Vec<_>>(), ["hull", "20", "10", "0.5", "", ""]);
    }

    #[test]
    fn bars_and_cells_are_named_by_their_category_in_the_csv() {
        let mechanisms = || Axis::categories("", ["current", "wind"]);
        let lying = Panel::new("1", Axis::new("SNR"), mechanisms()).with(Layer::bars_with_intervals(
            "score",
            BLUE,
            [(3.0, 2.0, 4.0), (1.0, NAN, NAN)],
        ));
        let map = Panel::new("2", mechanisms(), mechanisms())
            .with(Layer::heatmap("share", vec![vec![1.0, 0.0], vec![0.25, 0.75]]));
        let text = Figure::new("").with(lying).with(map).csv().unwrap();
        assert!(text.contains("1,score,bar,3,current,,2,4\n1,score,bar,1,wind,,,\n"), "{text}");
        assert!(text.contains("2,share,cell,current,wind,0.25,,\n"), "{text}");
    }
}
