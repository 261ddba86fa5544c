//! `trimtab maneuver`: the standard trials with any model, their measures, and the IMO criteria beside them.
//! The library sails and measures the trials; this file prints, tabulates and draws them.

mod measure;

use crate::cli::shared::answer::Answer;
use crate::cli::shared::audited::model_alone;
use crate::cli::shared::error::CliError;
use crate::cli::shared::figures::FigureArgs;
use crate::cli::shared::load::ShipArgs;
use crate::cli::shared::output::{Output, OutputArgs};
use crate::cli::shared::progress::progress;
use clap::Subcommand;
use serde::Serialize;
use std::path::PathBuf;
use trimtab::evaluate::maneuver::{
    Approach, DRAWS, Drawn, Ended, Known, ManeuverError, ManeuverSettings, Measured, SEED, Side, Trial,
    calm_water_of_depth, course_stable, drawn_able, drawn_from, is_stability_open, of_priors, pull_out_trial,
    set_intervals_from, spiral_trial, stopping_trial, turning_trial, zigzag_trial,
};
use trimtab::files::Names;
use trimtab::model::Model;
use trimtab::numbers::numerals::sig;
use trimtab::numbers::uncertainty::Uncertainty;
use trimtab::recording::validity::{self, Coverage};
use trimtab::report::maneuver::{
    Listed, criteria_note, criteria_table, ended_note, measures_csv, measures_table, pull_out_figure, spiral_figure,
    stopping_figure, track_csv, turning_figure, zigzag_figure,
};
use trimtab::report::plot::Figure;
use trimtab::ship::state::Inputs;
use trimtab::ship::units::GRAVITY;
use trimtab::study::Study;

const LONG: &str = "\
Simulates a standard manoeuvring trial to both sides with the model of a study, or another given with --model, and measures \
    it as on a real ship: distances of the midship point in ship lengths L, from the instant the rudder begins to move. The \
    criteria of IMO MSC.137(76) are printed beside the measures.

The trials are sailed in calm water: what the model has of wind, waves, current, bottom, banks, pushes and sensors is left \
    out, and the answer says which. --as-found keeps it.

A model file of `trimtab fit` or `trimtab diagnose` contains the covariance of its parameters. The measures then have 95 % \
    intervals: 2.97 [2.85, 3.09] are the value with the estimates and what the covariance moves it by, to first order, from trials \
    with drawn parameters. Without a covariance the priors of the model file are drawn from, and the spreads of the hull coefficients \
    that are estimated: the intervals then have the middle 95 % of the ships that are drawn. A criterion inside the interval of its measure is open.

The approach is straight ahead at a speed that the propeller keeps: give --speed or --rpm, or set them in [maneuver] of \
    the study with rudder rate, engine rate and angles. What is not set is that of the recordings, without them that of the ship file \
    (`service_speed` of [hull], `rate_deg_s` of [rudder]), else Froude number 0.15 and the usual rate; the first line says which. No \
    recording is needed: --ship and --model instead of a study.";

/// Sails the standard manoeuvring trials
#[derive(Debug, clap::Args)]
#[command(long_about = LONG)]
pub struct Args {
    #[command(subcommand)]
    trial: Kind,
}

#[derive(Debug, Subcommand)]
enum Kind {
    /// Turning circles: advance, transfer, tactical and steady diameter, speed loss, drift
    #[command(after_long_help = TURNING)]
    Turning(TurningArgs),
    /// Zigzags 10/10 and 20/20: overshoots, initial turning, period
    #[command(after_long_help = ZIGZAG)]
    Zigzag(ZigzagArgs),
    /// Trials found in the recordings: the same measures, with and without a current, beside the model's
    #[command(after_long_help = measure::AFTER)]
    Measure(measure::MeasureArgs),
    /// A crash stop: track reach, head reach, lateral deviation, time
    #[command(after_long_help = STOPPING)]
    Stopping(TrialArgs),
    /// Pull-outs: the yaw rate that is left when the rudder is put amidships in a steady turn
    #[command(after_long_help = PULLOUT)]
    Pullout(AngleArgs),
    /// A direct spiral: the steady yaw rate at each rudder angle, there and back
    #[command(after_long_help = SPIRAL)]
    Spiral(AngleArgs),
}

