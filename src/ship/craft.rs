//! A craft that is not a ship with one propeller and one rudder: what stands in for these, and the particulars that it may leave out.
//! What its actuators do is theirs.

use super::actuator::{self, Actuator, Drive};
use super::{PropellerParticulars, RudderParticulars, Ship, ShipError, Source};
use crate::state::Inputs;
use std::collections::BTreeMap;

/// Block coefficient of a craft that gives neither it nor its draught \[-\]: the middle of 0.5 (yachts, catamaran hulls) and 0.7.
const USUAL_BLOCK: f64 = 0.6;

impl PropellerParticulars {
    /// No propeller: it gives no thrust at any rate. The diameter is a unit of length, and nothing follows from it.
    pub(super) fn none() -> Self {
        Self {
            diameter: 1.0,
            x: None,
            wake: 0.0,
            thrust_deduction: 0.0,
            thrust_coefficients: [0.0; 3],
            astern: super::default_astern(),
            left_handed: false,
        }
    }

    /// Whether there is none.
    pub(super) fn is_none(&self) -> bool {
        self.thrust_coefficients == [0.0; 3]
    }
}

impl RudderParticulars {
    /// No rudder: it has no area.
    pub(super) fn none() -> Self {
        Self {
            area: 0.0,
            span: 1.0,
            x: None,
            straightening: super::default_straightening(),
            lever: super::default_lever(),
            wake_ratio: super::default_wake_ratio(),
            race: super::default_race(),
            rate_deg_s: None,
        }
    }

    /// Whether there is none.
    pub(super) fn is_none(&self) -> bool {
        self.area == 0.0
    }
}

impl Ship {
    /// Whether the craft has the propeller that the channel `n` drives.
    pub fn has_propeller(&self) -> bool {
        !self.propeller.is_none()
    }

    /// Whether the craft has the rudder that the channel `delta` turns.
    pub fn has_rudder(&self) -> bool {
        !self.rudder.is_none()
    }

    /// Names of the channels of its named actuators, in the order in which a simulation has them.
    pub fn commands(&self) -> Vec<String> {
        actuator::channels(&self.actuators)
    }

    /// The named actuator of this name.
    pub fn actuator(&self, name: &str) -> Option<&Actuator> {
        self.actuators.iter().find(|a| a.name == name)
    }

    /// Values of parameters that the ship file gives, by dotted name: those of `[parameters]`, and those in `[[actuator]]`.
    pub fn given_parameters(&self) -> BTreeMap<String, f64> {
        let mut given = self.parameters.clone();
        for a in &self.actuators {
            for (name, value) in a.starts(self.hull.lpp, self.hull.block_coefficient) {
                given.entry(format!("{}.{name}", a.name)).or_insert(value);
            }
        }
        given
    }

    /// Whether there is a propeller that trials can be sailed with: that of `n`, or a named one that pushes along the keel.
    pub fn is_driven(&self) -> bool {
        self.has_propeller() || self.actuators.iter().any(|a| a.drives_ahead() != 0.0)
    }

    /// Whether there is something to steer trials with: the rudder of `delta`, or a named actuator aft that turns.
    pub fn is_steered(&self) -> bool {
        self.has_rudder() || self.actuators.iter().any(|a| a.steers() != 0.0)
    }

    /// What acts on the craft at `t` \[s\] where every propeller turns at `n` \[1/s\] ahead and every rudder is at `delta` \[rad\], positive to
    /// starboard: `n` and `delta`, and of the named actuators the rates along the keel and the angles aft, others at rest.
    pub fn inputs_ordered(&self, t: f64, n: f64, delta: f64) -> Inputs<f64> {
        let mut inputs = Inputs::actuators(t, n, delta);
        let ordered = self.actuators.iter().flat_map(|a| {
            a.drives().into_iter().map(|drive| match drive {
                Drive::Rate => a.drives_ahead() * n,
                Drive::Angle => a.steers() * delta,
                _ => 0.0,
            })
        });
        for (command, order) in inputs.commands.iter_mut().zip(ordered) {
            *command = order;
        }
        inputs
    }

    /// The rudder angle \[rad\] and the propeller rate \[1/s\] that the commands of its named actuators amount to, as
    /// [`Self::inputs_ordered`] gives them: means over those that steer and those that drive. Those of `[rudder]` and `[propeller]` where it has them.
    pub fn helm_and_shaft(&self, inputs: &Inputs<f64>) -> [f64; 2] {
        let (mut helm, mut shaft) = ([0.0; 2], [0.0; 2]);
        let drives = self.actuators.iter().flat_map(|a| a.drives().into_iter().map(move |drive| (a, drive)));
        for ((a, drive), command) in drives.zip(inputs.commands) {
            let (sum, sign, value) = match drive {
                Drive::Angle => (&mut helm, a.steers(), command.sin().atan2(command.cos())),
                Drive::Rate => (&mut shaft, a.drives_ahead(), command),
                _ => continue,
            };
            if sign != 0.0 {
                (sum[0], sum[1]) = (sum[0] + sign * value, sum[1] + 1.0);
            }
        }
        let mean = |[sum, count]: [f64; 2], own: f64| if count > 0.0 { sum / count } else { own };
        [
            if self.has_rudder() { inputs.delta } else { mean(helm, inputs.delta) },
            if self.has_propeller() { inputs.n } else { mean(shaft, inputs.n) },
        ]
    }

