//! `trimtab simulate`: simulates the recordings of a study from their recorded start with their recorded inputs.
//! It compares no models; it prints how far each simulation is from the measured motion.

use super::answer::Answer;
use super::audited::{AcceptArgs, audited};
use super::error::CliError;
use super::load::{Loaded, StudyArgs};
use super::output::{Output, OutputArgs, csv_text};
use super::progress::progress;
use serde::Serialize;
use trimtab::evaluate::{Outcome, outcome, predict_all};
use trimtab::numerals::sig;
use trimtab::plot::{BLUE, Figure, GREY, Layer, Panel, RECORDED, east_north};
use trimtab::recording::{Run, Split, or_nan};
use trimtab::report::Table;
use trimtab::simulate::Trajectory;
use trimtab::validity::{self, Coverage};

const LONG: &str = "\
Simulates every recording of a study (or every window of it, where the study cuts them) with the study's model or another: \
    from the recorded start, under the recorded propeller rate, rudder angle and environment. Prints how far each simulation \
    is from the measured motion.";

const AFTER: &str = "\
Example:
  trimtab simulate study.toml --model results/fitted.toml --out simulated

cVDM is the mean deviation over position, heading and velocities, each relative to the size of the motion, in percent \
    (`trimtab evaluate` compares two models by it).

With --out: simulate.json, simulations.csv, tracks.png and .csv, and trajectories/RUN.csv, each in the layout of a \
    recording, so that a simulation can be read like a measurement.
JSON: recordings.doubts[] (severity, fault, channel, text, next_step, runs): what the audit of the recordings found; \
    result.model, result.runs[] with run, split, start_time [s], duration [s], steps, md (x, y [m], psi [rad], u, v [m/s], \
    r [rad/s]) and cvdm [%], or diverged_after [s]; result.validity (share_outside of the recorded samples; outside[] with term, \
    quantity, range, share, met).

Exit code 2 if a simulation diverges, after everything else was written.";

/// Simulates the recordings of a study
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    #[command(flatten)]
    study: StudyArgs,
    #[command(flatten)]
    accept: AcceptArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Report<'a> {
    model: &'a str,
    runs: Vec<Row<'a>>,
    validity: Coverage,
}

#[derive(Serialize)]
struct Row<'a> {
    run: &'a str,
    split: Split,
    start_time: f64,
    duration: f64,
    steps: usize,
    #[serde(flatten)]
    outcome: Outcome,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("simulate", &args.output)?;
    let loaded = Loaded::new(&args.study)?;
    output.recordings(audited(&loaded, &args.accept)?);
    let settings = loaded.fit_settings()?;
    let model = &loaded.model;
    let windows = loaded.windows()?.windows;
    let bar = progress(format!("simulating {} windows", windows.len()));
    let trajectories = predict_all(model, &windows, settings.integration);
    bar.finish_and_clear();

    let row = |(w, t): (&Run, &Trajectory)| outcome(w, t, &model.ship, settings.max_yaw_rate);
    let outcomes: Vec<Outcome> = windows.iter().zip(&trajectories).map(row).collect();
    let rows: Vec<Row<'_>> = windows
        .iter()
        .zip(&outcomes)
        .map(|(w, o)| Row {
            run: &w.recording,
            split: w.split,
            start_time: w.start_time(),
            duration: w.duration(),
            steps: w.steps(),
            outcome: *o,
        })
        .collect();
    let table = table(&rows);
    let header: Vec<&str> = table.header().iter().map(String::as_str).collect();
    output.file("simulations.csv", &csv_text(&header, table.rows().iter().cloned())?)?;
    if output.has_folder() {
        for (i, (w, t)) in windows.iter().zip(&trajectories).enumerate() {
            output.file(format!("trajectories/{}.csv", file_name(&windows, i)), recording(w, t).as_bytes())?;
        }
    }
    output.figure("tracks", || figure(&model.name, &windows, &trajectories))?;
    let samples = windows.iter().flat_map(validity::samples);
    let validity = validity::outside(model, samples);
    let text = format!("{} simulated with `{}`:\n\n{table}\n\n{}", loaded.study.name, model.name, validity.line());
    let report = Report { model: &model.name, runs: rows, validity };
    output.finish(&text, &report)?;
    let diverged = report.runs.iter().find_map(|r| match r.outcome {
        Outcome::Diverged { diverged_after } => Some((r.run, diverged_after)),
        Outcome::Simulated(_) => None,
    });
    match diverged {
        Some((run, after)) => Err(CliError::Diverged { what: format!("run `{run}`"), after }),
        None => Ok(Answer::Yes),
    }
}

