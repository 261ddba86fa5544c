//! KVLCC2: fitted to the zigzags of the free-running tests, judged on their turning circles, which no fit has seen.
//! Predictions are trials simulated from the approach of the tests; no sample of a recorded turn enters them.

use crate::real::error::RealError;
use crate::real::hull::{Hull, settings};
use trimtab::evaluate::maneuver::{
    Approach, ManeuverSettings, Side, Track, turning, turning_execute, turning_trial, zigzag, zigzag_executes,
    zigzag_trial,
};
use trimtab::fit::Fit;
use trimtab::model::Model;
use trimtab::numbers::numerals::fixed;
use trimtab::recording::{Run, Split};
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BASELINE, Color, FITTED, Figure, GREEN, Layer, Legend, Panel, RECORDED, east_north};

/// Rudder angle of the turning circles \[rad\].
const HARD_OVER: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// One measure of a trial: measured, and predicted by each model.
#[derive(Clone, Debug)]
pub struct Measure {
    /// The measure in words, with unit.
    pub what: String,
    /// Whether it is an angle, whose errors are in degrees rather than per cent.
    pub angle: bool,
    /// Whether the fit has seen the trial.
    pub seen: bool,
    /// Measured \[L or deg\].
    pub measured: f64,
    /// Predicted by each model; absent where the trial does not get there.
    pub predicted: Vec<Option<f64>>,
}

impl Measure {
    /// Relative error of a prediction \[-\].
    pub fn error(&self, model: usize) -> Option<f64> {
        self.predicted[model].map(|p| p / self.measured - 1.0)
    }
}

/// A trial as tested and as simulated by each model, for pictures.
pub struct Sailed {
    /// The trial, in words.
    pub name: String,
    /// From the execute on.
    pub measured: Track,
    /// Time at which the test ends \[s\]: the last with the rudder still at its angle, or the last recorded.
    pub end: f64,
    /// By each model.
    pub predicted: Vec<Track>,
}

/// The results of the experiment.
pub struct Outcome {
    /// Names of the models: empirical, eleven parameters, freed.
    pub models: Vec<String>,
    /// The two fits.
    pub fits: Vec<Fit>,
    /// Measures of turning circles, then of zigzags.
    pub measures: Vec<Measure>,
    /// Turning circles, starboard then port.
    pub circles: Vec<Sailed>,
    /// Zigzags.
    pub zigzags: Vec<Sailed>,
}

/// Fits the models to the zigzags and simulates all trials with each.
///
/// # Errors
/// [`RealError`].
pub fn run() -> Result<Outcome, RealError> {
    let hull = Hull::open("kvlcc2")?;
    let train = hull.windows(Split::Train)?;
    let mut empirical = hull.model("model.toml")?;
    let fits = vec![hull.fitted(&empirical, &train)?, hull.fitted(&hull.model("freed.toml")?, &train)?];
    empirical.name = "empirical".into();
    let models: Vec<&Model> = std::iter::once(&empirical).chain(fits.iter().map(|f| &f.model)).collect();

    // The tests on a grid fine enough for angles.
    let mut fine = hull.study.clone();
    fine.windows.step = Some(0.5);
    let tests = fine.whole_runs(hull.ship.hull.draught)?.windows;
    let trial: ManeuverSettings = settings(&hull.study, "maneuver", &hull.study.maneuver)?;

    let mut outcome = Outcome::new(&models);
    for side in Side::BOTH {
        for test in tests.iter().filter(|w| w.manoeuvre == "turning") {
            outcome.add_turn(test, side, &models, &trial)?;
        }
    }
    for test in tests.iter().filter(|w| w.manoeuvre == "zigzag") {
        // Rudder and heading of a test are alike, and nominally whole tens of degrees.
        let largest = test.inputs.iter().fold(0.0_f64, |m, i| m.max(i.delta.abs())).to_degrees();
        let angle = (10.0 * (largest / 10.0).round()).to_radians();
        outcome.add_zigzag(test, [angle, angle], &models, &trial)?;
    }
    outcome.fits = fits;
    Ok(outcome)
}

fn approaches(models: &[&Model], trial: &ManeuverSettings) -> Result<Vec<(Vec<f64>, Approach)>, RealError> {
    let of = |m: &&Model| {
        let theta = m.values();
        Ok((theta.clone(), trial.approach(m, &theta)?))
    };
    models.iter().map(of).collect()
}

