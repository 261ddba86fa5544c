//! Two small craft with actuators of their own, a catamaran with two thrusters and a tug with Voith-Schneider propellers: a general hull
//! fitted to training recordings and judged on others, beside steady motion.

use crate::real::error::RealError;
use crate::real::hull::Hull;
use trimtab::evaluate::{predict_all, steady_motion};
use trimtab::fit::Fit;
use trimtab::numbers::numerals::fixed;
use trimtab::numbers::statistics::mean;
use trimtab::recording::{Run, Split, or_nan};
use trimtab::report::Table;
use trimtab::report::plot::{FITTED, Figure, GREY, Layer, Legend, Panel, RECORDED, east_north};
use trimtab::simulate::Trajectory;

/// Studies of this experiment, with their names.
pub const STUDIES: [(&str, &str); 2] = [("blueboat", "BlueBoat"), ("cse1", "CyberShip Enterprise I")];

/// Mean speed \[m/s\] below which a window shows a craft that keeps its place: cVDM, a share of the path, says nothing of it.
const UNDER_WAY: f64 = 0.05;

/// A window with both predictions and their cVDM \[%\].
struct Window {
    run: Run,
    steady: f64,
    fitted: f64,
    predicted: Trajectory,
}

/// The results of one craft.
pub struct Judged {
    name: &'static str,
    /// The fit.
    pub fit: Fit,
    /// Windows under way, those of the test first.
    windows: Vec<Window>,
}

/// Fits a study's model to its training windows under way, and judges it on all.
///
/// # Errors
/// [`RealError`].
pub fn run((study, name): (&str, &'static str)) -> Result<Judged, RealError> {
    let hull = Hull::open(study)?;
    let of = |split| Ok::<_, RealError>(hull.windows(split)?.into_iter().filter(is_under_way).collect::<Vec<Run>>());
    let (test, train) = (of(Split::Test)?, of(Split::Train)?);
    let fit = hull.fitted(&hull.model("model.toml")?, &train)?;
    let runs = [test, train].concat();
    let predicted = predict_all(&fit.model, &runs, hull.fit.integration);
    let windows = runs.into_iter().zip(predicted).map(|(run, predicted)| Window {
        steady: hull.cvdm(&run, &steady_motion(&run)),
        fitted: hull.cvdm(&run, &predicted),
        predicted,
        run,
    });
    Ok(Judged { name, windows: windows.collect(), fit })
}

/// Whether a craft moves in a window.
fn is_under_way(run: &Run) -> bool {
    let speeds = run.measured.iter().filter_map(|m| Some(m[3]?.hypot(m[4]?)));
    mean(speeds).is_some_and(|speed| speed >= UNDER_WAY)
}

impl Judged {
    fn of(&self, split: Split) -> impl Iterator<Item = &Window> {
        self.windows.iter().filter(move |w| w.run.split == split)
    }

    /// Mean cVDM \[%\] over the windows of a split: of steady motion, and of the fitted model; absent where there is none.
    pub fn cvdm(&self, split: Split) -> Option<[f64; 2]> {
        Some([mean(self.of(split).map(|w| w.steady))?, mean(self.of(split).map(|w| w.fitted))?])
    }

    /// A row a recording, and one for all that the fit has not seen.
    pub fn table(&self) -> Table {
        let mut table =
            Table::new(["recording", "in the fit", "windows", "steady motion: cVDM [%]", "fitted model: cVDM [%]"]);
        let mut names: Vec<&str> = self.windows.iter().map(|w| w.run.recording.as_str()).collect();
        names.dedup();
        let mut row = |name: &str, seen: &str, some: &[&Window]| {
            let of = |value: fn(&Window) -> f64| {
                mean(some.iter().map(|w| value(w))).map_or_else(String::new, |m| fixed(m, 1))
            };
            table.row([name.to_owned(), seen.to_owned(), some.len().to_string(), of(|w| w.steady), of(|w| w.fitted)]);
        };
        for name in names {
            let some: Vec<&Window> = self.windows.iter().filter(|w| w.run.recording == name).collect();
            let seen = some.iter().any(|w| w.run.split == Split::Train);
            row(name, if seen { "yes" } else { "no" }, &some);
        }
        row("all test windows", "no", &self.of(Split::Test).collect::<Vec<_>>());
        table
    }

    /// Tracks of three test windows, those at the quartiles of the fitted model's error.
    pub fn figure(&self) -> Figure {
        let mut order: Vec<&Window> = self.of(Split::Test).collect();
        order.sort_by(|a, b| a.fitted.total_cmp(&b.fitted));
        let mut figure = Figure::new(format!("{}: test windows, of recordings that no fit has seen", self.name))
            .columns(3)
            .panel_size(640, 600)
            .legend(Legend::Shared);
        for (k, share) in [0.25, 0.5, 0.75].into_iter().enumerate() {
            let Some(w) = order.get((share * (order.len().max(1) - 1) as f64).round() as usize) else { continue };
            let track = |states: &[[f64; 6]]| states.iter().map(|s| east_north(s[0], s[1])).collect::<Vec<_>>();
            let measured: Vec<[f64; 6]> = w.run.measured.iter().map(or_nan).collect();
            let layers = [
                Layer::line("measured", RECORDED, track(&measured)).width(5.0),
                Layer::line("steady motion", GREY, track(&steady_motion(&w.run).states)).dashed(),
                Layer::line("fitted model", FITTED, track(&w.predicted.states)),
            ];
            let title =
                format!("{}: cVDM {} %, steady motion {} %", w.run.recording, fixed(w.fitted, 0), fixed(w.steady, 0));
            let layers = layers.into_iter().map(|layer| if k > 0 { layer.unlisted() } else { layer });
            figure = figure.with(Panel::track(title).with_all(layers));
        }
        figure
    }
}
