//! A ship's fixed particulars, read from a TOML file and checked once, and the empirical hull coefficients they imply.
//! It has no fitted parameter: parameters belong to the terms that use them, and take their defaults from here.

pub mod actuator;
mod craft;
pub mod parameter;
pub mod particulars;
pub(crate) mod rudder;
pub mod state;
pub mod units;

use crate::files::written::{Kind, joined, read_text, read_toml};
use crate::numerals::sig;
use crate::units::GRAVITY;
use actuator::Actuator;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// Why a ship file could not be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShipError {
    /// The file could not be opened.
    #[error("{path}: cannot read the ship file ({source}); check the path given as `ship` in the study")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is not TOML of the expected shape.
    #[error("{path}:{line}: {message}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong and what is expected.
        message: String,
    },
    /// Values that the file does not have.
    #[error(
        "{path}: {} missing: {}; add {}, or have {} estimated: {}",
        if missing.len() == 1 { "a value is".to_owned() } else { format!("{} values are", missing.len()) },
        missing.join(", "),
        if missing.len() == 1 { "it" } else { "them" },
        if missing.len() == 1 { "it" } else { "them" },
        completion(path, missing)
    )]
    Missing {
        /// The file.
        path: PathBuf,
        /// Dotted keys, with their units.
        missing: Vec<&'static str>,
    },
    /// A value that no ship can have.
    #[error("{path}:{line}: {key} = {found} {expected}")]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Dotted key.
        key: String,
        /// The value found.
        found: f64,
        /// What it should be, as the rest of a sentence.
        expected: String,
    },
    /// Several values that no ship can have.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Several(Vec<ShipError>),
}

/// A ship: its fixed particulars, in SI units.
///
/// Axes: x forward from midship, y to starboard.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ship {
    /// Name, for headings.
    pub name: String,
    /// Where the particulars come from.
    #[serde(default)]
    pub source: String,
    /// Hull particulars.
    pub hull: HullParticulars,
    /// Propeller particulars. A file has propeller and rudder, or neither: then what drives the craft are its named actuators.
    #[serde(default = "PropellerParticulars::none", skip_serializing_if = "PropellerParticulars::is_none")]
    pub propeller: PropellerParticulars,
    /// Rudder particulars.
    #[serde(default = "RudderParticulars::none", skip_serializing_if = "RudderParticulars::is_none")]
    pub rudder: RudderParticulars,
    /// Named actuators, beside propeller and rudder or instead of them.
    #[serde(default, rename = "actuator", skip_serializing_if = "Vec::is_empty")]
    pub actuators: Vec<Actuator>,
    /// Above-water particulars, needed for wind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub above_water: Option<AboveWater>,
    /// Bow thruster, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thruster: Option<ThrusterParticulars>,
    /// Hull coefficients given instead of estimated, dimensional (SI), by name (`Yv`, `Nr`, `Yvdot`, ...).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub coefficients: BTreeMap<String, f64>,
    /// Hull coefficients given instead of estimated, made dimensionless with 1/2 rho, L and d (MMG and Inoue's "L-d"
    /// normalisation), by the same names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub coefficients_prime: BTreeMap<String, f64>,
    /// Whether the recordings' u and v were made from a velocity over ground and the recorded heading, so that an error of the heading turns
    /// them. It is no part of a ship file: the column maps of a study say so.
    #[serde(skip)]
    pub velocity_by_heading: bool,
    /// Default values of named parameters of any term, e.g. `"resistance.linear" = 10500.0`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, f64>,
}

/// Hull particulars.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HullParticulars {
    /// Length between perpendiculars L \[m\].
    pub lpp: f64,
    /// Breadth B \[m\].
    pub breadth: f64,
    /// Mean draught d \[m\]. A craft without propeller and rudder may leave it out; it then follows from the mass.
    #[serde(default)]
    pub draught: f64,
    /// Mass m \[kg\].
    pub mass: f64,
    /// Block coefficient C_b \[-\]; a craft without propeller and rudder may leave it out.
    #[serde(default)]
    pub block_coefficient: f64,
    /// Longitudinal centre of gravity x_G \[m\], forward of midship.
    #[serde(default)]
    pub x_g: f64,
    /// Yaw radius of gyration about the centre of gravity over L \[-\].
    #[serde(default = "default_gyration")]
    pub gyration: f64,
    /// Water density rho \[kg/m3\].
    #[serde(default = "default_density")]
    pub water_density: f64,
    /// Service speed \[m/s\]: the approach of trials where nothing was recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub service_speed: Option<f64>,
}