const PULLOUT: &str = "\
Example:
  trimtab maneuver pullout study.toml --model results/fitted.toml --out pullout

A ship whose yaw rates from both sides come together is stable on its course.

With --out: maneuver_pullout.json, pullout.png and .csv, pullout_measures.csv, the track of each trial as CSV.
JSON: as for turning, with measures rudder [rad], turning_rate, residual_rate [rad/s], decay_time [s]; absent: not reached; result.course_stable.";

const SPIRAL: &str = "\
Example:
  trimtab maneuver spiral study.toml --model results/fitted.toml --angle 15 --out spiral

Each rudder angle is kept until the yaw rate is steady, for 150 ship lengths at most. A ship that is unstable on its course has a loop: two \
    rates at small angles. Its width is known to a degree or two, the distance of the angles.

With --out: maneuver_spiral.json, spiral.png and .csv, spiral_measures.csv, the track as CSV.
JSON: as for turning, with measures rudder, loop_width, neutral [rad], loop_height [rad/s], points[] (rudder angle [rad], yaw rate [rad/s]); \
    absent: not reached.";

const TURNING: &str = "\
Example:
  trimtab maneuver turning study.toml --model results/fitted.toml --speed 6 --out turning

With --out: maneuver_turning.json, turning.png and .csv, turning_measures.csv (a row a trial and a measure: value, low95, high95), the track of each trial as CSV.
JSON: result.ship, result.length [m], result.left_out[] (terms), result.draws (count, seed, covariance, undetermined[]; where there are \
    intervals), result.approach (speed [m/s], n [rps], balanced, rudder_rate [rad/s], step [s], speed_source and rudder_rate_source: set, propeller_rate, recordings, ship_file or usual), \
    result.trials[] with name, side, ended, intervals (by measure: low and high, in the units of the measures), measures (advance, transfer, tactical_diameter [m], time_90, time_180 [s], \
    steady.diameter [m], .speed [m/s], .speed_loss [-], .drift [rad], .yaw_rate [rad/s], nomoto.gain [1/s], .time [s], .neutral [rad]; absent: not reached), and criteria[] \
    with name, measured, interval, limit, unit, verdict (met, not_met, open, not_applicable), binding (L >= 100 m); result.validity \
    (share_outside of the samples sailed; outside[] with term, quantity, range, share, met).";

const ZIGZAG: &str = "\
Example:
  trimtab maneuver zigzag study.toml --model results/fitted.toml --out zigzag

With --out: maneuver_zigzag.json, zigzag.png and .csv, zigzag_measures.csv, the track of each trial as CSV.
JSON: as for turning, with measures rudder, heading, overshoots[] [rad], executes[] [s], initial_turning [m], \
    initial_turning_time, reach, period [s], nomoto (gain [1/s], time [s], neutral [rad]); absent: not reached.";

const STOPPING: &str = "\
Example:
  trimtab maneuver stopping study.toml --rpm 120 --out stopping

The propeller is reversed to `astern_rpm` at `engine_rate_rpm_s` of [maneuver]; by default to minus the approach rate while \
    sailing two ship lengths.

With --out: maneuver_stopping.json, stopping.png and .csv, stopping_measures.csv, the track as CSV.
JSON: as for turning, with measures track_reach, head_reach, lateral_deviation [m], heading_change [rad], time [s]; \
    absent: not reached.";

#[derive(Debug, clap::Args)]
struct TurningArgs {
    /// Rudder angle [deg]; instead of `turning_deg` in [maneuver], 35 without either.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    angle: Option<f64>,
    #[command(flatten)]
    trial: TrialArgs,
}

#[derive(Debug, clap::Args)]
struct ZigzagArgs {
    /// Rudder and heading angle [deg] of the one zigzag to sail; instead of `zigzag_deg` in [maneuver], 10 and 20 without either.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    angle: Option<f64>,
    #[command(flatten)]
    trial: TrialArgs,
}

#[derive(Debug, clap::Args)]
struct AngleArgs {
    /// Rudder angle [deg]: of the turn before a pull-out, the largest of a spiral.
    #[arg(long, value_name = "DEG", default_value_t = 20.0, allow_negative_numbers = true)]
    angle: f64,
    #[command(flatten)]
    trial: TrialArgs,
}

