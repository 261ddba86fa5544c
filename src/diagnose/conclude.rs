//! The verdict once every finding has its grade: what is left of the decision on the tests, as a pure function.
//! It estimates nothing and knows no runs.

use super::decide::Verdict;
use super::grade::Grade;

/// The verdict, from the one that the tests of the kept model give, the grades of what was withdrawn, and whether the base holds.
///
/// A model that does not follow the recordings is no base for any name. What unseen runs refute was significant on the training runs:
/// something is there, but not this law. What is too small to matter, or not determined, leaves nothing that could be named.
pub fn conclude(decided: Verdict, withdrawn: &[Grade], base_holds: bool) -> Verdict {
    match decided {
        Verdict::Sensor | Verdict::Numerics if base_holds => decided,
        _ if !base_holds => Verdict::Insufficient,
        Verdict::NothingMissing | Verdict::Random if withdrawn.contains(&Grade::Refuted) => Verdict::NotInCatalogue,
        _ => decided,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refuted_name_leaves_something_that_is_not_in_the_catalogue() {
        for quiet in [Verdict::NothingMissing, Verdict::Random] {
            assert_eq!(conclude(quiet, &[Grade::Immaterial, Grade::Refuted], true), Verdict::NotInCatalogue);
            for grade in [Grade::Immaterial, Grade::Undetermined] {
                assert_eq!(conclude(quiet, &[grade], true), quiet);
            }
        }
        assert_eq!(conclude(Verdict::Named, &[Grade::Refuted], true), Verdict::Named);
        assert_eq!(conclude(Verdict::Insufficient, &[Grade::Refuted], true), Verdict::Insufficient);
    }

    #[test]
    fn nothing_is_concluded_on_a_base_that_does_not_hold() {
        for decided in [Verdict::Named, Verdict::OneOf, Verdict::NothingMissing, Verdict::NotInCatalogue] {
            assert_eq!(conclude(decided, &[], false), Verdict::Insufficient);
            assert_eq!(conclude(decided, &[], true), decided);
        }
    }
}
