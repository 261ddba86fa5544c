//! Fixes: positions between which no ship sails, by a wrong position or by a wrong time stamp, and headings across north.
//! Whether track and velocity agree over a whole run is in `signs`.

use crate::numerals::sig;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{
    FASTEST, FIX_FAR, FIX_OPPOSITE, FIX_SHARE, FIX_SPEED, RESOLUTION_CHANGES, RESOLUTIONS,
};
use crate::recording::audit::motion::response::integral;
use crate::recording::{Channel, Recording, across_the_wrap};
use crate::statistics::{median, quantile};

/// A step from one fix to the next that differs from it.
struct Step {
    /// Row of the second.
    row: usize,
    /// Time between them \[s\].
    time: f64,
    /// Change of x and y, and its length \[m\].
    moved: [f64; 2],
    length: f64,
    /// Its difference from what velocity and heading say, and the size of that \[m\]; the step itself where they were not recorded.
    missed: [f64; 2],
    off: f64,
}

/// Steps between fixes that are far too long for the ship; true where there are some.
pub fn fixes(recording: &Recording, issues: &mut Vec<Issue>) -> bool {
    let steps = steps(recording);
    let known = [Channel::Psi, Channel::U, Channel::V].iter().all(|c| recording.has(*c));
    let Some(fastest) = fastest(recording, &steps) else { return false };
    let usual = 1.4826 * median(steps.iter().map(|s| s.off)).unwrap_or(0.0);
    // The resolution is computed only for steps that look impossible.
    let beyond = |rounding: f64, step: &Step| {
        step.length - rounding > FIX_SPEED * fastest * step.time && step.off - rounding > FIX_FAR * usual
    };
    let impossible =
        |(at, step): &(usize, &Step)| beyond(0.0, step) && beyond(RESOLUTIONS * resolution(&steps, *at), step);
    // A single fix or time stamp that is off makes one step too long, and the next one as much too short.
    let single = |(at, step): &(usize, &Step)| {
        let Some(next) = steps.get(at + 1) else { return false };
        let both = (step.missed[0] + next.missed[0]).hypot(step.missed[1] + next.missed[1]);
        let least = step.off.min(next.off) - RESOLUTIONS * resolution(&steps, *at).max(resolution(&steps, at + 1));
        let sailed = fastest * step.time.max(next.time);
        least > FIX_FAR * usual && least > FIX_SHARE * sailed && both < FIX_OPPOSITE * least
    };
    let off = |s: &(usize, &Step)| known && s.1.off > FIX_FAR * usual && single(s);
    let found: Vec<&Step> =
        steps.iter().enumerate().filter(|s| impossible(s) || off(s)).map(|(_, step)| step).collect();
    let Some(longest) = found.iter().max_by(|a, b| a.length.total_cmp(&b.length)) else { return false };
    let (first, last) = (found[0].row, found[found.len() - 1].row);
    let count = if found.len() == 1 { String::new() } else { format!(", and {} more so", found.len() - 1) };
    let text = format!(
        "the position moves {} m in {} s (line {}), where the ship sails {} m/s at most{count}",
        sig(longest.length, 3),
        sig(longest.time, 3),
        recording.line(longest.row),
        sig(fastest, 2),
    );
    let next = "the fix or its time stamp is wrong: leave x and y of these lines blank, or use `blank = { outside = [...] }` in a column map";
    let lines = (recording.line(first - 1), recording.line(last));
    issues.push(Issue::new(Severity::Warning, "fix_jump", text, next).of(Channel::X).at(lines));
    true
}

