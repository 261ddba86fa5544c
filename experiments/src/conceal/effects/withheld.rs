//! Effects that are in no catalogue of the diagnosis: the right answer to them is "not in the catalogue", with the place.
//! They are kept out of that catalogue on purpose: an effect whose mechanism is added there must leave this file.

use super::effect::{Draw, Entry, Instant, Physics, WITHHELD, Window, ramp, vector};
use crate::truth::motion::{Inputs, State};

/// Play in the steering gear, half width \[rad\].
struct DeadBand(f64);

impl Physics for DeadBand {
    fn actuate(&self, _h: f64, orders: [Inputs; 2], at: &Inputs, _state: &State, actual: &mut Inputs) {
        let order = orders[1].delta;
        if (order - at.delta).abs() <= self.0 {
            actual.delta = at.delta;
        } else {
            actual.delta = order - self.0 * (order - at.delta).signum();
        }
    }
}

/// The engine loses revolutions in a turn: n = n_order (1 - s tanh(3 |r| L/U)).
struct Sag {
    share: f64,
    length: f64,
}

impl Physics for Sag {
    fn actuate(&self, _h: f64, orders: [Inputs; 2], _at: &Inputs, state: &State, actual: &mut Inputs) {
        let turn = state.r.abs() * self.length / state.speed().max(0.5);
        actual.n = orders[1].n * (1.0 - self.share * (turn * 3.0).tanh());
    }
}

/// A yaw moment s tanh(u / 1 m/s) \[N m\].
struct TanhMoment(f64);

impl Physics for TanhMoment {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        [0.0, 0.0, self.0 * at.water[0].tanh()]
    }
}

/// A tow line from the stern to a point fixed on earth, tight beyond a length.
struct TowLine {
    tension: f64,
    anchor: [f64; 2],
    slack: f64,
    length: f64,
    runs: Vec<bool>,
}

impl Physics for TowLine {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        if !self.runs.get(at.run).copied().unwrap_or(false) {
            return [0.0; 3];
        }
        let (sin, cos) = at.state.psi.sin_cos();
        let stern = [at.state.x - 0.5 * self.length * cos, at.state.y - 0.5 * self.length * sin];
        let (north, east) = (self.anchor[0] - stern[0], self.anchor[1] - stern[1]);
        let distance = north.hypot(east).max(1.0);
        let pull = self.tension * ramp(distance, self.slack, self.slack + 60.0) / distance;
        let (x, y) = (pull * (north * cos + east * sin), pull * (-north * sin + east * cos));
        [x, y, -0.5 * self.length * y]
    }
}

/// Debris caught on one side from some time on: X = -s u|u|, with a yaw moment.
struct Debris {
    drag: f64,
    lever: f64,
    caught: Vec<Window>,
}

impl Physics for Debris {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let Some((_, start, _)) = self.caught.iter().find(|w| w.0 == at.run) else { return [0.0; 3] };
        let u = at.water[0];
        let x = -self.drag * u * u.abs() / 25.0 * ramp(at.t, *start, start + 2.0);
        [x, 0.0, self.lever * x]
    }

    fn windows(&self) -> Vec<Window> {
        self.caught.clone()
    }
}

/// A force fixed on earth within a patch of water 150 m wide.
struct Patch {
    force: [f64; 2],
    centre: [f64; 2],
}

impl Physics for Patch {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let (sin, cos) = at.state.psi.sin_cos();
        let (dx, dy) = (at.state.x - self.centre[0], at.state.y - self.centre[1]);
        let weight = (-(dx * dx + dy * dy) / (2.0 * 150.0 * 150.0)).exp();
        let [north, east] = self.force.map(|f| f * weight);
        [north * cos + east * sin, -north * sin + east * cos, 0.0]
    }
}

fn tow_line(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let anchor = [d.between(-300.0, 300.0), d.between(-300.0, 300.0)];
    Box::new(TowLine { tension: size, anchor, slack: 100.0, length: d.length, runs: d.some_runs(0.5) })
}

fn debris(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let side = d.side();
    let duration = d.duration;
    let caught = d.some_runs(0.35).into_iter().enumerate().filter(|(_, chosen)| *chosen).map(|(run, _)| {
        let start = d.between(0.2, 0.6) * duration;
        (run, start, duration)
    });
    Box::new(Debris { drag: size, lever: side * 15.0, caught: caught.collect() })
}

fn patch(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let force = vector(size, d.direction());
    Box::new(Patch { force, centre: [d.between(-200.0, 200.0), d.between(-200.0, 200.0)] })
}

/// The effects of this file.
pub const ENTRIES: &[Entry] = &[
    Entry {
        name: "dead_band",
        near: &["rudder_lag", "rudder_rate"],
        unit: "rad",
        size: 0.04,
        most: 0.3,
        moves_actuators: true,
        law: "play between order and rudder",
        build: |size, _| Box::new(DeadBand(size)),
        ..WITHHELD
    },
    Entry {
        name: "rpm_sag",
        near: &["engine_lag", "thrust_loss", "wake_drift"],
        size: 0.15,
        most: 0.9,
        moves_actuators: true,
        law: "revolutions lost in turns",
        build: |size, d| Box::new(Sag { share: size, length: d.length }),
        ..WITHHELD
    },
    Entry {
        name: "tanh_moment",
        near: &["asymmetric", "symmetric"],
        unit: "N m",
        size: 3e5,
        most: 1e7,
        law: "yaw moment of tanh(u)",
        build: |size, _| Box::new(TanhMoment(size)),
        ..WITHHELD
    },
    Entry {
        name: "tow_line",
        near: &["earth_force", "push"],
        unit: "N",
        size: 1.5e4,
        most: 3e5,
        law: "line to a fixed point, slack below 100 m",
        build: tow_line,
        ..WITHHELD
    },
    Entry {
        name: "debris",
        near: &["push", "fouling"],
        unit: "N",
        size: 1.5e4,
        most: 3e5,
        law: "drag at 5 m/s from some moment on, off centre",
        build: debris,
        ..WITHHELD
    },
    Entry {
        name: "patch",
        near: &["earth_force", "push"],
        unit: "N",
        size: 1.5e4,
        most: 3e5,
        law: "earth-fixed force in a patch of water",
        build: patch,
        ..WITHHELD
    },
];
