//! Three models on runs that no other step has used: the study's own as it was given, the base model (the study's, refitted) and the
//! improved model; and which of them is written. It fits nothing.
//!
//! The improved model that is written never simulates the unseen runs worse than the model that the study came with: it diverges on no more of
//! them, and where on as many its mean cVDM is no larger.

use crate::diagnose::proof::prove::{RunScore, diverged};
use crate::state::STATES;
use crate::statistics::mean;
use serde::Serialize;

/// Whose model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Whose {
    /// The study's own, as it was given.
    Own,
    /// The study's, with its parameters and the uncertain coefficients estimated.
    Base,
    /// The base model with what was found.
    Improved,
}

/// How one model simulates the unseen runs freely, as means over those on which none of the models diverges.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OnUnseen {
    /// Whose model.
    pub model: Whose,
    /// Runs on which no model diverges.
    pub runs: usize,
    /// Runs on which this one diverges.
    pub diverged: usize,
    /// Combined variable distance metric \[%\]; absent without runs on which no model diverges.
    pub cvdm: Option<f64>,
    /// Distance of the position \[m\], of its components' mean distances.
    pub position: Option<f64>,
    /// Mean distance of the heading \[rad\].
    pub heading: Option<f64>,
    /// Mean distance of the surge speed \[m/s\].
    pub speed: Option<f64>,
}

/// Models on unseen runs, by their scores run by run; empty where there are none.
pub fn on_unseen(models: &[(Whose, &[RunScore])]) -> Vec<OnUnseen> {
    let count = models.first().map_or(0, |(_, scores)| scores.len());
    if count == 0 {
        return Vec::new();
    }
    let judged: Vec<usize> = (0..count).filter(|i| models.iter().all(|(_, of)| of[*i].cvdm.is_some())).collect();
    let one = |(whose, of): &(Whose, &[RunScore])| {
        let kept = || judged.iter().map(|i| &of[*i]);
        let channel = |value: &dyn Fn(&[Option<f64>; STATES]) -> Option<f64>| {
            mean(kept().filter_map(|score| value(score.mean_distance.as_ref()?)))
        };
        OnUnseen {
            model: *whose,
            runs: judged.len(),
            diverged: diverged(of),
            cvdm: mean(kept().filter_map(|score| score.cvdm)),
            position: channel(&|md| Some(md[0]?.hypot(md[1]?))),
            heading: channel(&|md| md[2]),
            speed: channel(&|md| md[3]),
        }
    };
    models.iter().map(one).collect()
}

/// Whose model is written in place of `wanted`: the study's own where it simulates the unseen runs better.
pub fn written(wanted: Whose, scores: &[OnUnseen]) -> Whose {
    let of = |whose: Whose| scores.iter().find(|s| s.model == whose);
    let is_better = |(own, other): (&OnUnseen, &OnUnseen)| {
        own.diverged < other.diverged
            || own.diverged == other.diverged && own.cvdm.zip(other.cvdm).is_some_and(|(own, other)| own < other)
    };
    if of(Whose::Own).zip(of(wanted)).is_some_and(is_better) { Whose::Own } else { wanted }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{model, runs, with};
    use crate::diagnose::proof::prove::scores;
    use crate::diagnose::settings::Settings;

    #[test]
    fn the_truth_has_the_least_error_and_is_written_whoever_gave_it() {
        let truth = with(&[("current.north", 0.4)]);
        let (unseen, judging, other) = (runs(&truth, 4), Settings::default().judging, model());
        let [of_truth, of_other] = [&truth, &other].map(|model| scores(model, &unseen, &judging));
        let scores = on_unseen(&[(Whose::Own, &of_truth), (Whose::Base, &of_other)]);
        assert_eq!((scores.len(), scores[0].runs), (2, 4));
        assert!(scores[0].cvdm.zip(scores[1].cvdm).is_some_and(|(a, b)| a < 0.5 * b));
        assert!(scores[0].position < scores[1].position, "{scores:?}");
        assert_eq!(written(Whose::Base, &scores), Whose::Own);
        let swapped = on_unseen(&[(Whose::Own, &of_other), (Whose::Base, &of_truth)]);
        assert_eq!(written(Whose::Base, &swapped), Whose::Base);
    }

    #[test]
    fn a_run_on_which_one_model_diverges_counts_for_none_and_the_model_that_diverges_is_not_written() {
        let truth = model();
        let mut wild = truth.clone();
        let Some(i) = wild.index("hull.Nr") else { unreachable!("the hull has a yaw damping") };
        wild.parameters[i].value *= -50.0;
        let judging = Settings::default().judging;
        let [of_truth, of_wild] = [&truth, &wild].map(|model| scores(model, &runs(&truth, 2), &judging));
        let both = on_unseen(&[(Whose::Own, &of_truth), (Whose::Base, &of_wild)]);
        assert_eq!(both.iter().map(|s| (s.runs, s.diverged, s.cvdm)).collect::<Vec<_>>(), [(0, 0, None), (0, 2, None)]);
        assert_eq!(written(Whose::Base, &both), Whose::Own);
        assert!(on_unseen(&[(Whose::Own, &scores(&truth, &[], &judging))]).is_empty());
        assert_eq!(written(Whose::Improved, &[]), Whose::Improved);
    }
}