fn default_gyration() -> f64 {
    0.25
}
fn default_density() -> f64 {
    1025.0
}

/// Propeller particulars of a single screw.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PropellerParticulars {
    /// Diameter D \[m\].
    pub diameter: f64,
    /// Longitudinal position x_P \[m\], forward of midship; about -0.48 L.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// Effective wake fraction in straight running w \[-\].
    pub wake: f64,
    /// Thrust deduction t \[-\].
    pub thrust_deduction: f64,
    /// `K_T(J) = k0 + k1 J + k2 J^2`.
    pub thrust_coefficients: [f64; 3],
    /// Thrust rotating astern at rest over thrust ahead at rest \[-\]; about 0.72 to 0.77 for a fixed-pitch propeller.
    #[serde(default = "default_astern")]
    pub astern: f64,
    /// Whether the propeller turns anticlockwise ahead, seen from aft; its side forces then act to the other side.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub left_handed: bool,
}

fn default_astern() -> f64 {
    0.74
}

/// Rudder particulars of a single rudder behind the propeller.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RudderParticulars {
    /// Area A_R \[m2\].
    pub area: f64,
    /// Span H_R \[m\].
    pub span: f64,
    /// Longitudinal position x_R \[m\], forward of midship; about -0.5 L.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// Flow straightening gamma_R \[-\].
    #[serde(default = "default_straightening")]
    pub straightening: f64,
    /// Effective longitudinal position in the inflow l_R over L \[-\].
    #[serde(default = "default_lever")]
    pub lever: f64,
    /// Ratio of wake at the rudder to wake at the propeller, epsilon \[-\].
    #[serde(default = "default_wake_ratio")]
    pub wake_ratio: f64,
    /// Propeller race factor kappa \[-\].
    #[serde(default = "default_race")]
    pub race: f64,
    /// Rate at which the steering gear turns the rudder \[deg/s\]: that of trials where nothing was recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_deg_s: Option<f64>,
}

fn default_straightening() -> f64 {
    0.45
}
fn default_lever() -> f64 {
    -0.85
}
fn default_wake_ratio() -> f64 {
    1.05
}
fn default_race() -> f64 {
    0.5
}

/// Above-water particulars.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AboveWater {
    /// Frontal (transverse) projected area A_F \[m2\].
    pub frontal_area: f64,
    /// Lateral projected area A_L \[m2\].
    pub lateral_area: f64,
    /// Length overall \[m\].
    pub length_overall: f64,
    /// Air density \[kg/m3\].
    #[serde(default = "default_air_density")]
    pub air_density: f64,
}

fn default_air_density() -> f64 {
    1.225
}

/// Bow thruster particulars.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThrusterParticulars {
    /// Full thrust at rest \[N\].
    pub thrust: f64,
    /// Longitudinal position \[m\], forward of midship.
    pub x: f64,
}

/// Coefficient names accepted in a ship file, with the exponents of L and d in the "L-d" normalisation:
/// dimensional = prime * 1/2 rho * L^a * d.
pub const COEFFICIENTS: [(&str, i32); 16] = [
    ("Xudot", 2),
    ("Yvdot", 2),
    ("Yrdot", 3),
    ("Nvdot", 3),
    ("Nrdot", 4),
    ("Xvr", 2),
    ("Yv", 1),
    ("Yr", 2),
    ("Nv", 2),
    ("Nr", 3),
    ("Yvv", 1),
    ("Yvr", 2),
    ("Yrr", 3),
    ("Nrr", 4),
    ("Nrrv", 4),
    ("Nvvr", 3),
];

impl Ship {
    /// Reads and checks a ship file.
    pub fn read(path: &Path) -> Result<Self, ShipError> {
        let text = read_text(path).map_err(|source| ShipError::Read { path: path.to_path_buf(), source })?;
        Self::parse(&text, path)
    }

    /// Reads and checks the text of a ship file; `path` is used in messages.
    pub fn parse(text: &str, path: &Path) -> Result<Self, ShipError> {
        let absent = missing(text);
        let mut ship: Self = read_toml(text, Kind::Ship).map_err(|mistakes| {
            if !absent.is_empty() && mistakes.iter().all(|m| m.message.contains(" is missing")) {
                return ShipError::Missing { path: path.to_path_buf(), missing: absent.clone() };
            }
            let (line, message) = joined(mistakes, path);
            ShipError::Parse { path: path.to_path_buf(), line, message }
        })?;
        if !absent.is_empty() {
            return Err(ShipError::Missing { path: path.to_path_buf(), missing: absent });
        }
        ship.complete();
        let mut errors = ship.errors(&Source { text, path });
        match errors.len() {
            0 => Ok(ship),
            1 => Err(errors.remove(0)),
            _ => Err(ShipError::Several(errors)),
        }
    }