/// The part of a track from a sample on, moved to start at the origin on heading and time 0.
fn from_execute(track: &Track, execute: usize) -> Track {
    let Some(&[x0, y0, course, ..]) = track.states.get(execute) else {
        return Track::default();
    };
    let (sin, cos) = course.sin_cos();
    let moved = |s: &[f64; 6]| {
        let (north, east) = (s[0] - x0, s[1] - y0);
        [north * cos + east * sin, east * cos - north * sin, s[2] - course, s[3], s[4], s[5]]
    };
    Track {
        t: track.t[execute..].iter().map(|t| t - track.t[execute]).collect(),
        states: track.states[execute..].iter().map(moved).collect(),
        delta: track.delta[execute..].to_vec(),
        n: track.n[execute..].to_vec(),
    }
}

impl Outcome {
    /// An outcome of models without trials or fits yet.
    pub(in crate::real) fn new(models: &[&Model]) -> Self {
        Self {
            models: models.iter().map(|m| m.name.clone()).collect(),
            fits: Vec::new(),
            measures: Vec::new(),
            circles: Vec::new(),
            zigzags: Vec::new(),
        }
    }

    /// Adds a turning circle if it is to this side.
    fn add_turn(
        &mut self,
        test: &Run,
        side: Side,
        models: &[&Model],
        trial: &ManeuverSettings,
    ) -> Result<(), RealError> {
        let track = Track::recorded(test);
        let Some(execute) = turning_execute(&track) else { return Ok(()) };
        let measured = turning(&track, execute);
        if Side::of(measured.rudder) != side {
            return Ok(());
        }
        let sailed = approaches(models, trial)?;
        let trials: Vec<_> = models
            .iter()
            .zip(&sailed)
            .map(|(m, (theta, approach))| turning_trial(m, theta, approach, side, HARD_OVER))
            .collect();
        let length = models[0].ship.hull.lpp;
        type Read = fn(&trimtab::evaluate::maneuver::Turning) -> Option<f64>;
        let lengths: [(&str, Read); 4] = [
            ("advance", |t| t.advance),
            ("transfer", |t| t.transfer),
            ("tactical diameter", |t| t.tactical_diameter),
            ("steady diameter", |t| t.steady.map(|s| s.diameter)),
        ];
        for (what, read) in lengths {
            if let Some(value) = read(&measured) {
                self.measures.push(Measure {
                    what: format!("35 deg to {}: {what} [L]", side.word()),
                    angle: false,
                    seen: false,
                    measured: value / length,
                    predicted: trials.iter().map(|t| read(&t.measures).map(|v| v / length)).collect(),
                });
            }
        }
        let shown = from_execute(&track, execute);
        let held = (0..shown.len()).rev().find(|&k| (shown.delta[k] - measured.rudder).abs() < 0.05 * HARD_OVER);
        self.circles.push(Sailed {
            name: test.recording.clone(),
            end: held.map_or(0.0, |k| shown.t[k]),
            measured: shown,
            predicted: trials.into_iter().map(|t| t.track).collect(),
        });
        Ok(())
    }

    /// Adds a zigzag with the rudder at `angles[0]` and put over at a heading of `angles[1]` \[rad\].
    pub(in crate::real) fn add_zigzag(
        &mut self,
        test: &Run,
        angles: [f64; 2],
        models: &[&Model],
        trial: &ManeuverSettings,
    ) -> Result<(), RealError> {
        let track = Track::recorded(test);
        let executes = zigzag_executes(&track);
        let Some(&first) = executes.first() else { return Ok(()) };
        let measured = zigzag(&track, &executes, angles[1]);
        let side = Side::of(measured.rudder);
        let sailed = approaches(models, trial)?;
        let trials: Vec<_> = models
            .iter()
            .zip(&sailed)
            .map(|(m, (theta, approach))| zigzag_trial(m, theta, approach, side, angles))
            .collect();
        // The tests execute at headings counted from a nominal course of 0, from which the ship may be off by a degree at
        // the first execute; overshoots are counted from that course too.
        let strayed = side.sign() * track.states[first][2];
        let overshoots = measured.overshoots.iter().zip([strayed, -strayed]).map(|(o, s)| o + s);
        for (i, overshoot) in overshoots.enumerate() {
            self.measures.push(Measure {
                what: format!(
                    "{:.0}/{:.0}, {} first: overshoot {} [deg]",
                    angles[0].to_degrees(),
                    angles[1].to_degrees(),
                    side.word(),
                    i + 1
                ),
                angle: true,
                seen: test.split == Split::Train,
                measured: overshoot.to_degrees(),
                predicted: trials.iter().map(|t| t.measures.overshoots.get(i).map(|o| o.to_degrees())).collect(),
            });
        }
        let shown = from_execute(&track, first);
        self.zigzags.push(Sailed {
            name: test.recording.clone(),
            end: shown.t.last().copied().unwrap_or(0.0),
            measured: shown,
            predicted: trials.into_iter().map(|t| t.track).collect(),
        });
        Ok(())
    }

