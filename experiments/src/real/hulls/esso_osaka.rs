//! Esso Osaka, 3 m: models fitted to training runs, judged on test runs beside two baselines that use no recording.
//! The baselines are the empirical model (Clarke, Inoue) and the published low-speed MMG simulator, both in calm water.

use super::published::PublishedMmg;
use crate::real::error::RealError;
use crate::real::hull::Hull;
use trimtab::evaluate::{Comparison, EvaluationSettings, Outcome, Summary, compare, predict, summarise};
use trimtab::fit::Fit;
use trimtab::model::Model;
use trimtab::numbers::numerals::fixed;
use trimtab::recording::{Run, Split, or_nan};
use trimtab::report::Table;
use trimtab::report::plot::{
    Axis, BASELINE, Color, FITTED, Figure, GREEN, Layer, Legend, ORANGE, PURPLE, Panel, RECORDED, east_north,
};
use trimtab::simulate::Trajectory;

/// Model files that are fitted, in the order of the tables.
pub const FITTED_MODELS: [&str; 4] = ["model.toml", "wind.toml", "freed.toml", "freed_wind.toml"];

/// A point of a panel from the time since the start of the window \[s\] and a state.
type Curve = dyn Fn(f64, &[f64; 6]) -> (f64, f64);

/// A model on every window.
pub struct Candidate {
    /// Name.
    pub name: String,
    /// Prediction of each window.
    pub predicted: Vec<Trajectory>,
    /// Its deviations from the measured motion.
    pub outcomes: Vec<Outcome>,
}

/// The results of the experiment.
pub struct Judged {
    /// Test windows.
    pub windows: Vec<Run>,
    /// Number of training windows.
    pub train: usize,
    /// The baselines (empirical, published), then the fitted models.
    pub candidates: Vec<Candidate>,
    /// The fits.
    pub fits: Vec<Fit>,
    judge: Model,
    r_max: f64,
}

/// How many of the candidates are baselines.
pub const BASELINES: usize = 2;

/// Fits the models in `files` to the training windows and judges all on the test windows. `thin` takes every so many-th
/// training window, 1 for all.
///
/// # Errors
/// [`RealError`].
pub fn run(files: &[&str], thin: usize) -> Result<Judged, RealError> {
    let hull = Hull::open("esso_osaka")?;
    let train: Vec<Run> = hull.windows(Split::Train)?.into_iter().step_by(thin.max(1)).collect();
    let windows = hull.windows(Split::Test)?;
    let empirical = hull.model("model.toml")?;
    // The data folder is where the runs are, in folders by manoeuvre.
    let run = hull.study.runs.first().and_then(|r| r.file.ancestors().nth(2)).unwrap_or(&hull.study.path);
    let published = PublishedMmg::read(run)?;
    let fits = files.iter().map(|f| hull.fitted(&hull.model(f)?, &train)).collect::<Result<Vec<_>, _>>()?;

    let by_model = |m: &Model| windows.iter().map(|w| predict(m, w, hull.fit.integration)).collect::<Vec<_>>();
    let mut predictions = vec![
        ("empirical".to_owned(), by_model(&empirical)),
        ("published MMG".to_owned(), windows.iter().map(|w| published.simulate(w)).collect()),
    ];
    predictions.extend(fits.iter().map(|f| (f.model.name.clone(), by_model(&f.model))));
    let r_max = hull.fit.max_yaw_rate;
    let candidates = predictions
        .into_iter()
        .map(|(name, predicted)| {
            let outcome = |(w, t): (&Run, &Trajectory)| compare(w, &empirical, r_max, (t, t)).fitted;
            Candidate { name, outcomes: windows.iter().zip(&predicted).map(outcome).collect(), predicted }
        })
        .collect();
    Ok(Judged { windows, train: train.len(), candidates, fits, judge: empirical, r_max })
}

impl Judged {
    /// Candidate `fitted` against candidate `baseline`, on the test windows of a manoeuvre or on all.
    pub fn against(&self, baseline: usize, fitted: usize, manoeuvre: Option<&str>) -> Summary {
        let (b, f) = (&self.candidates[baseline], &self.candidates[fitted]);
        let comparisons: Vec<Comparison> = (0..self.windows.len())
            .filter(|&i| manoeuvre.is_none_or(|m| self.windows[i].manoeuvre == m))
            .map(|i| compare(&self.windows[i], &self.judge, self.r_max, (&b.predicted[i], &f.predicted[i])))
            .collect();
        let members: Vec<&Comparison> = comparisons.iter().collect();
        summarise(manoeuvre.unwrap_or("all").into(), &members, &EvaluationSettings::default())
    }

    /// Mean cVDM \[%\] of a candidate on test windows of a manoeuvre or on all; absent if it diverged on one.
    pub fn cvdm(&self, candidate: usize, manoeuvre: Option<&str>) -> Option<f64> {
        let of = self.windows.iter().zip(&self.candidates[candidate].outcomes);
        let of = of.filter(|(w, _)| manoeuvre.is_none_or(|m| w.manoeuvre == m));
        let cvdm: Vec<Option<f64>> = of.map(|(_, o)| o.deviation().map(|d| d.cvdm)).collect();
        let sum = cvdm.iter().copied().sum::<Option<f64>>()?;
        (!cvdm.is_empty()).then(|| sum / cvdm.len() as f64)
    }

    /// Kinds of manoeuvre among the test windows, in their order.
    pub fn manoeuvres(&self) -> Vec<String> {
        let mut kinds: Vec<String> = Vec::new();
        for w in &self.windows {
            if !kinds.contains(&w.manoeuvre) {
                kinds.push(w.manoeuvre.clone());
            }
        }
        kinds
    }

