//! What is sailed: seeded plans of manoeuvres, sessions and the split into train and test, and the helmsman who carries them out.
//! It knows no effect: two cases of one seed sail the same plans whatever is concealed in one of them.

use std::f64::consts::PI;

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::craft::Craft;
use crate::truth::{Inputs, State};

/// Time between rows \[s\].
pub const PERIOD: f64 = 2.0;
/// Steps of a run: 121 rows.
pub const STEPS: usize = 120;

/// Which recordings there are to judge from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
#[value(rename_all = "kebab-case")]
pub enum Design {
    /// 40 runs in 4 sessions, 30 to train on, every kind of manoeuvre, headings all round.
    Standard,
    /// The same number of runs, all within a few degrees of one heading.
    OneHeading,
    /// The same number of runs, all on straight courses.
    Straight,
    /// 6 runs in 2 sessions.
    Few,
}

impl Design {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::OneHeading => "one-heading",
            Self::Straight => "straight",
            Self::Few => "few",
        }
    }

    /// Whether it can tell every effect that is visible in it.
    pub fn can_tell(self) -> bool {
        self == Self::Standard
    }
}

/// How the rudder is ordered during a part of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Steer {
    /// This angle \[rad\].
    Helm(f64),
    /// Steady on the first course altered by this angle \[rad\].
    Course(f64),
    /// Rudder and change of heading of this angle, to either side in turn \[rad\].
    Zigzag(f64),
}

/// Orders from a time on: time \[s\], propeller rate \[rps\], rudder.
type Order = (f64, f64, Steer);

/// One run to be sailed.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// `r01`
    pub name: String,
    /// Index of the session.
    pub session: usize,
    /// Held out from the fit.
    pub test: bool,
    /// What is done, as a seaman would call it.
    pub manoeuvre: &'static str,
    /// First heading \[rad\].
    pub heading: f64,
    /// First speed \[m/s\].
    pub speed: f64,
    /// First position \[m\].
    pub start: [f64; 2],
    /// Time of the campaign at the first row \[s\].
    pub clock: f64,
    orders: Vec<Order>,
}

/// A helmsman under way on a plan.
#[derive(Debug)]
pub struct Helmsman<'a> {
    plan: &'a Plan,
    length: f64,
    side: f64,
    began: f64,
    part: usize,
    from: f64,
}

/// Rates of steering gear and telegraph that are in the recorded orders already \[rad/s, rps/s\].
const RATES: [f64; 2] = [5.0 * PI / 180.0, 0.15];

impl<'a> Helmsman<'a> {
    /// A helmsman at the start of a plan, with a ship of `length` \[m\].
    pub fn new(plan: &'a Plan, length: f64) -> Self {
        Self { plan, length, side: 1.0, began: plan.heading, part: usize::MAX, from: 0.0 }
    }

    /// Orders one row after `before`, from what he sees at time `t` \[s\].
    pub fn next(&mut self, t: f64, state: &State, before: &Inputs) -> Inputs {
        let orders = &self.plan.orders;
        let part = orders.iter().rposition(|o| o.0 <= t).unwrap_or(0);
        if part != self.part {
            (self.part, self.began, self.side) = (part, state.psi, 1.0);
            self.from = t;
        }
        let Some((_, n, steer)) = orders.get(part).copied() else { return *before };
        let wanted = match steer {
            Steer::Helm(angle) => angle,
            Steer::Course(alter) => {
                let error = self.plan.heading + alter - state.psi;
                let turn = state.r * self.length / state.speed().max(1.0);
                if state.u < 0.0 { 0.0 } else { (1.4 * error - 0.7 * turn).clamp(-0.45, 0.45) }
            }
            Steer::Zigzag(angle) => {
                if self.side * (state.psi - self.began) >= angle.abs() {
                    self.side = -self.side;
                }
                self.side * angle
            }
        };
        let reach = |from: f64, to: f64, rate: f64| from + (to - from).clamp(-rate * PERIOD, rate * PERIOD);
        Inputs { n: reach(before.n, n, RATES[1]), delta: reach(before.delta, wanted, RATES[0]) }
    }
}

