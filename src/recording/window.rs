//! From a recording to windows: runs on a uniform grid, ready to be simulated, that never reach across a dropout or a gap.
//! Which windows train and which test is decided by the study.

use super::channel::{Channel, STATE_CHANNELS};
use super::convert::to_earth;
use super::driven::Driven;
use super::error::RecordingError;
use super::local::local_fit;
use super::record::Recording;
use super::run::{Measured, Run, Split};
use crate::numerals::sig;
use crate::state::{Inputs, STATES};
use crate::statistics::mean;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// What a study says about a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Labels {
    /// Name of the run.
    pub run: String,
    /// Session (a day, a voyage): what may share a hidden condition.
    pub session: String,
    /// Kind of manoeuvre.
    pub manoeuvre: String,
    /// Train or test.
    pub split: Split,
}

/// What to do with a run that has missing values or jumps in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Gaps {
    /// Refuse it with one error that names the lines.
    #[default]
    Refuse,
    /// Cut it there and use the unbroken stretches.
    Split,
}

/// Where a window's initial state comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Initial {
    /// The first sample as measured. Channels that were not measured are estimated as in `Smoothed`, over ten rows.
    First,
    /// A local motion fitted to all state channels over `span` seconds: uniform acceleration in u, v and r, with x, y and psi
    /// their integrals, each channel weighted by its own scatter.
    Smoothed {
        /// Length of the fit \[s\], centred on the start where the recording allows it.
        span: f64,
    },
}

/// How recordings are cut into windows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WindowSettings {
    /// Grid step \[s\]; the recording's own when absent.
    ///
    /// At the recording's own step samples are used as they are. A finer grid interpolates linearly. On a coarser one each
    /// sample is the mean over one step centred on it, of inputs and measured states alike, so that both keep the same timing;
    /// the grid then starts half a step inside the stretch.
    pub step: Option<f64>,
    /// Window length \[s\]; each unbroken stretch is one window when absent.
    pub window: Option<f64>,
    /// Overlap of consecutive windows \[s\].
    pub overlap: f64,
    /// Time left out at the start of each run \[s\].
    pub discard_start: f64,
    /// Time left out at the end of each run \[s\].
    pub discard_end: f64,
    /// First time used, in the recording's time \[s\].
    pub from: Option<f64>,
    /// Last time used \[s\].
    pub to: Option<f64>,
    /// Initial state.
    pub initial: Initial,
    /// Missing values and gaps.
    pub gaps: Gaps,
    /// The ship's draught \[m\], which turns depth into d/h.
    pub draught: f64,
    /// What drives the craft.
    pub driven: Driven,
}

impl WindowSettings {
    /// The whole run at its own step, started from its first row.
    pub fn whole(draught: f64) -> Self {
        Self {
            step: None,
            window: None,
            overlap: 0.0,
            discard_start: 0.0,
            discard_end: 0.0,
            from: None,
            to: None,
            initial: Initial::First,
            gaps: Gaps::Refuse,
            draught,
            driven: Driven::default(),
        }
    }
}

/// An unbroken stretch too short for a window.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Skipped {
    /// Name of the run.
    pub run: String,
    /// First line.
    pub first_line: usize,
    /// Last line.
    pub last_line: usize,
    /// Length \[s\].
    pub length: f64,
}

/// The windows of a run and what was left over.
#[derive(Clone, Debug, Default)]
pub struct Windows {
    /// In order of time.
    pub windows: Vec<Run>,
    /// Stretches too short for one.
    pub skipped: Vec<Skipped>,
}

/// Steps a window must have to say anything of a motion.
const MIN_STEPS: usize = 2;
/// A grid may divide the recording's own step into so many parts: a finer one adds no information and needs more memory.
const FINEST: f64 = 1000.0;
/// Relative difference below which two steps are the same.
const SAME_STEP: f64 = 1e-6;

impl Recording {
    /// Cuts the recording into windows.
    ///
    /// # Errors
    /// [`RecordingError`]: an interruption where `gaps` refuses one, a missing channel, a setting that cannot be, or no stretch
    /// as long as a window.
    pub fn windows(&self, labels: &Labels, settings: &WindowSettings) -> Result<Windows, RecordingError> {
        if let (Gaps::Refuse, Some(error)) = (settings.gaps, self.interruption()) {
            return Err(error);
        }
        let columns = self.columns(settings)?;
        let grid = self.grid(settings)?;
        let t = self.time();
        let (first, last) = (t.first().copied().unwrap_or(0.0), t.last().copied().unwrap_or(0.0));
        let begin = (first + settings.discard_start).max(settings.from.unwrap_or(f64::MIN));
        let end = (last - settings.discard_end).min(settings.to.unwrap_or(f64::MAX));

        if begin >= end {
            return Err(self.nothing_left(settings, first, last));
        }
        let mut result = Windows::default();
        let mut longest: Option<(f64, usize)> = None;
        for segment in self.segments() {
            let sampler = Sampler::new(t, segment.clone(), &grid, begin, end);
            let needed = grid.window.unwrap_or(MIN_STEPS);
            if sampler.steps < needed {
                let length = sampler.steps as f64 * grid.step;
                let line = self.line(segment.start);
                if longest.is_none_or(|(l, _)| length > l) {
                    longest = Some((length, line));
                }
                let (run, last_line) = (labels.run.clone(), self.line(segment.end - 1));
                result.skipped.push(Skipped { run, first_line: line, last_line, length });
                continue;
            }
            let length = grid.window.unwrap_or(sampler.steps);
            let stride = length - grid.overlap;
            let mut start = 0;
            while start + length <= sampler.steps {
                let samples = start..start + length + 1;
                result.windows.push(self.window(labels, settings, &grid, &columns, &sampler, samples)?);
                start += stride;
            }
        }
        if result.windows.is_empty() {
            let (have, line) = longest.unwrap_or((0.0, self.line(0)));
            let need = grid.window.unwrap_or(MIN_STEPS) as f64 * grid.step;
            let (least, key) = if grid.window.is_some() { ("a window of", "window") } else { ("two steps,", "step") };
            return Err(RecordingError::TooShort { path: self.path.clone(), line, have, need, least, key });
        }
        Ok(result)
    }

