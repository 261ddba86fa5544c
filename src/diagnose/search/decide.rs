//! The verdict as a pure function of a table of tests: which mechanisms are kept, whether a push is named, what is said.
//! It estimates nothing and looks at no runs; every number it compares with is in the settings.

use crate::diagnose::settings::{
    BEYOND_DOUBT, BEYOND_FORM, FEWEST_RECORDINGS, FEWEST_RUNS, FEWEST_SAMPLES, GUST_SHARE, REMAINDER,
};
use crate::physics::Kind;
use crate::statistics::{chi_squared_p, scattered_p};
use serde::Serialize;

/// What a diagnosis concludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing is missing that these data could show.
    NothingMissing,
    /// One mechanism (or several together) is named.
    Named,
    /// One of several that these data cannot distinguish.
    OneOf,
    /// Something is missing that is not in the catalogue.
    NotInCatalogue,
    /// A sensor, not the ship.
    Sensor,
    /// The integration step, not the ship.
    Numerics,
    /// An unknown force acts, but nothing about it repeats.
    Random,
    /// The recordings cannot answer.
    Insufficient,
}

/// The test of one constant force in windows of some runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushTest {
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// Share of it in sway force and yaw moment, 0 to 1.
    pub across: f64,
    /// Statistic of its mirror image, as a share of its own.
    pub mirrored: f64,
    /// Recordings of equal evidence that those in which it acts count as.
    pub recordings: usize,
}

/// What the test of a push is compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chance {
    /// The chance of naming anything when nothing is missing.
    pub alpha: f64,
    /// Whether the ship's own forces have the form that the model gives them ([`form_holds`]).
    pub form_holds: bool,
}

impl PushTest {
    /// Chance of a statistic of three components whose scatter is known from the recordings in which they act alone: the same force
    /// in many recordings is soon significant, in two it must exceed a far higher statistic. One has no scatter and counts as two.
    fn by_chance(&self, statistic: f64) -> f64 {
        scattered_p(statistic, COMPONENTS, self.recordings.max(FEWEST_RECORDINGS - 1) as f64)
    }

    /// Whether such a force is an event and not the ship's own forces, which in another form make windows in manoeuvres like
    /// crash stops. Along the keel thrust and resistance of another form make windows too: only what a remainder of its
    /// statistic shows counts there.
    pub fn is_event(&self, chance: Chance) -> bool {
        let Chance { alpha, form_holds } = chance;
        let certain = chi_squared_p(self.statistic, COMPONENTS) < if form_holds { alpha * alpha } else { BEYOND_FORM };
        if self.across > 1.0 - REMAINDER {
            certain && self.by_chance(self.statistic) < alpha && self.mirrored < 0.5 * REMAINDER
        } else {
            certain && self.by_chance(REMAINDER * self.statistic) < alpha && form_holds
        }
    }

    /// Whether an event is put into the base model before any mechanism is refitted: the best mechanism (statistic `mechanism`)
    /// gains too little to explain it up to a remainder, and any smooth force law (statistic less degrees `law`) gains less.
    pub fn enters_first(&self, chance: Chance, mechanism: f64, law: f64) -> bool {
        self.is_event(chance) && mechanism < (1.0 - REMAINDER) * self.statistic && law < self.statistic
    }

    /// Whether a mechanism beside which a push has this statistic left explains the push.
    pub fn is_explained(&self, left: f64) -> bool {
        left < REMAINDER * self.statistic
    }

    /// Whether the push may be named beside a mechanism, whose form leaves something too: not where it acts in few recordings.
    fn exceeds_form(&self) -> bool {
        chi_squared_p(self.statistic, COMPONENTS) < BEYOND_FORM && !self.in_few_recordings()
    }

    /// Whether it acts in so few recordings that the ship's own forces in a state of their own could be meant.
    pub fn in_few_recordings(&self) -> bool {
        self.recordings < FEWEST_RECORDINGS
    }
}

/// Surge force, sway force and yaw moment.
const COMPONENTS: usize = 3;

/// The test of an earth-fixed force that differs between parts of the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceTest {
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// p-value.
    pub p: f64,
}

