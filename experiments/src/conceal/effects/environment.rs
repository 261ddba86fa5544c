//! Effects of wind, waves, current, bottom and bank, in the forms of Blendermann, Fujiwara, Daidola, Faltinsen, Hirano and the
//! exponential bank. No form here is the fitter's, which has cosine and sine wind, constant wave coefficients and a 1/distance bank.

use std::f64::consts::PI;

use super::effect::{ChannelOf, Class, Compare, Draw, Entry, FORCE, Instant, Physics, vector};
use crate::conceal::sailing::tweak::Tweak;

const AIR: f64 = 1.225;
const GRAVITY: f64 = 9.806_65;
/// Above-water particulars of ship A: frontal and lateral area \[m^2\], length overall \[m\].
const ABOVE: [f64; 3] = [175.0, 780.0, 92.0];

/// A current of constant direction, steady or with the tide.
struct Current {
    mean: [f64; 2],
    /// Phase of the tide \[rad\]; none for a steady current.
    tide: Option<f64>,
}

/// Period of the ramp \[s\]: a campaign of four sessions sees the tide turn.
const TIDE: f64 = 44_714.0;

impl Physics for Current {
    fn current(&self, clock: f64) -> [f64; 2] {
        let Some(phase) = self.tide else { return self.mean };
        // A triangle wave: water runs up and down at constant rates, the fitter has sine and cosine.
        let cycle = (clock / TIDE + phase / (2.0 * PI)).rem_euclid(1.0);
        let height = 1.0 - 4.0 * (cycle - 0.5).abs();
        self.mean.map(|v| v * height)
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("north", self.mean[0], "m/s"), ("east", self.mean[1], "m/s")]
    }
}

fn steady(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Current { mean: vector(size, d.direction()), tide: None })
}

fn tidal(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let mean = vector(size, d.direction());
    Box::new(Current { mean, tide: Some(d.direction()) })
}

/// A force law in air: coefficients (C_X, C_Y, C_N) of the angle of attack, 0 for head wind, positive from port.
type Coefficients = fn(f64) -> [f64; 3];

/// Mean wind with gusts of a tenth of its speed; the force in still air belongs to the hull's resistance and is subtracted.
struct Wind {
    mean: [f64; 2],
    law: Coefficients,
    measured: bool,
}

impl Wind {
    fn velocity(&self, at: &Instant<'_>) -> [f64; 2] {
        let strength = 1.0 + 0.1 * at.gust[0].clamp(-3.0, 3.0);
        self.mean.map(|v| v * strength)
    }

    fn load(&self, at: &Instant<'_>, wind: [f64; 2]) -> [f64; 3] {
        let (sin, cos) = at.state.psi.sin_cos();
        let u = at.state.u - (wind[0] * cos + wind[1] * sin);
        let v = at.state.v - (-wind[0] * sin + wind[1] * cos);
        let pressure = 0.5 * AIR * (u * u + v * v);
        let [cx, cy, cn] = (self.law)(-v.atan2(u));
        let [front, side, length] = ABOVE;
        [pressure * front * cx, pressure * side * cy, pressure * side * length * cn]
    }
}

impl Physics for Wind {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let (blown, still) = (self.load(at, self.velocity(at)), self.load(at, [0.0; 2]));
        std::array::from_fn(|i| blown[i] - still[i])
    }

    fn channels(&self) -> Vec<ChannelOf<'_>> {
        if !self.measured {
            return Vec::new();
        }
        // A direction is where the wind comes from; the speed contains the gusts.
        let from = (-self.mean[1]).atan2(-self.mean[0]).rem_euclid(2.0 * PI);
        vec![
            ChannelOf {
                name: "wind_speed",
                unit: "m/s",
                value: Box::new(|at| {
                    let [north, east] = self.velocity(at);
                    north.hypot(east)
                }),
            },
            ChannelOf { name: "wind_direction", unit: "rad", value: Box::new(move |_| from) },
        ]
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("north", self.mean[0], "m/s"), ("east", self.mean[1], "m/s")]
    }
}

