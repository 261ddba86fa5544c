//! `trimtab evaluate`: how well a model predicts the test runs, beside a baseline.
//! The library computes the measures; this file prints, tabulates and draws them.

use super::shared::answer::Answer;
use super::shared::audited::{AcceptArgs, audited_over};
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::load::{Loaded, StudyArgs};
use super::shared::output::{Each, Output, OutputArgs, Pruned, csv_text};
use super::shared::progress::progress;
use serde::Serialize;
use std::path::PathBuf;
use trimtab::evaluate::{Comparison, Estimate, Evaluation, Judging, Outcome, Outlying, Proof, Summary, predict, prove};
use trimtab::files::ranks::Ranks;
use trimtab::model::Model;
use trimtab::numbers::numerals::{DASH, sig, sig_above};
use trimtab::recording::validity::Coverage;
use trimtab::recording::{Run, Split, or_nan};
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BASELINE, FITTED, Figure, GREY, Layer, Panel, RECORDED, east_north};
use trimtab::ship::state::STATE_NAMES;
use trimtab::simulate::Integration;

const LONG: &str = "\
Simulates the recordings of a study with two models and compares both with the measured motion, first on the test runs: \
    mean deviation (MD) of each dimension, cVDM (all dimensions in one number, percent), how much the fitted model improves on \
    the baseline, and on how many runs. All intervals are of 95 % and over runs: of an improvement by Student's t, of \
    everything else from a bootstrap.

The fitted model is --model, or the study's. The baseline is --baseline, or `baseline` in [evaluate] of the study, or the \
    study's model. If both are one model, its deviations are printed without a comparison.";

const AFTER: &str = "\
Example:
  trimtab fit study.toml --out results
  trimtab evaluate study.toml --model results/fitted.toml --baseline published.toml --out results

Measures: MD = mean |simulated - measured|; cVDM = 100 x mean of |dx|/L + |dy|/L + |dpsi|/pi + |du|/U + |dv|/U + |dr|/r_max \
    with path length L and mean speed U of each run; mARI = median over trajectories of the mean relative improvement over the \
    six dimensions; consistency = 1 - Var(cVDM)/Var(cVDM of the baseline). Steady motion (u, v and r as they are at the start) \
    needs no model. A simulation that diverges is counted as worse than \
    any that does not, and left out of the means.

With --out: evaluate.json, trajectories.csv, summary.csv, improvement.png, cvdm.png, tracks.png, each with its CSV.
JSON: recordings.doubts[] (severity, fault, channel, text, next_step, runs, accepted): what the audit of the recordings found; \
    result.baseline, result.fitted (names), result.summaries[] with group (test, train, then `manoeuvre: ...` and \
    `session: ...` of test), runs, trajectories, md_baseline, md_fitted, md_improvement (x, y, psi, u, v, r), cvdm_baseline, \
    cvdm_fitted, cvdm_steady [%], cvdm_improvement, mari, consistency [-] (each value and ci95), better, worse, runs_better, runs_worse, \
    diverged_baseline, diverged_fitted, worst, most_worsened; result.trajectories[] with run, split, steady, baseline and fitted (md, \
    cvdm, or diverged_after [s]); result.validity (share_outside of the samples; outside[] with term, quantity, range, share, \
    met); result.outlying, where one run is predicted far worse than all others: run, cvdm and others (least and largest of the \
    other runs) [%], p (Grubbs's test). A number that does not exist is absent.";

/// Judges a model on the test runs, against a baseline
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// Model file of the baseline.
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    #[command(flatten)]
    accept: AcceptArgs,
    #[command(flatten)]
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// Runs the command.
pub fn run(args: &Args, ranks: &Ranks) -> Result<Answer, CliError> {
    let mut output = Output::of_rank(ranks, "evaluate", &args.output)?.drawn_as(&args.figures);
    let loaded = Loaded::new(&args.study)?;
    output.reads(&loaded, true);
    output.reads_files(&[baseline_path(&loaded, args.baseline.as_ref())?]);
    output.recordings(audited_over(ranks, &loaded, &args.accept)?);
    let baseline = baseline(&loaded, args.baseline.as_ref())?;
    let judging = judging(&loaded)?;
    output.settings("fit", &loaded.fit_settings()?)?;
    output.settings("evaluate", &loaded.evaluation_settings()?)?;
    let mut proof = Proof::new(&baseline, &loaded.model, &judging);
    let blank = Proof::new(&baseline, &loaded.model, &judging);
    loaded.part(ranks, |_| true).each(
        "evaluating",
        |_| true,
        |windows| blank.part(&windows),
        |part| {
            proof.add(part);
            Ok(())
        },
    )?;
    let evaluation = proof.evaluation_over(ranks);
    if !evaluation.trajectories.iter().any(|t| t.split == Split::Test) {
        return Err(loaded.nothing(Split::Test));
    }
    let shown = if output.has_folder() { recorded(&loaded, &shown(&evaluation))? } else { Vec::new() };
    write(&mut output, &evaluation, [&baseline, &loaded.model], &shown, judging.integration)?;
    output.finish_long(&text(&loaded.study.name, &evaluation), &Document::from(&evaluation))?;
    Ok(Answer::Yes)
}

/// An evaluation as JSON that is written trajectory by trajectory; its members are in the order of their names.
#[derive(Serialize)]
struct Document<'a> {
    baseline: &'a str,
    fitted: &'a str,
    max_yaw_rate: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    outlying: Option<&'a Outlying>,
    resamples: usize,
    seed: u64,
    summaries: Each<'a, Summary>,
    trajectories: Each<'a, Comparison>,
    validity: Pruned<'a, Coverage>,
}

