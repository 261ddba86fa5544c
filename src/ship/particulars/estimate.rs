//! The estimates: from main dimensions and type to every value of a ship file, each by its regression.
//! Hull coefficients are not here: [`Ship::coefficient`] estimates them from the finished file whenever they are needed.

use super::estimated::Estimated;
use super::kind::Kind;
use super::resistance::{form_factor, friction, wetted_surface};
use super::screw::quadratic;
use super::sheet::{Sheet, at, number, rounded};
use super::write::ship_text;
use crate::ship::rudder::{induced_force, normal_slope};
use crate::ship::{Ship, ShipError};
use crate::units::GRAVITY;
use std::f64::consts::PI;
use std::path::Path;
use toml::{Table, Value};

/// Why a ship could not be estimated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EstimateError {
    /// One of the three lengths from which all else follows is not given, or is no length.
    #[error("{key} must be given as a positive number in m: every estimate begins with length, breadth and draught")]
    Dimension {
        /// Dotted key.
        key: &'static str,
    },
    /// A value that is given contradicts what a ship can have.
    #[error("{0}")]
    Impossible(String),
}

const TOWNSIN: &str = "C_b = 0.7 + atan((23 - 100 Fn)/4)/8, Watson 1998, Practical Ship Design, eq. 3.14, p. 76";
const SLENDER: &str = "engineering estimate for round-bilge displacement craft, no published regression";
const MASS: &str = "m = rho C_b L B d";
const X_G: &str = "even keel, so that x_G is the centre of buoyancy: (8.80 - 38.9 Fn) % of L, Schneekluth & Bertram 1998, Ship Design for Efficiency and Economy, ch. 2";
const X_G_FULL: &str = "even keel, so that x_G is the centre of buoyancy: (-13.5 + 19.4 C_P) % of L for tankers and bulk carriers, Schneekluth & Bertram 1998, Ship Design for Efficiency and Economy, ch. 2";
const GYRATION: &str =
    "0.25 L, ITTC Recommended Procedures 7.5-02-07-02.1 (seakeeping experiments): the radius where none is measured";
const WAKE: &str =
    "w = 0.5 C_b - 0.05 for a single screw, Taylor; Lewis 1988, Principles of Naval Architecture II, ch. VI";
const DEDUCTION: &str = "t = 0.6 w, the middle of Schoenherr's 0.5 to 0.7 behind a streamlined rudder; Lewis 1988, Principles of Naval Architecture II, ch. VI";
const RUDDER: &str = "A_R = L d/100 (1 + 25 (B/L)^2), Det Norske Veritas 1975, the least area behind a propeller; Lewis 1989, Principles of Naval Architecture III, ch. IX";
const SPAN: &str = "aspect ratio 2.0, at most 0.9 d; usual are 1.2 to 2.2, Molland & Turnock 2007, Marine Rudders and Control Surfaces";
const MMG: &str = "engineering estimate for a single-screw ship; KVLCC2 has straightening 0.52, lever -0.71, wake_ratio 1.09, race 0.50 (Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, table 4)";
const AREAS: &str = "engineering estimate by type, no published regression; used by the wind alone";

const LINEAR: &str = "Wagner Smitt 1971, as tabulated by Clarke, Gedling & Hine 1982: of the published regressions that whose trials are nearest to those of free-running ships (`trimtab help ship`)";

/// The linear derivatives of Wagner Smitt over pi d/L, in the L-d normalisation: they depend on nothing else.
const WAGNER_SMITT: [(&str, f64); 4] = [("Yv", -1.59), ("Yr", 0.32), ("Nv", -0.62), ("Nr", -0.21)];

const ADDED_SWAY: &str = "-m_y', regression of Motora's charts by Zhou, Sheng & Feng 1983; used for L/B below 4.5, where that of Clarke fails";
const ADDED_YAW: &str = "-J_zz', regression of Motora's charts by Zhou, Sheng & Feng 1983";
const ADDED_COUPLING: &str = "a hull alike fore and aft";

/// L/B from which the added masses of Clarke, Gedling & Hine 1982 are taken: with less, that of yaw comes near zero \[-\].
const CLARKE_FROM: f64 = 4.5;