fn table(rows: &[Row<'_>]) -> Table {
    let mut table = Table::new([
        "run",
        "split",
        "start [s]",
        "steps",
        "x [m]",
        "y [m]",
        "psi [deg]",
        "u [m/s]",
        "v [m/s]",
        "r [deg/s]",
        "cVDM [%]",
    ]);
    for r in rows {
        let split = match r.split {
            Split::Train => "train",
            Split::Test => "test",
        };
        let mut cells = vec![r.run.to_owned(), split.into(), sig(r.start_time, 5), r.steps.to_string()];
        match &r.outcome {
            Outcome::Simulated(d) => {
                let degrees = |i: usize| if i == 2 || i == 5 { 180.0 / std::f64::consts::PI } else { 1.0 };
                let md = d.md.iter().enumerate().map(|(i, v)| v.map_or_else(|| "–".into(), |v| sig(v * degrees(i), 3)));
                cells.extend(md);
                cells.push(sig(d.cvdm, 3));
            }
            Outcome::Diverged { diverged_after } => {
                cells.extend(std::iter::repeat_n("–".to_owned(), 6));
                cells.push(format!("diverged after {diverged_after:.0} s"));
            }
        }
        table.row(cells);
    }
    table
}

/// The name of a window's file: its run, with its start where the run has several.
pub fn file_name(windows: &[Run], i: usize) -> String {
    let w = &windows[i];
    let safe: String =
        w.recording.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    if windows.iter().filter(|o| o.recording == w.recording).count() > 1 {
        format!("{safe}_{:.0}s", w.start_time())
    } else {
        safe
    }
}

/// A trajectory in the layout of a recording.
fn recording(window: &Run, trajectory: &Trajectory) -> String {
    let mut text = String::from("t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]\n");
    for (k, [x, y, psi, u, v, r]) in trajectory.states.iter().enumerate() {
        let i = &window.inputs[k];
        text += &format!("{},{x},{y},{psi},{u},{v},{r},{},{}\n", window.time(k), i.n, i.delta);
    }
    text
}

/// Tracks of the first windows, test before train: measured and simulated.
fn figure(model: &str, windows: &[Run], trajectories: &[Trajectory]) -> Figure {
    const PANELS: usize = 12;
    let mut order: Vec<usize> = (0..windows.len()).collect();
    order.sort_by_key(|&i| windows[i].split == Split::Train);
    let panels = order.into_iter().take(PANELS).map(|i| {
        let (w, t) = (&windows[i], &trajectories[i]);
        let track = |states: &[[f64; 6]]| states.iter().map(|s| east_north(s[0], s[1])).collect::<Vec<_>>();
        let start = east_north(w.initial[0], w.initial[1]);
        let mut panel = Panel::track(file_name(windows, i));
        let recorded: Vec<[f64; 6]> = w.measured.iter().map(or_nan).collect();
        if recorded.iter().any(|s| s[0].is_finite() && s[1].is_finite()) {
            panel = panel.with(Layer::line("recorded", RECORDED, track(&recorded)));
        }
        panel.with(Layer::line("simulated", BLUE, track(&t.states)).dashed()).with(Layer::scatter(
            "start",
            GREY,
            [start],
        ))
    });
    Figure::new(format!("Recorded and simulated with {model}"))
        .columns(4.min(windows.len().max(1)))
        .panel_size(560, 520)
        .with_all(panels.collect::<Vec<_>>())
}
