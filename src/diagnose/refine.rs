//! What the fit that follows a diagnosis should free, so that the manoeuvres of the ship itself come out: the hull, and what differs
//! between port and starboard. It is read from the tests of the diagnosis; nothing is estimated here.

use super::finding::Amplitude;
use super::settings::SIDES_DIFFER;
use super::sides::Sides;
use crate::model::Model;

/// The straightening of the flow at the rudder, to one side more than to the other.
const STRAIGHTENING: &str = "flow.asymmetry";
/// The wake at the propeller in drift, to one side more than to the other.
const WAKE: &str = "wake_drift";

impl Sides {
    /// The parameters whose interval excludes zero, the most significant first; none where the sides are not told apart.
    pub fn clear(&self) -> impl Iterator<Item = &Amplitude> {
        let apart = self.p < SIDES_DIFFER;
        self.parameters.iter().filter(move |a| apart && a.ci95[0] * a.ci95[1] > 0.0)
    }
}

/// Parameters and terms to free beside the hull in a fit that starts from the improved model: what `trimtab fit --free` takes.
///
/// These are the parameters that differ clearly between the sides and that a fit of the model would hold. With the straightening goes the
/// wake in drift: the MMG method has one value of each for either side of a ship with a single screw (Yasukawa & Yoshimura 2015, eq. 16
/// and 25), and a fit of the one alone gives it the part of the other.
pub fn to_free(sides: Option<&Sides>, model: &Model) -> Vec<String> {
    let held = |name: &str| model.index(name).is_none_or(|i| !model.parameters[i].free);
    let clear = sides.into_iter().flat_map(Sides::clear).map(|a| a.name.as_str());
    let mut names: Vec<String> = clear.filter(|name| held(name)).map(str::to_owned).collect();
    let wake_is_held = held("wake_drift.relief") && held("wake_drift.asymmetry");
    if names.iter().any(|name| name == STRAIGHTENING) && wake_is_held {
        names.push(WAKE.to_owned());
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::model;

    fn sides(p: f64, asymmetry: f64) -> Sides {
        let one = |name: &str, value: f64| Amplitude::within(name.to_owned(), value, "-", 0.02, 2.5);
        let parameters = vec![one(STRAIGHTENING, asymmetry), one("rudder.lift0", 0.5), one("rudder.drag1", 0.01)];
        Sides { statistic: 40.0, degrees: 3, p, parameters }
    }

    #[test]
    fn parameters_that_differ_clearly_are_freed_and_the_wake_with_the_straightening() {
        let mut model = model();
        model.find("rudder.lift0").map(|i| model.parameters[i].free = true).unwrap();
        // The lift is free already, the drag's interval holds zero.
        assert_eq!(to_free(Some(&sides(1e-8, -0.08)), &model), [STRAIGHTENING, WAKE]);
        // An interval that holds zero frees nothing, and neither do sides that are not told apart.
        assert!(to_free(Some(&sides(1e-8, -0.03)), &model).is_empty());
        assert!(to_free(Some(&sides(0.3, -0.08)), &model).is_empty());
        assert!(to_free(None, &model).is_empty());
    }

    #[test]
    fn a_wake_that_is_free_already_is_not_named_again() {
        let mut model = model();
        model.release(WAKE).unwrap();
        assert_eq!(to_free(Some(&sides(1e-8, -0.08)), &model), [STRAIGHTENING]);
    }
}
