//! Audit of recordings before anything is concluded from them: gaps, units, signs, clocks, frozen channels, jumps.
//! It reports doubts about recordings that can be read, one question a file; it fits nothing and knows no model.
//!
//! [`audit_study`] is what `trimtab check` shows; [`audit_runs`] and [`settled`] are called before a fit and before a diagnosis.

mod agreement;
#[cfg(test)]
mod example;
mod issue;
mod limits;
mod model;
mod motion;
mod record;
mod runs;
mod study;
mod values;

pub use agreement::across::{Evidence, across};
pub use agreement::lone::Lone;
pub use issue::{Issue, Severity, Shared};
pub use model::audit_model;
pub use motion::kinematics::Kinematics;
pub use motion::plateau::{Part, Plateau};
pub use motion::response::Curve;
pub use motion::sums::Sums;
pub use record::{Audit, ChannelSummary, Responses, Stretch, audit};
pub use runs::audit_runs;
pub use study::{StudyAudit, audit_each, audit_study};
pub use values::receiver::{Jump, jumps, piece, settled};

#[cfg(test)]
mod tests {
    use super::agreement::propeller;
    use super::*;
    use crate::recording::{Channel, ColumnMap, Recording};
    use crate::ship::Ship;
    use std::f64::consts::TAU;
    use std::path::Path;

    /// A zigzag-like run: Nomoto's ship under a rudder that swings, position integrated finely from velocity.
    fn swing() -> Vec<(Channel, Vec<f64>)> {
        let (dt, fine) = (0.5, 50);
        let mut state = [0.0, 0.0, 0.3, 0.0];
        let mut columns: [Vec<f64>; 8] = Default::default();
        for i in 0..600 {
            let t = f64::from(i) * dt;
            let delta = 0.3 * (TAU * t / 80.0).sin().signum() + 0.02 * (t * 0.7).sin();
            let (u, v) = (4.0 + 0.5 * (t * 0.02).sin() - 20.0 * state[3] * state[3], -8.0 * state[3]);
            for (column, value) in columns.iter_mut().zip([state[0], state[1], state[2], u, v, state[3], delta, t]) {
                column.push(value);
            }
            for k in 0..fine {
                let h = dt / f64::from(fine);
                let s = t + h * f64::from(k);
                let (u, v) = (4.0 + 0.5 * (s * 0.02).sin() - 20.0 * state[3] * state[3], -8.0 * state[3]);
                let psi: f64 = state[2] + 0.5 * h * state[3];
                state[0] += h * (u * psi.cos() - v * psi.sin());
                state[1] += h * (u * psi.sin() + v * psi.cos());
                state[2] += h * state[3];
                state[3] += h * (0.05 * delta - state[3]) / 8.0;
            }
        }
        let [x, y, psi, u, v, r, delta, t] = columns;
        let n = vec![2.0; t.len()];
        let names = [
            Channel::X,
            Channel::Y,
            Channel::Psi,
            Channel::U,
            Channel::V,
            Channel::R,
            Channel::Delta,
            Channel::T,
            Channel::N,
        ];
        names.into_iter().zip([x, y, psi, u, v, r, delta, t, n]).collect()
    }

    fn values(channels: &mut [(Channel, Vec<f64>)], channel: Channel) -> &mut Vec<f64> {
        &mut channels.iter_mut().find(|(c, _)| *c == channel).unwrap().1
    }

    fn issues(channels: Vec<(Channel, Vec<f64>)>) -> Vec<Issue> {
        audit(&Recording::from_channels("run", channels).unwrap()).issues
    }

    /// Scales a channel of the swing and returns the issues.
    fn scaled(channels: &[Channel], factor: f64) -> Vec<Issue> {
        let mut run = swing();
        for &c in channels {
            values(&mut run, c).iter_mut().for_each(|v| *v *= factor);
        }
        issues(run)
    }

    #[test]
    fn a_consistent_run_raises_nothing() {
        let recording = Recording::from_channels("run", swing()).unwrap();
        let audit = audit(&recording);
        assert_eq!(audit.issues, []);
        let k = audit.kinematics.unwrap();
        assert!(
            (k.yaw_rate_gain.unwrap() - 1.0).abs() < 0.02 && (k.velocity_gain.unwrap() - 1.0).abs() < 0.01,
            "{k:?}"
        );
        assert!(k.yaw_rate_lag.unwrap().abs() < 0.1 && k.track_angle.unwrap().abs() < 0.01, "{k:?}");
    }

