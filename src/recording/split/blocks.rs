//! Divides a recording into stretches by steering, propeller and turning: the rules, with their numbers.
//! Every row is in exactly one stretch, so that nothing is lost.

use super::controls::{Controls, size_below};
use super::stretch::{Kind, Stretch};
use std::ops::Range;

/// A rudder is put over beyond the first angle and amidships again within the second \[rad\]: 6 and 3.5 deg.
const PUT_OVER: f64 = 0.105;
const AMIDSHIPS: f64 = 0.061;
/// The same of a yaw rate, as shares of that below which it lies for nineteen twentieths of the time: those of 20 deg of rudder.
const TURNING: f64 = 0.3;
const STEADY: f64 = 0.175;
/// A turn changes the heading by this at least \[rad\]: 80 deg.
const TURN: f64 = 1.4;
/// Between two sides of a zigzag the heading changes by this at most \[rad\]: 100 deg.
const ZIGZAG_SIDE: f64 = 1.75;
/// Sides of a zigzag, at least.
const ZIGZAG_SIDES: usize = 3;
/// A propeller below this share of its usual rate is stopped.
const STOPPED: f64 = 0.25;
/// Speed changes by this share from the first to the last third of an approach.
const SETTLING: f64 = 0.08;
/// Times the time scale: shorter pauses between two sides of a zigzag are the rudder's way across.
const ACROSS: f64 = 3.0;
/// Times the time scale: shorter stretches amidships belong to what surrounds them.
const SHORTEST: f64 = 2.0;

/// Rows while the ship is steered to one side: -1, 0 or 1.
struct Side {
    side: i8,
    rows: Range<usize>,
}

/// The stretches of controls, in order, without gaps between them; `scale` is the time scale of the motion \[s\].
pub fn stretches(c: &Controls, scale: f64) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let stops = stops(c, scale);
    let mut from = 0;
    for stop in stops {
        if stop.start > from {
            stretches.extend(steered(c, from..stop.start, scale));
        }
        let astern = c.n[stop.clone()].iter().any(|n| *n < 0.0);
        let why = format!("propeller {}", if astern { "astern" } else { "stopped" });
        from = stop.end;
        stretches.push(Stretch { kind: Kind::Stop, rows: stop, why });
    }
    if from < c.len() {
        stretches.extend(steered(c, from..c.len(), scale));
    }
    merged(c, stretches, scale)
}