/// The test of one selected mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MechanismTest {
    /// What kind of thing it is.
    pub kind: Kind,
    /// Whether it is weather, the same wherever the ship sails.
    pub weather: bool,
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// Mechanisms that the data allow in its place, itself included.
    pub set_size: usize,
}

/// Tests of what a model leaves unexplained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualTests {
    /// p-value of the generic force law that breaks mirror symmetry or is fixed on the earth.
    pub asymmetric_p: f64,
    /// Its statistic less its degrees of freedom.
    pub asymmetric_gain: f64,
    /// The force in windows of some runs that gains most.
    pub push: Option<PushTest>,
    /// Whether an earth-fixed force differs from place to place.
    pub place: Option<PlaceTest>,
}

/// Every test that the verdict turns on.
#[derive(Clone, Debug, PartialEq)]
pub struct TestTable {
    /// The audit found a unit or a sign that is wrong.
    pub audit_blocks: bool,
    /// Gain in log-posterior of reading the recordings as explicit Euler steps.
    pub euler_gain: f64,
    /// Runs.
    pub runs: usize,
    /// Their samples.
    pub samples: usize,
    /// Standard deviation of the unknown force under the model with what was selected, in the mean over the time in which the ship sails its
    /// length, the larger of surge and sway \[N\]: what changes faster hardly moves the ship, and its size depends on the step.
    pub unknown_force: f64,
    /// Force that turns the ship, m u^2 / L \[N\].
    pub turning_force: f64,
    /// What the test of a push is compared with.
    pub chance: Chance,
    /// Whether a push may be named.
    pub push_allowed: bool,
    /// The push that was put into the base model before any mechanism was refitted.
    pub push_in_base: Option<PushTest>,
    /// What the base model leaves.
    pub base: ResidualTests,
    /// The mechanisms that were selected, in their order, without those that stay in the model unnamed.
    pub mechanisms: Vec<MechanismTest>,
    /// What the model with the selected mechanisms leaves; `None` without any.
    pub selected: Option<ResidualTests>,
}

/// How physics that is not in the catalogue shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unlisted {
    /// As a force law of state and inputs.
    Law,
    /// As a force in one part of the water.
    Place,
}

/// What is concluded from a table of tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The verdict.
    pub verdict: Verdict,
    /// Whether the selected mechanisms are kept; if not, what the base model leaves counts.
    pub keeps_mechanisms: bool,
    /// Whether a push is named: the one in the base model, or else the one in what the kept model leaves.
    pub names_push: bool,
    /// What is missing and not in the catalogue.
    pub unlisted: Option<Unlisted>,
}

/// Whether the ship's own forces have the form that the model gives them, by the p-value of a free mirror-symmetric force law.
pub fn form_holds(symmetric_p: f64, alpha: f64) -> bool {
    symmetric_p > alpha
}

/// Whether recordings are read as explicit Euler steps, by the gain in log-posterior.
pub fn is_euler(gain: f64) -> bool {
    gain > -BEYOND_DOUBT.ln()
}

/// The verdict on a table of tests.
pub fn decide(table: &TestTable) -> Decision {
    let refutation = refutation(table);
    let (mechanisms, left) = match (&table.selected, refutation) {
        (Some(left), None) => (table.mechanisms.as_slice(), left),
        _ => (&[][..], &table.base),
    };
    let push = push(table, mechanisms, left);
    let unlisted = if table.audit_blocks || !mechanisms.is_empty() || push.is_some() {
        None
    } else if refutation == Some(Unlisted::Place) {
        refutation
    } else {
        (left.asymmetric_p < BEYOND_FORM).then_some(Unlisted::Law)
    };
    let verdict = if table.audit_blocks {
        Verdict::Sensor
    } else if let Some(first) = mechanisms.first() {
        named(first.kind, first.set_size)
    } else if let Some(push) = push {
        if push.in_few_recordings() { Verdict::OneOf } else { Verdict::Named }
    } else {
        unnamed(table, unlisted)
    };
    Decision { verdict, keeps_mechanisms: refutation.is_none(), names_push: push.is_some(), unlisted }
}

