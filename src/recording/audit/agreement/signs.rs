//! Signs and axes: the track against the recorded velocity, sway against the slide of the track, the turn against the rudder.
//! Wrong units of velocity show here too, by their gain; heading against yaw rate is in `units`.

use super::units::{SPEED_GAINS, known_gain};
use crate::numerals::sig;
use crate::recording::Channel;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{
    AGAINST, AGAINST_RUDDER, AGAINST_TURN, ASTERN_SHARE, ASTERN_SPEED, CALIBRATED, COHERENT, EXPLAINS, LEVER_SHARE,
    LEVER_TURN, MIRROR_LEAVES, MIRRORED, NO_CALIBRATION, NOT_MIRRORED, SIGN_EVIDENCE, SWAY_COHERENCE, SWAY_LEAVES,
    TRACK_ANGLES, TRACK_ERRORS, TURNED, UNTURNED,
};
use crate::recording::audit::motion::clocks::Pair;
use crate::recording::audit::motion::course::Course;
use crate::recording::audit::motion::kinematics::{Kinematics, Proportion};
use crate::recording::audit::motion::response::Curve;
use crate::recording::audit::motion::series::Series;
use std::collections::BTreeMap;
use std::ops::Range;

/// Track against velocity: sums over rows of the track's velocity, the recorded one turned by the heading (along the earth's axes),
/// and the recorded one as it is (along the ship's).
#[derive(Default)]
pub struct Track {
    count: f64,
    track: f64,
    earth: f64,
    /// Scalar and vector product of track and velocity.
    along: f64,
    across: f64,
    /// Square of their difference.
    difference: f64,
    /// Of the track with the velocity not turned.
    unturned: f64,
    /// Scalar and vector product of the mirrored track and velocity.
    mirror_along: f64,
    mirror_across: f64,
    /// Slide of the track to starboard against v, and their difference against r.
    sway: Proportion,
    lever: Proportion,
    longest: Pair,
    /// How surely ratio and angle are known.
    course: Course,
}