    /// What is wrong with the numbers and the names of coefficients; `source` places the messages.
    fn errors(&self, source: &Source<'_>) -> Vec<ShipError> {
        let mut errors = self.not_finite(source);
        errors.extend(self.actuator_faults(source));
        for range in self.outside() {
            let [low, high] = range.limits;
            let within = if low == f64::MIN_POSITIVE {
                format!("a positive number, at most {}", sig(high, 4))
            } else {
                format!("between {} and {}", sig(low, 4), sig(high, 4))
            };
            let expected = format!("must be {within}: {}", range.meaning);
            errors.push(source.value(range.key, range.value, &expected));
        }
        errors.extend(self.unknown_coefficients(source));
        if errors.is_empty() {
            errors.extend(self.mass_error(source));
            errors.extend(self.coefficients_of_another_size(source));
        }
        let d = self.mass_determinant();
        // The regressions are those of ships with propeller and rudder; where they are not valid, the model says so.
        if errors.is_empty() && self.has_propeller() && (d.is_nan() || d <= 0.0) {
            let expected = format!(
                "kg makes the sway-yaw mass matrix singular (determinant {d:.3e}); check Yvdot, Yrdot, Nvdot, Nrdot, x_g and gyration"
            );
            errors.push(source.value("hull.mass", self.hull.mass, &expected));
        }
        errors
    }

    /// The tables of free numbers, and those that have no range: TOML has words for NaN and infinity.
    fn not_finite(&self, source: &Source<'_>) -> Vec<ShipError> {
        let tables = [&self.coefficients, &self.coefficients_prime, &self.parameters];
        let given = tables.into_iter().flatten().map(|(name, value)| (name.as_str(), *value));
        let thrust = self.propeller.thrust_coefficients.iter().map(|k| ("propeller.thrust_coefficients", *k));
        let wrong = given.chain(thrust).filter(|(_, value)| !value.is_finite());
        let expected = "is no number to compute with; correct it, or leave the entry out";
        wrong.map(|(key, value)| source.value(key, value, expected)).collect()
    }

    /// The particulars outside their ranges. Where a main dimension is, the ranges that follow from it say nothing.
    fn outside(&self) -> Vec<Range> {
        let mut outside = self.ranges();
        outside.retain(|range| !(range.limits[0]..=range.limits[1]).contains(&range.value));
        let Some(main) = outside.iter().find(|range| MAIN_DIMENSIONS.contains(&range.key)).map(|range| range.key)
        else {
            return outside;
        };
        let limits_of = |scale: f64| {
            let mut ship = self.clone();
            (ship.hull.lpp, ship.hull.breadth, ship.hull.draught) = (100.0 * scale, 15.0 * scale, 5.0 * scale);
            ship.ranges()
        };
        let fixed: Vec<&str> = limits_of(1.0)
            .iter()
            .zip(limits_of(2.0))
            .filter(|(a, b)| a.limits == b.limits)
            .map(|(a, _)| a.key)
            .collect();
        outside.retain(|range| range.key == main || fixed.contains(&range.key));
        outside
    }

    /// The range of every particular that a ship can have, wide enough for models, tugs and barges: what is outside is a wrong unit or
    /// a wrong sign.
    fn ranges(&self) -> Vec<Range> {
        [self.hull_ranges(), self.propulsion_ranges(), self.other_ranges()].concat()
    }

    fn hull_ranges(&self) -> Vec<Range> {
        let h = &self.hull;
        let tiny = f64::MIN_POSITIVE;
        vec![
            range("hull.lpp", h.lpp, tiny, 600.0, "the length between perpendiculars in m"),
            range("hull.breadth", h.breadth, tiny, h.lpp, "the breadth in m, at most the length"),
            range("hull.draught", h.draught, tiny, h.lpp, "the draught in m, at most the length"),
            range("hull.mass", h.mass, tiny, 1e10, "the mass in kg"),
            range("hull.block_coefficient", h.block_coefficient, 0.1, 1.0, "a share of L B d"),
            range("hull.x_g", h.x_g, -0.25 * h.lpp, 0.25 * h.lpp, "in m forward of midship, within L / 4"),
            range(
                "hull.gyration",
                h.gyration,
                0.1,
                0.5,
                "the yaw radius of gyration as a share of L, about 0.25; divide a radius in m by L",
            ),
            range(
                "hull.water_density",
                h.water_density,
                900.0,
                1100.0,
                "kg/m3, 1025 in the sea and 1000 in fresh water",
            ),
        ]
    }

