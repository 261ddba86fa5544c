//! A figure as JSON for a program that draws it itself: panels with ranges, layers with colours and points.
//! It contains what the images show, thinned to what a screen can; how it is drawn there is not decided here.

use super::axis::{Axis, Scale, drawable, limits};
use super::drawing::extent::extents;
use super::drawing::heatmap::{cell_colors, cell_words};
use super::figure::{Figure, Legend, Panel};
use super::layer::{Layer, Mark, Marker, Stroke};
use super::palette::Color;
use serde_json::{Value, json};

/// Points of a line that a screen can resolve.
const MOST: usize = 500;
/// Figures of a number: five are finer than a pixel of any panel.
const DIGITS: i32 = 5;

impl Figure {
    /// The figure as JSON: `columns`, `legend`, and `panels[]` with title `t`, axes `x` and `y` (label `l`, kind `k`, range `r`, categories
    /// `c`, tick step `e`), whether scales are equal `q`, and layers `s[]`. Numbers have five significant digits, lines at most 500
    /// points; what is not finite is null.
    #[must_use]
    pub fn data(&self) -> Value {
        json!({
            "columns": self.columns,
            "legend": self.legend != Legend::Off,
            "panels": self.panels.iter().map(panel).collect::<Vec<Value>>(),
        })
    }
}

fn panel(p: &Panel) -> Value {
    let (ex, ey) = extents(p);
    let (x, y) = (limits(&p.x, ex, 0.02), limits(&p.y, ey, 0.05));
    let equal = p.equal_aspect && p.x.scale == Scale::Linear && p.y.scale == Scale::Linear;
    let layers: Vec<Value> = p.layers.iter().map(layer).collect();
    json!({ "t": p.title, "x": axis(&p.x, x), "y": axis(&p.y, y), "q": equal, "s": layers })
}

fn axis(a: &Axis, (lo, hi): (f64, f64)) -> Value {
    let kind = match a.scale {
        Scale::Linear => "lin",
        Scale::Log => "log",
        Scale::Categories(_) => "cat",
    };
    // On a range fitted to the data a step counts where it divides it.
    let every = a.every.filter(|step| a.range.is_some() || (hi - lo) / step >= 2.0);
    json!({ "l": a.label, "k": kind, "r": [lo, hi], "c": a.labels(), "e": every, "g": a.angle.then_some(1) })
}

/// A number with as many digits as a screen can show; `None` where there is none.
pub(super) fn short(v: f64) -> Option<f64> {
    if !drawable(v) {
        return None;
    }
    let text = format!("{v:.*e}", DIGITS as usize - 1);
    text.parse().ok()
}

fn numbers(values: impl IntoIterator<Item = f64>) -> Vec<Option<f64>> {
    values.into_iter().map(short).collect()
}

/// The indices that are kept of so many points: all, or every so many and the last.
fn kept(count: usize) -> impl Iterator<Item = usize> + Clone {
    let stride = count.div_ceil(MOST).max(1);
    (0..count).filter(move |k| k.is_multiple_of(stride) || k + 1 == count)
}

fn hex(c: Color) -> String {
    format!("#{:02x}{:02x}{:02x}", c.r, c.g, c.b)
}

fn marker(m: Marker) -> &'static str {
    match m {
        Marker::Circle => "circle",
        Marker::Square => "square",
        Marker::Diamond => "diamond",
        Marker::Triangle => "triangle",
        Marker::Cross => "cross",
    }
}

fn layer(l: &Layer) -> Value {
    let dash = match l.stroke {
        Stroke::Solid => 0,
        Stroke::Dashed => 1,
        Stroke::Dotted => 2,
    };
    let mut out = json!({
        "n": l.name, "c": hex(l.color), "a": l.color.alpha, "d": dash, "w": f64::from(l.width) * 0.5, "g": l.in_legend,
    });
    let Value::Object(more) = mark(&l.mark) else { return out };
    if let Value::Object(members) = &mut out {
        members.extend(more);
    }
    out
}

