//! Table 1 of the paper: what the data sets cover, ours beside the paper's.
//! It concerns the data alone, not a fit.

use crate::paper::artefact::Artefact;
use crate::paper::case::Case;
use crate::paper::coverage::{Spread, printed_statistics, statistics};
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;
use crate::truth::dataset::{Split, period};
use trimtab::numbers::numerals::{DASH, fixed};
use trimtab::report::Table;
use trimtab::report::plot::{Axis, FITTED, Figure, GREY, Layer, Marker, Panel};

/// Table 1.
pub static TABLE1: Artefact = Artefact {
    name: "table1",
    about: "Table 1: ranges and means of the data sets, ours (reconstructed ships) beside the paper's",
    make,
};

const PARTS: [(Split, &str); 2] = [(Split::Train, "train"), (Split::Test, "test")];

/// A panel of a channel in the making: ours and the paper's.
#[derive(Default)]
struct Channel {
    label: String,
    ranges: [Vec<(f64, f64)>; 2],
    means: [Vec<(f64, f64)>; 2],
}

impl Channel {
    /// Adds a data set at a place of the axis, ours to the left of the paper's.
    fn add(&mut self, slot: f64, ours: &Spread, paper: &Spread) {
        for (which, (spread, shift)) in [(ours, -0.14), (paper, 0.14)].into_iter().enumerate() {
            let x = slot + shift;
            self.ranges[which].extend([(x, spread.min), (x, spread.max), (x, f64::NAN)]);
            self.means[which].extend(spread.mean.map(|mean| (x, mean)));
        }
    }

    fn panel(self, groups: &[String]) -> Panel {
        let Self { label, ranges, means } = self;
        let mut panel = Panel::new("", Axis::categories("", groups.to_vec()), Axis::new(label));
        for ((name, color), (range, mean)) in
            [("ours", FITTED), ("paper", GREY)].into_iter().zip(ranges.into_iter().zip(means))
        {
            panel = panel
                .with(Layer::line(format!("{name}: smallest to largest"), color, range).width(7.0))
                .with(Layer::scatter(format!("{name}: mean"), color, mean).marker(Marker::Diamond));
        }
        panel
    }
}

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut table = Table::new(["ship", "part", "channel", "min", "paper", "max", "paper", "mean", "paper"]);
    let header = ["ship", "part", "channel", "unit", "min", "paper_min", "max", "paper_max", "mean", "paper_mean"];
    let mut sheet = Sheet::new("table1_values", header);
    // One panel a channel; categories are ship and part.
    let mut groups = Vec::new();
    let mut channels: Vec<Channel> = Vec::new();
    for case in cases {
        for (split, part) in PARTS {
            let empty = PaperError::Empty { ship: case.ship.name(), what: "runs in one part of the split" };
            let ours = statistics(&case.runs, split).ok_or(empty)?.channels();
            let paper = printed_statistics(case.ship, split).channels();
            let slot = groups.len() as f64;
            groups.push(format!("{} {part}", &case.label()[5..]));
            for (i, ((name, unit, ours), (_, _, paper))) in ours.into_iter().zip(paper).enumerate() {
                let label = format!("{name} [{unit}]");
                let values = [ours, paper].map(|s| [Some(s.min), Some(s.max), s.mean]);
                let pairs: Vec<Option<f64>> = (0..3).flat_map(|i| [values[0][i], values[1][i]]).collect();
                let digits = if name == "r" { 4 } else { 2 };
                let show = |value: &Option<f64>| value.map_or(DASH.to_owned(), |v| fixed(v, digits));
                let row = [case.label().to_owned(), part.to_owned(), label.clone()];
                table.row(row.into_iter().chain(pairs.iter().map(show)));
                let start = [case.ship.name(), part, name, unit].map(str::to_owned);
                let cells: Vec<String> = start.into_iter().chain(pairs.iter().map(|v| cell(*v))).collect();
                sheet.row(std::array::from_fn(|i| cells[i].clone()));
                if channels.len() <= i {
                    channels.push(Channel { label, ..Channel::default() });
                }
                channels[i].add(slot, &ours, &paper);
            }
        }
    }
    sheet.save(&to.folder)?;
    to.table("table1", &table)?;
    let figure = Figure::new("Data sets of ships A and B beside the paper's (Table 1)")
        .columns(5)
        .panel_size(520, 620)
        .with_all(channels.into_iter().map(|c| c.panel(&groups)));
    to.figure("table1", figure)?;
    let sizes: String = cases.iter().map(size).collect();
    Ok(format!("{sizes}\n{table}\n"))
}

/// Number and length of the runs of a data set, in words.
fn size(case: &Case) -> String {
    let count = |split| case.runs.iter().filter(|run| run.split == split).count();
    format!(
        "{}: {} runs of {} steps of {} s, {} train and {} test\n",
        case.label(),
        case.runs.len(),
        case.windows[0].steps(),
        period(case.ship),
        count(Split::Train),
        count(Split::Test),
    )
}