/// A whole ship from what is given, a table of the layout of a ship file, and a type. `speed` is the service speed \[m/s\]; without it,
/// that of the type's usual Froude number.
///
/// # Errors
/// [`EstimateError`]: a main dimension that is missing, or a given value that no ship can have.
pub fn estimate(kind: &'static Kind, given: &Table, speed: Option<f64>) -> Result<Estimated, EstimateError> {
    let mut dimensions = [0.0; 3];
    for (value, key) in dimensions.iter_mut().zip(["hull.lpp", "hull.breadth", "hull.draught"]) {
        let found = at(given, key).and_then(number).filter(|x| x.is_finite() && *x > 0.0);
        *value = found.ok_or(EstimateError::Dimension { key })?;
    }
    let service = speed.unwrap_or(kind.froude * (GRAVITY * dimensions[0]).sqrt());
    let main = Main { kind, dimensions, speed: service, froude: service / (GRAVITY * dimensions[0]).sqrt() };
    let mut sheet = Sheet::new(given);
    if !sheet.keep("name") {
        let name = format!("{} of {} m", kind.name.replace('_', " "), dimensions[0]);
        sheet.put("name", Value::String(name), None, "");
    }
    if !sheet.keep("source") {
        let source = "main dimensions given, the rest estimated by `trimtab new`";
        sheet.put("source", Value::String(source.into()), None, "");
    }
    let hull = main.hull(&mut sheet);
    main.propeller(&mut sheet, &hull);
    main.rudder(&mut sheet);
    main.above_water(&mut sheet);
    main.added_mass(&mut sheet, &hull);
    main.derivatives(&mut sheet);
    main.parameters(&mut sheet, &hull);
    sheet.keep_rest();
    let (speed, outside, entries) = (rounded(service, 4), kind.outside(dimensions, main.froude), sheet.entries);
    let text = ship_text(kind.name, speed, &outside, &entries);
    let ship = Ship::parse(&text, Path::new("ship")).map_err(impossible)?;
    Ok(Estimated { ship, kind: kind.name, speed, outside, entries, text })
}

/// What is wrong with a value, without the line of a file that nobody has seen.
fn impossible(error: ShipError) -> EstimateError {
    fn words(error: &ShipError) -> String {
        match error {
            ShipError::Value { key, found, expected, .. } => format!("{key} = {found} {expected}"),
            ShipError::Parse { message, .. } => message.clone(),
            ShipError::Several(errors) => errors.iter().map(words).collect::<Vec<_>>().join("\n"),
            other => other.to_string(),
        }
    }
    EstimateError::Impossible(words(&error))
}

/// What every estimate begins with.
struct Main {
    kind: &'static Kind,
    /// Length between perpendiculars, breadth and draught \[m\].
    dimensions: [f64; 3],
    /// Service speed \[m/s\].
    speed: f64,
    /// Its Froude number.
    froude: f64,
}

/// What other estimates need of the hull.
struct HullEstimate {
    block: f64,
    density: f64,
    mass: f64,
}

impl Main {
    fn hull(&self, sheet: &mut Sheet<'_>) -> HullEstimate {
        let [length, breadth, draught] = self.dimensions;
        for key in ["hull.lpp", "hull.breadth", "hull.draught"] {
            sheet.keep(key);
        }
        sheet.take(
            "hull.service_speed",
            rounded(self.speed, 4),
            None,
            "that the estimates are for; the approach of trials",
        );
        let density = sheet.take("hull.water_density", 1025.0, None, "sea water; 1000 in fresh water");
        let box_mass = density * length * breadth * draught;
        let given_mass = sheet.given_number("hull.mass");
        let (line, source) = match self.kind.block {
            Some(block) => (block, SLENDER.to_owned()),
            None => (
                0.7 + ((23.0 - 100.0 * self.froude) / 4.0).atan() / 8.0,
                format!("{TOWNSIN}, at Fn = {}", rounded(self.froude, 3)),
            ),
        };
        // A mass that no ship of these dimensions can have is reported as such when the file is read.
        let block = match given_mass.filter(|mass| (0.2..1.0).contains(&(mass / box_mass))) {
            Some(mass) => sheet.take("hull.block_coefficient", mass / box_mass, 0.005, "C_b = m / (rho L B d)"),
            None => sheet.take("hull.block_coefficient", line, self.kind.block_spread, &source),
        };
        let mass_spread = self.kind.block_spread * box_mass;
        let mass = sheet.take("hull.mass", box_mass * block, mass_spread, MASS);
        let prismatic = block / if self.kind.full { 0.995 } else { 0.98 };
        let (share, source) =
            if self.kind.full { (-13.5 + 19.4 * prismatic, X_G_FULL) } else { (8.80 - 38.9 * self.froude, X_G) };
        sheet.take("hull.x_g", share.clamp(-4.0, 4.0) / 100.0 * length, 0.015 * length, source);
        sheet.take("hull.gyration", 0.25, 0.0125, GYRATION);
        HullEstimate { block, density, mass }
    }

