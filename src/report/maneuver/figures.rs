//! Figures of trials: the track with ship outlines, and rudder, heading and speed over time.
//! Nothing is computed here beyond units; measures are in `tables`.

use super::annotate::{circles, overshoots};
use crate::evaluate::maneuver::{PullOut, Side, Spiral, Stopping, Track, Trial, Turning, Zigzag};
use crate::numerals::sig;
use crate::report::plot::{Axis, BLUE, Color, Figure, GREY, Layer, Legend, Panel, VERMILLION, east_north};
use crate::ship::Ship;

/// Colour of a side.
fn color(side: Side) -> Color {
    match side {
        Side::Starboard => BLUE,
        Side::Port => VERMILLION,
    }
}

/// A line of a side: port is dashed, so that the sides are distinguished without colours too.
fn styled(side: Side, line: Layer) -> Layer {
    match side {
        Side::Starboard => line,
        Side::Port => line.dashed(),
    }
}

/// About this many points of a curve are drawn.
const POINTS: usize = 600;
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
        panel = panel.with(styled(trial.side, Layer::line(&trial.name, color, points)));
        let poses = outlines(track, ship.hull.lpp);
        panel =
            panel.with(Layer::hulls(&trial.name, color, poses, ship.hull.lpp, ship.hull.breadth).unlisted().width(2.0));
    }
    panel
}

/// Positions and headings at equal distances along a track, no closer than a length and a half.
fn outlines(track: &Track, lpp: f64) -> Vec<[f64; 3]> {
    let length = track.distance(0, track.len().saturating_sub(1));
    let spacing = (length / OUTLINES as f64).max(1.5 * lpp);
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
    poses
}

fn over_time<M>(trial: &Trial<M>, value: impl Fn(&Track, usize) -> f64) -> Vec<(f64, f64)> {
    thinned(&trial.track).map(|k| (trial.track.t[k], value(&trial.track, k))).collect()
}

fn time_panel<M>(label: &str, trials: &[Trial<M>], value: impl Fn(&Track, usize) -> f64) -> Panel {
    let layers = trials.iter().map(|t| styled(t.side, Layer::line(&t.name, color(t.side), over_time(t, &value))));
    Panel::new("", Axis::new("time [s]"), Axis::new(label).including(0.0)).with_all(layers)
}

fn heading_panel<M>(trials: &[Trial<M>]) -> Panel {
    let panel = time_panel("heading psi [deg]", trials, |t, k| t.states[k][2].to_degrees());
    Panel { y: panel.y.clone().angle(), ..panel }
}

/// What the brackets in a figure are; nothing where no trial has intervals.
fn in_brackets<M>(trials: &[Trial<M>]) -> &'static str {
    if trials.iter().any(|t| !t.intervals.is_empty()) { " In brackets: 95 % intervals." } else { "" }
}

/// Turning circles to both sides: tracks, heading, rudder, speed and yaw rate.
pub fn turning_figure(ship: &Ship, trials: &[Trial<Turning>]) -> Figure {
    let (measured, lowest) = circles(trials, ship.hull.lpp, color);
    let mut circles = track_panel("", ship, trials.iter()).with_all(measured);
    circles.y = circles.y.including(lowest);
    let caption = format!(
        "Turning circles to both sides; L = {} m. Advance: distance ahead at 90 deg of change of heading; transfer and tactical diameter: \
         distance abeam at 90 and 180 deg, all of the midship point from where the rudder begins to move. Arrows: advance ahead, \
         transfer abeam at its end, tactical diameter abeam.{}",
        sig(ship.hull.lpp, 4),
        in_brackets(trials)
    );
    Figure::new(format!("{}: turning circles", ship.name))
        .columns(2)
        .panel_size(900, 760)
        .caption(caption)
        .with(circles)
        .with(heading_panel(trials))
        .with(time_panel("rudder delta [deg]", trials, |t, k| t.delta[k].to_degrees()))
        .with(time_panel("speed U [m/s]", trials, Track::speed))
        .with(time_panel("yaw rate r [deg/s]", trials, |t, k| t.states[k][5].to_degrees()))
        .with(time_panel("drift angle beta [deg]", trials, |t, k| (-t.states[k][4]).atan2(t.states[k][3]).to_degrees()))
}

