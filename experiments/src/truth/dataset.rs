//! The data sets of ships A and B: seeded port approaches, departures and sea passages sailed by a helmsman on a truth simulator.
//! It decides what is sailed; the physics is the simulator's, and nothing is added to what is recorded, no noise either.
//!
//! The paper prints no time step. Here a manoeuvre is 120 steps of 2 s for ship A and of 3 s for ship B, recorded in 121 rows:
//! 240 s and 360 s, some 10 ship lengths at the mean speed of either ship. Orders are given at the rows and the actuators move in
//! a straight line from row to row, so that inputs interpolated linearly between rows are exactly those that moved the ship.

use std::io;
use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::helmsman::{Actuators, Helmsman, Leg, Phase, Steer, Style, Until};
use super::ships::ShipId;
use super::{Environment, Inputs, MAX_STEP, State, Truth, sail, trimmed_rate};

/// Steps of a recorded manoeuvre: 120 intervals, 121 rows.
pub const STEPS: usize = 120;
/// The seed of the data sets that the figures are made from, fixed before anything was looked at.
pub const SEED: u64 = 20_250_226;
/// Header of a recording, as the library reads it.
pub const HEADER: [&str; 9] =
    ["t [s]", "x [m]", "y [m]", "psi [rad]", "u [m/s]", "v [m/s]", "r [rad/s]", "n [rps]", "delta [rad]"];

/// Which part of the data a run belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Split {
    /// Fitted to.
    Train,
    /// Held out, 12.5 % of the runs.
    Test,
}

/// A recorded manoeuvre.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Name, unique in its data set: `ship_a_017`.
    pub name: String,
    /// Train or test.
    pub split: Split,
    /// What was done.
    pub manoeuvre: &'static str,
    /// Time from the first row \[s\].
    pub t: Vec<f64>,
    /// `[x, y, psi, u, v, r]` of each row, SI.
    pub state: Vec<[f64; 6]>,
    /// Propeller rate \[rps\].
    pub n: Vec<f64>,
    /// Rudder angle \[rad\].
    pub delta: Vec<f64>,
}

/// All that a helmsman is told before a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Name of the run.
    pub name: String,
    /// Train or test.
    pub split: Split,
    /// What is done.
    pub manoeuvre: &'static str,
    /// Speed ahead at which the lead-in begins \[m/s\].
    pub speed: f64,
    /// Heading there \[rad\].
    pub heading: f64,
    /// Time sailed before the first row, so that she is recorded in the middle of things \[s\].
    pub lead: f64,
    /// Telegraph and helm.
    pub phases: Vec<Phase>,
    /// The route, for those phases that follow it.
    pub legs: Vec<Leg>,
    /// The helmsman's style.
    pub style: Style,
}

/// What the generator knows of a ship.
struct Service {
    runs: usize,
    period: f64,
    actuators: Actuators,
    /// Manoeuvres and the share of each.
    programme: &'static [(Manoeuvre, f64)],
}

type Manoeuvre = fn(&mut Draw) -> Sketch;

/// The part of a [`Plan`] that a manoeuvre decides.
struct Sketch {
    manoeuvre: &'static str,
    speed: f64,
    phases: Vec<Phase>,
    legs: Vec<Leg>,
}

fn service(ship: ShipId) -> Service {
    let degrees = std::f64::consts::PI / 180.0;
    match ship {
        ShipId::A => Service {
            runs: 165,
            period: 2.0,
            actuators: Actuators {
                rudder_rate: 4.0 * degrees,
                rudder_lag: 1.0,
                engine_rate: 8.0 / 60.0,
                engine_lag: 5.0,
            },
            programme: &[
                (approach_a, 0.28),
                (departure_a, 0.25),
                (harbour_turn_a, 0.18),
                (crash_stop_a, 0.07),
                (astern_a, 0.05),
                (open_sea_a, 0.17),
            ],
        },
        ShipId::B => Service {
            runs: 100,
            period: 3.0,
            actuators: Actuators {
                rudder_rate: 2.8 * degrees,
                rudder_lag: 1.5,
                engine_rate: 4.0 / 60.0,
                engine_lag: 6.0,
            },
            programme: &[
                (approach_b, 0.32),
                (departure_b, 0.17),
                (harbour_turn_b, 0.16),
                (crash_stop_b, 0.08),
                (open_sea_b, 0.27),
            ],
        },
    }
}