/// Why the selected mechanisms are not what is missing: a name that leaves more unexplained than it explains, in forces that
/// break mirror symmetry or are fixed on the earth, is only the nearest of the catalogue; and weather is the same everywhere.
fn refutation(table: &TestTable) -> Option<Unlisted> {
    let left = table.selected.as_ref().filter(|_| !table.mechanisms.is_empty())?;
    let explained: f64 = table.mechanisms.iter().map(|m| m.statistic).sum();
    if left.asymmetric_p < BEYOND_FORM && left.asymmetric_gain > explained {
        return Some(Unlisted::Law);
    }
    let place = left.place.filter(|_| table.mechanisms.iter().any(|m| m.weather))?;
    let local = place.p < BEYOND_DOUBT && place.statistic - place.degrees as f64 > REMAINDER * explained;
    local.then_some(Unlisted::Place)
}

/// The push that is named beside these mechanisms, which leave so much.
fn push(table: &TestTable, mechanisms: &[MechanismTest], left: &ResidualTests) -> Option<PushTest> {
    let alone = mechanisms.is_empty();
    let is_named =
        |p: &PushTest| p.is_event(table.chance) && p.statistic > left.asymmetric_gain && (alone || p.exceeds_form());
    let may = table.push_allowed && !table.audit_blocks;
    let push = table.push_in_base.or(left.push.filter(|p| may && is_named(p)));
    // Beside a mechanism a force in one or two recordings may be that mechanism's.
    push.filter(|p| alone || !p.in_few_recordings())
}

/// The verdict of the first finding, by its kind and by how many mechanisms the data allow in its place.
pub fn named(kind: Kind, set_size: usize) -> Verdict {
    if set_size > 1 {
        Verdict::OneOf
    } else if kind == Kind::Sensor {
        Verdict::Sensor
    } else {
        Verdict::Named
    }
}

