//! Defects of sensors: the motion of the ship is right and its report is wrong.
//! Random sensor noise is not here: it is in every case (`noise`).

use super::effect::{Compare, Entry, Physics, SENSOR, vector};
use crate::conceal::sailing::track::Fine;

/// A constant added to one entry of the state.
struct Bias {
    entry: usize,
    size: f64,
}

impl Physics for Bias {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, y: &mut [f64; 6]) {
        y[self.entry] += self.size;
    }
}

/// The heading reads `d_N cos psi + d_E sin psi` too much.
struct Deviation([f64; 2]);

impl Physics for Deviation {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, y: &mut [f64; 6]) {
        let (sin, cos) = y[2].sin_cos();
        y[2] += self.0[0] * cos + self.0[1] * sin;
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("north", self.0[0], "rad"), ("east", self.0[1], "rad")]
    }
}

/// The log shows (1 + e) times the speed.
struct LogScale(f64);

impl Physics for LogScale {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, y: &mut [f64; 6]) {
        y[3] *= 1.0 + self.0;
        y[4] *= 1.0 + self.0;
    }
}

/// Positions are those of an antenna at (l_x, l_y) \[m\], and so are velocities where they are not those of midship.
struct Antenna {
    lever: [f64; 2],
    velocities: bool,
}

impl Physics for Antenna {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, y: &mut [f64; 6]) {
        let [lx, ly] = self.lever;
        let (sin, cos) = y[2].sin_cos();
        y[0] += lx * cos - ly * sin;
        y[1] += lx * sin + ly * cos;
        if self.velocities {
            y[3] -= y[5] * ly;
            y[4] += y[5] * lx;
        }
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("x", self.lever[0], "m"), ("y", self.lever[1], "m")]
    }
}

/// Positions arrive late \[s\]: the true track is read off at an earlier time, the fitter expands to first order.
struct Late(f64);

impl Physics for Late {
    fn measure(&self, _clock: f64, row: usize, fine: &Fine, y: &mut [f64; 6]) {
        let (then, now) = (fine.at(row, -self.0), fine.at(row, 0.0));
        y[0] += then.x - now.x;
        y[1] += then.y - now.y;
    }
}

/// A current, and a log that measures through the water while the file says over ground.
struct WaterLog([f64; 2]);

impl Physics for WaterLog {
    fn current(&self, _clock: f64) -> [f64; 2] {
        self.0
    }

    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, y: &mut [f64; 6]) {
        let (sin, cos) = y[2].sin_cos();
        y[3] -= self.0[0] * cos + self.0[1] * sin;
        y[4] -= -self.0[0] * sin + self.0[1] * cos;
    }
}

/// The yaw-rate channel has the wrong sign (size 1; 0 for the right one).
struct WrongSign(f64);

impl Physics for WrongSign {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, y: &mut [f64; 6]) {
        y[5] *= 1.0 - 2.0 * self.0;
    }
}

/// Speeds in knots under a header of m/s (size 1; 0 for m/s).
struct WrongUnit(f64);

impl Physics for WrongUnit {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, y: &mut [f64; 6]) {
        let factor = 1.0 + self.0 * (3.6 / 1.852 - 1.0);
        y[3] *= factor;
        y[4] *= factor;
    }
}

/// The effects of this file.
pub const ENTRIES: &[Entry] = &[
    Entry {
        name: "heading_bias",
        accepted: &["heading_bias"],
        unit: "rad",
        size: 0.017,
        most: 0.2,
        compare: Compare::Size("bias"),
        law: "constant",
        build: |size, _| Box::new(Bias { entry: 2, size }),
        ..SENSOR
    },
    Entry {
        name: "compass_deviation",
        accepted: &["compass_deviation"],
        unit: "rad",
        size: 0.03,
        most: 0.3,
        compare: Compare::Truth,
        law: "semicircular deviation, coefficients B and C",
        build: |size, d| Box::new(Deviation(vector(size, d.direction()))),
        ..SENSOR
    },
    Entry {
        name: "yaw_rate_bias",
        accepted: &["yaw_rate_bias"],
        unit: "rad/s",
        size: 5e-4,
        most: 0.01,
        compare: Compare::Size("bias"),
        law: "constant",
        build: |size, _| Box::new(Bias { entry: 5, size }),
        ..SENSOR
    },
    Entry {
        name: "sway_log_bias",
        accepted: &["sway_log_bias"],
        unit: "m/s",
        size: 0.05,
        most: 1.0,
        compare: Compare::Size("bias"),
        law: "constant",
        build: |size, _| Box::new(Bias { entry: 4, size }),
        ..SENSOR
    },
    Entry {
        name: "log_scale",
        accepted: &["log_scale"],
        size: 0.03,
        most: 0.5,
        compare: Compare::Size("error"),
        law: "constant share",
        build: |size, _| Box::new(LogScale(size)),
        ..SENSOR
    },
    Entry {
        name: "antenna",
        accepted: &["antenna"],
        unit: "m",
        size: 8.0,
        most: 100.0,
        compare: Compare::Truth,
        // A fitted hull of unknown Y_r, N_v has a pivot point of its own, some metres from the antenna's.
        reference: true,
        law: "rigid-body kinematics",
        build: |size, d| Box::new(Antenna { lever: vector(size, d.direction()), velocities: true }),
        ..SENSOR
    },
    Entry {
        name: "position_lever",
        accepted: &["position_lever"],
        unit: "m",
        size: 8.0,
        most: 100.0,
        compare: Compare::Truth,
        law: "rigid-body kinematics of the positions alone",
        build: |size, d| Box::new(Antenna { lever: vector(size, d.direction()), velocities: false }),
        ..SENSOR
    },
    Entry {
        name: "time_skew",
        accepted: &["time_skew"],
        unit: "s",
        size: 1.0,
        most: 20.0,
        compare: Compare::Size("position"),
        law: "the true position of an earlier time",
        build: |size, _| Box::new(Late(size)),
        ..SENSOR
    },
    Entry {
        name: "water_log",
        accepted: &["water_log", "current", "tide"],
        unit: "m/s",
        size: 0.3,
        most: 2.0,
        law: "a current, and speeds through the water reported as over ground",
        build: |size, d| Box::new(WaterLog(vector(size, d.direction()))),
        ..SENSOR
    },
    Entry {
        name: "sign_error",
        accepted: &["sign_error", "unit_error", "sign_or_unit_error", "sign", "audit"],
        size: 1.0,
        most: 1.0,
        law: "yaw rate positive to port",
        build: |size, _| Box::new(WrongSign(size)),
        ..SENSOR
    },
    Entry {
        name: "unit_error",
        accepted: &["unit_error", "sign_error", "sign_or_unit_error", "unit", "log_scale", "audit"],
        size: 1.0,
        most: 1.0,
        law: "knots under a header of m/s",
        build: |size, _| Box::new(WrongUnit(size)),
        ..SENSOR
    },
];