impl Track {
    /// Adds some rows. Where v was not recorded it counts as 0, and sway is not compared.
    pub fn add(&mut self, series: &Series<'_>) {
        let [Some(x), Some(y), Some(psi)] = [Channel::X, Channel::Y, Channel::Psi].map(|c| series.get(c)) else {
            return;
        };
        let Some(u) = series.recorded(Channel::U) else { return };
        let none = vec![0.0; u.len()];
        let v = match (series.recorded(Channel::V), series.get(Channel::V)) {
            (Some(v), _) => v,
            (None, Some(_)) => return,
            (None, None) => none.as_slice(),
        };
        let with_sway = series.get(Channel::V).is_some();
        let rows = x.len();
        let north: Vec<f64> = (0..rows).map(|i| u[i] * psi[i].cos() - v[i] * psi[i].sin()).collect();
        let east: Vec<f64> = (0..rows).map(|i| u[i] * psi[i].sin() + v[i] * psi[i].cos()).collect();
        self.course.add(series, [x, y], [&north, &east]);
        for s in &series.stretches {
            let smooth = |values: &[f64]| series.smooth(values, s);
            let (dx, dy) = (series.slope(x, s), series.slope(y, s));
            let (n, e, ub, vb) = (smooth(&north), smooth(&east), smooth(u), smooth(v));
            let r = series.get(Channel::R).map_or_else(|| series.slope(psi, s), smooth);
            for i in 0..s.len() {
                let (track, earth, body) = ([dx[i], dy[i]], [n[i], e[i]], [ub[i], vb[i]]);
                self.add_row(track, earth, body, psi[s.start + i], r[i], with_sway);
            }
            let speed = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a.hypot(*b)).collect::<Vec<f64>>();
            self.longest.offer(speed(&dx, &dy), speed(&n, &e), series.step);
        }
    }

    fn add_row(&mut self, track: [f64; 2], earth: [f64; 2], body: [f64; 2], psi: f64, r: f64, with_sway: bool) {
        if !track.iter().chain(&earth).chain(&body).chain([&psi, &r]).all(|v| v.is_finite()) {
            return;
        }
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let apart = [track[0] - earth[0], track[1] - earth[1]];
        self.count += 1.0;
        self.track += dot(track, track);
        self.earth += dot(earth, earth);
        self.along += dot(track, earth);
        self.across += track[1] * earth[0] - track[0] * earth[1];
        self.difference += dot(apart, apart);
        self.unturned += dot(track, body);
        self.mirror_along += track[0] * earth[0] - track[1] * earth[1];
        self.mirror_across += track[0] * earth[1] + track[1] * earth[0];
        if with_sway {
            let (sin, cos) = psi.sin_cos();
            let slide = track[1] * cos - track[0] * sin;
            self.sway.add(&[slide], &[body[1]]);
            self.lever.add(&[slide - body[1]], &[r]);
        }
    }

    /// Speed of the track as a multiple of the velocity, where the two go together.
    pub fn gain(&self) -> Option<f64> {
        let both = self.along.hypot(self.across);
        (self.earth > 0.0 && both > COHERENT * (self.track * self.earth).sqrt()).then(|| both / self.earth)
    }

    /// Reports what all rows show; `turn` is the gain of the heading on the yaw rate.
    pub fn tell(&self, kinematics: &mut Kinematics, turn: Option<f64>, issues: &mut Vec<Issue>) {
        if self.track <= 0.0 || self.earth <= 0.0 {
            return;
        }
        let size = (self.track * self.earth).sqrt();
        let coherence = self.along.hypot(self.across) / size;
        let angle = self.across.atan2(self.along);
        kinematics.velocity_rms = Some((self.difference / self.count).sqrt());
        kinematics.velocity_gain = Some(self.along.hypot(self.across) / self.earth);
        kinematics.track_angle = Some(angle);
        kinematics.velocity_coherence = Some(coherence);
        if let Some(axes) = self.wrong_frame(size).or_else(|| self.mirrored(turn)) {
            issues.push(axes);
            return;
        }
        if coherence > COHERENT {
            if self.wrong_velocity(angle.to_degrees(), self.along.hypot(self.across) / self.earth, turn, issues) {
                return;
            }
        } else if !self.sway_turned() {
            let rms = (self.difference / self.count).sqrt();
            let text =
                format!("track and velocity agree poorly (coherence {coherence:.2}, rms difference {rms:.3} m/s)");
            let next = "check axes, units and reference point of x, y, u and v";
            issues.push(Issue::new(Severity::Warning, "disagreement", text, next).of(Channel::U));
        }
        self.tell_sway(kinematics, turn, issues);
        kinematics.velocity_lag = self.longest.lag();
        self.longest.tell(kinematics.velocity_lag, Channel::U, "the position", issues);
    }

    /// How much of the track follows the mirror image of the velocity, turned by any angle.
    fn along_mirror(&self) -> f64 {
        self.mirror_along.hypot(self.mirror_across)
    }

    /// Velocities along other axes than the ship's.
    fn wrong_frame(&self, size: f64) -> Option<Issue> {
        // On a course near due north a heading counted from east leaves the track along the ship's velocity, too; its mirror image leaves less.
        let mirrored = 1.0 - self.along_mirror() / size < MIRROR_LEAVES * (1.0 - self.unturned / size);
        if self.unturned / size > UNTURNED && self.along / size < TURNED && !mirrored {
            let text = "u and v follow the track along the earth's axes, not the ship's";
            let next = "set `velocity_frame = \"earth\"` in a column map";
            return Some(Issue::new(Severity::Error, "axes_error", text, next).of(Channel::U));
        }
        None
    }

    /// Adds the course of a track whose velocity was not recorded, as if the ship sailed where it heads.
    pub fn add_course(&mut self, series: &Series<'_>) {
        let track = [Channel::X, Channel::Y, Channel::Psi].map(|c| series.recorded(c));
        let ([Some(x), Some(y), Some(psi)], None) = (track, series.recorded(Channel::U)) else { return };
        for s in &series.stretches {
            for ((dx, dy), psi) in series.slope(x, s).into_iter().zip(series.slope(y, s)).zip(&psi[s.clone()]) {
                let speed = dx.hypot(dy);
                self.add_row([dx, dy], [speed * psi.cos(), speed * psi.sin()], [speed, 0.0], *psi, 0.0, false);
            }
        }
    }

    /// A mirror image; `turn` is the gain of the heading on the yaw rate.
    pub fn mirrored(&self, turn: Option<f64>) -> Option<Issue> {
        let size = (self.track * self.earth).sqrt();
        let coherence = self.along.hypot(self.across) / size;
        let mirrored = self.along_mirror() / size;
        // On a straight course a mirror image and a turned one are the same; heading must vary for the two to differ.
        if mirrored > MIRRORED && coherence < NOT_MIRRORED && 1.0 - mirrored < MIRROR_LEAVES * (1.0 - coherence) {
            let text = "the track is the mirror image of what heading and velocity say";
            // Where the mirror lies between north and east, the two are exchanged, or the heading counts from east.
            let diagonal = self.mirror_across.abs() > self.mirror_along.abs();
            let next = match (turn.is_some_and(|turn| turn < 0.0), diagonal) {
                (true, true) => {
                    "is the heading counted anticlockwise from east? `psi = { sign = -1, offset = 90 }`, for one in deg, in a column map makes it clockwise from north"
                }
                (true, false) => {
                    "is y positive to port, or heading counted anticlockwise? The yaw rate agrees with the heading: set `sign = -1` for `psi` in a column map"
                }
                (false, true) => {
                    "are x and y exchanged, or heading and yaw rate counted anticlockwise, from east? exchange them, or set `sign = -1` for `r` and `psi = { sign = -1, offset = 90 }`, for one in deg, in a column map"
                }
                (false, false) => {
                    "is y positive to port, or are heading and yaw rate counted anticlockwise? set `sign = -1`, for `y` or for `psi` and `r`, in a column map"
                }
            };
            return Some(Issue::new(Severity::Error, "axes_error", text, next).of(Channel::Psi));
        }
        None
    }

    /// Direction and speed of the track against the velocity's; true when a unit or a sign is plainly wrong.
    fn wrong_velocity(&self, degrees: f64, gain: f64, turn: Option<f64>, issues: &mut Vec<Issue>) -> bool {
        let mut push = |severity, fault, channel, text: String, next: &str| {
            issues.push(Issue::new(severity, fault, text, next).of(channel));
        };
        let [backward, wrong, offset] = TRACK_ANGLES;
        if degrees.abs() > backward {
            let text = "the ship moves against its recorded velocity".to_owned();
            let next = "set `sign = -1` for u and v in a column map, or `offset` for psi by half a turn";
            push(Severity::Error, "sign_error", Channel::U, text, next);
            return true;
        }
        let [(ratio, ratio_error), (angle, angle_error)] =
            self.course.ratio_and_angle().unwrap_or([(gain, 0.0), (degrees.to_radians(), 0.0)]);
        let (degrees, uncertain) = (angle.to_degrees(), TRACK_ERRORS * angle_error.to_degrees());
        // Without v, a ship that drifts in turns seems to run beside its heading.
        if degrees.abs() > offset + uncertain && self.sway.known() && !self.sway_turned() {
            let severity = if degrees.abs() > wrong { Severity::Error } else { Severity::Warning };
            let text = format!("the track runs {degrees:.1} deg clockwise of heading and velocity");
            let next = "is the heading offset, or a current left out? `offset` in a column map corrects a heading";
            push(severity, "axes_error", Channel::Psi, text, next);
        }
        let next = "correct `unit` of u and v, or of x and y, in a column map";
        if let Some(meaning) = known_gain(gain, turn, &SPEED_GAINS, next) {
            let text = format!("the track is {} times as fast as the velocity: {}", sig(gain, 3), meaning.text);
            push(Severity::Error, meaning.fault, Channel::U, text, meaning.next);
            return true;
        }
        if !(1.0 / NO_CALIBRATION..NO_CALIBRATION).contains(&gain) {
            let text = format!("the track is {} times as fast as the velocity, as no calibration is", sig(gain, 3));
            let next = "a unit is another than declared: are x and y latitude and longitude in degrees (import them with `--column lat=NAME --column lon=NAME`)? Or correct `unit` of x and y, of u and v, or of t in a column map";
            push(Severity::Error, "unit_error", Channel::U, text, next);
            return true;
        }
        if (ratio - 1.0).abs() > CALIBRATED + TRACK_ERRORS * ratio_error {
            let text = format!("the track is {ratio:.3} times as fast as the velocity");
            let next = "check the log (`scale` in a column map), through-water against over-ground speed, and the units of x and y";
            push(Severity::Warning, "calibration", Channel::U, text, next);
        }
        false
    }

    /// Whether the track slides to the other side than v says: that turns the velocity, too, and its consequences are not reported as well.
    fn sway_turned(&self) -> bool {
        let known = self.lever.known() && self.sway.known();
        known && self.sway.rms_sum() < SWAY_LEAVES * self.sway.rms() && self.sway.coherence() < SWAY_COHERENCE
    }

    /// Sway of the track against recorded sway: a lever arm between the two points, or a turned sign.
    fn tell_sway(&self, kinematics: &mut Kinematics, turn: Option<f64>, issues: &mut Vec<Issue>) {
        // Where r itself is wrong, a slide in proportion to it is no evidence of a lever.
        let sound = turn.is_none_or(|turn| (turn - 1.0).abs() < LEVER_TURN);
        if !self.lever.known() {
            return;
        }
        kinematics.lever = Some(self.lever.gain());
        if !self.sway.known() {
            return;
        }
        if self.sway_turned() {
            let text = format!("sway of the track is {:.2} times the recorded v", self.sway.gain());
            let next = "is v positive to port? set `sign = -1` for `v` in a column map";
            issues.push(Issue::new(Severity::Error, "sign_error", text, next).of(Channel::V));
        } else if sound
            && self.lever.coherence().abs() > COHERENT
            && self.lever.rms_a() > LEVER_SHARE * self.sway.rms_b()
        {
            let lever = self.lever.gain();
            let text = format!(
                "in turns the track slides as if positions were taken {:.2} m {} of the point whose velocity is recorded",
                lever.abs(),
                if lever > 0.0 { "forward" } else { "aft" }
            );
            let next = "give `reference_point` and `velocity_point` in a column map";
            issues.push(Issue::new(Severity::Warning, "lever", text, next).of(Channel::V));
        }
    }
}

