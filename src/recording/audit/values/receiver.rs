//! What a receiver did that no ship can: jumps, values repeated while the ship sailed on, and a wild first fix.
//! It judges recordings by themselves, before any model is used; motion that a force could cause is left as it is.

use crate::numerals::sig;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{BEYOND_FORCE, BEYOND_NOISE, CAUGHT_UP, ENOUGH, SIDE};
use crate::recording::{Channel, Run, or_nan};
use crate::state::STATES;
use crate::statistics::median;
use nalgebra::SMatrix;
use std::borrow::Cow;
use trimtab_ad::smooth::wrap_angle;

/// Between two samples the position went where no force takes a ship, and stayed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The first sample after it.
    pub sample: usize,
    /// Its length \[m\].
    pub length: f64,
}

/// The runs, divided where the position jumps and without samples that repeat a value instead of measuring it, and one note a run on
/// each. `length` is that of the ship \[m\].
pub fn settled<'r>(runs: impl Into<Cow<'r, [Run]>>, length: f64) -> (Vec<Run>, Vec<Issue>) {
    let runs = runs.into();
    let jumps = jumps(&runs, length);
    let mut out = runs.into_owned();
    let mut issues = Vec::new();
    for run in &mut out {
        let repeated = repeated(run);
        for sample in repeated.iter().flat_map(|(from, to)| *from..=*to) {
            run.measured[sample][..3].fill(None);
        }
        if let Some((from, to)) = repeated.first() {
            let samples: usize = repeated.iter().map(|(from, to)| to - from + 1).sum();
            let text = format!(
                "{}: position and heading repeat, and then catch up, first from {} to {} s, {samples} samples in all",
                run.name,
                sig(run.inputs[*from].t, 5),
                sig(run.inputs[*to].t, 5)
            );
            let next = "a diagnosis takes these samples as not measured";
            issues.push(Issue::new(Severity::Note, "held", text, next).of(Channel::X));
        }
    }
    let mut parted = Vec::with_capacity(out.len());
    for (run, jumps) in out.into_iter().zip(jumps) {
        let Some(first) = jumps.first() else {
            parted.push(run);
            continue;
        };
        let times: Vec<String> = jumps.iter().map(|j| sig(run.inputs[j.sample].t, 5)).collect();
        let longest = jumps.iter().map(|j| j.length).fold(first.length, f64::max);
        let text = format!(
            "{}: the position jumps at {} s, by up to {} m, as no force moves the ship",
            run.name,
            times.join(", "),
            sig(longest, 2)
        );
        let next = "a diagnosis divides the run there, so that the jump is not taken for a force";
        issues.push(Issue::new(Severity::Note, "jump", text, next).of(Channel::X));
        parted.extend(parts(&run, &jumps));
    }
    issues.extend(from_second(&mut parted));
    (parted, issues)
}

/// Position and heading, with their units.
const CHANNELS: [(Channel, &str); 3] = [(Channel::X, "m"), (Channel::Y, "m"), (Channel::Psi, "rad")];

/// How far a sample is from the line through the four after it; NaN where one is not measured.
fn departure(run: &Run, k: usize, c: usize) -> f64 {
    let ahead = |i: usize| {
        let d = or_nan(&run.measured[k + i])[c] - or_nan(&run.measured[k])[c];
        if c == 2 { wrap_angle(d) } else { d }
    };
    0.5 * ahead(4) - 0.5 * ahead(2) - ahead(1)
}