/// Blendermann 1994, row "container ship, loaded": CD_t 0.90, CD_l 0.55, delta 0.40; centroid 1 m aft of midship.
fn blendermann(g: f64) -> [f64; 3] {
    let (cross, along, delta) = (0.90, 0.55, 0.40);
    let ratio = along * ABOVE[0] / ABOVE[1] / cross;
    let den = 1.0 - 0.5 * delta * (1.0 - ratio) * (2.0 * g).sin().powi(2);
    let cy = cross * g.sin() / den;
    let lever = -1.0 / ABOVE[2] - 0.18 * (g.abs() - 0.5 * PI);
    [-along * g.cos() / den, cy, lever * cy]
}

/// Fujiwara 1998: the Fourier coefficients of ship A from his regression.
fn fujiwara(g: f64) -> [f64; 3] {
    let s = |k: f64| (k * g).sin();
    let c = |k: f64| (k * g).cos();
    [
        0.096 - 1.019 * c(1.0) + 0.091 * c(3.0) + 0.126 * c(5.0),
        0.712 * s(1.0) - 0.025 * s(3.0) - 0.015 * s(5.0),
        -0.030 * s(1.0) + 0.031 * s(2.0) - 0.007 * s(3.0),
    ]
}

fn wind(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Wind { mean: vector(size, d.direction()), law: blendermann, measured: true })
}

fn mean_wind(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Wind { mean: vector(size, d.direction()), law: fujiwara, measured: false })
}

/// Mean second-order wave force.
struct Waves {
    height: f64,
    /// Direction of travel \[rad\].
    to: f64,
    /// Wave length over ship length; none for the short-wave asymptote.
    ratio: Option<f64>,
    length: f64,
    measured: bool,
}

impl Physics for Waves {
    /// Daidola et al. 1986: X, Y = 1/2 rho g L a^2 (cos chi C_X, sin chi C_Y), N = 1/2 rho g L^2 a^2 sin chi C_N, cubic in the wave
    /// length; in irregular seas a^2 becomes Hs^2/8. Faltinsen 1980 for waves much shorter than a wall-sided ship with square ends:
    /// the force on each side goes with the square of the sine of the angle to it.
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let chi = self.to - at.state.psi;
        let (sin, cos) = chi.sin_cos();
        let p = at.craft.particulars();
        let pressure = 0.5 * p.rho * GRAVITY * self.height * self.height / 8.0;
        let l = self.length;
        match self.ratio {
            Some(q) => {
                let cubic = |c: [f64; 4]| c[0] + q * (c[1] + q * (c[2] + q * c[3]));
                let cx = cubic([0.05, -0.2, 0.75, -0.51]);
                let cy = cubic([0.46, 6.83, -15.65, 8.44]);
                let cn = cubic([-0.11, 0.68, -0.79, 0.21]);
                [pressure * l * cos * cx, pressure * l * sin * cy, pressure * l * l * sin * cn]
            }
            None => [pressure * p.breadth * cos * cos.abs(), pressure * l * sin * sin.abs(), 0.0],
        }
    }

    fn channels(&self) -> Vec<ChannelOf<'_>> {
        if !self.measured {
            return Vec::new();
        }
        let from = (self.to + PI).rem_euclid(2.0 * PI);
        vec![
            ChannelOf { name: "wave_height", unit: "m", value: Box::new(|_| self.height) },
            ChannelOf { name: "wave_direction", unit: "rad", value: Box::new(move |_| from) },
        ]
    }
}

fn wave_drift(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let (to, ratio) = (d.direction(), d.between(0.35, 0.7));
    Box::new(Waves { height: size, to, ratio: Some(ratio), length: d.length, measured: false })
}

fn measured_waves(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Waves { height: size, to: d.direction(), ratio: None, length: d.length, measured: true })
}