impl<'a> From<&'a Evaluation> for Document<'a> {
    fn from(e: &'a Evaluation) -> Self {
        let Evaluation { baseline, fitted, trajectories, summaries, outlying, validity, max_yaw_rate, resamples, seed } =
            e;
        Self {
            baseline,
            fitted,
            max_yaw_rate: *max_yaw_rate,
            outlying: outlying.as_ref(),
            resamples: *resamples,
            seed: *seed,
            summaries: Each(summaries),
            trajectories: Each(trajectories),
            validity: Pruned(validity),
        }
    }
}

/// How the models of a study are judged.
fn judging(loaded: &Loaded) -> Result<Judging, CliError> {
    Ok(Judging::new(&loaded.fit_settings()?, loaded.evaluation_settings()?))
}

/// The baseline: the file given, else that of the study, else the study's model.
pub fn baseline(loaded: &Loaded, given: Option<&PathBuf>) -> Result<Model, CliError> {
    loaded.other_model(&baseline_path(loaded, given)?)
}

/// The file of the baseline.
pub fn baseline_path(loaded: &Loaded, given: Option<&PathBuf>) -> Result<PathBuf, CliError> {
    let folder = loaded.study.path.parent().map(PathBuf::from).unwrap_or_default();
    let listed = loaded.evaluation_settings()?.baseline.map(|b| folder.join(b));
    Ok(given.cloned().or(listed).unwrap_or_else(|| loaded.study.model.clone()))
}

/// Judges a model with the settings of the study.
pub fn judge(loaded: &Loaded, baseline: &Model, model: &Model, windows: &[Run]) -> Result<Evaluation, CliError> {
    let judging = judging(loaded)?;
    let bar = progress(format!("evaluating {} windows", windows.len()));
    let evaluation = prove(baseline, model, windows, &judging);
    bar.finish_and_clear();
    Ok(evaluation)
}

/// Below this a deviation (in m, deg, m/s, deg/s or %) is rounding, and is printed as 0.
const ROUNDING: f64 = 1e-6;

fn ends(x: f64) -> String {
    sig_above(x, 3, ROUNDING)
}

fn number(e: Option<Estimate>, scale: f64) -> String {
    e.map_or_else(|| DASH.into(), |e| sig_above(e.value * scale, 3, ROUNDING))
}

fn with_interval(e: Option<Estimate>, scale: f64) -> String {
    let interval = e
        .and_then(|e| e.ci95)
        .map_or(String::new(), |[lo, hi]| format!(" [{}, {}]", ends(lo * scale), ends(hi * scale)));
    number(e, scale) + &interval
}

/// Degrees for heading and yaw rate.
fn dimension(i: usize) -> (f64, &'static str) {
    let units = ["m", "m", "deg", "m/s", "m/s", "deg/s"];
    (if i == 2 || i == 5 { 180.0 / std::f64::consts::PI } else { 1.0 }, units[i])
}