#[derive(Debug, clap::Args)]
struct TrialArgs {
    #[command(flatten)]
    study: ShipArgs,
    /// Approach speed [m/s]; instead of `speed` in [maneuver].
    #[arg(long, value_name = "M/S", allow_negative_numbers = true)]
    speed: Option<f64>,
    /// Propeller rate of the approach [rpm]; instead of `n_rpm` in [maneuver].
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    rpm: Option<f64>,
    /// Depth of the water [m]; instead of `depth` in [maneuver], deep water without either.
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    depth: Option<f64>,
    /// Keep the environment and sensor terms of the model.
    #[arg(long)]
    as_found: bool,
    /// Draws of the covariance for the 95 % intervals, each sailed twice; 0 for none.
    #[arg(long, value_name = "N", default_value_t = DRAWS)]
    draws: usize,
    /// Seed of the draws.
    #[arg(long, value_name = "N", default_value_t = SEED)]
    seed: u64,
    #[command(flatten)]
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Report<'a, M> {
    ship: &'a str,
    model: &'a str,
    length: f64,
    left_out: &'a [&'static str],
    #[serde(skip_serializing_if = "Option::is_none")]
    draws: Option<Draws<'a>>,
    approach: Approach,
    trials: &'a [Trial<M>],
    validity: Coverage,
}

/// How intervals came about.
#[derive(Serialize)]
struct Draws<'a> {
    count: usize,
    seed: u64,
    covariance: &'a str,
    undetermined: &'a [String],
}

/// What every trial needs.
struct Prepared {
    model: Model,
    theta: Vec<f64>,
    settings: ManeuverSettings,
    approach: Approach,
    /// Terms that were left out.
    left_out: Vec<&'static str>,
    /// Environment and sensor terms that were kept.
    kept: Vec<&'static str>,
    /// Sessions whose additions are left out.
    sessions: usize,
    model_path: PathBuf,
    /// What is known of the parameters, by a fit or before it.
    uncertainty: Option<Uncertainty>,
    /// Which of the two.
    known: Known,
    /// Draws of it.
    drawn: Vec<Drawn>,
    /// Share of the drawn ships that cannot hold the approach speed, which are left out.
    unable: f64,
    seed: u64,
}

impl Prepared {
    /// `change` puts what only some trials have as an option into the settings of the study.
    fn new(
        args: &TrialArgs,
        output: &mut Output,
        change: impl FnOnce(&mut ManeuverSettings),
    ) -> Result<Self, CliError> {
        let loaded = args.study.load(Study::read_with_any_runs)?;
        output.reads(&loaded, false);
        let mut settings = loaded.maneuver_settings()?;
        if args.speed.is_some() || args.rpm.is_some() {
            (settings.speed, settings.n_rpm) = (args.speed, args.rpm);
        }
        settings.depth = args.depth.or(settings.depth);
        change(&mut settings);
        let settings = settings.of_recordings(&loaded.study, &loaded.model.ship);
        output.settings("maneuver", &settings)?;
        let path = loaded.study.path.clone();
        let fail = |error| CliError::Maneuver { path: path.clone(), error };
        let (calm, around) =
            calm_water_of_depth(&loaded.model, settings.depth).map_err(|error| fail(ManeuverError::Setting(error)))?;
        let (model, left_out, kept) =
            if args.as_found { (loaded.model.clone(), Vec::new(), around) } else { (calm, around, Vec::new()) };
        let theta = model.values();
        let approach = settings.approach(&model, &theta).map_err(fail)?;
        let (model_path, fitted) = loaded.uncertainty()?;
        let known = if fitted.is_some() { Known::ByFit } else { Known::Before };
        let uncertainty = fitted.or_else(|| of_priors(&model));
        let (drawn, unable) = match (&uncertainty, known) {
            (None, _) => (Vec::new(), 0.0),
            (Some(u), Known::ByFit) => (drawn_from(known, &model, u, args.draws, args.seed), 0.0),
            (Some(u), Known::Before) => {
                let can = |theta: &[f64]| settings.approach(&model, theta).is_ok();
                drawn_able(&model, u, args.draws, args.seed, can)
            }
        };
        let (model_path, sessions, seed) = (model_path.to_owned(), model.sessions.len(), args.seed);
        Ok(Self {
            model,
            theta,
            settings,
            approach,
            left_out,
            kept,
            sessions,
            model_path,
            known,
            uncertainty,
            drawn,
            unable,
            seed,
        })
    }

