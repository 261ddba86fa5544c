//! Propeller and rudder as the two MMG-like simulators share them: thrust, and the inflow at the rudder by momentum theory.
//! Wake laws, side forces and the rudder's own force law belong to each simulator; the third simulator has its own numbers.

use std::f64::consts::PI;

use super::blend::astern_weight;
use super::propeller::OpenWater;

/// Propeller, wake and thrust deduction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propeller {
    /// Diameter D_P \[m\].
    pub diameter: f64,
    /// Open-water law.
    pub open_water: OpenWater,
    /// Factor on the open-water thrust, 1 when clean.
    pub thrust_factor: f64,
    /// Thrust deduction t_P, ahead rotation only.
    pub thrust_deduction: f64,
    /// Wake fraction on a straight course w_P0.
    pub wake: f64,
    /// Position x_P / L, forward positive.
    pub position: f64,
    /// Strength of the side force of an astern screw; 0 for none, positive for a right-handed screw.
    pub side_force: f64,
}

impl Propeller {
    /// Thrust before deduction \[N\] at propeller rate `n` \[rps\] and inflow speed `va` \[m/s\].
    pub fn thrust(&self, n: f64, va: f64, rho: f64) -> f64 {
        self.thrust_factor * self.open_water.thrust(n, va, self.diameter, rho)
    }

    /// Thrust after deduction \[N\], which fades out with astern rotation.
    pub fn effective(&self, thrust: f64, u: f64, n: f64) -> f64 {
        thrust * (1.0 - self.thrust_deduction * (1.0 - astern_weight(n, self.diameter, u)))
    }
}

/// Rudder and its interaction with hull and screw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rudder {
    /// Area A_R \[m^2\].
    pub area: f64,
    /// Span H_R \[m\].
    pub span: f64,
    /// Steering deduction t_R.
    pub deduction: f64,
    /// Rudder force increase a_H.
    pub hull_increase: f64,
    /// Its position x_H / L.
    pub hull_position: f64,
    /// Position x_R / L.
    pub position: f64,
    /// Effective position in the inflow l_R / L.
    pub inflow_position: f64,
    /// Flow straightening gamma_R for lateral inflow from port (negative) and from starboard.
    pub straightening: [f64; 2],
    /// Wake ratio epsilon.
    pub wake_ratio: f64,
    /// Race factor kappa.
    pub race: f64,
    /// k_x of the suction of an astern screw.
    pub astern_race: f64,
    /// C_PR of the inflow behind an astern screw.
    pub astern_loss: f64,
    /// Offset added to the rudder angle \[rad\].
    pub offset: f64,
}

impl Rudder {
    /// Longitudinal inflow u_R \[m/s\] behind a propeller with thrust \[N\] before deduction in inflow `va` \[m/s\].
    ///
    /// Ahead u_R = epsilon sqrt(eta (u_P + kappa (sqrt(u_P^2 + 8 T/(pi rho D^2)) - u_P))^2 + (1 - eta) u_P^2), which is eq. 21 of
    /// Yasukawa & Yoshimura (2015) multiplied out with J. With astern rotation the race is replaced by the suction
    /// -k_x sqrt(8 |T|/(pi rho D^2)) and the loss C_PR u^2 (Kitagawa).
    pub fn axial_inflow(&self, p: &Propeller, rho: f64, [u, n]: [f64; 2], thrust: f64, va: f64) -> f64 {
        // Acceleration of the water through the screw disc far behind it, squared.
        let race = 8.0 * thrust / (PI * rho * p.diameter * p.diameter);
        let astern = astern_weight(n, p.diameter, u);
        let (ratio, astern_loss) = if u >= 0.0 { (self.wake_ratio, self.astern_loss * astern) } else { (1.0, 0.0) };
        let ahead_gain = self.wake_ratio * self.race * ((va * va + race).max(0.0).sqrt() - va.abs());
        let astern_gain = -self.astern_race * (-race).max(0.0).sqrt();
        let behind = ratio * va + (1.0 - astern) * ahead_gain + astern * astern_gain;
        let beside = ratio * va;
        let eta = (p.diameter / self.span).min(1.0);
        let squared = eta * behind * behind.abs() + (1.0 - eta) * beside * beside.abs() + astern_loss * u * u;
        squared.signum() * squared.abs().sqrt()
    }

    /// Lateral inflow v_R \[m/s\]: the lateral flow before the rudder, straightened by the factor of its side.
    pub fn straightened(&self, lateral: f64) -> f64 {
        lateral * if lateral < 0.0 { self.straightening[0] } else { self.straightening[1] }
    }

    /// Lever of the rudder's side force with the part a_H that it induces on the hull, over L.
    pub fn lever(&self) -> f64 {
        self.position + self.hull_increase * self.hull_position
    }

    /// The numbers that no chart gives exactly, by reference.
    pub fn uncertain(&mut self) -> [&mut f64; 9] {
        let [from_port, from_starboard] = &mut self.straightening;
        [
            &mut self.deduction,
            &mut self.hull_increase,
            &mut self.hull_position,
            &mut self.inflow_position,
            from_port,
            from_starboard,
            &mut self.wake_ratio,
            &mut self.race,
            &mut self.astern_race,
        ]
    }
}