/// Rudder and propeller of the wrong sign: what they do to yaw and surge, run by run, and steady turns against the rudder.
#[derive(Default)]
pub struct Actuators {
    rudder: Effect,
    /// Runs ahead with the propeller astern, and all runs.
    astern: [usize; 2],
    /// Of rudder and yaw rate: products, squares.
    products: [f64; 3],
    /// Rows, and change of heading \[rad\].
    rows: f64,
    turned: f64,
}

/// The effect of an actuator over runs.
#[derive(Default)]
pub struct Effect {
    /// Evidence that it acts to its own side, less evidence that it acts to the other.
    evidence: f64,
    /// Shares of the squares of the response that are left with it, one a run.
    left: f64,
    /// Runs.
    runs: f64,
    /// By lag, the reduction of these shares where it acts to its own side at that lag.
    late: BTreeMap<isize, f64>,
}

impl Effect {
    /// Adds the evidence of a run.
    pub fn add(&mut self, curve: Option<&Curve>) {
        let Some(curve) = curve else { return };
        let zero = curve.zero();
        self.evidence += curve.side();
        self.left += curve.left[zero] / curve.without;
        self.runs += 1.0;
        for (i, lag) in curve.lags.iter().enumerate().filter(|(i, _)| curve.sign[*i] > 0.0) {
            *self.late.entry(*lag).or_default() += 1.0 - curve.left[i] / curve.without;
        }
    }

