//! Defects of sensors: the ship moves as she should and is reported otherwise.
//! Random sensor noise is not here (`noise`): it is in every case.

use super::{Class, Compare, Draw, Entry, Physics, vector};
use crate::conceal::sail::Fine;

/// A constant added to one entry of the state.
struct Bias {
    entry: usize,
    size: f64,
    unit: &'static str,
}

impl Physics for Bias {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine<'_>, y: &mut [f64; 6]) {
        y[self.entry] += self.size;
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("bias", self.size, self.unit)]
    }
}

/// The log shows (1 + e) times the speed.
struct LogScale(f64);

impl Physics for LogScale {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine<'_>, y: &mut [f64; 6]) {
        y[3] *= 1.0 + self.0;
        y[4] *= 1.0 + self.0;
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("error", self.0, "-")]
    }
}

/// Position and velocity are those of an antenna at (l_x, l_y) \[m\].
struct Antenna([f64; 2]);

impl Physics for Antenna {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine<'_>, y: &mut [f64; 6]) {
        let [lx, ly] = self.0;
        let (sin, cos) = y[2].sin_cos();
        y[0] += lx * cos - ly * sin;
        y[1] += lx * sin + ly * cos;
        y[3] -= y[5] * ly;
        y[4] += y[5] * lx;
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("x", self.0[0], "m"), ("y", self.0[1], "m")]
    }
}

/// Positions arrive late \[s\]: the true track is read off at an earlier time, the fitter expands to first order.
struct Late(f64);

impl Physics for Late {
    fn measure(&self, _clock: f64, row: usize, fine: &Fine<'_>, y: &mut [f64; 6]) {
        let (then, now) = (fine.at(row, -self.0), fine.at(row, 0.0));
        y[0] += then.x - now.x;
        y[1] += then.y - now.y;
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("position", self.0, "s")]
    }
}

/// A current, and a log that measures through the water while the file says over ground.
struct WaterLog([f64; 2]);

impl Physics for WaterLog {
    fn current(&self, _clock: f64) -> [f64; 2] {
        self.0
    }

    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine<'_>, y: &mut [f64; 6]) {
        let (sin, cos) = y[2].sin_cos();
        y[3] -= self.0[0] * cos + self.0[1] * sin;
        y[4] -= -self.0[0] * sin + self.0[1] * cos;
    }
}

/// The yaw-rate channel has the wrong sign (size 1; 0 for the right one).
struct WrongSign(f64);

impl Physics for WrongSign {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine<'_>, y: &mut [f64; 6]) {
        y[5] *= 1.0 - 2.0 * self.0;
    }
}

/// Speeds in knots under a header of m/s (size 1; 0 for m/s).
struct WrongUnit(f64);

impl Physics for WrongUnit {
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine<'_>, y: &mut [f64; 6]) {
        let factor = 1.0 + self.0 * (3.6 / 1.852 - 1.0);
        y[3] *= factor;
        y[4] *= factor;
    }
}

fn antenna(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Antenna(vector(size, d.direction())))
}

const fn sensor(
    name: &'static str,
    accepted: &'static [&'static str],
    unit: &'static str,
    size: f64,
    most: f64,
    compare: Compare,
    law: &'static str,
    build: fn(f64, &mut Draw<'_>) -> Box<dyn Physics>,
) -> Entry {
    Entry {
        name,
        class: Class::Sensor,
        accepted,
        near: &[],
        unit,
        size,
        most,
        compare,
        in_mmg: true,
        reference: false,
        law,
        build,
    }
}

use Compare::{No, Parameters};

/// The effects of this file.
pub const ENTRIES: &[Entry] = &[
    sensor("heading_bias", &["heading_bias"], "rad", 0.017, 0.2, Parameters, "constant", |size, _| {
        Box::new(Bias { entry: 2, size, unit: "rad" })
    }),
    sensor("yaw_rate_bias", &["yaw_rate_bias"], "rad/s", 5e-4, 0.01, Parameters, "constant", |size, _| {
        Box::new(Bias { entry: 5, size, unit: "rad/s" })
    }),
    sensor("sway_log_bias", &["sway_log_bias"], "m/s", 0.05, 1.0, Parameters, "constant", |size, _| {
        Box::new(Bias { entry: 4, size, unit: "m/s" })
    }),
    sensor("log_scale", &["log_scale"], "-", 0.03, 0.5, Parameters, "constant share", |size, _| {
        Box::new(LogScale(size))
    }),
    // A fitted hull of unknown Y_r, N_v has a pivot point of its own, some metres from the antenna's.
    Entry {
        reference: true,
        ..sensor("antenna", &["antenna"], "m", 8.0, 100.0, Parameters, "rigid-body kinematics", antenna)
    },
    sensor(
        "time_skew",
        &["time_skew"],
        "s",
        1.0,
        20.0,
        Parameters,
        "the true position of an earlier time",
        |size, _| Box::new(Late(size)),
    ),
    sensor(
        "water_log",
        &["water_log", "current", "tide"],
        "m/s",
        0.3,
        2.0,
        No,
        "a current, and speeds through the water reported as over ground",
        |size, d| Box::new(WaterLog(vector(size, d.direction()))),
    ),
    sensor(
        "sign_error",
        &["sign_error", "unit_error", "sign_or_unit_error", "sign", "audit"],
        "-",
        1.0,
        1.0,
        No,
        "yaw rate positive to port",
        |size, _| Box::new(WrongSign(size)),
    ),
    sensor(
        "unit_error",
        &["unit_error", "sign_error", "sign_or_unit_error", "unit", "log_scale", "audit"],
        "-",
        1.0,
        1.0,
        No,
        "knots under a header of m/s",
        |size, _| Box::new(WrongUnit(size)),
    ),
];