    /// The same without intervals.
    fn without_draws(self) -> Self {
        Self { drawn: Vec::new(), ..self }
    }

    /// Sets the intervals of trials, which `sail` sails for an approach and a parameter vector.
    fn intervals<M: Measured + Send>(
        &self,
        trials: &mut [Trial<M>],
        sail: impl Fn(&Approach, &[f64]) -> Vec<Trial<M>> + Sync,
    ) {
        // The approach of a draw keeps the speed with the thrust and the resistance of that draw.
        set_intervals_from(self.known, trials, &self.drawn, |theta| {
            Some(sail(&self.settings.approach(&self.model, theta).ok()?, theta))
        });
    }

    fn draws(&self) -> Option<Draws<'_>> {
        let u = self.uncertainty.as_ref().filter(|_| !self.drawn.is_empty())?;
        Some(Draws { count: self.drawn.len(), seed: self.seed, covariance: &u.kind, undetermined: &u.undetermined })
    }

    /// What water the trials are sailed in, and where intervals are from.
    fn notes(&self) -> String {
        let mut notes = Vec::new();
        if !self.left_out.is_empty() {
            notes.push(format!("Calm water: {} left out (`--as-found` keeps them).", self.left_out.join(", ")));
        }
        if let Some(depth) = self.settings.depth {
            let ratio = depth / self.model.ship.hull.draught;
            let limit = if ratio < 1.5 { ", where its law is not valid (from 1.5 on)" } else { "" };
            notes.push(format!("Water of {} m, h/d = {}, by the term `shallow`{limit}.", sig(depth, 3), sig(ratio, 3)));
        }
        if !self.kept.is_empty() {
            notes.push(format!("As found, not in calm water: {} kept.", self.kept.join(", ")));
        }
        if self.sessions > 0 {
            notes.push(format!("What the model adds in its {} sessions is left out.", self.sessions));
        }
        match self.draws() {
            Some(d) => {
                let (what, without) = match self.known {
                    Known::ByFit => ("the covariance in", "; what the model's form leaves out is not in them"),
                    Known::Before => ("the priors of", ""),
                };
                notes.push(format!(
                    "95 % intervals in brackets: {} draws of {what} {} ({}), seed {}{without}.",
                    d.count,
                    self.model_path.display(),
                    d.covariance,
                    d.seed
                ));
                if self.unable > 0.0 {
                    notes.push(format!(
                        "Left out: {} % of the drawn ships, which cannot hold the approach speed.",
                        sig(100.0 * self.unable, 2)
                    ));
                }
                if !d.undetermined.is_empty() {
                    notes.push(format!(
                        "Fixed at their values, as the data do not determine them: {}.",
                        d.undetermined.join(", ")
                    ));
                }
            }
            None if self.uncertainty.is_none() => notes.push(format!(
                "No intervals: {} has no covariance and no priors; fitted.toml of `trimtab fit --out` has a covariance.",
                self.model_path.display()
            )),
            None => {}
        }
        if let Some(doubt) = self.uncertainty.as_ref().and_then(|u| u.doubt.as_ref()) {
            notes.push(format!("Of the fit: {doubt}"));
        }
        notes.iter().map(|note| format!("\n{note}")).collect()
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    match &args.trial {
        Kind::Measure(args) => return measure::run(args),
        Kind::Turning(TurningArgs { angle, trial: args }) => {
            let mut output = Output::new("maneuver turning", &args.output)?.drawn_as(&args.figures);
            let p = Prepared::new(args, &mut output, |settings| settings.turning_deg = angle.or(settings.turning_deg))?;
            let angle = p.settings.turning_angle();
            let sail = |approach: &Approach, theta: &[f64]| {
                Side::BOTH.map(|side| turning_trial(&p.model, theta, approach, side, angle)).to_vec()
            };
            let trials = sailed(&p, "turning", &sail);
            finish(&mut output, &p, &trials, "turning", || turning_figure(&p.model.ship, &trials))?;
            output.finish(&text(&p, &trials), &report(&p, &trials))
        }
        Kind::Zigzag(ZigzagArgs { angle, trial: args }) => {
            let mut output = Output::new("maneuver zigzag", &args.output)?.drawn_as(&args.figures);
            let one = angle.map(|a| vec![[a, a]]);
            let p =
                Prepared::new(args, &mut output, |settings| settings.zigzag_deg = one.or(settings.zigzag_deg.take()))?;
            let angles = p.settings.zigzag_angles();
            let sail = |approach: &Approach, theta: &[f64]| {
                let both = |a: &[f64; 2]| Side::BOTH.map(|side| zigzag_trial(&p.model, theta, approach, side, *a));
                angles.iter().flat_map(both).collect()
            };
            let trials = sailed(&p, "zigzag", &sail);
            finish(&mut output, &p, &trials, "zigzag", || zigzag_figure(&p.model.ship, &trials))?;
            output.finish(&text(&p, &trials), &report(&p, &trials))
        }
        Kind::Stopping(args) => {
            let mut output = Output::new("maneuver stopping", &args.output)?.drawn_as(&args.figures);
            let p = Prepared::new(args, &mut output, |_| {})?;
            let sail = |approach: &Approach, theta: &[f64]| vec![stopping_trial(&p.model, theta, approach)];
            let trials = sailed(&p, "stopping", &sail);
            finish(&mut output, &p, &trials, "stopping", || stopping_figure(&p.model.ship, &trials[0]))?;
            output.finish(&text(&p, &trials), &report(&p, &trials))
        }
        Kind::Pullout(args) => pull_out(args),
        Kind::Spiral(args) => spiral(args),
    }?;
    Ok(Answer::Yes)
}