/// The verdict where nothing is named.
fn unnamed(table: &TestTable, unlisted: Option<Unlisted>) -> Verdict {
    if is_euler(table.euler_gain) {
        Verdict::Numerics
    } else if unlisted.is_some() {
        Verdict::NotInCatalogue
    } else if table.runs < FEWEST_RUNS || table.samples < FEWEST_SAMPLES {
        Verdict::Insufficient
    } else if table.unknown_force > GUST_SHARE * table.turning_force {
        Verdict::Random
    } else {
        Verdict::NothingMissing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn push_in(recordings: usize, statistic: f64) -> PushTest {
        PushTest { statistic, across: 0.95, mirrored: 0.05, recordings }
    }

    fn quiet() -> ResidualTests {
        ResidualTests { asymmetric_p: 0.4, asymmetric_gain: 2.0, push: None, place: None }
    }

    /// Forces of the model's form, and another form.
    const OF_FORM: Chance = Chance { alpha: 0.01, form_holds: true };
    const OF_ANOTHER: Chance = Chance { form_holds: false, ..OF_FORM };

    /// Thirty runs in which no test finds anything.
    fn null() -> TestTable {
        TestTable {
            audit_blocks: false,
            euler_gain: -500.0,
            runs: 30,
            samples: 3600,
            unknown_force: 1.0e3,
            turning_force: 1.0e6,
            chance: OF_FORM,
            push_allowed: true,
            push_in_base: None,
            base: quiet(),
            mechanisms: Vec::new(),
            selected: None,
        }
    }

    const CURRENT: MechanismTest =
        MechanismTest { kind: Kind::Environment, weather: true, statistic: 100.0, set_size: 1 };

    fn with(mechanisms: &[MechanismTest]) -> TestTable {
        TestTable { mechanisms: mechanisms.to_vec(), selected: Some(quiet()), ..null() }
    }

    fn verdict(table: &TestTable) -> Verdict {
        decide(table).verdict
    }

    #[test]
    fn where_no_test_finds_anything_the_data_decide_between_nothing_gusts_and_no_answer() {
        assert_eq!(verdict(&null()), Verdict::NothingMissing);
        assert_eq!(verdict(&TestTable { unknown_force: 2.1e4, ..null() }), Verdict::Random);
        assert_eq!(verdict(&TestTable { unknown_force: 1.9e4, ..null() }), Verdict::NothingMissing);
        assert_eq!(verdict(&TestTable { runs: 3, ..null() }), Verdict::Insufficient);
        assert_eq!(verdict(&TestTable { samples: 149, unknown_force: 2.1e4, ..null() }), Verdict::Insufficient);
    }

    #[test]
    fn an_euler_reading_is_numerics_before_all_that_is_not_named() {
        let euler = TestTable { euler_gain: 13.9, runs: 3, ..null() };
        assert_eq!(verdict(&euler), Verdict::Numerics);
        let base = ResidualTests { asymmetric_p: 1e-9, ..quiet() };
        let law = decide(&TestTable { base, ..euler });
        assert_eq!((law.verdict, law.unlisted), (Verdict::Numerics, Some(Unlisted::Law)));
        assert_eq!(verdict(&TestTable { euler_gain: 13.8, ..null() }), Verdict::NothingMissing);
        assert_eq!(verdict(&TestTable { euler_gain: 100.0, ..with(&[CURRENT]) }), Verdict::Named);
    }

    #[test]
    fn a_wrong_unit_is_a_sensor_whatever_else_was_found() {
        let base = ResidualTests { asymmetric_p: 1e-30, push: Some(push_in(9, 1e4)), ..quiet() };
        let d = decide(&TestTable { audit_blocks: true, base, ..null() });
        assert_eq!((d.verdict, d.names_push, d.unlisted), (Verdict::Sensor, false, None));
    }

    #[test]
    fn the_first_mechanism_decides_between_named_one_of_and_sensor() {
        assert_eq!(verdict(&with(&[CURRENT])), Verdict::Named);
        let compass = MechanismTest { kind: Kind::Sensor, weather: false, ..CURRENT };
        assert_eq!(verdict(&with(&[compass])), Verdict::Sensor);
        assert_eq!(verdict(&with(&[CURRENT, compass])), Verdict::Named);
        assert_eq!(verdict(&with(&[MechanismTest { set_size: 2, ..compass }])), Verdict::OneOf);
    }

    #[test]
    fn a_name_that_leaves_more_than_it_explains_is_dropped_and_nothing_of_it_counts() {
        let left = ResidualTests { asymmetric_p: 1e-9, asymmetric_gain: 101.0, ..quiet() };
        let table = TestTable { selected: Some(left), ..with(&[CURRENT]) };
        let base = ResidualTests { asymmetric_p: 1e-20, ..quiet() };
        let d = decide(&TestTable { base, ..table.clone() });
        assert_eq!((d.verdict, d.keeps_mechanisms), (Verdict::NotInCatalogue, false));
        assert_eq!(d.unlisted, Some(Unlisted::Law));
        // The base model alone leaves nothing significant.
        assert_eq!(verdict(&table), Verdict::NothingMissing);
        // Less than is explained, or not significant: the name is kept.
        for kept in [ResidualTests { asymmetric_gain: 99.0, ..left }, ResidualTests { asymmetric_p: 1e-7, ..left }] {
            let d = decide(&TestTable { selected: Some(kept), ..table.clone() });
            assert_eq!((d.verdict, d.keeps_mechanisms), (Verdict::Named, true));
        }
    }

    #[test]
    fn weather_that_differs_from_place_to_place_is_not_weather() {
        let place = Some(PlaceTest { statistic: 80.0, degrees: 16, p: 1e-7 });
        let table = TestTable { selected: Some(ResidualTests { place, ..quiet() }), ..with(&[CURRENT]) };
        let d = decide(&table);
        assert_eq!((d.verdict, d.unlisted), (Verdict::NotInCatalogue, Some(Unlisted::Place)));
        let stall = MechanismTest { kind: Kind::Ship, weather: false, ..CURRENT };
        assert_eq!(verdict(&TestTable { mechanisms: vec![stall], ..table.clone() }), Verdict::Named);
        let larger = MechanismTest { statistic: 161.0, ..CURRENT };
        assert_eq!(verdict(&TestTable { mechanisms: vec![larger], ..table }), Verdict::Named);
    }

    #[test]
    fn a_push_needs_a_higher_statistic_in_fewer_recordings() {
        // Three times the 99 % points of F with 3 and so many degrees of freedom; in many recordings the 99.99 % point of chi-squared.
        for (recordings, needed) in [(2, 297.5), (3, 88.4), (4, 50.1), (5, 36.2), (12, 21.1), (30, 21.1)] {
            assert!(push_in(recordings, needed + 0.1).is_event(OF_FORM), "{recordings}");
            assert!(!push_in(recordings, needed - 0.1).is_event(OF_FORM), "{recordings}");
        }
        assert!(push_in(1, 297.6).is_event(OF_FORM) && !push_in(1, 297.4).is_event(OF_FORM));
        // Beyond doubt on a ship of another form: chi-squared of 3 degrees at 1e-8.
        assert!(!push_in(5, 40.0).is_event(OF_ANOTHER) && push_in(5, 40.3).is_event(OF_ANOTHER));
        assert!(!PushTest { mirrored: 0.2, ..push_in(5, 1e3) }.is_event(OF_FORM));
    }

    #[test]
    fn a_push_along_the_keel_needs_two_and_a_half_times_as_much_and_forces_of_the_models_form() {
        let along = |statistic: f64| PushTest { across: 0.6, mirrored: 0.9, ..push_in(5, statistic) };
        assert!(along(90.8).is_event(OF_FORM) && !along(90.2).is_event(OF_FORM) && !along(1e4).is_event(OF_ANOTHER));
    }

    #[test]
    fn a_push_enters_first_where_no_mechanism_gains_enough_to_explain_it_and_is_explained_where_less_than_a_remainder_is_left()
     {
        let push = push_in(5, 100.0);
        assert!(push.enters_first(OF_FORM, 59.0, 99.0));
        assert!(!push.enters_first(OF_FORM, 61.0, 99.0) && !push.enters_first(OF_FORM, 59.0, 101.0));
        assert!(!push_in(2, 100.0).enters_first(OF_FORM, 0.0, 0.0));
        assert!(push.is_explained(39.0) && !push.is_explained(40.0));
    }

    #[test]
    fn a_push_alone_is_named_and_in_one_or_two_recordings_it_is_one_of_two() {
        let base = |push| ResidualTests { push: Some(push), ..quiet() };
        let d = decide(&TestTable { base: base(push_in(5, 40.0)), ..null() });
        assert_eq!((d.verdict, d.names_push), (Verdict::Named, true));
        assert_eq!(verdict(&TestTable { base: base(push_in(2, 300.0)), ..null() }), Verdict::OneOf);
        assert_eq!(verdict(&TestTable { base: base(push_in(5, 34.0)), ..null() }), Verdict::NothingMissing);
        // A smooth force law gains more, or the user does not want pushes.
        let law = ResidualTests { asymmetric_gain: 41.0, ..base(push_in(5, 40.0)) };
        assert_eq!(verdict(&TestTable { base: law, ..null() }), Verdict::NothingMissing);
        let withheld = TestTable { base: base(push_in(5, 40.0)), push_allowed: false, ..null() };
        assert_eq!(verdict(&withheld), Verdict::NothingMissing);
        // In the base model it was weighed before.
        assert_eq!(verdict(&TestTable { push_in_base: Some(push_in(2, 10.0)), ..null() }), Verdict::OneOf);
    }

    #[test]
    fn beside_a_mechanism_a_push_needs_more_and_is_not_named_in_one_or_two_recordings() {
        let beside = |push| {
            let selected = Some(ResidualTests { push: Some(push), ..quiet() });
            decide(&TestTable { selected, ..with(&[CURRENT]) }).names_push
        };
        // Significant by the scatter over the recordings, and beyond what another form makes.
        assert!(beside(push_in(3, 88.5)) && !beside(push_in(3, 88.2)));
        assert!(beside(push_in(10, 40.3)) && !beside(push_in(10, 40.0)));
        assert!(!beside(push_in(2, 1e4)));
        let in_base = TestTable { push_in_base: Some(push_in(2, 1e4)), ..with(&[CURRENT]) };
        assert!(!decide(&in_base).names_push);
    }
}
