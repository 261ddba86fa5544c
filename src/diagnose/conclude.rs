//! The verdict once every finding has its grade: what is left of the decision on the tests, as a pure function.
//! It estimates nothing and knows no runs.

use super::decide::Verdict;
use super::grade::Grade;

/// The verdict, from the one that the tests of the kept model give, the grades of what was withdrawn, whether a mechanism led and was
/// rejected for its own coefficients, and whether the base holds.
///
/// A model that does not follow the recordings is no base for any name. What unseen runs refute was significant on the training runs:
/// something is there, but not this law; so it is with what was rejected. What is too small to matter, or not determined, leaves nothing that could be named.
pub fn conclude(decided: Verdict, withdrawn: &[Grade], rejected: bool, base_holds: bool) -> Verdict {
    match decided {
        Verdict::Sensor | Verdict::Numerics if base_holds => decided,
        _ if !base_holds => Verdict::Insufficient,
        Verdict::NothingMissing | Verdict::Random if rejected || withdrawn.contains(&Grade::Refuted) => {
            Verdict::NotInCatalogue
        }
        // Something fixed on the earth or to one side, and no heading that tells which.
        Verdict::NotInCatalogue if withdrawn.contains(&Grade::NotIsolated) => Verdict::Insufficient,
        _ => decided,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refuted_name_leaves_something_that_is_not_in_the_catalogue() {
        for quiet in [Verdict::NothingMissing, Verdict::Random] {
            assert_eq!(conclude(quiet, &[Grade::Immaterial, Grade::Refuted], false, true), Verdict::NotInCatalogue);
            assert_eq!(conclude(quiet, &[], true, true), Verdict::NotInCatalogue);
            for grade in [Grade::Immaterial, Grade::Undetermined] {
                assert_eq!(conclude(quiet, &[grade], false, true), quiet);
            }
        }
        assert_eq!(conclude(Verdict::NotInCatalogue, &[Grade::NotIsolated], false, true), Verdict::Insufficient);
        assert_eq!(conclude(Verdict::Named, &[Grade::Refuted], true, true), Verdict::Named);
        assert_eq!(conclude(Verdict::Insufficient, &[Grade::Refuted], false, true), Verdict::Insufficient);
    }

    #[test]
    fn nothing_is_concluded_on_a_base_that_does_not_hold() {
        for decided in [Verdict::Named, Verdict::OneOf, Verdict::NothingMissing, Verdict::NotInCatalogue] {
            assert_eq!(conclude(decided, &[], false, false), Verdict::Insufficient);
            assert_eq!(conclude(decided, &[], false, true), decided);
        }
    }
}