    /// Whether it acts to the other side in all runs together, and no lag that they share explains that as well: in one run a rudder that
    /// swings to and fro cannot be distinguished from a turned one when it is half a period late.
    pub fn turned(&self) -> bool {
        let is_late = self.late.values().any(|spared| self.runs - spared < self.left);
        self.evidence < -SIGN_EVIDENCE && self.left < EXPLAINS * self.runs && !is_late
    }
}

impl Actuators {
    /// Adds some rows; `rudder` is the response to the rudder.
    pub fn add(&mut self, series: &Series<'_>, rudder: Option<&Curve>) {
        self.rudder.add(rudder);
        self.astern[0] += usize::from(ahead_with_propeller_astern(series));
        self.astern[1] += 1;
        let (Some(delta), Some(r)) = (series.delta.as_deref(), series.get(Channel::R)) else { return };
        let (u, n) = (series.get(Channel::U), series.n.as_deref());
        let ahead = |values: Option<&[f64]>, row: usize| values.is_none_or(|v| v[row] > 0.0);
        for row in series.stretches.iter().flat_map(Range::clone).filter(|row| ahead(u, *row) && ahead(n, *row)) {
            let (delta, r) = (delta[row], r[row]);
            if delta.is_finite() && r.is_finite() {
                [delta * r, delta * delta, r * r].iter().zip(&mut self.products).for_each(|(new, sum)| *sum += new);
                self.rows += 1.0;
                self.turned += r * series.step;
            }
        }
    }

