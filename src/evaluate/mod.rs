//! How well models predict recordings: mean deviations, cVDM, and what a fitted model gains on a baseline, with intervals.
//! It compares trajectories and fits nothing; which windows are held out is set in the study.
//!
//! # Definitions
//! Source: Papandreou et al. 2025 (arXiv 2502.18696). For a window of K steps, with differences d between simulated and
//! measured state at the samples k = 1..K after the initial one (heading differences wrapped into (-pi, pi]):
//!
//! - Mean deviation of each dimension: `MD = (1/K) sum_k |d|` \[unit of the dimension\].
//! - `cVDM = (100/K) sum_k ( |dx|/L + |dy|/L + |dpsi|/pi + |du|/U + |dv|/U + |dr|/r_max )` \[%\] with the length L of the
//!   measured path, the mean measured speed U and a reference yaw rate r_max, as in the cost of a fit. Values that were not
//!   measured are left out, K of each channel being the samples that were; a channel never measured is left out of the means below.
//! - Relative improvement of a dimension over the baseline (marked ~): `(MD~ - MD*)/MD~`; its mean over the dimensions is
//!   the trajectory's average relative improvement, and `mARI` is the median of that over the trajectories. The paper's
//!   wording ("median of the average relative improvement") would also allow the mean over the dimensions of each
//!   dimension's median; we take it as said here.
//! - cVDM improvement: `(mean cVDM~ - mean cVDM*)/mean cVDM~` over the trajectories.
//! - Consistency: `1 - Var(cVDM*)/Var(cVDM~)` over the trajectories.
//!
//! - Steady motion, u, v and r kept as they are at the start of a window, is the prediction that needs no model: what a model is to beat.
//!
//! Intervals are 95 % intervals over whole runs: windows of one run share what is unknown. Of an improvement, on which verdicts turn,
//! it is that of a ratio by Student's t ([`crate::statistics::interval_of_ratio`]): few runs are resampled to too narrow an interval.
//! All others are percentile intervals of a bootstrap.
//!
//! A simulation that diverges has no deviation. It is counted, counts as worse than any that does not, and the other numbers
//! are of the trajectories that neither model diverges on.

mod compare;
mod cvdm;
pub mod maneuver;
mod outlying;
mod prove;
mod ranking;
mod settings;
mod start;
mod steady;
mod summary;
#[cfg(feature = "ipopt")]
pub mod sweep;