/// The pull-outs to both sides.
fn pull_out(args: &AngleArgs) -> Result<(), CliError> {
    let mut output = Output::new("maneuver pullout", &args.trial.output)?.drawn_as(&args.trial.figures);
    let p = Prepared::new(&args.trial, &mut output, |settings| settings.turning_deg = Some(args.angle))?;
    let angle = p.settings.turning_angle();
    let sail = |approach: &Approach, theta: &[f64]| {
        Side::BOTH.map(|side| pull_out_trial(&p.model, theta, approach, side, angle)).to_vec()
    };
    let trials = sailed(&p, "pull-out", &sail);
    finish(&mut output, &p, &trials, "pullout", || pull_out_figure(&p.model.ship, &trials))?;
    let stable = course_stable(&trials);
    let said = match (stable, is_stability_open(&trials)) {
        (None, _) => "",
        (Some(_), true) => {
            "\nThe intervals of the yaw rates that are left contain zero and more than zero: they leave open whether the ship is stable on its course."
        }
        (Some(true), false) => "\nThe yaw rates come together: the ship is stable on its course.",
        (Some(false), false) => "\nThe yaw rates do not come together: the ship is unstable on its course.",
    };
    let report = Steadied { report: report(&p, &trials), course_stable: stable };
    output.finish(&(text(&p, &trials) + said), &report)
}

/// A report of pull-outs.
#[derive(Serialize)]
struct Steadied<'a, M> {
    #[serde(flatten)]
    report: Report<'a, M>,
    #[serde(skip_serializing_if = "Option::is_none")]
    course_stable: Option<bool>,
}

/// The spiral.
fn spiral(args: &AngleArgs) -> Result<(), CliError> {
    let mut output = Output::new("maneuver spiral", &args.trial.output)?.drawn_as(&args.trial.figures);
    // A spiral is long, and its loop is no smooth measure of the parameters: it is sailed once.
    let p =
        Prepared::new(&args.trial, &mut output, |settings| settings.turning_deg = Some(args.angle))?.without_draws();
    let angle = p.settings.turning_angle();
    let trials = sailed(&p, "spiral", &|approach: &Approach, theta: &[f64]| {
        vec![spiral_trial(&p.model, theta, approach, angle)]
    });
    finish(&mut output, &p, &trials, "spiral", || spiral_figure(&p.model.ship, &trials[0]))?;
    output.finish(&text(&p, &trials), &report(&p, &trials))
}