    /// Reports what all rows show.
    pub fn tell(&self, issues: &mut Vec<Issue>) {
        let [both, delta, r] = self.products;
        let (turns, together) = (self.turned.abs() > AGAINST_TURN, both / (delta * r).sqrt());
        let steered = turns && delta > AGAINST_RUDDER * AGAINST_RUDDER * self.rows;
        // A steady turn shows its side by itself; how the yaw rate answers shows only where it changes.
        let with = steered && together > -AGAINST;
        if (self.rudder.turned() && !with) || (steered && together < AGAINST) {
            let next = "is the rudder positive to port? set `sign = -1` for `delta` in a column map";
            let issue = Issue::new(Severity::Error, "sign_error", "the ship turns against its rudder", next);
            issues.push(issue.of(Channel::Delta));
        }
        if self.astern[0] * 2 > self.astern[1] {
            let next = "is the rate positive astern? set `sign = -1` for `n` in a column map";
            let text = "the propeller turns astern and the ship sails on ahead";
            issues.push(Issue::new(Severity::Error, "sign_error", text, next).of(Channel::N));
        }
    }
}

/// Whether the propeller turns astern nearly all the time and the ship sails ahead and does not stop.
fn ahead_with_propeller_astern(series: &Series<'_>) -> bool {
    let Some((n, u)) = series.n.as_deref().zip(series.get(Channel::U)) else { return false };
    let rows: Vec<usize> = (0..n.len()).filter(|i| n[*i].is_finite() && u[*i].is_finite()).collect();
    let astern = rows.iter().filter(|i| n[**i] < 0.0 && u[**i] > 0.0).count();
    let third = rows.len() / 3;
    let mean = |rows: &[usize]| rows.iter().map(|i| u[*i]).sum::<f64>() / rows.len() as f64;
    third > 0
        && astern as f64 > ASTERN_SHARE * rows.len() as f64
        && mean(&rows[rows.len() - third..]) > ASTERN_SPEED * mean(&rows[..third])
}