    fn propulsion_ranges(&self) -> Vec<Range> {
        if self.propeller.is_none() && self.rudder.is_none() {
            return Vec::new();
        }
        let (h, p, r) = (&self.hull, &self.propeller, &self.rudder);
        vec![
            range(
                "propeller.diameter",
                p.diameter,
                0.02 * h.draught,
                1.5 * h.draught,
                "the diameter in m, at most one and a half draughts; is it in mm or cm?",
            ),
            range(
                "propeller.x",
                self.propeller_x(),
                -0.7 * h.lpp,
                0.0,
                "in m forward of midship, so that aft is negative; about -0.48 L",
            ),
            range("propeller.wake", p.wake, -0.2, 0.95, "the wake fraction, a share of the ship's speed"),
            range(
                "propeller.thrust_deduction",
                p.thrust_deduction,
                -0.2,
                0.95,
                "the thrust deduction, a share of the thrust",
            ),
            range("propeller.astern", p.astern, 0.0, 2.0, "thrust astern over thrust ahead, about 0.74"),
            range(
                "rudder.area",
                r.area,
                1e-4 * h.lpp * h.draught,
                0.25 * h.lpp * h.draught,
                "the area in m2, about L d / 50",
            ),
            range("rudder.span", r.span, 0.02 * h.draught, 2.0 * h.draught, "the span in m, at most two draughts"),
            range(
                "rudder.x",
                self.rudder_x(),
                -0.7 * h.lpp,
                0.0,
                "in m forward of midship, so that aft is negative; about -0.5 L",
            ),
            range("rudder.straightening", r.straightening, 0.0, 2.0, "the flow straightening, about 0.45"),
            range("rudder.lever", r.lever, -2.0, 0.0, "a share of L, negative aft; about -0.85"),
            range("rudder.wake_ratio", r.wake_ratio, 0.1, 5.0, "the wake ratio, about 1.05"),
            range("rudder.race", r.race, 0.0, 2.0, "the propeller race factor, about 0.5"),
        ]
    }

    fn other_ranges(&self) -> Vec<Range> {
        let h = &self.hull;
        let tiny = f64::MIN_POSITIVE;
        let mut ranges = Vec::new();
        if let Some(speed) = h.service_speed {
            let fastest = (GRAVITY * h.lpp).sqrt();
            ranges.push(range(
                "hull.service_speed",
                speed,
                tiny,
                fastest,
                "the service speed in m/s, up to a Froude number of 1",
            ));
        }
        if let Some(rate) = self.rudder.rate_deg_s {
            ranges.push(range(
                "rudder.rate_deg_s",
                rate,
                tiny,
                200.0,
                "the rate of the rudder in deg/s, about 2.3 of a ship",
            ));
        }
        if let Some(a) = &self.above_water {
            let lateral = h.lpp * (h.lpp + h.breadth);
            ranges.extend([
                range(
                    "above_water.frontal_area",
                    a.frontal_area,
                    tiny,
                    10.0 * h.breadth * h.lpp,
                    "the frontal area in m2",
                ),
                range("above_water.lateral_area", a.lateral_area, tiny, lateral, "the lateral area in m2"),
                range("above_water.length_overall", a.length_overall, 0.8 * h.lpp, 2.0 * h.lpp, "in m, about L"),
                range("above_water.air_density", a.air_density, 0.5, 2.0, "kg/m3, about 1.225"),
            ]);
        }
        if let Some(t) = &self.thruster {
            ranges.extend([
                range("thruster.thrust", t.thrust, 0.0, 1e8, "the thrust in N"),
                range("thruster.x", t.x, -0.7 * h.lpp, 0.7 * h.lpp, "in m forward of midship, within the ship"),
            ]);
        }
        ranges
    }

    /// The mass against the displacement rho L B d C_b: a factor of two is a wrong unit.
    fn mass_error(&self, source: &Source<'_>) -> Option<ShipError> {
        let h = &self.hull;
        let displaced = h.water_density * h.lpp * h.breadth * h.draught * h.block_coefficient;
        let expected = format!("kg is not the {displaced:.4e} kg that rho L B d C_b displaces; is the mass in kg?");
        (!(0.5..2.0).contains(&(h.mass / displaced))).then(|| source.value("hull.mass", h.mass, &expected))
    }