    #[test]
    fn wrong_units_and_signs_are_named_by_the_gain_they_cause() {
        let cases = [
            (vec![Channel::R], -1.0, Channel::R, "sign is turned"),
            (vec![Channel::R], 57.295_779_5, Channel::R, "in deg/s and was declared rad/s"),
            (vec![Channel::R], 1.0 / 57.295_779_5, Channel::R, "in rad/s and was declared deg/s"),
            (vec![Channel::R], 60.0, Channel::R, "deg/min"),
            (vec![Channel::U, Channel::V], 1.943_844, Channel::U, "in knots and was declared m/s"),
            (vec![Channel::U, Channel::V], 1.0 / 1.943_844, Channel::U, "in m/s and was declared kn"),
            (vec![Channel::U, Channel::V], -1.0, Channel::U, "against its recorded velocity"),
            (vec![Channel::U, Channel::V], 1.0 / 0.3048, Channel::U, "in ft/s and was declared m/s"),
            (vec![Channel::X, Channel::Y], 1.0 / 0.3048, Channel::U, "position is in ft"),
            (vec![Channel::X, Channel::Y], 1.0 / 1852.0, Channel::U, "position is in nautical miles"),
            (vec![Channel::V], -1.0, Channel::V, "sway of the track"),
            (vec![Channel::Y], -1.0, Channel::Psi, "mirror image"),
        ];
        for (channels, factor, at, words) in cases {
            let found = scaled(&channels, factor);
            let hit = found.iter().find(|i| i.severity == Severity::Error);
            let hit = hit.unwrap_or_else(|| panic!("{channels:?} x {factor}: no error in {found:?}"));
            assert!(hit.channel == Some(at) && hit.text.contains(words), "{channels:?} x {factor}: {hit:?}");
        }
    }

    #[test]
    fn a_time_in_milliseconds_is_an_error_of_every_gain() {
        let found = scaled(&[Channel::T], 1000.0);
        let of_time: Vec<&Issue> = found.iter().filter(|i| i.text.contains("the time is in ms")).collect();
        assert!(of_time.len() == 2 && of_time.iter().all(|i| i.severity == Severity::Error), "{found:?}");
    }

    #[test]
    fn a_propeller_rate_of_another_unit_shows_in_the_advance_ratio() {
        let ship = Ship::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/a.toml")).unwrap();
        for (factor, unit) in [(1.0, None), (TAU, Some("rad/s")), (1.0 / 60.0, Some("rps"))] {
            let mut run = swing();
            values(&mut run, Channel::N).iter_mut().for_each(|n| *n *= factor);
            let ratio = propeller::advance_ratio(&Recording::from_channels("run", run).unwrap(), &ship);
            let issues: Vec<Issue> = propeller::advance(&[ratio], &ship).into_iter().flatten().collect();
            assert_eq!(issues.len(), usize::from(unit.is_some()), "{issues:?}");
            assert!(unit.is_none_or(|t| issues[0].text.contains(&format!("the column is in {t} "))), "{issues:?}");
        }
    }

    #[test]
    fn a_propeller_that_is_stopped_has_no_advance_ratio_and_one_that_never_turns_is_reported() {
        let ship = Ship::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/a.toml")).unwrap();
        let with = |rate: &dyn Fn(usize) -> f64| {
            let mut run = swing();
            values(&mut run, Channel::N).iter_mut().enumerate().for_each(|(i, n)| *n = rate(i));
            Recording::from_channels("run", run).unwrap()
        };
        let windmilling = with(&|i| if i < 100 { 2.0 } else { 0.004 });
        let ratio = propeller::advance_ratio(&windmilling, &ship).unwrap();
        assert!((0.2..1.6).contains(&ratio), "{ratio}");
        assert!(!propeller::is_unpowered(&windmilling, &ship) && propeller::is_unpowered(&with(&|_| 0.0), &ship));
        // The noise of a stopped one, which is positive in half of the rows.
        assert_eq!(propeller::advance_ratio(&with(&|i| 2e-4 * (0.7 * i as f64).sin()), &ship), None);
    }

    #[test]
    fn a_ship_that_keeps_its_speed_is_driven_and_one_that_coasts_loses_it() {
        let ship = Ship::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/a.toml")).unwrap();
        let sailing = |speed: &dyn Fn(f64) -> f64| {
            let t: Vec<f64> = (0..600).map(f64::from).collect();
            let u = t.iter().map(|t| speed(*t)).collect();
            Recording::from_channels("run", [(Channel::T, t), (Channel::U, u)].into_iter().collect()).unwrap()
        };
        assert!(propeller::keeps_speed(&sailing(&|_| 5.0), &ship));
        assert!(!propeller::keeps_speed(&sailing(&|t| 5.0 / (1.0 + t / 200.0)), &ship));
    }

