//! Cross-flow drag of a hull in strips, integrated in closed form.
//! It has no coefficient: the simulators multiply it with their own drag coefficient and weight of the yaw rate.

/// Integrals over the length, `(int |w| w dx, int |w| w x dx)` with w = v + r x over -L/2..=L/2, in \[m^3/s^2, m^4/s^2\].
///
/// `v` sway velocity \[m/s\], `r` yaw rate (may be weighted) \[rad/s\], `length` L \[m\]. Exact: the integrand is a
/// quadratic that changes sign at most once.
pub fn integrals(v: f64, r: f64, length: f64) -> (f64, f64) {
    let half = 0.5 * length;
    if v.abs() >= r.abs() * half {
        let sign = v.signum();
        let second_moment = length * length * length / 12.0;
        (sign * (v * v * length + r * r * second_moment), sign * 2.0 * v * r * second_moment)
    } else {
        // Substituting w for x; |r| > 2 |v| / L here, so that the quotients are bounded.
        let (aft, fore) = (v - r * half, v + r * half);
        let cubic = |w: f64| w.abs().powi(3) / 3.0;
        let quartic = |w: f64| w.powi(3) * w.abs() / 4.0;
        let force = (cubic(fore) - cubic(aft)) / r;
        let moment = (quartic(fore) - quartic(aft) - v * (cubic(fore) - cubic(aft))) / (r * r);
        (force, moment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_equals_the_sum_over_strips() {
        for (v, r) in [(1.0, 0.0), (1.0, 0.01), (-0.3, 0.02), (0.2, -0.03), (0.0, 0.02), (-2.0, -0.01), (0.0, 0.0)] {
            let (length, strips) = (100.0, 20_000);
            let (mut force, mut moment) = (0.0, 0.0);
            for i in 0..strips {
                let x = length * ((i as f64 + 0.5) / strips as f64 - 0.5);
                let w: f64 = v + r * x;
                force += w.abs() * w * length / strips as f64;
                moment += w.abs() * w * x * length / strips as f64;
            }
            let (f, m) = integrals(v, r, length);
            assert!((f - force).abs() < 1e-5 * (1.0 + force.abs()), "{f} {force}");
            assert!((m - moment).abs() < 1e-5 * (1.0 + moment.abs()), "{m} {moment}");
        }
    }

    #[test]
    fn both_branches_meet_where_the_sign_change_reaches_the_end() {
        let (outside, inside) = (integrals(1.0, 0.02, 100.0), integrals(1.0 - 1e-9, 0.02, 100.0));
        assert!((outside.0 - inside.0).abs() < 1e-6 && (outside.1 - inside.1).abs() < 1e-4);
    }
}