/// Rows in which the propeller is stopped or astern, from just before it changes.
fn stops(c: &Controls, scale: f64) -> Vec<Range<usize>> {
    let usual = size_below(c.n.iter().copied().filter(|n| *n > 0.0), 0.6);
    if usual <= 0.0 {
        return Vec::new();
    }
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut start = None;
    for i in 0..=c.len() {
        let stopped = i < c.n.len() && c.n[i] < STOPPED * usual;
        match (start, stopped) {
            (None, true) => start = Some(i),
            (Some(from), false) => {
                let lasts = c.t[i - 1] - c.t[from] >= scale;
                // A ship that lies still with its propeller stopped does no manoeuvre.
                let moves = c.speed[from].is_nan() || c.speed[from] > 0.1 * size_below(c.speed.iter().copied(), 0.95);
                if lasts && moves {
                    found.push(back(c, from, scale)..i);
                }
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// The row `seconds` before another.
fn back(c: &Controls, row: usize, seconds: f64) -> usize {
    c.t[..row].partition_point(|t| *t < c.t[row] - seconds)
}

/// Rows by the side to which the ship is steered, with hysteresis; `rows` is not empty.
fn sides(c: &Controls, rows: Range<usize>) -> Vec<Side> {
    let mut found: Vec<Side> = Vec::new();
    let mut side = 0_i8;
    let [over, amidships] = if c.by_rudder {
        [PUT_OVER, AMIDSHIPS]
    } else {
        let fast = size_below(c.steering.iter().copied(), 0.95);
        [TURNING * fast, STEADY * fast]
    };
    for i in rows {
        let d = c.steering[i];
        side = match side {
            _ if d > over => 1,
            _ if d < -over => -1,
            1 if d > amidships => 1,
            -1 if d < -amidships => -1,
            _ => 0,
        };
        match found.last_mut() {
            Some(last) if last.side == side => last.rows.end = i + 1,
            _ => found.push(Side { side, rows: i..i + 1 }),
        }
    }
    found
}

fn lasts(c: &Controls, rows: &Range<usize>) -> f64 {
    c.t[rows.end - 1] - c.t[rows.start] + c.step
}

fn change(c: &Controls, rows: &Range<usize>) -> f64 {
    c.psi[(rows.end).min(c.len() - 1)] - c.psi[rows.start]
}

/// Stretches of rows with the propeller ahead.
fn steered(c: &Controls, rows: Range<usize>, scale: f64) -> Vec<Stretch> {
    let sides = sides(c, rows);
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut i = 0;
    while i < sides.len() {
        if sides[i].side == 0 {
            stretches.push(amidships(c, sides[i].rows.clone()));
            i += 1;
            continue;
        }
        let last = zigzag_end(c, &sides, i, scale);
        let count = sides[i..=last].iter().filter(|h| h.side != 0).count();
        if count >= ZIGZAG_SIDES {
            let rows = sides[i].rows.start..sides[last].rows.end;
            let why = format!("{count} times over, {}", size(c, &rows, 0.8));
            stretches.push(Stretch { kind: Kind::Zigzag, rows, why });
            i = last + 1;
        } else {
            stretches.push(one_side(c, &sides[i]));
            i += 1;
        }
    }
    stretches
}

/// The last of the sides that follow one another as in a zigzag, from `first` on.
fn zigzag_end(c: &Controls, sides: &[Side], first: usize, scale: f64) -> usize {
    let (mut last, mut i) = (first, first + 1);
    while let Some(next) = sides.get(i) {
        let pause = next.side == 0;
        if pause && lasts(c, &next.rows) > ACROSS * scale {
            break;
        }
        if !pause {
            let small = change(c, &sides[last].rows).abs() < ZIGZAG_SIDE && change(c, &next.rows).abs() < ZIGZAG_SIDE;
            if next.side != -sides[last].side || !small {
                break;
            }
            last = i;
        }
        i += 1;
    }
    last
}

/// The steering below which a share of rows lies, in words.
fn size(c: &Controls, rows: &Range<usize>, share: f64) -> String {
    let size = size_below(c.steering[rows.clone()].iter().copied(), share).to_degrees();
    if c.by_rudder { format!("{size:.0} deg") } else { format!("{size:.1} deg/s") }
}

fn one_side(c: &Controls, one: &Side) -> Stretch {
    let turned = change(c, &one.rows);
    let size = size(c, &one.rows, 0.5);
    let side = if one.side > 0 { "starboard" } else { "port" };
    let what = if c.by_rudder { "rudder" } else { "turning" };
    let kind = if turned.abs() >= TURN { Kind::Turn } else { Kind::Free };
    let why = format!("{what} {size} to {side}, heading changes by {:.0} deg", turned.to_degrees().abs());
    Stretch { kind, rows: one.rows.clone(), why }
}

fn amidships(c: &Controls, rows: Range<usize>) -> Stretch {
    let third = (rows.len() / 3).max(1);
    let mean = |rows: Range<usize>| {
        let some: Vec<f64> = c.speed[rows].iter().copied().filter(|v| v.is_finite()).collect();
        some.iter().sum::<f64>() / some.len().max(1) as f64
    };
    let (begin, end) = (mean(rows.start..rows.start + third), mean(rows.end - third..rows.end));
    let settling = (end - begin).abs() > SETTLING * begin.max(end) && begin.max(end) > 0.0;
    let kind = if settling { Kind::Approach } else { Kind::Straight };
    let what = if c.by_rudder { "rudder amidships" } else { "next to no turning" };
    Stretch { kind, rows, why: format!("{what}, {begin:.1} to {end:.1} m/s") }
}

/// Joins stretches that are too short to be one, and lets a manoeuvre begin shortly before the rudder moves.
fn merged(c: &Controls, stretches: Vec<Stretch>, scale: f64) -> Vec<Stretch> {
    let mut joined: Vec<Stretch> = Vec::new();
    for next in stretches {
        let short = |s: &Stretch| {
            lasts(c, &s.rows) < SHORTEST * scale && !matches!(s.kind, Kind::Turn | Kind::Zigzag | Kind::Stop)
        };
        match joined.last_mut() {
            // What is too short by itself joins what came before it: the end of a manoeuvre, or irregular steering.
            Some(last) if short(&next) => last.rows.end = next.rows.end,
            Some(last) if short(last) => {
                let start = last.rows.start;
                *last = Stretch { rows: start..next.rows.end, ..next };
            }
            Some(last) if last.kind == Kind::Free && next.kind == Kind::Free => {
                last.rows.end = next.rows.end;
                "irregular steering".clone_into(&mut last.why);
            }
            Some(last) if last.kind == Kind::Straight && next.kind == Kind::Straight => last.rows.end = next.rows.end,
            _ => joined.push(next),
        }
    }
    for i in 1..joined.len() {
        let steady = matches!(joined[i - 1].kind, Kind::Straight | Kind::Approach);
        if steady && matches!(joined[i].kind, Kind::Turn | Kind::Zigzag | Kind::Free) {
            let lead = back(c, joined[i].rows.start, 2.0 * scale).max(joined[i - 1].rows.start);
            // The straight run keeps most of its rows.
            if lead - joined[i - 1].rows.start > joined[i - 1].rows.len() / 2 {
                joined[i - 1].rows.end = lead;
                joined[i].rows.start = lead;
            }
        }
    }
    joined
}