/// The sample period of the recordings of a ship \[s\].
pub fn period(ship: ShipId) -> f64 {
    service(ship).period
}

/// The data set of a ship: her truth simulator in calm water, sailed on [`plans`].
pub fn dataset(ship: ShipId, seed: u64) -> Vec<Run> {
    dataset_with(ship.truth().as_ref(), ship, seed, &Environment::default())
}

/// The same plans sailed on another truth or in another environment: an altered copy of a ship, a current, an extra force.
pub fn dataset_with(truth: &dyn Truth, ship: ShipId, seed: u64, environment: &Environment) -> Vec<Run> {
    plans(ship, seed).iter().map(|plan| record(truth, ship, plan, environment)).collect()
}

/// The plans of a data set, 12.5 % of them drawn for the test: 21 of 165 for ship A, 13 of 100 for ship B.
///
/// Each run draws from a stream of its own, so that a change to one leaves the others as they are; so does the split.
pub fn plans(ship: ShipId, seed: u64) -> Vec<Plan> {
    let service = service(ship);
    let first_stream = match ship {
        ShipId::A => 0,
        ShipId::B => 1 << 32,
    };
    let stream = |i: usize| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(first_stream + i as u64);
        rng
    };
    let splits = split(service.runs, &mut stream(0));
    let of_run = |(i, split): (usize, Split)| {
        let mut draw = Draw { rng: stream(i + 1) };
        let sketch = pick(service.programme, (i as f64 + 0.5) / service.runs as f64)(&mut draw);
        Plan {
            name: format!("{}_{:03}", ship.name(), i + 1),
            split,
            manoeuvre: sketch.manoeuvre,
            speed: sketch.speed,
            heading: draw.between(0.0, 2.0 * std::f64::consts::PI),
            lead: service.period * draw.between(10.0, 25.0).round(),
            phases: sketch.phases,
            legs: sketch.legs,
            style: Style {
                gain: draw.between(1.0, 2.0),
                counter: draw.between(0.8, 1.5),
                limit: draw.between(15.0, 30.0).to_radians(),
                stop: match ship {
                    ShipId::A => 35.0_f64.to_radians(),
                    ShipId::B => 40.0_f64.to_radians(),
                },
            },
        }
    };
    splits.into_iter().enumerate().map(of_run).collect()
}

/// A random eighth of the runs (rounded) for the test, by Fisher and Yates.
fn split(runs: usize, rng: &mut ChaCha8Rng) -> Vec<Split> {
    let mut order: Vec<usize> = (0..runs).collect();
    for i in (1..runs).rev() {
        order.swap(i, rng.random_range(0..=i));
    }
    let mut splits = vec![Split::Train; runs];
    for &i in &order[..(0.125 * runs as f64).round() as usize] {
        splits[i] = Split::Test;
    }
    splits
}

/// The manoeuvre at this fraction of a data set, so that each has its share exactly and not by luck.
fn pick(programme: &[(Manoeuvre, f64)], fraction: f64) -> Manoeuvre {
    let total: f64 = programme.iter().map(|(_, share)| share).sum();
    let mut left = fraction * total;
    for (manoeuvre, share) in programme {
        if left < *share {
            return *manoeuvre;
        }
        left -= share;
    }
    // Only rounding of the sum leads here.
    programme[0].0
}