    /// The error of a run of which `from`, `to` and what is discarded leave nothing.
    fn nothing_left(&self, settings: &WindowSettings, first: f64, last: f64) -> RecordingError {
        let given = [
            ("from", settings.from),
            ("to", settings.to),
            ("discard_start", Some(settings.discard_start).filter(|t| *t > 0.0)),
            ("discard_end", Some(settings.discard_end).filter(|t| *t > 0.0)),
        ];
        let given = given.into_iter().filter_map(|(key, value)| Some(format!("`{key}` = {} s", value?)));
        let given = given.collect::<Vec<_>>().join(", ");
        let message = format!(
            "the recording lasts from {first} s to {last} s, of which {given} {} nothing; correct the times in the study",
            if given.contains(", ") { "leave" } else { "leaves" }
        );
        RecordingError::Setting { path: self.path.clone(), message }
    }

    /// One window: samples `samples` of the sampler's grid.
    fn window(
        &self,
        labels: &Labels,
        settings: &WindowSettings,
        grid: &Grid,
        columns: &Inputs<Vec<f64>>,
        sampler: &Sampler,
        samples: Range<usize>,
    ) -> Result<Run, RecordingError> {
        let take = |values: &[f64]| samples.clone().map(|k| sampler.sample(values, k)).collect::<Vec<f64>>();
        let measured_columns = STATE_CHANNELS.map(|c| self.get(c).map(take));
        let rows = samples.len();
        let value = |k: usize, i: usize| Some(measured_columns[i].as_ref()?[k]).filter(|v| v.is_finite());
        let measured: Vec<Measured> = (0..rows).map(|k| std::array::from_fn(|i| value(k, i))).collect();
        let start_time = sampler.time(samples.start);
        let taken: Inputs<Vec<f64>> =
            Inputs::from_entries(|entry: fn(&Inputs<Vec<f64>>) -> &Vec<f64>| match &entry(columns)[..] {
                [] => vec![0.0; rows],
                values => take(values),
            });
        let inputs = (0..rows).map(|k| Inputs {
            t: sampler.time(samples.start + k),
            ..Inputs::from_entries(|entry: fn(&Inputs<Vec<f64>>) -> &Vec<f64>| entry(&taken)[k])
        });
        let first = measured[0];
        let mut run = Run {
            name: format!("{} {} s", labels.run, thousandths(start_time)),
            recording: labels.run.clone(),
            session: labels.session.clone(),
            manoeuvre: labels.manoeuvre.clone(),
            split: labels.split,
            dt: sampler.step,
            recorded_dt: grid.usual,
            inputs: inputs.collect(),
            initial: first.map(|v| v.unwrap_or(0.0)),
            measured,
            disturbed: Vec::new(),
            // Made of a log through the water and a recorded current, a velocity is an observation.
            derived: std::array::from_fn(|i| {
                let logged = [(Channel::U, Channel::UWater), (Channel::V, Channel::VWater)];
                let by_log = |(own, log): &(Channel, Channel)| *own == STATE_CHANNELS[i] && self.has(*log);
                self.derived().contains(&STATE_CHANNELS[i]) && !logged.iter().any(by_log)
            }),
        };
        let (span, all) = match settings.initial {
            Initial::First => (10.0 * grid.usual, false),
            Initial::Smoothed { span } => (span, true),
        };
        if all || first.contains(&None) {
            let estimate = self.local_motion(&sampler.segment, start_time, span);
            let estimate = estimate.ok_or_else(|| RecordingError::Setting {
                path: self.path.clone(),
                message: format!(
                    "`initial_span` = {span} s covers fewer than three rows at {start_time:.2} s; set it to several steps of {:.3} s",
                    grid.usual
                ),
            })?;
            for i in 0..STATES {
                if all || first[i].is_none() {
                    run.initial[i] = estimate[i];
                }
            }
        }
        Ok(run)
    }

