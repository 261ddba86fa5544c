//! Clocks: how much later one channel shows a motion than another.
//! Which channels are compared is decided by those that differentiate and smooth them.

use crate::recording::Channel;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{LAG_LONGEST, LAG_STEPS, PAIR_HALVES, PAIR_LEAVES, PAIR_STEPS};

/// Two series of one motion, of the longest stretch offered.
#[derive(Default)]
pub struct Pair {
    a: Vec<f64>,
    b: Vec<f64>,
    step: f64,
}

impl Pair {
    /// Keeps these, a row each `step` \[s\], if they are longer than what is kept.
    pub fn offer(&mut self, a: Vec<f64>, b: Vec<f64>, step: f64) {
        if a.len() > self.a.len() {
            *self = Self { a, b, step };
        }
    }

    /// Time by which the second lags behind the first \[s\].
    pub fn lag(&self) -> Option<f64> {
        lag(&self.a, &self.b, self.step)
    }

    /// Reports the lag, where it is more than a step and a half.
    pub fn tell(&self, lag: Option<f64>, channel: Channel, other: &str, issues: &mut Vec<Issue>) {
        let [noted, doubtful] = LAG_STEPS;
        let Some(lag) = lag.filter(|l| l.abs() > noted * self.step) else { return };
        let severity = if lag.abs() > doubtful * self.step { Severity::Warning } else { Severity::Note };
        let order = if lag > 0.0 { "behind" } else { "ahead of" };
        let text = format!("runs {:.2} s {order} {other}", lag.abs());
        let next =
            format!("`delay = {lag:.2}` for `{channel}` in a column map takes it back, if its clock is the late one");
        issues.push(Issue::new(severity, "clock", text, next).of(channel));
    }
}

/// Time by which `b` lags behind `a` \[s\]: the shift that leaves the least difference, refined by a parabola through the least
/// and its neighbours. `None` when no shift up to an eighth of the series is clearly the best, so that no lag can be determined.
fn lag(a: &[f64], b: &[f64], step: f64) -> Option<f64> {
    let most = ((LAG_LONGEST.0 * a.len() as f64) as usize).min(PAIR_STEPS) as isize;
    if most < 3 {
        return None;
    }
    let centred = |v: &[f64]| {
        let mean = v.iter().sum::<f64>() / v.len() as f64;
        v.iter().map(|x| x - mean).collect::<Vec<f64>>()
    };
    let (a, b) = (centred(a), centred(b));
    let margin = most as usize;
    let inner = margin..a.len() - margin;
    // b lags by k: b at row i + k shows what a showed at row i.
    let difference = |k: isize| {
        inner.clone().map(|i| (a[i] - b[i.wrapping_add_signed(k)]).powi(2)).sum::<f64>() / inner.len() as f64
    };
    let table: Vec<f64> = (-most..=most).map(difference).collect();
    let best = (0..table.len()).min_by(|i, j| table[*i].total_cmp(&table[*j]))?;
    let power = inner.clone().map(|i| a[i] * a[i]).sum::<f64>() / inner.len() as f64;
    let edge = best == 0 || best == table.len() - 1;
    if edge || !table[best].is_finite() || table[best] > PAIR_LEAVES * power {
        return None;
    }
    // Noise alone also has a least shift: one that does not halve the difference is no lag.
    if best != margin && table[best] > PAIR_HALVES * table[margin] {
        return None;
    }
    let (before, least, after) = (table[best - 1], table[best], table[best + 1]);
    let bend = before - 2.0 * least + after;
    let shift = if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
    Some((best as f64 - margin as f64 + shift) * step)
}
