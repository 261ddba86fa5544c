//! `trimtab simulate`: simulates the recordings of a study from their recorded start with their recorded inputs.
//! It compares no models; it prints how far each simulation is from the measured motion.

use super::shared::answer::Answer;
use super::shared::audited::{AcceptArgs, audited};
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::load::{Loaded, StudyArgs};
use super::shared::output::{Each, Output, OutputArgs, Pruned, csv_text};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::Arc;
use trimtab::evaluate::{Outcome, Outlying, outcome, outlying, predict_all, start_error};
use trimtab::files::Names;
use trimtab::fit::FitSettings;
use trimtab::model::Model;
use trimtab::numbers::numerals::{DASH, sig, sig_above};
use trimtab::recording::validity::{self, Count, Coverage};
use trimtab::recording::{Run, Split, or_nan};
use trimtab::report::Table;
use trimtab::report::plot::{BLUE, Figure, GREY, Layer, Panel, RECORDED, east_north};
use trimtab::simulate::Trajectory;

const LONG: &str = "\
Simulates every recording of a study (or every window of it, where the study cuts them) with the study's model or another: \
    from the recorded start, under the recorded propeller rate, rudder angle and environment. Prints how far each simulation \
    is from the measured motion.";

const AFTER: &str = "\
Example:
  trimtab simulate study.toml --model results/fitted.toml --out simulated

cVDM is the mean deviation over position, heading and velocities, each relative to the size of the motion, in percent \
    (`trimtab evaluate` compares two models by it). The number after it, ±, is its standard error by the noise of the recorded \
    start, from row to row: a simulation begins where the sensors say, and they err. What the model lacks is not in it.

With --out: simulate.json, simulations.csv, tracks.png and .csv, and trajectories/RUN.csv (see column `file` of \
    simulations.csv), each in the layout of a recording, so that a simulation can be read like a measurement.
JSON: recordings.doubts[] (severity, fault, channel, text, next_step, runs, accepted): what the audit of the recordings found; \
    result.model, result.runs[] with run, split, start_time [s], duration [s], steps, md (x, y [m], psi [rad], u, v [m/s], \
    r [rad/s]), cvdm [%] and cvdm_standard_error [%], or diverged_after [s]; result.validity (share_outside of the recorded \
    samples; outside[] with term, quantity, range, share, met); result.outlying, where one run is predicted far worse than all \
    others: run, cvdm and others (least and largest of the other runs) [%], p (Grubbs's test).

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
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Report<'a> {
    model: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    outlying: Option<Outlying>,
    runs: Each<'a, Row>,
    validity: Pruned<'a, Coverage>,
}

#[derive(Serialize)]
struct Row {
    #[serde(serialize_with = "as_text")]
    run: Arc<str>,
    split: Split,
    start_time: f64,
    duration: f64,
    steps: usize,
    #[serde(flatten)]
    outcome: Outcome,
    /// Of cVDM \[%\], by the noise of the recorded start.
    #[serde(skip_serializing_if = "Option::is_none")]
    cvdm_standard_error: Option<f64>,
}

fn as_text<S: serde::Serializer>(text: &Arc<str>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(text)
}

/// Windows in the table that is printed; the files and the JSON have all of them.
const PRINTED: usize = 2000;

/// Heading of the standard error beside cVDM in a terminal.
const ERROR: &str = "± [%]";

/// Tracks in the figure.
const PANELS: usize = 12;

/// What comes of the windows of one recording.
struct Simulated<'a> {
    rows: Vec<Row>,
    validity: Count<'a>,
    /// Name and text of each trajectory, where files are wanted.
    files: Vec<(String, String)>,
    tracks: Vec<Track>,
}