/// Sails a plan and records it. The environment sees the time from the first row, negative in the lead-in.
pub fn record(truth: &dyn Truth, ship: ShipId, plan: &Plan, environment: &Environment) -> Run {
    let Service { period, actuators, .. } = service(ship);
    let mut state = State { psi: plan.heading, u: plan.speed, ..State::default() };
    // She comes in at the rate that holds her speed, or with the engine stopped.
    let mut inputs =
        Inputs { n: if plan.speed > 1.0 { trimmed_rate(truth, plan.speed, 6.0) } else { 0.0 }, delta: 0.0 };
    let lead = (plan.lead / period).round() as i64;
    let length = truth.particulars().length;
    let mut helmsman = Helmsman::new(&plan.phases, &plan.legs, plan.style, length, -plan.lead, &state);
    let mut run = Run {
        name: plan.name.clone(),
        split: plan.split,
        manoeuvre: plan.manoeuvre,
        t: Vec::with_capacity(STEPS + 1),
        state: Vec::with_capacity(STEPS + 1),
        n: Vec::with_capacity(STEPS + 1),
        delta: Vec::with_capacity(STEPS + 1),
    };
    for i in -lead..=STEPS as i64 {
        let t = i as f64 * period;
        if i >= 0 {
            run.t.push(t);
            run.state.push(state.to_array());
            run.n.push(inputs.n);
            run.delta.push(inputs.delta);
        }
        let next = actuators.follow(&inputs, &helmsman.order(t, &state), period);
        state = sail(truth, t, &state, &inputs, &next, period, MAX_STEP, environment);
        inputs = next;
    }
    run
}

/// Draws for the plans.
struct Draw {
    rng: ChaCha8Rng,
}

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.rng.random_range(low..high)
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    fn side(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// A telegraph order, drawn in rpm.
    fn rpm(&mut self, low: f64, high: f64) -> f64 {
        self.between(low, high) / 60.0
    }

    /// A rudder order to either side, drawn in degrees.
    fn helm(&mut self, low: f64, high: f64) -> Steer {
        let side = self.side();
        Steer::Helm(side * self.between(low, high).to_radians())
    }

    /// A route of `count` legs of so many metres, with changes of course in degrees to either side.
    fn legs(&mut self, count: usize, metres: [f64; 2], degrees: [f64; 2]) -> Vec<Leg> {
        (0..count)
            .map(|_| Leg {
                length: self.between(metres[0], metres[1]),
                alter: self.side() * self.between(degrees[0], degrees[1]).to_radians(),
            })
            .collect()
    }
}

fn phase(n: f64, steer: Steer, until: Until) -> Phase {
    Phase { n, steer, until }
}

/// In from sea: round the bends of the fairway, speed taken off in steps, stopped with a kick astern.
fn approach_a(d: &mut Draw) -> Sketch {
    let mut phases = vec![
        phase(d.rpm(110.0, 190.0), Steer::Route, Until::Elapsed(d.between(40.0, 110.0))),
        phase(d.rpm(70.0, 120.0), Steer::Route, Until::Elapsed(d.between(40.0, 100.0))),
        phase(d.rpm(30.0, 70.0), Steer::Route, Until::Elapsed(d.between(40.0, 120.0))),
    ];
    if d.chance(0.5) {
        phases.push(phase(-d.rpm(80.0, 180.0), Steer::Helm(0.0), Until::SlowerThan(d.between(-0.3, 0.5))));
        phases.push(phase(0.0, Steer::Helm(0.0), Until::Elapsed(20.0)));
    }
    phases.push(phase(d.rpm(30.0, 60.0), Steer::Route, Until::Elapsed(0.0)));
    Sketch { manoeuvre: "approach", speed: d.between(3.5, 6.5), phases, legs: d.legs(3, [200.0, 450.0], [15.0, 80.0]) }
}

/// Off the berth and out: a kick ahead with hard rudder to bring her round, then up through the telegraph along the fairway.
fn departure_a(d: &mut Draw) -> Sketch {
    let phases = vec![
        phase(d.rpm(80.0, 150.0), d.helm(15.0, 35.0), Until::Turned(d.between(10.0, 60.0).to_radians())),
        phase(d.rpm(60.0, 120.0), Steer::Route, Until::Elapsed(d.between(20.0, 70.0))),
        phase(d.rpm(110.0, 170.0), Steer::Route, Until::Elapsed(d.between(40.0, 100.0))),
        phase(d.rpm(150.0, 220.0), Steer::Route, Until::Elapsed(0.0)),
    ];
    Sketch { manoeuvre: "departure", speed: d.between(0.2, 2.0), phases, legs: d.legs(3, [180.0, 400.0], [15.0, 70.0]) }
}