    /// The grid: step, window and overlap in steps.
    fn grid(&self, settings: &WindowSettings) -> Result<Grid, RecordingError> {
        let fail = |message: String| RecordingError::Setting { path: self.path.clone(), message };
        let t = self.time();
        let median = self.step();
        // Over an unbroken regular run the mean step is the median without its rounding.
        let mean = self.duration() / (self.len().max(2) - 1) as f64;
        let regular = t.iter().enumerate().all(|(i, ti)| (ti - t[0] - i as f64 * mean).abs() < 1e-3 * mean);
        let own = (if regular { mean } else { median } * 1e9).round() / 1e9;
        let step = settings.step.unwrap_or(own);
        let times = [("step", step), ("window", settings.window.unwrap_or(1.0))];
        if let Some((key, value)) = times.into_iter().find(|(_, v)| !v.is_finite() || *v <= 0.0) {
            return Err(fail(format!("`{key}` = {value} s is not a positive time; correct it in the study")));
        }
        if self.len() > 1 && step * MIN_STEPS as f64 > self.duration() * (1.0 + SAME_STEP) {
            let duration = self.duration();
            let text = format!(
                "`step` = {step} s is too long for a recording of {duration} s with a step of {own} s; leave it out, or shorten it"
            );
            return Err(fail(text));
        }
        if step * FINEST < own {
            let text = format!(
                "`step` = {} s is less than a {FINEST}th of the recording's own step of {own} s; leave it out, or set it to that step or more",
                sig(step, 3)
            );
            return Err(fail(text));
        }
        let window = settings.window.map(|w| (w / step).round() as usize);
        if let Some(short) = window.filter(|&w| w < MIN_STEPS) {
            let text = format!(
                "`window` = {} s is {short} steps of {step} s, too short; set it to {MIN_STEPS} steps or more, {} s",
                settings.window.unwrap_or_default(),
                MIN_STEPS as f64 * step
            );
            return Err(fail(text));
        }
        let overlap = (settings.overlap / step).round() as usize;
        if settings.overlap < 0.0 || window.is_some_and(|w| overlap >= w) {
            let text =
                format!("`window_overlap` = {} s must be shorter than `window` and not negative", settings.overlap);
            return Err(fail(text));
        }
        let as_recorded = (step / own - 1.0).abs() < SAME_STEP;
        let width = if step > own * (1.0 + SAME_STEP) { step } else { 0.0 };
        Ok(Grid { usual: median, step, window, overlap, as_recorded, width })
    }

    /// Inputs at every row, by column; a column that is 0 throughout is empty, and so is time, for it is that of a window's own grid.
    fn columns(&self, settings: &WindowSettings) -> Result<Inputs<Vec<f64>>, RecordingError> {
        let need = |c, next: &str| self.require(c, "to simulate the run", next);
        let from_position = "record it, or derive it from position and heading with `derive` in a column map";
        let positions = self.has(Channel::X) && self.has(Channel::Y) && self.has(Channel::Psi);
        if !positions {
            need(Channel::U, from_position)?;
            need(Channel::V, from_position)?;
        }
        if !self.has(Channel::Psi) {
            need(Channel::R, "record it or the heading")?;
        }
        // What was ordered stands for a rate or an angle that was not fed back.
        let fed_back = |c: Channel| c.ordered().filter(|ordered| !self.has(c) && self.has(*ordered)).unwrap_or(c);
        for channel in settings.driven.needs() {
            need(fed_back(channel), "add the column")?;
        }
        let mut inputs = Inputs::from_entries(|_: fn(&Inputs<f64>) -> &f64| Vec::new());
        for (name, values) in inputs.recorded() {
            if let Some(recorded) = Channel::from_name(name).and_then(|c| self.get(c)) {
                *values = recorded.to_vec();
            }
        }
        for (values, channel) in inputs.commands.iter_mut().zip(&settings.driven.commands) {
            *values = need(fed_back(*channel), "add the column")?.to_vec();
        }
        let mut directed = false;
        let mut put = |vectors: &mut [Vec<f64>; 2], values: Vec<[f64; 2]>| {
            directed = true;
            *vectors = <[Vec<f64>; 2]>::from(values.into_iter().map(|v| (v[0], v[1])).unzip());
        };
        if let Some((speed, from)) = self.pair(Channel::WindSpeed, Channel::WindDirection) {
            put(&mut inputs.wind, polar(speed, from, -1.0).collect());
        } else if let Some((speed, from)) = self.pair(Channel::ApparentWindSpeed, Channel::ApparentWindDirection) {
            let purpose = "to turn apparent into true wind";
            let next = "record it, or record the true wind";
            let psi = self.require(Channel::Psi, purpose, next)?;
            let u = self.require(Channel::U, purpose, next)?;
            let v = self.require(Channel::V, purpose, next)?;
            let air = polar(speed, from, -1.0).enumerate();
            put(&mut inputs.wind, air.map(|(i, air)| to_earth(psi[i], [air[0] + u[i], air[1] + v[i]])).collect());
        }
        if let Some((speed, to)) = self.pair(Channel::CurrentSpeed, Channel::CurrentDirection) {
            put(&mut inputs.current, polar(speed, to, 1.0).collect());
        }
        if let Some((height, from)) = self.pair(Channel::WaveHeight, Channel::WaveDirection) {
            let squared: Vec<f64> = height.iter().map(|h| h * h).collect();
            put(&mut inputs.waves, polar(&squared, from, -1.0).collect());
        }
        if let Some(depth) = self.get(Channel::Depth) {
            inputs.draught_to_depth = depth.iter().map(|h| settings.draught / h).collect();
        }
        for (channel, sign) in [(Channel::BankStarboard, 1.0), (Channel::BankPort, -1.0)] {
            if let Some(distance) = self.get(channel) {
                inputs.bank.resize(distance.len(), 0.0);
                inputs.bank.iter_mut().zip(distance).for_each(|(bank, y)| *bank += sign / y);
            }
        }
        if directed {
            self.require(
                Channel::Psi,
                "to bring wind, current and waves to the ship's axes",
                "record it, or leave them out",
            )?;
        }
        Ok(inputs)
    }

