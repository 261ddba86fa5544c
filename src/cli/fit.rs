//! `trimtab fit`: fits the free parameters of a study's model to its training runs, and reports estimates with intervals.
//! The library makes the fit and its report; this file calls it, shows progress and writes files.

use super::shared::answer::Answer;
use super::shared::audited::{AcceptArgs, audited_over};
use super::shared::error::CliError;
use super::shared::figures::FigureArgs;
use super::shared::load::{Loaded, StudyArgs};
use super::shared::output::{Output, OutputArgs, csv_text};
use super::shared::progress::progress;
use std::collections::BTreeMap;
use trimtab::files::ranks::Ranks;
use trimtab::files::{Kept, seal};
use trimtab::fit::{Fit, FitSettings, Goal, MultiStart, StartRow, fit_over, multi_start_over};
use trimtab::model::{Model, ModelFile};
use trimtab::numbers::numerals::sig;
use trimtab::numbers::uncertainty::Uncertainty;
use trimtab::recording::{Run, RunStore, Runs, Split};
use trimtab::report::plot::{Axis, Color, FITTED, Figure, GREY, LIMIT, Layer, Panel};
use trimtab::report::{USUAL, at_width};
use trimtab::terms::hydrodynamics::resistance::Resistance;
use trimtab::terms::steering::rudder::Rudder;

const LONG: &str = "\
Fits the free parameters of the model to the training runs of the study with exact gradients, under the constraints of \
    [fit.constraints]. With `objective = \"trajectory\"` in [fit] it minimises the weighted squares between simulation and recording, as the \
    paper does; with `\"likelihood\"`, as `trimtab import` and `trimtab demo` write, it maximises the likelihood of recordings with sensor noise \
    under an unknown force, and estimates the coefficients of hull, propeller and rudder along, by their spreads. Which parameters are free, their bounds and \
    priors are in the model file; without any setting they are the paper's eleven (p0 to p10). There, `hull = \"free\"` at the top, \
    or --free-hull here, frees every hydrodynamic coefficient of the hull, and `prior = \"default\"` in [parameters.\"NAME\"], \
    or --free NAME, frees one: each with its \
    estimate as mean and the spread that its term knows (`trimtab terms`) as standard deviation.

Every fit is solved by Ipopt. It returns the best feasible point of all that it evaluated, never one above a feasible start, and says what \
    stopped the solver: max_iterations, max_evaluations and max_seconds of [fit] always limit it. It is called converged only after a second solve from \
    a disturbed point found no lower cost. Damping, added mass, thrust and drag keep their physical signs (the bounds of each term), and the mass matrix stays \
    invertible. Its first line says what the residuals say against it: a cost far above the noise of the sensors, windows \
    too long to be predicted in open loop, a recording or an input apart from the others.

The report gives every estimate with standard error and 95 % interval, the active constraints, what the \
    data do not determine, and how the solver ended.";

const AFTER: &str = "\
Example:
  trimtab fit study.toml --out results
  trimtab evaluate study.toml --model results/fitted.toml
  trimtab fit study.toml --free-hull --free wake_drift,flow.asymmetry --out freed
  trimtab compare study.toml results/fitted.toml freed/fitted.toml

With --out: fitted.toml (a model file with the estimates and their covariance, which every command takes as --model), fit.json, fit.txt (the \
    report), parameters.csv, curves.png and .csv (R(u), c_L, c_D at start and end); with --starts also starts.csv (how each start \
    ended). While the fit runs, best.toml is the model at the best point so far; it is removed at the end. \
    With --starts a fit that was killed goes on with the starts that are left when it is repeated on the same input.