    /// Names that are no coefficients, and coefficients that are given in both tables, of which one would go unread.
    fn unknown_coefficients(&self, source: &Source<'_>) -> Vec<ShipError> {
        let known: Vec<&str> = COEFFICIENTS.iter().map(|(n, _)| *n).collect();
        let fail = |name: &str, message| ShipError::Parse {
            path: source.path.to_path_buf(),
            line: source.line(name),
            message,
        };
        let given = self.coefficients.keys().chain(self.coefficients_prime.keys());
        let unknown = given.filter(|name| !known.contains(&name.as_str())).map(|name| {
            let near = crate::files::suggestion(name, known.iter().copied());
            fail(name, format!("unknown coefficient `{name}`{near}; known are {}", known.join(", ")))
        });
        let both = self.coefficients.keys().filter(|name| self.coefficients_prime.contains_key(*name)).map(|name| {
            let text = format!("`{name}` is in [coefficients] and in [coefficients_prime]; keep one of them");
            fail(name, text)
        });
        unknown.chain(both).collect()
    }

    /// Coefficients that are in the table of the other form: a prime value where one in SI units belongs, or the reverse. What is
    /// published of ships lies between 0.0001 and 2 as a prime; the limits are a good order of magnitude beyond.
    fn coefficients_of_another_size(&self, source: &Source<'_>) -> Vec<ShipError> {
        let unit = |power: i32| 0.5 * self.hull.water_density * self.hull.lpp.powi(power) * self.hull.draught;
        let power = |name: &str| COEFFICIENTS.iter().find(|(n, _)| *n == name).map_or(0, |(_, power)| *power);
        let si = self.coefficients.iter().filter_map(|(name, value)| {
            let prime = (value / unit(power(name))).abs();
            let expected = format!(
                "is {prime:.1e} without dimension, which no ship has; values without dimension stand in [coefficients_prime]"
            );
            (prime > 0.0 && !(5e-6..=50.0).contains(&prime)).then_some((name, *value, expected))
        });
        let prime = self.coefficients_prime.iter().filter_map(|(name, value)| {
            let expected = "is more than any ship has without dimension; values in SI units stand in [coefficients]";
            (value.abs() > 50.0).then(|| (name, *value, expected.to_owned()))
        });
        si.chain(prime).map(|(name, value, expected)| source.value(name, value, &expected)).collect()
    }

    /// (m - Y_vdot)(I_z - N_rdot) - (m x_G - Y_rdot)(m x_G - N_vdot), which must be positive.
    pub fn mass_determinant(&self) -> f64 {
        let c = |n: &str| self.coefficient(n);
        let (m, xg) = (self.hull.mass, self.hull.x_g);
        (m - c("Yvdot")) * (self.yaw_inertia() - c("Nrdot")) - (m * xg - c("Yrdot")) * (m * xg - c("Nvdot"))
    }

    /// Yaw moment of inertia about midship \[kg m2\]: `m (k L)^2 + m x_G^2`.
    pub fn yaw_inertia(&self) -> f64 {
        let h = &self.hull;
        h.mass * ((h.gyration * h.lpp).powi(2) + h.x_g * h.x_g)
    }

    /// Propeller position x_P \[m\]; -0.48 L where the file does not give it.
    pub fn propeller_x(&self) -> f64 {
        self.propeller.x.unwrap_or(-0.48 * self.hull.lpp)
    }

    /// Rudder position x_R \[m\]; -0.5 L where the file does not give it.
    pub fn rudder_x(&self) -> f64 {
        self.rudder.x.unwrap_or(-0.5 * self.hull.lpp)
    }

    /// Small speed below which the dynamics are regularised \[m/s\]: 0.002 sqrt(g L) (5.8 cm/s for an 85 m ship).
    pub fn small_speed(&self) -> f64 {
        0.002 * (GRAVITY * self.hull.lpp).sqrt()
    }

