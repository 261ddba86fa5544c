//! Effects that no catalogue of the diagnosis holds: the right answer to them is "not in the catalogue", with the place.
//! They are kept out of the catalogue on purpose; a mechanism that is added there one day must leave this file.

use super::{Class, Compare, Draw, Entry, Instant, Physics, Window, ramp, vector};
use crate::truth::{Inputs, State};

/// Play in the steering gear, half width \[rad\].
struct DeadBand(f64);

impl Physics for DeadBand {
    fn moves_actuators(&self) -> bool {
        true
    }

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
    fn moves_actuators(&self) -> bool {
        true
    }

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

/// Debris caught on one side from some moment on: X = -s u|u|, with a moment.
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

const fn withheld(
    name: &'static str,
    near: &'static [&'static str],
    unit: &'static str,
    size: f64,
    most: f64,
    law: &'static str,
    build: fn(f64, &mut Draw<'_>) -> Box<dyn Physics>,
) -> Entry {
    Entry {
        name,
        class: Class::Withheld,
        accepted: &[],
        near,
        unit,
        size,
        most,
        compare: Compare::No,
        in_mmg: true,
        reference: false,
        law,
        build,
    }
}

/// The effects of this file.
pub const ENTRIES: &[Entry] = &[
    withheld(
        "dead_band",
        &["rudder_lag", "rudder_rate"],
        "rad",
        0.04,
        0.3,
        "play between order and rudder",
        |size, _| Box::new(DeadBand(size)),
    ),
    withheld(
        "rpm_sag",
        &["engine_lag", "thrust_loss", "wake_drift"],
        "-",
        0.15,
        0.9,
        "revolutions lost in turns",
        |size, d| Box::new(Sag { share: size, length: d.length }),
    ),
    withheld("tanh_moment", &["asymmetric", "symmetric"], "N m", 3e5, 1e7, "yaw moment of tanh(u)", |size, _| {
        Box::new(TanhMoment(size))
    }),
    withheld(
        "tow_line",
        &["earth_force", "push"],
        "N",
        1.5e4,
        3e5,
        "line to a fixed point, slack below 100 m",
        tow_line,
    ),
    withheld("debris", &["push", "fouling"], "N", 1.5e4, 3e5, "drag at 5 m/s from some moment on, off centre", debris),
    withheld("patch", &["earth_force", "push"], "N", 1.5e4, 3e5, "earth-fixed force in a patch of water", patch),
];
