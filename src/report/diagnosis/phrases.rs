//! Phrases that several parts of a diagnosis share: p-values, shares, amplitudes and forces with their intervals.
//! Which of them are written, and about what, is decided in the parts.

use crate::diagnose::evidence::locate::EquationShare;
use crate::diagnose::evidence::push::Window;
use crate::diagnose::proof::finding::Amplitude;
use crate::numerals::{fixed, sig};
use crate::report::units::{EQUATIONS, Units};

/// A p-value, none below 1e-12.
pub(super) fn p_value(p: f64) -> String {
    if p < 1e-12 { "p < 1e-12".to_owned() } else { format!("p = {}", sig(p, 2)) }
}

/// A share as a percentage without decimals.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", fixed(100.0 * share, 0))
}

/// p-value above which a test of adequacy finds nothing.
pub(super) const UNDECIDED: f64 = 0.01;

/// The outcome of a test of adequacy or symmetry.
pub(super) fn adequacy_words(p: f64) -> &'static str {
    if p < 1e-4 {
        "significant"
    } else if p < UNDECIDED {
        "undecided"
    } else {
        "not significant"
    }
}

/// Value and interval.
pub(super) fn amplitude(a: &Amplitude, units: Units) -> String {
    let (factor, _) = units.human(&a.unit);
    let [low, high] = a.ci95.map(|v| sig(v * factor, 3));
    format!("{} ({low} to {high})", units.text(a.value, &a.unit))
}

/// Share and root mean square of a force in each equation.
pub(super) fn equations(shares: [&EquationShare; 3], units: Units) -> String {
    EQUATIONS
        .iter()
        .zip(shares)
        .map(|((e, unit, _), s)| format!("{e} {} ({})", percent(s.share), units.text(s.rms, unit)))
        .collect::<Vec<_>>()
        .join(", ")
}

/// A force in each equation with its 95 % interval, from its standard errors.
pub(super) fn forces(force: &[f64; 3], error: &[f64; 3], units: Units) -> String {
    EQUATIONS
        .iter()
        .zip(force.iter().zip(error))
        .map(|((e, unit, _), (f, s))| {
            let (factor, unit) = units.human(unit);
            format!("{e} {} +- {} {unit}", sig(f * factor, 3), sig(1.96 * s * factor, 2))
        })
        .collect::<Vec<_>>()
        .join(", ")
}

/// A window of time with its force.
pub(super) fn window(w: &Window, units: Units) -> String {
    format!(
        "{} from {} to {} s: {} ({})",
        w.run,
        fixed(w.start, 0),
        fixed(w.end, 0),
        forces(&w.force, &w.error, units),
        p_value(w.p)
    )
}