    fn pair(&self, a: Channel, b: Channel) -> Option<(&[f64], &[f64])> {
        self.get(a).zip(self.get(b))
    }

    /// Rows of `segment` within `span` seconds, centred on `t0`, moved inside where the segment ends.
    fn rows_around(&self, segment: &Range<usize>, t0: f64, span: f64) -> Range<usize> {
        let t = self.time();
        let (first, last) = (t[segment.start], t[segment.end - 1]);
        let from = (t0 - 0.5 * span).min(last - span).max(first);
        let slack = 1e-9 * span;
        let inside = &t[segment.clone()];
        segment.start + inside.partition_point(|ti| *ti < from - slack)
            ..segment.start + inside.partition_point(|ti| *ti <= from + span + slack)
    }

    /// State at `t0` of the local motion that fits all state channels of `segment` best over `span` seconds: u, v and r linear in
    /// time, x, y and psi their integrals. The deviation of a channel's own rows from that motion at `t0` is added, so that the
    /// state is what the sensors report. Channels that were not recorded come out of the others, or as 0 (position, and heading without
    /// one). `None` when fewer than three rows are covered.
    fn local_motion(&self, segment: &Range<usize>, t0: f64, span: f64) -> Option<[f64; STATES]> {
        let rows = self.rows_around(segment, t0, span);
        if rows.len() < 3 {
            return None;
        }
        let tau: Vec<f64> = self.time()[rows.clone()].iter().map(|ti| ti - t0).collect();
        let channel = |c: Channel| self.get(c).map(|v| &v[rows.clone()]);
        let [x, y, psi, u, v, r] = STATE_CHANNELS.map(channel);

        let mut turn = Rows::default();
        if let Some(psi) = psi {
            turn.push(&tau, psi, |_, s| vec![1.0, s, 0.5 * s * s]);
        }
        if let Some(r) = r {
            turn.push(&tau, r, |_, s| vec![0.0, 1.0, s]);
        }
        let heading = turn.solve(3)?;
        let psi_at = |s: f64| heading[0] + heading[1] * s + 0.5 * heading[2] * s * s;
        let mut motion = Rows::default();
        let table: Vec<[f64; 4]> = tau.iter().map(|&s| integrals(psi_at, s)).collect();
        // Unknowns: x0, y0, u0, u', v0, v'. Without a heading the track cannot be distinguished from drift, so it is left out.
        if psi.is_some() {
            if let Some(x) = x {
                motion.push(&tau, x, |i, _| {
                    let [c, s, ct, st] = table[i];
                    vec![1.0, 0.0, c, ct, -s, -st]
                });
            }
            if let Some(y) = y {
                motion.push(&tau, y, |i, _| {
                    let [c, s, ct, st] = table[i];
                    vec![0.0, 1.0, s, st, c, ct]
                });
            }
        }
        if let Some(u) = u {
            motion.push(&tau, u, |_, s| vec![0.0, 0.0, 1.0, s, 0.0, 0.0]);
        }
        if let Some(v) = v {
            motion.push(&tau, v, |_, s| vec![0.0, 0.0, 0.0, 0.0, 1.0, s]);
        }
        let m = motion.solve(6)?;
        let mut state = [m[0], m[1], heading[0], m[2], m[4], heading[1]];
        // A sensor that errs disagrees with the motion that all of them share: a simulation starts from what it reports itself. A velocity
        // is off by a constant, and the integrals of the others' errors are lines.
        let line = |value: f64, slope: f64, s: f64| value + slope * s;
        let shared: [&dyn Fn(usize) -> f64; STATES] = [
            &|i| m[0] + along(table[i], [m[2], m[3], -m[4], -m[5]]),
            &|i| m[1] + along(table[i], [m[4], m[5], m[2], m[3]]),
            &|i| psi_at(tau[i]),
            &|i| line(m[2], m[3], tau[i]),
            &|i| line(m[4], m[5], tau[i]),
            &|i| line(heading[1], heading[2], tau[i]),
        ];
        for (c, values) in [x, y, psi, u, v, r].into_iter().enumerate().filter(|(c, _)| *c > 1 || psi.is_some()) {
            let Some(values) = values else { continue };
            let rest: Vec<f64> = (0..tau.len()).map(|i| values[i] - shared[c](i)).collect();
            state[c] += if c < 3 { at_zero(&tau, &rest) } else { mean(rest) }.unwrap_or(0.0);
        }
        if psi.is_none() {
            for (i, values) in [x, y].into_iter().enumerate() {
                state[i] = values.and_then(|v| local_fit(&tau, v, 0.0)).map_or(0.0, |c| c[0]);
            }
        }
        state.iter().all(|s| s.is_finite()).then_some(state)
    }
}

/// Grid step and lengths in steps.
struct Grid {
    /// The recording's usual step.
    usual: f64,
    step: f64,
    window: Option<usize>,
    overlap: usize,
    /// The grid is the recording's own: rows are used as they are where they are regular.
    as_recorded: bool,
    /// Width of the mean around each sample \[s\], 0 for none.
    width: f64,
}

