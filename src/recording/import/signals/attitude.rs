//! The yaw of an attitude that is recorded as a unit quaternion, as inertial units and ROS write it.
//! What it counts from, and to which side, is decided with every heading.

use super::log::{Column, Log, Meaning};
use crate::recording::Channel;
use crate::recording::import::columns::names::meaning;

/// Ends of the names of w, x, y and z.
const ENDS: [[&str; 4]; 3] = [["w", "x", "y", "z"], ["0]", "1]", "2]", "3]"], ["0", "1", "2", "3"]];
/// What the names begin with or contain otherwise.
const WORDS: [&str; 4] = ["quat", "orientation", "attitude", "rotation"];
/// By how much a unit quaternion may miss its length: numbers of two decimals.
const UNIT: f64 = 0.02;

/// Puts the yaw of the first quaternion in its place in a log that has no other heading.
pub fn add_heading(log: &mut Log) {
    let heading = Meaning::Channel(Channel::Psi);
    if log.columns.iter().any(|c| c.meaning.or_else(|| meaning(&c.name)) == Some(heading)) {
        return;
    }
    let found = log.columns.iter().find_map(|scalar| quaternion(scalar, &log.columns));
    let Some((parts, yaw)) = found.and_then(|parts| Some((parts.map(|c| c.name.clone()), yaw(parts)?))) else { return };
    log.columns.retain(|c| !parts.contains(&c.name));
    log.columns.push(yaw);
}

/// The components w, x, y and z, where a column is the first of them.
fn quaternion<'a>(scalar: &'a Column, columns: &'a [Column]) -> Option<[&'a Column; 4]> {
    let name = scalar.name.to_lowercase();
    ENDS.iter().find_map(|[w, vector @ ..]| {
        let stem = name.strip_suffix(w)?;
        let letter = stem.trim_end_matches(['_', '.', '[']);
        let is_q = letter == "q" || [" q", ".q", "_q", "/q"].iter().any(|end| letter.ends_with(end));
        if !is_q && !WORDS.iter().any(|word| stem.contains(word)) {
            return None;
        }
        let other = |end: &str| columns.iter().find(|c| c.name.to_lowercase() == format!("{stem}{end}"));
        Some([scalar, other(vector[0])?, other(vector[1])?, other(vector[2])?])
    })
}

/// `atan2(2 (w z + x y), 1 - 2 (y^2 + z^2))` of unit quaternions; `None` where they are none.
fn yaw(parts: [&Column; 4]) -> Option<Column> {
    let [w, x, y, z] = parts;
    if w.v.is_empty() || parts.iter().any(|c| c.t != w.t) {
        return None;
    }
    let length = |i: usize| parts.iter().map(|c| c.v[i] * c.v[i]).sum::<f64>().sqrt();
    if (0..w.v.len()).any(|i| (length(i) - 1.0).abs() > UNIT) {
        return None;
    }
    let of = |i: usize| {
        let (w, x, y, z) = (w.v[i], x.v[i], y.v[i], z.v[i]);
        (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z))
    };
    Some(Column {
        name: format!("yaw of {}", parts.map(|c| c.name.as_str()).join(" ")),
        unit: Some("rad".to_owned()),
        meaning: Some(Meaning::Channel(Channel::Psi)),
        t: w.t.clone(),
        v: (0..w.v.len()).map(of).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::import::signals::log::Clock;

    fn log(names: [&str; 4], yaws: &[f64], scale: f64) -> Log {
        let column = |(i, name): (usize, &&str)| {
            let of = |yaw: &f64| scale * [(0.5 * yaw).cos(), 0.0, 0.0, (0.5 * yaw).sin()][i];
            let t = (0..yaws.len()).map(|k| k as f64).collect();
            Column { name: (*name).to_owned(), t, v: yaws.iter().map(of).collect(), ..Column::default() }
        };
        let columns = names.iter().enumerate().map(column).collect();
        let (path, format) = ("a.csv".into(), String::new());
        Log { path, format, clock: Clock::Own, columns, texts: Vec::new(), notes: Vec::new() }
    }

    #[test]
    fn the_yaw_of_a_quaternion_is_a_heading_by_any_of_its_names() {
        let yaws = [0.3, -2.0, 3.0];
        for names in [
            ["qw", "qx", "qy", "qz"],
            ["q[0]", "q[1]", "q[2]", "q[3]"],
            ["q0", "q1", "q2", "q3"],
            ["pose.orientation.w", "pose.orientation.x", "pose.orientation.y", "pose.orientation.z"],
        ] {
            let mut log = log(names, &yaws, 1.0);
            add_heading(&mut log);
            let found = log.columns.last().unwrap();
            assert_eq!((found.meaning, log.columns.len()), (Some(Meaning::Channel(Channel::Psi)), 1), "{names:?}");
            assert!(found.v.iter().zip(&yaws).all(|(a, b)| (a - b).abs() < 1e-12), "{names:?}");
        }
    }

    #[test]
    fn numbers_that_are_no_unit_quaternion_and_a_log_with_a_heading_are_left() {
        let mut scaled = log(["qw", "qx", "qy", "qz"], &[0.3, 1.0], 1.1);
        let mut others = log(["w", "x", "y", "z"], &[0.3, 1.0], 1.0);
        let mut headed = log(["qw", "qx", "qy", "qz"], &[0.3, 1.0], 1.0);
        headed.columns.push(Column { name: "heading".into(), t: vec![0.0], v: vec![1.0], ..Column::default() });
        for (log, count) in [(&mut scaled, 4), (&mut others, 4), (&mut headed, 5)] {
            add_heading(log);
            assert_eq!(log.columns.len(), count);
        }
    }
}