fn mark(m: &Mark) -> Value {
    let column = |of: &dyn Fn(usize) -> f64, count: usize| numbers(kept(count).map(of));
    match m {
        Mark::Line(p) => {
            json!({ "k": "line", "p": [column(&|i| p[i].0, p.len()), column(&|i| p[i].1, p.len())] })
        }
        Mark::Scatter(p, shape) => {
            let (x, y) = (numbers(p.iter().map(|p| p.0)), numbers(p.iter().map(|p| p.1)));
            json!({ "k": "scatter", "m": marker(*shape), "p": [x, y] })
        }
        Mark::Errors(p, shape) => {
            let columns: [fn(&(f64, f64, f64, f64)) -> f64; 4] = [|p| p.0, |p| p.1, |p| p.2, |p| p.3];
            json!({ "k": "errors", "m": marker(*shape), "p": columns.map(|of| numbers(p.iter().map(of))) })
        }
        Mark::Band(p) => {
            let columns: [fn(&(f64, f64, f64)) -> f64; 3] = [|p| p.0, |p| p.1, |p| p.2];
            json!({ "k": "band", "p": columns.map(|of| column(&|i| of(&p[i]), p.len())) })
        }
        Mark::HSpan(lo, hi) => json!({ "k": "hspan", "v": [short(*lo), short(*hi)] }),
        Mark::VSpan(lo, hi) => json!({ "k": "vspan", "v": [short(*lo), short(*hi)] }),
        Mark::HLine(y) => json!({ "k": "hline", "v": short(*y) }),
        Mark::VLine(x) => json!({ "k": "vline", "v": short(*x) }),
        Mark::Bars { values, intervals } if intervals.is_empty() => {
            json!({ "k": "bars", "p": numbers(values.iter().copied()) })
        }
        Mark::Bars { values, intervals } => json!({
            "k": "bars",
            "p": numbers(values.iter().copied()),
            "lo": numbers(intervals.iter().map(|i| i.0)),
            "hi": numbers(intervals.iter().map(|i| i.1)),
        }),
        Mark::Boxes(rows) => {
            json!({ "k": "boxes", "p": rows.iter().map(|r| numbers(r.iter().copied())).collect::<Vec<_>>() })
        }
        Mark::Hulls { poses, length, beam } => {
            let poses: Vec<_> = poses.iter().map(|pose| pose.map(short)).collect();
            json!({ "k": "hulls", "p": poses, "L": length, "B": beam })
        }
        Mark::Arrows(all) => {
            let ends = |[a, b]: &[(f64, f64); 2]| [a.0, a.1, b.0, b.1].map(short);
            json!({ "k": "arrows", "p": all.iter().map(ends).collect::<Vec<_>>() })
        }
        Mark::Heatmap { values, range, .. } => {
            let colors = cell_colors(values, *range);
            let fills: Vec<Vec<String>> = colors.iter().map(|row| row.iter().map(|c| hex(*c)).collect()).collect();
            let dark: Vec<Vec<bool>> =
                colors.iter().map(|row| row.iter().map(|c| c.luminance() <= 0.35).collect()).collect();
            let words = cell_words(values, *range);
            let values: Vec<_> = values.iter().map(|row| numbers(row.iter().copied())).collect();
            json!({ "k": "heat", "p": values, "f": fills, "b": dark, "t": words })
        }
        Mark::Text((x, y)) => json!({ "k": "text", "v": [short(*x), short(*y)] }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::palette::FITTED;

    #[test]
    fn a_line_keeps_its_ends_and_gaps_and_no_more_points_than_a_screen_shows() {
        let points = (0..5000).map(|i| (f64::from(i), if i == 0 { f64::NAN } else { 1.0 / 3.0 }));
        let panel = Panel::new("", Axis::new("x"), Axis::new("y")).with(Layer::line("a", FITTED, points).dashed());
        let data = Figure::new("").with(panel).data();
        let layer = &data["panels"][0]["s"][0];
        let (x, y) = (layer["p"][0].as_array().unwrap(), layer["p"][1].as_array().unwrap());
        assert!(x.len() <= MOST + 1 && x.len() == y.len());
        assert_eq!((x[0].as_f64(), x[x.len() - 1].as_f64()), (Some(0.0), Some(4999.0)));
        assert!(y[0].is_null() && y[1].as_f64() == Some(0.33333));
        assert_eq!((layer["d"].as_i64(), layer["c"].as_str()), (Some(1), Some("#0072b2")));
    }

    #[test]
    fn the_cells_of_a_heat_map_have_colours_and_missing_ones_are_null() {
        let map = Layer::heatmap("share", vec![vec![0.0, f64::NAN], vec![1.0, 0.5]]);
        let panel = Panel::new("", Axis::categories("", ["a", "b"]), Axis::categories("", ["c", "d"])).with(map);
        let data = Figure::new("").with(panel).data();
        let layer = &data["panels"][0]["s"][0];
        assert!(layer["p"][0][1].is_null() && layer["b"][1][0] == true && layer["b"][0][0] == false);
    }
}