JSON: recordings.doubts[] (severity, fault, channel, text, next_step, runs, accepted): what the audit of the recordings found; \
    result.converged, result.headline, result.status, result.solver_status (of Ipopt), result.hessian, result.checks (second solves, and how many found a lower cost), result.likelihood (start_log_posterior, log_posterior, noise, rounds; with objective = \"likelihood\" alone), result.doubts[] (kind: backwards, input, apart, model-error, windows-too-long or clustered; \
    value, limit, sentence), result.input_error (input, kind, name, is_session, value, p; where one recording or session has another gain or zero), \
    result.seen_inputs[] (input, kind, smallest: from which size on such an error would be reported, a share or rad), \
    result.residual_statistics (model_error, middle, apart, growth, growth_error, likeness), result.estimates[] \
    (name, symbol, unit, start, value, standard_error, interval, at_bound), result.start_cost, result.start_prior_cost, \
    result.cost, result.prior_cost, result.first_stage_parts, result.residual_variance, result.active[] (sentence, rule), \
    result.undetermined[] (words, standard_deviation), result.covariance (that of the standard errors), result.freedom (its degrees of freedom), \
    result.covariance_gauss_newton, result.covariance_sandwich, result.correlations (rows of numbers in the order of the estimates, null where the data do not determine a parameter), \
    result.validity (share_outside of the samples; outside[] with term, quantity, range, share, met: where the data leave the \
    range over which a term is valid), result.runs, result.recordings, result.residuals, result.iterations, result.counts, result.settings.

Exit code 1 if the fit did not converge; its result is written all the same.";

/// Fits the model of a study to its training runs
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// Fit from this many starts drawn around the model's values first, and then from the best of their ends.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    starts: Option<u16>,
    /// Frees every hydrodynamic coefficient of the hull around its estimate, as `hull = "free"` in the model file does.
    #[arg(long)]
    free_hull: bool,
    /// Frees this parameter (`flow.asymmetry`) or all of this term (`wake_drift`), which is added where the model lacks it, as
    /// `prior = "default"` in the model file does; several with commas between.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    free: Vec<String>,
    #[command(flatten)]
    accept: AcceptArgs,
    #[command(flatten)]
    figures: FigureArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// Runs the command.
pub fn run(args: &Args, ranks: &Ranks) -> Result<Answer, CliError> {
    let mut output = Output::of_rank(ranks, "fit", &args.output)?.drawn_as(&args.figures);
    let mut loaded = Loaded::new(&args.study)?;
    if args.free_hull {
        loaded.model.free_hull();
    }
    for name in &args.free {
        loaded.model.release(name).map_err(|error| CliError::Model { path: None, error })?;
    }
    output.reads(&loaded, true);
    output.settings("fit", &loaded.fit_settings()?)?;
    output.recordings(audited_over(ranks, &loaded, &args.accept)?);
    let (start, starts) = match args.starts {
        Some(count) => from_many(ranks, &loaded, count.into(), &mut output)?,
        None => (loaded.model.clone(), String::new()),
    };
    let store = stored(ranks, &loaded)?;
    let windows = Runs::from(&store);
    if ranks.is_first() {
        loaded.compare_yaw_rates(windows);
    }
    let fit = fit_windows(ranks, &loaded, &start, windows, output.kept(BEST));
    if let Some(source) = store.failure() {
        return Err(CliError::Write { path: std::env::temp_dir(), source });
    }
    let fit = fit?;
    write(&mut output, &start, &fit, speeds(ranks, windows))?;
    let mut text = fit.report() + &format!("\nTime taken: {:.2} s\n", fit.seconds) + &starts;
    if !output.has_folder() {
        text += "\nGive --out DIR to keep the fitted model as a file.";
    }
    output.finish(&text, &fit)?;
    Ok(if fit.converged { Answer::Yes } else { Answer::No })
}

/// The windows to train on that are this rank's, in memory or in a temporary file. One of several ranks opens no other recording.
fn stored(ranks: &Ranks, loaded: &Loaded) -> Result<RunStore, CliError> {
    let mut store = RunStore::default();
    let fail = |source| CliError::Write { path: std::env::temp_dir(), source };
    let train = |windows: Vec<Run>| windows.into_iter().filter(|w| w.split == Split::Train).collect::<Vec<Run>>();
    loaded.part(ranks, |run| ranks.size() == 1 || run.labels.split == Split::Train).each(
        "reading",
        |_| true,
        train,
        |windows| windows.into_iter().try_for_each(|window| store.push(window)).map_err(fail),
    )?;
    if ranks.counts([store.len()]) == [0] { Err(loaded.nothing(Split::Train)) } else { Ok(store) }
}

/// Share of the lowest cost, and units of log-likelihood below the highest log-posterior, within which starts ended at the same place.
const SAME_PLACE: f64 = 1e-4;
const SAME_LIKELIHOOD: f64 = 0.5;

/// What a fit adds to the name of its model.
const FITTED_NAME: &str = ", fitted";

/// File of the best point so far, while a fit runs.
const BEST: &str = "best.toml";

/// Fits a model to the windows of all ranks with the settings of the study. While it runs, `kept` is a model file of the best
/// point so far.
pub fn fit_windows(
    ranks: &Ranks,
    loaded: &Loaded,
    start: &Model,
    windows: Runs,
    kept: Option<Kept>,
) -> Result<Fit, CliError> {
    let settings: FitSettings = loaded.fit_settings()?;
    let bar = progress(format!("fitting to {} windows", windows.len()));
    let mut last: Vec<f64> = Vec::new();
    let result = fit_over(ranks, start, windows, &settings, &mut |p| {
        bar.set_message(format!("fitting: iteration {}, cost {:.5}", p.iteration, p.cost));
        if let (Some(kept), Some(best)) = (&kept, p.best.filter(|best| *best != last)) {
            last = best.to_vec();
            // A fit does not end because a copy of its best point cannot be written.
            let _ = keep(kept, start, best);
        }
        true
    });
    bar.finish_and_clear();
    if let Some(kept) = &kept {
        kept.remove();
    }
    let mut fit = result.map_err(|error| loaded.of_fit(error))?;
    if !start.name.ends_with(FITTED_NAME) {
        fit.model.name += FITTED_NAME;
    }
    Ok(fit)
}

/// Writes a model file with the free parameters at `best`, whole or not at all.
fn keep(kept: &Kept, start: &Model, best: &[f64]) -> Result<(), CliError> {
    let mut model = start.clone();
    for (i, value) in start.free().into_iter().zip(best) {
        model.parameters[i].value = *value;
    }
    kept.write(model_text(&model)?.as_bytes()).map_err(|source| CliError::Write { path: BEST.into(), source })
}

/// Fits from many starts, dealt out to the ranks, and writes how each ended: the model at the best end, and what to say of it.
fn from_many(ranks: &Ranks, loaded: &Loaded, count: usize, output: &mut Output) -> Result<(Model, String), CliError> {
    let windows = loaded.windows_of(Split::Train)?;
    let starts = MultiStart { count, ..MultiStart::default() };
    let bar = progress(format!("fitting from {count} starts"));
    let (mut log, known) = output.log::<(usize, StartRow)>("starts")?.unzip();
    let known: BTreeMap<usize, StartRow> = known.into_iter().flatten().collect();
    let mut done = known.len();
    let ended = |start: usize, row: &StartRow| {
        done += 1;
        bar.part(format!("fitting from {count} starts: {done} done"), done, count);
        if let Some(log) = &mut log {
            // A fit does not end because its parts cannot be kept.
            let _ = log.append(&(start, row));
        }
    };
    let settings = loaded.fit_settings()?;
    let by_likelihood = settings.objective == Goal::Likelihood;
    let rows = multi_start_over(ranks, &loaded.model, &windows, &settings, &starts, &known, ended);
    bar.finish_and_clear();
    if let Some(log) = log {
        output.done_with(log);
    }
    let mut model = loaded.model.clone();
    let free = model.free();
    let names = free.iter().map(|i| model.parameters[*i].name.clone());
    let (from, to): (Vec<String>, Vec<String>) = names.map(|n| (format!("start {n}"), format!("end {n}"))).unzip();
    let minimised = if by_likelihood { "minus log-posterior" } else { "cost" };
    let header = ["start", "converged", minimised, "iterations", "ended"].into_iter();
    let header: Vec<&str> = header.chain(from.iter().chain(&to).map(String::as_str)).collect();
    let fields = |(i, row): (usize, &StartRow)| {
        let cost = row.cost.map_or(String::new(), |c| c.to_string());
        let first = [i.to_string(), row.converged.to_string(), cost, row.iterations.to_string(), row.ended.clone()];
        let ends = (0..free.len()).map(|j| row.end.get(j).map_or(String::new(), f64::to_string));
        first.into_iter().chain(row.start.iter().map(f64::to_string)).chain(ends).collect::<Vec<String>>()
    };
    output.table("starts.csv", &csv_text(&header, rows.iter().enumerate().map(fields))?);
    let converged: Vec<&StartRow> = rows.iter().filter(|row| row.converged).collect();
    let best = converged.iter().min_by(|a, b| a.cost.unwrap_or(f64::NAN).total_cmp(&b.cost.unwrap_or(f64::NAN)));
    let Some((best, cost)) = best.and_then(|row| Some((row, row.cost?))) else {
        return Ok((
            model,
            format!("\n\nStarts: none of {count} converged; the fit is from the model's own values.\n"),
        ));
    };
    for (i, value) in free.iter().zip(&best.end) {
        model.parameters[*i].value = *value;
    }
    let (reach, place) = if by_likelihood {
        (SAME_LIKELIHOOD, format!("the highest log-posterior {}", sig(-cost, 6)))
    } else {
        (SAME_PLACE * cost, format!("the lowest cost {}", sig(cost, 4)))
    };
    let same = converged.iter().filter(|row| row.cost.is_some_and(|c| c <= cost + reach)).count();
    let said = format!(
        "\n\nStarts: {} of {count} converged, {same} of them at {place}; the fit is from there.\n",
        converged.len()
    );
    Ok((model, said))
}

/// The recorded range of surge speed \[m/s\] over all ranks, at least 0 to 1.
pub fn speeds(ranks: &Ranks, windows: Runs) -> [f64; 2] {
    let [slowest, fastest] = windows.iter().fold([0.0_f64, 1.0_f64], |range, w| {
        w.measured.iter().filter_map(|s| s[3]).fold(range, |[a, b], u| [a.min(u), b.max(u)])
    });
    let ends = ranks.largest(&[-slowest, fastest]);
    [-ends[0], ends[1]]
}

/// Writes the files of a fit.
pub fn write(output: &mut Output, start: &Model, fit: &Fit, speeds: [f64; 2]) -> Result<(), CliError> {
    output.file("fitted.toml", fitted_text(&fit.model, fit.uncertainty())?.as_bytes());
    // A file does not depend on the terminal it was made at.
    output.file("fit.txt", at_width(USUAL, || fit.report()).as_bytes());
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let rows = fit.reported().into_iter().map(|e| {
        let [low, high] = e.interval.map_or([None, None], |i| i.map(Some));
        [
            e.name.clone(),
            e.symbol.into(),
            e.unit.into(),
            e.start.to_string(),
            e.value.to_string(),
            number(e.standard_error),
            number(low),
            number(high),
            e.at_bound.unwrap_or_default().to_owned(),
        ]
    });
    let header = ["parameter", "symbol", "unit", "start", "estimate", "standard_error", "low95", "high95", "at_bound"];
    output.table("parameters.csv", &csv_text(&header, rows)?);
    output.figure("curves", || curves(&[("start", GREY, start), ("fitted", FITTED, &fit.model)], speeds));
    Ok(())
}

/// A model as the text of a model file, with a checksum at its end.
pub fn model_text(model: &Model) -> Result<String, CliError> {
    fitted_text(model, None)
}

/// As [`model_text`], with the covariance of the estimates.
pub fn fitted_text(model: &Model, covariance: Option<Uncertainty>) -> Result<String, CliError> {
    let file = ModelFile { covariance, ..model.to_file() };
    let text = toml::to_string(&file).map_err(|e| CliError::Format { format: "TOML", message: e.to_string() })?;
    Ok(seal("use it with --model.", &text))
}

/// R(u) over the recorded speeds, c_L and c_D over the angles of attack at which the curves are valid.
pub fn curves(models: &[(&str, Color, &Model)], [low, high]: [f64; 2]) -> Figure {
    let over = |from: f64, to: f64| (0..=120).map(move |i| from + (to - from) * f64::from(i) / 120.0);
    let layers = |f: &dyn Fn(&Model) -> Vec<(f64, f64)>| {
        let line = |(name, color, model): &(&str, Color, &Model)| {
            let line = Layer::line(*name, *color, f(model));
            if *color == FITTED { line } else { line.dashed() }
        };
        models.iter().map(line).collect::<Vec<_>>()
    };
    let resistance = |m: &Model| {
        let theta = m.values();
        over(low, high).map(|u| (u, Resistance::curve(m.part("resistance", &theta), u) * 1e-3)).collect()
    };
    let rudder = |m: &Model, curve: fn(&[f64], f64) -> f64| {
        let theta = m.values();
        let p = m.part("rudder", &theta).to_vec();
        over(-45.0, 45.0).map(|a| (a, curve(&p, a.to_radians()))).collect()
    };
    let panel = |x: &str, y: &str| Panel::new("", Axis::new(x), Axis::new(y));
    let limit = |y: f64| Layer::h_line("constraint", LIMIT, y).dotted();
    Figure::new("Curves of the model")
        .columns(3)
        .panel_size(720, 560)
        .caption(
            "Resistance R(u) over the recorded speeds, and lift and drag coefficients c_L and c_D of the rudder over the angles of attack \
             at which the curves are valid; dotted: the limits that the fit keeps to.",
        )
        .with(panel("surge velocity u [m/s]", "resistance R [kN]").with_all(layers(&resistance)))
        .with(
            panel("angle of attack [deg]", "lift coefficient c_L [-]")
                .with_all(layers(&|m| rudder(m, Rudder::lift_polynomial::<f64>)))
                .with_all([limit(1.0), limit(-1.0).unlisted()]),
        )
        .with(
            panel("angle of attack [deg]", "drag coefficient c_D [-]")
                .with_all(layers(&|m| rudder(m, Rudder::drag_polynomial::<f64>)))
                .with(limit(0.0)),
        )
}
