//! Figures and tables of trials: the track with ship outlines, rudder, heading and speed over time, measures in ship lengths.
//! It converts units and computes nothing else.

use super::table::Table;
use crate::maneuver::imo::{Criterion, SHORTEST};
use crate::maneuver::{Ended, Side, Stopping, Track, Trial, Turning, Zigzag};
use crate::numerals::fixed;
use crate::plot::{Axis, BLUE, Color, Figure, GREY, Layer, Panel, VERMILLION, east_north};
use crate::ship::Ship;

/// Colour of a side.
fn color(side: Side) -> Color {
    match side {
        Side::Starboard => BLUE,
        Side::Port => VERMILLION,
    }
}

/// About this many points of a curve are drawn.
const POINTS: usize = 600;
/// Tables of measures are this wide in a terminal.
const WIDTH: u16 = 110;
/// About this many ship outlines on a track.
const OUTLINES: usize = 14;

fn thinned(track: &Track) -> impl Iterator<Item = usize> + Clone {
    let stride = (track.len() / POINTS).max(1);
    let last = track.len().saturating_sub(1);
    (0..track.len()).filter(move |k| k % stride == 0 || *k == last)
}

fn track_panel<'a, M: 'a>(title: &str, ship: &Ship, trials: impl Iterator<Item = &'a Trial<M>>) -> Panel {
    let mut panel = Panel::track(title);
    for trial in trials {
        let (track, color) = (&trial.track, color(trial.side));
        let points = thinned(track).map(|k| east_north(track.states[k][0], track.states[k][1]));
        panel = panel.with(Layer::line(&trial.name, color, points));
        // Outlines at equal distances along the track, no closer than a length and a half.
        let length = track.distance(0, track.len().saturating_sub(1));
        let spacing = (length / OUTLINES as f64).max(1.5 * ship.hull.lpp);
        let mut poses = Vec::new();
        let (mut sailed, mut next) = (0.0, 0.0);
        for k in 0..track.len() {
            if k > 0 {
                sailed += track.distance(k - 1, k);
            }
            if sailed >= next || k + 1 == track.len() {
                let [x, y, psi, ..] = track.states[k];
                poses.push([x, y, psi]);
                next += spacing;
            }
        }
        panel =
            panel.with(Layer::hulls(&trial.name, color, poses, ship.hull.lpp, ship.hull.breadth).unlisted().width(2.0));
    }
    panel
}

fn over_time<M>(trial: &Trial<M>, value: impl Fn(&Track, usize) -> f64) -> Vec<(f64, f64)> {
    thinned(&trial.track).map(|k| (trial.track.t[k], value(&trial.track, k))).collect()
}

fn time_panel<M>(label: &str, trials: &[Trial<M>], value: impl Fn(&Track, usize) -> f64) -> Panel {
    let layers = trials.iter().map(|t| Layer::line(&t.name, color(t.side), over_time(t, &value)));
    Panel::new("", Axis::new("time [s]"), Axis::new(label).including(0.0)).with_all(layers)
}

/// Turning circles to both sides: tracks, heading, rudder, speed and yaw rate.
pub fn turning_figure(ship: &Ship, trials: &[Trial<Turning>]) -> Figure {
    Figure::new(format!("{}: turning circles", ship.name))
        .columns(2)
        .panel_size(900, 640)
        .with(track_panel("", ship, trials.iter()))
        .with(time_panel("heading psi [deg]", trials, |t, k| t.states[k][2].to_degrees()))
        .with(time_panel("rudder delta [deg]", trials, |t, k| t.delta[k].to_degrees()))
        .with(time_panel("speed U [m/s]", trials, Track::speed))
        .with(time_panel("yaw rate r [deg/s]", trials, |t, k| t.states[k][5].to_degrees()))
        .with(time_panel("drift angle beta [deg]", trials, |t, k| (-t.states[k][4]).atan2(t.states[k][3]).to_degrees()))
}

/// Zigzags, a row for each pair of angles: heading and rudder over time with either side first, and both tracks.
pub fn zigzag_figure(ship: &Ship, trials: &[Trial<Zigzag>]) -> Figure {
    let same = |a: &Trial<Zigzag>, b: &Trial<Zigzag>| a.measures.heading == b.measures.heading;
    let mut figure = Figure::new(format!("{}: zigzags", ship.name)).columns(3).panel_size(720, 520);
    for row in trials.chunk_by(same) {
        for trial in row {
            let heading = over_time(trial, |t, k| t.states[k][2].to_degrees());
            let rudder = over_time(trial, |t, k| t.delta[k].to_degrees());
            let limit = trial.measures.heading.to_degrees();
            let first = format!("heading, {} first", trial.side.word());
            figure = figure.with(
                Panel::new(&trial.name, Axis::new("time [s]"), Axis::new("heading, rudder [deg]"))
                    .with(Layer::h_line("heading of execute", GREY, limit).dotted())
                    .with(Layer::h_line("heading of execute", GREY, -limit).dotted().unlisted())
                    .with(Layer::line("rudder", GREY, rudder).dashed())
                    .with(Layer::line(first, color(trial.side), heading)),
            );
        }
        let mut tracks = track_panel("tracks", ship, row.iter());
        tracks.layers = tracks.layers.into_iter().map(Layer::unlisted).collect();
        figure = figure.with(tracks);
    }
    figure
}

