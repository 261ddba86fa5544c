//! A helmsman and the actuators he works through: helm and telegraph orders along a plan, rudder and engine that lag behind them.
//! It sees only position, heading, speed and yaw rate; it is a source of realistic inputs, not an autopilot to be judged.

use std::f64::consts::PI;

use super::motion::{Inputs, State};

/// Steering gear and engine: first-order lag under a rate limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Actuators {
    /// Largest rudder rate \[rad/s\].
    pub rudder_rate: f64,
    /// Time constant of the rudder \[s\].
    pub rudder_lag: f64,
    /// Largest change of the propeller rate \[rps/s\].
    pub engine_rate: f64,
    /// Time constant of the engine \[s\].
    pub engine_lag: f64,
}

impl Actuators {
    /// Positions `period` seconds after `at` under a command kept all that time.
    pub fn follow(&self, at: &Inputs, command: &Inputs, period: f64) -> Inputs {
        let reach = |from: f64, to: f64, lag: f64, rate: f64| {
            let step = (to - from) * (1.0 - (-period / lag).exp());
            from + step.clamp(-rate * period, rate * period)
        };
        Inputs {
            n: reach(at.n, command.n, self.engine_lag, self.engine_rate),
            delta: reach(at.delta, command.delta, self.rudder_lag, self.rudder_rate),
        }
    }
}

/// How the helmsman steers during a phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Steer {
    /// Along the route, looking ahead; rudder amidships in sternway.
    Route,
    /// This rudder angle \[rad\].
    Helm(f64),
    /// Steady on the heading at the begin of the phase, altered by this angle \[rad\].
    Alter(f64),
}

/// When a phase ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Until {
    /// After this time \[s\].
    Elapsed(f64),
    /// When the speed ahead has fallen below this \[m/s\].
    SlowerThan(f64),
    /// When the speed ahead has risen above this \[m/s\].
    FasterThan(f64),
    /// When the ship has turned by this angle, either way \[rad\].
    Turned(f64),
}

/// A part of a plan: one telegraph order and one way to steer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// Ordered propeller rate \[rps\].
    pub n: f64,
    /// How to steer.
    pub steer: Steer,
    /// When to go on to the next phase; the last one lasts for ever.
    pub until: Until,
}

/// A leg of a route: sail this far, then the next leg leads off by a change of course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Length \[m\].
    pub length: f64,
    /// Change of course at its end, to starboard positive \[rad\].
    pub alter: f64,
}

/// How a helmsman steers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// Rudder per heading error.
    pub gain: f64,
    /// Counter rudder: rudder per yaw rate made non-dimensional, r L / U.
    pub counter: f64,
    /// Largest rudder order while keeping a course \[rad\].
    pub limit: f64,
    /// Largest rudder there is \[rad\].
    pub stop: f64,
}

/// Smallest change of rudder that is ordered \[rad\].
const DEAD_BAND: f64 = 2.0 * PI / 180.0;

/// A helmsman under way on a plan.
#[derive(Debug, Clone)]
pub struct Helmsman<'a> {
    phases: &'a [Phase],
    style: Style,
    length: f64,
    waypoints: Vec<[f64; 2]>,
    /// Index of the waypoint steered for; the one before it begins the leg.
    target: usize,
    phase: usize,
    phase_began: f64,
    phase_heading: f64,
    helm: f64,
}

impl<'a> Helmsman<'a> {
    /// A helmsman of a ship of `length` \[m\] from `start` at time `t` \[s\] on; the first leg leads along the heading.
    pub fn new(phases: &'a [Phase], legs: &[Leg], style: Style, length: f64, t: f64, start: &State) -> Self {
        let mut course = start.psi;
        let mut waypoints = vec![[start.x, start.y]];
        let mut at = [start.x, start.y];
        for leg in legs {
            at = [at[0] + leg.length * course.cos(), at[1] + leg.length * course.sin()];
            waypoints.push(at);
            course += leg.alter;
        }
        // The last course is kept beyond the last waypoint.
        waypoints.push([at[0] + 1e5 * course.cos(), at[1] + 1e5 * course.sin()]);
        Self {
            phases,
            style,
            length,
            waypoints,
            target: 1,
            phase: 0,
            phase_began: t,
            phase_heading: start.psi,
            helm: 0.0,
        }
    }

    /// Orders at time `t` \[s\] with the ship at `state`: propeller rate \[rps\] and rudder angle \[rad\].
    pub fn order(&mut self, t: f64, state: &State) -> Inputs {
        while self.phase + 1 < self.phases.len() && self.phase_is_over(t, state) {
            self.phase += 1;
            self.phase_began = t;
            self.phase_heading = state.psi;
        }
        let Some(phase) = self.phases.get(self.phase) else { return Inputs::default() };
        let wanted = match phase.steer {
            Steer::Helm(angle) => angle,
            Steer::Alter(_) | Steer::Route if state.u < 0.0 => 0.0,
            Steer::Alter(angle) => self.course_helm(self.phase_heading + angle, state),
            Steer::Route => {
                let course = self.route_course(state);
                self.course_helm(course, state)
            }
        };
        let whole_degrees = wanted.clamp(-self.style.stop, self.style.stop).to_degrees().round().to_radians();
        if (whole_degrees - self.helm).abs() >= DEAD_BAND || whole_degrees == 0.0 {
            self.helm = whole_degrees;
        }
        Inputs { n: phase.n, delta: self.helm }
    }