/// Kinds of manoeuvre and how many of 40 runs there are of each.
const PROGRAMME: [(&str, usize); 8] = [
    ("turn", 8),
    ("zigzag", 7),
    ("steps", 8),
    ("crash stop", 5),
    ("astern", 3),
    ("course", 4),
    ("acceleration", 3),
    ("slow", 2),
];

/// The plans of a design, speeds times `pace`.
pub fn plans(design: Design, craft: &Craft, pace: f64, rng: &mut ChaCha8Rng) -> Vec<Plan> {
    let (runs, sessions) = match design {
        Design::Few => (6, 2),
        _ => (40, 4),
    };
    let mut kinds: Vec<&'static str> = match design {
        Design::Standard => PROGRAMME.iter().flat_map(|(kind, count)| vec![*kind; *count]).collect(),
        Design::OneHeading => (0..runs).map(|i| ["course", "acceleration", "weave", "coasting"][i % 4]).collect(),
        Design::Straight => (0..runs).map(|i| ["course", "acceleration", "coasting"][i % 3]).collect(),
        Design::Few => vec!["turn", "zigzag", "steps", "crash stop", "course", "steps"],
    };
    kinds.shuffle(rng);
    let per_session = runs / sessions;
    let common = rng.random_range(0.0..2.0 * PI);
    let mut tests = vec![false; runs];
    for session in 0..sessions {
        let mut places: Vec<usize> = (session * per_session..(session + 1) * per_session).collect();
        places.shuffle(rng);
        let held = if per_session < 10 { 1 } else { 3 - session % 2 };
        places.iter().take(held).for_each(|i| tests[*i] = true);
    }
    let of_run = |(i, kind): (usize, &'static str)| {
        let mut between = |low: f64, high: f64| rng.random_range(low..high);
        let heading = match design {
            Design::OneHeading => common + between(-0.05, 0.05),
            _ => between(0.0, 2.0 * PI),
        };
        let start = [between(-300.0, 300.0), between(-300.0, 300.0)];
        let (speed, orders) = orders(kind, craft, pace, &mut between);
        Plan {
            name: format!("r{:02}", i + 1),
            session: i / per_session,
            test: tests[i],
            manoeuvre: kind,
            heading,
            speed,
            start,
            clock: 21_600.0 * (i / per_session) as f64 + 900.0 * (i % per_session) as f64,
            orders,
        }
    };
    kinds.into_iter().enumerate().map(of_run).collect()
}