    /// A turn under a nearly constant rudder: the yaw rate answers once, and then follows from nothing that changes.
    fn turn(side: f64) -> Vec<(Channel, Vec<f64>)> {
        let t: Vec<f64> = (0..400).map(f64::from).collect();
        // The turn slackens as the ship loses speed, while the rudder stays.
        let r: Vec<f64> = t.iter().map(|t| 0.01 * (1.0 + (-t / 40.0).exp()) * (1.0 - (-t / 10.0).exp())).collect();
        let psi = r
            .iter()
            .scan(0.0, |psi: &mut f64, r| {
                *psi += r;
                Some(*psi)
            })
            .collect();
        let delta = t.iter().map(|t| side * 0.6 * (1.0 - 0.02 * (t / 30.0).min(1.0))).collect();
        let u = t.iter().map(|t| 3.0 + 2.0 * (-t / 60.0).exp()).collect();
        vec![(Channel::T, t), (Channel::Psi, psi), (Channel::U, u), (Channel::R, r), (Channel::Delta, delta)]
    }

    #[test]
    fn a_steady_turn_shows_the_side_to_which_the_rudder_acts() {
        let against = |side: f64| issues(turn(side)).iter().any(|i| i.text.contains("against its rudder"));
        assert!(!against(1.0) && against(-1.0));
    }

    #[test]
    fn a_rudder_that_never_moves_is_reported_where_the_ship_turns() {
        let still = |run| issues(run).iter().any(|i| i.fault == "still");
        assert!(still(turn(0.0)) && !still(turn(1.0)));
    }

    #[test]
    fn what_follows_from_a_turned_sign_is_not_reported_as_well() {
        for channel in [Channel::V, Channel::R, Channel::Delta] {
            let found = scaled(&[channel], -1.0);
            assert!(found.iter().all(|i| i.fault == "sign_error"), "{channel}: {found:?}");
        }
    }

    #[test]
    fn velocities_along_the_earth_axes_are_recognised() {
        let mut run = swing();
        let psi: Vec<f64> = values(&mut run, Channel::Psi).iter().map(|p| p * 2.0).collect();
        // A wider swing of the heading, so that the axes differ.
        *values(&mut run, Channel::Psi) = psi.clone();
        let (u, v) = (values(&mut run, Channel::U).clone(), values(&mut run, Channel::V).clone());
        let north: Vec<f64> = (0..u.len()).map(|i| u[i] * psi[i].cos() - v[i] * psi[i].sin()).collect();
        let east: Vec<f64> = (0..u.len()).map(|i| u[i] * psi[i].sin() + v[i] * psi[i].cos()).collect();
        let integral = |rate: &[f64]| {
            let mut sum = 0.0;
            rate.iter()
                .map(|r| {
                    sum += 0.5 * r;
                    sum
                })
                .collect::<Vec<f64>>()
        };
        *values(&mut run, Channel::X) = integral(&north);
        *values(&mut run, Channel::Y) = integral(&east);
        *values(&mut run, Channel::U) = north;
        *values(&mut run, Channel::V) = east;
        let found = issues(run);
        assert!(found.iter().any(|i| i.next_step.contains("velocity_frame = \"earth\"")), "{found:?}");
    }

    #[test]
    fn a_heading_from_east_on_a_course_near_north_is_not_taken_for_velocities_along_the_earth_axes() {
        let mut run = swing();
        let psi = values(&mut run, Channel::Psi).clone();
        let mean = psi.iter().sum::<f64>() / psi.len() as f64;
        let (x, y) = (values(&mut run, Channel::X).clone(), values(&mut run, Channel::Y).clone());
        let (sin, cos) = mean.sin_cos();
        // The run is turned so that it swings around north.
        *values(&mut run, Channel::X) = x.iter().zip(&y).map(|(x, y)| x * cos + y * sin).collect();
        *values(&mut run, Channel::Y) = x.iter().zip(&y).map(|(x, y)| y * cos - x * sin).collect();
        *values(&mut run, Channel::Psi) = psi.iter().map(|p| std::f64::consts::FRAC_PI_2 - (p - mean)).collect();
        let found = issues(run);
        assert!(found.iter().all(|i| !i.next_step.contains("velocity_frame")), "{found:?}");
        assert!(found.iter().any(|i| i.next_step.contains("anticlockwise from east")), "{found:?}");
    }

    #[test]
    fn a_yaw_rate_of_the_wrong_sign_does_not_accuse_the_rudder() {
        let found = scaled(&[Channel::R], -1.0);
        assert!(found.iter().any(|i| i.channel == Some(Channel::R) && i.fault == "sign_error"), "{found:?}");
        assert!(found.iter().all(|i| i.channel != Some(Channel::Delta)), "{found:?}");
    }