/// The evaluation as text.
pub fn text(study: &str, evaluation: &Evaluation) -> String {
    let Some(main) = evaluation.summaries.first() else {
        return format!("{study}: no trajectory to judge.");
    };
    let compared = main.md_baseline != main.md_fitted || main.cvdm_baseline != main.cvdm_fitted;
    let mut text = evaluation.outlying.as_ref().map_or(String::new(), Outlying::line);
    text += &if compared { comparison(study, evaluation, main) } else { deviations(study, &evaluation.fitted, main) };
    if let Some(w) = &main.worst {
        text += &format!("Worst run: {} ({}).\n", w.run, cvdm(&w.fitted));
    }
    for (name, count) in [(&evaluation.baseline, main.diverged_baseline), (&evaluation.fitted, main.diverged_fitted)] {
        if count > 0 {
            let left = "the means above leave these trajectories out";
            text += &format!("`{name}` diverged on {count} of {} trajectories; {left}.\n", main.trajectories);
        }
    }
    text += &format!("{}\n", evaluation.validity.line());
    if evaluation.summaries.len() > 1 {
        text += &format!("\n{}", groups(&evaluation.summaries, compared));
    }
    text
}

/// Which runs a summary is of, and how many.
fn counts(s: &Summary) -> String {
    format!("{} runs: {} runs, {} trajectories", s.group, s.runs, s.trajectories)
}

/// Two models beside each other.
fn comparison(study: &str, evaluation: &Evaluation, main: &Summary) -> String {
    let mut table = Table::new(["", "baseline", "fitted", "improvement [%]"]);
    for i in 0..STATE_NAMES.len() {
        let (scale, unit) = dimension(i);
        table.row([
            format!("MD {} [{unit}]", STATE_NAMES[i]),
            number(main.md_baseline[i], scale),
            number(main.md_fitted[i], scale),
            with_interval(main.md_improvement[i], 100.0),
        ]);
    }
    table.row([
        "cVDM [%]".to_owned(),
        with_interval(main.cvdm_baseline, 1.0),
        with_interval(main.cvdm_fitted, 1.0),
        with_interval(main.cvdm_improvement, 100.0),
    ]);
    table.row(["mARI".into(), String::new(), String::new(), with_interval(main.mari, 100.0)]);
    table.row(["consistency".into(), String::new(), String::new(), with_interval(main.consistency, 100.0)]);
    let (baseline, fitted) = (&evaluation.baseline, &evaluation.fitted);
    let mut text = format!("{study}: `{fitted}` against the baseline `{baseline}`, {}\n\n{table}\n\n", counts(main));
    text += &format!(
        "Better on {} of {} trajectories, worse on {}; better on {} of {} runs, worse on {}.\n",
        main.better, main.trajectories, main.worse, main.runs_better, main.runs, main.runs_worse
    );
    if let Some(w) = &main.most_worsened {
        text += &format!("Most worsened: {} ({} against {}).\n", w.run, cvdm(&w.fitted), cvdm(&w.baseline));
    }
    text
}

/// One model alone.
fn deviations(study: &str, fitted: &str, main: &Summary) -> String {
    let mut table = Table::new(["", "mean", "95 % interval"]);
    for i in 0..STATE_NAMES.len() {
        let (scale, unit) = dimension(i);
        table.row([
            format!("MD {} [{unit}]", STATE_NAMES[i]),
            number(main.md_fitted[i], scale),
            interval(main.md_fitted[i], scale),
        ]);
    }
    table.row(["cVDM [%]".to_owned(), number(main.cvdm_fitted, 1.0), interval(main.cvdm_fitted, 1.0)]);
    format!(
        "{study}: deviations of `{fitted}`, {}\n\n{table}\n\nGive --model or --baseline to compare two models.\n",
        counts(main)
    )
}

fn interval(e: Option<Estimate>, scale: f64) -> String {
    e.and_then(|e| e.ci95)
        .map_or_else(|| DASH.into(), |[lo, hi]| format!("[{}, {}]", ends(lo * scale), ends(hi * scale)))
}