/// Takes runs whose first position or heading is wild from their second sample on, and notes it: a run starts from what was
/// measured first, and a start that is off puts everything after it in doubt.
///
/// A first sample is wild where it stands out from how samples depart from those that follow in all runs, and the second does not.
fn from_second(runs: &mut [Run]) -> Vec<Issue> {
    let spread = |c: usize| {
        let of = |run: &Run| {
            (0..run.measured.len().saturating_sub(4)).map(|k| departure(run, k, c).abs()).collect::<Vec<f64>>()
        };
        let all: Vec<f64> = runs.iter().flat_map(of).filter(|d| d.is_finite()).collect();
        // The median of a normal variable's size is 0.6745 of its standard deviation.
        if all.len() < ENOUGH { f64::INFINITY } else { median(all).map_or(f64::INFINITY, |m| m / 0.6745) }
    };
    let spreads: [f64; 3] = std::array::from_fn(spread);
    let mut issues = Vec::new();
    for run in runs.iter_mut().filter(|r| r.measured.len() > 2 * SIDE) {
        let wild = |c: &usize| {
            let (first, second) = (departure(run, 0, *c), departure(run, 1, *c));
            first.abs() > BEYOND_NOISE * spreads[*c] && second.abs() < 0.5 * first.abs()
        };
        let Some(c) = (0..3).find(wild) else { continue };
        let (channel, unit) = CHANNELS[c];
        let text = format!(
            "{}: the first {channel} is {} {unit} from where those after it come from",
            run.name,
            sig(departure(run, 0, c).abs(), 2)
        );
        let next = "a diagnosis takes the run from its second sample on";
        issues.push(Issue::new(Severity::Note, "start", text, next).of(channel));
        run.inputs.remove(0);
        run.measured.remove(0);
        let second = run.measured[0];
        run.initial = std::array::from_fn(|c| second[c].unwrap_or(run.initial[c]));
    }
    issues
}

/// The samples `from..to` of a run as a run of its own; `None` where they are too few to say anything.
pub fn piece(run: &Run, from: usize, to: usize) -> Option<Run> {
    // Where a channel is not measured at the start, the last value before it is taken.
    let last = |c: usize| run.measured[..=from].iter().rev().find_map(|m| m[c]);
    (to >= from + 2 * SIDE).then(|| Run {
        name: format!("{} {} s", run.recording, sig(run.inputs[from].t, 5)),
        inputs: run.inputs[from..to].to_vec(),
        measured: run.measured[from..to].to_vec(),
        initial: if from == 0 { run.initial } else { std::array::from_fn(|c| last(c).unwrap_or(run.initial[c])) },
        disturbed: run
            .disturbed
            .iter()
            .filter(|(first, last)| *first < to && *last >= from)
            .map(|(first, last)| (first.max(&from) - from, last.min(&(to - 1)) - from))
            .collect(),
        ..run.clone()
    })
}

/// A run in pieces, each with a start of its own.
fn parts(run: &Run, jumps: &[Jump]) -> Vec<Run> {
    let mut edges = vec![0];
    edges.extend(jumps.iter().map(|j| j.sample));
    edges.push(run.measured.len());
    edges.windows(2).filter_map(|edge| piece(run, edge[0], edge[1])).collect()
}

/// Weights that read a step between the two middle samples off `N` positions in a row, whatever parabola they lie on, some of them left
/// out.
fn weights<const N: usize>(left_out: impl Fn(usize) -> bool) -> [f64; N] {
    let place = |i: usize| i as f64 + 0.5 - 0.5 * N as f64;
    let a = SMatrix::<f64, N, 4>::from_fn(|i, j| match j {
        _ if left_out(i) => 0.0,
        3 => f64::from(u8::from(2 * i >= N)),
        power => place(i).powi(power as i32),
    });
    let row = (a.transpose() * a).try_inverse().map_or([0.0; 4], |m| std::array::from_fn(|j| m[(3, j)]));
    std::array::from_fn(|i| (0..4).map(|j| row[j] * a[(i, j)]).sum())
}

/// What weights read off positions in a row; one without a weight may be missing.
fn by(weights: &[f64], rows: &[[f64; STATES]], c: usize) -> f64 {
    rows.iter().zip(weights).filter(|(_, w)| **w != 0.0).map(|(m, w)| w * m[c]).sum()
}

/// Steps and positions about a sample.
struct About<'r> {
    /// Positions of the run.
    rows: &'r [[f64; STATES]],
    /// The first sample after the step.
    sample: usize,
    /// The step \[m\].
    step: [f64; 2],
}