/// A window beside its simulation, to be drawn.
struct Track {
    name: String,
    window: Run,
    simulated: Trajectory,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("simulate", &args.output)?.drawn_as(&args.figures);
    let loaded = Loaded::new(&args.study)?;
    output.reads(&loaded, true);
    output.settings("fit", &loaded.fit_settings()?)?;
    output.recordings(audited(&loaded, &args.accept)?);
    let settings = loaded.fit_settings()?;
    let model = &loaded.model;
    let written = output.has_folder();
    let (mut rows, mut tracks, mut validity) = (Vec::new(), Tracks::default(), Count::new(model));
    let (mut names, mut files) = (Names::default(), Vec::new());
    loaded.each(
        "simulating",
        |_| true,
        |windows| simulated(model, &settings, windows, written),
        |one| {
            rows.extend(one.rows);
            validity.join(&one.validity);
            tracks.add(one.tracks);
            for (name, text) in &one.files {
                let file = format!("trajectories/{}.csv", names.take(name));
                output.file(&file, text.as_bytes());
                files.push(file);
            }
            Ok(())
        },
    )?;
    let header = table(&[]);
    let words = |name: &String| if name == ERROR { "cVDM std. error [%]".to_owned() } else { name.clone() };
    let more = ["diverged_after [s]", "file"].map(str::to_owned);
    let header: Vec<String> = header.header().iter().map(words).chain(more).collect();
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    if written {
        let cells = rows.iter().zip(files).map(|(row, file)| tidy(row).into_iter().chain([file]));
        output.table("simulations.csv", &csv_text(&header, cells)?);
    }
    output.figure("tracks", || figure(&model.name, rows.len(), tracks));
    let validity = validity.coverage();
    let table = table(&rows[..rows.len().min(PRINTED)]);
    let more = match rows.len().saturating_sub(PRINTED) {
        0 => String::new(),
        more => format!("\nand {more} windows more (in --out and --json)\n"),
    };
    let outlying = outlying(rows.iter().map(|r| (&*r.run, &r.outcome)));
    let text = format!(
        "{}{} simulated with `{}`:\n\n{table}\n{more}{}\n{}",
        outlying.as_ref().map_or(String::new(), Outlying::line),
        loaded.study.name,
        model.name,
        divergences(&rows),
        validity.line()
    );
    let report = Report { model: &model.name, outlying, runs: Each(&rows), validity: Pruned(&validity) };
    output.finish_long(&text, &report)?;
    let diverged = rows.iter().find_map(|r| match r.outcome {
        Outcome::Diverged { diverged_after } => Some((&r.run, diverged_after)),
        Outcome::Simulated(_) => None,
    });
    match diverged {
        Some((run, after)) => Err(CliError::Diverged { what: format!("run `{run}`"), after }),
        None => Ok(Answer::Yes),
    }
}

/// Which windows diverged, and when, as a line; nothing where none did.
fn divergences(rows: &[Row]) -> String {
    let after = |r: &Row| match r.outcome {
        Outcome::Diverged { diverged_after } => Some(format!("{} diverged after {diverged_after:.0} s", r.run)),
        Outcome::Simulated(_) => None,
    };
    let diverged: Vec<String> = rows.iter().filter_map(after).collect();
    match diverged.len() {
        0 => String::new(),
        n if n > 5 => format!("{}, and {} windows more\n", diverged[..5].join(", "), n - 5),
        _ => format!("{}\n", diverged.join(", ")),
    }
}

/// Simulates the windows of one recording.
fn simulated<'a>(model: &'a Model, settings: &FitSettings, windows: Vec<Run>, written: bool) -> Simulated<'a> {
    let trajectories = predict_all(model, &windows, settings.integration);
    let run: Arc<str> = windows.first().map_or("", |w| w.recording.as_str()).into();
    let row = |(w, t): (&Run, &Trajectory)| Row {
        run: run.clone(),
        split: w.split,
        start_time: w.start_time(),
        duration: w.duration(),
        steps: w.steps(),
        outcome: outcome(w, t, &model.ship, settings.max_yaw_rate),
        cvdm_standard_error: start_error(model, w, settings.integration, t, settings.max_yaw_rate),
    };
    let rows = windows.par_iter().zip(&trajectories).map(row).collect();
    let mut validity = Count::new(model);
    validity.add(windows.iter().flat_map(validity::samples));
    let (mut files, mut tracks) = (Vec::new(), Vec::new());
    if written {
        let name = |i: usize| name(&windows, i);
        files = windows.iter().zip(&trajectories).enumerate().map(|(i, (w, t))| (name(i), recording(w, t))).collect();
        let names: Vec<String> = (0..windows.len().min(PANELS)).map(name).collect();
        let all = windows.into_iter().zip(trajectories).zip(names);
        tracks = all.map(|((window, simulated), name)| Track { name, window, simulated }).collect();
    }
    Simulated { rows, validity, files, tracks }
}