/// Turned short round in the basin: hard rudder with kicks ahead, astern between them to hold her up.
fn harbour_turn_a(d: &mut Draw) -> Sketch {
    let side = d.side();
    let hard = side * d.between(25.0, 34.0).to_radians();
    let mut phases = vec![
        phase(d.rpm(50.0, 100.0), Steer::Route, Until::Elapsed(d.between(10.0, 60.0))),
        phase(d.rpm(100.0, 200.0), Steer::Helm(hard), Until::Turned(d.between(40.0, 100.0).to_radians())),
    ];
    if d.chance(0.6) {
        phases.push(phase(-d.rpm(80.0, 170.0), Steer::Helm(-hard), Until::SlowerThan(d.between(-0.8, 0.8))));
        phases.push(phase(d.rpm(90.0, 160.0), Steer::Helm(hard), Until::Turned(d.between(30.0, 90.0).to_radians())));
    }
    phases.push(phase(d.rpm(40.0, 110.0), Steer::Alter(0.0), Until::Elapsed(0.0)));
    Sketch {
        manoeuvre: "harbour turn",
        speed: d.between(1.5, 4.5),
        phases,
        legs: d.legs(2, [300.0, 500.0], [5.0, 30.0]),
    }
}

/// Full astern from way on, some until she gathers sternway, then stopped.
fn crash_stop_a(d: &mut Draw) -> Sketch {
    let phases = vec![
        phase(d.rpm(120.0, 220.0), Steer::Route, Until::Elapsed(d.between(25.0, 70.0))),
        phase(-d.rpm(150.0, 249.0), Steer::Helm(0.0), Until::SlowerThan(d.between(-1.5, 0.3))),
        phase(0.0, Steer::Helm(0.0), Until::Elapsed(d.between(20.0, 60.0))),
        phase(d.rpm(50.0, 110.0), d.helm(5.0, 30.0), Until::Elapsed(0.0)),
    ];
    Sketch { manoeuvre: "crash stop", speed: d.between(4.0, 7.5), phases, legs: d.legs(1, [250.0, 600.0], [5.0, 40.0]) }
}

/// Backed out of a narrow berth, then checked with a kick ahead.
fn astern_a(d: &mut Draw) -> Sketch {
    let phases = vec![
        phase(-d.rpm(110.0, 249.0), Steer::Helm(0.0), Until::Elapsed(d.between(60.0, 140.0))),
        phase(0.0, Steer::Helm(0.0), Until::Elapsed(d.between(0.0, 30.0))),
        phase(d.rpm(90.0, 180.0), d.helm(15.0, 34.0), Until::FasterThan(d.between(0.5, 2.0))),
        phase(d.rpm(70.0, 130.0), Steer::Alter(0.0), Until::Elapsed(0.0)),
    ];
    Sketch { manoeuvre: "astern", speed: d.between(-0.5, 0.5), phases, legs: Vec::new() }
}

/// At sea: full ahead, altering course, now and then with hard rudder.
fn open_sea_a(d: &mut Draw) -> Sketch {
    let n = d.rpm(190.0, 250.0);
    let mut phases = vec![phase(n, Steer::Route, Until::Elapsed(d.between(60.0, 140.0)))];
    if d.chance(0.5) {
        phases.push(phase(n, d.helm(22.0, 33.0), Until::Turned(d.between(50.0, 120.0).to_radians())));
    }
    phases.push(phase(n, Steer::Alter(0.0), Until::Elapsed(0.0)));
    Sketch { manoeuvre: "open sea", speed: d.between(6.0, 8.0), phases, legs: d.legs(2, [400.0, 900.0], [10.0, 50.0]) }
}

/// As [`approach_a`], for a ship that takes longer to stop.
fn approach_b(d: &mut Draw) -> Sketch {
    let mut phases = vec![
        phase(d.rpm(100.0, 150.0), Steer::Route, Until::Elapsed(d.between(60.0, 160.0))),
        phase(d.rpm(70.0, 110.0), Steer::Route, Until::Elapsed(d.between(60.0, 160.0))),
        phase(d.rpm(30.0, 70.0), Steer::Route, Until::Elapsed(d.between(60.0, 180.0))),
    ];
    if d.chance(0.3) {
        phases.push(phase(-d.rpm(60.0, 110.0), Steer::Helm(0.0), Until::SlowerThan(d.between(0.2, 1.5))));
        phases.push(phase(0.0, Steer::Helm(0.0), Until::Elapsed(30.0)));
    }
    phases.push(phase(d.rpm(30.0, 60.0), Steer::Route, Until::Elapsed(0.0)));
    Sketch { manoeuvre: "approach", speed: d.between(3.5, 5.5), phases, legs: d.legs(3, [300.0, 700.0], [10.0, 60.0]) }
}