impl About<'_> {
    /// The part of the step across the course \[m\], and along it, in the direction sailed.
    fn parts(&self) -> [f64; 2] {
        let (first, last) = (&self.rows[self.sample - SIDE], &self.rows[self.sample + SIDE - 1]);
        let way: [f64; 2] = std::array::from_fn(|c| last[c] - first[c] - self.step[c]);
        let length = way[0].hypot(way[1]);
        let [x, y] = self.step;
        if length == 0.0 {
            [x.hypot(y), 0.0]
        } else {
            [(x * way[1] - y * way[0]) / length, (x * way[0] + y * way[1]) / length]
        }
    }

    /// Whether the samples next but `SIDE` on both sides show the step too; `None` where there are none.
    fn lasts(&self, wide: &[f64; 4 * SIDE]) -> Option<bool> {
        let from = self.sample.checked_sub(2 * SIDE)?;
        let rows = self.rows.get(from..from + 4 * SIDE)?;
        let far: [f64; 2] = std::array::from_fn(|c| by(wide, rows, c));
        let [x, y] = self.step;
        let share = (far[0] * x + far[1] * y) / (x * x + y * y);
        share.is_finite().then_some(share > 0.5)
    }
}

/// Jumps of the position, run by run.
///
/// A step counts where it stands out from those of all runs, whose spread is what noise and manoeuvres make, and is longer than
/// the ship could have been carried. A fix that is late is off along the course, and the next ones catch up: a step along the course
/// counts where the samples further away show it too.
pub fn jumps(runs: &[Run], length: f64) -> Vec<Vec<Jump>> {
    let all: [f64; 2 * SIDE] = weights(|_| false);
    let without: [[f64; 2 * SIDE]; 2 * SIDE] = std::array::from_fn(|i| weights(|j| j == i));
    let wide: [f64; 4 * SIDE] = weights(|i| (SIDE..3 * SIDE).contains(&i));
    let step = |rows: &[[f64; STATES]], c: usize| by(&all, rows, c);
    // A jump stays: without any one sample it is there still, where a single wild fix is not.
    let stays =
        |rows: &[[f64; STATES]], least: f64| without.iter().all(|w| by(w, rows, 0).hypot(by(w, rows, 1)) > least);
    // Of each run, with the sample after the step; NaN where one of the samples is.
    let rows: Vec<Vec<[f64; STATES]>> = runs.iter().map(|r| r.measured.iter().map(or_nan).collect()).collect();
    let steps_of = |rows: &Vec<[f64; STATES]>| -> Vec<[f64; 2]> {
        rows.windows(2 * SIDE).map(|rows| [step(rows, 0), step(rows, 1)]).collect()
    };
    let steps: Vec<Vec<[f64; 2]>> = rows.iter().map(steps_of).collect();
    let sizes: Vec<f64> = steps.iter().flatten().flatten().map(|s| s.abs()).filter(|s| s.is_finite()).collect();
    let enough = sizes.len() >= ENOUGH;
    let Some(usual) = median(sizes).filter(|_| enough) else { return vec![Vec::new(); runs.len()] };
    // The median of a normal variable's size is 0.6745 of its standard deviation.
    let noise = BEYOND_NOISE * usual / 0.6745;
    let (mut squares, mut count) = (0.0, 0.0);
    for (run, rows) in runs.iter().zip(&rows) {
        for rows in rows.windows(2 * SIDE) {
            let (a, b) = (&rows[0], &rows[2 * SIDE - 1]);
            let speed = (b[0] - a[0]).hypot(b[1] - a[1]) / ((2 * SIDE - 1) as f64 * run.dt);
            if speed.is_finite() {
                squares += speed * speed;
                count += 1.0;
            }
        }
    }
    let acceleration = squares / f64::max(count, 1.0) / length;
    let of = |((run, rows), steps): ((&Run, &Vec<[f64; STATES]>), &Vec<[f64; 2]>)| {
        let least = noise.max(BEYOND_FORCE * acceleration * run.dt * run.dt);
        let mut out: Vec<Jump> = Vec::new();
        for (i, s) in steps.iter().enumerate() {
            let jump = Jump { sample: i + SIDE, length: s[0].hypot(s[1]) };
            if jump.length.is_nan() || jump.length <= least || !stays(&rows[i..i + 2 * SIDE], 0.5 * jump.length) {
                continue;
            }
            let about = About { rows, sample: jump.sample, step: *s };
            let [across, along] = about.parts();
            if across.abs() <= least && along.abs() > across.abs() && about.lasts(&wide) == Some(false) {
                continue;
            }
            match out.last_mut() {
                // A jump shows in its neighbours too.
                Some(last) if jump.sample - last.sample <= SIDE => {
                    if jump.length > last.length {
                        *last = jump;
                    }
                }
                _ => out.push(jump),
            }
        }
        out
    };
    runs.iter().zip(&rows).zip(&steps).map(of).collect()
}