/// Samples an unbroken stretch on a grid.
struct Sampler<'a> {
    t: &'a [f64],
    segment: Range<usize>,
    start: f64,
    step: f64,
    width: f64,
    /// Row of sample 0, when samples are rows.
    row: Option<usize>,
    /// Steps that fit.
    steps: usize,
}

impl<'a> Sampler<'a> {
    fn new(t: &'a [f64], segment: Range<usize>, grid: &Grid, begin: f64, end: f64) -> Self {
        let slack = 1e-6 * grid.step;
        let rows = &t[segment.clone()];
        let aligned =
            rows.iter().enumerate().all(|(i, ti)| (ti - rows[0] - i as f64 * grid.step).abs() < 1e-3 * grid.step);
        let (first, last) = (rows[0], rows[rows.len() - 1]);
        if grid.as_recorded && aligned {
            let from = segment.start + rows.partition_point(|&ti| ti < begin - slack);
            let to = segment.start + rows.partition_point(|&ti| ti <= end + slack);
            let steps = to.saturating_sub(from + 1);
            let start = t.get(from).copied().unwrap_or(last);
            return Self { t, segment, start, step: grid.step, width: 0.0, row: Some(from), steps };
        }
        let start = begin.max(first + 0.5 * grid.width);
        let room = end.min(last - 0.5 * grid.width) - start;
        let steps = if room < 0.0 { 0 } else { ((room + slack) / grid.step).floor() as usize };
        Self { t, segment, start, step: grid.step, width: grid.width, row: None, steps }
    }

    fn time(&self, sample: usize) -> f64 {
        match self.row {
            Some(row) => self.t[row + sample],
            None => self.start + sample as f64 * self.step,
        }
    }

    /// The sample of a column: the row itself, a linear interpolation, or the mean over `width` of the line through the rows.
    fn sample(&self, values: &[f64], sample: usize) -> f64 {
        if let Some(row) = self.row {
            return values[row + sample];
        }
        let at = self.time(sample);
        if self.width == 0.0 {
            return self.interpolate(values, at);
        }
        // Trapezoids between the ends of the mean and the rows inside are the exact integral of the line.
        let (from, to) = (at - 0.5 * self.width, at + 0.5 * self.width);
        let rows = &self.t[self.segment.clone()];
        let inside = rows.partition_point(|&t| t <= from)..rows.partition_point(|&t| t < to);
        let mut before = (from, self.interpolate(values, from));
        let mut integral = 0.0;
        let knots = inside.map(|i| (rows[i], values[self.segment.start + i]));
        for point in knots.chain(std::iter::once((to, self.interpolate(values, to)))) {
            integral += 0.5 * (point.1 + before.1) * (point.0 - before.0);
            before = point;
        }
        integral / self.width
    }

    fn interpolate(&self, values: &[f64], at: f64) -> f64 {
        let rows = &self.t[self.segment.clone()];
        let next = rows.partition_point(|&t| t <= at).clamp(1, rows.len() - 1);
        let (a, b) = (self.segment.start + next - 1, self.segment.start + next);
        let fraction = (at - self.t[a]) / (self.t[b] - self.t[a]);
        values[a] + (values[b] - values[a]) * fraction
    }
}

