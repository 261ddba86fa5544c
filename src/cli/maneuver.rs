//! `trimtab maneuver`: the standard trials with any model, their measures, and the IMO criteria beside them.
//! The library sails and measures the trials; this file prints, tabulates and draws them.

use super::answer::Answer;
use super::audited::model_alone;
use super::error::CliError;
use super::figures::FigureArgs;
use super::load::{Loaded, StudyArgs};
use super::output::{Output, OutputArgs};
use super::progress::progress;
use clap::Subcommand;
use serde::Serialize;
use trimtab::files::Names;
use trimtab::maneuver::{Approach, Ended, ManeuverSettings, Side, Trial, stopping_trial, turning_trial, zigzag_trial};
use trimtab::model::Model;
use trimtab::numerals::sig;
use trimtab::plot::Figure;
use trimtab::report::Table;
use trimtab::report::maneuver::{
    criteria_note, criteria_table, ended_note, stopping_figure, stopping_table, track_csv, turning_figure,
    turning_table, zigzag_figure, zigzag_table,
};
use trimtab::state::Inputs;
use trimtab::units::GRAVITY;
use trimtab::validity::{self, Coverage};

const LONG: &str = "\
Simulates a standard manoeuvring trial to both sides with the model of a study, or another given with --model, and measures \
    it as on a real ship: distances of the midship point in ship lengths L, from the instant the rudder begins to move. The \
    criteria of IMO MSC.137(76) are printed beside the measures.

The approach is straight ahead at a speed that the propeller holds: give --speed or --rpm, or set them in [maneuver] of \
    the study with rudder rate, engine rate and angles; without either the approach is at Froude number 0.15.";

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
    Turning(TrialArgs),
    /// Zigzags 10/10 and 20/20: overshoots, initial turning, period
    #[command(after_long_help = ZIGZAG)]
    Zigzag(TrialArgs),
    /// A crash stop: track reach, head reach, lateral deviation, time
    #[command(after_long_help = STOPPING)]
    Stopping(TrialArgs),
}

const TURNING: &str = "\
Example:
  trimtab maneuver turning study.toml --model results/fitted.toml --speed 6 --out turning

With --out: maneuver_turning.json, turning.png and .csv, the track of each trial as CSV.
JSON: result.ship, result.length [m], result.approach (speed [m/s], n [rps], balanced, rudder_rate [rad/s], step [s]), \
    result.trials[] with name, side, ended, measures (advance, transfer, tactical_diameter [m], time_90, time_180 [s], \
    steady.diameter [m], .speed [m/s], .speed_loss [-], .drift [rad], .yaw_rate [rad/s]; absent: not reached), and criteria[] \
    with name, measured, limit, unit, verdict (met, not_met, not_applicable), binding (L >= 100 m); result.validity \
    (share_outside of the samples sailed; outside[] with term, quantity, range, share, met).";

const ZIGZAG: &str = "\
Example:
  trimtab maneuver zigzag study.toml --model results/fitted.toml --out zigzag

With --out: maneuver_zigzag.json, zigzag.png and .csv, the track of each trial as CSV.
JSON: as for turning, with measures rudder, heading, overshoots[] [rad], executes[] [s], initial_turning [m], \
    initial_turning_time, reach, period [s]; absent: not reached.";

const STOPPING: &str = "\
Example:
  trimtab maneuver stopping study.toml --rpm 120 --out stopping

The propeller is reversed to `astern_rpm` at `engine_rate_rpm_s` of [maneuver]; by default to minus the approach rate while \
    sailing two ship lengths.

With --out: maneuver_stopping.json, stopping.png and .csv, the track as CSV.
JSON: as for turning, with measures track_reach, head_reach, lateral_deviation [m], heading_change [rad], time [s]; \
    absent: not reached.";

#[derive(Debug, clap::Args)]
struct TrialArgs {
    #[command(flatten)]
    study: StudyArgs,
    /// Approach speed [m/s]; instead of `speed` in [maneuver].
    #[arg(long, value_name = "M/S", allow_negative_numbers = true)]
    speed: Option<f64>,
    /// Propeller rate of the approach [rpm]; instead of `n_rpm` in [maneuver].
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    rpm: Option<f64>,
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
    approach: Approach,
    trials: &'a [Trial<M>],
    validity: Coverage,
}

/// What every trial needs.
struct Prepared {
    model: Model,
    theta: Vec<f64>,
    settings: ManeuverSettings,
    approach: Approach,
}