    fn propeller(&self, sheet: &mut Sheet<'_>, hull: &HullEstimate) {
        let draught = self.dimensions[2];
        let [slope, offset] = self.kind.diameter;
        let diameter = (slope * draught + offset).clamp(0.35 * draught, 0.75 * draught);
        let source = format!("D = {slope} d + {offset} m, 0.35 to 0.75 of d; {}", self.kind.diameter_source);
        sheet.take("propeller.diameter", diameter, 0.15 * diameter, &source.replace("+ -", "- ").replace(" + 0 m", ""));
        let wake = sheet.take("propeller.wake", (0.5 * hull.block - 0.05).max(0.05), 0.08, WAKE);
        sheet.take("propeller.thrust_deduction", 0.6 * wake, 0.06, DEDUCTION);
        if !sheet.keep("propeller.thrust_coefficients") {
            let screw = self.kind.screw;
            let k = quadratic(&screw).map(|k| Value::Float(rounded(k, 4)));
            let source = format!(
                "k0, k1, k2 nearest to the Wageningen B{}-{:.0} with P/D {}, Oosterveld & van Oossanen 1975, table 5",
                screw.blades,
                100.0 * screw.area,
                screw.pitch
            );
            let spread = rounded(0.15 * quadratic(&screw)[0], 2);
            sheet.put("propeller.thrust_coefficients", Value::Array(k.to_vec()), Some(spread), &source);
        }
        sheet.take("propeller.astern", 0.74, 0.2, "B4-70 with P/D 0.8 reversing at rest, Roddy, Hess & Faller 2006");
    }

    fn rudder(&self, sheet: &mut Sheet<'_>) {
        let [length, breadth, draught] = self.dimensions;
        let estimate = length * draught / 100.0 * (1.0 + 25.0 * (breadth / length).powi(2));
        let area = sheet.take("rudder.area", estimate, 0.25 * estimate, RUDDER);
        let span = (2.0 * area).sqrt().min(0.9 * draught);
        sheet.take("rudder.span", span, 0.15 * span, SPAN);
        for (key, value, spread) in [
            ("rudder.straightening", 0.45, 0.15),
            ("rudder.lever", -0.85, 0.2),
            ("rudder.wake_ratio", 1.05, 0.3),
            ("rudder.race", 0.5, 0.2),
        ] {
            sheet.take(key, value, spread, MMG);
        }
    }

    fn above_water(&self, sheet: &mut Sheet<'_>) {
        let [length, breadth, _] = self.dimensions;
        let [frontal, lateral] = self.kind.above_water;
        let (frontal, lateral) = (frontal * breadth * breadth, lateral * length * breadth);
        sheet.take("above_water.frontal_area", frontal, 0.3 * frontal, AREAS);
        sheet.take("above_water.lateral_area", lateral, 0.3 * lateral, AREAS);
        sheet.take(
            "above_water.length_overall",
            1.06 * length,
            0.03 * length,
            "1.06 L, usual of ships with a raked bow",
        );
    }

    /// Added mass of a beamy ship, for which the regressions of Clarke give one that is too small or has the wrong sign.
    fn added_mass(&self, sheet: &mut Sheet<'_>, hull: &HullEstimate) {
        let [length, breadth, draught] = self.dimensions;
        if length / breadth >= CLARKE_FROM {
            return;
        }
        let (cb, lb, db) = (hull.block, length / breadth, draught / breadth);
        let sway = 0.882 - 0.54 * cb * (1.0 - 1.6 * db) - 0.156 * lb * (1.0 - 0.673 * cb)
            + 0.826 * db * lb * (1.0 - 0.678 * db)
            - 0.638 * cb * db * lb * (1.0 - 0.669 * db);
        let radius = 0.01 * (33.0 - 76.85 * cb * (1.0 - 0.784 * cb) + 3.43 * lb * (1.0 - 0.63 * cb));
        // m' = m / (1/2 rho L^2 d)
        let prime = hull.mass / (0.5 * hull.density * length * length * draught);
        let (sway, yaw) = (sway * prime, radius * radius * prime);
        for (name, value, source) in [
            ("Yvdot", -sway, ADDED_SWAY),
            ("Nrdot", -yaw, ADDED_YAW),
            ("Yrdot", 0.0, ADDED_COUPLING),
            ("Nvdot", 0.0, ADDED_COUPLING),
        ] {
            if !sheet.has(&format!("coefficients.{name}")) {
                sheet.take(&format!("coefficients_prime.{name}"), value, 0.3 * value.abs(), source);
            }
        }
    }

