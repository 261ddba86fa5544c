//! Which recordings a concealed case has: designs, and seeded plans of manoeuvres, sessions and the split into train and test.
//! It depends on no effect: two cases of one seed have equal plans whatever is concealed in one of them.

use std::f64::consts::PI;

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::craft::Craft;
use super::helm::{Order, Steer};
use super::track::{PERIOD, STEPS};

/// Which recordings a diagnosis is given.
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

    /// Number of runs and of sessions.
    pub fn size(self) -> (usize, usize) {
        match self {
            Self::Few => (6, 2),
            _ => (40, 4),
        }
    }

    /// Whether every effect that is visible in it is identifiable.
    pub fn can_tell(self) -> bool {
        self == Self::Standard
    }
}

/// The plan of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// `r01`
    pub name: String,
    /// Index of the session.
    pub session: usize,
    /// Held out from the fit.
    pub test: bool,
    /// The kind of manoeuvre.
    pub manoeuvre: &'static str,
    /// First heading \[rad\].
    pub heading: f64,
    /// First speed \[m/s\].
    pub speed: f64,
    /// First position \[m\].
    pub start: [f64; 2],
    /// Clock at the first row, which runs on from session to session \[s\].
    pub clock: f64,
    /// Orders in their order.
    pub orders: Vec<Order>,
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
    let (runs, sessions) = design.size();
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

const DEGREE: f64 = PI / 180.0;

/// Highest propeller rate \[rps\].
const FASTEST: f64 = 4.15;

fn order(from: f64, n: f64, steer: Steer) -> Order {
    Order { from, n, steer }
}

/// On the first course.
fn steady(from: f64, n: f64) -> Order {
    order(from, n, Steer::Course(0.0))
}

/// First speed \[m/s\] and orders of a manoeuvre; `between` draws between two bounds.
fn orders(kind: &str, craft: &Craft, pace: f64, between: &mut dyn FnMut(f64, f64) -> f64) -> (f64, Vec<Order>) {
    let speed = pace * between(3.0, 7.0);
    let n = craft.trimmed_rate(speed, FASTEST);
    let side = if between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    match kind {
        "turn" => (speed, turn(n, side, between)),
        "zigzag" => {
            let angle = side * if between(0.0, 1.0) < 0.5 { 10.0 } else { 20.0 } * DEGREE;
            (speed, vec![steady(0.0, n), order(10.0, n, Steer::Zigzag(angle))])
        }
        "steps" => (speed, steps(n, between)),
        "crash stop" => (speed, crash_stop(n, side, between)),
        "astern" => (pace * between(0.1, 1.0), astern(side, between)),
        "acceleration" => {
            let speed = pace * between(1.0, 3.0);
            let (from, fast) = (between(10.0, 40.0), between(2.8, FASTEST));
            let later = order(from, fast, Steer::Course(side * between(0.0, 20.0) * DEGREE));
            (speed, vec![steady(0.0, craft.trimmed_rate(speed, FASTEST)), later])
        }
        "slow" => (pace * between(0.3, 1.5), slow(between)),
        "weave" => {
            let angle = side * between(4.0, 8.0) * DEGREE;
            (speed, vec![steady(0.0, n), order(10.0, n, Steer::Zigzag(angle))])
        }
        "coasting" => {
            let stop = between(20.0, 80.0);
            (speed, vec![steady(0.0, n), steady(stop, 0.2), steady(stop + between(60.0, 110.0), n)])
        }
        _ => {
            let from = between(90.0, 160.0);
            (speed, vec![steady(0.0, n), steady(from, (n * between(0.7, 1.2)).min(FASTEST))])
        }
    }
}

/// Steady, hard to one side, then less to the other.
fn turn(n: f64, side: f64, between: &mut dyn FnMut(f64, f64) -> f64) -> Vec<Order> {
    let hard = side * between(10.0, 35.0) * DEGREE;
    let back = between(150.0, 220.0);
    let over = order(between(10.0, 30.0), n, Steer::Helm(hard));
    vec![steady(0.0, n), over, order(back, n, Steer::Helm(-0.4 * hard))]
}

/// Steps of rudder and propeller rate together.
fn steps(n: f64, between: &mut dyn FnMut(f64, f64) -> f64) -> Vec<Order> {
    let mut parts = vec![steady(0.0, n)];
    let mut t = between(6.0, 20.0);
    while t < PERIOD * STEPS as f64 {
        let helm = between(-30.0, 30.0) * DEGREE;
        parts.push(order(t, (n * between(0.5, 1.35)).min(FASTEST), Steer::Helm(helm)));
        t += between(15.0, 45.0);
    }
    parts
}

/// Full astern from way on, stopped, then ahead with helm.
fn crash_stop(n: f64, side: f64, between: &mut dyn FnMut(f64, f64) -> f64) -> Vec<Order> {
    let back = -between(1.8, 3.8);
    let stop = between(10.0, 40.0);
    let end = stop + between(50.0, 110.0);
    let helm = between(-15.0, 15.0) * DEGREE;
    let ahead = end + between(15.0, 40.0);
    vec![
        steady(0.0, n),
        order(stop, back, Steer::Helm(helm)),
        order(end, 0.0, Steer::Helm(0.0)),
        order(ahead, 0.6 * n, Steer::Helm(side * between(5.0, 30.0) * DEGREE)),
    ]
}

/// Astern, then a kick ahead.
fn astern(side: f64, between: &mut dyn FnMut(f64, f64) -> f64) -> Vec<Order> {
    let back = -between(1.6, 3.6);
    let kick = between(110.0, 170.0);
    let first = order(0.0, back, Steer::Helm(between(-20.0, 20.0) * DEGREE));
    let rate = between(1.5, 2.5);
    vec![first, order(kick, rate, Steer::Helm(side * between(15.0, 34.0) * DEGREE))]
}

/// Rudder and rate at harbour speed, either way.
fn slow(between: &mut dyn FnMut(f64, f64) -> f64) -> Vec<Order> {
    let mut parts = Vec::new();
    let mut t = 0.0;
    while t < PERIOD * STEPS as f64 {
        let rate = between(-1.6, 1.8);
        parts.push(order(t, rate, Steer::Helm(between(-34.0, 34.0) * DEGREE)));
        t += between(25.0, 60.0);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::family::Family;
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
    fn headings_are_all_round_except_in_the_design_with_one_heading() {
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
            .filter_map(|p| p.orders.get(1).map(|o| matches!(o.steer, Steer::Helm(a) if a > 0.0)))
            .collect();
        assert!(turns.contains(&true) && turns.contains(&false));
    }
}