fn cvdm(outcome: &Outcome) -> String {
    match outcome {
        Outcome::Simulated(d) => format!("cVDM {} %", sig(d.cvdm, 3)),
        Outcome::Diverged { diverged_after } => format!("diverged after {diverged_after:.0} s"),
    }
}

fn groups(summaries: &[Summary], compared: bool) -> Table {
    let mut table = if compared {
        Table::new([
            "group",
            "runs",
            "cVDM steady [%]",
            "cVDM baseline [%]",
            "cVDM fitted [%]",
            "improvement [%]",
            "mARI [%]",
            "better",
            "worse",
        ])
    } else {
        Table::new(["group", "runs", "cVDM steady [%]", "cVDM [%]"])
    };
    for s in summaries {
        let mut row = vec![s.group.clone(), s.runs.to_string(), number(s.cvdm_steady, 1.0)];
        if compared {
            row.push(number(s.cvdm_baseline, 1.0));
        }
        row.push(number(s.cvdm_fitted, 1.0));
        if compared {
            row.push(number(s.cvdm_improvement, 100.0));
            row.push(number(s.mari, 100.0));
            row.push(s.better.to_string());
            row.push(s.worse.to_string());
        }
        table.row(row);
    }
    table
}

/// Writes the files of an evaluation; among `windows` are those of the trajectories that are [`shown`].
pub fn write(
    output: &mut Output,
    evaluation: &Evaluation,
    models: [&Model; 2],
    windows: &[Run],
    integration: Integration,
) -> Result<(), CliError> {
    output.table("trajectories.csv", &trajectories(&evaluation.trajectories)?);
    output.table("summary.csv", &summary(&evaluation.summaries)?);
    let test: Vec<&Comparison> = evaluation.trajectories.iter().filter(|t| t.split == Split::Test).collect();
    if let Some(main) = evaluation.summaries.first() {
        output.figure("improvement", || improvement(main));
    }
    output.figure("cvdm", || cvdm_figure(&test));
    output.figure("tracks", || tracks(evaluation, models, windows, integration));
    Ok(())
}

fn trajectories(comparisons: &[Comparison]) -> Result<Vec<u8>, CliError> {
    let mut header: Vec<String> =
        ["run", "session", "manoeuvre", "split", "start_time [s]", "duration [s]", "model", "cvdm [%]"]
            .map(str::to_owned)
            .to_vec();
    header.extend((0..6).map(|i| format!("md_{} [{}]", STATE_NAMES[i], dimension(i).1)));
    header.push("diverged_after [s]".into());
    let rows =
        comparisons.iter().flat_map(|c| {
            [("steady", &c.steady), ("baseline", &c.baseline), ("fitted", &c.fitted)].map(|(which, outcome)| {
                let split = if c.split == Split::Test { "test" } else { "train" };
                let mut row = vec![c.run.clone(), c.session.clone(), c.manoeuvre.clone(), split.into()];
                row.extend([c.start_time.to_string(), c.duration.to_string(), which.into()]);
                let deviation = outcome.deviation();
                row.push(deviation.map_or(String::new(), |d| d.cvdm.to_string()));
                row.extend((0..6).map(|i| {
                    deviation.and_then(|d| d.md[i]).map_or(String::new(), |m| (m * dimension(i).0).to_string())
                }));
                row.push(match outcome {
                    Outcome::Diverged { diverged_after } => diverged_after.to_string(),
                    Outcome::Simulated(_) => String::new(),
                });
                row
            })
        });
    csv_text(&header.iter().map(String::as_str).collect::<Vec<_>>(), rows)
}

/// Factor from SI and unit of a mean deviation; improvements are shares.
fn unit_of(kind: &str, i: usize) -> (f64, &'static str) {
    if kind == "improvement" { (1.0, "-") } else { dimension(i) }
}

fn scaled(e: Estimate, scale: f64) -> Estimate {
    Estimate { value: e.value * scale, ci95: e.ci95.map(|ends| ends.map(|x| x * scale)) }
}

