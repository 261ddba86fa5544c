//! What is exported of a model of form `general`: its equations, and its hull force as a MATLAB function.
//! Its hull has no MMG polynomial: of that form the masses alone are given.

/// The equations of motion, with the coefficients of `general_hull`.
pub(super) const EQUATIONS: [&str; 4] = [
    "(m - Xudot) u' = X; (m - Yvdot) v' + m x_g r' = Y; m x_g v' + (inertia - Nrdot) r' = N; the forces of the actuators are added to the right",
    "X = (m - Yvdot) v r + m x_g r^2 - (surge_linear + surge_square |u| + surge_drift |v| + surge_turn L |r|) u + turning v r",
    "Y = -(m - Xudot) u r - sum over bow, mid, stern of (linear + square |w| + lift |u|) w + (lift - turning) u r, w = v + x r, x = L/2, 0, -L/2",
    "N = -m x_g u r - (Xudot - Yvdot) u v - sum of x (linear + square |w| + lift |u|) w - (yaw_linear + yaw_square |r| + yaw_lift |u|) r - lift u v",
];

/// What is given of the MMG form.
pub(super) const NOTE: &str = "The hull is no MMG polynomial; of that form the masses are given.";

/// The hull force as a MATLAB function.
pub(super) const MATLAB: &str = "
% Hull force [X; Y; N] in N and N m at u, v [m/s] and r [rad/s]
h = ship.hd; g = ship.general_hull; s = ship.small; L = ship.L;
absu = @(u) sqrt(u.^2 + s^2);
absr = @(r) sqrt(r.^2 + (s/L)^2);
bow = @(u,v,r) (g.bow_linear + g.bow_square*absu(v + L/2*r) + g.bow_lift*absu(u)).*(v + L/2*r);
mid = @(u,v,r) (g.mid_linear + g.mid_square*absu(v) + g.mid_lift*absu(u)).*v;
stern = @(u,v,r) (g.stern_linear + g.stern_square*absu(v - L/2*r) + g.stern_lift*absu(u)).*(v - L/2*r);
ship.hull_force = @(u,v,r) [ ...
  (h.mass - h.Yvdot + g.turning)*v.*r + h.mass*h.x_g*r.^2 - (g.surge_linear + g.surge_square*absu(u) + g.surge_drift*absu(v) + g.surge_turn*L*absr(r)).*u; ...
  -(h.mass - h.Xudot + g.turning - g.lift)*u.*r - bow(u,v,r) - mid(u,v,r) - stern(u,v,r); ...
  -h.mass*h.x_g*u.*r - (h.Xudot - h.Yvdot + g.lift)*u.*v - L/2*bow(u,v,r) + L/2*stern(u,v,r) - (g.yaw_linear + g.yaw_square*absr(r) + g.yaw_lift*absu(u)).*r];
";
