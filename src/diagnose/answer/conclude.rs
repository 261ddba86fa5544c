//! The verdict once every finding has its grade: what is left of the decision on the tests, as a pure function.
//! It estimates nothing and looks at no runs.

use crate::diagnose::proof::finding::Finding;
use crate::diagnose::proof::grade::{Grade, LawGrade};
use crate::diagnose::search::decide::{Verdict, named};

/// The verdict, from the one that the tests of the kept model give, the grades of what was withdrawn, and whether the model
/// follows the recordings.
///
/// A model that does not follow the recordings is no base for any name. What unseen runs refute was significant on the training runs:
/// something is there, but not this law. What is too small to matter, or not determined, leaves nothing that could be named.
pub fn conclude(decided: Verdict, withdrawn: &[Grade], base_holds: bool) -> Verdict {
    match decided {
        Verdict::Sensor | Verdict::Numerics if base_holds => decided,
        _ if !base_holds => Verdict::Insufficient,
        Verdict::NothingMissing | Verdict::Random
            if withdrawn.iter().any(|g| matches!(g, Grade::Refuted | Grade::RefutedTogether)) =>
        {
            Verdict::NotInCatalogue
        }
        // A force fixed on the earth or to one side of the ship: the headings sailed do not distinguish them.
        Verdict::NotInCatalogue if withdrawn.contains(&Grade::NotIsolated) => Verdict::Insufficient,
        _ => decided,
    }
}

/// Puts what unseen runs confirm before what is suspected, each in the order in which it was found, and gives the verdict that the first
/// of them makes: a suspected sensor does not stand above a confirmed force.
pub fn lead(decided: Verdict, findings: &mut [Finding]) -> Verdict {
    findings.sort_by_key(|f| f.grade != Grade::Confirmed);
    match (decided, findings.first()) {
        (Verdict::Named | Verdict::OneOf | Verdict::Sensor, Some(first)) => {
            named(first.kind, first.confidence_set.len())
        }
        _ => decided,
    }
}

/// The grade of a law under the models that are written, which are within their bounds: where these are not better on unseen runs with it
/// than without, it describes the training runs alone.
pub fn capped_law(grade: LawGrade, better_together: bool) -> LawGrade {
    if grade == LawGrade::Confirmed && !better_together { LawGrade::Exploratory } else { grade }
}

/// What is confirmed by itself is suspected where all findings together make unseen runs worse than the base model: each may then stand
/// for a part of something else, and what is not written is not confirmed.
pub fn cap(findings: &mut [Finding], worse_together: bool) {
    let confirmed = findings.iter_mut().filter(|f| worse_together && f.grade == Grade::Confirmed);
    confirmed.for_each(|f| f.grade = Grade::Suspected);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::finding;
    use crate::physics::Kind;

    #[test]
    fn a_confirmed_force_leads_a_suspected_sensor() {
        let of = |name: &str, kind: Kind, grade: Grade| Finding { kind, grade, ..finding(name, name, &[name]) };
        let clocks = |grade: Grade| of("time_skew", Kind::Sensor, grade);
        let current = |grade: Grade| of("current", Kind::Environment, grade);
        let order = |mut findings: Vec<Finding>| {
            let verdict = lead(Verdict::Sensor, &mut findings);
            (verdict, findings.iter().map(|f| f.mechanism.clone()).collect::<Vec<_>>())
        };
        let names = |a: &str, b: &str| vec![a.to_owned(), b.to_owned()];
        let (sure, maybe) = (Grade::Confirmed, Grade::Suspected);
        assert_eq!(order(vec![clocks(maybe), current(sure)]), (Verdict::Named, names("current", "time_skew")));
        for grades in [[sure, sure], [maybe, maybe], [sure, maybe]] {
            let found = order(vec![clocks(grades[0]), current(grades[1])]);
            assert_eq!(found, (Verdict::Sensor, names("time_skew", "current")));
        }
        let mut both = [clocks(maybe), finding("current", "current", &["current", "mean_wind"])];
        both[1].grade = sure;
        assert_eq!(lead(Verdict::Sensor, &mut both), Verdict::OneOf);
        assert_eq!(lead(Verdict::Insufficient, &mut both), Verdict::Insufficient);
    }

    #[test]
    fn a_refuted_name_leaves_something_that_is_not_in_the_catalogue() {
        for quiet in [Verdict::NothingMissing, Verdict::Random] {
            assert_eq!(conclude(quiet, &[Grade::Immaterial, Grade::Refuted], true), Verdict::NotInCatalogue);
            for grade in [Grade::Immaterial, Grade::Undetermined] {
                assert_eq!(conclude(quiet, &[grade], true), quiet);
            }
        }
        assert_eq!(conclude(Verdict::NotInCatalogue, &[Grade::NotIsolated], true), Verdict::Insufficient);
        assert_eq!(conclude(Verdict::Named, &[Grade::Refuted], true), Verdict::Named);
        assert_eq!(conclude(Verdict::Insufficient, &[Grade::Refuted], true), Verdict::Insufficient);
    }

    #[test]
    fn nothing_is_confirmed_where_all_findings_together_make_unseen_runs_worse() {
        let of = |grade: Grade| Finding { grade, ..finding("current", "current", &["current"]) };
        for (worse, left) in [(true, Grade::Suspected), (false, Grade::Confirmed)] {
            let mut findings = [of(Grade::Confirmed), of(Grade::Suspected)];
            cap(&mut findings, worse);
            assert_eq!(findings.map(|f| f.grade), [left, Grade::Suspected]);
        }
    }

    #[test]
    fn a_law_is_confirmed_only_where_the_models_that_are_written_are_better_with_it() {
        use LawGrade::{Confirmed, Exploratory, Refuted};
        assert_eq!([true, false].map(|better| capped_law(Confirmed, better)), [Confirmed, Exploratory]);
        assert_eq!([Exploratory, Refuted].map(|grade| capped_law(grade, false)), [Exploratory, Refuted]);
    }

    #[test]
    fn nothing_is_concluded_on_a_base_that_does_not_follow_the_recordings() {
        for decided in [Verdict::Named, Verdict::OneOf, Verdict::NothingMissing, Verdict::NotInCatalogue] {
            assert_eq!(conclude(decided, &[], false), Verdict::Insufficient);
            assert_eq!(conclude(decided, &[], true), decided);
        }
    }
}
