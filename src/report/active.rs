//! Active constraints in words: neighbours on the grid of one rule are listed as one range, `c_D(-45 to 45 deg) >= 0 (drag, 91 samples)`.
//! Which constraints are active is decided in [`crate::fit`].

use crate::fit::Active;

/// A sentence `name(at unit) limit`, taken apart.
struct Parts<'a> {
    name: &'a str,
    at: f64,
    /// The same number as it is written.
    written: &'a str,
    unit: &'a str,
    limit: &'a str,
    rule: &'a str,
}

impl<'a> Parts<'a> {
    fn of(active: &'a Active) -> Option<Self> {
        let (name, rest) = active.sentence.split_once('(')?;
        let (inside, limit) = rest.split_once(')')?;
        let (written, unit) = inside.split_once(' ').unwrap_or((inside, ""));
        Some(Self { name, at: written.parse().ok()?, written, unit, limit: limit.trim(), rule: active.rule })
    }

    fn alike(&self, other: &Self) -> bool {
        (self.name, self.unit, self.limit, self.rule) == (other.name, other.unit, other.limit, other.rule)
    }
}

/// A line for each active constraint, or range of constraints.
pub(super) fn lines(active: &[Active]) -> Vec<String> {
    let mut lines = Vec::new();
    let mut i = 0;
    while i < active.len() {
        let length = Parts::of(&active[i]).map_or(1, |first| range(&first, &active[i..]));
        lines.push(match (Parts::of(&active[i]), Parts::of(&active[i + length - 1])) {
            (Some(first), Some(last)) if length > 1 => {
                let unit = if first.unit.is_empty() { String::new() } else { format!(" {}", first.unit) };
                let (from, to) = (first.written, last.written);
                format!("{}({from} to {to}{unit}) {}   ({}, {length} samples)", first.name, first.limit, first.rule)
            }
            _ => format!("{}   ({})", active[i].sentence, active[i].rule),
        });
        i += length;
    }
    lines
}

/// How many of the constraints, from the first, are equally spaced samples of one rule.
fn range(first: &Parts<'_>, active: &[Active]) -> usize {
    let alike: Vec<f64> = active.iter().map_while(|a| Parts::of(a).filter(|p| p.alike(first)).map(|p| p.at)).collect();
    let Some(step) = alike.windows(2).map(|w| (w[1] - w[0]).abs()).min_by(f64::total_cmp) else { return 1 };
    // A grid that skips zero has one gap of two steps, which no constraint fills. Angles are printed with few digits.
    let near = |w: &[f64]| (w[1] - w[0]).abs() <= 1.6 * step || (w[0] < 0.0 && w[1] > 0.0 && w[1] - w[0] <= 2.1 * step);
    1 + alike.windows(2).take_while(|w| near(w)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drag(angles: impl IntoIterator<Item = i32>) -> Vec<Active> {
        let row = |a: i32| Active { sentence: format!("c_D({a} deg) >= 0"), rule: "drag" };
        angles.into_iter().map(row).collect()
    }

    #[test]
    fn neighbours_on_a_grid_are_one_line_and_others_their_own() {
        assert_eq!(lines(&drag(-45..=45)), ["c_D(-45 to 45 deg) >= 0   (drag, 91 samples)"]);
        assert_eq!(lines(&drag((-3..=3).filter(|a| *a != 0))), ["c_D(-3 to 3 deg) >= 0   (drag, 6 samples)"]);
        let mut some = drag([-45, -44, -43, 10, 11]);
        some.push(Active { sentence: "p0 >= -0.05".into(), rule: "bounds" });
        some.push(Active { sentence: "R'(1.31 m/s) >= 0 N s/m".into(), rule: "resistance_slope" });
        assert_eq!(
            lines(&some),
            [
                "c_D(-45 to -43 deg) >= 0   (drag, 3 samples)",
                "c_D(10 to 11 deg) >= 0   (drag, 2 samples)",
                "p0 >= -0.05   (bounds)",
                "R'(1.31 m/s) >= 0 N s/m   (resistance_slope)",
            ]
        );
        assert!(lines(&[]).is_empty());
    }
}