fn summary(summaries: &[Summary]) -> Result<Vec<u8>, CliError> {
    let header = ["group", "measure", "unit", "value", "low95", "high95"];
    let rows = summaries.iter().flat_map(|s| {
        let named = [
            ("cvdm_baseline", s.cvdm_baseline),
            ("cvdm_fitted", s.cvdm_fitted),
            ("cvdm_steady", s.cvdm_steady),
            ("cvdm_improvement", s.cvdm_improvement),
            ("mari", s.mari),
            ("consistency", s.consistency),
        ];
        let percent = |n: &str| (1.0, if n.starts_with("cvdm") && n != "cvdm_improvement" { "%" } else { "-" });
        let named = named.into_iter().map(|(n, e)| (n.to_owned(), percent(n), e));
        let kinds = [("baseline", &s.md_baseline), ("fitted", &s.md_fitted), ("improvement", &s.md_improvement)];
        let md = kinds.into_iter().flat_map(|(kind, md)| {
            (0..6).map(move |i| (format!("md_{}_{kind}", STATE_NAMES[i]), unit_of(kind, i), md[i]))
        });
        let estimates = named.chain(md).filter_map(|(name, (scale, unit), e)| Some((name, unit, scaled(e?, scale))));
        let rows = estimates.map(|(name, unit, e)| {
            let [lo, hi] = e.ci95.map_or([String::new(), String::new()], |ci| ci.map(|c| c.to_string()));
            [s.group.clone(), name, unit.into(), e.value.to_string(), lo, hi]
        });
        let counts = [("runs", s.runs), ("trajectories", s.trajectories), ("better", s.better), ("worse", s.worse)];
        let diverged = [("diverged_baseline", s.diverged_baseline), ("diverged_fitted", s.diverged_fitted)];
        let counts = counts.into_iter().chain(diverged);
        rows.chain(
            counts.map(|(n, v)| [s.group.clone(), n.into(), "-".into(), v.to_string(), String::new(), String::new()]),
        )
        .collect::<Vec<_>>()
    });
    csv_text(&header, rows)
}

/// Improvement of each dimension's MD, of cVDM and of mARI, with intervals.
fn improvement(s: &Summary) -> Figure {
    let names = STATE_NAMES.iter().map(|n| format!("MD {n}")).chain(["cVDM", "mARI", "consistency"].map(str::to_owned));
    let estimates = s.md_improvement.iter().copied().chain([s.cvdm_improvement, s.mari, s.consistency]);
    let bars = estimates.map(|e| {
        let value = e.map_or(f64::NAN, |e| 100.0 * e.value);
        let [lo, hi] = e.and_then(|e| e.ci95).map_or([value, value], |ci| ci.map(|c| 100.0 * c));
        (value, lo, hi)
    });
    let axis = Axis::categories("", names);
    let title = format!("Improvement on the baseline, {} runs (95 % intervals)", s.group);
    let caption = "Relative improvement on the baseline of the mean deviation (MD) of each dimension, of cVDM, of their mean over \
                   dimensions (mARI) and of the variance of cVDM (consistency), with 95 % intervals over runs.";
    Figure::new(title).panel_size(1200, 620).caption(caption).legend(trimtab::report::plot::Legend::Off).with(
        Panel::new("", axis, Axis::new("improvement [%]").including(0.0))
            .with(Layer::bars_with_intervals("improvement", FITTED, bars))
            .with(Layer::h_line("none", GREY, 0.0)),
    )
}

/// cVDM of each test trajectory under both models.
fn cvdm_figure(test: &[&Comparison]) -> Figure {
    let pairs = test.iter().filter_map(|c| Some((c.baseline.deviation()?.cvdm, c.fitted.deviation()?.cvdm)));
    let pairs: Vec<(f64, f64)> = pairs.collect();
    let largest = pairs.iter().map(|(a, b)| a.max(*b)).fold(1.0, f64::max) * 1.05;
    let panel = Panel::new(
        "",
        Axis::new("cVDM of the baseline [%]").range(0.0, largest),
        Axis::new("cVDM of the fitted model [%]").range(0.0, largest),
    );
    let caption = format!(
        "{} of {} test trajectories, those that both models simulate to their end. Below the line the fitted model is better.",
        pairs.len(),
        test.len()
    );
    Figure::new("cVDM of each test trajectory").panel_size(900, 860).caption(caption).with(
        panel.with(Layer::line("equal", GREY, [(0.0, 0.0), (largest, largest)]).dashed()).with(Layer::scatter(
            "trajectory (below the line: better)",
            FITTED,
            pairs,
        )),
    )
}