/// As [`departure_a`].
fn departure_b(d: &mut Draw) -> Sketch {
    let phases = vec![
        phase(d.rpm(70.0, 130.0), d.helm(15.0, 40.0), Until::Turned(d.between(10.0, 50.0).to_radians())),
        phase(d.rpm(80.0, 120.0), Steer::Route, Until::Elapsed(d.between(30.0, 100.0))),
        phase(d.rpm(110.0, 150.0), Steer::Route, Until::Elapsed(0.0)),
    ];
    Sketch { manoeuvre: "departure", speed: d.between(0.6, 2.5), phases, legs: d.legs(3, [300.0, 600.0], [10.0, 60.0]) }
}

/// Hard over at harbour speed with a kick ahead, then steadied or put over to the other side.
fn harbour_turn_b(d: &mut Draw) -> Sketch {
    let side = d.side();
    let hard = side * d.between(25.0, 40.0).to_radians();
    let mut phases = vec![
        phase(d.rpm(60.0, 100.0), Steer::Route, Until::Elapsed(d.between(20.0, 90.0))),
        phase(d.rpm(80.0, 140.0), Steer::Helm(hard), Until::Turned(d.between(40.0, 110.0).to_radians())),
    ];
    if d.chance(0.4) {
        phases.push(phase(d.rpm(60.0, 120.0), Steer::Helm(-hard), Until::Turned(d.between(30.0, 80.0).to_radians())));
    }
    phases.push(phase(d.rpm(50.0, 110.0), Steer::Alter(0.0), Until::Elapsed(0.0)));
    Sketch {
        manoeuvre: "harbour turn",
        speed: d.between(2.0, 4.5),
        phases,
        legs: d.legs(2, [300.0, 500.0], [5.0, 30.0]),
    }
}

/// Full astern from way on; the engine is stopped when she is nearly dead in the water.
fn crash_stop_b(d: &mut Draw) -> Sketch {
    let phases = vec![
        phase(d.rpm(70.0, 130.0), Steer::Route, Until::Elapsed(d.between(40.0, 90.0))),
        phase(-d.rpm(110.0, 160.0), Steer::Helm(0.0), Until::SlowerThan(d.between(-0.6, 0.8))),
        phase(0.0, Steer::Helm(0.0), Until::Elapsed(d.between(30.0, 60.0))),
        phase(d.rpm(40.0, 90.0), d.helm(5.0, 35.0), Until::Elapsed(0.0)),
    ];
    Sketch { manoeuvre: "crash stop", speed: d.between(2.5, 4.5), phases, legs: d.legs(1, [300.0, 700.0], [5.0, 40.0]) }
}

/// As [`open_sea_a`].
fn open_sea_b(d: &mut Draw) -> Sketch {
    let n = d.rpm(130.0, 170.0);
    let mut phases = vec![phase(n, Steer::Route, Until::Elapsed(d.between(90.0, 220.0)))];
    if d.chance(0.5) {
        phases.push(phase(n, d.helm(15.0, 40.0), Until::Turned(d.between(30.0, 100.0).to_radians())));
    }
    phases.push(phase(n, Steer::Alter(0.0), Until::Elapsed(0.0)));
    Sketch { manoeuvre: "open sea", speed: d.between(4.8, 6.1), phases, legs: d.legs(2, [500.0, 1200.0], [10.0, 45.0]) }
}

/// Smallest, largest and mean value of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Mean over all rows of all runs; None where the paper prints none.
    pub mean: Option<f64>,
}

/// The channels of the paper's Table 1, in its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Surge velocity \[m/s\].
    pub u: Spread,
    /// Sway velocity \[m/s\].
    pub v: Spread,
    /// Yaw rate \[rad/s\].
    pub r: Spread,
    /// Propeller rate \[rpm\].
    pub n: Spread,
    /// Rudder angle \[deg\].
    pub delta: Spread,
}