/// Zigzags, a row for each pair of angles: heading and rudder over time with either side first, and both tracks.
pub fn zigzag_figure(ship: &Ship, trials: &[Trial<Zigzag>]) -> Figure {
    let same = |a: &Trial<Zigzag>, b: &Trial<Zigzag>| a.measures.heading == b.measures.heading;
    let caption = format!(
        "Zigzags to both sides first: heading and rudder, the overshoot angle at each peak of heading, and the tracks.{}",
        in_brackets(trials)
    );
    let mut figure = Figure::new(format!("{}: zigzags", ship.name)).columns(3).panel_size(720, 520).caption(caption);
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
                    .with(Layer::line(first, color(trial.side), heading))
                    .with_all(overshoots(trial, color(trial.side))),
            );
        }
        let mut tracks = track_panel("tracks", ship, row.iter());
        tracks.layers = tracks.layers.into_iter().map(Layer::unlisted).collect();
        figure = figure.with(tracks);
    }
    figure
}

/// Pull-outs from both sides: yaw rate, rudder, tracks and speed.
pub fn pull_out_figure(ship: &Ship, trials: &[Trial<PullOut>]) -> Figure {
    Figure::new(format!("{}: pull-outs", ship.name))
        .columns(2)
        .panel_size(900, 560)
        .caption(
            "Pull-outs from steady turns to both sides: the yaw rates of a ship that is stable on its course come together with the rudder amidships.",
        )
        .with(time_panel("yaw rate r [deg/s]", trials, |t, k| t.states[k][5].to_degrees()))
        .with(time_panel("rudder delta [deg]", trials, |t, k| t.delta[k].to_degrees()))
        .with(track_panel("", ship, trials.iter()))
        .with(time_panel("speed U [m/s]", trials, Track::speed))
}

/// A spiral: the steady yaw rate over the rudder angle, there and back.
pub fn spiral_figure(ship: &Ship, trial: &Trial<Spiral>) -> Figure {
    let points: Vec<(f64, f64)> =
        trial.measures.points.iter().map(|p| (p[0].to_degrees(), p[1].to_degrees())).collect();
    let half = points.len() / 2;
    let pass = |name: &str, color, points: &[(f64, f64)]| Layer::line(name, color, points.iter().copied());
    let mut panel = Panel::new("", Axis::new("rudder delta [deg]"), Axis::new("steady yaw rate r [deg/s]"))
        .with(Layer::h_line("no turn", GREY, 0.0).dotted().unlisted());
    if half > 0 {
        panel = panel
            .with(pass("from starboard to port", BLUE, &points[..=half]))
            .with(pass("from port to starboard", VERMILLION, &points[half..]).dashed());
    }
    Figure::new(format!("{}: {}", ship.name, trial.name))
        .panel_size(900, 640)
        .caption("Direct spiral: the steady yaw rate at each rudder angle, from starboard to port and back. A ship that is unstable on its course has two rates at small angles.")
        .with(panel)
}

/// A crash stop: track, speed, propeller rate and heading.
pub fn stopping_figure(ship: &Ship, trial: &Trial<Stopping>) -> Figure {
    let one = std::slice::from_ref(trial);
    Figure::new(format!("{}: {}", ship.name, trial.name))
        .columns(2)
        .panel_size(900, 560)
        .caption("Crash stop from the instant the propeller is reversed: track with ship outlines, speed, propeller rate and heading.")
        .legend(Legend::Off)
        .with(track_panel("", ship, one.iter()))
        .with(time_panel("surge velocity u [m/s]", one, |t, k| t.states[k][3]))
        .with(time_panel("propeller rate n [rpm]", one, |t, k| t.n[k] * 60.0))
        .with(heading_panel(one))
}