/// Rows of a weighted least-squares problem.
#[derive(Default)]
struct Rows {
    basis: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl Rows {
    /// Adds a channel, weighted by the inverse of its scatter about its own quadratic.
    fn push(&mut self, tau: &[f64], values: &[f64], basis: impl Fn(usize, f64) -> Vec<f64>) {
        let weight = 1.0 / scatter(tau, values);
        for (i, (&s, &v)) in tau.iter().zip(values).enumerate() {
            self.basis.push(basis(i, s).into_iter().map(|b| b * weight).collect());
            self.right.push(v * weight);
        }
    }

    /// Solution of least norm, columns scaled to unit length; columns without data come out as 0.
    fn solve(self, unknowns: usize) -> Option<Vec<f64>> {
        let rows = self.right.len();
        let mut a = nalgebra::DMatrix::from_fn(rows, unknowns, |i, j| self.basis[i][j]);
        let scale: Vec<f64> = (0..unknowns).map(|j| a.column(j).norm()).collect();
        for (j, &s) in scale.iter().enumerate().filter(|(_, s)| **s > 0.0) {
            a.column_mut(j).scale_mut(1.0 / s);
        }
        let solution = a.svd(true, true).solve(&nalgebra::DVector::from_vec(self.right), 1e-10).ok()?;
        Some((0..unknowns).map(|j| if scale[j] > 0.0 { solution[j] / scale[j] } else { 0.0 }).collect())
    }
}

/// Integrals from 0 to `s` of cos psi, sin psi, and of both times the running time, by Simpson's rule.
fn integrals(psi_at: impl Fn(f64) -> f64, s: f64) -> [f64; 4] {
    const PANELS: usize = 8;
    let mut sum = [0.0; 4];
    for i in 0..=2 * PANELS {
        let at = s * i as f64 / (2 * PANELS) as f64;
        let weight = if i == 0 || i == 2 * PANELS {
            1.0
        } else if i % 2 == 1 {
            4.0
        } else {
            2.0
        };
        let (sin, cos) = psi_at(at).sin_cos();
        for (sum, value) in sum.iter_mut().zip([cos, sin, at * cos, at * sin]) {
            *sum += weight * value;
        }
    }
    sum.map(|v| v * s / (6 * PANELS) as f64)
}

/// Integrals of cos psi and sin psi, and of both times the running time, times what each contributes ahead and its rate, and across.
fn along([c, s, ct, st]: [f64; 4], [a, rate, b, other]: [f64; 4]) -> f64 {
    c * a + ct * rate + s * b + st * other
}

/// Value at 0 of the line through samples by least squares; their mean where they are all at one time.
fn at_zero(tau: &[f64], values: &[f64]) -> Option<f64> {
    let (middle, centre) = (mean(tau.iter().copied())?, mean(values.iter().copied())?);
    let spread: f64 = tau.iter().map(|s| (s - middle).powi(2)).sum();
    let pull: f64 = tau.iter().zip(values).map(|(s, v)| (s - middle) * (v - centre)).sum();
    Some(if spread > 0.0 { centre - pull / spread * middle } else { centre })
}

/// Root mean square distance of samples from their own quadratic, with a floor for samples without noise.
fn scatter(tau: &[f64], values: &[f64]) -> f64 {
    let middle = tau[tau.len() / 2];
    let range = values.iter().fold(0.0_f64, |m, v| m.max((v - values[0]).abs()));
    let floor = 1e-6 * range + 1e-9 * values[0].abs() + 1e-12;
    let Some([c0, c1, c2]) = local_fit(tau, values, middle) else { return floor };
    let residual = |(s, v): (&f64, &f64)| v - (c0 + c1 * (s - middle) + 0.5 * c2 * (s - middle).powi(2));
    let sum: f64 = tau.iter().zip(values).map(|p| residual(p).powi(2)).sum();
    (sum / values.len().saturating_sub(3).max(1) as f64).sqrt().max(floor)
}

/// A time in seconds to the thousandth, without trailing zeros: `12` or `12.5`.
fn thousandths(time: f64) -> String {
    let text = format!("{time:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Vectors of a magnitude and a direction clockwise from north (or from the bow); `sign` -1 for directions something comes FROM.
fn polar<'a>(magnitude: &'a [f64], direction: &'a [f64], sign: f64) -> impl Iterator<Item = [f64; 2]> + 'a {
    magnitude.iter().zip(direction).map(move |(m, d)| [sign * m * d.cos(), sign * m * d.sin()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::or_nan;
    use proptest::prelude::*;

    fn labels() -> Labels {
        Labels { run: "run".into(), session: "day".into(), manoeuvre: "turning".into(), split: Split::Train }
    }

    /// A run whose channels are straight lines in time, `rows` long with step `dt`.
    fn straight(rows: usize, dt: f64) -> Vec<(Channel, Vec<f64>)> {
        let t: Vec<f64> = (0..rows).map(|i| i as f64 * dt).collect();
        let line = |a: f64, b: f64| t.iter().map(|t| a + b * t).collect::<Vec<f64>>();
        vec![
            (Channel::X, line(3.0, 2.0)),
            (Channel::Y, line(-1.0, 0.5)),
            (Channel::Psi, line(0.1, 0.0)),
            (Channel::U, line(2.0, 0.01)),
            (Channel::V, line(0.0, -0.01)),
            (Channel::R, line(0.001, 0.0001)),
            (Channel::N, line(1.0, 0.001)),
            (Channel::Delta, line(-0.1, 0.001)),
            (Channel::T, t),
        ]
    }

    fn settings() -> WindowSettings {
        WindowSettings::whole(5.0)
    }

    #[test]
    fn the_own_step_changes_nothing_bit_for_bit() {
        let r = Recording::from_channels("run", straight(50, 0.1)).unwrap();
        let w = &r.windows(&labels(), &settings()).unwrap().windows[0];
        assert_eq!((w.measured.len(), w.inputs.len(), w.dt), (50, 50, 0.1));
        for row in 0..50 {
            let recorded = STATE_CHANNELS.map(|c| r.get(c).unwrap()[row]);
            assert_eq!(w.measured[row], recorded.map(Some));
            assert_eq!(w.inputs[row].t, r.time()[row]);
            assert_eq!(w.inputs[row].delta, r.get(Channel::Delta).unwrap()[row]);
        }
        assert_eq!(w.initial.map(Some), w.measured[0]);
    }

    #[test]
    fn track_length_and_mean_speed_are_those_of_the_measured_motion() {
        let r = Recording::from_channels("run", straight(101, 0.1)).unwrap();
        let w = &r.windows(&labels(), &settings()).unwrap().windows[0];
        assert!((w.path_length() - 10.0 * 2_f64.hypot(0.5)).abs() < 1e-9);
        let mean =
            r.get(Channel::U).unwrap().iter().zip(r.get(Channel::V).unwrap()).map(|(u, v)| u.hypot(*v)).sum::<f64>()
                / 101.0;
        assert!((w.mean_speed() - mean).abs() < 1e-12);
    }

    #[test]
    fn apparent_wind_becomes_true_wind_with_the_ships_motion() {
        let mut channels = straight(20, 1.0);
        let (u, psi) = (channels[3].1.clone(), channels[2].1.clone());
        channels[4].1.fill(0.0);
        // True wind of 6 m/s from 40 deg: U_A cos g = U_T cos(g_T - psi) + u, U_A sin g = U_T sin(g_T - psi) + v.
        let from = 40_f64.to_radians();
        let apparent = u.iter().zip(&psi).map(|(u, p)| [6.0 * (from - p).cos() + u, 6.0 * (from - p).sin()]);
        let (speed, angle) = apparent.map(|a| (a[0].hypot(a[1]), a[1].atan2(a[0]))).unzip();
        channels.push((Channel::ApparentWindSpeed, speed));
        channels.push((Channel::ApparentWindDirection, angle));
        let r = Recording::from_channels("run", channels).unwrap();
        let w = &r.windows(&labels(), &settings()).unwrap().windows[0];
        for i in &w.inputs {
            assert!((i.wind[0] + 6.0 * from.cos()).abs() < 1e-12 && (i.wind[1] + 6.0 * from.sin()).abs() < 1e-12);
        }
    }

    #[test]
    fn every_input_recorded_as_it_is_reaches_the_run() {
        let mut channels = straight(10, 1.0);
        let mut wanted = Inputs::<f64>::actuators(0.0, 0.0, 0.0);
        for (i, (name, value)) in wanted.recorded().enumerate() {
            *value = 0.1 + 0.2 * i as f64;
            let channel = Channel::from_name(name).unwrap();
            channels.retain(|(c, _)| *c != channel);
            channels.push((channel, vec![*value; 10]));
        }
        let r = Recording::from_channels("run", channels).unwrap();
        let mut got = r.windows(&labels(), &settings()).unwrap().windows[0].inputs[4];
        let values = |i: &mut Inputs<f64>| i.recorded().map(|(_, v)| *v).collect::<Vec<f64>>();
        assert_eq!(values(&mut got), values(&mut wanted));
    }

    #[test]
    fn environment_channels_arrive_as_the_inputs_promise() {
        let mut channels = straight(10, 1.0);
        let add = |channels: &mut Vec<_>, c: Channel, v: f64| channels.push((c, vec![v; 10]));
        add(&mut channels, Channel::WindSpeed, 8.0);
        add(&mut channels, Channel::WindDirection, 0.0);
        add(&mut channels, Channel::CurrentSpeed, 0.5);
        add(&mut channels, Channel::CurrentDirection, std::f64::consts::FRAC_PI_2);
        add(&mut channels, Channel::WaveHeight, 2.0);
        add(&mut channels, Channel::WaveDirection, std::f64::consts::PI);
        add(&mut channels, Channel::Depth, 20.0);
        add(&mut channels, Channel::BankPort, 50.0);
        let r = Recording::from_channels("run", channels).unwrap();
        let w = &r.windows(&labels(), &settings()).unwrap().windows[0];
        let i = &w.inputs[3];
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(i.wind[0], -8.0);
        close(i.current[1], 0.5);
        close(i.waves[0], 4.0);
        close(i.draught_to_depth, 0.25);
        close(i.bank, -0.02);
        close(i.thruster, 0.0);
    }

    #[test]
    fn a_smoothed_initial_state_is_nearer_the_truth_than_a_noisy_sample() {
        use rand::SeedableRng;
        use rand_distr::{Distribution, Normal};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let (mut first, mut smoothed) = (0.0, 0.0);
        for _ in 0..40 {
            let noise = Normal::new(0.0, 0.05).unwrap();
            let (u, v, r) = (2.0, -0.3, 0.05);
            let t: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i)).collect();
            let psi: Vec<f64> = t.iter().map(|t| r * t).collect();
            let mut noisy =
                |values: Vec<f64>| values.into_iter().map(|x| x + noise.sample(&mut rng)).collect::<Vec<f64>>();
            let x = psi.iter().map(|p| (u * p.sin() + v * (p.cos() - 1.0)) / r).collect();
            let y = psi.iter().map(|p| (u * (1.0 - p.cos()) + v * p.sin()) / r).collect();
            let channels = vec![
                (Channel::X, noisy(x)),
                (Channel::Y, noisy(y)),
                (Channel::Psi, noisy(psi)),
                (Channel::U, noisy(vec![u; 100])),
                (Channel::V, noisy(vec![v; 100])),
                (Channel::R, noisy(vec![r; 100])),
                (Channel::N, vec![1.0; 100]),
                (Channel::Delta, vec![0.1; 100]),
                (Channel::T, t),
            ];
            let recording = Recording::from_channels("run", channels).unwrap();
            let truth = [0.0, 0.0, 0.0, u, v, r];
            let error = |initial| {
                let w = recording.windows(&labels(), &WindowSettings { initial, ..settings() }).unwrap();
                w.windows[0].initial.iter().zip(truth).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
            };
            first += error(Initial::First);
            smoothed += error(Initial::Smoothed { span: 3.0 });
        }
        assert!(smoothed < 0.2 * first, "{smoothed} {first}");
    }

    #[test]
    fn a_smoothed_initial_state_of_an_exact_circle_is_exact() {
        let (u, v, r) = (2.0, -0.3, 0.05);
        let t: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i)).collect();
        let psi: Vec<f64> = t.iter().map(|t| 0.3 + r * t).collect();
        let x = psi.iter().map(|p| (u * p.sin() + v * p.cos()) / r).collect::<Vec<_>>();
        let y = psi.iter().map(|p| (-u * p.cos() + v * p.sin()) / r).collect::<Vec<_>>();
        let truth = [x[0], y[0], 0.3, u, v, r];
        let full = vec![
            (Channel::X, x),
            (Channel::Y, y),
            (Channel::Psi, psi),
            (Channel::N, vec![1.0; 100]),
            (Channel::Delta, vec![0.1; 100]),
            (Channel::T, t),
        ];
        // Velocity and yaw rate were not recorded: they come out of position and heading.
        let recording = Recording::from_channels("run", full).unwrap();
        let initial = Initial::Smoothed { span: 2.0 };
        let w = recording.windows(&labels(), &WindowSettings { initial, ..settings() }).unwrap();
        assert_eq!(w.windows[0].channels(), [true, true, true, false, false, false]);
        for (a, b) in w.windows[0].initial.iter().zip(truth) {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }

    #[test]
    fn a_smoothed_initial_state_is_what_each_sensor_reports_of_itself() {
        // The log reads 8 % too much, the gyro has a bias: positions and heading are exact.
        let mut channels = straight(100, 0.1);
        let speed = 2.0_f64.hypot(0.5);
        let all = |value: f64| vec![value; 100];
        for (channel, values) in &mut channels {
            match channel {
                Channel::Psi => *values = all(0.5_f64.atan2(2.0)),
                Channel::U => *values = all(1.08 * speed),
                Channel::V => *values = all(0.0),
                Channel::R => *values = all(0.003),
                _ => {}
            }
        }
        let initial = Initial::Smoothed { span: 3.0 };
        let start = |channels| {
            let recording = Recording::from_channels("run", channels).unwrap();
            recording.windows(&labels(), &WindowSettings { initial, ..settings() }).unwrap().windows[0].initial
        };
        for (a, b) in start(channels.clone()).into_iter().zip([3.0, -1.0, 0.5_f64.atan2(2.0), 1.08 * speed, 0.0, 0.003])
        {
            assert!((a - b).abs() < 5e-3, "{a} {b}");
        }
        // Without a log the speed is that of the track.
        channels.retain(|(c, _)| *c != Channel::U);
        assert!((start(channels)[3] - speed).abs() < 0.02);
    }

    #[test]
    fn a_window_longer_than_the_run_is_one_clear_error() {
        let r = Recording::from_channels("run", straight(50, 0.1)).unwrap();
        let error = r.windows(&labels(), &WindowSettings { window: Some(10.0), ..settings() }).unwrap_err().to_string();
        assert!(error.starts_with("run:2: ") && error.contains("4.90 s") && error.contains("10.00 s"), "{error}");
    }

    proptest! {
        #![proptest_config(crate::recording::seeded())]
        #[test]
        fn resampling_keeps_straight_lines(step in 0.03..3.0f64, jitter in prop::collection::vec(-0.015..0.015f64, 200)) {
            let mut channels = straight(200, 0.1);
            let last = channels.len() - 1;
            let t: Vec<f64> = channels[last].1.iter().zip(&jitter).map(|(t, j)| t + j).collect();
            for (channel, values) in &mut channels {
                let (a, b) = (values[0], (values[199] - values[0]) / 19.9);
                if *channel != Channel::T {
                    values.iter_mut().zip(&t).for_each(|(v, t)| *v = a + b * t);
                }
            }
            channels[last].1 = t;
            let r = Recording::from_channels("run", channels).unwrap();
            let w = r.windows(&labels(), &WindowSettings { step: Some(step), ..settings() }).unwrap();
            let w = &w.windows[0];
            for (k, (s, i)) in w.measured.iter().zip(&w.inputs).enumerate() {
                let (t, s) = (w.time(k), or_nan(s));
                prop_assert!((s[0] - (3.0 + 2.0 * t)).abs() < 1e-9);
                prop_assert!((s[1] - (-1.0 + 0.5 * t)).abs() < 1e-9);
                prop_assert!((i.n - (1.0 + 0.001 * t)).abs() < 1e-9 && (i.t - t).abs() < 1e-9);
            }
        }

        #[test]
        fn windows_are_as_many_as_fit_and_share_their_ends(rows in 10_usize..400, length in 2_usize..60, overlap in 0_usize..59, hole in 0_usize..400) {
            prop_assume!(overlap < length);
            let mut channels = straight(rows, 0.5);
            if hole < rows {
                channels[0].1[hole] = f64::NAN;
            }
            let r = Recording::from_channels("run", channels).unwrap();
            let s = WindowSettings {
                window: Some(0.5 * length as f64),
                overlap: 0.5 * overlap as f64,
                gaps: Gaps::Split,
                ..settings()
            };
            let pieces = if hole < rows { vec![hole, rows - hole - 1] } else { vec![rows] };
            let expected: usize = pieces
                .iter()
                .map(|&rows| rows.saturating_sub(1))
                .filter(|&steps| steps >= length)
                .map(|steps| (steps - length) / (length - overlap) + 1)
                .sum();
            match r.windows(&labels(), &s) {
                Ok(w) => {
                    prop_assert_eq!(w.windows.len(), expected);
                    for w in &w.windows {
                        prop_assert_eq!(w.steps(), length);
                        prop_assert!(w.measured.iter().flatten().all(Option::is_some), "a window reaches across the hole");
                    }
                }
                Err(_) => prop_assert_eq!(expected, 0),
            }
        }
    }
}
