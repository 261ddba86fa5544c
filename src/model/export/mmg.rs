//! What is exported of a model of form `mmg`: its equations, and the primes as they are published.
//! The primes of the other forms, which have to be converted, are in the parent.

use crate::model::Model;

/// The equations of motion, with the primes of the table `mmg`.
pub(super) const EQUATIONS: [&str; 4] = [
    "(m - Xudot) u' = X; (m - Yvdot) v' + m x_g r' = Y; m x_g v' + (inertia - Nrdot) r' = N; the forces of propeller and rudder are added to the right; v' = v/U and r' = r L/U in the polynomials, for headway",
    "X = (m - Yvdot) v r + m x_g r^2 + 1/2 rho L d U^2 (-R_0 + X_vv v'^2 + X_vr v' r' + X_rr r'^2 + X_vvvv v'^4)",
    "Y = -(m - Xudot) u r + 1/2 rho L d U^2 (Y_v v' + Y_r r' + Y_vvv v'^3 + Y_vvr v'^2 r' + Y_vrr v' r'^2 + Y_rrr r'^3)",
    "N = -m x_g u r + 1/2 rho L^2 d U^2 (N_v v' + N_r r' + N_vvv v'^3 + N_vvr v'^2 r' + N_vrr v' r'^2 + N_rrr r'^3)",
];

/// How the coefficients relate to the publication.
pub(super) const NOTE: &str = "MMG form as Yasukawa & Yoshimura 2015 print it, at midship: (m + m_x) u' - (m + m_y) v r - x_G m r^2 = X; (m + m_y) v' + (m + m_x) u r + x_G m r' = Y; (I_z + J_z) r' + x_G m (v' + u r) = N, with I_z about midship. The two sides of gamma_R are flow.straightening + flow.asymmetry for beta_R < 0 and the difference for beta_R > 0, those of C_2 are mmg_wake.C_2 + mmg_wake.dC_2 for beta_P > 0 and the difference for beta_P < 0.";

/// The primes of `mmg_hull` as the model has them: name, value and meaning.
pub(super) fn primes(model: &Model) -> impl Iterator<Item = (&'static str, f64, &'static str)> + '_ {
    let own = model.parameters.iter().filter(|p| p.name.starts_with("mmg_hull."));
    own.map(|p| (p.info.name, p.value, p.info.about))
}

/// The hull force as a MATLAB function.
pub(super) const MATLAB: &str = "
% Hull force [X; Y; N] in N and N m at u > 0, v [m/s] and r [rad/s]
h = ship.hd; c = ship.mmg; s = ship.small; q = 0.5*ship.rho*ship.L*ship.d;
U = @(u,v) sqrt(u.^2 + v.^2 + s^2);
a = @(u,v) v./U(u,v);
b = @(u,v,r) r*ship.L./U(u,v);
ship.hull_force = @(u,v,r) [ ...
  (h.mass - h.Yvdot)*v.*r + h.mass*h.x_g*r.^2 + q*U(u,v).^2.*(-c.R_0 + c.X_vv*a(u,v).^2 + c.X_vr*a(u,v).*b(u,v,r) + c.X_rr*b(u,v,r).^2 + c.X_vvvv*a(u,v).^4); ...
  -(h.mass - h.Xudot)*u.*r + q*U(u,v).^2.*(c.Y_v*a(u,v) + c.Y_r*b(u,v,r) + c.Y_vvv*a(u,v).^3 + c.Y_vvr*a(u,v).^2.*b(u,v,r) + c.Y_vrr*a(u,v).*b(u,v,r).^2 + c.Y_rrr*b(u,v,r).^3); ...
  -h.mass*h.x_g*u.*r + q*ship.L*U(u,v).^2.*(c.N_v*a(u,v) + c.N_r*b(u,v,r) + c.N_vvv*a(u,v).^3 + c.N_vvr*a(u,v).^2.*b(u,v,r) + c.N_vrr*a(u,v).*b(u,v,r).^2 + c.N_rrr*b(u,v,r).^3)];
";