/// The test trajectories of which tracks are drawn: best, median and worst of the fitted model.
fn shown(evaluation: &Evaluation) -> Vec<(&'static str, &Comparison)> {
    let mut order: Vec<&Comparison> = evaluation.trajectories.iter().filter(|t| t.split == Split::Test).collect();
    let size = |t: &Comparison| t.fitted.deviation().map_or(f64::INFINITY, |d| d.cvdm);
    order.sort_by(|a, b| size(a).total_cmp(&size(b)));
    let named = [("best", order.first()), ("median", order.get(order.len() / 2)), ("worst", order.last())];
    let mut shown: Vec<(&str, &Comparison)> = named.iter().filter_map(|(n, t)| Some((*n, **(t.as_ref()?)))).collect();
    shown.dedup_by(|a, b| std::ptr::eq(a.1, b.1));
    shown
}

/// Whether a trajectory is of a window.
fn is_of(t: &Comparison, w: &Run) -> bool {
    t.run == w.recording && t.start_time == w.start_time()
}

/// The windows of some trajectories, read again.
fn recorded(loaded: &Loaded, shown: &[(&str, &Comparison)]) -> Result<Vec<Run>, CliError> {
    let mut found = Vec::new();
    let drawn = |w: &Run| shown.iter().any(|(_, t)| is_of(t, w));
    loaded.each(
        "reading",
        |listed| shown.iter().any(|(_, t)| t.run == listed.labels.run),
        |windows| windows.into_iter().filter(drawn).collect::<Vec<Run>>(),
        |some| {
            found.extend(some);
            Ok(())
        },
    )?;
    Ok(found)
}

/// Tracks of the trajectories that are [`shown`], recorded and under both models.
fn tracks(evaluation: &Evaluation, models: [&Model; 2], windows: &[Run], integration: Integration) -> Figure {
    let all = evaluation.trajectories.iter().filter(|t| t.split == Split::Test).count();
    let drawn = shown(evaluation).len();
    let caption = format!(
        "{drawn} of {all} test trajectories: those with the smallest, the median and the largest cVDM of the fitted model. Tracks with ship \
         outlines above, heading below; both models begin at the first recorded state."
    );
    let mut figure =
        Figure::new("Test runs: recorded, baseline and fitted").columns(3).panel_size(680, 600).caption(caption);
    let ship = &models[0].ship;
    let mut below = Vec::new();
    for (word, trajectory) in shown(evaluation) {
        let Some(w) = windows.iter().find(|w| is_of(trajectory, w)) else { continue };
        let shown = [
            ("recorded", RECORDED, w.measured.iter().map(or_nan).collect()),
            ("baseline", BASELINE, predict(models[0], w, integration).states),
            ("fitted", FITTED, predict(models[1], w, integration).states),
        ];
        let mut track = Panel::track(format!("{word}: {}, {}", w.recording, cvdm(&trajectory.fitted)));
        let mut heading = Panel::new("", Axis::new("time [s]"), Axis::new("heading psi [deg]").angle());
        // Headings of a long log are unwrapped: whole turns before this run say nothing of it.
        let turns = (w.initial[2].to_degrees() / 360.0).floor() * 360.0;
        for (name, color, states) in shown {
            let stride = (states.len() / 6).max(1);
            let poses = states.iter().step_by(stride).map(|s| [s[0], s[1], s[2]]).collect::<Vec<_>>();
            // Distinguished without colours too.
            let styled = |line: Layer| if name == "baseline" { line.dashed() } else { line };
            track = track
                .with(styled(Layer::line(name, color, states.iter().map(|s| east_north(s[0], s[1])))))
                .with(Layer::hulls(name, color, poses, ship.hull.lpp, ship.hull.breadth).unlisted().width(1.5));
            let psi = states.iter().enumerate().map(|(k, s)| (k as f64 * w.dt, s[2].to_degrees() - turns));
            heading = heading.with(styled(Layer::line(name, color, psi)));
        }
        figure = figure.with(track);
        below.push(heading);
    }
    let columns = below.len().max(1);
    figure.columns(columns).with_all(below)
}