impl Statistics {
    /// Name, unit and spread of each channel, in the order of the paper.
    pub fn channels(&self) -> [(&'static str, &'static str, Spread); 5] {
        [
            ("u", "m/s", self.u),
            ("v", "m/s", self.v),
            ("r", "rad/s", self.r),
            ("n", "rpm", self.n),
            ("delta", "deg", self.delta),
        ]
    }
}

/// Statistics over all rows of the runs of one part; None if it has no runs.
pub fn statistics(runs: &[Run], split: Split) -> Option<Statistics> {
    let part: Vec<&Run> = runs.iter().filter(|run| run.split == split).collect();
    let spread = |channel: &dyn Fn(&Run, usize) -> f64| {
        let (mut min, mut max, mut sum, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0_usize);
        for run in &part {
            for i in 0..run.t.len() {
                let value = channel(run, i);
                (min, max, sum, count) = (min.min(value), max.max(value), sum + value, count + 1);
            }
        }
        (count > 0).then(|| Spread { min, max, mean: Some(sum / count as f64) })
    };
    Some(Statistics {
        u: spread(&|run, i| run.state[i][3])?,
        v: spread(&|run, i| run.state[i][4])?,
        r: spread(&|run, i| run.state[i][5])?,
        n: spread(&|run, i| 60.0 * run.n[i])?,
        delta: spread(&|run, i| run.delta[i].to_degrees())?,
    })
}

/// Table 1 of the paper (arXiv 2502.18696), whose data sets these stand in for.
pub fn paper_statistics(ship: ShipId, split: Split) -> Statistics {
    let spread = |min, max, mean| Spread { min, max, mean };
    let [u, v, r, n, delta] = match (ship, split) {
        (ShipId::A, Split::Train) => [
            spread(-4.47, 8.23, Some(3.27)),
            spread(-2.05, 1.76, None),
            spread(-0.03, 0.03, None),
            spread(-249.1, 249.4, Some(95.0)),
            spread(-32.5, 33.5, Some(1.2)),
        ],
        (ShipId::A, Split::Test) => [
            spread(1.47, 7.38, Some(4.0)),
            spread(-1.74, 1.76, None),
            spread(-0.03, 0.03, None),
            spread(-129.4, 245.9, Some(129.1)),
            spread(-26.9, 27.9, None),
        ],
        (ShipId::B, Split::Train) => [
            spread(-0.47, 6.17, Some(3.83)),
            spread(-1.04, 1.03, None),
            spread(-0.02, 0.02, None),
            spread(-158.8, 169.7, Some(93.3)),
            spread(-40.0, 40.0, Some(-1.0)),
        ],
        (ShipId::B, Split::Test) => [
            spread(0.1, 5.45, Some(3.71)),
            spread(-0.57, 0.54, None),
            spread(-0.01, 0.01, None),
            spread(-98.9, 168.8, Some(88.8)),
            spread(-39.5, 32.6, None),
        ],
    };
    Statistics { u, v, r, n, delta }
}