    /// The measure of that name.
    pub fn measure(&self, what: &str) -> Option<&Measure> {
        self.measures.iter().find(|m| m.what == what)
    }

    /// Measured and predicted measures, a row each, with errors in per cent of lengths and degrees of angles.
    pub fn table(&self) -> Table {
        let mut header = vec!["measure".to_owned(), "in the fit".into(), "measured".into()];
        for model in &self.models {
            header.extend([model.clone(), format!("{model}: error")]);
        }
        let mut table = Table::new(header);
        for m in &self.measures {
            let decimals = if m.angle { 1 } else { 2 };
            let mut row = vec![m.what.clone(), if m.seen { "yes" } else { "no" }.into(), fixed(m.measured, decimals)];
            for predicted in &m.predicted {
                row.push(predicted.map_or("not reached".into(), |p| fixed(p, decimals)));
                row.push(predicted.map_or(String::new(), |p| {
                    if m.angle {
                        format!("{:+.1} deg", p - m.measured)
                    } else {
                        format!("{:+.1} %", 100.0 * (p / m.measured - 1.0))
                    }
                }));
            }
            table.row(row);
        }
        table
    }

    /// Port against starboard, in words: how much wider the starboard circle is, measured and by each model.
    pub fn asymmetry(&self) -> Option<String> {
        let starboard = self.measure("35 deg to starboard: tactical diameter [L]")?;
        let port = self.measure("35 deg to port: tactical diameter [L]")?;
        let wider = |s: Option<f64>, p: Option<f64>| match (s, p) {
            (Some(s), Some(p)) => format!("{:+.2} L", s - p),
            _ => "not reached".into(),
        };
        let models = self
            .models
            .iter()
            .enumerate()
            .map(|(i, name)| format!("{name} {}", wider(starboard.predicted[i], port.predicted[i])));
        Some(format!(
            "Tactical diameter to starboard less that to port: measured {}; {}.",
            wider(Some(starboard.measured), Some(port.measured)),
            models.collect::<Vec<_>>().join(", ")
        ))
    }

    /// The measured track, up to where the rudder is eased at the end of a turn, and those of the models.
    fn layers(&self, trial: &Sailed, first: bool, point: impl Fn(&Track, usize) -> (f64, f64)) -> Vec<Layer> {
        let line = |name: &str, color: Color, track: &Track, until: f64| {
            let samples = (0..track.len()).filter(|&k| track.t[k] <= until);
            let layer = Layer::line(name, color, samples.map(|k| point(track, k)).collect::<Vec<_>>());
            if first { layer } else { layer.unlisted() }
        };
        let end = trial.end;
        let mut layers = vec![line("measured", RECORDED, &trial.measured, end).width(5.0)];
        for ((name, color), track) in self.models.iter().zip([BASELINE, GREEN, FITTED]).zip(&trial.predicted) {
            layers.push(line(name, color, track, end).dashed());
        }
        layers
    }

    /// Tracks, speed and yaw rate of the turning circles.
    pub fn circles_figure(&self) -> Figure {
        let mut tracks = Panel::track("turning circles at 35 deg of rudder, from the execute");
        let mut speed = Panel::new("speed in the turns", Axis::new("time [s]"), Axis::new("U [m/s]").including(0.0));
        let mut rate = Panel::new("yaw rate in the turns", Axis::new("time [s]"), Axis::new("r [deg/s]"));
        for (i, circle) in self.circles.iter().enumerate() {
            let first = i == 0;
            tracks = tracks.with_all(self.layers(circle, first, |t, k| east_north(t.states[k][0], t.states[k][1])));
            speed = speed.with_all(self.layers(circle, first, |t, k| (t.t[k], t.speed(k))));
            rate = rate.with_all(self.layers(circle, first, |t, k| (t.t[k], t.states[k][5].to_degrees())));
        }
        Figure::new("KVLCC2: turning circles, measured and predicted by models fitted to zigzags alone")
            .columns(3)
            .panel_size(900, 800)
            .with(tracks)
            .with(speed)
            .with(rate)
    }

    /// Heading of the zigzags over time.
    pub fn zigzags_figure(&self) -> Figure {
        self.zigzags_titled("KVLCC2: zigzags, measured and sailed by each model with its own executes")
    }

    /// Heading of the zigzags over time, under a title.
    pub(in crate::real) fn zigzags_titled(&self, title: &str) -> Figure {
        let panels = self.zigzags.iter().enumerate().map(|(i, z)| {
            Panel::new(&z.name, Axis::new("time from the first execute [s]"), Axis::new("heading [deg]"))
                .with_all(self.layers(z, i == 0, |t, k| (t.t[k], t.states[k][2].to_degrees())))
        });
        Figure::new(title).columns(2).panel_size(900, 520).legend(Legend::Shared).with_all(panels)
    }
}