impl Prepared {
    fn new(args: &TrialArgs, output: &mut Output) -> Result<Self, CliError> {
        let loaded = Loaded::new(&args.study)?;
        output.reads(&loaded, false);
        let mut settings = loaded.maneuver_settings()?;
        if args.speed.is_some() || args.rpm.is_some() {
            (settings.speed, settings.n_rpm) = (args.speed, args.rpm);
        }
        output.settings("maneuver", &settings)?;
        let path = loaded.study.path.clone();
        let theta = loaded.model.values();
        let approach = settings.approach(&loaded.model, &theta).map_err(|error| CliError::Maneuver { path, error })?;
        Ok(Self { model: loaded.model, theta, settings, approach })
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    match &args.trial {
        Kind::Turning(args) => {
            let mut output = Output::new("maneuver turning", &args.output)?.drawn_as(&args.figures);
            let p = Prepared::new(args, &mut output)?;
            let angle = p.settings.turning_angle();
            let bar = progress("turning");
            let trials = Side::BOTH.map(|side| turning_trial(&p.model, &p.theta, &p.approach, side, angle));
            bar.finish_and_clear();
            let table = turning_table(&p.model.ship, &trials);
            finish(&mut output, &p, &trials, "turning", &table, || turning_figure(&p.model.ship, &trials))?;
            output.finish(&text(&p, &trials, &table), &report(&p, &trials))
        }
        Kind::Zigzag(args) => {
            let mut output = Output::new("maneuver zigzag", &args.output)?.drawn_as(&args.figures);
            let p = Prepared::new(args, &mut output)?;
            let bar = progress("zigzag");
            let sail = |angles, side| zigzag_trial(&p.model, &p.theta, &p.approach, side, angles);
            let angles = p.settings.zigzag_angles();
            let trials: Vec<_> = angles.iter().flat_map(|a| Side::BOTH.map(|side| sail(*a, side))).collect();
            bar.finish_and_clear();
            let table = zigzag_table(&p.model.ship, &trials);
            finish(&mut output, &p, &trials, "zigzag", &table, || zigzag_figure(&p.model.ship, &trials))?;
            output.finish(&text(&p, &trials, &table), &report(&p, &trials))
        }
        Kind::Stopping(args) => {
            let mut output = Output::new("maneuver stopping", &args.output)?.drawn_as(&args.figures);
            let p = Prepared::new(args, &mut output)?;
            let trial = stopping_trial(&p.model, &p.theta, &p.approach);
            let table = stopping_table(&p.model.ship, &trial);
            let trials = [trial];
            finish(&mut output, &p, &trials, "stopping", &table, || stopping_figure(&p.model.ship, &trials[0]))?;
            output.finish(&text(&p, &trials, &table), &report(&p, &trials))
        }
    }?;
    Ok(Answer::Yes)
}

fn report<'a, M>(p: &'a Prepared, trials: &'a [Trial<M>]) -> Report<'a, M> {
    Report {
        ship: &p.model.ship.name,
        model: &p.model.name,
        length: p.model.ship.hull.lpp,
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
fn finish<M>(
    output: &mut Output,
    p: &Prepared,
    trials: &[Trial<M>],
    stem: &str,
    table: &Table,
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
    let rows = table.rows().iter().cloned();
    let header: Vec<&str> = table.header().iter().map(String::as_str).collect();
    output.file(format!("{stem}_measures.csv"), &super::output::csv_text(&header, rows)?);
    output.figure(stem, figure);
    Ok(())
}

fn text<M>(p: &Prepared, trials: &[Trial<M>], table: &Table) -> String {
    let ship = &p.model.ship;
    let a = &p.approach;
    let held = if a.balanced { "in balance" } else { "not in balance" };
    let mut text = format!(
        "{}, model {}: L = {} m, approach {} m/s (Froude number {}) at {} rpm, {held}; rudder rate {} deg/s\n\n{table}\n\n{}",
        ship.name,
        p.model.name,
        sig(ship.hull.lpp, 4),
        sig(a.speed, 4),
        sig(a.speed / (GRAVITY * ship.hull.lpp).sqrt(), 2),
        sig(a.n * 60.0, 4),
        sig(a.rudder_rate.to_degrees(), 3),
        criteria_table(trials.iter().map(|t| (t.name.as_str(), t.criteria.as_slice()))),
    );
    let notes = trials.iter().filter_map(ended_note).chain(criteria_note(ship));
    for note in notes {
        text += &format!("\n{note}");
    }
    text += &format!("\n{}", validity_of(p, trials).line());
    text
}