/// Shallow water: Hirano & Kijima's effective aspect ratio of the hull, added masses after Li & Wu. `ratio` is d/h.
struct Shallow {
    ratio: f64,
}

impl Physics for Shallow {
    /// lambda_e = lambda / (d/(2h) lambda + ((pi d/2h) cot(pi d/2h))^n), n = 2.3 (Y_v), 1.7 (N_v), 0.7 (Y_r, N_r); nonlinear parts
    /// grow with (d/h)^3.5 and (d/h)^2.5.
    fn alter(&self, at: &Instant<'_>, tweak: &mut Tweak) {
        let q = self.ratio;
        if q <= 0.0 {
            return;
        }
        let p = at.craft.particulars();
        let (l, b, d, cb) = (p.length, p.breadth, p.draught, p.block());
        let aspect = 2.0 * d / l;
        let x = 0.5 * PI * q;
        let effective = |n: f64| aspect / (0.5 * q * aspect + (x / x.tan()).powf(n));
        let fullness = 1.4 * cb * b / l;
        let (ev, en, er) = (effective(2.3), effective(1.7), effective(0.7));
        let yaw = |k: f64| 0.54 * k - k * k;
        tweak.linear[0] *= (0.5 * PI * ev + fullness) / (0.5 * PI * aspect + fullness);
        tweak.linear[1] *= er / aspect;
        tweak.linear[2] *= en / aspect;
        tweak.linear[3] *= yaw(er) / yaw(aspect);
        let (steep, mild) = (q.powf(3.5), q.powf(2.5));
        for (factor, growth) in tweak.nonlinear.iter_mut().zip([14.0 * steep, 3.0 * mild, 6.0 * mild, 5.0 * steep]) {
            *factor *= 1.0 + growth;
        }
        let clearance = 1.0 / q - 1.0;
        tweak.added[0] *= 1.0 + (3.77 + 1.14 * b / d - 0.233 * l / d - 3.43 * cb).max(0.0) / clearance.powf(1.3);
        let beam = b / d;
        tweak.added[1] *= 1.0 + (0.413 + 0.032 * beam + 0.0129 * beam * beam) / clearance.powf(0.82);
        tweak.added[2] *= 1.0 + (0.413 + 0.0192 * beam + 0.00554 * beam * beam) / clearance.powf(0.82);
        // 20 % at h/d 2, a third at 1.5: the middle of what is reported for slow ships.
        tweak.resistance *= 1.0 + 0.75 * q * q;
    }
}

fn shallow(size: f64, _d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Shallow { ratio: size.clamp(0.0, 0.85) })
}

/// A straight bank beside the course of some runs.
struct Bank {
    strength: f64,
    /// For every run: distance at the start, to starboard positive \[m\]; 0 where there is no bank.
    distance: Vec<f64>,
}

const FAR: f64 = 1e6;

impl Bank {
    /// Distance to the bank \[m\] and its side; the bank runs along the first course of the run.
    fn place(&self, at: &Instant<'_>) -> Option<(f64, f64)> {
        let start = self.distance.get(at.run).copied().filter(|d| *d != 0.0)?;
        let across = -at.state.x * at.course.sin() + at.state.y * at.course.cos();
        let side = start.signum();
        // The side of the ship on which the bank lies changes with the heading.
        let seen = side * (at.state.psi - at.course).cos().signum();
        Some(((start.abs() - side * across).max(10.0), seen))
    }
}

impl Physics for Bank {
    /// Y = side rho V^2 Cb B d^2/h a exp(-b y/B), b = 1.5, at h = 2 d; N = -side |Y| L/4: suction with the bow away (PIANC).
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let Some((distance, side)) = self.place(at) else { return [0.0; 3] };
        let p = at.craft.particulars();
        let v2 = at.water[0] * at.water[0];
        let size = p.rho * v2 * p.block() * p.breadth * p.draught * 0.5 * self.strength;
        let y = side * size * (-1.5 * distance / p.breadth).exp();
        [0.0, y, -0.25 * p.length * y]
    }

    fn channels(&self) -> Vec<ChannelOf<'_>> {
        let seen = move |at: &Instant<'_>, wanted: f64| match self.place(at) {
            Some((distance, side)) if side == wanted => distance,
            _ => FAR,
        };
        vec![
            ChannelOf { name: "bank_starboard", unit: "m", value: Box::new(move |at| seen(at, 1.0)) },
            ChannelOf { name: "bank_port", unit: "m", value: Box::new(move |at| seen(at, -1.0)) },
        ]
    }
}

