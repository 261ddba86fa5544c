//! Table 1 of the paper: what the data sets cover, ours beside the paper's.
//! It says nothing of how well anything is fitted.

use super::case::Case;
use super::sheet::{cell, save};
use super::{Artefact, PaperError};
use crate::truth::dataset::{Split, paper_statistics, period, statistics};
use std::fmt::Write;
use std::path::Path;
use trimtab::numerals::{DASH, fixed};
use trimtab::plot::{Axis, FITTED, Figure, GREY, Layer, Marker, Panel};
use trimtab::report::Table;

/// Table 1.
pub static TABLE1: Artefact = Artefact {
    name: "table1",
    about: "Table 1: ranges and means of the data sets, ours (reconstructed ships) beside the paper's",
    make,
};

const PARTS: [(Split, &str); 2] = [(Split::Train, "train"), (Split::Test, "test")];

/// What the panel of a channel shows: ours and the paper's.
#[derive(Default)]
struct Channel {
    label: String,
    ranges: [Vec<(f64, f64)>; 2],
    means: [Vec<(f64, f64)>; 2],
}

fn make(cases: &[Case], out: &Path) -> Result<String, PaperError> {
    let mut table = Table::new(["ship", "part", "channel", "min", "paper", "max", "paper", "mean", "paper"]);
    let mut rows = Vec::new();
    // One panel a channel; categories are ship and part.
    let mut groups = Vec::new();
    let mut panels: Vec<Channel> = Vec::new();
    let mut text = String::new();
    for case in cases {
        for (split, part) in PARTS {
            let empty = PaperError::Empty { ship: case.ship.name(), what: "runs in one part of the split" };
            let ours = statistics(&case.runs, split).ok_or(empty)?;
            let paper = paper_statistics(case.ship, split);
            let slot = groups.len() as f64;
            groups.push(format!("{} {part}", &case.label()[5..]));
            for (i, ((name, unit, ours), (_, _, paper))) in
                ours.channels().into_iter().zip(paper.channels()).enumerate()
            {
                let digits = if name == "r" { 4 } else { 2 };
                let show = |value: Option<f64>| value.map_or(DASH.to_owned(), |v| fixed(v, digits));
                table.row([
                    case.label().to_owned(),
                    part.to_owned(),
                    format!("{name} [{unit}]"),
                    show(Some(ours.min)),
                    show(Some(paper.min)),
                    show(Some(ours.max)),
                    show(Some(paper.max)),
                    show(ours.mean),
                    show(paper.mean),
                ]);
                rows.push([
                    case.ship.name().to_owned(),
                    part.to_owned(),
                    name.to_owned(),
                    unit.to_owned(),
                    cell(ours.min),
                    cell(paper.min),
                    cell(ours.max),
                    cell(paper.max),
                    cell(ours.mean),
                    cell(paper.mean),
                ]);
                if panels.len() <= i {
                    panels.push(Channel { label: format!("{name} [{unit}]"), ..Channel::default() });
                }
                for (which, (spread, shift)) in [(ours, -0.14), (paper, 0.14)].into_iter().enumerate() {
                    let x = slot + shift;
                    panels[i].ranges[which].extend([(x, spread.min), (x, spread.max), (x, f64::NAN)]);
                    panels[i].means[which].extend(spread.mean.map(|mean| (x, mean)));
                }
            }
        }
        let count = |split| case.runs.iter().filter(|run| run.split == split).count();
        let _ = writeln!(
            text,
            "{}: {} runs of {} steps of {} s, {} train and {} test",
            case.label(),
            case.runs.len(),
            case.windows[0].steps(),
            period(case.ship),
            count(Split::Train),
            count(Split::Test),
        );
    }
    let header = ["ship", "part", "channel", "unit", "min", "paper_min", "max", "paper_max", "mean", "paper_mean"];
    save(out, "table1_values", header, rows)?;
    let panels = panels.into_iter().map(|Channel { label, ranges, means }| {
        let mut panel = Panel::new("", Axis::categories("", groups.clone()), Axis::new(label));
        for (which, (name, color)) in [("ours", FITTED), ("paper", GREY)].into_iter().enumerate() {
            panel = panel
                .with(Layer::line(format!("{name}: smallest to largest"), color, ranges[which].clone()).width(7.0))
                .with(Layer::scatter(format!("{name}: mean"), color, means[which].clone()).marker(Marker::Diamond));
        }
        panel
    });
    Figure::new("Data sets of ships A and B beside the paper's (Table 1)")
        .columns(5)
        .panel_size(520, 620)
        .with_all(panels)
        .save(&out.join("table1"))?;
    Ok(format!("{text}\n{table}\n"))
}