    /// Length \[m\] that the advance of a propeller is measured with: its diameter, of a thruster of unknown make 2 % of the length.
    pub fn screw_diameter(&self) -> f64 {
        let named = self.actuators.iter().find_map(|a| a.diameter);
        if self.has_propeller() { self.propeller.diameter } else { named.unwrap_or(0.02 * self.hull.lpp) }
    }

    /// Draught and block coefficient where the file leaves them out: the one that is missing from m = rho L B d C_b.
    pub(super) fn complete(&mut self) {
        let h = &mut self.hull;
        let box_of_unit_height = h.water_density * h.lpp * h.breadth;
        if h.draught == 0.0 {
            if h.block_coefficient == 0.0 {
                h.block_coefficient = USUAL_BLOCK;
            }
            h.draught = h.mass / (box_of_unit_height * h.block_coefficient);
        } else if h.block_coefficient == 0.0 {
            h.block_coefficient = (h.mass / (box_of_unit_height * h.draught)).clamp(0.1, 1.0);
        }
    }

    /// What is wrong with the named actuators.
    pub(super) fn actuator_faults(&self, source: &Source<'_>) -> Vec<ShipError> {
        let parse = |key: &str, message: String| ShipError::Parse {
            path: source.path.to_path_buf(),
            line: source.line_of_text(key),
            message,
        };
        let of = |a: &Actuator| {
            let faults = a.faults(self.hull.lpp).into_iter();
            let fault = |(key, found, expected): (&str, f64, String)| {
                let found = if found.is_nan() { String::new() } else { format!(" = {found}") };
                parse(&a.name, format!("actuator `{}`: {key}{found} {expected}", a.name))
            };
            faults.map(fault).collect::<Vec<_>>()
        };
        let list = actuator::list_fault(&self.actuators).map(|(key, message)| parse(&key, message));
        list.into_iter().chain(self.actuators.iter().flat_map(of)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const CRAFT: &str = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 15.0\n";

    fn craft(more: &str) -> Result<Ship, String> {
        Ship::parse(&format!("{CRAFT}{more}"), Path::new("ship.toml")).map_err(|e| e.to_string())
    }

    #[test]
    fn a_craft_needs_mass_length_and_breadth_alone() {
        let ship = craft("").unwrap();
        assert!(!ship.has_propeller() && !ship.has_rudder() && ship.actuators.is_empty());
        let h = &ship.hull;
        let displaced = h.water_density * h.lpp * h.breadth * h.draught * h.block_coefficient;
        assert!((displaced - h.mass).abs() < 1e-12);
        let written: toml::Table = toml::from_str(&toml::to_string(&ship).unwrap()).unwrap();
        assert!(!written.contains_key("propeller") && !written.contains_key("rudder"));
        assert!(craft("x_g = 0.0\n[rudder]\narea = 0.1\n").unwrap_err().contains("propeller.diameter [m]"));
        let bare = Ship::parse("name = \"a\"\n[hull]\nlpp = 2.0\n", Path::new("s.toml")).unwrap_err().to_string();
        assert!(bare.contains("hull.breadth [m]") && bare.contains("hull.mass [kg]") && !bare.contains("rudder"));
    }

    #[test]
    fn what_an_actuator_gives_is_where_its_parameters_begin() {
        let ship =
            craft("[[actuator]]\nname = \"port\"\nlaw = \"thruster\"\nangle = 0\ny = -0.3\ngain = 0.02\nlag = 0.4\n");
        let given = ship.unwrap().given_parameters();
        assert_eq!((given["port.gain"], given["port.lag"], given.contains_key("port.astern")), (0.02, 0.4, false));
    }

    #[test]
    fn the_helm_of_an_azimuth_aft_is_the_angle_that_turns_the_same_way() {
        let ship = craft(
            "[[actuator]]\nname = \"aft\"\nlaw = \"thruster\"\nx = -0.5\n[[actuator]]\nname = \"bow\"\nlaw = \"thruster\"\nx = 0.5\n",
        );
        let ship = ship.unwrap();
        let inputs = ship.inputs_ordered(0.0, 4.0, 0.3);
        assert_eq!(inputs.commands[..4], [4.0, -0.3, 4.0, 0.0]);
        let [helm, shaft] = ship.helm_and_shaft(&inputs);
        assert!((helm - 0.3).abs() < 1e-12 && shaft == 4.0);
    }

    #[test]
    fn a_fault_of_an_actuator_has_its_line() {
        let said = craft(
            "[[actuator]]\nname = \"a\"\nlaw = \"order\"\n[[actuator]]\nname = \"bow\"\nlaw = \"order\"\nx = 9\n",
        );
        let said = said.unwrap_err();
        assert!(said.contains("ship.toml:10: actuator `bow`: x = 9 must be between -1.2 and 1.2"), "{said}");
    }
}