/// Writes a run as a recording: one CSV file with [`HEADER`], SI units, at full precision.
pub fn write_csv(run: &Run, path: &Path) -> io::Result<()> {
    let mut writer = csv::Writer::from_path(path).map_err(io::Error::other)?;
    writer.write_record(HEADER).map_err(io::Error::other)?;
    for i in 0..run.t.len() {
        let [x, y, psi, u, v, r] = run.state[i];
        let row = [run.t[i], x, y, psi, u, v, r, run.n[i], run.delta[i]].map(|value| value.to_string());
        writer.write_record(row).map_err(io::Error::other)?;
    }
    writer.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHIPS: [ShipId; 2] = [ShipId::A, ShipId::B];

    #[test]
    fn training_statistics_are_like_the_paper_s() {
        for ship in SHIPS {
            let ours = statistics(&dataset(ship, SEED), Split::Train).expect("there are training runs");
            let paper = paper_statistics(ship, Split::Train);
            for ((name, unit, ours), (_, _, paper)) in ours.channels().into_iter().zip(paper.channels()) {
                let range = paper.max - paper.min;
                let near = |a: f64, b: f64, share: f64| (a - b).abs() <= share * range;
                assert!(near(ours.min, paper.min, 0.25), "{ship:?} min {name} {} {unit}", ours.min);
                assert!(near(ours.max, paper.max, 0.25), "{ship:?} max {name} {} {unit}", ours.max);
                if let (Some(ours), Some(paper)) = (ours.mean, paper.mean) {
                    assert!(near(ours, paper, 0.10), "{ship:?} mean {name} {ours} {unit}");
                }
            }
        }
    }

    #[test]
    fn data_sets_have_the_paper_s_size_and_an_eighth_of_test_runs() {
        for (ship, runs, tests) in [(ShipId::A, 165, 21), (ShipId::B, 100, 13)] {
            let plans = plans(ship, 7);
            assert_eq!(plans.len(), runs);
            assert_eq!(plans.iter().filter(|plan| plan.split == Split::Test).count(), tests);
        }
    }

    #[test]
    fn same_seed_gives_the_same_bits_and_another_seed_other_runs() {
        let plans = plans(ShipId::A, 3);
        let truth = ShipId::A.truth();
        let sail = |plan: &Plan| record(truth.as_ref(), ShipId::A, plan, &Environment::default());
        for plan in plans.iter().step_by(40) {
            assert_eq!(sail(plan), sail(plan));
        }
        assert_eq!(plans, super::plans(ShipId::A, 3));
        assert_ne!(plans, super::plans(ShipId::A, 4));
    }

    #[test]
    fn every_row_is_finite_and_every_run_has_120_steps() {
        for ship in SHIPS {
            for run in dataset(ship, 11) {
                assert_eq!([run.t.len(), run.state.len(), run.n.len(), run.delta.len()], [STEPS + 1; 4]);
                assert!(run.t[0] == 0.0 && (run.t[STEPS] - STEPS as f64 * period(ship)).abs() < 1e-9);
                let inputs = run.n.iter().chain(&run.delta);
                assert!(run.state.iter().flatten().chain(inputs).all(|x| x.is_finite()), "{}", run.name);
            }
        }
    }

    #[test]
    fn rows_hold_all_that_moved_the_ship() {
        // Sailed again from the first row with the recorded inputs, linear between rows.
        let ship = ShipId::B;
        let truth = ship.truth();
        for plan in plans(ship, 5).iter().step_by(17) {
            let run = record(truth.as_ref(), ship, plan, &Environment::default());
            let mut state = State::from_array(run.state[0]);
            let inputs = |i: usize| Inputs { n: run.n[i], delta: run.delta[i] };
            for i in 0..STEPS {
                let calm = Environment::default();
                state = sail(truth.as_ref(), 0.0, &state, &inputs(i), &inputs(i + 1), period(ship), MAX_STEP, &calm);
            }
            assert_eq!(state.to_array(), run.state[STEPS]);
        }
    }

    #[test]
    fn current_in_the_environment_reaches_the_recording() {
        let truth = ShipId::A.truth();
        let plan = &plans(ShipId::A, 5)[0];
        let current = Environment { current: [0.5, 0.0], extra: None };
        let calm = record(truth.as_ref(), ShipId::A, plan, &Environment::default());
        assert_ne!(record(truth.as_ref(), ShipId::A, plan, &current).state, calm.state);
    }

    #[test]
    fn csv_gives_back_every_bit() {
        let run = record(ShipId::A.truth().as_ref(), ShipId::A, &plans(ShipId::A, 1)[0], &Environment::default());
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("run.csv");
        write_csv(&run, &path).expect("written");
        let mut reader = csv::Reader::from_path(&path).expect("readable");
        assert_eq!(reader.headers().expect("a header"), &HEADER[..]);
        let rows: Vec<Vec<f64>> = reader
            .records()
            .map(|row| row.expect("a row").iter().map(|cell| cell.parse().expect("a number")).collect())
            .collect();
        assert_eq!(rows.len(), STEPS + 1);
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(row[0], run.t[i]);
            assert_eq!(row[1..7], run.state[i]);
            assert_eq!(row[7..], [run.n[i], run.delta[i]]);
        }
    }
}