pub use compare::{Comparison, compare, predict, predict_all};
pub use cvdm::{Deviation, Outcome, outcome};
pub use outlying::{Outlying, outlying};
pub use prove::{Evaluation, Judging, Part, Proof, prove};
pub use ranking::{Ranked, Ranking, rank};
pub use settings::EvaluationSettings;
pub use start::start_error;
pub use steady::steady_motion;
pub use summary::{Estimate, Named, Summary, summarise};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Dynamics;
    use crate::fit::{Cost, CostOptions, Derivatives};
    use crate::model::Model;
    use crate::physics::Form;
    use crate::recording::{Run, Split, measured, or_nan};
    use crate::ship::Ship;
    use crate::simulate::Integration;
    use crate::state::Inputs;
    use crate::statistics::{median, variance};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};
    use std::f64::consts::PI;
    use std::path::Path;

    const R_MAX: f64 = 0.0314;

    fn model() -> Model {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/a.toml");
        let mut model = Model::new(Ship::read(&path).unwrap(), "A", Form::Regular, &[]).unwrap();
        model.set_eleven(&[-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370]);
        model
    }

    /// Windows sailed by the model itself under rudder angles that differ from window to window.
    fn windows(model: &Model, count: usize) -> Vec<Run> {
        (0..count)
            .map(|i| {
                let angle = 0.04 * (i as f64 - 2.0);
                let inputs: Vec<_> = (0..=40).map(|k| Inputs::actuators(5.0 * k as f64, 2.0, angle)).collect();
                let initial = [0.0, 0.0, 0.3 * i as f64, 4.0, 0.0, 0.0];
                let mut window = Run {
                    name: format!("run_{i} 0 s"),
                    recording: format!("run_{i}"),
                    session: format!("day {}", i % 2),
                    manoeuvre: "turn".into(),
                    split: Split::Test,
                    dt: 5.0,
                    recorded_dt: 5.0,
                    measured: vec![initial.map(Some); inputs.len()],
                    inputs,
                    initial,
                    disturbed: Vec::new(),
                    derived: [false; 6],
                };
                window.measured = measured(&predict(model, &window, Integration::default()).states);
                window
            })
            .collect()
    }

    #[test]
    fn what_sensors_report_is_predicted_from_what_they_reported_first() {
        let ship = model();
        let mut off = ship.clone();
        for (term, values) in [
            ("heading_bias", [("heading_bias.bias", 0.05)].as_slice()),
            ("compass_deviation", &[("compass_deviation.north", 0.02), ("compass_deviation.east", -0.04)]),
            ("log_scale", &[("log_scale.error", 0.08)]),
            ("antenna", &[("antenna.x", 30.0), ("antenna.y", -8.0)]),
            ("time_skew", &[("time_skew.position", 1.5)]),
        ] {
            off.add_term(term).unwrap();
            off.set(values).unwrap();
        }
        let theta = off.values();
        let mut windows = windows(&ship, 3);
        for w in &mut windows {
            for (m, inputs) in w.measured.iter_mut().zip(&w.inputs) {
                *m = Dynamics::new(&off, theta.clone()).report(&or_nan(m), inputs).map(Some);
            }
            w.initial = or_nan(&w.measured[0]);
        }
        let cvdm = |model: &Model, w: &Run| {
            let Outcome::Simulated(d) = outcome(w, &predict(model, w, Integration::default()), &ship.ship, R_MAX)
            else {
                panic!("diverged")
            };
            d.cvdm
        };
        for w in &windows {
            assert!(cvdm(&off, w) < 1e-4 && cvdm(&ship, w) > 3.0, "{} {}", cvdm(&off, w), cvdm(&ship, w));
        }
        // A fit sees the same: its cost has its least value, nothing, at the sensors' own errors, and is level there.
        let at = off.find("log_scale.error").unwrap();
        off.parameters.iter_mut().enumerate().for_each(|(i, p)| p.free = i == at);
        for derivatives in [Derivatives::Lanes, Derivatives::NumDual] {
            let options = CostOptions {
                max_yaw_rate: R_MAX,
                derivatives,
                difference_step: 1e-6,
                integration: Integration::default(),
            };
            let cost = Cost::new(&off, &windows, options).unwrap();
            let (here, there) = (cost.with_gradient(&[0.08]).unwrap(), cost.with_gradient(&[0.06]).unwrap());
            assert!(here.value < 1e-9 && there.value > 1e-4, "{} {}", here.value, there.value);
            let h = 1e-5;
            let slope = (cost.value(&[0.06 + h]).unwrap() - cost.value(&[0.06 - h]).unwrap()) / (2.0 * h);
            assert!((there.gradient[0] - slope).abs() < 1e-6 * slope.abs(), "{} {slope}", there.gradient[0]);
        }
    }

    fn changed(by: f64) -> Model {
        let mut model = model();
        model.set(&[("rudder.lift1", 3.193 * (1.0 + by)), ("resistance.linear", 34187.0 * (1.0 + by))]).unwrap();
        model
    }

    #[test]
    fn the_standard_error_of_cvdm_is_how_it_scatters_with_the_noise_of_the_start() {
        let (truth, off) = (model(), changed(0.1));
        let noise = [2.0, 2.0, 0.01, 0.03, 0.03, 2e-4];
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        for sound in windows(&truth, 3) {
            let (mut cvdms, mut errors) = (Vec::new(), Vec::new());
            for _ in 0..60 {
                let mut window = sound.clone();
                for sample in &mut window.measured {
                    for (value, noise) in sample.iter_mut().zip(noise) {
                        let white: f64 = StandardNormal.sample(&mut rng);
                        *value = value.map(|v| v + noise * white);
                    }
                }
                window.initial = or_nan(&window.measured[0]);
                let predicted = predict(&off, &window, Integration::default());
                cvdms.push(outcome(&window, &predicted, &off.ship, R_MAX).deviation().unwrap().cvdm);
                errors.push(start_error(&off, &window, Integration::default(), &predicted, R_MAX).unwrap());
            }
            let (scatter, error) = (variance(&cvdms).unwrap().sqrt(), median(errors).unwrap());
            assert!((0.6..1.6).contains(&(error / scatter)), "{error} {scatter}");
            let exact = predict(&truth, &sound, Integration::default());
            assert_eq!(start_error(&truth, &sound, Integration::default(), &exact, R_MAX), Some(0.0));
        }
    }

    fn judging(seed: u64) -> Judging {
        let settings = EvaluationSettings { seed, ..EvaluationSettings::default() };
        Judging { integration: Integration::default(), max_yaw_rate: R_MAX, settings }
    }

    fn evaluated(baseline: &Model, fitted: &Model, windows: &[Run]) -> Evaluation {
        prove(baseline, fitted, windows, &judging(1))
    }

    #[test]
    fn cvdm_of_a_constant_offset_is_what_the_formula_says() {
        let model = model();
        let window = windows(&model, 1).remove(0);
        let mut predicted = predict(&model, &window, Integration::default());
        let offset = [3.0, -4.0, 0.1, 0.2, -0.05, 0.002];
        for s in predicted.states.iter_mut().skip(1) {
            *s = std::array::from_fn(|i| s[i] + offset[i]);
            // A whole turn is no difference of heading.
            s[2] += 2.0 * PI;
        }
        let (l, u) = (window.path_length(), window.mean_speed());
        let expected = 100.0 * (7.0 / l + 0.1 / PI + 0.25 / u + 0.002 / R_MAX);
        let comparison = compare(&window, &model, R_MAX, (&predicted, &predicted));
        let deviation = comparison.fitted.deviation().unwrap();
        assert!((deviation.cvdm - expected).abs() < 1e-9 * expected, "{} {expected}", deviation.cvdm);
        for (md, offset) in deviation.md.iter().zip(offset) {
            assert!((md.unwrap() - offset.abs()).abs() < 1e-9);
        }
    }

    #[test]
    fn halving_every_deviation_improves_every_number_by_half() {
        let model = model();
        let windows = windows(&model, 6);
        let settings = EvaluationSettings::default();
        let comparisons: Vec<Comparison> = windows
            .iter()
            .enumerate()
            .map(|(i, w)| {
                let moved = |by: f64| {
                    let mut p = predict(&model, w, Integration::default());
                    p.states.iter_mut().for_each(|s| *s = s.map(|x| x + by * 0.01 * (i + 1) as f64));
                    p
                };
                compare(w, &model, R_MAX, (&moved(1.0), &moved(0.5)))
            })
            .collect();
        let summary = summarise("all".into(), &comparisons.iter().collect::<Vec<_>>(), &settings);
        let near = |e: Option<Estimate>, v: f64| assert!((e.unwrap().value - v).abs() < 1e-9, "{e:?} {v}");
        near(summary.cvdm_improvement, 0.5);
        near(summary.mari, 0.5);
        near(summary.consistency, 0.75);
        summary.md_improvement.iter().for_each(|e| near(*e, 0.5));
        assert_eq!((summary.better, summary.worse, summary.runs_better), (6, 0, 6));
        let [lo, hi] = summary.cvdm_improvement.unwrap().ci95.unwrap();
        assert!(lo <= 0.5 + 1e-9 && hi >= 0.5 - 1e-9);
        assert_eq!(summary.most_worsened, None);
    }

    #[test]
    fn the_true_model_is_exact_and_beats_a_wrong_one_everywhere() {
        let truth = model();
        let windows = windows(&truth, 6);
        let evaluation = evaluated(&changed(0.2), &truth, &windows);
        let test = evaluation.summary("test").unwrap();
        assert!(test.cvdm_fitted.unwrap().value < 1e-9);
        assert!((test.mari.unwrap().value - 1.0).abs() < 1e-9);
        assert_eq!((test.better, test.worse), (6, 0));
        // And the other way round an exact baseline leaves no relative improvement to speak of, and no NaN.
        let reversed = evaluated(&truth, &changed(0.2), &windows);
        let test = reversed.summary("test").unwrap();
        assert_eq!((test.mari, test.cvdm_improvement, test.better), (None, None, 0));
        assert!(!serde_json::to_string(&reversed).unwrap().contains("null"));
    }

    #[test]
    fn a_diverged_simulation_is_counted_and_named_and_spoils_no_number() {
        let truth = model();
        let windows = windows(&truth, 5);
        let mut wild = changed(0.1);
        wild.set(&[("resistance.linear", -1e9)]).unwrap();
        let evaluation = evaluated(&changed(0.2), &wild, &windows);
        let test = evaluation.summary("test").unwrap();
        assert_eq!((test.diverged_fitted, test.diverged_baseline), (5, 0));
        assert_eq!((test.better, test.worse, test.runs_worse), (0, 5, 5));
        assert_eq!(test.cvdm_fitted, None);
        assert!(matches!(test.worst.as_ref().unwrap().fitted, Outcome::Diverged { .. }));
        let text = serde_json::to_string(&evaluation).unwrap();
        assert!(!text.contains("null") && !text.contains("NaN"), "{text}");
    }

    #[test]
    fn runs_judged_in_parts_give_the_evaluation_of_all_of_them() {
        let truth = model();
        let windows = windows(&truth, 7);
        let (baseline, judging) = (changed(0.2), judging(1));
        let mut proof = Proof::new(&baseline, &truth, &judging);
        for some in windows.chunks(3) {
            let part = proof.part(some);
            proof.add(part);
        }
        assert_eq!(proof.evaluation(), prove(&baseline, &truth, &windows, &judging));
    }

    #[test]
    fn channels_that_were_not_measured_take_no_part() {
        let truth = model();
        let mut windows = windows(&truth, 4);
        for w in &mut windows {
            w.measured.iter_mut().for_each(|m| m[4] = None);
        }
        let evaluation = evaluated(&changed(0.2), &truth, &windows);
        assert_eq!(evaluation.trajectories[1].fitted.deviation().unwrap().md[4], None);
        assert!((evaluation.summary("test").unwrap().mari.unwrap().value - 1.0).abs() < 1e-9);
    }

    #[test]
    fn intervals_repeat_with_the_seed_and_cover_the_number() {
        let truth = model();
        let windows = windows(&truth, 8);
        let (a, b) = (changed(0.3), changed(-0.1));
        let first = evaluated(&a, &b, &windows);
        assert_eq!(first, evaluated(&a, &b, &windows));
        let of = |evaluation: &Evaluation| {
            let test = evaluation.summary("test").unwrap();
            [test.cvdm_fitted.unwrap(), test.cvdm_improvement.unwrap()]
        };
        let estimates = of(&first);
        for estimate in estimates {
            let [lo, hi] = estimate.ci95.unwrap();
            assert!(lo < estimate.value && estimate.value < hi);
        }
        // An improvement has its interval from no draws.
        let other = of(&prove(&a, &b, &windows, &judging(2)));
        assert!(other[0].ci95 != estimates[0].ci95 && other[1] == estimates[1]);
    }

    #[test]
    fn models_are_ranked_on_the_trajectories_that_all_run_through_and_differences_are_paired() {
        let truth = model();
        let all = windows(&truth, 6);
        let mut off = truth.clone();
        off.set(&[("rudder.lift1", 2.4)]).unwrap();
        off.parameters.iter_mut().for_each(|p| p.free = p.name == "rudder.lift1");
        let judging = Judging {
            integration: Integration::default(),
            max_yaw_rate: R_MAX,
            settings: EvaluationSettings { resamples: 200, ..EvaluationSettings::default() },
        };
        let ranking = rank(&[off.clone(), truth.clone(), off.clone()], &all, &judging);
        let [first, second, third] = &ranking.models[..] else { panic!("{ranking:?}") };
        assert_eq!((ranking.runs, ranking.trajectories, ranking.common), (6, 6, 6));
        assert_eq!((first.free, first.difference, second.runs_better, second.runs_worse), (1, None, 6, 0));
        let gained = second.difference.unwrap();
        assert!((gained.value - (second.cvdm.unwrap().value - first.cvdm.unwrap().value)).abs() < 1e-9);
        assert!(gained.ci95.unwrap()[1] < 0.0, "{gained:?}");
        assert_eq!(third.difference.map(|d| (d.value, d.ci95)), Some((0.0, Some([0.0, 0.0]))));
        // The second model's deviation is that of an evaluation.
        let evaluation = prove(&off, &truth, &all, &judging);
        let test: Vec<&Comparison> = evaluation.trajectories.iter().collect();
        let summary = summarise("all".into(), &test, &judging.settings);
        assert_eq!(summary.cvdm_fitted.map(|e| e.value), second.cvdm.map(|e| e.value));
    }

    #[test]
    fn groups_follow_split_manoeuvre_and_session() {
        let truth = model();
        let mut windows = windows(&truth, 6);
        windows[0].split = Split::Train;
        windows[1].manoeuvre = "stop".into();
        let evaluation = evaluated(&changed(0.2), &truth, &windows);
        let groups: Vec<&str> = evaluation.summaries.iter().map(|s| s.group.as_str()).collect();
        let expected = ["test", "train", "manoeuvre: stop", "manoeuvre: turn", "session: day 0", "session: day 1"];
        assert_eq!(groups, expected);
        assert_eq!(evaluation.summary("manoeuvre: stop").unwrap().cvdm_improvement.unwrap().ci95, None);
    }
}
