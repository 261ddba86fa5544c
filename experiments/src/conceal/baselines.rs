//! The rival methods and the oracle on the files of a case, for the rows beside the diagnosis in the campaign's table.
//! They run after the diagnosis, when the seal is open; only the oracle gets the concealed effects.

use std::path::Path;

use trimtab::diagnose::evidence::candidate::Extent;
use trimtab::diagnose::proof::baseline::{GivenMechanism, oracle};

use super::campaign::plan::Planned;
use super::error::ConcealError;
use super::judge::rules::baseline_right;
use super::judge::score::Score;
use super::seal::Manifest;
use super::spec::Strength;
use crate::rivals::{Content, Refit};

/// Which baselines are run on a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// The refit of trajectories, and the mechanism chosen from its residuals: BIC here, sparse regression in a script.
    pub rivals: bool,
    /// The oracle.
    pub oracle: bool,
}

impl Wanted {
    /// Rivals where one effect or none is concealed in the standard design; the oracle where one effect is concealed. Below a
    /// ratio of 6 no baseline is run: there is no gap to close and little to name.
    pub fn on(planned: &Planned) -> Self {
        let weak = planned.spec.effects.iter().any(|(_, s)| matches!(s, Strength::Snr(snr) if *snr < 6.0));
        let of = |arms: &[&str]| arms.contains(&planned.arm) && !weak;
        Self { rivals: of(&["null", "single", "contrast"]), oracle: of(&["single", "contrast"]) }
    }
}

/// The answers of the baselines on a case.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Baselines {
    /// Held-out score of the refit of trajectories \[%\].
    pub refit: Option<f64>,
    /// The mechanism that iid BIC names; `nothing` when no mechanism lowers it.
    pub bic: Option<String>,
    /// Held-out score of the oracle \[%\].
    pub oracle: Option<f64>,
}

/// Runs the baselines on the study of an opened case.
///
/// # Errors
/// [`ConcealError::Content`] when the library refuses the study.
pub fn ask(study: &Path, manifest: &Manifest, wanted: Wanted) -> Result<Baselines, ConcealError> {
    let mut said = Baselines::default();
    if !(wanted.rivals || wanted.oracle) {
        return Ok(said);
    }
    let content = Content::read(study)?;
    if wanted.rivals
        && let Some(refit) = Refit::new(study, &content)?
    {
        (said.refit, said.bic) = (refit.held_out, Some(refit.bic));
    }
    if wanted.oracle {
        let Content { model, train, held_out, settings } = &content;
        said.oracle =
            oracle(model, train, held_out, settings, &known(manifest)).map_err(|e| ConcealError::content(study, &e))?;
    }
    Ok(said)
}

/// The concealed effects, in the names of the diagnosis.
fn known(manifest: &Manifest) -> Vec<GivenMechanism> {
    let mut known = Vec::new();
    for answer in &manifest.answers {
        let extent = if manifest.spec.contrast { Extent::In(answer.sessions.clone()) } else { Extent::All };
        // A log through the water has no effect without the current.
        let needed = (answer.effect == "water_log").then_some("current");
        for mechanism in needed.into_iter().chain(answer.accepted.first().map(String::as_str)) {
            known.push(GivenMechanism { mechanism: mechanism.to_owned(), extent: extent.clone() });
        }
    }
    known
}

impl Baselines {
    /// Adds the answers to the scores of the diagnosis on the same case.
    pub fn add_to(&self, score: &mut Score, manifest: &Manifest) {
        score.refit_held_out = self.refit;
        score.oracle_held_out = self.oracle;
        if let Some(name) = &self.bic {
            score.bic_named.clone_from(name);
            score.bic_right = Some(baseline_right(manifest, name));
        }
        if let (Some(base), Some(named), Some(oracle)) = (score.base_held_out, score.named_held_out, self.oracle)
            && base - oracle > 0.02 * base.abs()
        {
            score.gap_closed = Some((base - named) / (base - oracle));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::campaign::plan::{SEED, plan};
    use crate::conceal::case::Case;
    use crate::conceal::effects::catalogue::catalogue;
    use crate::conceal::effects::effect::Class;
    use crate::conceal::family::Family;
    use crate::conceal::spec::Spec;
    use crate::conceal::strength::ForceMeter;
    use trimtab::report::diagnosis::mechanism_names;

    #[test]
    fn rivals_run_on_nulls_and_the_oracle_on_visible_effects() {
        let of = |key: &str| Wanted::on(plan(SEED).iter().find(|c| c.key == key).unwrap());
        let said = |rivals, oracle| Wanted { rivals, oracle };
        assert_eq!(of("hd/null/gusts/1"), said(true, false));
        assert_eq!(of("mmg/current/snr12/1"), said(true, true));
        assert_eq!(of("hd/current/snr3/1"), said(false, false));
        assert_eq!(of("hd/tanh_moment/x0.5/1"), said(false, false));
    }

    #[test]
    fn the_gap_to_the_oracle_is_closed_by_a_share() {
        let manifest = Manifest {
            spec: Spec::null(Family::Hd, 1),
            expected: "NAMED".into(),
            structure: Vec::new(),
            answers: Vec::new(),
            asymmetry: None,
            files: Default::default(),
        };
        let mut s = Score { base_held_out: Some(2.0), named_held_out: Some(1.1), ..Score::default() };
        let said = Baselines { refit: Some(3.0), bic: Some("wind".into()), oracle: Some(1.0) };
        said.add_to(&mut s, &manifest);
        assert!((s.gap_closed.unwrap() - 0.9).abs() < 1e-12);
        assert_eq!((s.refit_held_out, s.bic_named.as_str(), s.bic_right), (Some(3.0), "wind", Some(false)));
        let mut near = Score { base_held_out: Some(1.01), named_held_out: Some(1.0), ..Score::default() };
        said.add_to(&mut near, &manifest);
        assert_eq!(near.gap_closed, None, "a gap within 2 % of the base is noise");
    }

    #[test]
    fn the_oracle_gets_a_name_of_the_catalogue_for_every_force() {
        let names: Vec<&str> = mechanism_names(trimtab::terms::standard()).collect();
        for entry in catalogue().filter(|e| e.class == Class::Force) {
            assert!(names.contains(&entry.accepted[0]), "{}", entry.name);
        }
    }

    #[test]
    fn an_oracle_that_knows_a_strong_current_beats_the_refit_and_bic_names_a_mechanism() {
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