    fn groups(&self) -> Vec<Option<String>> {
        self.manoeuvres().into_iter().map(Some).chain([None]).collect()
    }

    /// Mean cVDM of every candidate, a row a manoeuvre.
    pub fn cvdm_table(&self) -> Table {
        let header = ["manoeuvre".to_owned(), "runs".into(), "windows".into()];
        let mut table = Table::new(header.into_iter().chain(self.candidates.iter().map(|c| c.name.clone())));
        for group in self.groups() {
            let group = group.as_deref();
            let of: Vec<&Run> = self.windows.iter().filter(|w| group.is_none_or(|g| w.manoeuvre == g)).collect();
            let mut runs: Vec<&str> = of.iter().map(|w| w.recording.as_str()).collect();
            runs.dedup();
            let mut row = vec![group.unwrap_or("all").to_owned(), runs.len().to_string(), of.len().to_string()];
            let cell = |i: usize| self.cvdm(i, group).map_or("diverged".into(), |c| fixed(c, 1));
            row.extend((0..self.candidates.len()).map(cell));
            table.row(row);
        }
        table
    }

    /// What each fitted model gains on each baseline, a row a manoeuvre.
    pub fn gain_table(&self) -> Table {
        let mut table = Table::new([
            "model",
            "baseline",
            "manoeuvre",
            "cVDM gain [%]",
            "95 % interval",
            "mARI [%]",
            "windows better",
            "windows worse",
        ]);
        for fitted in BASELINES..self.candidates.len() {
            for baseline in 0..BASELINES {
                for group in self.groups() {
                    let s = self.against(baseline, fitted, group.as_deref());
                    let percent = |v: f64| fixed(100.0 * v, 1);
                    let interval = s.cvdm_improvement.and_then(|e| e.ci95);
                    table.row([
                        self.candidates[fitted].name.clone(),
                        self.candidates[baseline].name.clone(),
                        group.unwrap_or_else(|| "all".into()),
                        s.cvdm_improvement.map_or(String::new(), |e| percent(e.value)),
                        interval.map_or(String::new(), |[a, b]| format!("[{}, {}]", percent(a), percent(b))),
                        s.mari.map_or(String::new(), |e| percent(e.value)),
                        s.better.to_string(),
                        s.worse.to_string(),
                    ]);
                }
            }
        }
        table
    }

    fn color(candidate: usize) -> Color {
        [BASELINE, ORANGE, PURPLE, trimtab::report::plot::SKY, GREEN, FITTED][candidate.min(5)]
    }

    /// Mean cVDM by manoeuvre, a bar a candidate.
    pub fn cvdm_figure(&self) -> Figure {
        let groups = self.groups();
        let names = groups.iter().map(|g| g.clone().unwrap_or_else(|| "all".into()));
        let bars = self.candidates.iter().enumerate().map(|(i, c)| {
            let values = groups.iter().map(|g| self.cvdm(i, g.as_deref()).unwrap_or(f64::NAN)).collect::<Vec<_>>();
            Layer::bars(&c.name, Self::color(i), values)
        });
        let panel =
            Panel::new("", Axis::categories("", names), Axis::new("mean cVDM of test windows [%]").including(0.0));
        Figure::new("Esso Osaka, 3 m: error on runs that no fit has seen")
            .panel_size(1500, 700)
            .with(panel.with_all(bars))
    }

    /// For each manoeuvre the test window with the median error of the last candidate: track, heading and speed.
    pub fn windows_figure(&self) -> Figure {
        let last = self.candidates.len() - 1;
        let shown = [0, 1, last];
        let mut figure = Figure::new("Esso Osaka, 3 m: the median test window of each manoeuvre")
            .columns(3)
            .panel_size(800, 620)
            .legend(Legend::Shared);
        for (row, kind) in self.manoeuvres().iter().enumerate() {
            let mut of: Vec<usize> = (0..self.windows.len()).filter(|&i| &self.windows[i].manoeuvre == kind).collect();
            let cvdm = |i: usize| self.candidates[last].outcomes[i].deviation().map_or(f64::INFINITY, |d| d.cvdm);
            of.sort_by(|a, b| cvdm(*a).total_cmp(&cvdm(*b)));
            let Some(&i) = of.get((of.len() - 1) / 2) else { continue };
            let window = &self.windows[i];
            let series = |point: &Curve| {
                let points = |states: &[[f64; 6]]| {
                    states.iter().enumerate().map(|(k, s)| point(k as f64 * window.dt, s)).collect::<Vec<_>>()
                };
                let mut layers = vec![
                    Layer::line("measured", RECORDED, points(&window.measured.iter().map(or_nan).collect::<Vec<_>>()))
                        .width(5.0),
                ];
                for c in shown {
                    let candidate = &self.candidates[c];
                    let layer = Layer::line(&candidate.name, Self::color(c), points(&candidate.predicted[i].states));
                    layers.push(if c == last { layer } else { layer.dashed() });
                }
                if row > 0 { layers.into_iter().map(Layer::unlisted).collect() } else { layers }
            };
            let time = || Axis::new("time [s]");
            figure = figure
                .with(Panel::track(format!("{kind}: track")).with_all(series(&|_, s| east_north(s[0], s[1]))))
                .with(
                    Panel::new(format!("{kind}: heading"), time(), Axis::new("psi [deg]"))
                        .with_all(series(&|t, s| (t, s[2].to_degrees()))),
                )
                .with(
                    Panel::new(format!("{kind}: surge velocity"), time(), Axis::new("u [m/s]").including(0.0))
                        .with_all(series(&|t, s| (t, s[3]))),
                );
        }
        figure
    }
}