    /// The linear derivatives of a ship; of a craft shorter than 4.5 breadths, which no ship's model of the regression is, those of
    /// [`Ship::coefficient`] stay.
    fn derivatives(&self, sheet: &mut Sheet<'_>) {
        let [length, breadth, draught] = self.dimensions;
        if length / breadth < CLARKE_FROM {
            return;
        }
        for (name, factor) in WAGNER_SMITT {
            if !sheet.has(&format!("coefficients.{name}")) {
                let value = factor * PI * draught / length;
                sheet.take(&format!("coefficients_prime.{name}"), value, 0.3 * value.abs(), LINEAR);
            }
        }
    }

    /// Resistance and rudder, where a fit starts; what is given of either is not mixed with estimates.
    fn parameters(&self, sheet: &mut Sheet<'_>, hull: &HullEstimate) {
        let any = |sheet: &Sheet<'_>, names: &[&str]| names.iter().any(|n| sheet.has(&format!("parameters.{n}")));
        if !any(sheet, &["resistance.linear", "resistance.quadratic", "resistance.cubic"]) {
            self.resistance(sheet, hull);
        }
        let rudder = ["lift0", "lift1", "lift2", "lift3", "drag0", "drag1", "drag2"].map(|n| format!("rudder.{n}"));
        if !any(sheet, &rudder.each_ref().map(String::as_str)) {
            rudder_curves(sheet, hull.block);
        }
    }

    fn resistance(&self, sheet: &mut Sheet<'_>, hull: &HullEstimate) {
        let [length, _, draught] = self.dimensions;
        let surface = wetted_surface(length, draught, hull.mass / hull.density);
        let coefficient = (1.0 + form_factor(hull.block, self.dimensions)) * friction(length, self.speed) + 4e-4;
        let quadratic = 0.5 * hull.density * surface * coefficient;
        // Beyond this Froude number wave making is no longer small beside friction.
        let share = if self.froude > 0.25 { 0.6 } else { 0.3 };
        let source = "R = 1/2 rho S ((1+k) C_F + 0.0004) u^2 without wave making: S by Mumford, k by Watanabe, C_F by the ITTC 1957 line; Schneekluth & Bertram 1998, Ship Design for Efficiency and Economy, ch. 6";
        sheet.take("parameters.resistance.quadratic", quadratic, share * quadratic, source);
    }
}

/// Lift and drag of the rudder from the normal force F_N = 1/2 rho A_R U_R^2 f_a sin a, with what the rudder makes the hull do:
/// c_L = (1 + a_H) f_a sin a cos a to the third order, c_D = (1 - t_R) f_a sin^2 a to the second.
fn rudder_curves(sheet: &mut Sheet<'_>, block: f64) {
    let read = |sheet: &Sheet<'_>, key: &str| {
        sheet.entries.iter().find(|e| e.key == key).and_then(|e| number(&e.value)).unwrap_or(1.0)
    };
    let aspect = read(sheet, "rudder.span").powi(2) / read(sheet, "rudder.area");
    let slope = normal_slope(aspect);
    let pull = 1.0 + induced_force(block).max(0.0);
    let normal = "f_a = 6.13 A/(A + 2.25) of Fujii for the aspect ratio A";
    let lift = slope * pull;
    let source = format!("(1 + a_H) f_a, {normal}; a_H = 0.627 C_b - 0.153 of Kijima 1990");
    let lift = sheet.take("parameters.rudder.lift1", lift, 0.15 * lift, &source);
    sheet.take("parameters.rudder.lift3", -2.0 / 3.0 * lift, 0.3 * lift, "-2/3 lift1, third order of sin a cos a");
    sheet.take("parameters.rudder.drag0", 0.01, 0.01, "friction of the blade, engineering estimate");
    let source = format!("(1 - t_R) f_a with t_R = 0.39, {normal}; Yasukawa & Yoshimura 2015, table 4");
    sheet.take("parameters.rudder.drag2", 0.61 * slope, 0.3 * 0.61 * slope, &source);
}