/// The trials with the model's parameters, and their intervals.
fn sailed<M: Measured + Send>(
    p: &Prepared,
    doing: &str,
    sail: &(impl Fn(&Approach, &[f64]) -> Vec<Trial<M>> + Sync),
) -> Vec<Trial<M>> {
    let bar = progress(doing.to_owned());
    let mut trials = sail(&p.approach, &p.theta);
    p.intervals(&mut trials, sail);
    bar.finish_and_clear();
    trials
}

fn report<'a, M>(p: &'a Prepared, trials: &'a [Trial<M>]) -> Report<'a, M> {
    Report {
        ship: &p.model.ship.name,
        model: &p.model.name,
        length: p.model.ship.hull.lpp,
        left_out: &p.left_out,
        draws: p.draws(),
        approach: p.approach,
        trials,
        validity: validity_of(p, trials),
    }
}

/// How much of what was sailed lies outside the ranges of the model's terms.
fn validity_of<M>(p: &Prepared, trials: &[Trial<M>]) -> Coverage {
    let samples = trials.iter().flat_map(|trial| {
        let track = &trial.track;
        let inputs = track.t.iter().zip(&track.n).zip(&track.delta);
        track.states.iter().zip(inputs.map(|((t, n), delta)| Inputs::actuators(*t, *n, *delta)))
    });
    validity::outside(&p.model, samples)
}

/// Writes the files; refuses a trial that diverged, which has no measures.
fn finish<M: Listed>(
    output: &mut Output,
    p: &Prepared,
    trials: &[Trial<M>],
    stem: &str,
    figure: impl FnOnce() -> Figure,
) -> Result<(), CliError> {
    if let Some(doubts) = model_alone(&p.model) {
        output.recordings(doubts);
    }
    if let Some((what, after)) = trials.iter().find_map(|t| match t.ended {
        Ended::Diverged { after } => Some((t.name.clone(), after)),
        Ended::Complete | Ended::TimeOut { .. } => None,
    }) {
        return Err(CliError::Diverged { what: format!("{}: {what}", p.model.name), after });
    }
    let mut names = Names::default();
    for trial in trials {
        let name = names.take(&trial.name.replace(", ", "_"));
        output.file(format!("tracks/{name}.csv"), track_csv(&trial.track).as_bytes());
    }
    let table = measures_csv(trials);
    let rows = table.rows().iter().cloned();
    let header: Vec<&str> = table.header().iter().map(String::as_str).collect();
    output.table(&format!("{stem}_measures.csv"), &crate::cli::shared::output::csv_text(&header, rows)?);
    output.figure(stem, figure);
    Ok(())
}

fn text<M: Listed>(p: &Prepared, trials: &[Trial<M>]) -> String {
    let ship = &p.model.ship;
    let a = &p.approach;
    let balance = if a.balanced { "in balance" } else { "not in balance" };
    let mut text = format!(
        "{}, model {}: L = {} m, approach {} m/s ({}; Froude number {}) at {} rpm, {balance}; rudder rate {} deg/s ({}){}\n\n{}\n\n{}",
        ship.name,
        p.model.name,
        sig(ship.hull.lpp, 4),
        sig(a.speed, 4),
        a.speed_source.words(),
        sig(a.speed / (GRAVITY * ship.hull.lpp).sqrt(), 2),
        sig(a.n * 60.0, 4),
        sig(a.rudder_rate.to_degrees(), 3),
        a.rudder_rate_source.words(),
        p.notes(),
        measures_table(ship, trials),
        criteria_table(trials.iter().map(|t| (t.name.as_str(), t.criteria.as_slice()))),
    );
    let judged = trials.iter().any(|t| !t.criteria.is_empty());
    if !judged {
        text.truncate(text.rfind("\n\n").unwrap_or(text.len()));
    }
    let without = p.draws().filter(|_| trials.iter().any(|t| t.ended == Ended::Complete && t.intervals.is_empty()));
    let without = without.map(|_| "No interval where fewer than 95 % of the drawn ships reach a measure.".to_owned());
    let notes = trials.iter().filter_map(ended_note).chain(criteria_note(ship).filter(|_| judged)).chain(without);
    for note in notes {
        text += &format!("\n{note}");
    }
    text += &format!("\n{}", validity_of(p, trials).line());
    text
}
