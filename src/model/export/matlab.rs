//! An exported ship as a MATLAB script, which Octave runs too: a struct of numbers, and the hull force as a function of u, v and r.
//! Numbers are written so that they read back as they are.

use super::{Coefficient, Export};

impl Export {
    /// The script; it leaves the struct `ship` in the workspace.
    #[must_use]
    pub fn matlab(&self) -> String {
        let mut text = format!("%% {} ({})\n", plain(&self.ship), plain(&self.model));
        for line in [self.frame, self.normalisation, self.mmg_note].iter().chain(&self.equations) {
            text += &format!("%  {line}\n");
        }
        if !self.left_out.is_empty() {
            text += &format!("%  Terms of the model that are not exported: {}\n", self.left_out.join(", "));
        }
        text += &format!("ship.name = '{}';\n", plain(&self.ship).replace('\'', "''"));
        for p in &self.particulars {
            text += &format!("ship.{} = {:e}; % [{}] {}\n", p.name, p.value, p.unit, p.about);
        }
        text += "\n% HD coefficients in SI units, and their primes\n";
        for c in &self.hull {
            text += &format!("ship.hd.{} = {:e}; % [{}] {}\n", c.name, c.value, c.unit, c.about);
        }
        for Coefficient { name, prime, divided_by, .. } in &self.hull {
            if let (Some(prime), Some(by)) = (prime, divided_by) {
                text += &format!("ship.prime.{name} = {prime:e}; % over {by}\n");
            }
        }
        text += "\n% MMG form\n";
        for p in &self.mmg {
            text += &format!("ship.mmg.{} = {:e}; % {}\n", p.name, p.value, p.definition);
        }
        text += "\n% What else moves the craft and holds it back\n";
        for c in &self.others {
            text += &format!("ship.{} = {:e}; % [{}] {}\n", c.name, c.value, c.unit, c.about);
        }
        for a in &self.actuators {
            let place = format!("ship.actuators.{}", a.name);
            text += &format!(
                "\n% {}: {}\n{place}.x = {:e}; % [m]\n{place}.y = {:e}; % [m]\n",
                a.name, a.equation, a.x, a.y
            );
            if let Some(angle) = a.angle {
                text += &format!("{place}.angle = {angle:e}; % [deg]\n");
            }
            for c in &a.parameters {
                text += &format!("{place}.{} = {:e}; % [{}] {}\n", c.name, c.value, c.unit, c.about);
            }
        }
        text + &self.hull_force()
    }

    /// The hull force as a function: what stands on the right of the equations.
    fn hull_force(&self) -> String {
        if self.equations == super::mmg::EQUATIONS {
            return super::mmg::MATLAB.to_owned();
        }
        if self.equations == super::general::EQUATIONS {
            return super::general::MATLAB.to_owned();
        }
        let regular = self.equations[2].contains("Yv |u| v");
        let (even, odd) = if regular { ("absu(u)", "u") } else { ("U(u,v)", "U(u,v)") };
        format!(
            "
% Hull force [X; Y; N] in N and N m at u, v [m/s] and r [rad/s]
h = ship.hd; s = ship.small;
U = @(u,v) sqrt(u.^2 + v.^2 + s^2);
absu = @(u) sqrt(u.^2 + s^2);
absr = @(r) sqrt(r.^2 + (s/ship.L)^2);
ship.hull_force = @(u,v,r) [ ...
  (h.mass + h.Xvr - h.Yvdot)*v.*r + (h.mass*h.x_g - h.Yrdot)*r.^2; ...
  h.Yv*{even}.*v + h.Yr*{odd}.*r + h.Yvv*v.*absu(v) + h.Yvr*v.*absr(r) + h.Yrr*r.*absr(r) - h.mass*u.*r; ...
  h.Nv*{odd}.*v + h.Nr*{even}.*r + h.Nrr*r.*absr(r) + h.Nrrv*r.^2.*v./U(u,v) + h.Nvvr*v.^2.*r./U(u,v) - h.mass*h.x_g*u.*r];
"
        )
    }
}

/// A name without what would end a line or a comment.
fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