    #[test]
    fn a_rudder_positive_to_port_is_recognised() {
        let found = scaled(&[Channel::Delta], -1.0);
        assert!(
            found.iter().any(|i| i.channel == Some(Channel::Delta) && i.text.contains("against its rudder")),
            "{found:?}"
        );
    }

    #[test]
    fn a_late_channel_is_reported_with_its_lag() {
        for late in [4_usize, 8] {
            let mut run = swing();
            let r = values(&mut run, Channel::R);
            r.rotate_right(late);
            r[..late].fill(0.0);
            let audit = audit(&Recording::from_channels("run", run).unwrap());
            let lag = audit.kinematics.unwrap().yaw_rate_lag.unwrap();
            assert!((lag - 0.5 * late as f64).abs() < 0.1, "{lag}");
            assert!(audit.issues.iter().any(|i| i.channel == Some(Channel::R) && i.text.contains("behind")));
        }
    }

    #[test]
    fn a_position_taken_off_midship_is_reported_with_its_lever() {
        let mut run = swing();
        let psi = values(&mut run, Channel::Psi).clone();
        values(&mut run, Channel::X).iter_mut().zip(&psi).for_each(|(x, p)| *x += 30.0 * p.cos());
        values(&mut run, Channel::Y).iter_mut().zip(&psi).for_each(|(y, p)| *y += 30.0 * p.sin());
        let audit = audit(&Recording::from_channels("run", run).unwrap());
        assert!((audit.kinematics.unwrap().lever.unwrap() - 30.0).abs() < 1.0);
        assert!(audit.issues.iter().any(|i| i.next_step.contains("reference_point")), "{:?}", audit.issues);
    }

    #[test]
    fn a_frozen_channel_is_reported_with_its_lines() {
        for channel in [Channel::X, Channel::Psi] {
            let mut run = swing();
            let v = values(&mut run, channel);
            let value = v[200];
            v[200..300].fill(value);
            let found = issues(run);
            let hit = found.iter().find(|i| i.channel == Some(channel) && i.text.contains("stands still")).unwrap();
            assert_eq!(hit.lines, Some((202, 301)));
        }
    }

    #[test]
    fn a_log_that_reads_nothing_is_frozen_and_no_fault_of_axes_units_or_heading() {
        let mut run = swing();
        values(&mut run, Channel::U).fill(0.0);
        let found = issues(run);
        let frozen = |i: &Issue| i.fault == "frozen" && i.channel == Some(Channel::U);
        assert!(found.len() == 1 && frozen(&found[0]), "{found:?}");
    }

    #[test]
    fn an_outlier_is_reported_with_its_line() {
        let mut run = swing();
        values(&mut run, Channel::U)[123] += 3.0;
        let found = issues(run);
        let hit = found.iter().find(|i| i.channel == Some(Channel::U) && i.text.contains("far from")).unwrap();
        assert_eq!(hit.lines, Some((125, 125)));
    }

    #[test]
    fn dropouts_and_gaps_are_warnings_with_lines() {
        let mut run = swing();
        values(&mut run, Channel::U)[10..14].fill(f64::NAN);
        values(&mut run, Channel::T)[300..].iter_mut().for_each(|t| *t += 7.0);
        let found = issues(run);
        assert!(found.iter().any(|i| i.lines == Some((12, 15)) && i.severity == Severity::Warning), "{found:?}");
        assert!(found.iter().any(|i| i.lines == Some((301, 302)) && i.text.contains("7.500 s")), "{found:?}");
    }

    #[test]
    fn a_rudder_converted_to_radians_twice_is_suspected_where_the_ship_turns() {
        let twice = |turn: f64| {
            let mut run = swing();
            values(&mut run, Channel::Delta).iter_mut().for_each(|d| *d /= 57.3);
            values(&mut run, Channel::Psi).iter_mut().for_each(|p| *p *= turn);
            issues(run).iter().any(|i| i.channel == Some(Channel::Delta) && i.next_step.contains("twice"))
        };
        assert!(twice(1.0) && !twice(1e-3));
    }

    #[test]
    fn a_rudder_in_radians_declared_in_degrees_is_suspected() {
        let mut text = "t [s],n [rps],delta [deg]\n".to_owned();
        (0..30).for_each(|i| text.push_str(&format!("{i},2,{}\n", 0.4 * f64::from(i).sin())));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("run.csv");
        std::fs::write(&file, text).unwrap();
        let map = ColumnMap::parse("", Path::new("columns.toml")).unwrap();
        let audit = audit(&Recording::read(&file, &map).unwrap());
        assert!(
            audit.issues.iter().any(|i| i.channel == Some(Channel::Delta) && i.next_step.contains("rad")),
            "{:?}",
            audit.issues
        );
    }
}