    /// A dimensional hull coefficient (SI): from the file (`coefficients`, then `coefficients_prime`), else estimated.
    ///
    /// Linear derivatives and added masses by Clarke, Gedling & Hine 1982; surge added mass by the Zhou 1983 regression of Motora's charts; X_vr by
    /// Hasegawa 1980; nonlinear derivatives by the Zhou 1983 regression of the charts of Inoue, Hirano & Kijima 1981.
    /// Signs and units follow the equation in [`crate::terms::hydrodynamics::hull`]. An unknown name gives 0.
    pub fn coefficient(&self, name: &str) -> f64 {
        if let Some(value) = self.coefficients.get(name) {
            return *value;
        }
        let h = &self.hull;
        let prime_to_si =
            |prime: f64, length_power: i32| prime * 0.5 * h.water_density * h.lpp.powi(length_power) * h.draught;
        if let Some(prime) = self.coefficients_prime.get(name) {
            let power = COEFFICIENTS.iter().find(|(n, _)| *n == name).map_or(0, |(_, p)| *p);
            return prime_to_si(*prime, power);
        }
        let (l, b, d, cb) = (h.lpp, h.breadth, h.draught, h.block_coefficient);
        // Clarke's coefficients are made dimensionless with powers of L alone: L/d times those of the L-d normalisation.
        let clarke =
            |bracket: f64, length_power: i32| prime_to_si(-PI * (d / l).powi(2) * bracket * l / d, length_power);
        let fullness = (1.0 - cb) * d / b;
        let x_c = cb * b / l;
        match name {
            "Xudot" => {
                let (lb, db) = (l / b, d / b);
                let percent = 0.398 + 11.97 * cb * (1.0 + 3.73 * db) - 2.89 * cb * lb * (1.0 + 1.13 * db)
                    + 0.175 * cb * lb * lb * (1.0 + 0.541 * db)
                    - 1.107 * lb * db;
                -0.01 * h.mass * percent
            }
            "Yvdot" => clarke(1.0 + 0.16 * cb * b / d - 5.1 * (b / l).powi(2), 2),
            "Yrdot" => clarke(0.67 * b / l - 0.0033 * (b / d).powi(2), 3),
            "Nvdot" => clarke(1.1 * b / l - 0.041 * b / d, 3),
            "Nrdot" => clarke(1.0 / 12.0 + 0.017 * cb * b / d - 0.33 * b / l, 4),
            "Xvr" => (1.75 * cb - 0.525 - 1.0) * -self.coefficient("Yvdot"),
            "Yv" => clarke(1.0 + 0.40 * cb * b / d, 1),
            "Yr" => clarke(-0.5 + 2.2 * b / l - 0.080 * b / d, 2),
            "Nv" => clarke(0.5 + 2.4 * d / l, 2),
            "Nr" => clarke(0.25 + 0.039 * b / d - 0.56 * b / l, 3),
            "Yvv" => prime_to_si(0.048265 - 6.293 * fullness, 1),
            "Yvr" => prime_to_si(-0.3791 + 1.28 * fullness, 2),
            "Yrr" => prime_to_si(0.0045 - 0.445 * fullness, 3),
            "Nrr" => prime_to_si(-0.0805 + 8.6092 * x_c * x_c - 36.9816 * x_c.powi(3), 4),
            "Nrrv" => prime_to_si(-0.05877 + 0.43958 * cb * d / b, 4),
            "Nvvr" => prime_to_si(-0.42361 - 3.5193 * x_c + 135.4668 * x_c * x_c - 686.3107 * x_c.powi(3), 3),
            _ => 0.0,
        }
    }
}

/// From these the ranges of the others follow.
const MAIN_DIMENSIONS: [&str; 3] = ["hull.lpp", "hull.breadth", "hull.draught"];

/// A particular and the range it must be in.
fn range(key: &'static str, value: f64, low: f64, high: f64, meaning: &'static str) -> Range {
    Range { key, value, limits: [low, high], meaning }
}

/// See [`range`].
#[derive(Clone)]
struct Range {
    /// Dotted key.
    key: &'static str,
    value: f64,
    /// Smallest and largest value.
    limits: [f64; 2],
    /// What it is, and in which unit.
    meaning: &'static str,
}

/// The text of a ship file and its path: where a message points to.
struct Source<'a> {
    text: &'a str,
    path: &'a Path,
}