/// The tracks that are drawn: the first ones, test before train.
#[derive(Default)]
struct Tracks {
    test: Vec<Track>,
    train: Vec<Track>,
}

impl Tracks {
    fn add(&mut self, tracks: Vec<Track>) {
        for track in tracks {
            let side = if track.window.split == Split::Test { &mut self.test } else { &mut self.train };
            if side.len() < PANELS {
                side.push(track);
            }
        }
    }
}

fn table(rows: &[Row]) -> Table {
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
        ERROR,
    ]);
    for r in rows {
        table.row(cells(r));
    }
    table
}

/// The cells of a window's row.
fn cells(r: &Row) -> Vec<String> {
    let split = match r.split {
        Split::Train => "train",
        Split::Test => "test",
    };
    let mut cells = vec![r.run.to_string(), split.into(), sig(r.start_time, 5), r.steps.to_string()];
    match &r.outcome {
        Outcome::Simulated(d) => {
            let degrees = |i: usize| if i == 2 || i == 5 { 180.0 / std::f64::consts::PI } else { 1.0 };
            let md =
                d.md.iter()
                    .enumerate()
                    .map(|(i, v)| v.map_or_else(|| "–".into(), |v| sig_above(v * degrees(i), 3, 1e-6)));
            cells.extend(md);
            cells.push(sig_above(d.cvdm, 3, 1e-6));
            cells.push(r.cvdm_standard_error.map_or_else(|| DASH.to_owned(), |e| sig_above(e, 2, 1e-6)));
        }
        Outcome::Diverged { .. } => {
            cells.extend(std::iter::repeat_n("–".to_owned(), 6));
            cells.extend(["diverged", DASH].map(str::to_owned));
        }
    }
    cells
}

/// The cells of a window's row in a file: what has no value is empty, and the time of a divergence has its own column.
fn tidy(r: &Row) -> Vec<String> {
    let diverged = match &r.outcome {
        Outcome::Simulated(_) => None,
        Outcome::Diverged { diverged_after } => Some(diverged_after.to_string()),
    };
    let mut cells = cells(r);
    if diverged.is_some() {
        // The word that is in the place of cVDM in a terminal.
        let cvdm = cells.len() - 2;
        cells[cvdm].clear();
    }
    let empty = |cell: String| if cell == DASH { String::new() } else { cell };
    cells.into_iter().map(empty).chain([diverged.unwrap_or_default()]).collect()
}

/// The name of a window: its run, with its start to the millisecond where the run has several. `windows` are those of one
/// recording.
fn name(windows: &[Run], i: usize) -> String {
    let w = &windows[i];
    if windows.len() == 1 {
        return w.recording.clone();
    }
    let start = format!("{:.3}", w.start_time());
    format!("{}_{}s", w.recording, start.trim_end_matches('0').trim_end_matches('.'))
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

/// Tracks of the first windows, measured and simulated.
fn figure(model: &str, windows: usize, tracks: Tracks) -> Figure {
    let panels = tracks.test.iter().chain(&tracks.train).take(PANELS).map(|track| {
        let (w, t) = (&track.window, &track.simulated);
        let line = |states: &[[f64; 6]]| states.iter().map(|s| east_north(s[0], s[1])).collect::<Vec<_>>();
        let start = east_north(w.initial[0], w.initial[1]);
        let mut panel = Panel::track(track.name.clone());
        let recorded: Vec<[f64; 6]> = w.measured.iter().map(or_nan).collect();
        if recorded.iter().any(|s| s[0].is_finite() && s[1].is_finite()) {
            panel = panel.with(Layer::line("recorded", RECORDED, line(&recorded)));
        }
        panel.with(Layer::line("simulated", BLUE, line(&t.states)).dashed()).with(Layer::scatter(
            "start",
            GREY,
            [start],
        ))
    });
    let panels: Vec<Panel> = panels.collect();
    let caption = format!(
        "{} of {windows} windows, the first in the order of the study, test before training: the recorded track, and the track simulated \
         from its first state.",
        panels.len()
    );
    Figure::new(format!("Recorded and simulated with {model}"))
        .caption(caption)
        .columns(4.min(windows.max(1)))
        .panel_size(560, 520)
        .with_all(panels)
}
