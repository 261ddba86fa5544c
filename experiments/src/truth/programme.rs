//! The manoeuvres of the data sets of ships A and B: port approaches, departures, harbour turns, stops and sea passages.
//! Each draws its own speeds, orders and route; the plans are put together in `dataset`.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::helmsman::{Actuators, Leg, Phase, Steer, Until};
use super::ships::ShipId;

/// Size, sampling, actuators and manoeuvres of a ship's data set.
pub struct Service {
    /// Number of runs.
    pub runs: usize,
    /// Sample period \[s\].
    pub period: f64,
    /// Steering gear and engine.
    pub actuators: Actuators,
    /// Manoeuvres and the share of each.
    programme: &'static [(Manoeuvre, f64)],
}

/// A manoeuvre draws its plan.
pub type Manoeuvre = fn(&mut Draw) -> Sketch;

/// The part of a plan that a manoeuvre decides.
pub struct Sketch {
    /// Name of the manoeuvre.
    pub manoeuvre: &'static str,
    /// Speed ahead at which the lead-in begins \[m/s\].
    pub speed: f64,
    /// Telegraph and helm.
    pub phases: Vec<Phase>,
    /// The route, for those phases that follow it.
    pub legs: Vec<Leg>,
}

/// The data set of a ship.
pub fn service(ship: ShipId) -> Service {
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

/// The manoeuvre at this fraction of a data set, so that each has its exact share.
pub fn manoeuvre(service: &Service, fraction: f64) -> Manoeuvre {
    let programme = service.programme;
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

/// Random numbers of one plan.
pub struct Draw {
    /// A stream of the plan's own.
    pub rng: ChaCha8Rng,
}

impl Draw {
    /// A number between two bounds.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
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

/// In from sea: along the bends of the fairway, slower in steps, stopped with a kick astern.
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

/// Off the berth and out: a kick ahead with hard rudder to turn the ship, then faster in steps along the fairway.
fn departure_a(d: &mut Draw) -> Sketch {
    let phases = vec![
        phase(d.rpm(80.0, 150.0), d.helm(15.0, 35.0), Until::Turned(d.between(10.0, 60.0).to_radians())),
        phase(d.rpm(60.0, 120.0), Steer::Route, Until::Elapsed(d.between(20.0, 70.0))),
        phase(d.rpm(110.0, 170.0), Steer::Route, Until::Elapsed(d.between(40.0, 100.0))),
        phase(d.rpm(150.0, 220.0), Steer::Route, Until::Elapsed(0.0)),
    ];
    Sketch { manoeuvre: "departure", speed: d.between(0.2, 2.0), phases, legs: d.legs(3, [180.0, 400.0], [15.0, 70.0]) }
}

/// Turned short round in the basin: hard rudder with kicks ahead, astern between them to keep the speed low.
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

/// Full astern from way on, some runs until the ship gathers sternway, then stopped.
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

/// Full astern from way on; the engine is stopped when the ship is nearly dead in the water.
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
