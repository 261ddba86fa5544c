//! `trimtab maneuver measure`: the standard trials found in the recordings of a study, measured as recorded and with the model.
//! The library finds and measures them; this file prints and tabulates.

use crate::cli::shared::answer::Answer;
use crate::cli::shared::audited::model_alone;
use crate::cli::shared::error::CliError;
use crate::cli::shared::load::{Loaded, StudyArgs};
use crate::cli::shared::output::{Output, OutputArgs, csv_text};
use serde::Serialize;
use trimtab::evaluate::maneuver::{MeasuredTrial, measured};
use trimtab::recording::{Gaps, Initial, WindowSettings};
use trimtab::report::maneuver::{criteria_note, recorded_criteria, recorded_csv, recorded_heading, recorded_table};

pub(super) const AFTER: &str = "\
Example:
  trimtab maneuver measure study.toml --model results/improved.toml --out measured

A turning circle is a rudder kept at one angle, 4 deg or more, until heading has changed by 90 deg or more; a zigzag is three executes \
    or more to alternating sides at equal changes of heading. Both begin on a straight course: heading within 4 deg over the last ship \
    length, or over what was recorded of it. What is passed over is said with the reason. The whole recording is read at its own step, also where a study cuts it into windows.

The current is that of the recording and of the model: after `trimtab diagnose`, give its improved.toml with --model. Positions and \
    velocities less the current are the trial through the water, to which the IMO criteria are applied. The model sails the same \
    trial in calm water from that speed, its propeller in balance, with the rudder angle and the rudder rate of the recording; where the \
    recorded rudder is an order, over within one sample, with the rate of [maneuver].

With --out: maneuver_measure.json, measured.csv (a row a trial and a measure: over_ground, through_water, model).
JSON: result.ship, result.model, result.length [m], result.trials[] with run, session, name, side, at [s], approach_change [-], rudder_rate [rad/s; absent for an order], \
    recorded (measures, criteria), current (north, east [m/s]), through_water (measures, criteria), simulated (n [rps], ended, measures, criteria) \
    or not_simulated (the reason); measures are those of `trimtab maneuver turning` and `zigzag`, nomoto (gain [1/s], time [s], neutral [rad]) \
    among them. result.passed_over[] with run, at [s], why.";

#[derive(Debug, clap::Args)]
pub(super) struct MeasureArgs {
    #[command(flatten)]
    study: StudyArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Report<'a> {
    ship: &'a str,
    model: &'a str,
    length: f64,
    trials: &'a [MeasuredTrial],
    passed_over: &'a [Passed],
}

/// What is no trial, and in which recording.
#[derive(Serialize)]
struct Passed {
    run: String,
    at: f64,
    why: String,
}

pub(super) fn run(args: &MeasureArgs) -> Result<Answer, CliError> {
    let mut output = Output::new("maneuver measure", &args.output)?;
    let mut loaded = Loaded::new(&args.study)?;
    output.reads(&loaded, true);
    let settings = loaded.maneuver_settings()?;
    output.settings("maneuver", &settings)?;
    // Trials begin and end where they do: whole recordings at their own step, and unbroken stretches of those with gaps.
    let windows = WindowSettings { step: None, window: None, overlap: 0.0, ..loaded.study.windows.clone() };
    loaded.study.windows = WindowSettings { initial: Initial::First, gaps: Gaps::Split, ..windows };
    let (mut trials, mut passed_over) = (Vec::new(), Vec::new());
    let measure = |runs: Vec<trimtab::recording::Run>| {
        let all = runs.into_iter().map(|run| (measured(&run, &loaded.model, &settings), run.recording));
        all.collect::<Vec<_>>()
    };
    loaded.each(
        "measuring",
        |_| true,
        measure,
        |stretches| {
            for ((found, passed), run) in stretches {
                trials.extend(found);
                passed_over.extend(passed.into_iter().map(|p| Passed { run: run.clone(), at: p.at, why: p.why }));
            }
            Ok(())
        },
    )?;
    if let Some(doubts) = model_alone(&loaded.model) {
        output.recordings(doubts);
    }
    let table = recorded_csv(&trials);
    let header: Vec<&str> = table.header().iter().map(String::as_str).collect();
    output.table("measured.csv", &csv_text(&header, table.rows().iter().cloned())?);
    let report = Report {
        ship: &loaded.model.ship.name,
        model: &loaded.model.name,
        length: loaded.model.ship.hull.lpp,
        trials: &trials,
        passed_over: &passed_over,
    };
    output.finish(&text(&loaded, &trials, &passed_over), &report)?;
    Ok(Answer::Yes)
}

fn text(loaded: &Loaded, trials: &[MeasuredTrial], passed: &[Passed]) -> String {
    let ship = &loaded.model.ship;
    let mut parts = Vec::new();
    if trials.is_empty() {
        parts.push(format!(
            "{}: no turning circle and no zigzag in {} recordings; `trimtab maneuver measure --help` says what counts as one.",
            ship.name,
            loaded.study.runs.len()
        ));
    }
    parts.extend(trials.iter().map(|t| format!("{}\n{}", recorded_heading(t), recorded_table(ship, t))));
    if !trials.is_empty() {
        parts.push(recorded_criteria(trials).to_string());
    }
    let mut text = parts.join("\n\n");
    if let Some(note) = criteria_note(ship).filter(|_| !trials.is_empty()) {
        text += &format!("\n{note}");
    }
    for p in passed {
        text += &format!("\nPassed over: {} at {:.1} s, {}.", p.run, p.at, p.why);
    }
    text
}
