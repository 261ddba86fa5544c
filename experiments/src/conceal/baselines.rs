//! What a user would do otherwise, and the oracle, on the very files of a case: the rows beside the diagnosis in the campaign's table.
//! They are asked after the diagnosis has spoken and the seal is open; only the oracle is told what was in it.

use std::path::Path;

use trimtab::diagnose::Settings;
use trimtab::diagnose::baseline::{Refitted, Told, oracle};
use trimtab::diagnose::candidate::Extent;
use trimtab::model::Model;
use trimtab::recording::{Run, Split};
use trimtab::ship::Ship;
use trimtab::study::Study;

use super::campaign::Planned;
use super::seal::Manifest;
use super::{ConcealError, Strength};

/// Which baselines are worth their time on a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// The refit of trajectories, and what is chosen on its residuals: BIC here, sparse regression in a script of its own.
    pub rivals: bool,
    /// The oracle.
    pub oracle: bool,
}

impl Wanted {
    /// Rivals where one effect or none is concealed in the standard design; the oracle where there is one to be told of. Below a
    /// ratio of 6 there is nothing to close and little to name.
    pub fn on(planned: &Planned) -> Self {
        let weak = planned.spec.effects.iter().any(|(_, s)| matches!(s, Strength::Snr(snr) if *snr < 6.0));
        let of = |arms: &[&str]| arms.contains(&planned.arm) && !weak;
        Self { rivals: of(&["null", "single", "contrast"]), oracle: of(&["single", "contrast"]) }
    }
}

/// What the baselines say of a case.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Baselines {
    /// Held-out score of the refit of trajectories \[%\].
    pub refit: Option<f64>,
    /// What iid BIC names; `nothing` when no mechanism lowers it.
    pub bic: Option<String>,
    /// Held-out score of the oracle \[%\].
    pub oracle: Option<f64>,
}

/// Asks the baselines about the study of an opened case.
///
/// # Errors
/// [`ConcealError::Content`] when the library refuses the study.
pub fn ask(study: &Path, manifest: &Manifest, wanted: Wanted) -> Result<Baselines, ConcealError> {
    let fail = |e: &dyn std::fmt::Display| ConcealError::Content { path: study.to_owned(), message: e.to_string() };
    let mut said = Baselines::default();
    if !(wanted.rivals || wanted.oracle) {
        return Ok(said);
    }
    let content = Study::read(study).map_err(|e| fail(&e))?;
    let ship = Ship::read(&content.ship).map_err(|e| fail(&e))?;
    let model = Model::read(&content.model, ship).map_err(|e| fail(&e))?;
    let windows = content.windows(model.ship.hull.draught).map_err(|e| fail(&e))?.windows;
    let (train, held_out): (Vec<Run>, Vec<Run>) = windows.into_iter().partition(|w| w.split == Split::Train);
    let settings = Settings::default();
    if wanted.rivals
        && let Some(refitted) = Refitted::new(&model, &train, &settings).map_err(|e| fail(&e))?
    {
        said.refit = Some(refitted.held_out(&held_out));
        let ranking = refitted.ranking(&train, &settings.withhold);
        let best = ranking.first().filter(|best| best.gain > 0.0);
        said.bic = Some(best.map_or("nothing", |b| b.mechanism.as_str()).to_owned());
    }
    if wanted.oracle {
        said.oracle = oracle(&model, &train, &held_out, &settings, &told(manifest)).map_err(|e| fail(&e))?;
    }
    Ok(said)
}

/// What was concealed, in the names of the diagnosis.
fn told(manifest: &Manifest) -> Vec<Told> {
    let mut told = Vec::new();
    for answer in &manifest.answers {
        let extent = if manifest.spec.contrast { Extent::In(answer.sessions.clone()) } else { Extent::All };
        // A log through the water says nothing without the current it leaves out.
        let needed = (answer.effect == "water_log").then_some("current");
        for mechanism in needed.into_iter().chain(answer.accepted.first().map(String::as_str)) {
            told.push(Told { mechanism: mechanism.to_owned(), extent: extent.clone() });
        }
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::campaign::{SEED, plan};
    use crate::conceal::craft::Family;
    use crate::conceal::effects::{Class, catalogue};
    use crate::conceal::strength::ForceMeter;
    use crate::conceal::{Case, Spec};
    use trimtab::diagnose::report::mechanism_names;

    #[test]
    fn rivals_are_asked_about_nulls_and_the_oracle_about_effects_that_can_be_seen() {
        let of = |key: &str| Wanted::on(plan(SEED).iter().find(|c| c.key == key).unwrap());
        let said = |rivals, oracle| Wanted { rivals, oracle };
        assert_eq!(of("hd/null/gusts/1"), said(true, false));
        assert_eq!(of("mmg/current/snr12/1"), said(true, true));
        assert_eq!(of("hd/current/snr3/1"), said(false, false));
        assert_eq!(of("hd/tanh_moment/x0.5/1"), said(false, false));
    }

    #[test]
    fn the_oracle_is_told_a_name_of_the_catalogue_for_every_force() {
        let names: Vec<&str> = mechanism_names().collect();
        for entry in catalogue().filter(|e| e.class == Class::Force) {
            assert!(names.contains(&entry.accepted[0]), "{}", entry.name);
        }
    }

    #[test]
    fn an_oracle_told_of_a_strong_current_beats_the_refit_and_the_criterion_sees_something() {
        let folder = tempfile::tempdir().unwrap();
        let effects = vec![("current".to_owned(), Strength::Times(2.0))];
        let spec = Spec { effects, ..Spec::null(Family::Hd, 12) };
        let study = Case::make(&spec, &ForceMeter::default()).unwrap().write(folder.path()).unwrap();
        let manifest = crate::conceal::seal::open(folder.path()).unwrap();
        let said = ask(&study, &manifest, Wanted { rivals: true, oracle: true }).unwrap();
        let (refit, oracle) = (said.refit.unwrap(), said.oracle.unwrap());
        assert!(oracle < 0.8 * refit, "{oracle} {refit}");
        assert!(said.bic.unwrap() != "nothing");
    }
}