/// First speed and orders of a manoeuvre.
fn orders(kind: &str, craft: &Craft, pace: f64, between: &mut dyn FnMut(f64, f64) -> f64) -> (f64, Vec<Order>) {
    let most = 4.15;
    let degrees = PI / 180.0;
    let mut speed = pace * between(3.0, 7.0);
    let n = craft.trimmed_rate(speed, most);
    let side = if between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    let steady = Steer::Course(0.0);
    let parts = match kind {
        "turn" => {
            let hard = side * between(10.0, 35.0) * degrees;
            let back = between(150.0, 220.0);
            vec![(0.0, n, steady), (between(10.0, 30.0), n, Steer::Helm(hard)), (back, n, Steer::Helm(-0.4 * hard))]
        }
        "zigzag" => {
            let angle = side * if between(0.0, 1.0) < 0.5 { 10.0 } else { 20.0 } * degrees;
            vec![(0.0, n, steady), (10.0, n, Steer::Zigzag(angle))]
        }
        "steps" => {
            let mut parts = vec![(0.0, n, steady)];
            let mut t = between(6.0, 20.0);
            while t < PERIOD * STEPS as f64 {
                let helm = between(-30.0, 30.0) * degrees;
                let rate = (n * between(0.5, 1.35)).min(most);
                parts.push((t, rate, Steer::Helm(helm)));
                t += between(15.0, 45.0);
            }
            parts
        }
        "crash stop" => {
            let back = -between(1.8, 3.8);
            let stop = between(10.0, 40.0);
            let end = stop + between(50.0, 110.0);
            let helm = between(-15.0, 15.0) * degrees;
            vec![
                (0.0, n, steady),
                (stop, back, Steer::Helm(helm)),
                (end, 0.0, Steer::Helm(0.0)),
                (end + between(15.0, 40.0), 0.6 * n, Steer::Helm(side * between(5.0, 30.0) * degrees)),
            ]
        }
        "astern" => {
            speed = pace * between(0.1, 1.0);
            let back = -between(1.6, 3.6);
            let kick = between(110.0, 170.0);
            vec![
                (0.0, back, Steer::Helm(between(-20.0, 20.0) * degrees)),
                (kick, between(1.5, 2.5), Steer::Helm(side * between(15.0, 34.0) * degrees)),
            ]
        }
        "acceleration" => {
            speed = pace * between(1.0, 3.0);
            let low = craft.trimmed_rate(speed, most);
            vec![
                (0.0, low, steady),
                (between(10.0, 40.0), between(2.8, most), Steer::Course(side * between(0.0, 20.0) * degrees)),
            ]
        }
        "slow" => {
            speed = pace * between(0.3, 1.5);
            let mut parts = Vec::new();
            let mut t = 0.0;
            while t < PERIOD * STEPS as f64 {
                parts.push((t, between(-1.6, 1.8), Steer::Helm(between(-34.0, 34.0) * degrees)));
                t += between(25.0, 60.0);
            }
            parts
        }
        "weave" => {
            let angle = side * between(4.0, 8.0) * degrees;
            vec![(0.0, n, steady), (10.0, n, Steer::Zigzag(angle))]
        }
        "coasting" => {
            let stop = between(20.0, 80.0);
            vec![(0.0, n, steady), (stop, 0.2, steady), (stop + between(60.0, 110.0), n, steady)]
        }
        _ => {
            let alter = if kind == "course" { 0.0 } else { side };
            vec![(0.0, n, steady), (between(90.0, 160.0), (n * between(0.7, 1.2)).min(most), Steer::Course(alter))]
        }
    };
    (speed, parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::craft::Family;
    use rand::SeedableRng;

    fn of(design: Design) -> Vec<Plan> {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let craft = Craft::draw(Family::Mmg, 0.0, &mut rng);
        plans(design, &craft, 1.0, &mut rng)
    }

    #[test]
    fn standard_design_has_30_runs_to_train_on_and_10_to_test_on_in_4_sessions() {
        let all = of(Design::Standard);
        assert_eq!((all.len(), all.iter().filter(|p| p.test).count()), (40, 10));
        for session in 0..4 {
            let here = all.iter().filter(|p| p.session == session);
            assert_eq!(here.clone().count(), 10);
            assert!((2..=3).contains(&here.filter(|p| p.test).count()));
        }
    }

    #[test]
    fn headings_are_all_round_but_where_the_design_says_one() {
        let spread = |design| {
            let c: Vec<[f64; 2]> = of(design).iter().map(|p| [p.heading.cos(), p.heading.sin()]).collect();
            let mean = c.iter().fold([0.0; 2], |s, v| [s[0] + v[0], s[1] + v[1]]).map(|s| s / c.len() as f64);
            1.0 - mean[0].hypot(mean[1])
        };
        assert!(spread(Design::Standard) > 0.6);
        assert!(spread(Design::OneHeading) < 0.01);
    }

    #[test]
    fn turns_go_both_ways() {
        let turns: Vec<bool> = of(Design::Standard)
            .iter()
            .filter(|p| p.manoeuvre == "turn")
            .filter_map(|p| p.orders.get(1).map(|o| matches!(o.2, Steer::Helm(a) if a > 0.0)))
            .collect();
        assert!(turns.contains(&true) && turns.contains(&false));
    }
}