fn bank(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let chosen = d.some_runs(0.6);
    let distance = chosen.into_iter().map(|c| {
        let place = d.side() * d.between(16.0, 35.0);
        if c { place } else { 0.0 }
    });
    Box::new(Bank { strength: size, distance: distance.collect() })
}

/// Gusts: an Ornstein-Uhlenbeck force in sway, with its moment.
struct Gusts {
    sigma: f64,
    length: f64,
}

impl Physics for Gusts {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let y = self.sigma * at.gust[0];
        [0.3 * self.sigma * at.gust[1], y, 0.3 * self.length * self.sigma * at.gust[1]]
    }
}

fn gusts(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Gusts { sigma: size, length: d.length })
}

/// The effects of this file.
pub const ENTRIES: &[Entry] = &[
    Entry {
        name: "current",
        accepted: &["current", "tide"],
        unit: "m/s",
        size: 0.15,
        most: 2.0,
        compare: Compare::Truth,
        law: "uniform steady current, irrotational (Fossen 2011)",
        build: steady,
        ..FORCE
    },
    Entry {
        name: "tide",
        accepted: &["tide", "current"],
        unit: "m/s",
        size: 0.3,
        most: 3.0,
        law: "current that ramps up and down over 12.4 h",
        build: tidal,
        ..FORCE
    },
    Entry {
        name: "wind",
        accepted: &["wind", "mean_wind"],
        unit: "m/s",
        size: 8.0,
        most: 30.0,
        law: "Blendermann 1994 with gusts, anemometer recorded",
        build: wind,
        ..FORCE
    },
    Entry {
        name: "mean_wind",
        accepted: &["mean_wind", "wind"],
        near: &["earth_force", "wave_drift"],
        unit: "m/s",
        size: 8.0,
        most: 30.0,
        compare: Compare::Truth,
        law: "Fujiwara 1998 with gusts, not recorded",
        build: mean_wind,
        ..FORCE
    },
    Entry {
        name: "wave_drift",
        accepted: &["wave_drift", "waves"],
        near: &["earth_force", "mean_wind"],
        unit: "m",
        size: 0.8,
        most: 5.0,
        law: "Daidola et al. 1986, cubic in the wave length, not recorded",
        build: wave_drift,
        ..FORCE
    },
    Entry {
        name: "waves",
        accepted: &["waves", "wave_drift"],
        near: &["earth_force"],
        unit: "m",
        size: 0.8,
        most: 5.0,
        law: "Faltinsen et al. 1980, short waves on a wall-sided ship, recorded",
        build: measured_waves,
        ..FORCE
    },
    Entry {
        name: "shallow",
        accepted: &["shallow"],
        near: &["crossflow", "hull_nonlinear", "loading"],
        unit: "d/h",
        size: 0.5,
        most: 0.85,
        reference: true,
        law: "Hirano & Kijima effective aspect ratio, Li & Wu added mass, depth not recorded",
        build: shallow,
        ..FORCE
    },
    Entry {
        name: "bank",
        accepted: &["bank"],
        size: 0.4,
        most: 5.0,
        law: "exponential in the distance (PIANC), distances recorded",
        build: bank,
        ..FORCE
    },
    Entry {
        name: "gusts",
        class: Class::Random,
        accepted: &["gusts", "random"],
        unit: "N",
        size: 4000.0,
        most: 5e4,
        law: "Ornstein-Uhlenbeck force, 20 s",
        build: gusts,
        ..FORCE
    },
];
