//! `trimtab plan`: what planned trials and sensors would show, before going to sea.
//! The library simulates and tests the trials; this file reads the arguments, prints and writes files.

use super::shared::answer::Answer;
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::load::ShipArgs;
use super::shared::output::{Output, OutputArgs, csv_text};
use super::shared::progress::progress;
use serde::Serialize;
use std::path::PathBuf;
use trimtab::diagnose::Settings;
use trimtab::diagnose::plan::{Plan, PlanSettings, Question, plan};
use trimtab::evaluate::maneuver::ManeuverSettings;
use trimtab::model::Model;
use trimtab::report::Table;
use trimtab::report::plan::{detectable_table, isolability_figure, isolability_table, summary, trials_table};
use trimtab::study::Study;

const LONG: &str = "\
Says before going to sea what planned trials and sensors would show. The trials are simulated with
the model and tested as `trimtab diagnose` would test their recordings:
  - which mechanisms of the catalogue are identifiable once the model's parameters and the unknown
    hull, propeller and rudder coefficients are fitted too
  - the smallest size of each that is seen in 80 % of such programmes
  - which mechanisms cannot be distinguished, as one takes over 90 % of the gain of the other
  - with --part A,B the cheapest set of trials found that distinguishes two mechanisms

Recordings are not needed: STUDY may name recordings that do not exist yet, or list none. Instead
of a study --ship and --model can be given.

Cost is sailing time without approaches. The set for --part is chosen one trial at a time, the one
that brings most for its duration, from the planned trials, the usual ones and an acceleration, on
courses 0, 90, 180 and 270 deg; then trials that are not needed are removed. It is not proved to be
the cheapest of all.";

const AFTER: &str = "\
Example:
  trimtab plan study.toml --part current,mean_wind --out planned
  trimtab plan --ship ship.toml --model model.toml

Table [plan] of the study; every key may be left out:
  [[plan.trials]]             a trial; without any, turning circles of 35 deg and zigzags 10/10 and
                              20/20 to both sides, a crash stop, and straight runs at the approach
                              speed and 0.6 of it, each on courses 0, 90, 180 and 270 deg
  kind = \"zigzag\"             turning, zigzag, stopping, straight or acceleration (required)
  rudder_deg = -20            rudder of a turning circle (35) or zigzag (20) [deg], 1 to 70; negative
                              for a first rudder to port
  heading_change_deg = 20     heading at which the rudder of a zigzag is put over [deg], 1 to 90; the
                              rudder angle
  speed = 6.0                 speed at the start [m/s]; the approach speed of [maneuver], half of it
                              for an acceleration
  n_rpm = 110                 propeller rate [rpm]; the rate that keeps the speed, for an acceleration
                              the rate of the approach
  heading_deg = [0, 90]       course or courses at the start [deg]; 0
  duration = 600              longest duration [s]; 15 ship lengths for a straight run, 20 for an
                              acceleration, the others until they are complete
  repeat = 2                  times that it is sailed, 1 to 100; 1
  session = \"loaded\"          what shares a hidden condition; all trials share one

  [plan.sensors]              standard deviations of white noise; in brackets for ships below 20 m
  position = 0.5              north and east [m]; 0.5 (0.005)
  heading_deg = 0.1           [deg]; 0.1 (0.05)
  speed = 0.05                velocity ahead and across [m/s]; 0.05 (0.01)
  yaw_rate_deg_s = 0.02       [deg/s]; 0.02 (0.05)
  step = 1.0                  sample period [s]; the time for a tenth of a ship length
  without = [\"speed\"]         sensors not on board: position, heading, speed, yaw_rate

Rudder rate, engine rate and approach are those of [maneuver]; alpha, nuisance, withhold and
substeps those of [diagnose]. The unknown force is the first guess of a diagnosis.

With --out: plan.json, trials.csv, detectable.csv, isolability.csv, the matrix as figure
isolability_map.png with the CSV behind it.
JSON: result.ship, result.model, result.plan with trials[] (name, kind, heading_deg, session, speed
[m/s], minutes, samples, complete), minutes, noise (SI units), alpha, mechanisms[] (mechanism,
title, identifiable, retained, size, unit, absorbed_by, between_sessions), isolability (mechanisms[],
share[][], tolerance, pairs[], classes[]) and parting (pair, parted, unidentifiable[], trials[],
minutes, of).

Exit code 0 if done, 1 if no set of trials was found that parts the pair of --part, 2 if it could
not run.";

/// Says what planned trials and sensors would show, before going to sea
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    #[command(flatten)]
    study: ShipArgs,
    /// Two mechanisms (see `trimtab terms`): looks for the cheapest trials that distinguish them.
    #[arg(long, value_name = "A,B", value_delimiter = ',', num_args = 1)]
    part: Vec<String>,
    #[command(flatten)]
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Report<'a> {
    ship: &'a str,
    model: &'a str,
    plan: &'a Plan,
}

/// What a plan is made from.
struct Prepared {
    path: PathBuf,
    files: Vec<PathBuf>,
    model: Model,
    plan: PlanSettings,
    maneuver: ManeuverSettings,
    diagnose: Settings,
}

impl Prepared {
    fn new(args: &Args) -> Result<Self, CliError> {
        let loaded = args.study.load(Study::read_without_runs)?;
        Ok(Self {
            path: loaded.study.path.clone(),
            files: loaded.files(false),
            plan: loaded.plan_settings()?,
            maneuver: loaded.maneuver_settings()?,
            diagnose: loaded.diagnose_settings()?,
            model: loaded.model,
        })
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("plan", &args.output)?.drawn_as(&args.figures);
    let pair = match args.part.as_slice() {
        [] => None,
        [a, b] => Some([a.trim(), b.trim()]),
        _ => return Err(CliError::Argument("--part takes two mechanisms, as in `--part current,mean_wind`".into())),
    };
    let p = Prepared::new(args)?;
    output.reads_files(&p.files);
    output.settings("plan", &p.plan)?;
    output.settings("maneuver", &p.maneuver)?;
    output.settings("diagnose", &p.diagnose)?;
    let question = Question { model: &p.model, plan: &p.plan, maneuver: &p.maneuver, diagnose: &p.diagnose };
    let bar = progress("planning");
    let planned = plan(&question, pair, &|step| bar.set_message(format!("planning: {step}")));
    bar.finish_and_clear();
    let planned = planned.map_err(|error| CliError::Plan { path: p.path.clone(), error })?;
    for (name, table) in [
        ("trials.csv", trials_table(&planned)),
        ("detectable.csv", detectable_table(&planned)),
        ("isolability.csv", isolability_table(&planned)),
    ] {
        output.table(name, &csv(&table)?);
    }
    if !planned.isolability.mechanisms.is_empty() {
        output.figure("isolability_map", || isolability_figure(&planned));
    }
    let (ship, model) = (p.model.ship.name.as_str(), p.model.name.as_str());
    let text = format!("PLAN for {ship}, model {model}\n{}", summary(&planned));
    output.finish(&text, &Report { ship, model, plan: &planned })?;
    let refused = planned.parting.as_ref().is_some_and(|parting| !parting.parted);
    Ok(if refused { Answer::No } else { Answer::Yes })
}

fn csv(table: &Table) -> Result<Vec<u8>, CliError> {
    let header: Vec<&str> = table.header().iter().map(String::as_str).collect();
    csv_text(&header, table.rows().iter().cloned())
}