/// Stretches of samples that repeat position and heading to the last bit and end with a leap to where the ship has sailed.
fn repeated(run: &Run) -> Vec<(usize, usize)> {
    let m: Vec<[f64; STATES]> = run.measured.iter().map(or_nan).collect();
    let moved = |a: usize, b: usize| (m[b][0] - m[a][0]).hypot(m[b][1] - m[a][1]);
    let repeats = |k: usize| m[k][..3] == m[k - 1][..3];
    let mut out = Vec::new();
    let mut k = 2;
    while k + 1 < m.len() {
        let from = k;
        while k + 1 < m.len() && repeats(k) {
            k += 1;
        }
        let (before, periods) = (moved(from - 2, from - 1), (k - from + 1) as f64);
        if k > from && before > 0.0 && moved(k - 1, k) >= CAUGHT_UP * periods * before {
            out.push((from, k - 1));
        }
        k += 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Split, measured};
    use crate::state::Inputs;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    const LENGTH: f64 = 3.0;

    /// Runs of 60 s at 0.4 m/s on circles of two ship lengths, positions within 6 mm, with a force of one `U^2 / L` for 3 s.
    fn circles() -> Vec<Run> {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let (dt, speed) = (0.5, 0.4);
        let acceleration = speed * speed / LENGTH;
        let run = |i: usize| {
            let mut noise = || rng.random_range(-0.006..0.006);
            let at = |k: usize| {
                let (t, rate) = (dt * k as f64, speed / (2.0 * LENGTH));
                let square = |t: f64| t.max(0.0).powi(2);
                let pushed = 0.5 * acceleration * (square(t - 30.0) - square(t - 33.0));
                let radius = speed / rate;
                [radius * (rate * t).sin() + pushed, radius * (1.0 - (rate * t).cos()), rate * t]
            };
            let place = |k: usize| {
                let [x, y, psi] = at(k);
                [x + noise(), y + noise(), psi, speed, 0.0, 0.0]
            };
            let states: Vec<[f64; 6]> = (0..121).map(place).collect();
            Run {
                name: format!("run {i}"),
                recording: format!("run {i}"),
                session: "a".into(),
                manoeuvre: String::new(),
                split: Split::Train,
                dt,
                recorded_dt: dt,
                inputs: (0..121).map(|k| Inputs::actuators(dt * f64::from(k), 10.0, 0.1)).collect(),
                initial: states[0],
                measured: measured(&states),
                disturbed: Vec::new(),
                derived: [false; STATES],
            }
        };
        (0..8).map(run).collect()
    }

    #[test]
    fn neither_noise_nor_a_sudden_force_is_a_jump() {
        let (runs, issues) = settled(circles(), LENGTH);
        assert!(issues.is_empty(), "{issues:?}");
        assert_eq!(runs.len(), 8);
    }

    #[test]
    fn a_jump_is_found_between_its_samples_and_the_run_parted_there() {
        let mut runs = circles();
        for m in &mut runs[3].measured[70..] {
            m[1] = m[1].map(|y| y + 0.09);
        }
        let found = jumps(&runs, LENGTH);
        assert_eq!(found.iter().map(Vec::len).sum::<usize>(), 1, "{found:?}");
        assert_eq!(found[3][0].sample, 70);
        assert!((found[3][0].length - 0.09).abs() < 0.03, "{found:?}");
        let (runs, issues) = settled(&runs, LENGTH);
        assert_eq!(runs.len(), 9);
        let [before, after] = [&runs[3], &runs[4]];
        assert!(before.measured.len() == 70 && after.measured.len() == 51 && after.inputs.len() == 51);
        assert!(before.recording == "run 3" && after.recording == "run 3" && before.name != after.name);
        assert!(after.initial.map(Some) == after.measured[0] && after.inputs[0].t == before.inputs[69].t + before.dt);
        assert_eq!(issues.len(), 1);
        assert!(issues[0].fault == "jump" && !issues[0].blocking() && issues[0].text.contains("run 3"), "{issues:?}");
    }

    #[test]
    fn fixes_that_are_late_and_catch_up_are_no_jump_and_one_across_the_course_is() {
        let mut runs = circles();
        for run in &mut runs {
            let truth = run.measured.clone();
            // A tenth of the fixes, and in one run three in a row, are 0.9 periods old.
            let late = |k: usize| k.is_multiple_of(10) || (run.name == "run 2" && (63..66).contains(&k));
            for k in (1..truth.len()).filter(|k| late(*k)) {
                for c in 0..2 {
                    run.measured[k][c] = Some(0.1 * or_nan(&truth[k])[c] + 0.9 * or_nan(&truth[k - 1])[c]);
                }
            }
        }
        assert!(jumps(&runs, LENGTH).iter().all(Vec::is_empty), "{:?}", jumps(&runs, LENGTH));
        // Twice as far, to the side: the ship sails along x at the start of a circle.
        for m in &mut runs[3].measured[5..] {
            m[1] = m[1].map(|y| y + 0.4);
        }
        let found = jumps(&runs, LENGTH);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [0, 0, 0, 1, 0, 0, 0, 0], "{found:?}");
    }

    #[test]
    fn a_single_wild_fix_is_no_jump() {
        let mut runs = circles();
        for (run, sample, error) in [(1, 20, 0.3), (1, 90, -2.0), (4, 57, 15.0)] {
            runs[run].measured[sample][0] = runs[run].measured[sample][0].map(|x| x + error);
        }
        let found = jumps(&runs, LENGTH);
        assert!(found.iter().all(Vec::is_empty), "{found:?}");
    }

    #[test]
    fn a_wild_first_sample_is_left_out_and_an_early_manoeuvre_is_not_wild() {
        let mut runs = circles();
        runs[1].measured[0][1] = runs[1].measured[0][1].map(|y| y + 2.0);
        runs[6].measured[0][2] = runs[6].measured[0][2].map(|psi| psi - 0.1);
        // From the first sample on this ship slows down as fast as in a crash stop.
        for (k, m) in runs[4].measured.iter_mut().enumerate() {
            let t = 0.5 * k as f64;
            m[0] = m[0].map(|x| x - 0.025 * t * t);
            m[3] = m[3].map(|u| u - 0.05 * t);
        }
        let whole = runs.clone();
        let (runs, issues) = settled(&runs, LENGTH);
        assert!(issues.iter().all(|i| i.fault == "start" && !i.blocking()), "{issues:?}");
        let noted = |name: &str, channel| issues.iter().any(|i| i.channel == Some(channel) && i.text.starts_with(name));
        assert!(issues.len() == 2 && noted("run 1", Channel::Y) && noted("run 6", Channel::Psi), "{issues:?}");
        for (i, (run, whole)) in runs.iter().zip(&whole).enumerate() {
            let from = usize::from(i == 1 || i == 6);
            assert_eq!(run.measured, whole.measured[from..]);
            assert_eq!(run.inputs.len(), run.measured.len());
            assert_eq!(
                (run.initial.map(Some), run.inputs[0].t),
                (run.measured[0], whole.inputs[from].t),
                "{}",
                run.name
            );
        }
    }

    #[test]
    fn repeated_samples_are_not_measured_and_a_ship_at_rest_is() {
        let mut runs = circles();
        for k in 41..44 {
            let last = runs[2].measured[40];
            runs[2].measured[k][..3].copy_from_slice(&last[..3]);
        }
        let rest = runs[5].measured[100];
        for m in &mut runs[5].measured[100..] {
            *m = rest;
        }
        let (runs, issues) = settled(&runs, LENGTH);
        let missing = |r: &Run| (0..r.measured.len()).filter(|k| r.measured[*k][0].is_none()).collect::<Vec<_>>();
        assert_eq!(missing(&runs[2]), [41, 42, 43]);
        assert!(missing(&runs[5]).is_empty());
        assert!(issues.iter().any(|i| i.fault == "held" && i.text.contains("run 2")), "{issues:?}");
    }
}