    fn phase_is_over(&self, t: f64, state: &State) -> bool {
        match self.phases[self.phase].until {
            Until::Elapsed(time) => t - self.phase_began >= time,
            Until::SlowerThan(u) => state.u < u,
            Until::FasterThan(u) => state.u > u,
            Until::Turned(angle) => (state.psi - self.phase_heading).abs() >= angle,
        }
    }

    fn course_helm(&self, course: f64, state: &State) -> f64 {
        let error = wrap(course - state.psi);
        let yaw = state.r * self.length / state.speed().max(1.0);
        (self.style.gain * error - self.style.counter * yaw).clamp(-self.style.limit, self.style.limit)
    }

    /// Course to a point on the leg three ship lengths ahead; turns to the next leg two lengths early.
    fn route_course(&mut self, state: &State) -> f64 {
        loop {
            let (from, to) = (self.waypoints[self.target - 1], self.waypoints[self.target]);
            let (north, east) = (to[0] - from[0], to[1] - from[1]);
            let leg = north.hypot(east).max(1.0);
            let (cos, sin) = (north / leg, east / leg);
            let (dx, dy) = (state.x - from[0], state.y - from[1]);
            let along = dx * cos + dy * sin;
            if leg - along < 2.0 * self.length && self.target + 1 < self.waypoints.len() {
                self.target += 1;
                continue;
            }
            let off = -dx * sin + dy * cos;
            return east.atan2(north) - off.atan2(3.0 * self.length);
        }
    }
}

/// The angle in -pi..=pi.
fn wrap(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::integrate::{MAX_STEP, sail, trimmed_rate};
    use crate::truth::ships::ship_a;

    const STYLE: Style = Style { gain: 1.5, counter: 1.2, limit: 0.44, stop: 0.6 };
    const GEAR: Actuators = Actuators { rudder_rate: 0.05, rudder_lag: 1.0, engine_rate: 0.1, engine_lag: 5.0 };

    #[test]
    fn actuators_never_exceed_their_rates_and_arrive() {
        let command = Inputs { n: -3.0, delta: 0.5 };
        let mut at = Inputs { n: 3.0, delta: -0.5 };
        for _ in 0..200 {
            let next = GEAR.follow(&at, &command, 1.0);
            assert!((next.n - at.n).abs() <= 0.1 + 1e-12 && (next.delta - at.delta).abs() <= 0.05 + 1e-12);
            at = next;
        }
        assert!((at.n + 3.0).abs() < 1e-6 && (at.delta - 0.5).abs() < 1e-6);
    }

    #[test]
    fn helmsman_steers_the_ship_onto_the_second_leg() {
        let truth = ship_a();
        let n = trimmed_rate(&truth, 5.0, 5.0);
        let phases = [Phase { n, steer: Steer::Route, until: Until::Elapsed(0.0) }];
        let legs = [Leg { length: 600.0, alter: 1.0 }];
        let mut state = State { u: 5.0, psi: 2.5, ..State::default() };
        let mut helmsman = Helmsman::new(&phases, &legs, STYLE, 85.0, 0.0, &state);
        let mut at = Inputs { n, delta: 0.0 };
        for i in 0..400 {
            let t = i as f64;
            let next = GEAR.follow(&at, &helmsman.order(t, &state), 1.0);
            state = sail(&truth, &state, [&at, &next], 1.0, MAX_STEP);
            at = next;
        }
        assert!(wrap(state.psi - 3.5).abs() < 0.05, "heading {}", state.psi);
        let (x, y) = (state.x - 600.0 * 2.5_f64.cos(), state.y - 600.0 * 2.5_f64.sin());
        let off = -x * 3.5_f64.sin() + y * 3.5_f64.cos();
        assert!(off.abs() < 20.0, "{off} m off the leg");
    }

    #[test]
    fn phases_follow_each_other_by_their_conditions() {
        let phases = [
            Phase { n: 1.0, steer: Steer::Helm(0.1), until: Until::Elapsed(10.0) },
            Phase { n: -1.0, steer: Steer::Helm(0.0), until: Until::SlowerThan(0.0) },
            Phase { n: 0.0, steer: Steer::Helm(-0.2), until: Until::Elapsed(0.0) },
        ];
        let moving = State { u: 2.0, ..State::default() };
        let mut helmsman = Helmsman::new(&phases, &[], STYLE, 85.0, 0.0, &moving);
        assert_eq!(helmsman.order(0.0, &moving).n, 1.0);
        assert_eq!(helmsman.order(10.0, &moving).n, -1.0);
        assert_eq!(helmsman.order(50.0, &moving).n, -1.0);
        assert_eq!(helmsman.order(51.0, &State { u: -0.1, ..moving }).n, 0.0);
    }
}