impl Source<'_> {
    /// The line, counted from 1, that sets a key: that of a table (`hull.mass`), or a quoted one in a table of free names; that of
    /// the table, or 1, where the file leaves it out.
    fn line(&self, key: &str) -> usize {
        let (table, last) = key.split_once('.').unwrap_or(("", key));
        let sets = |line: &str, name: &str| {
            let rest = line.trim_start().trim_start_matches('"').strip_prefix(name);
            rest.is_some_and(|rest| rest.trim_start_matches('"').trim_start().starts_with('='))
        };
        let heading = format!("[{table}]");
        let start = self.text.lines().position(|l| l.trim() == heading);
        let inside = |start: usize| {
            let mut lines = self.text.lines().skip(start + 1).take_while(|l| !l.trim_start().starts_with('['));
            start + 1 + lines.position(|l| sets(l, last)).map_or(0, |i| i + 1)
        };
        if let Some(quoted) = self.text.lines().position(|l| l.trim_start().starts_with('"') && sets(l, key)) {
            return quoted + 1;
        }
        let whole = || self.text.lines().position(|l| sets(l, key) || sets(l, last)).map_or(1, |i| i + 1);
        start.map_or_else(whole, inside)
    }

    /// The line, counted from 1, on which a text in quotes first stands; 1 where it does not.
    fn line_of_text(&self, text: &str) -> usize {
        let quoted = [format!("\"{text}\""), format!("'{text}'")];
        let has = |line: &str| quoted.iter().any(|q| line.contains(q)) || line.trim() == format!("[[{text}]]");
        self.text.lines().position(has).map_or(1, |i| i + 1)
    }

    /// The error of a value that no ship can have.
    fn value(&self, key: &str, found: f64, expected: &str) -> ShipError {
        ShipError::Value {
            path: self.path.to_path_buf(),
            line: self.line(key),
            key: key.into(),
            found,
            expected: expected.into(),
        }
    }
}

/// What a file of a craft without propeller and rudder has: table, key and unit.
const REQUIRED_OF_A_CRAFT: [[&str; 3]; 4] = [
    ["", "name", "name"],
    ["hull", "lpp", "hull.lpp [m]"],
    ["hull", "breadth", "hull.breadth [m]"],
    ["hull", "mass", "hull.mass [kg]"],
];

/// What every file of a ship with propeller and rudder has: table, key and unit.
const REQUIRED: [[&str; 3]; 12] = [
    ["", "name", "name"],
    ["hull", "lpp", "hull.lpp [m]"],
    ["hull", "breadth", "hull.breadth [m]"],
    ["hull", "draught", "hull.draught [m]"],
    ["hull", "mass", "hull.mass [kg]"],
    ["hull", "block_coefficient", "hull.block_coefficient [-]"],
    ["propeller", "diameter", "propeller.diameter [m]"],
    ["propeller", "wake", "propeller.wake [-]"],
    ["propeller", "thrust_deduction", "propeller.thrust_deduction [-]"],
    ["propeller", "thrust_coefficients", "propeller.thrust_coefficients [-]"],
    ["rudder", "area", "rudder.area [m2]"],
    ["rudder", "span", "rudder.span [m]"],
];

/// Which of the required values the text of a ship file does not have.
fn missing(text: &str) -> Vec<&'static str> {
    let Ok(file) = text.parse::<toml::Table>() else { return Vec::new() };
    let has = |table: &str, key: &str| match table {
        "" => file.contains_key(key),
        _ => file.get(table).and_then(toml::Value::as_table).is_some_and(|t| t.contains_key(key)),
    };
    let required = if ["propeller", "rudder"].iter().any(|table| file.contains_key(*table)) {
        &REQUIRED[..]
    } else {
        &REQUIRED_OF_A_CRAFT[..]
    };
    required.iter().filter(|[table, key, _]| !has(table, key)).map(|[_, _, named]| *named).collect()
}

/// The command that completes a ship file.
fn completion(path: &Path, missing: &[&str]) -> String {
    let lengths = [("hull.lpp [m]", "--lpp"), ("hull.breadth [m]", "--breadth"), ("hull.draught [m]", "--draught")];
    let asked: String =
        lengths.iter().filter(|(key, _)| missing.contains(key)).map(|(_, o)| format!(" {o} METRES")).collect();
    let stem = path.file_stem().map_or("ship".into(), |s| s.to_string_lossy());
    let out = path.with_file_name(format!("{stem}_complete.toml"));
    format!(
        "`trimtab new --from {}{asked} --type TYPE --out {}` (`trimtab new --help` lists the types)",
        path.display(),
        out.display()
    )
}