/// The steps between successive fixes that differ: a receiver repeats its last one until it has another.
fn steps(recording: &Recording) -> Vec<Step> {
    let Some((x, y)) = recording.get(Channel::X).zip(recording.get(Channel::Y)) else { return Vec::new() };
    let t = recording.time();
    let velocity = [Channel::Psi, Channel::U, Channel::V].map(|c| recording.get(c));
    let said = |row: usize| {
        let [psi, u, v] = velocity.map(|values| values.map_or(0.0, |v| v[row]));
        let (s, c) = psi.sin_cos();
        [u * c - v * s, u * s + v * c]
    };
    let known = velocity.iter().all(Option::is_some);
    let mut steps = Vec::new();
    let mut last: Option<usize> = None;
    let mut sailed = [0.0; 2];
    for row in 0..t.len() {
        if row > 0 && known {
            let add: [f64; 2] =
                std::array::from_fn(|i| 0.5 * (said(row)[i] + said(row - 1)[i]) * (t[row] - t[row - 1]));
            if add.iter().all(|a| a.is_finite()) {
                sailed.iter_mut().zip(add).for_each(|(s, a)| *s += a);
            }
        }
        if !(x[row].is_finite() && y[row].is_finite()) {
            continue;
        }
        let Some(from) = last.filter(|&from| (x[from], y[from]) != (x[row], y[row])) else {
            last = last.or(Some(row));
            continue;
        };
        let moved = [x[row] - x[from], y[row] - y[from]];
        let length = moved[0].hypot(moved[1]);
        let missed = if known { [moved[0] - sailed[0], moved[1] - sailed[1]] } else { moved };
        steps.push(Step { row, time: t[row] - t[from], moved, length, missed, off: missed[0].hypot(missed[1]) });
        (last, sailed) = (Some(row), [0.0; 2]);
    }
    steps
}

/// Resolution of positions around a step \[m\]: where an axis repeats its value while the other changes, the smallest change of it,
/// the larger one of those before and after; 0 where it changes with every fix.
fn resolution(steps: &[Step], at: usize) -> f64 {
    let axis = |i: usize| {
        let near = |near: &mut dyn Iterator<Item = &Step>| {
            let near: Vec<f64> = near.take(RESOLUTION_CHANGES).map(|s| s.moved[i].abs()).collect();
            let changes = near.iter().copied().filter(|d| *d > 0.0);
            if changes.clone().count() == near.len() { 0.0 } else { changes.reduce(f64::min).unwrap_or(0.0) }
        };
        near(&mut steps[..=at].iter().rev()).max(near(&mut steps[at..].iter()))
    };
    axis(0).hypot(axis(1))
}

/// The speed that the ship has at its fastest \[m/s\]: as recorded, or as most fixes say.
fn fastest(recording: &Recording, steps: &[Step]) -> Option<f64> {
    let mut speeds: Vec<f64> = match (recording.get(Channel::U), recording.get(Channel::V)) {
        (Some(u), v) => (0..u.len()).map(|i| u[i].hypot(v.map_or(0.0, |v| v[i]))).collect(),
        (None, _) => steps.iter().map(|s| s.length / s.time).collect(),
    };
    speeds.retain(|s| s.is_finite());
    speeds.sort_by(f64::total_cmp);
    quantile(&speeds, FASTEST).filter(|speed| *speed > 0.0)
}

/// Headings that were interpolated across north; true where there are some.
pub fn headings(recording: &Recording, issues: &mut Vec<Issue>) -> bool {
    let recorded = recording.get(Channel::Psi).filter(|_| !recording.derived().contains(&Channel::Psi));
    // What the yaw rate adds up to.
    let rate = recording.get(Channel::R).filter(|_| !recording.derived().contains(&Channel::R));
    let turned = rate.map(|r| integral(recording.time(), |i| r[i]));
    let turned = |from: usize, to: usize| turned.as_ref().map(|sum| sum[to] - sum[from]);
    let found = recorded.map(|psi| across_the_wrap(recording.time(), psi, turned)).unwrap_or_default();
    let (Some(first), Some(last)) = (found.first(), found.last()) else { return false };
    let rows: usize = found.iter().map(ExactSizeIterator::len).sum();
    let text = format!("{rows} values between 359 and 1 deg were interpolated the wrong way round, through 180 deg");
    let next = "set `wrap_repair = true` in a column map";
    let lines = (recording.line(first.start), recording.line(last.end - 1));
    issues.push(Issue::new(Severity::Error, "heading_wrap", text, next).of(Channel::Psi).at(lines));
    true
}