/// A crash stop: track, speed, propeller rate and heading.
pub fn stopping_figure(ship: &Ship, trial: &Trial<Stopping>) -> Figure {
    let one = std::slice::from_ref(trial);
    Figure::new(format!("{}: {}", ship.name, trial.name))
        .columns(2)
        .panel_size(900, 560)
        .legend(crate::plot::Legend::Off)
        .with(track_panel("", ship, one.iter()))
        .with(time_panel("surge velocity u [m/s]", one, |t, k| t.states[k][3]))
        .with(time_panel("propeller rate n [rpm]", one, |t, k| t.n[k] * 60.0))
        .with(time_panel("heading psi [deg]", one, |t, k| t.states[k][2].to_degrees()))
}

fn optional(x: Option<f64>, scale: f64, decimals: usize) -> String {
    x.map_or_else(|| "not reached".into(), |x| fixed(x * scale, decimals))
}

/// Turning circles, a row a trial.
pub fn turning_table(ship: &Ship, trials: &[Trial<Turning>]) -> Table {
    let l = 1.0 / ship.hull.lpp;
    let mut table = Table::new([
        "trial",
        "advance [L]",
        "transfer [L]",
        "tactical diameter [L]",
        "steady diameter [L]",
        "speed loss [%]",
        "drift [deg]",
        "time to 90 [s]",
        "time to 180 [s]",
    ]);
    for t in trials {
        let m = &t.measures;
        table.row([
            t.name.clone(),
            optional(m.advance, l, 2),
            optional(m.transfer, l, 2),
            optional(m.tactical_diameter, l, 2),
            optional(m.steady.map(|s| s.diameter), l, 2),
            optional(m.steady.map(|s| s.speed_loss), 100.0, 0),
            optional(m.steady.map(|s| s.drift.to_degrees()), 1.0, 1),
            optional(m.time_90, 1.0, 1),
            optional(m.time_180, 1.0, 1),
        ]);
    }
    table.wrapped(WIDTH)
}

/// Zigzags, a row a trial.
pub fn zigzag_table(ship: &Ship, trials: &[Trial<Zigzag>]) -> Table {
    let mut table = Table::new([
        "trial",
        "overshoot 1 [deg]",
        "overshoot 2 [deg]",
        "overshoot 3 [deg]",
        "initial turning [L]",
        "reach [s]",
        "period [s]",
    ]);
    for t in trials {
        let m = &t.measures;
        let overshoot = |i: usize| optional(m.overshoots.get(i).map(|o| o.to_degrees()), 1.0, 1);
        table.row([
            t.name.clone(),
            overshoot(0),
            overshoot(1),
            overshoot(2),
            optional(m.initial_turning, 1.0 / ship.hull.lpp, 2),
            optional(m.reach, 1.0, 1),
            optional(m.period, 1.0, 1),
        ]);
    }
    table.wrapped(WIDTH)
}

/// A crash stop as a table of one row.
pub fn stopping_table(ship: &Ship, trial: &Trial<Stopping>) -> Table {
    let (m, l) = (&trial.measures, 1.0 / ship.hull.lpp);
    let mut table = Table::new([
        "trial",
        "track reach [L]",
        "head reach [L]",
        "lateral deviation [L]",
        "heading change [deg]",
        "time [s]",
    ]);
    table.row([
        trial.name.clone(),
        optional(m.track_reach, l, 2),
        optional(m.head_reach, l, 2),
        optional(m.lateral_deviation, l, 2),
        optional(m.heading_change.map(f64::to_degrees), 1.0, 1),
        optional(m.time, 1.0, 1),
    ]);
    table.wrapped(WIDTH)
}

/// The IMO criteria beside the measures, a row a criterion.
pub fn criteria_table<'a>(trials: impl IntoIterator<Item = (&'a str, &'a [Criterion])>) -> Table {
    let mut table = Table::new(["trial", "IMO MSC.137(76)", "measured", "limit", "unit", "verdict"]);
    for (name, criteria) in trials {
        for c in criteria {
            let number = |x: Option<f64>| x.map_or_else(|| crate::numerals::DASH.into(), |x| fixed(x, 2));
            table.row([
                name.to_owned(),
                c.name.clone(),
                number(c.measured),
                number(c.limit),
                c.unit.to_owned(),
                c.verdict.word().to_owned(),
            ]);
        }
    }
    table
}

/// A note on the criteria for a ship that the standard does not bind.
pub fn criteria_note(ship: &Ship) -> Option<String> {
    (ship.hull.lpp < SHORTEST).then(|| {
        format!(
            "The standard binds ships of {SHORTEST:.0} m and more; for L = {} m its limits are shown for comparison.",
            crate::numerals::sig(ship.hull.lpp, 3)
        )
    })
}

/// How a trial ended, if it is not complete.
pub fn ended_note<M>(trial: &Trial<M>) -> Option<String> {
    match trial.ended {
        Ended::Complete => None,
        Ended::TimeOut { after } => {
            Some(format!("{}: not complete after {after:.0} s (200 ship lengths at approach speed).", trial.name))
        }
        Ended::Diverged { after } => Some(format!(
            "{}: the simulation diverged after {after:.1} s; the model is not usable there (set `step` in [maneuver] to rule out the integration).",
            trial.name
        )),
    }
}

/// The sailed track as CSV, SI units and radians, in the layout of a recording.
pub fn track_csv(track: &Track) -> String {
    let mut text = String::from("t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]\n");
    for k in 0..track.len() {
        let [x, y, psi, u, v, r] = track.states[k];
        text.push_str(&format!("{},{x},{y},{psi},{u},{v},{r},{},{}\n", track.t[k], track.n[k], track.delta[k]));
    }
    text
}