/// The line, counted from 1, of a ship file that sets a parameter by its dotted name; 1 where it cannot be found.
pub fn parameter_line(path: &Path, name: &str) -> usize {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let sets = |line: &str| {
        let rest = line.trim_start().trim_start_matches('"').strip_prefix(name);
        rest.is_some_and(|rest| rest.trim_start_matches('"').trim_start().starts_with('='))
    };
    text.lines().position(sets).map_or(1, |i| i + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHIP: &str = include_str!("../study/demo/ship.toml");

    fn message(from: &str, to: &str) -> Option<String> {
        assert!(SHIP.contains(from), "{from}");
        Ship::parse(&SHIP.replacen(from, to, 1), Path::new("ship.toml")).err().map(|e| e.to_string())
    }

    #[test]
    fn what_no_ship_has_is_one_message_with_line_and_next_step() {
        let cases = [
            ("gyration = 0.25", "gyration = 21.25", ":12: hull.gyration", "divide a radius in m by L"),
            ("lpp = 85.0", "lpp = nan", ":6: hull.lpp", "in m"),
            ("mass = 3.359e6", "mass = inf", ":9: hull.mass", "in kg"),
            ("x_g = 0.0", "x_g = nan", ":11: hull.x_g", "within L / 4"),
            ("diameter = 2.85", "diameter = 285", ":16: propeller.diameter", "is it in mm or cm?"),
            ("[0.3425,", "[nan,", ":20: propeller.thrust_coefficients", "correct it"),
            ("span = 3.56", "span = 3.56\nx = 42.5", ":26: rudder.x", "aft is negative"),
            ("wake = 0.28", "wake = 28", ":17: propeller.wake", "a share of the ship's speed"),
            ("\"rudder.lift1\" = 0.864", "\"rudder.lift1\" = nan", ":39: rudder.lift1", "leave the entry out"),
            ("wake = 0.28", "wakes = 0.28", ":17: unknown key", "did you mean `wake`?"),
            (
                "area = 7.9",
                "",
                "ship.toml: a value is missing: rudder.area [m2]",
                "trimtab new --from ship.toml --type",
            ),
        ];
        for (from, to, place, next) in cases {
            let text = message(from, to).unwrap_or_else(|| panic!("{to}: no message"));
            assert!(text.contains(place) && text.contains(next) && !text.contains('\n'), "{to}:\n{text}");
        }
        assert_eq!(message("lpp = 85.0", "lpp = 85.0"), None);
    }

    #[test]
    fn several_wrong_values_are_reported_at_once_and_a_wrong_length_hides_what_follows_from_it() {
        let text = SHIP.replace("wake = 0.28", "wake = 28.0").replace("gyration = 0.25", "gyration = 21.25");
        let said = |text: &str| Ship::parse(text, Path::new("ship.toml")).unwrap_err().to_string();
        let both = said(&text);
        assert!(
            both.lines().count() == 2 && both.contains("ship.toml:12: ") && both.contains("\nship.toml:17: "),
            "{both}"
        );
        let length = said(&text.replace("lpp = 85.0", "lpp = -85.0"));
        assert!(length.lines().count() == 3 && length.contains("hull.lpp = -85"), "{length}");
    }

    #[test]
    fn coefficients_in_the_wrong_table_are_refused() {
        for (tables, words) in [
            ("[coefficients]\nYv = -0.3\n", "without dimension stand in [coefficients_prime]"),
            ("[coefficients_prime]\nYv = -3e5\n", "in SI units stand in [coefficients]"),
            ("[coefficients]\nYv = -5e4\n[coefficients_prime]\nYv = -0.3\n", "keep one of them"),
        ] {
            let said = message("[parameters]", &format!("{tables}[parameters]")).unwrap_or_default();
            assert!(said.contains(words) && said.contains("ship.toml:3"), "{tables}{said}");
        }
        let zero =
            "[coefficients]\nYrdot = 0.0\nYv = -5e4\n[coefficients_prime]\nNv = -0.1\nNrrv = 0.0003\n[parameters]";
        assert_eq!(message("[parameters]", zero), None);
    }

    #[test]
    fn everything_that_is_missing_is_one_message_with_the_command_that_fills_it() {
        let text = "[hull]\nlpp = 85.0\ndraught = 4.2\n[rudder]\narea = 7.9\n";
        let said = Ship::parse(text, Path::new("a/my.toml")).unwrap_err().to_string();
        for [table, key, named] in REQUIRED {
            let given = [("hull", "lpp"), ("hull", "draught"), ("rudder", "area")].contains(&(table, key));
            assert_eq!(said.contains(named), !given, "{named}: {said}");
        }
        let command = "trimtab new --from a/my.toml --breadth METRES --type TYPE --out a/my_complete.toml";
        assert!(said.contains("9 values are missing") && said.contains(command), "{said}");
    }
}
